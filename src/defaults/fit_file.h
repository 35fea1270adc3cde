// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A run file of `mesofit fit`: target, scene, method.
#pragma once

#include "problem/verify.h"
#include "defaults/fit_constraints.h"
#include "defaults/fit_numbers.h"
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
    bool says_unknowns;                  ///< the file does
    struct fit_unknown unknown[UNKNOWNS];
    struct bonded_shape shape[BONDED_KINDS][MOLECULES_MAX_GROUPS]; ///< of groups to be found
    struct inverse_number number[INVERSE_MAX_NUMBERS];             ///< that are to be found
    size_t numbers;
    struct fit_core core;
    uint64_t core_given; ///< which fields the file says
    const struct inverse_method *method;
    void *method_parameters;
    struct verify_parameters verification;
    uint64_t verification_given;
    struct inverse_problem problem;
    struct input_files inputs;
};

/// Read a run file and those that it names, each for itself. Fails: BAD_INPUT with all faults; IO;
/// NO_MEMORY. Tested: tests/fuzz.
enum status mf_fit_file_parse(struct fit_file *fit, const char *file,
                              const struct run_options *options) MUST_USE;

/// Read a run file and check it. Fails: BAD_INPUT with all faults; IO; NO_MEMORY.
enum status mf_fit_file_read(struct fit_file *fit, const char *file,
                             const struct run_options *options) MUST_USE;
void mf_fit_file_clear(struct fit_file *fit);

/// Write all values, defaults filled in, so that running what is written gives the same bits.
void mf_fit_file_write(const struct fit_file *fit, struct json_writer *writer);

/// Add what used.json only names to the digest of a checkpoint: targets, tables, curves to begin
/// with.
void mf_fit_file_digest(const struct fit_file *fit, uint64_t *digest);
