// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a fit is to reproduce: measured observables, and how far a simulation is from them.
#pragma once

#include "observe/etd.h"
#include "observe/observable.h"
#include "observe/rdf.h"

/// Kinds of targets are numbers: their order is that in which the observables of the list
/// (observe/observable.h) supply them. Those that something asks for by name are named here;
/// others follow. Tested: test_targets.
enum target_kind {
    TARGET_RDF,
    TARGET_ETD,
    TARGET_VACF,
    TARGET_MSD,
    TARGET_DIFFUSION,
    TARGET_PRESSURE,
    TARGET_DENSITY,
    TARGETS = OBSERVABLE_TARGETS ///< at most
};

/// Name in run files and tables; NULL beyond the last kind.
const char *mf_targets_name(int kind);

/// What the errors of a target's values are of.
enum target_errors {
    TARGET_ERRORS_UNKNOWN,    ///< a file gives them, and does not say
    TARGET_ERRORS_OF_SAMPLES, ///< of a simulation: what the values have in common, its samples have
    TARGET_ERRORS_OF_BINS     ///< of each value by itself: a figure, a rounded table; or no errors
                              ///< are given, and the scatter of the values tells them
};

/// Their names in a run file; ends with NULL.
extern const char *const mf_targets_errors[];

/// Measured values of one observable. Borrowed.
struct target {
    size_t count;               ///< 0: not asked for
    const double *value;        ///< shape [count]; NaN: not known, left out
    const double *error;        ///< standard errors, shape [count]; NaN: not known, left out
    double weight;              ///< of its error in the sum; 0: one over the rms of its errors
    size_t columns;             ///< of a matrix, else 0
    const double *factor_error; ///< of g(r): relative error that all values of a pair type have in
                                ///< common, shape [pairs]; NULL: none
    size_t pairs;               ///< pair types of that
    const double *x;     ///< shape [count]: of a curve that is given at its own points, else NULL
    const size_t *block; ///< of distributions: first values of the blocks that are its features,
                         ///< shape [blocks + 1]; NULL: none
    size_t blocks;
    enum target_errors errors_of;
};

/// Everything that is asked for, and how it was measured.
struct targets {
    struct target target[TARGETS];
    struct rdf_bins bins;   ///< of g(r)
    struct etd_grid etd;    ///< of E(t, r_0); its target has shape [times, bins]
    double etd_interval;    ///< between its times [τ]
    double etd_origins;     ///< between time origins [τ]
    double motion_interval; ///< of VACF, MSD and D [τ]
    size_t motion_lags;     ///< intervals in the window of VACF, MSD and D
    /// Of the other observables, by their places in the list, or NULL of one without. Borrowed.
    const void *settings[OBSERVABLES_MAX];
};

/// Distance of measured values from one target.
struct target_distance {
    double rms;      ///< of measured − wanted over what is known of both
    double noise;    ///< rms of their standard errors
    double variance; ///< of rms by the noise of what was measured: another measurement differs so
    size_t count;    ///< values compared
};

static inline bool targets_ask(const struct targets *targets, enum target_kind kind) {
    return targets->target[kind].count > 0;
}

/// Whether g(r) of a pair type is known. That of single beads is not, nor of pairs whose potential
/// is known and not looked for.
bool mf_targets_have_pair(const struct targets *targets, size_t pair);

/// Number of targets that are asked for.
size_t mf_targets_count(const struct targets *targets);

/// @param[in] value, error  shape [target->count]; NaN: not measured
struct target_distance mf_targets_distance(const struct target *target, const double *value,
                                           const double *error);

/// Variance of an rms e over n values, of which ten at most are independent, each with the variance
/// s²: e² has 4 e² s²/n + 2 s⁴/n, and e that over (2e)².
double mf_targets_rms_variance(double rms, double square, double count);

/// The same of the one known value that is farthest off by its noise: what agrees within the errors
/// of all has each of its numbers within its own.
struct target_distance mf_targets_worst(const struct target *target, const double *value,
                                        const double *error);

/// Weight of a target in the sum: its own, or one over the rms of its standard errors.
double mf_targets_weight(const struct target *target);

/// All distances in one number: that of a single target as it is; of several the weighted rms,
/// sqrt(Σ (w rms)² / count), in which 1 is as far as the statistical errors of the targets alone.
double mf_targets_error(const struct targets *targets, const struct target_distance *distance);

/// Variance of that sum.
double mf_targets_variance(const struct targets *targets, const struct target_distance *distance);

/// The same sum over the noise of each.
double mf_targets_noise(const struct targets *targets, const struct target_distance *distance);

/// The noise that the targets have by themselves, in the same sum: what the exactest measurement
/// leaves of mf_targets_noise. A target without errors has those that its weight assumes.
/// Tested: test_targets.
double mf_targets_own_noise(const struct targets *targets);

/// @name Features: the targets in few enough numbers for a linear model
/// Values as they are, but a matrix, E(t, r_0), as means over blocks of cells, 10 by 10, without
/// its first row; and distributions as means over their blocks, over those of the target.

/// Blocks of consecutive values of a distribution, each of at least a 50th of the whole, so that
/// the few counts of its ends, whose errors are hardly known, do not stand alone. Returns how many.
/// @param[in]  value  shape [count]
/// @param[out] block  the first value of each, counted from `first`; at most 50
/// Tested: test_targets.
enum { TARGETS_MAX_BLOCKS = 50 };
size_t mf_targets_blocks(const double *value, size_t count, size_t first,
                         size_t block[TARGETS_MAX_BLOCKS]);

size_t mf_targets_features(const struct targets *targets);

/// Features of observed values, or of the targets themselves if `observed` is NULL. What is not
/// known of the targets is 0 in both, and what was not observed is as the target. Errors are rms
/// over a block, as if its cells were one.
/// @param[in]  observed      shape [TARGETS][target.count], or NULL
/// @param[out] value, error  shape [mf_targets_features]; error may be NULL with observed values
void mf_targets_take_features(const struct targets *targets, double *const *observed, double *value,
                              double *error);

/// Variances ε_j² of the features with which Σ_j (miss_j/ε_j)² is the square of mf_targets_error,
/// up to a factor: their mean over features is as if each missed by `error`.
/// @param[out] variance  shape [mf_targets_features]
void mf_targets_spread_error(const struct targets *targets, double error, double *variance);
