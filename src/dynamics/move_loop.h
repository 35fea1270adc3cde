// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of Metropolis moves, compiled for each instruction set.
///
/// Distances of the listed particles come first, a vector at a time; those in range are packed, and
/// the table is read for them alone: a list with a skin of a quarter of the cutoff has twice as
/// many.
#pragma once

#include "base/lanes.h"
#include "move_kernels.h"

/// Distances looked up together.
enum { MOVE_BATCH = 256 };

/// Squared distances [λ²] of pairs in range.
struct move_batch {
    int count;
    float square[MOVE_BATCH + LANES];
};

/// What stays the same from pair to pair.
struct move_scene {
    const struct particle_place *place;
    const struct table *potential;
    float scale[3]; ///< of fractions [λ]
    float cutoff2;
};

LANES_INLINE struct move_scene move_prepare(const struct particles *particles,
                                            const struct table *potential) {
    struct move_scene scene = {.place = particles->kernel_place,
                               .potential = potential,
                               .cutoff2 = (float)(potential->cutoff * potential->cutoff)};
    for (int d = 0; d < 3; d++)
        scene.scale[d] = (float)(particles->box.length[d] * 0x1p-32);
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

/// Append those whose bits are set.
LANES_INLINE void move_append(struct move_batch *batch, unsigned mask, lanes_real square) {
    lanes_store(batch->square + batch->count, lanes_permute(square, lanes_set_bits(mask)));
    batch->count += __builtin_popcount(mask);
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

/// Sums over the distances of a batch. Another potential for some of them would be an offset of
/// their rows.
LANES_INLINE void move_sums(struct move_batch *batch, const struct move_scene *scene,
                            lanes_real *energy, lanes_real *virial) {
    const struct table *potential = scene->potential;
    const float inverse_spacing = (float)potential->inverse_spacing;
    const float spacing = (float)(1 / potential->inverse_spacing);
    // The last vector is filled up with distances beyond the cutoff.
    lanes_store(batch->square + batch->count, lanes_all(4 * scene->cutoff2));
    for (int k = 0; k < batch->count; k += LANES) {
        int32_t row[LANES];
        const lanes_real r = lanes_sqrt(lanes_load(batch->square + k));
        const lanes_real place = lanes_least(r * inverse_spacing, lanes_all(TABLE_INTERVALS));
        const lanes_int interval = lanes_to_int(place);
        lanes_store_int(row, interval);
        const struct lanes_record c = lanes_load_records(potential->single, row);
        const lanes_real f = place - lanes_to_real(interval);
        *energy += c.word[0] -
                   spacing * f * (c.word[1] + f * (0.5F * c.word[2] + f * (1.0F / 3) * c.word[3]));
        if (virial)
            *virial += r * (c.word[1] + f * (c.word[2] + f * c.word[3]));
    }
    batch->count = 0;
}

LANES_INLINE double move_change(const struct particles *particles,
                                const struct neighbours *neighbours, const struct table *potential,
                                size_t self, const int32_t to[3], const int dim) {
    const struct move_scene scene = move_prepare(particles, potential);
    const int32_t *from = scene.place[self].fraction;
    const int32_t *list = neighbours->list + neighbours->start[self];
    const size_t count = neighbours->stop[self] - neighbours->start[self];
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
        move_append(&before, lanes_below(here, cutoff2) & listed, here);
        move_append(&after, lanes_below(there, cutoff2) & listed, there);
        if (before.count > MOVE_BATCH - LANES)
            move_sums(&before, &scene, &energy_before, NULL);
        if (after.count > MOVE_BATCH - LANES)
            move_sums(&after, &scene, &energy_after, NULL);
    }
    move_sums(&before, &scene, &energy_before, NULL);
    move_sums(&after, &scene, &energy_after, NULL);
    return (double)lanes_sum(energy_after - energy_before);
}

/// Count the distances of a batch.
LANES_INLINE void move_histogram(const struct move_batch *batch,
                                 const struct pair_histogram *histogram) {
    const float low = (float)histogram->low, inverse_width = (float)(1 / histogram->width);
    const lanes_real bins = lanes_all((float)histogram->bins);
    for (int k = 0; k < batch->count; k += LANES) {
        int32_t bin[LANES];
        const lanes_real r = lanes_sqrt(lanes_load(batch->square + k));
        const lanes_real place = (r - low) * inverse_width;
        const lanes_int outside = lanes_all(0) > place;
        lanes_store_int(bin, lanes_to_int(lanes_least(place, bins)));
        for (int lane = 0; lane < LANES && k + lane < batch->count; lane++)
            histogram->counts[outside[lane] ? (int32_t)histogram->bins : bin[lane]]++;
    }
}

/// Each pair once: from a full list the entries with the larger number.
LANES_INLINE void move_count(const struct particles *particles, const struct neighbours *neighbours,
                             const struct table *potential, const struct pair_histogram *histogram,
                             struct pair_sums *sums, const int dim) {
    const struct move_scene scene = move_prepare(particles, potential);
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
            // Of the others the distance counts as beyond the cutoff.
            const lanes_int once = entries > lanes_all_int((int32_t)self);
            const lanes_int far = (lanes_int)lanes_all(4 * scene.cutoff2);
            const lanes_real wanted = (lanes_real)((once & (lanes_int)square) | (~once & far));
            move_append(&batch, lanes_below(wanted, lanes_all(scene.cutoff2)), square);
            if (batch.count > MOVE_BATCH - LANES) {
                move_histogram(&batch, histogram);
                move_sums(&batch, &scene, &energy, &virial);
            }
        }
        move_histogram(&batch, histogram);
        move_sums(&batch, &scene, &energy, &virial);
        sums->energy += (double)lanes_sum(energy);
        sums->virial += (double)lanes_sum(virial);
    }
}

#define MOVE_INSTANCE(name)                                                                        \
    static double name##_energy_change(                                                            \
        const struct particles *particles, const struct neighbours *neighbours,                    \
        const struct table *potential, size_t particle, const int32_t to[3]) {                     \
        if (particles->box.dimensions == 2)                                                        \
            return move_change(particles, neighbours, potential, particle, to, 2);                 \
        return move_change(particles, neighbours, potential, particle, to, 3);                     \
    }                                                                                              \
    static void name##_count_pairs(                                                                \
        const struct particles *particles, const struct neighbours *neighbours,                    \
        const struct table *potential, const struct pair_histogram *histogram,                     \
        struct pair_sums *sums) {                                                                  \
        if (particles->box.dimensions == 2)                                                        \
            move_count(particles, neighbours, potential, histogram, sums, 2);                      \
        else                                                                                       \
            move_count(particles, neighbours, potential, histogram, sums, 3);                      \
    }                                                                                              \
    const struct move_kernels name = {name##_energy_change, name##_count_pairs};
