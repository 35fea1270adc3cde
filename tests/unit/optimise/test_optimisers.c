// SPDX-License-Identifier: GPL-3.0-or-later
//
// What every optimiser promises, for all of them alike. landscape_step asks twice and compares, and
// checks that no candidate and no incumbent is beyond the bounds, in every round of every test
// here.
#include "optimise/genetic.h"
#include "optimise/optimiser.h"
#include "shared/is_close.h"
#include "shared/landscapes.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { VARIABLES = 4, EVALUATIONS = 3000, SETTINGS = 8, SEEDS = 3 };

/// An optimiser with its settings, and the largest error of its incumbent that is right: twice what
/// was the worst of ten seeds, or 1e-9. Those of the GN_ and of Rosenbrock's and Rastrigin's
/// functions are of local minima, or of a search that was not over.
static const struct variant {
    const struct optimiser *optimiser;
    struct landscape_setting settings[SETTINGS];
    double sphere, rosenbrock, rastrigin, edge, noisy, failing;
} variants[] = {
#define GENETIC(crossover, mutation)                                                               \
    &mf_genetic_optimiser, {                                                                       \
        {"crossover_kind", crossover}, {"mutation_kind", mutation}, {"population", 60},            \
            {"mutation", 1}, {"initial", GENETIC_UNIFORM}, {"patience", 0}, {                      \
            "generations", 50                                                                      \
        }                                                                                          \
    }
    {GENETIC(GENETIC_ONE_POINT, GENETIC_SCALE), 6e-5, 8, 4, 1e-3, 0.02, 4e-4},
    {GENETIC(GENETIC_BLEND, GENETIC_SCALE), 6e-5, 8, 4, 4.5e-3, 0.02, 4e-4},
    {GENETIC(GENETIC_BLEND, GENETIC_WALK), 6e-5, 3, 8, 0.02, 0.011, 6e-5},
#define NLOPT(algorithm)                                                                           \
    &mf_nlopt_optimiser, {                                                                         \
        {"algorithm", algorithm}, {                                                                \
            "evaluations", EVALUATIONS                                                             \
        }                                                                                          \
    }
    {&mf_cmaes_optimiser, {{"rounds", 2000}}, 1e-9, 1e-9, 24, 1e-9, 0.02, 1e-9},
    {NLOPT(0), 1.4e-3, 5, 1.7, 0.024, 0.036, 5.4e-3}, // GN_ESCH
    {NLOPT(1), 1e-9, 1.6e-5, 8, 1e-9, 0.042, 1e-9},   // GN_CRS2_LM
    {NLOPT(2), 0.014, 6, 8, 0.34, 0.054, 0.01},       // GN_ISRES
    {NLOPT(3), 1e-9, 1.2e-3, 6, 1e-9, 0.017, 0.015},  // GN_DIRECT_L_RAND
    {NLOPT(4), 1e-9, 0.42, 1e-9, 1e-9, 0.048, 1e-9},  // LN_SBPLX
    {NLOPT(5), 1e-9, 1e-9, 1e-9, 1e-9, 0.161, 0.161}, // LN_BOBYQA: what it begins with, if fooled
    {NLOPT(6), 1e-9, 0.1, 8, 1e-9, 0.161, 0.161},     // LN_COBYLA
};

enum { VARIANTS = sizeof variants / sizeof *variants };

static void *parameters_of(const struct variant *variant) {
    return landscape_parameters_with(variant->optimiser, variant->settings, SETTINGS);
}

/// The incumbent's error is at most `bound` for each of some seeds.
static void check_minimum(const struct variant *variant, struct landscape_drive drive,
                          double bound) {
    void *parameters = parameters_of(variant);
    drive.variables = VARIABLES;
    drive.evaluations = EVALUATIONS;
    drive.target = -HUGE_VAL;
    for (drive.seed = 1; drive.seed <= SEEDS; drive.seed++) {
        const struct landscape_result result =
            landscape_minimise(variant->optimiser, parameters, &drive);
        if (!(result.best_candidate <= bound))
            fail_msg("%s, variant %d, %s, seed %d: %g is above %g", variant->optimiser->name,
                     (int)(variant - variants), drive.landscape->name, (int)drive.seed,
                     result.best_candidate, bound);
    }
    mf_memory_free(parameters);
}

static void test_every_optimiser_finds_a_known_minimum(void **state) {
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_sphere}, v->sphere);
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_rosenbrock},
                      v->rosenbrock);
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_rastrigin}, v->rastrigin);
    }
}

