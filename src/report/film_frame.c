// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/film_frame.h"

#include "base/memory.h"
#include "report/film_columns.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static enum status take_speeds(struct film_columns *columns, double **speed) {
    enum status status = STATUS_OK;
    double *velocity = NULL;
    CHECK(mf_film_columns_take(columns, "velocity", 3, &velocity));
    if (velocity == NULL)
        goto done;
    NEW_ARRAY(*speed, columns->count);
    for (size_t k = 0; k < columns->count; k++) {
        const double *v = velocity + 3 * k;
        (*speed)[k] = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
done:
    mf_memory_free(velocity);
    return status;
}

static enum status take_colour(struct film_columns *columns, const char *colour, double **values) {
    TRY(strcmp(colour, "speed") == 0 ? take_speeds(columns, values)
                                     : mf_film_columns_take(columns, colour, 1, values));
    if (*values)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: its particles have no \"%s\"; --colour takes type, speed, or what "
                          "they have, as orientation, stiffness, mass",
                          columns->file, colour);
}

static enum status read(struct film_frame *frame, struct film_columns *columns,
                        const char *colour) {
    enum status status = STATUS_OK;
    double *turn = NULL;
    frame->time = columns->time;
    memcpy(frame->box, columns->box, sizeof frame->box);
    frame->count = columns->count;
    CHECK(mf_film_columns_take(columns, "position", 3, &frame->position));
    CHECK(mf_film_columns_take(columns, "type", 1, &frame->type));
    CHECK(mf_film_columns_take(columns, "radius", 1, &frame->radius));
    CHECK(mf_film_columns_take(columns, "orientation", 1, &turn));
    if (colour)
        CHECK(take_colour(columns, colour, &frame->colour));
    if (frame->position == NULL || frame->type == NULL)
        CHECK(mf_status_fail(STATUS_BAD_INPUT, "%s: no positions or no types", columns->file));
    frame->oriented = turn != NULL;
    for (size_t k = 0; k < frame->count; k++) {
        if (!(frame->type[k] >= 0 && frame->type[k] <= INT_MAX - 1))
            CHECK(mf_status_fail(STATUS_BAD_INPUT, "%s: a type has no number", columns->file));
        frame->mixed |= frame->type[k] != frame->type[0];
    }
done:
    mf_memory_free(turn);
    return status;
}

enum status mf_film_frame_read(struct film_frame *frame, const char *file, const char *colour) {
    struct film_columns columns;
    *frame = (struct film_frame){0};
    TRY(mf_film_columns_open(&columns, file));
    const enum status status = mf_film_columns_close(&columns, read(frame, &columns, colour));
    if (status != STATUS_OK)
        mf_film_frame_clear(frame);
    return status;
}

void mf_film_frame_clear(struct film_frame *frame) {
    mf_memory_free(frame->position);
    mf_memory_free(frame->type);
    mf_memory_free(frame->radius);
    mf_memory_free(frame->colour);
    *frame = (struct film_frame){0};
}
