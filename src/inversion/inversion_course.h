// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where an inversion is on its way: the present potential, the step from it, and the best so
/// far.
///
/// The best potential is kept; a worse one than chance allows makes the next step half as long,
/// from the best, or the method's other step if it has one. The fit has converged when χ² of each
/// target is that of noise.
#pragma once

#include "inversion/inversion_band.h"
#include "inversion/inversion_state.h"

/// What the samples of the best potential said.
struct inversion_best_samples {
    struct target_distance distance[TARGETS]; ///< rms of g infinite: there is none yet
    struct inversion_section worst; ///< section with the largest χ² by bin over the probable
    struct inversion_factor factor; ///< mf_inversion_find_factor
    double own_noise;
    double noise[INVERSE_MAX_STATES]; ///< mf_targets_noise of each state
    bool precise;                     ///< they are as exact as was asked for
};

/// What the iterations since the fit came near its targets still asked for, of the ramp and of the
/// pressure of each state, at constant pressure of the density (inversion/inversion_bulk.h).
enum { INVERSION_MAX_DRIFTS = 8 };
struct inversion_drifts {
    uint32_t near; ///< such iterations; the last of them are kept
    uint32_t met;  ///< those of them that met all targets
    double ramp[INVERSION_MAX_DRIFTS], bulk[INVERSION_MAX_DRIFTS][INVERSE_MAX_STATES];
};

/// What a checkpoint keeps besides arrays and samplers.
struct inversion_progress {
    uint32_t iteration;
    bool from_disorder;    ///< the replicas are placed without order
    bool has_other;        ///< the best has another step
    double damping;        ///< part of the bounded step from the best, as the fit finds it
    double chosen_damping; ///< the same, as a person has it: both are multiplied
    int64_t stretch;       ///< of equilibration and spacing, by which the next samples begin
    struct inversion_best_samples best;
    struct target_distance min[TARGETS]; ///< nearest so far, of all that was kept
    double min_decrement;                ///< of what was kept, by the gradient
    double first_error, second_error;    ///< of g, in the first two iterations from a start
    double newton_failed_error; ///< of g, from where a step with another in reserve led away, or
                                ///< the first
    struct inversion_drifts drifts;
    bool on_its_way; ///< the last two keep one direction: what earlier iterations ask for, moved
                     ///< by a response that changes on the way, would hold the fit back
    uint64_t refine_sweeps; ///< of each replica, that longer samples may take: all before the first
                            ///< time that nothing but their noise in A kept the fit from its end;
                            ///< 0: none of the kind yet
    bool second_start;      ///< it began again, from −k_B T ln g
    double first_start;     ///< error of the start before that, until it is known which is nearer,
                            ///< 0: none
    bool lost;              ///< none of the starts settled
    bool gave_up;           ///< the last samples had not settled when they had cost enough
    bool weighs_starts;     ///< the start that the target alone says is tried beside that of forces
    bool trial;             ///< the present potential is that
    bool tried;             ///< it has been
    bool from_forces;       ///< the start of the best was that of forces
};

/// Curves are of shape [points].
struct inversion_course {
    double *phi, *step; ///< present potential and the step from it
    double *reference;  ///< what the targets alone say, mf_inversion_reference
    double *other_step; ///< what to do if the step makes it worse
    bool has_other;     ///< else: half of it
    bool most_probable; ///< the step is the most probable one, near the noise
    struct inversion_best {
        double *phi, *step, *other_step;
        double *counts; ///< ⟨S⟩ of one state after the other, shape [bins of all]
    } best;
    struct inversion_band band; ///< of the best
    struct inversion_progress progress;
};

struct inversion;

enum status mf_inversion_course_init(struct inversion_course *course, size_t known, size_t points,
                                     size_t bins) MUST_USE;
void mf_inversion_course_clear(struct inversion_course *course);

/// What a checkpoint keeps; returns the number of spans.
size_t mf_inversion_course_spans(struct inversion_course *course, size_t points, size_t bins,
                                 struct memory_span *span);

/// Damping below this: the step leads nowhere, and the fit ends.
extern const double mf_inversion_min_damping;

/// Whether distances are near enough to the targets for their potential to be kept.
bool mf_inversion_is_worth_keeping(const struct inversion *inversion,
                                   const struct inversion_assessment *assessment);

/// Whether the present potential is kept: unless it is farther from the targets than the nearest so
/// far, by two of the present noises. The nearest, not the last: samples are no more precise than a
/// third of the error, so that each could be 1.67 times as far as the one before, and so on.
/// Remembers the nearest. One that is hardly another than the best, and much worse, tells that the
/// best one's samples had not settled: it is kept in its place. By the gradient: unless what is
/// still promised of S_rel, which is convex, is more than twice the least so far. Tested:
/// test_inversion_keeps.
bool mf_inversion_keeps(struct inversion *inversion);

