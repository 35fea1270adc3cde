// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is no JSON is refused in one line with its place, and what cJSON reads beyond JSON keeps its
// value.
#include "io/json.h"
#include "io/json_document.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <cJSON.h>

#include <stdlib.h>

static void assert_malformed(const char *text, const char *part) {
    cJSON *root;
    assert_fails(mf_json_parse("f.json", text, &root), STATUS_BAD_INPUT, part);
    assert_null(root);
    assert_null(strchr(mf_status_message(), '\n'));
}

static void assert_read(const char *text, const char *again) {
    cJSON *root;
    assert_ok(mf_json_parse("f.json", text, &root));
    char *printed = cJSON_PrintUnformatted(root);
    assert_string_equal(printed, again);
    cJSON_free(printed);
    cJSON_Delete(root);
}

static void test_json_parse_reads_what_is_json(void **state) {
    (void)state;
    assert_read("0", "0");
    assert_read("-0.5e-3", "-0.0005");
    assert_read("1E+5\n", "100000");
    assert_read(" [ ] ", "[]");
    assert_read("\"\\u00e9 \\\" \\\\ \\/ é\"", "\"é \\\" \\\\ / é\"");
    assert_read("{\"a\": [1, {\"b\": false}, []], \"c\": {\"d\": \"\"}}",
                "{\"a\":[1,{\"b\":false},[]],\"c\":{\"d\":\"\"}}");
    assert_read("\"C:\\\\users\\\\u0000\"", "\"C:\\\\users\\\\u0000\"");
    // Beyond RFC 8259:
    assert_read("[01, 1., -.5, \"a\nb\"]", "[1,1,-0.5,\"a\\nb\"]");
}

static void test_json_parse_gives_the_place_when_the_text_is_malformed(void **state) {
    (void)state;
    assert_malformed("{\n  \"a\": 1\n  \"b\": 2\n}",
                     "f.json:3:3: expected ',', ':' or a closing bracket (is one, or a '\"', "
                     "missing?), found '\"'");
    assert_malformed("{\"a\": 1,}",
                     "f.json:1:9: expected something after the last comma, found '}'");
    assert_malformed("{\"a\": [1, ]}", ":1:11: expected something after the last comma, found ']'");
    assert_malformed("{\"a\": 1,\n",
                     ":2:1: expected something after the last comma, found the end");
    assert_malformed("{\"a\" 1}", ":1:6: expected ',', ':' or a closing bracket");
    assert_malformed("{\"a\": 298,5}", ":1:12: expected a key after the comma (a decimal comma?");
    assert_malformed("{\"a\": [298,5}", " or a closing bracket");
    assert_malformed("{\"a\": NaN}", ":1:7: expected a value, found 'N'");
    assert_malformed("{\"ä\": nul}", ":1:7: expected a value, found 'n'");
    assert_malformed("[1, 2 3]", ":1:7: expected ',', ':' or a closing bracket");
    assert_malformed("{\"a\": 1",
                     "closing bracket (is one, or a '\"', missing?), found the end of");
    assert_malformed("[1}", ":1:3: expected ',', ':' or a closing bracket");
    assert_malformed("{", ":1:2: expected a key in double quotes, found the end of the file");
    assert_malformed("{a: 1}", ":1:2: expected a key in double quotes, found 'a'");
    assert_malformed("{\"x\": 1, 'a': 1}", ":1:10: expected a key in double quotes, found '''");
    assert_malformed("{\"a\": 'x'}", ":1:7: expected a value, found '''");
    assert_malformed(" \n", ":2:1: expected a value, found the end of the file");
    assert_malformed("{\"a\": 1} {}", ":1:10: expected nothing after the document, found '{'");
    assert_malformed("{\"a\": 1}x", ":1:9: expected nothing after the document");
    assert_malformed("0.5 1.2\n0.6 1.1\n", ": a table, not JSON: it is named in a JSON file");
    assert_malformed("# r g\n0.5 1.2\n", ": a table, not JSON: it is named in a JSON file");
    assert_malformed("@ title\n0.5 1.2\n", "{\"target\": {\"rdf\": {\"file\": ");
    assert_malformed("{\"a\": 1e}", ":1:8: expected ',', ':' or a closing bracket");
    assert_malformed("{\"a\": 0x10}", ":1:8: expected ',', ':' or a closing bracket");
}

