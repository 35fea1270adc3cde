// SPDX-License-Identifier: GPL-3.0-or-later
#include "programming_fit.h"

#include <math.h>
#include <string.h>

/// Constants beyond these are of no use: their formulas have lost all digits.
static const double largest_constant = 1e9, largest_exponent = 30;

enum status mf_programming_fit_init(struct programming_scratch *scratch,
                                    const struct programming_points *points) {
    *scratch = (struct programming_scratch){0};
    TRY_ARRAY(scratch->value, EXPRESSION_MAX * (points->count + 1));
    TRY_ARRAY(scratch->adjoint, EXPRESSION_MAX * (points->count + 1));
    TRY_ARRAY(scratch->difference, points->count);
    TRY_ARRAY(scratch->slope, points->count);
    TRY_ARRAY(scratch->jacobian, EXPRESSION_MAX * points->count);
    TRY_ARRAY(scratch->residual, points->rows);
    TRY_ARRAY(scratch->columns, EXPRESSION_MAX * points->rows);
    return STATUS_OK;
}

void mf_programming_fit_clear(struct programming_scratch *scratch) {
    double *arrays[] = {scratch->value,    scratch->adjoint,  scratch->difference, scratch->slope,
                        scratch->jacobian, scratch->residual, scratch->columns};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        mf_memory_free(arrays[k]);
    *scratch = (struct programming_scratch){0};
}

// A formula at all points at once -----------------------------------------------------------------

/// Places where a formula is wanted: the points, and where it is to be 0.
static size_t places(const struct programming_points *points) {
    return points->count + (isnan(points->zero) ? 0 : 1);
}

static double place(const struct programming_points *points, size_t k) {
    return k < points->count ? points->r[k] : points->zero;
}

/// The node that is the first of two arguments.
static int first_argument(const struct expression *expression, int node) {
    return mf_expression_begin(expression, node - 1) - 1;
}

static void evaluate_node(const struct expression *expression, int node, size_t count,
                          size_t stride, double *value) {
    const enum expression_kind kind = expression->node[node].kind;
    double *to = value + (size_t)node * stride;
    const double *b = to - stride;
    if (kind == EXPRESSION_EXP) {
        for (size_t k = 0; k < count; k++)
            to[k] = exp(b[k]);
        return;
    }
    const double *a = value + (size_t)first_argument(expression, node) * stride;
    for (size_t k = 0; k < count; k++)
        to[k] = kind == EXPRESSION_ADD        ? a[k] + b[k]
                : kind == EXPRESSION_SUBTRACT ? a[k] - b[k]
                : kind == EXPRESSION_MULTIPLY ? a[k] * b[k]
                : kind == EXPRESSION_DIVIDE   ? a[k] / b[k]
                                              : mf_expression_power(a[k], b[k]);
}

/// Values of all nodes. Returns whether the formula is finite.
static bool evaluate(const struct programming_points *points, struct programming_scratch *scratch,
                     const struct expression *expression) {
    const size_t count = places(points), stride = points->count + 1;
    for (int node = 0; node < expression->length; node++) {
        double *value = scratch->value + (size_t)node * stride;
        const enum expression_kind kind = expression->node[node].kind;
        if (mf_expression_arguments(kind) > 0)
            evaluate_node(expression, node, count, stride, scratch->value);
        else
            for (size_t k = 0; k < count; k++)
                value[k] = kind == EXPRESSION_DISTANCE ? place(points, k)
                                                       : expression->node[node].constant;
    }
    const double *whole = scratch->value + (size_t)(expression->length - 1) * stride;
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += whole[k] * 0;
    return sum == 0;
}

/// Derivatives of the whole by the arguments of a power. An exponent of a base that is not positive
/// everywhere is held.
static void go_back_power(const double *x, const double *p, const double *value,
                          const double *adjoint, size_t count, double *dx, double *dp) {
    bool positive = true;
    for (size_t k = 0; k < count; k++) {
        positive = positive && x[k] > 0;
        dx[k] =
            adjoint[k] * p[k] * (x[k] != 0 ? value[k] / x[k] : mf_expression_power(0, p[k] - 1));
    }
    for (size_t k = 0; k < count; k++)
        dp[k] = positive ? adjoint[k] * value[k] * log(x[k]) : 0;
}

