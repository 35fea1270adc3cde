// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/configuration.h"

#include "base/memory.h"

#include <stdio.h>

enum { TYPES_SIZE = COMPOSITION_MAX_TYPES * (COMPOSITION_NAME_SIZE + 24) };

static void list_types(const struct composition *composition, char text[TYPES_SIZE]) {
    int length = snprintf(text, TYPES_SIZE, "types:");
    for (int type = 0; type < composition->types; type++)
        length += snprintf(text + length, (size_t)(TYPES_SIZE - length), " %s %lld",
                           composition->name[type], (long long)composition->count[type]);
}

static size_t count_bonds(const struct topology *topology) {
    size_t bonds = 0;
    for (int k = 0; k < topology->kinds; k++)
        bonds += (size_t)topology->kind[k].count * (size_t)topology->kind[k].terms[BONDED_BOND];
    return bonds;
}

/// The two beads of each bond, molecule after molecule, in two columns of `bonds` rows.
static void list_bonds(const struct topology *topology, double *first, double *second) {
    size_t row = 0;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int t = 0; t < kind->terms[BONDED_BOND]; t++, row++) {
                const int *bead = kind->term[BONDED_BOND][t].bead;
                first[row] = topology_id(kind, m, bead[0]) + 1.0;
                second[row] = topology_id(kind, m, bead[1]) + 1.0;
            }
    }
}

static enum status write_bonds(const char *file, const struct topology *topology) {
    const size_t bonds = count_bonds(topology);
    OWNED double *beads = NULL;
    if (bonds == 0)
        return STATUS_OK;
    TRY_ARRAY(beads, 2 * bonds);
    list_bonds(topology, beads, beads + bonds);
    const struct data_column columns[] = {{"first", beads, "%.0f"},
                                          {"second", beads + bonds, "%.0f"}};
    return mf_data_table_write(file, "rows of " CONFIGURATION_FILE " that are bonded, from 1 on",
                               columns, 2, bonds);
}

enum status mf_configuration_write(const char *file, const char *bonds_file,
                                   const struct units *units, const struct composition *composition,
                                   const struct topology *topology,
                                   const struct data_column *columns, size_t count, size_t rows) {
    char types[TYPES_SIZE];
    list_types(composition, types);
    TRY(mf_data_table_write_in(file, units, composition_is_mixed(composition) ? types : NULL,
                               columns, count, rows));
    return topology ? write_bonds(bonds_file, topology) : STATUS_OK;
}
