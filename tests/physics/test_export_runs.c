// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is exported, run as its README says: OpenMM where it is installed, LAMMPS and GROMACS for
// ENGINES=1. LAMMPS, Debian's lmp: energies and forces of a hundred configurations of mixtures and
// chains are ours, a run has our g(r), and at another pressure the density that the README tells.
// OpenMM: mixtures; GROMACS: chains without pairs, of which it has no tables; both have our g(r).
#include "shared/lammps_runs.h"
#include "shared/length.h"
#include "shared/other_engine.h"
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
    "{\"seed\": 5, \"box\": [4.1, 4.1, 4.1], \"time_step\": 0.01, \"precision\": \"double\",\n"
    "\"particles\": {\"types\": {\"A\": 90, \"B\": 115}, \"mass\": {\"A\": 1, \"B\": 2}},\n"
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

// By `measure` ------------------------------------------------------------------------------------

static void export_in_nm(struct temporary_folder *folder, const char *scene, const char *from,
                         const char *to, const char *engine) {
    small_inputs_write(folder, "scene.json", scene, "\"precision\": \"double\",",
                       "\"units\": {\"length\": 0.5, \"temperature\": 300, \"mass\": 5e-26},");
    small_inputs_change(folder, "scene.json", from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "-o", engine);
    run_program_assert_code(&result, 0);
}

/// Of a hundred bins of λ = 0.5 nm, by their volumes.
static void compare_measured(const char *name, double bound) {
    char path[64], line[512];
    double squares = 0, shells = 0;
    snprintf(path, sizeof path, "out/%s", name);
    FILE *ours = fopen(path, "r");
    snprintf(path, sizeof path, "measured/%s", name);
    FILE *theirs = fopen(path, "r");
    assert_true(ours && theirs);
    while (fgets(line, sizeof line, ours)) {
        double r, g, their_r, their_g;
        if (sscanf(line, "%lf %lf", &r, &g) != 2)
            continue;
        do
            assert_non_null(fgets(line, sizeof line, theirs));
        while (sscanf(line, "%lf %lf", &their_r, &their_g) != 2);
        assert_true(fabs(their_r - 0.5 * r) < 1e-6);
        squares += r * r * (g - their_g) * (g - their_g);
        shells += r * r;
    }
    fclose(ours);
    fclose(theirs);
    print_message("%s: rms of g - ours: %.4f\n", name, sqrt(squares / shells));
    assert_true(sqrt(squares / shells) < bound);
}

/// Noise is 0.02 to 0.03, and of a third as many frames it was 0.03 to 0.06: OpenMM's have no seed.
/// Without the pairs g is 0.3 apart.
static void test_mixture_of_openmm_is_ours(void **state) {
    if (system("/usr/bin/python3 -c 'import openmm' 2>/dev/null") != 0) {
        print_message("skipped: OpenMM is not installed\n");
        skip();
    }
    export_in_nm(*state, mixture, "\"seed\": 5", "\"seed\": 6", "openmm");
    if (system("cd openmm && PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 run.py 1800 >run.out 2>&1"))
        fail_msg("OpenMM failed: %s", temporary_folder_read("openmm/run.out"));
    RUN_PROGRAM(&result, "measure", "openmm/trajectory.xyz", "--temperature", "300", "--range", "1",
                "--bins", "100", "-o", "measured");
    run_program_assert_code(&result, 0);
    compare_measured("rdf_A-A.tsv", 0.06);
    compare_measured("rdf_A-B.tsv", 0.06);
    compare_measured("rdf_B-B.tsv", 0.06);
}

/// Debian's GROMACS has no tables of pairs, which are next to nothing here.
static void test_chains_of_gromacs_are_ours(void **state) {
    static const char command[] =
        "cd gromacs && sed 's/ A 0.0 1.0$/ A 0.0 0.0/' topol.top >once.top && (grep -v "
        "'cutoff-scheme\\|vdwtype\\|energygrp\\|nsteps\\|nstlist\\|rlist\\|rcoulomb\\|rvdw' "
        "grompp.mdp && "
        "printf 'rcoulomb = 0.5\\nrvdw = 0.5\\nnsteps = 40000\\n') >once.mdp && (gmx grompp -f "
        "once.mdp -p once.top -n index.ndx -maxwarn 9 && gmx mdrun -nt 1) >gmx.out 2>&1";
    other_engine_skip_without("gmx");
    export_in_nm(*state, chains, "\"a\": 20", "\"a\": 1e-6", "gromacs");
    if (system(command) != 0)
        fail_msg("GROMACS failed: %s", temporary_folder_read("gromacs/gmx.out"));
    RUN_PROGRAM(&result, "measure", "gromacs/traj_comp.xtc", "-s", "gromacs/conf.gro",
                "--temperature", "300", "--molecules", "out/used.json", "--range", "1", "--bins",
                "100", "-o", "measured");
    run_program_assert_code(&result, 0);
    compare_measured("rdf.tsv", 0.03);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_mixture_is_ours), TEST(test_chains_are_ours),
                                       TEST(test_density_follows_the_pressure),
                                       TEST(test_mixture_of_openmm_is_ours),
                                       TEST(test_chains_of_gromacs_are_ours)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
