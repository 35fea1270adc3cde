// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What several states that share the potentials say together.
#pragma once

#include "inversion/inversion_assessment.h"

struct inversion;
struct inversion_state;

/// The assessment of one state alone is that of all. A section of several is that of the state that
/// is farthest off by its noise, with the noise of the least exact; the distance of g, and of each
/// kind of groups, the rms over the states; and those of the pressure and of integrals as many
/// times the first state's noise as that of the worst state. They have settled if all have.
void mf_inversion_states_assess(const struct inversion_state *state, size_t states,
                                struct inversion_assessment *all);

/// The target of a state that is farthest off.
struct inversion_worst {
    size_t state;
    int kind;
    double noises; ///< error in units of its noise
};

/// What is farthest off of all states and targets, each group for itself.
struct inversion_worst mf_inversion_states_worst(const struct inversion_state *state,
                                                 size_t states);

/// rms over the states and their targets, each in units of its noise.
double mf_inversion_states_distance(const struct inversion_state *state, size_t states);

/// Whether the states still come nearer to their targets together.
struct inversion_stagnation {
    double min;          ///< mf_inversion_states_distance so far
    uint32_t iterations; ///< since it was lower by more than a little
};

/// End a fit of several states that want different potentials, where no step makes all better: the
/// steps end in a compromise, about which they go on, as the equations of a state that is far off
/// carry the noise of C into the step. Says which target is farthest off.
void mf_inversion_states_end(struct inversion *inversion, struct inverse_step *step);

/// The state whose targets tell of most bins: start and reference of all are those of its targets,
/// which in bins that it has not seen say nothing. Tested: test_inversion_states.
size_t mf_inversion_states_widest(const struct inversion_state *state, size_t states);

/// The mean of the states' steps of mf_inversion_low_rank_step, each bin weighted by 1/(k_B T
/// σ_a/S_a)² of the states, 0 where a state has not seen it. U of a group is known but for a
/// constant, which is another one in each state: what the states differ by over the bins that all
/// know is taken off before. Then the ramp by which the pressures are met, if they are asked for:
/// by least squares. The step is made only far from the targets.
/// @param[in,out] state  shape [states]; their `low_rank` is overwritten
/// @param[out] step  shape [points]
/// Fails: NO_MEMORY. Tested: test_inversion_states.
enum status mf_inversion_states_low_rank_step(struct inversion_state *state, size_t states,
                                              double *step) MUST_USE;
