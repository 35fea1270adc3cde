// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits of molecules by methods that simulate candidates: numbers of laws of bonds and angles, and
// curves of pairs, bonds and angles at once, with errors; the same bits again; and what is refused.
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define MOLECULES                                                                                  \
    "\"molecules\": {\"trimer\": {\"count\": 80, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"  \
    "  \"bond\": \"backbone\", \"angle\": \"bend\"}}}"
#define PAIRS                                                                                      \
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 20},\n"                      \
    "  \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 12},\n"                                       \
    "  \"B-B\": {\"law\": \"soft-repulsion\", \"a\": 25}}"
#define FRICTION "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

/// The truth.
static const char scene[] =
    "{\"seed\": 11, \"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 200, \"length\": 0.6}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 20, \"angle\": 110}},\n" MOLECULES
    ",\n" PAIRS ",\n" FRICTION ",\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 24}, \"bond_lengths\": {\"bins\": 60},\n"
    "\"bond_angles\": {\"bins\": 45},\n"
    "\"measure\": {\"equilibration\": 2000, \"samples\": 400, \"every\": 25}}\n";

#define BOND_LAW "\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.65}"
#define NUMBERS                                                                                    \
    "\"bonds.backbone.k\": {\"minimum\": 50, \"maximum\": 500},\n"                                 \
    "  \"bonds.backbone.length\": {\"minimum\": 0.5, \"maximum\": 0.7},\n"                         \
    "  \"angles.bend.k\": {\"minimum\": 5, \"maximum\": 50},\n"                                    \
    "  \"angles.bend.angle\": {\"minimum\": 90, \"maximum\": 150}"
#define GAUSS_NEWTON "\"name\": \"gauss-newton\""
#define HOW "\"equilibration\": 500, \"samples\": 40, \"every\": 25"
#define COARSELY "\"equilibration\": 100, \"samples\": 10, \"every\": 10"

/// The scene of the fit has other numbers: there it begins.
static const char numbers[] =
    "{\"seed\": 2, \"target\": {\n"
    " \"bond_lengths\": {\"backbone\": {\"file\": \"truth/bond_lengths.tsv\"}},\n"
    " \"bond_angles\": {\"bend\": {\"file\": \"truth/bond_angles.tsv\"}}},\n"
    "\"unknowns\": {\"numbers\": {" NUMBERS "}},\n"
    "\"scene\": {\"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n"
    "\"bonds\": {" BOND_LAW "},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 10, \"angle\": 120}},\n" MOLECULES
    ",\n" PAIRS ",\n" FRICTION "},\n"
    "\"method\": {" GAUSS_NEWTON ", " HOW "},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 500, \"samples\": 100, \"every\": "
    "25}}\n";

static struct run_program_result result;

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    twins_simulate("scene.json", "truth");
    return 0;
}

/// The square of the deviation in errors.
static double deviation(const char *name, double truth, double largest_error) {
    const double value = results_parameter("out/summary.json", name, "value");
    const double error = results_parameter("out/summary.json", name, "error");
    print_message("%s = %g +- %g, truth %g\n", name, value, error, truth);
    assert_true(error > 0 && error < largest_error);
    return pow((value - truth) / error, 2);
}

/// Four numbers at once: 16.25 is the value of chi squared that 3 in 1000 seeds are above, if the
/// errors are honest. A processor with other last bits is another seed.
static void check_numbers(void) {
    const double sum =
        deviation("bonds.backbone.k", 200, 10) + deviation("bonds.backbone.length", 0.6, 0.003) +
        deviation("angles.bend.k", 20, 1.5) + deviation("angles.bend.angle", 110, 0.6);
    print_message("chi squared %.2f of four\n", sum);
    assert_true(sum < 16.25);
}

