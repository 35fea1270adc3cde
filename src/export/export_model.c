// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_model.h"

#include "base/memory.h"
#include "curves/bonded_table.h"
#include "curves/sampled.h"
#include "curves/sum.h"
#include "export/export_columns.h"
#include "export/export_density.h"
#include "export/export_start.h"
#include "defaults/fit_states.h"
#include "defaults/fit_unknowns.h"
#include "scene/heading.h"
#include "observe/rdf_observable.h"
#include "problem/verify.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

/// What is read on the way.
struct reading {
    struct export_model *model;
    int unknown; ///< a sum of scene_unknown
    struct inverse_number number[INVERSE_MAX_NUMBERS];
    double value[INVERSE_MAX_NUMBERS];
    size_t numbers;
};

static void file_of(const struct export_model *model, const char *name, char *path) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.3900s/%.120s", model->folder, name);
}

static bool exists(const char *path) {
    struct stat found;
    return stat(path, &found) == 0;
}

static enum status check_folder(const struct export_model *model) {
    static const char *const names[] = {"used.json", "summary.json"};
    char path[OUTPUT_PATH_SIZE];
    if (!exists(model->folder))
        return mf_status_fail(STATUS_IO, "%s: %s", model->folder, strerror(errno));
    file_of(model, "target.json", path);
    if (exists(path))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the folder holds a measured target, not a result: fit it first "
                              "(mesofit fit --target %s -o fit) and export the fit",
                              model->folder, model->folder);
    for (int k = 0; k < 2; k++) {
        file_of(model, names[k], path);
        if (!exists(path))
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: not the folder of a finished fit or simulation: it has no %s", model->folder,
                names[k]);
    }
    return STATUS_OK;
}

/// The scene of a run file leaves out what was fitted.
static enum status read_run(struct reading *reading, struct json_object *root,
                            struct json_object *object) {
    struct scene *scene = &reading->model->scene;
    struct json_object unknowns = mf_json_child(root, "unknowns", true);
    struct scene_fitted fitted;
    reading->unknown = mf_fit_unknowns_left_out(root);
    mf_fit_unknowns_groups(root, object, &fitted);
    TRY(mf_scene_read(scene, object, reading->unknown, &fitted));
    return mf_fit_numbers_read(&unknowns, scene, reading->number, &reading->numbers);
}

/// The step that the result was verified with.
static void read_time_step(struct simulation_setup *setup, struct json_object *root) {
    struct verify_parameters verification;
    struct json_object object = mf_json_child(root, "verification", false);
    mf_json_fields(&object, mf_verify_fields, &verification);
    if (verification.time_step > 0)
        setup->time_step = verification.time_step;
}

static enum status read_used(struct reading *reading) {
    struct export_model *model = reading->model;
    char path[OUTPUT_PATH_SIZE], state[FIT_STATE_NAME_SIZE];
    size_t states;
    struct json_document *document;
    struct heading heading;
    file_of(model, "used.json", path);
    TRY(mf_json_open(&document, path));
    // Of several states, the first.
    const enum status taken = mf_fit_states_take(document, path, 0, state, &states);
    if (taken != STATUS_OK)
        return mf_json_close(document, taken);
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, mf_heading_fields, &heading);
    snprintf(model->title, sizeof model->title, "%s", heading.title);
    reading->model->fit = mf_json_is_object(&root, "scene");
    struct json_object scene = reading->model->fit ? mf_json_child(&root, "scene", true) : root;
    if (reading->model->fit) // of a scene that is its own root, mf_scene_read does so
        mf_units_read_document(&root, &scene);
    const enum status status = reading->model->fit
                                   ? read_run(reading, &root, &scene)
                                   : mf_scene_read(&model->scene, &scene, SCENE_FITS_NOTHING, NULL);
    read_time_step(&model->scene.setup, &root);
    struct engine_settings engine;
    struct json_object sampled = mf_json_child(&root, "engine", false);
    mf_json_fields(&sampled, mf_sampling_engine_fields, &engine);
    model->partial = engine.kind == ENGINE_COMMAND || engine.input[0];
    TRY(mf_json_close(document, status));
    model->setup = model->scene.setup;
    model->scene.units.dimensions = model->setup.box.dimensions;
    model->setup.seed = heading.seed;
    return STATUS_OK;
}

#define NUMBER(key, member, its_unit)                                                              \
    {                                                                                              \
        .name = key, .type = FIELD_NUMBER, .offset = offsetof(struct export_model, member),        \
        .initial = NAN, .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = its_unit                  \
    }
