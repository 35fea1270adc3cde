// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/polarity.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "system/orientation.h"

#include <math.h>

/// D_t, v_0² and D_r that fit an MSD.
struct law {
    double diffusion, square_speed, turning, misfit;
};

enum { MAX_BLOCKS = 64, GRID = 48, REFINED = 40 };

/// A curve of MSD without time 0, its times, and of a law its two basis functions.
struct displacements {
    size_t count;
    double *time, *msd, *walk, *persist;
};

/// The best law of this D_r: linear least squares of 4 D_t t + v_0² persistence(t), each over the
/// MSD, so that all points count alike.
static struct law fit_linear(const struct displacements *curve, double turning) {
    const struct brownian_free unit = {.speed = 1, .orientation_diffusion = turning};
    double ww = 0, wp = 0, pp = 0, w1 = 0, p1 = 0, misfit = 0;
    for (size_t k = 0; k < curve->count; k++) {
        const double w = 4 * curve->time[k] / curve->msd[k];
        const double p = mf_brownian_free_msd(&unit, curve->time[k]) / curve->msd[k];
        curve->walk[k] = w;
        curve->persist[k] = p;
        ww += w * w;
        wp += w * p;
        pp += p * p;
        w1 += w;
        p1 += p;
    }
    const double determinant = ww * pp - wp * wp;
    const bool apart = determinant > 1e-10 * ww * pp; // else both are lines
    struct law law = {.diffusion = apart ? (w1 * pp - p1 * wp) / determinant : w1 / ww,
                      .square_speed = apart ? (p1 * ww - w1 * wp) / determinant : 0,
                      .turning = turning};
    for (size_t k = 0; k < curve->count; k++)
        misfit += pow(law.diffusion * curve->walk[k] + law.square_speed * curve->persist[k] - 1, 2);
    law.misfit = misfit;
    return law;
}

/// The best of a grid of D_r, refined by golden sections.
static struct law fit_law(const struct displacements *curve) {
    static const double golden = 0.6180339887498949;
    const double low = log(0.01 / curve->time[curve->count - 1]), high = log(10 / curve->time[0]);
    const double width = (high - low) / (GRID - 1);
    struct law best = {.misfit = INFINITY};
    for (int n = 0; n < GRID; n++) {
        const struct law law = fit_linear(curve, exp(low + n * width));
        best = law.misfit < best.misfit ? law : best;
    }
    double left = log(best.turning) - width, right = log(best.turning) + width;
    for (int n = 0; n < REFINED && isfinite(best.misfit); n++) {
        const double a = right - golden * (right - left), b = left + golden * (right - left);
        const struct law first = fit_linear(curve, exp(a)), second = fit_linear(curve, exp(b));
        best = first.misfit < best.misfit ? first : best;
        best = second.misfit < best.misfit ? second : best;
        if (first.misfit < second.misfit)
            right = b;
        else
            left = a;
    }
    // At an end of the range the curve says no more than that D_r is beyond it.
    if (!(log(best.turning) > low && log(best.turning) < high))
        best = (struct law){.diffusion = NAN, .square_speed = NAN, .turning = NAN};
    return best;
}

/// The MSD of all blocks but one; `without` beyond them: of all.
static void take_curve(const struct motion *motion, size_t blocks, size_t without,
                       struct displacements *curve) {
    const size_t lags = (size_t)motion->plan.lags;
    const double used = (double)(without < blocks ? blocks - 1 : blocks);
    for (size_t lag = 1; lag <= lags; lag++) {
        double sum = 0;
        for (size_t b = 0; b < blocks; b++)
            sum += b == without ? 0 : motion->squares[b * (lags + 1) + lag];
        curve->msd[lag - 1] = sum / (used * (double)motion->each);
        curve->time[lag - 1] = (double)lag * (double)motion->plan.every * motion->time_step;
    }
}

static void find_numbers(const struct law *law, double number[3]) {
    number[0] = isnan(law->turning) ? NAN : sqrt(fmax(0, law->square_speed));
    number[1] = law->turning;
    number[2] = law->diffusion + law->square_speed / (2 * law->turning);
}

/// The pseudo-values of M. H. Quenouille (Biometrika 43, 353 (1956)) are a series like any other.
static void find_errors(const struct motion *motion, size_t blocks, struct displacements *curve,
                        const double number[3], double error[3]) {
    double series[3][MAX_BLOCKS], part[3];
    for (size_t b = 0; b < blocks; b++) {
        take_curve(motion, blocks, b, curve);
        const struct law law = fit_law(curve);
        find_numbers(&law, part);
        for (int n = 0; n < 3; n++)
            series[n][b] = (double)blocks * number[n] - ((double)blocks - 1) * part[n];
    }
    for (int n = 0; n < 3; n++)
        error[n] = mf_statistics_correlated_error(series[n], blocks, 1);
}

