// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How far particles go, and how long they remember their velocity: mean-square displacement,
/// velocity autocorrelation function, diffusion coefficient.
///
///   MSD(t) = ⟨|r_i(s + t) − r_i(s)|²⟩,   VACF(t) = ⟨v_i(s + t) · v_i(s)⟩,
///   D = slope of the MSD / (2d) (Einstein),   D = (1/d) ∫ VACF dt (Green and Kubo),
///
/// over all particles i and many overlapping time origins s: D. Frenkel and B. Smit, Understanding
/// Molecular Simulation (2nd ed., 2002), sections 4.4 and 5.3; M. P. Allen and D. J. Tildesley,
/// Computer Simulation of Liquids (2nd ed., 2017), section 8.5. Positions are unwrapped, and
/// positions and velocities are those relative to the centre of mass.
///
/// Dynamics without velocities conserve no momentum: positions are those in the box, since the
/// centre of mass diffuses as the particles do, and without its share D would be (1 − 1/N) too
/// small. A drift, such as that of a uniform force, is in their MSD. They are read where the noise
/// of the last step has been taken off (`remove_correlated` of the integrator), so that the MSD of
/// free particles is 2 d D t at every lag. They have no VACF, and all that comes of it is NaN.
#pragma once

#include "base/fields.h"
#include "base/number_text.h"
#include "dynamics/simulation.h"
#include "observe/maxwell.h"
#include "system/whole_molecules.h"

struct motion_plan {
    int64_t every;        ///< steps between samples
    int64_t lags;         ///< length of the window [samples]
    int64_t origin_every; ///< samples between time origins
};

extern const struct field mf_motion_plan_fields[];

enum { MOTION_MAX_BLOCKS = 64 };

/// Cost of a sample: particles × lags / origin_every.
struct motion {
    struct motion_plan plan;
    int dimensions;
    size_t count; ///< of particles
    double time_step;
    bool has_velocities; ///< has velocities
    bool together; ///< momentum is conserved: displacements are relative to the centre of mass
    bool polar;    ///< polarities stand in the place of velocities (observe/polarity.h)
    int64_t begin; ///< step of the first sample
    size_t blocks; ///< of time origins, for the errors
    size_t each;   ///< time origins in a block
    bool endless;  ///< nothing is planned: blocks are joined two by two when all are full
    size_t slots;  ///< time origins whose windows are open at the same time
    size_t samples;
    double *now;      ///< shape [2, dimensions, count]: positions, velocities by particle id
    double *origins;  ///< shape [slots, 2, dimensions, count]
    double *squares;  ///< shape [blocks, lags + 1]: Σ over origins of the mean |Δr|²  [λ²]
    double *products; ///< shape [blocks, lags + 1]: the same of v · v                 [λ²/τ²]
    struct maxwell maxwell;       ///< of configurations a whole window apart
    struct whole_molecules whole; ///< that the particles are; zero: none
    double gyration[2]; ///< Σ of the mean R_g² of a particle [λ²], of how many windows
};

/// Prepare to sample a simulation from step `begin` on, for `steps` steps. Only windows that end
/// within them are begun.
/// Fails: BAD_INPUT if there is no whole window; NO_MEMORY.
enum status mf_motion_init(struct motion *motion, const struct motion_plan *plan,
                           const struct simulation *simulation, int64_t begin,
                           int64_t steps) MUST_USE;

/// The same for `count` points whose samples others take (mf_motion_add): they have no velocities.
/// `together` tells whether their positions are to be relative to the centre of mass of all
/// particles. Fails: as mf_motion_init.
enum status mf_motion_init_points(struct motion *motion, const struct motion_plan *plan,
                                  const struct simulation *simulation, size_t count, int64_t begin,
                                  int64_t steps) MUST_USE;

/// Prepare for samples that others take (mf_motion_add), `interval` apart, as many as there will
/// be, of particles in three dimensions; `has_velocities` if they come with velocities. The plan's
/// `every` is
/// 1. Fails: NO_MEMORY.
enum status mf_motion_init_endless(struct motion *motion, const struct motion_plan *plan,
                                   size_t count, double interval, bool has_velocities) MUST_USE;
void mf_motion_clear(struct motion *motion);

/// Blocks of time origins whose windows are complete.
size_t mf_motion_blocks(const struct motion *motion);

/// The step of the next sample, or INT64_MAX after the last.
int64_t mf_motion_due(const struct motion *motion);

/// Add the present positions and velocities: those of step mf_motion_due.
void mf_motion_sample(struct motion *motion, const struct simulation *simulation);

/// Add a sample that others have taken.
/// @param[in] state  shape [2, dimensions, count]: unwrapped positions and velocities
void mf_motion_add(struct motion *motion, const double *state, int threads);

/// Where particles are beads of molecules, look how large these are, once in a window; beads
/// without bonds have no size. Fails: NO_MEMORY.
enum status mf_motion_see_molecules(struct motion *motion,
                                    const struct particles *particles) MUST_USE;

