// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where the fitted U of bonds, angles and dihedrals is known, against distributions of known laws.
#include "problem/bonded_grid.h"

#include "problem/potential_grid.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 180, POINTS = 3 * BINS };

static const double temperature = 1.5;
static const int types[4] = {0};

/// A problem of chains of four beads with a group of each order, one of which is looked for.
struct twin {
    struct molecules molecules;
    struct inverse_problem problem;
    double target[BINS], error[BINS];
};

/// p of a bin is proportional to exp(−U/k_B T) and to the Jacobian at its centre.
static void make_twin(struct twin *twin, int order, struct bonded_bins bins,
                      double (*energy)(double)) {
    *twin = (struct twin){.problem = {.scene = {.temperature = temperature,
                                                .box = {.dimensions = 3, .length = {9, 9, 9}}}}};
    const struct composition composition =
        molecules_topology(&twin->molecules.topology, molecules_chain(20, types, 4, 2, 0),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&twin->molecules, BONDED_BOND, &mf_bond_harmonic, NULL);
    molecules_add_group(&twin->molecules, BONDED_ANGLE, &mf_angle_harmonic, NULL);
    molecules_add_group(&twin->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, NULL);
    molecules_enter(&twin->problem.scene, &twin->molecules, &composition);
    double sum = 0;
    for (size_t k = 0; k < bins.count; k++) {
        const double q = bonded_bins_centre(&bins, k);
        const double jacobian = order == BONDED_BOND    ? q * q
                                : order == BONDED_ANGLE ? sin(q * M_PI / 180)
                                                        : 1;
        twin->target[k] = fmax(0, jacobian) * exp(-energy(q) / temperature);
        sum += bins.width * twin->target[k];
    }
    for (size_t k = 0; k < bins.count; k++)
        twin->target[k] /= sum;
    twin->problem.bonded = 1;
    twin->problem.unknown[UNKNOWN_BONDED].wanted = true;
    twin->problem.group[0] = (struct bonded_unknown){order, 0, bins, 0, {0}};
    twin->problem.targets.target[mf_bonded_distribution_kind(order)] =
        (struct target){.count = bins.count, .value = twin->target, .error = twin->error};
}

static void clear_twin(struct twin *twin) {
    mf_molecules_clear(&twin->molecules);
}

/// The curve that a fit begins with, and its grid.
static void begin(const struct twin *twin, struct bonded_grid *grid, double *values,
                  struct bonded_curve *curve) {
    assert_ok(mf_bonded_grid_init(grid, &twin->problem, &twin->problem.group[0]));
    assert_true(grid->points <= POINTS);
    mf_bonded_grid_start(grid, values);
    assert_ok(mf_bonded_grid_curve(grid, values, curve));
}

static double bond_energy(double r) {
    return 400 * (r - 0.8) * (r - 0.8) / 2;
}

static double wide_bond_energy(double r) {
    return 0.5 * bond_energy(r);
}

static double angle_energy(double theta) {
    return 8 * pow((theta - 150) * M_PI / 180, 2) / 2;
}

static double dihedral_energy(double phi) {
    return 1.2 * (1 + cos(3 * phi * M_PI / 180)) + 0.4 * cos((phi - 30) * M_PI / 180);
}

/// Against the law that made it, up to a constant; q in the units of the curve.
static void assert_law(const struct bonded_curve *curve, double (*energy)(double), double unit,
                       double low, double high, double tolerance) {
    double base;
    mf_bonded_value(curve, unit * low, &base, NULL);
    for (double q = low; q <= high; q += (high - low) / 97) {
        double value;
        mf_bonded_value(curve, unit * q, &value, NULL);
        assert_close(value - base, energy(q) - energy(low), tolerance);
    }
}

static void test_bonded_grid_inverts_the_distribution_of_a_bond(void **state) {
    (void)state;
    static struct twin twin;
    struct bonded_grid grid;
    struct bonded_curve curve = {0};
    double values[POINTS];
    make_twin(&twin, BONDED_BOND, (struct bonded_bins){0.6, 0.4 / BINS, BINS}, bond_energy);
    begin(&twin, &grid, values, &curve);
    assert_law(&curve, bond_energy, 1, 0.66, 0.94, 2e-3);
    mf_bonded_clear(&curve);
    clear_twin(&twin);
}

