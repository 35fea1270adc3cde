// SPDX-License-Identifier: GPL-3.0-or-later
//
// g(r) whose state is known: an ideal gas, correlations of Ornstein and Zernike about a critical
// point, and a crystal of face-centred cubes whose beads tremble.
#include "targets/target_sanity.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { BINS = 250, BEADS = 4000 };

static double g[BINS], error[BINS];
static const struct rdf_bins bins = {.width = 0.02, .count = BINS};

static struct target_state make_state(struct box *box, double density) {
    const double edge = cbrt(BEADS / density);
    *box = (struct box){3, {edge, edge, edge}};
    for (int k = 0; k < BINS; k++)
        error[k] = 1e-3;
    return (struct target_state){
        .bins = &bins, .g = g, .error = error, .box = box, .count = BEADS, .tail = 1};
}

/// g = 1 + A exp(−r/ξ)/r has 1 + ρG = 1 + 4π ρ A ξ², of which a range of 7 ξ shows nine tenths.
static void test_target_state_tells_fluctuations_of_many_beads(void **state) {
    (void)state;
    const double density = 0.3, reach = 0.7;
    char line[TARGET_STATE_LINE];
    struct box box;
    struct target_state look = make_state(&box, density);
    static const double compressibility[] = {1, 1.5, 6};
    for (int n = 0; n < 3; n++) {
        const double a = (compressibility[n] - 1) / (4 * acos(-1) * density * reach * reach);
        for (int k = 0; k < BINS; k++) {
            const double r = mf_rdf_bins_centre(&bins, (size_t)k);
            g[k] = 1 + a * exp(-r / reach) / r;
        }
        assert_int_equal(mf_target_state_print(&look, line), n == 2);
    }
    assert_contains(line, "1 + rho G = 5.4");
    assert_null(strstr(line, "g ends"));
    look.tail = 1.08;
    assert_true(mf_target_state_print(&look, line));
    assert_contains(line, "and g ends at 1.080");
    // Noise as large as what is said is no evidence.
    for (int k = 0; k < BINS; k++)
        error[k] = 1;
    assert_false(mf_target_state_print(&look, line));
}

/// A table that reaches beyond the scene's box is of another system: nothing is said of it.
static void test_target_state_is_silent_on_a_range_beyond_the_box(void **state) {
    (void)state;
    char line[TARGET_STATE_LINE];
    struct box box;
    struct target_state look = make_state(&box, 0.3);
    for (int k = 0; k < BINS; k++) {
        const double r = mf_rdf_bins_centre(&bins, (size_t)k);
        g[k] = 1 + 2.7 * exp(-r / 0.7) / r;
    }
    assert_true(mf_target_state_print(&look, line));
    look.count = 100; // 6.9 wide, and g is known up to 5
    box = (struct box){3, {cbrt(100 / 0.3), cbrt(100 / 0.3), cbrt(100 / 0.3)}};
    assert_false(mf_target_state_print(&look, line));
}

/// Beads of dimers: g leaves out the partner of each. An ideal gas of them has 1 + ρG = 2 of its
/// beads, 1 of itself; what makes 6 of single beads is (1 + 5.4)/2 of dimers.
static void test_target_state_tells_fluctuations_of_molecules(void **state) {
    (void)state;
    const double density = 0.3, reach = 0.7;
    char line[TARGET_STATE_LINE];
    struct box box;
    struct target_state look = make_state(&box, density);
    look.bound = 1;
    look.inside = 1 / density;
    for (int n = 0; n < 2; n++) {
        const double a = n * 5.3 / (4 * acos(-1) * density * reach * reach);
        for (int k = 0; k < BINS; k++) {
            const double r = mf_rdf_bins_centre(&bins, (size_t)k);
            g[k] = 1 + a * exp(-r / reach) / r;
        }
        assert_int_equal(mf_target_state_print(&look, line), n);
    }
    assert_contains(line, "1 + rho G of the molecules = 3.");
    look.bound = 3; // of four beads in each the same is little
    assert_false(mf_target_state_print(&look, line));
}

/// Neighbours of a face-centred cube, whose edge has two of the density's four beads, with normal
/// displacements of a Lindemann ratio: the relative one is σ.
static void make_crystal(double density, double sigma) {
    const double edge = cbrt(4 / density);
    for (int k = 0; k < BINS; k++)
        g[k] = 0;
    for (int x = -12; x <= 12; x++)
        for (int y = -12; y <= 12; y++)
            for (int z = -12; z <= 12; z++) {
                const double far = 0.5 * edge * sqrt((double)(x * x + y * y + z * z));
                if ((x + y + z) % 2 || far == 0)
                    continue;
                for (int k = 0; k < BINS; k++) {
                    const double r = mf_rdf_bins_centre(&bins, (size_t)k);
                    g[k] += exp(-0.5 * pow((r - far) / sigma, 2)) /
                            (sigma * sqrt(2 * acos(-1)) * 4 * acos(-1) * r * r * density);
                }
            }
}

static void test_target_state_tells_a_crystal(void **state) {
    (void)state;
    char line[TARGET_STATE_LINE];
    struct box box;
    const struct target_state look = make_state(&box, 1.05);
    // Near melting: rms displacements are 0.13 of the distance of neighbours, 1.1 (Lindemann), and
    // the relative one along a line is √(2/3) of that.
    make_crystal(1.05, 0.12);
    assert_true(mf_target_state_print(&look, line));
    assert_contains(line, "of a crystal?");
    make_crystal(1.05, 0.2); // its peak is 2.5
    assert_false(mf_target_state_print(&look, line));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_target_state_tells_fluctuations_of_many_beads),
        cmocka_unit_test(test_target_state_is_silent_on_a_range_beyond_the_box),
        cmocka_unit_test(test_target_state_tells_fluctuations_of_molecules),
        cmocka_unit_test(test_target_state_tells_a_crystal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
