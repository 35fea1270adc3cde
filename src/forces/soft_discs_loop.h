// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the loop over soft discs.
///
/// Included by soft_discs_portable.c, soft_discs_avx2.c and soft_discs_avx512.c, and by their twins
/// for double precision. Each disc i sums over all j around it, and each pair is so computed twice:
/// without square roots, divisions and branches a pair is cheaper than to write its force back to
/// j, and forces are the same for any number of threads. Both halves of a pair are equal and
/// opposite to the last bit.
#pragma once

#include "base/lanes.h"
#include "forces/soft_discs_kernels.h"

#define INLINE static inline __attribute__((always_inline))

#if defined(LANES_DOUBLE)
#define DISCS_PLACE double
#define DISCS_PLACES position
#define DISCS_RADIUS precise_radius
#define DISCS_STIFFNESS precise_stiffness
#else
#define DISCS_PLACE int32_t
#define DISCS_PLACES fraction
#define DISCS_RADIUS radius
#define DISCS_STIFFNESS stiffness
#endif

/// What is there of the discs that look, each with what it sums without its own stiffness and the
/// strength.
struct discs_block {
    DISCS_PLACE place[3][SOFT_DISCS_BLOCK];
    REAL radius[SOFT_DISCS_BLOCK];
    int32_t at[SOFT_DISCS_BLOCK];        ///< its own place among the discs
    lanes_real sum[3][SOFT_DISCS_BLOCK]; ///< Σ k_j min(r² − s², 0) (r_j − r_i)
    lanes_real energy[SOFT_DISCS_BLOCK]; ///< Σ k_j min(r² − s², 0)²
    lanes_real virial[SOFT_DISCS_BLOCK]; ///< Σ k_j min(r² − s², 0) r²
};

/// What all of a pass read, in registers.
struct discs_scene {
    const struct soft_discs_cells *cells;
    double length[3], inverse_length[3];
    float scale[3]; ///< fractions to lengths
};

/// From a disc of the block to those at the places from `at` on, along axis d, nearest images.
INLINE lanes_real discs_separation(const struct discs_scene *scene, DISCS_PLACE from, size_t at,
                                   int d) {
#if defined(LANES_DOUBLE)
    const lanes_real x = lanes_load(scene->cells->position[d] + at) - from;
    return x - lanes_nearest(x * scene->inverse_length[d]) * scene->length[d];
#else
    const lanes_uint x =
        (lanes_uint)lanes_load_int(scene->cells->fraction[d] + at) - (uint32_t)from;
    return scene->scale[d] * lanes_to_real((lanes_int)x);
#endif
}

/// The discs at the places from `at` on, with `share` of their stiffness.
INLINE void discs_add(struct discs_block *block, const struct discs_scene *scene, size_t at,
                      lanes_real share, const int dimensions, const bool wants_sums) {
    const lanes_real zero = lanes_all(0);
    const lanes_real radius = lanes_load(scene->cells->DISCS_RADIUS + at);
    const lanes_real stiffness = share * lanes_load(scene->cells->DISCS_STIFFNESS + at);
#pragma GCC unroll 8
    for (int n = 0; n < SOFT_DISCS_BLOCK; n++) {
        const lanes_real dx = discs_separation(scene, block->place[0][n], at, 0);
        const lanes_real dy = discs_separation(scene, block->place[1][n], at, 1);
        const lanes_real dz =
            dimensions == 3 ? discs_separation(scene, block->place[2][n], at, 2) : zero;
        const lanes_real s = radius + block->radius[n];
        const lanes_real plane = dx * dx + dy * dy;
        const lanes_real r2 = dimensions == 3 ? plane + dz * dz : plane;
        const lanes_real overlap = lanes_min(r2 - s * s, zero);
        lanes_real force = stiffness * overlap;
        block->sum[0][n] += force * dx;
        block->sum[1][n] += force * dy;
        if (dimensions == 3)
            block->sum[2][n] += force * dz;
        if (!wants_sums)
            continue;
        // The disc itself is at no distance: it has no force, but is no pair.
        force *= lanes_to_real(-(lanes_number() != block->at[n] - (int32_t)at));
        block->energy[n] += force * overlap;
        block->virial[n] += force * r2;
    }
}

