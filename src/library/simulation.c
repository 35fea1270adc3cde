// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesofit/simulation.h"

#include "base/memory.h"
#include "dynamics/user_force.h"
#include "io/json_write.h"
#include "io/units.h"
#include "scene/heading.h"
#include "scene/scene.h"
#include "scene/scene_step.h"
#include "library/guard.h"
#include "library/memory_files.h"
#include "library/scene_words.h"
#include "observe/measure.h"
#include "observe/rdf_observable.h"
#include "observe/thermodynamics.h"

#include <math.h>
#include <stdlib.h>

struct mesofit_simulation {
    struct scene scene;
    struct simulation engine;
    struct user_force force;
    char *text; ///< of the scene, once it was asked for
    atomic_bool stop;
};

/// Name of a text that is no file, in messages.
static const char in_memory[] = "scene";

/// What the root of a scene says.
static enum status read_root(struct scene *scene, struct json_document *document) {
    struct heading heading;
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, mf_heading_fields, &heading);
    const enum status status = mf_scene_read(scene, &root, SCENE_FITS_NOTHING, NULL);
    // What `mesofit simulate` measures is the caller's business here.
    mf_json_has(&root, "measure");
    for (size_t k = 0; mf_observables[k]; k++)
        mf_json_has(&root, mf_observables[k]->name);
    mf_json_finish(&root);
    scene->setup.seed = heading.seed;
    scene->setup.threads = 1;
    return status;
}

static void choose_step(struct scene *scene) {
    char chosen[SCENE_STEP_SIZE];
    mf_scene_step_choose(scene, false, chosen);
}

/// A scene of a file, or, with `own`, of the caller.
static enum status read_scene(struct scene *scene, const char *file,
                              const struct mesofit_scene *own) {
    struct json_document *document;
    struct json_word words[SCENE_WORDS];
    enum status status =
        own ? mf_json_open_text(&document, in_memory, "{}") : mf_json_open(&document, file);
    if (own && status == STATUS_OK)
        status = mf_json_add(document, words, mf_scene_words(own, false, words));
    if (status == STATUS_OK)
        status = read_root(scene, document);
    return mf_json_close(document, status);
}

static enum status begin(struct mesofit_simulation *simulation) {
    simulation->scene.setup.cancel = &simulation->stop;
    return mf_simulation_init(&simulation->engine, &simulation->scene.setup,
                              &simulation->scene.start);
}

/// Make a simulation of a file, or of a scene of the caller's.
static enum status open_scene(struct mesofit_simulation **simulation, const char *file,
                              const struct mesofit_scene *own) {
    enum status status = STATUS_OK;
    NEW_ARRAY(*simulation, 1);
    CHECK(read_scene(&(*simulation)->scene, file, own));
    choose_step(&(*simulation)->scene);
    if (own) {
        (*simulation)->scene.setup.threads = own->threads;
        CHECK(mf_scene_words_add_own(own, &(*simulation)->scene));
    }
    CHECK(begin(*simulation));
    CHECK(mf_simulation_add_interaction(
        &(*simulation)->engine,
        &(struct interaction_choice){&mf_user_force, &(*simulation)->force}));
done:
    if (status != STATUS_OK) {
        if (*simulation)
            mf_units_convert_message(&(*simulation)->scene.units, status);
        mesofit_simulation_free(*simulation);
        *simulation = NULL;
    }
    return status;
}

struct mesofit_simulation *mesofit_simulation_open(const char *file) {
    struct mesofit_simulation *simulation = NULL;
    mf_guard_enter();
    mf_guard_return(open_scene(&simulation, file, NULL));
    return simulation;
}

struct mesofit_simulation *
mesofit_simulation_parse(const char *text, const struct mesofit_table *tables, size_t table_count) {
    struct mesofit_simulation *simulation = NULL;
    struct memory_files memory_files;
    mf_guard_enter();
    if (mf_memory_files_begin(&memory_files, &(const struct mesofit_text){in_memory, text}, 1,
                              tables, table_count) == STATUS_OK) {
        if (open_scene(&simulation, in_memory, NULL) != STATUS_OK)
            simulation = NULL;
        mf_memory_files_end(&memory_files);
    }
    mf_guard_leave();
    return simulation;
}

