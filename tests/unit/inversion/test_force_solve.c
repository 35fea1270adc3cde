// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forces of a known law with noise that neighbouring frames share: they come back within their
// errors, which fall as one over the root of the number of frames; a pressure is met.
#include "base/rng.h"
#include "inversion/force_solve.h"
#include "measure/frame_forces.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BEADS = 80, BINS = 30, SEEDS = 12, FRAMES = 160 };

static const double edge = 4, cutoff = 1.5, noise = 4, memory = 0.8;

struct gas {
    struct trajectory_frame frame;
    struct box_vectors box;
    struct frame_pairs_plan pairs;
    struct measured_molecules none;
    struct frame_forces_plan plan;
    struct frame_forces forces;
    struct rng_sequence random;
    double position[BEADS][3], force[BEADS][3], own[BEADS][3];
    int32_t place_memory[3][BEADS], *place[3];
};

/// −dΦ/dr of Φ = 10 (1 − r/r_c)² + sin(2π r/r_c)²/2.
static double law_of(double r) {
    return 20 / cutoff * (1 - r / cutoff) - M_PI / cutoff * sin(4 * M_PI * r / cutoff);
}

static double potential_of(double r) {
    return 10 * pow(1 - r / cutoff, 2) + 0.5 * pow(sin(2 * M_PI * r / cutoff), 2);
}

static double normal(struct gas *gas) {
    double sum = -6;
    for (int k = 0; k < 12; k++)
        sum += mf_rng_sequence_uniform(&gas->random);
    return sum;
}

/// Anywhere; the noise of a bead is partly that of the frame before.
static void next_frame(struct gas *gas) {
    for (size_t k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++) {
            gas->position[k][d] = edge * mf_rng_sequence_uniform(&gas->random);
            gas->own[k][d] =
                memory * gas->own[k][d] + sqrt(1 - memory * memory) * noise * normal(gas);
            gas->force[k][d] = gas->own[k][d];
        }
    for (size_t i = 0; i < BEADS; i++)
        for (size_t j = 0; j < i; j++) {
            double way[3], square = 0;
            for (int d = 0; d < 3; d++) {
                way[d] = gas->position[i][d] - gas->position[j][d];
                way[d] -= edge * rint(way[d] / edge);
                square += way[d] * way[d];
            }
            const double r = sqrt(square);
            for (int d = 0; r < cutoff && d < 3; d++) {
                gas->force[i][d] += law_of(r) * way[d] / r;
                gas->force[j][d] -= law_of(r) * way[d] / r;
            }
        }
    assert_ok(mf_frame_box_places(&gas->box, &gas->frame, gas->place));
}

/// The equations of some frames, to be cleared by clear.
static struct gas *measure(uint32_t seed, size_t frames) {
    static const double box[3][3] = {{edge, 0, 0}, {0, edge, 0}, {0, 0, edge}};
    struct gas *gas = calloc(1, sizeof *gas);
    gas->random = mf_rng_sequence_begin(seed, RNG_PLACEMENT, 0, 0);
    gas->pairs = (struct frame_pairs_plan){
        .range = cutoff, .bins = BINS, .composition = {.types = 1, .count = {BEADS}}};
    gas->frame = (struct trajectory_frame){
        .atoms = BEADS, .position = gas->position, .force = gas->force, .has_forces = true};
    mf_frame_set_box(&gas->frame, box);
    for (int d = 0; d < 3; d++)
        gas->place[d] = gas->place_memory[d];
    gas->plan =
        (struct frame_forces_plan){.cutoff = cutoff, .pairs = &gas->pairs, .molecules = &gas->none};
    assert_ok(mf_frame_box_find(&gas->box, &gas->frame));
    for (size_t t = 0; t < frames; t++) {
        next_frame(gas);
        if (t == 0)
            assert_ok(mf_frame_forces_begin(&gas->plan, &gas->box, &gas->frame, gas->place, NULL));
        assert_ok(mf_frame_forces_find(&gas->forces, &gas->plan, &gas->box, &gas->frame, gas->place,
                                       NULL));
        mf_force_equations_add(&gas->plan.equations, gas->forces.gram, gas->forces.product,
                               gas->forces.virial, gas->forces.square);
    }
    return gas;
}

