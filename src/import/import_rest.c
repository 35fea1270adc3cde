// SPDX-License-Identifier: GPL-3.0-or-later
//
// What settings say that a run file does not: one line a reason.
#include "import/import_settings.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// The first line whose path begins that of an element says what becomes of it.
static const struct {
    const char *path, *reason; ///< NULL: it is read
} fates[] = {
    {"non-bonded.name", NULL},
    {"non-bonded.type", NULL},
    {"non-bonded.max", NULL},
    {"non-bonded.inverse.target", NULL},
    {"non-bonded.inverse.optimizer.rdf.target", NULL},
    {"bonded.name", NULL},
    {"bonded.inverse.target", NULL},
    {"bonded.inverse.gromacs.table", NULL},
    {"inverse.kBT", NULL},
    {"non-bonded.min", "ranges and bins are those of the targets"},
    {"non-bonded.step", "ranges and bins are those of the targets"},
    {"bonded.min", "ranges and bins are those of the targets"},
    {"bonded.max", "ranges and bins are those of the targets"},
    {"bonded.step", "ranges and bins are those of the targets"},
    {"non-bonded.inverse.p_target", "it is a target only with <post_update>pressure"},
    {"non-bonded.inverse.do_potential", "all that has a target is found at once"},
    {"bonded.inverse.do_potential", "all that has a target is found at once"},
    {"non-bonded.inverse.post_", "a fit needs no scripts between its steps"},
    {"bonded.inverse.post_", "a fit needs no scripts between its steps"},
    {"inverse.p_target", "it is a target only inside <non-bonded><inverse>, with "
                         "<post_update>pressure"},
    {"inverse.method", "the method is chosen; \"method\": {\"name\": …} asks for another"},
    {"inverse.iie", "the method is chosen; \"method\": {\"name\": …} asks for another"},
    {"non-bonded.inverse.imc", "imc takes its regularisation from the noise"},
    {"bonded.inverse.imc", "imc takes its regularisation from the noise"},
    {"inverse.imc", "imc takes its regularisation from the noise"},
    {"inverse.iterations_max", "a fit ends when it has converged"},
    {"inverse.convergence_check", "a fit ends when it has converged"},
    {"inverse.scale", "a fit ends when it has converged"},
    {"inverse.average", "a fit ends when it has converged"},
    {"non-bonded.inverse.optimizer.density", "profiles of the density are no targets"},
    {"non-bonded.inverse.optimizer", "potentials are tables; laws with parameters: \"unknowns\""},
    {"inverse.optimizer", "potentials are tables; laws with parameters: \"unknowns\""},
    {"non-bonded.re", "potentials are tables; splines: \"method\": {\"name\": "
                      "\"relative-entropy\"}"},
    {"non-bonded.fmatch", "force matching is not here"},
    {"bonded.fmatch", "force matching is not here"},
    {"fmatch", "force matching is not here"},
    {"non-bonded.inverse", "no other program runs in between"},
    {"bonded.inverse", "no other program runs in between"},
    {"inverse", "no other program runs in between"},
    {"nbsearch", "no other program runs in between"},
    {"", "not known"},
};
enum { FATES = sizeof fates / sizeof *fates, PATH_SIZE = 256, LIST_SIZE = 600 };

struct rest {
    const struct import_settings *settings;
    char list[FATES][LIST_SIZE]; ///< of each line that is the first of its reason: paths
};

static int first_of_reason(int fate) {
    int first = 0;
    while (fates[first].reason == NULL || strcmp(fates[first].reason, fates[fate].reason) != 0)
        first++;
    return first;
}

/// Add a path, as far as one name below that of its line, to a list in which it is not yet.
static void add(char list[LIST_SIZE], const char *path, const char *of_line) {
    char item[PATH_SIZE];
    const size_t above = strlen(of_line);
    const char *const below = strlen(path) > above ? strchr(path + above + 1, '.') : NULL;
    snprintf(item, sizeof item, "%.*s", (int)(below ? (size_t)(below - path) : strlen(path)), path);
    const char *const known = strstr(list, item);
    const size_t length = strlen(list);
    if (known == NULL || strchr(", ", known[strlen(item)]) == NULL)
        snprintf(list + length, LIST_SIZE - length, "%s%s", length ? ", " : "", item);
}

static void collect(struct rest *rest, const struct xml_element *element, const char *path) {
    char inner[PATH_SIZE];
    int fate = 0;
    for (const struct xml_element *child = element->child; child; child = child->next) {
        snprintf(inner, sizeof inner, "%.180s%s%.60s", path, path[0] ? "." : "", child->name);
        collect(rest, child, inner);
    }
    if (element->child || element->text[0] == '\0' || element == rest->settings->pressure)
        return;
    while (strncmp(path, fates[fate].path, strlen(fates[fate].path)) != 0)
        fate++;
    if (fates[fate].reason)
        add(rest->list[first_of_reason(fate)], path, fates[fate].path);
}

void mf_import_settings_print_rest(const struct import_settings *settings,
                                   struct progress *progress) {
    struct rest rest = {.settings = settings};
    collect(&rest, settings->document.root, "");
    for (int k = 0; k < FATES; k++)
        if (rest.list[k][0])
            mf_import_print(progress, "left out: %s: %s", rest.list[k], fates[k].reason);
}

void mf_import_print(struct progress *progress, const char *format, ...) {
    char text[LIST_SIZE + OUTPUT_PATH_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (progress->watcher)
        mf_progress_print(progress, "%s", text);
    else if (!progress->quiet)
        printf("%s\n", text);
}
