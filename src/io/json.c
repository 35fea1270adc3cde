// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json.h"

#include "base/faults.h"
#include "base/memory.h"
#include "base/nearest.h"
#include "base/visible.h"
#include "io/json_item.h"
#include "io/json_list.h"
#include "io/json_syntax.h"
#include "io/output.h"
#include "io/text_file.h"

#include <cJSON.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 4096 };

struct json_document {
    cJSON *root;
    char *file;
    struct input_files *inputs; ///< files that it names, or NULL: nobody wants to know
    struct faults faults;
};

// Faults ------------------------------------------------------------------------------------------

/// "scene.particles" and "count" make "scene.particles.count"; either may be empty.
static void join_path(char *text, size_t size, const char *path, const char *key) {
    const char *dot = path[0] && key[0] && key[0] != '[' ? "." : "";
    if (snprintf(text, size, "%s%s%s", path, dot, key) >= (int)size)
        memcpy(text + size - 4, "...", 4);
}

void mf_json_fault(struct json_object *object, const char *key, const char *format, ...) {
    char path[2 * JSON_PATH_SIZE], message[LINE_SIZE / 2], line[LINE_SIZE], visible[LINE_SIZE];
    join_path(path, sizeof path, object->path, key ? key : "");
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    snprintf(line, sizeof line, "%.1024s: %s%s%s", object->document->file, path,
             path[0] ? ": " : "", message);
    mf_visible_copy(visible, sizeof visible, line, ""); // one line a fault, whatever it quotes
    mf_faults_add(&object->document->faults, visible);
}

static void fault_wrong_type(struct json_object *object, const char *key, const char *expected,
                             const cJSON *item) {
    char found[64];
    mf_json_item_describe(item, found, sizeof found);
    mf_json_fault(object, key, "expected %s, found %s", expected, found);
}

// Documents and objects ---------------------------------------------------------------------------

static struct json_object view(struct json_document *document, const cJSON *item) {
    return (struct json_object){.document = document, .item = item};
}

/// Record each key that an object holds twice, here and in everything below: cJSON would read the
/// first and pass over the others.
static void find_duplicates(struct json_object *object) {
    const cJSON *item = object->item, *member;
    int index = 0;
    cJSON_ArrayForEach(member, item) {
        if (member->string && cJSON_GetObjectItemCaseSensitive(item, member->string) != member)
            mf_json_fault(object, member->string, "the key stands here twice");
        if (member->child) {
            struct json_object inner = view(object->document, member);
            char place[32];
            snprintf(place, sizeof place, "[%d]", index);
            join_path(inner.path, sizeof inner.path, object->path,
                      member->string ? member->string : place);
            find_duplicates(&inner);
        }
        index++;
    }
}

/// The syntax was checked, so what cJSON refuses is a \u escape without a meaning.
static enum status parse(struct json_document *document, const char *text) {
    const char *end = text;
    errno = 0;
    document->root = cJSON_ParseWithOpts(text, &end, true);
    if (document->root)
        return STATUS_OK;
    if (errno == ENOMEM)
        return mf_status_fail(STATUS_NO_MEMORY, "%s: out of memory", document->file);
    const struct text_place place = mf_text_file_place(text, end);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu:%zu: expected a valid \\u escape",
                          document->file, place.line, place.column);
}

static void free_document(struct json_document *document) {
    cJSON_Delete(document->root);
    mf_memory_free(document->file);
    mf_memory_free(document);
}

enum status mf_json_open(struct json_document **document, const char *file) {
    enum status status = STATUS_OK;
    struct json_document *opened = NULL;
    char *text = NULL;
    size_t length = 0;
    *document = NULL;
    NEW_ARRAY(opened, 1);
    NEW_ARRAY(opened->file, strlen(file) + 1);
    memcpy(opened->file, file, strlen(file) + 1);
    CHECK(mf_text_file_read(file, &text, &length));
    CHECK(mf_json_syntax_check(file, text));
    CHECK(parse(opened, text));
    CHECK(mf_json_item_check(file, opened->root));
    struct json_object root = view(opened, opened->root);
    find_duplicates(&root);
    *document = opened;
done:
    mf_memory_free(text);
    if (status != STATUS_OK && opened)
        free_document(opened);
    return status;
}

