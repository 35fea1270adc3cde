// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/density_waves.h"

#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/// Beads whose phases are in memory at a time, so that they stay in a cache; no power of two, whose
/// rows would get into each other's way there.
enum { STRETCH = 1000 };

enum status mf_density_waves_init(struct density_waves *waves,
                                  const struct density_waves_plan *plan) {
    enum status status = STATUS_OK;
    const bool mixed = composition_is_mixed(&plan->composition);
    *waves = (struct density_waves){
        .plan = *plan,
        .count = (size_t)mf_composition_particles(&plan->composition),
        .curves = mixed ? 1 + (size_t)mf_composition_pairs(&plan->composition) : 1};
    NEW_ARRAY(waves->q, plan->bins);
    NEW_ARRAY(waves->members, plan->bins);
done:
    if (status != STATUS_OK)
        mf_density_waves_clear(waves);
    return status;
}

void mf_density_waves_clear(struct density_waves *waves) {
    mf_memory_free(waves->wave);
    mf_memory_free(waves->q);
    mf_memory_free(waves->members);
    mf_memory_free(waves->amplitude);
    for (int i = 0; i < 3; i++)
        mf_memory_free(waves->phase[i]);
    *waves = (struct density_waves){0};
}

// Which waves -------------------------------------------------------------------------------------

double mf_density_waves_expected(double q_maximum, const double length[3]) {
    double all = 1;
    for (int i = 0; i < 3; i++)
        all *= q_maximum * length[i] / pi + 1;
    return all / 2;
}

/// One of q and −q.
static bool is_kept(int a, int b, int c) {
    return c > 0 || (c == 0 && (b > 0 || (b == 0 && a > 0)));
}

static double find_length(const struct density_waves *waves, const int n[3]) {
    double square = 0;
    for (int d = 0; d < 3; d++) {
        double q = 0;
        for (int i = 0; i < 3; i++)
            q += n[i] * waves->lattice[i][d];
        square += q * q;
    }
    return sqrt(square);
}

/// Whether the next wave of a bin is taken, if `all` are counted and `taken` of `max` are: evenly.
static bool is_next(size_t all, size_t taken, size_t members, size_t max) {
    return max == 0 || members <= max || all * max >= taken * members;
}

/// Go through the waves up to q_maximum, and either count those of each bin, or list what is taken
/// of them, with `members` in each.
static void go_through(struct density_waves *waves, size_t *seen, const size_t *members) {
    const struct density_waves_plan *const plan = &waves->plan;
    for (int c = 0; c <= waves->largest[2]; c++)
        for (int b = -waves->largest[1]; b <= waves->largest[1]; b++)
            for (int a = -waves->largest[0]; a <= waves->largest[0]; a++) {
                const int n[3] = {a, b, c};
                const double q = is_kept(a, b, c) ? find_length(waves, n) : INFINITY;
                if (q > plan->q_maximum)
                    continue;
                size_t bin = (size_t)(q / plan->q_maximum * (double)plan->bins);
                bin = bin < plan->bins ? bin : plan->bins - 1;
                const size_t taken = (size_t)waves->members[bin];
                if (members && is_next(seen[bin], taken, members[bin], plan->max)) {
                    waves->wave[waves->vectors++] = (struct density_wave){{a, b, c}, bin};
                    waves->q[bin] += q;
                    waves->members[bin] += 1;
                }
                seen[bin]++;
            }
}

static enum status reserve_for_waves(struct density_waves *waves, size_t all) {
    if (all <= waves->capacity)
        return STATUS_OK;
    mf_memory_free(waves->wave);
    mf_memory_free(waves->amplitude);
    waves->wave = NULL, waves->amplitude = NULL, waves->capacity = 0;
    TRY_ARRAY(waves->wave, all);
    TRY_ARRAY(waves->amplitude, all * (size_t)waves->plan.composition.types * 2);
    waves->capacity = all;
    return STATUS_OK;
}

static enum status reserve_for_phases(struct density_waves *waves) {
    for (int i = 0; i < 3; i++) {
        const size_t along = (size_t)waves->largest[i] + 1;
        if (along <= waves->phase_capacity[i])
            continue;
        mf_memory_free(waves->phase[i]);
        waves->phase[i] = NULL, waves->phase_capacity[i] = 0;
        TRY_ARRAY(waves->phase[i], along * 2 * STRETCH);
        waves->phase_capacity[i] = along;
    }
    return STATUS_OK;
}

