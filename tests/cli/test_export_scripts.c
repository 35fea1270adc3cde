// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules in engines that a Python script drives: OpenMM (Debian's python3-simtk; skipped where
// there is none) has our energies and forces, law by law, and our g(r). HOOMD-blue and ESPResSo are
// not in Debian: models of what their manuals say of each call (tests/shared/engines) have them.
#include "export/export_units.h"
#include "shared/exported_molecules.h"
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

/// Chains of all laws, dimers that exclude other pairs, and single beads. Pairs are so weak that
/// the forces are those of the terms.
static const char scene[] =
    "{\"seed\": 5, \"box\": [5, 5, 5], \"time_step\": 0.002, \"precision\": \"double\",\n"
    "\"units\": {\"length\": 0.5, \"temperature\": 300, \"mass\": 5e-26},\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 120, \"length\": 0.7},\n"
    "  \"fene\": {\"law\": \"fene\", \"k\": 8, \"longest\": 2},\n"
    "  \"stiff\": {\"law\": \"harmonic\", \"k\": 300, \"length\": 0.9}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 8, \"angle\": 110},\n"
    "  \"straight\": {\"law\": \"cosine\", \"k\": 3},\n"
    "  \"squared\": {\"law\": \"cosine-squared\", \"k\": 30, \"angle\": 120}},\n"
    "\"dihedrals\": {\"butane\": {\"law\": \"ryckaert-bellemans\", \"c0\": 3.7, \"c1\": 4.9,\n"
    "    \"c2\": -5.3, \"c3\": -1.1, \"c4\": 1.3, \"c5\": 0.4},\n"
    "  \"turn\": {\"law\": \"periodic\", \"k\": 1.7, \"multiplicity\": 3, \"phase\": 70.5}},\n"
    "\"molecules\": {\"chain\": {\"count\": 6, \"exclude\": 1,\n"
    "    \"beads\": [\"A\", \"B\", \"A\", \"B\", \"A\", \"A\"],\n"
    "    \"bonds\": {\"spring\": [[1, 2], [2, 3]], \"fene\": [[3, 4]], \"stiff\": [[4, 5], [5, "
    "6]]},\n"
    "    \"angles\": {\"bend\": [[1, 2, 3]], \"straight\": [[2, 3, 4]],\n"
    "      \"squared\": [[3, 4, 5], [4, 5, 6]]},\n"
    "    \"dihedrals\": {\"butane\": [[1, 2, 3, 4]], \"turn\": [[2, 3, 4, 5], [3, 4, 5, 6]]}},\n"
    "  \"dimer\": {\"count\": 4, \"exclude\": 0, \"chain\": {\"beads\": [\"B\", \"W\"],\n"
    "    \"bond\": \"stiff\"}}},\n"
    "\"particles\": {\"types\": {\"W\": 6}, \"mass\": {\"A\": 1, \"B\": 2, \"W\": 1.5}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 1e-6},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2},\n"
    "\"snapshots\": {\"every\": 300, \"formats\": [\"json\"]},\n"
    "\"measure\": {\"equilibration\": 300, \"samples\": 2, \"every\": 10}}\n";

/// The same with tables in their place, and with pairs.
static const struct exported_molecules_table tables[] = {
    {"{\"law\": \"harmonic\", \"k\": 120, \"length\": 0.7}",
     "{\"law\": \"table\", \"file\": \"bond.tsv\"}"},
    {"{\"law\": \"harmonic\", \"k\": 8, \"angle\": 110}",
     "{\"law\": \"table\", \"file\": \"angle.tsv\"}"},
    {"{\"law\": \"periodic\", \"k\": 1.7, \"multiplicity\": 3, \"phase\": 70.5}",
     "{\"law\": \"table\", \"file\": \"dihedral.tsv\"}"},
    {"\"a\": 1e-6", "\"a\": 15"},
};
enum { TABLES = sizeof tables / sizeof *tables };

static void make_result(struct temporary_folder *folder, bool with_tables) {
    exported_molecules_simulate(folder, scene, tables, with_tables ? TABLES : 0);
}