static void test_every_optimiser_finds_a_minimum_at_the_bounds(void **state) {
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++)
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_edge}, v->edge);
}

static void test_every_optimiser_comes_close_when_errors_are_noisy(void **state) {
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++)
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_sphere, .noise = 0.02},
                      v->noisy);
}

/// Three of ten candidates fail by turns with 1e9, NaN, ∞, −∞ and 1e300.
static void test_every_optimiser_goes_on_when_candidates_fail(void **state) {
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++)
        check_minimum(v, (struct landscape_drive){.landscape = &landscape_sphere, .failing = 0.3},
                      v->failing);
}

static void test_every_optimiser_has_no_incumbent_when_all_have_failed(void **state) {
    const struct landscape_drive drive = {.landscape = &landscape_sphere,
                                          .variables = VARIABLES,
                                          .seed = 5,
                                          .failing = 1,
                                          .target = -HUGE_VAL,
                                          .evaluations = 500};
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        void *parameters = parameters_of(v);
        const struct landscape_result result = landscape_minimise(v->optimiser, parameters, &drive);
        assert_true(result.rounds > 0);
        assert_true(result.best_candidate == HUGE_VAL);
        mf_memory_free(parameters);
    }
}

// Restart -----------------------------------------------------------------------------------------

struct checkpoint {
    size_t count;
    struct memory_span spans[OPTIMISER_MAX_SPANS];
};

static struct checkpoint save(struct landscape_run *run) {
    struct checkpoint saved;
    saved.count = run->optimiser->spans(run->state, saved.spans);
    assert_true(saved.count <= OPTIMISER_MAX_SPANS);
    for (size_t k = 0; k < saved.count; k++) {
        void *copy = malloc(saved.spans[k].bytes);
        assert_non_null(copy);
        saved.spans[k].memory = memcpy(copy, saved.spans[k].memory, saved.spans[k].bytes);
    }
    return saved;
}

static void load(struct landscape_run *run, struct checkpoint *saved) {
    struct memory_span spans[OPTIMISER_MAX_SPANS];
    assert_int_equal(run->optimiser->spans(run->state, spans), saved->count);
    for (size_t k = 0; k < saved->count; k++) {
        assert_int_equal(spans[k].bytes, saved->spans[k].bytes);
        memcpy(spans[k].memory, saved->spans[k].memory, spans[k].bytes);
        free(saved->spans[k].memory);
    }
}

static void compare_candidates(struct landscape_run *a, struct landscape_run *b) {
    struct optimiser_round first, second;
    assert_ok(a->optimiser->ask(a->state, &first));
    assert_ok(b->optimiser->ask(b->state, &second));
    assert_int_equal(first.count, second.count);
    assert_memory_equal(first.variables, second.variables,
                        first.count * VARIABLES * sizeof(double));
}

static void compare_beliefs(struct landscape_run *a, struct landscape_run *b) {
    double first[VARIABLES] = {0}, second[VARIABLES] = {0};
    assert_int_equal(a->optimiser->best_candidate(a->state, first),
                     b->optimiser->best_candidate(b->state, second));
    assert_memory_equal(first, second, sizeof first);
    assert_identical(a->optimiser->spread(a->state), b->optimiser->spread(b->state));
    assert_identical(a->optimiser->discard_above(a->state), b->optimiser->discard_above(b->state));
}

/// Save after `before` rounds, go on in a new state, and compare with going on in the old one.
static void check_restart(const struct variant *variant, double noise, int before, bool asked) {
    const struct landscape_drive drive = {.landscape = &landscape_rastrigin,
                                          .variables = VARIABLES,
                                          .seed = 7,
                                          .noise = noise,
                                          .failing = noise > 0 ? 0.1 : 0};
    void *parameters = parameters_of(variant);
    struct landscape_result result = {.min = HUGE_VAL};
    struct landscape_run old = landscape_begin(variant->optimiser, parameters, &drive);
    for (int k = 0; k < before; k++)
        landscape_step(&old, &drive, &result);
    struct checkpoint saved = save(&old);
    struct landscape_run new = landscape_begin(variant->optimiser, parameters, &drive);
    if (asked) {
        struct optimiser_round ignored;
        assert_ok(new.optimiser->ask(new.state, &ignored));
    }
    load(&new, &saved);
    struct landscape_result again = result;
    for (int k = 0; k < 60; k++) {
        compare_candidates(&old, &new);
        compare_beliefs(&old, &new);
        landscape_step(&old, &drive, &result);
        landscape_step(&new, &drive, &again);
    }
    landscape_end(&old);
    landscape_end(&new);
    mf_memory_free(parameters);
}

