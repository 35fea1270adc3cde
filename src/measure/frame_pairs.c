// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_pairs.h"

#include "base/memory.h"
#include "base/simd.h"

#include <math.h>
#include <string.h>

void mf_frame_pairs_clear(struct frame_pairs *pairs) {
    mf_cell_pairs_clear(&pairs->search);
    mf_memory_free(pairs->type);
    mf_memory_free(pairs->molecule);
    mf_memory_free(pairs->counts);
    mf_memory_free(pairs->within);
    *pairs = (struct frame_pairs){0};
}

static size_t find_beads(const struct frame_pairs_plan *plan) {
    return (size_t)mf_composition_particles(&plan->composition);
}

static size_t find_counts(const struct frame_pairs_plan *plan) {
    return (size_t)mf_composition_pairs(&plan->composition) * (plan->bins + 1);
}

static enum status reserve(struct frame_pairs *pairs, const struct frame_pairs_plan *plan) {
    if (pairs->counts)
        return STATUS_OK;
    TRY_ARRAY(pairs->type, find_beads(plan));
    TRY_ARRAY(pairs->molecule, find_beads(plan));
    TRY_ARRAY(pairs->counts, find_counts(plan));
    if (plan->within)
        TRY_ARRAY(pairs->within, find_counts(plan));
    return STATUS_OK;
}

/// Sort the beads and their attributes.
static enum status sort(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                        double range, const struct box_vectors *box, int32_t *const place[3]) {
    const size_t beads = find_beads(plan);
    TRY(reserve(pairs, plan));
    TRY(mf_cell_pairs_sort(&pairs->search, box, place, beads, range));
    const uint32_t *bead = pairs->search.cells.order;
    for (size_t k = 0; composition_is_mixed(&plan->composition) && k < beads; k++)
        pairs->type[k] = mf_composition_type(&plan->composition, bead[k]);
    for (size_t k = 0; plan->molecule && k < beads; k++)
        pairs->molecule[k] = plan->molecule[bead[k]];
    return STATUS_OK;
}

// Counts ------------------------------------------------------------------------------------------

struct work {
    struct frame_pairs *pairs;
    const struct frame_pairs_plan *plan;
    double per_length; ///< bins [1/nm]
};

/// Bins of the distances; what is beyond the range is in the bin after the last.
SIMD_CLONES static void find_bins(const struct cell_pairs_batch *batch, double per_length,
                                  double bins, int32_t *restrict bin) {
    const struct cell_pairs_batch b = *batch;
    for (size_t k = 0; k < b.count; k++) {
        const double place = sqrt(cell_pairs_square(&b, k)) * per_length;
        bin[k] = (int32_t)(place < bins ? place : bins);
    }
}

/// Where the pairs of bead i with each type are counted.
static void list_offsets(const struct work *work, size_t i, size_t offset[COMPOSITION_MAX_TYPES]) {
    const struct composition *composition = &work->plan->composition;
    for (int type = 0; type < composition->types; type++)
        offset[type] = (size_t)mf_composition_pair(composition, work->pairs->type[i], type) *
                       (work->plan->bins + 1);
}

/// Where the pairs of two types, of beads in the order of cells, are counted.
static size_t offset_of(const struct work *work, size_t i, size_t j) {
    const struct composition *composition = &work->plan->composition;
    if (!composition_is_mixed(composition))
        return 0;
    return (size_t)mf_composition_pair(composition, work->pairs->type[i], work->pairs->type[j]) *
           (work->plan->bins + 1);
}

/// Pairs of one molecule go where nobody looks, or are counted apart.
static void leave_out(const struct work *work, size_t i, size_t begin, size_t count, int32_t *bin) {
    const uint32_t *molecule = work->pairs->molecule + begin, own = work->pairs->molecule[i];
    for (size_t k = 0; work->pairs->within && k < count; k++)
        if (molecule[k] == own)
            work->pairs->within[offset_of(work, i, begin + k) + (size_t)bin[k]]++;
    for (size_t k = 0; k < count; k++)
        bin[k] = molecule[k] == own ? (int32_t)work->plan->bins : bin[k];
}

static void count_batch(void *context, const struct cell_pairs_batch *batch) {
    const struct work *const work = context;
    uint64_t *counts = work->pairs->counts;
    const int32_t *type = work->pairs->type + batch->begin;
    size_t offset[COMPOSITION_MAX_TYPES];
    int32_t bin[CELL_PAIRS_BATCH];
    find_bins(batch, work->per_length, (double)work->plan->bins, bin);
    if (work->plan->molecule)
        leave_out(work, batch->i, batch->begin, batch->count, bin);
    if (!composition_is_mixed(&work->plan->composition)) {
        for (size_t k = 0; k < batch->count; k++)
            counts[bin[k]]++;
        return;
    }
    list_offsets(work, batch->i, offset);
    for (size_t k = 0; k < batch->count; k++)
        counts[offset[type[k]] + (size_t)bin[k]]++;
}

