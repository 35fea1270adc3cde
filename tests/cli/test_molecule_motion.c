// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far molecules go: against the motion of beads where each molecule is one, against Rouse's
// D = k_B T/(N zeta), which holds whatever holds a chain together, and through a restart; and beads
// in a solvent without hydrodynamics against molecular chaos.
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

static void simulate(struct temporary_folder *folder, const char *scene, const char *out) {
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out);
    run_program_assert_code(&result, 0);
}

/// Molecules of one bead, some heavy: their centres of mass are the beads'.
static const char beads[] =
    "{\"seed\": 5, \"box\": [5, 5, 5], \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"dynamics\": {\"integrator\": \"velocity-verlet\"},\n"
    "\"particles\": {\"mass\": {\"A\": 1, \"B\": 4}},\n"
    "\"molecules\": {\"light\": {\"count\": 200, \"beads\": [\"A\"]}, \"heavy\": {\"count\": 175,\n"
    "\"beads\": [\"B\"]}},\n"
    "\"motion\": {\"lags\": 20}, \"molecule_motion\": {\"lags\": 20},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 100, \"every\": 20}}\n";

/// Columns of a table's rows; returns the number of rows.
static size_t read_rows(const char *file, double (*rows)[8], size_t max, int columns) {
    char line[4096];
    size_t count = 0;
    FILE *stream = fopen(file, "r");
    assert_non_null(stream);
    while (count < max && fgets(line, sizeof line, stream)) {
        char *at = line;
        for (int k = 0; line[0] != '#' && k < columns; k++)
            rows[count][k] = strtod(at, &at);
        count += line[0] != '#';
    }
    fclose(stream);
    return count;
}

static void test_molecules_of_one_bead_move_as_the_bead_does(void **state) {
    double all[64][8], kinds[64][8];
    simulate(*state, beads, "out");
    assert_int_equal(read_rows("out/motion.tsv", all, 64, 3), 21);
    assert_int_equal(read_rows("out/molecule_motion.tsv", kinds, 64, 5), 21);
    for (size_t k = 1; k < 21; k++) {
        assert_close(kinds[k][0], all[k][0], 1e-12);
        assert_close((200 * kinds[k][1] + 175 * kinds[k][3]) / 375, all[k][1], 1e-6 * all[k][1]);
    }
    // Light ones go farther.
    assert_true(kinds[20][1] > 1.1 * kinds[20][3]);
}

/// Two molecules alone: the heavier one goes less far, by the ratio of their masses.
static void test_centres_are_those_of_mass(void **state) {
    static const char pair[] =
        "{\"seed\": 5, \"box\": [2.2, 2.2, 2.2], \"time_step\": 0.01,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
        "\"dynamics\": {\"integrator\": \"velocity-verlet\"},\n"
        "\"particles\": {\"mass\": {\"A\": 1, \"B\": 4}},\n"
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 10, \"length\": 0.8}},\n"
        "\"molecules\": {\"three\": {\"count\": 1, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"
        "\"bond\": \"spring\"}}, \"pair\": {\"count\": 1, \"beads\": [\"B\", \"B\"]}},\n"
        "\"molecule_motion\": {\"lags\": 20},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 100, \"every\": 20}}\n";
    double rows[64][8];
    simulate(*state, pair, "out");
    assert_int_equal(read_rows("out/molecule_motion.tsv", rows, 64, 5), 21);
    for (size_t k = 1; k < 21; k++) {
        assert_true(rows[k][1] > 0);
        assert_close(36 * rows[k][1], 64 * rows[k][3], 1e-5 * 64 * rows[k][3]);
    }
}

