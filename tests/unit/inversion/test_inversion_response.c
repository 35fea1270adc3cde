// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a distribution follows the values of U, against bonds that nothing else acts upon: their p is
// r² exp(−U/k_B T), by quadrature.
#include "inversion/inversion_state.h"

#include "curves/bonded_law.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 24, POINTS = 3 * BINS };

static const double temperature = 1.5, terms = 50;
static const struct bonded_bins bins = {0.6, 0.4 / BINS, BINS};
static const int types[2] = {0};

struct twin {
    struct molecules molecules;
    struct inverse_problem problem;
    struct potential_group group;
    struct inversion_state state;
    double target[BINS], error[BINS], covariance[BINS * BINS];
};

/// S of `terms` bonds with this completed U, in the known bins.
static void count_bonds(const struct bonded_grid *grid, const double *values, double *counts) {
    enum { PLACES = 100 };
    struct bonded_curve curve = {0};
    double sum = 0;
    assert_ok(mf_bonded_grid_curve(grid, values, &curve));
    for (size_t a = 0; a < grid->known; a++) {
        const double centre = mf_bonded_grid_place(grid, grid->below + a);
        counts[a] = 0;
        for (int k = 0; k < PLACES; k++) {
            const double r = centre + bins.width * ((k + 0.5) / PLACES - 0.5);
            double energy;
            mf_bonded_value(&curve, r, &energy, NULL);
            counts[a] += r * r * exp(-energy / temperature);
        }
        sum += counts[a];
    }
    for (size_t a = 0; a < grid->known; a++)
        counts[a] *= terms / sum;
    mf_bonded_clear(&curve);
}

/// A fit of bonds alone, whose U is a parabola, with the C of independent bonds.
static void make_twin(struct twin *twin, double *values, double *counts) {
    *twin = (struct twin){.problem = {.scene = {.temperature = temperature,
                                                .box = {.dimensions = 3, .length = {9, 9, 9}}}}};
    const struct composition composition =
        molecules_topology(&twin->molecules.topology, molecules_chain(20, types, 2, 1, 0),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&twin->molecules, BONDED_BOND, &mf_bond_harmonic, NULL);
    molecules_enter(&twin->problem.scene, &twin->molecules, &composition);
    for (size_t k = 0; k < BINS; k++)
        twin->target[k] = 1;
    twin->problem.group[0] = (struct bonded_unknown){BONDED_BOND, 0, bins, 0, {0}};
    twin->problem.targets.target[mf_bonded_distribution_kind(BONDED_BOND)] =
        (struct target){.count = BINS, .value = twin->target, .error = twin->error};
    struct bonded_grid *grid = &twin->group.own;
    assert_ok(mf_bonded_grid_init(grid, &twin->problem, &twin->problem.group[0]));
    assert_true(grid->known == BINS && grid->points <= POINTS);
    for (size_t k = 0; k < grid->points; k++)
        values[k] = 75 * pow(mf_bonded_grid_place(grid, k) - 0.8, 2);
    count_bonds(grid, values, counts);
    for (size_t a = 0; a < BINS; a++)
        for (size_t b = 0; b < BINS; b++)
            twin->covariance[a * BINS + b] =
                (a == b ? counts[a] : 0) - counts[a] * counts[b] / terms;
    twin->state = (struct inversion_state){
        .problem = &twin->problem, .grid = {.groups = 1, .known = BINS, .group = &twin->group}};
    assert_ok(mf_inversion_response_init(&twin->state));
    memcpy(twin->state.response.covariance, twin->covariance, sizeof twin->covariance);
    mf_inversion_response_find(&twin->state);
}

static void clear_twin(struct twin *twin) {
    mf_inversion_response_clear(&twin->state.response);
    mf_molecules_clear(&twin->molecules);
}

/// rms over the bins of the change of S/sqrt(S) that these equations miss, over that of the change.
static double miss(const double *equations, const double *before, const double *after,
                   const double *change) {
    double missed = 0, all = 0;
    for (size_t a = 0; a < BINS; a++) {
        double left = after[a] - before[a];
        all += left * left / before[a];
        for (size_t b = 0; b < BINS; b++)
            left += equations[a * BINS + b] * change[b] / temperature;
        missed += left * left / before[a];
    }
    return sqrt(missed / all);
}

