// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/film_frame.h"

#include "base/memory.h"
#include "base/status.h"
#include "io/input.h"
#include "io/json.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A snapshot that is open.
struct film_columns {
    const char *file; ///< borrowed
    char *text;       ///< of a VTP file
    struct json_document *document;
    double time, box[3];
    size_t count; ///< particles, of all kinds
};

enum { MOST_BYTES = 2147483647, NAME_SIZE = 96 };

static enum status fail(const struct film_columns *columns, const char *what) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: %s, so it is no whole snapshot of mesofit",
                          columns->file, what);
}

// VTP --------------------------------------------------------------------------------------------

static enum status read_text(struct film_columns *columns) {
    enum status status = STATUS_OK;
    FILE *stream;
    TRY(mf_input_open(&stream, columns->file));
    long size = fseek(stream, 0, SEEK_END) == 0 ? ftell(stream) : -1;
    if (size < 0 || size >= MOST_BYTES)
        status = fail(columns, "its size is not known or too large");
    else if ((columns->text = mf_memory_uncleared((size_t)size + 1, 1)) == NULL)
        status = STATUS_NO_MEMORY;
    else {
        rewind(stream);
        size = (long)fread(columns->text, 1, (size_t)size, stream);
        columns->text[size] = '\0';
    }
    fclose(stream);
    return status;
}

/// What stands in the array of this name, and how its element is described; NULL: there is none.
static const char *find_array(const struct film_columns *columns, const char *name,
                              char head[256]) {
    char wanted[NAME_SIZE];
    snprintf(wanted, sizeof wanted, " Name=\"%.64s\"", name);
    const char *at = strstr(columns->text, wanted);
    const char *end = at ? strchr(at, '>') : NULL, *begin = at;
    while (begin && begin > columns->text && *begin != '<')
        begin--;
    if (end == NULL || end - begin >= 256)
        return NULL;
    snprintf(head, 256, "%.*s", (int)(end - begin), begin);
    return end + 1;
}

static bool find_numbers(const struct film_columns *columns, const char *name, double *values,
                         int count) {
    char head[256];
    const char *at = find_array(columns, name, head);
    for (int k = 0; at && k < count; k++) {
        char *end;
        values[k] = strtod(at, &end);
        at = end == at ? NULL : end;
    }
    return at != NULL;
}

/// Value of a letter of base64, −1 of another.
static int value_of(unsigned char letter) {
    return letter >= 'A' && letter <= 'Z'   ? letter - 'A'
           : letter >= 'a' && letter <= 'z' ? letter - 'a' + 26
           : letter >= '0' && letter <= '9' ? letter - '0' + 52
           : letter == '+'                  ? 62
           : letter == '/'                  ? 63
                                            : -1;
}

/// The bytes of a text of base64, at most `max`; how many there are.
static size_t decode(const char *text, unsigned char *bytes, size_t max) {
    size_t count = 0;
    unsigned bits = 0;
    for (int held = 0, value; (value = value_of((unsigned char)*text)) >= 0; text++) {
        bits = bits << 6 | (unsigned)value;
        held += 6;
        if (held < 8)
            continue;
        held -= 8;
        if (count == max)
            return count + 1;
        bytes[count++] = (unsigned char)(bits >> held);
    }
    return count;
}

static size_t min(size_t a, size_t b) {
    return a < b ? a : b;
}

/// As doubles, `width` a particle of the `components` that the file has.
static void spread(const unsigned char *bytes, bool whole, size_t components, size_t count,
                   size_t width, double *values) {
    for (size_t k = 0; k < count; k++)
        for (size_t c = 0; c < min(width, components); c++) {
            const unsigned char *at = bytes + (k * components + c) * sizeof(double);
            int64_t integer;
            memcpy(&integer, at, sizeof integer);
            if (whole)
                values[k * width + c] = (double)integer;
            else
                memcpy(&values[k * width + c], at, sizeof(double));
        }
}

static enum status take_of_vtp(struct film_columns *columns, const char *name, size_t width,
                               double **values) {
    enum status status = STATUS_OK;
    char head[256];
    unsigned char *bytes = NULL;
    const char *text = find_array(columns, name, head);
    const char *width_text = text ? strstr(head, "NumberOfComponents=\"") : NULL;
    if (width_text == NULL)
        return STATUS_OK;
    const size_t components = strtoul(strchr(width_text, '"') + 1, NULL, 10);
    if (components < 1 || components > 64)
        return fail(columns, "an array is too wide");
    const size_t size = sizeof(uint64_t) + columns->count * components * sizeof(double);
    NEW_ARRAY(bytes, size);
    if (decode(text, bytes, size) != size)
        CHECK(fail(columns, "an array has another length than the particles"));
    NEW_ARRAY(*values, columns->count * width);
    spread(bytes + sizeof(uint64_t), strstr(head, "\"Int64\"") != NULL, components, columns->count,
           width, *values);
done:
    mf_memory_free(bytes);
    return status;
}

static enum status open_vtp(struct film_columns *columns) {
    TRY(read_text(columns));
    const char *points = strstr(columns->text, "NumberOfPoints=\"");
    if (points == NULL || strstr(columns->text, "</VTKFile>") == NULL ||
        strstr(columns->text, "header_type=\"UInt64\"") == NULL)
        return fail(columns, "parts of it are missing");
    columns->count = strtoul(strchr(points, '"') + 1, NULL, 10);
    if (columns->count > strlen(columns->text) ||
        !find_numbers(columns, "TimeValue", &columns->time, 1) ||
        !find_numbers(columns, "box", columns->box, 3))
        return fail(columns, "it lacks time or box");
    return STATUS_OK;
}

