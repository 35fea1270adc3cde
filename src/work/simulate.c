// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate.h"

#include "base/memory.h"
#include "base/version.h"
#include "scene/heading.h"
#include "scene/scene.h"
#include "scene/scene_doubts.h"
#include "scene/scene_step.h"
#include "io/checkpoint.h"
#include "observe/shear_viscosity.h"
#include "report/progress.h"
#include "work/explain.h"
#include "work/simulate_observables.h"
#include "work/simulate_remarks.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>

/// Seconds between checkpoints of a long simulation, at least.
static const double checkpoint_interval = 60;

struct run {
    struct run_folder folder;
    struct progress progress;
    struct scene scene;
    struct measure_plan plan;
    struct heading heading;
    struct input_files inputs;
    int64_t equilibration;        ///< of the file; that of the plan grows with a change
    uint64_t digest;              ///< of used.json
    char chosen[SCENE_STEP_SIZE]; ///< how the time step was, or ""
    struct checkpoint_pace pace;
    struct simulation simulation;
    struct simulate_observables observables;
    struct kept {
        double seconds; ///< of all pieces until then
        struct simulate_changes changes;
    } kept;                ///< in the checkpoint, before the simulation
    double seconds_before; ///< of the pieces before a restart
    atomic_bool cancel;    ///< set for a change, of a run that no option stops
};

/// Threads meet a dozen times in a step: with fewer particles than this each, and a busy machine,
/// they wait for each other all day. Two threads gain 1.46 with 500 each on an idle one.
enum { PARTICLES_A_THREAD = 500 };

static int find_threads(const struct simulation_setup *setup, int wanted) {
    const int max = (int)(simulation_moved(setup) / PARTICLES_A_THREAD);
    return max < 1 ? 1 : wanted < max ? wanted : max;
}

static enum status read_file(struct run *run, const char *file, const struct run_options *options) {
    struct json_document *document;
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    enum status status = mf_heading_check_scene(&root, file);
    if (status != STATUS_OK)
        return mf_json_close(document, status);
    mf_json_fields(&root, mf_heading_fields, &run->heading);
    status = mf_json_collect_files(document, &run->inputs);
    if (status == STATUS_OK)
        status = mf_scene_read(&run->scene, &root, SCENE_FITS_NOTHING, NULL);
    struct json_object measure = mf_json_child(&root, "measure", false);
    mf_json_fields(&measure, mf_measure_plan_fields, &run->plan);
    if (measure.item)
        mf_json_finish(&measure);
    run->equilibration = run->plan.equilibration;
    if (status == STATUS_OK)
        status = mf_simulate_observables_read(&run->observables, &root, &run->scene.setup);
    mf_json_finish(&root);
    TRY(mf_json_close(document, status));
    mf_scene_step_choose(&run->scene,
                         mf_simulate_observables_has(&run->observables, &mf_shear_viscosity),
                         run->chosen);
    if (options->callers)
        TRY(mf_simulate_observables_add(&run->observables, options->callers));
    if (options->has_seed)
        run->heading.seed = options->seed;
    run->scene.setup.seed = run->heading.seed;
    run->scene.setup.cancel = options->stop ? options->stop : &run->cancel;
    run->scene.setup.threads = find_threads(&run->scene.setup, options->threads);
    return STATUS_OK;
}

/// Keep all settings, and take their digest.
static enum status keep_settings(struct run *run) {
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_fields(writer, mf_heading_fields, &run->heading);
    mf_units_write(&run->scene.units, writer);
    mf_scene_write(&run->scene, writer);
    mf_json_begin(writer, "measure");
    mf_json_write_fields(writer, mf_measure_plan_fields, &run->plan);
    mf_json_end(writer);
    mf_simulate_observables_write_used(&run->observables, writer);
    const enum status status = mf_run_folder_keep_settings(&run->folder, writer, &run->digest);
    mf_json_writer_free(writer);
    mf_scene_digest(&run->scene, &run->digest);
    mf_simulate_observables_digest(&run->observables, &run->digest);
    return status;
}

static double seconds(const struct run *run) {
    return run->seconds_before + mf_progress_seconds(&run->progress);
}

static struct memory_span kept_span(struct run *run) {
    return (struct memory_span){&run->kept, sizeof run->kept};
}

