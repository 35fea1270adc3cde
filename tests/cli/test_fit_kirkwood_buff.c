// SPDX-License-Identifier: GPL-3.0-or-later
//
// Integrals of Kirkwood and Buff as targets. A mixture with known potentials; its g(r) is known to
// their cutoff, and tilted within its errors. By g alone the fit's integrals are several errors
// off; with those of a simulation of the truth they agree. And what is refused.
#include "shared/integrals.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TYPES "\"particles\": {\"types\": {\"A\": 200, \"B\": 200}}"
#define SETUP                                                                                      \
    "\"box\": [7.4, 7.4, 7.4], \"time_step\": 0.05, " TYPES                                        \
    ", \"dissipative\": {\"law\": \"power\", \"sigma\": 2}"
#define SOFT(a) "{\"law\": \"soft-repulsion\", \"a\": " #a "}"

static const char scene[] =
    "{\"seed\": 1, " SETUP ",\n"
    "\"conservative\": {\"A-A\": " SOFT(10) ", \"A-B\": " SOFT(14) ", \"B-B\": " SOFT(
        10) "},\n"
            "\"rdf\": {\"range\": 1, \"bins\": 16}, \"kirkwood_buff\": {\"q_maximum\": 2.2},\n"
            "\"measure\": {\"equilibration\": 1000, \"samples\": 6000, \"every\": 20}}\n";

#define RDF(pair) "\"" pair "\": {\"file\": \"g_" pair ".tsv\", \"normalisation\": 1}"
#define METHOD                                                                                     \
    "\"name\": \"imc\", \"replicas\": 8, \"samples\": 400, \"every\": 10, \"precision\": 0.01"
#define COARSE_METHOD                                                                              \
    "\"name\": \"imc\", \"replicas\": 4, \"samples\": 100, \"every\": 10, \"precision\": 0.03"
// Potentials of bins this wide heat a step of 0.05 by 7 %.
#define CHECKS                                                                                     \
    "\"replicas\": 4, \"equilibration\": 1000, \"samples\": 800, \"every\": 80, "                  \
    "\"time_step\": 0.02"

#define COARSE_CHECKS                                                                              \
    "\"replicas\": 4, \"equilibration\": 1000, \"samples\": 200, \"every\": 40, "                  \
    "\"time_step\": 0.02"

#define PLAN METHOD "},\n\"verification\": {" CHECKS
#define COARSE_PLAN COARSE_METHOD "},\n\"verification\": {" COARSE_CHECKS
#define SHORT_PLAN                                                                                 \
    "\"name\": \"imc\", \"replicas\": 2, \"samples\": 100, \"precision\": 0.05, \"iterations\": "  \
    "3},\n"                                                                                        \
    "\"verification\": {\"replicas\": 2, \"equilibration\": 50, \"samples\": 20, \"every\": 5"

/// Of the run file, with the integrals in between.
static const char head[] =
    "{\"seed\": 4, \"scene\": {" SETUP "}, \"unknowns\": {\"potential\": {}},\n"
    "\"method\": {" PLAN
    "},\n\"target\": {\"rdf\": {" RDF("A-A") ", " RDF("A-B") ", " RDF("B-B") "}";

static struct integrals integrals = {{"A-A", "A-B", "B-B"}, 3, 0.04};
static double tilt = 0.06;
static struct run_program_result result;

/// In short g is tilted more and integrals are met less closely, which takes fewer samples.
static int enter(void **state) {
    if (!length_is_long()) {
        integrals.error = 0.12;
        tilt = 0.15;
    }
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "truth.json", scene, "6000", length_is_long() ? "6000" : "1500");
    RUN_PROGRAM(&result, "simulate", "truth.json", "-o", "truth");
    run_program_assert_code(&result, 0);
    integrals_tilt(*state, "A-A", 1 - tilt, tilt);
    integrals_tilt(*state, "A-B", 1 + tilt, tilt);
    integrals_tilt(*state, "B-B", 1 - tilt, tilt);
    return 0;
}

/// The run with the truth's integrals, fitted or not.
static void write_run(struct temporary_folder *folder, const char *file, const char *fitted,
                      double error, const char *plan) {
    char text[4096], members[1024];
    integrals_of_truth(&integrals, error, members, sizeof members);
    snprintf(text, sizeof text,
             "%s, \"kirkwood_buff\": {\"q_maximum\": 2.2, %s, \"fitted\": \"%s\"}}}\n", head,
             members, fitted);
    small_inputs_write(folder, file, text, PLAN, plan);
}

static void test_g_alone_leaves_the_integrals_of_a_mixture_off(void **state) {
    write_run(*state, "alone.json", "no", integrals.error, length_is_long() ? PLAN : COARSE_PLAN);
    RUN_PROGRAM(&result, "fit", "alone.json", "-o", "alone");
    run_program_assert_code(&result, 0);
    assert_true(integrals_farthest(&integrals, "alone") > 3);
}

/// 3 errors: as often as the verification itself would say that the fit has not converged.
static void test_fit_meets_the_integrals_of_a_mixture(void **state) {
    write_run(*state, "both.json", "yes", integrals.error, length_is_long() ? PLAN : COARSE_PLAN);
    RUN_PROGRAM(&result, "fit", "both.json", "-o", "both", "--threads", "2");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "Kirkwood-Buff integral of A-B = ");
    assert_true(integrals_farthest(&integrals, "both") < 3);
    assert_true(results_number("both/summary.json", "rdf_rmse") < 1.5 * tilt);
}

