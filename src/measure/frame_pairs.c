// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_pairs.h"

#include "base/memory.h"
#include "base/simd.h"

#include <math.h>
#include <string.h>

/// Beads of a row that are worked at together.
enum { BATCH = 512 };

void mf_frame_pairs_clear(struct frame_pairs *pairs) {
    mf_cells_clear(&pairs->cells);
    for (int i = 0; i < 3; i++)
        mf_memory_free(pairs->place[i]);
    mf_memory_free(pairs->type);
    mf_memory_free(pairs->molecule);
    mf_memory_free(pairs->counts);
    mf_memory_free(pairs->within);
    mf_memory_free(pairs->first);
    mf_memory_free(pairs->second);
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
    for (int i = 0; i < 3; i++)
        TRY_ARRAY(pairs->place[i], find_beads(plan));
    TRY_ARRAY(pairs->type, find_beads(plan));
    TRY_ARRAY(pairs->molecule, find_beads(plan));
    TRY_ARRAY(pairs->counts, find_counts(plan));
    if (plan->within)
        TRY_ARRAY(pairs->within, find_counts(plan));
    return STATUS_OK;
}

/// Two beads nearer than the range differ by less than range/height of a vector of the box, so that
/// their cells along it are at most ⌈cells range/height⌉ apart: two, or three by rounding. Where
/// the range is near half the box, the search becomes that of all pairs.
static void choose_cells(struct frame_pairs *pairs, size_t beads, double range,
                         const struct box_vectors *box, int count[3]) {
    const double max = fmax(1, floor(cbrt((double)beads)));
    for (int i = 0; i < 3; i++) {
        const double share = range / box->height[i];
        count[i] = cells_fit(2, share, max);
        pairs->reach[i] = (int)fmin(CELLS_MAX_REACH, ceil(count[i] * share));
    }
}

static void find_cells(struct cells *cells, int32_t *const place[3]) {
    for (size_t k = 0; k < cells->particles; k++) {
        uint32_t cell = 0;
        for (int i = 0; i < 3; i++)
            cell = cell * (uint32_t)cells->count[i] +
                   cells_along_fraction(place[i][k], cells->count[i]);
        cells->of[k] = cell;
    }
}

/// Sort the beads and their attributes.
static enum status sort(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                        double range, const struct box_vectors *box, int32_t *const place[3]) {
    const size_t beads = find_beads(plan);
    int count[3];
    TRY(reserve(pairs, plan));
    choose_cells(pairs, beads, range, box, count);
    TRY(mf_cells_shape(&pairs->cells, count, beads));
    find_cells(&pairs->cells, place);
    mf_cells_sort(&pairs->cells);
    const uint32_t *bead = pairs->cells.order;
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < beads; k++)
            pairs->place[i][k] = place[i][bead[k]];
    for (size_t k = 0; composition_is_mixed(&plan->composition) && k < beads; k++)
        pairs->type[k] = mf_composition_type(&plan->composition, bead[k]);
    for (size_t k = 0; plan->molecule && k < beads; k++)
        pairs->molecule[k] = plan->molecule[bead[k]];
    return STATUS_OK;
}

// Distances ---------------------------------------------------------------------------------------

/// One bead, the beads of a row, and the box.
struct probe {
    const int32_t *place[3]; ///< of the row
    int32_t own[3];
    double edge[3][3]; ///< of differences of places [nm]
    double per_length; ///< bins [1/nm]
    double bins;
};

static inline __attribute__((always_inline)) double square(const struct probe *p, size_t k) {
    const double a = box_fraction_difference(p->place[0][k], p->own[0]);
    const double b = box_fraction_difference(p->place[1][k], p->own[1]);
    const double c = box_fraction_difference(p->place[2][k], p->own[2]);
    const double x = a * p->edge[0][0] + b * p->edge[1][0] + c * p->edge[2][0];
    const double y = b * p->edge[1][1] + c * p->edge[2][1];
    const double z = c * p->edge[2][2];
    return x * x + y * y + z * z;
}

/// Bins of the distances; what is beyond the range is in the bin after the last.
SIMD_CLONES static void find_bins(const struct probe *probe, size_t count, int32_t *restrict bin) {
    const struct probe p = *probe;
    for (size_t k = 0; k < count; k++) {
        const double place = sqrt(square(&p, k)) * p.per_length;
        bin[k] = (int32_t)(place < p.bins ? place : p.bins);
    }
}

