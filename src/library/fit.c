// SPDX-License-Identifier: GPL-3.0-or-later

#include "defaults/fit_file.h"
#include "problem/parametrisation.h"
#include "base/memory.h"
#include "base/status.h"
#include "defaults/fit_unknowns.h"
#include "library/guard.h"
#include "library/memory_files.h"
#include "library/scene_words.h"
#include "matching/population.h"
#include "mesofit/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stdatomic.h>

struct mesofit_fit {
    struct fit_file file;
    struct unknowns unknowns;
    struct parametrisation parametrisation; ///< of a method of the kind INVERSE_MATCHING
    void *state;                            ///< of file.method
    struct inverse_step step;
    bool iterated;
    atomic_bool cancel;
    mesofit_fit_progress *progress;
    void *context;
};

// What the caller says, as words of a run file with tables in memory ------------------------------

enum { FIT_TABLES = 3, FIT_WORDS = SCENE_WORDS + 11 };

struct fit_words {
    struct json_word word[FIT_WORDS];
    size_t words;
    struct mesofit_table table[FIT_TABLES];
    size_t tables;
    double *values[FIT_TABLES]; ///< of the tables
};

struct mesofit_fit_options mesofit_fit_options_default(void) {
    return (struct mesofit_fit_options){
        .scene = mesofit_scene_default(), .method = "imc", .find_potential = 1};
}

/// A new table, whose values are zero.
static enum status add_table(struct fit_words *run, const char *name, size_t rows, size_t columns,
                             double **values) {
    enum status status = STATUS_OK;
    NEW_ARRAY(*values, rows * columns);
    run->values[run->tables] = *values;
    run->table[run->tables++] = (struct mesofit_table){name, rows, columns, *values};
done:
    return status;
}

static enum status add_rdf(struct fit_words *run, const struct mesofit_fit_options *options) {
    const size_t columns = options->rdf.error ? 3 : 2;
    double *values;
    if (options->rdf.r == NULL || options->rdf.g == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "rdf: r and g are required");
    TRY(add_table(run, "rdf", options->rdf.count, columns, &values));
    for (size_t k = 0; k < options->rdf.count; k++) {
        values[k * columns] = options->rdf.r[k];
        values[k * columns + 1] = options->rdf.g[k];
        if (options->rdf.error)
            values[k * columns + 2] = options->rdf.error[k];
    }
    return STATUS_OK;
}

/// Times, then a column for each bin.
static enum status add_matrix(struct fit_words *run, const char *name,
                              const struct mesofit_fit_options *options, const double *from) {
    const size_t times = options->etd.times, bins = options->etd.bins, columns = bins + 1;
    double *values;
    TRY(add_table(run, name, times, columns, &values));
    for (size_t t = 0; t < times; t++) {
        values[t * columns] = (double)t * options->etd.interval;
        memcpy(values + t * columns + 1, from + t * bins, bins * sizeof *values);
    }
    return STATUS_OK;
}

static enum status add_tables(struct fit_words *run, const struct mesofit_fit_options *options) {
    if (options->rdf.count > 0)
        TRY(add_rdf(run, options));
    if (options->etd.times == 0)
        return STATUS_OK;
    if (options->etd.survival == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "etd: survival is required");
    TRY(add_matrix(run, "etd", options, options->etd.survival));
    return options->etd.error ? add_matrix(run, "etd_error", options, options->etd.error)
                              : STATUS_OK;
}

static void add(struct fit_words *run, const struct json_word *word) {
    run->word[run->words++] = *word;
}

static void add_text(struct fit_words *run, const char *object, const char *key, const char *text) {
    add(run, &(struct json_word){.object = object, .key = key, .text = text});
}

static void add_json(struct fit_words *run, const char *object, const char *key, const char *json) {
    add(run, &(struct json_word){.object = object, .key = key, .json = json ? json : "{}"});
}

