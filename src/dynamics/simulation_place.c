// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation_place.h"

#include "forces/molecules.h"
#include "system/orientation.h"

/// Orientations, if an interaction is about them.
static enum status give_orientations(struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    const struct interaction *oriented = mf_simulation_oriented(setup);
    if (oriented == NULL)
        return STATUS_OK;
    if (setup->box.dimensions != 2)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "interactions.%s: orientations are of two dimensions, not %d",
                              oriented->name, setup->box.dimensions);
    if (setup->integrator->orientation_mobility == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "interactions.%s: \"%s\" turns no orientations; use \"brownian\"",
                              oriented->name, setup->integrator->name);
    return mf_orientation_give(&simulation->particles, setup->seed);
}

/// Positions of the scene's placement.
static enum status place_particles(struct simulation *simulation,
                                   const struct simulation_start *start) {
    const struct simulation_setup *setup = &simulation->setup;
    struct particles *particles = &simulation->particles;
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    if (molecules && setup->placement.kind != PLACEMENT_FILE)
        return mf_molecules_place(molecules, &simulation->law, particles, &setup->placement,
                                  setup->seed);
    switch ((enum placement_kind)setup->placement.kind) {
    case PLACEMENT_LATTICE:
        TRY(mf_placement_fill(particles, &setup->placement, setup->seed));
        if (composition_is_mixed(&setup->composition))
            mf_placement_mix(particles, setup->seed);
        mf_placement_tilt(particles, setup->placement.bias.tilt, setup->seed);
        break;
    case PLACEMENT_RANDOM:
        TRY(mf_placement_fill(particles, &setup->placement, setup->seed));
        break;
    case PLACEMENT_FILE:
        for (int d = 0; d < setup->box.dimensions; d++)
            memcpy(particles->position[d], start->position[d],
                   particles->count * sizeof *particles->position[d]);
        break;
    }
    return STATUS_OK;
}

enum status mf_simulation_place(struct simulation *simulation,
                                const struct simulation_start *start) {
    const struct simulation_setup *setup = &simulation->setup;
    struct particles *particles = &simulation->particles;
    TRY(place_particles(simulation, start));
    TRY(mf_attributes_give(particles, setup->attribute, &setup->composition, setup->seed));
    TRY(give_orientations(simulation));
    simulation->velocities_drawn = start == NULL || start->velocity[0] == NULL;
    if (simulation->velocities_drawn) {
        mf_particles_draw_velocities(particles, (enum particles_speeds)setup->placement.speeds,
                                     setup->temperature, setup->seed);
        return STATUS_OK;
    }
    for (int d = 0; d < setup->box.dimensions; d++)
        memcpy(particles->velocity[d], start->velocity[d],
               particles->count * sizeof *particles->velocity[d]);
    return STATUS_OK;
}