// Comparison --------------------------------------------------------------------------------------

enum { PAIRS, BONDS, ANGLES, DIHEDRALS, FORCES, DIFFERENCES };

static void write_configuration(const struct lammps_runs_ours *ours,
                                const struct export_units *units, FILE *stream) {
    const struct particles *particles = &ours->simulation.particles;
    double pairs = ours->simulation.sums.energy;
    for (int order = 0; order < BONDED_KINDS; order++)
        pairs -= lammps_runs_energy_of(ours, order);
    fprintf(stream, "%.17g", pairs * units->energy);
    for (int order = 0; order < BONDED_KINDS; order++)
        fprintf(stream, " %.17g", lammps_runs_energy_of(ours, order) * units->energy);
    for (size_t id = 0; id < particles->count; id++) {
        const uint32_t place = particles->place[id];
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%c%.17g", d ? ' ' : '\n',
                    particles->position[d][place] * units->length);
        for (int d = 0; d < 3; d++)
            fprintf(stream, " %.17g", particles->force[d][place] * export_units_force(units));
    }
    fprintf(stream, "\n");
}

/// The largest differences of energies of a bead [k_B T_0] and of forces [k_B T_0/lambda].
static void compare(const char *engine, int configurations, double difference[DIFFERENCES]) {
    static struct run_program_result result;
    static struct lammps_runs_ours ours;
    char command[1024];
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "-o", engine);
    run_program_assert_code(&result, 0);
    lammps_runs_find_ours(&ours);
    const struct export_units units =
        mf_export_units(EXPORT_NANOMETRES, &ours.model.scene.units, true);
    FILE *stream = fopen("configurations.txt", "w");
    assert_non_null(stream);
    fprintf(stream, "%zu\n", ours.model.count);
    for (int k = 0; k < configurations; k++) {
        write_configuration(&ours, &units, stream);
        lammps_runs_move(&ours, (uint32_t)k);
    }
    fclose(stream);
    lammps_runs_clear_ours(&ours);
    snprintf(command, sizeof command,
             "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 %s/tests/shared/engines/compare.py %s "
             "configurations.txt >said.txt 2>&1 && tail -n 1 said.txt >differences.txt",
             run_program_sources(), engine);
    if (system(command) != 0)
        fail_msg("%s does not take the script: %s", engine, temporary_folder_read("said.txt"));
    stream = fopen("differences.txt", "r");
    assert_int_equal(fscanf(stream, "%*d"), 0);
    for (int k = 0; k < DIFFERENCES; k++) {
        assert_int_equal(fscanf(stream, "%lf", &difference[k]), 1);
        difference[k] /= k == FORCES ? export_units_force(&units) : units.energy;
    }
    fclose(stream);
    print_message("%s, %d configurations: pairs %.2g, bonds %.2g, angles %.2g, dihedrals %.2g of a "
                  "bead, forces %.2g apart at most\n",
                  engine, configurations, difference[PAIRS], difference[BONDS], difference[ANGLES],
                  difference[DIHEDRALS], difference[FORCES]);
}

static void skip_without(const char *module) {
    char command[128];
    snprintf(command, sizeof command, "/usr/bin/python3 -c 'import %s' 2>/dev/null", module);
    if (system(command) == 0)
        return;
    print_message("the Python module %s is not installed\n", module);
    skip();
}

static void assert_below(const double difference[DIFFERENCES], double energy, double force) {
    for (int k = 0; k < FORCES; k++)
        assert_true(difference[k] < energy);
    assert_true(difference[FORCES] < force);
}

enum { CONFIGURATIONS = 100 };

/// Models of engines are slow.
static int configurations(void) {
    return length_is_long() ? CONFIGURATIONS : 2;
}

/// Numbers of the script have 15 digits, and positions of ours 32 bits.
static void test_openmm_has_the_energies_and_forces_of_our_laws(void **state) {
    double difference[DIFFERENCES];
    skip_without("openmm");
    make_result(*state, false);
    compare("openmm", CONFIGURATIONS, difference);
    assert_below(difference, 1e-7, 1e-5);
}

