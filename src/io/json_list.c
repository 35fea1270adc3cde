// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_list.h"

#include "base/nearest.h"
#include "io/json_document.h"

#include <cJSON.h>

#include <math.h>
#include <stdio.h>

bool mf_json_list_choices(struct json_object *object, const struct field *field, const void *item,
                          int *chosen) {
    const cJSON *element;
    char described[JSON_PATH_SIZE];
    size_t known = 0;
    *chosen = 0;
    while (field->choices[known])
        known++;
    if (!cJSON_IsArray((const cJSON *)item) || cJSON_GetArraySize(item) == 0) {
        mf_json_item_describe(item, described, sizeof described);
        mf_json_fault(object, field->name, "expected a list of texts, found %s",
                      cJSON_IsArray((const cJSON *)item) ? "an empty one" : described);
        return false;
    }
    cJSON_ArrayForEach(element, (const cJSON *)item) {
        const char *name = cJSON_IsString(element) ? element->valuestring : NULL;
        const int number = name ? mf_fields_choice_index(field, name) : -1;
        if (number < 0) {
            char hint[JSON_PATH_SIZE];
            mf_json_item_describe(element, described, sizeof described);
            mf_nearest_hint(name ? name : "", field->choices, known, hint, sizeof hint);
            mf_json_fault(object, field->name, "%s is unknown; %s", described, hint);
            return false;
        }
        *chosen |= 1 << number;
    }
    return true;
}

bool mf_json_list_numbers(struct json_object *object, const char *key, double *values,
                          size_t count) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object->item, key), *element;
    size_t n = 0;
    mf_json_has(object, key);
    if (!cJSON_IsArray(list) || (size_t)mf_json_count(object, key) != count) {
        mf_json_fault(object, key, "expected a list of %zu numbers", count);
        return false;
    }
    cJSON_ArrayForEach(element, list) {
        if (!cJSON_IsNumber(element) || !isfinite(element->valuedouble)) {
            mf_json_fault(object, key, "number %zu of the list is not a number", n + 1);
            return false;
        }
        values[n++] = element->valuedouble;
    }
    return true;
}

bool mf_json_list_texts(struct json_object *object, const char *key, const char **texts,
                        size_t count) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object->item, key), *element;
    size_t n = 0;
    mf_json_has(object, key);
    cJSON_ArrayForEach(element, list) {
        if (n < count && cJSON_IsString(element))
            texts[n++] = element->valuestring;
    }
    if (n == count && (size_t)mf_json_count(object, key) == count)
        return true;
    mf_json_fault(object, key, "expected a list of %zu texts", count);
    return false;
}

const char *mf_json_list_text(const struct json_object *object, const char *key, size_t n) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object->item, key);
    if (cJSON_IsArray(item))
        item = cJSON_GetArrayItem(item, (int)n);
    else if (n > 0)
        return NULL;
    return cJSON_IsString(item) ? item->valuestring : NULL;
}

/// A whole number that an int holds.
static bool read_whole(const cJSON *item, int *value) {
    static const double largest = 1e9;
    if (!cJSON_IsNumber(item) || !(fabs(item->valuedouble) <= largest) ||
        item->valuedouble != floor(item->valuedouble))
        return false;
    *value = (int)item->valuedouble;
    return true;
}

bool mf_json_list_rows(struct json_object *object, const char *key, int *values, size_t rows,
                       size_t width) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object->item, key), *row, *element;
    size_t n = 0;
    mf_json_has(object, key);
    cJSON_ArrayForEach(row, list) {
        size_t found = 0;
        cJSON_ArrayForEach(element, row) {
            if (n < rows && found < width && read_whole(element, &values[n * width + found]))
                found++;
        }
        if (!cJSON_IsArray(row) || found != width || (size_t)cJSON_GetArraySize(row) != width)
            break;
        n++;
    }
    if (cJSON_IsArray(list) && n == rows && (size_t)cJSON_GetArraySize(list) == rows)
        return true;
    mf_json_fault(object, key, "expected a list of lists of %zu integers; number %zu is not one",
                  width, n + 1);
    return false;
}

/// Finite numbers of a list, or one alone.
static bool read_numbers(const cJSON *item, double *values, size_t width) {
    const cJSON *element;
    size_t n = 0;
    if (width == 0) {
        values[0] = cJSON_IsNumber(item) ? item->valuedouble : NAN;
        return isfinite(values[0]);
    }
    if (!cJSON_IsArray(item) || (size_t)cJSON_GetArraySize(item) != width)
        return false;
    cJSON_ArrayForEach(element, item) {
        values[n] = cJSON_IsNumber(element) ? element->valuedouble : NAN;
        if (!isfinite(values[n++]))
            return false;
    }
    return true;
}

bool mf_json_list_members(struct json_object *object, const char *key, const char *member,
                          double *values, size_t rows, size_t width) {
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object->item, key), *row;
    size_t n = 0;
    mf_json_has(object, key);
    cJSON_ArrayForEach(row, list) {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(row, member);
        if (n == 0 && item == NULL)
            return false;
        if (n >= rows || !read_numbers(item, values + n * (width ? width : 1), width))
            break;
        n++;
    }
    if (cJSON_IsArray(list) && n == rows && (size_t)cJSON_GetArraySize(list) == rows)
        return true;
    if (width > 0)
        mf_json_fault(object, key, "number %zu of the list: expected \"%s\", a list of %zu numbers",
                      n + 1, member, width);
    else
        mf_json_fault(object, key, "number %zu of the list: expected \"%s\", a number", n + 1,
                      member);
    return false;
}