static void test_brownian_chains_diffuse_as_rouse_says(void **state) {
    static const char chains[] =
        "{\"seed\": 7, \"box\": [9, 9, 9], \"time_step\": 0.01,\n"
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 10, \"length\": 0.8}},\n"
        "\"molecules\": {\"four\": {\"count\": 60, \"chain\": {\"type\": \"A\", \"length\": 4,\n"
        "\"bond\": \"spring\"}}, \"seven\": {\"count\": 40, \"chain\": {\"type\": \"A\",\n"
        "\"length\": 7, \"bond\": \"spring\"}}},\n"
        "\"dynamics\": {\"integrator\": \"brownian\", \"friction\": 2},\n"
        "\"molecule_motion\": {\"every\": 10, \"lags\": 20, \"origin_every\": 5},\n"
        "\"motion\": {\"every\": 10, \"lags\": 20, \"origin_every\": 5},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 2000, \"every\": 10}}\n";
    simulate(*state, chains, "out");
    // Their beads are held by the chains for longer than this window.
    const char *const centres = strstr(result.err, "four: D = "), *const end =
                                                                      strchr(centres, '\n');
    const char *const of_beads = strstr(result.err, "\nD = ");
    const char *const early = strstr(result.err, "; no D yet: the MSD still grows as t^0.");
    assert_true(end <= of_beads && of_beads < early);
    static const struct {
        const char *kind;
        double beads;
    } expected[] = {{"four", 4}, {"seven", 7}};
    for (size_t k = 0; k < 2; k++) {
        char key[64];
        snprintf(key, sizeof key, "molecule_motion.%s.diffusion_error", expected[k].kind);
        const double error = results_number("out/summary.json", key);
        key[strlen(key) - strlen("_error")] = '\0';
        // Without forces between chains 1/(2 N); false alarm 1 in 15,000 each.
        assert_true(error < 0.03 / (2 * expected[k].beads));
        assert_close(results_number("out/summary.json", key), 1 / (2 * expected[k].beads),
                     4 * error);
    }
}

/// Chains whose beads' MSD grows as t between their flights and their molecules' hold: no D.
static void test_beads_that_move_within_their_molecules_have_no_diffusion(void **state) {
    static const char chains[] =
        "{\"seed\": 7, \"box\": [7, 7, 7], \"time_step\": 0.01,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 10, \"length\": 0.8}},\n"
        "\"molecules\": {\"seven\": {\"count\": 60, \"chain\": {\"type\": \"A\", \"length\": 7,\n"
        "\"bond\": \"spring\"}}},\n"
        "\"dynamics\": {\"integrator\": \"velocity-verlet\"}, \"molecule_sizes\": {},\n"
        "\"motion\": {\"every\": 10, \"lags\": LAGS, \"origin_every\": 2},\n"
        "\"measure\": {\"equilibration\": 1000, \"samples\": 1000, \"every\": 10}}\n";
    static const char within[] = "no D yet: beads still move within their molecules";
    double soon;
    small_inputs_write(*state, "scene.json", chains, "LAGS", "12");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_non_null(strstr(result.err, within));
    char line[160];
    snprintf(line, sizeof line, "%.*s", (int)strcspn(strstr(result.err, within), "\n"),
             strstr(result.err, within));
    results_assert_text("out/summary.json", "motion.warning", line);
    soon = results_number("out/summary.json", "motion.diffusion_msd");
    small_inputs_write(*state, "long.json", chains, "LAGS", "400");
    RUN_PROGRAM(&result, "simulate", "long.json", "-o", "long");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "no D yet"));
    assert_true(results_number("long/summary.json", "motion.diffusion_msd") < 0.6 * soon);
}

static void test_motion_of_molecules_goes_on_with_the_same_bits(void **state) {
    static const char *const tables[] = {"molecule_motion.tsv", "motion.tsv", NULL};
    simulate(*state, beads, "whole");
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
}

