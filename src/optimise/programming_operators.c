// SPDX-License-Identifier: GPL-3.0-or-later
#include "programming_operators.h"

#include <math.h>

/// Exponents that physics has often; others come by the fit of constants.
static const double exponents[] = {2, 3, 4, -1, -2, -3, -6, -9, -12, 0.5, 1.5};
enum { EXPONENTS = sizeof exponents / sizeof *exponents };

/// Share of parts that are r where they are not a constant, and so on.
static const double leaf_is_distance = 0.6, stays_short = 0.3;

static double uniform(struct rng_sequence *random) {
    return mf_rng_sequence_uniform(random);
}

/// A constant of either sign, from about 0.1 to 10.
static double random_constant(struct rng_sequence *random) {
    double normal[2];
    const double u = uniform(random);
    rng_box_muller(u, uniform(random), normal);
    return (uniform(random) < 0.5 ? -1 : 1) * exp(1.2 * normal[0]);
}

/// −x² and the like stand in an exp as often as not.
static void push_exponential(struct rng_sequence *random, struct expression *to) {
    mf_expression_push(to, EXPRESSION_CONSTANT, -fabs(random_constant(random)));
    mf_expression_push(to, EXPRESSION_MULTIPLY, 0);
    mf_expression_push(to, EXPRESSION_EXP, 0);
}

static void push_power(struct rng_sequence *random, struct expression *to) {
    mf_expression_push(to, EXPRESSION_CONSTANT,
                       exponents[mf_rng_sequence_below(random, EXPONENTS)]);
    mf_expression_push(to, EXPRESSION_POWER, 0);
}

static void push_random(struct rng_sequence *random, int depth, struct expression *to) {
    if (depth <= 1 || uniform(random) < stays_short) {
        const bool distance = uniform(random) < leaf_is_distance;
        mf_expression_push(to, distance ? EXPRESSION_DISTANCE : EXPRESSION_CONSTANT,
                           distance ? 0 : random_constant(random));
        return;
    }
    push_random(random, depth - 1, to);
    const uint32_t choice = mf_rng_sequence_below(random, 8);
    if (choice == 0) {
        push_exponential(random, to);
    } else if (choice < 3) {
        push_power(random, to);
    } else {
        static const enum expression_kind operations[] = {EXPRESSION_ADD, EXPRESSION_SUBTRACT,
                                                          EXPRESSION_MULTIPLY, EXPRESSION_MULTIPLY,
                                                          EXPRESSION_DIVIDE};
        push_random(random, depth - 1, to);
        mf_expression_push(to, operations[choice - 3], 0);
    }
}

struct expression mf_programming_random(struct rng_sequence *random, int depth) {
    struct expression made = {0};
    push_random(random, depth, &made);
    return made;
}

/// The end of a part at random, no exponent.
static int random_part(struct rng_sequence *random, const struct expression *expression) {
    int end;
    do
        end = (int)mf_rng_sequence_below(random, (uint32_t)expression->length);
    while (mf_expression_is_exponent(expression, end));
    return end;
}

/// `in` with nodes begin … end of `from` in the place of the part that ends with `at`.
static struct expression replace(const struct expression *in, int at, const struct expression *from,
                                 int begin, int end) {
    struct expression made = {0};
    const bool fits = mf_expression_append(&made, in, 0, mf_expression_begin(in, at) - 1) &&
                      mf_expression_append(&made, from, begin, end) &&
                      mf_expression_append(&made, in, at + 1, in->length - 1);
    return fits ? made : *in;
}

struct expression mf_programming_cross(struct rng_sequence *random, const struct expression *first,
                                       const struct expression *second) {
    const int at = random_part(random, first), end = random_part(random, second);
    return replace(first, at, second, mf_expression_begin(second, end), end);
}

static struct expression change_part(struct rng_sequence *random, const struct expression *parent) {
    const struct expression part = mf_programming_random(random, 3);
    return replace(parent, random_part(random, parent), &part, 0, part.length - 1);
}