static void clear(struct gas *gas) {
    mf_frame_forces_clear(&gas->forces);
    mf_frame_forces_end(&gas->plan);
    free(gas);
}

/// Φ of a node and its standard error.
static double find_potential(const struct gas *gas, const struct force_solution *solution,
                             size_t node, double *error) {
    const struct force_curve *const curve = gas->plan.equations.curve;
    double weight[BINS + 1] = {0}, value = 0, variance = 0;
    mf_force_solution_integral(solution, curve, (double)node * curve->width, cutoff, weight);
    for (size_t k = 0; k < solution->size; k++) {
        value += weight[k] * solution->value[k];
        for (size_t l = 0; l < solution->size; l++)
            variance += weight[k] * weight[l] * solution->covariance[k * solution->size + l];
    }
    *error = sqrt(variance);
    return value;
}

/// Mean of z² over nodes of a seed, and mean error.
static double find_deviation(uint32_t seed, size_t frames, double *mean_error) {
    enum { FIRST = 4 };
    struct force_solution solution;
    struct gas *gas = measure(seed, frames);
    double sum = 0;
    assert_ok(mf_force_solve(&gas->plan.equations, 1, &solution));
    *mean_error = 0;
    for (size_t node = FIRST; node < BINS; node++) {
        double error;
        const double value = find_potential(gas, &solution, node, &error);
        const double truth = potential_of((double)node * cutoff / BINS);
        sum += pow((value - truth) / error, 2) / (BINS - FIRST);
        *mean_error += error / (BINS - FIRST);
    }
    assert_true(solution.explained > 0.1 && solution.explained < 1);
    assert_true(solution.directions > 3 && solution.directions <= BINS + 1);
    mf_force_solution_clear(&solution);
    clear(gas);
    return sum;
}

static void test_a_known_law_comes_back_within_its_errors(void **state) {
    double sum = 0, error;
    (void)state;
    for (uint32_t seed = 1; seed <= SEEDS; seed++)
        sum += find_deviation(seed, FRAMES, &error) / SEEDS;
    print_message("rms z over %d seeds: %.2f\n", SEEDS, sqrt(sum));
    assert_true(sqrt(sum) < 1.3);
    assert_true(sqrt(sum) > 0.6);
}

static void test_errors_fall_with_the_number_of_frames(void **state) {
    double few, many, all[2] = {0};
    (void)state;
    for (uint32_t seed = 1; seed <= 4; seed++) {
        find_deviation(seed, 64, &few);
        find_deviation(seed, 1024, &many);
        all[0] += few;
        all[1] += many;
    }
    print_message("errors with 64 and 1024 frames: %.3f %.3f\n", all[0] / 4, all[1] / 4);
    assert_true(all[0] / all[1] > 2.8);
    assert_true(all[0] / all[1] < 5.7);
}

/// U of a frame in a box whose edge is `stretch` times as long.
static double energy_of(const struct gas *gas, double stretch) {
    double sum = 0;
    for (size_t i = 0; i < BEADS; i++)
        for (size_t j = 0; j < i; j++) {
            double square = 0;
            for (int d = 0; d < 3; d++) {
                const double way = gas->position[i][d] - gas->position[j][d];
                square += pow(stretch * (way - edge * rint(way / edge)), 2);
            }
            sum += sqrt(square) < cutoff ? potential_of(sqrt(square)) : 0;
        }
    return sum;
}

/// w·c of the law against −dU/dV by a difference.
static void test_virial_is_the_slope_of_the_energy(void **state) {
    static const double small = 1e-4;
    (void)state;
    struct gas *gas = measure(3, 1);
    const double volume = pow(edge, 3);
    const double slope = (energy_of(gas, 1 + small) - energy_of(gas, 1 - small)) /
                         (volume * (pow(1 + small, 3) - pow(1 - small, 3)));
    double virial = 0;
    for (size_t k = 0; k <= BINS; k++)
        virial += gas->plan.equations.virial[k] * law_of((double)k * cutoff / BINS);
    print_message("virial %.4f, slope of the energy %.4f\n", virial, -slope);
    assert_true(fabs(virial + slope) < 0.005 * fabs(slope));
    clear(gas);
}

