// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The time step of a verification that the run file leaves to the program.
///
/// Before a fit a step can be chosen for its target alone. The potential that was found may be
/// steeper, or rough from bin to bin, and then beads are hotter, or their positions those of
/// another temperature. So the verification begins with the step that suits the potential by its
/// curvature, and is done again with half of it until both temperatures are right: within 1 %, or
/// three standard errors where these are larger. That a shorter step helps is a test, too: the
/// error of a step falls as Δt² at least, and what is left of it by half a step is no error of the
/// step.
#pragma once

#include "curves/table.h"
#include "observe/thermodynamics.h"
#include "problem/inverse.h"
#include "system/attributes.h"

/// So often is a step halved at most: to a sixteenth.
enum { VERIFY_STEP_HALVINGS = 4 };

enum verify_step_result {
    VERIFY_STEP_UNKNOWN,       ///< too few samples to tell
    VERIFY_STEP_HOLDS,         ///< both temperatures are right
    VERIFY_STEP_LONG,          ///< they are not
    VERIFY_STEP_NOT_THE_CAUSE, ///< they are not, and with twice the step it was the same
};

struct verify_step {
    double used;                         ///< [τ]
    double first;                        ///< of the scene, or what the file gives [τ]
    struct thermodynamics_off off;       ///< with `used`; of none: it blew up, or is not known
    struct thermodynamics_off first_off; ///< with the longest step that was tried, `tried`
    double tried;                        ///< [τ]
    bool blew_up, first_blew_up;
    double would_hold; ///< what would be right by what was seen, if the step is too long [τ]
    enum verify_step_result result;
    bool shortens; ///< whether it is halved
    int halvings;  ///< of `first`
};

/// The step by which Verlet's integrator would have the configurational temperature of two beads
/// right within 1 % where Φ bends most up and pairs come: at g above 0.02 of its maximum, that of
/// the target, or exp(−Φ/k_B T) without one. Infinite without velocities. Tested:
/// test_verify_step.
double mf_verify_step_of_potential(const struct inverse_problem *problem,
                                   const struct table *potential);

/// Begin with a step [τ]; one that may be shortened is halved at once as often as brings it nearest
/// to that of the potential.
struct verify_step mf_verify_step_begin(const struct inverse_problem *problem,
                                        const struct table *potential, double first, bool shortens);

/// Judge a verification with `used`, whose temperatures were so far off, or that blew up; returns
/// whether it is to be done again with the step that is now `used`. Tested: test_verify_step.
bool mf_verify_step_again(struct verify_step *step, const struct thermodynamics_off *off,
                          bool blew_up);
