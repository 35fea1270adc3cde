// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/components.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

// Which there are ---------------------------------------------------------------------------------

/// Beads of a type that are in molecules.
static int64_t count_bound(const struct topology *topology, int type) {
    int64_t bound = 0;
    for (int k = 0; topology && k < topology->kinds; k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            bound += topology->kind[k].type[bead] == type ? topology->kind[k].count : 0;
    return bound;
}

/// Returns false if there are too many.
static bool add(struct composition *components, const char *name, int64_t sites) {
    if (components->types == COMPOSITION_MOST_TYPES)
        return false;
    snprintf(components->name[components->types], COMPOSITION_NAME_SIZE, "%.*s",
             COMPOSITION_NAME_SIZE - 1, name);
    components->count[components->types++] = sites;
    return true;
}

static enum status fail_of_many(void) {
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "kinds of molecules and types of single beads are more than %d components",
        COMPOSITION_MOST_TYPES);
}

/// Two pairs of one name, as those of a kind and a type that are called alike.
static enum status check_names(const struct composition *components) {
    const int pairs = mf_composition_pairs(components);
    for (int pair = 0; pair < pairs; pair++) {
        int type[2];
        char name[2][COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_types(components, pair, type);
        for (int k = 0; k < 2; k++)
            snprintf(name[k], sizeof name[k], "%s-%s", components->name[type[k]],
                     components->name[type[1 - k]]);
        for (int other = pair + 1; other < pairs; other++) {
            char its[COMPOSITION_PAIR_NAME_SIZE];
            mf_composition_pair_name(components, other, its);
            if (strcmp(its, name[0]) == 0 || strcmp(its, name[1]) == 0)
                return mf_status_fail(
                    STATUS_BAD_INPUT,
                    "\"%s\" would be two pairs of components, which are the kinds "
                    "of molecules and the types of single beads: call a kind "
                    "differently",
                    its);
        }
    }
    return STATUS_OK;
}

enum status mf_components_find(struct composition *components, const struct composition *beads,
                               size_t count, const struct topology *topology) {
    const int types = composition_is_mixed(beads) ? beads->types : 1;
    const char *longest = "";
    *components = (struct composition){0};
    for (int k = 0; topology && k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        if (!add(components, kind->name, kind->count))
            return fail_of_many();
        longest = strlen(kind->name) > strlen(longest) ? kind->name : longest;
    }
    for (int type = 0; type < types; type++) {
        const int64_t all = types > 1 ? beads->count[type] : (int64_t)count;
        const int64_t single = all - count_bound(topology, type);
        if (single > 0 && !add(components, beads->name[type], single))
            return fail_of_many();
    }
    if (!composition_is_mixed(components))
        return STATUS_OK;
    if (strlen(longest) >= COMPOSITION_NAME_SIZE)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "the kind of molecules \"%s\" is a component, whose name has up to %d "
            "characters",
            longest, COMPOSITION_NAME_SIZE - 1);
    return check_names(components);
}

// Where their sites are ---------------------------------------------------------------------------

/// Ids of a type's single beads are behind those that are in molecules.
static void find_single(struct component_sites *sites, const struct composition *beads,
                        const struct topology *topology) {
    const int types = composition_is_mixed(beads) ? beads->types : 1;
    int component = sites->kinds;
    int64_t next = 0;
    for (int type = 0; type < types; type++) {
        const int64_t bound = count_bound(topology, type);
        if (component < sites->components.types && (types == 1 || beads->count[type] > bound))
            sites->single[component++] = (uint32_t)(next + bound);
        next += beads->count[type];
    }
}

enum status mf_component_sites_init(struct component_sites *sites, int dimensions,
                                    const struct composition *beads, size_t count,
                                    const struct topology *topology) {
    enum status status = STATUS_OK;
    *sites = (struct component_sites){.kinds = topology ? topology->kinds : 0, .beads = count};
    CHECK(mf_components_find(&sites->components, beads, count, topology));
    find_single(sites, beads, topology);
    if (topology)
        CHECK(mf_whole_molecules_init(&sites->whole, topology));
    else
        NEW_ARRAY(sites->place, count);
    for (int d = 0; d < dimensions; d++)
        NEW_ARRAY(sites->site[d], mf_composition_particles(&sites->components));
done:
    return status;
}

void mf_component_sites_clear(struct component_sites *sites) {
    mf_whole_molecules_clear(&sites->whole);
    mf_memory_free(sites->place);
    for (int d = 0; d < 3; d++)
        mf_memory_free(sites->site[d]);
    *sites = (struct component_sites){0};
}

/// Mean places of a kind's molecules, as sites from `first` on.
static void find_means(struct component_sites *sites, const struct particles *particles, int k,
                       size_t first) {
    const struct topology_kind *kind = &sites->whole.topology->kind[k];
    for (int64_t m = 0; m < kind->count; m++) {
        const size_t begin = particles->place[topology_id(kind, m, 0)];
        mf_whole_molecules_make(&sites->whole, particles, k, m);
        for (int d = 0; d < particles->box.dimensions; d++) {
            double sum = 0;
            for (int bead = 0; bead < kind->beads; bead++)
                sum += sites->whole.place[bead][d];
            sites->site[d][first + (size_t)m] = particles->position[d][begin] + sum / kind->beads;
        }
    }
}

/// Where each id is.
static const uint32_t *find_places(struct component_sites *sites,
                                   const struct particles *particles) {
    if (sites->place == NULL)
        return particles->place;
    for (size_t k = 0; k < sites->beads; k++)
        sites->place[particles->id[k]] = (uint32_t)k;
    return sites->place;
}

void mf_component_sites_find(struct component_sites *sites, const struct particles *particles) {
    const uint32_t *place = find_places(sites, particles);
    size_t first = 0;
    for (int c = 0; c < sites->components.types; c++) {
        const size_t count = (size_t)sites->components.count[c];
        if (c < sites->kinds)
            find_means(sites, particles, c, first);
        for (int d = 0; d < particles->box.dimensions && c >= sites->kinds; d++)
            for (size_t k = 0; k < count; k++)
                sites->site[d][first + k] = particles->position[d][place[sites->single[c] + k]];
        first += count;
    }
}
