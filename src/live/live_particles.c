// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_particles.h"

#include "base/memory.h"
#include "system/orientation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct head {
    char name[4];
    uint32_t count, dimensions, parts, types, bonds;
    double step, time;
    float box[3];
    char zeros[12];
};

_Static_assert(sizeof(struct head) == LIVE_PARTICLES_HEAD, "the page reads 64 bytes");

static unsigned find_parts(const struct simulation *simulation, bool energies) {
    const bool potential = simulation->setup.potential != NULL;
    const bool listed = !simulation->setup.integrator->samples; // whoever is near now
    return (mf_simulation_oriented(&simulation->setup) ? LIVE_PARTICLES_POLARITY : 0) |
           (potential ? LIVE_PARTICLES_POTENTIAL : 0) |
           (potential && energies && listed ? LIVE_PARTICLES_ENERGY : 0);
}

enum { NAMES_SIZE = COMPOSITION_MAX_TYPES * COMPOSITION_NAME_SIZE };
_Static_assert(COMPOSITION_NAME_SIZE == 16, "the page reads 16 bytes a name");

static size_t count_bonds(const struct particles *particles) {
    return particles->topology ? mf_topology_terms(particles->topology, BONDED_BOND) : 0;
}

static size_t find_size(const struct particles *particles, unsigned parts) {
    const size_t numbers =
        4 + (parts & LIVE_PARTICLES_POLARITY ? 2 : 0) + (parts & LIVE_PARTICLES_ENERGY ? 1 : 0);
    return LIVE_PARTICLES_HEAD + COMPOSITION_MAX_TYPES * sizeof(uint32_t) +
           particles->count * numbers * sizeof(float) +
           count_bonds(particles) * 2 * sizeof(uint32_t) + NAMES_SIZE;
}

static bool reserve(struct live_bytes *bytes, size_t size) {
    bytes->size = 0;
    if (bytes->capacity < size) {
        unsigned char *more = realloc(bytes->bytes, size);
        if (more == NULL)
            return false;
        bytes->bytes = more;
        bytes->capacity = size;
    }
    bytes->size = size;
    return true;
}

static unsigned char *write_head(const struct simulation *simulation, unsigned parts,
                                 unsigned char *to) {
    const struct composition *composition = &simulation->setup.composition;
    const struct box *box = &simulation->particles.box;
    const int types = composition->types > 1 ? composition->types : 1;
    uint32_t counts[COMPOSITION_MAX_TYPES] = {0};
    struct head head = {.name = "MFP1",
                        .count = (uint32_t)simulation->particles.count,
                        .dimensions = (uint32_t)box->dimensions,
                        .parts = parts,
                        .types = (uint32_t)types,
                        .bonds = (uint32_t)count_bonds(&simulation->particles),
                        .step = (double)simulation->step,
                        .time = (double)simulation->step * simulation->setup.time_step};
    for (int d = 0; d < 3; d++)
        head.box[d] = (float)(d < box->dimensions ? box->length[d] : 0);
    for (int type = 0; type < types; type++)
        counts[type] = types > 1 ? (uint32_t)composition->count[type] : head.count;
    memcpy(to, &head, sizeof head);
    memcpy(to + sizeof head, counts, sizeof counts);
    return to + sizeof head + sizeof counts;
}

/// Between two sorts particles may have left the box. By truncation a frame of 10,125 beads takes
/// 64 µs, by floor 84: at a five-hundredth of the time, 31 or 24 of them a second.
static void write_places(const struct particles *particles, float *to) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d];
        for (size_t k = 0; k < particles->count; k++) {
            const double boxes = particles->position[d][k] / length;
            const double part = boxes - (double)(int64_t)boxes;
            to[3 * (size_t)particles->id[k] + (size_t)d] =
                (float)(length * (part < 0 ? part + 1 : part));
        }
    }
    for (size_t k = 0; particles->box.dimensions < 3 && k < particles->count; k++)
        to[3 * k + 2] = 0;
}

