// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the loops over pairs that remember: included by pair_memory_portable.c,
/// pair_memory_avx2.c and pair_memory_avx512.c, which compile it for an instruction set.
#pragma once

#include "pair_memory_steps.h"

INLINE double memory_sum(lanes_double4 a) {
    return (a[0] + a[1]) + a[2];
}

/// Add the impulse on the first of a pair, whose velocity was `before`, to what is transferred,
/// unless nobody asks. As a difference, so that what a compiler fuses is the same for both.
INLINE void memory_report(const struct memory_columns *columns, int n, lanes_double4 before,
                          lanes_double4 after, double (*transfer)[3]) {
    const lanes_double4 impulse = after - before;
    if (transfer)
        transfer_add(transfer, (double)columns->r[n], columns->direction[n],
                     (double[]){impulse[0], impulse[1], impulse[2]});
}

INLINE void memory_rotate(struct memory_columns *columns, const struct memory_scene *scene, int n,
                          double (*transfer)[3]) {
    const lanes_double4 e = lanes_load_double4(columns->direction[n]);
    lanes_double4 *a = &scene->v[columns->near.i[n]], *b = &scene->v[columns->near.j[n]];
    const double u = memory_sum(e * (*a - *b));
    const lanes_double4 change = (columns->push[n] - columns->decay[n] * u) * e, velocity = *a;
    columns->u[n] = (float)u;
    *a += change;
    *b -= change;
    memory_report(columns, n, velocity, *a, transfer);
}

INLINE void memory_damp_across(const struct memory_columns *columns,
                               const struct memory_scene *scene, int n, double (*transfer)[3]) {
    const lanes_double4 e = lanes_load_double4(columns->direction[n]);
    lanes_double4 *a = &scene->v[columns->near.i[n]], *b = &scene->v[columns->near.j[n]];
    const lanes_double4 u = *a - *b, across = u - memory_sum(e * u) * e;
    const lanes_double4 change =
        lanes_load_double4(columns->kick[n]) - (double)columns->damping[n] * across;
    const lanes_double4 velocity = *a;
    *a += change;
    *b -= change;
    memory_report(columns, n, velocity, *a, transfer);
}

/// Pairs come sorted by particle, where each waits for the velocity that the last one changed. So
/// they are taken from so many places of the block in turn, and a processor overlaps them.
INLINE int memory_in_turn(int turn, int count) {
    enum { STREAMS = 8 };
    const int part = count / STREAMS;
    return turn < part * STREAMS ? turn % STREAMS * part + turn / STREAMS : turn;
}

/// What the modes do to a block.
INLINE void memory_rotate_all(struct memory_columns *columns, const struct memory_scene *scene,
                              double (*transfer)[3]) {
    const int modes = scene->memory->law.modes, count = columns->near.count;
    for (int m = 0; m < modes; m++) {
        memory_relax(columns, scene, m);
        memory_find_rotations(columns, scene, m);
    }
    for (int turn = 0; turn < count; turn++)
        memory_rotate(columns, scene, memory_in_turn(turn, count), transfer);
    memory_turn_variables(columns, scene);
}

/// A constant NULL for `transfer` leaves nothing of it.
INLINE void memory_sweep_block(const struct memory_scene *scene, size_t begin, int count,
                               double (*transfer)[3]) {
    const struct pair_memory *memory = scene->memory;
    struct memory_columns columns;
    memory_measure(&columns, scene, begin, count);
    memory_find_directions(&columns);
    const int near = columns.near.count;
    if (scene->mixed)
        pair_kinds(columns.kind, &columns.near, near, &scene->mixture);
    if (memory->variables > 0)
        memory_clear(memory->pairs.value[0] + begin, count);
    memory_draw(&columns, scene);
    if (memory->variables > 0 && near > 0)
        memory_rotate_all(&columns, scene, transfer);
    for (int k = 0; near > 0 && k < memory->variables; k++)
        memory_give(&columns, memory->pairs.value[k] + begin, k);
    if (memory->law.transverse == NULL)
        return;
    memory_find_kicks(&columns, scene);
    for (int turn = 0; turn < near; turn++)
        memory_damp_across(&columns, scene, memory_in_turn(turn, near), transfer);
}

