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
    const struct field *fields; ///< parameters; must contain "cutoff" unless `cutoff` knows better
    size_t size;                ///< bytes of the parameter struct
    double (*value)(const void *parameters, double r);
    double (*cutoff)(const void *parameters);
    /// Refuse what is in range each and not together, and make what `value` needs besides, as of a
    /// formula that is text; NULL: neither.
    enum status (*check)(void *parameters);
    /// Told before `check` in which units a formula is written: its r is r times `length`, its
    /// value that of the curve times `unit`; NULL: the parameters are all there is.
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

/// Say in which units what the family's fields cannot convert is written: lengths and values of it
/// are `length` λ^-1 and `unit` times those of the curve. Tested: test_units_files.
void mf_curve_scale(const struct curve *curve, double length, double unit);

/// Whether the parameters go together: to be asked after they were set, and before any value.
/// Fails: BAD_INPUT. Tested: test_curves.
enum status mf_curve_check(const struct curve *curve) MUST_USE;

/// Free the parameters; a zeroed curve is fine.
void mf_curve_clear(struct curve *curve);

/// Value at distance r ≥ 0 [λ]: Φ [k_B T_0] or ω [sqrt(mass/time)]. Finite for every r ≥ 0.
/// Threads: any number at once.
double mf_curve_value(const struct curve *curve, double r);

/// Distance beyond which the value is 0 [λ].
double mf_curve_cutoff(const struct curve *curve);
