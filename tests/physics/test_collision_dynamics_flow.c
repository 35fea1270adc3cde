// SPDX-License-Identifier: GPL-3.0-or-later
//
// Flow past discs, and the momentum that they take. Seeds are fixed.
#include "dynamics/solvent.h"
#include "observe/flow_field.h"
#include "observe/measure.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <math.h>
#include <stdlib.h>

/// A square array of discs without plates: all of the driving force is drag on the disc, and slow
/// flow obeys F/(μ U) = 4π/(½ ln(1/c) − 0.738 + c − 0.887 c² + 2.039 c³), U the velocity averaged
/// over fluid and discs, c their share of the area: A. S. Sangani and A. Acrivos, Int. J.
/// Multiphase Flow 8, 193 (1982). F is known; the drag is the balance of momentum, to its
/// statistical error.
static void test_drag_on_an_array_of_discs_is_that_of_slow_flow(void **state) {
    (void)state;
    static const struct collision_dynamics_parameters parameters = {.cell = 1,
                                                                    .particles_per_cell = 10,
                                                                    .mass = 1,
                                                                    .angle = 130,
                                                                    .interval = 1,
                                                                    .thermostat = 1,
                                                                    .grid_shift = 1,
                                                                    .hydrodynamics = 1,
                                                                    .wall_filling = 1.4,
                                                                    .acceleration = {0.012},
                                                                    .obstacle_centre = {12, 12},
                                                                    .obstacle_radius = 5};
    const struct simulation_setup setup = {.box = {2, {24, 24, 1}},
                                           .temperature = 1,
                                           .time_step = 0.1,
                                           .temperature_limit = 100,
                                           .integrator = &mf_collision_dynamics,
                                           .integrator_parameters = &parameters,
                                           .seed = 5,
                                           .threads = 1};
    const struct measure_plan plan = {.equilibration = 1000, .samples = 4000, .every = 10};
    const struct { double spacing; } settings = {1};
    struct simulation simulation;
    double temperature;
    void *flow = calloc(1, mf_flow_field.state_size);
    assert_non_null(flow);
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    assert_ok(told_begin(&mf_flow_field, flow, &settings, &simulation, &plan));
    const struct observable_use uses[] = {{.observable = &mf_flow_field, .state = flow}, {0}};
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(mf_measure_sample(&simulation, &plan, uses, NULL));
    const struct flow_field_summary found = mf_flow_field_result(flow);
    const double c = M_PI * 25 / (24 * 24), density = 10;
    const double factor =
        4 * M_PI / (0.5 * log(1 / c) - 0.738 + c - 0.887 * c * c + 2.039 * c * c * c);
    const double viscosity = density * mf_collision_dynamics_viscosity(&setup);
    const double expected = factor * viscosity * found.velocity * (1 - c);
    // The acceleration pushes the fluid alone; a drop of pressure would push the discs as well.
    const double force = found.driving_force / (1 - c);
    const double error = expected * found.velocity_error / found.velocity;
    print_message("drag %.3f(%.3f), driving force %.3f, with buoyancy %.3f, of slow flow "
                  "%.3f(%.3f), Re %.2f\n",
                  found.drag, found.drag_error, found.driving_force, force, expected, error,
                  found.reynolds);
    assert_close(found.drag, found.driving_force, 4 * found.drag_error);
    assert_close_relative(expected, force, 0.08);
    mf_flow_field.clear(flow);
    free(flow);
    mf_simulation_clear(&simulation);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_drag_on_an_array_of_discs_is_that_of_slow_flow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
