// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/imc_solve.h"

#include "base/memory.h"
#include "inversion/householder.h"
#include "inversion/triangular.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

const double mf_imc_smooth_length = 0.1;

/// Weight of |x|² beside the curvature: settles directions that are smooth and unseen. More of it
/// keeps the ramp, which follows the noise of g, from drifting, and from the truth: with 0.01, 0.1
/// and 1 water took 4.6, 3.8 and 3.4 iterations (means of seeds 1 to 5), but the Gaussian core came
/// back within 0.004, 0.011 and 0.014 k_B T without the ramp, and A off by 0.4, with 1, of an error
/// of 0.1 (one run each).
static const double ridge = 0.01;

/// Share of χ² that is left to the noise where some of the excess cannot be removed at all.
static const double noise_share = 0.5;

/// Work space of one solve. Least squares by QR of the rows of the equations, over those of the
/// prior: the normal equations square the condition, and for a singular C gave standard errors of
/// 0.
struct workspace {
    const struct imc_system *system;
    size_t size;
    gsl_matrix *rows;    ///< B = L⁻¹ C / k_B T, then D and sqrt(ρ): shape [3 size − 1, size]
    gsl_vector *rhs;     ///< b = L⁻¹ excess, then zeros
    gsl_matrix *factor;  ///< QR of `rows` at one strength
    gsl_vector *reflect; ///< of the Householder vectors
    gsl_vector *x, *residual;
    gsl_vector *meet; ///< H⁻¹ p = R⁻¹ R⁻ᵀ p
};

static void workspace_free(struct workspace *w) {
    gsl_matrix_free(w->rows);
    gsl_matrix_free(w->factor);
    gsl_vector_free(w->rhs);
    gsl_vector_free(w->reflect);
    gsl_vector_free(w->x);
    gsl_vector_free(w->residual);
    gsl_vector_free(w->meet);
}

static enum status workspace_allocate(struct workspace *w, const struct imc_system *system) {
    const size_t n = system->size;
    w->system = system;
    w->size = n;
    w->rows = gsl_matrix_calloc(3 * n - 1, n);
    w->factor = gsl_matrix_alloc(3 * n - 1, n);
    w->rhs = gsl_vector_calloc(3 * n - 1);
    w->reflect = gsl_vector_alloc(n);
    w->x = gsl_vector_alloc(n);
    w->residual = gsl_vector_alloc(3 * n - 1);
    w->meet = gsl_vector_alloc(n);
    if (w->rows && w->factor && w->rhs && w->reflect && w->x && w->residual && w->meet)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n);
}

enum status mf_imc_solve_rows(const struct imc_system *s, gsl_matrix *response,
                              gsl_vector *excess) {
    for (size_t a = 0; a < s->size; a++) {
        const double scale = s->noise ? 1 : sqrt(s->variance[a]);
        for (size_t b = 0; b < s->size; b++)
            gsl_matrix_set(response, a, b,
                           s->covariance[a * s->size + b] / (s->temperature * scale));
        if (excess)
            gsl_vector_set(excess, a, s->excess[a] / scale);
    }
    if (s->noise == NULL)
        return STATUS_OK;
    gsl_matrix_const_view l = gsl_matrix_const_view_array(s->noise, s->size, s->size);
    if (excess)
        gsl_blas_dtrsv(CblasLower, CblasNoTrans, CblasNonUnit, &l.matrix, excess);
    return mf_triangular_left(&l.matrix, response);
}

/// Row k of D is (x_{k−1} − 2 x_k + x_{k+1}) (ℓ/h)²/(1 + steepness). In the last the neighbour is
/// the cutoff, half a spacing away, where the curve is 0: the second difference of unequal steps, h
/// and h/2.
static void fill_differences(const struct imc_system *s, gsl_matrix *rows, size_t begin,
                             size_t end) {
    const double free = pow(mf_imc_smooth_length / s->spacing, 2);
    if (begin == end)
        return; // of pairs that there are not
    for (size_t k = begin + 1; k < end; k++) {
        const double scale = s->steepness ? free / (1 + s->steepness[k]) : free;
        const bool last = k + 1 == end;
        gsl_matrix_set(rows, k - 1, k - 1, last ? 4 * scale / 3 : scale);
        gsl_matrix_set(rows, k - 1, k, last ? -4 * scale : -2 * scale);
        if (!last)
            gsl_matrix_set(rows, k - 1, k + 1, scale);
    }
}

