// SPDX-License-Identifier: GPL-3.0-or-later
//
// The shear viscosity by its two ways, of which one needs no stress and the other no flow, against
// each other and against what was published. Seeds are fixed; a deviation of four errors is one
// false alarm in 15,000.
#include "forces/shear_wave.h"
#include "observe/finite_size.h"
#include "observe/shear_viscosity.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/remembering.h"
#include "shared/testing.h"
#include "shared/told.h"
#include "shared/watched.h"

#include <math.h>
#include <stdlib.h>

static const double deviations = 4;

struct settings {
    int64_t every, lags;
};

static struct shear_viscosity_summary
measure(struct simulation *simulation, const struct measure_plan *plan, struct settings settings) {
    double temperature;
    void *state = calloc(1, mf_shear_viscosity.state_size);
    assert_non_null(state);
    assert_ok(told_begin(&mf_shear_viscosity, state, &settings, simulation, plan));
    const struct observable_use uses[] = {{.observable = &mf_shear_viscosity, .state = state}, {0}};
    assert_ok(mf_measure_equilibrate(simulation, plan, &temperature, NULL));
    assert_ok(mf_measure_sample(simulation, plan, uses, NULL));
    const struct shear_viscosity_summary s = mf_shear_viscosity_result(state);
    mf_shear_viscosity.clear(state);
    free(state);
    return s;
}

static struct shear_viscosity_summary simulate(const struct simulation_setup *setup,
                                               const struct measure_plan *plan,
                                               struct settings settings) {
    struct simulation simulation;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    const struct shear_viscosity_summary s = measure(&simulation, plan, settings);
    mf_simulation_clear(&simulation);
    return s;
}

/// In a smaller box, where less is to be done: its fluctuations tell as much.
static struct shear_viscosity_summary at_rest(const struct simulation_setup *setup) {
    enum { FEWER = 648 };
    const struct measure_plan plan = {
        .equilibration = 1000, .samples = length_is_long() ? 10000 : 1500, .every = 10};
    struct simulation_setup small = *setup;
    small.box = mf_box_scaled(&setup->box, (double)FEWER / (double)setup->placement.count);
    small.placement.count = FEWER;
    small.composition = mf_composition_of_one(FEWER);
    return simulate(&small, &plan, (struct settings){4, 128});
}

/// At rest, and driven to a flow of some tenths.
static struct shear_viscosity_summary check_drifts(struct simulation_setup *setup,
                                                   double acceleration) {
    const struct measure_plan plan = {
        .equilibration = 1500, .samples = length_is_long() ? 3000 : 500, .every = 10};
    const struct shear_wave_parameters wave = {acceleration};
    const struct shear_viscosity_summary rest = at_rest(setup);
    setup->interaction[0] = (struct interaction_choice){&mf_shear_wave, &wave};
    setup->interactions = 1;
    const struct shear_viscosity_summary driven =
        simulate(setup, &plan, (struct settings){10, 100});
    print_message("at rest %.3f(%.3f), window %.1f; driven %.3f(%.3f), V = %.3f, T = %.3f\n",
                  rest.value, rest.error, rest.window, driven.value, driven.error, driven.velocity,
                  driven.temperature);
    assert_close(rest.value, driven.value, deviations * hypot(rest.error, driven.error));
    assert_true(rest.error < (length_is_long() ? 0.1 : 0.2) * rest.value);
    assert_true(driven.error < (length_is_long() ? 0.04 : 0.08) * driven.value);
    return driven;
}

/// 0.85 is usually quoted for this fluid; the second digit was not traced to a table.
static void test_viscosity_of_the_standard_fluid_is_the_usual_one(void **state) {
    (void)state;
    static const double quoted = 0.85, uncertainty = 0.02;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 1536, 0.02);
    fluid.setup.integrator = &mf_aboba;
    const struct shear_viscosity_summary s = check_drifts(&fluid.setup, 0.035);
    assert_close(s.value, quoted, deviations * hypot(s.error, uncertainty));
    fluid_clear(&fluid);
}

