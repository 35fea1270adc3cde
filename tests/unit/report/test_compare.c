// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/compare.h"

#include "io/data_table.h"
#include "io/output.h"
#include "io/units.h"
#include "problem/targets.h"
#include "report/result.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH = 512 };

static char root[] = "/tmp/mesofit_compare_XXXXXX";

static const char good_summary[] =
    "{\"status\": \"ok\", \"method\": \"imc\", \"version\": \"0.1\", \"seconds\": 12.25,"
    " \"threads\": 2, \"iterations\": 3, \"evaluations\": 4, \"engine_steps\": 80000,"
    " \"rdf_rmse\": 0.01234, \"rdf_rmse_error\": 0.0004, \"rdf_noise\": 0.003,"
    " \"temperature\": 1.001, \"temperature_configurational\": 1.02, \"pressure\": 3.25,"
    " \"seed\": 7, \"a_later_key\": {\"x\": [1]}}";

/// Of a fit of omega alone by its escape times; what is not known is null.
static const char omega_summary[] =
    "{\"status\": \"converged\", \"method\": \"cma-es\", \"version\": \"0.1\","
    " \"etd_rmse\": 0.056, \"etd_rmse_error\": null, \"etd_noise\": 0.0027,"
    " \"diffusion\": 0.0263, \"diffusion_error\": 0.0002, \"diffusion_cm2_per_s\": 4.5e-5,"
    " \"omega_truth_rms\": 0.42, \"diffusion_rmse\": null}";

static void write_file(const char *folder, const char *name, const char *text) {
    char path[PATH];
    snprintf(path, sizeof path, "%s/%s/%s", root, folder, name);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
}

/// A small fit; the second of two has other numbers in its potential.
static void make_fit(const char *folder, const char *summary, double phi) {
    char path[PATH], potential[256];
    snprintf(path, sizeof path, "%s/%s", root, folder);
    assert_int_equal(mf_output_make_folder(path), STATUS_OK);
    snprintf(potential, sizeof potential,
             "# r[lambda]\tphi[k_BT_0]\tforce[k_BT_0/lambda]\tphi_error[k_BT_0]\n"
             "0.5\t1000\t9\tnan\n1\t%g\t-1\t0.1\n1.5\t0\t0\tnan\n",
             phi);
    write_file(folder, "summary.json", summary);
    write_file(folder, "potential.tsv", potential);
    write_file(folder, "rdf.tsv",
               "# r[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]\n"
               "0.5\t0\t0\t0\t0\n1\t1.5\t0.01\t1.48\t0.02\n1.5\t1\t0.01\t1.01\t0.02\n");
    write_file(folder, "history.tsv",
               "# iteration[1]\tevaluations[1]\tengine_steps[1]\terror[1]\tnoise[1]\tdamping[1]\n"
               "0\t1\t100\t0.5\t0.003\t1\n1\t2\t200\t0.1\t0.003\t1\n2\t3\t300\t0.02\tnan\t1\n");
    // Tables of a run that was stopped between the two and went on: iteration 1 has no time.
    write_file(folder, "timing.tsv", "# iteration[1]\tseconds[s]\n0\t1.5\n2\t3\n");
}

/// A fit of omega, without g(r) and potential. `columns`: those of omega.tsv after omega.
static void make_omega_fit(const char *folder, const char *names, const char *columns) {
    char path[PATH], omega[512];
    snprintf(path, sizeof path, "%s/%s", root, folder);
    assert_int_equal(mf_output_make_folder(path), STATUS_OK);
    snprintf(omega, sizeof omega, "# r[lambda]\tomega[sqrt(mu/tau)]%s\n0\t2%s\n0.5\t1%s\n1\t0%s\n",
             names, columns, columns, columns);
    write_file(folder, "omega.tsv", omega);
    write_file(folder, "summary.json", omega_summary);
    write_file(
        folder, "history.tsv",
        "# iteration\tevaluations\tengine_steps\terror[1]\tnoise[1]\n0\t1\t100\t0.5\t0.003\n");
    write_file(folder, "timing.tsv", "# iteration\tseconds[s]\n0\t1.5\n");
}

