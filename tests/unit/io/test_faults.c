// SPDX-License-Identifier: GPL-3.0-or-later
//
// Faults of one input: told together, each once, and taken back when another explains it.
#include "io/faults.h"
#include "shared/testing.h"

#include <stdio.h>

static void add(struct faults *faults, const char *const *lines) {
    *faults = (struct faults){0};
    for (; *lines; lines++)
        mf_faults_add(faults, *lines);
}

static const char *reported(const struct faults *faults) {
    return mf_faults_status(faults) == STATUS_OK ? "" : mf_status_message();
}

static void test_faults_add_tells_a_line_once(void **state) {
    (void)state;
    struct faults faults;
    add(&faults, (const char *const[]){"f: a", "f: ab", "f: a", "f: b", "f: b", NULL});
    assert_int_equal(faults.count, 3);
    assert_string_equal(reported(&faults), "f: a\nf: ab\nf: b");
}

static void test_faults_take_back_the_line_that_begins_so(void **state) {
    (void)state;
    static const char *const lines[] = {"f: a: x", "f: b: x", "f: c: x", NULL};
    static const struct {
        const char *words, *left;
    } cases[] = {{"f: a:", "f: b: x\nf: c: x"},
                 {"f: b:", "f: a: x\nf: c: x"},
                 {"f: c:", "f: a: x\nf: b: x"},
                 {"b:", "f: a: x\nf: b: x\nf: c: x"},
                 {"f: d:", "f: a: x\nf: b: x\nf: c: x"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct faults faults;
        add(&faults, lines);
        mf_faults_take_back(&faults, cases[k].words);
        assert_string_equal(reported(&faults), cases[k].left);
        mf_faults_add(&faults, "f: e");
        assert_int_equal(faults.length, strlen(faults.text));
        assert_contains(reported(&faults), "x\nf: e");
    }
}

static void test_faults_are_none_when_all_are_taken_back(void **state) {
    (void)state;
    struct faults faults;
    add(&faults, (const char *const[]){"f: a", NULL});
    mf_faults_take_back(&faults, "f: a");
    assert_ok(mf_faults_status(&faults));
    mf_faults_take_back(&faults, "f: a");
    mf_faults_add(&faults, "f: b");
    assert_string_equal(reported(&faults), "f: b");
}

/// Of more faults than are told, one that is taken back leaves the rest counted.
static void test_faults_are_counted_when_there_are_too_many(void **state) {
    (void)state;
    struct faults faults = {0};
    for (int k = 0; k < FAULTS_REPORTED + 5; k++) {
        char line[16];
        snprintf(line, sizeof line, "f: %d.", k);
        mf_faults_add(&faults, line);
    }
    assert_contains(reported(&faults), "\n… and 5 more faults");
    mf_faults_take_back(&faults, "f: 3.");
    assert_contains(reported(&faults), "\n… and 5 more faults");
    assert_null(strstr(reported(&faults), "f: 3."));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faults_add_tells_a_line_once),
        cmocka_unit_test(test_faults_take_back_the_line_that_begins_so),
        cmocka_unit_test(test_faults_are_none_when_all_are_taken_back),
        cmocka_unit_test(test_faults_are_counted_when_there_are_too_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
