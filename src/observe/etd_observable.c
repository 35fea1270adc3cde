// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/data_table.h"
#include "observe/etd.h"
#include "observe/measure.h"

#include <math.h>

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    const struct etd_settings *s = settings;
    return mf_etd_init(state, &s->grid, &s->plan, simulation, plan->equilibration,
                       plan->samples * plan->every);
}

static void clear(void *state) {
    mf_etd_clear(state);
}

static int64_t due(const void *state) {
    return mf_etd_due(state);
}

static enum status sample(void *state, const struct configuration *configuration) {
    return mf_etd_sample(state, configuration);
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_etd_spans(state, spans);
}

static enum status reserve(void *state) {
    return mf_etd_reserve(state);
}

// Tables ------------------------------------------------------------------------------------------

static double centre(const struct etd_grid *grid, size_t bin) {
    const double width = (grid->r_maximum - grid->r_minimum) / (double)grid->bins;
    return grid->r_minimum + width * ((double)bin + 0.5);
}

/// Time between samples [τ].
static double interval(const struct etd *etd, const struct observable_results *results) {
    return (double)etd->plan.every * results->setup->time_step;
}

/// Times, then a column for each bin of the matrix `values`, shape [times, bins].
static enum status write_matrix(const struct etd *etd, const struct observable_results *results,
                                const char *file, const char *what, const double *values,
                                const char *format) {
    const size_t times = (size_t)etd->grid.times, bins = (size_t)etd->grid.bins;
    const double length = mf_units_factor(results->units, "lambda");
    OWNED double *columns = NULL;
    OWNED struct data_column *column = NULL;
    OWNED char(*name)[48] = NULL;
    TRY_ARRAY(columns, (bins + 1) * times);
    TRY_ARRAY(column, bins + 1);
    TRY_ARRAY(name, bins + 1);
    for (size_t k = 0; k <= bins; k++) {
        column[k] = (struct data_column){name[k], columns + k * times, k ? format : NULL};
        snprintf(name[k], sizeof *name, k ? "%s(r0=%.6g)[1]" : "time[tau]", what,
                 k ? length * centre(&etd->grid, k - 1) : 0);
        for (size_t t = 0; t < times; t++)
            columns[k * times + t] =
                k ? values[t * bins + k - 1] : (double)t * interval(etd, results);
    }
    return mf_observable_table(results, file, column, bins + 1, times);
}

static enum status write_bins(const struct etd *etd, const struct observable_results *results,
                              const uint64_t *pairs) {
    const size_t bins = (size_t)etd->grid.bins;
    OWNED double *r = NULL, *n = NULL;
    TRY_ARRAY(r, bins);
    TRY_ARRAY(n, bins);
    for (size_t k = 0; k < bins; k++) {
        r[k] = centre(&etd->grid, k);
        n[k] = (double)pairs[k];
    }
    const struct data_column columns[] = {{"r0[lambda]", r, NULL}, {"pairs[1]", n, "%.0f"}};
    return mf_observable_table(results, "etd_bins.tsv", columns, 2, bins);
}

/// Tables without a number are not written, and a warning says so.
static enum status assess(const void *state, const struct simulation_setup *setup) {
    const struct etd *etd = state;
    (void)setup;
    return mf_etd_pairs(etd) > 0
               ? STATUS_OK
               : mf_status_fail(STATUS_UNCONVERGED,
                                "there are no escape times: no pair was between %.4g" STATUS_LENGTH
                                " and %.4g" STATUS_LENGTH " at "
                                "an origin",
                                etd->grid.r_minimum, etd->grid.r_maximum);
}

/// etd.tsv and etd_error.tsv: time, then E or its standard error for each bin of r_0, nan where no
/// pair began; and etd_bins.tsv: r_0, pairs.
static enum status write(const void *state, const struct observable_results *results) {
    const struct etd *etd = state;
    OWNED double *survival = NULL, *error = NULL;
    OWNED uint64_t *pairs = NULL;
    if (mf_etd_pairs(etd) == 0)
        return STATUS_OK;
    TRY_ARRAY(survival, etd_cells(etd));
    TRY_ARRAY(error, etd_cells(etd));
    TRY_ARRAY(pairs, (size_t)etd->grid.bins);
    TRY(mf_etd_result(&etd, 1, survival, error, pairs));
    TRY(write_matrix(etd, results, "etd.tsv", "E", survival, "%.8g"));
    TRY(write_matrix(etd, results, "etd_error.tsv", "E_error", error, "%.3g"));
    return write_bins(etd, results, pairs);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct etd *etd = state;
    mf_json_begin(writer, "etd");
    mf_json_write_integer(writer, "origins", (int64_t)mf_etd_complete(etd));
    mf_json_write_integer(writer, "pairs", (int64_t)mf_etd_pairs(etd));
    mf_json_write_quantity(writer, "interval", "tau", interval(etd, results));
    mf_json_end(writer);
}

/// Nanoseconds of a particle and sample; of a pair and sample, and of one at an origin.
static const double gather_cost = 4, follow_cost = 2.4, begin_cost = 30;

/// Pairs that a search looks at for one within r: 5³ cells of r/2, over a ball.
static const double looked_at = 3.7;

