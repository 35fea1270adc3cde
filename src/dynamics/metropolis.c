// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/metropolis.h"

#include "base/interrupt.h"
#include "base/rng.h"
#include "base/simd.h"
#include "system/placement.h"

/// Skin of the list as a fraction of the cutoff. Measured for SPC water (cutoff 2.15, steps of
/// about 0.1): a rebuild every few sweeps, 2.2 times the pairs in range on the list.
static const double skin_fraction = 0.25;

/// Accepted fraction that the step size is tuned to.
static const double wanted_acceptance = 0.4;

/// Largest step that leaves the list room for one sweep.
static double largest_step(const struct metropolis *metropolis) {
    return 0.49 * metropolis->neighbours.skin / sqrt(metropolis->particles.box.dimensions);
}

enum status metropolis_init(struct metropolis *metropolis, const struct box *box, size_t count,
                            const struct table *potential, double temperature, uint64_t seed) {
    enum status status = STATUS_OK;
    *metropolis = (struct metropolis){
        .potential = potential, .temperature = temperature, .step = 0.1, .seed = seed};
    CHECK(particles_init(&metropolis->particles, box, count));
    CHECK(neighbours_init(&metropolis->neighbours, NEIGHBOURS_FULL, box, count, potential->cutoff,
                          skin_fraction * potential->cutoff));
    if (metropolis->neighbours.skin < 0.05 * potential->cutoff) {
        status = status_fail(STATUS_BAD_INPUT,
                             "the box is too small for Monte Carlo: its shortest edge %g must be "
                             "at least 2.1 times the cutoff %g",
                             box_shortest(box), potential->cutoff);
        goto done;
    }
    metropolis->step = fmin(metropolis->step, largest_step(metropolis));
    placement_lattice(&metropolis->particles, 0.05, seed);
    CHECK(metropolis_refresh(metropolis));
done:
    if (status != STATUS_OK)
        metropolis_clear(metropolis);
    return status;
}

void metropolis_clear(struct metropolis *metropolis) {
    particles_clear(&metropolis->particles);
    neighbours_clear(&metropolis->neighbours);
}

enum status metropolis_refresh(struct metropolis *metropolis) {
    return neighbours_sort_and_build(&metropolis->neighbours, &metropolis->particles);
}

/// Places in the table of the distances from two points to the particles of a list: r / spacing, at
/// most the table's zero row.
SIMD_CLONES static void find_places(const struct particles *particles,
                                    const struct table *potential, const int32_t *list,
                                    size_t count, const int32_t from[3], const int32_t to[3],
                                    float *restrict before, float *restrict after) {
    const struct box *box = &particles->box;
    const float sx = (float)(box->length[0] * 0x1p-32), sy = (float)(box->length[1] * 0x1p-32),
                sz = box->dimensions == 3 ? (float)(box->length[2] * 0x1p-32) : 0;
    const int32_t *restrict x = particles->fraction[0], *restrict y = particles->fraction[1],
                            *restrict z = particles->fraction[2];
    const float inverse_spacing = (float)potential->inverse_spacing;
    const float last = TABLE_INTERVALS;
    for (size_t k = 0; k < count; k++) {
        const int32_t j = list[k];
        const float dx0 = sx * (float)box_fraction_difference(from[0], x[j]);
        const float dy0 = sy * (float)box_fraction_difference(from[1], y[j]);
        const float dz0 = sz * (float)box_fraction_difference(from[2], z[j]);
        const float dx1 = sx * (float)box_fraction_difference(to[0], x[j]);
        const float dy1 = sy * (float)box_fraction_difference(to[1], y[j]);
        const float dz1 = sz * (float)box_fraction_difference(to[2], z[j]);
        const float place0 = inverse_spacing * sqrtf(dx0 * dx0 + dy0 * dy0 + dz0 * dz0);
        const float place1 = inverse_spacing * sqrtf(dx1 * dx1 + dy1 * dy1 + dz1 * dz1);
        before[k] = place0 < last ? place0 : last;
        after[k] = place1 < last ? place1 : last;
    }
}

/// Φ at a place of the table, from the value and the force that a row holds.
static inline float table_energy(const struct table *potential, float place) {
    const int interval = (int)place;
    const float f = place - (float)interval;
    const float *c = potential->single[interval];
    const float spacing = (float)(1 / potential->inverse_spacing);
    return c[0] - spacing * f * (c[1] + f * (0.5f * c[2] + f * (1.0f / 3) * c[3]));
}

