// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_guard.h"
#include "shared/testing.h"

static void test_tokens_are_hexadecimal_and_differ(void **state) {
    char first[LIVE_TOKEN_SIZE], second[LIVE_TOKEN_SIZE];
    (void)state;
    assert_ok(mf_live_guard_make_token(first));
    assert_ok(mf_live_guard_make_token(second));
    assert_int_equal(strspn(first, "0123456789abcdef"), 32);
    assert_int_equal(strlen(first), 32);
    assert_string_not_equal(first, second);
}

static void test_token_is_itself_alone(void **state) {
    static const char token[LIVE_TOKEN_SIZE] = "0123456789abcdef0123456789abcdef";
    static const char *const others[] = {"",
                                         "0123456789abcdef0123456789abcde",
                                         "0123456789abcdef0123456789abcdee",
                                         "1123456789abcdef0123456789abcdef",
                                         "0123456789abcdef0123456789abcdeff",
                                         "00000000000000000000000000000000",
                                         "0123456789ABCDEF0123456789ABCDEF"};
    (void)state;
    assert_true(mf_live_guard_is_token(token, "0123456789abcdef0123456789abcdef"));
    assert_false(mf_live_guard_is_token(token, NULL));
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        assert_false(mf_live_guard_is_token(token, others[k]));
    // What has another length is compared with zeros, which no length makes right.
    assert_false(mf_live_guard_is_token("00000000000000000000000000000000", "0"));
}

static void test_hosts_are_names_of_the_loopback(void **state) {
    static const char *const good[] = {"127.0.0.1", "localhost", "127.0.0.1:1", "localhost:65535"};
    static const char *const bad[] = {"",
                                      "evil.example",
                                      "evil.example:8080",
                                      "127.0.0.1.evil.example",
                                      "127.0.0.11",
                                      "localhost.evil.example",
                                      "localhost:",
                                      "localhost:80@evil.example",
                                      "localhost:123456",
                                      "127.0.0.1:80 ",
                                      "0.0.0.0:80",
                                      "[::1]:80",
                                      "2130706433"};
    (void)state;
    assert_false(mf_live_guard_is_host(NULL));
    for (size_t k = 0; k < sizeof good / sizeof *good; k++)
        assert_true(mf_live_guard_is_host(good[k]));
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_false(mf_live_guard_is_host(bad[k]));
}

static void test_origin_is_the_page_itself(void **state) {
    static const char *const bad[] = {"",
                                      "null",
                                      "http://evil.example",
                                      "https://localhost:80",
                                      "http://localhost:81",
                                      "http://127.0.0.1:80",
                                      "http://localhost:80.evil.example",
                                      "http://localhost:80/",
                                      "localhost:80"};
    (void)state;
    assert_true(mf_live_guard_is_origin(NULL, "localhost:80"));
    assert_true(mf_live_guard_is_origin("http://localhost:80", "localhost:80"));
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_false(mf_live_guard_is_origin(bad[k], "localhost:80"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tokens_are_hexadecimal_and_differ),
        cmocka_unit_test(test_token_is_itself_alone),
        cmocka_unit_test(test_hosts_are_names_of_the_loopback),
        cmocka_unit_test(test_origin_is_the_page_itself),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
