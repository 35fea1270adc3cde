// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/lammps_kinds.h"

#include "base/memory.h"
#include "base/names.h"
#include "topologies/lammps_topology.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A molecule is called by its first atom, the one of the lowest id. All of shape [atoms], or one
/// more.
struct finding {
    const struct lammps_kinds_source *source;
    struct topology *topology;
    struct composition *composition;
    size_t atoms;
    int *root;                                 ///< the molecule of an atom
    int *local;                                ///< its number in that
    int *type;                                 ///< of the composition
    const char *called[COMPOSITION_MAX_TYPES]; ///< a type in the file, if types are named
    size_t *member; ///< atoms, molecule after molecule, ids growing in each
    size_t *begin;  ///< where those of a molecule begin; they end where the next atom's do
    int *kind;      ///< of a molecule; −1: of a single bead, or there is none of that atom
    size_t *term_begin[BONDED_KINDS]; ///< likewise of its terms
    struct topology_term *term[BONDED_KINDS];
};

// Molecules ---------------------------------------------------------------------------------------

static int find_root(int *root, int atom) {
    while (root[atom] != atom)
        atom = root[atom] = root[root[atom]];
    return atom;
}

static void join_atoms(struct finding *finding) {
    int *root = finding->root;
    for (size_t atom = 0; atom < finding->atoms; atom++)
        root[atom] = (int)atom;
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct structure_terms *const terms = &finding->source->structure->terms[order];
        const size_t beads = (size_t)mf_bonded_kinds[order]->beads;
        for (size_t n = 0; n < terms->count * beads; n++) {
            const int a = find_root(root, (int)terms->atom[n - n % beads]);
            const int b = find_root(root, (int)terms->atom[n]);
            root[a > b ? a : b] = a > b ? b : a;
        }
    }
    for (size_t atom = 0; atom < finding->atoms; atom++)
        root[atom] = find_root(root, (int)atom);
}

static void gather_members(struct finding *finding) {
    size_t *begin = finding->begin;
    for (size_t atom = 0; atom < finding->atoms; atom++)
        finding->local[atom] = (int)begin[finding->root[atom] + 1]++;
    for (size_t atom = 0; atom < finding->atoms; atom++)
        begin[atom + 1] += begin[atom];
    for (size_t atom = 0; atom < finding->atoms; atom++)
        finding->member[begin[finding->root[atom]] + (size_t)finding->local[atom]] = atom;
}

static size_t beads_of(const struct finding *finding, size_t molecule) {
    return finding->begin[molecule + 1] - finding->begin[molecule];
}

static int compare_terms(const void *a, const void *b) {
    const struct topology_term *x = a, *y = b;
    for (int k = 0; k < BONDED_MAX_TERM_BEADS; k++)
        if (x->bead[k] != y->bead[k])
            return x->bead[k] < y->bead[k] ? -1 : 1;
    return x->group < y->group ? -1 : x->group > y->group;
}

/// Terms of a molecule name its beads, from the smaller end, in an order that is the same for
/// molecules that are alike.
static enum status gather_terms(struct finding *finding, int order) {
    const struct structure_terms *const terms = &finding->source->structure->terms[order];
    const size_t count = terms->count, beads = (size_t)mf_bonded_kinds[order]->beads;
    OWNED size_t *next = NULL;
    TRY_ARRAY(finding->term_begin[order], finding->atoms + 1);
    TRY_ARRAY(finding->term[order], count);
    TRY_ARRAY(next, finding->atoms);
    size_t *begin = finding->term_begin[order];
    for (size_t n = 0; n < count; n++)
        begin[finding->root[terms->atom[n * beads]] + 1]++;
    for (size_t atom = 0; atom < finding->atoms; atom++) {
        next[atom] = begin[atom];
        begin[atom + 1] += begin[atom];
    }
    for (size_t n = 0; n < count; n++) {
        const uint32_t *const atom = terms->atom + n * beads;
        const bool turned = atom[0] > atom[beads - 1];
        struct topology_term *to = &finding->term[order][next[finding->root[atom[0]]]++];
        to->group = finding->source->group[order][n];
        for (size_t k = 0; k < beads; k++)
            to->bead[k] = finding->local[atom[turned ? beads - 1 - k : k]];
    }
    for (size_t atom = 0; atom < finding->atoms; atom++)
        if (begin[atom + 1] > begin[atom])
            qsort(finding->term[order] + begin[atom], begin[atom + 1] - begin[atom],
                  sizeof **finding->term, compare_terms);
    return STATUS_OK;
}