/// The same of a curve with free ends. Round a circle the last point is beside the first; one of
/// its differences is left out, as a curve has one row less than points.
static void fill_free_differences(gsl_matrix *rows, size_t begin, size_t end, double scale,
                                  bool periodic) {
    const size_t count = end - begin;
    for (size_t k = periodic ? 0 : 1; k + 1 < count; k++) {
        const size_t row = begin + k - !periodic;
        gsl_matrix_set(rows, row, begin + (k + count - 1) % count, scale);
        gsl_matrix_set(rows, row, begin + k, -2 * scale);
        gsl_matrix_set(rows, row, begin + k + 1, scale);
    }
}

void mf_imc_solve_prior(const struct imc_system *s, gsl_matrix *rows) {
    const size_t n = rows->size2;
    gsl_matrix_set_zero(rows);
    if (s->blocks == 0)
        fill_differences(s, rows, 0, n);
    for (size_t b = 0, begin = 0; s->block && b < s->blocks; begin += s->block[b], b++)
        if (s->shape && s->shape[b].bend > 0)
            fill_free_differences(rows, begin, begin + s->block[b], pow(s->shape[b].bend, 2),
                                  s->shape[b].periodic);
        else
            fill_differences(s, rows, begin, begin + s->block[b]);
    for (size_t k = 0; k < n; k++)
        gsl_matrix_set(rows, n - 1 + k, k, sqrt(ridge));
}

/// Whether a row of the prior is the last difference of a curve of pairs, that to its cutoff.
static void mark_ends(const struct imc_system *s, bool *is_end) {
    size_t end = s->blocks == 0 ? s->size : 0, begin = 0;
    for (size_t b = 0; b == 0 || b < s->blocks; b++, begin = end) {
        end += s->blocks > 0 ? s->block[b] : 0;
        if (end - begin >= 2 && !(s->shape && s->shape[b].bend > 0))
            is_end[end - 2] = true;
    }
}

enum status mf_imc_solve_prior_excess(const struct imc_system *s, const gsl_matrix *rows,
                                      gsl_vector *excess) {
    enum status status = STATUS_OK;
    const size_t n = s->size;
    bool *is_end = NULL;
    NEW_ARRAY(is_end, rows->size1);
    mark_ends(s, is_end);
    for (size_t k = 0; k < rows->size1; k++) {
        double sum = 0;
        for (size_t a = 0; a < n; a++)
            sum += gsl_matrix_get(rows, k, a) * (s->phi[a] - (is_end[k] ? 0 : s->reference[a]));
        gsl_vector_set(excess, k, -sum);
    }
done:
    mf_memory_free(is_end);
    return status;
}

/// Sum of squares of the rows begin … end − 1.
static double square_rows(const gsl_matrix *rows, size_t begin, size_t end) {
    double sum = 0;
    for (size_t a = begin; a < end; a++)
        for (size_t b = 0; b < rows->size2; b++)
            sum += gsl_matrix_get(rows, a, b) * gsl_matrix_get(rows, a, b);
    return sum;
}

/// χ² by bin of what x leaves.
static double misfit(const struct workspace *w, const double *x) {
    double sum = 0;
    for (size_t a = 0; a < w->size; a++) {
        double left = gsl_vector_get(w->rhs, a);
        for (size_t b = 0; b < w->size; b++)
            left -= gsl_matrix_get(w->rows, a, b) * x[b];
        sum += left * left;
    }
    return sum / (double)w->size;
}

/// Meet the constraint: x ← x + u (wanted − p·x)/(p·u), which is the constrained minimum if x is
/// the free one and u = H⁻¹ p, H the matrix of the normal equations.
static void meet_constraint(const struct imc_system *s, const double *u, double *x) {
    double missing = s->wanted, response = 0;
    for (size_t k = 0; k < s->size; k++) {
        missing -= s->constraint[k] * x[k];
        response += s->constraint[k] * u[k];
    }
    // Nothing that is free to change moves what is wanted.
    if (!(response > 0))
        return;
    for (size_t k = 0; k < s->size; k++)
        x[k] += u[k] * missing / response;
}

/// What is left in a discrepancy principle: 1, or more where not even the weakest regularisation,
/// which leaves `min`, comes so far. To follow the excess down to that would make the potential
/// large in directions that do not matter.
static double discrepancy(double min) {
    return fmax(1, min + noise_share);
}

