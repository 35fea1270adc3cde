/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file A fit: from measured observables back to the potential Phi(r) and the friction weight
 *  omega(r).
 *
 * Several fits may live in one process, each used by one thread at a time.
 */
#ifndef MESOFIT_FIT_H
#define MESOFIT_FIT_H

#include "mesofit/simulation.h"

struct mesofit_fit;

/** Where a fit is. */
struct mesofit_fit_state {
    uint32_t iteration;    /**< iterations so far */
    uint64_t simulations;  /**< so far */
    uint64_t engine_steps; /**< time steps or Monte Carlo sweeps so far */
    double error;          /**< rms distance from the target of the best so far */
    double noise;          /**< what statistics alone would make of it */
    int finished;          /**< there is nothing left to do */
    int converged;         /**< by its own measure it can do no better */
    const char *reason;    /**< why it finished without having converged, or "" */
};

/** Told now and then inside an iteration, `done` of `total` parts; not 0: stop as soon as possible,
 *  with INTERRUPTED. Called by one thread at a time. */
typedef int mesofit_fit_progress(void *context, uint32_t iteration, uint64_t done, uint64_t total);

/** What defines a fit of one type of beads. Begin with mesofit_fit_options_default. */
struct mesofit_fit_options {
    struct mesofit_scene scene; /**< without the law that is looked for */
    const char *method;         /**< as `mesofit describe` lists them: "imc", "gauss-newton", ... */
    const char *settings; /**< of the method, a JSON object such as {"replicas": 8}; or NULL */

    /** The measured g(r), best in equal bins from 0 on or from where it begins; at any other
        growing r it is read at equal ones. Errors may be NULL. */
    struct {
        size_t count;
        const double *r, *g, *error; /**< shape [count]; r in the middle of the bins [lambda] */
    } rdf;

    /** The measured escape time distribution E(t, r_0); times = 0: none. Errors may be NULL. */
    struct {
        size_t times, bins;
        double interval; /**< between times, from 0 on [tau] */
        double r_minimum,
            r_maximum; /**< of the bins of r_0, and where a pair has escaped [lambda] */
        const double *survival, *error; /**< shape [times, bins] */
    } etd;

    int find_potential, find_friction; /**< which laws are looked for */
    const char *potential; /**< how Phi is written, the object "potential" of "unknowns";
                                or NULL */
    const char *friction;  /**< the same of omega */

    mesofit_fit_progress *progress; /**< or NULL */
    void *context;
};

/** Inverse Monte Carlo for the potential, in the scene of mesofit_scene_default. */
MESOFIT_API struct mesofit_fit_options mesofit_fit_options_default(void);

/** Check everything, find the target's normalisation and begin. NULL on failure: BAD_INPUT,
 *  NO_MEMORY. */
MESOFIT_API struct mesofit_fit *mesofit_fit_create(const struct mesofit_fit_options *options);

/** The same from the text of a run file (JSON), in which files may be tables in memory; of one
 * state: several are fitted by mesofit_run_words (mesofit/run.h). */
MESOFIT_API struct mesofit_fit *mesofit_fit_parse(const char *text,
                                                  const struct mesofit_table *tables,
                                                  size_t table_count, int threads,
                                                  mesofit_fit_progress *progress, void *context);

/** The same from a run file. Fails also with IO. */
MESOFIT_API struct mesofit_fit *mesofit_fit_open(const char *file, int threads,
                                                 mesofit_fit_progress *progress, void *context);

MESOFIT_API void mesofit_fit_free(struct mesofit_fit *fit);

/** One iteration; call it until state->finished. `state` may be NULL. Fails: INTERRUPTED,
 *  NO_MEMORY, BAD_INPUT; the fit is then only good to be freed. */
MESOFIT_API enum mesofit_status mesofit_fit_iterate(struct mesofit_fit *fit,
                                                    struct mesofit_fit_state *state);

enum mesofit_law_kind { MESOFIT_POTENTIAL, MESOFIT_FRICTION };

/** A curve that was found, on the fit's own points. */
struct mesofit_curve {
    size_t count;        /**< 0: not looked for, or no iteration yet */
    const double *r;     /**< [lambda] */
    const double *value; /**< [k_B T_0] or [sqrt(mu/tau)] */
    const double *error; /**< standard errors; NaN: not known */
};

/** The best so far; its arrays belong to the fit and change with the next iteration. Of a mixture
 *  the potentials of all pair types follow each other. */
MESOFIT_API struct mesofit_curve mesofit_fit_curve(const struct mesofit_fit *fit,
                                                   enum mesofit_law_kind kind);

/** What independent simulations say of the best so far. NaN: not measured. */
struct mesofit_verification {
    double rdf_rms, rdf_rms_error; /**< distance of g(r) from the target */
    double rdf_noise;              /**< what statistics alone would make of it */
    double etd_rms, etd_noise;     /**< the same of E(t, r_0) */
    double temperature, pressure, pressure_error;
};

/** Simulate the best so far with new seeds. Fails: as mesofit_simulation_run; BAD_INPUT before the
 *  first iteration. */
MESOFIT_API enum mesofit_status mesofit_fit_verify(struct mesofit_fit *fit,
                                                   struct mesofit_verification *verification);

/** @name For an optimiser of the caller's own
 *  Methods that search ("genetic", "cma-es", "nlopt", "gauss-newton", "pareto") write the unknown
 *  laws by coefficients from 0 to 1. The caller asks for the error of any of them.
 */

/** Coefficients of the laws and of the numbers of the scene that are to be found, one after the
 *  other; 0 of a method that does not search. */
MESOFIT_API size_t mesofit_fit_coefficients(const struct mesofit_fit *fit);

/** Those that the fit begins with, shape [coefficients]. Fails: BAD_INPUT if the method does not
 *  search; NO_MEMORY. */
MESOFIT_API enum mesofit_status mesofit_fit_start(const struct mesofit_fit *fit,
                                                  double *coefficients);

/** Simulate one candidate as the method would.
 *  @param seed       of the simulation: the same seed gives the same noise
 *  @param[out] error, variance  rms distance from the target and its variance by noise; infinite
 *                    where the simulation failed; `variance` may be NULL
 *  Fails: BAD_INPUT if the method does not search; INTERRUPTED; NO_MEMORY. */
MESOFIT_API enum mesofit_status mesofit_fit_evaluate(const struct mesofit_fit *fit,
                                                     const double *coefficients, uint64_t seed,
                                                     double *error, double *variance);

#endif
