// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors by the scatter of blocks of time, correlated as they are, or of groups of molecules, whose
// means over all times differ where a molecule keeps what it is for long, as the side of a
// dihedral. Tested: test_molecules, test_bonded_errors.
#include "observe/bonded_distribution.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "forces/bonded.h"
#include "io/data_table.h"
#include "observe/bonded_counts.h"
#include "observe/measure.h"
#include "observe/rdf_observable.h"

#include <math.h>

enum { COLUMNS = 3, MAX_PARTS = 20 };

static const struct field fields[] = {
    {"bins", FIELD_INTEGER, .offset = offsetof(struct bonded_settings, bins), .initial = 100,
     .minimum = 1, .maximum = 100000, .unit = "",
     .help = "number of bins; lengths up to twice those at rest, all angles"},
    FIELD_END,
};

const struct observable *mf_bonded_distribution_of(int order) {
#define OF(NAME, kind, ...) &mf_bonded_distribution_##kind,
    static const struct observable *const of[] = {BONDED_LIST(OF)};
    return of[order];
}

int mf_bonded_distribution_order(int kind) {
    const struct observable *observable = mf_observable_kind(kind).observable;
    for (int order = 0; order < BONDED_KINDS; order++)
        if (observable && observable == mf_bonded_distribution_of(order))
            return order;
    return BONDED_KINDS;
}

int mf_bonded_distribution_kind(int order) {
    int kind = 0;
    while (mf_bonded_distribution_order(kind) != order)
        kind++;
    return kind;
}

size_t mf_bonded_distribution_terms(const struct topology *topology, int order, int group) {
    size_t terms = 0;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int t = 0; t < kind->terms[order]; t++)
            terms += kind->term[order][t].group == group ? (size_t)kind->count : 0;
    }
    return terms;
}

double mf_bonded_distribution_jacobian(int order, int dimensions, const struct bonded_bins *bins,
                                       size_t bin) {
    return mf_bonded_kinds[order]->jacobian(dimensions, bins->low + (double)bin * bins->width,
                                            bins->width);
}

// Sampling ----------------------------------------------------------------------------------------

/// As far as the lengths of any group are likely to go: once in 10^8 one at rest at 0 goes on.
static double longest_of(const struct molecules *molecules, int order, double temperature) {
    static const double likely = 18;
    double longest = 0;
    for (int g = 0; g < molecules->groups[order]; g++) {
        const struct bonded_curve *curve = &molecules->group[order][g].curve;
        const double rest = mf_bonded_rest(curve);
        longest = fmax(longest, rest > 0 ? fmin(mf_bonded_longest(curve), 2 * rest)
                                         : mf_bonded_reach(curve, likely * temperature));
    }
    return longest;
}

static struct bonded_bins choose_bins(const struct molecules *molecules, int order, int64_t count,
                                      double temperature) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double high = kind->is_length ? longest_of(molecules, order, temperature) : kind->high;
    return (struct bonded_bins){kind->low, (high - kind->low) / (double)count, (size_t)count};
}

static enum status begin(struct bonded_state *s, int order, const struct bonded_settings *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct molecules *molecules = configuration->molecules;
    if (molecules == NULL || molecules->groups[order] == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the scene has no %s",
                              mf_bonded_distribution_of(order)->name,
                              mf_bonded_kinds[order]->plural);
    *s = (struct bonded_state){
        .molecules = molecules, .order = order, .dimensions = configuration->dimensions};
    for (int g = 0; g < molecules->groups[order]; g++) {
        s->bins[g] = settings->bins > 0
                         ? choose_bins(molecules, order, settings->bins, configuration->temperature)
                         : settings->target[g];
        s->first[g + 1] = s->first[g] + s->bins[g].count;
    }
    s->parts = (size_t)molecules->topology.molecules;
    s->parts = s->parts < MAX_PARTS ? s->parts : MAX_PARTS;
    const size_t row = s->first[molecules->groups[order]];
    TRY_ARRAY(s->of_part, s->parts * row);
    return mf_sample_blocks_init(&s->blocks, (size_t)plan->samples, row);
}

static void clear(void *state) {
    struct bonded_state *s = state;
    mf_memory_free(s->of_part);
    mf_sample_blocks_clear(&s->blocks);
    *s = (struct bonded_state){0};
}

