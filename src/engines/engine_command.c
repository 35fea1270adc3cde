// SPDX-License-Identifier: GPL-3.0-or-later
//
// Any engine: tables and a description of the piece are there when the command begins, a trajectory
// and perhaps sample.json when it has ended.
#include "base/memory.h"
#include "curves/table.h"
#include "engines/engine.h"
#include "engines/engine_folder.h"
#include "engines/engine_model.h"
#include "export/export_engine.h"
#include "io/json.h"
#include "io/json_write.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

static const char description[] = "engine.json", answer[] = "sample.json";

enum { ROWS = 2000 }; // of each table

/// Nearest distance of a table, as a share of its range.
static const double nearest = 0.01;

/// A piece as it is written.
struct job {
    const struct engine_run *run;
    const struct engine_piece *piece;
    int pair; ///< whose table is written
};

// Files of a piece --------------------------------------------------------------------------------

/// "potential.tsv", of a mixture "potential_A-B.tsv", as a fit writes them.
static void name_table(const struct job *job, char name[COMPOSITION_PAIR_NAME_SIZE + 16]) {
    char types[COMPOSITION_PAIR_NAME_SIZE];
    mf_composition_pair_name(&job->run->fit->scene.setup.composition, job->pair, types);
    snprintf(name, COMPOSITION_PAIR_NAME_SIZE + 16, "potential%s%s.tsv", types[0] ? "_" : "",
             types);
}

static void print_table(const void *memory, FILE *stream) {
    const struct job *job = memory;
    const struct units *units = &job->run->fit->scene.units;
    const struct table *potential = job->piece->potential;
    static const char *const unit[] = {"lambda", "k_B T_0", "k_B T_0/lambda"};
    double factor[3];
    char name[3][UNITS_NAME_SIZE];
    for (int k = 0; k < 3; k++) {
        factor[k] = mf_units_factor(units, unit[k]);
        mf_units_name(units, unit[k], name[k]);
    }
    fprintf(stream, "# r[%s]\tphi[%s]\tforce[%s]\n", name[0], name[1], name[2]);
    for (int k = 0; k < ROWS; k++) {
        const double share = nearest + (1 - nearest) * k / (ROWS - 1);
        const double r = table_cutoff(potential, job->pair) * share;
        double phi = 0, slope = 0;
        if (k < ROWS - 1)
            mf_table_evaluate_pair(potential, job->pair, r, &phi, &slope, NULL);
        fprintf(stream, "%.12g\t%.12g\t%.12g\n", r * factor[0], phi * factor[1],
                -slope * factor[2]);
    }
}

/// How many beads of each type there are, in their order.
static void write_beads(const struct engine_run *run, struct json_writer *writer) {
    const struct simulation_setup *setup = &run->fit->scene.setup;
    const struct composition *composition = &setup->composition;
    mf_json_begin(writer, "beads");
    for (int type = 0; type < composition->types; type++)
        mf_json_write_integer(writer, composition->name[type][0] ? composition->name[type] : "A",
                              composition->count[type]);
    if (composition->types == 0)
        mf_json_write_integer(writer, "A", setup->placement.count);
    mf_json_end(writer);
}

/// What is asked for.
static void describe(const struct job *job, struct json_writer *writer) {
    const struct engine_run *run = job->run;
    const struct engine_piece *piece = job->piece;
    const struct simulation_setup *setup = &run->fit->scene.setup;
    char before[OUTPUT_PATH_SIZE];
    snprintf(before, sizeof before, "../../%04llu/%02zu", (unsigned long long)piece->number - 1,
             piece->replica + 1);
    mf_json_writer_set_units(writer, &run->fit->scene.units);
    mf_json_write_integer(writer, "piece", (int64_t)piece->number);
    mf_json_write_integer(writer, "replica", (int64_t)piece->replica + 1);
    mf_json_write_integer(writer, "seed",
                          (int64_t)((piece->seed + piece->number) % (INT32_MAX - 1)) + 1);
    mf_json_write_quantity(writer, "temperature", "T_0", piece->temperature);
    mf_json_write_quantities(writer, "box", "lambda", setup->box.length,
                             (size_t)setup->box.dimensions);
    write_beads(run, writer);
    mf_json_write_integer(writer, "equilibration", (int64_t)engine_steps(run, piece->lead));
    mf_json_write_integer(writer, "frames", (int64_t)piece->frames);
    mf_json_write_integer(writer, "every", (int64_t)engine_steps(run, piece->every));
    mf_json_write_text(writer, "trajectory", run->settings->frames);
    if (!piece->fresh)
        mf_json_write_text(writer, "before", before);
}

