// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a fit is to reproduce: measured observables, and how far a simulation is from them.
#pragma once

#include "observe/etd.h"
#include "observe/rdf.h"

enum goal_kind { GOAL_RDF, GOAL_ETD, GOAL_VACF, GOAL_MSD, GOAL_DIFFUSION, GOAL_PRESSURE, GOALS };

/// Names in run files and tables, shape [GOALS].
extern const char *const mf_goals_names[GOALS];

/// Measured values of one observable. Borrowed.
struct goal {
    size_t count;        ///< 0: not asked for
    const double *value; ///< shape [count]; NaN: not known, left out
    const double *error; ///< standard errors, shape [count]; NaN: not known, left out
    double weight;       ///< of its error in the sum; 0: one over the rms of its errors
};

/// Everything that is asked for, and how it was measured.
struct goals {
    struct goal goal[GOALS];
    struct rdf_bins bins;   ///< of g(r)
    struct etd_grid etd;    ///< of E(t, r_0); its goal has shape [times, bins]
    double etd_interval;    ///< between its times [τ]
    double etd_origins;     ///< between time origins [τ]
    double motion_interval; ///< of VACF, MSD and D [τ]
    size_t motion_lags;     ///< intervals in the window of VACF, MSD and D
};

/// Distance of measured values from one goal.
struct goal_distance {
    double rms;      ///< of measured − wanted over what is known of both
    double noise;    ///< rms of their standard errors
    double variance; ///< of rms by the noise of what was measured: another measurement differs so
    size_t count;    ///< values compared
};

static inline bool goals_ask(const struct goals *goals, enum goal_kind kind) {
    return goals->goal[kind].count > 0;
}

/// Number of goals that are asked for.
size_t mf_goals_count(const struct goals *goals);

/// @param[in] value, error  shape [goal->count]; NaN: not measured
struct goal_distance mf_goals_distance(const struct goal *goal, const double *value,
                                       const double *error);

/// Weight of a goal in the sum: its own, or one over the rms of its standard errors.
double mf_goals_weight(const struct goal *goal);

/// All distances in one number: that of a single goal as it is; of several the weighted rms,
/// sqrt(Σ (w rms)² / count), in which 1 is as far as the statistical errors of the targets alone.
double mf_goals_error(const struct goals *goals, const struct goal_distance *distance);

/// Variance of that sum.
double mf_goals_variance(const struct goals *goals, const struct goal_distance *distance);

/// The same sum over the noise of each.
double mf_goals_noise(const struct goals *goals, const struct goal_distance *distance);

/// @name Features: the goals in few enough numbers for a linear model
/// g(r), VACF, MSD, D and pressure as they are; E(t, r_0) as means over blocks of cells, 10 by 10.

size_t mf_goals_features(const struct goals *goals);

/// Features of observed values, or of the targets themselves if `observed` is NULL. What is not
/// known of the targets is 0 in both, and what was not observed is as the target. Errors are rms
/// over a block, as if its cells were one.
/// @param[in]  observed      shape [GOALS][goal.count], or NULL
/// @param[out] value, error  shape [mf_goals_features]; error may be NULL with observed values
void mf_goals_take_features(const struct goals *goals, double *const *observed, double *value,
                            double *error);
