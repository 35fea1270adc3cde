// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/exported_molecules.h"

#include "curves/bonded_kind.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void write_tables(struct temporary_folder *folder) {
    char bond[4096] = "# r[lambda] U[k_B.T_0]\n", angle[4096] = "# theta[degrees] U[k_B.T_0]\n",
         dihedral[4096] = "# phi[degrees] U[k_B.T_0]\n";
    for (int k = 0; k <= 40; k++) {
        const double r = 0.3 + 0.02 * k, theta = (30 + 3.75 * k) * BONDED_RADIANS;
        const double phi = (-180 + 9 * k) * BONDED_RADIANS;
        snprintf(bond + strlen(bond), sizeof bond - strlen(bond), "%.4f %.8f\n", r,
                 60 * pow(r - 0.7, 2) + 40 * pow(r - 0.7, 3));
        snprintf(angle + strlen(angle), sizeof angle - strlen(angle), "%.4f %.8f\n", 30 + 3.75 * k,
                 9 * pow(theta - 1.9, 2) - 2 * pow(theta - 1.9, 3));
        snprintf(dihedral + strlen(dihedral), sizeof dihedral - strlen(dihedral), "%.4f %.8f\n",
                 -180 + 9.0 * k, 1.7 * cos(3 * phi - 1.2) + 0.8 * sin(phi) + 0.3 * cos(7 * phi));
    }
    small_inputs_write(folder, "bond.tsv", bond, NULL, NULL);
    small_inputs_write(folder, "angle.tsv", angle, NULL, NULL);
    small_inputs_write(folder, "dihedral.tsv", dihedral, NULL, NULL);
}

void exported_molecules_simulate(struct temporary_folder *folder, const char *scene,
                                 const struct exported_molecules_table *tables, size_t count) {
    static struct run_program_result result;
    write_tables(folder);
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
    for (size_t k = 0; k < count; k++)
        small_inputs_change(folder, "scene.json", tables[k].law, tables[k].table);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
}
