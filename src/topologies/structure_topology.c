// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/structure_topology.h"

#include "base/memory.h"
#include "base/names.h"
#include "topologies/lammps_kinds.h"
#include "topologies/lammps_topology.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

bool mf_structure_topology_is(const char *file) {
    const char *const end = strrchr(file, '.');
    const char *const slash = strrchr(file, '/'), *const name = slash ? slash + 1 : file;
    return mf_lammps_topology_is(file) || strncmp(name, "molecule.", 9) == 0 ||
           (end && (strcasecmp(end, ".psf") == 0 || strcasecmp(end, ".gsd") == 0 ||
                    strcasecmp(end, ".mol") == 0));
}

enum status mf_structure_topology_open(struct trajectory *trajectory, const char *file,
                                       const char *units) {
    const struct trajectory_options own = {.units = NULL}, told = {.units = units ? units : "lj"};
    return mf_trajectory_open(trajectory, file, &own) == STATUS_OK
               ? STATUS_OK
               : mf_trajectory_open(trajectory, file, &told);
}

struct reading {
    struct molecules *molecules;
    const char *file;
    const struct structure *structure;
    int *group[BONDED_KINDS];                            ///< shape [terms]: of each
    uint32_t called[BONDED_KINDS][MOLECULES_MAX_GROUPS]; ///< a group in the file, by its number
};

// Groups ------------------------------------------------------------------------------------------

/// "A-B-C", from the end whose names come first.
static void name_by_atoms(const struct structure *structure, int order, const uint32_t *atom,
                          char *name, size_t size) {
    const int last = order + 1;
    int turned = 0;
    size_t length = 0;
    for (int k = 0; k <= last / 2 && turned == 0; k++)
        turned = strcmp(structure->atom[atom[k]].name, structure->atom[atom[last - k]].name);
    for (int k = 0; k <= last && length < size; k++)
        length += (size_t)snprintf(name + length, size - length, "%s%s", k > 0 ? "-" : "",
                                   structure->atom[atom[turned > 0 ? last - k : k]].name);
}

static enum status find_group(struct reading *reading, int order, size_t n, int *group) {
    struct molecules *const molecules = reading->molecules;
    const struct structure_terms *const terms = &reading->structure->terms[order];
    const struct bonded_kind *const kind = mf_bonded_kinds[order];
    const uint32_t number = terms->type ? terms->type[n] : 0;
    char called[BONDED_MAX_TERM_BEADS * STRUCTURE_NAME + 1], name[TOPOLOGY_NAME_SIZE];
    if (terms->type)
        snprintf(called, sizeof called, "%s", terms->name[number]);
    else
        name_by_atoms(reading->structure, order, terms->atom + n * (size_t)kind->beads, called,
                      sizeof called);
    mf_names_adapt(called, "_-", name, sizeof name);
    for (*group = 0; *group < molecules->groups[order]; ++*group)
        if (strcmp(molecules->group[order][*group].name, name) == 0 &&
            reading->called[order][*group] == number)
            return STATUS_OK;
        else if (strcmp(molecules->group[order][*group].name, name) == 0)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %s %zu: \"%s\" and another would both be called \"%s\": "
                                  "give the molecules by a JSON file",
                                  reading->file, kind->name, n + 1, called, name);
    if (strlen(called) >= sizeof name || !mf_topology_is_name(name))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: %s %zu: \"%s\": expected a group name of " NAMES_OF_OTHERS
                              ": give the molecules by a JSON file",
                              reading->file, kind->name, n + 1, called, TOPOLOGY_NAME_SIZE - 1);
    if (*group == MOLECULES_MAX_GROUPS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: more than %d types of %s: give the molecules by a JSON file",
                              reading->file, MOLECULES_MAX_GROUPS, kind->plural);
    reading->called[order][*group] = number;
    return mf_molecules_add_group(molecules, order, name, kind->laws[0]);
}

static enum status find_groups(struct reading *reading, int order) {
    const size_t count = reading->structure->terms[order].count;
    TRY_ARRAY(reading->group[order], count);
    for (size_t n = 0; n < count; n++)
        TRY(find_group(reading, order, n, &reading->group[order][n]));
    return STATUS_OK;
}

// Kinds -------------------------------------------------------------------------------------------

static enum status find_kinds(struct reading *reading, struct composition *types) {
    OWNED size_t *order = NULL;
    return mf_lammps_kinds_find(&(struct lammps_kinds_source){.file = reading->file,
                                                              .structure = reading->structure,
                                                              .group = reading->group,
                                                              .exclude = 0,
                                                              .named = true},
                                &reading->molecules->topology, types, &order);
}

/// Whether two kinds have as many beads of each type.
static bool have_same_beads(const struct topology_kind *a, const struct topology_kind *b) {
    int more[COMPOSITION_MAX_TYPES] = {0};
    if (a->beads != b->beads)
        return false;
    for (int bead = 0; bead < a->beads; bead++) {
        more[a->type[bead]]++;
        more[b->type[bead]]--;
    }
    for (int type = 0; type < COMPOSITION_MAX_TYPES; type++)
        if (more[type] != 0)
            return false;
    return true;
}

/// Molecules of a trajectory are known by their beads.
static enum status check_kinds(struct reading *reading, const struct composition *types) {
    struct topology *const topology = &reading->molecules->topology;
    for (int type = 0; type < types->types; type++)
        if (!mf_composition_is_name(types->name[type]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: \"%s\": expected a type name of " NAMES_OF_TYPE
                                  ": give the molecules by a JSON file",
                                  reading->file, types->name[type], COMPOSITION_NAME_SIZE - 1);
    for (int k = 0; k < topology->kinds; k++) {
        topology->kind[k].exclude = mf_topology_reach(&topology->kind[k]);
        const enum status status = mf_topology_check(&topology->kind[k]);
        if (status != STATUS_OK)
            return mf_status_prefix(status, "%s: %s", reading->file, topology->kind[k].name);
        for (int other = 0; other < k; other++)
            if (have_same_beads(&topology->kind[k], &topology->kind[other]))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: molecules of the same beads differ in the order of "
                                      "these or in what joins them: give them by a JSON file",
                                      reading->file);
    }
    return STATUS_OK;
}

enum status mf_structure_topology_read(struct molecules *molecules, struct composition *types,
                                       const char *file) {
    enum status status = STATUS_OK;
    struct trajectory trajectory;
    struct reading reading = {.molecules = molecules, .file = file};
    TRY(mf_structure_topology_open(&trajectory, file, NULL)); // lengths are not used
    reading.structure = &trajectory.structure;
    for (int order = 0; order < STRUCTURE_TERM_KINDS; order++)
        CHECK(find_groups(&reading, order));
    CHECK(find_kinds(&reading, types));
    CHECK(check_kinds(&reading, types));
done:
    for (int order = 0; order < STRUCTURE_TERM_KINDS; order++)
        mf_memory_free(reading.group[order]);
    mf_trajectory_close(&trajectory);
    return status;
}
