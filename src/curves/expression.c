// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/expression.h"

#include <math.h>

int mf_expression_arguments(enum expression_kind kind) {
    if (kind == EXPRESSION_CONSTANT || kind == EXPRESSION_DISTANCE)
        return 0;
    return mf_expression_is_function(kind) ? 1 : 2;
}

bool mf_expression_is_function(enum expression_kind kind) {
    return kind == EXPRESSION_EXP || kind == EXPRESSION_LOG || kind == EXPRESSION_TANH ||
           kind == EXPRESSION_ERF;
}

double mf_expression_function(enum expression_kind kind, double x) {
    return kind == EXPRESSION_EXP    ? exp(x)
           : kind == EXPRESSION_LOG  ? log(x)
           : kind == EXPRESSION_TANH ? tanh(x)
                                     : erf(x);
}

int mf_expression_begin(const struct expression *expression, int end) {
    int wanted = 1, node = end + 1;
    while (wanted > 0) {
        node--;
        wanted += mf_expression_arguments(expression->node[node].kind) - 1;
    }
    return node;
}

int mf_expression_depth(const struct expression *expression) {
    int depth[EXPRESSION_MAX], top = 0;
    for (int k = 0; k < expression->length; k++) {
        const int arguments = mf_expression_arguments(expression->node[k].kind);
        int below = 0;
        for (int n = 0; n < arguments; n++) {
            top--;
            below = depth[top] > below ? depth[top] : below;
        }
        depth[top++] = below + 1;
    }
    return expression->length > 0 ? depth[0] : 0;
}

bool mf_expression_is_exponent(const struct expression *expression, int node) {
    return node + 1 < expression->length && expression->node[node + 1].kind == EXPRESSION_POWER;
}

bool mf_expression_push(struct expression *expression, enum expression_kind kind, double constant) {
    if (expression->length >= EXPRESSION_MAX)
        return false;
    expression->node[expression->length++] = (struct expression_node){kind, constant};
    return true;
}

bool mf_expression_append(struct expression *expression, const struct expression *from, int begin,
                          int end) {
    bool fits = true;
    for (int k = begin; k <= end && fits; k++)
        fits = mf_expression_push(expression, from->node[k].kind, from->node[k].constant);
    return fits;
}

bool mf_expression_scale(struct expression *expression, double length, double unit) {
    struct expression scaled = {0};
    bool fits = mf_expression_push(&scaled, EXPRESSION_CONSTANT, unit);
    for (int k = 0; k < expression->length && fits; k++) {
        const struct expression_node *node = &expression->node[k];
        if (node->kind == EXPRESSION_DISTANCE)
            fits = mf_expression_push(&scaled, EXPRESSION_CONSTANT, 1 / length) &&
                   mf_expression_push(&scaled, EXPRESSION_DISTANCE, 0) &&
                   mf_expression_push(&scaled, EXPRESSION_MULTIPLY, 0);
        else
            fits = mf_expression_push(&scaled, node->kind, node->constant);
    }
    if (!fits || !mf_expression_push(&scaled, EXPRESSION_MULTIPLY, 0))
        return false;
    mf_expression_simplify(&scaled);
    *expression = scaled;
    return true;
}

// Values ------------------------------------------------------------------------------------------

/// Rounding of differences of numbers about 1.
static const double rounding = 1e-12;

double mf_expression_power(double base, double exponent) {
    if (base < 0 && base > -rounding && exponent != rint(exponent))
        return pow(0, exponent);
    return pow(base, exponent);
}

/// A value and its slope.
struct dual {
    double value, slope;
};

static struct dual raise(struct dual base, double exponent) {
    const double value = mf_expression_power(base.value, exponent);
    if (exponent == 0 || base.slope == 0)
        return (struct dual){value, 0};
    return (struct dual){value,
                         exponent * mf_expression_power(base.value, exponent - 1) * base.slope};
}

static struct dual apply(enum expression_kind kind, struct dual x) {
    const double value = mf_expression_function(kind, x.value);
    const double slope = kind == EXPRESSION_EXP    ? value
                         : kind == EXPRESSION_LOG  ? 1 / x.value
                         : kind == EXPRESSION_TANH ? 1 - value * value
                                                   : M_2_SQRTPI * exp(-x.value * x.value);
    return (struct dual){value, slope * x.slope};
}

