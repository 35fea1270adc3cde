// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/table.h"

#include "base/memory.h"

#include <string.h>

static enum status allocate(struct table *table, double cutoff, int terms, int curves) {
    *table = (struct table){.cutoff = cutoff,
                            .inverse_spacing = TABLE_INTERVALS / cutoff,
                            .terms = terms,
                            .curves = curves,
                            .cutoffs = {cutoff}};
    const size_t rows = (size_t)(TABLE_INTERVALS + 1) * (size_t)curves;
    TRY_ARRAY(table->coefficient, rows * (size_t)terms);
    TRY_ARRAY(table->precise, rows);
    TRY_ARRAY(table->single, rows);
    return STATUS_OK;
}

/// Rows for the kernels from the coefficients: of Φ the value, then the coefficients of the force
/// −dΦ/dr. 0 − x, since −x of a flat piece would be −0.
static void fill_rows(struct table *table) {
    const double inverse = table->inverse_spacing;
    for (int k = 0; k <= TABLE_INTERVALS; k++) {
        const double *c = table->coefficient + k * table->terms;
        double *row = table->precise[k];
        row[0] = c[0];
        if (table->terms == 2) {
            row[1] = c[1];
        } else {
            row[1] = 0 - inverse * c[1];
            row[2] = 0 - 2 * inverse * c[2];
            row[3] = 0 - 3 * inverse * c[3];
        }
        for (int n = 0; n < 4; n++)
            table->single[k][n] = (float)row[n];
    }
}

static double node(int k, double cutoff) {
    return cutoff * k / TABLE_INTERVALS;
}

/// Curve value just inside the cutoff for the last node, where curves drop to 0 by definition.
static double value_at_node(const struct curve *curve, int k, double cutoff) {
    return mf_curve_value(curve, k == TABLE_INTERVALS ? cutoff * (1 - 1e-12) : node(k, cutoff));
}

/// Slope at an end from three points on its inner side, in units of the spacing.
static double end_slope(const struct curve *curve, double cutoff, int end) {
    const double step = cutoff / TABLE_INTERVALS / 16;
    const double at = end == 0 ? 0 : cutoff * (1 - 1e-12);
    const double inward = end == 0 ? step : -step;
    const double y0 = mf_curve_value(curve, at), y1 = mf_curve_value(curve, at + inward),
                 y2 = mf_curve_value(curve, at + 2 * inward);
    return (-1.5 * y0 + 2 * y1 - 0.5 * y2) / inward * cutoff / TABLE_INTERVALS;
}

/// Slopes m of the clamped C² spline in units of the spacing: m_{k−1} + 4 m_k + m_{k+1} =
/// 3 (y_{k+1} − y_{k−1}), by the Thomas algorithm.
static void spline_slopes(const double *y, double *m, double *ratio) {
    ratio[0] = 0;
    for (int k = 1; k < TABLE_INTERVALS; k++) {
        const double pivot = 1 / (4 - ratio[k - 1]);
        ratio[k] = pivot;
        m[k] = (3 * (y[k + 1] - y[k - 1]) - m[k - 1]) * pivot;
    }
    for (int k = TABLE_INTERVALS - 1; k > 0; k--)
        m[k] -= ratio[k] * m[k + 1];
}

enum status mf_table_init_potential(struct table *table, const struct curve *curve) {
    TRY(mf_curve_check(curve));
    enum status status = STATUS_OK;
    double *y = NULL, *m = NULL, *ratio = NULL;
    CHECK(allocate(table, mf_curve_cutoff(curve), 4, 1));
    NEW_ARRAY(y, TABLE_INTERVALS + 1);
    NEW_ARRAY(m, TABLE_INTERVALS + 1);
    NEW_ARRAY(ratio, TABLE_INTERVALS + 1);
    for (int k = 0; k <= TABLE_INTERVALS; k++)
        y[k] = value_at_node(curve, k, table->cutoff);
    for (int k = 0; k <= TABLE_INTERVALS; k++)
        y[k] -= y[TABLE_INTERVALS];
    m[0] = end_slope(curve, table->cutoff, 0);
    m[TABLE_INTERVALS] = end_slope(curve, table->cutoff, TABLE_INTERVALS);
    spline_slopes(y, m, ratio);
    for (int k = 0; k < TABLE_INTERVALS; k++) {
        double *c = table->coefficient + 4 * k;
        c[0] = y[k];
        c[1] = m[k];
        c[2] = 3 * (y[k + 1] - y[k]) - 2 * m[k] - m[k + 1];
        c[3] = 2 * (y[k] - y[k + 1]) + m[k] + m[k + 1];
    }
    fill_rows(table);
done:
    mf_memory_free(y);
    mf_memory_free(m);
    mf_memory_free(ratio);
    if (status != STATUS_OK)
        mf_table_clear(table);
    return status;
}

