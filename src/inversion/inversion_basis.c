// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_basis.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "curves/shape.h"
#include "inversion/inversion_state.h"
#include "problem/parametrisation.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// Coefficients of a block of the grid.
static size_t count_of(const struct potential_grid *grid, size_t block,
                       const struct inversion_basis_size *parameters) {
    const size_t known = grid->known_of[block];
    const size_t wanted =
        (size_t)(block < grid->pairs ? parameters->coefficients : parameters->group_coefficients);
    // A constant of a group is no degree of freedom.
    const size_t max = block < grid->pairs ? known : known - 1;
    return wanted < max ? wanted : max;
}

/// B-splines of a pair type from its first known bin, number `first` of all, to the cutoff.
static enum status fill_pair(const struct potential_grid *grid, size_t first, size_t known,
                             size_t count, double *own) {
    enum status status = STATUS_OK;
    const double begin = grid->r[grid->known_point[first]], end = grid->r[grid->pair_points - 1];
    double *place = NULL;
    NEW_ARRAY(place, known);
    for (size_t k = 0; k < known; k++)
        place[k] = (grid->r[grid->known_point[first + k]] - begin) / (end - begin);
    CHECK(mf_shape_basis(mf_shapes[INVERSE_CURVE_BSPLINE], count, place, known, own));
done:
    mf_memory_free(place);
    return status;
}

enum status mf_inversion_basis_init(struct inversion_basis *basis,
                                    const struct potential_grid *grid,
                                    const struct inversion_basis_size *parameters) {
    enum status status = STATUS_OK;
    double *own = NULL;
    *basis = (struct inversion_basis){0};
    for (size_t block = 0; block < grid->blocks; block++)
        basis->count += count_of(grid, block, parameters);
    const size_t all = basis->count;
    NEW_ARRAY(basis->value, grid->known * all);
    NEW_ARRAY(basis->gradient, all);
    NEW_ARRAY(basis->hessian, all * all);
    NEW_ARRAY(basis->noise, all * all);
    NEW_ARRAY(basis->inverse, all * all);
    NEW_ARRAY(basis->damped, all * all);
    NEW_ARRAY(basis->change, all);
    for (size_t block = 0, first = 0, column = 0; block < grid->blocks; block++) {
        const size_t known = grid->known_of[block], count = count_of(grid, block, parameters);
        if (known == 0)
            continue;
        mf_memory_free(own);
        own = NULL;
        NEW_ARRAY(own, known * count);
        CHECK(block < grid->pairs ? fill_pair(grid, first, known, count, own)
                                  : mf_parametrisation_bonded_basis(
                                        &grid->group[block - grid->pairs].own, count, own));
        for (size_t k = 0; k < known; k++)
            memcpy(basis->value + (first + k) * all + column, own + k * count, count * sizeof *own);
        first += known;
        column += count;
    }
done:
    mf_memory_free(own);
    return status;
}

void mf_inversion_basis_clear(struct inversion_basis *basis) {
    mf_memory_free(basis->value);
    mf_memory_free(basis->gradient);
    mf_memory_free(basis->hessian);
    mf_memory_free(basis->noise);
    mf_memory_free(basis->inverse);
    mf_memory_free(basis->damped);
    mf_memory_free(basis->change);
    *basis = (struct inversion_basis){0};
}

/// Σ_k B_ak c_k into the known points of `phi`.
static void make_curve(const struct inversion_basis *basis, const struct potential_grid *grid,
                       const double *coefficient, double *phi) {
    for (size_t a = 0; a < grid->known; a++) {
        double sum = 0;
        for (size_t k = 0; k < basis->count; k++)
            sum += basis->value[a * basis->count + k] * coefficient[k];
        phi[grid->known_point[a]] = sum;
    }
}

