// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/density_profile.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"

#include <math.h>
#include <string.h>

struct density_profile_plan {
    struct composition composition;
    size_t bins, samples; ///< samples 0: as many as there will be
    int axis;
    bool masses; ///< beads have masses, in u, and volumes are in nm³
};

/// All zero is none.
struct density_profile {
    struct density_profile_plan plan;
    struct sample_blocks
        blocks;    ///< of densities, of types and, behind them, their masses, times bins
    double *block; ///< of the sample that is being taken
};

/// Add a bead of it. @param[in] share   of the way along the box, from 0 to 1
/// @param[in] density  one over the volume of a bin
static inline void density_profile_add(struct density_profile *profile, int type, double share,
                                       double density, double mass) {
    const size_t bins = profile->plan.bins, bin = (size_t)(share * (double)bins);
    const size_t at = (size_t)type * bins + (bin < bins ? bin : bins - 1);
    profile->block[at] += density;
    if (profile->plan.masses)
        profile->block[(size_t)profile->plan.composition.types * bins + at] += density * mass;
}

/// 1 u/nm³ [g/cm³].
static const double gram_per_cubic_centimetre = UNITS_ATOMIC_MASS * 1e3 / 1e-21;

static enum status density_profile_init(struct density_profile *profile,
                                        const struct density_profile_plan *plan) {
    *profile = (struct density_profile){.plan = *plan};
    const size_t row = (size_t)plan->composition.types * plan->bins * (plan->masses ? 2 : 1);
    return mf_sample_blocks_init(&profile->blocks, plan->samples, row);
}

static void density_profile_clear(struct density_profile *profile) {
    mf_sample_blocks_clear(&profile->blocks);
    *profile = (struct density_profile){0};
}

/// A curve over the bins: of one type, or of the sum of several.
struct profile_curve {
    size_t first, types; ///< parts of a row
    double beads;        ///< of them, in all bins
    double unit;
    double *density, *error; ///< shape [bins]
};

static double sum_at(const struct density_profile *profile, const struct profile_curve *curve,
                     size_t block, size_t bin) {
    const size_t bins = profile->plan.bins;
    const double *const row = profile->blocks.sums + block * profile->blocks.row;
    double sum = 0;
    for (size_t type = curve->first; type < curve->first + curve->types; type++)
        sum += row[type * bins + bin];
    return sum * curve->unit;
}

/// Where nothing was: what one visit would have made.
static void mark_empty_bins(const struct density_profile *profile,
                            const struct profile_curve *curve) {
    double density = 0, squares = 0;
    for (size_t k = 0; k < profile->plan.bins; k++) {
        density += curve->density[k];
        squares += curve->error[k] * curve->error[k];
    }
    const double one = density / (curve->beads * (double)profile->blocks.taken);
    const double visit = one > 0 ? fmax(1, squares / (one * density)) * one : NAN;
    mf_statistics_mark_unknown_errors(curve->error, profile->plan.bins);
    for (size_t k = 0; k < profile->plan.bins; k++)
        if (curve->density[k] == 0 && !isnan(curve->error[k]))
            curve->error[k] = visit;
}

/// Mean over all samples, and the error by the blocks.
static enum status find_curve(const struct density_profile *profile,
                              const struct profile_curve *curve) {
    const size_t bins = profile->plan.bins, whole = mf_sample_blocks_whole(&profile->blocks);
    OWNED double *series = NULL;
    TRY_ARRAY(series, bins * whole + 1);
    for (size_t k = 0; k < bins; k++) {
        double sum = 0;
        for (size_t b = 0; b < profile->blocks.count; b++)
            sum += sum_at(profile, curve, b, k);
        for (size_t b = 0; b < whole; b++)
            series[k * whole + b] = sum_at(profile, curve, b, k) / profile->blocks.samples[b];
        curve->density[k] = sum / (double)profile->blocks.taken;
    }
    mf_statistics_correlated_errors(series, whole, 1, bins, curve->error);
    mark_empty_bins(profile, curve);
    return STATUS_OK;
}

/// Columns that are made, and their names.
struct columns {
    struct data_column column[1 + 2 * (2 * COMPOSITION_MAX_TYPES + 1)];
    char name[1 + 2 * (2 * COMPOSITION_MAX_TYPES + 1)][2 * COMPOSITION_NAME_SIZE + 32];
    size_t count;
};

/// "density_A[unit]" and "error_A[unit]".
static void name_columns(struct columns *columns, const char *const words[2], const char *type,
                         const char *unit, const struct profile_curve *curve) {
    for (int k = 0; k < 2; k++) {
        const size_t n = columns->count++;
        snprintf(columns->name[n], sizeof columns->name[n], "%s%s%s[%s]", words[k],
                 type[0] ? "_" : "", type, unit);
        columns->column[n] =
            (struct data_column){columns->name[n], k ? curve->error : curve->density, "%.6g"};
    }
}

