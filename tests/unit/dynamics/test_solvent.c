// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solvent of collision dynamics: each collision by its definition, flights between walls, the
// same bits through threads and restarts, and what it refuses.
#include "base/rng.h"
#include "dynamics/simulation.h"
#include "dynamics/solvent.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

static const struct collision_dynamics_parameters plain = {.cell = 1,
                                                           .particles_per_cell = 6,
                                                           .mass = 1.5,
                                                           .angle = 110,
                                                           .interval = 1,
                                                           .grid_shift = 1,
                                                           .hydrodynamics = 1,
                                                           .wall_filling = 1.4};

static struct simulation_setup setup_of(int dimensions, int64_t beads,
                                        const struct collision_dynamics_parameters *parameters) {
    return (struct simulation_setup){
        .box = {dimensions, {8, 6, dimensions == 3 ? 5 : 1}},
        .placement = {.count = beads, .kind = PLACEMENT_LATTICE, .jitter = 0.4},
        .attribute[ATTRIBUTES_MASS] = {.ranges = beads > 0, .range = {{2, 9}}},
        .temperature = 1.2,
        .time_step = 0.3,
        .temperature_limit = 100,
        .integrator = &mf_collision_dynamics,
        .integrator_parameters = parameters,
        .seed = 11,
        .threads = 1};
}

/// Σ m v and Σ m v² of solvent and beads.
struct totals {
    double momentum[3], squares;
};

static struct totals add_up(const struct simulation *simulation) {
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    const struct particles *beads = &simulation->particles;
    const double *mass = particles_masses(beads);
    struct totals totals = {{0}, 0};
    for (int d = 0; d < beads->box.dimensions; d++) {
        for (size_t k = 0; k < solvent->count; k++) {
            totals.momentum[d] += solvent->parameters.mass * solvent->velocity[d][k];
            totals.squares += solvent->parameters.mass * pow(solvent->velocity[d][k], 2);
        }
        for (size_t k = 0; k < beads->count; k++) {
            totals.momentum[d] += mass[k] * beads->velocity[d][k];
            totals.squares += mass[k] * pow(beads->velocity[d][k], 2);
        }
    }
    return totals;
}

/// Rounding alone: 20 steps of 300 to 1500 particles change sums of 1e3 by less than 1e-10.
static void test_collisions_conserve_momentum_and_energy_with_beads_of_any_mass(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int64_t beads = 0; beads <= 40; beads += 40) {
            const struct simulation_setup setup = setup_of(dimensions, beads, &plain);
            struct simulation simulation;
            assert_ok(mf_simulation_init(&simulation, &setup, NULL));
            const struct totals before = add_up(&simulation);
            const size_t count = mf_collision_dynamics_solvent(&simulation)->count;
            assert_ok(mf_simulation_run(&simulation, 20));
            const struct totals after = add_up(&simulation);
            for (int d = 0; d < dimensions; d++)
                assert_close(after.momentum[d], before.momentum[d], 1e-10);
            assert_close_relative(after.squares, before.squares, 1e-12);
            assert_int_equal(mf_collision_dynamics_solvent(&simulation)->count, count);
            mf_simulation_clear(&simulation);
        }
}

/// The first velocities have the temperature and the drift exactly.
static void test_solvent_starts_with_its_temperature_and_drift(void **state) {
    (void)state;
    struct collision_dynamics_parameters parameters = plain;
    parameters.drift[0] = 0.7;
    const struct simulation_setup setup = setup_of(2, 0, &parameters);
    struct simulation simulation;
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    const struct totals totals = add_up(&simulation);
    const double count = 8 * 6 * 6;
    assert_close(totals.momentum[0], 1.5 * count * 0.7, 1e-10);
    assert_close(totals.momentum[1], 0, 1e-10);
    assert_close(totals.squares - 1.5 * count * 0.49, 2 * (count - 1) * 1.2, 1e-9);
    mf_simulation_clear(&simulation);
}

