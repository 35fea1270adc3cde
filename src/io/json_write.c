// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_write.h"

#include "base/memory.h"
#include "io/json.h"
#include "io/output.h"

#include <cJSON.h>

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DEEPEST_OBJECT = 16 };

struct json_writer {
    cJSON *object[DEEPEST_OBJECT]; ///< the root and the objects entered; NULL where that failed
    int depth;
    struct units units; ///< of the numbers that it writes
    char problem[256];  ///< the first one; "" while all is well
};

static struct json_writer *create(cJSON *root) {
    struct json_writer *writer = mf_memory_zeroed(1, sizeof *writer);
    if (writer && root) {
        writer->object[0] = root;
        return writer;
    }
    cJSON_Delete(root);
    mf_memory_free(writer);
    mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    return NULL;
}

struct json_writer *mf_json_writer_create(void) {
    return create(cJSON_CreateObject());
}

struct json_writer *mf_json_writer_create_list(void) {
    return create(cJSON_CreateArray());
}

void mf_json_writer_free(struct json_writer *writer) {
    if (writer)
        cJSON_Delete(writer->object[0]);
    mf_memory_free(writer);
}

static void note_problem(struct json_writer *writer, const char *key, const char *problem) {
    if (writer->problem[0] == '\0')
        snprintf(writer->problem, sizeof writer->problem, "\"%s\" %s", key, problem);
}

/// Put `item`, which may be NULL for want of memory, into the current object.
static void append(struct json_writer *writer, const char *key, cJSON *item) {
    cJSON *object = writer->object[writer->depth];
    if (cJSON_GetObjectItemCaseSensitive(object, key))
        note_problem(writer, key, "is given twice");
    else if (item == NULL || object == NULL)
        note_problem(writer, key, "does not fit into the memory");
    else if (cJSON_AddItemToObject(object, key, item))
        return;
    else
        note_problem(writer, key, "does not fit into the memory");
    cJSON_Delete(item);
}

/// Put a new last object into the list.
static void begin_in_list(struct json_writer *writer) {
    cJSON *list = writer->object[writer->depth];
    if (!cJSON_IsArray(list) || writer->depth + 1 == DEEPEST_OBJECT) {
        note_problem(writer, "", "is an object without a key");
        return;
    }
    cJSON *item = cJSON_CreateObject();
    if (!cJSON_AddItemToArray(list, item))
        note_problem(writer, "", "does not fit into the memory");
    writer->object[++writer->depth] = item;
}

/// Enter `item`, new at a key.
static void enter(struct json_writer *writer, const char *key, cJSON *item) {
    if (writer->depth + 1 == DEEPEST_OBJECT) {
        note_problem(writer, key, "is nested too deeply");
        cJSON_Delete(item);
        return;
    }
    append(writer, key, item);
    cJSON *object = cJSON_GetObjectItemCaseSensitive(writer->object[writer->depth], key);
    writer->object[++writer->depth] = object;
}

void mf_json_begin(struct json_writer *writer, const char *key) {
    if (key == NULL)
        begin_in_list(writer);
    else
        enter(writer, key, cJSON_CreateObject());
}

void mf_json_begin_list(struct json_writer *writer, const char *key) {
    enter(writer, key, cJSON_CreateArray());
}

void mf_json_end(struct json_writer *writer) {
    if (writer->depth > 0)
        writer->depth--;
}

/// cJSON's own numbers are close to the value, not equal. JSON has no NaN and no infinity: what is
/// not known is null, and the rest of the file is worth having.
static cJSON *create_number(double value) {
    char text[32];
    if (!isfinite(value))
        return cJSON_CreateNull();
    snprintf(text, sizeof text, "%.15g", value);
    if (strtod(text, NULL) != value)
        snprintf(text, sizeof text, "%.17g", value);
    return cJSON_CreateRaw(text);
}

void mf_json_write_number(struct json_writer *writer, const char *key, double value) {
    append(writer, key, create_number(value));
}

void mf_json_writer_set_units(struct json_writer *writer, const struct units *units) {
    writer->units = *units;
}

void mf_json_write_quantity(struct json_writer *writer, const char *key, const char *unit,
                            double value) {
    mf_json_write_number(writer, key,
                         mf_units_file_value(value, mf_units_factor(&writer->units, unit)));
}

void mf_json_put_measured(struct json_writer *writer, const char *key, const char *unit,
                          double value, double error) {
    char name[128];
    snprintf(name, sizeof name, "%s_error", key);
    mf_json_write_quantity(writer, key, unit, value);
    mf_json_write_quantity(writer, name, unit, error);
}

void mf_json_write_integer(struct json_writer *writer, const char *key, int64_t value) {
    char text[32];
    snprintf(text, sizeof text, "%" PRId64, value);
    append(writer, key, cJSON_CreateRaw(text));
}

void mf_json_write_flag(struct json_writer *writer, const char *key, bool value) {
    append(writer, key, cJSON_CreateBool(value));
}

static void write_seed(struct json_writer *writer, const char *key, uint64_t value) {
    char text[32];
    snprintf(text, sizeof text, "%" PRIu64, value);
    append(writer, key, cJSON_CreateRaw(text));
}

void mf_json_write_text(struct json_writer *writer, const char *key, const char *value) {
    append(writer, key, cJSON_CreateString(value));
}