static enum status save(struct run *run) {
    struct memory_span spans[1 + SIMULATE_MAX_SPANS] = {kept_span(run)};
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    const double begun = mf_progress_seconds(&run->progress);
    run->kept.seconds = seconds(run);
    const size_t count =
        mf_simulate_observables_spans(&run->observables, &run->simulation, spans + 1);
    const enum status status = mf_checkpoint_save(path, run->digest, spans, 1 + count);
    mf_checkpoint_pace_saved(&run->pace, begun, mf_progress_seconds(&run->progress));
    return status;
}

/// What was measured before a change is not of what comes after it: the simulation equilibrates
/// once more, and all samples are taken again.
static enum status change(struct run *run) {
    const struct simulation_change *last = mf_simulate_changes_last(&run->kept.changes);
    TRY(mf_simulation_change(&run->simulation, last));
    run->plan.equilibration = (int64_t)last->step + run->equilibration;
    return mf_simulate_observables_restart(&run->observables, &run->simulation, &run->plan);
}

static enum status load(struct run *run) {
    const struct memory_span kept = kept_span(run);
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    TRY(mf_checkpoint_load_span(path, run->digest, 0, &kept));
    if (mf_simulate_changes_last(&run->kept.changes))
        TRY(change(run));
    TRY(mf_simulate_observables_load(&run->observables, &run->simulation, path, run->digest,
                                     &kept));
    run->progress.done_before = run->simulation.step;
    run->seconds_before = run->kept.seconds;
    return STATUS_OK;
}

static void report(void *context, const struct simulation *simulation, uint64_t done,
                   uint64_t total) {
    struct run *run = context;
    const struct units *units = &run->scene.units;
    char text[96], unit[UNITS_NAME_SIZE];
    snprintf(text, sizeof text, "step %llu", (unsigned long long)done);
    if (done > 0 && simulation_has_velocities(&simulation->setup) &&
        simulation->particles.count > 1)
        snprintf(text, sizeof text, "step %llu  T %.*f%s", (unsigned long long)done,
                 !mf_units_are_physical(units) ? 3 : 1,
                 mf_simulation_temperature(simulation) * mf_units_factor(units, "T_0"),
                 mf_units_suffix(units, "T_0", unit));
    // Before its first step, what goes on knows neither temperature nor rate.
    if (done == 0 || done > run->progress.done_before)
        mf_progress_report(&run->progress, done, total, "steps", text);
    if (mf_progress_seconds(&run->progress) > run->pace.next && save(run) != STATUS_OK)
        mf_progress_print(&run->progress, "mesofit: warning: %s", mf_status_message());
    struct simulation_change wanted;
    if (done < total && mf_progress_ask_change(&run->progress, &wanted) &&
        mf_simulate_changes_add(&run->kept.changes, &wanted))
        atomic_store(&run->cancel, true);
}

static int64_t steps(void *context) {
    const struct watcher *watcher = ((const struct run *)context)->progress.watcher;
    return watcher->steps(watcher->context);
}

static void report_run(struct run *run) {
    const struct watcher_run watched = {.kind = RUN_SIMULATION,
                                        .folder = run->folder.path,
                                        .units = &run->scene.units,
                                        .simulation = &run->simulation,
                                        .plan = &run->plan,
                                        .observables = run->observables.use};
    mf_progress_report_run(&run->progress, &watched);
}

static struct observable_results results_of(const struct run *run) {
    return (struct observable_results){.setup = &run->simulation.setup,
                                       .plan = &run->plan,
                                       .units = &run->scene.units,
                                       .folder = run->folder.path,
                                       .use = run->observables.use};
}

/// What the integrator tells of itself.
static void write_numbers(const struct simulation *simulation, struct json_writer *writer) {
    const struct integrator *integrator = simulation->setup.integrator;
    struct integrator_number number[INTEGRATOR_NUMBERS];
    const size_t count =
        integrator->numbers ? integrator->numbers(simulation->integrator_state, number) : 0;
    for (size_t k = 0; k < count; k++)
        mf_json_write_number(writer, number[k].name, number[k].value);
}

