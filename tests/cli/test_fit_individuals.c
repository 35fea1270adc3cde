// SPDX-License-Identifier: GPL-3.0-or-later
//
// individuals.tsv: whose children the individuals of a genetic algorithm are.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdlib.h>

enum { POPULATION = 8, GENERATIONS = 5, GENES = 4, COLUMNS = 5 + GENES, MAX = 200 };
enum { ITERATION, NUMBER, ERROR, PARENT, OTHER };

#define SCENE                                                                                      \
    "\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02, "                    \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

/// Without mutation all genes are those of parents.
static const char fit[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}}, \"unknowns\": "
    "{\"potential\": {\"coefficients\": 4, \"maximum\": 30}}, \"scene\": {" SCENE "}, "
    "\"method\": {\"name\": \"genetic\", \"population\": 8, \"generations\": 5, \"mutation\": 0, "
    "\"crossover_kind\": \"one-point\", \"step\": 0.1, \"surrogate\": \"no\", "
    "\"equilibration\": 40, \"samples\": 8, \"every\": 5, \"temperature_tolerance\": 0.5}, "
    "\"core\": {\"threshold\": 0.05, \"stiffness\": 50}, \"verification\": {\"replicas\": 2, "
    "\"equilibration\": 20, \"samples\": 8, \"every\": 5}}\n";

static void write_inputs(struct temporary_folder *folder) {
    small_inputs_write(folder, "scene.json",
                       "{\"seed\": 5, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, "
                       "\"measure\": {\"equilibration\": 100, \"samples\": 40}, "
                       "\"rdf\": {\"range\": 1, \"bins\": 20}, " SCENE "}",
                       NULL, NULL);
    small_inputs_write(folder, "run.json", fit, NULL, NULL);
    twins_simulate("scene.json", "target");
}

/// The numbers of a table. Returns its rows.
static size_t read_rows(const char *path, double row[MAX][COLUMNS]) {
    char *text = temporary_folder_read(path);
    size_t rows = 0;
    for (char *rest, *line = strtok_r(text, "\n", &rest); line;
         line = strtok_r(NULL, "\n", &rest)) {
        if (line[0] == '#')
            continue;
        assert_true(rows < MAX);
        for (int c = 0; c < COLUMNS; c++)
            row[rows][c] = strtod(line, &line);
        rows++;
    }
    free(text);
    return rows;
}

static bool has_gene(const double *row, const double *of) {
    return of && *row == *of;
}

/// Each gene of a child stands at its place in one of its parents, who were measured before it; and
/// the first generation has none. One parent alone is what the individual is a copy of.
static void test_genes_of_children_are_those_of_their_parents(void **state) {
    static struct run_program_result result;
    static double row[MAX][COLUMNS];
    size_t crossed = 0, copies = 0, challengers = 0;
    write_inputs(*state);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_in_range(result.code, 0, 1);
    const size_t rows = read_rows("out/individuals.tsv", row);
    assert_true(rows > POPULATION * 2);
    for (size_t k = 0; k < rows; k++) {
        const size_t parent = (size_t)row[k][PARENT], other = (size_t)row[k][OTHER];
        assert_int_equal((size_t)row[k][NUMBER], k + 1);
        assert_true(k < POPULATION ? parent == 0 && other == 0 : parent > 0 && parent <= k);
        assert_true(other <= k);
        if (k > 0)
            assert_true(row[k][ITERATION] >= row[k - 1][ITERATION]);
        for (int c = ERROR + 3; parent && c < COLUMNS; c++)
            assert_true(has_gene(&row[k][c], &row[parent - 1][c]) ||
                        has_gene(&row[k][c], other ? &row[other - 1][c] : NULL));
        crossed += other > 0 && other != parent;
        copies += parent > 0 && other == 0;
        challengers += k > 0 && parent > 0 && other == 0 && row[k - 1][PARENT] == row[k][PARENT];
    }
    assert_true(crossed > POPULATION);
    assert_true(copies > 2 && challengers > 0);
    assert_true(temporary_folder_exists("out/genes_potential.tsv"));
}

static void test_individuals_are_the_same_for_any_threads_and_after_interruptions(void **state) {
    static struct run_program_result result;
    static const char *const tables[] = {"individuals.tsv", "genes_potential.tsv", NULL};
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    write_inputs(*state);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "whole", "--threads", "1", "--quiet");
    run_program_in_pieces(result.code, words);
    results_assert_same("whole", "pieces", tables);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_genes_of_children_are_those_of_their_parents,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_individuals_are_the_same_for_any_threads_and_after_interruptions,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
