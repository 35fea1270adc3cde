// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The points at which the fitted potentials are known: a block for each pair of types, and
/// after them one for each group of bonds, angles or dihedrals (problem/bonded_grid.h).
///
/// In each block of pairs the bin centres of the target, in three parts: the core, where the target
/// has no more pairs than two of its standard errors and the potential is continued, as a straight
/// line where there are some pairs and as a parabola where there are none (mf_core_fill); the known
/// bins; and the cutoff, the upper edge of the last bin, where the potential is 0. It has one point
/// more than bins.
#pragma once

#include "problem/bonded_grid.h"

struct potential_grid {
    size_t pairs;        ///< of types whose potential is unknown
    size_t bins;         ///< of a block of pairs
    size_t groups;       ///< of bonds, angles and dihedrals
    size_t blocks;       ///< pairs + groups
    size_t pair_points;  ///< pairs · (bins + 1)
    size_t pair_bins;    ///< pairs · bins
    size_t points;       ///< of all blocks
    size_t all_bins;     ///< of all blocks
    size_t *core;        ///< shape [pairs]: points in the core = the first known bin
    size_t *empty;       ///< shape [pairs]: points below the first with any pairs; core at most
    size_t *known_of;    ///< shape [blocks]: bins with a value of their own
    size_t known;        ///< bins with a value of their own, of all blocks
    size_t pairs_known;  ///< those of pairs
    size_t *known_point; ///< shape [known]: where they are among the points …
    size_t *known_bin;   ///< … and among the bins of all blocks
    bool *well_known;    ///< shape [known]: the target tells the potential there: g* > 0.1, or p* >
                         ///< 0.1 of its peak; of several states, one of their targets
    bool *seen;          ///< shape [known]: this problem's target tells of the bin, and not only
                         ///< another state's
    double *r;           ///< shape [points] [λ], of angles [degrees]
    double *stiffness;   ///< shape [pairs]: of the core; 0 where what is known keeps pairs away
    double *rise;        ///< shape [pairs]: −Φ' into the core, at least [k_B T_0/λ]
    struct inverse_law beside; ///< what acts with it in samples; none if an engine has it itself
    /// The straight line of f(ρ), which is a potential of pairs: f less s ρ, and Φ plus 2 s w(r),
    /// are the same energy. Shape [known], or NULL without both.
    struct {
        double *change; ///< (ρ, −2 w): what takes away a slope of 1
        double *weight; ///< slope of f = Σ weight f, the best line over the target's p(ρ)
    } shared;
    struct potential_group {
        struct bonded_grid own;
        size_t point, bin; ///< where its points and bins begin among all
    } * group;             ///< shape [groups]
};

/// Pairs are left out if groups are looked for and the pairs' potential is not. Fails: NO_MEMORY;
/// BAD_INPUT if a target is nowhere above the threshold, as mf_potential_grid_check_known, or as
/// mf_bonded_grid_init.
enum status mf_potential_grid_init(struct potential_grid *grid,
                                   const struct inverse_problem *problem) MUST_USE;
void mf_potential_grid_clear(struct potential_grid *grid);

/// Whether a group is one of terms of molecules, and not of local densities.
bool mf_potential_grid_has_terms(const struct potential_grid *grid);

/// First point of a block of pairs.
size_t mf_potential_grid_block(const struct potential_grid *grid, size_t pair);

/// Whether a point of pairs is in the core of its block.
bool mf_potential_grid_in_core(const struct potential_grid *grid, size_t point);

/// Complete phi, shape [points], from its known values, less what is shared: core below, 0 at the
/// cutoff; U with a least value of 0, and beyond what the target knows. Or, with the constants of U
/// left as they are, pairs alone, shape [pair_points], or groups, shape [points − pair_points].
void mf_potential_grid_complete(const struct potential_grid *grid, double *phi);
void mf_potential_grid_complete_pairs(const struct potential_grid *grid, double *phi);
void mf_potential_grid_complete_groups(const struct potential_grid *grid, double *energy);

/// Find what f and Φ share. Fails: NO_MEMORY.
enum status mf_potential_grid_find_shared(struct potential_grid *grid,
                                          const struct inverse_problem *problem) MUST_USE;

/// The convention: f has no slope, of its best line over p(ρ), and Φ has it all. phi, shape
/// [points], of which the known values change.
void mf_potential_grid_remove_shared(const struct potential_grid *grid, double *phi);

