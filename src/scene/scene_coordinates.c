// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_parts.h"

#include "base/memory.h"
#include "topologies/lammps_topology.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

/// Files have three decimals; a bond that is so many times as long as at rest is of other beads,
/// unless less than so many k_B T stretch it, as the soft bonds of a run.
static const double box_tolerance = 2e-3, longest_share = 3, largest_energy = 30;

bool mf_scene_coordinates_are_of_engine(const char *file) {
    const char *dot = strrchr(file, '.');
    return (dot && strcmp(dot, ".gro") == 0) || mf_lammps_topology_is(file);
}

/// The number of each id in the file, from 0 on.
static void number_ids(const struct scene *scene, size_t *number) {
    const struct topology *topology = &scene->molecules.molecules.topology;
    const size_t beads = (size_t)scene->setup.placement.count;
    size_t next = 0;
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            for (int bead = 0; bead < topology->kind[k].beads; bead++)
                number[topology_id(&topology->kind[k], m, bead)] = next++;
    for (size_t id = 0; id < beads; id++)
        if (topology->kinds == 0 || topology->molecule[id] >= (uint64_t)topology->molecules)
            number[id] = next++;
}

static bool is_box(const struct scene *scene, struct json_object *particles,
                   const struct trajectory_frame *frame, double unit) {
    const struct box *box = &scene->setup.box;
    if (fabs(frame->box[1][0]) + fabs(frame->box[2][0]) + fabs(frame->box[2][1]) > box_tolerance) {
        mf_json_fault(particles, "file",
                      "%s: the box is triclinic; a scene needs an orthogonal one",
                      scene->setup.placement.file);
        return false;
    }
    for (int d = 0; d < 3; d++) {
        const double length = unit * (d < box->dimensions ? box->length[d] : 0);
        if (fabs(frame->box[d][d] - length) <= box_tolerance)
            continue;
        mf_json_fault(particles, "file",
                      "%s: its box is %g x %g x %g nm; edge %d of the scene's is %g nm",
                      scene->setup.placement.file, frame->box[0][0], frame->box[1][1],
                      frame->box[2][2], d + 1, length);
        return false;
    }
    return true;
}

/// The length of a bond, by the nearest image.
static double length_of(const struct scene *scene, uint32_t i, uint32_t j) {
    double square = 0;
    for (int d = 0; d < scene->setup.box.dimensions; d++) {
        const double *x = scene->start.position[d];
        const double apart = box_nearest(x[i] - x[j], scene->setup.box.length[d]);
        square += apart * apart;
    }
    return sqrt(square);
}

/// Whether a bond can be so long.
static bool can_be(const struct bonded_curve *curve, double length, double temperature) {
    const double rest = mf_bonded_rest(curve);
    double at_rest, energy;
    if (length > mf_bonded_longest(curve))
        return false;
    mf_bonded_value(curve, rest, &at_rest, NULL);
    mf_bonded_value(curve, length, &energy, NULL);
    return length <= longest_share * rest || rest == 0 ||
           energy - at_rest <= largest_energy * temperature;
}

void mf_scene_coordinates_check_bonds(const struct scene *scene, struct json_object *particles,
                                      const size_t *number) {
    const struct molecules *molecules = &scene->molecules.molecules;
    const double unit = mf_units_known(&scene->units) ? scene->units.length : 1;
    for (int k = 0; k < molecules->topology.kinds; k++) {
        const struct topology_kind *kind = &molecules->topology.kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int n = 0; n < kind->terms[BONDED_BOND]; n++) {
                const struct topology_term *term = &kind->term[BONDED_BOND][n];
                const struct bonded_curve *curve =
                    &molecules->group[BONDED_BOND][term->group].curve;
                const uint32_t i = topology_id(kind, m, term->bead[0]);
                const uint32_t j = topology_id(kind, m, term->bead[1]);
                if (can_be(curve, length_of(scene, i, j), scene->setup.temperature))
                    continue;
                mf_json_fault(particles, "file",
                              "%s: the bond of atoms %zu and %zu, of %s number %lld, is %.3g%s "
                              "long, and at rest %.3g: do the coordinates belong to the topology?",
                              scene->setup.placement.file, (number ? number[i] : i) + 1,
                              (number ? number[j] : j) + 1, kind->name, (long long)m + 1,
                              unit * length_of(scene, i, j),
                              mf_units_known(&scene->units) ? " nm" : "",
                              unit * mf_bonded_rest(curve));
                return;
            }
    }
}

