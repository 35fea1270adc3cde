// SPDX-License-Identifier: GPL-3.0-or-later
//
// The structure of free molecules: dimers of one type, whose bonds are as long as Boltzmann's
// factor makes them, dimers of two types, which g of the types cannot distinguish at small q, and
// trimers of two types, whose bonds are freely jointed.
#include "inversion/inversion.h"
#include "inversion/inversion_intramolecular.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { DIMERS = 100, TRIMERS = 67, BINS = 40, TYPES = 2, MAX_PAIRS = TYPES * (TYPES + 1) / 2 };

static const double spring = 120, rest = 0.6;
static const struct molecules_number bond_numbers[] = {{"k", 120}, {"length", 0.6}, {NULL, 0}};

struct made {
    struct fluid fluid;
    struct molecules molecules;
    double g[MAX_PAIRS * BINS], error[MAX_PAIRS * BINS];
    struct inverse_problem problem;
    struct inversion_parameters settings;
    struct inversion inversion;
};

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}
static const struct inverse_listener listener = {ignore, NULL};

/// Chains of beads of these types, which exclude all their pairs, with a target of some liquid from
/// `low` to 2.
static void make(struct made *made, int count, int beads, const int *type, double low) {
    const int types = type[1] + 1, pairs = types * (types + 1) / 2;
    *made = (struct made){0};
    const struct composition composition = molecules_topology(
        &made->molecules.topology, molecules_chain(count, type, beads, 0, beads - 1),
        (struct topology_kind){0}, types, NULL);
    molecules_add_group(&made->molecules, BONDED_BOND, &mf_bond_harmonic, bond_numbers);
    fluid_groot_warren(&made->fluid, beads * count, 0.004);
    molecules_enter(&made->fluid.setup, &made->molecules, &composition);
    const struct rdf_bins bins = {low, (2 - low) / BINS, BINS};
    for (int n = 0; n < pairs * BINS; n++) {
        const double r = mf_rdf_bins_centre(&bins, (size_t)(n % BINS));
        made->g[n] = 1 - 0.9 * exp(-4 * r * r);
        made->error[n] = 0.01;
    }
    made->problem =
        (struct inverse_problem){.targets = {.bins = bins,
                                             .target[TARGET_RDF] = {.count = (size_t)(pairs * BINS),
                                                                    .value = made->g,
                                                                    .error = made->error}},
                                 .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
                                 .scene = made->fluid.setup,
                                 .core_threshold = 1e-3,
                                 .core_stiffness = 2000,
                                 .seed = 3,
                                 .threads = 2};
    made->settings = (struct inversion_parameters){.replicas = 4,
                                                   .equilibration = 10,
                                                   .samples = 8,
                                                   .every = 1,
                                                   .iterations = 2,
                                                   .damping = 1,
                                                   .precision = 1,
                                                   .sampler = SAMPLER_AUTO};
    assert_ok(
        mf_inversion_create(&made->inversion, &mf_automatic, &made->problem, &made->settings));
    assert_ok(mf_inversion_intramolecular_find(made->inversion.state, made->inversion.course.phi,
                                               &listener));
}

static void clear(struct made *made) {
    mf_inversion_destroy(&made->inversion);
    mf_molecules_clear(&made->molecules);
    fluid_clear(&made->fluid);
}

/// Mean of r in a bin's middle over r² exp(−k (r − r_0)²/2), and its standard deviation.
static double find_mean_length(double *deviation) {
    double norm = 0, sum = 0, squares = 0;
    for (double r = 0.0005; r < 2; r += 0.001) {
        const double weight = r * r * exp(-0.5 * spring * pow(r - rest, 2));
        norm += weight;
        sum += r * weight;
        squares += r * r * weight;
    }
    *deviation = sqrt(squares / norm - pow(sum / norm, 2));
    return sum / norm;
}

static void test_inside_of_dimers_is_the_distribution_of_their_bonds(void **state) {
    (void)state;
    static struct made made;
    make(&made, DIMERS, 2, (const int[]){0, 0}, 0);
    const struct inversion_state *own = made.inversion.state;
    double counts = 0, sum = 0, deviation;
    for (size_t k = 0; k < BINS; k++) {
        // Over N²/2 pairs, where those of an ideal gas are N (N − 1)/2.
        const double here = own->inside.g[k] * own->target.ideal[k] / (1 - 0.5 / DIMERS);
        counts += here;
        sum += here * mf_rdf_bins_centre(&made.problem.targets.bins, k);
    }
    const double exact = find_mean_length(&deviation);
    print_message("%.1f bonds of %.4f, exactly %.4f\n", counts, sum / counts, exact);
    assert_close(counts, DIMERS, 1e-9);
    // 4 replicas and 10 configurations, which hardly remember each other; and the bins' middles.
    assert_close(sum / counts, exact, 5 * deviation / sqrt(4 * 10 * DIMERS));
    // 1 + min sin x/x of bonds of one length is 0.783.
    assert_true(own->inside.min > 0.783 && own->inside.min < 0.9);
    assert_true(mf_inversion_knows_intramolecular(own));
    clear(&made);
}

