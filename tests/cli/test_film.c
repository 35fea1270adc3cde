// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit film`: frames read back from snapshots of both formats, a GIF of all of them, and what
// ffmpeg makes of it. The ffmpeg here is a script, so that it does not matter whether there is one.
#include "report/film_frame.h"
#include "shared/gif.h"
#include "shared/is_close.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define SNAPSHOTS                                                                                  \
    "\"measure\": {\"equilibration\": 0, \"samples\": 4, \"every\": 5}, \"snapshots\": "           \
    "{\"every\": 5, \"formats\": [\"vtp\", \"json\"]"
static const char plan[] = "\"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1}";

static const char solvent[] =
    "{\"seed\": 1, \"dimensions\": 2, \"box\": [20, 5], \"particles\": {\"count\": 0}, "
    "\"temperature\": 1, \"time_step\": 0.1, \"dynamics\": {\"integrator\": "
    "\"collision-dynamics\", \"particles_per_cell\": 4, \"angle\": 90}, " SNAPSHOTS
    ", \"solvent\": \"yes\"}}";

static void simulate(struct temporary_folder *folder, const char *text, const char *from,
                     const char *to) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", text, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force");
    run_program_assert_code(&result, 0);
}

/// Put a program that does so before all others; another time it is another.
static void use_ffmpeg(const char *does) {
    static char before[4096];
    char path[8192], here[4096];
    if (before[0] == '\0')
        snprintf(before, sizeof before, "%s", getenv("PATH"));
    FILE *script = fopen("ffmpeg", "w");
    assert_non_null(script);
    fprintf(script, "#!/bin/sh\n%s\n", does);
    fclose(script);
    assert_int_equal(chmod("ffmpeg", 0755), 0);
    assert_non_null(realpath(".", here));
    snprintf(path, sizeof path, "%s:%s", here, before);
    setenv("PATH", path, 1);
}

static int pictures(const char *file) {
    struct gif gif = gif_read(file);
    const int count = gif.pictures;
    gif_clear(&gif);
    return count;
}

static void assert_same(const double *a, const double *b, size_t count) {
    for (size_t k = 0; k < count; k++)
        assert_close(a[k], b[k], 1e-12);
}

/// The two formats are read by two readers, and hold the same.
static void check_formats(const char *colour, size_t count) {
    struct film_frame vtp, json;
    assert_ok(mf_film_frame_read(&vtp, "out/snapshots/step_000000010.vtp", colour));
    assert_ok(mf_film_frame_read(&json, "out/snapshots/step_000000010.json", colour));
    assert_int_equal(vtp.count, count);
    assert_int_equal(json.count, count);
    assert_close(vtp.time, json.time, 1e-12);
    assert_same(vtp.box, json.box, 3);
    assert_same(vtp.position, json.position, 3 * count);
    assert_same(vtp.colour, json.colour, count);
    double largest = 0;
    for (size_t k = 0; k < count; k++)
        largest = fmax(largest, fabs(vtp.position[3 * k]));
    assert_true(largest > 0.8 * vtp.box[0] && largest <= vtp.box[0]);
    mf_film_frame_clear(&vtp);
    mf_film_frame_clear(&json);
}

static void test_frames_of_both_formats_are_the_same(void **state) {
    simulate(*state, small_inputs_scene, plan, SNAPSHOTS "}");
    check_formats("speed", 81);
    simulate(*state, solvent, NULL, NULL);
    check_formats("speed", 400);
}

/// A picture for each snapshot, and the first and the last of fewer.
static void test_film_has_a_picture_for_each_snapshot(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    use_ffmpeg("exit 1");
    simulate(*state, small_inputs_scene, plan, SNAPSHOTS "}");
    RUN_PROGRAM(&result, "film", "out");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "out/figures/film.gif\n");
    assert_contains(result.err, "5 frames in ");
    assert_int_equal(pictures("out/figures/film.gif"), 5);
    RUN_PROGRAM(&result, "film", "out", "--frames", "2", "--colour", "type");
    assert_int_equal(pictures("out/figures/film.gif"), 2);
    simulate(*state, solvent, NULL, NULL);
    RUN_PROGRAM(&result, "film", "out", "--frames", "3");
    run_program_assert_code(&result, 0);
    assert_int_equal(pictures("out/figures/film.gif"), 3);
}

/// With ffmpeg there is its film alone; what a person put in its place stays.
static void test_ffmpeg_makes_it_a_film(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    use_ffmpeg("cp film.gif film.mp4");
    simulate(*state, small_inputs_scene, plan, SNAPSHOTS "}");
    RUN_PROGRAM(&result, "film", "out");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "out/figures/film.mp4\n");
    assert_false(temporary_folder_exists("out/figures/film.gif"));
    FILE *own = fopen("out/figures/film.mp4", "w");
    fputs("a film of mine", own);
    fclose(own);
    RUN_PROGRAM(&result, "film", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "film.mp4");
    RUN_PROGRAM(&result, "film", "out", "--force");
    run_program_assert_code(&result, 0);
}

/// Two beads that are bonded, of two types, and two beside opposite edges, in a box of 10 by 10.
static const char beads[] =
    "{\"time\": 1, \"box\": [10, 10], \"particles\": {\"type\": [\"A\", \"A\", \"A\", \"B\"], "
    "\"x\": [3, 0.5, 9.5, 5], \"y\": [5, 2, 2, 5], \"radius\": [0.2, 0.2, 0.2, 0.2]}}";
