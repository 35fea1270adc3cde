// SPDX-License-Identifier: GPL-3.0-or-later
//
// pair_style local/density could read all densities from one file, but under hybrid LAMMPS (29 Sep
// 2021) has messages as long as they were before that file was read: of 16 densities of 8000 beads
// it wrote beyond their end and stopped. One density a style always fits.
#include "export/export_lammps_density.h"

#include "io/output.h"

bool mf_export_lammps_overlays(const struct export_job *job) {
    return job->densities.terms > 0;
}

static const char *name_of(const struct export_job *job, int term) {
    return mf_export_densities_of(job->model)->term[term].name;
}

/// A line of types, from 1 on.
static void print_set(const struct export_model *model, uint32_t set, FILE *stream) {
    for (int type = 0; type < model->types; type++)
        if (set >> type & 1)
            fprintf(stream, "%d ", type + 1);
    fprintf(stream, "\n");
}

/// The first two lines are comments, and LAMMPS looks into the first one for units.
static void print_density(const struct export_job *job, int term, FILE *stream) {
    const struct many_body_term *of = &mf_export_densities_of(job->model)->term[term];
    const struct export_grid *grid = &job->densities.table[term].grid;
    const struct export_units *units = &job->units;
    fprintf(stream, "# UNITS: %s\n# %s: f in %s, cutoffs in %s\n1 %zu\n\n",
            units->system == EXPORT_REAL ? "real" : "lj", of->name, units->energy_name,
            units->length_name, grid->rows);
    fprintf(stream, "%.15g %.15g\n", of->weight.inner * units->length,
            weight_cutoff(&of->weight) * units->length);
    print_set(job->model, of->central, stream);
    print_set(job->model, of->neighbours, stream);
    fprintf(stream, "%.15g %.15g %.15g\n", grid->first, grid->last,
            (grid->last - grid->first) / (double)(grid->rows - 1));
    for (size_t k = 0; k < grid->rows; k++)
        fprintf(stream, "%.15g\n", grid->phi[k] * units->energy);
    fprintf(stream, "\n");
}

enum status mf_export_lammps_write_densities(const struct export_job *job) {
    for (int t = 0; t < job->densities.terms; t++) {
        struct output output;
        char path[OUTPUT_PATH_SIZE];
        snprintf(path, sizeof path, "%.3800s/%s.density", job->folder, name_of(job, t));
        TRY(mf_output_open(&output, path));
        print_density(job, t, output.stream);
        TRY(mf_output_commit(&output));
    }
    return STATUS_OK;
}

void mf_export_lammps_density_styles(const struct export_job *job, FILE *stream) {
    for (int t = 0; t < job->densities.terms; t++)
        fprintf(stream, " local/density");
    fprintf(stream, "\"");
}

void mf_export_lammps_density_coefficients(const struct export_job *job, FILE *stream) {
    for (int t = 0; t < job->densities.terms; t++) {
        fprintf(stream, " &\n  \"pair_coeff * * local/density ");
        if (job->densities.terms > 1) // which of the styles of this name
            fprintf(stream, "%d ", t + 1);
        fprintf(stream, "%s.density\"", name_of(job, t));
    }
}
