// SPDX-License-Identifier: GPL-3.0-or-later
//
// A run that is interrupted, saved and resumed, several times, has the bits of one that went on in
// peace, also where friction and time step are so large that the physics is wrong, or the end is
// UNSTABLE.
#include "shared/fluids.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include "curves/formula.h"

enum { PARTICLES = 1000, STEPS = 200 };

/// Steps at which the run in pieces is saved.
static const uint64_t stops[] = {1, 2, 57, 58, 123, 199};

static const double frictions[] = {40, 200, 1000}, time_steps[] = {0.02, 0.05, 0.1, 0.2};

/// Run to step `end`, but not on from where it was unstable.
static enum status run_to(struct simulation *simulation, enum status before, uint64_t end) {
    if (before != STATUS_OK)
        return before;
    const enum status status = mf_simulation_run(simulation, end - simulation->step);
    assert_true(status == STATUS_OK || status == STATUS_UNSTABLE);
    return status;
}

/// Returns how the run ends.
static enum status check(const struct simulation_setup *setup) {
    struct simulation whole, pieces;
    assert_ok(mf_simulation_init(&whole, setup, NULL));
    assert_ok(mf_simulation_init(&pieces, setup, NULL));
    const enum status expected = run_to(&whole, STATUS_OK, STEPS);
    enum status status = STATUS_OK;
    for (size_t k = 0; k < sizeof stops / sizeof *stops && status == STATUS_OK; k++) {
        status = run_to(&pieces, status, stops[k]);
        if (status == STATUS_OK)
            restart_simulation(&pieces);
    }
    status = run_to(&pieces, status, STEPS);
    print_message("%s, time step %g, %d threads: %s at step %llu\n", setup->integrator->name,
                  setup->time_step, setup->threads, status == STATUS_OK ? "ends" : "unstable",
                  (unsigned long long)pieces.step);
    assert_int_equal(status, expected);
    if (status == STATUS_OK)
        restart_assert_same(&whole, &pieces);
    else // NaN has many bits
        assert_int_equal(pieces.step, whole.step);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&pieces);
    return status;
}

static void
test_restart_goes_on_with_the_same_bits_when_friction_and_time_step_are_large(void **state) {
    (void)state;
    int ended = 0, unstable = 0;
    for (size_t f = 0; f < sizeof frictions / sizeof *frictions; f++) {
        struct formula_power_omega_parameters parameters = {sqrt(frictions[f]), 1, 0, 1};
        const struct curve curve = {&mf_formula_power_omega, &parameters};
        struct table omega;
        assert_ok(mf_table_init_omega(&omega, &curve));
        for (size_t k = 0; mf_integrator_list[k]; k++)
            for (size_t t = 0; t < sizeof time_steps / sizeof *time_steps; t++) {
                if (!mf_integrator_list[k]->dissipative)
                    continue;
                struct fluid fluid;
                fluid_groot_warren(&fluid, PARTICLES, time_steps[t]);
                fluid.setup.omega = &omega;
                fluid.setup.integrator = mf_integrator_list[k];
                fluid.setup.temperature_limit = 20;
                fluid.setup.threads = 1 + (int)(t % 2);
                print_message("gamma %g: ", frictions[f]);
                *(check(&fluid.setup) == STATUS_OK ? &ended : &unstable) += 1;
                fluid_clear(&fluid);
            }
        mf_table_clear(&omega);
    }
    assert_true(ended >= 40);
    assert_true(unstable >= 10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            test_restart_goes_on_with_the_same_bits_when_friction_and_time_step_are_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
