// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_document.h"

#include "io/json.h"
#include "io/text_file.h"

#include <cJSON.h>
#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// What a value is ---------------------------------------------------------------------------------

void mf_json_item_describe(const void *item, char *text, size_t size) {
    const cJSON *json = item;
    if (cJSON_IsString(json))
        snprintf(text, size, "the text \"%.40s\"", json->valuestring);
    else if (cJSON_IsNumber(json))
        snprintf(text, size, "the number %.15g", json->valuedouble);
    else if (cJSON_IsBool(json))
        snprintf(text, size, "%s", cJSON_IsTrue(json) ? "true" : "false");
    else
        snprintf(text, size, "%s",
                 cJSON_IsArray(json)    ? "an array"
                 : cJSON_IsObject(json) ? "an object"
                                        : "null");
}

void mf_json_item_complete(const void *item, const char *chief, char *text, size_t size) {
    const cJSON *json = item;
    text[0] = '\0';
    if (chief && cJSON_IsString(json))
        snprintf(text, size, ": write {\"%s\": \"%.40s\"}", chief, json->valuestring);
    else if (chief && cJSON_IsNumber(json))
        snprintf(text, size, ": write {\"%s\": %.15g}", chief, json->valuedouble);
}

static enum status check_below(const char *file, const cJSON *json, int depth) {
    const cJSON *member;
    int count = 0;
    if (depth > JSON_DEEPEST)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: more than %d nested objects and arrays", file,
                              JSON_DEEPEST);
    cJSON_ArrayForEach(member, json) {
        count++;
        if (member->child)
            TRY(check_below(file, member, depth + 1));
    }
    if (cJSON_IsObject(json) && count > JSON_MAX_MEMBERS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: an object has %d keys; %d are the most", file,
                              count, JSON_MAX_MEMBERS);
    return STATUS_OK;
}

enum status mf_json_item_check(const char *file, const void *item) {
    return check_below(file, item, 1);
}

// A text ------------------------------------------------------------------------------------------

static const char spaces[] = " \t\r\n";

/// The last character before a place that is no space, or NULL.
static const char *find_before(const char *text, const char *at) {
    while (at > text && strchr(spaces, at[-1]))
        at--;
    return at > text ? at - 1 : NULL;
}

/// Where cJSON says that a text begins which does not end: one character after its quote.
static bool is_open_text(const char *text, const char *end) {
    if (end == text || end[-1] != '"' || strchr(end, '"'))
        return false;
    const char *last = find_before(text, end - 1);
    return last == NULL || strchr("{[,:", *last);
}

/// Whether cJSON found something else where it looked for a key: it then stops one character
/// after that.
static bool is_after_key(const char *text, const char *end) {
    if (end == text || strchr(" \t\r\n[{\"0123456789", end[-1]))
        return false;
    const char *last = find_before(text, end - 1);
    return last && (*last == '{' || *last == ',');
}

static enum status fail_at(const char *file, const char *text, const char *at,
                           const char *expected) {
    const struct text_place place = mf_text_file_place(text, at);
    const unsigned char c = (unsigned char)*at;
    char found[32];
    if (c == '\0')
        snprintf(found, sizeof found, "the end of the file");
    else if (c == '/' || c == '#')
        snprintf(found, sizeof found, "'%c' (JSON has no comments)", c);
    else
        snprintf(found, sizeof found, c > ' ' && c < 127 ? "'%c'" : "byte 0x%02x", c);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu:%zu: expected %s, found %s", file, place.line,
                          place.column, expected, found);
}

/// Whether the value of a key and the digits behind its comma stand before, as in "key": 298,5.
static bool is_after_decimal_comma(const char *text, const char *at) {
    const char *first = find_before(text, at);
    int commas = 0;
    if (first == NULL || !isdigit((unsigned char)*first) || *at == ':')
        return false;
    for (; first > text && (isdigit((unsigned char)*first) || strchr(",-.", *first)); first--)
        commas += *first == ',';
    if (isspace((unsigned char)*first))
        first = find_before(text, first);
    return commas == 1 && first && *first == ':';
}

/// In words, by where cJSON has stopped and what stands before that.
static enum status fail_where_it_ended(const char *file, const char *text, const char *end) {
    if (is_open_text(text, end))
        return fail_at(file, text, end - 1, "a text with a '\"' at its end, too");
    if (*end == '\\')
        return fail_at(file, text, end, "an escape such as \\n or \\u00e9");
    if (is_after_decimal_comma(text, end))
        return fail_at(file, text, end, "a key after the comma (a decimal comma? JSON has points)");
    const bool after_key = is_after_key(text, end);
    const char *at = after_key ? end - 1 : end, *before = find_before(text, at);
    if (before && *before == ',' && strchr("}]", *at)) // also the end of the file
        return fail_at(file, text, at, "something after the last comma");
    if (after_key || (before && *before == '{'))
        return fail_at(file, text, at, "a key in double quotes");
    if (before == NULL || strchr(":[,", *before))
        return fail_at(file, text, at, "a value");
    return fail_at(file, text, at, "',', ':' or a closing bracket (is one, or a '\"', missing?)");
}

/// cJSON reads digits that are none as 0, and ends a text at a 0.
static enum status check_escapes(const char *file, const char *text) {
    for (const char *c = strchr(text, '\\'); c && c[1]; c = strchr(c + 2, '\\'))
        if (c[1] == 'u' &&
            (strspn(c + 2, "0123456789abcdefABCDEF") < 4 || strncmp(c + 2, "0000", 4) == 0))
            return fail_at(file, text, c, "\\u and four hexadecimal digits, not all 0");
    return STATUS_OK;
}

/// Whether there are rows of numbers below comments, if any, of "#" or of an .xvg file.
static bool is_table(const char *text) {
    text += strspn(text, spaces);
    while (*text == '#' || *text == '@') {
        text += strcspn(text, "\r\n");
        text += strspn(text, spaces);
    }
    text += *text == '-';
    return *text >= '0' && *text <= '9';
}

/// What a table is for stands in a JSON file.
static enum status fail_as_table(const char *file) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: a table, not JSON: it is named in a JSON file, as {\"target\": "
                          "{\"rdf\": {\"file\": \"%s\"}}, \"scene\": {\"density\": ..., "
                          "\"temperature\": ...}} for a fit, or as {\"law\": \"table\", \"file\": "
                          "\"%s\"} in a scene",
                          file, file, file);
}

enum status mf_json_parse(const char *file, const char *text, struct cJSON **root) {
    const char *end = text;
    *root = NULL;
    TRY(check_escapes(file, text));
    errno = 0;
    cJSON *parsed = cJSON_ParseWithOpts(text, &end, false);
    if (parsed == NULL && errno == ENOMEM)
        return mf_status_fail(STATUS_NO_MEMORY, "%s: out of memory", file);
    if (parsed == NULL)
        return is_table(text) ? fail_as_table(file) : fail_where_it_ended(file, text, end);
    end += strspn(end, spaces);
    if (*end != '\0') {
        cJSON_Delete(parsed);
        if (is_table(text))
            return fail_as_table(file);
        return fail_at(file, text, end, "nothing after the document");
    }
    *root = parsed;
    return STATUS_OK;
}
