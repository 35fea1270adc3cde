// SPDX-License-Identifier: GPL-3.0-or-later
//
// Clusters: particles nearer than a distance to one of them belong to it, by the forest of R. E.
// Tarjan, J. ACM 22, 215 (1975). Of some types alone, as the tails of a surfactant, the others are
// as if they were not there. Told are the share of particles in clusters of each size, its mean ⟨Σ
// s²⟩/N, and the share in the largest. Tested: test_clusters.
#include "base/memory.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_series.h"

#include <stdio.h>
#include <string.h>

struct settings {
    double distance;
    char types[FIELD_TEXT_SIZE]; ///< "T" or "H T"; "": all
};

/// Of a sample: Σ s²/N, and the share of all particles in the largest.
enum { MEAN, LARGEST, NUMBERS };

struct state {
    double distance;
    size_t count; ///< of particles that can belong to one
    bool *counts; ///< shape [particles]: whether that one can, or NULL: all can
    size_t particles;
    struct sample_series series;
    uint32_t *root;  ///< shape [particles]: a particle of the same cluster, or itself
    uint32_t *size;  ///< shape [particles]: of the cluster, at its root
    double *members; ///< shape [count + 1]: particles in clusters of each size, over all samples
};

static void clear(void *state) {
    struct state *s = state;
    mf_memory_free(s->counts);
    mf_memory_free(s->root);
    mf_memory_free(s->size);
    mf_memory_free(s->members);
    mf_sample_series_clear(&s->series);
    *s = (struct state){0};
}

/// Mark the particles of the type that a word names.
static enum status mark(struct state *s, const struct composition *composition, const char *word) {
    int type = 0;
    while (type < composition->types && strcmp(composition->name[type], word) != 0)
        type++;
    if (type >= composition->types)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "clusters.types: \"%.64s\" is no type of the scene; name those that "
                              "count, as \"A\" or \"A B\"",
                              word);
    for (size_t k = 0; k < s->particles; k++)
        if (mf_composition_type(composition, (uint32_t)k) == type && !s->counts[k]) {
            s->counts[k] = true;
            s->count++;
        }
    return STATUS_OK;
}

/// Mark those of all types that are named.
static enum status choose(struct state *s, const struct composition *composition,
                          const char *types) {
    char words[FIELD_TEXT_SIZE];
    snprintf(words, sizeof words, "%s", types);
    TRY_ARRAY(s->counts, s->particles);
    s->count = 0;
    for (char *rest, *word = strtok_r(words, " ,", &rest); word; word = strtok_r(NULL, " ,", &rest))
        TRY(mark(s, composition, word));
    return s->count > 0 ? STATUS_OK
                        : mf_status_fail(STATUS_BAD_INPUT, "clusters.types: no type is named");
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    (void)plan;
    const struct settings *wanted = settings;
    *s = (struct state){.distance = wanted->distance,
                        .count = simulation->particles.count,
                        .particles = simulation->particles.count,
                        .series.columns = NUMBERS};
    const double range = mf_simulation_range(&simulation->setup);
    if (s->distance > range * (1 + 1e-9))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "clusters.distance: %g" STATUS_LENGTH " is beyond %g" STATUS_LENGTH
                              ", the range of the interactions, "
                              "for which pairs are known",
                              s->distance, range);
    if (simulation->particles.topology && simulation->particles.topology->excludes)
        return mf_status_fail(STATUS_BAD_INPUT, "clusters: excluded pairs of molecules are not "
                                                "counted as bonds of clusters; set \"exclude\": 0");
    if (wanted->types[0])
        TRY(choose(s, &simulation->setup.composition, wanted->types));
    TRY_ARRAY(s->root, s->particles);
    TRY_ARRAY(s->size, s->particles);
    TRY_ARRAY(s->members, s->count + 1);
    return STATUS_OK;
}

static uint32_t find_root(uint32_t *root, uint32_t k) {
    while (root[k] != k) {
        root[k] = root[root[k]];
        k = root[k];
    }
    return k;
}