enum status mf_json_collect_files(struct json_document *document, struct input_files *inputs) {
    document->inputs = inputs;
    return mf_input_files_add(inputs, document->file);
}

struct json_object mf_json_root(struct json_document *document) {
    struct json_object root = view(document, document->root);
    if (!cJSON_IsObject(document->root)) {
        fault_wrong_type(&root, NULL, "an object", document->root);
        root.item = NULL;
    }
    return root;
}

static bool was_asked(const struct json_object *object, const char *key) {
    for (size_t k = 0; k < object->asked_count; k++)
        if (strcmp(object->asked[k], key) == 0)
            return true;
    return false;
}

/// Remember that the reader knows `key`, and find it.
static const cJSON *ask(struct json_object *object, const char *key) {
    if (!was_asked(object, key)) {
        if (object->asked_count < JSON_MAX_KEYS)
            object->asked[object->asked_count++] = key;
        else
            mf_json_fault(object, key, "the reader knows more than %d keys here", JSON_MAX_KEYS);
    }
    return cJSON_GetObjectItemCaseSensitive(object->item, key);
}

static void fault_no_object(struct json_object *parent, const char *key, const char *chief,
                            const cJSON *item) {
    char found[64], meant[128];
    mf_json_item_describe(item, found, sizeof found);
    mf_json_item_complete(item, chief, meant, sizeof meant);
    mf_json_fault(parent, key, "expected an object, found %s%s", found, meant);
}

struct json_object mf_json_child(struct json_object *parent, const char *key, bool required) {
    return mf_json_child_of(parent, key, required, NULL);
}

struct json_object mf_json_child_of(struct json_object *parent, const char *key, bool required,
                                    const char *chief) {
    const cJSON *item = ask(parent, key);
    struct json_object child = view(parent->document, NULL);
    join_path(child.path, sizeof child.path, parent->path, key);
    if (cJSON_IsObject(item))
        child.item = item;
    else if (item)
        fault_no_object(parent, key, chief, item);
    else if (required && parent->item)
        mf_json_fault(parent, key, "missing: an object is required");
    return child;
}

bool mf_json_has(struct json_object *object, const char *key) {
    return ask(object, key) != NULL;
}

bool mf_json_is_object(const struct json_object *object, const char *key) {
    return cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(object->item, key));
}

int mf_json_count(const struct json_object *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object->item, key);
    return cJSON_IsArray(item) ? cJSON_GetArraySize(item) : 0;
}

void mf_json_renamed(struct json_object *object, const char *old, const char *today) {
    // Only then: the name is not to be proposed as the nearest one.
    if (cJSON_GetObjectItemCaseSensitive(object->item, old) && ask(object, old))
        mf_json_fault(object, old, "is called \"%s\" now", today);
}

const char *mf_json_key(const struct json_object *object, size_t n) {
    const cJSON *member;
    cJSON_ArrayForEach(member, (const cJSON *)object->item) {
        if (n-- == 0)
            return member->string;
    }
    return NULL;
}

void mf_json_refuse(struct json_object *object, const char *key, const char *reason) {
    // Only then: the key is not to be proposed as one that is known.
    if (cJSON_GetObjectItemCaseSensitive(object->item, key) && ask(object, key))
        mf_json_fault(object, key, "unknown key: %s", reason);
}

/// A key that is nearly that of what is missing tells why it is.
static void take_back_missing(struct json_object *object, const char *given) {
    const char *meant = mf_nearest_name(given, object->asked, object->asked_count);
    char path[2 * JSON_PATH_SIZE], words[LINE_SIZE];
    if (meant == NULL)
        return;
    join_path(path, sizeof path, object->path, meant);
    snprintf(words, sizeof words, "%.1024s: %s: missing: ", object->document->file, path);
    mf_faults_take_back(&object->document->faults, words);
}

void mf_json_finish(struct json_object *object) {
    const cJSON *member;
    cJSON_ArrayForEach(member, (const cJSON *)object->item) {
        if (was_asked(object, member->string))
            continue;
        char hint[LINE_SIZE / 4];
        mf_nearest_hint(member->string, object->asked, object->asked_count, hint, sizeof hint);
        take_back_missing(object, member->string);
        mf_json_fault(object, member->string, "unknown key; %s", hint);
    }
}

