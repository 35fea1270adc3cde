// SPDX-License-Identifier: GPL-3.0-or-later
//
// Distributions of bonds, angles and dihedrals as files have them.
#include "targets/target_bonded.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// λ is half a nanometre.
static const struct units units = {.length = 0.5, .temperature = 300.68, .mass = 1e-26};

/// Read `table` as the target of a group "b"; the status is that of the document.
static enum status read(void **state, const char *table, const char *members, int order,
                        struct target_bonded *target) {
    char text[512];
    struct json_document *document;
    temporary_folder_write(*state, "p.tsv", table, strlen(table));
    const int length = snprintf(text, sizeof text, "{\"b\": {\"file\": \"p.tsv\"%s}}", members);
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, (size_t)length)));
    struct json_object root = mf_json_root(document);
    struct json_object object = mf_json_child(&root, "b", true);
    assert_ok(mf_target_bonded_read(target, order, "b", &object, &units, 3));
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

/// Rows of a normal distribution with `rows` of them from `low` on, and `end` after each.
static char *normal(double low, double width, int rows, double mean, double sigma, double scale,
                    const char *end) {
    char *text = calloc(1, 64 * (size_t)rows + 1);
    for (int k = 0; k < rows; k++) {
        const double q = low + k * width;
        const double p = scale * exp(-pow((q - mean) / sigma, 2) / 2) / (sigma * sqrt(2 * M_PI));
        snprintf(text + strlen(text), 64, "%.8g %.8g%s\n", q, p * sigma > 1e-9 ? p : 0, end);
    }
    return text;
}

static void assert_refused(void **state, char *table, const char *members, int order,
                           const char *part) {
    struct target_bonded target;
    assert_fails(read(state, table, members, order, &target), STATUS_BAD_INPUT, part);
    assert_contains(mf_status_message(), "a.json: b.file: ");
    assert_int_equal(target.bins.count, 0);
    mf_target_bonded_clear(&target);
    free(table);
}

#define VOTCA ", \"format\": \"votca\""

static void test_target_bonded_reads_lengths_of_votca(void **state) {
    struct target_bonded target;
    char *table = normal(0, 0.001, 300, 0.15, 0.005, 1, " i");
    assert_ok(read(state, table, VOTCA, BONDED_BOND, &target));
    // From nm: λ is 0.5 nm. What was not seen is left out, but for two bins.
    assert_close(target.bins.width, 0.002, 1e-12);
    size_t peak = 0;
    double sum = 0, mean = 0;
    for (size_t k = 0; k < target.bins.count; k++) {
        peak = target.value[k] > target.value[peak] ? k : peak;
        sum += target.bins.width * target.value[k];
        mean += target.bins.width * target.value[k] * bonded_bins_centre(&target.bins, k);
    }
    assert_close(sum, 1, 1e-12);
    assert_close(mean, 0.3, 1e-6);
    assert_close(bonded_bins_centre(&target.bins, peak), 0.3, 1e-9);
    assert_close(target.value[0] + target.value[1], 0, 0);
    assert_true(target.value[2] > 0);
    mf_target_bonded_clear(&target);
    free(table);
}

static void test_target_bonded_reads_angles_in_radians_and_degrees(void **state) {
    struct target_bonded votca, degrees;
    const double radian = 180 / M_PI;
    char *first = normal(0, 0.01, 315, 1.9, 0.05, 1, " i");
    char *second = normal(0, 0.01 * radian, 315, 1.9 * radian, 0.05 * radian, 1, "");
    assert_ok(read(state, first, VOTCA, BONDED_ANGLE, &votca));
    assert_ok(read(state, second, "", BONDED_ANGLE, &degrees));
    assert_int_equal(votca.bins.count, degrees.bins.count);
    assert_close(votca.bins.low, degrees.bins.low, 1e-6);
    for (size_t k = 0; k < votca.bins.count; k++)
        assert_close(votca.value[k], degrees.value[k], 1e-6);
    mf_target_bonded_clear(&votca);
    mf_target_bonded_clear(&degrees);
    free(first);
    free(second);
}

/// Dihedrals begin and end with half a bin about ±π, or both with all of that bin, normalised with
/// (VOTCA's histograms) or without the second.
static void test_target_bonded_joins_the_ends_of_a_circle(void **state) {
    enum { ROWS = 101 };
    static const struct {
        double ends, all; // part of p in both ends, integral of all rows
    } cases[] = {{0.5, 1}, {1, 1}, {1, 1 + 0.5 / (ROWS - 1)}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        struct target_bonded target;
        char table[64 * ROWS] = "";
        for (int k = 0; k < ROWS; k++) {
            const double phi = -M_PI + 2 * M_PI * k / (ROWS - 1);
            const double p = (1 + 0.5 * cos(phi)) / (2 * M_PI) / cases[n].all;
            snprintf(table + strlen(table), 64, "%.8f %.10f i\n", phi,
                     k == 0 || k == ROWS - 1 ? p * cases[n].ends : p);
        }
        assert_ok(read(state, table, VOTCA, BONDED_DIHEDRAL, &target));
        assert_int_equal(target.bins.count, ROWS - 1);
        assert_close(target.bins.width * (double)target.bins.count, 360, 1e-9);
        assert_close(bonded_bins_centre(&target.bins, 0), -180, 1e-4);
        assert_close(target.value[0], 0.5 / 360, 1e-6);
        assert_close(target.value[50], 1.5 / 360, 1e-6);
        mf_target_bonded_clear(&target);
    }
}

