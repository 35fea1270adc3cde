// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_system.h"

#include "curves/bonded_table.h"
#include "topologies/gromacs_topology.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The configuration -------------------------------------------------------------------------------

/// A file with atoms in a box, if it is one. Which files these are is for its readers to say.
static bool open_configuration(struct trajectory *trajectory, struct trajectory_frame *frame,
                               const char *path) {
    static const char *const units[] = {NULL, "real"}; // those of LAMMPS's files for VOTCA
    if (access(path, R_OK) != 0)
        return false;
    for (int k = 0; k < 2; k++) {
        bool more = false;
        if (mf_trajectory_open(trajectory, path, &(struct trajectory_options){.units = units[k]}) !=
            STATUS_OK)
            continue;
        if (mf_trajectory_next(trajectory, frame, &more) == STATUS_OK && more && frame->has_box)
            return true;
        mf_trajectory_close(trajectory);
    }
    return false;
}

/// Try the files that a text names, one word after the other.
static bool open_first(struct trajectory *trajectory, struct trajectory_frame *frame,
                       const struct import_settings *settings, const char *text, char *path) {
    char name[OUTPUT_PATH_SIZE];
    for (size_t length; text += strspn(text, " \t\n\r"), (length = strcspn(text, " \t\n\r")) > 0;
         text += length) {
        snprintf(name, sizeof name, "%.*s", (int)length, text);
        mf_import_settings_path(settings, name, path);
        if (open_configuration(trajectory, frame, path))
            return true;
    }
    return false;
}

static bool find_configuration(struct trajectory *trajectory, struct trajectory_frame *frame,
                               const struct import_settings *settings, char *path) {
    static const char *const paths[] = {"inverse.gromacs.conf", "inverse.lammps.topol",
                                        "inverse.filelist"};
    const struct xml_element *const root = settings->document.root;
    const char *const given = mf_xml_text(root, paths[0]);
    if (open_first(trajectory, frame, settings, given[0] ? given : "conf.gro", path))
        return true;
    for (size_t k = 1; k < sizeof paths / sizeof *paths; k++)
        if (open_first(trajectory, frame, settings, mf_xml_text(root, paths[k]), path))
            return true;
    path[0] = '\0';
    return false;
}

static enum status take_box(struct import_system *system, const struct trajectory_frame *frame,
                            const char *path) {
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++)
            if (i != d && frame->box[i][d] != 0)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: the box is not rectangular: give one of the same volume "
                                      "by --box",
                                      path);
    for (int d = 0; d < 3; d++)
        system->box[d] = frame->box[d][d];
    snprintf(system->box_file, sizeof system->box_file, "%s", path);
    return STATUS_OK;
}

// Beads -------------------------------------------------------------------------------------------

static int find_type(const struct composition *composition, const char *name) {
    int type = 0;
    while (type < composition->types && strcmp(composition->name[type], name) != 0)
        type++;
    return type;
}

static enum status add_type(struct composition *composition, const char *name,
                            const struct import_settings *settings) {
    if (find_type(composition, name) < composition->types)
        return STATUS_OK;
    if (composition->types == COMPOSITION_MAX_TYPES)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: more than %d types of beads",
                              settings->document.file, COMPOSITION_MAX_TYPES);
    snprintf(composition->name[composition->types++], COMPOSITION_NAME_SIZE, "%s", name);
    return STATUS_OK;
}

/// The types that the settings name, without counts.
static enum status take_types(struct import_system *system,
                              const struct import_settings *settings) {
    for (size_t k = 0; k < settings->pairs; k++)
        for (int n = 0; n < 2; n++)
            TRY(add_type(&system->beads, settings->pair[k].type[n], settings));
    return STATUS_OK;
}

/// "A=100,B=50".
static enum status take_counts(struct import_system *system, const char *text) {
    const char *at = text;
    while (*at) {
        char name[COMPOSITION_NAME_SIZE];
        long long count;
        int length = 0;
        if (sscanf(at, "%15[A-Za-z0-9_]=%lld%n", name, &count, &length) != 2 || count < 1 ||
            (at[length] != '\0' && at[length] != ','))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "--count takes numbers of beads as A=100,B=50, "
                                  "not \"%.60s\"",
                                  text);
        const int type = find_type(&system->beads, name);
        if (type == system->beads.types)
            return mf_status_fail(STATUS_BAD_INPUT, "--count: no <non-bonded> has the type \"%s\"",
                                  name);
        system->beads.count[type] = count;
        at += length + (at[length] == ',');
    }
    return STATUS_OK;
}

