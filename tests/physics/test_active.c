// SPDX-License-Identifier: GPL-3.0-or-later
//
// Active Brownian particles against what is known of them exactly. Seeds are fixed; comparisons
// allow 4 standard errors, a false alarm in 16,000 each, unless they say otherwise.
#include "base/statistics.h"
#include "dynamics/brownian.h"
#include "dynamics/metropolis.h"
#include "observe/measure.h"
#include "observe/polarity.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/told.h"
#include "shared/watched.h"

#include <math.h>

extern const struct observable mf_polarity_observable;

static const double deviations = 4;

static const struct { double force; } propulsion = {2};

static void make_free(struct fluid *fluid, int64_t count, double time_step,
                      const struct integrator *integrator,
                      const struct brownian_parameters *parameters) {
    fluid_ideal_gas(fluid, 2, count, time_step);
    fluid->setup.omega = NULL;
    fluid->setup.temperature = 0.1;
    fluid->setup.integrator = integrator;
    fluid->setup.integrator_parameters = parameters;
    fluid->setup.interaction[0] = (struct interaction_choice){&mf_self_propulsion, &propulsion};
    fluid->setup.interactions = 1;
}

/// ⟨n(t)·n(0)⟩ = exp(−D_r t) and the MSD of ten Hagen, van Teeffelen and Löwen (2011) at five
/// times, of both integrators. Errors are those of independent particles.
static void test_free_particles_walk_by_the_exact_law(void **state) {
    (void)state;
    enum { COUNT = 8000, PIECES = 5 };
    static const struct brownian_parameters parameters = {2, 1.5, 1.2};
    static const struct integrator *const integrators[] = {&mf_brownian, &mf_brownian_euler};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation simulation;
        struct motion motion[2];
        const struct motion_plan plan = {.every = 1, .lags = 2, .origin_every = 1};
        make_free(&fluid, COUNT, 0.02, integrators[n], &parameters);
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        const struct brownian_free law = mf_brownian_free(&fluid.setup);
        assert_close(law.speed, 1, 1e-15);
        assert_close(law.orientation_diffusion, 0.8, 1e-15);
        assert_close(law.diffusion, 0.05, 1e-15);
        for (int k = 0; k < 2; k++) {
            assert_ok(mf_motion_init(&motion[k], &plan, &simulation, 0, 100));
            motion[k].polar = true;
        }
        mf_motion_sample(&motion[0], &simulation);
        for (int piece = 1; piece <= PIECES; piece++) {
            assert_ok(mf_simulation_run(&simulation, 40));
            motion[1].samples = 0;
            mf_motion_sample(&motion[1], &simulation);
            const double t = 0.8 * piece;
            struct running_mean msd = {0}, cosine = {0};
            for (size_t k = 0; k < COUNT; k++) {
                double square = 0, product = 0;
                for (int d = 0; d < 2; d++) {
                    const size_t place = (size_t)d * COUNT + k;
                    square += pow(motion[1].now[place] - motion[0].now[place], 2);
                    product += motion[1].now[2 * COUNT + place] * motion[0].now[2 * COUNT + place];
                }
                mf_statistics_add(&msd, square);
                mf_statistics_add(&cosine, product);
            }
            const double msd_error = mf_statistics_standard_error(&msd);
            const double cosine_error = mf_statistics_standard_error(&cosine);
            print_message(
                "%s, t = %.1f: MSD %.4f(%.4f), exact %.4f; <n.n> %.4f(%.4f), exact %.4f\n",
                integrators[n]->name, t, msd.mean, msd_error, mf_brownian_free_msd(&law, t),
                cosine.mean, cosine_error, exp(-0.8 * t));
            assert_close(msd.mean, mf_brownian_free_msd(&law, t), 3 * msd_error);
            assert_close(cosine.mean, exp(-0.8 * t), 3 * cosine_error);
        }
        for (int k = 0; k < 2; k++)
            mf_motion_clear(&motion[k]);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// The polarity observable finds D_eff, v_0 and D_r again.
static void test_fit_of_the_msd_finds_its_numbers(void **state) {
    (void)state;
    static const struct brownian_parameters parameters = {1, 1, 1};
    const struct measure_plan plan = {.equilibration = 0, .samples = 400, .every = 10};
    const struct motion_plan window = {.every = 10, .lags = 40, .origin_every = 5};
    struct fluid fluid;
    struct simulation simulation;
    struct polarity polarity = {0};
    make_free(&fluid, 1000, 0.01, &mf_brownian, &parameters);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(told_begin(&mf_polarity_observable, &polarity, &window, &simulation, &plan));
    assert_true(polarity.noninteracting);
    const struct observable_use uses[] = {{&mf_polarity_observable, &polarity, NULL}, {0}};
    assert_ok(mf_measure_sample(&simulation, &plan, uses, NULL));
    const struct polarity_fit fit = mf_polarity_fit(&polarity);
    print_message("D %.3f(%.3f), exact 2.1; v_0 %.3f(%.3f), 2; D_r %.3f(%.3f), 1\n",
                  fit.effective_diffusion, fit.effective_diffusion_error, fit.speed,
                  fit.speed_error, fit.orientation_diffusion, fit.orientation_diffusion_error);
    assert_close(fit.effective_diffusion, 2.1, deviations * fit.effective_diffusion_error);
    assert_close(fit.speed, 2, deviations * fit.speed_error);
    assert_close(fit.orientation_diffusion, 1, deviations * fit.orientation_diffusion_error);
    assert_true(fit.effective_diffusion_error < 0.1 && fit.speed_error < 0.1);
    mf_polarity_observable.clear(&polarity);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Weak order: particles in a trap, <x²> of Euler and Maruyama is T/k · 1/(1 − k Δt/2γ), that of
/// Leimkuhler and Matthews is exact; independent samples give the error.
static void test_euler_maruyama_is_of_first_order_and_brownian_better(void **state) {
    (void)state;
    enum { COUNT = 2000, SAMPLES = 60 };
    static const struct { double stiffness[3], centre[3]; } trap = {{10, 10, 0}, {2.5, 2.5, 0}};
    static const struct brownian_parameters parameters = {1, 1, 1};
    static const double steps[] = {0.1, 0.05, 0.025};
    for (int n = 0; n < 6; n++) {
        struct fluid fluid;
        struct simulation simulation;
        struct running_mean squares = {0};
        const double time_step = steps[n % 3];
        make_free(&fluid, COUNT, time_step, n < 3 ? &mf_brownian : &mf_brownian_euler, &parameters);
        fluid.setup.temperature = 1;
        fluid.setup.temperature_limit = 100;
        fluid.setup.interaction[0] = (struct interaction_choice){&mf_harmonic_trap, &trap};
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 100));
        for (int sample = 0; sample < SAMPLES; sample++) {
            assert_ok(mf_simulation_run(&simulation, (uint64_t)(0.5 / time_step)));
            double sum = 0;
            for (int d = 0; d < 2; d++)
                for (size_t k = 0; k < COUNT; k++)
                    sum += pow(box_nearest(simulation.particles.position[d][k] - 2.5, 5), 2);
            mf_statistics_add(&squares, sum / (2 * COUNT));
        }
        const double expected = n < 3 ? 0.1 : 0.1 / (1 - 5 * time_step);
        const double error = expected * sqrt(2.0 / (2.0 * COUNT * SAMPLES)) * 1.05;
        print_message("%s, k dt/gamma = %g: <x^2> = %.5f(%.5f), by theory %.5f\n",
                      fluid.setup.integrator->name, 10 * time_step, squares.mean, error, expected);
        assert_close(squares.mean, expected, deviations * error);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// |<n>| without alignment: <|n|²> = 1/N; and near 1 with much of it.
static void test_order_is_that_of_chance_without_alignment_and_high_with_it(void **state) {
    (void)state;
    enum { COUNT = 900 };
    static const struct { double coupling, range; } alignment = {1, 2};
    static const struct brownian_parameters parameters = {1, 1, 0.1};
    const struct measure_plan plan = {.equilibration = 3000, .samples = 60, .every = 50};
    const struct motion_plan window = {.every = 50, .lags = 2, .origin_every = 1};
    for (int aligned = 0; aligned < 2; aligned++) {
        struct fluid fluid;
        struct simulation simulation;
        struct polarity polarity = {0};
        double squares = 0, min = 1, temperature;
        make_free(&fluid, COUNT, 0.02, &mf_brownian, &parameters);
        fluid.setup.temperature = 0;
        fluid.setup.box = (struct box){2, {30, 30, 1}};
        fluid.setup.interaction[1] = (struct interaction_choice){&mf_polar_alignment, &alignment};
        fluid.setup.interactions = 1 + aligned;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(told_begin(&mf_polarity_observable, &polarity, &window, &simulation, &plan));
        const struct observable_use uses[] = {{&mf_polarity_observable, &polarity, NULL}, {0}};
        assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
        assert_ok(mf_measure_sample(&simulation, &plan, uses, NULL));
        const double *order = sample_series_column(&polarity.order, 0);
        for (size_t k = 0; k < polarity.order.count; k++) {
            squares += pow(order[k], 2) / (double)polarity.order.count;
            min = fmin(min, order[k]);
        }
        print_message("%s: N <|n|^2> = %.3f, least order %.3f\n", aligned ? "aligned" : "alone",
                      COUNT * squares, min);
        // An order keeps for 1/D_r, 10 of 60: 6 independent exponential numbers of mean 1.
        if (aligned)
            assert_true(min > 0.9);
        else
            assert_close(COUNT * squares, 1, 3);
        mf_polarity_observable.clear(&polarity);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

enum { DISCS = 400, BINS = 20 };

/// Soft discs without activity: g(r) and energy of Brownian dynamics are those of Metropolis.
static void test_discs_have_the_structure_of_metropolis(void **state) {
    (void)state;
    static const struct brownian_parameters parameters = {1, 1, 1};
    const struct measure_plan plan = {.equilibration = 2000, .samples = 600, .every = 20};
    const struct rdf_bins bins = {.width = 1.0 / BINS, .count = BINS};
    double g[2][BINS], error[2][BINS], chi = 0, temperature;
    struct fluid fluid;
    struct simulation simulation;
    struct metropolis metropolis;
    struct rdf rdf;
    fluid_soft_discs(&fluid, DISCS, 0.001);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_brownian;
    fluid.setup.integrator_parameters = &parameters;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_rdf_init(&rdf, &bins, &fluid.setup.box, DISCS, 1, (size_t)plan.samples));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(watched_sample(&simulation, &plan, (struct watched){.rdf = &rdf}, NULL));
    assert_ok(mf_rdf_result(&rdf, 1, g[0], error[0]));
    mf_rdf_clear(&rdf);
    mf_simulation_clear(&simulation);
    assert_ok(mf_metropolis_init(&metropolis, &fluid.setup.box, &fluid.setup.composition,
                                 fluid.setup.potential, fluid.setup.temperature, 5));
    assert_ok(mf_rdf_init(&rdf, &bins, &fluid.setup.box, DISCS, 0, (size_t)plan.samples));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 500));
    for (int64_t sample = 0; sample < plan.samples; sample++) {
        assert_ok(mf_metropolis_run(&metropolis, 10));
        assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
    }
    assert_ok(mf_rdf_result(&rdf, 1, g[1], error[1]));
    mf_rdf_clear(&rdf);
    mf_metropolis_clear(&metropolis);
    for (int k = 2; k < BINS; k++)
        chi += pow((g[0][k] - g[1][k]) / hypot(error[0][k], error[1][k]), 2);
    print_message("g(r) of discs: chi^2 of %d bins %.1f\n", BINS - 2, chi);
    assert_true(chi < 50); // of 18: one in 15,000
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_particles_walk_by_the_exact_law),
        cmocka_unit_test(test_fit_of_the_msd_finds_its_numbers),
        cmocka_unit_test(test_euler_maruyama_is_of_first_order_and_brownian_better),
        cmocka_unit_test(test_order_is_that_of_chance_without_alignment_and_high_with_it),
        cmocka_unit_test(test_discs_have_the_structure_of_metropolis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
