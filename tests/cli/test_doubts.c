// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers in another unit than that of the file, which no liquid has: each has a warning that names
// its key, and the same in the right unit has none.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char root[512];

static int enter(void **state) {
    char from[1024];
    snprintf(from, sizeof from, "%s/targets/spc-water/spc298_rdf_com_1.0nm_100.txt", root);
    return small_inputs_enter_without_gnuplot(state) != 0 || symlink(from, "water.txt") != 0;
}

/// One bead a molecule of water, and two in a chain where bonds or angles are asked for.
#define TARGET "\"diffusion\": {\"value\": 0.0042, \"error\": 0.0001}"
static const char water[] =
    "{\"units\": \"nm-ps\", \"target\": {" TARGET ", \"rdf\": {\"file\": \"water.txt\",\n"
    "\"r_column\": 2, \"g_column\": 5, \"error_column\": 6}},\n"
    "\"scene\": {\"density\": 32.57, \"temperature\": 298, \"time_step\": 0.003,\n"
    "\"particles\": {\"mass\": 18.015}}}\n";

static const char chains[] =
    "{\"units\": \"nm-ps\", \"target\": {\"bond_lengths\": {\"bond\": {\"file\": \"bond.tsv\"}},\n"
    "\"bond_angles\": {\"bend\": {\"file\": \"bend.tsv\"}}},\n"
    "\"scene\": {\"box\": [8, 8, 8], \"temperature\": 298, \"particles\": {\"mass\": 18.015},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 60, \"cutoff\": 0.3},\n"
    "\"molecules\": {\"chain\": {\"count\": 4000, \"chain\": {\"type\": \"A\", \"length\": 3,\n"
    "\"bond\": \"bond\", \"angle\": \"bend\"}}}}}\n";

static const char scene[] =
    "{\"units\": \"nm-ps\", \"box\": [4, 4, 4], \"temperature\": 298, \"time_step\": 0.003,\n"
    "\"particles\": {\"mass\": 18.015}, \"dissipative\": {\"law\": \"power\", \"sigma\": 5, "
    "\"cutoff\": 0.3},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 60, \"cutoff\": 0.3},\n"
    "\"bonds\": {\"bond\": {\"law\": \"harmonic\", \"k\": 5000, \"length\": 0.3}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 50, \"angle\": 110}},\n"
    "\"molecules\": {\"chain\": {\"count\": 500, \"chain\": {\"type\": \"A\", \"length\": 3,\n"
    "\"bond\": \"bond\", \"angle\": \"bend\"}}},\n"
    "\"measure\": {\"equilibration\": 1, \"samples\": 1, \"every\": 1}}\n";

static struct run_program_result result;

/// `from` becomes `to`, and a warning has `words`; nothing is warned of before.
static void assert_doubted(struct temporary_folder *folder, const char *command, const char *file,
                           const char *from, const char *to, const char *words) {
    for (int k = 0; k < 2; k++) {
        small_inputs_write(folder, "run.json", file, k ? from : NULL, k ? to : NULL);
        RUN_PROGRAM(&result, command, "run.json", "--explain");
        run_program_assert_code(&result, 0);
        if (k == 0 && strstr(result.out, "warning"))
            fail_msg("before %s: %s", to, strstr(result.out, "warning"));
        if (k == 1 && !strstr(result.out, words))
            fail_msg("no %s with %s, but %s", words, to, strstr(result.out, "warning"));
    }
}

