// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/unknowns.h"

#include "base/memory.h"
#include "problem/group_kind.h"
#include "problem/numbers.h"

#include <stdio.h>

enum status mf_unknowns_init(struct unknowns *unknowns, const struct inverse_problem *problem) {
    *unknowns = (struct unknowns){.problem = problem};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct unknown_parameters *p = &problem->unknown[kind].parameters;
        if (unknown_is_omega(kind))
            mf_omega_grid_init(&unknowns->omega[kind], p->inner_cutoff, p->cutoff);
    }
    return problem->unknown[UNKNOWN_POTENTIAL].wanted || problem->bonded > 0
               ? mf_potential_grid_init(&unknowns->potential, problem)
               : STATUS_OK;
}

void mf_unknowns_clear(struct unknowns *unknowns) {
    mf_potential_grid_clear(&unknowns->potential);
    *unknowns = (struct unknowns){0};
}

size_t mf_unknowns_points(const struct unknowns *unknowns, enum unknown_kind kind) {
    const struct potential_grid *grid = &unknowns->potential;
    if (!unknowns->problem->unknown[kind].wanted)
        return 0;
    return kind == UNKNOWN_POTENTIAL ? grid->pair_points
           : kind == UNKNOWN_BONDED  ? grid->points - grid->pair_points
                                     : OMEGA_POINTS;
}

const double *mf_unknowns_r(const struct unknowns *unknowns, enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? unknowns->potential.r
           : kind == UNKNOWN_BONDED  ? unknowns->potential.r + unknowns->potential.pair_points
                                     : unknowns->omega[kind].r;
}

size_t mf_unknowns_curve_count(const struct unknowns *unknowns, enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? unknowns->potential.pairs
           : kind == UNKNOWN_BONDED  ? unknowns->potential.groups
                                     : 1;
}

bool mf_unknowns_is_sought(const struct unknowns *unknowns, enum unknown_kind kind, size_t curve) {
    return kind != UNKNOWN_POTENTIAL || unknowns->potential.known_of[curve] > 0;
}

struct unknowns_part mf_unknowns_part(const struct unknowns *unknowns, enum unknown_kind kind,
                                      size_t curve) {
    const struct potential_grid *grid = &unknowns->potential;
    if (kind == UNKNOWN_BONDED)
        return (struct unknowns_part){grid->group[curve].point - grid->pair_points,
                                      grid->group[curve].own.points};
    const size_t each =
        mf_unknowns_points(unknowns, kind) / mf_unknowns_curve_count(unknowns, kind);
    return (struct unknowns_part){curve * each, each};
}

/// Whether a point of the groups is one of those that a target knows.
static bool fits_group(const struct potential_grid *grid, size_t point) {
    for (size_t g = 0; g < grid->groups; g++) {
        const size_t first = grid->group[g].point + grid->group[g].own.below;
        if (point >= first && point < first + grid->group[g].own.known)
            return true;
    }
    return false;
}

bool mf_unknowns_fits(const struct unknowns *unknowns, enum unknown_kind kind, size_t point) {
    const struct potential_grid *grid = &unknowns->potential;
    if (kind == UNKNOWN_BONDED)
        return fits_group(grid, grid->pair_points + point);
    const size_t each = mf_unknowns_part(unknowns, kind, 0).points;
    return point % each + 1 < each &&
           !(kind == UNKNOWN_POTENTIAL && mf_potential_grid_in_core(grid, point));
}

const char *mf_unknowns_heading(const struct unknowns *unknowns, enum unknown_kind kind,
                                size_t curve) {
    if (kind != UNKNOWN_BONDED)
        return "r[lambda]";
    const int order = unknowns->potential.group[curve].own.unknown->order;
    return mf_observable_kind(mf_group_kind_target(order)).target->argument;
}

const char *mf_unknowns_unit(enum unknown_kind kind) {
    return unknown_is_omega(kind) ? "sqrt(mu/tau)" : "k_B.T_0";
}

void mf_unknowns_kind_name(const struct unknowns *unknowns, enum unknown_kind kind,
                           char name[UNKNOWNS_NAME_SIZE]) {
    const int mode = kind - UNKNOWN_MEMORY;
    const bool remembers = mode >= 0 && mode < PAIR_MEMORY_MAX_MODES;
    snprintf(name, UNKNOWNS_NAME_SIZE, "%s%s%s", mf_inverse_unknown_names[kind],
             remembers ? "_" : "", remembers ? unknowns->problem->mode[mode] : "");
}

void mf_unknowns_curve_name(const struct unknowns *unknowns, enum unknown_kind kind, size_t curve,
                            char name[UNKNOWNS_NAME_SIZE]) {
    char pair[COMPOSITION_PAIR_NAME_SIZE] = "", own[UNKNOWNS_NAME_SIZE];
    if (kind == UNKNOWN_BONDED) {
        const struct bonded_unknown *group = unknowns->potential.group[curve].own.unknown;
        snprintf(name, UNKNOWNS_NAME_SIZE, "%s_%s", mf_group_kind_file(group->order),
                 mf_group_kind_group(&unknowns->problem->scene, group));
        return;
    }
    mf_unknowns_kind_name(unknowns, kind, own);
    if (kind == UNKNOWN_POTENTIAL)
        mf_composition_pair_name(&unknowns->problem->scene.composition, (int)curve, pair);
    snprintf(name, UNKNOWNS_NAME_SIZE, "%.*s%s%s", UNKNOWNS_NAME_SIZE / 2, own, pair[0] ? "_" : "",
             pair);
}

