// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_molecules.h"

#include "topologies/gromacs_topology.h"
#include "topologies/lammps_topology.h"

#include <stdio.h>

struct topology_file_input {
    char file[FIELD_TEXT_SIZE];
    int64_t exclude;
    int units;
};
static const char *const file_units[] = {"auto", "lj", "real", "metal", NULL};
#define TOLD_FILE(member) .offset = offsetof(struct topology_file_input, member)
const struct field mf_scene_file_fields[] = {
    {"file", FIELD_FILE, TOLD_FILE(file), .required = true, .unit = "",
     .help = "GROMACS topology (.top, .itp) or LAMMPS data file (.data, data.…)"},
    {"exclude", FIELD_INTEGER, TOLD_FILE(exclude), .initial = TOPOLOGY_MAX_EXCLUDE, .minimum = 0,
     .maximum = TOPOLOGY_MAX_EXCLUDE, .unit = "",
     .help = "LAMMPS: largest number of bonds between beads without pair interactions; 3 as "
             "special_bonds 0 0 0"},
    {"units", FIELD_CHOICE, TOLD_FILE(units), .choices = file_units, .initial = 0, .unit = "",
     .help = "units of a data file without any; auto: real, or lj if the scene has no units"},
    FIELD_END,
};

/// A topology of GROMACS.
static enum status read_top(struct scene_molecules *own, struct json_object *object,
                            struct composition *composition,
                            const struct topology_file_input *given, const struct units *units,
                            struct molecules *groups) {
    struct gromacs_note note;
    *groups = own->molecules;
    own->molecules = (struct molecules){0};
    for (const char *const *key = (const char *const[]){"exclude", "units", NULL}; *key; key++)
        if (mf_json_has(object, *key))
            mf_json_fault(object, *key, "a GROMACS topology defines it; leave it out");
    TRY(mf_gromacs_topology_read(&own->molecules, composition, given->file, units, &note));
    snprintf(own->warning, sizeof own->warning, "%s", note.text);
    own->scattered = note.scattered;
    return STATUS_OK;
}

/// A data file of LAMMPS, whose atoms keep their order for the file's coordinates.
static enum status read_data(struct scene_molecules *own, struct composition *composition,
                             const struct topology_file_input *given, const struct units *units) {
    TRY(mf_lammps_topology_units(given->file, given->units > 0 ? file_units[given->units] : "",
                                 units, &own->order_units));
    return mf_lammps_topology_read(&own->molecules, composition, given->file, units,
                                   own->order_units, (int)given->exclude, &own->order,
                                   own->warning);
}

enum status mf_scene_topology_read(struct scene_molecules *molecules, struct json_object *object,
                                   struct json_object *scene, const struct scene_fitted *fitted,
                                   struct composition *composition, const struct units *units) {
    const size_t faults = mf_json_fault_count(object->document);
    enum status status = STATUS_OK;
    struct topology_file_input given;
    struct molecules groups = {0};
    mf_json_fields(object, mf_scene_file_fields, &given);
    if (mf_json_fault_count(object->document) == faults)
        status = mf_lammps_topology_is(given.file)
                     ? read_data(molecules, composition, &given, units)
                     : read_top(molecules, object, composition, &given, units, &groups);
    mf_json_finish(object);
    if (status == STATUS_OK && molecules->order == NULL &&
        mf_json_fault_count(object->document) == faults)
        mf_scene_groups_join(&molecules->molecules, &groups, fitted, scene);
    mf_molecules_clear(&groups);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        mf_json_fault(object, "file", "%s", mf_status_marked());
    return STATUS_OK;
}
