// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Another engine that runs what was found: its record, and the folder that is written for
/// it.
///
/// To add one, write a file with its record and put its name into EXPORT_ENGINES below.
#pragma once

#include "export/export_bonded.h"
#include "export/export_density.h"
#include "export/export_dynamics.h"
#include "export/export_grid.h"
#include "export/export_projection.h"
#include "export/export_units.h"
#include "report/progress.h"

#include <stdio.h>

struct export_engine;

/// What a writer writes of.
struct export_job {
    const struct export_engine *engine;
    const struct export_model *model;
    const char *folder;
    struct export_units units;
    struct export_grids grids;
    struct export_power power[COMPOSITION_MAX_PAIRS];  ///< of ω, if there is one
    struct export_power across[COMPOSITION_MAX_PAIRS]; ///< of ω across pairs, likewise
    double worst_misfit;                               ///< of all of them
    bool projected;                                    ///< the power laws stand for ω
    enum export_motion runs;                           ///< what the engine does of its own
    enum export_here here;                             ///< whether this machine's has the friction
    bool measured;                                     ///< what stands for ω was simulated:
    struct export_projection projection;               ///< what it costs,
    char unmeasured[256];                              ///< or why it was not; ""
    double time_step;                                  ///< for this engine [τ]
    const char *why_step;                              ///< is as long
    struct export_bonded bonded;                       ///< tables of laws that it has not
    struct export_densities densities;                 ///< tables of "many_body"
    int exclude; ///< of all molecules, for engines that have one number for all
};

enum { EXPORT_PAIR_NAME_SIZE = 2 * COMPOSITION_NAME_SIZE + 8 };

struct export_engine {
    const char *name;
    const char *title;   ///< as its authors write it
    const char *summary; ///< what is written, one line
    enum export_system system;
    bool physical; ///< knows no reduced units: these are then nm, kJ/mol and u
    const struct export_interpolation *interpolation;
    /// Whether it has a law as it is, so that no table is wanted; with `molecules`.
    bool (*has_law)(const struct bonded_curve *curve);
    enum export_friction friction;
    bool across;               ///< has it across pairs, too
    const char *friction_name; ///< what it calls that, but for EXPORT_POWER; NULL: none
    const char *bath; ///< what it calls its Langevin bath; NULL: nothing that moves is written
    /// Whether the program on this machine has the style of the friction, which it runs of its own
    /// only then. NULL: not asked.
    enum export_here (*ask)(const struct export_job *job);
    /// Lines of the block: how the friction can be had. NULL: none.
    void (*advise)(const struct export_job *job, const char *prefix, FILE *stream);
    const char *commands; ///< that run the folder, a line each
    /// Those of a job, or NULL: `commands`.
    const char *(*commands_of)(const struct export_job *job);
    const char *versions; ///< of the engine that run the folder, said first; NULL: any
    const char *verified; ///< whether such folders were run: a sentence of the README
    int max_types;        ///< that it is written for
    bool one_cutoff;      ///< all its tables end at the same distance
    /// What it calls a pair of types, if not A-B: no two may have one name.
    void (*pair_name)(const char *a, const char *b, char name[EXPORT_PAIR_NAME_SIZE]);
    bool flat;                                    ///< also in two dimensions
    bool molecules;                               ///< bonds, angles and dihedrals are written, too
    bool many_body;                               ///< energies of local densities, likewise
    enum status (*check)(struct export_job *job); ///< before anything is written; NULL: nothing
    enum status (*tables)(const struct export_job *job); ///< write those of pairs alone
    enum status (*write)(const struct export_job *job);
    /// What a person should know of the thermostat, for the README.
    void (*explain)(const struct export_job *job, FILE *stream);
};

/// All engines, in the order in which they are listed.
#define EXPORT_ENGINES(EACH)                                                                       \
    EACH(mf_export_lammps)                                                                         \
    EACH(mf_export_hoomd)                                                                          \
    EACH(mf_export_espresso)                                                                       \
    EACH(mf_export_openmm)                                                                         \
    EACH(mf_export_gromacs)                                                                        \
    EACH(mf_export_dl_poly)                                                                        \
    EACH(mf_export_votca)

#define EXPORT_DECLARE(record) extern const struct export_engine record;
EXPORT_ENGINES(EXPORT_DECLARE)
#undef EXPORT_DECLARE

/// What is to be exported, and how.
struct export_request {
    const char *from, *engine;
    const char *to; ///< folder; NULL: called as the engine
    bool bands;     ///< Φ less and plus one standard error, too
    bool dynamics;  ///< what moves otherwise there is measured
    bool project;   ///< the nearest power law of the engine stands for ω, and its cost is measured
    bool force;     ///< replace also files of an earlier export that were changed since
    int threads;    ///< of that measurement
    const struct measure_listener *listener; ///< of its progress; NULL: none
    const atomic_bool *stop;                 ///< ends it, or NULL
    struct progress *progress;               ///< to which is said what was written
};

/// Write the folder for an engine of a result, and say what was written.
/// Fails: BAD_INPUT for an engine or a result that is none, interactions that the engine does not
/// express, no friction to project, and a folder `to` that holds a result, files of others alone,
/// or an export that was changed since; IO; NO_MEMORY; with `project` as mf_export_project. Nothing
/// is written before all was read and checked. Tested: cli/test_export.
enum status mf_export_run(const struct export_request *request) MUST_USE;

/// The engine of a name. Fails: BAD_INPUT with the names that there are.
enum status mf_export_find(const char *name, const struct export_engine **engine) MUST_USE;

/// @name For the engines
/// Write a file of the folder, whole or not at all. Fails: IO.
typedef void export_print(const struct export_job *job, FILE *stream);
enum status mf_export_file(const struct export_job *job, const char *name,
                           export_print *print) MUST_USE;

/// The ending of the names of a curve's tables: "", "_lower" or "_upper".
const char *mf_export_curve_name(enum export_curve curve);

/// Whether the engine's law is the friction's within EXPORT_POWER_BOUND for all pairs, or projected
/// onto it, along pairs and, if it is there, across them; and whether all exponents are 1.
bool mf_export_is_power(const struct export_job *job);
bool mf_export_is_linear(const struct export_job *job);

/// Time in which the friction of its neighbours slows a particle down [τ]; a hundred steps without
/// friction. For thermostats that keep g(r) and not the motion.
double mf_export_slowing(const struct export_job *job);

/// The step of the result, shortened if its configurational temperature, which is off as Δt²,
/// shows that it is long: by what is beyond two errors, as the rest may be chance; and as bonds ask
/// for [τ].
/// @param[out] why  it is as long, for the README
double mf_export_safe_step(const struct export_model *model, const char **why);

/// A coordinate in the box, [0, length).
double mf_export_place(const struct export_model *model, int axis, size_t particle);

/// The type of a particle, from 0 on.
int mf_export_type(const struct export_model *model, size_t particle);

/// Particles of a type.
size_t mf_export_count(const struct export_model *model, int type);
