// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_parts.h"

#include "base/memory.h"
#include "base/names.h"
#include "dynamics/respa.h"

NAMED_RECORD(struct integrator);

static void fault_too_few_particles(const struct scene *scene, struct json_object *object) {
    struct json_object particles = mf_json_child(object, "particles", false);
    if (particles.item && mf_json_has(&particles, "count") &&
        mf_json_fault_count(object->document) == 0)
        mf_json_fault(&particles, "count", "%lld is out of range; allowed: 2 to 1e+08",
                      (long long)scene->setup.placement.count);
}

/// Orientations are of the plane, and of those whom somebody turns; a file may bring them along.
static void check_orientation(const struct scene *scene, struct json_object *object) {
    const struct attributes_source *source = &scene->setup.attribute[ATTRIBUTES_ORIENTATION];
    const struct integrator *integrator = scene->setup.integrator;
    if (source->ranges == 0)
        return;
    if (scene->setup.box.dimensions != 2)
        mf_json_fault(object, "particles.orientation",
                      "orientations are of two dimensions, not %d; leave it out",
                      scene->setup.box.dimensions);
    else if (integrator->orientation_mobility == NULL && source->column == NULL)
        mf_json_fault(object, "particles.orientation",
                      "%s turns no orientations; leave it out, or use \"%s\"", integrator->name,
                      mf_brownian.name);
}

/// Whether there is memory, or friction across pairs, or it is to be found.
static bool remembers(const struct scene *scene) {
    return pair_memory_acts(&scene->setup.memory) || (scene->unknown & SCENE_FITS_TRANSVERSE);
}

static bool is_dissipative(const struct scene *scene) {
    return scene->omega.curves > 0 || (scene->unknown & SCENE_FITS_OMEGA) || remembers(scene);
}

/// What moves the beads of a scene that does not say it.
static const struct integrator *usual_integrator(const struct scene *scene) {
    return is_dissipative(scene) ? &mf_aboba : &mf_velocity_verlet;
}

/// Moves of Monte Carlo know pairs and molecules, in the precision of single moves.
static void check_moves(const struct scene *scene, struct json_object *object) {
    const struct simulation_setup *setup = &scene->setup;
    for (int k = 0; k < setup->interactions; k++) {
        const struct interaction *kind = setup->interaction[k].kind;
        char key[64];
        snprintf(key, sizeof key, "interactions.%s", kind->name);
        if (kind == &mf_many_body)
            snprintf(key, sizeof key, "many_body");
        if (kind != &mf_molecules)
            mf_json_fault(
                object, key,
                "\"%s\" moves by the energy of pairs and molecules alone; leave it out, or "
                "take another integrator",
                setup->integrator->name);
    }
    if (setup->precision == PAIR_DOUBLE)
        mf_json_fault(object, "precision",
                      "\"%s\" computes its moves in mixed precision; leave it out",
                      setup->integrator->name);
}

/// Masses of 1 are the unit; particles do not have them where these would not be read, or cost
/// time in a sweep of the friction.
static void check_masses(struct scene *scene, struct json_object *object) {
    const struct integrator *integrator = scene->setup.integrator;
    struct attributes_source *mass = &scene->setup.attribute[ATTRIBUTES_MASS];
    if (attributes_are(mass, 1) && (!integrator->masses || integrator->friction))
        mass->ranges = 0;
    else if (mass->ranges > 0 && !integrator->masses)
        mf_json_fault(
            object, "particles.mass",
            "%s moves particles of mass 1 only; \"aboba\" and \"dpd-verlet\" move others, "
            "and without \"dissipative\" \"velocity-verlet\"",
            integrator->name);
    else if (mass->ranges > 0 && remembers(scene))
        mf_json_fault(object, "particles.mass",
                      "friction with memory or perpendicular to pairs needs particles of mass 1");
}

/// With its default parameters.
static enum status take_integrator(struct scene *scene, const struct integrator *integrator) {
    mf_memory_free(scene->integrator_parameters);
    scene->integrator_parameters = NULL;
    if (integrator->parameters_size > 0) {
        scene->integrator_parameters = mf_memory_zeroed(1, integrator->parameters_size);
        if (scene->integrator_parameters == NULL)
            return STATUS_NO_MEMORY;
    }
    mf_fields_set_defaults(integrator->fields, scene->integrator_parameters);
    scene->setup.integrator = integrator;
    scene->setup.integrator_parameters = scene->integrator_parameters;
    return STATUS_OK;
}

/// What the integrator cannot do.
static void check_integrator(struct scene *scene, struct json_object *object) {
    const struct integrator *integrator = scene->setup.integrator;
    if (scene->setup.temperature == 0 && integrator->mobility == NULL)
        mf_json_fault(object, "temperature", "0 is for dynamics without velocities, as \"%s\"",
                      mf_brownian.name);
    const struct interaction *oriented = mf_simulation_oriented(&scene->setup);
    if (oriented && scene->setup.box.dimensions == 2 && integrator->orientation_mobility == NULL)
        mf_json_fault(object, "dynamics",
                      "%s turns no orientations, which \"%s\" is about; use \"%s\"",
                      integrator->name, oriented->name, mf_brownian.name);
    if (scene->setup.placement.count < 2 && integrator->solvent_particles == NULL)
        fault_too_few_particles(scene, object);
    if (scene->unknown && integrator->events)
        mf_json_fault(object, "dynamics",
                      "%s moves hard particles, which have no forces that could be found",
                      integrator->name);
    else if (is_dissipative(scene) && !integrator->dissipative)
        mf_json_fault(object, "dynamics",
                      integrator->samples
                          ? "%s has no friction: leave \"dissipative\" out"
                          : "%s has no friction; use \"aboba\" with \"dissipative\"",
                      integrator->name);
    else if (remembers(scene) && !integrator->remembers)
        mf_json_fault(object, "dynamics", "%s does not integrate \"%s\"; use \"aboba\"",
                      integrator->name,
                      scene->memory.modes > 0 ? "memory" : "dissipative_transverse");
    if (integrator->samples)
        check_moves(scene, object);
    check_orientation(scene, object);
    check_masses(scene, object);
}

enum status mf_scene_dynamics_read(struct scene *scene, struct json_object *object) {
    const char **names;
    TRY(mf_names_collect(mf_integrator_list, NULL, &names));
    struct json_object dynamics = mf_json_child_of(object, "dynamics", false, "integrator");
    const char *name = usual_integrator(scene)->name;
    if (dynamics.item)
        name = mf_json_choice(&dynamics, "integrator", names, name);
    mf_memory_free(names);
    if (name == NULL)
        return STATUS_OK;
    TRY(take_integrator(scene, mf_names_find(mf_integrator_list, name)));
    mf_json_fields(&dynamics, scene->setup.integrator->fields, scene->integrator_parameters);
    if (dynamics.item)
        mf_json_finish(&dynamics);
    check_integrator(scene, object);
    return STATUS_OK;
}

enum status mf_scene_dynamics_complete(struct scene *scene, struct json_object *object,
                                       const struct integrator *integrator, int64_t inner_steps) {
    if (integrator == NULL && !scene->given.dynamics)
        integrator = usual_integrator(scene);
    if (integrator && integrator != scene->setup.integrator) {
        TRY(take_integrator(scene, integrator));
        check_integrator(scene, object);
    }
    if (inner_steps > 0)
        mf_respa_set(scene->setup.integrator, scene->integrator_parameters, inner_steps);
    return STATUS_OK;
}
