// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules are shared out among blocks, as many for any number of threads, and each block adds its
// terms to the forces in an order that is the same for each bead (molecules_layout.h).
// Tested: test_molecules, physics/test_molecules.
#include "forces/molecules.h"

#include "base/parallel.h"
#include "forces/molecules_layout.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct state {
    const struct molecules *molecules;
    struct molecules_layout layout;
};

// Laws --------------------------------------------------------------------------------------------

void mf_molecules_clear(struct molecules *molecules) {
    mf_topology_clear(&molecules->topology);
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++)
            mf_bonded_clear(&molecules->group[order][g].curve);
    *molecules = (struct molecules){0};
}

struct molecules_group *mf_molecules_group(struct molecules *molecules, int order,
                                           const char *name) {
    for (int g = 0; g < molecules->groups[order]; g++)
        if (strcmp(molecules->group[order][g].name, name) == 0)
            return &molecules->group[order][g];
    return NULL;
}

enum status mf_molecules_add_group(struct molecules *molecules, int order, const char *name,
                                   const struct bonded_law *law) {
    struct molecules_group *group = &molecules->group[order][molecules->groups[order]];
    TRY(mf_bonded_create(&group->curve, law));
    snprintf(group->name, sizeof group->name, "%s", name);
    molecules->groups[order]++;
    return STATUS_OK;
}

const struct molecules *mf_molecules_find(const struct interaction_choice *interactions,
                                          int count) {
    for (int k = 0; k < count; k++)
        if (interactions[k].kind == &mf_molecules)
            return interactions[k].parameters;
    return NULL;
}

// Begin -------------------------------------------------------------------------------------------

/// A length that is as long as it can be, or at rest.
static enum status check_lengths(const struct molecules *molecules, int order,
                                 const struct box *box) {
    for (int g = 0; g < molecules->groups[order]; g++) {
        const struct molecules_group *group = &molecules->group[order][g];
        const double longest = mf_bonded_longest(&group->curve);
        const double length = isfinite(longest) ? longest : mf_bonded_rest(&group->curve);
        if (!(length < 0.5 * mf_box_shortest(box)))
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s.%s: %s %s of %g" STATUS_LENGTH " is not shorter than half of the box, "
                "whose shortest edge is %g" STATUS_LENGTH,
                mf_bonded_kinds[order]->plural, group->name, mf_bonded_kinds[order]->article,
                mf_bonded_kinds[order]->name, length, mf_box_shortest(box));
    }
    return STATUS_OK;
}

enum status mf_molecules_check(const struct molecules *molecules, const struct box *box) {
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct bonded_kind *kind = mf_bonded_kinds[order];
        if (kind->is_length)
            TRY(check_lengths(molecules, order, box));
        if (box->dimensions == 2 && kind->spatial && molecules->groups[order] > 0)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: in two dimensions there are none, as nothing leaves the "
                                  "plane",
                                  kind->plural);
    }
    return STATUS_OK;
}

static enum status begin(const void *parameters, void *own, const struct particles *particles) {
    struct state *state = own;
    state->molecules = parameters;
    TRY(mf_molecules_check(state->molecules, &particles->box));
    return mf_molecules_layout_init(&state->layout, &state->molecules->topology, particles);
}

static void clear(void *own) {
    mf_molecules_layout_clear(&((struct state *)own)->layout);
}

// Forces ------------------------------------------------------------------------------------------

struct sweep {
    struct state *state;
    const struct interaction_pass *pass;
    struct bonded_sums sums[MOLECULES_MAX_BLOCKS];
};

/// The terms of a group in a bundle, whose beads begin at `bead`.
static struct bonded_terms terms_of(const struct sweep *sweep,
                                    const struct molecules_bundle *bundle, int order, int group,
                                    const int *bead) {
    return (struct bonded_terms){
        .order = order,
        .curve = &sweep->state->molecules->group[order][group].curve,
        .group = group,
        .count = bundle->motif->terms[order][group],
        .bead = bead,
        .lanes = bundle->lanes,
        .sums = sweep->pass->wants == PAIR_FORCES_AND_SUMS,
        .transfer = sweep->pass->law->transfer != NULL,
    };
}

/// Add all terms of a bundle, group by group, to the forces of its beads.
static void add_terms(const struct sweep *sweep, const struct molecules_bundle *bundle,
                      struct bonded_beads *beads, struct bonded_sums *sums) {
    const struct molecules *molecules = sweep->state->molecules;
    const int *bead = bundle->motif->term_bead;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct bonded_terms terms = terms_of(sweep, bundle, order, g, bead);
            mf_bonded_add(&terms, beads, sums);
            bead += terms.count * mf_bonded_kinds[order]->beads;
        }
}