/// What goes with a checkpoint.
enum { MOTION_SPANS = 5 + MAXWELL_SPANS };
size_t mf_motion_spans(struct motion *motion, struct memory_span *spans);

/// Arrays of lags + 1 numbers, from time 0 on in steps of plan.every · time_step.
struct motion_curves {
    double *msd, *msd_error;   ///< [λ²]
    double *vacf, *vacf_error; ///< [λ²/τ²]; d k_B T ⟨1/m⟩ at time 0
};

struct motion_summary {
    double msd, msd_error;               ///< D of the MSD: least squares, unweighted      [λ²/τ]
    double green_kubo, green_kubo_error; ///< D of the VACF: trapezoids to the window's end [λ²/τ]
    double green_kubo_sampling; ///< what trapezoids of this width may be off               [λ²/τ]
    double green_kubo_truncation; ///< what may follow the window's end                       [λ²/τ]
    double vacf_drop;             ///< 1 − VACF(one interval)/VACF(0)
    double blocks;                ///< of time, complete: what errors rest on
    double fit_begin, fit_end;    ///< the window of the least squares               [τ]
    double growth, growth_error; ///< exponent of the MSD over that window: 1 of what diffuses
    double bend, bend_error;     ///< what its slope changes by along that window, over the slope
    double sizes; ///< MSD at its begin over the mean R_g² of a particle; 0 without molecules
    struct maxwell_summary maxwell; ///< NaN without friction: no thermostat
};

/// Results of all windows that are complete; `curves` may be NULL.
///
/// Errors are those of the means over up to 64 consecutive blocks of time origins, by
/// mf_statistics_correlated_error, since windows of neighbouring blocks overlap. Blocks are of time
/// and not of particles: particles drag their neighbours along, c(r) ∼ R_h/r of a displacement is
/// shared, and groups of particles that look independent would give an error that is too small,
/// by more in a larger box. The price: a run should be twenty windows long or more; from a shorter
/// one the errors, too, are rough (as said there). What is not in the errors: D of the MSD is a
/// mean of D(t) over the fitted times, that of the VACF is D(t) at the window's end; whether D(t)
/// has come to its plateau by then is for the eye.
/// Tested: test_motion, test_motion_brute_force, test_diffusion, test_errors.
///
/// `green_kubo_sampling` is that of Richardson's extrapolation, a third of what trapezoids of twice
/// the width differ by; `green_kubo_truncation` what the second half of the window adds beyond its
/// statistical error: a VACF that has decayed adds nothing there.
struct motion_summary mf_motion_result(const struct motion *motion,
                                       const struct motion_curves *curves);

/// Whether beads still move within their molecules where the window of D begins, however their MSD
/// grows: it is below 4 R_g². Of Rouse's chain D is then 7 % too large or more: the MSD is that of
/// the centre, 12/π² R_g² t/τ, and 2 R_g² (1 − Σ_p 6/(π p)² exp(−p² t/τ)), which come to 4 R_g² at
/// t = 1.8 τ, where the line of least squares up to 2 t has a slope 7 % too steep; at 3.5 R_g² 11
/// %, at 5 2.6 %. Tested: test_motion_growth, cli/test_molecule_motion.
bool mf_motion_is_within(const struct motion_summary *summary);

/// Whether what moves does not diffuse yet over the window that D is of: it is within its
/// molecules, or flies, with an exponent near 2, or is held, below 1, or comes from one to the
/// other, so that the slope still changes. The exponent must be below 0.85 or above 1.3, and 3 of
/// its errors from 1; where these are not known, of one window, it decides alone; but not where the
/// slope is known not to change as that of such a power. The slope must change by a twentieth and 3
/// errors. Of Brownian paths none of several 100 is told, with 2 to 128 beads and 20 to 80 windows.
/// Tested: test_motion, test_motion_growth.
bool mf_motion_is_early(const struct motion_summary *summary);

/// "no D yet: the MSD still grows as t^0.803(21)", or "". Returns `text`.
enum { MOTION_EARLY_SIZE = 128 };
const char *mf_motion_early_text(const struct motion_summary *summary,
                                 char text[MOTION_EARLY_SIZE]);

/// Columns of a table, each of lags + 1 numbers after the one before, which the caller frees:
/// time, MSD, its error, VACF, its error; errors that are not known are NaN. Fails: NO_MEMORY.
enum { MOTION_COLUMNS = 5 };
enum status mf_motion_table(const struct motion *motion, double **columns) MUST_USE;

/// The error of D of the VACF with sampling and truncation [λ²/τ].
double mf_motion_green_kubo_uncertainty(const struct motion_summary *summary);

/// Whether samples are too far apart for D of the VACF: its sampling is off by more than 3 % and
/// its statistical error. Tested: test_motion.
bool mf_motion_is_coarse(const struct motion_summary *summary);

/// Whether D of the VACF can be trusted: its sampling is off by less than 3 % or its statistical
/// error, and it agrees with D of the MSD within four combined errors. Fails: UNCONVERGED with the
/// numbers in the message. Tested: test_motion.
enum status mf_motion_assess(const struct motion_summary *s) MUST_USE;
