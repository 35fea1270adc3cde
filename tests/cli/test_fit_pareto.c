// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of potential and friction weight by the method "pareto": the same bits for any
// threads and after any interruption, and the front that it leaves.
#include "io/data_table.h"
#include "optimise/nsga2.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

/// A soft fluid whose escape times and g(r) are the targets.
static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 60, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2},\n"
    "\"rdf\": {\"range\": 1, \"bins\": 20}}\n";

#define ETD                                                                                        \
    "\"etd\": {\"file\": \"target/etd.tsv\", \"error_file\": \"target/etd_error.tsv\", "           \
    "\"r_minimum\": 0.4, \"r_maximum\": 0.9}, "

static const char fit[] =
    "{\"seed\": 3, \"target\": {" ETD "\"rdf\": {\"file\": \"target/rdf.tsv\"}},\n"
    "\"unknowns\": {\"omega\": {\"coefficients\": 4, \"maximum\": 6},\n"
    "\"potential\": {\"coefficients\": 5, \"maximum\": 30}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02},\n"
    "\"method\": {\"name\": \"pareto\", \"population\": 9, \"generations\": 4, \"warm_start\": "
    "\"yes\",\n"
    "\"equilibration\": 10, \"samples\": 4, \"every\": 8, \"temperature_tolerance\": 0.5},\n"
    "\"core\": {\"threshold\": 0.05, \"stiffness\": 50},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n";

static const char *const tables[] = {"history.tsv",        "omega.tsv",
                                     "potential.tsv",      "pareto.tsv",
                                     "pareto_history.tsv", "pareto_potential.tsv",
                                     "pareto_omega.tsv",   NULL};

static void write_fit(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", fit, from, to);
}

static void run_fit(const char *file, const char *out, const char *threads) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "fit", file, "-o", out, "--threads", threads, "--quiet");
    run_program_assert_code(&result, 0);
}

static void test_pareto_gives_the_same_bits_for_any_threads_and_in_pieces(void **state) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    write_fit(*state, NULL, NULL);
    run_fit("run.json", "1", "1");
    run_fit("run.json", "2", "2");
    results_assert_same("1", "2", tables);
    run_fit("1/used.json", "again", "1");
    results_assert_same("1", "again", tables);
    run_program_in_pieces(0, words);
    results_assert_same("1", "pieces", tables);
}

/// Columns of pareto.tsv.
enum { MEMBER, RANK, CHOSEN, MEASURED, ERROR, DISTANCES, COLUMNS = DISTANCES + 4 };

/// Nobody dominates a member of the front, and the chosen one is a member that was measured again.
static void test_pareto_leaves_a_front_that_nobody_dominates(void **state) {
    struct data_table table;
    size_t members = 0, chosen = 0;
    write_fit(*state, NULL, NULL);
    run_fit("run.json", "out", "2");
    assert_ok(mf_data_table_read(&table, "out/pareto.tsv", COLUMNS));
    assert_int_equal(table.columns, COLUMNS);
    assert_int_equal(table.rows, 9);
    for (size_t a = 0; a < table.rows; a++) {
        const double *one = table.values + a * COLUMNS;
        assert_true(one[MEMBER] == (double)a + 1);
        members += one[RANK] == 1;
        if (one[CHOSEN] == 1) {
            chosen++;
            assert_true(one[RANK] == 1 && one[MEASURED] >= 3);
        }
        for (size_t b = 0; b < table.rows && one[RANK] == 1; b++)
            assert_false(
                mf_nsga2_dominates(table.values + b * COLUMNS + DISTANCES, one + DISTANCES, 2));
    }
    assert_int_equal(chosen, 1);
    assert_true(members >= 1);
    results_assert_table("out/pareto_potential.tsv", members + 1, 21);
    results_assert_table("out/pareto_omega.tsv", members + 1, 201);
    results_assert_table("out/pareto_history.tsv", 5, 0);
    mf_data_table_clear(&table);
}

static void test_pareto_wants_two_targets(void **state) {
    static struct run_program_result result;
    write_fit(*state, ETD, "");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "needs two fitted targets");
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_pareto_gives_the_same_bits_for_any_threads_and_in_pieces),
        TEST_WITHOUT_FIGURES(test_pareto_leaves_a_front_that_nobody_dominates),
        TEST_WITHOUT_FIGURES(test_pareto_wants_two_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