static void add_blocks(void *context, size_t begin_block, size_t end_block) {
    struct sweep *sweep = context;
    const struct molecules_layout *layout = &sweep->state->layout;
    struct bonded_beads beads;
    for (size_t block = begin_block; block < end_block; block++)
        for (size_t n = layout->start[block]; n < layout->start[block + 1]; n++) {
            const struct molecules_bundle *bundle = &layout->bundle[n];
            const int32_t *place = layout->place + bundle->row * BONDED_LANES;
            mf_bonded_take(&beads, sweep->pass->particles, place, bundle->motif->beads);
            add_terms(sweep, bundle, &beads, &sweep->sums[block]);
            (sweep->pass->before_pairs ? mf_bonded_give_sums : mf_bonded_give)(
                &beads, sweep->pass->particles, place, bundle->motif->beads, bundle->lanes);
        }
}

/// Add the sums of all blocks, in their order.
static void collect(const struct sweep *sweep) {
    const struct interaction_pass *pass = sweep->pass;
    for (int block = 0; block < sweep->state->layout.blocks; block++) {
        const struct bonded_sums *sums = &sweep->sums[block];
        if (pass->wants == PAIR_FORCES_AND_SUMS) {
            pass->sums->energy += sums->energy;
            pass->sums->virial += sums->virial;
        }
        for (int a = 0; a < 3 && pass->law->transfer; a++)
            for (int b = 0; b < 3; b++)
                pass->law->transfer->part[0][a][b] += sums->transfer[a][b];
    }
}

/// Before the first step molecules are parted, and bonds may be too long for a while.
static enum status check_broken(const struct sweep *sweep) {
    const struct state *state = sweep->state;
    for (int block = 0; block < state->layout.blocks && sweep->pass->step > 0; block++) {
        const struct bonded_sums *sums = &sweep->sums[block];
        const struct molecules_group *group =
            &state->molecules->group[sums->broken_order][sums->broken];
        if (sums->longest > 0)
            return mf_status_fail(
                STATUS_UNSTABLE,
                "unstable at step %llu: %s %s \"%s\" is %.4g" STATUS_LENGTH " long, and breaks at "
                "%.4g" STATUS_LENGTH "; lower \"time_step\", or begin with shorter bonds",
                (unsigned long long)sweep->pass->step, mf_bonded_kinds[sums->broken_order]->article,
                mf_bonded_kinds[sums->broken_order]->name, group->name, sums->longest,
                mf_bonded_longest(&group->curve));
    }
    return STATUS_OK;
}

static enum status add(const void *parameters, void *own, const struct interaction_pass *pass) {
    struct sweep sweep = {.state = own, .pass = pass};
    (void)parameters;
    mf_molecules_layout_follow(&sweep.state->layout, pass->particles);
    mf_parallel_for((size_t)sweep.state->layout.blocks, pass->particles->threads, add_blocks,
                    &sweep);
    collect(&sweep);
    return check_broken(&sweep);
}

/// Each block by itself, so that the sum is the same for any number of threads.
static void add_laplacians(void *context, size_t begin_block, size_t end_block) {
    struct sweep *sweep = context;
    const struct molecules_layout *layout = &sweep->state->layout;
    const struct molecules *molecules = sweep->state->molecules;
    struct bonded_beads beads;
    for (size_t block = begin_block; block < end_block; block++)
        for (size_t n = layout->start[block]; n < layout->start[block + 1]; n++) {
            const struct molecules_bundle *bundle = &layout->bundle[n];
            const int *bead = bundle->motif->term_bead;
            mf_bonded_take(&beads, sweep->pass->particles,
                           layout->place + bundle->row * BONDED_LANES, bundle->motif->beads);
            for (int order = 0; order < BONDED_KINDS; order++)
                for (int g = 0; g < molecules->groups[order]; g++) {
                    const struct bonded_terms terms = terms_of(sweep, bundle, order, g, bead);
                    sweep->sums[block].energy += mf_bonded_laplacian(&terms, &beads);
                    bead += terms.count * mf_bonded_kinds[order]->beads;
                }
        }
}

static enum status laplacian(const void *parameters, void *own, const struct interaction_pass *pass,
                             double *sum) {
    struct sweep sweep = {.state = own, .pass = pass};
    (void)parameters;
    mf_parallel_for((size_t)sweep.state->layout.blocks, pass->particles->threads, add_laplacians,
                    &sweep);
    for (int block = 0; block < sweep.state->layout.blocks; block++)
        *sum += sweep.sums[block].energy;
    return STATUS_OK;
}

const struct interaction mf_molecules = {
    .name = "molecules",
    .summary = "bonds, angles and dihedrals",
    .state_size = sizeof(struct state),
    .cost = 6,
    .before_pairs = true,
    .begin = begin,
    .clear = clear,
    .add = add,
    .laplacian = laplacian,
};
