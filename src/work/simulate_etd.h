// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "etd" of a scene file: escape times of pairs, as `mesofit simulate` measures and writes
/// them.
#pragma once

#include "io/json.h"
#include "io/json_write.h"
#include "observe/measure.h"

/// A scene without "etd" has this off, and it costs nothing.
struct simulate_etd {
    bool on;
    struct etd_grid grid;
    struct etd_plan plan;
    struct etd etd;
    double interval; ///< between times [τ]
};

/// Read "etd" of a scene file; faults go to its document.
void mf_simulate_etd_read(struct simulate_etd *etd, struct json_object *root);

/// Write the settings as they were read; nothing if it is off.
void mf_simulate_etd_write_used(const struct simulate_etd *etd, struct json_writer *writer);

/// Make room for all samples that `measure` has time for.
/// Fails: BAD_INPUT if there is no time for one window, or no room in the box; NO_MEMORY.
enum status mf_simulate_etd_begin(struct simulate_etd *etd, const struct simulation *simulation,
                                  const struct measure_plan *measure) MUST_USE;
void mf_simulate_etd_clear(struct simulate_etd *etd);

/// For measure_observables: NULL if it is off.
struct etd *mf_simulate_etd_target(struct simulate_etd *etd);

/// Spans of a checkpoint, ETD_SPANS or none; returns their number. As mf_etd_spans says, the first
/// is to be read, followed by mf_etd_make_room, before the others are asked for.
size_t mf_simulate_etd_spans(struct simulate_etd *etd, struct memory_span *spans);

/// Write, into `folder`, etd.tsv and etd_error.tsv: time, then E or its standard error for each bin
/// of r_0, nan where no pair began; and etd_bins.tsv: r_0, pairs. Fails: IO, NO_MEMORY.
enum status mf_simulate_etd_write_tables(const struct simulate_etd *etd,
                                         const char *folder) MUST_USE;

/// Add the object "etd" to summary.json; nothing if it is off.
void mf_simulate_etd_write_summary(const struct simulate_etd *etd, struct json_writer *writer);