void mf_json_write_quantities(struct json_writer *writer, const char *key, const char *unit,
                              const double *values, size_t count) {
    const double factor = mf_units_factor(&writer->units, unit);
    cJSON *array = cJSON_CreateArray();
    for (size_t k = 0; array && k < count; k++) {
        cJSON *item = create_number(mf_units_file_value(values[k], factor));
        if (!cJSON_AddItemToArray(array, item))
            note_problem(writer, key, "does not fit into the memory");
    }
    append(writer, key, array);
}

void mf_json_write_texts(struct json_writer *writer, const char *key, const char *const *texts,
                         size_t count) {
    cJSON *array = cJSON_CreateArray();
    for (size_t k = 0; array && k < count; k++)
        if (!cJSON_AddItemToArray(array, cJSON_CreateString(texts[k])))
            note_problem(writer, key, "does not fit into the memory");
    append(writer, key, array);
}

void mf_json_write_rows(struct json_writer *writer, const char *key, const int *values, size_t rows,
                        size_t width) {
    cJSON *array = cJSON_CreateArray();
    for (size_t k = 0; array && k < rows; k++)
        if (!cJSON_AddItemToArray(array, cJSON_CreateIntArray(values + k * width, (int)width)))
            note_problem(writer, key, "does not fit into the memory");
    append(writer, key, array);
}

static void write_file(struct json_writer *writer, const char *key, const char *file) {
    char folder[OUTPUT_PATH_SIZE], path[OUTPUT_PATH_SIZE + FIELD_TEXT_SIZE];
    if (file[0] == '/') {
        mf_json_write_text(writer, key, file);
        return;
    }
    if (getcwd(folder, sizeof folder) == NULL)
        note_problem(writer, key, "lies in a folder without a name");
    else {
        snprintf(path, sizeof path, "%s/%s", folder, file);
        mf_json_write_text(writer, key, path);
    }
}

static void write_choices(struct json_writer *writer, const struct field *field, int chosen) {
    cJSON *array = cJSON_CreateArray();
    for (int k = 0; array && field->choices[k]; k++)
        if ((chosen >> k & 1) &&
            !cJSON_AddItemToArray(array, cJSON_CreateString(field->choices[k])))
            note_problem(writer, field->name, "does not fit into the memory");
    append(writer, field->name, array);
}

static void write_field(struct json_writer *writer, const struct field *field, const char *member) {
    double number[3];
    int64_t integer;
    uint64_t seed;
    int choice;
    const char *unit = field->unit ? field->unit : "";
    switch (field->type) {
    case FIELD_NUMBER:
        memcpy(number, member, sizeof *number);
        mf_json_write_quantity(writer, field->name, unit, number[0]);
        break;
    case FIELD_INTEGER:
        memcpy(&integer, member, sizeof integer);
        mf_json_write_integer(writer, field->name, integer);
        break;
    case FIELD_SEED:
        memcpy(&seed, member, sizeof seed);
        write_seed(writer, field->name, seed);
        break;
    case FIELD_LENGTHS:
        memcpy(number, member, sizeof number);
        if (field->required || number[0] != 0 || number[1] != 0 || number[2] != 0)
            mf_json_write_quantities(writer, field->name, unit, number, number[2] != 0 ? 3 : 2);
        break;
    case FIELD_TEXT:
        if (member[0])
            mf_json_write_text(writer, field->name, member);
        break;
    case FIELD_FILE:
        if (member[0])
            write_file(writer, field->name, member);
        break;
    case FIELD_CHOICE:
        memcpy(&choice, member, sizeof choice);
        mf_json_write_text(writer, field->name, field->choices[choice]);
        break;
    case FIELD_CHOICES:
        memcpy(&choice, member, sizeof choice);
        write_choices(writer, field, choice);
        break;
    }
}

void mf_json_write_fields(struct json_writer *writer, const struct field *fields,
                          const void *parameters) {
    for (const struct field *field = fields; field->name; field++)
        write_field(writer, field, (const char *)parameters + field->offset);
}

/// The tree as a text that cJSON_free frees.
static enum status print(const struct json_writer *writer, const char *name, char **text) {
    *text = NULL;
    if (writer->problem[0])
        return mf_status_fail(STATUS_IO, "cannot write %s: %s", name, writer->problem);
    *text = cJSON_Print(writer->object[0]);
    if (*text == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "cannot write %s: out of memory", name);
    return STATUS_OK;
}

enum status mf_json_write(const struct json_writer *writer, const char *file) {
    char *text;
    TRY(print(writer, file, &text));
    struct output output;
    const enum status status = mf_output_open(&output, file);
    if (status == STATUS_OK)
        fprintf(output.stream, "%s\n", text);
    cJSON_free(text);
    return status == STATUS_OK ? mf_output_commit(&output) : status;
}

enum status mf_json_write_stream(const struct json_writer *writer, FILE *stream, const char *name) {
    char *text;
    TRY(print(writer, name, &text));
    const bool written = fprintf(stream, "%s\n", text) >= 0 && fflush(stream) == 0;
    const int error = errno;
    cJSON_free(text);
    return written ? STATUS_OK
                   : mf_status_fail(STATUS_IO, "cannot write %s: %s", name, strerror(error));
}
