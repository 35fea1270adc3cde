// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/figures.h"

#include "io/tracked_files.h"
#include "observe/observable.h"
#include "report/figure_script.h"
#include "system/composition.h"
#include "system/topology.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    PATH_SIZE = FIGURE_SCRIPT_PATH_SIZE,
    PART_SIZE = 2 * COMPOSITION_NAME_SIZE + 2 > TOPOLOGY_NAME_SIZE + 1
                    ? 2 * COMPOSITION_NAME_SIZE + 2
                    : TOPOLOGY_NAME_SIZE + 1,
    MESSAGE_SIZE = 2048,
};

/// What may stand after the name of a figure's table, as "_A-B" of "rdf_A-B.tsv".
enum parts {
    NO_PARTS,
    PAIRS,          ///< in a mixture a pair type: a figure each
    PAIRS_TOGETHER, ///< the same, but one figure of all
    GROUPS,         ///< of bonds, angles, dihedrals or local densities: a figure each
};

struct figure {
    const char *name;
    const char *script;
    const char *tables[4]; ///< that the script cannot do without; NULL-terminated
    const char *column;    ///< that the first table must have and its like has not, or NULL
    enum parts parts;      ///< of the first table
    const char *number;    ///< column of it that must have a number in some row, or NULL
};

#define DISTRIBUTION(NAME, kind, beads, key, ...)                                                  \
    {#key, "groups", {#key ".tsv"}, "target", GROUPS, NULL},
#define ENERGY(NAME, kind, ...)                                                                    \
    {#kind "s", "bonded", {#kind "s.tsv"}, "energy_error", GROUPS, NULL},
static const struct figure figures[] = {
    {"rdf", "rdf", {"rdf.tsv"}, "target_error", PAIRS, NULL},
    {"intermolecular_rdf", "rdf", {"intermolecular_rdf.tsv"}, "target_error", PAIRS, NULL},
    {"intermolecular_rdf",
     "intermolecular_rdf",
     {"intermolecular_rdf.tsv"},
     "g",
     PAIRS_TOGETHER,
     NULL},
    BONDED_LIST(DISTRIBUTION){"potential", "potential", {"potential.tsv"}, "phi", PAIRS, NULL},
    BONDED_LIST(ENERGY){"many_body", "bonded", {"many_body.tsv"}, "energy_error", GROUPS, NULL},
    {"omega", "omega", {"omega.tsv"}, "omega_error", NO_PARTS, NULL},
    {"etd_cells", "etd_cells", {"etd_cells.tsv"}, "target", NO_PARTS, NULL},
    {"vacf", "vacf", {"vacf.tsv"}, "target", NO_PARTS, NULL},
    {"msd", "msd", {"msd.tsv"}, "target", NO_PARTS, NULL},
    {"error", "error", {"history.tsv", "timing.tsv"}, NULL, NO_PARTS, "error"},
    {"generations", "generations", {"history.tsv"}, "diversity", NO_PARTS, NULL},
    {"population", "population", {"population_potential.tsv"}, NULL, PAIRS, NULL},
    {"flow_panels", "flow_panels", {"flow_field.tsv"}, NULL, NO_PARTS, NULL},
    {"pareto", "pareto", {"pareto.tsv", "pareto_history.tsv"}, NULL, NO_PARTS, NULL},
};

// Which figures -----------------------------------------------------------------------------------

/// Whether a word of a heading is this name, with or without a unit in brackets.
static bool is_called(const char *word, const char *name) {
    return strcspn(word, "[\n") == strlen(name) && strncmp(word, name, strlen(name)) == 0;
}

/// Whether a table has a column of this name.
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
            found = is_called(word, column);
    free(line);
    fclose(stream);
    return found;
}

/// A file that can be read to its end, which a pipe or a device may not have.
static bool is_table(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode) && access(path, R_OK) == 0;
}

/// Whether a table has more than its arguments, as that of a run that was stopped early need not.
static bool has_values(const char *path) {
    FILE *stream = fopen(path, "r");
    char *line = NULL;
    size_t size = 0;
    bool found = false;
    while (stream && !found && getline(&line, &size, stream) > 0) {
        char *rest, *word = line[0] == '#' ? NULL : strtok_r(line, " \t\n", &rest);
        while (word && !found && (word = strtok_r(NULL, " \t\n", &rest)))
            found = strcmp(word, "nan") != 0;
    }
    free(line);
    if (stream)
        fclose(stream);
    return found;
}

/// The field of a line of a table that stands at a place, or that begins with a name; its place, or
/// −1.
static int find_field(char *line, int place, const char *name, const char **field) {
    char *rest, *word = strtok_r(line, "\t\n", &rest);
    for (int k = 0; word; word = strtok_r(NULL, "\t\n", &rest), k++) {
        *field = word + strspn(word, "# ");
        if (name ? is_called(*field, name) : k == place)
            return k;
    }
    return -1;
}

