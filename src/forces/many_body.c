// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the pair loop finds of densities (many_body_steps.h) becomes energies and slopes here.
// Tested: reference/test_many_body, physics/test_many_body.
#include "forces/many_body.h"

#include "base/parallel.h"
#include "forces/many_body_work.h"

#include <math.h>

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

// Room --------------------------------------------------------------------------------------------

static double no_value(const void *parameters, double r) {
    (void)parameters;
    (void)r;
    return 0;
}

static double no_cutoff(const void *parameters) {
    return *(const double *)parameters;
}

/// Whether all beads are central, and count.
static bool is_for_all(const struct many_body *many_body, const struct many_body_term *term) {
    const int types = many_body->composition.types > 1 ? many_body->composition.types : 1;
    const uint32_t all = (1U << types) - 1;
    return (term->central & all) == all && (term->neighbours & all) == all;
}

static enum status begin(const void *parameters, void *own, const struct particles *particles) {
    static const struct curve_family nothing = {.value = no_value, .cutoff = no_cutoff};
    const struct many_body *many_body = parameters;
    struct many_body_work *work = own;
    work->many_body = many_body;
    work->cutoff = range_of(many_body);
    TRY(mf_table_init_potential(&work->nothing, &(struct curve){&nothing, &work->cutoff}));
    for (int t = 0; t < many_body->terms; t++) {
        struct many_body_density *term = &work->term[t];
        term->weight = &many_body->term[t].weight;
        TRY_ARRAY(term->density, particles->count);
        TRY_ARRAY(term->slope, particles->count);
        if (!is_for_all(many_body, &many_body->term[t]))
            TRY_ARRAY(term->share, particles->count);
        work->extreme[t][0] = INFINITY;
        work->extreme[t][1] = -INFINITY;
    }
    return STATUS_OK;
}

static void join(void *own, struct pair_law *law) {
    law->many_body = own;
}

static void clear(void *own) {
    struct many_body_work *work = own;
    for (int t = 0; t < MANY_BODY_MAX_TERMS; t++) {
        mf_memory_free(work->term[t].density);
        mf_memory_free(work->term[t].slope);
        mf_memory_free(work->term[t].share);
    }
    mf_table_clear(&work->nothing);
    mf_memory_free(work->held);
}

/// Room for all pairs of the list. Most of it is never touched, and so takes no memory.
static enum status reserve(struct many_body_work *work, const struct neighbours *neighbours,
                           enum pair_precision precision) {
    const size_t batches =
        neighbours->list_capacity / PAIR_BATCH + 2 * (size_t)NEIGHBOURS_MAX_PARTS;
    work->held_size = mf_pair_held_size(precision, work->many_body->terms);
    const size_t bytes = batches * work->held_size;
    if (bytes <= work->capacity)
        return STATUS_OK;
    mf_memory_free(work->held);
    work->capacity = 0;
    work->held = mf_memory_uncleared(bytes, 1);
    if (work->held == NULL)
        return STATUS_NO_MEMORY;
    work->capacity = bytes;
    return STATUS_OK;
}

const double *mf_many_body_density(const void *own, int term) {
    return ((const struct many_body_work *)own)->term[term].density;
}

// Densities ---------------------------------------------------------------------------------------

/// One term of all beads.
struct beads {
    const struct particles *particles;
    const struct composition *composition;
    const struct many_body_term *term;
    const struct many_body_density *of;
};

static struct beads beads_of(const struct many_body_work *work, const struct particles *particles,
                             int term) {
    return (struct beads){particles, &work->many_body->composition, &work->many_body->term[term],
                          &work->term[term]};
}

static bool is_of(uint32_t set, const struct beads *beads, size_t k) {
    return !beads->of->share ||
           set >> mf_composition_type(beads->composition, beads->particles->id[k]) & 1;
}

static void clear_densities(void *context, size_t begin, size_t end) {
    const struct beads *beads = context;
    for (size_t k = begin; k < end; k++) {
        beads->of->density[k] = 0;
        if (beads->of->share)
            beads->of->share[k] = is_of(beads->term->neighbours, beads, k);
    }
}

