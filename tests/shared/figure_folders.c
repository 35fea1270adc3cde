// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/figure_folders.h"

#include "io/output.h"
#include "report/figures.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char figure_folders_fit_rdf[] =
    "# r[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]\n"
    "0.5\t0\t0\t0\t0\n1\t1.5\tnan\t1.4\t0.1\n1.5\t1\t0.1\t1.1\t0.1\n";
const char figure_folders_imc_history[] =
    "# iteration[1]\tevaluations[1]\tengine_steps[1]\terror[1]\tnoise[1]\tdamping[1]\t"
    "regularisation[1]\n0\t1\t100\t0.5\t0.01\t1\t0\n";
const char figure_folders_timing[] = "# iteration[1]\tseconds[s]\n0\t0\n1\t2\n";

static char root[] = "/tmp/mesofit_figures_XXXXXX";

const char *figure_folders_root(void) {
    return root;
}

int figure_folders_begin(void **state) {
    (void)state;
    return mkdtemp(root) ? 0 : -1;
}

int figure_folders_end(void **state) {
    (void)state;
    char command[FIGURE_PATH];
    snprintf(command, sizeof command, "rm -r '%s'", root);
    return system(command);
}

void figure_folders_write(const char *folder, const char *name, const char *text) {
    char path[2 * FIGURE_PATH];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
}

void figure_folders_make(char path[FIGURE_PATH], const char *name) {
    snprintf(path, FIGURE_PATH, "%s/%s", root, name);
    assert_int_equal(mf_output_make_folder(path), STATUS_OK);
}

void figure_folders_draw(const char *folder) {
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
}

bool figure_folders_print(const char *folder, const char *name, const char *word) {
    char path[FIGURE_PATH + 64], line[4096];
    bool found = false;
    snprintf(path, sizeof path, "%s/figures/%s.svg", folder, name);
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    while (!found && fgets(line, sizeof line, stream))
        found = strstr(line, word) != NULL;
    fclose(stream);
    return found;
}

bool figure_folders_drawn(const char *folder, const char *name) {
    char svg[FIGURE_PATH + 64], png[FIGURE_PATH + 64];
    snprintf(svg, sizeof svg, "%s/figures/%s.svg", folder, name);
    snprintf(png, sizeof png, "%s/figures/%s.png", folder, name);
    assert_int_equal(access(svg, F_OK), access(png, F_OK));
    if (access(svg, F_OK) != 0)
        return false;
    static const char *const code[] = {"using", "word(", "column(", "every ", "title "};
    for (size_t k = 0; k < sizeof code / sizeof *code; k++)
        if (figure_folders_print(folder, name, code[k]))
            fail_msg("%s says \"%s\"", svg, code[k]);
    return true;
}

void figure_folders_skip_without_gnuplot(void) {
    if (system("gnuplot --version >/dev/null 2>&1") != 0)
        skip();
}
