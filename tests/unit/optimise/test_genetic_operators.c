// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fixed seeds; bounds are five standard errors, or for χ² and Kolmogorov the value that a right
// operator exceeds for one seed in a million.
#include "base/rng.h"
#include "optimise/genetic.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { DRAWS = 60000 };

static struct rng_sequence begin(uint64_t seed) {
    return mf_rng_sequence_begin(seed, RNG_SELECTION, 0, 0);
}

// Tournament --------------------------------------------------------------------------------------

enum { POPULATION = 6 };

/// Probability that at most `max` of n draws fall on a share of the population.
static double at_most(int max, int n, double share) {
    double sum = 0, choose = 1;
    for (int k = 0; k <= max; k++) {
        sum += choose * pow(share, k) * pow(1 - share, n - k);
        choose *= (double)(n - k) / (k + 1);
    }
    return sum;
}

/// Probability of each individual to win: the one of rank m of the population is number j among n
/// drawn ones if at least j + 1 of these are of rank m or better, but not of rank m − 1 or better.
static void expected_winners(const double *errors, int size, double p, double *probability) {
    for (int k = 0; k < POPULATION; k++) {
        int better = 0;
        for (int other = 0; other < POPULATION; other++)
            better += errors[other] < errors[k];
        probability[k] = 0;
        for (int j = 0; j < size; j++) {
            const double wins = j + 1 < size ? p * pow(1 - p, j) : pow(1 - p, j);
            probability[k] += wins * (at_most(j, size, (double)better / POPULATION) -
                                      at_most(j, size, (better + 1.0) / POPULATION));
        }
    }
}

static void check_tournament(int size, double p) {
    static const double errors[POPULATION] = {0.3, 0.1, 2, 0.2, GENETIC_FAILED, 0.5};
    double probability[POPULATION], chi_squared = 0;
    int wins[POPULATION] = {0};
    struct rng_sequence random = begin((uint64_t)size);
    for (int k = 0; k < DRAWS; k++)
        wins[mf_genetic_tournament(errors, POPULATION, size, p, &random)]++;
    expected_winners(errors, size, p, probability);
    for (int k = 0; k < POPULATION; k++) {
        const double expected = DRAWS * probability[k];
        if (expected > 1e-9)
            chi_squared += (wins[k] - expected) * (wins[k] - expected) / expected;
        else
            assert_int_equal(wins[k], 0);
    }
    if (!(chi_squared < 35.9)) // 5 degrees of freedom
        fail_msg("size %d, probability %g: chi squared %g", size, p, chi_squared);
}

static void test_genetic_tournament_wins_with_the_probabilities_of_its_rule(void **state) {
    (void)state;
    check_tournament(1, 0.75);
    check_tournament(2, 0.75);
    check_tournament(2, 1);
    check_tournament(3, 0.5);
    check_tournament(8, 0.75);
    check_tournament(8, 1);
}

// Roulette ----------------------------------------------------------------------------------------

/// Draws of each individual, and χ² of those on what shares of the whole say.
static double spin(const double *errors, const double *share, int draws[POPULATION]) {
    double wheel[POPULATION], chi_squared = 0;
    struct rng_sequence random = begin(7);
    mf_genetic_fill_wheel(wheel, errors, POPULATION);
    for (int k = 0; k < POPULATION; k++)
        draws[k] = 0;
    for (int k = 0; k < DRAWS; k++)
        draws[mf_genetic_roulette(wheel, POPULATION, &random)]++;
    for (int k = 0; k < POPULATION; k++)
        if (share[k] > 0)
            chi_squared += pow(draws[k] - DRAWS * share[k], 2) / (DRAWS * share[k]);
        else
            assert_int_equal(draws[k], 0);
    return chi_squared;
}

static void test_genetic_roulette_chooses_in_proportion_to_fitness(void **state) {
    static const double errors[POPULATION] = {0.5, 0.25, 2, 1, GENETIC_FAILED, 0.125};
    static const double share[POPULATION] = {2 / 15.5, 4 / 15.5, 0.5 / 15.5, 1 / 15.5, 0, 8 / 15.5};
    int draws[POPULATION];
    (void)state;
    assert_true(spin(errors, share, draws) < 33.4); // 4 degrees of freedom
}

