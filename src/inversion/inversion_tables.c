// SPDX-License-Identifier: GPL-3.0-or-later
//
// g(r) and p of groups of the last iteration's samples beside their targets, so that a fit can be
// seen while it works; S − S* of all iterations.
#include "inversion/inversion.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"
#include "problem/group_kind.h"

#include <math.h>
#include <stdio.h>

enum { COLUMNS = 5 };

/// `bins` values from `first` on, with their places: target, samples, standard error, S − S*.
static void fill(const struct inversion_state *state, size_t first, size_t bins,
                 double *const column[COLUMNS]) {
    const struct comoments *counts = &state->replicas.counts;
    const double independent = fmax(1, counts->count / state->inefficiency);
    for (size_t k = 0; k < bins; k++) {
        const size_t bin = first + k;
        const double unit = state->target.unit[bin];
        column[1][k] = state->target.counts[bin] / unit;
        column[2][k] = counts->mean[bin] / unit;
        column[3][k] = sqrt(mf_comoments_covariance(counts, bin, bin) / independent) / unit;
        column[4][k] = counts->mean[bin] - state->target.counts[bin];
    }
}

/// Of a pair type: "rdf_now_A-B.tsv", "excess_A-B_history.tsv".
static void find_path(const struct inversion_state *state, size_t pair, const char *name,
                      const char *end, const struct inverse_folder *folder, char *path) {
    char kind[COMPOSITION_PAIR_NAME_SIZE], file[COMPOSITION_PAIR_NAME_SIZE + 32];
    mf_composition_pair_name(&state->composition, (int)pair, kind);
    snprintf(file, sizeof file, "%s%s%s%s", name, kind[0] ? "_" : "", kind, end);
    folder->file(folder->context, file, path);
}

/// Columns of a table for each section of bins, of the longest one.
static enum status allocate_columns(const struct inversion_state *state, double **memory,
                                    double *column[COLUMNS]) {
    enum status status = STATUS_OK;
    size_t max = state->grid.bins;
    for (size_t g = 0; g < state->grid.groups; g++)
        if (state->grid.group[g].own.unknown->bins.count > max)
            max = state->grid.group[g].own.unknown->bins.count;
    NEW_ARRAY(*memory, COLUMNS * max);
    for (size_t c = 0; c < COLUMNS; c++)
        column[c] = *memory + c * max;
done:
    return status;
}

static enum status write_pairs(const struct inversion_state *state,
                               const struct inverse_folder *folder, double *column[COLUMNS]) {
    const size_t bins = state->grid.bins;
    const struct data_column columns[COLUMNS] = {{"r[lambda]", column[0], NULL},
                                                 {"target[1]", column[1], "%.8g"},
                                                 {"result[1]", column[2], "%.8g"},
                                                 {"result_error[1]", column[3], "%.3g"},
                                                 {"excess[1]", column[4], "%.6g"}};
    char path[OUTPUT_PATH_SIZE];
    for (size_t k = 0; k < bins; k++)
        column[0][k] = mf_rdf_bins_centre(&state->problem->targets.bins, k);
    for (size_t pair = 0; pair < state->grid.pairs; pair++) {
        if (state->grid.known_of[pair] == 0)
            continue;
        fill(state, pair * bins, bins, column);
        find_path(state, pair, "rdf_now", ".tsv", folder, path);
        TRY(mf_data_table_write_in(path, folder->units, NULL, columns, COLUMNS, bins));
    }
    return STATUS_OK;
}

/// p of a group: "now_bond_lengths_backbone.tsv".
static enum status write_group(const struct inversion_state *state, size_t g,
                               const struct inverse_folder *folder, double *column[COLUMNS]) {
    const struct simulation_setup *scene = &state->problem->scene;
    const struct potential_group *group = &state->grid.group[g];
    const struct bonded_unknown *unknown = group->own.unknown;
    const struct observable_target *about =
        mf_observable_kind(mf_group_kind_target(unknown->order)).target;
    char path[OUTPUT_PATH_SIZE], file[TOPOLOGY_NAME_SIZE + 64], names[3][64];
    static const char *const words[3] = {"target", "result", "result_error"};
    for (int k = 0; k < 3; k++)
        snprintf(names[k], sizeof names[k], "%s[%s]", words[k], about->unit);
    const struct data_column columns[COLUMNS] = {{about->argument, column[0], NULL},
                                                 {names[0], column[1], "%.8g"},
                                                 {names[1], column[2], "%.8g"},
                                                 {names[2], column[3], "%.3g"},
                                                 {"excess[1]", column[4], "%.6g"}};
    for (size_t k = 0; k < unknown->bins.count; k++)
        column[0][k] = bonded_bins_centre(&unknown->bins, k);
    fill(state, group->bin, unknown->bins.count, column);
    snprintf(file, sizeof file, "now_%s_%s.tsv", about->name, mf_group_kind_group(scene, unknown));
    folder->file(folder->context, file, path);
    return mf_data_table_write_in(path, folder->units, NULL, columns, COLUMNS, unknown->bins.count);
}

static enum status write_now(const struct inversion_state *state,
                             const struct inverse_folder *folder) {
    enum status status = STATUS_OK;
    double *memory = NULL, *column[COLUMNS];
    CHECK(allocate_columns(state, &memory, column));
    CHECK(write_pairs(state, folder, column));
    for (size_t g = 0; g < state->grid.groups; g++)
        CHECK(write_group(state, g, folder, column));
done:
    mf_memory_free(memory);
    return status;
}

/// A first column and then a column an iteration, named by its number.
/// @param[in] values  of the first iteration, the others `stride` numbers apart
static enum status write_iterations(const char *path, const struct units *units,
                                    struct data_column first, const double *values, size_t stride,
                                    size_t iterations, size_t rows) {
    enum { NAME_SIZE = 24 };
    enum status status = STATUS_OK;
    struct data_column *columns = NULL;
    char *names = NULL;
    NEW_ARRAY(columns, iterations + 1);
    NEW_ARRAY(names, iterations * NAME_SIZE);
    columns[0] = first;
    for (size_t k = 0; k < iterations; k++) {
        snprintf(names + k * NAME_SIZE, NAME_SIZE, "%zu", k);
        columns[k + 1] = (struct data_column){names + k * NAME_SIZE, values + k * stride, "%.6g"};
    }
    CHECK(mf_data_table_write_in(path, units, NULL, columns, iterations + 1, rows));
done:
    mf_memory_free(columns);
    mf_memory_free(names);
    return status;
}

static enum status write_excess(const struct inversion *inversion,
                                const struct inverse_folder *folder) {
    const struct inversion_state *first = inversion->state;
    const struct inversion_history *history = &inversion->history;
    const size_t bins = first->grid.bins;
    char path[OUTPUT_PATH_SIZE];
    for (size_t pair = 0; pair < first->grid.pairs; pair++) {
        if (first->grid.known_of[pair] == 0)
            continue;
        const struct data_column r = {
            "r[lambda]", first->grid.r + mf_potential_grid_block(&first->grid, pair), NULL};
        find_path(first, pair, "excess", "_history.tsv", folder, path);
        TRY(write_iterations(path, folder->units, r, history->excess + pair * bins, history->bins,
                             history->iterations, bins));
    }
    return STATUS_OK;
}

enum status mf_inversion_write(const void *memory, const struct inverse_folder *folder) {
    const struct inversion *inversion = memory;
    if (!(inversion->state->replicas.counts.count > 0))
        return STATUS_OK;
    TRY(write_now(inversion->state, folder));
    return write_excess(inversion, folder);
}
