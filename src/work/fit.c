// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/ranks.h"
#include "base/visible.h"
#include "defaults/fit_states.h"
#include "io/checkpoint.h"
#include "report/fit_closing.h"
#include "report/fit_output.h"
#include "report/fit_report.h"
#include "report/fit_verification.h"
#include "report/history.h"
#include "report/progress.h"
#include "work/fit_checkpoint.h"
#include "work/fit_tasks.h"
#include "work/fit_print.h"
#include "work/fit_verify.h"

#include <math.h>
#include <string.h>

struct run {
    struct run_folder folder;
    struct progress progress;
    struct fit_file fit;
    struct unknowns unknowns;
    void *state;
    bool created;
    struct history history;
    struct fit_checkpoint checkpoint;
    uint64_t digest; ///< of used.json
    struct checkpoint_pace pace;
    double seconds_before;     ///< of a run before a restart
    double processor_origin;   ///< processor time of the process, less what the fit has had
    struct spent spent_origin; ///< the same of what it went to
    double *curve[UNKNOWNS], *curve_error[UNKNOWNS]; ///< shape [mf_unknowns_points]
    double *curve_flat[UNKNOWNS];                    ///< shape [INVERSE_FLAT, mf_unknowns_points]
    double *without_ramp;                            ///< shape [mf_unknowns_points of Φ]
    struct kept {
        struct inverse_step step; ///< without its curves, which stand above
        struct history_time time;
        char formula[FIELD_TEXT_SIZE]; ///< or ""
    } kept;
    struct fit_dampings changes;
};

static struct history_time time_of(const struct run *run) {
    return (struct history_time){run->seconds_before + mf_progress_seconds(&run->progress),
                                 clock_process_seconds() - run->processor_origin,
                                 mf_spent_less(mf_spent(), run->spent_origin)};
}

static enum status save(struct run *run) {
    char path[OUTPUT_PATH_SIZE];
    if (!ranks_lead())
        return STATUS_OK;
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    const double begun = mf_progress_seconds(&run->progress);
    run->kept.time = time_of(run);
    const enum status status = mf_fit_checkpoint_save(&run->checkpoint, path, run->digest);
    mf_checkpoint_pace_saved(&run->pace, begun, mf_progress_seconds(&run->progress));
    return status;
}

static enum status load(struct run *run) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    if (mf_checkpoint_is_of_others(path, run->digest))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: the run's settings have changed since it was written, and --resume goes on with "
            "the same; for more iterations, or others, begin in another folder (-o) with the pair "
            "potentials of this one, as \"start\" of unknowns.potential ({\"law\": \"table\", "
            "\"file\": the full path of %s/potential.tsv}); --force begins anew in this one",
            path, run->folder.path);
    TRY(mf_fit_checkpoint_load(&run->checkpoint, path, run->digest));
    run->seconds_before = run->kept.time.seconds;
    run->processor_origin = clock_process_seconds() - run->kept.time.processor;
    run->spent_origin = mf_spent_less(mf_spent(), run->kept.time.spent);
    return STATUS_OK;
}

/// Keep all settings, and take their digest.
static enum status keep_settings(struct run *run) {
    struct json_writer *writer = mf_json_writer_create();
    mf_fit_file_write(&run->fit, writer);
    const enum status status = mf_run_folder_keep_settings(&run->folder, writer, &run->digest);
    mf_json_writer_free(writer);
    mf_fit_file_digest(&run->fit, &run->digest);
    return status;
}

/// What a checkpoint keeps.
static void list_state(struct run *run) {
    struct fit_checkpoint *to = &run->checkpoint;
    *to = (struct fit_checkpoint){
        .method = run->fit.method, .state = run->state, .history = &run->history};
    mf_fit_checkpoint_add(to, &run->kept, sizeof run->kept);
    mf_fit_checkpoint_add(to, &run->changes, sizeof run->changes);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t bytes = mf_unknowns_points(&run->unknowns, kind) * sizeof(double);
        mf_fit_checkpoint_add(to, run->curve[kind], bytes);
        mf_fit_checkpoint_add(to, run->curve_error[kind], bytes);
        mf_fit_checkpoint_add(to, run->curve_flat[kind], INVERSE_FLAT * bytes);
    }
    mf_fit_checkpoint_add(to, run->without_ramp,
                          mf_unknowns_points(&run->unknowns, UNKNOWN_POTENTIAL) * sizeof(double));
}

