// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/is_close.h"
#include "shared/testing.h"
#include "system/composition.h"

static const struct composition three = {
    .types = 3, .count = {4, 1, 3}, .name = {"A", "water", "B_2"}};

static void test_composition_type_follows_from_the_id(void **state) {
    (void)state;
    static const int types[] = {0, 0, 0, 0, 1, 2, 2, 2};
    for (uint32_t id = 0; id < 8; id++)
        assert_int_equal(mf_composition_type(&three, id), types[id]);
}

static void test_composition_pairs_come_in_order_whatever_the_number_of_types(void **state) {
    (void)state;
    for (int types = 2; types <= COMPOSITION_MAX_TYPES; types++) {
        const struct composition composition = {.types = types};
        int next = 0;
        for (int a = 0; a < types; a++)
            for (int b = a; b < types; b++, next++) {
                int type[2];
                assert_int_equal(mf_composition_pair(&composition, a, b), next);
                assert_int_equal(mf_composition_pair(&composition, b, a), next);
                mf_composition_pair_types(&composition, next, type);
                assert_int_equal(type[0], a);
                assert_int_equal(type[1], b);
            }
        assert_int_equal(mf_composition_pairs(&composition), next);
    }
}

static void test_composition_counts_pairs_by_type(void **state) {
    (void)state;
    static const double possible[] = {6, 4, 12, 0, 3, 3};
    double all = 0;
    for (int pair = 0; pair < 6; pair++) {
        assert_true(mf_composition_possible_pairs(&three, pair) == possible[pair]);
        all += possible[pair];
    }
    assert_true(all == 8 * 7 / 2);
    assert_int_equal(mf_composition_pair_of_ids(&three, 6, 2), 2);
    assert_int_equal(mf_composition_pair_of_ids(&three, 5, 7), 5);
}

static void test_composition_finds_pairs_by_name_in_either_order(void **state) {
    (void)state;
    char name[COMPOSITION_PAIR_NAME_SIZE];
    mf_composition_pair_name(&three, 4, name);
    assert_string_equal(name, "water-B_2");
    assert_int_equal(mf_composition_find_pair(&three, name), 4);
    assert_int_equal(mf_composition_find_pair(&three, "B_2-water"), 4);
    assert_int_equal(mf_composition_find_pair(&three, "A-A"), 0);
    assert_int_equal(mf_composition_find_pair(&three, "A"), -1);
    assert_int_equal(mf_composition_find_pair(&three, "A-C"), -1);
    assert_int_equal(mf_composition_find_pair(&three, "a-A"), -1);
}

static void test_composition_has_one_pair_type_when_it_is_one_component(void **state) {
    (void)state;
    const struct composition none = {0}, one = mf_composition_of_one(7);
    char name[COMPOSITION_PAIR_NAME_SIZE];
    assert_false(composition_is_mixed(&none));
    assert_false(composition_is_mixed(&one));
    assert_int_equal(mf_composition_pairs(&none), 1);
    assert_int_equal(mf_composition_pair_of_ids(&one, 3, 6), 0);
    assert_true(mf_composition_possible_pairs(&one, 0) == 21);
    mf_composition_pair_name(&one, 0, name);
    assert_string_equal(name, "");
}

static void test_composition_is_name_refuses_what_no_file_could_be_called(void **state) {
    (void)state;
    assert_true(mf_composition_is_name("A"));
    assert_true(mf_composition_is_name("Bead_number_015"));
    assert_false(mf_composition_is_name(""));
    assert_false(mf_composition_is_name("A-B"));
    assert_false(mf_composition_is_name("a/b"));
    assert_false(mf_composition_is_name("ü"));
    assert_false(mf_composition_is_name("Bead_number_0016"));
}

static void test_composition_scaled_keeps_the_shares(void **state) {
    (void)state;
    struct composition several = three;
    for (int type = 0; type < 3; type++)
        several.count[type] *= 2;
    const struct composition large = mf_composition_scaled(&several, 800);
    assert_int_equal(large.types, 3);
    assert_int_equal(large.count[0], 400);
    assert_int_equal(large.count[1], 100);
    assert_int_equal(large.count[2], 300);
    assert_int_equal(mf_composition_particles(&large), 800);
    assert_string_equal(large.name[1], "water");
    const struct composition back = mf_composition_scaled(&large, 8);
    assert_int_equal(mf_composition_particles(&back), 9); // 4, 2, 3
    assert_int_equal(
        mf_composition_scaled(&(struct composition){.types = 1, .count = {7}}, 21).count[0], 21);
}

/// A type whose like pairs were there keeps some: without them there is no g of them.
static void test_composition_scaled_leaves_each_type_a_pair(void **state) {
    (void)state;
    const struct composition rare = {.types = 2, .count = {10, 990}};
    const struct composition single = {.types = 2, .count = {1, 999}};
    const struct composition small = mf_composition_scaled(&rare, 50);
    assert_int_equal(small.count[0], 2);
    assert_int_equal(small.count[1], 50);
    assert_int_equal(mf_composition_scaled(&single, 50).count[0], 1);
    // Two of it would have a pair, of whose potential nothing is known.
    const struct composition larger = mf_composition_scaled(&single, 4000);
    assert_int_equal(larger.count[0], 1);
    assert_false(mf_composition_has_pairs(&single, 0));
    assert_true(mf_composition_has_pairs(&single, 1) && mf_composition_has_pairs(&rare, 0));
}

static void test_composition_particles_are_those_of_all_types(void **state) {
    (void)state;
    const struct composition none = {0}, one = mf_composition_of_one(7);
    assert_int_equal(mf_composition_particles(&three), 8);
    assert_int_equal(mf_composition_particles(&one), 7);
    assert_int_equal(mf_composition_particles(&none), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_composition_type_follows_from_the_id),
        cmocka_unit_test(test_composition_pairs_come_in_order_whatever_the_number_of_types),
        cmocka_unit_test(test_composition_counts_pairs_by_type),
        cmocka_unit_test(test_composition_finds_pairs_by_name_in_either_order),
        cmocka_unit_test(test_composition_scaled_keeps_the_shares),
        cmocka_unit_test(test_composition_scaled_leaves_each_type_a_pair),
        cmocka_unit_test(test_composition_particles_are_those_of_all_types),
        cmocka_unit_test(test_composition_has_one_pair_type_when_it_is_one_component),
        cmocka_unit_test(test_composition_is_name_refuses_what_no_file_could_be_called),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
