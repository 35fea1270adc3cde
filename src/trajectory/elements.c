// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/elements.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

static const struct element {
    char symbol[4];
    double mass;
} elements[] = {
    {"H", 1.008},   {"He", 4.0026}, {"Li", 6.94},   {"Be", 9.0122}, {"B", 10.81},   {"C", 12.011},
    {"N", 14.007},  {"O", 15.999},  {"F", 18.998},  {"Ne", 20.180}, {"Na", 22.990}, {"Mg", 24.305},
    {"Al", 26.982}, {"Si", 28.085}, {"P", 30.974},  {"S", 32.06},   {"Cl", 35.45},  {"Ar", 39.95},
    {"K", 39.098},  {"Ca", 40.078}, {"Sc", 44.956}, {"Ti", 47.867}, {"V", 50.942},  {"Cr", 51.996},
    {"Mn", 54.938}, {"Fe", 55.845}, {"Co", 58.933}, {"Ni", 58.693}, {"Cu", 63.546}, {"Zn", 65.38},
    {"Ga", 69.723}, {"Ge", 72.630}, {"As", 74.922}, {"Se", 78.971}, {"Br", 79.904}, {"Kr", 83.798},
    {"Rb", 85.468}, {"Sr", 87.62},  {"Y", 88.906},  {"Zr", 91.224}, {"Nb", 92.906}, {"Mo", 95.95},
    {"Tc", 97},     {"Ru", 101.07}, {"Rh", 102.91}, {"Pd", 106.42}, {"Ag", 107.87}, {"Cd", 112.41},
    {"In", 114.82}, {"Sn", 118.71}, {"Sb", 121.76}, {"Te", 127.60}, {"I", 126.90},  {"Xe", 131.29},
    {"Cs", 132.91}, {"Ba", 137.33}, {"La", 138.91}, {"Ce", 140.12}, {"Pr", 140.91}, {"Nd", 144.24},
    {"Pm", 145},    {"Sm", 150.36}, {"Eu", 151.96}, {"Gd", 157.25}, {"Tb", 158.93}, {"Dy", 162.50},
    {"Ho", 164.93}, {"Er", 167.26}, {"Tm", 168.93}, {"Yb", 173.05}, {"Lu", 174.97}, {"Hf", 178.49},
    {"Ta", 180.95}, {"W", 183.84},  {"Re", 186.21}, {"Os", 190.23}, {"Ir", 192.22}, {"Pt", 195.08},
    {"Au", 196.97}, {"Hg", 200.59}, {"Tl", 204.38}, {"Pb", 207.2},  {"Bi", 208.98}, {"Th", 232.04},
    {"Pa", 231.04}, {"U", 238.03},
};

static const struct element *find(const char *symbol) {
    for (size_t k = 0; k < sizeof elements / sizeof *elements; k++)
        if (strcmp(elements[k].symbol, symbol) == 0)
            return &elements[k];
    return NULL;
}

double mf_elements_mass(const char *symbol) {
    const struct element *const element = find(symbol);
    return element ? element->mass : NAN;
}

const char *mf_elements_symbol(const char *name) {
    return find(name) ? name : "X";
}

/// The symbol of the first `letters` letters, as it is written.
static const struct element *find_letters(const char *name, size_t letters) {
    char symbol[4] = {(char)toupper((unsigned char)name[0])};
    if (letters == 2)
        symbol[1] = (char)tolower((unsigned char)name[1]);
    return find(symbol);
}

/// Two letters that are an element in whatever molecule they stand. Those that begin with C, H, N,
/// O, P or S are mostly such an atom and where it stands in its molecule, as CA, HG and NE of amino
/// acids or PB of ATP.
static bool are_symbol(const char *letters) {
    static const char *const others[] = {"CL", "CU", "NI", "PT", "SE", "SI", "SR"};
    if (strchr("CHNOPS", toupper((unsigned char)letters[0])) == NULL)
        return true;
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (strncasecmp(letters, others[k], 2) == 0)
            return true;
    return false;
}

/// An atom that is a residue of its own is an ion, or of a gas: its letters are all a symbol. Where
/// of a protein one atom is left, it is CA.
static bool is_ion(const struct structure_atom *atom, const char *letters, bool alone) {
    const size_t of_residue = strcspn(atom->residue_name, "0123456789+-");
    if (of_residue == 2 && strncasecmp(letters, atom->residue_name, 2) == 0)
        return true;
    return alone &&
           (strncasecmp(letters, "CA", 2) != 0 || strncasecmp(atom->residue_name, "CA", 2) == 0 ||
            strncasecmp(atom->residue_name, "ION", 3) == 0);
}

const char *mf_elements_guess(const struct structure_atom *atom, bool alone) {
    const char *const name = atom->name + strspn(atom->name, "0123456789'\"*+-");
    const size_t letters = strcspn(name, "0123456789'\"*+-_");
    const struct element *element = find(atom->element);
    if (element == NULL)
        element = find(name);
    if (element == NULL && letters == 2 && (are_symbol(name) || is_ion(atom, name, alone)))
        element = find_letters(name, 2);
    if (element == NULL && letters > 0)
        element = find_letters(name, 1);
    return element ? element->symbol : NULL;
}
