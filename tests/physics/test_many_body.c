// SPDX-License-Identifier: GPL-3.0-or-later
//
// Energies of local densities in motion, and in LAMMPS (Debian's lmp with its package MANYBODY;
// skipped where there is none).
#include "base/comoments.h"
#include "curves/expression_law.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/many_bodies.h"
#include "shared/other_engine.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Energy ------------------------------------------------------------------------------------------

static double total_energy(const struct simulation *simulation) {
    return (simulation->sums.energy +
            0.5 * mf_particles_square_velocities(&simulation->particles)) /
           (double)simulation->particles.count;
}

/// Slope of the energy of a bead over time, and its scatter about that line.
static void follow(const struct many_bodies *many, const struct simulation *from, double time_step,
                   double *slope, double *scatter) {
    static const double duration = 1, interval = 0.01;
    struct simulation_setup setup = many->fluid.setup;
    struct simulation simulation;
    struct comoments moments;
    setup.omega = NULL;
    setup.integrator = &mf_velocity_verlet;
    setup.time_step = time_step;
    setup.precision = PAIR_DOUBLE;
    fluid_continue(&simulation, &setup, from);
    simulation.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_comoments_init(&moments, 2));
    for (double time = 0; time < duration; time += interval) {
        assert_ok(mf_simulation_run(&simulation, (uint64_t)lround(interval / time_step)));
        mf_comoments_add(&moments, (double[]){time, total_energy(&simulation)});
    }
    const double tt = mf_comoments_covariance(&moments, 0, 0),
                 te = mf_comoments_covariance(&moments, 0, 1),
                 ee = mf_comoments_covariance(&moments, 1, 1);
    *slope = te / tt;
    *scatter = sqrt(ee - te * te / tt);
    mf_comoments_clear(&moments);
    mf_simulation_clear(&simulation);
}

/// As of pairs (test_nve): no drift, and an error of second order in the time step. Measured: 7e-5,
/// of what the fluid is still finding its place by.
static const double largest_drift = 3e-4;

static void test_energy_is_kept_without_friction(void **state) {
    (void)state;
    for (int mixed = 0; mixed < 2; mixed++) {
        struct many_bodies many;
        struct simulation start;
        double slope[2], scatter[2];
        (mixed ? many_bodies_mixture : many_bodies_dpd)(&many, 3, 500);
        assert_ok(mf_simulation_init(&start, &many.fluid.setup, NULL));
        assert_ok(mf_simulation_run(&start, 300));
        follow(&many, &start, 0.005, &slope[0], &scatter[0]);
        follow(&many, &start, 0.0025, &slope[1], &scatter[1]);
        print_message(
            "%s: drift %.2e per bead and time unit; scatter %.2e, of half the step %.2e\n",
            mixed ? "mixture" : "many-body DPD", slope[1], scatter[0], scatter[1]);
        assert_true(fabs(slope[1]) < largest_drift);
        assert_close(scatter[0] / scatter[1], 4, 1);
        mf_simulation_clear(&start);
        many_bodies_clear(&many);
    }
}

// LAMMPS ------------------------------------------------------------------------------------------

enum { BEADS = 150, TABLE = 2001 };

static bool lammps_is_there(void) {
    if (!other_engine_runs("lmp"))
        return false;
    if (system("lmp -h | grep -q local/density") == 0)
        return true;
    print_message("skipped: lmp lacks local/density\n");
    return false;
}

