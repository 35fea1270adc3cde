// SPDX-License-Identifier: GPL-3.0-or-later
//
// The noise inside the pair kernels. Particles at rest with a friction weight alone feel nothing
// else, so that each ζ_ij comes back from a force:
//   F_i · r̂ = sqrt(2 k_B T / Δt) ω(r) ζ_ij
// The scenes are pairs, and right-angled triangles in which every side acts, each far from all
// others: along one axis, one corner of a triangle feels one side only.
#include "base/memory.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/variants.h"

#include <gsl/gsl_cdf.h>
#include <stdlib.h>

/// Numbers behind every quantity that is compared with its expectation.
static const double draws = 1e7;

/// Standard errors by which a quantity may differ from its expectation: one false alarm in 16,000.
/// There are 44 such quantities, twice (both precisions see the same numbers), so that the file
/// would fail once in 360 times with a new seed.
static const double deviations = 4;

/// The same rate for the histogram's χ².
static const double false_alarm_rate = 6.3e-5;

/// Of ζ between instruction sets and precisions: a dozen roundings of 6e-8, and two of r in an ω
/// whose r |dω/dr| is up to 2.3 times as much as itself. Measured: 4e-7.
static const double zeta_tolerance = 4e-6;

/// So that the upper word of the step counts changes within every series of steps.
static const uint64_t carry = UINT64_C(1) << 32;

enum motif { DIMERS, TRIANGLES };
enum ids { IDS_IN_ORDER, IDS_SHUFFLED };

/// Sides of a triangle by the ranks of their ids. Any two share a particle.
enum side { LOW_MIDDLE, LOW_HIGH, MIDDLE_HIGH, SIDES };

/// Where a ζ is read: ζ = factor × force[axis][particle].
struct probe {
    uint32_t particle; ///< its id first, its place in the arrays once these are sorted
    int axis;
    double factor;
};

struct scene {
    struct particles particles;
    struct neighbours neighbours;
    struct table omega;
    struct pair_law law;
    size_t pairs;
    struct probe *probe;  ///< shape [pairs]
    struct probe *mirror; ///< the same ζ on the other particle; of DIMERS
};

/// What a scene is made of.
struct plan {
    enum motif motif;
    enum ids ids;
    int dimensions, sites; ///< sites along an axis, one motif each
    bool exchanged;        ///< the particles of each dimer have changed places
    bool reversed;         ///< the arrays began in the opposite order
};

/// Between sites: a triangle's particles are less than 0.6 from its corner, which leaves 1.2.
static const double site_spacing = 2.4;
static const double triangle_leg = 0.6;

static void make_omega(struct table *omega) {
    struct formula_power_omega_parameters parameters = {1.3, 1, 0, 1};
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    assert_ok(mf_table_init_omega(omega, &curve));
}

/// Ids in the order in which they are given to particles.
static uint32_t *make_ids(size_t count, enum ids ids) {
    uint32_t *id = mf_memory_zeroed(count, sizeof *id);
    assert_non_null(id);
    struct rng_sequence sequence = mf_rng_sequence_begin(17, RNG_SELECTION, 0, 0);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t other = ids == IDS_SHUFFLED ? mf_rng_sequence_below(&sequence, k + 1) : k;
        id[k] = id[other];
        id[other] = k;
    }
    return id;
}

static int compare_ids(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/// The ζ of particles a and b from the force on a along `axis`.
static struct probe make_probe(const struct scene *scene, uint32_t a, uint32_t b, int axis) {
    const struct particles *particles = &scene->particles;
    const struct pair_law *law = &scene->law;
    double square = 0, along = 0, omega;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double dx = box_nearest(particles->position[d][a] - particles->position[d][b],
                                      particles->box.length[d]);
        square += dx * dx;
        if (d == axis)
            along = dx;
    }
    mf_table_evaluate(law->omega, sqrt(square), &omega, NULL, NULL);
    assert_true(omega > 0 && fabs(along) > 0.1);
    const double amplitude = sqrt(2 * law->temperature / law->time_step) * omega;
    return (struct probe){a, axis, sqrt(square) / (amplitude * along)};
}

static void place(struct scene *scene, uint32_t id, const double site[3], int axis, double shift) {
    for (int d = 0; d < scene->particles.box.dimensions; d++)
        scene->particles.position[d][id] = site[d] + (d == axis ? shift : 0);
}

