// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the inversions of g(r) by sampling share: imc, ibi, hnc, auto.
///
/// Each iteration samples the present potential and asks the method for a step towards the targets
/// (inversion_rule.update): g(r) and, if it is asked for, the pressure. The best potential so far
/// is kept; a worse one than chance allows makes the next step half as long, from the best, or the
/// method's other step if it has one. Several targets count in units of their noise. Samples double
/// until their noise is small against the error, or as small as was asked for, and until they are
/// those of equilibrium (inversion/inversion_settled.h), or what is not is small against the error:
/// for a step, and for no more. The fit has converged when χ² of each target is that of noise.
///
/// It starts from the hypernetted-chain inversion (mf_hnc_closure): for water the error of g is
/// then a quarter of that of −k_B T ln g. Where that is far off and puts the liquid under tension,
/// or the first step from there makes it worse, as with targets that end before their oscillations
/// do, it starts again from −k_B T ln g. Replicas begin from disorder, and again after a potential
/// that made it worse: a poor one freezes a liquid, or tears it apart, and what is left of that
/// would be taken for the next potential's structure.
#pragma once

#include "inversion/inversion_band.h"
#include "inversion/inversion_basis.h"
#include "inversion/inversion_kirkwood_buff.h"
#include "inversion/inversion_pressure.h"
#include "inversion/inversion_response.h"
#include "inversion/inversion_rows.h"
#include "inversion/inversion_settled.h"
#include "inversion/inversion_smooth.h"
#include "inversion/inversion_trail.h"
#include "problem/potential_grid.h"
#include "inversion/replicas.h"

/// Bins of all pair types. There are some 20 matrices of bins by bins: 2.5 GB with so many, and
/// minutes to solve.
enum { INVERSION_MOST_BINS = 4000 };

struct inversion_parameters {
    int64_t particles, replicas;
    int64_t equilibration, samples, every;
    int64_t iterations;
    double precision;
    int start;   ///< INVERSION_FROM_…
    int sampler; ///< enum sampler_kind
};

enum { INVERSION_FROM_HNC, INVERSION_FROM_MEAN_FORCE };

/// The parameters of an inversion: what is common, and those of single methods.
struct inversion_settings {
    struct inversion_parameters common;
    struct entropy_parameters entropy;
};

extern const struct field mf_inversion_fields[]; ///< of struct inversion_parameters

struct inversion;

/// What an inversion has of its own (inverse_method.own): the step from its samples, for the known
/// bins, into `step`; perhaps another into `other_step`, with `has_other` set, to be taken from
/// here if that one makes it worse; and up to INVERSION_OWN_COLUMNS columns. A method that is
/// `restricted` measures the gradient of its coefficients, and goes by that. A method that
/// `forgets` goes by the present samples alone: each of its potentials has their noise.
struct inversion_rule {
    enum status (*update)(struct inversion *inversion, double *extra);
    bool forgets;
};

/// Consecutive bins of one kind of targets: those of all pairs, those of all bonds, …
struct inversion_section {
    int kind;                  ///< enum target_kind, or of mf_bonded_distribution_kind
    size_t bin, bins;          ///< the first one among all, and how many there are
    size_t known, known_count; ///< the same of those that are known
    double peak;               ///< largest value of a group's target; of g 1
    double inefficiency;       ///< samples that count as one independent
    double rms, noise;         ///< of the samples and their targets, in peaks
    double own_noise;          ///< of the samples alone
    double misfit;             ///< χ² by bin of the samples, with the noise that they expect
    double probable;           ///< the same at most, of what agrees but for noise
    double precision;          ///< at which that is small enough
};
/// By how much of itself g of the samples is larger than that of a target as a whole, and the
/// standard deviation that was expected of it.
struct inversion_factor {
    double missing, prior;
};

/// What iterations running that met all targets still asked for, of the ramp and of the pressure.
enum { INVERSION_MOST_WAYS = 8 };
struct inversion_ways {
    uint32_t met; ///< such iterations; the last of them are kept
    double ramp[INVERSION_MOST_WAYS], pressure[INVERSION_MOST_WAYS];
};