/// Keep the present potential, or go back if it is worse than the nearest by more than chance.
/// Replicas that a worse potential may have frozen or torn apart are not gone on with. Fails:
/// NO_MEMORY.
enum status mf_inversion_course_accept(struct inversion *inversion, bool *kept) MUST_USE;

/// The next potential to be sampled: the other start, the first again if that is much farther, or a
/// step from the best. Fails: NO_MEMORY.
enum status mf_inversion_course_go_on(struct inversion *inversion, bool kept) MUST_USE;

/// Lengthen the steps after one that is kept, by half, or shorten them if it went much too far: if
/// it was a share s of the step f, and f' from there leads back half of f or more, so much that
/// both lead to one place, s |f|²/(|f|² − f·f'). B. M. Irons and R. C. Tuck, Int. J. Numer. Methods
/// Eng. 1, 275 (1969). Near the target, where f' is noise, it is not asked. Tested:
/// test_inversion_keeps.
void mf_inversion_relax(struct inversion *inversion);

/// phi = best + both dampings · best step, bounded as a whole where the target is well known, and
/// bin by bin elsewhere; as a whole everywhere if it is made of coefficients.
void mf_inversion_take_step(struct inversion *inversion);

/// Whether the result of a memoryless method is the mean of the potentials near the target, and
/// no longer the present one (B. T. Polyak and A. B. Juditsky, SIAM J. Control Optim. 30, 838
/// (1992)): there are three or more, and their mean g is nearer. A fit with a pressure, which may
/// have come nearer meanwhile, ends with its last potential. Tested: test_inversion_keeps,
/// test_inversion_converged.
bool mf_inversion_ends_with_mean(const struct inversion *inversion);

/// The end of a fit that has converged. Where the step is the most probable one, it is taken
/// whatever damping a person has chosen: the potential that the samples ask for is the result, and
/// not the one that they were taken of, which lies on the side that the fit came from. Or the mean
/// of the potentials near the target. U of groups is then as smooth as the prior of the band has it
/// (mf_inversion_smooth). Fails: NO_MEMORY. Tested: test_inversion_keeps.
enum status mf_inversion_take_last_step(struct inversion *inversion) MUST_USE;

/// Whether the fit may end with the iteration that begins, if that meets the targets. Tested:
/// test_inversion_converged.
bool mf_inversion_may_end(const struct inversion *inversion);

/// Whether this iteration, whose potential was kept or not, ends the fit: its samples are as exact
/// as was asked for, agree with all targets, and leave no way that g hardly sees. The way has the
/// noise of the samples: the mean of those of the last iterations near the targets may be half
/// of its error, and the last does not keep the direction of the one before. In fits with groups
/// three of these or more must have met the targets, since each step goes a part of its way, from
/// one side, and an iteration that finds it over by chance would end there and take the same chance
/// into the last step: the pressures of 16 twins were 0.6 errors too low. They need not follow on
/// each other: by the noise of C chi^2 of hexane swings about its bound. The way has an end, as the
/// prior is that of Φ (inversion_band.h), and a fit whose iterations do not reach it has not
/// converged. Iterations that are not kept do not count, and the last one must have settled.
/// Where its samples leave more open of A or of a pressure than all else does, by half, those near
/// the targets are longer from there on, and the fit ends with the first that meets them. Tested:
/// test_inversion_converged.
bool mf_inversion_has_converged(struct inversion *inversion, bool kept);

/// A few bins of g(r) beside each other.
struct inversion_stretch {
    size_t state, pair;
    double first, last; ///< centres of the first and the last [λ]
};

/// Find the stretch of a g(r) that is farthest off, by more than noise, though all of it may agree:
/// few bins drown among the others, as those that few pairs reach among those of all shells. Of the
/// excess of all iterations near the targets, moved to the present potential, or of their mean, if
/// the fit ends with it. Distributions of groups are not looked at so, since U is made smooth at
/// the end. Returns whether there is one; else *farthest is not set. Tested:
/// test_inversion_converged.
bool mf_inversion_find_stretch(const struct inversion *inversion,
                               struct inversion_stretch *farthest);

/// Iterations that must meet the targets before a fit that must settle ends.
uint32_t mf_inversion_least_met(const struct inversion *inversion);

/// Why a fit that has finished did not converge, in words.
void mf_inversion_reason_write(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]);
