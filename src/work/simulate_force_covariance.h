// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "force_covariance" of a scene file: the friction weight as the forces show it.
#pragma once

#include "io/json.h"
#include "io/json_write.h"
#include "observe/measure.h"

/// A scene without "force_covariance" has this off, and it costs nothing.
struct simulate_force_covariance {
    bool on;
    struct force_covariance_plan plan;
    struct force_covariance covariance;
};

/// Read "force_covariance" of a scene file; faults go to its document.
void mf_simulate_force_covariance_read(struct simulate_force_covariance *covariance,
                                       struct json_object *root);

/// Write the settings as they were read; nothing if it is off.
void mf_simulate_force_covariance_write_used(const struct simulate_force_covariance *covariance,
                                             struct json_writer *writer);

/// Fails: BAD_INPUT where it would mean nothing (mf_force_covariance_init); NO_MEMORY.
enum status mf_simulate_force_covariance_begin(struct simulate_force_covariance *covariance,
                                               const struct simulation *simulation,
                                               const struct measure_plan *measure) MUST_USE;
void mf_simulate_force_covariance_clear(struct simulate_force_covariance *covariance);

/// For measure_observables: NULL if it is off.
struct force_covariance *
mf_simulate_force_covariance_target(struct simulate_force_covariance *covariance);

/// Spans of a checkpoint, FORCE_COVARIANCE_SPANS at most; returns their number.
size_t mf_simulate_force_covariance_spans(struct simulate_force_covariance *covariance,
                                          struct memory_span *spans);

/// Write force_covariance.tsv: r, κ with its standard error. Fails: IO, NO_MEMORY.
enum status
mf_simulate_force_covariance_write_table(const struct simulate_force_covariance *covariance,
                                         const char *file) MUST_USE;