/// Change of potential energy when a particle goes from `from` to `to` [k_B T_0].
static double energy_change(const struct particles *particles, const struct table *potential,
                            const int32_t *list, size_t count, const int32_t from[3],
                            const int32_t to[3]) {
    enum { BATCH = 128 };
    float before[BATCH], after[BATCH];
    double change = 0;
    for (size_t first = 0; first < count; first += BATCH) {
        const size_t batch = count - first < BATCH ? count - first : BATCH;
        find_places(particles, potential, list + first, batch, from, to, before, after);
        // Scalar look-ups: gathers of the coefficients were measured to be three times slower.
        for (size_t k = 0; k < batch; k++)
            change += table_energy(potential, after[k]) - table_energy(potential, before[k]);
    }
    return change;
}

/// Try to move particle k once.
static void try_move(struct metropolis *metropolis, size_t k) {
    struct particles *particles = &metropolis->particles;
    const struct neighbours *neighbours = &metropolis->neighbours;
    const struct box *box = &particles->box;
    const struct rng_block random =
        rng_philox(metropolis->seed, RNG_METROPOLIS, metropolis->sweep, particles->id[k], 0);
    int32_t from[3] = {0}, to[3] = {0};
    double moved[3];
    for (int d = 0; d < box->dimensions; d++) {
        moved[d] =
            particles->position[d][k] + metropolis->step * (2 * rng_uniform(random.word[d], 0) - 1);
        from[d] = particles->fraction[d][k];
        to[d] = box_fraction(moved[d], 1 / box->length[d]);
    }
    const size_t begin = neighbours->start[k], end = neighbours->stop[k];
    const double change = energy_change(particles, metropolis->potential, neighbours->list + begin,
                                        end - begin, from, to);
    metropolis->tried++;
    // Written so that a NaN is refused.
    if (!(rng_uniform(random.word[3], 0) < exp(-change / metropolis->temperature)))
        return;
    metropolis->accepted++;
    for (int d = 0; d < box->dimensions; d++) {
        particles->position[d][k] = moved[d];
        particles->fraction[d][k] = to[d];
    }
}

/// A particle moves once in a sweep, by at most √d steps: the list must have room for that.
static enum status refresh_if_needed(struct metropolis *metropolis) {
    struct neighbours *neighbours = &metropolis->neighbours;
    const double reach = sqrt(metropolis->particles.box.dimensions) * metropolis->step;
    const double skin = neighbours->skin;
    neighbours->skin = fmax(0, skin - 2 * reach);
    const bool stale = neighbours_are_stale(neighbours, &metropolis->particles);
    neighbours->skin = skin;
    return stale ? metropolis_refresh(metropolis) : STATUS_OK;
}

static enum status sweep(struct metropolis *metropolis) {
    if (interrupt_requested())
        return status_fail(STATUS_INTERRUPTED, "interrupted");
    TRY(refresh_if_needed(metropolis));
    for (size_t k = 0; k < metropolis->particles.count; k++)
        try_move(metropolis, k);
    metropolis->sweep++;
    return STATUS_OK;
}

enum status metropolis_run(struct metropolis *metropolis, uint32_t sweeps) {
    for (uint32_t s = 0; s < sweeps; s++)
        TRY(sweep(metropolis));
    return STATUS_OK;
}

enum status metropolis_equilibrate(struct metropolis *metropolis, uint32_t sweeps) {
    for (uint32_t s = 0; s < sweeps; s++) {
        metropolis->accepted = metropolis->tried = 0;
        TRY(sweep(metropolis));
        const double accepted = (double)metropolis->accepted / (double)metropolis->tried;
        metropolis->step *= fmin(1.1, fmax(0.9, 1 + 0.5 * (accepted - wanted_acceptance)));
        metropolis->step = fmin(metropolis->step, largest_step(metropolis));
    }
    metropolis->accepted = metropolis->tried = 0;
    return STATUS_OK;
}

struct virial {
    const struct table *potential;
    double sum;
};

static void add_virial(void *context, const float *squared_distances, size_t count) {
    struct virial *virial = context;
    for (size_t k = 0; k < count; k++) {
        const double r = sqrt((double)squared_distances[k]);
        double slope;
        table_evaluate(virial->potential, r, NULL, &slope, NULL);
        virial->sum -= r * slope;
    }
}

double metropolis_virial(const struct metropolis *metropolis) {
    struct virial virial = {metropolis->potential, 0};
    neighbours_visit_distances(&metropolis->neighbours, &metropolis->particles,
                               metropolis->potential->cutoff, add_virial, &virial);
    return 0.5 * virial.sum; // the list has each pair from both sides
}