static void join(void *context, const struct neighbours_batch *batch) {
    struct state *s = context;
    for (size_t n = 0; n < batch->count; n++) {
        if (s->counts && !(s->counts[batch->id_i[n]] && s->counts[batch->id_j[n]]))
            continue;
        const uint32_t a = find_root(s->root, batch->id_i[n]);
        const uint32_t b = find_root(s->root, batch->id_j[n]);
        const uint32_t low = s->size[a] < s->size[b] ? a : b, high = low == a ? b : a;
        if (a == b)
            continue;
        s->root[low] = high;
        s->size[high] += s->size[low];
    }
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    double squares = 0, largest = 0;
    for (size_t k = 0; k < s->particles; k++) {
        s->root[k] = (uint32_t)k;
        s->size[k] = 1;
    }
    mf_neighbours_visit_pairs(&simulation->neighbours, &simulation->particles, s->distance, join,
                              s);
    for (size_t k = 0; k < s->particles; k++) {
        const bool leads = s->root[k] == k && (s->counts == NULL || s->counts[k]);
        const double size = leads ? s->size[k] : 0;
        s->members[(size_t)size] += size;
        squares += size * size;
        largest = fmax(largest, size);
    }
    const double numbers[NUMBERS] = {squares / (double)s->count, largest / (double)s->count};
    return mf_sample_series_add(&s->series, numbers);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    const size_t n = mf_sample_series_spans(&s->series, spans);
    spans[n] = (struct memory_span){s->members, (s->count + 1) * sizeof *s->members};
    return n + 1;
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->series);
}

/// clusters.tsv: sizes that were seen, the share of particles in clusters of each, and how many
/// clusters there were in a sample.
static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    OWNED double *values = NULL;
    size_t rows = 0;
    TRY_ARRAY(values, 3 * (s->count + 1));
    double *size = values, *share = size + s->count + 1, *number = share + s->count + 1;
    for (size_t k = 1; k <= s->count; k++) {
        if (s->members[k] == 0)
            continue;
        size[rows] = (double)k;
        share[rows] = s->members[k] / ((double)s->count * (double)s->series.count);
        number[rows++] = s->members[k] / ((double)k * (double)s->series.count);
    }
    const struct data_column columns[] = {
        {"size[1]", size, "%.0f"}, {"share[1]", share, "%.6g"}, {"clusters[1]", number, "%.6g"}};
    return mf_observable_table(results, "clusters.tsv", columns, 3, rows);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    static const char *const names[NUMBERS] = {"cluster_size", "largest_cluster"};
    (void)results;
    for (size_t n = 0; n < NUMBERS; n++) {
        double error, mean = mf_sample_series_mean(&s->series, n, &error);
        mf_statistics_mark_unknown_errors(&error, 1);
        mf_json_put_measured(writer, names[n], "1", mean, error);
    }
}

/// Nanoseconds of an entry of the list.
static const double entry_cost = 3;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    char text[STAGES_LENGTH_SIZE];
    const double entries = mf_stages_pairs_within(setup, mf_simulation_range(setup));
    mf_stages_add(stages, "clusters", true, (10 + entry_cost * entries) / every,
                  "particles nearer than %s, one step in %.0f",
                  mf_stages_length(stages, ((const struct settings *)settings)->distance, 3, text),
                  every);
}

static const struct field fields[] = {
    {"distance", FIELD_NUMBER, offsetof(struct settings, distance), .required = true,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "lambda",
     .help = "largest distance of neighbours, at most the range of the interactions"},
    {"types", FIELD_TEXT, offsetof(struct settings, types), .unit = "",
     .help = "types that count, as \"T\" or \"H T\"; else all"},
    FIELD_END,
};
static const char *const files[] = {"clusters.tsv", NULL};

const struct observable mf_clusters = {
    .name = "clusters",
    .summary = "sizes of clusters of neighbouring particles",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .explain = explain,
    .stage = "clusters",
    .files = files,
    .figure = "clusters",
};
