// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/clock.h"
#include "io/json.h"
#include "shared/is_close.h"
#include "shared/sample_fields.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct field required_fields[] = {
    {"strength", FIELD_NUMBER, offsetof(struct sample, strength), true, 0, 0, 1, NULL, "",
     "how strong"},
    FIELD_END,
};

static const char *write_text(void **state, const char *text) {
    return temporary_folder_write(*state, "run.json", text, strlen(text));
}

static struct json_document *open_text(void **state, const char *text) {
    struct json_document *document = NULL;
    assert_ok(mf_json_open(&document, write_text(state, text)));
    return document;
}

/// Read the whole text as one `sample`, unknown keys being faults.
static enum status read_sample(void **state, const char *text, struct sample *sample) {
    struct json_document *document = open_text(state, text);
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, sample_fields, sample);
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

static void assert_fault(void **state, const char *text, const char *part) {
    struct sample sample;
    assert_fails(read_sample(state, text, &sample), STATUS_BAD_INPUT, part);
    assert_null(strchr(mf_status_message(), '\n'));
}

static void assert_malformed(void **state, const char *text, const char *part) {
    struct json_document *document;
    assert_fails(mf_json_open(&document, write_text(state, text)), STATUS_BAD_INPUT, part);
    assert_null(document);
    assert_null(strchr(mf_status_message(), '\n'));
}

// Whole files -------------------------------------------------------------------------------------

static void test_json_open_gives_the_place_when_the_text_is_malformed(void **state) {
    assert_malformed(state, "{\n  \"a\": 1\n  \"b\": 2\n}",
                     "run.json:3:3: expected ',', ':' or a closing bracket");
    assert_malformed(state, "{\"a\": \"\\ud800\"}", "run.json:1:8: expected an escape");
}

static void test_json_open_says_what_is_wrong_when_there_is_no_text(void **state) {
    struct json_document *document;
    struct temporary_folder *folder = *state;
    assert_malformed(state, "", "run.json: the file is empty");
    assert_fails(mf_json_open(&document, temporary_folder_file(folder, "none.json")), STATUS_IO,
                 "none.json: No such file or directory");
    assert_fails(mf_json_open(&document, folder->path), STATUS_IO, ": is a folder, not a file");
    assert_fails(mf_json_open(&document, temporary_folder_write(folder, "nul", "{\n\0}", 4)),
                 STATUS_BAD_INPUT, "nul:2:1: a NUL byte");
    assert_null(document);
}

static void test_json_open_skips_the_byte_order_mark_when_there_is_one(void **state) {
    struct sample sample;
    assert_ok(read_sample(state, "\xEF\xBB\xBF{\"seed\": 3}\r\n", &sample));
    assert_int_equal(sample.seed, 3);
}

static void test_json_root_is_a_fault_when_it_is_not_an_object(void **state) {
    assert_fault(state, "[1]", "run.json: expected an object, found an array");
    assert_fault(state, "\"x\"", "run.json: expected an object, found the text \"x\"");
}

// Fields ------------------------------------------------------------------------------------------

static void test_json_fields_reads_every_type_when_all_are_given(void **state) {
    struct sample sample;
    assert_ok(read_sample(state,
                          "{\"strength\": 0.25, \"steps\": 1e3, \"seed\": 9007199254740991,"
                          " \"lengths\": [1, 2.5], \"name\": \"\\u00e9\\\"\", \"file\": \"/x/y\","
                          " \"kind\": \"soft\", \"kinds\": [\"hard\", \"soft\"]}",
                          &sample));
    assert_identical(sample.strength, 0.25);
    assert_int_equal(sample.steps, 1000);
    assert_int_equal(sample.seed, 9007199254740991);
    assert_identical(sample.lengths[0], 1.0);
    assert_identical(sample.lengths[1], 2.5);
    assert_identical(sample.lengths[2], 0.0);
    assert_string_equal(sample.name, "é\"");
    assert_string_equal(sample.file, "/x/y");
    assert_int_equal(sample.kind, 0);
    assert_int_equal(sample.kinds, 3);
}

