// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The record of an observable, and their list: whatever is measured of configurations, those
/// of a simulation or, if places are enough, of a trajectory.
///
/// Scene files, restarts, tables, summaries, `--explain`, `mesofit describe` and figures know an
/// observable by its record alone. What a record does not need is left out (NULL): the least is a
/// name, a summary, fields, `begin`, `clear`, `sample`, `spans` and `stage`; clusters.c is an
/// example of one file. Tested: test_observable, test_structure_factor.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "io/data_table.h"
#include "io/json_write.h"
#include "io/output.h"
#include "io/units.h"
#include "observe/configuration.h"
#include "observe/stages.h"

struct measure_plan;
struct observable_use;

/// The script that draws x, values and errors of the first file, and a target of that name.
#define OBSERVABLE_FIGURE_OF_CURVE "curve"
/// The script that draws all columns of the first file but errors, and what ends with _boltzmann.
#define OBSERVABLE_FIGURE_OF_GROUPS "groups"

/// Observables in the list, targets of all of them, and spans of one, at most. What is more is
/// found when the list is compiled and by test_observable; a target beyond them is not known to run
/// files.
enum { OBSERVABLES_MAX = 32, OBSERVABLE_TARGETS = 32, OBSERVABLE_MAX_SPANS = 160 };

/// Where and of what results are written.
struct observable_results {
    const struct simulation_setup *setup;
    const struct measure_plan *plan;
    const struct units *units;
    const char *folder;
    const struct observable_use
        *use; ///< all that was measured, as mf_measure_sample has it, or NULL
};

/// How a target is given in a run file.
enum observable_form {
    OBSERVABLE_NUMBER,        ///< by a value and its error
    OBSERVABLE_CURVE,         ///< by a table of x, values, errors
    OBSERVABLE_CURVE_OF_TIME, ///< the same at equal times from 0 on, of whole time steps
    OBSERVABLE_OWN_FORM,      ///< by a record of its own (targets/target_files.h)
};

/// What an observable supplies as a target of fits.
struct observable_target {
    const char *name;    ///< in run files and tables; NULL ends a list
    const char *summary; ///< for `mesofit describe`
    enum observable_form form;
    const char *argument, *unit; ///< of a curve: "q[1/lambda]", "1"; of a number the unit alone
    bool has_settings; ///< the observable's, in its object of a run file, beside the values
};

/// The values of one target over replicas, and their standard errors.
struct observable_values {
    size_t count;    ///< 0: not asked for
    const double *x; ///< shape [count]: where a curve is to be evaluated, as the target has it
    double *value, *error; ///< shape [count], zeroed; NaN: not measured
    double *freedom;       ///< degrees of freedom of the errors, at most, or NULL: nobody asks
};

struct observable {
    const char *name;    ///< of its object in a scene file
    const char *summary; ///< for `mesofit describe`
    bool always;         ///< measured by `mesofit simulate` even if the scene does not name it
    bool of_time;        ///< follows particles through time, or is about velocities
    bool of_solvent;     ///< of an integrator's own particles: the scene may have none
    bool of_places;      ///< asks for nothing that a trajectory has not (observe/configuration.h)

    const struct field *fields; ///< of the settings
    size_t settings_size, state_size;

    /// Prepare a zeroed state for the samples of a plan; without a number of samples for as many as
    /// there will be. Fails: BAD_INPUT, NO_MEMORY; the state is then cleared as after a success.
    enum status (*begin)(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan);
    void (*clear)(void *state);

    /// Told where its files go, once before the first sample and after a restart, if it writes them
    /// while it measures. What `results` points to lives as long as the state.
    void (*open)(void *state, const struct observable_results *results);

