// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/digest.h"
#include "shared/testing.h"

/// Published digests of FNV-1a, 64 bits (draft-eastlake-fnv).
static const struct {
    const char *text;
    uint64_t digest;
} published[] = {
    {"", 0xcbf29ce484222325u},
    {"a", 0xaf63dc4c8601ec8cu},
    {"foobar", 0x85944171f73967e8u},
};

static void test_digest_is_the_published_one(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof published / sizeof *published; k++) {
        uint64_t digest = DIGEST_OF_NOTHING;
        mf_digest_add(&digest, published[k].text, strlen(published[k].text));
        assert_int_equal(digest, published[k].digest);
    }
}

static void test_digest_is_the_same_when_bytes_come_in_pieces(void **state) {
    (void)state;
    uint64_t whole = DIGEST_OF_NOTHING, pieces = DIGEST_OF_NOTHING;
    mf_digest_add(&whole, "foobar", 6);
    mf_digest_add(&pieces, "fo", 2);
    mf_digest_add(&pieces, NULL, 3);
    mf_digest_add(&pieces, "obar", 4);
    assert_int_equal(pieces, whole);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_digest_is_the_published_one),
        cmocka_unit_test(test_digest_is_the_same_when_bytes_come_in_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
