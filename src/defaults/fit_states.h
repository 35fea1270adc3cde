// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "states" of a run file: several systems that share what is to be found.
///
///   "states": {"dilute": {"scene": {"density": 2}, "target": {"rdf": {"file": "rdf_2.tsv"}}}, …}
///
/// The run file merged with what a state says (RFC 7396) is the run file of that state. Each has
/// a struct fit_file of its own; the first is that of the run.
#pragma once

#include "defaults/fit_file.h"

/// Make a document that of its state number n, if it has states.
/// @param[out] name   of the state, shape [FIT_STATE_NAME_SIZE]; "" without states
/// @param[out] count  states; 0: none
/// Fails: BAD_INPUT if states are none, too many, or have names that no folder should have;
/// NO_MEMORY.
enum status mf_fit_states_take(struct json_document *document, const char *file, size_t n,
                               char *name, size_t *count) MUST_USE;

/// State number s, the run itself being 0, of mf_fit_states_count.
size_t mf_fit_states_count(const struct fit_file *fit);
struct fit_file *mf_fit_states_at(struct fit_file *fit, size_t s);

/// Let the problems of all states know each other, with a seed for each.
void mf_fit_states_link(struct fit_file *fit);

/// Whether the states can share a potential, and the method knows them. Fails: BAD_INPUT.
enum status mf_fit_states_check(const struct fit_file *fit, const char *file) MUST_USE;

/// Divide the targets of all states by their normalisations. Fails: NO_MEMORY.
enum status mf_fit_states_normalise(struct fit_file *fit) MUST_USE;

/// Begin the message of a failure with the state that it is about. Returns `status`.
enum status mf_fit_states_mark(const struct fit_file *fit, enum status status);

/// Give the targets of each group that is to be found the bins of all states: what one state has
/// not seen has p = 0 there. Fails: BAD_INPUT if the states do not look for the same groups, or
/// their bins do not meet; NO_MEMORY.
enum status mf_fit_states_widen(struct fit_file *fit, const char *file) MUST_USE;