    bool sums; ///< its samples want energy and virial of the force pass
    /// What the force pass of a sampled step is to count, or NULL if it cannot; `counted` then
    /// stands for `sample`. One observable at a time is served so, the others sample.
    const struct pair_histogram *(*histogram)(void *state);
    enum status (*counted)(void *state, const struct configuration *configuration);
    /// What all steps from the first sample on are to add their momentum transfer to, or NULL if it
    /// wants none. One observable is served so.
    struct transfer *(*transfer)(void *state);
    /// The step of its next sample, INT64_MAX after the last. Without it samples are the plan's.
    int64_t (*due)(const void *state);
    /// Add the present configuration, with the forces of its step. Fails: NO_MEMORY.
    enum status (*sample)(void *state, const struct configuration *configuration);

    /// What goes with a checkpoint, at most OBSERVABLE_MAX_SPANS; returns their number.
    size_t (*spans)(void *state, struct memory_span *spans);
    /// If lengths of the spans depend on the state, as those of a sample_series: makes room, after
    /// the first span alone was restored and before the others are.
    enum status (*reserve)(void *state);

    /// Write its tables. Fails: IO, NO_MEMORY.
    enum status (*write)(const void *state, const struct observable_results *results);
    /// Add its numbers to summary.json.
    void (*write_summary)(const void *state, const struct observable_results *results,
                          struct json_writer *writer);
    /// A line for the person.
    void (*print)(const void *state, const struct observable_results *results, char *line,
                  size_t size);
    /// Whether its results can be trusted; the message is a warning if not. UNSTABLE: nothing of
    /// the simulation can, and it is not ok.
    enum status (*assess)(const void *state, const struct simulation_setup *setup);

    /// Its stages of `--explain`, `every` being the steps between the plan's samples.
    void (*explain)(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages);
    const char *stage; ///< what `--explain` calls it if it is not measured

    const char *const *files; ///< that `write` makes, NULL-terminated; * for names of types
    const char *figure;       ///< script in plots/ that draws its files, or that of any curve

    const struct observable_target *targets; ///< that it supplies, or NULL
    /// Values of those, shape [targets], from one replica, and on how many blocks of time their
    /// errors rest; mf_pooled_result joins replicas. Fails: NO_MEMORY.
    enum status (*result)(const void *state, const struct observable_values *values,
                          double *blocks);
    /// In its place: values from the sums of `count` replicas together. Fails: NO_MEMORY.
    enum status (*result_of_all)(const void *const *states, size_t count,
                                 const struct observable_values *values);
};

/// All observables, NULL-terminated.
extern const struct observable *const mf_observables[];

/// An observable of a simulation; a list of them ends with one of which `observable` is NULL.
struct observable_use {
    const struct observable *observable;
    void *state, *settings;
};

/// Make the state of an observable and begin; a failure leaves it to be ended, too. Fails: as
/// begin; BAD_INPUT for a trajectory where the observable asks for more than places.
enum status mf_observable_begin(struct observable_use *use,
                                const struct configuration *configuration,
                                const struct measure_plan *plan) MUST_USE;

/// Clear the state and free it, if there is one. The settings stay.
void mf_observable_end(struct observable_use *use);

/// A target, by its number below OBSERVABLE_TARGETS among those of the whole list.
struct observable_kind {
    const struct observable *observable; ///< NULL: there are not so many
    const struct observable_target *target;
    size_t place;  ///< of the observable in the list
    size_t number; ///< of the target among those of the observable
};
struct observable_kind mf_observable_kind(int kind);

/// Path of a table in the folder of the results, into OUTPUT_PATH_SIZE bytes.
void mf_observable_file(const struct observable_results *results, const char *name, char *path);

/// Write a table of that name, in the units of the results. Fails: IO, NO_MEMORY.
enum status mf_observable_table(const struct observable_results *results, const char *name,
                                const struct data_column *columns, size_t count,
                                size_t rows) MUST_USE;

extern const struct observable mf_rdf_observable, mf_etd_observable, mf_motion_observable;
extern const struct observable mf_thermodynamics_observable, mf_force_covariance_observable;
extern const struct observable mf_molecule_sizes;
