// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of Metropolis moves, compiled for each instruction set.
///
/// Distances of the listed particles come first, a vector at a time; those in range are packed, and
/// the table is read for them alone: a list with a skin of a quarter of the cutoff has twice as
/// many.
#pragma once

#include "forces/pair_mixture.h"
#include "move_kernels.h"

/// Distances looked up together.
enum { MOVE_BATCH = 256 };

/// Squared distances [λ²] of pairs in range, and in a mixture their kinds.
struct move_batch {
    int count;
    float square[MOVE_BATCH + LANES];
    int32_t kind[MOVE_BATCH + LANES];
};

/// What stays the same from pair to pair.
struct move_scene {
    const struct particle_place *place;
    const struct pair_law *law;
    float scale[3]; ///< of fractions [λ]
    float cutoff2;
    struct pair_mixture mixture;
};

LANES_INLINE struct move_scene move_prepare(const struct pair_law *law,
                                            const struct particles *particles, const bool mixed) {
    const double cutoff = law->potential->cutoff;
    struct move_scene scene = {
        .place = particles->kernel_place, .law = law, .cutoff2 = (float)(cutoff * cutoff)};
    for (int d = 0; d < 3; d++)
        scene.scale[d] = (float)(particles->box.length[d] * 0x1p-32);
    if (mixed)
        scene.mixture = pair_mixture_of(law);
    return scene;
}

/// Squared distances from a point to the particles of a vector.
LANES_INLINE lanes_real move_squares(const struct move_scene *scene, const int32_t from[3],
                                     const struct lanes_record *place, const int dim) {
    lanes_real square = lanes_all(0);
    for (int d = 0; d < dim; d++) {
        const lanes_uint apart = (lanes_uint)lanes_all_int(from[d]) - (lanes_uint)place->word[d];
        const lanes_real x = scene->scale[d] * lanes_to_real((lanes_int)apart);
        square += x * x;
    }
    return square;
}

/// Append those whose bits are set; `kind` is of a mixture.
LANES_INLINE void move_append(struct move_batch *batch, unsigned mask, lanes_real square,
                              lanes_int kind, const bool mixed) {
    const lanes_int order = lanes_set_bits(mask);
    lanes_store(batch->square + batch->count, lanes_permute(square, order));
    if (mixed)
        lanes_store_int(batch->kind + batch->count, lanes_permute_int(kind, order));
    batch->count += __builtin_popcount(mask);
}

/// Kinds of the pairs of a particle with those of a vector.
LANES_INLINE lanes_int move_kinds(const struct move_scene *scene, uint32_t id,
                                  const struct lanes_record *place, const bool mixed) {
    if (!mixed)
        return lanes_all_int(0);
    return pair_kind(&scene->mixture, lanes_all_int((int32_t)id), (lanes_int)place->word[3]);
}

/// The squares of those lanes that are wanted; the others count as beyond the cutoff.
LANES_INLINE lanes_real move_only(const struct move_scene *scene, lanes_int wanted,
                                  lanes_real square) {
    const lanes_int far = (lanes_int)lanes_all(4 * scene->cutoff2);
    return (lanes_real)((wanted & (lanes_int)square) | (~wanted & far));
}

/// The bits of those lanes of a vector, from entry k on, that are on a list with `count` entries.
LANES_INLINE unsigned move_listed(size_t k, size_t count) {
    return count - k < LANES ? (1U << (count - k)) - 1 : ~0U;
}

/// Numbers of a vector of entries; those beyond the list's end are `self`, which is no neighbour.
LANES_INLINE lanes_int move_entries(const int32_t *list, size_t k, size_t count, size_t self) {
    if (count - k >= LANES)
        return lanes_load_int(list + k);
    lanes_int entries = lanes_all_int((int32_t)self);
    for (size_t lane = 0; lane < count - k; lane++)
        entries[lane] = list[k + lane];
    return entries;
}

