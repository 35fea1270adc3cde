// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `describe` tells of: the keys of files by topics, and the objects inside them.
#include "app/cmd_describe.h"

#include "problem/numbers.h"
#include "defaults/fit_file.h"
#include "defaults/fit_unknowns.h"
#include "defaults/methods.h"
#include "observe/kirkwood_buff.h"
#include "observe/measure.h"
#include "observe/rdf_observable.h"
#include "trajectory/mapping_plan.h"

#include <string.h>

/// "the same of angles" after what is said of bonds.
#define SAME_UNKNOWNS(NAME, kind, ...)                                                             \
    {"unknowns", #kind "s", "the same of " #kind "s", "group", TOPIC_NAMED},
#define SAME_GROUPS(NAME, kind, ...)                                                               \
    {"scene", #kind "s", "the same of " #kind "s", #kind "s", TOPIC_NAMED},
#define SAME_TERMS(NAME, kind, beads, ...)                                                         \
    {"molecule", #kind "s", "the same of " #kind "s, of " #beads " beads each", #kind "s",         \
     TOPIC_BEADS},

/// The objects in what a topic is about, and the topic or group that says what stands in each.
static const struct {
    const char *topic, *key, *help, *inner;
    enum topic_form form;
} contents[] = {
    {"run", "scene", "the simulated system, without the unknowns", "scene", TOPIC_ONE},
    {"run", "target", "measured quantities, at least one", "target", TOPIC_ONE},
    {"run", "unknowns", "the unknowns; default: the potential", "unknowns", TOPIC_ONE},
    {"run", "method", "\"name\" and settings of the method", "method", TOPIC_ONE},
    {"run", "units", "units of the file and its results, \"nm-ps\" or \"angstrom-fs\"", "units",
     TOPIC_ONE},
    {"run", "core", "region where the target is 0", "core", TOPIC_ONE},
    {"run", "engine", "another program that samples for an inversion", "engine", TOPIC_ONE},
    {"run", "verification", "independent simulations of the result", "verification", TOPIC_ONE},
    {"run", "states",
     "systems that share a potential, {\"dilute\": {\"scene\": {…}, …}, …}, else with this file's "
     "keys",
     "run", TOPIC_NAMED},
    {"scene", "particles", "number and placement of particles", "particles", TOPIC_ONE},
    {"scene", "conservative", "potential, {\"law\": …}; in a mixture one for each pair type",
     "conservative", TOPIC_PARTS},
    {"scene", "known", "of a fit: potential beside the one sought, likewise", "conservative",
     TOPIC_PARTS},
    {"scene", "dissipative", "friction weight, likewise", "dissipative", TOPIC_PARTS},
    {"scene", "dissipative_transverse", "friction weight perpendicular to the pair, likewise",
     "dissipative", TOPIC_PARTS},
    {"scene", "memory", "friction with memory: named modes, {\"slow\": {…}, …}", "memory",
     TOPIC_NAMED},
    {"scene", "many_body", "energies of local densities, {\"cohesion\": {…}, …}", "many_body",
     TOPIC_NAMED},
    {"scene", "molecules", "named kinds of molecules, {\"hexane\": {…}, …}", "molecule",
     TOPIC_MOLECULES},
    {"scene", "bonds", "named groups of bonds, {\"backbone\": {\"law\": …}, …}", "bonds",
     TOPIC_NAMED},
    BONDED_LIST_BEYOND_BONDS(SAME_GROUPS){"scene", "interactions",
                                          "other interactions, {\"harmonic-trap\": {…}, …}",
                                          "interactions", TOPIC_ONE},
    {"scene", "dynamics",
     "{\"integrator\": …} and its settings; default \"aboba\" with friction, else "
     "\"velocity-verlet\"",
     "dynamics", TOPIC_ONE},
    {"scene", "units", "physical units for the results of a scene in reduced units", "scale",
     TOPIC_ONE},
    {"scene", "measure",
     "sampling; like the observables below (measured if given) in scene files only", "measure",
     TOPIC_ONE},
    {"unknowns", "potential", "Phi(r)", "potential", TOPIC_ONE},
    {"unknowns", "bonds", "U(r) of named groups, {\"backbone\": {}, …}", "group", TOPIC_NAMED},
    BONDED_LIST_BEYOND_BONDS(SAME_UNKNOWNS){"unknowns", "omega", "omega(r)", "omega", TOPIC_ONE},
    {"unknowns", "omega_transverse", "omega(r) perpendicular to the pair", "omega", TOPIC_ONE},
    {"unknowns", "memory",
     "omega(r) of modes of the scene's \"memory\" without \"omega\", {\"slow\": {…}, …}", "omega",
     TOPIC_NAMED},
    {"unknowns", "numbers",
     "numbers of the scene by path, for methods that search: {\"dissipative.sigma\": {…}, …}",
     "numbers", TOPIC_NAMED},
    {"potential", "start", "initial law, in a mixture one for each pair type", "conservative",
     TOPIC_PARTS},
    {"potential", "truth", "known law, for comparison", "conservative", TOPIC_PARTS},
    {"omega", "fixed", "fixed parameters of the curve \"power\"", "fixed", TOPIC_ONE},
    {"omega", "start", "initial law", "dissipative", TOPIC_ONE},
    {"omega", "truth", "known law, for comparison", "dissipative", TOPIC_ONE},
    {"map", "beads", "named kinds of beads, {\"CH3\": {…}, \"OH\": {…}}", "bead", TOPIC_NAMED},
    {"memory", "omega", "amplitude, {\"law\": …}: friction omega^2/[1 + (time frequency)^2]",
     "dissipative", TOPIC_ONE},
    {"sum", "of", "the laws, {\"core\": {\"law\": …}, …}", "conservative", TOPIC_NAMED},
    {"molecule", "chain", "linear chain; instead \"beads\": [\"A\", \"B\", …] and", "chain",
     TOPIC_ONE},
    {"molecule", "bonds", "beads of each bond, counted from 1: {\"backbone\": [[1, 2], …], …}",
     "bonds", TOPIC_BEADS},
    BONDED_LIST_BEYOND_BONDS(SAME_TERMS){"many_body", "weight", "w(r), {\"law\": …}", "weight",
                                         TOPIC_ONE},
    {"many_body", "energy", "f(rho), {\"law\": …}", "energy", TOPIC_ONE},
};

/// The tables of a topic's keys.
#define KEYS(...)                                                                                  \
    { __VA_ARGS__ }

static const struct topic fixed_topics[] = {
    {"files", "run", "the top of a run file, for `mesofit fit`",
     KEYS(mf_heading_fields, mf_fit_friction_fields)},
    {"files", "scene",
     "the top of a scene file, for `mesofit simulate`, and \"scene\" of a run file (without "
     "title and seed)",
     KEYS(mf_heading_fields, mf_scene_fields, mf_scene_density_fields)},
    {"files", "particles",
     "\"particles\" of a scene; a mixture has \"types\": {\"A\": 500, \"B\": 300} for \"count\"",
     KEYS(mf_placement_count_fields, mf_placement_fields, mf_attributes_fields)},
    {"files", "memory", "a mode of \"memory\" of a scene: friction with memory",
     KEYS(mf_scene_memory_fields)},
    {"files", "many_body",
     "\"many_body\" of a scene: f(rho) of each bead, rho = sum w(r) over its neighbours",
     KEYS(mf_scene_many_body_fields)},
    {"files", "molecule", "a kind of \"molecules\" of a scene", KEYS(mf_scene_molecule_fields)},
    {"files", "chain", "\"chain\" of a molecule", KEYS(mf_scene_chain_fields)},
    {"files", "topology", "\"molecules\" of a topology: {\"file\": \"topol.top\"}",
     KEYS(mf_scene_file_fields)},
    {"files", "measure", "\"measure\" of a scene file: when to sample",
     KEYS(mf_measure_plan_fields)},
    {"files", "units",
     "\"units\" of a file in physical units: \"nm-ps\", \"angstrom-fs\", or an object",
     KEYS(mf_units_system_fields)},
    {"files", "scale", "\"units\" of a scene in reduced units: physical units for its results",
     KEYS(mf_units_fields)},
    {"files", "core", "\"core\" of a run file: where the target is 0", KEYS(mf_fit_core_fields)},
    {"files", "engine",
     "\"engine\" of a run file: another program that samples; \"types\": {\"1\": \"A\", …}",
     KEYS(mf_sampling_engine_fields)},
    {"files", "verification",
     "\"verification\" of a run file: independent simulations of the result",
     KEYS(mf_verify_fields)},
    {"files", "map",
     "a map of atoms to beads (`mesofit measure --map`); \"masses\": {\"C\": 12.011, "
     "…} has masses of atoms [u] by name",
     KEYS(mf_mapping_plan_fields)},
    {"files", "bead", "one of \"beads\" of a map", KEYS(mf_mapping_plan_bead_fields)},
    {"target", "target", "\"target\" of a run file", KEYS(NULL)},
};

/// After those of the readers of targets.
static const struct topic unknown_topics[] = {
    {"unknowns", "unknowns", "\"unknowns\" of a run file", KEYS(NULL)},
    {"unknowns", "group", "U of a group of bonds, angles or dihedrals, to be found from its target",
     KEYS(mf_inverse_group_fields)},
    {"unknowns", "potential", "Phi(r), to be found", KEYS(mf_inverse_potential_fields)},
    {"unknowns", "omega", "a friction weight omega(r), to be found", KEYS(mf_inverse_omega_fields)},
    {"unknowns", "numbers",
     "a number of the scene, to be found, under the path of its key: \"conservative.a\", "
     "\"conservative.A-B.a\", \"dissipative.sigma\", \"bonds.backbone.k\", \"temperature\", "
     "\"dynamics.lambda\"",
     KEYS(mf_numbers_fields)},
    {"unknowns", "fixed",
     "\"fixed\" of a friction weight: parameters of the curve \"power\" that are not fitted",
     KEYS(mf_inverse_fixed_fields)},
};

static size_t add_topic(struct topic *topics, size_t n, const char *group, const char *name,
                        const char *summary, const struct field *fields) {
    topics[n] = (struct topic){group, name, summary, {fields}};
    return n + 1;
}

static size_t add_target_topics(struct topic *topics, size_t n) {
    for (const struct target_record *const *record = mf_target_records; *record; record++) {
        topics[n] = (struct topic){"target", (*record)->topic, (*record)->summary, {NULL}};
        memcpy(topics[n++].tables, (*record)->fields, sizeof(*record)->fields);
    }
    return add_topic(topics, n, "target", "forces-target", "\"forces\", of `measure --forces`",
                     mf_target_forces_fields);
}

static size_t add_curves(struct topic *topics, size_t n, const char *group,
                         const struct curve_family *const *list) {
    for (; *list; list++)
        n = add_topic(topics, n, group, (*list)->name, (*list)->summary, (*list)->fields);
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
    n = add_topic(topics, n, "shared", "weights", "what all targets have in common",
                  mf_target_files_use_fields);
    for (size_t k = 0; k < sizeof shared / sizeof *shared; k++)
        n = add_topic(topics, n, "shared", shared[k].name, shared[k].summary,
                      find_shared(shared[k].name));
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
            n = add_topic(topics, n, "observables", mf_observables[k]->name,
                          mf_observables[k]->summary, mf_observables[k]->fields);
    n = add_curves(topics, n, "conservative", mf_curve_potentials);
    n = add_curves(topics, n, "dissipative", mf_curve_omegas);
    n = add_curves(topics, n, "weight", mf_weight_laws);
    n = add_curves(topics, n, "energy", mf_density_energy_laws);
    for (int order = 0; order < BONDED_KINDS; order++)
        for (size_t k = 0; mf_bonded_kinds[order]->laws[k]; k++)
            n = add_topic(
                topics, n, mf_bonded_kinds[order]->plural, mf_bonded_kinds[order]->laws[k]->name,
                mf_bonded_kinds[order]->laws[k]->summary, mf_bonded_kinds[order]->laws[k]->fields);
    for (size_t k = 0; mf_interaction_list[k]; k++)
        n = add_topic(topics, n, "interactions", mf_interaction_list[k]->name,
                      mf_interaction_list[k]->summary, mf_interaction_list[k]->fields);
    for (size_t k = 0; mf_integrator_list[k]; k++)
        n = add_topic(topics, n, "dynamics", mf_integrator_list[k]->name,
                      mf_integrator_list[k]->summary, mf_integrator_list[k]->fields);
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
            n = add_object(objects, n, contents[k].key, contents[k].help, contents[k].inner,
                           contents[k].form);
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
