// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/component_sites.h"

#include "base/memory.h"

/// Ids of a type's single beads are after those that are in molecules.
static void find_single(struct component_sites *sites, const struct composition *beads,
                        const struct topology *topology) {
    int64_t end = 0;
    for (int type = 0, c = sites->kinds; c < sites->components.types; type++) {
        const int64_t single = mf_components_single(beads, sites->beads, topology, type);
        end += composition_is_mixed(beads) ? beads->count[type] : (int64_t)sites->beads;
        if (single > 0)
            sites->single[c++] = (uint32_t)(end - single);
    }
}

enum status mf_component_sites_init(struct component_sites *sites, int dimensions,
                                    const struct composition *beads, size_t count,
                                    const struct topology *topology) {
    *sites = (struct component_sites){.kinds = topology ? topology->kinds : 0, .beads = count};
    TRY(mf_components_find(&sites->components, beads, count, topology));
    find_single(sites, beads, topology);
    if (topology)
        TRY(mf_whole_molecules_init(&sites->whole, topology));
    else
        TRY_ARRAY(sites->place, count);
    for (int d = 0; d < dimensions; d++)
        TRY_ARRAY(sites->site[d], mf_composition_particles(&sites->components));
    return STATUS_OK;
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
