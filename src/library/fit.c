// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesofit/fit.h"

#include "base/memory.h"
#include "defaults/fit_base.h"
#include "defaults/fit_check.h"
#include "library/fit.h"
#include "library/fit_text.h"
#include "library/guard.h"
#include "library/memory_files.h"
#include "library/scene_text.h"

#include <math.h>

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
    TRY(mf_scene_text_add_own(own, scene));
    fit->file.problem.scene.potential = scene->setup.potential;
    fit->file.problem.scene.omega = scene->setup.omega;
    return STATUS_OK;
}

/// Make a fit of a run file, or of an in-memory file.
static enum status open_run(struct mesofit_fit **made, const char *file,
                            const struct mesofit_scene *own, int threads,
                            mesofit_fit_progress *progress, void *context) {
    enum status status = STATUS_OK;
    struct mesofit_fit *fit = NULL;
    const struct run_options options = {.threads = threads > 0 ? threads : 1};
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
    CHECK(mf_fit_check(&fit->file, file));
    CHECK(mf_fit_base_find(&fit->file));
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
    mf_guard_return(open_run(&fit, file, NULL, threads, progress, context));
    return fit;
}

struct mesofit_fit *mesofit_fit_parse(const char *text, const struct mesofit_table *tables,
                                      size_t table_count, int threads,
                                      mesofit_fit_progress *progress, void *context) {
    struct mesofit_fit *fit = NULL;
    struct memory_files memory_files;
    mf_guard_enter();
    if (mf_memory_files_begin_one(&memory_files, in_memory, text, tables, table_count) ==
        STATUS_OK) {
        if (open_run(&fit, in_memory, NULL, threads, progress, context) != STATUS_OK)
            fit = NULL;
        mf_memory_files_end(&memory_files);
    }
    mf_guard_leave();
    return fit;
}

struct mesofit_fit *mesofit_fit_create(const struct mesofit_fit_options *options) {
    struct mesofit_fit *fit = NULL;
    struct fit_text run;
    struct memory_files memory_files;
    mf_guard_enter();
    if (mf_fit_text_write(&run, options) == STATUS_OK &&
        mf_memory_files_begin_one(&memory_files, in_memory, run.text, run.table, run.tables) ==
            STATUS_OK) {
        if (open_run(&fit, in_memory, &options->scene, options->scene.threads, options->progress,
                     options->context) != STATUS_OK)
            fit = NULL;
        mf_memory_files_end(&memory_files);
    }
    mf_fit_text_clear(&run);
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
    fit->iterated = fit->iterated || status == STATUS_OK;
    if (status == STATUS_OK && state)
        describe(fit, state);
    return mf_guard_return(status);
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
    return mf_guard_return(verify(fit, verification));
}