/// Number of the cell of a solvent particle by its definition, x along rows.
static size_t cell_by_definition(const struct solvent *solvent, size_t k) {
    size_t cell = 0;
    for (int d = solvent->box.dimensions - 1; d >= 0; d--) {
        const double shifted = solvent->position[d][k] + solvent->shift[d];
        const size_t cells = (size_t)rint(solvent->box.length[d]);
        cell = cell * cells + (size_t)floor(shifted) % cells;
    }
    return cell;
}

/// The mean velocity of the particles of a cell among `velocity`, shape [3][count].
static void mean_of_cell(const struct solvent *solvent, const double *velocity, size_t cell,
                         double mean[3]) {
    double count = 0;
    memset(mean, 0, 3 * sizeof *mean);
    for (size_t k = 0; k < solvent->count; k++)
        if (cell_by_definition(solvent, k) == cell) {
            count++;
            for (int d = 0; d < 3; d++)
                mean[d] += velocity[(size_t)d * solvent->count + k];
        }
    for (int d = 0; d < 3; d++)
        mean[d] /= count;
}

static double *copy_velocities(const struct solvent *solvent) {
    double *copy = calloc(3 * solvent->count, sizeof *copy);
    assert_non_null(copy);
    for (int d = 0; d < solvent->box.dimensions; d++)
        memcpy(copy + (size_t)d * solvent->count, solvent->velocity[d],
               solvent->count * sizeof(double));
    return copy;
}

/// By brute force over all particles: those of a cell keep their mean velocity, and relative
/// velocities turn together: all their products stay, and in the plane each turns by ±α, with the
/// same sign in a cell. In space the mean cosine of the turn is (1 + 2 cos α)/3.
static void test_collision_turns_relative_velocities_of_each_cell_together(void **state) {
    (void)state;
    const double alpha = 110 * M_PI / 180;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const struct simulation_setup setup = setup_of(dimensions, 0, &plain);
        struct simulation simulation;
        double cosines = 0, squares = 0, positive = 0, cells = 0;
        assert_ok(mf_simulation_init(&simulation, &setup, NULL));
        struct solvent *solvent = simulation.integrator_state;
        assert_ok(mf_solvent_stream(solvent, 7, 1));
        mf_solvent_sort(solvent, 1);
        double *before = copy_velocities(solvent);
        mf_solvent_collide(solvent, &simulation.particles, 7, 1);
        double *after = copy_velocities(solvent);
        for (size_t cell = 0; cell < solvent->cell_total; cell++) {
            const uint32_t begin = solvent->start[cell], end = solvent->start[cell + 1];
            double mean[3], mean_after[3], sign = 0;
            if (begin == end)
                continue;
            mean_of_cell(solvent, before, cell, mean);
            mean_of_cell(solvent, after, cell, mean_after);
            for (int d = 0; d < 3; d++)
                assert_close(mean_after[d], mean[d], 1e-12);
            for (uint32_t i = begin; i < end; i++) {
                assert_int_equal(cell_by_definition(solvent, i), cell);
                double u[3], v[3];
                for (int d = 0; d < 3; d++) {
                    u[d] = before[(size_t)d * solvent->count + i] - mean[d];
                    v[d] = after[(size_t)d * solvent->count + i] - mean[d];
                }
                for (uint32_t j = begin; j <= i; j++) {
                    double product = 0, product_after = 0;
                    for (int d = 0; d < 3; d++) {
                        const size_t k = (size_t)d * solvent->count + j;
                        product += u[d] * (before[k] - mean[d]);
                        product_after += v[d] * (after[k] - mean[d]);
                    }
                    assert_close(product_after, product, 1e-12);
                }
                const double square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
                const double cosine = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
                squares += square;
                cosines += cosine;
                if (dimensions == 3 || end - begin < 2)
                    continue;
                const double sine = (u[0] * v[1] - u[1] * v[0]) / (square * sin(alpha));
                assert_close(cosine, square * cos(alpha), 1e-12);
                assert_close(fabs(sine), 1, 1e-9);
                assert_true(sign * sine >= 0);
                sign = sine;
            }
            cells += sign != 0;
            positive += sign > 0;
        }
        print_message("%d-D: mean cosine %.3f; %.0f of %.0f cells turn to the left\n", dimensions,
                      cosines / squares, positive, cells);
        if (dimensions == 3) // 240 cells: 4.5 standard errors of 0.04, a false alarm in 150,000
            assert_close(cosines / squares, (1 + 2 * cos(alpha)) / 3, 0.18);
        else // 48 cells: 4.5 standard errors
            assert_close(positive, cells / 2, 4.5 * sqrt(cells) / 2);
        free(before);
        free(after);
        mf_simulation_clear(&simulation);
    }
}

