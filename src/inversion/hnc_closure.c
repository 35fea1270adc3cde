// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/hnc_closure.h"

#include "inversion/ornstein_zernike.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <math.h>

/// The transform back is periodic in r with twice this many ranges of the target: h − c of liquids
/// has died away well before.
static const double ranges = 8;

/// Transform at q of `values` − `zero` in the bins and of `core` below the first.
static double transform(const struct rdf_bins *bins, const double *values, double zero, double core,
                        double q) {
    double inner = mf_ornstein_zernike_ball(q, mf_rdf_bins_edge(bins, 0)), sum = core * inner;
    for (size_t k = 0; k < bins->count; k++) {
        const double outer = mf_ornstein_zernike_ball(q, mf_rdf_bins_edge(bins, k + 1));
        sum += (values[k] - zero) * (outer - inner);
        inner = outer;
    }
    return sum;
}

/// Matrices over the types at one q: transforms times sqrt(ρ_a ρ_b).
struct wave {
    const struct hnc_liquid *liquid;
    double density[COMPOSITION_MAX_TYPES];
    gsl_matrix *matrix, *vectors; ///< S or Ω, which is lost, and its eigenvectors
    gsl_matrix *result, *scratch;
    gsl_vector *values; ///< its eigenvalues
    gsl_eigen_symmv_workspace *work;
};

static void wave_clear(struct wave *wave) {
    gsl_matrix_free(wave->matrix);
    gsl_matrix_free(wave->vectors);
    gsl_matrix_free(wave->result);
    gsl_matrix_free(wave->scratch);
    gsl_vector_free(wave->values);
    gsl_eigen_symmv_free(wave->work);
}

static enum status wave_init(struct wave *wave, const struct hnc_liquid *liquid) {
    const struct composition *composition = liquid->composition;
    const size_t types = (size_t)composition->types;
    *wave = (struct wave){.liquid = liquid,
                          .matrix = gsl_matrix_alloc(types, types),
                          .vectors = gsl_matrix_alloc(types, types),
                          .result = gsl_matrix_alloc(types, types),
                          .scratch = gsl_matrix_alloc(types, types),
                          .values = gsl_vector_alloc(types),
                          .work = gsl_eigen_symmv_alloc(types)};
    for (size_t a = 0; a < types; a++)
        wave->density[a] = (double)composition->count[a] / mf_box_volume(liquid->box);
    if (wave->matrix && wave->vectors && wave->result && wave->scratch && wave->values &&
        wave->work)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "no memory for the hypernetted chain");
}

/// Geometric mean of the densities of a pair type, and its types.
static double pair_density(const struct wave *wave, int pair, int type[2]) {
    mf_composition_pair_types(wave->liquid->composition, pair, type);
    return sqrt(wave->density[type[0]] * wave->density[type[1]]);
}

/// Add the transforms of all pair types at q to a matrix.
static void add_transforms(const struct wave *wave, const double *values, double zero, double core,
                           double q, gsl_matrix *matrix) {
    const struct rdf_bins *bins = wave->liquid->bins;
    for (int pair = 0; pair < mf_composition_pairs(wave->liquid->composition); pair++) {
        int type[2];
        const double density = pair_density(wave, pair, type);
        const double value =
            density * transform(bins, values + (size_t)pair * bins->count, zero, core, q);
        *gsl_matrix_ptr(matrix, (size_t)type[0], (size_t)type[1]) += value;
        if (type[0] != type[1])
            *gsl_matrix_ptr(matrix, (size_t)type[1], (size_t)type[0]) += value;
    }
}

/// The result in terms of the eigenvectors, Vᵀ M V, or `back`.
static void rotate(const struct wave *wave, bool back) {
    const CBLAS_TRANSPOSE_t first = back ? CblasNoTrans : CblasTrans;
    const CBLAS_TRANSPOSE_t second = back ? CblasTrans : CblasNoTrans;
    gsl_blas_dgemm(first, CblasNoTrans, 1, wave->vectors, wave->result, 0, wave->scratch);
    gsl_blas_dgemm(CblasNoTrans, second, 1, wave->scratch, wave->vectors, 0, wave->result);
}

