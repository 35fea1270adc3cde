// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The static structure factor at the wave vectors of the box.
///
///   S(q) = ⟨|ρ(q)|²⟩/N,   ρ(q) = Σ_j exp(−i q·r_j),   q = 2π (n_x/L_x, n_y/L_y, n_z/L_z) ≠ 0,
///
/// the mean over all q in a bin of |q|, which is told at the mean |q| of them; and for each pair
/// type of a mixture
///   S_ab(q) = Re ⟨ρ_a(q) ρ_b(−q)⟩/sqrt(N_a N_b)
/// (N. W. Ashcroft and D. C. Langreth, Phys. Rev. 156, 685 (1967)), which for large q is 1 for
/// a = b and 0 for others. Only vectors of the box obey its periodicity, so that nothing is cut
/// off, and S of the smallest tells the compressibility: S(0) = ρ k_B T κ_T of one component.
/// Standard errors are those of means over up to 64 blocks of consecutive samples, by
/// mf_statistics_correlated_error. The same bits for any number of threads.
/// Tested: test_structure_factor (unit, cli).
#include "base/memory.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/pooled.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

enum { MOST_BLOCKS = 64, MOST_VECTORS = 1000000 };

struct settings {
    double q_maximum; ///< [1/λ]
    int64_t bins;
};

#define MEMBER(name) .offset = offsetof(struct settings, name)
static const struct field fields[] = {
    {"q_maximum", FIELD_NUMBER, MEMBER(q_maximum), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "1/lambda",
     .help = "largest wave number; the vectors, and their time, grow as its cube"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 100, .minimum = 1, .maximum = 100000,
     .unit = "",
     .help = "of the wave number from 0 on; those without a vector of the box are left "
             "out"},
    FIELD_END,
};

struct wave {
    int n[3];
    size_t bin;
};

struct structure_factor {
    struct composition composition;
    size_t count, types, curves;           ///< S, and in a mixture those of all pair types
    double unit[3];                        ///< 2π/L [1/λ]
    int most[3];                           ///< largest |n| along each axis
    size_t vectors, bins;                  ///< bins with vectors
    struct wave *wave;                     ///< shape [vectors]: q, of which −q tells the same
    double *q, *members;                   ///< shape [bins]: mean |q|, number of vectors
    size_t planned, samples, blocks, each; ///< `each`: samples in a block
    double *sums;      ///< shape [blocks, curves, bins]: Σ of S over samples and vectors
    double *phase[3];  ///< shape [most + 1, 2, count]: cos, sin of n 2π x/L, by id
    double *amplitude; ///< shape [vectors, types, 2]: ρ of each type
    const struct particles *particles; ///< of the sample that is taken
};

// Wave vectors ------------------------------------------------------------------------------------

/// One of q and −q.
static bool is_kept(int x, int y, int z) {
    return z > 0 || (z == 0 && (y > 0 || (y == 0 && x > 0)));
}

/// Go through all wave vectors up to q_maximum and count them; list them with their bins if there
/// is room for them already.
static size_t list_waves(struct structure_factor *s, const struct settings *settings) {
    size_t found = 0;
    for (int z = 0; z <= s->most[2]; z++)
        for (int y = -s->most[1]; y <= s->most[1]; y++)
            for (int x = -s->most[0]; x <= s->most[0]; x++) {
                const double q =
                    sqrt(pow(x * s->unit[0], 2) + pow(y * s->unit[1], 2) + pow(z * s->unit[2], 2));
                if (q > settings->q_maximum || !is_kept(x, y, z))
                    continue;
                if (s->wave) {
                    size_t bin = (size_t)(q / settings->q_maximum * (double)settings->bins);
                    bin = bin < s->bins ? bin : s->bins - 1;
                    s->wave[found] = (struct wave){{x, y, z}, bin};
                    s->q[bin] += q;
                    s->members[bin] += 1;
                }
                found++;
            }
    return found;
}

/// Leave out the bins without a vector, and make means of the sums of |q|.
static enum status close_ranks(struct structure_factor *s) {
    enum status status = STATUS_OK;
    size_t *place = NULL, kept = 0;
    NEW_ARRAY(place, s->bins);
    for (size_t bin = 0; bin < s->bins; bin++) {
        place[bin] = kept;
        if (s->members[bin] == 0)
            continue;
        s->q[kept] = s->q[bin] / s->members[bin];
        s->members[kept++] = s->members[bin];
    }
    for (size_t k = 0; k < s->vectors; k++)
        s->wave[k].bin = place[s->wave[k].bin];
    s->bins = kept;
done:
    mf_memory_free(place);
    return status;
}