/// Whether a column has a number in some row: that of an error has none where a method does without
/// and where all candidates fail.
static bool has_number(const char *path, const char *column) {
    FILE *stream = fopen(path, "r");
    char *line = NULL;
    size_t size = 0;
    const char *field = "";
    int place = -1;
    bool found = false;
    while (stream && !found && getline(&line, &size, stream) > 0) {
        if (line[0] == '#')
            place = find_field(line, -1, column, &field);
        else
            found = place >= 0 && find_field(line, place, NULL, &field) == place &&
                    isfinite(strtod(field, NULL));
    }
    free(line);
    if (stream)
        fclose(stream);
    return found;
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
    return (figure->column == NULL || has_column(path, figure->column)) &&
           (figure->number == NULL || has_number(path, figure->number));
}

// Drawing -----------------------------------------------------------------------------------------

/// Take "_A-B" out of "rdf_A-B.tsv", if the name is made so, of the names of two types and no more,
/// or "_backbone" out of "bonds_backbone.tsv": it comes from the folder, where it could be
/// anything.
static bool take_part(const char *name, const char *table, enum parts parts, char part[PART_SIZE]) {
    char first[PART_SIZE], second[PART_SIZE];
    const size_t stem = strcspn(table, "."), length = strlen(name), end = strlen(".tsv");
    if (parts == NO_PARTS || length < stem + end || length - stem - end >= PART_SIZE ||
        strncmp(name, table, stem) != 0 || strcmp(name + length - end, ".tsv") != 0 ||
        name[stem] != '_')
        return false;
    snprintf(part, PART_SIZE, "%.*s", (int)(length - stem - end), name + stem);
    if (parts == GROUPS)
        return mf_topology_is_name(part + 1);
    const size_t dash = strcspn(part, "-");
    if (part[dash] == '\0')
        return false;
    snprintf(first, sizeof first, "%.*s", (int)dash - 1, part + 1);
    snprintf(second, sizeof second, "%s", part + dash + 1);
    return mf_composition_is_name(first) && mf_composition_is_name(second);
}

/// Draw a figure from one table, of the part `part` or of all, and count it.
static enum status draw(const char *folder, const char *plots, const struct figure *figure,
                        const char *table, const char *part, size_t *count) {
    char drawn[128];
    snprintf(drawn, sizeof drawn, "%s%s", figure->name, part);
    ++*count;
    return mf_figure_script_draw(folder, plots, figure->script, table, drawn);
}

/// Whether a file is a table of one part that the figure is drawn from, like rdf_A-B.tsv: no type
/// is called "now_A" or "B_history" (base/names.h). The columns tell the rdf.tsv of a fit from
/// that of a simulation.
static bool is_of_part(const char *folder, const struct figure *figure, const char *name,
                       char part[PART_SIZE]) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return take_part(name, figure->tables[0], figure->parts, part) && is_table(path) &&
           (figure->column == NULL || has_column(path, figure->column));
}

/// Draw a figure for each part, or one of all of them, and count them; the first failure.
static enum status draw_parts(const char *folder, const char *plots, const struct figure *figure,
                              size_t *count) {
    struct dirent **entries;
    enum status first = STATUS_OK;
    bool done = false;
    const int files = scandir(folder, &entries, NULL, alphasort);
    if (files < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    for (int k = 0; k < files; k++) {
        const char *name = entries[k]->d_name;
        char part[PART_SIZE];
        if (!done && is_of_part(folder, figure, name, part)) {
            done = figure->parts == PAIRS_TOGETHER;
            const enum status status = draw(folder, plots, figure, name, done ? "" : part, count);
            first = first == STATUS_OK ? status : first;
        }
        free(entries[k]);
    }
    free(entries);
    return first;
}

/// Draw a figure if its tables are there, and count it; or one for each part.
static enum status draw_figure(const char *folder, const char *plots, const struct figure *figure,
                               size_t *count) {
    return has_tables(folder, figure)  ? draw(folder, plots, figure, figure->tables[0], "", count)
           : figure->parts != NO_PARTS ? draw_parts(folder, plots, figure, count)
                                       : STATUS_OK;
}

/// The figure of an observable; that without a script of its own is called after it.
static enum status draw_observable(const char *folder, const char *plots,
                                   const struct observable *observable, size_t *count) {
    if (observable->figure == NULL)
        return STATUS_OK;
    // What else it writes may be left out.
    const char *const first[] = {observable->files[0], NULL};
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, *first);
    if (!has_files(folder, first) || !has_values(path))
        return STATUS_OK;
    // It shows the box of the settings, which the folder of a state of a fit has not.
    static const char *const settings[] = {"used.json", NULL};
    if (strcmp(observable->figure, "configuration") == 0 && !has_files(folder, settings))
        return STATUS_OK;
    const bool shared = strcmp(observable->figure, OBSERVABLE_FIGURE_OF_CURVE) == 0 ||
                        strcmp(observable->figure, OBSERVABLE_FIGURE_OF_GROUPS) == 0;
    ++*count;
    return mf_figure_script_draw(folder, plots, observable->figure, observable->files[0],
                                 shared ? observable->name : observable->figure);
}

