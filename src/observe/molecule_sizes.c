// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Sizes of molecules, by kind:
///   ⟨R_g²⟩ = ⟨Σ_i m_i |r_i − r_cm|²⟩/Σ m,   ⟨R_e²⟩ = ⟨|r_N − r_1|²⟩ of the last and the first
///   bead,
/// and the correlation of the end-to-end vector, ⟨R_e(t) · R_e(0)⟩/⟨R_e²⟩. Molecules are made whole
/// along their bonds. Errors of the means see the correlation of the samples, those of the
/// correlation that of blocks of time; where molecules remember longer than a run, both are of the
/// scatter of parts of the molecules. Tested: test_bonded_errors, physics/test_molecules.
#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "forces/molecules.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_blocks.h"
#include "observe/sample_series.h"
#include "system/whole_molecules.h"

#include <math.h>

/// Means over the molecules of a kind in a sample: ⟨R_g²⟩, ⟨R_e²⟩ [λ²].
enum { GYRATION, END, NUMBERS };

/// Of a kind's molecules, for errors.
enum { MAX_PARTS = 20 };

struct settings {
    int64_t lags;
};

struct state {
    const struct molecules *molecules;
    /// Of R(t)·R(0) of each kind [λ²], and of how many there are: shape [kinds + 1, lags + 1].
    struct sample_blocks blocks;
    size_t lags, every;
    double begin, time_step;     ///< step of the first sample, Δt or 1 sweep
    const char *clock;           ///< what tables call it
    struct sample_series series; ///< NUMBERS of each kind
    double *ends; ///< shape [lags + 1, molecules, 3]: the last end-to-end vectors [λ]
    /// Shape [kinds, MAX_PARTS, NUMBERS + lags + 1]: sums of the numbers and of the products over
    /// samples and every so manieth molecule of a kind.
    double *of_part;
    struct whole_molecules whole;
};

static const struct field fields[] = {
    {"lags", FIELD_INTEGER, .offset = offsetof(struct settings, lags), .initial = 100, .minimum = 0,
     .maximum = 100000, .unit = "samples",
     .help = "length of the correlation function of the end-to-end vector"},
    FIELD_END,
};

/// R_g² of the molecule that was made whole.
static double find_gyration(const struct state *s, const struct particles *particles,
                            const struct topology_kind *kind, int64_t m) {
    const double *mass = particles_masses(particles);
    double all = 0, gyration = 0, centre[3] = {0};
    for (int bead = 0; bead < kind->beads; bead++) {
        const double own = mass ? mass[particles->place[topology_id(kind, m, bead)]] : 1;
        all += own;
        for (int d = 0; d < 3; d++) {
            centre[d] += own * s->whole.place[bead][d];
            gyration += own * s->whole.place[bead][d] * s->whole.place[bead][d];
        }
    }
    gyration /= all;
    for (int d = 0; d < 3; d++)
        gyration -= centre[d] * centre[d] / (all * all);
    return gyration;
}

// Sampling ----------------------------------------------------------------------------------------

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    struct state *s = state;
    const struct molecules *molecules = configuration->molecules;
    if (molecules == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "molecule_sizes: the scene has no molecules");
    const struct topology *topology = &molecules->topology;
    const size_t kinds = (size_t)topology->kinds, planned = (size_t)plan->samples;
    const size_t lags = (size_t)((const struct settings *)settings)->lags;
    *s = (struct state){.molecules = molecules,
                        .lags = planned == 0 || lags < planned ? lags : planned - 1,
                        .every = (size_t)plan->every,
                        .begin = (double)plan->equilibration,
                        .time_step = configuration->sweeps ? 1 : configuration->time_step,
                        .clock = configuration->sweeps ? "sweeps[1]" : "time[tau]",
                        .series.columns = NUMBERS * kinds};
    TRY(mf_sample_blocks_init(&s->blocks, planned, (kinds + 1) * (s->lags + 1)));
    TRY_ARRAY(s->ends, 3 * (s->lags + 1) * (size_t)topology->molecules);
    TRY_ARRAY(s->of_part, kinds * MAX_PARTS * (NUMBERS + s->lags + 1));
    return mf_whole_molecules_init(&s->whole, topology);
}