static void write_speeds(const struct simulation *simulation, float *to) {
    const struct particles *particles = &simulation->particles;
    const bool has_velocities = simulation_has_velocities(&simulation->setup);
    for (size_t k = 0; k < particles->count; k++) {
        double square = 0;
        for (int d = 0; d < particles->box.dimensions; d++)
            square += particles->velocity[d][k] * particles->velocity[d][k];
        to[particles->id[k]] = has_velocities ? (float)sqrt(square) : NAN;
    }
}

static void write_polarities(const struct particles *particles, float *to) {
    const struct orientation orientation = mf_orientation_of(particles);
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < 2; d++)
            to[2 * (size_t)particles->id[k] + (size_t)d] = (float)orientation.polarity[d][k];
}

static void write_bonds(const struct topology *topology, uint32_t *to) {
    for (int k = 0; topology && k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int t = 0; t < kind->terms[BONDED_BOND]; t++)
                for (int end = 0; end < 2; end++)
                    *to++ = topology_id(kind, m, kind->term[BONDED_BOND][t].bead[end]);
    }
}

static void write_names(const struct composition *composition, unsigned char *to) {
    memset(to, 0, NAMES_SIZE);
    for (int type = 0; type < composition->types; type++)
        memcpy(to + (ptrdiff_t)type * COMPOSITION_NAME_SIZE, composition->name[type],
               strlen(composition->name[type]));
}

void mf_live_particles_energies(const struct table *potential,
                                const struct composition *composition,
                                const struct particles *particles,
                                const struct neighbours *neighbours, float *energy) {
    memset(energy, 0, particles->count * sizeof *energy);
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            const uint32_t a = particles->id[i], b = particles->id[j];
            double square = 0, phi;
            for (int d = 0; d < particles->box.dimensions; d++) {
                const double apart =
                    box_nearest(particles->position[d][i] - particles->position[d][j],
                                particles->box.length[d]);
                square += apart * apart;
            }
            const double r = sqrt(square);
            const int pair = mf_composition_pair_of_ids(composition, a, b);
            if (j == i || r >= table_cutoff(potential, pair)) // j = i is what is left of a row
                continue;
            mf_table_evaluate_pair(potential, pair, r, &phi, NULL, NULL);
            energy[a] += (float)(0.5 * phi);
            energy[b] += (float)(0.5 * phi);
        }
}

void mf_live_particles_write(const struct simulation *simulation, bool energies,
                             struct live_bytes *bytes) {
    const struct particles *particles = &simulation->particles;
    const unsigned parts = find_parts(simulation, energies);
    if (!reserve(bytes, find_size(particles, parts)))
        return;
    float *to = (float *)(void *)write_head(simulation, parts, bytes->bytes);
    write_places(particles, to);
    to += 3 * particles->count;
    write_speeds(simulation, to);
    to += particles->count;
    if (parts & LIVE_PARTICLES_POLARITY) {
        write_polarities(particles, to);
        to += 2 * particles->count;
    }
    if (parts & LIVE_PARTICLES_ENERGY) {
        mf_live_particles_energies(simulation->setup.potential, &simulation->setup.composition,
                                   particles, &simulation->neighbours, to);
        to += particles->count;
    }
    write_bonds(particles->topology, (uint32_t *)(void *)to);
    write_names(&simulation->setup.composition, bytes->bytes + bytes->size - NAMES_SIZE);
}

// The candidate of a fit --------------------------------------------------------------------------

/// {"name": "potential", "unit": "kJ/mol", "r_unit": "nm", "r": […], "value": […]}
static void write_curve(struct json_writer *writer, const struct unknowns *unknowns,
                        const struct units *units, enum unknown_kind kind, size_t curve,
                        const double *value) {
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const double *r = mf_unknowns_r(unknowns, kind);
    char name[UNKNOWNS_NAME_SIZE], unit[UNITS_NAME_SIZE];
    const bool angle = strstr(mf_unknowns_heading(unknowns, kind, curve), "degrees") != NULL;
    const char *r_unit = angle ? "degrees" : "lambda";
    mf_unknowns_curve_name(unknowns, kind, curve, name);
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "name", name);
    mf_json_write_text(writer, "unit", mf_units_name(units, mf_unknowns_unit(kind), unit));
    mf_json_write_text(writer, "r_unit", mf_units_name(units, r_unit, unit));
    mf_json_write_quantities(writer, "r", r_unit, r + part.first, part.points);
    mf_json_write_quantities(writer, "value", mf_unknowns_unit(kind), value + part.first,
                             part.points);
    mf_json_end(writer);
}

