// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/ornstein_zernike.h"

#include "shared/hard_spheres.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_errno.h>
#include <math.h>

enum { CELLS = 80 };

static const struct composition one = {.types = 1, .count = {1}};

/// c of hard spheres comes back from their h up to a range, 0 beyond the diameter though h goes on.
/// Cells are a fortieth of a diameter wide: where S(0) is small, that is seen in the midst of the
/// core.
static void check(double eta, double range, double absolute, double relative) {
    struct ornstein_zernike oz = {0};
    double edge[CELLS + 1], h[CELLS], compressibility;
    // The diameter is an edge, so that no cell is half in the core.
    for (int k = 0; k <= CELLS; k++)
        edge[k] = range * k / CELLS;
    for (int k = 0; k < CELLS; k++)
        h[k] = hard_spheres_h(eta, 0.5 * (edge[k] + edge[k + 1]));
    assert_ok(mf_ornstein_zernike_init(&oz, edge, CELLS, &one, 1 / hard_spheres_density(eta)));
    assert_ok(mf_ornstein_zernike_solve(&oz, h, &compressibility));
    // The cells about r = 0 hold a thousandth of the core.
    for (int k = 0; k < CELLS; k++) {
        if (edge[k] < 0.1)
            continue;
        const double exact = hard_spheres_c(eta, 0.5 * (edge[k] + edge[k + 1]));
        assert_close(oz.c[k], exact, absolute + relative * fabs(exact));
    }
    print_message("eta %g, range %g: S(0) = %.5f, exact %.5f\n", eta, range, compressibility,
                  hard_spheres_compressibility(eta));
    assert_close(compressibility, hard_spheres_compressibility(eta), 0.0015);
    mf_ornstein_zernike_clear(&oz);
}

static void test_ornstein_zernike_finds_the_exact_c_of_hard_spheres(void **state) {
    (void)state;
    check(0.1, 2, 0.01, 0.005);
    check(0.3, 2, 0.02, 0.01);
}

static void test_ornstein_zernike_does_so_when_h_ends_before_its_oscillations(void **state) {
    (void)state;
    check(0.3, 1.6, 0.02, 0.01);
    check(0.45, 2, 0.2, 0.08);
}

static void test_ornstein_zernike_knows_no_liquid_with_a_negative_compressibility(void **state) {
    (void)state;
    struct ornstein_zernike oz = {0};
    double edge[CELLS + 1], h[CELLS], compressibility;
    for (int k = 0; k <= CELLS; k++)
        edge[k] = 2.5 * k / CELLS;
    // Repelled over the whole range at a density at which that is impossible.
    for (int k = 0; k < CELLS; k++)
        h[k] = -0.9;
    assert_ok(mf_ornstein_zernike_init(&oz, edge, CELLS, &one, 1));
    assert_ok(mf_ornstein_zernike_solve(&oz, h, &compressibility));
    assert_true(!(compressibility > 0.01));
    mf_ornstein_zernike_clear(&oz);
}

static void test_ornstein_zernike_of_few_particles_is_h(void **state) {
    (void)state;
    struct ornstein_zernike oz = {0};
    const double edge[] = {0, 0.5, 1, 1.5};
    const double h[] = {-1, 0.7, -0.2};
    double compressibility;
    assert_ok(mf_ornstein_zernike_init(&oz, edge, 3, &one, 1e12));
    assert_ok(mf_ornstein_zernike_solve(&oz, h, &compressibility));
    for (int k = 0; k < 3; k++)
        assert_close(oz.c[k], h[k], 1e-5);
    assert_close(compressibility, 1, 1e-12);
    mf_ornstein_zernike_clear(&oz);
}

int main(void) {
    gsl_set_error_handler_off(); // as the program does: a matrix may have no Cholesky factor
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ornstein_zernike_finds_the_exact_c_of_hard_spheres),
        cmocka_unit_test(test_ornstein_zernike_does_so_when_h_ends_before_its_oscillations),
        cmocka_unit_test(test_ornstein_zernike_knows_no_liquid_with_a_negative_compressibility),
        cmocka_unit_test(test_ornstein_zernike_of_few_particles_is_h),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
