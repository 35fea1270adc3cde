// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/mapping.h"

#include "base/memory.h"
#include "base/names.h"
#include "trajectory/elements.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/// Add a line to the notes.
__attribute__((format(printf, 2, 3))) MUST_USE static enum status note(struct mapping *mapping,
                                                                       const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const enum status status = mf_source_note(&mapping->notes, format, arguments);
    va_end(arguments);
    return status;
}

/// The element that an atom seems to be, or NULL.
static const char *element_of(const struct structure *structure, size_t k) {
    const struct structure_atom *const atom = &structure->atom[k];
    const bool alone = structure->residues > 0 && (k == 0 || atom[-1].residue != atom->residue) &&
                       (k + 1 == structure->atoms || atom[1].residue != atom->residue);
    return mf_elements_guess(atom, alone);
}

// United atoms ------------------------------------------------------------------------------------

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

/// Warn of carbons that seem to have their hydrogens in them.
static enum status warn_of_united(struct mapping *mapping, const struct structure *structure,
                                  const bool *guessed) {
    OWNED struct residue *residue = NULL;
    const struct structure_atom *first = NULL;
    char names[160] = "";
    TRY_ARRAY(residue, structure->residues + 1);
    for (size_t k = 0; k < structure->atoms; k++) {
        const char *const element = element_of(structure, k);
        if (element)
            add_atom(&residue[structure->atom[k].residue], &structure->atom[k], element);
    }
    for (size_t k = 0; k < structure->atoms; k++) {
        const struct structure_atom *const atom = &structure->atom[k];
        if (!guessed[k] || strcmp(element_of(structure, k), "C") != 0 ||
            !lacks(&residue[atom->residue]))
            continue;
        first = first ? first : atom;
        list_name(names, sizeof names, atom->name);
    }
    if (first == NULL)
        return STATUS_OK;
    return note(
        mapping,
        "mesofit: warning: the mass of carbon is taken for %s%s%s%s, with fewer hydrogens than it "
        "binds: are these united atoms? Their masses are those of a topology (-s topol.top), or of "
        "\"masses\" of a map",
        names, first->residue_name[0] ? " of \"" : "", first->residue_name,
        first->residue_name[0] ? "\"" : "");
}

// Masses ------------------------------------------------------------------------------------------

/// Mass of an atom and who says so.
enum origin { FROM_PLAN, FROM_FILE, FROM_ELEMENT, FROM_NOBODY };

/// A mass of 0 is that of a site without any, as M of TIP4P; in a file where all are 0 it is none.
static bool has_masses(const struct structure *structure) {
    for (size_t k = 0; k < structure->atoms; k++)
        if (structure->atom[k].mass > 0)
            return true;
    return false;
}

static enum origin find_mass(const struct mapping_plan *plan, const struct structure *structure,
                             bool from_file, size_t number, double *mass) {
    const struct structure_atom *const atom = &structure->atom[number];
    for (size_t k = 0; k < plan->masses; k++)
        if (strcmp(plan->mass[k].name, atom->name) == 0) {
            *mass = plan->mass[k].mass;
            return FROM_PLAN;
        }
    *mass = atom->mass;
    if (from_file && atom->mass >= 0)
        return FROM_FILE;
    const char *const element = element_of(structure, number);
    *mass = element ? mf_elements_mass(element) : NAN;
    return element ? FROM_ELEMENT : FROM_NOBODY;
}

/// What has been guessed once need not be reported again: few names make up a liquid.
enum { MAX_REPORTED = 64 };
struct reported {
    const struct structure_atom *atom[MAX_REPORTED];
    size_t count;
    bool from_file; ///< the file knows masses
    bool *guessed;  ///< shape [atoms]
};

static bool was_reported(struct reported *reported, const struct structure_atom *atom) {
    for (size_t k = 0; k < reported->count; k++)
        if (strcmp(reported->atom[k]->name, atom->name) == 0 &&
            strcmp(reported->atom[k]->residue_name, atom->residue_name) == 0)
            return true;
    if (reported->count == MAX_REPORTED)
        return true;
    reported->atom[reported->count++] = atom;
    return false;
}

static enum status note_guess(struct mapping *mapping, struct reported *reported,
                              const struct structure *structure, size_t k, double mass) {
    const struct structure_atom *const atom = &structure->atom[k];
    if (was_reported(reported, atom))
        return STATUS_OK;
    if (reported->count == MAX_REPORTED)
        return note(mapping, "masses of further names were guessed, too");
    return note(mapping, "guessed by its name: \"%s\"%s%s%s is %s, %g u", atom->name,
                atom->residue_name[0] ? " of \"" : "", atom->residue_name,
                atom->residue_name[0] ? "\"" : "", element_of(structure, k), mass);
}

