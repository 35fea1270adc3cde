// SPDX-License-Identifier: GPL-3.0-or-later
//
// What blows up says so within a few steps, with the step and the largest force, and never crashes
// or hangs: for a fit it is a score like any other.
#include "curves/formula.h"
#include "curves/sampled.h"
#include "dynamics/metropolis.h"
#include "problem/evaluate.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <time.h>

enum { PARTICLES = 3000, FEW_STEPS = 20 };

/// Processor time that a blow-up may take [s]; measured: 0.1 at most. A list of all pairs of the
/// largest scene would take longer.
static const double patience = 3;

/// A simulation with `setup` is UNSTABLE in the first steps, and says when and how.
static void assert_unstable(const struct simulation_setup *setup,
                            const struct simulation_start *start) {
    struct simulation simulation;
    char step[64];
    const clock_t begin = clock();
    assert_ok(mf_simulation_init(&simulation, setup, start));
    const enum status status = mf_simulation_run(&simulation, FEW_STEPS);
    print_message("%s (%.2f s)\n", mf_status_message(), (double)(clock() - begin) / CLOCKS_PER_SEC);
    assert_int_equal(status, STATUS_UNSTABLE);
    assert_in_range(simulation.step, 1, FEW_STEPS);
    snprintf(step, sizeof step, "step %llu:", (unsigned long long)simulation.step);
    assert_contains(mf_status_message(), step);
    assert_contains(mf_status_message(), "largest force");
    assert_null(strstr(mf_status_message(), "-nan"));
    double temperature, limit; // if it tells them, they must be a reason
    const char *told = strstr(mf_status_message(), "temperature ");
    if (told && sscanf(told, "temperature %lf (limit %lf", &temperature, &limit) == 2)
        assert_false(temperature <= limit);
    assert_contains(mf_status_message(), "time_step");
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < patience);
    mf_simulation_clear(&simulation);
}

static void test_simulation_is_unstable_when_the_time_step_is_huge(void **state) {
    (void)state;
    static const double time_steps[] = {0.5, 100, 1e12, 1e200};
    for (size_t k = 0; k < sizeof time_steps / sizeof *time_steps; k++) {
        struct fluid fluid;
        fluid_groot_warren(&fluid, PARTICLES, time_steps[k]);
        assert_unstable(&fluid.setup, NULL);
        fluid.setup.omega = NULL;
        fluid.setup.integrator = &mf_velocity_verlet;
        assert_unstable(&fluid.setup, NULL);
        fluid_clear(&fluid);
        fluid_lennard_jones(&fluid, 864, time_steps[k]);
        assert_unstable(&fluid.setup, NULL);
        fluid_clear(&fluid);
        fluid_soft_discs(&fluid, PARTICLES, time_steps[k]);
        assert_unstable(&fluid.setup, NULL);
        fluid_clear(&fluid);
    }
}

static void test_simulation_is_unstable_soon_when_many_particles_are_flung_far(void **state) {
    (void)state;
    // Beyond 2⁵³ boxes a position has no place in its box: all particles meet in one corner.
    struct fluid fluid;
    fluid_groot_warren(&fluid, 40000, 1e200);
    assert_unstable(&fluid.setup, NULL);
    fluid_clear(&fluid);
    // The temperature of free flight is right however far it goes.
    fluid_ideal_gas(&fluid, 3, 40000, 1e200);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_velocity_verlet;
    assert_unstable(&fluid.setup, NULL);
    fluid_clear(&fluid);
}

/// Lennard-Jones with all particles on the same line, plane or spot of size `edge`.
static void assert_heap_is_unstable(const double edge[3]) {
    enum { HEAP = 500 };
    static double position[3][HEAP];
    struct simulation_start start = {.position = {position[0], position[1], position[2]}};
    struct fluid fluid;
    fluid_lennard_jones(&fluid, HEAP, 0.004);
    fluid.setup.placement.kind = PLACEMENT_FILE;
    for (int d = 0; d < 3; d++)
        for (int k = 0; k < HEAP; k++) {
            const double u = fmod((k + 1) * (0.6180339887 + 0.17 * d), 1);
            position[d][k] = 4 + edge[d] * u;
        }
    assert_unstable(&fluid.setup, &start);
    fluid_clear(&fluid);
}

