// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is measured of frames whose answer is known from elsewhere.
#include "base/rng.h"
#include "measure/measured.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { BEADS = 60 };

/// Of sums of some thousand numbers, and of places in units of 2⁻³² of a box.
static const double rounding = 1e-6;

static const double tilted[3][3] = {{3, 0, 0}, {1, 2.8, 0}, {-1, 1.4, 2.5}};

/// Frames that a test makes, of beads that are atoms.
struct film {
    struct trajectory_frame *frame;
    size_t frames;
    struct mapping mapping;
    struct mapping_bead bead[BEADS];
    size_t atom[BEADS];
    double weight[BEADS];
    char name[2][STRUCTURE_NAME];
};

static struct film *make_film(size_t frames, size_t types) {
    struct film *film = calloc(1, sizeof *film);
    film->frames = frames;
    film->frame = calloc(frames, sizeof *film->frame);
    film->mapping = (struct mapping){.atoms = BEADS,
                                     .beads = BEADS,
                                     .types = types,
                                     .type_name = film->name,
                                     .bead = film->bead,
                                     .atom = film->atom,
                                     .weight = film->weight};
    for (size_t k = 0; k < BEADS; k++) {
        film->bead[k] = (struct mapping_bead){
            .first = k, .count = 1, .type = types == 2 && k >= BEADS / 3, .molecule = k, .mass = 2};
        film->atom[k] = k;
        film->weight[k] = 1;
    }
    snprintf(film->name[0], STRUCTURE_NAME, "A");
    snprintf(film->name[1], STRUCTURE_NAME, "B");
    for (size_t t = 0; t < frames; t++) {
        struct trajectory_frame *frame = &film->frame[t];
        frame->file = "film";
        frame->number = t;
        frame->time = 0.5 * (double)t;
        assert_ok(mf_frame_reserve(frame, BEADS, true));
        mf_frame_set_box(frame, tilted);
    }
    return film;
}

static void free_film(struct film *film) {
    for (size_t t = 0; t < film->frames; t++)
        mf_frame_clear(&film->frame[t]);
    free(film->frame);
    free(film);
}

static void scale_box(struct trajectory_frame *frame, double a, double b, double c) {
    double box[3][3];
    const double factor[3] = {a, b, c};
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++)
            box[i][d] = factor[i] * tilted[i][d];
    mf_frame_set_box(frame, box);
}

static void place(struct trajectory_frame *frame, size_t k, const double fraction[3]) {
    for (int d = 0; d < 3; d++) {
        frame->position[k][d] = 0;
        for (int i = 0; i < 3; i++)
            frame->position[k][d] += fraction[i] * frame->box[i][d];
    }
}

/// Measure a film, `batch` frames at a time.
static void measure(const struct film *film, const struct measured_plan *plan, size_t batch,
                    struct measured *measured) {
    assert_ok(mf_measured_begin(measured, plan, &film->mapping, film->frame));
    for (size_t t = 0; t < film->frames; t += batch) {
        const size_t left = film->frames - t;
        assert_ok(mf_measured_add(measured, film->frame + t, left < batch ? left : batch));
    }
    mf_measured_motion_end(&measured->motion);
}

static struct measured_plan make_plan(double range, int64_t bins, double window) {
    return (struct measured_plan){
        .range = range, .bins = bins, .motion = {.window = window, .threads = 1}, .threads = 1};
}

static const struct structure_factor *factor_of(const struct measured *measured) {
    const struct structure_factor_state *const state =
        mf_measured_state(measured, &mf_structure_factor);
    return &state->factor;
}

/// Independent beads have S = 1, beads of two types S_ab = 0, at every q. 400 numbers beyond 5 of
/// their errors, of 50 blocks, come once in some hundred seeds.
static void assert_waves_of_a_gas(const struct measured *measured) {
    const struct structure_factor *const factor = factor_of(measured);
    struct structure_factor_curves curves;
    assert_ok(mf_structure_factor_find(factor, &curves));
    assert_int_equal(factor->curves, 4);
    assert_true(curves.bins > 80);
    for (size_t curve = 0; curve < 4; curve++)
        for (size_t k = 0; k < curves.bins; k++) {
            const size_t at = curve * factor->bins + k;
            assert_close(curves.value[at], curve == 2 ? 0 : 1, 5 * curves.error[at]);
            assert_true(curves.error[at] < 0.3);
        }
    mf_structure_factor_curves_clear(&curves);
}