/// Values that alternate move the mean over a bin by 0.64 of them alone, so that a U that is
/// constant in each bin would move p by 1/0.64 − 1 = 0.57 too much. What is left is that p is not
/// constant in a bin, and that the change is no differential.
static void test_inversion_response_tells_how_lengths_follow_their_values(void **state) {
    static struct twin twin;
    double values[POINTS], before[BINS], after[BINS], change[BINS];
    (void)state;
    make_twin(&twin, values, before);
    for (size_t b = 0; b < BINS; b++) {
        change[b] = b > 1 && b + 2 < BINS ? (b % 2 ? 0.01 : -0.01) : 0;
        values[twin.group.own.below + b] += change[b];
    }
    count_bonds(&twin.group.own, values, after);
    const double by_curve = miss(twin.state.response.values, before, after, change),
                 by_bins = miss(twin.covariance, before, after, change);
    print_message("missed with the curve %.4f, with constant bins %.4f\n", by_curve, by_bins);
    assert_true(by_curve < 0.05);
    assert_close(by_bins, 0.57, 0.06);
    clear_twin(&twin);
}

/// Ten samples of two bins, with this mean of the first and this variance of both.
static void add_samples(struct inversion_state *state, double mean, double variance) {
    enum { NUMBERS = 2 };
    double means[NUMBERS] = {mean, 5},
           comoment[NUMBERS * NUMBERS] = {10 * variance, 0, 0, 10 * variance};
    state->replicas.counts =
        (struct comoments){.size = NUMBERS, .count = 10, .mean = means, .comoment = comoment};
    assert_ok(mf_inversion_response_add(state));
}

static void make_two_bins(struct inversion_state *state) {
    static size_t bins_known[] = {0, 1}, known_of = 2;
    static double ideal[] = {5, 5};
    static const double phi[] = {0, 0};
    static const struct inverse_problem problem = {0};
    *state = (struct inversion_state){.problem = &problem,
                                      .phi = phi,
                                      .grid = {.known = 2,
                                               .known_bin = bins_known,
                                               .known_point = bins_known,
                                               .known_of = &known_of,
                                               .blocks = 1},
                                      .target.ideal = ideal,
                                      .inefficiency = 1};
    assert_ok(mf_inversion_response_init(state));
}

/// Samples of the same g add up; those of a g that is off by 1 in one of two bins are worth one:
/// 1/(1/20 + (4/2)/2), where C of each has a relative variance of 2/n.
static void test_inversion_response_forgets_what_has_changed(void **unused) {
    (void)unused;
    struct inversion_state state;
    make_two_bins(&state);
    add_samples(&state, 5, 1);
    assert_close(state.response.covariance[0], 1, 1e-12);
    add_samples(&state, 5, 3);
    assert_close(state.response.covariance[0], 2, 1e-12);
    assert_close(state.response.independent, 20, 1e-12);
    add_samples(&state, 10, 8);
    assert_close(state.response.independent, 10 + 1 / 1.05, 1e-12);
    assert_true(state.response.covariance[0] > 7.3 && state.response.covariance[0] < 8);
    mf_inversion_response_clear(&state.response);
}

/// Ten samples too near to each other, worth two, and ten that are worth as many: together the mean
/// of all twelve has the least variance.
static void test_inversion_response_weighs_independent_samples(void **unused) {
    (void)unused;
    struct inversion_state state;
    make_two_bins(&state);
    state.inefficiency = 5;
    add_samples(&state, 5, 7);
    state.inefficiency = 1;
    add_samples(&state, 5, 1);
    assert_close(state.response.independent, 12, 1e-12);
    assert_close(state.response.covariance[0], (2 * 7 + 10 * 1) / 12.0, 1e-12);
    mf_inversion_response_clear(&state.response);
}

/// g is as it was, but the variance is half of what it was along the way that the potential has
/// gone: 1/1000 + (1² − 2/1000 − 2/10)/2.
static void test_inversion_response_forgets_what_has_changed_along_the_way(void **unused) {
    (void)unused;
    static const double gone[] = {0.3, 0};
    struct inversion_state state;
    make_two_bins(&state);
    state.inefficiency = 0.01;
    add_samples(&state, 5, 2);
    assert_close(state.response.independent, 1000, 1e-9);
    state.inefficiency = 1;
    state.phi = gone;
    add_samples(&state, 5, 1);
    assert_close(state.response.independent, 10 + 1 / (0.001 + (1 - 0.002 - 0.2) / 2), 1e-9);
    mf_inversion_response_clear(&state.response);
}