/// Eigenvalues and eigenvectors of Ω, or of S, which has the pairs of g as well.
static void diagonalise(struct wave *wave, const double *g, double q) {
    gsl_matrix_set_identity(wave->matrix);
    if (wave->liquid->inside)
        add_transforms(wave, wave->liquid->inside, 0, 0, q, wave->matrix);
    if (g)
        add_transforms(wave, g, 1, -1, q, wave->matrix);
    gsl_eigen_symmv(wave->matrix, wave->values, wave->vectors, wave->work);
}

/// Its change.
static void find_slope(struct wave *wave, const double *g, const double *difference, double ridge,
                       double q) {
    gsl_matrix_set_zero(wave->result);
    add_transforms(wave, difference, 0, 0, q, wave->result);
    diagonalise(wave, g, q);
    rotate(wave, false);
    for (size_t i = 0; i < wave->values->size; i++)
        for (size_t j = 0; j < wave->values->size; j++) {
            // Below 0 by noise alone, and then as good as its opposite.
            const double product =
                fabs(gsl_vector_get(wave->values, i) * gsl_vector_get(wave->values, j));
            *gsl_matrix_ptr(wave->result, i, j) *= 1 - 1 / (product + ridge * ridge);
        }
    rotate(wave, true);
}

/// Add a wave to all bins.
static void add_wave(const struct wave *wave, double q, double spacing, double *indirect) {
    const struct rdf_bins *bins = wave->liquid->bins;
    for (int pair = 0; pair < mf_composition_pairs(wave->liquid->composition); pair++) {
        int type[2];
        const double density = pair_density(wave, pair, type);
        const double gamma =
            gsl_matrix_get(wave->result, (size_t)type[0], (size_t)type[1]) / density;
        for (size_t k = 0; k < bins->count; k++) {
            const double r = mf_rdf_bins_centre(bins, k);
            indirect[(size_t)pair * bins->count + k] +=
                q * gamma * sin(q * r) / r * spacing / (2 * M_PI * M_PI);
        }
    }
}

/// Wave numbers, and how far they are from each other.
static size_t count_waves(const struct rdf_bins *bins, double *spacing) {
    *spacing = M_PI / (ranges * mf_rdf_bins_range(bins));
    return (size_t)(M_PI / bins->width / *spacing);
}

enum status mf_hnc_closure_slope(const struct hnc_liquid *liquid, const double *g,
                                 const double *difference, double ridge, double *indirect) {
    enum status status = STATUS_OK;
    struct wave wave = {0};
    double spacing;
    const size_t waves = count_waves(liquid->bins, &spacing);
    if (liquid->box->dimensions != 3)
        return mf_status_fail(STATUS_BAD_INPUT, "the hypernetted chain is for three dimensions");
    CHECK(wave_init(&wave, liquid));
    for (size_t k = 0; k < (size_t)mf_composition_pairs(liquid->composition) * liquid->bins->count;
         k++)
        indirect[k] = 0;
    for (size_t n = 1; n <= waves; n++) {
        const double q = (double)n * spacing;
        find_slope(&wave, g, difference, ridge, q);
        add_wave(&wave, q, spacing, indirect);
    }
done:
    wave_clear(&wave);
    return status;
}

enum status mf_hnc_closure_min_intramolecular(const struct hnc_liquid *liquid, double *min) {
    struct wave wave = {0};
    double spacing;
    const size_t waves = count_waves(liquid->bins, &spacing);
    const enum status status = wave_init(&wave, liquid);
    *min = 1;
    for (size_t n = 1; status == STATUS_OK && n <= waves; n++) {
        diagonalise(&wave, NULL, (double)n * spacing);
        *min = fmin(*min, gsl_vector_min(wave.values));
    }
    wave_clear(&wave);
    return status;
}
