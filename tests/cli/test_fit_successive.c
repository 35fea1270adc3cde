// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` by the method "successive": the potential is that of "auto" alone, ω meets the
// escape times with it, and a fit in pieces has the same bits as one in one.
#include "io/data_table.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>

/// A soft fluid whose g(r) and escape times are the targets.
static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 5},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 400, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2},\n"
    "\"rdf\": {\"range\": 1, \"bins\": 20}}\n";

static const char both[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}, \"etd\": {\"file\": "
    "\"target/etd.tsv\", \"error_file\": \"target/etd_error.tsv\"}},\n"
    "\"unknowns\": {\"potential\": {}, \"omega\": {\"curve\": \"bspline\", \"coefficients\": 4, "
    "\"maximum\": 10, \"start\": {\"law\": \"power\", \"sigma\": 1}}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02},\n"
    "\"method\": {\"name\": \"successive\", \"potential_precision\": 0.02, \"equilibration\": 50, "
    "\"samples\": 60, \"every\": 5, \"temperature_tolerance\": 0.5, \"warm_start\": \"yes\"},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 100, \"samples\": 100, \"every\": "
    "10}}\n";

static const char potential_alone[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02, "
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"
    "\"method\": {\"name\": \"auto\", \"precision\": 0.02},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n";

static const char *const tables[] = {"history.tsv", "potential.tsv", "omega.tsv",
                                     "omega_history.tsv", NULL};

static struct run_program_result result;

static void write_fit(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", both, from, to);
}

/// Exit code 1 is that of a fit that has not converged: its bits are the same all the same.
static void run_fit(const char *file, const char *out, const char *threads) {
    RUN_PROGRAM(&result, "fit", file, "-o", out, "--threads", threads, "--quiet");
    assert_in_range(result.code, 0, 1);
}

static void test_successive_gives_the_same_bits_for_any_threads_and_in_pieces(void **state) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    write_fit(*state, NULL, NULL);
    run_fit("run.json", "1", "1");
    const int code = result.code;
    run_fit("1/used.json", "again", "2");
    results_assert_same("1", "again", tables);
    run_program_in_pieces(code, words);
    results_assert_same("1", "pieces", tables);
}

/// rms difference of a column in two tables.
static double mean_difference(const char *one, const char *other, size_t column) {
    struct data_table a, b;
    double squares = 0;
    assert_ok(mf_data_table_read(&a, one, column + 1));
    assert_ok(mf_data_table_read(&b, other, column + 1));
    assert_int_equal(a.rows, b.rows);
    for (size_t k = 0; k < a.rows; k++)
        squares += pow(a.values[k * a.columns + column] - b.values[k * b.columns + column], 2);
    const double rms = sqrt(squares / (double)a.rows);
    mf_data_table_clear(&a);
    mf_data_table_clear(&b);
    return rms;
}

/// The rms of E − E* of the true ω is that of two measurements of this length, 0.02; that of the
/// start, a fifth of the true one, was measured as 0.09.
static void test_successive_finds_the_potential_of_auto_and_omega_with_it(void **state) {
    write_fit(*state, NULL, NULL);
    run_fit("run.json", "both", "2");
    small_inputs_write(*state, "alone.json", potential_alone, NULL, NULL);
    run_fit("alone.json", "alone", "2");
    assert_true(mean_difference("both/potential.tsv", "alone/potential.tsv", 1) == 0);
    const double rms = results_number("both/summary.json", "etd_rmse");
    print_message("rms of E: %.4f\n", rms);
    assert_true(rms < 0.04);
}

static void test_successive_is_refused_where_nothing_moves(void **state) {
    write_fit(*state, "\"error_file\"", "\"fitted\": \"no\", \"error_file\"");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "finds omega from a target of motion");
    write_fit(*state, "\"potential\": {}, ", "");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_successive_gives_the_same_bits_for_any_threads_and_in_pieces),
        TEST_WITHOUT_FIGURES(test_successive_finds_the_potential_of_auto_and_omega_with_it),
        TEST_WITHOUT_FIGURES(test_successive_is_refused_where_nothing_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
