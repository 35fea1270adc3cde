// SPDX-License-Identifier: GPL-3.0-or-later
//
// The neighbour list never misses a pair: 10,000 steps of simulations with each instruction set,
// every step against all pairs.
//
// A step's forces are computed once its positions are new, and no position changes before the next
// step (velocity Verlet ends with a kick). So the list and the positions that are seen after a step
// are those of its forces, and any pair that the list lacks now is a force that was missing.
#include "base/memory.h"
#include "base/simd.h"
#include "dynamics/simulation.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/variants.h"

/// Of a temperature at one instant: six standard deviations sqrt(2/(d N)) at least.
static const double temperature_band = 0.4;

static const double skins[] = {0, 0.1, 0.35};
enum { SKINS = sizeof skins / sizeof *skins, SCENES = 12, STEPS = 10000 / (SCENES * SKINS) + 1 };

/// Of all runs.
static size_t watched_steps, watched_pairs;

/// Looks at a simulation after every step.
struct watcher {
    size_t count, bytes;
    double *x[3];    ///< wrapped positions, shape [count] each
    uint8_t *listed; ///< a bit for each pair that stands on the list
    double length[3], limit;
    size_t pairs; ///< in range, of all steps
};

static void watcher_init(struct watcher *watcher, const struct simulation *simulation) {
    const struct box *box = &simulation->particles.box;
    const double limit = mf_pair_cutoff(&simulation->law);
    *watcher = (struct watcher){.count = simulation->particles.count, .limit = limit * limit};
    watcher->bytes = watcher->count * watcher->count / 8 + 1;
    watcher->listed = mf_memory_zeroed(watcher->bytes, 1);
    assert_non_null(watcher->listed);
    for (int d = 0; d < 3; d++) {
        watcher->length[d] = d < box->dimensions ? box->length[d] : 1;
        watcher->x[d] = mf_memory_zeroed(watcher->count, sizeof *watcher->x[d]);
        assert_non_null(watcher->x[d]);
    }
}

static void watcher_clear(struct watcher *watcher) {
    mf_memory_free(watcher->listed);
    for (int d = 0; d < 3; d++)
        mf_memory_free(watcher->x[d]);
}

/// Positions between lists are not in the box.
static void take_positions(struct watcher *watcher, const struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < watcher->count; k++) {
            const double x = particles->position[d][k], length = watcher->length[d];
            watcher->x[d][k] = x - floor(x / length) * length;
        }
}

static double min(double a, double b) {
    return a < b ? a : b;
}

/// Squared distance of the nearest images.
static double square_distance(const struct watcher *watcher, size_t i, size_t j) {
    double square = 0;
    for (int d = 0; d < 3; d++) {
        const double apart = fabs(watcher->x[d][i] - watcher->x[d][j]);
        const double dx = min(apart, watcher->length[d] - apart);
        square += dx * dx;
    }
    return square;
}

/// Pairs in range of all pairs. The loop is simple enough for vectors. These may round otherwise
/// than square_distance does, of which one pair in 10^16 could tell.
SIMD_CLONES static size_t count_all(const struct watcher *watcher) {
    const double *restrict x = watcher->x[0], *restrict y = watcher->x[1],
                           *restrict z = watcher->x[2];
    const double lx = watcher->length[0], ly = watcher->length[1], lz = watcher->length[2];
    const double limit = watcher->limit;
    int64_t count = 0;
    for (size_t i = 0; i < watcher->count; i++) {
        const double xi = x[i], yi = y[i], zi = z[i];
        for (size_t j = i + 1; j < watcher->count; j++) {
            const double ax = fabs(x[j] - xi), ay = fabs(y[j] - yi), az = fabs(z[j] - zi);
            const double dx = min(ax, lx - ax), dy = min(ay, ly - ay), dz = min(az, lz - az);
            count += dx * dx + dy * dy + dz * dz < limit;
        }
    }
    return (size_t)count;
}

/// The bit of a pair, whichever comes first.
static bool is_set(const struct watcher *watcher, size_t i, size_t j) {
    const size_t bit = i < j ? i * watcher->count + j : j * watcher->count + i;
    return watcher->listed[bit / 8] >> bit % 8 & 1;
}

static void set(struct watcher *watcher, size_t i, size_t j) {
    const size_t bit = i < j ? i * watcher->count + j : j * watcher->count + i;
    watcher->listed[bit / 8] |= (uint8_t)(1 << bit % 8);
}

static size_t list_end(const struct neighbours *neighbours, size_t i) {
    return neighbours->stop[i];
}

