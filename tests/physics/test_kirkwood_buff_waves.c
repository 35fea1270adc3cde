// SPDX-License-Identifier: GPL-3.0-or-later
//
// Kirkwood and Buff's integrals of soft beads, by an equation of state and by the random phase
// approximation.
#include "base/statistics.h"
#include "curves/formula.h"
#include "observe/kirkwood_buff.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <math.h>

enum { PARTICLES = 1500, SAMPLES = 1000, MAX_PAIRS = 3 };

/// Standard errors by which a mean may be off beside what a theory is off.
static const double deviations = 4;

/// G of the pair types and their errors, by the observable.
static void measure(const struct simulation_setup *setup, double *value, double *error) {
    const struct measure_plan plan = {.equilibration = 400, .samples = SAMPLES, .every = 10};
    const struct observable *observable = &mf_kirkwood_buff_observable;
    const struct kirkwood_buff_settings settings = {0};
    static struct simulation simulation;
    struct observable_use uses[2] = {{.observable = observable}, {NULL, NULL, NULL}};
    struct observable_values values = {
        .count = (size_t)mf_composition_pairs(&setup->composition), .value = value, .error = error};
    double temperature;
    uses[0].state = mf_memory_zeroed(1, observable->state_size);
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(told_begin(observable, uses[0].state, &settings, &simulation, &plan));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(mf_measure_sample(&simulation, &plan, uses, NULL));
    assert_ok(mf_pooled_result(observable, (const void *const[]){uses[0].state}, 1, &values));
    observable->clear(uses[0].state);
    mf_memory_free(uses[0].state);
    mf_simulation_clear(&simulation);
}

/// p = ρ k_B T + 0.101 a ρ² (R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 (1997)), whose
/// slope is good within a few per cent: 1 + ρG = 1/(1 + 2 · 0.101 · 25 · 3) = 0.0619.
static void test_compressibility_of_soft_beads_is_that_of_their_equation_of_state(void **state) {
    (void)state;
    struct fluid fluid;
    double value[MAX_PAIRS] = {0}, error[MAX_PAIRS] = {0};
    fluid_groot_warren(&fluid, PARTICLES, 0.03);
    fluid.setup.composition = mf_composition_of_one(PARTICLES);
    measure(&fluid.setup, value, error);
    const double found = 1 + 3 * value[0], exact = 1 / (1 + 2 * 0.101 * 25 * 3);
    print_message("1 + rho G = %.4f(%.4f), by the equation of state %.4f\n", found, 3 * error[0],
                  exact);
    assert_true(3 * error[0] < 0.1 * exact);
    assert_close(found, exact, 0.05 * exact + deviations * 3 * error[0]);
    fluid_clear(&fluid);
}

/// Pressure of soft beads at a density.
static double find_pressure(double density, double *error) {
    const struct measure_plan plan = {.equilibration = 400, .samples = 300, .every = 10};
    static struct simulation simulation;
    struct fluid fluid;
    struct running_mean mean = {0};
    double temperature;
    fluid_groot_warren(&fluid, PARTICLES, 0.03);
    for (int d = 0; d < 3; d++)
        fluid.setup.box.length[d] = cbrt(PARTICLES / density);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    for (int k = 0; k < plan.samples; k++) {
        assert_ok(mf_simulation_run(&simulation, (uint64_t)plan.every - 1));
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, 1));
        mf_statistics_add(&mean, mf_simulation_pressure(&simulation));
    }
    *error = 2 * mf_statistics_standard_error(&mean); // of a memory of a few samples
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
    return mean.mean;
}

