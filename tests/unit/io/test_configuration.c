// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/configuration.h"

#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <string.h>
#include <unistd.h>

static const int abba[] = {0, 1, 1, 0}, bc[] = {1, 2};
static const double places[14] = {0};
static const struct data_column column = {"x[lambda]", places, NULL};
static const struct units reduced = {.system = UNITS_REDUCED};

/// Two A-B-B-A, one B-C, and single beads A and C: A is rows 1 to 6, B 7 to 11, C 12 to 14.
static void test_bonds_are_rows_of_the_beads_by_type(void **state) {
    static const double expected[7][2] = {{1, 7},  {7, 8},  {8, 2},  {3, 9},
                                          {9, 10}, {10, 4}, {11, 12}};
    struct temporary_folder *folder = *state;
    char file[512], bonds[512];
    struct topology topology;
    struct data_table table;
    const struct composition composition = molecules_topology(
        &topology, molecules_chain(2, abba, 4, BONDED_DIHEDRAL, 3),
        molecules_chain(1, bc, 2, BONDED_BOND, 1), 3, (const int64_t[]){2, 0, 2});
    snprintf(file, sizeof file, "%s", temporary_folder_write(folder, "places", "", 0));
    snprintf(bonds, sizeof bonds, "%s", temporary_folder_write(folder, "bonds", "", 0));
    assert_ok(
        mf_configuration_write(file, bonds, &reduced, &composition, &topology, &column, 1, 14));
    assert_ok(mf_data_table_read(&table, file, 1));
    assert_int_equal(table.rows, 14);
    assert_non_null(strstr(table.comments, "types: A 6 B 5 C 3\n"));
    assert_int_equal(mf_data_table_find(&table, "x"), 1);
    mf_data_table_clear(&table);
    assert_ok(mf_data_table_read(&table, bonds, 2));
    assert_int_equal(table.rows, 7);
    for (size_t k = 0; k < 14; k++)
        assert_identical(table.values[k], expected[k / 2][k % 2]);
    mf_data_table_clear(&table);
    mf_topology_clear(&topology);
}

/// Beads of one type without bonds leave a table of places and nothing else.
static void test_single_beads_leave_no_table_of_bonds(void **state) {
    struct temporary_folder *folder = *state;
    const struct composition alike = mf_composition_of_one(14);
    char file[512], bonds[600];
    struct data_table table;
    snprintf(file, sizeof file, "%s", temporary_folder_write(folder, "places", "", 0));
    snprintf(bonds, sizeof bonds, "%s_bonds", file);
    assert_ok(mf_configuration_write(file, bonds, &reduced, &alike, NULL, &column, 1, 14));
    assert_int_not_equal(access(bonds, F_OK), 0);
    assert_ok(mf_data_table_read(&table, file, 1));
    assert_null(strstr(table.comments, "types"));
    mf_data_table_clear(&table);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_bonds_are_rows_of_the_beads_by_type),
        TEST(test_single_beads_leave_no_table_of_bonds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