/// With coarse integrals, which take few samples; whether they are met is no matter here.
static void test_fit_of_integrals_has_the_same_bits_when_it_is_resumed(void **state) {
    static const char *const same[] = {"potential_A-B.tsv", "rdf_A-B.tsv", "history.tsv", NULL};
    static const char *const pieces[] = {"fit",       "coarse.json", "-o", "pieces",
                                         "--threads", "1",           NULL};
    write_run(*state, "coarse.json", "yes", 10 * integrals.error, SHORT_PLAN);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "coarse", "--threads", "2");
    print_message("%s", result.err);
    run_program_in_pieces(result.code, pieces);
    results_assert_same("coarse", "pieces", same);
}

/// a of A-B is 14. Nothing else is fitted, from a = 11. In 24 seeds, of truth and fit, what was
/// found was off by 1.25(18) times its error, so that five errors are a false alarm in thousands.
/// In short with fewer samples, whose errors are larger.
static void test_optimiser_finds_a_repulsion_from_the_integrals_alone(void **state) {
    static const char text[] =
        "{\"seed\": 3, \"scene\": {" SETUP
        ", \"conservative\": {\"A-A\": " SOFT(10) ", \"A-B\": " SOFT(11) ", \"B-B\": " SOFT(
            10) "}},\n"
                "\"unknowns\": {\"numbers\": {\"conservative.A-B.a\": {\"minimum\": 8, "
                "\"maximum\": 20}}},\n"
                "\"method\": {\"name\": \"cma-es\", \"population\": 6, \"rounds\": 6,\n"
                "\"equilibration\": 300, \"samples\": 150, \"every\": 20},\n"
                "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": 200, "
                "\"every\": 20},\n"
                "\"target\": {\"kirkwood_buff\": {\"q_maximum\": 2.2, %s}}}\n";
    char run[4096], members[1024];
    integrals_of_truth(&integrals, 0.015, members, sizeof members);
    snprintf(run, sizeof run, text, members);
    small_inputs_write(*state, "number.json", run, "\"samples\": 150",
                       length_is_long() ? "\"samples\": 150" : "\"samples\": 60");
    RUN_PROGRAM(&result, "fit", "number.json", "-o", "number");
    run_program_assert_code(&result, 0);
    const double a = results_parameter("number/summary.json", "conservative.A-B.a", "value");
    const double error = results_parameter("number/summary.json", "conservative.A-B.a", "error");
    if (!(error > 0 && error < 1 && fabs(a - 14) < 5 * error))
        fail_msg("conservative.A-B.a = %g +- %g, not 14", a, error);
}

/// One line that names file and key. @param[in] members  of the target
static void assert_refused(struct temporary_folder *folder, const char *members,
                           const char *replaced, const char *by, const char *words) {
    char text[4096];
    snprintf(text, sizeof text, "%s, \"kirkwood_buff\": {%s}}}\n", head, members);
    small_inputs_write(folder, "bad.json", text, replaced, by);
    RUN_PROGRAM(&result, "fit", "bad.json", "-o", "bad");
    print_message("%s", result.err);
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "bad.json");
    assert_contains(result.err, words);
}

#define GOOD "\"q_maximum\": 2.2, \"A-B\": {\"value\": 0.1, \"error\": 0.01}"

static void test_fit_refuses_integrals_that_cannot_be_met(void **state) {
    assert_refused(*state, "\"A-C\": {\"value\": 0.1, \"error\": 0.01}", NULL, NULL,
                   "kirkwood_buff.A-C: unknown pair; expected A-A, A-B, B-B");
    assert_refused(*state, "\"A-B\": {\"value\": 0.1}", NULL, NULL, "kirkwood_buff.A-B.error");
    assert_refused(*state, "\"A-B\": {\"value\": 0.1, \"error\": 0}", NULL, NULL,
                   "kirkwood_buff.A-B.error");
    assert_refused(*state, GOOD ", \"B-A\": {\"value\": 0.1, \"error\": 0.01}", NULL, NULL,
                   "kirkwood_buff.B-A: duplicate pair");
    assert_refused(*state, "\"q_maximum\": 2.2", NULL, NULL, "expected pairs of the scene");
    assert_refused(*state, "\"value\": 0.1, \"error\": 0.01", NULL, NULL, "target.kirkwood_buff");
    assert_refused(*state, "\"q_maximum\": 0.9, \"A-B\": {\"value\": 0.1, \"error\": 0.01}", NULL,
                   NULL, "all have one length");
    assert_refused(*state, GOOD, "\"name\": \"imc\"", "\"name\": \"ibi\"",
                   "target.kirkwood_buff: \"ibi\" does not fit it");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_g_alone_leaves_the_integrals_of_a_mixture_off),
        cmocka_unit_test(test_fit_meets_the_integrals_of_a_mixture),
        cmocka_unit_test(test_fit_of_integrals_has_the_same_bits_when_it_is_resumed),
        cmocka_unit_test(test_optimiser_finds_a_repulsion_from_the_integrals_alone),
        cmocka_unit_test(test_fit_refuses_integrals_that_cannot_be_met),
    };
    return cmocka_run_group_tests(tests, enter, small_inputs_leave);
}
