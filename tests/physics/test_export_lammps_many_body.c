// SPDX-License-Identifier: GPL-3.0-or-later
//
// Energies of local densities as they are exported, run by LAMMPS (Debian's lmp with its package
// MANYBODY, for ENGINES=1): its energy, pressure and forces of the configuration are
// ours, and its fluid has our g(r), pressure and densities.
#include "curves/weight.h"
#include "export/export_units.h"
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

// One configuration -------------------------------------------------------------------------------

#define MEASURE                                                                                    \
    "\"rdf\": {\"range\": 1.5}, \"measure\": {\"equilibration\": 20, \"samples\": 2, \"every\": "  \
    "5},\n"                                                                                        \
    "\"snapshots\": {\"every\": 10, \"formats\": [\"json\"]}}\n"
#define WEIGHT(inner, outer)                                                                       \
    "\"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": " #inner ", \"cutoff\": " #outer "}"

// clang-format off
/// Densities of some types among others, by each law of weights, in nm and ps.
static const char mixture[] =
    "{\"seed\": 1, \"units\": \"nm-ps\", \"box\": [1.8, 1.9, 2.0], \"time_step\": 0.01,\n"
    "\"temperature\": 300, \"precision\": \"double\",\n"
    "\"particles\": {\"types\": {\"A\": 65, \"B\": 85, \"C\": 12}, \"mass\": {\"A\": 18, \"B\": 30, \"C\": 10}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 60, \"cutoff\": 0.6},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 20, \"cutoff\": 0.6},\n"
    "\"many_body\": {\n"
    "  \"all\": {" WEIGHT(0.3, 0.7) ", \"energy\": {\"law\": \"polynomial\", \"c1\": -1, \"c2\": 0.02, \"c3\": -0.002,\n"
    "    \"c4\": 0.00005, \"origin\": 9}},\n"
    "  \"some\": {\"central\": \"A\", \"neighbours\": \"B C\", \"weight\": {\"law\": \"lucy\", \"cutoff\": 0.8},\n"
    "    \"energy\": {\"law\": \"expression\", \"formula\": \"-12*rho/(rho + 4)\", \"maximum\": 100}},\n"
    "  \"others\": {\"central\": \"C\", \"neighbours\": \"A\", " WEIGHT(0.4, 0.75) ",\n"
    "    \"energy\": {\"law\": \"table\", \"file\": \"f.tsv\"}},\n"
    "  \"one\": {\"central\": \"B\", \"weight\": {\"law\": \"many-body-dpd\", \"cutoff\": 0.6},\n"
    "    \"energy\": {\"law\": \"many-body-dpd\", \"b\": 5, \"cutoff\": 0.6}},\n"
    "  \"two\": {\"neighbours\": \"A C\", \"weight\": {\"law\": \"expression\", \"formula\": \"exp(-4*r^2)\", \"cutoff\": 0.7},\n"
    "    \"energy\": {\"law\": \"polynomial\", \"c2\": -0.2}},\n"
    "  \"three\": {\"central\": \"A B\", \"neighbours\": \"C\", \"weight\": {\"law\": \"table\", \"file\": \"w.tsv\"},\n"
    "    \"energy\": {\"law\": \"polynomial\", \"c1\": 1.5, \"c2\": 0.4}},\n"
    "  \"four\": {\"weight\": {\"law\": \"lucy\", \"cutoff\": 0.7}, \"energy\": {\"law\": \"polynomial\", \"c2\": 0.01}},\n"
    "  \"five\": {" WEIGHT(0.1, 0.4) ", \"energy\": {\"law\": \"polynomial\", \"c2\": 0.1}}},\n"
    "\"rdf\": {\"range\": 0.9}, \"measure\": {\"equilibration\": 500, \"samples\": 2, \"every\": 5},\n"
    "\"snapshots\": {\"every\": 300, \"formats\": [\"json\"]}}\n";
// clang-format on

