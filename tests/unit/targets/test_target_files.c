// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_files.h"

#include "io/units_scale.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

static const char g[] = "# r g e\n0.05 0 0\n0.15 0.5 0.1\n0.25 1.5 0.2\n0.35 1 0.3\n";
static const char escape[] = "# t E E\n0 1 1\n0.1 0.9 0.5\n0.2 nan 0\n";
static const char vacf[] = "# t vacf e\n0 3 0.01\n0.1 1 0.02\n0.2 -0.1 0.03\n";
static const char msd[] = "# t msd e\n0 0 0\n0.1 0.02 0.001\n0.2 0.06 0.002\n";

static const char apart[] =
    "# r g e\n0.1 0.2 0.1\n0.3 1.2 0.2\n0.5 1.1 0.1\n0.7 1 0.1\n0.9 1 0.2\n";

#define RDF "\"rdf\": {\"file\": \"g.tsv\"}"
#define APART "\"intermolecular_rdf\": {\"file\": \"apart.tsv\"}"
#define ETD "\"etd\": {\"file\": \"e.tsv\", \"r_minimum\": 0.5, \"r_maximum\": 1}"
#define VACF "\"vacf\": {\"file\": \"v.tsv\"}"
#define MSD "\"msd\": {\"file\": \"m.tsv\"}"
#define NUMBERS                                                                                    \
    "\"diffusion\": {\"value\": 0.02, \"error\": 0.001, \"weight\": 7}, "                          \
    "\"pressure\": {\"value\": -3, \"fitted\": \"no\"}"

/// λ is half a nanometre, k_B T_0 2.5 kJ/mol.
static const struct box box = {3, {5, 5, 5}};
static const struct units units = {.length = 0.5, .temperature = 300.68, .mass = 1e-26};

static void put(void **state, const char *name, const char *text) {
    temporary_folder_write(*state, name, text, strlen(text));
}

/// Read the targets in `members`; the status is that of the document.
static enum status read(void **state, const char *members, struct target_files *targets) {
    char text[1024];
    struct json_document *document;
    const int length = snprintf(text, sizeof text, "{\"target\": {%s}}", members);
    assert_in_range(length, 1, sizeof text - 1);
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, (size_t)length)));
    struct json_object root = mf_json_root(document);
    assert_ok(mf_target_files_read(
        targets, &root,
        &(struct target_scene){&box, &(struct composition){.types = 1, .count = {100}}, NULL,
                               &units}));
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

static void write_tables(void **state) {
    put(state, "g.tsv", g);
    put(state, "apart.tsv", apart);
    put(state, "e.tsv", escape);
    put(state, "v.tsv", vacf);
    put(state, "m.tsv", msd);
}

/// Whatever an observable supplies as a target can be read, kept and fitted.
static void test_target_record_of_every_kind_is_whole(void **state) {
    (void)state;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const struct target_record *record = mf_target_record(kind);
        assert_non_null(record);
        assert_true(record->size > 0 && record->read && record->values && record->fields[0]);
        assert_true(record->form == mf_observable_kind(kind).target->form);
        assert_true((record->table == NULL) == (record->place == NULL));
    }
}

/// What a fit shows beside its result are all values of a target, each once.
static void test_target_files_table_holds_every_value_once(void **state) {
    struct target_files t;
    struct target_table table;
    struct targets fitted, compared;
    write_tables(state);
    assert_ok(read(state, RDF ", " APART ", " ETD ", " VACF ", " NUMBERS, &t));
    mf_target_files_targets(&t, false, &fitted, &compared);
    for (int kind = 0; mf_targets_name(kind); kind++) {
        size_t values = 0;
        for (size_t n = 0; mf_target_files_table(&t, kind, n, &table); n++) {
            double at[2];
            assert_int_equal(table.first, values);
            values += table.count;
            mf_target_record(kind)->place(&t, kind, &table, table.count - 1, at);
            assert_true(at[table.places - 1] > 0);
        }
        if (mf_target_record(kind)->table)
            assert_int_equal(values, compared.target[kind].count);
    }
    assert_false(mf_target_files_table(&t, TARGET_PRESSURE, 0, &table));
    assert_false(mf_target_files_table(&t, TARGET_MSD, 0, &table)); // not given
    mf_target_files_clear(&t);
}