/// Derivatives of the whole by the arguments of a node, from that by the node.
static void go_back(const struct expression *expression, int node, size_t count, size_t stride,
                    struct programming_scratch *scratch) {
    const enum expression_kind kind = expression->node[node].kind;
    const size_t at = (size_t)node * stride, second = at - stride;
    const double *adjoint = scratch->adjoint + at, *value = scratch->value + at;
    double *db = scratch->adjoint + second;
    if (kind == EXPRESSION_EXP) {
        for (size_t k = 0; k < count; k++)
            db[k] = adjoint[k] * value[k];
        return;
    }
    const size_t first = (size_t)first_argument(expression, node) * stride;
    const double *a = scratch->value + first, *b = scratch->value + second;
    double *da = scratch->adjoint + first;
    if (kind == EXPRESSION_POWER) {
        go_back_power(a, b, value, adjoint, count, da, db);
        return;
    }
    for (size_t k = 0; k < count; k++) {
        const bool product = kind == EXPRESSION_MULTIPLY, quotient = kind == EXPRESSION_DIVIDE;
        da[k] = adjoint[k] * (product ? b[k] : quotient ? 1 / b[k] : 1);
        db[k] = adjoint[k] * (product                       ? a[k]
                              : quotient                    ? -value[k] / b[k]
                              : kind == EXPRESSION_SUBTRACT ? -1
                                                            : 1);
    }
}

/// How a difference counts, and its derivative.
static double soften(double difference, double softness, double *slope) {
    *slope = 1;
    if (softness == 0)
        return difference;
    const double x = difference / softness, end = -3;
    if (x > 0) {
        *slope = 1 / (1 + x);
        return softness * log1p(x);
    }
    *slope = exp(-fmax(x, end));
    return softness * (1 - *slope + (x < end ? *slope * (x - end) : 0));
}

// Residuals ---------------------------------------------------------------------------------------

/// To the residuals, or one column of their derivatives: the response or weights times `from`.
static void respond(const struct programming_points *points, const double *from, double *to) {
    if (points->response == NULL) {
        for (size_t k = 0; k < points->count; k++)
            to[k] = points->weight[k] * from[k];
        return;
    }
    for (size_t row = 0; row < points->rows; row++) {
        const double *response = points->response + row * points->count;
        double sum[4] = {0};
        size_t k = 0;
        for (; k + 4 <= points->count; k += 4)
            for (int n = 0; n < 4; n++)
                sum[n] += response[k + n] * from[k + n];
        for (; k < points->count; k++)
            sum[0] += response[k] * from[k];
        to[row] = sum[0] + sum[1] + sum[2] + sum[3];
    }
}

/// Residuals of a formula; the sum of their squares, or infinity.
static double find_residuals(const struct programming_points *points,
                             struct programming_scratch *scratch,
                             const struct expression *expression) {
    if (!evaluate(points, scratch, expression))
        return INFINITY;
    const double *whole = scratch->value + (size_t)(expression->length - 1) * (points->count + 1);
    const double shift = isnan(points->zero) ? 0 : whole[points->count];
    for (size_t k = 0; k < points->count; k++)
        scratch->difference[k] =
            soften(whole[k] - shift - points->y[k], points->softness ? points->softness[k] : 0,
                   &scratch->slope[k]);
    respond(points, scratch->difference, scratch->residual);
    double squares = 0;
    for (size_t row = 0; row < points->rows; row++) {
        scratch->residual[row] += points->offset ? points->offset[row] : 0;
        squares += scratch->residual[row] * scratch->residual[row];
    }
    return isfinite(squares) ? squares : INFINITY;
}

double mf_programming_fit_error(const struct programming_points *points,
                                struct programming_scratch *scratch,
                                const struct expression *expression) {
    return sqrt(find_residuals(points, scratch, expression) / (double)points->rows);
}

/// Derivatives of the residuals by the constants that are fitted; after find_residuals.
static void find_columns(const struct programming_points *points,
                         struct programming_scratch *scratch, const struct expression *expression,
                         const int *constant, int constants) {
    const size_t count = places(points), stride = points->count + 1;
    double *whole = scratch->adjoint + (size_t)(expression->length - 1) * stride;
    for (size_t k = 0; k < count; k++)
        whole[k] = 1;
    for (int node = expression->length - 1; node >= 0; node--)
        if (mf_expression_arguments(expression->node[node].kind) > 0)
            go_back(expression, node, count, stride, scratch);
    for (int n = 0; n < constants; n++) {
        const double *by = scratch->adjoint + (size_t)constant[n] * stride;
        const double shift = isnan(points->zero) ? 0 : by[points->count];
        for (size_t k = 0; k < points->count; k++)
            scratch->jacobian[k] = scratch->slope[k] * (by[k] - shift);
        respond(points, scratch->jacobian, scratch->columns + (size_t)n * points->rows);
    }
}

// Steps -------------------------------------------------------------------------------------------

struct normal_equations {
    int constants;
    double matrix[EXPRESSION_MAX][EXPRESSION_MAX], right[EXPRESSION_MAX];
};

static void find_normal(const struct programming_points *points,
                        const struct programming_scratch *scratch, int constants,
                        struct normal_equations *normal) {
    normal->constants = constants;
    for (int a = 0; a < constants; a++) {
        const double *x = scratch->columns + (size_t)a * points->rows;
        normal->right[a] = 0;
        for (size_t row = 0; row < points->rows; row++)
            normal->right[a] -= x[row] * scratch->residual[row];
        for (int b = 0; b <= a; b++) {
            const double *y = scratch->columns + (size_t)b * points->rows;
            double sum = 0;
            for (size_t row = 0; row < points->rows; row++)
                sum += x[row] * y[row];
            normal->matrix[a][b] = sum;
        }
    }
}

