// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How bond lengths, angles and dihedrals of each group are distributed: p(q), ∫ p dq = 1,
/// and p over its Jacobian, which is exp(−U/k_B T) up to a factor where a term stands alone:
///   r^(d−1) of lengths, (sin θ)^(d−2) of angles, 1 of dihedrals
/// (V. Rühle et al., J. Chem. Theory Comput. 5, 3211 (2009), eqs. 5 to 8). Jacobians are integrated
/// over the bins.
#pragma once

#include "base/statistics.h"
#include "forces/molecules.h"
#include "observe/observable.h"

/// Equal bins of lengths [λ] or of angles [degrees].
struct bonded_bins {
    double low, width;
    size_t count;
};

static inline double bonded_bins_centre(const struct bonded_bins *bins, size_t k) {
    return bins->low + ((double)k + 0.5) * bins->width;
}

/// Settings of the observables bond_lengths, bond_angles and dihedral_angles.
struct bonded_settings {
    int64_t bins; ///< of all groups; 0: those of `target`
    /// Of each group of a target; a count of 0: not measured. The values of the target are those of
    /// these groups, one after the other.
    struct bonded_bins target[MOLECULES_MAX_GROUPS];
};

/// The observable of an order of terms, and the number of its target among all kinds.
const struct observable *mf_bonded_distribution_of(int order);
int mf_bonded_distribution_kind(int order);

/// The order of terms that a kind of targets is about; BONDED_KINDS if it is about none.
int mf_bonded_distribution_order(int kind);

/// Terms of a group in all molecules.
size_t mf_bonded_distribution_terms(const struct topology *topology, int order, int group);

/// Add the terms of a group to the counts of the bins that they are in, shape [bins->count]. What
/// is in no bin is not counted; dihedrals go round. The particles must be joined.
void mf_bonded_distribution_count(const struct molecules *molecules, int order, int group,
                                  const struct bonded_bins *bins, const struct particles *particles,
                                  double *counts);

/// ∫ of the Jacobian over the part of a bin in which q can be [λ^d or rad]. Tested:
/// test_bonded_distribution.
double mf_bonded_distribution_jacobian(int order, int dimensions, const struct bonded_bins *bins,
                                       size_t bin);

/// What p of a group says of its width.
struct bonded_moments {
    double mean, deviation; ///< [λ] or [degrees]; of the deviation that of the bins is taken off
    size_t seen;            ///< bins from the first to the last with p above a part of the peak
};

/// The part of the peak below which the ends of a distribution are not known.
extern const double mf_bonded_distribution_seen;

/// @param[in] p  shape [bins->count]; its integral need not be 1
struct bonded_moments mf_bonded_distribution_moments(const struct bonded_bins *bins,
                                                     const double *p);

/// The means of two parts of a distribution of lengths with a deep valley between, less than a
/// twentieth of the lower peak, or of which a twentieth or more is beyond twice the median, where
/// counts are many and the means differ by a quarter; NaN: it is one. p are counts. Tested:
/// cli/test_measure_molecules.
void mf_bonded_distribution_parts(const struct bonded_bins *bins, const double *p, double part[2]);

/// The deviation below which a group is as good as constrained, by `narrow` of its kind: a
/// hundredth of a bond's mean length, a degree of an angle, none of a dihedral. An oscillation as
/// narrow asks for time steps of a thousandth of the length at the thermal velocity, a twentieth of
/// what pairs ask for, and no g(r) sees that a bond is narrower.
double mf_bonded_distribution_narrow(int order, double mean);

/// Whether that is so, by what is measured.
bool mf_bonded_distribution_is_constrained(int order, const struct bonded_moments *moments);

/// Of what is measured without knowing how wide it is, in `fine` bins of its kind: they are to be
/// joined when all has been counted, by `mf_bonded_distribution_join`. They become as wide as the
/// narrowest group and its counts ask for: its deviation has two where there are few counts and up
/// to five where there are many, as many as D. W. Scott, Biometrika 66, 605 (1979), reckons, and
/// the whole range has 100 at least. A group narrower than a constraint counts as that. Tested:
/// test_measure_own_targets.
void mf_bonded_distribution_join(void *state);

/// Counts of a group in its bins, shape [bins->count], the caller's to free; NULL: no memory.
double *mf_bonded_distribution_counts(const void *state, int group, struct bonded_bins *bins);

#define BONDED_OBSERVABLE(NAME, kind, ...)                                                         \
    extern const struct observable mf_bonded_distribution_##kind;
BONDED_LIST(BONDED_OBSERVABLE)
#undef BONDED_OBSERVABLE

/// How many independent ones `bins` bins of a group from `first` on count as, by the scatter of the
/// blocks of all states. Fails: NO_MEMORY.
/// @param[in] states  of the observable, shape [count]
enum status mf_bonded_distribution_independence(const void *const *states, size_t count, int group,
                                                size_t first, size_t bins,
                                                struct statistics_independence *found) MUST_USE;