static enum status find_waves(struct structure_factor *s, const struct settings *settings,
                              const struct box *box) {
    enum status status = STATUS_OK;
    double cube = 1;
    for (int d = 0; d < box->dimensions; d++) {
        s->unit[d] = 2 * pi / box->length[d];
        cube *= 2 * settings->q_maximum / s->unit[d] + 1;
    }
    if (cube > 2.0 * MOST_VECTORS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "structure_factor: q_maximum %g has about %.2g wave vectors of the "
                              "box; at most %d are measured",
                              settings->q_maximum, cube / 2, MOST_VECTORS);
    for (int d = 0; d < box->dimensions; d++)
        s->most[d] = (int)(settings->q_maximum / s->unit[d]);
    s->bins = (size_t)settings->bins;
    s->vectors = list_waves(s, settings);
    if (s->vectors == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "structure_factor: q_maximum %g is below that of the longest wave in "
                              "the box",
                              settings->q_maximum);
    NEW_ARRAY(s->wave, s->vectors);
    NEW_ARRAY(s->q, s->bins);
    NEW_ARRAY(s->members, s->bins);
    list_waves(s, settings);
    CHECK(close_ranks(s));
done:
    return status;
}

static enum status begin(void *state, const void *settings, const struct simulation *simulation,
                         const struct measure_plan *plan) {
    enum status status = STATUS_OK;
    struct structure_factor *s = state;
    const struct composition *composition = &simulation->setup.composition;
    const bool mixed = composition_is_mixed(composition);
    s->count = simulation->particles.count;
    s->composition = mixed ? *composition : mf_composition_of_one((int64_t)s->count);
    s->types = (size_t)s->composition.types;
    s->curves = mixed ? 1 + (size_t)mf_composition_pairs(composition) : 1;
    s->planned = (size_t)plan->samples;
    s->each = (s->planned + MOST_BLOCKS - 1) / MOST_BLOCKS;
    s->blocks = s->planned / s->each;
    CHECK(find_waves(s, settings, &simulation->setup.box));
    NEW_ARRAY(s->sums, s->blocks * s->curves * s->bins);
    NEW_ARRAY(s->amplitude, s->vectors * s->types * 2);
    for (int d = 0; d < 3; d++)
        NEW_ARRAY(s->phase[d], ((size_t)s->most[d] + 1) * 2 * s->count);
done:
    return status;
}

static void clear(void *state) {
    struct structure_factor *s = state;
    mf_memory_free(s->wave);
    mf_memory_free(s->q);
    mf_memory_free(s->members);
    mf_memory_free(s->sums);
    mf_memory_free(s->amplitude);
    for (int d = 0; d < 3; d++)
        mf_memory_free(s->phase[d]);
    *s = (struct structure_factor){0};
}

// Sampling ----------------------------------------------------------------------------------------

/// Phases of the particles begin … end − 1 along all axes, by Euler's formula and recurrence.
static void find_phases(void *context, size_t begin, size_t end) {
    struct structure_factor *s = context;
    const size_t stride = 2 * s->count;
    for (int d = 0; d < 3; d++)
        for (size_t k = begin; k < end; k++) {
            const double angle = s->unit[d] > 0 ? s->unit[d] * s->particles->position[d][k] : 0;
            const double c = cos(angle), i = sin(angle);
            double *phase = s->phase[d] + s->particles->id[k];
            phase[0] = 1;
            phase[s->count] = 0;
            for (int n = 1; n <= s->most[d]; n++, phase += stride) {
                phase[stride] = phase[0] * c - phase[s->count] * i;
                phase[stride + s->count] = phase[0] * i + phase[s->count] * c;
            }
        }
}

/// ρ of the ids begin … end − 1 at one wave vector.
static void add_up(const struct structure_factor *s, const struct wave *wave, size_t begin,
                   size_t end, double rho[2]) {
    const double *c[3], *i[3], sign[3] = {wave->n[0] < 0 ? -1 : 1, wave->n[1] < 0 ? -1 : 1, 1};
    double real = 0, imaginary = 0;
    for (int d = 0; d < 3; d++) {
        c[d] = s->phase[d] + (size_t)abs(wave->n[d]) * 2 * s->count;
        i[d] = c[d] + s->count;
    }
#pragma omp simd reduction(+ : real, imaginary)
    for (size_t k = begin; k < end; k++) {
        const double ix = sign[0] * i[0][k], iy = sign[1] * i[1][k];
        const double cxy = c[0][k] * c[1][k] - ix * iy, ixy = c[0][k] * iy + ix * c[1][k];
        real += cxy * c[2][k] - ixy * i[2][k];
        imaginary += cxy * i[2][k] + ixy * c[2][k];
    }
    rho[0] = real;
    rho[1] = imaginary;
}

