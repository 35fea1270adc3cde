// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/measured_molecules.h"

#include "base/memory.h"
#include "forces/bonded.h"
#include "trajectory/mapping.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Which beads are of which molecule ---------------------------------------------------------------

enum { NO_KIND = -1 };

/// A bead, and where it stands in the trajectory.
struct entry {
    size_t group; ///< its residue or molecule
    size_t atom;  ///< the first of the bead
    size_t bead;  ///< in the mapping
};

struct work {
    struct topology *topology;
    const struct mapping *mapping;
    const char *file;
    struct entry *entry; ///< shape [beads]
    size_t *begin;       ///< shape [groups + 1]: first entry of each
    int *kind;           ///< shape [groups]: NO_KIND for a single bead
    size_t groups;
    int64_t count[TOPOLOGY_MAX_KINDS]; ///< found so far
};

static int by_group(const void *a, const void *b) {
    const struct entry *const x = a, *const y = b;
    if (x->group != y->group)
        return x->group < y->group ? -1 : 1;
    return x->atom < y->atom ? -1 : x->atom > y->atom;
}

static int by_atom(const void *a, const void *b) {
    const struct entry *const x = a, *const y = b;
    return x->atom < y->atom ? -1 : x->atom > y->atom;
}

static size_t type_of(const struct work *work, size_t entry) {
    return work->mapping->bead[work->entry[entry].bead].type;
}

/// Types of the kinds become those of the mapping.
static enum status translate_types(const struct work *work, const struct composition *types) {
    for (int k = 0; k < work->topology->kinds; k++) {
        struct topology_kind *kind = &work->topology->kind[k];
        for (int bead = 0; bead < kind->beads; bead++) {
            const char *name = types->name[kind->type[bead]];
            size_t type = 0;
            while (type < work->mapping->types && strcmp(work->mapping->type_name[type], name) != 0)
                type++;
            if (type == work->mapping->types)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: molecules.%s: no bead of the trajectory is of type "
                                      "\"%s\"",
                                      work->file, kind->name, name);
            kind->type[bead] = (int)type;
        }
    }
    return STATUS_OK;
}

static enum status list_beads(struct work *work) {
    const struct mapping *mapping = work->mapping;
    TRY_ARRAY(work->entry, mapping->beads);
    TRY_ARRAY(work->begin, mapping->beads + 1);
    TRY_ARRAY(work->kind, mapping->beads);
    for (size_t k = 0; k < mapping->beads; k++)
        work->entry[k] = (struct entry){.group = mapping->bead[k].molecule,
                                        .atom = mapping->atom[mapping->bead[k].first],
                                        .bead = k};
    return STATUS_OK;
}

// By residues -------------------------------------------------------------------------------------

/// Whether a kind has as many beads of each type as a group, whose order then becomes the kind's.
static bool take_group(struct work *work, size_t group, const struct topology_kind *kind) {
    const size_t first = work->begin[group], beads = work->begin[group + 1] - first;
    if (beads != (size_t)kind->beads)
        return false;
    for (size_t n = 0; n < beads; n++) {
        size_t k = first + n;
        while (k < first + beads && type_of(work, k) != (size_t)kind->type[n])
            k++;
        if (k == first + beads)
            return false;
        const struct entry found = work->entry[k];
        memmove(&work->entry[first + n + 1], &work->entry[first + n],
                (k - first - n) * sizeof found);
        work->entry[first + n] = found;
    }
    return true;
}

static bool has_capacity(const struct work *work, int k) {
    const int64_t wanted = work->topology->kind[k].count;
    return wanted == 0 || work->count[k] < wanted;
}

/// Whether there are all molecules, and some of each kind.
static bool is_complete(const struct work *work) {
    for (int k = 0; k < work->topology->kinds; k++)
        if (work->count[k] == 0 || work->count[k] < work->topology->kind[k].count)
            return false;
    return true;
}

static bool match_groups(struct work *work) {
    qsort(work->entry, work->mapping->beads, sizeof *work->entry, by_group);
    for (size_t k = 0; k < work->mapping->beads; k++)
        if (k == 0 || work->entry[k].group != work->entry[k - 1].group)
            work->begin[work->groups++] = k;
    work->begin[work->groups] = work->mapping->beads;
    for (size_t group = 0; group < work->groups; group++) {
        int k = 0;
        while (k < work->topology->kinds &&
               !(has_capacity(work, k) && take_group(work, group, &work->topology->kind[k])))
            k++;
        work->kind[group] = k < work->topology->kinds ? k : NO_KIND;
        if (work->kind[group] != NO_KIND)
            work->count[k]++;
        else if (work->begin[group + 1] - work->begin[group] > 1)
            return false;
    }
    return is_complete(work);
}

// In the order of atoms ---------------------------------------------------------------------------

static enum status fail_bead(const struct work *work, size_t entry, int k, int bead) {
    const struct topology_kind *kind = &work->topology->kind[k];
    if (entry >= work->mapping->beads)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: molecules.%s: the trajectory ends with bead %d of number %lld",
                              work->file, kind->name, bead, (long long)work->count[k] + 1);
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: molecules.%s: bead %d of number %lld would be the bead of atom %zu, which is of type "
        "\"%s\" and not \"%s\": are kinds, numbers and beads those of the trajectory, in its "
        "order?",
        work->file, kind->name, bead + 1, (long long)work->count[k] + 1,
        work->entry[entry].atom + 1, work->mapping->type_name[type_of(work, entry)],
        work->mapping->type_name[kind->type[bead]]);
}

