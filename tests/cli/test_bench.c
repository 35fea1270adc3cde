// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit bench engine` from outside: its JSON and its table, bad input, no LAMMPS.
#include "shared/other_engine.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdlib.h>

/// A list of one object becomes that object in a file, for the checks of results.
static void write_object(struct temporary_folder *folder, const char *list) {
    const size_t length = strlen(list);
    assert_int_equal(list[0], '[');
    assert_string_equal(list + length - 2, "]\n");
    temporary_folder_write(folder, "object.json", list + 1, length - 3);
}

static void test_bench_prints_json_and_writes_a_table(void **state) {
    static struct run_program_result result;
    static const char *const numbers[] = {"particles",
                                          "threads",
                                          "steps_per_second",
                                          "steps_per_second_best",
                                          "steps_per_second_spread",
                                          "particle_steps_per_second",
                                          "pairs_per_second",
                                          "ns_per_pair",
                                          "ticks_per_pair",
                                          "list_share",
                                          "forces_share",
                                          "motion_share",
                                          "list_efficiency",
                                          "steps_per_build",
                                          NULL};
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "engine", "small.json", "--json", "--isa", "portable",
                "--precision", "double", "--seconds", "0.02", "-o", "speed.tsv");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    write_object(*state, result.out);
    results_assert_text("object.json", "scene", "small");
    results_assert_text("object.json", "isa", "portable");
    results_assert_text("object.json", "precision", "double");
    results_assert_number("object.json", "particles", 81);
    results_assert_number("object.json", "threads", 1);
    results_assert_numbers("object.json", numbers);
    assert_true(temporary_folder_exists("speed.tsv"));
    run_program_assert_no_partial(".");
}

/// Scenes of every kind, as a person types them: with friction, bonds, discs that drive themselves.
static void test_bench_skips_tells_what_parts_of_a_step_cost(void **state) {
    static const struct {
        const char *put, *says;
    } scenes[] = {
        {"\"time_step\"", "friction and noise"},
        {"\"dynamics\": {\"integrator\": \"dpd-verlet\"}, \"time_step\"", "friction and noise"},
        {"\"dynamics\": {\"integrator\": \"shardlow\"}, \"time_step\"", "friction and noise"},
        {"\"snapshots\": {\"every\": 1}, \"time_step\"", "friction and noise"},
        {"\"interactions\": {\"harmonic-trap\": {\"stiffness\": [1, 1, 1]}}, \"time_step\"",
         "harmonic-trap"},
    };
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        small_inputs_write(*state, "small.json", small_inputs_scene, "\"time_step\"",
                           scenes[k].put);
        RUN_PROGRAM(&result, "bench", "engine", "small.json", "--skips", "--isa", "portable",
                    "--precision", "mixed", "--seconds", "0.005", "-o", "skips.tsv", "--force");
        run_program_assert_code(&result, 0);
        assert_string_equal(result.err, "");
        assert_contains(result.out, "small: 81 particles, portable, mixed precision");
        assert_contains(result.out, scenes[k].says);
        assert_contains(result.out, "g(r) at every step");
        assert_true(temporary_folder_exists("skips.tsv"));
    }
}

static const struct {
    const char *words[6];
    const char *says[3];
} bad_lines[] = {
    {{"bench"}, {"usage: mesofit bench engine|accuracy|stability|samplers [SCENE...]"}},
    {{"bench", "motor"}, {"bench: \"motor\" is not known", "engine"}},
    {{"bench", "samplers", "no/such.json"}, {"no/such.json: No such file"}},
    {{"bench", "samplers"}, {"usage: mesofit bench samplers SCENE.json"}},
    {{"bench", "engine", "no/such.json"}, {"no/such.json: No such file"}},
    {{"bench", "engine", "bad.json"}, {"bad.json: box: missing"}},
    {{"bench", "engine", "narrow.json"}, {"narrow: ", "box"}},
    {{"bench", "engine", "--isa", "avx3"}, {"--isa: \"avx3\" is not known", "\"avx2\"?"}},
    {{"bench", "engine", "--precision", "duble"}, {"--precision: \"duble\"", "\"double\"?"}},
    {{"bench", "engine", "--isa"}, {"--isa takes NAME"}},
    {{"bench", "engine", "-o", "--json"}, {"-o takes FILE.tsv"}},
    {{"bench", "engine", "-o", "no/such/file.tsv"}, {"cannot write no/such/file.tsv"}},
    {{"bench", "engine", "--jsn"}, {"unknown option --jsn", "did you mean \"--json\"?"}},
    {{"fit", "run.json", "--json"}, {"unknown option --json"}},
    {{"bench", "engine", "--against-lammps", "--threads", "2"}, {"compares single threads"}},
    {{"bench", "engine", "--seconds", "0"}, {"--seconds: expected a number above 0", "\"0\""}},
    {{"bench", "engine", "--skips", "--json"}, {"--skips goes with neither", "-o FILE.tsv"}},
};

static void test_bad_bench_lines_are_refused_before_anything_is_timed(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "bad.json", small_inputs_scene, "  \"box\": [3, 3, 3],\n", "");
    small_inputs_write(*state, "narrow.json", small_inputs_scene, "[3, 3, 3]", "[3, 1.5, 3]");
    for (size_t k = 0; k < sizeof bad_lines / sizeof *bad_lines; k++) {
        run_program(&result, &(struct run_program_how){0}, bad_lines[k].words);
        run_program_assert_refused(&result, ".", bad_lines[k].says[0], 1, bad_lines[k].says);
    }
}

static void test_comparison_without_lammps_is_one_clear_line(void **state) {
    static struct run_program_result result;
    (void)state; // PATH leads nowhere
    RUN_PROGRAM(&result, "bench", "engine", "--against-lammps");
    run_program_assert_refused(&result, ".", "no lmp", 1,
                               (const char *[]){"--against-lammps", "lmp is not installed", NULL});
}

static void test_comparison_leaves_out_scenes_with_friction(void **state) {
    static struct run_program_result result;
    other_engine_skip_without("lmp");
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "engine", "small.json", "--against-lammps", "--json");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "[]\n");
    assert_contains(result.err, "small is not compared: ");
    assert_int_equal(run_program_lines(result.err), 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_bench_prints_json_and_writes_a_table),
        TEST(test_bench_skips_tells_what_parts_of_a_step_cost),
        TEST(test_bad_bench_lines_are_refused_before_anything_is_timed),
        cmocka_unit_test_setup_teardown(test_comparison_without_lammps_is_one_clear_line,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        TEST(test_comparison_leaves_out_scenes_with_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
