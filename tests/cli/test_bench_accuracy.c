// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit bench accuracy` from outside: the same numbers from any number of threads, its table and
// figures, an unstable ladder, Ctrl-C, bad input.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdlib.h>

/// Blank out the numbers of processor time in a table: columns 3 to 5, and comments.
static void forget_times(char *table) {
    size_t column = 0;
    bool comment = false;
    for (char *at = table; *at; at++) {
        if (column == 0 && *at == '#')
            comment = true;
        if (*at == '\t')
            column++;
        else if (*at != '\n' && (comment || (column >= 2 && column <= 4)))
            *at = ' ';
        if (*at != '\n')
            continue;
        column = 0;
        comment = false;
    }
}

/// `text` without its blanks, which stand for times.
static void squeeze(char *text) {
    char *to = text;
    for (const char *from = text; *from; from++)
        if (*from != ' ')
            *to++ = *from;
    *to = '\0';
}

static char *read_results(const char *file) {
    char *table = temporary_folder_read(file);
    forget_times(table);
    squeeze(table);
    return table;
}

static void test_results_do_not_depend_on_threads(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "accuracy", "small.json", "--time", "4", "--time-steps",
                "0.02,0.04", "--threads", "1", "-o", "one.tsv");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "bench", "accuracy", "small.json", "--time", "4", "--time-steps",
                "0.02,0.04", "--threads", "3", "-o", "three.tsv", "--quiet");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "small: 81 particles, 4 tau a point\nreference: aboba at 0.01 tau "
                                "(with 0.04 tau, extrapolated to 0, ");
    assert_contains(result.out, "lowe-andersen");
    char *one = read_results("one.tsv"), *three = read_results("three.tsv");
    assert_string_equal(one, three);
    assert_contains(one, "\n\n\nshardlow\t0.02\t");
    free(one);
    free(three);
    run_program_assert_no_partial(".");
}

static void test_table_is_drawn_beside_it(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "accuracy", "small.json", "--time", "2", "-o", "points.tsv");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    assert_true(temporary_folder_exists("figures/points.svg"));
    assert_true(temporary_folder_exists("figures/points.png"));
}

static void test_json_has_reference_points_and_recommendation(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "accuracy", "small.json", "--time", "2", "--json", "--error", "9",
                "--time-steps", "0.02", "--integrators", "shardlow,dpd-verlet(0.65)");
    assert_null(strstr(result.out, "dpd-verlet(0.5)"));
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "\"role\":\t\"reference\"");
    assert_contains(result.out, "\"role\":\t\"point\"");
    assert_contains(result.out, "\"integrator\":\t\"dpd-verlet(0.65)\"");
    assert_contains(result.out, "\"temperature_configurational\":\t");
    assert_contains(result.out, "\"role\":\t\"recommendation\"");
    assert_null(strstr(result.out, "\"diffusion"));
    RUN_PROGRAM(&result, "bench", "accuracy", "small.json", "--time", "20", "--json",
                "--time-steps", "0.04", "--integrators", "aboba");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "\"diffusion\":\t");
    assert_contains(result.out, "\"diffusion_change_error\":\t");
}

static void test_ladder_ends_where_a_step_is_unstable(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "accuracy", "small.json", "--time", "2", "--time-steps",
                "0.02,2,2.5", "-o", "points.tsv");
    run_program_assert_code(&result, 0);
    char *table = temporary_folder_read("points.tsv");
    assert_contains(table, "dpd-verlet(0.5)\t0.02\t");
    assert_null(strstr(table, "dpd-verlet(0.5)\t2\t"));
    assert_null(strstr(table, "\t2.5\t"));
    free(table);
}

static void test_scene_without_friction_is_told_its_drift(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "nve.json", small_inputs_scene,
                       ",\n  \"dissipative\": {\"law\": \"power\", \"sigma\": 2}", "");
    RUN_PROGRAM(&result, "bench", "accuracy", "nve.json", "--time", "4", "--time-steps", "0.01");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "reference: velocity-verlet at 0.005 tau");
    assert_contains(result.out, "drift of E");
    assert_contains(result.out, "total energy");
}