/// The file has other bins than that of all pairs: what measures it is told.
static void test_targets_read_gives_the_structure_between_molecules_its_own_bins(void **state) {
    static const double wanted[] = {0.2, 1.2, 1.1, 1, 1}, errors[] = {0.1, 0.2, 0.1, 0.1, 0.2};
    const int kind = mf_rdf_intermolecular_kind();
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    assert_ok(read(state, RDF ", " APART, &t));
    mf_target_files_targets(&t, false, &fitted, &compared);
    const struct rdf_settings *settings = compared.settings[mf_observable_kind(kind).place];
    assert_int_equal(compared.bins.count, 4);
    assert_int_equal(settings->target.count, 5);
    assert_close(settings->target.width, 0.2, 1e-12);
    assert_int_equal(compared.target[kind].count, 5);
    assert_int_equal(fitted.target[kind].count, 5);
    for (int k = 0; k < 5; k++) {
        assert_close(fitted.target[kind].value[k], wanted[k], 1e-12);
        assert_close(fitted.target[kind].error[k], errors[k], 1e-12);
    }
    assert_close(fitted.target[TARGET_RDF].value[2], 1.5, 1e-12);
    mf_target_files_clear(&t);
}

/// A λ of half a nanometre: 1 nm³ is 8 λ³.
static void test_targets_read_converts_integrals_of_kirkwood_and_buff(void **state) {
    static const struct units physical = {
        .system = UNITS_NM_PS, .length = 0.5, .temperature = 300, .mass = 1e-26, .dimensions = 3};
    static const char text[] =
        "{\"target\": {\"kirkwood_buff\": {\"A-B\": {\"value\": -0.25, \"error\": 0.125}, "
        "\"fitted\": \"no\"}}}";
    const struct composition binary = {.types = 2, .count = {50, 50}, .name = {"A", "B"}};
    const int kind = mf_kirkwood_buff_kind();
    struct json_document *document;
    struct target_files t;
    struct targets fitted, compared;
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, strlen(text))));
    mf_json_set_units(document, &physical);
    struct json_object root = mf_json_root(document);
    assert_ok(
        mf_target_files_read(&t, &root, &(struct target_scene){&box, &binary, NULL, &physical}));
    mf_json_finish(&root);
    assert_ok(mf_json_close(document, STATUS_OK));
    mf_target_files_targets(&t, false, &fitted, &compared);
    assert_false(targets_ask(&fitted, kind));
    assert_int_equal(compared.target[kind].count, 3);
    assert_true(isnan(compared.target[kind].value[0]));
    assert_close(compared.target[kind].value[1], -2, 1e-6);
    assert_close(compared.target[kind].error[1], 1, 1e-6);
    mf_target_files_clear(&t);
}

static void test_targets_read_takes_all_kinds(void **state) {
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    assert_ok(read(state, RDF ", " ETD ", " VACF ", " MSD ", " NUMBERS, &t));
    mf_target_files_targets(&t, true, &fitted, &compared);
    assert_int_equal(mf_targets_count(&compared), 6);
    assert_int_equal(mf_targets_count(&fitted), 5);
    assert_false(targets_ask(&fitted, TARGET_PRESSURE));
    assert_close(*compared.target[TARGET_PRESSURE].value, -3, 0);
    assert_close(*fitted.target[TARGET_DIFFUSION].value, 0.02, 0);
    assert_close(*fitted.target[TARGET_DIFFUSION].error, 0.001, 0);
    assert_close(fitted.target[TARGET_DIFFUSION].weight, 7, 0);
    assert_close(fitted.target[TARGET_RDF].weight, 0, 0);
    assert_int_equal(fitted.target[TARGET_RDF].count, 4);
    assert_int_equal(fitted.target[TARGET_ETD].count, 6);
    assert_close(fitted.target[TARGET_ETD].value[2], 0.9, 0);
    assert_true(isnan(fitted.target[TARGET_ETD].value[4]));
    assert_int_equal(target_files_etd(&t)->left_out, 1);
    assert_close(fitted.etd_interval, 0.1, 1e-12);
    assert_close(fitted.etd_origins, 1, 1e-12);
    assert_int_equal(fitted.target[TARGET_VACF].count, 3);
    assert_close(fitted.target[TARGET_VACF].value[2], -0.1, 0);
    assert_close(fitted.target[TARGET_MSD].error[2], 0.002, 0);
    assert_close(fitted.motion_interval, 0.1, 1e-12);
    assert_int_equal(fitted.motion_lags, 2);
    mf_target_files_clear(&t);
}

