// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_routes.h"

#include "io/json.h"
#include "live/live_assets.h"
#include "live/live_folder.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OK = 200, BAD_REQUEST = 400, NOT_FOUND = 404, NO_METHOD = 405, FAILED = 500 };

/// Seconds until a stream without news says that it is there.
static const double heartbeat = 5;

static const char json_type[] = "application/json";

enum status mf_live_routes_give(struct live_answer *answer, const char *type, char *bytes) {
    if (bytes == NULL)
        return mf_status_fail(STATUS_IO, "there is nothing yet");
    answer->type = type;
    answer->bytes = bytes;
    answer->size = strlen(bytes);
    return STATUS_OK;
}

/// Whether an argument is 1.
static bool has(const struct live_request *request, const char *name) {
    const char *value = mf_live_server_argument(request, name);
    return value && strcmp(value, "1") == 0;
}

// What is published -------------------------------------------------------------------------------

static enum status give_state(struct live_view *view, const struct live_request *request,
                              struct live_answer *answer) {
    (void)request;
    return mf_live_routes_give(answer, json_type, mf_live_feed_get(&view->feed, LIVE_STATE));
}

static enum status give_text(struct live_view *view, const struct live_request *request,
                             struct live_answer *answer) {
    (void)request;
    return mf_live_routes_give(answer, json_type, mf_live_view_text(view));
}

static enum status give_topics(struct live_view *view, const struct live_request *request,
                               struct live_answer *answer) {
    (void)request;
    answer->type = json_type;
    answer->constant = view->topics;
    answer->size = strlen(view->topics);
    return STATUS_OK;
}

/// An open stream and what it has sent.
struct listening {
    struct live_feed *feed;
    uint64_t seen;
};

static char *next_events(void *context) {
    struct listening *listening = context;
    return mf_live_feed_wait(listening->feed, &listening->seen, heartbeat);
}

static void end_events(void *context) {
    struct listening *listening = context;
    mf_live_feed_count_stream(listening->feed, -1);
    free(listening);
}

