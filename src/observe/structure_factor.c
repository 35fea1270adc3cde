// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/structure_factor.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "observe/sample_blocks.h"

#include <math.h>
#include <string.h>

enum { MAX_BLOCKS = 64 };

/// Prepare for `planned` samples of such waves; 0: for as many as there will be.
static enum status structure_factor_init(struct structure_factor *factor,
                                         const struct density_waves_plan *plan, size_t planned) {
    const struct composition *const composition = &plan->composition;
    *factor = (struct structure_factor){
        .composition = *composition,
        .curves =
            composition_is_mixed(composition) ? 1 + (size_t)mf_composition_pairs(composition) : 1,
        .bins = plan->bins,
        .endless = planned == 0};
    factor->each = planned > 0 ? (planned + MAX_BLOCKS - 1) / MAX_BLOCKS : 1;
    factor->blocks = planned > 0 ? planned / factor->each : MAX_BLOCKS;
    TRY_ARRAY(factor->sums, factor->blocks * mf_structure_factor_numbers(factor));
    return STATUS_OK;
}

static void structure_factor_clear(struct structure_factor *factor) {
    mf_memory_free(factor->sums);
    *factor = (struct structure_factor){0};
}

size_t mf_structure_factor_numbers(const struct structure_factor *factor) {
    return (factor->curves + 2) * factor->bins;
}

// Samples -----------------------------------------------------------------------------------------

/// What a sample has.
static void take(const struct density_waves *waves, double *numbers) {
    const size_t bins = waves->plan.bins;
    memset(numbers, 0, waves->curves * bins * sizeof *numbers);
    mf_density_waves_add(waves, numbers);
    memcpy(numbers + waves->curves * bins, waves->q, bins * sizeof *numbers);
    memcpy(numbers + (waves->curves + 1) * bins, waves->members, bins * sizeof *numbers);
}

/// Add a sample of waves whose ρ are found; beyond those planned it is left out.
/// @param[out] numbers  as many as said above
static void structure_factor_add(struct structure_factor *factor, const struct density_waves *waves,
                                 double *numbers) {
    const size_t count = mf_structure_factor_numbers(factor);
    take(waves, numbers);
    if (factor->endless && factor->samples == factor->blocks * factor->each) {
        mf_sample_blocks_join(factor->sums, factor->blocks, count);
        factor->each *= 2;
    }
    const size_t block = factor->samples++ / factor->each;
    if (block >= factor->blocks)
        return;
    for (size_t k = 0; k < count; k++)
        factor->sums[block * count + k] += numbers[k];
}

// Results -----------------------------------------------------------------------------------------

/// Blocks that are complete: what errors rest on.
static size_t structure_factor_blocks(const struct structure_factor *factor) {
    const size_t blocks = factor->samples / factor->each;
    return blocks < factor->blocks ? blocks : factor->blocks;
}

/// One of the numbers of a bin, in one block.
static double sum_at(const struct structure_factor *factor, size_t block, size_t row, size_t bin) {
    return factor->sums[block * mf_structure_factor_numbers(factor) + row * factor->bins + bin];
}

/// The mean over all waves and samples, and the error by the means of those blocks that have any
/// wave: where the box changes, a bin may have none at times.
static void find_point(const struct structure_factor *factor, size_t curve, size_t bin,
                       double *value, double *error) {
    const size_t blocks = structure_factor_blocks(factor);
    double means[MAX_BLOCKS], sum = 0, all = 0;
    size_t count = 0;
    for (size_t b = 0; b < blocks; b++) {
        const double members = sum_at(factor, b, factor->curves + 1, bin);
        if (!(members > 0))
            continue;
        sum += sum_at(factor, b, curve, bin);
        all += members;
        means[count++] = sum_at(factor, b, curve, bin) / members;
    }
    *value = all > 0 ? sum / all : NAN;
    *error = mf_statistics_correlated_error(means, count, 1);
}

