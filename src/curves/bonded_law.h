// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The energy U(q) of a bonded term, and the record of its law.
///
/// q is the length of a bond [λ], an angle from 0 to π, or a dihedral from −π to π [rad], 0 where
/// the outer beads are on the same side (cis) and π where they are on opposite ones (trans), as
/// IUPAC has it. A law is one record: name, parameters, energy and slope. To add one, write the
/// record and add it to the laws of its kind (bond.c, angle.c, dihedral.c).
#pragma once

#include "base/fields.h"
#include "base/status.h"

struct bonded_law {
    const char *name;           ///< value of "law" in a scene
    const char *summary;        ///< the formula with its factor and its source, one line
    const struct field *fields; ///< of the parameters
    size_t size;                ///< of their struct
    /// Energies U [k_B T_0] and slopes dU/dq at `count` values of q. Finite for all q.
    void (*evaluate)(const void *parameters, size_t count, const double *q, double *energy,
                     double *slope);
    /// The slopes alone, of the same bits; NULL: energies cost little beside them.
    void (*slopes)(const void *parameters, size_t count, const double *q, double *slope);
    double (*rest)(const void *parameters); ///< q at which a molecule begins
    /// Length at which a bond breaks [λ]; NULL: never.
    double (*longest)(const void *parameters);
    void (*clear)(void *parameters); ///< frees what the parameters own; NULL: nothing
};

/// A law and its numbers, which it owns. A zeroed one is none.
struct bonded_curve {
    const struct bonded_law *law;
    void *parameters;
};

/// Start a curve with the law's default parameters. Fails: NO_MEMORY.
enum status mf_bonded_create(struct bonded_curve *curve, const struct bonded_law *law) MUST_USE;
void mf_bonded_clear(struct bonded_curve *curve);

/// A parameter by its name in a scene; set it, or false if it is out of its range.
double mf_bonded_number(const struct bonded_curve *curve, const char *name);
bool mf_bonded_set_number(struct bonded_curve *curve, const char *name, double value);

/// Energy and slope at one q; each may be NULL. Tested: test_bonded_law.
void mf_bonded_value(const struct bonded_curve *curve, double q, double *energy, double *slope);

/// Where a molecule begins: a length [λ] or an angle [rad].
double mf_bonded_rest(const struct bonded_curve *curve);

/// Length at which a bond breaks [λ], or infinite.
double mf_bonded_longest(const struct bonded_curve *curve);

/// How long a bond may be before it is stretched by more than an energy, within a factor of two of
/// the way from its rest, which may be at 0; at most its longest [λ].
double mf_bonded_reach(const struct bonded_curve *curve, double height);

/// Share of bonds that are longer than `length` [λ] if their law alone acts: of r^(d−1) e^(−U/k_B
/// T), or 0 where that takes more than 40 k_B T. Tested: test_bonded_law.
double mf_bonded_share_beyond(const struct bonded_curve *curve, double length, double temperature,
                              int dimensions);

extern const struct bonded_law mf_bond_harmonic, mf_bond_fene;
extern const struct bonded_law mf_angle_harmonic, mf_angle_cosine, mf_angle_cosine_squared;
extern const struct bonded_law mf_dihedral_ryckaert_bellemans, mf_dihedral_periodic;
