// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/heading.h"

#define MEMBER(name) .offset = offsetof(struct heading, name)
const struct field mf_heading_fields[] = {
    {"title", FIELD_TEXT, MEMBER(title), .unit = "", .help = "one line of text"},
    {"seed", FIELD_SEED, MEMBER(seed), .initial = 1, .minimum = 0, .maximum = FIELD_LARGEST_INTEGER,
     .unit = "", .help = "seed of all random numbers"},
    FIELD_END,
};

/// Without the reader learning of the key.
static bool has(struct json_object root, const char *key) {
    return mf_json_has(&root, key);
}

enum status mf_heading_check_scene(const struct json_object *root, const char *file) {
    if (!has(*root, "states") && (!has(*root, "scene") || !has(*root, "target")))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: this is a run file, with a scene and a target; use: mesofit fit %s",
                          file, file);
}

enum status mf_heading_check_run(const struct json_object *root, const char *file) {
    if (has(*root, "scene") || has(*root, "target") || has(*root, "states") || !has(*root, "box"))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: this is a scene file, without a target; use: mesofit simulate %s",
                          file, file);
}