enum { INVERSION_MOST_SECTIONS = 1 + INVERSE_MOST_BONDED };

/// Whether the samples meet its targets but for noise.
static inline bool inversion_section_agrees(const struct inversion_section *section) {
    return section->misfit <= section->probable;
}

/// What several states say together, for the step of the first of them (inversion/joint.h); or one
/// state, with integrals of Kirkwood and Buff.
struct inversion_joint {
    const struct inversion *state; ///< shape [states]
    size_t states;
    struct imc_system system;  ///< the equations of all, with their pressures and integrals
    struct imc_system doubted; ///< the same with the variances of mf_imc_doubt, of fits with groups
    const double *coarse; ///< the step of several states far from the targets of groups, or NULL
};

struct inversion {
    struct inversion_settings settings;
    const struct inverse_method *method;
    const struct inverse_problem *problem;
    struct potential_grid grid;
    struct box box; ///< of the system that is sampled
    struct composition composition;
    size_t bins; ///< of all pair types and groups
    struct inversion_section section[INVERSION_MOST_SECTIONS];
    int sections;
    struct imc_shape *shape;      ///< of each block
    double *smoothness;           ///< of each group, see inversion_smooth.h
    struct sampler_group *groups; ///< that are counted, shape [grid.groups]
    struct table table;
    struct molecules molecules; ///< with the present U of the groups
    struct replicas replicas;
    /// Shape [bins]: S if g were 1, or p its mean over the known bins; S for a value of 1 of the
    /// target; S of the target and its error; S/ideal that counts as none.
    double *ideal, *unit, *target_counts, *target_error, *least;
    double *excess, *variance; ///< of S in the known bins, shape [known]
    double *common;            ///< error of S* by the factor of its pair type, shape [known]
    double *pooled, *pooled_variance, *pooled_phi; ///< of iterations near the target, see
                                                   ///< mf_inversion_pool
    double *covariance;                 ///< C of S in the known bins, shape [known, known]
    struct inversion_response response; ///< of S to the potential, by C
    double *doubt;                      ///< variances with those of C, of fits with groups
    const struct inversion_joint
        *joint;          ///< of the first of several states, or with integrals; or NULL
    double behind;       ///< samples behind C
    double misfit;       ///< χ² of the excess by bin
    int64_t stretch;     ///< of their equilibration and spacing
    bool unsettled;      ///< the samples are not those of equilibrium, and there are to be no more
    bool useless;        ///< what has not settled of them might change a step
    double inefficiency; ///< the largest of all sections
    double disagreement; ///< of the replicas, mf_replicas_disagreement
    struct target_distance distance[TARGETS]; ///< of the samples from what is asked for
    double own_noise; ///< by the samples alone, rms, of the noisiest section
    bool settling;    ///< the step is the most probable one, near the noise
    struct inversion_pressure pressure;
    struct inversion_kirkwood_buff kirkwood_buff;
    struct inversion_rows rows;      ///< with the integrals, if they are asked for
    struct inversion_rows doubted;   ///< the same with the variances of mf_imc_doubt, with groups
    struct inversion_joint together; ///< these, as of one state
    double *phi, *step;              ///< present potential and the step from it, shape [points]
    double *other_step;              ///< what to do if the step makes it worse
    bool has_other;                  ///< else: half of it
    double *best, *best_step, *best_other;
    double *best_counts;           ///< ⟨S⟩ of the best, shape [bins]
    struct inversion_basis basis;  ///< of methods that go by the gradient; else its count is 0
    struct inversion_basis coarse; ///< of steps far from the targets, of fits with groups
    struct inversion_band band;    ///< of the best
    struct inversion_trail trail;  ///< of all iterations
    // What a checkpoint keeps besides phi, best, … and the samplers:
    struct inversion_progress {
        uint32_t iteration;
        bool anew;         ///< the replicas are placed anew
        bool best_other;   ///< the best has another step
        bool best_precise; ///< its samples are as exact as was asked for
        uint64_t evaluations, sweeps;
        double damping;
        struct target_distance best[TARGETS];  ///< rms of g infinite: there is none yet
        struct target_distance least[TARGETS]; ///< nearest so far, of all that was kept
        double best_own_noise;
        struct inversion_section
            best_worst; ///< section with the largest χ² by bin over the probable
        struct inversion_factor best_factor;  ///< of the best
        struct inversion_unsettled unsettled; ///< the last that were found
        bool again;                           ///< the start is −k_B T ln g after another
        bool lost;                            ///< none of the starts settled
        int64_t stretch;        ///< of equilibration and spacing, by which the next samples begin
        double responses;       ///< samples behind C, of all iterations near the noise
        double pool;            ///< samples that the pooled excess is worth, 0 far off
        double least_decrement; ///< of what was kept, by the gradient
        double miss;            ///< of the last gradient, in its noise
        struct inversion_ways ways;
        double first_error, second_error; ///< of g, in the first two iterations from a start
    } progress;
};

