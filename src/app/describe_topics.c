// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `describe` tells of: the keys of files by topics, and the objects inside them.
#include "app/cmd_describe.h"

#include "problem/numbers.h"
#include "defaults/fit_file.h"
#include "defaults/fit_unknowns.h"
#include "defaults/methods.h"
#include "observe/kirkwood_buff_observable.h"
#include "observe/measure.h"
#include "observe/rdf_observable.h"
#include "trajectory/mapping_plan.h"

#include <string.h>

/// An object inside another, and the topic or group that says what stands in it.
struct inner {
    const char *key, *help, *topic;
    enum topic_form form;
};

static const struct inner run_objects[] = {
    {"scene", "the simulated system, without the unknowns", "scene", TOPIC_ONE},
    {"target", "measured quantities, at least one", "target", TOPIC_ONE},
    {"unknowns", "the unknowns; default: the potential", "unknowns", TOPIC_ONE},
    {"method", "\"name\" and settings of the method", "method", TOPIC_ONE},
    {"units", "units of the file and its results, \"nm-ps\" or \"angstrom-fs\"", "units",
     TOPIC_ONE},
    {"core", "region where the target is 0", "core", TOPIC_ONE},
    {"engine", "another program that samples for an inversion", "engine", TOPIC_ONE},
    {"verification", "independent simulations of the result", "verification", TOPIC_ONE},
    {"states",
     "systems that share a potential, {\"dilute\": {\"scene\": {…}, …}, …}, else with this file's "
     "keys",
     "run", TOPIC_NAMED},
    {NULL, NULL, NULL, TOPIC_ONE},
};