static void clear(void *state) {
    struct state *s = state;
    mf_sample_series_clear(&s->series);
    mf_memory_free(s->ends);
    mf_memory_free(s->of_part);
    mf_whole_molecules_clear(&s->whole);
    mf_sample_blocks_clear(&s->blocks);
    *s = (struct state){0};
}

static double *vectors_of(const struct state *s, size_t sample) {
    return s->ends + 3 * (sample % (s->lags + 1)) * (size_t)s->molecules->topology.molecules;
}

/// Parts of a kind's molecules, and the sums of one of them.
static size_t parts_of(const struct state *s, int k) {
    const size_t count = (size_t)s->molecules->topology.kind[k].count;
    return count < MAX_PARTS ? count : MAX_PARTS;
}

static double *part_of(const struct state *s, int k, size_t molecule) {
    const size_t part = (size_t)k * MAX_PARTS + molecule % parts_of(s, k);
    return s->of_part + part * (NUMBERS + s->lags + 1);
}

/// Products of a sample's end-to-end vectors with those of the samples before.
static void correlate(struct state *s, size_t sample, double *sums) {
    const struct topology *topology = &s->molecules->topology;
    const size_t row = s->lags + 1;
    const double *now = vectors_of(s, sample);
    for (size_t lag = 0; lag <= s->lags && lag <= sample; lag++) {
        const double *then = vectors_of(s, sample - lag);
        for (int k = 0; k < topology->kinds; k++) {
            const struct topology_kind *kind = &topology->kind[k];
            double sum = 0;
            for (size_t m = 0; m < (size_t)kind->count; m++) {
                const double *a = now + 3 * ((size_t)kind->first + m);
                const double *b = then + 3 * ((size_t)kind->first + m);
                double own = 0;
                for (int d = 0; d < 3; d++) {
                    sum += a[d] * b[d];
                    own += a[d] * b[d];
                }
                part_of(s, k, m)[NUMBERS + lag] += own;
            }
            sums[(size_t)k * row + lag] += sum / (double)kind->count;
        }
        sums[(size_t)topology->kinds * row + lag] += 1;
    }
}

static enum status sample(void *state, const struct configuration *configuration) {
    struct state *s = state;
    const struct particles *const particles = configuration->particles;
    const struct topology *topology = &s->molecules->topology;
    const size_t number = s->blocks.taken;
    double *vectors = vectors_of(s, number), numbers[NUMBERS * TOPOLOGY_MAX_KINDS];
    double *const sums = mf_sample_blocks_next(&s->blocks);
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        double gyration = 0, end = 0;
        for (int64_t m = 0; m < kind->count; m++) {
            double *vector = vectors + 3 * (kind->first + m);
            double *part = part_of(s, k, (size_t)m);
            mf_whole_molecules_make(&s->whole, particles, k, m);
            const double own = find_gyration(s, particles, kind, m);
            gyration += own;
            part[GYRATION] += own;
            for (int d = 0; d < 3; d++) {
                vector[d] = s->whole.place[kind->end[1]][d] - s->whole.place[kind->end[0]][d];
                end += vector[d] * vector[d];
                part[END] += vector[d] * vector[d];
            }
        }
        numbers[NUMBERS * k + GYRATION] = gyration / (double)kind->count;
        numbers[NUMBERS * k + END] = end / (double)kind->count;
    }
    correlate(s, number, sums);
    return mf_sample_series_add(&s->series, numbers);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    const size_t kinds = (size_t)s->molecules->topology.kinds, row = s->lags + 1;
    const size_t vectors = 3 * row * (size_t)s->molecules->topology.molecules;
    size_t n = mf_sample_series_spans(&s->series, spans);
    spans[n++] = (struct memory_span){s->ends, vectors * sizeof *s->ends};
    spans[n++] =
        (struct memory_span){s->of_part, kinds * MAX_PARTS * (NUMBERS + row) * sizeof *s->of_part};
    return n + mf_sample_blocks_spans(&s->blocks, spans + n);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->series);
}

// Results -----------------------------------------------------------------------------------------

enum { MAX_COLUMNS = 1 + 2 * TOPOLOGY_MAX_KINDS, HEAD_SIZE = TOPOLOGY_NAME_SIZE + 32 };