static void test_json_fields_gives_defaults_when_nothing_is_given(void **state) {
    struct sample sample;
    memset(&sample, 0x5A, sizeof sample);
    assert_ok(read_sample(state, "{}", &sample));
    assert_identical(sample.strength, 0.1);
    assert_int_equal(sample.steps, 5);
    assert_int_equal(sample.seed, 42);
    assert_identical(sample.lengths[0], 0.0);
    assert_string_equal(sample.name, "");
    assert_int_equal(sample.kind, 1);
    assert_int_equal(sample.kinds, 2);
}

static void test_json_fields_joins_the_folder_when_a_file_is_relative(void **state) {
    struct temporary_folder *folder = *state;
    struct sample sample;
    char expected[2048];
    assert_ok(read_sample(state, "{\"file\": \"a/b.dat\", \"name\": \"a/b.dat\"}", &sample));
    snprintf(expected, sizeof expected, "%s/a/b.dat", folder->path);
    assert_string_equal(sample.file, expected);
    assert_string_equal(sample.name, "a/b.dat");
}

static void test_json_fields_gives_value_and_range_when_out_of_range(void **state) {
    struct sample sample;
    assert_fault(state, "{\"strength\": 1.5}",
                 "run.json: strength: 1.5 is out of range; allowed: 0 to 1 k_B T");
    assert_fault(state, "{\"strength\": -1e-9}", "strength: -1e-09 is out of range");
    assert_fault(state, "{\"steps\": 0}", "steps: 0 is out of range; allowed: at least 1");
    assert_fault(state, "{\"seed\": -1}", "seed: -1 is out of range; allowed: at least 0");
    assert_fault(state, "{\"lengths\": [1, 0]}", "lengths[1]: 0 is out of range; allowed: above 0");
    assert_int_equal(read_sample(state, "{\"strength\": 1.5}", &sample), STATUS_BAD_INPUT);
    assert_identical(sample.strength, 0.1);
    assert_int_equal(read_sample(state, "{\"lengths\": [1, 0]}", &sample), STATUS_BAD_INPUT);
    assert_identical(sample.lengths[0], 0.0);
}

static void test_json_fields_refuses_numbers_when_they_are_not_finite_or_lose_digits(void **state) {
    assert_fault(state, "{\"strength\": 1e999}", "strength: the number is too large");
    assert_fault(state, "{\"strength\": -1e999}", "strength: the number is too large");
    assert_fault(state, "{\"lengths\": [1, 1e999]}", "lengths[1]: the number is too large");
    assert_fault(state, "{\"seed\": 1e999}", "seed: the number is too large");
    assert_fault(state, "{\"seed\": 9007199254740993}",
                 "seed: 9007199254740992 is out of range: whole numbers of 2^53");
    assert_fault(state, "{\"seed\": 9007199254740992}", "and beyond lose digits");
    assert_fault(state, "{\"steps\": 1e300}", "and beyond lose digits");
    assert_fault(state, "{\"steps\": 2.5}", "steps: expected a whole number, found the number 2.5");
}

