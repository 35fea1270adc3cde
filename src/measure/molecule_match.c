// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/molecule_match.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

enum { NO_KIND = -1 };

/// A bead, and where it stands in the trajectory.
struct entry {
    size_t group; ///< its residue or molecule
    size_t atom;  ///< the first of the bead
    size_t bead;  ///< in the mapping
};

struct work {
    struct topology *topology;
    const struct mapping *mapping;
    const char *file;
    struct entry *entry; ///< shape [beads]
    size_t *begin;       ///< shape [groups + 1]: first entry of each
    int *kind;           ///< shape [groups]: NO_KIND for a single bead
    size_t groups;
    int64_t count[TOPOLOGY_MAX_KINDS]; ///< found so far
};

static int by_group(const void *a, const void *b) {
    const struct entry *const x = a, *const y = b;
    if (x->group != y->group)
        return x->group < y->group ? -1 : 1;
    return x->atom < y->atom ? -1 : x->atom > y->atom;
}

static int by_atom(const void *a, const void *b) {
    const struct entry *const x = a, *const y = b;
    return x->atom < y->atom ? -1 : x->atom > y->atom;
}

static size_t type_of(const struct work *work, size_t entry) {
    return work->mapping->bead[work->entry[entry].bead].type;
}

/// Types of the kinds become those of the mapping.
static enum status translate_types(const struct work *work, const struct composition *types) {
    for (int k = 0; k < work->topology->kinds; k++) {
        struct topology_kind *kind = &work->topology->kind[k];
        for (int bead = 0; bead < kind->beads; bead++) {
            const char *name = types->name[kind->type[bead]];
            size_t type = 0;
            while (type < work->mapping->types && strcmp(work->mapping->type_name[type], name) != 0)
                type++;
            if (type == work->mapping->types)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: molecules.%s: no bead of the trajectory is of type "
                                      "\"%s\"",
                                      work->file, kind->name, name);
            kind->type[bead] = (int)type;
        }
    }
    return STATUS_OK;
}

static enum status list_beads(struct work *work) {
    const struct mapping *mapping = work->mapping;
    TRY_ARRAY(work->entry, mapping->beads);
    TRY_ARRAY(work->begin, mapping->beads + 1);
    TRY_ARRAY(work->kind, mapping->beads);
    for (size_t k = 0; k < mapping->beads; k++)
        work->entry[k] = (struct entry){.group = mapping->bead[k].molecule,
                                        .atom = mapping->atom[mapping->bead[k].first],
                                        .bead = k};
    return STATUS_OK;
}

// By residues -------------------------------------------------------------------------------------

/// Whether a kind has as many beads of each type as a group, whose order then becomes the kind's.
static bool take_group(struct work *work, size_t group, const struct topology_kind *kind) {
    const size_t first = work->begin[group], beads = work->begin[group + 1] - first;
    if (beads != (size_t)kind->beads)
        return false;
    for (size_t n = 0; n < beads; n++) {
        size_t k = first + n;
        while (k < first + beads && type_of(work, k) != (size_t)kind->type[n])
            k++;
        if (k == first + beads)
            return false;
        const struct entry found = work->entry[k];
        memmove(&work->entry[first + n + 1], &work->entry[first + n],
                (k - first - n) * sizeof found);
        work->entry[first + n] = found;
    }
    return true;
}

static bool has_capacity(const struct work *work, int k) {
    const int64_t wanted = work->topology->kind[k].count;
    return wanted == 0 || work->count[k] < wanted;
}

/// Whether there are all molecules, and some of each kind.
static bool is_complete(const struct work *work) {
    for (int k = 0; k < work->topology->kinds; k++)
        if (work->count[k] == 0 || work->count[k] < work->topology->kind[k].count)
            return false;
    return true;
}

static bool match_groups(struct work *work) {
    qsort(work->entry, work->mapping->beads, sizeof *work->entry, by_group);
    for (size_t k = 0; k < work->mapping->beads; k++)
        if (k == 0 || work->entry[k].group != work->entry[k - 1].group)
            work->begin[work->groups++] = k;
    work->begin[work->groups] = work->mapping->beads;
    for (size_t group = 0; group < work->groups; group++) {
        int k = 0;
        while (k < work->topology->kinds &&
               !(has_capacity(work, k) && take_group(work, group, &work->topology->kind[k])))
            k++;
        work->kind[group] = k < work->topology->kinds ? k : NO_KIND;
        if (work->kind[group] != NO_KIND)
            work->count[k]++;
        else if (work->begin[group + 1] - work->begin[group] > 1)
            return false;
    }
    return is_complete(work);
}

