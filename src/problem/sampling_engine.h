// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Another program that samples the potentials of an inversion: what it is asked for, and
/// what it gives back.
///
/// An inversion needs of its samples only that they are configurations of the canonical ensemble of
/// the potentials sought plus everything else that the other program knows: A. P. Lyubartsev and A.
/// Laaksonen, Phys. Rev. E 52, 3730 (1995), eq. 6, holds whatever the rest is. Each replica asks
/// for its samples piece by piece (inversion/sampler_engine.c); who answers stands above, in the
/// room engines.
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "dynamics/integrator.h"
#include "system/box_vectors.h"
#include "system/composition.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct inverse_problem;
struct molecules;
struct table;

/// Who samples: "engine" of a run file.
enum engine_kind { ENGINE_NONE, ENGINE_LAMMPS, ENGINE_COMMAND };

struct engine_settings {
    int kind;                     ///< enum engine_kind
    char input[FIELD_TEXT_SIZE];  ///< of LAMMPS, as its user has written it; "": one is written
    char frames[FIELD_TEXT_SIZE]; ///< trajectory that a command leaves
    int tables;                   ///< in whose form a command has them, too:
                                  ///< mf_sampling_engine_tables; 0: nobody's
    double time_step;             ///< of an input that is written; 0: that of the scene [τ]
    int64_t steps;                ///< time steps of what counts as a sweep
    int64_t at_once;              ///< pieces that run side by side; 0: as many as threads
    int64_t keep;                 ///< pieces of each replica whose files stay
    char type[COMPOSITION_MAX_TYPES][COMPOSITION_NAME_SIZE]; ///< what it calls each type; "": as we
};

extern const struct field mf_sampling_engine_fields[]; ///< of struct engine_settings
extern const char *const mf_sampling_engine_kinds[];   ///< in the order of enum engine_kind
extern const char *const mf_sampling_engine_tables[];  ///< "none", then engines of `export`

/// What a replica asks for: frames of the canonical ensemble. Borrowed.
struct engine_piece {
    size_t replica;
    uint64_t number; ///< of the pieces of this replica, from 1 on; 0: of the verification
    bool fresh;      ///< from the beginning, else from where the piece before ended
    uint64_t seed;
    double temperature;                ///< [T_0]
    const struct table *potential;     ///< of the pairs
    const struct molecules *molecules; ///< with their laws; NULL: single beads
    uint64_t lead;                     ///< sweeps before the first frame
    uint64_t frames, every;            ///< how many, and sweeps between them
};

/// What is known of a frame besides its positions; NAN: it is not.
struct engine_sample {
    double temperature; ///< kinetic [T_0]
    double pressure;    ///< of everything [k_B T_0/λ^d]
    double energy;      ///< of what `whole_energy` says [k_B T_0]
    struct box box;     ///< of the frame; at constant volume that of the scene; of a tilted one the
                        ///< diagonal of its vectors, of which positions are parts then
    bool tilted;
    struct box_vectors vectors; ///< of a tilted one
};

/// Functions are called by several threads, each with pieces of its own.
struct sampling_engine {
    void *context;
    int64_t steps;     ///< time steps of a sweep
    int at_once;       ///< 0: as many as threads
    bool whole_energy; ///< its energies are of pairs and molecules; else of the pairs alone
    /// Of an engine that somebody else runs: prepare a piece, before any of those that are asked
    /// for side by side is waited for. NULL: `begin` does so.
    enum status (*announce)(void *context, const struct engine_piece *piece);
    /// Make the frames of a piece. Fails: IO with what the program said; INTERRUPTED, also while
    /// it waits for who runs it; BAD_INPUT for
    /// frames that are not those of the scene; UNSTABLE; NO_MEMORY.
    enum status (*begin)(void *context, const struct engine_piece *piece, void **frames);
    /// The next frame. @param[out] position  shape [dimensions][particles], by id [λ]
    enum status (*next)(void *frames, double *const position[3], struct engine_sample *sample);
    void (*end)(void *frames); ///< of NULL: nothing
};

/// Frames of another engine as a simulation, of which a step takes the next frame: what observes
/// simulations then observes those. The parameters of the integrator say whose frames they are.
struct engine_replay {
    const struct sampling_engine *engine;
    struct engine_piece piece;
};

/// Temperature and pressure are those that the engine tells. Tested: cli/test_fit_engine.
extern const struct integrator mf_sampling_engine_replay;