/// A constant that the steps of a fit have added to U is gone, and nothing else has changed.
static void test_bonded_grid_has_no_constant(void **state) {
    (void)state;
    static struct twin twin;
    struct bonded_grid grid;
    struct bonded_curve curve = {0};
    double values[POINTS], shifted[POINTS] = {0}, min = INFINITY;
    make_twin(&twin, BONDED_BOND, (struct bonded_bins){0.6, 0.4 / BINS, BINS}, bond_energy);
    begin(&twin, &grid, values, &curve);
    for (size_t k = grid.below; k < grid.below + grid.known; k++)
        shifted[k] = values[k] - 7;
    mf_bonded_grid_level(&grid, shifted);
    mf_bonded_grid_complete(&grid, shifted);
    for (size_t k = 0; k < grid.points; k++) {
        assert_close(shifted[k], values[k], 1e-9);
        min = fmin(min, values[k]);
    }
    assert_close(min, 0, 1e-12);
    mf_bonded_clear(&curve);
    clear_twin(&twin);
}

/// Beyond the known range the curve goes on as the parabola that it is, and grows for ever.
static void test_bonded_grid_holds_what_leaves_the_target(void **state) {
    (void)state;
    static struct twin twin;
    struct bonded_grid grid;
    struct bonded_curve curve = {0};
    double values[POINTS], before, energy;
    make_twin(&twin, BONDED_BOND, (struct bonded_bins){0.6, 0.4 / BINS, BINS}, bond_energy);
    begin(&twin, &grid, values, &curve);
    const double last = mf_bonded_grid_place(&grid, grid.below + grid.known - 1);
    assert_true(last > 0.93 && last < 1);
    assert_law(&curve, bond_energy, 1, last, last + 0.05, 1.5);
    mf_bonded_clear(&curve);
    // Noise at the end, a bin that was seen alone, must not turn the wall.
    twin.target[BINS - 1] = 0.02;
    begin(&twin, &grid, values, &curve);
    assert_int_equal(grid.first + grid.known, BINS);
    mf_bonded_value(&curve, 1, &before, NULL);
    for (double r = 1.02; r < 2; r += 0.02, before = energy) {
        mf_bonded_value(&curve, r, &energy, NULL);
        assert_true(energy > before);
    }
    mf_bonded_clear(&curve);
    clear_twin(&twin);
}

/// An angle reaches 180 degrees, where its Jacobian, not its energy, makes p vanish.
static void test_bonded_grid_lets_an_angle_be_straight(void **state) {
    (void)state;
    static struct twin twin;
    struct bonded_grid grid;
    struct bonded_curve curve = {0};
    double values[POINTS];
    make_twin(&twin, BONDED_ANGLE, (struct bonded_bins){0, 180.0 / BINS, BINS}, angle_energy);
    begin(&twin, &grid, values, &curve);
    assert_law(&curve, angle_energy, M_PI / 180, 80, 180, 6e-3);
    mf_bonded_clear(&curve);
    clear_twin(&twin);
}

static void test_bonded_grid_closes_the_circle(void **state) {
    (void)state;
    static struct twin twin;
    struct bonded_grid grid;
    struct bonded_curve curve = {0};
    double values[POINTS], low, high;
    make_twin(&twin, BONDED_DIHEDRAL, (struct bonded_bins){-180, 360.0 / BINS, BINS},
              dihedral_energy);
    begin(&twin, &grid, values, &curve);
    assert_law(&curve, dihedral_energy, M_PI / 180, -180, 180, 2e-3);
    mf_bonded_value(&curve, -M_PI + 1e-9, NULL, &low);
    mf_bonded_value(&curve, M_PI - 1e-9, NULL, &high);
    assert_close(low, high, 1e-6);
    mf_bonded_clear(&curve);
    clear_twin(&twin);
}

