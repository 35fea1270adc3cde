// SPDX-License-Identifier: GPL-3.0-or-later
//
// A German, whose decimals have a comma and whose names are sorted another way, gets the tables and
// figures of anybody, to the byte. The locale is made for the test, where its sources are (Debian:
// locales).
#include "shared/german.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static struct run_program_result result;

/// Names of types that a German sorts "a, B" and C "B, a".
static const char scene[] =
    "{\"title\": \"\\u00e9 \\u03c1\", \"seed\": 7, \"box\": [5, 5, 5],\n"
    "\"particles\": {\"types\": {\"a\": 150, \"B\": 120, \"C_x\": 105}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"time_step\": 0.02,\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, \"motion\": {\"lags\": 20},\n"
    "\"snapshots\": {\"every\": 50},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 40}, \"structure_factor\": {\"q_maximum\": 8},\n"
    "\"measure\": {\"equilibration\": 50, \"samples\": 20, \"every\": 5}}\n";

static const char plane[] =
    "{\"seed\": 2, \"dimensions\": 2, \"box\": [12, 12], \"particles\": {\"count\": 200},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"time_step\": 0.02,\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"local_density\": {\"cell\": 2}, \"clusters\": {\"distance\": 0.5},\n"
    "\"snapshots\": {\"every\": 50},\n"
    "\"measure\": {\"equilibration\": 50, \"samples\": 20, \"every\": 5}}\n";

static const char run[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"
    "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 5, \"samples\": 20, "
    "\"every\": 1, \"iterations\": 3, \"precision\": 1e-4},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 10, \"every\": 5}}\n";

static const char map[] = "{\"beads\": {\"W\": {\"residue\": \"SOL\"}},"
                          " \"masses\": {\"OW\": 15.9994, \"HW1\": 1.008, \"HW2\": 1.008}}";

static int leave(void **state) {
    unsetenv("LOCPATH");
    unsetenv("LC_ALL");
    return small_inputs_leave(state);
}

/// Times of a fit that are in figures, the same for all.
static void write_times(const char *file) {
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    fprintf(stream, "# iteration[1]\tseconds[s]\n0\t0.5\n1\t1.25\n2\t2\n3\t3.5\n");
    fclose(stream);
}

/// All that makes tables and figures, in a folder that is always called alike, since files name it.
static void run_all(const char *place, const char *locale) {
    char water[1024];
    snprintf(water, sizeof water, "%s/tests/trajectories/water.gro", run_program_sources());
    const char *const lines[][9] = {
        {"simulate", "../scene.json", "-o", "mixture", "--quiet"},
        {"simulate", "../plane.json", "-o", "plane", "--quiet"},
        {"fit", "../run.json", "-o", "fit", "--quiet"},
        {"plot", "fit"},
        {"compare", "fit", "mixture", "-o", "both"},
        {"measure", water, "--map", "../map.json", "-o", "measured", "--quiet"},
        {"export", "fit", "--engine", "lammps", "-o", "exported"},
    };
    assert_true(mkdir("here", 0777) == 0 && chdir("here") == 0);
    assert_int_equal(setenv("LC_ALL", locale, 1), 0);
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        run_program(&result, &(struct run_program_how){0}, lines[k]);
        if (result.code < 0 || result.code > 1 || strstr(result.err, "no figure"))
            fail_msg("%s under %s: %s", lines[k][0], locale, result.err);
        if (strcmp(lines[k][0], "fit") == 0)
            write_times("fit/timing.tsv");
    }
    unsetenv("LC_ALL");
    assert_true(chdir("..") == 0 && rename("here", place) == 0);
}

static const char *twin;
static int compared;

/// What a run takes in time is nobody's: a line of numbers with "seconds", and whole files.
static void drop_times(char *text) {
    for (char *line = text, *end; *line; line = end) {
        end = line + strcspn(line, "\n");
        end += *end == '\n';
        char name[4096];
        snprintf(name, sizeof name, "%.*s", (int)(end - line), line);
        if (strstr(name, "seconds") || strstr(name, "steps_per_second")) {
            memmove(line, end, strlen(end) + 1);
            end = line;
        }
    }
}

static int compare_file(const char *path, const struct stat *about, int type, struct FTW *place) {
    static const char *const timed[] = {"tasks.tsv", "checkpoint.bin", "compare.tsv"};
    char other[4096];
    (void)about;
    // What a run has written is listed with digests of all of it, in files that begin so.
    if (type != FTW_F || strncmp(path + place->base, ".mesofit-", 9) == 0)
        return 0;
    for (size_t k = 0; k < sizeof timed / sizeof *timed; k++)
        if (strcmp(path + place->base, timed[k]) == 0)
            return 0;
    snprintf(other, sizeof other, "%s%s", twin, path + strcspn(path, "/"));
    if (access(other, R_OK) != 0)
        fail_msg("%s is not there", other);
    if (strstr(path, ".png")) {
        char command[9000];
        snprintf(command, sizeof command, "cmp '%s' '%s'", path, other);
        assert_int_equal(system(command), 0);
    } else {
        char *one = temporary_folder_read(path), *two = temporary_folder_read(other);
        drop_times(one);
        drop_times(two);
        if (strcmp(one, two) != 0)
            fail_msg("%s and %s differ", path, other);
        free(one);
        free(two);
    }
    compared++;
    return 0;
}

static void test_a_german_has_the_bytes_of_anybody(void **state) {
    struct temporary_folder *folder = *state;
    small_inputs_need_gnuplot();
    if (!german_make(folder))
        skip();
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
    small_inputs_write(folder, "plane.json", plane, NULL, NULL);
    small_inputs_write(folder, "run.json", run, NULL, NULL);
    small_inputs_write(folder, "map.json", map, NULL, NULL);
    small_inputs_write(folder, "target.tsv", small_inputs_target, NULL, NULL);
    run_all("plain", "C");
    run_all("german", "de_DE.UTF-8");
    twin = "german";
    assert_int_equal(nftw("plain", compare_file, 16, FTW_PHYS), 0);
    const int files = compared;
    twin = "plain";
    assert_int_equal(nftw("german", compare_file, 16, FTW_PHYS), 0);
    print_message("%d files are the same\n", files);
    assert_int_equal(compared, 2 * files);
    assert_true(files > 60);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_german_has_the_bytes_of_anybody, small_inputs_enter,
                                        leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
