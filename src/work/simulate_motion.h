// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "motion" of a scene file: diffusion, as `mesofit simulate` measures and writes it.
#pragma once

#include "io/json.h"
#include "io/json_write.h"
#include "observe/measure.h"
#include "report/progress.h"
#include "input/units.h"

/// A scene without "motion" has this off, and it costs nothing.
struct simulate_motion {
    bool on;
    struct motion_plan plan;
    struct motion motion;
};

/// Read "motion" of a scene file; faults go to its document.
void mf_simulate_motion_read(struct simulate_motion *motion, struct json_object *root);

/// Write the settings as they were read; nothing if it is off.
void mf_simulate_motion_write_used(const struct simulate_motion *motion,
                                   struct json_writer *writer);

/// Make room for all samples that `measure` has time for.
/// Fails: BAD_INPUT if there is no time for one window; NO_MEMORY.
enum status mf_simulate_motion_begin(struct simulate_motion *motion,
                                     const struct simulation *simulation,
                                     const struct measure_plan *measure) MUST_USE;
void mf_simulate_motion_clear(struct simulate_motion *motion);

/// For measure_observables: NULL if it is off.
struct motion *mf_simulate_motion_target(struct simulate_motion *motion);

/// Spans of a checkpoint, MOTION_SPANS at most; returns their number.
size_t mf_simulate_motion_spans(struct simulate_motion *motion, struct memory_span *spans);

/// Write motion.tsv: time, MSD, VACF, each with its standard error. Fails: IO, NO_MEMORY.
enum status mf_simulate_motion_write_table(const struct simulate_motion *motion,
                                           const struct units *units, const char *file) MUST_USE;

/// Add the object "motion" to summary.json: diffusion coefficients with errors, in cm²/s too when
/// the units are known, and the test of the velocities; nothing if it is off.
void mf_simulate_motion_write_summary(const struct simulate_motion *motion,
                                      const struct units *units, struct json_writer *writer);

/// Say both diffusion coefficients, and a warning where they are not to be trusted.
void mf_simulate_motion_say(const struct simulate_motion *motion, struct progress *to);
