// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the loops over pairs that remember: included by pair_memory_portable.c,
/// pair_memory_avx2.c and pair_memory_avx512.c, which compile it for an instruction set.
///
/// Lanes are floats whatever the precision of the forces; variables, velocities and rotations are
/// doubles, since what one rotation is wrong by, the next keeps.
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

/// What the numbers are for: the lower bits of the fourth counter, to which the call is added.
enum { MEMORY_OF_STEP, MEMORY_OF_ENTRY = 1 << 4 };

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
    float excess[MEMORY_BLOCK]; ///< r² over that of the range, of all pairs
    struct pair_batch near;     ///< those in range; (dx, dy, dz) is made e, from second to first
    int32_t place[PAIR_ROOM];   ///< in the block
    int32_t kind[PAIR_ROOM], low_id[PAIR_ROOM], high_id[PAIR_ROOM];
    float r[PAIR_ROOM], tangent[PAIR_ROOM];
    float direction[PAIR_ROOM][4]; ///< e; the last is 0
    int32_t word[MEMORY_WORDS][PAIR_ROOM];
    float zeta[MEMORY_WORDS][PAIR_ROOM];
    double cosine[PAIR_MEMORY_MAX_MODES][PAIR_ROOM], sine[PAIR_MEMORY_MAX_MODES][PAIR_ROOM];
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

/// Separations of all pairs of the block, of which those in range are kept.
INLINE void memory_measure(struct memory_columns *columns, const struct memory_scene *scene,
                           size_t begin, int count) {
    const struct particle_place *places = scene->particles->kernel_place;
    const struct pair_memory_pairs *pairs = &scene->memory->pairs;
    int near = 0;
    for (int k = 0; k < count; k += LANES) {
        const int32_t *first = pairs->first + begin + k, *second = pairs->second + begin + k;
        const struct lanes_record i = lanes_load_records(places, first);
        const struct lanes_record j = lanes_load_records(places, second);
        struct pair_vector vector = {lanes_load_int(first), lanes_load_int(second), pair_id(&i),
                                     pair_id(&j), .dr = {{0}}};
        lanes_real r2 = lanes_all(0), max = lanes_all(scene->square[0]);
        for (int d = 0; d < 3; d++) {
            const lanes_uint x = (lanes_uint)i.word[d] - (lanes_uint)j.word[d];
            vector.dr[d] = scene->box.scale[d] * lanes_to_real((lanes_int)x);
            r2 += vector.dr[d] * vector.dr[d];
        }
        if (scene->mixed)
            max =
                memory_by_kind(scene->square, pair_kind(&scene->mixture, vector.id_i, vector.id_j));
        lanes_store(columns->excess + k, r2 - max);
        unsigned in_range = lanes_below(r2 - max, lanes_all(0)) & lanes_below(lanes_all(0), r2);
        if (count - k < LANES)
            in_range &= (1U << (count - k)) - 1;
        lanes_store_int(columns->place + near, k + lanes_set_bits(in_range));
        near = pair_append(&columns->near, near, in_range, &vector, 3, true);
    }
    columns->near.count = near;
    pair_fill_up(&columns->near, 2 * (float)mf_pair_memory_range(&scene->memory->law));
}

