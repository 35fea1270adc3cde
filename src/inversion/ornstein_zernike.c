// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/ornstein_zernike.h"

#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/// The transform back is periodic in r with twice so many ranges.
static const double ranges = 6;

/// The solution is good enough when h is met within this, rms over the cells.
static const double tolerance = 1e-9;

enum { MAX_STEPS = 60, MAX_HALVINGS = 12, MAX_TYPES = COMPOSITION_MAX_TYPES };

double mf_ornstein_zernike_ball(double q, double edge) {
    const double x = q * edge;
    if (x < 1e-2) // the difference cancels; the series is exact to 1e-13 there
        return 4 * M_PI / 3 * edge * edge * edge * (1 - x * x / 10 + x * x * x * x / 280);
    return 4 * M_PI * (sin(x) - x * cos(x)) / (q * q * q);
}

static enum status allocate(struct ornstein_zernike *oz) {
    TRY_ARRAY(oz->edge, oz->cells + 1);
    TRY_ARRAY(oz->volume, oz->cells);
    TRY_ARRAY(oz->transform, oz->waves * oz->cells);
    TRY_ARRAY(oz->weight, oz->waves);
    TRY_ARRAY(oz->intramolecular, oz->waves * oz->types * oz->types);
    TRY_ARRAY(oz->inverse, oz->waves * oz->types * oz->types);
    TRY_ARRAY(oz->softness, oz->pairs * oz->cells);
    TRY_ARRAY(oz->c, oz->pairs * oz->cells);
    return STATUS_OK;
}

enum status mf_ornstein_zernike_init(struct ornstein_zernike *oz, const double *edge, size_t cells,
                                     const struct composition *composition, double volume) {
    const double range = edge[cells], spacing = M_PI / (ranges * range);
    *oz = (struct ornstein_zernike){.composition = *composition,
                                    .types = (size_t)composition->types,
                                    .pairs = (size_t)mf_composition_pairs(composition),
                                    .cells = cells,
                                    .waves = (size_t)(ranges * (double)cells)};
    TRY(allocate(oz));
    for (size_t a = 0; a < oz->types; a++)
        oz->density[a] = (double)composition->count[a] / volume;
    memcpy(oz->edge, edge, (cells + 1) * sizeof *edge);
    for (size_t k = 0; k < cells; k++)
        oz->volume[k] = 4 * M_PI / 3 * (pow(edge[k + 1], 3) - pow(edge[k], 3));
    for (size_t n = 0; n < oz->waves; n++) {
        const double q = (double)(n + 1) * spacing;
        oz->weight[n] = q * q * spacing / (2 * M_PI * M_PI);
        for (size_t k = 0; k < cells; k++)
            oz->transform[n * cells + k] =
                mf_ornstein_zernike_ball(q, edge[k + 1]) - mf_ornstein_zernike_ball(q, edge[k]);
        for (size_t a = 0; a < oz->types; a++) {
            const size_t diagonal = (n * oz->types + a) * oz->types + a;
            oz->intramolecular[diagonal] = oz->inverse[diagonal] = 1;
        }
    }
    return STATUS_OK;
}

void mf_ornstein_zernike_clear(struct ornstein_zernike *oz) {
    mf_memory_free(oz->edge);
    mf_memory_free(oz->volume);
    mf_memory_free(oz->transform);
    mf_memory_free(oz->weight);
    mf_memory_free(oz->intramolecular);
    mf_memory_free(oz->inverse);
    mf_memory_free(oz->softness);
    mf_memory_free(oz->c);
    *oz = (struct ornstein_zernike){0};
}

/// The types of a pair type, and its component of a symmetric matrix M over the types in an
/// orthonormal basis: M_aa, √2 M_ab.
struct pair {
    size_t a, b;
    double unit;   ///< 1 or √2
    double weight; ///< sqrt(ρ_a ρ_b) times this: of C over c
};

static struct pair pair_of(const struct ornstein_zernike *oz, size_t pair) {
    int type[2];
    mf_composition_pair_types(&oz->composition, (int)pair, type);
    const double unit = type[0] == type[1] ? 1 : M_SQRT2;
    return (struct pair){(size_t)type[0], (size_t)type[1], unit,
                         unit * sqrt(oz->density[type[0]] * oz->density[type[1]])};
}

static double component(const struct ornstein_zernike *oz, const struct pair *pair,
                        const double *matrix) {
    return pair->unit * matrix[pair->a * oz->types + pair->b];
}

/// C at a wave, of which `transform` is given.
static void find_direct(const struct ornstein_zernike *oz, const struct pair *pairs,
                        const double *c, const double *transform, double *direct) {
    for (size_t p = 0; p < oz->pairs; p++) {
        double sum = 0;
        for (size_t k = 0; k < oz->cells; k++)
            sum += transform[k] * c[p * oz->cells + k];
        direct[pairs[p].a * oz->types + pairs[p].b] = direct[pairs[p].b * oz->types + pairs[p].a] =
            pairs[p].weight / pairs[p].unit * sum;
    }
}