/// Ω of the difference of the types is 1 − w(q), 0 at small q.
static void test_inside_of_two_types_that_always_go_together_is_of_no_use(void **state) {
    (void)state;
    static struct made made;
    make(&made, DIMERS, 2, (const int[]){0, 1}, 0);
    const struct inversion_state *own = made.inversion.state;
    assert_true(own->inside.min < 0.05);
    assert_false(mf_inversion_knows_intramolecular(own));
    clear(&made);
}

/// 4π ∫ r² sin(qr)/(qr) dr from 0 to r.
static double find_ball(double q, double r) {
    return q > 0 ? 4 * acos(-1) * (sin(q * r) - q * r * cos(q * r)) / pow(q, 3)
                 : 4 * acos(-1) / 3 * pow(r, 3);
}

/// Ω of two types without the 1 of a bead itself, of a and b of them in the box.
static double find_omega(const struct made *made, int pair, double a, double b, double q) {
    const struct inversion_state *own = made->inversion.state;
    const struct rdf_bins *bins = &made->problem.targets.bins;
    double sum = 0;
    for (size_t k = 0; k < BINS; k++)
        sum +=
            own->inside.g[(size_t)pair * BINS + k] *
            (find_ball(q, mf_rdf_bins_edge(bins, k + 1)) - find_ball(q, mf_rdf_bins_edge(bins, k)));
    return sum * sqrt(a * b) / mf_box_volume(&own->box);
}

/// Mean of sin(qr)/(qr) over the lengths of a bond.
static double find_mean_wave(double q) {
    double norm = 0, sum = 0;
    for (double r = 0.0005; r < 2; r += 0.001) {
        const double weight = r * r * exp(-0.5 * spring * pow(r - rest, 2));
        norm += weight;
        sum += weight * sin(q * r) / (q * r);
    }
    return sum / norm;
}

/// A-B-A: each B has two bonds and each A one, N_A = 2 N_B, so that Ω_AB is √2 times the wave of a
/// bond; both A are apart by two independent bonds, whose waves are multiplied. Counts are exact.
static void test_inside_of_trimers_is_that_of_freely_jointed_bonds(void **state) {
    (void)state;
    static struct made made;
    static const double q[] = {0.5, 1, 2};
    make(&made, TRIMERS, 3, (const int[]){0, 1, 0}, 0);
    const struct composition *composition = &made.problem.scene.composition;
    const int unlike = mf_composition_pair(composition, 0, 1);
    assert_close(find_omega(&made, unlike, 2 * TRIMERS, TRIMERS, 0), sqrt(2), 1e-9);
    assert_close(find_omega(&made, 0, 2 * TRIMERS, 2 * TRIMERS, 0), 1, 1e-9);
    for (int k = 0; k < 3; k++) {
        const double bond = find_mean_wave(q[k]);
        // Of 4 replicas: the wave varies by (q r)²/6 of its mean or so, and by bins of 0.05.
        const double error = pow(q[k], 2) / 6 / sqrt(4 * TRIMERS);
        assert_close(find_omega(&made, unlike, 2 * TRIMERS, TRIMERS, q[k]), sqrt(2) * bond, error);
        assert_close(find_omega(&made, 0, 2 * TRIMERS, 2 * TRIMERS, q[k]), bond * bond, 2 * error);
    }
    clear(&made);
}

/// Bonds of 0.6 are in no bin from 1 on: single beads' S would be taken for theirs.
static void test_inside_of_dimers_whose_bonds_are_below_the_first_bin_is_not_known(void **state) {
    (void)state;
    static struct made made;
    make(&made, DIMERS, 2, (const int[]){0, 0}, 1);
    assert_false(mf_inversion_knows_intramolecular(made.inversion.state));
    assert_null(mf_inversion_liquid(made.inversion.state).inside);
    clear(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inside_of_dimers_is_the_distribution_of_their_bonds),
        cmocka_unit_test(test_inside_of_two_types_that_always_go_together_is_of_no_use),
        cmocka_unit_test(test_inside_of_trimers_is_that_of_freely_jointed_bonds),
        cmocka_unit_test(test_inside_of_dimers_whose_bonds_are_below_the_first_bin_is_not_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