static void test_json_fields_says_what_it_found_when_the_type_is_wrong(void **state) {
    assert_fault(state, "{\"strength\": \"0.5\"}",
                 "strength: expected a number, found the text \"0.5\"");
    assert_fault(state, "{\"strength\": null}", "strength: expected a number, found null");
    assert_fault(state, "{\"steps\": true}", "steps: expected a whole number, found true");
    assert_fault(state, "{\"name\": 3}", "name: expected a text, found the number 3");
    assert_fault(state, "{\"name\": \"\"}", "name: the text is empty");
    assert_fault(state, "{\"file\": {}}",
                 "file: expected a text with the name of a file, found an "
                 "object");
    assert_fault(state, "{\"lengths\": 3}", "lengths: expected an array of 2 or 3 numbers, found");
    assert_fault(state, "{\"lengths\": [3]}", "lengths: expected 2 or 3 numbers, found 1");
    assert_fault(state, "{\"lengths\": [1,2,3,4]}", "lengths: expected 2 or 3 numbers, found 4");
    assert_fault(state, "{\"lengths\": [1,\"2\"]}",
                 "lengths[1]: expected a number, found the text");
    assert_fault(state, "{\"kind\": 0}", "kind: expected a text, found the number 0");
    assert_fault(state, "{\"kind\": \"sotf\"}",
                 "kind: \"sotf\" is unknown; did you mean \"soft\"?");
    assert_fault(state, "{\"kind\": \"liquid\"}", "kind: \"liquid\" is unknown; known: soft, hard");
    assert_fault(state, "{\"kinds\": \"soft\"}", "kinds: expected a list of texts, found the text");
    assert_fault(state, "{\"kinds\": []}", "kinds: expected a list of texts, found an empty one");
    assert_fault(state, "{\"kinds\": [\"soft\", \"hart\"]}",
                 "kinds: the text \"hart\" is unknown; did you mean \"hard\"?");
    assert_fault(state, "{\"kinds\": [3]}", "kinds: the number 3 is unknown; known: soft, hard");
}

static void test_json_fields_refuses_texts_when_they_do_not_fit(void **state) {
    char text[FIELD_TEXT_SIZE + 64];
    snprintf(text, sizeof text, "{\"name\": \"%01024d\"}", 0);
    assert_fault(state, text, "name: the text is longer than 1023 bytes");
    snprintf(text, sizeof text, "{\"file\": \"%01022d\"}", 0);
    assert_fault(state, text, "file: the text is longer than 1023 bytes");
}

static void test_json_refuses_texts_and_keys_that_are_not_utf_8(void **state) {
    struct sample sample;
    assert_fault(state, "{\"name\": \"caf\xe9\"}",
                 "run.json: name: byte 0xe9 is not UTF-8; save the file as UTF-8");
    assert_ok(
        read_sample(state, "{\"name\": \"caf\u00e9 \u2192\", \"file\": \"caf\xe9\"}", &sample));
    struct json_document *document = open_text(state, "{\"in\": {\"caf\xe9\": 1}}");
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "run.json: in.caf\\xe9: byte 0xe9 is not UTF-8; save the file as UTF-8");
}

static void test_json_fields_demands_required_ones_when_the_object_is_there(void **state) {
    struct sample sample;
    struct json_document *document = open_text(state, "{\"here\": {}}");
    struct json_object root = mf_json_root(document);
    struct json_object here = mf_json_child(&root, "here", false);
    struct json_object absent = mf_json_child(&root, "absent", false);
    mf_json_fields(&absent, required_fields, &sample);
    assert_int_equal(mf_json_fault_count(document), 0);
    mf_json_fields(&here, required_fields, &sample);
    assert_int_equal(mf_json_fault_count(document), 1);
    mf_json_finish(&root);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "run.json: here.strength: missing: expected a number (how strong)");
}

// Keys and objects --------------------------------------------------------------------------------

static void test_json_count_is_of_the_items_of_an_array(void **state) {
    struct json_document *document = open_text(state, "{\"a\": [1, 2, 3], \"b\": [], \"c\": 7}");
    const struct json_object root = mf_json_root(document);
    assert_int_equal(mf_json_count(&root, "a"), 3);
    assert_int_equal(mf_json_count(&root, "b"), 0);
    assert_int_equal(mf_json_count(&root, "c"), 0);
    assert_int_equal(mf_json_count(&root, "d"), 0);
    assert_false(mf_json_is_object(&root, "a"));
    assert_false(mf_json_is_object(&root, "d"));
    assert_ok(mf_json_close(document, STATUS_OK));
}

static void test_json_finish_suggests_the_nearest_key_when_one_is_unknown(void **state) {
    assert_fault(state, "{\"sede\": 1}", "run.json: sede: unknown key; did you mean \"seed\"?");
    assert_fault(state, "{\"Seed\": 1}", "Seed: unknown key; did you mean \"seed\"?");
    assert_fault(
        state, "{\"temperature\": 1}",
        "temperature: unknown key; known: strength, steps, seed, lengths, name, file, kind, kinds");
}

