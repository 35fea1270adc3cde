// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sums over pairs, the extrapolation, and where the covariance of forces would mean nothing. That
// it gives the friction weight is in tests/physics.
#include "observe/force_covariance.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 10 };

static const struct force_covariance_plan plan = {.range = 1, .bins = BINS};

static void test_force_covariance_equals_a_sum_over_all_pairs(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct force_covariance covariance;
    double products[BINS] = {0}, pairs[BINS] = {0}, kappa[BINS], error[BINS];
    fluid_soft_discs(&fluid, 100, 0.03);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_force_covariance_init(&covariance, &plan, &simulation, 1));
    assert_ok(mf_simulation_run(&simulation, 50));
    mf_force_covariance_sample(&covariance, &simulation);
    const struct particles *p = &simulation.particles;
    for (size_t i = 0; i < p->count; i++)
        for (size_t j = 0; j < i; j++) {
            const double r =
                hypot(box_nearest(p->position[0][i] - p->position[0][j], p->box.length[0]),
                      box_nearest(p->position[1][i] - p->position[1][j], p->box.length[1]));
            if (r >= 1)
                continue;
            products[(int)(r * BINS)] +=
                p->force[0][i] * p->force[0][j] + p->force[1][i] * p->force[1][j];
            pairs[(int)(r * BINS)]++;
        }
    mf_force_covariance_result(&covariance, kappa, error);
    for (int bin = 0; bin < BINS; bin++) {
        if (pairs[bin] > 0)
            assert_close_relative(kappa[bin], -0.03 * products[bin] / pairs[bin], 1e-9);
        else
            assert_true(isnan(kappa[bin]));
        assert_true(isnan(error[bin])); // of one sample
    }
    mf_force_covariance_clear(&covariance);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_force_covariance_init_refuses_where_it_would_mean_nothing(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct force_covariance covariance;
    fluid_groot_warren(&fluid, 100, 0.03);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    const struct force_covariance_plan far = {.range = 1.01, .bins = BINS};
    assert_fails(mf_force_covariance_init(&covariance, &far, &simulation, 1), STATUS_BAD_INPUT,
                 "the range 1.01 exceeds 1");
    mf_simulation_clear(&simulation);
    for (size_t k = 0; mf_integrator_list[k]; k++) {
        fluid.setup.integrator = mf_integrator_list[k];
        if (!mf_integrator_list[k]->friction || !mf_integrator_list[k]->dissipative)
            continue;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_fails(mf_force_covariance_init(&covariance, &plan, &simulation, 1), STATUS_BAD_INPUT,
                     "splits friction and noise off the forces");
        mf_simulation_clear(&simulation);
    }
    fluid.setup.integrator = &mf_velocity_verlet;
    fluid.setup.omega = NULL;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_fails(mf_force_covariance_init(&covariance, &plan, &simulation, 1), STATUS_BAD_INPUT,
                 "no friction weight");
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_force_covariance_equals_a_sum_over_all_pairs),
        cmocka_unit_test(test_force_covariance_init_refuses_where_it_would_mean_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