static enum status write_summary(const struct run *run, enum status how, double taken) {
    const struct observable_results results = results_of(run);
    struct json_writer *writer = mf_json_writer_create();
    char path[OUTPUT_PATH_SIZE];
    mf_units_write_summary(&run->scene.units, writer);
    mf_json_write_text(writer, "status", mf_status_name(how));
    mf_json_write_text(writer, "method", "simulate");
    mf_json_write_number(writer, "seconds", taken);
    mf_json_write_number(writer, "engine_steps", (double)run->simulation.step);
    mf_simulate_changes_write(&run->kept.changes, writer);
    mf_json_write_number(writer, "steps_per_second", (double)run->simulation.step / taken);
    write_numbers(&run->simulation, writer);
    mf_simulate_remarks_write(&run->scene, &run->simulation, writer);
    mf_simulate_observables_write_summary(&run->observables, &results, writer);
    mf_json_write_number(writer, "seed", (double)run->heading.seed);
    mf_json_write_text(writer, "version", mf_version);
    mf_run_folder_file(&run->folder, "summary.json", path);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}

static enum status begin_measuring(struct run *run, const char *file) {
    enum status status = mf_simulation_init(&run->simulation, &run->scene.setup, &run->scene.start);
    if (status == STATUS_OK)
        status = mf_simulate_observables_begin(&run->observables, &run->simulation, &run->plan);
    return status == STATUS_OK
               ? status
               : mf_status_prefix(mf_units_convert_message(&run->scene.units, status), "%s", file);
}

static enum status begin_folder(struct run *run, bool resume) {
    if (resume) {
        TRY(load(run));
        return mf_run_folder_resume(&run->folder, run->digest);
    }
    TRY(mf_run_folder_begin(&run->folder, run->digest));
    TRY(save(run));
    return mf_run_folder_take_over(&run->folder);
}

/// What an earlier run left is touched once this one can begin.
static enum status prepare(struct run *run, const char *file, const struct run_options *options) {
    TRY(read_file(run, file, options));
    TRY(mf_run_folder_open(&run->folder, RUN_SIMULATION, file, &run->inputs, options));
    TRY(mf_simulate_observables_reserve(&run->observables, &run->scene.setup.composition,
                                        &run->folder));
    TRY(begin_measuring(run, file));
    TRY(keep_settings(run));
    return begin_folder(run, options->resume);
}

static void print_doubt(void *context, const char *line) {
    mf_progress_print(context, "mesofit: warning: %s", line);
}

static void warn(struct run *run) {
    const char *warning = mf_scene_warning(&run->scene);
    mf_progress_print_scale(&run->progress, &run->scene.units);
    if (run->chosen[0])
        mf_progress_print(&run->progress, "%s", run->chosen);
    if (warning)
        mf_progress_print(&run->progress, "mesofit: warning: %s", warning);
    mf_scene_doubts(&run->scene, &(struct scene_doubts_listener){print_doubt, &run->progress});
}

static enum status measure(struct run *run, const struct measure_listener *listener) {
    const struct observable_results results = results_of(run);
    double temperature;
    mf_simulate_observables_open(&run->observables, &results);
    TRY(mf_measure_equilibrate(&run->simulation, &run->plan, &temperature, listener));
    return mf_measure_sample(&run->simulation, &run->plan, run->observables.use, listener);
}

static enum status carry_out(struct run *run) {
    const struct watcher *watcher = run->progress.watcher;
    const struct measure_listener listener = {report, run,
                                              watcher && watcher->steps ? steps : NULL};
    report_run(run);
    warn(run);
    enum status status = measure(run, &listener);
    // A person may have stopped it meanwhile: it then begins with the change when it goes on.
    while (status == STATUS_INTERRUPTED && atomic_exchange(&run->cancel, false)) {
        TRY(change(run));
        mf_simulate_changes_print(&run->kept.changes, &run->scene.units, &run->progress);
        TRY(save(run));
        status = measure(run, &listener);
    }
    return status;
}

/// Nothing is left to go on with.
static void remove_checkpoint(const struct run *run) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    mf_tracked_files_remove(path);
}

enum { MEMORY_SIZE = 64 };

/// The most memory that the program has had at once, and of so many particles that it is theirs
/// what each of them takes. @param[in] share  of the scene's particles, which were simulated
static void describe_memory(const struct run *run, double share, char line[MEMORY_SIZE]) {
    static const double many = 1e5;
    const double count = (double)run->simulation.particles.count / share;
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    const double bytes = 1024.0 * (double)used.ru_maxrss / share;
    const int length =
        snprintf(line, MEMORY_SIZE, "%s%.0f MB of memory", share < 1 ? "about " : "", bytes / 1e6);
    if (count >= many)
        snprintf(line + length, (size_t)(MEMORY_SIZE - length), ", %.0f bytes a particle",
                 bytes / count);
}