/// The bin of q, or −1. The end of the circle may be rounded up.
static int64_t find_bin(const struct bonded_bins *bins, int order, double q) {
    double place = (q - bins->low) / bins->width;
    if (mf_bonded_kinds[order]->periodic)
        place -= 360 / bins->width * floor(place * bins->width / 360);
    const double count = (double)bins->count;
    if (!mf_bonded_kinds[order]->is_length && place >= count && place < count * (1 + 1e-9))
        return (int64_t)bins->count - 1;
    return place >= 0 && place < count ? (int64_t)place : -1;
}

/// Counts of all molecules, and of parts of them: every so manieth.
struct counting {
    double *all;
    double *of_part; ///< shape [parts, stride], or NULL
    size_t parts, stride;
};

/// Count one term in all molecules of a kind.
static void count_term(int order, const struct bonded_bins *bins, const struct particles *particles,
                       const struct topology_kind *kind, const struct topology_term *term,
                       const struct counting *counting) {
    const int beads = mf_bonded_kinds[order]->beads;
    const double unit = 1 / mf_bonded_kinds[order]->scale;
    for (int64_t m = 0; m < kind->count; m += BONDED_BATCH) {
        int32_t place[BONDED_MAX_TERM_BEADS * BONDED_BATCH];
        double q[BONDED_BATCH];
        const int64_t left = kind->count - m;
        const size_t some = left < BONDED_BATCH ? (size_t)left : BONDED_BATCH;
        for (size_t n = 0; n < some; n++)
            for (int k = 0; k < beads; k++)
                place[n * (size_t)beads + (size_t)k] =
                    (int32_t)particles->place[topology_id(kind, m + (int64_t)n, term->bead[k])];
        mf_bonded_measure(order, some, place, particles, q);
        for (size_t n = 0; n < some; n++) {
            const int64_t bin = find_bin(bins, order, unit * q[n]);
            if (bin < 0)
                continue;
            counting->all[bin] += 1;
            if (counting->of_part) {
                const size_t part = (size_t)(kind->first + m + (int64_t)n) % counting->parts;
                counting->of_part[part * counting->stride + (size_t)bin] += 1;
            }
        }
    }
}

static void count_group(const struct molecules *molecules, int order, int group,
                        const struct bonded_bins *bins, const struct particles *particles,
                        const struct counting *counting) {
    const struct topology *topology = &molecules->topology;
    for (int k = 0; k < topology->kinds; k++)
        for (int t = 0; t < topology->kind[k].terms[order]; t++)
            if (topology->kind[k].term[order][t].group == group)
                count_term(order, bins, particles, &topology->kind[k],
                           &topology->kind[k].term[order][t], counting);
}

void mf_bonded_distribution_count(const struct molecules *molecules, int order, int group,
                                  const struct bonded_bins *bins, const struct particles *particles,
                                  double *counts) {
    count_group(molecules, order, group, bins, particles, &(struct counting){.all = counts});
}

static enum status sample(void *state, const struct configuration *configuration) {
    struct bonded_state *s = state;
    const int groups = s->molecules->groups[s->order];
    double *counts = mf_sample_blocks_next(&s->blocks);
    for (int g = 0; g < groups; g++)
        if (s->bins[g].count > 0)
            count_group(s->molecules, s->order, g, &s->bins[g], configuration->particles,
                        &(struct counting){counts + s->first[g], s->of_part + s->first[g], s->parts,
                                           s->first[groups]});
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct bonded_state *s = state;
    spans[0] = (struct memory_span){s->of_part, s->parts * s->blocks.row * sizeof *s->of_part};
    return 1 + mf_sample_blocks_spans(&s->blocks, spans + 1);
}

// Results -----------------------------------------------------------------------------------------

/// Terms of a group in a part of the molecules.
static double terms_of_part(const struct bonded_state *s, int group, size_t part) {
    double terms = 0;
    for (int k = 0; k < s->molecules->topology.kinds; k++) {
        const struct topology_kind *kind = &s->molecules->topology.kind[k];
        int own = 0;
        for (int t = 0; t < kind->terms[s->order]; t++)
            own += kind->term[s->order][t].group == group;
        for (int64_t m = 0; m < kind->count && own > 0; m++)
            terms += (size_t)(kind->first + m) % s->parts == part ? own : 0;
    }
    return terms;
}