/// Two types; the weights that LAMMPS has, and energies whose slopes are 0 at both ends of the
/// table, as LAMMPS takes them to be.
static void make_laws(struct many_bodies *many) {
    static const struct {
        uint32_t central, neighbours;
        double inner, cutoff;
        const char *formula;
    } terms[] = {{1, 2, 0.5, 1.4, "0.3*(rho - 9)^2*exp(-rho/3)"},
                 {2, 3, 0, 1.6, "2*exp(-(rho - 4)^2/5)"},
                 {3, 3, 1, 1.5, "0.02*rho^2*exp(-(rho/8)^4)"}};
    *many = (struct many_bodies){0};
    fluid_groot_warren(&many->fluid, BEADS, 0.01);
    struct simulation_setup *setup = &many->fluid.setup;
    setup->box = (struct box){3, {4, 4.5, 5}};
    setup->composition =
        (struct composition){.types = 2, .count = {60, BEADS - 60}, .name = {"A", "B"}};
    setup->potential = setup->omega = NULL;
    setup->precision = PAIR_DOUBLE;
    setup->placement.kind = PLACEMENT_RANDOM;
    setup->placement.separation = 0;
    many->law.composition = setup->composition;
    for (size_t n = 0; n < sizeof terms / sizeof *terms; n++) {
        struct weight_parameters shape = {terms[n].inner, terms[n].cutoff, 3};
        struct curve energy;
        assert_ok(mf_curve_create(&energy, &mf_density_energy_expression));
        for (const struct field *field = energy.family->fields; field->name; field++) {
            char *member = (char *)energy.parameters + field->offset;
            if (field->type == FIELD_TEXT)
                strcpy(member, terms[n].formula);
            else
                memcpy(member, &(double){strcmp(field->name, "maximum") == 0 ? 40 : -5},
                       sizeof(double));
        }
        many_bodies_add(&many->law, "term", terms[n].central, terms[n].neighbours,
                        &(struct curve){&mf_weight_sanyal_shell, &shape}, &energy);
        mf_curve_clear(&energy);
    }
    setup->interaction[setup->interactions++] =
        (struct interaction_choice){&mf_many_body, &many->law};
}

static FILE *open_for(const char *name) {
    FILE *stream = fopen(name, "w");
    assert_non_null(stream);
    return stream;
}

static void write_set(FILE *stream, uint32_t set) {
    for (int t = 0; t < 2; t++)
        if (set >> t & 1)
            fprintf(stream, "%d ", t + 1);
    fprintf(stream, "\n");
}

static void write_table(const struct many_body *law) {
    FILE *stream = open_for("local.table");
    fprintf(stream, "# local densities\n# of a test\n%d %d\n\n", law->terms, TABLE);
    for (int t = 0; t < law->terms; t++) {
        const struct many_body_term *term = &law->term[t];
        const double low = -5, high = 40, step = (high - low) / (TABLE - 1);
        fprintf(stream, "%.17g %.17g\n", term->weight.inner, weight_cutoff(&term->weight));
        write_set(stream, term->central);
        write_set(stream, term->neighbours);
        fprintf(stream, "%.17g %.17g %.17g\n", low, high, step);
        for (int k = 0; k < TABLE; k++) {
            double slope;
            fprintf(stream, "%.17g\n",
                    mf_density_energy_value(&term->energy, low + k * step, &slope));
        }
        fprintf(stream, "\n");
    }
    fclose(stream);
}

static void write_atoms(FILE *stream, const struct particles *particles) {
    for (size_t k = 0; k < particles->count; k++)
        fprintf(stream, "%u %d %.17g %.17g %.17g\n", particles->id[k] + 1,
                particles->id[k] < 60 ? 1 : 2, particles->position[0][k], particles->position[1][k],
                particles->position[2][k]);
}

static void write_start(const struct particles *particles) {
    static const char axis[] = "xyz";
    FILE *stream = open_for("start.data");
    fprintf(stream, "a test\n\n%zu atoms\n2 atom types\n\n", particles->count);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "0 %.17g %clo %chi\n", particles->box.length[d], axis[d], axis[d]);
    fprintf(stream, "\nMasses\n\n1 1\n2 1\n\nAtoms # atomic\n\n");
    write_atoms(stream, particles);
    fclose(stream);
    stream = open_for("in.lammps");
    fprintf(stream, "units lj\natom_style atomic\nnewton on\nread_data start.data\n"
                    "pair_style local/density\npair_coeff * * local.table\nneighbor 0.2 bin\n"
                    "dump forces all custom 1 forces.dump id fx fy fz\n"
                    "dump_modify forces sort id format float %%.15g\n"
                    "thermo_style custom step pe press\n"
                    "thermo_modify format float %%.15g norm no\nthermo 1\n"
                    "rerun frames.dump dump x y z\n");
    fclose(stream);
}

