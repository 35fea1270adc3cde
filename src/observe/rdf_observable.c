// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/rdf_observable.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "forces/many_body.h"
#include "io/data_table.h"
#include "observe/bound_pairs.h"
#include "observe/measure.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct rdf_settings, name)
static const struct field fields[] = {
    {"range", FIELD_NUMBER, MEMBER(range), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "range of g(r); 0: the cutoff of the forces"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "number of bins"},
    {"estimator", FIELD_CHOICE, MEMBER(estimator), .choices = mf_rdf_force_estimators,
     .initial = RDF_FORCE_NOT_USED, .unit = "",
     .help = "estimator of g(r); force: less noise, biased by a large time step"},
    FIELD_END,
};

/// Where g(r) ends [λ]: with the forces, unless the settings say where; 0 if nothing does.
static double range_of(const struct rdf_settings *settings, const struct simulation_setup *setup) {
    if (settings->of_target)
        return mf_rdf_bins_range(&settings->target);
    return settings->range > 0 ? settings->range : mf_stages_cutoff(setup);
}

static struct rdf_bins bins_of(const struct rdf_settings *settings,
                               const struct simulation_setup *setup) {
    if (settings->of_target)
        return settings->target;
    return (struct rdf_bins){.width = range_of(settings, setup) / (double)settings->bins,
                             .count = (size_t)settings->bins};
}

static enum status check(const struct rdf_settings *settings,
                         const struct simulation_setup *setup) {
    if (!(range_of(settings, setup) > 0))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "rdf: the scene has no forces whose cutoff is the range of g(r): "
                              "give the range, as in {\"range\": 2}");
    if (settings->of_target || settings->estimator != RDF_FORCE_USED)
        return STATUS_OK;
    if (composition_is_mixed(&setup->composition))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "rdf: \"estimator\": \"force\" is not for mixtures; "
                              "\"histogram\" counts their partial g(r)");
    if (setup->interactions > 0)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "rdf: \"estimator\": \"force\" supports only pair forces, not \"interactions\"");
    if (!mf_rdf_force_applies(setup->potential, setup->temperature))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "rdf: \"estimator\": \"force\" needs a potential of at least 10 k_B T at r = 0");
    return STATUS_OK;
}

static bool uses_force(const struct rdf_settings *settings, const struct simulation_setup *setup) {
    return settings->estimator == RDF_FORCE_USED && setup->interactions == 0 &&
           !composition_is_mixed(&setup->composition) &&
           mf_rdf_force_applies(setup->potential, setup->temperature);
}

/// Of a trajectory, whose pairs are counted in these bins.
static enum status begin_frames(struct rdf_observed *observed, const struct rdf_settings *settings,
                                const struct configuration *configuration) {
    const struct box cube = mf_box_cube(configuration->box.volume);
    const struct rdf_bins bins = {.width = settings->range / (double)settings->bins,
                                  .count = (size_t)settings->bins};
    return mf_rdf_init_endless(&observed->counted, &bins, &cube, configuration->composition);
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    if (simulation == NULL)
        return begin_frames(state, settings, configuration);
    const struct simulation_setup *setup = &simulation->setup;
    const struct rdf_settings *s = settings;
    struct rdf_observed *observed = state;
    const size_t samples = (size_t)plan->samples;
    const double cutoff = mf_stages_cutoff(setup);
    observed->time = (double)(plan->samples * plan->every) * setup->time_step;
    TRY(check(s, setup));
    const struct rdf_bins bins = bins_of(s, setup);
    const bool force = uses_force(s, setup);
    if (!force || !s->of_target)
        TRY(mf_rdf_init_mixture(&observed->counted, &bins, &setup->box, &setup->composition, cutoff,
                                samples));
    if (!force)
        return STATUS_OK;
    return mf_rdf_force_init(&observed->force, &bins, &setup->box, simulation->particles.count,
                             setup->potential, setup->temperature, cutoff, samples);
}

/// Of beads of different molecules, and of single ones.
static enum status begin_intermolecular(void *state, const void *settings,
                                        const struct configuration *configuration,
                                        const struct measure_plan *plan) {
    struct rdf_observed *observed = state;
    struct rdf_settings counted = *(const struct rdf_settings *)settings;
    counted.estimator = RDF_FORCE_NOT_USED;
    if (configuration->molecules == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "intermolecular_rdf: the scene has no molecules");
    TRY(begin(state, &counted, configuration, plan));
    observed->counted.intermolecular = &configuration->molecules->topology;
    return STATUS_OK;
}