static const char types[] = "# types: A 3 B 1\n# x\ty\n3\t5\n0.5\t2\n9.5\t2\n5\t5\n";
static const char bonds[] = "# first\tsecond\n1\t4\n2\t3\n1\t900\n";

enum { BLUE = 0x0072b2, RED = 0xd55e00, WHITE = 0xffffff };

/// What is seen there, where the box is 600 pixels wide; of the film of the beads.
static uint32_t seen_at(double x, double y) {
    struct gif gif = gif_read("beads/figures/film.gif");
    const int column = 20 + (int)(60 * x), row = 40 + (int)(60 * (10 - y));
    assert_true(column < gif.width && row < gif.height);
    const uint32_t colour = gif.pixel[row * gif.width + column];
    gif_clear(&gif);
    return colour;
}

static void film_beads(const char *const more[2]) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "film", "beads", "--quiet", more[0], more[1]);
    run_program_assert_code(&result, 0);
}

/// Types in the colours of figures; each half of a bond has that of its bead, also across an edge
/// of the box; what is hidden is not there, nor are its bonds.
static void test_bonds_are_drawn_between_beads_that_are_shown(void **state) {
    static const char *const none[2] = {NULL, NULL}, *const hide[2] = {"--hide", "B"};
    small_inputs_need_gnuplot();
    use_ffmpeg("exit 1");
    mkdir("beads", 0777);
    mkdir("beads/snapshots", 0777);
    temporary_folder_write(*state, "beads/snapshots/step_000000000.json", beads, strlen(beads));
    temporary_folder_write(*state, "beads/configuration.tsv", types, strlen(types));
    film_beads(none);
    assert_int_equal(seen_at(3, 5), BLUE);
    assert_int_equal(seen_at(5, 5), RED);
    assert_int_equal(seen_at(3.6, 5), WHITE);
    temporary_folder_write(*state, "beads/configuration_bonds.tsv", bonds, strlen(bonds));
    film_beads(none);
    assert_int_equal(seen_at(3, 5), BLUE);
    assert_int_equal(seen_at(3.6, 5), BLUE);
    assert_int_equal(seen_at(4.4, 5), RED);
    assert_int_equal(seen_at(0.1, 2), BLUE);
    assert_int_equal(seen_at(9.9, 2), BLUE);
    assert_int_equal(seen_at(5, 2), WHITE);
    film_beads(hide);
    assert_int_equal(seen_at(3, 5), BLUE);
    assert_int_equal(seen_at(5, 5), WHITE);
    assert_int_equal(seen_at(3.6, 5), WHITE);
    assert_int_equal(seen_at(0.1, 2), BLUE);
}

/// One particle, at 0, whose type is −1.
static const char without_type[] =
    "<VTKFile header_type=\"UInt64\"><DataArray Name=\"TimeValue\">0</DataArray>"
    "<DataArray Name=\"box\">5 5 0</DataArray><Piece NumberOfPoints=\"1\">"
    "<DataArray type=\"Float64\" Name=\"position\" NumberOfComponents=\"3\">"
    "GAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=</DataArray>"
    "<DataArray type=\"Int64\" Name=\"type\" NumberOfComponents=\"1\">"
    "CAAAAAAAAAD//////////w==</DataArray></Piece></VTKFile>";

static void test_types_without_a_number_are_refused(void **state) {
    struct film_frame frame;
    temporary_folder_write(*state, "one.vtp", without_type, strlen(without_type));
    assert_fails(mf_film_frame_read(&frame, "one.vtp", NULL), STATUS_BAD_INPUT,
                 "one.vtp: a type has no number");
}

static const struct {
    const char *words[6];
    const char *says[3];
} bad_lines[] = {
    {{"film"}, {"usage: mesofit film DIR"}},
    {{"film", "no/such"}, {"no/such: No such file"}},
    {{"film", "."}, {".: no snapshots to make a film of", "\"formats\": [\"vtp\"]"}},
    {{"film", "out", "--frames", "many"}, {"--frames: expected a number", "\"many\""}},
    {{"film", "out", "--colour", "taste"}, {"have no \"taste\"", "speed"}},
    {{"film", "out", "--hide", "solvent"}, {"--hide: no type \"solvent\"; there are particles"}},
    {{"film", "out", "--hide", "particles"}, {"--hide: no type of particles is left"}},
    {{"film", "torn"}, {"torn/snapshots/step_000000000.vtp: parts of it are missing"}},
};

static void test_bad_lines_are_refused(void **state) {
    static struct run_program_result result;
    simulate(*state, small_inputs_scene, plan, SNAPSHOTS "}");
    mkdir("torn", 0777);
    mkdir("torn/snapshots", 0777);
    temporary_folder_write(*state, "torn/snapshots/step_000000000.vtp", "<VTKFile", 8);
    for (size_t k = 0; k < sizeof bad_lines / sizeof *bad_lines; k++) {
        run_program(&result, &(struct run_program_how){0}, bad_lines[k].words);
        run_program_assert_code(&result, 2);
        for (const char *const *says = bad_lines[k].says; *says; says++)
            assert_contains(result.err, *says);
        assert_int_equal(run_program_lines(result.err), 1);
    }
    assert_false(temporary_folder_exists("out/figures/film.gif"));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_frames_of_both_formats_are_the_same),
        TEST(test_film_has_a_picture_for_each_snapshot),
        TEST(test_ffmpeg_makes_it_a_film),
        TEST(test_bonds_are_drawn_between_beads_that_are_shown),
        TEST(test_types_without_a_number_are_refused),
        TEST(test_bad_lines_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
