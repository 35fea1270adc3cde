// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A run file of `mesofit fit`: target, scene, method.
#pragma once

#include "observe/bonded_distribution.h"
#include "problem/verify.h"
#include "scene/heading.h"
#include "scene/run_options.h"
#include "scene/scene.h"
#include "targets/target_files.h"

/// Numbers of the object "core".
struct fit_core {
    double threshold, stiffness;
};

extern const struct field mf_fit_core_fields[];

/// What "unknowns" says of one of them.
struct fit_unknown {
    bool wanted;
    const struct field *fields;           ///< of `said`
    struct unknown_parameters said;       ///< by the file, the family of friction, or chosen
    uint64_t given;                       ///< which fields that are (mf_fields_bit)
    struct unknown_parameters parameters; ///< what follows from it
    struct scene_law start;               ///< without a curve: as mf_unknowns_start says
    struct scene_law truth;               ///< the true curves where they are known
    double *base;                         ///< of struct unknown
};

static inline bool fit_unknown_says(const struct fit_unknown *unknown, const char *key) {
    return unknown->given & mf_fields_bit(unknown->fields, key);
}

/// What the program chose because the file did not say it, a line each with its reason.
enum { FIT_MAX_CHOICES = 20, FIT_CHOICE_SIZE = 256 };
struct fit_choices {
    size_t count;
    char line[FIT_MAX_CHOICES][FIT_CHOICE_SIZE];
    char doubt[FIT_CHOICE_SIZE]; ///< of what the file says; "": none
    bool thermostat; ///< the friction is chosen, and does no more than hold the temperature
};

/// Bonds and angles whose distribution is so narrow that it is a constraint, or stands in so few
/// rows that it shows nothing but a width: a fit takes a harmonic law for them instead of looking
/// for one. The law is as wide as the target, but not narrower than what a time step can follow
/// (mf_bonded_distribution_narrow). As a constraint is not met to its width, its target is left
/// out.
enum { FIT_MAX_CONSTRAINTS = 2 * MOLECULES_MAX_GROUPS };

struct fit_constraint {
    int order;
    char name[TOPOLOGY_NAME_SIZE];
    struct bonded_moments moments;
    double deviation; ///< of the law
    double k;         ///< [k_B T_0/λ²] or [k_B T_0/rad²]
};

struct fit_constraints {
    size_t count;
    struct fit_constraint of[FIT_MAX_CONSTRAINTS];
};

enum { FIT_STATE_NAME_SIZE = 64 };

/// Owns everything that the problem borrows.
struct fit_file {
    char name[FIT_STATE_NAME_SIZE]; ///< of a state; "" if there is but one
    size_t others;                  ///< states beside this, the first
    struct fit_file *other;         ///< shape [others], each whole but for its own others
    const struct inverse_problem *problems[INVERSE_MAX_STATES]; ///< of all states
    struct heading heading;
    int friction; ///< enum fit_friction
    struct fit_choices choices;
    struct fit_constraints constraints; ///< that the laws of the scene have come from
    struct target_files files;
    struct scene scene;
    const struct integrator *integrator; ///< that was chosen for the scene; or NULL
    int64_t inner_steps;                 ///< that were chosen for it; or 0
    bool says_unknowns;                  ///< the file does
    struct fit_unknown unknown[UNKNOWNS];
    struct bonded_shape shape[BONDED_KINDS][MOLECULES_MAX_GROUPS]; ///< of groups to be found
    struct inverse_number number[INVERSE_MAX_NUMBERS];             ///< that are to be found
    size_t numbers;
    struct fit_core core;
    uint64_t core_given;           ///< which fields the file says
    struct engine_settings engine; ///< who samples
    const struct inverse_method *method;
    void *method_parameters;   ///< of the method, or of mf_automatic, if the file says some alone
    uint64_t parameters_given; ///< which ones, then: the method is chosen beside them
    struct verify_parameters verification;
    uint64_t verification_given;
    struct inverse_problem problem;
    struct input_files inputs;
};

/// Read a run file and those that it names, each for itself. Must be cleared, also after a failure.
/// Fails: BAD_INPUT with all faults; IO; NO_MEMORY. Tested: tests/fuzz.
enum status mf_fit_file_parse(struct fit_file *fit, const char *file,
                              const struct run_options *options) MUST_USE;

/// Check how the parts of one state fit together, by beginning a simulation; `file` is named in
/// messages. Fails: BAD_INPUT; NO_MEMORY. Tested: test_bad_targets, test_fit_numbers.
enum status mf_fit_check(const struct fit_file *fit, const char *file) MUST_USE;

/// Check all that was read, and find the bases of unknowns. Fails: BAD_INPUT, NO_MEMORY.
enum status mf_fit_file_check(struct fit_file *fit, const char *file) MUST_USE;

/// Read a run file and check it. Must be cleared, also after a failure. Fails: BAD_INPUT with all
/// faults; IO; NO_MEMORY.
enum status mf_fit_file_read(struct fit_file *fit, const char *file,
                             const struct run_options *options) MUST_USE;
void mf_fit_file_clear(struct fit_file *fit);

/// Write all values, defaults filled in, so that running what is written gives the same bits.
void mf_fit_file_write(const struct fit_file *fit, struct json_writer *writer);

/// Add what used.json only names to the digest of a checkpoint: targets, tables, curves to begin
/// with.
void mf_fit_file_digest(const struct fit_file *fit, uint64_t *digest);
