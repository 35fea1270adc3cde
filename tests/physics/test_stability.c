// SPDX-License-Identifier: GPL-3.0-or-later
//
// The time steps at which each integrator is still right and where it no longer is, at small and
// large friction: lab/stability.md. tests/stress looks at more of them.
#include "shared/stability.h"
#include "shared/testing.h"

/// Δt that is good, and one that is not: temperatures there are off by 20 % and more.
static const struct {
    const struct integrator *integrator;
    double lambda, friction;
    double good, bad;
} limits[] = {
    {&mf_dpd_verlet, 0.5, 4.5, 0.05, 0.1},
    {&mf_dpd_verlet, 0.5, 200, 0.002, 0.01},
    {&mf_dpd_verlet, 0.65, 4.5, 0.05, 0.1},
    {&mf_dpd_verlet, 0.65, 200, 0.002, 0.01},
    {&mf_dpd_vv, 0, 4.5, 0.05, 0.1},
    {&mf_dpd_vv, 0, 200, 0.005, 0.02},
    {&mf_shardlow, 0, 4.5, 0.05, 0.1},
    {&mf_shardlow, 0, 200, 0.04, 0.1},
    {&mf_aboba, 0, 4.5, 0.08, 0.15},
    {&mf_aboba, 0, 200, 0.1, 0.2},
    {&mf_aboba_implicit, 0, 4.5, 0.08, 0.15},
    {&mf_aboba_implicit, 0, 200, 0.06, 0.15},
    {&mf_lowe_andersen, 0, 4.5, 0.05, 0.1},
    {&mf_lowe_andersen, 0, 200, 0.04, 0.1},
    {&mf_dpd_verlet, 0.5, 1000, 0.0005, 0.002},
    {&mf_aboba, 0, 1000, 0.1, 0.2},
};

static void test_integrators_are_right_up_to_their_limits_and_never_silently_wrong(void **state) {
    (void)state;
    enum { PARTICLES = 300 };
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        struct stability_case at = {limits[k].integrator, limits[k].lambda, limits[k].friction,
                                    limits[k].good};
        assert_int_equal(stability_of(&at, PARTICLES), STABILITY_GOOD);
        at.time_step = limits[k].bad;
        assert_true(stability_of(&at, PARTICLES) != STABILITY_GOOD);
        at.time_step = 10 * limits[k].bad;
        assert_true(stability_of(&at, PARTICLES) != STABILITY_GOOD);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_integrators_are_right_up_to_their_limits_and_never_silently_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
