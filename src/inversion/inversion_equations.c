// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_equations.h"

#include "inversion/householder.h"
#include "inversion/inversion_noise.h"
#include "inversion/inversion_state.h"
#include "inversion/inversion_states.h"
#include "inversion/method_steps.h"
#include "observe/kirkwood_buff.h"

#include "inversion/products.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

struct imc_system mf_inversion_equations_of(const struct inversion_state *state) {
    return (struct imc_system){.size = state->grid.known,
                               .block = state->grid.known_of,
                               .blocks = state->grid.blocks,
                               .shape = state->target.shape,
                               .covariance = mf_inversion_response_values(state),
                               .excess = state->excess,
                               .variance = state->variance,
                               .steepness = state->target.steepness,
                               .temperature = state->problem->scene.temperature,
                               .spacing = state->problem->targets.bins.width};
}

/// Room for a system that is reduced.
static enum status rows_init(struct inversion_rows *rows, size_t known) {
    enum status status = STATUS_OK;
    NEW_ARRAY(rows->covariance, known * known);
    NEW_ARRAY(rows->excess, known);
    NEW_ARRAY(rows->variance, known);
done:
    return status;
}

static void rows_clear(struct inversion_rows *rows) {
    mf_memory_free(rows->covariance);
    mf_memory_free(rows->excess);
    mf_memory_free(rows->variance);
}

enum status mf_inversion_equations_init(struct inversion_equations *equations,
                                        const struct inversion_state *state, size_t states) {
    enum status status = STATUS_OK;
    const bool groups = state->grid.groups > 0;
    equations->state = state;
    equations->states = states;
    equations->reduced = states > 1 || state->kirkwood_buff.pairs > 0;
    // The prior is that of the state whose potential is the reference.
    equations->system = equations->of_response =
        mf_inversion_equations_of(&state[mf_inversion_states_widest(state, states)]);
    NEW_ARRAY(equations->scatter, state->grid.known * state->grid.known);
    NEW_ARRAY(equations->noise, state->grid.known * state->grid.known);
    if (groups) {
        NEW_ARRAY(equations->response_variance, state->grid.known);
        NEW_ARRAY(equations->noise_of_response, state->grid.known * state->grid.known);
    }
    if (equations->reduced)
        CHECK(rows_init(&equations->rows, state->grid.known));
    if (equations->reduced && groups)
        CHECK(rows_init(&equations->rows_of_response, state->grid.known));
done:
    return status;
}

void mf_inversion_equations_clear(struct inversion_equations *equations) {
    mf_memory_free(equations->scatter);
    mf_memory_free(equations->noise);
    mf_memory_free(equations->noise_of_response);
    mf_memory_free(equations->response_variance);
    rows_clear(&equations->rows);
    rows_clear(&equations->rows_of_response);
    *equations = (struct inversion_equations){0};
}

/// Rows to be filled, from the first on.
struct filling {
    gsl_matrix *rows;
    gsl_vector *rhs;
    size_t row;
    gsl_matrix *response; ///< scratch, of one state
    gsl_vector *excess;
    double *noise;       ///< scratch, of one state
    double *more;        ///< scratch for more variances; or NULL
    const bool *without; ///< bins that are left out, else `more` is that of the response; or NULL
    double birge;        ///< by which the variances of all rows will be larger
};

/// The variance of what is left out, in its own.
static const double left_out = 1e10;

/// What comes to the variances of the bins.
static enum status fill_more(const struct inversion_state *state, struct filling *to) {
    if (to->without == NULL)
        return to->more ? mf_imc_response_variance(state, to->more) : STATUS_OK;
    for (size_t a = 0; a < state->grid.known; a++)
        to->more[a] = to->without[a] ? left_out * state->variance[a] : 0;
    return STATUS_OK;
}

/// slope·x = missing within the error.
static void fill_row(struct filling *to, const double *slope, double missing, double wide) {
    const double error = wide / sqrt(to->birge);
    for (size_t b = 0; b < to->rows->size2; b++)
        gsl_matrix_set(to->rows, to->row, b, slope[b] / error);
    gsl_vector_set(to->rhs, to->row, missing / error);
    to->row++;
}

/// The rows of g(r) and of groups, in the bins that the state has seen; the others stay 0.
static enum status fill_bins(const struct inversion_state *state, enum inversion_noise_kind kind,
                             struct filling *to) {
    struct imc_system own = mf_inversion_equations_of(state);
    TRY(fill_more(state, to));
    mf_inversion_noise_find(state, kind, to->more, to->noise);
    own.noise = to->noise;
    TRY(mf_imc_solve_rows(&own, to->response, to->excess));
    for (size_t a = 0; a < own.size; a++, to->row++) {
        if (!state->grid.seen[a])
            continue;
        for (size_t b = 0; b < own.size; b++)
            gsl_matrix_set(to->rows, to->row, b, gsl_matrix_get(to->response, a, b));
        gsl_vector_set(to->rhs, to->row, gsl_vector_get(to->excess, a));
    }
    return STATUS_OK;
}

