// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each frame becomes a small table, gnuplot (plots/film.gp) draws them all into one GIF, and ffmpeg
// makes a film of that. All happens in a folder of its own for files that pass; only the finished
// film comes into the run's.
#include "report/film.h"

#include "base/memory.h"
#include "io/input.h"
#include "io/tracked_files.h"
#include "trajectory/snapshot.h"
#include "report/figure_script.h"
#include "report/film_paint.h"
#include "report/program.h"
#include "report/progress.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 320,
    ERRORS_SIZE = 2048,
    CHUNK_SIZE = 1 << 16,
};

/// A hundred frames of ten thousand particles take some seconds; of millions, minutes [s].
static const double drawing_time = 3600;

struct film {
    const struct film_options *options;
    char snapshots[PATH_SIZE]; ///< folder
    char scratch[256];         ///< folder for files that pass
    char **file;               ///< names of the snapshots shown, in the order of their steps
    int files;
    struct film_beads beads;
    struct film_paint paint;
    struct progress progress;
};

// Which frames -----------------------------------------------------------------------------------

static int is_vtp(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return strncmp(entry->d_name, "step_", 5) == 0 && length > 4 &&
           strcmp(entry->d_name + length - 4, ".vtp") == 0;
}

static int is_json(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return strncmp(entry->d_name, "step_", 5) == 0 && length > 5 &&
           strcmp(entry->d_name + length - 5, ".json") == 0;
}

static int list(const char *folder, int (*wanted)(const struct dirent *),
                struct dirent ***entries) {
    const int count = scandir(folder, entries, wanted, alphasort);
    if (count == 0)
        free(*entries);
    return count;
}

/// Keep at most as many as are wanted, the first and the last among them.
static enum status choose_files(struct film *film, struct dirent **entries, int count) {
    enum status status = STATUS_OK;
    const int wanted = film->options->frames < count ? film->options->frames : count;
    NEW_ARRAY(film->file, (size_t)wanted);
    for (int k = 0; k < wanted; k++) {
        const long long at = wanted > 1 ? (long long)k * (count - 1) / (wanted - 1) : 0;
        film->file[k] = strdup(entries[at]->d_name);
        film->files++;
        CHECK(film->file[k] ? STATUS_OK : STATUS_NO_MEMORY);
    }
done:
    return status;
}

static enum status find_files(struct film *film, const char *folder) {
    struct dirent **entries;
    snprintf(film->snapshots, sizeof film->snapshots, "%s/" SNAPSHOT_FOLDER, folder);
    int count = list(film->snapshots, is_vtp, &entries);
    if (count <= 0)
        count = list(film->snapshots, is_json, &entries);
    if (count <= 0)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: no snapshots to make a film of, which is of VTP or JSON; the scene needs "
            "\"snapshots\": {\"every\": 100, \"formats\": [\"vtp\"]}",
            folder);
    const enum status status = choose_files(film, entries, count);
    for (int k = 0; k < count; k++)
        free(entries[k]);
    free(entries);
    return status;
}

static void path_of(const struct film *film, int frame, char path[PATH_SIZE]) {
    snprintf(path, PATH_SIZE, "%.*s/%.255s", OUTPUT_PATH_SIZE, film->snapshots, film->file[frame]);
}

// What gnuplot draws -----------------------------------------------------------------------------

static enum status close_stream(FILE *stream, const char *path) {
    const bool failed = ferror(stream) != 0;
    if (fclose(stream) != 0 || failed)
        return mf_status_fail(STATUS_IO, "cannot write %s: is the disk full?", path);
    return STATUS_OK;
}

static enum status open_stream(FILE **stream, const char *path) {
    *stream = fopen(path, "w");
    return *stream ? STATUS_OK
                   : mf_status_fail(STATUS_IO, "cannot write %s: %s", path, strerror(errno));
}

/// frame_0.tsv and so on; its time goes into the list of times.
static enum status write_frame(const struct film *film, int number, FILE *times) {
    char path[PATH_SIZE];
    struct film_frame frame;
    FILE *stream;
    path_of(film, number, path);
    TRY(mf_film_frame_read(&frame, path, film->paint.colour));
    snprintf(path, sizeof path, "%s/frame_%d.tsv", film->scratch, number);
    enum status status = open_stream(&stream, path);
    if (status == STATUS_OK) {
        mf_film_paint_frame(&film->paint, &frame, stream);
        status = close_stream(stream, path);
    }
    fprintf(times, "%.6g ", frame.time);
    mf_film_frame_clear(&frame);
    return status;
}

