// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "units" of scene and run files, read and written.
///
///   "units": "nm-ps"                                                the program chooses the scale
///   "units": {"system": "nm-ps", "length": 0.465, …}                it is given, in part or whole
///   "units": {"length": 0.465, "temperature": 298, "mass": 3e-26}   the file is reduced: results
///                                                                   in nm and ps stand beside
#pragma once

#include "base/fields.h"
#include "io/json.h"
#include "io/json_write.h"
#include "io/units_scale.h"

/// The scale of a reduced scene, in nm, K and kg; and that of a file in physical units.
extern const struct field mf_units_fields[], mf_units_system_fields[];

/// Set the units of the document to the "units" at the top of its file, before anything else is
/// read.
/// @param[in] scene  the file's scene, or the root itself in a scene file
///
/// What the file does not say of the scale follows from the scene: T_0 is its temperature, μ the
/// mean mass of its beads, 1 u if it says none, and λ is such that λ³, in two dimensions λ², holds
/// three beads. Faults: a temperature that is missing or 0; units whose time, energy, pressure or
/// diffusion no number can hold. Tested: test_units.
void mf_units_read_document(struct json_object *root, struct json_object *scene);

/// The units of a scene: those of its document, as mf_units_read_document finds them
/// if the scene is all of the file, or "units" of a reduced one. Units whose time, energy, pressure
/// or diffusion no number can hold are a fault. Tested: test_units.
void mf_units_read(struct units *units, struct json_object *scene);

/// Write "units" at the top of a file in physical units, and set the units of the writer to them
/// from now on; nothing in a reduced file. Reading it gives the same bits.
void mf_units_write(const struct units *units, struct json_writer *writer);

/// The same for a summary, with the other units that follow.
void mf_units_write_summary(const struct units *units, struct json_writer *writer);

/// Add an object "physical" with the units and the given results in them to a reduced summary;
/// nothing if not known.
/// @param[in] energy    of a particle [k_B T_0]
/// @param[in] pressure  [k_B T_0/λ³]
void mf_units_write_results(const struct units *units, struct json_writer *writer, double energy,
                            double pressure);