static double virial_of(const struct gas *gas, const struct force_solution *solution) {
    const struct force_equations *const equations = &gas->plan.equations;
    double sum = 0;
    for (size_t b = 0; b < force_equations_blocks(equations); b++)
        for (size_t k = 0; k < equations->size; k++)
            sum += equations->virial[b * equations->size + k] * solution->value[k];
    return sum / (double)equations->frames;
}

/// The pressure that is asked for is had, at little cost, and its direction is known as it is.
static void test_a_pressure_is_met(void **state) {
    static const double more = 0.3;
    struct force_solution free, met, loose;
    double error[3];
    (void)state;
    struct gas *gas = measure(5, FRAMES);
    assert_ok(mf_force_solve(&gas->plan.equations, 1, &free));
    assert_ok(mf_force_solve(&gas->plan.equations, 1, &met));
    assert_ok(mf_force_solve(&gas->plan.equations, 1, &loose));
    const double before = virial_of(gas, &free);
    assert_ok(mf_force_solution_meet(&met, &gas->plan.equations, before + more, 0));
    assert_ok(mf_force_solution_meet(&loose, &gas->plan.equations, before + more, more));
    assert_true(fabs(virial_of(gas, &met) - before - more) < 1e-9);
    assert_true(fabs(virial_of(gas, &loose) - before - more) < 1e-9);
    assert_true(met.explained < free.explained && met.explained > free.explained - 0.01);
    find_potential(gas, &free, BINS / 2, &error[0]);
    find_potential(gas, &met, BINS / 2, &error[1]);
    find_potential(gas, &loose, BINS / 2, &error[2]);
    print_message("share %.4f and %.4f, errors %.3f and %.3f\n", free.explained, met.explained,
                  error[0], error[1]);
    assert_true(error[1] > 0.3 * error[0] && error[1] < 3 * error[0]);
    assert_true(error[2] > 2 * error[1]);
    mf_force_solution_clear(&free);
    mf_force_solution_clear(&met);
    mf_force_solution_clear(&loose);
    clear(gas);
}

static void test_few_frames_tell_no_errors(void **state) {
    struct force_solution solution;
    (void)state;
    struct gas *gas = measure(1, 3);
    assert_int_equal(mf_force_solve(&gas->plan.equations, 1, &solution), STATUS_BAD_INPUT);
    clear(gas);
}

/// The force of a term or density goes on along its last two nodes, in the equations and in their
/// integral; that of pairs does not.
static void test_forces_go_on_beyond_their_nodes(void **state) {
    enum { NODES = 4 };
    bool known[NODES] = {true, true, true, true};
    const struct force_solution solution = {.size = NODES, .known = known};
    const double from = -1.3, to = 9.1, low = 2, width = 1.5;
    (void)state;
    for (int order = 0; order < 2; order++) {
        const struct force_curve curve = {
            .order = order ? FORCES_OF_DENSITY : 0, .low = low, .width = width, .nodes = NODES};
        double weight[NODES] = {0}, sum = 0, share;
        size_t node, next;
        mf_force_solution_integral(&solution, &curve, from, to, weight);
        for (size_t k = 0; k < NODES; k++) // of a force 5 − 3 q
            sum += weight[k] * (5 - 3 * (low + width * (double)k));
        assert_true(fabs(sum - (5 * (to - from) - 1.5 * (to * to - from * from))) < 1e-10);
        assert_true(mf_force_equations_find(&curve, to, &node, &next, &share));
        assert_true(fabs((1 - share) * (double)node + share * (double)next - (to - low) / width) <
                    1e-12);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_known_law_comes_back_within_its_errors),
        cmocka_unit_test(test_errors_fall_with_the_number_of_frames),
        cmocka_unit_test(test_virial_is_the_slope_of_the_energy),
        cmocka_unit_test(test_a_pressure_is_met),
        cmocka_unit_test(test_few_frames_tell_no_errors),
        cmocka_unit_test(test_forces_go_on_beyond_their_nodes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