enum status mf_structure_factor_find(const struct structure_factor *factor,
                                     struct structure_factor_curves *curves) {
    enum status status = STATUS_OK;
    const size_t blocks = structure_factor_blocks(factor);
    size_t kept = 0;
    *curves = (struct structure_factor_curves){0};
    NEW_ARRAY(curves->q, factor->bins);
    NEW_ARRAY(curves->members, factor->bins);
    NEW_ARRAY(curves->value, factor->curves * factor->bins);
    NEW_ARRAY(curves->error, factor->curves * factor->bins);
    for (size_t bin = 0; bin < factor->bins; bin++) {
        double q = 0, members = 0;
        // A block that is not complete says where the waves are if there is no other.
        for (size_t b = 0; b < (blocks > 0 ? blocks : 1); b++) {
            q += sum_at(factor, b, factor->curves, bin);
            members += sum_at(factor, b, factor->curves + 1, bin);
        }
        if (!(members > 0))
            continue;
        const size_t samples =
            factor->samples < factor->each ? factor->samples : blocks * factor->each;
        curves->q[kept] = q / members;
        curves->members[kept] = members / (double)samples;
        for (size_t curve = 0; curve < factor->curves; curve++) {
            const size_t at = curve * factor->bins + kept;
            find_point(factor, curve, bin, &curves->value[at], &curves->error[at]);
        }
        kept++;
    }
    curves->bins = kept;
done:
    if (status != STATUS_OK)
        mf_structure_factor_curves_clear(curves);
    return status;
}

void mf_structure_factor_curves_clear(struct structure_factor_curves *curves) {
    mf_memory_free(curves->q);
    mf_memory_free(curves->members);
    mf_memory_free(curves->value);
    mf_memory_free(curves->error);
    *curves = (struct structure_factor_curves){0};
}

/// structure_factor.tsv: q, S with its error, in a mixture those of each pair type, and how many
/// waves there are, of q and −q one. Fails: IO, NO_MEMORY.
static enum status structure_factor_write(const struct structure_factor *factor,
                                          const struct observable_results *results) {
    CLEARED_BY(mf_structure_factor_curves_clear) struct structure_factor_curves curves = {0};
    struct data_column columns[2 + 2 * (1 + COMPOSITION_MAX_PAIRS)];
    static const char *const beside[sizeof columns / sizeof *columns] = {"%.10g"};
    char names[2 * (1 + COMPOSITION_MAX_PAIRS)][COMPOSITION_PAIR_NAME_SIZE + 16];
    char path[OUTPUT_PATH_SIZE];
    size_t n = 0;
    TRY(mf_structure_factor_find(factor, &curves));
    columns[n++] = (struct data_column){"q[1/lambda]", curves.q, NULL};
    for (size_t curve = 0; curve < factor->curves; curve++) {
        char pair[COMPOSITION_PAIR_NAME_SIZE] = "", brackets[COMPOSITION_PAIR_NAME_SIZE + 2] = "";
        double *const value = curves.value + curve * factor->bins, *const error =
                                                                       curves.error +
                                                                       curve * factor->bins;
        mf_statistics_mark_unknown_errors(error, curves.bins);
        if (curve > 0) {
            mf_composition_pair_name(&factor->composition, (int)curve - 1, pair);
            snprintf(brackets, sizeof brackets, "(%s)", pair);
        }
        snprintf(names[2 * curve], sizeof *names, "S%s[1]", brackets);
        snprintf(names[2 * curve + 1], sizeof *names, "S_error%s[1]", brackets);
        columns[n++] = (struct data_column){names[2 * curve], value, "%.8g"};
        columns[n++] = (struct data_column){names[2 * curve + 1], error, "%.3g"};
    }
    columns[n++] = (struct data_column){"vectors[1]", curves.members, "%.7g"};
    mf_observable_file(results, "structure_factor.tsv", path);
    return mf_data_table_write_beside(path, results->units, NULL, columns, beside, n, curves.bins);
}

static const double pi = 3.14159265358979323846;

#define MEMBER(name) .offset = offsetof(struct structure_factor_settings, name)
static const struct field fields[] = {
    {"q_maximum", FIELD_NUMBER, MEMBER(q_maximum), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "1/lambda",
     .help = "largest wave number; the cost grows as its cube"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "bins from 0"},
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
    CHECK(structure_factor_init(&s->factor, &waves, (size_t)plan->samples));
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
    structure_factor_clear(&s->factor);
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
    structure_factor_add(&s->factor, &s->waves, s->numbers);
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
    return structure_factor_write(&((const struct structure_factor_state *)state)->factor, results);
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
    *blocks = (double)structure_factor_blocks(factor);
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