static void test_numbers_that_no_liquid_has_are_doubted(void **state) {
    static const char *const cases[][3] = {
        {"298,", "25,", "warning: scene.temperature: at 25 K hardly anything is liquid"},
        {"298,", "1,", "and 1 degrees Celsius are 274.15"},
        {"0.0042", "4.2e-5", "warning: target.diffusion: 4.2e-05 nm^2/ps is 0.00036 of"},
        {"\"time_step\": 0.003", "\"time_step\": 0.3",
         "warning: scene.time_step: in 0.3 ps a bead moves 0.36 of the distance"},
        {"\"time_step\": 0.003", "\"time_step\": 0.08",
         "warning: scene.time_step: 0.08 ps is 32 times as long as the program would choose"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_doubted(*state, "fit", water, cases[k][0], cases[k][1], cases[k][2]);
}

/// A normal distribution about a mean, in 21 rows.
static void write_distribution(struct temporary_folder *folder, const char *name, double mean,
                               double width) {
    static const int p[] = {1, 2, 4, 8, 14, 24, 38, 55, 74, 90, 100};
    char text[2048];
    size_t length = 0;
    for (int k = 0; k <= 20; k++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%.9g %.6g\n",
                                   mean + width * (k - 10), p[k > 10 ? 20 - k : k] / (720 * width));
    temporary_folder_write(folder, name, text, length);
}

static void test_bonds_in_angstrom_and_angles_in_radians_are_doubted(void **state) {
    small_inputs_write(*state, "run.json", chains, NULL, NULL);
    for (int k = 0; k < 2; k++) {
        write_distribution(*state, "bond.tsv", k == 1 ? 3 : 0.3, k == 1 ? 0.05 : 0.005);
        write_distribution(*state, "bend.tsv", 109, 3);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out, "warning: target.bond_lengths.bond: bond.tsv: bonds of "
                                            "2.48 to 3.53 nm, where beads") != NULL,
                         k == 1);
    }
    assert_doubted(*state, "simulate", scene, "\"length\": 0.3", "\"length\": 1.5",
                   "warning: bonds.bond: a bond of 1.5 nm, where beads have a mean distance of");
    assert_doubted(*state, "simulate", scene, "110", "1.92",
                   "warning: angles.bend: an angle of 1.92 degrees lets beads overlap");
    assert_doubted(*state, "simulate", scene, "0.003", "0.3",
                   "warning: time_step: 0.3 ps is 41 times as long as bonds");
}

/// Energies in kelvins, a length that is another, a cutoff in the unit of another file.
static void test_potentials_that_hold_or_end_as_none_does_are_doubted(void **state) {
    static const char beads[] =
        "{\"box\": [9, 9, 9], \"particles\": {\"count\": 400}, \"time_step\": 1e-4,\n"
        "\"conservative\": {\"law\": \"lennard-jones\", \"epsilon\": 5, \"sigma\": 1, "
        "\"cutoff\": 2.5},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
        "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}}\n";
    assert_doubted(*state, "simulate", beads, "\"epsilon\": 5,", "\"epsilon\": 119.8,",
                   "warning: conservative: a well of 118 k_B T, which beads hardly ever leave");
    // 120 (2 (3/2.5)^12 - (3/2.5)^6) is 1782.
    assert_doubted(*state, "simulate", beads, "\"sigma\": 1,", "\"sigma\": 3,",
                   "the force ends abruptly at the cutoff, 2.5, where it is still 1.8e+03 k_B T");
}

