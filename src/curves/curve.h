// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A function of the pair distance: Φ(r) or ω(r), and the record of its family.
///
/// A family is one record: name, parameters, value. To add one, write the record and add it to a
/// list in curve.c.
#pragma once

#include "base/fields.h"
#include "base/status.h"

/// Record of a function family.
struct curve_family {
    const char *name;           ///< value of "law" in a scene
    const char *summary;        ///< the formula, one line
    const struct field *fields; ///< parameters, as members of their struct
    size_t size;                ///< bytes of the parameter struct
    double (*value)(const void *parameters, double r);
    double (*cutoff)(const void *parameters);
    /// Called once the parameters are set: refuses those that are each in range but do not go
    /// together, and prepares what `value` needs besides, as the parsed text of a formula. NULL:
    /// nothing to do.
    enum status (*check)(void *parameters);
    /// Called before `check` of a family whose parameters the field table cannot convert, as a
    /// formula given as text, whose r is `length` times that of the curve and whose value is `unit`
    /// times that of the curve. NULL: the field table converts all.
    void (*scale)(void *parameters, double length, double unit);
    void (*clear)(void *parameters); ///< frees what the parameters own; NULL if nothing
};

/// A member of a family. Owns its parameters.
struct curve {
    const struct curve_family *family;
    void *parameters;
};

/// Potentials Φ(r) that a scene can name, NULL-terminated.
extern const struct curve_family *const mf_curve_potentials[];

/// Friction weights ω(r) that a scene can name, NULL-terminated.
extern const struct curve_family *const mf_curve_omegas[];

/// Family called `name` in `list`, or NULL.
const struct curve_family *mf_curve_find(const struct curve_family *const *list, const char *name);

/// Start a curve with the family's default parameters.
enum status mf_curve_create(struct curve *curve, const struct curve_family *family) MUST_USE;

/// Call `scale` of the family, if it has one, with the units of the file: lengths and values in the
/// file are `length` and `unit` times those of the curve. Tested: test_units_files.
void mf_curve_scale(const struct curve *curve, double length, double unit);

/// Call `check` of the family, if it has one: once the parameters are set, before any value.
/// Fails: BAD_INPUT if they do not go together. Tested: test_curves.
enum status mf_curve_check(const struct curve *curve) MUST_USE;

/// Free the parameters; a zeroed curve is fine.
void mf_curve_clear(struct curve *curve);

/// Value at distance r ≥ 0 [λ]: Φ [k_B T_0] or ω [sqrt(mass/time)]. Finite for every r ≥ 0.
/// Threads: any number at once.
double mf_curve_value(const struct curve *curve, double r);

/// Distance beyond which the value is 0 [λ].
double mf_curve_cutoff(const struct curve *curve);