static void test_simulation_is_unstable_when_particles_overlap(void **state) {
    (void)state;
    assert_heap_is_unstable((double[]){1, 1, 1});
    assert_heap_is_unstable((double[]){5, 0, 0});
    assert_heap_is_unstable((double[]){1e-6, 1e-6, 1e-6});
    // Two particles within 1e-4 of each other in a good liquid.
    struct fluid fluid;
    struct simulation good;
    fluid_lennard_jones(&fluid, 500, 0.004);
    assert_ok(mf_simulation_init(&good, &fluid.setup, NULL));
    for (int d = 0; d < 3; d++)
        good.particles.position[d][0] = good.particles.position[d][499] + (d == 0 ? 1e-4 : 0);
    const struct simulation_start start = {.position = {good.particles.position[0],
                                                        good.particles.position[1],
                                                        good.particles.position[2]}};
    fluid.setup.placement.kind = PLACEMENT_FILE;
    assert_unstable(&fluid.setup, &start);
    mf_simulation_clear(&good);
    fluid_clear(&fluid);
}

static void test_simulation_goes_on_when_two_particles_share_a_spot(void **state) {
    (void)state;
    // They have no direction, so no force; friction and noise of others part them.
    struct fluid fluid;
    struct simulation simulation;
    static double zero[3][2];
    const struct simulation_start start = {.position = {zero[0], zero[1], zero[2]}};
    fluid_groot_warren(&fluid, 2, 0.01);
    for (int d = 0; d < 3; d++)
        fluid.setup.box.length[d] = 3;
    fluid.setup.placement.kind = PLACEMENT_FILE;
    fluid.setup.temperature_limit = 1000;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, &start));
    assert_ok(mf_simulation_run(&simulation, 100));
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// A uniform force carries all along, by far faster than they move among each other; what is hot
/// besides is found as ever.
static void test_simulation_goes_on_when_it_drifts_as_a_whole(void **state) {
    (void)state;
    static const struct { double force[3]; } drift = {{100, 0, 0}};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation simulation;
        fluid_groot_warren(&fluid, PARTICLES, n == 0 ? 0.01 : 0.002);
        fluid.setup.interaction[0] = (struct interaction_choice){&mf_uniform_force, &drift};
        fluid.setup.interactions = 1;
        if (n == 1) {
            fluid.setup.omega = NULL;
            fluid.setup.integrator = &mf_brownian;
            fluid.setup.temperature = 0.1;
        }
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 200));
        const double speed = simulation.particles.velocity[0][0];
        assert_true(speed * speed > 0.5 * fluid.setup.temperature_limit);
        for (size_t k = 0; k < PARTICLES; k++)
            simulation.particles.force[1][k] += k % 2 ? 1e5 : -1e5;
        assert_int_equal(mf_simulation_run(&simulation, 1), STATUS_UNSTABLE);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// Values of Φ at 0, 0.25, …, 1, from `wild`.
static void make_wild_table(const double wild[5], struct table *table) {
    static const double r[] = {0, 0.25, 0.5, 0.75, 1};
    struct curve curve;
    assert_ok(mf_sampled_create(&curve, r, wild, 5));
    assert_ok(mf_table_init_potential(table, &curve));
    mf_curve_clear(&curve);
}

static const double wild[][5] = {
    {1e6, -1e6, 1e6, -1e6, 0},    {1e30, 0, -1e30, 1e30, 0},
    {1e39, 1e39, -1e39, 1e39, 0}, {1e300, -1e300, 1e300, 1e-300, 0},
    {NAN, NAN, NAN, NAN, NAN},    {-1e5, -1e5, -1e5, -1e5, 0},
    {INFINITY, 1, 0, 0, 0},
};
enum { WILD = sizeof wild / sizeof *wild };

static void test_simulation_is_unstable_when_the_table_is_wild(void **state) {
    (void)state;
    for (size_t k = 0; k < WILD; k++) {
        struct fluid fluid;
        struct table table;
        fluid_groot_warren(&fluid, PARTICLES, 0.01);
        make_wild_table(wild[k], &table);
        fluid.setup.potential = &table;
        assert_unstable(&fluid.setup, NULL);
        fluid.setup.omega = NULL;
        fluid.setup.integrator = &mf_velocity_verlet;
        assert_unstable(&fluid.setup, NULL);
        mf_table_clear(&table);
        fluid_clear(&fluid);
    }
}

