// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where beads and molecules begin among plates and an obstacle, of which their placement knows
// nothing.
#include "dynamics/solvent.h"

#include "base/memory.h"

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

/// A molecule or a single bead, which begins elsewhere as a whole.
struct body {
    int beads;
    size_t *bead; ///< shape [beads], of the particles; of a molecule in the order of its walk
    double (*offset)[3]; ///< shape [beads], from the first one
};

/// Where a bead is if its body's first one is at `first`: in the box, but along plates.
static void find_place(const struct solvent *solvent, const struct body *body, int n,
                       const double first[3], double place[3]) {
    for (int d = 0; d < 3; d++) {
        const double length = d < solvent->box.dimensions ? solvent->box.length[d] : 0;
        const bool plates = d == 1 && solvent->parameters.walls == COLLISION_PLATES;
        place[d] = length > 0 ? first[d] + body->offset[n][d] : 0;
        if (length > 0 && !plates)
            place[d] -= length * floor(place[d] / length);
    }
}

/// Whether a body has all its beads outside the obstacle and between the plates.
static bool fits(const struct solvent *solvent, const struct body *body, const double first[3]) {
    for (int n = 0; n < body->beads; n++) {
        double place[3];
        find_place(solvent, body, n, first, place);
        if (!mf_solvent_is_free(solvent, place) ||
            (solvent->parameters.walls == COLLISION_PLATES &&
             !(place[1] >= 0 && place[1] < solvent->box.length[1])))
            return false;
    }
    return true;
}

static bool is_own(const struct body *body, size_t bead) {
    for (int n = 0; n < body->beads; n++)
        if (body->bead[n] == bead)
            return true;
    return false;
}

/// Whether all beads of a body would be farther from all others than a distance.
static bool has_space(const struct solvent *solvent, const struct particles *beads,
                      const struct body *body, const double first[3], double distance) {
    for (int n = 0; n < body->beads; n++) {
        double place[3];
        find_place(solvent, body, n, first, place);
        for (size_t k = 0; k < beads->count; k++) {
            double square = 0;
            for (int d = 0; d < beads->box.dimensions; d++) {
                const double apart =
                    box_nearest(place[d] - beads->position[d][k], beads->box.length[d]);
                square += apart * apart;
            }
            if (square < distance * distance && !is_own(body, k))
                return false;
        }
    }
    return true;
}

/// The distance from others shrinks from trial to trial, down to the least that is wanted.
static enum status move_out(const struct solvent *solvent, struct particles *beads,
                            const struct body *body, double min) {
    enum { TRIALS = 100000 };
    static const double share = 0.7, shrinks = 0.99;
    const struct box *box = &beads->box;
    const uint32_t id = beads->id[body->bead[0]];
    double distance = share * pow(mf_box_volume(box) / (double)beads->count, 1.0 / box->dimensions);
    for (uint32_t trial = 0; trial < TRIALS; trial++, distance *= shrinks) {
        const struct rng_block block = solvent_noise(solvent, trial / 256, id, SOLVENT_BEAD, trial);
        double first[3] = {0};
        for (int d = 0; d < box->dimensions; d++)
            first[d] = box->length[d] * mf_rng_uniform(block.word[d], block.word[3]);
        if (!fits(solvent, body, first) ||
            !has_space(solvent, beads, body, first, fmax(distance, min)))
            continue;
        for (int n = 0; n < body->beads; n++) {
            double place[3];
            find_place(solvent, body, n, first, place);
            for (int d = 0; d < box->dimensions; d++)
                beads->position[d][body->bead[n]] = place[d];
        }
        return STATUS_OK;
    }
    if (body->beads > 1)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "molecules: no room for a molecule of %d beads outside the obstacle "
                              "and between the plates: it is too long, or there are too many",
                              body->beads);
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "particles.separation: no room for particle %u outside the obstacle, %g" STATUS_LENGTH
        " from the others",
        id, min);
}

/// Move a body that does not fit where it is.
static enum status part_body(const struct solvent *solvent, struct particles *beads,
                             const struct body *body, double min) {
    double first[3] = {0};
    for (int d = 0; d < beads->box.dimensions; d++)
        first[d] = beads->position[d][body->bead[0]];
    return fits(solvent, body, first) ? STATUS_OK : move_out(solvent, beads, body, min);
}

/// The beads of a molecule, from one to the next along its bonds.
static void make_whole(const struct particles *beads, const struct topology_kind *kind, int64_t m,
                       const int *order, const int *parent, struct body *body) {
    body->beads = kind->beads;
    for (int n = 0; n < kind->beads; n++) {
        const int from = parent[order[n]];
        int before = 0; // of those that were placed
        while (from >= 0 && order[before] != from)
            before++;
        body->bead[n] = beads->place[topology_id(kind, m, order[n])];
        for (int d = 0; d < beads->box.dimensions; d++)
            body->offset[n][d] = body->offset[before][d] * (n > 0) +
                                 box_nearest(beads->position[d][body->bead[n]] -
                                                 beads->position[d][body->bead[before]],
                                             beads->box.length[d]);
    }
}

static enum status part_molecules(const struct solvent *solvent, struct particles *beads,
                                  double min) {
    enum status status = STATUS_OK;
    const struct topology *topology = beads->topology;
    struct body body = {0};
    int *order = NULL, *parent = NULL;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        NEW_ARRAY(body.bead, kind->beads);
        NEW_ARRAY(body.offset, kind->beads);
        NEW_ARRAY(order, kind->beads);
        NEW_ARRAY(parent, kind->beads);
        mf_topology_walk(kind, order, parent);
        for (int64_t m = 0; m < kind->count; m++) {
            make_whole(beads, kind, m, order, parent, &body);
            CHECK(part_body(solvent, beads, &body, min));
        }
        mf_memory_free(body.bead);
        mf_memory_free(body.offset);
        mf_memory_free(order);
        mf_memory_free(parent);
        body = (struct body){0};
        order = parent = NULL;
    }
done:
    mf_memory_free(body.bead);
    mf_memory_free(body.offset);
    mf_memory_free(order);
    mf_memory_free(parent);
    return status;
}

enum status mf_solvent_part_beads(const struct solvent *solvent, struct particles *beads,
                                  const struct placement *placement) {
    const struct topology *topology = beads->topology;
    const double min = placement->kind == PLACEMENT_RANDOM ? placement->separation : 0;
    if (placement->kind == PLACEMENT_FILE)
        return check_file(solvent, beads);
    if (topology)
        TRY(part_molecules(solvent, beads, min));
    for (size_t k = 0; k < beads->count; k++) {
        double none[1][3] = {{0}};
        if (topology == NULL || topology->molecule[beads->id[k]] >= topology->molecules)
            TRY(part_body(solvent, beads, &(struct body){1, &k, none}, min));
    }
    mf_particles_update_fractions(beads);
    return STATUS_OK;
}
