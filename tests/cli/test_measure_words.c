// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `mesofit measure` says where a person is likely to be wrong: units, temperatures, types by
// their numbers, formats that other programs convert.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { ATOMS = 60, FRAMES = 30, TEXT = 1 << 20 };

static struct run_program_result result;

static double chance(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) * 0x1p-24;
}

/// A number of mean 0 and variance 1.
static double normal(unsigned *seed) {
    double sum = -6;
    for (int k = 0; k < 12; k++)
        sum += chance(seed);
    return sum;
}

/// Argon at 300 K in a cube of 20 Å, whatever box is told, in LAMMPS's units real: sqrt(k_B T/m) is
/// 2.4988e-3 Å/fs.
/// @param[in] shrink  of the box from frame to frame [Å]
/// @param[in] second  element and mass that every second atom is said to have
static void write_beside(struct temporary_folder *folder, double box, double shrink,
                         const char *second) {
    static char text[TEXT];
    size_t length = 0;
    unsigned seed = 5;
    for (int t = 0; t < FRAMES; t++) {
        length +=
            (size_t)snprintf(text + length, TEXT - length,
                             "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS "
                             "pp pp pp\n0 %g\n0 %g\n0 %g\nITEM: ATOMS id type element mass x "
                             "y z vx vy vz\n",
                             t, ATOMS, box - t * shrink, box - t * shrink, box - t * shrink);
        for (int k = 0; k < ATOMS; k++)
            length +=
                (size_t)snprintf(text + length, TEXT - length, "%d %d %s %g %g %g %g %g %g\n",
                                 k + 1, 1 + k % 2, k % 2 ? second : "Ar 39.948", 20 * chance(&seed),
                                 20 * chance(&seed), 20 * chance(&seed), 2.4988e-3 * normal(&seed),
                                 2.4988e-3 * normal(&seed), 2.4988e-3 * normal(&seed));
    }
    temporary_folder_write(folder, "a.dump", text, length);
}

static void write_argon_in(struct temporary_folder *folder, double box, double shrink) {
    write_beside(folder, box, shrink, "Ar 39.948");
}

static void write_argon(struct temporary_folder *folder) {
    write_argon_in(folder, 20, 0);
}

#define MEASURE(...)                                                                               \
    do {                                                                                           \
        RUN_PROGRAM(&result, "measure", "a.dump", "--q-range", "0", "--force", "-o", "out",        \
                    __VA_ARGS__);                                                                  \
        run_program_assert_code(&result, 0);                                                       \
    } while (0)

static void assert_without(const char *words) {
    if (strstr(result.err, words))
        fail_msg("\"%s\" in:\n%s", words, result.err);
}

static void test_a_temperature_that_velocities_have_not(void **state) {
    write_argon(*state);
    MEASURE("--file-units", "real", "--file-time-step", "0.01", "--temperature", "400");
    assert_contains(result.err,
                    "warning: --temperature 400, but the velocities of the beads have ");
    MEASURE("--file-units", "real", "--file-time-step", "0.01", "--temperature", "302");
    assert_without("warning: --temperature");
    assert_without("other units?");
}

static void test_types_of_different_temperatures(void **state) {
    write_beside(*state, 20, 0, "Kr 83.798");
    MEASURE("--file-units", "real", "--file-time-step", "0.01");
    assert_contains(result.err, "warning: by velocities and masses Ar has ");
    assert_contains(result.err, "is a mass wrong, or are some held");
    write_beside(*state, 20, 0, "Kr 41");
    MEASURE("--file-units", "real", "--file-time-step", "0.01");
    assert_without("by velocities and masses");
}

