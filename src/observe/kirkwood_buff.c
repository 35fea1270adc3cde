// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/kirkwood_buff.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "forces/molecules.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "observe/sample_blocks.h"

#include <math.h>

/// ∫_0^r 4π s² u(s/L) ds.
static double weight_below(double r, double range) {
    const double x = r / range, x3 = x * x * x;
    return 4 * M_PI * range * range * range * x3 *
           (1.0 / 3 + x3 * (-23.0 / 48 + x * (3.0 / 28 + x * 9.0 / 64)));
}

struct kirkwood_buff mf_kirkwood_buff_integrate(const struct rdf_bins *bins, const double *g,
                                                const double *error, const struct box *box,
                                                size_t count, double inside) {
    const double range = mf_rdf_bins_range(bins);
    const double volume = mf_box_volume(box);
    const double density = (double)count / volume, all = weight_below(range, range);
    double below = weight_below(mf_rdf_bins_edge(bins, 0), range), sum = inside - below,
           squares = 0;
    if (4.0 / 3 * M_PI * range * range * range > volume)
        return (struct kirkwood_buff){NAN, NAN, NAN, NAN};
    for (size_t k = 0; k < bins->count; k++) {
        const double above = weight_below(mf_rdf_bins_edge(bins, k + 1), range);
        const double own_error = isfinite(error[k]) ? error[k] : 0;
        sum += (g[k] - 1) * (above - below);
        squares += pow((above - below) * own_error, 2);
        below = above;
    }
    const double integral = sum / (1 - all / volume);
    const double integral_error = sqrt(squares) / (1 - all / volume);
    return (struct kirkwood_buff){.integral = integral,
                                  .integral_error = integral_error,
                                  .compressibility = 1 + density * integral,
                                  .compressibility_error = density * integral_error};
}

/// The scatter of G is that over so many ranges, from this part of the bins on to all of them.
enum { RANGES = 16 };
static const double shortest_range = 0.7;

struct kirkwood_buff mf_kirkwood_buff_of_range(const struct rdf_bins *bins, const double *g,
                                               const double *error, const struct box *box,
                                               size_t count, double inside) {
    struct kirkwood_buff whole = mf_kirkwood_buff_integrate(bins, g, error, box, count, inside);
    const double density = (double)count / mf_box_volume(box);
    double squares = whole.integral_error * whole.integral_error;
    for (int k = 0; k < RANGES; k++) {
        const double part = shortest_range + (1 - shortest_range) * k / RANGES;
        struct rdf_bins fewer = *bins;
        fewer.count = (size_t)ceil(part * (double)bins->count);
        const struct kirkwood_buff own =
            mf_kirkwood_buff_integrate(&fewer, g, error, box, count, inside);
        squares += pow(own.integral - whole.integral, 2) / RANGES;
    }
    whole.integral_error = sqrt(squares);
    whole.compressibility_error = density * whole.integral_error;
    return whole;
}

struct kirkwood_buff mf_kirkwood_buff_known(const struct rdf_bins *bins, const double *g,
                                            const double *error, const struct box *box,
                                            size_t count, double inside) {
    static const double standard_errors = 3, tail = 0.003; // of N particles it is below 1 by S(0)/N
    struct kirkwood_buff found = mf_kirkwood_buff_of_range(bins, g, error, box, count, inside);
    bool reaches = false, has_errors = false;
    for (size_t k = 0; k < bins->count; k++) {
        const double own = isfinite(error[k]) ? error[k] : 0;
        reaches = reaches || g[k] + standard_errors * own >= 1 - tail;
        has_errors = has_errors || own > 0;
    }
    if (!reaches)
        return (struct kirkwood_buff){NAN, NAN, NAN, NAN};
    if (!has_errors)
        found.integral_error = found.compressibility_error = NAN;
    return found;
}

//
// Means of G of each pair of components over blocks of samples. Errors see the correlation of the
// blocks: long waves decay slowly, with the collective diffusion D/S(q) times q². Tested:
// test_kirkwood_buff_waves.

// By waves ----------------------------------------------------------------------------------------

/// R_g of the largest molecules, as of a random walk whose steps are the mean distance of all
/// beads.
static double guess_size(const struct box *box, size_t beads, const struct topology *topology) {
    const double step = pow(mf_box_volume(box) / (double)beads, 1.0 / box->dimensions);
    int max = 1;
    for (int k = 0; topology && k < topology->kinds; k++)
        max = topology->kind[k].beads > max ? topology->kind[k].beads : max;
    return step * sqrt(max / 6.0);
}