/// The types that the legend has, where colours are theirs.
static void write_types(const struct film *film, FILE *stream) {
    const struct film_beads *beads = &film->beads;
    const bool legend = film->paint.scale == FILM_TYPES && beads->types > 1;
    fprintf(stream, "types = '");
    for (int type = 0; legend && type < beads->types; type++)
        if (!beads->hidden[type])
            fprintf(stream, "%s %d ", beads->name[type], type);
    fprintf(stream, "'\n");
}

static size_t count_shown(const struct film *film, const struct film_frame *frame) {
    size_t count = 0;
    for (size_t k = 0; k < frame->count; k++)
        count += !mf_film_beads_hides(&film->beads, frame->type[k]);
    return count;
}

static enum status write_head(const struct film *film, FILE *stream) {
    static const char *const scales[] = {"types", "turns", "range"};
    const struct film_paint *paint = &film->paint;
    char path[PATH_SIZE];
    struct film_frame frame;
    path_of(film, 0, path);
    TRY(mf_film_frame_read(&frame, path, NULL));
    fprintf(stream,
            "frames = %d\nscale = \"%s\"\nquantity = \"%s\"\nX = %.10g + 0.0\n"
            "Y = %.10g + 0.0\ndeep = %d\ncount = %zu.0\nleast = %.6g\nmost = %.6g\n"
            "layers = %d\n",
            film->files, scales[paint->scale], paint->colour, frame.box[0], frame.box[1],
            frame.box[2] > 0, count_shown(film, &frame), paint->min, paint->max,
            film->beads.bonds.rows > 0 ? FILM_LAYERS : 0);
    write_types(film, stream);
    mf_film_paint_palette(paint, stream);
    mf_film_frame_clear(&frame);
    return STATUS_OK;
}

static enum status write_tables(const struct film *film) {
    char path[PATH_SIZE];
    FILE *stream;
    snprintf(path, sizeof path, "%s/head.gp", film->scratch);
    TRY(open_stream(&stream, path));
    enum status status = write_head(film, stream);
    fprintf(stream, "times = \"");
    for (int k = 0; k < film->files && status == STATUS_OK; k++)
        status = write_frame(film, k, stream);
    fprintf(stream, "\"\n");
    const enum status closed = close_stream(stream, path);
    return status == STATUS_OK ? closed : status;
}

// Programs ---------------------------------------------------------------------------------------

/// gnuplot tells the number of each frame that it has drawn, a line each.
static void hear(void *context, const char *text) {
    struct film *film = context;
    const char *line = text + strlen(text);
    for (int ends = 0; line > text && (ends += line[-1] == '\n') < 2;)
        line--;
    const unsigned long drawn = strtoul(line, NULL, 10);
    if (drawn > 0 && drawn <= (unsigned long)film->files)
        mf_progress_report(&film->progress, drawn, (uint64_t)film->files, "frames", "film");
}