static enum status give_events(struct live_view *view, const struct live_request *request,
                               struct live_answer *answer) {
    struct listening *listening = calloc(1, sizeof *listening);
    (void)request;
    if (listening == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    listening->feed = &view->feed;
    mf_live_feed_count_stream(&view->feed, 1);
    answer->type = "text/event-stream";
    answer->stream.context = listening;
    answer->stream.next = next_events;
    answer->stream.close = end_events;
    return STATUS_OK;
}

static enum status give_particles(struct live_view *view, const struct live_request *request,
                                  struct live_answer *answer) {
    const char *after = mf_live_server_argument(request, "after");
    const struct live_bytes bytes = mf_live_feed_get_particles(
        &view->feed, after ? strtoull(after, NULL, 10) : 0, has(request, "energies"));
    answer->type = "application/octet-stream";
    answer->bytes = bytes.bytes;
    answer->size = bytes.size;
    answer->serial = bytes.serial;
    return STATUS_OK;
}

// What is wished ----------------------------------------------------------------------------------

static enum status check_idle(struct live_view *view) {
    return mf_live_view_is_busy(view)
               ? mf_status_fail(STATUS_BAD_INPUT, "a run is going on: stop it first")
               : STATUS_OK;
}

static enum status open_path(struct live_view *view, const struct live_request *request,
                             struct live_answer *answer) {
    const char *path = mf_live_server_argument(request, "path");
    size_t size;
    TRY(check_idle(view));
    const int root = mf_live_view_root(view, NULL);
    if (root < 0 || path == NULL || path[0] == '\0')
        return mf_status_fail(STATUS_BAD_INPUT, "open takes the path of a file or folder");
    const int folder = mf_live_folder_enter(root, path);
    const int file = folder < 0 ? mf_live_folder_read(root, path, &size) : -1;
    close(root);
    if (folder < 0 && file < 0)
        return STATUS_BAD_INPUT;
    close(folder < 0 ? file : folder);
    TRY(folder < 0 ? mf_live_view_show_file(view, path)
                   : mf_live_view_show_folder(view, path, LIVE_LOOKING));
    return give_state(view, request, answer);
}

/// The folder that a page wishes its results in; without one they are beside the file.
static enum status check_folder(struct live_view *view, const char *folder) {
    if (folder == NULL || folder[0] == '\0')
        return STATUS_OK;
    const int root = mf_live_view_root(view, NULL);
    if (root < 0)
        return STATUS_IO;
    const enum status status = mf_live_folder_check_new(root, folder);
    close(root);
    return status;
}

/// The body is the text to be run in the place of the file that is shown; without a body that is.
static enum status start(struct live_view *view, const struct live_request *request,
                         struct live_answer *answer) {
    const char *folder = mf_live_server_argument(request, "folder");
    struct live_order order = {.resume = has(request, "resume"), .force = has(request, "force")};
    TRY(check_idle(view));
    TRY(check_folder(view, folder));
    if (strlen(request->body) != request->size)
        return mf_status_fail(STATUS_BAD_INPUT, "the settings have a NUL byte");
    if (folder)
        snprintf(order.folder, sizeof order.folder, "%s", folder);
    pthread_mutex_lock(&view->lock);
    snprintf(order.file, sizeof order.file, "%s", view->file);
    pthread_mutex_unlock(&view->lock);
    order.text = request->size > 0 ? strdup(request->body) : mf_live_view_text(view);
    if (order.file[0] == '\0' || order.text == NULL) {
        free(order.text);
        return mf_status_fail(STATUS_BAD_INPUT, "choose a scene or a run file first");
    }
    const enum status status = mf_live_view_order(view, &order);
    free(order.text);
    TRY(status);
    return give_state(view, request, answer);
}

enum wish { PAUSE, GO, STEP, STOP, SPEED, CHANGE };
static const char *const wishes[] = {"pause", "go", "step", "stop", "speed", "change", NULL};

struct wished {
    int wish;
    int64_t steps;
    double speed;
    struct live_change change;
};

#define MEMBER(name) .offset = offsetof(struct wished, name)
static const struct field request_fields[] = {
    {"wish", FIELD_CHOICE, MEMBER(wish), .required = true, .choices = wishes, .unit = "",
     .help = "what the run is to do"},
    {"steps", FIELD_INTEGER, MEMBER(steps), .initial = 1, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "of \"step\""},
    {"speed", FIELD_NUMBER, MEMBER(speed), .initial = 0, .minimum = 0, .maximum = 1e9,
     .unit = "steps/s", .help = "of \"speed\": at most so many; 0: any"},
    {"temperature", FIELD_NUMBER, MEMBER(change.temperature), .initial = NAN,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "",
     .help = "of \"change\", in the unit of the scene; without it: as it is"},
    {"time_step", FIELD_NUMBER, MEMBER(change.time_step), .initial = NAN,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "",
     .help = "of \"change\", likewise"},
    {"damping", FIELD_NUMBER, MEMBER(change.damping), .initial = NAN, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "", .help = "of \"change\": part of its steps that a fit takes"},
    FIELD_END,
};

static enum status read_wish(const struct live_request *request, struct wished *wished) {
    struct json_document *document;
    if (strlen(request->body) != request->size)
        return mf_status_fail(STATUS_BAD_INPUT, "the request has a NUL byte");
    TRY(mf_json_open_text(&document, "the wish", request->body));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, request_fields, wished);
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

static enum status check_change(struct live_view *view, const struct live_change *change) {
    pthread_mutex_lock(&view->lock);
    const bool is_fit = view->is_fit;
    pthread_mutex_unlock(&view->lock);
    const bool simulates = !isnan(change->temperature) || !isnan(change->time_step);
    const bool fits = !isnan(change->damping);
    if (is_fit ? simulates || !fits : fits || !simulates)
        return mf_status_fail(STATUS_BAD_INPUT,
                              is_fit ? "change takes a damping; a fit keeps its other settings"
                                     : "change takes a temperature, a time step or both");
    return STATUS_OK;
}

static enum status wish(struct live_view *view, const struct live_request *request,
                        struct live_answer *answer) {
    struct live_control *control = &view->control;
    struct wished wished = {0};
    TRY(read_wish(request, &wished));
    if (wished.wish == CHANGE)
        TRY(check_change(view, &wished.change));
    if (!mf_live_view_is_busy(view) && wished.wish != SPEED)
        return mf_status_fail(STATUS_BAD_INPUT, "no run is going on");
    if (wished.wish == STOP)
        mf_live_control_stop(control);
    else if (wished.wish == STEP)
        mf_live_control_step(control, wished.steps);
    else if (wished.wish == SPEED)
        mf_live_control_speed(control, wished.speed);
    else if (wished.wish == CHANGE)
        mf_live_control_change(control, &wished.change);
    else
        mf_live_control_pause(control, wished.wish == PAUSE);
    return give_state(view, request, answer);
}

// The table ---------------------------------------------------------------------------------------

static const struct live_route routes[] = {
    {"/api/state", false, give_state},
    {"/api/events", false, give_events},
    {"/api/text", false, give_text},
    {"/api/topics", false, give_topics},
    {"/api/particles", false, give_particles},
    {"/api/open", true, open_path},
    {"/api/start", true, start},
    {"/api/wish", true, wish},
    {NULL, false, NULL},
};

static const struct live_route *find(const struct live_route *route,
                                     const struct live_request *request, bool *known) {
    for (; route->path; route++) {
        if (strcmp(route->path, request->path) != 0)
            continue;
        *known = true;
        if (route->post == request->post)
            return route;
    }
    return NULL;
}

static void refuse(struct live_answer *answer, unsigned code, const char *why) {
    answer->code = code;
    answer->bytes = strdup(why);
    answer->size = answer->bytes ? strlen(why) : 0;
}

static bool is_open(void *context, const struct live_request *request) {
    (void)context;
    return !request->post && mf_live_assets_find(request->path) != NULL;
}

static void answer_any(void *context, const struct live_request *request,
                       struct live_answer *answer) {
    const struct live_asset *asset = request->post ? NULL : mf_live_assets_find(request->path);
    bool known = false;
    if (asset) {
        answer->type = asset->type;
        answer->constant = asset->bytes;
        answer->size = (size_t)(asset->end - asset->bytes);
        return;
    }
    const struct live_route *route = find(routes, request, &known);
    if (route == NULL)
        route = find(mf_live_routes_files, request, &known);
    if (route == NULL) {
        refuse(answer, known ? NO_METHOD : NOT_FOUND, known ? "Wrong method." : "No such page.");
        return;
    }
    const enum status status = route->answer(context, request, answer);
    if (status != STATUS_OK)
        refuse(answer,
               status == STATUS_BAD_INPUT ? BAD_REQUEST
               : status == STATUS_IO      ? NOT_FOUND
                                          : FAILED,
               mf_status_message());
}

struct live_answerer mf_live_routes(struct live_view *view) {
    return (struct live_answerer){view, is_open, answer_any};
}
