// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_output.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

static const struct bench_result fast = {
    .scene = "water",
    .isa = "avx2",
    .precision = "mixed",
    .particles = 2744,
    .threads = 1,
    .temperature = 1.0 / 3,
    .pairs = 187000,
    .steps_per_second = 12345.6,
    .steps_per_second_best = 12400,
    .steps_per_second_spread = 0.0123,
    .particle_steps_per_second = 33876326.4,
    .pairs_per_second = 2308627200,
    .ns_per_pair = 0.43316,
    .ticks_per_pair = 10,
    .phase_share = {0.05, 0.2, 0.75},
    .list_efficiency = 0.7,
    .row_filling = 1,
    .steps_per_build = 0,
    .lammps_steps_per_second = NAN,
    .lammps_ratio = NAN,
};

static char *read_back(struct temporary_folder *folder,
                       void (*print)(FILE *, const struct bench_result *, size_t),
                       const struct bench_result *results, size_t count) {
    const char *file = temporary_folder_file(folder, "output");
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    print(stream, results, count);
    assert_int_equal(fclose(stream), 0);
    return temporary_folder_read(file);
}

static void print_engine(FILE *stream, const struct bench_result *results, size_t count) {
    assert_ok(mf_bench_output_table(stream, results, count, false));
}

static void print_lammps(FILE *stream, const struct bench_result *results, size_t count) {
    assert_ok(mf_bench_output_table(stream, results, count, true));
}

static void print_json(FILE *stream, const struct bench_result *results, size_t count) {
    assert_ok(mf_bench_output_json(stream, results, count));
}

static void test_bench_output_table_is_aligned_and_rounded(void **state) {
    struct bench_result results[] = {fast, fast};
    results[1].isa = "portable";
    results[1].steps_per_second = 1.23456;
    results[1].ns_per_pair = INFINITY;
    char *text = read_back(*state, print_engine, results, 2);
    assert_string_equal(
        text,
        "water: 2744 particles with 136 neighbours in range, 1 thread\n"
        "  isa       precision   median     best  spread  particle-steps  pairs  per pair  per pair"
        "  list  forces  motion  in range  rows full  rebuild\n"
        "                       steps/s  steps/s       %             M/s    M/s        ns     ticks"
        "     %       %       %         %          %    steps\n"
        "  avx2      mixed        12346    12400     1.2            33.9   2309     0.433      10.0"
        "    20      75     5.0      70.0        100     0.00\n"
        "  portable  mixed        1.235    12400     1.2            33.9   2309         -      10.0"
        "    20      75     5.0      70.0        100     0.00\n");
    free(text);
}

static void test_bench_output_table_shows_the_comparison_when_there_is_one(void **state) {
    struct bench_result result = fast;
    snprintf(result.lammps_style, sizeof result.lammps_style, "pair_style lj/cut, skin 0.3");
    result.threads = 2;
    result.lammps_steps_per_second = 1000;
    result.lammps_ratio = 12.3456;
    char *text = read_back(*state, print_lammps, &result, 1);
    assert_string_equal(text, "water: 2744 particles with 136 neighbours in range, 2 threads, "
                              "LAMMPS with pair_style lj/cut, skin 0.3\n"
                              "  isa   precision   median     best  spread   LAMMPS  ratio\n"
                              "                   steps/s  steps/s       %  steps/s      1\n"
                              "  avx2  mixed        12346    12400     1.2     1000   12.3\n");
    free(text);
}

static void test_bench_output_json_has_all_digits_and_no_nan(void **state) {
    struct bench_result results[] = {fast, fast};
    results[1].ns_per_pair = INFINITY;
    char *text = read_back(*state, print_json, results, 2);
    assert_int_equal(strncmp(text, "[{", 2), 0);
    assert_contains(text, "\"scene\":\t\"water\"");
    assert_contains(text, "\"isa\":\t\"avx2\"");
    assert_contains(text, "\"precision\":\t\"mixed\"");
    assert_contains(text, "\"particles\":\t2744,");
    assert_contains(text, "\"temperature\":\t0.33333333333333331,");
    assert_contains(text, "\"forces_share\":\t0.75,");
    const char *first = strstr(text, "\"ns_per_pair\":\t0.43316,");
    assert_non_null(first);
    assert_null(strstr(first + 2, "ns_per_pair"));
    assert_null(strstr(text, "lammps"));
    free(text);
}

/// Columns of the header and of each line are as many; those of LAMMPS are there when compared.
static size_t count_columns(const char *text, size_t lines) {
    size_t columns = 1;
    for (const char *c = text; *c != '\n'; c++)
        columns += *c == '\t';
    for (size_t line = 0; line < lines; line++) {
        size_t here = 1;
        for (; *text != '\n'; text++)
            here += *text == '\t';
        text++;
        assert_int_equal(here, columns);
    }
    assert_int_equal(*text, '\0');
    return columns;
}

static void test_bench_output_tsv_names_every_column(void **state) {
    struct bench_result results[] = {fast, fast};
    char *text = read_back(*state, mf_bench_output_tsv, results, 2);
    assert_int_equal(strncmp(text, "# scene\tisa\tprecision\tparticles[1]\t", 35), 0);
    assert_contains(text, "\tns_per_pair[ns]\t");
    assert_contains(text, "\nwater\tavx2\tmixed\t2744\t1\t");
    const size_t columns = count_columns(text, 3);
    free(text);
    snprintf(results[1].lammps_style, sizeof results[1].lammps_style, "style");
    text = read_back(*state, mf_bench_output_tsv, results, 2);
    assert_contains(text, "\tlammps_ratio[1]\n");
    assert_int_equal(count_columns(text, 3), columns + 2);
    free(text);
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_bench_output_table_is_aligned_and_rounded),
        IN_FOLDER(test_bench_output_table_shows_the_comparison_when_there_is_one),
        IN_FOLDER(test_bench_output_json_has_all_digits_and_no_nan),
        IN_FOLDER(test_bench_output_tsv_names_every_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