static void explain(const void *settings, const struct simulation_setup *setup,
                    double samples_every, struct stages *stages) {
    (void)samples_every;
    const struct etd_settings *s = settings;
    const double every = (double)s->plan.every, origin_every = (double)s->plan.origin_every;
    const double r = s->grid.r_maximum;
    char text[STAGES_LENGTH_SIZE];
    const double pairs = mf_stages_pairs_within(setup, r);
    const double search = mf_stages_cost.sort + looked_at * mf_stages_cost.go_through * pairs;
    const double origin = (search + begin_cost * pairs) / origin_every;
    mf_stages_add(stages, "escape times", true,
                  (gather_cost + follow_cost * pairs + origin) / every,
                  "%.0f pairs a particle within %s, one step in %.0f; an origin in %.0f", pairs,
                  mf_stages_length(stages, r, 6, text), every, origin_every * every);
}

/// Values have the shape [times, bins] of the grid.
static enum status result_of_all(const void *const *states, size_t count,
                                 const struct observable_values *values) {
    const struct etd *const *etd = (const struct etd *const *)states;
    TRY(mf_etd_result(etd, count, values->value, values->error, NULL));
    for (size_t k = 0; values->freedom && k < count; k++)
        *values->freedom += (double)etd[k]->blocks - (k == 0);
    // At time 0 all are there: no measurement.
    for (size_t k = 0; k < (size_t)etd[0]->grid.bins; k++)
        values->value[k] = NAN;
    return STATUS_OK;
}

static const struct observable_target targets[] = {
    {.name = "etd", .summary = "escape times of pairs", .form = OBSERVABLE_OWN_FORM},
    {.name = NULL}};

static const char *const files[] = {"etd.tsv", "etd_error.tsv", "etd_bins.tsv", NULL};

const struct observable mf_etd_observable = {
    .name = "etd",
    .summary = "escape times of pairs",
    .of_time = true,
    .fields = mf_etd_fields,
    .settings_size = sizeof(struct etd_settings),
    .state_size = sizeof(struct etd),
    .begin = begin,
    .clear = clear,
    .due = due,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .assess = assess,
    .write_summary = write_summary,
    .explain = explain,
    .stage = "escape times",
    .files = files,
    .figure = "etd",
    .targets = targets,
    .result_of_all = result_of_all,
};

/// Pairs of one bin: begun, and escaped by some time.
struct tally {
    double begun, escaped;
};

static double survived(struct tally tally) {
    return 1 - tally.escaped / tally.begun;
}

/// Standard error of what has survived of n independent pairs; if all or none have, the end of
/// Wilson's interval of one standard deviation, where n p² = p (1 − p).
static double find_error_of_pairs(struct tally sum) {
    if (sum.escaped == 0 || sum.escaped == sum.begun)
        return 1 / (sum.begun + 1);
    return sqrt(survived(sum) * (1 - survived(sum)) / sum.begun);
}

/// Spread of a jackknife that is but rounding.
static const double no_spread = 1e-12;

/// Standard error of what has survived of the sum of `count` blocks.
static double find_error(const struct tally *blocks, size_t count, struct tally sum) {
    double filled = 0, changes = 0, squares = 0;
    for (size_t b = 0; b < count; b++) {
        if (blocks[b].begun == 0 || blocks[b].begun == sum.begun)
            continue;
        const struct tally without = {sum.begun - blocks[b].begun, sum.escaped - blocks[b].escaped};
        const double change = survived(without) - survived(sum);
        filled++;
        changes += change;
        squares += change * change;
    }
    if (filled < 3)
        return find_error_of_pairs(sum);
    const double error =
        sqrt(fmax(0, squares - changes * changes / filled) * (filled - 1) / filled);
    return error > no_spread ? error : find_error_of_pairs(sum);
}

/// Go on to the next time: the pairs of a bin that are begun at time 0 or escape at a later one.
static struct tally advance(const struct etd *const *replicas, size_t count, size_t time,
                            size_t bin, struct tally *blocks) {
    struct tally sum = {0, 0};
    size_t b = 0;
    for (size_t r = 0; r < count; r++)
        for (size_t block = 0; block < replicas[r]->blocks; block++, b++) {
            const size_t cell = time * (size_t)replicas[r]->grid.bins + bin;
            const double here = (double)replicas[r]->counts[block * etd_cells(replicas[r]) + cell];
            if (time == 0)
                blocks[b] = (struct tally){here, 0};
            else
                blocks[b].escaped += here;
            sum.begun += blocks[b].begun;
            sum.escaped += blocks[b].escaped;
        }
    return sum;
}

enum status mf_etd_result(const struct etd *const *replicas, size_t count, double *survival,
                          double *error, uint64_t *pairs) {
    const size_t times = (size_t)replicas[0]->grid.times, bins = (size_t)replicas[0]->grid.bins;
    size_t block_count = 0;
    OWNED struct tally *blocks = NULL;
    for (size_t r = 0; r < count; r++)
        block_count += replicas[r]->blocks;
    TRY_ARRAY(blocks, block_count);
    for (size_t bin = 0; bin < bins; bin++)
        for (size_t time = 0; time < times; time++) {
            const struct tally sum = advance(replicas, count, time, bin, blocks);
            const bool known = sum.begun > 0;
            survival[time * bins + bin] = known ? survived(sum) : NAN;
            if (error)
                error[time * bins + bin] = !known      ? NAN
                                           : time == 0 ? 0 // E(0) is 1 by definition
                                                       : find_error(blocks, block_count, sum);
            if (pairs)
                pairs[bin] = (uint64_t)sum.begun;
        }
    return STATUS_OK;
}