static void add_mass(struct import_mass *mass, double of_bead, double beads) {
    mass->low = mass->count > 0 ? fmin(mass->low, of_bead) : of_bead;
    mass->high = mass->count > 0 ? fmax(mass->high, of_bead) : of_bead;
    mass->sum += beads * of_bead;
    mass->count += beads;
}

/// Masses of the atoms that are called as types are, or of the only type that there is.
static void take_masses(struct import_system *system, const struct structure *structure) {
    const struct composition *const beads = &system->beads;
    for (size_t k = 0; k < structure->atoms; k++) {
        const int type = beads->types == 1 ? 0 : find_type(beads, structure->atom[k].name);
        if (type < beads->types)
            add_mass(&system->mass[type], structure->atom[k].mass, 1);
    }
}

/// Atoms are beads of the type that they are called by, or all of the only type that there is.
static enum status count_atoms(struct import_system *system, const struct structure *structure,
                               const char *file) {
    struct composition *const beads = &system->beads;
    for (size_t k = 0; k < structure->atoms; k++) {
        const int type = beads->types == 1 ? 0 : find_type(beads, structure->atom[k].name);
        if (type == beads->types)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: no <non-bonded> has the type of atom %zu, \"%s\": give the "
                                  "numbers of beads by --count A=100,B=50",
                                  file, k + 1, structure->atom[k].name);
        beads->count[type]++;
    }
    take_masses(system, structure);
    snprintf(system->beads_file, sizeof system->beads_file, "%s", file);
    return STATUS_OK;
}

static enum status check_counts(const struct import_system *system,
                                const struct import_settings *settings) {
    for (int type = 0; type < system->beads.types; type++)
        if (system->beads.count[type] == 0)
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: nothing beside it (topol.top, conf.gro) has beads of type \"%s\": give their "
                "number by --count %s=N",
                settings->document.file, system->beads.name[type], system->beads.name[type]);
    return STATUS_OK;
}

// Molecules ---------------------------------------------------------------------------------------

/// A table that the settings do not have is a known potential, if its file is there.
static enum status add_group(struct import_settings *settings, int order, int number,
                             const char *name, const char *file) {
    char path[OUTPUT_PATH_SIZE];
    struct import_group group = {.order = order, .table = number};
    memcpy(group.name, name, TOPOLOGY_NAME_SIZE);
    snprintf(group.table_file, sizeof group.table_file, "table_%c%d.xvg", "bad"[order], number);
    mf_import_settings_path(settings, group.table_file, path);
    if (access(path, R_OK) != 0 || settings->groups == IMPORT_MAX_INTERACTIONS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: %s is not beside it, nor has %s a <bonded> with this "
                              "<inverse><gromacs><table>",
                              file, group.table_file, settings->document.file);
    settings->group[settings->groups++] = group;
    return STATUS_OK;
}

/// A group of a topology takes the name that the settings have for its table.
static enum status name_group(struct import_settings *settings, int order,
                              struct molecules_group *group, const char *file) {
    const struct bonded_table *const table = group->curve.parameters;
    int number;
    if (!bonded_is_table(group->curve.law) || sscanf(table->file, "table %d", &number) != 1)
        return STATUS_OK;
    for (size_t k = 0; k < settings->groups; k++)
        if (settings->group[k].order == order && settings->group[k].table == number) {
            memcpy(group->name, settings->group[k].name, TOPOLOGY_NAME_SIZE);
            return STATUS_OK;
        }
    return add_group(settings, order, number, group->name, file);
}

/// Molecules of one bead are single beads.
static void drop_single(struct import_system *system) {
    struct topology *const topology = &system->molecules.molecules.topology;
    int left = 0;
    system->single = system->beads;
    for (int k = 0; k < topology->kinds; k++) {
        struct topology_kind *const kind = &topology->kind[k];
        for (int bead = 0; bead < kind->beads && kind->beads > 1; bead++)
            system->single.count[kind->type[bead]] -= kind->count;
        if (kind->beads > 1) {
            struct topology_kind kept = *kind;
            topology->kind[k] = topology->kind[left];
            topology->kind[left] = kept;
            left++;
        }
    }
    struct topology dropped = *topology;
    for (int k = left; k < topology->kinds; k++)
        dropped.kind[k - left] = topology->kind[k];
    dropped.kinds = topology->kinds - left;
    topology->kinds = left;
    mf_topology_clear(&dropped);
}