/// All discs at the places begin … end − 1.
INLINE void discs_add_all(struct discs_block *block, const struct discs_scene *scene, size_t begin,
                          size_t end, const int dimensions, const bool wants_sums) {
    for (; begin + LANES <= end; begin += LANES)
        discs_add(block, scene, begin, lanes_all(1), dimensions, wants_sums);
    if (begin < end)
        discs_add(block, scene, begin, lanes_to_real(-(lanes_number() < (int32_t)(end - begin))),
                  dimensions, wants_sums);
}

/// Where the discs of a block stand in a grid, in cells from the lower to the higher end, and how
/// far they reach there.
struct discs_view {
    float low[2], high[2], reach;
    float row_height, columns_each; ///< [λ]; per λ
};

/// The discs of a row of cells that is `away` [λ] from the block.
INLINE void discs_add_row(struct discs_block *block, const struct discs_scene *scene,
                          const struct soft_discs_class *class, int row, float away,
                          const struct discs_view *view, const int dimensions,
                          const bool wants_sums) {
    const int n = class->columns;
    const uint32_t *start =
        scene->cells->sorted.start + class->first_cell + (size_t)row * (size_t)n;
    const float square = view->reach * view->reach - away * away;
    const float half = sqrtf(square > 0 ? square : 0) * view->columns_each;
    const int first = (int)floorf(view->low[1] - half),
              last = (int)floorf(view->high[1] + half) + 1;
    if (last - first >= n) {
        discs_add_all(block, scene, start[0], start[n], dimensions, wants_sums);
        return;
    }
    if (first < 0)
        discs_add_all(block, scene, start[first + n], start[n], dimensions, wants_sums);
    if (last > n)
        discs_add_all(block, scene, start[0], start[last - n], dimensions, wants_sums);
    discs_add_all(block, scene, start[first > 0 ? first : 0], start[last < n ? last : n],
                  dimensions, wants_sums);
}

/// The discs of a class around a block.
INLINE void discs_add_class(struct discs_block *block, const struct discs_scene *scene,
                            const struct soft_discs_class *class, const struct discs_view *view,
                            const int dimensions, const bool wants_sums) {
    const int n = class->rows;
    const float height = view->row_height, far = view->reach / height;
    int first = (int)floorf(view->low[0] - far), last = (int)floorf(view->high[0] + far);
    const bool all = last - first + 1 >= n;
    if (all) {
        first = 0;
        last = n - 1;
    }
    for (int row = first; row <= last; row++) {
        const float behind = view->low[0] - (float)(row + 1), ahead = (float)row - view->high[0];
        const float gap = behind > ahead ? behind : ahead;
        discs_add_row(block, scene, class,
                      row < 0   ? row + n
                      : row < n ? row
                                : row - n,
                      all || gap < 0 ? 0 : gap * height, view, dimensions, wants_sums);
    }
}

/// Take the discs of a block; the last stands in for those that it lacks.
INLINE void discs_begin(struct discs_block *block, const struct soft_discs_cells *cells,
                        const struct soft_discs_block *places, const int dimensions) {
    for (int n = 0; n < SOFT_DISCS_BLOCK; n++) {
        const size_t at =
            places->first + (n < (int)places->count ? (uint32_t)n : places->count - 1);
        for (int d = 0; d < dimensions; d++)
            block->place[d][n] = cells->DISCS_PLACES[d][at];
        block->radius[n] = cells->DISCS_RADIUS[at];
        block->at[n] = (int32_t)at;
        block->sum[0][n] = block->sum[1][n] = block->sum[2][n] = block->energy[n] =
            block->virial[n] = lanes_all(0);
    }
}

