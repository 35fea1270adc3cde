// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is computed of a block of pairs that remember, step by step: the first part of
/// pair_memory_loop.h.
///
/// Lanes, and so variables and rotations, are floats whatever the precision of the forces;
/// velocities are doubles. What is rounded is random, and forgotten in the time of a mode.
#pragma once

#include "forces/pair_kernels.h"
#include "forces/pair_memory_kernels.h"
#include "pair_steps.h"

enum {
    MEMORY_BLOCK = PAIR_BATCH, ///< pairs of the list looked at together
    MEMORY_CALL = 4,           ///< words of a call of Philox
    MEMORY_WORDS = (PAIR_MEMORY_MAX_VARIABLES + 3 + MEMORY_CALL - 1) / MEMORY_CALL * MEMORY_CALL,
    MEMORY_CURVES = PAIR_MEMORY_MAX_MODES + 1, ///< of modes, and of what is across
};

/// What stays the same from block to block.
struct memory_scene {
    struct pair_memory *memory;
    const struct particles *particles;
    uint64_t step;
    lanes_double4 *v;
    struct pair_box box;
    bool mixed;
    struct pair_mixture mixture;
    float square[COMPOSITION_MAX_PAIRS]; ///< of the range of each pair type
    float inverse_spacing[MEMORY_CURVES][COMPOSITION_MAX_PAIRS];
    int variables, kicks; ///< normal numbers that a pair needs: of z and y, across
};

/// A block, column by column.
struct memory_columns {
    /// Those in range; (dx, dy, dz) is made e, from second to first, and of the ids the first is
    /// the lower.
    struct pair_batch near;
    int32_t place[PAIR_ROOM]; ///< in the block
    int32_t kind[PAIR_ROOM];
    float r[PAIR_ROOM];
    float direction[PAIR_ROOM][4]; ///< e; the last is 0
    float zeta[MEMORY_WORDS][PAIR_ROOM];
    float z[PAIR_MEMORY_MAX_VARIABLES][PAIR_ROOM];
    float cosine[PAIR_MEMORY_MAX_MODES][PAIR_ROOM];
    float sine[PAIR_MEMORY_MAX_MODES][PAIR_ROOM]; ///< over √2
    float decay[PAIR_ROOM], push[PAIR_ROOM];      ///< the impulse along e is push − decay u
    float u[PAIR_ROOM];
    float damping[PAIR_ROOM], kick[PAIR_ROOM][4]; ///< of what is across
};

INLINE struct memory_scene memory_scene_of(struct pair_memory *memory,
                                           const struct particles *particles, uint64_t step) {
    const struct pair_memory_law *law = &memory->law;
    const struct composition *composition = &memory->scene.composition;
    struct memory_scene scene = {.memory = memory,
                                 .particles = particles,
                                 .step = step,
                                 .v = (lanes_double4 *)particles->kernel_force,
                                 .box = pair_box_of(&particles->box),
                                 .mixed = composition_is_mixed(composition),
                                 .variables = memory->variables,
                                 .kicks = law->transverse ? particles->box.dimensions : 0};
    if (scene.mixed)
        scene.mixture = pair_mixture_of(&(struct pair_law){.composition = *composition});
    for (int p = 0; p < mf_composition_pairs(composition); p++) {
        scene.square[p] = (float)(memory->range[p] * memory->range[p]);
        for (int m = 0; m < law->modes; m++)
            scene.inverse_spacing[m][p] = (float)mf_table_inverse_spacing(law->mode[m].omega, p);
        if (law->transverse)
            scene.inverse_spacing[law->modes][p] =
                (float)mf_table_inverse_spacing(law->transverse, p);
    }
    return scene;
}

/// Numbers of pair types from a short table.
INLINE lanes_real memory_by_kind(const float *of_kind, lanes_int kind) {
    lanes_real number = lanes_all(0);
    for (int lane = 0; lane < LANES; lane++)
        number[lane] = of_kind[kind[lane]];
    return number;
}