size_t mf_json_fault_count(const struct json_document *document) {
    return document->faults.count;
}

enum status mf_json_close(struct json_document *document, enum status status) {
    if (document == NULL)
        return status;
    if (status != STATUS_NO_MEMORY && document->faults.count > 0)
        status = mf_faults_status(&document->faults);
    free_document(document);
    return status;
}

// Values ------------------------------------------------------------------------------------------

static const char *const expected_name[] = {
    [FIELD_NUMBER] = "a number",     [FIELD_INTEGER] = "a whole number",
    [FIELD_SEED] = "a whole number", [FIELD_LENGTHS] = "an array of 2 or 3 numbers",
    [FIELD_TEXT] = "a text",         [FIELD_FILE] = "a text with the name of a file",
    [FIELD_CHOICE] = "a text",       [FIELD_CHOICES] = "a list of texts",
};

/// A finite number, or false and a fault.
static bool read_finite(struct json_object *object, const char *key, const char *expected,
                        const cJSON *item, double *value) {
    if (!cJSON_IsNumber(item)) {
        fault_wrong_type(object, key, expected, item);
        return false;
    }
    if (!isfinite(item->valuedouble)) {
        mf_json_fault(object, key, "the number is too large; the largest is %.3g", DBL_MAX);
        return false;
    }
    *value = item->valuedouble;
    return true;
}

/// A finite whole number whose digits survived, or false and a fault.
static bool read_whole(struct json_object *object, const char *key, const cJSON *item,
                       double *value) {
    if (!read_finite(object, key, "a whole number", item, value))
        return false;
    if (*value != floor(*value)) {
        fault_wrong_type(object, key, "a whole number", item);
        return false;
    }
    if (fabs(*value) >= FIELD_LARGEST_INTEGER) {
        mf_json_fault(object, key,
                      "%.0f is out of range: whole numbers of 2^53 (%.0f) and beyond lose digits",
                      *value, FIELD_LARGEST_INTEGER);
        return false;
    }
    return true;
}

static bool is_in_range(struct json_object *object, const char *key, const struct field *field,
                        double value) {
    if (value >= field->minimum && value <= field->maximum)
        return true;
    char range[64];
    mf_fields_range_text(field, range, sizeof range);
    mf_json_fault(object, key, "%.15g is out of range; allowed: %s%s%s", value, range,
                  field->unit && field->unit[0] ? " " : "", field->unit ? field->unit : "");
    return false;
}

static void read_lengths(struct json_object *object, const struct field *field, const cJSON *item,
                         char *member) {
    double lengths[3] = {0};
    const int count = mf_json_count(object, field->name);
    if (count < 2 || count > 3) {
        if (cJSON_IsArray(item))
            mf_json_fault(object, field->name, "expected 2 or 3 numbers, found %d", count);
        else
            fault_wrong_type(object, field->name, expected_name[FIELD_LENGTHS], item);
        return;
    }
    bool good = true;
    for (int k = 0; k < count; k++) {
        char key[JSON_PATH_SIZE];
        snprintf(key, sizeof key, "%s[%d]", field->name, k);
        good &= read_finite(object, key, "a number", cJSON_GetArrayItem(item, k), &lengths[k]) &&
                is_in_range(object, key, field, lengths[k]);
    }
    if (good)
        memcpy(member, lengths, sizeof lengths);
}

/// A text that is not empty, or NULL and a fault.
static const char *read_text(struct json_object *object, const char *key, const char *expected,
                             const cJSON *item) {
    if (!cJSON_IsString(item))
        fault_wrong_type(object, key, expected, item);
    else if (item->valuestring[0] == '\0')
        mf_json_fault(object, key, "the text is empty");
    else
        return item->valuestring;
    return NULL;
}

