// SPDX-License-Identifier: GPL-3.0-or-later
#include "watch/watch.h"

#include "base/interrupt.h"
#include "base/memory.h"
#include "io/data_table.h"
#include "io/json.h"
#include "io/output.h"
#include "watch/watch_plot.h"
#include "watch/watch_screen.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MOST_PLOTS = 6, LEAST_WIDTH = 36, LEAST_HEIGHT = 8, WAIT = 1000 };

/// Tables worth a plot, in the order of their worth; columns against the first one.
static const struct kind {
    const char *file, *title, *columns[WATCH_MOST_CURVES];
    bool logarithmic;
} kinds[] = {
    {"history.tsv", "error of the fit and its noise, by iteration", {"error", "noise"}, true},
    {"potential.tsv", "potential Phi(r)", {"phi"}, false},
    {"rdf.tsv", "g(r) and its target", {"result", "target"}, false},
    {"omega.tsv", "friction weight omega(r)", {"omega"}, false},
    {"rdf.tsv", "g(r)", {"g"}, false},
    {"thermodynamics.tsv", "temperature, by step", {"temperature"}, false},
    {"thermodynamics.tsv", "pressure, by step", {"pressure"}, false},
    {"motion.tsv", "mean-square displacement", {"msd"}, false},
    {"vacf.tsv", "velocity autocorrelation and its target", {"result", "target"}, false},
};

/// What is shown: plots and the tables that they borrow.
struct shown {
    size_t count;
    struct data_table table[MOST_PLOTS];
    struct watch_plot plot[MOST_PLOTS];
};

static void clear(struct shown *shown) {
    for (size_t k = 0; k < shown->count; k++)
        mf_data_table_clear(&shown->table[k]);
    shown->count = 0;
}

/// " [nm]": what a heading has in brackets behind the name of a column, from 1; "" if it has
/// nothing, or 1.
static void find_unit(const struct data_table *table, size_t column, char *unit, size_t size) {
    static const char gaps[] = " \t,;";
    const char *word = table->header + strspn(table->header, gaps);
    while (--column > 0 && *word) {
        word += strcspn(word, gaps);
        word += strspn(word, gaps);
    }
    const size_t name = strcspn(word, " \t,;[");
    const int length = word[name] == '[' ? (int)strcspn(word + name, gaps) : 0;
    const bool none = length == 0 || strncmp(word + name, "[1]", (size_t)length) == 0;
    snprintf(unit, size, "%s%.*s", none ? "" : " ", none ? 0 : length, word + name);
}

/// What is drawn, the units of both axes, and of which distance, time or step y is.
static void put_title(struct watch_plot *plot, const struct data_table *table, const char *title,
                      size_t column) {
    char of_x[24], of_y[24];
    find_unit(table, 1, of_x, sizeof of_x);
    find_unit(table, column, of_y, sizeof of_y);
    snprintf(plot->title, sizeof plot->title, "%s%s%s%s", title, of_y, *of_x ? "; x" : "", of_x);
}

/// A table that is not there, or has not what is asked for, is no fault.
static void add(struct shown *shown, const char *folder, const struct kind *kind) {
    char path[OUTPUT_PATH_SIZE];
    struct data_table *table = &shown->table[shown->count];
    struct watch_plot *plot = &shown->plot[shown->count];
    if (shown->count == MOST_PLOTS ||
        snprintf(path, sizeof path, "%s/%s", folder, kind->file) >= (int)sizeof path ||
        access(path, R_OK) != 0 || mf_data_table_read(table, path, 1) != STATUS_OK)
        return;
    *plot = (struct watch_plot){.logarithmic = kind->logarithmic};
    for (int c = 0; c < WATCH_MOST_CURVES && kind->columns[c]; c++) {
        const size_t column = mf_data_table_find(table, kind->columns[c]);
        if (column > 0 && plot->curves == 0)
            put_title(plot, table, kind->title, column);
        if (column > 0)
            plot->curve[plot->curves++] =
                (struct watch_curve){kind->columns[c], table->values, table->values + column - 1,
                                     table->rows, table->columns};
    }
    if (plot->curves > 0)
        shown->count++;
    else
        mf_data_table_clear(table);
}

/// Whether a process has the folder locked, which a run does until its end.
static bool is_running(const char *folder) {
    const int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool locked = file >= 0 && flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (file >= 0)
        close(file); // and the lock goes with it
    return locked;
}

/// "status" of the summary, or what can be said without one.
static void find_state(const char *folder, bool running, char *text, size_t size) {
    char path[OUTPUT_PATH_SIZE];
    struct json_document *document;
    snprintf(text, size, "%s", running ? "running" : "no run has ended here");
    if (running || snprintf(path, sizeof path, "%s/summary.json", folder) >= (int)sizeof path ||
        access(path, R_OK) != 0 || mf_json_open(&document, path) != STATUS_OK)
        return;
    struct json_object root = mf_json_root(document);
    const char *status = mf_json_choice(&root, "status", NULL, "unknown");
    snprintf(text, size, "%.60s", status ? status : "unknown");
    if (mf_json_close(document, STATUS_OK) != STATUS_OK)
        snprintf(text, size, "its summary cannot be read");
}

/// When something was last written.
static void put_heading(const char *folder, bool running, int columns, const char *end,
                        FILE *stream) {
    char state[80], text[512], when[32] = "?";
    struct stat about;
    struct tm local;
    find_state(folder, running, state, sizeof state);
    if (stat(folder, &about) == 0 && localtime_r(&about.st_mtime, &local))
        strftime(when, sizeof when, "%H:%M:%S", &local);
    snprintf(text, sizeof text, "%.300s: %s; last change %s; q quits", folder, state, when);
    fprintf(stream, "%-*.*s%s", columns, columns, text, end);
}

