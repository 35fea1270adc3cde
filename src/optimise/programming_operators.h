// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How genetic programming makes formulas: at random, and from others.
#pragma once

#include "base/rng.h"
#include "curves/expression.h"

/// A formula at random, of at most so many levels, 1 at least. Constants are of the size of r_c.
struct expression mf_programming_random(struct rng_sequence *random, int depth);

/// A child: the first with a part of the second in the place of one of its own, or the first
/// changed by a mutation. One that does not fit into EXPRESSION_MAX nodes is the first itself.
struct expression mf_programming_cross(struct rng_sequence *random, const struct expression *first,
                                       const struct expression *second);
struct expression mf_programming_mutate(struct rng_sequence *random,
                                        const struct expression *parent);

/// Constants elsewhere, from where their fit may end in another minimum; exponents stay.
void mf_programming_shake(struct rng_sequence *random, struct expression *expression);
