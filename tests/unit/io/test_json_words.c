// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is said beside a file, which fields a file gives, and tables in memory.
#include "io/data_table.h"
#include "io/json.h"
#include "io/text_file.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

static const struct field fields[] = {
    {"first", FIELD_NUMBER, 0, .initial = 1, .minimum = 0, .maximum = 9},
    {"second", FIELD_NUMBER, sizeof(double), .initial = 2, .minimum = 0, .maximum = 9},
    {"third", FIELD_NUMBER, 2 * sizeof(double), .initial = NAN, .minimum = 0, .maximum = 9},
    FIELD_END,
};

static struct json_document *open_text(const char *text) {
    struct json_document *document = NULL;
    assert_ok(mf_json_open_text(&document, "run.json", text));
    return document;
}

static void test_json_fields_say_which_are_given(void **state) {
    double values[3];
    (void)state;
    struct json_document *document = open_text("{\"second\": 2, \"third\": null}");
    struct json_object root = mf_json_root(document), none = mf_json_child(&root, "none", false);
    assert_int_equal(mf_json_fields(&root, fields, values),
                     mf_fields_bit(fields, "second") | mf_fields_bit(fields, "third"));
    assert_int_equal(mf_json_fields(&none, fields, values), 0);
    assert_ok(mf_json_close(document, STATUS_OK));
}

static void test_json_add_makes_objects_of_words(void **state) {
    static const double edges[] = {5, 1.0 / 3};
    const struct json_word words[] = {
        {.key = "first", .value = 1.0 / 3},
        {.object = "scene.particles", .key = "kind", .text = "A"},
        {.object = "scene", .key = "law", .json = "{\"first\": 7}"},
        {.object = "scene", .key = "box", .count = 2, .values = edges}};
    double values[3];
    (void)state;
    struct json_document *document = open_text("{\"scene\": {}}");
    assert_ok(mf_json_add(document, words, sizeof words / sizeof *words));
    struct json_object root = mf_json_root(document), scene = mf_json_child(&root, "scene", true),
                       law = mf_json_child(&scene, "law", true),
                       particles = mf_json_child(&scene, "particles", true);
    mf_json_fields(&law, fields, values);
    assert_identical(values[0], 7);
    assert_int_equal(mf_json_numbers(&root, "first", values, 1), 1);
    assert_identical(values[0], 1.0 / 3);
    assert_int_equal(mf_json_numbers(&scene, "box", values, 3), 2);
    assert_identical(values[1], 1.0 / 3);
    assert_string_equal(mf_json_choice(&particles, "kind", NULL, ""), "A");
    assert_ok(mf_json_close(document, STATUS_OK));
}

static void test_json_add_refuses_what_the_file_says_and_what_is_no_json(void **state) {
    struct json_document *document = open_text("{\"scene\": {\"density\": 1}}");
    (void)state;
    assert_fails(mf_json_add(document,
                             &(struct json_word){.object = "scene", .key = "density", .value = 2},
                             1),
                 STATUS_BAD_INPUT, "--density: run.json has scene.density");
    assert_fails(mf_json_add(document, &(struct json_word){.key = "law", .json = "{\"a\" 1}"}, 1),
                 STATUS_BAD_INPUT, "law:1:6: ");
    assert_ok(
        mf_json_add(document, &(struct json_word){.key = "b", .json = "{\"a\": 1, \"a\": 2}"}, 1));
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT, "b.a: duplicate key");
}

static void test_tables_in_memory_are_read_as_numbers(void **state) {
    static const double values[] = {0.1, 1.0 / 3, 0.2, NAN};
    const struct memory_file files[] = {{.name = "rdf", .rows = 2, .columns = 2, .values = values}};
    struct data_table table;
    (void)state;
    mf_text_file_set_memory_files(files, 1);
    assert_ok(mf_data_table_read(&table, "rdf", 1));
    assert_int_equal(table.rows, 2);
    assert_int_equal(table.columns, 2);
    assert_identical(table.values[1], 1.0 / 3);
    assert_int_equal(table.line[1], 2);
    mf_data_table_clear(&table);
    assert_fails(mf_data_table_read(&table, "rdf", 2), STATUS_BAD_INPUT, "rdf:2: column 2: ");
    assert_fails(mf_data_table_read(&table, "rdf", 3), STATUS_BAD_INPUT, "rdf: 2 columns");
    mf_text_file_set_memory_files(NULL, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json_fields_say_which_are_given),
        cmocka_unit_test(test_json_add_makes_objects_of_words),
        cmocka_unit_test(test_json_add_refuses_what_the_file_says_and_what_is_no_json),
        cmocka_unit_test(test_tables_in_memory_are_read_as_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