/// The mean of a curve over a bin, by its energies at many places; it is straight beyond its ends.
static double mean_over(const struct bonded_grid *grid, const double *values, double unit,
                        size_t bin) {
    enum { PLACES = 200 };
    struct bonded_curve curve = {0};
    const double centre = mf_bonded_grid_place(grid, grid->below + bin);
    const double first = mf_bonded_grid_place(grid, 0),
                 last = mf_bonded_grid_place(grid, grid->points - 1);
    double sum = 0, count = 0;
    assert_ok(mf_bonded_grid_curve(grid, values, &curve));
    for (int k = 0; k < PLACES; k++) {
        const double q = centre + grid->unknown->bins.width * ((k + 0.5) / PLACES - 0.5);
        double energy;
        mf_bonded_value(&curve, unit * q, &energy, NULL);
        const bool inside = (q >= first && q <= last) || grid->unknown->order == BONDED_DIHEDRAL;
        sum += inside ? energy : 0;
        count += inside;
    }
    mf_bonded_clear(&curve);
    return sum / count;
}

/// Of the points at an end, beside it and in the middle, against the curve that the engine reads.
static void assert_means(int order, struct bonded_bins bins, double unit,
                         double (*energy)(double)) {
    enum { MAX = 60 };
    static struct twin twin;
    struct bonded_grid grid;
    double values[POINTS], means[MAX * MAX];
    make_twin(&twin, order, bins, energy);
    assert_ok(mf_bonded_grid_init(&grid, &twin.problem, &twin.problem.group[0]));
    assert_true(grid.known <= MAX);
    assert_ok(mf_bonded_grid_means(&grid, means));
    const size_t points[] = {0, 1, grid.known / 2, grid.known - 1};
    for (size_t n = 0; n < sizeof points / sizeof *points; n++) {
        for (size_t k = 0; k < grid.points; k++)
            values[k] = k == grid.below + points[n];
        if (order == BONDED_DIHEDRAL)
            values[grid.known] = values[0];
        for (size_t a = 0; a < grid.known; a++)
            assert_close(means[a * grid.known + points[n]], mean_over(&grid, values, unit, a),
                         2e-4);
    }
    clear_twin(&twin);
}

static void test_bonded_grid_means_are_those_of_the_curve(void **state) {
    (void)state;
    assert_means(BONDED_BOND, (struct bonded_bins){0.6, 0.01, 40}, 1, bond_energy);
    assert_means(BONDED_ANGLE, (struct bonded_bins){0, 4, 45}, M_PI / 180, angle_energy);
    assert_means(BONDED_DIHEDRAL, (struct bonded_bins){-180, 10, 36}, M_PI / 180, dihedral_energy);
}

static void test_bonded_grid_refuses_what_tells_nothing(void **state) {
    (void)state;
    static struct twin twin;
    struct bonded_grid grid;
    make_twin(&twin, BONDED_BOND, (struct bonded_bins){0, 0.2, 10}, bond_energy);
    assert_fails(mf_bonded_grid_init(&grid, &twin.problem, &twin.problem.group[0]),
                 STATUS_BAD_INPUT, "has only 2 bins");
    clear_twin(&twin);
    make_twin(&twin, BONDED_DIHEDRAL, (struct bonded_bins){-170, 2, 170}, dihedral_energy);
    assert_fails(mf_bonded_grid_init(&grid, &twin.problem, &twin.problem.group[0]),
                 STATUS_BAD_INPUT, "340 degrees, not 360");
    clear_twin(&twin);
}