/// A fit of omega with its escape times and its VACF, all of them `shift` off.
static void make_moving_fit(const char *folder, double shift) {
    char cells[512], vacf[512];
    make_omega_fit(folder, "\tomega_error[sqrt(mu/tau)]", "\t0.1");
    snprintf(cells, sizeof cells,
             "# time[tau]\tr0[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]\n"
             "0\t0.5\t1\t0\t1\t0\n0\t1.5\t1\t0\t1\t0\n"
             "0.2\t0.5\t0.9\t0.01\t%g\t0.02\n0.2\t1.5\t0.5\tnan\t%g\tnan\n",
             0.9 + shift, 0.5 + shift);
    snprintf(vacf, sizeof vacf,
             "# time[tau]\ttarget[lambda^2/tau^2]\ttarget_error[lambda^2/tau^2]"
             "\tresult[lambda^2/tau^2]\tresult_error[lambda^2/tau^2]\ttime[ps]\n"
             "0\t3\t0.1\t3\t0.2\t0\n0.1\t1\t0.1\t%g\t0.2\t7\n",
             1 + shift);
    write_file(folder, "etd_cells.tsv", cells);
    write_file(folder, "vacf.tsv", vacf);
}

/// A simulation that has a matrix of E, and motion.tsv.
static void make_moving_simulation(const char *folder) {
    char path[PATH];
    snprintf(path, sizeof path, "%s/%s", root, folder);
    assert_int_equal(mf_output_make_folder(path), STATUS_OK);
    write_file(folder, "summary.json", "{\"status\": \"ok\", \"method\": \"simulate\"}");
    write_file(folder, "etd_bins.tsv", "# r0[lambda]\tpairs[1]\n0.5\t20\n1.5\t0\n");
    write_file(folder, "etd.tsv",
               "# time[tau]\tE(r0=0.5)[1]\tE(r0=1.5)[1]\n0\t1\tnan\n0.2\t0.75\tnan\n");
    write_file(folder, "etd_error.tsv",
               "# time[tau]\tE_error(r0=0.5)[1]\tE_error(r0=1.5)[1]\n0\t0\tnan\n0.2\t0.03\tnan\n");
    write_file(folder, "motion.tsv",
               "# time[tau]\tmsd[lambda^2]\tmsd_error[lambda^2]\tvacf[lambda^2/tau^2]\t"
               "vacf_error[lambda^2/tau^2]\n0\t0\t0\t2.5\t0.1\n0.1\t0.02\t0.001\t1.5\t0.2\n");
}

/// Text of a file, to be freed.
static char *read_text(const char *path) {
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    char *text = calloc(1, 1 << 20);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    fclose(stream);
    return text;
}

/// Compare up to two folders of the root into <root>/cmp.
static enum status compare(const char *first, const char *second, bool quiet) {
    char paths[2][PATH], out[PATH];
    snprintf(paths[0], PATH, "%s/%s", root, first);
    snprintf(paths[1], PATH, "%s/%s", root, second ? second : "");
    snprintf(out, sizeof out, "%s/cmp", root);
    return mf_compare_folders((const char *const[]){paths[0], paths[1]}, second ? 2 : 1, out, false,
                              quiet);
}

static char *compare_text(const char *table) {
    char path[PATH];
    snprintf(path, sizeof path, "%s/cmp/%s", root, table);
    return read_text(path);
}

/// Comment lines of compare.tsv after comparing two folders.
static char *names_of(const char *first, const char *second) {
    assert_int_equal(compare(first, second, true), STATUS_OK);
    return compare_text("compare.tsv");
}

