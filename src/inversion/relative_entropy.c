// SPDX-License-Identifier: GPL-3.0-or-later
//
// Relative entropy minimisation: M. S. Shell, J. Chem. Phys. 129, 144108 (2008); by Newton steps in
// the coefficients of splines (inversion/inversion_basis.h), as A. Chaimovich and M. S. Shell, J.
// Chem. Phys. 134, 094112 (2011), take them.
#include "inversion/inversion.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct entropy_parameters, name)
static const struct field own_fields[] = {
    {"coefficients", FIELD_INTEGER, MEMBER(coefficients), .initial = 20, .minimum = 1,
     .maximum = INVERSION_MOST_BINS, .unit = "",
     .help = "of each potential of pairs: cubic B-splines that end at the cutoff"},
    {"group_coefficients", FIELD_INTEGER, MEMBER(group_coefficients), .initial = 8, .minimum = 1,
     .maximum = INVERSION_MOST_BINS, .unit = "",
     .help = "of each bond, angle or dihedral: cubic B-splines, of a dihedral sines and cosines"},
    FIELD_END,
};

static const char *const columns[] = {INVERSION_COLUMNS, "gradient[1]", "decrement[1]",
                                      "directions", NULL};

/// The step of Boltzmann inversion, as near as coefficients come to it.
static enum status take_logarithms(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &inversion->grid;
    double *weight = NULL;
    NEW_ARRAY(weight, grid->known);
    mf_inversion_basis_weights(inversion, weight);
    mf_ibi_logarithms(inversion, inversion->step);
    CHECK(mf_inversion_basis_project(&inversion->basis, grid, weight, inversion->step));
done:
    mf_memory_free(weight);
    return status;
}

/// The Newton step; of hardly more independent samples than coefficients, whose covariance tells
/// less, that of Boltzmann inversion, which has the noise of the present samples alone.
static enum status update(struct inversion *inversion, double *extra) {
    static const double enough = 2;
    const struct inversion_basis *basis = &inversion->basis;
    mf_inversion_basis_measure(&inversion->basis, inversion, inversion->step);
    inversion->progress.miss = extra[0] = basis->miss;
    extra[1] = basis->decrement;
    extra[2] = (double)basis->count;
    if (basis->behind < enough * (double)basis->count) {
        inversion->progress.pool = 0;
        return take_logarithms(inversion);
    }
    inversion->settling = mf_inversion_is_near(inversion);
    return STATUS_OK;
}

static enum status create(void *inversion, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    if (targets_ask(&problem->targets, TARGET_PRESSURE))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "target.pressure: \"relative-entropy\" goes by structure alone; with "
                              "\"fitted\": \"no\" it is compared with");
    return mf_inversion_create(inversion, method, problem, parameters);
}

const struct inverse_method mf_relative_entropy = {
    .name = "relative-entropy",
    .summary = "the best potentials of few coefficients; M. S. Shell, J. Chem. Phys. 129, 144108 "
               "(2008)",
    .own = &(const struct inversion_rule){.update = update},
    .tables =
        (const struct inverse_table[]){
            INVERSION_TABLE, {own_fields, offsetof(struct inversion_settings, entropy)}, {NULL, 0}},
    .knows_molecules = true,
    .restricted = true,
    .columns = columns,
    .create = create,
    INVERSION_RECORD,
};