static void multiply(size_t n, const double *a, const double *b, double *product) {
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            double sum = 0;
            for (size_t k = 0; k < n; k++)
                sum += a[i * n + k] * b[k * n + j];
            product[i * n + j] = sum;
        }
}

static bool invert(gsl_matrix *matrix) {
    return gsl_linalg_cholesky_decomp1(matrix) == GSL_SUCCESS &&
           gsl_linalg_cholesky_invert(matrix) == GSL_SUCCESS;
}

/// S = (Ω⁻¹ − C)⁻¹ at a wave; false where it has an eigenvalue that is not positive.
static bool find_structure(const struct ornstein_zernike *oz, const double *direct, size_t wave,
                           double *structure) {
    const size_t types = oz->types, squared = types * types;
    for (size_t n = 0; n < squared; n++)
        structure[n] = oz->inverse[wave * squared + n] - direct[n];
    if (types == 1) {
        structure[0] = 1 / structure[0];
        return structure[0] > 0;
    }
    gsl_matrix_view s = gsl_matrix_view_array(structure, types, types);
    return invert(&s.matrix);
}

/// H − C = Ω C S − C at a wave.
static void find_indirect(const struct ornstein_zernike *oz, const double *direct,
                          const double *structure, size_t wave, double *indirect) {
    const size_t types = oz->types;
    const double *omega = oz->intramolecular + wave * types * types;
    double product[MAX_TYPES * MAX_TYPES];
    multiply(types, direct, structure, product);
    multiply(types, omega, product, indirect);
    for (size_t n = 0; n < types * types; n++)
        indirect[n] -= direct[n];
}

/// rms of the error of h that `rest` stands for.
static double error_of(const struct ornstein_zernike *oz, const double *rest) {
    double sum = 0, volume = 0;
    for (size_t p = 0; p < oz->pairs; p++) {
        const double weight = pair_of(oz, p).weight;
        for (size_t k = 0; k < oz->cells; k++) {
            sum += pow(rest[p * oz->cells + k] / weight, 2) / oz->volume[k];
            volume += oz->volume[k];
        }
    }
    return sqrt(sum / volume);
}

/// What is left of the equations of each pair type, times the cells' volumes and its weight: volume
/// (h − (1 + softness) c) less the integral of the indirect correlations. Returns the rms of the
/// error of h, infinite where some S has an eigenvalue that is not positive. @param[out] structures
/// S of all waves, shape [waves, types, types]
static double find_rest(const struct ornstein_zernike *oz, const double *h, const double *c,
                        double *rest, double *structures) {
    const size_t cells = oz->cells, squared = oz->types * oz->types;
    double direct[MAX_TYPES * MAX_TYPES], indirect[MAX_TYPES * MAX_TYPES];
    struct pair pairs[COMPOSITION_MAX_PAIRS];
    for (size_t p = 0; p < oz->pairs; p++) {
        pairs[p] = pair_of(oz, p);
        for (size_t k = 0, n = p * cells; k < cells; k++, n++)
            rest[n] = pairs[p].weight * oz->volume[k] * (h[n] - (1 + oz->softness[n]) * c[n]);
    }
    for (size_t wave = 0; wave < oz->waves; wave++) {
        double *structure = structures + wave * squared;
        find_direct(oz, pairs, c, oz->transform + wave * cells, direct);
        if (!find_structure(oz, direct, wave, structure))
            return INFINITY;
        find_indirect(oz, direct, structure, wave, indirect);
        for (size_t p = 0; p < oz->pairs; p++) {
            const double factor = oz->weight[wave] * component(oz, &pairs[p], indirect);
            for (size_t k = 0; k < cells; k++)
                rest[p * cells + k] -= factor * oz->transform[wave * cells + k];
        }
    }
    return error_of(oz, rest);
}

/// Change of component p of S with component q of C.
static double slope(const struct ornstein_zernike *oz, const double *s, struct pair p,
                    struct pair q) {
    const size_t types = oz->types;
    return 0.5 * p.unit * q.unit *
           (s[p.a * types + q.a] * s[p.b * types + q.b] +
            s[p.a * types + q.b] * s[p.b * types + q.a]);
}

/// Add Fᵀ w (slope − δ) F of two pair types to the cells of both; of one to the lower triangle.
static void add_block(const struct ornstein_zernike *oz, const double *structures, size_t p,
                      size_t q, double *jacobian) {
    const size_t cells = oz->cells, rows = oz->pairs * cells;
    const struct pair first = pair_of(oz, p), second = pair_of(oz, q);
    for (size_t wave = 0; wave < oz->waves; wave++) {
        const double *structure = structures + wave * oz->types * oz->types;
        const double *restrict transform = oz->transform + wave * cells;
        const double factor = oz->weight[wave] * (slope(oz, structure, first, second) - (p == q));
        for (size_t k = 0; k < cells; k++) {
            double *restrict row = jacobian + (p * cells + k) * rows + q * cells;
            const double scaled = factor * transform[k];
            for (size_t l = 0, end = p == q ? k + 1 : cells; l < end; l++)
                row[l] += scaled * transform[l];
        }
    }
}

