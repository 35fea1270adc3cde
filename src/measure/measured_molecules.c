// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/measured_molecules.h"

#include "base/memory.h"
#include "forces/bonded.h"
#include "observe/bonded_distribution.h"

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
    *measured = (struct measured_molecules){
        .molecules = plan->molecules, .mapping = mapping, .composition = composition};
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

/// A configuration with the beads where the mapping has them.
static enum status make_configuration(struct measured_molecules *measured, double interval) {
    const struct topology *topology = &measured->molecules->topology;
    const struct box box = {3, {without_end, without_end, without_end}};
    struct particles *particles = &measured->particles;
    TRY(mf_particles_init(particles, &box, topology->particles));
    TRY(mf_particles_join(particles, topology));
    for (uint32_t id = 0; id < topology->particles; id++)
        particles->id[measured->match.bead[id]] = id;
    mf_particles_label_places(particles);
    measured->configuration = (struct configuration){.dimensions = 3,
                                                     .composition = measured->composition,
                                                     .molecules = measured->molecules,
                                                     .time_step = interval,
                                                     .particles = particles};
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

static void place_beads(struct measured_molecules *measured, const struct trajectory_frame *beads) {
    const struct topology *topology = &measured->molecules->topology;
    double reciprocal[3][3];
    mf_frame_reciprocal(beads, reciprocal);
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            make_whole(measured, beads, reciprocal, k, m);
}

enum status mf_measured_molecules_add(struct measured_molecules *measured,
                                      const struct trajectory_frame *beads) {
    if (measured->configuration.particles == NULL)
        return STATUS_OK;
    place_beads(measured, beads);
    for (const struct observable_use *use = measured->use; use->observable; use++)
        TRY(use->observable->sample(use->state, &measured->configuration));
    return STATUS_OK;
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

static const struct observable *find_observable(const char *name) {
    size_t k = 0;
    while (strcmp(mf_observables[k]->name, name) != 0)
        k++;
    return mf_observables[k];
}

/// @param[in] bins  of what is distributed, or 0
static enum status add_observable(struct measured_molecules *measured,
                                  const struct observable *observable, int64_t bins,
                                  struct observable_use *use) {
    const struct measure_plan plan = {.equilibration = -1, .samples = 0, .every = 1};
    use->observable = observable;
    use->settings = mf_memory_zeroed(1, observable->settings_size);
    TRY(use->settings ? STATUS_OK : STATUS_NO_MEMORY);
    mf_fields_set_defaults(observable->fields, use->settings);
    if (bins > 0)
        ((struct bonded_settings *)use->settings)->bins = bins;
    return mf_observable_begin(use, &measured->configuration, &plan);
}

enum status mf_measured_molecules_start(struct measured_molecules *measured,
                                        const struct trajectory_frame *beads, double interval) {
    struct observable_use *use = measured->use;
    if (measured->molecules == NULL)
        return STATUS_OK;
    TRY(make_configuration(measured, interval));
    place_beads(measured, beads);
    find_rest(measured);
    for (int order = 0; order < BONDED_KINDS; order++)
        if (measured->molecules->groups[order] > 0)
            TRY(add_observable(measured, mf_bonded_distribution_of(order),
                               mf_bonded_kinds[order]->fine, use++));
    return add_observable(measured, find_observable("molecule_sizes"), 0, use);
}

static const struct observable_use *find_use(const struct measured_molecules *measured, int order) {
    const struct observable_use *use = measured->use;
    while (use->observable && use->observable != mf_bonded_distribution_of(order))
        use++;
    return use->observable ? use : NULL;
}

void mf_measured_molecules_end(struct measured_molecules *measured) {
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct observable_use *use = find_use(measured, order);
        if (use)
            mf_bonded_distribution_join(use->state);
    }
}

enum status mf_measured_molecules_moments(const struct measured_molecules *measured, int order,
                                          int group, struct bonded_moments *moments) {
    struct bonded_bins bins;
    double *counts = mf_bonded_distribution_counts(find_use(measured, order)->state, group, &bins);
    if (counts == NULL)
        return STATUS_NO_MEMORY;
    *moments = mf_bonded_distribution_moments(&bins, counts);
    mf_memory_free(counts);
    return STATUS_OK;
}

void mf_measured_molecules_clear(struct measured_molecules *measured) {
    for (struct observable_use *use = measured->use; use->observable; use++) {
        mf_observable_end(use);
        mf_memory_free(use->settings);
    }
    mf_particles_clear(&measured->particles);
    mf_memory_free(measured->order);
    mf_memory_free(measured->parent);
    mf_memory_free(measured->excluded);
    mf_molecule_match_clear(&measured->match);
    *measured = (struct measured_molecules){0};
}