/// Standard errors by parts of the molecules, which count as independent; 0 of fewer than two.
static void find_errors_of_parts(const struct bonded_state *const *states, size_t count, int group,
                                 double *error) {
    const struct bonded_state *s = states[0];
    const size_t all = s->first[s->molecules->groups[s->order]], bins = s->bins[group].count;
    double terms[MAX_PARTS] = {0};
    for (size_t part = 0; part < s->parts; part++)
        terms[part] = terms_of_part(s, group, part);
    for (size_t bin = 0; bin < bins; bin++) {
        struct running_mean mean = {0};
        for (size_t n = 0; n < count * s->parts; n++) {
            const struct bonded_state *of = states[n / s->parts];
            const size_t part = n % s->parts;
            if (terms[part] > 0)
                mf_statistics_add(
                    &mean, of->of_part[part * all + s->first[group] + bin] /
                               ((double)of->blocks.taken * terms[part] * s->bins[group].width));
        }
        error[bin] = mf_statistics_standard_error(&mean);
    }
}

/// p of a group's bins and their errors: by blocks of time or by parts of the molecules, which of
/// them scatters more.
static enum status average(const struct bonded_state *const *states, size_t count, int group,
                           double *value, double *error) {
    const size_t bins = states[0]->bins[group].count,
                 blocks = mf_bonded_series_blocks(states, count);
    const size_t values = count * blocks;
    OWNED double *series = NULL, *of_parts = NULL;
    TRY_ARRAY(series, bins * values + 1);
    TRY_ARRAY(of_parts, bins + 1);
    mf_bonded_series_find(states, count, group, blocks, series);
    for (size_t bin = 0; bin < bins; bin++) {
        struct running_mean mean = {0};
        for (size_t n = 0; n < values; n++)
            mf_statistics_add(&mean, series[bin * values + n]);
        value[bin] = mean.mean;
    }
    mf_statistics_correlated_errors(series, blocks, count, bins, error);
    find_errors_of_parts(states, count, group, of_parts);
    if (values > 1)
        mf_statistics_take_larger(error, of_parts, bins);
    return STATUS_OK;
}

/// p, its error and p over the Jacobian with a largest value of 1; shape [COLUMNS, bins].
static enum status find_columns(const struct bonded_state *s, int group, double *values) {
    const struct bonded_bins *own = &s->bins[group];
    double largest = 0;
    TRY(average(&s, 1, group, values, values + own->count));
    for (size_t bin = 0; bin < own->count; bin++) {
        values[2 * own->count + bin] =
            values[bin] / mf_bonded_distribution_jacobian(s->order, s->dimensions, own, bin);
        largest = fmax(largest, values[2 * own->count + bin]);
    }
    for (size_t bin = 0; bin < own->count && largest > 0; bin++)
        values[2 * own->count + bin] /= largest;
    mf_statistics_mark_unknown_errors(values + own->count, own->count);
    return STATUS_OK;
}

/// p of the groups that are measured, one after the other.
static enum status result_of_all(const void *const *states, size_t count,
                                 const struct observable_values *values) {
    const struct bonded_state *const *all = (const struct bonded_state *const *)states;
    const struct bonded_state *first = all[0];
    for (int g = 0; g < first->molecules->groups[first->order]; g++)
        TRY(average(all, count, g, values->value + first->first[g],
                    values->error + first->first[g]));
    return STATUS_OK;
}