static const struct field summary_fields[] = {
    NUMBER("temperature", temperature.value, "T_0"),
    NUMBER("temperature_error", temperature.error, "T_0"),
    NUMBER("temperature_configurational", configurational.value, "T_0"),
    NUMBER("temperature_configurational_error", configurational.error, "T_0"),
    NUMBER("pressure", pressure.value, "k_B T_0/lambda^d"),
    NUMBER("pressure_error", pressure.error, "k_B T_0/lambda^d"),
    NUMBER("density", density, "1/lambda^d"),
    NUMBER("compressibility", compressibility.value, "1"),
    NUMBER("compressibility_error", compressibility.error, "1"),
    NUMBER("diffusion", diffusion.value, "lambda^2/tau"),
    NUMBER("diffusion_error", diffusion.error, "lambda^2/tau"),
    NUMBER("verification_time_step", verified_step, "tau"),
    FIELD_END,
};
/// Of a simulation, in its object "motion".
static const struct field motion_fields[] = {
    NUMBER("diffusion_msd", diffusion.value, "lambda^2/tau"),
    NUMBER("diffusion_msd_error", diffusion.error, "lambda^2/tau"),
    FIELD_END,
};

/// "parameters": {"dissipative.sigma": {"value": 3.1, …}, …}: numbers of the scene that were
/// fitted.
static void read_numbers(struct reading *reading, struct json_object *root) {
    struct json_object parameters = mf_json_child(root, "parameters", reading->numbers > 0);
    for (size_t n = 0; n < reading->numbers; n++) {
        const struct field fields[] = {{.name = "value",
                                        .type = FIELD_NUMBER,
                                        .required = true,
                                        .minimum = -DBL_MAX,
                                        .maximum = DBL_MAX,
                                        .unit = reading->number[n].unit},
                                       FIELD_END};
        struct json_object number = mf_json_child(&parameters, reading->number[n].name, true);
        mf_json_fields(&number, fields, &reading->value[n]);
    }
}

static enum status read_summary(struct reading *reading) {
    struct export_model *model = reading->model;
    char path[OUTPUT_PATH_SIZE];
    struct json_document *document;
    file_of(model, "summary.json", path);
    TRY(mf_json_open(&document, path));
    mf_json_set_units(document, &model->scene.units);
    struct json_object root = mf_json_root(document);
    const char *status = mf_json_choice(&root, "status", NULL, "");
    if (status && reading->model->fit && strcmp(status, "converged") != 0 &&
        strcmp(status, "finished") != 0)
        snprintf(model->warning, sizeof model->warning,
                 "%.160s: the fit is %.40s; what is exported is its best so far", model->folder,
                 status);
    const char *friction = mf_json_choice(&root, "friction", NULL, "");
    model->thermostat = friction && strcmp(friction, "chosen") == 0;
    mf_json_fields(&root, summary_fields, model);
    if (mf_json_is_object(&root, "motion")) {
        struct json_object motion = mf_json_child(&root, "motion", true);
        mf_json_fields(&motion, motion_fields, model);
    }
    // At constant pressure the box is that of the density which came out.
    if (model->fit && model->density > 0)
        model->setup.box = mf_box_scaled(&model->setup.box,
                                         (double)model->setup.placement.count /
                                             (model->density * mf_box_volume(&model->setup.box)));
    else
        model->density = NAN;
    if (model->verified_step > 0) // what the verification chose, if that was left to it
        model->setup.time_step = model->verified_step;
    read_numbers(reading, &root);
    return mf_json_close(document, STATUS_OK);
}

/// The first interaction beside the pairs that is not of molecules or local densities, or NULL.
static const struct interaction *find_other(const struct simulation_setup *setup) {
    for (int k = 0; k < setup->interactions; k++)
        if (setup->interaction[k].kind != &mf_molecules &&
            setup->interaction[k].kind != &mf_many_body)
            return setup->interaction[k].kind;
    return NULL;
}

/// What forces of pairs, molecules and local densities and velocities do not express.
static enum status check_scene(const struct export_model *model) {
    const struct simulation_setup *setup = &model->setup;
    const char *what = NULL, *why = NULL;
    if (setup->integrator->events || setup->integrator->solvent_particles) {
        what = setup->integrator->name;
        why = setup->integrator->events ? "moves hard particles, which have no pair forces"
                                        : "moves a solvent, which other engines do not have";
    } else if (!simulation_has_velocities(setup)) {
        what = setup->integrator->name;
        why = "moves particles without velocities; only dynamics with velocities are exported";
    } else if (find_other(setup)) {
        what = find_other(setup)->name;
        why = "is not a force of pairs, molecules or local densities; only these are exported";
    }
    return what == NULL ? STATUS_OK
                        : mf_status_fail(STATUS_BAD_INPUT, "%s: cannot be exported: \"%s\" %s",
                                         model->folder, what, why);
}