static struct dual combine(enum expression_kind kind, struct dual a, struct dual b) {
    switch (kind) {
    case EXPRESSION_LESSER:
        return b.value < a.value ? b : a;
    case EXPRESSION_GREATER:
        return b.value > a.value ? b : a;
    case EXPRESSION_ADD:
        return (struct dual){a.value + b.value, a.slope + b.slope};
    case EXPRESSION_SUBTRACT:
        return (struct dual){a.value - b.value, a.slope - b.slope};
    case EXPRESSION_MULTIPLY:
        return (struct dual){a.value * b.value, a.slope * b.value + a.value * b.slope};
    case EXPRESSION_DIVIDE:
        return (struct dual){a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value};
    default:
        return raise(a, b.value);
    }
}

double mf_expression_value(const struct expression *expression, double r, double *slope) {
    struct dual stack[EXPRESSION_MAX] = {{0}};
    int top = 0;
    for (int k = 0; k < expression->length; k++) {
        const struct expression_node *node = &expression->node[k];
        if (node->kind == EXPRESSION_CONSTANT) {
            stack[top++] = (struct dual){node->constant, 0};
        } else if (node->kind == EXPRESSION_DISTANCE) {
            stack[top++] = (struct dual){r, 1};
        } else if (mf_expression_is_function(node->kind)) {
            stack[top - 1] = apply(node->kind, stack[top - 1]);
        } else {
            top--;
            stack[top - 1] = combine(node->kind, stack[top - 1], stack[top]);
        }
    }
    if (slope)
        *slope = stack[0].slope;
    return stack[0].value;
}

// Intervals ---------------------------------------------------------------------------------------

struct interval {
    double low, high; ///< NaN: not finite
};

static const struct interval nowhere = {NAN, NAN};

static struct interval around(double a, double b, double c, double d) {
    return (struct interval){fmin(fmin(a, b), fmin(c, d)), fmax(fmax(a, b), fmax(c, d))};
}

static struct interval times(struct interval a, struct interval b) {
    return around(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high);
}

/// Powers are monotonic on either side of 0.
static struct interval raise_interval(struct interval a, double exponent) {
    const bool whole = exponent == rint(exponent), across = a.low < 0 && a.high > 0;
    if (!whole && a.low < -rounding)
        return nowhere;
    if (exponent < 0 && a.low <= 0 && a.high >= 0)
        return nowhere;
    const double low = mf_expression_power(a.low, exponent),
                 high = mf_expression_power(a.high, exponent);
    return around(low, high, across ? 0 : low, high);
}

/// All functions grow.
static struct interval apply_to_interval(enum expression_kind kind, struct interval x) {
    if (kind == EXPRESSION_LOG && x.low <= 0)
        return nowhere;
    return (struct interval){mf_expression_function(kind, x.low),
                             mf_expression_function(kind, x.high)};
}

static struct interval combine_intervals(enum expression_kind kind, struct interval a,
                                         struct interval b) {
    switch (kind) {
    case EXPRESSION_LESSER:
        return (struct interval){fmin(a.low, b.low), fmin(a.high, b.high)};
    case EXPRESSION_GREATER:
        return (struct interval){fmax(a.low, b.low), fmax(a.high, b.high)};
    case EXPRESSION_ADD:
        return (struct interval){a.low + b.low, a.high + b.high};
    case EXPRESSION_SUBTRACT:
        return (struct interval){a.low - b.high, a.high - b.low};
    case EXPRESSION_MULTIPLY:
        return times(a, b);
    case EXPRESSION_DIVIDE:
        return b.low <= 0 && b.high >= 0 ? nowhere
                                         : times(a, (struct interval){1 / b.high, 1 / b.low});
    default:
        return raise_interval(a, b.low);
    }
}

static bool piece_is_finite(const struct expression *expression, struct interval r) {
    struct interval stack[EXPRESSION_MAX];
    int top = 0;
    for (int k = 0; k < expression->length; k++) {
        const struct expression_node *node = &expression->node[k];
        if (node->kind == EXPRESSION_CONSTANT) {
            stack[top++] = (struct interval){node->constant, node->constant};
        } else if (node->kind == EXPRESSION_DISTANCE) {
            stack[top++] = r;
        } else if (mf_expression_is_function(node->kind)) {
            stack[top - 1] = apply_to_interval(node->kind, stack[top - 1]);
        } else {
            top--;
            stack[top - 1] = combine_intervals(node->kind, stack[top - 1], stack[top]);
        }
        if (!isfinite(stack[top - 1].low) || !isfinite(stack[top - 1].high))
            return false;
    }
    return true;
}

bool mf_expression_is_finite(const struct expression *expression, double low, double high,
                             int pieces, double *where) {
    for (int k = 0; k < pieces; k++) {
        const double from = low + (high - low) * k / pieces;
        const double to = low + (high - low) * (k + 1) / pieces;
        if (piece_is_finite(expression, (struct interval){from, to}))
            continue;
        if (where)
            *where = from;
        return false;
    }
    return true;
}
