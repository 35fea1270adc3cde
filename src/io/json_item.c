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

enum status mf_json_item_check(const char *file, const void *item) {
    const cJSON *json = item, *member;
    int count = 0;
    cJSON_ArrayForEach(member, json) {
        count++;
        if (member->child)
            TRY(mf_json_item_check(file, member));
    }
    if (cJSON_IsObject(json) && count > JSON_MOST_MEMBERS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: an object has %d keys; %d are the most", file,
                              count, JSON_MOST_MEMBERS);
    return STATUS_OK;
}
