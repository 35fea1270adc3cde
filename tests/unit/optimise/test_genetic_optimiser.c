// SPDX-License-Identifier: GPL-3.0-or-later
//
// The elite by ask and tell: rows of a round, and who may replace it. What it shares with the other
// optimisers is in test_optimisers.
#include "optimise/genetic.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { POPULATION = 6, GENES = 3, ROWS = POPULATION + GENETIC_REMEASUREMENTS };

struct run {
    void *state;
    struct optimiser_round round;
    struct genetic_parameters parameters;
};

static void ask(struct run *run) {
    assert_ok(mf_genetic_optimiser.ask(run->state, &run->round));
}

static void tell(struct run *run, const double *errors) {
    static const double exact[ROWS] = {0};
    assert_ok(mf_genetic_optimiser.tell(run->state, errors, exact));
    ask(run);
}

static struct run begin(int64_t generations) {
    struct run run = {.state = mf_memory_zeroed(1, mf_genetic_optimiser.state_size)};
    const struct optimiser_space space = {.variables = GENES, .maximum = 1, .seed = 3};
    assert_non_null(run.state);
    mf_fields_set_defaults(mf_genetic_fields, &run.parameters);
    run.parameters.population = POPULATION;
    run.parameters.generations = generations;
    run.parameters.mutation = 1; // so nobody is a twin by chance
    assert_ok(mf_genetic_optimiser.create(run.state, &space, &run.parameters));
    ask(&run);
    return run;
}

static void end(struct run *run) {
    mf_genetic_optimiser.destroy(run->state);
    mf_memory_free(run->state);
}

static void assert_genes(const double *a, const double *b) {
    assert_memory_equal(a, b, GENES * sizeof(double));
}

static const double *row(const struct run *run, size_t number) {
    return run->round.variables + number * GENES;
}

static void copy_row(const struct run *run, size_t number, double genes[GENES]) {
    memcpy(genes, row(run, number), GENES * sizeof(double));
}

static void test_challenger_becomes_elite_by_fresh_measurements_alone(void **state) {
    double challenger[GENES], better[GENES], best_candidate[GENES];
    struct run run = begin(10);
    (void)state;
    assert_int_equal(run.round.count, POPULATION);
    assert_false(mf_genetic_optimiser.best_candidate(run.state, best_candidate));
    copy_row(&run, 4, challenger);
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    assert_int_equal(run.round.count, ROWS);
    assert_genes(row(&run, POPULATION), challenger);
    assert_genes(row(&run, POPULATION + 1), challenger);
    assert_true(mf_genetic_optimiser.best_candidate(run.state, best_candidate));
    assert_genes(best_candidate, challenger);

    // Measured again, it is 2 on average. Nobody of this generation is below.
    tell(&run, (double[]){5, 4, 3, 2, 2.5, 6, 1.5, 2.5});
    assert_int_equal(run.round.count, POPULATION);
    assert_genes(row(&run, 0), challenger);

    // A lucky one that is no better when measured again.
    tell(&run, (double[]){2, 9, 9, 0.1, 9, 9});
    assert_int_equal(run.round.count, ROWS);
    tell(&run, (double[]){2, 9, 9, 9, 9, 9, 3, 2});
    assert_int_equal(run.round.count, POPULATION);
    assert_genes(row(&run, 0), challenger);

    // One that is.
    copy_row(&run, 2, better);
    tell(&run, (double[]){2, 9, 0.1, 9, 9, 9});
    tell(&run, (double[]){2, 9, 9, 9, 9, 9, 1.5, 1});
    assert_genes(row(&run, 0), better);
    assert_true(mf_genetic_optimiser.best_candidate(run.state, best_candidate));
    assert_genes(best_candidate, better);
    end(&run);
}

static void test_elite_falls_when_it_turns_out_to_be_bad(void **state) {
    double better[GENES];
    struct run run = begin(10);
    (void)state;
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    tell(&run, (double[]){9, 9, 9, 9, 9, 9, 1, 1});
    copy_row(&run, 5, better);
    tell(&run, (double[]){10, 9, 9, 9, 9, 3.9}); // a mean of 4 now
    assert_int_equal(run.round.count, ROWS);
    assert_genes(row(&run, POPULATION), better);
    end(&run);
}

