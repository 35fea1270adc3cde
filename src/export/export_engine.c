// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_checks.h"

#include "base/memory.h"
#include "base/nearest.h"
#include "base/version.h"
#include "dynamics/hybrid_step.h"
#include "io/tracked_files.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define EXPORT_LIST(record) &record,
static const struct export_engine *const engines[] = {EXPORT_ENGINES(EXPORT_LIST) NULL};

enum { MAX_ENGINES = 16 };

enum status mf_export_find(const char *name, const struct export_engine **engine) {
    const char *names[MAX_ENGINES];
    char hint[256];
    size_t count = 0;
    for (; engines[count]; count++) {
        names[count] = engines[count]->name;
        if (strcmp(name, names[count]) == 0) {
            *engine = engines[count];
            return STATUS_OK;
        }
    }
    mf_nearest_hint(name, names, count, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "unknown engine \"%s\"; %s", name, hint);
}

static enum status check_friction(const struct export_job *job) {
    if (job->engine->friction == EXPORT_NO_FRICTION)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: --project: what is written for %s has no friction between pairs",
                              job->model->folder, job->engine->title);
    if (job->model->remembers || !export_model_has_friction(job->model))
        return mf_status_fail(
            STATUS_BAD_INPUT, "%s: --project: there is no friction weight%s", job->model->folder,
            job->model->remembers ? " alone: no law of an engine stands for friction with memory"
                                  : "");
    if (export_model_across(job->model) && !job->engine->across)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: --project: friction of %s is along pairs alone; LAMMPS and "
                              "ESPResSo have it across pairs, too",
                              job->model->folder, job->engine->title);
    return STATUS_OK;
}

/// Where two pairs of types would be one to the engine, the potential of one would stand for both.
static enum status check_pair_names(const struct export_job *job) {
    const struct export_model *model = job->model;
    const int pairs = mf_export_model_pairs(model);
    char called[COMPOSITION_MAX_PAIRS][EXPORT_PAIR_NAME_SIZE];
    char name[COMPOSITION_MAX_PAIRS][COMPOSITION_PAIR_NAME_SIZE];
    for (int pair = 0; job->engine->pair_name && pair < pairs; pair++) {
        int type[2];
        mf_export_model_pair(model, pair, type, name[pair]);
        job->engine->pair_name(model->name[type[0]], model->name[type[1]], called[pair]);
        for (int other = 0; other < pair; other++)
            if (strcmp(called[other], called[pair]) == 0)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: cannot be exported: in %s the pairs %s and %s would "
                                      "have the same name, \"%s\"; rename a type",
                                      model->folder, job->engine->title, name[other], name[pair],
                                      called[pair]);
    }
    return STATUS_OK;
}

/// The folder is empty, or an export wrote it that nobody has changed, unless `force`; other files
/// beside it, as those of the program that has run there, stay.
static enum status open_folder(struct tracked_files *own, const struct export_job *job,
                               bool force) {
    char path[OUTPUT_PATH_SIZE];
    struct stat found;
    snprintf(path, sizeof path, "%.4000s/used.json", job->folder);
    if (stat(path, &found) == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the folder holds a result; give another folder with -o",
                              job->folder);
    TRY(mf_tracked_files_make(own, job->folder, TRACKED_FILES_OF_EXPORT));
    own->force = force;
    if (!own->list.there && !force && mf_tracked_files_has_others(own))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: the folder holds files that are not of an export (" TRACKED_FILES_OF_EXPORT
            "): give another folder with -o; --force replaces those of the "
            "same names",
            job->folder);
    TRY(mf_tracked_files_lock(own));
    return mf_tracked_files_check(own, NULL);
}

static enum status check(const struct export_job *job, bool bands) {
    const struct export_model *model = job->model;
    const struct export_engine *engine = job->engine;
    if (bands && !model->bands)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: --bands: its potential has no errors",
                              model->folder);
    if (model->setup.box.dimensions == 2 && !engine->flat)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: cannot be exported: %s is written for three dimensions",
                              model->folder, engine->title);
    if (model->types > engine->max_types)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: cannot be exported: %s is written for %d types of beads at most",
                              model->folder, engine->title, engine->max_types);
    if (model->molecules && !engine->molecules)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: cannot be exported: what is written for %s is of single beads, "
                              "and there are molecules",
                              model->folder, engine->title);
    if (mf_export_densities_of(model) && !engine->many_body)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: cannot be exported: what is written for %s has no energies of "
                              "local densities (\"many_body\"); LAMMPS has them",
                              model->folder, engine->title);
    TRY(check_pair_names(job));
    return job->projected ? check_friction(job) : STATUS_OK;
}

