// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_output.h"

#include "io/json_write.h"
#include "io/units.h"
#include "mesofit.h"
#include "observe/kirkwood_buff.h"
#include "observe/measure.h"

#include <math.h>

/// The digest of a file's frames, as a text: not every reader of JSON knows integers of 64 bits.
static void put_digest(struct json_writer *writer, uint64_t digest) {
    char text[24];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)digest);
    mf_json_put_text(writer, "digest", text);
}

/// "trajectories": {"1": {"file": …, "bytes": …, …}, "2": …}
static void put_trajectories(const struct measure_result *result, struct json_writer *writer) {
    mf_json_begin(writer, "trajectories");
    for (size_t k = 0; k < result->request->frames.files; k++) {
        const struct frames_source *const source = &result->frames->source[k];
        char number[24];
        snprintf(number, sizeof number, "%zu", k + 1);
        mf_json_begin(writer, number);
        mf_json_put_text(writer, "file", result->request->frames.file[k]);
        mf_json_put_integer(writer, "bytes", (int64_t)source->bytes);
        mf_json_put_integer(writer, "frames", (int64_t)source->read);
        mf_json_put_integer(writer, "frames_used", (int64_t)source->used);
        mf_json_put_integer(writer, "frames_doubled", (int64_t)source->doubled);
        put_digest(writer, source->digest);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

static enum status write_json(const struct measure_result *result, const char *name,
                              struct json_writer *writer) {
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.*s/%s", OUTPUT_PATH_SIZE - 64, result->folder, name);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}

/// Number density of all beads [1/nm³].
static double find_density(const struct measure_result *result) {
    const struct box box = mf_measured_box(result->measured);
    return (double)result->mapping->beads / mf_box_volume(&box);
}

// summary.json ------------------------------------------------------------------------------------

static void put_density(const struct measure_result *result, struct json_writer *writer) {
    const struct series *const volume = &result->measured->volume;
    const double density = find_density(result), mean = mf_series_mean(volume);
    const double error = density * mf_series_error(volume) / mean;
    mf_json_put_quantity(writer, "density", "1/lambda^3", density);
    mf_json_put_quantity(writer, "density_error", "1/lambda^3", error);
    mf_json_put_quantity(writer, "volume", "lambda^3", mean);
}

static enum status write_summary(const struct measure_result *result) {
    struct json_writer *writer = mf_json_writer_create();
    mf_json_put_text(writer, "status",
                     mf_status_name(result->interrupted ? STATUS_INTERRUPTED : STATUS_OK));
    mf_json_put_text(writer, "method", "measure");
    mf_units_write_summary(&result->units, writer);
    mf_json_put_number(writer, "seconds", result->seconds);
    mf_json_put_integer(writer, "frames", (int64_t)result->measured->frames);
    mf_json_put_integer(writer, "particles", (int64_t)result->mapping->beads);
    put_density(result, writer);
    put_trajectories(result, writer);
    mf_json_put_text(writer, "version", MESOFIT_VERSION);
    return write_json(result, "summary.json", writer);
}

// target.json -------------------------------------------------------------------------------------

static void put_rdf_file(const struct measure_result *result, struct json_writer *writer,
                         const char *file) {
    mf_json_put_text(writer, "file", file);
    mf_json_put_integer(writer, "particles", (int64_t)result->mapping->beads);
}

static void put_rdf(const struct measure_result *result, struct json_writer *writer) {
    const struct composition *const composition = &result->measured->pairs.composition;
    mf_json_begin(writer, "rdf");
    if (!composition_is_mixed(composition))
        put_rdf_file(result, writer, "rdf.tsv");
    for (int pair = 0;
         composition_is_mixed(composition) && pair < mf_composition_pairs(composition); pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE], file[COMPOSITION_PAIR_NAME_SIZE + 16];
        mf_composition_pair_name(composition, pair, name);
        snprintf(file, sizeof file, "rdf_%s.tsv", name);
        mf_json_begin(writer, name);
        put_rdf_file(result, writer, file);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

static enum status write_target(const struct measure_result *result) {
    struct json_writer *writer = mf_json_writer_create();
    mf_json_put_text(writer, "title", result->request->frames.file[0]);
    mf_json_put_text(writer, "units", mf_units_systems[result->units.system]);
    mf_json_writer_speak(writer, &result->units);
    mf_json_begin(writer, "target");
    put_rdf(result, writer);
    mf_json_end(writer);
    mf_json_begin(writer, "scene");
    mf_json_put_quantity(writer, "density", "1/lambda^3", find_density(result));
    mf_json_end(writer);
    return write_json(result, "target.json", writer);
}

static enum status write_used(const struct measure_result *result) {
    const struct measured_plan *const plan = &result->measured->plan;
    struct json_writer *writer = mf_json_writer_create();
    put_trajectories(result, writer);
    mf_json_put_number(writer, "range", plan->range);
    mf_json_put_integer(writer, "bins", plan->bins);
    return write_json(result, "used.json", writer);
}

static enum status write_tables(const struct measure_result *result) {
    const struct simulation_setup setup = {.box = mf_measured_box(result->measured)};
    const struct measure_plan plan = {.samples = (int64_t)result->measured->frames};
    const struct observable_results results = {&setup, &plan, &result->units, result->folder};
    return mf_rdf_observable.write(&result->measured->rdf, &results);
}

enum status mf_measure_output_write(const struct measure_result *result) {
    TRY(write_used(result));
    TRY(write_tables(result));
    TRY(write_target(result));
    return write_summary(result);
}