/// How x responds to the constraint, u = H⁻¹ p with H = RᵀR, into `meet`.
static void find_constraint_response(struct workspace *w) {
    gsl_matrix_const_view factor = gsl_matrix_const_submatrix(w->factor, 0, 0, w->size, w->size);
    for (size_t k = 0; k < w->size; k++)
        gsl_vector_set(w->meet, k, w->system->constraint[k]);
    gsl_blas_dtrsv(CblasUpper, CblasTrans, CblasNonUnit, &factor.matrix, w->meet);
    gsl_blas_dtrsv(CblasUpper, CblasNoTrans, CblasNonUnit, &factor.matrix, w->meet);
}

/// Solve for x at one strength; χ² / size of what is left.
static enum status solve_at(struct workspace *w, double strength, double *left) {
    const size_t n = w->size;
    gsl_matrix_memcpy(w->factor, w->rows);
    gsl_matrix_view prior = gsl_matrix_submatrix(w->factor, n, 0, 2 * n - 1, n);
    gsl_matrix_scale(&prior.matrix, sqrt(strength));
    TRY(mf_householder_factor(w->factor, w->reflect));
    gsl_linalg_QR_lssolve(w->factor, w->reflect, w->rhs, w->x, w->residual);
    if (w->system->constraint) {
        find_constraint_response(w);
        meet_constraint(w->system, w->meet->data, w->x->data);
    }
    *left = misfit(w, w->x->data);
    return STATUS_OK;
}

/// B R⁻¹ = U s Vᵀ, with D = Q R: what x leaves at any strength (L. Eldén, BIT 22, 487 (1982)).
struct spectrum {
    gsl_matrix *prior, *left, *right; ///< D and its factor, U, V
    gsl_vector *s, *excess, *meet;    ///< s, Uᵀ b, Vᵀ R⁻ᵀ p
    gsl_vector *scratch;
};

static void spectrum_free(struct spectrum *spectrum) {
    gsl_matrix_free(spectrum->prior);
    gsl_matrix_free(spectrum->left);
    gsl_matrix_free(spectrum->right);
    gsl_vector_free(spectrum->s);
    gsl_vector_free(spectrum->excess);
    gsl_vector_free(spectrum->meet);
    gsl_vector_free(spectrum->scratch);
}

static enum status spectrum_allocate(struct spectrum *spectrum, size_t n) {
    *spectrum = (struct spectrum){gsl_matrix_alloc(2 * n - 1, n),
                                  gsl_matrix_alloc(n, n),
                                  gsl_matrix_alloc(n, n),
                                  gsl_vector_alloc(n),
                                  gsl_vector_alloc(n),
                                  gsl_vector_calloc(n),
                                  gsl_vector_alloc(n)};
    if (spectrum->prior && spectrum->left && spectrum->right && spectrum->s && spectrum->excess &&
        spectrum->meet && spectrum->scratch)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n);
}

static enum status fill_spectrum(const struct workspace *w, struct spectrum *to) {
    const size_t n = w->size;
    gsl_matrix_const_view response = gsl_matrix_const_submatrix(w->rows, 0, 0, n, n);
    gsl_matrix_const_view prior = gsl_matrix_const_submatrix(w->rows, n, 0, 2 * n - 1, n);
    gsl_vector_const_view excess = gsl_vector_const_subvector(w->rhs, 0, n);
    gsl_matrix_memcpy(to->left, &response.matrix);
    gsl_matrix_memcpy(to->prior, &prior.matrix);
    TRY(mf_householder_factor(to->prior, to->scratch));
    gsl_matrix_const_view r = gsl_matrix_const_submatrix(to->prior, 0, 0, n, n);
    mf_triangular_right(&r.matrix, to->left);
    gsl_linalg_SV_decomp(to->left, to->right, to->s, to->scratch);
    gsl_blas_dgemv(CblasTrans, 1, to->left, &excess.vector, 0, to->excess);
    if (w->system->constraint == NULL)
        return STATUS_OK;
    for (size_t k = 0; k < n; k++)
        gsl_vector_set(to->scratch, k, w->system->constraint[k]);
    gsl_blas_dtrsv(CblasUpper, CblasTrans, CblasNonUnit, &r.matrix, to->scratch);
    gsl_blas_dgemv(CblasTrans, 1, to->right, to->scratch, 0, to->meet);
    return STATUS_OK;
}

