// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/figure_script.h"

#include "io/input.h"
#include "io/tracked_files.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 64, ///< a folder's path and the name of a file in it
    ERRORS_SIZE = 2048,                ///< the end of what gnuplot says; its error comes last
};

/// A figure takes a second; one of a million rows takes some. What takes longer hangs [s].
static const double drawing_time = 300;

enum status mf_figure_script_find(char plots[FIGURE_SCRIPT_PATH_SIZE]) {
    const enum status status =
        mf_program_find_folder(plots, FIGURE_SCRIPT_PATH_SIZE, "plots", "style.gp");
    return status == STATUS_OK ? status : mf_status_prefix(status, "no figures");
}

static enum status run_gnuplot(const char *folder, const char *script, double seconds,
                               const struct program_ear *ear) {
    // -d: the settings of the user's own gnuplot must not change the figures.
    const char *const words[] = {"gnuplot", "-d", script, NULL};
    char errors[ERRORS_SIZE];
    return mf_program_hear(folder, words, PROGRAM_ERRORS, seconds, ear, errors, sizeof errors);
}

static const char *const kinds[] = {"svg", "png"};
enum { KINDS = 2 };

/// The path of a figure of one kind.
static void find_figure(const char *folder, const char *name, int kind, char path[PATH_SIZE]) {
    snprintf(path, PATH_SIZE, "%s/figures/%s.%s", folder, name, kinds[kind]);
}

/// While it is drawn, the names of both kinds end so.
static void find_temporary(const char *folder, const char *name, int kind, const char *ending,
                           char path[PATH_SIZE + OUTPUT_PARTIAL_SIZE]) {
    char figure[PATH_SIZE];
    find_figure(folder, name, kind, figure);
    snprintf(path, PATH_SIZE + OUTPUT_PARTIAL_SIZE, "%s%s", figure, ending);
}

/// Whether a file ends as it must, a blank or two after not counted: gnuplot says nothing of a
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

static enum status check_figure(const char *folder, const char *name, const char *ending) {
    static const char svg_end[] = "</svg>", png_end[] = "IEND\xae\x42\x60\x82";
    char path[PATH_SIZE + OUTPUT_PARTIAL_SIZE];
    find_temporary(folder, name, 0, ending, path);
    bool whole = ends_with(path, svg_end, sizeof svg_end - 1);
    find_temporary(folder, name, 1, ending, path);
    whole = whole && ends_with(path, png_end, sizeof png_end - 1);
    return whole ? STATUS_OK
                 : mf_status_fail(STATUS_IO, "gnuplot left it unfinished; is the disk full?");
}

/// Both kinds get their names, or none does: a figure of other tables is worse than none.
static enum status publish(const char *folder, const char *name, const char *ending,
                           enum status status) {
    char path[PATH_SIZE], temporary[PATH_SIZE + OUTPUT_PARTIAL_SIZE];
    for (int kind = 0; kind < KINDS && status == STATUS_OK; kind++) {
        find_figure(folder, name, kind, path);
        find_temporary(folder, name, kind, ending, temporary);
        if (rename(temporary, path) != 0)
            status = mf_status_fail(STATUS_IO, "%s: %s", path, strerror(errno));
    }
    for (int kind = 0; kind < KINDS && status != STATUS_OK; kind++) {
        find_figure(folder, name, kind, path);
        find_temporary(folder, name, kind, ending, temporary);
        remove(temporary);
        mf_tracked_files_remove(path);
    }
    return status;
}

/// Before gnuplot takes its second.
static enum status claim(const char *folder, const char *name) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures", folder);
    TRY(mf_output_make_folder(path));
    for (int kind = 0; kind < KINDS; kind++) {
        find_figure(folder, name, kind, path);
        TRY(mf_tracked_files_claim(path, false));
    }
    return STATUS_OK;
}

static enum status report(const char *name, const char *text) {
    return setenv(name, text, 1) == 0 ? STATUS_OK
                                      : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
}

static enum status draw(const char *folder, const char *plots, const char *script,
                        const char *table, const char *figure) {
    char file[PATH_SIZE + 64], ending[OUTPUT_PARTIAL_SIZE];
    snprintf(file, sizeof file, "%s/%s.gp", plots, script);
    mf_output_partial(ending);
    TRY(claim(folder, figure));
    TRY(report("MESOFIT_PLOTS", plots));
    TRY(report("MESOFIT_TABLE", table));
    TRY(report("MESOFIT_FIGURE", figure));
    TRY(report("MESOFIT_PARTIAL", ending));
    enum status status = run_gnuplot(folder, file, drawing_time, NULL);
    if (status == STATUS_OK)
        status = check_figure(folder, figure, ending);
    return publish(folder, figure, ending, status);
}

enum status mf_figure_script_draw(const char *folder, const char *plots, const char *script,
                                  const char *table, const char *figure) {
    const enum status status = draw(folder, plots, script, table, figure);
    return status == STATUS_OK
               ? STATUS_OK
               : mf_status_prefix(status, "no figure %s/figures/%s", folder, figure);
}

enum status mf_figure_script_run(const char *folder, const char *plots, const char *script,
                                 double seconds, const struct program_ear *ear) {
    char file[PATH_SIZE + 64];
    snprintf(file, sizeof file, "%s/%s.gp", plots, script);
    TRY(report("MESOFIT_PLOTS", plots));
    return run_gnuplot(folder, file, seconds, ear);
}