static void test_genetic_roulette_without_a_finite_fitness_is_fair(void **state) {
    static const double exact[POPULATION] = {0, 0.25, GENETIC_FAILED, 0, 1, 1};
    static const double failed[POPULATION] = {GENETIC_FAILED, GENETIC_FAILED, GENETIC_FAILED,
                                              GENETIC_FAILED, GENETIC_FAILED, GENETIC_FAILED};
    int draws[POPULATION];
    (void)state;
    assert_true(spin(exact, (const double[]){0.5, 0, 0, 0.5, 0, 0}, draws) < 25);
    assert_true(spin(failed, (const double[]){1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0},
                     draws) < 35.9);
}

// Crossover ---------------------------------------------------------------------------------------

static void test_genetic_crossover_exchanges_all_genes_beyond_one_point(void **state) {
    enum { GENES = 6 };
    int points[GENES + 1] = {0};
    struct rng_sequence random = begin(1);
    (void)state;
    for (int trial = 0; trial < DRAWS; trial++) {
        double a[GENES], b[GENES];
        int point = GENES;
        for (int k = 0; k < GENES; k++) {
            a[k] = k;
            b[k] = 100 + k;
        }
        mf_genetic_crossover(a, b, GENES, &random);
        while (point > 0 && a[point - 1] >= 100)
            point--;
        for (int k = 0; k < GENES; k++) {
            assert_close(a[k], k < point ? k : 100 + k, 0);
            assert_close(b[k], k < point ? 100 + k : k, 0);
        }
        points[point]++;
    }
    double chi_squared = 0;
    for (int point = 1; point < GENES; point++)
        chi_squared += pow(points[point] - DRAWS / 5.0, 2) / (DRAWS / 5.0);
    assert_int_equal(points[0] + points[GENES], 0);
    assert_true(chi_squared < 33.4); // 4 degrees of freedom
}

static void test_genetic_crossover_leaves_single_genes_alone(void **state) {
    double a = 1, b = 2;
    struct rng_sequence random = begin(1);
    (void)state;
    mf_genetic_crossover(&a, &b, 1, &random);
    assert_close(a, 1, 0);
    assert_close(b, 2, 0);
}

static void test_genetic_crossover_two_points_exchanges_a_stretch(void **state) {
    enum { GENES = 5 };
    int stretches[GENES][GENES + 1] = {0};
    double chi_squared = 0;
    struct rng_sequence random = begin(6);
    (void)state;
    for (int trial = 0; trial < DRAWS; trial++) {
        double a[GENES] = {0}, b[GENES] = {1, 1, 1, 1, 1};
        int first = 0, end = GENES;
        mf_genetic_crossover_two_points(a, b, GENES, &random);
        while (first < GENES && a[first] == 0)
            first++;
        while (end > 0 && a[end - 1] == 0)
            end--;
        for (int k = 0; k < GENES; k++) {
            assert_close(a[k], k >= first && k < end, 0);
            assert_close(b[k], 1 - a[k], 0);
        }
        assert_true(first < end && end < GENES);
        stretches[first][end]++;
    }
    for (int first = 0; first < GENES; first++)
        for (int end = first + 1; end < GENES; end++)
            chi_squared += pow(stretches[first][end] - DRAWS / 10.0, 2) / (DRAWS / 10.0);
    assert_true(chi_squared < 44.8); // 9 degrees of freedom
}

/// Both children keep the sum; each lies between its parents, and nearer to one of them at each end
/// of a curve when the blend is narrow.
static void test_genetic_blend_mixes_smoothly(void **state) {
    enum { GENES = 64 };
    struct rng_sequence random = begin(7);
    double steepest = 0;
    (void)state;
    for (int trial = 0; trial < 2000; trial++) {
        double a[GENES], b[GENES];
        for (int k = 0; k < GENES; k++) {
            a[k] = 1;
            b[k] = 0;
        }
        mf_genetic_blend(a, b, GENES, &random);
        for (int k = 0; k < GENES; k++) {
            assert_close(a[k] + b[k], 1, 1e-15);
            assert_true(a[k] >= 0 && a[k] <= 1);
            assert_true(k == 0 || a[k] <= a[k - 1]);
        }
        steepest += fabs(a[GENES / 2] - a[GENES / 2 - 1]) / 2000;
    }
    assert_true(steepest < 0.03); // one-point crossover: 1/63 of the trials a step of 1
}