void mf_inversion_basis_weights(const struct inversion_state *state, double *weight) {
    static const double min = 0.01;
    const struct potential_grid *grid = &state->grid;
    double sum = 0;
    for (size_t a = 0; a < grid->known; a++)
        sum += state->target.counts[grid->known_bin[a]];
    for (size_t a = 0; a < grid->known; a++)
        weight[a] = fmax(state->target.counts[grid->known_bin[a]], min * sum / (double)grid->known);
}

enum status mf_inversion_basis_project(const struct inversion_basis *basis,
                                       const struct potential_grid *grid, const double *weight,
                                       double *phi) {
    static const double ridge = 1e-9;
    enum status status = STATUS_OK;
    const size_t count = basis->count;
    double *normal = NULL, *right = NULL;
    NEW_ARRAY(normal, count * count);
    NEW_ARRAY(right, count);
    for (size_t a = 0; a < grid->known; a++) {
        const double *row = basis->value + a * count;
        for (size_t k = 0; k < count; k++) {
            right[k] += weight[a] * row[k] * phi[grid->known_point[a]];
            for (size_t n = 0; n < count; n++)
                normal[k * count + n] += weight[a] * row[k] * row[n] * (k == n ? 1 + ridge : 1);
        }
    }
    gsl_matrix_view matrix = gsl_matrix_view_array(normal, count, count);
    gsl_vector_view vector = gsl_vector_view_array(right, count);
    gsl_linalg_cholesky_decomp1(&matrix.matrix);
    gsl_linalg_cholesky_svx(&matrix.matrix, &vector.vector);
    make_curve(basis, grid, right, phi);
done:
    mf_memory_free(normal);
    mf_memory_free(right);
    return status;
}

/// BᵀC B, and the noise of the gradient but for the samples': that of the target, bin by bin, and
/// of one count where there are none.
static void fill_matrices(struct inversion_basis *basis, const struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const size_t count = basis->count, known = grid->known;
    const double empty = state->inefficiency / pow(state->replicas.counts.count, 2);
    memset(basis->hessian, 0, count * count * sizeof *basis->hessian);
    memset(basis->noise, 0, count * count * sizeof *basis->noise);
    for (size_t a = 0; a < known; a++) {
        const double *row = basis->value + a * count;
        const double error = state->target.error[grid->known_bin[a]];
        double *covered = basis->inverse; // Bᵀ of a row of C, for the time being
        memset(covered, 0, count * sizeof *covered);
        for (size_t b = 0; b < known; b++)
            for (size_t k = 0; k < count; k++)
                covered[k] += state->response.sampled[a * known + b] * basis->value[b * count + k];
        for (size_t k = 0; k < count; k++)
            for (size_t n = 0; n < count; n++) {
                basis->hessian[k * count + n] += row[k] * covered[n];
                basis->noise[k * count + n] += row[k] * row[n] * (error * error + empty);
            }
    }
}

/// Bᵀ S of a block of samples, or of all blocks of a replica, for one coefficient.
static double block_gradient(const struct inversion_basis *basis,
                             const struct inversion_state *state, size_t member, size_t begin,
                             size_t end, size_t coefficient) {
    const struct potential_grid *grid = &state->grid;
    double sum = 0;
    for (size_t b = begin; b < end; b++)
        for (size_t a = 0; a < grid->known; a++)
            sum += basis->value[a * basis->count + coefficient] *
                   state->replicas.member[member]
                       .block[b * state->replicas.numbers + grid->known_bin[a]];
    return sum / (double)(end - begin);
}

/// Samples that count as one independent: by the scatter of parts of them, of blocks or of whole
/// replicas, the mean over coefficients of the variance over that of independent ones.
static double find_inefficiency(const struct inversion_basis *basis,
                                const struct inversion_state *state, size_t parts) {
    const struct replicas *replicas = &state->replicas;
    const size_t length = REPLICAS_BLOCKS / parts;
    double sum = 0;
    for (size_t k = 0; k < basis->count; k++) {
        struct running_mean found = {0};
        for (size_t m = 0; m < replicas->count; m++)
            for (size_t part = 0; part < parts; part++)
                mf_statistics_add(
                    &found, block_gradient(basis, state, m, part * length, (part + 1) * length, k));
        const double variance = basis->hessian[k * (basis->count + 1)];
        if (variance > 0)
            sum += found.squares / (found.count - 1) / variance;
    }
    return sum / (double)basis->count * replicas->counts.count / (double)(replicas->count * parts);
}

