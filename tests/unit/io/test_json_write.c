// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json.h"
#include "io/json_write.h"
#include "shared/is_close.h"
#include "shared/sample_fields.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void assert_round_trip(void **state, const struct sample *sample) {
    const char *file = temporary_folder_file(*state, "run.json");
    struct json_writer *writer = mf_json_writer_create();
    assert_non_null(writer);
    mf_json_write_fields(writer, sample_fields, sample);
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);

    struct sample again;
    struct json_document *document;
    assert_ok(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, sample_fields, &again);
    mf_json_finish(&root);
    assert_ok(mf_json_close(document, STATUS_OK));
    assert_identical(again.strength, sample->strength);
    assert_int_equal(again.steps, sample->steps);
    assert_int_equal(again.seed, sample->seed);
    assert_memory_equal(again.lengths, sample->lengths, sizeof again.lengths);
    assert_string_equal(again.name, sample->name);
    assert_string_equal(again.file, sample->file);
    assert_int_equal(again.kind, sample->kind);
    assert_int_equal(again.kinds, sample->kinds);
}

static void test_json_write_fields_reads_back_the_same_bits_when_digits_are_many(void **state) {
    struct sample sample = {.strength = 1.0 / 3,
                            .steps = 9007199254740991,
                            .seed = 9007199254740991,
                            .lengths = {0.1 + 0.2, DBL_MIN, DBL_MAX},
                            .name = "tab\t, \"quote\", é",
                            .file = "/a/b",
                            .kind = 1,
                            .kinds = 3};
    assert_round_trip(state, &sample);
    sample = (struct sample){
        .strength = nextafter(0.1, 1), .steps = 1, .lengths = {1, 2, 0}, .kinds = 1};
    assert_round_trip(state, &sample);
    sample = (struct sample){.strength = 5e-324, .steps = 1, .kinds = 2};
    assert_round_trip(state, &sample);
    sample = (struct sample){.strength = -0.0, .steps = 1, .kinds = 2};
    assert_round_trip(state, &sample);
}

static void test_json_write_fields_makes_a_file_absolute_when_it_is_relative(void **state) {
    const struct sample sample = {.file = "a/b.dat"};
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_fields(writer, sample_fields, &sample);
    const char *file = temporary_folder_file(*state, "used.json");
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);
    char *text = temporary_folder_read(file);
    assert_contains(text, "\"file\":\t\"/");
    assert_contains(text, "/a/b.dat\"");
    assert_null(strstr(text, "\"name\""));
    assert_null(strstr(text, "\"lengths\""));
    free(text);
}

static void test_json_write_fields_writes_what_is_required_when_it_is_zero(void **state) {
    static const struct field required[] = {
        {"force", FIELD_LENGTHS, 0, .required = true, .minimum = -1, .maximum = 1}, FIELD_END};
    static const double force[3] = {0, 0, 0};
    double again[3] = {1, 1, 1};
    const char *file = temporary_folder_file(*state, "used.json");
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_fields(writer, required, force);
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);
    struct json_document *document;
    assert_ok(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, required, again);
    assert_ok(mf_json_close(document, STATUS_OK));
    assert_memory_equal(again, force, sizeof again);
}

static void test_json_write_prints_the_tree_when_objects_are_nested(void **state) {
    struct json_writer *writer = mf_json_writer_create();
    assert_non_null(writer);
    mf_json_write_text(writer, "name", "x");
    mf_json_begin(writer, "scene");
    mf_json_begin(writer, "box");
    mf_json_write_quantities(writer, "sides", "", (double[]){1, 0.1, 1e300}, 3);
    mf_json_end(writer);
    mf_json_write_integer(writer, "steps", INT64_MIN);
    mf_json_end(writer);
    mf_json_write_number(writer, "score", 0.1);
    mf_json_write_quantities(writer, "none", "", NULL, 0);
    const char *file = temporary_folder_file(*state, "out.json");
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);
    char *text = temporary_folder_read(file);
    assert_string_equal(text, "{\n\t\"name\":\t\"x\",\n\t\"scene\":\t{\n\t\t\"box\":\t{\n"
                              "\t\t\t\"sides\":\t[1, 0.1, 1e+300]\n\t\t},\n"
                              "\t\t\"steps\":\t-9223372036854775808\n\t},\n"
                              "\t\"score\":\t0.1,\n\t\"none\":\t[]\n}\n");
    free(text);
}

static void write_twice(struct json_writer *writer) {
    mf_json_write_integer(writer, "distance", 1);
    mf_json_write_integer(writer, "distance", 1);
}