/// Whether given weights are those of masses, as 16 1 1 of water: a bead's velocity is then that of
/// its centre of mass, but for the share by which they differ.
static bool moves_with_mass(const struct mapping *mapping, const struct mapping_plan *plan,
                            const struct structure *structure, const struct mapping_bead *bead,
                            const struct reported *reported) {
    static const double share = 0.01;
    for (size_t i = 0; bead->weighted && bead->count > 1 && i < bead->count; i++) {
        double mass;
        (void)find_mass(plan, structure, reported->from_file, mapping->atom[bead->first + i],
                        &mass);
        if (!(fabs(mapping->weight[bead->first + i] - mass / bead->mass) < share))
            return false;
    }
    return true;
}

/// The mass of a bead, and the weights of its atoms if these are not those of geometry. The weight
/// of an atom alone is 1, whatever its mass; atoms none of which has a mass weigh the same.
static enum status weigh_bead(struct mapping *mapping, const struct mapping_plan *plan,
                              const struct structure *structure, struct mapping_bead *bead,
                              struct reported *reported) {
    double *const weight = &mapping->weight[bead->first];
    const bool by_mass = !bead->weighted;
    for (size_t i = 0; i < bead->count; i++) {
        const size_t k = mapping->atom[bead->first + i];
        double mass;
        const enum origin origin = find_mass(plan, structure, reported->from_file, k, &mass);
        if (origin == FROM_NOBODY && by_mass && bead->count > 1)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: unknown mass of atom %zu, \"%s\": give it in \"masses\" of "
                                  "the map (0 for a site without mass)",
                                  plan->file, k + 1, structure->atom[k].name);
        reported->guessed[k] = origin == FROM_ELEMENT;
        if (origin == FROM_ELEMENT)
            TRY(note_guess(mapping, reported, structure, k, mass));
        bead->mass += mass;
        if (by_mass)
            weight[i] = bead->count > 1 ? mass : 1;
    }
    mapping->off_mass =
        mapping->off_mass || !moves_with_mass(mapping, plan, structure, bead, reported);
    mapping->broken = mapping->broken || mapping->off_mass;
    const bool without = bead->mass == 0;
    for (size_t i = 0; by_mass && bead->count > 1 && i < bead->count; i++)
        weight[i] = without ? 1 / (double)bead->count : weight[i] / bead->mass;
    if (!without)
        return STATUS_OK;
    bead->mass = NAN; // none that a simulation could have
    const struct structure_atom *const first = &structure->atom[mapping->atom[bead->first]];
    return was_reported(reported, first)
               ? STATUS_OK
               : note(mapping,
                      "the bead of \"%s\" has no mass: it is at the centre of "
                      "geometry, and its temperature is not known",
                      first->name);
}

/// Find the masses of beads, and the weights for centres of mass; note what was guessed.
static enum status find_masses(struct mapping *mapping, const struct mapping_plan *plan,
                               const struct structure *structure) {
    struct reported reported = {.from_file = has_masses(structure)};
    OWNED bool *guessed = NULL;
    TRY_ARRAY(guessed, structure->atoms);
    reported.guessed = guessed;
    for (size_t k = 0; k < mapping->beads; k++)
        TRY(weigh_bead(mapping, plan, structure, &mapping->bead[k], &reported));
    return warn_of_united(mapping, structure, guessed);
}

/// Note how many beads of which type there are, of how many atoms.
static enum status note_beads(struct mapping *mapping) {
    size_t k = 0;
    for (size_t type = 0; type < mapping->types; type++) {
        const size_t begin = k;
        size_t least = mapping->bead[begin].count, most = least;
        for (; k < mapping->beads && mapping->bead[k].type == type; k++) {
            least = mapping->bead[k].count < least ? mapping->bead[k].count : least;
            most = mapping->bead[k].count > most ? mapping->bead[k].count : most;
        }
        const struct mapping_bead *first = &mapping->bead[begin];
        char mass[64] = "of unknown mass: nothing names residues and atoms (-s)";
        if (isfinite(first->mass))
            snprintf(mass, sizeof mass, "the first of %.6g u", first->mass);
        if (least < most)
            TRY(note(mapping,
                     "mesofit: warning: %s: %zu beads of %zu to %zu atoms: a bead is a residue "
                     "(name and number) unless --map says more: does the file number them?",
                     mapping->type_name[type], k - begin, least, most));
        else
            TRY(note(mapping, "%s: %zu beads of %zu atom%s, %s", mapping->type_name[type],
                     k - begin, most, most == 1 ? "" : "s", mass));
    }
    return STATUS_OK;
}

/// Order of beads: by type, then by their first atoms.
static int by_type(const void *a, const void *b) {
    const struct mapping_bead *const x = a, *const y = b;
    if (x->type != y->type)
        return x->type < y->type ? -1 : 1;
    return x->first < y->first ? -1 : x->first > y->first;
}

enum status mf_mapping_init(struct mapping *mapping, const struct mapping_plan *plan,
                            const struct structure *structure) {
    enum status status;
    *mapping = (struct mapping){.atoms = structure->atoms};
    CHECK(mf_mapping_build(mapping, plan, structure));
    CHECK(find_masses(mapping, plan, structure));
    qsort(mapping->bead, mapping->beads, sizeof *mapping->bead, by_type);
    CHECK(note_beads(mapping));
done:
    if (status != STATUS_OK)
        mf_mapping_clear(mapping);
    return status;
}

