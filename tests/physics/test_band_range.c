// SPDX-License-Identifier: GPL-3.0-or-later
//
// A potential that ends before the law does: its band knows.
#include "io/data_table.h"
#include "shared/run_program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { R, PHI, FORCE, ERROR, WITHOUT_RAMP };

/// Of runs/standard-set/yukawa/truth.json.
static double law(double r) {
    return 10 * exp(-2 * (r - 1)) / r;
}

/// Of a row of potential.tsv, which is 0 at its range.
static double off(const double *row, double range) {
    return row[PHI] - (law(row[R]) - law(range));
}

/// A screened Coulomb repulsion of which 0.25 k_B T is cut off at 2.4. By its counts alone Φ would
/// be known within 0.01 k_BT, and was 6.6 of its errors off: g up to 2.4 does not tell what lies
/// beyond.
static void test_band_of_a_short_range_has_what_lies_beyond(void **state) {
    static const double range = 2.4;
    static struct run_program_result result;
    char text[1024], folder[512], run[1024], out[1024], path[1100];
    struct data_table table;
    double squares = 0, count = 0, along = 0, ramps = 0, beside = 0;
    assert_non_null(getcwd(folder, sizeof folder));
    const int length = snprintf(
        text, sizeof text,
        "{\"target\": {\"rdf\": {\"file\": \"%s/runs/standard-set/yukawa/rdf.tsv\", \"particles\": "
        "1000, \"cutoff\": %g, \"errors_of\": \"samples\"}},"
        " \"scene\": {\"density\": 0.5, \"temperature\": 1}}",
        folder, range);
    assert_in_range(length, 1, sizeof text - 1);
    snprintf(run, sizeof run, "%s",
             temporary_folder_write(*state, "run.json", text, (size_t)length));
    snprintf(out, sizeof out, "%s", temporary_folder_file(*state, "out"));
    run_program(&result, &(struct run_program_how){.work_limit = 600},
                (const char *const[]){"fit", run, "-o", out, "--quiet", NULL});
    run_program_assert_code(&result, 0);
    snprintf(path, sizeof path, "%s/potential.tsv", out);
    assert_ok(mf_data_table_read(&table, path, ERROR));
    for (size_t k = 0; k + 1 < table.rows; k++) {
        const double *row = table.values + k * table.columns, ramp = 1 - row[R] / range;
        if (!(row[ERROR] > 0))
            continue;
        squares += pow(off(row, range) / row[ERROR], 2);
        along += ramp * off(row, range);
        ramps += ramp * ramp;
        count++;
    }
    for (size_t k = 0; k + 1 < table.rows; k++) {
        const double *row = table.values + k * table.columns;
        if (row[ERROR] > 0)
            beside += pow(
                (off(row, range) - along / ramps * (1 - row[R] / range)) / row[WITHOUT_RAMP], 2);
    }
    mf_data_table_clear(&table);
    print_message("rms of Phi - law in its errors: %.2f, without the ramp %.2f\n",
                  sqrt(squares / count), sqrt(beside / count));
    assert_true(count > 20);
    assert_true(sqrt(squares / count) < 1.3);
    assert_true(sqrt(squares / count) > 0.1);
    assert_true(sqrt(beside / count) < 2); // 3.6 if a shorter range were no more than a ramp
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_band_of_a_short_range_has_what_lies_beyond,
                                        temporary_folder_create, temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