/// A scene without a time step: by the rule of a fit's verification; ten times that is doubted.
static void test_time_step_of_a_scene_is_chosen_and_a_long_one_doubted(void **state) {
    static const char beads[] =
        "{\"box\": [6, 6, 6], \"particles\": {\"count\": 180}, \"time_step\": 0,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
        "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}}\n";
    static const struct {
        const char *scene, *given, *from, *to, *chosen, *step, *long_one, *doubt;
        double used;
    } cases[] = {
        {beads, "\"time_step\": 0,", NULL, NULL,
         "chosen: time step 0.02 tau: beads move a fiftieth of the distance to their neighbours",
         "0.02", "0.2", "warning: time_step: 0.2 tau is 7.1 times as long as this potential allows",
         0.02},
        {beads, "\"time_step\": 0,", "\"law\": \"soft-repulsion\", \"a\": 25",
         "\"law\": \"lennard-jones\", \"cutoff\": 2.5",
         "chosen: time step 0.003 tau: the curvature of the potential is up to ", "0.003", "0.03",
         "warning: time_step: 0.03 tau is 7.6 times as long as this potential allows", 0.003},
        {scene, "\"time_step\": 0.003,", NULL, NULL,
         "chosen: time step 0.015 ps, in which bonds take 4 of their own: beads move a fiftieth of",
         "0.006", "0.06",
         "warning: time_step: 0.06 ps is 8.1 times as long as bonds, angles and dihedrals allow if "
         "their distributions are to be right within 0.3 % of their variance, 0.0074 ps",
         0.015},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[2048], given[64], *at;
        snprintf(text, sizeof text, "%s", cases[k].scene);
        at = cases[k].from ? strstr(text, cases[k].from) : NULL;
        if (at) { // another law
            char rest[2048];
            snprintf(rest, sizeof rest, "%s", at + strlen(cases[k].from));
            snprintf(at, sizeof text - (size_t)(at - text), "%s%s", cases[k].to, rest);
        }
        small_inputs_write(*state, "run.json", text, cases[k].given, "");
        RUN_PROGRAM(&result, "simulate", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_contains(result.out, cases[k].chosen);
        assert_null(strstr(result.out, "warning: time_step"));
        RUN_PROGRAM(&result, "simulate", "run.json", "-o", "out", "--force");
        assert_contains(result.err, cases[k].chosen);
        assert_close(results_number("out/used.json", "time_step"), cases[k].used, 1e-12);
        snprintf(given, sizeof given, "\"time_step\": %s,", cases[k].step);
        small_inputs_write(*state, "run.json", text, cases[k].given, given);
        RUN_PROGRAM(&result, "simulate", "run.json", "--explain");
        assert_null(strstr(result.out, "chosen: time step"));
        assert_null(strstr(result.out, "warning: time_step"));
        snprintf(given, sizeof given, "\"time_step\": %s,", cases[k].long_one);
        small_inputs_write(*state, "run.json", text, cases[k].given, given);
        RUN_PROGRAM(&result, "simulate", "run.json", "--explain");
        assert_contains(result.out, cases[k].doubt);
        RUN_PROGRAM(&result, "simulate", "run.json", "-o", "out", "--force");
        assert_contains(result.err, cases[k].doubt);
    }
}

/// What follows the forces of all, step by step, has no use for steps of the bonds' own; nor has a
/// file whose dynamics are given them.
static void test_bonds_take_no_steps_of_their_own_where_all_forces_are_followed(void **state) {
    static const char *const whole[] = {"\"shear_viscosity\": {\"every\": 1, \"lags\": 8}",
                                        "\"dynamics\": {\"integrator\": \"aboba\"}"};
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "run.json", scene, "\"time_step\": 0.003", whole[k]);
        small_inputs_change(*state, "run.json", "\"samples\": 1,", "\"samples\": 100,");
        RUN_PROGRAM(&result, "simulate", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_contains(result.out, "chosen: time step 0.006 ps: the distributions of bonds");
    }
}

/// The same step in a fit of molecules whose bonds have a law, explained and run.
static void test_long_time_step_of_molecules_is_doubted_in_fits(void **state) {
    static const char doubt[] = "warning: scene.time_step: 0.06 ps is 8.1 times as long as bonds, ";
    static const char fit[] =
        "{\"units\": \"nm-ps\", \"target\": {\"bond_angles\": {\"bend\": {\"file\":\n"
        "\"bend.tsv\"}}}, \"scene\": {\"box\": [4, 4, 4], \"temperature\": 298,\n"
        "\"particles\": {\"mass\": 18.015}, \"time_step\": STEP,\n"
        "\"bonds\": {\"bond\": {\"law\": \"harmonic\", \"k\": 5000, \"length\": 0.3}},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 60, \"cutoff\": 0.3},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 5, \"cutoff\": 0.3},\n"
        "\"molecules\": {\"chain\": {\"count\": 60, \"chain\": {\"type\": \"A\", \"length\": 3,\n"
        "\"bond\": \"bond\", \"angle\": \"bend\"}}}},\n"
        "\"method\": {\"name\": \"ibi\", \"iterations\": 1, \"samples\": 8, \"precision\": 1},\n"
        "\"verification\": {\"replicas\": 2, \"equilibration\": 1, \"samples\": 2, "
        "\"every\": 1}}\n";
    write_distribution(*state, "bend.tsv", 109, 3);
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "run.json", fit, "STEP", k ? "0.06" : "0.006");
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out, doubt) != NULL, k);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
        assert_int_equal(strstr(result.err, doubt) != NULL, k);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, small_inputs_leave)

int main(void) {
    if (getcwd(root, sizeof root) == NULL)
        return 1;
    const struct CMUnitTest tests[] = {
        TEST(test_numbers_that_no_liquid_has_are_doubted),
        TEST(test_time_step_of_a_scene_is_chosen_and_a_long_one_doubted),
        TEST(test_bonds_take_no_steps_of_their_own_where_all_forces_are_followed),
        TEST(test_long_time_step_of_molecules_is_doubted_in_fits),
        TEST(test_bonds_in_angstrom_and_angles_in_radians_are_doubted),
        TEST(test_potentials_that_hold_or_end_as_none_does_are_doubted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
