// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a run file looks for: {"potential": {…}, "omega": {…}, "omega_transverse": {…},
/// "memory": {"slow": {…}}, "numbers": {…}, "bonds": {"backbone": {}}, "angles", "dihedrals"}, the
/// modes of memory by the names that the scene has. A file without "unknowns" looks for the
/// potential, unless only groups have targets, and for the groups that have one and no law.
#pragma once

#include "defaults/fit_file.h"

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
