// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Scalars of a scene that are to be found: the scene with other values of them.
#pragma once

#include "forces/many_body.h"
#include "problem/inverse.h"

/// What a run file says of one: struct inverse_number.
enum { NUMBERS_FIELDS = 4 };
extern const struct field mf_numbers_fields[NUMBERS_FIELDS];

/// Those of a number of this unit.
void mf_numbers_fields_of(const char *unit, struct field fields[NUMBERS_FIELDS]);

/// Where a setup has the table of a law, by enum unknown_kind.
const struct table **mf_numbers_table_of(struct simulation_setup *scene, int law);

/// What is made for values: tables of laws, parameters of the integrator and the interactions, the
/// molecules, whose groups have parameters of their own where a number belongs to them, and local
/// densities, all of whose tables are made anew where a number belongs to one of them.
struct numbers_own {
    struct table table[UNKNOWNS];
    void *dynamics, *interaction[INTERACTION_MAX];
    struct molecules molecules;
    void *bonded[INVERSE_MAX_BONDED]; ///< parameters, by inverse_group
    struct many_body many_body;
};

/// The problem whose scene has these values: settings are replaced, and the table of a law with a
/// changed parameter is rebuilt. Laws that are unknown curves stay as they are.
/// @param[in]  value    shape [problem->numbers]
/// @param[out] changed  borrows what `problem` does, and `own`
/// @param[in,out] own   zero; what was made, to be cleared, also after a failure
/// Fails: NO_MEMORY; BAD_INPUT if a law has no table with these values.
/// Threads: any number at once. Tested: test_numbers.
enum status mf_numbers_apply(const struct inverse_problem *problem, const double *value,
                             struct inverse_problem *changed, struct numbers_own *own) MUST_USE;
void mf_numbers_own_clear(struct numbers_own *own);

/// The values that a fit begins with, shape [problem->numbers].
void mf_numbers_start(const struct inverse_problem *problem, double *value);

/// The end of its range, "minimum" or "maximum", that a value has come to within a thousandth of
/// the range; NULL if none.
const char *mf_numbers_bound(const struct inverse_number *number, double value);

/// Whether the targets say nothing of a number: two of its standard errors to each side are more
/// than half of its range, of which the range alone would leave 1.15. At an end of the range they
/// say that it is too narrow, and an error that is not known (NaN) tells nothing. Tested:
/// test_numbers.
bool mf_numbers_undetermined(const struct inverse_number *number,
                             const struct inverse_parameter *found);
