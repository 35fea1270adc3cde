// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the inversions of g(r) by sampling share: imc, ibi, hnc, auto, relative-entropy.
///
///   samples → equations → course.
/// Each iteration samples the present potential in every state (inversion/inversion_state.h), makes
/// of all of them one assessment and one set of equations (inversion/inversion_equations.h),
/// and asks the method for a step towards the targets (inversion_rule.update): g(r) and, if they
/// are asked for, pressures and integrals. The course (inversion/inversion_course.h) keeps the
/// potential or goes back, and steps on.
///
/// It starts from the hypernetted-chain inversion (mf_hnc_closure), with g continued beyond its
/// range; where samples of that do not settle, or the first step leads away, from −k_B T ln g.
/// Replicas begin from disorder, and again after a potential that made it worse: a poor one freezes
/// a liquid or makes it cavitate, and what is left of that would be taken for the next potential's
/// structure.
///
/// Several states, at other temperatures, densities, compositions, share one set of potentials.
/// Near the targets, and of pairs alone always, the step is that of the equations of all. With
/// groups it is, as long as the states are far from their targets, the mean of the coarse steps of
/// all (inversion/inversion_states.h).
#pragma once

#include "inversion/inversion_course.h"
#include "inversion/inversion_equations.h"
#include "inversion/inversion_smooth.h"
#include "inversion/inversion_states.h"
#include "inversion/inversion_history.h"

extern const struct field mf_inversion_fields[]; ///< of struct inversion_parameters

struct inversion;

/// What an inversion has of its own (inverse_method.own): the step from its samples, for the known
/// bins, into `course.step`; perhaps another into `course.other_step`, with `has_other` set, to be
/// taken from here if that one makes it worse; and up to INVERSION_OWN_COLUMNS columns. A method
/// that is `memoryless` goes by the present samples alone, so that each of its potentials has their
/// whole noise. One whose potentials are made of few coefficients, of which it measures the
/// gradient, has `coefficients`: how many, by its parameters. One that `weighs_starts` begins with
/// the forces of a target that has them, tries the start that the target alone says after it, and
/// goes on from the nearer of both.
struct inversion_rule {
    enum status (*update)(struct inversion *inversion, double *extra);
    const struct inversion_basis_size *(*coefficients)(const void *parameters); ///< or NULL
    bool memoryless, weighs_starts;
};

struct inversion {
    struct inversion_parameters parameters;
    const struct inverse_method *method;
    const struct inverse_problem *problem; ///< of the first state
    struct inversion_state *state;         ///< shape [states]; the tables show the first one
    size_t states;
    struct inversion_assessment assessment; ///< of all states
    struct inversion_equations equations;   ///< of all states
    struct inversion_course course;
    struct inversion_stagnation stagnation; ///< of several states
    double *smoothness;                     ///< of each group, see inversion_smooth.h
    struct inversion_history history;       ///< of all iterations
};

/// The known bins and all points of the potentials, which are those of all states; what a state has
/// seen and its targets are its own.
static inline const struct potential_grid *inversion_grid(const struct inversion *inversion) {
    return &inversion->state->grid;
}

/// @name For the records of the methods: struct inverse_method has a word on each.

enum status mf_inversion_create(void *inversion, const struct inverse_method *method,
                                const struct inverse_problem *problem,
                                const void *parameters) MUST_USE;
void mf_inversion_destroy(void *inversion);
enum status mf_inversion_iterate(void *inversion, struct inverse_step *step,
                                 const struct inverse_listener *listener) MUST_USE;
double *mf_inversion_damping(void *inversion);
size_t mf_inversion_spans(void *inversion, struct memory_span *span);
enum status mf_inversion_write(const void *inversion, const struct inverse_folder *folder) MUST_USE;

/// What the records of the inversions have in common: of those without memory of their own, and of
/// those whose state is another struct, with struct inversion as its first member, and functions
/// that call mf_inversion_destroy and mf_inversion_spans. Tested: test_own_inversion.
#define INVERSION_RECORD                                                                           \
    INVERSION_RECORD_OF(struct inversion, mf_inversion_destroy, mf_inversion_spans)
#define INVERSION_RECORD_OF(STATE, DESTROY, SPANS)                                                 \
    .kind = INVERSE_INVERSION, .state_size = sizeof(STATE), .finds_potential = true,               \
    .destroy = DESTROY, .iterate = mf_inversion_iterate, .spans = SPANS,                           \
    .write = mf_inversion_write, .damping = mf_inversion_damping

/// The parameters that all have, which stand first in those of each method and in their tables.
#define INVERSION_TABLE                                                                            \
    { mf_inversion_fields, 0, "inversions" }

/// What the records of methods without parameters of their own have beside.
#define INVERSION_PARAMETERS                                                                       \
    .parameters_size = sizeof(struct inversion_parameters),                                        \
    .tables = (const struct inverse_table[]) {                                                     \
        INVERSION_TABLE, {                                                                         \
            NULL, 0, NULL                                                                          \
        }                                                                                          \
    }

