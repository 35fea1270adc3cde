// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tables that describe the numbers of a parameter struct.
///
/// One table drives reading from JSON, range checks, the written-back used.json and
/// `mesofit describe`, so a number's name, unit, default and range stand in one place.
#pragma once

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum field_type {
    FIELD_NUMBER,  ///< double
    FIELD_INTEGER, ///< int64_t
    FIELD_SEED,    ///< uint64_t below 2^53, the range that JSON numbers carry exactly
    FIELD_LENGTHS, ///< double[3]: two or three numbers, the third 0 when absent
    FIELD_TEXT,    ///< char[FIELD_TEXT_SIZE], not empty
    FIELD_FILE,    ///< char[FIELD_TEXT_SIZE], a path relative to the file that names it
    FIELD_CHOICE,  ///< int: index into `choices`
    FIELD_CHOICES, ///< int: set of `choices`, a bit each; at least one
};

enum { FIELD_TEXT_SIZE = 1024 };

struct field {
    const char *name;
    enum field_type type;
    size_t offset;              ///< of the member in the parameter struct
    bool required;              ///< no default: the user must give it
    double initial;             ///< default of a number, integer, seed, choice or set of them
    double minimum, maximum;    ///< inclusive range of numbers and integers
    const char *const *choices; ///< FIELD_CHOICE(S): names, NULL-terminated
    const char *unit;           ///< "k_B T", "λ", "steps", …; "" for pure numbers
    const char *help;           ///< one line
};

/// End of a field table.
#define FIELD_END                                                                                  \
    { .name = NULL }

/// Smallest minimum that means "above zero"; messages print it so.
#define FIELD_ABOVE_ZERO DBL_MIN

/// 2^53: integers beyond it lose digits in JSON.
#define FIELD_LARGEST_INTEGER 9007199254740992.0

/// The bit of a field in a set of those of its table, such as the ones that somebody gave.
uint64_t mf_fields_bit(const struct field *fields, const char *name);

/// Set every member of `parameters` to its default.
void mf_fields_set_defaults(const struct field *fields, void *parameters);

/// Print one line a field: name, type or choices, unit, default, range, help.
void mf_fields_describe(const struct field *fields, FILE *stream);

/// Print the allowed range of a field, such as "above 0" or "0 to 1", into `text`.
void mf_fields_range_text(const struct field *field, char *text, size_t size);

/// The type of a field, such as "number", or its choices, "a|b".
void mf_fields_type_text(const struct field *field, char *text, size_t size);

/// The default of a field, "none" or "required".
void mf_fields_default_text(const struct field *field, char *text, size_t size);

/// Index of `name` among the choices of `field`, or −1.
int mf_fields_choice_index(const struct field *field, const char *name);