/// An ideal gas has g = 1, whatever its box does: counts are weighted by the volume. Without
/// that g would be ⟨V⟩⟨1/V⟩ = 1.03 here. Beads of no type know of each other. A bin's deviation is
/// judged by its own error, of 25 blocks: 60 numbers beyond 4.5 standard errors come once in some
/// thousand seeds.
static void test_measured_g_is_one_when_an_ideal_gas_is_in_a_box_that_changes(void **state) {
    (void)state;
    enum { FRAMES = 800, BINS = 20 };
    struct film *film = make_film(FRAMES, 2);
    struct rng_sequence random = mf_rng_sequence_begin(5, RNG_PLACEMENT, 0, 0);
    struct measured measured;
    double g[3 * BINS], error[3 * BINS], mean = 0;
    for (size_t t = 0; t < FRAMES; t++) {
        const double swell = 1 + 0.25 * sin((double)t);
        scale_box(&film->frame[t], swell, 1 / swell, swell);
        for (size_t k = 0; k < BEADS; k++) {
            double fraction[3];
            for (int i = 0; i < 3; i++)
                fraction[i] = mf_rng_sequence_uniform(&random);
            place(&film->frame[t], k, fraction);
        }
    }
    struct measured_plan plan = make_plan(0.8, BINS, 1);
    plan.motion.escape = 0.5;
    plan.waves.q_maximum = 12;
    measure(film, &plan, 7, &measured);
    assert_waves_of_a_gas(&measured);
    assert_ok(mf_rdf_result(mf_measured_rdf(&measured), 1, g, error));
    for (int n = 0; n < 3 * BINS; n++) {
        if (n % BINS > 2) // of few pairs an error is not known
            assert_close(g[n], 1, 4.5 * error[n]);
        mean += n % BINS > BINS / 2 ? g[n] / (3 * (BINS / 2 - 1)) : 0;
    }
    assert_close(mean, 1, 0.01);
    mf_measured_clear(&measured);
    free_film(film);
}

/// Beads that fly on, their sum of momenta being 0: |Δr|² = v² t². The box breathes, and velocities
/// are those relative to its flow; places go round it many times.
static void test_measured_msd_is_ballistic_when_beads_fly_through_a_box(void **state) {
    (void)state;
    enum { FRAMES = 200, LAGS = 20 };
    struct film *film = make_film(FRAMES, 1);
    struct rng_sequence random = mf_rng_sequence_begin(6, RNG_PLACEMENT, 0, 0);
    struct measured measured;
    double velocity[BEADS][3], fraction[BEADS][3] = {{0}}, squares = 0;
    for (size_t k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++) {
            velocity[k][d] = k % 2 ? -velocity[k - 1][d] : mf_rng_sequence_uniform(&random) - 0.5;
            squares += velocity[k][d] * velocity[k][d] / BEADS;
        }
    for (size_t t = 0; t < FRAMES; t++) {
        struct trajectory_frame *frame = &film->frame[t], mean = *frame;
        scale_box(frame, 1 + 0.1 * sin((double)t), 1, 1 - 0.1 * cos((double)t));
        for (int n = 0; t > 0 && n < 9; n++)
            mean.box[n / 3][n % 3] = 0.5 * (frame->box[n / 3][n % 3] + frame[-1].box[n / 3][n % 3]);
        mean.has_box = true;
        double inverse[3][3];
        mf_frame_reciprocal(&mean, inverse);
        for (size_t k = 0; k < BEADS; k++) {
            for (int i = 0; t > 0 && i < 3; i++)
                for (int d = 0; d < 3; d++)
                    fraction[k][i] += inverse[i][d] * velocity[k][d] * 0.5;
            place(frame, k, fraction[k]);
            memcpy(frame->velocity[k], velocity[k], sizeof velocity[k]);
        }
    }
    const struct measured_plan plan = make_plan(0.8, 10, 0.5 * LAGS);
    measure(film, &plan, 8, &measured);
    // 90 origins, two frames apart, in blocks that were joined once: 64 would be too few.
    assert_int_equal(measured.motion.motion.each, 2);
    assert_int_equal(mf_motion_blocks(&measured.motion.motion), 45);
    double curve[4][LAGS + 1];
    mf_motion_result(&measured.motion.motion,
                     &(struct motion_curves){curve[0], curve[1], curve[2], curve[3]});
    for (int lag = 0; lag <= LAGS; lag++) {
        const double time = 0.5 * lag;
        assert_close(curve[0][lag], squares * time * time, rounding * (1 + time * time));
        assert_close(curve[2][lag], squares, rounding);
    }
    // ½ m v² = 3/2 k_B T (N − 1)/N of beads of 2 u.
    assert_close_relative(mf_measured_mean(&measured.motion.temperature, NULL),
                          2 * squares * BEADS / (3 * (BEADS - 1)) / 0.00831446262, 1e-6);
    mf_measured_clear(&measured);
    free_film(film);
}

