// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Masses, radii and so on of the particles of a scene: numbers, ranges, columns of a file.
#pragma once

#include "scene/scene.h"
#include "io/data_table.h"

/// Read those members of "particles" that are attributes; the types must be known. Faults go to the
/// document.
void mf_scene_attributes_read(struct scene *scene, struct json_object *particles);

/// The first column of a placement file after those of positions and velocities: the last ones
/// that are called by an attribute in the line of names.
size_t mf_scene_attributes_first_column(const struct data_table *table);

/// Make the numbers of such a column reduced. Fails: BAD_INPUT.
enum status mf_scene_attributes_convert(struct data_table *table, const char *file, size_t column,
                                        const struct units *units) MUST_USE;

/// The name of a column in the line of names; false if that has not as many names as there are
/// columns.
bool mf_scene_attributes_column_name(const struct data_table *table, size_t column, char *name,
                                     size_t size);

/// Take such a column; `values`, shape [rows], are its numbers and live as long as the scene.
/// Faults go to the document.
void mf_scene_attributes_column(struct scene *scene, struct json_object *particles,
                                const struct data_table *table, size_t column,
                                const double *values);

/// Write what mf_scene_attributes_read has read.
void mf_scene_attributes_write(const struct scene *scene, struct json_writer *writer);
