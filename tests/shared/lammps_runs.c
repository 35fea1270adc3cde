// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/lammps_runs.h"

#include "base/rng.h"
#include "export/export_units.h"
#include "forces/bonded.h"
#include "shared/other_engine.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void lammps_runs_skip_without(const char *style) {
    char command[256];
    other_engine_skip_without("lmp");
    snprintf(command, sizeof command, "lmp -h 2>/dev/null | grep -q '%s'", style ? style : "");
    if (system(command) == 0)
        return;
    print_message("skipped: lmp lacks %s\n", style);
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

/// The exported input up to its integrator, and what asks for forces and sums.
/// @param[in] command  that visits the configurations
static void write_input(const char *columns, const char *command) {
    FILE *from = fopen("lammps/in.mesofit", "r"), *to = fopen("lammps/in.once", "w");
    char line[4096];
    assert_true(from && to);
    while (fgets(line, sizeof line, from) && strstr(line, "is_defined(variable,pressure)") == NULL)
        fputs(line, to);
    fprintf(to,
            "unfix bath\nfix move all nve\nthermo 1\nthermo_style custom step %s\n"
            "thermo_modify norm no format float %%.15g\n"
            "dump forces all custom 1 forces.txt id fx fy fz\n"
            "dump_modify forces sort id format float %%.15g\n%s\n",
            columns, command);
    fclose(from);
    fclose(to);
}

/// Run it, and read its log up to the names of the columns.
static FILE *run_input(void) {
    char line[1024];
    if (system("cd lammps && lmp -in in.once >lmp.out 2>&1") != 0)
        fail_msg("LAMMPS failed: %s", temporary_folder_read("lammps/lmp.out"));
    FILE *stream = fopen("lammps/log.lammps", "r");
    assert_non_null(stream);
    do
        assert_non_null(fgets(line, sizeof line, stream));
    while (strncmp(line + strspn(line, " "), "Step", 4) != 0);
    return stream;
}

void lammps_runs_once(const char *columns, double *values, size_t count) {
    write_input(columns, "run 0");
    FILE *stream = run_input();
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

// Many configurations -----------------------------------------------------------------------------

void lammps_runs_move(struct lammps_runs_ours *ours, uint32_t configuration) {
    struct simulation_start start = {{0}, {0}};
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_PLACEMENT, configuration + 1, 0);
    struct rng_sequence before = mf_rng_sequence_begin(7, RNG_PLACEMENT, configuration, 0);
    for (int d = 0; d < ours->model.setup.box.dimensions; d++) {
        for (size_t k = 0; k < ours->model.count; k++) {
            ours->model.position[d][k] += 0.1 * (mf_rng_sequence_uniform(&random) - 0.5);
            if (configuration > 0)
                ours->model.position[d][k] -= 0.1 * (mf_rng_sequence_uniform(&before) - 0.5);
        }
        start.position[d] = ours->model.position[d];
        start.velocity[d] = ours->model.velocity[d];
    }
    mf_simulation_clear(&ours->simulation);
    assert_ok(mf_simulation_init(&ours->simulation, &ours->model.setup, &start));
    assert_ok(mf_simulation_compute_potential(&ours->simulation));
}

/// A frame of LAMMPS's dump.
static void write_frame(const struct lammps_runs_ours *ours, const struct export_units *units,
                        int frame, FILE *stream) {
    const struct particles *particles = &ours->simulation.particles;
    const struct box *box = &particles->box;
    fprintf(stream, "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%zu\nITEM: BOX BOUNDS pp pp pp\n",
            frame, particles->count);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "%.17g %.17g\n", d < box->dimensions ? 0 : -0.5 * units->length,
                (d < box->dimensions ? box->length[d] : 0.5) * units->length);
    fprintf(stream, "ITEM: ATOMS id x y z\n");
    for (size_t k = 0; k < particles->count; k++) {
        fprintf(stream, "%u", particles->id[k] + 1);
        for (int d = 0; d < 3; d++)
            fprintf(stream, " %.17g",
                    d < box->dimensions ? particles->position[d][k] * units->length : 0);
        fprintf(stream, "\n");
    }
}