/// Oscillators of all phases: ⟨v(t)·v(0)⟩ = ½ A² ω² cos ωt; by differences over 2 Δt it is
/// (sin ωΔt/(ωΔt))² of that. Times are in single precision, from `begin` on.
static void check_oscillators(int velocities, double begin, double interval, int lags) {
    enum { FRAMES = 120, MAX_LAGS = 15 };
    static const double amplitude = 0.3, omega = 0.9;
    struct film *film = make_film(FRAMES, 1);
    struct measured measured;
    for (size_t t = 0; t < FRAMES; t++) {
        film->frame[t].time = (double)(float)(begin + interval * (double)t);
        for (size_t k = 0; k < BEADS; k++) {
            const double phase = omega * interval * (double)t + 2 * acos(-1) * (double)k / BEADS;
            const double home[3] = {0.01 * (double)k, 0.1, 0.9};
            place(&film->frame[t], k, home);
            film->frame[t].position[k][0] += amplitude * cos(phase);
            film->frame[t].velocity[k][0] = -amplitude * omega * sin(phase);
            film->frame[t].velocity[k][1] = film->frame[t].velocity[k][2] = 0;
        }
    }
    struct measured_plan plan = make_plan(0.8, 10, interval * lags);
    plan.motion.velocities = velocities;
    measure(film, &plan, 5, &measured);
    assert_int_equal(measured.motion.motion.plan.lags, lags);
    double curve[4][MAX_LAGS + 1];
    mf_motion_result(&measured.motion.motion,
                     &(struct motion_curves){curve[0], curve[1], curve[2], curve[3]});
    const double blur = velocities == MEASURED_VELOCITIES_DIFFERENCES
                            ? pow(sin(omega * interval) / (omega * interval), 2)
                            : 1;
    for (int lag = 0; lag <= lags; lag++) {
        const double turned = cos(omega * interval * lag);
        assert_close(curve[2][lag], blur * 0.5 * pow(amplitude * omega, 2) * turned, rounding);
        assert_close(curve[0][lag], amplitude * amplitude * (1 - turned), rounding);
    }
    mf_measured_clear(&measured);
    free_film(film);
}

static void test_measured_vacf_is_a_cosine_when_beads_oscillate(void **state) {
    (void)state;
    check_oscillators(MEASURED_VELOCITIES_USUAL, 0, 0.5, 15);
    check_oscillators(MEASURED_VELOCITIES_DIFFERENCES, 0, 0.5, 15);
    // After 20 ns the last digit of a time is 0.002 ps: two frames are not enough for the interval.
    check_oscillators(MEASURED_VELOCITIES_DIFFERENCES, 20000, 0.02, 15);
    check_oscillators(MEASURED_VELOCITIES_DIFFERENCES, 20000, 0.025, 4);
}

/// Two pairs, one of which parts at 2.5 ps: of the origins from 0 to 4.5 ps, windows of 2 ps.
static struct film *make_walk(uint32_t seed) {
    enum { FRAMES = 90 };
    struct film *film = make_film(FRAMES, 2);
    struct rng_sequence random = mf_rng_sequence_begin(seed, RNG_PLACEMENT, 0, 0);
    double fraction[BEADS][3];
    for (size_t k = 0; k < BEADS; k++)
        for (int i = 0; i < 3; i++)
            fraction[k][i] = mf_rng_sequence_uniform(&random);
    for (size_t t = 0; t < FRAMES; t++) {
        const double swell = 1 + 0.03 * sin((double)t);
        scale_box(&film->frame[t], swell, swell, 1 / swell);
        for (size_t k = 0; k < BEADS; k++) {
            for (int i = 0; i < 3; i++)
                fraction[k][i] += 0.05 * (mf_rng_sequence_uniform(&random) - 0.5);
            place(&film->frame[t], k, fraction[k]);
            for (int d = 0; d < 3; d++)
                film->frame[t].velocity[k][d] = mf_rng_sequence_uniform(&random) - 0.5;
        }
    }
    return film;
}