/// Sums over the distances of a batch, which it empties.
LANES_INLINE void move_sums(struct move_batch *batch, const struct move_scene *scene,
                            lanes_real *energy, lanes_real *virial, const bool mixed) {
    const struct table *potential = scene->law->potential;
    lanes_real inverse_spacing = lanes_all((float)potential->inverse_spacing);
    lanes_real spacing = lanes_all((float)(1 / potential->inverse_spacing));
    lanes_int first = lanes_all_int(0);
    // The last vector is filled up with distances beyond the cutoff.
    lanes_store(batch->square + batch->count, lanes_all(4 * scene->cutoff2));
    if (mixed)
        lanes_store_int(batch->kind + batch->count, lanes_all_int(0));
    for (int k = 0; k < batch->count; k += LANES) {
        int32_t row[LANES];
        if (mixed) {
            const struct lanes_record grid =
                lanes_load_records(scene->mixture.grid, batch->kind + k);
            inverse_spacing = grid.word[0];
            spacing = grid.word[2];
            first = lanes_load_int(batch->kind + k) * scene->mixture.potential_stride;
        }
        const lanes_real r = lanes_sqrt(lanes_load(batch->square + k));
        const lanes_real place = lanes_min(r * inverse_spacing, lanes_all(TABLE_INTERVALS));
        const lanes_int interval = lanes_to_int(place);
        lanes_store_int(row, first + interval);
        const struct lanes_record c = lanes_load_records(potential->single, row);
        const lanes_real f = place - lanes_to_real(interval);
        *energy += c.word[0] -
                   spacing * f * (c.word[1] + f * (0.5F * c.word[2] + f * (1.0F / 3) * c.word[3]));
        if (virial)
            *virial += r * (c.word[1] + f * (c.word[2] + f * c.word[3]));
    }
    batch->count = 0;
}

LANES_INLINE double move_change(const struct pair_law *law, const struct particles *particles,
                                size_t self, const int32_t *list, size_t count, const int32_t to[3],
                                const int dim, const bool mixed) {
    const struct move_scene scene = move_prepare(law, particles, mixed);
    const int32_t *from = scene.place[self].fraction;
    const lanes_real cutoff2 = lanes_all(scene.cutoff2);
    lanes_real energy_before = lanes_all(0), energy_after = lanes_all(0);
    struct move_batch before, after;
    before.count = after.count = 0;
    for (size_t k = 0; k < count; k += LANES) {
        int32_t entry[LANES];
        lanes_store_int(entry, move_entries(list, k, count, self));
        const struct lanes_record place = lanes_load_records(scene.place, entry);
        const unsigned listed = move_listed(k, count);
        const lanes_real here = move_squares(&scene, from, &place, dim);
        const lanes_real there = move_squares(&scene, to, &place, dim);
        const lanes_int kinds = move_kinds(&scene, scene.place[self].id, &place, mixed);
        move_append(&before, lanes_below(here, cutoff2) & listed, here, kinds, mixed);
        move_append(&after, lanes_below(there, cutoff2) & listed, there, kinds, mixed);
        if (before.count > MOVE_BATCH - LANES)
            move_sums(&before, &scene, &energy_before, NULL, mixed);
        if (after.count > MOVE_BATCH - LANES)
            move_sums(&after, &scene, &energy_after, NULL, mixed);
    }
    move_sums(&before, &scene, &energy_before, NULL, mixed);
    move_sums(&after, &scene, &energy_after, NULL, mixed);
    return (double)lanes_sum(energy_after - energy_before);
}

LANES_INLINE double move_change_type(const struct pair_law *law, const struct particles *particles,
                                     size_t self, size_t other, const int32_t *list, size_t count,
                                     const int dim) {
    const struct move_scene scene = move_prepare(law, particles, true);
    const uint32_t id = scene.place[self].id, as = scene.place[other].id;
    const lanes_real cutoff2 = lanes_all(scene.cutoff2);
    lanes_real energy_before = lanes_all(0), energy_after = lanes_all(0);
    struct move_batch before, after;
    before.count = after.count = 0;
    for (size_t k = 0; k < count; k += LANES) {
        int32_t entry[LANES];
        const lanes_int entries = move_entries(list, k, count, self);
        lanes_store_int(entry, entries);
        const struct lanes_record place = lanes_load_records(scene.place, entry);
        const lanes_real square = move_squares(&scene, scene.place[self].fraction, &place, dim);
        const lanes_real wanted =
            move_only(&scene, entries != lanes_all_int((int32_t)other), square);
        const unsigned near = lanes_below(wanted, cutoff2) & move_listed(k, count);
        move_append(&before, near, square, move_kinds(&scene, id, &place, true), true);
        move_append(&after, near, square, move_kinds(&scene, as, &place, true), true);
        if (before.count > MOVE_BATCH - LANES) {
            move_sums(&before, &scene, &energy_before, NULL, true);
            move_sums(&after, &scene, &energy_after, NULL, true);
        }
    }
    move_sums(&before, &scene, &energy_before, NULL, true);
    move_sums(&after, &scene, &energy_after, NULL, true);
    return (double)lanes_sum(energy_after - energy_before);
}