/// @name For the records of the methods: struct inverse_method has a word on each.

enum status mf_inversion_create(void *inversion, const struct inverse_method *method,
                                const struct inverse_problem *problem,
                                const void *parameters) MUST_USE;
void mf_inversion_destroy(void *inversion);
enum status mf_inversion_iterate(void *inversion, struct inverse_step *step,
                                 const struct inverse_listener *listener) MUST_USE;
size_t mf_inversion_spans(void *inversion, struct memory_span *span);
enum status mf_inversion_write(const void *inversion, const struct inverse_folder *folder) MUST_USE;

/// What the records of the inversions have in common.
#define INVERSION_RECORD                                                                           \
    .kind = INVERSE_INVERSION, .parameters_size = sizeof(struct inversion_settings),               \
    .state_size = sizeof(struct inversion), .finds_potential = true,                               \
    .destroy = mf_inversion_destroy, .iterate = mf_inversion_iterate, .spans = mf_inversion_spans, \
    .write = mf_inversion_write

/// The parameters that all have, the first of their tables.
#define INVERSION_TABLE                                                                            \
    { mf_inversion_fields, offsetof(struct inversion_settings, common) }

/// The first of a method's columns; the others may be its own.
#define INVERSION_COLUMNS                                                                          \
    "damping[1]", "own_noise[1]", "disagreement[1]", "rdf_rms[1]", "pressure", "pressure_error",   \
        "acceptance[1]", "potential_energy", "potential_energy_error"
enum { INVERSION_SHARED_COLUMNS = 9, INVERSION_OWN_COLUMNS = INVERSE_EXTRA - 9 };

/// S/ideal of the samples in a bin, g of pairs, and of the target in the same system.
double mf_inversion_g(const struct inversion *inversion, size_t bin);
double mf_inversion_target_g(const struct inversion *inversion, size_t bin);

/// Fill the sections, the shapes and all that the targets say of the bins.
void mf_inversion_count_targets(struct inversion *inversion);

/// Make the tables of the present potentials, which the samplers read. Fails: NO_MEMORY.
enum status mf_inversion_tabulate(struct inversion *inversion) MUST_USE;

/// The two halves of an iteration: sample the present potential and find what that says; keep the
/// potential or go back, and step on. Fails: as inverse_method.iterate.
enum status mf_inversion_observe(struct inversion *inversion,
                                 const struct inverse_listener *listener) MUST_USE;
enum status mf_inversion_advance(struct inversion *inversion, struct inverse_step *step) MUST_USE;

/// Sample the present potential until their noise, and what of them has not settled, is small
/// against their error, and assess them. Samples in equilibrium count for all; those that are far
/// from their targets and not from equilibrium, for a step. They are left `useless` where they have
/// cost 200 times as much as the first ones, or get farther and cannot be kept. Fails: NO_MEMORY,
/// INTERRUPTED. Tested: test_inversion_doubling, test_inversion_settled.
enum status mf_inversion_sample(struct inversion *inversion,
                                const struct inverse_listener *listener) MUST_USE;

/// Whether samples that have not settled do for a step: all that is asked for is so far off that
/// what has not settled is a third of it at most. A potential that is far off may freeze a liquid
/// or tear it, which takes for ever and tells no more of the way to the target. Tested:
/// test_inversion_settled.
bool mf_inversion_tells_way(const struct inversion *inversion);