static void clear(void *state) {
    struct rdf_observed *observed = state;
    mf_rdf_clear(&observed->counted);
    mf_rdf_force_clear(&observed->force);
}

static const struct pair_histogram *histogram(void *state) {
    struct rdf_observed *observed = state;
    return observed->counted.pairs > 0 ? mf_rdf_histogram(&observed->counted) : NULL;
}

static enum status sample_force(struct rdf_observed *observed, struct simulation *simulation) {
    if (observed->force.planned == 0)
        return STATUS_OK;
    return mf_rdf_force_sample(&observed->force, &simulation->particles, &simulation->neighbours);
}

static enum status counted(void *state, const struct configuration *configuration) {
    struct simulation *const simulation = configuration->simulation;
    struct rdf_observed *observed = state;
    mf_rdf_set_volume(&observed->counted, mf_box_volume(&simulation->particles.box));
    mf_rdf_sample_counted(&observed->counted);
    return sample_force(observed, simulation);
}

static enum status sample(void *state, const struct configuration *configuration) {
    struct simulation *const simulation = configuration->simulation;
    struct rdf_observed *observed = state;
    if (configuration->counts) {
        mf_rdf_add(&observed->counted, configuration);
        return STATUS_OK;
    }
    if (observed->counted.pairs > 0)
        mf_rdf_set_volume(&observed->counted, mf_box_volume(&simulation->particles.box));
    if (observed->counted.pairs > 0)
        TRY(mf_rdf_sample(&observed->counted, &simulation->particles, &simulation->neighbours));
    return sample_force(observed, simulation);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct rdf_observed *observed = state;
    size_t n = 0;
    if (observed->counted.pairs > 0)
        n = mf_sample_blocks_spans(&observed->counted.blocks, spans);
    if (observed->force.planned > 0)
        n += mf_rdf_force_spans(&observed->force, spans + n);
    return n;
}

void mf_rdf_observable_file(const char *folder, const char *name,
                            const struct composition *composition, int pair, char *path) {
    char kind[COMPOSITION_PAIR_NAME_SIZE];
    mf_composition_pair_name(composition, pair, kind);
    snprintf(path, OUTPUT_PATH_SIZE, "%.*s/%.20s%s%s.tsv",
             OUTPUT_PATH_SIZE - COMPOSITION_PAIR_NAME_SIZE - 32, folder, name, kind[0] ? "_" : "",
             kind);
}

/// rdf.tsv, or in a mixture rdf_A-A.tsv, rdf_A-B.tsv and so on: r, g as the estimator tells it, g
/// as counted, each with its standard error. A comment says where these are of samples.
static enum status write(const void *state, const struct observable_results *results) {
    const struct rdf_observed *observed = state;
    const struct rdf *rdf = &observed->counted;
    const struct rdf_bins *bins = &rdf->bins;
    const bool force = observed->force.planned > 0;
    const size_t all = rdf->pairs * bins->count;
    static const char *const beside[5] = {"%.10g"};
    OWNED double *r = NULL, *g = NULL, *error = NULL, *counted = NULL, *counted_error = NULL;
    char path[OUTPUT_PATH_SIZE];
    TRY_ARRAY(r, bins->count);
    TRY_ARRAY(g, bins->count);
    TRY_ARRAY(error, bins->count);
    TRY_ARRAY(counted, all);
    TRY_ARRAY(counted_error, all);
    for (size_t k = 0; k < bins->count; k++)
        r[k] = mf_rdf_bins_centre(bins, k);
    TRY(mf_rdf_result(rdf, 1, counted, counted_error));
    if (force)
        TRY(mf_rdf_force_result(&observed->force, 1, RDF_FORCE_COUNTED, g, error));
    for (size_t pair = 0; pair < rdf->pairs; pair++) {
        const size_t first = pair * bins->count;
        if (!mf_composition_has_pairs(&rdf->composition, (int)pair))
            continue;
        mf_statistics_mark_unknown_errors(counted_error + first, bins->count);
        const bool of_samples =
            !force && mf_sample_blocks_are_independent(&rdf->blocks, first, bins->count,
                                                       counted + first, counted_error + first);
        mf_statistics_mark_unknown_errors(error, force ? bins->count : 0);
        const struct data_column columns[5] = {
            {"r[lambda]", r, NULL},
            {"g[1]", force ? g : counted + first, "%.8g"},
            {"g_error[1]", force ? error : counted_error + first, "%.3g"},
            {"g_histogram[1]", counted + first, "%.8g"},
            {"g_histogram_error[1]", counted_error + first, "%.3g"}};
        mf_rdf_observable_file(results->folder, rdf->intermolecular ? "intermolecular_rdf" : "rdf",
                               &rdf->composition, (int)pair, path);
        TRY(mf_data_table_write_beside(path, results->units,
                                       of_samples ? SAMPLE_BLOCKS_COMMENT : NULL, columns, beside,
                                       force ? 5 : 3, bins->count));
    }
    return STATUS_OK;
}

