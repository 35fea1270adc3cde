// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a scene file asks to be measured: all of the list that it names or that always is.
#pragma once

#include "dynamics/simulation_change.h"
#include "io/json.h"
#include "io/json_write.h"
#include "io/units_scale.h"
#include "observe/caller_observable.h"
#include "observe/measure.h"
#include "report/progress.h"
#include "report/run_folder.h"

struct simulate_observables {
    /// Settings are NULL of one without any.
    struct observable_use use[OBSERVABLES_MAX + CALLER_OBSERVABLES_MAX + 1];
};

/// Read the objects of a scene file; faults go to its document. Fails: NO_MEMORY.
/// @param[in] lonely  whether there are fewer than two particles, of which little can be measured
enum status mf_simulate_observables_read(struct simulate_observables *observables,
                                         struct json_object *root,
                                         const struct simulation_setup *setup) MUST_USE;
/// Whether it is among them.
bool mf_simulate_observables_has(const struct simulate_observables *observables,
                                 const struct observable *observable);

/// Add those of who calls the library. Fails: BAD_INPUT, NO_MEMORY.
enum status mf_simulate_observables_add(struct simulate_observables *observables,
                                        const struct caller_observables *callers) MUST_USE;
void mf_simulate_observables_clear(struct simulate_observables *observables);

/// Mix into a digest which functions of the caller's there are, of which no setting tells.
void mf_simulate_observables_digest(const struct simulate_observables *observables,
                                    uint64_t *digest);

/// Write the settings as they were read.
void mf_simulate_observables_write_used(const struct simulate_observables *observables,
                                        struct json_writer *writer);

/// Fails: as the records' `begin`.
enum status mf_simulate_observables_begin(struct simulate_observables *observables,
                                          struct simulation *simulation,
                                          const struct measure_plan *plan) MUST_USE;

/// Forget all that was measured, and begin once more.
enum status mf_simulate_observables_restart(struct simulate_observables *observables,
                                            struct simulation *simulation,
                                            const struct measure_plan *plan) MUST_USE;

/// Tell those that write while they measure where their files go.
void mf_simulate_observables_open(const struct simulate_observables *observables,
                                  const struct observable_results *results);

/// Refuse now a table that could not be written. Fails: as mf_run_folder_reserve.
enum status mf_simulate_observables_reserve(const struct simulate_observables *observables,
                                            const struct composition *composition,
                                            struct run_folder *folder) MUST_USE;

enum {
    SIMULATE_MAX_SPANS =
        SIMULATION_SPANS + (OBSERVABLES_MAX + CALLER_OBSERVABLES_MAX) * OBSERVABLE_MAX_SPANS
};

/// Spans of a checkpoint, the simulation's first; returns their number.
size_t mf_simulate_observables_spans(struct simulate_observables *observables,
                                     struct simulation *simulation, struct memory_span *spans);

/// Restore all of a checkpoint.
/// @param[in] first  the span before those
/// Fails: as mf_checkpoint_load; NO_MEMORY.
enum status mf_simulate_observables_load(struct simulate_observables *observables,
                                         struct simulation *simulation, const char *file,
                                         uint64_t digest, const struct memory_span *first) MUST_USE;

/// Write all tables. Fails: IO, NO_MEMORY.
enum status mf_simulate_observables_write(const struct simulate_observables *observables,
                                          const struct observable_results *results) MUST_USE;

/// Add all numbers to summary.json.
void mf_simulate_observables_write_summary(const struct simulate_observables *observables,
                                           const struct observable_results *results,
                                           struct json_writer *writer);

/// Whether the simulation is what the scene says. Fails: UNCONVERGED, as a fit whose verification
/// is not, if one of its observables is assessed as unstable.
enum status mf_simulate_observables_judge(const struct simulate_observables *observables,
                                          const struct observable_results *results) MUST_USE;

/// Say what a person is to know, and what is not to be trusted.
void mf_simulate_observables_print(const struct simulate_observables *observables,
                                   const struct observable_results *results, struct progress *to);

// What a person has changed of a simulation while it ran
// -------------------------------------------

enum { SIMULATE_CHANGES_MAX = 256 };

/// The last ones; plain data, which a checkpoint keeps.
struct simulate_changes {
    size_t count; ///< that are kept
    struct simulation_change change[SIMULATE_CHANGES_MAX];
};

/// Keep one more: where nothing has passed since the last one, in its place. False if there are too
/// many.
bool mf_simulate_changes_add(struct simulate_changes *changes,
                             const struct simulation_change *change);

/// The last one, or NULL.
const struct simulation_change *mf_simulate_changes_last(const struct simulate_changes *changes);

/// Put "changed", a list, if there are any. Tested: tests/live/test_changes.py.
void mf_simulate_changes_write(const struct simulate_changes *changes, struct json_writer *writer);

/// Say what the last one is.
void mf_simulate_changes_print(const struct simulate_changes *changes, const struct units *units,
                               struct progress *to);