double mf_kirkwood_buff_waves_maximum(const struct box *box, size_t sites, size_t beads,
                                      const struct topology *topology, double wish) {
    static const double part = 0.2; // of 2π ρ^(1/d), near the first peak of S
    const double density = (double)sites / mf_box_volume(box);
    const double of_sites = part * 2 * M_PI * pow(density, 1.0 / box->dimensions);
    return wish > 0 ? wish : fmin(of_sites, 1 / guess_size(box, beads, topology));
}

/// About how many waves there are up to a wave number.
static double kirkwood_buff_waves_expected(const struct box *box, double q_maximum) {
    const double ball = mf_box_shell_volume(box, 0, q_maximum);
    return ball * mf_box_volume(box) / pow(2 * M_PI, box->dimensions) / 2;
}

static double squared_length(const struct density_waves *waves, size_t k) {
    double square = 0;
    for (int d = 0; d < 3; d++) {
        double q = 0;
        for (int i = 0; i < 3; i++)
            q += waves->wave[k].n[i] * waves->lattice[i][d];
        square += q * q;
    }
    return square;
}

/// Weights of the intercept of least squares, Σ (S − S_0 − c q²)².
static enum status find_weights(struct kirkwood_buff_waves *kb) {
    static const double same = 1e-6;
    const struct density_waves *waves = &kb->waves;
    const double count = (double)waves->vectors;
    double first = 0, second = 0;
    for (size_t k = 0; k < waves->vectors; k++) {
        const double x = squared_length(waves, k);
        first += x;
        second += x * x;
    }
    const double spread = count * second - first * first;
    if (!(spread > same * count * second))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the waves of the box up to q_maximum %.4g" STATUS_WAVE_NUMBER
                              " all have one length, so that S(q) cannot be "
                              "extrapolated to q = 0: take a box with more particles",
                              kb->q_maximum);
    for (size_t k = 0; k < waves->vectors; k++)
        kb->weight[k] = (second - squared_length(waves, k) * first) / spread;
    return STATUS_OK;
}

enum status mf_kirkwood_buff_waves_init(struct kirkwood_buff_waves *kb, const struct box *box,
                                        const struct composition *composition, size_t count,
                                        const struct topology *topology, double q_maximum) {
    const struct box_vectors vectors = mf_box_vectors_of(box);
    const struct composition *const components = &kb->sites.components;
    *kb = (struct kirkwood_buff_waves){.box = *box};
    TRY(mf_component_sites_init(&kb->sites, box->dimensions, composition, count, topology));
    kb->q_maximum = mf_kirkwood_buff_waves_maximum(
        box, (size_t)mf_composition_particles(components), count, topology, q_maximum);
    const struct density_waves_plan plan = {
        .composition = *components, .q_maximum = kb->q_maximum, .bins = 1};
    TRY(mf_density_waves_init(&kb->waves, &plan));
    TRY(mf_density_waves_list(&kb->waves, &vectors));
    TRY_ARRAY(kb->weight, kb->waves.vectors);
    return find_weights(kb);
}

void mf_kirkwood_buff_waves_clear(struct kirkwood_buff_waves *kb) {
    mf_density_waves_clear(&kb->waves);
    mf_component_sites_clear(&kb->sites);
    mf_memory_free(kb->weight);
    *kb = (struct kirkwood_buff_waves){0};
}

const struct composition *mf_kirkwood_buff_waves_components(const struct kirkwood_buff_waves *kb) {
    return &kb->sites.components;
}

/// Σ weight Re ρ_a ρ_b*.
static double extrapolate(const struct kirkwood_buff_waves *kb, const int type[2]) {
    const struct density_waves *waves = &kb->waves;
    const size_t types = (size_t)waves->plan.composition.types;
    double sum = 0;
    for (size_t k = 0; k < waves->vectors; k++) {
        const double *const rho = waves->amplitude + 2 * k * types;
        const double *const a = rho + 2 * type[0], *const b = rho + 2 * type[1];
        sum += kb->weight[k] * (a[0] * b[0] + a[1] * b[1]);
    }
    return sum;
}

