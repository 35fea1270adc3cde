// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit describe`: it tells of every key that the readers of files know.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

/// A file with one key that is unknown at `path`: the reader then lists those that it knows.
static const struct {
    const char *command, *text, *topic;
} readers[] = {
    {"fit", "{\"x\": 1}", "run"},
    {"fit", "{\"target\": {\"x\": 1}}", "target"},
    {"fit", "{\"unknowns\": {\"x\": 1}}", "unknowns"},
    {"fit", "{\"unknowns\": {\"omega\": {\"x\": 1}}}", "omega"},
    {"fit", "{\"unknowns\": {\"potential\": {\"x\": 1}}}", "potential"},
    {"fit", "{\"unknowns\": {\"omega\": {\"fixed\": {\"x\": 1}}}}", "fixed"},
    {"fit", "{\"core\": {\"x\": 1}}", "core"},
    {"fit", "{\"verification\": {\"x\": 1}}", "verification"},
    {"fit", "{\"method\": {\"name\": \"imc\", \"x\": 1}}", "imc"},
    {"fit", "{\"method\": {\"name\": \"genetic\", \"x\": 1}}", "genetic"},
    {"fit", "{\"method\": {\"name\": \"gauss-newton\", \"x\": 1}}", "gauss-newton"},
    {"fit", "{\"method\": {\"name\": \"pareto\", \"x\": 1}}", "pareto"},
    {"fit", "{\"method\": {\"name\": \"formulas\", \"x\": 1}}", "formulas"},
    {"simulate", "{\"x\": 1}", "scene"},
    {"simulate", "{\"measure\": {\"x\": 1}}", "measure"},
    {"simulate", "{\"rdf\": {\"x\": 1}}", "rdf"},
    {"simulate", "{\"motion\": {\"x\": 1}}", "motion"},
    {"simulate", "{\"units\": {\"x\": 1}}", "units"},
};

static void test_describe_tells_of_every_key_that_a_reader_knows(void **state) {
    for (size_t k = 0; k < sizeof readers / sizeof *readers; k++) {
        size_t keys = 0;
        small_inputs_write(*state, "file.json", readers[k].text, NULL, NULL);
        RUN_PROGRAM(&result, readers[k].command, "file.json", "-o", "out");
        run_program_assert_code(&result, 2);
        char *known = strstr(result.err, "x: unknown key; known: ");
        if (known == NULL)
            fail_msg("no list of keys: %s", result.err);
        known += strlen("x: unknown key; known: ");
        char list[1024];
        snprintf(list, sizeof list, "%.*s", (int)strcspn(known, "\n"), known);
        RUN_PROGRAM(&result, "describe", readers[k].topic);
        run_program_assert_code(&result, 0);
        for (char *rest, *key = strtok_r(list, ", ", &rest); key;
             key = strtok_r(NULL, ", ", &rest), keys++) {
            char line[128];
            snprintf(line, sizeof line, "\n  %s ", key);
            if (strcmp(key, "name") != 0 && strstr(result.out, line) == NULL)
                fail_msg("describe %s does not tell of %s", readers[k].topic, key);
        }
        assert_true(keys > 0);
    }
}

/// What an object is said to be described by is described.
static void test_describe_knows_every_topic_that_it_names(void **state) {
    static const char *const topics[] = {"run", "scene", "target", "unknowns", "omega"};
    static const char words[] = "see `mesofit describe ";
    (void)state;
    for (size_t k = 0; k < sizeof topics / sizeof *topics; k++) {
        static char text[sizeof result.out];
        RUN_PROGRAM(&result, "describe", topics[k]);
        run_program_assert_code(&result, 0);
        snprintf(text, sizeof text, "%s", result.out);
        assert_contains(text, words);
        for (char *at = text; (at = strstr(at, words)); at++) {
            char name[64];
            snprintf(name, sizeof name, "%.*s", (int)strcspn(at + strlen(words), "`"),
                     at + strlen(words));
            RUN_PROGRAM(&result, "describe", name);
            run_program_assert_code(&result, 0);
        }
    }
}

