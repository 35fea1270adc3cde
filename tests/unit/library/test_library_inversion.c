// SPDX-License-Identifier: GPL-3.0-or-later
//
// An inversion whose samples are the caller's, in C: Metropolis moves of soft beads, by a sampler
// that knows no more than the table that it is given, find a known potential; between two rounds
// the object is thrown away and made again.
#include "mesofit.h"

#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BEADS = 64, SWEEPS = 5 };
static const double edge = 2.9, truth = 12; // the law is truth/2 (1 - r)²

/// A liquid of the caller's: positions, and what acts between them.
struct liquid {
    double position[BEADS][3];
    const struct mesofit_columns *table; ///< r, phi, force; NULL: the truth
    unsigned seed;
};

static double draw(struct liquid *liquid) {
    return (double)rand_r(&liquid->seed) / RAND_MAX;
}

static double energy_at(const struct liquid *liquid, double r) {
    const struct mesofit_columns *table = liquid->table;
    if (table == NULL)
        return r < 1 ? truth / 2 * (1 - r) * (1 - r) : 0;
    const double first = table->values[0];
    const double width = (table->values[(table->rows - 1) * 3] - first) / (double)(table->rows - 1);
    const double place = fmax(0, (r - first) / width);
    const size_t row = (size_t)place;
    if (row + 1 >= table->rows)
        return 0;
    const double below = table->values[row * 3 + 1], above = table->values[(row + 1) * 3 + 1];
    return below + (above - below) * (place - (double)row);
}

static double distance(const double a[3], const double b[3]) {
    double square = 0;
    for (int d = 0; d < 3; d++)
        square += pow(a[d] - b[d] - edge * rint((a[d] - b[d]) / edge), 2);
    return sqrt(square);
}

static double energy_of(const struct liquid *liquid, size_t bead, const double at[3]) {
    double sum = 0;
    for (size_t k = 0; k < BEADS; k++)
        sum += k == bead ? 0 : energy_at(liquid, distance(liquid->position[k], at));
    return sum;
}

static void sweep(struct liquid *liquid) {
    for (size_t bead = 0; bead < BEADS; bead++) {
        double *own = liquid->position[bead], trial[3];
        for (int d = 0; d < 3; d++)
            trial[d] = own[d] + 0.7 * (draw(liquid) - 0.5);
        if (draw(liquid) < exp(energy_of(liquid, bead, own) - energy_of(liquid, bead, trial)))
            memcpy(own, trial, sizeof trial);
    }
}

static void begin(struct liquid *liquid, unsigned seed) {
    *liquid = (struct liquid){.seed = seed};
    for (size_t k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++)
            liquid->position[k][d] = edge * draw(liquid);
    for (int k = 0; k < 100; k++)
        sweep(liquid);
}

/// g(r) of the truth, as a table of the run.
static void write_target(const char *path) {
    enum { BINS = 25, FRAMES = 4000 };
    static double counts[BINS];
    struct liquid liquid;
    begin(&liquid, 1);
    for (int frame = 0; frame < FRAMES; frame++) {
        sweep(&liquid);
        for (size_t i = 0; i < BEADS; i++)
            for (size_t j = 0; j < i; j++) {
                const double bin = distance(liquid.position[i], liquid.position[j]) / 0.05;
                if (bin < BINS)
                    counts[(int)bin]++;
            }
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "# r[lambda] g[1] error[1]\n");
    for (int k = 0; k < BINS; k++) {
        const double low = 0.05 * k,
                     shell = 4.0 / 3 * 3.14159265 * (pow(low + 0.05, 3) - pow(low, 3));
        const double ideal = FRAMES * 0.5 * BEADS * (BEADS - 1) * shell / pow(edge, 3);
        fprintf(file, "%g %g %g\n", low + 0.025, counts[k] / ideal,
                2 * sqrt(counts[k] + 1) / ideal);
    }
    fclose(file);
}

static void sample(struct mesofit_inversion *inversion, size_t number) {
    const struct mesofit_piece *piece = mesofit_inversion_piece(inversion, number);
    assert_int_equal(piece->beads, BEADS);
    assert_int_equal(piece->dimensions, 3);
    assert_true(fabs(piece->box[0] - edge) < 1e-9 && fabs(piece->temperature - 1) < 1e-9);
    struct mesofit_result *tables = mesofit_inversion_potentials(inversion, number);
    struct mesofit_columns potential;
    assert_ok((enum status)mesofit_result_table(tables, "potential", &potential));
    assert_string_equal(potential.names[1], "phi");
    struct liquid liquid;
    begin(&liquid, (unsigned)piece->seed);
    liquid.table = &potential;
    const size_t frames = (size_t)piece->frames;
    double *positions = calloc(frames, sizeof liquid.position);
    for (int k = 0; k < 60; k++)
        sweep(&liquid);
    for (size_t frame = 0; frame < frames; frame++) {
        for (int k = 0; k < SWEEPS; k++)
            sweep(&liquid);
        memcpy(positions + frame * 3 * BEADS, liquid.position, sizeof liquid.position);
    }
    assert_ok((enum status)mesofit_inversion_tell(
        inversion, number, &(struct mesofit_samples){.positions = positions}));
    free(positions);
    mesofit_result_free(tables);
}

