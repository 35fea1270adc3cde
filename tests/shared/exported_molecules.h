// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A scene of molecules that is simulated to be exported, with laws or with tables for them.
#pragma once

#include "shared/temporary_folder.h"

/// A law of the scene, and what stands in its place.
struct exported_molecules_table {
    const char *law, *table;
};

/// Write scene.json, with the tables unless `count` is 0, and bond.tsv, angle.tsv and dihedral.tsv,
/// which they may name; simulate it, into "out".
void exported_molecules_simulate(struct temporary_folder *folder, const char *scene,
                                 const struct exported_molecules_table *tables, size_t count);
