// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is known while the program chooses what a run file leaves out
/// (defaults/fit_defaults.h), and how it puts a choice into the document.
///
/// Paths are of objects, "scene.particles"; what a file has at a path and key is never replaced.
#pragma once

#include "defaults/fit_file.h"
#include "defaults/fit_scales.h"

/// Filled in from choice to choice, in their order.
struct fit_choice {
    const struct fit_file *read, *leader;
    struct json_object *root;
    struct fit_choices *choices;
    const struct fit_scales_rdf *rdf;
    struct fit_scales scales;
    int dimensions;
    double density;
    double mass;          ///< the least of any bead
    double crossing;      ///< time in which a bead flies, or diffuses, as far as its neighbours
                          ///< are [τ]
    double range;         ///< of g(r) as it will be used [λ]
    size_t joined;        ///< bins of `read` that make one of `rdf`
    double count;         ///< beads of a simulation
    double time_step;     ///< [τ]
    double precision;     ///< of the method, of g
    bool finds[UNKNOWNS]; ///< what is looked for
};

/// Keep a line for the person who reads what was chosen.
void mf_fit_choice_note(const struct fit_choice *choice, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// "0.334 nm": a number of a reduced unit in the units of the file, "2.15 lambda" in a reduced one.
/// Returns `text`.
enum { FIT_CHOICE_TEXT_SIZE = 160 };
const char *mf_fit_choice_text(const struct fit_choice *choice, const char *unit, double value,
                               char text[FIT_CHOICE_TEXT_SIZE]);

/// Whether the file does not say a key; the object at a path, without the reader learning of
/// either.
bool mf_fit_choice_lacks(const struct json_object *root, const char *path, const char *key);
struct json_object mf_fit_choice_object(const struct json_object *root, const char *path);

/// Put in a text; a number without a unit; a number or whole number of a field table in its type,
/// its range, whatever a target asks for, and the units of the file (tested: test_fit_defaults);
/// the friction weight σ (1 − r/cutoff); an object without members. Fails: NO_MEMORY.
enum status mf_fit_choice_give_text(const struct json_object *root, const char *path,
                                    const char *key, const char *text) MUST_USE;
enum status mf_fit_choice_give_number(const struct json_object *root, const char *path,
                                      const char *key, double value) MUST_USE;
enum status mf_fit_choice_give(const struct fit_choice *choice, const char *path,
                               const struct field *fields, const char *key, double value) MUST_USE;
enum status mf_fit_choice_give_omega(const struct fit_choice *choice, const char *path,
                                     double sigma, double cutoff) MUST_USE;
enum status mf_fit_choice_give_empty(const struct json_object *root, const char *path) MUST_USE;

/// The time step that bonds, angles and dihedrals ask for by their targets and the integrator [τ];
/// infinite without.
double mf_fit_defaults_stiff_step(const struct fit_choice *choice);

/// The time step of dynamics without velocities whose variance in a well of that curvature
/// [k_B T_0/λ²] is wrong by the allowed share [τ].
double mf_fit_defaults_relaxing_step(const struct fit_choice *choice, double curvature,
                                     double allowed);

/// σ of ω = σ (1 − r/cutoff) with which a bead loses its velocity in the time in which it would
/// reach its neighbours [sqrt(μ/τ)].
double mf_fit_defaults_sigma(const struct fit_choice *choice, double cutoff);

/// ω, if it is to be found, up to the end of the second shell and to several times that friction.
enum status mf_fit_defaults_omega(struct fit_choice *choice) MUST_USE;

/// How exactly g is to be known: as the target is.
double mf_fit_defaults_precision(const struct fit_choice *choice);

/// The choices of the method and of the verification (defaults/fit_defaults_method.c).
enum status mf_fit_defaults_method(struct fit_choice *choice) MUST_USE;
enum status mf_fit_defaults_verification(struct fit_choice *choice) MUST_USE;
