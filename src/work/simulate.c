// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "mesofit.h"
#include "observe/measure.h"
#include "io/checkpoint.h"
#include "work/explain.h"
#include "input/heading.h"
#include "report/progress.h"
#include "input/scene.h"
#include "work/simulate_etd.h"
#include "work/simulate_force_covariance.h"
#include "work/simulate_motion.h"

#include <math.h>

/// Seconds between checkpoints of a long simulation.
static const double checkpoint_interval = 60;

struct rdf_parameters {
    double range;
    int64_t bins;
    int estimator; ///< enum rdf_force_estimator
};

#define MEMBER(name) .offset = offsetof(struct rdf_parameters, name)
const struct field mf_simulate_rdf_fields[] = {
    {"range", FIELD_NUMBER, MEMBER(range), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "of g(r); 0 means the cutoff of the forces, if there are any"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "of g(r)"},
    {"estimator", FIELD_CHOICE, MEMBER(estimator), .choices = mf_rdf_force_estimators,
     .initial = RDF_FORCE_NOT_USED, .unit = "",
     .help = "of g(r): force is worth twice the samples, but a large time step puts it off"},
    FIELD_END,
};

struct run {
    struct run_folder folder;
    struct progress progress;
    struct scene scene;
    struct measure_plan plan;
    struct rdf_parameters rdf_parameters;
    struct heading heading;
    struct input_files inputs;
    uint64_t digest; ///< of used.json
    double last_checkpoint;
    struct simulation simulation;
    struct rdf rdf;
    struct rdf_force rdf_force; ///< if it is used
    struct thermodynamics thermodynamics;
    struct simulate_motion motion;
    struct simulate_force_covariance force_covariance;
    struct simulate_etd etd;
};

/// Threads meet a dozen times in a step: with fewer particles than this each, and a busy machine,
/// they wait for each other all day. Two threads gain 1.46 with 500 each on an idle one.
enum { PARTICLES_A_THREAD = 500 };

static int find_threads(const struct simulation_setup *setup, int wanted) {
    const int most = (int)(setup->placement.count / PARTICLES_A_THREAD);
    return most < 1 ? 1 : wanted < most ? wanted : most;
}

/// g(r) ends with the forces, unless the file says where.
static enum status check_range(const struct run *run, const char *file) {
    const struct simulation_setup *setup = &run->scene.setup;
    const struct pair_law law = {.potential = setup->potential, .omega = setup->omega};
    if (mf_pair_cutoff(&law) > 0 || run->rdf_parameters.range > 0)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: rdf: the scene has no forces whose cutoff is the range of g(r): say how "
        "far, as in {\"range\": 2}",
        file);
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
        status = mf_scene_read(&run->scene, &root, SCENE_FITS_NOTHING);
    struct json_object measure = mf_json_child(&root, "measure", false);
    mf_json_fields(&measure, mf_measure_plan_fields, &run->plan);
    if (measure.item)
        mf_json_finish(&measure);
    struct json_object rdf = mf_json_child(&root, "rdf", false);
    mf_json_fields(&rdf, mf_simulate_rdf_fields, &run->rdf_parameters);
    if (rdf.item)
        mf_json_finish(&rdf);
    mf_simulate_motion_read(&run->motion, &root);
    mf_simulate_etd_read(&run->etd, &root);
    mf_simulate_force_covariance_read(&run->force_covariance, &root);
    mf_json_finish(&root);
    TRY(mf_json_close(document, status));
    TRY(check_range(run, file));
    if (options->has_seed)
        run->heading.seed = options->seed;
    run->scene.setup.seed = run->heading.seed;
    run->scene.setup.threads = find_threads(&run->scene.setup, options->threads);
    return STATUS_OK;
}

/// Write all settings to used.json and take their digest. A run that is resumed leaves used.json
/// alone, since the settings may turn out to be others.
static enum status write_used(struct run *run, bool resume) {
    char path[OUTPUT_PATH_SIZE];
    struct json_writer *writer = mf_json_writer_create();
    mf_json_put_fields(writer, mf_heading_fields, &run->heading);
    mf_scene_write(&run->scene, writer);
    mf_json_begin(writer, "measure");
    mf_json_put_fields(writer, mf_measure_plan_fields, &run->plan);
    mf_json_end(writer);
    mf_json_begin(writer, "rdf");
    mf_json_put_fields(writer, mf_simulate_rdf_fields, &run->rdf_parameters);
    mf_json_end(writer);
    mf_simulate_motion_write_used(&run->motion, writer);
    mf_simulate_etd_write_used(&run->etd, writer);
    mf_simulate_force_covariance_write_used(&run->force_covariance, writer);
    mf_run_folder_file(&run->folder, resume ? "used.json.resumed" : "used.json", path);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    TRY(status);
    TRY(mf_checkpoint_digest(path, &run->digest));
    mf_scene_digest(&run->scene, &run->digest);
    if (resume)
        remove(path);
    return STATUS_OK;
}

