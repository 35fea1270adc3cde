// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules of algebra, each for one operator and the parts that it joins, applied from the bottom up
// until none is left that applies. No rule makes a formula longer.
#include "curves/expression.h"

#include <math.h>
#include <string.h>

/// Rounds of all rules; a formula of 64 nodes is done after five or so.
enum { MAX_ROUNDS = 20 };

/// A part of a formula: nodes begin … end.
struct part {
    const struct expression *of;
    int begin, end;
};

static enum expression_kind kind(struct part part) {
    return part.of->node[part.end].kind;
}

static struct part second(struct part part) {
    return (struct part){part.of, mf_expression_begin(part.of, part.end - 1), part.end - 1};
}

static struct part first(struct part part) {
    const int end =
        mf_expression_arguments(kind(part)) == 2 ? second(part).begin - 1 : part.end - 1;
    return (struct part){part.of, part.begin, end};
}

static bool is_number(struct part part) {
    return kind(part) == EXPRESSION_CONSTANT;
}

static double number(struct part part) {
    return part.of->node[part.end].constant;
}

/// Whether a part is k x with a number k.
static bool is_scaled(struct part part) {
    return kind(part) == EXPRESSION_MULTIPLY && is_number(first(part));
}

/// Whether a part is x + k with a number k.
static bool is_shifted(struct part part) {
    return kind(part) == EXPRESSION_ADD && is_number(second(part));
}

static bool is_whole(double x) {
    return x == rint(x);
}

static bool are_equal(struct part a, struct part b) {
    if (a.end - a.begin != b.end - b.begin)
        return false;
    for (int k = 0; k <= a.end - a.begin; k++) {
        const struct expression_node *x = &a.of->node[a.begin + k], *y = &b.of->node[b.begin + k];
        if (x->kind != y->kind || x->constant != y->constant)
            return false;
    }
    return true;
}

/// Whether a stands after b where the order does not matter: what is longer does, and of the same
/// length what differs first in its nodes.
static bool is_after(struct part a, struct part b) {
    if (a.end - a.begin != b.end - b.begin)
        return a.end - a.begin > b.end - b.begin;
    for (int k = 0; k <= a.end - a.begin; k++) {
        const struct expression_node *x = &a.of->node[a.begin + k], *y = &b.of->node[b.begin + k];
        if (x->kind != y->kind)
            return x->kind > y->kind;
        if (x->constant != y->constant)
            return x->constant > y->constant;
    }
    return false;
}

// What a rule makes: no longer than what it was made of, so that it always fits -------------------

static void append(struct expression *to, struct part part) {
    mf_expression_append(to, part.of, part.begin, part.end);
}

static void write_number(struct expression *to, double value) {
    mf_expression_push(to, EXPRESSION_CONSTANT, value);
}

static bool done(struct expression *to, enum expression_kind last) {
    mf_expression_push(to, last, 0);
    return true;
}

static bool make_number(struct expression *to, double value) {
    write_number(to, value);
    return true;
}

static bool make(struct expression *to, struct part part) {
    append(to, part);
    return true;
}

/// x ∘ y
static bool make_pair(struct expression *to, struct part x, enum expression_kind operation,
                      struct part y) {
    append(to, x);
    append(to, y);
    return done(to, operation);
}

/// k x
static bool make_scaled(struct expression *to, double k, struct part x) {
    write_number(to, k);
    append(to, x);
    return done(to, EXPRESSION_MULTIPLY);
}

/// x + k
static bool make_shifted(struct expression *to, struct part x, double k) {
    append(to, x);
    write_number(to, k);
    return done(to, EXPRESSION_ADD);
}

/// k (x ∘ y)
static bool make_scaled_pair(struct expression *to, double k, struct part x,
                             enum expression_kind operation, struct part y) {
    write_number(to, k);
    append(to, x);
    append(to, y);
    mf_expression_push(to, operation, 0);
    return done(to, EXPRESSION_MULTIPLY);
}

/// (x ∘ y) + k
static bool make_shifted_pair(struct expression *to, struct part x, enum expression_kind operation,
                              struct part y, double k) {
    append(to, x);
    append(to, y);
    mf_expression_push(to, operation, 0);
    write_number(to, k);
    return done(to, EXPRESSION_ADD);
}

/// x^p
static bool make_power(struct expression *to, struct part x, double p) {
    append(to, x);
    write_number(to, p);
    return done(to, EXPRESSION_POWER);
}

/// k x^p
static bool make_scaled_power(struct expression *to, double k, struct part x, double p) {
    write_number(to, k);
    make_power(to, x, p);
    return done(to, EXPRESSION_MULTIPLY);
}

// Rules -------------------------------------------------------------------------------------------

/// A part as k x: k is 1 unless it is scaled.
static double factor_of(struct part *part) {
    if (!is_scaled(*part))
        return 1;
    const double k = number(first(*part));
    *part = second(*part);
    return k;
}

