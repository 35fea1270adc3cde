// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/structure.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum status mf_structure_init(struct structure *structure, size_t atoms) {
    *structure = (struct structure){.atoms = atoms};
    structure->atom = mf_memory_zeroed(atoms, sizeof *structure->atom);
    if (structure->atom == NULL)
        return STATUS_NO_MEMORY;
    for (size_t k = 0; k < atoms; k++)
        structure->atom[k].mass = NAN;
    return STATUS_OK;
}

void mf_structure_clear(struct structure *structure) {
    mf_memory_free(structure->atom);
    for (int kind = 0; kind < STRUCTURE_TERM_KINDS; kind++) {
        mf_memory_free(structure->terms[kind].atom);
        mf_memory_free(structure->terms[kind].type);
        mf_memory_free(structure->terms[kind].name);
    }
    *structure = (struct structure){0};
}

static int by_id(const void *a, const void *b) {
    const int64_t x = ((const struct structure_atom *)a)->id;
    const int64_t y = ((const struct structure_atom *)b)->id;
    return x < y ? -1 : x > y;
}

enum status mf_structure_sort(struct structure *structure) {
    qsort(structure->atom, structure->atoms, sizeof *structure->atom, by_id);
    for (size_t k = 1; k < structure->atoms; k++)
        if (structure->atom[k].id == structure->atom[k - 1].id)
            return mf_status_fail(STATUS_BAD_INPUT, "two atoms have the id %lld",
                                  (long long)structure->atom[k].id);
    return STATUS_OK;
}

static bool is_same_residue(const struct structure_atom *a, const struct structure_atom *b) {
    return a->residue_number == b->residue_number && a->chain == b->chain &&
           a->molecule == b->molecule && strcmp(a->residue_name, b->residue_name) == 0;
}

static int by_molecule(const void *a, const void *b) {
    const struct structure_atom *const x = *(const struct structure_atom *const *)a;
    const struct structure_atom *const y = *(const struct structure_atom *const *)b;
    if (x->molecule != y->molecule)
        return x->molecule < y->molecule ? -1 : 1;
    return x < y ? -1 : x > y;
}

static enum status number_molecules(struct structure *structure) {
    OWNED struct structure_atom **sorted = NULL;
    TRY_ARRAY(sorted, structure->atoms);
    for (size_t k = 0; k < structure->atoms; k++)
        sorted[k] = &structure->atom[k];
    qsort(sorted, structure->atoms, sizeof *sorted, by_molecule);
    for (size_t k = 0; k < structure->atoms; k++) {
        const bool goes_on =
            k > 0 && sorted[k]->molecule != 0 && sorted[k]->molecule == sorted[k - 1]->molecule;
        structure->residues += !goes_on;
        sorted[k]->residue = structure->residues - 1;
    }
    return STATUS_OK;
}

enum status mf_structure_number_residues(struct structure *structure) {
    structure->residues = 0;
    if (!structure->has_residues)
        return structure->has_molecules ? number_molecules(structure) : STATUS_OK;
    for (size_t k = 0; k < structure->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        structure->residues += k == 0 || !is_same_residue(atom, atom - 1);
        atom->residue = structure->residues - 1;
    }
    return STATUS_OK;
}

/// The first atom of a molecule, which stands for it; the way there is halved for the next time.
static size_t find_root(size_t *root, size_t k) {
    for (; root[k] != k; k = root[k])
        root[k] = root[root[k]];
    return k;
}

enum status mf_structure_join(struct structure *structure, const uint32_t (*bond)[2],
                              size_t bonds) {
    OWNED size_t *root = NULL;
    TRY_ARRAY(root, structure->atoms);
    for (size_t k = 0; k < structure->atoms; k++)
        root[k] = k;
    for (size_t n = 0; n < bonds; n++) {
        if (bond[n][0] >= structure->atoms || bond[n][1] >= structure->atoms)
            return mf_status_fail(STATUS_BAD_INPUT, "bond %zu is of the atoms %lu and %lu of %zu",
                                  n + 1, (unsigned long)bond[n][0] + 1,
                                  (unsigned long)bond[n][1] + 1, structure->atoms);
        const size_t a = find_root(root, bond[n][0]), b = find_root(root, bond[n][1]);
        root[a < b ? b : a] = a < b ? a : b;
        structure->atom[bond[n][0]].molecule = structure->atom[bond[n][1]].molecule = 1;
    }
    for (size_t k = 0; k < structure->atoms; k++)
        if (structure->atom[k].molecule != 0)
            structure->atom[k].molecule = (int64_t)find_root(root, k) + 1;
    structure->has_molecules = true;
    return STATUS_OK;
}

size_t mf_structure_find(const struct structure *structure, int64_t id) {
    const struct structure_atom *const atom = structure->atom;
    size_t begin = 0, end = structure->atoms;
    if (end == 0 || id < atom[0].id || id > atom[end - 1].id)
        return structure->atoms;
    const size_t guess = (size_t)(id - atom[0].id); // where ids have no gaps
    if (guess < end && atom[guess].id == id)
        return guess;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (atom[middle].id < id)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin < structure->atoms && atom[begin].id == id ? begin : structure->atoms;
}

enum status mf_structure_check_same(const struct structure *structure, const char *file,
                                    const struct structure *other, const char *other_file) {
    if (structure->atoms != other->atoms)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: has %zu atoms, %s has %zu", other_file,
                              other->atoms, file, structure->atoms);
    const bool names = structure->has_names && other->has_names && structure->names == other->names;
    const bool residues = structure->has_residues && other->has_residues;
    const bool ids = structure->has_ids && other->has_ids;
    for (size_t k = 0; k < structure->atoms; k++) {
        const struct structure_atom *const a = &structure->atom[k], *const b = &other->atom[k];
        if (ids && a->id != b->id)
            return mf_status_fail(STATUS_BAD_INPUT, "%s: atom %zu has the id %lld, in %s %lld",
                                  other_file, k + 1, (long long)b->id, file, (long long)a->id);
        if ((names && strcmp(a->name, b->name) != 0) ||
            (residues && strcmp(a->residue_name, b->residue_name) != 0))
            return mf_status_fail(
                STATUS_BAD_INPUT, "%s: atom %zu is called \"%s\" of \"%s\", in %s \"%s\" of \"%s\"",
                other_file, k + 1, b->name, b->residue_name, file, a->name, a->residue_name);
    }
    return STATUS_OK;
}