/// Pairs in range of those on the list.
static size_t count_listed(struct watcher *watcher, const struct neighbours *neighbours) {
    size_t count = 0;
    memset(watcher->listed, 0, watcher->bytes);
    for (size_t i = 0; i < watcher->count; i++)
        for (size_t k = neighbours->start[i]; k < list_end(neighbours, i); k++) {
            assert_in_range(neighbours->list[k], 0, watcher->count - 1);
            const size_t j = (size_t)neighbours->list[k];
            if (j == i) // what is left of a row
                continue;
            if (is_set(watcher, i, j))
                fail_msg("the pair %zu, %zu stands twice on the list", i, j);
            set(watcher, i, j);
            count += square_distance(watcher, i, j) < watcher->limit;
        }
    return count;
}

static void fail_incomplete(const struct watcher *watcher, const struct simulation *simulation,
                            size_t missed) {
    for (size_t i = 0; i < watcher->count; i++)
        for (size_t j = i + 1; j < watcher->count; j++) {
            const double square = square_distance(watcher, i, j);
            if (square < watcher->limit && !is_set(watcher, i, j))
                fail_msg("step %llu misses %zu pairs: one is at distance %.9g (cutoff %g, range of "
                         "the list %g, skin %g, %s)",
                         (unsigned long long)simulation->step, missed, sqrt(square),
                         mf_pair_cutoff(&simulation->law), simulation->neighbours.range,
                         simulation->setup.skin, mf_simd_name());
        }
    fail_msg("the two counts of pairs in range differ by %zu", missed);
}

/// The list holds no pair twice, so that if it has as many pairs in range as there are, it has all.
static void watch(struct watcher *watcher, const struct simulation *simulation) {
    take_positions(watcher, &simulation->particles);
    const size_t listed = count_listed(watcher, &simulation->neighbours);
    const size_t all = count_all(watcher);
    if (listed != all)
        fail_incomplete(watcher, simulation, all - listed);
    watcher->pairs += all;
    watched_pairs += all;
    watched_steps++;
}

/// How the particles start.
struct beginning {
    double heat;     ///< factor of the velocities that the setup gives
    double drift[3]; ///< velocity that all have in common
    bool opposed;    ///< every other particle drifts the other way
};

/// A simulation at the positions of `setup` with the velocities of `beginning`.
static void begin(struct simulation *simulation, const struct simulation_setup *setup,
                  const struct beginning *beginning) {
    struct simulation from;
    assert_ok(mf_simulation_init(&from, setup, NULL));
    for (int d = 0; d < setup->box.dimensions; d++)
        for (size_t k = 0; k < from.particles.count; k++) {
            double *v = &from.particles.velocity[d][k];
            const double sign = beginning->opposed && from.particles.id[k] % 2 ? -1 : 1;
            *v = *v * beginning->heat + sign * beginning->drift[d];
        }
    fluid_continue(simulation, setup, &from);
    mf_simulation_clear(&from);
}

/// What shows that a scene was what it should be.
struct outcome {
    double temperature; ///< at the end, of the motion against each other
    double builds;      ///< lists in a step
    double pairs;       ///< in range, in a step
};

static struct outcome run(const struct simulation_setup *setup, const struct beginning *beginning) {
    struct simulation simulation;
    struct watcher watcher;
    begin(&simulation, setup, beginning);
    watcher_init(&watcher, &simulation);
    for (int k = 0; k < STEPS; k++) {
        assert_ok(mf_simulation_run(&simulation, 1));
        watch(&watcher, &simulation);
    }
    const struct outcome outcome = {.temperature = mf_particles_temperature(&simulation.particles),
                                    .builds = (double)simulation.list_builds / STEPS,
                                    .pairs = (double)watcher.pairs / STEPS};
    assert_true(watcher.pairs > 0);
    watcher_clear(&watcher);
    mf_simulation_clear(&simulation);
    return outcome;
}

/// One scene with all skins and instruction sets, which ends about at `temperature`.
static void check_scene(struct fluid *fluid, const char *what, const struct beginning *beginning,
                        double temperature) {
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    for (int v = 0; v < variant_count; v++) {
        // Lists know nothing of the precision of forces: one instruction set is enough for both.
        if (variants[v].precision == PAIR_DOUBLE && v > 1)
            continue;
        variants_select(&variants[v]);
        fluid->setup.precision = (int)variants[v].precision;
        print_message("%s, %s:", what, variants[v].name);
        for (int s = 0; s < SKINS; s++) {
            fluid->setup.skin = skins[s];
            const struct outcome outcome = run(&fluid->setup, beginning);
            print_message(" skin %g: %.2f lists a step", skins[s], outcome.builds);
            if (s == SKINS - 1)
                print_message("; T = %.2f, %.1f pairs\n", outcome.temperature, outcome.pairs);
            assert_close(outcome.temperature, temperature, temperature_band * temperature + 1e-9);
            // The list was rebuilt, and a list with a wide skin was kept for some steps.
            assert_true(outcome.builds > 0 && (skins[s] < 0.3 || outcome.builds < 0.7));
        }
    }
    variants_select(&variants[0]);
    fluid_clear(fluid);
}

