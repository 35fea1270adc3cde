// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit measure` on what formats do not say: a box that is told, masses of a topology, how many
// frames there are.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH = 1024 };

static struct run_program_result result;
static char xtc[PATH];

static void find_samples(void) {
    char folder[PATH / 2];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(xtc, PATH, "%s/tests/trajectories/water.xtc", folder);
}

#define MEASURE(...)                                                                               \
    do {                                                                                           \
        RUN_PROGRAM(&result, "measure", "--temperature", "300", __VA_ARGS__);                      \
        run_program_assert_code(&result, 0);                                                       \
    } while (0)

#define REFUSED(words, ...)                                                                        \
    do {                                                                                           \
        RUN_PROGRAM(&result, "measure", "--temperature", "300", __VA_ARGS__);                      \
        run_program_assert_code(&result, 2);                                                       \
        assert_contains(result.err, words);                                                        \
    } while (0)

/// The usual window is a tenth of the frames, however many bytes each has.
static void test_measure_has_the_same_window_when_frames_are_of_other_lengths(void **state) {
    enum { FRAMES = 201 };
    static const char *const names[] = {"even.xyz", "odd.xyz"};
    for (int odd = 0; odd < 2; odd++) {
        char text[FRAMES * 256];
        size_t length = 0;
        for (int k = 0; k < FRAMES; k++)
            length += (size_t)snprintf(
                text + length, sizeof text - length,
                "2\nLattice=\"30 0 0 0 30 0 0 0 30\" Properties=species:S:1:pos:R:3 Time=%d\n"
                "Ar %.*f 0 0\nAr %05.3f 0 0\n",
                1000 * k, odd && k == 0 ? 40 : 3, 5 + 0.005 * k, 9 - 0.005 * k);
        temporary_folder_write(*state, names[odd], text, length);
        MEASURE(names[odd], "-o", "of", "--quiet");
        assert_close(results_number("of/summary.json", "window"), 20, 1e-9);
    }
    MEASURE("even.xyz", "odd.xyz", "--every", "4", "-o", "of",
            "--quiet"); // 51 frames, the rest twice
    assert_close(results_number("of/summary.json", "window"), 40, 1e-9);
}

/// Of 20 atoms on a line, with a box of the file and one that is told.
static void test_measure_has_the_box_that_is_told(void **state) {
    static const char *const names[] = {"boxed.xyz", "bare.xyz", "film.xyz"};
    static const char *const comment[] = {
        "Lattice=\"30 0 0 0 30 0 0 0 40\" Properties=species:S:1:pos:R:3", "no box",
        "Lattice=\"30 0 0 0 30 0 0 0 90\" Properties=species:S:1:pos:R:3 pbc=\"T T F\""};
    for (int bare = 0; bare < 3; bare++) {
        char text[1 << 12];
        int length = snprintf(text, sizeof text, "20\n%s\n", comment[bare]);
        for (int k = 0; k < 20; k++)
            length += snprintf(text + length, sizeof text - (size_t)length, "Ar %g %g %g\n",
                               1.3 * k, 0.7 * k * k, 11.0 * k);
        temporary_folder_write(*state, names[bare], text, (size_t)length);
    }
    MEASURE("boxed.xyz", "--static", "-o", "boxed", "--quiet");
    MEASURE("bare.xyz", "--static", "--box", "3,3,4", "-o", "bare", "--quiet");
    MEASURE("film.xyz", "--static", "--box", "3,3,4", "-o", "film", "--quiet");
    results_assert_same("boxed", "bare", (const char *const[]){"rdf.tsv", NULL});
    results_assert_same("boxed", "film", (const char *const[]){"rdf.tsv", NULL});
    REFUSED("frame 0 is not periodic along vector c of its box: give a box that is, by --box",
            "film.xyz", "-o", "none");
    REFUSED("bare.xyz: frame 0 has no box: g(r) needs the volume and its images; give it by --box",
            "bare.xyz", "-o", "none");
    REFUSED("boxed.xyz: frame 0 has a box of its own: leave out --box", "boxed.xyz", "--box", "3",
            "-o", "none");
    static const char *const odd[] = {"3,4", "0", "3,3,", "3,3,3,3", "x", "3,-3,3", "inf"};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++)
        REFUSED("--box takes one length or three", "bare.xyz", "--box", odd[k], "-o", "none");
}

