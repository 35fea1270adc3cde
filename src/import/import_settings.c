// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_settings.h"

#include "base/names.h"
#include "io/votca.h"
#include "targets/target_bonded.h"
#include "trajectory/words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// [kJ/(mol K)], as VOTCA and GROMACS of its time have it.
static const double boltzmann = 0.00831451;

void mf_import_settings_path(const struct import_settings *settings, const char *name,
                             char path[OUTPUT_PATH_SIZE]) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.3000s%.1000s", name[0] == '/' ? "" : settings->folder,
             name);
}

static enum status read_number(const struct import_settings *settings,
                               const struct xml_element *element, double *number) {
    const struct word word = {element->text, strlen(element->text)};
    if (mf_words_number(&word, number) && *number > 0)
        return STATUS_OK;
    return mf_xml_fail(&settings->document, element, "\"%.60s\" is no number above 0",
                       element->text);
}

/// A name of at most `size` − 1 characters.
static enum status read_name(const struct import_settings *settings,
                             const struct xml_element *parent, const char *key, char *name,
                             size_t size) {
    const struct xml_element *const element = mf_xml_find(parent, key);
    if (element == NULL)
        return mf_xml_fail(&settings->document, parent, "<%s> is missing", key);
    if (strlen(element->text) >= size || !mf_topology_is_name(element->text))
        return mf_xml_fail(&settings->document, element,
                           "\"%.60s\": expected a name of " NAMES_OF_OTHERS, element->text,
                           (int)size - 1);
    memcpy(name, element->text, strlen(element->text) + 1);
    return STATUS_OK;
}

/// Read a target's table for its faults, and where it ends.
static enum status read_target(const struct import_settings *settings,
                               const struct xml_element *target, double *end) {
    char path[OUTPUT_PATH_SIZE];
    CLEARED_BY(mf_votca_clear) struct votca_table table = {0};
    mf_import_settings_path(settings, target->text, path);
    const enum status status = mf_votca_read(&table, path);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s:%zu: <%s>", settings->document.file, target->line,
                                target->name);
    *end = table.x[table.rows - 1];
    return STATUS_OK;
}

/// A distribution has to be one, too.
static enum status check_distribution(const struct import_settings *settings,
                                      const struct import_group *group) {
    char path[OUTPUT_PATH_SIZE];
    mf_import_settings_path(settings, group->target->text, path);
    const enum status status = mf_target_bonded_check_votca(path, group->order);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s:%zu: <%s>", settings->document.file,
                                group->target->line, group->target->name);
    return STATUS_OK;
}

/// VOTCA's optimisers name the target of g(r) elsewhere.
static const struct xml_element *find_target(const struct xml_element *interaction) {
    const struct xml_element *const target = mf_xml_find(interaction, "inverse.target");
    return target ? target : mf_xml_find(interaction, "inverse.optimizer.rdf.target");
}

/// VOTCA calls files of an interaction by its name, as copies of its table are.
static enum status check_name(const struct import_settings *settings,
                              const struct xml_element *element, const char *name) {
    const struct xml_element *other = NULL;
    for (size_t k = 0; k < settings->pairs; k++)
        if (strcmp(settings->pair[k].name, name) == 0)
            other = settings->pair[k].element;
    for (size_t k = 0; k < settings->groups; k++)
        if (strcmp(settings->group[k].name, name) == 0)
            other = settings->group[k].element;
    if (other == NULL)
        return STATUS_OK;
    return mf_xml_fail(&settings->document, element,
                       "that of line %zu has the name %s too: each needs a name of its own",
                       other->line, name);
}

static bool is_pair(const struct import_pair *pair, const char *first, const char *second) {
    return (strcmp(pair->type[0], first) == 0 && strcmp(pair->type[1], second) == 0) ||
           (strcmp(pair->type[0], second) == 0 && strcmp(pair->type[1], first) == 0);
}

