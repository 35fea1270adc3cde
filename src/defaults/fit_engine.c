// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_engine.h"

#include "defaults/fit_states.h"
#include "forces/many_body.h"
#include "observe/kirkwood_buff.h"

#include <string.h>

#define NAMES_OF_ENGINE "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-_."

/// A path is a word of a script and of LAMMPS.
static bool is_plain(const char *path) {
    bool plain = true;
    for (; *path; path++)
        plain = plain && (unsigned char)*path >= ' ' && strchr("'\"$`\\", *path) == NULL;
    return plain;
}

/// The types of the scene and their names; beads without a name are called A.
static int list_types(const struct fit_file *fit, const char *name[COMPOSITION_MAX_TYPES + 1]) {
    const struct composition *composition = &fit->scene.setup.composition;
    const int types = composition->types > 0 ? composition->types : 1;
    for (int type = 0; type < types; type++)
        name[type] =
            composition->types > 0 && composition->name[type][0] ? composition->name[type] : "A";
    name[types] = NULL;
    return types;
}

/// Note that the engine calls a type of the scene so.
static void name_type(struct json_object *types, const char *key, char *called) {
    if (called[0])
        mf_json_fault(types, key, "\"%s\" is it already", called);
    if (strspn(key, NAMES_OF_ENGINE) != strlen(key) || strlen(key) >= COMPOSITION_NAME_SIZE)
        mf_json_fault(types, key, "expected at most %d letters, digits and any of + - _ .",
                      COMPOSITION_NAME_SIZE - 1);
    snprintf(called, COMPOSITION_NAME_SIZE, "%s", key);
}

/// What the types are called there: an object of names of the engine, each with one of ours.
static void read_types(struct fit_file *fit, struct json_object *object) {
    struct json_object types = mf_json_child(object, "types", false);
    if (types.item == NULL)
        return;
    const char *known[COMPOSITION_MAX_TYPES + 1], *key;
    const int count = list_types(fit, known);
    for (size_t n = 0; (key = mf_json_key(&types, n)) != NULL; n++) {
        const char *name = mf_json_choice(&types, key, known, NULL);
        for (int type = 0; name && type < count; type++)
            if (strcmp(name, known[type]) == 0)
                name_type(&types, key, fit->engine.type[type]);
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
    if (engine->kind != ENGINE_COMMAND && engine->tables)
        mf_json_fault(&object, "tables", "it is for the engine \"command\"; LAMMPS has its own");
    if (engine->kind != ENGINE_LAMMPS && engine->input[0])
        mf_json_fault(&object, "input", "it is for the engine \"lammps\"");
    if (engine->input[0] && engine->time_step > 0)
        mf_json_fault(&object, "time_step", "the \"input\" sets it");
    if (!is_plain(engine->input) || !is_plain(engine->frames))
        mf_json_fault(&object, NULL, "a name of a file may have no quotes, $, ` or \\");
    mf_json_finish(&object);
}

void mf_fit_engine_write(const struct fit_file *fit, struct json_writer *writer) {
    const char *name[COMPOSITION_MAX_TYPES + 1];
    const int count = list_types(fit, name);
    if (fit->engine.kind == ENGINE_NONE)
        return;
    mf_json_begin(writer, "engine");
    mf_json_write_fields(writer, mf_sampling_engine_fields, &fit->engine);
    mf_json_begin(writer, "types");
    for (int type = 0; type < count; type++)
        if (fit->engine.type[type][0])
            mf_json_write_text(writer, fit->engine.type[type], name[type]);
    mf_json_end(writer);
    mf_json_end(writer);
}

bool mf_fit_engine_knows_more(const struct fit_file *fit) {
    return fit->engine.kind == ENGINE_COMMAND || fit->engine.input[0];
}

bool mf_fit_engine_verifies(const struct fit_file *fit) {
    return fit->verification.by == VERIFY_BY_ENGINE ||
           (fit->verification.by == VERIFY_BY_AUTO && mf_fit_engine_knows_more(fit));
}

bool mf_fit_engine_moves(const struct fit_file *fit) {
    return mf_fit_engine_knows_more(fit) && mf_fit_engine_verifies(fit);
}

static enum status refuse(const char *file, const char *why) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: engine: %s", file, why);
}

/// A density is one of constant pressure, which an engine of the user's own holds.
static enum status check_density(const struct fit_file *fit, const char *file) {
    const char *why = NULL;
    if (!targets_ask(&fit->problem.compared, TARGET_DENSITY))
        return STATUS_OK;
    if (fit->engine.kind == ENGINE_NONE)
        why = "mesofit samples at constant volume, where it is that of the scene; an \"engine\" "
              "that holds the pressure finds one";
    else if (!mf_fit_engine_knows_more(fit))
        why = "the LAMMPS input that is written is of constant volume; give one of your own with "
              "`fix npt` as \"input\" of \"engine\"";
    else if (targets_ask(&fit->problem.targets, TARGET_PRESSURE))
        why = "where it is a target the engine holds the pressure: leave \"pressure\" out";
    else if (targets_ask(&fit->problem.targets, mf_kirkwood_buff_kind()))
        why = "integrals of Kirkwood and Buff are those of one box; with \"fitted\": \"no\" "
              "they are compared";
    else if (fit->verification.by == VERIFY_BY_MESOFIT)
        why = "\"verification\" by mesofit is at constant volume";
    return why ? mf_status_fail(STATUS_BAD_INPUT, "%s: target.density: %s", file, why) : STATUS_OK;
}

enum status mf_fit_engine_check(const struct fit_file *fit, const char *file) {
    const struct simulation_setup *setup = &fit->scene.setup;
    TRY(check_density(fit, file));
    if (fit->engine.kind == ENGINE_NONE)
        return STATUS_OK;
    if (fit->method->kind != INVERSE_INVERSION)
        return refuse(file, "it samples for inversions alone: \"auto\", \"imc\", \"ibi\", \"hnc\", "
                            "\"relative-entropy\"");
    if (mf_fit_states_count(fit) > 1)
        return refuse(file, "of several \"states\" each would be a system of its own; fit one");
    if (fit->engine.kind == ENGINE_COMMAND && fit->problem.bonded > 0)
        return refuse(file, "a command is given potentials of pairs alone; bonds, angles and "
                            "dihedrals are found with \"lammps\" or by mesofit itself");
    if (mf_many_body_find(setup->interaction, setup->interactions))
        return refuse(file, "local densities (\"many_body\") are sampled by mesofit alone");
    return STATUS_OK;
}
