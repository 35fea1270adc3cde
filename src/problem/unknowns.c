// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/unknowns.h"

#include "base/memory.h"
#include "problem/numbers.h"

#include <stdio.h>

enum status mf_unknowns_init(struct unknowns *unknowns, const struct inverse_problem *problem) {
    *unknowns = (struct unknowns){.problem = problem};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct unknown_parameters *p = &problem->unknown[kind].parameters;
        if (unknown_is_omega(kind))
            mf_omega_grid_init(&unknowns->omega[kind], p->inner_cutoff, p->cutoff);
    }
    return problem->unknown[UNKNOWN_POTENTIAL].wanted
               ? mf_potential_grid_init(&unknowns->potential, problem)
               : STATUS_OK;
}

void mf_unknowns_clear(struct unknowns *unknowns) {
    mf_potential_grid_clear(&unknowns->potential);
    *unknowns = (struct unknowns){0};
}

size_t mf_unknowns_points(const struct unknowns *unknowns, enum unknown_kind kind) {
    if (!unknowns->problem->unknown[kind].wanted)
        return 0;
    return kind == UNKNOWN_POTENTIAL ? unknowns->potential.points : OMEGA_POINTS;
}

const double *mf_unknowns_r(const struct unknowns *unknowns, enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? unknowns->potential.r : unknowns->omega[kind].r;
}

size_t mf_unknowns_curve_count(const struct unknowns *unknowns, enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? unknowns->potential.pairs : 1;
}

size_t mf_unknowns_points_each(const struct unknowns *unknowns, enum unknown_kind kind) {
    return mf_unknowns_points(unknowns, kind) / mf_unknowns_curve_count(unknowns, kind);
}

bool mf_unknowns_fits(const struct unknowns *unknowns, enum unknown_kind kind, size_t point) {
    const size_t each = mf_unknowns_points_each(unknowns, kind);
    return point % each + 1 < each &&
           !(kind == UNKNOWN_POTENTIAL && mf_potential_grid_in_core(&unknowns->potential, point));
}

const char *mf_unknowns_unit(enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? "k_B.T_0" : "sqrt(mu/tau)";
}

void mf_unknowns_kind_name(const struct unknowns *unknowns, enum unknown_kind kind,
                           char name[UNKNOWNS_NAME_SIZE]) {
    const int mode = kind - UNKNOWN_MEMORY;
    const bool remembers = mode >= 0 && mode < PAIR_MEMORY_MOST_MODES;
    snprintf(name, UNKNOWNS_NAME_SIZE, "%s%s%s", mf_inverse_unknown_names[kind],
             remembers ? "_" : "", remembers ? unknowns->problem->mode[mode] : "");
}

void mf_unknowns_curve_name(const struct unknowns *unknowns, enum unknown_kind kind, size_t curve,
                            char name[UNKNOWNS_NAME_SIZE]) {
    char pair[COMPOSITION_PAIR_NAME_SIZE] = "", own[UNKNOWNS_NAME_SIZE];
    mf_unknowns_kind_name(unknowns, kind, own);
    if (kind == UNKNOWN_POTENTIAL)
        mf_composition_pair_name(&unknowns->problem->scene.composition, (int)curve, pair);
    snprintf(name, UNKNOWNS_NAME_SIZE, "%.*s%s%s", UNKNOWNS_NAME_SIZE / 2, own, pair[0] ? "_" : "",
             pair);
}

void mf_unknowns_start(const struct unknowns *unknowns, enum unknown_kind kind, double *curve) {
    const struct unknown *unknown = &unknowns->problem->unknown[kind];
    if (kind == UNKNOWN_POTENTIAL) {
        mf_potential_grid_start(&unknowns->potential, unknowns->problem, curve);
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

enum status mf_unknowns_laws_make(const struct unknowns *unknowns,
                                  const double *const curve[UNKNOWNS], const double *number,
                                  struct unknowns_laws *laws) {
    *laws = (struct unknowns_laws){0};
    TRY(mf_numbers_apply(unknowns->problem, number, &laws->problem, &laws->own));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        laws->table[kind] = *mf_numbers_table_of(&laws->problem.scene, kind);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
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
}

enum status mf_unknowns_laws_start(const struct unknowns *unknowns, struct unknowns_laws *laws) {
    enum status status = STATUS_OK;
    double *curve[UNKNOWNS] = {NULL}, number[INVERSE_MOST_NUMBERS];
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
