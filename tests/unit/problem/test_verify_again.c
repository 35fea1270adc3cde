// SPDX-License-Identifier: GPL-3.0-or-later
//
// A verification that begins far from equilibrium, and is not given the time to get there.
#include "problem/verify.h"
#include "shared/fluids.h"
#include "shared/testing.h"

enum { PARTICLES = 300, BINS = 20, SAMPLES = 40, REPLICAS = 4 };

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// A lattice melts within some tens of steps, in which its energy rises. None is left for that, and
/// whoever began again from the lattice, for twice as long, would never be out of it.
static void test_verification_that_has_not_settled_goes_on(void **state) {
    (void)state;
    static double none[BINS];
    static const struct inverse_listener listener = {ignore, NULL};
    const struct verify_parameters parameters = {
        .replicas = REPLICAS, .plan = {.equilibration = 0, .samples = SAMPLES, .every = 1}};
    struct fluid fluid = {0};
    struct verification verification;
    fluid_groot_warren(&fluid, PARTICLES, 0.02);
    struct inverse_problem problem = {.scene = fluid.setup, .seed = 1, .threads = 1};
    problem.compared.bins = (struct rdf_bins){0, 0.05, BINS};
    problem.compared.target[TARGET_RDF] =
        (struct target){.count = BINS, .value = none, .error = none};
    assert_ok(mf_verify(&problem, &fluid.potential, fluid.setup.omega, &parameters, &listener,
                        &verification));
    const uint64_t first = (uint64_t)REPLICAS * SAMPLES;
    print_message("%d steps\n", (int)verification.engine_steps);
    assert_true(verification.engine_steps > first);
    assert_string_equal(verification.unequilibrated, "");
    mf_verify_clear(&verification);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verification_that_has_not_settled_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