/// Few replicas hardly know how they scatter: halves of them count then.
static double count_independent(const struct inversion_basis *basis,
                                const struct inversion_state *state) {
    enum { MANY = 4 };
    const size_t parts = state->replicas.count < MANY ? 2 : 1;
    double inefficiency = state->inefficiency;
    if (state->replicas.count > 1)
        inefficiency = fmax(inefficiency, fmax(find_inefficiency(basis, state, parts),
                                               find_inefficiency(basis, state, REPLICAS_BLOCKS)));
    return state->replicas.counts.count / inefficiency;
}

/// gᵀN⁻¹g; N is overwritten. Infinite if it has no inverse.
static double measure_against(double *noise, const double *gradient, double *scratch,
                              size_t count) {
    gsl_matrix_view matrix = gsl_matrix_view_array(noise, count, count);
    gsl_vector_const_view right = gsl_vector_const_view_array(gradient, count);
    gsl_vector_view left = gsl_vector_view_array(scratch, count);
    double product;
    if (gsl_linalg_cholesky_decomp1(&matrix.matrix) != GSL_SUCCESS)
        return INFINITY;
    gsl_linalg_cholesky_solve(&matrix.matrix, &right.vector, &left.vector);
    gsl_blas_ddot(&right.vector, &left.vector, &product);
    return product;
}

/// (BᵀC B, its diagonal larger by a factor, + 1/n)⁻¹.
static void invert(const struct inversion_basis *basis, double larger, double held,
                   double *inverse) {
    const size_t count = basis->count;
    memcpy(inverse, basis->hessian, count * count * sizeof *inverse);
    for (size_t k = 0; k < count; k++)
        inverse[k * (count + 1)] = larger * inverse[k * (count + 1)] + held;
    gsl_matrix_view matrix = gsl_matrix_view_array(inverse, count, count);
    gsl_linalg_cholesky_decomp1(&matrix.matrix);
    gsl_linalg_cholesky_invert(&matrix.matrix);
}

/// The inverse for steps. Near the target it is as much smaller as a whole as that of a sampled C
/// is too large, about n/(n − K) for n samples and K coefficients: J. Hartlap, P. Simon and P.
/// Schneider, Astron. Astrophys. 464, 399 (2007). Far from it the diagonal is larger by K/n, which
/// all but stops what C hardly sees, as the ramp.
static void damp(struct inversion_basis *basis, bool near) {
    static const double max = 0.5;
    const double part = (double)basis->count / basis->samples;
    invert(basis, near ? 1 : 1 + part, 1 / basis->pooled, basis->damped);
    for (size_t k = 0; near && k < basis->count * basis->count; k++)
        basis->damped[k] *= 1 - fmin(part, max);
}

/// The step of the coefficients, and what it promises.
static void find_change(struct inversion_basis *basis, double temperature) {
    const size_t count = basis->count;
    basis->decrement = basis->chance = 0;
    for (size_t k = 0; k < count; k++) {
        basis->change[k] = 0;
        for (size_t n = 0; n < count; n++) {
            const double part = basis->damped[k * count + n];
            basis->change[k] += temperature * part * basis->gradient[n];
            basis->chance += part * basis->noise[k * count + n];
        }
        basis->decrement += basis->gradient[k] * basis->change[k] / temperature;
    }
}

