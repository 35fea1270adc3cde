// SPDX-License-Identifier: GPL-3.0-or-later
//
// The escapes of all pairs are, one by one, those of a twin that stores its whole trajectory and
// looks at every pair of particles for every time origin. The twin computes distances from the
// positions themselves, without fractions of the box, lists or records.
#include "base/memory.h"
#include "shared/fluids.h"
#include "shared/watched.h"
#include "shared/testing.h"

enum { SAMPLES = 150, EQUILIBRATION = 40 };

/// Positions by id, shape [SAMPLES + 1, 3, count].
struct trajectory {
    struct box box;
    size_t count;
    double *values;
};

static double *find(const struct trajectory *trajectory, int64_t sample, int d) {
    return trajectory->values + ((size_t)sample * 3 + (size_t)d) * trajectory->count;
}

static void make_trajectory(struct trajectory *trajectory, const struct simulation_setup *setup,
                            int64_t every) {
    struct simulation simulation;
    *trajectory = (struct trajectory){setup->box, (size_t)setup->placement.count, NULL};
    trajectory->values =
        mf_memory_zeroed((SAMPLES + 1) * 3 * trajectory->count, sizeof *trajectory->values);
    assert_non_null(trajectory->values);
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_simulation_run(&simulation, EQUILIBRATION));
    for (int64_t sample = 0; sample <= SAMPLES; sample++) {
        const struct particles *particles = &simulation.particles;
        for (int d = 0; d < setup->box.dimensions; d++)
            for (size_t k = 0; k < particles->count; k++)
                find(trajectory, sample, d)[particles->id[k]] = particles->position[d][k];
        assert_ok(mf_simulation_run(&simulation, (uint64_t)every));
    }
    mf_simulation_clear(&simulation);
}

static double distance(const struct trajectory *trajectory, int64_t sample, size_t i, size_t j) {
    double square = 0;
    for (int d = 0; d < trajectory->box.dimensions; d++) {
        const double *x = find(trajectory, sample, d);
        const double nearest = box_nearest(x[i] - x[j], trajectory->box.length[d]);
        square += nearest * nearest;
    }
    return sqrt(square);
}

/// Add the pairs of one origin to `counts`, shape [times, bins], as etd.counts has them.
static void follow(const struct trajectory *trajectory, const struct etd_grid *grid, int64_t origin,
                   uint64_t *counts) {
    const double width = (grid->r_maximum - grid->r_minimum) / (double)grid->bins;
    for (size_t i = 0; i < trajectory->count; i++)
        for (size_t j = 0; j < i; j++) {
            const double r = distance(trajectory, origin, i, j);
            if (r < grid->r_minimum || r >= grid->r_maximum)
                continue;
            const int64_t bin = (int64_t)((r - grid->r_minimum) / width);
            counts[bin]++;
            for (int64_t time = 1; time < grid->times; time++)
                if (distance(trajectory, origin + time, i, j) >= grid->r_maximum) {
                    counts[time * grid->bins + bin]++;
                    break;
                }
        }
}

static void measure(const struct simulation_setup *setup, struct etd *etd,
                    const struct etd_grid *grid, const struct etd_plan *plan) {
    // Samples of other things fall on the same steps now and then. If forces are those of the
    // middle of the step, they build lists, which changes the last bits: there, one at the end.
    const int64_t steps = SAMPLES * plan->every;
    const int64_t often = setup->integrator->forces_midway ? steps : 10;
    const struct measure_plan when = {
        .equilibration = EQUILIBRATION, .samples = steps / often, .every = often};
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    double temperature;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_etd_init(etd, grid, plan, &simulation, EQUILIBRATION, steps));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &when, &temperature, NULL));
    const struct watched observables = {.thermodynamics = &thermodynamics, .etd = etd};
    assert_ok(watched_sample(&simulation, &when, observables, NULL));
    assert_true(mf_etd_due(etd) == INT64_MAX);
    // The list was built, and particles sorted, many times.
    assert_true(simulation.list_builds > 10);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
}