static void test_describe_of_a_group_is_all_that_it_holds(void **state) {
    static const char *const methods[] = {"imc (method)", "gauss-newton (method)",
                                          "cma-es (method)", "pareto (method)"};
    (void)state;
    RUN_PROGRAM(&result, "describe", "method");
    run_program_assert_code(&result, 0);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
        assert_contains(result.out, methods[k]);
    assert_null(strstr(result.out, "(target)"));
}

/// The integrator that a scene without "dynamics" gets is called the default in words alone.
static void assert_default(void *state, const char *text, const char *integrator,
                           const char *words) {
    char line[256];
    small_inputs_write(state, "scene.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", integrator, "--quiet");
    run_program_assert_code(&result, 0);
    snprintf(line, sizeof line, "%s/used.json", integrator);
    results_assert_text(line, "dynamics.integrator", integrator);
    RUN_PROGRAM(&result, "describe", integrator);
    snprintf(line, sizeof line, "the default %s friction", words);
    assert_contains(result.out, line);
    RUN_PROGRAM(&result, "describe", "scene");
    snprintf(line, sizeof line, "\"%s\"", integrator);
    assert_contains(result.out, line);
}

#define SCENE_WITH(more)                                                                           \
    "{\"box\": [4, 4, 4], \"particles\": {\"count\": 64}, "                                        \
    "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}" more "}"

/// A run file calls a target as a simulation calls what it measures, and says other things of it.
static void test_describe_of_a_path_is_what_stands_there(void **state) {
    static const char *const paths[][2] = {{"scene.box", "edges"},
                                           {"run.scene.box", "edges"},
                                           {"scene.conservative.a", "soft-repulsion"},
                                           {"run.target.rdf", "rdf-target (target)"},
                                           {"run.method.name", "gauss-newton"},
                                           {"weight.name", "lucy"}};
    (void)state;
    for (size_t k = 0; k < sizeof paths / sizeof *paths; k++) {
        RUN_PROGRAM(&result, "describe", paths[k][0]);
        run_program_assert_code(&result, 0);
        assert_contains(result.out, paths[k][1]);
    }
    RUN_PROGRAM(&result, "describe", "scene.box");
    assert_null(strstr(result.out, "density"));
    RUN_PROGRAM(&result, "describe", "scene.every");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "measure");
}

static void test_describe_says_once_what_a_missing_time_step_is(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "describe", "scene.time_step");
    assert_contains(result.out, "time step; another chosen if needed");
    assert_contains(result.out, "number, default 0.01");
}

static void test_describe_of_an_observable_names_the_target_of_that_name(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "describe", "rdf");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "see `mesofit describe rdf-target`");
}

/// Who looks for a key finds the objects that have it.
static void test_describe_of_a_key_tells_where_it_is(void **state) {
    static const char *const wanted[][2] = {{"molecules", "see mesofit describe molecule\n"},
                                            {"every", "see mesofit describe measure, verif"}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        RUN_PROGRAM(&result, "describe", wanted[k][0]);
        run_program_assert_code(&result, 2);
        assert_contains(result.err, wanted[k][1]);
    }
    RUN_PROGRAM(&result, "describe", "simualte"); // no key
    assert_contains(result.err, "is not known");
}

static void test_describe_says_which_integrator_is_the_default(void **state) {
    assert_default(*state, SCENE_WITH(", \"dissipative\": {\"law\": \"power\", \"sigma\": 3}"),
                   "aboba", "with");
    assert_default(*state,
                   SCENE_WITH(", \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}"),
                   "velocity-verlet", "without");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_describe_tells_of_every_key_that_a_reader_knows),
        TEST(test_describe_knows_every_topic_that_it_names),
        TEST(test_describe_of_a_group_is_all_that_it_holds),
        TEST(test_describe_of_a_path_is_what_stands_there),
        TEST(test_describe_says_once_what_a_missing_time_step_is),
        TEST(test_describe_of_an_observable_names_the_target_of_that_name),
        TEST(test_describe_of_a_key_tells_where_it_is),
        TEST(test_describe_says_which_integrator_is_the_default),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