/// Clear the memory of pairs out of range.
INLINE void memory_clear(const struct memory_columns *columns, double *value, int count) {
    for (int n = 0; n < count; n++)
        value[n] = columns->excess[n] < 0 ? value[n] : (double)NAN;
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

/// The fourth counter.
INLINE uint32_t memory_stream(const struct memory_scene *scene, uint32_t purpose) {
    return rng_stream_word(RNG_PAIR_MEMORY, (uint32_t)(scene->step >> 32) << 6 | purpose);
}

/// A pair that comes into the range draws its variables from the stationary law.
static void __attribute__((noinline))
memory_draw_new(const struct memory_columns *columns, const struct memory_scene *scene, int n,
                size_t pair) {
    const struct pair_memory *memory = scene->memory;
    const uint64_t seed = memory->scene.seed;
    const double sigma = sqrt(memory->scene.temperature);
    for (int k = 0; k < scene->variables; k++) {
        const uint32_t purpose = MEMORY_OF_ENTRY + (uint32_t)(k / MEMORY_CALL);
        uint32_t word[MEMORY_CALL];
        rng_philox_words((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)scene->step,
                         (uint32_t)columns->low_id[n], (uint32_t)columns->high_id[n],
                         memory_stream(scene, purpose), word);
        memory->pairs.value[k][pair] =
            sigma * normal_of_word(&memory->normal, word[k % MEMORY_CALL]);
    }
}

/// ζ of all that a pair needs in a step.
INLINE void memory_draw(struct memory_columns *columns, const struct memory_scene *scene) {
    const uint64_t seed = scene->memory->scene.seed;
    const int count = columns->near.count, words = scene->variables + scene->kicks;
    for (int w = 0; w < words; w += MEMORY_CALL) {
        const uint32_t stream = memory_stream(scene, MEMORY_OF_STEP + (uint32_t)(w / MEMORY_CALL));
        for (int k = 0; k < count; k += RNG_LANES)
            rng_philox_lanes_words((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)scene->step,
                                   columns->low_id + k, columns->high_id + k, stream, MEMORY_CALL,
                                   columns->word[w] + k, PAIR_ROOM);
    }
    for (int w = 0; w < words; w++)
        pair_normal(columns->zeta[w], columns->word[w], count, &scene->memory->normal);
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

INLINE void memory_find_rotations(struct memory_columns *columns, const struct memory_scene *scene,
                                  int m) {
    const struct pair_memory *memory = scene->memory;
    for (int k = 0; k < columns->near.count; k += LANES)
        lanes_store(columns->tangent + k,
                    memory_values(columns, scene, m, memory->law.mode[m].omega,
                                  (const float(*)[4])memory->mode[m].half, k));
    for (int n = 0; n < columns->near.count; n++) {
        const double t = columns->tangent[n], scale = 1 / (1 + t * t);
        columns->cosine[m][n] = (1 - t * t) * scale;
        columns->sine[m][n] = 2 * t * scale;
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

/// Relax the variables of each mode without u, then rotate (u/√2, z), one after the other.
INLINE void memory_rotate(const struct memory_columns *columns, const struct memory_scene *scene,
                          int n, size_t begin, const int modes, const bool plain,
                          double (*transfer)[3]) {
    const struct pair_memory *memory = scene->memory;
    const size_t p = begin + (size_t)columns->place[n];
    const lanes_double4 e = lanes_load_double4(columns->direction[n]);
    lanes_double4 *a = &scene->v[columns->near.i[n]], *b = &scene->v[columns->near.j[n]];
    const double before = M_SQRT1_2 * memory_sum(e * (*a - *b));
    double w = before;
    if (isnan(memory->pairs.value[0][p]))
        memory_draw_new(columns, scene, n, p);
    for (int m = 0; m < modes; m++) {
        const int first = memory->mode[m].first;
        const double keep = memory->mode[m].keep, noise = memory->mode[m].noise;
        const double c = columns->cosine[m][n], s = columns->sine[m][n], was = w;
        const double rest = memory->pairs.value[first][p];
        double z = keep * rest + noise * columns->zeta[first][n];
        if (!plain && memory->law.mode[m].frequency > 0) {
            double *y = &memory->pairs.value[first + 1][p];
            z += memory->mode[m].turn * *y;
            *y = keep * *y - memory->mode[m].turn * rest + noise * columns->zeta[first + 1][n];
        }
        w = c * was + s * z;
        memory->pairs.value[first][p] = c * z - s * was;
    }
    const lanes_double4 change = M_SQRT1_2 * (w - before) * e, velocity = *a;
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

INLINE void memory_rotate_all(const struct memory_columns *columns,
                              const struct memory_scene *scene, size_t begin,
                              double (*transfer)[3]) {
    const int modes = scene->memory->law.modes, count = columns->near.count;
    if (modes == 1 && scene->variables == 1) {
        for (int turn = 0; turn < count; turn++)
            memory_rotate(columns, scene, memory_in_turn(turn, count), begin, 1, true, transfer);
    } else {
        for (int turn = 0; turn < count; turn++)
            memory_rotate(columns, scene, memory_in_turn(turn, count), begin, modes, false,
                          transfer);
    }
}

/// A constant NULL for `transfer` leaves nothing of it.
INLINE void memory_sweep_block(const struct memory_scene *scene, size_t begin, int count,
                               double (*transfer)[3]) {
    const struct pair_memory *memory = scene->memory;
    struct memory_columns columns;
    memory_measure(&columns, scene, begin, count);
    memory_find_directions(&columns);
    if (scene->mixed)
        pair_kinds(columns.kind, &columns.near, columns.near.count, &scene->mixture);
    pair_ids(columns.low_id, columns.high_id, &columns.near, columns.near.count);
    if (memory->variables > 0)
        memory_clear(&columns, memory->pairs.value[0] + begin, count);
    memory_draw(&columns, scene);
    for (int m = 0; m < memory->law.modes; m++)
        memory_find_rotations(&columns, scene, m);
    if (memory->law.modes > 0)
        memory_rotate_all(&columns, scene, begin, transfer);
    if (memory->law.transverse == NULL)
        return;
    memory_find_kicks(&columns, scene);
    for (int turn = 0; turn < columns.near.count; turn++)
        memory_damp_across(&columns, scene, memory_in_turn(turn, columns.near.count), transfer);
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

/// Leave those pairs of a mixture in a batch that may come into the range of their type.
INLINE void memory_select(struct pair_batch *batch, const struct pair_memory *memory, double skin) {
    int left = 0;
    for (int k = 0; k < batch->count; k++) {
        const int kind = mf_composition_pair_of_ids(
            &memory->scene.composition, (uint32_t)batch->id_i[k], (uint32_t)batch->id_j[k]);
        const float far = (float)(memory->range[kind] + skin);
        const float r2 =
            batch->dx[k] * batch->dx[k] + batch->dy[k] * batch->dy[k] + batch->dz[k] * batch->dz[k];
        batch->i[left] = batch->i[k];
        batch->j[left] = batch->j[k];
        batch->id_i[left] = batch->id_i[k];
        batch->id_j[left] = batch->id_j[k];
        left += memory->range[kind] > 0 && r2 < far * far;
    }
    batch->count = left;
}

/// Append the pairs of a batch, as far as there is room for them; returns the new number.
INLINE size_t memory_append(struct pair_memory_pairs *pairs, const struct pair_batch *batch,
                            size_t n) {
    const size_t left = pairs->capacity > n ? pairs->capacity - n : 0;
    const size_t size =
        sizeof(int32_t) * ((size_t)batch->count < left ? (size_t)batch->count : left);
    if (size > 0) {
        memcpy(pairs->first + n, batch->i, size);
        memcpy(pairs->second + n, batch->j, size);
        memcpy(pairs->first_id + n, batch->id_i, size);
        memcpy(pairs->second_id + n, batch->id_j, size);
    }
    return n + (size_t)batch->count;
}

INLINE size_t memory_collect(struct pair_memory *memory, const struct particles *built,
                             const struct neighbours *neighbours, int part_number, size_t n) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    const double max = mf_pair_memory_range(&memory->law) + neighbours->skin;
    struct particles particles = *built;
    const struct pair_scene scene = {
        .particles = &particles, .box = pair_box_of(&built->box), .cutoff2 = (float)(max * max)};
    struct pair_batch batch, far; // none is far
    batch.count = far.count = 0;
    for (size_t k = part->begin; k < part->end; k += PAIR_PIECE) {
        const int count = part->end - k < PAIR_PIECE ? (int)(part->end - k) : PAIR_PIECE;
        pair_collect(&batch, &far, &scene, neighbours->list + k,
                     neighbours->owner + k / NEIGHBOURS_ROW, count, 3, false, true, false);
        if (batch.count >= PAIR_BATCH || k + PAIR_PIECE >= part->end) {
            if (composition_is_mixed(&memory->scene.composition))
                memory_select(&batch, memory, neighbours->skin);
            n = memory_append(&memory->pairs, &batch, n);
            batch.count = 0;
        }
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
