// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Words that tables, columns and numbers of a result have before and behind the names of
/// types, kinds, groups and modes: potential_A-B_history.tsv, rdf_now_A-B.tsv, "backbone_error".
///
/// A name that has one itself is refused wherever names are read, so that what differs in its names
/// differs in its files: with a type "B_history" the history of A-B would be the potential of A
/// with it.
#pragma once

#include <stdbool.h>

/// For the message of who refuses.
#define OWN_WORDS                                                                                  \
    "and does not begin with now_ or error_ nor end with _history, _flat, _error, _boltzmann, "    \
    "_lower or _upper, as the program's tables do"

/// Whether a name begins or ends so. Tested: test_own_words.
bool mf_own_words_has(const char *name);
