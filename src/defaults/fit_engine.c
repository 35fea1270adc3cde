// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_engine.h"

#include "defaults/fit_states.h"
#include "forces/many_body.h"

#include <string.h>

/// What the types are called there: an object of names of the engine, each with one of ours.
static void read_types(struct fit_file *fit, struct json_object *object) {
    const struct composition *composition = &fit->scene.setup.composition;
    struct json_object types = mf_json_child(object, "types", false);
    if (types.item == NULL)
        return;
    const char *known[COMPOSITION_MAX_TYPES + 1] = {NULL}, *key;
    for (int type = 0; type < composition->types; type++)
        known[type] = composition->name[type];
    for (size_t n = 0; (key = mf_json_key(&types, n)) != NULL; n++) {
        const char *name = mf_json_choice(&types, key, known, NULL);
        for (int type = 0; name && type < composition->types; type++) {
            if (strcmp(name, composition->name[type]) != 0)
                continue;
            if (fit->engine.type[type][0])
                mf_json_fault(&types, key, "\"%s\" is \"%s\" already", name,
                              fit->engine.type[type]);
            if (strlen(key) >= sizeof fit->engine.type[type])
                mf_json_fault(&types, key, "expected a name of at most %zu letters",
                              sizeof fit->engine.type[type] - 1);
            snprintf(fit->engine.type[type], sizeof fit->engine.type[type], "%s", key);
        }
    }
    mf_json_finish(&types);
}

void mf_fit_engine_read(struct fit_file *fit, struct json_object *root) {
    struct engine_settings *engine = &fit->engine;
    struct json_object object = mf_json_child_of(root, "engine", false, "name");
    mf_json_fields(&object, mf_sampling_engine_fields, engine);
    if (object.item == NULL)
        return;
    read_types(fit, &object);
    if (engine->kind == ENGINE_COMMAND && !engine->frames[0])
        mf_json_fault(&object, "frames", "missing: the trajectory that the command leaves");
    if (engine->kind != ENGINE_COMMAND && engine->frames[0])
        mf_json_fault(&object, "frames", "it is for the engine \"command\"");
    if (engine->kind != ENGINE_LAMMPS && engine->input[0])
        mf_json_fault(&object, "input", "it is for the engine \"lammps\"");
    if (engine->input[0] && engine->time_step > 0)
        mf_json_fault(&object, "time_step", "the \"input\" sets it");
    mf_json_finish(&object);
}

void mf_fit_engine_write(const struct fit_file *fit, struct json_writer *writer) {
    const struct composition *composition = &fit->scene.setup.composition;
    if (fit->engine.kind == ENGINE_NONE)
        return;
    mf_json_begin(writer, "engine");
    mf_json_write_fields(writer, mf_sampling_engine_fields, &fit->engine);
    mf_json_begin(writer, "types");
    for (int type = 0; type < composition->types; type++)
        if (fit->engine.type[type][0])
            mf_json_write_text(writer, fit->engine.type[type], composition->name[type]);
    mf_json_end(writer);
    mf_json_end(writer);
}

static enum status refuse(const char *file, const char *why) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: engine: %s", file, why);
}

enum status mf_fit_engine_check(const struct fit_file *fit, const char *file) {
    const struct simulation_setup *setup = &fit->scene.setup;
    if (fit->engine.kind == ENGINE_NONE)
        return STATUS_OK;
    if (fit->method->kind != INVERSE_INVERSION)
        return refuse(file, "it samples for inversions alone: \"auto\", \"imc\", \"ibi\", \"hnc\", "
                            "\"relative-entropy\"");
    if (mf_fit_states_count(fit) > 1)
        return refuse(file, "of several \"states\" each would be a system of its own; fit one");
    if (mf_many_body_find(setup->interaction, setup->interactions))
        return refuse(file, "local densities (\"many_body\") are sampled by mesofit alone");
    return STATUS_OK;
}
