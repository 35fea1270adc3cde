// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Units as texts: products, quotients, powers and square roots of named units.
///
/// "k_B T_0/lambda^d", "sqrt(mu/tau)" and "kJ/mol/nm^3" are units; "k_B.T_0" has a dot where a
/// heading may have no blank. A quotient divides by the one factor after it, so that a/b/c is
/// a/(b c). What is counted or is an angle, as "steps" and "degrees", is a pure number. Tested:
/// test_units_text.
#pragma once

#include <stdbool.h>
#include <stddef.h>

/// What a scene sets, and what SI is made of.
enum units_base {
    UNITS_LAMBDA,
    UNITS_TAU,
    UNITS_MU,
    UNITS_K_B,
    UNITS_T_0,
    UNITS_METRE,
    UNITS_SECOND,
    UNITS_KILOGRAM,
    UNITS_KELVIN,
    UNITS_BASES,
    UNITS_SCALED = UNITS_METRE, ///< as many are a scene's
};

/// factor · Π base^exponent.
struct units_text {
    double factor; ///< of the units of SI
    double exponent[UNITS_BASES];
};

/// Read a unit of a scene of so many dimensions, the d of "lambda^d"; false if it is none.
bool mf_units_text_parse(struct units_text *unit, const char *text, int dimensions);

/// Where "name[unit]" has its unit, and how long that is; NULL if it has none.
const char *mf_units_text_in_brackets(const char *heading, size_t *length);
