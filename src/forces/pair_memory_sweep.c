// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/pair_memory.h"

#include "base/lanes.h"
#include "base/rng.h"
#include "base/simd.h"
#include "forces/friction.h"

#include <math.h>

/// Pairs of the list looked at together. What is known of them before velocities change is computed
/// in columns, which vectors do; velocities then change pair after pair.
enum { BLOCK = 512, WORDS = 4 };

/// Pairs of a block that are in range.
struct columns {
    int count;
    size_t pair[BLOCK]; ///< among all
    double square[BLOCK], separation[3][BLOCK];
    double r[BLOCK];
    float direction[BLOCK][4]; ///< e, from second to first; the last is 0
    int32_t kind[BLOCK];
    uint32_t word[WORDS][BLOCK];
    double cosine[PAIR_MEMORY_MOST_MODES][BLOCK], sine[PAIR_MEMORY_MOST_MODES][BLOCK];
    double damping[BLOCK], kick[BLOCK][4]; ///< of what is across
};

/// What the numbers are for: the lower bits of the fourth counter.
enum { OF_STEP, OF_ENTRY = 1 << 4, OF_TRANSVERSE = 2 << 4 };

static inline void random_words(const struct pair_memory *memory, uint64_t step, uint32_t low,
                                uint32_t high, uint32_t purpose, uint32_t word[WORDS]) {
    const uint64_t seed = memory->scene.seed;
    const uint32_t extra = (uint32_t)(step >> 32) << 6 | purpose;
    rng_philox_words((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)step, low, high,
                     rng_stream_word(RNG_PAIR_MEMORY, extra), word);
}

/// Separations of all pairs of the block; those in range come first.
static inline void measure(struct columns *columns, struct pair_memory *memory,
                           const struct particles *particles, size_t begin, int count) {
    double separation[3][BLOCK] = {{0}}, square[BLOCK] = {0};
    const int32_t *first = memory->first + begin, *second = memory->second + begin;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const int32_t *fraction = particles->fraction[d];
        const double scale = 0x1p-32 * particles->box.length[d];
        for (int n = 0; n < count; n++) {
            separation[d][n] =
                scale * box_fraction_difference(fraction[first[n]], fraction[second[n]]);
            square[n] += separation[d][n] * separation[d][n];
        }
    }
    int near = 0;
    for (int n = 0; n < count; n++) {
        const int32_t kind = memory->kind[begin + (size_t)n];
        const double most = memory->range[kind] * memory->range[kind];
        columns->pair[near] = begin + (size_t)n;
        columns->kind[near] = kind;
        columns->square[near] = square[n];
        for (int d = 0; d < 3; d++)
            columns->separation[d][near] = separation[d][n];
        if (memory->variables > 0 && square[n] >= most)
            memory->value[0][begin + (size_t)n] = NAN;
        near += square[n] < most && square[n] > 0;
    }
    columns->count = near;
}

static inline void find_directions(struct columns *columns) {
    for (int n = 0; n < columns->count; n++) {
        const double r = sqrt(columns->square[n]), inverse = 1 / r;
        columns->r[n] = r;
        for (int d = 0; d < 3; d++)
            columns->direction[n][d] = (float)(columns->separation[d][n] * inverse);
        columns->direction[n][3] = 0;
    }
}

/// The value of a table's rows at r.
static inline double row_value(const double (*rows)[2], const struct table *table, int kind,
                               double r) {
    const double place = r * mf_table_inverse_spacing(table, kind);
    const int interval = place < TABLE_INTERVALS ? (int)place : TABLE_INTERVALS;
    const double *c = rows[kind * table_stride(table) + interval];
    return c[0] + (place - interval) * c[1];
}

static inline void find_rotations(struct columns *columns, const struct pair_memory *memory,
                                  int m) {
    const double(*rows)[2] = (const double(*)[2])memory->mode[m].half;
    for (int n = 0; n < columns->count; n++) {
        const double t =
            row_value(rows, memory->law.mode[m].omega, columns->kind[n], columns->r[n]);
        const double scale = 1 / (1 + t * t);
        columns->cosine[m][n] = (1 - t * t) * scale;
        columns->sine[m][n] = 2 * t * scale;
    }
}

static inline void draw_words(struct columns *columns, const struct pair_memory *memory,
                              uint64_t step, uint32_t purpose) {
    for (int n = 0; n < columns->count; n++) {
        uint32_t word[WORDS];
        random_words(memory, step, memory->low[columns->pair[n]], memory->high[columns->pair[n]],
                     purpose, word);
        for (int k = 0; k < WORDS; k++)
            columns->word[k][n] = word[k];
    }
}

/// Pairs that come into the range draw their variables from the stationary law.
static inline void greet(struct columns *columns, struct pair_memory *memory, uint64_t step) {
    const double sigma = sqrt(memory->scene.temperature);
    for (int n = 0; n < columns->count; n++) {
        const size_t p = columns->pair[n];
        if (!isnan(memory->value[0][p]))
            continue;
        for (int k = 0; k < memory->variables; k++) {
            uint32_t word[WORDS];
            random_words(memory, step, memory->low[p], memory->high[p],
                         OF_ENTRY + (uint32_t)(k / WORDS), word);
            memory->value[k][p] = sigma * normal_of_word(&memory->normal, word[k % WORDS]);
        }
    }
}