static void find_waves(struct kirkwood_buff_waves *kb, const struct particles *particles,
                       int threads) {
    struct density_places places = {{NULL}, {0}};
    mf_component_sites_find(&kb->sites, particles);
    for (int d = 0; d < kb->box.dimensions; d++) {
        places.place[d] = kb->sites.site[d];
        places.unit[d] = 2 * M_PI / kb->box.length[d];
    }
    mf_density_waves_find(&kb->waves, &places, threads);
}

void mf_kirkwood_buff_waves_take(struct kirkwood_buff_waves *kb, const struct particles *particles,
                                 int threads, double *integral) {
    const struct composition *components = mf_kirkwood_buff_waves_components(kb);
    const double volume = mf_box_volume(&kb->box);
    find_waves(kb, particles, threads);
    for (int pair = 0; pair < mf_composition_pairs(components); pair++) {
        int type[2];
        mf_composition_pair_types(components, pair, type);
        const double a = (double)components->count[type[0]];
        const double b = (double)components->count[type[1]];
        integral[pair] =
            volume * (extrapolate(kb, type) / (a * b) - (type[0] == type[1] ? 1 / a : 0));
    }
}

// Observable --------------------------------------------------------------------------------------

static const char unit[] = "lambda^d";

const struct field mf_kirkwood_buff_observable_fields[] = {
    {"q_maximum", FIELD_NUMBER, .offset = offsetof(struct kirkwood_buff_settings, q_maximum),
     .initial = 0, .minimum = 0, .maximum = DBL_MAX, .unit = "1/lambda",
     .help = "largest wave number of the extrapolation to q = 0; 0: a fifth of 2 pi density^(1/d), "
             "less for large molecules"},
    FIELD_END,
};

struct state {
    struct kirkwood_buff_waves waves;
    struct sample_blocks blocks; ///< of the integrals
    size_t pairs;
    double density;
    double *integral; ///< of one sample, shape [pairs] [λ^d]
};

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    enum status status = STATUS_OK;
    struct state *s = state;
    const struct simulation_setup *setup = &simulation->setup;
    const size_t count = simulation->particles.count;
    const struct molecules *molecules = configuration->molecules;
    status = mf_kirkwood_buff_waves_init(
        &s->waves, &setup->box, &setup->composition, count, molecules ? &molecules->topology : NULL,
        ((const struct kirkwood_buff_settings *)settings)->q_maximum);
    CHECK(status == STATUS_BAD_INPUT ? mf_status_prefix(status, "kirkwood_buff") : status);
    const struct composition *components = mf_kirkwood_buff_waves_components(&s->waves);
    s->pairs = (size_t)mf_composition_pairs(components);
    s->density = (double)mf_composition_particles(components) / mf_box_volume(&setup->box);
    CHECK(mf_sample_blocks_init(&s->blocks, (size_t)plan->samples, s->pairs));
    NEW_ARRAY(s->integral, s->pairs);
done:
    return status;
}

static void clear(void *state) {
    struct state *s = state;
    mf_kirkwood_buff_waves_clear(&s->waves);
    mf_sample_blocks_clear(&s->blocks);
    mf_memory_free(s->integral);
    *s = (struct state){0};
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    double *const sums = mf_sample_blocks_next(&s->blocks);
    mf_kirkwood_buff_waves_take(&s->waves, &simulation->particles, simulation->setup.threads,
                                s->integral);
    for (size_t pair = 0; pair < s->pairs; pair++)
        sums[pair] += s->integral[pair];
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_sample_blocks_spans(&((struct state *)state)->blocks, spans);
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct state *s = state;
    for (size_t pair = 0; pair < s->pairs && values->count > 0; pair++)
        values->value[pair] = mf_sample_blocks_mean(&s->blocks, pair, 1, &values->error[pair]);
    *blocks = (double)mf_sample_blocks_whole(&s->blocks);
    return STATUS_OK;
}

/// A number that is known.
static void write_known(struct json_writer *writer, const char *what, const char *error,
                        const char *pair, double value) {
    char key[COMPOSITION_PAIR_NAME_SIZE + 40];
    snprintf(key, sizeof key, "%s%s%s%s", what, error, pair[0] ? "_" : "", pair);
    if (isfinite(value))
        mf_json_write_quantity(writer, key, unit, value);
}

