// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every integrator from tiny to absurd time steps, at friction up to 1000:
// lab/stability.md.
#include "shared/stability.h"
#include "shared/testing.h"

enum { PARTICLES = 300, FRICTIONS = 4 };

static const double friction[FRICTIONS] = {4.5, 40, 200, 1000};

/// The largest time step that must be good at each friction.
static const struct {
    const struct integrator *integrator;
    double lambda;
    double good[FRICTIONS];
} limits[] = {
    {&mf_dpd_verlet, 0.5, {0.05, 0.02, 0.002, 0.0005}},
    {&mf_dpd_verlet, 0.65, {0.05, 0.02, 0.002, 0.0005}},
    {&mf_dpd_vv, 0, {0.05, 0.03, 0.005, 0.001}},
    {&mf_shardlow, 0, {0.05, 0.04, 0.04, 0.04}},
    {&mf_aboba, 0, {0.08, 0.1, 0.1, 0.1}},
    {&mf_aboba_implicit, 0, {0.08, 0.1, 0.06, 0.06}},
    {&mf_lowe_andersen, 0, {0.05, 0.04, 0.04, 0.04}},
};

/// From here on nothing is right.
static const double bad = 0.2;

static void test_time_steps_are_good_up_to_a_limit_and_never_silently_wrong(void **state) {
    (void)state;
    static const double time_steps[] = {1e-4, 0.0005, 0.001, 0.002, 0.005, 0.02, 0.03,
                                        0.04, 0.05,   0.06,  0.08,  0.1,   0.2,  0.3,
                                        0.5,  1,      10,    1e3,   1e6,   1e12, 1e100};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        for (int f = 0; f < FRICTIONS; f++)
            for (size_t t = 0; t < sizeof time_steps / sizeof *time_steps; t++) {
                const struct stability_case at = {limits[i].integrator, limits[i].lambda,
                                                  friction[f], time_steps[t]};
                const enum stability outcome = stability_of(&at, PARTICLES);
                if (time_steps[t] <= limits[i].good[f])
                    assert_int_equal(outcome, STABILITY_GOOD);
                if (time_steps[t] >= bad)
                    assert_true(outcome != STABILITY_GOOD);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_time_steps_are_good_up_to_a_limit_and_never_silently_wrong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
