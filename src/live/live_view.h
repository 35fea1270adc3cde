// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the page shows: a file or a folder of results, and what is being done with it.
///
/// The work and the server's threads share it.
#pragma once

#include "io/output.h"
#include "live/live_feed.h"

struct json_writer;

enum live_phase {
    LIVE_CHOOSING, ///< nothing is shown
    LIVE_LOOKING,  ///< at a folder of results
    LIVE_READY,    ///< to begin with a file
    LIVE_RUNNING,
    LIVE_PAUSED,
    LIVE_STOPPED, ///< by the page; it can go on
    LIVE_ENDED,
    LIVE_REFUSED ///< with a message
};

/// The folders that the page sees into.
enum live_root {
    LIVE_WORK,   ///< where the program was started
    LIVE_RESULT, ///< of the run that is shown
    LIVE_NOW,    ///< tables of a simulation as they are while it runs
    LIVE_ROOTS
};

struct live_view {
    struct live_feed feed;
    struct live_control control;
    const char *topics; ///< JSON: what `mesofit describe` knows; borrowed
    bool stays;         ///< after the end of a run

    pthread_mutex_t lock; ///< of all that follows
    int root[LIVE_ROOTS]; ///< open folders, or −1
    enum live_phase phase;
    bool is_fit;
    char file[OUTPUT_PATH_SIZE], folder[OUTPUT_PATH_SIZE];
    char *text;         ///< of the file, or NULL
    char message[2048]; ///< of the last run's end
};

/// Fails: IO if the working folder cannot be opened; NO_MEMORY.
enum status mf_live_view_init(struct live_view *view, const char *topics, bool stays) MUST_USE;
void mf_live_view_clear(struct live_view *view);

/// Show a scene or run file, ready to begin. Fails: BAD_INPUT if it is no JSON; IO.
enum status mf_live_view_show_file(struct live_view *view, const char *file) MUST_USE;

/// Show a folder of results, also that which a run has just begun to write. Fails: IO.
enum status mf_live_view_show_folder(struct live_view *view, const char *folder,
                                     enum live_phase phase) MUST_USE;

/// Publish a new phase, with a message or NULL.
void mf_live_view_set_phase(struct live_view *view, enum live_phase phase, const char *message);

/// Whether a run is going on, or about to.
bool mf_live_view_is_busy(struct live_view *view);

/// Ask for a run. From here on it is going on, and hears what is wished of it.
/// @param[in,out] order  its text is taken over
/// Fails: BAD_INPUT if one is.
enum status mf_live_view_order(struct live_view *view, struct live_order *order) MUST_USE;

/// Publish what a writer has, which is freed; without memory nothing is.
void mf_live_view_publish(struct live_view *view, enum live_slot slot, struct json_writer *writer);

/// Publish which tables there are.
void mf_live_view_write_tables(struct live_view *view);

/// One of the folders under a number of its own, to be closed; −1 with a message if there is none.
/// @param[in] name  "work", "result" or "now"; NULL is "work"
int mf_live_view_root(struct live_view *view, const char *name);

/// Put an open folder, or −1, in the place of one of them.
void mf_live_view_set_root(struct live_view *view, enum live_root root, int folder);

/// A copy of the text that is shown, to be freed with free(); NULL if there is none.
char *mf_live_view_text(struct live_view *view);

/// Whether a text in the place of a file is of a fit: it has a target. Fails: BAD_INPUT if it is no
/// JSON.
enum status mf_live_view_is_fit(const char *file, const char *text, bool *is_fit) MUST_USE;
