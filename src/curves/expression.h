// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Formulas of the distance r as data: constants, r, + − × /, powers and some functions.
///
/// The nodes of a formula stand in postfix order: the arguments of a node come before it, so that
/// the last node is the whole, and a part of the formula is a stretch of the array. Its length is
/// the number of its nodes: 12.5 (1 − r/0.99)² has nine, 12.5 * 1 − r / 0.99 ^ 2.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

enum expression_kind {
    EXPRESSION_CONSTANT,
    EXPRESSION_DISTANCE, ///< r
    EXPRESSION_ADD,
    EXPRESSION_SUBTRACT,
    EXPRESSION_MULTIPLY,
    EXPRESSION_DIVIDE,
    EXPRESSION_POWER, ///< its exponent is a constant, the node before it
    EXPRESSION_EXP,
    EXPRESSION_LOG, ///< natural
    EXPRESSION_TANH,
    EXPRESSION_ERF,
    EXPRESSION_LESSER, ///< min and max of two
    EXPRESSION_GREATER,
};

enum { EXPRESSION_MAX = 64 }; ///< nodes

struct expression_node {
    enum expression_kind kind;
    double constant; ///< of EXPRESSION_CONSTANT, else 0
};

/// Owns nothing: it may be copied.
struct expression {
    int length; ///< 0: none
    struct expression_node node[EXPRESSION_MAX];
};

/// Arguments of a node: 0, 1 or 2.
int mf_expression_arguments(enum expression_kind kind);

/// First node of the part that ends with node `end`.
int mf_expression_begin(const struct expression *expression, int end);

/// Levels of the deepest part: 1 of a constant or of r.
int mf_expression_depth(const struct expression *expression);

/// Whether a node is the exponent of a power.
bool mf_expression_is_exponent(const struct expression *expression, int node);

/// base^exponent. A base below 0 by no more than rounding counts as 0, so that (1 − r/r_c)^2.5
/// is 0 at r_c. NaN of another negative base unless the exponent is whole.
double mf_expression_power(double base, double exponent);

/// Whether a node is a function of one argument, and its value.
bool mf_expression_is_function(enum expression_kind kind);
double mf_expression_function(enum expression_kind kind, double x);

/// Value at r, and, unless it is NULL, its slope by forward differentiation; where both arguments
/// of min or max are equal, that of the first. Threads: any number at once. Tested:
/// test_expression.
double mf_expression_value(const struct expression *expression, double r, double *slope);

/// Whether the formula is finite everywhere in low ≤ r ≤ high: intervals of this range, as many as
/// `pieces`, go through its nodes (R. E. Moore, Interval Analysis (1966)), so that a pole between
/// two points is found, too. A formula that is finite may be refused where one of its parts nearly
/// is not.
/// @param[out] where  left end of the first piece that is not, or NULL
bool mf_expression_is_finite(const struct expression *expression, double low, double high,
                             int pieces, double *where);

/// Make it shorter without changing its values: constants are folded and gathered, and what is
/// neutral or equal to another part falls away (x + 0, 1 x, x − x, x x = x², e^x e^y = e^(x+y)).
/// Constants come first in products and last in sums; x − c becomes x + (−c), x/c becomes (1/c) x.
/// Tested: test_expression.
void mf_expression_simplify(struct expression *expression);

/// Tell it in other units: it becomes unit · f(r/length). False, and nothing changes, if that has
/// more than EXPRESSION_MAX nodes; of up to 30 it never has. Tested: test_expression.
bool mf_expression_scale(struct expression *expression, double length, double unit);

/// @name For those who build one

/// Add a node at the end. Beyond EXPRESSION_MAX nothing is added, and false returned.
bool mf_expression_push(struct expression *expression, enum expression_kind kind, double constant);

/// Add a part of another formula at the end, nodes begin … end of it.
bool mf_expression_append(struct expression *expression, const struct expression *from, int begin,
                          int end);
