// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is simulated: box, beads and molecules, which settings do not say themselves but
/// files beside them.
#pragma once

#include "import/import_settings.h"
#include "scene/scene_molecules.h"

/// What the command line says in place of files.
struct import_options {
    double box[3];     ///< [nm]; 0: not given
    const char *count; ///< "A=100,B=50": single beads of types; NULL: not given
};

struct import_system {
    double box[3];                     ///< [nm]
    char box_file[OUTPUT_PATH_SIZE];   ///< that has it; "": the command line
    char beads_file[OUTPUT_PATH_SIZE]; ///< the same of the beads
    struct composition beads;          ///< all of them
    struct composition single;         ///< those that are in no molecule, of the same types
    struct scene_molecules molecules;  ///< without kinds of one bead
    struct import_mass {
        double sum, count, low, high; ///< [u] of the beads whose masses are given
    } mass[COMPOSITION_MAX_TYPES];
};

/// Box of the first file beside the settings that has one: <inverse><gromacs><conf>, conf.gro, and
/// what <filelist> and the engines' <topol> name; beads and molecules of topol.top or, where there
/// is none, the atoms of that file. Groups of tables get the names that the settings have for them;
/// those that the settings lack are added to them, with the table that lies beside them. Fails:
/// BAD_INPUT, naming the file and the option that helps; IO; NO_MEMORY. Tested: cli/test_import.
enum status mf_import_system_find(struct import_system *system, struct import_settings *settings,
                                  const struct import_options *options) MUST_USE;
void mf_import_system_clear(struct import_system *system);

/// Mean over the beads of a type [u]; NAN: not known.
double mf_import_system_mass(const struct import_system *system, int type);
