// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/rng.h"
#include "forces/molecules.h"

#include <math.h>

/// How a bead is joined to those before it: beads of the molecule, −1 where there is none.
struct joint {
    int bead;
    int parent, before; ///< bonded to it, and to that one
    double length;      ///< of the bond at rest [λ]
    double angle;       ///< before-parent-bead at rest [rad]; NaN: free
};

// The order of growth -----------------------------------------------------------------------------

/// A bond of a bead that is placed with one that is not, the first in the order of bonds.
static const struct topology_term *next_bond(const struct topology_kind *kind, const bool *placed) {
    for (int n = 0; n < kind->terms[BONDED_BOND]; n++) {
        const struct topology_term *bond = &kind->term[BONDED_BOND][n];
        if (placed[bond->bead[0]] != placed[bond->bead[1]])
            return bond;
    }
    return NULL;
}

/// A bead that is placed and bonded to `parent`, or −1; `angle` is that of the term of the three at
/// rest, if there is one.
static int find_before(const struct molecules *molecules, const struct topology_kind *kind,
                       const bool *placed, int parent, int bead, double *angle) {
    int before = -1;
    *angle = NAN;
    for (int n = 0; n < kind->terms[BONDED_ANGLE]; n++) {
        const struct topology_term *term = &kind->term[BONDED_ANGLE][n];
        const int other = term->bead[0] == bead ? term->bead[2] : term->bead[0];
        if (term->bead[1] != parent || !placed[other] ||
            (term->bead[0] != bead && term->bead[2] != bead))
            continue;
        *angle = mf_bonded_rest(&molecules->group[BONDED_ANGLE][term->group].curve);
        return other;
    }
    for (int n = 0; n < kind->terms[BONDED_BOND]; n++) {
        const int *pair = kind->term[BONDED_BOND][n].bead;
        for (int k = 0; k < 2 && before < 0; k++)
            if (pair[k] == parent && placed[pair[1 - k]])
                before = pair[1 - k];
    }
    return before;
}

/// The joints of a kind in the order in which its beads are placed, shape [beads]. What no bond
/// joins to the rest starts again at the first bead.
static enum status plan_growth(const struct molecules *molecules, const struct topology_kind *kind,
                               struct joint *joints) {
    OWNED bool *placed = NULL;
    TRY_ARRAY(placed, kind->beads);
    for (int n = 0; n < kind->beads; n++) {
        const struct topology_term *bond = next_bond(kind, placed);
        struct joint joint = {.parent = -1, .before = -1, .angle = NAN};
        if (bond) {
            joint.parent = bond->bead[placed[bond->bead[0]] ? 0 : 1];
            joint.bead = bond->bead[placed[bond->bead[0]] ? 1 : 0];
            joint.length = mf_bonded_rest(&molecules->group[BONDED_BOND][bond->group].curve);
            joint.before =
                find_before(molecules, kind, placed, joint.parent, joint.bead, &joint.angle);
        } else {
            while (placed[joint.bead])
                joint.bead++;
        }
        placed[joint.bead] = true;
        joints[n] = joint;
    }
    return STATUS_OK;
}

// Growth ------------------------------------------------------------------------------------------

/// A random direction, uniform on the sphere or the circle.
static void draw_direction(struct rng_sequence *sequence, int dimensions, double direction[3]) {
    const double turn = 2 * M_PI * mf_rng_sequence_uniform(sequence);
    const double up = dimensions == 3 ? 2 * mf_rng_sequence_uniform(sequence) - 1 : 0;
    const double flat = sqrt(1 - up * up);
    direction[0] = flat * cos(turn);
    direction[1] = flat * sin(turn);
    direction[2] = up;
}

/// Turn a direction into one at an angle to `axis`, on the side where it was.
static void turn_to(const double axis[3], double angle, double direction[3]) {
    double along = 0, square = 0;
    for (int d = 0; d < 3; d++)
        along += axis[d] * direction[d];
    for (int d = 0; d < 3; d++) {
        direction[d] -= along * axis[d];
        square += direction[d] * direction[d];
    }
    for (int d = 0; d < 3; d++)
        direction[d] = cos(angle) * axis[d] + sin(angle) * direction[d] / sqrt(fmax(square, 1e-30));
}

/// Where the bead of a joint comes to, relative to the molecule's start.
static void place_bead(const struct joint *joint, int dimensions, struct rng_sequence *sequence,
                       double (*place)[3]) {
    enum { TRIALS = 100 };
    static const double nearest = 1.05; // to the bead before the last, in lengths of the bond
    double *here = place[joint->bead], direction[3] = {0}, back[3] = {0}, length = 0;
    if (joint->parent < 0) {
        here[0] = here[1] = here[2] = 0;
        return;
    }
    const double *parent = place[joint->parent];
    for (int d = 0; d < 3 && joint->before >= 0; d++) {
        back[d] = place[joint->before][d] - parent[d];
        length += back[d] * back[d];
    }
    length = sqrt(length);
    for (int trial = 0; trial < TRIALS; trial++) {
        double square = 0;
        draw_direction(sequence, dimensions, direction);
        for (int d = 0; d < 3; d++)
            square += pow(joint->length * direction[d] - back[d], 2);
        if (joint->before < 0 || isfinite(joint->angle) ||
            square >= pow(nearest * fmin(joint->length, length), 2))
            break;
    }
    if (isfinite(joint->angle) && length > 0) {
        for (int d = 0; d < 3; d++)
            back[d] /= length;
        turn_to(back, joint->angle, direction);
    }
    for (int d = 0; d < 3; d++)
        here[d] = parent[d] + joint->length * direction[d];
}

/// Where molecules and single beads begin, by their numbers.
struct starts {
    struct particles particles;
    uint32_t *site; ///< shape [count]: particle that stands for each number
};

static enum status grow_kind(const struct molecules *molecules, const struct topology_kind *kind,
                             const struct starts *starts, struct particles *particles,
                             uint64_t seed) {
    OWNED struct joint *joints = NULL;
    OWNED double(*place)[3] = NULL;
    TRY_ARRAY(joints, kind->beads);
    TRY_ARRAY(place, kind->beads);
    TRY(plan_growth(molecules, kind, joints));
    for (int64_t m = 0; m < kind->count; m++) {
        const uint32_t molecule = (uint32_t)(kind->first + m), site = starts->site[molecule];
        for (int n = 0; n < kind->beads; n++) {
            struct rng_sequence sequence =
                mf_rng_sequence_begin(seed, RNG_MIXING, molecule + 1, (uint32_t)n);
            place_bead(&joints[n], particles->box.dimensions, &sequence, place);
        }
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
    for (size_t k = 0; k < particles->count; k++)
        starts->site[particles->id[k]] = (uint32_t)k;
    return STATUS_OK;
}

enum status mf_molecules_place(const struct molecules *molecules, struct particles *particles,
                               const struct placement *placement, uint64_t seed) {
    enum status status = STATUS_OK;
    const struct topology *topology = &molecules->topology;
    struct starts starts = {0};
    size_t count = (size_t)topology->molecules;
    for (size_t id = 0; id < topology->particles; id++)
        count += topology->molecule[id] >= topology->molecules;
    CHECK(mf_particles_init(&starts.particles, &particles->box, count));
    CHECK(place_starts(&starts, placement, seed));
    for (int k = 0; k < topology->kinds; k++)
        CHECK(grow_kind(molecules, &topology->kind[k], &starts, particles, seed));
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