/// The next numbers of a block, of which `count` are left. (Others may belong to another thread.)
INLINE lanes_real memory_load(const float *from, int count) {
    float last[LANES] = {0};
    if (count >= LANES)
        return lanes_load(from);
    memcpy(last, from, (size_t)count * sizeof *last);
    return lanes_load(last);
}

/// Separations of all pairs of the block, of which those in range are kept, with their variables.
INLINE void memory_measure(struct memory_columns *columns, const struct memory_scene *scene,
                           size_t begin, int count) {
    const struct particle_place *places = scene->particles->kernel_place;
    const struct pair_memory_pairs *pairs = &scene->memory->pairs;
    int near = 0;
    for (int k = 0; k < count; k += LANES) {
        const int32_t *first = pairs->first + begin + k, *second = pairs->second + begin + k;
        const struct lanes_record i = lanes_load_records(places, first);
        const struct lanes_record j = lanes_load_records(places, second);
        struct pair_vector vector = {lanes_load_int(first), lanes_load_int(second),
                                     lanes_min_int(pair_id(&i), pair_id(&j)),
                                     lanes_max_int(pair_id(&i), pair_id(&j)), .dr = {{0}}};
        lanes_real r2 = lanes_all(0), max = lanes_all(scene->square[0]);
        for (int d = 0; d < 3; d++) {
            const lanes_uint x = (lanes_uint)i.word[d] - (lanes_uint)j.word[d];
            vector.dr[d] = scene->box.scale[d] * lanes_to_real((lanes_int)x);
            r2 += vector.dr[d] * vector.dr[d];
        }
        if (scene->mixed)
            max =
                memory_by_kind(scene->square, pair_kind(&scene->mixture, vector.id_i, vector.id_j));
        unsigned in_range = lanes_below(r2, max) & lanes_below(lanes_all(0), r2);
        if (count - k < LANES)
            in_range &= (1U << (count - k)) - 1;
        const lanes_int order = lanes_set_bits(in_range);
        lanes_store_int(columns->place + near, k + order);
        for (int n = 0; n < scene->variables; n++)
            lanes_store(columns->z[n] + near,
                        lanes_permute(memory_load(pairs->value[n] + begin + k, count - k), order));
        near = pair_append(&columns->near, near, in_range, &vector, 3, true);
    }
    columns->near.count = near;
    pair_fill_up(&columns->near, 2 * (float)mf_pair_memory_range(&scene->memory->law));
}

INLINE void memory_find_directions(struct memory_columns *columns) {
    struct pair_batch *near = &columns->near;
    for (int k = 0; k < near->count; k += LANES) {
        lanes_real dx = lanes_load(near->dx + k), dy = lanes_load(near->dy + k);
        lanes_real dz = lanes_load(near->dz + k);
        const lanes_real r = lanes_sqrt(dx * dx + dy * dy + dz * dz), inverse = 1 / r;
        dx *= inverse;
        dy *= inverse;
        dz *= inverse;
        lanes_store(columns->r + k, r);
        lanes_store(near->dx + k, dx);
        lanes_store(near->dy + k, dy);
        lanes_store(near->dz + k, dz);
        lanes_store_records(columns->direction + k, dx, dy, dz, lanes_all(0));
    }
}

/// The fourth counter, of a call of a step.
INLINE uint32_t memory_stream(const struct memory_scene *scene, uint32_t call) {
    return rng_stream_word(RNG_PAIR_MEMORY, (uint32_t)(scene->step >> 32) << 6 | call);
}

/// `words` of ζ from number `first` on, at most those of a call.
INLINE void memory_draw_call(struct memory_columns *columns, const struct memory_scene *scene,
                             int first, const int words) {
    const uint64_t seed = scene->memory->scene.seed;
    const uint32_t stream = memory_stream(scene, (uint32_t)(first / MEMORY_CALL));
    const struct pair_batch *near = &columns->near;
    int32_t word[MEMORY_CALL][PAIR_ROOM];
    for (int k = 0; k < near->count; k += RNG_LANES)
        rng_philox_lanes_words((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)scene->step,
                               near->id_i + k, near->id_j + k, stream, words, word[0] + k,
                               PAIR_ROOM);
    for (int w = 0; w < words; w++)
        pair_normal(columns->zeta[first + w], word[w], near->count, &scene->memory->normal);
}