static void test_numbers_are_those_of_the_summary(void **state) {
    (void)state;
    struct data_table table;
    char path[PATH];
    assert_int_equal(compare("a/out", "b/out", true), STATUS_OK);
    snprintf(path, sizeof path, "%s/cmp/compare.tsv", root);
    assert_int_equal(mf_data_table_read(&table, path, 2), STATUS_OK);
    assert_int_equal(table.rows, 2);
    assert_int_equal(table.columns, 14);
    const double ratio = 0.01234 / 0.003;
    const double expected[] = {1,       12.25,  2,     3,     4,    80000, ratio,
                               0.01234, 0.0004, 0.003, 1.001, 1.02, 3.25,  7.0};
    for (size_t k = 0; k < 14; k++)
        assert_close(table.values[14 + k], expected[k], 1e-14);
    assert_contains(table.header, "index[1]\tseconds[s]\tthreads[1]");
    assert_contains(table.comments, "# 1\tb\timc\tok\t0.1\n");
    mf_data_table_clear(&table);
}

static const struct field *summary_field(const char *target, const char *ending,
                                         struct result_field *room) {
    char name[FIELD_TEXT_SIZE];
    const struct field *field;
    snprintf(name, sizeof name, "%s%s", target, ending);
    for (size_t n = 0; (field = mf_result_summary_field(n, room)); n++)
        if (strcmp(field->name, name) == 0)
            return field;
    fail_msg("%s is not compared", name);
    return NULL;
}

/// Whatever can be a target, its distance is read from summaries, in the unit that it has there.
static void test_distances_from_all_targets_are_known(void **state) {
    (void)state;
    static const char *const endings[] = {"_rmse", "_rmse_error", "_noise"};
    const struct units units = {.system = UNITS_ANGSTROM_FS,
                                .dimensions = 3,
                                .length = 0.7,
                                .temperature = 310,
                                .mass = 5e-26};
    struct result_field room;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const char *own = mf_observable_kind(kind).target->unit, *unit = own ? own : "1";
        for (size_t k = 0; k < sizeof endings / sizeof endings[0]; k++)
            assert_close_relative(
                mf_units_factor(&units,
                                summary_field(mf_targets_name(kind), endings[k], &room)->unit) /
                    mf_units_factor(&units, unit),
                1, 1e-12);
    }
}

/// A fit of g(r) and of bonds, whose error is a sum of both by their weights.
static void test_distances_of_bonds_are_compared(void **state) {
    (void)state;
    make_fit("bonds/out",
             "{\"rdf_rmse\": 0.1, \"bond_lengths_rmse\": 0.155, \"bond_lengths_rmse_error\": 0.007,"
             " \"bond_lengths_noise\": 0.06, \"bond_angles_rmse\": 0.0008}",
             -0.5);
    char *text = names_of("bonds/out", "little");
    assert_contains(text, "\tbond_lengths_rmse[1/lambda]\tbond_lengths_rmse_error[1/lambda]\t"
                          "bond_lengths_noise[1/lambda]\tbond_angles_rmse[1/degrees]\n");
    // Nothing is known of the noise of g(r) and of the angles: 0.155/0.06 is all that there is.
    assert_contains(text, "\n0\t2.583333333333333");
    assert_contains(text, "\t0.1\t0.155\t0.007\t0.06\t0.0008\n1\tnan\t0.5\tnan\tnan\tnan\tnan\n");
    free(text);
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
    text = compare_text("figures/compare.svg");
    assert_contains(text, "error of the fit");
    assert_null(strstr(text, "rmse of"));
    free(text);
    assert_int_equal(compare("a/out", "little", true), STATUS_OK);
    text = compare_text("figures/compare.svg");
    assert_contains(text, "rmse of");
    free(text);
}

static void test_missing_numbers_are_nan(void **state) {
    (void)state;
    char *text = names_of("a/out", "little");
    assert_contains(text, "\n1\tnan\tnan\tnan\tnan\tnan\tnan\t0.5\tnan");
    free(text);
}

