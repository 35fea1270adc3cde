// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/fit.h"

#include "base/memory.h"
#include "run/checkpoint.h"
#include "run/explain.h"
#include "run/fit_output.h"
#include "run/history.h"
#include "run/progress.h"

#include <math.h>
#include <string.h>

/// Seconds between checkpoints inside an iteration.
static const double checkpoint_interval = 30;

struct run {
    struct run_folder folder;
    struct progress progress;
    struct fit_file fit;
    struct potential_grid grid;
    void *state;
    bool created;
    struct history history;
    uint64_t digest; ///< of used.json
    double last_checkpoint;
    double seconds_before;   ///< of a run before a restart
    double *phi, *phi_error; ///< shape [grid.points]
    struct standing {
        bool finished, converged;
        uint64_t iterations, evaluations, engine_steps;
        double error, seconds;
    } standing;
};

static double seconds(const struct run *run) {
    return run->seconds_before + progress_seconds(&run->progress);
}

enum { MAX_SPANS = INVERSE_MAX_SPANS + HISTORY_SPANS + 3 };

static size_t run_spans(struct run *run, struct memory_span *spans) {
    const size_t bytes = run->grid.points * sizeof(double);
    size_t n = run->fit.method->spans(run->state, spans);
    n += history_spans(&run->history, spans + n);
    spans[n++] = (struct memory_span){&run->standing, sizeof run->standing};
    spans[n++] = (struct memory_span){run->phi, bytes};
    spans[n++] = (struct memory_span){run->phi_error, bytes};
    return n;
}

static enum status save(struct run *run) {
    struct memory_span spans[MAX_SPANS];
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(&run->folder, "checkpoint.bin", path);
    run->last_checkpoint = progress_seconds(&run->progress);
    run->standing.seconds = seconds(run);
    return checkpoint_save(path, run->digest, spans, run_spans(run, spans));
}

static enum status load(struct run *run) {
    struct memory_span spans[MAX_SPANS];
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(&run->folder, "checkpoint.bin", path);
    TRY(checkpoint_load(path, run->digest, spans, run_spans(run, spans)));
    run->seconds_before = run->standing.seconds;
    return STATUS_OK;
}

/// Write all settings to used.json and take their digest. A run that is resumed leaves used.json
/// alone, since the settings may turn out to be others.
static enum status write_used(struct run *run, bool resume) {
    const struct fit_file *fit = &run->fit;
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(&run->folder, resume ? "used.json.resumed" : "used.json", path);
    TRY(fit_file_write(fit, path));
    TRY(checkpoint_digest(path, &run->digest));
    const size_t bytes = fit->target.bins.count * sizeof(double);
    checkpoint_digest_add(&run->digest, fit->target.g, bytes);
    checkpoint_digest_add(&run->digest, fit->target.error, bytes);
    scene_digest(&fit->scene, &run->digest);
    if (resume)
        remove(path);
    return STATUS_OK;
}

static enum status create(struct run *run) {
    enum status status = STATUS_OK;
    const struct fit_file *fit = &run->fit;
    CHECK(potential_grid_init(&run->grid, &fit->problem));
    NEW_ARRAY(run->phi, run->grid.points);
    NEW_ARRAY(run->phi_error, run->grid.points);
    CHECK(history_init(&run->history, fit->method, run->grid.points,
                       fit->method->most_iterations(fit->method_parameters)));
    CHECK((run->state = memory_zeroed(1, fit->method->state_size)) ? STATUS_OK : STATUS_NO_MEMORY);
    run->created = true;
    CHECK(fit->method->create(run->state, &fit->problem, fit->method_parameters));
done:
    return status;
}

static enum status prepare(struct run *run, const char *file, const struct run_options *options) {
    TRY(fit_file_read(&run->fit, file, options));
    TRY(run_folder_open(&run->folder, file, options));
    TRY(write_used(run, options->resume));
    const enum status status = create(run);
    if (status != STATUS_OK)
        return status_prefix(status, "%s", file);
    // Saved now, so that a run interrupted in its first iteration can be resumed like any other.
    return options->resume ? load(run) : save(run);
}

