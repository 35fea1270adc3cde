// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dynamics without velocities against what is known of them exactly, and against DPD, which samples
// the same ensemble. Seeds are fixed; each comparison allows 4.5 standard errors, a false alarm in
// 150,000.
#include "base/statistics.h"
#include "dynamics/brownian.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/watched.h"

#include <math.h>

static const double deviations = 4.5;

/// No interactions between them, in a box of edge 5, in 2 or 3 dimensions.
static void make_free(struct fluid *fluid, int dimensions, int64_t count, double time_step,
                      const struct brownian_parameters *parameters) {
    fluid_ideal_gas(fluid, dimensions, count, time_step);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_brownian;
    fluid->setup.integrator_parameters = parameters;
    fluid->setup.temperature_limit = 100; // they fall into a trap
}

/// MSD of free particles: 2 d D t at all times but for the first half step, D = k_B T/γ.
static void test_free_particles_diffuse_by_einsteins_law(void **state) {
    (void)state;
    enum { COUNT = 4000, STEPS = 100 };
    static const struct brownian_parameters parameters = {.friction = 2.5};
    struct fluid fluid;
    struct simulation simulation;
    make_free(&fluid, 3, COUNT, 0.01, &parameters);
    fluid.setup.temperature = 1.5;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    const struct particles *particles = &simulation.particles;
    static double start[COUNT][3];
    for (size_t k = 0; k < COUNT; k++)
        for (int d = 0; d < 3; d++)
            start[particles->id[k]][d] =
                particles->position[d][k] + particles->image[d][k] * particles->box.length[d];
    assert_ok(mf_simulation_run(&simulation, STEPS));
    double squares = 0;
    for (size_t k = 0; k < COUNT; k++)
        for (int d = 0; d < 3; d++)
            squares +=
                pow(particles->position[d][k] + particles->image[d][k] * particles->box.length[d] -
                        start[particles->id[k]][d],
                    2);
    // n steps add ½(R_0 + R_n) and n − 1 whole numbers: the variance of n − ½ of them.
    const double expected = 2 * 1.5 / 2.5 * 0.01 * (STEPS - 0.5);
    const double error = expected * sqrt(2.0 / (3.0 * COUNT));
    print_message("MSD along an axis %.5f, by Einstein %.5f(%.5f)\n", squares / (3.0 * COUNT),
                  expected, error);
    assert_close(squares / (3.0 * COUNT), expected, deviations * error);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// MSD(t) = 2 d D t + (f t/γ)² at every lag from the first on, of so few beads that the centre of
/// mass carries a quarter of it. Windows do not overlap, so that their number gives the error.
static void test_motion_of_free_particles_is_exact_at_every_lag(void **state) {
    (void)state;
    enum { COUNT = 4, LAGS = 10, WINDOWS = 4000 };
    static const struct brownian_parameters parameters = {.friction = 2.5};
    static const struct { double force[3]; } drift = {{0, 30, 0}};
    const struct motion_plan plan = {.every = 1, .lags = LAGS, .origin_every = LAGS};
    const struct measure_plan when = {.equilibration = 1, .samples = 1, .every = LAGS * WINDOWS};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation simulation;
        struct motion motion;
        double msd[LAGS + 1], msd_error[LAGS + 1], vacf[LAGS + 1], vacf_error[LAGS + 1];
        double temperature, max = 0;
        make_free(&fluid, 3, COUNT, 0.01, &parameters);
        fluid.setup.interaction[0] = (struct interaction_choice){&mf_uniform_force, &drift};
        fluid.setup.interactions = n;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_motion_init(&motion, &plan, &simulation, 1, when.every));
        assert_ok(mf_measure_equilibrate(&simulation, &when, &temperature, NULL));
        assert_ok(watched_sample(&simulation, &when, (struct watched){.motion = &motion}, NULL));
        const struct motion_curves curves = {msd, msd_error, vacf, vacf_error};
        const struct motion_summary s = mf_motion_result(&motion, &curves);
        for (int lag = 1; lag <= LAGS; lag++) {
            const double t = 0.01 * lag, square = 2 / 2.5 * t, way = n * 30 / 2.5 * t;
            const double variance = 6 * square * square + 4 * square * way * way;
            const double error = sqrt(variance / (COUNT * WINDOWS));
            const double off = (msd[lag] - 3 * square - way * way) / error;
            max = fmax(max, fabs(off));
            assert_close(off, 0, deviations);
            assert_true(isnan(vacf[lag]) && isnan(vacf_error[lag]));
        }
        print_message(
            "drift %g: MSD at the first lag %.5f, at most %.1f errors off; D %.4f(%.4f)\n",
            n * 30 / 2.5, msd[1], max, s.msd, s.msd_error);
        if (n == 0)
            assert_close(s.msd, 1 / 2.5, deviations * s.msd_error);
        assert_true(isnan(s.green_kubo) && isnan(mf_motion_green_kubo_uncertainty(&s)));
        assert_ok(mf_motion_assess(&s));
        mf_motion_clear(&motion);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// <x²> = k_B T/k at any stable time step: here k Δt/γ = 1 and 1.6, where the method of Euler and
/// Maruyama has 2 and 5 times as much.
static void test_trapped_particles_have_exact_width_at_large_time_steps(void **state) {
    (void)state;
    enum { COUNT = 500, SAMPLES = 200 };
    static const struct { double stiffness[3], centre[3]; } trap = {{10, 10, 0}, {1, 2, 0}};
    static const struct brownian_parameters parameters = {.friction = 1};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation simulation;
        struct running_mean squares = {0};
        make_free(&fluid, 2, COUNT, n == 0 ? 0.1 : 0.16, &parameters);
        fluid.setup.interaction[0] = (struct interaction_choice){&mf_harmonic_trap, &trap};
        fluid.setup.interactions = 1;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 100));
        for (int sample = 0; sample < SAMPLES; sample++) {
            assert_ok(mf_simulation_run(&simulation, 10)); // 0.6^10: independent
            double sum = 0;
            for (int d = 0; d < 2; d++)
                for (size_t k = 0; k < COUNT; k++)
                    sum += pow(box_nearest(simulation.particles.position[d][k] - trap.centre[d], 5),
                               2);
            mf_statistics_add(&squares, sum / (2 * COUNT));
        }
        const double error = 0.1 * sqrt(2.0 / (2.0 * COUNT * SAMPLES));
        print_message("k dt/gamma = %g: <x^2> = %.5f, by equipartition 0.1(%.5f)\n",
                      10 * fluid.setup.time_step, squares.mean, error);
        assert_close(squares.mean, 0.1, deviations * error);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