/// Blocks of groups stand after those of pairs; without an unknown Φ there are no pairs.
static void test_potential_grid_has_groups_behind_the_pairs(void **state) {
    (void)state;
    enum { PAIR_BINS = 30 };
    static struct twin twin;
    struct potential_grid grid;
    double g[PAIR_BINS];
    make_twin(&twin, BONDED_ANGLE, (struct bonded_bins){0, 180.0 / BINS, BINS}, angle_energy);
    for (int k = 0; k < PAIR_BINS; k++)
        g[k] = k < 10 ? 0 : 1;
    twin.problem.targets.bins = (struct rdf_bins){0, 0.1, PAIR_BINS};
    twin.problem.targets.target[TARGET_RDF] = (struct target){.count = PAIR_BINS, .value = g};
    twin.problem.unknown[UNKNOWN_POTENTIAL].wanted = true;
    twin.problem.core_threshold = 1e-3;
    assert_ok(mf_potential_grid_init(&grid, &twin.problem));
    assert_int_equal(grid.pair_points, PAIR_BINS + 1);
    assert_int_equal(grid.pairs_known, PAIR_BINS - 10);
    assert_int_equal(grid.all_bins, PAIR_BINS + BINS);
    const size_t first = grid.pairs_known;
    assert_int_equal(grid.known_bin[first], PAIR_BINS + grid.group[0].own.first);
    assert_close(grid.r[grid.known_point[first]],
                 bonded_bins_centre(&twin.problem.group[0].bins, grid.group[0].own.first), 1e-9);
    assert_close(mf_potential_grid_ramp(&grid, grid.known_point[first]), 0, 0);
    mf_potential_grid_clear(&grid);
    twin.problem.unknown[UNKNOWN_POTENTIAL].wanted = false;
    assert_ok(mf_potential_grid_init(&grid, &twin.problem));
    assert_int_equal(grid.pairs, 0);
    assert_int_equal(grid.known_bin[0], grid.group[0].own.first);
    mf_potential_grid_clear(&grid);
    clear_twin(&twin);
}

/// A second state that is hotter knows more bins. They are known to both, but seen by it alone; the
/// first begins there with a parabola.
static void test_bins_of_two_states_are_those_of_both(void **state) {
    static const struct bonded_bins bins = {0.4, 0.8 / BINS, BINS};
    static struct twin cold, hot;
    struct bonded_grid grid, own;
    double values[POINTS], alone[POINTS];
    (void)state;
    make_twin(&cold, BONDED_BOND, bins, bond_energy);
    assert_ok(mf_bonded_grid_init(&own, &cold.problem, &cold.problem.group[0]));
    mf_bonded_grid_start(&own, alone);
    make_twin(&hot, BONDED_BOND, bins, wide_bond_energy);
    const struct inverse_problem *const both[] = {&cold.problem, &hot.problem};
    cold.problem.state = both;
    cold.problem.states = 2;
    assert_ok(mf_bonded_grid_init(&grid, &cold.problem, &cold.problem.group[0]));
    assert_true(grid.first < own.first);
    assert_true(grid.first + grid.known > own.first + own.known);
    assert_int_equal(grid.seen_first, own.first);
    assert_int_equal(grid.seen, own.known);
    mf_bonded_grid_start(&grid, values);
    for (size_t k = 0; k < own.points; k++) {
        const double q = mf_bonded_grid_place(&own, k);
        const double place = (q - mf_bonded_grid_place(&grid, 0)) / bins.width;
        if (place > -0.5 && place < (double)grid.points - 0.5)
            assert_close(values[lround(place)], alone[k], 1e-9);
    }
    assert_true(
        mf_bonded_grid_is_above(&grid, &cold.problem, grid.first, mf_bonded_distribution_seen));
    clear_twin(&hot);
    clear_twin(&cold);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonded_grid_inverts_the_distribution_of_a_bond),
        cmocka_unit_test(test_bonded_grid_has_no_constant),
        cmocka_unit_test(test_bonded_grid_holds_what_leaves_the_target),
        cmocka_unit_test(test_bonded_grid_lets_an_angle_be_straight),
        cmocka_unit_test(test_bonded_grid_closes_the_circle),
        cmocka_unit_test(test_bonded_grid_means_are_those_of_the_curve),
        cmocka_unit_test(test_bonded_grid_refuses_what_tells_nothing),
        cmocka_unit_test(test_potential_grid_has_groups_behind_the_pairs),
        cmocka_unit_test(test_bins_of_two_states_are_those_of_both),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