static void find_amplitudes(void *context, size_t begin, size_t end) {
    struct structure_factor *s = context;
    for (size_t k = begin; k < end; k++) {
        size_t first = 0;
        for (size_t type = 0; type < s->types; type++) {
            const size_t next = first + (size_t)s->composition.count[type];
            add_up(s, &s->wave[k], first, next, s->amplitude + 2 * (k * s->types + type));
            first = next;
        }
    }
}

/// Add S of one wave vector, and of its pair types.
static void add_wave(const struct structure_factor *s, size_t k, double *sums) {
    const double *rho = s->amplitude + 2 * k * s->types;
    const size_t bin = s->wave[k].bin;
    double all[2] = {0};
    for (size_t type = 0; type < s->types; type++)
        for (int part = 0; part < 2; part++)
            all[part] += rho[2 * type + (size_t)part];
    sums[bin] += (all[0] * all[0] + all[1] * all[1]) / (double)s->count;
    for (size_t curve = 1; curve < s->curves; curve++) {
        int type[2];
        mf_composition_pair_types(&s->composition, (int)curve - 1, type);
        const double *a = rho + 2 * type[0], *b = rho + 2 * type[1];
        const double beads =
            (double)s->composition.count[type[0]] * (double)s->composition.count[type[1]];
        sums[curve * s->bins + bin] += (a[0] * b[0] + a[1] * b[1]) / sqrt(beads);
    }
}

static enum status sample(void *state, struct simulation *simulation) {
    struct structure_factor *s = state;
    const int threads = simulation->setup.threads;
    const size_t block = s->samples++ / s->each;
    if (block >= s->blocks)
        return STATUS_OK;
    s->particles = &simulation->particles;
    mf_parallel_for(s->count, threads, find_phases, s);
    mf_parallel_for(s->vectors, threads, find_amplitudes, s);
    for (size_t k = 0; k < s->vectors; k++)
        add_wave(s, k, s->sums + block * s->curves * s->bins);
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct structure_factor *s = state;
    spans[0] = (struct memory_span){&s->samples, sizeof s->samples};
    spans[1] = (struct memory_span){s->sums, s->blocks * s->curves * s->bins * sizeof *s->sums};
    return 2;
}

// Results -----------------------------------------------------------------------------------------

static size_t complete_blocks(const struct structure_factor *s) {
    const size_t blocks = s->samples / s->each;
    return blocks < s->blocks ? blocks : s->blocks;
}

/// One curve with its standard errors; NaN before the first block is complete.
/// @param[out] value, error  shape [bins]
static void find_curve(const struct structure_factor *s, size_t curve, double *value,
                       double *error) {
    const size_t blocks = complete_blocks(s);
    for (size_t bin = 0; bin < s->bins; bin++) {
        double means[MOST_BLOCKS], sum = 0;
        for (size_t b = 0; b < blocks; b++) {
            means[b] = s->sums[(b * s->curves + curve) * s->bins + bin] /
                       (s->members[bin] * (double)s->each);
            sum += means[b];
        }
        value[bin] = blocks > 0 ? sum / (double)blocks : NAN;
        error[bin] = mf_statistics_correlated_error(means, blocks, 1);
    }
}

