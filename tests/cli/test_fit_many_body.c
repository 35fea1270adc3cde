// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` with energies of local densities: numbers of f of a twin found again, the potential
// of its pairs beside f, and what is refused.
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

static struct run_program_result result;

#define FLUID                                                                                      \
    "\"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 100}, \"time_step\": 0.02,\n"         \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 4.5},\n"
#define PAIRS "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
#define WEIGHT "\"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": 0.5, \"cutoff\": 1.2}"
#define ENERGY(c1, c2)                                                                             \
    "\"energy\": {\"law\": \"polynomial\", \"c1\": " c1 ", \"c2\": " c2 ", \"origin\": 2.4}"
#define DENSITIES(c1, c2) "\"many_body\": {\"crowd\": {" WEIGHT ",\n" ENERGY(c1, c2) "}}"

/// The twin, at a density of 1 with 2.2 neighbours by the weight: f costs beads that have fewer or
/// more.
static const char twin[] = "{\"seed\": 51, " FLUID PAIRS DENSITIES(
    "0.5", "1") ",\n"
                "\"measure\": {\"equilibration\": 2000, \"samples\": 3000, \"every\": 10},\n"
                "\"rdf\": {\"range\": 1.5, \"bins\": 30}}\n";

#define C1 "\"many_body.crowd.energy.c1\": {\"minimum\": -0.5, \"maximum\": 1.5}"
#define C2 "\"many_body.crowd.energy.c2\": {\"minimum\": 0.2, \"maximum\": 1.8}"
#define NUMBERS "\"numbers\": {" C1 ", " C2 "}"
#define GAUSS_NEWTON                                                                               \
    "{\"name\": \"gauss-newton\", \"iterations\": 14, \"equilibration\": 800, \"samples\": 200,\n" \
    "\"every\": 10, \"temperature_tolerance\": 0.5}"
#define IMC "{\"name\": \"imc\", \"precision\": 0.006}"
#define POTENTIAL "\"potential\": {\"truth\": {\"law\": \"soft-repulsion\", \"a\": 25}}"

/// Simulate the twin, and write a fit to its g(r) and pressure.
static void write_fit(struct temporary_folder *folder, const char *unknowns, const char *scene,
                      const char *method) {
    char text[4096];
    small_inputs_write(folder, "scene.json", twin, NULL, NULL);
    twins_simulate("scene.json", "target");
    snprintf(text, sizeof text,
             "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}, \"pressure\": "
             "{\"value\": %.8g, \"error\": %.8g}},\n\"unknowns\": {%s},\n\"scene\": {" FLUID
             "%s},\n\"method\": %s,\n\"verification\": {\"replicas\": 2, \"equilibration\": 500, "
             "\"samples\": 200, \"every\": 10}}\n",
             results_number("target/summary.json", "pressure"),
             results_number("target/summary.json", "pressure_error"), unknowns, scene, method);
    small_inputs_write(folder, "run.json", text, NULL, NULL);
}

static void run_fit(void) {
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
}

/// False alarms: 3 in 1000 for another seed, if the errors are honest.
static void assert_found(const char *name, double truth, double largest_error) {
    const double value = results_parameter("out/summary.json", name, "value");
    const double error = results_parameter("out/summary.json", name, "error");
    print_message("%s: %.3f(%.3f)\n", name, value, error);
    if (!(error > 0 && error < largest_error) || !(fabs(value - truth) < 3 * error))
        fail_msg("%s = %g +- %g, not %g", name, value, error, truth);
}

/// What is exported is the energy that was found: the polynomial at the second row and at the last.
static void assert_exported(void) {
    const double c1 = results_parameter("out/summary.json", "many_body.crowd.energy.c1", "value");
    const double c2 = results_parameter("out/summary.json", "many_body.crowd.energy.c2", "value");
    double step, f;
    int rows;
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("lammps/crowd.eam.fs");
    FILE *stream = fmemopen(text, strlen(text), "r");
    assert_non_null(stream);
    assert_int_equal(
        fscanf(stream, "#%*[^\n]\n#%*[^\n]\n#%*[^\n]\n1 T1 %d %lf %*d %*f %*f %*d %*f %*d none",
               &rows, &step),
        2);
    for (int k = 0; k < rows; k++) {
        assert_int_equal(fscanf(stream, "%lf", &f), 1);
        const double x = step * k;
        if (k == 1 || k == rows - 1)
            assert_close_relative(f, c1 * x + c2 * x * (x - 2 * 2.4), 1e-6);
    }
    fclose(stream);
    free(text);
}

static void test_fit_finds_an_energy_of_the_density(void **state) {
    write_fit(*state, NUMBERS, PAIRS DENSITIES("0.1", "0.6"), GAUSS_NEWTON);
    run_fit();
    assert_found("many_body.crowd.energy.c1", 0.5, 0.2);
    assert_found("many_body.crowd.energy.c2", 1, 0.4);
    assert_exported();
}

/// With f the potential of the twin's pairs is found; without it another one meets the same g(r),
/// by far another one.
static void test_inversions_find_the_potential_beside_an_energy_of_the_density(void **state) {
    double rms[2];
    for (int has_energy = 1; has_energy >= 0; has_energy--) {
        write_fit(*state, POTENTIAL, has_energy ? DENSITIES("0.5", "1") : DENSITIES("0", "0"), IMC);
        run_fit();
        double sum = 0, count = 0, row[6];
        FILE *file = fopen("out/potential.tsv", "r");
        assert_non_null(file);
        for (char line[512]; fgets(line, sizeof line, file);)
            if (sscanf(line, "%lf %lf %lf %lf %lf %lf", &row[0], &row[1], &row[2], &row[3], &row[4],
                       &row[5]) == 6 &&
                row[0] > 0.5) {
                sum += pow(row[1] - row[5], 2);
                count++;
            }
        fclose(file);
        rms[has_energy] = sqrt(sum / count);
    }
    print_message("rms of the potential from the truth beyond 0.5: %.3f, without f %.3f\n", rms[1],
                  rms[0]);
    assert_true(rms[1] < 0.1);
    assert_true(rms[0] > 5 * rms[1]);
}

static void assert_refused(const char *words) {
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_refused(&result, "refused", words, 1, (const char *const[]){words, NULL});
}

static void test_what_cannot_be_found_is_refused(void **state) {
    write_fit(*state, POTENTIAL, DENSITIES("0.5", "1"),
              "{\"name\": \"imc\", \"sampler\": \"monte-carlo\"}");
    assert_refused("method.sampler: \"monte-carlo\" moves beads by energies of pairs");
    write_fit(*state, "\"potential\": {}, " NUMBERS, DENSITIES("0.5", "1"), GAUSS_NEWTON);
    assert_refused("many_body.crowd.energy.c1: it cannot be found: it is a potential of pairs, 2 "
                   "c1 w(r), and so a part of the unknown potential");
    write_fit(
        *state,
        "\"numbers\": {\"many_body.crowd.weight.cutoff\": {\"minimum\": 0.4, \"maximum\": 2}}",
        PAIRS DENSITIES("0.5", "1"), GAUSS_NEWTON);
    assert_refused("many_body.crowd.weight.cutoff: at ends of the ranges the inner_cutoff 0.5 is "
                   "not below the cutoff 0.4");
}

#define CASE(test) cmocka_unit_test_setup_teardown(test, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        CASE(test_fit_finds_an_energy_of_the_density),
        CASE(test_inversions_find_the_potential_beside_an_energy_of_the_density),
        CASE(test_what_cannot_be_found_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
