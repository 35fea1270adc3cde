// SPDX-License-Identifier: GPL-3.0-or-later
//
// Number density along an axis of the box, of each type: slabs, walls, interfaces. Errors are of
// the scatter of blocks in time, which is that of correlated samples. Tested:
// cli/test_density_profile.
#include "base/memory.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_blocks.h"

struct settings {
    int axis;
    int64_t bins;
};

struct state {
    struct settings settings;
    struct composition composition;
    struct box box; ///< at the begin, by which distances are told
    size_t row;     ///< types times bins
    struct sample_blocks blocks;
    double *sums; ///< shape [blocks, types, bins]: densities, over the samples of a block [1/λ^d]
};

static void clear(void *state) {
    struct state *s = state;
    mf_sample_blocks_clear(&s->blocks);
    mf_memory_free(s->sums);
    *s = (struct state){0};
}

static enum status begin(void *state, const void *settings, const struct simulation *simulation,
                         const struct measure_plan *plan) {
    struct state *s = state;
    *s = (struct state){.settings = *(const struct settings *)settings,
                        .composition = simulation->setup.composition,
                        .box = simulation->particles.box};
    if (s->settings.axis >= s->box.dimensions)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "density_profile.axis: z; expected x or y in two dimensions");
    s->row = (size_t)s->composition.types * (size_t)s->settings.bins;
    TRY(mf_sample_blocks_init(&s->blocks, (size_t)plan->samples));
    TRY_ARRAY(s->sums, s->blocks.count * s->row);
    return STATUS_OK;
}

static enum status sample(void *state, struct simulation *simulation) {
    struct state *s = state;
    const struct particles *const particles = &simulation->particles;
    const size_t bins = (size_t)s->settings.bins;
    const int axis = s->settings.axis;
    const double one = (double)bins / mf_box_volume(&particles->box);
    if (mf_sample_blocks_are_full(&s->blocks)) {
        mf_sample_blocks_join(&s->blocks, s->sums, s->row);
        mf_sample_blocks_double(&s->blocks);
    }
    double *const sums = s->sums + mf_sample_blocks_take(&s->blocks) * s->row;
    for (size_t k = 0; k < particles->count; k++) {
        const double share = particles->position[axis][k] / particles->box.length[axis];
        const size_t bin = (size_t)((share - floor(share)) * (double)bins);
        const int type = mf_composition_type(&s->composition, particles->id[k]);
        sums[(size_t)type * bins + (bin < bins ? bin : bins - 1)] += one;
    }
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    const size_t n = mf_sample_blocks_spans(&s->blocks, spans);
    spans[n] = (struct memory_span){s->sums, s->blocks.count * s->row * sizeof *s->sums};
    return n + 1;
}

/// Mean over all samples, and the standard error of the means of blocks.
static double find_mean(const struct state *s, size_t k, double *error) {
    const size_t whole = mf_sample_blocks_whole(&s->blocks);
    struct running_mean means = {0};
    double sum = 0;
    for (size_t b = 0; b < s->blocks.count; b++)
        sum += s->sums[b * s->row + k];
    for (size_t b = 0; b < whole; b++)
        mf_statistics_add(&means, s->sums[b * s->row + k] / s->blocks.samples[b]);
    *error = whole > 1 ? mf_statistics_standard_error(&means) : NAN;
    return sum / (double)s->blocks.taken;
}

/// density_profile.tsv: the middle of a bin, and density and error of each type.
static enum status write(const void *state, const struct observable_results *results) {
    enum { MAX = 1 + 2 * COMPOSITION_MAX_TYPES };
    static const char *const axes[] = {"x[lambda]", "y[lambda]", "z[lambda]"};
    const struct state *s = state;
    const size_t bins = (size_t)s->settings.bins;
    const char *const unit = s->box.dimensions == 3 ? "1/lambda^3" : "1/lambda^2";
    struct data_column columns[MAX];
    char names[MAX][2 * COMPOSITION_NAME_SIZE + 32];
    OWNED double *values = NULL;
    TRY_ARRAY(values, bins + 2 * s->row);
    for (size_t k = 0; k < bins; k++)
        values[k] = ((double)k + 0.5) * s->box.length[s->settings.axis] / (double)bins;
    columns[0] = (struct data_column){axes[s->settings.axis], values, "%.6g"};
    for (size_t k = 0; k < s->row; k++)
        values[bins + k] = find_mean(s, k, &values[bins + s->row + k]);
    mf_statistics_mark_unknown_errors(values + bins + s->row, s->row);
    for (int type = 0; type < s->composition.types; type++) {
        const bool mixed = composition_is_mixed(&s->composition);
        const char *const name = mixed ? s->composition.name[type] : "";
        const size_t at = bins + (size_t)type * bins;
        const int n = 1 + 2 * type;
        snprintf(names[n], sizeof names[n], "density%s%s[%s]", mixed ? "_" : "", name, unit);
        snprintf(names[n + 1], sizeof names[n + 1], "error%s%s[%s]", mixed ? "_" : "", name, unit);
        columns[n] = (struct data_column){names[n], values + at, "%.6g"};
        columns[n + 1] = (struct data_column){names[n + 1], values + at + s->row, "%.6g"};
    }
    return mf_observable_table(results, "density_profile.tsv", columns,
                               (size_t)(1 + 2 * s->composition.types), bins);
}

/// Nanoseconds of a particle.
static const double particle_cost = 5;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)setup;
    mf_stages_add(stages, "density profile", true, particle_cost / every,
                  "%lld bins, one step in %.0f",
                  (long long)((const struct settings *)settings)->bins, every);
}

static const char *const axes[] = {"x", "y", "z", NULL};

static const struct field fields[] = {
    {"axis", FIELD_CHOICE, offsetof(struct settings, axis), .choices = axes, .initial = 2,
     .unit = "", .help = "axis"},
    {"bins", FIELD_INTEGER, offsetof(struct settings, bins), .initial = 100, .minimum = 1,
     .maximum = 100000, .unit = "", .help = "number"},
    FIELD_END,
};
static const char *const files[] = {"density_profile.tsv", NULL};

const struct observable mf_density_profile = {
    .name = "density_profile",
    .summary = "number density along an axis",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "density profile",
    .files = files,
};