/// Whether a file is a table of a measurement, x, values, errors, that has no script of its own.
static bool is_curve(const char *name) {
    static const char *const known[] = {"rdf.tsv", "msd.tsv", "vacf.tsv"};
    char pair[PART_SIZE];
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(name, known[k]) == 0)
            return true;
    return take_part(name, known[0], PAIRS, pair);
}

static enum status draw_curve(const char *folder, const char *plots, const char *table,
                              size_t *count) {
    char path[PATH_SIZE], name[PART_SIZE + 8];
    snprintf(path, sizeof path, "%s/%s", folder, table);
    if (!is_table(path) || has_column(path, "target"))
        return STATUS_OK;
    ++*count;
    snprintf(name, sizeof name, "%.*s", (int)(strlen(table) - strlen(".tsv")), table);
    return mf_figure_script_draw(folder, plots, OBSERVABLE_FIGURE_OF_CURVE, table, name);
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

static enum status check_access(const char *folder) {
    struct stat is;
    if (stat(folder, &is) == 0 && !S_ISDIR(is.st_mode))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: a file: give the folder of a run", folder);
    return access(folder, X_OK) == 0 ? STATUS_OK
                                     : mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
}

/// Draw all figures, and count them, also those that fail.
static enum status draw_all(const char *folder, size_t *count) {
    enum status first = STATUS_OK;
    char message[MESSAGE_SIZE], plots[PATH_SIZE];
    TRY(check_access(folder));
    TRY(mf_figure_script_find(plots));
    const size_t fixed = sizeof figures / sizeof *figures;
    TRY(draw_measured(folder, plots, count));
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

enum status mf_figures_draw_again(const char *folder, bool force) {
    struct tracked_files own;
    size_t count = 0;
    TRY(check_access(folder));
    TRY(mf_tracked_files_open(&own, folder, TRACKED_FILES_OF_RUN));
    own.force = force;
    const enum status status = draw_all(folder, &count);
    mf_tracked_files_close(&own);
    TRY(status);
    return count > 0 ? STATUS_OK
                     : mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: there is nothing to draw: no table that a fit or a "
                                      "simulation leaves",
                                      folder);
}

enum status mf_figures_draw_comparison(const char *folder) {
    static const char *const tables[] = {"compare.tsv", NULL};
    static const char *const etd[] = {"etd_compare.tsv", NULL};
    static const char *const vacf[] = {"vacf_compare.tsv", NULL};
    char plots[PATH_SIZE];
    if (!has_files(folder, tables))
        return mf_status_fail(STATUS_IO, "no figure of a comparison: no compare.tsv in %s", folder);
    TRY(mf_figure_script_find(plots));
    TRY(mf_figure_script_draw(folder, plots, "compare", tables[0], "compare"));
    return has_files(folder, etd) || has_files(folder, vacf)
               ? mf_figure_script_draw(folder, plots, "compare_dynamics", tables[0],
                                       "compare_dynamics")
               : STATUS_OK;
}

/// Folder and name of the figure of a table, and the table's name there.
static enum status find_table(const char *path, char folder[OUTPUT_PATH_SIZE], char name[256],
                              const char **table) {
    static const char ending[] = ".tsv";
    const char *slash = strrchr(path, '/');
    *table = slash ? slash + 1 : path;
    const size_t length = strlen(*table), cut = sizeof ending - 1;
    if (length >= 256 || strlen(path) >= OUTPUT_PATH_SIZE - 256)
        return mf_status_fail(STATUS_IO, "no figure of %.60s…: its path is too long", path);
    snprintf(folder, OUTPUT_PATH_SIZE, "%.*s", slash ? (int)(slash - path) : 1, slash ? path : ".");
    snprintf(name, 256, "%s", *table);
    if (length > cut && strcmp(name + length - cut, ending) == 0)
        name[length - cut] = '\0';
    return STATUS_OK;
}

enum status mf_figures_check_table(const char *path) {
    char folder[OUTPUT_PATH_SIZE], name[256], figure[PATH_SIZE + 256];
    const char *table;
    struct stat about;
    TRY(find_table(path, folder, name, &table));
    for (int kind = 0; kind < 2; kind++) {
        snprintf(figure, sizeof figure, "%s/figures/%s.%s", folder, name, kind ? "png" : "svg");
        if (lstat(figure, &about) == 0)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s is there: --force replaces it, -o OTHER keeps it", figure);
    }
    return STATUS_OK;
}

enum status mf_figures_draw_table(const char *path, const char *script) {
    char folder[OUTPUT_PATH_SIZE], name[256], plots[PATH_SIZE];
    const char *table;
    TRY(find_table(path, folder, name, &table));
    TRY(mf_figure_script_find(plots));
    return mf_figure_script_draw(folder, plots, script, table, name);
}
