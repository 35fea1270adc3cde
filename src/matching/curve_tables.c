// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/curve_tables.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

#include <stdio.h>

/// The columns of one curve of an unknown.
static enum status write_curve(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve,
                               const struct curve_tables_member *member, size_t members,
                               const char *comment, const struct units *units, const char *path) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    const size_t points = mf_unknowns_points(unknowns, kind);
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const size_t each = part.points, first = part.first;
    OWNED struct data_column *column = NULL;
    OWNED double *values = NULL;
    OWNED char(*names)[CURVE_TABLES_NAME_SIZE + 24] = NULL;
    TRY_ARRAY(column, members + 1);
    TRY_ARRAY(names, members);
    TRY_ARRAY(values, (members + 1) * points);
    column[0] = (struct data_column){mf_unknowns_heading(unknowns, kind, curve),
                                     mf_unknowns_r(unknowns, kind) + first, NULL};
    for (size_t k = 0; k < members; k++) {
        double *value = values + k * points;
        mf_parametrisation_curve(parametrisation, kind, member[k].variables, value);
        mf_data_table_name(units, member[k].name, mf_unknowns_unit(kind), names[k],
                           sizeof names[k]);
        column[k + 1] = (struct data_column){names[k], value + first, "%.8g"};
    }
    return mf_data_table_write_in(path, units, comment, column, members + 1, each);
}

enum status mf_curve_tables_write(const struct parametrisation *parametrisation,
                                  const struct inverse_folder *folder, const char *prefix,
                                  const char *comment, const struct curve_tables_member *member,
                                  size_t members) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    char name[UNKNOWNS_NAME_SIZE], file[2 * UNKNOWNS_NAME_SIZE], path[OUTPUT_PATH_SIZE];
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; unknowns->problem->unknown[kind].wanted &&
                               curve < mf_unknowns_curve_count(unknowns, kind);
             curve++) {
            mf_unknowns_curve_name(unknowns, kind, curve, name);
            snprintf(file, sizeof file, "%s_%s.tsv", prefix, name);
            folder->file(folder->context, file, path);
            TRY(write_curve(parametrisation, kind, curve, member, members, comment, folder->units,
                            path));
        }
    return STATUS_OK;
}
