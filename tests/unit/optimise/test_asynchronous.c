// SPDX-License-Identifier: GPL-3.0-or-later
//
// What optimisers promise that are asked for one candidate at a time, by workers of very unequal
// speed. landscape_stream checks the bounds of all candidates and incumbents.
#include "optimise/genetic.h"
#include "optimise/optimiser.h"
#include "shared/is_close.h"
#include "shared/landscapes.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { VARIABLES = 4, EVALUATIONS = 3000, SETTINGS = 6, SEEDS = 3 };

/// Errors are bounds of the incumbent's: twice what was the worst of ten seeds with 1, 3 and 16
/// workers.
static const struct variant {
    const struct optimiser *optimiser;
    struct landscape_setting settings[SETTINGS];
    double sphere, edge, noisy, failing;
} variants[] = {
    {&mf_genetic_optimiser,
     {{"population", 60},
      {"mutated_genes", 0.3},
      {"initial", GENETIC_UNIFORM},
      {"patience", 0},
      {"generations", 50}},
     4e-4,
     0.045,
     0.01,
     7e-3},
    {&mf_cmaes_optimiser, {{"rounds", 2000}}, 1e-9, 1e-9, 0.012, 7.5e-5},
};

#define EACH_VARIANT(v)                                                                            \
    const struct variant *v = variants;                                                            \
    v < variants + sizeof variants / sizeof *variants;                                             \
    v++

static void *parameters_of(const struct variant *variant) {
    return landscape_parameters_with(variant->optimiser, variant->settings, SETTINGS);
}

/// The incumbent's error is at most `bound`, for one worker and for more than a few.
static void check_minimum(const struct variant *variant, struct landscape_drive drive,
                          double bound) {
    static const int counts[] = {1, 3, 16};
    void *parameters = parameters_of(variant);
    drive.variables = VARIABLES;
    drive.evaluations = EVALUATIONS;
    drive.target = -HUGE_VAL;
    for (drive.seed = 1; drive.seed <= SEEDS; drive.seed++)
        for (int k = 0; k < 3; k++) {
            const struct landscape_workers workers = {counts[k], 1};
            const struct landscape_result result =
                landscape_minimise_by_stream(variant->optimiser, parameters, &drive, &workers);
            if (!(result.incumbent <= bound))
                fail_msg("%s, %s, seed %d, %d workers: %g", variant->optimiser->name,
                         drive.landscape->name, (int)drive.seed, counts[k], result.incumbent);
        }
    mf_memory_free(parameters);
}

static void test_asynchronous_finds_a_known_minimum(void **state) {
    (void)state;
    for (EACH_VARIANT(v)) {
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_sphere}, v->sphere);
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_edge}, v->edge);
    }
}

static void test_asynchronous_comes_close_when_errors_are_noisy(void **state) {
    (void)state;
    for (EACH_VARIANT(v))
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_sphere, .noise = 0.01},
                      v->noisy);
}

static void test_asynchronous_goes_on_when_candidates_fail(void **state) {
    (void)state;
    for (EACH_VARIANT(v))
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_sphere, .failing = 0.3},
                      v->failing);
}

static void test_asynchronous_has_no_incumbent_when_all_have_failed(void **state) {
    const struct landscape_drive drive = {.landscape = &landscape_sphere,
                                          .variables = VARIABLES,
                                          .failing = 1,
                                          .evaluations = 400,
                                          .target = -HUGE_VAL};
    (void)state;
    for (EACH_VARIANT(v)) {
        void *parameters = parameters_of(v);
        const struct landscape_result result = landscape_minimise_by_stream(
            v->optimiser, parameters, &drive, &(struct landscape_workers){8, 1});
        assert_true(result.evaluations == 400 || result.finished);
        assert_true(result.incumbent == HUGE_VAL);
        mf_memory_free(parameters);
    }
}