struct mesofit_simulation *mesofit_simulation_create(const struct mesofit_scene *scene) {
    struct mesofit_simulation *simulation = NULL;
    mf_guard_enter();
    mf_guard_return(open_scene(&simulation, NULL, scene));
    return simulation;
}

void mesofit_simulation_free(struct mesofit_simulation *simulation) {
    if (simulation == NULL)
        return;
    mf_simulation_clear(&simulation->engine);
    mf_scene_clear(&simulation->scene);
    free(simulation->text);
    mf_memory_free(simulation);
}

void mesofit_simulation_set_force(struct mesofit_simulation *simulation, mesofit_force *force,
                                  void *context) {
    simulation->force = (struct user_force){force, context};
}

// What it is --------------------------------------------------------------------------------------

static void write_scale(const struct units *units, struct json_writer *writer) {
    mf_json_begin(writer, "physical");
    mf_json_write_number(writer, "length_unit_nm", units->length);
    mf_json_write_number(writer, "time_unit_ps", mf_units_time_ps(units));
    mf_json_write_number(writer, "energy_unit_kJ_per_mol", mf_units_energy_kj_per_mol(units));
    mf_json_write_number(writer, "mass_unit_u", units->mass / UNITS_ATOMIC_MASS);
    mf_json_write_number(writer, "temperature_unit_K", units->temperature);
    mf_json_end(writer);
}

static enum status write_scene(const struct scene *scene, FILE *stream) {
    const struct box *box = &scene->setup.box;
    struct json_writer *writer = mf_json_writer_create();
    if (writer == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    if (mf_units_known(&scene->units))
        write_scale(&scene->units, writer);
    mf_json_write_quantities(writer, "edges", "", box->length, (size_t)box->dimensions);
    mf_units_write(&scene->units, writer);
    mf_scene_write(scene, writer);
    const enum status status = mf_json_write_stream(writer, stream, in_memory);
    mf_json_writer_free(writer);
    return status;
}

const char *mesofit_simulation_text(struct mesofit_simulation *simulation) {
    size_t size;
    if (simulation == NULL)
        return NULL;
    FILE *stream = simulation->text ? NULL : open_memstream(&simulation->text, &size);
    if (stream == NULL)
        return simulation->text;
    mf_guard_enter();
    const enum status status = write_scene(&simulation->scene, stream);
    mf_guard_leave();
    if (fclose(stream) == 0 && status == STATUS_OK)
        return simulation->text;
    free(simulation->text);
    return simulation->text = NULL;
}

// Steps -------------------------------------------------------------------------------------------

static enum status check_force(const struct mesofit_simulation *simulation) {
    const struct integrator *integrator = simulation->engine.setup.integrator;
    if (simulation->force.function == NULL || !integrator->samples)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "a force of the caller's: \"%s\" moves by the energy of pairs and "
                          "molecules alone",
                          integrator->name);
}

void mesofit_simulation_stop(struct mesofit_simulation *simulation) {
    atomic_store(&simulation->stop, true);
}

/// What was stopped before is no business of what begins.
static enum status prepare(struct mesofit_simulation *simulation) {
    atomic_store(&simulation->stop, false);
    return check_force(simulation);
}

static enum status run(struct mesofit_simulation *simulation, uint64_t steps) {
    TRY(prepare(simulation));
    return mf_simulation_run(&simulation->engine, steps);
}

enum mesofit_status mesofit_simulation_run(struct mesofit_simulation *simulation, uint64_t steps) {
    mf_guard_enter();
    return mf_guard_return(
        mf_units_convert_message(&simulation->scene.units, run(simulation, steps)));
}

uint64_t mesofit_simulation_step(const struct mesofit_simulation *simulation) {
    return simulation->engine.step;
}

size_t mesofit_simulation_count(const struct mesofit_simulation *simulation) {
    return simulation->engine.particles.count;
}

int mesofit_simulation_dimensions(const struct mesofit_simulation *simulation) {
    return simulation->engine.particles.box.dimensions;
}

const uint32_t *mesofit_simulation_ids(const struct mesofit_simulation *simulation) {
    return simulation->engine.particles.id;
}

static bool has_axis(const struct mesofit_simulation *simulation, int axis) {
    return axis >= 0 && axis < simulation->engine.particles.box.dimensions;
}

const double *mesofit_simulation_positions(const struct mesofit_simulation *simulation, int axis) {
    return has_axis(simulation, axis) ? simulation->engine.particles.position[axis] : NULL;
}

