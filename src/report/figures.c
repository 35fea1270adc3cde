// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/figures.h"

#include "io/input.h"
#include "io/output.h"
#include "observe/observable.h"
#include "report/program.h"
#include "system/composition.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 64, ///< a folder's path and the name of a file in it
    PAIR_SIZE = 2 * COMPOSITION_NAME_SIZE + 2,
    ERRORS_SIZE = 2048, ///< the end of what gnuplot says; its error comes last
};

/// A figure takes a second; one of a million rows takes some. What takes longer hangs [s].
static const double drawing_time = 300;

struct figure {
    const char *name;      ///< of the script and of the figure
    const char *tables[4]; ///< that the script cannot do without; NULL-terminated
    const char *column;    ///< that the first table must have and its like has not, or NULL
    bool by_pairs;         ///< in a mixture one for each pair type, by the first table
};

static const struct figure figures[] = {
    {"rdf", {"rdf.tsv"}, "target_error", true},
    {"potential", {"potential.tsv"}, "phi", true},
    {"omega", {"omega.tsv"}, "omega_error", false},
    {"etd_cells", {"etd_cells.tsv"}, "target", false},
    {"vacf", {"vacf.tsv"}, "target", false},
    {"msd", {"msd.tsv"}, "target", false},
    {"error", {"history.tsv", "timing.tsv"}, NULL, false},
    {"generations", {"history.tsv"}, "diversity", false},
    {"population", {"population_potential.tsv", "potential.tsv"}, NULL, false},
    {"pareto", {"pareto.tsv", "pareto_history.tsv"}, NULL, false},
};

static const struct figure comparison = {"compare", {"compare.tsv"}, NULL, false};

// Which figures -----------------------------------------------------------------------------------

/// True if a column of the table is called `column`, with or without a unit in brackets.
static bool has_column(const char *file, const char *column) {
    FILE *stream = fopen(file, "r");
    if (stream == NULL)
        return false;
    bool found = false;
    char *line = NULL;
    size_t size = 0;
    while (!found && getline(&line, &size, stream) > 0 && line[0] == '#')
        for (char *rest, *word = strtok_r(line, "# \t\n", &rest); word && !found;
             word = strtok_r(NULL, " \t\n", &rest))
            found =
                strcspn(word, "[") == strlen(column) && strncmp(word, column, strlen(column)) == 0;
    free(line);
    fclose(stream);
    return found;
}

/// A file that can be read to its end, which a pipe or a device may not have.
static bool is_table(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode) && access(path, R_OK) == 0;
}

/// Whether all files of a list are there.
static bool has_files(const char *folder, const char *const *files) {
    char path[PATH_SIZE];
    for (; *files; files++) {
        snprintf(path, sizeof path, "%s/%s", folder, *files);
        if (!is_table(path))
            return false;
    }
    return true;
}

static bool has_tables(const char *folder, const struct figure *figure) {
    char path[PATH_SIZE];
    if (!has_files(folder, figure->tables))
        return false;
    snprintf(path, sizeof path, "%s/%s", folder, figure->tables[0]);
    return figure->column == NULL || has_column(path, figure->column);
}

// Drawing -----------------------------------------------------------------------------------------

static enum status find_plots(char plots[PATH_SIZE]) {
    const enum status status = mf_program_find_folder(plots, PATH_SIZE, "plots", "style.gp");
    return status == STATUS_OK ? status : mf_status_prefix(status, "no figures");
}

static enum status run_gnuplot(const char *folder, const char *script) {
    // -d: the settings of the user's own gnuplot must not change the figures.
    const char *const words[] = {"gnuplot", "-d", script, NULL};
    char errors[ERRORS_SIZE];
    return mf_program_run(folder, words, PROGRAM_ERRORS, drawing_time, errors, sizeof errors);
}

/// A figure that was begun and not finished would look like one.
static void remove_figure(const char *folder, const char *name) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures/%s.svg", folder, name);
    remove(path);
    snprintf(path, sizeof path, "%s/figures/%s.png", folder, name);
    remove(path);
}

