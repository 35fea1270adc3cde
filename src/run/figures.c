// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/figures.h"

#include "io/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 64, ///< a folder's path and the name of a file in it
    ERRORS_SIZE = 2048,                ///< the end of what gnuplot says; its error comes last
    EXIT_NOT_FOUND = 127,              ///< of the child, when there is no gnuplot
    EXIT_NOT_STARTED = 126,            ///< of the child, when it cannot run gnuplot
};

struct figure {
    const char *name;      ///< of the script and of the figure
    const char *tables[3]; ///< that the script cannot do without; NULL-terminated
    const char *column;    ///< that the first table must have, or NULL
};

static const struct figure figures[] = {
    {"rdf", {"rdf.tsv"}, "target"},
    {"potential", {"potential.tsv"}, NULL},
    {"error", {"history.tsv", "timing.tsv"}, NULL},
    {"generations", {"history.tsv"}, "diversity"},
    {"simulation", {"thermodynamics.tsv"}, NULL},
};

static const struct figure comparison = {"compare", {"compare.tsv"}, NULL};

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

static bool has_tables(const char *folder, const struct figure *figure) {
    char path[PATH_SIZE];
    for (size_t k = 0; figure->tables[k]; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, figure->tables[k]);
        if (access(path, R_OK) != 0)
            return false;
    }
    snprintf(path, sizeof path, "%s/%s", folder, figure->tables[0]);
    return figure->column == NULL || has_column(path, figure->column);
}

// Where the scripts are ---------------------------------------------------------------------------

/// The folder is the right one if it has the file that every script begins with.
static bool is_plots_folder(const char *path) {
    char style[PATH_SIZE];
    snprintf(style, sizeof style, "%s/style.gp", path);
    return access(style, R_OK) == 0;
}

/// A program that is being built lies one or more folders below the source tree; one that is
/// installed lies in bin beside share.
static enum status find_plots(char plots[PATH_SIZE]) {
    char folder[OUTPUT_PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    if (length < 0)
        return status_fail(STATUS_IO, "no figures: cannot read /proc/self/exe: %s",
                           strerror(errno));
    folder[length] = '\0';
    for (char *slash = strrchr(folder, '/'); slash; slash = strrchr(folder, '/')) {
        *slash = '\0';
        snprintf(plots, PATH_SIZE, "%s/plots", folder);
        if (is_plots_folder(plots))
            return STATUS_OK;
        snprintf(plots, PATH_SIZE, "%s/share/mesofit/plots", folder);
        if (is_plots_folder(plots))
            return STATUS_OK;
    }
    return status_fail(STATUS_IO, "no figures: no folder plots with style.gp near the program");
}

// Running gnuplot ---------------------------------------------------------------------------------

/// In the child: nothing but calls that are safe after a fork of a program with threads.
static void become_gnuplot(const char *folder, const char *script, const int errors[2]) {
    const int nothing = open("/dev/null", O_RDWR);
    if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(nothing, STDOUT_FILENO) >= 0 &&
        dup2(errors[1], STDERR_FILENO) >= 0 && close(errors[0]) == 0 && chdir(folder) == 0)
        // -d: the settings of the user's own gnuplot must not change the figures.
        execlp("gnuplot", "gnuplot", "-d", script, (char *)NULL);
    _exit(errno == ENOENT ? EXIT_NOT_FOUND : EXIT_NOT_STARTED);
}

/// Read to the end and keep the last size − 1 bytes as a text.
static void read_tail(int file, char *text, size_t size) {
    char chunk[512];
    size_t used = 0;
    for (;;) {
        const ssize_t count = read(file, chunk, sizeof chunk);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            break;
        const size_t room = size - 1 - (size_t)count;
        const size_t kept = used < room ? used : room;
        memmove(text, text + used - kept, kept);
        memcpy(text + kept, chunk, (size_t)count);
        used = kept + (size_t)count;
    }
    text[used] = '\0';
}

/// Cut `text` behind its last line that is not empty, and return that line.
static const char *last_line(char *text) {
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\n", text[length - 1]))
        text[--length] = '\0';
    const char *newline = strrchr(text, '\n');
    return newline ? newline + 1 : text;
}

static int wait_for(pid_t child) {
    int state = 0;
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    return state;
}

static enum status run_gnuplot(const char *folder, const char *script) {
    int errors[2];
    if (pipe(errors) != 0)
        return status_fail(STATUS_IO, "cannot run gnuplot: %s", strerror(errno));
    const pid_t child = fork();
    if (child == 0)
        become_gnuplot(folder, script, errors);
    close(errors[1]);
    char text[ERRORS_SIZE] = "";
    if (child > 0)
        read_tail(errors[0], text, sizeof text);
    close(errors[0]);
    if (child < 0)
        return status_fail(STATUS_IO, "cannot run gnuplot: %s", strerror(errno));
    const int state = wait_for(child);
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return STATUS_OK;
    if (WIFSIGNALED(state))
        return status_fail(STATUS_IO, "gnuplot was ended by signal %d", WTERMSIG(state));
    if (WEXITSTATUS(state) == EXIT_NOT_FOUND)
        return status_fail(STATUS_IO, "gnuplot is not installed");
    return status_fail(STATUS_IO, "gnuplot failed: %s", text[0] ? last_line(text) : "no reason");
}

/// A figure that was begun and not finished would look like one.
static void remove_figure(const char *folder, const char *name) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures/%s.svg", folder, name);
    remove(path);
    snprintf(path, sizeof path, "%s/figures/%s.png", folder, name);
    remove(path);
}

static enum status draw(const char *folder, const char *plots, const char *name) {
    char path[PATH_SIZE], script[PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/figures", folder);
    TRY(output_make_folder(path));
    snprintf(script, sizeof script, "%s/%s.gp", plots, name);
    if (setenv("MESOFIT_PLOTS", plots, 1) != 0)
        return status_fail(STATUS_NO_MEMORY, "out of memory");
    const enum status status = run_gnuplot(folder, script);
    if (status == STATUS_OK)
        return STATUS_OK;
    remove_figure(folder, name);
    return status_prefix(status, "no figure %s/%s", path, name);
}

enum status figures_draw(const char *folder) {
    enum status first = STATUS_OK;
    char message[ERRORS_SIZE], plots[PATH_SIZE];
    if (access(folder, X_OK) != 0)
        return status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    TRY(find_plots(plots));
    for (size_t k = 0; k < sizeof figures / sizeof figures[0]; k++) {
        if (!has_tables(folder, &figures[k]))
            continue;
        const enum status status = draw(folder, plots, figures[k].name);
        if (first != STATUS_OK || status == STATUS_OK)
            continue;
        first = status;
        snprintf(message, sizeof message, "%s", status_message());
    }
    return first == STATUS_OK ? STATUS_OK : status_fail(first, "%s", message);
}

enum status figures_draw_comparison(const char *folder) {
    char plots[PATH_SIZE];
    if (!has_tables(folder, &comparison))
        return status_fail(STATUS_IO, "no figure of a comparison: no compare.tsv in %s", folder);
    TRY(find_plots(plots));
    return draw(folder, plots, comparison.name);
}
