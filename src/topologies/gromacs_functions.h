// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Functions of bonds, angles and dihedrals in topologies of GROMACS (reference manual,
/// "Topology file", table of interactions) and the laws that they are.
#pragma once

#include "curves/bonded_kind.h"

enum { GROMACS_MAX_PARAMETERS = 6 };
enum gromacs_unit { GROMACS_PURE, GROMACS_LENGTH, GROMACS_ENERGY, GROMACS_BOND };

struct gromacs_function {
    int order;
    int number;
    const struct bonded_law *law;
    const char *parameter[GROMACS_MAX_PARAMETERS]; ///< in their order, by their names in a scene
    enum gromacs_unit unit[GROMACS_MAX_PARAMETERS];
};

/// All that are laws of ours, ended by one without a law. Of a law the first is what is written.
extern const struct gromacs_function mf_gromacs_functions[];

/// The function of a table of an order of terms: the law "table", without points. Its numbers are
/// the table's and a factor.
extern const struct gromacs_function mf_gromacs_tables[BONDED_KINDS];

/// What a number of a unit in nm and kJ/mol is to be divided by to be one in λ and k_B T_0, given
/// these [nm], [kJ/mol].
static inline double gromacs_unit(enum gromacs_unit unit, double length, double energy) {
    return unit == GROMACS_LENGTH   ? length
           : unit == GROMACS_ENERGY ? energy
           : unit == GROMACS_BOND   ? energy / (length * length)
                                    : 1;
}