enum status mf_rdf_observable_is_of_samples(const struct observable_results *results,
                                            bool *of_samples) {
    const struct observable_use *use = results->use;
    OWNED double *g = NULL, *error = NULL;
    *of_samples = false;
    while (use && use->observable && use->observable != &mf_rdf_observable)
        use++;
    if (use == NULL || use->observable == NULL)
        return STATUS_OK;
    const struct rdf *rdf = &((const struct rdf_observed *)use->state)->counted;
    TRY_ARRAY(g, rdf->blocks.row);
    TRY_ARRAY(error, rdf->blocks.row);
    TRY(mf_rdf_result(rdf, 1, g, error));
    *of_samples = mf_sample_blocks_are_independent(&rdf->blocks, 0, rdf->blocks.row, g, error);
    return STATUS_OK;
}

/// Whether pairs of a type were within a distance: nobody may be in a well behind a high barrier.
static bool were_within(const struct rdf *rdf, size_t pair, double distance) {
    const size_t bins = rdf->bins.count;
    bool were = false;
    for (size_t row = pair; row < rdf->blocks.count * rdf->pairs; row += rdf->pairs)
        for (size_t k = 0; k < bins && mf_rdf_bins_centre(&rdf->bins, k) < distance; k++)
            were = were || rdf->blocks.sums[row * bins + k] > 0;
    return were;
}

/// Whether the samples are long beside the time that pairs of a type stay together.
static enum status assess_binding(const struct simulation_setup *setup, const struct rdf *rdf,
                                  int pair, double time) {
    static const double deep = 3, enough = 10;
    const struct bound_pairs bound = mf_bound_pairs_find(setup, pair);
    char name[COMPOSITION_PAIR_NAME_SIZE];
    for (int k = 0; k < setup->interactions; k++)
        if (setup->interaction[k].kind == &mf_many_body) // which may hold beads apart
            return STATUS_OK;
    if (!(bound.depth >= deep) || time >= enough * bound.lifetime ||
        !were_within(rdf, (size_t)pair, bound.edge))
        return STATUS_OK;
    mf_composition_pair_name(&setup->composition, pair, name);
    return mf_status_fail(STATUS_UNCONVERGED,
                          "pairs%s%s stay for %.3g" STATUS_TIME " or longer in their well of %.2g "
                          "k_B T, and the samples cover %.3g" STATUS_TIME
                          ": their g(r) may remember the start, and its errors may be too small; "
                          "run for at least %.3g" STATUS_TIME ", or compare seeds",
                          name[0] ? " " : "", name, bound.lifetime, bound.depth, time,
                          enough * bound.lifetime);
}

/// A table without a number is not written, and a warning says so.
static enum status assess(const void *state, const struct simulation_setup *setup) {
    const struct rdf_observed *const observed = state;
    const struct rdf *rdf = &observed->counted;
    char name[COMPOSITION_PAIR_NAME_SIZE];
    for (int pair = 0; pair < (int)rdf->pairs; pair++) {
        mf_composition_pair_name(&rdf->composition, pair, name);
        if (!mf_composition_has_pairs(&rdf->composition, pair))
            return mf_status_fail(STATUS_UNCONVERGED,
                                  "there is no pair %s, and so no g(r) of it: a single bead is of "
                                  "that type",
                                  name);
    }
    // A trajectory tells no potential.
    for (int pair = 0; setup && pair < mf_composition_pairs(&setup->composition); pair++)
        TRY(assess_binding(setup, rdf, pair, observed->time));
    return STATUS_OK;
}

/// Nanoseconds of a pair and sample: to count it, and to see what forces tell.
static const double count_cost = 1.0, flux_cost = 5;

