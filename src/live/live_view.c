// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_view.h"

#include "base/memory.h"
#include "base/visible.h"
#include "base/version.h"
#include "io/json.h"
#include "io/json_write.h"
#include "io/text_file.h"
#include "live/live_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const phases[] = {"choosing", "looking", "ready", "running",
                                     "paused",   "stopped", "ended", "refused"};
static const char *const roots[LIVE_ROOTS] = {"work", "result", "now"};

static int open_folder(const char *path) {
    return open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

enum status mf_live_view_init(struct live_view *view, const char *topics, bool stays) {
    *view =
        (struct live_view){.topics = topics, .stays = stays, .root = {open_folder("."), -1, -1}};
    if (view->root[LIVE_WORK] < 0)
        return mf_status_fail(STATUS_IO, "the working folder: %s", strerror(errno));
    TRY(mf_live_feed_init(&view->feed));
    TRY(mf_live_control_init(&view->control));
    if (pthread_mutex_init(&view->lock, NULL) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "no lock for the live view");
    mf_live_view_set_phase(view, LIVE_CHOOSING, NULL);
    return STATUS_OK;
}

void mf_live_view_clear(struct live_view *view) {
    for (int root = 0; root < LIVE_ROOTS; root++)
        if (view->root[root] >= 0)
            close(view->root[root]);
    free(view->text);
    pthread_mutex_destroy(&view->lock);
    mf_live_control_clear(&view->control);
    mf_live_feed_clear(&view->feed);
}

void mf_live_view_publish(struct live_view *view, enum live_slot slot, struct json_writer *writer) {
    char *text = NULL;
    size_t size;
    FILE *stream = writer ? open_memstream(&text, &size) : NULL;
    const enum status status =
        stream ? mf_json_write_stream(writer, stream, "the live view") : STATUS_NO_MEMORY;
    if (stream && fclose(stream) == 0 && status == STATUS_OK)
        mf_live_feed_push(&view->feed, slot, text);
    free(text);
    mf_json_writer_free(writer);
}

/// A path as a person can read it: JSON is UTF-8, and names of files need not be.
static void write_path(struct json_writer *writer, const char *key, const char *path) {
    char shown[OUTPUT_PATH_SIZE];
    mf_visible_copy(shown, sizeof shown, path, "");
    mf_json_write_text(writer, key, shown);
}

/// The lock is held.
static void publish_state(struct live_view *view) {
    struct json_writer *writer = mf_json_writer_create();
    if (writer == NULL)
        return;
    mf_json_write_text(writer, "phase", phases[view->phase]);
    mf_json_write_text(writer, "kind",
                       view->file[0] == '\0' ? (view->folder[0] ? "results" : "")
                       : view->is_fit        ? "fit"
                                             : "simulation");
    write_path(writer, "file", view->file);
    write_path(writer, "folder", view->folder);
    mf_json_write_text(writer, "message", view->message);
    mf_json_write_integer(writer, "stays", view->stays);
    mf_json_write_text(writer, "version", mf_version);
    mf_live_view_publish(view, LIVE_STATE, writer);
}

/// The lock is held.
static void set_phase(struct live_view *view, enum live_phase phase, const char *message) {
    view->phase = phase;
    snprintf(view->message, sizeof view->message, "%s", message ? message : "");
    publish_state(view);
}

void mf_live_view_set_phase(struct live_view *view, enum live_phase phase, const char *message) {
    pthread_mutex_lock(&view->lock);
    if (view->phase != phase || message != NULL || phase == LIVE_CHOOSING)
        set_phase(view, phase, message);
    pthread_mutex_unlock(&view->lock);
}

/// The lock is held.
static bool is_busy(const struct live_view *view) {
    return view->phase == LIVE_RUNNING || view->phase == LIVE_PAUSED;
}

bool mf_live_view_is_busy(struct live_view *view) {
    pthread_mutex_lock(&view->lock);
    const bool busy = is_busy(view);
    pthread_mutex_unlock(&view->lock);
    return busy;
}

enum status mf_live_view_order(struct live_view *view, struct live_order *order) {
    pthread_mutex_lock(&view->lock);
    const bool busy = is_busy(view);
    if (!busy) {
        mf_live_control_order(&view->control, order);
        set_phase(view, LIVE_RUNNING, NULL);
    }
    pthread_mutex_unlock(&view->lock);
    return busy ? mf_status_fail(STATUS_BAD_INPUT, "a run is going on") : STATUS_OK;
}

enum status mf_live_view_is_fit(const char *file, const char *text, bool *is_fit) {
    struct json_document *document;
    TRY(mf_json_open_text(&document, file, text));
    struct json_object root = mf_json_root(document);
    *is_fit = mf_json_has(&root, "target") || mf_json_has(&root, "states");
    return mf_json_close(document, STATUS_OK);
}

enum status mf_live_view_show_file(struct live_view *view, const char *file) {
    char *text = NULL;
    size_t length;
    bool is_fit = false;
    TRY(mf_text_file_read(file, &text, &length));
    const enum status status = mf_live_view_is_fit(file, text, &is_fit);
    char *copy = status == STATUS_OK ? strdup(text) : NULL;
    mf_memory_free(text);
    TRY(status);
    pthread_mutex_lock(&view->lock);
    free(view->text);
    view->text = copy;
    view->is_fit = is_fit;
    view->phase = LIVE_READY;
    view->message[0] = view->folder[0] = '\0';
    snprintf(view->file, sizeof view->file, "%s", file);
    publish_state(view);
    pthread_mutex_unlock(&view->lock);
    mf_live_view_set_root(view, LIVE_RESULT, -1);
    return STATUS_OK;
}

enum status mf_live_view_show_folder(struct live_view *view, const char *folder,
                                     enum live_phase phase) {
    const int opened = open_folder(folder);
    if (opened < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    mf_live_view_set_root(view, LIVE_RESULT, opened);
    pthread_mutex_lock(&view->lock);
    if (phase == LIVE_LOOKING) {
        free(view->text);
        view->text = NULL;
        view->file[0] = '\0';
    }
    view->phase = phase;
    view->message[0] = '\0';
    snprintf(view->folder, sizeof view->folder, "%s", folder);
    publish_state(view);
    pthread_mutex_unlock(&view->lock);
    mf_live_view_write_tables(view);
    return STATUS_OK;
}

/// The tables of a simulation that runs, else those of the results.
void mf_live_view_write_tables(struct live_view *view) {
    pthread_mutex_lock(&view->lock);
    const enum live_root shown = view->root[LIVE_NOW] >= 0 ? LIVE_NOW : LIVE_RESULT;
    const int folder = view->root[shown] >= 0 ? dup(view->root[shown]) : -1;
    pthread_mutex_unlock(&view->lock);
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (stream) {
        fprintf(stream, "{\"in\": \"%s\", \"files\": ", roots[shown]);
        const enum status status =
            folder >= 0 ? mf_live_folder_list(folder, "", stream) : STATUS_IO;
        fprintf(stream, "%s}", status == STATUS_OK ? "" : "[]");
        if (fclose(stream) == 0)
            mf_live_feed_push(&view->feed, LIVE_TABLES, text);
    }
    free(text);
    if (folder >= 0)
        close(folder);
}

int mf_live_view_root(struct live_view *view, const char *name) {
    int folder = -1;
    pthread_mutex_lock(&view->lock);
    for (int root = 0; root < LIVE_ROOTS; root++)
        if (strcmp(name ? name : roots[LIVE_WORK], roots[root]) == 0 && view->root[root] >= 0)
            folder = fcntl(view->root[root], F_DUPFD_CLOEXEC, 0);
    pthread_mutex_unlock(&view->lock);
    if (folder < 0)
        mf_status_fail(STATUS_IO, "there is no folder \"%.40s\" now", name ? name : "work");
    return folder;
}

void mf_live_view_set_root(struct live_view *view, enum live_root root, int folder) {
    pthread_mutex_lock(&view->lock);
    const int old = view->root[root];
    view->root[root] = folder;
    pthread_mutex_unlock(&view->lock);
    if (old >= 0)
        close(old);
}

char *mf_live_view_text(struct live_view *view) {
    pthread_mutex_lock(&view->lock);
    char *text = view->text ? strdup(view->text) : NULL;
    pthread_mutex_unlock(&view->lock);
    return text;
}
