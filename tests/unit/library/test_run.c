// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the program does, done by the library: from words, texts, tables and frames in memory to
// folders, and back to tables.
#include "mesofit.h"

#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

/// Words of a run in a folder of the test's.
static enum mesofit_status carry_out(struct mesofit_run *run, const char *const *words,
                                     const struct mesofit_inputs *inputs) {
    size_t count = 0;
    while (words[count])
        count++;
    return mesofit_run_words(run, count, words, inputs);
}

#define CARRY_OUT(run, inputs, ...)                                                                \
    carry_out((run), (const char *const[]){__VA_ARGS__, NULL}, (inputs))

static const char small_scene[] =
    "{\"box\": [4, 4, 4], \"particles\": {\"count\": 150}, \"conservative\": {\"law\": "
    "\"soft-repulsion\", \"a\": 25}, \"dissipative\": {\"law\": \"power\", \"sigma\": 3}, "
    "\"measure\": {\"equilibration\": 100, \"samples\": 40, \"every\": 5}, \"rdf\": {\"range\": 1, "
    "\"bins\": 20}}";

static const struct mesofit_text scene_text = {"scene", small_scene};
static const struct mesofit_inputs scene_inputs = {.texts = &scene_text, .text_count = 1};

static void test_scene_in_memory_becomes_tables_by_name(void **state) {
    struct temporary_folder *const folder = *state;
    char out[1024];
    snprintf(out, sizeof out, "%s", temporary_folder_file(folder, "out"));
    struct mesofit_run *const run = mesofit_run_create();
    assert_ok((enum status)CARRY_OUT(run, &scene_inputs, "simulate", "scene", "-o", out));
    struct mesofit_run_progress progress;
    mesofit_run_progress(run, &progress);
    assert_int_equal(progress.done, 300);
    assert_int_equal(progress.total, 300);
    assert_string_equal(progress.unit, "steps");
    const char *last = "", *line;
    for (size_t k = 0; (line = mesofit_run_line(run, k)); k++)
        last = line;
    assert_contains(last, "300 steps in ");
    mesofit_run_free(run);

    struct mesofit_result *const result = mesofit_result_open(out);
    assert_non_null(result);
    assert_string_equal(mesofit_result_name(result, 0), "rdf");
    assert_string_equal(mesofit_result_name(result, 1), "thermodynamics");
    assert_null(mesofit_result_name(result, 2));
    struct mesofit_columns rdf;
    assert_ok((enum status)mesofit_result_table(result, "rdf", &rdf));
    assert_int_equal(rdf.rows, 20);
    assert_string_equal(rdf.names[0], "r");
    assert_string_equal(rdf.units[0], "lambda");
    assert_string_equal(rdf.names[1], "g");
    assert_true(fabs(rdf.values[0] - 0.025) < 1e-12 && rdf.values[19 * rdf.columns + 1] > 0.5);
    assert_contains(mesofit_result_text(result, "summary.json"), "\"status\"");
    assert_null(mesofit_result_text(result, "no.json"));
    assert_contains(mesofit_message(), "no.json");
    assert_int_equal(mesofit_result_table(result, "gdr", &rdf), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "no table \"gdr\"");
    mesofit_result_free(result);
}

static void test_faults_are_the_lines_of_the_program(void **state) {
    struct temporary_folder *const folder = *state;
    struct mesofit_run *const run = mesofit_run_create();
    const char *const out = temporary_folder_file(folder, "out");
    static const struct {
        const char *words[5], *message;
    } cases[] = {
        {{"mesure"}, "unknown command \"mesure\"; did you mean \"measure\"?"},
        {{"live"}, "unknown command \"live\""},
        {{"measure"}, "usage: mesofit measure TRAJECTORY..."},
        {{"measure", "x.xtc", "--bins", "0"}, "--bins takes a whole number from 1 to 100000"},
        {{"measure", "x.xtc", "-s"}, "-s takes FILE"},
        {{"measure", "no.xtc"}, "no.xtc: No such file"},
        {{"simulate", "scene", "--rezume"}, "unknown option --rezume; did you mean"},
        {{"simulate", "scene", "--explain"}, "--explain is for the program alone"},
        {{"fit", "run", "--live"}, "--live is for the program alone"},
        {{"fit", "--density", "2"}, "usage: mesofit fit RUN.json"},
        {{"export", "no", "--engine", "gulp"}, "lammps"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const enum mesofit_status status = carry_out(run, cases[k].words, &scene_inputs);
        assert_true(status == MESOFIT_BAD_INPUT || status == MESOFIT_IO);
        assert_contains(mesofit_message(), cases[k].message);
    }
    const struct mesofit_text wrong = {"scene", "{\"bax\": 1}"};
    const struct mesofit_inputs inputs = {.texts = &wrong, .text_count = 1};
    assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "scene: bax: unknown key; did you mean \"box\"?");
    assert_int_equal(mesofit_run_words(run, 0, NULL, NULL), MESOFIT_BAD_INPUT);
    assert_null(mesofit_result_open(folder->path));
    assert_contains(mesofit_message(), "holds no results");
    assert_null(mesofit_result_open("no/such/folder"));
    mesofit_run_free(run);
}

