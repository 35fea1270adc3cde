// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/topology.h"

#include "base/memory.h"
#include "base/names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool mf_topology_is_name(const char *name) {
    return mf_names_is_plain(name, "_-", TOPOLOGY_NAME_SIZE) && !mf_names_is_reserved(name);
}

// Checks ------------------------------------------------------------------------------------------

/// Whether two terms are of the same beads, in either direction.
static bool are_same(const struct topology_term *a, const struct topology_term *b, int beads) {
    bool forward = true, backward = true;
    for (int k = 0; k < beads; k++) {
        forward &= a->bead[k] == b->bead[k];
        backward &= a->bead[k] == b->bead[beads - 1 - k];
    }
    return forward || backward;
}

void mf_topology_name_term(const struct topology_term *term, int order,
                           char text[TOPOLOGY_TERM_SIZE]) {
    size_t length = 0;
    for (int k = 0; k < mf_bonded_kinds[order]->beads; k++)
        length += (size_t)snprintf(text + length, TOPOLOGY_TERM_SIZE - length, "%s%d", k ? "-" : "",
                                   term->bead[k] + 1);
}

static enum status check_beads(const struct topology_kind *kind, int order,
                               const struct topology_term *term, const char *name) {
    const int beads = mf_bonded_kinds[order]->beads;
    for (int k = 0; k < beads; k++) {
        if (term->bead[k] < 0 || term->bead[k] >= kind->beads)
            return mf_status_fail(
                STATUS_BAD_INPUT, "the %s %s has a bead %d, which is not there: beads are 1 to %d",
                mf_bonded_kinds[order]->name, name, term->bead[k] + 1, kind->beads);
        for (int other = 0; other < k; other++)
            if (term->bead[other] == term->bead[k])
                return mf_status_fail(STATUS_BAD_INPUT, "the %s %s has a bead twice",
                                      mf_bonded_kinds[order]->name, name);
    }
    return STATUS_OK;
}

enum status mf_topology_check_term(const struct topology_kind *kind, int order, int n) {
    const struct topology_term *term = &kind->term[order][n];
    const int beads = mf_bonded_kinds[order]->beads;
    char name[TOPOLOGY_TERM_SIZE];
    mf_topology_name_term(term, order, name);
    TRY(check_beads(kind, order, term, name));
    for (int m = 0; m < n; m++) {
        const struct topology_term *other = &kind->term[order][m];
        if (are_same(term, other, beads) && (order == BONDED_BOND || term->group == other->group))
            return mf_status_fail(STATUS_BAD_INPUT, "duplicate %s %s", mf_bonded_kinds[order]->name,
                                  name);
    }
    return STATUS_OK;
}

enum status mf_topology_check(const struct topology_kind *kind) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < kind->terms[order]; n++)
            TRY(mf_topology_check_term(kind, order, n));
    return STATUS_OK;
}

static bool are_bonded(const struct topology_kind *kind, int a, int b) {
    const struct topology_term wanted = {.bead = {a, b}};
    for (int n = 0; n < kind->terms[BONDED_BOND]; n++)
        if (are_same(&kind->term[BONDED_BOND][n], &wanted, 2))
            return true;
    return false;
}

const struct topology_term *mf_topology_unbonded(const struct topology_kind *kind, int *order,
                                                 int pair[2]) {
    for (*order = 0; *order < BONDED_KINDS; ++*order) {
        const struct bonded_kind *of = mf_bonded_kinds[*order];
        for (int n = 0; n < kind->terms[*order]; n++)
            for (int k = 0; k + 1 < of->beads; k++) {
                const struct topology_term *term = &kind->term[*order][n];
                memcpy(pair, term->bead + k, 2 * sizeof *pair);
                if (of->chain[k + 1] == of->chain[k] + 1 && !are_bonded(kind, pair[0], pair[1]))
                    return term;
            }
    }
    return NULL;
}

// What is excluded --------------------------------------------------------------------------------

enum status mf_topology_bonds(const struct topology_kind *kind, struct topology_bonds *bonds) {
    const int count = kind->terms[BONDED_BOND];
    const struct topology_term *term = kind->term[BONDED_BOND];
    TRY_ARRAY(bonds->start, kind->beads + 2);
    TRY_ARRAY(bonds->to, 2 * count);
    int *next = bonds->start + 1; // of each bead; they end as starts
    for (int n = 0; n < count; n++)
        for (int k = 0; k < 2; k++)
            next[term[n].bead[k] + 1]++;
    for (int bead = 0; bead < kind->beads; bead++)
        next[bead + 1] += next[bead];
    for (int n = 0; n < count; n++)
        for (int k = 0; k < 2; k++)
            bonds->to[next[term[n].bead[k]]++] = term[n].bead[1 - k];
    return STATUS_OK;
}

static int compare_beads(const void *a, const void *b) {
    const int x = *(const int *)a, y = *(const int *)b;
    return x < y ? -1 : x > y;
}

/// A search along the bonds of a kind.
struct search {
    struct topology_bonds bonds;
    int *distance; ///< shape [beads]: −1 of all between two searches
    int *reached;  ///< shape [beads]
};

