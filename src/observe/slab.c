// SPDX-License-Identifier: GPL-3.0-or-later
//
// A slab of liquid in its vapour, which stands across the longest edge of the box: the density
// profile about its middle, both densities, the interface, and the surface tension of its two
// sides,
//   γ = L/2 ⟨P_N − P_T⟩,
// P_N the pressure along the longest edge L, P_T the mean of those across it (J. G. Kirkwood and
// F. P. Buff, J. Chem. Phys. 17, 338 (1949)); in two dimensions γ is a line tension. Of the stress
// only the virial counts: what velocities carry is alike along all axes in equilibrium, and
// scatters about that.
//
// The middle is where the longest wave of the density, ρ(q) = Σ exp(2πi z/L), has its crest: all
// beads decide on it, those of the vapour hardly, and no place in the box is special. Each
// configuration counts about its own, so that a slab that drifts is not smeared. Errors of the
// profile are of the scatter of blocks in time; those of the fit are a jackknife of these, and see
// their correlation. Tested: cli/test_slab, physics/test_slab.
#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "dynamics/simulation_look.h"
#include "io/data_table.h"
#include "observe/equilibration.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "observe/sample_blocks.h"
#include "observe/sample_series.h"
#include "observe/slab_fit.h"

#include <math.h>

enum { MAX_BLOCKS = SLAB_MAX_BLOCKS };

/// Columns of the series: γ and P_N of each sample.
enum { TENSION, NORMAL, SERIES };

static const char tension_unit[] = "k_B T_0/lambda^2", line_unit[] = "k_B T_0/lambda";
static const char density_unit[] = "1/lambda^d", pressure_unit[] = "k_B T_0/lambda^d";

struct settings {
    int64_t bins; ///< 0: USUAL_BINS, as of targets
};

static size_t find_bins(const struct settings *settings) {
    enum { USUAL_BINS = 200 };
    return settings->bins > 0 ? (size_t)settings->bins : USUAL_BINS;
}

struct state {
    size_t bins;
    struct composition composition;
    struct box box;
    double count;
    int axis;
    size_t curves; ///< profiles: of all beads, and in a mixture of each type
    struct sample_series series;
    struct sample_blocks blocks; ///< of densities, shape [curves, bins] [1/λ^d]
};

static void clear(void *state) {
    struct state *s = state;
    mf_sample_series_clear(&s->series);
    mf_sample_blocks_clear(&s->blocks);
    *s = (struct state){0};
}

/// What has no stress, or not along each axis, is told before the equilibration.
static enum status check_stress(const struct simulation *simulation) {
    double virial[3][3];
    if (simulation->setup.integrator->events)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "slab: \"%s\" has no forces, of which a surface tension is made",
                              simulation->setup.integrator->name);
    const enum status status = mf_simulation_look_virial(simulation, virial);
    return status == STATUS_BAD_INPUT ? mf_status_prefix(status, "slab") : status;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const struct composition *composition = &simulation->setup.composition;
    const bool mixed = composition_is_mixed(composition);
    *s = (struct state){.bins = find_bins(settings),
                        .composition = *composition,
                        .box = simulation->particles.box,
                        .count = (double)simulation->particles.count,
                        .axis = mf_placement_slab_axis(&simulation->particles.box),
                        .curves = 1 + (mixed ? (size_t)composition->types : 0),
                        .series.columns = SERIES};
    TRY(check_stress(simulation));
    return mf_sample_blocks_init(&s->blocks, (size_t)plan->samples, s->curves * s->bins);
}

// Sampling ----------------------------------------------------------------------------------------

/// The middle of the slab along the axis, as a part of the edge.
static double find_middle(const struct particles *particles, int axis) {
    const double turn = 2 * M_PI / particles->box.length[axis];
    double real = 0, imaginary = 0;
    for (size_t k = 0; k < particles->count; k++) {
        real += cos(turn * particles->position[axis][k]);
        imaginary += sin(turn * particles->position[axis][k]);
    }
    return atan2(imaginary, real) / (2 * M_PI);
}