static void test_every_optimiser_goes_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        check_restart(v, 2, 0, false);
        check_restart(v, 2, 1, true);
        check_restart(v, 2, 7, false);
        check_restart(v, 2, 40, true);
    }
}

/// Two at once in turns, which NLopt's random numbers must not mix up.
static void test_every_optimiser_is_a_function_of_its_seed(void **state) {
    const struct landscape_drive drive = {
        .landscape = &landscape_rosenbrock, .variables = VARIABLES, .seed = 3};
    struct landscape_drive other = drive;
    (void)state;
    other.seed = 4;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        void *parameters = parameters_of(v);
        struct landscape_result a = {0}, b = {0}, c = {0};
        struct landscape_run first = landscape_begin(v->optimiser, parameters, &drive);
        struct landscape_run third = landscape_begin(v->optimiser, parameters, &other);
        for (int k = 0; k < 30; k++) {
            landscape_step(&first, &drive, &a);
            landscape_step(&third, &other, &c);
        }
        struct landscape_run second = landscape_begin(v->optimiser, parameters, &drive);
        for (int k = 0; k < 30; k++)
            landscape_step(&second, &drive, &b);
        compare_candidates(&first, &second);
        compare_beliefs(&first, &second);
        landscape_end(&first);
        landscape_end(&second);
        landscape_end(&third);
        mf_memory_free(parameters);
    }
}

/// An optimiser that has used its budget up has not settled, whatever it believes.
static void test_only_what_ended_by_itself_has_settled(void **state) {
    struct landscape_drive drive = {
        .landscape = &landscape_sphere, .variables = VARIABLES, .seed = 7};
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        const bool local = v->optimiser == &mf_nlopt_optimiser && v->settings[0].value >= 4;
        const bool may_settle = local || v->optimiser == &mf_cmaes_optimiser;
        for (int ample = 0; ample < 2; ample++) {
            void *parameters = parameters_of(v);
            struct landscape_result result = {.min = HUGE_VAL};
            landscape_set(v->optimiser, parameters, v->optimiser->budget, ample ? 5000 : 10);
            struct landscape_run run = landscape_begin(v->optimiser, parameters, &drive);
            while ((!ample || may_settle) && landscape_step(&run, &drive, &result))
                assert_false(v->optimiser->settled && v->optimiser->settled(run.state) &&
                             result.rounds < 5);
            if (v->optimiser->settled)
                assert_int_equal(v->optimiser->settled(run.state), ample && may_settle);
            landscape_end(&run);
            mf_memory_free(parameters);
        }
    }
}

// Space -------------------------------------------------------------------------------------------

static void test_every_optimiser_begins_near_its_start(void **state) {
    const double start[VARIABLES] = {0.7, 0.25, 0.6, 0.3};
    const struct landscape_drive drive = {
        .landscape = &landscape_sphere, .variables = VARIABLES, .seed = 3, .start = start};
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        void *parameters = parameters_of(v);
        struct optimiser_round round;
        double nearest = HUGE_VAL;
        if (v->optimiser == &mf_cmaes_optimiser)
            landscape_set(v->optimiser, parameters, "step", 0.01);
        struct landscape_run run = landscape_begin(v->optimiser, parameters, &drive);
        assert_ok(v->optimiser->ask(run.state, &round));
        for (size_t k = 0; k < round.count; k++) {
            double distance = 0;
            for (int variable = 0; variable < VARIABLES; variable++)
                distance = fmax(distance, fabs(round.variables[k * VARIABLES + (size_t)variable] -
                                               start[variable]));
            nearest = fmin(nearest, distance);
        }
        const bool global = v->optimiser == &mf_nlopt_optimiser && v->settings[0].value < 4;
        if (!global)
            assert_close(nearest, 0, v->optimiser == &mf_cmaes_optimiser ? 0.03 : 1e-12);
        landscape_end(&run);
        mf_memory_free(parameters);
    }
}

static void test_every_optimiser_refuses_a_space_without_room(void **state) {
    const double start[1] = {NAN};
    const struct optimiser_space bad[] = {
        {.variables = 0, .maximum = 1},
        {.variables = 1, .minimum = 1, .maximum = 1},
        {.variables = 1, .minimum = 0, .maximum = NAN},
        {.variables = 1, .minimum = -1e308, .maximum = 1e308},
        {.variables = 1, .maximum = 1, .start = start},
    };
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++)
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            void *parameters = parameters_of(v),
                 *memory = mf_memory_zeroed(1, v->optimiser->state_size);
            assert_non_null(memory);
            assert_int_equal(v->optimiser->create(memory, &bad[k], parameters), STATUS_BAD_INPUT);
            v->optimiser->destroy(memory);
            mf_memory_free(memory);
            mf_memory_free(parameters);
        }
}

