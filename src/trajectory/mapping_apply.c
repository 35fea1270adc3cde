// SPDX-License-Identifier: GPL-3.0-or-later
//
// The beads of a frame of atoms.
#include "trajectory/mapping.h"

#include <math.h>
#include <string.h>

static void copy_surroundings(const struct trajectory_frame *frame,
                              struct trajectory_frame *beads) {
    beads->number = frame->number;
    beads->step = frame->step;
    beads->time = frame->time;
    beads->has_box = frame->has_box;
    beads->unwrapped = frame->unwrapped;
    memcpy(beads->periodic, frame->periodic, sizeof beads->periodic);
    memcpy(beads->box, frame->box, sizeof beads->box);
    beads->file = frame->file;
}

/// The forces of beads, whose atoms are in no other.
static enum status add_forces(const struct mapping *mapping, const struct trajectory_frame *frame,
                              struct trajectory_frame *beads) {
    TRY(mf_frame_reserve_forces(beads));
    for (size_t k = 0; k < mapping->beads; k++) {
        const struct mapping_bead *const bead = &mapping->bead[k];
        for (int d = 0; d < 3; d++) {
            double sum = 0;
            for (size_t i = 0; i < bead->count; i++)
                sum += frame->force[mapping->atom[bead->first + i]][d];
            beads->force[k][d] = sum;
        }
    }
    return STATUS_OK;
}

enum status mf_mapping_apply(const struct mapping *mapping, const struct trajectory_frame *frame,
                             struct trajectory_frame *beads) {
    double reciprocal[3][3];
    if (frame->atoms != mapping->atoms)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu has %zu atoms, the map is for %zu",
                              frame->file, frame->number, frame->atoms, mapping->atoms);
    TRY(mf_frame_reserve(beads, mapping->beads, frame->has_velocities));
    copy_surroundings(frame, beads);
    if (frame->has_forces)
        TRY(add_forces(mapping, frame, beads));
    mf_frame_reciprocal(frame, reciprocal);
    for (size_t k = 0; k < mapping->beads; k++) {
        const struct mapping_bead *const bead = &mapping->bead[k];
        const size_t *const atom = &mapping->atom[bead->first];
        const double *const weight = &mapping->weight[bead->first];
        double place[3], centre[3] = {0}, velocity[3] = {0};
        memcpy(place, frame->position[atom[0]], sizeof place);
        for (size_t i = 0; i < bead->count; i++) {
            mf_frame_step_to(frame, reciprocal, frame->position[atom[i]], place);
            for (int d = 0; d < 3; d++) {
                centre[d] += weight[i] * place[d];
                velocity[d] += frame->has_velocities ? weight[i] * frame->velocity[atom[i]][d] : 0;
            }
        }
        memcpy(beads->position[k], centre, sizeof centre);
        if (frame->has_velocities)
            memcpy(beads->velocity[k], velocity, sizeof velocity);
    }
    return STATUS_OK;
}
