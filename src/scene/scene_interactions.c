// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_interactions.h"

/// A vector has a number for each axis: one too many would act on nothing, one too few leave an
/// axis free.
static void check_vectors(struct json_object *object, const struct field *fields, int dimensions) {
    for (const struct field *field = fields; field->name; field++) {
        const int count = mf_json_count(object, field->name);
        if (field->type == FIELD_LENGTHS && (count == 2 || count == 3) && count != dimensions)
            mf_json_fault(object, field->name, "has %d numbers, but the scene has %d dimensions",
                          count, dimensions);
    }
}

static enum status read_one(struct scene_interactions *interactions, struct json_object *object,
                            const struct interaction *kind) {
    struct json_object own = mf_json_child(object, kind->name, false);
    if (own.item == NULL)
        return STATUS_OK;
    void *parameters = mf_memory_zeroed(1, kind->parameters_size);
    if (parameters == NULL)
        return STATUS_NO_MEMORY;
    mf_json_fields(&own, kind->fields, parameters);
    check_vectors(&own, kind->fields, interactions->dimensions);
    if (kind->oriented && interactions->dimensions != 2)
        mf_json_fault(object, kind->name, "orientations are of two dimensions, not %d",
                      interactions->dimensions);
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
    interactions->dimensions = setup->box.dimensions;
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

/// Vectors with a number for each axis, be it 0.
static void write_field(const struct field *field, const char *parameters, int dimensions,
                        struct json_writer *writer) {
    const struct field one[] = {*field, FIELD_END};
    double vector[3];
    if (field->type != FIELD_LENGTHS) {
        mf_json_write_fields(writer, one, parameters);
        return;
    }
    memcpy(vector, parameters + field->offset, sizeof vector);
    mf_json_write_quantities(writer, field->name, field->unit, vector, (size_t)dimensions);
}

void mf_scene_interactions_write(const struct scene_interactions *interactions,
                                 struct json_writer *writer) {
    if (interactions->count == 0)
        return;
    mf_json_begin(writer, "interactions");
    for (int k = 0; k < interactions->count; k++) {
        const struct interaction *kind = interactions->choice[k].kind;
        mf_json_begin(writer, kind->name);
        for (const struct field *field = kind->fields; field->name; field++)
            write_field(field, interactions->parameters[k], interactions->dimensions, writer);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}