/// χ²/size of what is left at a strength, as solve_at finds it.
static double misfit_at(const struct workspace *w, const struct spectrum *spectrum,
                        double strength) {
    double missing = w->system->constraint ? w->system->wanted : 0, response = 0, sum = 0;
    for (size_t k = 0; k < w->size; k++) {
        const double s = gsl_vector_get(spectrum->s, k), p = gsl_vector_get(spectrum->meet, k);
        const double stiffness = s * s + strength;
        missing -= p * s * gsl_vector_get(spectrum->excess, k) / stiffness;
        response += p * p / stiffness;
    }
    const double share = response > 0 ? missing / response : 0;
    for (size_t k = 0; k < w->size; k++) {
        const double s = gsl_vector_get(spectrum->s, k), p = gsl_vector_get(spectrum->meet, k);
        const double left = strength * gsl_vector_get(spectrum->excess, k) - share * s * p;
        sum += pow(left / (s * s + strength), 2);
    }
    return sum / (double)w->size;
}

/// Largest strength whose misfit is within the noise, by bisection of its logarithm.
static enum status find_strength(const struct workspace *w, double *strength) {
    enum { ROUNDS = 40 };
    enum status status = STATUS_OK;
    const size_t n = w->size;
    const double unit = square_rows(w->rows, 0, n) / square_rows(w->rows, n, 3 * n - 1);
    struct spectrum spectrum = {0};
    double low = -12, high = 6;
    CHECK(spectrum_allocate(&spectrum, n));
    CHECK(fill_spectrum(w, &spectrum));
    const double wanted = discrepancy(misfit_at(w, &spectrum, unit * pow(10, low)));
    for (int k = 0; k < ROUNDS; k++) {
        const double middle = 0.5 * (low + high);
        if (misfit_at(w, &spectrum, unit * pow(10, middle)) > wanted)
            high = middle;
        else
            low = middle;
    }
    *strength = unit * pow(10, low);
done:
    spectrum_free(&spectrum);
    return status;
}

/// Trace of the hat matrix B H⁻¹ Bᵀ: Σ_a |R⁻ᵀ B_a|². Takes the place of the reflections.
static double count_directions(struct workspace *w) {
    const size_t n = w->size;
    gsl_matrix_const_view factor = gsl_matrix_const_submatrix(w->factor, 0, 0, n, n);
    gsl_matrix_const_view response = gsl_matrix_const_submatrix(w->rows, 0, 0, n, n);
    gsl_matrix_view solved = gsl_matrix_submatrix(w->factor, n, 0, n, n);
    double trace = 0;
    gsl_matrix_memcpy(&solved.matrix, &response.matrix);
    mf_triangular_right(&factor.matrix, &solved.matrix);
    for (size_t a = 0; a < n; a++) {
        gsl_vector_const_view row = gsl_matrix_const_row(&solved.matrix, a);
        trace += pow(gsl_blas_dnrm2(&row.vector), 2);
    }
    return trace;
}

enum status mf_imc_solve(const struct imc_system *system, double strength, double *x,
                         struct imc_solution *solution) {
    enum status status = STATUS_OK;
    struct workspace w = {0};
    const size_t n = system->size;
    CHECK(workspace_allocate(&w, system));
    gsl_matrix_view response = gsl_matrix_submatrix(w.rows, 0, 0, n, n);
    gsl_vector_view excess = gsl_vector_subvector(w.rhs, 0, n);
    CHECK(mf_imc_solve_rows(system, &response.matrix, &excess.vector));
    gsl_matrix_view prior = gsl_matrix_submatrix(w.rows, n, 0, 2 * n - 1, n);
    mf_imc_solve_prior(system, &prior.matrix);
    solution->strength = strength;
    if (!(strength > 0)) {
        CHECK(find_strength(&w, &solution->strength));
    } else if (system->phi) {
        gsl_vector_view left = gsl_vector_subvector(w.rhs, n, 2 * n - 1);
        CHECK(mf_imc_solve_prior_excess(system, &prior.matrix, &left.vector));
        gsl_vector_scale(&left.vector, sqrt(strength));
    }
    CHECK(solve_at(&w, solution->strength, &solution->misfit));
    solution->directions = count_directions(&w);
    for (size_t k = 0; k < n; k++)
        x[k] = gsl_vector_get(w.x, k);
done:
    workspace_free(&w);
    return status;
}
