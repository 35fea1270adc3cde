// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json.h"

#include "base/memory.h"
#include "base/nearest.h"
#include "base/visible.h"
#include "io/json_document.h"
#include "io/output.h"
#include "io/text_file.h"

#include <cJSON.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = JSON_LINE_SIZE };

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
    mf_units_convert_text(&object->document->units, message, sizeof message);
    snprintf(line, sizeof line, "%.1024s: %s%s%s", object->document->file, path,
             path[0] ? ": " : "", message);
    mf_visible_copy(visible, sizeof visible, line, ""); // one line a fault, whatever it quotes
    mf_faults_add(&object->document->faults, visible);
}

void mf_json_fault_type(struct json_object *object, const char *key, const char *expected,
                        const void *item) {
    char found[64];
    mf_json_item_describe(item, found, sizeof found);
    mf_json_fault(object, key, "expected %s, found %s", expected, found);
}

bool mf_json_is_encoded(struct json_object *object, const char *key, const char *text) {
    size_t left = strlen(text), bytes;
    for (; left > 0; text += bytes, left -= bytes)
        if ((bytes = mf_visible_character(text, left)) == 0) {
            mf_json_fault(object, key, "byte 0x%02x is not UTF-8; save the file as UTF-8",
                          (unsigned char)*text);
            return false;
        }
    return true;
}

// Documents and objects ---------------------------------------------------------------------------

static struct json_object view(struct json_document *document, const cJSON *item) {
    return (struct json_object){.document = document, .item = item};
}

/// Record each key that is not UTF-8, or that an object holds twice, here and in everything below:
/// cJSON would read the first and pass over the others.
static void check_keys(struct json_object *object) {
    const cJSON *item = object->item, *member;
    int index = 0;
    cJSON_ArrayForEach(member, item) {
        if (member->string && cJSON_GetObjectItemCaseSensitive(item, member->string) != member)
            mf_json_fault(object, member->string, "duplicate key");
        if (member->string)
            mf_json_is_encoded(object, member->string, member->string);
        if (member->child) {
            struct json_object inner = view(object->document, member);
            char place[32];
            snprintf(place, sizeof place, "[%d]", index);
            join_path(inner.path, sizeof inner.path, object->path,
                      member->string ? member->string : place);
            check_keys(&inner);
        }
        index++;
    }
}

static void free_document(struct json_document *document) {
    cJSON_Delete(document->root);
    mf_memory_free(document->file);
    mf_memory_free(document);
}

enum status mf_json_open(struct json_document **document, const char *file) {
    OWNED char *text = NULL;
    size_t length;
    *document = NULL;
    TRY(mf_text_file_read(file, &text, &length));
    return mf_json_open_text(document, file, text);
}

enum status mf_json_open_text(struct json_document **document, const char *file, const char *text) {
    enum status status = STATUS_OK;
    struct json_document *opened = NULL;
    *document = NULL;
    NEW_ARRAY(opened, 1);
    NEW_ARRAY(opened->file, strlen(file) + 1);
    memcpy(opened->file, file, strlen(file) + 1);
    CHECK(mf_json_parse(file, text, &opened->root));
    CHECK(mf_json_item_check(file, opened->root));
    struct json_object root = view(opened, opened->root);
    check_keys(&root);
    *document = opened;
done:
    if (status != STATUS_OK && opened)
        free_document(opened);
    return status;
}

enum status mf_json_collect_files(struct json_document *document, struct input_files *inputs) {
    document->inputs = inputs;
    return mf_input_files_add(inputs, document->file);
}

void mf_json_set_units(struct json_document *document, const struct units *units) {
    document->units = *units;
}

const struct units *mf_json_units(const struct json_object *object) {
    return &object->document->units;
}

/// What is null goes, objects are merged, and everything else replaces what was there; false if
/// there is no memory.
static bool merge(cJSON *object, const cJSON *patch) {
    const cJSON *from;
    cJSON_ArrayForEach(from, patch) {
        cJSON *to = cJSON_GetObjectItemCaseSensitive(object, from->string);
        const bool both = cJSON_IsObject(from) && cJSON_IsObject(to);
        if (!both)
            cJSON_DeleteItemFromObjectCaseSensitive(object, from->string);
        if (cJSON_IsNull(from))
            continue;
        if (!both) {
            to = cJSON_IsObject(from) ? cJSON_CreateObject() : cJSON_Duplicate(from, true);
            if (!cJSON_AddItemToObject(object, from->string, to)) {
                cJSON_Delete(to);
                return false;
            }
        }
        if (cJSON_IsObject(from) && !merge(to, from))
            return false;
    }
    return true;
}

enum status mf_json_take_variant(struct json_document *document, const char *key, size_t n) {
    cJSON *variants = cJSON_DetachItemFromObjectCaseSensitive(document->root, key);
    const cJSON *one = cJSON_GetArrayItem(variants, (int)n);
    enum status status = STATUS_OK;
    if (!cJSON_IsObject(one)) {
        status = mf_status_fail(STATUS_BAD_INPUT, "%s: %s.%s: expected an object", document->file,
                                key, one && one->string ? one->string : "");
    } else {
        status = merge(document->root, one)
                     ? STATUS_OK
                     : mf_status_fail(STATUS_NO_MEMORY, "%s: out of memory", document->file);
    }
    cJSON_Delete(variants);
    return status;
}

/// The item at a path, whose objects are made if they are missing.
static cJSON *find_place(cJSON *root, const char *path) {
    char name[JSON_PATH_SIZE], *rest;
    cJSON *place = root;
    snprintf(name, sizeof name, "%s", path ? path : "");
    for (char *key = strtok_r(name, ".", &rest); place && key; key = strtok_r(NULL, ".", &rest)) {
        cJSON *const inner = cJSON_GetObjectItemCaseSensitive(place, key);
        place = inner || !cJSON_IsObject(place) ? inner : cJSON_AddObjectToObject(place, key);
    }
    return place;
}