static enum status check_new_pair(const struct import_settings *settings,
                                  const struct import_pair *pair) {
    for (const struct import_pair *other = settings->pair; other < pair; other++)
        if (is_pair(other, pair->type[0], pair->type[1]))
            return mf_xml_fail(&settings->document, pair->element,
                               "%s-%s has the target of line %zu already: leave one of them out",
                               pair->type[0], pair->type[1], other->target->line);
    return STATUS_OK;
}

static enum status read_pair(struct import_settings *settings, const struct xml_element *element) {
    struct import_pair *const pair = &settings->pair[settings->pairs];
    const struct xml_element *const max = mf_xml_find(element, "max");
    double end;
    pair->element = element;
    pair->target = find_target(element);
    if (pair->target == NULL)
        return STATUS_OK;
    TRY(read_name(settings, element, "name", pair->name, sizeof pair->name));
    for (int k = 0; k < 2; k++) {
        TRY(read_name(settings, element, k ? "type2" : "type1", pair->type[k],
                      sizeof pair->type[k]));
        if (!mf_composition_is_name(pair->type[k]))
            return mf_xml_fail(&settings->document, element,
                               "\"%s\": expected a type name of " NAMES_OF_TYPE, pair->type[k],
                               COMPOSITION_NAME_SIZE - 1);
    }
    TRY(check_new_pair(settings, pair));
    TRY(check_name(settings, element, pair->name));
    if (max == NULL)
        return mf_xml_fail(&settings->document, element, "<max> is missing");
    TRY(read_number(settings, max, &pair->cutoff));
    TRY(read_target(settings, pair->target, &end));
    pair->cutoff = fmin(pair->cutoff, end);
    settings->pairs++;
    return STATUS_OK;
}

static enum status check_new_group(const struct import_settings *settings,
                                   const struct import_group *group) {
    for (const struct import_group *other = settings->group; other < group; other++)
        if (other->order == group->order && other->table == group->table)
            return mf_xml_fail(&settings->document, group->element,
                               "that of line %zu has %s too: leave one of them out",
                               other->element->line, group->table_file);
    return STATUS_OK;
}

/// "table_b1.xvg": table 1 of bonds.
static enum status read_group(struct import_settings *settings, const struct xml_element *element) {
    static const char letters[] = "bad";
    struct import_group *const group = &settings->group[settings->groups];
    const struct xml_element *const file = mf_xml_find(element, "inverse.gromacs.table");
    char letter = '\0';
    if (mf_xml_find(element, "inverse") == NULL)
        return STATUS_OK;
    group->element = element;
    group->target = find_target(element);
    TRY(read_name(settings, element, "name", group->name, sizeof group->name));
    snprintf(group->table_file, sizeof group->table_file, "%s", file ? file->text : "");
    if (sscanf(group->table_file, "table_%c%d.xvg", &letter, &group->table) != 2 ||
        letter == '\0' || strchr(letters, letter) == NULL)
        return mf_xml_fail(&settings->document, element,
                           "nothing says whether \"%s\" is a bond, an angle or a dihedral: "
                           "<inverse><gromacs><table>table_b1.xvg</table> does, or table_a1, "
                           "table_d1",
                           group->name);
    group->order = (int)(strchr(letters, letter) - letters);
    TRY(check_name(settings, element, group->name));
    TRY(check_new_group(settings, group));
    if (group->target)
        TRY(check_distribution(settings, group));
    settings->groups++;
    return STATUS_OK;
}

static enum status read_interactions(struct import_settings *settings,
                                     const struct xml_element *root) {
    const struct xml_element *element = root->child;
    for (; element; element = element->next) {
        const bool pair = strcmp(element->name, "non-bonded") == 0;
        if (!pair && strcmp(element->name, "bonded") != 0)
            continue;
        if ((pair ? settings->pairs : settings->groups) == IMPORT_MAX_INTERACTIONS)
            return mf_xml_fail(&settings->document, element, "more than %d interactions",
                               IMPORT_MAX_INTERACTIONS);
        TRY(pair ? read_pair(settings, element) : read_group(settings, element));
    }
    if (settings->pairs > 0)
        return STATUS_OK;
    return mf_xml_fail(
        &settings->document, root, "no <non-bonded> has a target, <inverse><target>%s",
        mf_xml_find(root, "non-bonded.fmatch") ? ": force matching is by \"measure --forces\""
        : mf_xml_find(root, "inverse")
            ? ""
            : ": what csg_stat does by these, mesofit measure does by itself");
}