static void write_frame(FILE *stream, int frame, const struct particles *particles) {
    fprintf(stream, "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%zu\nITEM: BOX BOUNDS pp pp pp\n",
            frame, particles->count);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "0 %.17g\n", particles->box.length[d]);
    fprintf(stream, "ITEM: ATOMS id type x y z\n");
    write_atoms(stream, particles);
}

/// Skip to what follows a line that begins so.
static void skip_to(FILE *stream, const char *head) {
    char line[1024];
    while (fgets(line, sizeof line, stream))
        if (strncmp(line + strspn(line, " "), head, strlen(head)) == 0)
            return;
    fail_msg("LAMMPS does not say \"%s\"", head);
}

/// Forces, energy and pressure of the kernels and of LAMMPS, whose numbers follow in the files.
static void compare(const struct simulation *simulation, FILE *log, FILE *forces) {
    const struct particles *particles = &simulation->particles;
    double energy, pressure, force[BEADS][3], largest = 0;
    assert_int_equal(fscanf(log, "%*d %lf %lf", &energy, &pressure), 2);
    skip_to(forces, "ITEM: ATOMS");
    for (int k = 0; k < BEADS; k++)
        assert_int_equal(
            fscanf(forces, "%*d %lf %lf %lf", &force[k][0], &force[k][1], &force[k][2]), 3);
    assert_close_relative(simulation->sums.energy, energy, 1e-8);
    assert_close(simulation->sums.virial / (3 * mf_box_volume(&particles->box)), pressure,
                 1e-6 * fabs(pressure) + 1e-7);
    for (int k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++)
            largest = fmax(largest, fabs(force[k][d]));
    for (size_t k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++)
            assert_close(particles->force[d][k], force[particles->id[k]][d], 1e-6 * largest);
}

static void test_energies_forces_and_pressures_are_those_of_lammps(void **state) {
    const int frames = length_is_long() ? 100 : 6;
    struct many_bodies many;
    struct simulation *simulation = calloc((size_t)frames, sizeof *simulation);
    (void)state;
    if (!lammps_is_there())
        skip();
    assert_non_null(simulation);
    make_laws(&many);
    FILE *stream = open_for("frames.dump");
    for (int n = 0; n < frames; n++) {
        many.fluid.setup.seed = 100 + (uint64_t)n;
        assert_ok(mf_simulation_init(&simulation[n], &many.fluid.setup, NULL));
        assert_ok(mf_simulation_compute_potential(&simulation[n]));
        write_frame(stream, n, &simulation[n].particles);
    }
    fclose(stream);
    write_table(&many.law);
    write_start(&simulation[0].particles);
    if (system("lmp -in in.lammps -log none >lmp.out 2>&1") != 0)
        fail_msg("LAMMPS failed: see lmp.out");
    FILE *log = fopen("lmp.out", "r"), *forces = fopen("forces.dump", "r");
    assert_true(log && forces);
    skip_to(log, "Step");
    for (int n = 0; n < frames; n++) {
        compare(&simulation[n], log, forces);
        mf_simulation_clear(&simulation[n]);
    }
    fclose(log);
    fclose(forces);
    free(simulation);
    many_bodies_clear(&many);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energy_is_kept_without_friction),
        cmocka_unit_test_setup_teardown(test_energies_forces_and_pressures_are_those_of_lammps,
                                        small_inputs_enter, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