static void read_text_field(struct json_object *object, const struct field *field,
                            const cJSON *item, char *member) {
    const char *text = read_text(object, field->name, expected_name[field->type], item);
    if (text == NULL)
        return;
    const char *file = object->document->file, *slash = strrchr(file, '/');
    const bool joined = field->type == FIELD_FILE && text[0] != '/' && slash;
    const size_t folder = joined ? (size_t)(slash + 1 - file) : 0;
    if (folder + strlen(text) >= FIELD_TEXT_SIZE) {
        mf_json_fault(object, field->name, "the text is longer than %d bytes", FIELD_TEXT_SIZE - 1);
        return;
    }
    memcpy(member, file, folder);
    strcpy(member + folder, text);
    if (field->type == FIELD_FILE && object->document->inputs &&
        mf_input_files_add(object->document->inputs, member) != STATUS_OK)
        mf_json_fault(object, field->name, "%s", mf_status_message());
}

static void read_field(struct json_object *object, const struct field *field, const cJSON *item,
                       char *member) {
    const char *key = field->name;
    double value;
    int chosen;
    switch (field->type) {
    case FIELD_NUMBER:
        if (read_finite(object, key, expected_name[FIELD_NUMBER], item, &value) &&
            is_in_range(object, key, field, value))
            memcpy(member, &value, sizeof value);
        break;
    case FIELD_INTEGER:
        if (read_whole(object, key, item, &value) && is_in_range(object, key, field, value))
            memcpy(member, &(int64_t){(int64_t)value}, sizeof(int64_t));
        break;
    case FIELD_SEED:
        if (!read_whole(object, key, item, &value))
            break;
        if (value < 0)
            mf_json_fault(object, key, "%.0f is out of range; allowed: at least 0", value);
        else
            memcpy(member, &(uint64_t){(uint64_t)value}, sizeof(uint64_t));
        break;
    case FIELD_LENGTHS:
        read_lengths(object, field, item, member);
        break;
    case FIELD_TEXT:
    case FIELD_FILE:
        read_text_field(object, field, item, member);
        break;
    case FIELD_CHOICE:
        if (mf_json_choice(object, key, field->choices, NULL))
            memcpy(member, &(int){mf_fields_choice_index(field, item->valuestring)}, sizeof(int));
        break;
    case FIELD_CHOICES:
        if (mf_json_list_choices(object, field, item, &chosen))
            memcpy(member, &chosen, sizeof chosen);
        break;
    }
}

void mf_json_fields(struct json_object *object, const struct field *fields, void *parameters) {
    mf_fields_set_defaults(fields, parameters);
    for (const struct field *field = fields; field->name; field++) {
        const cJSON *item = ask(object, field->name);
        // A number that is not known is written as null.
        if (cJSON_IsNull(item) && field->type == FIELD_NUMBER && isnan(field->initial))
            continue;
        if (item)
            read_field(object, field, item, (char *)parameters + field->offset);
        else if (field->required && object->item)
            mf_json_fault(object, field->name, "missing: %s is required (%s)",
                          expected_name[field->type], field->help ? field->help : field->name);
    }
}

static void fault_missing_choice(struct json_object *object, const char *key,
                                 const char *const *known) {
    char hint[LINE_SIZE / 4] = "";
    size_t count = 0;
    while (known && known[count])
        count++;
    mf_nearest_hint("", known, count, hint, sizeof hint);
    mf_json_fault(object, key, "missing: a text is required%s%s", known ? "; " : "",
                  known ? hint : "");
}

const char *mf_json_choice(struct json_object *object, const char *key, const char *const *known,
                           const char *fallback) {
    const cJSON *item = ask(object, key);
    if (item == NULL) {
        if (fallback == NULL && object->item)
            fault_missing_choice(object, key, known);
        return fallback;
    }
    const char *flag = cJSON_IsTrue(item) ? "true" : cJSON_IsFalse(item) ? "false" : NULL;
    const char *text = known && flag ? flag : read_text(object, key, "a text", item);
    if (text == NULL || known == NULL)
        return text;
    size_t count = 0;
    for (; known[count]; count++)
        if (strcmp(known[count], text) == 0)
            return text;
    char hint[LINE_SIZE / 4];
    mf_nearest_hint(text, known, count, hint, sizeof hint);
    mf_json_fault(object, key, "\"%.60s\" is unknown; %s", text, hint);
    return NULL;
}
