// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/probes.h"

#include "base/memory.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

const double probes_tolerance = 4e-6;
const uint64_t probes_carry = UINT64_C(1) << 32;

/// Between sites: a triangle's particles are less than 0.6 from its corner, which leaves 1.2.
static const double site_spacing = 2.4;
static const double triangle_leg = 0.6;

static void make_omega(struct table *omega) {
    struct formula_power_omega_parameters parameters = {1.3, 1, 0, 1};
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    assert_ok(mf_table_init_omega(omega, &curve));
}

/// Ids in the order in which they are given to particles.
static uint32_t *make_ids(size_t count, enum probes_ids ids) {
    uint32_t *id = mf_memory_zeroed(count, sizeof *id);
    assert_non_null(id);
    struct rng_sequence sequence = mf_rng_sequence_begin(17, RNG_SELECTION, 0, 0);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t other = ids == PROBES_SHUFFLED ? mf_rng_sequence_below(&sequence, k + 1) : k;
        id[k] = id[other];
        id[other] = k;
    }
    return id;
}

static int compare_ids(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/// The ζ of particles a and b from the force on a along `axis`.
static struct probe make_probe(const struct probes *scene, uint32_t a, uint32_t b, int axis) {
    const struct particles *particles = &scene->particles;
    const struct pair_law *law = &scene->law;
    double square = 0, along = 0, omega;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double dx = box_nearest(particles->position[d][a] - particles->position[d][b],
                                      particles->box.length[d]);
        square += dx * dx;
        if (d == axis)
            along = dx;
    }
    mf_table_evaluate(law->omega, sqrt(square), &omega, NULL, NULL);
    assert_true(omega > 0 && fabs(along) > 0.1);
    const double amplitude = sqrt(2 * law->temperature / law->time_step) * omega;
    return (struct probe){a, axis, sqrt(square) / (amplitude * along)};
}

static void place(struct probes *scene, uint32_t id, const double site[3], int axis, double shift) {
    for (int d = 0; d < scene->particles.box.dimensions; d++)
        scene->particles.position[d][id] = site[d] + (d == axis ? shift : 0);
}

/// Dimers of lengths from 0.3 to 0.7 lie along each axis in turn, and either way.
static void add_dimer(struct probes *scene, const struct probes_plan *plan, size_t number,
                      const double site[3], const uint32_t id[2]) {
    const int axis = (int)(number % (size_t)plan->dimensions);
    const double size = 0.3 + 0.4 * fmod(0.618 * (double)number, 1);
    const double length = number / 3 % 2 ? size : -size;
    place(scene, id[plan->exchanged ? 1 : 0], site, axis, 0);
    place(scene, id[plan->exchanged ? 0 : 1], site, axis, length);
    scene->probe[number] = make_probe(scene, id[0], id[1], axis);
    scene->mirror[number] = make_probe(scene, id[1], id[0], axis);
}

/// Each of the three ids stands at the right angle in turn, and the legs lie along each pair of
/// axes, either way.
static void add_triangle(struct probes *scene, const struct probes_plan *plan, size_t number,
                         const double site[3], const uint32_t id[3]) {
    static const enum probes_side side_of[3][3] = {
        {PROBES_SIDES, PROBES_LOW_MIDDLE, PROBES_LOW_HIGH},
        {PROBES_LOW_MIDDLE, PROBES_SIDES, PROBES_MIDDLE_HIGH},
        {PROBES_LOW_HIGH, PROBES_MIDDLE_HIGH, PROBES_SIDES}};
    const int dim = plan->dimensions, x = (int)(number / 3 % (size_t)dim), y = (x + 1) % dim;
    const size_t corner = number % 3, a = (corner + 1) % 3, b = (corner + 2) % 3;
    const double leg = number / 9 % 2 ? triangle_leg : -triangle_leg;
    place(scene, id[corner], site, -1, 0);
    place(scene, id[a], site, x, leg);
    place(scene, id[b], site, y, leg);
    struct probe *probe = scene->probe + PROBES_SIDES * number;
    probe[side_of[corner][a]] = make_probe(scene, id[corner], id[a], x);
    probe[side_of[corner][b]] = make_probe(scene, id[corner], id[b], y);
    probe[side_of[a][b]] = make_probe(scene, id[a], id[b], y);
}

