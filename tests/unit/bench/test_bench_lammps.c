// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/formula.h"
#include "curves/sampled.h"
#include "bench/bench_lammps.h"
#include "report/program.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/other_engine.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

/// 500 particles of Lennard-Jones without friction, or of its points from a table.
struct liquid {
    struct scene scene;
    struct simulation simulation;
};

static void make_liquid(struct liquid *liquid, bool from_table) {
    enum { POINTS = 800 };
    static double r[POINTS], value[POINTS];
    struct fluid fluid;
    struct scene *scene = &liquid->scene;
    *scene = (struct scene){0};
    fluid_lennard_jones(&fluid, 500, 0.002);
    scene->setup = fluid.setup;
    fluid_clear(&fluid);
    scene->setup.integrator = &mf_velocity_verlet;
    scene->setup.omega = NULL;
    assert_ok(mf_curve_create(&scene->potential.curve[0], &mf_formula_lennard_jones));
    if (from_table) {
        for (int k = 0; k < POINTS; k++) {
            r[k] = 0.8 + 1.7 * k / (POINTS - 1);
            value[k] = mf_curve_value(&scene->potential.curve[0], r[k]);
        }
        mf_curve_clear(&scene->potential.curve[0]);
        assert_ok(mf_sampled_create(&scene->potential.curve[0], r, value, POINTS));
    }
    assert_ok(mf_table_init_potential(&scene->potential.table, &scene->potential.curve[0]));
    scene->setup.potential = &scene->potential.table;
    assert_ok(mf_simulation_init(&liquid->simulation, &scene->setup, NULL));
    assert_ok(mf_simulation_run(&liquid->simulation, 200));
    liquid->simulation.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(&liquid->simulation, 1));
}

static void clear_liquid(struct liquid *liquid) {
    mf_simulation_clear(&liquid->simulation);
    mf_scene_clear(&liquid->scene);
}

/// LAMMPS reads its input and finds temperature, energy and pressure of the same state.
static void check_first_state(struct temporary_folder *folder, bool from_table) {
    static const char *const words[] = {"lmp",  "-in", "in.bench", "-log",  "none", "-var",
                                        "skin", "0.3", "-var",     "steps", "10",   NULL};
    struct liquid liquid;
    char text[16384];
    double temperature, energy, pressure;
    make_liquid(&liquid, from_table);
    assert_ok(mf_bench_lammps_write(folder->path, &liquid.scene, &liquid.simulation));
    assert_ok(mf_program_run(folder->path, words, PROGRAM_EVERYTHING, 0, text, sizeof text));
    const char *heading = strstr(text, "Step Temp E_pair E_mol TotEng Press");
    assert_non_null(heading);
    assert_int_equal(
        sscanf(strchr(heading, '\n'), " 0 %lf %lf %*f %*f %lf", &temperature, &energy, &pressure),
        3);
    const struct simulation *simulation = &liquid.simulation;
    assert_close_relative(temperature, mf_particles_temperature(&simulation->particles), 1e-4);
    assert_close_relative(energy, simulation->sums.energy / 500, 1e-4);
    assert_close(pressure, mf_simulation_pressure(simulation), 3e-3);
    assert_true(mf_bench_lammps_rate(text) > 0);
    clear_liquid(&liquid);
}

static void test_bench_lammps_write_gives_the_same_lennard_jones(void **state) {
    other_engine_skip_without("lmp");
    check_first_state(*state, false);
}

static void test_bench_lammps_write_gives_the_same_table(void **state) {
    other_engine_skip_without("lmp");
    check_first_state(*state, true);
}

static void test_bench_lammps_rate_is_that_of_the_last_run(void **state) {
    (void)state;
    assert_close(mf_bench_lammps_rate("Loop time of 1 on 1 procs for 50 steps with 500 atoms\n"
                                      "Loop time of 0.25 on 1 procs for 300 steps with 500 atoms\n"
                                      "Total wall time: 0:00:01\n"),
                 1200, 1e-9);
    assert_true(isnan(mf_bench_lammps_rate("ERROR: no\n")));
    assert_true(isnan(mf_bench_lammps_rate("Loop time of nothing")));
}

static void test_bench_lammps_unsupported_says_what_debians_lammps_lacks(void **state) {
    (void)state;
    struct scene scene = {.setup = {.integrator = &mf_velocity_verlet, .box.dimensions = 3}};
    assert_contains(mf_bench_lammps_unsupported(&scene), "neither a table nor Lennard-Jones");
    scene.potential.curve[0].family = &mf_formula_lennard_jones;
    assert_null(mf_bench_lammps_unsupported(&scene));
    scene.potential.curve[0].family = &mf_sampled_family;
    assert_null(mf_bench_lammps_unsupported(&scene));
    scene.setup.box.dimensions = 2;
    assert_contains(mf_bench_lammps_unsupported(&scene), "three dimensions");
    scene.setup.integrator = &mf_dpd_verlet;
    assert_contains(mf_bench_lammps_unsupported(&scene), "velocity-verlet");
    scene.omega.curves = 1;
    assert_contains(mf_bench_lammps_unsupported(&scene), "friction");
    scene.setup.composition.types = 2;
    assert_contains(mf_bench_lammps_unsupported(&scene), "mixture");
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_bench_lammps_write_gives_the_same_lennard_jones),
        IN_FOLDER(test_bench_lammps_write_gives_the_same_table),
        cmocka_unit_test(test_bench_lammps_rate_is_that_of_the_last_run),
        cmocka_unit_test(test_bench_lammps_unsupported_says_what_debians_lammps_lacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