/// Dimers of lengths from 0.3 to 0.7 lie along each axis in turn, and either way.
static void add_dimer(struct scene *scene, const struct plan *plan, size_t number,
                      const double site[3], const uint32_t id[2]) {
    const int axis = (int)(number % (size_t)plan->dimensions);
    const double size = 0.3 + 0.4 * fmod(0.618 * (double)number, 1);
    const double length = number / 3 % 2 ? size : -size;
    place(scene, id[plan->exchanged ? 1 : 0], site, axis, 0);
    place(scene, id[plan->exchanged ? 0 : 1], site, axis, length);
    scene->probe[number] = make_probe(scene, id[0], id[1], axis);
    scene->mirror[number] = make_probe(scene, id[1], id[0], axis);
}

/// Each of the three ids stands at the right angle in turn, and the legs lie along each pair of
/// axes, either way.
static void add_triangle(struct scene *scene, const struct plan *plan, size_t number,
                         const double site[3], const uint32_t id[3]) {
    static const enum side side_of[3][3] = {{SIDES, LOW_MIDDLE, LOW_HIGH},
                                            {LOW_MIDDLE, SIDES, MIDDLE_HIGH},
                                            {LOW_HIGH, MIDDLE_HIGH, SIDES}};
    const int dim = plan->dimensions, x = (int)(number / 3 % (size_t)dim), y = (x + 1) % dim;
    const size_t corner = number % 3, a = (corner + 1) % 3, b = (corner + 2) % 3;
    const double leg = number / 9 % 2 ? triangle_leg : -triangle_leg;
    place(scene, id[corner], site, -1, 0);
    place(scene, id[a], site, x, leg);
    place(scene, id[b], site, y, leg);
    struct probe *probe = scene->probe + SIDES * number;
    probe[side_of[corner][a]] = make_probe(scene, id[corner], id[a], x);
    probe[side_of[corner][b]] = make_probe(scene, id[corner], id[b], y);
    probe[side_of[a][b]] = make_probe(scene, id[a], id[b], y);
}

static void add_motifs(struct scene *scene, const struct plan *plan) {
    const int n = plan->sites, each = plan->motif == DIMERS ? 2 : 3;
    uint32_t *ids = make_ids(scene->particles.count, plan->ids);
    const size_t motifs = scene->particles.count / (size_t)each;
    for (size_t number = 0; number < motifs; number++) {
        uint32_t *id = ids + number * (size_t)each;
        const size_t m = number;
        const double site[3] = {site_spacing * (double)(m % (size_t)n),
                                site_spacing * (double)(m / (size_t)n % (size_t)n),
                                site_spacing * (double)(m / (size_t)(n * n))};
        qsort(id, (size_t)each, sizeof *id, compare_ids);
        if (plan->motif == DIMERS)
            add_dimer(scene, plan, number, site, id);
        else
            add_triangle(scene, plan, number, site, id);
    }
    mf_memory_free(ids);
}

static void reverse(struct particles *particles) {
    uint32_t *order = mf_memory_zeroed(particles->count, sizeof *order);
    assert_non_null(order);
    for (size_t k = 0; k < particles->count; k++)
        order[k] = (uint32_t)(particles->count - 1 - k);
    mf_particles_permute(particles, order);
    mf_memory_free(order);
}

/// Particles do not move, so that their places in the arrays are known from the first sort on.
static void find_places(struct scene *scene) {
    const size_t count = scene->particles.count;
    uint32_t *place_of = mf_memory_zeroed(count, sizeof *place_of);
    assert_non_null(place_of);
    for (uint32_t k = 0; k < count; k++)
        place_of[scene->particles.id[k]] = k;
    for (size_t p = 0; p < scene->pairs; p++) {
        scene->probe[p].particle = place_of[scene->probe[p].particle];
        scene->mirror[p].particle = place_of[scene->mirror[p].particle];
    }
    mf_memory_free(place_of);
}

