// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_drop.h"

#include <cJSON.h>

void mf_json_drop(const struct json_object *root, const char *parent, const char *child,
                  const char *key) {
    // A view is constant, its document is not.
    cJSON *const above = cJSON_GetObjectItemCaseSensitive((cJSON *)(uintptr_t)root->item, parent);
    cJSON *const object = cJSON_GetObjectItemCaseSensitive(above, child);
    cJSON_DeleteItemFromObjectCaseSensitive(object, key);
    if (cJSON_IsObject(object) && object->child == NULL)
        cJSON_DeleteItemFromObjectCaseSensitive(above, child);
}