static void add_profile(struct state *s, const struct particles *particles) {
    double *const sums = mf_sample_blocks_next(&s->blocks);
    const double middle = find_middle(particles, s->axis);
    const double one = (double)s->bins / mf_box_volume(&s->box);
    for (size_t k = 0; k < particles->count; k++) {
        const double share =
            particles->position[s->axis][k] / s->box.length[s->axis] - middle + 0.5;
        const size_t bin = (size_t)((share - floor(share)) * (double)s->bins);
        const size_t at = bin < s->bins ? bin : s->bins - 1;
        sums[at] += one;
        if (s->curves > 1)
            sums[(size_t)(1 + mf_composition_type(&s->composition, particles->id[k])) * s->bins +
                 at] += one;
    }
}

static enum status add_stress(struct state *s, const struct simulation *simulation) {
    const int dimensions = s->box.dimensions;
    const double volume = mf_box_volume(&s->box);
    double virial[3][3], trace = 0, numbers[SERIES];
    TRY(mf_simulation_look_virial(simulation, virial));
    for (int d = 0; d < dimensions; d++)
        trace += virial[d][d];
    const double along = virial[s->axis][s->axis], across = (trace - along) / (dimensions - 1);
    numbers[TENSION] = 0.5 * s->box.length[s->axis] * (along - across) / volume;
    numbers[NORMAL] = mf_simulation_pressure(simulation) + (along - trace / dimensions) / volume;
    return mf_sample_series_add(&s->series, numbers);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    add_profile(s, &simulation->particles);
    return add_stress(s, simulation);
}

/// Those of the series first, whose lengths depend on the first.
static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    const size_t n = mf_sample_series_spans(&s->series, spans);
    return n + mf_sample_blocks_spans(&s->blocks, spans + n);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->series);
}

// Results -----------------------------------------------------------------------------------------

/// Numbers of the fit that have errors.
enum { LIQUID, VAPOUR, WIDTH, NUMBERS };
static const char *const names[] = {"liquid_density", "vapour_density", "interface_width",
                                    "surface_tension"};

struct found {
    struct slab_fit fit;
    bool has_step, is_slab;
    double value[NUMBERS], error[NUMBERS]; ///< NaN: not known
};

/// Density in a bin of one curve, the mean of all whole blocks but one, or of all for −1.
static double mean_without(const struct state *s, size_t k, int without) {
    double sum = 0, samples = 0;
    for (size_t b = 0; b < mf_sample_blocks_whole(&s->blocks); b++)
        if ((int)b != without) {
            sum += s->blocks.sums[b * s->blocks.row + k];
            samples += s->blocks.samples[b];
        }
    return sum / samples;
}

static void numbers_of(const struct slab_fit *fit, double numbers[NUMBERS]) {
    numbers[LIQUID] = fit->liquid;
    numbers[VAPOUR] = fit->vapour;
    numbers[WIDTH] = fit->width;
}

/// The fit, and its errors by what it is without each of the blocks: pseudo-values
/// B θ − (B − 1) θ_(b), whose scatter is that of a mean of B values.
static enum status find(const struct state *s, struct found *found) {
    const size_t blocks = mf_sample_blocks_whole(&s->blocks);
    double pseudo[NUMBERS][MAX_BLOCKS];
    OWNED double *density = NULL;
    *found = (struct found){0};
    TRY_ARRAY(density, s->bins);
    for (size_t k = 0; k < s->bins; k++)
        density[k] = mean_without(s, k, -1);
    const double length = s->box.length[s->axis];
    found->fit = mf_slab_fit(density, s->bins, length, NULL);
    const double volume = mf_box_volume(&s->box);
    found->has_step = mf_slab_fit_is_slab(&found->fit, length, volume, s->count);
    found->is_slab = found->has_step &&
                     mf_slab_fit_rises_once(&found->fit,
                                            &(struct slab_blocks){s->blocks.sums, s->blocks.samples,
                                                                  blocks, s->blocks.row},
                                            s->bins, length, volume);
    numbers_of(&found->fit, found->value);
    for (size_t b = 0; b < blocks && blocks > 1; b++) {
        double without[NUMBERS];
        for (size_t k = 0; k < s->bins; k++)
            density[k] = mean_without(s, k, (int)b);
        const struct slab_fit fit = mf_slab_fit(density, s->bins, length, &found->fit);
        numbers_of(&fit, without);
        for (int n = 0; n < NUMBERS; n++)
            pseudo[n][b] = (double)blocks * found->value[n] - (double)(blocks - 1) * without[n];
    }
    for (int n = 0; n < NUMBERS; n++)
        found->error[n] = blocks > 1 ? mf_statistics_correlated_error(pseudo[n], blocks, 1) : NAN;
    return STATUS_OK;
}

