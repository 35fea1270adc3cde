// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/gromacs_functions.h"

#define SPRING(name)                                                                               \
    {name, "k"}, {                                                                                 \
        GROMACS_LENGTH, GROMACS_BOND                                                               \
    }
#define BEND                                                                                       \
    {"angle", "k"}, {                                                                              \
        GROMACS_PURE, GROMACS_ENERGY                                                               \
    }
#define TURN                                                                                       \
    {"phase", "k", "multiplicity"}, {                                                              \
        GROMACS_PURE, GROMACS_ENERGY, GROMACS_PURE                                                 \
    }
#define COSINES                                                                                    \
    {"c0", "c1", "c2", "c3", "c4", "c5"}, {                                                        \
        GROMACS_ENERGY, GROMACS_ENERGY, GROMACS_ENERGY, GROMACS_ENERGY, GROMACS_ENERGY,            \
            GROMACS_ENERGY                                                                         \
    }

const struct gromacs_function mf_gromacs_functions[] = {
    {BONDED_BOND, 1, &mf_bond_harmonic, SPRING("length")},
    {BONDED_BOND, 7, &mf_bond_fene, SPRING("longest")},
    {BONDED_ANGLE, 1, &mf_angle_harmonic, BEND},
    {BONDED_ANGLE, 2, &mf_angle_cosine_squared, BEND},
    {BONDED_DIHEDRAL, 1, &mf_dihedral_periodic, TURN},
    {BONDED_DIHEDRAL, 4, &mf_dihedral_periodic, TURN},
    {BONDED_DIHEDRAL, 9, &mf_dihedral_periodic, TURN},
    {BONDED_DIHEDRAL, 3, &mf_dihedral_ryckaert_bellemans, COSINES},
    {.law = NULL},
};

#define TABLE(NAME, kind, ...)                                                                     \
    {BONDED_##NAME, 8, &mf_##kind##_table, {"table", "k"}, {GROMACS_PURE, GROMACS_PURE}},
const struct gromacs_function mf_gromacs_tables[BONDED_KINDS] = {BONDED_LIST(TABLE)};