struct polarity_fit mf_polarity_fit(const struct polarity *polarity) {
    const struct motion *motion = &polarity->motion;
    const size_t blocks = mf_motion_blocks(motion), lags = (size_t)motion->plan.lags;
    double number[3] = {NAN, NAN, NAN}, error[3] = {NAN, NAN, NAN};
    double *memory = mf_memory_zeroed(4 * lags, sizeof *memory);
    if (memory && blocks >= 2) {
        struct displacements curve = {lags, memory, memory + lags, memory + 2 * lags,
                                      memory + 3 * lags};
        take_curve(motion, blocks, blocks, &curve);
        const struct law law = fit_law(&curve);
        find_numbers(&law, number);
        find_errors(motion, blocks, &curve, number, error);
    }
    mf_memory_free(memory);
    return (struct polarity_fit){number[0], error[0], number[1], error[1], number[2], error[2]};
}

// Sampling ----------------------------------------------------------------------------------------

/// Whether nothing but self-propulsion acts.
static bool is_noninteracting(const struct simulation_setup *setup) {
    bool noninteracting = setup->potential == NULL;
    for (int k = 0; k < setup->interactions; k++)
        noninteracting = noninteracting && setup->interaction[k].kind == &mf_self_propulsion;
    return noninteracting;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct polarity *polarity = state;
    const int64_t steps = plan->samples * plan->every;
    if (mf_orientation_of(&simulation->particles).angle == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "polarity: particles have no orientations; add "
                                                "\"self-propulsion\" to \"interactions\"");
    TRY(mf_motion_init(&polarity->motion, settings, simulation, plan->equilibration, steps));
    polarity->motion.polar = true;
    polarity->order.columns = 1;
    polarity->noninteracting = is_noninteracting(&simulation->setup);
    polarity->free = mf_brownian_free(&simulation->setup);
    return STATUS_OK;
}

static void clear(void *state) {
    struct polarity *polarity = state;
    mf_motion_clear(&polarity->motion);
    mf_sample_series_clear(&polarity->order);
    *polarity = (struct polarity){0};
}

static int64_t due(const void *state) {
    return mf_motion_due(&((const struct polarity *)state)->motion);
}

/// By ids, so that the sum is the same for any order of the particles.
static double find_order(const struct motion *motion) {
    const double *c = motion->now + 2 * motion->count, *s = c + motion->count;
    double sum[2] = {0};
    for (size_t k = 0; k < motion->count; k++) {
        sum[0] += c[k];
        sum[1] += s[k];
    }
    return hypot(sum[0], sum[1]) / (double)motion->count;
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct polarity *polarity = state;
    mf_motion_sample(&polarity->motion, simulation);
    const double order = find_order(&polarity->motion);
    return mf_sample_series_add(&polarity->order, &order);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct polarity *polarity = state;
    const size_t n = mf_sample_series_spans(&polarity->order, spans);
    return n + mf_motion_spans(&polarity->motion, spans + n);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct polarity *)state)->order);
}

static const double *orders_of(const struct polarity *polarity) {
    return sample_series_column(&polarity->order, 0);
}

// Results -----------------------------------------------------------------------------------------

static double interval(const struct motion *motion) {
    return (double)motion->plan.every * motion->time_step;
}

/// polarity.tsv: time, correlation and MSD with their errors, and what they are for a particle
/// alone if that is known.
static enum status write_curves(const struct polarity *polarity,
                                const struct observable_results *results) {
    const struct motion *motion = &polarity->motion;
    const size_t rows = (size_t)motion->plan.lags + 1;
    OWNED double *values = NULL;
    TRY_ARRAY(values, 7 * rows);
    double *time = values + 4 * rows, *exact = time + rows, *exact_msd = exact + rows;
    const struct motion_curves curves = {values, values + rows, values + 2 * rows,
                                         values + 3 * rows};
    mf_motion_result(motion, &curves);
    mf_statistics_mark_unknown_errors(curves.msd_error, rows);
    mf_statistics_mark_unknown_errors(curves.vacf_error, rows);
    for (size_t k = 0; k < rows; k++) {
        time[k] = (double)k * interval(motion);
        exact[k] = exp(-polarity->free.orientation_diffusion * time[k]);
        exact_msd[k] = mf_brownian_free_msd(&polarity->free, time[k]);
    }
    const struct data_column columns[] = {{"time[tau]", time, NULL},
                                          {"correlation[1]", curves.vacf, "%.8g"},
                                          {"correlation_error[1]", curves.vacf_error, "%.3g"},
                                          {"msd[lambda^2]", curves.msd, "%.8g"},
                                          {"msd_error[lambda^2]", curves.msd_error, "%.3g"},
                                          {"correlation_theory[1]", exact, "%.8g"},
                                          {"msd_theory[lambda^2]", exact_msd, "%.8g"}};
    return mf_observable_table(results, "polarity.tsv", columns, polarity->noninteracting ? 7 : 5,
                               rows);
}