static enum status take_frame(struct scene *scene, struct json_object *particles,
                              const struct trajectory_frame *frame) {
    const size_t beads = (size_t)scene->setup.placement.count;
    const int dimensions = scene->setup.box.dimensions;
    const bool known = mf_units_known(&scene->units);
    const double length = known ? scene->units.length : 1;
    const double speed = known ? length / mf_units_time_ps(&scene->units) : 1;
    OWNED size_t *number = NULL;
    TRY_ARRAY(number, beads);
    TRY_ARRAY(scene->start_values, 2 * (size_t)dimensions * beads);
    number_ids(scene, number);
    for (size_t id = 0; id < beads && scene->molecules.order; id++)
        number[id] = scene->molecules.order[number[id]];
    for (int d = 0; d < dimensions; d++) {
        double *x = scene->start_values + (size_t)d * beads;
        double *v = scene->start_values + (size_t)(dimensions + d) * beads;
        for (size_t id = 0; id < beads; id++) {
            x[id] = frame->position[number[id]][d] / length;
            v[id] = frame->has_velocities ? frame->velocity[number[id]][d] / speed : 0;
        }
        scene->start.position[d] = x;
        if (frame->has_velocities)
            scene->start.velocity[d] = v;
    }
    if (is_box(scene, particles, frame, length))
        mf_scene_coordinates_check_bonds(scene, particles, number);
    return STATUS_OK;
}

/// In which order the file has the atoms.
static enum status find_order(struct scene *scene) {
    const char *file = scene->setup.placement.file;
    struct scene_molecules *molecules = &scene->molecules;
    if (!mf_lammps_topology_is(file) && molecules->order)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: a LAMMPS data file has the coordinates of its molecules", file);
    if (!mf_lammps_topology_is(file) || molecules->order)
        return STATUS_OK;
    TRY(mf_lammps_topology_units(file, "", &scene->units, &molecules->order_units));
    return mf_lammps_topology_order(file, molecules->order_units, &molecules->molecules.topology,
                                    &scene->setup.composition, &molecules->order);
}

enum status mf_scene_coordinates_read(struct scene *scene, struct json_object *particles) {
    const char *file = scene->setup.placement.file;
    struct trajectory trajectory;
    struct trajectory_frame frame = {0};
    bool more = true;
    if (mf_json_fault_count(particles->document) > 0)
        return STATUS_OK; // whose places they are may not be known
    if (scene->molecules.scattered) {
        mf_json_fault(particles, "file",
                      "%s: coordinates need each moleculetype only once in [ molecules ]", file);
        return STATUS_OK;
    }
    enum status status = find_order(scene);
    const struct trajectory_options options = {.units = scene->molecules.order_units};
    if (status == STATUS_OK)
        status = mf_trajectory_open(&trajectory, file, &options);
    if (status == STATUS_OK) {
        status = mf_trajectory_next(&trajectory, &frame, &more);
        if (status == STATUS_OK && frame.atoms != (size_t)scene->setup.placement.count)
            mf_json_fault(particles, "file", "%s: %zu atoms; the scene has %lld beads", file,
                          frame.atoms, (long long)scene->setup.placement.count);
        else if (status == STATUS_OK)
            status = take_frame(scene, particles, &frame);
        mf_trajectory_close(&trajectory);
    }
    mf_frame_clear(&frame);
    if (status == STATUS_OK || status == STATUS_NO_MEMORY)
        return status;
    mf_json_fault(particles, "file", "%s", mf_status_marked());
    return STATUS_OK;
}
