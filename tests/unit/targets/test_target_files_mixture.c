// SPDX-License-Identifier: GPL-3.0-or-later
//
// "rdf" of a mixture in a run file: a partial g(r) for each pair type.
#include "targets/target_files.h"

#include "observe/rdf_observable.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BINS = 4 };

static const struct composition binary = {.types = 2, .count = {100, 300}, .name = {"A", "B"}};
static const struct box box = {2, {20, 20, 1}};
static const struct units units = {.length = 0.5, .temperature = 300.68, .mass = 1e-26};

static void put(void **state, const char *name, const char *text) {
    temporary_folder_write(*state, name, text, strlen(text));
}

static void write_tables(void **state) {
    put(state, "aa.tsv", "0.05 0 0\n0.15 0.5 0.1\n0.25 1.5 0.2\n0.35 1 0.3\n");
    put(state, "ab.tsv", "0.05 0.1 0\n0.15 0.6 0.1\n0.25 1.6 0.2\n0.35 1.1 0.3\n");
    put(state, "bb.tsv", "0.05 0.2 0\n0.15 0.7 0.1\n0.25 1.7 0.2\n0.35 1.2 0.3\n");
}

/// Read a target of pairs with `members`; the status is that of the document.
static enum status read_as(void **state, const char *name, const char *members,
                           struct target_files *targets) {
    char text[1024];
    struct json_document *document;
    const int length = snprintf(text, sizeof text, "{\"target\": {\"%s\": {%s}}}", name, members);
    assert_in_range(length, 1, sizeof text - 1);
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, (size_t)length)));
    struct json_object root = mf_json_root(document);
    assert_ok(
        mf_target_files_read(targets, &root, &(struct target_scene){&box, &binary, NULL, &units}));
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

static enum status read(void **state, const char *members, struct target_files *targets) {
    return read_as(state, "rdf", members, targets);
}

#define AA "\"A-A\": {\"file\": \"aa.tsv\"}"
#define AB "\"A-B\": {\"file\": \"ab.tsv\"}"
#define BA "\"B-A\": {\"file\": \"ab.tsv\"}"
#define BB "\"B-B\": {\"file\": \"bb.tsv\"}"

static void check_values(const struct targets *targets) {
    static const double first[] = {0, 0.5, 1.5, 1}, errors[] = {0, 0.1, 0.2, 0.3};
    assert_int_equal(targets->bins.count, BINS);
    assert_int_equal(targets->target[TARGET_RDF].count, 3 * BINS);
    for (int n = 0; n < 3 * BINS; n++) {
        assert_close(targets->target[TARGET_RDF].value[n], first[n % BINS] + 0.1 * (n / BINS),
                     1e-12);
        assert_close(targets->target[TARGET_RDF].error[n], errors[n % BINS], 1e-12);
    }
}

static void test_targets_read_takes_pairs_in_any_order_and_either_name(void **state) {
    static const char *const members[] = {AA ", " AB ", " BB, BB ", " BA ", " AA ", \"weight\": 7"};
    write_tables(state);
    for (int k = 0; k < 2; k++) {
        struct target_files t;
        struct targets fitted, compared;
        assert_ok(read(state, members[k], &t));
        mf_target_files_targets(&t, false, &fitted, &compared);
        check_values(&fitted);
        assert_close(fitted.target[TARGET_RDF].weight, k ? 7 : 0, 0);
        mf_target_files_clear(&t);
    }
}

/// What goes further than the others ends with them.
static void test_targets_read_cuts_pairs_to_the_shortest(void **state) {
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    put(state, "more.tsv", "0.05 0 0\n0.15 1 0\n0.25 1.25 0\n0.35 1 0\n0.45 1 0\n");
    assert_ok(read(state, AA ", \"B-A\": {\"file\": \"more.tsv\"}, " BB, &t));
    mf_target_files_targets(&t, false, &fitted, &compared);
    assert_int_equal(fitted.bins.count, 4);
    assert_close(target_files_rdf(&t)->ends[0], 0.4, 1e-12);
    assert_close(target_files_rdf(&t)->ends[1], 0.5, 1e-12);
    assert_int_equal(fitted.target[TARGET_RDF].count, 12);
    assert_close(fitted.target[TARGET_RDF].value[4 + 2], 1.25, 1e-12);
    mf_target_files_clear(&t);
}

