// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/mapping.h"

#include "base/memory.h"
#include "trajectory/mapping_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Order of beads: by type, then by their first atoms.
static int by_type(const void *a, const void *b) {
    const struct mapping_bead *const x = a, *const y = b;
    if (x->type != y->type)
        return x->type < y->type ? -1 : 1;
    return x->first < y->first ? -1 : x->first > y->first;
}

enum status mf_mapping_init(struct mapping *mapping, const struct mapping_plan *plan,
                            const struct structure *structure) {
    enum status status;
    *mapping = (struct mapping){.atoms = structure->atoms};
    CHECK(mf_mapping_build(mapping, plan, structure));
    CHECK(mf_mapping_build_masses(mapping, plan, structure));
    qsort(mapping->bead, mapping->beads, sizeof *mapping->bead, by_type);
    CHECK(mf_mapping_build_notes(mapping));
done:
    if (status != STATUS_OK)
        mf_mapping_clear(mapping);
    return status;
}

void mf_mapping_clear(struct mapping *mapping) {
    mf_memory_free(mapping->type_name);
    mf_memory_free(mapping->bead);
    mf_memory_free(mapping->atom);
    mf_memory_free(mapping->weight);
    mf_source_free(&mapping->notes);
    *mapping = (struct mapping){0};
}

/// place = the image of `position` nearest to `place`.
static void step_to(const struct trajectory_frame *frame, double reciprocal[3][3],
                    const double position[3], double place[3]) {
    double difference[3];
    for (int d = 0; d < 3; d++)
        difference[d] = position[d] - place[d];
    for (int i = 2; i >= 0; i--) {
        const double *const row = reciprocal[i];
        const double images =
            rint(difference[0] * row[0] + difference[1] * row[1] + difference[2] * row[2]);
        for (int d = 0; images != 0 && d < 3; d++)
            difference[d] -= images * frame->box[i][d];
    }
    for (int d = 0; d < 3; d++)
        place[d] += difference[d];
}

static void copy_surroundings(const struct trajectory_frame *frame,
                              struct trajectory_frame *beads) {
    beads->number = frame->number;
    beads->step = frame->step;
    beads->time = frame->time;
    beads->has_box = frame->has_box;
    memcpy(beads->periodic, frame->periodic, sizeof beads->periodic);
    memcpy(beads->box, frame->box, sizeof beads->box);
    beads->file = frame->file;
}

enum status mf_mapping_apply(const struct mapping *mapping, const struct trajectory_frame *frame,
                             struct trajectory_frame *beads) {
    double reciprocal[3][3];
    if (frame->atoms != mapping->atoms)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu has %zu atoms, the map is for %zu",
                              frame->file, frame->number, frame->atoms, mapping->atoms);
    TRY(mf_frame_reserve(beads, mapping->beads, frame->has_velocities));
    copy_surroundings(frame, beads);
    mf_frame_reciprocal(frame, reciprocal);
    for (size_t k = 0; k < mapping->beads; k++) {
        const struct mapping_bead *const bead = &mapping->bead[k];
        const size_t *const atom = &mapping->atom[bead->first];
        const double *const weight = &mapping->weight[bead->first];
        double place[3], centre[3] = {0}, velocity[3] = {0};
        memcpy(place, frame->position[atom[0]], sizeof place);
        for (size_t i = 0; i < bead->count; i++) {
            step_to(frame, reciprocal, frame->position[atom[i]], place);
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