static void test_metropolis_ends_when_the_table_is_wild(void **state) {
    (void)state;
    for (size_t k = 0; k < WILD; k++) {
        struct fluid fluid;
        struct table table;
        struct metropolis metropolis;
        fluid_groot_warren(&fluid, PARTICLES / 2, 0.01);
        make_wild_table(wild[k], &table);
        const clock_t begin = clock();
        assert_ok(mf_metropolis_init(&metropolis, &fluid.setup.box,
                                     &(struct composition){.types = 1, .count = {PARTICLES / 2}},
                                     &table, 1, 5));
        assert_ok(mf_metropolis_equilibrate(&metropolis, 20));
        assert_ok(mf_metropolis_run(&metropolis, 20));
        for (size_t i = 0; i < metropolis.particles.count; i++)
            assert_true(isfinite(metropolis.particles.position[0][i]));
        // A change of energy that is not a number is refused.
        if (isnan(wild[k][0]))
            assert_int_equal(metropolis.accepted, 0);
        assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < patience);
        mf_metropolis_clear(&metropolis);
        mf_table_clear(&table);
        fluid_clear(&fluid);
    }
}

static enum status measure(const struct inverse_problem *problem, const struct table *potential,
                           const struct evaluate_parameters *parameters,
                           struct evaluate_result *result) {
    const struct evaluate_candidate candidate = {.potential = potential,
                                                 .omega = problem->scene.omega,
                                                 .discard_above = HUGE_VAL,
                                                 .threads = 1,
                                                 .seed = 8};
    return mf_evaluate(problem, &candidate, parameters, NULL, NULL, NULL, result);
}

static void test_evaluate_is_a_score_when_the_potential_is_wild(void **state) {
    (void)state;
    enum { BINS = 10 };
    static const double target[BINS] = {0, 0, 0.5, 1, 1, 1, 1, 1, 1, 1}, none[BINS] = {0};
    const struct evaluate_parameters parameters = {
        .plan = {.equilibration = 200, .samples = 10, .every = 5}, .temperature_tolerance = 0.05};
    for (size_t k = 0; k < WILD; k++) {
        struct fluid fluid;
        struct table table;
        struct evaluate_result result;
        fluid_groot_warren(&fluid, 400, 0.01);
        make_wild_table(wild[k], &table);
        const struct inverse_problem problem = {
            .targets = {.bins = {0, 0.1, BINS},
                        .target[TARGET_RDF] = {.count = BINS, .value = target, .error = none}},
            .scene = fluid.setup,
            .threads = 1};
        assert_int_equal(measure(&problem, &table, &parameters, &result), STATUS_UNSTABLE);
        assert_in_range(result.engine_steps, 1, FEW_STEPS);
        assert_int_equal(result.failure, EVALUATE_BLEW_UP);
        mf_table_clear(&table);
        fluid_clear(&fluid);
    }
}

static void test_evaluate_is_a_score_when_particles_collapse(void **state) {
    (void)state;
    enum { BINS = 10 };
    static const double target[BINS] = {0, 0, 0.5, 1, 1, 1, 1, 1, 1, 1}, none[BINS] = {0};
    // All particles fall into one drop, which heats them: no limit of the temperature is to see it.
    struct formula_gaussian_parameters well = {.epsilon = -1, .sigma = 0.5, .cutoff = 1};
    const struct curve curve = {&mf_formula_gaussian, &well};
    const struct evaluate_parameters parameters = {
        .plan = {.equilibration = 2000, .samples = 10, .every = 5}, .temperature_tolerance = 1e6};
    struct fluid fluid;
    struct table table;
    struct evaluate_result result;
    fluid_groot_warren(&fluid, 400, 0.01);
    fluid.setup.temperature_limit = 1e6;
    assert_ok(mf_table_init_potential(&table, &curve));
    const struct inverse_problem problem = {
        .targets = {.bins = {0, 0.1, BINS},
                    .target[TARGET_RDF] = {.count = BINS, .value = target, .error = none}},
        .scene = fluid.setup,
        .threads = 1};
    assert_int_equal(measure(&problem, &table, &parameters, &result), STATUS_UNSTABLE);
    assert_contains(mf_status_message(), "collapsed");
    assert_int_equal(result.failure, EVALUATE_COLLAPSED);
    mf_table_clear(&table);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_simulation_is_unstable_when_the_time_step_is_huge),
        cmocka_unit_test(test_simulation_is_unstable_soon_when_many_particles_are_flung_far),
        cmocka_unit_test(test_simulation_is_unstable_when_particles_overlap),
        cmocka_unit_test(test_simulation_goes_on_when_two_particles_share_a_spot),
        cmocka_unit_test(test_simulation_goes_on_when_it_drifts_as_a_whole),
        cmocka_unit_test(test_simulation_is_unstable_when_the_table_is_wild),
        cmocka_unit_test(test_metropolis_ends_when_the_table_is_wild),
        cmocka_unit_test(test_evaluate_is_a_score_when_the_potential_is_wild),
        cmocka_unit_test(test_evaluate_is_a_score_when_particles_collapse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