const double *mesofit_simulation_velocities(const struct mesofit_simulation *simulation, int axis) {
    return has_axis(simulation, axis) ? simulation->engine.particles.velocity[axis] : NULL;
}

double mesofit_simulation_temperature(const struct mesofit_simulation *simulation) {
    return simulation_has_velocities(&simulation->engine.setup)
               ? mf_particles_temperature(&simulation->engine.particles)
               : NAN;
}

// Measurements ------------------------------------------------------------------------------------

/// From now on.
static struct measure_plan plan_from_now(const struct mesofit_simulation *simulation,
                                         size_t samples, uint64_t every) {
    return (struct measure_plan){.equilibration = (int64_t)simulation->engine.step,
                                 .samples = (int64_t)samples,
                                 .every = (int64_t)every};
}

static enum status check_plan(struct mesofit_simulation *simulation, size_t samples,
                              uint64_t every) {
    TRY(prepare(simulation));
    if (samples > 0 && every > 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "samples and the steps between them must be positive");
}

struct mesofit_rdf_plan mesofit_rdf_plan_default(void) {
    return (struct mesofit_rdf_plan){.bins = 100, .samples = 200, .every = 25};
}

static enum status measure_rdf(struct mesofit_simulation *simulation,
                               const struct mesofit_rdf_plan *plan, double *r, double *g,
                               double *error) {
    enum status status = STATUS_OK;
    struct simulation *engine = &simulation->engine;
    const double cutoff = mf_pair_cutoff(&engine->law);
    const double range = plan->range > 0 ? plan->range : cutoff;
    struct rdf_observed rdf = {0};
    const struct observable_use uses[] = {{&mf_rdf_observable, &rdf, NULL}, {NULL, NULL, NULL}};
    TRY(check_plan(simulation, plan->samples, plan->every));
    if (!(plan->range >= 0) || !(range > 0) || plan->bins == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "g(r) needs bins and, without forces, a range");
    const struct rdf_bins bins = {.width = range / (double)plan->bins, .count = plan->bins};
    const struct measure_plan when = plan_from_now(simulation, plan->samples, plan->every);
    CHECK(mf_rdf_init(&rdf.counted, &bins, &engine->particles.box, engine->particles.count, cutoff,
                      plan->samples));
    CHECK(mf_measure_sample(engine, &when, uses, NULL));
    CHECK(mf_rdf_result(&rdf.counted, 1, g, error));
    for (size_t k = 0; k < bins.count; k++)
        r[k] = mf_rdf_bins_centre(&bins, k);
done:
    mf_rdf_clear(&rdf.counted);
    return status;
}

enum mesofit_status mesofit_simulation_rdf(struct mesofit_simulation *simulation,
                                           const struct mesofit_rdf_plan *plan, double *r,
                                           double *g, double *error) {
    mf_guard_enter();
    return mf_guard_return(mf_units_convert_message(&simulation->scene.units,
                                                    measure_rdf(simulation, plan, r, g, error)));
}

static enum status measure_means(struct mesofit_simulation *simulation, size_t samples,
                                 uint64_t every, struct mesofit_means *means) {
    enum status status = STATUS_OK;
    struct thermodynamics thermodynamics = {0};
    const struct observable_use uses[] = {{&mf_thermodynamics_observable, &thermodynamics, NULL},
                                          {NULL, NULL, NULL}};
    TRY(check_plan(simulation, samples, every));
    const struct measure_plan when = plan_from_now(simulation, samples, every);
    mf_thermodynamics_init(&thermodynamics);
    CHECK(mf_measure_sample(&simulation->engine, &when, uses, NULL));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    *means = (struct mesofit_means){.temperature = s.temperature,
                                    .temperature_error = s.temperature_error,
                                    .energy = s.potential_energy,
                                    .energy_error = s.potential_energy_error,
                                    .pressure = s.pressure,
                                    .pressure_error = s.pressure_error};
done:
    mf_thermodynamics_clear(&thermodynamics);
    return status;
}

enum mesofit_status mesofit_simulation_means(struct mesofit_simulation *simulation, size_t samples,
                                             uint64_t every, struct mesofit_means *means) {
    mf_guard_enter();
    return mf_guard_return(mf_units_convert_message(
        &simulation->scene.units, measure_means(simulation, samples, every, means)));
}
