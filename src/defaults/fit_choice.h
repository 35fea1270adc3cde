// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is known while the program chooses what a run file leaves out
/// (defaults/fit_defaults.h), and how it puts a choice into the struct of what is chosen.
#pragma once

#include "defaults/fit_file.h"
#include "defaults/fit_scales.h"

/// Filled in from choice to choice, in their order.
struct fit_choice {
    struct fit_file *fit;
    const struct fit_file *leader;
    const struct fit_scales_rdf *rdf;
    struct fit_scales scales;
    int dimensions;
    double density;
    double mass;          ///< the least of any bead
    double crossing;      ///< time in which a bead flies, or diffuses, as far as its neighbours
                          ///< are [τ]
    double range;         ///< of g(r) as it will be used [λ]
    size_t joined;        ///< bins of the fit that make one of `rdf`
    double count;         ///< beads of a simulation
    double time_step;     ///< [τ]
    double precision;     ///< of the method, of g
    bool finds[UNKNOWNS]; ///< what is looked for
};

/// The range of g(r), or that of a known part of the potential if it is longer [λ].
static inline double fit_choice_reach(const struct fit_choice *choice) {
    const double known = choice->fit->scene.known.table.cutoff;
    return choice->range > known ? choice->range : known;
}

/// Keep a line for the person who reads what was chosen.
void mf_fit_choice_note(const struct fit_choice *choice, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// "0.334 nm": a number of a reduced unit in the units of the file, "2.15 lambda" in a reduced one.
/// Returns `text`.
enum { FIT_CHOICE_TEXT_SIZE = 160 };
const char *mf_fit_choice_text(const struct fit_choice *choice, const char *unit, double value,
                               char text[FIT_CHOICE_TEXT_SIZE]);

/// A struct of which something may be chosen.
struct fit_place {
    const char *path; ///< of its object, for messages
    const struct field *fields;
    void *parameters;
    uint64_t *given; ///< fields that the file says or that were chosen before (mf_fields_bit)
};

/// Choose a number or one of the choices of a field, within its range whatever a target asks for,
/// unless it is given. Returns whether it was chosen. Tested: test_fit_defaults.
bool mf_fit_choice_give(const struct fit_choice *choice, const struct fit_place *place,
                        const char *key, double value);

/// A number of a field as it is chosen: within its range, and as it is when it has been written to
/// used.json, in the units of the file, and is read again, so that used.json gives the same fit.
double mf_fit_choice_number(const struct fit_choice *choice, const char *path,
                            const struct field *fields, const char *key, double value);

/// Make a law that has none the friction weight σ (1 − r/cutoff). Fails: NO_MEMORY.
enum status mf_fit_choice_give_omega(const struct fit_choice *choice, const char *path,
                                     double sigma, double cutoff, struct scene_law *law) MUST_USE;

/// The time step, and the steps that molecules take in it (dynamics/respa.h), unless the file gives
/// it: then it is only doubted.
void mf_fit_defaults_time_step(struct fit_choice *choice);

/// No molecule is longer than its bonds, one after the other [λ].
double mf_fit_longest_molecule(const struct fit_choice *choice);

/// σ of ω = σ (1 − r/cutoff) with which a bead loses its velocity in the time in which it would
/// reach its neighbours [sqrt(μ/τ)].
double mf_fit_defaults_sigma(const struct fit_choice *choice, double cutoff);

/// ω, if it is to be found, up to the end of the second shell and to several times that friction.
enum status mf_fit_defaults_omega(struct fit_choice *choice) MUST_USE;

/// How exactly g is to be known: as the target is.
double mf_fit_defaults_precision(const struct fit_choice *choice);

/// The choices of the method and of the verification (defaults/fit_defaults_method.c).
enum status mf_fit_defaults_method(struct fit_choice *choice) MUST_USE;
void mf_fit_defaults_verification(struct fit_choice *choice);
struct fit_place mf_fit_defaults_verification_place(const struct fit_choice *choice);

/// A method with its default parameters. Fails: NO_MEMORY.
enum status mf_fit_defaults_take_method(struct fit_choice *choice,
                                        const struct inverse_method *method) MUST_USE;
