// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/scene_interactions.h"

static enum status read_one(struct scene_interactions *interactions, struct json_object *object,
                            const struct interaction *kind) {
    struct json_object own = mf_json_child(object, kind->name, false);
    if (own.item == NULL)
        return STATUS_OK;
    void *parameters = mf_memory_zeroed(1, kind->parameters_size);
    if (parameters == NULL)
        return STATUS_NO_MEMORY;
    mf_json_fields(&own, kind->fields, parameters);
    mf_json_finish(&own);
    interactions->parameters[interactions->count] = parameters;
    interactions->choice[interactions->count++] = (struct interaction_choice){kind, parameters};
    return STATUS_OK;
}

enum status mf_scene_interactions_read(struct scene_interactions *interactions,
                                       struct json_object *parent, struct simulation_setup *setup) {
    struct json_object object = mf_json_child(parent, "interactions", false);
    if (object.item == NULL)
        return STATUS_OK;
    for (size_t k = 0; mf_interaction_list[k]; k++)
        TRY(read_one(interactions, &object, mf_interaction_list[k]));
    mf_json_finish(&object);
    memcpy(setup->interaction, interactions->choice, sizeof interactions->choice);
    setup->interactions = interactions->count;
    return STATUS_OK;
}

void mf_scene_interactions_clear(struct scene_interactions *interactions) {
    for (int k = 0; k < interactions->count; k++)
        mf_memory_free(interactions->parameters[k]);
    *interactions = (struct scene_interactions){0};
}

void mf_scene_interactions_write(const struct scene_interactions *interactions,
                                 struct json_writer *writer) {
    if (interactions->count == 0)
        return;
    mf_json_begin(writer, "interactions");
    for (int k = 0; k < interactions->count; k++) {
        mf_json_begin(writer, interactions->choice[k].kind->name);
        mf_json_put_fields(writer, interactions->choice[k].kind->fields,
                           interactions->parameters[k]);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}
