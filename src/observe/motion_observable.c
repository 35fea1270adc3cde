// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/motion.h"
#include "observe/pooled.h"
#include "observe/shear_viscosity.h"

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    return mf_motion_init(state, settings, simulation, plan->equilibration,
                          plan->samples * plan->every);
}

static void clear(void *state) {
    mf_motion_clear(state);
}

static int64_t due(const void *state) {
    return mf_motion_due(state);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    TRY(mf_motion_see_molecules(state, &simulation->particles));
    mf_motion_sample(state, simulation);
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_motion_spans(state, spans);
}

/// motion.tsv: time, MSD, VACF, each with its standard error.
static enum status write(const void *state, const struct observable_results *results) {
    const struct motion *motion = state;
    const size_t rows = (size_t)motion->plan.lags + 1;
    static const char *const beside[MOTION_COLUMNS] = {"%.10g", "%.8g", "%.3g", "%.8g", "%.3g"};
    OWNED double *values = NULL;
    char path[OUTPUT_PATH_SIZE];
    TRY(mf_motion_table(motion, &values));
    const struct data_column columns[MOTION_COLUMNS] = {
        {"time[tau]", values, NULL},
        {"msd[lambda^2]", values + rows, "%.8g"},
        {"msd_error[lambda^2]", values + 2 * rows, "%.3g"},
        {"vacf[lambda^2/tau^2]", values + 3 * rows, "%.8g"},
        {"vacf_error[lambda^2/tau^2]", values + 4 * rows, "%.3g"}};
    mf_observable_file(results, "motion.tsv", path);
    return mf_data_table_write_beside(path, results->units, NULL, columns, beside, MOTION_COLUMNS,
                                      rows);
}

/// D of an infinite box, where the viscosity is known.
static void write_infinite(const struct motion_summary *s, const struct observable_results *results,
                           struct json_writer *writer) {
    double diffusion = s->msd, error = s->msd_error;
    if (!mf_shear_viscosity_correct(results, &diffusion, &error))
        return;
    mf_json_put_measured(writer, "diffusion_infinite", "lambda^2/tau", diffusion, error);
}

/// That there is no D yet, and what the two of them say of each other.
static void write_warning(const struct motion_summary *s, const struct units *units,
                          struct json_writer *writer) {
    char early[MOTION_EARLY_SIZE], text[STATUS_MESSAGE_SIZE + MOTION_EARLY_SIZE] = "";
    const bool parted = mf_units_convert_message(units, mf_motion_assess(s)) != STATUS_OK;
    mf_motion_early_text(s, early);
    snprintf(text, sizeof text, "%s%s%s", early, early[0] && parted ? "; " : "",
             parted ? mf_status_message() : "");
    if (text[0])
        mf_json_write_text(writer, "warning", text);
}

/// The object "motion": diffusion coefficients with errors, in cm²/s too when the units are known,
/// and the test of the velocities.
static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct units *units = results->units;
    struct motion_summary s = mf_motion_result(state, NULL);
    mf_json_begin(writer, "motion");
    mf_statistics_mark_unknown_errors(&s.msd_error, 1);
    write_warning(&s, units, writer);
    mf_json_put_measured(writer, "diffusion_msd", "lambda^2/tau", s.msd, s.msd_error);
    write_infinite(&s, results, writer);
    mf_json_write_quantity(writer, "diffusion_green_kubo", "lambda^2/tau", s.green_kubo);
    const double error = mf_motion_green_kubo_uncertainty(&s);
    mf_json_write_quantity(writer, "diffusion_green_kubo_error", "lambda^2/tau", error);
    mf_json_write_quantity(writer, "diffusion_green_kubo_sampling", "lambda^2/tau",
                           s.green_kubo_sampling);
    mf_json_write_quantity(writer, "diffusion_green_kubo_truncation", "lambda^2/tau",
                           s.green_kubo_truncation);
    if (mf_units_known(units)) {
        const double unit = mf_units_diffusion_cm2_per_s(units);
        mf_json_write_number(writer, "diffusion_msd_cm2_per_s", s.msd * unit);
        mf_json_write_number(writer, "diffusion_msd_error_cm2_per_s", s.msd_error * unit);
        mf_json_write_number(writer, "diffusion_green_kubo_cm2_per_s", s.green_kubo * unit);
        mf_json_write_number(writer, "diffusion_green_kubo_error_cm2_per_s", error * unit);
    }
    mf_json_write_quantity(writer, "fit_begin", "tau", s.fit_begin);
    mf_json_write_quantity(writer, "fit_end", "tau", s.fit_end);
    if (s.maxwell.numbers > 0) {
        mf_json_write_number(writer, "velocities_tested", s.maxwell.numbers);
        mf_json_write_number(writer, "velocities_independent", s.maxwell.independent);
        mf_json_write_number(writer, "velocities_kolmogorov_smirnov", s.maxwell.statistic);
        mf_json_write_number(writer, "velocities_p_value", s.maxwell.probability);
    }
    mf_json_end(writer);
}

