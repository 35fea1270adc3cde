// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where beads begin among plates and an obstacle, of which their placement knows nothing.
#include "dynamics/solvent.h"

#include <math.h>

static bool is_inside(const struct solvent *solvent, const struct particles *beads, size_t k) {
    double position[3] = {0};
    for (int d = 0; d < beads->box.dimensions; d++)
        position[d] = beads->position[d][k];
    return !mf_solvent_is_free(solvent, position);
}

static enum status check_file(const struct solvent *solvent, const struct particles *beads) {
    for (size_t k = 0; k < beads->count; k++) {
        if (is_inside(solvent, beads, k))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "particles.file: particle %u begins inside the obstacle",
                                  beads->id[k]);
        // What a file puts there has been wrapped into the box.
        if (solvent->parameters.walls == COLLISION_PLATES && beads->image[1][k] != 0)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "particles.file: particle %u begins beyond a plate",
                                  beads->id[k]);
    }
    return STATUS_OK;
}

/// Whether a place is outside the obstacle, and farther from all other beads than a distance.
static bool is_room(const struct solvent *solvent, const struct particles *beads, size_t bead,
                    const double place[3], double distance) {
    if (!mf_solvent_is_free(solvent, place))
        return false;
    for (size_t k = 0; k < beads->count; k++) {
        double square = 0;
        for (int d = 0; d < beads->box.dimensions; d++) {
            const double apart =
                box_nearest(place[d] - beads->position[d][k], beads->box.length[d]);
            square += apart * apart;
        }
        if (k != bead && square < distance * distance)
            return false;
    }
    return true;
}

/// The distance from others shrinks from trial to trial, down to the least that is wanted.
static enum status move_out(const struct solvent *solvent, struct particles *beads, size_t bead,
                            double least) {
    enum { TRIALS = 100000 };
    static const double share = 0.7, shrinks = 0.99;
    const struct box *box = &beads->box;
    double distance = share * pow(mf_box_volume(box) / (double)beads->count, 1.0 / box->dimensions);
    for (uint32_t trial = 0; trial < TRIALS; trial++, distance *= shrinks) {
        const struct rng_block block =
            solvent_noise(solvent, trial / 256, beads->id[bead], SOLVENT_BEAD, trial);
        double place[3] = {0};
        for (int d = 0; d < box->dimensions; d++)
            place[d] = box->length[d] * mf_rng_uniform(block.word[d], block.word[3]);
        if (!is_room(solvent, beads, bead, place, fmax(distance, least)))
            continue;
        for (int d = 0; d < box->dimensions; d++)
            beads->position[d][bead] = place[d];
        return STATUS_OK;
    }
    return mf_status_fail(STATUS_BAD_INPUT,
                          "particles.separation: no room for particle %u outside the obstacle, %g "
                          "from the others",
                          beads->id[bead], least);
}

enum status mf_solvent_part_beads(const struct solvent *solvent, struct particles *beads,
                                  const struct placement *placement) {
    const double least = placement->kind == PLACEMENT_RANDOM ? placement->separation : 0;
    if (placement->kind == PLACEMENT_FILE)
        return check_file(solvent, beads);
    for (size_t k = 0; k < beads->count; k++)
        if (is_inside(solvent, beads, k))
            TRY(move_out(solvent, beads, k, least));
    mf_particles_update_fractions(beads);
    return STATUS_OK;
}