static enum status fail_of_many(const struct density_waves *waves, double all) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "q_maximum %g" STATUS_WAVE_NUMBER
                          " has about %.2g wave vectors of the box; at most %d are "
                          "measured",
                          waves->plan.q_maximum, all, DENSITY_WAVES_MAX);
}

/// Room for all waves that are to be taken. @param[in] members  shape [bins]: those that there are
static enum status reserve(struct density_waves *waves, const size_t *members) {
    const size_t max = waves->plan.max;
    size_t all = 0;
    for (size_t bin = 0; bin < waves->plan.bins; bin++)
        all += max > 0 && members[bin] > max ? max : members[bin];
    if (all == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "q_maximum %g" STATUS_WAVE_NUMBER
                              " is below that of the longest wave in the box",
                              waves->plan.q_maximum);
    if (all > DENSITY_WAVES_MAX)
        return fail_of_many(waves, (double)all);
    TRY(reserve_for_waves(waves, all));
    return reserve_for_phases(waves);
}

/// The phases of a bead along an edge are in memory, however few waves are taken.
static enum status check_edges(const struct density_waves *waves, const double length[3]) {
    for (int i = 0; i < 3; i++) {
        const double along = waves->plan.q_maximum * length[i] / (2 * pi);
        if (along > DENSITY_WAVES_LONGEST)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "q_maximum %g" STATUS_WAVE_NUMBER
                                  " has %.3g wave lengths along edge %d of the box; at "
                                  "most %d are measured",
                                  waves->plan.q_maximum, along, i + 1, DENSITY_WAVES_LONGEST);
    }
    return STATUS_OK;
}

/// The box's own n, and nothing of another box.
static void begin_list(struct density_waves *waves, const double lattice[3][3],
                       const double length[3]) {
    static const double rounding = 1 + 1e-9;
    memcpy(waves->lattice, lattice, sizeof waves->lattice);
    for (int i = 0; i < 3; i++)
        waves->largest[i] = (int)(waves->plan.q_maximum * length[i] / (2 * pi) * rounding);
    memset(waves->q, 0, waves->plan.bins * sizeof *waves->q);
    memset(waves->members, 0, waves->plan.bins * sizeof *waves->members);
    waves->vectors = 0;
}

/// b_i, and lengths of the box's own vectors; both 0 where there is no wave.
static void find_lattice(const struct box_vectors *box, double lattice[3][3], double length[3]) {
    for (int i = 0; i < 3; i++) {
        const double *const edge = box->edge[i];
        double square = 0;
        for (int d = 0; d < 3; d++) {
            lattice[i][d] = 2 * pi * box->inverse[i][d];
            square += lattice[i][d] * lattice[i][d];
        }
        length[i] = square > 0 ? hypot(edge[0], hypot(edge[1], edge[2])) : 0;
    }
}

enum status mf_density_waves_list(struct density_waves *waves, const struct box_vectors *box) {
    static const double max_tested = 1e3 * DENSITY_WAVES_MAX;
    double lattice[3][3], length[3];
    find_lattice(box, lattice, length);
    const double all = mf_density_waves_expected(waves->plan.q_maximum, length);
    OWNED size_t *seen = NULL, *members = NULL;
    if (waves->vectors > 0 && memcmp(waves->lattice, lattice, sizeof waves->lattice) == 0)
        return STATUS_OK;
    if (all > max_tested)
        return fail_of_many(waves, all);
    TRY(check_edges(waves, length));
    TRY_ARRAY(seen, waves->plan.bins);
    TRY_ARRAY(members, waves->plan.bins);
    begin_list(waves, lattice, length);
    go_through(waves, members, NULL);
    TRY(reserve(waves, members));
    go_through(waves, seen, members);
    return STATUS_OK;
}

// Their amplitudes --------------------------------------------------------------------------------

/// Beads first … first + count − 1, whose phases are in memory.
struct stretch {
    struct density_waves *waves;
    const struct density_places *places;
    size_t first, count;
};

