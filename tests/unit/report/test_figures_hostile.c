// SPDX-License-Identifier: GPL-3.0-or-later
//
// Names, words, links and programs that mean no good: figures of a folder from somebody else.
#include "report/figures.h"

#include "io/output.h"
#include "shared/figure_folders.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// True if a file of that name has come into the folder or beside it.
static bool has_come(const char *folder, const char *name) {
    char path[FIGURE_PATH + 64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0 || access(name, F_OK) == 0;
}

/// Names of tables that a shell or gnuplot would take for commands; "rdf_A_1-B.tsv" is a table of
/// a mixture, and drawn.
static void test_names_of_tables_are_no_commands(void **state) {
    (void)state;
    static const char *const endings[] = {"A-B$(touch pwned)",
                                          "A-'; system('touch pwned'); a='",
                                          "A-\"; system(\"touch pwned\"); a=\"",
                                          "A-`touch pwned`",
                                          "A-B' . system('touch pwned') . '",
                                          "A-B\n; touch pwned",
                                          "A-|touch pwned",
                                          "A-%n%s",
                                          "<touch pwned-B",
                                          "A B-C",
                                          "Φ-B",
                                          "--",
                                          "-B",
                                          "A_1-B"};
    enum { ENDINGS = sizeof endings / sizeof *endings };
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "hostile");
    for (size_t k = 0; k < ENDINGS; k++) {
        char name[128];
        snprintf(name, sizeof name, "potential_%s.tsv", endings[k]);
        figure_folders_write(folder, name, "# r phi force phi_error\n0.5 1 0 0.1\n1 0 0 nan\n");
        snprintf(name, sizeof name, "potential_%s_history.tsv", endings[k]);
        figure_folders_write(folder, name, "# r i0 i1\n0.5 1 0\n1 0 0\n");
        snprintf(name, sizeof name, "rdf_%s.tsv", endings[k]);
        figure_folders_write(folder, name, figure_folders_fit_rdf);
    }
    figure_folders_write(folder, "thermodynamics.tsv",
                         "# s t T U P Tc\n0 0 1 0 3 1\n1 0.1 1 0 3 1\n");
    figure_folders_write(folder, "omega.tsv", "# r omega omega_error\n0 2 1\n1 0 1\n");
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
    assert_false(has_come(folder, "pwned"));
    assert_true(figure_folders_drawn(folder, "rdf_A_1-B") &&
                figure_folders_drawn(folder, "potential_A_1-B"));
    assert_true(figure_folders_drawn(folder, "simulation"));
}

/// What stands in a table is no command either: here the names of targets on the axes of a front.
static void test_words_of_tables_are_no_commands(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "words");
    figure_folders_write(
        folder, "pareto.tsv",
        "# member\trank\tchosen\tmeasured\terror\tx'; system('touch pwned'); a='_rmse\t"
        "`touch pwned`_rmse\trdf_noise\tetd_noise\n1\t1\t1\t3\t2\t0.1\t0.2\t0\t0\n");
    figure_folders_write(folder, "pareto_history.tsv",
                         "# iteration\tfront\terror\trdf_rmse\tetd_rmse\n0\t0\t2\t0.1\t0.2\n");
    figure_folders_write(folder, "used.json",
                         "{\"'; system('touch pwned'); '\": {\"rdf\":\n"
                         "\"fitted\": \"yes\"}}\n");
    figure_folders_write(folder, "history.tsv", figure_folders_imc_history);
    figure_folders_write(folder, "timing.tsv", figure_folders_timing);
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
    assert_false(has_come(folder, "pwned"));
    assert_true(figure_folders_drawn(folder, "pareto"));
}

/// Nor are the names of types that a configuration tells.
static void test_names_of_types_are_no_commands(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "types");
    figure_folders_write(folder, "used.json", "{\n\t\"box\":\t[4, 4, 4]\n}\n");
    figure_folders_write(folder, "configuration.tsv",
                         "# types: A'; touch pwned; ' 1 \"; system('touch pwned'); \"B 1\n"
                         "# x\ty\tz\n1\t1\t1\n2\t2\t2\n");
    figure_folders_write(folder, "configuration_bonds.tsv",
                         "# first\tsecond\n1\t2\n1\t900\nsystem(\"touch pwned\")\t-1\n");
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
    assert_false(has_come(folder, "pwned"));
    assert_true(figure_folders_drawn(folder, "configuration"));
}