/// It ends by itself, and has then asked for no more than its rounds have.
static void test_asynchronous_ends_when_its_rounds_are_used_up(void **state) {
    const struct landscape_drive drive = {
        .landscape = &landscape_sphere, .variables = VARIABLES, .seed = 2, .target = -HUGE_VAL};
    (void)state;
    for (EACH_VARIANT(v)) {
        void *parameters = parameters_of(v);
        const bool genetic = v->optimiser == &mf_genetic_optimiser;
        landscape_set(v->optimiser, parameters, genetic ? "generations" : "rounds", 7);
        const struct landscape_result result = landscape_minimise_by_stream(
            v->optimiser, parameters, &drive, &(struct landscape_workers){8, 1});
        assert_true(result.finished);
        assert_int_equal(result.rounds, 7);
        mf_memory_free(parameters);
    }
}

static void copy_state(struct landscape_run *from, struct landscape_run *to) {
    struct memory_span source[OPTIMISER_MAX_SPANS], target[OPTIMISER_MAX_SPANS];
    const size_t count = from->optimiser->spans(from->state, source);
    assert_in_range(count, 1, OPTIMISER_MAX_SPANS);
    assert_int_equal(to->optimiser->spans(to->state, target), count);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(source[k].bytes, target[k].bytes);
        memcpy(target[k].memory, source[k].memory, source[k].bytes);
    }
}

static void check_incumbents(const struct landscape_run *first,
                             const struct landscape_run *second) {
    double one[VARIABLES] = {0}, other[VARIABLES] = {0};
    assert_int_equal(first->optimiser->incumbent(first->state, one),
                     second->optimiser->incumbent(second->state, other));
    assert_memory_equal(one, other, sizeof one);
}

/// Wherever it is interrupted, it finds the minimum without what was then being measured.
static void test_asynchronous_goes_on_when_restarted(void **state) {
    const struct landscape_workers workers = {16, 1};
    (void)state;
    for (EACH_VARIANT(v))
        for (uint64_t stop = 0; stop < 400; stop += 37) {
            void *parameters = parameters_of(v);
            struct landscape_drive drive = {.landscape = &landscape_sphere,
                                            .variables = VARIABLES,
                                            .seed = 5,
                                            .evaluations = stop,
                                            .target = -HUGE_VAL};
            struct landscape_result result = {.incumbent = HUGE_VAL};
            landscape_set(v->optimiser, parameters, "asynchronous", 1);
            struct landscape_run first = landscape_begin(v->optimiser, parameters, &drive);
            struct landscape_run second = landscape_begin(v->optimiser, parameters, &drive);
            if (stop > 0)
                landscape_stream(&first, &drive, &workers, &result);
            copy_state(&first, &second);
            check_incumbents(&first, &second);
            drive.evaluations = EVALUATIONS;
            landscape_stream(&second, &drive, &workers, &result);
            assert_true(result.incumbent <= v->sphere);
            landscape_end(&first);
            landscape_end(&second);
            mf_memory_free(parameters);
        }
}

enum { INDIVIDUALS = 6, GENES = 2 };

/// Ask for the next candidate and tell its error. Returns its first gene.
static double ask_and_tell(void *state, double error, bool *ended) {
    struct optimiser_candidate *candidate = mf_memory_zeroed(1, optimiser_candidate_size(GENES));
    assert_non_null(candidate);
    assert_true(mf_genetic_optimiser.stream->ask(state, candidate));
    const double gene = candidate->numbers[0];
    assert_ok(mf_genetic_optimiser.stream->tell(state, candidate, error, 0, ended));
    mf_memory_free(candidate);
    return gene;
}