static void explain_counting(const struct simulation_setup *setup, double range, double every,
                             struct stages *stages) {
    const double cutoff = mf_stages_cutoff(setup), pairs = mf_stages_pairs_within(setup, cutoff);
    char text[STAGES_LENGTH_SIZE];
    const double farther = mf_stages_pairs_within(setup, range);
    if (range <= cutoff * (1 + 1e-9))
        mf_stages_add(
            stages, "g(r)", true, count_cost * pairs / every, "counted in %s of one step in %.0f",
            setup->integrator->forces_midway ? "a pass at the end" : "the force pass", every);
    else
        mf_stages_add(stages, "g(r)", true,
                      (mf_stages_cost.sort + (mf_stages_cost.build + count_cost) * farther) / every,
                      "to %s, beyond the forces: a list of its own, one step in %.0f",
                      mf_stages_length(stages, range, 3, text), every);
}

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const struct rdf_settings *s = settings;
    const double range = range_of(s, setup);
    const bool force = s->estimator == RDF_FORCE_USED && setup->interactions == 0 &&
                       !composition_is_mixed(&setup->composition);
    if (force && s->of_target)
        mf_stages_add(stages, "g(r)", false, 0,
                      "from forces; counted for potentials that are low at r = 0");
    else
        explain_counting(setup, range, every, stages);
    if (force)
        mf_stages_add(
            stages, "g(r) from forces", true,
            flux_cost * mf_stages_pairs_within(setup, fmax(range, mf_stages_cutoff(setup))) / every,
            "one step in %.0f: the forces without friction and noise, then all pairs", every);
}

/// Values have the shape [pairs, bins].
static enum status result_of_all(const void *const *states, size_t count,
                                 const struct observable_values *values) {
    OWNED struct rdf *rdf = NULL;
    OWNED struct rdf_force *force = NULL;
    TRY_ARRAY(rdf, count);
    TRY_ARRAY(force, count);
    for (size_t k = 0; k < count; k++) {
        const struct rdf_observed *observed = states[k];
        rdf[k] = observed->counted;
        force[k] = observed->force;
    }
    if (force->planned > 0)
        TRY(mf_rdf_force_result(force, count, RDF_FORCE_COUNTED, values->value, values->error));
    else
        TRY(mf_rdf_result(rdf, count, values->value, values->error));
    return STATUS_OK;
}

static const struct observable_target targets[] = {
    {.name = "rdf",
     .summary = "g(r); in a mixture one for each pair type, as \"A-B\"",
     .form = OBSERVABLE_OWN_FORM},
    {.name = NULL}};

static const char *const files[] = {"rdf.tsv", "rdf_*-*.tsv", NULL};

const struct observable mf_rdf_observable = {
    .name = "rdf",
    .summary = "g(r)",
    .always = true,
    .of_places = true,
    .fields = fields,
    .settings_size = sizeof(struct rdf_settings),
    .state_size = sizeof(struct rdf_observed),
    .begin = begin,
    .clear = clear,
    .histogram = histogram,
    .counted = counted,
    .sample = sample,
    .spans = spans,
    .write = write,
    .assess = assess,
    .explain = explain,
    .stage = "g(r)",
    .targets = targets,
    .result_of_all = result_of_all,
    .files = files,
};

/// Nanoseconds of a pair and sample, one by one.
static const double visit_cost = 6;

static void explain_intermolecular(const void *settings, const struct simulation_setup *setup,
                                   double every, struct stages *stages) {
    const double range = range_of(settings, setup);
    mf_stages_add(stages, "g(r) between molecules", true,
                  visit_cost * mf_stages_pairs_within(setup, range) / every,
                  "visits all pairs, one step in %.0f", every);
}

static const struct field intermolecular_fields[] = {
    {"range", FIELD_NUMBER, MEMBER(range), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "range of g(r); 0: the cutoff of the forces"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "number of bins"},
    FIELD_END,
};

static const struct observable_target intermolecular_targets[] = {
    {.name = "intermolecular_rdf",
     .summary = "g(r) of beads of different molecules; in a mixture one for each pair type",
     .form = OBSERVABLE_OWN_FORM},
    {.name = NULL}};

static const char *const intermolecular_files[] = {"intermolecular_rdf.tsv",
                                                   "intermolecular_rdf_*-*.tsv", NULL};

const struct observable mf_rdf_intermolecular = {
    .name = "intermolecular_rdf",
    .summary = "g(r) of beads of different molecules, normalised as that of all",
    .of_places = true,
    .fields = intermolecular_fields,
    .settings_size = sizeof(struct rdf_settings),
    .state_size = sizeof(struct rdf_observed),
    .begin = begin_intermolecular,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain_intermolecular,
    .stage = "g(r) between molecules",
    .targets = intermolecular_targets,
    .result_of_all = result_of_all,
    .files = intermolecular_files,
};

int mf_rdf_intermolecular_kind(void) {
    int kind = 0;
    while (mf_observable_kind(kind).observable != &mf_rdf_intermolecular)
        kind++;
    return kind;
}