static bool uses_force(const struct run *run) {
    return run->rdf_parameters.estimator == RDF_FORCE_USED;
}

enum {
    MAX_SPANS =
        SIMULATION_SPANS + 6 + RDF_FORCE_SPANS + MOTION_SPANS + FORCE_COVARIANCE_SPANS + ETD_SPANS
};

static size_t run_spans(struct run *run, struct memory_span *spans) {
    size_t n = mf_simulation_spans(&run->simulation, spans);
    const struct rdf *rdf = &run->rdf;
    spans[n++] = (struct memory_span){&run->rdf.samples, sizeof rdf->samples};
    spans[n++] =
        (struct memory_span){rdf->histogram, rdf->blocks * rdf->pairs * rdf->bins.count * 8};
    spans[n++] = (struct memory_span){rdf->block_samples, rdf->blocks * 8};
    spans[n++] = (struct memory_span){&run->thermodynamics.samples, sizeof rdf->samples};
    spans[n++] = (struct memory_span){run->thermodynamics.values,
                                      THERMODYNAMICS_QUANTITIES * run->thermodynamics.planned * 8};
    if (uses_force(run))
        n += mf_rdf_force_spans(&run->rdf_force, spans + n);
    n += mf_simulate_motion_spans(&run->motion, spans + n);
    n += mf_simulate_force_covariance_spans(&run->force_covariance, spans + n);
    return n + mf_simulate_etd_spans(&run->etd, spans + n);
}

static enum status save(struct run *run) {
    struct memory_span spans[MAX_SPANS];
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    run->last_checkpoint = mf_progress_seconds(&run->progress);
    return mf_checkpoint_save(path, run->digest, spans, run_spans(run, spans));
}

static enum status load(struct run *run) {
    struct memory_span spans[MAX_SPANS];
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "checkpoint.bin", path);
    size_t count = run_spans(run, spans);
    if (run->etd.on) { // which has as many pairs as there were
        const size_t first = count - ETD_SPANS;
        TRY(mf_checkpoint_load_span(path, run->digest, first, &spans[first]));
        TRY(mf_etd_make_room(&run->etd.etd));
        count = run_spans(run, spans);
    }
    TRY(mf_checkpoint_load(path, run->digest, spans, count));
    run->progress.done_before = run->simulation.step;
    return mf_simulation_restore(&run->simulation);
}

static void tell(void *context, const struct simulation *simulation, uint64_t done,
                 uint64_t total) {
    struct run *run = context;
    char text[96];
    snprintf(text, sizeof text, "step %llu", (unsigned long long)done);
    if (!simulation_is_overdamped(&simulation->setup))
        snprintf(text, sizeof text, "step %llu  T %.3f", (unsigned long long)done,
                 mf_particles_temperature(&simulation->particles));
    mf_progress_tell(&run->progress, done, total, "steps", text);
    if (mf_progress_seconds(&run->progress) - run->last_checkpoint > checkpoint_interval &&
        save(run) != STATUS_OK)
        mf_progress_say(&run->progress, "mesofit: warning: %s", mf_status_message());
}

