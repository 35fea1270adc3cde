// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What settings of VOTCA's csg_inverse, <cg> in XML, say that a fit needs: the targets of
/// pairs and groups, their ranges, temperature and pressure; and what is left out of them.
#pragma once

#include "io/output.h"
#include "io/xml.h"
#include "report/progress.h"
#include "system/topology.h"

enum { IMPORT_MAX_INTERACTIONS = 64 };

struct import_pair {
    const struct xml_element *element;
    char name[2 * COMPOSITION_NAME_SIZE], type[2][COMPOSITION_NAME_SIZE];
    const struct xml_element *target; ///< whose text is its file
    double cutoff;                    ///< [nm]: <max>, or where the target ends before
};

/// A bond, angle or dihedral: number `table` of those of its order in a topology of GROMACS.
struct import_group {
    char name[TOPOLOGY_NAME_SIZE];
    const struct xml_element *element; ///< NULL: the settings lack it
    const struct xml_element *target;  ///< or NULL: its potential is that table
    char table_file[64];
    int order, table;
};

struct import_settings {
    struct xml_document document;
    char folder[OUTPUT_PATH_SIZE]; ///< that the file is in
    struct import_pair pair[IMPORT_MAX_INTERACTIONS];
    struct import_group group[IMPORT_MAX_INTERACTIONS];
    size_t pairs, groups;
    double temperature;                 ///< [K]
    const struct xml_element *pressure; ///< [bar], or NULL: it is no target
};

/// Fails: BAD_INPUT with file and line; IO; NO_MEMORY. Tested: cli/test_import.
enum status mf_import_settings_read(struct import_settings *settings, const char *file) MUST_USE;
void mf_import_settings_clear(struct import_settings *settings);

/// A file that stands beside the settings.
void mf_import_settings_path(const struct import_settings *settings, const char *name,
                             char path[OUTPUT_PATH_SIZE]);
