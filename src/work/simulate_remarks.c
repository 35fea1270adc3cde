// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_remarks.h"

#include <string.h>

struct remark {
    char line[SCENE_MANY_BODY_REMARK_SIZE];
};

/// Returns how many lines.
static int find_remarks(const struct scene *scene, const struct simulation *simulation,
                        struct remark remark[MANY_BODY_MAX_TERMS]) {
    const struct scene_many_body *many_body = &scene->many_body;
    int count = 0;
    for (int k = 0; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        for (int t = 0; use->choice.kind == &mf_many_body && t < many_body->law->terms; t++)
            count += mf_scene_many_body_remark(many_body, use->state, t, &scene->units,
                                               remark[count].line);
    }
    return count;
}

void mf_simulate_remarks_print(const struct scene *scene, const struct simulation *simulation,
                               struct progress *progress) {
    struct remark remark[MANY_BODY_MAX_TERMS];
    const int count = find_remarks(scene, simulation, remark);
    for (int k = 0; k < count; k++)
        mf_progress_print(progress, "mesofit: warning: %s", remark[k].line);
}

void mf_simulate_remarks_write(const struct scene *scene, const struct simulation *simulation,
                               struct json_writer *writer) {
    struct remark remark[MANY_BODY_MAX_TERMS];
    char text[MANY_BODY_MAX_TERMS * sizeof *remark] = "";
    const int count = find_remarks(scene, simulation, remark);
    for (int k = 0; k < count; k++)
        strcat(strcat(text, k > 0 ? "; " : ""), remark[k].line);
    if (count > 0)
        mf_json_write_text(writer, "many_body_warning", text);
}