/// Σ f(ρ) of central beads, whose slopes are noted.
static double find_energies(const void *context, size_t begin, size_t end) {
    const struct beads *beads = context;
    double sum = 0;
    for (size_t k = begin; k < end; k++) {
        beads->of->slope[k] = 0;
        if (is_of(beads->term->central, beads, k))
            sum += mf_density_energy_value(&beads->term->energy, beads->of->density[k],
                                           &beads->of->slope[k]);
    }
    return sum;
}

static void note_extremes(double extreme[2], const struct beads *beads) {
    for (size_t k = 0; k < beads->particles->count; k++)
        if (is_of(beads->term->central, beads, k)) {
            extreme[0] = fmin(extreme[0], beads->of->density[k]);
            extreme[1] = fmax(extreme[1], beads->of->density[k]);
        }
}

double mf_many_body_slopes(struct many_body_work *work, const struct particles *particles,
                           uint64_t step) {
    double energy = 0;
    for (int t = 0; t < work->many_body->terms; t++) {
        const struct beads beads = beads_of(work, particles, t);
        energy += mf_parallel_sum(particles->count, particles->threads, find_energies, &beads);
        if (beads.term->energy.tabulated && step > 0)
            note_extremes(work->extreme[t], &beads);
    }
    return energy;
}

// In a pass ---------------------------------------------------------------------------------------

/// A pass that is not one of all replaces no forces: without Φ and friction, and added.
static void add_alone(struct many_body_work *work, const struct interaction_pass *pass) {
    struct particles *particles = pass->particles;
    const struct pair_law law = {.composition = pass->law->composition,
                                 .precision = pass->law->precision,
                                 .many_body = work};
    struct pair_sums sums;
    mf_pair_clear(particles);
    mf_pair_add(&law, particles, pass->neighbours, pass->step, pass->wants, &sums);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->force[d][k] += particles->kernel_force[k][d];
    if (pass->wants == PAIR_FORCES_AND_SUMS) {
        pass->sums->energy += sums.energy;
        pass->sums->virial += sums.virial;
    }
}

/// Before the pairs: they do the rest.
static enum status add(const void *parameters, void *own, const struct interaction_pass *pass) {
    struct many_body_work *work = own;
    (void)parameters;
    TRY(reserve(work, pass->neighbours, pass->law->precision));
    for (int p = 0; p < pass->neighbours->parts; p++)
        work->end[p] = many_body_begin(pass->neighbours, p);
    for (int t = 0; t < work->many_body->terms; t++) {
        struct beads beads = beads_of(work, pass->particles, t);
        mf_parallel_for(pass->particles->count, pass->particles->threads, clear_densities, &beads);
    }
    if (!pass->before_pairs)
        add_alone(work, pass);
    return STATUS_OK;
}

// Laplacian ---------------------------------------------------------------------------------------

/// Of beads of a term, by place: Σ_j w' r̂, Σ_j w'² and Σ_j (w'' + (d − 1) w'/r) of their neighbours
/// that count, shape [count, 3], [count], [count].
struct spread {
    double *gradient, *squares, *curvature;
};

/// w' and w'' at r. At the cutoff w' may end abruptly: a Dirac peak of w'', spread over a shell
/// inside, as that of Φ is (configurational.c).
static double curvature_at(const struct weight_table *weight, double r, double *slope) {
    static const double shell = 0.01;
    const double width = shell * weight_cutoff(weight);
    double curvature, last;
    mf_table_evaluate(&weight->table, fmax(0, r - weight->inner), NULL, slope, &curvature);
    mf_table_evaluate(&weight->table, weight->table.cutoff * (1 - 1e-9), NULL, &last, NULL);
    return (r < weight->inner ? 0 : curvature) -
           (r > weight_cutoff(weight) - width ? last / width : 0);
}

static void add_neighbour(struct spread *spread, size_t i, const double r_ij[3], double r,
                          double slope, double laplacian) {
    for (int d = 0; d < 3; d++)
        spread->gradient[3 * i + (size_t)d] += slope * r_ij[d] / r;
    spread->squares[i] += slope * slope;
    spread->curvature[i] += laplacian;
}