/// Count the distances of a batch.
LANES_INLINE void move_histogram(const struct move_batch *batch, const struct move_scene *scene,
                                 const bool mixed) {
    const struct pair_histogram *histogram = scene->law->histogram;
    const float low = (float)histogram->low, inverse_width = (float)(1 / histogram->width);
    const lanes_real bins = lanes_all((float)histogram->bins);
    const size_t none = pair_histogram_size(histogram) - 1;
    for (int k = 0; k < batch->count; k += LANES) {
        int32_t bin[LANES];
        const lanes_real r = lanes_sqrt(lanes_load(batch->square + k));
        const lanes_real place = (r - low) * inverse_width;
        const lanes_int outside = (lanes_all(0) > place) | (place >= bins);
        lanes_store_int(bin, lanes_to_int(lanes_min(place, bins)));
        for (int lane = 0; lane < LANES && k + lane < batch->count; lane++) {
            const int32_t first =
                mixed ? batch->kind[k + lane] * scene->mixture.histogram_stride : 0;
            histogram->counts[outside[lane] ? none : (size_t)(first + bin[lane])]++;
        }
    }
}

/// Each pair once: from a full list the entries with the larger number.
LANES_INLINE void move_count(const struct pair_law *law, const struct particles *particles,
                             const struct neighbours *neighbours, struct pair_sums *sums,
                             const int dim, const bool mixed) {
    const struct move_scene scene = move_prepare(law, particles, mixed);
    *sums = (struct pair_sums){0};
    for (size_t self = 0; self < particles->count; self++) {
        const int32_t *list = neighbours->list + neighbours->start[self];
        const size_t count = neighbours->stop[self] - neighbours->start[self];
        lanes_real energy = lanes_all(0), virial = lanes_all(0);
        struct move_batch batch;
        batch.count = 0;
        for (size_t k = 0; k < count; k += LANES) {
            int32_t entry[LANES];
            const lanes_int entries = move_entries(list, k, count, self);
            lanes_store_int(entry, entries);
            const struct lanes_record place = lanes_load_records(scene.place, entry);
            const lanes_real square = move_squares(&scene, scene.place[self].fraction, &place, dim);
            const lanes_real wanted =
                move_only(&scene, entries > lanes_all_int((int32_t)self), square);
            move_append(&batch, lanes_below(wanted, lanes_all(scene.cutoff2)), square,
                        move_kinds(&scene, scene.place[self].id, &place, mixed), mixed);
            if (batch.count > MOVE_BATCH - LANES) {
                move_histogram(&batch, &scene, mixed);
                move_sums(&batch, &scene, &energy, &virial, mixed);
            }
        }
        move_histogram(&batch, &scene, mixed);
        move_sums(&batch, &scene, &energy, &virial, mixed);
        sums->energy += (double)lanes_sum(energy);
        sums->virial += (double)lanes_sum(virial);
    }
}

#define MOVE_CHANGE(name, dim, mixed)                                                              \
    static double name(const struct pair_law *law, const struct particles *particles,              \
                       size_t particle, const int32_t *list, size_t count, const int32_t to[3]) {  \
        return move_change(law, particles, particle, list, count, to, dim, mixed);                 \
    }
#define MOVE_CHANGE_TYPE(name, dim)                                                                \
    static double name(const struct pair_law *law, const struct particles *particles,              \
                       size_t particle, size_t other, const int32_t *list, size_t count) {         \
        return move_change_type(law, particles, particle, other, list, count, dim);                \
    }
#define MOVE_COUNT(name, dim, mixed)                                                               \
    static void name(const struct pair_law *law, const struct particles *particles,                \
                     const struct neighbours *neighbours, struct pair_sums *sums) {                \
        move_count(law, particles, neighbours, sums, dim, mixed);                                  \
    }

/// All instances of an instruction set, by dimensions (2, 3) and whether the beads are of one type.
#define MOVE_INSTANCES(set)                                                                        \
    MOVE_CHANGE(set##_change_2d, 2, false)                                                         \
    MOVE_CHANGE(set##_change_2d_mixed, 2, true)                                                    \
    MOVE_CHANGE(set##_change_3d, 3, false)                                                         \
    MOVE_CHANGE(set##_change_3d_mixed, 3, true)                                                    \
    MOVE_CHANGE_TYPE(set##_change_type_2d, 2)                                                      \
    MOVE_CHANGE_TYPE(set##_change_type_3d, 3)                                                      \
    MOVE_COUNT(set##_count_2d, 2, false)                                                           \
    MOVE_COUNT(set##_count_2d_mixed, 2, true)                                                      \
    MOVE_COUNT(set##_count_3d, 3, false)                                                           \
    MOVE_COUNT(set##_count_3d_mixed, 3, true)                                                      \
    const struct move_kernels set[2][2] = {                                                        \
        {{set##_change_2d, set##_change_type_2d, set##_count_2d},                                  \
         {set##_change_2d_mixed, set##_change_type_2d, set##_count_2d_mixed}},                     \
        {{set##_change_3d, set##_change_type_3d, set##_count_3d},                                  \
         {set##_change_3d_mixed, set##_change_type_3d, set##_count_3d_mixed}}};
