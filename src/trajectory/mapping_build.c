// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/mapping.h"

#include "base/memory.h"

#include <string.h>

/// What is known while beads are found.
struct work {
    struct mapping *mapping;
    const struct mapping_plan *plan;
    const struct structure *structure;
    size_t residues;
    size_t *first;  ///< shape [residues + 1]: where a residue begins in `member`
    size_t *member; ///< shape [atoms]: atoms by residue
    bool *taken;    ///< shape [atoms]: belongs to a bead
    size_t used;    ///< atoms that belong to beads
    size_t model[MAPPING_MAX_BEADS + 1]; ///< of a type without a name: a residue of it
};

/// Sort the atoms by residue, keeping their order; without residues each is one.
static enum status sort_residues(struct work *work) {
    const struct structure *const structure = work->structure;
    const bool known = structure->residues > 0;
    work->residues = known ? structure->residues : structure->atoms;
    TRY_ARRAY(work->first, work->residues + 2);
    TRY_ARRAY(work->member, structure->atoms);
    size_t *const next = work->first + 1;
    for (size_t k = 0; k < structure->atoms; k++)
        next[(known ? structure->atom[k].residue : k) + 1]++;
    for (size_t r = 0; r < work->residues; r++)
        next[r + 1] += next[r];
    for (size_t k = 0; k < structure->atoms; k++)
        work->member[next[known ? structure->atom[k].residue : k]++] = k;
    return STATUS_OK;
}

static enum status fail_atom(const struct work *work, size_t atom, const char *what) {
    const struct structure_atom *const a = &work->structure->atom[atom];
    return mf_status_fail(STATUS_BAD_INPUT, "%s: atom %zu, \"%s\" of residue %lld \"%s\", %s",
                          work->plan->file, atom + 1, a->name, (long long)a->residue_number,
                          a->residue_name, what);
}

/// Whether two residues have atoms of the same names in the same order.
static bool are_alike(const struct work *work, size_t a, size_t b) {
    const size_t *const first = work->first;
    const size_t count = first[a + 1] - first[a];
    if (first[b + 1] - first[b] != count)
        return false;
    for (size_t i = 0; i < count; i++)
        if (strcmp(work->structure->atom[work->member[first[a] + i]].name,
                   work->structure->atom[work->member[first[b] + i]].name) != 0)
            return false;
    return true;
}

/// Number of a type, which is new or was there: types are told apart by their names or, where the
/// file has no names of residues, by the names of their atoms. @param[in] name  or ""
static size_t find_type(struct work *work, const char *name, size_t residue) {
    struct mapping *const mapping = work->mapping;
    size_t type = 0;
    while (type < mapping->types &&
           (strcmp(mapping->type_name[type], name) != 0 ||
            (name[0] == '\0' && !are_alike(work, work->model[type], residue))))
        type++;
    if (type == mapping->types) {
        work->model[type] = residue;
        snprintf(mapping->type_name[mapping->types++], STRUCTURE_NAME, "%.*s", STRUCTURE_NAME - 1,
                 name);
    }
    return type;
}

/// What the plan calls a bead's type or, in its absence, the file: by its residue's name, or that
/// of an atom alone. "": nobody names it.
static const char *name_type(const struct work *work, const struct mapping_entry *entry,
                             const struct structure_atom *atom, size_t residue) {
    const bool alone = work->first[residue + 1] - work->first[residue] == 1;
    if (entry->type[0])
        return entry->type;
    return atom->residue_name[0] || !alone ? atom->residue_name : atom->name;
}

/// Begin a bead whose atoms follow, of a residue or of a molecule that begins with it.
static enum status begin_bead_of(struct work *work, const char *name, size_t residue) {
    struct mapping *const mapping = work->mapping;
    const size_t type = find_type(work, name, residue);
    if (mapping->types > MAPPING_MAX_BEADS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: more than %d types of beads; a map (--map) makes fewer",
                              work->plan->file, MAPPING_MAX_BEADS);
    mapping->bead[mapping->beads++] =
        (struct mapping_bead){.first = work->used, .type = type, .molecule = residue};
    return STATUS_OK;
}

static enum status begin_bead(struct work *work, const struct mapping_entry *entry, size_t atom) {
    const struct structure_atom *const a = &work->structure->atom[atom];
    const size_t residue = work->structure->residues ? a->residue : atom;
    return begin_bead_of(work, name_type(work, entry, a, residue), residue);
}

static enum status add_atom(struct work *work, size_t atom) {
    struct mapping *const mapping = work->mapping;
    if (work->taken[atom])
        return fail_atom(work, atom, "belongs to two beads");
    work->taken[atom] = true;
    mapping->atom[work->used++] = atom;
    mapping->bead[mapping->beads - 1].count++;
    return STATUS_OK;
}