/// "the same of angles" after what is said of bonds.
#define SAME_UNKNOWNS(NAME, kind, ...) {#kind "s", "the same of " #kind "s", "group", TOPIC_NAMED},
#define SAME_GROUPS(NAME, kind, ...) {#kind "s", "the same of " #kind "s", #kind "s", TOPIC_NAMED},
#define SAME_TERMS(NAME, kind, beads, ...)                                                         \
    {#kind "s", "the same of " #kind "s, of " #beads " beads each", #kind "s", TOPIC_BEADS},

static const struct inner unknowns_objects[] = {
    {"potential", "Phi(r)", "potential", TOPIC_ONE},
    {"bonds", "U(r) of named groups, {\"backbone\": {}, …}", "group", TOPIC_NAMED},
    BONDED_LIST_BEYOND_BONDS(SAME_UNKNOWNS){"omega", "omega(r)", "omega", TOPIC_ONE},
    {"omega_transverse", "omega(r) perpendicular to the pair", "omega", TOPIC_ONE},
    {"memory", "omega(r) of modes of the scene's \"memory\" without \"omega\", {\"slow\": {…}, …}",
     "omega", TOPIC_NAMED},
    {"numbers",
     "numbers of the scene by path, for methods that search: {\"dissipative.sigma\": {…}, …}",
     "numbers", TOPIC_NAMED},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner potential_objects[] = {
    {"start", "initial law, in a mixture one for each pair type", "conservative", TOPIC_PARTS},
    {"truth", "known law, for comparison", "conservative", TOPIC_PARTS},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner omega_objects[] = {
    {"fixed", "fixed parameters of the curve \"power\"", "fixed", TOPIC_ONE},
    {"start", "initial law", "dissipative", TOPIC_ONE},
    {"truth", "known law, for comparison", "dissipative", TOPIC_ONE},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner sum_objects[] = {
    {"of", "the laws, {\"core\": {\"law\": …}, …}", "conservative", TOPIC_NAMED},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner scene_objects[] = {
    {"particles", "number and placement of particles", "particles", TOPIC_ONE},
    {"conservative", "potential, {\"law\": …}; in a mixture one for each pair type", "conservative",
     TOPIC_PARTS},
    {"known", "of a fit: potential beside the one sought, likewise", "conservative", TOPIC_PARTS},
    {"dissipative", "friction weight, likewise", "dissipative", TOPIC_PARTS},
    {"dissipative_transverse", "friction weight perpendicular to the pair, likewise", "dissipative",
     TOPIC_PARTS},
    {"memory", "friction with memory: named modes, {\"slow\": {…}, …}", "memory", TOPIC_NAMED},
    {"many_body", "energies of local densities, {\"cohesion\": {…}, …}", "many_body", TOPIC_NAMED},
    {"molecules", "named kinds of molecules, {\"hexane\": {…}, …}", "molecule", TOPIC_MOLECULES},
    {"bonds", "named groups of bonds, {\"backbone\": {\"law\": …}, …}", "bonds", TOPIC_NAMED},
    BONDED_LIST_BEYOND_BONDS(SAME_GROUPS){"interactions",
                                          "other interactions, {\"harmonic-trap\": {…}, …}",
                                          "interactions", TOPIC_ONE},
    {"dynamics",
     "{\"integrator\": …} and its settings; default \"aboba\" with friction, else "
     "\"velocity-verlet\"",
     "dynamics", TOPIC_ONE},
    {"units", "physical units for the results of a scene in reduced units", "scale", TOPIC_ONE},
    {"measure", "sampling; like the observables below (measured if given) in scene files only",
     "measure", TOPIC_ONE},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner molecule_objects[] = {
    {"chain", "linear chain; instead \"beads\": [\"A\", \"B\", …] and", "chain", TOPIC_ONE},
    {"bonds", "beads of each bond, counted from 1: {\"backbone\": [[1, 2], …], …}", "bonds",
     TOPIC_BEADS},
    BONDED_LIST_BEYOND_BONDS(SAME_TERMS){NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner memory_objects[] = {
    {"omega", "amplitude, {\"law\": …}: friction omega^2/[1 + (time frequency)^2]", "dissipative",
     TOPIC_ONE},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner many_body_objects[] = {
    {"weight", "w(r), {\"law\": …}", "weight", TOPIC_ONE},
    {"energy", "f(rho), {\"law\": …}", "energy", TOPIC_ONE},
    {NULL, NULL, NULL, TOPIC_ONE},
};

static const struct inner map_objects[] = {
    {"beads", "named kinds of beads, {\"CH3\": {…}, \"OH\": {…}}", "bead", TOPIC_NAMED},
    {NULL, NULL, NULL, TOPIC_ONE},
};

/// The objects in what a topic is about.
static const struct {
    const char *topic;
    const struct inner *objects;
} contents[] = {
    {"run", run_objects},           {"scene", scene_objects},
    {"unknowns", unknowns_objects}, {"potential", potential_objects},
    {"omega", omega_objects},       {"map", map_objects},
    {"memory", memory_objects},     {"sum", sum_objects},
    {"molecule", molecule_objects}, {"many_body", many_body_objects},
};

static const struct topic fixed_topics[] = {
    {"files",
     "run",
     "the top of a run file, for `mesofit fit`",
     {mf_heading_fields, mf_fit_friction_fields}},
    {"files",
     "scene",
     "the top of a scene file, for `mesofit simulate`, and \"scene\" of a run file (without title "
     "and "
     "seed)",
     {mf_heading_fields, mf_scene_fields, mf_scene_density_fields}},
    {"files",
     "particles",
     "\"particles\" of a scene; a mixture has \"types\": {\"A\": 500, \"B\": 300} for \"count\"",
     {mf_placement_count_fields, mf_placement_fields, mf_attributes_fields}},
    {"files",
     "memory",
     "a mode of \"memory\" of a scene: friction with memory",
     {mf_scene_memory_fields}},
    {"files",
     "many_body",
     "\"many_body\" of a scene: f(rho) of each bead, rho = sum w(r) over its neighbours",
     {mf_scene_many_body_fields}},
    {"files", "molecule", "a kind of \"molecules\" of a scene", {mf_scene_molecule_fields}},
    {"files", "chain", "\"chain\" of a molecule", {mf_scene_chain_fields}},
    {"files",
     "topology",
     "\"molecules\" of a topology: {\"file\": \"topol.top\"}",
     {mf_scene_file_fields}},
    {"files", "measure", "\"measure\" of a scene file: when to sample", {mf_measure_plan_fields}},
    {"files",
     "units",
     "\"units\" of a file in physical units: \"nm-ps\", \"angstrom-fs\", or an object",
     {mf_units_system_fields}},
    {"files",
     "scale",
     "\"units\" of a scene in reduced units: physical units for its results",
     {mf_units_fields}},
    {"files", "core", "\"core\" of a run file: where the target is 0", {mf_fit_core_fields}},
    {"files",
     "engine",
     "\"engine\" of a run file: another program that samples; \"types\": {\"1\": \"A\", …}",
     {mf_sampling_engine_fields}},
    {"files",
     "verification",
     "\"verification\" of a run file: independent simulations of the result",
     {mf_verify_fields}},
    {"files",
     "map",
     "a map of atoms to beads (`mesofit measure --map`); \"masses\": {\"C\": 12.011, "
     "…} has masses of atoms [u] by name",
     {mf_mapping_plan_fields}},
    {"files", "bead", "one of \"beads\" of a map", {mf_mapping_plan_bead_fields}},
    {"target", "target", "\"target\" of a run file", {NULL}},
};

/// After those of the readers of targets.
static const struct topic unknown_topics[] = {
    {"unknowns", "unknowns", "\"unknowns\" of a run file", {NULL}},
    {"unknowns",
     "group",
     "U of a group of bonds, angles or dihedrals, to be found from its target",
     {mf_inverse_group_fields}},
    {"unknowns", "potential", "Phi(r), to be found", {mf_inverse_potential_fields}},
    {"unknowns", "omega", "a friction weight omega(r), to be found", {mf_inverse_omega_fields}},
    {"unknowns",
     "numbers",
     "a number of the scene, to be found, under the path of its key: \"conservative.a\", "
     "\"conservative.A-B.a\", \"dissipative.sigma\", \"bonds.backbone.k\", \"temperature\", "
     "\"dynamics.lambda\"",
     {mf_numbers_fields}},
    {"unknowns",
     "fixed",
     "\"fixed\" of a friction weight: parameters of the curve \"power\" that are not fitted",
     {mf_inverse_fixed_fields}},
};

static size_t add_target_topics(struct topic *topics, size_t n) {
    for (const struct target_record *const *record = mf_target_records; *record; record++) {
        topics[n] = (struct topic){"target", (*record)->topic, (*record)->summary, {NULL}};
        memcpy(topics[n++].tables, (*record)->fields, sizeof(*record)->fields);
    }
    topics[n++] = (struct topic){
        "target", "forces-target", "\"forces\", of `measure --forces`", {mf_target_forces_fields}};
    return n;
}

static size_t add_curves(struct topic *topics, size_t n, const char *group,
                         const struct curve_family *const *list) {
    for (; *list; list++)
        topics[n++] = (struct topic){group, (*list)->name, (*list)->summary, {(*list)->fields}};
    return n;
}

/// Tables that several methods share, by their names there.
static const struct {
    const char *name, *summary;
} shared[] = {
    {"inversions", "what inversions simulate: auto, imc, ibi, hnc, relative-entropy"},
    {"candidates", "how methods that search simulate a candidate"},
    {"searches", "what genetic, cma-es and nlopt have in common"},
};

static const struct field *find_shared(const char *name) {
    for (size_t k = 0; mf_methods[k]; k++)
        for (const struct inverse_table *table = mf_methods[k]->tables; table->fields; table++)
            if (table->shared && strcmp(table->shared, name) == 0)
                return table->fields;
    return NULL;
}

static size_t add_shared(struct topic *topics, size_t n) {
    topics[n++] = (struct topic){
        "shared", "weights", "what all targets have in common", {mf_target_files_use_fields}};
    for (size_t k = 0; k < sizeof shared / sizeof *shared; k++)
        topics[n++] = (struct topic){
            "shared", shared[k].name, shared[k].summary, {find_shared(shared[k].name)}};
    return n;
}

size_t mf_describe_topics(struct topic topics[DESCRIBE_MAX_TOPICS]) {
    size_t n = sizeof fixed_topics / sizeof *fixed_topics;
    memcpy(topics, fixed_topics, sizeof fixed_topics);
    n = add_target_topics(topics, n);
    memcpy(topics + n, unknown_topics, sizeof unknown_topics);
    n += sizeof unknown_topics / sizeof *unknown_topics;
    for (size_t k = 0; mf_observables[k]; k++)
        if (mf_observables[k]->fields)
            topics[n++] = (struct topic){"observables",
                                         mf_observables[k]->name,
                                         mf_observables[k]->summary,
                                         {mf_observables[k]->fields}};
    n = add_curves(topics, n, "conservative", mf_curve_potentials);
    n = add_curves(topics, n, "dissipative", mf_curve_omegas);
    n = add_curves(topics, n, "weight", mf_weight_laws);
    n = add_curves(topics, n, "energy", mf_density_energy_laws);
    for (int order = 0; order < BONDED_KINDS; order++)
        for (size_t k = 0; mf_bonded_kinds[order]->laws[k]; k++)
            topics[n++] = (struct topic){mf_bonded_kinds[order]->plural,
                                         mf_bonded_kinds[order]->laws[k]->name,
                                         mf_bonded_kinds[order]->laws[k]->summary,
                                         {mf_bonded_kinds[order]->laws[k]->fields}};
    for (size_t k = 0; mf_interaction_list[k]; k++)
        topics[n++] = (struct topic){"interactions",
                                     mf_interaction_list[k]->name,
                                     mf_interaction_list[k]->summary,
                                     {mf_interaction_list[k]->fields}};
    for (size_t k = 0; mf_integrator_list[k]; k++)
        topics[n++] = (struct topic){"dynamics",
                                     mf_integrator_list[k]->name,
                                     mf_integrator_list[k]->summary,
                                     {mf_integrator_list[k]->fields}};
    n = add_shared(topics, n);
    for (size_t k = 0; mf_methods[k]; k++) {
        const struct inverse_method *method = mf_methods[k];
        topics[n] = (struct topic){"method", method->name, method->summary, {NULL}};
        for (size_t t = 0; t + 1 < DESCRIBE_MAX_TABLES && method->tables[t].fields; t++)
            topics[n].tables[t] = method->tables[t].fields;
        n++;
    }
    return n;
}

static size_t add_object(struct topic_object *objects, size_t n, const char *key, const char *help,
                         const char *topic, enum topic_form form) {
    snprintf(objects[n].key, sizeof objects[n].key, "%s", key);
    snprintf(objects[n].help, sizeof objects[n].help, "%s", help);
    snprintf(objects[n].topic, sizeof objects[n].topic, "%s", topic);
    objects[n].form = form;
    return n + 1;
}

/// The objects of a scene file that say what is measured.
static size_t add_observables(struct topic_object *objects, size_t n) {
    for (size_t k = 0; mf_observables[k]; k++) {
        const struct observable *observable = mf_observables[k];
        char help[sizeof objects->help];
        snprintf(help, sizeof help, "%s%s", observable->summary,
                 observable->always ? "; always measured" : "");
        if (observable->fields)
            n = add_object(objects, n, observable->name, help, observable->name, TOPIC_ONE);
    }
    return n;
}

/// The objects of a run file's "target", and of what form each is.
static size_t add_targets(struct topic_object *objects, size_t n) {
    struct observable_kind found;
    for (int kind = 0; (found = mf_observable_kind(kind)).observable; kind++) {
        n = add_object(objects, n, found.target->name, found.target->summary,
                       mf_target_record(kind)->topic, TOPIC_PARTS);
    }
    return add_object(objects, n, "forces", "force matching", "forces-target", TOPIC_ONE);
}

size_t mf_describe_objects(const char *topic, struct topic_object objects[DESCRIBE_MAX_OBJECTS]) {
    size_t n = 0;
    for (size_t k = 0; k < sizeof contents / sizeof *contents; k++)
        if (strcmp(contents[k].topic, topic) == 0)
            for (const struct inner *inner = contents[k].objects; inner->key; inner++)
                n = add_object(objects, n, inner->key, inner->help, inner->topic, inner->form);
    if (strcmp(topic, "scene") == 0)
        n = add_observables(objects, n);
    if (strcmp(topic, "target") == 0)
        n = add_targets(objects, n);
    return n;
}

const struct topic *mf_describe_home(const struct topic *topics, size_t count,
                                     const struct field *table) {
    for (size_t k = 0; k < count; k++)
        if (topics[k].tables[0] == table && topics[k].tables[1] == NULL)
            return &topics[k];
    return NULL;
}