static void test_targets_read_takes_the_columns_of_a_curve(void **state) {
    struct target_files t;
    put(state, "v.tsv", "9 0 8 3\n9 0.5 8 2\n9 1 8 1\n");
    assert_ok(read(state,
                   "\"vacf\": {\"file\": \"v.tsv\", \"time_column\": 2, \"value_column\": 4, "
                   "\"error_column\": 0}",
                   &t));
    assert_close(target_files_curve(&t, TARGET_VACF)->interval, 0.5, 0);
    assert_close(target_files_curve(&t, TARGET_VACF)->value[2], 1, 0);
    assert_close(target_files_curve(&t, TARGET_VACF)->error[2], 0, 0);
    mf_target_files_clear(&t);
}

/// As motion.tsv of `simulate` has them; numbers of columns come first.
static void test_targets_read_finds_the_columns_of_a_curve_by_their_names(void **state) {
    struct target_files t;
    put(state, "motion.tsv",
        "# time[tau]\tmsd[lambda^2]\tmsd_error[lambda^2]\tvacf[lambda^2/tau^2]\t"
        "vacf_error[lambda^2/tau^2]\n0 0 0 3 0.1\n0.5 1 0.2 2 0.3\n1 2 0.4 1 0.5\n");
    assert_ok(read(
        state, "\"vacf\": {\"file\": \"motion.tsv\"}, \"msd\": {\"file\": \"motion.tsv\"}", &t));
    assert_close(target_files_curve(&t, TARGET_VACF)->value[1], 2, 0);
    assert_close(target_files_curve(&t, TARGET_VACF)->error[2], 0.5, 0);
    assert_close(target_files_curve(&t, TARGET_MSD)->value[1], 1, 0);
    assert_close(target_files_curve(&t, TARGET_MSD)->error[2], 0.4, 0);
    mf_target_files_clear(&t);
    assert_ok(read(state,
                   "\"vacf\": {\"file\": \"motion.tsv\", \"value_column\": 2, \"error_column\": 0}",
                   &t));
    assert_close(target_files_curve(&t, TARGET_VACF)->value[1], 1, 0);
    assert_close(target_files_curve(&t, TARGET_VACF)->error[1], 0, 0);
    mf_target_files_clear(&t);
}

/// The window of motion is that of a curve, else that of the escape times, else its own.
static void test_targets_sample_motion_as_the_curves_do(void **state) {
    struct target_files t;
    struct targets fitted, compared;
    write_tables(state);
    put(state, "v.tsv", "0 3 0\n0.3 2 0\n0.6 1 0\n0.9 1 0\n");
    assert_ok(read(state, ETD ", " VACF, &t));
    mf_target_files_targets(&t, true, &fitted, &compared);
    assert_close(compared.motion_interval, 0.3, 1e-12);
    assert_int_equal(compared.motion_lags, 3);
    assert_true(targets_ask(&compared, TARGET_DIFFUSION) &&
                !targets_ask(&fitted, TARGET_DIFFUSION));
    assert_true(isnan(*compared.target[TARGET_DIFFUSION].value));
    mf_target_files_targets(&t, false, &fitted, &compared);
    assert_false(targets_ask(&compared, TARGET_DIFFUSION));
    mf_target_files_clear(&t);
    assert_ok(read(state, ETD, &t));
    mf_target_files_targets(&t, true, &fitted, &compared);
    assert_close(compared.motion_interval, 0.1, 1e-12);
    assert_int_equal(compared.motion_lags, 2);
    mf_target_files_clear(&t);
    assert_ok(read(state, "\"diffusion\": {\"value\": 1}", &t));
    mf_target_files_targets(&t, true, &fitted, &compared);
    assert_close(compared.motion_interval * (double)compared.motion_lags, 1.6, 1e-12);
    mf_target_files_clear(&t);
}