static enum status write_rdf(const struct run *run) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = &run->rdf.bins;
    const size_t all = run->rdf.pairs * bins->count;
    char path[OUTPUT_PATH_SIZE];
    const struct units *units = &run->scene.units;
    double *r = NULL, *g = NULL, *error = NULL, *counted = NULL, *counted_error = NULL;
    double *nanometres = NULL;
    NEW_ARRAY(r, bins->count);
    NEW_ARRAY(g, bins->count);
    NEW_ARRAY(error, bins->count);
    NEW_ARRAY(counted, all);
    NEW_ARRAY(counted_error, all);
    for (size_t k = 0; k < bins->count; k++)
        r[k] = mf_rdf_bins_centre(bins, k);
    nanometres = mf_units_column(r, bins->count, units->length);
    CHECK(nanometres ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(mf_rdf_result(&run->rdf, 1, counted, counted_error));
    if (uses_force(run))
        CHECK(mf_rdf_force_result(&run->rdf_force, 1, RDF_FORCE_COUNTED, g, error));
    for (size_t pair = 0; pair < run->rdf.pairs; pair++) {
        const size_t first = pair * bins->count;
        size_t count = uses_force(run) ? 5 : 3;
        struct data_column columns[6] = {
            {"r[lambda]", r, NULL},
            {"g[1]", uses_force(run) ? g : counted + first, "%.8g"},
            {"g_error[1]", uses_force(run) ? error : counted_error + first, "%.3g"},
            {"g_histogram[1]", counted + first, "%.8g"},
            {"g_histogram_error[1]", counted_error + first, "%.3g"}};
        if (mf_units_known(units))
            columns[count++] = (struct data_column){"r[nm]", nanometres, NULL};
        mf_run_folder_rdf(&run->folder, &run->scene.setup.composition, (int)pair, path);
        CHECK(mf_data_table_write(path, NULL, columns, count, bins->count));
    }
done:
    mf_memory_free(r);
    mf_memory_free(nanometres);
    mf_memory_free(g);
    mf_memory_free(error);
    mf_memory_free(counted);
    mf_memory_free(counted_error);
    return status;
}

static enum status write_thermodynamics(const struct run *run) {
    enum status status = STATUS_OK;
    const struct thermodynamics *t = &run->thermodynamics;
    char path[OUTPUT_PATH_SIZE];
    const struct units *units = &run->scene.units;
    const double *energy = mf_thermodynamics_series(t, THERMODYNAMICS_POTENTIAL_ENERGY);
    const double *pressure = mf_thermodynamics_series(t, THERMODYNAMICS_PRESSURE);
    double *step = NULL, *time = NULL, *configurational = NULL, *physical[3] = {NULL};
    NEW_ARRAY(step, t->samples);
    NEW_ARRAY(time, t->samples);
    NEW_ARRAY(configurational, t->samples);
    for (size_t k = 0; k < t->samples; k++) {
        step[k] = (double)(run->plan.equilibration + (int64_t)(k + 1) * run->plan.every);
        time[k] = step[k] * run->scene.setup.time_step;
        configurational[k] = mf_thermodynamics_series(t, THERMODYNAMICS_FORCE_SQUARES)[k] /
                             mf_thermodynamics_series(t, THERMODYNAMICS_LAPLACIAN)[k];
    }
    // bar is a force on an area.
    const bool known = mf_units_known(units), in_space = run->scene.setup.box.dimensions == 3;
    physical[0] = mf_units_column(time, t->samples, known ? mf_units_time_ps(units) : 0);
    physical[1] =
        mf_units_column(energy, t->samples, known ? mf_units_energy_kj_per_mol(units) : 0);
    physical[2] = mf_units_column(pressure, t->samples, known ? mf_units_pressure_bar(units) : 0);
    CHECK(physical[0] && physical[1] && physical[2] ? STATUS_OK : STATUS_NO_MEMORY);
    const struct data_column columns[] = {
        {"step", step, NULL},
        {"time[tau]", time, NULL},
        {"temperature[T_0]", mf_thermodynamics_series(t, THERMODYNAMICS_TEMPERATURE), "%.8g"},
        {"potential_energy[k_B.T_0]", energy, "%.12g"},
        {"pressure[k_B.T_0/lambda^d]", pressure, "%.8g"},
        {"temperature_configurational[T_0]", configurational, "%.8g"},
        {"time[ps]", physical[0], NULL},
        {"potential_energy[kJ/mol]", physical[1], "%.8g"},
        {"pressure[bar]", physical[2], "%.8g"}};
    mf_run_folder_file(&run->folder, "thermodynamics.tsv", path);
    CHECK(mf_data_table_write(path, NULL, columns, !known ? 6 : in_space ? 9 : 8, t->samples));
done:
    for (int k = 0; k < 3; k++)
        mf_memory_free(physical[k]);
    mf_memory_free(step);
    mf_memory_free(time);
    mf_memory_free(configurational);
    return status;
}