INLINE void memory_sweep(struct pair_memory *memory, const struct particles *particles,
                         uint64_t step, int part, struct transfer *transfer) {
    const struct memory_scene scene = memory_scene_of(memory, particles, step);
    for (size_t k = memory->begin[part]; k < memory->end[part]; k += MEMORY_BLOCK) {
        const size_t left = memory->end[part] - k;
        const int count = left < MEMORY_BLOCK ? (int)left : MEMORY_BLOCK;
        if (transfer)
            memory_sweep_block(&scene, k, count, transfer->part[part]);
        else
            memory_sweep_block(&scene, k, count, NULL);
    }
}

/// Squared, so near must pairs of each type be that may come into their range.
INLINE void memory_find_reaches(float *square, const struct pair_memory *memory, double skin) {
    for (int p = 0; p < mf_composition_pairs(&memory->scene.composition); p++) {
        const double reach = memory->range[p] > 0 ? memory->range[p] + skin : 0;
        square[p] = (float)(reach * reach);
    }
}

INLINE size_t memory_collect(struct pair_memory *memory, const struct particles *built,
                             const struct neighbours *neighbours, int part_number, size_t n) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    const struct particle_place *place = built->kernel_place;
    const struct pair_box box = pair_box_of(&built->box);
    struct pair_memory_pairs *pairs = &memory->pairs;
    struct memory_scene scene = memory_scene_of(memory, built, 0);
    memory_find_reaches(scene.square, memory, neighbours->skin);
    for (size_t k = part->begin; k < part->end; k += LANES) {
        const int32_t *rows = neighbours->owner + k / NEIGHBOURS_ROW, *list = neighbours->list + k;
        const struct lanes_record j = lanes_load_records(place, list);
        const lanes_int id_i =
            lanes_eights(pair_owner_id(&place[rows[0]]), pair_owner_id(&place[rows[1]]));
        lanes_real r2 = lanes_all(0), max = lanes_all(scene.square[0]);
        for (int d = 0; d < 3; d++) {
            const lanes_real x = pair_separation(&box, &place[rows[0]], &place[rows[1]], &j, d);
            r2 += x * x;
        }
        if (scene.mixed)
            max = memory_by_kind(scene.square, pair_kind(&scene.mixture, id_i, pair_id(&j)));
        const unsigned near = lanes_below(lanes_all(0), r2) & lanes_below(r2, max);
        if (n <= pairs->capacity) {
            const lanes_int order = lanes_set_bits(near);
            lanes_store_int(pairs->first + n,
                            lanes_permute_int(lanes_eights(rows[0], rows[1]), order));
            lanes_store_int(pairs->second + n, lanes_permute_int(lanes_load_int(list), order));
            lanes_store_int((int32_t *)pairs->first_id + n, lanes_permute_int(id_i, order));
            lanes_store_int((int32_t *)pairs->second_id + n, lanes_permute_int(pair_id(&j), order));
        }
        n += (size_t)__builtin_popcount(near);
    }
    return n;
}

#define PAIR_MEMORY_INSTANCES(set)                                                                 \
    static size_t set##_collect(struct pair_memory *memory, const struct particles *built,         \
                                const struct neighbours *neighbours, int part, size_t count) {     \
        return memory_collect(memory, built, neighbours, part, count);                             \
    }                                                                                              \
    static void set##_sweep(struct pair_memory *memory, const struct particles *particles,         \
                            uint64_t step, int part, struct transfer *transfer) {                  \
        memory_sweep(memory, particles, step, part, transfer);                                     \
    }                                                                                              \
    const struct pair_memory_kernels set = {set##_collect, set##_sweep};
