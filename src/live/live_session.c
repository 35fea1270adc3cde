// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_session.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/memory.h"
#include "io/text_file.h"
#include "live/live_routes.h"
#include "live/live_watch.h"
#include "work/fit.h"
#include "work/simulate.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/// A page that is open gets so long to fetch the last tables, and its stream to end [s].
static const double last_visit_wait = 3, end_of_stream = 1;

struct session {
    const struct live_options *options;
    char token[LIVE_TOKEN_SIZE];
    struct live_view view;
    struct live_watch watch;
    struct live_server server;
};

static bool is_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/// The file's own text stands for it, or what the page has made of it.
static enum status run(struct session *session, const struct live_order *order) {
    const struct memory_file memory_files = {.name = order->file, .text = order->text};
    struct run_options options = session->options->run;
    bool is_fit;
    TRY(mf_live_view_is_fit(order->file, order->text, &is_fit));
    options.watcher = &session->watch.watcher;
    options.resume = options.resume || order->resume;
    options.force = (options.force || order->force) && !options.resume;
    if (order->folder[0])
        options.folder = order->folder;
    mf_text_file_set_memory_files(&memory_files, 1);
    const enum status status =
        is_fit ? mf_fit_run(order->file, &options) : mf_simulate_file(order->file, &options);
    mf_text_file_set_memory_files(NULL, 0);
    return status;
}

/// Run an order, and tell the page how it ended; from then on another one may come.
/// @param[out] stopped  from the page
static enum status carry_out(struct session *session, struct live_order *order, bool *stopped) {
    struct live_view *view = &session->view;
    const enum status status = run(session, order);
    free(order->text);
    *stopped = status == STATUS_INTERRUPTED && mf_live_control_stopped(&view->control);
    const bool ran = session->watch.run.folder != NULL;
    const char *message = status == STATUS_OK ? "" : mf_status_message();
    mf_live_watch_end(&session->watch);
    mf_live_view_write_tables(view);
    mf_live_control_reset(&view->control);
    mf_live_view_set_phase(view,
                           *stopped ? LIVE_STOPPED
                           : ran    ? LIVE_ENDED
                                    : LIVE_REFUSED,
                           message);
    return status;
}

static void wait_for_pages(struct session *session, double seconds) {
    const double until = clock_seconds() + seconds;
    while (mf_live_feed_streams(&session->view.feed) > 0 && clock_seconds() < until)
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}

/// What a run without a page says at its end, for the terminal: the program goes on.
static void report_end(enum status status) {
    if (status != STATUS_OK)
        fprintf(stderr, "mesofit: %s\n", mf_status_message());
}

/// Take orders until it is time to end.
static enum status serve(struct session *session) {
    struct live_control *control = &session->view.control;
    struct live_order order;
    for (;;) {
        if (!mf_live_control_take(control, &order)) {
            if (mf_interrupt_requested())
                return STATUS_OK;
            continue;
        }
        bool stopped;
        const enum status status = carry_out(session, &order, &stopped);
        if (mf_interrupt_requested())
            return status;
        const bool refused = status == STATUS_BAD_INPUT || status == STATUS_IO;
        if (session->view.stays || stopped || (refused && !session->options->start)) {
            report_end(status);
            continue;
        }
        wait_for_pages(session, last_visit_wait);
        return status;
    }
}

/// What the command line names is shown, and perhaps begun.
static enum status show_subject(struct session *session) {
    const struct live_options *options = session->options;
    struct live_order order = {0};
    if (options->subject == NULL)
        return STATUS_OK;
    if (is_folder(options->subject))
        return options->start
                   ? mf_status_fail(STATUS_BAD_INPUT, "%s is a folder: there is nothing to start",
                                    options->subject)
                   : mf_live_view_show_folder(&session->view, options->subject, LIVE_LOOKING);
    TRY(mf_live_view_show_file(&session->view, options->subject));
    if (!options->start)
        return STATUS_OK;
    snprintf(order.file, sizeof order.file, "%s", options->subject);
    order.text = mf_live_view_text(&session->view);
    return order.text ? mf_live_view_order(&session->view, &order) : STATUS_NO_MEMORY;
}

static enum status begin(struct session *session) {
    TRY(mf_live_guard_make_token(session->token));
    TRY(show_subject(session));
    session->server =
        (struct live_server){.token = session->token, .answerer = mf_live_routes(&session->view)};
    TRY(mf_live_server_start(&session->server, session->options->port));
    printf("live at http://127.0.0.1:%d/?token=%s\n", session->server.port, session->token);
    return fflush(stdout) == 0
               ? STATUS_OK
               : mf_status_fail(STATUS_IO,
                                "cannot write the address of the live view to stdout: %s",
                                strerror(errno));
}

enum status mf_live_session(const struct live_options *options) {
    const bool is_file = options->subject && !is_folder(options->subject);
    enum status status = STATUS_OK;
    struct session *session = NULL;
    NEW_ARRAY(session, 1);
    session->options = options;
    CHECK(mf_live_view_init(&session->view, options->topics, options->stay || !is_file));
    mf_live_watch_init(&session->watch, &session->view);
    status = begin(session);
    if (status == STATUS_OK)
        status = serve(session);
    mf_live_feed_close(&session->view.feed);
    wait_for_pages(session, end_of_stream);
    mf_live_server_stop(&session->server);
    mf_live_watch_clear(&session->watch);
    mf_live_view_clear(&session->view);
done:
    mf_memory_free(session);
    return status;
}