// In the order of atoms ---------------------------------------------------------------------------

static enum status fail_bead(const struct work *work, size_t entry, int k, int bead) {
    const struct topology_kind *kind = &work->topology->kind[k];
    if (entry >= work->mapping->beads)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: molecules.%s: the trajectory ends with bead %d of number %lld",
                              work->file, kind->name, bead, (long long)work->count[k] + 1);
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: molecules.%s: bead %d of number %lld would be the bead of atom %zu, which is of type "
        "\"%s\" and not \"%s\"",
        work->file, kind->name, bead + 1, (long long)work->count[k] + 1,
        work->entry[entry].atom + 1, work->mapping->type_name[type_of(work, entry)],
        work->mapping->type_name[kind->type[bead]]);
}

static enum status match_in_order(struct work *work) {
    const size_t beads = work->mapping->beads;
    const struct topology *topology = work->topology;
    size_t at = 0;
    work->groups = 0;
    memset(work->count, 0, sizeof work->count);
    qsort(work->entry, beads, sizeof *work->entry, by_atom);
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        const int64_t wanted = kind->count;
        if (wanted == 0 && topology->kinds > 1)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: molecules.%s: residues of the trajectory do not match; "
                                  "\"count\" is the number of consecutive molecules",
                                  work->file, kind->name);
        for (; wanted == 0 ? at < beads : work->count[k] < wanted; work->count[k]++) {
            for (int bead = 0; bead < kind->beads; bead++)
                if (at + (size_t)bead >= beads ||
                    type_of(work, at + (size_t)bead) != (size_t)kind->type[bead])
                    return fail_bead(work, at + (size_t)bead, k, bead);
            work->begin[work->groups] = at;
            work->kind[work->groups++] = k;
            at += (size_t)kind->beads;
        }
    }
    for (; at < beads; at++) {
        work->begin[work->groups] = at;
        work->kind[work->groups++] = NO_KIND;
    }
    work->begin[work->groups] = beads;
    return STATUS_OK;
}

// Ids ---------------------------------------------------------------------------------------------

static void keep_counts(struct work *work) {
    for (int k = 0; k < work->topology->kinds; k++)
        work->topology->kind[k].count = work->count[k];
}

/// The ids of molecules' beads, and of single ones after them.
static enum status number_beads(const struct work *work, const struct composition *composition,
                                struct molecule_match *match) {
    int64_t found[TOPOLOGY_MAX_KINDS] = {0};
    size_t single[COMPOSITION_MAX_TYPES] = {0};
    TRY_ARRAY(match->bead, work->mapping->beads);
    for (int type = 0; type < composition->types; type++)
        for (int before = 0; before <= type; before++)
            single[type] += (size_t)composition->count[before];
    for (size_t group = work->groups; group-- > 0;) { // single beads from the end
        const size_t entry = work->begin[group];
        if (work->kind[group] == NO_KIND)
            match->bead[--single[type_of(work, entry)]] = work->entry[entry].bead;
    }
    for (size_t group = 0; group < work->groups; group++) {
        const int k = work->kind[group];
        if (k == NO_KIND)
            continue;
        const struct topology_kind *kind = &work->topology->kind[k];
        for (int bead = 0; bead < kind->beads; bead++)
            match->bead[topology_id(kind, found[k], bead)] =
                work->entry[work->begin[group] + (size_t)bead].bead;
        found[k]++;
    }
    return STATUS_OK;
}

enum status mf_molecule_match(struct molecule_match *match, struct topology *topology,
                              const struct composition *types, const struct mapping *mapping,
                              const struct composition *composition, const char *file) {
    enum status status = STATUS_OK;
    struct work work = {.topology = topology, .mapping = mapping, .file = file};
    *match = (struct molecule_match){0};
    CHECK(translate_types(&work, types));
    CHECK(list_beads(&work));
    if (!match_groups(&work))
        CHECK(match_in_order(&work));
    keep_counts(&work);
    CHECK(mf_topology_complete(topology, composition));
    CHECK(number_beads(&work, composition, match));
done:
    mf_memory_free(work.entry);
    mf_memory_free(work.begin);
    mf_memory_free(work.kind);
    if (status != STATUS_OK)
        mf_molecule_match_clear(match);
    return status;
}

void mf_molecule_match_clear(struct molecule_match *match) {
    mf_memory_free(match->bead);
    *match = (struct molecule_match){0};
}
