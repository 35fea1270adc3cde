// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hard discs and spheres from event to event: bits, energy, overlaps, and what is refused.
#include "base/interrupt.h"
#include "shared/fluids.h"
#include "shared/hard_gases.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

static const double diameters[2] = {1, 0.6}, masses[2] = {1, 3};

/// Mixtures in two dimensions with walls along y, and in three without.
static void make(struct hard_gas_scene *scene, int dimensions) {
    hard_gases_make_mixture(scene, dimensions, 400, 0.3, diameters, masses);
    scene->parameters.walls = dimensions == 2 ? 2 : 0;
}

static void test_event_driven_goes_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct hard_gas_scene scene;
        struct simulation whole, pieces;
        make(&scene, dimensions);
        assert_ok(mf_simulation_init(&whole, &scene.setup, NULL));
        assert_ok(mf_simulation_init(&pieces, &scene.setup, NULL));
        assert_ok(mf_simulation_run(&whole, 120)); // several epochs
        assert_ok(mf_simulation_run(&pieces, 53));
        restart_simulation(&pieces);
        assert_ok(mf_simulation_run(&pieces, 67));
        restart_assert_same(&whole, &pieces);
        assert_true(whole.sums.virial > 0);
        assert_identical(whole.sums.virial, pieces.sums.virial);
        mf_simulation_clear(&whole);
        mf_simulation_clear(&pieces);
    }
}

static void test_event_driven_has_the_same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    struct simulation alone, shared;
    make(&scene, 3);
    assert_ok(mf_simulation_init(&alone, &scene.setup, NULL));
    scene.setup.threads = 2;
    assert_ok(mf_simulation_init(&shared, &scene.setup, NULL));
    assert_ok(mf_simulation_run(&alone, 20));
    assert_ok(mf_simulation_run(&shared, 20));
    restart_assert_same(&alone, &shared);
    mf_simulation_clear(&alone);
    mf_simulation_clear(&shared);
}

/// So many bodies that memory is fetched ahead, which must change nothing, beside the same without.
static void test_event_driven_has_the_same_bits_when_memory_is_fetched_ahead(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct hard_gas_scene scene;
        struct simulation fetched, plain;
        hard_gases_make_mixture(&scene, dimensions, 31000, 0.2, diameters, masses);
        scene.parameters.walls = dimensions == 2 ? 2 : 0;
        assert_ok(mf_simulation_init(&fetched, &scene.setup, NULL));
        assert_ok(mf_simulation_init(&plain, &scene.setup, NULL));
        assert_non_null(hard_gases_of(&fetched)->calendar.fetch);
        struct hard_gas *gas = &((struct event_driven *)plain.integrator_state)->gas;
        mf_memory_free(gas->calendar.fetch);
        gas->calendar.fetch = NULL;
        assert_ok(mf_simulation_run(&fetched, 3));
        restart_simulation(&fetched);
        assert_ok(mf_simulation_run(&fetched, 3));
        assert_ok(mf_simulation_run(&plain, 6));
        restart_assert_same(&fetched, &plain);
        // A sum over all collisions, in their order.
        assert_identical(gas->now.tally.virial, hard_gases_of(&fetched)->now.tally.virial);
        assert_true(gas->now.tally.collisions > 10000);
        mf_simulation_clear(&fetched);
        mf_simulation_clear(&plain);
    }
}

/// Only where results are taken: velocities change in events alone, and so have the same bits.
static void test_event_driven_has_the_same_events_for_any_time_step(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    struct simulation coarse, fine;
    make(&scene, 2);
    scene.setup.time_step = 8;
    assert_ok(mf_simulation_init(&coarse, &scene.setup, NULL));
    scene.setup.time_step = 0.125;
    assert_ok(mf_simulation_init(&fine, &scene.setup, NULL));
    assert_ok(mf_simulation_run(&coarse, 1));
    assert_ok(mf_simulation_run(&fine, 64));
    for (int d = 0; d < 2; d++)
        assert_memory_equal(coarse.particles.velocity[d], fine.particles.velocity[d],
                            coarse.particles.count * sizeof(double));
    assert_true(hard_gases_of(&fine)->now.tally.collisions > 1000);
    mf_simulation_clear(&coarse);
    mf_simulation_clear(&fine);
}

