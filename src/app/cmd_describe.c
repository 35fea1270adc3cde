// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "base/nearest.h"
#include "run/fit_file.h"
#include "run/simulate.h"

#include <string.h>

/// A thing that `mesofit describe` knows: its name and a list of field tables.
struct topic {
    const char *group, *name, *summary;
    const struct field *tables[4]; ///< NULL-terminated
};

enum { MAX_TOPICS = 64 };

static const struct topic fixed_topics[] = {
    {"files",
     "scene",
     "the top of a scene file, and \"scene\" of a run file",
     {heading_fields, scene_fields}},
    {"files",
     "particles",
     "\"particles\" of a scene; a mixture has \"types\": {\"A\": 500, \"B\": 300} for \"count\"",
     {placement_count_fields, placement_fields}},
    {"files", "measure", "\"measure\" of a scene file: when to sample", {measure_plan_fields}},
    {"files", "rdf", "\"rdf\" of a scene file", {simulate_rdf_fields}},
    {"files",
     "motion",
     "\"motion\" of a scene file: diffusion; measured if it is there",
     {motion_plan_fields}},
    {"files",
     "etd",
     "\"etd\" of a scene file: escape times of pairs; measured if it is there",
     {etd_grid_fields, etd_plan_fields}},
    {"files",
     "force_covariance",
     "\"force_covariance\" of a scene file: friction as the forces show it; measured if it is "
     "there",
     {force_covariance_fields}},
    {"files", "units", "\"units\" of a scene: physical units for the results", {units_fields}},
    {"files", "core", "\"core\" of a run file: where the target is 0", {fit_core_fields}},
    {"files",
     "verification",
     "\"verification\" of a run file: independent simulations of the result",
     {verify_fields}},
    {"target",
     "rdf-target",
     "\"rdf\" of a run file's \"target\": g(r)",
     {target_fields, targets_goal_fields}},
    {"target",
     "etd-target",
     "\"etd\": escape times of pairs",
     {target_etd_fields, targets_goal_fields}},
    {"target",
     "curve-target",
     "\"vacf\" and \"msd\": functions of time, each with its file",
     {targets_curve_fields, targets_goal_fields}},
    {"target",
     "number-target",
     "\"diffusion\" and \"pressure\"",
     {targets_number_fields, targets_goal_fields}},
    {"unknowns",
     "potential",
     "Phi(r), to be found; \"start\" and \"truth\" are laws as in \"conservative\"",
     {inverse_potential_fields}},
    {"unknowns",
     "weight",
     "omega(r), to be found; \"start\" and \"truth\" are laws as in \"dissipative\"",
     {inverse_weight_fields}},
};

static size_t add_curves(struct topic *topics, size_t n, const char *group,
                         const struct curve_family *const *list) {
    for (; *list; list++)
        topics[n++] = (struct topic){group, (*list)->name, (*list)->summary, {(*list)->fields}};
    return n;
}

/// All topics: the fixed ones, and one for each record in the lists.
static size_t collect(struct topic topics[MAX_TOPICS]) {
    size_t n = sizeof fixed_topics / sizeof *fixed_topics;
    memcpy(topics, fixed_topics, sizeof fixed_topics);
    n = add_curves(topics, n, "conservative", curve_potentials);
    n = add_curves(topics, n, "dissipative", curve_weights);
    for (size_t k = 0; integrator_list[k]; k++)
        topics[n++] = (struct topic){"dynamics",
                                     integrator_list[k]->name,
                                     integrator_list[k]->summary,
                                     {integrator_list[k]->fields}};
    for (size_t k = 0; inverse_methods[k]; k++) {
        const struct inverse_method *method = inverse_methods[k];
        topics[n] = (struct topic){"method", method->name, method->summary, {NULL}};
        for (size_t t = 0; t < 3 && method->tables[t]; t++)
            topics[n].tables[t] = method->tables[t];
        n++;
    }
    return n;
}

static void print_index(const struct topic *topics, size_t count) {
    const char *group = "";
    for (size_t k = 0; k < count; k++) {
        if (strcmp(group, topics[k].group) != 0)
            printf("%s%s\n", k ? "\n" : "", topics[k].group);
        group = topics[k].group;
        printf("  %-16s %s\n", topics[k].name, topics[k].summary);
    }
    printf("\n`mesofit describe NAME` lists the numbers of one of them.\n");
}

static void print_topic(const struct topic *topic) {
    printf("%s (%s): %s\n", topic->name, topic->group, topic->summary);
    for (size_t t = 0; topic->tables[t]; t++)
        fields_describe(topic->tables[t], stdout);
}

static enum status run(const struct command_line *line) {
    struct topic topics[MAX_TOPICS];
    const char *names[MAX_TOPICS];
    const size_t count = collect(topics);
    if (line->file_count == 0) {
        print_index(topics, count);
        return STATUS_OK;
    }
    bool found = false;
    for (size_t k = 0; k < count; k++) {
        names[k] = topics[k].name;
        if (strcmp(topics[k].name, line->files[0]) != 0)
            continue;
        print_topic(&topics[k]);
        found = true;
    }
    if (found)
        return STATUS_OK;
    char hint[512];
    nearest_hint(line->files[0], names, count, hint, sizeof hint);
    return status_fail(STATUS_BAD_INPUT, "describe: \"%s\" is not known; %s", line->files[0], hint);
}

const struct command cmd_describe = {
    .name = "describe",
    .usage = "[NAME]",
    .summary = "list everything that a file can say, with units, defaults and ranges",
    .least_files = 0,
    .most_files = 1,
    .run = run,
};
