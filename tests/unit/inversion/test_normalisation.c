// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/normalisation.h"

#include "shared/hard_spheres.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_errno.h>
#include <math.h>

enum { BINS = 90, PARTICLES = 1000 };

static const double width = 0.01;

/// A fluid of hard spheres (Percus and Yevick) of 1000 particles, whose g has the tail of so many.
struct fluid {
    struct rdf_bins bins;
    struct box box;
    struct composition composition;
    double g[3 * BINS];
};

/// Such a range that the diameter is an edge.
static void make(struct fluid *fluid, double eta, double range) {
    const double density = hard_spheres_density(eta), edge = cbrt(PARTICLES / density);
    *fluid = (struct fluid){.bins = {0, range / BINS, BINS},
                            .box = {3, {edge, edge, edge}},
                            .composition = mf_composition_of_one(PARTICLES)};
    const double tail = (1 - hard_spheres_compressibility(eta)) / PARTICLES;
    for (size_t k = 0; k < BINS; k++)
        fluid->g[k] = (1 + hard_spheres_h(eta, mf_rdf_bins_centre(&fluid->bins, k))) * (1 + tail);
}

static struct normalisation find(struct fluid *fluid, double factor) {
    struct normalisation found;
    double g[3 * BINS], error[3 * BINS];
    for (int k = 0; k < 3 * BINS; k++) {
        g[k] = factor * fluid->g[k];
        error[k] = 1e-4 * g[k];
    }
    assert_ok(mf_normalisation_find(&fluid->bins, &fluid->box, &fluid->composition, g, error, width,
                                    &found));
    print_message("factor %.4f: %s %.5f(%.5f), S(0) = %.3f\n", factor,
                  found.found ? "found" : "kept", found.factor, found.error, found.compressibility);
    return found;
}

/// By how much the factor found may be off: what is not known of the tail and of S_0.
static const double tolerance = 0.002;

static void test_normalisation_is_found_of_a_liquid(void **state) {
    (void)state;
    static const double factors[] = {0.97, 0.985, 0.992, 0.996, 1.004, 1.008, 1.015, 1.03};
    struct fluid fluid;
    make(&fluid, 0.4, 3);
    for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
        const struct normalisation found = find(&fluid, factors[k]);
        assert_true(found.found);
        assert_close(found.factor, factors[k], tolerance);
        assert_true(fabs(found.factor - factors[k]) < 3 * found.error);
    }
}

static void test_normalisation_is_found_where_g_ends_before_its_oscillations(void **state) {
    (void)state;
    struct fluid fluid;
    make(&fluid, 0.45, 2.25);
    assert_true(fabs(fluid.g[BINS - 1] - 1) > 0.01);
    assert_close(find(&fluid, 0.985).factor, 0.985, 2 * tolerance);
    assert_close(find(&fluid, 1.015).factor, 1.015, 2 * tolerance);
}

static void test_normalisation_is_kept_where_nothing_speaks_against_it(void **state) {
    (void)state;
    static const double etas[] = {0.2, 0.3, 0.4, 0.45};
    for (size_t k = 0; k < sizeof etas / sizeof *etas; k++) {
        struct fluid fluid;
        make(&fluid, etas[k], 3);
        const struct normalisation found = find(&fluid, 1);
        assert_false(found.found);
        assert_close(found.factor, 1, 0);
        assert_true(found.error > 0 && found.error <= width);
        assert_close(found.compressibility, hard_spheres_compressibility(etas[k]), 0.008);
    }
    struct fluid gas;
    make(&gas, 0.01, 3);
    assert_false(find(&gas, 1).found);
}

static void test_normalisation_of_a_mixture_of_isotopes_is_that_of_the_whole(void **state) {
    (void)state;
    struct fluid fluid;
    make(&fluid, 0.4, 3);
    fluid.composition = (struct composition){.types = 2, .count = {100, 900}, .name = {"A", "B"}};
    for (int k = 0; k < 2 * BINS; k++)
        fluid.g[BINS + k] = fluid.g[k % BINS];
    assert_close(find(&fluid, 0.992).factor, 0.992, tolerance);
}

static void test_normalisation_is_not_looked_for_in_a_plane_or_without_a_tail(void **state) {
    (void)state;
    struct fluid fluid;
    make(&fluid, 0.4, 1.5);
    assert_false(find(&fluid, 0.98).found);
    make(&fluid, 0.4, 3);
    fluid.box.dimensions = 2;
    assert_false(find(&fluid, 0.98).found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normalisation_is_found_of_a_liquid),
        cmocka_unit_test(test_normalisation_is_found_where_g_ends_before_its_oscillations),
        cmocka_unit_test(test_normalisation_is_kept_where_nothing_speaks_against_it),
        cmocka_unit_test(test_normalisation_of_a_mixture_of_isotopes_is_that_of_the_whole),
        cmocka_unit_test(test_normalisation_is_not_looked_for_in_a_plane_or_without_a_tail),
    };
    gsl_set_error_handler_off(); // as the program does: a matrix may have no Cholesky factor
    return cmocka_run_group_tests(tests, NULL, NULL);
}