static double find_distance(const struct trajectory_frame *frame, size_t i, size_t j) {
    double inverse[3][3], min = INFINITY;
    mf_frame_reciprocal(frame, inverse);
    for (int n = 0; n < 7 * 7 * 7; n++) {
        const int image[3] = {n % 7 - 3, n / 7 % 7 - 3, n / 49 - 3};
        double difference[3], square = 0;
        for (int d = 0; d < 3; d++)
            difference[d] = frame->position[i][d] - frame->position[j][d];
        for (int v = 0; v < 3; v++) {
            double whole = 0;
            for (int d = 0; d < 3; d++)
                whole += inverse[v][d] * (frame->position[i][d] - frame->position[j][d]);
            for (int d = 0; d < 3; d++)
                difference[d] += (image[v] - floor(whole)) * frame->box[v][d];
        }
        for (int d = 0; d < 3; d++)
            square += difference[d] * difference[d];
        min = fmin(min, square);
    }
    return sqrt(min);
}

static void test_measured_escapes_are_those_of_all_images_when_beads_walk(void **state) {
    (void)state;
    enum { LAGS = 8, EVERY = 1 };
    struct film *film = make_walk(11);
    struct measured measured;
    struct measured_plan plan = make_plan(0.8, 10, 0.5 * LAGS);
    plan.motion.escape = 0.6;
    for (size_t k = 0; k < BEADS; k++) // pairs of a molecule never part, and are not followed
        film->bead[k].molecule = k / 2;
    measure(film, &plan, 6, &measured);
    const struct etd *etd = &measured.motion.etd;
    const size_t bins = (size_t)etd->grid.bins, times = LAGS + 1;
    assert_int_equal(etd->grid.times, times);
    assert_int_equal(etd->plan.origin_every, EVERY);
    double *survival = calloc(times * bins, sizeof *survival), *begun = calloc(bins, sizeof *begun);
    double *escaped = calloc(times * bins, sizeof *escaped);
    uint64_t *pairs = calloc(bins, sizeof *pairs);
    const double low = etd->grid.r_minimum, width = (0.6 - low) / (double)bins;
    for (size_t i = 0; i < BEADS; i++)
        for (size_t j = 0; j < i; j++) {
            double r[90] = {0};
            for (size_t t = 0; t < film->frames && i / 2 != j / 2; t++)
                r[t] = find_distance(&film->frame[t], i, j);
            for (size_t t = 0; t + LAGS < film->frames && i / 2 != j / 2; t++) {
                if (r[t] < low || r[t] >= 0.6)
                    continue;
                const size_t bin = (size_t)((r[t] - low) / width);
                bool out = false;
                begun[bin]++;
                for (size_t lag = 0; lag <= LAGS; lag++) {
                    out = out || r[t + lag] >= 0.6;
                    escaped[lag * bins + bin] += out;
                }
            }
        }
    assert_ok(mf_etd_result(&etd, 1, survival, NULL, pairs));
    for (size_t bin = 0; bin < bins; bin++) {
        assert_int_equal(pairs[bin], (uint64_t)begun[bin]);
        for (size_t t = 0; begun[bin] > 0 && t < times; t++)
            assert_close(survival[t * bins + bin], 1 - escaped[t * bins + bin] / begun[bin], 1e-12);
    }
    free(survival);
    free(begun);
    free(escaped);
    free(pairs);
    mf_measured_clear(&measured);
    free_film(film);
}

static void test_measured_bits_are_the_same_when_threads_and_batches_differ(void **state) {
    (void)state;
    struct film *film = make_walk(12);
    struct measured one, other;
    struct measured_plan plan = make_plan(0.8, 40, 4);
    plan.waves.q_maximum = 12;
    measure(film, &plan, 2, &one);
    for (int threads = 2; threads <= 3; threads++) {
        plan.threads = plan.motion.threads = threads;
        measure(film, &plan, (size_t)threads * 4, &other);
        const struct rdf *a = mf_measured_rdf(&one), *b = mf_measured_rdf(&other);
        assert_memory_equal(a->blocks.sums, b->blocks.sums,
                            a->blocks.count * a->blocks.row * sizeof *a->blocks.sums);
        const struct motion *m = &one.motion.motion, *n = &other.motion.motion;
        const size_t curve = m->blocks * ((size_t)m->plan.lags + 1) * sizeof *m->squares;
        assert_memory_equal(m->squares, n->squares, curve);
        assert_memory_equal(m->products, n->products, curve);
        assert_memory_equal(one.motion.etd.counts, other.motion.etd.counts,
                            one.motion.etd.blocks * etd_cells(&one.motion.etd) * sizeof(uint64_t));
        const struct structure_factor *const factor = factor_of(&one);
        assert_memory_equal(factor->sums, factor_of(&other)->sums,
                            factor->blocks * mf_structure_factor_numbers(factor) * sizeof(double));
        mf_measured_clear(&other);
    }
    mf_measured_clear(&one);
    free_film(film);
}

