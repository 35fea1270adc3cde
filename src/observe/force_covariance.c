// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/force_covariance.h"

#include "io/data_table.h"
#include "observe/measure.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct force_covariance_plan, name)
static const struct field force_covariance_fields[] = {
    {"range", FIELD_NUMBER, MEMBER(range), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "range; 0: the cutoff of the friction weight"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 50, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "number of bins from r = 0"},
    FIELD_END,
};

static enum status check(const struct simulation *simulation, double range) {
    const struct simulation_setup *setup = &simulation->setup;
    if (setup->omega == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "force_covariance: the scene has no friction weight");
    if (setup->integrator->friction)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "force_covariance: \"%s\" splits friction and noise off the forces; use "
            "\"dynamics\": {\"integrator\": \"dpd-verlet\"}",
            setup->integrator->name);
    // A part in 10⁹ forgives a range that was rounded in another unit.
    if (range > mf_pair_cutoff(&simulation->law) * (1 + 1e-9))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "force_covariance: the range %g" STATUS_LENGTH
                              " exceeds %g" STATUS_LENGTH ", that of the forces",
                              range, mf_pair_cutoff(&simulation->law));
    return STATUS_OK;
}

enum status mf_force_covariance_init(struct force_covariance *covariance,
                                     const struct force_covariance_plan *plan,
                                     const struct simulation *simulation, size_t planned) {
    enum status status = STATUS_OK;
    const struct table *omega = simulation->setup.omega;
    const double range = plan->range > 0 || omega == NULL ? plan->range : omega->cutoff;
    *covariance = (struct force_covariance){.width = range / (double)plan->bins,
                                            .bins = (size_t)plan->bins,
                                            .time_step = simulation->setup.time_step};
    CHECK(check(simulation, range));
    CHECK(mf_sample_blocks_init(&covariance->blocks, planned, 2 * covariance->bins));
done:
    if (status != STATUS_OK)
        mf_force_covariance_clear(covariance);
    return status;
}

void mf_force_covariance_clear(struct force_covariance *covariance) {
    mf_sample_blocks_clear(&covariance->blocks);
    *covariance = (struct force_covariance){0};
}

static double distance(const struct particles *particles, size_t i, size_t j) {
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double x = particles->position[d][i] - particles->position[d][j];
        const double nearest = box_nearest(x, particles->box.length[d]);
        square += nearest * nearest;
    }
    return sqrt(square);
}

void mf_force_covariance_sample(struct force_covariance *covariance,
                                const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const struct neighbours *neighbours = &simulation->neighbours;
    double *const products = mf_sample_blocks_next(&covariance->blocks);
    double *const pairs = products + covariance->bins;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            const double place = distance(particles, i, j) / covariance->width;
            if (j == i || place >= (double)covariance->bins)
                continue;
            double product = 0;
            for (int d = 0; d < particles->box.dimensions; d++)
                product += particles->force[d][i] * particles->force[d][j];
            products[(size_t)place] += product;
            pairs[(size_t)place] += 1;
        }
}

/// Jackknife of a ratio of sums over blocks; blocks without pairs do not count.
static double find_error(const struct force_covariance *covariance, size_t bin, double products,
                         double pairs) {
    double filled = 0, changes = 0, squares = 0;
    for (size_t b = 0; b < covariance->blocks.count; b++) {
        const double *const own = covariance->blocks.sums + b * covariance->blocks.row;
        const double here = own[covariance->bins + bin];
        if (here == 0 || here == pairs)
            continue;
        const double without = products - own[bin];
        const double change = without / (pairs - here) - products / pairs;
        filled++;
        changes += change;
        squares += change * change;
    }
    if (filled < 2)
        return NAN;
    return sqrt(fmax(0, squares - changes * changes / filled) * (filled - 1) / filled);
}

void mf_force_covariance_result(const struct force_covariance *covariance, double *kappa,
                                double *error) {
    for (size_t bin = 0; bin < covariance->bins; bin++) {
        double products = 0, pairs = 0;
        for (size_t b = 0; b < covariance->blocks.count; b++) {
            const double *const own = covariance->blocks.sums + b * covariance->blocks.row;
            products += own[bin];
            pairs += own[covariance->bins + bin];
        }
        kappa[bin] = pairs > 0 ? -covariance->time_step * products / pairs : NAN;
        error[bin] = covariance->time_step * find_error(covariance, bin, products, pairs);
    }
}

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
    return mf_sample_blocks_spans(&((struct force_covariance *)state)->blocks, spans);
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
    *blocks = fmin((double)covariance->blocks.taken, (double)covariance->blocks.count);
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
    .fields = force_covariance_fields,
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
