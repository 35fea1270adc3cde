// SPDX-License-Identifier: GPL-3.0-or-later
//
// Friction of all pairs at once by the implicit midpoint rule: the solution of its linear system.
#include "forces/friction.h"

#include "base/memory.h"
#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/kept_pairs.h"
#include "shared/testing.h"

#include <math.h>

static struct table soft, omega;

static int make_tables(void **state) {
    (void)state;
    struct formula_soft_repulsion_parameters repulsion = {25, 1};
    struct formula_power_omega_parameters friction = {sqrt(4.5), 1, 0, 1};
    const struct curve potential = {&mf_formula_soft_repulsion, &repulsion},
                       curve = {&mf_formula_power_omega, &friction};
    assert_ok(mf_table_init_potential(&soft, &potential));
    assert_ok(mf_table_init_omega(&omega, &curve));
    return 0;
}

static int clear_tables(void **state) {
    (void)state;
    mf_table_clear(&soft);
    mf_table_clear(&omega);
    return 0;
}

/// Residual of (1 + G) v' = (1 − G) v + kicks, over the change kicks − 2 G v.
static double find_residual(const struct kept_pairs *kept, double (*before)[4]) {
    const struct particles *particles = &kept->particles;
    const size_t count = particles->count;
    double(*now)[4] = mf_memory_zeroed(count, sizeof *now);
    double(*twice)[4] = mf_memory_zeroed(count, sizeof *twice);
    double(*change)[4] = mf_memory_zeroed(count, sizeof *change);
    double(*moved)[4] = mf_memory_zeroed(count, sizeof *moved);
    double residual = 0, size = 0;
    for (size_t k = 0; k < count; k++)
        for (int d = 0; d < 3; d++) {
            now[k][d] = particles->velocity[d][k] - before[k][d];
            twice[k][d] = 2 * before[k][d];
        }
    // (1 + G)(v' − v) = kicks − 2 G v; mf_friction_apply is −G, with the kicks or without.
    mf_friction_apply(&kept->friction, particles, (const double(*)[4])twice, change, true);
    mf_friction_apply(&kept->friction, particles, (const double(*)[4])now, moved, false);
    for (size_t k = 0; k < count; k++)
        for (int d = 0; d < 3; d++) {
            const double r = now[k][d] - moved[k][d] - change[k][d];
            residual += r * r;
            size += change[k][d] * change[k][d];
        }
    mf_memory_free(now);
    mf_memory_free(twice);
    mf_memory_free(change);
    mf_memory_free(moved);
    return sqrt(residual / size);
}

static void check_solution(double time_step, double tolerance, double more) {
    struct kept_pairs kept = {.law = kept_pairs_law(&soft, &omega, time_step)};
    double momentum[3], size, before[443][4] = {{0}};
    kept_pairs_init(&kept, &(struct box){3, {5.1, 4.6, 6.3}}, 443, 0);
    kept_pairs_use(&kept, &mf_aboba_implicit);
    kept_pairs_keep(&kept, 3);
    for (size_t k = 0; k < 443; k++)
        for (int d = 0; d < 3; d++)
            before[k][d] = kept.particles.velocity[d][k];
    kept_pairs_momentum(&kept.particles, momentum, &size);
    assert_ok(mf_friction_solve(&kept.friction, &kept.particles, tolerance));
    assert_true(find_residual(&kept, before) <= tolerance + more);
    kept_pairs_assert_momentum(&kept.particles, momentum);
    kept_pairs_clear(&kept);
}

/// The residual that conjugate gradients carry along drifts from the true one by roundings.
static void test_solution_is_within_its_tolerance_when_friction_is_implicit(void **state) {
    (void)state;
    check_solution(0.01, 1e-2, 1e-12);
    check_solution(0.01, 1e-10, 1e-12);
    check_solution(1, 1e-2, 1e-12);
    check_solution(1, 1e-10, 1e-12);
    check_solution(1e4, 1e-2, 1e-9);
}

static void test_solution_is_refused_when_iterations_are_too_few_for_its_tolerance(void **state) {
    (void)state;
    struct kept_pairs kept = {.law = kept_pairs_law(&soft, &omega, 1e9)};
    kept_pairs_init(&kept, &(struct box){3, {5.1, 4.6, 6.3}}, 443, 0);
    kept_pairs_use(&kept, &mf_aboba_implicit);
    kept_pairs_keep(&kept, 3);
    const double before = kept.particles.velocity[0][0];
    assert_fails(mf_friction_solve(&kept.friction, &kept.particles, 1e-200), STATUS_UNSTABLE,
                 "time_step");
    assert_identical(kept.particles.velocity[0][0], before);
    kept_pairs_clear(&kept);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solution_is_within_its_tolerance_when_friction_is_implicit),
        cmocka_unit_test(test_solution_is_refused_when_iterations_are_too_few_for_its_tolerance),
    };
    return cmocka_run_group_tests(tests, make_tables, clear_tables);
}
