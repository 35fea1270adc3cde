// SPDX-License-Identifier: GPL-3.0-or-later
//
// Conjugate gradients: M. R. Hestenes and E. Stiefel, J. Res. Natl. Bur. Stand. 49, 409 (1952).
#include "base/parallel.h"
#include "base/simd.h"
#include "forces/friction.h"

/// v' = v + x with (1 + G) x = kicks − 2 G v: residual r, direction p, and (1 + G) p in q.
struct solution {
    struct particles *particles;
    double (*x)[4], (*r)[4], (*p)[4], (*q)[4];
    double along; ///< how far along p, or how much of the last p to keep
};

static void begin(void *context, size_t begin, size_t end) {
    const struct solution *s = context;
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 4; d++) {
            s->x[k][d] = 0;
            s->p[k][d] = d < 3 ? 2 * s->particles->velocity[d][k] : 0;
        }
}

SIMD_CLONES static double square_residual(const void *context, size_t begin, size_t end) {
    const struct solution *s = context;
    double sum[4] = {0};
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 4; d++)
            sum[d] += s->r[k][d] * s->r[k][d];
    return (sum[0] + sum[1]) + sum[2];
}

/// p·q, after what mf_friction_apply has left out of q = (1 + G) p.
SIMD_CLONES static double complete_product(const void *context, size_t begin, size_t end) {
    const struct solution *s = context;
    double sum[4] = {0};
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 4; d++) {
            s->q[k][d] = s->p[k][d] - s->q[k][d];
            sum[d] += s->p[k][d] * s->q[k][d];
        }
    return (sum[0] + sum[1]) + sum[2];
}

SIMD_CLONES static void advance(void *context, size_t begin, size_t end) {
    const struct solution *s = context;
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 4; d++) {
            s->x[k][d] += s->along * s->p[k][d];
            s->r[k][d] -= s->along * s->q[k][d];
        }
}

SIMD_CLONES static void turn(void *context, size_t begin, size_t end) {
    const struct solution *s = context;
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 4; d++)
            s->p[k][d] = s->r[k][d] + s->along * s->p[k][d];
}

static void finish(void *context, size_t begin, size_t end) {
    const struct solution *s = context;
    for (int d = 0; d < s->particles->box.dimensions; d++)
        for (size_t k = begin; k < end; k++)
            s->particles->velocity[d][k] += s->x[k][d];
}

enum status mf_friction_solve(struct friction *friction, struct particles *particles,
                              double tolerance) {
    enum { MAX_ITERATIONS = 1000 };
    TRY(mf_friction_reserve_work(friction, particles->count));
    struct solution s = {.particles = particles,
                         .x = friction->work[0],
                         .r = friction->work[1],
                         .p = friction->work[2],
                         .q = friction->work[3]};
    const size_t count = particles->count;
    const int threads = particles->threads;
    mf_parallel_for(count, threads, begin, &s);
    mf_friction_apply(friction, particles, (const double(*)[4])s.p, s.r, true);
    memcpy(s.p, s.r, count * sizeof *s.p);
    double squares = mf_parallel_sum(count, threads, square_residual, &s);
    const double enough = tolerance * tolerance * squares;
    for (int iteration = 0; squares > enough && iteration < MAX_ITERATIONS; iteration++) {
        mf_friction_apply(friction, particles, (const double(*)[4])s.p, s.q, false);
        s.along = squares / mf_parallel_sum(count, threads, complete_product, &s);
        mf_parallel_for(count, threads, advance, &s);
        const double before = squares;
        squares = mf_parallel_sum(count, threads, square_residual, &s);
        s.along = squares / before;
        mf_parallel_for(count, threads, turn, &s);
    }
    if (squares > enough)
        return mf_status_fail(STATUS_UNSTABLE,
                              "the implicit friction is not solved after %d iterations; lower "
                              "\"time_step\" or raise \"tolerance\"",
                              MAX_ITERATIONS);
    mf_parallel_for(count, threads, finish, &s);
    return STATUS_OK;
}
