// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_memory.h"

#include "base/names.h"

#define MEMBER(name) .offset = offsetof(struct scene_memory_mode, name)
const struct field mf_scene_memory_fields[] = {
    {"time", FIELD_NUMBER, MEMBER(time), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "tau", .help = "decay time of the memory kernel"},
    {"frequency", FIELD_NUMBER, MEMBER(frequency), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "1/tau", .help = "angular frequency of the kernel; 0: no oscillation"},
    FIELD_END,
};

/// The table of a law that was read; it is negative nowhere.
static enum status tabulate(struct scene_law *law, struct json_object *object, const char *key) {
    TRY(mf_scene_law_tabulate(law, mf_table_init_omega));
    const struct table *table = &law->table;
    for (int row = 0; row < table->curves * (TABLE_INTERVALS + 1); row++)
        if (table->coefficient[2 * row] < 0) {
            const int pair = row / (TABLE_INTERVALS + 1), k = row % (TABLE_INTERVALS + 1);
            mf_json_fault(object, key, "omega is negative at r = %g" STATUS_LENGTH,
                          k / mf_table_inverse_spacing(table, pair));
            return STATUS_OK;
        }
    return STATUS_OK;
}

static enum status read_mode(struct scene_memory *memory, struct json_object *object,
                             const char *name, const struct composition *composition,
                             const struct units *units, bool open) {
    if (memory->modes == PAIR_MEMORY_MAX_MODES ||
        !mf_names_is_plain(name, "_-", SCENE_MEMORY_NAME_SIZE) || mf_names_is_reserved(name)) {
        mf_json_fault(object, name, "expected at most %d modes with names of " NAMES_OF_OTHERS,
                      PAIR_MEMORY_MAX_MODES, SCENE_MEMORY_NAME_SIZE - 1);
        return STATUS_OK;
    }
    struct json_object own = mf_json_child(object, name, true);
    if (own.item == NULL)
        return STATUS_OK;
    const int m = memory->modes;
    struct scene_law *omega = &memory->omega[m];
    mf_json_fields(&own, mf_scene_memory_fields, &memory->mode[m]);
    if (!open && !mf_json_has(&own, "omega"))
        mf_json_child(&own, "omega", true);
    TRY(mf_scene_law_read(omega, &own, "omega", mf_curve_omegas, composition, units));
    TRY(tabulate(omega, &own, "omega"));
    mf_json_finish(&own);
    if (omega->curves > 0 || open)
        strcpy(memory->name[memory->modes++], name);
    return STATUS_OK;
}

enum status mf_scene_memory_read(struct scene_memory *memory, struct json_object *scene,
                                 const struct composition *composition, const struct units *units,
                                 bool open) {
    const char *name;
    struct json_object object = mf_json_child(scene, "memory", false);
    if (object.item) {
        for (size_t n = 0; (name = mf_json_key(&object, n)); n++)
            TRY(read_mode(memory, &object, name, composition, units, open));
        mf_json_finish(&object);
    }
    TRY(mf_scene_law_read(&memory->transverse, scene, "dissipative_transverse", mf_curve_omegas,
                          composition, units));
    return tabulate(&memory->transverse, scene, "dissipative_transverse");
}

void mf_scene_memory_clear(struct scene_memory *memory) {
    for (int m = 0; m < PAIR_MEMORY_MAX_MODES; m++)
        mf_scene_law_clear(&memory->omega[m]);
    mf_scene_law_clear(&memory->transverse);
    *memory = (struct scene_memory){0};
}

struct pair_memory_law mf_scene_memory_law(const struct scene_memory *memory) {
    struct pair_memory_law law = {.modes = memory->modes};
    for (int m = 0; m < memory->modes; m++)
        law.mode[m] =
            (struct pair_memory_mode){memory->omega[m].curves ? &memory->omega[m].table : NULL,
                                      memory->mode[m].time, memory->mode[m].frequency};
    law.transverse = memory->transverse.curves ? &memory->transverse.table : NULL;
    return law;
}

void mf_scene_memory_write(const struct scene_memory *memory, const struct composition *composition,
                           struct json_writer *writer) {
    if (memory->transverse.curves)
        mf_scene_law_write(&memory->transverse, composition, writer, "dissipative_transverse");
    if (memory->modes == 0)
        return;
    mf_json_begin(writer, "memory");
    for (int m = 0; m < memory->modes; m++) {
        mf_json_begin(writer, memory->name[m]);
        mf_json_write_fields(writer, mf_scene_memory_fields, &memory->mode[m]);
        if (memory->omega[m].curves)
            mf_scene_law_write(&memory->omega[m], composition, writer, "omega");
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_scene_memory_digest(const struct scene_memory *memory, uint64_t *digest) {
    for (int m = 0; m < memory->modes; m++)
        if (memory->omega[m].curves)
            mf_scene_law_digest(&memory->omega[m], digest);
    if (memory->transverse.curves)
        mf_scene_law_digest(&memory->transverse, digest);
}
