// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/measured_molecules.h"

#include "base/memory.h"
#include "forces/bonded.h"

#include <math.h>
#include <string.h>

/// Edge of the box in which the nearest image of everything is itself [nm].
static const double without_end = 1e9;

// Preparing ---------------------------------------------------------------------------------------

static enum status plan_walks(struct measured_molecules *measured) {
    const struct topology *topology = &measured->molecules->topology;
    for (int k = 0; k < topology->kinds; k++)
        if ((size_t)topology->kind[k].beads > measured->max_beads)
            measured->max_beads = (size_t)topology->kind[k].beads;
    TRY_ARRAY(measured->order, (size_t)topology->kinds * measured->max_beads);
    TRY_ARRAY(measured->parent, (size_t)topology->kinds * measured->max_beads);
    for (int k = 0; k < topology->kinds; k++)
        mf_topology_walk(&topology->kind[k], measured->order + (size_t)k * measured->max_beads,
                         measured->parent + (size_t)k * measured->max_beads);
    return STATUS_OK;
}

static enum status list_excluded(struct measured_molecules *measured) {
    const struct topology *topology = &measured->molecules->topology;
    TRY_ARRAY(measured->excluded, topology->excluded_start[topology->particles] / 2);
    for (uint32_t id = 0; id < topology->particles; id++)
        for (size_t n = topology->excluded_start[id]; n < topology->excluded_start[id + 1]; n++) {
            const uint32_t other = topology->excluded[n];
            if (other < id)
                continue;
            uint32_t *pair = measured->excluded[measured->excluded_count++];
            pair[0] = (uint32_t)measured->match.bead[id];
            pair[1] = (uint32_t)measured->match.bead[other];
        }
    return STATUS_OK;
}

enum status mf_measured_molecules_begin(struct measured_molecules *measured,
                                        const struct measured_molecules_plan *plan,
                                        const struct mapping *mapping,
                                        const struct composition *composition) {
    *measured = (struct measured_molecules){.molecules = plan->molecules, .mapping = mapping};
    TRY(mf_molecule_match(&measured->match, &plan->molecules->topology, plan->types, mapping,
                          composition, plan->file));
    TRY(plan_walks(measured));
    return list_excluded(measured);
}

/// The masses of the beads, if all are known.
static enum status add_masses(struct measured_molecules *measured, struct particles *particles) {
    const struct mapping *mapping = measured->mapping;
    const struct particles_attribute mass = {
        .name = "mass", .type = PARTICLES_DOUBLE, .components = 1};
    int number;
    for (size_t k = 0; k < mapping->beads; k++)
        if (!(mapping->bead[k].mass > 0))
            return STATUS_OK;
    TRY(mf_particles_add_attribute(particles, &mass, &number));
    double *values = particles->attribute[number].value[0];
    for (size_t k = 0; k < mapping->beads; k++)
        values[k] = mapping->bead[k].mass;
    return STATUS_OK;
}

static enum status make_particles(struct measured_molecules *measured) {
    const struct topology *topology = &measured->molecules->topology;
    const struct box box = {3, {without_end, without_end, without_end}};
    struct particles *particles = &measured->particles;
    TRY(mf_particles_init(particles, &box, topology->particles));
    TRY(mf_particles_join(particles, topology));
    for (uint32_t id = 0; id < topology->particles; id++)
        particles->id[measured->match.bead[id]] = id;
    mf_particles_label_places(particles);
    return add_masses(measured, particles);
}

// Frames ------------------------------------------------------------------------------------------

/// Put one molecule's beads where they are nearest to what they are bonded to.
static void make_whole(struct measured_molecules *measured, const struct trajectory_frame *beads,
                       double reciprocal[3][3], int k, int64_t m) {
    const struct topology_kind *kind = &measured->molecules->topology.kind[k];
    const int *order = measured->order + (size_t)k * measured->max_beads;
    const int *parent = measured->parent + (size_t)k * measured->max_beads;
    double *const *position = measured->particles.position;
    for (int n = 0; n < kind->beads; n++) {
        const int from = parent[order[n]] < 0 ? order[0] : parent[order[n]];
        const size_t here = measured->match.bead[topology_id(kind, m, order[n])];
        const size_t there = measured->match.bead[topology_id(kind, m, from)];
        double place[3];
        for (int d = 0; d < 3; d++)
            place[d] = n == 0 ? beads->position[here][d] : position[d][there];
        mf_frame_step_to(beads, reciprocal, beads->position[here], place);
        for (int d = 0; d < 3; d++)
            position[d][here] = place[d];
    }
}

void mf_measured_molecules_place(struct measured_molecules *measured,
                                 const struct trajectory_frame *beads) {
    const struct topology *topology = &measured->molecules->topology;
    double reciprocal[3][3];
    mf_frame_reciprocal(beads, reciprocal);
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            make_whole(measured, beads, reciprocal, k, m);
}

// Beginning ---------------------------------------------------------------------------------------

/// Lengths of a group in a frame.
struct lengths {
    double count, sum;
};

static void add_lengths(const struct measured_molecules *measured,
                        struct lengths found[MOLECULES_MAX_GROUPS]) {
    const struct topology *topology = &measured->molecules->topology;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int n = 0; n < kind->terms[BONDED_BOND]; n++) {
            const struct topology_term *term = &kind->term[BONDED_BOND][n];
            struct lengths *group = &found[term->group];
            for (int64_t m = 0; m < kind->count; m++) {
                int32_t place[2];
                double length;
                for (int bead = 0; bead < 2; bead++)
                    place[bead] =
                        (int32_t)measured->match.bead[topology_id(kind, m, term->bead[bead])];
                mf_bonded_measure(BONDED_BOND, 1, place, &measured->particles, &length);
                group->sum += length;
                group->count++;
            }
        }
    }
}

/// Let a group of bonds rest at its mean length, so that bins go to twice the longest of them.
static void rest_at(const struct bonded_curve *curve, double mean) {
    const struct field *field = curve->law->fields;
    while (field->name && strcmp(field->name, "length") != 0)
        field++;
    if (field->name)
        memcpy((char *)curve->parameters + field->offset, &mean, sizeof mean);
}

static void find_rest(struct measured_molecules *measured) {
    const struct molecules *molecules = measured->molecules;
    struct lengths found[MOLECULES_MAX_GROUPS] = {{0}};
    add_lengths(measured, found);
    for (int g = 0; g < molecules->groups[BONDED_BOND]; g++)
        if (found[g].count > 0)
            rest_at(&molecules->group[BONDED_BOND][g].curve, found[g].sum / found[g].count);
}

enum status mf_measured_molecules_start(struct measured_molecules *measured,
                                        const struct trajectory_frame *beads) {
    TRY(make_particles(measured));
    mf_measured_molecules_place(measured, beads);
    find_rest(measured);
    return STATUS_OK;
}

void mf_measured_molecules_clear(struct measured_molecules *measured) {
    mf_particles_clear(&measured->particles);
    mf_memory_free(measured->order);
    mf_memory_free(measured->parent);
    mf_memory_free(measured->excluded);
    mf_molecule_match_clear(&measured->match);
    *measured = (struct measured_molecules){0};
}