static void test_json_finish_proposes_no_key_that_is_refused(void **state) {
    struct json_document *document =
        open_text(state, "{\"a\": 1, \"old\": 1, \"away\": 1, \"other\": 1}");
    struct json_object root = mf_json_root(document);
    mf_json_retired(&root, "old", NULL, "leave it out");
    mf_json_refuse(&root, "away", "it stands elsewhere");
    assert_true(mf_json_has(&root, "a"));
    mf_json_finish(&root);
    assert_int_equal(mf_json_fault_count(document), 3);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "run.json: old: no longer a key: leave it out");
    assert_contains(mf_status_message(), "run.json: away: unknown key: it stands elsewhere");
    assert_contains(mf_status_message(), "run.json: other: unknown key; known: a");
    assert_null(strstr(mf_status_message(), "known: a,"));
}

static void test_json_open_records_a_fault_when_a_key_stands_twice(void **state) {
    assert_fault(state, "{\"seed\": 1, \"seed\": 1}", "run.json: seed: duplicate key");
    struct json_document *document =
        open_text(state, "{\"a\": [{\"x\": 1}, {\"b\": {\"c\": 1, \"d\": 2, \"c\": 3}}]}");
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "run.json: a[1].b.c: duplicate key");
}

static void test_json_child_reports_paths_when_objects_are_nested(void **state) {
    struct json_document *document = open_text(state, "{\"a\": {\"b\": {\"x\": 1}, \"c\": 3}}");
    struct json_object root = mf_json_root(document);
    struct json_object a = mf_json_child(&root, "a", true);
    struct json_object b = mf_json_child(&a, "b", true);
    struct json_object c = mf_json_child(&a, "c", false);
    struct json_object d = mf_json_child(&a, "d", true);
    assert_true(mf_json_has(&a, "b"));
    assert_false(mf_json_has(&a, "B"));
    assert_null(c.item);
    assert_null(d.item);
    mf_json_fault(&b, "x", "must be below %d", 1);
    mf_json_fault(&b, NULL, "is odd");
    mf_json_finish(&d);
    mf_json_finish(&b);
    char expected[8192];
    const char *file = ((struct temporary_folder *)*state)->file;
    snprintf(expected, sizeof expected,
             "%s: a.c: expected an object, found the number 3\n"
             "%s: a.d: missing: expected an object\n"
             "%s: a.b.x: must be below 1\n"
             "%s: a.b: is odd\n"
             "%s: a.b.x: unknown key; no name is known here",
             file, file, file, file, file);
    assert_int_equal(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), expected);
}

static void test_json_choice_returns_known_texts_when_given_or_falls_back(void **state) {
    struct json_document *document =
        open_text(state, "{\"law\": \"soft\", \"odd\": \"hrad\", \"number\": 1}");
    struct json_object root = mf_json_root(document);
    assert_string_equal(mf_json_choice(&root, "law", sample_kinds, NULL), "soft");
    assert_string_equal(mf_json_choice(&root, "law", NULL, NULL), "soft");
    assert_string_equal(mf_json_choice(&root, "none", sample_kinds, "hard"), "hard");
    assert_int_equal(mf_json_fault_count(document), 0);
    assert_null(mf_json_choice(&root, "odd", sample_kinds, NULL));
    assert_null(mf_json_choice(&root, "number", sample_kinds, "hard"));
    assert_null(mf_json_choice(&root, "missing", sample_kinds, NULL));
    mf_json_finish(&root);
    assert_int_equal(mf_json_fault_count(document), 3);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT, "did you mean \"hard\"?");
    assert_contains(mf_status_message(), "number: expected a text, found the number 1");
    assert_contains(mf_status_message(), "missing: missing: expected a text");
}

