// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One potential for several states: temperatures, densities, compositions. Each state is an
/// inversion with samples of its own; the first one takes the step for all of them. One state is
/// that inversion and nothing else.
///
/// Near the targets, and of pairs alone always, the step is that of the linear equations of all
/// states (inversion_rows). With groups it is, as long as one state is far from its targets, the
/// mean of the coarse steps of all (joint_coarse). What the first state judges itself by are the
/// distances of all (joint_targets).
#pragma once

#include "inversion/inversion.h"

struct joint {
    size_t states;
    struct inversion *state;         ///< shape [states]; the first one leads
    struct inversion_rows rows;      ///< of all states
    struct inversion_rows doubted;   ///< with the variances of mf_imc_doubt, of fits with groups
    double *coarse;                  ///< shape [points], of fits with groups
    struct inversion_joint together; ///< for the first state
    double least;                    ///< error so far
    uint32_t standstill;             ///< iterations since it was lower by more than a little
};

static inline struct inversion *joint_leader(const struct joint *joint) {
    return &joint->state[0];
}

/// @name For the records of the methods that fit several states: struct inverse_method has a word
/// on each.

enum status mf_joint_create(void *joint, const struct inverse_method *method,
                            const struct inverse_problem *problem, const void *parameters) MUST_USE;
void mf_joint_destroy(void *joint);
enum status mf_joint_iterate(void *joint, struct inverse_step *step,
                             const struct inverse_listener *listener) MUST_USE;
size_t mf_joint_spans(void *joint, struct memory_span *span);
enum status mf_joint_write(const void *joint, const struct inverse_folder *folder) MUST_USE;

/// What their records have in common, in place of INVERSION_RECORD.
#define JOINT_RECORD                                                                               \
    .kind = INVERSE_INVERSION, .parameters_size = sizeof(struct inversion_settings),               \
    .state_size = sizeof(struct joint), .finds_potential = true, .knows_states = true,             \
    .create = mf_joint_create, .destroy = mf_joint_destroy, .iterate = mf_joint_iterate,           \
    .spans = mf_joint_spans, .write = mf_joint_write

/// @name The parts of an iteration of several states

/// The mean of the states' steps of mf_inversion_coarse_step, each bin weighted by 1/(k_B T
/// σ_a/S_a)² of the states, 0 where a state has not seen it. U of a group is known but for a
/// constant, which is another one in each state: what the states differ by over the bins that all
/// know is taken off before. Then the ramp by which the pressures are met, if they are asked for:
/// by least squares. Overwrites `step` of the states.
/// @param[out] step  shape [points]
/// Fails: NO_MEMORY. Tested: test_joint_coarse.
enum status mf_joint_coarse_step(const struct joint *joint, double *step) MUST_USE;

/// The target of a state that is farthest off.
struct joint_worst {
    size_t state;
    int kind;
    double noises; ///< error in units of its noise
};

/// What is farthest off of all states and targets, each group for itself.
struct joint_worst mf_joint_targets_worst(const struct joint *joint);

/// rms over the states and their targets, each in units of its noise.
double mf_joint_targets_distance(const struct joint *joint);

/// Make the distances of the first state those of all. A section becomes that of the state that is
/// farthest off by its noise, with the noise of the least exact; the distance of g, and of each
/// kind of groups, the rms over the states; and those of the pressure and of integrals as many
/// times their own noise as that of the worst state.
void mf_joint_targets_join(const struct joint *joint);
