// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/target_kirkwood_buff.h"

#include "input/pair_names.h"

#include <math.h>

#define NUMBER(name) .offset = offsetof(struct target_kirkwood_buff_number, name)
const struct field mf_target_kirkwood_buff_fields[] = {
    {"value", FIELD_NUMBER, NUMBER(value), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "lambda^d",
     .help = "integral of g - 1 over all space, of the open system; in a mixture an object for "
             "each pair of components, as \"A-B\""},
    {"error", FIELD_NUMBER, NUMBER(error), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda^d", .help = "standard error"},
    FIELD_END,
};

static void read_number(struct target_kirkwood_buff *target, int pair, struct json_object *object) {
    struct target_kirkwood_buff_number number = {NAN, NAN};
    mf_json_fields(object, mf_target_kirkwood_buff_fields, &number);
    target->value[pair] = number.value;
    target->error[pair] = number.error;
}

void mf_target_kirkwood_buff_read(struct target_kirkwood_buff *target, struct json_object *object,
                                  const struct composition *composition,
                                  const struct topology *topology) {
    const struct composition *components = &target->components;
    char name[COMPOSITION_MOST_PAIRS]
             [COMPOSITION_PAIR_NAME_SIZE]; // remembered until it is finished
    const char *key[COMPOSITION_MOST_PAIRS];
    size_t named = 0;
    *target = (struct target_kirkwood_buff){0};
    if (composition->types == 0)
        return; // a fault of the types is told, those of their pairs would mislead
    if (mf_components_find(&target->components, composition,
                           (size_t)mf_composition_particles(composition), topology) != STATUS_OK) {
        mf_json_fault(object, NULL, "%s", mf_status_message());
        return;
    }
    target->pairs = (size_t)mf_composition_pairs(components);
    for (size_t pair = 0; pair < target->pairs; pair++)
        target->value[pair] = target->error[pair] = NAN;
    if (!composition_is_mixed(components)) {
        if (mf_pair_names_refuse(object, components, "{\"value\": …, \"error\": …}"))
            return;
        read_number(target, 0, object);
        mf_json_finish(object);
        return;
    }
    const bool known = mf_pair_names_find(object, components, key);
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
        return;
    }
    mf_json_finish(object);
}

void mf_target_kirkwood_buff_write(const struct target_kirkwood_buff *target,
                                   struct json_writer *writer) {
    for (size_t pair = 0; pair < target->pairs; pair++) {
        const struct target_kirkwood_buff_number number = {target->value[pair],
                                                           target->error[pair]};
        char name[COMPOSITION_PAIR_NAME_SIZE];
        if (isnan(number.value))
            continue;
        mf_composition_pair_name(&target->components, (int)pair, name);
        if (target->pairs > 1)
            mf_json_begin(writer, name);
        mf_json_put_fields(writer, mf_target_kirkwood_buff_fields, &number);
        if (target->pairs > 1)
            mf_json_end(writer);
    }
}
