// SPDX-License-Identifier: GPL-3.0-or-later
//
// Carbons that have their hydrogens in them, by what is missing: of a residue the names of carbons
// say more hydrogens than there are (CH3), or the valences of its atoms are too few for them.
// Tested: test_mapping.
#include "base/memory.h"
#include "trajectory/mapping_build.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/// Atoms of a residue.
struct residue {
    double carbons, hydrogens, oxygens;
    double others;  ///< valences of all that is neither
    double claimed; ///< hydrogens by the names of carbons
};

/// Hydrogens that a name says: of CH3 three, of CH one.
static double claimed_by(const char *name) {
    if (strncasecmp(name, "CH", 2) != 0 || strlen(name) > 3)
        return 0;
    return name[2] == '\0' ? 1 : isdigit((unsigned char)name[2]) ? name[2] - '0' : 0;
}

/// What an atom can bind; metals are ions, and bind nothing.
static double valence(const char *element) {
    static const struct {
        const char *symbol;
        double bonds;
    } all[] = {{"N", 3}, {"P", 5},  {"S", 6},  {"Si", 4}, {"B", 3},
               {"F", 1}, {"Cl", 1}, {"Br", 1}, {"I", 1}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if (strcmp(element, all[k].symbol) == 0)
            return all[k].bonds;
    return 0;
}

static void add_atom(struct residue *residue, const struct structure_atom *atom,
                     const char *element) {
    const bool is_carbon = strcmp(element, "C") == 0;
    residue->carbons += is_carbon;
    residue->hydrogens += strcmp(element, "H") == 0;
    residue->oxygens += strcmp(element, "O") == 0;
    residue->others += valence(element);
    residue->claimed += is_carbon ? claimed_by(atom->name) : 0;
}

/// Whether carbons lack hydrogens: of their four valences each, bonds among n of them take two for
/// an order, whose sum is at most 3 for two, as in acetylene, and 1.75 n − 1 or, of rings joined
/// with rings, 1.75 n. The rest is for other atoms, of which a half of the oxygens has a hydrogen
/// of its own. Carbon monoxide is none of the case.
static bool lacks(const struct residue *r) {
    const double n = r->carbons, atoms = n + r->hydrogens + r->oxygens;
    const double among = n < 2 ? 0 : n < 3 ? 3 : n < 6 ? 1.75 * n - 1 : 1.75 * n;
    const double hydroxyl = fmin(r->hydrogens, r->oxygens > 0 ? fmax(1, floor(r->oxygens / 2)) : 0);
    const double bound = 2 * r->oxygens + r->others + r->hydrogens - 2 * hydroxyl;
    if (n == 0 || (n == 1 && r->oxygens == 1 && atoms == 2 && r->others == 0))
        return false;
    return r->claimed > r->hydrogens || bound < 4 * n - 2 * among;
}

/// Add the name of an atom to a list of quoted ones, unless it is there or the list is long.
static void list_name(char *list, size_t size, const char *name) {
    char quoted[STRUCTURE_NAME + 4];
    const size_t length = strlen(list);
    snprintf(quoted, sizeof quoted, "\"%s\"", name);
    if (strstr(list, quoted) == NULL && length + 2 * sizeof quoted < size)
        snprintf(list + length, size - length, "%s%s", length > 0 ? ", " : "", quoted);
}

enum status mf_mapping_build_united(struct mapping *mapping, const struct structure *structure,
                                    const bool *guessed) {
    OWNED struct residue *residue = NULL;
    const struct structure_atom *first = NULL;
    char names[160] = "";
    TRY_ARRAY(residue, structure->residues + 1);
    for (size_t k = 0; k < structure->atoms; k++) {
        const char *const element = mf_mapping_element(structure, k);
        if (element)
            add_atom(&residue[structure->atom[k].residue], &structure->atom[k], element);
    }
    for (size_t k = 0; k < structure->atoms; k++) {
        const struct structure_atom *const atom = &structure->atom[k];
        if (!guessed[k] || strcmp(mf_mapping_element(structure, k), "C") != 0 ||
            !lacks(&residue[atom->residue]))
            continue;
        first = first ? first : atom;
        list_name(names, sizeof names, atom->name);
    }
    if (first == NULL)
        return STATUS_OK;
    return mf_mapping_note(
        mapping,
        "mesofit: warning: the mass of carbon is taken for %s%s%s%s, with fewer hydrogens than it "
        "binds: are these united atoms? Their masses are those of a topology (-s topol.top), or of "
        "\"masses\" of a map",
        names, first->residue_name[0] ? " of \"" : "", first->residue_name,
        first->residue_name[0] ? "\"" : "");
}
