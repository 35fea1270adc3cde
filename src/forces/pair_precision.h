// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the pair loop reads in its two precisions, and how it finds the nearest image.
#pragma once

#include "base/lanes.h"
#include "forces/friction.h"
#include "system/particles.h"

#define INLINE static inline __attribute__((always_inline))

#if defined(LANES_DOUBLE)

#define PAIR_ROWS precise // of a table
#define PAIR_PLACE particle_precise_place
#define PAIR_PLACES precise_place
#define PAIR_MOTION particle_precise_motion
#define PAIR_MOTIONS precise_motion

struct pair_box {
    double length[3], inverse_length[3];
};

INLINE struct pair_box pair_box_of(const struct box *box) {
    struct pair_box edges;
    for (int d = 0; d < 3; d++) {
        edges.length[d] = box->length[d];
        edges.inverse_length[d] = 1 / box->length[d];
    }
    return edges;
}

/// Along axis d from entries j of the list to the owners of their two rows (one, since a vector of
/// doubles is no longer than a row), nearest images: box_nearest.
INLINE lanes_real pair_separation(const struct pair_box *box,
                                  const struct particle_precise_place *owner,
                                  const struct particle_precise_place *next,
                                  const struct lanes_record *j, int d) {
    (void)next;
    const lanes_real x = owner->position[d] - j->word[d];
    return x - lanes_nearest(x * box->inverse_length[d]) * box->length[d];
}

INLINE lanes_int pair_id(const struct lanes_record *particle) {
    return lanes_to_int(particle->word[3]);
}

INLINE int32_t pair_owner_id(const struct particle_precise_place *owner) {
    return (int32_t)owner->id;
}

INLINE void pair_store_directions(float (*to)[4], lanes_real x, lanes_real y, lanes_real z) {
    for (int n = 0; n < LANES; n++) {
        to[n][0] = (float)x[n];
        to[n][1] = (float)y[n];
        to[n][2] = (float)z[n];
        to[n][3] = 0;
    }
}

INLINE void pair_store_frictions(struct friction_pair *to, lanes_real damping, lanes_real kick,
                                 lanes_int i, lanes_int j) {
    for (int n = 0; n < LANES; n++)
        to[n] = (struct friction_pair){(float)damping[n], (float)kick[n], i[n], j[n]};
}

#else

#define PAIR_ROWS single // of a table
#define PAIR_PLACE particle_place
#define PAIR_PLACES kernel_place
#define PAIR_MOTION particle_motion
#define PAIR_MOTIONS kernel_motion

struct pair_box {
    float scale[3]; ///< box edges in units of 2³²: fractions to lengths
};

INLINE struct pair_box pair_box_of(const struct box *box) {
    struct pair_box edges;
    for (int d = 0; d < 3; d++)
        edges.scale[d] = (float)(box->length[d] * 0x1p-32);
    return edges;
}

/// Along axis d from entries j of the list to the owners of their two rows, nearest images:
/// differences of unsigned fractions wrap around; read as signed, they are those (box_fraction).
INLINE lanes_real pair_separation(const struct pair_box *box, const struct particle_place *owner,
                                  const struct particle_place *next, const struct lanes_record *j,
                                  int d) {
    const lanes_uint x = (lanes_uint)lanes_eights(owner->fraction[d], next->fraction[d]);
    return box->scale[d] * lanes_to_real((lanes_int)(x - (lanes_uint)j->word[d]));
}

INLINE lanes_int pair_id(const struct lanes_record *particle) {
    return (lanes_int)particle->word[3];
}

INLINE int32_t pair_owner_id(const struct particle_place *owner) {
    return (int32_t)owner->id;
}

INLINE void pair_store_directions(float (*to)[4], lanes_real x, lanes_real y, lanes_real z) {
    lanes_store_records(to, x, y, z, lanes_all(0));
}

INLINE void pair_store_frictions(struct friction_pair *to, lanes_real damping, lanes_real kick,
                                 lanes_int i, lanes_int j) {
    lanes_store_records((float(*)[4])to, damping, kick, (lanes_real)i, (lanes_real)j);
}

#endif
