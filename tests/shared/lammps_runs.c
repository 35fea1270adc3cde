// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/lammps_runs.h"

#include "forces/bonded.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void lammps_runs_skip_without(const char *style) {
    char command[256] = "command -v lmp >/dev/null";
    if (style)
        snprintf(command, sizeof command, "lmp -h 2>/dev/null | grep -q '%s'", style);
    if (system(command) == 0)
        return;
    print_message("lmp%s%s is not installed: LAMMPS is not run\n", style ? " with " : "",
                  style ? style : "");
    skip();
}

// One configuration -------------------------------------------------------------------------------

void lammps_runs_find_ours(struct lammps_runs_ours *ours) {
    struct simulation_start start = {{0}, {0}};
    assert_ok(mf_export_model_read(&ours->model, "out"));
    for (int d = 0; d < ours->model.setup.box.dimensions; d++) {
        start.position[d] = ours->model.position[d];
        start.velocity[d] = ours->model.velocity[d];
    }
    assert_ok(mf_simulation_init(&ours->simulation, &ours->model.setup, &start));
    assert_ok(mf_simulation_compute_potential(&ours->simulation));
}

void lammps_runs_clear_ours(struct lammps_runs_ours *ours) {
    mf_simulation_clear(&ours->simulation);
    mf_export_model_clear(&ours->model);
}

double lammps_runs_energy_of(const struct lammps_runs_ours *ours, int order) {
    const struct molecules *molecules = ours->model.molecules;
    double sum = 0;
    for (int k = 0; k < molecules->topology.kinds; k++) {
        const struct topology_kind *kind = &molecules->topology.kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int n = 0; n < kind->terms[order]; n++) {
                const struct topology_term *term = &kind->term[order][n];
                int32_t place[BONDED_MAX_TERM_BEADS];
                double q, energy;
                for (int bead = 0; bead < mf_bonded_kinds[order]->beads; bead++)
                    place[bead] = (int32_t)ours->simulation.particles
                                      .place[topology_id(kind, m, term->bead[bead])];
                mf_bonded_measure(order, 1, place, &ours->simulation.particles, &q);
                mf_bonded_value(&molecules->group[order][term->group].curve, q, &energy, NULL);
                sum += energy;
            }
    }
    return sum;
}

/// The exported input up to its integrator, and what asks for a start.
static void write_input(const char *columns) {
    FILE *from = fopen("lammps/in.mesofit", "r"), *to = fopen("lammps/in.once", "w");
    char line[4096];
    assert_true(from && to);
    while (fgets(line, sizeof line, from) && strncmp(line, "fix move", 8) != 0)
        fputs(line, to);
    fprintf(to,
            "unfix bath\nfix move all nve\nthermo_style custom step %s\n"
            "thermo_modify norm no format float %%.15g\n"
            "dump forces all custom 1 forces.txt id fx fy fz\n"
            "dump_modify forces sort id format float %%.15g\nrun 0\n",
            columns);
    fclose(from);
    fclose(to);
}

void lammps_runs_once(const char *columns, double *values, size_t count) {
    char line[1024];
    write_input(columns);
    if (system("cd lammps && lmp -in in.once >lmp.out 2>&1") != 0)
        fail_msg("LAMMPS failed: see lammps/lmp.out");
    FILE *stream = fopen("lammps/log.lammps", "r");
    assert_non_null(stream);
    do
        assert_non_null(fgets(line, sizeof line, stream));
    while (strncmp(line + strspn(line, " "), "Step", 4) != 0);
    assert_int_equal(fscanf(stream, "%*d"), 0);
    for (size_t k = 0; k < count; k++)
        assert_int_equal(fscanf(stream, "%lf", &values[k]), 1);
    fclose(stream);
}

static size_t place_of(const struct particles *particles, size_t id) {
    for (size_t k = 0; k < particles->count; k++)
        if (particles->id[k] == id)
            return k;
    fail_msg("there is no bead %zu", id);
    return 0;
}

double lammps_runs_compare_forces(const struct lammps_runs_ours *ours, double unit) {
    const struct particles *particles = &ours->simulation.particles;
    FILE *stream = fopen("lammps/forces.txt", "r");
    char line[1024];
    double worst = 0;
    size_t rows = 0, id;
    double f[3];
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream))
        if (sscanf(line, "%zu %lf %lf %lf", &id, &f[0], &f[1], &f[2]) == 4) {
            const size_t place = place_of(particles, id - 1);
            for (int d = 0; d < particles->box.dimensions; d++)
                worst = fmax(worst, fabs(f[d] / unit - particles->force[d][place]));
            rows++;
        }
    fclose(stream);
    assert_int_equal(rows, ours->model.count);
    return worst;
}

// Runs -------------------------------------------------------------------------------------------

double lammps_runs_rdf_difference(double unit) {
    FILE *first = fopen("out/rdf.tsv", "r"), *second = fopen("lammps/rdf.dat", "r");
    char line[512], other[512];
    double squares = 0;
    int rows = 0;
    assert_true(first && second);
    for (int k = 0; k < 4; k++) // three comments and the step
        assert_non_null(fgets(other, sizeof other, second));
    while (fgets(line, sizeof line, first)) {
        double r, g, their_r, their_g;
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lf %lf", &r, &g), 2);
        assert_non_null(fgets(other, sizeof other, second));
        assert_int_equal(sscanf(other, "%*d %lf %lf", &their_r, &their_g), 2);
        assert_true(fabs(their_r - unit * r) < 1e-5); // the same bins
        squares += (g - their_g) * (g - their_g);
        rows++;
    }
    fclose(first);
    fclose(second);
    assert_int_equal(rows, 100);
    return sqrt(squares / rows);
}

double lammps_runs_mean(int column, double *error) {
    enum { BLOCKS = 20 };
    static double values[100000];
    FILE *stream = fopen("lammps/thermo.dat", "r");
    char line[512];
    int rows = 0;
    double sum = 0, squares = 0;
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream)) {
        double v[4];
        if (line[0] != '#' && sscanf(line, "%lf %lf %lf %lf", &v[0], &v[1], &v[2], &v[3]) == 4)
            values[rows++] = v[column];
    }
    fclose(stream);
    for (int b = 0; b < BLOCKS; b++) {
        double block = 0;
        for (int k = 0; k < rows / BLOCKS; k++)
            block += values[b * (rows / BLOCKS) + k];
        block /= rows / BLOCKS;
        sum += block;
        squares += block * block;
    }
    sum /= BLOCKS;
    *error = sqrt((squares / BLOCKS - sum * sum) / (BLOCKS - 1));
    return sum;
}