/// What a group of dihedrals has at its first point it has at its last, which is the same: of
/// errors.
void mf_potential_grid_close(const struct potential_grid *grid, size_t group, double *values);

/// Table of the pairs for the kernels from a completed phi, with what is known beside it. Fails:
/// NO_MEMORY. Tested: test_potential_known.
enum status mf_potential_grid_table(const struct potential_grid *grid, const double *phi,
                                    struct table *table) MUST_USE;

/// The same of what is looked for alone, and of one pair type.
enum status mf_potential_grid_table_sought(const struct potential_grid *grid, const double *phi,
                                           struct table *table) MUST_USE;
enum status mf_potential_grid_table_pair(const struct potential_grid *grid, const double *phi,
                                         size_t pair, struct table *table) MUST_USE;

/// What the known part counts as in a bin of its pair type, of a uniform density in it:
/// −k_B T ln⟨exp(−Φ/k_B T)⟩, and no more than a height at which there are no pairs.
double mf_potential_grid_known(const struct inverse_problem *problem, size_t pair, size_t bin);

/// Curvature of the core of a pair type: 0 where the known part rises into it by
/// more than that by itself.
double mf_potential_grid_stiffness(const struct potential_grid *grid,
                                   const struct inverse_problem *problem, size_t pair);

/// −Φ' into the core of a pair type, at least: by how g falls there from its first known bin to the
/// one before, the mean force, less what is known. The wall of a hard core, and the inner side of a
/// well at contact, are narrower than a bin: pairs would come through what goes on as between the
/// first two known bins; 0 where the known part keeps pairs away [k_B T_0/λ].
double mf_potential_grid_rise(const struct potential_grid *grid,
                              const struct inverse_problem *problem, size_t pair);

/// Refuse a known part that is so high where the target has many pairs. Fails: BAD_INPUT.
enum status mf_potential_grid_check_known(const struct potential_grid *grid,
                                          const struct inverse_problem *problem) MUST_USE;

/// The molecules with the laws that are looked for. What is not is borrowed, and the rest is to be
/// cleared with mf_potential_grid_molecules_clear, also after a failure.
/// @param[in] energy  completed, of all groups: from pair_points on of a phi
/// Fails: NO_MEMORY.
enum status mf_potential_grid_molecules(const struct potential_grid *grid, const double *energy,
                                        const struct molecules *from,
                                        struct molecules *to) MUST_USE;
void mf_potential_grid_molecules_clear(const struct potential_grid *grid,
                                       struct molecules *molecules);

/// The same of the scene's local densities, with the energies that are looked for.
enum status mf_potential_grid_many_body(const struct potential_grid *grid, const double *energy,
                                        const struct many_body *from,
                                        struct many_body *to) MUST_USE;
void mf_potential_grid_many_body_clear(const struct potential_grid *grid,
                                       struct many_body *many_body);

/// Where the pairs of a fit begin: the problem's start curves, or the potentials of mean force
/// −k_B T ln g* less what is known; shape [pair_points].
void mf_potential_grid_start_pairs(const struct potential_grid *grid,
                                   const struct inverse_problem *problem, double *phi);

/// Where a fit begins: pairs as above, groups as mf_bonded_grid_start.
void mf_potential_grid_start(const struct potential_grid *grid,
                             const struct inverse_problem *problem, double *phi);

/// The same whatever starts the problem has: what the targets alone say.
void mf_potential_grid_mean_force(const struct potential_grid *grid,
                                  const struct inverse_problem *problem, double *phi);

/// The virial of pairs, by the bin that they are in and the value that makes it: the mean over a
/// bin's shell of −r ∂Φ'(r)/∂Φ_b, so that W = Σ_a S_a Σ_b virial_ab Φ_b + what the core's stiffness
/// adds. Through the tables that the kernels read, so that spline and core are those of a
/// simulation. g(r) counts as constant in a bin.
/// @param[in]  phi     completed, shape [points]
/// @param[out] virial  shape [pairs · bins, known], row-major; 0 for groups
/// Fails: NO_MEMORY. Tested: test_potential_grid, test_inversion_pressure.
enum status mf_potential_grid_virials(const struct potential_grid *grid,
                                      const struct rdf_bins *bins, int dimensions,
                                      const double *phi, double *virial) MUST_USE;

/// The ramp 1 − r/r_c, which moves the pressure and hardly g(r), at a point of the grid; 0 for
/// groups.
double mf_potential_grid_ramp(const struct potential_grid *grid, size_t point);