static enum status draw(struct film *film, const char *folder) {
    const struct program_ear ear = {hear, film};
    char plots[FIGURE_SCRIPT_PATH_SIZE];
    TRY(mf_figure_script_find(plots));
    if (setenv("MESOFIT_FILM", film->scratch, 1) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    return mf_figure_script_run(folder, plots, "film", drawing_time, &ear);
}

/// Whether there is a film.mp4: without ffmpeg, or with one that cannot make it, the GIF will do.
static bool make_mp4(const struct film *film) {
    char text[ERRORS_SIZE];
    // An even number of pixels, and colours that every player knows.
    const char *const words[] = {
        "ffmpeg",    "-y",         "-loglevel", "error",
        "-i",        "film.gif",   "-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2",
        "-preset",   "veryfast",   "-pix_fmt",  "yuv420p",
        "-movflags", "+faststart", "film.mp4",  NULL};
    return mf_program_run(film->scratch, words, PROGRAM_ERRORS, drawing_time, text, sizeof text) ==
           STATUS_OK;
}

// The film in the run's folder -------------------------------------------------------------------

static enum status copy(FILE *from, FILE *to) {
    enum status status = STATUS_OK;
    char *chunk = NULL;
    NEW_ARRAY(chunk, CHUNK_SIZE);
    for (size_t size; (size = fread(chunk, 1, CHUNK_SIZE, from)) > 0;)
        fwrite(chunk, 1, size, to);
done:
    mf_memory_free(chunk);
    return status;
}

static enum status publish(const struct film *film, const char *folder, const char *kind,
                           char *made) {
    char path[PATH_SIZE];
    FILE *from;
    struct output output;
    snprintf(path, sizeof path, "%.*s/figures", OUTPUT_PATH_SIZE - 64, folder);
    TRY(mf_output_make_folder(path));
    snprintf(made, OUTPUT_PATH_SIZE, "%.*s/figures/film.%s", OUTPUT_PATH_SIZE - 64, folder, kind);
    snprintf(path, sizeof path, "%s/film.%s", film->scratch, kind);
    TRY(mf_input_open(&from, path));
    enum status status = mf_output_open(&output, made);
    if (status == STATUS_OK) {
        status = copy(from, output.stream);
        if (status == STATUS_OK)
            status = mf_output_commit(&output);
        else
            mf_output_abandon(&output);
    }
    fclose(from);
    return status;
}

/// A film of the other kind would be of an earlier run.
static void remove_other(const char *folder, const char *kind) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%.*s/figures/film.%s", OUTPUT_PATH_SIZE - 64, folder,
             strcmp(kind, "gif") == 0 ? "mp4" : "gif");
    mf_tracked_files_remove(path);
}

static enum status make(struct film *film, const char *folder, char *made) {
    char first[PATH_SIZE], middle[PATH_SIZE], last[PATH_SIZE];
    TRY(find_files(film, folder));
    path_of(film, 0, first);
    path_of(film, film->files / 2, middle);
    path_of(film, film->files - 1, last);
    TRY(mf_film_beads_read(&film->beads, folder, first, film->options->hide));
    TRY(mf_film_paint_choose(&film->paint, &film->beads, (const char *const[]){first, middle, last},
                             film->options->colour));
    TRY(write_tables(film));
    TRY(draw(film, folder));
    const char *kind = make_mp4(film) ? "mp4" : "gif";
    TRY(publish(film, folder, kind, made));
    remove_other(folder, kind);
    mf_progress_print(&film->progress, "%d frames in %.3g s", film->files,
                      mf_progress_seconds(&film->progress));
    return STATUS_OK;
}

// Beginning and end ------------------------------------------------------------------------------

static enum status make_scratch(struct film *film) {
    const char *where = getenv("TMPDIR");
    snprintf(film->scratch, sizeof film->scratch, "%.200s/mesofit-film-XXXXXX",
             where && where[0] == '/' ? where : "/tmp");
    if (mkdtemp(film->scratch))
        return STATUS_OK;
    const enum status status =
        mf_status_fail(STATUS_IO, "cannot make the folder %s: %s", film->scratch, strerror(errno));
    film->scratch[0] = '\0';
    return status;
}

static void clear(struct film *film) {
    static const char *const others[] = {"head.gp", "film.gif", "film.mp4"};
    char path[PATH_SIZE];
    for (int k = 0; k < film->files; k++) {
        snprintf(path, sizeof path, "%s/frame_%d.tsv", film->scratch, k);
        remove(path);
        free(film->file[k]);
    }
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        snprintf(path, sizeof path, "%s/%s", film->scratch, others[k]);
        remove(path);
    }
    rmdir(film->scratch);
    mf_film_beads_clear(&film->beads);
    mf_memory_free(film->file);
}

enum status mf_film_make(const char *folder, const struct film_options *options, char *made) {
    struct film film = {.options = options, .progress = mf_progress_begin(options->quiet, NULL)};
    struct tracked_files own;
    if (access(folder, X_OK) != 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    TRY(mf_tracked_files_open(&own, folder, TRACKED_FILES_OF_RUN));
    own.force = options->force;
    enum status status = make_scratch(&film);
    if (status == STATUS_OK) {
        status = make(&film, folder, made);
        clear(&film);
    }
    mf_tracked_files_close(&own);
    return status;
}