static enum status add_curves(const struct density_profile *profile, int dimensions, double *values,
                              struct columns *columns) {
    static const char *const number[] = {"density", "error"}, *const mass[] = {"mass_density",
                                                                               "mass_error"};
    const struct composition *const composition = &profile->plan.composition;
    const size_t bins = profile->plan.bins, types = (size_t)composition->types;
    const bool mixed = composition_is_mixed(composition);
    const size_t parts = profile->plan.masses ? 2 * types : types;
    for (size_t part = 0; part < parts + (mixed && profile->plan.masses); part++) {
        const bool weighed = part >= types, all = part == parts;
        const char *const type = mixed && !all ? composition->name[part % types] : "";
        const struct profile_curve curve = {.first = all ? types : part,
                                            .types = all ? types : 1,
                                            .beads =
                                                all ? (double)mf_composition_particles(composition)
                                                    : (double)composition->count[part % types],
                                            .unit = weighed ? gram_per_cubic_centimetre : 1,
                                            .density = values + 2 * part * bins,
                                            .error = values + (2 * part + 1) * bins};
        TRY(find_curve(profile, &curve));
        name_columns(columns, weighed ? mass : number, type,
                     weighed           ? "g/cm^3"
                     : dimensions == 3 ? "1/lambda^3"
                                       : "1/lambda^2",
                     &curve);
    }
    return STATUS_OK;
}

/// Write density_profile.tsv: the middle of a bin; density and error of each type; with masses the
/// same in g/cm³, and of all types together. Fails: IO, NO_MEMORY.
/// @param[in] length  of the box along the axis
static enum status density_profile_write(const struct density_profile *profile, double length,
                                         int dimensions, const struct observable_results *results) {
    const size_t bins = profile->plan.bins;
    struct columns columns = {.count = 1};
    OWNED double *values = NULL;
    TRY_ARRAY(values, bins + 2 * (profile->blocks.row + bins));
    for (size_t k = 0; k < bins; k++)
        values[k] = ((double)k + 0.5) * length / (double)bins;
    snprintf(columns.name[0], sizeof columns.name[0], "%s[lambda]",
             mf_density_profile_axes[profile->plan.axis]);
    columns.column[0] = (struct data_column){columns.name[0], values, "%.6g"};
    TRY(add_curves(profile, dimensions, values + bins, &columns));
    return mf_observable_table(results, "density_profile.tsv", columns.column, columns.count, bins);
}

const char *const mf_density_profile_axes[] = {"x", "y", "z", NULL};

struct state {
    struct density_profile profile;
    int dimensions;
    double *share; ///< shape [count]: where the beads are along the axis
    double length; ///< of the box along it, summed over the samples
};

static void clear(void *state) {
    struct state *s = state;
    density_profile_clear(&s->profile);
    mf_memory_free(s->share);
    *s = (struct state){0};
}

/// Masses of a simulation are not in u.
static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct density_profile_settings *const set = settings;
    const struct density_profile_plan own = {.composition = *configuration->composition,
                                             .bins = (size_t)set->bins,
                                             .samples = (size_t)plan->samples,
                                             .axis = set->axis,
                                             .masses = configuration->mass != NULL};
    struct state *s = state;
    s->dimensions = configuration->dimensions;
    if (set->axis >= s->dimensions)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "density_profile.axis: z; expected x or y in two dimensions");
    TRY_ARRAY(s->share, configuration->count);
    return density_profile_init(&s->profile, &own);
}

/// Slabs are parallel to the other vectors of the box, and counted along its height.
static enum status sample(void *state, const struct configuration *configuration) {
    struct state *s = state;
    const double *const mass = configuration->mass;
    const struct density_profile_plan *const plan = &s->profile.plan;
    const double one = (double)plan->bins / configuration->box.volume;
    mf_configuration_shares(configuration, plan->axis, s->share);
    s->profile.block = mf_sample_blocks_next(&s->profile.blocks);
    for (size_t k = 0; k < configuration->count; k++)
        density_profile_add(&s->profile, mf_composition_type(&plan->composition, (uint32_t)k),
                            s->share[k] - floor(s->share[k]), one, mass ? mass[k] : 0);
    s->length += configuration->box.height[plan->axis];
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    spans[0] = (struct memory_span){&s->length, sizeof s->length};
    return 1 + mf_sample_blocks_spans(&s->profile.blocks, spans + 1);
}

static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    const double samples = (double)s->profile.blocks.taken;
    return density_profile_write(&s->profile, s->length / samples, s->dimensions, results);
}

/// Nanoseconds of a particle.
static const double particle_cost = 5;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)setup;
    mf_stages_add(stages, "density profile", true, particle_cost / every,
                  "%lld bins, one step in %.0f",
                  (long long)((const struct density_profile_settings *)settings)->bins, every);
}

static const struct field fields[] = {
    {"axis", FIELD_CHOICE, offsetof(struct density_profile_settings, axis),
     .choices = mf_density_profile_axes, .initial = 2, .unit = "", .help = "axis"},
    {"bins", FIELD_INTEGER, offsetof(struct density_profile_settings, bins), .initial = 100,
     .minimum = 1, .maximum = 100000, .unit = "", .help = "number"},
    FIELD_END,
};
static const char *const files[] = {"density_profile.tsv", NULL};

const struct observable mf_density_profile_observable = {
    .name = "density_profile",
    .of_places = true,
    .summary = "number density along an axis",
    .fields = fields,
    .settings_size = sizeof(struct density_profile_settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "density profile",
    .files = files,
    .figure = "density_profile",
};
