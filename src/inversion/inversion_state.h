// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One state of an inversion: what is sampled, what its targets ask for, and what its samples
/// say.
///
/// A state has a problem of its own: targets, temperature, density, composition; the potentials are
/// those of all states. Samples double until their noise is small against the error, or as small as
/// was asked for, and until they are those of equilibrium (inversion/inversion_equilibrium.h), or
/// what is not is small against the error: for a step, and for no more.
#pragma once

#include "inversion/imc_solve.h"
#include "inversion/inversion_basis.h"
#include "inversion/inversion_kirkwood_buff.h"
#include "inversion/inversion_memory.h"
#include "inversion/inversion_bulk.h"
#include "inversion/inversion_response.h"
#include "inversion/inversion_assessment.h"
#include "inversion/replicas.h"
#include "problem/potential_grid.h"

/// Bins of all pair types. There are some 20 matrices of bins by bins: 2.5 GB with so many, and
/// minutes to solve.
enum { INVERSION_MAX_BINS = 4000 };

/// The parameters of all inversions, the first of each method's own.
struct inversion_parameters {
    int64_t particles, replicas;
    int64_t equilibration, samples, every;
    int64_t iterations;
    double precision;
    double damping; ///< part of each step that is taken
    int start;      ///< INVERSION_FROM_…
    int sampler;    ///< enum sampler_kind
};

enum { INVERSION_FROM_HNC, INVERSION_FROM_MEAN_FORCE, INVERSION_FROM_FORCES };

/// What its targets ask of S: the number of pairs in a bin of g(r), or of terms in a bin of a
/// group, in one sample; S* is what it should be. Shape [bins] each.
struct inversion_target {
    double *ideal;           ///< S if g were 1, or p its mean over the known bins
    double *unit;            ///< S for a value of 1 of the target; infinite where there is none
    double *counts, *error;  ///< S of the target and its error
    double *min;             ///< S/ideal that counts as none
    double *common;          ///< error of S* by the factor of its pair type, shape [known]
    double *steepness;       ///< of −ln g*, imc_system.steepness, shape [known]
    struct imc_shape *shape; ///< of each block
};

/// The present potentials as the samplers read them.
struct inversion_interaction {
    struct table table;
    struct molecules molecules; ///< with the present U of the groups
    struct many_body many_body; ///< with the present f of the local densities
};

/// The excess of all iterations near the target: S̄ − S* at the mean potential, see
/// mf_inversion_pool.
struct inversion_pool {
    double *excess, *variance; ///< shape [known]
    double *phi;               ///< the mean potential, shape [points]
    double samples;            ///< that the pool is worth, 0 far off
};

struct inversion_state {
    const struct inverse_problem *problem;
    const struct inversion_parameters *parameters;
    const double *phi; ///< the present potential, of all states; borrowed
    struct potential_grid grid;
    struct box box; ///< of the system that is sampled
    struct composition composition;
    struct topology topology; ///< of its molecules, if it is not as large as the scene
    size_t bins;              ///< of all pair types and groups
    struct inversion_target target;
    struct sampler_group *groups; ///< that are counted, shape [grid.groups]
    struct inversion_interaction interaction;
    struct replicas replicas;
    double *excess, *variance;          ///< of S in the known bins, shape [known]
    double *bin_inefficiency;           ///< the same of the bin's pair type or group
    double inefficiency;                ///< the largest of all sections
    struct inversion_memory *memory;    ///< of each pair type and group, shape [grid.blocks]
    struct inversion_response response; ///< of S to the potential, by C
    struct inversion_pool pool;
    struct inversion_bulk bulk;
    struct inversion_kirkwood_buff kirkwood_buff;
    struct inversion_assessment assessment;
    struct {
        double *g;    ///< of the pairs that molecules exclude, shape [pairs, bins of a pair]
        double min;   ///< mf_hnc_closure_min_intramolecular; 0: not known
    } inside;         ///< molecules by themselves, inversion/inversion_intramolecular.h
    double *indirect; ///< h − c of the target's pairs, shape [bins]; NULL until it is asked for
    struct {
        double *weight;     ///< of S in it, shape [known]
        double samples;     ///< its standard error by the samples of all states
        double rest;        ///< and without; 0: not known
        double independent; ///< samples of the slowest number that these are worth; 0: not known
    } open; ///< A of the step, or the pressure that it asks for, of which the samples tell least;
            ///< as the last iteration knew it, mf_inversion_band_add_samples
    struct inversion_basis basis;    ///< of methods that go by the gradient; else its count is 0
    struct inversion_basis low_rank; ///< of steps far from the targets, of fits with groups
    double gradient;                 ///< of coefficients in its noise, when it was measured last
    struct inversion_work {
        uint64_t evaluations, sweeps; ///< so far
        bool mixed;    ///< since they were placed the replicas have agreed but for their noise
        double memory; ///< sweeps from one independent sample to the next, as the last ones had,
                       ///< of what is slowest
    } work;
};