/// Friction that remembers, and friction across pairs, whose stress is not symmetric.
static void test_viscosity_with_memory_is_the_same_by_both_ways(void **state) {
    (void)state;
    struct remembering r;
    remembering_make(&r, 1536, 0.02, REMEMBERING_SLOW | REMEMBERING_ACROSS);
    const struct shear_viscosity_summary s = check_drifts(&r.fluid.setup, 0.08);
    assert_true(s.value > 1); // of white friction alone: 0.85
    remembering_clear(&r);
}

/// 3.24(4) by M. Ferrario et al., Phys. Rev. A 44, 6936 (1991).
static void test_viscosity_of_a_lennard_jones_liquid_is_the_published_one(void **state) {
    (void)state;
    const struct measure_plan plan = {.equilibration = 1000, .samples = 8000, .every = 10};
    struct fluid fluid;
    struct simulation warm, simulation;
    fluid_lennard_jones(&fluid, 864, 0.005);
    fluid.setup.temperature = 0.722;
    assert_ok(mf_simulation_init(&warm, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&warm, 10000));
    struct simulation_setup setup = fluid.setup;
    setup.omega = NULL;
    setup.integrator = &mf_velocity_verlet;
    fluid_continue(&simulation, &setup, &warm);
    const struct shear_viscosity_summary s = measure(&simulation, &plan, (struct settings){4, 400});
    print_message("Lennard-Jones: %.3f(%.3f), window %.2f, T = %.4f\n", s.value, s.error, s.window,
                  mf_simulation_temperature(&simulation));
    assert_close(s.value, 3.24, 3 * hypot(s.error, 0.04));
    assert_true(s.error < 0.15 * s.value);
    mf_simulation_clear(&warm);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static struct motion_summary diffuse(int64_t count, int64_t samples) {
    const struct measure_plan plan = {.equilibration = 2000, .samples = samples, .every = 10};
    const struct motion_plan motion_plan = {.every = 10, .lags = 60, .origin_every = 5};
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    double temperature;
    fluid_groot_warren(&fluid, count, 0.02);
    fluid.setup.integrator = &mf_aboba;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(mf_motion_init(&motion, &motion_plan, &simulation, plan.equilibration,
                             samples * plan.every));
    assert_ok(watched_sample(&simulation, &plan, (struct watched){.motion = &motion}, NULL));
    const struct motion_summary s = mf_motion_result(&motion, NULL);
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
    return s;
}

/// Boxes of edges 4 and 10: their D differ, and those of infinite boxes agree.
static void test_diffusion_of_an_infinite_box_is_the_same_from_two_boxes(void **state) {
    (void)state;
    static const double viscosity = 0.83;
    static const double edge[] = {4, 10};
    const struct motion_summary s[] = {diffuse(192, 16000), diffuse(3000, 1500)};
    double infinite[2];
    for (int k = 0; k < 2; k++) {
        infinite[k] = s[k].msd + mf_finite_size_diffusion(1, viscosity, 3, s[k].msd, edge[k]);
        print_message("edge %g: D = %.4f(%.4f), of an infinite box %.4f, by eta alone %.4f\n",
                      edge[k], s[k].msd, s[k].msd_error, infinite[k],
                      s[k].msd + mf_finite_size_diffusion(1, viscosity, 0, s[k].msd, edge[k]));
    }
    const double error = hypot(s[0].msd_error, s[1].msd_error);
    assert_true(s[1].msd - s[0].msd > 4 * error);
    assert_close(infinite[0], infinite[1], deviations * error);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_viscosity_of_the_standard_fluid_is_the_usual_one),
        LENGTH_ONLY_LONG(cmocka_unit_test(test_viscosity_with_memory_is_the_same_by_both_ways)),
        LENGTH_ONLY_LONG(
            cmocka_unit_test(test_viscosity_of_a_lennard_jones_liquid_is_the_published_one)),
        LENGTH_ONLY_LONG(
            cmocka_unit_test(test_diffusion_of_an_infinite_box_is_the_same_from_two_boxes)),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