// JSON -------------------------------------------------------------------------------------------

static const char *const groups[] = {"particles", "solvent"};

static enum status open_json(struct film_columns *columns) {
    TRY(mf_json_open(&columns->document, columns->file));
    struct json_object root = mf_json_root(columns->document);
    mf_json_numbers(&root, "time", &columns->time, 1);
    if (mf_json_numbers(&root, "box", columns->box, 3) < 2)
        return fail(columns, "it lacks the box");
    for (int g = 0; g < 2; g++) {
        struct json_object group = mf_json_child(&root, groups[g], false);
        columns->count += group.item ? (size_t)mf_json_count(&group, "x") : 0;
    }
    return STATUS_OK;
}

/// Key of a component: "velocity_x", or "x" of positions, or the name itself of what has but one.
static void name_component(const char *name, size_t width, size_t component, char key[NAME_SIZE]) {
    const bool position = strcmp(name, "position") == 0;
    if (position)
        snprintf(key, NAME_SIZE, "%c", "xyz"[component]);
    else if (width > 1)
        snprintf(key, NAME_SIZE, "%.64s_%c", name, "xyz"[component]);
    else
        snprintf(key, NAME_SIZE, "%.64s", name);
}

/// Types are texts: they get numbers as they come.
static enum status take_types(struct json_object *group, size_t count, double *to) {
    enum { MOST_TYPES = 64 };
    enum status status = STATUS_OK;
    const char *known[MOST_TYPES], **texts = NULL;
    int types = 0;
    NEW_ARRAY(texts, count);
    if (mf_json_list_texts(group, "type", texts, count))
        for (size_t k = 0; k < count; k++) {
            int type = 0;
            while (type < types && strcmp(known[type], texts[k]) != 0)
                type++;
            if (type == types && types < MOST_TYPES)
                known[types++] = texts[k];
            to[k] = type;
        }
done:
    mf_memory_free(texts);
    return status;
}

static enum status take_component(struct json_object *group, const char *key, size_t count,
                                  size_t width, double *to) {
    enum status status = STATUS_OK;
    double *list = NULL;
    NEW_ARRAY(list, count);
    if (mf_json_list_numbers(group, key, list, count))
        for (size_t k = 0; k < count; k++)
            to[k * width] = list[k];
done:
    mf_memory_free(list);
    return status;
}

static enum status take_of_json(struct film_columns *columns, const char *name, size_t width,
                                double **values) {
    enum status status = STATUS_OK;
    struct json_object root = mf_json_root(columns->document);
    size_t begin = 0, highest = 0;
    for (int g = 0; g < 2; g++) {
        struct json_object group = mf_json_child(&root, groups[g], false);
        const size_t count = group.item ? (size_t)mf_json_count(&group, "x") : 0;
        for (size_t c = 0; c < width && count > 0; c++) {
            char key[NAME_SIZE];
            name_component(name, width, c, key);
            if (!mf_json_has(&group, key))
                continue;
            if (*values == NULL)
                NEW_ARRAY(*values, columns->count * width);
            double *to = *values + begin * width + c;
            CHECK(strcmp(name, "type") == 0 ? take_types(&group, count, to)
                                            : take_component(&group, key, count, width, to));
        }
        // The solvent is a type of its own.
        for (size_t k = begin; strcmp(name, "type") == 0 && *values && k < begin + count; k++) {
            (*values)[k] += g == 1 ? (double)(highest + (begin > 0)) : 0;
            highest = g == 0 && (size_t)(*values)[k] > highest ? (size_t)(*values)[k] : highest;
        }
        begin += count;
    }
done:
    return status;
}

// Both -------------------------------------------------------------------------------------------

/// `status` is what became of reading it: returned, unless the file turns out to have faults.
static enum status close_columns(struct film_columns *columns, enum status status) {
    mf_memory_free(columns->text);
    if (columns->document)
        status = mf_json_close(columns->document, status);
    *columns = (struct film_columns){0};
    return status;
}

static enum status open_columns(struct film_columns *columns, const char *file) {
    const size_t length = strlen(file);
    *columns = (struct film_columns){.file = file};
    const bool json = length > 5 && strcmp(file + length - 5, ".json") == 0;
    const enum status status = json ? open_json(columns) : open_vtp(columns);
    return status == STATUS_OK ? status : close_columns(columns, status);
}

/// The numbers of this name, `width` a particle, as a new array to be freed, shape [count, width];
/// what the file has not is 0. *values is NULL if no particle has them.
static enum status take_columns(struct film_columns *columns, const char *name, size_t width,
                                double **values) {
    *values = NULL;
    if (columns->count == 0)
        return fail(columns, "it has no particles");
    return columns->document ? take_of_json(columns, name, width, values)
                             : take_of_vtp(columns, name, width, values);
}

static enum status take_speeds(struct film_columns *columns, double **speed) {
    enum status status = STATUS_OK;
    double *velocity = NULL;
    CHECK(take_columns(columns, "velocity", 3, &velocity));
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
                                     : take_columns(columns, colour, 1, values));
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
    CHECK(take_columns(columns, "position", 3, &frame->position));
    CHECK(take_columns(columns, "type", 1, &frame->type));
    CHECK(take_columns(columns, "radius", 1, &frame->radius));
    CHECK(take_columns(columns, "orientation", 1, &turn));
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
    TRY(open_columns(&columns, file));
    const enum status status = close_columns(&columns, read(frame, &columns, colour));
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
