// SPDX-License-Identifier: GPL-3.0-or-later
//
// A simulation whose box is exchanged: its energy is that of one that begins in the other box, and
// g(r) of its configurations counts pairs by the volume that they have.
#include "dynamics/simulation_change.h"
#include "observe/rdf.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

enum { COUNT = 300, BINS = 20 };

/// All places and the box by a factor.
static void scale(const struct simulation *simulation, double factor, struct box *box,
                  double *position[3]) {
    *box = simulation->particles.box;
    for (int d = 0; d < 3; d++) {
        box->length[d] *= factor;
        for (size_t k = 0; k < COUNT; k++)
            position[d][simulation->particles.id[k]] =
                factor * simulation->particles.position[d][k];
    }
}

static double energy_of(struct simulation *simulation) {
    simulation->wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_compute_forces(simulation, 0));
    return simulation->sums.energy;
}

static void compare(double factor) {
    static double places[3][COUNT];
    double *position[3] = {places[0], places[1], places[2]};
    struct fluid fluid;
    struct simulation changed, begun;
    struct box box;
    fluid_groot_warren(&fluid, COUNT, 0.02);
    assert_ok(mf_simulation_init(&changed, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&changed, 20));
    scale(&changed, factor, &box, position);
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < COUNT; k++)
            changed.particles.position[d][k] = position[d][changed.particles.id[k]];
    assert_ok(mf_simulation_set_box(&changed, &box));
    struct simulation_setup setup = fluid.setup;
    setup.box = box;
    setup.placement.kind = PLACEMENT_FILE;
    const struct simulation_start start = {.position = {position[0], position[1], position[2]}};
    assert_ok(mf_simulation_init(&begun, &setup, &start));
    assert_close(energy_of(&changed), energy_of(&begun), 1e-3);

    const struct rdf_bins bins = {.width = 0.05, .count = BINS};
    double g[2][BINS];
    struct rdf rdf[2];
    assert_ok(mf_rdf_init(&rdf[0], &bins, &fluid.setup.box, COUNT, 1, 1));
    assert_ok(mf_rdf_init(&rdf[1], &bins, &box, COUNT, 1, 1));
    mf_rdf_set_volume(&rdf[0], mf_box_volume(&box));
    assert_ok(mf_rdf_sample(&rdf[0], &changed.particles, &changed.neighbours));
    assert_ok(mf_rdf_sample(&rdf[1], &begun.particles, &begun.neighbours));
    for (int k = 0; k < 2; k++) {
        assert_ok(mf_rdf_result(&rdf[k], 1, g[k], NULL));
        mf_rdf_clear(&rdf[k]);
    }
    for (int k = 0; k < BINS; k++)
        assert_close(g[0][k], g[1][k], 1e-9);
    mf_simulation_clear(&changed);
    mf_simulation_clear(&begun);
    fluid_clear(&fluid);
}

static void test_another_box_is_that_of_a_simulation_that_begins_in_it(void **state) {
    (void)state;
    compare(1.07);
    compare(0.9);
    compare(1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_another_box_is_that_of_a_simulation_that_begins_in_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