/// A curve through the points with `sign` errors added, and what is known beside it, or NULL; what
/// is set and has no error moves with the first point that has one, and the last stays 0.
static enum status make_curve(const struct export_columns *points, int sign,
                              const struct curve *known, struct table *table) {
    enum status status = STATUS_OK;
    const size_t rows = points->rows;
    const double *r = points->values, *phi = r + rows, *error = phi + rows;
    double *moved = NULL;
    struct curve curve = {0};
    size_t first = 0;
    NEW_ARRAY(moved, rows);
    while (first < rows && isnan(error[first]))
        first++;
    for (size_t k = 0; k < rows; k++) {
        const double own = k < first && first < rows ? error[first] : error[k];
        moved[k] = phi[k] + (sign && isfinite(own) ? sign * own : 0);
    }
    CHECK(mf_sampled_create(&curve, r, moved, rows));
    status = known ? mf_sum_tabulate(table, &curve, known) : mf_table_init_potential(table, &curve);
    mf_curve_clear(&curve);
done:
    mf_memory_free(moved);
    return status;
}

static bool has_errors(const struct export_columns *points) {
    for (size_t k = 0; k < points->rows; k++)
        if (isfinite(points->values[2 * points->rows + k]))
            return true;
    return false;
}

/// The fitted potentials, "potential.tsv" or "potential_A-B.tsv".
static enum status read_potentials(struct export_model *model) {
    static const struct export_column wanted[] = {
        {"r", "lambda", true}, {"phi", "k_B.T_0", true}, {"phi_error", "k_B.T_0", false}, {0}};
    static const int sign[EXPORT_CURVES] = {0, -1, 1};
    enum status status = STATUS_OK;
    const int pairs = mf_export_model_pairs(model);
    struct table part[EXPORT_CURVES][COMPOSITION_MAX_PAIRS] = {{{0}}};
    model->bands = true;
    for (int pair = 0; pair < pairs; pair++) {
        const struct curve *known = mf_scene_law_curve(&model->scene.known, pair);
        struct export_columns points;
        char path[OUTPUT_PATH_SIZE], name[2 * COMPOSITION_PAIR_NAME_SIZE],
            of[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&model->setup.composition, pair, of);
        snprintf(name, sizeof name, "potential%s%s.tsv", pairs > 1 ? "_" : "", pairs > 1 ? of : "");
        file_of(model, name, path);
        CHECK(mf_export_columns_read(&points, path, &model->scene.units, wanted));
        for (int c = 0; c < EXPORT_CURVES && status == STATUS_OK; c++)
            status = make_curve(&points, sign[c], known, &part[c][pair]);
        model->bands = model->bands && has_errors(&points);
        mf_export_columns_clear(&points);
        if (status != STATUS_OK)
            status = mf_status_prefix(status, "%s", path);
        CHECK(status);
    }
    for (int c = 0; c < EXPORT_CURVES; c++)
        CHECK(mf_table_stack(&model->potential[c], part[c], pairs));
    model->setup.potential = &model->potential[EXPORT_FITTED];
done:
    for (int k = 0; k < EXPORT_CURVES * COMPOSITION_MAX_PAIRS; k++)
        mf_table_clear(&part[k / COMPOSITION_MAX_PAIRS][k % COMPOSITION_MAX_PAIRS]);
    return status;
}

/// The fitted laws of groups: bonds_backbone.tsv, angles_bend.tsv and so on.
static enum status read_groups(struct export_model *model) {
    struct molecules *molecules = &model->scene.molecules.molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            struct molecules_group *group = &molecules->group[order][g];
            const char *const unit[2] = {mf_bonded_kinds[order]->unit, "k_B T_0"};
            char path[OUTPUT_PATH_SIZE], name[2 * TOPOLOGY_NAME_SIZE];
            double *q, *energy;
            size_t count;
            if (!mf_scene_groups_are_fitted(group))
                continue;
            snprintf(name, sizeof name, "%s_%s.tsv", mf_bonded_kinds[order]->plural, group->name);
            file_of(model, name, path);
            TRY(mf_scene_read_columns(path, unit, bonded_min(order), &model->scene.units, &q,
                                      &energy, &count));
            const enum status status = mf_bonded_table_set_points(&group->curve, q, energy, count);
            mf_memory_free(q);
            mf_memory_free(energy);
            if (status != STATUS_OK)
                return mf_status_prefix(status, "%s", path);
        }
    return STATUS_OK;
}

/// Numbers of the scene that were fitted: its laws and settings with their values.
static enum status apply_numbers(struct reading *reading) {
    struct export_model *model = reading->model;
    struct inverse_problem problem = {.numbers = reading->numbers, .scene = model->setup}, changed;
    memcpy(problem.number, reading->number, sizeof problem.number);
    mf_fit_numbers_lend(&model->scene, &problem);
    TRY(mf_numbers_apply(&problem, reading->value, &changed, &model->own));
    model->setup = changed.scene;
    return STATUS_OK;
}

