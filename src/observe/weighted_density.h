// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How dense it is around each particle: the distribution p(ρ) of
///
///   ρ_i = Σ_{j≠i} w(r_ij),
///
/// with w by Sanyal and Shell (curves/weight.h), a number of neighbours, on which the energy of
/// many-body potentials depends. It is of all pairs that interact: those that molecules exclude are
/// left out. Of an ideal gas the mean is ρ ∫w dV and the variance ρ ∫w² dV.
#pragma once

#include "base/statistics.h"
#include "curves/weight.h"
#include "observe/observable.h"
#include "observe/sample_blocks.h"
#include "observe/sample_series.h"
#include "system/neighbours.h"

struct weighted_density_settings {
    double inner_cutoff, cutoff; ///< r_0 and r_c [λ]
    int64_t bins;
    double maximum; ///< of the bins; 0: chosen
};

extern const struct field mf_weighted_density_fields[];
extern const struct observable mf_weighted_density;

/// w of a squared distance.
static inline double weighted_density_weight(const struct weighted_density_settings *settings,
                                             double squared) {
    return weight_sanyal_shell(squared, settings->inner_cutoff * settings->inner_cutoff,
                               settings->cutoff * settings->cutoff);
}

/// r w'(r) of a squared distance.
static inline double weighted_density_stress(const struct weighted_density_settings *settings,
                                             double squared) {
    return weight_sanyal_shell_stress(squared, settings->inner_cutoff * settings->inner_cutoff,
                                      settings->cutoff * settings->cutoff);
}

/// The number of its target among all kinds.
int mf_weighted_density_kind(void);

/// How many independent ones `count` bins from `first` on count as, by the scatter of the blocks of
/// all replicas. Fails: NO_MEMORY.
/// @param[in] states  of the observable, shape [replicas]
enum status mf_weighted_density_independence(const void *const *states, size_t replicas,
                                             size_t first, size_t count,
                                             struct statistics_independence *found) MUST_USE;

/// What is counted of many configurations. All zero is none.
struct weighted_density {
    struct weighted_density_settings settings; ///< with the maximum that was chosen
    struct sample_series series; ///< of each sample: the means of ρ and ρ², the share beyond
    struct sample_blocks blocks; ///< of the share of the particles in each bin
};

/// Prepare for `planned` samples, 0: as many as there will be, of `count` particles in a box, whose
/// ideal gas chooses the largest ρ of the bins: four times its mean and standard deviation, where
/// even a liquid beside its vapour has its place. Must be cleared, also after a failure.
/// Fails: BAD_INPUT if r_0 is not below r_c; NO_MEMORY.
enum status mf_weighted_density_init(struct weighted_density *density,
                                     const struct weighted_density_settings *settings,
                                     const struct box *box, size_t count, size_t planned) MUST_USE;
void mf_weighted_density_clear(struct weighted_density *density);

/// Add a configuration. @param[in] values  shape [count]: ρ_i
/// Fails: NO_MEMORY. Tested: test_weighted_density.
enum status mf_weighted_density_add(struct weighted_density *density, const double *values,
                                    size_t count) MUST_USE;

struct weighted_density_summary {
    double mean, mean_error, variance, variance_error;
    double beyond; ///< share of the particles with a ρ above the bins'
};
struct weighted_density_summary mf_weighted_density_result(const struct weighted_density *density);

/// p at some ρ, on the line between the middles of bins, and its error; NaN beyond the bins.
double mf_weighted_density_at(const struct weighted_density *density, double value, double *error);

/// weighted_density.tsv: ρ, p(ρ) with ∫ p dρ = 1, its error. Fails: IO, NO_MEMORY.
enum status mf_weighted_density_write(const struct weighted_density *density,
                                      const struct observable_results *results) MUST_USE;

/// The numbers of a summary.
void mf_weighted_density_write_summary(const struct weighted_density *density,
                                       struct json_writer *writer);

/// The weighted density around each particle of a configuration, by a list of its own that is as
/// long as the weight is.
struct density_list {
    struct weighted_density_settings settings;
    struct particles particles; ///< a sorted copy
    struct neighbours neighbours;
    double *values;   ///< shape [count]: ρ_i = Σ_j w(r_ij), by id
    double *stresses; ///< shape [count]: Σ_j r w'(r_ij), by id
};

/// Must be cleared, also after a failure. Fails: BAD_INPUT if the weight is too long for the box;
/// NO_MEMORY.
enum status mf_weighted_density_list_init(struct density_list *list,
                                          const struct weighted_density_settings *settings,
                                          const struct box *box, size_t count) MUST_USE;

void mf_weighted_density_list_clear(struct density_list *list);

/// Fill in what a configuration has. Fails: NO_MEMORY. Tested: test_weighted_density (unit, cli).
enum status mf_weighted_density_list_find(struct density_list *list,
                                          const struct particles *from) MUST_USE;