static enum status write_summary(const struct run *run, double seconds) {
    const struct thermodynamics_summary s = mf_thermodynamics_result(&run->thermodynamics, 1);
    struct json_writer *writer = mf_json_writer_create();
    char path[OUTPUT_PATH_SIZE];
    mf_json_put_text(writer, "status", mf_status_name(STATUS_OK));
    if (mf_thermodynamics_judge(&s, &run->simulation.setup) != STATUS_OK)
        mf_json_put_text(writer, "warning", mf_status_message());
    mf_json_put_text(writer, "method", "simulate");
    mf_json_put_number(writer, "seconds", seconds);
    mf_json_put_number(writer, "engine_steps", (double)run->simulation.step);
    mf_json_put_number(writer, "steps_per_second",
                       (double)(run->simulation.step - run->progress.done_before) / seconds);
    mf_json_put_number(writer, "temperature", s.temperature);
    mf_json_put_number(writer, "temperature_error", s.temperature_error);
    if (isfinite(s.temperature_configurational)) {
        mf_json_put_number(writer, "temperature_configurational", s.temperature_configurational);
        mf_json_put_number(writer, "temperature_configurational_error",
                           s.temperature_configurational_error);
    }
    mf_json_put_number(writer, "potential_energy", s.potential_energy);
    mf_json_put_number(writer, "potential_energy_error", s.potential_energy_error);
    mf_json_put_number(writer, "pressure", s.pressure);
    mf_json_put_number(writer, "pressure_error", s.pressure_error);
    mf_json_put_number(writer, "seed", (double)run->heading.seed);
    mf_json_put_text(writer, "version", MESOFIT_VERSION);
    mf_simulate_motion_write_summary(&run->motion, &run->scene.units, writer);
    mf_simulate_etd_write_summary(&run->etd, writer);
    mf_units_put(&run->scene.units, writer, s.potential_energy, s.pressure);
    mf_run_folder_file(&run->folder, "summary.json", path);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}

static enum status prepare_force(struct run *run, const struct rdf_bins *bins) {
    const struct simulation_setup *setup = &run->scene.setup;
    if (composition_is_mixed(&setup->composition))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "rdf: \"estimator\": \"force\" is not for mixtures; "
                              "\"histogram\" counts their partial g(r)");
    if (setup->interactions > 0)
        return mf_status_fail(STATUS_BAD_INPUT, "rdf: \"estimator\": \"force\" knows the forces of "
                                                "pairs alone, not \"interactions\"");
    if (!mf_rdf_force_applies(setup->potential, setup->temperature))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "rdf: \"estimator\": \"force\" wants a potential that keeps particles "
            "apart, of 10 k_B T at least where r is 0");
    return mf_rdf_force_init(&run->rdf_force, bins, &setup->box, run->simulation.particles.count,
                             setup->potential, setup->temperature,
                             mf_pair_cutoff(&run->simulation.law), (size_t)run->plan.samples);
}

static enum status begin_measuring(struct run *run, const char *file) {
    const struct simulation_setup *setup = &run->scene.setup;
    enum status status = mf_simulation_init(&run->simulation, setup, &run->scene.start);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s", file);
    const double cutoff = mf_pair_cutoff(&run->simulation.law);
    const double range = run->rdf_parameters.range > 0 ? run->rdf_parameters.range : cutoff;
    const struct rdf_bins bins = {.width = range / (double)run->rdf_parameters.bins,
                                  .count = (size_t)run->rdf_parameters.bins};
    status = mf_rdf_init_mixture(&run->rdf, &bins, &setup->box, &setup->composition, cutoff,
                                 (size_t)run->plan.samples);
    if (status == STATUS_OK && uses_force(run))
        status = prepare_force(run, &bins);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s", file);
    TRY(mf_thermodynamics_init(&run->thermodynamics, (size_t)run->plan.samples));
    status = mf_simulate_motion_begin(&run->motion, &run->simulation, &run->plan);
    if (status == STATUS_OK)
        status = mf_simulate_etd_begin(&run->etd, &run->simulation, &run->plan);
    if (status == STATUS_OK)
        status = mf_simulate_force_covariance_begin(&run->force_covariance, &run->simulation,
                                                    &run->plan);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s", file);
    return STATUS_OK;
}