/// Tables are right within 1e-4 k_B T a term.
static void test_openmm_has_those_of_our_tables(void **state) {
    double difference[DIFFERENCES];
    skip_without("openmm");
    make_result(*state, true);
    compare("openmm", CONFIGURATIONS, difference);
    assert_below(difference, 1e-4, 0.02);
}

static void test_scripts_of_hoomd_and_espresso_have_those_of_our_laws(void **state) {
    static const char *const engines[] = {"hoomd", "espresso"};
    double difference[DIFFERENCES];
    skip_without("numpy");
    for (int with_tables = 0; with_tables < 2; with_tables++) {
        make_result(*state, with_tables);
        for (int e = 0; e < 2; e++) {
            compare(engines[e], configurations(), difference);
            assert_below(difference, 1e-4, 0.05);
        }
    }
}

// A run -------------------------------------------------------------------------------------------

/// Dimers, whose pairs g(r) has as long as they are not excluded.
static const char dimers[] =
    "{\"seed\": 5, \"box\": [3.3, 3.3, 3.3], \"time_step\": 0.01,\n"
    "\"units\": {\"length\": 0.5, \"temperature\": 300, \"mass\": 5e-26},\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 60, \"length\": 0.7}},\n"
    "\"molecules\": {\"dimer\": {\"count\": 54, \"exclude\": 1,\n"
    "  \"chain\": {\"beads\": [\"A\", \"A\"], \"bond\": \"spring\"}}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"rdf\": {\"range\": 1.6, \"bins\": 40},\n"
    "\"snapshots\": {\"every\": 300, \"formats\": [\"json\"]},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 1000, \"every\": 5}}\n";

/// rms of the difference of g in rdf.txt [nm] from that in out/rdf.tsv, and the temperature.
static double rdf_difference(double *temperature) {
    FILE *ours = fopen("out/rdf.tsv", "r"), *theirs = fopen("rdf.txt", "r");
    char line[512];
    double squares = 0;
    int rows = 0;
    assert_true(ours && theirs);
    while (fgets(line, sizeof line, ours)) {
        double r, g, their_r, their_g;
        if (sscanf(line, "%lf %lf", &r, &g) != 2)
            continue;
        assert_int_equal(fscanf(theirs, "%lf %lf %lf", &their_r, &their_g, temperature), 3);
        assert_true(fabs(their_r - 0.5 * r) < 1e-6);
        squares += (g - their_g) * (g - their_g);
        rows++;
    }
    fclose(ours);
    fclose(theirs);
    assert_int_equal(rows, 40);
    return sqrt(squares / rows);
}

/// A fault of pairs or exclusions shows by 0.08 and more, where statistics have 0.01. The bath's
/// temperature forgets in 120 steps: its error is 9 K, and 2.5 K in the longer form.
static void test_openmm_has_our_molecules(void **state) {
    static struct run_program_result result;
    char command[1024];
    double temperature = 0;
    skip_without("openmm");
    small_inputs_write(*state, "scene.json", dimers, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "openmm", "-o", "openmm");
    run_program_assert_code(&result, 0);
    snprintf(command, sizeof command,
             "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 %s/tests/shared/engines/openmm_rdf.py "
             "openmm %d 0.8 40 >rdf.txt",
             run_program_sources(), length_is_long() ? 20000 : 1500);
    assert_int_equal(system(command), 0);
    const double difference = rdf_difference(&temperature);
    print_message("rms of g - ours: %.4f; T %.2f K\n", difference, temperature);
    assert_true(difference < (length_is_long() ? 0.015 : 0.03));
    assert_true(fabs(temperature - 300) < (length_is_long() ? 12 : 42));
}

// Friction ----------------------------------------------------------------------------------------