/// The Newton step: (volume (1 + softness) + Fᵀ w (slope − δ) F) step = rest, for the components of
/// C, by the lower triangle.
static bool find_step(const struct ornstein_zernike *oz, const double *structures,
                      const double *rest, double *jacobian, double *step) {
    const size_t rows = oz->pairs * oz->cells;
    memset(jacobian, 0, rows * rows * sizeof *jacobian);
    for (size_t p = 0; p < oz->pairs; p++)
        for (size_t q = 0; q <= p; q++)
            add_block(oz, structures, p, q, jacobian);
    for (size_t n = 0; n < rows; n++)
        jacobian[n * rows + n] += (1 + oz->softness[n]) * oz->volume[n % oz->cells];
    memcpy(step, rest, rows * sizeof *step);
    gsl_matrix_view j = gsl_matrix_view_array(jacobian, rows, rows);
    gsl_vector_view x = gsl_vector_view_array(step, rows);
    if (gsl_linalg_cholesky_decomp1(&j.matrix) != GSL_SUCCESS ||
        gsl_linalg_cholesky_svx(&j.matrix, &x.vector) != GSL_SUCCESS)
        return false;
    for (size_t p = 0; p < oz->pairs; p++)
        for (size_t k = 0; k < oz->cells; k++)
            step[p * oz->cells + k] /= pair_of(oz, p).weight;
    return true;
}

/// Where c makes some structure factor negative, smaller c do not.
static double begin(struct ornstein_zernike *oz, const double *h, double *rest,
                    double *structures) {
    double error;
    while (isinf(error = find_rest(oz, h, oz->c, rest, structures)))
        for (size_t n = 0; n < oz->pairs * oz->cells; n++)
            oz->c[n] *= 0.8;
    return error;
}

static void forget(const struct ornstein_zernike *oz, double *structure) {
    for (size_t n = 0; n < oz->types * oz->types; n++)
        structure[n] = NAN;
}

/// S(q → 0) as of the longest wave, which is of six ranges, but for one component of single beads.
static void find_limit(const struct ornstein_zernike *oz, double *structure) {
    double direct[MAX_TYPES * MAX_TYPES] = {0};
    struct pair pairs[COMPOSITION_MAX_PAIRS];
    for (size_t p = 0; p < oz->pairs; p++)
        pairs[p] = pair_of(oz, p);
    find_direct(oz, pairs, oz->c, oz->volume, direct);
    if (!find_structure(oz, direct, 0, structure))
        forget(oz, structure);
}

bool mf_ornstein_zernike_set_molecules(struct ornstein_zernike *oz) {
    const size_t squared = oz->types * oz->types;
    bool positive = true;
    memcpy(oz->inverse, oz->intramolecular, oz->waves * squared * sizeof *oz->inverse);
    for (size_t wave = 0; wave < oz->waves && positive; wave++) {
        gsl_matrix_view omega =
            gsl_matrix_view_array(oz->inverse + wave * squared, oz->types, oz->types);
        positive = invert(&omega.matrix);
    }
    return positive;
}

enum status mf_ornstein_zernike_solve(struct ornstein_zernike *oz, const double *h,
                                      double *structure) {
    enum status status = STATUS_OK;
    const size_t rows = oz->pairs * oz->cells, squared = oz->types * oz->types;
    double *rest = NULL, *structures = NULL, *jacobian = NULL, *step = NULL, *next = NULL;
    NEW_ARRAY(rest, rows);
    NEW_ARRAY(step, rows);
    NEW_ARRAY(next, rows);
    NEW_ARRAY(structures, oz->waves * squared);
    NEW_ARRAY(jacobian, rows * rows);
    forget(oz, structure);
    double error = begin(oz, h, rest, structures);
    for (int n = 0; n < MAX_STEPS && error > tolerance; n++) {
        if (!find_step(oz, structures, rest, jacobian, step))
            goto done;
        double share = 1, here = INFINITY;
        for (int half = 0; half < MAX_HALVINGS && !(here < error); half++, share *= 0.5) {
            for (size_t k = 0; k < rows; k++)
                next[k] = oz->c[k] + share * step[k];
            here = find_rest(oz, h, next, rest, structures);
        }
        if (!(here < error))
            goto done;
        memcpy(oz->c, next, rows * sizeof *next);
        error = here;
    }
    if (error <= tolerance)
        find_limit(oz, structure);
done:
    mf_memory_free(rest);
    mf_memory_free(step);
    mf_memory_free(next);
    mf_memory_free(structures);
    mf_memory_free(jacobian);
    return status;
}