static enum status write(const void *state, const struct observable_results *results) {
    const struct polarity *polarity = state;
    const struct motion *motion = &polarity->motion;
    OWNED double *time = NULL;
    TRY_ARRAY(time, motion->samples);
    for (size_t k = 0; k < motion->samples; k++)
        time[k] = (double)motion->begin * motion->time_step + (double)k * interval(motion);
    const struct data_column columns[] = {{"time[tau]", time, NULL},
                                          {"order[1]", orders_of(polarity), "%.8g"}};
    TRY(mf_observable_table(results, "polar_order.tsv", columns, 2, motion->samples));
    return write_curves(polarity, results);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct polarity *polarity = state;
    const struct polarity_fit fit = mf_polarity_fit(polarity);
    double error, order = mf_sample_series_mean(&polarity->order, 0, &error);
    (void)results;
    mf_json_put_measured(writer, "polar_order", "1", order, error);
    mf_json_write_number(writer, "polar_order_last",
                         orders_of(polarity)[polarity->order.count - 1]);
    mf_json_put_measured(writer, "effective_diffusion", "lambda^2/tau", fit.effective_diffusion,
                         fit.effective_diffusion_error);
    if (polarity->noninteracting)
        mf_json_write_quantity(writer, "effective_diffusion_theory", "lambda^2/tau",
                               mf_brownian_free_long_time(&polarity->free));
    mf_json_put_measured(writer, "msd_speed", "lambda/tau", fit.speed, fit.speed_error);
    mf_json_put_measured(writer, "msd_orientation_diffusion", "1/tau", fit.orientation_diffusion,
                         fit.orientation_diffusion_error);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct polarity *polarity = state;
    const struct polarity_fit fit = mf_polarity_fit(polarity);
    char order[NUMBER_TEXT_SIZE], diffusion[UNITS_MEASURED_SIZE];
    double error;
    const double mean = mf_sample_series_mean(&polarity->order, 0, &error);
    mf_number_text(mean, error, order);
    mf_units_measured(results->units, "lambda^2/tau", fit.effective_diffusion,
                      fit.effective_diffusion_error, diffusion);
    if (isfinite(fit.effective_diffusion)) // the MSD of those that fly together has no such law
        snprintf(line, size, "polar order %s, effective diffusion %s", order, diffusion);
    else
        snprintf(line, size, "polar order %s", order);
}

/// The correlation on the line between the two nearest lags; NaN beyond the last.
static double read_at(const struct motion *motion, const double *curve, double time) {
    const double place = time / interval(motion), rounding = 1e-6;
    const double last = (double)motion->plan.lags;
    if (!(place >= -rounding) || place > last + rounding)
        return NAN;
    const size_t lag = (size_t)fmin(fmax(place, 0), last - 1);
    const double part = place - (double)lag;
    return (1 - part) * curve[lag] + part * curve[lag + 1];
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct polarity *polarity = state;
    const struct motion *motion = &polarity->motion;
    const size_t times = (size_t)motion->plan.lags + 1;
    OWNED double *curve = NULL;
    double error, order = mf_sample_series_mean(&polarity->order, 0, &error);
    TRY_ARRAY(curve, 4 * times);
    const struct motion_curves curves = {curve, curve + times, curve + 2 * times,
                                         curve + 3 * times};
    mf_motion_result(motion, &curves);
    for (size_t n = 0; n < values->count; n++) {
        values->value[n] = read_at(motion, curves.vacf, values->x[n]);
        values->error[n] = read_at(motion, curves.vacf_error, values->x[n]);
    }
    mf_pooled_set(&values[1], &order, &error);
    *blocks = (double)mf_motion_blocks(motion);
    return STATUS_OK;
}

// Record ------------------------------------------------------------------------------------------

/// Nanoseconds of a particle and sample, and of each of its time origins.
static const double gather_cost = 25, correlate_cost = 1.3;

static void explain(const void *settings, const struct simulation_setup *setup,
                    double samples_every, struct stages *stages) {
    const struct motion_plan *plan = settings;
    const double every = (double)plan->every;
    const double origins = (double)plan->lags / (double)plan->origin_every + 1;
    (void)setup, (void)samples_every;
    mf_stages_add(stages, "polarity", true, (gather_cost + correlate_cost * origins) / every,
                  "%.0f time origins, one step in %.0f", origins, every);
}

static const struct observable_target targets[] = {
    {.name = "polarity_correlation",
     .summary = "<n(t).n(0)>, persistence of directions",
     .form = OBSERVABLE_CURVE,
     .argument = "time[tau]",
     .unit = "1",
     .has_settings = true},
    {.name = "polar_order",
     .summary = "|<n>|, averaged over time",
     .form = OBSERVABLE_NUMBER,
     .has_settings = true},
    {.name = NULL}};
static const char *const files[] = {"polarity.tsv", "polar_order.tsv", NULL};

const struct observable mf_polarity_observable = {
    .name = "polarity",
    .summary = "order, persistence and distribution of directions",
    .of_time = true,
    .fields = mf_motion_plan_fields,
    .settings_size = sizeof(struct motion_plan),
    .state_size = sizeof(struct polarity),
    .begin = begin,
    .clear = clear,
    .due = due,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "polarity",
    .files = files,
    .figure = "polarity",
    .targets = targets,
    .result = result,
};