/// P + p·x = P*, and the same of the integrals, within the errors of both sides.
static void fill_others(const struct inversion_state *state, struct filling *to) {
    const struct targets *targets = &state->problem->targets;
    const struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
    const struct target *integrals = &targets->target[mf_kirkwood_buff_kind()];
    if (mf_inversion_bulk_is_asked(state))
        fill_row(to, state->bulk.slope, mf_inversion_bulk_missing(state),
                 state->assessment.bulk_reach);
    for (size_t pair = 0; pair < kb->pairs; pair++)
        if (isfinite(integrals->value[pair]))
            fill_row(to, kb->slope + pair * state->grid.known,
                     integrals->value[pair] - kb->value[pair],
                     hypot(kb->error[pair], integrals->error[pair]));
}

/// Room for all rows; those that stay empty are 0.
static size_t count_rows(const struct inversion_equations *equations) {
    size_t count = 0;
    for (size_t s = 0; s < equations->states; s++) {
        const struct inversion_state *state = &equations->state[s];
        count += state->grid.known + state->kirkwood_buff.pairs + mf_inversion_bulk_is_asked(state);
    }
    return count;
}

/// R x = Qᵀ b as a system. Its variances are 1, and it needs no `noise`: the rows are whitened.
static void take_triangle(const gsl_matrix *rows, const gsl_vector *rhs, struct inversion_rows *to,
                          struct imc_system *system) {
    const size_t known = rows->size2;
    for (size_t a = 0; a < known; a++) {
        to->excess[a] = gsl_vector_get(rhs, a);
        to->variance[a] = 1;
        for (size_t b = 0; b < known; b++)
            to->covariance[a * known + b] =
                b < a ? 0 : gsl_matrix_get(rows, a, b) * system->temperature;
    }
    system->covariance = to->covariance;
    system->excess = to->excess;
    system->variance = to->variance;
    system->noise = NULL;
}

static enum status filling_allocate(const struct inversion_equations *equations,
                                    struct filling *all) {
    const size_t known = equations->state->grid.known, count = count_rows(equations);
    all->rows = gsl_matrix_calloc(count, known);
    all->rhs = gsl_vector_calloc(count);
    all->response = gsl_matrix_alloc(known, known);
    all->excess = gsl_vector_alloc(known);
    return all->rows && all->rhs && all->response && all->excess ? STATUS_OK : STATUS_NO_MEMORY;
}

static void filling_free(struct filling *all) {
    gsl_matrix_free(all->rows);
    gsl_vector_free(all->rhs);
    gsl_matrix_free(all->response);
    gsl_vector_free(all->excess);
}

/// The rows of all states.
static enum status fill_all(const struct inversion_equations *equations, struct filling *all) {
    for (size_t s = 0; s < equations->states; s++) {
        TRY(fill_bins(&equations->state[s], equations->kind[s], all));
        if (equations->reduced)
            fill_others(&equations->state[s], all);
    }
    return STATUS_OK;
}