/// How a block sees a class.
INLINE struct discs_view discs_view_of(const struct soft_discs_cells *cells, const struct box *box,
                                       const struct soft_discs_block *places,
                                       const struct soft_discs_class *class) {
    static const float slack = 1e-4F; // of what is rounded here, in cells and lengths
    const int n[2] = {class->rows, class->columns};
    struct discs_view view = {.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    float radius = 0;
    for (uint32_t at = places->first; at < places->first + places->count; at++) {
        for (int d = 0; d < 2; d++) {
            const float x = 0x1p-32F * (float)(uint32_t)cells->fraction[d][at] * (float)n[d];
            view.low[d] = x < view.low[d] ? x : view.low[d];
            view.high[d] = x > view.high[d] ? x : view.high[d];
        }
        radius = cells->radius[at] > radius ? cells->radius[at] : radius;
    }
    for (int d = 0; d < 2; d++) {
        view.low[d] -= slack;
        view.high[d] += slack;
    }
    view.reach = (radius + (float)class->largest) * (1 + slack);
    view.row_height = (float)(box->length[0] / class->rows);
    view.columns_each = (float)(class->columns / box->length[1]);
    return view;
}

INLINE void discs_end(const struct discs_block *block, const struct soft_discs_pass *pass,
                      const struct soft_discs_block *places, const int dimensions,
                      const bool wants_sums) {
    for (uint32_t n = 0; n < places->count; n++) {
        const size_t at = places->first + n, k = pass->cells->sorted.order[at];
        const double own = pass->strength * (double)pass->cells->DISCS_STIFFNESS[at];
        for (int d = 0; d < dimensions; d++)
            pass->particles->force[d][k] += 4 * own * (double)lanes_sum(block->sum[d][n]);
        if (wants_sums) {
            pass->energy[at] = 0.5 * own * (double)lanes_sum(block->energy[n]);
            pass->virial[at] = -2 * own * (double)lanes_sum(block->virial[n]);
        }
    }
}

INLINE void discs_loop(const struct soft_discs_pass *pass, size_t begin, size_t end,
                       const int dimensions, const bool wants_sums) {
    const struct soft_discs_cells *cells = pass->cells;
    const struct box *box = &pass->particles->box;
    struct discs_scene scene = {.cells = cells};
    for (int d = 0; d < dimensions; d++) {
        scene.length[d] = box->length[d];
        scene.inverse_length[d] = 1 / box->length[d];
        scene.scale[d] = (float)(box->length[d] * 0x1p-32);
    }
    for (size_t b = begin; b < end; b++) {
        struct discs_block block;
        discs_begin(&block, cells, &cells->block[b], dimensions);
        for (int c = 0; c < cells->classes; c++) {
            const struct discs_view view =
                discs_view_of(cells, box, &cells->block[b], &cells->of[c]);
            discs_add_class(&block, &scene, &cells->of[c], &view, dimensions, wants_sums);
        }
        discs_end(&block, pass, &cells->block[b], dimensions, wants_sums);
    }
}

/// The instances for an instruction set and precision, and the table of them.
#define SOFT_DISCS_INSTANCE(name, dimensions, wants_sums)                                          \
    static void name(void *pass, size_t begin, size_t end) {                                       \
        discs_loop(pass, begin, end, dimensions, wants_sums);                                      \
    }
#define SOFT_DISCS_INSTANCES(set)                                                                  \
    SOFT_DISCS_INSTANCE(set##_discs, 2, false)                                                     \
    SOFT_DISCS_INSTANCE(set##_discs_sums, 2, true)                                                 \
    SOFT_DISCS_INSTANCE(set##_spheres, 3, false)                                                   \
    SOFT_DISCS_INSTANCE(set##_spheres_sums, 3, true)                                               \
    soft_discs_kernels set = {{set##_discs, set##_discs_sums}, {set##_spheres, set##_spheres_sums}};