void mf_kirkwood_buff_write(struct json_writer *writer, const char *what,
                            const struct composition *components, size_t pair, double value,
                            double error) {
    char name[COMPOSITION_PAIR_NAME_SIZE];
    mf_composition_pair_name(components, (int)pair, name);
    write_known(writer, what, "", name, value);
    write_known(writer, what, "_error", name, error > 0 ? error : NAN);
}

/// κ_T = (1 + ρG)/(ρ k_B T) where the temperature is held.
static void write_isothermal(const struct state *s, const struct observable_results *results,
                             double integral, double error, struct json_writer *writer) {
    const double unit_of = 1 / (s->density * results->setup->temperature);
    const double value = (1 + s->density * integral) * unit_of;
    const double value_error = s->density * error * unit_of;
    if (!mf_simulation_is_thermal(results->setup) || !simulation_holds_temperature(results->setup))
        return;
    if (!mf_units_are_physical(results->units))
        mf_json_put_measured(writer, "isothermal_compressibility", "lambda^d/(k_B T_0)", value,
                             value_error);
    if (mf_units_known(results->units) && results->setup->box.dimensions == 3) {
        const double bar = mf_units_pressure_bar(results->units);
        mf_json_put_measured(writer, "isothermal_compressibility_per_bar", "1", value / bar,
                             value_error / bar);
    }
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    double value, error;
    for (size_t pair = 0; pair < s->pairs; pair++) {
        value = mf_sample_blocks_mean(&s->blocks, pair, 1, &error);
        mf_kirkwood_buff_write(writer, "kirkwood_buff",
                               mf_kirkwood_buff_waves_components(&s->waves), pair, value, error);
    }
    if (s->pairs == 1) {
        mf_json_put_measured(writer, "compressibility", "1", 1 + s->density * value,
                             s->density * error);
        write_isothermal(s, results, value, error, writer);
    }
    mf_json_write_quantity(writer, "kirkwood_buff_q_maximum", "1/lambda", s->waves.q_maximum);
    mf_json_write_number(writer, "kirkwood_buff_waves", (double)s->waves.waves.vectors);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    int length = snprintf(line, size, "Kirkwood-Buff integral%s", s->pairs > 1 ? "s" : "");
    for (size_t pair = 0; pair < s->pairs && length < (int)size; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE], text[UNITS_MEASURED_SIZE];
        double value, error;
        value = mf_sample_blocks_mean(&s->blocks, pair, 1, &error);
        mf_composition_pair_name(mf_kirkwood_buff_waves_components(&s->waves), (int)pair, name);
        length += snprintf(line + length, size - (size_t)length, "%s %s%s%s", pair ? "," : "", name,
                           name[0] ? " " : "",
                           mf_units_measured(results->units, unit, value, error, text));
    }
}

/// Nanoseconds of a site and wave vector.
static const double wave_cost = 1.1;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const double wish = ((const struct kirkwood_buff_settings *)settings)->q_maximum;
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const struct topology *topology = molecules ? &molecules->topology : NULL;
    const size_t beads = (size_t)setup->placement.count;
    struct composition components;
    if (mf_components_find(&components, &setup->composition, beads, topology) != STATUS_OK)
        return; // which the scene's beginning tells
    const size_t sites = (size_t)mf_composition_particles(&components);
    const double waves = kirkwood_buff_waves_expected(
        &setup->box, mf_kirkwood_buff_waves_maximum(&setup->box, sites, beads, topology, wish));
    mf_stages_add(stages, "Kirkwood-Buff integrals", true,
                  wave_cost * waves * (double)sites / ((double)beads * every),
                  "about %.0f wave vectors, one step in %.0f", waves, every);
}

static const struct observable_target targets[] = {
    {.name = "kirkwood_buff",
     .summary = "Kirkwood-Buff integrals of pairs of components",
     .form = OBSERVABLE_OWN_FORM,
     .unit = unit,
     .has_settings = true},
    {.name = NULL}};

const struct observable mf_kirkwood_buff_observable = {
    .name = "kirkwood_buff",
    .summary = "Kirkwood-Buff integrals from S(q) at small q",
    .fields = mf_kirkwood_buff_observable_fields,
    .settings_size = sizeof(struct kirkwood_buff_settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "Kirkwood-Buff integrals",
    .targets = targets,
    .result = result,
};

int mf_kirkwood_buff_kind(void) {
    int kind = 0;
    while (mf_observable_kind(kind).observable != &mf_kirkwood_buff_observable)
        kind++;
    return kind;
}