static void spread_pairs(const struct beads *beads, const struct neighbours *neighbours,
                         struct spread *spread) {
    const struct particles *particles = beads->particles;
    const int dimensions = particles->box.dimensions;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            double r_ij[3] = {0}, r_ji[3], square = 0, slope;
            for (int d = 0; d < dimensions; d++) {
                r_ij[d] = box_nearest(particles->position[d][i] - particles->position[d][j],
                                      particles->box.length[d]);
                square += r_ij[d] * r_ij[d];
            }
            const double r = sqrt(square);
            if (j == i || r >= weight_cutoff(beads->of->weight)) // j = i is what is left of a row
                continue;
            const double curvature = curvature_at(beads->of->weight, r, &slope);
            const double laplacian = curvature + (dimensions - 1) * slope / r;
            for (int d = 0; d < 3; d++)
                r_ji[d] = -r_ij[d];
            if (is_of(beads->term->neighbours, beads, j))
                add_neighbour(spread, i, r_ij, r, slope, laplacian);
            if (is_of(beads->term->neighbours, beads, i))
                add_neighbour(spread, j, r_ji, r, slope, laplacian);
        }
}

/// Σ_k ∇_k² f(ρ_i) = f'' Σ_k |∇_k ρ_i|² + f' Σ_k ∇_k² ρ_i, of k = i and its neighbours.
static double laplacian_of(const struct beads *beads, const struct spread *spread, size_t i) {
    static const double apart = 1e-5;
    const struct density_energy *energy = &beads->term->energy;
    const double density = beads->of->density[i];
    double slope, above, below, square = spread->squares[i];
    mf_density_energy_value(energy, density, &slope);
    mf_density_energy_value(energy, density + apart, &above);
    mf_density_energy_value(energy, density - apart, &below);
    for (int d = 0; d < 3; d++)
        square += pow(spread->gradient[3 * i + (size_t)d], 2);
    return (above - below) / (2 * apart) * square + slope * 2 * spread->curvature[i];
}

static enum status laplacian(const void *parameters, void *own, const struct interaction_pass *pass,
                             double *sum) {
    const struct many_body_work *work = own;
    const size_t count = pass->particles->count;
    (void)parameters;
    for (int t = 0; t < work->many_body->terms; t++) {
        const struct beads beads = beads_of(work, pass->particles, t);
        OWNED double *values = NULL;
        TRY_ARRAY(values, 5 * count);
        struct spread spread = {values, values + 3 * count, values + 4 * count};
        spread_pairs(&beads, pass->neighbours, &spread);
        for (size_t i = 0; i < count; i++)
            if (is_of(beads.term->central, &beads, i))
                *sum += laplacian_of(&beads, &spread, i);
    }
    return STATUS_OK;
}

static size_t spans(void *own, struct memory_span *spans) {
    struct many_body_work *work = own;
    spans[0] = (struct memory_span){work->extreme, sizeof work->extreme};
    return 1;
}

bool mf_many_body_was_beyond(const struct many_body *many_body, const void *own, int term,
                             double extreme[2]) {
    static const double rounding = 1e-9;
    const struct density_energy *energy = &many_body->term[term].energy;
    const double within = rounding * (energy->high - energy->low);
    memcpy(extreme, ((const struct many_body_work *)own)->extreme[term], 2 * sizeof *extreme);
    return energy->tabulated && extreme[0] <= extreme[1] &&
           (extreme[0] < energy->low - within || extreme[1] > energy->high + within);
}

const struct interaction mf_many_body = {
    .name = "many_body",
    .summary = "energies of local densities",
    .parameters_size = sizeof(struct many_body),
    .state_size = sizeof(struct many_body_work),
    .cost = 120,
    .finds_pairs = true,
    .range = range_of,
    .before_pairs = true,
    .begin = begin,
    .clear = clear,
    .join = join,
    .add = add,
    .laplacian = laplacian,
    .spans = spans,
};