static void test_event_driven_goes_on_when_it_was_interrupted_in_a_step(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    struct simulation whole, stopped;
    atomic_bool cancel = true;
    make(&scene, 2);
    scene.setup.time_step = 5;
    assert_ok(mf_simulation_init(&whole, &scene.setup, NULL));
    assert_ok(mf_simulation_init(&stopped, &scene.setup, NULL));
    assert_ok(mf_simulation_run(&whole, 2));
    assert_ok(mf_simulation_run(&stopped, 1));
    // Half of the step's collisions, and then a signal, after mf_simulation_run has looked.
    struct event_driven *own = stopped.integrator_state;
    const uint64_t collisions = own->gas.now.tally.collisions;
    assert_ok(mf_hard_gas_run(&own->gas, 1.5 * scene.setup.time_step, NULL));
    assert_true(own->gas.now.tally.collisions > collisions);
    stopped.setup.cancel = &cancel;
    stopped.step++;
    assert_int_equal(mf_event_driven.step(&stopped), STATUS_INTERRUPTED);
    assert_int_equal(stopped.step, 1);
    cancel = false;
    assert_ok(mf_simulation_run(&stopped, 1));
    restart_assert_same(&whole, &stopped);
    assert_close(stopped.sums.virial, whole.sums.virial, 0);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&stopped);
}

/// 10⁵ collisions here; ten million in test_kinetic_gas. Rounding walks: 3e5 turns of 1e-16.
static void test_event_driven_keeps_energy_and_momentum_and_no_two_overlap(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct hard_gas_scene scene;
        struct simulation simulation;
        hard_gases_make_mixture(&scene, dimensions, 400, 0.4, diameters, masses);
        assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
        const double energy = mf_particles_kinetic_energy(&simulation.particles);
        assert_close_relative(mf_particles_temperature(&simulation.particles), 1, 1e-13);
        const struct hard_gas_tally *tally = &hard_gases_of(&simulation)->now.tally;
        double gap = INFINITY;
        while (tally->collisions < 100000) {
            assert_ok(mf_simulation_run(&simulation, 1));
            gap = fmin(gap, hard_gases_smallest_gap(&simulation));
        }
        print_message("%d dimensions: energy off by %.1e, smallest gap %.1e, deepest overlap at a "
                      "collision %.1e\n",
                      dimensions, mf_particles_kinetic_energy(&simulation.particles) / energy - 1,
                      gap, tally->overlap);
        assert_close_relative(mf_particles_kinetic_energy(&simulation.particles), energy, 1e-13);
        for (int d = 0; d < dimensions; d++)
            assert_close(mf_particles_mean_velocity(&simulation.particles, d), 0, 1e-14);
        assert_true(gap > -1e-12);
        assert_true(tally->overlap < 1e-12);
        mf_simulation_clear(&simulation);
    }
}

/// Backwards from where it ended, it comes back to its start. Each collision multiplies errors by
/// the free path over the radius, which limits how many of each particle can be undone: here about
/// seven, of 10⁴ in all.
static void test_event_driven_comes_back_when_time_is_reversed(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    struct simulation forward, backward, origin;
    hard_gases_make(&scene, 2, 3000, 0.3);
    assert_ok(mf_simulation_init(&origin, &scene.setup, NULL));
    assert_ok(mf_simulation_init(&forward, &scene.setup, NULL));
    assert_ok(mf_simulation_run(&forward, 28));
    assert_true(hard_gases_of(&forward)->now.tally.collisions > 10000);
    for (int d = 0; d < 2; d++)
        for (size_t k = 0; k < forward.particles.count; k++)
            forward.particles.velocity[d][k] *= -1;
    fluid_continue(&backward, &scene.setup, &forward);
    assert_ok(mf_simulation_run(&backward, 28));
    double largest = 0, *place[2];
    for (int d = 0; d < 2; d++) {
        place[d] = calloc(origin.particles.count, sizeof(double));
        for (size_t k = 0; k < origin.particles.count; k++)
            place[d][origin.particles.id[k]] = origin.particles.position[d][k];
        // Those that go back have the places of the arrays for their ids.
        for (size_t k = 0; k < backward.particles.count; k++) {
            const uint32_t id = forward.particles.id[backward.particles.id[k]];
            const double off = backward.particles.position[d][k] - place[d][id];
            largest = fmax(largest, fabs(box_nearest(off, scene.setup.box.length[d])));
        }
        free(place[d]);
    }
    print_message("%llu collisions, and as many back: %.1e from the start at most\n",
                  (unsigned long long)hard_gases_of(&forward)->now.tally.collisions, largest);
    assert_true(largest < 1e-4);
    mf_simulation_clear(&origin);
    mf_simulation_clear(&forward);
    mf_simulation_clear(&backward);
}

