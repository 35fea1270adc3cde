// SPDX-License-Identifier: GPL-3.0-or-later
//
// Functions of who calls the library, asked at each sample of a simulation.
#include "mesofit.h"

#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    "{\"box\": [4, 4, 4], \"particles\": {\"count\": 150}, \"time_step\": 0.01, \"conservative\": "
    "{\"law\": "
    "\"soft-repulsion\", \"a\": 25}, \"dissipative\": {\"law\": \"power\", \"sigma\": 3}, "
    "\"measure\": {\"equilibration\": 100, \"samples\": 40, \"every\": 5}, \"rdf\": {\"range\": 1, "
    "\"bins\": 20}}";

static const struct mesofit_text scene_text = {"scene", small_scene};
static const struct mesofit_inputs scene_inputs = {.texts = &scene_text, .text_count = 1};

enum { PARTICLES = 150, EDGE = 4, WIDTH = 40 };

/// What a function saw, and when it is to fail.
struct seen {
    int samples, calls, outside;
    int fail_at, grow_at; ///< sample; 0: never
};

/// The kinetic energy of a particle, and 39 zeros.
static ptrdiff_t kinetic(void *context, size_t count, int dimensions, const double *position,
                         const double *velocity, const int32_t *type, const double *edge,
                         size_t room, double *values) {
    struct seen *const seen = context;
    double sum = 0;
    seen->calls++;
    if (room < WIDTH)
        return WIDTH;
    seen->samples++;
    assert_int_equal(count, PARTICLES);
    assert_int_equal(dimensions, 3);
    for (size_t k = 0; k < 3 * count; k++) {
        sum += velocity[k] * velocity[k];
        seen->outside += !(position[k] >= 0 && position[k] < edge[k % 3]) || edge[k % 3] != EDGE;
    }
    for (size_t k = 0; k < count; k++)
        seen->outside += type[k] != 0;
    memset(values, 0, WIDTH * sizeof *values);
    values[0] = sum / (2 * (double)count);
    if (seen->samples == seen->fail_at)
        return -1;
    return seen->samples == seen->grow_at ? WIDTH - 1 : WIDTH;
}

static size_t column(const struct mesofit_columns *table, const char *name) {
    size_t at = 0;
    while (strcmp(table->names[at], name) != 0)
        at++;
    return at;
}

static struct mesofit_inputs lend_observable(const struct mesofit_named_observable *observable) {
    struct mesofit_inputs inputs = scene_inputs;
    inputs.observables = observable;
    inputs.observable_count = 1;
    return inputs;
}

static void test_mean_of_a_function_is_what_the_program_says_of_it(void **state) {
    struct temporary_folder *const folder = *state;
    struct seen seen = {0};
    const struct mesofit_named_observable own = {"kinetic", kinetic, &seen};
    const struct mesofit_inputs inputs = lend_observable(&own);
    const char *const out = temporary_folder_file(folder, "out");
    struct mesofit_run *const run = mesofit_run_create();
    assert_ok((enum status)CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out));
    mesofit_run_free(run);
    assert_int_equal(seen.samples, 40);
    assert_int_equal(seen.calls, 41);
    assert_int_equal(seen.outside, 0);
    struct mesofit_result *const result = mesofit_result_open(out);
    struct mesofit_columns table, energies;
    double kinetic_energy = 0;
    assert_ok((enum status)mesofit_result_table(result, "thermodynamics", &energies));
    const size_t potential = column(&energies, "potential_energy");
    const size_t total = column(&energies, "total_energy");
    for (size_t k = 0; k < energies.rows; k++) {
        const double *const row = energies.values + k * energies.columns;
        kinetic_energy += (row[total] - row[potential]) / (double)energies.rows;
    }
    assert_ok((enum status)mesofit_result_table(result, "kinetic", &table));
    assert_int_equal(table.rows, WIDTH);
    assert_string_equal(table.names[1], "value");
    assert_true(fabs(table.values[1] - kinetic_energy) < 1e-9);
    // Equipartition, of all degrees of freedom but those of the centre of mass.
    const double wanted = 1.5 * (PARTICLES - 1) / PARTICLES;
    assert_true(table.values[2] > 0 && fabs(table.values[1] - wanted) < 4 * table.values[2]);
    assert_true(table.values[table.columns + 1] == 0);
    mesofit_result_free(result);
}

static void test_a_function_that_fails_leaves_no_results(void **state) {
    struct temporary_folder *const folder = *state;
    struct seen seen = {.fail_at = 7};
    const struct mesofit_named_observable own = {"kinetic", kinetic, &seen};
    const struct mesofit_inputs inputs = lend_observable(&own);
    char out[2][1024];
    char *text[2];
    for (int k = 0; k < 2; k++)
        snprintf(out[k], sizeof out[k], "%s", temporary_folder_file(folder, k ? "whole" : "out"));
    struct mesofit_run *const run = mesofit_run_create();
    assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out[0]), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "observable \"kinetic\" failed at step 135");
    assert_null(mesofit_result_open(temporary_folder_file(folder, "out/rdf")));
    seen = (struct seen){.grow_at = 9};
    assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out[0], "--force"),
                     MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "has 39 values at step 145, and had 40 before");
    // Who goes on without it, or with another one, would mix two runs.
    assert_int_equal(CARRY_OUT(run, &scene_inputs, "simulate", "scene", "-o", out[0], "--resume"),
                     MESOFIT_BAD_INPUT);
    seen = (struct seen){0};
    assert_ok((enum status)CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out[0], "--resume"));
    assert_ok((enum status)CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out[1]));
    for (int k = 0; k < 2; k++) {
        char table[2100];
        snprintf(table, sizeof table, "%s/kinetic.tsv", out[k]);
        text[k] = temporary_folder_read(table);
    }
    assert_string_equal(text[0], text[1]);
    free(text[0]);
    free(text[1]);
    mesofit_run_free(run);
}

static void test_observables_that_cannot_be_are_refused(void **state) {
    struct temporary_folder *const folder = *state;
    const char *const out = temporary_folder_file(folder, "out");
    struct seen seen = {0};
    static const struct {
        const char *name, *message;
    } cases[] = {{"rdf", "\"rdf\" has a table of this name; choose another one"},
                 {"rdf_A-B", "has a table of this name"},
                 {"../up", "observable \"../up\": expected a name of letters"},
                 {"", "expected a name of letters"},
                 {NULL, "expected a name of letters"}};
    struct mesofit_run *const run = mesofit_run_create();
    struct mesofit_named_observable own[2] = {{"e", kinetic, &seen}, {"e", kinetic, &seen}};
    struct mesofit_inputs inputs = lend_observable(own);
    assert_int_equal(CARRY_OUT(run, &inputs, "fit", "scene", "-o", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "fit takes no observables of the caller");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        own[0].name = cases[k].name;
        assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out),
                         MESOFIT_BAD_INPUT);
        assert_contains(mesofit_message(), cases[k].message);
    }
    own[0].name = "e";
    inputs.observable_count = 2;
    assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "observable \"e\": the name comes twice");
    own[1] = (struct mesofit_named_observable){"f", NULL, NULL};
    assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "observable \"f\" has no function");
    inputs.observable_count = 17;
    assert_int_equal(CARRY_OUT(run, &inputs, "simulate", "scene", "-o", out), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "17 observables: at most 16");
    assert_false(temporary_folder_exists(out));
    mesofit_run_free(run);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_mean_of_a_function_is_what_the_program_says_of_it),
        TEST(test_a_function_that_fails_leaves_no_results),
        TEST(test_observables_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