/// All but the samplers, by the parameters, which are borrowed.
/// @param[in] coefficients  of potentials that are made of few; NULL: bins have values of their own
/// Must be cleared, also after a failure. Fails: NO_MEMORY, BAD_INPUT.
enum status mf_inversion_state_init(struct inversion_state *state,
                                    const struct inverse_problem *problem,
                                    const struct inversion_parameters *parameters,
                                    const struct inversion_basis_size *coefficients) MUST_USE;

/// Whether so many particles, at the densities of the scene, keep the shares of its types and kinds
/// of molecules in a box that holds its forces; 0: those of the scene. It takes no time, however
/// many there are. Fails: BAD_INPUT. Tested: test_fit_molecules.
enum status mf_inversion_check_size(const struct inverse_problem *problem,
                                    int64_t particles) MUST_USE;

/// The molecules of the system that is sampled; NULL: it has none.
const struct topology *mf_inversion_topology(const struct inversion_state *state);

/// Make the samplers of the present potential. Fails: as mf_replicas_init.
enum status mf_inversion_state_make_samplers(struct inversion_state *state) MUST_USE;
void mf_inversion_state_clear(struct inversion_state *state);

/// What a checkpoint keeps; returns the number of spans.
size_t mf_inversion_state_spans(struct inversion_state *state, struct memory_span *span);

/// S/ideal of the samples in a bin, g of pairs, and of the target in the same system.
double mf_inversion_g(const struct inversion_state *state, size_t bin);
double mf_inversion_target_g(const struct inversion_state *state, size_t bin);

/// Variance of S* of a known bin, as it would be if the potential were right: where the target has
/// few counts, they are as often fewer than expected as more, and would have too small an error
/// then. It is that of the counts that the samples expect, if these are more.
double mf_inversion_target_variance(const struct inversion_state *state, size_t a);

/// Fill `target` and the sections from the targets of the problem.
void mf_inversion_count_targets(struct inversion_state *state);

/// Make the tables of the present potentials, which the samplers read. Fails: NO_MEMORY.
enum status mf_inversion_tabulate(struct inversion_state *state) MUST_USE;

/// What the present samples say of g and p of groups: excess, variance and inefficiencies of S, the
/// distances over the bins of each section, and their noise.
void mf_inversion_assess(struct inversion_state *state);

/// χ² of an excess in the known bins begin … end − 1, with the variances of the present samples and
/// the factors of pair types, which are known within an error each.
/// @param[in] excess  shape [known]
double mf_inversion_chi_squared(const struct inversion_state *state, const double *excess,
                                size_t begin, size_t end);

/// The chance that noise alone makes a fit that has met its targets look as if it had not.
extern const double mf_inversion_chance;

/// χ² by bin of a section that noise alone exceeds with a chance; infinite if none of it was seen.
double mf_inversion_probable(const struct inversion_state *state,
                             const struct inversion_section *section, double chance);

/// By how much of itself g of the samples is larger than that of a target as a whole, and the
/// standard deviation that was expected of it.
struct inversion_factor {
    double missing, prior;
};

/// Of a pair type; 0 where it is known.
struct inversion_factor mf_inversion_factor_of(const struct inversion_state *state, size_t pair);

/// Fill in the factor of a pair type that is farthest from what was known of it.
void mf_inversion_find_factor(const struct inversion_state *state, struct inversion_factor *factor);

/// Near the target, replace the excess and its variance by those of all iterations since it was
/// reached: what the earlier ones saw, moved to the present potential by the newest response, which
/// is the best known: each moved by that of its time took for gone what a noisy C had promised. A
/// step from the present samples alone carries their noise into the next potential, so that its
/// error is sqrt(2) times the noise, iteration after iteration; Kushner and Yin, Stochastic
/// Approximation (2003), section 1.1. Present samples weigh a third at least, for what C does not
/// tell. Tested: test_inversion_keeps.
/// @param[in] alone  the present samples weigh all: the fit is on its way
///                   (inversion_progress.on_its_way)
void mf_inversion_pool(struct inversion_state *state, bool alone);

/// Whether g, and p of all groups, are so near to their targets, by their noise, that C hardly
/// changes any more; or the gradient of coefficients to 0, by its own.
bool mf_inversion_state_is_near(const struct inversion_state *state);
