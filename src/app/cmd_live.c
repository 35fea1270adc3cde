// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/cmd_live.h"

#include "app/live_topics.h"
#include "live/live_session.h"

#include <stdlib.h>
#include <string.h>

enum { START, STAY, PORT };

static const struct command_option options[] = {
    [START] = {"--start", NULL, "start at once, not from the page"},
    [STAY] = {"--stay", NULL, "keep serving after the run"},
    [PORT] = {"--port", "N", "port of 127.0.0.1; else any free one"},
    {NULL, NULL, NULL},
};

static enum status parse_port(const char *text, int *port) {
    char *end;
    const long number = strtol(text, &end, 10);
    if (end == text || *end != '\0' || number < 1 || number > 65535)
        return mf_status_fail(STATUS_BAD_INPUT, "a port is a whole number from 1 to 65535");
    *port = (int)number;
    return STATUS_OK;
}

static enum status serve(struct live_options *live) {
    char *topics = mf_live_topics();
    if (topics == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    live->topics = topics;
    const enum status status = mf_live_session(live);
    free(topics);
    return status;
}

static const struct command_option live_option = COMMAND_LIVE_OPTION;

enum status mf_cmd_live_run(const char *file, const struct run_options *run_options,
                            const char *port) {
    struct live_options live = {.subject = file, .run = *run_options, .start = true};
    if (strcmp(port, live_option.name) != 0)
        TRY(parse_port(port, &live.port));
    return serve(&live);
}

static enum status run(const struct command_line *line) {
    struct live_options live = {.subject = line->file_count > 0 ? line->files[0] : NULL,
                                .run = line->options,
                                .start = line->own[START] != NULL,
                                .stay = line->own[STAY] != NULL};
    if (line->own[PORT])
        TRY(parse_port(line->own[PORT], &live.port));
    if (live.start && live.subject == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--start takes a scene or a run file to begin with");
    return serve(&live);
}

const struct command cmd_live = {
    .name = "live",
    .usage = "[FILE]",
    .summary = "show and run files and results in a browser",
    .min_files = 0,
    .max_files = 1,
    .options = options,
    .run = run,
};
