// SPDX-License-Identifier: GPL-3.0-or-later
//
// DL_POLY: TABLE has energies and −r dΦ/dr, four numbers a line, at multiples of
// cutoff/(rows − 4), so that it takes them over as they are. Of a name it reads eight letters.
#include "export/export_engine.h"

static void print_four(FILE *stream, size_t k, size_t rows, double value) {
    fprintf(stream, " %.12e%s", value, k % 4 == 3 || k + 1 == rows ? "\n" : "");
}

static void name_pair(const char *a, const char *b, char name[EXPORT_PAIR_NAME_SIZE]) {
    snprintf(name, EXPORT_PAIR_NAME_SIZE, "%-8.8s %-8.8s", a, b);
}

static void print_pair(const struct export_job *job, int pair, FILE *stream) {
    char name[COMPOSITION_PAIR_NAME_SIZE], called[EXPORT_PAIR_NAME_SIZE];
    int type[2];
    mf_export_model_pair(job->model, pair, type, name);
    name_pair(job->model->name[type[0]], job->model->name[type[1]], called);
    fprintf(stream, "%s", called);
}

static void print_curve(const struct export_job *job, enum export_curve curve, FILE *stream) {
    const struct export_grid *first = &job->grids.grid[curve][0];
    const double spacing = first->r[0] * job->units.length;
    fprintf(stream, "%s\n%.15e %.15e %zu\n", "tables by mesofit", spacing,
            spacing * (double)first->rows, first->rows);
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        const struct export_grid *grid = &job->grids.grid[curve][pair];
        print_pair(job, pair, stream);
        fprintf(stream, " 0.0 0.0\n");
        for (size_t k = 0; k < grid->rows; k++)
            print_four(stream, k, grid->rows, grid->phi[k] * job->units.energy);
        for (size_t k = 0; k < grid->rows; k++)
            print_four(stream, k, grid->rows, grid->r[k] * grid->force[k] * job->units.energy);
    }
}

static void print_table(const struct export_job *job, FILE *stream) {
    print_curve(job, EXPORT_FITTED, stream);
}

static void print_lower(const struct export_job *job, FILE *stream) {
    print_curve(job, EXPORT_LOWER, stream);
}

static void print_upper(const struct export_job *job, FILE *stream) {
    print_curve(job, EXPORT_UPPER, stream);
}

static void print_field(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    fprintf(stream, "%s\nunits kJ\nmolecules %d\n", model->title[0] ? model->title : "beads",
            model->types);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%s\nnummols %zu\natoms 1\n%-8.8s %.9g 0.0\nfinish\n", model->name[type],
                mf_export_count(model, type), model->name[type],
                model->mass[type] * job->units.mass);
    fprintf(stream, "vdw %d\n", job->grids.pairs);
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        print_pair(job, pair, stream);
        fprintf(stream, " tab\n");
    }
    fprintf(stream, "close\n");
}

/// The box is around the origin.
static void print_config(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const double length = job->units.length, velocity = export_units_velocity(&job->units);
    const double *box = model->setup.box.length;
    fprintf(stream, "%.70s\n%10d%10d%10zu\n", model->title[0] ? model->title : "beads", 1, 2,
            model->count);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "%20.10f%20.10f%20.10f\n", d == 0 ? box[0] * length : 0,
                d == 1 ? box[1] * length : 0, d == 2 ? box[2] * length : 0);
    for (size_t k = 0; k < model->count; k++) {
        fprintf(stream, "%-8.8s%10zu\n", model->name[mf_export_type(model, k)], k + 1);
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%20.10f", (mf_export_place(model, d, k) - 0.5 * box[d]) * length);
        fprintf(stream, "\n");
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%20.10f", model->velocity[d][k] * velocity);
        fprintf(stream, "\n");
    }
}

static void print_control(const struct export_job *job, FILE *stream) {
    const double cutoff = job->model->setup.potential->cutoff * job->units.length;
    fprintf(stream,
            "%.70s\ntemperature %.9g\nensemble nvt langevin %.6g\ntimestep %.9g\nsteps "
            "10000\nequilibration 1000\ncutoff %.12g\nrvdw %.12g\nno electrostatics\nrdf 20\nprint "
            "rdf\nprint 1000\nstats 20\njob time 1000000\nclose time 100\nfinish\n",
            job->model->title[0] ? job->model->title : "beads",
            job->model->setup.temperature * job->units.temperature,
            1 / (mf_export_slowing(job) * job->units.time), job->time_step * job->units.time,
            cutoff, cutoff);
}

static enum status write_tables(const struct export_job *job) {
    TRY(mf_export_file(job, "TABLE", print_table));
    if (job->grids.curves == 1)
        return STATUS_OK;
    TRY(mf_export_file(job, "TABLE_lower", print_lower));
    return mf_export_file(job, "TABLE_upper", print_upper);
}

static enum status write(const struct export_job *job) {
    TRY(write_tables(job));
    TRY(mf_export_file(job, "FIELD", print_field));
    TRY(mf_export_file(job, "CONFIG", print_config));
    return mf_export_file(job, "CONTROL", print_control);
}

static void explain(const struct export_job *job, FILE *stream) {
    fprintf(stream, "A Langevin bath of each particle holds the temperature%s. %s\n",
            export_model_has_friction(job->model) ? ", and not this omega" : "",
            mf_export_dynamics_kept(job));
}

const struct export_engine mf_export_dl_poly = {
    .name = "dl_poly",
    .title = "DL_POLY",
    .summary = "CONTROL, CONFIG, FIELD, TABLE, for version 4; A, ps, kJ/mol",
    .system = EXPORT_DL_POLY,
    .physical = true,
    .interpolation = &mf_export_grid_quadratic,
    .bath = "ensemble nvt langevin",
    .commands = "    DLPOLY.Z\n    mpirun -np 4 DLPOLY.Z\n",
    .verified = "The tables of such folders were checked against the source of the engine; nothing "
                "was run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .one_cutoff = true,
    .pair_name = name_pair,
    .tables = write_tables,
    .write = write,
    .explain = explain,
};
