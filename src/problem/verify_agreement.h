// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether what a verification measures is what its targets say, but for noise.
///
/// As an inversion assesses its samples (inversion/inversion_assess): each section, g(r) of a pair
/// type or p of a group, by its χ² by bin, and by how many independent bins it has, as bins next to
/// each other are off together. Any other target likewise as a whole, and then in each of its
/// parts, as one mean hides a misfit in a few of its values: times from one power of two to the
/// next, tenths of r_0 or of any other argument. How values of a part are correlated is not known
/// well enough. The mean of χ² over them is above a bound no more often than that of one value, so
/// that it is judged as one value is. All bounds together are exceeded by noise in one of a
/// thousand fits.
///
/// The noise is that of the target, of the verification, and of the fit's own samples: the
/// potential was found where *their* g is the target's, so that its own g misses it by their noise,
/// however exactly that is simulated later. Both are configurations of one fluid, and so their
/// noises are taken to be alike but for one factor. The error of a target's factor, which its bins
/// have in common, counts as such.
#pragma once

#include "base/statistics.h"
#include "problem/measurement.h"

/// Consecutive values of a target.
struct verify_section {
    int kind;
    size_t first, count; ///< of the target's values: those that tell of the potential
    size_t core;      ///< values before them that have no pairs by the target, but for chance …
    double threshold; ///< … and g that is as good as none
    struct statistics_independence known;
};

enum { VERIFY_MAX_SECTIONS = COMPOSITION_MAX_PAIRS + INVERSE_MAX_BONDED };

struct verify_sections {
    size_t count;
    struct verify_section section[VERIFY_MAX_SECTIONS];
    struct statistics_independence
        curve[TARGETS]; ///< of targets without sections, fitted or compared; numbers 0: none
};

/// A few values beside each other.
struct verify_stretch {
    size_t first, count; ///< of the target's values
    double misfit;       ///< χ² by bin, of a core that of its pairs together
    double probable;     ///< what noise alone exceeds in one of a thousand over all stretches
    bool core;           ///< pairs where the target has none
};

/// Of the section or part of a kind of targets that is least probable.
struct verify_agreement {
    struct target_distance distance;
    double misfit;   ///< χ² by bin
    double probable; ///< what noise alone exceeds in one of a thousand; 0: nothing was assessed
    struct verify_stretch stretch; ///< that is farthest off
    struct verify_part {
        size_t row, rows;       ///< of a matrix; else 0 and 1
        size_t column, columns; ///< of a matrix; else consecutive values
    } part;
};

/// How far it is off, 1 being what noise alone exceeds: as a whole, or in a stretch of it.
static inline double verify_agreement_off(const struct verify_agreement *agreement) {
    const double whole = agreement->probable > 0 ? agreement->misfit / agreement->probable : 0;
    const struct verify_stretch *stretch = &agreement->stretch;
    const double part = stretch->probable > 0 ? stretch->misfit / stretch->probable : 0;
    return whole > part ? whole : part;
}

static inline bool verify_agreement_holds(const struct verify_agreement *agreement) {
    return !(verify_agreement_off(agreement) > 1);
}

/// Find the sections of what is to be found of a problem, and what is known of its other targets.
/// Fails: NO_MEMORY.
/// @param[in] replicas  shape [count], with all samples
/// @param[in] observed  what they have measured together
enum status mf_verify_sections_find(const struct inverse_problem *problem,
                                    const struct measurement *replicas, size_t count,
                                    const struct observed *observed,
                                    struct verify_sections *sections) MUST_USE;

/// Returns how many times the variance of what was observed is that of the fit's samples.
/// @param[in]  noise      mf_targets_noise of the fit's last samples; 0: it has none
/// @param[out] agreement  shape [TARGETS]
/// Tested: test_verify_agreement.
double mf_verify_agree(const struct targets *targets, const struct verify_sections *sections,
                       const struct observed *observed, double noise,
                       struct verify_agreement *agreement);

/// The same of the targets that are only compared with what was fitted to the others: their own
/// noise is off in one of a thousand fits in any of them. What that of the fitted targets makes of
/// them is not known but for `open`.
/// @param[in] share  of mf_verify_agree
/// @param[in] open   standard error of each value by what was fitted, shape [TARGETS]; INFINITY: it
///                   is fitted itself, or not fixed by what is, and not judged
/// Tested: test_verify_agreement.
void mf_verify_compare(const struct targets *compared, const struct verify_sections *sections,
                       const struct observed *observed, double share, const double *open,
                       struct verify_agreement *agreement);

/// What replicas have measured together, how far that is from their targets, and the standard error
/// of each rms: by leaving out one replica in turn (jackknife), of g(r) by leaving out blocks, of
/// which there are more; NaN: not known. Fails: NO_MEMORY.
/// @param[in]  replicas         shape [count]; in the same order afterwards
/// @param[out] observed         zeroed before; to be cleared, also after a failure
/// @param[out] distance, error  shape [TARGETS]
enum status mf_verify_distances(struct measurement *replicas, size_t count,
                                struct observed *observed, struct target_distance *distance,
                                double *error) MUST_USE;

/// Whether the samples so far tell what a verification must: the rms difference from each target
/// that is a curve within a tenth of it, half of its square at most being their own noise; each
/// number as well as its target does; both temperatures within a third of a per cent; and nothing
/// drifts. Fails: NO_MEMORY. Tested: test_verify_known.
enum status mf_verify_knows(struct measurement *replicas, size_t count, bool *known) MUST_USE;

enum { VERIFY_EQUILIBRIUM_SIZE = 160 };

/// Say what is not, into `text`; "" if all is, or if there is one replica. Of samples in
/// equilibrium one of a thousand is reported. Fails: NO_MEMORY. Tested: test_verify_equilibrium.
enum status mf_verify_equilibrium(const struct measurement *replicas, size_t count,
                                  char text[VERIFY_EQUILIBRIUM_SIZE]) MUST_USE;