static void test_blocks_hold_each_fit_once(void **state) {
    (void)state;
    assert_int_equal(compare("a/out", "b/out", true), STATUS_OK);
    char *text = compare_text("potential_compare.tsv");
    const char *header = "# r[lambda]\tphi[k_B.T_0]\tphi_error[k_B.T_0]\ttruth[k_B.T_0]\n";
    char expected[512];
    snprintf(expected, sizeof expected,
             "# 0\ta\n%s0.5\t1000\tnan\tnan\n1\t-0.25\t0.1\tnan\n1.5\t0\tnan\tnan\n\n\n"
             "# 1\tb\n%s0.5\t1000\tnan\tnan\n1\t-0.5\t0.1\tnan\n1.5\t0\tnan\tnan\n",
             header, header);
    assert_string_equal(text, expected);
    free(text);
    text = compare_text("rdf_compare.tsv");
    assert_contains(text, "\n1\t1.5\t0.01\t1.48\t0.02\n");
    free(text);
    text = compare_text("error_compare.tsv");
    assert_contains(text, "\n1\t2\t200\tnan\t0.1\t0.003\n2\t3\t300\t3\t0.02\tnan\n");
    free(text);
}

static void test_fits_without_a_table_keep_their_block(void **state) {
    (void)state;
    assert_int_equal(compare("weight/out", "a/out", true), STATUS_OK);
    char *text = compare_text("rdf_compare.tsv");
    assert_contains(text, "result_error[1]\nnan\tnan\tnan\tnan\tnan\n\n\n# 1\ta\n");
    free(text);
    text = compare_text("omega_compare.tsv");
    assert_string_equal(
        text, "# 0\tweight\n# r[lambda]\tomega[sqrt(mu/tau)]\tomega_error[sqrt(mu/tau)]\t"
              "truth[sqrt(mu/tau)]\n0\t2\t0.1\t1.5\n0.5\t1\t0.1\t1.5\n1\t0\t0.1\t1.5\n\n\n"
              "# 1\ta\n# r[lambda]\tomega[sqrt(mu/tau)]\tomega_error[sqrt(mu/tau)]\t"
              "truth[sqrt(mu/tau)]\nnan\tnan\tnan\tnan\n");
    free(text);
    text = compare_text("compare.tsv");
    assert_contains(text, "\tetd_rmse[1]\tetd_noise[1]\tdiffusion[lambda^2/tau]\t");
    assert_contains(text, "\tomega_truth_rms[1]\ttemperature[T_0]\t");
    free(text);
}

static void test_dynamics_stand_side_by_side(void **state) {
    (void)state;
    assert_int_equal(compare("moving/out", "moved", true), STATUS_OK);
    char *text = compare_text("etd_compare.tsv");
    assert_string_equal(
        text, "# 0\tmoving\n# time[tau]\tr0[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\t"
              "result_error[1]\n0\t0.5\t1\t0\t1\t0\n0\t1.5\t1\t0\t1\t0\n"
              "0.2\t0.5\t0.9\t0.01\t1\t0.02\n0.2\t1.5\t0.5\tnan\t0.6\tnan\n\n\n"
              "# 1\tmoved\n# time[tau]\tr0[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\t"
              "result_error[1]\n0\t0.5\tnan\tnan\t1\t0\n0\t1.5\tnan\tnan\tnan\tnan\n"
              "0.2\t0.5\tnan\tnan\t0.75\t0.03\n0.2\t1.5\tnan\tnan\tnan\tnan\n");
    free(text);
    text = compare_text("vacf_compare.tsv");
    assert_contains(text, "\n0.1\t1\t0.1\t1.1\t0.2\n\n\n# 1\tmoved\n");
    assert_contains(text, "\n0.1\tnan\tnan\t1.5\t0.2\n");
    free(text);
}

static bool has_table(const char *name) {
    char path[PATH];
    snprintf(path, sizeof path, "%s/cmp/%s", root, name);
    return access(path, F_OK) == 0;
}

static void test_figure_of_dynamics_has_what_there_are_data_for(void **state) {
    (void)state;
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
    const struct {
        const char *first, *second;
        bool curves, maps;
    } cases[] = {
        {"moving/out", "moved", true, true},
        {"moved", "moved", true, false},
        {"weight/out", "a/out", false, false},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        assert_int_equal(compare(cases[k].first, cases[k].second, true), STATUS_OK);
        assert_int_equal(has_table("figures/compare_dynamics.svg"), cases[k].curves);
        assert_int_equal(has_table("figures/compare_dynamics.png"), cases[k].curves);
        if (!cases[k].curves)
            continue;
        char *text = compare_text("figures/compare_dynamics.svg");
        assert_contains(text, "VACF(");
        assert_int_equal(strstr(text, ">target<") != NULL, cases[k].maps);
        assert_int_equal(strstr(text, "result − target") != NULL, cases[k].maps);
        free(text);
    }
}

