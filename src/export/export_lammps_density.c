// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS's pair_style eam/fs, whose "elements" are the types: f of each, then w of a bead of this
// type at beads of each type; its potentials of pairs, which are others here, are 0.
#include "export/export_lammps_density.h"

bool mf_export_lammps_overlays(const struct export_job *job) {
    return job->densities.terms > 0;
}

static const char *name_of(const struct export_job *job, int term) {
    return mf_export_densities_of(job->model)->term[term].name;
}

/// Rows of a table, or as many zeros, of which LAMMPS reads any number a line.
static void print_rows(const struct export_grid *grid, double unit, FILE *stream) {
    enum { COLUMNS = 5 };
    for (size_t k = 0; k < grid->rows; k++)
        fprintf(stream, "%.15g%c", unit * grid->phi[k],
                (k + 1) % COLUMNS == 0 || k + 1 == grid->rows ? '\n' : ' ');
}

/// Three comments, of which LAMMPS looks into the first one for units; types, rows, cutoff.
static void print_head(const struct export_job *job, int term, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    const struct export_density *table = &job->densities.table[term];
    const double unit = mf_export_density_unit(model, term, units->length);
    fprintf(stream,
            "# UNITS: %s\n# %s: f [%s] of the density rho, and its weight w(r), r [%s]\n# T1, "
            "T2, ... are the types:",
            units->system == EXPORT_REAL ? "real" : "lj", name_of(job, term), units->energy_name,
            units->length_name);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, " %s", model->name[type]);
    fprintf(stream, "\n%d", model->types);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, " T%d", type + 1);
    fprintf(stream, "\n%zu %.15g %zu %.15g %.15g\n", table->energy.rows, unit * table->energy.r[1],
            table->weight.rows, units->length * table->weight.r[1],
            units->length * weight_cutoff(&mf_export_densities_of(model)->term[term].weight));
}

static void print_density(const struct export_job *job, int term, FILE *stream) {
    const struct export_model *model = job->model;
    const struct many_body_term *of = &mf_export_densities_of(model)->term[term];
    const struct export_density *table = &job->densities.table[term];
    const double unit = mf_export_density_unit(model, term, job->units.length);
    print_head(job, term, stream);
    for (int type = 0; type < model->types; type++) {
        const bool counts = of->neighbours >> type & 1;
        fprintf(stream, "0 %.12g 0 none\n", model->mass[type] * job->units.mass);
        print_rows(&table->energy, of->central >> type & 1 ? job->units.energy : 0, stream);
        for (int at = 0; at < model->types; at++)
            print_rows(&table->weight, counts && of->central >> at & 1 ? unit : 0, stream);
    }
    for (int pair = 0; pair < job->grids.pairs; pair++)
        print_rows(&table->weight, 0, stream);
}

enum status mf_export_lammps_write_densities(const struct export_job *job) {
    for (int t = 0; t < job->densities.terms; t++) {
        struct output output;
        char path[OUTPUT_PATH_SIZE];
        snprintf(path, sizeof path, "%.3800s/%s.eam.fs", job->folder, name_of(job, t));
        TRY(mf_output_open(&output, path));
        print_density(job, t, output.stream);
        TRY(mf_output_commit(&output));
    }
    return STATUS_OK;
}

void mf_export_lammps_density_styles(const struct export_job *job, FILE *stream) {
    for (int t = 0; t < job->densities.terms; t++)
        fprintf(stream, " eam/fs");
    fprintf(stream, "\"");
}

void mf_export_lammps_density_coefficients(const struct export_job *job, FILE *stream) {
    for (int t = 0; t < job->densities.terms; t++) {
        fprintf(stream, " &\n  \"pair_coeff * * eam/fs ");
        if (job->densities.terms > 1) // which of the styles of this name
            fprintf(stream, "%d ", t + 1);
        fprintf(stream, "%s.eam.fs", name_of(job, t));
        for (int type = 0; type < job->model->types; type++)
            fprintf(stream, " T%d", type + 1);
        fprintf(stream, "\"");
    }
}
