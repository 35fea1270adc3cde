// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit measure` on what is no box, no line and no place, on so few beads that tables would
// have no number, and on frames before equilibrium.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 3, TEXT_SIZE = 1 << 16 };

static struct run_program_result result;

/// A dump of atoms at k/10 nm along the diagonal, which stay; `bounds` are those of each axis.
static void write_dump(struct temporary_folder *folder, const char *bounds, int atoms,
                       const char *first_x, const char *first_type) {
    char text[TEXT_SIZE] = "";
    size_t length = 0;
    for (int t = 0; t < FRAMES; t++) {
        length += (size_t)snprintf(
            text + length, TEXT_SIZE - length,
            "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS pp pp pp\n%s\n%s\n%s\n"
            "ITEM: ATOMS id element x y z\n",
            t, atoms, bounds, "0 3", "0 3");
        for (int k = 0; k < atoms; k++) {
            char x[32];
            snprintf(x, sizeof x, "%g", 0.1 * k);
            length += (size_t)snprintf(text + length, TEXT_SIZE - length, "%d %s %s %g %g\n", k + 1,
                                       k ? "B" : first_type, k ? x : first_x, 0.1 * k, 0.1 * k);
        }
    }
    temporary_folder_write(folder, "a.dump", text, length);
}

static void run(void) {
    RUN_PROGRAM(&result, "measure", "a.dump", "--file-units", "nano", "--file-time-step", "0.1",
                "--range", "1", "-o", "out");
}

static void assert_refused(const char *words) {
    run();
    run_program_assert_code(&result, 2);
    assert_contains(result.err, words);
    assert_false(temporary_folder_exists("out/summary.json"));
}

static void test_boxes_and_places_that_are_none_are_refused(void **state) {
    write_dump(*state, "3 0", 20, "0", "B");
    assert_refused("a.dump: frame 0: edge 1 of the box is -3 nm");
    write_dump(*state, "0 3", 20, "1e300", "B");
    assert_refused("a.dump: frame 0: bead 1 is 3.33e+299 boxes away");
    write_dump(*state, "0 3", 20, "9e7", "B"); // of 2^19 boxes 5.7e7 are too many
    assert_refused("boxes away, so that its place in a box is lost");
    write_dump(*state, "0 3", 20, "-3e5", "B");
    run();
    run_program_assert_code(&result, 0);
}

static void test_atoms_of_a_plane_are_refused(void **state) {
    for (int many = 0; many < 2; many++) { // two beads are in a plane whatever they are
        const int edge = many ? 4 : 2, step = many ? 1 : 3;
        char text[TEXT_SIZE];
        size_t length = (size_t)snprintf(
            text, sizeof text, "%d\nLattice=\"30 0 0 0 30 0 0 0 10\" Time=0\n", many ? 16 : 2);
        for (int k = 0; k < edge * edge; k += step)
            length += (size_t)snprintf(text + length, sizeof text - length, "A %g %g 0.5\n",
                                       30.0 * (k % edge) / edge, 30.0 * (k / edge) / edge);
        temporary_folder_write(*state, "a.xyz", text, length);
        RUN_PROGRAM(&result, "measure", "a.xyz", "-o", "out", "--force", "--range", "0.4");
        run_program_assert_code(&result, many ? 2 : 0);
    }
    assert_contains(result.err, "a.xyz: frame 0: all atoms lie in one plane");
}

static void test_times_that_are_none_are_refused(void **state) {
    static const char *const time[] = {"1e300", "-1e300"};
    static const char frames[] =
        "3\nLattice=\"3 0 0 0 3 0 0 0 3\" Time=0\nA 0 0 0\nA 1 1 1\nA 2 2 2\n"
        "3\nLattice=\"3 0 0 0 3 0 0 0 3\" Time=TIME\nA 0 0 0\nA 1 1 1\nA 2 2 2\n";
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "a.xyz", frames, "TIME", time[k]);
        RUN_PROGRAM(&result, "measure", "a.xyz", "--file-units", "nano", "-o", "out");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, "a.xyz: frame 1: its time is");
        assert_false(temporary_folder_exists("out/summary.json"));
    }
}

static void test_lines_of_old_macs_are_refused(void **state) {
    write_dump(*state, "0 3", 20, "0", "B");
    char *text = temporary_folder_read("a.dump");
    for (char *at = text; (at = strchr(at, '\n')); at++)
        *at = '\r';
    temporary_folder_write(*state, "a.dump", text, strlen(text));
    free(text);
    assert_refused("a.dump:1: frame 0: lines end with CR alone");
}

static void test_tables_without_a_number_are_not_written(void **state) {
    write_dump(*state, "0 3", 1, "0", "B");
    assert_refused("a.dump: there is a single bead");
    write_dump(*state, "0 3", 20, "0", "A");
    small_inputs_write(*state, "map.json",
                       "{\"beads\": {\"A\": {\"first\": 1, \"last\": 1, \"size\": 1}, "
                       "\"B\": {\"first\": 2, \"last\": 20, \"size\": 1}}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "measure", "a.dump", "--file-units", "nano", "--file-time-step", "0.1",
                "--range", "1", "--map", "map.json", "-o", "mixed");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "warning: there is no pair A-A, and so no g(r) of it");
    assert_false(temporary_folder_exists("mixed/rdf_A-A.tsv"));
    assert_true(temporary_folder_exists("mixed/rdf_A-B.tsv"));
    char *target = temporary_folder_read("mixed/target.json");
    assert_null(strstr(target, "A-A"));
    assert_contains(target, "rdf_B-B.tsv");
    free(target);
    write_dump(*state, "0 30", 2, "15", "B"); // far apart
    run();
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "warning: no escape times: no pair was between");
    assert_false(temporary_folder_exists("out/etd.tsv"));
    target = temporary_folder_read("out/target.json");
    assert_null(strstr(target, "etd"));
    free(target);
}