static enum status write_unknown(struct json_writer *writer, const struct watcher_run *run,
                                 const struct inverse_candidate *candidate,
                                 enum unknown_kind kind) {
    const size_t points = mf_unknowns_points(run->unknowns, kind);
    OWNED double *value = NULL;
    if (points == 0)
        return STATUS_OK;
    TRY_ARRAY(value, points);
    candidate->curve(candidate->context, kind, value);
    for (size_t k = 0; k < mf_unknowns_curve_count(run->unknowns, kind); k++)
        write_curve(writer, run->unknowns, run->units, kind, k, value);
    return STATUS_OK;
}

/// g(r) of one pair type, as curves are.
static void write_rdf(struct json_writer *writer, const struct watcher_run *run, size_t pair,
                      const double *g, const double *r) {
    const struct rdf_bins *bins = &run->targets->bins;
    const struct composition *types = &run->unknowns->problem->scene.composition;
    char name[COMPOSITION_PAIR_NAME_SIZE], unit[UNITS_NAME_SIZE];
    mf_composition_pair_name(types, (int)pair, name);
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "name", name);
    mf_json_write_text(writer, "r_unit", mf_units_name(run->units, "lambda", unit));
    mf_json_write_quantities(writer, "r", "lambda", r, bins->count);
    mf_json_write_quantities(writer, "value", "1", g + pair * bins->count, bins->count);
    mf_json_write_quantities(writer, "target", "1",
                             run->targets->target[TARGET_RDF].value + pair * bins->count,
                             bins->count);
    mf_json_end(writer);
}

static enum status write_rdfs(struct json_writer *writer, const struct watcher_run *run,
                              const double *g) {
    const struct rdf_bins *bins = &run->targets->bins;
    const size_t pairs = run->targets->target[TARGET_RDF].count / bins->count;
    OWNED double *r = NULL;
    TRY_ARRAY(r, bins->count);
    for (size_t k = 0; k < bins->count; k++)
        r[k] = mf_rdf_bins_centre(bins, k);
    for (size_t pair = 0; pair < pairs; pair++)
        write_rdf(writer, run, pair, g, r);
    return STATUS_OK;
}

static enum status fill(struct json_writer *writer, const struct watcher_run *run,
                        const struct inverse_candidate *candidate) {
    const double temperature = run->unknowns->problem->scene.temperature;
    char unit[UNITS_NAME_SIZE];
    mf_json_writer_set_units(writer, run->units);
    mf_json_write_integer(writer, "number", (int64_t)candidate->number);
    mf_json_write_number(writer, "error", candidate->error);
    mf_json_write_quantity(writer, "temperature", "T_0",
                           candidate->temperature > 0 ? candidate->temperature * temperature : NAN);
    mf_json_write_text(writer, "temperature_unit", mf_units_name(run->units, "T_0", unit));
    mf_json_begin_list(writer, "curves");
    for (int kind = 0; kind < UNKNOWNS; kind++)
        TRY(write_unknown(writer, run, candidate, kind));
    mf_json_end(writer);
    mf_json_begin_list(writer, "rdf");
    if (candidate->rdf)
        TRY(write_rdfs(writer, run, candidate->rdf));
    mf_json_end(writer);
    return STATUS_OK;
}

struct json_writer *mf_live_candidate_write(const struct watcher_run *run,
                                            const struct inverse_candidate *candidate) {
    struct json_writer *writer = mf_json_writer_create();
    if (writer && fill(writer, run, candidate) != STATUS_OK) {
        mf_json_writer_free(writer);
        return NULL;
    }
    return writer;
}