static void make_scene(struct scene *scene, const struct plan *plan) {
    const double edge = plan->sites * site_spacing;
    const struct box box = {plan->dimensions, {edge, edge, plan->dimensions == 3 ? edge : 1}};
    const size_t motifs = (size_t)lround(pow(plan->sites, plan->dimensions));
    *scene = (struct scene){.law = {.temperature = 0.8, .time_step = 0.03, .seed = 0x57EED}};
    make_omega(&scene->omega);
    scene->law.omega = &scene->omega;
    scene->pairs = motifs * (plan->motif == DIMERS ? 1 : SIDES);
    scene->probe = mf_memory_zeroed(scene->pairs, sizeof *scene->probe);
    scene->mirror = mf_memory_zeroed(scene->pairs, sizeof *scene->mirror);
    assert_non_null(scene->probe);
    assert_non_null(scene->mirror);
    assert_ok(mf_particles_init(&scene->particles, &box, motifs * (plan->motif == DIMERS ? 2 : 3)));
    assert_ok(mf_particles_keep_precise(&scene->particles));
    add_motifs(scene, plan);
    if (plan->reversed)
        reverse(&scene->particles);
    assert_ok(mf_neighbours_init(&scene->neighbours, NEIGHBOURS_HALF, &box, scene->particles.count,
                                 mf_pair_cutoff(&scene->law), 0.1));
    assert_ok(mf_neighbours_sort_and_build(&scene->neighbours, &scene->particles));
    mf_particles_update_motion(&scene->particles, 0);
    find_places(scene);
}

static void clear_scene(struct scene *scene) {
    mf_particles_clear(&scene->particles);
    mf_neighbours_clear(&scene->neighbours);
    mf_table_clear(&scene->omega);
    mf_memory_free(scene->probe);
    mf_memory_free(scene->mirror);
}

static void read_probes(const struct scene *scene, const struct probe *probe, double *zeta) {
    for (size_t p = 0; p < scene->pairs; p++)
        zeta[p] = probe[p].factor * scene->particles.force[probe[p].axis][probe[p].particle];
}

/// The ζ of all pairs at a step, as kernels see it: shape [pairs].
static void draw(struct scene *scene, uint64_t seed, uint64_t step, double *zeta) {
    scene->law.seed = seed;
    mf_pair_forces(&scene->law, &scene->particles, &scene->neighbours, step, PAIR_FORCES, NULL);
    read_probes(scene, scene->probe, zeta);
}

static double *new_numbers(size_t count) {
    double *numbers = mf_memory_zeroed(count, sizeof *numbers);
    assert_non_null(numbers);
    return numbers;
}

/// `value` is the mean of `count` independent numbers of variance `variance`.
static void check(const char *what, double value, double expected, double variance, double count) {
    const double error = sqrt(variance / count), off = (value - expected) / error;
    print_message("  %-44s %9.6f, expected %g: %+.2f errors\n", what, value, expected, off);
    if (!(fabs(off) < deviations))
        fail_msg("%s is %.7g, but should be %g(%.2g)", what, value, expected, error);
}

static double dot(const double *a, const double *b, size_t count) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < count; k++)
        sum += a[k] * b[k];
    return sum;
}

enum { HISTOGRAM = 64 };

/// Sums over single ζ.
struct moments {
    double count, sum[5], largest;
    double step_squares; ///< Σ over steps of (Σ over pairs ζ)²/pairs
    double steps, histogram[HISTOGRAM];
};

static void add_moments(struct moments *moments, const double *zeta, size_t count) {
    double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
#pragma omp simd reduction(+ : m1, m2, m3, m4)
    for (size_t k = 0; k < count; k++) {
        const double square = zeta[k] * zeta[k];
        m1 += zeta[k];
        m2 += square;
        m3 += zeta[k] * square;
        m4 += square * square;
    }
    moments->sum[1] += m1;
    moments->sum[2] += m2;
    moments->sum[3] += m3;
    moments->sum[4] += m4;
    for (size_t k = 0; k < count; k++) {
        moments->largest = fmax(moments->largest, fabs(zeta[k]));
        const double u = 0.5 + zeta[k] / sqrt(12);
        moments->histogram[(int)fmin(fmax(u * HISTOGRAM, 0), HISTOGRAM - 1)]++;
    }
    moments->count += (double)count;
    moments->step_squares += m1 * m1 / (double)count;
    moments->steps++;
}