/// Drift is no heat, and a bead with half of all mass has half of a bead's freedom.
static void test_types_that_drift_together(void **state) {
    static char text[TEXT];
    static const double heat = 0.015794; // sqrt(k_B T) at 300 K [Å/fs sqrt(u)]
    size_t length = 0;
    unsigned seed = 3;
    for (int t = 0; t < FRAMES; t++) {
        double momentum = 0, v[ATOMS][3];
        for (int d = 0; d < 3; d++, momentum = 0) {
            for (int k = 0; k < ATOMS; k++) {
                const double mass = k == 0 ? 2000 : 40;
                v[k][d] = normal(&seed) * heat / sqrt(mass);
                momentum += mass * v[k][d];
            }
            for (int k = 0; k < ATOMS; k++)
                v[k][d] += 0.01 - momentum / (2000 + 40 * (ATOMS - 1));
        }
        length +=
            (size_t)snprintf(text + length, TEXT - length,
                             "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS "
                             "pp pp pp\n0 20\n0 20\n0 20\nITEM: ATOMS id element mass x y z vx "
                             "vy vz\n",
                             t, ATOMS);
        for (int k = 0; k < ATOMS; k++)
            length +=
                (size_t)snprintf(text + length, TEXT - length, "%d %s %d %d %d %g %.8g %.8g %.8g\n",
                                 k + 1, k == 0 ? "Au" : "Ar", k == 0 ? 2000 : 40, k % 4 * 5,
                                 k / 4 % 4 * 5, k / 16 * 5.0, v[k][0], v[k][1], v[k][2]);
    }
    temporary_folder_write(*state, "a.dump", text, length);
    MEASURE("--file-units", "real", "--file-time-step", "0.01");
    assert_without("by velocities and masses");
}

/// Sixty beads have 300 K within a tenth: no temperature for a potential.
static void test_one_frame_of_few_beads_tells_no_temperature(void **state) {
    write_argon(*state);
    MEASURE("--file-units", "real", "--end", "0", "--file-time-step", "0.01");
    assert_contains(result.err, "there is one frame");
    assert_contains(result.err, "unknown temperature (the velocities of one frame do not tell it");
}

/// D of two windows has no error, and is no target.
static void test_three_frames_are_a_target(void **state) {
    write_argon(*state);
    MEASURE("--file-units", "real", "--end", "0.02", "--file-time-step", "0.01");
    assert_contains(result.err, "3 frames of");
    RUN_PROGRAM(&result, "fit", "--target", "out", "--explain");
    run_program_assert_code(&result, 0);
}

static void test_units_that_cannot_be(void **state) {
    write_argon(*state);
    MEASURE("--file-units", "lj", "--static", "--range", "2", "--bins", "10");
    assert_contains(result.err, "a.dump: units lj: 1 is taken as 1 nm, 1 ps and 1 u, so that "
                                "k_B T = 1 is 120.272 K");
    assert_without("in a nm^3");
    assert_contains(result.err, "warning: --file-units lj make velocities of 0.0");
    MEASURE("--file-units", "micro", "--static", "--range", "2", "--bins", "10");
    assert_contains(result.err, "warning: --file-units micro make 7.5e-12 beads in a nm^3: is the "
                                "file in other units?");
    MEASURE("--file-units", "metal", "--file-time-step", "0.01");
    assert_contains(result.err, "warning: --file-units metal make velocities of ");
}

/// Places are taken modulo the box, whichever it is.
static void test_boxes_that_are_not_those_of_the_atoms(void **state) {
    static const char *const said[] = {NULL, "a.dump: in its first frame atoms spread over 1.",
                                       "a.dump: in its first frame atoms fill 0.0"};
    static const double boxes[] = {20, 12, 200};
    for (int k = 0; k < 3; k++) {
        write_argon_in(*state, boxes[k], 0);
        MEASURE("--file-units", "real", "--static", "--temperature", "300", "--range", "0.5");
        if (said[k])
            assert_contains(result.err, said[k]);
        else
            assert_without("first frame");
    }
}

/// Argon on a lattice, 4 Å apart, in LAMMPS's units real, that moves by 0.07 Å from frame to frame,
/// by the same velocities in all of them.
static void write_solid(struct temporary_folder *folder) {
    enum { SIDE = 4 };
    static char text[TEXT];
    size_t length = 0;
    unsigned seed = 7;
    for (int t = 0; t < FRAMES; t++) {
        unsigned same = 11;
        length += (size_t)snprintf(text + length, TEXT - length,
                                   "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX "
                                   "BOUNDS pp pp pp\n0 16\n0 16\n0 16\nITEM: ATOMS id type mass x "
                                   "y z vx vy vz\n",
                                   t, SIDE * SIDE * SIDE);
        for (int k = 0; k < SIDE * SIDE * SIDE; k++)
            length += (size_t)snprintf(
                text + length, TEXT - length, "%d 1 39.948 %g %g %g %g %g %g\n", k + 1,
                4 * (k % SIDE) + 0.1 * chance(&seed), 4 * (k / SIDE % SIDE) + 0.1 * chance(&seed),
                4.0 * (k / SIDE / SIDE) + 0.1 * chance(&seed), 2.4988e-3 * normal(&same),
                2.4988e-3 * normal(&same), 2.4988e-3 * normal(&same));
    }
    temporary_folder_write(folder, "a.dump", text, length);
}

