// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/group_kind.h"

int mf_group_kind_target(int order) {
    return order == INVERSE_LOCAL_DENSITY ? mf_weighted_density_kind()
                                          : mf_bonded_distribution_kind(order);
}

bool mf_group_kind_is_periodic(int order) {
    return order != INVERSE_LOCAL_DENSITY && mf_bonded_kinds[order]->periodic;
}

bool mf_group_kind_is_length(int order) {
    return order != INVERSE_LOCAL_DENSITY && mf_bonded_kinds[order]->is_length;
}

bool mf_group_kind_is_possible(int order, double value) {
    static const double rounding = 1e-6;
    if (order == INVERSE_LOCAL_DENSITY)
        return value >= 0;
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    return kind->periodic || (value > kind->low && value <= kind->high * (1 + rounding));
}

double mf_group_kind_jacobian(int order, int dimensions, const struct bonded_bins *bins,
                              size_t bin) {
    return order == INVERSE_LOCAL_DENSITY
               ? 1
               : mf_bonded_distribution_jacobian(order, dimensions, bins, bin);
}

size_t mf_group_kind_terms(const struct topology *topology, const struct bonded_unknown *unknown,
                           size_t beads) {
    if (unknown->order == INVERSE_LOCAL_DENSITY)
        return beads;
    return mf_bonded_distribution_terms(topology, unknown->order, unknown->group);
}

const struct weighted_density_settings *mf_group_kind_density(const struct targets *targets) {
    return targets->settings[mf_observable_kind(mf_weighted_density_kind()).place];
}

const char *mf_group_kind_name(int order) {
    return order == INVERSE_LOCAL_DENSITY ? "local density" : mf_bonded_kinds[order]->name;
}

const char *mf_group_kind_file(int order) {
    return order == INVERSE_LOCAL_DENSITY ? "many_body" : mf_bonded_kinds[order]->plural;
}

const char *mf_group_kind_group(const struct simulation_setup *scene,
                                const struct bonded_unknown *unknown) {
    if (unknown->order == INVERSE_LOCAL_DENSITY)
        return mf_many_body_find(scene->interaction, scene->interactions)
            ->term[unknown->group]
            .name;
    return mf_molecules_find(scene->interaction, scene->interactions)
        ->group[unknown->order][unknown->group]
        .name;
}