static void test_fit_finds_numbers_of_bonds_and_angles_of_a_twin(void **state) {
    static const char *const methods[] = {GAUSS_NEWTON, "\"name\": \"cma-es\", \"rounds\": 25"};
    for (size_t k = 0; k < (length_is_long() ? 2 : 1); k++) {
        small_inputs_write(*state, "run.json", numbers, GAUSS_NEWTON, methods[k]);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
        run_program_assert_code(&result, 0);
        check_numbers();
        // No curve was fitted; the distributions are those of the numbers that were found.
        assert_int_equal(access("out/bonds_backbone.tsv", F_OK), -1);
        assert_int_equal(access("out/bond_lengths_backbone.tsv", F_OK), 0);
        assert_true(results_number("out/summary.json", "bond_lengths_rmse") < 0.15);
    }
}

/// The number that comes after a text in a file.
static double number_after(const char *file, const char *words) {
    char *text = temporary_folder_read(file);
    const char *found = strstr(text, words);
    assert_non_null(found);
    const double value = strtod(found + strlen(words), NULL);
    free(text);
    return value;
}

/// An engine gets the numbers that were found; LAMMPS has K = k/2.
static void test_fit_exports_the_bonds_that_it_has_found(void **state) {
    small_inputs_write(*state, "run.json", numbers, GAUSS_NEWTON,
                       GAUSS_NEWTON ", \"iterations\": 2");
    small_inputs_change(*state, "run.json", HOW, COARSELY);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_true(result.code == 0 || result.code == 1);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    assert_close(2 * number_after("lammps/in.mesofit", "bond_coeff 1 "),
                 results_parameter("out/summary.json", "bonds.backbone.k", "value"), 1e-6);
    assert_close(2 * number_after("lammps/in.mesofit", "angle_coeff 1 "),
                 results_parameter("out/summary.json", "angles.bend.k", "value"), 1e-6);
}

static const char *const tables[] = {"history.tsv", "bond_lengths_backbone.tsv",
                                     "bond_angles_bend.tsv", NULL};

/// Threads, an interruption and the written file change no bits.
static void test_fit_finds_numbers_again_with_the_same_bits(void **state) {
    small_inputs_write(*state, "run.json", numbers, GAUSS_NEWTON,
                       GAUSS_NEWTON ", \"iterations\": 4");
    small_inputs_change(*state, "run.json", HOW, COARSELY);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "one", "--threads", "1");
    assert_true(result.code == 0 || result.code == 1);
    RUN_PROGRAM(&result, "fit", "one/used.json", "-o", "two", "--threads", "2");
    assert_true(result.code == 0 || result.code == 1);
    run_program_in_pieces(result.code,
                          (const char *const[]){"fit", "run.json", "-o", "three", NULL});
    results_assert_same("one", "two", tables);
    results_assert_same("one", "three", tables);
}

#define ONE_TYPE                                                                                   \
    "\"molecules\": {\"trimer\": {\"count\": 80, \"chain\": {\"type\": \"A\", \"length\": 3,\n"    \
    "  \"bond\": \"backbone\", \"angle\": \"bend\"}}}"
/// Chains of one type.
static const char plain_scene[] =
    "{\"seed\": 12, \"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 200, \"length\": 0.6}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 20, \"angle\": 110}},\n" ONE_TYPE
    ",\n\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20},\n" FRICTION ",\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 24}, \"bond_lengths\": {\"bins\": 60},\n"
    "\"bond_angles\": {\"bins\": 45},\n"
    "\"measure\": {\"equilibration\": 2000, \"samples\": 400, \"every\": 25}}\n";

/// All potentials of it at once, that of pairs from another one.
static const char curves[] =
    "{\"seed\": 2, \"target\": {\"rdf\": {\"file\": \"truth/rdf.tsv\"},\n"
    " \"bond_lengths\": {\"backbone\": {\"file\": \"truth/bond_lengths.tsv\"}},\n"
    " \"bond_angles\": {\"bend\": {\"file\": \"truth/bond_angles.tsv\"}}},\n"
    "\"unknowns\": {\"potential\": {\"curve\": \"bspline\", \"coefficients\": 4, \"maximum\": 2,\n"
    "  \"base\": \"start\", \"start\": {\"law\": \"soft-repulsion\", \"a\": 17}},\n"
    "  \"bonds\": {\"backbone\": {\"coefficients\": 3}}, \"angles\": {\"bend\": {\"coefficients\": "
    "3}}},\n"
    "\"scene\": {\"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n" ONE_TYPE ",\n" FRICTION "},\n"
    "\"method\": {" GAUSS_NEWTON ", \"reach\": 0.1, " HOW "},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 500, \"samples\": 200, \"every\": "
    "25}}\n";