/// Uniform of mean 0 and variance 1: E ζ⁴ = 9/5, E ζ⁶ = 27/7, E ζ⁸ = 9, |ζ| ≤ √3.
static void check_moments(const struct moments *moments) {
    const double n = moments->count;
    check("mean", moments->sum[1] / n, 0, 1, n);
    check("variance", moments->sum[2] / n, 1, 9. / 5 - 1, n);
    check("third moment", moments->sum[3] / n, 0, 27. / 7, n);
    check("fourth moment", moments->sum[4] / n, 9. / 5, 9 - 81. / 25, n);
    assert_true(moments->largest < sqrt(3) + zeta_tolerance);
    double chi2 = 0;
    for (int k = 0; k < HISTOGRAM; k++) {
        const double off = moments->histogram[k] - n / HISTOGRAM;
        chi2 += off * off / (n / HISTOGRAM);
    }
    const double p = gsl_cdf_chisq_Q(chi2, HISTOGRAM - 1);
    print_message("  %-44s %9.2f, p = %.3f\n", "chi2 of a uniform histogram of 64 bins", chi2, p);
    assert_true(p > false_alarm_rate);
    // The covariances of all pairs of pairs at once: if any number of ζ of a step are the same, the
    // variance of their sum shows it. A sum is all but normal, so that its square scatters by 2.
    check("variance of a step's sum", moments->step_squares / moments->steps, 1, 2, moments->steps);
}

/// What must not replay ζ(seed, step).
enum replay {
    NEXT_STEP,
    NEXT_SEED,
    NEXT_SEED_A_STEP_BEFORE,
    NEXT_SEED_A_STEP_LATER,
    UPPER_WORD_OF_STEP,
    UPPER_WORD_OF_SEED,
    REPLAYS
};

static const char *const replays[REPLAYS] = {
    [NEXT_STEP] = "covariance with step + 1",
    [NEXT_SEED] = "covariance with seed + 1",
    [NEXT_SEED_A_STEP_BEFORE] = "covariance with seed + 1, step - 1",
    [NEXT_SEED_A_STEP_LATER] = "covariance with seed + 1, step + 1",
    [UPPER_WORD_OF_STEP] = "covariance with step + 2^32",
    [UPPER_WORD_OF_SEED] = "covariance with seed + 2^32",
};

/// All about ζ of dimers, over steps that end beyond 2³².
static void check_dimers(struct scene *scene) {
    const uint64_t steps = (uint64_t)(draws / (double)scene->pairs) + 2, seed = 0x57EED;
    const size_t n = scene->pairs;
    double *now = new_numbers(n), *before = new_numbers(n), *other = new_numbers(n),
           *other_before = new_numbers(n), *far = new_numbers(n);
    double sum[REPLAYS] = {0}, count = 0;
    struct moments moments = {0};
    for (uint64_t k = 0; k < steps; k++) {
        const uint64_t step = carry - steps / 2 + k;
        draw(scene, seed, step, now);
        draw(scene, seed + 1, step, other);
        if (k > 0) {
            add_moments(&moments, now, n);
            sum[NEXT_STEP] += dot(now, before, n);
            sum[NEXT_SEED] += dot(now, other, n);
            sum[NEXT_SEED_A_STEP_BEFORE] += dot(now, other_before, n);
            sum[NEXT_SEED_A_STEP_LATER] += dot(before, other, n);
            draw(scene, seed, step + carry, far);
            sum[UPPER_WORD_OF_STEP] += dot(now, far, n);
            draw(scene, seed + carry, step, far);
            sum[UPPER_WORD_OF_SEED] += dot(now, far, n);
            count += (double)n;
        }
        double *spare = before;
        before = now;
        now = spare;
        spare = other_before;
        other_before = other;
        other = spare;
    }
    assert_true(count >= draws);
    check_moments(&moments);
    for (int k = 0; k < REPLAYS; k++)
        check(replays[k], sum[k] / count, 0, 1, count);
    mf_memory_free(now);
    mf_memory_free(before);
    mf_memory_free(other);
    mf_memory_free(other_before);
    mf_memory_free(far);
}

/// ζ of the sides of triangles, which share their lowest, middle or highest particle.
static void check_triangles(struct scene *scene) {
    const size_t motifs = scene->pairs / SIDES;
    const uint64_t steps = (uint64_t)(draws / (double)motifs) + 1;
    double *zeta = new_numbers(scene->pairs);
    double low = 0, middle = 0, high = 0, product = 0;
    struct moments moments = {0};
    for (uint64_t k = 0; k < steps; k++) {
        draw(scene, 0xC0FFEE, carry - steps / 2 + k, zeta);
        add_moments(&moments, zeta, scene->pairs);
        for (size_t m = 0; m < motifs; m++) {
            const double *side = zeta + SIDES * m;
            low += side[LOW_MIDDLE] * side[LOW_HIGH];
            middle += side[LOW_MIDDLE] * side[MIDDLE_HIGH];
            high += side[LOW_HIGH] * side[MIDDLE_HIGH];
            product += side[LOW_MIDDLE] * side[LOW_HIGH] * side[MIDDLE_HIGH];
        }
    }
    const double count = (double)(steps * motifs);
    assert_true(count >= draws);
    check("covariance of pairs that share the low id", low / count, 0, 1, count);
    check("covariance of pairs that share the middle id", middle / count, 0, 1, count);
    check("covariance of pairs that share the high id", high / count, 0, 1, count);
    check("mean product around a triangle", product / count, 0, 1, count);
    check_moments(&moments);
    mf_memory_free(zeta);
}

