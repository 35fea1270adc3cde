// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "forces" of a target: the equations of force matching that `measure --forces` has written.
/// They are no observable, and nothing is compared with them.
#pragma once

#include "io/json.h"
#include "io/json_write.h"
#include "io/units_scale.h"
#include "observe/force_equations.h"

struct target_forces {
    bool given;
    struct target_forces_files {
        char file[FIELD_TEXT_SIZE], gram_file[FIELD_TEXT_SIZE];
    } files;
    struct force_equations equations; ///< in reduced units
};

extern const struct field mf_target_forces_fields[];

/// Read the object "forces", if there is one. Faults go to the document. Fails: NO_MEMORY. Tested:
/// cli/test_force_matching.
enum status mf_target_forces_read(struct target_forces *forces, struct json_object *target,
                                  const struct units *units) MUST_USE;
void mf_target_forces_clear(struct target_forces *forces);
void mf_target_forces_write(const struct target_forces *forces, struct json_writer *writer);
