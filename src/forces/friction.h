// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Friction and noise apart from the other forces, for integrators that split them off.
///
/// The force pass keeps the pairs within the cutoff of ω instead of adding their friction. What
/// becomes of the velocities is the integrator's: with u = e·(v_i − v_j) along the unit vector e of
/// a pair, they make
///   v_i += (kick − damping·u) e,   v_j −= the same,   kick = amplitude ζ,
/// with a damping d and an amplitude that depend on ω, and so on r, alone, and with masses on
/// these. ω² is the friction, so that u obeys du = −2 ω² u dt + 2 sqrt(2 k_B T) ω dW, with variance
/// 2 k_B T. ζ is normal (base/normal.h): where friction is thin and strong a pair gets one or two
/// kicks on its way through, and a uniform ζ leaves it too little energy, by a fifth of the
/// temperature. The amplitude is made of the damping, amplitude² = A d (1 − B d), so that the two
/// agree at every r, also in the interval where ω jumps. Tested: test_friction, physics/test_shell.
#pragma once

#include "base/normal.h"
#include "curves/table.h"
#include "forces/transfer.h"
#include "system/neighbours.h"

struct friction_pair {
    float damping, kick;
    int32_t i, j;
};

/// What a method makes of ω at a time step.
struct friction_method {
    double (*damping)(double omega, double time_step);
    double (*square)(double time_step, double temperature); ///< A [λ²/τ²]; NULL: the kick is ζ
    double bound;                                           ///< B
    bool uniform;                                           ///< ζ is, with variance 1, not normal
};

enum { FRICTION_WORK = 4 };

struct friction {
    const struct friction_method *method;
    double kick, bound; ///< sqrt(A), or 0 if the kick is ζ; B
    /// Shape [curves, TABLE_INTERVALS + 1], over the intervals of the table of ω: sqrt(damping),
    /// which is straight where ω is, at the start of an interval and its change over it. The other
    /// two are 0: kernels read records of four.
    double (*precise)[4];
    float (*single)[4]; ///< the same rounded
    struct normal_table normal;
    float (*direction)[4]; ///< e of each pair, from j to i; the last is 0
    struct friction_pair *pair;
    size_t capacity;
    size_t begin[NEIGHBOURS_MAX_PARTS], end[NEIGHBOURS_MAX_PARTS]; ///< pairs of each part
    int parts;
    double (*work[FRICTION_WORK])[4]; ///< of mf_friction_solve; shape [count, 4] each
};

/// Tabulate a method for one ω(r). Fails: NO_MEMORY.
enum status mf_friction_init(struct friction *friction, const struct table *omega, double time_step,
                             double temperature, const struct friction_method *method) MUST_USE;
void mf_friction_clear(struct friction *friction);

/// Make room for all pairs of a list, and clear those kept. Fails: NO_MEMORY.
enum status mf_friction_reserve(struct friction *friction,
                                const struct neighbours *neighbours) MUST_USE;

/// Make room for what is done with all pairs at once, of `count` particles. Fails: NO_MEMORY.
enum status mf_friction_reserve_work(struct friction *friction, size_t count) MUST_USE;

/// @name For sweeps: the velocities into kernel_force, shape [count, 4], and back.
void mf_friction_load_velocities(struct particles *particles);
void mf_friction_store_velocities(struct particles *particles);

/// Where particles have masses, make damping and kick of the pairs those of their masses. They are
/// kept as if all were 1, u decaying by 1 − 2 d = exp(−2 ω² Δt) and the amplitude keeping 2 k_B T:
/// for a method that is exact for one pair. Tested: test_friction.
void mf_friction_weigh(struct friction *friction, const struct particles *particles);

/// Change the velocities pair after pair, in an order that depends on the list alone: the same bits
/// for any number of threads.
/// @param[in,out] transfer  what the impulses are added to, the particles being where the pairs
///                          were kept; or NULL
void mf_friction_sweep(const struct friction *friction, struct particles *particles,
                       struct transfer *transfer);

/// to_i = Σ_j (kick − damping·u) e for all pairs at once, u from the velocities `from`.
/// @param[in]  from   shape [count, 4], the last of each 0
/// @param[out] to     shape [count, 4]
/// @param[in]  kicks  whether to include them
void mf_friction_apply(const struct friction *friction, const struct particles *particles,
                       const double (*from)[4], double (*to)[4], bool kicks);

/// The same added to the forces of the particles, with velocities scale · source[d].
/// @param[in] source  shape [count] for each dimension
/// Fails: NO_MEMORY.
enum status mf_friction_add_to_forces(struct friction *friction, struct particles *particles,
                                      double *const source[3], double scale, bool kicks) MUST_USE;

/// Solve (1 + G) v' = (1 − G) v + kicks, G v = Σ damping·u e, by conjugate gradients, to a
/// residual of `tolerance` times the change that friction and noise make; v' replaces the
/// velocities. The same bits for any number of threads. Fails: NO_MEMORY; UNSTABLE if 1000
/// iterations are too few for so large a friction, and the velocities stay.
enum status mf_friction_solve(struct friction *friction, struct particles *particles,
                              double tolerance) MUST_USE;
