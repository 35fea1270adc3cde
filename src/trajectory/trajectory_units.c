// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/trajectory_units.h"

#include "base/nearest.h"

#include <string.h>

/// One gram, and the masses of an electron and an attogram, in u: CODATA 2018.
#define GRAM 6.02214076208e23
#define BOHR 0.0529177210903
/// The time of "electron" is a femtosecond, its speed that of one Bohr in 1.03275 fs.
#define ATOMIC_TIME 1.03275e-3

const char *const mf_trajectory_unit_names[] = {"real",     "metal", "nano",  "lj",    "si",
                                                "electron", "cgs",   "micro", "nm-ps", NULL};

static const struct trajectory_scale scales[] = {
    {0.1, 1e-3, 1, 100},
    {0.1, 1, 1, 0.1},
    {1, 1e3, 1e-18 * GRAM, 1e-3},
    {1, 1, 1, 1},
    {1e9, 1e12, 1e3 * GRAM, 1e-3},
    {BOHR, 1e-3, 1, BOHR / ATOMIC_TIME},
    {1e7, 1e12, GRAM, 1e-5},
    {1e3, 1e6, 1e-12 * GRAM, 1e-3},
    {1, 1, 1, 1},
};

enum { STYLES = sizeof scales / sizeof *scales };
_Static_assert(sizeof mf_trajectory_unit_names / sizeof *mf_trajectory_unit_names == STYLES + 1,
               "every style has a scale");

enum status mf_trajectory_units_find(const char *name, struct trajectory_scale *scale) {
    char hint[256];
    for (int k = 0; k < STYLES; k++)
        if (strcmp(name, mf_trajectory_unit_names[k]) == 0) {
            *scale = scales[k];
            return STATUS_OK;
        }
    mf_nearest_hint(name, mf_trajectory_unit_names, STYLES, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "unknown units \"%s\"; %s", name, hint);
}