static void test_json_close_counts_the_rest_when_faults_are_many(void **state) {
    struct json_document *document = open_text(state, "{}");
    struct json_object root = mf_json_root(document);
    for (int k = 0; k < 27; k++)
        mf_json_fault(&root, NULL, "fault %d", k);
    assert_int_equal(mf_json_fault_count(document), 27);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "fault 19\n… and 7 more faults");
    assert_null(strstr(mf_status_message(), "fault 20"));
}

static void test_json_close_drops_whole_lines_when_faults_are_long(void **state) {
    struct json_document *document = open_text(state, "{}");
    struct json_object root = mf_json_root(document);
    for (int k = 0; k < 10; k++)
        mf_json_fault(&root, NULL, "%01500d end", k);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "04 end\n… and 5 more faults");
}

/// 160 000 keys took minutes; more than a thousand have no meaning in any file.
static void test_json_open_refuses_more_keys_than_can_be_looked_for(void **state) {
    enum { MANY = 160000 };
    char *text = malloc(MANY * 16 + 16), *end = text;
    struct json_document *document = NULL;
    assert_non_null(text);
    for (int count = JSON_MAX_MEMBERS; count <= MANY; count += MANY - JSON_MAX_MEMBERS) {
        end = text + sprintf(text, "{\"a\": {");
        for (int k = 0; k < count; k++)
            end += sprintf(end, "%s\"k%d\": 1", k ? ", " : "", k);
        sprintf(end, "}}");
        const double begun = clock_thread_seconds();
        const enum status status = mf_json_open(&document, write_text(state, text));
        assert_true(clock_thread_seconds() - begun < 10);
        assert_int_equal(status, count > JSON_MAX_MEMBERS ? STATUS_BAD_INPUT : STATUS_OK);
        if (status == STATUS_OK)
            assert_ok(mf_json_close(document, STATUS_OK));
    }
    assert_contains(mf_status_message(), "run.json: an object has 160000 keys; 1000 are the most");
    free(text);
}

/// Want of memory is told before what the file says wrong.
static void test_json_close_tells_want_of_memory_first(void **state) {
    struct json_document *document = open_text(state, "{\"a\": 1, \"a\": 2}");
    mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    assert_fails(mf_json_close(document, STATUS_NO_MEMORY), STATUS_NO_MEMORY, "out of memory");
    document = open_text(state, "{\"a\": 1, \"a\": 2}");
    assert_fails(mf_json_close(document, STATUS_IO), STATUS_BAD_INPUT, "duplicate key");
    document = open_text(state, "{}");
    assert_int_equal(mf_json_close(document, STATUS_IO), STATUS_IO);
}

/// A text of a file is shown, not sent to the terminal.
static void test_faults_show_control_characters(void **state) {
    struct sample sample;
    assert_fails(read_sample(state, "{\"strength\": \"\\u001b[31m\\n\"}", &sample),
                 STATUS_BAD_INPUT, "the text \"\\x1b[31m\\x0a\"");
    assert_fails(read_sample(state, "{\"\\u001b]0;x\\u0007\": 1}", &sample), STATUS_BAD_INPUT,
                 "\\x1b]0;x\\x07: unknown key");
}

/// Files that a document names are known by what they are.
static void test_json_collect_files_finds_what_the_fields_name(void **state) {
    struct sample sample;
    struct input_files inputs = {0};
    temporary_folder_write(*state, "table.tsv", "1", 1);
    struct json_document *document = open_text(state, "{\"file\": \"./table.tsv\"}");
    assert_ok(mf_json_collect_files(document, &inputs));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, sample_fields, &sample);
    assert_ok(mf_json_close(document, STATUS_OK));
    assert_int_equal(inputs.count, 2);
    assert_fails(mf_input_files_protect(&inputs, temporary_folder_file(*state, "table.tsv")),
                 STATUS_BAD_INPUT, "/./table.tsv: write elsewhere");
    assert_fails(mf_input_files_protect(&inputs, temporary_folder_file(*state, "run.json")),
                 STATUS_BAD_INPUT, "run.json would be replaced");
    assert_ok(mf_input_files_protect(&inputs, temporary_folder_file(*state, "other.tsv")));
    mf_input_files_clear(&inputs);
}

