// SPDX-License-Identifier: GPL-3.0-or-later
//
// Relative entropy minimisation: M. S. Shell, J. Chem. Phys. 129, 144108 (2008); by Newton steps in
// the coefficients of splines (inversion/inversion_basis.h), as A. Chaimovich and M. S. Shell, J.
// Chem. Phys. 134, 094112 (2011), take them.
#include "inversion/relative_entropy.h"

#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "inversion/method_steps.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct inversion_basis_size, name)
static const struct field own_fields[] = {
    {"coefficients", FIELD_INTEGER, MEMBER(coefficients), .initial = 20, .minimum = 1,
     .maximum = INVERSION_MAX_BINS, .unit = "", .help = "cubic B-splines of each pair potential"},
    {"group_coefficients", FIELD_INTEGER, MEMBER(group_coefficients), .initial = 8, .minimum = 1,
     .maximum = INVERSION_MAX_BINS, .unit = "",
     .help = "coefficients of each group: cubic B-splines, of a dihedral sines and cosines"},
    FIELD_END,
};

static const char *const columns[] = {INVERSION_COLUMNS, "gradient[1]", "decrement[1]",
                                      "directions", NULL};

/// The step of Boltzmann inversion, as near as coefficients come to it.
static enum status take_logarithms(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const struct inversion_state *first = inversion->state;
    double *weight = NULL, *step = inversion->course.step;
    NEW_ARRAY(weight, first->grid.known);
    mf_inversion_basis_weights(first, weight);
    mf_ibi_logarithms(first, step);
    CHECK(mf_inversion_basis_project(&first->basis, &first->grid, weight, step));
done:
    mf_memory_free(weight);
    return status;
}

/// The Newton step; of hardly more independent samples than coefficients, whose covariance tells
/// less, that of Boltzmann inversion, which has the noise of the present samples alone.
static enum status update(struct inversion *inversion, double *extra) {
    static const double enough = 2;
    struct inversion_state *first = inversion->state;
    const struct inversion_basis *basis = &first->basis;
    mf_inversion_basis_measure(first, inversion->course.step);
    extra[0] = basis->miss;
    extra[1] = basis->decrement;
    extra[2] = (double)basis->count;
    if (basis->samples < enough * (double)basis->count) {
        first->pool.samples = 0;
        return take_logarithms(inversion);
    }
    inversion->course.most_probable = mf_inversion_is_near(inversion);
    return STATUS_OK;
}

static const struct inversion_basis_size *coefficients(const void *parameters) {
    return &((const struct relative_entropy_parameters *)parameters)->size;
}

static enum status create(void *inversion, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    const enum target_kind bulk = inverse_problem_bulk(problem);
    if (targets_ask(&problem->targets, bulk))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "target.%s: \"%s\" fits the structure alone; with \"fitted\": "
                              "\"no\" it is only compared",
                              mf_targets_name((int)bulk), method->name);
    return mf_inversion_create(inversion, method, problem, parameters);
}

const struct inverse_method mf_relative_entropy = {
    .name = "relative-entropy",
    .summary =
        "relative entropy, of few coefficients; M. S. Shell, J. Chem. Phys. 129, 144108 (2008)",
    .own = &(const struct inversion_rule){.update = update, .coefficients = coefficients},
    .parameters_size = sizeof(struct relative_entropy_parameters),
    .tables =
        (const struct inverse_table[]){
            INVERSION_TABLE,
            {own_fields, offsetof(struct relative_entropy_parameters, size), NULL},
            {NULL, 0, NULL}},
    .knows_molecules = true,
    .restricted = true,
    .columns = columns,
    .create = create,
    INVERSION_RECORD,
};
