// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <string.h>

static const struct units argon = {
    .length = 0.34, .temperature = 120, .mass = 39.948 * UNITS_ATOMIC_MASS, .system = UNITS_NM_PS};

static enum status convert(void **state, const char *text, const struct units *units,
                           double value[2]) {
    const char *file = temporary_folder_write(*state, "t.tsv", text, strlen(text));
    struct data_table table;
    assert_ok(mf_data_table_read(&table, file, 2));
    enum status status = mf_data_table_convert(&table, "t.tsv", 0, "lambda", units);
    if (status == STATUS_OK)
        status = mf_data_table_convert(&table, "t.tsv", 1, "k_B T_0", units);
    memcpy(value, table.values, 2 * sizeof *value);
    mf_data_table_clear(&table);
    return status;
}

/// 0.34 nm are 1 lambda, and 120 K · 0.0083144626 kJ/mol/K are 1 k_B T_0.
static void test_data_table_convert_reads_the_units_of_headings(void **state) {
    static const char *const same[] = {
        "# r[nm]\tphi[kJ/mol]\n0.34 0.997735512\n",
        "# r [nm]  phi [kJ/mol]\n0.34 0.997735512\n",
        "r[A];phi[kcal/mol]\n3.4;0.23846451\n",
        "# made by hand\n0.34 0.997735512\n",
        "# r phi[J/mol]\n0.34 997.735512\n",
        "# columns: r[A] phi[kcal/mol] pairs[of all frames]\n3.4 0.23846451 7\n",
        "# r (nm)  phi (kJ/mol)\n0.34 0.997735512\n",
        "r (\xc3\x85),phi of r (kcal/mol)\n3.4,0.23846451\n",
        "\"r (A)\";\"U(A-A), mean [kcal/mol]\"\n3,4;0,23846451\n",
        "of my figure\nr\tphi\nA\tkcal/mol\n3,4\t0,23846451\n",
        "# r phi\n# (A) (kcal/mol)\n3.4 0.23846451\n",
        "r;phi\n[nm];\n0.34;0.997735512\n",
        "# r (pm)  phi (J/mol)\n340 997.735512\n",
        "Distance / Angstrom,phi/kcal/mol\n3.4,0.23846451\n",
        "# Distance / Angstrom phi / kcal/mol\n3.4 0.23846451\n",
        "# r/nm U/eV\n0.34 0.01034079989\n",
        "\"r / pm\"\t\"phi / kJ mol^-1\"\n340\t0.997735512\n"};
    double value[2];
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        assert_ok(convert(state, same[k], &argon, value));
        assert_close_relative(value[0], 1, 1e-12);
        assert_close_relative(value[1], 1, 1e-7);
    }
    // As `gmx rdf` writes it; the y axis, "g(r)", tells no unit.
    assert_ok(
        convert(state,
                "# gmx rdf\n@    title \"Radial distribution\"\n@    xaxis  label \"r (nm)\"\n"
                "@    yaxis  label \"g(r)\"\n@TYPE xy\n@ s0 legend \"OW\"\n0.34 0.997735512\n",
                &argon, value));
    assert_close_relative(value[0], 1, 1e-12);
    assert_close_relative(value[1], 1, 1e-7);
    struct units real = argon;
    real.system = UNITS_ANGSTROM_FS;
    assert_ok(convert(state, "@ xaxis label \"r (nm)\"\n0.34 0.23846451\n", &real, value));
    assert_close_relative(value[0], 1, 1e-12);
    assert_ok(convert(state, "3.4 0.23846451\n", &real, value));
    assert_close_relative(value[0], 1, 1e-12);
    assert_close_relative(value[1], 1, 1e-7);
    assert_ok(convert(state, "# r[lambda]\tphi[k_B.T_0]\n1 1\n", &argon, value));
    assert_close_relative(value[0], 1, 1e-15);
    assert_close_relative(value[1], 1, 1e-15);
}

static void test_data_table_convert_leaves_reduced_files_alone(void **state) {
    struct units reduced = argon;
    const struct units none = {0};
    double value[2];
    reduced.system = UNITS_REDUCED;
    assert_ok(convert(state, "# r[nm]\tphi[kJ/mol]\n0.34 0.5\n", &none, value));
    assert_close(value[0], 0.34, 0);
    assert_close(value[1], 0.5, 0);
    assert_ok(convert(state, "# r[lambda]\tphi[1]\n0.34 0.5\n", &reduced, value));
    assert_close(value[0], 0.34, 0);
    // The scale tells that 1 nm is not 1.
    assert_int_equal(convert(state, "# r[nm]\tphi[1]\n0.34 0.5\n", &reduced, value),
                     STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "column 1 is in nm");
    assert_int_equal(convert(state, "@ xaxis label \"r (nm)\"\n0.34 0.5\n", &reduced, value),
                     STATUS_BAD_INPUT);
    reduced.length = 1;
    assert_ok(convert(state, "# r[nm]\tphi[1]\n0.34 0.5\n", &reduced, value));
    assert_close(value[0], 0.34, 0);
}