static struct collision_dynamics_parameters with_walls(int thermostat) {
    struct collision_dynamics_parameters parameters = plain;
    parameters.walls = COLLISION_PLATES;
    parameters.acceleration[0] = 0.02;
    parameters.obstacle_radius = 1.1;
    parameters.obstacle_centre[0] = 0.4; // across the periodic boundary
    parameters.obstacle_centre[1] = 3.1;
    parameters.obstacle_centre[2] = 2;
    parameters.thermostat = thermostat;
    return parameters;
}

/// Nobody is ever in the obstacle or beyond a plate, and nobody is lost.
static void test_particles_stay_outside_walls_and_obstacle(void **state) {
    (void)state;
    const struct collision_dynamics_parameters parameters = with_walls(1);
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const struct simulation_setup setup = setup_of(dimensions, 20, &parameters);
        struct simulation simulation;
        assert_ok(mf_simulation_init(&simulation, &setup, NULL));
        const struct solvent *solvent = mf_collision_dynamics_solvent(&simulation);
        const double obstacle = dimensions == 2 ? M_PI * 1.21 : 4 * M_PI / 3 * 1.1 * 1.21;
        const double capacity = 48 * (dimensions == 3 ? 5 : 1) - obstacle;
        assert_int_equal(solvent->count, (size_t)rint(6 * capacity));
        for (int step = 0; step < 100; step++) {
            assert_ok(mf_simulation_run(&simulation, 1));
            for (size_t k = 0; k < solvent->count; k++) {
                double square = 0;
                for (int d = 0; d < dimensions; d++) {
                    const double x = solvent->position[d][k];
                    const double away = x - parameters.obstacle_centre[d];
                    const double length = solvent->box.length[d];
                    assert_true(x >= -1e-12 && x <= length);
                    square += pow(d == 1 ? away : away - length * rint(away / length), 2);
                }
                assert_true(sqrt(square) >= 1.1 - 1e-9);
            }
        }
        assert_true(solvent->given[0] != 0);
        mf_simulation_clear(&simulation);
    }
}

/// A flight that turns back at walls, stopped after `time` and turned around, ends where it began,
/// with an acceleration too: v → −v reverses parabolas. The same way in a thousand small flights.
static void test_flights_reverse_and_agree_with_small_flights(void **state) {
    (void)state;
    const struct collision_dynamics_parameters parameters = with_walls(0);
    const struct simulation_setup setup = setup_of(2, 0, &parameters);
    const double g[3] = {0.3, 0, 0};
    struct simulation simulation;
    int met = 0;
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    const struct solvent *solvent = mf_collision_dynamics_solvent(&simulation);
    for (size_t k = 0; k < solvent->count; k++) {
        double x[3] = {solvent->position[0][k], solvent->position[1][k]};
        double v[3] = {solvent->velocity[0][k], solvent->velocity[1][k]}, impulse[3] = {0};
        double small_x[3] = {x[0], x[1]}, small_v[3] = {v[0], v[1]};
        const double begin[2] = {x[0], x[1]}, speed[2] = {v[0], v[1]};
        assert_true(mf_solvent_propagate(solvent, x, v, g, 2, impulse));
        for (int n = 0; n < 1000; n++)
            assert_true(mf_solvent_propagate(solvent, small_x, small_v, g, 0.002, NULL));
        met += impulse[0] != 0;
        for (int d = 0; d < 2; d++) {
            assert_close(small_x[d], x[d], 1e-6);
            assert_close(small_v[d], v[d], 1e-6);
            v[d] = -v[d];
        }
        assert_true(mf_solvent_propagate(solvent, x, v, g, 2, NULL));
        for (int d = 0; d < 2; d++) {
            assert_close(x[d], begin[d], 1e-6);
            assert_close(v[d], -speed[d], 1e-6);
        }
    }
    print_message("%d of %zu flights met the obstacle\n", met, solvent->count);
    assert_true(met > 20);
    mf_simulation_clear(&simulation);
}