/// Nearest neighbours, and those two bonds apart, count neither for the pairs nor for densities.
static const char chains[] =
    "{\"seed\": 2, \"box\": [4, 4, 4], \"time_step\": 0.02, \"precision\": \"double\",\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.7}},\n"
    "\"molecules\": {\"chain\": {\"count\": 20, \"exclude\": 2, \"chain\": {\"beads\": [\"A\", "
    "\"A\", \"B\", \"A\", \"A\"], \"bond\": \"spring\"}}},\n"
    "\"particles\": {\"types\": {\"W\": 40}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 5},\n"
    "\"many_body\": {\"crowd\": {" WEIGHT(
        0.5, 1.3) ",\n"
                  "    \"energy\": {\"law\": \"polynomial\", \"c1\": -0.8, \"c2\": 0.07}},\n"
                  "  \"ends\": {\"central\": \"A\", \"neighbours\": \"A\", " WEIGHT(
                      0.2, 1.1) ",\n"
                                "    \"energy\": {\"law\": \"polynomial\", \"c2\": 0.2, "
                                "\"origin\": 3}}},\n" MEASURE;

static const char flat[] = "{\"seed\": 3, \"dimensions\": 2, \"box\": [8, 9], \"time_step\": 0.04, "
                           "\"precision\": \"double\",\n"
                           "\"particles\": {\"count\": 180},\n"
                           "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 10},\n"
                           "\"many_body\": {\"crowd\": {" WEIGHT(
                               0.5, 1.4) ",\n"
                                         "    \"energy\": {\"law\": \"polynomial\", \"c1\": "
                                         "-0.5, \"c2\": 0.1, \"origin\": 5}}},\n" MEASURE;

static double twice_kinetic(const struct particles *particles) {
    const double *mass = particles_masses(particles);
    double sum = 0;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            sum += (mass ? mass[k] : 1) * particles->velocity[d][k] * particles->velocity[d][k];
    return sum;
}

/// @param[in] bound  of a bead's share of the virial [k_B T_0]
static void compare_pressure(double bound) {
    static struct lammps_runs_ours ours;
    double theirs;
    lammps_runs_once("press", &theirs, 1);
    lammps_runs_find_ours(&ours);
    const struct export_units units = mf_export_units(EXPORT_REAL, &ours.model.scene.units, false);
    const struct particles *particles = &ours.simulation.particles;
    const double volume = mf_box_volume(&particles->box);
    const double now = (ours.simulation.sums.virial + twice_kinetic(particles)) /
                       (particles->box.dimensions * volume);
    print_message("pressure %.9g, ours %.9g\n", theirs / units.pressure, now);
    assert_true(fabs(theirs / units.pressure - now) < bound * (double)ours.model.count / volume);
    lammps_runs_clear_ours(&ours);
}