static void test_data_table_convert_refuses_units_of_something_else(void **state) {
    double value[2];
    struct units chosen = argon;
    assert_fails(convert(state, "# r[ps] phi\n1 1\n", &argon, value), STATUS_BAD_INPUT,
                 "t.tsv: column 1: \"ps\" is not a unit of the same kind as nm");
    assert_fails(convert(state, "# r[nm] phi[parsec]\n1 1\n", &argon, value), STATUS_BAD_INPUT,
                 "t.tsv: column 2: unknown unit \"parsec\"");
    chosen.chosen = true;
    assert_fails(convert(state, "# r[lambda] phi\n1 1\n", &chosen, value), STATUS_BAD_INPUT,
                 "needs the lambda that it was written with");
}

static void test_data_table_write_in_converts_columns_and_names(void **state) {
    const char *file = temporary_folder_file(*state, "t.tsv");
    const double r[] = {1, 2}, g[] = {0.5, 0.25};
    const struct data_column columns[] = {
        {"r[lambda]", r, "%.3f"}, {"g[1]", g, NULL}, {"n", r, NULL}};
    struct data_table table;
    assert_ok(mf_data_table_write_in(file, &argon, "a comment", columns, 3, 2));
    assert_ok(mf_data_table_read(&table, file, 3));
    assert_string_equal(table.header, "r[nm]\tg[1]\tn");
    const double expected[] = {0.34, 0.5, 1, 0.68, 0.25, 2};
    for (size_t k = 0; k < 6; k++)
        assert_close_relative(table.values[k], expected[k], 1e-12);
    mf_data_table_clear(&table);
}

static void test_data_table_write_beside_repeats_columns_of_reduced_files(void **state) {
    const char *file = temporary_folder_file(*state, "t.tsv");
    const double r[] = {1, 2}, u[] = {0.5, 0.25};
    const struct data_column columns[] = {
        {"r[lambda]", r, "%.17g"}, {"u[k_B.T_0]", u, NULL}, {"n[1]", r, NULL}};
    const char *const beside[] = {"%.10g", "%.10g", NULL};
    struct units units = argon;
    struct data_table table;
    units.system = UNITS_REDUCED;
    assert_ok(mf_data_table_write_beside(file, &units, "of both", columns, beside, 3, 2));
    assert_ok(mf_data_table_read(&table, file, 5));
    assert_string_equal(table.header, "r[lambda]\tu[k_B.T_0]\tn[1]\tr[nm]\tu[kJ/mol]");
    assert_contains(table.comments, "# of both\n");
    // 120 K · 0.0083144626 kJ/mol/K
    const double expected[] = {1, 0.5, 1, 0.34, 0.498867756, 2, 0.25, 2, 0.68, 0.249433878};
    for (size_t k = 0; k < 10; k++)
        assert_close_relative(table.values[k], expected[k], 1e-8);
    mf_data_table_clear(&table);
    // What speaks nm and ps, or has no scale, repeats nothing.
    assert_ok(mf_data_table_write_beside(file, &argon, NULL, columns, beside, 3, 2));
    assert_ok(mf_data_table_read(&table, file, 3));
    assert_string_equal(table.header, "r[nm]\tu[kJ/mol]\tn[1]");
    mf_data_table_clear(&table);
    assert_ok(
        mf_data_table_write_beside(file, &(const struct units){0}, NULL, columns, beside, 3, 2));
    assert_ok(mf_data_table_read(&table, file, 3));
    assert_string_equal(table.header, "r[lambda]\tu[k_B.T_0]\tn[1]");
    mf_data_table_clear(&table);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_data_table_convert_reads_the_units_of_headings),
        TEST(test_data_table_convert_leaves_reduced_files_alone),
        TEST(test_data_table_convert_refuses_units_of_something_else),
        TEST(test_data_table_write_in_converts_columns_and_names),
        TEST(test_data_table_write_beside_repeats_columns_of_reduced_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