// Frames ------------------------------------------------------------------------------------------

enum { ATOMS = 200, FRAMES = 8 };

/// A gas in a sheared box [nm], the same numbers in memory and in a file.
struct gas {
    double position[FRAMES][ATOMS][3];
    const char *name[ATOMS];
    double mass[ATOMS];
    int fail_at; ///< frame; -1: none
};

static const double edges[9] = {3, 0, 0, 0.5, 3, 0, 0.25, 0.75, 3};

static void make_gas(struct gas *gas) {
    uint32_t number = 12345;
    gas->fail_at = -1;
    for (int frame = 0; frame < FRAMES; frame++)
        for (int atom = 0; atom < ATOMS; atom++)
            for (int d = 0; d < 3; d++) {
                number = 1664525u * number + 1013904223u;
                gas->position[frame][atom][d] = (number >> 8) * (3.0 / (1 << 24));
            }
    for (int atom = 0; atom < ATOMS; atom++) {
        gas->name[atom] = atom % 2 ? "B" : "A";
        gas->mass[atom] = 18;
    }
}

static int read_gas(void *context, size_t number, struct mesofit_frame *frame) {
    struct gas *const gas = context;
    if ((int)number == gas->fail_at)
        return -1;
    if (number >= FRAMES)
        return 0;
    frame->time = (double)number;
    memcpy(frame->box, edges, sizeof edges);
    frame->positions = &gas->position[number][0][0];
    return 1;
}

static struct mesofit_trajectory lend_gas(struct gas *gas, size_t frames) {
    return (struct mesofit_trajectory){.name = "<gas>",
                                       .atoms = ATOMS,
                                       .frames = frames,
                                       .length = 1,
                                       .time = 1,
                                       .names = gas->name,
                                       .masses = gas->mass,
                                       .read = read_gas,
                                       .context = gas};
}

/// GROMACS's text, in which an atom is a residue. 3 nm over 2^24 is no decimal number: a pair at
/// the edge of a bin may be in the next one.
static void write_gas(const struct gas *gas, const char *file) {
    FILE *const stream = fopen(file, "w");
    for (int frame = 0; frame < FRAMES; frame++) {
        fprintf(stream, "gas t= %d.0\n%d\n", frame, ATOMS);
        for (int atom = 0; atom < ATOMS; atom++) {
            const double *const p = gas->position[frame][atom];
            fprintf(stream, "%5d%-5s%5s%5d%14.9f%14.9f%14.9f\n", atom + 1, gas->name[atom],
                    gas->name[atom], atom + 1, p[0], p[1], p[2]);
        }
        fprintf(stream, "%f %f %f 0 0 %f 0 %f %f\n", edges[0], edges[4], edges[8], edges[3],
                edges[6], edges[7]);
    }
    fclose(stream);
}

static void read_pairs(const char *out, double g[100]) {
    struct mesofit_result *const result = mesofit_result_open(out);
    struct mesofit_columns columns;
    assert_non_null(result);
    assert_ok((enum status)mesofit_result_table(result, "rdf_A-B", &columns));
    assert_int_equal(columns.rows, 50);
    assert_string_equal(columns.units[0], "nm");
    for (size_t k = 0; k < columns.rows; k++)
        g[k] = columns.values[k * columns.columns + 1];
    mesofit_result_free(result);
}

#define MEASURE(run, inputs, file, out)                                                            \
    CARRY_OUT(run, inputs, "measure", file, "--static", "--bins", "50", "--range", "1.2", "-o", out)

static void test_frames_in_memory_are_those_of_a_file(void **state) {
    struct temporary_folder *const folder = *state;
    char out[2][1024];
    double g[2][100];
    struct gas gas;
    make_gas(&gas);
    for (int k = 0; k < 2; k++)
        snprintf(out[k], sizeof out[k], "%s", temporary_folder_file(folder, k ? "file" : "memory"));
    write_gas(&gas, temporary_folder_file(folder, "gas.gro"));
    const struct mesofit_trajectory trajectory = lend_gas(&gas, 0);
    const struct mesofit_inputs inputs = {.trajectory = &trajectory};
    struct mesofit_run *const run = mesofit_run_create();
    assert_ok((enum status)MEASURE(run, &inputs, "<gas>", out[0]));
    assert_ok((enum status)MEASURE(run, NULL, folder->file, out[1]));
    read_pairs(out[0], g[0]);
    read_pairs(out[1], g[1]);
    for (int k = 0; k < 50; k++)
        assert_true(fabs(g[0][k] - g[1][k]) < 1e-9);
    mesofit_run_free(run);
}