static const char *axis_name(const struct state *s) {
    static const char *const axes[] = {"x", "y", "z"};
    return axes[s->axis];
}

/// Why there are no numbers.
static enum status warn_no_slab(const struct state *s, const struct found *found) {
    const char *const axis = axis_name(s);
    if (found->fit.liquid_bins < 2 || found->fit.vapour_bins < 2)
        return mf_status_fail(STATUS_UNCONVERGED,
                              "no interface found: the density along %s has no two plateaus with "
                              "an interface between them; a slab may begin by \"slab\" of "
                              "\"particles\", in a box that is longer, or at a lower temperature",
                              axis);
    if (found->has_step)
        return mf_status_fail(
            STATUS_UNCONVERGED,
            "no interface found: more than one slab, or a hole: the density along "
            "%s rises more than once; begin by \"slab\" of \"particles\"",
            axis);
    return mf_status_fail(STATUS_UNCONVERGED,
                          "no interface found: the densities along %s differ by no more than "
                          "chance allows; a slab may begin by \"slab\" of \"particles\", at a "
                          "lower temperature",
                          axis);
}

static enum status assess(const void *state, const struct simulation_setup *setup) {
    const struct state *s = state;
    struct found found;
    (void)setup;
    TRY(find(s, &found));
    if (!found.is_slab)
        return warn_no_slab(s, &found);
    return mf_equilibration_check("surface tension",
                                  s->box.dimensions == 3 ? tension_unit : line_unit,
                                  sample_series_column(&s->series, TENSION), s->series.count);
}

/// slab.tsv: places from the middle of the slab, density with its error, the fit, and in a mixture
/// the density and error of each type.
static enum status write(const void *state, const struct observable_results *results) {
    enum { FIRST = 4, MAX = FIRST + 2 * COMPOSITION_MAX_TYPES };
    static const char *const axes[] = {"x[lambda]", "y[lambda]", "z[lambda]"};
    const struct state *s = state;
    const size_t bins = s->bins;
    struct data_column columns[MAX];
    char heads[MAX][COMPOSITION_NAME_SIZE + 32];
    struct found found;
    OWNED double *values = NULL;
    TRY(find(s, &found));
    TRY_ARRAY(values, 2 * bins + 2 * s->blocks.row);
    double *const z = values, *const fit = z + bins, *const density = fit + bins,
                  *const error = density + s->blocks.row;
    for (size_t k = 0; k < bins; k++) {
        z[k] = s->box.length[s->axis] * (((double)k + 0.5) / (double)bins - 0.5);
        fit[k] = found.is_slab ? mf_slab_fit_value(&found.fit, z[k]) : NAN;
    }
    for (size_t k = 0; k < s->blocks.row; k++)
        density[k] = mf_sample_blocks_mean(&s->blocks, k, 1, &error[k]);
    mf_statistics_mark_unknown_errors(error, s->blocks.row);
    columns[0] = (struct data_column){axes[s->axis], z, "%.6g"};
    columns[1] = (struct data_column){"density[1/lambda^d]", density, "%.6g"};
    columns[2] = (struct data_column){"error[1/lambda^d]", error, "%.3g"};
    columns[3] = (struct data_column){"fit[1/lambda^d]", fit, "%.6g"};
    for (size_t curve = 1; curve < s->curves; curve++) {
        const size_t n = FIRST + 2 * (curve - 1);
        const char *const name = s->composition.name[curve - 1];
        snprintf(heads[n], sizeof heads[n], "density_%s[%s]", name, density_unit);
        snprintf(heads[n + 1], sizeof heads[n + 1], "error_%s[%s]", name, density_unit);
        columns[n] = (struct data_column){heads[n], density + curve * bins, "%.6g"};
        columns[n + 1] = (struct data_column){heads[n + 1], error + curve * bins, "%.3g"};
    }
    return mf_observable_table(results, "slab.tsv", columns, FIRST + 2 * (s->curves - 1), bins);
}