/// Tables, figures and the summary of what was sampled.
static enum status write_results(struct run *run, enum status how, double taken) {
    const struct observable_results results = results_of(run);
    TRY(mf_simulate_observables_write(&run->observables, &results));
    // Who is killed while they are drawn leaves a run that is to be resumed, which clears up.
    mf_run_folder_draw(&run->folder);
    return write_summary(run, how, taken);
}

/// A simulation that is stopped leaves what it has measured, as the live view shows it, and goes on
/// from its checkpoint. One sample alone has no errors.
static enum status write_interrupted(struct run *run) {
    const struct simulation *simulation = &run->simulation;
    const bool sampled = (int64_t)simulation->step >= run->plan.equilibration + 2 * run->plan.every;
    TRY(save(run));
    if (sampled)
        TRY(write_results(run, STATUS_INTERRUPTED, seconds(run)));
    return mf_status_fail(
        STATUS_INTERRUPTED, "interrupted at step %llu%s%.300s; continue with --resume",
        (unsigned long long)simulation->step, sampled ? "; what there is, is in " : "",
        sampled ? run->folder.path : "");
}

static enum status write_finished(struct run *run) {
    const struct observable_results results = results_of(run);
    const double taken = seconds(run);
    char memory[MEMORY_SIZE];
    TRY(write_results(run, mf_simulate_observables_judge(&run->observables, &results), taken));
    remove_checkpoint(run);
    mf_simulate_observables_print(&run->observables, &results, &run->progress);
    mf_simulate_remarks_print(&run->scene, &run->simulation, &run->progress);
    describe_memory(run, 1, memory);
    mf_progress_print(&run->progress, "%llu steps in %.3g s, %s; results in %s",
                      (unsigned long long)run->simulation.step, taken, memory, run->folder.path);
    return mf_simulate_observables_judge(&run->observables, &results);
}

static void clear(struct run *run) {
    if (run == NULL)
        return;
    mf_simulation_clear(&run->simulation);
    mf_simulate_observables_clear(&run->observables);
    mf_scene_clear(&run->scene);
    mf_input_files_clear(&run->inputs);
    mf_progress_end(&run->progress);
    mf_run_folder_close(&run->folder);
    mf_memory_free(run);
}

enum status mf_simulate_file(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    run->pace.interval = run->pace.next = checkpoint_interval;
    run->progress = mf_progress_begin(options->quiet, options->watcher);
    CHECK(prepare(run, file, options));
    status = mf_units_convert_message(&run->scene.units, carry_out(run));
    if (status == STATUS_INTERRUPTED)
        status = write_interrupted(run);
    if (status == STATUS_UNSTABLE) // it would be so again
        remove_checkpoint(run);
    if (status == STATUS_OK)
        status = write_finished(run);
done:
    clear(run);
    return status;
}

/// Of many particles a part, at their density, tells what each takes, unless they are placed by
/// hand or bound to each other. Returns which part it is.
static double take_part(struct simulation_setup *setup) {
    static const double enough = 2e5;
    const double share = enough / (double)setup->placement.count;
    if (share >= 1 || setup->placement.kind == PLACEMENT_FILE || setup->interactions > 0 ||
        setup->integrator->solvent_particles)
        return 1;
    setup->placement.count = (int64_t)enough;
    if (setup->composition.types > 0) {
        setup->composition = mf_composition_scaled(&setup->composition, (int64_t)enough);
        setup->placement.count = mf_composition_particles(&setup->composition);
    }
    for (int axis = 0; axis < setup->box.dimensions; axis++)
        setup->box.length[axis] *= pow(share, 1.0 / setup->box.dimensions);
    return share;
}

enum status mf_simulate_explain(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    char memory[MEMORY_SIZE];
    NEW_ARRAY(run, 1);
    CHECK(read_file(run, file, options));
    const struct simulation_setup whole = run->scene.setup;
    const double share = take_part(&run->scene.setup);
    // All that a run refuses before its first step.
    CHECK(begin_measuring(run, file));
    mf_explain_scale(stdout, &run->scene.units);
    if (run->chosen[0])
        printf("%s\n", run->chosen);
    mf_explain_doubts(stdout, &run->scene);
    mf_explain_scene(stdout, &whole, &run->scene.units, run->observables.use, run->plan.every);
    describe_memory(run, share, memory);
    printf("%s\n", memory);
done:
    clear(run);
    return status;
}