static void print_description(const void *memory, FILE *stream) {
    struct json_writer *writer = mf_json_writer_create();
    if (writer)
        describe(memory, writer);
    if (writer == NULL || mf_json_write_stream(writer, stream, description) != STATUS_OK)
        fprintf(stream, "\n");
    mf_json_writer_free(writer);
}

/// The same tables as `export` writes them for the engine that the command drives.
static enum status write_tables(const struct engine_run *run, const struct engine_piece *piece,
                                const char *folder) {
    OWNED struct export_model *model = NULL;
    struct export_job job = {.folder = folder};
    if (run->settings->tables == 0)
        return STATUS_OK;
    TRY(mf_export_find(mf_sampling_engine_tables[run->settings->tables], &job.engine));
    TRY_ARRAY(model, 1);
    mf_engine_model(run, piece, model);
    job.model = model;
    job.units = mf_export_units(job.engine->system, &run->fit->scene.units, job.engine->physical);
    TRY(mf_export_grids_make(&job.grids, job.engine->interpolation, model, false,
                             job.engine->one_cutoff ? piece->potential->cutoff : 0));
    const enum status status = job.engine->tables(&job);
    mf_export_grids_clear(&job.grids);
    return status;
}

static enum status write_piece(const struct engine_run *run, const struct engine_piece *piece,
                               const char *folder) {
    struct job job = {run, piece, 0};
    for (; job.pair < mf_composition_pairs(&run->fit->scene.setup.composition); job.pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE + 16];
        name_table(&job, name);
        TRY(mf_engine_write(folder, name, print_table, &job));
    }
    TRY(write_tables(run, piece, folder));
    return mf_engine_write(folder, description, print_description, &job);
}

// What comes back ---------------------------------------------------------------------------------

static const char *name_frames(const struct engine_run *run) {
    return run->settings->frames;
}

/// Its last line.
static const char *find_reason(char *text) {
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\n", text[length - 1]))
        text[--length] = '\0';
    const char *newline = strrchr(text, '\n');
    return length == 0 ? NULL : newline ? newline + 1 : text;
}

/// The numbers of a key, one of each frame.
static enum status read_list(struct json_object *root, const char *key, double factor, size_t rows,
                             double **list) {
    const size_t count = (size_t)mf_json_count(root, key);
    if (!mf_json_has(root, key))
        return STATUS_OK;
    if (count != rows)
        mf_json_fault(root, key, "expected a list of %zu numbers, one of each frame, found %zu",
                      rows, count);
    TRY_ARRAY(*list, count + 1);
    (void)mf_json_list_numbers(root, key, *list, count);
    for (size_t k = 0; k < count; k++)
        (*list)[k] /= factor;
    return STATUS_OK;
}

static enum status read_answer(const struct engine_run *run, const struct engine_piece *piece,
                               struct json_document *document, struct engine_numbers *numbers) {
    const struct units *units = &run->fit->scene.units;
    const char *volume =
        run->fit->scene.setup.box.dimensions == 2 ? "k_B T_0/lambda^2" : "k_B T_0/lambda^3";
    struct json_object root = mf_json_root(document);
    numbers->rows = piece->frames;
    TRY(read_list(&root, "temperature", mf_units_factor(units, "T_0"), numbers->rows,
                  &numbers->temperature));
    TRY(read_list(&root, "pressure", mf_units_factor(units, volume), numbers->rows,
                  &numbers->pressure));
    TRY(read_list(&root, "pair_energy", mf_units_factor(units, "k_B T_0"), numbers->rows,
                  &numbers->energy));
    mf_json_finish(&root);
    return STATUS_OK;
}

static enum status read_numbers(const struct engine_run *run, const struct engine_piece *piece,
                                const char *folder, struct engine_numbers *numbers) {
    struct json_document *document;
    char path[OUTPUT_PATH_SIZE];
    struct stat found;
    mf_engine_path(folder, answer, path);
    if (stat(path, &found) != 0)
        return STATUS_OK;
    TRY(mf_json_open(&document, path));
    return mf_json_close(document, read_answer(run, piece, document, numbers));
}

const struct engine_tongue mf_engine_command = {
    .write = write_piece, .reason = find_reason, .frames = name_frames, .numbers = read_numbers};
