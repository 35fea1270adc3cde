// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_low_rank.h"

#include "base/memory.h"
#include "inversion/inversion.h"
#include "inversion/method_steps.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum status mf_inversion_low_rank_init(struct inversion_state *state) {
    static const struct inversion_basis_size size = {.coefficients = 20, .group_coefficients = 8};
    return mf_inversion_basis_init(&state->low_rank, &state->grid, &size);
}

bool mf_inversion_is_low_rank(const struct inversion *inversion) {
    return mf_potential_grid_has_terms(inversion_grid(inversion)) &&
           !mf_inversion_is_near(inversion);
}

/// Work space of one step, in coefficients.
struct response {
    gsl_matrix *ideal;       ///< T, then its factor L: T = L Lᵀ
    gsl_matrix *sampled;     ///< L⁻¹BᵀC B L⁻ᵀ
    gsl_matrix *eigenvector; ///< of that
    gsl_vector *eigenvalue;
    gsl_vector *asked; ///< Bᵀ S* u, then L⁻¹ of it
    gsl_vector *along; ///< the same along the eigenvectors
    gsl_eigen_symmv_workspace *workspace;
};

static void response_free(struct response *r) {
    gsl_matrix_free(r->ideal);
    gsl_matrix_free(r->sampled);
    gsl_matrix_free(r->eigenvector);
    gsl_vector_free(r->eigenvalue);
    gsl_vector_free(r->asked);
    gsl_vector_free(r->along);
    gsl_eigen_symmv_free(r->workspace);
}

static enum status response_allocate(struct response *r, size_t count) {
    *r = (struct response){gsl_matrix_calloc(count, count), gsl_matrix_alloc(count, count),
                           gsl_matrix_alloc(count, count),  gsl_vector_alloc(count),
                           gsl_vector_calloc(count),        gsl_vector_alloc(count),
                           gsl_eigen_symmv_alloc(count)};
    if (r->ideal && r->sampled && r->eigenvector && r->eigenvalue && r->asked && r->along &&
        r->workspace)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu coefficients", count);
}

/// T and Bᵀ S* u.
static enum status fill_ideal(const struct inversion_state *state, const double *step,
                              struct response *r) {
    static const double ridge = 1e-9;
    enum status status = STATUS_OK;
    const struct inversion_basis *low_rank = &state->low_rank;
    const struct potential_grid *grid = &state->grid;
    const size_t count = low_rank->count;
    double *weight = NULL;
    NEW_ARRAY(weight, grid->known);
    mf_inversion_basis_weights(state, weight);
    for (size_t a = 0; a < grid->known; a++) {
        const double *row = low_rank->value + a * count;
        for (size_t k = 0; k < count; k++) {
            *gsl_vector_ptr(r->asked, k) += row[k] * weight[a] * step[grid->known_point[a]];
            for (size_t n = 0; n < count; n++)
                *gsl_matrix_ptr(r->ideal, k, n) +=
                    row[k] * weight[a] * row[n] * (k == n ? 1 + ridge : 1);
        }
    }
done:
    mf_memory_free(weight);
    return status;
}

/// The response of the samples in the norm of T, and what is asked for along its eigenvectors;
/// false if coefficients are not independent of each other.
static bool decompose(const struct inversion_basis *low_rank, struct response *r) {
    const gsl_matrix_const_view hessian =
        gsl_matrix_const_view_array(low_rank->hessian, low_rank->count, low_rank->count);
    if (gsl_linalg_cholesky_decomp1(r->ideal) != GSL_SUCCESS)
        return false;
    gsl_matrix_memcpy(r->sampled, &hessian.matrix);
    gsl_blas_dtrsm(CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, 1, r->ideal, r->sampled);
    gsl_blas_dtrsm(CblasRight, CblasLower, CblasTrans, CblasNonUnit, 1, r->ideal, r->sampled);
    gsl_eigen_symmv(r->sampled, r->eigenvalue, r->eigenvector, r->workspace);
    gsl_blas_dtrsv(CblasLower, CblasNoTrans, CblasNonUnit, r->ideal, r->asked);
    gsl_blas_dgemv(CblasTrans, 1, r->eigenvector, r->asked, 0, r->along);
    return true;
}

/// A large eigenvalue ℓ of the true response.
struct spike {
    double value, share; ///< ℓ, and the share c² of its vector that that of the samples has
};

/// γ = m/n makes eigenvalues h of samples up to (1 + √γ)² of nothing, false, and
/// h = ℓ + γℓ/(ℓ − 1) of a true ℓ.
static bool find_spike(double h, double ratio, struct spike *spike) {
    const double sum = h + 1 - ratio;
    if (h <= pow(1 + sqrt(ratio), 2))
        return false;
    spike->value = (sum + sqrt(fmax(0, sum * sum - 4 * h))) / 2;
    const double above = spike->value - 1;
    spike->share = (1 - ratio / (above * above)) / (1 + ratio / above);
    return true;
}

