// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Verification of a result by independent replicas of a longer simulation.
#pragma once

#include "observe/thermodynamics.h"
#include "problem/verify_agreement.h"
#include "problem/verify_step.h"

/// Who simulates: mesofit, but the engine of a fit where that may know more than the scene does.
enum verify_by { VERIFY_BY_AUTO, VERIFY_BY_MESOFIT, VERIFY_BY_ENGINE };

struct verify_parameters {
    int by; ///< enum verify_by
    int64_t replicas;
    double time_step;         ///< 0: that of the scene [τ]
    int shorten;              ///< of the choices "no" and "yes"
    int end_early;            ///< of the choices "no" and "yes"
    struct measure_plan plan; ///< of that step: a shorter one takes as many more steps
};

extern const struct field mf_verify_fields[];

struct verification {
    struct observed observed;
    struct target_distance distance[TARGETS];
    double distance_error[TARGETS]; ///< standard error of each distance, by leaving out replicas;
                                    ///< that of g(r) by leaving out blocks. NaN with one replica
    struct verify_sections sections;
    struct verify_agreement agreement[TARGETS]; ///< with what was to be met; the caller's
    struct verify_agreement compared[TARGETS];  ///< with other targets; the caller's
    double share;                               ///< of mf_verify_agree; the caller's
    struct thermodynamics_summary thermodynamics;
    struct thermodynamics_shift shift;
    double diffusion_begin, diffusion_end; ///< times between which D is the MSD's slope [τ]; or 0
    char warning[512]; ///< why its temperatures are not to be trusted; "" if they are
    struct verify_step step;
    char dynamics[96]; ///< what a file that gives the time step must give, too; the caller's
    char unequilibrated[VERIFY_EQUILIBRIUM_SIZE]; ///< what is not in equilibrium; "" if all is
    bool by_engine;                               ///< another engine has simulated
    uint64_t engine_steps;                        ///< of those that had not settled, too
    size_t particles;
    size_t sampled; ///< particles of the samples that the fit ended with; 0: it has none of its own
    /// Where the first replica ended: positions, then velocities, by id, shape [6, particles];
    /// after the dimensions of the scene 0 [λ], [λ/τ].
    double *configuration;
};

/// Simulate the problem's scene with new seeds; replicas in parallel. With a step that may be
/// shortened it is done again until that suits the potential (problem/verify_step.h), for as long a
/// time each. What has not settled was equilibration: it goes on from where it ended, equilibrated
/// for new velocities and with twice as many steps between samples, up to two times. Another engine
/// of the problem simulates in its place, once.
/// Fails: as mf_simulation_run. Tested: test_verify_again.
enum status mf_verify(const struct inverse_problem *problem, const struct table *potential,
                      const struct table *omega, const struct verify_parameters *parameters,
                      const struct inverse_listener *listener,
                      struct verification *verification) MUST_USE;
void mf_verify_clear(struct verification *verification);