static void write_run(const char *path) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "{\"scene\": {\"box\": [%g, %g, %g], \"particles\": {\"count\": %d}},\n", edge,
            edge, edge, BEADS);
    fputs("\"target\": {\"rdf\": {\"file\": \"g.tsv\", \"particles\": 64}},\n"
          "\"engine\": {\"name\": \"command\", \"frames\": \"frames.extxyz\"},\n"
          "\"verification\": {\"by\": \"mesofit\", \"replicas\": 2, \"equilibration\": 200, "
          "\"samples\": 50},\n"
          "\"method\": {\"name\": \"imc\", \"replicas\": 4, \"samples\": 160, \"precision\": 0.02, "
          "\"iterations\": 12}}\n",
          file);
    fclose(file);
}

static void test_samples_of_the_caller_find_a_known_potential(void **state) {
    struct temporary_folder *const folder = *state;
    char run[1024], out[1024];
    write_target(temporary_folder_file(folder, "g.tsv"));
    snprintf(run, sizeof run, "%s", temporary_folder_file(folder, "run.json"));
    snprintf(out, sizeof out, "%s", temporary_folder_file(folder, "out"));
    write_run(run);
    struct mesofit_inversion *inversion = mesofit_inversion_open(run, out, 0);
    assert_non_null(inversion);
    assert_int_equal(mesofit_inversion_pieces(inversion), 4);
    assert_null(mesofit_inversion_piece(inversion, 4));
    const struct mesofit_samples none = {.positions = NULL};
    assert_int_equal(mesofit_inversion_tell(inversion, 0, &none), MESOFIT_BAD_INPUT);
    assert_int_equal(mesofit_inversion_tell(inversion, 4, &none), MESOFIT_BAD_INPUT);
    const size_t numbers = (size_t)mesofit_inversion_piece(inversion, 0)->frames * BEADS * 3;
    double *wrong = calloc(numbers, sizeof *wrong);
    assert_non_null(wrong);
    for (size_t k = 0; k < numbers; k++) // as of metres
        wrong[k] = 1e-9 * (double)(k % 97) / 97 * edge;
    const struct mesofit_samples other_unit = {.positions = wrong};
    assert_int_equal(mesofit_inversion_tell(inversion, 0, &other_unit), MESOFIT_BAD_INPUT);
    assert_non_null(strstr(mesofit_message(), "look at the unit of their positions"));
    free(wrong);
    sample(inversion, 0);
    mesofit_inversion_free(inversion); // what was told stays
    inversion = mesofit_inversion_open(run, out, 1);
    assert_non_null(inversion);
    assert_int_equal(mesofit_inversion_pieces(inversion), 3);
    int rounds = 0;
    while (mesofit_inversion_pieces(inversion) > 0 && rounds++ < 100) {
        for (size_t n = 0; n < mesofit_inversion_pieces(inversion); n++)
            sample(inversion, n);
        const enum mesofit_status status = mesofit_inversion_go_on(inversion);
        if (status != MESOFIT_OK && status != MESOFIT_UNCONVERGED)
            fail_msg("%s", mesofit_message());
    }
    mesofit_inversion_free(inversion);
    struct mesofit_result *result = mesofit_result_open(out);
    struct mesofit_columns phi;
    assert_ok((enum status)mesofit_result_table(result, "potential", &phi));
    double worst = 0;
    for (size_t k = 0; k < phi.rows; k++) {
        const double r = phi.values[k * phi.columns], found = phi.values[k * phi.columns + 1];
        if (r > 0.4 && r < 1)
            worst = fmax(worst, fabs(found - truth / 2 * (1 - r) * (1 - r)));
    }
    print_message("%d rounds, at most %.2f k_B T_0 off\n", rounds, worst);
    assert_true(worst < 0.35);
    mesofit_result_free(result);
}

static void test_what_cannot_be_opened_says_so(void **state) {
    struct temporary_folder *const folder = *state;
    assert_null(mesofit_inversion_open(temporary_folder_file(folder, "nothing.json"), "out", 0));
    assert_contains(mesofit_message(), "nothing.json");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_samples_of_the_caller_find_a_known_potential,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_what_cannot_be_opened_says_so, temporary_folder_create,
                                        temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