/// The first instruction set in both precisions, with ids in order and shuffled. The others draw
/// the same numbers, which another test says.
static void check_statistics(enum motif motif, void (*check_scene)(struct scene *scene)) {
    struct variant variants[VARIANTS_MOST];
    variants_find(variants);
    for (int v = 0; v < 2; v++)
        for (int ids = IDS_IN_ORDER; ids <= IDS_SHUFFLED; ids++) {
            const struct plan plan = {
                .motif = motif, .ids = (enum ids)ids, .dimensions = 3, .sites = 15};
            struct scene scene;
            make_scene(&scene, &plan);
            scene.law.precision = variants[v].precision;
            print_message("%s, ids %s:\n", variants[v].name,
                          ids == IDS_SHUFFLED ? "shuffled" : "in order");
            check_scene(&scene);
            clear_scene(&scene);
        }
}

static void test_pair_noise_is_white_when_steps_and_seeds_change(void **state) {
    (void)state;
    check_statistics(DIMERS, check_dimers);
}

static void test_pair_noise_is_independent_when_pairs_share_a_particle(void **state) {
    (void)state;
    check_statistics(TRIANGLES, check_triangles);
}

/// Scenes of the tests that compare number by number.
static struct plan small_plan(enum motif motif, int ids, int dimensions) {
    return (struct plan){.motif = motif,
                         .ids = (enum ids)ids,
                         .dimensions = dimensions,
                         .sites = dimensions == 3 ? 7 : 19};
}

/// Steps on both sides of the carry.
enum { FEW_STEPS = 20 };

static uint64_t few_step(int k) {
    return carry - FEW_STEPS / 2 + (uint64_t)k;
}

static void test_pair_noise_is_the_same_when_the_variant_changes(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MOST];
    const int variant_count = variants_find(variants);
    double largest = 0;
    size_t compared = 0;
    for (int which = 0; which < 8; which++) {
        const struct plan plan =
            small_plan(which & 1 ? TRIANGLES : DIMERS, which >> 1 & 1, which & 4 ? 3 : 2);
        struct scene scene;
        make_scene(&scene, &plan);
        double *first = new_numbers(scene.pairs), *zeta = new_numbers(scene.pairs);
        for (int k = 0; k < FEW_STEPS; k++)
            for (int v = 0; v < variant_count; v++) {
                variants_select(&variants[v]);
                scene.law.precision = variants[v].precision;
                draw(&scene, 0xABCDEF0123456789, few_step(k), v == 0 ? first : zeta);
                for (size_t p = 0; v > 0 && p < scene.pairs; p++) {
                    if (!is_close(zeta[p], first[p], zeta_tolerance))
                        fail_msg("%s: zeta = %.9g, but %.9g for %s", variants[v].name, zeta[p],
                                 first[p], variants[0].name);
                    largest = fmax(largest, fabs(zeta[p] - first[p]));
                    compared++;
                }
            }
        mf_memory_free(first);
        mf_memory_free(zeta);
        clear_scene(&scene);
    }
    variants_select(&variants[0]);
    print_message("%zu numbers of %d variants: largest difference %.1e\n", compared, variant_count,
                  largest);
}

/// The word of Philox that a pair's ζ is made of.
static int32_t word_of(const struct scene *scene, size_t pair, uint64_t step) {
    const uint32_t a = scene->particles.id[scene->probe[pair].particle],
                   b = scene->particles.id[scene->mirror[pair].particle];
    const uint64_t seed = scene->law.seed;
    return (int32_t)rng_philox_lane((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)step,
                                    a < b ? a : b, a < b ? b : a,
                                    rng_stream_word(RNG_PAIR_NOISE, (uint32_t)(step >> 32)));
}