/// What errors are of is said by all files together: a table without errors has those of the
/// scatter of its rows, each bin's own unless it says that they are of samples.
static void test_targets_read_tells_what_errors_are_of(void **state) {
#define SAYS(pair, file) "\"" pair "\": {\"file\": \"" file "\", \"errors_of\": \"samples\"}"
    static const struct {
        const char *members;
        enum target_errors of;
    } cases[] = {{AA ", " AB ", " BB, TARGET_ERRORS_UNKNOWN},
                 {AA ", " AB ", " SAYS("B-B", "bb.tsv"), TARGET_ERRORS_UNKNOWN},
                 {AA ", " AB ", \"B-B\": {\"file\": \"none.tsv\"}", TARGET_ERRORS_OF_BINS},
                 {SAYS("A-A", "aa.tsv") ", " SAYS("A-B", "ab.tsv") ", " SAYS("B-B", "none.tsv"),
                  TARGET_ERRORS_OF_SAMPLES}};
    write_tables(state);
    put(state, "none.tsv", "0.05 0\n0.15 0.7\n0.25 1.7\n0.35 1.2\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct target_files t;
        struct targets fitted, compared;
        assert_ok(read(state, cases[k].members, &t));
        mf_target_files_targets(&t, false, &fitted, &compared);
        assert_int_equal(fitted.target[TARGET_RDF].errors_of, cases[k].of);
        mf_target_files_clear(&t);
    }
}

static void assert_refused(void **state, const char *members, const char *first,
                           const char *second) {
    struct target_files t;
    assert_fails(read(state, members, &t), STATUS_BAD_INPUT, first);
    assert_contains(mf_status_message(), second);
    mf_target_files_clear(&t);
}

/// Whether the others are known is asked where the scene is (defaults/fit_check).
static void test_targets_read_takes_some_pairs_alone(void **state) {
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    assert_ok(read(state, AA ", " BB, &t));
    mf_target_files_targets(&t, false, &fitted, &compared);
    assert_int_equal(fitted.target[TARGET_RDF].count, 3 * BINS);
    for (int pair = 0; pair < 3; pair++) {
        assert_int_equal(mf_targets_have_pair(&fitted, (size_t)pair), pair != 1);
        assert_int_equal(isnan(fitted.target[TARGET_RDF].value[pair * BINS + 2]), pair == 1);
    }
    mf_target_files_clear(&t);
}

static void test_targets_read_refuses_a_mixture_that_is_not_complete(void **state) {
    write_tables(state);
    put(state, "other.tsv", "0.1 0 0\n0.3 0.5 0.1\n0.5 1.5 0.2\n0.7 1 0.3\n");
    assert_refused(state, "", "a.json: target.rdf.A-A", "missing");
    assert_refused(state, AA ", " AB ", " BB ", \"A-C\": {\"file\": \"aa.tsv\"}", "target.rdf.A-C",
                   "unknown pair");
    assert_refused(state, AA ", " AB ", " BA ", " BB, "target.rdf.B-A", "duplicate pair");
    assert_refused(state, "\"file\": \"aa.tsv\"", "target.rdf.A-A", "missing");
    assert_refused(state, AA ", " AB ", \"B-B\": {\"file\": \"other.tsv\"}", "target.rdf.B-B",
                   "must have the bins of \"A-A\"");
    assert_refused(state, AA ", " AB ", \"B-B\": {\"file\": \"none.tsv\"}", "target.rdf.B-B.file",
                   "none.tsv");
    assert_refused(state, AA ", " AB ", \"B-B\": {\"file\": \"bb.tsv\", \"g_colum\": 2}",
                   "target.rdf.B-B.g_colum", "did you mean \"g_column\"?");
}

