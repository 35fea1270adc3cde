// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/imc_solve.h"
#include "inversion/joint.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

enum status mf_joint_rows_init(struct joint_equations *equations, const struct inversion *leader) {
    enum status status = STATUS_OK;
    const size_t known = leader->grid.known;
    NEW_ARRAY(equations->covariance, known * known);
    NEW_ARRAY(equations->excess, known);
    NEW_ARRAY(equations->variance, known);
    equations->system = mf_inversion_system(leader);
    equations->system.covariance = equations->covariance;
    equations->system.excess = equations->excess;
    equations->system.variance = equations->variance;
done:
    return status;
}

void mf_joint_rows_clear(struct joint_equations *equations) {
    mf_memory_free(equations->covariance);
    mf_memory_free(equations->excess);
    mf_memory_free(equations->variance);
}

/// Rows of the states and, below each state's, one of its pressure if it is asked for.
static size_t count_rows(const struct joint *joint) {
    const struct inversion *leader = joint_leader(joint);
    const bool pressure = targets_ask(&leader->problem->targets, TARGET_PRESSURE);
    return joint->states * (leader->grid.known + pressure);
}

/// P + p·x = P* within the errors of both.
/// @param[in] birge  by which the variances of all rows will be larger
static void fill_pressure(const struct inversion *state, double birge, gsl_matrix *rows,
                          gsl_vector *rhs, size_t row) {
    const double error = state->distance[TARGET_PRESSURE].noise / sqrt(birge);
    const double wanted = *state->problem->targets.target[TARGET_PRESSURE].value;
    for (size_t b = 0; b < state->grid.known; b++)
        gsl_matrix_set(rows, row, b, state->pressure.slope[b] / error);
    gsl_vector_set(rhs, row, (wanted - state->pressure.value) / error);
}

/// Of the bins that the state has seen; the others stay 0.
static void fill_state(const struct inversion *state, const struct imc_system *own,
                       gsl_matrix *response, gsl_matrix *rows, gsl_vector *rhs, size_t row) {
    mf_imc_solve_response(own, response);
    for (size_t a = 0; a < own->size; a++) {
        if (!state->grid.seen[a])
            continue;
        for (size_t b = 0; b < own->size; b++)
            gsl_matrix_set(rows, row + a, b, gsl_matrix_get(response, a, b));
        gsl_vector_set(rhs, row + a, own->excess[a] / sqrt(own->variance[a]));
    }
}

static void fill_rows(const struct joint *joint, bool doubted, gsl_matrix *response,
                      gsl_matrix *rows, gsl_vector *rhs) {
    const size_t known = joint_leader(joint)->grid.known;
    const double birge = mf_inversion_band_birge(joint_leader(joint));
    size_t row = 0;
    for (size_t s = 0; s < joint->states; s++) {
        struct inversion *state = &joint->state[s];
        struct imc_system own = mf_inversion_system(state);
        if (doubted) {
            mf_imc_doubt(state, state->step);
            own.variance = state->doubt;
        }
        fill_state(state, &own, response, rows, rhs, row);
        row += known;
        if (targets_ask(&state->problem->targets, TARGET_PRESSURE))
            fill_pressure(state, birge, rows, rhs, row++);
    }
}

enum status mf_joint_rows_reduce(const struct joint *joint, bool doubted,
                                 struct joint_equations *equations) {
    enum status status = STATUS_OK;
    const size_t known = joint_leader(joint)->grid.known, count = count_rows(joint);
    gsl_matrix *rows = gsl_matrix_calloc(count, known), *response = gsl_matrix_alloc(known, known);
    gsl_vector *rhs = gsl_vector_calloc(count), *reflect = gsl_vector_alloc(known);
    CHECK(rows && response && rhs && reflect ? STATUS_OK : STATUS_NO_MEMORY);
    fill_rows(joint, doubted, response, rows, rhs);
    gsl_linalg_QR_decomp(rows, reflect);
    gsl_linalg_QR_QTvec(rows, reflect, rhs);
    for (size_t a = 0; a < known; a++) {
        equations->excess[a] = gsl_vector_get(rhs, a);
        equations->variance[a] = 1;
        for (size_t b = 0; b < known; b++)
            equations->covariance[a * known + b] =
                b < a ? 0 : gsl_matrix_get(rows, a, b) * equations->system.temperature;
    }
done:
    gsl_matrix_free(rows);
    gsl_matrix_free(response);
    gsl_vector_free(rhs);
    gsl_vector_free(reflect);
    return status;
}