/// Water of 20 u, which no element is.
static void test_measure_has_masses_of_a_topology(void **state) {
    static const char topology[] = "[ atomtypes ]\nO 8 16 0 A 0 0\nH 1 2 0 A 0 0\n"
                                   "[ moleculetype ]\nW 2\n[ atoms ]\n"
                                   "1 O 1 WAT O 1\n2 H 1 WAT H 1\n3 H 1 WAT H 1\n"
                                   "[ molecules ]\nW 2744\n";
    temporary_folder_write(*state, "topol.top", topology, strlen(topology));
    MEASURE(xtc, "-s", "topol.top", "--static", "-o", "water");
    assert_contains(result.err, "WAT: 2744 beads of 3 atoms, the first of 20 u");
    assert_false(strstr(result.err, "guessed"));
    temporary_folder_write(*state, "few.top", topology, strlen(topology) - 3);
    REFUSED("water.xtc: has 8232 atoms", xtc, "-s", "few.top", "-o", "none");
    REFUSED("topol.top: has no coordinates: give it by -s", "topol.top", "-o", "none");
}

/// What a dump calls 1 and 2 are two types without a map, as a map makes of it.
static void test_measure_has_the_types_of_the_file(void **state) {
    char text[1 << 12];
    int length = snprintf(text, sizeof text,
                          "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n20\n"
                          "ITEM: BOX BOUNDS pp pp pp\n0 3\n0 3\n0 3\nITEM: ATOMS id type x y z\n");
    for (int k = 0; k < 20; k++)
        length += snprintf(text + length, sizeof text - (size_t)length, "%d %d %g %g %g\n", k + 1,
                           k < 8 ? 1 : 2, 0.13 * k, 0.07 * k * k, 1.1 * k);
    temporary_folder_write(*state, "two.dump", text, (size_t)length);
    static const char map[] = "{\"beads\": {\"1\": {\"first\": 1, \"last\": 8, \"size\": 1}, "
                              "\"2\": {\"first\": 9, \"last\": 20, \"size\": 1}}}\n";
    temporary_folder_write(*state, "map.json", map, strlen(map));
    MEASURE("two.dump", "--file-units", "nano", "--static", "-o", "without");
    assert_contains(result.err, "2: 12 beads of 1 atom");
    MEASURE("two.dump", "--file-units", "nano", "--static", "--map", "map.json", "-o", "by_map");
    results_assert_same("without", "by_map",
                        (const char *const[]){"rdf_1-1.tsv", "rdf_1-2.tsv", "rdf_2-2.tsv", NULL});
    assert_false(temporary_folder_exists("without/rdf.tsv"));
}

/// A range that nobody gave goes by the least box, wherever in the file it is: 0.45 of it.
static void test_measure_has_a_range_by_the_least_box(void **state) {
    static const double edge[] = {40, 39, 30, 38, 20, 22};
    char text[1 << 13];
    int length = 0;
    for (size_t f = 0; f < sizeof edge / sizeof *edge; f++) {
        length += snprintf(text + length, sizeof text - (size_t)length,
                           "20\nLattice=\"%g 0 0 0 50 0 0 0 60\" Properties=species:S:1:pos:R:3 "
                           "Time=%zu\n",
                           edge[f], 1000 * f);
        for (int k = 0; k < 20; k++)
            length += snprintf(text + length, sizeof text - (size_t)length, "Ar %g %g %g\n",
                               1.3 * k, 0.7 * k * k, 11.0 * k + edge[f]);
    }
    temporary_folder_write(*state, "shrinking.xyz", text, (size_t)length);
    MEASURE("shrinking.xyz", "--static", "-o", "usual");
    assert_contains(result.err, "g(r) to 0.9 nm in 90 bins");
    assert_close(results_number("usual/summary.json", "frames"), 6, 1e-9);
    MEASURE("shrinking.xyz", "--static", "--range", "0.9", "-o", "told", "--quiet");
    results_assert_same("usual", "told",
                        (const char *const[]){"rdf.tsv", "structure_factor.tsv", NULL});
    // In time, escapes are followed no further either: 0.9 of half the least box.
    MEASURE("shrinking.xyz", "--begin", "0", "-o", "moving");
    assert_contains(result.err, "g(r) to 0.9 nm in 90 bins");
    assert_contains(result.err, "escape times of pairs from 0.45 to 0.9 nm");
    REFUSED("frame 4: the range of g(r), 1.5 nm, is beyond half the shortest height",
            "shrinking.xyz", "--static", "--range", "1.5", "-o", "none");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_measure_has_the_same_window_when_frames_are_of_other_lengths),
        TEST(test_measure_has_the_box_that_is_told),
        TEST(test_measure_has_a_range_by_the_least_box),
        TEST(test_measure_has_masses_of_a_topology),
        TEST(test_measure_has_the_types_of_the_file),
    };
    find_samples();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