/// Beads of two masses.
static const char rubbing[] =
    "{\"seed\": 5, \"units\": \"nm-ps\", \"box\": [2, 2, 2], \"time_step\": 0.005, "
    "\"temperature\": 300,\n"
    "\"particles\": {\"types\": {\"A\": 30, \"B\": 20}, \"mass\": {\"A\": 18, \"B\": 40}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 50, \"cutoff\": 0.6},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 20, \"cutoff\": 0.5},\n"
    "\"snapshots\": {\"every\": 100, \"formats\": [\"json\"]},\n"
    "\"measure\": {\"equilibration\": 20, \"samples\": 2, \"every\": 10}}\n";

/// A pair's velocity falls by exp(−γ w² Δt/m_r), m_r its reduced mass and γ = σ², and DPDIntegrator
/// lets it fall by exp(−2 friction w² Δt).
static void test_openmm_is_told_our_friction(void **state) {
    static struct run_program_result result;
    static const double mass[] = {18, 40};
    char command[1024];
    skip_without("openmm");
    small_inputs_write(*state, "scene.json", rubbing, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "openmm", "-o", "openmm");
    run_program_assert_code(&result, 0);
    snprintf(command, sizeof command,
             "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 %s/tests/shared/engines/openmm_dpd.py "
             "openmm >dpd.txt",
             run_program_sources());
    assert_int_equal(system(command), 0);
    FILE *stream = fopen("dpd.txt", "r");
    double temperature, step;
    assert_non_null(stream);
    for (int k = 0; k < 3; k++) {
        int a, b;
        double friction, cutoff;
        assert_int_equal(fscanf(stream, "%d %d %lf %lf", &a, &b, &friction, &cutoff), 4);
        print_message("%d %d: %g\n", a, b, friction);
        assert_true(fabs(2 * friction / (20 * 20 * (1 / mass[a] + 1 / mass[b])) - 1) < 1e-6);
        assert_true(fabs(cutoff - 0.5) < 1e-6);
    }
    assert_int_equal(fscanf(stream, "%lf %lf", &temperature, &step), 2);
    assert_true(fabs(temperature - 300) < 1e-9 && step > 0 && step < 0.0051);
    for (int k = 0; k < 50; k++) {
        int type;
        assert_int_equal(fscanf(stream, "%d", &type), 1);
        assert_int_equal(type, k >= 30);
    }
    fclose(stream);
}

// Pressure ----------------------------------------------------------------------------------------

/// OpenMM refuses a box below two cutoffs; its pressure is by what boxes beside that of the scene
/// tell.
static void test_openmm_has_a_pressure_where_two_cutoffs_just_fit(void **state) {
    static struct run_program_result result;
    double step, temperature, pressure, sum = 0;
    int lines = 0;
    char line[256];
    skip_without("openmm");
    small_inputs_write(*state, "scene.json", rubbing, "[2, 2, 2]", "[1.2, 1.2, 1.2]");
    small_inputs_change(*state, "scene.json", "\"equilibration\": 20, \"samples\": 2",
                        "\"equilibration\": 500, \"samples\": 400");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "openmm", "-o", "openmm");
    run_program_assert_code(&result, 0);
    assert_int_equal(system("cd openmm && PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 run.py 2000 "
                            ">run.out 2>error"),
                     0);
    FILE *stream = fopen("openmm/run.out", "r");
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream))
        if (sscanf(line, "%lf %lf %lf", &step, &temperature, &pressure) == 3) {
            sum += pressure;
            lines++;
        }
    fclose(stream);
    const double ours = results_number("out/summary.json", "pressure");
    print_message("pressure %.4g, ours %.4g bar\n", sum / lines, ours);
    assert_int_equal(lines, 100);
    assert_true(fabs(sum / lines / ours - 1) < 0.1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_openmm_has_the_energies_and_forces_of_our_laws),
        TEST(test_openmm_has_those_of_our_tables),
        TEST(test_scripts_of_hoomd_and_espresso_have_those_of_our_laws),
        TEST(test_openmm_has_our_molecules),
        TEST(test_openmm_is_told_our_friction),
        TEST(test_openmm_has_a_pressure_where_two_cutoffs_just_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