static void add_target(struct fit_words *run, const struct mesofit_fit_options *options) {
    static const char etd[] = "target.etd";
    add_json(run, NULL, "target", NULL);
    if (options->rdf.count > 0)
        add_text(run, "target.rdf", "file", "rdf");
    if (options->etd.times == 0)
        return;
    add_text(run, etd, "file", "etd");
    if (options->etd.error)
        add_text(run, etd, "error_file", "etd_error");
    add(run,
        &(struct json_word){.object = etd, .key = "r_minimum", .value = options->etd.r_minimum});
    add(run,
        &(struct json_word){.object = etd, .key = "r_maximum", .value = options->etd.r_maximum});
}

static enum status find_words(struct fit_words *run, const struct mesofit_fit_options *options) {
    *run = (struct fit_words){0};
    TRY(add_tables(run, options));
    run->words = mf_scene_words(&options->scene, true, run->word);
    add_target(run, options);
    add_json(run, NULL, "unknowns", NULL);
    if (options->find_potential)
        add_json(run, "unknowns", "potential", options->potential);
    if (options->find_friction)
        add_json(run, "unknowns", "omega", options->friction);
    add_json(run, NULL, "method", options->settings);
    add_text(run, "method", "name", options->method ? options->method : "");
    return STATUS_OK;
}

static void clear(struct fit_words *run) {
    for (size_t k = 0; k < run->tables; k++)
        mf_memory_free(run->values[k]);
    *run = (struct fit_words){0};
}

// Fits --------------------------------------------------------------------------------------------

/// Name of a text that is no file, in messages.
static const char in_memory[] = "run";

static void report(void *context, const struct inverse_progress *p) {
    struct mesofit_fit *fit = context;
    if (fit->progress && fit->progress(fit->context, p->iteration, p->done, p->total) != 0)
        atomic_store(&fit->cancel, true);
}

static enum status begin(struct mesofit_fit *fit) {
    enum status status = STATUS_OK;
    const struct inverse_method *method = fit->file.method;
    TRY(mf_target_files_normalise(&fit->file.files, &fit->file.scene.setup.box,
                                  scene_has_molecules(&fit->file.scene.molecules)));
    fit->file.problem.scene.cancel = &fit->cancel;
    TRY(mf_unknowns_init(&fit->unknowns, &fit->file.problem));
    if (method->kind == INVERSE_MATCHING)
        TRY(mf_parametrisation_init(&fit->parametrisation, &fit->file.problem));
    CHECK((fit->state = mf_memory_zeroed(1, method->state_size)) ? STATUS_OK : STATUS_NO_MEMORY);
    status = method->create(fit->state, method, &fit->file.problem, fit->file.method_parameters);
done:
    return status;
}

static enum status add_own_laws(struct mesofit_fit *fit, const struct mesofit_scene *own) {
    struct scene *scene = &fit->file.scene;
    TRY(mf_scene_words_add_own(own, scene));
    fit->file.problem.scene.potential = scene->setup.potential;
    fit->file.problem.scene.omega = scene->setup.omega;
    return STATUS_OK;
}

/// Make a fit of a run file, or of an in-memory file.
static enum status open_run(struct mesofit_fit **made, const char *file,
                            const struct fit_words *words, const struct mesofit_scene *own,
                            int threads, mesofit_fit_progress *progress, void *context) {
    enum status status = STATUS_OK;
    struct mesofit_fit *fit = NULL;
    const struct run_options options = {.threads = threads > 0 ? threads : 1,
                                        .words = words ? words->word : NULL,
                                        .word_count = words ? words->words : 0};
    NEW_ARRAY(fit, 1);
    fit->progress = progress;
    fit->context = context;
    CHECK(mf_fit_file_parse(&fit->file, file, &options));
    if (fit->file.others > 0)
        CHECK(mf_status_fail(STATUS_BAD_INPUT,
                             "%s: states: a fit that is stepped has one; mesofit_run_words, "
                             "mesofit.fit of Python, and the program fit several",
                             file));
    if (own)
        CHECK(add_own_laws(fit, own));
    CHECK(mf_fit_file_check(&fit->file, file));
    CHECK(begin(fit));
done:
    if (status != STATUS_OK) {
        mesofit_fit_free(fit);
        fit = NULL;
    }
    *made = fit;
    return status;
}

