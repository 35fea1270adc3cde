// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is exported, run by LAMMPS (Debian's lmp; skipped where there is none): water with the
// shipped potential has the g(r), temperature and pressure of our own simulation.
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void skip_without_lammps(void) {
    if (system("command -v lmp >/dev/null") == 0)
        return;
    print_message("lmp is not installed: LAMMPS is not run\n");
    skip();
}

/// The scene of runs/spc-water-imc with the potential that it found, and a finer step.
static void write_scene(struct temporary_folder *folder) {
    char text[4096];
    const char *const measure = length_is_long()
                                    ? "\"equilibration\": 2500, \"samples\": 200, \"every\": 50"
                                    : "\"equilibration\": 1000, \"samples\": 50, \"every\": 25";
    snprintf(text, sizeof text,
             "{\"seed\": 3, \"box\": [9.428, 9.428, 9.428], \"particles\": {\"count\": 2744},\n"
             "\"time_step\": 0.002, \"conservative\": {\"law\": \"table\", \"file\": "
             "\"%s/targets/spc-water/potential_imc.tsv\"},\n"
             "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.589, \"inner_cutoff\": 0.596, "
             "\"cutoff\": 1.72},\n"
             "\"units\": {\"length\": 0.465, \"temperature\": 298, \"mass\": 2.992e-26},\n"
             "\"rdf\": {\"range\": 2.15, \"bins\": 100},\n"
             "\"measure\": {%s},\n"
             "\"snapshots\": {\"every\": 10000, \"formats\": [\"json\"]}}\n",
             run_program_sources(), measure);
    small_inputs_write(folder, "scene.json", text, NULL, NULL);
}

/// The last rows of rdf.dat, "bin r g coordination", beside ours.
static double rdf_difference(const char *ours, const char *theirs) {
    FILE *first = fopen(ours, "r"), *second = fopen(theirs, "r");
    char line[512], other[512];
    double squares = 0;
    int rows = 0;
    assert_true(first && second);
    for (int k = 0; k < 4; k++) // three comments and the step
        assert_non_null(fgets(other, sizeof other, second));
    while (fgets(line, sizeof line, first)) {
        double r, g, their_r, their_g;
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lf %lf", &r, &g), 2);
        assert_non_null(fgets(other, sizeof other, second));
        assert_int_equal(sscanf(other, "%*d %lf %lf", &their_r, &their_g), 2);
        assert_true(fabs(their_r - 4.65 * r) < 1e-5); // the same bins, in A
        squares += (g - their_g) * (g - their_g);
        rows++;
    }
    fclose(first);
    fclose(second);
    assert_int_equal(rows, 100);
    return sqrt(squares / rows);
}

/// Mean of a column of thermo.dat, and its error by twenty blocks.
static double mean_of(const char *file, int column, double *error) {
    enum { BLOCKS = 20 };
    static double values[100000];
    FILE *stream = fopen(file, "r");
    char line[512];
    int rows = 0;
    double sum = 0, squares = 0;
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream)) {
        double v[4];
        if (line[0] != '#' && sscanf(line, "%lf %lf %lf %lf", &v[0], &v[1], &v[2], &v[3]) == 4)
            values[rows++] = v[column];
    }
    fclose(stream);
    for (int b = 0; b < BLOCKS; b++) {
        double block = 0;
        for (int k = 0; k < rows / BLOCKS; k++)
            block += values[b * (rows / BLOCKS) + k];
        block /= rows / BLOCKS;
        sum += block;
        squares += block * block;
    }
    sum /= BLOCKS;
    *error = sqrt((squares / BLOCKS - sum * sum) / (BLOCKS - 1));
    return sum;
}

/// False alarms: T and P 4.5 standard errors each, 1e-5; g, which statistics alone would have
/// 0.0024 apart, is asked for by what the export promises; in short statistics have 0.007.
static void test_lammps_has_our_water(void **state) {
    static struct run_program_result result;
    skip_without_lammps();
    write_scene(*state);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    assert_int_equal(system(length_is_long()
                                ? "cd lammps && lmp -in in.mesofit >lmp.out 2>&1"
                                : "cd lammps && lmp -in in.mesofit -var equilibration 500 "
                                  "-var steps 2000 >lmp.out 2>&1"),
                     0);
    const double difference = rdf_difference("out/rdf.tsv", "lammps/rdf.dat");
    double error;
    const double temperature = mean_of("lammps/thermo.dat", 1, &error);
    print_message("rms of g - ours: %.4f; T %.2f(%.2f) K\n", difference, temperature, error);
    assert_true(difference < (length_is_long() ? 0.004 : 0.014));
    assert_true(fabs(temperature - 298) < 4.5 * error + 0.001 * 298);
    const double pressure = mean_of("lammps/thermo.dat", 2, &error);
    const double unit = results_number("out/summary.json", "physical.pressure_bar") /
                        results_number("out/summary.json", "pressure") / 1.01325;
    const double ours = unit * results_number("out/summary.json", "pressure");
    const double our_error = unit * results_number("out/summary.json", "pressure_error");
    print_message("P %.0f(%.0f) atm, ours %.0f(%.0f)\n", pressure, error, ours, our_error);
    assert_true(fabs(pressure - ours) < 4.5 * hypot(error, our_error));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_lammps_has_our_water)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
