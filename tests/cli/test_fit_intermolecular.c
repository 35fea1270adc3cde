// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of g(r) between molecules: a number that is found from it alone, the same bits
// again, its comparison with what an inversion finds from all pairs, and what is refused.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// The pair of bonded beads is seen, or all pairs of a molecule are excluded.
#define SEEN "\"exclude\": 0"
#define EXCLUDED "\"exclude\": 2"
#define TRIMERS                                                                                    \
    "\"box\": [4.4, 4.4, 4.4], \"time_step\": 0.01,\n"                                             \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n" MOLECULES
#define MOLECULES                                                                                  \
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.6}},\n"           \
    "\"molecules\": {\"trimer\": {\"count\": 80, " SEEN ",\n"                                      \
    "  \"chain\": {\"type\": \"A\", \"length\": 3, \"bond\": \"backbone\"}}}"
#define REPULSION(a) "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": " a "}"

static const char twin[] =
    "{\"seed\": 61, " TRIMERS
    ", " REPULSION("25") ",\n"
                         "\"rdf\": {\"range\": 1, \"bins\": 20}, \"intermolecular_rdf\": "
                         "{\"range\": 1, \"bins\": 20},\n"
                         "\"bond_lengths\": {}, \"measure\": {\"equilibration\": 1000, "
                         "\"samples\": 500, \"every\": 25}}\n";

#define RDF "\"rdf\": {\"file\": \"twin/rdf.tsv\"}"
#define APART "\"intermolecular_rdf\": {\"file\": \"twin/intermolecular_rdf.tsv\"}"
#define COMPARED                                                                                   \
    "\"intermolecular_rdf\": {\"file\": \"twin/intermolecular_rdf.tsv\", \"fitted\": \"no\"}"
#define METHOD                                                                                     \
    "\"name\": \"gauss-newton\", \"iterations\": 12, \"equilibration\": 300, \"samples\": 60,\n"   \
    "  \"every\": 25, \"temperature_tolerance\": 0.5"
#define UNKNOWN                                                                                    \
    "\"unknowns\": {\"numbers\": {\"conservative.a\": {\"minimum\": 5, \"maximum\": 60}}}"

/// The scene says a = 40: there the fit begins.
static const char fit[] =
    "{\"seed\": 3, \"target\": {" APART "}, " UNKNOWN ",\n"
    "\"scene\": {" TRIMERS
    ", " REPULSION("40") "},\n"
                         "\"method\": {" METHOD "},\n"
                         "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": "
                         "60, \"every\": 25}}\n";

/// What an inversion wants instead.
#define POTENTIAL "\"unknowns\": {\"potential\": {}}"
#define INVERSION(name)                                                                            \
    "\"name\": \"" name "\", \"replicas\": 2, \"equilibration\": 40, \"samples\": 40,\n"           \
    "  \"iterations\": 3, \"precision\": 0.02"

static struct run_program_result result;

static void simulate(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "twin.json", twin, from, to);
    twins_simulate("twin.json", "twin");
}

/// Write run.json with pairs of texts replaced, the last followed by NULL.
static void write_fit(struct temporary_folder *folder, const char *const replaced[]) {
    small_inputs_write(folder, "run.json", fit, NULL, NULL);
    for (size_t k = 0; replaced[k]; k += 2) {
        char *text = temporary_folder_read("run.json");
        small_inputs_write(folder, "run.json", text, replaced[k], replaced[k + 1]);
        free(text);
    }
}

/// A number of a table, in row `row` from 0.
static double cell(const char *file, size_t row, const char *name) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, file, 2));
    const size_t column = mf_data_table_find(&table, name);
    assert_in_range(column, 1, table.columns);
    assert_in_range(row, 0, table.rows - 1);
    const double value = table.values[row * table.columns + column - 1];
    mf_data_table_clear(&table);
    return value;
}

