// SPDX-License-Identifier: GPL-3.0-or-later
//
// Two sweeps over the pairs of each term, and one over the beads between them.
// Tested: reference/test_many_body, physics/test_many_body.
#include "forces/many_body.h"

#include "base/parallel.h"
#include "base/simd.h"
#include "forces/many_body_kernels.h"

#include <math.h>

/// Smallest and largest density of central beads since the begin.
struct extremes {
    double low, high;
};

struct state {
    struct many_body_work work;
    size_t count;
    double *density;    ///< shape [terms, count]
    double (*force)[4]; ///< shape [count], of a pass that is not one of all
    struct extremes extremes[MANY_BODY_MAX_TERMS];
};

void mf_many_body_clear(struct many_body *many_body) {
    for (int t = 0; t < many_body->terms; t++) {
        mf_weight_clear(&many_body->term[t].weight);
        mf_density_energy_clear(&many_body->term[t].energy);
    }
    *many_body = (struct many_body){0};
}

const struct many_body *mf_many_body_find(const struct interaction_choice *interactions,
                                          int count) {
    for (int k = 0; k < count; k++)
        if (interactions[k].kind == &mf_many_body)
            return interactions[k].parameters;
    return NULL;
}

static double range_of(const void *parameters) {
    const struct many_body *many_body = parameters;
    double range = 0;
    for (int t = 0; t < many_body->terms; t++)
        range = fmax(range, weight_cutoff(&many_body->term[t].weight));
    return range;
}

static enum status begin(const void *parameters, void *own, const struct particles *particles) {
    const struct many_body *many_body = parameters;
    struct state *state = own;
    state->count = particles->count;
    TRY_ARRAY(state->density, particles->count * (size_t)many_body->terms);
    TRY_ARRAY(state->work.slope, particles->count);
    TRY_ARRAY(state->work.share, particles->count);
    for (int t = 0; t < many_body->terms; t++)
        state->extremes[t] = (struct extremes){INFINITY, -INFINITY};
    return STATUS_OK;
}

static void clear(void *own) {
    struct state *state = own;
    mf_memory_free(state->density);
    mf_memory_free(state->force);
    mf_memory_free(state->work.slope);
    mf_memory_free(state->work.share);
    mf_memory_free(state->work.pair);
    mf_memory_free(state->work.precise);
    mf_memory_free(state->work.i);
    mf_memory_free(state->work.j);
}

const double *mf_many_body_density(const void *own, int term) {
    const struct state *state = own;
    return state->density + (size_t)term * state->count;
}

/// Room for as many pairs as there are places on the list.
static enum status reserve(struct many_body_work *work, const struct neighbours *neighbours,
                           bool is_double) {
    const size_t capacity = neighbours->list_capacity + PARTICLES_PADDING; // whole vectors
    if (capacity <= work->capacity)
        return STATUS_OK;
    mf_memory_free(work->pair);
    mf_memory_free(work->precise);
    mf_memory_free(work->i);
    mf_memory_free(work->j);
    work->capacity = 0;
    // Most of the room is never touched, and so takes no memory.
    work->pair = is_double ? NULL : mf_memory_uncleared(capacity, sizeof *work->pair);
    work->precise = is_double ? mf_memory_uncleared(capacity, sizeof *work->precise) : NULL;
    work->i = mf_memory_uncleared(capacity, sizeof *work->i);
    work->j = mf_memory_uncleared(capacity, sizeof *work->j);
    if ((work->pair == NULL && work->precise == NULL) || work->i == NULL || work->j == NULL)
        return STATUS_NO_MEMORY;
    work->capacity = capacity;
    return STATUS_OK;
}

/// Kernels for the instruction set in use.
static const struct many_body_kernels *choose_set(bool is_double) {
    switch (mf_simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return is_double ? &mf_many_body_avx512_double : &mf_many_body_avx512;
    case SIMD_AVX2:
        return is_double ? &mf_many_body_avx2_double : &mf_many_body_avx2;
#endif
    default:
        return is_double ? &mf_many_body_portable_double : &mf_many_body_portable;
    }
}

/// One term of a pass.
struct sweep {
    const struct interaction_pass *pass;
    const struct composition *composition;
    const struct many_body_term *term;
    struct many_body_work *work;
    bool mixed; ///< not all beads are central and count
    double (*force)[4];
};

static bool is_for_all(const struct sweep *sweep) {
    const int types = sweep->composition->types > 1 ? sweep->composition->types : 1;
    const uint32_t all = (1U << types) - 1;
    return (sweep->term->central & all) == all && (sweep->term->neighbours & all) == all;
}

static bool is_of(uint32_t set, const struct sweep *sweep, size_t k) {
    const uint32_t id = sweep->pass->particles->id[k];
    return !sweep->mixed || set >> mf_composition_type(sweep->composition, id) & 1;
}

static void prepare_beads(void *context, size_t begin, size_t end) {
    const struct sweep *sweep = context;
    for (size_t k = begin; k < end; k++) {
        sweep->work->density[k] = 0;
        sweep->work->share[k] = is_of(sweep->term->neighbours, sweep, k);
    }
}