static enum status find_laws(struct reading *reading) {
    struct export_model *model = reading->model;
    TRY(apply_numbers(reading));
    if (reading->unknown & SCENE_FITS_POTENTIAL)
        TRY(read_potentials(model));
    TRY(read_groups(model));
    TRY(mf_export_densities_read(model));
    TRY(mf_export_friction_find(model, reading->unknown));
    if (model->setup.potential == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no potential to export",
                              model->folder);
    return STATUS_OK;
}

/// The bins of the result's g(r), or a hundred up to the cutoff.
static enum status find_bins(struct export_model *model) {
    static const struct export_column wanted[] = {{"r", "lambda", true}, {0}};
    char path[OUTPUT_PATH_SIZE];
    model->rdf_bins = 100;
    model->rdf_range = mf_export_model_cutoff(model);
    mf_rdf_observable_file(model->folder, "rdf", &model->setup.composition, 0, path);
    if (!exists(path))
        return STATUS_OK;
    struct export_columns columns;
    TRY(mf_export_columns_read(&columns, path, &model->scene.units, wanted));
    const double *r = columns.values;
    if (columns.rows > 1) {
        const double width = (r[columns.rows - 1] - r[0]) / (double)(columns.rows - 1);
        const double below = floor(r[0] / width); // bins of LAMMPS begin at 0
        model->rdf_bins = columns.rows + (size_t)below;
        model->rdf_range = (double)model->rdf_bins * width;
    }
    mf_export_columns_clear(&columns);
    return STATUS_OK;
}

static void name_types(struct export_model *model) {
    const struct composition *composition = &model->setup.composition;
    model->types = composition_is_mixed(composition) ? composition->types : 1;
    for (int type = 0; type < model->types; type++)
        snprintf(model->name[type], sizeof model->name[type], "%s",
                 composition_is_mixed(composition) ? composition->name[type] : "A");
}

enum status mf_export_model_read(struct export_model *model, const char *folder) {
    struct reading reading = {.model = model};
    *model = (struct export_model){
        .temperature = {NAN, NAN}, .pressure = {NAN, NAN}, .configurational = {NAN, NAN}};
    snprintf(model->folder, sizeof model->folder, "%s", folder);
    TRY(check_folder(model));
    TRY(read_used(&reading));
    TRY(check_scene(model));
    TRY(read_summary(&reading));
    name_types(model);
    TRY(find_laws(&reading));
    model->molecules = mf_molecules_find(model->setup.interaction, model->setup.interactions);
    TRY(mf_export_start_find(model));
    return find_bins(model);
}

void mf_export_model_clear(struct export_model *model) {
    for (int d = 0; d < 3; d++) {
        mf_memory_free(model->position[d]);
        mf_memory_free(model->velocity[d]);
        mf_memory_free(model->image[d]);
    }
    for (int c = 0; c < EXPORT_CURVES; c++)
        mf_table_clear(&model->potential[c]);
    mf_export_friction_clear(model);
    mf_numbers_own_clear(&model->own);
    mf_scene_clear(&model->scene);
    *model = (struct export_model){0};
}

int mf_export_model_pairs(const struct export_model *model) {
    return mf_composition_pairs(&model->setup.composition);
}

const struct table *mf_export_model_potential(const struct export_model *model,
                                              enum export_curve curve) {
    return curve == EXPORT_FITTED ? model->setup.potential : &model->potential[curve];
}

void mf_export_model_pair(const struct export_model *model, int pair, int type[2],
                          char name[COMPOSITION_PAIR_NAME_SIZE]) {
    type[0] = type[1] = 0;
    if (model->types > 1)
        mf_composition_pair_types(&model->setup.composition, pair, type);
    snprintf(name, COMPOSITION_PAIR_NAME_SIZE, "%.14s-%.14s", model->name[type[0]],
             model->name[type[1]]);
}

double mf_export_model_cutoff(const struct export_model *model) {
    const struct simulation_setup *setup = &model->setup;
    const struct many_body *law = mf_many_body_find(setup->interaction, setup->interactions);
    double cutoff = setup->potential->cutoff;
    if (setup->omega)
        cutoff = fmax(cutoff, setup->omega->cutoff);
    if (export_model_across(model))
        cutoff = fmax(cutoff, export_model_across(model)->cutoff);
    for (int t = 0; law && t < law->terms; t++)
        cutoff = fmax(cutoff, weight_cutoff(&law->term[t].weight));
    return cutoff;
}