/// Distances from all targets together, each in units of the noise of the present samples.
double mf_inversion_count_noises(const struct inversion *inversion,
                                 const struct target_distance distance[TARGETS]);

/// Whether the samples are near enough to the targets to be kept, if these are what they are judged
/// by.
bool mf_inversion_is_near_enough(const struct inversion *inversion);

/// The linear equations of the present samples, without the pressure; with it those of all states
/// where there are several, and those with the integrals of Kirkwood and Buff.
struct imc_system mf_inversion_system(const struct inversion *inversion);

/// Replace phi by the nearest that coefficients make, where potentials are made of them. Fails:
/// NO_MEMORY.
enum status mf_inversion_restrict(struct inversion *inversion) MUST_USE;

/// Lengthen the steps after one that is kept, by half, or shorten them if it went much too far: if
/// it was a share s of the step f, and f' from there leads back half of f or more, so much that
/// both lead to one place, s |f|²/(|f|² − f·f'). B. M. Irons and R. C. Tuck, Int. J. Numer. Methods
/// Eng. 1, 275 (1969). Near the target, where f' is noise, it is not asked. Tested:
/// test_inversion_keeps.
void mf_inversion_relax(struct inversion *inversion);

/// phi = best + damping · best_step, bounded as a whole where the target is well known, and bin by
/// bin elsewhere; as a whole everywhere if it is made of coefficients.
void mf_inversion_take_step(struct inversion *inversion);

/// Whether the result of a method that forgets is the mean of the potentials near the target, and
/// no longer the present one (B. T. Polyak and A. B. Juditsky, SIAM J. Control Optim. 30, 838
/// (1992)): there are three or more, and their mean g is nearer. A fit with a pressure, which may
/// have come nearer meanwhile, ends with its last potential. Tested: test_inversion_keeps,
/// test_inversion_converged.
bool mf_inversion_ends_with_mean(const struct inversion *inversion);

/// The same as the end of a fit that has converged, where the step is the most probable one: the
/// potential that the samples ask for is the result, and not the one that they were taken of, which
/// lies on the side that the fit came from. Or the mean of the potentials near the target. U of
/// groups is then as smooth as the prior of the band has it (mf_inversion_smooth). Fails:
/// NO_MEMORY. Tested: test_inversion_keeps.
enum status mf_inversion_take_last_step(struct inversion *inversion) MUST_USE;

/// Whether the present potential is kept: unless it is farther from the targets than the nearest so
/// far, by two of the present noises. The nearest, not the last: samples are no more precise than a
/// third of the error, so that each could be 1.67 times as far as the one before, and so on.
/// Remembers the nearest. By the gradient: unless what is still promised of S_rel, which is convex,
/// is more than twice the least so far. Tested: test_inversion_keeps.
bool mf_inversion_keeps(struct inversion *inversion);

/// Fill phi with the start of the fit: the problem's own, the hypernetted chain's, or −k_B T ln g;
/// what is made of the target is as smooth as its errors allow (mf_imc_solve), since noise of bins
/// beside one another is a force. Fails: NO_MEMORY. Tested: test_inversion_start.
enum status mf_inversion_start(struct inversion *inversion) MUST_USE;

/// The curve that an inversion of the problem begins with, shape [points of mf_unknowns_points]:
/// that of the problem, or the hypernetted chain's, in two dimensions −k_B T ln g; and its virial
/// pressure with the target's g: below 0 the curve may lead nowhere. Fails: NO_MEMORY; BAD_INPUT as
/// mf_inversion_create. Tested: test_fit_base.
enum status mf_inversion_start_curve(const struct inverse_problem *problem, double *curve,
                                     double *pressure) MUST_USE;

/// Whether there is another start to be tried: the first was the hypernetted chain's, a moment ago.
bool mf_inversion_start_has_other(const struct inversion *inversion);

/// Whether the start was the hypernetted chain's and leads nowhere, after an iteration whose
/// potential was kept or not.
bool mf_inversion_start_is_poor(const struct inversion *inversion, bool kept);

