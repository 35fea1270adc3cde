// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Hybrid Monte Carlo: dynamics that sample the canonical ensemble exactly at any time step.
///
/// S. Duane, A. D. Kennedy, B. J. Pendleton and D. Roweth, Phys. Lett. B 195, 216 (1987), with
/// velocities that persist as in A. M. Horowitz, Phys. Lett. B 268, 247 (1991), and extra chances,
/// C. M. Campos and J. M. Sanz-Serna, J. Comput. Phys. 281, 365 (2015): a few steps of velocity
/// Verlet are a proposal, taken if u < exp(−ΔH/k_B T); if it is not, it goes on for as many steps,
/// with ΔH from the same beginning and the same u, until it is or has no more chances: then the
/// particles go back the way they came. Before each, some of them collide with a heat bath: they
/// get velocities of Maxwell's distribution. Bonds, angles and dihedrals of molecules take
/// shorter steps of their own (dynamics/respa.h).
#pragma once

#include "dynamics/simulation.h"
#include "forces/many_body.h"
#include "forces/molecules.h"

/// Time steps of a trajectory.
enum { HYBRID_STEPS = 4 };

struct hybrid {
    struct simulation simulation;
    double longest;              ///< time step, however soft the forces are [τ]
    uint32_t trajectory;         ///< so far: the counter of the random numbers
    double *position[3];         ///< at the start of the trajectory, shape [particles]
    double *velocity[3];         ///< the same
    uint32_t *id;                ///< the same
    double accepted;             ///< probability to be, of the last trajectory at first
    uint64_t taken, tried;       ///< trajectories since mf_hybrid_equilibrate
    struct pair_sums sums;       ///< of the present configuration
    const uint32_t *counts;      ///< its pairs, shape [bins + 1]
    struct pair_histogram trial; ///< of the end of a trajectory, shape [parts, bins + 1]
    uint32_t *kept;
};

/// Particles on a lattice in `box`, mixed at random.
/// @param[in] potential  borrowed; may be exchanged before mf_hybrid_refresh
/// @param[in] molecules  borrowed, and so may their laws be; NULL: single particles
/// @param[in] many_body  energies of local densities, borrowed; NULL: none
/// @param[in] bins       of the pairs to be counted, within the cutoff; `counts` is not read. None:
///                       no pairs are
/// @param[in] bias       of where they begin, now and when they are scattered; NULL: none
/// Fails: as mf_simulation_init.
enum status mf_hybrid_init(struct hybrid *hybrid, const struct box *box,
                           const struct composition *composition, const struct table *potential,
                           const struct molecules *molecules, const struct many_body *many_body,
                           const struct pair_histogram *bins, double temperature, uint64_t seed,
                           const struct placement_bias *bias) MUST_USE;
void mf_hybrid_clear(struct hybrid *hybrid);

/// Place the particles again, without order; molecules as a scene does. Fails: NO_MEMORY,
/// INTERRUPTED.
enum status mf_hybrid_scatter(struct hybrid *hybrid) MUST_USE;

/// Begin with the potential as it is now, from positions, velocities and ids alone, so that a run
/// that continues and one that was reloaded here go on with the same bits. Fails: NO_MEMORY.
enum status mf_hybrid_refresh(struct hybrid *hybrid) MUST_USE;

/// Trajectories whose time step is tuned until four of five are taken at their first chance. Fails:
/// NO_MEMORY, INTERRUPTED.
enum status mf_hybrid_equilibrate(struct hybrid *hybrid, uint64_t trajectories) MUST_USE;

/// Trajectories with a fixed time step, as detailed balance asks. Fails: NO_MEMORY, INTERRUPTED.
enum status mf_hybrid_run(struct hybrid *hybrid, uint64_t trajectories) MUST_USE;
