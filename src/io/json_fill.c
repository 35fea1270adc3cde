// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_fill.h"

#include "base/memory.h"
#include "io/json.h"
#include "io/json_document.h"

#include <cJSON.h>
#include <string.h>

static enum status add(const char *file, cJSON *root, const char *object,
                       const struct json_filling *filling) {
    cJSON *place = object ? cJSON_GetObjectItemCaseSensitive(root, object) : root;
    if (place == NULL)
        place = cJSON_AddObjectToObject(root, object);
    if (place == NULL)
        return STATUS_NO_MEMORY;
    if (!cJSON_IsObject(place)) // its reader says what should stand there
        return STATUS_OK;
    if (cJSON_GetObjectItemCaseSensitive(place, filling->key))
        return mf_status_fail(STATUS_BAD_INPUT, "--%s: %s has %s%s%s", filling->key, file,
                              object ? object : "", object ? "." : "", filling->key);
    const cJSON *added = filling->text
                             ? cJSON_AddStringToObject(place, filling->key, filling->text)
                             : cJSON_AddNumberToObject(place, filling->key, filling->value);
    return added ? STATUS_OK : STATUS_NO_MEMORY;
}

enum status mf_json_fill(const char *file, const char *object, const struct json_filling *filling,
                         size_t count, char **text) {
    enum status status = STATUS_OK;
    struct json_document *document;
    char *printed = NULL;
    *text = NULL;
    TRY(mf_json_open(&document, file));
    for (size_t k = 0; status == STATUS_OK && k < count; k++)
        status = add(file, document->root, object, &filling[k]);
    if (status == STATUS_OK)
        printed = cJSON_Print(document->root);
    status = mf_json_close(document, status);
    CHECK(status);
    CHECK(printed ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(*text, strlen(printed) + 1);
    memcpy(*text, printed, strlen(printed) + 1);
done:
    cJSON_free(printed);
    return status;
}