void mf_unknowns_start(const struct unknowns *unknowns, enum unknown_kind kind, double *curve) {
    const struct unknown *unknown = &unknowns->problem->unknown[kind];
    if (kind == UNKNOWN_POTENTIAL) {
        mf_potential_grid_start_pairs(&unknowns->potential, unknowns->problem, curve);
        return;
    }
    if (kind == UNKNOWN_BONDED) {
        for (size_t g = 0; g < unknowns->potential.groups; g++)
            mf_bonded_grid_start(&unknowns->potential.group[g].own,
                                 curve + mf_unknowns_part(unknowns, kind, g).first);
        return;
    }
    const struct omega_grid *grid = &unknowns->omega[kind];
    const double middle = 0.5 * (unknown->parameters.minimum + unknown->parameters.maximum);
    for (int k = 0; k < OMEGA_POINTS; k++)
        curve[k] = unknown->start[0] ? mf_curve_value(unknown->start[0], grid->r[k])
                                     : middle * (1 - grid->r[k] / grid->cutoff);
}

bool mf_unknowns_has_start(const struct unknowns *unknowns, enum unknown_kind kind) {
    for (size_t curve = 0; curve < mf_unknowns_curve_count(unknowns, kind); curve++)
        if (unknowns->problem->unknown[kind].start[curve])
            return true;
    return false;
}

/// Let an interaction of the scene have other parameters.
static void exchange(struct simulation_setup *scene, const struct interaction *kind,
                     const void *parameters) {
    for (int k = 0; k < scene->interactions; k++)
        if (scene->interaction[k].kind == kind)
            scene->interaction[k].parameters = parameters;
}

/// The scene's molecules and local densities with the curves of the groups.
static enum status make_groups(const struct unknowns *unknowns, const double *curve,
                               struct unknowns_laws *laws) {
    struct simulation_setup *scene = &laws->problem.scene;
    const struct molecules *molecules = mf_molecules_find(scene->interaction, scene->interactions);
    const struct many_body *many_body = mf_many_body_find(scene->interaction, scene->interactions);
    laws->grid = &unknowns->potential;
    if (molecules)
        TRY(mf_potential_grid_molecules(laws->grid, curve, molecules, &laws->molecules));
    if (many_body)
        TRY(mf_potential_grid_many_body(laws->grid, curve, many_body, &laws->many_body));
    exchange(scene, &mf_molecules, &laws->molecules);
    exchange(scene, &mf_many_body, &laws->many_body);
    return STATUS_OK;
}

enum status mf_unknowns_laws_make(const struct unknowns *unknowns,
                                  const double *const curve[UNKNOWNS], const double *number,
                                  struct unknowns_laws *laws) {
    *laws = (struct unknowns_laws){0};
    TRY(mf_numbers_apply(unknowns->problem, number, &laws->problem, &laws->own));
    for (int kind = 0; kind < UNKNOWN_BONDED; kind++)
        laws->table[kind] = *mf_numbers_table_of(&laws->problem.scene, kind);
    if (curve[UNKNOWN_BONDED])
        TRY(make_groups(unknowns, curve[UNKNOWN_BONDED], laws));
    for (int kind = 0; kind < UNKNOWN_BONDED; kind++) {
        struct table *own = &laws->own.table[kind];
        if (curve[kind] == NULL)
            continue;
        TRY(kind == UNKNOWN_POTENTIAL
                ? mf_potential_grid_table(&unknowns->potential, curve[kind], own)
                : mf_omega_grid_table(&unknowns->omega[kind], curve[kind], own));
        laws->table[kind] = own;
        *mf_numbers_table_of(&laws->problem.scene, kind) = own;
    }
    return STATUS_OK;
}

void mf_unknowns_laws_clear(struct unknowns_laws *laws) {
    mf_numbers_own_clear(&laws->own);
    if (laws->grid) {
        mf_potential_grid_molecules_clear(laws->grid, &laws->molecules);
        mf_potential_grid_many_body_clear(laws->grid, &laws->many_body);
    }
}

enum status mf_unknowns_laws_start(const struct unknowns *unknowns, struct unknowns_laws *laws) {
    enum status status = STATUS_OK;
    double *curve[UNKNOWNS] = {NULL}, number[INVERSE_MAX_NUMBERS];
    *laws = (struct unknowns_laws){0};
    mf_numbers_start(unknowns->problem, number);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknowns->problem->unknown[kind].wanted) {
            NEW_ARRAY(curve[kind], mf_unknowns_points(unknowns, kind));
            mf_unknowns_start(unknowns, kind, curve[kind]);
        }
    CHECK(mf_unknowns_laws_make(unknowns, (const double *const *)curve, number, laws));
done:
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_memory_free(curve[kind]);
    return status;
}