static bool has_pair(const struct import_settings *settings, const char *first,
                     const char *second) {
    for (size_t k = 0; k < settings->pairs; k++)
        if (is_pair(&settings->pair[k], first, second))
            return true;
    return false;
}

/// All types interact: a fit needs g(r) of each pair of them.
static enum status check_pairs(const struct import_settings *settings) {
    for (size_t k = 0; k < 2 * settings->pairs; k++)
        for (size_t j = 0; j <= k; j++) {
            const struct import_pair *const pair = &settings->pair[k / 2];
            const char *const first = settings->pair[j / 2].type[j % 2];
            const char *const second = pair->type[k % 2];
            if (!has_pair(settings, first, second))
                return mf_xml_fail(&settings->document, pair->element,
                                   "it has the type %s, but no <non-bonded> has a target for the "
                                   "pair %s-%s: add it, its g(r) as <inverse><target>",
                                   second, first, second);
        }
    return STATUS_OK;
}

/// With five digits: k_B T of 300 K has been written as 2.4942, 2.49435 and 2.494338785.
static enum status read_temperature(struct import_settings *settings,
                                    const struct xml_element *root) {
    const struct xml_element *const energy = mf_xml_find(root, "inverse.kBT");
    char text[32];
    double number;
    if (energy == NULL)
        return mf_xml_fail(&settings->document, root, "<inverse><kBT> is missing");
    TRY(read_number(settings, energy, &number));
    snprintf(text, sizeof text, "%.5g", number / boltzmann);
    const struct word word = {text, strlen(text)};
    (void)mf_words_number(&word, &settings->temperature);
    return STATUS_OK;
}

/// A pressure is a target where a correction for it is asked for.
static enum status find_pressure(struct import_settings *settings, const struct xml_element *root) {
    double number;
    for (size_t k = 0; k < settings->pairs; k++) {
        const struct xml_element *const element = settings->pair[k].element;
        const bool wanted = strstr(mf_xml_text(element, "inverse.post_update"), "pressure") ||
                            strstr(mf_xml_text(element, "inverse.optimizer.targets"), "pressure");
        if (wanted && settings->pressure == NULL)
            settings->pressure = mf_xml_find(element, "inverse.p_target");
    }
    if (settings->pressure == NULL)
        settings->pressure = mf_xml_find(root, "inverse.iie.pressure_constraint");
    return settings->pressure ? read_number(settings, settings->pressure, &number) : STATUS_OK;
}

enum status mf_import_settings_read(struct import_settings *settings, const char *file) {
    const char *const slash = strrchr(file, '/');
    *settings = (struct import_settings){0};
    snprintf(settings->folder, sizeof settings->folder, "%.*s", (int)(slash ? slash - file + 1 : 0),
             file);
    TRY(mf_xml_read(&settings->document, file));
    const struct xml_element *const root = settings->document.root;
    if (strcmp(root->name, "cg") != 0)
        return mf_xml_fail(
            &settings->document, root, "no settings of VOTCA, which begin with <cg>%s",
            strcmp(root->name, "cg_molecule") == 0 ? ": this is a map, which measure --map takes"
                                                   : "");
    TRY(read_interactions(settings, root));
    TRY(check_pairs(settings));
    TRY(read_temperature(settings, root));
    return find_pressure(settings, root);
}

void mf_import_settings_clear(struct import_settings *settings) {
    mf_xml_clear(&settings->document);
}
