// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"
#include "io/output.h"
#include "report/film.h"

#include <math.h>
#include <stdlib.h>

enum { COLOUR, HIDE, FRAMES };

static const struct command_option options[] = {
    [COLOUR] = {"--colour", "NAME", "type, speed, orientation, stiffness, …"},
    [HIDE] = {"--hide", "A,..", "leave out these types"},
    [FRAMES] = {"--frames", "N", "at most (300)"},
    {NULL, NULL, NULL},
};

enum { USUAL_FRAMES = 300, MOST_FRAMES = 10000 };

static enum status read_frames(const char *text, int *frames) {
    char *end;
    const double value = text ? strtod(text, &end) : USUAL_FRAMES;
    *frames = (int)fmin(value, MOST_FRAMES);
    if (text == NULL || (*end == '\0' && end != text && value >= 1 && value <= MOST_FRAMES))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "--frames: expected a number from 1 to %d, not \"%s\"",
                          MOST_FRAMES, text);
}

static enum status run(const struct command_line *line) {
    char made[OUTPUT_PATH_SIZE];
    int frames;
    TRY(read_frames(line->own[FRAMES], &frames));
    const struct film_options chosen = {
        .colour = line->own[COLOUR],
        .hide = line->own[HIDE],
        .frames = frames,
        .quiet = line->options.quiet,
        .force = line->options.force,
    };
    TRY(mf_film_make(line->files[0], &chosen, made));
    if (!line->options.quiet)
        printf("%s\n", made);
    return STATUS_OK;
}

const struct command cmd_film = {
    .name = "film",
    .usage = "DIR",
    .summary = "film a simulation's snapshots",
    .min_files = 1,
    .max_files = 1,
    .options = options,
    .run = run,
};
