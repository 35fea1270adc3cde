// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/molecules_file.h"

#include "topologies/gromacs_topology.h"
#include "topologies/structure_topology.h"
#include "base/memory.h"
#include "io/json.h"
#include "scene/scene_parts.h"
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

static bool have_same_ids(const struct structure *list, const struct structure *of) {
    bool same = list->atoms == of->atoms;
    for (size_t k = 0; k < of->atoms && same; k++)
        same = list->atom[k].id == of->atom[k].id;
    return same;
}

/// Atoms of the same ids are the same atoms, and of the same types.
static enum status fail_type(const char *file, const struct structure_atom *listed,
                             const struct structure_atom *atom) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: atom %lld is of type %lld, in the trajectory of %lld", file,
                          (long long)atom->id, (long long)listed->type, (long long)atom->type);
}

/// Whether atoms of the trajectory are called as those of the listing, or are of its numbers of
/// types, again and again; one without names must be listed from end to end.
static enum status find_listed(const struct structure *list, const char *file,
                               const struct structure *of, bool *listed) {
    const bool numbers = (list->names == STRUCTURE_TYPES || list->has_types) && of->has_types;
    const bool names = list->has_names && of->has_names && (list->names == of->names || numbers);
    const bool ids = list->has_ids && of->has_ids && list->atoms == of->atoms;
    *listed = list->atoms > 0 && of->atoms % list->atoms == 0 &&
              (names || list->atoms == of->atoms) && (!ids || have_same_ids(list, of));
    for (size_t k = 0; k < of->atoms && names && *listed; k++) {
        const struct structure_atom *const a = &list->atom[k % list->atoms], *const b =
                                                                                 &of->atom[k];
        *listed = strcmp(a->name, b->name) == 0 || (numbers && a->type == b->type);
        if (ids && numbers && !*listed)
            return fail_type(file, a, b);
    }
    return STATUS_OK;
}

/// Molecules are what bonds join, or what the listing numbers.
static enum status find_molecules(struct structure *list) {
    const struct structure_terms *const bonds = &list->terms[0];
    if (bonds->count == 0)
        return STATUS_OK;
    for (size_t k = 0; k < list->atoms; k++)
        list->atom[k].molecule = 0;
    return mf_structure_join(list, (const uint32_t(*)[2])(const void *)bonds->atom, bonds->count);
}

/// Names of types and numbers of molecules, of which those of each repeat follow each other.
static enum status take_names(struct structure *own, const struct structure *list) {
    own->has_names = own->has_molecules = true;
    own->has_residues = false;
    own->names = STRUCTURE_NAMES;
    for (size_t k = 0; k < own->atoms; k++) {
        const struct structure_atom *const from = &list->atom[k % list->atoms];
        const int64_t before = (int64_t)(k - k % list->atoms);
        memcpy(own->atom[k].name, from->type_name[0] ? from->type_name : from->name,
               STRUCTURE_NAME);
        own->atom[k].type = 0;
        own->atom[k].molecule = from->molecule > 0 ? before + from->molecule : 0;
    }
    return mf_structure_number_residues(own);
}

static void take_masses(struct structure *own, const struct structure *list) {
    for (size_t k = 0; k < own->atoms; k++)
        if (!own->has_masses || !(own->atom[k].mass >= 0))
            own->atom[k].mass = list->atom[k % list->atoms].mass;
    own->has_masses = own->has_masses || list->has_masses;
}

static enum status take(struct molecules_listing *listing, struct structure *list,
                        const struct structure *of, bool mapped) {
    struct structure *const own = &listing->structure;
    TRY(mf_structure_init(own, of->atoms));
    struct structure_atom *const atom = own->atom;
    *own = *of;
    own->atom = memcpy(atom, of->atom, of->atoms * sizeof *atom);
    memset(own->terms, 0, sizeof own->terms); // which are the other's
    listing->repeats = of->atoms / list->atoms;
    take_masses(own, list);
    if (mapped)
        return STATUS_OK;
    TRY(find_molecules(list));
    return take_names(own, list);
}

enum status mf_molecules_listing_read(struct molecules_listing *listing, struct topology *molecules,
                                      const char *file, const char *units,
                                      const struct structure *of, bool mapped) {
    struct trajectory trajectory;
    enum status status;
    *listing = (struct molecules_listing){.repeats = 0};
    if (!mf_molecules_file_lists(file))
        return STATUS_OK;
    bool listed = false;
    TRY(mf_structure_topology_open(&trajectory, file, units));
    status = find_listed(&trajectory.structure, file, of, &listed);
    if (status == STATUS_OK && listed)
        status = take(listing, &trajectory.structure, of, mapped);
    for (int k = 0; k < molecules->kinds && listing->repeats > 0; k++)
        molecules->kind[k].count *= (int64_t)listing->repeats;
    mf_trajectory_close(&trajectory);
    return status;
}

void mf_molecules_listing_clear(struct molecules_listing *listing) {
    if (listing->structure.atoms > 0)
        mf_structure_clear(&listing->structure);
    *listing = (struct molecules_listing){.repeats = 0};
}