static const struct beginning as_drawn = {.heat = 1};

static void set_box(struct fluid *fluid, double a, double b, double c) {
    const double length[3] = {a, b, c};
    memcpy(fluid->setup.box.length, length, sizeof length);
}

/// The standard fluid at density 3.
static void make_fluid(struct fluid *fluid, double a, double b, double c, double temperature) {
    fluid_groot_warren(fluid, lround(3 * a * b * c), 0.008);
    set_box(fluid, a, b, c);
    fluid->setup.temperature = temperature;
    fluid->setup.temperature_limit = 1e4; // it counts the drift
}

/// The same in two dimensions, at density 2.
static void make_discs(struct fluid *fluid, double a, double b, double temperature) {
    fluid_soft_discs(fluid, lround(2 * a * b), 0.008);
    set_box(fluid, a, b, 1);
    fluid->setup.temperature = temperature;
}

static void test_list_is_complete_when_the_fluid_is_in_equilibrium(void **state) {
    (void)state;
    struct fluid fluid;
    make_fluid(&fluid, 5.1, 4.7, 5.6, 1);
    check_scene(&fluid, "fluid", &as_drawn, 1);
    make_fluid(&fluid, 14.3, 2.9, 3.1, 1);
    check_scene(&fluid, "long box", &as_drawn, 1);
    make_discs(&fluid, 13.1, 9.7, 1);
    check_scene(&fluid, "discs", &as_drawn, 1);
}

static void test_list_is_complete_when_the_fluid_is_hot(void **state) {
    (void)state;
    struct fluid fluid;
    // So narrow that the skin is cut to 0.15.
    make_fluid(&fluid, 2.3, 7.4, 7.9, 4);
    check_scene(&fluid, "hot fluid", &as_drawn, 4);
    make_discs(&fluid, 8.9, 11.3, 4);
    check_scene(&fluid, "hot discs", &as_drawn, 4);
}

/// A gas without forces; the table belongs to the caller.
static void make_gas(struct fluid *fluid, struct table *nothing, double time_step) {
    fluid_ideal_gas(fluid, 3, 400, time_step);
    set_box(fluid, 6.3, 5.2, 5.8);
    fluid_no_potential(nothing);
    fluid->setup.omega = NULL;
    fluid->setup.potential = nothing;
    fluid->setup.integrator = &mf_velocity_verlet;
}

static void test_list_is_complete_when_all_particles_drift_together(void **state) {
    (void)state;
    struct fluid fluid;
    struct table nothing;
    // Nothing happens but that the gas moves by some boxes.
    const struct beginning slow = {.drift = {1.5, -0.9, 1.1}};
    make_gas(&fluid, &nothing, 0.03);
    check_scene(&fluid, "drifting gas", &slow, 0);
    mf_table_clear(&nothing);
    const struct beginning fast = {.heat = 1, .drift = {-7, 4, 9}};
    make_fluid(&fluid, 4.9, 5.7, 5.2, 1);
    check_scene(&fluid, "drifting fluid", &fast, 1);
}

/// The hardest on the rule that a list is stale once a particle has moved by half the skin: there
/// are always pairs of which both do, towards each other, so that nothing of the skin is to spare.
static void test_list_is_complete_when_two_streams_meet_head_on(void **state) {
    (void)state;
    static const char *const what[] = {"streams along x", "streams along y", "streams along z"};
    for (int d = 0; d < 3; d++) {
        struct fluid fluid;
        struct table nothing;
        struct beginning streams = {.opposed = true};
        streams.drift[d] = 1;
        make_gas(&fluid, &nothing, 0.007);
        check_scene(&fluid, what[d], &streams, 1. / 3);
        mf_table_clear(&nothing);
    }
}

static void test_list_is_complete_when_the_temperature_changes(void **state) {
    (void)state;
    struct fluid fluid;
    const struct beginning at_rest = {.heat = 0}, hot = {.heat = 3};
    make_fluid(&fluid, 5.3, 4.8, 5.1, 4);
    check_scene(&fluid, "lattice at rest, heated", &at_rest, 4);
    make_fluid(&fluid, 5.3, 4.8, 5.1, 1);
    check_scene(&fluid, "lattice at T = 9, cooled", &hot, 1);
}

static int report(void **state) {
    (void)state;
    print_message("%zu steps with %zu pairs in range, none missed\n", watched_steps, watched_pairs);
    return watched_steps >= 10000 ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_list_is_complete_when_the_fluid_is_in_equilibrium),
        cmocka_unit_test(test_list_is_complete_when_the_fluid_is_hot),
        cmocka_unit_test(test_list_is_complete_when_all_particles_drift_together),
        cmocka_unit_test(test_list_is_complete_when_two_streams_meet_head_on),
        cmocka_unit_test(test_list_is_complete_when_the_temperature_changes),
    };
    return cmocka_run_group_tests(tests, NULL, report);
}
