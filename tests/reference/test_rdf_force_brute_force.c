// SPDX-License-Identifier: GPL-3.0-or-later
//
// What mf_rdf_force_sample adds up is the same as a double loop over all particles in double
// precision, with the field A of each bin written down as it stands in rdf_force.h.
#include "observe/rdf_force.h"
#include "shared/all_pairs.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

enum { MAX_BINS = 40, PARTICLES = 200 };

/// Single-precision pairs. One so near to an edge that it falls on its other side would show as
/// more in h; with these seeds there is none.
static const double tolerance = 2e-5;

/// h, z and D of one configuration.
struct answer {
    double h[MAX_BINS], z[MAX_BINS], difference, level;
};

/// Share of the volume of a shell that lies within r.
static double filled(double r, double low, double high, int dimensions) {
    const double share = (pow(r, dimensions) - pow(low, dimensions)) /
                         (pow(high, dimensions) - pow(low, dimensions));
    return fmin(fmax(share, 0), 1);
}

static void add_pair(const struct rdf_bins *bins, int dimensions, double r, double dot, double unit,
                     struct answer *answer) {
    const double range = mf_rdf_bins_range(bins);
    const double flux = dot / pow(r, dimensions) * unit;
    if (r >= range)
        return;
    answer->difference -= flux * (1 - pow(r / range, dimensions));
    answer->level += 1;
    for (size_t k = 0; k < bins->count; k++) {
        const double low = mf_rdf_bins_edge(bins, k), high = mf_rdf_bins_edge(bins, k + 1);
        answer->h[k] += r >= low && r < high;
        answer->z[k] += flux * (1 - filled(r, low, high, dimensions));
    }
}

/// @param particles  with the forces of the potential alone
static void count_all(const struct rdf_bins *bins, const struct particles *particles,
                      double temperature, struct answer *answer) {
    const struct box *box = &particles->box;
    const double solid = box->dimensions == 3 ? 4 * M_PI : 2 * M_PI;
    const double ideal =
        0.5 * (double)particles->count * (double)(particles->count - 1) / mf_box_volume(box);
    *answer = (struct answer){.difference = 0};
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = 0; j < i; j++) {
            double square = 0, dot = 0;
            for (int d = 0; d < box->dimensions; d++) {
                const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                              box->length[d]);
                square += dx * dx;
                dot += dx * (particles->force[d][i] - particles->force[d][j]) / 2;
            }
            add_pair(bins, box->dimensions, sqrt(square), dot, 1 / (temperature * solid * ideal),
                     answer);
        }
    answer->level /= ideal * mf_box_shell_volume(box, 0, mf_rdf_bins_range(bins));
    answer->difference += answer->level;
    for (size_t k = 0; k < bins->count; k++)
        answer->h[k] /= mf_rdf_ideal_pairs(bins, k, box, particles->count);
}

/// One sample of the simulation is what the double loop says; its forces stay as they are.
static void assert_sample(const struct rdf_bins *bins, struct simulation *simulation,
                          double list_cutoff) {
    static struct particles brute;
    struct particles *particles = &simulation->particles;
    const struct simulation_setup *setup = &simulation->setup;
    const size_t bytes = particles->count * sizeof(double);
    struct answer answer;
    struct rdf_force force;
    double largest = 0;
    assert_ok(mf_particles_init(&brute, &particles->box, particles->count));
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(brute.position[d], particles->position[d], bytes);
    all_pairs_forces(&(struct pair_law){.potential = setup->potential}, &brute, 0, NULL);
    count_all(bins, &brute, 0.7, &answer);
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(brute.force[d], particles->force[d], bytes);
    assert_ok(mf_rdf_force_init(&force, bins, &particles->box, particles->count, setup->potential,
                                0.7, list_cutoff, 1));
    assert_int_equal(force.needs_own_list, mf_rdf_bins_range(bins) > list_cutoff);
    assert_ok(mf_rdf_force_sample(&force, particles, &simulation->neighbours));
    for (size_t k = 0; k < bins->count; k++) {
        assert_close(force.sums[RDF_FORCE_H * bins->count + k], answer.h[k], tolerance);
        assert_close(force.sums[RDF_FORCE_Z * bins->count + k], answer.z[k], tolerance);
        assert_close(force.sums[RDF_FORCE_ZD * bins->count + k], answer.z[k] * answer.difference,
                     3 * tolerance);
        largest = fmax(largest, fabs(answer.z[k]));
    }
    assert_true(largest > 0.5); // a comparison of nothing proves nothing
    assert_close(force.totals->level, answer.level, tolerance);
    assert_close(force.totals->difference, answer.difference, tolerance);
    for (int d = 0; d < particles->box.dimensions; d++)
        assert_memory_equal(brute.force[d], particles->force[d], bytes);
    mf_rdf_force_clear(&force);
    mf_particles_clear(&brute);
}

static void assert_fluid(struct fluid *fluid) {
    struct simulation simulation;
    assert_ok(mf_simulation_init(&simulation, &fluid->setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 203));
    const double half = mf_box_shortest(&fluid->setup.box) / 2;
    const struct rdf_bins within = {0, 0.025, 40}, above_zero = {0.31, 0.023, 30},
                          beyond = {0, half / 40, 40}, far = {1.1, 0.03, 20};
    assert_sample(&within, &simulation, 1);
    assert_sample(&above_zero, &simulation, 1);
    assert_sample(&within, &simulation, 0);
    assert_sample(&beyond, &simulation, 1);
    assert_sample(&far, &simulation, 1);
    mf_simulation_clear(&simulation);
    fluid_clear(fluid);
}

static void test_rdf_force_is_the_double_loop_when_the_box_is_long(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.04);
    fluid.setup.box.length[0] = 3.6;
    fluid.setup.box.length[1] = 7;
    fluid.setup.box.length[2] = 3.5;
    assert_fluid(&fluid);
}

static void test_rdf_force_is_the_double_loop_when_the_scene_is_flat(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, PARTICLES, 0.04);
    assert_fluid(&fluid);
}

static void test_rdf_force_is_the_double_loop_when_precision_is_double(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.04);
    fluid.setup.precision = PAIR_DOUBLE;
    assert_fluid(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rdf_force_is_the_double_loop_when_the_box_is_long),
        cmocka_unit_test(test_rdf_force_is_the_double_loop_when_the_scene_is_flat),
        cmocka_unit_test(test_rdf_force_is_the_double_loop_when_precision_is_double),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