static void test_faults_of_frames_are_told(void **state) {
    struct temporary_folder *const folder = *state;
    struct gas gas;
    make_gas(&gas);
    const char *const out = temporary_folder_file(folder, "out");
    struct mesofit_trajectory trajectory = lend_gas(&gas, 0);
    const struct mesofit_inputs inputs = {.trajectory = &trajectory};
    struct mesofit_run *const run = mesofit_run_create();
    gas.position[3][17][1] = NAN;
    assert_int_equal(MEASURE(run, &inputs, "<gas>", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "<gas>: frame 4: the position of atom 18 is not finite");
    gas.fail_at = 2;
    assert_int_equal(MEASURE(run, &inputs, "<gas>", out), MESOFIT_INTERRUPTED);
    assert_contains(mesofit_message(), "frame 3 could not be had");
    trajectory.length = 0;
    assert_int_equal(MEASURE(run, &inputs, "<gas>", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "units of length");
    trajectory = lend_gas(&gas, 0);
    gas.name[5] = "a name that is too long";
    assert_int_equal(MEASURE(run, &inputs, "<gas>", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "of atom 6 has more than");
    assert_false(temporary_folder_exists(out));
    mesofit_run_free(run);
}

// Stopping ----------------------------------------------------------------------------------------

static void test_a_run_is_stopped_alone(void **state) {
    struct temporary_folder *const folder = *state;
    char out[1024];
    snprintf(out, sizeof out, "%s", temporary_folder_file(folder, "out"));
    struct mesofit_run *const stopped = mesofit_run_create(), *const other = mesofit_run_create();
    mesofit_run_stop(stopped);
    assert_int_equal(CARRY_OUT(stopped, &scene_inputs, "simulate", "scene", "-o", out),
                     MESOFIT_INTERRUPTED);
    assert_contains(mesofit_message(), "continue with --resume");
    assert_ok(
        (enum status)CARRY_OUT(other, &scene_inputs, "simulate", "scene", "-o", out, "--resume"));
    mesofit_run_free(stopped);
    mesofit_run_free(other);
}

struct job {
    char out[1024];
    enum mesofit_status status;
};

static void *simulate(void *context) {
    struct job *const job = context;
    struct mesofit_run *const run = mesofit_run_create();
    job->status = CARRY_OUT(run, &scene_inputs, "simulate", "scene", "-o", job->out);
    mesofit_run_free(run);
    return NULL;
}

static void test_runs_of_two_threads_are_the_same(void **state) {
    struct temporary_folder *const folder = *state;
    struct job jobs[2] = {0};
    pthread_t threads[2];
    char *text[2];
    for (int k = 0; k < 2; k++) {
        snprintf(jobs[k].out, sizeof jobs[k].out, "%s",
                 temporary_folder_file(folder, k ? "two" : "one"));
        assert_int_equal(pthread_create(&threads[k], NULL, simulate, &jobs[k]), 0);
    }
    for (int k = 0; k < 2; k++) {
        char table[2100];
        pthread_join(threads[k], NULL);
        assert_int_equal(jobs[k].status, MESOFIT_OK);
        snprintf(table, sizeof table, "%s/rdf.tsv", jobs[k].out);
        text[k] = temporary_folder_read(table);
    }
    assert_string_equal(text[0], text[1]);
    free(text[0]);
    free(text[1]);
}

static void test_scene_tells_its_units_and_its_box(void **state) {
    (void)state;
    static const char text[] =
        "{\"units\": {\"system\": \"nm-ps\", \"length\": 0.5, \"mass\": 18}, \"box\": [4, 4, 4], "
        "\"particles\": "
        "{\"count\": 300}, \"temperature\": 300, \"time_step\": 0.01, "
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20, \"cutoff\": 0.5}}";
    struct mesofit_simulation *const simulation = mesofit_simulation_parse(text, NULL, 0);
    if (simulation == NULL)
        fail_msg("%s", mesofit_message());
    const char *const told = mesofit_simulation_text(simulation);
    assert_contains(told, "\"length_unit_nm\":\t0.5");
    assert_contains(told, "\"temperature_unit_K\":\t300");
    assert_contains(told, "\"edges\":\t[8, 8, 8]");
    mesofit_simulation_free(simulation);
    assert_int_equal(mesofit_size_of("mesofit_scene"), sizeof(struct mesofit_scene));
    assert_int_equal(mesofit_size_of("mesofit_run"), 0);
    assert_int_equal(mesofit_size_of(NULL), 0);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_scene_in_memory_becomes_tables_by_name),
        TEST(test_faults_are_the_lines_of_the_program),
        TEST(test_frames_in_memory_are_those_of_a_file),
        TEST(test_faults_of_frames_are_told),
        TEST(test_a_run_is_stopped_alone),
        TEST(test_runs_of_two_threads_are_the_same),
        cmocka_unit_test(test_scene_tells_its_units_and_its_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