/// Fill phi with −k_B T ln g. As mf_inversion_start.
enum status mf_inversion_start_again(struct inversion *inversion) MUST_USE;

/// Why a fit that has finished did not converge, in words.
void mf_inversion_reason_tell(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]);

/// Fill excess, variance and inefficiencies of S, the distances over the bins of each section, and
/// their noise, from the present samples.
void mf_inversion_assess(struct inversion *inversion);

/// χ² of an excess in the known bins begin … end − 1, with the variances of the present samples and
/// the factors of pair types, which are known within an error each.
/// @param[in] excess  shape [known]
double mf_inversion_chi_squared(const struct inversion *inversion, const double *excess,
                                size_t begin, size_t end);

/// Fill in the factor of a pair type that is farthest from what was known of it.
void mf_inversion_find_factor(const struct inversion *inversion, struct inversion_factor *factor);

/// Near the target, replace the excess and its variance by those of all iterations since it was
/// reached: what the earlier ones saw, moved to the present potential by the newest response, which
/// is the best known: each moved by that of its time took for gone what a noisy C had promised. A
/// step from the present samples alone carries their noise into the next potential, so that its
/// error is sqrt(2) times the noise, iteration after iteration; Kushner and Yin, Stochastic
/// Approximation (2003), section 1.1. Present samples weigh a third at least, for what C does not
/// tell. Tested: test_inversion_keeps.
void mf_inversion_pool(struct inversion *inversion);

/// The section that is farthest off, by its χ².
const struct inversion_section *mf_inversion_worst(const struct inversion *inversion);

/// Whether g, and p of all groups, are so near to their targets, by their noise, that C hardly
/// changes any more; or the gradient of coefficients to 0, by its own.
bool mf_inversion_is_near(const struct inversion *inversion);

/// Whether this iteration, whose potential was kept or not, ends the fit: its samples are as exact
/// as was asked for, agree with all targets, and leave no way that g hardly sees. The way has the
/// noise of the samples: the mean of those of the last iterations that met the targets may be half
/// of its error. In fits with groups it is that of two or more, since each step goes a part of its
/// way, from one side, and an iteration that finds it over by chance would end there and take the
/// same chance into the last step: the pressures of 16 twins were 0.6 errors too low. Iterations
/// that are not kept, or whose samples have not settled, do not count. Tested:
/// test_inversion_converged.
bool mf_inversion_has_converged(struct inversion *inversion, bool kept);

/// Damping below this: the step leads nowhere, and the fit ends.
extern const double mf_inversion_least_damping;

/// k_B T ln(g/g*) of the known bins.
void mf_ibi_logarithms(const struct inversion *inversion, double *step);

/// @name The steps of the methods, for the known bins; each meets the pressure if it is asked for.

/// The logarithms; where the target is not well known, of the counts nearest to it that are within
/// two standard errors of those of the samples. Tested: test_ibi.
void mf_ibi_step(const struct inversion *inversion, double *step);

/// The same with the slope of the hypernetted chain. Fails: NO_MEMORY.
enum status mf_hnc_step(const struct inversion *inversion, double *step) MUST_USE;

/// The regularised Newton step, or, with groups far from their targets, that of
/// mf_inversion_coarse_step; of several states by what all say. `extra` are strength, misfit and
/// directions. Sets `settling`. Fails: NO_MEMORY.
enum status mf_imc_step(struct inversion *inversion, double *step, double extra[3]) MUST_USE;

/// Fill `doubt`, the variances of what C predicts. C is itself sampled: of n independent samples
/// C_ab has the variance (C_aa C_bb + C_ab²)/n (normal S), and so Σ_b C_ab x_b/k_B T has
///   (C_aa Σ_b C_bb x_b² + (Σ_b C_ab x_b)²)/(n (k_B T)²),
/// where the last sum is about the excess, and x about the step of Boltzmann inversion. Several
/// pair types and groups have about as many bins as an iteration has independent samples: a step
/// that removed the excess as far as its own noise would follow the noise of C, by thousands of k_B
/// T.
/// @param[out] logarithms  the step of Boltzmann inversion, shape [points]
void mf_imc_doubt(struct inversion *inversion, double *logarithms);