/// The variables of a mode without u.
static inline void relax(struct columns *columns, struct pair_memory *memory, uint64_t step,
                         int m) {
    const double keep = memory->mode[m].keep, turn = memory->mode[m].turn;
    const double noise = memory->mode[m].noise;
    const bool two = memory->law.mode[m].frequency > 0;
    double *z = memory->value[memory->mode[m].first];
    double *y = two ? memory->value[memory->mode[m].first + 1] : NULL;
    draw_words(columns, memory, step, OF_STEP + (uint32_t)m);
    for (int n = 0; n < columns->count; n++) {
        const size_t p = columns->pair[n];
        const double was = z[p];
        z[p] = keep * was + noise * normal_of_word(&memory->normal, columns->word[0][n]);
        if (two) {
            z[p] += turn * y[p];
            y[p] = keep * y[p] - turn * was +
                   noise * normal_of_word(&memory->normal, columns->word[1][n]);
        }
    }
}

/// Damping and kicks across e.
static inline void find_kicks(struct columns *columns, const struct pair_memory *memory,
                              uint64_t step, int dimensions) {
    const double(*rows)[2] = (const double(*)[2])memory->root;
    draw_words(columns, memory, step, OF_TRANSVERSE);
    for (int n = 0; n < columns->count; n++) {
        const double root =
            row_value(rows, memory->law.transverse, columns->kind[n], columns->r[n]);
        const double d = root * root, size = sqrt(2 * memory->scene.temperature * d * (1 - d));
        double xi[3] = {0}, along = 0;
        for (int k = 0; k < dimensions; k++) {
            xi[k] = normal_of_word(&memory->normal, columns->word[k][n]);
            along += xi[k] * columns->direction[n][k];
        }
        columns->damping[n] = d;
        for (int k = 0; k < 3; k++)
            columns->kick[n][k] = size * (xi[k] - along * columns->direction[n][k]);
        columns->kick[n][3] = 0;
    }
}

static inline double sum_of(lanes_double4 a) {
    return (a[0] + a[1]) + a[2];
}

/// Rotate (u/√2, z) of each mode, one after the other.
static inline void rotate(const struct columns *columns, int n, struct pair_memory *memory,
                          lanes_double4 *v) {
    const size_t p = columns->pair[n];
    const lanes_double4 e = lanes_load_double4(columns->direction[n]);
    lanes_double4 *a = &v[memory->first[p]], *b = &v[memory->second[p]];
    const double begin = M_SQRT1_2 * sum_of(e * (*a - *b));
    double w = begin;
    for (int m = 0; m < memory->law.modes; m++) {
        double *z = &memory->value[memory->mode[m].first][p];
        const double c = columns->cosine[m][n], s = columns->sine[m][n], was = w;
        w = c * was + s * *z;
        *z = c * *z - s * was;
    }
    const lanes_double4 change = M_SQRT1_2 * (w - begin) * e;
    *a += change;
    *b -= change;
}

static inline void damp_across(const struct columns *columns, int n,
                               const struct pair_memory *memory, lanes_double4 *v) {
    const size_t p = columns->pair[n];
    const lanes_double4 e = lanes_load_double4(columns->direction[n]);
    lanes_double4 *a = &v[memory->first[p]], *b = &v[memory->second[p]], kick;
    memcpy(&kick, columns->kick[n], sizeof kick);
    const lanes_double4 u = *a - *b, across = u - sum_of(e * u) * e;
    const lanes_double4 change = kick - columns->damping[n] * across;
    *a += change;
    *b -= change;
}

SIMD_CLONES static void sweep_block(struct pair_memory *memory, const struct particles *particles,
                                    uint64_t step, size_t begin, int count, lanes_double4 *v) {
    struct columns columns;
    measure(&columns, memory, particles, begin, count);
    find_directions(&columns);
    if (memory->variables > 0)
        greet(&columns, memory, step);
    for (int m = 0; m < memory->law.modes; m++) {
        find_rotations(&columns, memory, m);
        relax(&columns, memory, step, m);
    }
    if (memory->law.modes > 0)
        for (int n = 0; n < columns.count; n++)
            rotate(&columns, n, memory, v);
    if (memory->law.transverse == NULL)
        return;
    find_kicks(&columns, memory, step, particles->box.dimensions);
    for (int n = 0; n < columns.count; n++)
        damp_across(&columns, n, memory, v);
}

static void sweep_part(struct pair_memory *memory, const struct particles *particles, uint64_t step,
                       int p, lanes_double4 *v) {
    for (size_t k = memory->begin[p]; k < memory->end[p]; k += BLOCK) {
        const size_t left = memory->end[p] - k;
        sweep_block(memory, particles, step, k, left < BLOCK ? (int)left : BLOCK, v);
    }
}

void mf_pair_memory_sweep(struct pair_memory *memory, struct particles *particles, uint64_t step) {
    const int threads = particles->threads;
    mf_friction_load_velocities(particles);
    lanes_double4 *v = (lanes_double4 *)particles->kernel_force;
    // The parts of the list: even ones, which never meet, then odd ones.
    for (int first = 0; first < 2; first++) {
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
        for (int p = first; p < memory->parts; p += 2)
            sweep_part(memory, particles, step, p, v);
    }
    mf_friction_store_velocities(particles);
}
