// SPDX-License-Identifier: GPL-3.0-or-later
//
// A simulation that was saved in the middle, loaded into a new one and continued has the bits of
// one that went on in peace, whatever its integrator and while it is sampled.
#include "shared/fluids.h"
#include "shared/watched.h"
#include "shared/restart.h"
#include "shared/testing.h"

enum { BINS = 20, SAMPLES = 6, EVERY = 5, EQUILIBRATION = 4 };

static const struct measure_plan plan = {
    .equilibration = EQUILIBRATION, .samples = SAMPLES, .every = EVERY};

/// A simulation with all that is measured of it.
struct run {
    struct simulation simulation;
    struct rdf rdf;
    struct thermodynamics thermodynamics;
};

static void begin(struct run *run, const struct simulation_setup *setup) {
    const struct rdf_bins bins = {0, 1.0 / BINS, BINS};
    assert_ok(mf_simulation_init(&run->simulation, setup, NULL));
    const struct composition alike = mf_composition_of_one(setup->placement.count);
    assert_ok(mf_rdf_init_mixture(
        &run->rdf, &bins, &setup->box,
        composition_is_mixed(&setup->composition) ? &setup->composition : &alike, 1, SAMPLES));
    mf_thermodynamics_init(&run->thermodynamics);
}

static void clear(struct run *run) {
    mf_simulation_clear(&run->simulation);
    mf_rdf_clear(&run->rdf);
    mf_thermodynamics_clear(&run->thermodynamics);
}

static void sample(struct run *run, int64_t samples) {
    struct measure_plan part = plan;
    part.samples = samples;
    const struct watched observables = {.rdf = &run->rdf, .thermodynamics = &run->thermodynamics};
    assert_ok(watched_sample(&run->simulation, &part, observables, NULL));
}

/// All samples that are complete after `steps` steps, and the steps.
static void run_for(struct run *run, uint64_t steps) {
    if (steps >= EQUILIBRATION) {
        assert_ok(mf_simulation_run(&run->simulation, EQUILIBRATION));
        sample(run, ((int64_t)steps - EQUILIBRATION) / EVERY);
    }
    run->simulation.wants = PAIR_FORCES;
    assert_ok(mf_simulation_run(&run->simulation, steps - run->simulation.step));
}

static void run_to_the_end(struct run *run) {
    if (run->simulation.step < EQUILIBRATION)
        assert_ok(mf_simulation_run(&run->simulation, EQUILIBRATION - run->simulation.step));
    sample(run, SAMPLES);
}

static void assert_same(const struct run *a, const struct run *b) {
    restart_assert_same(&a->simulation, &b->simulation);
    assert_int_equal(a->rdf.blocks.taken, b->rdf.blocks.taken);
    assert_memory_equal(a->rdf.blocks.sums, b->rdf.blocks.sums,
                        a->rdf.blocks.count * a->rdf.pairs * BINS * sizeof(double));
    assert_int_equal(a->thermodynamics.series.count, SAMPLES);
    assert_int_equal(b->thermodynamics.series.count, SAMPLES);
    for (int q = 0; q < THERMODYNAMICS_QUANTITIES; q++)
        assert_memory_equal(mf_thermodynamics_series(&a->thermodynamics, q),
                            mf_thermodynamics_series(&b->thermodynamics, q),
                            SAMPLES * sizeof(double));
}

/// Every step of the run is one at which it is saved.
static void check(const struct simulation_setup *setup) {
    static struct run whole, pieces;
    begin(&whole, setup);
    run_for(&whole, EQUILIBRATION);
    run_to_the_end(&whole);
    assert_true(whole.simulation.list_builds > 1);
    for (uint64_t steps = 0; steps <= mf_measure_steps(&plan); steps += 3) {
        begin(&pieces, setup);
        run_for(&pieces, steps);
        restart_simulation(&pieces.simulation);
        run_to_the_end(&pieces);
        assert_same(&whole, &pieces);
        clear(&pieces);
    }
    clear(&whole);
}

/// With a skin so short that lists are built every few steps, at a sample's positions, too.
static void check_integrators(struct fluid *fluid) {
    fluid->setup.skin = 0.15;
    for (size_t k = 0; mf_integrator_list[k]; k++) {
        if (mf_integrator_list[k]->events)
            continue; // no forces, no list: test_hard_gas
        if (mf_integrator_list[k]
                ->solvent_particles) // whose cells divide other boxes: test_solvent
            continue;
        fluid->setup.integrator = mf_integrator_list[k];
        fluid->setup.omega = mf_integrator_list[k]->dissipative ? &fluid->omega : NULL;
        for (int precision = PAIR_MIXED; precision <= PAIR_DOUBLE; precision++) {
            fluid->setup.precision = precision;
            check(&fluid->setup);
        }
        fluid->setup.omega = NULL;
        check(&fluid->setup);
    }
    fluid_clear(fluid);
}

static void test_restart_goes_on_with_the_same_bits_when_sampled(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 300, 0.04);
    check_integrators(&fluid);
}

static void test_restart_goes_on_with_the_same_bits_when_types_differ(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_mixture(&fluid, 300, 0.04);
    check_integrators(&fluid);
}

static void test_restart_goes_on_with_the_same_bits_when_the_scene_is_flat(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, 200, 0.04);
    check_integrators(&fluid);
}

static void test_restart_goes_on_with_the_same_bits_when_there_is_no_potential(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_ideal_gas(&fluid, 3, 375, 0.04);
    fluid.setup.potential = NULL;
    check_integrators(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_restart_goes_on_with_the_same_bits_when_sampled),
        cmocka_unit_test(test_restart_goes_on_with_the_same_bits_when_types_differ),
        cmocka_unit_test(test_restart_goes_on_with_the_same_bits_when_the_scene_is_flat),
        cmocka_unit_test(test_restart_goes_on_with_the_same_bits_when_there_is_no_potential),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