static void assert_refused(void **state, const char *members, const char *first,
                           const char *second) {
    struct target_files t;
    assert_fails(read(state, members, &t), STATUS_BAD_INPUT, first);
    assert_contains(mf_status_message(), second);
    assert_contains(mf_status_message(), "a.json: target");
    mf_target_files_clear(&t);
}

static void refuse_curve(void **state, const char *table, const char *part) {
    put(state, "v.tsv", table);
    put(state, "m.tsv", table);
    assert_refused(state, VACF, "target.vacf.file: ", part);
    // A curve that is wrong once is not also compared with the other.
    assert_refused(state, MSD, "target.msd.file: ", part);
}

static void test_targets_read_refuses_what_is_no_function_of_time(void **state) {
    refuse_curve(state, "0 3 0\n0.1 2 0\n0.3 1 0\n", ".tsv:2: the times are not equally");
    refuse_curve(state, "0.1 3 0\n0.2 2 0\n0.3 1 0\n", ".tsv:1: the times are not");
    refuse_curve(state, "0 3 0\n0 2 0\n0 1 0\n", ".tsv:2: ");
    refuse_curve(state, "0 3 0\n-0.1 2 0\n-0.2 1 0\n", ".tsv:2: ");
    refuse_curve(state, "0 3 0\n0.1 2 0\n", ".tsv: only 2 times");
    refuse_curve(state, "0 3 0\n0.1 nan 0\n0.2 1 0\n", ".tsv:2: column 2: \"nan\"");
    refuse_curve(state, "0 3 0\n0.1 2 -1\n0.2 1 0\n", ".tsv:2: column 3: -1 is not");
    refuse_curve(state, "0\n0.1\n0.2\n", ".tsv:1: 1 columns, at least 2");
    refuse_curve(state, "0 3 0\n0.1 2 nan\n0.2 1 0\n", ".tsv:2: column 3: nan is not");
    refuse_curve(state, "0 3 0\n0.1 2\n0.2 1 0\n", ".tsv:2: 2 columns");
}

static void test_targets_read_takes_curves_without_errors(void **state) {
    struct target_files t;
    put(state, "v.tsv", "t,vacf\n0,3\n0.1,2\n0.2,1\n");
    assert_ok(read(state, VACF, &t));
    assert_int_equal(target_files_curve(&t, TARGET_VACF)->points, 3);
    assert_close(target_files_curve(&t, TARGET_VACF)->value[1], 2, 0);
    assert_close(target_files_curve(&t, TARGET_VACF)->error[1], 0, 0);
    mf_target_files_clear(&t);
    assert_refused(state, "\"vacf\": {\"file\": \"v.tsv\", \"error_column\": 3}",
                   "v.tsv:2: 2 columns, at least 3", "\"error_column\"; 0 if");
}