/// What of the true response R and of R² lies along each other direction, where the vectors of
/// large eigenvalues are not quite known: Σ (ℓ − 1)(1 − c²) and Σ (ℓ² − 1)(1 − c²) by their number.
static void find_leaks(const struct inversion_basis *low_rank, const struct response *r,
                       double ratio, double leak[2]) {
    double others = (double)low_rank->count;
    leak[0] = leak[1] = 0;
    for (size_t k = 0; k < low_rank->count; k++) {
        struct spike spike;
        if (!find_spike(gsl_vector_get(r->eigenvalue, k), ratio, &spike))
            continue;
        leak[0] += (spike.value - 1) * (1 - spike.share);
        leak[1] += (spike.value * spike.value - 1) * (1 - spike.share);
        others--;
    }
    leak[0] /= fmax(others, 1);
    leak[1] /= fmax(others, 1);
}

/// Part x of the step along an eigenvector of the sampled response, of an eigenvalue h, of which
/// the true response leaves least, ⟨|R x v − v|²⟩: x = ⟨v·Rv⟩/⟨|Rv|²⟩.
static double find_part(double h, double ratio, const double leak[2]) {
    const double small = sqrt(ratio) / (1 + sqrt(ratio)); // λ
    struct spike spike;
    if (find_spike(h, ratio, &spike))
        return (spike.share * (spike.value - 1) + 1) /
               (spike.share * (spike.value * spike.value - 1) + 1);
    const double value = small + (1 - small) * fmin(h, 1);
    return (value + leak[0]) / (value * value + leak[1]);
}

/// step += B (H⁻¹ − T⁻¹) Bᵀ S* u.
static void add_difference(const struct inversion_state *state, struct response *r, double *step) {
    const struct inversion_basis *low_rank = &state->low_rank;
    const struct potential_grid *grid = &state->grid;
    const double ratio = (double)low_rank->count / low_rank->independent;
    double leak[2];
    find_leaks(low_rank, r, ratio, leak);
    for (size_t k = 0; k < low_rank->count; k++)
        *gsl_vector_ptr(r->along, k) *=
            find_part(gsl_vector_get(r->eigenvalue, k), ratio, leak) - 1;
    gsl_blas_dgemv(CblasNoTrans, 1, r->eigenvector, r->along, 0, r->asked);
    gsl_blas_dtrsv(CblasLower, CblasTrans, CblasNonUnit, r->ideal, r->asked);
    for (size_t a = 0; a < grid->known; a++)
        for (size_t k = 0; k < low_rank->count; k++)
            step[grid->known_point[a]] +=
                low_rank->value[a * low_rank->count + k] * gsl_vector_get(r->asked, k);
}

enum status mf_inversion_low_rank_respond(struct inversion_state *state, double *step) {
    enum status status = STATUS_OK;
    struct response response = {0};
    CHECK(response_allocate(&response, state->low_rank.count));
    mf_inversion_basis_respond(&state->low_rank, state);
    CHECK(fill_ideal(state, step, &response));
    if (decompose(&state->low_rank, &response))
        add_difference(state, &response, step);
done:
    response_free(&response);
    return status;
}

/// Take off the steps of pairs what the most probable factor of each type explains: it is an error
/// of the target, and the logarithm would ask the potential for a constant up to its cutoff.
static void leave_factors(const struct inversion_state *state, double *step) {
    const struct potential_grid *grid = &state->grid;
    for (size_t pair = 0, first = 0; state->target.common && pair < grid->pairs; pair++) {
        const size_t last = first + grid->known_of[pair];
        const double explained =
            state->problem->scene.temperature * log1p(mf_inversion_factor_of(state, pair).missing);
        for (size_t a = first; a < last; a++)
            if (grid->seen[a])
                step[grid->known_point[a]] -= explained;
        first = last;
    }
}

/// Of an excess of which a part is noise, the rest is to be removed (N. Wiener, Extrapolation,
/// Interpolation, and Smoothing of Stationary Time Series (1949)): 1 − 1/χ² per bin, of each pair
/// type and group by itself. Few beads of a type have a noise beside which all others seem to
/// agree.
static void leave_noise(const struct inversion_state *state, double *step) {
    const struct potential_grid *grid = &state->grid;
    for (size_t block = 0, first = 0; block < grid->blocks; first += grid->known_of[block++]) {
        const size_t last = first + grid->known_of[block];
        const double misfit = mf_inversion_chi_squared(state, state->excess, first, last);
        double bins = 0;
        for (size_t a = first; a < last; a++)
            bins += grid->seen[a];
        for (size_t a = first; a < last; a++)
            step[grid->known_point[a]] *= misfit > bins ? 1 - bins / misfit : 0;
    }
}

enum status mf_inversion_low_rank_step(struct inversion_state *state, double *step) {
    mf_ibi_logarithms(state, step);
    leave_factors(state, step);
    leave_noise(state, step);
    return mf_inversion_low_rank_respond(state, step);
}
