// SPDX-License-Identifier: GPL-3.0-or-later
//
// Keys of earlier versions.
#include "io/json.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <string.h>

static struct json_document *open_text(struct temporary_folder *folder, const char *text) {
    struct json_document *document = NULL;
    const char *file = temporary_folder_write(folder, "run.json", text, strlen(text));
    assert_ok(mf_json_open(&document, file));
    return document;
}

/// What earlier versions wrote into their results can be read while it says what is so now.
static void test_json_retired_accepts_what_is_so_now(void **state) {
    struct json_document *document =
        open_text(*state, "{\"n\": 0.050, \"word\": \"no\", \"other\": 0, \"flag\": true}");
    struct json_object root = mf_json_root(document);
    mf_json_retired(&root, "n", "0.05", "leave it out");
    mf_json_retired(&root, "word", "no", "leave it out");
    mf_json_retired(&root, "away", "no", "leave it out");
    assert_int_equal(mf_json_fault_count(document), 0);
    mf_json_retired(&root, "other", "no", "leave it out");
    assert_int_equal(mf_json_fault_count(document), 1);
    mf_json_retired(&root, "flag", "1", "leave it out");
    mf_json_finish(&root);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "run.json: no longer keys: other, flag; leave them out");
    assert_null(strchr(mf_status_message(), '\n'));
}

static void test_json_retired_names_all_keys_of_a_document_in_a_line(void **state) {
    struct json_document *document =
        open_text(*state, "{\"a\": 1, \"in\": {\"b\": 2, \"new\": 1}, \"c\": 3, \"odd\": 4}");
    struct json_object root = mf_json_root(document);
    struct json_object in = mf_json_child(&root, "in", true);
    mf_json_retired(&root, "a", "2", "leave it out");
    mf_json_fault(&root, "odd", "is odd");
    mf_json_retired(&in, "b", "1", "leave it out");
    mf_json_retired(&root, "c", "2", "leave it out");
    mf_json_finish(&in);
    assert_int_equal(mf_json_fault_count(document), 3);
    assert_fails(mf_json_close(document, STATUS_OK), STATUS_BAD_INPUT,
                 "run.json: no longer keys: a, in.b, c; leave them out\n");
    assert_contains(mf_status_message(), "run.json: odd: is odd\n");
    assert_contains(mf_status_message(), "run.json: in.new: unknown key; no name is known here");
    assert_null(strstr(mf_status_message(), "no longer a key"));
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_json_retired_accepts_what_is_so_now),
        IN_FOLDER(test_json_retired_names_all_keys_of_a_document_in_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