static void test_motion_that_velocities_contradict(void **state) {
    static const char *const step[] = {"0.00001", "0.015", "100"};
    write_solid(*state);
    for (int k = 0; k < 3; k++) {
        MEASURE("--file-units", "real", "--file-time-step", step[k], "--temperature", "300");
        if (k == 1)
            assert_without("velocities carry them");
        else
            assert_contains(result.err, " times as far as their velocities carry them in ");
    }
    assert_contains(result.err,
                    "in 100 ps: is --file-time-step (ps), or that of places, in another "
                    "unit?");
}

static void test_pairs_as_close_as_in_a_liquid_that_is_as_light_as_a_gas(void **state) {
    write_solid(*state);
    MEASURE("--file-units", "nm-ps", "--static", "--temperature", "300");
    assert_contains(result.err, "warning: pairs are at 4");
    assert_contains(result.err, " nm, as close as in a liquid of so many beads, but it has 0.001 "
                                "g/cm^3: are places and box in another unit?");
    MEASURE("--file-units", "real", "--static", "--temperature", "300");
    assert_without("as close as in a liquid");
    MEASURE("--file-units", "lj", "--static", "--temperature", "300");
    assert_without("as close as in a liquid");
}

/// Frames are read again where a later box is too small for the range that the first one has.
static void test_what_the_first_frame_shows_is_told_once(void **state) {
    static const char words[] = "in its first frame atoms fill ";
    write_argon_in(*state, 200, 2);
    MEASURE("--file-units", "real", "--static", "--temperature", "300");
    const char *first = strstr(result.err, words);
    assert_non_null(first);
    assert_null(strstr(first + 1, words));
}

/// Rows of LAMMPS are other atoms in each frame, unless ids tell which.
static void test_motion_of_rows_that_may_be_any_atoms(void **state) {
    static const char words[] = "mesofit: warning: no ids tell atoms apart: MSD, D, escape times "
                                "and VACF take each row for one atom";
    write_argon(*state);
    MEASURE("--file-units", "real", "--file-time-step", "0.01", "--quiet");
    assert_without(words);
    char *const text = temporary_folder_read("a.dump");
    for (char *at = text; (at = strstr(at, "ATOMS id "));)
        memcpy(at, "ATOMS no ", 9);
    temporary_folder_write(*state, "a.dump", text, strlen(text));
    free(text);
    MEASURE("--file-units", "real", "--file-time-step", "0.01", "--quiet");
    assert_contains(result.err, words);
    MEASURE("--file-units", "real", "--file-time-step", "0.01", "--quiet", "--static");
    assert_without(words);
}

/// A temperature takes no times.
static void test_velocities_without_times(void **state) {
    write_argon(*state);
    MEASURE("--file-units", "real", "--static", "--temperature", "400");
    assert_contains(result.err,
                    "warning: --temperature 400, but the velocities of the beads have ");
    MEASURE("--file-units", "real", "--static", "--temperature", "302");
    assert_without("warning: --temperature");
    MEASURE("--file-units", "real", "--static");
    assert_contains(result.err, " K by the velocities of the beads");
}

static void test_a_temperature_that_nothing_tells(void **state) {
    static const char frame[] = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp "
                                "pp pp\n0 20\n0 20\n0 20\nITEM: ATOMS id type element x y z\n1 1 "
                                "Ar 1 2 3\n2 1 Ar 9 2 3\n3 1 Ar 5 9 17\n";
    small_inputs_write(*state, "a.dump", frame, NULL, NULL);
    MEASURE("--file-units", "real", "--static");
    assert_contains(result.err, "unknown temperature (there are no velocities): give it by "
                                "--temperature");
    assert_contains(result.err, "next: mesofit fit --target out --temperature T finds the ");
    RUN_PROGRAM(&result, "fit", "--target", "out", "-o", "fit");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "out/target.json: scene.temperature: missing: expected a number "
                                "(K), as fit --target DIR takes it by --temperature");
    // What is no number is not missing.
    small_inputs_write(*state, "run.json",
                       "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\"file\": "
                       "\"out/rdf.tsv\"}}, \"scene\": {\"density\": 3, "
                       "\"temperature\": \"300 K\"}}",
                       NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "scene.temperature: expected a number, found the text \"300 K\"");
    assert_without("missing");
}