static void test_beads_without_hydrodynamics_diffuse_by_molecular_chaos(void **state) {
    static const char solvent[] =
        "{\"seed\": 1, \"box\": [8, 8, 8], \"time_step\": 0.1,\n"
        "\"particles\": {\"count\": 15, \"mass\": 10}, \"dynamics\": {\"integrator\":\n"
        "\"collision-dynamics\", \"thermostat\": \"yes\", \"hydrodynamics\": \"WHICH\"},\n"
        "\"motion\": {\"lags\": 40, \"origin_every\": 4}, \"flow_profile\": {},\n"
        "\"measure\": {\"equilibration\": 200, \"samples\": 2000, \"every\": 20}}\n";
    double found[2], error[2];
    for (int which = 0; which < 2; which++) {
        small_inputs_write(*state, "scene.json", solvent, "WHICH", which ? "yes" : "no");
        small_inputs_change(*state, "scene.json", "2000", length_is_long() ? "2000" : "700");
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
        run_program_assert_code(&result, 0);
        found[which] = results_number("out/summary.json", "motion.diffusion_msd");
        error[which] = results_number("out/summary.json", "motion.diffusion_msd_error");
    }
    // Theory is off by 2 %, as numbers of particles in a cell last; the flow brings back 40 %.
    const double theory = results_number("out/summary.json", "bead_diffusion_theory");
    print_message("D = %g(%g) and %g(%g), theory %g\n", found[0], error[0], found[1], error[1],
                  theory);
    assert_close(found[0], theory, 4 * error[0] + 0.03 * theory);
    assert_true(found[1] > found[0] + 4 * hypot(error[0], error[1]));
}

#define CHANNEL(length, height)                                                                    \
    "{\"seed\": 1, \"dimensions\": 2, \"box\": [24, " height "], \"time_step\": 0.02,\n"           \
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.7}},\n"             \
    "\"molecules\": {\"chain\": {\"count\": 8, \"chain\": {\"type\": \"A\", \"length\": " length   \
    ",\n"                                                                                          \
    "\"bond\": \"spring\"}}, \"star\": {\"count\": 4, \"beads\": [\"A\", \"A\", \"A\", \"A\"],\n"  \
    "\"bonds\": {\"spring\": [[4, 1], [4, 2], [3, 4]]}}},\n"                                       \
    "\"particles\": {\"types\": {\"W\": 30}},\n"                                                   \
    "\"dynamics\": {\"integrator\": \"collision-dynamics\", \"interval\": 5, \"thermostat\":\n"    \
    "\"yes\", \"walls\": \"plates\", \"obstacle_centre\": [8, 6], \"obstacle_radius\": 3},\n"      \
    "\"snapshots\": {\"every\": 20},\n"                                                            \
    "\"measure\": {\"equilibration\": 0, \"samples\": 20, \"every\": 1}}\n"

/// Molecules that would begin in the obstacle or through a plate begin elsewhere, whole.
static void test_molecules_begin_between_plates_and_outside_obstacles(void **state) {
    enum { SINGLE = 30, CHAINS = 8, LENGTH = 12, STARS = 16 };
    double rows[200][8];
    simulate(*state, CHANNEL("12", "12"), "out");
    assert_int_equal(read_rows("out/configuration.tsv", rows, 200, 2),
                     SINGLE + CHAINS * LENGTH + STARS);
    for (size_t k = 0; k < SINGLE + CHAINS * LENGTH + STARS; k++)
        assert_true(hypot(rows[k][0] - 8, rows[k][1] - 6) >= 3);
    for (size_t k = SINGLE; k < SINGLE + CHAINS * LENGTH; k++)
        if ((k - SINGLE) % LENGTH != LENGTH - 1) {
            const double x = fabs(rows[k][0] - rows[k + 1][0]);
            assert_true(hypot(fmin(x, 24 - x), rows[k][1] - rows[k + 1][1]) < 1.4);
        }
    small_inputs_write(*state, "long.json", CHANNEL("150", "12"), NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "long.json", "-o", "none");
    run_program_assert_refused(&result, "none", "too long", 1,
                               (const char *const[]){"no room for a molecule of 150 beads", NULL});
}

int main(void) {
#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_molecules_of_one_bead_move_as_the_bead_does),
        IN_FOLDER(test_centres_are_those_of_mass),
        IN_FOLDER(test_brownian_chains_diffuse_as_rouse_says),
        IN_FOLDER(test_beads_that_move_within_their_molecules_have_no_diffusion),
        IN_FOLDER(test_motion_of_molecules_goes_on_with_the_same_bits),
        IN_FOLDER(test_molecules_begin_between_plates_and_outside_obstacles),
        IN_FOLDER(test_beads_without_hydrodynamics_diffuse_by_molecular_chaos),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
