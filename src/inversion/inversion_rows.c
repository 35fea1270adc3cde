// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "observe/kirkwood_buff_observable.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

enum status mf_inversion_rows_init(struct inversion_rows *rows, const struct inversion *leader) {
    enum status status = STATUS_OK;
    const size_t known = leader->grid.known;
    NEW_ARRAY(rows->covariance, known * known);
    NEW_ARRAY(rows->excess, known);
    NEW_ARRAY(rows->variance, known);
    rows->system = mf_inversion_system(leader);
    rows->system.covariance = rows->covariance;
    rows->system.excess = rows->excess;
    rows->system.variance = rows->variance;
    rows->system.common = NULL; // the rows have it in them
done:
    return status;
}

void mf_inversion_rows_clear(struct inversion_rows *rows) {
    mf_memory_free(rows->covariance);
    mf_memory_free(rows->excess);
    mf_memory_free(rows->variance);
    *rows = (struct inversion_rows){0};
}

/// Rows to be filled, from the first on.
struct filling {
    gsl_matrix *rows;
    gsl_vector *rhs;
    size_t row;
    gsl_matrix *response; ///< scratch, of one state
    gsl_vector *excess;
    double birge; ///< by which the variances of all rows will be larger
};

/// slope·x = missing within the error.
static void fill_row(struct filling *to, const double *slope, double missing, double wide) {
    const double error = wide / sqrt(to->birge);
    for (size_t b = 0; b < to->rows->size2; b++)
        gsl_matrix_set(to->rows, to->row, b, slope[b] / error);
    gsl_vector_set(to->rhs, to->row, missing / error);
    to->row++;
}

/// The rows of g(r) and of groups, in the bins that the state has seen; the others stay 0.
static void fill_bins(struct inversion *state, bool doubted, struct filling *to) {
    struct imc_system own = mf_inversion_system(state);
    if (doubted) {
        mf_imc_doubt(state, state->step);
        own.variance = state->doubt;
    }
    mf_imc_solve_rows(&own, to->response, to->excess);
    for (size_t a = 0; a < own.size; a++, to->row++) {
        if (!state->grid.seen[a])
            continue;
        for (size_t b = 0; b < own.size; b++)
            gsl_matrix_set(to->rows, to->row, b, gsl_matrix_get(to->response, a, b));
        gsl_vector_set(to->rhs, to->row, gsl_vector_get(to->excess, a));
    }
}

/// P + p·x = P*, and the same of the integrals, within the errors of both sides.
static void fill_others(const struct inversion *state, struct filling *to) {
    const struct targets *targets = &state->problem->targets;
    const struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
    const struct target *integrals = &targets->target[mf_kirkwood_buff_kind()];
    if (targets_ask(targets, TARGET_PRESSURE))
        fill_row(to, state->pressure.slope,
                 *targets->target[TARGET_PRESSURE].value - state->pressure.value,
                 state->distance[TARGET_PRESSURE].noise);
    for (size_t pair = 0; pair < kb->pairs; pair++)
        if (isfinite(integrals->value[pair]))
            fill_row(to, kb->slope + pair * state->grid.known,
                     integrals->value[pair] - kb->value[pair],
                     hypot(kb->error[pair], integrals->error[pair]));
}

/// Room for all rows; those that stay empty are 0.
static size_t count_rows(const struct inversion *state, size_t states) {
    size_t count = 0;
    for (size_t s = 0; s < states; s++)
        count += state[s].grid.known + state[s].kirkwood_buff.pairs +
                 targets_ask(&state[s].problem->targets, TARGET_PRESSURE);
    return count;
}

/// R x = Qᵀ b.
static void take_triangle(const gsl_matrix *rows, const gsl_vector *rhs,
                          struct inversion_rows *to) {
    const size_t known = rows->size2;
    for (size_t a = 0; a < known; a++) {
        to->excess[a] = gsl_vector_get(rhs, a);
        to->variance[a] = 1;
        for (size_t b = 0; b < known; b++)
            to->covariance[a * known + b] =
                b < a ? 0 : gsl_matrix_get(rows, a, b) * to->system.temperature;
    }
}

enum status mf_inversion_rows_reduce(struct inversion_rows *rows, struct inversion *state,
                                     size_t states, bool doubted) {
    enum status status = STATUS_OK;
    const size_t known = state->grid.known, count = count_rows(state, states);
    struct filling all = {.rows = gsl_matrix_calloc(count, known),
                          .rhs = gsl_vector_calloc(count),
                          .response = gsl_matrix_alloc(known, known),
                          .excess = gsl_vector_alloc(known),
                          .birge = mf_inversion_band_birge(state)};
    gsl_vector *reflect = gsl_vector_alloc(known);
    CHECK(all.rows && all.rhs && all.response && all.excess && reflect ? STATUS_OK
                                                                       : STATUS_NO_MEMORY);
    for (size_t s = 0; s < states; s++) {
        fill_bins(&state[s], doubted, &all);
        fill_others(&state[s], &all);
    }
    gsl_linalg_QR_decomp(all.rows, reflect);
    gsl_linalg_QR_QTvec(all.rows, reflect, all.rhs);
    take_triangle(all.rows, all.rhs, rows);
done:
    gsl_matrix_free(all.rows);
    gsl_vector_free(all.rhs);
    gsl_matrix_free(all.response);
    gsl_vector_free(all.excess);
    gsl_vector_free(reflect);
    return status;
}
