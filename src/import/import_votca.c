// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_votca.h"

#include "base/memory.h"
#include "import/import_settings.h"
#include "io/json_write.h"
#include "io/text_file.h"
#include "io/tracked_files.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LIST_SIZE = 600 };

/// Print a line, to whom watches or on stdout: it is what the command is asked for.
__attribute__((format(printf, 2, 3))) static void say(struct progress *progress, const char *format,
                                                      ...) {
    char text[LIST_SIZE + OUTPUT_PATH_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (progress->watcher)
        mf_progress_print(progress, "%s", text);
    else if (!progress->quiet)
        printf("%s\n", text);
}

// What is not taken -------------------------------------------------------------------------------

/// The first line whose path begins that of an element says what becomes of it.
static const struct {
    const char *path, *reason; ///< NULL: it is read
} fates[] = {
    {"non-bonded.name", NULL},
    {"non-bonded.type", NULL},
    {"non-bonded.max", NULL},
    {"non-bonded.inverse.target", NULL},
    {"non-bonded.inverse.optimizer.rdf.target", NULL},
    {"bonded.name", NULL},
    {"bonded.inverse.target", NULL},
    {"bonded.inverse.gromacs.table", NULL},
    {"inverse.kBT", NULL},
    {"non-bonded.min", "ranges and bins are those of the targets"},
    {"non-bonded.step", "ranges and bins are those of the targets"},
    {"bonded.min", "ranges and bins are those of the targets"},
    {"bonded.max", "ranges and bins are those of the targets"},
    {"bonded.step", "ranges and bins are those of the targets"},
    {"non-bonded.inverse.p_target", "it is a target only with <post_update>pressure"},
    {"non-bonded.inverse.do_potential", "all that has a target is found at once"},
    {"bonded.inverse.do_potential", "all that has a target is found at once"},
    {"non-bonded.inverse.post_", "a fit needs no scripts between its steps"},
    {"bonded.inverse.post_", "a fit needs no scripts between its steps"},
    {"inverse.p_target", "it is a target only inside <non-bonded><inverse>, with "
                         "<post_update>pressure"},
    {"inverse.method", "the method is chosen; \"method\": {\"name\": …} asks for another"},
    {"inverse.iie", "the method is chosen; \"method\": {\"name\": …} asks for another"},
    {"non-bonded.inverse.imc", "imc takes its regularisation from the noise"},
    {"bonded.inverse.imc", "imc takes its regularisation from the noise"},
    {"inverse.imc", "imc takes its regularisation from the noise"},
    {"inverse.iterations_max", "a fit ends when it has converged"},
    {"inverse.convergence_check", "a fit ends when it has converged"},
    {"inverse.scale", "a fit ends when it has converged"},
    {"inverse.average", "a fit ends when it has converged"},
    {"non-bonded.inverse.optimizer.density", "profiles of the density are no targets"},
    {"non-bonded.inverse.optimizer", "potentials are tables; laws with parameters: \"unknowns\""},
    {"inverse.optimizer", "potentials are tables; laws with parameters: \"unknowns\""},
    {"non-bonded.re", "potentials are tables; splines: \"method\": {\"name\": "
                      "\"relative-entropy\"}"},
    {"non-bonded.fmatch", "force matching is by \"measure --forces\""},
    {"bonded.fmatch", "force matching is by \"measure --forces\""},
    {"fmatch", "force matching is by \"measure --forces\""},
    {"non-bonded.inverse", "no other program runs in between"},
    {"bonded.inverse", "no other program runs in between"},
    {"inverse", "no other program runs in between"},
    {"nbsearch", "no other program runs in between"},
    {"", "not known"},
};
enum { FATES = sizeof fates / sizeof *fates, PATH_SIZE = 256 };

struct rest {
    const struct import_settings *settings;
    char list[FATES][LIST_SIZE]; ///< of each line that is the first of its reason: paths
};

static int first_of_reason(int fate) {
    int first = 0;
    while (fates[first].reason == NULL || strcmp(fates[first].reason, fates[fate].reason) != 0)
        first++;
    return first;
}

/// Add a path, as far as one name below that of its line, to a list in which it is not yet.
static void add(char list[LIST_SIZE], const char *path, const char *of_line) {
    char item[PATH_SIZE];
    const size_t above = strlen(of_line);
    const char *const below = strlen(path) > above ? strchr(path + above + 1, '.') : NULL;
    snprintf(item, sizeof item, "%.*s", (int)(below ? (size_t)(below - path) : strlen(path)), path);
    const char *const known = strstr(list, item);
    const size_t length = strlen(list);
    if (known == NULL || strchr(", ", known[strlen(item)]) == NULL)
        snprintf(list + length, LIST_SIZE - length, "%s%s", length ? ", " : "", item);
}

static void collect(struct rest *rest, const struct xml_element *element, const char *path) {
    char inner[PATH_SIZE];
    int fate = 0;
    for (const struct xml_element *child = element->child; child; child = child->next) {
        snprintf(inner, sizeof inner, "%.180s%s%.60s", path, path[0] ? "." : "", child->name);
        collect(rest, child, inner);
    }
    if (element->child || element->text[0] == '\0' || element == rest->settings->pressure)
        return;
    while (strncmp(path, fates[fate].path, strlen(fates[fate].path)) != 0)
        fate++;
    if (fates[fate].reason)
        add(rest->list[first_of_reason(fate)], path, fates[fate].path);
}

/// Print a line for each reason why something that is set is left out.
static void print_rest(const struct import_settings *settings, struct progress *progress) {
    struct rest rest = {.settings = settings};
    collect(&rest, settings->document.root, "");
    for (int k = 0; k < FATES; k++)
        if (rest.list[k][0])
            say(progress, "left out: %s: %s", rest.list[k], fates[k].reason);
}

// The run file ------------------------------------------------------------------------------------

struct job {
    const struct import_request *request;
    struct import_settings settings;
    struct import_system system;
    struct tracked_files own;
    struct input_files inputs; ///< tables and settings
    struct json_writer *writer;
};

// Tables ------------------------------------------------------------------------------------------

/// Copies are called as VOTCA calls its own tables, by the names of interactions, which differ:
/// those of files in several folders may not.
enum { COPY_SIZE = 2 * COMPOSITION_NAME_SIZE + TOPOLOGY_NAME_SIZE + 16 };

static void name_target(char copy[COPY_SIZE], const char *interaction) {
    snprintf(copy, COPY_SIZE, "%s.dist.tgt", interaction);
}

static void name_group_table(char copy[COPY_SIZE], const struct import_group *group) {
    if (group->target)
        name_target(copy, group->name);
    else
        snprintf(copy, COPY_SIZE, "table_%c%d.xvg", "bad"[group->order], group -> table);
}

static enum status copy(struct job *job, const char *file, const char *name) {
    char from[OUTPUT_PATH_SIZE], to[OUTPUT_PATH_SIZE];
    OWNED char *text = NULL;
    size_t length;
    struct output output;
    mf_import_settings_path(&job->settings, file, from);
    snprintf(to, sizeof to, "%.3000s/%.1000s", job->own.folder, name);
    TRY(mf_text_file_read(from, &text, &length));
    TRY(mf_output_open(&output, to));
    fwrite(text, 1, length, output.stream);
    return mf_output_commit(&output);
}

/// Do something with each table, whose copy is called `name`.
static enum status each_table(struct job *job,
                              enum status (*what)(struct job *job, const char *file,
                                                  const char *name)) {
    const struct import_settings *const settings = &job->settings;
    char name[COPY_SIZE];
    for (size_t k = 0; k < settings->pairs; k++) {
        name_target(name, settings->pair[k].name);
        TRY(what(job, settings->pair[k].target->text, name));
    }
    for (size_t k = 0; k < settings->groups; k++) {
        const struct import_group *const group = &settings->group[k];
        name_group_table(name, group);
        TRY(what(job, group->target ? group->target->text : group->table_file, name));
    }
    return STATUS_OK;
}

static enum status add_input(struct job *job, const char *file, const char *name) {
    char from[OUTPUT_PATH_SIZE];
    (void)name;
    mf_import_settings_path(&job->settings, file, from);
    return mf_input_files_add(&job->inputs, from);
}

static enum status reserve(struct job *job, const char *file, const char *name) {
    (void)file;
    return mf_tracked_files_reserve(&job->own, name);
}

/// No copy takes the place of a table that is read, as in the folder of the settings it would.
static enum status protect_inputs(struct job *job) {
    TRY(mf_input_files_add(&job->inputs, job->request->file));
    TRY(each_table(job, add_input));
    job->own.inputs = &job->inputs;
    TRY(each_table(job, reserve));
    return mf_tracked_files_reserve(&job->own, "run.json");
}

// The run file ------------------------------------------------------------------------------------

static void write_table(struct json_writer *writer, const char *key, const char *interaction,
                        double cutoff) {
    char copy[COPY_SIZE];
    name_target(copy, interaction);
    mf_json_begin(writer, key);
    mf_json_write_text(writer, "file", copy);
    mf_json_write_text(writer, "format", "votca");
    if (isfinite(cutoff))
        mf_json_write_number(writer, "cutoff", cutoff);
    mf_json_end(writer);
}

static void write_pairs(const struct job *job) {
    const struct import_settings *const settings = &job->settings;
    if (job->system.beads.types == 1) {
        write_table(job->writer, "rdf", settings->pair[0].name, settings->pair[0].cutoff);
        return;
    }
    mf_json_begin(job->writer, "rdf");
    for (size_t k = 0; k < settings->pairs; k++) {
        const struct import_pair *const pair = &settings->pair[k];
        char name[2 * COMPOSITION_NAME_SIZE];
        snprintf(name, sizeof name, "%s-%s", pair->type[0], pair->type[1]);
        write_table(job->writer, name, pair->name, pair->cutoff);
    }
    mf_json_end(job->writer);
}

/// Groups of an order that have a target, or those that have a table.
static void write_groups(const struct job *job, const char *key, int order, bool with_target) {
    const struct import_settings *const settings = &job->settings;
    char copy[COPY_SIZE];
    bool begun = false;
    for (size_t k = 0; k < settings->groups; k++) {
        const struct import_group *const group = &settings->group[k];
        if (group->order != order || (group->target != NULL) != with_target)
            continue;
        if (!begun)
            mf_json_begin(job->writer, key);
        begun = true;
        if (with_target) {
            write_table(job->writer, group->name, group->name, NAN);
            continue;
        }
        name_group_table(copy, group);
        mf_json_begin(job->writer, group->name);
        mf_json_write_text(job->writer, "law", "table");
        mf_json_write_text(job->writer, "file", copy);
        mf_json_end(job->writer);
    }
    if (begun)
        mf_json_end(job->writer);
}

static void write_target(const struct job *job) {
    static const char *const keys[BONDED_KINDS] = {"bond_lengths", "bond_angles",
                                                   "dihedral_angles"};
    const struct xml_element *const pressure = job->settings.pressure;
    mf_json_begin(job->writer, "target");
    write_pairs(job);
    for (int order = 0; order < BONDED_KINDS; order++)
        write_groups(job, keys[order], order, true);
    if (pressure) {
        mf_json_begin(job->writer, "pressure");
        mf_json_write_number(job->writer, "value", strtod(pressure->text, NULL));
        mf_json_end(job->writer);
    }
    mf_json_end(job->writer);
}

static void write_masses(const struct job *job) {
    const struct composition *const beads = &job->system.beads;
    for (int type = 0; type < beads->types; type++)
        if (!(mf_import_system_mass(&job->system, type) > 0))
            return;
    if (beads->types == 1) {
        mf_json_write_number(job->writer, "mass", mf_import_system_mass(&job->system, 0));
        return;
    }
    mf_json_begin(job->writer, "mass");
    for (int type = 0; type < beads->types; type++)
        mf_json_write_number(job->writer, beads->name[type],
                             mf_import_system_mass(&job->system, type));
    mf_json_end(job->writer);
}

static void write_particles(const struct job *job) {
    const struct composition *const single = &job->system.single;
    mf_json_begin(job->writer, "particles");
    if (single->types == 1 && !scene_has_molecules(&job->system.molecules)) {
        mf_json_write_integer(job->writer, "count", single->count[0]);
    } else if (mf_composition_particles(single) > 0) {
        mf_json_begin(job->writer, "types");
        for (int type = 0; type < single->types; type++)
            if (single->count[type] > 0)
                mf_json_write_integer(job->writer, single->name[type], single->count[type]);
        mf_json_end(job->writer);
    }
    write_masses(job);
    mf_json_end(job->writer);
}

static void write_scene(const struct job *job) {
    mf_json_begin(job->writer, "scene");
    mf_json_write_quantities(job->writer, "box", "lambda", job->system.box, 3);
    mf_json_write_number(job->writer, "temperature", job->settings.temperature);
    write_particles(job);
    if (scene_has_molecules(&job->system.molecules))
        mf_scene_kinds_write(&job->system.molecules, &job->system.beads, 1, job->writer);
    for (int order = 0; order < BONDED_KINDS; order++)
        write_groups(job, mf_bonded_kinds[order]->plural, order, false);
    mf_json_end(job->writer);
}

static enum status write_run(const struct job *job) {
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.4000s/run.json", job->own.folder);
    mf_json_write_text(job->writer, "title", job->settings.document.file);
    mf_json_write_text(job->writer, "units", "nm-ps");
    write_target(job);
    write_scene(job);
    return mf_json_write(job->writer, path);
}

// What is said ------------------------------------------------------------------------------------

/// A scene has one mass for each type.
static void print_masses(const struct import_system *system, struct progress *progress) {
    static const double rounding = 1e-3;
    for (int type = 0; type < system->beads.types; type++) {
        const struct import_mass *const mass = &system->mass[type];
        if (mass->high - mass->low > rounding)
            say(progress, "masses of type %s differ (%g to %g): their mean is taken",
                system->beads.name[type], mass->low, mass->high);
    }
}

static void print_read(const struct job *job) {
    struct progress *const progress = job->request->progress;
    const struct import_settings *const settings = &job->settings;
    const struct import_system *const system = &job->system;
    for (size_t k = 0; k < settings->pairs; k++)
        say(progress, "read: %s: g(r) of %s, to %g nm", settings->pair[k].name,
            settings->pair[k].target->text, settings->pair[k].cutoff);
    for (size_t k = 0; k < settings->groups; k++) {
        const struct import_group *const group = &settings->group[k];
        say(progress, "read: %s: %s %s %s", group->name, mf_bonded_kinds[group->order]->name,
            group->target ? "with the distribution of" : "with the known potential",
            group->target ? group->target->text : group->table_file);
    }
    say(progress, "read: temperature %g K", settings->temperature);
    if (settings->pressure)
        say(progress, "read: pressure %s bar", settings->pressure->text);
    say(progress, "read: box %g %g %g nm of %s", system->box[0], system->box[1], system->box[2],
        system->box_file[0] ? system->box_file : "--box");
    for (int type = 0; type < system->beads.types; type++)
        say(progress, "read: %lld beads %s of %s", (long long)system->beads.count[type],
            system->beads.name[type], system->beads_file[0] ? system->beads_file : "--count");
    print_masses(system, progress);
    print_rest(settings, progress);
    say(progress, "mesofit fit %s/run.json --explain tells what a fit will do", job->own.folder);
}

// All of it ---------------------------------------------------------------------------------------

/// The folder is empty, or an import wrote it that nobody has changed, unless `force`.
static enum status open_folder(struct job *job) {
    const char *const folder = job->request->folder;
    struct tracked_files *const own = &job->own;
    TRY(mf_tracked_files_make(own, folder, TRACKED_FILES_OF_IMPORT));
    own->force = job->request->force;
    if (!own->list.there && !own->force && mf_tracked_files_has_others(own))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the folder holds files that are not of an import: give another "
                              "folder with -o; --force replaces those of the same names",
                              folder);
    TRY(mf_tracked_files_lock(own));
    return mf_tracked_files_check(own, NULL);
}

static enum status carry_out(struct job *job) {
    TRY(mf_import_settings_read(&job->settings, job->request->file));
    TRY(mf_import_system_find(&job->system, &job->settings, &job->request->options));
    TRY(open_folder(job));
    TRY(protect_inputs(job));
    TRY(mf_tracked_files_begin(&job->own, 0));
    TRY(each_table(job, copy));
    job->writer = mf_json_writer_create();
    TRY(job->writer ? STATUS_OK : STATUS_NO_MEMORY);
    TRY(write_run(job));
    TRY(mf_tracked_files_remove_earlier(&job->own));
    print_read(job);
    return STATUS_OK;
}

enum status mf_import_votca(const struct import_request *request) {
    struct job job = {.request = request};
    const enum status status = carry_out(&job);
    mf_json_writer_free(job.writer);
    mf_tracked_files_close(&job.own);
    mf_input_files_clear(&job.inputs);
    mf_import_system_clear(&job.system);
    mf_import_settings_clear(&job.settings);
    return status;
}