enum status mf_frame_pairs_count(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                 const struct box_vectors *box, int32_t *const place[3]) {
    struct work work = {pairs, plan, (double)plan->bins / plan->range};
    TRY(sort(pairs, plan, plan->range, box, place));
    memset(pairs->counts, 0, find_counts(plan) * sizeof *pairs->counts);
    if (pairs->within)
        memset(pairs->within, 0, find_counts(plan) * sizeof *pairs->within);
    mf_cell_pairs_visit(&pairs->search, count_batch, &work);
    return STATUS_OK;
}

void mf_frame_pairs_exclude(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                            int32_t *const place[3], uint32_t (*excluded)[2], size_t count) {
    const double per_length = (double)plan->bins / plan->range;
    for (size_t n = 0; n < count; n++) {
        const uint32_t i = excluded[n][0], j = excluded[n][1];
        const struct cell_pairs_batch one = mf_cell_pairs_one(&pairs->search, place, i, j);
        const int pair = mf_composition_pair_of_ids(&plan->composition, i, j);
        int32_t bin;
        find_bins(&one, per_length, (double)plan->bins, &bin);
        if ((size_t)bin < plan->bins)
            pairs->within[(size_t)pair * (plan->bins + 1) + (size_t)bin]--;
    }
    for (size_t n = 0; n < find_counts(plan); n++)
        pairs->within[n] += pairs->counts[n];
}

// Weights -----------------------------------------------------------------------------------------

struct weighing {
    const struct frame_pairs *pairs;
    const struct weighted_density_settings *settings;
    bool apart; ///< pairs of one molecule are left out
    double *density;
};

static void weigh_batch(void *context, const struct cell_pairs_batch *batch) {
    const struct weighing *const w = context;
    const uint32_t *const bead = w->pairs->search.cells.order, *molecule = w->pairs->molecule;
    const double limit = w->settings->cutoff * w->settings->cutoff;
    double squares[CELL_PAIRS_BATCH];
    mf_cell_pairs_squares(batch, squares);
    for (size_t k = 0; k < batch->count; k++) {
        const size_t j = batch->begin + k;
        if (squares[k] >= limit || (w->apart && molecule[batch->i] == molecule[j]))
            continue;
        const double weight = weighted_density_weight(w->settings, squares[k]);
        w->density[bead[batch->i]] += weight;
        w->density[bead[j]] += weight;
    }
}

enum status mf_frame_pairs_weigh(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                 const struct weighted_density_settings *settings,
                                 const struct box_vectors *box, int32_t *const place[3],
                                 uint32_t (*excluded)[2], size_t count, double *density) {
    struct weighing w = {pairs, settings, plan->molecule && !plan->within, density};
    TRY(sort(pairs, plan, settings->cutoff, box, place));
    memset(density, 0, find_beads(plan) * sizeof *density);
    mf_cell_pairs_visit(&pairs->search, weigh_batch, &w);
    for (size_t n = 0; n < count; n++) {
        const uint32_t i = excluded[n][0], j = excluded[n][1];
        const struct cell_pairs_batch one = mf_cell_pairs_one(&pairs->search, place, i, j);
        double squared;
        mf_cell_pairs_squares(&one, &squared);
        density[i] -= weighted_density_weight(settings, squared);
        density[j] -= weighted_density_weight(settings, squared);
    }
    return STATUS_OK;
}

enum status mf_frame_pairs_possible(const struct frame_pairs_plan *plan, double *possible) {
    enum status status = STATUS_OK;
    const struct composition *composition = &plan->composition;
    const size_t beads = find_beads(plan), pairs = (size_t)mf_composition_pairs(composition);
    uint32_t(*seen)[COMPOSITION_MAX_TYPES] = NULL; // of each molecule, so far
    uint32_t max = 0;
    for (size_t pair = 0; pair < pairs; pair++)
        possible[pair] = mf_composition_possible_pairs(composition, (int)pair);
    for (size_t k = 0; plan->molecule && k < beads; k++)
        max = plan->molecule[k] > max ? plan->molecule[k] : max;
    NEW_ARRAY(seen, (size_t)max + 1);
    for (size_t k = 0; plan->molecule && k < beads; k++) {
        uint32_t *own = seen[plan->molecule[k]];
        const int type = mf_composition_type(composition, (uint32_t)k);
        for (int other = 0; other < composition->types; other++)
            possible[pairs > 1 ? mf_composition_pair(composition, type, other) : 0] -= own[other];
        own[type]++;
    }
done:
    mf_memory_free(seen);
    return status;
}