/// Σ f(ρ) of central beads, whose slopes are noted.
static double find_energies(const void *context, size_t begin, size_t end) {
    const struct sweep *sweep = context;
    double sum = 0;
    for (size_t k = begin; k < end; k++) {
        sweep->work->slope[k] = 0;
        if (is_of(sweep->term->central, sweep, k))
            sum += mf_density_energy_value(&sweep->term->energy, sweep->work->density[k],
                                           &sweep->work->slope[k]);
    }
    return sum;
}

static void note_extremes(struct extremes *extremes, const struct sweep *sweep) {
    for (size_t k = 0; k < sweep->pass->particles->count; k++)
        if (is_of(sweep->term->central, sweep, k)) {
            extremes->low = fmin(extremes->low, sweep->work->density[k]);
            extremes->high = fmax(extremes->high, sweep->work->density[k]);
        }
}

/// All pairs of a term. A part adds to its own beads and to those of the next one: even parts never
/// meet.
static void add_term(struct sweep *sweep, struct pair_sums *sums) {
    const struct interaction_pass *pass = sweep->pass;
    struct particles *particles = pass->particles;
    const struct neighbours *neighbours = pass->neighbours;
    const struct many_body_kernels *kernels = choose_set(sweep->work->precise != NULL);
    const int parts = neighbours->parts, threads = particles->threads;
    const bool wants_sums = pass->wants == PAIR_FORCES_AND_SUMS;
    struct transfer *transfer = pass->law->transfer;
    double virial[NEIGHBOURS_MAX_PARTS] = {0};
    mf_parallel_for(particles->count, threads, prepare_beads, sweep);
    many_body_densities *densities =
        kernels->densities[particles->box.dimensions - 2][sweep->mixed];
    for (int first = 0; first < 2; first++) {
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
        for (int p = first; p < parts; p += 2)
            densities(sweep->term, sweep->work, particles, neighbours, p);
    }
    sums->energy += mf_parallel_sum(particles->count, threads, find_energies, sweep);
    many_body_forces *forces = kernels->forces[sweep->mixed];
    for (int first = 0; first < 2; first++) {
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
        for (int p = first; p < parts; p += 2)
            forces(sweep->work, neighbours, p, sweep->force, wants_sums ? &virial[p] : NULL,
                   transfer ? transfer->part[p] : NULL);
    }
    for (int p = 0; p < parts; p++)
        sums->virial += virial[p];
}

/// A pass that is not one of all replaces no sums: the forces are found apart, and added.
static enum status clear_forces(struct state *state) {
    if (state->force == NULL)
        TRY_ARRAY(state->force, state->count);
    memset(state->force, 0, state->count * sizeof *state->force);
    return STATUS_OK;
}

static void give_forces(const struct state *state, struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->force[d][k] += state->force[k][d];
}

static enum status add(const void *parameters, void *own, const struct interaction_pass *pass) {
    const struct many_body *many_body = parameters;
    struct state *state = own;
    struct pair_sums sums = {0};
    TRY(reserve(&state->work, pass->neighbours, pass->particles->precise_place != NULL));
    if (!pass->before_pairs)
        TRY(clear_forces(state));
    for (int t = 0; t < many_body->terms; t++) {
        struct sweep sweep = {.pass = pass,
                              .composition = &many_body->composition,
                              .term = &many_body->term[t],
                              .work = &state->work,
                              .force = pass->before_pairs ? pass->particles->kernel_force
                                                          : state->force};
        sweep.mixed = !is_for_all(&sweep);
        state->work.density = state->density + (size_t)t * state->count;
        add_term(&sweep, &sums);
        if (sweep.term->energy.tabulated && pass->step > 0)
            note_extremes(&state->extremes[t], &sweep);
    }
    if (!pass->before_pairs)
        give_forces(state, pass->particles);
    if (pass->wants == PAIR_FORCES_AND_SUMS) {
        pass->sums->energy += sums.energy;
        pass->sums->virial += sums.virial;
    }
    return STATUS_OK;
}

static size_t spans(void *own, struct memory_span *spans) {
    struct state *state = own;
    spans[0] = (struct memory_span){state->extremes, sizeof state->extremes};
    return 1;
}

bool mf_many_body_was_beyond(const struct many_body *many_body, const void *own, int term,
                             double extreme[2]) {
    const struct extremes *found = &((const struct state *)own)->extremes[term];
    const struct density_energy *energy = &many_body->term[term].energy;
    extreme[0] = found->low;
    extreme[1] = found->high;
    return energy->tabulated && found->low <= found->high &&
           (found->low < energy->low || found->high > energy->high);
}

const struct interaction mf_many_body = {
    .name = "many_body",
    .summary = "energies of local densities",
    .parameters_size = sizeof(struct many_body),
    .state_size = sizeof(struct state),
    .cost = 120,
    .range = range_of,
    .before_pairs = true,
    .begin = begin,
    .clear = clear,
    .add = add,
    .spans = spans,
};