// Types -------------------------------------------------------------------------------------------

static enum status find_type(struct finding *finding, size_t atom) {
    struct composition *composition = finding->composition;
    char name[COMPOSITION_NAME_SIZE];
    int type = 0;
    const struct structure_atom *const is = &finding->source->structure->atom[atom];
    if (finding->source->named)
        mf_names_adapt(is->name, "_", name, sizeof name);
    else
        snprintf(name, sizeof name, "%lld", (long long)is->type);
    while (type < composition->types && strcmp(composition->name[type], name) != 0)
        type++;
    if (type == COMPOSITION_MAX_TYPES)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: atoms are of more than %d types",
                              finding->source->file, COMPOSITION_MAX_TYPES);
    if (type == composition->types) {
        memcpy(composition->name[composition->types++], name, sizeof name);
        finding->called[type] = is->name;
    }
    if (finding->source->named && strcmp(finding->called[type], is->name) != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: \"%s\" and \"%s\" would both be the type \"%s\": give the "
                              "molecules by a JSON file",
                              finding->source->file, finding->called[type], is->name, name);
    finding->type[atom] = type;
    composition->count[type]++;
    return STATUS_OK;
}

/// Types of single beads come first, as in a scene.
static enum status find_types(struct finding *finding) {
    for (int joined = 0; joined < 2; joined++)
        for (size_t atom = 0; atom < finding->atoms; atom++)
            if ((beads_of(finding, (size_t)finding->root[atom]) > 1) == (joined > 0))
                TRY(find_type(finding, atom));
    return STATUS_OK;
}

// Kinds -------------------------------------------------------------------------------------------

static bool is_of(const struct finding *finding, size_t molecule,
                  const struct topology_kind *kind) {
    if (beads_of(finding, molecule) != (size_t)kind->beads)
        return false;
    for (int bead = 0; bead < kind->beads; bead++)
        if (finding->type[finding->member[finding->begin[molecule] + (size_t)bead]] !=
            kind->type[bead])
            return false;
    for (int order = 0; order < BONDED_KINDS; order++) {
        const size_t *begin = finding->term_begin[order] + molecule;
        if (begin[1] - begin[0] != (size_t)kind->terms[order] ||
            (kind->terms[order] > 0 &&
             memcmp(finding->term[order] + begin[0], kind->term[order],
                    (size_t)kind->terms[order] * sizeof *kind->term[order]) != 0))
            return false;
    }
    return true;
}