static enum status match_in_order(struct work *work) {
    const size_t beads = work->mapping->beads;
    const struct topology *topology = work->topology;
    size_t at = 0;
    work->groups = 0;
    memset(work->count, 0, sizeof work->count);
    qsort(work->entry, beads, sizeof *work->entry, by_atom);
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        const int64_t wanted = kind->count;
        if (wanted == 0 && topology->kinds > 1)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: molecules.%s: residues of the trajectory do not match; "
                                  "\"count\" is the number of consecutive molecules",
                                  work->file, kind->name);
        for (; wanted == 0 ? at < beads : work->count[k] < wanted; work->count[k]++) {
            for (int bead = 0; bead < kind->beads; bead++)
                if (at + (size_t)bead >= beads ||
                    type_of(work, at + (size_t)bead) != (size_t)kind->type[bead])
                    return fail_bead(work, at + (size_t)bead, k, bead);
            work->begin[work->groups] = at;
            work->kind[work->groups++] = k;
            at += (size_t)kind->beads;
        }
    }
    for (; at < beads; at++) {
        work->begin[work->groups] = at;
        work->kind[work->groups++] = NO_KIND;
    }
    work->begin[work->groups] = beads;
    return STATUS_OK;
}

// Ids ---------------------------------------------------------------------------------------------

static void keep_counts(struct work *work) {
    for (int k = 0; k < work->topology->kinds; k++)
        work->topology->kind[k].count = work->count[k];
}

/// The ids of molecules' beads, and of single ones after them.
static enum status number_beads(const struct work *work, const struct composition *composition,
                                size_t **number) {
    int64_t found[TOPOLOGY_MAX_KINDS] = {0};
    size_t single[COMPOSITION_MAX_TYPES] = {0};
    TRY_ARRAY(*number, work->mapping->beads);
    for (int type = 0; type < composition->types; type++)
        for (int before = 0; before <= type; before++)
            single[type] += (size_t)composition->count[before];
    for (size_t group = work->groups; group-- > 0;) { // single beads from the end
        const size_t entry = work->begin[group];
        if (work->kind[group] == NO_KIND)
            (*number)[--single[type_of(work, entry)]] = work->entry[entry].bead;
    }
    for (size_t group = 0; group < work->groups; group++) {
        const int k = work->kind[group];
        if (k == NO_KIND)
            continue;
        const struct topology_kind *kind = &work->topology->kind[k];
        for (int bead = 0; bead < kind->beads; bead++)
            (*number)[topology_id(kind, found[k], bead)] =
                work->entry[work->begin[group] + (size_t)bead].bead;
        found[k]++;
    }
    return STATUS_OK;
}

/// Find the molecules of `topology`, whose kinds have counts or 0 of unknown ones, among the beads
/// of a mapping, and complete it. The beads of a residue or molecule of the trajectory are one of
/// the kind that has as many of each type; among those of a type the order is that of their first
/// atoms. Where that does not fit all, as of chains of several residues, the beads are taken in the
/// order of their atoms, kind after kind: as many molecules as the file counts, or all of a single
/// kind. What is one bead, and no kind, is a single bead.
/// @param[in] types  of the topology's kinds; its names are those of the mapping's types
/// @param[in] composition  of the mapping
/// @param[out] bead  shape [particles], by the id that the topology gives: number in the mapping
static enum status match_molecules(size_t **bead, struct topology *topology,
                                   const struct composition *types, const struct mapping *mapping,
                                   const struct composition *composition, const char *file) {
    enum status status = STATUS_OK;
    struct work work = {.topology = topology, .mapping = mapping, .file = file};
    CHECK(translate_types(&work, types));
    CHECK(list_beads(&work));
    if (!match_groups(&work))
        CHECK(match_in_order(&work));
    keep_counts(&work);
    CHECK(mf_topology_complete(topology, composition));
    CHECK(number_beads(&work, composition, bead));
done:
    mf_memory_free(work.entry);
    mf_memory_free(work.begin);
    mf_memory_free(work.kind);
    return status;
}

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
            pair[0] = (uint32_t)measured->bead[id];
            pair[1] = (uint32_t)measured->bead[other];
        }
    return STATUS_OK;
}

enum status mf_measured_molecules_begin(struct measured_molecules *measured,
                                        const struct measured_molecules_plan *plan,
                                        const struct mapping *mapping,
                                        const struct composition *composition) {
    *measured = (struct measured_molecules){.molecules = plan->molecules, .mapping = mapping};
    TRY(match_molecules(&measured->bead, &plan->molecules->topology, plan->types, mapping,
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
        particles->id[measured->bead[id]] = id;
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
        const size_t here = measured->bead[topology_id(kind, m, order[n])];
        const size_t there = measured->bead[topology_id(kind, m, from)];
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
                    place[bead] = (int32_t)measured->bead[topology_id(kind, m, term->bead[bead])];
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
    mf_memory_free(measured->bead);
    *measured = (struct measured_molecules){0};
}