/// The noise that the factors of pair types make.
static void add_common(struct inversion_basis *basis, const struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const size_t count = basis->count;
    double *along = basis->inverse; // for the time being
    for (size_t block = 0, a = 0; state->target.common && block < grid->blocks; block++) {
        memset(along, 0, count * sizeof *along);
        for (const size_t last = a + grid->known_of[block]; a < last; a++)
            for (size_t k = 0; k < count; k++)
                along[k] += basis->value[a * count + k] * state->target.common[a];
        for (size_t k = 0; k < count * count; k++)
            basis->noise[k] += along[k / count] * along[k % count];
    }
}

void mf_inversion_basis_respond(struct inversion_basis *basis,
                                const struct inversion_state *state) {
    fill_matrices(basis, state);
    add_common(basis, state);
    const double now = state->replicas.counts.count;
    basis->independent = count_independent(basis, state);
    basis->pooled = basis->independent * fmax(1, state->pool.samples / now);
    basis->samples =
        basis->independent * fmax(1, state->response.independent * state->inefficiency / now);
}

void mf_inversion_basis_measure(struct inversion_state *state, double *step) {
    struct inversion_basis *basis = &state->basis;
    const struct potential_grid *grid = &state->grid;
    const size_t count = basis->count;
    memset(basis->gradient, 0, count * sizeof *basis->gradient);
    for (size_t a = 0; a < grid->known; a++)
        for (size_t k = 0; k < count; k++)
            basis->gradient[k] += basis->value[a * count + k] * state->excess[a];
    mf_inversion_basis_respond(basis, state);
    for (size_t k = 0; k < count * count; k++)
        basis->noise[k] += basis->hessian[k] / basis->pooled;
    memcpy(basis->inverse, basis->noise, count * count * sizeof *basis->noise);
    basis->miss = sqrt(measure_against(basis->inverse, basis->gradient, basis->change, count) /
                       (double)count);
    state->gradient = basis->miss; // which tells whether the target is near
    invert(basis, 1, 1 / basis->pooled, basis->inverse);
    damp(basis, mf_inversion_state_is_near(state));
    find_change(basis, state->problem->scene.temperature);
    make_curve(basis, grid, basis->change, step);
}

enum status mf_inversion_basis_covariance(const struct inversion_state *state, double *covariance,
                                          double *directions) {
    enum status status = STATUS_OK;
    const struct inversion_basis *basis = &state->basis;
    const size_t count = basis->count, known = state->grid.known;
    const double held = 1 / basis->pooled;
    const double unit = pow(state->problem->scene.temperature, 2);
    double *noise = NULL, *product = NULL, *half = NULL;
    NEW_ARRAY(noise, count * count);
    NEW_ARRAY(product, count * count);
    NEW_ARRAY(half, known * count);
    memcpy(noise, basis->noise, count * count * sizeof *noise);
    for (size_t k = 0; k < count; k++)
        noise[k * (count + 1)] += held * held;
    gsl_matrix_const_view a = gsl_matrix_const_view_array(basis->inverse, count, count),
                          b = gsl_matrix_const_view_array(basis->value, known, count),
                          h = gsl_matrix_const_view_array(basis->hessian, count, count);
    gsl_matrix_view n = gsl_matrix_view_array(noise, count, count),
                    p = gsl_matrix_view_array(product, count, count),
                    q = gsl_matrix_view_array(half, known, count),
                    to = gsl_matrix_view_array(covariance, known, known);
    *directions = 0;
    for (size_t k = 0; k < count * count; k++)
        *directions += basis->inverse[k] * h.matrix.data[k];
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &a.matrix, &n.matrix, 0, &p.matrix);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &p.matrix, &a.matrix, 0, &n.matrix);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &b.matrix, &n.matrix, 0, &q.matrix);
    gsl_blas_dgemm(CblasNoTrans, CblasTrans, unit, &q.matrix, &b.matrix, 0, &to.matrix);
done:
    mf_memory_free(noise);
    mf_memory_free(product);
    mf_memory_free(half);
    return status;
}
