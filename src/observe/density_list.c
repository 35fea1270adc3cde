// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/density_list.h"

#include "base/memory.h"

#include <string.h>

enum status mf_density_list_init(struct density_list *list,
                                 const struct weighted_density_settings *settings,
                                 const struct box *box, size_t count) {
    *list = (struct density_list){.settings = *settings};
    TRY(mf_particles_init(&list->particles, box, count));
    const enum status status =
        mf_neighbours_init(&list->neighbours, NEIGHBOURS_HALF, box, count, settings->cutoff, 0);
    TRY(status == STATUS_BAD_INPUT ? mf_status_prefix(status, "weighted_density.cutoff") : status);
    TRY_ARRAY(list->values, count);
    TRY_ARRAY(list->stresses, count);
    return STATUS_OK;
}

void mf_density_list_clear(struct density_list *list) {
    mf_particles_clear(&list->particles);
    mf_neighbours_clear(&list->neighbours);
    mf_memory_free(list->values);
    mf_memory_free(list->stresses);
    *list = (struct density_list){0};
}

static void add_pairs(void *context, const struct neighbours_batch *batch) {
    struct density_list *list = context;
    for (size_t k = 0; k < batch->count; k++) {
        const double squared = (double)batch->squared[k];
        const double weight = weighted_density_weight(&list->settings, squared);
        const double stress = weighted_density_stress(&list->settings, squared);
        list->values[batch->id_i[k]] += weight;
        list->values[batch->id_j[k]] += weight;
        list->stresses[batch->id_i[k]] += stress;
        list->stresses[batch->id_j[k]] += stress;
    }
}

enum status mf_density_list_find(struct density_list *list, const struct particles *from) {
    const size_t count = from->count;
    for (int d = 0; d < from->box.dimensions; d++)
        memcpy(list->particles.position[d], from->position[d], count * sizeof *from->position[d]);
    memcpy(list->particles.id, from->id, count * sizeof *from->id);
    TRY(mf_particles_join(&list->particles, from->topology));
    TRY(mf_neighbours_sort_and_build(&list->neighbours, &list->particles));
    memset(list->values, 0, count * sizeof *list->values);
    memset(list->stresses, 0, count * sizeof *list->stresses);
    mf_neighbours_visit_pairs(&list->neighbours, &list->particles, list->settings.cutoff, add_pairs,
                              list);
    return STATUS_OK;
}
