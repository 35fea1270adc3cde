// SPDX-License-Identifier: GPL-3.0-or-later
//
// The words of an iteration's progress, and what is said of the targets of molecules.
#include "defaults/fit_states.h"
#include "shared/propane.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "work/fit_print.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

/// Where the tests are started, with targets/.
static char root[512];

static const struct inverse_progress nothing = {
    .iteration = 3, .best = NAN, .min = NAN, .mean = NAN};

static void assert_says(const struct inverse_progress *now, const struct units *units,
                        const char *expected) {
    char text[FIT_TELL_SIZE];
    mf_fit_print_iteration(now, units, text);
    assert_string_equal(text, expected);
}

static void test_iteration_tells_the_errors_that_it_knows(void **state) {
    (void)state;
    const struct units units = {0};
    struct inverse_progress now = nothing;
    assert_says(&now, &units, "iteration 3");
    now.best = 0.01234;
    assert_says(&now, &units, "iteration 3  error 0.0123 so far");
    now.min = 0.02, now.mean = 0.5, now.failures = 2;
    assert_says(&now, &units,
                "iteration 3  error 0.0123 so far  this round: best 0.0200, mean 0.5000, 2 failed");
}

/// As the samples of single molecules report before a fit has begun.
static void test_iteration_tells_no_errors_that_nobody_has_set(void **state) {
    (void)state;
    assert_says(&(struct inverse_progress){.iterations = 40}, &(struct units){0}, "iteration 0");
}

/// Integrals have a unit, in which the files speak: here 2 nm is the unit of length.
static void test_iteration_tells_of_samples_that_are_doubled(void **state) {
    (void)state;
    struct units units = {0};
    struct inverse_progress now = nothing;
    now.best = 0.01234;
    now.doubling = (struct inverse_doubling){3, 7, 0.00641, 0.004, ""};
    assert_says(&now, &units, "iteration 3  doubling samples, 3 of 7: noise 0.0064, wanted 0.004");
    units = (struct units){.system = UNITS_NM_PS, .length = 2, .dimensions = 3};
    assert_says(&now, &units, "iteration 3  doubling samples, 3 of 7: noise 0.0064, wanted 0.004");
    now.doubling.unit = "lambda^d";
    assert_says(&now, &units,
                "iteration 3  doubling samples, 3 of 7: noise 0.051, wanted 0.032 nm^3");
}

static void keep_line(void *context, const char *line) {
    char *text = context;
    strcat(strncat(text, line, 1000), "\n");
}

/// What is told of the state of run.json.
static void report_state(char text[16384]) {
    struct fit_file fit;
    text[0] = '\0';
    assert_ok(mf_fit_file_parse(&fit, "run.json", &(struct run_options){.threads = 1}));
    assert_ok(mf_fit_states_normalise(&fit));
    assert_ok(mf_fit_print_state(&fit, &(struct target_sanity_listener){keep_line, text}));
    mf_fit_file_clear(&fit);
}

/// As of a volume that is off by 5 %, or of one file that is over another number of pairs. Pair
/// types that are off and make up for each other are a mixture whose types gather.
static void test_fit_of_molecules_warns_of_g_that_ends_beside_1(void **state) {
    static const struct {
        double factor[PROPANE_PAIRS];
        const char *words; ///< NULL: no warning
    } cases[] = {{{1, 1, 1}, NULL},
                 {{1.05, 1.05, 1.05}, "g of all beads is 1.05"},
                 {{0.95, 0.95, 0.95}, "g of all beads is 0.95"},
                 {{1.05, 1, 1}, "target.rdf.A-A: over the last quarter of its range g is 1.05"},
                 {{1, 0.95, 1}, "target.rdf.A-B: over the last quarter of its range g is 0.9"},
                 {{1, 1, 1.05}, "target.rdf.B-B: over the last quarter of its range g is 1.05"},
                 {{1, 1, 1.025}, NULL},
                 {{1.05, 0.95, 1.05}, NULL}};
    static char text[16384];
    small_inputs_write(*state, "run.json", propane_run, NULL, NULL);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        for (int pair = 0; pair < PROPANE_PAIRS; pair++)
            propane_write_target(*state, root, pair, cases[k].factor[pair]);
        report_state(text);
        assert_contains(text, "target rdf.A-A: ");
        if (cases[k].words)
            assert_contains(text, cases[k].words);
        else
            assert_null(strstr(text, "not 1"));
    }
}

int main(void) {
    if (getcwd(root, sizeof root) == NULL)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_iteration_tells_the_errors_that_it_knows),
        cmocka_unit_test(test_iteration_tells_no_errors_that_nobody_has_set),
        cmocka_unit_test(test_iteration_tells_of_samples_that_are_doubled),
        cmocka_unit_test_setup_teardown(test_fit_of_molecules_warns_of_g_that_ends_beside_1,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