/// Masses of the beads of each type: a topology's atoms stand molecule after molecule, or, in
/// another order than that of the kinds, are known by their names.
static void find_masses(struct import_system *system, const char *file, bool scattered) {
    const struct topology *const topology = &system->molecules.molecules.topology;
    struct trajectory atoms;
    size_t at = 0;
    if (mf_trajectory_open(&atoms, file, &(struct trajectory_options){.units = NULL}) != STATUS_OK)
        return;
    if (scattered)
        take_masses(system, &atoms.structure);
    for (int k = 0; k < topology->kinds && !scattered; k++) {
        const struct topology_kind *const kind = &topology->kind[k];
        for (int bead = 0; bead < kind->beads; bead++)
            if (at + (size_t)bead < atoms.structure.atoms)
                add_mass(&system->mass[kind->type[bead]],
                         atoms.structure.atom[at + (size_t)bead].mass, (double)kind->count);
        at += (size_t)(kind->count * kind->beads);
    }
    mf_trajectory_close(&atoms);
}

/// Beads of types beyond those of the settings have no targets.
static enum status check_types(const struct import_system *system, int types,
                               const struct import_settings *settings, const char *file) {
    if (system->beads.types == types)
        return STATUS_OK;
    const char *const name = system->beads.name[types];
    return mf_xml_fail(&settings->document, settings->document.root,
                       "no <non-bonded> has a target for beads %s of %.1000s: add the pair %s-%s, "
                       "and those with the other types",
                       name, file, name, name);
}

static enum status read_topology(struct import_system *system, struct import_settings *settings,
                                 const char *file) {
    static const struct units nanometres = {0};
    struct molecules *const molecules = &system->molecules.molecules;
    const int types = system->beads.types;
    struct gromacs_note note;
    TRY(mf_gromacs_topology_read(molecules, &system->beads, file, &nanometres, &note));
    TRY(check_types(system, types, settings, file));
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++)
            TRY(name_group(settings, order, &molecules->group[order][g], file));
    find_masses(system, file, note.scattered);
    drop_single(system);
    snprintf(system->beads_file, sizeof system->beads_file, "%s", file);
    return STATUS_OK;
}

static enum status find_beads(struct import_system *system, struct import_settings *settings,
                              const struct import_options *options,
                              const struct trajectory *configuration) {
    const char *const given = mf_xml_text(settings->document.root, "inverse.gromacs.topol_in");
    char topology[OUTPUT_PATH_SIZE];
    mf_import_settings_path(settings, given[0] ? given : "topol.top", topology);
    TRY(take_types(system, settings));
    if (options->count) {
        TRY(take_counts(system, options->count));
    } else if (access(topology, R_OK) == 0) {
        TRY(read_topology(system, settings, topology));
        return check_counts(system, settings);
    } else if (configuration->file) {
        TRY(count_atoms(system, &configuration->structure, configuration->file));
    }
    system->single = system->beads;
    if (settings->groups > 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: no topol.top beside it says which beads \"%s\" binds",
                              settings->document.file, settings->group[0].name);
    return check_counts(system, settings);
}

enum status mf_import_system_find(struct import_system *system, struct import_settings *settings,
                                  const struct import_options *options) {
    enum status status = STATUS_OK;
    struct trajectory configuration = {0};
    struct trajectory_frame frame = {0};
    char path[OUTPUT_PATH_SIZE];
    *system = (struct import_system){0};
    const bool found = find_configuration(&configuration, &frame, settings, path);
    if (options->box[0] > 0)
        memcpy(system->box, options->box, sizeof system->box);
    else if (found)
        CHECK(take_box(system, &frame, path));
    else
        CHECK(
            mf_status_fail(STATUS_BAD_INPUT,
                           "%s: nothing beside it (conf.gro) has a box: give it by --box LX,LY,LZ "
                           "[nm]",
                           settings->document.file));
    CHECK(find_beads(system, settings, options, &configuration));
done:
    mf_frame_clear(&frame);
    if (found)
        mf_trajectory_close(&configuration);
    if (status != STATUS_OK)
        mf_import_system_clear(system);
    return status;
}

void mf_import_system_clear(struct import_system *system) {
    mf_scene_molecules_clear(&system->molecules);
}

double mf_import_system_mass(const struct import_system *system, int type) {
    const struct import_mass *const mass = &system->mass[type];
    return mass->count > 0 ? mass->sum / mass->count : NAN;
}
