// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The linear equations of states and of targets beside g(r), as one system.
///
/// The rows B_s x = b_s of the states, each over its errors, and below each state's those of its
/// pressure and its integrals of Kirkwood and Buff, if they are asked for, stand one below the
/// other. A QR decomposition leaves as many rows as unknowns, with the same least squares, so that
/// the strength of the regularisation, the band and its ramp are found as of one state. A bin that
/// a state has not seen has no row of that state. Birge's factor, by which the band widens the
/// variances, is of g: the rows of the others are that much narrower before.
#pragma once

#include "inversion/imc_solve.h"

#include <stdbool.h>

struct inversion;

struct inversion_rows {
    struct imc_system system;
    double *covariance, *excess, *variance; ///< of the system; its variances are 1
};

/// Make room for the unknowns of an inversion. Must be cleared, also after a failure. Fails:
/// NO_MEMORY.
enum status mf_inversion_rows_init(struct inversion_rows *rows,
                                   const struct inversion *leader) MUST_USE;
void mf_inversion_rows_clear(struct inversion_rows *rows);

/// Fill the system from the present samples of all states.
/// @param[in,out] state  shape [states]
/// @param[in] doubted    with the variances of mf_imc_doubt; overwrites `step` of the states
/// Fails: NO_MEMORY. Tested: test_inversion_rows, test_fit_states, test_fit_kirkwood_buff.
enum status mf_inversion_rows_reduce(struct inversion_rows *rows, struct inversion *state,
                                     size_t states, bool doubted) MUST_USE;