static void test_json_parse_says_that_there_are_no_comments(void **state) {
    (void)state;
    assert_malformed("// c\n{}", ":1:1: expected a value, found '/' (JSON has no comments)");
    assert_malformed("{\"a\": 1, // c\n\"b\": 2}",
                     ":1:10: expected a key in double quotes, found '/' (JSON");
    assert_malformed("{\"a\": 1 # c\n, \"b\": 2}", ":1:9: expected ',', ':' or a closing bracket");
    assert_malformed("{\"a\": 1 # c\n, \"b\": 2}", "found '#' (JSON has no comments)");
    assert_malformed("{} # c", ":1:4: expected nothing after the document, found '#' (JSON");
}

static void test_json_parse_finds_quotes_that_are_missing(void **state) {
    (void)state;
    assert_malformed("{\"a\": \"x}",
                     ":1:7: expected a text with a '\"' at its end, too, found '\"'");
    assert_malformed("\"", ":1:1: expected a text with a '\"' at its end");
    assert_malformed("{\"a: 1,\n\"b\": 2}", ":2:2: expected ',', ':' or a closing bracket");
    assert_malformed("{\"a\": \"x,\n\"b\": 2}", "is one, or a '\"', missing?), found 'b'");
}

/// cJSON ends a text at what is, or what it takes for, a NUL.
static void test_json_parse_refuses_escapes_that_would_cut_a_text(void **state) {
    (void)state;
    assert_malformed("{\"a\\u0000b\": 1}",
                     ":1:4: expected \\u and four hexadecimal digits, not all 0, found '\\'");
    assert_malformed("{\"a\": \"\\u12\"}", ":1:8: expected \\u and four hexadecimal digits");
    assert_malformed("{\"a\": \"\\\\\\uzz\"}", ":1:10: expected \\u and four hexadecimal digits");
    assert_malformed("{\"a\": \"\\x\"}", ":1:8: expected an escape such as");
    assert_malformed("{\"a\": \"b,c\\ud800\"}", ":1:11: expected an escape such as");
    assert_malformed("{\"a\": \"\\", ":1:7: expected a text with a '\"' at its end");
}

static enum status open_nested(void **state, size_t opened, size_t closed) {
    struct json_document *document;
    char *text = malloc(opened + 1 + closed);
    assert_non_null(text);
    memset(text, '[', opened);
    text[opened] = '1';
    memset(text + opened + 1, ']', closed);
    const enum status status = mf_json_open(
        &document, temporary_folder_write(*state, "f.json", text, opened + 1 + closed));
    free(text);
    return mf_json_close(document, status);
}

/// Readers recurse.
static void test_deep_nesting_is_refused(void **state) {
    assert_ok(open_nested(state, 64, 64));
    assert_fails(open_nested(state, 65, 65), STATUS_BAD_INPUT, "f.json: more than 64 nested");
    assert_fails(open_nested(state, 900, 900), STATUS_BAD_INPUT, "f.json: more than 64 nested");
    assert_fails(open_nested(state, 100000, 0), STATUS_BAD_INPUT, "f.json:1:");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json_parse_reads_what_is_json),
        cmocka_unit_test(test_json_parse_gives_the_place_when_the_text_is_malformed),
        cmocka_unit_test(test_json_parse_says_that_there_are_no_comments),
        cmocka_unit_test(test_json_parse_finds_quotes_that_are_missing),
        cmocka_unit_test(test_json_parse_refuses_escapes_that_would_cut_a_text),
        cmocka_unit_test_setup_teardown(test_deep_nesting_is_refused, temporary_folder_create,
                                        temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