static void test_last_round_measures_the_last_challenger_alone(void **state) {
    double challenger[GENES], best_candidate[GENES];
    struct run run = begin(2);
    (void)state;
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    copy_row(&run, 1, challenger);
    tell(&run, (double[]){9, 0.5, 9, 9, 9, 9, 1, 1});
    assert_int_equal(run.round.count, GENETIC_REMEASUREMENTS);
    assert_genes(row(&run, 0), challenger);
    tell(&run, (double[]){0.5, 0.7});
    assert_int_equal(run.round.count, 0);
    assert_true(mf_genetic_optimiser.best_candidate(run.state, best_candidate));
    assert_genes(best_candidate, challenger);
    assert_int_equal(mf_genetic_optimiser.max_rounds(&run.parameters, GENES), 3);
    end(&run);
}

static void test_twins_of_the_elite_are_no_challengers(void **state) {
    struct run run = begin(10);
    (void)state;
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    tell(&run, (double[]){9, 9, 9, 9, 9, 9, 1, 1});
    double *twin = (double *)run.round.variables + 3 * GENES;
    memcpy(twin, row(&run, 0), GENES * sizeof(double));
    tell(&run, (double[]){1, 9, 9, 0.1, 9, 9});
    assert_int_equal(run.round.count, POPULATION);
    end(&run);
}

static void test_discard_above_is_the_median_of_the_last_generation(void **state) {
    struct run run = begin(10);
    (void)state;
    tell(&run, (double[]){5, 4, 3, 2, 1, NAN});
    assert_close(mf_genetic_optimiser.discard_above(run.state), 4, 0);
    end(&run);
}

/// Walks begin about the start, which is individual 0, with the rms that is asked for; a block of
/// one gene is drawn anywhere in the range.
static void test_first_walks_are_about_the_start(void **state) {
    enum { CURVE = 50, COUNT = CURVE + 1, MANY = 400 };
    (void)state;
    struct genetic genetic;
    double start[COUNT], squares = 0, mean = 0, spread = 0;
    for (int k = 0; k < COUNT; k++)
        start[k] = 0.3 + 0.005 * k;
    const struct genetic_parameters parameters = {.population = MANY, .step = 0.02};
    assert_ok(mf_genetic_init(&genetic, &parameters,
                              &(struct optimiser_space){.variables = COUNT,
                                                        .maximum = 1,
                                                        .start = start,
                                                        .seed = 4,
                                                        .blocks = 2,
                                                        .block = (size_t[]){CURVE, 1}}));
    assert_memory_equal(mf_genetic_individual(&genetic, 0), start, sizeof start);
    for (int k = 1; k < MANY; k++) {
        const double *genes = mf_genetic_individual(&genetic, k);
        for (int n = 0; n < CURVE; n++)
            squares += pow(genes[n] - start[n], 2);
        mean += genes[CURVE] / (MANY - 1);
        spread += pow(genes[CURVE] - 0.5, 2) / (MANY - 1);
    }
    assert_close(sqrt(squares / (CURVE * (MANY - 1))), 0.02, 1e-9);
    assert_close(mean, 0.5, 5 * sqrt(1 / 12.0 / MANY));
    assert_close(spread, 1 / 12.0, 0.015);
    mf_genetic_clear(&genetic);
}

static struct run begin_patiently(int64_t generations, int64_t patience) {
    struct run run = begin(generations);
    mf_genetic_optimiser.destroy(run.state);
    const struct optimiser_space space = {.variables = GENES, .maximum = 1, .seed = 3};
    run.parameters.patience = patience;
    assert_ok(mf_genetic_optimiser.create(run.state, &space, &run.parameters));
    ask(&run);
    return run;
}

