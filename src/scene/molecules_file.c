// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/molecules_file.h"

#include "topologies/gromacs_topology.h"
#include "topologies/structure_topology.h"
#include "base/memory.h"
#include "io/json.h"
#include "scene/scene_attributes.h"
#include "trajectory/votca_map.h"

#include <math.h>
#include <string.h>

/// "particles": {"types": {"W": 400}}: single beads, whose types come first.
static void read_types(struct json_object *root, struct composition *types) {
    const char *name;
    if (!mf_json_is_object(root, "particles"))
        return;
    struct json_object particles = mf_json_child(root, "particles", false);
    if (!mf_json_is_object(&particles, "types"))
        return;
    struct json_object object = mf_json_child(&particles, "types", false);
    for (size_t n = 0; (name = mf_json_key(&object, n)) && n < COMPOSITION_MAX_TYPES; n++)
        if (mf_composition_is_name(name))
            strcpy(types->name[types->types++], name);
}

static bool is_topology(const char *file) {
    const char *end = strrchr(file, '.');
    return end && (strcmp(end, ".top") == 0 || strcmp(end, ".itp") == 0);
}

bool mf_molecules_file_lists(const char *file) {
    return is_topology(file) || mf_structure_topology_is(file);
}

/// A topology of GROMACS, whatever its laws, or what a PSF, GSD or data file lists.
static enum status read_topology(struct scene_molecules *molecules, struct composition *types,
                                 const char *file) {
    struct gromacs_note note;
    enum status status =
        mf_structure_topology_is(file)
            ? mf_structure_topology_read(&molecules->molecules, types, file)
            : mf_gromacs_topology_read(&molecules->molecules, types, file, NULL, &note);
    if (status == STATUS_OK)
        status = mf_scene_groups_clear_tables(&molecules->molecules);
    if (status != STATUS_OK)
        mf_scene_molecules_clear(molecules);
    return status;
}

/// A JSON file, or what maps of VOTCA are in JSON.
static enum status open_file(struct json_document **document, const char *file) {
    OWNED char *text = NULL;
    if (!mf_votca_map_is(file))
        return mf_json_open(document, file);
    TRY(mf_votca_map_bonds(&text, file));
    if (text == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: <cg_bonded> is missing or empty", file);
    return mf_json_open_text(document, file, text);
}

enum status mf_molecules_file_read(struct scene_molecules *molecules, struct composition *types,
                                   const char *file) {
    struct json_document *document;
    *molecules = (struct scene_molecules){0};
    *types = (struct composition){0};
    if (mf_molecules_file_lists(file))
        return read_topology(molecules, types, file);
    TRY(open_file(&document, file));
    struct json_object root = mf_json_root(document);
    read_types(&root, types);
    const enum status status =
        mf_json_close(document, mf_scene_kinds_read(molecules, &root, types));
    if (status == STATUS_OK && !scene_has_molecules(molecules))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: \"molecules\" is missing or empty", file);
    if (status != STATUS_OK)
        mf_scene_molecules_clear(molecules);
    return status;
}

/// Masses in a file [u]: what 1 is, and what beads have of which nothing is said; NAN: not known.
struct masses {
    double unit, usual;
};

static struct masses find_masses(struct json_object *root, bool reduced_trajectory) {
    double mass = NAN;
    if (mf_json_is_object(root, "units")) {
        struct json_object object = mf_json_child(root, "units", false);
        mf_json_numbers(&object, "mass", &mass, 1);
        if (mf_json_has(&object, "system"))
            return (struct masses){1, mass == 1 ? NAN : mass}; // 1 u stands for none
        mass /= UNITS_ATOMIC_MASS;
    } else if (mf_json_has(root, "units"))
        return (struct masses){1, NAN}; // "nm-ps"
    if (reduced_trajectory)
        mass = 1;
    return (struct masses){mass, mass};
}

static void read_masses(struct json_object *root, const struct composition *types,
                        struct masses known, double mass[COMPOSITION_MAX_TYPES]) {
    struct scene scene = {.setup.composition = *types};
    struct json_object particles = mf_json_child(root, "particles", false);
    if (!isnan(known.unit))
        mf_scene_attributes_read(&scene, &particles);
    const struct attributes_source *const source = &scene.setup.attribute[ATTRIBUTES_MASS];
    for (int type = 0; type < types->types; type++) {
        const struct attributes_range *range = &source->range[source->ranges == 1 ? 0 : type];
        const bool same = range->minimum == range->maximum;
        mass[type] = source->ranges == 0 ? known.usual : same ? known.unit * range->minimum : NAN;
    }
}

enum status mf_molecules_file_masses(double mass[COMPOSITION_MAX_TYPES],
                                     const struct composition *types, const char *file,
                                     const char *units) {
    struct json_document *document;
    for (int type = 0; type < COMPOSITION_MAX_TYPES; type++)
        mass[type] = NAN;
    if (mf_molecules_file_lists(file) || mf_votca_map_is(file))
        return STATUS_OK;
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    read_masses(&root, types, find_masses(&root, units && strcmp(units, "lj") == 0), mass);
    return mf_json_close(document, STATUS_OK);
}