/// The rules of RFC 7396: null takes away, objects are merged, also into nothing, and all else
/// replaces.
static void test_json_take_variant_merges_it(void **state) {
    double value;
    struct json_document *document =
        open_text(state, "{\"a\": 1, \"b\": {\"c\": 2, \"d\": 3}, \"k\": {\"x\": 1}, \"of\": {\n"
                         "\"first\": {\"a\": 7}, \"second\": {\"a\": 5, \"k\": [4],\n"
                         "\"b\": {\"c\": null, \"e\": {\"f\": null, \"g\": 6}}}}}");
    assert_ok(mf_json_take_variant(document, "of", 1));
    struct json_object root = mf_json_root(document);
    assert_false(mf_json_is_member(&root, "of"));
    assert_int_equal(mf_json_numbers(&root, "a", &value, 1), 1);
    assert_true(value == 5);
    assert_int_equal(mf_json_numbers(&root, "k", &value, 1), 1);
    assert_true(value == 4);
    struct json_object b = mf_json_child(&root, "b", true);
    assert_false(mf_json_is_member(&b, "c"));
    assert_int_equal(mf_json_numbers(&b, "d", &value, 1), 1);
    assert_true(value == 3);
    struct json_object e = mf_json_child(&b, "e", true);
    assert_false(mf_json_is_member(&e, "f"));
    assert_int_equal(mf_json_numbers(&e, "g", &value, 1), 1);
    assert_true(value == 6);
    assert_ok(mf_json_close(document, STATUS_OK));
    document = open_text(state, "{\"of\": {\"first\": 3}}");
    assert_fails(mf_json_take_variant(document, "of", 0), STATUS_BAD_INPUT,
                 "run.json: of.first: expected an object");
    assert_ok(mf_json_close(document, STATUS_OK));
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_json_open_gives_the_place_when_the_text_is_malformed),
        IN_FOLDER(test_json_open_says_what_is_wrong_when_there_is_no_text),
        IN_FOLDER(test_json_open_skips_the_byte_order_mark_when_there_is_one),
        IN_FOLDER(test_json_root_is_a_fault_when_it_is_not_an_object),
        IN_FOLDER(test_json_fields_reads_every_type_when_all_are_given),
        IN_FOLDER(test_json_fields_gives_defaults_when_nothing_is_given),
        IN_FOLDER(test_json_fields_joins_the_folder_when_a_file_is_relative),
        IN_FOLDER(test_json_fields_gives_value_and_range_when_out_of_range),
        IN_FOLDER(test_json_fields_refuses_numbers_when_they_are_not_finite_or_lose_digits),
        IN_FOLDER(test_json_fields_says_what_it_found_when_the_type_is_wrong),
        IN_FOLDER(test_json_fields_refuses_texts_when_they_do_not_fit),
        IN_FOLDER(test_json_refuses_texts_and_keys_that_are_not_utf_8),
        IN_FOLDER(test_json_fields_demands_required_ones_when_the_object_is_there),
        IN_FOLDER(test_json_count_is_of_the_items_of_an_array),
        IN_FOLDER(test_json_finish_suggests_the_nearest_key_when_one_is_unknown),
        IN_FOLDER(test_json_finish_proposes_no_key_that_is_refused),
        IN_FOLDER(test_json_open_records_a_fault_when_a_key_stands_twice),
        IN_FOLDER(test_json_child_reports_paths_when_objects_are_nested),
        IN_FOLDER(test_json_choice_returns_known_texts_when_given_or_falls_back),
        IN_FOLDER(test_json_close_counts_the_rest_when_faults_are_many),
        IN_FOLDER(test_json_close_drops_whole_lines_when_faults_are_long),
        IN_FOLDER(test_json_open_refuses_more_keys_than_can_be_looked_for),
        IN_FOLDER(test_json_close_tells_want_of_memory_first),
        IN_FOLDER(test_faults_show_control_characters),
        IN_FOLDER(test_json_collect_files_finds_what_the_fields_name),
        IN_FOLDER(test_json_take_variant_merges_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