/// The table of a benchmark has the name that the user gave.
static void test_names_of_a_benchmark_are_no_commands(void **state) {
    static const char table[] =
        "# wanted 0.005\n# integrator\ttime_step\tcpu\tcpu_error\tcpu_to_error\tg\tge\tn\tr\tre\t"
        "t\tte\tc\tce\ttemperature_configurational[T_0]\n"
        "aboba\t0.01\t1\t0.1\t1\t0.01\t0.001\t0.002\t0.01\t0.001\t0.1\t0.1\t0.01\t0.01\t1\n"
        "aboba\t0.02\t0.5\t0.1\t1\t0.02\t0.001\t0.002\t0.01\t0.001\t0.1\t0.1\t0.01\t0.01\t1\n";
    static const char *const names[] = {"a'; system('touch pwned'); b='",
                                        "<touch pwned",
                                        "|touch pwned",
                                        "$(touch pwned)",
                                        "a b",
                                        "-",
                                        "plain"};
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH], path[2 * FIGURE_PATH], name[128];
    figure_folders_make(folder, "benchmark");
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(name, sizeof name, "%s.tsv", names[k]);
        figure_folders_write(folder, name, table);
        snprintf(path, sizeof path, "%s/%s", folder, name);
        if (mf_figures_draw_table(path, "accuracy") != STATUS_OK)
            fail_msg("%s", mf_status_message());
        assert_false(has_come(folder, "pwned"));
        assert_true(figure_folders_drawn(folder, names[k]));
    }
}

/// A program in the place of gnuplot that says all is well.
static enum status draw_with(const char *gnuplot, const char *folder) {
    char place[FIGURE_PATH], script[FIGURE_PATH + 64], path[2 * FIGURE_PATH],
        *before = strdup(getenv("PATH"));
    figure_folders_make(place, "bin");
    figure_folders_write(place, "gnuplot", gnuplot);
    snprintf(script, sizeof script, "%s/gnuplot", place);
    assert_int_equal(chmod(script, 0755), 0);
    snprintf(path, sizeof path, "%s:%s", place, before);
    assert_int_equal(setenv("PATH", path, 1), 0);
    const enum status status = mf_figures_draw(folder);
    assert_int_equal(setenv("PATH", before, 1), 0);
    free(before);
    return status;
}

/// Figures that are cut, as on a full disk, where gnuplot returns 0: none are left, and it is said.
static void test_unfinished_figures_are_none(void **state) {
    static const char *const gnuplots[] = {
        "#!/bin/sh\nprintf '%1000s' x > figures/rdf.svg$MESOFIT_PARTIAL\n"
        "printf '%1000s' x > figures/rdf.png$MESOFIT_PARTIAL\n",
        "#!/bin/sh\nprintf '%1000s</svg>\\n' x > figures/rdf.svg$MESOFIT_PARTIAL\n"
        ": > figures/rdf.png$MESOFIT_PARTIAL\n",
        "#!/bin/sh\nprintf '%1000s</svg>\\n' x > figures/rdf.svg$MESOFIT_PARTIAL\n", "#!/bin/sh\n"};
    (void)state;
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "unfinished");
    figure_folders_write(folder, "rdf.tsv", figure_folders_fit_rdf);
    for (size_t k = 0; k < sizeof gnuplots / sizeof *gnuplots; k++) {
        assert_int_equal(draw_with(gnuplots[k], folder), STATUS_IO);
        assert_non_null(strstr(mf_status_message(), "figures/rdf: gnuplot left it unfinished"));
        assert_false(figure_folders_drawn(folder, "rdf"));
    }
    assert_int_equal(draw_with("#!/bin/sh\nprintf '%1000s</svg>\\n\\n' x > "
                               "figures/rdf.svg$MESOFIT_PARTIAL\nprintf "
                               "'%100sIEND\\256\\102\\140\\202' x > "
                               "figures/rdf.png$MESOFIT_PARTIAL\n",
                               folder),
                     STATUS_OK);
}

/// A link where a figure comes, to a file of somebody.
static void test_figures_do_not_follow_links(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH], figures[FIGURE_PATH + 64], link[2 * FIGURE_PATH], text[16] = "";
    figure_folders_make(folder, "links");
    figure_folders_write(folder, "rdf.tsv", figure_folders_fit_rdf);
    figure_folders_write(folder, "victim", "precious");
    snprintf(figures, sizeof figures, "%s/figures", folder);
    assert_int_equal(mf_output_make_folder(figures), STATUS_OK);
    snprintf(link, sizeof link, "%s/rdf.svg", figures);
    assert_int_equal(symlink("../victim", link), 0);
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "rdf"));
    snprintf(link, sizeof link, "%s/victim", folder);
    FILE *stream = fopen(link, "r");
    assert_non_null(stream);
    assert_non_null(fgets(text, sizeof text, stream));
    fclose(stream);
    assert_string_equal(text, "precious");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_of_tables_are_no_commands),
        cmocka_unit_test(test_words_of_tables_are_no_commands),
        cmocka_unit_test(test_names_of_types_are_no_commands),
        cmocka_unit_test(test_names_of_a_benchmark_are_no_commands),
        cmocka_unit_test(test_unfinished_figures_are_none),
        cmocka_unit_test(test_figures_do_not_follow_links),
    };
    return cmocka_run_group_tests(tests, figure_folders_begin, figure_folders_end);
}
