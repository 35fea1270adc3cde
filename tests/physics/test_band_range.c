// SPDX-License-Identifier: GPL-3.0-or-later
//
// A potential that ends before the law does: its band knows.
#include "io/data_table.h"
#include "shared/length.h"
#include "shared/run_program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { R, PHI, FORCE, ERROR, WITHOUT_RAMP };

/// Of runs/standard-set/yukawa/truth.json.
static double yukawa(double r) {
    return 10 * exp(-2 * (r - 1)) / r;
}

/// Of runs/standard-set/hertzian/truth.json, which ends at 1.
static double hertz(double r) {
    return r < 1 ? 50 * pow(1 - r, 2.5) : 0;
}

/// A system of the standard set by its folder, fitted up to a range.
struct cut {
    const char *folder;
    double (*law)(double r);
    double range;
    const char *state, *pressure; ///< of the scene; what stands beside the target of g
};

/// What the errors of its potential are worth.
struct worth {
    double off, beside; ///< rms of Φ − law in its errors, and without its ramp in those without it
    double error;       ///< rms where the law is 0.1 to 3 k_B T
};

static struct data_table fit(void **state, const struct cut *cut, int seed) {
    static struct run_program_result result;
    char text[1024], folder[512], run[1024], out[1024], path[1100], of_seed[16];
    struct data_table table;
    assert_non_null(getcwd(folder, sizeof folder));
    const int length =
        snprintf(text, sizeof text,
                 "{\"target\": {\"rdf\": {\"file\": \"%s/runs/standard-set/%s/rdf.tsv\", "
                 "\"particles\": 1000, \"cutoff\": %g, \"errors_of\": \"samples\"}%s}, "
                 "\"scene\": {%s}}",
                 folder, cut->folder, cut->range, cut->pressure, cut->state);
    assert_in_range(length, 1, sizeof text - 1);
    snprintf(run, sizeof run, "%s",
             temporary_folder_write(*state, "run.json", text, (size_t)length));
    snprintf(out, sizeof out, "%s", temporary_folder_file(*state, "out"));
    snprintf(of_seed, sizeof of_seed, "%d", seed);
    run_program(&result, &(struct run_program_how){.work_limit = 600},
                (const char *const[]){"fit", run, "-o", out, "--seed", of_seed, "--force",
                                      "--quiet", NULL});
    run_program_assert_code(&result, 0);
    snprintf(path, sizeof path, "%s/potential.tsv", out);
    assert_ok(mf_data_table_read(&table, path, ERROR));
    return table;
}

static struct worth judge_seed(void **state, const struct cut *cut, int seed) {
    struct data_table table = fit(state, cut, seed);
    double squares = 0, count = 0, along = 0, ramps = 0, beside = 0, error = 0, of_error = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k + 1 < table.rows; k++) {
            const double *row = table.values + k * table.columns;
            const double ramp = 1 - row[R] / cut->range;
            const double law = cut->law(row[R]) - cut->law(cut->range), off = row[PHI] - law;
            if (!(row[ERROR] > 0))
                continue;
            if (pass == 1) {
                beside += pow((off - along / ramps * ramp) / row[WITHOUT_RAMP], 2);
                continue;
            }
            squares += pow(off / row[ERROR], 2);
            along += ramp * off;
            ramps += ramp * ramp;
            count++;
            if (law > 0.1 && law < 3) {
                error += row[ERROR] * row[ERROR];
                of_error++;
            }
        }
    mf_data_table_clear(&table);
    const struct worth worth = {sqrt(squares / count), sqrt(beside / count),
                                sqrt(error / of_error)};
    print_message("%s up to %g%s: off %.2f errors, without the ramp %.2f; error %.4f\n",
                  cut->folder, cut->range, cut->pressure, worth.off, worth.beside, worth.error);
    assert_true(count > 20);
    return worth;
}

/// By two fits, rms: what a fit takes the slope at its end for has the noise of its samples.
static struct worth judge(void **state, const struct cut *cut) {
    const struct worth one = judge_seed(state, cut, 1), two = judge_seed(state, cut, 2);
    return (struct worth){hypot(one.off, two.off) / sqrt(2),
                          hypot(one.beside, two.beside) / sqrt(2),
                          hypot(one.error, two.error) / sqrt(2)};
}

/// A screened Coulomb repulsion of which 0.25 k_B T is cut off at 2.4. By its counts alone Φ would
/// be known within 0.01 k_B T, and was 6.6 of its errors off: g up to 2.4 does not tell what lies
/// beyond.
static void test_band_of_a_short_range_has_what_lies_beyond(void **state) {
    const struct worth worth = judge(
        state, &(struct cut){"yukawa", yukawa, 2.4, "\"density\": 0.5, \"temperature\": 1", ""});
    assert_true(worth.off < 1.3 && worth.off > 0.1);
    assert_true(worth.beside < 2); // 3.6 if a shorter range were no more than a ramp
}

/// The pressure of the law, of which a quarter is cut off, goes into the potential: 45 errors.
static void test_band_of_a_short_range_knows_that_its_pressure_is_that_of_more(void **state) {
    const struct worth worth =
        judge(state, &(struct cut){"yukawa", yukawa, 2.4, "\"density\": 0.5, \"temperature\": 1",
                                   ", \"pressure\": {\"value\": 19.308, \"error\": 0.05}"});
    assert_true(worth.off < 1.3 && worth.off > 0.1);
    assert_true(worth.beside < 4);
}

/// A law that ends where the potential does is known by its counts: of what it has in its last
/// fifth an error of 0.9 would come.
static void test_band_of_a_range_that_fits_the_law_is_that_of_its_counts(void **state) {
    const struct worth worth =
        judge(state, &(struct cut){"hertzian", hertz, 1, "\"density\": 2, \"temperature\": 1", ""});
    assert_true(worth.off < 2);
    assert_true(worth.error < 0.05);
}

#define IN_FOLDER(name)                                                                            \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_band_of_a_short_range_has_what_lies_beyond),
        LENGTH_ONLY_LONG(
            IN_FOLDER(test_band_of_a_short_range_knows_that_its_pressure_is_that_of_more)),
        LENGTH_ONLY_LONG(IN_FOLDER(test_band_of_a_range_that_fits_the_law_is_that_of_its_counts)),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
