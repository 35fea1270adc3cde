// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/figure_script.h"

#include "io/input.h"
#include "io/output.h"
#include "report/program.h"

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

static enum status tell(const char *name, const char *text) {
    return setenv(name, text, 1) == 0 ? STATUS_OK
                                      : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
}

enum status mf_figure_script_draw(const char *folder, const char *plots, const char *script,
                                  const char *table, const char *figure) {
    char path[PATH_SIZE], file[PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/figures", folder);
    TRY(mf_output_make_folder(path));
    snprintf(file, sizeof file, "%s/%s.gp", plots, script);
    TRY(tell("MESOFIT_PLOTS", plots));
    TRY(tell("MESOFIT_TABLE", table));
    TRY(tell("MESOFIT_FIGURE", figure));
    // An earlier one goes first, and with it a link that would be followed.
    remove_figure(folder, figure);
    enum status status = run_gnuplot(folder, file);
    if (status == STATUS_OK)
        status = check_figure(folder, figure);
    if (status == STATUS_OK)
        return STATUS_OK;
    remove_figure(folder, figure);
    return mf_status_prefix(status, "no figure %s/%s", path, figure);
}