/// Phases of the beads begin … end − 1 of the stretch, by Euler's formula and recurrence.
static void find_phases(void *context, size_t begin, size_t end) {
    const struct stretch *const stretch = context;
    struct density_waves *const waves = stretch->waves;
    for (size_t k = begin; k < end; k++) {
        for (int i = 0; i < 3; i++) {
            const double unit = stretch->places->unit[i];
            const double angle =
                unit > 0 ? unit * stretch->places->place[i][stretch->first + k] : 0;
            const double c = cos(angle), s = sin(angle);
            double *phase = waves->phase[i] + k;
            phase[0] = 1;
            phase[STRETCH] = 0;
            for (int n = 1; n <= waves->largest[i]; n++, phase += 2 * STRETCH) {
                phase[2 * STRETCH] = phase[0] * c - phase[STRETCH] * s;
                phase[3 * STRETCH] = phase[0] * s + phase[STRETCH] * c;
            }
        }
    }
}

/// Add ρ of the beads begin … end − 1 of the stretch, of one wave.
static void add_up(const struct density_waves *waves, const struct density_wave *wave, size_t begin,
                   size_t end, double rho[2]) {
    const double *c[3], *s[3], sign[2] = {wave->n[0] < 0 ? -1 : 1, wave->n[1] < 0 ? -1 : 1};
    double real = 0, imaginary = 0;
    for (int i = 0; i < 3; i++) {
        c[i] = waves->phase[i] + (size_t)abs(wave->n[i]) * 2 * STRETCH;
        s[i] = c[i] + STRETCH;
    }
#pragma omp simd reduction(+ : real, imaginary)
    for (size_t k = begin; k < end; k++) {
        const double sx = sign[0] * s[0][k], sy = sign[1] * s[1][k];
        const double cxy = c[0][k] * c[1][k] - sx * sy, sxy = c[0][k] * sy + sx * c[1][k];
        real += cxy * c[2][k] - sxy * s[2][k];
        imaginary += cxy * s[2][k] + sxy * c[2][k];
    }
    rho[0] += real;
    rho[1] += imaginary;
}

/// Add the stretch to ρ of the waves begin … end − 1, each type to its own.
static void add_stretch(void *context, size_t begin, size_t end) {
    const struct stretch *const stretch = context;
    struct density_waves *const waves = stretch->waves;
    const struct composition *const composition = &waves->plan.composition;
    const size_t types = (size_t)composition->types, last = stretch->first + stretch->count;
    size_t first = 0;
    for (size_t type = 0; type < types; type++) {
        const size_t next = first + (size_t)composition->count[type];
        const size_t from = first > stretch->first ? first : stretch->first;
        const size_t to = next < last ? next : last;
        for (size_t k = begin; from < to && k < end; k++)
            add_up(waves, &waves->wave[k], from - stretch->first, to - stretch->first,
                   waves->amplitude + 2 * (k * types + type));
        first = next;
    }
}

void mf_density_waves_find(struct density_waves *waves, const struct density_places *places,
                           int threads) {
    struct stretch stretch = {.waves = waves, .places = places};
    memset(waves->amplitude, 0,
           waves->vectors * (size_t)waves->plan.composition.types * 2 * sizeof *waves->amplitude);
    while (stretch.first < waves->count) {
        const size_t left = waves->count - stretch.first;
        stretch.count = left < STRETCH ? left : STRETCH;
        mf_parallel_for(stretch.count, threads, find_phases, &stretch);
        mf_parallel_for(waves->vectors, threads, add_stretch, &stretch);
        stretch.first += stretch.count;
    }
}

/// Add S of one wave, and of its pair types.
static void add_wave(const struct density_waves *waves, size_t k, double *sums) {
    const struct composition *const composition = &waves->plan.composition;
    const size_t types = (size_t)composition->types, bin = waves->wave[k].bin;
    const double *const rho = waves->amplitude + 2 * k * types;
    double all[2] = {0};
    for (size_t type = 0; type < types; type++)
        for (size_t part = 0; part < 2; part++)
            all[part] += rho[2 * type + part];
    sums[bin] += (all[0] * all[0] + all[1] * all[1]) / (double)waves->count;
    for (size_t curve = 1; curve < waves->curves; curve++) {
        int type[2];
        mf_composition_pair_types(composition, (int)curve - 1, type);
        const double *const a = rho + 2 * type[0], *const b = rho + 2 * type[1];
        const double beads =
            (double)composition->count[type[0]] * (double)composition->count[type[1]];
        sums[curve * waves->plan.bins + bin] += (a[0] * b[0] + a[1] * b[1]) / sqrt(beads);
    }
}

void mf_density_waves_add(const struct density_waves *waves, double *sums) {
    for (size_t k = 0; k < waves->vectors; k++)
        add_wave(waves, k, sums);
}
