/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file A simulation: create it from a scene, step it, measure it.
 *
 * All numbers are in reduced units, also where a file speaks others: energy k_B T_0, length lambda,
 * mass mu, time tau = lambda sqrt(mu / k_B T_0). Several simulations may live in one process, each
 * used by one thread at a time.
 */
#ifndef MESOFIT_SIMULATION_H
#define MESOFIT_SIMULATION_H

#include "mesofit/status.h"
#include "mesofit/table.h"

#include <stdint.h>

struct mesofit_simulation;

/** A function of the pair distance: the potential Phi(r) or the friction weight omega(r). */
struct mesofit_law {
    /** As a scene file says it, such as {"law": "soft-repulsion", "a": 25}; or NULL. */
    const char *text;
    /** The caller's own, if `text` is NULL: its value at r [k_B T_0] or [sqrt(mu/tau)], which is
     *  called while the simulation is created, and not afterwards. NULL: there is none. */
    double (*value)(const void *context, double r);
    const void *context;
    double cutoff; /**< of `value`, beyond which it is 0 [lambda] */
};

/** What defines a simulation. Begin with mesofit_scene_default. */
struct mesofit_scene {
    double box[3]; /**< edges; box[2] = 0 is a plane [lambda] */
    int64_t particles;
    double temperature;              /**< [T_0] */
    double time_step;                /**< [tau] */
    struct mesofit_law conservative; /**< Phi(r) */
    struct mesofit_law dissipative;  /**< omega(r); friction omega^2, noise sqrt(2 k_B T) omega */
    const char *integrator; /**< name, as `mesofit describe dynamics` lists them; or NULL */
    uint64_t seed;          /**< below 2^53 */
    int threads;            /**< of one step; the results do not depend on it */
};

/** A box of 10^3 with 3000 particles at temperature 1, time step 0.02, no forces, seed 1, one
 *  thread. */
MESOFIT_API struct mesofit_scene mesofit_scene_default(void);

/** Place the particles on a lattice and draw their velocities. NULL on failure: BAD_INPUT,
 *  NO_MEMORY, UNSTABLE. */
MESOFIT_API struct mesofit_simulation *mesofit_simulation_create(const struct mesofit_scene *scene);

/** The same from the text of a scene file (JSON), in which files may be tables in memory. */
MESOFIT_API struct mesofit_simulation *
mesofit_simulation_parse(const char *text, const struct mesofit_table *tables, size_t table_count);

/** The same from a scene file. Fails also with IO. */
MESOFIT_API struct mesofit_simulation *mesofit_simulation_open(const char *file);

MESOFIT_API void mesofit_simulation_free(struct mesofit_simulation *simulation);

/** Forces of the caller's own, added to those of the pairs in each step: add to force[d][k].
 *  @param position, force  shape [dimensions][count], in the order of `id`
 *                          [lambda], [k_B T_0/lambda]
 *  @param id               of each particle, 0 to count - 1, shape [count]
 *  @return their potential energy [k_B T_0], or 0
 */
typedef double mesofit_force(void *context, size_t count, const uint32_t *id,
                             const double *const *position, double *const *force);

/** Add these forces from the next step on, which calls them once or more often; NULL ends it. They
 * count for the energy, not for the pressure. "monte-carlo" refuses them: it knows no forces. */
MESOFIT_API void mesofit_simulation_set_force(struct mesofit_simulation *simulation,
                                              mesofit_force *force, void *context);

/** End what runs with it in another thread between two steps: INTERRUPTED, after which it can go
 * on. Nothing if nothing runs. Also from a handler of a signal. */
MESOFIT_API void mesofit_simulation_stop(struct mesofit_simulation *simulation);

/** Advance by `steps` steps. Fails: UNSTABLE, NO_MEMORY, INTERRUPTED. */
MESOFIT_API enum mesofit_status mesofit_simulation_run(struct mesofit_simulation *simulation,
                                                       uint64_t steps);

/** The scene as it was read, defaults filled in, a JSON text as of a scene file, with two members
 *  more: "edges" of the box [lambda] and, if the scene has units, "physical": what 1 of length,
 * time, energy, mass and temperature is, "length_unit_nm", "time_unit_ps",
 * "energy_unit_kJ_per_mol", "mass_unit_u", "temperature_unit_K". NULL without memory. It stays
 * until the simulation is freed.
 */
MESOFIT_API const char *mesofit_simulation_text(struct mesofit_simulation *simulation);

MESOFIT_API uint64_t mesofit_simulation_step(const struct mesofit_simulation *simulation);
MESOFIT_API size_t mesofit_simulation_count(const struct mesofit_simulation *simulation);
MESOFIT_API int mesofit_simulation_dimensions(const struct mesofit_simulation *simulation);

/** @name The state, without a copy
 *  Arrays of shape [count] for axis 0, 1 and, in space, 2; the particle in place k has the number
 *  mesofit_simulation_ids()[k]. Steps sort the particles: ask again after each run.
 *  Positions may be outside of the box by what a particle has moved since the last sort.
 *  NULL: no such axis.
 */
MESOFIT_API const uint32_t *mesofit_simulation_ids(const struct mesofit_simulation *simulation);
MESOFIT_API const double *mesofit_simulation_positions(const struct mesofit_simulation *simulation,
                                                       int axis); /**< [lambda] */
MESOFIT_API const double *mesofit_simulation_velocities(const struct mesofit_simulation *simulation,
                                                        int axis); /**< [lambda/tau] */

/** Kinetic temperature now [T_0]: m <v^2> relative to the centre of mass; NaN
 *  for dynamics without velocities. */
MESOFIT_API double mesofit_simulation_temperature(const struct mesofit_simulation *simulation);

/** How to measure g(r). Begin with mesofit_rdf_plan_default. */
struct mesofit_rdf_plan {
    double range; /**< of g(r), at most half the box; 0: the cutoff of the forces [lambda] */
    size_t bins;
    size_t samples;
    uint64_t every; /**< steps between samples */
};

/** 100 bins up to the cutoff, 200 samples, one every 25 steps. */
MESOFIT_API struct mesofit_rdf_plan mesofit_rdf_plan_default(void);

/** Run samples * every steps and measure the radial distribution function
 *    g(r_k) = 2 V <S_k> / (N (N - 1) v_k),  S_k pairs in bin k, v_k the volume of its shell.
 *  @param[out] r, g, error  shape [bins]: centres, g, its standard error from 20 blocks; `error`
 *                           may be NULL
 *  Fails: as mesofit_simulation_run; BAD_INPUT if the range exceeds half the box.
 */
MESOFIT_API enum mesofit_status mesofit_simulation_rdf(struct mesofit_simulation *simulation,
                                                       const struct mesofit_rdf_plan *plan,
                                                       double *r, double *g, double *error);

/** Means of a run, with standard errors that see correlation. */
struct mesofit_means {
    double temperature, temperature_error; /**< kinetic [T_0]; NaN without velocities */
    double energy, energy_error;           /**< potential energy of a particle [k_B T_0] */
    double pressure, pressure_error;       /**< [k_B T_0/lambda^d] */
};

/** Run samples * every steps and average. Fails: as mesofit_simulation_run. */
MESOFIT_API enum mesofit_status mesofit_simulation_means(struct mesofit_simulation *simulation,
                                                         size_t samples, uint64_t every,
                                                         struct mesofit_means *means);

#endif