static void test_tables_that_no_fit_has_are_not_written(void **state) {
    (void)state;
    assert_int_equal(compare("weight/out", "a/out", true), STATUS_OK);
    assert_true(has_table("omega_compare.tsv"));
    assert_int_equal(compare("a/out", "set/out", true), STATUS_OK);
    assert_false(has_table("omega_compare.tsv")); // that of the scene, not fitted
    assert_true(has_table("potential_compare.tsv"));
    assert_int_equal(compare("weight/out", NULL, true), STATUS_OK);
    assert_false(has_table("rdf_compare.tsv"));
    assert_false(has_table("potential_compare.tsv"));
    assert_true(has_table("error_compare.tsv"));
}

static void test_figure_has_the_panels_that_there_are_data_for(void **state) {
    (void)state;
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
    const struct {
        const char *first, *second;
        bool g, phi, omega;
    } cases[] = {
        {"a/out", "b/out", true, true, false},
        {"weight/out", "a/out", true, true, true},
        {"weight/out", "set/out", false, false, true},
        {"set/out", "set/out", false, false, false},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        assert_int_equal(compare(cases[k].first, cases[k].second, true), STATUS_OK);
        char *text = compare_text("figures/compare.svg");
        assert_int_equal(strstr(text, ">target<") != NULL, cases[k].g);
        assert_int_equal(strstr(text, ">Φ<") != NULL, cases[k].phi);
        assert_int_equal(strstr(text, ">ω<") != NULL, cases[k].omega);
        assert_int_equal(strstr(text, ">truth<") != NULL, cases[k].omega);
        assert_contains(text, "simulations");
        assert_contains(text, "time / s");
        free(text);
    }
}

static void test_figure_is_drawn(void **state) {
    (void)state;
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
    char path[PATH];
    assert_int_equal(compare("a/out", "it's a \"run\"/out", true), STATUS_OK);
    snprintf(path, sizeof path, "%s/cmp/figures/compare.svg", root);
    char *text = read_text(path);
    assert_contains(text, "it's a \"run\"");
    free(text);
}