enum { ATOMS = 60, SHOTS = 80 };

static bool in_beginning(int atom, int frame) {
    (void)atom;
    return frame < 10;
}

static bool along_all(int atom, int frame) {
    return atom * SHOTS >= frame * ATOMS;
}

static bool late(int atom, int frame) {
    (void)atom;
    return frame < 48;
}

/// Atoms at places of a multiplicative generator (D. H. Lehmer); those that are compressed are in
/// half of the box along x.
static void write_compressed(struct temporary_folder *folder,
                             bool (*is_compressed)(int atom, int frame)) {
    char *text = malloc(SHOTS * (ATOMS + 2) * 48);
    size_t length = 0;
    uint64_t random = 12345;
    for (int t = 0; t < SHOTS; t++) {
        length += (size_t)sprintf(text + length,
                                  "%d\nLattice=\"30 0 0 0 30 0 0 0 30\" "
                                  "Properties=species:S:1:pos:R:3 Time=%d\n",
                                  ATOMS, 1000 * t);
        for (int k = 0; k < ATOMS; k++) {
            double place[3];
            for (int d = 0; d < 3; d++) {
                random = random * 48271 % 2147483647;
                place[d] = 30 * (double)random / 2147483647;
            }
            length +=
                (size_t)sprintf(text + length, "Ar %.3f %.3f %.3f\n",
                                is_compressed(k, t) ? place[0] / 2 : place[0], place[1], place[2]);
        }
    }
    temporary_folder_write(folder, "box.xyz", text, length);
    free(text);
}

static void test_frames_before_equilibrium_are_left_out(void **state) {
    write_compressed(*state, in_beginning);
    RUN_PROGRAM(&result, "measure", "box.xyz", "--static", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, " of 80 frames are not in equilibrium (pairs at ");
    const double left_out = results_number("out/summary.json", "frames_left_out");
    assert_true(left_out >= 8 && left_out <= 16);
    assert_true(results_number("out/summary.json", "frames") == 80 - left_out);
    RUN_PROGRAM(&result, "measure", "box.xyz", "--static", "--begin", "0", "-o", "all");
    assert_contains(result.err, "frames are not in equilibrium (pairs at ");
    assert_contains(result.err, "--begin leaves them out");
    assert_true(results_number("all/summary.json", "frames") == 80);
    RUN_PROGRAM(&result, "measure", "box.xyz", "--static", "--begin", "10", "-o", "rest");
    assert_null(strstr(result.err, "equilibrium"));
    RUN_PROGRAM(&result, "measure", "box.xyz", "--static", "--units", "angstrom-fs", "-o", "other");
    assert_contains(result.err, " angstrom) and are left out");
}

/// Atoms that spread one after the other until the end, which no half that is left out mends, or
/// all at 60 % of the frames.
static void test_frames_that_never_settle_are_told_with_what_changes(void **state) {
    static bool (*const ways[])(int atom, int frame) = {along_all, late};
    for (int k = 0; k < 2; k++) {
        write_compressed(*state, ways[k]);
        RUN_PROGRAM(&result, "measure", "box.xyz", "--static", "-o", k ? "late" : "all");
        run_program_assert_code(&result, 0);
        char *summary = temporary_folder_read(k ? "late/summary.json" : "all/summary.json");
        const char *warning = k ? "the trajectory is not in equilibrium: pairs at "
                                : "80 frames were not in equilibrium (pairs at ";
        assert_contains(result.err, warning);
        assert_contains(summary, warning);
        free(summary);
    }
}

#define AT(x)                                                                                      \
    "at once t= 0.0\n2\n    1AR     AR    1   0.500   0.500   0.500\n    2AR     AR    2   " x     \
    "   0.500   0.500\n   2.00000   2.00000   2.00000\n"

/// Configurations that are independent have no order in time; those of a run that was begun again
/// have.
static void test_frames_of_one_time_are_used_when_they_are_independent(void **state) {
    small_inputs_write(*state, "one.gro", AT("0.900") AT("0.950"), NULL, NULL);
    small_inputs_write(*state, "two.gro", AT("0.800"), NULL, NULL);
    RUN_PROGRAM(&result, "measure", "one.gro", "two.gro", "--static", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_true(results_number("out/summary.json", "frames") == 3);
    assert_null(strstr(result.err, "is given twice"));
    RUN_PROGRAM(&result, "measure", "one.gro", "two.gro", "./one.gro", "--static", "-o", "twice");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "warning: ./one.gro is given twice: frames that count twice make");
    RUN_PROGRAM(&result, "measure", "one.gro", "two.gro", "-o", "in-time", "--quiet");
    run_program_assert_code(&result, 0);
    assert_true(results_number("in-time/summary.json", "frames") == 1);
    assert_contains(result.err, "mesofit: warning: one.gro: 1 frames of times that had been were "
                                "left out, half of them or more; --static uses");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_boxes_and_places_that_are_none_are_refused),
        TEST(test_atoms_of_a_plane_are_refused),
        TEST(test_times_that_are_none_are_refused),
        TEST(test_lines_of_old_macs_are_refused),
        TEST(test_tables_without_a_number_are_not_written),
        TEST(test_frames_before_equilibrium_are_left_out),
        TEST(test_frames_that_never_settle_are_told_with_what_changes),
        TEST(test_frames_of_one_time_are_used_when_they_are_independent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