static void end_bead(struct work *work, const struct mapping_entry *entry) {
    struct mapping_bead *const bead = &work->mapping->bead[work->mapping->beads - 1];
    bead->weighted = entry->centre == MAPPING_CENTRE_OF_GEOMETRY;
    for (size_t i = 0; bead->weighted && i < bead->count; i++)
        work->mapping->weight[bead->first + i] = 1.0 / (double)bead->count;
}

static enum status take_range(struct work *work, const struct mapping_entry *entry) {
    if ((uint64_t)entry->last > work->structure->atoms)
        return mf_status_fail(
            STATUS_BAD_INPUT, "%s: \"%s\" includes atom %lld, but there are %zu atoms",
            work->plan->file, entry->key, (long long)entry->last, work->structure->atoms);
    for (int64_t k = entry->first - 1; k < entry->last; k++) {
        if ((k - entry->first + 1) % entry->size == 0)
            TRY(begin_bead(work, entry, (size_t)k));
        TRY(add_atom(work, (size_t)k));
        if ((k - entry->first + 2) % entry->size == 0)
            end_bead(work, entry);
    }
    return STATUS_OK;
}

/// Add the atom of that name, which the residue must have once.
static enum status add_named(struct work *work, size_t residue, const struct word *name) {
    const struct structure *const structure = work->structure;
    size_t found = 0, atom = 0;
    for (size_t i = work->first[residue]; i < work->first[residue + 1]; i++)
        if (mf_words_same(name, structure->atom[work->member[i]].name)) {
            atom = work->member[i];
            found++;
        }
    if (found == 1)
        return add_atom(work, atom);
    const struct structure_atom *const any = &structure->atom[work->member[work->first[residue]]];
    return mf_status_fail(
        STATUS_BAD_INPUT, "%s: residue %lld \"%s\" (atom %zu) has %zu atoms \"%.*s\"",
        work->plan->file, (long long)any->residue_number, any->residue_name,
        work->member[work->first[residue]] + 1, found, (int)name->length, name->begin);
}

static enum status take_residue(struct work *work, const struct mapping_entry *entry,
                                size_t residue) {
    const char *names = entry->atoms;
    struct word name;
    TRY(begin_bead(work, entry, work->member[work->first[residue]]));
    if (entry->atoms[0] == '\0')
        for (size_t i = work->first[residue]; i < work->first[residue + 1]; i++)
            TRY(add_atom(work, work->member[i]));
    else
        while (mf_words_next(&names, &name))
            TRY(add_named(work, residue, &name));
    end_bead(work, entry);
    return STATUS_OK;
}

/// All residues of a name have as many atoms: another number is a broken file, or another molecule.
static enum status check_alike(const struct work *work, const struct mapping_entry *entry,
                               size_t model, size_t residue) {
    const size_t *const first = work->first;
    const size_t has = first[residue + 1] - first[residue];
    const size_t should = first[model + 1] - first[model];
    const struct structure_atom *const a = &work->structure->atom[work->member[first[residue]]];
    if (has == should || entry->residue[0] == '\0')
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: residue %lld \"%s\" (atom %zu) has %zu atoms, the first of its name "
                          "has %zu",
                          work->plan->file, (long long)a->residue_number, a->residue_name,
                          work->member[first[residue]] + 1, has, should);
}

static enum status take_residues(struct work *work, const struct mapping_entry *entry) {
    size_t model = work->residues;
    for (size_t r = 0; r < work->residues; r++) {
        const struct structure_atom *const a = &work->structure->atom[work->member[work->first[r]]];
        if (entry->residue[0] && strcmp(entry->residue, a->residue_name) != 0)
            continue;
        if (model == work->residues)
            model = r;
        TRY(check_alike(work, entry, model, r));
        TRY(take_residue(work, entry, r));
    }
    if (model == work->residues)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: \"%s\": there is no residue \"%s\"%s",
                              work->plan->file, entry->key, entry->residue,
                              work->structure->has_residues
                                  ? ""
                                  : ": these atoms have no residues; a .gro or .pdb by -s has");
    return STATUS_OK;
}

/// The first molecule of the plan whose residues begin here, or NULL.
static const struct mapping_molecule *find_molecule(const struct work *work, size_t residue) {
    const struct mapping_plan *const plan = work->plan;
    for (size_t k = 0; k < plan->molecules; k++) {
        const struct mapping_molecule *const molecule = &plan->molecule[k];
        size_t same = 0;
        while (same < molecule->residues && residue + same < work->residues) {
            const char *const name = plan->residue[molecule->first_residue + same];
            const size_t atom = work->member[work->first[residue + same]];
            if (name[0] && strcmp(name, work->structure->atom[atom].residue_name) != 0)
                break;
            same++;
        }
        if (same == molecule->residues)
            return molecule;
    }
    return NULL;
}

