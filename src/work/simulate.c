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
const struct field simulate_rdf_fields[] = {
    {"range", FIELD_NUMBER, MEMBER(range), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "of g(r); 0 means the cutoff of the forces, if there are any"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "of g(r)"},
    {"estimator", FIELD_CHOICE, MEMBER(estimator), .choices = rdf_force_estimators,
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
    const struct pair_law law = {.potential = setup->potential, .weight = setup->weight};
    if (pair_cutoff(&law) > 0 || run->rdf_parameters.range > 0)
        return STATUS_OK;
    return status_fail(
        STATUS_BAD_INPUT,
        "%s: rdf: the scene has no forces whose cutoff is the range of g(r): say how "
        "far, as in {\"range\": 2}",
        file);
}

static enum status read_file(struct run *run, const char *file, const struct run_options *options) {
    struct json_document *document;
    TRY(json_open(&document, file));
    struct json_object root = json_root(document);
    enum status status = heading_check_scene(&root, file);
    if (status != STATUS_OK)
        return json_close(document, status);
    json_fields(&root, heading_fields, &run->heading);
    status = json_collect_files(document, &run->inputs);
    if (status == STATUS_OK)
        status = scene_read(&run->scene, &root, SCENE_FITS_NOTHING);
    struct json_object measure = json_child(&root, "measure", false);
    json_fields(&measure, measure_plan_fields, &run->plan);
    if (measure.item)
        json_finish(&measure);
    struct json_object rdf = json_child(&root, "rdf", false);
    json_fields(&rdf, simulate_rdf_fields, &run->rdf_parameters);
    if (rdf.item)
        json_finish(&rdf);
    simulate_motion_read(&run->motion, &root);
    simulate_etd_read(&run->etd, &root);
    simulate_force_covariance_read(&run->force_covariance, &root);
    json_finish(&root);
    TRY(json_close(document, status));
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
    struct json_writer *writer = json_writer_create();
    json_put_fields(writer, heading_fields, &run->heading);
    scene_write(&run->scene, writer);
    json_begin(writer, "measure");
    json_put_fields(writer, measure_plan_fields, &run->plan);
    json_end(writer);
    json_begin(writer, "rdf");
    json_put_fields(writer, simulate_rdf_fields, &run->rdf_parameters);
    json_end(writer);
    simulate_motion_write_used(&run->motion, writer);
    simulate_etd_write_used(&run->etd, writer);
    simulate_force_covariance_write_used(&run->force_covariance, writer);
    run_folder_file(&run->folder, resume ? "used.json.resumed" : "used.json", path);
    const enum status status = json_write(writer, path);
    json_writer_free(writer);
    TRY(status);
    TRY(checkpoint_digest(path, &run->digest));
    scene_digest(&run->scene, &run->digest);
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
    size_t n = simulation_spans(&run->simulation, spans);
    const struct rdf *rdf = &run->rdf;
    spans[n++] = (struct memory_span){&run->rdf.samples, sizeof rdf->samples};
    spans[n++] =
        (struct memory_span){rdf->histogram, rdf->blocks * rdf->pairs * rdf->bins.count * 8};
    spans[n++] = (struct memory_span){rdf->block_samples, rdf->blocks * 8};
    spans[n++] = (struct memory_span){&run->thermodynamics.samples, sizeof rdf->samples};
    spans[n++] = (struct memory_span){run->thermodynamics.values,
                                      THERMODYNAMICS_QUANTITIES * run->thermodynamics.planned * 8};
    if (uses_force(run))
        n += rdf_force_spans(&run->rdf_force, spans + n);
    n += simulate_motion_spans(&run->motion, spans + n);
    n += simulate_force_covariance_spans(&run->force_covariance, spans + n);
    return n + simulate_etd_spans(&run->etd, spans + n);
}

static enum status save(struct run *run) {
    struct memory_span spans[MAX_SPANS];
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(&run->folder, "checkpoint.bin", path);
    run->last_checkpoint = progress_seconds(&run->progress);
    return checkpoint_save(path, run->digest, spans, run_spans(run, spans));
}

static enum status load(struct run *run) {
    struct memory_span spans[MAX_SPANS];
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(&run->folder, "checkpoint.bin", path);
    size_t count = run_spans(run, spans);
    if (run->etd.on) { // which has as many pairs as there were
        const size_t first = count - ETD_SPANS;
        TRY(checkpoint_load_span(path, run->digest, first, &spans[first]));
        TRY(etd_make_room(&run->etd.etd));
        count = run_spans(run, spans);
    }
    TRY(checkpoint_load(path, run->digest, spans, count));
    run->progress.done_before = run->simulation.step;
    return simulation_restore(&run->simulation);
}

static void tell(void *context, const struct simulation *simulation, uint64_t done,
                 uint64_t total) {
    struct run *run = context;
    char text[96];
    snprintf(text, sizeof text, "step %llu  T %.3f", (unsigned long long)done,
             particles_temperature(&simulation->particles));
    progress_tell(&run->progress, done, total, "steps", text);
    if (progress_seconds(&run->progress) - run->last_checkpoint > checkpoint_interval &&
        save(run) != STATUS_OK)
        progress_say(&run->progress, "mesofit: warning: %s", status_message());
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
        r[k] = rdf_bins_centre(bins, k);
    nanometres = units_column(r, bins->count, units->length);
    CHECK(nanometres ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(rdf_result(&run->rdf, 1, counted, counted_error));
    if (uses_force(run))
        CHECK(rdf_force_result(&run->rdf_force, 1, RDF_FORCE_COUNTED, g, error));
    for (size_t pair = 0; pair < run->rdf.pairs; pair++) {
        const size_t first = pair * bins->count;
        size_t count = uses_force(run) ? 5 : 3;
        struct data_column columns[6] = {
            {"r[lambda]", r, NULL},
            {"g[1]", uses_force(run) ? g : counted + first, "%.8g"},
            {"g_error[1]", uses_force(run) ? error : counted_error + first, "%.3g"},
            {"g_histogram[1]", counted + first, "%.8g"},
            {"g_histogram_error[1]", counted_error + first, "%.3g"}};
        if (units_known(units))
            columns[count++] = (struct data_column){"r[nm]", nanometres, NULL};
        run_folder_rdf(&run->folder, &run->scene.setup.composition, (int)pair, path);
        CHECK(data_table_write(path, NULL, columns, count, bins->count));
    }
done:
    memory_free(r);
    memory_free(nanometres);
    memory_free(g);
    memory_free(error);
    memory_free(counted);
    memory_free(counted_error);
    return status;
}

static enum status write_thermodynamics(const struct run *run) {
    enum status status = STATUS_OK;
    const struct thermodynamics *t = &run->thermodynamics;
    char path[OUTPUT_PATH_SIZE];
    const struct units *units = &run->scene.units;
    const double *energy = thermodynamics_series(t, THERMODYNAMICS_POTENTIAL_ENERGY);
    const double *pressure = thermodynamics_series(t, THERMODYNAMICS_PRESSURE);
    double *step = NULL, *time = NULL, *configurational = NULL, *physical[3] = {NULL};
    NEW_ARRAY(step, t->samples);
    NEW_ARRAY(time, t->samples);
    NEW_ARRAY(configurational, t->samples);
    for (size_t k = 0; k < t->samples; k++) {
        step[k] = (double)(run->plan.equilibration + (int64_t)(k + 1) * run->plan.every);
        time[k] = step[k] * run->scene.setup.time_step;
        configurational[k] = thermodynamics_series(t, THERMODYNAMICS_FORCE_SQUARES)[k] /
                             thermodynamics_series(t, THERMODYNAMICS_LAPLACIAN)[k];
    }
    // bar is a force on an area.
    const bool known = units_known(units), in_space = run->scene.setup.box.dimensions == 3;
    physical[0] = units_column(time, t->samples, known ? units_time_ps(units) : 0);
    physical[1] = units_column(energy, t->samples, known ? units_energy_kj_per_mol(units) : 0);
    physical[2] = units_column(pressure, t->samples, known ? units_pressure_bar(units) : 0);
    CHECK(physical[0] && physical[1] && physical[2] ? STATUS_OK : STATUS_NO_MEMORY);
    const struct data_column columns[] = {
        {"step", step, NULL},
        {"time[tau]", time, NULL},
        {"temperature[T_0]", thermodynamics_series(t, THERMODYNAMICS_TEMPERATURE), "%.8g"},
        {"potential_energy[k_B.T_0]", energy, "%.12g"},
        {"pressure[k_B.T_0/lambda^d]", pressure, "%.8g"},
        {"temperature_configurational[T_0]", configurational, "%.8g"},
        {"time[ps]", physical[0], NULL},
        {"potential_energy[kJ/mol]", physical[1], "%.8g"},
        {"pressure[bar]", physical[2], "%.8g"}};
    run_folder_file(&run->folder, "thermodynamics.tsv", path);
    CHECK(data_table_write(path, NULL, columns, !known ? 6 : in_space ? 9 : 8, t->samples));
done:
    for (int k = 0; k < 3; k++)
        memory_free(physical[k]);
    memory_free(step);
    memory_free(time);
    memory_free(configurational);
    return status;
}

static enum status write_summary(const struct run *run, double seconds) {
    const struct thermodynamics_summary s = thermodynamics_result(&run->thermodynamics, 1);
    struct json_writer *writer = json_writer_create();
    char path[OUTPUT_PATH_SIZE];
    json_put_text(writer, "status", status_name(STATUS_OK));
    if (thermodynamics_judge(&s, &run->simulation.setup) != STATUS_OK)
        json_put_text(writer, "warning", status_message());
    json_put_text(writer, "method", "simulate");
    json_put_number(writer, "seconds", seconds);
    json_put_number(writer, "engine_steps", (double)run->simulation.step);
    json_put_number(writer, "steps_per_second",
                    (double)(run->simulation.step - run->progress.done_before) / seconds);
    json_put_number(writer, "temperature", s.temperature);
    json_put_number(writer, "temperature_error", s.temperature_error);
    if (isfinite(s.temperature_configurational)) {
        json_put_number(writer, "temperature_configurational", s.temperature_configurational);
        json_put_number(writer, "temperature_configurational_error",
                        s.temperature_configurational_error);
    }
    json_put_number(writer, "potential_energy", s.potential_energy);
    json_put_number(writer, "potential_energy_error", s.potential_energy_error);
    json_put_number(writer, "pressure", s.pressure);
    json_put_number(writer, "pressure_error", s.pressure_error);
    json_put_number(writer, "seed", (double)run->heading.seed);
    json_put_text(writer, "version", MESOFIT_VERSION);
    simulate_motion_write_summary(&run->motion, &run->scene.units, writer);
    simulate_etd_write_summary(&run->etd, writer);
    units_put(&run->scene.units, writer, s.potential_energy, s.pressure);
    run_folder_file(&run->folder, "summary.json", path);
    const enum status status = json_write(writer, path);
    json_writer_free(writer);
    return status;
}

static enum status prepare_force(struct run *run, const struct rdf_bins *bins) {
    const struct simulation_setup *setup = &run->scene.setup;
    if (composition_is_mixed(&setup->composition))
        return status_fail(STATUS_BAD_INPUT, "rdf: \"estimator\": \"force\" is not for mixtures; "
                                             "\"histogram\" counts their partial g(r)");
    if (!rdf_force_applies(setup->potential, setup->temperature))
        return status_fail(STATUS_BAD_INPUT,
                           "rdf: \"estimator\": \"force\" wants a potential that keeps particles "
                           "apart, of 10 k_B T at least where r is 0");
    return rdf_force_init(&run->rdf_force, bins, &setup->box, run->simulation.particles.count,
                          setup->potential, setup->temperature, pair_cutoff(&run->simulation.law),
                          (size_t)run->plan.samples);
}

static enum status begin_measuring(struct run *run, const char *file) {
    const struct simulation_setup *setup = &run->scene.setup;
    enum status status = simulation_init(&run->simulation, setup, &run->scene.start);
    if (status != STATUS_OK)
        return status_prefix(status, "%s", file);
    const double cutoff = pair_cutoff(&run->simulation.law);
    const double range = run->rdf_parameters.range > 0 ? run->rdf_parameters.range : cutoff;
    const struct rdf_bins bins = {.width = range / (double)run->rdf_parameters.bins,
                                  .count = (size_t)run->rdf_parameters.bins};
    status = rdf_init_mixture(&run->rdf, &bins, &setup->box, &setup->composition, cutoff,
                              (size_t)run->plan.samples);
    if (status == STATUS_OK && uses_force(run))
        status = prepare_force(run, &bins);
    if (status != STATUS_OK)
        return status_prefix(status, "%s", file);
    TRY(thermodynamics_init(&run->thermodynamics, (size_t)run->plan.samples));
    status = simulate_motion_begin(&run->motion, &run->simulation, &run->plan);
    if (status == STATUS_OK)
        status = simulate_etd_begin(&run->etd, &run->simulation, &run->plan);
    if (status == STATUS_OK)
        status =
            simulate_force_covariance_begin(&run->force_covariance, &run->simulation, &run->plan);
    if (status != STATUS_OK)
        return status_prefix(status, "%s", file);
    return STATUS_OK;
}

/// What an earlier run left is touched once this one can begin.
static enum status prepare(struct run *run, const char *file, const struct run_options *options) {
    TRY(read_file(run, file, options));
    TRY(run_folder_open(&run->folder, RUN_SIMULATION, file, &run->inputs, options));
    TRY(begin_measuring(run, file));
    TRY(write_used(run, options->resume));
    TRY(options->resume ? load(run) : save(run));
    return run_folder_begin(&run->folder, options->resume);
}

static enum status carry_out(struct run *run) {
    const struct measure_listener listener = {tell, run};
    const struct measure_targets targets = {
        .rdf = &run->rdf,
        .rdf_force = uses_force(run) ? &run->rdf_force : NULL,
        .thermodynamics = &run->thermodynamics,
        .force_covariance = simulate_force_covariance_target(&run->force_covariance),
        .motion = simulate_motion_target(&run->motion),
        .etd = simulate_etd_target(&run->etd)};
    double temperature;
    TRY(measure_equilibrate(&run->simulation, &run->plan, &temperature, &listener));
    return measure_sample(&run->simulation, &run->plan, targets, &listener);
}

static enum status write_results(struct run *run) {
    const double seconds = progress_seconds(&run->progress);
    TRY(write_rdf(run));
    TRY(write_thermodynamics(run));
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(&run->folder, "motion.tsv", path);
    TRY(simulate_motion_write_table(&run->motion, &run->scene.units, path));
    TRY(simulate_etd_write_tables(&run->etd, run->folder.path));
    run_folder_file(&run->folder, "force_covariance.tsv", path);
    TRY(simulate_force_covariance_write_table(&run->force_covariance, path));
    TRY(write_summary(run, seconds));
    run_folder_file(&run->folder, "checkpoint.bin", path); // nothing is left to go on with
    remove(path);
    run_folder_draw(&run->folder);
    const struct thermodynamics_summary s = thermodynamics_result(&run->thermodynamics, 1);
    if (thermodynamics_judge(&s, &run->simulation.setup) != STATUS_OK)
        progress_say(&run->progress, "mesofit: warning: %s", status_message());
    simulate_motion_say(&run->motion, &run->progress);
    progress_say(&run->progress, "%llu steps in %.3g s; results in %s",
                 (unsigned long long)run->simulation.step, seconds, run->folder.path);
    return STATUS_OK;
}

static void clear(struct run *run) {
    if (run == NULL)
        return;
    simulation_clear(&run->simulation);
    rdf_clear(&run->rdf);
    rdf_force_clear(&run->rdf_force);
    thermodynamics_clear(&run->thermodynamics);
    simulate_motion_clear(&run->motion);
    simulate_etd_clear(&run->etd);
    simulate_force_covariance_clear(&run->force_covariance);
    scene_clear(&run->scene);
    input_files_clear(&run->inputs);
    run_folder_close(&run->folder);
    memory_free(run);
}

enum status simulate_file(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    run->progress = progress_begin(options->quiet);
    CHECK(prepare(run, file, options));
    status = carry_out(run);
    if (status == STATUS_INTERRUPTED) {
        CHECK(save(run));
        status = status_fail(STATUS_INTERRUPTED, "interrupted at step %llu; go on with --resume",
                             (unsigned long long)run->simulation.step);
    }
    if (status == STATUS_OK)
        status = write_results(run);
done:
    clear(run);
    return status;
}

enum status simulate_explain(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    CHECK(read_file(run, file, options));
    // All that a run refuses before its first step.
    CHECK(begin_measuring(run, file));
    const struct simulation_setup *setup = &run->scene.setup;
    const double cutoff = pair_cutoff(&run->simulation.law);
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
    explain_scene(stdout, setup, &measured);
done:
    clear(run);
    return status;
}