/// The first of a method's columns; the others may be its own.
#define INVERSION_COLUMNS                                                                          \
    "damping[1]", "own_noise[1]", "disagreement[1]", "rdf_rms[1]", "pressure", "pressure_error",   \
        "acceptance[1]", "potential_energy", "potential_energy_error", "inefficiency[1]"
enum { INVERSION_SHARED_COLUMNS = 10, INVERSION_OWN_COLUMNS = INVERSE_EXTRA - 10 };

/// Sample the present potential in all states, and assess them, and make `assessment` of all.
/// Fails: as inverse_method.iterate.
enum status mf_inversion_observe(struct inversion *inversion,
                                 const struct inverse_listener *listener) MUST_USE;

/// Sample the present potential in one state until their noise, and what of them has not settled,
/// is small against their error, and assess them. Samples in equilibrium count for all; those that
/// are far from their targets and not from equilibrium, for a step, and so do those in which sizes
/// of molecules alone remember. They are given up where they have cost 600 times as much as the
/// first ones, or after a step to wait for them as much as all potentials before, or get farther
/// and cannot be kept: left `useless`, unless replicas only remember and the samples before were
/// not given up, too. Fails: NO_MEMORY, INTERRUPTED. Tested: test_inversion_doubling,
/// test_inversion_equilibrium.
enum status mf_inversion_sample(struct inversion *inversion, struct inversion_state *state,
                                const struct inverse_listener *listener) MUST_USE;

/// Whether samples that have not settled do for a step: something that is asked for is so far off
/// that what has not settled is half of it at most, and so is all else, or agrees and drifts by
/// half of its noise at most. A potential that is far off may freeze a liquid or make it cavitate,
/// which takes very long and gives no better direction to the target. Tested:
/// test_inversion_equilibrium.
bool mf_inversion_is_far_beyond_drift(const struct inversion_state *state);

/// Whether the assessment of all is near, as mf_inversion_state_is_near.
bool mf_inversion_is_near(const struct inversion *inversion);

/// Fill phi with the start of the fit: the problem's own, the hypernetted chain's, or −k_B T ln g;
/// what is made of the target is as smooth as its errors allow (mf_imc_solve), since noise of bins
/// beside one another is a force. By the target of one state, whose C is overwritten.
/// @param[out] phi  shape [points]
/// Fails: NO_MEMORY. Tested: test_inversion_start.
enum status mf_inversion_start(struct inversion_state *state, double *phi) MUST_USE;

/// The potential that the targets of a state alone say, whatever the fit begins with: the
/// hypernetted chain's, or −k_B T ln g, as smooth as their errors allow. The prior of the most
/// probable potential is that of its difference from this one. As mf_inversion_start.
enum status mf_inversion_reference(struct inversion_state *state, double *phi) MUST_USE;

/// Start and reference of molecules, whose structure by themselves is sampled first. Nothing
/// changes for single beads and several states. Fails: as mf_inversion_intramolecular_find.
enum status mf_inversion_start_of_molecules(struct inversion *inversion,
                                            const struct inverse_listener *listener) MUST_USE;

/// The curve that an inversion of the problem begins with, shape [points of mf_unknowns_points]:
/// that of the problem, or the hypernetted chain's, in two dimensions −k_B T ln g; and its virial
/// pressure with the target's g: below 0 the curve may lead nowhere. Fails: NO_MEMORY; BAD_INPUT as
/// mf_inversion_create. Tested: test_fit_base.
enum status mf_inversion_start_curve(const struct inverse_problem *problem, double *curve,
                                     double *pressure) MUST_USE;

/// Begin with forces if the method weighs starts, and the target has those of all that is unknown:
/// else nothing changes. By the target of one state. Fails: as mf_inversion_start.
enum status mf_inversion_start_weigh(struct inversion *inversion,
                                     struct inversion_state *state) MUST_USE;

/// Whether the start that the target alone says is tried next: the first was that of forces, and it
/// is not so near that no other is needed.
bool mf_inversion_start_has_trial(const struct inversion *inversion, bool kept);
void mf_inversion_start_try(struct inversion *inversion);

/// Which start the fit has gone on from. @param[in] kept  whether the last potential is
enum inverse_start mf_inversion_start_taken(const struct inversion *inversion, bool kept);

/// Whether there is another start to be tried: the first was the hypernetted chain's, a moment ago.
bool mf_inversion_start_has_other(const struct inversion *inversion,
                                  const struct inversion_state *state);

/// Whether the start was the hypernetted chain's, and either its own samples are of no use, or
/// those of the first step from it are, and were not kept as it led away.
bool mf_inversion_start_is_poor(const struct inversion *inversion, bool kept);

/// Fill phi with −k_B T ln g. As mf_inversion_start.
enum status mf_inversion_start_again(struct inversion_state *state, double *phi) MUST_USE;