/// The fresh measurements go before all others; by them the first challenger becomes the elite, and
/// the second, whose first error was as lucky, does not.
static void test_steady_state_believes_challengers_by_fresh_measurements_alone(void **unused) {
    const struct optimiser_space space = {.variables = GENES, .maximum = 1, .seed = 3};
    struct genetic_parameters parameters;
    void *state = mf_memory_zeroed(1, mf_genetic_optimiser.state_size);
    double lucky = 0, elite[GENES], later[GENES];
    bool ended;
    (void)unused;
    assert_non_null(state);
    mf_fields_set_defaults(mf_genetic_fields, &parameters);
    parameters.population = INDIVIDUALS;
    parameters.initial = GENETIC_UNIFORM;
    parameters.asynchronous = 1;
    assert_int_equal(parameters.remeasurements, 2);
    assert_ok(mf_genetic_optimiser.create(state, &space, &parameters));
    for (int k = 0; k < INDIVIDUALS; k++) {
        assert_false(mf_genetic_optimiser.incumbent(state, elite));
        const double gene = ask_and_tell(state, k == 4 ? 1 : 2 + k, &ended);
        lucky = k == 4 ? gene : lucky;
        assert_int_equal(ended, k == INDIVIDUALS - 1);
    }
    for (int k = 0; k < 2; k++)
        assert_identical(ask_and_tell(state, 1.5, &ended), lucky);
    assert_true(mf_genetic_optimiser.incumbent(state, elite));
    assert_identical(elite[0], lucky);
    for (int k = 0; k < INDIVIDUALS; k++)
        assert_true(ask_and_tell(state, k == 2 ? 0.5 : 9, &ended) != lucky);
    assert_true(ended);
    for (int k = 0; k < 2; k++)
        assert_true(ask_and_tell(state, 1.6, &ended) != lucky);
    assert_true(mf_genetic_optimiser.incumbent(state, later));
    assert_memory_equal(later, elite, sizeof elite);
    assert_identical(ask_and_tell(state, 1.5, &ended), lucky); // the elite, once a generation
    mf_genetic_optimiser.destroy(state);
    mf_memory_free(state);
}

static void test_steady_state_refuses_islands(void **unused) {
    const struct optimiser_space space = {.variables = GENES, .maximum = 1};
    struct genetic_parameters parameters;
    void *state = mf_memory_zeroed(1, mf_genetic_optimiser.state_size);
    (void)unused;
    assert_non_null(state);
    mf_fields_set_defaults(mf_genetic_fields, &parameters);
    parameters.asynchronous = 1;
    parameters.islands = 2;
    assert_int_equal(mf_genetic_optimiser.create(state, &space, &parameters), STATUS_BAD_INPUT);
    assert_non_null(strstr(mf_status_message(), "islands"));
    mf_genetic_optimiser.destroy(state);
    mf_memory_free(state);
}

/// A plateau ends the first descent. What was asked for before makes up no round of the second.
static void test_cmaes_leaves_candidates_out_when_their_descent_has_ended(void **unused) {
    const struct optimiser_space space = {.variables = GENES, .maximum = 1, .seed = 3};
    const struct optimiser *cmaes = &mf_cmaes_optimiser;
    struct cmaes_parameters parameters;
    struct optimiser_candidate *old = mf_memory_zeroed(1, optimiser_candidate_size(GENES)),
                               *now = mf_memory_zeroed(1, optimiser_candidate_size(GENES));
    void *state = mf_memory_zeroed(1, cmaes->state_size);
    bool ended;
    (void)unused;
    assert_true(old && now && state);
    mf_fields_set_defaults(mf_cmaes_fields, &parameters);
    parameters.population = INDIVIDUALS;
    parameters.restarts = 1;
    parameters.asynchronous = 1;
    assert_ok(cmaes->create(state, &space, &parameters));
    assert_true(cmaes->stream->ask(state, old));
    do {
        assert_true(cmaes->stream->ask(state, now));
        if (now->origin == old->origin)
            assert_ok(cmaes->stream->tell(state, now, 1, 0, &ended));
    } while (now->origin == old->origin);
    for (int k = 0; k < 10 * INDIVIDUALS; k++) {
        assert_ok(cmaes->stream->tell(state, old, 0, 0, &ended));
        assert_false(ended);
    }
    cmaes->destroy(state);
    mf_memory_free(state);
    mf_memory_free(old);
    mf_memory_free(now);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_asynchronous_finds_a_known_minimum),
        cmocka_unit_test(test_asynchronous_comes_close_when_errors_are_noisy),
        cmocka_unit_test(test_asynchronous_goes_on_when_candidates_fail),
        cmocka_unit_test(test_asynchronous_has_no_incumbent_when_all_have_failed),
        cmocka_unit_test(test_asynchronous_ends_when_its_rounds_are_used_up),
        cmocka_unit_test(test_asynchronous_goes_on_when_restarted),
        cmocka_unit_test(test_steady_state_believes_challengers_by_fresh_measurements_alone),
        cmocka_unit_test(test_steady_state_refuses_islands),
        cmocka_unit_test(test_cmaes_leaves_candidates_out_when_their_descent_has_ended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