/// Both diffusion coefficients; without velocities there is one.
static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct motion *motion = state;
    char msd[UNITS_MEASURED_SIZE], green_kubo[NUMBER_TEXT_SIZE], time_unit[UNITS_NAME_SIZE];
    char early[MOTION_EARLY_SIZE];
    const struct motion_summary s = mf_motion_result(motion, NULL);
    const struct units *units = results->units;
    const double factor = mf_units_factor(units, "lambda^2/tau");
    const double time = mf_units_factor(units, "tau");
    mf_number_text(factor * s.green_kubo, factor * mf_motion_green_kubo_uncertainty(&s),
                   green_kubo);
    snprintf(line, size, "D = %s by the MSD from %.4g to %.4g %s%s%s%s%s%s",
             mf_units_measured(units, "lambda^2/tau", s.msd, s.msd_error, msd), time * s.fit_begin,
             time * s.fit_end, mf_units_name(units, "tau", time_unit),
             motion->has_velocities ? ", " : "", motion->has_velocities ? green_kubo : "",
             motion->has_velocities ? " by Green and Kubo" : "", mf_motion_is_early(&s) ? "; " : "",
             mf_motion_early_text(&s, early));
}

static enum status assess(const void *state, const struct simulation_setup *setup) {
    (void)setup;
    const struct motion_summary s = mf_motion_result(state, NULL);
    return mf_motion_assess(&s);
}

/// Nanoseconds of a particle and sample, and of each of its time origins.
static const double gather_cost = 4, correlate_cost = 1.3;

static void explain(const void *settings, const struct simulation_setup *setup,
                    double samples_every, struct stages *stages) {
    (void)setup, (void)samples_every;
    const struct motion_plan *plan = settings;
    const double every = (double)plan->every;
    const double origins = (double)plan->lags / (double)plan->origin_every + 1;
    mf_stages_add(stages, "diffusion", true, (gather_cost + correlate_cost * origins) / every,
                  "%.0f time origins, one step in %.0f", origins, every);
}

/// VACF, MSD, and D of the MSD.
static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const size_t times = (size_t)((const struct motion *)state)->plan.lags + 1;
    OWNED double *memory = NULL;
    TRY_ARRAY(memory, 4 * times);
    const struct motion_curves curves = {memory, memory + times, memory + 2 * times,
                                         memory + 3 * times};
    const struct motion_summary found = mf_motion_result(state, &curves);
    mf_pooled_set(&values[0], curves.vacf, curves.vacf_error);
    mf_pooled_set(&values[1], curves.msd, curves.msd_error);
    mf_pooled_set(&values[2], &found.msd, &found.msd_error);
    *blocks = found.blocks;
    return STATUS_OK;
}

static const struct observable_target targets[] = {
    {.name = "vacf",
     .summary = "velocity autocorrelation",
     .form = OBSERVABLE_CURVE_OF_TIME,
     .argument = "time[tau]",
     .unit = "lambda^2/tau^2"},
    {.name = "msd",
     .summary = "mean-square displacement",
     .form = OBSERVABLE_CURVE_OF_TIME,
     .argument = "time[tau]",
     .unit = "lambda^2"},
    {.name = "diffusion", .summary = "D", .form = OBSERVABLE_NUMBER, .unit = "lambda^2/tau"},
    {.name = NULL}};

static const char *const files[] = {"motion.tsv", NULL};

const struct observable mf_motion_observable = {
    .name = "motion",
    .summary = "diffusion",
    .of_time = true,
    .fields = mf_motion_plan_fields,
    .settings_size = sizeof(struct motion_plan),
    .state_size = sizeof(struct motion),
    .begin = begin,
    .clear = clear,
    .due = due,
    .sample = sample,
    .spans = spans,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .assess = assess,
    .explain = explain,
    .stage = "diffusion",
    .files = files,
    .figure = "motion",
    .targets = targets,
    .result = result,
};