static bool reduce_add(struct part a, struct part b, struct expression *to) {
    if (is_number(a))
        return make_shifted(to, b, number(a));
    if (is_number(b) && number(b) == 0)
        return make(to, a);
    if (is_number(b) && is_shifted(a))
        return make_shifted(to, first(a), number(second(a)) + number(b));
    if (is_number(b) && kind(a) == EXPRESSION_SUBTRACT && is_number(first(a))) {
        write_number(to, number(first(a)) + number(b));
        append(to, second(a));
        return done(to, EXPRESSION_SUBTRACT);
    }
    if (is_shifted(a) && !is_number(b))
        return make_shifted_pair(to, first(a), EXPRESSION_ADD, b, number(second(a)));
    if (is_shifted(b))
        return make_shifted_pair(to, a, EXPRESSION_ADD, first(b), number(second(b)));
    struct part x = a, y = b;
    const double k = factor_of(&x), m = factor_of(&y);
    if (!is_number(b) && are_equal(x, y))
        return make_scaled(to, k + m, x);
    if (m == -1)
        return make_pair(to, a, EXPRESSION_SUBTRACT, y);
    return !is_number(b) && is_after(a, b) && make_pair(to, b, EXPRESSION_ADD, a);
}

static bool reduce_subtract(struct part a, struct part b, struct expression *to) {
    if (is_number(b))
        return make_shifted(to, a, -number(b));
    if (is_number(a) && number(a) == 0)
        return make_scaled(to, -1, b);
    if (are_equal(a, b))
        return make_number(to, 0);
    if (is_scaled(b)) {
        append(to, a);
        make_scaled(to, -number(first(b)), second(b));
        return done(to, EXPRESSION_ADD);
    }
    if (is_number(a) && is_shifted(b)) {
        write_number(to, number(a) - number(second(b)));
        append(to, first(b));
        return done(to, EXPRESSION_SUBTRACT);
    }
    if (is_shifted(a))
        return make_shifted_pair(to, first(a), EXPRESSION_SUBTRACT, b, number(second(a)));
    if (is_shifted(b))
        return make_shifted_pair(to, a, EXPRESSION_SUBTRACT, first(b), -number(second(b)));
    return false;
}

/// A part as x^p: p is 1 unless it is a power.
static double exponent_of(struct part *part) {
    if (kind(*part) != EXPRESSION_POWER)
        return 1;
    const double p = number(second(*part));
    *part = first(*part);
    return p;
}

/// c b with a number c.
static bool scale(double c, struct part b, struct expression *to) {
    if (c == 0)
        return make_number(to, 0);
    if (c == 1)
        return make(to, b);
    if (is_scaled(b))
        return make_scaled(to, c * number(first(b)), second(b));
    if (c < 0 && kind(b) == EXPRESSION_SUBTRACT)
        return make_scaled_pair(to, -c, second(b), EXPRESSION_SUBTRACT, first(b));
    if (kind(b) == EXPRESSION_DIVIDE && is_number(first(b))) {
        write_number(to, c * number(first(b)));
        append(to, second(b));
        return done(to, EXPRESSION_DIVIDE);
    }
    if (is_shifted(b) && is_scaled(first(b)) && number(first(first(b))) != 0) {
        const double k = number(first(first(b)));
        write_number(to, c * k);
        make_shifted(to, second(first(b)), number(second(b)) / k);
        return done(to, EXPRESSION_MULTIPLY);
    }
    return false;
}

static bool reduce_multiply(struct part a, struct part b, struct expression *to) {
    if (is_number(a))
        return scale(number(a), b, to);
    if (is_number(b))
        return make_scaled(to, number(b), a);
    if (is_scaled(a))
        return make_scaled_pair(to, number(first(a)), second(a), EXPRESSION_MULTIPLY, b);
    if (is_scaled(b))
        return make_scaled_pair(to, number(first(b)), a, EXPRESSION_MULTIPLY, second(b));
    if (kind(b) == EXPRESSION_DIVIDE && is_number(first(b)))
        return make_scaled_pair(to, number(first(b)), a, EXPRESSION_DIVIDE, second(b));
    if (kind(a) == EXPRESSION_DIVIDE && is_number(first(a)))
        return make_scaled_pair(to, number(first(a)), b, EXPRESSION_DIVIDE, second(a));
    if (kind(a) == EXPRESSION_EXP && kind(b) == EXPRESSION_EXP) {
        append(to, first(a));
        append(to, first(b));
        mf_expression_push(to, EXPRESSION_ADD, 0);
        return done(to, EXPRESSION_EXP);
    }
    struct part x = a, y = b;
    const double p = exponent_of(&x), q = exponent_of(&y);
    if (are_equal(x, y))
        return make_power(to, x, p + q);
    return is_after(a, b) && make_pair(to, b, EXPRESSION_MULTIPLY, a);
}