/// Whether a file ends as it must, a blank or two behind not counted: gnuplot says nothing of a
/// full disk.
static bool ends_with(const char *path, const char *end, size_t length) {
    char tail[64];
    FILE *stream;
    if (mf_input_open(&stream, path) != STATUS_OK)
        return false;
    const bool long_enough = fseek(stream, -(long)sizeof tail, SEEK_END) == 0;
    size_t bytes = long_enough ? fread(tail, 1, sizeof tail, stream) : 0;
    fclose(stream);
    while (bytes > 0 && tail[bytes - 1] == '\n')
        bytes--;
    return bytes >= length && memcmp(tail + bytes - length, end, length) == 0;
}

static enum status check_figure(const char *folder, const char *name) {
    static const char svg_end[] = "</svg>", png_end[] = "IEND\xae\x42\x60\x82";
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures/%s.svg", folder, name);
    bool whole = ends_with(path, svg_end, sizeof svg_end - 1);
    snprintf(path, sizeof path, "%s/figures/%s.png", folder, name);
    whole = whole && ends_with(path, png_end, sizeof png_end - 1);
    return whole ? STATUS_OK
                 : mf_status_fail(STATUS_IO, "gnuplot left it unfinished; is the disk full?");
}

/// Draw a figure with a script; an earlier one of that name goes first, and with it a link that
/// would be followed.
static enum status draw_to(const char *folder, const char *plots, const char *name,
                           const char *drawn) {
    char path[PATH_SIZE], script[PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/figures", folder);
    TRY(mf_output_make_folder(path));
    snprintf(script, sizeof script, "%s/%s.gp", plots, name);
    if (setenv("MESOFIT_PLOTS", plots, 1) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    remove_figure(folder, drawn);
    enum status status = run_gnuplot(folder, script);
    if (status == STATUS_OK)
        status = check_figure(folder, drawn);
    if (status == STATUS_OK)
        return STATUS_OK;
    remove_figure(folder, drawn);
    return mf_status_prefix(status, "no figure %s/%s", path, drawn);
}

/// Draw a figure, of the pair type `pair`, as "_A-B", or of all.
static enum status draw(const char *folder, const char *plots, const char *name, const char *pair) {
    char drawn[128];
    if (setenv("MESOFIT_PAIR", pair, 1) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    snprintf(drawn, sizeof drawn, "%s%s", name, pair);
    return draw_to(folder, plots, name, drawn);
}

/// Take "_A-B" out of "rdf_A-B.tsv", if the name is made so, of the names of two types and no more:
/// it comes from the folder, where it could be anything.
static bool take_pair(const char *name, const char *table, char pair[PAIR_SIZE]) {
    char first[PAIR_SIZE], second[PAIR_SIZE];
    const size_t stem = strcspn(table, "."), length = strlen(name), end = strlen(".tsv");
    if (length < stem + end || length - stem - end >= PAIR_SIZE ||
        strncmp(name, table, stem) != 0 || strcmp(name + length - end, ".tsv") != 0 ||
        name[stem] != '_')
        return false;
    snprintf(pair, PAIR_SIZE, "%.*s", (int)(length - stem - end), name + stem);
    const size_t dash = strcspn(pair, "-");
    if (pair[dash] == '\0')
        return false;
    snprintf(first, sizeof first, "%.*s", (int)dash - 1, pair + 1);
    snprintf(second, sizeof second, "%s", pair + dash + 1);
    return mf_composition_is_name(first) && mf_composition_is_name(second);
}

/// Draw a figure from a table of one pair type, like rdf_A-B.tsv, if `name` is one.
static enum status draw_pair(const char *folder, const char *plots, const struct figure *figure,
                             const char *name, size_t *count) {
    char path[PATH_SIZE], pair[PAIR_SIZE];
    if (!take_pair(name, figure->tables[0], pair))
        return STATUS_OK;
    // A name such as "rdf_now_A-B" or "potential_A-B_history" could be of types "now_A" and
    // "B_history"; the columns tell another table.
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (!is_table(path) || !has_column(path, figure->column))
        return STATUS_OK;
    ++*count;
    return draw(folder, plots, figure->name, pair);
}

/// Draw a figure for each pair type, and count them; the first failure.
static enum status draw_pairs(const char *folder, const char *plots, const struct figure *figure,
                              size_t *count) {
    struct dirent **entries;
    enum status first = STATUS_OK;
    const int files = scandir(folder, &entries, NULL, alphasort);
    if (files < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    for (int k = 0; k < files; k++) {
        const enum status status = draw_pair(folder, plots, figure, entries[k]->d_name, count);
        first = first == STATUS_OK ? status : first;
        free(entries[k]);
    }
    free(entries);
    return first;
}

/// Draw a figure if its tables are there, and count it; or one for each pair type.
static enum status draw_figure(const char *folder, const char *plots, const struct figure *figure,
                               size_t *count) {
    if (!has_tables(folder, figure))
        return figure->by_pairs ? draw_pairs(folder, plots, figure, count) : STATUS_OK;
    ++*count;
    return draw(folder, plots, figure->name, "");
}

/// The figure of an observable; that without a script of its own is told what to draw.
static enum status draw_observable(const char *folder, const char *plots,
                                   const struct observable *observable, size_t *count) {
    if (observable->figure == NULL || !has_files(folder, observable->files))
        return STATUS_OK;
    // It shows the box of the settings, which the folder of a state of a fit has not.
    static const char *const settings[] = {"used.json", NULL};
    if (strcmp(observable->figure, "configuration") == 0 && !has_files(folder, settings))
        return STATUS_OK;
    ++*count;
    if (strcmp(observable->figure, OBSERVABLE_FIGURE_OF_CURVE) != 0 &&
        strcmp(observable->figure, OBSERVABLE_FIGURE_OF_GROUPS) != 0)
        return draw(folder, plots, observable->figure, "");
    if (setenv("MESOFIT_TABLE", observable->files[0], 1) != 0 ||
        setenv("MESOFIT_FIGURE", observable->name, 1) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    return draw_to(folder, plots, observable->figure, observable->name);
}

/// Whether a file is a table of a measurement, x, values, errors, that has no script of its own.
static bool is_curve(const char *name) {
    static const char *const known[] = {"rdf.tsv", "msd.tsv", "vacf.tsv"};
    char pair[PAIR_SIZE];
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(name, known[k]) == 0)
            return true;
    return take_pair(name, known[0], pair);
}

static enum status draw_curve(const char *folder, const char *plots, const char *table,
                              size_t *count) {
    char path[PATH_SIZE], name[PAIR_SIZE + 8];
    snprintf(path, sizeof path, "%s/%s", folder, table);
    if (!is_table(path) || has_column(path, "target"))
        return STATUS_OK;
    ++*count;
    snprintf(name, sizeof name, "%.*s", (int)(strlen(table) - strlen(".tsv")), table);
    if (setenv("MESOFIT_TABLE", table, 1) != 0 || setenv("MESOFIT_FIGURE", name, 1) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    return draw_to(folder, plots, OBSERVABLE_FIGURE_OF_CURVE, name);
}

/// Draw the curves of a measurement, which has a target.json, and count them; the first failure.
static enum status draw_measured(const char *folder, const char *plots, size_t *count) {
    static const char *const target[] = {"target.json", NULL};
    struct dirent **entries;
    enum status first = STATUS_OK;
    const int files = has_files(folder, target) ? scandir(folder, &entries, NULL, alphasort) : -1;
    for (int k = 0; k < files; k++) {
        const enum status status = is_curve(entries[k]->d_name)
                                       ? draw_curve(folder, plots, entries[k]->d_name, count)
                                       : STATUS_OK;
        first = first == STATUS_OK ? status : first;
        free(entries[k]);
    }
    if (files >= 0)
        free(entries);
    return first;
}

/// The name of an observable of groups whose distribution beside its target a table is, as
/// "bond_lengths_backbone.tsv", or NULL.
static const char *observable_of(const char *table) {
    for (size_t k = 0; mf_observables[k]; k++) {
        const struct observable *observable = mf_observables[k];
        const size_t length = strlen(observable->name);
        if (observable->figure && observable->targets &&
            strcmp(observable->figure, OBSERVABLE_FIGURE_OF_GROUPS) == 0 &&
            strncmp(table, observable->name, length) == 0 && table[length] == '_')
            return observable->name;
    }
    return NULL;
}

/// Draw the distributions of groups beside their targets, and count them; the first failure.
static enum status draw_groups(const char *folder, const char *plots, size_t *count) {
    struct dirent **entries;
    enum status first = STATUS_OK;
    char path[PATH_SIZE], name[FIELD_TEXT_SIZE];
    const int files = scandir(folder, &entries, NULL, alphasort);
    for (int k = 0; k < files; k++) {
        const char *table = entries[k]->d_name;
        const char *end = strstr(table, ".tsv");
        snprintf(path, sizeof path, "%s/%s", folder, table);
        if (observable_of(table) && end && end[4] == '\0' && is_table(path) &&
            has_column(path, "target")) {
            ++*count;
            snprintf(name, sizeof name, "%.*s", (int)(end - table), table);
            const bool told =
                setenv("MESOFIT_TABLE", table, 1) == 0 && setenv("MESOFIT_FIGURE", name, 1) == 0;
            const enum status status =
                told ? draw_to(folder, plots, OBSERVABLE_FIGURE_OF_GROUPS, name)
                     : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
            first = first == STATUS_OK ? status : first;
        }
        free(entries[k]);
    }
    if (files >= 0)
        free(entries);
    return first;
}

/// Draw all figures, and count them, also those that fail.
static enum status draw_all(const char *folder, size_t *count) {
    enum status first = STATUS_OK;
    char message[ERRORS_SIZE], plots[PATH_SIZE];
    if (access(folder, X_OK) != 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    TRY(find_plots(plots));
    const size_t fixed = sizeof figures / sizeof *figures;
    TRY(draw_measured(folder, plots, count));
    TRY(draw_groups(folder, plots, count));
    for (size_t k = 0; k < fixed || mf_observables[k - fixed]; k++) {
        const enum status status =
            k < fixed ? draw_figure(folder, plots, &figures[k], count)
                      : draw_observable(folder, plots, mf_observables[k - fixed], count);
        if (first != STATUS_OK || status == STATUS_OK)
            continue;
        first = status;
        snprintf(message, sizeof message, "%s", mf_status_message());
    }
    return first == STATUS_OK ? STATUS_OK : mf_status_fail(first, "%s", message);
}

enum status mf_figures_draw(const char *folder) {
    size_t count = 0;
    return draw_all(folder, &count);
}

enum status mf_figures_draw_again(const char *folder) {
    size_t count = 0;
    TRY(draw_all(folder, &count));
    return count > 0 ? STATUS_OK
                     : mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: there is nothing to draw: no table that a fit or a "
                                      "simulation leaves",
                                      folder);
}

enum status mf_figures_draw_comparison(const char *folder) {
    char plots[PATH_SIZE];
    if (!has_tables(folder, &comparison))
        return mf_status_fail(STATUS_IO, "no figure of a comparison: no compare.tsv in %s", folder);
    TRY(find_plots(plots));
    return draw(folder, plots, comparison.name, "");
}

enum status mf_figures_draw_accuracy(const char *table) {
    static const char ending[] = ".tsv";
    char plots[PATH_SIZE], folder[OUTPUT_PATH_SIZE - 256], name[256];
    const char *slash = strrchr(table, '/');
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - table) : 1, slash ? table : ".");
    snprintf(name, sizeof name, "%s", slash ? slash + 1 : table);
    if (strlen(slash ? slash + 1 : table) >= sizeof name || strlen(table) >= sizeof folder)
        return mf_status_fail(STATUS_IO, "no figure of %.60s…: its path is too long", table);
    const size_t length = strlen(name), cut = sizeof ending - 1;
    if (length > cut && strcmp(name + length - cut, ending) == 0)
        name[length - cut] = '\0';
    TRY(find_plots(plots));
    if (setenv("MESOFIT_TABLE", slash ? slash + 1 : table, 1) != 0 ||
        setenv("MESOFIT_FIGURE", name, 1) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    return draw_to(folder, plots, "accuracy", name);
}