/// The law that the engine has, or, of engines with s = 1 alone, the nearest power law, which tells
/// what is missing. LAMMPS has one cutoff for both weights of a pair, ESPResSo one exponent.
static void find_powers(struct export_job *job) {
    const struct simulation_setup *setup = &job->model->setup;
    const struct table *across = export_model_across(job->model);
    const bool rising = job->engine->friction == EXPORT_RISING;
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        struct export_power form = {.family = rising           ? EXPORT_RISING
                                              : job->projected ? job->engine->friction
                                                               : EXPORT_POWER};
        if (across && setup->omega && !rising)
            form.cutoff = fmax(table_cutoff(setup->omega, pair), table_cutoff(across, pair));
        job->power[pair] =
            mf_export_power_fit(setup->omega, setup->potential, pair, setup->temperature, &form);
        if (rising)
            form.exponent = job->power[pair].exponent;
        job->across[pair] =
            mf_export_power_fit(across, setup->potential, pair, setup->temperature, &form);
        job->worst_misfit =
            fmax(job->worst_misfit, fmax(job->power[pair].misfit, job->across[pair].misfit));
    }
}

/// What of the friction no law of the engine can stand for; NULL: nothing.
static const char *left_out(const struct export_job *job) {
    if (job->model->remembers)
        return "Friction with memory is left out, and all friction beside it: g(r) is the "
               "result's, the dynamics is not";
    return export_model_across(job->model) && !job->engine->across
               ? "Friction across pairs is left out, and all friction beside it: g(r) is the "
                 "result's, the dynamics is not"
               : NULL;
}

static void print_power(const struct export_job *job, int pair, const struct export_power *p,
                        const char *direction, FILE *stream) {
    char name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    if (!(p->cutoff > 0))
        return;
    mf_export_model_pair(job->model, pair, type, name);
    fprintf(stream,
            "    %s%s: gamma = A^2 = %.6g %s %s/%s^2, s = %.6g, r_c = %.6g %s; misfit of omega "
            "%.2g\n",
            name, direction, export_units_friction(&job->units) * p->amplitude * p->amplitude,
            job->units.energy_name, job->units.time_name, job->units.length_name, p->exponent,
            job->units.length * p->cutoff, job->units.length_name, p->misfit);
}

static void print_friction(const struct export_job *job, FILE *stream) {
    if (left_out(job))
        fprintf(stream, "%s.\n", left_out(job));
    if (job->model->remembers)
        return;
    if (job->model->setup.omega == NULL && export_model_across(job->model) == NULL) {
        fprintf(stream, "The result has no friction weight.\n");
        return;
    }
    fprintf(stream, "The law %s nearest to the friction weight omega:\n\n",
            job->engine->friction == EXPORT_RISING ? "A (1 - (r/r_c)^s)"
                                                   : "A (1 - r/r_c)^s, a power law,");
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        print_power(job, pair, &job->power[pair], "", stream);
        print_power(job, pair, &job->across[pair], ", across pairs", stream);
    }
    fprintf(stream,
            "\nThe misfit is sqrt(sum w (omega - law)^2 / sum w omega^2) with w = r^2 "
            "exp(-phi/k_B T);\nbelow %g the two count as the same friction.\n",
            EXPORT_POWER_BOUND);
}

static void print_number(FILE *stream, const char *name, const struct export_number *number,
                         double factor, const char *unit) {
    if (!isfinite(number->value))
        return;
    fprintf(stream, "    %s %.6g", name, factor * number->value);
    if (isfinite(number->error))
        fprintf(stream, " +- %.2g", factor * number->error);
    fprintf(stream, " %s\n", unit);
}

static const char partial[] =
    "This is the potential alone: the forces that the engine of the fit knew beside it are missing "
    "here, and with them g(r) and pressure are others";

/// What the tables are of, where a part of the potential was known; NULL: all of it was found.
static const char *say_known(const struct export_model *model) {
    if (model->scene.known.curves == 0)
        return model->partial ? partial : NULL;
    return model->partial
               ? "The tables are of the potential that was found and of the known part beside it "
                 "(\"known\" of used.json); what the engine of the fit had besides is missing here"
               : "The tables are of the potential that was found and of the known part beside it "
                 "(\"known\" of used.json)";
}