/// What progress.json (report/progress.h) says.
struct progress {
    int64_t done, total;
    double rate;
    char unit[FIELD_TEXT_SIZE], left[FIELD_TEXT_SIZE], text[FIELD_TEXT_SIZE];
};

#define MEMBER(name) .offset = offsetof(struct progress, name)
static const struct field progress_fields[] = {
    {"done", FIELD_INTEGER, MEMBER(done), .required = true, .maximum = 9e18, .unit = ""},
    {"total", FIELD_INTEGER, MEMBER(total), .required = true, .maximum = 9e18, .unit = ""},
    {"rate", FIELD_NUMBER, MEMBER(rate), .required = true, .maximum = DBL_MAX, .unit = ""},
    {"unit", FIELD_TEXT, MEMBER(unit), .required = true, .unit = ""},
    {"left", FIELD_TEXT, MEMBER(left), .required = true, .unit = ""},
    {"text", FIELD_TEXT, MEMBER(text), .required = true, .unit = ""},
    FIELD_END,
};

/// How far the run is, in a line; none, and 0, as long as it has not told.
static int put_progress(const char *folder, int columns, const char *end, FILE *stream) {
    char path[OUTPUT_PATH_SIZE], line[512];
    struct json_document *document;
    struct progress progress = {0};
    if (snprintf(path, sizeof path, "%s/progress.json", folder) >= (int)sizeof path ||
        access(path, R_OK) != 0 || mf_json_open(&document, path) != STATUS_OK)
        return 0;
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, progress_fields, &progress);
    if (mf_json_close(document, STATUS_OK) != STATUS_OK || progress.total == 0)
        return 0;
    snprintf(line, sizeof line, "%lld of %lld %.40s (%.0f %%), %.3g a second, %.60s left; %.160s",
             (long long)progress.done, (long long)progress.total, progress.unit,
             100 * (double)progress.done / (double)progress.total, progress.rate, progress.left,
             progress.text);
    fprintf(stream, "%-*.*s%s", columns, columns, line, end);
    return 1;
}

/// Plots side by side, `across` of them in a row.
static enum status put_row(const struct watch_plot *plots, size_t count, int width, int height,
                           const char *end, FILE *stream) {
    enum status status = STATUS_OK;
    const size_t size = WATCH_LINE_SIZE(width);
    char *lines = NULL;
    NEW_ARRAY(lines, count * (size_t)height * size);
    for (size_t k = 0; k < count; k++)
        CHECK(mf_watch_plot_draw(&plots[k], width, height, lines + k * (size_t)height * size));
    for (int row = 0; row < height; row++) {
        for (size_t k = 0; k < count; k++)
            fprintf(stream, "%s%s", lines + (k * (size_t)height + (size_t)row) * size,
                    k + 1 < count ? "  " : "");
        fputs(end, stream);
    }
done:
    mf_memory_free(lines);
    return status;
}

static enum status put_plots(const struct shown *shown, int columns, int rows, const char *end,
                             FILE *stream) {
    const int most_across = columns / LEAST_WIDTH < 1 ? 1 : columns / LEAST_WIDTH;
    const int across = (int)shown->count < most_across ? (int)shown->count
                       : most_across > 2               ? 2
                                                       : most_across;
    const int most_down = rows / LEAST_HEIGHT < 1 ? 1 : rows / LEAST_HEIGHT;
    const int wanted = ((int)shown->count + across - 1) / across;
    const int down = wanted < most_down ? wanted : most_down;
    const int width = (columns - 2 * (across - 1)) / across, height = rows / down;
    for (int row = 0; row < down && height > 2; row++) {
        const size_t first = (size_t)(row * across), left = shown->count - first;
        TRY(put_row(shown->plot + first, left < (size_t)across ? left : (size_t)across, width,
                    height, end, stream));
    }
    return STATUS_OK;
}

enum status mf_watch_write(const char *folder, int columns, int rows, const char *end,
                           FILE *stream) {
    struct shown shown = {0};
    enum status status = STATUS_OK;
    const bool running = is_running(folder);
    put_heading(folder, running, columns, end, stream);
    const int told = running ? put_progress(folder, columns, end, stream) : 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        add(&shown, folder, &kinds[k]);
    if (shown.count == 0)
        fprintf(stream, "there are no tables yet%s", end);
    else
        status = put_plots(&shown, columns, rows - 2 - told, end, stream);
    clear(&shown);
    return status;
}

/// Draw, and wait for a key or for a second.
static enum status show(const char *folder) {
    int columns, rows;
    do {
        mf_watch_screen_size(&columns, &rows);
        fputs("\033[H", stdout);
        TRY(mf_watch_write(folder, columns, rows, "\033[K\n", stdout));
        fputs("\033[J", stdout);
        fflush(stdout);
    } while (mf_watch_screen_key(WAIT) != 'q' && !mf_interrupt_requested());
    return STATUS_OK;
}

enum status mf_watch(const char *folder) {
    struct watch_screen screen;
    struct stat about;
    if (stat(folder, &about) != 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    if (!S_ISDIR(about.st_mode))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: not a folder", folder);
    TRY(mf_watch_screen_open(&screen));
    const enum status status = show(folder);
    mf_watch_screen_close(&screen);
    return status;
}