/// Bounds: what tables promise is 1e-4 k_B T of a bead's energy and 1e-3 of the largest slope;
/// polynomials are a cubic or nearly so, and what is left is the table of the pairs.
static void compare(struct temporary_folder *folder, const char *scene, double bound) {
    lammps_runs_skip_without("eam/fs");
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
    small_inputs_write(folder, "f.tsv",
                       "# rho f[kJ/mol]\n0 0\n1 -0.4\n3 0.9\n6 2\n10 1.7\n15 2.5\n20 4\n", NULL,
                       NULL);
    small_inputs_write(folder, "w.tsv", "0 1\n0.2 0.8\n0.4 0.5\n0.5 0.25\n0.6 0.07\n0.7 0\n", NULL,
                       NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    const struct lammps_runs_apart apart = lammps_runs_compare(100);
    assert_true(apart.energy < bound && apart.force < bound * apart.largest_force);
    compare_pressure(bound * apart.largest_force);
}

static void test_mixtures_have_our_energies_and_forces(void **state) {
    compare(*state, mixture, 2e-5);
}

static void test_molecules_have_our_energies_and_forces(void **state) {
    compare(*state, chains, 2e-5);
}

static void test_plane_has_our_energies_and_forces(void **state) {
    compare(*state, flat, 2e-5);
}

// A run -----------------------------------------------------------------------------------------

enum { BEADS = 300, BLOCKS = 10 };
static const double edge = 4.6416, inner = 0.4, outer = 1.1;

static const char fluid[] =
    "{\"seed\": 4, \"box\": [4.6416, 4.6416, 4.6416], \"time_step\": 0.01, \"particles\": "
    "{\"count\": 300},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 15},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"many_body\": {\"crowd\": {\n"
    "    \"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": 0.4, \"cutoff\": 1.1},\n"
    "    \"energy\": {\"law\": \"polynomial\", \"c2\": 0.2, \"origin\": 5}}},\n"
    "\"weighted_density\": {\"inner_cutoff\": 0.4, \"cutoff\": 1.1},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 100},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": %d, \"every\": 10}}\n";

/// Mean density around the beads of a frame.
static double density_of(double (*place)[3]) {
    double sum = 0;
    for (int i = 0; i < BEADS; i++)
        for (int j = 0; j < i; j++) {
            double squared = 0;
            for (int d = 0; d < 3; d++) {
                const double x = place[i][d] - place[j][d];
                squared += pow(x - edge * rint(x / edge), 2);
            }
            sum += 2 * weight_sanyal_shell(squared, inner * inner, outer * outer);
        }
    return sum / BEADS;
}

/// That of the frames of a dump, and its error by blocks of them.
static double density_of_dump(const char *file, double *error) {
    static double place[BEADS][3];
    FILE *stream = fopen(file, "r");
    double block[BLOCKS] = {0}, sum = 0, squares = 0;
    static double value[10000];
    char line[512];
    int frames = 0;
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream)) {
        if (strncmp(line, "ITEM: ATOMS", 11) != 0)
            continue;
        for (int k = 0; k < BEADS; k++)
            assert_int_equal(fscanf(stream, "%*d %*d %lf %lf %lf%*[^\n]\n", &place[k][0],
                                    &place[k][1], &place[k][2]),
                             3);
        value[frames++] = density_of(place);
    }
    fclose(stream);
    for (int k = 0; k < frames / BLOCKS * BLOCKS; k++)
        block[k / (frames / BLOCKS)] += value[k] / (frames / BLOCKS);
    for (int b = 0; b < BLOCKS; b++)
        sum += block[b] / BLOCKS, squares += block[b] * block[b] / BLOCKS;
    *error = sqrt((squares - sum * sum) / (BLOCKS - 1));
    return sum;
}

/// False alarms: 4.5 standard errors each, 1e-5, of errors by ten or twenty blocks; g, whose
/// statistics left 0.013 apart, in the longer form 0.008, most of it below 0.1, where pairs are
/// few. Without the energy g is 0.047 apart, the pressure 15.4 and the density 6.37.
static void test_fluid_has_our_structure_pressure_and_density(void **state) {
    char scene[2048], key[64];
    const bool is_long = length_is_long();
    lammps_runs_skip_without("eam/fs");
    snprintf(scene, sizeof scene, fluid, is_long ? 2000 : 300);
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps");
    run_program_assert_code(&result, 0);
    if (system(is_long ? "cd lammps && lmp -in in.mesofit -var friction langevin -var steps 20000 "
                         "-var dump 100 >lmp.out 2>&1"
                       : "cd lammps && lmp -in in.mesofit -var friction langevin -var "
                         "equilibration 500 -var steps 3000 -var dump 50 >lmp.out 2>&1") != 0)
        fail_msg("LAMMPS failed: see lammps/lmp.out");
    const double difference = lammps_runs_rdf_difference(1);
    print_message("rms of g - ours: %.4f\n", difference);
    assert_true(difference < (is_long ? 0.012 : 0.025));
    for (int n = 0; n < 2; n++) {
        const char *name = n ? "weighted_density" : "pressure";
        double error;
        const double theirs =
            n ? density_of_dump("lammps/dump.lammpstrj", &error) : lammps_runs_mean(2, &error);
        const double ours = results_number("out/summary.json", name);
        snprintf(key, sizeof key, "%s_error", name);
        const double our_error = results_number("out/summary.json", key);
        print_message("%s %.4f(%.4f), ours %.4f(%.4f)\n", name, theirs, error, ours, our_error);
        assert_true(fabs(theirs - ours) < 4.5 * hypot(error, our_error));
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_mixtures_have_our_energies_and_forces),
                                       TEST(test_molecules_have_our_energies_and_forces),
                                       TEST(test_plane_has_our_energies_and_forces),
                                       TEST(test_fluid_has_our_structure_pressure_and_density)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