/// ζ of all that a pair needs in a step, in whole calls unless it is one.
INLINE void memory_draw(struct memory_columns *columns, const struct memory_scene *scene) {
    const int words = scene->variables + scene->kicks;
    for (int w = 0; w < words; w += MEMORY_CALL) {
        if (words == w + 1)
            memory_draw_call(columns, scene, w, 1);
        else
            memory_draw_call(columns, scene, w, MEMORY_CALL);
    }
}

/// Leave none in the list: pairs out of range have none.
INLINE void memory_clear(float *value, int count) {
    for (int n = 0; n < count; n++)
        value[n] = NAN;
}

/// Give the variables back, four at a time: a processor's own instruction for it takes longer.
/// What is beyond the last goes where it has gone.
INLINE void memory_give(struct memory_columns *columns, float *value, int k) {
    int32_t *place = columns->place;
    float *z = columns->z[k];
    const int last = columns->near.count - 1;
    for (int n = last + 1; n < last + 4; n++) {
        place[n] = place[last];
        z[n] = z[last];
    }
    for (int n = 0; n <= last; n += 4) {
        const lanes_double4 four = lanes_load_double4(z + n);
        value[place[n]] = (float)four[0];
        value[place[n + 1]] = (float)four[1];
        value[place[n + 2]] = (float)four[2];
        value[place[n + 3]] = (float)four[3];
    }
}

/// At the distances from k on, the values of curve number `curve`, of which `rows` were made.
INLINE lanes_real memory_values(const struct memory_columns *columns,
                                const struct memory_scene *scene, int curve,
                                const struct table *table, const float (*rows)[4], int k) {
    lanes_real inverse_spacing = lanes_all(scene->inverse_spacing[curve][0]);
    lanes_int first = lanes_all_int(0);
    int32_t interval[LANES] = {0};
    if (scene->mixed) {
        const lanes_int kind = lanes_load_int(columns->kind + k);
        inverse_spacing = memory_by_kind(scene->inverse_spacing[curve], kind);
        first = kind * table_stride(table);
    }
    const struct pair_rows at = pair_rows_of(inverse_spacing, first, lanes_load(columns->r + k));
    lanes_store_int(interval, at.interval);
    const struct lanes_record c = lanes_load_records(rows, interval);
    return c.word[0] + at.fraction * c.word[1];
}

/// a where it is known, else b.
INLINE lanes_real memory_select(lanes_int known, lanes_real a, lanes_real b) {
    return (lanes_real)((known & (lanes_int)a) | (~known & (lanes_int)b));
}

/// Relax the variables of a mode without u. Pairs that come into the range, which have none, draw
/// theirs from the stationary law.
INLINE void memory_relax(struct memory_columns *columns, const struct memory_scene *scene, int m) {
    const struct pair_memory *memory = scene->memory;
    const float keep = (float)memory->mode[m].keep, turn = (float)memory->mode[m].turn;
    const float noise = (float)memory->mode[m].noise;
    const float sigma = (float)(sqrt(memory->scene.temperature) / memory->unit);
    float *z = columns->z[memory->mode[m].first], *y = z + PAIR_ROOM;
    const float *zeta = columns->zeta[memory->mode[m].first], *other = zeta + PAIR_ROOM;
    for (int k = 0; k < columns->near.count; k += LANES) {
        const lanes_real rest = lanes_load(z + k);
        const lanes_int known = rest == rest;
        lanes_real relaxed = keep * rest + noise * lanes_load(zeta + k);
        if (memory->law.mode[m].frequency > 0) {
            const lanes_real beside = lanes_load(y + k), xi = lanes_load(other + k);
            relaxed += turn * beside;
            lanes_store(y + k,
                        memory_select(known, keep * beside - turn * rest + noise * xi, sigma * xi));
        }
        lanes_store(z + k, memory_select(known, relaxed, sigma * lanes_load(zeta + k)));
    }
}