enum status mf_table_init_omega(struct table *table, const struct curve *curve) {
    TRY(mf_curve_check(curve));
    enum status status = STATUS_OK;
    CHECK(allocate(table, mf_curve_cutoff(curve), 2, 1));
    for (int k = 0; k < TABLE_INTERVALS; k++) {
        const double low = value_at_node(curve, k, table->cutoff);
        table->coefficient[2 * k] = low;
        table->coefficient[2 * k + 1] = value_at_node(curve, k + 1, table->cutoff) - low;
    }
    fill_rows(table);
done:
    if (status != STATUS_OK)
        mf_table_clear(table);
    return status;
}

enum status mf_table_stack(struct table *table, const struct table *parts, int curves) {
    enum status status = STATUS_OK;
    double cutoff = 0;
    int terms = 0;
    for (int p = 0; p < curves; p++) {
        cutoff = fmax(cutoff, parts[p].cutoff);
        terms = parts[p].terms > terms ? parts[p].terms : terms;
    }
    CHECK(allocate(table, cutoff, terms, curves));
    for (int p = 0; p < curves; p++) {
        const size_t rows = TABLE_INTERVALS + 1, first = (size_t)p * rows;
        table->cutoffs[p] = parts[p].cutoff;
        if (parts[p].curves == 0)
            continue;
        memcpy(table->coefficient + first * (size_t)terms, parts[p].coefficient,
               rows * (size_t)terms * sizeof *table->coefficient);
        memcpy(table->precise + first, parts[p].precise, rows * sizeof *table->precise);
        memcpy(table->single + first, parts[p].single, rows * sizeof *table->single);
    }
done:
    if (status != STATUS_OK)
        mf_table_clear(table);
    return status;
}

enum status mf_table_scale(struct table *table, const struct table *from, double factor) {
    enum status status = STATUS_OK;
    const size_t rows = (size_t)(TABLE_INTERVALS + 1) * (size_t)from->curves;
    CHECK(allocate(table, from->cutoff, from->terms, from->curves));
    memcpy(table->cutoffs, from->cutoffs, sizeof table->cutoffs);
    table->inverse_spacing = from->inverse_spacing;
    for (size_t k = 0; k < rows * (size_t)from->terms; k++)
        table->coefficient[k] = factor * from->coefficient[k];
    for (size_t k = 0; k < rows; k++)
        for (int n = 0; n < 4; n++) {
            table->precise[k][n] = factor * from->precise[k][n];
            table->single[k][n] = (float)table->precise[k][n];
        }
done:
    if (status != STATUS_OK)
        mf_table_clear(table);
    return status;
}

void mf_table_clear(struct table *table) {
    mf_memory_free(table->coefficient);
    mf_memory_free(table->precise);
    mf_memory_free(table->single);
    *table = (struct table){0};
}

double mf_table_inverse_spacing(const struct table *table, int pair) {
    const double cutoff = table_cutoff(table, pair);
    return TABLE_INTERVALS / (cutoff > 0 ? cutoff : table->cutoff);
}

void mf_table_evaluate(const struct table *table, double r, double *value, double *slope,
                       double *curvature) {
    mf_table_evaluate_pair(table, 0, r, value, slope, curvature);
}

void mf_table_evaluate_pair(const struct table *table, int pair, double r, double *value,
                            double *slope, double *curvature) {
    const double inverse = mf_table_inverse_spacing(table, pair);
    const int k = (int)fmin(r * inverse, TABLE_INTERVALS); // the row of zeros beyond the cutoff
    const double f = r * inverse - k;                      // fraction of the interval
    const ptrdiff_t row = (ptrdiff_t)pair * table_stride(table) + k;
    const double *c = table->coefficient + (ptrdiff_t)table->terms * row;
    const double c2 = table->terms == 4 ? c[2] : 0, c3 = table->terms == 4 ? c[3] : 0;
    if (value)
        *value = c[0] + f * (c[1] + f * (c2 + f * c3));
    if (slope)
        *slope = inverse * (c[1] + f * (2 * c2 + f * 3 * c3));
    if (curvature)
        *curvature = inverse * inverse * (2 * c2 + 6 * f * c3);
}