/// Once an elite has stood its ground for the generations of its patience; a better one begins
/// again.
static void test_it_settles_when_its_patience_is_over(void **state) {
    (void)state;
    struct run run = begin_patiently(100, 3);
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    tell(&run, (double[]){9, 9, 9, 9, 9, 9, 1, 1}); // the elite of generation 1
    tell(&run, (double[]){1, 9, 9, 9, 9, 9});
    assert_false(mf_genetic_optimiser.settled(run.state));
    tell(&run, (double[]){1, 9, 9, 9, 0.5, 9}); // a challenger at the last moment
    assert_int_equal(run.round.count, GENETIC_REMEASUREMENTS);
    double challenger[GENES];
    copy_row(&run, 0, challenger);
    tell(&run, (double[]){0.5, 0.5}); // is better: three more
    assert_false(mf_genetic_optimiser.settled(run.state));
    assert_genes(row(&run, 0), challenger);
    assert_int_equal(run.round.count, POPULATION);
    for (int generation = 0; generation < 3; generation++) {
        assert_int_equal(run.round.count, POPULATION);
        tell(&run, (double[]){0.5, 9, 9, 9, 9, 9});
    }
    assert_true(mf_genetic_optimiser.settled(run.state));
    assert_int_equal(run.round.count, 0);
    end(&run);
}

/// The elite keeps its place, and not the error of its noisy measurements; patience begins again.
static void test_it_goes_on_with_measurements_of_less_noise(void **state) {
    (void)state;
    double elite[GENES], best[GENES];
    struct run run = begin_patiently(5, 2);
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    tell(&run, (double[]){9, 9, 9, 9, 9, 9, 1, 1});
    copy_row(&run, 0, elite);
    tell(&run, (double[]){1, 9, 9, 9, 9, 9});
    tell(&run, (double[]){1, 9, 9, 9, 9, 9});
    assert_true(mf_genetic_optimiser.settled(run.state));
    assert_true(mf_genetic_optimiser.go_on(run.state));
    ask(&run);
    assert_false(mf_genetic_optimiser.settled(run.state));
    assert_int_equal(run.round.count, POPULATION);
    assert_genes(row(&run, 0), elite);
    // A checkpoint knows that patience has begun again.
    struct run other = begin_patiently(5, 2);
    struct memory_span from[OPTIMISER_MAX_SPANS], to[OPTIMISER_MAX_SPANS];
    const size_t spans = mf_genetic_optimiser.spans(run.state, from);
    assert_int_equal(mf_genetic_optimiser.spans(other.state, to), spans);
    for (size_t k = 0; k < spans; k++)
        memcpy(to[k].memory, from[k].memory, from[k].bytes);
    assert_false(mf_genetic_optimiser.settled(other.state));
    end(&other);
    // 2 now, not 1: what measures 1.5 is better.
    tell(&run, (double[]){2, 1.5, 9, 9, 9, 9});
    assert_int_equal(run.round.count, ROWS);
    tell(&run, (double[]){2, 9, 9, 9, 9, 9, 1.5, 1.5});
    assert_true(mf_genetic_optimiser.best_candidate(run.state, best));
    assert_memory_not_equal(best, elite, sizeof best);
    assert_false(mf_genetic_optimiser.go_on(run.state)); // five generations are used up
    end(&run);
}

static void test_what_is_suggested_joins_the_next_generation(void **state) {
    (void)state;
    const double found[GENES] = {0.1, 0.2, 0.3};
    struct run run = begin(10);
    tell(&run, (double[]){5, 4, 3, 2, 1, 6});
    mf_genetic_optimiser.suggest(run.state, found);
    ask(&run);
    assert_genes(row(&run, POPULATION - 1), found);
    end(&run);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_challenger_becomes_elite_by_fresh_measurements_alone),
        cmocka_unit_test(test_elite_falls_when_it_turns_out_to_be_bad),
        cmocka_unit_test(test_last_round_measures_the_last_challenger_alone),
        cmocka_unit_test(test_twins_of_the_elite_are_no_challengers),
        cmocka_unit_test(test_discard_above_is_the_median_of_the_last_generation),
        cmocka_unit_test(test_first_walks_are_about_the_start),
        cmocka_unit_test(test_it_settles_when_its_patience_is_over),
        cmocka_unit_test(test_it_goes_on_with_measurements_of_less_noise),
        cmocka_unit_test(test_what_is_suggested_joins_the_next_generation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