struct mesofit_fit *mesofit_fit_open(const char *file, int threads, mesofit_fit_progress *progress,
                                     void *context) {
    struct mesofit_fit *fit = NULL;
    mf_guard_enter();
    mf_guard_return(open_run(&fit, file, NULL, NULL, threads, progress, context));
    return fit;
}

struct mesofit_fit *mesofit_fit_parse(const char *text, const struct mesofit_table *tables,
                                      size_t table_count, int threads,
                                      mesofit_fit_progress *progress, void *context) {
    struct mesofit_fit *fit = NULL;
    struct memory_files memory_files;
    mf_guard_enter();
    if (mf_memory_files_begin(&memory_files, &(const struct mesofit_text){in_memory, text}, 1,
                              tables, table_count) == STATUS_OK) {
        if (open_run(&fit, in_memory, NULL, NULL, threads, progress, context) != STATUS_OK)
            fit = NULL;
        mf_memory_files_end(&memory_files);
    }
    mf_guard_leave();
    return fit;
}

struct mesofit_fit *mesofit_fit_create(const struct mesofit_fit_options *options) {
    struct mesofit_fit *fit = NULL;
    struct fit_words run;
    struct memory_files memory_files;
    mf_guard_enter();
    if (find_words(&run, options) == STATUS_OK &&
        mf_memory_files_begin(&memory_files, &(const struct mesofit_text){in_memory, "{}"}, 1,
                              run.table, run.tables) == STATUS_OK) {
        if (open_run(&fit, in_memory, &run, &options->scene, options->scene.threads,
                     options->progress, options->context) != STATUS_OK)
            fit = NULL;
        mf_memory_files_end(&memory_files);
    }
    clear(&run);
    mf_guard_leave();
    return fit;
}

void mesofit_fit_free(struct mesofit_fit *fit) {
    if (fit == NULL)
        return;
    if (fit->state)
        fit->file.method->destroy(fit->state);
    mf_memory_free(fit->state);
    mf_unknowns_clear(&fit->unknowns);
    mf_parametrisation_clear(&fit->parametrisation);
    mf_fit_file_clear(&fit->file);
    mf_memory_free(fit);
}

static void describe(struct mesofit_fit *fit, struct mesofit_fit_state *state) {
    const struct inverse_step *step = &fit->step;
    *state = (struct mesofit_fit_state){.iteration = step->iteration + 1,
                                        .simulations = step->evaluations,
                                        .engine_steps = step->engine_steps,
                                        .error = step->error,
                                        .noise = step->noise,
                                        .finished = step->finished,
                                        .converged = step->converged,
                                        .reason = step->reason};
}

enum mesofit_status mesofit_fit_iterate(struct mesofit_fit *fit, struct mesofit_fit_state *state) {
    const struct inverse_listener listener = {report, fit};
    enum status status = STATUS_OK;
    mf_guard_enter();
    if (!fit->step.finished)
        status = fit->file.method->iterate(fit->state, &fit->step, &listener);
    mf_units_convert_text(&fit->file.scene.units, fit->step.reason, sizeof fit->step.reason);
    fit->iterated = fit->iterated || status == STATUS_OK;
    if (status == STATUS_OK && state)
        describe(fit, state);
    return mf_guard_return(mf_units_convert_message(&fit->file.scene.units, status));
}

struct mesofit_curve mesofit_fit_curve(const struct mesofit_fit *fit, enum mesofit_law_kind kind) {
    const enum unknown_kind unknown = kind == MESOFIT_POTENTIAL ? UNKNOWN_POTENTIAL : UNKNOWN_OMEGA;
    if (!fit->iterated || fit->step.curve[unknown] == NULL)
        return (struct mesofit_curve){0};
    return (struct mesofit_curve){.count = mf_unknowns_points(&fit->unknowns, unknown),
                                  .r = mf_unknowns_r(&fit->unknowns, unknown),
                                  .value = fit->step.curve[unknown],
                                  .error = fit->step.curve_error[unknown]};
}

// Verification ------------------------------------------------------------------------------------

/// What was not compared is not known.
static double known(const struct target_distance *distance, double value) {
    return distance->count > 0 ? value : NAN;
}

