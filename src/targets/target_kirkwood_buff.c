// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_files.h"

#include "scene/scene_law.h"

#include <math.h>

/// Of one pair [λ^d].
struct target_kirkwood_buff_number {
    double value, error;
};

#define NUMBER(name) .offset = offsetof(struct target_kirkwood_buff_number, name)
static const struct field number_fields[] = {
    {"value", FIELD_NUMBER, NUMBER(value), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "lambda^d",
     .help = "integral of g - 1 over all space; of a mixture by pairs of components, as \"A-B\""},
    {"error", FIELD_NUMBER, NUMBER(error), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda^d", .help = "standard error"},
    FIELD_END,
};

static void read_number(struct target_kirkwood_buff *target, int pair, struct json_object *object) {
    struct target_kirkwood_buff_number number = {NAN, NAN};
    mf_json_fields(object, number_fields, &number);
    target->value[pair] = number.value;
    target->error[pair] = number.error;
}

/// The components of the scene.
static enum status complete(struct target_files *files, int kind, struct json_object *object,
                            const struct target_scene *scene) {
    struct target_kirkwood_buff *target = files->own[kind];
    const struct composition *composition = &files->composition;
    const struct topology *topology = scene->molecules ? &scene->molecules->topology : NULL;
    if (mf_components_find(&target->components, composition,
                           (size_t)mf_composition_particles(composition), topology) != STATUS_OK)
        mf_json_fault(object, NULL, "%s", mf_status_marked());
    return STATUS_OK;
}

/// Faults, as a pair that is not there or no error, go to the document.
static enum status read(struct target_files *files, int kind, struct json_object *object,
                        const struct target_scene *scene) {
    struct target_kirkwood_buff *target = files->own[kind];
    const struct composition *composition = &files->composition;
    const struct composition *components = &target->components;
    const size_t faults = mf_json_fault_count(object->document);
    char name[COMPOSITION_MAX_PAIRS][COMPOSITION_PAIR_NAME_SIZE]; // remembered until it is finished
    const char *key[COMPOSITION_MAX_PAIRS];
    size_t named = 0;
    if (composition->types == 0)
        return STATUS_OK; // a fault of the types is told, those of their pairs would mislead
    TRY(complete(files, kind, object, scene));
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    target->pairs = (size_t)mf_composition_pairs(components);
    for (size_t pair = 0; pair < target->pairs; pair++)
        target->value[pair] = target->error[pair] = NAN;
    if (!composition_is_mixed(components)) {
        if (mf_scene_pair_names_refuse(object, components, "{\"value\": …, \"error\": …}"))
            return STATUS_OK;
        read_number(target, 0, object);
        mf_json_finish(object);
        return STATUS_OK;
    }
    const bool known = mf_scene_pair_names_find(object, components, key);
    for (size_t pair = 0; pair < target->pairs; pair++) {
        mf_composition_pair_name(components, (int)pair, name[pair]);
        mf_json_has(object, name[pair]);
        if (key[pair] == NULL)
            continue;
        struct json_object child = mf_json_child_of(object, key[pair], true, "value");
        if (child.item)
            read_number(target, (int)pair, &child);
        mf_json_finish(&child);
        named++;
    }
    if (named == 0 && known) {
        mf_json_fault(object, NULL,
                      "expected pairs of the scene's components, such as {\"%s-%s\": {\"value\": "
                      "0.1, \"error\": 0.01}}",
                      components->name[0], components->name[1]);
        return STATUS_OK;
    }
    mf_json_finish(object);
    return STATUS_OK;
}

static void write(const struct target_files *files, int kind, struct json_writer *writer) {
    const struct target_kirkwood_buff *target = files->own[kind];
    for (size_t pair = 0; pair < target->pairs; pair++) {
        const struct target_kirkwood_buff_number number = {target->value[pair],
                                                           target->error[pair]};
        char name[COMPOSITION_PAIR_NAME_SIZE];
        if (isnan(number.value))
            continue;
        mf_composition_pair_name(&target->components, (int)pair, name);
        if (target->pairs > 1)
            mf_json_begin(writer, name);
        mf_json_write_fields(writer, number_fields, &number);
        if (target->pairs > 1)
            mf_json_end(writer);
    }
}

static struct target values(const struct target_files *files, int kind) {
    const struct target_kirkwood_buff *target = files->own[kind];
    return (struct target){.count = target->pairs, .value = target->value, .error = target->error};
}

const struct target_record mf_target_kirkwood_buff = {
    .topic = "kirkwood_buff-target",
    .summary = "\"kirkwood_buff\": Kirkwood and Buff's integrals, of a mixture by pairs of "
               "components",
    .chief = "value",
    .fields = {number_fields, mf_kirkwood_buff_observable_fields, mf_target_files_use_fields},
    .form = OBSERVABLE_OWN_FORM,
    .kinds = {"kirkwood_buff"},
    .size = sizeof(struct target_kirkwood_buff),
    .read = read,
    .complete = complete,
    .write = write,
    .values = values,
};
