// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reference interaction sites: an ideal gas of molecules, the equation H = Ω C S by hand, and the
// structure factor of a pair at a distance.
#include "inversion/hnc_closure.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_errno.h>
#include <math.h>

enum { BINS = 400 };

static const double pi = 3.14159265358979323846;

static const struct rdf_bins bins = {0, 0.025, BINS};
static const struct box box = {.dimensions = 3, .length = {1e4, 1e4, 1e4}};
static const struct composition one = {.types = 1, .count = {500000000000}};

/// ρ ĥ = −0.4 exp(−q²/4) and Ω − 1 = 0.8 exp(−q²/3), as functions of r.
static const double hole = 0.4, partner = 0.8;

static void make_curves(double *g, double *inside) {
    const double density = 0.5;
    for (size_t k = 0; k < BINS; k++) {
        const double r = mf_rdf_bins_centre(&bins, k);
        g[k] = 1 - hole / density * pow(pi, -1.5) * exp(-r * r);
        inside[k] = partner / density * pow(4 * pi / 3, -1.5) * exp(-0.75 * r * r);
    }
}

/// h − c at a wave number, with c = h/(Ω S).
static double indirect_at(double q) {
    const double density = 0.5, h = -hole * exp(-q * q / 4) / density;
    const double inside = 1 + partner * exp(-q * q / 3);
    return h - h / (inside * (inside + density * h));
}

/// Its transform to r, by Simpson's rule.
static double indirect_of(double r) {
    enum { STEPS = 2000 };
    static const double end = 20;
    double sum = 0;
    for (int k = 1; k < STEPS; k++) {
        const double q = end * k / STEPS;
        sum += (k % 2 ? 4 : 2) * q * indirect_at(q) * sin(q * r) / r;
    }
    return sum * end / STEPS / 3 / (2 * pi * pi);
}

static void test_hnc_closure_is_the_equation_by_hand_when_beads_have_partners(void **state) {
    (void)state;
    static const double discretisation = 5e-6; // of constant pieces
    double g[BINS], inside[BINS], indirect[BINS], largest = 0, size = 0;
    make_curves(g, inside);
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){&bins, &box, &one, inside, 0}, g, indirect));
    for (size_t k = 0; k < BINS; k += 3) {
        const double exact = indirect_of(mf_rdf_bins_centre(&bins, k));
        largest = fmax(largest, fabs(indirect[k] - exact));
        size = fmax(size, fabs(exact));
    }
    print_message("largest error %.1e of %.3f\n", largest, size);
    assert_true(largest < discretisation && size > 0.01);
}

/// One bead in four is called B, by chance: the same liquid, in which a bead's partner is like it
/// or unlike it, and each pair type has the counts of all over those of an ideal gas.
static void test_hnc_closure_does_not_change_when_some_beads_are_called_otherwise(void **state) {
    (void)state;
    enum { PAIRS = 3 };
    static const double discretisation = 2e-4; // of cells of four bins
    const struct composition two = {.types = 2, .count = {375000000000, 125000000000}};
    double g[PAIRS * BINS], inside[PAIRS * BINS], indirect[PAIRS * BINS];
    for (int pair = 0; pair < PAIRS; pair++)
        make_curves(g + (ptrdiff_t)pair * BINS, inside + (ptrdiff_t)pair * BINS);
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){&bins, &box, &two, inside, 0}, g, indirect));
    for (int n = 0; n < PAIRS * BINS; n += 3)
        assert_close(indirect[n], indirect_of(mf_rdf_bins_centre(&bins, (size_t)(n % BINS))),
                     discretisation);
}

static void test_hnc_closure_has_no_indirect_part_in_an_ideal_gas_of_molecules(void **state) {
    (void)state;
    double g[BINS], inside[BINS], indirect[BINS];
    make_curves(g, inside);
    for (size_t k = 0; k < BINS; k++)
        g[k] = 1;
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){&bins, &box, &one, inside, 0}, g, indirect));
    for (size_t k = 0; k < BINS; k++)
        assert_close(indirect[k], 0, 1e-11);
}

static void test_hnc_closure_slope_is_that_of_the_closure_of_molecules(void **state) {
    (void)state;
    static const double small = 1e-4, cells = 5e-4; // means of cells, not values at their centres
    double g[BINS], inside[BINS], above[BINS], below[BINS], more[BINS], less[BINS];
    double difference[BINS], slope[BINS], largest = 0;
    const struct hnc_liquid liquid = {&bins, &box, &one, inside, 0};
    make_curves(g, inside);
    for (size_t k = 0; k < BINS; k++) {
        const double r = mf_rdf_bins_centre(&bins, k), change = small * exp(-r * r) * (1 + r);
        above[k] = g[k] + change;
        below[k] = g[k] - change;
        difference[k] = 2 * change;
    }
    assert_ok(mf_hnc_closure(&liquid, above, more));
    assert_ok(mf_hnc_closure(&liquid, below, less));
    assert_ok(mf_hnc_closure_slope(&liquid, g, difference, 0, slope));
    for (size_t k = 0; k < BINS; k++) {
        largest = fmax(largest, fabs(slope[k]));
        assert_close(slope[k], more[k] - less[k], small * cells);
    }
    assert_true(largest > 0.1 * small);
}

static void test_hnc_closure_min_intramolecular_is_that_of_pairs_at_a_distance(void **state) {
    (void)state;
    static const double longest_wave = -0.21723362821122166; // of sin x/x
    double inside[BINS] = {0}, min;
    const size_t bin = 64;
    // Half a pair for each bead, all in one bin, over those of an ideal gas of this density.
    inside[bin] = 0.5 / (0.5 * 0.5 *
                         mf_box_shell_volume(&box, mf_rdf_bins_edge(&bins, bin),
                                             mf_rdf_bins_edge(&bins, bin + 1)));
    assert_ok(mf_hnc_closure_min_intramolecular(&(struct hnc_liquid){&bins, &box, &one, inside, 0},
                                                &min));
    assert_close(min, 1 + longest_wave, 2e-3);
    assert_ok(
        mf_hnc_closure_min_intramolecular(&(struct hnc_liquid){&bins, &box, &one, NULL, 0}, &min));
    assert_close(min, 1, 0);
}

int main(void) {
    gsl_set_error_handler_off(); // as the program does: a matrix may have no Cholesky factor
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hnc_closure_is_the_equation_by_hand_when_beads_have_partners),
        cmocka_unit_test(test_hnc_closure_does_not_change_when_some_beads_are_called_otherwise),
        cmocka_unit_test(test_hnc_closure_has_no_indirect_part_in_an_ideal_gas_of_molecules),
        cmocka_unit_test(test_hnc_closure_slope_is_that_of_the_closure_of_molecules),
        cmocka_unit_test(test_hnc_closure_min_intramolecular_is_that_of_pairs_at_a_distance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
