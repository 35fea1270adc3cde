// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A measured RDF to be matched.
#pragma once

#include "io/json.h"
#include "observe/rdf.h"

/// "rdf" among the targets of a run file.
struct target_parameters {
    char file[FIELD_TEXT_SIZE];
    int64_t r_column, g_column, error_column; ///< from 1; error_column 0: no errors given
    int64_t particles; ///< of the system it was measured in; 0: as many as the scene has
};

extern const struct field target_fields[];

struct target {
    struct target_parameters parameters;
    struct rdf_bins bins;
    double *g, *error; ///< shape [bins.count]
};

/// Read the members of {"file": …}. Faults (gaps, negative values, …) go to the document and leave
/// the target empty. Fails: NO_MEMORY.
enum status target_read(struct target *target, struct json_object *object) MUST_USE;
/// Convert g and its errors to a system of `count` particles (rdf_finite_size_factor).
void target_convert(struct target *target, size_t count);

void target_clear(struct target *target);