static bool reduce_divide(struct part a, struct part b, struct expression *to) {
    if (is_number(b) && number(b) != 0)
        return make_scaled(to, 1 / number(b), a);
    if (is_number(a) && number(a) == 0)
        return make_number(to, 0);
    if (are_equal(a, b))
        return make_number(to, 1);
    if (is_scaled(a))
        return make_scaled_pair(to, number(first(a)), second(a), EXPRESSION_DIVIDE, b);
    if (is_scaled(b) && number(first(b)) != 0)
        return make_scaled_pair(to, 1 / number(first(b)), a, EXPRESSION_DIVIDE, second(b));
    if (kind(b) == EXPRESSION_EXP && is_scaled(first(b))) {
        append(to, a);
        make_scaled(to, -number(first(first(b))), second(first(b)));
        mf_expression_push(to, EXPRESSION_EXP, 0);
        return done(to, EXPRESSION_MULTIPLY);
    }
    if (kind(b) == EXPRESSION_POWER && is_number(a) && number(a) == 1)
        return make_power(to, first(b), -number(second(b)));
    if (kind(b) == EXPRESSION_POWER) {
        append(to, a);
        make_power(to, first(b), -number(second(b)));
        return done(to, EXPRESSION_MULTIPLY);
    }
    return false;
}

static bool reduce_power(struct part a, double p, struct expression *to) {
    if (p == 0)
        return make_number(to, 1);
    if (p == 1)
        return make(to, a);
    if (p == -1) {
        write_number(to, 1);
        append(to, a);
        return done(to, EXPRESSION_DIVIDE);
    }
    if (kind(a) == EXPRESSION_POWER && is_whole(p))
        return make_power(to, first(a), p * number(second(a)));
    if (kind(a) == EXPRESSION_EXP) {
        make_scaled(to, p, first(a));
        return done(to, EXPRESSION_EXP);
    }
    const bool scaled = is_scaled(a) || (kind(a) == EXPRESSION_DIVIDE && is_number(first(a)));
    if (scaled && (number(first(a)) > 0 || (is_whole(p) && number(first(a)) != 0)))
        return make_scaled_power(to, pow(number(first(a)), p), second(a), is_scaled(a) ? p : -p);
    if (kind(a) == EXPRESSION_SUBTRACT && is_number(first(a)) && is_whole(p / 2)) {
        make_shifted(to, second(a), -number(first(a)));
        write_number(to, p);
        return done(to, EXPRESSION_POWER);
    }
    if (is_shifted(a) && is_scaled(first(a))) {
        const double k = number(first(first(a)));
        if (k > 0 || (is_whole(p) && k != 0)) {
            write_number(to, pow(k, p));
            make_shifted(to, second(first(a)), number(second(a)) / k);
            write_number(to, p);
            mf_expression_push(to, EXPRESSION_POWER, 0);
            return done(to, EXPRESSION_MULTIPLY);
        }
    }
    return false;
}

static bool reduce_exp(struct part a, struct expression *to) {
    if (!is_shifted(a))
        return false;
    write_number(to, exp(number(second(a))));
    append(to, first(a));
    mf_expression_push(to, EXPRESSION_EXP, 0);
    return done(to, EXPRESSION_MULTIPLY);
}

/// An operator of numbers alone.
static bool fold(struct part whole, struct expression *to) {
    const int arguments = mf_expression_arguments(kind(whole));
    struct expression part = {0};
    if (arguments == 0 || !is_number(first(whole)) || !is_number(second(whole)))
        return false;
    mf_expression_append(&part, whole.of, whole.begin, whole.end);
    const double value = mf_expression_value(&part, 0, NULL);
    return isfinite(value) && make_number(to, value);
}

static bool reduce(struct part whole, struct expression *to) {
    if (fold(whole, to))
        return true;
    switch (kind(whole)) {
    case EXPRESSION_ADD:
        return reduce_add(first(whole), second(whole), to);
    case EXPRESSION_SUBTRACT:
        return reduce_subtract(first(whole), second(whole), to);
    case EXPRESSION_MULTIPLY:
        return reduce_multiply(first(whole), second(whole), to);
    case EXPRESSION_DIVIDE:
        return reduce_divide(first(whole), second(whole), to);
    case EXPRESSION_POWER:
        return reduce_power(first(whole), number(second(whole)), to);
    case EXPRESSION_EXP:
        return reduce_exp(first(whole), to);
    default:
        return false;
    }
}

static bool has_finite_numbers(const struct expression *expression) {
    for (int k = 0; k < expression->length; k++)
        if (!isfinite(expression->node[k].constant))
            return false;
    return true;
}

/// One round: every node with its arguments as they have become. Returns whether a rule applied.
static bool simplify_once(const struct expression *from, struct expression *to) {
    bool changed = false;
    to->length = 0;
    for (int k = 0; k < from->length; k++) {
        struct expression made = {0};
        mf_expression_push(to, from->node[k].kind, from->node[k].constant);
        const int end = to->length - 1, begin = mf_expression_begin(to, end);
        if (!reduce((struct part){to, begin, end}, &made) || !has_finite_numbers(&made))
            continue;
        to->length = begin;
        mf_expression_append(to, &made, 0, made.length - 1);
        changed = true;
    }
    return changed;
}

void mf_expression_simplify(struct expression *expression) {
    struct expression simpler = {0};
    for (int round = 0; round < MAX_ROUNDS; round++) {
        const bool changed = simplify_once(expression, &simpler);
        memset(expression->node, 0, sizeof expression->node);
        expression->length = 0;
        mf_expression_append(expression, &simpler, 0, simpler.length - 1);
        if (!changed)
            break;
    }
}