static int enter_plain(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "scene.json", plain_scene, NULL, NULL);
    twins_simulate("scene.json", "truth");
    return 0;
}

/// A curve with its errors, rows without an error left out.
struct curve_points {
    size_t count;
    double q[200], value[200], error[200];
};

static void read_curve(const char *file, int column, int error_column, struct curve_points *curve) {
    char line[512];
    FILE *stream = fopen(file, "r");
    assert_non_null(stream);
    *curve = (struct curve_points){0};
    while (fgets(line, sizeof line, stream)) {
        double number[4] = {NAN, NAN, NAN, NAN};
        if (line[0] == '#')
            continue;
        sscanf(line, "%lf %lf %lf %lf", number, number + 1, number + 2, number + 3);
        if (!isfinite(number[error_column]))
            continue;
        assert_in_range(curve->count, 0, 199);
        curve->q[curve->count] = number[0];
        curve->value[curve->count] = number[column];
        curve->error[curve->count++] = number[error_column];
    }
    fclose(stream);
}

/// Rms of U less the truth in errors, up to a constant: the few coefficients make neighbours
/// deviate together, so that one coefficient in ten of three errors is a false alarm in 300.
static void check_group(const char *file, double k, double rest, double unit) {
    static struct curve_points curve;
    double sum = 0, weights = 0, squares = 0;
    read_curve(file, 1, 2, &curve);
    for (int pass = 0; pass < 2; pass++)
        for (size_t n = 0; n < curve.count; n++) {
            const double x = unit * (curve.q[n] - rest), weight = pow(curve.error[n], -2);
            const double off = curve.value[n] - 0.5 * k * x * x;
            sum += pass ? 0 : weight * off;
            weights += pass ? 0 : weight;
            squares += pass ? weight * pow(off - sum / weights, 2) : 0;
        }
    const double deviation = sqrt(squares / (double)curve.count);
    print_message("%s: %zu points, %.2f errors off\n", file, curve.count, deviation);
    assert_true(curve.count > 15);
    assert_true(deviation > 0.2 && deviation < 3);
}

/// Up to the ramp, which g(r) hardly tells.
static void check_pairs(void) {
    static struct curve_points curve;
    double above = 0, below = 0, squares = 0;
    read_curve("out/potential.tsv", 1, 3, &curve);
    for (int pass = 0; pass < 2; pass++)
        for (size_t n = 0; n < curve.count; n++) {
            const double r = curve.q[n], ramp = 1 - r / 1.2;
            const double off = curve.value[n] - (r < 1 ? 10 * (1 - r) * (1 - r) : 0);
            if (r < 0.3)
                continue;
            above += pass ? 0 : ramp * off;
            below += pass ? 0 : ramp * ramp;
            squares += pass ? pow(off - above / below * ramp, 2) : 0;
        }
    print_message("pairs: rms %.3f beside a ramp of %.3f\n", sqrt(squares / 18), above / below);
    assert_true(sqrt(squares / 18) < 0.15);
}