static void test_names_tell_fits_apart(void **state) {
    (void)state;
    const char *const cases[][4] = {
        {"a/out", "b/out", "# 0\ta\t", "# 1\tb\t"},
        {"x/same/out", "y/same/out", "# 0\tx/same\t", "# 1\ty/same\t"},
        {"a/out", "a/out", "# 0\ta\t", "# 1\ta (2)\t"},
        {"a/out/", "b/../b/out", "# 0\ta\t", "# 1\tb\t"},
        {"it's a \"run\"/out", "a/out", "# 0\tit's a \"run\"\t", "# 1\ta\t"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char *text = names_of(cases[k][0], cases[k][1]);
        assert_contains(text, cases[k][2]);
        assert_contains(text, cases[k][3]);
        free(text);
    }
}

/// What compare prints on stdout, without the line that says where its figures are.
static char *printed_by(const char *first, const char *second, bool quiet) {
    char path[PATH];
    snprintf(path, sizeof path, "%s/printed", root);
    fflush(stdout);
    const int before = dup(STDOUT_FILENO);
    assert_non_null(freopen(path, "w", stdout));
    const enum status status = compare(first, second, quiet);
    puts("the end");
    fflush(stdout);
    assert_true(dup2(before, STDOUT_FILENO) >= 0);
    close(before);
    assert_int_equal(status, STATUS_OK);
    char *text = read_text(path);
    char figures[2 * PATH];
    snprintf(figures, sizeof figures, "figures: %s/cmp/figures\n", root);
    char *line = strstr(text, figures);
    assert_int_equal(line != NULL, !quiet);
    if (line)
        memmove(line, line + strlen(figures), strlen(line + strlen(figures)) + 1);
    return text;
}

static void test_printed_table_is_rounded_and_aligned(void **state) {
    (void)state;
    char *text = printed_by("a/out", "little", false);
    assert_string_equal(text,
                        "name    method  status  threads  iterations  simulations  steps  time/s"
                        "  error/noise  worst        rmse(g)  noise      T  T_conf     p\n"
                        "a       imc     ok            2           3            4  80000    12.2"
                        "         4.11  rdf 4.1  0.01234(40)  0.003  1.001   1.020  3.25\n"
                        "little  -       -             -           -            -      -       -"
                        "            -  -                0.5      -      -       -     -\n"
                        "the end\n");
    free(text);
}

static void test_printed_table_has_the_columns_of_any_fit(void **state) {
    (void)state;
    char *text = printed_by("weight/out", "little", false);
    assert_string_equal(text,
                        "name    method  status     error/noise  worst   rmse(g)  rmse(E)  noise(E)"
                        "            D  truth(omega)\n"
                        "weight  cma-es  converged        20.74  etd 21        -    0.056    0.0027"
                        "  0.02630(20)          0.42\n"
                        "little  -       -                    -  -           0.5        -         -"
                        "            -             -\n"
                        "the end\n");
    free(text);
}

/// Bonds off by 4 and angles by 2 of their noises; D has no noise, so that it has no place in it.
static void test_targets_count_by_their_noise(void **state) {
    (void)state;
    make_fit("noisy/out",
             "{\"bond_lengths_rmse\": 8, \"bond_lengths_noise\": 2, \"bond_angles_rmse\": 0.001,"
             " \"bond_angles_noise\": 0.0005, \"diffusion_rmse\": 7, \"diffusion_noise\": 0}",
             -0.5);
    char *text = printed_by("noisy/out", "little", false);
    assert_contains(text, " 3.16  bond_lengths 4 "); // sqrt((16 + 4)/2)
    free(text);
}

static void test_error_in_brackets_has_sensible_digits(void **state) {
    (void)state;
    const char *const cases[][2] = {
        {"\"rdf_rmse\": 0.01234, \"rdf_rmse_error\": 0.00013", " 0.01234(13)\n"},
        {"\"rdf_rmse\": 0.01234, \"rdf_rmse_error\": 0.00096", " 0.01234(96)\n"},
        {"\"rdf_rmse\": 0.01234, \"rdf_rmse_error\": 0.002", " 0.0123(20)\n"},
        {"\"rdf_rmse\": 123.4, \"rdf_rmse_error\": 25", " 123(25)\n"},
        {"\"rdf_rmse\": 0.01234, \"rdf_rmse_error\": 0", " 0.01234\n"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char summary[256];
        snprintf(summary, sizeof summary, "{%s}", cases[k][0]);
        make_fit("digits", summary, -0.5);
        char *text = printed_by("digits", NULL, false);
        assert_contains(text, cases[k][1]);
        free(text);
    }
}

static void test_quiet_prints_nothing(void **state) {
    (void)state;
    char *text = printed_by("a/out", "b/out", true);
    assert_string_equal(text, "the end\n");
    free(text);
}

static void assert_refused(const char *folder, enum status status, const char *ending) {
    char message[2 * PATH];
    snprintf(message, sizeof message, "%s/%s%s", root, folder, ending);
    assert_int_equal(compare("a/out", folder, true), status);
    assert_string_equal(mf_status_message(), message);
}

static void test_faults_name_the_file(void **state) {
    (void)state;
    assert_refused("nowhere", STATUS_IO, ": No such file or directory");
    assert_refused("a/out/rdf.tsv", STATUS_BAD_INPUT, ": not a folder");
    assert_refused("a", STATUS_BAD_INPUT,
                   "/summary.json: missing, so this is no folder of a finished fit");

    make_fit("bad", "{\"status\": \"ok\", \"seconds\": 3}", 0);
    assert_refused("bad", STATUS_BAD_INPUT,
                   "/summary.json: not the result of a fit: there is no rdf_rmse or other rmse");
    make_fit("bad", "{\"rdf_rmse\": \"small\"}", 0);
    assert_refused("bad", STATUS_BAD_INPUT,
                   "/summary.json: rdf_rmse: expected a number, found the text \"small\"");
    make_fit("bad", "[]", 0);
    assert_refused("bad", STATUS_BAD_INPUT, "/summary.json: expected an object, found an array");

    make_fit("bad", good_summary, 0);
    write_file("bad", "rdf.tsv", "# r\tg\tg_error\n0.5\t1\t0.1\n");
    assert_refused("bad", STATUS_BAD_INPUT, "/rdf.tsv: there is no column 4");
    write_file("bad", "rdf.tsv", "# nothing\n");
    assert_refused("bad", STATUS_BAD_INPUT, "/rdf.tsv:2: the file ends without a row of numbers");
    make_fit("bad", good_summary, 0);
    write_file("bad", "potential.tsv", "0.5 1\n\n0.6 1x\n");
    assert_refused("bad", STATUS_BAD_INPUT,
                   "/potential.tsv:3: column 2: \"1x\" is not a finite number");

    char path[PATH];
    make_fit("bad", good_summary, 0);
    snprintf(path, sizeof path, "%s/bad/timing.tsv", root);
    assert_int_equal(remove(path), 0);
    assert_int_equal(compare("bad", NULL, true), STATUS_IO);
    assert_contains(mf_status_message(), path);
    assert_null(strchr(mf_status_message(), '\n'));
}

static void test_no_folder_is_refused(void **state) {
    (void)state;
    assert_int_equal(mf_compare_folders(NULL, 0, root, false, true), STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), "compare: give the folder of at least one fit");
}

static int make_all(void **state) {
    (void)state;
    if (mkdtemp(root) == NULL)
        return -1;
    make_fit("a/out", good_summary, -0.25);
    make_fit("b/out", good_summary, -0.5);
    make_fit("x/same/out", good_summary, -0.5);
    make_fit("y/same/out", good_summary, -0.5);
    make_fit("it's a \"run\"/out", good_summary, -0.5);
    make_omega_fit("weight/out", "\tomega_error[sqrt(mu/tau)]\ttruth[sqrt(mu/tau)]", "\t0.1\t1.5");
    make_omega_fit("set/out", "", "");
    make_moving_fit("moving/out", 0.1);
    make_moving_simulation("moved");
    make_fit("little", "{\"rdf_rmse\": 0.5}", -0.5);
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    char command[PATH];
    snprintf(command, sizeof command, "rm -r '%s'", root);
    return system(command);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_are_those_of_the_summary),
        cmocka_unit_test(test_distances_from_all_targets_are_known),
        cmocka_unit_test(test_distances_of_bonds_are_compared),
        cmocka_unit_test(test_missing_numbers_are_nan),
        cmocka_unit_test(test_blocks_hold_each_fit_once),
        cmocka_unit_test(test_fits_without_a_table_keep_their_block),
        cmocka_unit_test(test_dynamics_stand_side_by_side),
        cmocka_unit_test(test_figure_of_dynamics_has_what_there_are_data_for),
        cmocka_unit_test(test_tables_that_no_fit_has_are_not_written),
        cmocka_unit_test(test_figure_has_the_panels_that_there_are_data_for),
        cmocka_unit_test(test_figure_is_drawn),
        cmocka_unit_test(test_names_tell_fits_apart),
        cmocka_unit_test(test_printed_table_is_rounded_and_aligned),
        cmocka_unit_test(test_printed_table_has_the_columns_of_any_fit),
        cmocka_unit_test(test_targets_count_by_their_noise),
        cmocka_unit_test(test_error_in_brackets_has_sensible_digits),
        cmocka_unit_test(test_quiet_prints_nothing),
        cmocka_unit_test(test_faults_name_the_file),
        cmocka_unit_test(test_no_folder_is_refused),
    };
    return cmocka_run_group_tests(tests, make_all, remove_all);
}