static void test_targets_read_tells_what_is_wrong_and_where(void **state) {
    write_tables(state);
    assert_refused(state, "\"vacf\": {\"file\": \"none.tsv\"}", "target.vacf.file", "none.tsv");
    assert_refused(state, "\"vacf\": {}", "target.vacf.file", "missing");
    assert_refused(state, "\"vcf\": {}", "target.vcf", "did you mean \"vacf\"?");
    assert_refused(state, "\"msd\": {\"file\": \"m.tsv\", \"fited\": \"no\"}", "target.msd.fited",
                   "did you mean \"fitted\"?");
    assert_refused(state, "\"msd\": {\"file\": \"m.tsv\", \"fitted\": \"maybe\"}",
                   "target.msd.fitted", "\"maybe\"");
    assert_refused(state, "\"msd\": {\"file\": \"m.tsv\", \"weight\": -1}", "target.msd.weight",
                   "out of range");
    assert_refused(state, "\"msd\": {\"file\": \"m.tsv\", \"error_column\": 4}", "m.tsv:2",
                   "3 columns, at least 4");
    assert_refused(state, "\"diffusion\": {}", "target.diffusion.value", "missing");
    assert_refused(state, "\"diffusion\": 3", "target.diffusion", "expected an object");
    assert_refused(state, "\"pressure\": {\"value\": 1, \"error\": -1}", "target.pressure.error",
                   "out of range");
    put(state, "m.tsv", "0 0 0\n0.1 1 0\n0.2 2 0\n0.3 3 0\n");
    assert_refused(state, VACF ", " MSD, "target.msd", "must have the times of \"vacf\"");
}

static void test_targets_check_steps_tells_the_time_step_that_would_do(void **state) {
    struct target_files t;
    write_tables(state);
    assert_ok(read(state, VACF, &t));
    assert_ok(mf_target_files_check_steps(&t, 0.1));
    assert_ok(mf_target_files_check_steps(&t, 0.025));
    assert_fails(mf_target_files_check_steps(&t, 0.03), STATUS_BAD_INPUT, "v.tsv");
    assert_contains(mf_status_message(), "a time step of 0.025 or 0.0333");
    assert_fails(mf_target_files_check_steps(&t, 0.15), STATUS_BAD_INPUT, "a time step of 0.1");
    mf_target_files_clear(&t);
    assert_ok(read(state, ETD, &t));
    assert_fails(mf_target_files_check_steps(&t, 0.03), STATUS_BAD_INPUT,
                 "a time step of 0.025 or 0.0333");
    mf_target_files_clear(&t);
}

static void test_targets_digest_knows_every_number(void **state) {
    struct target_files t;
    uint64_t before = 1, after;
    write_tables(state);
    assert_ok(read(state, RDF ", " APART ", " ETD ", " VACF ", " MSD, &t));
    mf_target_files_digest(&t, &before);
    double *const numbers[] = {target_files_rdf(&t)->g,
                               target_files_rdf(&t)->error,
                               target_files_intermolecular(&t)->g,
                               target_files_intermolecular(&t)->error,
                               target_files_etd(&t)->survival,
                               target_files_etd(&t)->error,
                               target_files_curve(&t, TARGET_VACF)->value,
                               target_files_curve(&t, TARGET_VACF)->error,
                               target_files_curve(&t, TARGET_MSD)->value,
                               target_files_curve(&t, TARGET_MSD)->error};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        const double good = numbers[k][2];
        numbers[k][2] = good + 1;
        after = 1;
        mf_target_files_digest(&t, &after);
        assert_true(after != before);
        numbers[k][2] = good;
    }
    mf_target_files_clear(&t);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_targets_read_takes_all_kinds),
        TEST(test_target_record_of_every_kind_is_whole),
        TEST(test_target_files_table_holds_every_value_once),
        TEST(test_targets_read_gives_the_structure_between_molecules_its_own_bins),
        TEST(test_targets_read_converts_integrals_of_kirkwood_and_buff),
        TEST(test_targets_read_takes_the_columns_of_a_curve),
        TEST(test_targets_read_finds_the_columns_of_a_curve_by_their_names),
        TEST(test_targets_sample_motion_as_the_curves_do),
        TEST(test_targets_read_refuses_what_is_no_function_of_time),
        TEST(test_targets_read_takes_curves_without_errors),
        TEST(test_targets_read_tells_what_is_wrong_and_where),
        TEST(test_targets_check_steps_tells_the_time_step_that_would_do),
        TEST(test_targets_digest_knows_every_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