static void test_interrupted_bench_leaves_nothing(void **state) {
    static struct run_program_result result;
    static const char *const words[] = {"bench", "accuracy", "small.json", "--time", "1e5",
                                        "-o",    "x.tsv",    "bad-option", NULL};
    (void)state;
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    run_program(&result, &(struct run_program_how){0}, words);
    run_program_assert_code(&result, 2); // two scenes
    assert_contains(result.err, "usage: mesofit bench accuracy SCENE.json");
    const struct run_program_how how = {
        .interrupt_with = SIGINT, .interrupt_after = 0.3, .interrupt_from_start = true};
    run_program(&result, &how,
                (const char *const[]){"bench", "accuracy", "small.json", "--time", "1e5", "-o",
                                      "x.tsv", NULL});
    run_program_assert_code(&result, 130);
    assert_string_equal(result.err, "mesofit: interrupted\n");
    assert_false(temporary_folder_exists("x.tsv"));
    run_program_assert_no_partial(".");
}

/// What other integrators would take for an ideal gas, or have no pairs to look at.
static const char hard_discs[] =
    "{\"dimensions\": 2, \"box\": [20, 20], \"particles\": {\"count\": 40, \"radius\": 0.5},\n"
    "\"time_step\": 0.05, \"dynamics\": {\"integrator\": \"event-driven\"}}\n";
static const char solvent[] =
    "{\"dimensions\": 2, \"box\": [16, 8], \"particles\": {\"count\": 0}, \"time_step\": 0.5,\n"
    "\"dynamics\": {\"integrator\": \"collision-dynamics\", \"particles_per_cell\": 8}}\n";
static const char soft_discs[] =
    "{\"dimensions\": 2, \"box\": [20, 20], \"particles\": {\"count\": 40, \"radius\": 0.5},\n"
    "\"time_step\": 0.01, \"interactions\": {\"soft-discs\": {\"strength\": 10}}}\n";

static const struct {
    const char *words[8];
    const char *says[3];
} bad_lines[] = {
    {{"bench", "accuracy"}, {"usage: mesofit bench accuracy SCENE.json"}},
    {{"bench", "acuracy", "small.json"}, {"did you mean \"accuracy\"?"}},
    {{"bench", "accuracy", "no/such.json"}, {"no/such.json: No such file"}},
    {{"bench", "accuracy", "small.json", "--error", "0"}, {"--error takes a number above 0"}},
    {{"bench", "accuracy", "small.json", "--time", "long"}, {"--time takes a number above 0"}},
    {{"bench", "accuracy", "small.json", "--time-steps", "0.02,0.01"}, {"--time-steps takes grow"}},
    {{"bench", "accuracy", "small.json", "--time-steps", "0.02,"}, {"--time-steps takes growing"}},
    {{"bench", "accuracy", "small.json", "--integrators", "aboba,abobo"},
     {"--integrators: \"abobo\" does not suit the scene", "\"aboba\"?"}},
    {{"bench", "accuracy", "small.json", "-o", "no/such/file.tsv"}, {"cannot write no/such/file"}},
    {{"bench", "accuracy", "small.json", "-o", "./small.json"},
     {"./small.json would be replaced", "reads it as small.json"}},
    {{"bench", "engine", "small.json", "-o", "./small.json"}, {"./small.json would be replaced"}},
    {{"bench", "accuracy", "small.json", "--skips"}, {"bench accuracy takes no --skips"}},
    {{"bench", "engine", "small.json", "--time", "2"}, {"bench engine takes no --time"}},
    {{"bench", "accuracy", "hard.json"},
     {"\"event-driven\" goes from collision to collision, without an error of a time step"}},
    {{"bench", "accuracy", "solvent.json", "--time", "1"},
     {"the time step of \"collision-dynamics\" is a property of its fluid"}},
    {{"bench", "accuracy", "soft.json"}, {"soft: bench accuracy wants \"conservative\" or"}},
};

static void test_bad_lines_are_refused_before_anything_is_run(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(*state, "hard.json", hard_discs, NULL, NULL);
    small_inputs_write(*state, "solvent.json", solvent, NULL, NULL);
    small_inputs_write(*state, "soft.json", soft_discs, NULL, NULL);
    for (size_t k = 0; k < sizeof bad_lines / sizeof *bad_lines; k++) {
        run_program(&result, &(struct run_program_how){0}, bad_lines[k].words);
        run_program_assert_refused(&result, ".", bad_lines[k].says[0], 1, bad_lines[k].says);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_results_do_not_depend_on_threads),
        TEST(test_table_is_drawn_beside_it),
        TEST(test_json_has_reference_points_and_recommendation),
        TEST(test_ladder_ends_where_a_step_is_unstable),
        TEST(test_scene_without_friction_is_told_its_drift),
        TEST(test_interrupted_bench_leaves_nothing),
        TEST(test_bad_lines_are_refused_before_anything_is_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