/// (∂P/∂ρ)_T of runs beside it is k_B T/S(0), without any equation of state.
static void test_compressibility_of_one_run_is_that_of_two_pressures(void **state) {
    (void)state;
    static const double step = 0.2;
    struct fluid fluid;
    double value[MAX_PAIRS] = {0}, error[MAX_PAIRS] = {0}, errors[2];
    fluid_groot_warren(&fluid, PARTICLES, 0.03);
    fluid.setup.composition = mf_composition_of_one(PARTICLES);
    measure(&fluid.setup, value, error);
    const double slope =
        (find_pressure(3 + step, &errors[0]) - find_pressure(3 - step, &errors[1])) / (2 * step);
    const double slope_error = hypot(errors[0], errors[1]) / (2 * step);
    const double found = 1 + 3 * value[0], product = found * slope;
    const double product_error = hypot(3 * error[0] * slope, found * slope_error);
    print_message("S(0) = %.4f(%.4f), dP/drho = %.3f(%.3f), product %.3f(%.3f)\n", found,
                  3 * error[0], slope, slope_error, product, product_error);
    assert_true(product_error < 0.08);
    assert_close(product, 1, 0.02 + deviations * product_error);
    fluid_clear(&fluid);
}

/// Points that know nothing of each other have S = 1 at every wave.
static void test_compressibility_of_an_ideal_gas_is_one(void **state) {
    (void)state;
    struct fluid fluid;
    double value[MAX_PAIRS] = {0}, error[MAX_PAIRS] = {0};
    fluid_ideal_gas(&fluid, 3, 500, 0.1);
    fluid.setup.composition = mf_composition_of_one(500);
    const double density = 500 / mf_box_volume(&fluid.setup.box);
    measure(&fluid.setup, value, error);
    print_message("S(0) = %.4f(%.4f) of an ideal gas\n", 1 + density * value[0],
                  density * error[0]);
    assert_true(density * error[0] < 0.1);
    assert_close(density * value[0], 0, deviations * density * error[0]);
    fluid_clear(&fluid);
}

/// Weak repulsion at density 3: c = −Φ/k_B T, so that 1/S = 1 + ρ_a (u ± u_AB) for all beads and
/// for the composition, u = π a/15. At a = 2 the approximation is off by a few per cent of S − 1;
/// at a = 25 it takes the composition's for twice as large as it is.
static void test_integrals_of_weak_beads_are_those_of_the_random_phase_approximation(void **state) {
    (void)state;
    static const double a[MAX_PAIRS] = {2, 1, 2}, density = 1.5, part = 0.1;
    struct fluid fluid;
    struct table tables[MAX_PAIRS], potential, omega;
    double value[MAX_PAIRS] = {0}, error[MAX_PAIRS] = {0};
    fluid_groot_warren(&fluid, PARTICLES, 0.03);
    for (int pair = 0; pair < MAX_PAIRS; pair++) {
        struct formula_soft_repulsion_parameters soft = {a[pair], 1};
        const struct curve curve = {&mf_formula_soft_repulsion, &soft};
        assert_ok(mf_table_init_potential(&tables[pair], &curve));
    }
    assert_ok(mf_table_stack(&potential, tables, MAX_PAIRS));
    fluid.setup.composition = (struct composition){
        .types = 2, .count = {PARTICLES / 2, PARTICLES / 2}, .name = {"A", "B"}};
    fluid.setup.potential = &potential;
    omega = fluid.omega;
    const struct table same[MAX_PAIRS] = {omega, omega, omega};
    struct table omegas;
    assert_ok(mf_table_stack(&omegas, same, MAX_PAIRS));
    fluid.setup.omega = &omegas;
    measure(&fluid.setup, value, error);
    const double like = 0.5 * (value[0] + value[2]), unit = M_PI / 15;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double found = density * (like + sign * value[1]);
        const double noise = density * hypot(error[0], error[1]);
        const double theory = 1 / (1 + density * unit * (a[0] + sign * a[1])) - 1;
        print_message("S - 1 of %s = %.4f(%.4f), theory %.4f\n", sign > 0 ? "all" : "composition",
                      found, noise, theory);
        assert_close(found, theory, part * fabs(theory) + deviations * noise);
    }
    for (int pair = 0; pair < MAX_PAIRS; pair++)
        mf_table_clear(&tables[pair]);
    mf_table_clear(&potential);
    mf_table_clear(&omegas);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_compressibility_of_soft_beads_is_that_of_their_equation_of_state),
        cmocka_unit_test(test_compressibility_of_one_run_is_that_of_two_pressures),
        cmocka_unit_test(test_compressibility_of_an_ideal_gas_is_one),
        cmocka_unit_test(test_integrals_of_weak_beads_are_those_of_the_random_phase_approximation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
