// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/target_groups.h"

#include "base/memory.h"
#include "base/nearest.h"

#include <math.h>
#include <string.h>

/// Keys of the object that are no groups (struct target_use).
static bool is_use(const char *key) {
    return strcmp(key, "weight") == 0 || strcmp(key, "fitted") == 0;
}

static void fault_unknown(const struct target_groups *groups, struct json_object *object,
                          const char *key) {
    const char *known[MOLECULES_MOST_GROUPS];
    char hint[1024];
    for (size_t g = 0; g < groups->groups; g++)
        known[g] = groups->name[g];
    mf_nearest_hint(key, known, groups->groups, hint, sizeof hint);
    mf_json_fault(object, key, "no molecule has such %s %s%s%s",
                  mf_bonded_kinds[groups->order]->article, mf_bonded_kinds[groups->order]->name,
                  groups->groups ? "; " : "", groups->groups ? hint : "");
    mf_json_has(object, key);
}

/// Values of all members, one behind the other.
static enum status collect(struct target_groups *groups) {
    enum status status = STATUS_OK;
    mf_memory_free(groups->value);
    mf_memory_free(groups->error);
    mf_memory_free(groups->block);
    groups->value = groups->error = NULL;
    groups->block = NULL;
    groups->blocks = 0;
    for (size_t g = 0; g < groups->groups; g++)
        groups->first[g + 1] = groups->first[g] + groups->member[g].bins.count;
    NEW_ARRAY(groups->value, groups->first[groups->groups]);
    NEW_ARRAY(groups->error, groups->first[groups->groups]);
    NEW_ARRAY(groups->block, groups->groups * TARGETS_MOST_BLOCKS + 1);
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
done:
    return status;
}

enum status mf_target_groups_read(struct target_groups *groups, int order,
                                  struct json_object *object, const struct molecules *molecules,
                                  const struct units *units, int dimensions) {
    enum status status = STATUS_OK;
    const char *key;
    *groups = (struct target_groups){.order = order};
    groups->groups = molecules ? (size_t)molecules->groups[order] : 0;
    NEW_ARRAY(groups->member, groups->groups);
    for (size_t g = 0; g < groups->groups; g++) {
        if (is_use(molecules->group[order][g].name))
            mf_json_fault(
                object, molecules->group[order][g].name,
                "is both a setting of the target and a group of the scene: rename the group");
        memcpy(groups->name[g], molecules->group[order][g].name, sizeof groups->name[g]);
    }
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
            CHECK(mf_target_bonded_read(&groups->member[g], order, key, &child, units, dimensions));
    }
    mf_json_finish(object);
    CHECK(collect(groups));
done:
    return status;
}

enum status mf_target_groups_widen(struct target_groups *groups, size_t group,
                                   const struct bonded_bins *bins) {
    enum status status = STATUS_OK;
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
    return collect(groups);
done:
    mf_memory_free(value);
    mf_memory_free(error);
    return status;
}

void mf_target_groups_clear(struct target_groups *groups) {
    for (size_t g = 0; g < groups->groups; g++)
        mf_target_bonded_clear(&groups->member[g]);
    mf_memory_free(groups->member);
    mf_memory_free(groups->value);
    mf_memory_free(groups->error);
    mf_memory_free(groups->block);
    *groups = (struct target_groups){0};
}

void mf_target_groups_write(const struct target_groups *groups, struct json_writer *writer) {
    for (size_t g = 0; g < groups->groups; g++) {
        if (groups->member[g].bins.count == 0)
            continue;
        mf_json_begin(writer, groups->name[g]);
        mf_json_put_fields(writer, mf_target_bonded_fields, &groups->member[g].parameters);
        mf_json_end(writer);
    }
}

struct bonded_settings mf_target_groups_settings(const struct target_groups *groups) {
    struct bonded_settings settings = {.bins = 0};
    for (size_t g = 0; g < groups->groups; g++)
        settings.target[g] = groups->member[g].bins;
    return settings;
}