static void test_fit_finds_pairs_bonds_and_angles_of_a_twin(void **state) {
    small_inputs_write(*state, "run.json", curves, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    check_group("out/bonds_backbone.tsv", 200, 0.6, 1);
    check_group("out/angles_bend.tsv", 20, 110, M_PI / 180);
    check_pairs();
    assert_true(results_number("out/summary.json", "bond_lengths_rmse") <
                3 * results_number("out/summary.json", "bond_lengths_noise"));
}

/// Optimisers move the same curves, and pareto. So few candidates need not come closer.
static void test_fit_by_optimisers_moves_curves_of_groups(void **state) {
    static const char *const methods[] = {
        "\"name\": \"cma-es\", \"rounds\": 2",
        "\"name\": \"genetic\", \"population\": 8, \"generations\": 2",
        "\"name\": \"nlopt\", \"evaluations\": 8",
        "\"name\": \"pareto\", \"population\": 8, \"generations\": 1",
    };
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        small_inputs_write(*state, "run.json", curves, GAUSS_NEWTON ", \"reach\": 0.1", methods[k]);
        small_inputs_change(*state, "run.json", HOW, COARSELY);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
        assert_true(result.code == 0 || result.code == 1);
        assert_int_equal(access("out/bonds_backbone.tsv", F_OK), 0);
        const double rmse = results_number("out/summary.json", "bond_lengths_rmse");
        print_message("%s: rms of bond lengths %.3f\n", methods[k], rmse);
        assert_true(rmse < 1.5);
        char *individuals = k < 3 ? temporary_folder_read("out/individuals.tsv") : NULL;
        if (individuals)
            assert_contains(individuals, "angles_bend(3)");
        free(individuals);
    }
}

static const char *const curve_tables[] = {"history.tsv",
                                           "potential.tsv",
                                           "bonds_backbone.tsv",
                                           "angles_bend.tsv",
                                           "bonds_backbone_history.tsv",
                                           NULL};

static void test_fit_of_curves_again_with_the_same_bits(void **state) {
    small_inputs_write(*state, "run.json", curves, GAUSS_NEWTON,
                       GAUSS_NEWTON ", \"iterations\": 2");
    small_inputs_change(*state, "run.json", HOW, COARSELY);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "one", "--threads", "1");
    assert_true(result.code == 0 || result.code == 1);
    RUN_PROGRAM(&result, "fit", "one/used.json", "-o", "two", "--threads", "2");
    assert_true(result.code == 0 || result.code == 1);
    run_program_in_pieces(result.code,
                          (const char *const[]){"fit", "run.json", "-o", "three", NULL});
    results_assert_same("one", "two", curve_tables);
    results_assert_same("one", "three", curve_tables);
}

static void test_fit_of_curves_refuses_the_hypernetted_chain(void **state) {
    small_inputs_write(*state, "run.json", curves, "\"base\": \"start\"",
                       "\"base\": \"hypernetted-chain\"");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_contains(result.err,
                    "unknowns.potential.base: the hypernetted chain is not for molecules");
}

struct wrong {
    const char *from, *to, *words[3];
};

static void test_fit_refuses_numbers_that_cannot_be(void **state) {
    static const struct wrong wrong[] = {
        {"\"angles.bend.angle\"",
         "\"angles.bend.angel\"",
         {"unknowns.numbers.angles.bend.angel", "angles.bend.angle", NULL}},
        {"\"minimum\": 0.5, \"maximum\": 0.7",
         "\"minimum\": 0.5, \"maximum\": 2.5",
         {"with bonds.backbone.length = 2.5", "not shorter than half of the box", NULL}},
        {BOND_LAW, "", {"bonds.backbone.k", "unknown curve itself", NULL}},
        {GAUSS_NEWTON, "\"name\": \"imc\"", {"\"imc\" does not find numbers", NULL}},
        {GAUSS_NEWTON,
         "\"name\": \"formulas\"",
         {"method.name: \"formulas\" does not fit molecules", NULL}},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        small_inputs_write(*state, "run.json", numbers, wrong[k].from, wrong[k].to);
        if (k >= 3) {
            char *text = temporary_folder_read("run.json");
            small_inputs_write(*state, "run.json", text, ", " HOW, "");
            free(text);
        }
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
        run_program_assert_code(&result, 2);
        for (size_t w = 0; wrong[k].words[w]; w++)
            assert_contains(result.err, wrong[k].words[w]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_fit_finds_numbers_of_bonds_and_angles_of_a_twin, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_exports_the_bonds_that_it_has_found, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_finds_numbers_again_with_the_same_bits, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_finds_pairs_bonds_and_angles_of_a_twin,
                                        enter_plain, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_by_optimisers_moves_curves_of_groups, enter_plain,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_of_curves_again_with_the_same_bits, enter_plain,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_of_curves_refuses_the_hypernetted_chain,
                                        enter_plain, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_refuses_numbers_that_cannot_be, enter,
                                        small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