/// False alarms: 3 in 1000 for another seed, if the errors are honest.
static void test_fit_finds_a_repulsion_from_the_structure_between_molecules_alone(void **state) {
    enum { BOND = 11 }; // bin of the length of the bonds
    simulate(*state, NULL, NULL);
    write_fit(*state, (const char *const[]){NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    const double a = results_parameter("out/summary.json", "conservative.a", "value");
    const double error = results_parameter("out/summary.json", "conservative.a", "error");
    if (!(error > 0 && error < 1.5 && fabs(a - 25) < 3 * error))
        fail_msg("conservative.a = %g +- %g, not 25", a, error);
    assert_true(results_number("out/summary.json", "intermolecular_rdf_rmse") <
                2 * results_number("out/summary.json", "intermolecular_rdf_noise"));
    // Without the pairs of one molecule.
    assert_true(cell("out/intermolecular_rdf.tsv", BOND, "target") <
                0.8 * cell("twin/rdf.tsv", BOND, "g"));
    assert_true(cell("out/intermolecular_rdf.tsv", BOND, "result") <
                0.8 * cell("twin/rdf.tsv", BOND, "g"));
}

static void test_fit_of_structure_between_molecules_has_the_same_bits_again(void **state) {
    static const char *const same[] = {"numbers_history.tsv", "history.tsv",
                                       "intermolecular_rdf.tsv", NULL};
    static const char *const pieces[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    simulate(*state, NULL, NULL);
    write_fit(*state, (const char *const[]){
                          "\"iterations\": 12, \"equilibration\": 300, \"samples\": 60",
                          "\"iterations\": 2, \"equilibration\": 100, \"samples\": 15", NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--threads", "1");
    const int code = result.code;
    assert_true(code == 0 || code == 1);
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, code);
    run_program_in_pieces(code, pieces);
    results_assert_same("out", "again", same);
    results_assert_same("out", "pieces", same);
}

/// Where molecules exclude all their own pairs, pairs of different molecules are all that there
/// are. At the edge of a bin the two counts may see a pair on either side of it.
static void test_inversion_compares_the_structure_between_molecules(void **state) {
    static const double few_pairs = 3e-4;
    simulate(*state, SEEN, EXCLUDED);
    write_fit(*state,
              (const char *const[]){APART, RDF ", " COMPARED, SEEN, EXCLUDED, UNKNOWN, POTENTIAL,
                                    ", " REPULSION("40"), "", METHOD, INVERSION("imc"), NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_true(result.code == 0 || result.code == 1);
    assert_contains(result.err, "intermolecular_rdf");
    for (size_t row = 0; row < 20; row++) {
        assert_close(cell("out/intermolecular_rdf.tsv", row, "target"),
                     cell("out/rdf.tsv", row, "target"), few_pairs);
        assert_close(cell("out/intermolecular_rdf.tsv", row, "result"),
                     cell("out/rdf.tsv", row, "result"), few_pairs);
    }
}

static void assert_refused(struct temporary_folder *folder, const char *const replaced[],
                           const char *words) {
    write_fit(folder, replaced);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "bad");
    run_program_assert_code(&result, 2);
    assert_int_equal(run_program_lines(result.err), 1);
    assert_contains(result.err, "intermolecular_rdf");
    assert_contains(result.err, words);
    assert_int_equal(access("bad", F_OK), -1);
}

static void test_inversions_refuse_to_fit_the_structure_between_molecules(void **state) {
    static const char *const methods[] = {INVERSION("imc"), INVERSION("ibi"), INVERSION("auto")};
    simulate(*state, NULL, NULL);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
        assert_refused(*state,
                       (const char *const[]){APART, RDF ", " APART, UNKNOWN, POTENTIAL,
                                             ", " REPULSION("40"), "", METHOD, methods[k], NULL},
                       "it is the same as rdf: give the file as \"rdf\"");
}

static void test_fit_refuses_structure_between_molecules_where_there_are_none(void **state) {
    simulate(*state, NULL, NULL);
    assert_refused(*state,
                   (const char *const[]){MOLECULES, "\"particles\": {\"count\": 240}", NULL},
                   "run.json: scene: intermolecular_rdf: the scene has no molecules");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_fit_finds_a_repulsion_from_the_structure_between_molecules_alone),
        TEST(test_fit_of_structure_between_molecules_has_the_same_bits_again),
        TEST(test_inversion_compares_the_structure_between_molecules),
        TEST(test_inversions_refuse_to_fit_the_structure_between_molecules),
        TEST(test_fit_refuses_structure_between_molecules_where_there_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
