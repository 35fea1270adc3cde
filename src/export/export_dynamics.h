// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What of a result's dynamics another engine will run, and what that costs: as numbers of
/// two simulations, in a block that the program prints and that the files carry.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stdio.h>

struct export_job;
struct export_request;
struct progress;

/// What an engine does of its own, without a change of its input: nothing, the friction of the
/// result, the nearest that it has (--project), or a bath of each bead.
enum export_motion { EXPORT_TABLES_ALONE, EXPORT_OWN_FRICTION, EXPORT_PROJECTED, EXPORT_BATH };

/// Whether the engine of this machine has the style of the friction.
enum export_here { EXPORT_NOT_ASKED, EXPORT_HERE, EXPORT_NOT_HERE, EXPORT_NO_PROGRAM };

/// Decide what the engine will run, and simulate what that changes. In passing a failure is no
/// fault of the export: it is told in the block. Fails: INTERRUPTED; NO_MEMORY; with --project as
/// mf_export_project.
enum status mf_export_dynamics_find(struct export_job *job,
                                    const struct export_request *request) MUST_USE;

/// Whether the engine runs friction between pairs of its own.
bool mf_export_dynamics_pairs(const struct export_job *job);

/// The block, each line after `prefix`: "# " in a script.
void mf_export_dynamics_print(const struct export_job *job, const char *prefix, FILE *stream);

/// The same for a person.
void mf_export_dynamics_tell(const struct export_job *job, struct progress *progress);

/// Details for the README, and both E(t, r_0) as a table, of a projection.
void mf_export_dynamics_explain(const struct export_job *job, FILE *stream);
void mf_export_dynamics_escapes(const struct export_job *job, FILE *stream);

/// What a bath keeps of the result, two lines of the README.
const char *mf_export_dynamics_kept(const struct export_job *job);

/// The engine's own name of its friction between pairs.
const char *mf_export_dynamics_friction(const struct export_job *job);