static const double *series_of(const struct state *s, int k, int which) {
    return sample_series_column(&s->series, (size_t)(NUMBERS * k + which));
}

/// molecule_sizes.tsv: time, and means over the molecules of each kind.
static enum status write_sizes(const struct state *s, const struct observable_results *results) {
    const struct topology *topology = &s->molecules->topology;
    struct data_column columns[MAX_COLUMNS];
    char names[MAX_COLUMNS][HEAD_SIZE];
    OWNED double *time = NULL;
    size_t n = 0;
    TRY_ARRAY(time, s->blocks.taken);
    for (size_t k = 0; k < s->blocks.taken; k++)
        time[k] = (s->begin + (double)((k + 1) * s->every)) * s->time_step;
    columns[n++] = (struct data_column){s->clock, time, NULL};
    for (int k = 0; k < topology->kinds; k++)
        for (int which = 0; which < NUMBERS; which++) {
            snprintf(names[n], HEAD_SIZE, "%s_%s[lambda^2]", which == GYRATION ? "gyration" : "end",
                     topology->kind[k].name);
            columns[n] = (struct data_column){names[n], series_of(s, k, which), "%.8g"};
            n++;
        }
    return mf_observable_table(results, "molecule_sizes.tsv", columns, n, s->blocks.taken);
}

/// Standard error of a mean of a kind's molecules by their parts, which count as independent: of
/// the sums number n over so many samples, less `factor` times those number 0 of the products.
static double error_of_parts(const struct state *s, int k, size_t n, double samples,
                             double factor) {
    struct running_mean mean = {0};
    const size_t parts = parts_of(s, k), count = (size_t)s->molecules->topology.kind[k].count;
    for (size_t part = 0; part < parts; part++) {
        const double *sums = part_of(s, k, part);
        const double molecules = (double)((count - part - 1) / parts + 1);
        mf_statistics_add(&mean,
                          (sums[n] / samples - factor * sums[NUMBERS] / (double)s->blocks.taken) /
                              molecules);
    }
    return mf_statistics_standard_error(&mean);
}

/// The mean product of a lag in blocks of time; returns how many are whole and have any.
static size_t find_products(const struct state *s, int k, size_t lag, double *products) {
    const size_t kinds = (size_t)s->molecules->topology.kinds, row = s->lags + 1;
    size_t blocks = 0;
    for (size_t block = 0; block < mf_sample_blocks_whole(&s->blocks); block++) {
        const double *const sums = s->blocks.sums + block * s->blocks.row;
        const double origins = sums[kinds * row + lag];
        if (origins > 0)
            products[blocks++] = sums[(size_t)k * row + lag] / origins;
    }
    return blocks;
}

/// The normalised correlation of a kind and its error by blocks; shape [2, lags + 1]. It is a ratio
/// c of means, and its error that of the mean of R(t)·R(0) − c R(0)².
static enum status find_correlation(const struct state *s, int k, double *values) {
    const size_t kinds = (size_t)s->molecules->topology.kinds, row = s->lags + 1;
    OWNED double *products = NULL, *squares = NULL, *of_parts = NULL;
    double square = NAN;
    TRY_ARRAY(products, s->blocks.count);
    TRY_ARRAY(squares, s->blocks.count);
    TRY_ARRAY(of_parts, row);
    const size_t whole = find_products(s, k, 0, squares);
    for (size_t lag = 0; lag < row; lag++) {
        double sum = 0, origins = 0;
        for (size_t block = 0; block < s->blocks.count; block++) {
            const double *const sums = s->blocks.sums + block * s->blocks.row;
            sum += sums[(size_t)k * row + lag];
            origins += sums[kinds * row + lag];
        }
        const double mean = origins > 0 ? sum / origins : NAN;
        square = lag == 0 ? mean : square;
        values[lag] = mean / square;
        // Without origins in them are the first blocks, if any.
        const size_t blocks = find_products(s, k, lag, products);
        for (size_t block = 0; block < blocks; block++)
            products[block] -= values[lag] * squares[whole - blocks + block];
        values[row + lag] = mf_statistics_correlated_error(products, blocks, 1) / square;
        of_parts[lag] =
            blocks > 1 ? error_of_parts(s, k, NUMBERS + lag, origins, values[lag]) / square : NAN;
    }
    mf_statistics_take_larger(values + row, of_parts, row);
    mf_statistics_mark_unknown_errors(values + row, row);
    return STATUS_OK;
}