static void test_measured_frames_are_refused_when_they_do_not_fit(void **state) {
    (void)state;
    struct film *film = make_walk(13);
    struct measured measured;
    struct measured_plan plan = make_plan(0.8, 40, 4);
    assert_ok(mf_measured_begin(&measured, &plan, &film->mapping, film->frame));
    film->frame[30].time += 0.01;
    assert_fails(mf_measured_add(&measured, film->frame, 60), STATUS_BAD_INPUT,
                 "film: frame 30, at 15.01 ps, comes 0.51 ps after the one before, not 0.5");
    mf_measured_clear(&measured);
    film->frame[30].time -= 0.01;
    film->frame[31].has_velocities = false;
    assert_ok(mf_measured_begin(&measured, &plan, &film->mapping, film->frame));
    assert_fails(mf_measured_add(&measured, film->frame, 60), STATUS_BAD_INPUT,
                 "film: frame 31 has no velocities");
    mf_measured_clear(&measured);
    film->frame[0].has_velocities = false;
    plan.motion.velocities = MEASURED_VELOCITIES_FILE;
    assert_ok(mf_measured_begin(&measured, &plan, &film->mapping, film->frame));
    assert_fails(mf_measured_add(&measured, film->frame, 60), STATUS_BAD_INPUT,
                 "film: frame 0 has no velocities");
    mf_measured_clear(&measured);
    plan.motion.leave_out = true;
    plan.range = 1.2;
    assert_ok(mf_measured_begin(&measured, &plan, &film->mapping, film->frame));
    assert_fails(mf_measured_add(&measured, film->frame, 60), STATUS_BAD_INPUT,
                 "film: frame 4: the range of g(r), 1.2 nm, is beyond half the shortest height");
    mf_measured_clear(&measured);
    snprintf(film->name[1], STRUCTURE_NAME, "B-2");
    assert_fails(mf_measured_begin(&measured, &plan, &film->mapping, film->frame), STATUS_BAD_INPUT,
                 "the type of beads \"B-2\"");
    free_film(film);
}

/// Counts of Poisson's law: the error of a mean of n is sqrt(mean/n), of 20 to 40 blocks known to
/// some 20 %, of the mean over 30 bins to 4 %.
static void test_measured_errors_are_those_of_counts_when_frames_are_independent(void **state) {
    (void)state;
    enum { FRAMES = 700, BINS = 30 };
    struct film *film = make_film(FRAMES, 1);
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_PLACEMENT, 0, 0);
    struct measured measured;
    double g[BINS], error[BINS], ratio = 0;
    for (size_t t = 0; t < FRAMES; t++)
        for (size_t k = 0; k < BEADS; k++) {
            double fraction[3];
            for (int i = 0; i < 3; i++)
                fraction[i] = mf_rng_sequence_uniform(&random);
            place(&film->frame[t], k, fraction);
        }
    const struct measured_plan plan = make_plan(0.9, BINS, 1);
    measure(film, &plan, 4, &measured);
    assert_ok(mf_rdf_result(mf_measured_rdf(&measured), 1, g, error));
    const struct rdf *rdf = mf_measured_rdf(&measured);
    assert_int_equal(rdf->blocks.each, 32); // 700 frames in 21 blocks and a part
    for (size_t k = BINS / 3; k < BINS; k++) {
        const double ideal = mf_rdf_ideal_pairs(&rdf->bins, k, &rdf->box, BEADS);
        ratio += error[k] * sqrt(ideal * FRAMES) / (BINS - BINS / 3);
    }
    assert_close(ratio, 1, 0.2);
    mf_measured_clear(&measured);
    free_film(film);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_measured_g_is_one_when_an_ideal_gas_is_in_a_box_that_changes),
        cmocka_unit_test(test_measured_msd_is_ballistic_when_beads_fly_through_a_box),
        cmocka_unit_test(test_measured_vacf_is_a_cosine_when_beads_oscillate),
        cmocka_unit_test(test_measured_escapes_are_those_of_all_images_when_beads_walk),
        cmocka_unit_test(test_measured_bits_are_the_same_when_threads_and_batches_differ),
        cmocka_unit_test(test_measured_frames_are_refused_when_they_do_not_fit),
        cmocka_unit_test(test_measured_errors_are_those_of_counts_when_frames_are_independent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
