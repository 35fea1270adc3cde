// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Functions of the caller's, as observables of a simulation.
#pragma once

#include "mesofit/run.h"
#include "observe/caller_observable.h"

/// @param[in] given  shape [count], borrowed as long as `callers`
/// Fails: BAD_INPUT if there are too many, or one has no function.
enum status mf_run_observables_begin(struct caller_observables *callers,
                                     const struct mesofit_named_observable *given,
                                     size_t count) MUST_USE;