static void test_genetic_recombine_does_what_its_kind_says(void **state) {
    (void)state;
    for (int kind = GENETIC_ONE_POINT; kind <= GENETIC_BLEND; kind++) {
        const struct genetic_parameters p = {.genes = 3, .crossover_kind = kind};
        double a[3] = {1, 2, 3}, b[3] = {4, 5, 6}, c[3] = {1, 2, 3}, d[3] = {4, 5, 6};
        struct rng_sequence first = begin(8), second = begin(8);
        mf_genetic_recombine(a, b, &p, &first);
        if (kind == GENETIC_ONE_POINT)
            mf_genetic_crossover(c, d, 3, &second);
        else if (kind == GENETIC_TWO_POINT)
            mf_genetic_crossover_two_points(c, d, 3, &second);
        else
            mf_genetic_blend(c, d, 3, &second);
        assert_memory_equal(a, c, sizeof a);
        assert_memory_equal(b, d, sizeof b);
    }
}

// Mutation ----------------------------------------------------------------------------------------

/// DRAWS genes of one value, mutated; free() them.
static double *mutated(double gene, double probability, double additive, uint64_t seed) {
    const struct genetic_parameters parameters = {
        .genes = DRAWS, .gene_minimum = -2, .gene_maximum = 8};
    struct rng_sequence random = begin(seed);
    double *genes = calloc(DRAWS, sizeof *genes);
    assert_non_null(genes);
    for (int k = 0; k < DRAWS; k++)
        genes[k] = gene;
    mf_genetic_mutate_scale(genes, &parameters, probability, additive, &random);
    return genes;
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// log2 of the factor is uniform in (−1, 1) by the test of Kolmogorov; so its mean is 0, and genes
/// do not drift.
static void test_genetic_mutate_scales_without_drift(void **state) {
    double *genes = mutated(-3, 1, 0, 2), mean = 0, largest = 0;
    (void)state;
    for (int k = 0; k < DRAWS; k++) {
        genes[k] = log2(genes[k] / -3);
        mean += genes[k] / DRAWS;
    }
    qsort(genes, DRAWS, sizeof *genes, compare_numbers);
    assert_true(genes[0] > -1 && genes[DRAWS - 1] < 1);
    for (int k = 0; k < DRAWS; k++)
        largest = fmax(largest, fabs(0.5 * (genes[k] + 1) - (k + 0.5) / DRAWS));
    assert_true(largest * sqrt(DRAWS) < 2.7);
    assert_close(mean, 0, 5 / sqrt(3.0 * DRAWS));
    free(genes);
}

/// A normal number of a tenth of the range, 1 here, is added: half of the genes near 0 change sign.
static void test_genetic_mutate_crosses_zero_when_it_adds(void **state) {
    int negative = 0;
    double squares = 0, mean = 0;
    double *genes = mutated(0, 1, 1, 3);
    (void)state;
    for (int k = 0; k < DRAWS; k++) {
        negative += genes[k] < 0;
        mean += genes[k] / DRAWS;
        squares += genes[k] * genes[k] / DRAWS;
    }
    assert_close(negative, 0.5 * DRAWS, 2.5 * sqrt(DRAWS));
    assert_close(mean, 0, 5 / sqrt(DRAWS));
    assert_close(squares, 1, 5 * sqrt(2.0 / DRAWS));
    free(genes);
}

/// Genes that are 0 stay 0 when scaled: those that do not are the additive share.
static void test_genetic_mutate_keeps_to_its_probabilities(void **state) {
    int scaled = 0, added = 0;
    double *ones = mutated(1, 0.2, 0.3, 4), *zeros = mutated(0, 0.2, 0.3, 5);
    (void)state;
    for (int k = 0; k < DRAWS; k++) {
        scaled += ones[k] != 1;
        added += zeros[k] != 0;
    }
    assert_close(scaled, 0.2 * DRAWS, 5 * sqrt(0.2 * 0.8 * DRAWS));
    assert_close(added, 0.06 * DRAWS, 5 * sqrt(0.06 * 0.94 * DRAWS));
    free(ones);
    free(zeros);
}

static void test_genetic_mutate_spares_the_children_that_are_not_drawn(void **state) {
    (void)state;
    enum { CHILDREN = 20000, GENES = 200 }; // all of which a mutation spares once in 1e9 children
    const struct genetic_parameters some = {.genes = GENES, .gene_maximum = 1, .mutation = 0.3};
    struct rng_sequence random = begin(11);
    int mutated = 0, all = 0;
    for (int child = 0; child < CHILDREN; child++) {
        double genes[GENES];
        int changed = 0;
        for (int k = 0; k < GENES; k++)
            genes[k] = 1;
        mf_genetic_mutate(genes, &(struct genetic){.parameters = some}, &random);
        for (int k = 0; k < GENES; k++)
            changed += genes[k] != 1;
        mutated += changed > 0;
        all += changed;
    }
    assert_close_relative(all, 0.1 * GENES * mutated, 0.005);
    // Five standard deviations of a binomial number.
    assert_close(mutated, 0.3 * CHILDREN, 5 * sqrt(CHILDREN * 0.3 * 0.7));
}

/// The variance of Brownian motion grows in proportion to the way from where it is 0: at the last
/// of 64 genes it is 1/64 of that at the first, for walks of all modes. Scaled to one height, with
/// modes that are broken off anywhere, walks are still flat at the first gene and 0 beyond the
/// last.
static void test_genetic_walk_has_its_height_and_ends_at_zero(void **state) {
    enum { COUNT = 64, TRIALS = 2000 };
    (void)state;
    double first = 0, last = 0, mean = 0;
    struct rng_sequence random = begin(5);
    for (int trial = 0; trial < TRIALS; trial++) {
        double genes[COUNT] = {0}, squares = 0;
        mf_genetic_walk(genes, COUNT, 2, &random);
        for (int k = 0; k < COUNT; k++)
            squares += genes[k] * genes[k] / COUNT;
        assert_close(squares, 4, 1e-9);
        first += genes[0] * genes[0] / TRIALS;
        last += genes[COUNT - 1] * genes[COUNT - 1] / TRIALS;
        mean += genes[0] / TRIALS;
    }
    print_message("mean squares %.3f at the first gene and %.4f at the last\n", first, last);
    assert_true(first > 4 && first < 8 && last < first / 40 && last > first / 4000);
    assert_close(mean, 0, 5 * sqrt(first / TRIALS));
}

/// Steps are in proportion to the survivors' spread, block by block.
static void test_genetic_mutate_walk_steps_as_far_as_survivors_differ(void **state) {
    enum { FIRST = 20, COUNT = 21 };
    (void)state;
    double step[2][COUNT] = {{0}};
    for (int k = 0; k < 2; k++) {
        size_t block[] = {FIRST, 1};
        double spread[] = {k == 0 ? 0.01 : 0.05, k == 0 ? 0.02 : 0.06};
        const struct genetic genetic = {.parameters = {.genes = COUNT,
                                                       .gene_minimum = -1,
                                                       .gene_maximum = 3,
                                                       .mutation = 1,
                                                       .mutation_kind = GENETIC_WALK},
                                        .blocks = 2,
                                        .block = block,
                                        .spread = spread};
        struct rng_sequence random = begin(6);
        mf_genetic_mutate(step[k], &genetic, &random);
    }
    for (int k = 0; k < COUNT; k++)
        assert_close(step[1][k], (k < FIRST ? 5 : 3) * step[0][k], 1e-12);
    assert_true(step[0][FIRST] != 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_genetic_tournament_wins_with_the_probabilities_of_its_rule),
        cmocka_unit_test(test_genetic_roulette_chooses_in_proportion_to_fitness),
        cmocka_unit_test(test_genetic_roulette_without_a_finite_fitness_is_fair),
        cmocka_unit_test(test_genetic_crossover_exchanges_all_genes_beyond_one_point),
        cmocka_unit_test(test_genetic_crossover_leaves_single_genes_alone),
        cmocka_unit_test(test_genetic_crossover_two_points_exchanges_a_stretch),
        cmocka_unit_test(test_genetic_blend_mixes_smoothly),
        cmocka_unit_test(test_genetic_recombine_does_what_its_kind_says),
        cmocka_unit_test(test_genetic_mutate_scales_without_drift),
        cmocka_unit_test(test_genetic_mutate_crosses_zero_when_it_adds),
        cmocka_unit_test(test_genetic_mutate_keeps_to_its_probabilities),
        cmocka_unit_test(test_genetic_mutate_spares_the_children_that_are_not_drawn),
        cmocka_unit_test(test_genetic_walk_has_its_height_and_ends_at_zero),
        cmocka_unit_test(test_genetic_mutate_walk_steps_as_far_as_survivors_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