/// Progress inside an iteration, and a checkpoint now and then.
static void tell(void *context, const struct inverse_progress *p) {
    struct run *run = context;
    char text[160], best[48] = "", mean[96] = "";
    const uint64_t done = p->iteration * p->total + p->done, total = p->iterations * p->total;
    if (isfinite(p->best))
        snprintf(best, sizeof best, "  best %.4f", p->best);
    if (isfinite(p->mean))
        snprintf(mean, sizeof mean, "  mean %.4f  failed %llu", p->mean,
                 (unsigned long long)p->failures);
    snprintf(text, sizeof text, "iteration %u%s%s", p->iteration, best, mean);
    if (run->progress.done_before == 0)
        run->progress.done_before = done - 1;
    progress_tell(&run->progress, done, total, "evaluations", text);
    if (run->fit.method->keeps_parts &&
        progress_seconds(&run->progress) - run->last_checkpoint > checkpoint_interval &&
        save(run) != STATUS_OK)
        progress_say(&run->progress, "mesofit: warning: %s", status_message());
}

static void tell_verification(void *context, const struct inverse_progress *p) {
    progress_tell(context, p->done, p->total, "simulations", "verification");
}

/// What the tables and the summary say at this point.
static struct fit_result result_so_far(const struct run *run, enum status status) {
    const struct standing *s = &run->standing;
    return (struct fit_result){.status = status,
                               .iterations = s->iterations,
                               .evaluations = s->evaluations,
                               .engine_steps = s->engine_steps,
                               .seconds = s->seconds,
                               .phi = run->phi,
                               .phi_error = run->phi_error};
}

/// Remember an iteration and put it on disk.
static enum status record(struct run *run, const struct inverse_step *step) {
    const size_t points = run->grid.points;
    memcpy(run->phi, step->phi, points * sizeof *run->phi);
    for (size_t k = 0; k < points; k++) {
        const bool known = step->phi_error && k >= run->grid.core && k + 1 < points;
        run->phi_error[k] = known ? step->phi_error[k] : NAN;
    }
    run->standing = (struct standing){.finished = step->finished,
                                      .converged = step->converged,
                                      .iterations = step->iteration + 1,
                                      .evaluations = step->evaluations,
                                      .engine_steps = step->engine_steps,
                                      .error = step->error,
                                      .seconds = seconds(run)};
    history_add(&run->history, step, run->standing.seconds);
    TRY(history_write(&run->history, run->fit.method, run->grid.r, &run->folder));
    const struct fit_result result = result_so_far(run, STATUS_UNCONVERGED);
    TRY(fit_output_potential(&run->fit, &run->grid, &result, &run->folder));
    progress_say(&run->progress, "iteration %u  error %.4f  noise %.4f  %.1f s", step->iteration,
                 step->error, step->noise, run->standing.seconds);
    return save(run);
}

static enum status iterate(struct run *run) {
    const struct inverse_method *method = run->fit.method;
    const struct inverse_listener listener = {tell, run};
    while (!run->standing.finished) {
        struct inverse_step step;
        const enum status status = method->iterate(run->state, &step, &listener);
        if (status == STATUS_INTERRUPTED && method->keeps_parts)
            TRY(save(run));
        TRY(status);
        TRY(record(run, &step));
    }
    return STATUS_OK;
}

/// A method without an error has not measured anything.
static void tell_unconverged(const struct run *run) {
    const char *folder = run->folder.path;
    if (isfinite(run->standing.error))
        status_fail(STATUS_UNCONVERGED, "the fit has not converged; its best potential is in %s",
                    folder);
    else
        status_fail(STATUS_UNCONVERGED,
                    "not one simulation of the fit succeeded; the failures are counted in "
                    "%s/history.tsv",
                    folder);
}

/// A potential whose verification blows up leaves a summary that says so.
static enum status write_unstable(struct run *run) {
    const struct fit_result result = result_so_far(run, STATUS_UNSTABLE);
    status_prefix(STATUS_UNSTABLE, "the verification of the fitted potential%s",
                  isfinite(run->standing.error) ? ""
                                                : " (not one simulation of the fit succeeded)");
    char reason[512];
    snprintf(reason, sizeof reason, "%s", status_message());
    TRY(fit_output_summary(&run->fit, &run->grid, &result, &run->folder));
    run_folder_draw(&run->folder);
    return status_fail(STATUS_UNSTABLE, "%s", reason);
}