/// Solve with the diagonal 1 + damping times as large (J. L. Cholesky). False if it is singular.
static bool solve(const struct normal_equations *normal, double damping, double *step) {
    double l[EXPRESSION_MAX][EXPRESSION_MAX];
    const int n = normal->constants;
    for (int a = 0; a < n; a++) {
        for (int b = 0; b <= a; b++) {
            double sum = normal->matrix[a][b];
            // What moves nothing has a diagonal all the same, and a step of 0.
            if (a == b)
                sum = sum * (1 + damping) + 1e-300;
            for (int k = 0; k < b; k++)
                sum -= l[a][k] * l[b][k];
            if (a == b && !(sum > 0))
                return false;
            l[a][b] = a == b ? sqrt(sum) : sum / l[b][b];
        }
        step[a] = normal->right[a];
        for (int k = 0; k < a; k++)
            step[a] -= l[a][k] * step[k];
        step[a] /= l[a][a];
    }
    for (int a = n - 1; a >= 0; a--) {
        for (int k = a + 1; k < n; k++)
            step[a] -= l[k][a] * step[k];
        step[a] /= l[a][a];
    }
    return true;
}

/// The formula with its constants a step further; false if one of them leaves all bounds.
static bool move(const struct expression *from, const int *constant, int constants,
                 const double *step, struct expression *to) {
    *to = *from;
    for (int n = 0; n < constants; n++) {
        double *value = &to->node[constant[n]].constant;
        *value += step[n];
        const double max =
            mf_expression_is_exponent(to, constant[n]) ? largest_exponent : largest_constant;
        if (!(fabs(*value) <= max))
            return false;
    }
    return true;
}

/// Try steps of growing damping until one helps; the squares after it, or those before.
static double try_steps(const struct programming_points *points,
                        struct programming_scratch *scratch, const struct normal_equations *normal,
                        const int *constant, double squares, double *damping,
                        struct expression *expression) {
    double step[EXPRESSION_MAX];
    struct expression next;
    for (; *damping < 1e10; *damping *= 8) {
        if (!solve(normal, *damping, step) ||
            !move(expression, constant, normal->constants, step, &next))
            continue;
        const double found = find_residuals(points, scratch, &next);
        if (found < squares) {
            *expression = next;
            *damping = fmax(1e-12, *damping / 16);
            return found;
        }
    }
    return squares;
}

bool mf_programming_fit_stays(const struct expression *expression, int node) {
    const double exponent = expression->node[node].constant;
    return mf_expression_is_exponent(expression, node) &&
           (exponent == 2 || exponent == 3 || exponent == 4);
}

/// The constants that may move, in the order of the nodes.
static int find_constants(const struct expression *expression, const bool *held, int *constant) {
    int constants = 0;
    for (int k = 0; k < expression->length; k++)
        if (expression->node[k].kind == EXPRESSION_CONSTANT && !(held && held[k]) &&
            !mf_programming_fit_stays(expression, k))
            constant[constants++] = k;
    return constants;
}

static double descend(const struct programming_points *points, struct programming_scratch *scratch,
                      struct expression *expression, const int *constant, int constants,
                      int iterations) {
    static const double enough = 1e-9; // part of the squares
    struct normal_equations normal;
    double damping = 1e-3, squares = find_residuals(points, scratch, expression);
    for (int k = 0; k < iterations && constants > 0 && isfinite(squares) && squares > 0; k++) {
        find_columns(points, scratch, expression, constant, constants);
        find_normal(points, scratch, constants, &normal);
        const double now =
            try_steps(points, scratch, &normal, constant, squares, &damping, expression);
        const bool settled = now > squares * (1 - enough);
        squares = now;
        if (settled)
            break;
    }
    return squares;
}

double mf_programming_fit(const struct programming_points *points,
                          struct programming_scratch *scratch, struct expression *expression,
                          const bool *held, int iterations) {
    int constant[EXPRESSION_MAX];
    const int constants = find_constants(expression, held, constant);
    const double squares = descend(points, scratch, expression, constant, constants, iterations);
    return sqrt(squares / (double)points->rows);
}

double mf_programming_fit_scale(const struct programming_points *points,
                                struct programming_scratch *scratch,
                                struct expression *expression) {
    static const int first = 0;
    const bool scaled = expression->node[expression->length - 1].kind == EXPRESSION_MULTIPLY &&
                        expression->node[0].kind == EXPRESSION_CONSTANT;
    const double squares = descend(points, scratch, expression, &first, scaled ? 1 : 0, 1);
    return sqrt(squares / (double)points->rows);
}
