// SPDX-License-Identifier: GPL-3.0-or-later
//
// g(r) of the last iteration's samples beside its target, so that a fit can be seen while it works.
#include "inversion/inversion.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

#include <math.h>
#include <stdio.h>

enum { COLUMNS = 5 };

/// One pair type's bins, from `first` on: r, target, g, its standard error, S − S*.
static void fill(const struct inversion *inversion, size_t first, size_t bins,
                 double *const column[COLUMNS]) {
    const struct comoments *counts = &inversion->replicas.counts;
    const double independent = fmax(1, counts->count / inversion->inefficiency);
    for (size_t k = 0; k < bins; k++) {
        const size_t bin = first + k;
        column[0][k] = mf_rdf_bins_centre(&inversion->problem->targets.bins, k);
        column[1][k] = mf_inversion_target_g(inversion, bin);
        column[2][k] = mf_inversion_g(inversion, bin);
        column[3][k] =
            sqrt(mf_comoments_covariance(counts, bin, bin) / independent) / inversion->ideal[bin];
        column[4][k] = counts->mean[bin] - inversion->target_counts[bin];
    }
}

static void find_path(const struct inversion *inversion, size_t pair,
                      const struct inverse_folder *folder, char *path) {
    char kind[COMPOSITION_PAIR_NAME_SIZE], name[COMPOSITION_PAIR_NAME_SIZE + 16];
    mf_composition_pair_name(&inversion->composition, (int)pair, kind);
    snprintf(name, sizeof name, "rdf_now%s%s.tsv", kind[0] ? "_" : "", kind);
    folder->file(folder->context, name, path);
}

enum status mf_inversion_write(const void *state, const struct inverse_folder *folder) {
    const struct inversion *inversion = state;
    const size_t bins = inversion->grid.bins;
    enum status status = STATUS_OK;
    double *memory = NULL, *column[COLUMNS];
    char path[OUTPUT_PATH_SIZE];
    if (!(inversion->replicas.counts.count > 0))
        return STATUS_OK;
    NEW_ARRAY(memory, COLUMNS * bins);
    for (size_t c = 0; c < COLUMNS; c++)
        column[c] = memory + c * bins;
    const struct data_column columns[COLUMNS] = {{"r[lambda]", column[0], NULL},
                                                 {"target[1]", column[1], "%.8g"},
                                                 {"result[1]", column[2], "%.8g"},
                                                 {"result_error[1]", column[3], "%.3g"},
                                                 {"excess[1]", column[4], "%.6g"}};
    for (size_t pair = 0; pair < inversion->grid.pairs; pair++) {
        fill(inversion, pair * bins, bins, column);
        find_path(inversion, pair, folder, path);
        CHECK(mf_data_table_write_in(path, folder->units, NULL, columns, COLUMNS, bins));
    }
done:
    mf_memory_free(memory);
    return status;
}
