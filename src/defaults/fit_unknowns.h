// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a run file looks for: {"potential": {…}, "omega": {…}, "omega_transverse": {…},
/// "memory": {"slow": {…}}, "numbers": {…}, "bonds": {"backbone": {}}, "angles", "dihedrals"}, the
/// modes of memory by the names that the scene has. A file without "unknowns" looks for the
/// potential, unless only groups have targets, and for the groups that have one and no law.
#pragma once

#include "defaults/fit_file.h"
#include "problem/numbers.h"

/// What the scene leaves out since "unknowns" names it or, without that, has a target: a sum of
/// scene_unknown.
int mf_fit_unknowns_left_out(struct json_object *root);

/// Whether "unknowns" names groups of bonds, angles or dihedrals; else they are those of targets.
bool mf_fit_unknowns_name_groups(const struct json_object *root);

/// The groups of bonds, angles and dihedrals that are looked for: those of "unknowns", or without
/// that those with a target and without a law in the scene. A fault if the scene has one of both.
void mf_fit_unknowns_groups(struct json_object *root, struct json_object *scene,
                            struct scene_fitted *fitted);

/// Read "unknowns" of a run file whose scene is read. Faults go to the document. Fails: NO_MEMORY.
enum status mf_fit_unknowns_read(struct fit_file *fit, struct json_object *root) MUST_USE;

/// Let follow what does from what was chosen after they were read. Faults go to the document.
/// Fails: NO_MEMORY.
enum status mf_fit_unknowns_complete(struct fit_file *fit, struct json_object *root) MUST_USE;

void mf_fit_unknowns_write(const struct fit_file *fit, struct json_writer *writer);

/// Read {"dissipative.sigma": {"minimum": 1, "maximum": 10}, …} of the object "unknowns". A path is
/// that of a key in the scene: any number there that can change from simulation to simulation.
/// Faults go to the document: paths that the scene does not know (with the nearest), what is no
/// number, what cannot change, and ranges that are none. Fails: NO_MEMORY. Tested:
/// test_fit_numbers.
enum status mf_fit_numbers_read(struct json_object *unknowns, const struct scene *scene,
                                struct inverse_number number[INVERSE_MAX_NUMBERS],
                                size_t *count) MUST_USE;

/// Begin with what the scene has, or in the middle of the range, where the file does not say with
/// what. Fails: NO_MEMORY.
enum status mf_fit_numbers_complete(const struct scene *scene, struct inverse_number *number,
                                    size_t count) MUST_USE;

/// Lend a problem the laws of the scene that numbers may belong to.
void mf_fit_numbers_lend(const struct scene *scene, struct inverse_problem *problem);

/// "friction" at the top of a run file, a FIELD_CHOICE at offset 0. Chosen is that of used.json:
/// the scene's, which a program has chosen to hold the temperature.
enum fit_friction {
    FIT_FRICTION_FREE,
    FIT_FRICTION_EXPORTABLE,
    FIT_FRICTION_LINEAR,
    FIT_FRICTION_CHOSEN
};
extern const struct field mf_fit_friction_fields[];

/// Let ω be of the family: "curve": "power" without an inner cutoff, and its exponent 1 if it is to
/// be linear. What the file says itself is never replaced. False if it says another curve. Tested:
/// test_fit_friction.
bool mf_fit_friction_take(struct fit_unknown *omega, enum fit_friction family);

/// Faults of what the file says of the base: one of a formula, or a range of coefficients that are
/// to be added but never below 0. Sets what the file leaves out: none where it gives the range of
/// the coefficients, which then is that of the curve; and the lower end of the range.
void mf_fit_base_check(struct fit_unknown *unknown, struct json_object *object);
