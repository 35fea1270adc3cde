// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/data_table.h"
#include "observe/force_covariance.h"
#include "observe/measure.h"

#include <math.h>

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    return mf_force_covariance_init(state, settings, simulation, (size_t)plan->samples);
}

static void clear(void *state) {
    mf_force_covariance_clear(state);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    mf_force_covariance_sample(state, simulation);
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_force_covariance_spans(state, spans);
}

/// What κ is without a time step, 2 k_B T ω², as its mean over the area of the bin; NaN where pair
/// types differ.
static double exact_of(const struct simulation_setup *setup, double begin, double width) {
    enum { PARTS = 64 };
    double sum = 0, weight = 0;
    if (setup->omega->curves > 1)
        return NAN;
    for (int k = 0; k < PARTS; k++) {
        const double r = begin + width * (k + 0.5) / PARTS;
        double omega = 0;
        if (r < setup->omega->cutoff)
            mf_table_evaluate(setup->omega, r, &omega, NULL, NULL);
        sum += pow(r, setup->box.dimensions - 1) * omega * omega;
        weight += pow(r, setup->box.dimensions - 1);
    }
    return 2 * setup->temperature * sum / weight;
}

/// force_covariance.tsv: r, κ with its standard error, and what it is without a time step.
static enum status write(const void *state, const struct observable_results *results) {
    const struct force_covariance *covariance = state;
    const size_t bins = covariance->bins;
    OWNED double *values = NULL;
    TRY_ARRAY(values, 4 * bins);
    double *r = values, *kappa = r + bins, *error = kappa + bins, *exact = error + bins;
    mf_force_covariance_result(covariance, kappa, error);
    for (size_t k = 0; k < bins; k++) {
        r[k] = covariance->width * ((double)k + 0.5);
        exact[k] = exact_of(results->setup, covariance->width * (double)k, covariance->width);
    }
    const struct data_column columns[] = {{"r[lambda]", r, NULL},
                                          {"kappa[k_B.T_0.mu/tau]", kappa, "%.8g"},
                                          {"kappa_error[k_B.T_0.mu/tau]", error, "%.3g"},
                                          {"exact[k_B.T_0.mu/tau]", exact, "%.8g"}};
    return mf_observable_table(results, "force_covariance.tsv", columns, 4, bins);
}

/// κ at a distance, on the line between the centres of two bins; NaN beyond them.
static double read_at(const double *values, size_t bins, double width, double r) {
    const double place = r / width - 0.5, rounding = 1e-4; // of a table
    if (!(place >= -rounding) || place > (double)(bins - 1) + rounding)
        return NAN;
    const double inside = fmin(fmax(place, 0), (double)(bins - 1));
    const size_t k = (size_t)fmin(rint(inside), (double)(bins - 1));
    if (fabs(inside - (double)k) <= rounding)
        return values[k];
    const size_t left = (size_t)inside;
    const double part = inside - (double)left;
    return (1 - part) * values[left] + part * values[left + 1];
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct force_covariance *covariance = state;
    const size_t bins = covariance->bins;
    OWNED double *kappa = NULL, *error = NULL;
    TRY_ARRAY(kappa, bins);
    TRY_ARRAY(error, bins);
    mf_force_covariance_result(covariance, kappa, error);
    for (size_t n = 0; n < values->count; n++) {
        values->value[n] = read_at(kappa, bins, covariance->width, values->x[n]);
        values->error[n] = read_at(error, bins, covariance->width, values->x[n]);
    }
    *blocks = fmin((double)covariance->samples, FORCE_COVARIANCE_BLOCKS);
    return STATUS_OK;
}

/// Nanoseconds of a pair and sample.
static const double covary_cost = 3;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)settings;
    const double pairs = mf_stages_pairs_within(setup, mf_stages_cutoff(setup));
    mf_stages_add(stages, "force covariance", true, covary_cost * pairs / every, "one step in %.0f",
                  every);
}

static const struct observable_target targets[] = {{.name = "force_covariance",
                                                    .summary = "kappa(r)",
                                                    .form = OBSERVABLE_CURVE,
                                                    .argument = "r[lambda]",
                                                    .unit = "k_B T_0 mu/tau",
                                                    .has_settings = true},
                                                   {.name = NULL}};
static const char *const files[] = {"force_covariance.tsv", NULL};

const struct observable mf_force_covariance_observable = {
    .name = "force_covariance",
    .summary = "friction from the covariance of the forces",
    .of_time = true,
    .fields = mf_force_covariance_fields,
    .settings_size = sizeof(struct force_covariance_plan),
    .state_size = sizeof(struct force_covariance),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "force covariance",
    .files = files,
    .figure = "force_covariance",
    .targets = targets,
    .result = result,
};