/// What an earlier run left is touched once this one can begin.
static enum status prepare(struct run *run, const char *file, const struct run_options *options) {
    TRY(read_file(run, file, options));
    TRY(mf_run_folder_open(&run->folder, RUN_SIMULATION, file, &run->inputs, options));
    TRY(begin_measuring(run, file));
    TRY(write_used(run, options->resume));
    TRY(options->resume ? load(run) : save(run));
    return mf_run_folder_begin(&run->folder, options->resume);
}

static enum status carry_out(struct run *run) {
    const struct measure_listener listener = {tell, run};
    const struct measure_observables observables = {
        .rdf = &run->rdf,
        .rdf_force = uses_force(run) ? &run->rdf_force : NULL,
        .thermodynamics = &run->thermodynamics,
        .force_covariance = mf_simulate_force_covariance_target(&run->force_covariance),
        .motion = mf_simulate_motion_target(&run->motion),
        .etd = mf_simulate_etd_target(&run->etd)};
    double temperature;
    TRY(mf_measure_equilibrate(&run->simulation, &run->plan, &temperature, &listener));
    return mf_measure_sample(&run->simulation, &run->plan, observables, &listener);
}

static enum status write_results(struct run *run) {
    const double seconds = mf_progress_seconds(&run->progress);
    TRY(write_rdf(run));
    TRY(write_thermodynamics(run));
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(&run->folder, "motion.tsv", path);
    TRY(mf_simulate_motion_write_table(&run->motion, &run->scene.units, path));
    TRY(mf_simulate_etd_write_tables(&run->etd, run->folder.path));
    mf_run_folder_file(&run->folder, "force_covariance.tsv", path);
    TRY(mf_simulate_force_covariance_write_table(&run->force_covariance, path));
    TRY(write_summary(run, seconds));
    mf_run_folder_file(&run->folder, "checkpoint.bin", path); // nothing is left to go on with
    remove(path);
    mf_run_folder_draw(&run->folder);
    const struct thermodynamics_summary s = mf_thermodynamics_result(&run->thermodynamics, 1);
    if (mf_thermodynamics_judge(&s, &run->simulation.setup) != STATUS_OK)
        mf_progress_say(&run->progress, "mesofit: warning: %s", mf_status_message());
    mf_simulate_motion_say(&run->motion, &run->progress);
    mf_progress_say(&run->progress, "%llu steps in %.3g s; results in %s",
                    (unsigned long long)run->simulation.step, seconds, run->folder.path);
    return STATUS_OK;
}

static void clear(struct run *run) {
    if (run == NULL)
        return;
    mf_simulation_clear(&run->simulation);
    mf_rdf_clear(&run->rdf);
    mf_rdf_force_clear(&run->rdf_force);
    mf_thermodynamics_clear(&run->thermodynamics);
    mf_simulate_motion_clear(&run->motion);
    mf_simulate_etd_clear(&run->etd);
    mf_simulate_force_covariance_clear(&run->force_covariance);
    mf_scene_clear(&run->scene);
    mf_input_files_clear(&run->inputs);
    mf_run_folder_close(&run->folder);
    mf_memory_free(run);
}

enum status mf_simulate_file(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    run->progress = mf_progress_begin(options->quiet);
    CHECK(prepare(run, file, options));
    status = carry_out(run);
    if (status == STATUS_INTERRUPTED) {
        CHECK(save(run));
        status = mf_status_fail(STATUS_INTERRUPTED, "interrupted at step %llu; go on with --resume",
                                (unsigned long long)run->simulation.step);
    }
    if (status == STATUS_OK)
        status = write_results(run);
done:
    clear(run);
    return status;
}

enum status mf_simulate_explain(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    CHECK(read_file(run, file, options));
    // All that a run refuses before its first step.
    CHECK(begin_measuring(run, file));
    const struct simulation_setup *setup = &run->scene.setup;
    const double cutoff = mf_pair_cutoff(&run->simulation.law);
    const struct explain_measured measured = {
        .has_potential = setup->potential != NULL,
        .cutoff = cutoff,
        .rdf_range = run->rdf_parameters.range > 0 ? run->rdf_parameters.range : cutoff,
        .rdf_force = uses_force(run),
        .sums = true,
        .every = run->plan.every,
        .force_covariance = run->force_covariance.on,
        .motion = run->motion.on ? &run->motion.plan : NULL,
        .etd_grid = run->etd.on ? &run->etd.grid : NULL,
        .etd_plan = &run->etd.plan};
    mf_explain_scene(stdout, setup, &measured);
done:
    clear(run);
    return status;
}
