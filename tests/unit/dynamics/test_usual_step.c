// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/usual_step.h"

#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

/// Groot and Warren's Φ'' is a = 25 at all r: Ω² = 2 a, and Ω Δt = 0.2 makes the configurational
/// temperature 1 % too high. Beads at a density of 3 are ρ^(−1/3) apart.
static void test_usual_step_is_that_of_oscillations_and_free_flight(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 81, 0.02);
    const struct usual_step usual = mf_usual_step_find(&fluid.setup);
    assert_close(usual.curvature, 25, 0.1);
    assert_close(usual.pairs, 0.2 / sqrt(50), 1e-4);
    assert_close(usual.free, 0.02 * pow(3, -1.0 / 3), 1e-9);
    assert_true(isinf(usual.bonds));
    assert_int_equal(mf_usual_step_limit(&usual), USUAL_STEP_FREE);
    fluid_clear(&fluid);
    fluid_lennard_jones(&fluid, 100, 0.005);
    const struct usual_step steep = mf_usual_step_find(&fluid.setup);
    assert_int_equal(mf_usual_step_limit(&steep), USUAL_STEP_PAIRS);
    assert_true(steep.curvature_at > 0.85 && steep.curvature_at < 1);
    fluid_clear(&fluid);
}

static void test_usual_step_is_round(void **state) {
    (void)state;
    static const double values[][2] = {{0.0139, 0.012}, {0.001, 0.001}, {0.0299, 0.025}, {9, 8}};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++)
        assert_close(mf_usual_step_round(values[k][0]), values[k][1], 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_usual_step_is_that_of_oscillations_and_free_flight),
        cmocka_unit_test(test_usual_step_is_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