/// Counts of a stiff bond, whose p is steeper than its noise: σ² is that of counts.
static void test_target_bonded_tells_the_errors_of_counts(void **state) {
    enum { ROWS = 40, COUNT = 40000 };
    struct target_bonded target;
    struct rng_sequence random = mf_rng_sequence_begin(5, RNG_PLACEMENT, 1, 2);
    int counts[ROWS] = {0};
    char table[64 * ROWS] = "";
    for (int k = 0; k < COUNT; k++) {
        double sum = -6; // nearly normal: the sum of twelve uniform numbers
        for (int n = 0; n < 12; n++)
            sum += mf_rng_sequence_uniform(&random);
        counts[(int)floor(20 + 4 * sum)]++;
    }
    for (int k = 0; k < ROWS; k++)
        snprintf(table + strlen(table), 64, "%.8f %.10g\n", 1 + 0.01 * k,
                 counts[k] / (0.01 * COUNT));
    assert_ok(read(state, table, "", BONDED_BOND, &target));
    assert_false(target.assumed);
    const double peak = 4000; // counts: 40000/(4 sqrt(2 pi)) = 3989
    // Some 12 differences tell a variance within 40 %, an error within 20 %.
    assert_true(target.estimated_error * sqrt(peak) > 0.5);
    assert_true(target.estimated_error * sqrt(peak) < 1.8);
    mf_target_bonded_clear(&target);
}

/// Two bins between others have no count and a scatter of 0: their error is that of one count.
static void test_target_bonded_of_what_was_not_seen_has_the_error_of_one_count(void **state) {
    static const int counts[] = {1, 0, 4, 16, 50, 21, 4, 0, 3, 1};
    struct target_bonded target;
    char table[1024] = "";
    for (int k = 0; k < 10; k++)
        snprintf(table + strlen(table), 64, "%.2f\t%.6g\t%.6g\n", 1 + 0.1 * k, counts[k] / 10.0,
                 sqrt(counts[k]) / 10);
    assert_ok(read(state, table, "", BONDED_BOND, &target));
    assert_close(target.error[1], 0.1, 1e-5);
    assert_close(target.error[7], 0.1, 1e-5);
    assert_close(target.error[4], sqrt(0.5), 1e-5);
    mf_target_bonded_clear(&target);
}

static void test_target_bonded_finds_columns_by_the_name_of_the_group(void **state) {
    struct target_bonded target;
    char table[2048] = "# r[lambda]\ta[1/lambda]\tb[1/lambda]\tb_error[1/lambda]\n";
    for (int k = 0; k < 10; k++)
        snprintf(table + strlen(table), 64, "%.2f\t7\t%.3f\t%.3f\n", 1 + 0.1 * k, 1.0, 0.01 * k);
    assert_ok(read(state, table, "", BONDED_BOND, &target));
    assert_close(target.value[3], 1, 1e-9);
    assert_close(target.error[3], 0.03, 1e-9);
    assert_close(target.estimated_error, 0, 0);
    mf_target_bonded_clear(&target);
}

static void test_target_bonded_refuses_nonsense(void **state) {
    assert_refused(state, normal(0, 0.01, 300, 1.5, 0.05, 1.03, ""), "", BONDED_BOND,
                   "the integral of p is 1.03, not 1");
    assert_refused(state, normal(0, 0.01, 315, 1.9, 0.05, 1, ""), "", BONDED_ANGLE,
                   "as if in radians");
    assert_refused(state, strdup("0 0.9\n0 2.7\n0.1 4.5\n0.4 6.3\n"), "", BONDED_ANGLE,
                   "p.tsv:2: column 1: 0 does not increase from 0 in line 1 (are the columns");
    assert_refused(state, normal(0, 1, 181, 110, 5, 1, " i"), VOTCA, BONDED_ANGLE,
                   "as if in degrees");
    assert_refused(state, normal(0, 2, 181, 110, 5, 1, ""), "", BONDED_ANGLE,
                   "the range is 0 to 360; expected angles from 0 to 180");
    assert_refused(state, normal(-1, 0.01, 300, 0.5, 0.05, 1, ""), "", BONDED_BOND,
                   "expected lengths from 0");
    assert_refused(state, normal(-90, 1, 181, 0, 20, 1, ""), "", BONDED_DIHEDRAL,
                   "expected dihedrals from -180 to 180 degrees");
    assert_refused(state, normal(1, 0.1, 5, 1.2, 0.1, 1, ""), "", BONDED_BOND, "only 5 bins");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_target_bonded_reads_lengths_of_votca,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_target_bonded_reads_angles_in_radians_and_degrees,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_target_bonded_joins_the_ends_of_a_circle,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(
            test_target_bonded_of_what_was_not_seen_has_the_error_of_one_count,
            temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_target_bonded_tells_the_errors_of_counts,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_target_bonded_finds_columns_by_the_name_of_the_group,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_target_bonded_refuses_nonsense,
                                        temporary_folder_create, temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