enum { PARTICLES = 648, BINS = 20 };

/// g(r), energy and pressure of the standard fluid.
static struct thermodynamics_summary simulate(const struct simulation_setup *setup,
                                              const struct measure_plan *plan, double *g,
                                              double *error) {
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    struct rdf rdf;
    double temperature;
    const struct rdf_bins bins = {.width = 1.0 / BINS, .count = BINS};
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_rdf_init(&rdf, &bins, &setup->box, PARTICLES, 1, (size_t)plan->samples));
    assert_ok(mf_measure_equilibrate(&simulation, plan, &temperature, NULL));
    const struct watched watched = {.rdf = &rdf, .thermodynamics = &thermodynamics};
    assert_ok(watched_sample(&simulation, plan, watched, NULL));
    assert_ok(mf_rdf_result(&rdf, 1, g, error));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    mf_rdf_clear(&rdf);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    return s;
}

/// The ensemble is that of DPD; both time steps are short enough that what they change is below the
/// noise: 0.001 in energy at k Δt/γ = 0.1 for the stiffest mode.
static void test_soft_fluid_has_the_structure_of_dpd(void **state) {
    (void)state;
    static const struct brownian_parameters parameters = {.friction = 1};
    const struct measure_plan plan[] = {{.equilibration = 1000, .samples = 400, .every = 20},
                                        {.equilibration = 500, .samples = 400, .every = 20}};
    double g[2][BINS], error[2][BINS], chi = 0;
    struct thermodynamics_summary s[2];
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        fluid_groot_warren(&fluid, PARTICLES, n == 0 ? 0.001 : 0.01);
        fluid.setup.integrator = n == 0 ? &mf_brownian : &mf_aboba;
        if (n == 0) {
            fluid.setup.omega = NULL;
            fluid.setup.integrator_parameters = &parameters;
        }
        s[n] = simulate(&fluid.setup, &plan[n], g[n], error[n]);
        print_message("%s: U/N %.4f(%.4f), pressure %.4f(%.4f), configurational %.4f(%.4f)\n",
                      fluid.setup.integrator->name, s[n].potential_energy,
                      s[n].potential_energy_error, s[n].pressure, s[n].pressure_error,
                      s[n].temperature_configurational, s[n].temperature_configurational_error);
        fluid_clear(&fluid);
    }
    for (int k = 4; k < BINS; k++)
        chi += pow((g[0][k] - g[1][k]) / hypot(error[0][k], error[1][k]), 2);
    print_message("g(r): chi^2 of %d bins %.1f\n", BINS - 4, chi);
    assert_true(chi < 60); // of 16 that hang together: one in a million by their own
    assert_close(s[0].potential_energy, s[1].potential_energy,
                 deviations * hypot(s[0].potential_energy_error, s[1].potential_energy_error));
    assert_close(s[0].pressure, s[1].pressure,
                 deviations * hypot(s[0].pressure_error, s[1].pressure_error));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_particles_diffuse_by_einsteins_law),
        cmocka_unit_test(test_motion_of_free_particles_is_exact_at_every_lag),
        cmocka_unit_test(test_trapped_particles_have_exact_width_at_large_time_steps),
        cmocka_unit_test(test_soft_fluid_has_the_structure_of_dpd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