/// end_to_end.tsv: time, correlation and error of each kind.
static enum status write_correlation(const struct state *s,
                                     const struct observable_results *results) {
    const struct topology *topology = &s->molecules->topology;
    const size_t row = s->lags + 1, rows = row < s->blocks.taken ? row : s->blocks.taken;
    struct data_column columns[MAX_COLUMNS];
    char names[MAX_COLUMNS][HEAD_SIZE];
    OWNED double *values = NULL;
    size_t n = 0;
    TRY_ARRAY(values, (1 + 2 * (size_t)topology->kinds) * row);
    for (size_t lag = 0; lag < row; lag++)
        values[lag] = (double)(lag * s->every) * s->time_step;
    columns[n++] = (struct data_column){s->clock, values, NULL};
    for (int k = 0; k < topology->kinds; k++) {
        double *own = values + (1 + 2 * (size_t)k) * row;
        TRY(find_correlation(s, k, own));
        for (int which = 0; which < 2; which++) {
            snprintf(names[n], HEAD_SIZE, "%s%s[1]", topology->kind[k].name,
                     which == 0 ? "" : "_error");
            columns[n] = (struct data_column){names[n], own + (size_t)which * row,
                                              which == 0 ? "%.8g" : "%.3g"};
            n++;
        }
    }
    return mf_observable_table(results, "end_to_end.tsv", columns, n, rows);
}

static enum status write(const void *state, const struct observable_results *results) {
    if (isnan(((const struct state *)state)->time_step)) // frames without known times
        return STATUS_OK;
    TRY(write_correlation(state, results));
    return write_sizes(state, results);
}

static double mean_of(const struct state *s, int k, int which, double *error) {
    const double of_parts = error_of_parts(s, k, (size_t)which, (double)s->blocks.taken, 0);
    const double mean = mf_sample_series_mean(&s->series, (size_t)(NUMBERS * k + which), error);
    mf_statistics_take_larger(error, &of_parts, 1);
    return mean;
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    (void)results;
    mf_json_begin(writer, "molecule_sizes");
    for (int k = 0; k < s->molecules->topology.kinds; k++) {
        double error, mean = mean_of(s, k, GYRATION, &error);
        mf_json_begin(writer, s->molecules->topology.kind[k].name);
        mf_json_put_measured(writer, "gyration_squared", "lambda^2", mean, error);
        mean = mean_of(s, k, END, &error);
        mf_json_put_measured(writer, "end_to_end_squared", "lambda^2", mean, error);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

/// The sizes of the first kind.
static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    const double factor = mf_units_factor(results->units, "lambda^2");
    char end[NUMBER_TEXT_SIZE], gyration[UNITS_MEASURED_SIZE];
    double error, mean = mean_of(s, 0, END, &error);
    mf_number_text(factor * mean, factor * error, end);
    mean = mean_of(s, 0, GYRATION, &error);
    snprintf(line, size, "%s: R_e^2 %s, R_g^2 %s", s->molecules->topology.kind[0].name, end,
             mf_units_measured(results->units, "lambda^2", mean, error, gyration));
}

/// Nanoseconds of a bead in a molecule and sample, and of a molecule and lag.
static const double walk_cost = 30, product_cost = 1.5;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const double count = fmax(1, (double)setup->placement.count);
    const double share = molecules ? (double)molecules->topology.molecules / count : 0;
    const double lags = (double)((const struct settings *)settings)->lags;
    mf_stages_add(stages, "sizes of molecules", true,
                  (walk_cost + product_cost * lags * share) / every, "one step in %.0f", every);
}

static const char *const files[] = {"end_to_end.tsv", "molecule_sizes.tsv", NULL};

const struct observable mf_molecule_sizes = {
    .name = "molecule_sizes",
    .of_places = true,
    .summary = "radius of gyration, end-to-end distance and correlation of its vector",
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
    .print = print,
    .explain = explain,
    .stage = "sizes of molecules",
    .files = files,
    .figure = "molecule_sizes",
};