static enum status create(struct run *run) {
    const struct fit_file *fit = &run->fit;
    size_t points[UNKNOWNS];
    TRY(mf_unknowns_init(&run->unknowns, &fit->problem));
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        points[kind] = mf_unknowns_points(&run->unknowns, kind);
        if (points[kind] == 0)
            continue;
        TRY_ARRAY(run->curve[kind], points[kind]);
        TRY_ARRAY(run->curve_error[kind], points[kind]);
        TRY_ARRAY(run->curve_flat[kind], INVERSE_FLAT * points[kind]);
    }
    if (points[UNKNOWN_POTENTIAL] > 0)
        TRY_ARRAY(run->without_ramp, points[UNKNOWN_POTENTIAL]);
    mf_history_init(&run->history, fit->method, points, &fit->problem);
    TRY((run->state = mf_memory_zeroed(1, fit->method->state_size)) ? STATUS_OK : STATUS_NO_MEMORY);
    run->created = true;
    TRY(fit->method->create(run->state, fit->method, &fit->problem, fit->method_parameters));
    list_state(run);
    return mf_fit_checkpoint_begin(&run->checkpoint);
}

/// Read what the run needs, and begin its state. On a cluster all ranks read the same files.
static enum status read_and_create(struct run *run, const char *file,
                                   const struct run_options *options) {
    TRY(mf_fit_file_read(&run->fit, file, options));
    TRY(mf_run_folder_open(&run->folder, RUN_FIT, file, &run->fit.inputs, options));
    TRY(mf_fit_verify_folders(&run->fit, &run->folder));
    TRY(mf_fit_states_normalise(&run->fit));
    TRY(mf_fit_engine_open(&run->fit, options->engine, run->folder.path, options->resume));
    const enum status status = create(run);
    if (status != STATUS_OK)
        return mf_status_prefix(mf_units_convert_message(&run->fit.scene.units, status), "%s",
                                file);
    return mf_fit_reserve_curves(&run->fit, &run->unknowns, &run->folder);
}

static enum status begin_folder(struct run *run, bool resume) {
    TRY(keep_settings(run));
    if (resume) {
        TRY(load(run));
        return mf_run_folder_resume(&run->folder, run->digest);
    }
    TRY(mf_run_folder_begin(&run->folder, run->digest));
    // Saved now, so that a run interrupted in its first iteration can be resumed like any other.
    TRY(save(run));
    return mf_run_folder_take_over(&run->folder);
}

static double *find_damping(const struct run *run) {
    return run->fit.method->damping ? run->fit.method->damping(run->state) : NULL;
}

static enum status prepare(struct run *run, const char *file, const struct run_options *options) {
    TRY(mf_ranks_check(read_and_create(run, file, options), mf_fit_ranks_digest(&run->fit)));
    TRY(mf_ranks_check(ranks_lead() ? begin_folder(run, options->resume) : STATUS_OK, 0));
    if (options->resume)
        TRY(mf_fit_checkpoint_share(&run->checkpoint));
    mf_progress_report_run(
        &run->progress,
        &(struct watcher_run){RUN_FIT, run->folder.path, .units = &run->fit.scene.units,
                              .unknowns = &run->unknowns, .targets = &run->fit.problem.targets,
                              .damping = find_damping(run)});
    return mf_fit_engine_print_targets(&run->progress, &run->fit, options->resume);
}

static void save_now_and_then(struct run *run) {
    if (mf_progress_seconds(&run->progress) > run->pace.next && save(run) != STATUS_OK)
        mf_progress_print(&run->progress, "mesofit: warning: %s", mf_status_message());
}