/// Atoms are called Ar, types X and Y: LAMMPS's numbers are all that there is.
static void test_types_by_their_numbers(void **state) {
    static const char types[] = "{\"particles\": {\"types\": {\"X\": 3, \"Y\": 3}},\n"
                                "\"molecules\": {\"one\": {\"count\": 1, \"beads\": [\"X\"]}}}\n";
    write_argon(*state);
    small_inputs_write(*state, "scene.json", types, NULL, NULL);
    MEASURE("--file-units", "real", "--static", "--temperature", "300", "--molecules",
            "scene.json");
    assert_contains(result.err, "scene.json: atoms \"Ar\" of type number 1 are beads \"X\", the "
                                "type of that number: no type is called \"Ar\"");
    assert_contains(result.err, "\"Ar\" of type number 2 are beads \"Y\"");
}

/// Where one type is called as atoms are, names tell all: krypton is no third argon by its number.
static void test_types_by_their_names(void **state) {
    static const char frame[] = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp "
                                "pp pp\n0 20\n0 20\n0 20\nITEM: ATOMS id type element x y z\n1 1 "
                                "Kr 1 2 3\n2 2 Ar 9 2 3\n3 2 Ar 5 9 17\n";
    static const char types[] = "{\"particles\": {\"types\": {\"Ar\": 2}},\n"
                                "\"molecules\": {\"one\": {\"count\": 1, \"beads\": [\"Ar\"]}}}\n";
    small_inputs_write(*state, "a.dump", frame, NULL, NULL);
    small_inputs_write(*state, "scene.json", types, NULL, NULL);
    RUN_PROGRAM(&result, "measure", "a.dump", "--file-units", "real", "--static", "--molecules",
                "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "no type has the name of atom 1, \"Kr\"; add it to "
                                "\"particles.types\", or map atoms to beads by --map");
}

/// A line that a shell takes as it is.
static void test_names_with_blanks_are_quoted(void **state) {
    temporary_folder_write(*state, "it's mine.tpr", "\0\0\0\15\0\0\0\14VERSION 2020", 20);
    RUN_PROGRAM(&result, "measure", "it's mine.tpr", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "\"gmx editconf -f 'it'\\''s mine.tpr' -o conf.gro\"");
}

static void test_a_pipe_says_not_what_its_atoms_are(void **state) {
    (void)state;
    assert_int_equal(mkfifo("pipe.dump", 0600), 0);
    RUN_PROGRAM(&result, "measure", "pipe.dump", "--file-units", "real", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err,
                    "pipe.dump: a pipe is read once: say what its atoms are by -s FILE");
}

static void test_the_next_command_is_told(void **state) {
    write_argon(*state);
    MEASURE("--file-units", "real", "--temperature", "300", "--static");
    assert_contains(result.err, "next: mesofit fit --target out finds the potential of pairs\n");
    MEASURE("--file-units", "real", "--file-time-step", "0.01", "--temperature", "300", "--window",
            "0.1");
    assert_contains(result.err, "finds the potential of pairs, then omega, the friction (measured "
                                "with --static: no omega)\n");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_temperature_that_velocities_have_not),
        TEST(test_types_of_different_temperatures),
        TEST(test_types_that_drift_together),
        TEST(test_one_frame_of_few_beads_tells_no_temperature),
        TEST(test_three_frames_are_a_target),
        TEST(test_units_that_cannot_be),
        TEST(test_boxes_that_are_not_those_of_the_atoms),
        TEST(test_motion_that_velocities_contradict),
        TEST(test_pairs_as_close_as_in_a_liquid_that_is_as_light_as_a_gas),
        TEST(test_what_the_first_frame_shows_is_told_once),
        TEST(test_motion_of_rows_that_may_be_any_atoms),
        TEST(test_velocities_without_times),
        TEST(test_a_temperature_that_nothing_tells),
        TEST(test_types_by_their_numbers),
        TEST(test_types_by_their_names),
        TEST(test_names_with_blanks_are_quoted),
        TEST(test_a_pipe_says_not_what_its_atoms_are),
        TEST(test_the_next_command_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