/// The genetic algorithm's largest round has the measurements of a challenger, too.
static void test_populations_larger_than_a_round_are_refused(void **state) {
    static const struct {
        const struct optimiser *optimiser;
        size_t max; ///< for a population of 60
    } populations[] = {{&mf_genetic_optimiser, 62}, {&mf_cmaes_optimiser, 60}};
    (void)state;
    for (int k = 0; k < 2; k++)
        for (size_t less = 0; less < 2; less++) {
            const struct optimiser *optimiser = populations[k].optimiser;
            const struct optimiser_space space = {
                .variables = VARIABLES, .maximum = 1, .max = populations[k].max - less};
            void *parameters = landscape_parameters(optimiser),
                 *memory = mf_memory_zeroed(1, optimiser->state_size);
            assert_non_null(memory);
            landscape_set(optimiser, parameters, "population", 60);
            if (less)
                assert_fails(optimiser->create(memory, &space, parameters), STATUS_BAD_INPUT,
                             "\"population\" gives rounds of");
            else
                assert_ok(optimiser->create(memory, &space, parameters));
            optimiser->destroy(memory);
            mf_memory_free(memory);
            mf_memory_free(parameters);
        }
}

static void test_discard_above_is_unknown_before_a_round_is_told(void **state) {
    const struct landscape_drive drive = {
        .landscape = &landscape_sphere, .variables = VARIABLES, .seed = 3};
    (void)state;
    for (const struct variant *v = variants; v < variants + VARIANTS; v++) {
        void *parameters = parameters_of(v);
        struct landscape_result result = {.min = HUGE_VAL};
        struct landscape_run run = landscape_begin(v->optimiser, parameters, &drive);
        assert_true(v->optimiser->discard_above(run.state) == HUGE_VAL);
        landscape_step(&run, &drive, &result);
        if (v->optimiser != &mf_nlopt_optimiser) {
            assert_true(v->optimiser->discard_above(run.state) > result.min);
            assert_true(v->optimiser->discard_above(run.state) < VARIABLES);
        }
        landscape_end(&run);
        mf_memory_free(parameters);
    }
}

static void test_optimiser_find_knows_every_optimiser_when_named(void **state) {
    (void)state;
#define FOUND(record, name, summary)                                                               \
    assert_ptr_equal(mf_optimiser_find(name), &mf_##record##_optimiser);
    OPTIMISERS(FOUND)
    assert_null(mf_optimiser_find("simplex"));
}

static void test_optimiser_reflect_folds_at_both_ends(void **state) {
    (void)state;
    assert_close(mf_optimiser_reflect(0.25), 0.25, 0);
    assert_close(mf_optimiser_reflect(-0.25), 0.25, 0);
    assert_close(mf_optimiser_reflect(1.25), 0.75, 0);
    assert_close(mf_optimiser_reflect(-1.25), 0.75, 0);
    assert_close(mf_optimiser_reflect(2.25), 0.25, 0);
    assert_close(mf_optimiser_reflect(1e300), 0, 1);
    assert_close(mf_optimiser_reflect(NAN), 0, 0);
    assert_close(mf_optimiser_reflect(HUGE_VAL), 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_optimiser_finds_a_known_minimum),
        cmocka_unit_test(test_every_optimiser_finds_a_minimum_at_the_bounds),
        cmocka_unit_test(test_every_optimiser_comes_close_when_errors_are_noisy),
        cmocka_unit_test(test_every_optimiser_goes_on_when_candidates_fail),
        cmocka_unit_test(test_every_optimiser_has_no_incumbent_when_all_have_failed),
        cmocka_unit_test(test_every_optimiser_goes_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_every_optimiser_is_a_function_of_its_seed),
        cmocka_unit_test(test_only_what_ended_by_itself_has_settled),
        cmocka_unit_test(test_every_optimiser_begins_near_its_start),
        cmocka_unit_test(test_every_optimiser_refuses_a_space_without_room),
        cmocka_unit_test(test_populations_larger_than_a_round_are_refused),
        cmocka_unit_test(test_discard_above_is_unknown_before_a_round_is_told),
        cmocka_unit_test(test_optimiser_find_knows_every_optimiser_when_named),
        cmocka_unit_test(test_optimiser_reflect_folds_at_both_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
