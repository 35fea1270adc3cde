// SPDX-License-Identifier: GPL-3.0-or-later
//
// The pressure that a long time step makes wrong, and what the configurational temperature tells of
// it, against the same fluid with a step a quarter as long, whose error is a sixteenth.
#include "curves/sampled.h"
#include "dynamics/aboba.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/molecules.h"
#include "shared/testing.h"
#include "shared/watched.h"

#include <math.h>

/// What a simulation of `time` τ says of the pressure.
struct found {
    struct thermodynamics_summary summary;
    struct thermodynamics_shift shift;
};

static struct found simulate(struct fluid *fluid, double time_step, double apart, int64_t samples) {
    const int64_t every = (int64_t)rint(apart / time_step);
    const struct measure_plan plan = {
        .equilibration = 40 * every, .samples = samples, .every = every};
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    struct found found;
    double temperature;
    fluid->setup.integrator = &mf_aboba;
    fluid->setup.time_step = time_step;
    assert_ok(mf_simulation_init(&simulation, &fluid->setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(watched_sample(&simulation, &plan,
                             (struct watched){.thermodynamics = &thermodynamics}, NULL));
    found.summary = mf_thermodynamics_result(&thermodynamics, 1);
    found.shift = mf_thermodynamics_shift(&thermodynamics, 1, &found.summary, &simulation.setup);
    print_message("time step %g: T %.4f(%.4f), configurational %.4f(%.4f), pressure %.4f(%.4f), "
                  "of the step %.4f(%.4f)\n",
                  time_step, found.summary.temperature, found.summary.temperature_error,
                  found.summary.temperature_configurational,
                  found.summary.temperature_configurational_error, found.summary.pressure,
                  found.summary.pressure_error, found.shift.pressure, found.shift.error);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    return found;
}

/// Beads of water: a hard core inside a soft one, whose pressure a step moves most.
static void make_water(struct fluid *fluid, int64_t count) {
    const double edge = pow((double)count / 3.2743, 1.0 / 3);
    struct data_table table;
    struct curve curve = {0};
    double r[128], phi[128];
    fluid_groot_warren(fluid, count, 0.01);
    mf_table_clear(&fluid->potential);
    assert_ok(mf_data_table_read(&table, "targets/spc-water/potential_imc.tsv", 2));
    assert_true(table.rows <= 128);
    for (size_t k = 0; k < table.rows; k++) {
        r[k] = table.values[k * table.columns];
        phi[k] = table.values[k * table.columns + 1];
    }
    assert_ok(mf_sampled_create(&curve, r, phi, table.rows));
    assert_ok(mf_table_init_potential(&fluid->potential, &curve));
    mf_curve_clear(&curve);
    mf_data_table_clear(&table);
    for (int d = 0; d < 3; d++)
        fluid->setup.box.length[d] = edge;
}

/// Bonds, of which a step is not short; the configurational temperature sees that it is too long
/// for them, by (Ω Δt)²/4 of 0.64 less what aboba makes good.
static void check_trimers(void) {
    enum { TRIMERS = 60 };
    static const int type[3] = {0};
    static const struct molecules_number spring[] = {{"k", 200}, {"length", 0.6}, {NULL, 0}};
    struct fluid fluid;
    struct molecules molecules = {0};
    const struct composition composition =
        molecules_topology(&molecules.topology, molecules_chain(TRIMERS, type, 3, BONDED_BOND, 0),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    fluid_groot_warren(&fluid, 3 * TRIMERS, 0.04);
    molecules_enter(&fluid.setup, &molecules, &composition);
    const struct found found = simulate(&fluid, 0.04, 0.16, 800);
    assert_true(isnan(found.shift.pressure));
    assert_true(found.summary.temperature_configurational <
                1 - 2 * found.summary.temperature_configurational_error);
    mf_molecules_clear(&molecules);
    fluid_clear(&fluid);
}

/// Steps at whose end nothing is known, samples that are too few, and molecules.
static void test_time_step_shift_is_not_known_everywhere(void **state) {
    (void)state;
    struct fluid fluid;
    check_trimers();
    fluid_groot_warren(&fluid, 81, 0.02);
    assert_true(isnan(simulate(&fluid, 0.02, 0.02, 60).shift.pressure));
    fluid.setup.omega = NULL; // nothing holds the temperature
    assert_true(isnan(simulate(&fluid, 0.02, 0.02, 200).shift.pressure));
    fluid_clear(&fluid);
}

/// The pressure of two steps, within three errors of what is told of them, or `most`.
static struct found compare(struct fluid *fluid, double time_step, double shorter, double apart,
                            int64_t samples, double most, double *seen_change) {
    const struct found coarse = simulate(fluid, time_step, apart, samples);
    const struct found fine = simulate(fluid, shorter, apart, samples);
    const double seen = coarse.summary.pressure - fine.summary.pressure;
    const double told = coarse.shift.pressure - fine.shift.pressure;
    const double chance =
        sqrt(pow(coarse.summary.pressure_error, 2) + pow(fine.summary.pressure_error, 2) +
             pow(coarse.shift.error, 2) + pow(fine.shift.error, 2));
    print_message("seen %.4f, told %.4f, one error %.4f\n", seen, told, chance);
    assert_close(told, seen, fmin(3 * chance, most));
    *seen_change = seen;
    return coarse;
}

static void test_time_step_shift_is_what_a_shorter_step_takes_off(void **state) {
    (void)state;
    struct fluid fluid;
    double seen;
    make_water(&fluid, 400);
    const struct found coarse = compare(&fluid, 0.01, 0.005, 0.04, 600, 0.3, &seen);
    // Seen: -0.37(10), told -0.40(6).
    assert_true(seen < -0.1);
    assert_true(coarse.shift.pressure < -4 * coarse.shift.error);
    fluid_clear(&fluid);
}

/// With 6000 samples: seen -0.036(9), told -0.022(4).
static void test_time_step_shift_is_of_local_densities_too(void **state) {
    (void)state;
    struct fluid fluid;
    struct many_body crowd;
    double seen;
    fluid_groot_warren(&fluid, 200, 0.04);
    many_bodies_crowd(&crowd, 0.4, 1, 0.2, 4, &(struct composition){0});
    fluid.setup.interaction[fluid.setup.interactions++] =
        (struct interaction_choice){&mf_many_body, &crowd};
    const struct found coarse = compare(&fluid, 0.05, 0.0125, 0.2, 1500, 0.1, &seen);
    assert_true(coarse.shift.pressure < -3 * coarse.shift.error);
    mf_many_body_clear(&crowd);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_time_step_shift_is_what_a_shorter_step_takes_off),
        cmocka_unit_test(test_time_step_shift_is_of_local_densities_too),
        cmocka_unit_test(test_time_step_shift_is_not_known_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