static enum status search_begin(struct search *search, const struct topology_kind *kind) {
    *search = (struct search){0};
    TRY_ARRAY(search->distance, kind->beads);
    TRY_ARRAY(search->reached, kind->beads);
    TRY(mf_topology_bonds(kind, &search->bonds));
    memset(search->distance, 0xff, (size_t)kind->beads * sizeof *search->distance);
    return STATUS_OK;
}

static void search_end(struct search *search) {
    mf_memory_free(search->distance);
    mf_memory_free(search->reached);
    mf_memory_free(search->bonds.start);
    mf_memory_free(search->bonds.to);
}

/// The beads at most kind->exclude bonds from one, by growing number, after it in `reached`.
static int reach(const struct topology_kind *kind, struct search *search, int bead) {
    const struct topology_bonds *bonds = &search->bonds;
    int *distance = search->distance, *reached = search->reached, count = 1;
    reached[0] = bead;
    distance[bead] = 0;
    for (int n = 0; n < count && distance[reached[n]] < kind->exclude; n++)
        for (int k = bonds->start[reached[n]]; k < bonds->start[reached[n] + 1]; k++) {
            const int to = bonds->to[k];
            if (distance[to] >= 0)
                continue;
            distance[to] = distance[reached[n]] + 1;
            reached[count++] = to;
        }
    for (int n = 0; n < count; n++)
        distance[reached[n]] = -1;
    qsort(reached + 1, (size_t)count - 1, sizeof *reached, compare_beads);
    return count - 1;
}

/// The beads at most `exclude` bonds from each.
static enum status find_near(struct topology_kind *kind) {
    enum status status = STATUS_OK;
    struct search search;
    CHECK(search_begin(&search, kind));
    NEW_ARRAY(kind->near_start, kind->beads + 1);
    for (int pass = 0; pass < 2; pass++) {
        int found = 0;
        for (int bead = 0; bead < kind->beads; bead++) {
            const int count = reach(kind, &search, bead);
            if (pass == 1)
                memcpy(kind->near + found, search.reached + 1,
                       (size_t)count * sizeof *search.reached);
            found += count;
            kind->near_start[bead + 1] = found;
        }
        if (pass == 0)
            NEW_ARRAY(kind->near, found);
    }
done:
    search_end(&search);
    return status;
}

/// The order of the beads says nothing: snapshots have them by type.
static enum status find_ends(struct topology_kind *kind) {
    struct topology_bonds bonds;
    int found = 0, end[2] = {0};
    TRY(mf_topology_bonds(kind, &bonds));
    for (int bead = 0; bead < kind->beads; bead++) {
        if (bonds.start[bead + 1] - bonds.start[bead] != 1)
            continue;
        if (found < 2)
            end[found] = bead;
        found++;
    }
    kind->end[0] = found == 2 ? end[0] : 0;
    kind->end[1] = found == 2 ? end[1] : kind->beads - 1;
    mf_memory_free(bonds.start);
    mf_memory_free(bonds.to);
    return STATUS_OK;
}

enum status mf_topology_find_disconnected(const struct topology_kind *kind, int *bead) {
    enum status status = STATUS_OK;
    struct search search;
    struct topology_kind whole = *kind;
    *bead = -1;
    whole.exclude = kind->beads;
    CHECK(search_begin(&search, kind));
    const int others = reach(&whole, &search, 0);
    if (others + 1 < kind->beads)
        for (*bead = 1; *bead <= others && search.reached[*bead] == *bead;)
            ++*bead;
done:
    search_end(&search);
    return status;
}

enum status mf_topology_count_excluded(const struct topology_kind *kind, int exclude,
                                       size_t *count) {
    struct topology_kind other = *kind;
    other.exclude = exclude;
    other.near = other.near_start = NULL;
    const enum status status = find_near(&other);
    *count = status == STATUS_OK ? (size_t)other.near_start[kind->beads] : 0;
    mf_memory_free(other.near);
    mf_memory_free(other.near_start);
    return status;
}

// Numbers of beads --------------------------------------------------------------------------------

/// Ids of a kind's beads, given the next one of each type, which go on.
static enum status number_beads(struct topology_kind *kind, int64_t next[COMPOSITION_MAX_TYPES]) {
    int64_t of_type[COMPOSITION_MAX_TYPES] = {0};
    TRY_ARRAY(kind->id, kind->beads);
    TRY_ARRAY(kind->step, kind->beads);
    for (int bead = 0; bead < kind->beads; bead++)
        kind->id[bead] = (uint32_t)(next[kind->type[bead]] + of_type[kind->type[bead]]++);
    for (int bead = 0; bead < kind->beads; bead++)
        kind->step[bead] = (uint32_t)of_type[kind->type[bead]];
    for (int type = 0; type < COMPOSITION_MAX_TYPES; type++)
        next[type] += of_type[type] * kind->count;
    return STATUS_OK;
}