static void write_too_deep(struct json_writer *writer) {
    for (int k = 0; k < 20; k++)
        mf_json_begin(writer, "distance");
}

static void write_nameless(struct json_writer *writer) {
    mf_json_begin(writer, NULL);
}

static void test_json_write_writes_nothing_when_the_tree_has_a_problem(void **state) {
    static const struct {
        void (*build)(struct json_writer *);
        const char *part;
    } cases[] = {{write_twice, "out.json: \"distance\" is given twice"},
                 {write_too_deep, "out.json: \"distance\" is nested too deeply"},
                 {write_nameless, "out.json: \"\" is an object without a key"}};
    const char *file = temporary_folder_file(*state, "out.json");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct json_writer *writer = mf_json_writer_create();
        assert_non_null(writer);
        cases[k].build(writer);
        assert_fails(mf_json_write(writer, file), STATUS_IO, cases[k].part);
        assert_false(temporary_folder_exists(file));
        mf_json_writer_free(writer);
    }
}

/// JSON has no word for them but null, and one of them must not cost the rest.
static void test_json_write_writes_null_when_a_number_is_not_finite(void **state) {
    const char *file = temporary_folder_file(*state, "out.json");
    struct json_writer *writer = mf_json_writer_create();
    assert_non_null(writer);
    mf_json_write_number(writer, "a", NAN);
    mf_json_write_number(writer, "b", -INFINITY);
    mf_json_write_quantities(writer, "c", "", (double[]){1, INFINITY, 0.5}, 3);
    mf_json_write_number(writer, "d", 2);
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);
    char *text = temporary_folder_read(file);
    assert_string_equal(text, "{\n\t\"a\":\tnull,\n\t\"b\":\tnull,\n\t\"c\":\t[1, null, 0.5],\n"
                              "\t\"d\":\t2\n}\n");
    free(text);
}

static void test_json_write_stream_prints_a_list_when_the_root_is_one(void **state) {
    char text[256];
    const char *file = temporary_folder_file(*state, "stream");
    FILE *stream = fopen(file, "w+");
    assert_non_null(stream);
    struct json_writer *writer = mf_json_writer_create_list();
    assert_non_null(writer);
    assert_ok(mf_json_write_stream(writer, stream, "stream"));
    for (int k = 0; k < 2; k++) {
        mf_json_begin(writer, NULL);
        mf_json_write_integer(writer, "number", k);
        mf_json_begin(writer, "inside");
        mf_json_end(writer);
        mf_json_end(writer);
    }
    assert_ok(mf_json_write_stream(writer, stream, "stream"));
    rewind(stream);
    const size_t length = fread(text, 1, sizeof text - 1, stream);
    text[length] = '\0';
    assert_string_equal(text, "[]\n[{\n\t\t\"number\":\t0,\n\t\t\"inside\":\t{\n\t\t}\n\t}, {\n"
                              "\t\t\"number\":\t1,\n\t\t\"inside\":\t{\n\t\t}\n\t}]\n");
    assert_int_equal(fclose(stream), 0);
    mf_json_writer_free(writer);
}

static void test_json_write_stream_fails_when_the_tree_or_the_stream_is_bad(void **state) {
    (void)state;
    struct json_writer *writer = mf_json_writer_create_list();
    assert_non_null(writer);
    FILE *full = fopen("/dev/full", "w");
    assert_non_null(full);
    assert_fails(mf_json_write_stream(writer, full, "stdout"), STATUS_IO,
                 "cannot write stdout: No space left");
    fclose(full);
    mf_json_begin(writer, NULL);
    write_twice(writer);
    mf_json_end(writer);
    assert_fails(mf_json_write_stream(writer, stdout, "stdout"), STATUS_IO,
                 "cannot write stdout: \"distance\" is given twice");
    mf_json_writer_free(writer);
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_json_write_fields_reads_back_the_same_bits_when_digits_are_many),
        IN_FOLDER(test_json_write_fields_makes_a_file_absolute_when_it_is_relative),
        IN_FOLDER(test_json_write_fields_writes_what_is_required_when_it_is_zero),
        IN_FOLDER(test_json_write_prints_the_tree_when_objects_are_nested),
        IN_FOLDER(test_json_write_writes_null_when_a_number_is_not_finite),
        IN_FOLDER(test_json_write_writes_nothing_when_the_tree_has_a_problem),
        IN_FOLDER(test_json_write_stream_prints_a_list_when_the_root_is_one),
        cmocka_unit_test(test_json_write_stream_fails_when_the_tree_or_the_stream_is_bad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