/// Mixed and double precision draw the same 32 bits. In double precision a ζ, good to 1e-14, tells
/// all of them; in mixed precision the 17 highest or more.
static void test_pair_noise_is_made_of_the_same_word_when_the_precision_changes(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MOST];
    const int variant_count = variants_find(variants);
    const struct plan plan = small_plan(DIMERS, IDS_SHUFFLED, 3);
    struct scene scene;
    make_scene(&scene, &plan);
    double *zeta = new_numbers(scene.pairs);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        scene.law.precision = variants[v].precision;
        const double lost = variants[v].precision == PAIR_DOUBLE ? 0.01 : zeta_tolerance * 0x1p32;
        for (int k = 0; k < FEW_STEPS; k++) {
            draw(&scene, 0xABCDEF0123456789, few_step(k), zeta);
            for (size_t p = 0; p < scene.pairs; p++)
                assert_close(zeta[p] * 0x1p32 / sqrt(12), word_of(&scene, p, few_step(k)), lost);
        }
    }
    mf_memory_free(zeta);
    clear_scene(&scene);
    variants_select(&variants[0]);
}

static void test_pair_noise_is_opposite_when_read_on_the_other_particle(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MOST];
    const int variant_count = variants_find(variants);
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const struct plan plan = small_plan(DIMERS, IDS_SHUFFLED, dimensions);
        struct scene scene;
        make_scene(&scene, &plan);
        double *zeta = new_numbers(scene.pairs), *mirrored = new_numbers(scene.pairs);
        for (int v = 0; v < variant_count; v++) {
            variants_select(&variants[v]);
            scene.law.precision = variants[v].precision;
            for (int k = 0; k < FEW_STEPS; k++) {
                draw(&scene, 3, few_step(k), zeta);
                // The factors are opposite, so the same ζ is the opposite force, bit by bit.
                read_probes(&scene, scene.mirror, mirrored);
                for (size_t p = 0; p < scene.pairs; p++)
                    assert_identical(mirrored[p], zeta[p]);
            }
        }
        mf_memory_free(zeta);
        mf_memory_free(mirrored);
        clear_scene(&scene);
    }
    variants_select(&variants[0]);
}

/// Pairs of which the particle with the lower id is stored first.
static size_t count_low_first(const struct scene *scene) {
    size_t count = 0;
    for (size_t p = 0; p < scene->pairs; p++)
        count += scene->probe[p].particle < scene->mirror[p].particle;
    return count;
}

static void
test_pair_noise_is_the_same_when_particles_are_stored_the_other_way_round(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MOST];
    const int variant_count = variants_find(variants);
    for (int which = 0; which < 4; which++) {
        struct plan plan = small_plan(DIMERS, which & 1, which & 2 ? 3 : 2);
        struct scene scene[3];
        make_scene(&scene[0], &plan);
        // Another order within the cells alone, then the opposite order of every pair.
        plan.reversed = true;
        make_scene(&scene[1], &plan);
        plan.exchanged = true;
        make_scene(&scene[2], &plan);
        const size_t pairs = scene[0].pairs, low_first = count_low_first(&scene[0]);
        assert_true(count_low_first(&scene[1]) != low_first);
        assert_int_equal(count_low_first(&scene[2]), pairs - low_first);
        double *zeta[3];
        for (int s = 0; s < 3; s++)
            zeta[s] = new_numbers(pairs);
        for (int v = 0; v < variant_count; v++) {
            variants_select(&variants[v]);
            for (int k = 0; k < FEW_STEPS; k++) {
                for (int s = 0; s < 3; s++) {
                    scene[s].law.precision = variants[v].precision;
                    draw(&scene[s], 3, few_step(k), zeta[s]);
                }
                for (size_t p = 0; p < pairs; p++) {
                    assert_identical(zeta[1][p], zeta[0][p]);
                    assert_identical(zeta[2][p], zeta[0][p]);
                }
            }
        }
        for (int s = 0; s < 3; s++) {
            mf_memory_free(zeta[s]);
            clear_scene(&scene[s]);
        }
    }
    variants_select(&variants[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pair_noise_is_white_when_steps_and_seeds_change),
        cmocka_unit_test(test_pair_noise_is_independent_when_pairs_share_a_particle),
        cmocka_unit_test(test_pair_noise_is_the_same_when_the_variant_changes),
        cmocka_unit_test(test_pair_noise_is_made_of_the_same_word_when_the_precision_changes),
        cmocka_unit_test(test_pair_noise_is_opposite_when_read_on_the_other_particle),
        cmocka_unit_test(test_pair_noise_is_the_same_when_particles_are_stored_the_other_way_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