/// On a lattice with equal speeds everything happens at once: in one bucket of the calendar.
static void test_event_driven_masters_events_at_one_time(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    struct simulation simulation;
    hard_gases_make(&scene, 2, 40000, 0.3);
    scene.setup.placement.kind = PLACEMENT_LATTICE;
    scene.setup.placement.speeds = PARTICLES_SIGNS;
    assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 5));
    const struct hard_gas_tally *tally = &hard_gases_of(&simulation)->now.tally;
    assert_true(tally->collisions > 1000);
    assert_true(tally->overlap < 1e-12);
    mf_simulation_clear(&simulation);
}

static void test_event_driven_places_particles_where_sequential_addition_cannot(void **state) {
    (void)state;
    static const double densest[4] = {0, 0, 0.5, 0.45};
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int kind = PLACEMENT_LATTICE; kind <= PLACEMENT_RANDOM; kind++) {
            struct hard_gas_scene scene;
            struct simulation simulation;
            hard_gases_make(&scene, dimensions, 1000, densest[dimensions]);
            scene.setup.placement.kind = kind;
            scene.setup.placement.jitter = 0.3;
            scene.parameters.walls = 1;
            assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
            assert_true(hard_gases_smallest_gap(&simulation) > -1e-9);
            mf_simulation_clear(&simulation);
        }
}

static void expect_refusal(const struct simulation_setup *setup,
                           const struct simulation_start *start, const char *words) {
    struct simulation simulation;
    assert_fails(mf_simulation_init(&simulation, setup, start), STATUS_BAD_INPUT, words);
}

static void test_event_driven_names_the_pair_that_overlaps(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    double x[] = {1, 4, 7, 7.9, 4}, y[] = {1, 4, 9.9, 0.3, 7};
    const struct simulation_start start = {.position = {x, y}};
    hard_gases_make(&scene, 2, 5, 0.05);
    scene.setup.box = (struct box){2, {10, 10, 1}};
    scene.setup.placement.kind = PLACEMENT_FILE;
    expect_refusal(&scene.setup, &start, "particles 2 and 3 overlap at the start: they are 0.98");
    x[3] = 8.1; // next to each other through the border
    scene.parameters.walls = 2;
    expect_refusal(&scene.setup, &start, "overlaps a wall of the axis y at the start");
    scene.parameters.walls = 4;
    expect_refusal(&scene.setup, &start, "dynamics.walls");
    scene.parameters.walls = 0;
    scene.setup.box.length[1] = 1.9;
    expect_refusal(&scene.setup, &start, "box: its edge 1.9 is below two diameters");
    hard_gases_make(&scene, 2, 100, 0.95);
    expect_refusal(&scene.setup, NULL, "overlap at the start");
}

static void test_event_driven_refuses_forces(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 100, 0.01);
    fluid.setup.integrator = &mf_event_driven;
    fluid.setup.omega = NULL;
    expect_refusal(&fluid.setup, NULL, "conservative: \"event-driven\" moves hard particles");
    fluid.setup.potential = NULL;
    fluid.setup.omega = &fluid.omega;
    expect_refusal(&fluid.setup, NULL, "dissipative: ");
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_event_driven_goes_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_event_driven_has_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(test_event_driven_has_the_same_events_for_any_time_step),
        cmocka_unit_test(test_event_driven_goes_on_when_it_was_interrupted_in_a_step),
        cmocka_unit_test(test_event_driven_keeps_energy_and_momentum_and_no_two_overlap),
        cmocka_unit_test(test_event_driven_comes_back_when_time_is_reversed),
        cmocka_unit_test(test_event_driven_masters_events_at_one_time),
        cmocka_unit_test(test_event_driven_places_particles_where_sequential_addition_cannot),
        cmocka_unit_test(test_event_driven_has_the_same_bits_when_memory_is_fetched_ahead),
        cmocka_unit_test(test_event_driven_names_the_pair_that_overlaps),
        cmocka_unit_test(test_event_driven_refuses_forces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