/// x becomes x ∘ y or y ∘ x with a small y.
static void push_joined(struct rng_sequence *random, const struct expression *from, int begin,
                        int end, struct expression *to) {
    const struct expression other =
        mf_programming_random(random, 1 + (int)mf_rng_sequence_below(random, 2));
    const bool behind = uniform(random) < 0.5;
    if (behind)
        mf_expression_append(to, from, begin, end);
    mf_expression_append(to, &other, 0, other.length - 1);
    if (!behind)
        mf_expression_append(to, from, begin, end);
    mf_expression_push(
        to, (enum expression_kind)(EXPRESSION_ADD + mf_rng_sequence_below(random, 4)), 0);
}

/// A part x becomes exp(−c x), x^p, (x + c)^p, or is joined with another.
static struct expression grow(struct rng_sequence *random, const struct expression *parent) {
    struct expression part = {0};
    const int at = random_part(random, parent), begin = mf_expression_begin(parent, at);
    const uint32_t choice = mf_rng_sequence_below(random, 10);
    if (choice < 3)
        mf_expression_append(&part, parent, begin, at);
    if (choice == 2) {
        mf_expression_push(&part, EXPRESSION_CONSTANT, random_constant(random));
        mf_expression_push(&part, EXPRESSION_ADD, 0);
    }
    if (choice == 0)
        push_exponential(random, &part);
    else if (choice < 3)
        push_power(random, &part);
    else
        push_joined(random, parent, begin, at, &part);
    return replace(parent, at, &part, 0, part.length - 1);
}

/// A part becomes a part of itself.
static struct expression hoist(struct rng_sequence *random, const struct expression *parent) {
    const int at = random_part(random, parent), begin = mf_expression_begin(parent, at);
    int end;
    do
        end = begin + (int)mf_rng_sequence_below(random, (uint32_t)(at - begin + 1));
    while (mf_expression_is_exponent(parent, end));
    return replace(parent, at, parent, mf_expression_begin(parent, end), end);
}

/// A node becomes another of as many arguments, a constant another one.
static struct expression change_node(struct rng_sequence *random, const struct expression *parent) {
    struct expression made = *parent;
    const int at = (int)mf_rng_sequence_below(random, (uint32_t)made.length);
    struct expression_node *node = &made.node[at];
    if (mf_expression_is_exponent(&made, at)) {
        node->constant = uniform(random) < 0.5 ? exponents[mf_rng_sequence_below(random, EXPONENTS)]
                                               : -node->constant;
    } else if (mf_expression_arguments(node->kind) == 0) {
        const bool distance = node->kind != EXPRESSION_DISTANCE && uniform(random) < 0.3;
        node->kind = distance ? EXPRESSION_DISTANCE : EXPRESSION_CONSTANT;
        node->constant = distance ? 0 : random_constant(random);
    } else if (node->kind != EXPRESSION_EXP && node->kind != EXPRESSION_POWER) {
        node->kind = (enum expression_kind)(EXPRESSION_ADD + mf_rng_sequence_below(random, 4));
    }
    return made;
}

void mf_programming_shake(struct rng_sequence *random, struct expression *expression) {
    for (int k = 0; k < expression->length; k++) {
        double normal[2];
        const double u = uniform(random);
        rng_box_muller(u, uniform(random), normal);
        if (expression->node[k].kind == EXPRESSION_CONSTANT &&
            !mf_expression_is_exponent(expression, k))
            expression->node[k].constant *= (normal[1] < -1 ? -1 : 1) * exp(normal[0]);
    }
}

struct expression mf_programming_mutate(struct rng_sequence *random,
                                        const struct expression *parent) {
    switch (mf_rng_sequence_below(random, 7)) {
    case 0:
    case 1:
        return change_part(random, parent);
    case 2:
    case 3:
    case 4:
        return grow(random, parent);
    case 5:
        return hoist(random, parent);
    default:
        return change_node(random, parent);
    }
}