/// How far the forces of the next frame of a dump are from ours, at most.
static double read_frame(const struct lammps_runs_ours *ours, double unit, FILE *stream) {
    enum { MOST = 10000 };
    static double f[MOST][3];
    const struct particles *particles = &ours->simulation.particles;
    char line[1024];
    double worst = 0;
    assert_true(particles->count <= MOST);
    do
        assert_non_null(fgets(line, sizeof line, stream));
    while (strncmp(line, "ITEM: ATOMS", 11) != 0);
    for (size_t id = 0; id < particles->count; id++) {
        assert_non_null(fgets(line, sizeof line, stream));
        assert_int_equal(sscanf(line, "%*u %lf %lf %lf", &f[id][0], &f[id][1], &f[id][2]), 3);
    }
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < particles->box.dimensions; d++)
            worst = fmax(worst, fabs(f[particles->id[k]][d] / unit - particles->force[d][k]));
    return worst;
}

/// A row of the log, which may have warnings before it: of images, which a rerun does not set.
static void read_row(FILE *stream, double energy[1 + BONDED_KINDS]) {
    char line[1024];
    do
        assert_non_null(fgets(line, sizeof line, stream));
    while (sscanf(line, "%*d %lf %lf %lf %lf", &energy[0], &energy[1], &energy[2], &energy[3]) !=
           1 + BONDED_KINDS);
}

static double largest_force(const struct particles *particles) {
    double largest = 0;
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < particles->box.dimensions; d++)
            largest = fmax(largest, fabs(particles->force[d][k]));
    return largest;
}

struct lammps_runs_apart lammps_runs_compare(int configurations) {
    static struct lammps_runs_ours ours;
    struct lammps_runs_apart apart = {0};
    FILE *frames = fopen("lammps/frames.dump", "w");
    assert_non_null(frames);
    lammps_runs_find_ours(&ours);
    const struct export_units units = mf_export_units(EXPORT_REAL, &ours.model.scene.units, false);
    for (int k = 0; k < configurations; k++, lammps_runs_move(&ours, (uint32_t)k))
        write_frame(&ours, &units, k, frames);
    fclose(frames);
    lammps_runs_clear_ours(&ours); // the same configurations once more
    lammps_runs_find_ours(&ours);
    write_input("evdwl ebond eangle edihed", ours.model.setup.box.dimensions == 2
                                                 ? "rerun frames.dump dump x y"
                                                 : "rerun frames.dump dump x y z");
    FILE *log = run_input(), *forces = fopen("lammps/forces.txt", "r");
    assert_non_null(forces);
    for (int k = 0; k < configurations; k++, lammps_runs_move(&ours, (uint32_t)k)) {
        double e[1 + BONDED_KINDS], energy = 0;
        read_row(log, e);
        for (int order = 0; order <= BONDED_KINDS; order++)
            energy += e[order] / units.energy;
        apart.energy = fmax(apart.energy,
                            fabs(energy - ours.simulation.sums.energy) / (double)ours.model.count);
        apart.force = fmax(apart.force, read_frame(&ours, export_units_force(&units), forces));
        apart.largest_force = fmax(apart.largest_force, largest_force(&ours.simulation.particles));
    }
    fclose(log);
    fclose(forces);
    lammps_runs_clear_ours(&ours);
    print_message(
        "%d configurations: energies of a bead %.2g apart, forces up to %.4g %.2g apart\n",
        configurations, apart.energy, apart.largest_force, apart.force);
    return apart;
}

// Runs -------------------------------------------------------------------------------------------

/// The number in a column of a line, from 0 on.
static double number_in(const char *line, int column) {
    char *rest = (char *)line;
    double value = 0;
    for (int k = 0; k <= column; k++)
        value = strtod(rest, &rest);
    return value;
}

double lammps_runs_rdf_difference(double unit) {
    return lammps_runs_rdf_difference_of("out/rdf.tsv", 0, unit);
}

double lammps_runs_rdf_difference_of(const char *table, int pair, double unit) {
    FILE *first = fopen(table, "r"), *second = fopen("lammps/rdf.dat", "r");
    char line[512], other[512];
    double squares = 0, shells = 0;
    int rows = 0;
    assert_true(first && second);
    for (int k = 0; k < 4; k++) // three comments and the step
        assert_non_null(fgets(other, sizeof other, second));
    while (fgets(line, sizeof line, first)) {
        double r, g;
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lf %lf", &r, &g), 2);
        assert_non_null(fgets(other, sizeof other, second));
        const double their_g = number_in(other, 2 + 2 * pair);
        assert_true(fabs(number_in(other, 1) - unit * r) < 1e-5); // the same bins
        squares += r * r * (g - their_g) * (g - their_g);         // as many pairs as r²
        shells += r * r;
        rows++;
    }
    fclose(first);
    fclose(second);
    assert_int_equal(rows, 100);
    return sqrt(squares / shells);
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
        if (line[0] != '#')
            values[rows++] = number_in(line, column);
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
