// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/nearest.h"
#include "io/json_document.h"
#include "io/json.h"

#include <cJSON.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

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
        mf_json_fault_type(object, key, expected, item);
        return false;
    }
    if (!isfinite(item->valuedouble)) {
        mf_json_fault(object, key, "the number is too large; the largest is %.3g", DBL_MAX);
        return false;
    }
    *value = item->valuedouble;
    return true;
}

/// How many of the document's units one of the field's is.
static double factor_of(const struct json_object *object, const struct field *field) {
    return mf_json_factor(object, field->unit ? field->unit : "");
}

double mf_json_factor(const struct json_object *object, const char *unit) {
    return mf_units_factor(&object->document->units, unit);
}

/// A finite whole number whose digits survived, or false and a fault.
static bool read_whole(struct json_object *object, const char *key, const cJSON *item,
                       double *value) {
    if (!read_finite(object, key, "a whole number", item, value))
        return false;
    if (*value != floor(*value)) {
        mf_json_fault_type(object, key, "a whole number", item);
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

void mf_json_range_text(const struct json_object *object, const struct field *field, char *text,
                        size_t size) {
    const double factor = factor_of(object, field);
    struct field physical = *field;
    char range[64], name[UNITS_NAME_SIZE];
    // The ends of all numbers stay: they stand for words.
    if (fabs(field->minimum) < DBL_MAX && field->minimum > FIELD_ABOVE_ZERO)
        physical.minimum *= factor;
    if (field->maximum < DBL_MAX)
        physical.maximum *= factor;
    mf_fields_range_text(&physical, range, sizeof range);
    mf_units_name(&object->document->units, field->unit ? field->unit : "", name);
    snprintf(text, size, "%s%s%s", range, name[0] ? " " : "", name);
}

static bool is_in_range(struct json_object *object, const char *key, const struct field *field,
                        double value) {
    if (value >= field->minimum && value <= field->maximum)
        return true;
    char range[64 + UNITS_NAME_SIZE];
    mf_json_range_text(object, field, range, sizeof range);
    mf_json_fault(object, key, "%.15g is out of range; allowed: %s",
                  value * factor_of(object, field), range);
    return false;
}

/// A number in the document's units, as one in the field's.
static bool read_quantity(struct json_object *object, const char *key, const struct field *field,
                          const char *expected, const cJSON *item, double *value) {
    if (!read_finite(object, key, expected, item, value))
        return false;
    *value /= factor_of(object, field);
    if (!isfinite(*value)) {
        mf_json_fault(object, key, "the number is too large for the units of the file");
        return false;
    }
    return is_in_range(object, key, field, *value);
}

static void read_lengths(struct json_object *object, const struct field *field, const cJSON *item,
                         char *member) {
    double lengths[3] = {0};
    const int count = mf_json_count(object, field->name);
    if (count < 2 || count > 3) {
        if (cJSON_IsArray(item))
            mf_json_fault(object, field->name, "expected 2 or 3 numbers, found %d", count);
        else
            mf_json_fault_type(object, field->name, expected_name[FIELD_LENGTHS], item);
        return;
    }
    bool good = true;
    for (int k = 0; k < count; k++) {
        char key[JSON_PATH_SIZE];
        snprintf(key, sizeof key, "%s[%d]", field->name, k);
        good &=
            read_quantity(object, key, field, "a number", cJSON_GetArrayItem(item, k), &lengths[k]);
    }
    if (good)
        memcpy(member, lengths, sizeof lengths);
}

/// A text that is not empty, or NULL and a fault. Names of files need not be UTF-8.
static const char *read_text(struct json_object *object, const char *key, enum field_type type,
                             const cJSON *item) {
    const char *text = cJSON_GetStringValue(item);
    if (text == NULL)
        mf_json_fault_type(object, key, expected_name[type], item);
    else if (text[0] == '\0')
        mf_json_fault(object, key, "the text is empty");
    else if (type == FIELD_FILE || mf_json_is_encoded(object, key, text))
        return text;
    return NULL;
}

static void read_text_field(struct json_object *object, const struct field *field,
                            const cJSON *item, char *member) {
    const char *text = read_text(object, field->name, field->type, item);
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
        mf_json_fault(object, field->name, "%s", mf_status_marked());
}

/// A list of at least one choice of a field as a set, a bit each; false and a fault otherwise.
static bool read_choices(struct json_object *object, const struct field *field, const void *item,
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

static void read_field(struct json_object *object, const struct field *field, const cJSON *item,
                       char *member) {
    const char *key = field->name;
    double value;
    int chosen;
    switch (field->type) {
    case FIELD_NUMBER:
        if (read_quantity(object, key, field, expected_name[FIELD_NUMBER], item, &value))
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
        if (read_choices(object, field, item, &chosen))
            memcpy(member, &chosen, sizeof chosen);
        break;
    }
}

uint64_t mf_json_fields(struct json_object *object, const struct field *fields, void *parameters) {
    uint64_t given = 0, bit = 1;
    mf_fields_set_defaults(fields, parameters);
    for (const struct field *field = fields; field->name; field++, bit <<= 1) {
        const cJSON *item = mf_json_get(object, field->name);
        given |= item ? bit : 0;
        // A number that is not known is written as null.
        if (cJSON_IsNull(item) && field->type == FIELD_NUMBER && isnan(field->initial))
            continue;
        if (item)
            read_field(object, field, item, (char *)parameters + field->offset);
        else if (field->required && object->item)
            mf_json_fault(object, field->name, "missing: expected %s (%s)",
                          expected_name[field->type], field->help ? field->help : field->name);
    }
    return given;
}

void mf_json_fields_need_scale(struct json_object *object, const struct field *fields) {
    char name[UNITS_NAME_SIZE];
    if (!object->document->units.chosen)
        return;
    for (const struct field *field = fields; field->name; field++) {
        const bool scaled = field->type == FIELD_NUMBER && field->initial != 0 &&
                            (strstr(field->unit, "lambda") || strstr(field->unit, "tau"));
        if (scaled && !field->required && !mf_json_has(object, field->name))
            mf_json_fault(object, field->name,
                          "missing: expected a number in %s (%s); the default, %g %s, would change "
                          "with the density",
                          mf_units_name(&object->document->units, field->unit, name), field->help,
                          field->initial, field->unit);
    }
}

static void fault_missing_choice(struct json_object *object, const char *key,
                                 const char *const *known) {
    char hint[JSON_LINE_SIZE / 4] = "";
    size_t count = 0;
    while (known && known[count])
        count++;
    mf_nearest_hint("", known, count, hint, sizeof hint);
    mf_json_fault(object, key, "missing: expected a text%s%s", known ? "; " : "",
                  known ? hint : "");
}

const char *mf_json_choice(struct json_object *object, const char *key, const char *const *known,
                           const char *fallback) {
    const cJSON *item = mf_json_get(object, key);
    if (item == NULL) {
        if (fallback == NULL && object->item)
            fault_missing_choice(object, key, known);
        return fallback;
    }
    const char *flag = cJSON_IsTrue(item) ? "true" : cJSON_IsFalse(item) ? "false" : NULL;
    const char *text = known && flag ? flag : read_text(object, key, FIELD_TEXT, item);
    if (text == NULL || known == NULL)
        return text;
    size_t count = 0;
    for (; known[count]; count++)
        if (strcmp(known[count], text) == 0)
            return text;
    char hint[JSON_LINE_SIZE / 4];
    mf_nearest_hint(text, known, count, hint, sizeof hint);
    mf_json_fault(object, key, "\"%.60s\" is unknown; %s", text, hint);
    return NULL;
}

int mf_json_numbers(const struct json_object *object, const char *key, double *values, int max) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object->item, key), *element;
    int count = 0;
    if (cJSON_IsNumber(item) && isfinite(item->valuedouble)) {
        values[0] = item->valuedouble;
        return 1;
    }
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) > max)
        return 0;
    cJSON_ArrayForEach(element, item) {
        if (!cJSON_IsNumber(element) || !isfinite(element->valuedouble))
            return 0;
        values[count++] = element->valuedouble;
    }
    return count;
}

// Lists -------------------------------------------------------------------------------------------

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
static bool is_whole_number(const cJSON *item, int *value) {
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
            if (n < rows && found < width && is_whole_number(element, &values[n * width + found]))
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