static void print_readme(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    if (job->engine->versions)
        fprintf(stream, "%s\n\n", job->engine->versions);
    fprintf(stream, "%s, for %s\n\nWritten by mesofit %s from %s. Run it here:\n\n",
            model->title[0] ? model->title : "A result of mesofit", job->engine->title, mf_version,
            model->folder);
    fprintf(stream, "%s\n",
            job->engine->commands_of ? job->engine->commands_of(job) : job->engine->commands);
    mf_export_dynamics_print(job, "", stream);
    fprintf(stream, "\n");
    if (say_known(model))
        fprintf(stream, "%s.\n\n", say_known(model));
    fprintf(stream,
            "Units: %s, %s, %s, %s, %s. Time step %.6g %s; mesofit's own was %.6g %s: %s.\n\n",
            units->length_name, units->time_name, units->energy_name, units->temperature_name,
            units->pressure_name, units->time * job->time_step, units->time_name,
            units->time * model->setup.time_step, units->time_name, job->why_step);
    mf_export_checks_tables(job, stream);
    const bool measured = isfinite(model->temperature.value) || isfinite(model->pressure.value);
    fprintf(stream,
            measured && model->partial
                ? "\nWhat was measured of the result, with the forces that are missing here:\n\n"
            : measured ? "\nWhat mesofit itself measured of the result:\n\n"
                       : "\nThe result was not simulated by mesofit to its end: nothing was "
                         "measured of it.\n");
    print_number(stream, "temperature", &model->temperature, units->temperature,
                 units->temperature_name);
    print_number(stream, "pressure   ", &model->pressure, units->pressure, units->pressure_name);
    fprintf(stream, "\n");
    print_friction(job, stream);
    if (job->projected)
        mf_export_dynamics_explain(job, stream);
    fprintf(stream, "\n");
    job->engine->explain(job, stream);
    fprintf(stream, "%s\n\nThe start is %s.\n", job->engine->verified,
            model->equilibrated ? "where the result's own simulation ended"
                                : "that of the scene, which must be equilibrated first");
}

static void print_result(const struct export_job *job, struct progress *to) {
    const struct export_error *error = &job->grids.error;
    if (job->engine->versions)
        mf_progress_print(to, "%s", job->engine->versions);
    if (job->model->warning[0])
        mf_progress_print(to, "mesofit: warning: %s", job->model->warning);
    if (say_known(job->model))
        mf_progress_print(to, "%s%s", job->model->partial ? "mesofit: warning: " : "",
                          say_known(job->model));
    mf_progress_print(to,
                      "%zu rows; as %s reads them within %.2g k_B T and %.2g of the largest force "
                      "from r = %.4g %s on",
                      job->grids.grid[0][0].rows, job->engine->title, error->phi, error->force,
                      job->units.length * error->from, job->units.length_name);
    mf_progress_print(to, "time step %.6g %s; mesofit's own was %.6g %s: %s",
                      job->units.time * job->time_step, job->units.time_name,
                      job->units.time * job->model->setup.time_step, job->units.time_name,
                      job->why_step);
    if (left_out(job))
        mf_progress_print(to, "mesofit: warning: %.160s: %s", job->model->folder, left_out(job));
    mf_export_dynamics_tell(job, to);
    mf_progress_print(to, "%s: see README", job->folder);
}

static enum status write_files(struct export_job *job) {
    TRY(mf_export_file(job, "README", print_readme));
    if (job->projected)
        TRY(mf_export_file(job, "projection.tsv", mf_export_dynamics_escapes));
    return job->engine->write(job);
}

/// What an earlier export left, and this one has not replaced, goes: tables of types that are gone.
static enum status write_folder(struct export_job *job, struct tracked_files *own) {
    TRY(mf_tracked_files_begin(own, 0));
    TRY(write_files(job));
    return mf_tracked_files_remove_earlier(own);
}

/// Share by which a temperature, or the variance of a bond, may be off.
static const double allowed = 0.003;

/// Other engines make the variance of a bond too large by (Ω Δt)²/4, and ours does not.
static double step_of_bonds(const struct export_model *model) {
    double lightest = model->mass[0];
    if (model->molecules == NULL)
        return INFINITY;
    for (int type = 1; type < model->types; type++)
        lightest = fmin(lightest, model->mass[type]);
    return 2 * sqrt(allowed * lightest /
                    mf_hybrid_step_fastest(model->molecules, model->setup.temperature));
}