/// Add the rotation of (u/√2, z) of mode m to those of the modes before it. One makes
/// u' = c u + √2 s z of u and z' = c z − s u/√2 of z; the impulse of all of them is (u' − u)/2.
INLINE void memory_find_rotations(struct memory_columns *columns, const struct memory_scene *scene,
                                  int m) {
    const struct pair_memory *memory = scene->memory;
    const float *z = columns->z[memory->mode[m].first], unit = (float)memory->unit;
    for (int k = 0; k < columns->near.count; k += LANES) {
        const lanes_real t = memory_values(columns, scene, m, memory->law.mode[m].omega,
                                           (const float(*)[4])memory->mode[m].half, k);
        const lanes_real scale = 1 / (1 + t * t), c = (1 - t * t) * scale;
        const lanes_real s = (float)M_SQRT2 * t * scale, push = unit * s * lanes_load(z + k);
        lanes_store(columns->cosine[m] + k, c);
        lanes_store(columns->sine[m] + k, s);
        if (m == 0) {
            lanes_store(columns->decay + k, t * t * scale);
            lanes_store(columns->push + k, push);
        } else {
            const lanes_real decay = lanes_load(columns->decay + k);
            lanes_store(columns->decay + k, t * t * scale + c * decay);
            lanes_store(columns->push + k, c * lanes_load(columns->push + k) + push);
        }
    }
}

/// What the rotations make of the variables.
INLINE void memory_turn_variables(struct memory_columns *columns,
                                  const struct memory_scene *scene) {
    const struct pair_memory *memory = scene->memory;
    const float unit = (float)memory->unit, inverse = 1 / unit;
    for (int m = 0; m < memory->law.modes; m++) {
        float *z = columns->z[memory->mode[m].first];
        for (int k = 0; k < columns->near.count; k += LANES) {
            const lanes_real c = lanes_load(columns->cosine[m] + k);
            const lanes_real s = lanes_load(columns->sine[m] + k);
            const lanes_real rest = lanes_load(z + k), u = lanes_load(columns->u + k);
            lanes_store(z + k, c * rest - inverse * s * u);
            if (m + 1 < memory->law.modes)
                lanes_store(columns->u + k, c * u + 2 * unit * s * rest);
        }
    }
}

/// Damping and kicks across e.
INLINE void memory_find_kicks(struct memory_columns *columns, const struct memory_scene *scene) {
    const struct pair_memory *memory = scene->memory;
    const struct pair_batch *near = &columns->near;
    const float size = (float)sqrt(2 * memory->scene.temperature);
    const float(*zeta)[PAIR_ROOM] = (const float(*)[PAIR_ROOM])columns->zeta + scene->variables;
    for (int k = 0; k < near->count; k += LANES) {
        const lanes_real root =
            memory_values(columns, scene, memory->law.modes, memory->law.transverse,
                          (const float(*)[4])memory->root, k);
        const lanes_real damping = root * root;
        const lanes_real scale = size * root * lanes_sqrt(1 - damping);
        const lanes_real x = lanes_load(near->dx + k), y = lanes_load(near->dy + k);
        const lanes_real z = lanes_load(near->dz + k);
        const lanes_real a = lanes_load(zeta[0] + k), b = lanes_load(zeta[1] + k);
        const lanes_real c = scene->kicks > 2 ? lanes_load(zeta[2] + k) : lanes_all(0);
        const lanes_real along = a * x + b * y + c * z;
        lanes_store(columns->damping + k, damping);
        lanes_store_records(columns->kick + k, scale * (a - along * x), scale * (b - along * y),
                            scale * (c - along * z), lanes_all(0));
    }
}
