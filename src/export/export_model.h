// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a finished fit or simulation found, as another engine needs it.
///
/// All numbers are reduced (k_B T_0, λ, μ, τ); a writer multiplies them with the units of its
/// engine.
#pragma once

#include "scene/scene.h"
#include "io/output.h"
#include "problem/numbers.h"

/// Φ, and Φ less and plus one standard error.
enum export_curve { EXPORT_FITTED, EXPORT_LOWER, EXPORT_UPPER, EXPORT_CURVES };

/// A number of summary.json with its standard error; NAN where it does not say.
struct export_number {
    double value, error;
};

/// Owns everything.
struct export_model {
    char folder[OUTPUT_PATH_SIZE], title[FIELD_TEXT_SIZE];
    struct scene scene;
    struct numbers_own own;
    struct simulation_setup setup;         ///< of the scene, with what was fitted in its place
    struct table potential[EXPORT_CURVES]; ///< of a fitted potential
    bool bands;                            ///< the last two of them are known
    /// Of fitted friction along pairs, across them and with memory.
    struct table omega, across, memory[PAIR_MEMORY_MAX_MODES];
    const struct table *own_omega;     ///< all friction of the result: that of the setup is
    struct pair_memory_law own_memory; ///< what other engines could have (export_columns.h)
    const struct molecules *molecules; ///< of the scene, or NULL
    bool fit;                          ///< the folder is of a fit, not of a simulation
    bool remembers;                    ///< friction has memory: all of it is left out
    bool partial;    ///< the engine of the fit may have known forces beside the potential
    bool thermostat; ///< omega was chosen to hold the temperature, and is no result
    int types;       ///< at least 1
    char name[COMPOSITION_MAX_TYPES][COMPOSITION_NAME_SIZE];
    double mass[COMPOSITION_MAX_TYPES]; ///< [μ]
    size_t count;
    double *position[3], *velocity[3]; ///< shape [count], by id: in the box [λ], [λ/τ]
    int *image[3];     ///< shape [count], by id: boxes away, so that no bond crosses a wall
    bool equilibrated; ///< they are where the result's own simulation ended
    double densest[MANY_BODY_MAX_TERMS]; ///< largest ρ of a central bead there, of each term
    size_t rdf_bins;                     ///< of g(r), equally wide from 0 on
    double rdf_range;                    ///< where they end [λ]
    struct export_number temperature, pressure; ///< of the result
    double density; ///< that came out at constant pressure [1/λ^d]; NaN: the box is the scene's
    struct export_number compressibility; ///< ρ k_B T κ_T of it, likewise
    struct export_number diffusion;       ///< D of it, if it was measured
    struct export_number configurational; ///< its configurational temperature
    double verified_step;                 ///< time step of the verification; or NAN [τ]
    char warning[256]; ///< what a person should know of the result; "" if nothing
};

/// Read the folder of a finished fit or simulation.
/// Fails: IO; BAD_INPUT with one line for a folder that is none, has no potential, or whose scene
/// is of what forces of pairs, molecules and local densities and velocities do not express: hard
/// particles, a solvent, other forces beside the pairs, dynamics without velocities, masses that
/// differ within a type; NO_MEMORY. Tested: test_export_model.
enum status mf_export_model_read(struct export_model *model, const char *folder) MUST_USE;
void mf_export_model_clear(struct export_model *model);

/// Whether friction is a part of the result: fitted, or the scene's own.
static inline bool export_model_has_friction(const struct export_model *model) {
    return (model->own_omega && !model->thermostat) || pair_memory_acts(&model->own_memory);
}

/// ω across pairs, which some engines have, or NULL.
static inline const struct table *export_model_across(const struct export_model *model) {
    return model->setup.memory.transverse;
}

/// Pair types, at least 1, and Φ or ω of one of them.
int mf_export_model_pairs(const struct export_model *model);
const struct table *mf_export_model_potential(const struct export_model *model,
                                              enum export_curve curve);

/// "A-B", and the types of it.
void mf_export_model_pair(const struct export_model *model, int pair, int type[2],
                          char name[COMPOSITION_PAIR_NAME_SIZE]);

/// Largest cutoff of Φ, ω and the weights of local densities [λ].
double mf_export_model_cutoff(const struct export_model *model);