/// Progress inside an iteration, and a checkpoint now and then.
static void report(void *context, const struct inverse_progress *p) {
    struct run *run = context;
    char text[FIT_TELL_SIZE];
    mf_fit_print_iteration(p, &run->fit.scene.units, text);
    mf_progress_report_iteration(&run->progress, p, text);
    save_now_and_then(run);
}

/// The verification has a progress of its own.
struct verifying {
    struct run *run;
    struct progress progress;
};

static void report_verification(void *context, const struct inverse_progress *p) {
    struct verifying *verifying = context;
    mf_progress_report(&verifying->progress, p->done, p->total, "samples", "verification");
    save_now_and_then(verifying->run);
}

/// What the tables and the summary say at this point.
static struct fit_result result_so_far(const struct run *run, enum status status) {
    struct fit_result result = {.status = status,
                                .step = run->kept.step,
                                .seconds = mf_history_seconds(&run->history),
                                .first_error = mf_history_first_error(&run->history),
                                .changes = &run->changes,
                                .reason = run->kept.step.reason};
    result.step.formula = run->kept.formula;
    result.step.without_ramp = run->without_ramp;
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        result.step.curve[kind] = run->curve[kind];
        result.step.curve_error[kind] = run->curve_error[kind];
        result.step.curve_flat[kind] = run->curve_flat[kind];
        result.first[kind] = run->history.iterations > 0 ? run->history.curve[kind] : NULL;
    }
    return result;
}

/// The curves of an iteration. What is set, not fitted, has no error: core and cutoff.
static void keep_curves(struct run *run, const struct inverse_step *step) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t points = mf_unknowns_points(&run->unknowns, kind);
        for (size_t k = 0; k < points; k++) {
            const bool known = step->curve_error[kind] && mf_unknowns_fits(&run->unknowns, kind, k);
            run->curve[kind][k] = step->curve[kind][k];
            run->curve_error[kind][k] = known ? step->curve_error[kind][k] : NAN;
        }
        for (size_t k = 0; k < INVERSE_FLAT * points; k++)
            run->curve_flat[kind][k] = step->curve_flat[kind] ? step->curve_flat[kind][k] : NAN;
    }
    const double *without = step->without_ramp, *error = run->curve_error[UNKNOWN_POTENTIAL];
    for (size_t k = 0; k < mf_unknowns_points(&run->unknowns, UNKNOWN_POTENTIAL); k++)
        run->without_ramp[k] = without && isfinite(error[k]) ? without[k] : NAN;
}

/// An iteration as it is kept and told. What it borrows has no meaning in a checkpoint.
static void keep(struct run *run, const struct inverse_step *step) {
    struct inverse_step *kept = &run->kept.step;
    keep_curves(run, step);
    *kept = *step;
    kept->without_ramp = NULL;
    kept->formula = kept->begins = NULL;
    kept->response = (struct inverse_response){0};
    for (int kind = 0; kind < UNKNOWNS; kind++)
        kept->curve[kind] = kept->curve_error[kind] = kept->curve_flat[kind] = NULL;
    run->kept.time = time_of(run);
    mf_units_convert_text(&run->fit.scene.units, kept->reason, sizeof kept->reason);
    mf_fit_report_formula(&run->fit, step->formula, run->kept.formula);
}

static void own_file(void *context, const char *name, char *path) {
    mf_run_folder_file(context, name, path);
}

/// Remember an iteration and put it on disk.
static enum status record(struct run *run, const struct inverse_step *step) {
    keep(run, step);
    TRY(mf_history_add(&run->history, step, run->kept.time));
    TRY(mf_history_write(&run->history, run->fit.method, &run->unknowns, &run->fit.scene.units,
                         &run->folder));
    const struct fit_result result = result_so_far(run, STATUS_UNCONVERGED);
    TRY(mf_fit_output_curves(&run->fit, &run->unknowns, &result, &run->folder));
    const struct inverse_folder own = {own_file, &run->folder, &run->fit.scene.units};
    if (run->fit.method->write)
        TRY(run->fit.method->write(run->state, &own));
    TRY(mf_fit_tasks_write(&run->folder, mf_progress_seconds(&run->progress)));
    mf_progress_report_written(&run->progress);
    mf_fit_print_step(step, run->kept.time.seconds, &run->progress);
    if (step->begins)
        mf_progress_print(&run->progress, "%s", step->begins);
    TRY(mf_fit_checkpoint_begin(&run->checkpoint));
    return save(run);
}

