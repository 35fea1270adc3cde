// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_item.h"

#include "io/json.h"

#include <cJSON.h>

#include <stdio.h>

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