static enum status make_item(const struct json_word *word, cJSON **item) {
    if (word->json) {
        TRY(mf_json_parse(word->key, word->json, item));
        return mf_json_item_check(word->key, *item);
    }
    *item = word->text    ? cJSON_CreateString(word->text)
            : word->count ? cJSON_CreateDoubleArray(word->values, (int)word->count)
                          : cJSON_CreateNumber(word->value);
    return *item ? STATUS_OK : STATUS_NO_MEMORY;
}

static enum status add_word(struct json_document *document, const struct json_word *word) {
    cJSON *const place = find_place(document->root, word->object), *item = NULL;
    if (!cJSON_IsObject(place)) // its reader says what should stand there
        return STATUS_OK;
    if (cJSON_GetObjectItemCaseSensitive(place, word->key))
        return mf_status_fail(STATUS_BAD_INPUT, "--%s: %s has %s%s%s", word->key, document->file,
                              word->object ? word->object : "", word->object ? "." : "", word->key);
    enum status status = make_item(word, &item);
    if (status == STATUS_OK && !cJSON_AddItemToObject(place, word->key, item))
        status = STATUS_NO_MEMORY;
    if (status != STATUS_OK) {
        cJSON_Delete(item);
        return status;
    }
    struct json_object added = view(document, item);
    join_path(added.path, sizeof added.path, word->object ? word->object : "", word->key);
    check_keys(&added);
    return STATUS_OK;
}

enum status mf_json_add(struct json_document *document, const struct json_word *words,
                        size_t count) {
    for (size_t k = 0; k < count; k++)
        TRY(add_word(document, &words[k]));
    return STATUS_OK;
}

struct json_object mf_json_root(struct json_document *document) {
    struct json_object root = view(document, document->root);
    if (!cJSON_IsObject(document->root)) {
        mf_json_fault_type(&root, NULL, "an object", document->root);
        root.item = NULL;
    }
    return root;
}

static bool is_among(const char *const *keys, size_t count, const char *key) {
    for (size_t k = 0; k < count; k++)
        if (strcmp(keys[k], key) == 0)
            return true;
    return false;
}

static bool was_asked(const struct json_object *object, const char *key) {
    return is_among(object->asked, object->asked_count, key);
}

static bool was_refused(const struct json_object *object, const char *key) {
    return is_among(object->refused, object->refused_count, key);
}

const void *mf_json_get(struct json_object *object, const char *key) {
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
    const cJSON *item = mf_json_get(parent, key);
    struct json_object child = view(parent->document, NULL);
    join_path(child.path, sizeof child.path, parent->path, key);
    if (cJSON_IsObject(item))
        child.item = item;
    else if (item)
        fault_no_object(parent, key, chief, item);
    else if (required && parent->item)
        mf_json_fault(parent, key, "missing: expected an object");
    return child;
}

bool mf_json_has(struct json_object *object, const char *key) {
    return mf_json_get(object, key) != NULL;
}

bool mf_json_is_object(const struct json_object *object, const char *key) {
    return cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(object->item, key));
}

bool mf_json_is_member(const struct json_object *object, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(object->item, key) != NULL;
}

int mf_json_count(const struct json_object *object, const char *key) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object->item, key);
    return cJSON_IsArray(item) ? cJSON_GetArraySize(item) : 0;
}

/// Whether the key is there. It is not one that the reader knows, and is not proposed as such.
static bool refuses(struct json_object *object, const char *key) {
    if (cJSON_GetObjectItemCaseSensitive(object->item, key) == NULL)
        return false;
    if (object->refused_count < JSON_MAX_KEYS)
        object->refused[object->refused_count++] = key;
    return true;
}

/// Whether a text or a number is this one.
static bool is_printed(const cJSON *item, const char *fixed) {
    char number[32];
    const char *text = cJSON_GetStringValue(item);
    if (cJSON_IsNumber(item)) {
        snprintf(number, sizeof number, "%.15g", item->valuedouble);
        text = number;
    }
    return text && strcmp(text, fixed) == 0;
}

/// The first removed key is reported with its reason; if there are several, all by their names.
static void fault_retired(struct json_object *object, const char *key, const char *reason) {
    struct json_document *document = object->document;
    struct json_object root = view(document, NULL);
    char *all = document->retired, path[2 * JSON_PATH_SIZE], words[LINE_SIZE];
    const size_t before = strlen(all), capacity = sizeof document->retired - before;
    join_path(path, sizeof path, object->path, key);
    if (before == 0) {
        snprintf(all, capacity, "%s", path);
        mf_json_fault(object, key, "no longer a key: %s", reason);
        return;
    }
    snprintf(words, sizeof words, "%.1024s: %.1024s: no longer a key: ", document->file, all);
    mf_faults_take_back(&document->faults, words);
    snprintf(words, sizeof words, "%.1024s: no longer keys: ", document->file);
    mf_faults_take_back(&document->faults, words);
    snprintf(all + before, capacity, ", %s", path);
    mf_json_fault(&root, NULL, "no longer keys: %s; leave them out", all);
}

void mf_json_retired(struct json_object *object, const char *old, const char *fixed,
                     const char *reason) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object->item, old);
    if (refuses(object, old) && !(fixed && is_printed(item, fixed)))
        fault_retired(object, old, reason);
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
    if (refuses(object, key))
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
        if (was_asked(object, member->string) || was_refused(object, member->string))
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
