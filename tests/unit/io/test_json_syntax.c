// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_syntax.h"
#include "shared/testing.h"

#include <stdlib.h>

static void assert_malformed(const char *text, const char *part) {
    assert_fails(mf_json_syntax_check("f.json", text), STATUS_BAD_INPUT, part);
}

static void test_json_syntax_check_accepts_when_the_text_is_json(void **state) {
    (void)state;
    static const char *const texts[] = {
        "0",
        "-0.5e-3",
        "1E+5",
        "true",
        " [ ] ",
        "{}\n",
        "null",
        "\"\\u00e9 \\\" \\\\ \\/ é\"",
        "{\"a\": [1, {\"b\": false}, []], \"c\": {\"d\": \"\"}}",
        "\"\\\\u0000\"",
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        assert_ok(mf_json_syntax_check("f.json", texts[k]));

    char siblings[400] = "[[]";
    for (int k = 0; k < 100; k++)
        strcat(siblings, ",[]");
    assert_ok(mf_json_syntax_check("f.json", strcat(siblings, "]")));
}

static void test_json_syntax_check_gives_the_place_when_the_text_is_malformed(void **state) {
    (void)state;
    assert_malformed("{\n  \"a\": 1\n  \"b\": 2\n}", "f.json:3:3: expected ',' or '}', found '\"'");
    assert_malformed("{\"a\": 1,}",
                     "f.json:1:9: expected something behind the last comma, found '}'");
    assert_malformed("{\"a\": [1,]}", ":1:10: expected something behind the last comma, found ']'");
    assert_malformed("{\"a\" 1}", ":1:6: expected ':' after the key, found '1'");
    assert_malformed("{\"a\": NaN}", ":1:7: expected a value, found 'N'");
    assert_malformed("{\"ä\": nul}", ":1:7: expected a value, found 'n'");
    assert_malformed("{\"a\": 1", ":1:8: expected ',' or '}', found the end of the file");
    assert_malformed("{\"a\": \"x\n\"}", ":1:9: expected the closing '\"'");
    assert_malformed(" \n", ":2:1: expected a value, found the end of the file");
}

static void
test_json_syntax_check_refuses_what_cjson_lets_through_when_it_is_not_json(void **state) {
    (void)state;
    assert_malformed("{\"a\": 1} {}", ":1:10: expected nothing after the document, found '{'");
    assert_malformed("{\"a\": 1}x", ":1:9: expected nothing after the document");
    assert_malformed("{\"a\": 01}", ":1:8: expected ',' or '}', found '1'");
    assert_malformed("{\"a\": 1.}", ":1:9: expected a digit after the decimal point");
    assert_malformed("{\"a\": -.5}", ":1:8: expected a digit, found '.'");
    assert_malformed("{\"a\": 1e}", ":1:9: expected a digit in the exponent");
    assert_malformed("{\"a\": \"x\ty\"}", ":1:9: expected the closing '\"' of a text");
    assert_malformed("{\"a\\u0000b\": 1}", ":1:4: expected a text without the character");
    assert_malformed("{\"a\": \"\\x\"}", ":1:8: expected an escape of JSON");
    assert_malformed("{\"a\": \"\\u12\"}", ":1:8: expected an escape of JSON");
    assert_malformed("{\"a\": 0.0000000000000000000000000000000000000000000000000000000000000001}",
                     "expected a number of at most 60 characters");
}

static void
test_json_syntax_check_refuses_deep_nesting_when_it_could_overflow_the_stack(void **state) {
    (void)state;
    enum { DEPTH = 100000 };
    char *text = malloc(DEPTH + 1);
    assert_non_null(text);
    memset(text, '[', DEPTH);
    text[DEPTH] = '\0';
    assert_malformed(text, ":1:65: expected at most 64 nested objects and arrays");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json_syntax_check_accepts_when_the_text_is_json),
        cmocka_unit_test(test_json_syntax_check_gives_the_place_when_the_text_is_malformed),
        cmocka_unit_test(
            test_json_syntax_check_refuses_what_cjson_lets_through_when_it_is_not_json),
        cmocka_unit_test(
            test_json_syntax_check_refuses_deep_nesting_when_it_could_overflow_the_stack),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
