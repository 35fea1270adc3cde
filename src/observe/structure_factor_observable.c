// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The static structure factor of beads as an observable. Only vectors of the box obey its
/// periodicity, so that nothing is cut off, and S of the smallest tells the compressibility: S(0) =
/// ρ k_B T κ_T of one component. The same bits for any number of threads. Tested:
/// test_structure_factor (unit, cli), test_density_waves.
#include "base/memory.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "observe/structure_factor.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

#define MEMBER(name) .offset = offsetof(struct structure_factor_settings, name)
static const struct field fields[] = {
    {"q_maximum", FIELD_NUMBER, MEMBER(q_maximum), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "1/lambda",
     .help = "largest wave number; the cost grows as its cube"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "number of bins from 0"},
    {"waves", FIELD_INTEGER, MEMBER(waves), .initial = 0, .minimum = 0, .maximum = 1e6, .unit = "",
     .help = "most waves of a bin, evenly chosen of more; 0: all"},
    FIELD_END,
};

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    enum status status = STATUS_OK;
    struct structure_factor_state *s = state;
    const struct structure_factor_settings *const wish = settings;
    const struct density_waves_plan waves = {.composition = mf_configuration_types(configuration),
                                             .q_maximum = wish->q_maximum,
                                             .bins = (size_t)wish->bins,
                                             .max = (size_t)wish->waves};
    CHECK(mf_density_waves_init(&s->waves, &waves));
    CHECK(mf_structure_factor_init(&s->factor, &waves, (size_t)plan->samples));
    for (int d = 0; d < configuration->dimensions; d++)
        NEW_ARRAY(s->share[d], configuration->count);
    NEW_ARRAY(s->numbers, mf_structure_factor_numbers(&s->factor));
    if (configuration->simulation) // whose box stays; whoever reads frames says which one it is
        status = mf_density_waves_list(&s->waves, &configuration->box);
    CHECK(status == STATUS_BAD_INPUT ? mf_status_prefix(status, "structure_factor") : status);
done:
    return status;
}

static void clear(void *state) {
    struct structure_factor_state *s = state;
    mf_density_waves_clear(&s->waves);
    mf_structure_factor_clear(&s->factor);
    for (int d = 0; d < 3; d++)
        mf_memory_free(s->share[d]);
    mf_memory_free(s->numbers);
    *s = (struct structure_factor_state){0};
}

/// The box may have changed.
static enum status sample(void *state, const struct configuration *configuration) {
    struct structure_factor_state *s = state;
    struct density_places places = {{NULL}, {0}};
    TRY(mf_density_waves_list(&s->waves, &configuration->box));
    for (int d = 0; d < configuration->dimensions; d++) {
        mf_configuration_shares(configuration, d, s->share[d]);
        places.place[d] = s->share[d];
        places.unit[d] = 2 * pi;
    }
    mf_density_waves_find(&s->waves, &places, configuration->threads);
    mf_structure_factor_add(&s->factor, &s->waves, s->numbers);
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct structure_factor *const factor = &((struct structure_factor_state *)state)->factor;
    spans[0] = (struct memory_span){&factor->samples, sizeof factor->samples};
    spans[1] = (struct memory_span){
        factor->sums, factor->blocks * mf_structure_factor_numbers(factor) * sizeof *factor->sums};
    return 2;
}

static enum status write(const void *state, const struct observable_results *results) {
    return mf_structure_factor_write(&((const struct structure_factor_state *)state)->factor,
                                     results);
}

/// S at a wave number, on the line between the two nearest that were measured; NaN beyond them.
static void read_at(const struct structure_factor_curves *s, double q, double *value,
                    double *value_error) {
    const double rounding = 1e-4 * q; // of a table
    size_t k = 0;
    *value = *value_error = NAN;
    if (s->bins == 0 || !(q >= s->q[0] - rounding) || q > s->q[s->bins - 1] + rounding)
        return;
    while (k + 2 < s->bins && s->q[k + 1] <= q)
        k++;
    const size_t next = k + 1 < s->bins ? k + 1 : k;
    const double width = next > k ? s->q[next] - s->q[k] : 1;
    const double part = fmin(fmax((q - s->q[k]) / width, 0), 1);
    *value = (1 - part) * s->value[k] + part * s->value[next];
    *value_error = hypot((1 - part) * s->error[k], part * s->error[next]);
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct structure_factor *const factor =
        &((const struct structure_factor_state *)state)->factor;
    CLEARED_BY(mf_structure_factor_curves_clear) struct structure_factor_curves curves = {0};
    TRY(mf_structure_factor_find(factor, &curves));
    for (size_t n = 0; n < values->count; n++)
        read_at(&curves, values->x[n], &values->value[n], &values->error[n]);
    *blocks = (double)mf_structure_factor_blocks(factor);
    return STATUS_OK;
}

// Record ------------------------------------------------------------------------------------------

/// Nanoseconds of a particle and wave vector.
static const double wave_cost = 1.1;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const struct structure_factor_settings *s = settings;
    const double ball = mf_box_shell_volume(&setup->box, 0, s->q_maximum);
    const double all = ball * mf_box_volume(&setup->box) / pow(2 * pi, setup->box.dimensions) / 2;
    const double waves = s->waves > 0 ? fmin(all, (double)(s->waves * s->bins)) : all;
    mf_stages_add(stages, "structure factor", true, wave_cost * waves / every,
                  "about %.0f wave vectors, one step in %.0f", waves, every);
}

static const struct observable_target targets[] = {{.name = "structure_factor",
                                                    .summary = "S(q) of all beads",
                                                    .form = OBSERVABLE_CURVE,
                                                    .argument = "q[1/lambda]",
                                                    .unit = "1",
                                                    .has_settings = true},
                                                   {.name = NULL}};
static const char *const files[] = {"structure_factor.tsv", NULL};

const struct observable mf_structure_factor = {
    .name = "structure_factor",
    .of_places = true,
    .summary = "S(q) at the wave vectors of the box",
    .fields = fields,
    .settings_size = sizeof(struct structure_factor_settings),
    .state_size = sizeof(struct structure_factor_state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "structure factor",
    .files = files,
    .figure = OBSERVABLE_FIGURE_OF_CURVE,
    .targets = targets,
    .result = result,
};