SIMD_CLONES static void find_squares(const struct probe *probe, size_t count,
                                     double *restrict squares) {
    const struct probe p = *probe;
    for (size_t k = 0; k < count; k++)
        squares[k] = square(&p, k);
}

// Pairs -------------------------------------------------------------------------------------------

/// What a row is taken for.
struct work {
    struct frame_pairs *pairs;
    const struct frame_pairs_plan *plan;
    struct probe probe;
    double limit;       ///< square of the range [nm²]
    enum status status; ///< of making room
};

static struct work make_work(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                             double range, const struct box_vectors *box) {
    struct work work = {pairs, plan, .limit = range * range};
    work.probe.bins = (double)plan->bins;
    work.probe.per_length = (double)plan->bins / range;
    for (int n = 0; n < 9; n++)
        work.probe.edge[n / 3][n % 3] = 0x1p-32 * box->edge[n / 3][n % 3];
    return work;
}

/// Look from bead i at those from `begin` on.
static void aim(struct work *work, size_t i, size_t begin) {
    for (int d = 0; d < 3; d++) {
        work->probe.own[d] = work->pairs->place[d][i];
        work->probe.place[d] = work->pairs->place[d] + begin;
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

static void count_batch(const struct work *work, size_t i, size_t begin, size_t count,
                        const int32_t *bin) {
    uint64_t *counts = work->pairs->counts;
    const int32_t *type = work->pairs->type + begin;
    size_t offset[COMPOSITION_MAX_TYPES];
    if (!composition_is_mixed(&work->plan->composition)) {
        for (size_t k = 0; k < count; k++)
            counts[bin[k]]++;
        return;
    }
    list_offsets(work, i, offset);
    for (size_t k = 0; k < count; k++)
        counts[offset[type[k]] + (size_t)bin[k]]++;
}

static void count_row(void *context, size_t i, struct cells_row row) {
    struct work *work = context;
    int32_t bin[BATCH];
    for (size_t begin = row.begin; begin < row.end; begin += BATCH) {
        const size_t left = row.end - begin, count = left < BATCH ? left : BATCH;
        aim(work, i, begin);
        find_bins(&work->probe, count, bin);
        if (work->plan->molecule)
            leave_out(work, i, begin, count, bin);
        count_batch(work, i, begin, count, bin);
    }
}

enum status mf_frame_pairs_count(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                 const struct box_vectors *box, int32_t *const place[3]) {
    TRY(sort(pairs, plan, plan->range, box, place));
    struct work work = make_work(pairs, plan, plan->range, box);
    const struct cells_visitor visitor = {count_row, &work};
    memset(pairs->counts, 0, find_counts(plan) * sizeof *pairs->counts);
    if (pairs->within)
        memset(pairs->within, 0, find_counts(plan) * sizeof *pairs->within);
    mf_cells_visit_pairs(&pairs->cells, pairs->reach, &visitor);
    return STATUS_OK;
}

void mf_frame_pairs_exclude(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                            const struct box_vectors *box, int32_t *const place[3],
                            uint32_t (*excluded)[2], size_t count) {
    const struct composition *composition = &plan->composition;
    struct work work = make_work(pairs, plan, plan->range, box);
    for (size_t n = 0; n < count; n++) {
        const uint32_t i = excluded[n][0], j = excluded[n][1];
        int32_t bin;
        size_t offset = 0;
        for (int d = 0; d < 3; d++) {
            work.probe.own[d] = place[d][i];
            work.probe.place[d] = &place[d][j];
        }
        find_bins(&work.probe, 1, &bin);
        if (composition_is_mixed(composition))
            offset = (size_t)mf_composition_pair(composition, mf_composition_type(composition, i),
                                                 mf_composition_type(composition, j)) *
                     (plan->bins + 1);
        if ((size_t)bin < plan->bins)
            pairs->within[offset + (size_t)bin]--;
    }
    for (size_t n = 0; n < find_counts(plan); n++)
        pairs->within[n] += pairs->counts[n];
}

static enum status grow_array(uint32_t **array, size_t count, size_t capacity) {
    uint32_t *larger = mf_memory_uncleared(capacity, sizeof *larger);
    if (larger == NULL)
        return STATUS_NO_MEMORY;
    if (count > 0)
        memcpy(larger, *array, count * sizeof *larger);
    mf_memory_free(*array);
    *array = larger;
    return STATUS_OK;
}

static enum status grow(struct frame_pairs *pairs) {
    const size_t capacity = pairs->near_capacity ? 2 * pairs->near_capacity : 4096;
    TRY(grow_array(&pairs->first, pairs->near_count, capacity));
    TRY(grow_array(&pairs->second, pairs->near_count, capacity));
    pairs->near_capacity = capacity;
    return STATUS_OK;
}

static void keep(struct work *work, size_t i, size_t j) {
    struct frame_pairs *pairs = work->pairs;
    if (work->plan->molecule && pairs->molecule[i] == pairs->molecule[j])
        return;
    if (pairs->near_count == pairs->near_capacity && work->status == STATUS_OK)
        work->status = grow(pairs);
    if (work->status != STATUS_OK)
        return;
    pairs->first[pairs->near_count] = pairs->cells.order[i];
    pairs->second[pairs->near_count++] = pairs->cells.order[j];
}

static void keep_row(void *context, size_t i, struct cells_row row) {
    struct work *work = context;
    double squares[BATCH];
    for (size_t begin = row.begin; begin < row.end; begin += BATCH) {
        const size_t left = row.end - begin, count = left < BATCH ? left : BATCH;
        aim(work, i, begin);
        find_squares(&work->probe, count, squares);
        for (size_t k = 0; k < count; k++)
            if (squares[k] < work->limit)
                keep(work, i, begin + k);
    }
}

enum status mf_frame_pairs_find(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                double range, const struct box_vectors *box,
                                int32_t *const place[3]) {
    TRY(sort(pairs, plan, range, box, place));
    struct work work = make_work(pairs, plan, range, box);
    const struct cells_visitor visitor = {keep_row, &work};
    pairs->near_count = 0;
    mf_cells_visit_pairs(&pairs->cells, pairs->reach, &visitor);
    return work.status;
}

// Weights -----------------------------------------------------------------------------------------

struct weighing {
    struct work work;
    const struct weighted_density_settings *settings;
    double *density;
};

static void weigh_row(void *context, size_t i, struct cells_row row) {
    struct weighing *w = context;
    const struct frame_pairs *pairs = w->work.pairs;
    const bool apart = w->work.plan->molecule && !w->work.plan->within;
    double squares[BATCH];
    for (size_t begin = row.begin; begin < row.end; begin += BATCH) {
        const size_t left = row.end - begin, count = left < BATCH ? left : BATCH;
        aim(&w->work, i, begin);
        find_squares(&w->work.probe, count, squares);
        for (size_t k = 0; k < count; k++) {
            const size_t j = begin + k;
            if (squares[k] >= w->work.limit || (apart && pairs->molecule[i] == pairs->molecule[j]))
                continue;
            const double weight = weighted_density_weight(w->settings, squares[k]);
            w->density[pairs->cells.order[i]] += weight;
            w->density[pairs->cells.order[j]] += weight;
        }
    }
}

enum status mf_frame_pairs_weigh(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                 const struct weighted_density_settings *settings,
                                 const struct box_vectors *box, int32_t *const place[3],
                                 uint32_t (*excluded)[2], size_t count, double *density) {
    TRY(sort(pairs, plan, settings->cutoff, box, place));
    struct weighing w = {make_work(pairs, plan, settings->cutoff, box), settings, density};
    const struct cells_visitor visitor = {weigh_row, &w};
    memset(density, 0, find_beads(plan) * sizeof *density);
    mf_cells_visit_pairs(&pairs->cells, pairs->reach, &visitor);
    for (size_t n = 0; n < count; n++) {
        const uint32_t i = excluded[n][0], j = excluded[n][1];
        double squared;
        for (int d = 0; d < 3; d++) {
            w.work.probe.own[d] = place[d][i];
            w.work.probe.place[d] = &place[d][j];
        }
        find_squares(&w.work.probe, 1, &squared);
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
