// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/rng.h"
#include "forces/molecules_growth.h"

/// Where molecules and single beads begin, by their numbers.
struct starts {
    struct particles particles;
    uint32_t *site; ///< shape [count]: particle that stands for each number
};

static enum status grow_kind(const struct growth *growth, const struct starts *starts,
                             struct particles *particles, uint64_t seed) {
    const struct topology_kind *kind = growth->kind;
    OWNED double(*place)[3] = NULL;
    TRY_ARRAY(place, kind->beads);
    for (int64_t m = 0; m < kind->count; m++) {
        const uint32_t molecule = (uint32_t)(kind->first + m), site = starts->site[molecule];
        mf_molecules_growth_draw(growth, seed, molecule, place);
        for (int bead = 0; bead < kind->beads; bead++)
            for (int d = 0; d < particles->box.dimensions; d++)
                particles->position[d][topology_id(kind, m, bead)] =
                    starts->particles.position[d][site] + place[bead][d];
    }
    return STATUS_OK;
}

static enum status place_starts(struct starts *starts, const struct placement *placement,
                                uint64_t seed) {
    struct particles *particles = &starts->particles;
    TRY_ARRAY(starts->site, particles->count);
    TRY(mf_placement_fill(particles, placement, seed));
    if (placement->kind != PLACEMENT_RANDOM)
        mf_placement_mix(particles, seed);
    mf_placement_tilt(particles, placement->bias.tilt, seed);
    for (size_t k = 0; k < particles->count; k++)
        starts->site[particles->id[k]] = (uint32_t)k;
    return STATUS_OK;
}

enum status mf_molecules_place(const struct molecules *molecules, const struct pair_law *law,
                               struct particles *particles, const struct placement *placement,
                               uint64_t seed) {
    enum status status = STATUS_OK;
    const struct topology *topology = &molecules->topology;
    struct starts starts = {0};
    size_t count = (size_t)topology->molecules;
    for (size_t id = 0; id < topology->particles; id++)
        count += topology->molecule[id] >= topology->molecules;
    CHECK(mf_particles_init(&starts.particles, &particles->box, count));
    CHECK(place_starts(&starts, placement, seed));
    for (int k = 0; k < topology->kinds; k++) {
        CLEARED_BY(mf_molecules_growth_clear) struct growth growth = {0};
        CHECK(mf_molecules_growth_init(&growth, molecules, &topology->kind[k], law,
                                       particles->box.dimensions));
        growth.stretch = placement->bias.stretch;
        CHECK(grow_kind(&growth, &starts, particles, seed));
    }
    for (size_t id = 0; id < topology->particles; id++)
        for (int d = 0; d < particles->box.dimensions; d++)
            if (topology->molecule[id] >= topology->molecules)
                particles->position[d][id] =
                    starts.particles.position[d][starts.site[topology->molecule[id]]];
    mf_particles_wrap(particles);
    mf_particles_update_fractions(particles);
done:
    mf_particles_clear(&starts.particles);
    mf_memory_free(starts.site);
    return status;
}