/// A slow particle that the acceleration presses against the obstacle hops ever less, on its
/// surface or behind it by rounding. It stays there, and hands on what presses it.
static void test_particle_that_is_pressed_against_the_obstacle_rests_there(void **state) {
    (void)state;
    const struct collision_dynamics_parameters parameters = with_walls(0);
    const struct simulation_setup setup = setup_of(2, 0, &parameters);
    const double g[3] = {0.3, 0, 0}, radius = parameters.obstacle_radius, time = 0.1;
    struct simulation simulation;
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    const struct solvent *solvent = mf_collision_dynamics_solvent(&simulation);
    for (double behind = -1e-13; behind <= 1e-13; behind += 1e-13)
        for (double slow = 1e-15; slow < 1e-4; slow *= 30) {
            double x[3] = {parameters.obstacle_centre[0] - radius + behind,
                           parameters.obstacle_centre[1]};
            double v[3] = {-slow, 0}, impulse[3] = {0};
            assert_true(mf_solvent_propagate(solvent, x, v, g, time, impulse));
            assert_close(x[0], parameters.obstacle_centre[0] - radius, 1e-6);
            assert_true(fabs(v[0]) < 0.005);
            assert_close(v[0] + impulse[0], time * g[0] - slow, 1e-9);
        }
    mf_simulation_clear(&simulation);
}

static void assert_same_solvent(const struct simulation *a, const struct simulation *b) {
    const struct solvent *left = mf_collision_dynamics_solvent(a);
    const struct solvent *right = mf_collision_dynamics_solvent(b);
    restart_assert_same(a, b);
    assert_int_equal(left->count, right->count);
    for (int d = 0; d < left->box.dimensions; d++) {
        const size_t bytes = left->count * sizeof(double);
        assert_memory_equal(left->position[d], right->position[d], bytes);
        assert_memory_equal(left->velocity[d], right->velocity[d], bytes);
    }
    assert_memory_equal(left->given, right->given, sizeof left->given);
}

static void test_solvent_has_the_same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int thermostat = 0; thermostat < 2; thermostat++) {
            const struct collision_dynamics_parameters parameters = with_walls(thermostat);
            struct simulation_setup setup = setup_of(dimensions, 30, &parameters);
            struct simulation alone, shared;
            assert_ok(mf_simulation_init(&alone, &setup, NULL));
            setup.threads = 3;
            assert_ok(mf_simulation_init(&shared, &setup, NULL));
            assert_ok(mf_simulation_run(&alone, 30));
            assert_ok(mf_simulation_run(&shared, 30));
            assert_same_solvent(&alone, &shared);
            mf_simulation_clear(&alone);
            mf_simulation_clear(&shared);
        }
}

static void test_solvent_goes_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    struct collision_dynamics_parameters parameters = with_walls(1);
    parameters.interval = 3;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct simulation_setup setup = setup_of(dimensions, 30, &parameters);
        struct simulation whole, pieces;
        setup.time_step = 0.1;
        assert_ok(mf_simulation_init(&whole, &setup, NULL));
        assert_ok(mf_simulation_init(&pieces, &setup, NULL));
        assert_ok(mf_simulation_run(&whole, 40));
        assert_ok(mf_simulation_run(&pieces, 16));
        restart_simulation(&pieces);
        assert_ok(mf_simulation_run(&pieces, 24));
        assert_same_solvent(&whole, &pieces);
        mf_simulation_clear(&whole);
        mf_simulation_clear(&pieces);
    }
}

