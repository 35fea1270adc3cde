// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Types of beads in a mixture, and the types of their pairs.
///
/// Ids 0 … n_A − 1 are beads of the first type, the next n_B of the second, and so on: the type
/// follows from the id, is never saved, and survives every sort. The T (T + 1)/2 pair types are
/// numbered A-A, A-B, …, B-B, B-C, …
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum {
    COMPOSITION_MAX_TYPES = 8,
    COMPOSITION_MAX_PAIRS = COMPOSITION_MAX_TYPES * (COMPOSITION_MAX_TYPES + 1) / 2,
    COMPOSITION_NAME_SIZE = 16,
    COMPOSITION_PAIR_NAME_SIZE = 2 * COMPOSITION_NAME_SIZE,
};

/// Plain data; all zero is a one-component system.
struct composition {
    int types;                            ///< 0 or 1: a one-component system
    int64_t count[COMPOSITION_MAX_TYPES]; ///< beads of each type
    char name[COMPOSITION_MAX_TYPES][COMPOSITION_NAME_SIZE];
};

/// `count` beads of one type without a name.
struct composition mf_composition_of_one(int64_t count);

/// Beads of all types.
int64_t mf_composition_particles(const struct composition *composition);

/// The same mixture of about `particles` beads; a type keeps two if it has them, so that there are
/// pairs of it, and one if it has no more, so that there are none.
struct composition mf_composition_scaled(const struct composition *composition, int64_t particles);

static inline bool composition_is_mixed(const struct composition *composition) {
    return composition->types > 1;
}

/// Number of pair types: T (T + 1)/2, at least 1.
int mf_composition_pairs(const struct composition *composition);

/// Number of the pair type of types a and b, in either order.
int mf_composition_pair(const struct composition *composition, int a, int b);

/// The same of two beads.
int mf_composition_pair_of_ids(const struct composition *composition, uint32_t i, uint32_t j);

/// Type of a bead.
int mf_composition_type(const struct composition *composition, uint32_t id);

/// The types of a pair type, type[0] ≤ type[1].
void mf_composition_pair_types(const struct composition *composition, int pair, int type[2]);

/// How many pairs of a pair type there are: N_a (N_a − 1)/2 of one type, N_a N_b of two.
double mf_composition_possible_pairs(const struct composition *composition, int pair);

/// Whether there is any pair of a pair type: of a single bead there is none. Of beads that nobody
/// has counted there are.
bool mf_composition_has_pairs(const struct composition *composition, int pair);

/// Print the name of a pair type, "A-B", or nothing for beads without names.
void mf_composition_pair_name(const struct composition *composition, int pair,
                              char text[COMPOSITION_PAIR_NAME_SIZE]);

/// The pair type called "A-B" or "B-A", or −1.
int mf_composition_find_pair(const struct composition *composition, const char *name);

/// Whether a type can be called so: NAMES_OF_TYPE.
bool mf_composition_is_name(const char *name);
