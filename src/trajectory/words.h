// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Words and numbers of a line of text. Tested: test_words.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// A part of a NUL-terminated line.
struct word {
    const char *begin;
    size_t length;
};

/// How many of its characters a message shows.
static inline int words_shown(const struct word *word) {
    enum { MOST = 40 };
    return word->length < MOST ? (int)word->length : MOST;
}

/// Take the next word, blanks and tabs being between them; false if there is none.
bool mf_words_next(const char **line, struct word *word);

/// How many words the line has.
size_t mf_words_count(const char *line);

/// Columns first … first + count − 1 of the line, from 0, as far as it has them, without the blanks
/// around what stands there.
struct word mf_words_columns(const char *line, size_t first, size_t count);

bool mf_words_same(const struct word *word, const char *text);

/// The same, whatever the case of letters.
bool mf_words_alike(const struct word *word, const char *text);

/// Whether the word is a finite number and nothing else; as strtod in the C locale, to the last
/// bit.
bool mf_words_number(const struct word *word, double *value);

/// What to ask a person whose line has no number where one is expected; "" if nothing is likely.
const char *mf_words_number_hint(const char *line);

/// Whether the word is a whole number that an int64_t can hold.
bool mf_words_integer(const struct word *word, int64_t *value);

/// Take `count` numbers from the line; false if there are fewer.
bool mf_words_numbers(const char **line, double *values, size_t count);

/// Copy a word to `text` of `size` bytes; false if it is too long.
bool mf_words_copy(const struct word *word, char *text, size_t size);

/// Copy line `number`, from 0, of the first bytes of a file to `line` of `size` bytes, as much of
/// it as there is room for; false if there is no such line.
bool mf_words_line(const unsigned char *begin, size_t bytes, size_t number, char *line,
                   size_t size);
