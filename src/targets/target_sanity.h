// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A look at the targets of g(r) and at the scene's density before a fit.
///
/// What no fluid does is refused: a g that does not end near 1, beads that no packing holds, number
/// fluctuations below zero. What a fluid hardly does is a warning. Told are the numbers by which a
/// person sees a wrong column, unit of length or number of beads at once.
#pragma once

#include "scene/scene.h"
#include "targets/target_files.h"

/// Takes one line at a time, without its end.
struct target_sanity_listener {
    void (*warn)(void *context, const char *line);
    void *context;
};

/// Refuse what cannot be, for g(r) of each pair type, converted to the scene's number of beads.
///
/// It must not be 0 everywhere. Its mean over the last quarter of the file must be within 0.25 of
/// 1, or within twice the scatter that oscillations make there. Pairs of one type must have ρ d³ ≤
/// √2 (in two dimensions ρ d² ≤ 2/√3), the closest packing of beads no two of which are nearer than
/// d, up to where g stays below 0.01. In three dimensions they must have 1 + ρG ≥ 0, the variance
/// of their number over its mean in a large volume (J. G. Kirkwood and F. P. Buff, J. Chem. Phys.
/// 19, 774 (1951)): refused is what stays below zero by three standard errors up to any range from
/// half of the target's on, and with 1.03 g, too. In a mixture a fault of the mean or of 1 + ρG
/// asks for demixing if the integrals G of two types are above 0 for pairs of one type and below 0
/// for pairs of two. Fails: BAD_INPUT with `file`, the key and the likely reason; NO_MEMORY.
/// Tested: test_target_sanity.
enum status mf_target_sanity_check(const struct target_files *files, const struct scene *scene,
                                   const char *file) MUST_USE;

/// Tell a line for each g(r) as it is given, where its errors and bins come from, warnings, and the
/// normalisation if one was found.
///
/// Warned of are: what is of two phases or of a crystal (targets/target_sanity_errors.c); 1 + ρG
/// below zero, but not with 1.03 g, so that the normalisation may be off; layers, a minimum below
/// 0.95 and a second maximum, of fewer than four neighbours up to that maximum, as a liquid's g has
/// at a density ten times too low (solutes in an implicit solvent look so, too, which is why it is
/// no fault); ρ d³ < 0.01 with d where g exceeds 1/2, the density of a dilute gas; dihedrals of
/// beads that may stand in a line; of molecules a mean g of all beads that ends more than 3 % and
/// three times its scatter away from 1, or that of the only pair type of one kind of molecules that
/// does so. Fails: NO_MEMORY. Tested: test_target_sanity.
enum status mf_target_sanity_report(const struct target_files *files, const struct scene *scene,
                                    const struct target_sanity_listener *listener) MUST_USE;

/// The same of bonds, angles and dihedrals: a line a group, and warnings of angles that may be
/// straight, and of g(r) of molecules that does not end near 1.
void mf_target_sanity_report_groups(const struct target_files *files, const struct scene *scene,
                                    const struct target_sanity_listener *listener);

/// Warn of a pressure that no fluid of this density has, as one in Pa that should be in bar.
/// Tested: cli/test_target_sanity.
void mf_target_sanity_report_pressure(const struct target_files *files, const struct scene *scene,
                                      const struct target_sanity_listener *listener);

/// Tell what was made of a table of g(r) without equal bins, with a g slightly below 0, or that
/// ends before its "cutoff". Tested: cli/test_target_sanity.
void mf_target_sanity_report_reading(const struct target_rdf *target, const char *name,
                                     const struct scene *scene,
                                     const struct target_sanity_listener *listener);

/// By which factor g was divided, if by one.
void mf_target_sanity_report_normalisation(const struct normalisation *n,
                                           const struct target_sanity_listener *listener);

/// Warn of a g(r) most of whose errors are larger than a fifth of it and three times what its rows
/// scatter by, as errors in per cent are; and of all other curves and distributions most of whose
/// errors are larger than half of them. Fails: NO_MEMORY. Tested: cli/test_target_sanity.
enum status mf_target_sanity_report_errors(const struct target_rdf *target, const char *name,
                                           const struct target_sanity_listener *listener) MUST_USE;
void mf_target_sanity_report_other_errors(const struct target_files *files,
                                          const struct target_sanity_listener *listener);

/// Warn of a g(r) of single beads whose mean over the last tenth of its range is more than 3 % away
/// from 1, by four of its errors and twice the scatter of the last quarter, over the normalisation
/// that was given or found. Tested: cli/test_target_sanity.
void mf_target_sanity_report_end(const struct target_rdf *target, const char *name,
                                 const struct normalisation *normalisation,
                                 const struct scene *scene,
                                 const struct target_sanity_listener *listener);

/// Warn of what mf_scene_doubts finds, and of targets beside the scene's mean distance of beads and
/// thermal velocity: a g(r) that ends before 0.3 of the first, bonds beyond 2.5 or below 0.1 of it,
/// a D below 10⁻³ of their product, and a VACF that
/// does not begin at d k_B T/m within a factor of two. Tested: cli/test_doubts.
void mf_target_sanity_report_scales(const struct target_files *files, const struct scene *scene,
                                    const struct target_sanity_listener *listener);

/// Warn of a density or a temperature that is not that of a target.json of `measure` beside the
/// table of g(r), and say again what its summary.json warns of, as of a trajectory that was not
/// in equilibrium. Tested: cli/test_target_sanity.
void mf_target_sanity_report_measured(const struct target_files *files, const struct scene *scene,
                                      const struct target_sanity_listener *listener);

/// Say a line.
void mf_target_sanity_warn(const struct target_sanity_listener *listener, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// The unit of length of printed targets, and λ in it.
const char *mf_target_sanity_length(const struct scene *scene, double *length);

// Whether a g(r) is that of a homogeneous liquid at all.

/// g(r) of beads of one type, in three dimensions, single ones or of molecules.
struct target_state {
    const struct rdf_bins *bins;
    const double *g, *error; ///< shape [bins->count]
    const struct box *box;
    size_t count;  ///< of these beads
    double tail;   ///< mean of g over the last quarter of its range
    double bound;  ///< of them in the molecule of each, beside itself
    double inside; ///< of mf_kirkwood_buff_integrate
};

enum { TARGET_STATE_LINE = 320 };

/// Print what contradicts a homogeneous liquid, and what to do; whether there is something.
///
/// - Two phases, or nearly: 1 + ρG, the variance of the number of beads in a large volume over its
///   mean, is above 3 by three standard errors. It is 0.05 of liquids, 1 of an ideal gas, and grows
///   without bound towards a critical point; between phases g stays above 1 to the end. Of beads of
///   molecules it is over that of an ideal gas of these, 1 + `bound`.
/// - A crystal, of single beads: S(q) = 1 + ρ ∫ (g − 1) sin(qr)/(qr) 4π r² dr over the range of g
///   is above 3.3 by three standard errors. Liquids freeze near a peak of 2.85 (J.-P. Hansen and L.
///   Verlet, Phys. Rev. 184, 151 (1969)), and may be undercooled. Measured, 500 Lennard-Jones
///   particles and g to half of the box: 2.6 near the triple point, 4.1 of the crystal.
///
/// Tested: test_target_sanity_state.
bool mf_target_state_print(const struct target_state *state, char line[TARGET_STATE_LINE]);

/// The same of a file that goes on beyond the cutoff; nothing where it does not.
bool mf_target_state_print_whole(const struct target_state *state,
                                 const struct target_rdf_whole *whole,
                                 char line[TARGET_STATE_LINE]);