/// q, then p, error and p over the Jacobian of each group under its name. All have the same bins.
/// A comment says where all errors are of samples.
static enum status write_table(const struct bonded_state *s, const char *file,
                               const struct observable_results *results) {
    enum { MAX = 1 + COLUMNS * MOLECULES_MAX_GROUPS };
    static const char *const endings[COLUMNS] = {"", "_error", "_boltzmann"};
    const int groups = s->molecules->groups[s->order];
    const size_t bins = s->bins[0].count;
    struct data_column columns[MAX];
    char names[MAX][TOPOLOGY_NAME_SIZE + 32];
    OWNED double *values = NULL;
    char path[OUTPUT_PATH_SIZE];
    bool of_samples;
    TRY(mf_rdf_observable_is_of_samples(results, &of_samples));
    TRY_ARRAY(values, (1 + COLUMNS * (size_t)groups) * bins);
    for (size_t bin = 0; bin < bins; bin++)
        values[bin] = bonded_bins_centre(&s->bins[0], bin);
    columns[0] =
        (struct data_column){mf_bonded_distribution_of(s->order)->targets->argument, values, NULL};
    for (int g = 0; g < groups; g++) {
        double *own = values + (1 + COLUMNS * (size_t)g) * bins;
        TRY(find_columns(s, g, own));
        of_samples = of_samples && mf_sample_blocks_are_independent(&s->blocks, s->first[g], bins,
                                                                    own, own + bins);
        for (int c = 0; c < COLUMNS; c++) {
            const int n = 1 + COLUMNS * g + c;
            snprintf(names[n], sizeof names[n], "%s%s[%s]", s->molecules->group[s->order][g].name,
                     endings[c], c == 2 ? "1" : mf_bonded_kinds[s->order]->density);
            columns[n] =
                (struct data_column){names[n], own + (size_t)c * bins, c == 1 ? "%.3g" : "%.8g"};
        }
    }
    mf_observable_file(results, file, path);
    return mf_data_table_write_in(path, results->units, of_samples ? SAMPLE_BLOCKS_COMMENT : NULL,
                                  columns, (size_t)(1 + COLUMNS * groups), bins);
}

/// Nanoseconds of a term and sample.
static void explain(const struct simulation_setup *setup, int order, const char *what, double every,
                    struct stages *stages) {
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const double terms = molecules ? (double)mf_topology_terms(&molecules->topology, order) : 0;
    mf_stages_add(stages, what, true,
                  mf_bonded_kinds[order]->cost * terms /
                      (every * fmax(1, (double)setup->placement.count)),
                  "%.0f of them, one step in %.0f", terms, every);
}

// Records -----------------------------------------------------------------------------------------

#define DISTRIBUTION(NAME, term, beads_, key, what, argument_, unit_)                              \
    static enum status term##_begin(void *state, const void *settings,                             \
                                    const struct configuration *configuration,                     \
                                    const struct measure_plan *plan) {                             \
        return begin(state, BONDED_##NAME, settings, configuration, plan);                         \
    }                                                                                              \
    static enum status term##_write(const void *state, const struct observable_results *results) { \
        return write_table(state, #key ".tsv", results);                                           \
    }                                                                                              \
    static void term##_explain(const void *settings, const struct simulation_setup *setup,         \
                               double every, struct stages *stages) {                              \
        (void)settings;                                                                            \
        explain(setup, BONDED_##NAME, what, every, stages);                                        \
    }                                                                                              \
    static const char *const term##_files[] = {#key ".tsv", NULL};                                 \
    static const struct observable_target term##_targets[] = {                                     \
        {.name = #key,                                                                             \
         .summary = "p of the " what " of each group: {\"group\": {\"file\": ...}, ...}",          \
         .form = OBSERVABLE_OWN_FORM,                                                              \
         .argument = argument_,                                                                    \
         .unit = unit_},                                                                           \
        {0}};                                                                                      \
    const struct observable mf_bonded_distribution_##term = {                                      \
        .name = #key,                                                                              \
        .summary = "distribution of the " what " of each group",                                   \
        .of_places = true,                                                                         \
        .fields = fields,                                                                          \
        .settings_size = sizeof(struct bonded_settings),                                           \
        .state_size = sizeof(struct bonded_state),                                                 \
        .begin = term##_begin,                                                                     \
        .clear = clear,                                                                            \
        .sample = sample,                                                                          \
        .spans = spans,                                                                            \
        .write = term##_write,                                                                     \
        .explain = term##_explain,                                                                 \
        .stage = what,                                                                             \
        .files = term##_files,                                                                     \
        .figure = OBSERVABLE_FIGURE_OF_GROUPS,                                                     \
        .targets = term##_targets,                                                                 \
        .result_of_all = result_of_all,                                                            \
    };

BONDED_LIST(DISTRIBUTION)
