// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Names: of records in a list, those that people give, and those that are reserved.
///
/// What a file may choose from (integrators, methods, families of curves, shapes, optimisers)
/// stands in a list: an array of pointers to records of one type, with NULL at its end. The first
/// member of each record is its name. Tested: test_names.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/// Said once where records of a type are looked for.
#define NAMED_RECORD(type)                                                                         \
    _Static_assert(offsetof(type, name) == 0, "the name is the first member of a record in a "     \
                                              "list")

/// The record of that name, or NULL.
/// @param[in] list  array of pointers to records
const void *mf_names_find(const void *list, const char *name);

/// All names of a list, with NULL at the end, in an array that the caller frees.
/// @param[in] before  a name that stands before them, or NULL: none does
/// Fails: NO_MEMORY.
enum status mf_names_collect(const void *list, const char *before, const char ***names) MUST_USE;

/// @name Names that people give
/// They become parts of files' names and of columns'.

/// Whether a name has 1 to `size` − 1 letters of ASCII, digits and characters of `marks`: "_" of
/// types, since "A-B" is a pair of them, "_-" of all others.
bool mf_names_is_plain(const char *name, const char *marks, size_t size);

/// What another program calls so, as such a name: what is no letter, digit or mark becomes "_".
void mf_names_adapt(const char *from, const char *marks, char *name, size_t size);

/// Whether two paths of keys are the same but for a pair of types in the other order:
/// "conservative.B-A.epsilon" and "conservative.A-B.epsilon".
bool mf_names_are_one_path(const char *a, const char *b);

/// @name Reserved names
/// Tables, columns and numbers of a result have words before and after the names of types, kinds,
/// groups and modes: potential_A-B_history.tsv, rdf_now_A-B.tsv, "backbone_error". A name that has
/// one itself is refused wherever names are read, so that what differs in its names differs in its
/// files: with a type "B_history" the history of A-B would be the potential of A with it.

/// For the message of who refuses.
#define NAMES_RESERVED                                                                             \
    "and does not begin with now_ or error_ nor end with _history, _flat, _error, _boltzmann, "    \
    "_lower or _upper, as the program's tables do"

/// The rule in messages, with how many characters there may be at most.
#define NAMES_OF_TYPE "up to %d letters, digits and _, " NAMES_RESERVED
#define NAMES_OF_OTHERS "up to %d letters, digits, _ and -, " NAMES_RESERVED

bool mf_names_is_reserved(const char *name);
