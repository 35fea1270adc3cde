// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mixtures, chains, and constant pressure in LAMMPS (Debian's lmp; skipped where there is none):
// energies and forces of a hundred configurations are ours, and a run has our g(r); at another
// pressure the density is the one that the README tells.
#include "shared/lammps_runs.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct run_program_result result;

static void export_scene(struct temporary_folder *folder, const char *scene) {
    char samples[32];
    lammps_runs_skip_without(NULL);
    snprintf(samples, sizeof samples, "\"samples\": %d", length_is_long() ? 4000 : 400);
    small_inputs_write(folder, "scene.json", scene, "\"samples\": 400", samples);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
}

static void run_lammps(const char *variables) {
    char command[256];
    snprintf(command, sizeof command,
             "cd lammps && lmp -in in.mesofit -var friction langevin -var equilibration 1000 -var "
             "steps %d %s >lmp.out 2>&1",
             length_is_long() ? 40000 : 4000, variables);
    if (system(command) != 0)
        fail_msg("LAMMPS failed: %s", temporary_folder_read("lammps/lmp.out"));
}

/// Statistics alone have 0.005 to 0.012, and in the longer form a third of it.
static void compare_rdf(const char *table, int pair) {
    const double difference = lammps_runs_rdf_difference_of(table, pair, 1);
    print_message("%s: rms of g - ours: %.4f\n", table, difference);
    assert_true(difference < (length_is_long() ? 0.01 : 0.025));
}

/// Soft pairs are parabolas, which the tables have as they are.
static void compare_configurations(void) {
    const struct lammps_runs_apart apart = lammps_runs_compare(100);
    assert_true(apart.energy < 1e-7 && apart.force < 5e-6 * apart.largest_force);
}

static const char mixture[] =
    "{\"seed\": 5, \"box\": [4.5, 4.5, 4.5], \"time_step\": 0.01, \"precision\": \"double\",\n"
    "\"particles\": {\"types\": {\"A\": 120, \"B\": 150}, \"mass\": {\"A\": 1, \"B\": 2}},\n"
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "  \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 35},\n"
    "  \"B-B\": {\"law\": \"soft-repulsion\", \"a\": 20, \"cutoff\": 1.1}},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 100},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 400, \"every\": 10},\n"
    "\"snapshots\": {\"every\": 500, \"formats\": [\"json\"]}}\n";

static void test_mixture_is_ours(void **state) {
    export_scene(*state, mixture);
    compare_configurations();
    run_lammps("");
    compare_rdf("out/rdf_A-A.tsv", 0);
    compare_rdf("out/rdf_A-B.tsv", 1);
    compare_rdf("out/rdf_B-B.tsv", 2);
}

/// Chains with bonds, angles and dihedrals; pairs as far as two bonds are excluded.
static const char chains[] =
    "{\"seed\": 5, \"box\": [4.2, 4.2, 4.2], \"time_step\": 0.01, \"precision\": \"double\",\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 60, \"length\": 0.7}},\n"
    "\"angles\": {\"bend\": {\"law\": \"cosine-squared\", \"k\": 10, \"angle\": 110}},\n"
    "\"dihedrals\": {\"turn\": {\"law\": \"periodic\", \"k\": 1, \"multiplicity\": 3, \"phase\": "
    "0}},\n"
    "\"molecules\": {\"chain\": {\"count\": 50, \"exclude\": 2, \"chain\": {\"beads\": [\"A\", "
    "\"A\", \"A\", "
    "\"A\"],\n"
    "  \"bond\": \"spring\", \"angle\": \"bend\", \"dihedral\": \"turn\"}}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 100},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 400, \"every\": 10},\n"
    "\"snapshots\": {\"every\": 500, \"formats\": [\"json\"]}}\n";

static void test_chains_are_ours(void **state) {
    export_scene(*state, chains);
    compare_configurations();
    run_lammps("");
    compare_rdf("out/rdf.tsv", 0);
}

// Constant pressure -------------------------------------------------------------------------------

static const char fluid[] =
    "{\"seed\": 4, \"box\": [6, 6, 6], \"time_step\": 0.02, \"particles\": {\"count\": 648},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 15}, \"kirkwood_buff\": {},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 100},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 400, \"every\": 10},\n"
    "\"snapshots\": {\"every\": 500, \"formats\": [\"json\"]}}\n";

/// By the README: ρ (1 + κ (P − P_0)). False alarms: 4.5 standard errors, 1e-5; the square of
/// κ (P − P_0), 0.05, is what a straight line leaves.
static void compare_density(double change, double pressure, double error, double kappa) {
    char variables[64];
    double noise;
    snprintf(variables, sizeof variables, "-var pressure %.9g", pressure + change);
    run_lammps(variables);
    const double density = lammps_runs_mean(4, &noise);
    const double expected = 3 * (1 + kappa * change);
    print_message("P %.3f: density %.4f(%.4f), expected %.4f\n", pressure + change, density, noise,
                  expected);
    assert_true(fabs(density - expected) <
                4.5 * hypot(noise, 3 * kappa * error) + 3 * pow(kappa * change, 2));
}

static void test_density_follows_the_pressure(void **state) {
    export_scene(*state, fluid);
    const double pressure = results_number("out/summary.json", "pressure");
    const double error = results_number("out/summary.json", "pressure_error");
    const double kappa = results_number("out/summary.json", "isothermal_compressibility");
    compare_density(0, pressure, error, kappa);
    compare_density(0.05 / kappa, pressure, error, kappa);
    char *readme = temporary_folder_read("lammps/README"), told[64];
    snprintf(told, sizeof told, "kappa = %.3g per", kappa);
    assert_contains(readme, told);
    free(readme);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_mixture_is_ours), TEST(test_chains_are_ours),
                                       TEST(test_density_follows_the_pressure)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
