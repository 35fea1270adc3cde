// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/molecules_file.h"

#include "topologies/gromacs_topology.h"
#include "topologies/structure_topology.h"
#include "base/memory.h"
#include "io/json.h"
#include "trajectory/votca_map.h"

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