static void add_motifs(struct probes *scene, const struct probes_plan *plan) {
    const int n = plan->sites, each = plan->motif == PROBES_DIMERS ? 2 : 3;
    uint32_t *ids = make_ids(scene->particles.count, plan->ids);
    const size_t motifs = scene->particles.count / (size_t)each;
    for (size_t number = 0; number < motifs; number++) {
        uint32_t *id = ids + number * (size_t)each;
        const size_t m = number;
        const double site[3] = {site_spacing * (double)(m % (size_t)n),
                                site_spacing * (double)(m / (size_t)n % (size_t)n),
                                site_spacing * (double)(m / (size_t)(n * n))};
        qsort(id, (size_t)each, sizeof *id, compare_ids);
        if (plan->motif == PROBES_DIMERS)
            add_dimer(scene, plan, number, site, id);
        else
            add_triangle(scene, plan, number, site, id);
    }
    mf_memory_free(ids);
}

static void reverse(struct particles *particles) {
    uint32_t *order = mf_memory_zeroed(particles->count, sizeof *order);
    assert_non_null(order);
    for (size_t k = 0; k < particles->count; k++)
        order[k] = (uint32_t)(particles->count - 1 - k);
    mf_particles_permute(particles, order);
    mf_memory_free(order);
}

/// Particles do not move, so that their places in the arrays are known from the first sort on.
static void find_places(struct probes *scene) {
    const size_t count = scene->particles.count;
    uint32_t *place_of = mf_memory_zeroed(count, sizeof *place_of);
    assert_non_null(place_of);
    for (uint32_t k = 0; k < count; k++)
        place_of[scene->particles.id[k]] = k;
    for (size_t p = 0; p < scene->pairs; p++) {
        scene->probe[p].particle = place_of[scene->probe[p].particle];
        scene->mirror[p].particle = place_of[scene->mirror[p].particle];
    }
    mf_memory_free(place_of);
}

void probes_make(struct probes *scene, const struct probes_plan *plan) {
    const double edge = plan->sites * site_spacing;
    const struct box box = {plan->dimensions, {edge, edge, plan->dimensions == 3 ? edge : 1}};
    const size_t motifs = (size_t)lround(pow(plan->sites, plan->dimensions));
    *scene = (struct probes){.law = {.temperature = 0.8, .time_step = 0.03, .seed = 0x57EED}};
    make_omega(&scene->omega);
    scene->law.omega = &scene->omega;
    scene->pairs = motifs * (plan->motif == PROBES_DIMERS ? 1 : PROBES_SIDES);
    scene->probe = mf_memory_zeroed(scene->pairs, sizeof *scene->probe);
    scene->mirror = mf_memory_zeroed(scene->pairs, sizeof *scene->mirror);
    assert_non_null(scene->probe);
    assert_non_null(scene->mirror);
    assert_ok(mf_particles_init(&scene->particles, &box,
                                motifs * (plan->motif == PROBES_DIMERS ? 2 : 3)));
    assert_ok(mf_particles_keep_precise(&scene->particles));
    add_motifs(scene, plan);
    if (plan->reversed)
        reverse(&scene->particles);
    assert_ok(mf_neighbours_init(&scene->neighbours, NEIGHBOURS_HALF, &box, scene->particles.count,
                                 mf_pair_cutoff(&scene->law), 0.1));
    assert_ok(mf_neighbours_sort_and_build(&scene->neighbours, &scene->particles));
    mf_particles_update_motion(&scene->particles, 0);
    find_places(scene);
}

void probes_clear(struct probes *scene) {
    mf_particles_clear(&scene->particles);
    mf_neighbours_clear(&scene->neighbours);
    mf_table_clear(&scene->omega);
    mf_memory_free(scene->probe);
    mf_memory_free(scene->mirror);
}

void probes_read(const struct probes *scene, const struct probe *probe, double *zeta) {
    for (size_t p = 0; p < scene->pairs; p++)
        zeta[p] = probe[p].factor * scene->particles.force[probe[p].axis][probe[p].particle];
}

void probes_draw(struct probes *scene, uint64_t seed, uint64_t step, double *zeta) {
    scene->law.seed = seed;
    mf_pair_forces(&scene->law, &scene->particles, &scene->neighbours, step, PAIR_FORCES, NULL);
    probes_read(scene, scene->probe, zeta);
}

double *probes_numbers(size_t count) {
    double *numbers = mf_memory_zeroed(count, sizeof *numbers);
    assert_non_null(numbers);
    return numbers;
}