static double find_tension(const struct state *s, double *error) {
    const double mean = mf_sample_series_mean(&s->series, TENSION, error);
    *error = s->series.count > 1 ? *error : NAN;
    return mean;
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    static const char *const units[NUMBERS] = {density_unit, density_unit, "lambda"};
    const struct state *s = state;
    struct found found;
    double error;
    if (mf_units_convert_message(results->units, assess(s, results->setup)) != STATUS_OK)
        mf_json_write_text(writer, "slab_warning", mf_status_message());
    if (find(s, &found) != STATUS_OK || !found.is_slab)
        return;
    for (int n = 0; n < NUMBERS; n++)
        mf_json_put_measured(writer, names[n], units[n], found.value[n], found.error[n]);
    const double tension = find_tension(s, &error);
    const bool in_space = s->box.dimensions == 3;
    mf_json_put_measured(writer, names[NUMBERS], in_space ? tension_unit : line_unit, tension,
                         error);
    if (in_space && mf_units_known(results->units)) {
        // 1 bar nm = 0.1 mN/m
        const double factor = 0.1 * mf_units_pressure_bar(results->units) * results->units->length;
        mf_json_write_number(writer, "surface_tension_mN_per_m", factor * tension);
        mf_json_write_number(writer, "surface_tension_error_mN_per_m", factor * error);
    }
    const double normal = mf_sample_series_mean(&s->series, NORMAL, &error);
    mf_json_put_measured(writer, "pressure_normal", pressure_unit, normal,
                         s->series.count > 1 ? error : NAN);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    char text[NUMBERS + 1][UNITS_MEASURED_SIZE];
    struct found found;
    double error;
    if (find(s, &found) != STATUS_OK || !found.is_slab) {
        snprintf(line, size, "slab: no interface found");
        return;
    }
    const double tension = find_tension(s, &error);
    for (int n = 0; n < NUMBERS; n++)
        mf_units_measured(results->units, n == WIDTH ? "lambda" : density_unit, found.value[n],
                          found.error[n], text[n]);
    mf_units_measured(results->units, s->box.dimensions == 3 ? tension_unit : line_unit, tension,
                      error, text[NUMBERS]);
    snprintf(line, size,
             "slab: density %s in the liquid, %s in the vapour, interface %s wide, %s tension %s",
             text[LIQUID], text[VAPOUR], text[WIDTH], s->box.dimensions == 3 ? "surface" : "line",
             text[NUMBERS]);
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct state *s = state;
    struct found found;
    TRY(find(s, &found));
    for (int n = 0; n < NUMBERS; n++)
        mf_pooled_set(&values[n], found.is_slab ? &found.value[n] : &(double){NAN},
                      &found.error[n]);
    double error, tension = find_tension(s, &error);
    tension = found.is_slab ? tension : NAN;
    mf_pooled_set(&values[NUMBERS], &tension, &error);
    *blocks = (double)mf_sample_blocks_whole(&s->blocks);
    return STATUS_OK;
}

// Record ------------------------------------------------------------------------------------------

/// Nanoseconds of a particle: its place in the profile; a list and a pass of forces of its own.
static const double particle_cost = 40, pair_cost = 4;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const double pairs = mf_stages_pairs_within(setup, mf_stages_cutoff(setup));
    mf_stages_add(stages, "slab", true, (particle_cost + pair_cost * pairs) / every,
                  "%zu bins, a list and forces of its own, one step in %.0f", find_bins(settings),
                  every);
}

static const struct field fields[] = {
    {"bins", FIELD_INTEGER, offsetof(struct settings, bins), .initial = 0, .minimum = 0,
     .maximum = 100000, .unit = "", .help = "bins along the longest edge; 0: 200"},
    FIELD_END,
};
static const char *const files[] = {"slab.tsv", NULL};

static const struct observable_target targets[] = {
    {.name = "liquid_density",
     .summary = "density within a slab",
     .form = OBSERVABLE_NUMBER,
     .unit = density_unit},
    {.name = "vapour_density",
     .summary = "density beside a slab",
     .form = OBSERVABLE_NUMBER,
     .unit = density_unit},
    {.name = "interface_width",
     .summary = "of a slab, between 10 and 90 % of the step",
     .form = OBSERVABLE_NUMBER,
     .unit = "lambda"},
    {.name = "surface_tension",
     .summary = "of a slab; of two dimensions times lambda",
     .form = OBSERVABLE_NUMBER,
     .unit = tension_unit},
    {.name = NULL}};

const struct observable mf_slab = {
    .name = "slab",
    .summary = "densities, interface and surface tension of a slab across the longest edge",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sums = true,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .assess = assess,
    .explain = explain,
    .stage = "slab",
    .files = files,
    .figure = "slab",
    .targets = targets,
    .result = result,
};