/// What is written is read again as it was.
static void test_targets_write_gives_a_mixture_back(void **state) {
    struct target_files t, again;
    struct targets fitted, compared;
    struct json_document *document;
    write_tables(state);
    assert_ok(read(state, BA ", " BB ", \"fitted\": \"yes\", " AA, &t));
    struct json_writer *writer = mf_json_writer_create();
    mf_target_files_write(&t, writer);
    const char *path = temporary_folder_file(*state, "b.json");
    assert_ok(mf_json_write(writer, path));
    mf_json_writer_free(writer);
    assert_ok(mf_json_open(&document, path));
    struct json_object root = mf_json_root(document);
    assert_ok(
        mf_target_files_read(&again, &root, &(struct target_scene){&box, &binary, NULL, &units}));
    mf_json_finish(&root);
    assert_ok(mf_json_close(document, STATUS_OK));
    mf_target_files_targets(&again, false, &fitted, &compared);
    check_values(&compared);
    mf_target_files_clear(&t);
    mf_target_files_clear(&again);
}

/// Isotopes have the g of the whole for every pair type, whatever their shares are. In two
/// dimensions the whole counts as incompressible.
static void test_targets_read_converts_every_pair_by_all_particles(void **state) {
#define FROM(file) "{\"file\": \"" file "\", \"particles\": 50}"
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    assert_ok(read(
        state, "\"A-A\": " FROM("aa.tsv") ", \"A-B\": " FROM("ab.tsv") ", \"B-B\": " FROM("bb.tsv"),
        &t));
    const double factor = (1 - 1.0 / 50) / (1 - 1.0 / 400);
    for (int again = 0; again < 2; again++) {
        mf_target_files_targets(&t, false, &fitted, &compared);
        const double *g = fitted.target[TARGET_RDF].value, *error = fitted.target[TARGET_RDF].error;
        for (int pair = 0; pair < 3; pair++) {
            assert_close(g[pair * BINS + 2], (1.5 + 0.1 * pair) * factor, 1e-12);
            assert_close(error[pair * BINS + 2], 0.2 * factor, 1e-12);
        }
    }
    mf_target_files_clear(&t);
}

static void test_targets_read_takes_the_structure_between_molecules_of_every_pair(void **state) {
    const int kind = mf_rdf_intermolecular_kind();
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    assert_ok(read_as(state, "intermolecular_rdf", BB ", " BA ", " AA, &t));
    mf_target_files_targets(&t, false, &fitted, &compared);
    assert_int_equal(fitted.target[TARGET_RDF].count, 0);
    assert_int_equal(fitted.target[kind].count, 3 * BINS);
    for (int pair = 0; pair < 3; pair++)
        assert_close(fitted.target[kind].value[pair * BINS + 2], 1.5 + 0.1 * pair, 1e-12);
    mf_target_files_clear(&t);
    assert_fails(read_as(state, "intermolecular_rdf", AA ", " BB, &t), STATUS_BAD_INPUT,
                 "a.json: target.intermolecular_rdf.A-B: missing");
    mf_target_files_clear(&t);
}

static void test_targets_digest_knows_every_pair(void **state) {
    struct target_files t;
    uint64_t before = 1;
    write_tables(state);
    assert_ok(read(state, AA ", " AB ", " BB, &t));
    mf_target_files_digest(&t, &before);
    for (int n = 0; n < 3 * BINS; n++) {
        uint64_t after = 1;
        target_files_rdf(&t)->g[n] += 1;
        mf_target_files_digest(&t, &after);
        assert_true(after != before);
        target_files_rdf(&t)->g[n] -= 1;
    }
    mf_target_files_clear(&t);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_targets_read_takes_pairs_in_any_order_and_either_name),
        TEST(test_targets_read_cuts_pairs_to_the_shortest),
        TEST(test_targets_read_tells_what_errors_are_of),
        TEST(test_targets_read_takes_some_pairs_alone),
        TEST(test_targets_read_refuses_a_mixture_that_is_not_complete),
        TEST(test_targets_write_gives_a_mixture_back),
        TEST(test_targets_read_converts_every_pair_by_all_particles),
        TEST(test_targets_read_takes_the_structure_between_molecules_of_every_pair),
        TEST(test_targets_digest_knows_every_pair),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