static enum status add_kind(struct finding *finding, size_t molecule) {
    struct topology *topology = finding->topology;
    const size_t beads = beads_of(finding, molecule);
    const struct structure *const structure = finding->source->structure;
    const long long id =
        structure->has_ids ? (long long)structure->atom[molecule].id : (long long)molecule + 1;
    if (topology->kinds == TOPOLOGY_MAX_KINDS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the molecule of atom %lld: more than %d kinds",
                              finding->source->file, id, TOPOLOGY_MAX_KINDS);
    if (beads > LAMMPS_MAX_ATOMS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the molecule of atom %lld has %zu atoms; the most are %d",
                              finding->source->file, id, beads, LAMMPS_MAX_ATOMS);
    struct topology_kind *kind = &topology->kind[topology->kinds++];
    *kind = (struct topology_kind){.exclude = finding->source->exclude, .beads = (int)beads};
    snprintf(kind->name, sizeof kind->name, "molecule-%d", topology->kinds);
    TRY_ARRAY(kind->type, beads);
    for (size_t bead = 0; bead < beads; bead++)
        kind->type[bead] = finding->type[finding->member[finding->begin[molecule] + bead]];
    for (int order = 0; order < BONDED_KINDS; order++) {
        const size_t *begin = finding->term_begin[order] + molecule;
        kind->terms[order] = (int)(begin[1] - begin[0]);
        TRY_ARRAY(kind->term[order], kind->terms[order]);
        if (kind->terms[order] > 0)
            memcpy(kind->term[order], finding->term[order] + begin[0],
                   (size_t)kind->terms[order] * sizeof *kind->term[order]);
    }
    return STATUS_OK;
}

static enum status find_kinds(struct finding *finding) {
    struct topology *topology = finding->topology;
    const int first = topology->kinds;
    for (size_t molecule = 0; molecule < finding->atoms; molecule++) {
        int k = first;
        finding->kind[molecule] = -1;
        if (beads_of(finding, molecule) < 2)
            continue;
        while (k < topology->kinds && !is_of(finding, molecule, &topology->kind[k]))
            k++;
        if (k == topology->kinds)
            TRY(add_kind(finding, molecule));
        topology->kind[k].count++;
        finding->kind[molecule] = k;
    }
    return topology->kinds > first ? STATUS_OK
                                   : mf_status_fail(STATUS_BAD_INPUT, "%s: no bond joins any atoms",
                                                    finding->source->file);
}

// Order -------------------------------------------------------------------------------------------

static enum status find_order(const struct finding *finding, size_t **order) {
    size_t next = 0;
    TRY_ARRAY(*order, finding->atoms);
    for (int k = 0; k < finding->topology->kinds; k++)
        for (size_t molecule = 0; molecule < finding->atoms; molecule++)
            for (size_t n = finding->begin[molecule];
                 finding->kind[molecule] == k && n < finding->begin[molecule + 1]; n++)
                (*order)[next++] = finding->member[n];
    for (int type = 0; type < finding->composition->types; type++)
        for (size_t atom = 0; atom < finding->atoms; atom++)
            if (finding->type[atom] == type && beads_of(finding, (size_t)finding->root[atom]) == 1)
                (*order)[next++] = atom;
    return STATUS_OK;
}

static void clear(struct finding *finding) {
    mf_memory_free(finding->root);
    mf_memory_free(finding->local);
    mf_memory_free(finding->type);
    mf_memory_free(finding->member);
    mf_memory_free(finding->begin);
    mf_memory_free(finding->kind);
    for (int order = 0; order < BONDED_KINDS; order++) {
        mf_memory_free(finding->term_begin[order]);
        mf_memory_free(finding->term[order]);
    }
}

enum status mf_lammps_kinds_find(const struct lammps_kinds_source *source,
                                 struct topology *topology, struct composition *composition,
                                 size_t **order) {
    const size_t atoms = source->structure->atoms;
    CLEARED_BY(clear)
    struct finding finding = {
        .source = source, .topology = topology, .composition = composition, .atoms = atoms};
    TRY_ARRAY(finding.root, atoms);
    TRY_ARRAY(finding.local, atoms);
    TRY_ARRAY(finding.type, atoms);
    TRY_ARRAY(finding.member, atoms);
    TRY_ARRAY(finding.begin, atoms + 1);
    TRY_ARRAY(finding.kind, atoms);
    join_atoms(&finding);
    gather_members(&finding);
    for (int n = 0; n < BONDED_KINDS; n++)
        TRY(gather_terms(&finding, n));
    TRY(find_types(&finding));
    TRY(find_kinds(&finding));
    return find_order(&finding, order);
}