/// The type that is called as an atom; `count` if none is.
static size_t type_of_name(const struct structure_atom *atom, const char *const *types,
                           size_t count) {
    char name[STRUCTURE_NAME];
    size_t type = 0;
    mf_names_adapt(atom->name, "_", name, sizeof name);
    while (type < count && strcmp(types[type], atom->name) != 0 && strcmp(types[type], name) != 0)
        type++;
    return type;
}

/// Whether a type is called as any atom is: names then tell all types, and numbers none.
static bool names_tell(const struct structure *structure, const char *const *types, size_t count) {
    bool tell = false;
    for (size_t k = 0; k < structure->atoms && !tell; k++)
        tell = type_of_name(&structure->atom[k], types, count) < count;
    return tell;
}

/// The type of an atom of another name: of types that are called by numbers, that of its number;
/// else the type that is of this number in their order; `count` if it has none.
static size_t type_of_number(const struct structure_atom *atom, const char *const *types,
                             size_t count, bool *by_number) {
    char number[32];
    snprintf(number, sizeof number, "%lld", (long long)atom->type);
    for (size_t type = 0; type < count; type++)
        if (strcmp(types[type], number) == 0)
            return type;
    *by_number = true;
    return atom->type >= 1 && (uint64_t)atom->type <= count ? (size_t)atom->type - 1 : count;
}

static enum status take_atoms(struct mapping *mapping, const struct structure *structure,
                              const char *const *types, const double *mass, const char *file) {
    OWNED bool *told = NULL;
    const bool named = names_tell(structure, types, mapping->types);
    TRY_ARRAY(told, mapping->types + 1);
    for (size_t k = 0; k < structure->atoms; k++) {
        const struct structure_atom *const atom = &structure->atom[k];
        bool by_number = false;
        const size_t type = named ? type_of_name(atom, types, mapping->types)
                                  : type_of_number(atom, types, mapping->types, &by_number);
        if (type == mapping->types)
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: no type has the name of atom %zu, \"%s\"; %smap atoms to beads by --map%s",
                file, k + 1, atom->name, named ? "add it to \"particles.types\", or " : "",
                atom->name[0] ? "" : ", or name atoms by a structure, -s FILE");
        if (by_number && !told[type] && structure->names != STRUCTURE_TYPES) {
            told[type] = true;
            TRY(note(mapping,
                     "%s: atoms \"%s\" of type number %zu are beads \"%s\", the type of "
                     "that number: no type is called \"%s\"",
                     file, atom->name, type + 1, types[type], atom->name));
        }
        mapping->atom[k] = k;
        mapping->weight[k] = 1;
        mapping->bead[mapping->beads++] =
            (struct mapping_bead){.first = k,
                                  .count = 1,
                                  .type = type,
                                  .molecule = structure->residues ? atom->residue : k,
                                  .mass = isnan(atom->mass) ? mass[type] : atom->mass};
    }
    return STATUS_OK;
}

/// Each type has a bead, the beads being in their order.
static enum status check_types(const struct mapping *mapping, const char *file) {
    size_t k = 0;
    for (size_t type = 0; type < mapping->types; type++) {
        const size_t begin = k;
        while (k < mapping->beads && mapping->bead[k].type == type)
            k++;
        if (k == begin)
            return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no atom of the type \"%s\"", file,
                                  mapping->type_name[type]);
    }
    return STATUS_OK;
}

enum status mf_mapping_init_atoms(struct mapping *mapping, const struct structure *structure,
                                  const char *const *types, const double *mass, size_t count,
                                  const char *file) {
    enum status status = STATUS_OK;
    *mapping = (struct mapping){.atoms = structure->atoms, .types = count};
    NEW_ARRAY(mapping->type_name, count);
    NEW_ARRAY(mapping->bead, structure->atoms);
    NEW_ARRAY(mapping->atom, structure->atoms);
    NEW_ARRAY(mapping->weight, structure->atoms);
    for (size_t type = 0; type < count; type++)
        snprintf(mapping->type_name[type], STRUCTURE_NAME, "%.*s", STRUCTURE_NAME - 1, types[type]);
    CHECK(take_atoms(mapping, structure, types, mass, file));
    qsort(mapping->bead, mapping->beads, sizeof *mapping->bead, by_type);
    CHECK(check_types(mapping, file));
    mapping->broken = structure->residues > 0 && structure->residues < structure->atoms;
    CHECK(note_beads(mapping));
done:
    if (status != STATUS_OK)
        mf_mapping_clear(mapping);
    return status;
}

void mf_mapping_clear(struct mapping *mapping) {
    mf_memory_free(mapping->type_name);
    mf_memory_free(mapping->bead);
    mf_memory_free(mapping->atom);
    mf_memory_free(mapping->weight);
    mf_source_free(&mapping->notes);
    *mapping = (struct mapping){0};
}