static void assert_refused(const struct collision_dynamics_parameters *parameters, double time_step,
                           const char *message) {
    struct simulation_setup setup = setup_of(2, 0, parameters);
    struct simulation simulation;
    setup.time_step = time_step;
    assert_fails(mf_simulation_init(&simulation, &setup, NULL), STATUS_BAD_INPUT, message);
}

static void test_solvent_refuses_what_has_no_sense(void **state) {
    (void)state;
    struct collision_dynamics_parameters parameters = plain;
    parameters.cell = 0.7;
    assert_refused(&parameters, 0.1, "dynamics.cell: cells of 0.7 do not divide box[0] = 8");
    parameters = with_walls(0);
    parameters.obstacle_centre[1] = 0.5;
    assert_refused(&parameters, 0.1, "dynamics.obstacle_centre[1]: with 0.5 an obstacle of radius");
    parameters = with_walls(0);
    parameters.obstacle_radius = 4;
    parameters.walls = COLLISION_NO_WALLS;
    assert_refused(&parameters, 0.1, "dynamics.obstacle_radius: 4, and the");
    parameters = with_walls(0);
    parameters.obstacle_radius = 0;
    assert_refused(&parameters, 3, "crosses the channel of width 6 twice");
    parameters.acceleration[1] = 1;
    assert_refused(&parameters, 0.1, "dynamics.acceleration: 1 along y");
    parameters = with_walls(0);
    parameters.wave_acceleration = 1;
    assert_refused(&parameters, 0.1, "dynamics.wave_acceleration: a wave is for a periodic box");
    parameters = plain;
    parameters.particles_per_cell = 1e-3;
    assert_refused(&parameters, 0.1, "dynamics.particles_per_cell: 0.001 would be 0");
}

/// The results of the literature: ν = 0.191 for M = 5, α = 90°, Δt = 1, and 0.278 for M = 10, 60°,
/// 1, in two dimensions; in three by Kikuchi's formulas; a particle of the solvent diffuses by D =
/// (k_B T Δt/2m)[d M/((1 − cos α) (M − 1 + exp(−M))) − 1].
static void test_theory_is_that_of_the_literature_without_a_thermostat(void **state) {
    (void)state;
    struct collision_dynamics_parameters parameters = plain;
    parameters.mass = 1;
    parameters.angle = 90;
    parameters.particles_per_cell = 5;
    struct simulation_setup setup = setup_of(2, 0, &parameters);
    setup.temperature = setup.time_step = 1;
    assert_close(mf_collision_dynamics_viscosity(&setup), 0.191, 0.0005);
    assert_close(mf_collision_dynamics_diffusion(&setup, 1), 0.5 * (2 * 5 / (4 + exp(-5)) - 1),
                 1e-9);
    parameters.angle = 60;
    parameters.particles_per_cell = 10;
    assert_close(mf_collision_dynamics_viscosity(&setup), 0.278, 0.0005);
    setup.box.dimensions = 3;
    const double c = 9 + exp(-10), cosine = 0.5, twice = -0.5;
    assert_close(mf_collision_dynamics_viscosity(&setup),
                 1.0 / 18 * c / 10 * (1 - cosine) + 0.5 * (5 * 10 / (c * (2 - cosine - twice)) - 1),
                 1e-9);
    assert_close(mf_collision_dynamics_diffusion(&setup, 1), 0.5 * (3 * 10 / (c * 0.5) - 1), 1e-9);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_collisions_conserve_momentum_and_energy_with_beads_of_any_mass),
        cmocka_unit_test(test_solvent_starts_with_its_temperature_and_drift),
        cmocka_unit_test(test_collision_turns_relative_velocities_of_each_cell_together),
        cmocka_unit_test(test_particles_stay_outside_walls_and_obstacle),
        cmocka_unit_test(test_flights_reverse_and_agree_with_small_flights),
        cmocka_unit_test(test_particle_that_is_pressed_against_the_obstacle_rests_there),
        cmocka_unit_test(test_solvent_has_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(test_solvent_goes_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_solvent_refuses_what_has_no_sense),
        cmocka_unit_test(test_theory_is_that_of_the_literature_without_a_thermostat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
