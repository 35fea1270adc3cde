// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Particles whose last force pass has kept its pairs for the friction.
#pragma once

#include "dynamics/integrator.h"
#include "forces/friction.h"
#include "forces/pair.h"

/// Set `law` first, by kept_pairs_law.
struct kept_pairs {
    struct pair_law law;
    struct particles particles;
    struct neighbours neighbours;
    struct friction friction;
};

/// One temperature and seed for all.
struct pair_law kept_pairs_law(const struct table *potential, const struct table *omega,
                               double time_step);

/// Uniform random particles, of which no two are very close, sorted and listed.
void kept_pairs_init(struct kept_pairs *kept, const struct box *box, size_t count,
                     double separation);
void kept_pairs_clear(struct kept_pairs *kept);

/// What an integrator makes of ω.
void kept_pairs_use(struct kept_pairs *kept, const struct integrator *integrator);

/// The force pass of a step.
void kept_pairs_keep(struct kept_pairs *kept, uint64_t step);

size_t kept_pairs_count(const struct friction *friction);

/// Σ v along each axis, and Σ |v| that its rounding is relative to.
void kept_pairs_momentum(const struct particles *particles, double sum[3], double *size);

/// Friction and noise leave the momentum alone.
void kept_pairs_assert_momentum(const struct particles *particles, const double before[3]);