/// Between two iterations, so that one that was interrupted begins again with what it had.
static enum status take_change(struct run *run) {
    if (!mf_fit_damping_ask(&run->changes, run->history.iterations, find_damping(run),
                            &run->progress))
        return STATUS_OK;
    TRY(mf_fit_checkpoint_begin(&run->checkpoint));
    return save(run);
}

static enum status iterate(struct run *run) {
    const struct inverse_method *method = run->fit.method;
    if (run->kept.step.finished)
        mf_progress_print(&run->progress,
                          "the fit is finished: only its result is verified and written");
    while (!run->kept.step.finished) {
        struct inverse_step step;
        TRY(take_change(run));
        mf_task_log_use(&run->checkpoint.tasks);
        const enum status status =
            method->iterate(run->state, &step, &(struct inverse_listener){report, run});
        mf_task_log_use(NULL);
        TRY(status);
        TRY(mf_ranks_check(record(run, &step),
                           mf_fit_ranks_digest_curves(&run->unknowns, run->curve)));
    }
    return STATUS_OK;
}

/// A result whose verification blows up leaves a summary that says so.
static enum status write_unstable(struct run *run) {
    struct fit_result result = result_so_far(run, STATUS_UNSTABLE);
    char reason[1024];
    if (isfinite(run->kept.step.error))
        mf_status_prefix(STATUS_UNSTABLE, "the verification of what was fitted");
    else
        mf_status_prefix(STATUS_UNSTABLE, "the verification of what was fitted (no result%s%s)",
                         run->kept.step.reason[0] ? ": " : "", run->kept.step.reason);
    snprintf(reason, sizeof reason, "%s", mf_status_message());
    result.reason = reason;
    TRY(mf_fit_output_summary(&run->fit, &run->unknowns, &result, &run->folder));
    mf_run_folder_draw(&run->folder);
    return mf_status_fail(STATUS_UNSTABLE, "%s", reason);
}

/// The verification has the last word.
static void doubt(struct run *run, struct verification *verification) {
    struct inverse_step *step = &run->kept.step;
    if (!step->converged && !step->exhausted)
        return;
    if (mf_fit_verify_any_contradicts(&run->fit, verification, step, step->reason))
        step->converged = step->exhausted = false;
    else if (step->converged &&
             (mf_fit_closing_is_noise(
                  &run->unknowns, &run->fit.problem.targets, (const double *const *)run->curve,
                  (const double *const *)run->curve_error, &run->fit.scene.units, step->reason) ||
              mf_fit_closing_is_missed(&run->fit, verification, step->noise, step->reason))) {
        step->converged = false;
        step->exhausted = true;
    }
}

