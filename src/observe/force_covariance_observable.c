// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/data_table.h"
#include "observe/force_covariance.h"
#include "observe/measure.h"

static enum status begin(void *state, const void *settings, const struct simulation *simulation,
                         const struct measure_plan *plan) {
    return mf_force_covariance_init(state, settings, simulation, (size_t)plan->samples);
}

static void clear(void *state) {
    mf_force_covariance_clear(state);
}

static enum status sample(void *state, struct simulation *simulation) {
    mf_force_covariance_sample(state, simulation);
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_force_covariance_spans(state, spans);
}

/// force_covariance.tsv: r, κ with its standard error.
static enum status write(const void *state, const struct observable_results *results) {
    const struct force_covariance *covariance = state;
    const size_t bins = covariance->bins;
    OWNED double *values = NULL;
    TRY_ARRAY(values, 3 * bins);
    double *r = values, *kappa = r + bins, *error = kappa + bins;
    mf_force_covariance_result(covariance, kappa, error);
    for (size_t k = 0; k < bins; k++)
        r[k] = covariance->width * ((double)k + 0.5);
    const struct data_column columns[] = {{"r[lambda]", r, NULL},
                                          {"kappa[k_B.T_0.mu/tau]", kappa, "%.8g"},
                                          {"kappa_error[k_B.T_0.mu/tau]", error, "%.3g"}};
    return mf_observable_table(results, "force_covariance.tsv", columns, 3, bins);
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
};
