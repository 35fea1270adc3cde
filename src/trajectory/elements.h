// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Masses of the chemical elements.
#pragma once

#include "trajectory/structure.h"

/// Standard atomic weight [u], abridged: T. Prohaska et al., Pure Appl. Chem. 94, 573 (2022); where
/// there is none, the mass of the longest-lived isotope. NAN if there is no such element.
/// @param[in] symbol  "C", "Cl", in this case
double mf_elements_mass(const char *symbol);

/// The element that an atom probably is, from what is known of it: what the file says; the name if
/// it is a symbol ("Cl"), in capitals, too, if that is no usual name of an organic molecule's atom
/// ("SI", "FE1", "CL", but not "CA"), or if the atom is an ion or a gas ("NA" of residue "NA");
/// else the first letter of the name ("HW1", "CA"). NULL if that is no element.
/// @param[in] alone  of its residue there is no other atom. Tested: test_structure.
const char *mf_elements_guess(const struct structure_atom *atom, bool alone);

/// A name that is the symbol of an element, or else "X", which programs of atoms take for a bead.
const char *mf_elements_symbol(const char *name);