/// C of four bins has the relative variance 4/n as a matrix, so that one that is off by half in all
/// directions, as where the variance has fallen to two thirds, is worth at most 4/0.5² samples.
static void test_inversion_response_bears_what_the_noise_of_more_bins_hides(void **unused) {
    (void)unused;
    enum { MANY = 4 };
    static size_t known[] = {0, 1, 2, 3}, known_of = MANY;
    static double ideal[] = {5, 5, 5, 5}, mean[] = {5, 5, 5, 5};
    static const double phi[MANY] = {0}, gone[] = {0.1, -0.2, 0.3, 0.1};
    static const struct inverse_problem problem = {0};
    double comoment[MANY * MANY] = {0};
    struct inversion_state state = {
        .problem = &problem,
        .phi = phi,
        .grid = {.known = MANY,
                 .known_bin = known,
                 .known_point = known,
                 .known_of = &known_of,
                 .blocks = 1},
        .target.ideal = ideal,
        .inefficiency = 1e-6,
        .replicas.counts = {.size = MANY, .count = 10, .mean = mean, .comoment = comoment}};
    assert_ok(mf_inversion_response_init(&state));
    for (size_t a = 0; a < MANY; a++)
        comoment[a * (MANY + 1)] = 3;
    assert_ok(mf_inversion_response_add(&state));
    for (size_t a = 0; a < MANY; a++)
        comoment[a * (MANY + 1)] = 2;
    state.phi = gone;
    const double now = 10 / state.inefficiency;
    assert_ok(mf_inversion_response_add(&state));
    assert_close(state.response.independent - now, MANY / (0.5 * 0.5), 0.01);
    mf_inversion_response_clear(&state.response);
}

/// Pairs that an expansion parts, in a volume that fluctuates by 2 %: of the same samples the
/// response of G, the counts with their volume, to the potential of the pairs S as they are is
/// cov(G, S), and that of the density cov(ρ, S).
static void test_inversion_response_follows_the_density_at_constant_pressure(void **unused) {
    (void)unused;
    enum { OWN = 3, NUMBERS = OWN + SAMPLER_SUMS, SAMPLES = 20000, PAIRS = 400 };
    static size_t known[] = {0, 1, 2}, known_of = OWN;
    static double ideal[] = {40, 60, 80}, slope[OWN];
    static const double phi[OWN] = {0}, share[OWN] = {0.1, 0.15, 0.2};
    struct inverse_problem problem = {.scene.temperature = temperature};
    problem.compared.target[TARGET_DENSITY].count = 1;
    struct inversion_state state = {.problem = &problem,
                                    .phi = phi,
                                    .bins = OWN,
                                    .box = {.dimensions = 3, .length = {5, 5, 5}},
                                    .composition = mf_composition_of_one(100),
                                    .grid = {.known = OWN,
                                             .pairs_known = OWN,
                                             .pairs = 1,
                                             .known_bin = known,
                                             .known_point = known,
                                             .known_of = &known_of,
                                             .blocks = 1},
                                    .target.ideal = ideal,
                                    .inefficiency = 1,
                                    .bulk.slope = slope};
    struct comoments exact;
    unsigned seed = 5;
    assert_ok(mf_comoments_init(&state.replicas.counts, NUMBERS));
    assert_ok(mf_comoments_init(&exact, 2 * OWN + 1));
    for (int n = 0; n < SAMPLES; n++) {
        double normal = -6, sample[NUMBERS] = {0}, both[2 * OWN + 1];
        for (int k = 0; k < 12; k++)
            normal += (double)rand_r(&seed) / RAND_MAX;
        const double w = 1 / (1 + 0.02 * normal);
        for (int a = 0; a < OWN; a++) {
            int pairs = 0;
            for (int k = 0; k < PAIRS; k++)
                pairs += (double)rand_r(&seed) / RAND_MAX < share[a] * w * (1 + 5 * (w - 1));
            sample[a] = both[a] = pairs / w;
            both[OWN + a] = pairs;
        }
        sample[OWN + SAMPLER_DENSITY] = both[2 * OWN] = w;
        mf_comoments_add(&state.replicas.counts, sample);
        mf_comoments_add(&exact, both);
    }
    assert_ok(mf_inversion_response_init(&state));
    assert_ok(mf_inversion_response_add(&state));
    assert_ok(mf_inversion_bulk_slopes(&state));
    const double *response = mf_inversion_response_values(&state);
    for (size_t a = 0; a < OWN; a++)
        for (size_t b = 0; b < OWN; b++)
            assert_close(response[a * OWN + b], mf_comoments_covariance(&exact, a, OWN + b), 0.3);
    assert_true(response[1] > 2); // which without the density is 0
    for (size_t b = 0; b < OWN; b++)
        assert_close_relative(
            slope[b],
            -100 / 125.0 * mf_comoments_covariance(&exact, 2 * OWN, OWN + b) / temperature, 0.01);
    assert_true(slope[0] < 0);
    mf_inversion_response_clear(&state.response);
    mf_comoments_clear(&state.replicas.counts);
    mf_comoments_clear(&exact);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_response_tells_how_lengths_follow_their_values),
        cmocka_unit_test(test_inversion_response_forgets_what_has_changed),
        cmocka_unit_test(test_inversion_response_weighs_independent_samples),
        cmocka_unit_test(test_inversion_response_forgets_what_has_changed_along_the_way),
        cmocka_unit_test(test_inversion_response_bears_what_the_noise_of_more_bins_hides),
        cmocka_unit_test(test_inversion_response_follows_the_density_at_constant_pressure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
