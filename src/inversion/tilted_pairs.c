// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/tilted_pairs.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

void mf_tilted_pairs_clear(struct tilted_pairs *pairs) {
    mf_cell_pairs_clear(&pairs->search);
    for (int d = 0; d < 3; d++)
        mf_memory_free(pairs->place[d]);
    mf_memory_free(pairs->counts);
    *pairs = (struct tilted_pairs){0};
}

static enum status reserve(struct tilted_pairs *pairs, size_t beads,
                           const struct pair_histogram *bins) {
    if (pairs->counts)
        return STATUS_OK;
    pairs->beads = beads;
    for (int d = 0; d < 3; d++)
        TRY_ARRAY(pairs->place[d], beads);
    TRY_ARRAY(pairs->counts, pair_histogram_size(bins));
    return STATUS_OK;
}

/// What a visitor needs.
struct work {
    const struct tilted_pairs *pairs;
    const struct composition *composition;
    const struct table *potential;
    const struct pair_histogram *bins;
    struct pair_sums *sums;
};

static void take(void *context, const struct cell_pairs_batch *batch) {
    const struct work *w = context;
    const uint32_t *id = w->pairs->search.cells.order;
    double squares[CELL_PAIRS_BATCH];
    mf_cell_pairs_squares(batch, squares);
    for (size_t k = 0; k < batch->count; k++) {
        const int pair =
            mf_composition_pair_of_ids(w->composition, id[batch->i], id[batch->begin + k]);
        const double r = sqrt(squares[k]), bin = (r - w->bins->low) / w->bins->width;
        double phi, slope;
        if (bin >= 0 && bin < (double)w->bins->bins)
            w->pairs->counts[(size_t)pair * w->bins->bins + (size_t)bin]++;
        if (!(r < table_cutoff(w->potential, pair)))
            continue;
        mf_table_evaluate_pair(w->potential, pair, r, &phi, &slope, NULL);
        w->sums->energy += phi;
        w->sums->virial -= r * slope;
    }
}

enum status mf_tilted_pairs_count(struct tilted_pairs *pairs, const struct box_vectors *box,
                                  double *const share[3], const struct composition *composition,
                                  const struct table *potential, const struct pair_histogram *bins,
                                  struct pair_sums *sums) {
    const size_t beads = (size_t)mf_composition_particles(composition);
    const double range = fmax(potential->cutoff, bins->low + bins->width * (double)bins->bins);
    const double half = 0.5 * mf_box_vectors_min_height(box);
    struct work work = {pairs, composition, potential, bins, sums};
    if (range > half)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the box is too small: half its shortest height, %g" STATUS_LENGTH
                              ", is below the cutoff %g" STATUS_LENGTH,
                              half, range);
    TRY(reserve(pairs, beads, bins));
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < beads; k++)
            pairs->place[d][k] = box_fraction(share[d][k], 1);
    memset(pairs->counts, 0, pair_histogram_size(bins) * sizeof *pairs->counts);
    *sums = (struct pair_sums){0};
    TRY(mf_cell_pairs_sort(&pairs->search, box, pairs->place, beads, range));
    mf_cell_pairs_visit(&pairs->search, take, &work);
    return STATUS_OK;
}
