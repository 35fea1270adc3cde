// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/relax.h"
#include "shared/fluids.h"
#include "shared/testing.h"

/// Lennard-Jones near its triple point, placed with no regard to overlaps.
static void make_heap(struct fluid *fluid) {
    fluid_lennard_jones(fluid, 864, 0.004);
    fluid->setup.placement.kind = PLACEMENT_RANDOM;
    fluid->setup.placement.separation = 0;
}

static void test_simulation_begins_well_when_particles_overlap_at_random(void **state) {
    (void)state;
    struct fluid fluid;
    make_heap(&fluid);
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct simulation simulation;
        fluid.setup.seed = seed;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 500));
        mf_simulation_clear(&simulation);
    }
    fluid_clear(&fluid);
}

static void test_relax_gives_the_same_bits_when_there_are_threads(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation alone, shared;
    make_heap(&fluid);
    fluid.setup.threads = 1;
    assert_ok(mf_simulation_init(&alone, &fluid.setup, NULL));
    fluid.setup.threads = 2;
    assert_ok(mf_simulation_init(&shared, &fluid.setup, NULL));
    for (int d = 0; d < 3; d++)
        assert_memory_equal(alone.particles.position[d], shared.particles.position[d],
                            alone.particles.count * sizeof(double));
    mf_simulation_clear(&alone);
    mf_simulation_clear(&shared);
    fluid_clear(&fluid);
}

/// The forces of soft particles at random are no overlap, and neither is a lattice.
static void test_relax_moves_nothing_when_there_is_no_overlap(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    fluid_groot_warren(&fluid, 500, 0.04);
    fluid.setup.placement.kind = PLACEMENT_RANDOM;
    for (int soft = 0; soft < 2; soft++) {
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        const double before = simulation.particles.position[0][17];
        assert_ok(mf_relax_overlaps(&simulation));
        assert_true(simulation.particles.position[0][17] == before);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
        fluid_lennard_jones(&fluid, 864, 0.004);
    }
    fluid_clear(&fluid);
}

/// A heap of many particles takes minutes to part: who stops the run need not wait for that.
static void test_relax_ends_when_it_is_cancelled(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    const atomic_bool cancel = true;
    make_heap(&fluid);
    fluid.setup.cancel = &cancel;
    assert_fails(mf_simulation_init(&simulation, &fluid.setup, NULL), STATUS_INTERRUPTED,
                 "interrupted");
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_simulation_begins_well_when_particles_overlap_at_random),
        cmocka_unit_test(test_relax_gives_the_same_bits_when_there_are_threads),
        cmocka_unit_test(test_relax_moves_nothing_when_there_is_no_overlap),
        cmocka_unit_test(test_relax_ends_when_it_is_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
