// SPDX-License-Identifier: GPL-3.0-or-later
//
// What an energy of local densities and the potential of pairs have in common.
#include "base/memory.h"
#include "problem/potential_grid.h"

#include <math.h>

/// The group of local densities whose slope pairs have, or NULL.
static const struct potential_group *find_density(const struct potential_grid *grid,
                                                  size_t *first) {
    *first = grid->pairs_known;
    for (size_t g = 0; g < grid->groups; *first += grid->group[g++].own.known)
        if (grid->group[g].own.is_level)
            return &grid->group[g];
    return NULL;
}

/// ⟨ρ⟩ and its variance by the target.
static void find_moments(const struct bonded_grid *own, const double *rho, double *mean,
                         double *variance) {
    const double sum = mf_bonded_grid_mean(own) * (double)own->known;
    *mean = *variance = 0;
    for (size_t a = 0; a < own->known; a++)
        *mean += own->target[own->first + a] / sum * rho[a];
    for (size_t a = 0; a < own->known; a++)
        *variance += own->target[own->first + a] / sum * pow(rho[a] - *mean, 2);
}

enum status mf_potential_grid_find_shared(struct potential_grid *grid,
                                          const struct inverse_problem *problem) {
    size_t first;
    const struct potential_group *group = find_density(grid, &first);
    if (group == NULL)
        return STATUS_OK;
    const struct bonded_grid *own = &group->own;
    const struct simulation_setup *scene = &problem->scene;
    const struct many_body *many_body = mf_many_body_find(scene->interaction, scene->interactions);
    const double sum = mf_bonded_grid_mean(own) * (double)own->known;
    const double *rho = grid->r + group->point + own->below; // of the known bins
    double mean, variance;
    TRY_ARRAY(grid->shared.change, grid->known);
    TRY_ARRAY(grid->shared.weight, grid->known);
    find_moments(own, rho, &mean, &variance);
    for (size_t a = 0; a < grid->pairs_known; a++) {
        double w;
        mf_weight_evaluate(&many_body->term[own->unknown->group].weight,
                           grid->r[grid->known_point[a]], &w, NULL);
        grid->shared.change[a] = -2 * w;
    }
    for (size_t a = 0; a < own->known; a++) {
        const double off = rho[a] - mean;
        grid->shared.change[first + a] = off;
        grid->shared.weight[first + a] = own->target[own->first + a] / sum * off / variance;
    }
    return STATUS_OK;
}

void mf_potential_grid_remove_shared(const struct potential_grid *grid, double *phi) {
    double part = 0;
    if (grid->shared.change == NULL)
        return;
    for (size_t a = 0; a < grid->known; a++)
        part += grid->shared.weight[a] * phi[grid->known_point[a]];
    for (size_t a = 0; a < grid->known; a++)
        phi[grid->known_point[a]] -= part * grid->shared.change[a];
}
