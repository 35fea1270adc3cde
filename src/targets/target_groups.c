// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_files.h"

#include "base/memory.h"
#include "base/nearest.h"

#include <math.h>
#include <string.h>

/// Keys of the object that are no groups (struct target_use).
static bool is_use(const char *key) {
    bool is = false;
    for (const struct field *field = mf_target_files_use_fields; field->name; field++)
        is = is || strcmp(key, field->name) == 0;
    return is;
}

static void fault_unknown(const struct target_groups *groups, struct json_object *object,
                          const char *key) {
    const char *known[MOLECULES_MAX_GROUPS];
    char hint[1024];
    for (size_t g = 0; g < groups->groups; g++)
        known[g] = groups->name[g];
    mf_nearest_hint(key, known, groups->groups, hint, sizeof hint);
    mf_json_fault(object, key, "no molecule has such %s %s%s%s",
                  mf_bonded_kinds[groups->order]->article, mf_bonded_kinds[groups->order]->name,
                  groups->groups ? "; " : "", groups->groups ? hint : "");
    mf_json_has(object, key);
}

/// Values of all members, one after the other.
static enum status collect(struct target_groups *groups) {
    mf_memory_free(groups->value);
    mf_memory_free(groups->error);
    mf_memory_free(groups->block);
    groups->value = groups->error = NULL;
    groups->block = NULL;
    groups->blocks = 0;
    for (size_t g = 0; g < groups->groups; g++)
        groups->first[g + 1] = groups->first[g] + groups->member[g].bins.count;
    TRY_ARRAY(groups->value, groups->first[groups->groups]);
    TRY_ARRAY(groups->error, groups->first[groups->groups]);
    TRY_ARRAY(groups->block, groups->groups * TARGETS_MAX_BLOCKS + 1);
    for (size_t g = 0; g < groups->groups; g++) {
        const struct target_bonded *member = &groups->member[g];
        const size_t bytes = member->bins.count * sizeof(double);
        if (bytes == 0)
            continue;
        memcpy(groups->value + groups->first[g], member->value, bytes);
        memcpy(groups->error + groups->first[g], member->error, bytes);
        groups->blocks += mf_targets_blocks(member->value, member->bins.count, groups->first[g],
                                            groups->block + groups->blocks);
    }
    groups->block[groups->blocks] = groups->first[groups->groups];
    return STATUS_OK;
}

/// What the observable is to measure for them.
static struct bonded_settings settings_of(const struct target_groups *groups) {
    struct bonded_settings settings = {.bins = 0};
    for (size_t g = 0; g < groups->groups; g++)
        settings.target[g] = groups->member[g].bins;
    return settings;
}

enum status mf_target_files_widen(struct target_files *files, int order, size_t group,
                                  const struct bonded_bins *bins) {
    enum status status = STATUS_OK;
    const int kind = mf_bonded_distribution_kind(order);
    struct target_groups *groups = files->own[kind];
    struct bonded_settings *settings = files->settings[mf_observable_kind(kind).place];
    struct target_bonded *member = &groups->member[group];
    const size_t before = (size_t)lround((member->bins.low - bins->low) / bins->width);
    const size_t last = member->bins.count - 1;
    double *value = NULL, *error = NULL;
    if (before == 0 && bins->count == member->bins.count)
        return STATUS_OK;
    NEW_ARRAY(value, bins->count);
    NEW_ARRAY(error, bins->count);
    for (size_t k = 0; k < bins->count; k++) {
        const bool own = k >= before && k - before <= last;
        value[k] = own ? member->value[k - before] : 0;
        error[k] = member->error[own ? k - before : k < before ? 0 : last];
    }
    mf_memory_free(member->value);
    mf_memory_free(member->error);
    member->value = value;
    member->error = error;
    member->bins = *bins;
    TRY(collect(groups));
    *settings = settings_of(groups);
    return STATUS_OK;
done:
    mf_memory_free(value);
    mf_memory_free(error);
    return status;
}

enum status mf_target_files_drop(struct target_files *files, int order, size_t group) {
    const int kind = mf_bonded_distribution_kind(order);
    struct target_groups *groups = files->own[kind];
    mf_target_bonded_clear(&groups->member[group]);
    TRY(collect(groups));
    void **const settings = &files->settings[mf_observable_kind(kind).place];
    *(struct bonded_settings *)*settings = settings_of(groups);
    if (groups->first[groups->groups] > 0)
        return STATUS_OK;
    mf_memory_free(*settings);
    *settings = NULL;
    files->given[kind] = false;
    return STATUS_OK;
}

/// By the numbers of the scene's groups.
static enum status allocate(struct target_groups *groups, struct json_object *object,
                            const struct molecules *molecules) {
    const int order = groups->order;
    groups->groups = molecules ? (size_t)molecules->groups[order] : 0;
    TRY_ARRAY(groups->member, groups->groups);
    for (size_t g = 0; g < groups->groups; g++) {
        if (is_use(molecules->group[order][g].name))
            mf_json_fault(
                object, molecules->group[order][g].name,
                "is both a setting of the target and a group of the scene: rename the group");
        memcpy(groups->name[g], molecules->group[order][g].name, sizeof groups->name[g]);
    }
    return STATUS_OK;
}