static enum status take_molecule(struct work *work, const struct mapping_molecule *molecule,
                                 size_t residue) {
    const struct mapping_plan *const plan = work->plan;
    for (size_t k = 0; k < molecule->parts; k++) {
        const struct mapping_part *const part = &plan->part[molecule->first_part + k];
        TRY(begin_bead_of(work, part->type, residue));
        struct mapping_bead *const bead = &work->mapping->bead[work->mapping->beads - 1];
        bead->weighted = true;
        for (size_t i = 0; i < part->count; i++) {
            const struct mapping_member *const member = &plan->member[part->first + i];
            const struct word name = {member->name, strlen(member->name)};
            TRY(add_named(work, residue + member->residue, &name));
            work->mapping->weight[work->used - 1] = member->weight;
        }
    }
    return STATUS_OK;
}

/// Fails: BAD_INPUT for a molecule of the plan that is not there.
static enum status check_molecules(const struct work *work, const bool *found) {
    const struct mapping_plan *const plan = work->plan;
    for (size_t k = 0; k < plan->molecules; k++) {
        const struct mapping_molecule *const molecule = &plan->molecule[k];
        const char *const name = plan->residue[molecule->first_residue];
        if (!found[k])
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: molecule \"%s\": there is no residue \"%s\"%s%s", plan->file,
                                  molecule->name, name,
                                  molecule->residues > 1 ? " that its other residues follow" : "",
                                  work->structure->has_residues
                                      ? ""
                                      : ": these atoms have no residues; a .gro or .pdb by -s has");
    }
    return STATUS_OK;
}

/// Molecules after each other; residues that begin none are left out.
static enum status take_molecules(struct work *work) {
    OWNED bool *found = NULL;
    TRY_ARRAY(found, work->plan->molecules);
    for (size_t r = 0; r < work->residues;) {
        const struct mapping_molecule *const molecule = find_molecule(work, r);
        if (molecule) {
            TRY(take_molecule(work, molecule, r));
            found[molecule - work->plan->molecule] = true;
        }
        r += molecule ? molecule->residues : 1;
    }
    return check_molecules(work, found);
}

static bool is_used(const struct mapping *mapping, const char *name) {
    for (size_t type = 0; type < mapping->types; type++)
        if (strcmp(mapping->type_name[type], name) == 0)
            return true;
    return false;
}

/// Types that nobody names are A, B and so on, but for what others are called.
static void name_rest(struct mapping *mapping) {
    int next = 0;
    for (size_t type = 0; type < mapping->types; type++)
        for (char *const name = mapping->type_name[type]; name[0] == '\0';) {
            char free[STRUCTURE_NAME];
            snprintf(free, sizeof free, next < 26 ? "%c" : "A%d", next < 26 ? 'A' + next : next);
            if (!is_used(mapping, free))
                memcpy(name, free, sizeof free);
            next++;
        }
}

static enum status find_rest(const struct work *work) {
    size_t atom = 0;
    if (work->plan->ignores_rest)
        return STATUS_OK;
    while (atom < work->structure->atoms && work->taken[atom])
        atom++;
    if (atom == work->structure->atoms)
        return STATUS_OK;
    return fail_atom(work, atom, "belongs to no bead; \"rest\": \"ignore\" leaves such atoms out");
}

static bool is_broken(const struct work *work) {
    for (size_t k = 0; k < work->mapping->beads; k++) {
        const struct mapping_bead *const bead = &work->mapping->bead[k];
        const size_t *const first = work->first + bead->molecule;
        if (bead->count < first[1] - first[0])
            return true;
    }
    return false;
}

enum status mf_mapping_build(struct mapping *mapping, const struct mapping_plan *plan,
                             const struct structure *structure) {
    enum status status = STATUS_OK;
    struct work work = {.mapping = mapping, .plan = plan, .structure = structure};
    const size_t atoms = structure->atoms;
    NEW_ARRAY(mapping->type_name, MAPPING_MAX_BEADS + 1);
    NEW_ARRAY(mapping->bead, atoms + 1); // one more: a bead is begun before an atom is found taken
    NEW_ARRAY(mapping->atom, atoms);
    NEW_ARRAY(mapping->weight, atoms);
    NEW_ARRAY(work.taken, atoms);
    CHECK(sort_residues(&work));
    for (size_t k = 0; k < plan->entries; k++)
        CHECK(plan->entry[k].first ? take_range(&work, &plan->entry[k])
                                   : take_residues(&work, &plan->entry[k]));
    if (plan->molecules > 0)
        CHECK(take_molecules(&work));
    CHECK(find_rest(&work));
    name_rest(mapping);
    mapping->broken = is_broken(&work);
done:
    mf_memory_free(work.taken);
    mf_memory_free(work.first);
    mf_memory_free(work.member);
    return status;
}