/// The independent verification of the result, and everything that rests on it.
static enum status verify_and_write(struct run *run) {
    struct table table = {0};
    struct evaluate_verification verification = {0};
    struct progress progress = progress_begin(run->progress.quiet);
    const struct inverse_listener listener = {tell_verification, &progress};
    enum status status = STATUS_OK;
    CHECK(potential_grid_table(&run->grid, run->phi, &table));
    status = evaluate_verify(&run->fit.problem, &table, &run->fit.verification, &listener,
                             &verification);
    if (status == STATUS_UNSTABLE)
        status = write_unstable(run);
    CHECK(status);
    struct fit_result result =
        result_so_far(run, run->standing.converged ? STATUS_OK : STATUS_UNCONVERGED);
    result.verification = &verification;
    CHECK(fit_output_rdf(&run->fit, &result, &run->folder));
    CHECK(fit_output_summary(&run->fit, &run->grid, &result, &run->folder));
    run_folder_draw(&run->folder);
    progress_say(&run->progress,
                 "%s after %llu iterations, %.1f s\nverified: rms of g - g* = %.4f(%.0f), "
                 "statistics alone %.4f\nT = %.4f, configurational %.4f, pressure %.3f\nresults in "
                 "%s",
                 run->standing.converged ? "converged" : "not converged",
                 (unsigned long long)run->standing.iterations, run->standing.seconds,
                 verification.rmse, ceil(verification.rmse_error * 1e4), verification.noise,
                 verification.thermodynamics.temperature,
                 verification.thermodynamics.temperature_configurational,
                 verification.thermodynamics.pressure, run->folder.path);
    if (thermodynamics_judge(&verification.thermodynamics, &run->fit.problem.scene) != STATUS_OK)
        progress_say(&run->progress, "mesofit: warning: %s", status_message());
    status = result.status;
    if (status == STATUS_UNCONVERGED)
        tell_unconverged(run);
done:
    table_clear(&table);
    evaluate_verification_clear(&verification);
    return status;
}

/// A fit that is stopped leaves a summary that says so.
static enum status write_interrupted(struct run *run) {
    const struct fit_result result = result_so_far(run, STATUS_INTERRUPTED);
    if (run->standing.iterations > 0) {
        TRY(fit_output_summary(&run->fit, &run->grid, &result, &run->folder));
        run_folder_draw(&run->folder);
    }
    return status_fail(STATUS_INTERRUPTED,
                       "interrupted after %llu iterations; what there is, is in %s; go on with "
                       "--resume",
                       (unsigned long long)run->standing.iterations, run->folder.path);
}

enum status fit_run(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    run->progress = progress_begin(options->quiet);
    CHECK(prepare(run, file, options));
    status = iterate(run);
    if (status == STATUS_OK)
        status = verify_and_write(run);
    if (status == STATUS_INTERRUPTED)
        status = write_interrupted(run);
done:
    if (run) {
        if (run->created)
            run->fit.method->destroy(run->state);
        memory_free(run->state);
        history_clear(&run->history);
        potential_grid_clear(&run->grid);
        memory_free(run->phi);
        memory_free(run->phi_error);
        fit_file_clear(&run->fit);
    }
    memory_free(run);
    return status;
}

enum status fit_explain(const char *file, const struct run_options *options) {
    struct fit_file fit;
    const enum status status = fit_file_read(&fit, file, options);
    if (status == STATUS_OK) {
        const double cutoff = rdf_bins_range(&fit.target.bins);
        struct simulation_setup finer = fit.scene.setup;
        if (fit.verification.time_step > 0)
            finer.time_step = fit.verification.time_step;
        const struct explain_measured verified = {.has_potential = true,
                                                  .cutoff = cutoff,
                                                  .rdf_range = cutoff,
                                                  .sums = true,
                                                  .every = fit.verification.plan.every};
        const struct inverse_sampling sampling = fit.method->sampling(fit.method_parameters);
        if (sampling.every > 0) {
            const struct explain_measured evaluated = {.has_potential = true,
                                                       .cutoff = cutoff,
                                                       .rdf_range = cutoff,
                                                       .rdf_force = sampling.rdf_force,
                                                       .rdf_force_alone = sampling.rdf_force,
                                                       .every = sampling.every};
            printf("An evaluation of the method \"%s\", one a thread:\n", fit.method->name);
            explain_scene(stdout, &fit.scene.setup, &evaluated);
        } else {
            printf("The method \"%s\" samples by Monte Carlo: no velocities, no forces.\n",
                   fit.method->name);
        }
        printf("A replica of the verification, one a thread:\n");
        explain_scene(stdout, &finer, &verified);
    }
    fit_file_clear(&fit);
    return status;
}