double mf_export_safe_step(const struct export_model *model, const char **why) {
    const struct export_number *found = &model->configurational;
    const double wrong = (fabs(found->value - model->setup.temperature) - 2 * found->error) /
                         model->setup.temperature; // NaN: not known
    const double step = model->setup.time_step, of_bonds = step_of_bonds(model);
    const double right = wrong > allowed ? step * sqrt(allowed / wrong) : step;
    *why = of_bonds < right  ? "shorter for the stiffest bonds, angles and dihedrals"
           : wrong > allowed ? "shorter, as its configurational temperature is off"
                             : "the same, as no temperature shows that it is long";
    return fmin(right, of_bonds);
}

static enum status run(struct export_job *job, const struct export_request *request) {
    enum status status = STATUS_OK;
    const struct export_model *model = job->model;
    struct tracked_files own = {.open = false};
    TRY(check(job, request->bands));
    job->units = mf_export_units(job->engine->system, &model->scene.units, job->engine->physical);
    job->time_step = mf_export_safe_step(model, &job->why_step);
    TRY(mf_export_grids_make(&job->grids, job->engine->interpolation, model, request->bands,
                             job->engine->one_cutoff ? model->setup.potential->cutoff : 0));
    CHECK(mf_export_bonded_make(&job->bonded, model, job->engine->has_law));
    CHECK(mf_export_densities_make(&job->densities, model));
    if (job->engine->check)
        CHECK(job->engine->check(job));
    CHECK(open_folder(&own, job, request->force));
    find_powers(job);
    CHECK(mf_export_dynamics_find(job, request));
    CHECK(write_folder(job, &own));
    print_result(job, request->progress);
done:
    mf_tracked_files_close(&own);
    mf_export_grids_clear(&job->grids);
    mf_export_densities_clear(&job->densities);
    mf_export_bonded_clear(&job->bonded);
    return status;
}

/// The title stands in comments, which a line ends.
static void join_lines(char *title) {
    for (; *title; title++)
        *title = (char)(iscntrl((unsigned char)*title) ? ' ' : *title);
}

enum status mf_export_run(const struct export_request *request) {
    enum status status = STATUS_OK;
    struct export_model *model = NULL;
    struct export_job *job = NULL;
    const struct export_engine *engine;
    TRY(mf_export_find(request->engine, &engine));
    NEW_ARRAY(model, 1);
    NEW_ARRAY(job, 1);
    CHECK(mf_export_model_read(model, request->from));
    model->setup.cancel = request->stop;
    join_lines(model->title);
    *job = (struct export_job){.engine = engine,
                               .model = model,
                               .folder = request->to ? request->to : engine->name,
                               .projected = request->project};
    CHECK(run(job, request));
done:
    if (model)
        mf_export_model_clear(model);
    mf_memory_free(model);
    mf_memory_free(job);
    return status;
}

enum status mf_export_file(const struct export_job *job, const char *name, export_print *print) {
    struct output output;
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.3800s/%.200s", job->folder, name);
    TRY(mf_output_open(&output, path));
    print(job, output.stream);
    return mf_output_commit(&output);
}

const char *mf_export_curve_name(enum export_curve curve) {
    return curve == EXPORT_FITTED ? "" : curve == EXPORT_LOWER ? "_lower" : "_upper";
}

bool mf_export_is_power(const struct export_job *job) {
    const struct table *across = export_model_across(job->model);
    return (job->model->setup.omega || across) && (across == NULL || job->engine->across) &&
           (job->projected || job->worst_misfit < EXPORT_POWER_BOUND);
}

bool mf_export_is_linear(const struct export_job *job) {
    for (int pair = 0; pair < job->grids.pairs; pair++)
        if ((job->power[pair].exponent != 1 && job->power[pair].amplitude > 0) ||
            (job->across[pair].exponent != 1 && job->across[pair].amplitude > 0))
            return false;
    return mf_export_is_power(job);
}

double mf_export_place(const struct export_model *model, int axis, size_t particle) {
    const double length = model->setup.box.length[axis];
    const double x = model->position[axis][particle];
    const double inside = x - length * floor(x / length);
    return inside < length ? inside : 0;
}

int mf_export_type(const struct export_model *model, size_t particle) {
    return model->types > 1 ? mf_composition_type(&model->setup.composition, (uint32_t)particle)
                            : 0;
}

size_t mf_export_count(const struct export_model *model, int type) {
    return model->types > 1 ? (size_t)model->setup.composition.count[type] : model->count;
}