/// The independent verification of the result, and everything that rests on it.
static enum status verify_and_write(struct run *run) {
    struct verification *verification = NULL;
    struct verifying verifying = {run,
                                  mf_progress_begin(run->progress.quiet, run->progress.watcher)};
    verifying.progress.folder = run->progress.folder;
    verifying.progress.may_end_early = run->fit.verification.end_early == 1;
    const struct inverse_listener listener = {report_verification, &verifying};
    const size_t states = mf_fit_states_count(&run->fit);
    enum status status = STATUS_OK;
    NEW_ARRAY(verification, states);
    mf_task_log_use(&run->checkpoint.tasks);
    const bool agreed = run->kept.step.converged && run->fit.method->kind == INVERSE_INVERSION;
    status = mf_fit_verify_states(&run->fit, run->curve, run->kept.step.number,
                                  agreed ? &run->kept.step : NULL, &run->progress, &listener,
                                  verification);
    mf_task_log_use(NULL);
    CHECK(status == STATUS_UNSTABLE ? write_unstable(run) : status);
    doubt(run, verification);
    const bool accepted = run->kept.step.converged || run->kept.step.exhausted;
    struct fit_result result = result_so_far(run, accepted ? STATUS_OK : STATUS_UNCONVERGED);
    result.verification = verification;
    CHECK(mf_fit_tasks_write(&run->folder, mf_progress_seconds(&run->progress)));
    for (size_t s = 0; s < states; s++)
        CHECK(mf_fit_verify_write(&run->fit, s, &verification[s], &run->folder));
    CHECK(mf_history_close(&run->history, time_of(run).spent, &run->folder));
    // Who is killed while they are drawn leaves a fit that is to be resumed, which clears up.
    if (mf_run_folder_draw(&run->folder))
        CHECK(mf_history_close(&run->history, time_of(run).spent, &run->folder));
    CHECK(mf_fit_output_summary(&run->fit, &run->unknowns, &result, &run->folder));
    mf_fit_report_print(&run->progress, &run->fit, &run->unknowns, &result);
    mf_fit_print_warnings(&run->progress, &run->fit, verification);
    mf_fit_closing_print(&run->progress, &run->fit, &run->unknowns, &result, run->folder.path);
    status = result.status;
    if (status == STATUS_UNCONVERGED)
        mf_fit_print_unconverged(run->folder.path, &run->kept.step, run->kept.step.reason);
done:
    for (size_t s = 0; verification && s < states; s++)
        mf_verify_clear(&verification[s]);
    mf_memory_free(verification);
    return status;
}

/// A fit that is stopped leaves what it has done, and a summary that says so.
static enum status write_interrupted(struct run *run, const struct engine_door *door) {
    TRY(save(run));
    const struct fit_result result = result_so_far(run, STATUS_INTERRUPTED);
    if (run->history.iterations > 0) {
        TRY(mf_fit_output_summary(&run->fit, &run->unknowns, &result, &run->folder));
        mf_run_folder_draw(&run->folder);
    }
    if (mf_fit_engine_waits(&run->fit, door))
        return STATUS_INTERRUPTED;
    return mf_status_fail(
        STATUS_INTERRUPTED,
        "interrupted after %llu iterations; what there is, is in %s; continue with --resume",
        (unsigned long long)run->history.iterations, run->folder.path);
}

enum status mf_fit_run(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    run->pace.interval = run->pace.next = 30; // seconds between checkpoints in an iteration
    run->progress = mf_progress_begin(options->quiet, options->watcher);
    run->processor_origin = clock_process_seconds();
    run->spent_origin = mf_spent();
    run->progress.may_end_early = true; // it may converge before the last iteration
    CHECK(prepare(run, file, options));
    status = mf_units_convert_message(&run->fit.scene.units, iterate(run));
    if (status == STATUS_OK)
        status = verify_and_write(run);
    if (status != STATUS_OK && run->fit.problem.engine)
        (void)save(run);
    if (status == STATUS_INTERRUPTED)
        status = write_interrupted(run, options->engine);
done:
    if (run) {
        if (run->created)
            run->fit.method->destroy(run->state);
        mf_memory_free(run->state);
        mf_history_clear(&run->history);
        mf_fit_engine_close(&run->fit, options->engine);
        mf_unknowns_clear(&run->unknowns);
        for (int kind = 0; kind < UNKNOWNS; kind++) {
            mf_memory_free(run->curve[kind]);
            mf_memory_free(run->curve_error[kind]);
            mf_memory_free(run->curve_flat[kind]);
        }
        mf_memory_free(run->without_ramp);
        mf_fit_checkpoint_clear(&run->checkpoint);
        mf_fit_file_clear(&run->fit);
        mf_progress_end(&run->progress);
        mf_run_folder_close(&run->folder);
    }
    mf_memory_free(run);
    return mf_ranks_check(status, 0);
}