/// By id: molecules, and how many pairs each bead is excluded from.
static void enter_molecules(struct topology *topology) {
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int bead = 0; bead < kind->beads; bead++) {
                const uint32_t id = topology_id(kind, m, bead);
                topology->molecule[id] = (uint32_t)(kind->first + m);
                topology->excluded_start[id + 1] =
                    (size_t)(kind->near_start[bead + 1] - kind->near_start[bead]);
            }
    }
    uint32_t next = (uint32_t)topology->molecules;
    for (size_t id = 0; id < topology->particles; id++) {
        if (topology->molecule[id] == UINT32_MAX)
            topology->molecule[id] = next++;
        topology->excluded_start[id + 1] += topology->excluded_start[id];
    }
}

static void enter_excluded(struct topology *topology) {
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int bead = 0; bead < kind->beads; bead++) {
                size_t at = topology->excluded_start[topology_id(kind, m, bead)];
                for (int n = kind->near_start[bead]; n < kind->near_start[bead + 1]; n++)
                    topology->excluded[at++] = topology_id(kind, m, kind->near[n]);
            }
    }
}

enum status mf_topology_complete(struct topology *topology, const struct composition *composition) {
    int64_t next[COMPOSITION_MAX_TYPES] = {0};
    for (int type = 1; type < composition->types; type++)
        next[type] = next[type - 1] + composition->count[type - 1];
    topology->particles = (size_t)mf_composition_particles(composition);
    for (int k = 0; k < topology->kinds; k++) {
        topology->kind[k].first = topology->molecules;
        topology->molecules += topology->kind[k].count;
        TRY(number_beads(&topology->kind[k], next));
        TRY(find_near(&topology->kind[k]));
        TRY(find_ends(&topology->kind[k]));
    }
    TRY_ARRAY(topology->molecule, topology->particles);
    memset(topology->molecule, 0xff, topology->particles * sizeof *topology->molecule);
    TRY_ARRAY(topology->excluded_start, topology->particles + 1);
    enter_molecules(topology);
    const size_t excluded = topology->excluded_start[topology->particles];
    TRY_ARRAY(topology->excluded, excluded);
    topology->excludes = excluded > 0;
    enter_excluded(topology);
    return STATUS_OK;
}

int mf_topology_beads_of(const struct topology_kind *kind, int type) {
    int beads = 0;
    for (int bead = 0; bead < kind->beads; bead++)
        beads += kind->type[bead] == type;
    return beads;
}

double mf_topology_intramolecular_pairs(const struct topology *topology, const int type[2],
                                        bool excluded) {
    double pairs = 0;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        int own = 0;
        for (int bead = 0; bead < kind->beads; bead++) {
            if (kind->type[bead] != type[0])
                continue;
            own += excluded ? 0 : mf_topology_beads_of(kind, type[1]) - (type[0] == type[1]);
            for (int n = kind->near_start[bead]; excluded && n < kind->near_start[bead + 1]; n++)
                own += kind->type[kind->near[n]] == type[1];
        }
        pairs += (double)kind->count * own;
    }
    return pairs;
}

void mf_topology_walk(const struct topology_kind *kind, int *order, int *parent) {
    int placed = 0;
    for (int bead = 0; bead < kind->beads; bead++)
        parent[bead] = -2; // not yet
    while (placed < kind->beads) {
        int next = -1, from = -1;
        for (int n = 0; n < kind->terms[BONDED_BOND] && next < 0; n++) {
            const int *pair = kind->term[BONDED_BOND][n].bead;
            for (int k = 0; k < 2 && next < 0; k++)
                if (parent[pair[k]] > -2 && parent[pair[1 - k]] == -2) {
                    from = pair[k];
                    next = pair[1 - k];
                }
        }
        for (int bead = 0; bead < kind->beads && next < 0; bead++)
            next = parent[bead] == -2 ? bead : -1;
        parent[next] = from;
        order[placed++] = next;
    }
}

size_t mf_topology_terms(const struct topology *topology, int order) {
    size_t terms = 0;
    for (int k = 0; k < topology->kinds; k++)
        terms += (size_t)topology->kind[k].terms[order] * (size_t)topology->kind[k].count;
    return terms;
}

void mf_topology_kind_clear(struct topology_kind *kind) {
    mf_memory_free(kind->type);
    for (int order = 0; order < BONDED_KINDS; order++)
        mf_memory_free(kind->term[order]);
    mf_memory_free(kind->id);
    mf_memory_free(kind->step);
    mf_memory_free(kind->near_start);
    mf_memory_free(kind->near);
    *kind = (struct topology_kind){0};
}

void mf_topology_clear(struct topology *topology) {
    for (int k = 0; k < topology->kinds; k++)
        mf_topology_kind_clear(&topology->kind[k]);
    mf_memory_free(topology->molecule);
    mf_memory_free(topology->excluded_start);
    mf_memory_free(topology->excluded);
    *topology = (struct topology){0};
}

int mf_topology_reach(const struct topology_kind *kind) {
    int reach = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        if (kind->terms[order] > 0 && mf_bonded_kinds[order]->reach > reach)
            reach = mf_bonded_kinds[order]->reach;
    return reach;
}