/// structure_factor.tsv: q, S with its error, in a mixture those of each pair type, and how many
/// wave vectors there are, of q and −q one.
static enum status write(const void *state, const struct observable_results *results) {
    enum status status = STATUS_OK;
    const struct structure_factor *s = state;
    struct data_column columns[3 + 2 * (1 + COMPOSITION_MOST_PAIRS)] = {
        {"q[1/lambda]", s->q, NULL}};
    char names[2 * (1 + COMPOSITION_MOST_PAIRS)][COMPOSITION_PAIR_NAME_SIZE + 16];
    char path[OUTPUT_PATH_SIZE];
    double *values = NULL, *nanometres = NULL;
    size_t n = 1;
    NEW_ARRAY(values, 2 * s->curves * s->bins);
    for (size_t curve = 0; curve < s->curves; curve++) {
        char pair[COMPOSITION_PAIR_NAME_SIZE] = "", brackets[COMPOSITION_PAIR_NAME_SIZE + 2] = "";
        double *value = values + 2 * curve * s->bins, *error = value + s->bins;
        find_curve(s, curve, value, error);
        mf_statistics_forget_errors(error, s->bins);
        if (curve > 0) {
            mf_composition_pair_name(&s->composition, (int)curve - 1, pair);
            snprintf(brackets, sizeof brackets, "(%s)", pair);
        }
        snprintf(names[2 * curve], sizeof *names, "S%s[1]", brackets);
        snprintf(names[2 * curve + 1], sizeof *names, "S_error%s[1]", brackets);
        columns[n++] = (struct data_column){names[2 * curve], value, "%.8g"};
        columns[n++] = (struct data_column){names[2 * curve + 1], error, "%.3g"};
    }
    columns[n++] = (struct data_column){"vectors[1]", s->members, "%.0f"};
    nanometres = mf_units_column(s->q, s->bins,
                                 mf_units_beside(results->units) ? 1 / results->units->length : 0);
    CHECK(nanometres ? STATUS_OK : STATUS_NO_MEMORY);
    if (mf_units_beside(results->units))
        columns[n++] = (struct data_column){"q[1/nm]", nanometres, NULL};
    mf_observable_file(results, "structure_factor.tsv", path);
    CHECK(mf_data_table_write_in(path, results->units, NULL, columns, n, s->bins));
done:
    mf_memory_free(values);
    mf_memory_free(nanometres);
    return status;
}

/// S at a wave number, on the line between the two nearest that were measured; NaN beyond them.
static void read_at(const struct structure_factor *s, const double *curve, const double *error,
                    double q, double *value, double *value_error) {
    const double rounding = 1e-4 * q; // of a table
    size_t k = 0;
    *value = *value_error = NAN;
    if (!(q >= s->q[0] - rounding) || q > s->q[s->bins - 1] + rounding)
        return;
    while (k + 2 < s->bins && s->q[k + 1] <= q)
        k++;
    const size_t next = k + 1 < s->bins ? k + 1 : k;
    const double width = next > k ? s->q[next] - s->q[k] : 1;
    const double part = fmin(fmax((q - s->q[k]) / width, 0), 1);
    *value = (1 - part) * curve[k] + part * curve[next];
    *value_error = hypot((1 - part) * error[k], part * error[next]);
}

static enum status result(const void *const *states, size_t count,
                          const struct observable_values *values) {
    enum status status = STATUS_OK;
    const size_t bins = ((const struct structure_factor *)states[0])->bins;
    double *own = NULL, *read = NULL;
    struct pooled_curve *replicas = NULL;
    NEW_ARRAY(own, 2 * bins);
    NEW_ARRAY(read, 2 * count * values->count);
    NEW_ARRAY(replicas, count);
    for (size_t k = 0; k < count; k++) {
        const struct structure_factor *s = states[k];
        double *value = read + 2 * k * values->count, *error = value + values->count;
        find_curve(s, 0, own, own + bins);
        for (size_t n = 0; n < values->count; n++)
            read_at(s, own, own + bins, values->x[n], &value[n], &error[n]);
        replicas[k] = (struct pooled_curve){value, error, (double)complete_blocks(s)};
    }
    mf_pooled_join(values, replicas, count);
done:
    mf_memory_free(own);
    mf_memory_free(read);
    mf_memory_free(replicas);
    return status;
}

// Record ------------------------------------------------------------------------------------------

/// Nanoseconds of a particle and wave vector.
static const double wave_cost = 1.1;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const struct settings *s = settings;
    const double ball = mf_box_shell_volume(&setup->box, 0, s->q_maximum);
    const double waves = ball * mf_box_volume(&setup->box) / pow(2 * pi, setup->box.dimensions) / 2;
    mf_stages_add(stages, "structure factor", true, wave_cost * waves / every,
                  "about %.0f wave vectors, one step in %.0f", waves, every);
}

static const struct observable_target targets[] = {{.name = "structure_factor",
                                                    .summary = "S(q), of all beads",
                                                    .form = OBSERVABLE_CURVE,
                                                    .argument = "q[1/lambda]",
                                                    .unit = "1",
                                                    .has_settings = true},
                                                   {.name = NULL}};
static const char *const files[] = {"structure_factor.tsv", NULL};

const struct observable mf_structure_factor = {
    .name = "structure_factor",
    .summary = "S(q) at the wave vectors of the box",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct structure_factor),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "structure factor",
    .files = files,
    .figure = OBSERVABLE_FIGURE_OF_CURVE,
    .targets = targets,
    .result = result,
};