static void assert_etd(const struct simulation_setup *setup, const struct etd_grid *grid,
                       const struct etd_plan *plan) {
    struct trajectory trajectory;
    struct etd etd;
    uint64_t begun = 0, escaped = 0;
    make_trajectory(&trajectory, setup, plan->every);
    measure(setup, &etd, grid, plan);
    const int64_t origins = (SAMPLES - grid->times + 1) / plan->origin_every + 1;
    const size_t blocks = origins < 10 ? (size_t)origins : 10;
    assert_int_equal(etd.blocks, blocks);
    uint64_t *counts = mf_memory_zeroed(blocks * etd_cells(&etd), sizeof *counts);
    assert_non_null(counts);
    for (int64_t o = 0; o < origins; o++)
        follow(&trajectory, grid, o * plan->origin_every,
               counts + (size_t)o * blocks / (size_t)origins * etd_cells(&etd));
    for (size_t k = 0; k < blocks * etd_cells(&etd); k++) {
        assert_int_equal(etd.counts[k], counts[k]);
        *(k % etd_cells(&etd) < (size_t)grid->bins ? &begun : &escaped) += counts[k];
    }
    assert_true(begun > 1000);
    assert_true(escaped > begun / 100 && escaped <= begun);
    mf_memory_free(counts);
    mf_memory_free(trajectory.values);
    mf_etd_clear(&etd);
}

static const struct etd_grid grid = {.r_minimum = 0.4, .r_maximum = 0.9, .bins = 7, .times = 31};

static void test_etd_equals_that_of_a_stored_trajectory(void **state) {
    (void)state;
    const struct etd_plan plan = {.every = 1, .origin_every = 5};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 300, 0.04);
    assert_etd(&fluid.setup, &grid, &plan);
    fluid.setup.threads = 2;
    assert_etd(&fluid.setup, &grid, &plan);
    fluid.setup.precision = PAIR_DOUBLE;
    assert_etd(&fluid.setup, &grid, &plan);
    fluid_clear(&fluid);
}

static void test_etd_equals_that_of_a_stored_trajectory_when_windows_lie_otherwise(void **state) {
    (void)state;
    // Windows that overlap unevenly, touch, leave gaps; samples some steps apart.
    const struct etd_plan plans[] = {{2, 7}, {2, 30}, {2, 50}, {4, 29}, {2, 1}};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 200, 0.02);
    for (size_t k = 0; k < sizeof plans / sizeof *plans; k++)
        assert_etd(&fluid.setup, &grid, &plans[k]);
    fluid_clear(&fluid);
}

static void test_etd_equals_that_of_a_stored_trajectory_whatever_moves_the_particles(void **state) {
    (void)state;
    const struct etd_plan plan = {.every = 2, .origin_every = 4};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 200, 0.03);
    fluid.setup.integrator = &mf_aboba;
    assert_etd(&fluid.setup, &grid, &plan);
    fluid.setup.integrator = &mf_velocity_verlet;
    fluid.setup.omega = NULL;
    assert_etd(&fluid.setup, &grid, &plan);
    fluid_clear(&fluid);
}

static void test_etd_makes_its_own_list_when_that_of_the_forces_is_too_short(void **state) {
    (void)state;
    const struct etd_grid far = {.r_minimum = 0, .r_maximum = 1.7, .bins = 20, .times = 41};
    const struct etd_plan plan = {.every = 1, .origin_every = 8};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 200, 0.04);
    fluid.setup.integrator = &mf_aboba;
    assert_etd(&fluid.setup, &far, &plan);
    fluid_clear(&fluid);
}

/// Within the range of the list when it was built, but beyond it once particles have moved.
static void test_etd_makes_its_own_list_when_that_of_the_forces_is_worn(void **state) {
    (void)state;
    const struct etd_grid far = {.r_minimum = 0.9, .r_maximum = 1.25, .bins = 5, .times = 11};
    const struct etd_plan plan = {.every = 1, .origin_every = 3};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 200, 0.02);
    assert_etd(&fluid.setup, &far, &plan);
    fluid_clear(&fluid);
}

static void test_etd_equals_that_of_a_stored_trajectory_when_the_scene_is_flat(void **state) {
    (void)state;
    const struct etd_plan plan = {.every = 1, .origin_every = 5};
    struct fluid fluid;
    fluid_soft_discs(&fluid, 200, 0.04);
    assert_etd(&fluid.setup, &grid, &plan);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_etd_equals_that_of_a_stored_trajectory),
        cmocka_unit_test(test_etd_equals_that_of_a_stored_trajectory_when_windows_lie_otherwise),
        cmocka_unit_test(test_etd_equals_that_of_a_stored_trajectory_whatever_moves_the_particles),
        cmocka_unit_test(test_etd_makes_its_own_list_when_that_of_the_forces_is_too_short),
        cmocka_unit_test(test_etd_makes_its_own_list_when_that_of_the_forces_is_worn),
        cmocka_unit_test(test_etd_equals_that_of_a_stored_trajectory_when_the_scene_is_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