static enum status verify(struct mesofit_fit *fit, struct mesofit_verification *out) {
    enum status status = STATUS_OK;
    const struct inverse_listener listener = {report, fit};
    struct unknowns_laws laws = {0};
    struct verification v = {0};
    double number[INVERSE_MAX_NUMBERS];
    if (!fit->iterated)
        return mf_status_fail(STATUS_BAD_INPUT, "there is nothing to verify before an iteration");
    for (int n = 0; n < INVERSE_MAX_NUMBERS; n++)
        number[n] = fit->step.number[n].value;
    CHECK(mf_unknowns_laws_make(&fit->unknowns, fit->step.curve, number, &laws));
    CHECK(mf_verify(&laws.problem, laws.table[UNKNOWN_POTENTIAL], laws.table[UNKNOWN_OMEGA],
                    &fit->file.verification, &listener, &v));
    const struct target_distance *rdf = &v.distance[TARGET_RDF], *etd = &v.distance[TARGET_ETD];
    *out = (struct mesofit_verification){.rdf_rms = known(rdf, rdf->rms),
                                         .rdf_rms_error = known(rdf, v.distance_error[TARGET_RDF]),
                                         .rdf_noise = known(rdf, rdf->noise),
                                         .etd_rms = known(etd, etd->rms),
                                         .etd_noise = known(etd, etd->noise),
                                         .temperature = v.thermodynamics.temperature,
                                         .pressure = v.thermodynamics.pressure,
                                         .pressure_error = v.thermodynamics.pressure_error};
done:
    mf_verify_clear(&v);
    mf_unknowns_laws_clear(&laws);
    return status;
}

enum mesofit_status mesofit_fit_verify(struct mesofit_fit *fit,
                                       struct mesofit_verification *verification) {
    mf_guard_enter();
    return mf_guard_return(
        mf_units_convert_message(&fit->file.scene.units, verify(fit, verification)));
}

// Single candidates, for optimisers of the caller's own -------------------------------------------

size_t mesofit_fit_coefficients(const struct mesofit_fit *fit) {
    return fit->parametrisation.variables;
}

/// An inversion has no coefficients.
static enum status check_kind(const struct mesofit_fit *fit) {
    const struct inverse_method *method = fit->file.method;
    return method->kind == INVERSE_MATCHING
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "the method \"%s\" does not measure candidates",
                                method->name);
}

static enum status start(const struct mesofit_fit *fit, double *coefficients) {
    TRY(check_kind(fit));
    return mf_parametrisation_start(&fit->parametrisation, coefficients);
}

enum mesofit_status mesofit_fit_start(const struct mesofit_fit *fit, double *coefficients) {
    mf_guard_enter();
    return mf_guard_return(start(fit, coefficients));
}

static enum status evaluate(const struct mesofit_fit *fit, const double *coefficients,
                            uint64_t seed, double *error, double *variance) {
    enum status status = STATUS_OK;
    struct unknowns_laws laws = {0};
    struct evaluate_result result;
    TRY(check_kind(fit));
    const struct population_parameters *population = fit->file.method_parameters;
    CHECK(mf_parametrisation_laws(&fit->parametrisation, coefficients, &laws));
    const struct evaluate_candidate candidate = {.potential = laws.table[UNKNOWN_POTENTIAL],
                                                 .omega = laws.table[UNKNOWN_OMEGA],
                                                 .discard_above = HUGE_VAL,
                                                 .threads = 1,
                                                 .seed = seed};
    status =
        mf_evaluate(&laws.problem, &candidate, &population->evaluate, NULL, NULL, NULL, &result);
    *error = status == STATUS_OK ? result.error : HUGE_VAL;
    if (variance)
        *variance = status == STATUS_OK ? result.variance : 0;
    if (status == STATUS_UNSTABLE)
        status = STATUS_OK;
done:
    mf_unknowns_laws_clear(&laws);
    return status;
}

enum mesofit_status mesofit_fit_evaluate(const struct mesofit_fit *fit, const double *coefficients,
                                         uint64_t seed, double *error, double *variance) {
    mf_guard_enter();
    return mf_guard_return(evaluate(fit, coefficients, seed, error, variance));
}