/// All rows, reduced to as many as one state has.
/// @param[in] response_variance  scratch: the variances of the response are added to those of the
///                               excess; NULL: they are not
static enum status reduce(const struct inversion_equations *equations, double birge,
                          double *response_variance, struct inversion_rows *to,
                          struct imc_system *system) {
    enum status status = STATUS_OK;
    struct filling all = {.noise = equations->noise, .more = response_variance, .birge = birge};
    gsl_vector *reflect = gsl_vector_alloc(equations->state->grid.known);
    CHECK(reflect ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(filling_allocate(equations, &all));
    CHECK(fill_all(equations, &all));
    CHECK(mf_householder_factor(all.rows, reflect));
    gsl_linalg_QR_QTvec(all.rows, reflect, all.rhs);
    take_triangle(all.rows, all.rhs, to, system);
done:
    filling_free(&all);
    gsl_vector_free(reflect);
    return status;
}

enum status mf_inversion_equations_without(const struct inversion_equations *equations,
                                           double birge, const bool *without, gsl_matrix *normal,
                                           gsl_vector *asked) {
    enum status status = STATUS_OK;
    const size_t known = equations->state->grid.known;
    struct filling all = {.without = without, .birge = birge};
    NEW_ARRAY(all.noise, known * known);
    NEW_ARRAY(all.more, known);
    CHECK(filling_allocate(equations, &all));
    CHECK(fill_all(equations, &all));
    CHECK(mf_products_gram(1 / birge, all.rows, 0, normal));
    gsl_blas_dgemv(CblasTrans, 1 / birge, all.rows, all.rhs, 0, asked);
done:
    filling_free(&all);
    mf_memory_free(all.noise);
    mf_memory_free(all.more);
    return status;
}

/// Add what a state's rows scatter by: TᵀV T with T = W⁻¹C/k_B T.
static enum status add_scatter(const struct inversion_state *state, enum inversion_noise_kind kind,
                               double *scatter) {
    enum status status = STATUS_OK;
    const size_t known = state->grid.known;
    struct imc_system own = mf_inversion_equations_of(state);
    gsl_matrix *t = gsl_matrix_alloc(known, known), *factor = gsl_matrix_alloc(known, known);
    gsl_matrix_view to = gsl_matrix_view_array(scatter, known, known);
    CHECK(t && factor ? STATUS_OK : STATUS_NO_MEMORY);
    mf_inversion_noise_find(state, kind, NULL, factor->data);
    own.noise = factor->data;
    CHECK(mf_imc_solve_rows(&own, t, NULL));
    gsl_blas_dtrsm(CblasLeft, CblasLower, CblasTrans, CblasNonUnit, 1, factor, t);
    for (size_t a = 0; a < known; a++)
        for (size_t b = 0; b < known && !state->grid.seen[a]; b++)
            gsl_matrix_set(t, a, b, 0);
    mf_inversion_noise_find(state, mf_inversion_noise_of_band(state, kind), NULL, factor->data);
    gsl_blas_dtrmm(CblasLeft, CblasLower, CblasTrans, CblasNonUnit, 1, factor, t);
    CHECK(mf_products_gram(1, t, 1, &to.matrix));
done:
    gsl_matrix_free(t);
    gsl_matrix_free(factor);
    return status;
}

/// That of numbers, whose rows have no noise in common: s sᵀ/σ².
static void add_scatter_of_number(const struct inversion_state *state, const double *slope,
                                  double wide, double birge, double *scatter) {
    const size_t known = state->grid.known;
    for (size_t a = 0; a < known; a++)
        for (size_t b = 0; b <= a; b++)
            scatter[a * known + b] += slope[a] * slope[b] * birge / (wide * wide);
}

static enum status fill_scatter(const struct inversion_equations *equations, double birge) {
    const size_t known = equations->state->grid.known;
    memset(equations->scatter, 0, known * known * sizeof *equations->scatter);
    for (size_t s = 0; s < equations->states; s++) {
        const struct inversion_state *state = &equations->state[s];
        const struct targets *targets = &state->problem->targets;
        const struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
        const struct target *integrals = &targets->target[mf_kirkwood_buff_kind()];
        TRY(add_scatter(state, equations->kind[s], equations->scatter));
        if (equations->reduced && mf_inversion_bulk_is_asked(state))
            add_scatter_of_number(state, state->bulk.slope, state->assessment.bulk_reach, birge,
                                  equations->scatter);
        for (size_t pair = 0; pair < kb->pairs; pair++)
            if (isfinite(integrals->value[pair]))
                add_scatter_of_number(state, kb->slope + pair * known,
                                      hypot(kb->error[pair], integrals->error[pair]), birge,
                                      equations->scatter);
    }
    return STATUS_OK;
}

enum status mf_inversion_equations_fill(struct inversion_equations *equations, double birge) {
    const struct inversion_state *state = equations->state;
    double *variance = equations->response_variance;
    for (size_t s = 0; s < equations->states; s++)
        TRY(mf_inversion_noise_choose(&equations->state[s], &equations->kind[s]));
    TRY(fill_scatter(equations, birge));
    if (equations->reduced) {
        TRY(reduce(equations, birge, NULL, &equations->rows, &equations->system));
        return variance ? reduce(equations, birge, variance, &equations->rows_of_response,
                                 &equations->of_response)
                        : STATUS_OK;
    }
    mf_inversion_noise_find(state, equations->kind[0], NULL, equations->noise);
    equations->system.noise = equations->noise;
    if (variance == NULL)
        return STATUS_OK;
    TRY(mf_imc_response_variance(state, variance));
    mf_inversion_noise_find(state, equations->kind[0], variance, equations->noise_of_response);
    equations->of_response.noise = equations->noise_of_response;
    return STATUS_OK;
}

void mf_inversion_equations_weigh(struct inversion_equations *equations, size_t s, const double *x,
                                  double *q) {
    const struct inversion_state *state = &equations->state[s];
    const size_t known = state->grid.known;
    const struct imc_system own = mf_inversion_equations_of(state);
    const gsl_matrix_const_view response =
        gsl_matrix_const_view_array(own.covariance, known, known);
    const gsl_vector_const_view from = gsl_vector_const_view_array(x, known);
    const gsl_matrix_const_view l = gsl_matrix_const_view_array(equations->noise, known, known);
    gsl_vector_view to = gsl_vector_view_array(q, known);
    if (equations->reduced) // else it is that of the system
        mf_inversion_noise_find(state, equations->kind[s], NULL, equations->noise);
    gsl_blas_dgemv(CblasNoTrans, 1 / own.temperature, &response.matrix, &from.vector, 0,
                   &to.vector);
    gsl_blas_dtrsv(CblasLower, CblasNoTrans, CblasNonUnit, &l.matrix, &to.vector);
    for (size_t a = 0; a < known; a++)
        if (!state->grid.seen[a])
            q[a] = 0;
    gsl_blas_dtrsv(CblasLower, CblasTrans, CblasNonUnit, &l.matrix, &to.vector);
}