static enum status read(struct target_files *files, int kind, struct json_object *object,
                        const struct target_scene *scene) {
    struct target_groups *groups = files->own[kind];
    struct bonded_settings *settings = mf_memory_zeroed(1, sizeof *settings);
    const char *key;
    if (settings == NULL)
        return STATUS_NO_MEMORY;
    files->settings[mf_observable_kind(kind).place] = settings;
    if (files->composition.types == 0)
        return STATUS_OK; // a fault of the molecules is told, those of their groups would mislead
    groups->order = mf_bonded_distribution_order(kind);
    TRY(allocate(groups, object, scene->molecules));
    for (size_t n = 0; (key = mf_json_key(object, n)); n++) {
        size_t g = 0;
        while (g < groups->groups && strcmp(groups->name[g], key) != 0)
            g++;
        if (is_use(key))
            continue;
        if (g == groups->groups) {
            fault_unknown(groups, object, key);
            continue;
        }
        struct json_object child = mf_json_child_of(object, key, true, "file");
        if (child.item)
            TRY(mf_target_bonded_read(&groups->member[g], groups->order, key, &child, scene->units,
                                      scene->box->dimensions));
    }
    mf_json_finish(object);
    TRY(collect(groups));
    *settings = settings_of(groups);
    return STATUS_OK;
}

static void clear(void *own) {
    struct target_groups *groups = own;
    for (size_t g = 0; g < groups->groups; g++)
        mf_target_bonded_clear(&groups->member[g]);
    mf_memory_free(groups->member);
    mf_memory_free(groups->value);
    mf_memory_free(groups->error);
    mf_memory_free(groups->block);
}

static void write(const struct target_files *files, int kind, struct json_writer *writer) {
    const struct target_groups *groups = files->own[kind];
    for (size_t g = 0; g < groups->groups; g++) {
        if (groups->member[g].bins.count == 0)
            continue;
        mf_json_begin(writer, groups->name[g]);
        mf_json_write_fields(writer, mf_target_bonded_fields, &groups->member[g].parameters);
        mf_json_end(writer);
    }
}

/// What the errors of all groups are of: of bins if a file has none and does not say.
static enum target_errors errors_of(const struct target_groups *groups) {
    bool samples = true;
    for (size_t g = 0; g < groups->groups; g++) {
        const struct target_bonded *member = &groups->member[g];
        if (member->bins.count == 0)
            continue;
        const bool says = member->parameters.errors_of == TARGET_ERRORS_OF_SAMPLES;
        if ((member->estimated_error > 0 && !says) ||
            member->parameters.errors_of == TARGET_ERRORS_OF_BINS)
            return TARGET_ERRORS_OF_BINS;
        samples = samples && says;
    }
    return samples ? TARGET_ERRORS_OF_SAMPLES : TARGET_ERRORS_UNKNOWN;
}

static struct target values(const struct target_files *files, int kind) {
    const struct target_groups *groups = files->own[kind];
    return (struct target){.count = groups->first[groups->groups],
                           .value = groups->value,
                           .error = groups->error,
                           .errors_of = errors_of(groups),
                           .block = groups->block,
                           .blocks = groups->blocks};
}

/// bond_lengths_backbone.tsv.
static bool find_table(const struct target_files *files, int kind, size_t g,
                       struct target_table *table) {
    const struct observable_target *about = mf_observable_kind(kind).target;
    const struct target_groups *groups = files->own[kind];
    if (g >= groups->groups)
        return false;
    *table = (struct target_table){.part = g,
                                   .first = groups->first[g],
                                   .count = groups->member[g].bins.count,
                                   .places = 1,
                                   .place = {about->argument}};
    snprintf(table->name, sizeof table->name, "%s_%s", about->name, groups->name[g]);
    return true;
}

static void find_place(const struct target_files *files, int kind, const struct target_table *table,
                       size_t k, double at[2]) {
    const struct target_groups *groups = files->own[kind];
    at[0] = bonded_bins_centre(&groups->member[table->part].bins, k);
}

#define KEY(NAME, kind, beads, key, ...) #key,

const struct target_record mf_target_groups = {
    .topic = "distribution-target",
    .summary = "one group of \"bond_lengths\", \"bond_angles\" and \"dihedral_angles\", as "
               "\"backbone\"",
    .chief = "file",
    .fields = {mf_target_bonded_fields},
    .form = OBSERVABLE_OWN_FORM,
    .kinds = {BONDED_LIST(KEY)},
    .size = sizeof(struct target_groups),
    .read = read,
    .clear = clear,
    .write = write,
    .values = values,
    .table = find_table,
    .place = find_place,
};
