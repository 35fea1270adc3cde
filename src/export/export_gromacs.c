// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS up to 2019: tables of energy groups in the group scheme, cubics between rows of value and
// −derivative. The potential stands in the column of the repulsion, whose C12 is 1 for all pairs.
#include "export/export_gromacs_molecules.h"

enum { EXTENSION_NM = 1 }; ///< that GROMACS wants after the cutoff

/// What one table is of.
static enum status write_table(const struct export_job *job, const struct export_grid *grid,
                               const char *name) {
    const struct export_units *units = &job->units;
    const double spacing = grid->r[1] * units->length;
    const size_t extra = (size_t)(EXTENSION_NM / spacing) + 2;
    struct output output;
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.3800s/%.200s", job->folder, name);
    TRY(mf_output_open(&output, path));
    fprintf(output.stream, "# r, f, -f', g, -g', h = energy, -h' [nm, kJ/mol]\n");
    for (size_t k = 0; k < grid->rows + extra; k++) {
        const bool within = k < grid->rows;
        fprintf(output.stream, "%.12e 0 0 0 0 %.12e %.12e\n", spacing * (double)k,
                within ? grid->phi[k] * units->energy : 0,
                within ? grid->force[k] * export_units_force(units) : 0);
    }
    return mf_output_commit(&output);
}

static void name_pair(const char *a, const char *b, char name[EXPORT_PAIR_NAME_SIZE]) {
    snprintf(name, EXPORT_PAIR_NAME_SIZE, "%s_%s", a, b);
}

static enum status write_tables(const struct export_job *job) {
    TRY(write_table(job, &job->grids.grid[0][0], "table.xvg"));
    for (int n = 0; n < job->grids.curves * job->grids.pairs; n++) {
        const int curve = n / job->grids.pairs, pair = n % job->grids.pairs;
        char name[2 * EXPORT_PAIR_NAME_SIZE], of[COMPOSITION_PAIR_NAME_SIZE];
        char called[EXPORT_PAIR_NAME_SIZE];
        int type[2];
        mf_export_model_pair(job->model, pair, type, of);
        name_pair(job->model->name[type[0]], job->model->name[type[1]], called);
        snprintf(name, sizeof name, "table_%s%s.xvg", called,
                 mf_export_curve_name((enum export_curve)curve));
        TRY(write_table(job, &job->grids.grid[curve][pair], name));
    }
    return STATUS_OK;
}

static void print_conf(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const double length = job->units.length, velocity = export_units_velocity(&job->units);
    fprintf(stream, "%s\n%zu\n", model->title[0] ? model->title : "beads", model->count);
    for (size_t k = 0; k < model->count; k++) {
        const char *name = model->name[mf_export_type(model, k)];
        fprintf(stream, "%5zu%-5.5s%5.5s%5zu", (k + 1) % 100000, name, name, (k + 1) % 100000);
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%12.7f", mf_export_place(model, d, k) * length);
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%12.8f", model->velocity[d][k] * velocity);
        fprintf(stream, "\n");
    }
    fprintf(stream, "%.9g %.9g %.9g\n", model->setup.box.length[0] * length,
            model->setup.box.length[1] * length, model->setup.box.length[2] * length);
}

static void print_topology(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    fprintf(stream, "[ defaults ]\n1 1 no 1.0 1.0\n\n[ atomtypes ]\n");
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%s %.9g 0.0 A 0.0 1.0\n", model->name[type],
                model->mass[type] * job->units.mass);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "\n[ moleculetype ]\n%s 0\n\n[ atoms ]\n1 %s 1 %s %.5s 1 0.0 %.9g\n",
                model->name[type], model->name[type], model->name[type], model->name[type],
                model->mass[type] * job->units.mass);
    fprintf(stream, "\n[ system ]\nbeads\n\n[ molecules ]\n");
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%s %zu\n", model->name[type], mf_export_count(model, type));
}

static void print_settings(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const double cutoff = model->setup.potential->cutoff * job->units.length;
    mf_export_dynamics_print(job, "; ", stream);
    fprintf(stream,
            "integrator = sd\ndt = %.9g\nnsteps = 10000\nnstxout-compressed = 100\nnstenergy = "
            "20\ncutoff-scheme = group\nnstlist = 5\nrlist = %.9g\ncoulombtype = Cut-off\nrcoulomb "
            "= %.9g\nvdwtype = User\nrvdw = %.9g\ntc-grps = System\ntau-t = %.6g\nref-t = "
            "%.9g\ngen-vel = no\ncomm-mode = Linear\nenergygrps =",
            job->time_step * job->units.time, cutoff, cutoff, cutoff,
            mf_export_slowing(job) * job->units.time,
            model->setup.temperature * job->units.temperature);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, " %s", model->name[type]);
    fprintf(stream, "\nenergygrp-table =");
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        int type[2];
        mf_export_model_pair(model, pair, type, name);
        fprintf(stream, " %s %s", model->name[type[0]], model->name[type[1]]);
    }
    fprintf(stream, "\n");
}

static enum status write(const struct export_job *job) {
    TRY(write_tables(job));
    if (job->model->molecules) {
        TRY(mf_export_gromacs_molecules(job));
    } else {
        TRY(mf_export_file(job, "conf.gro", print_conf));
        TRY(mf_export_file(job, "topol.top", print_topology));
    }
    return mf_export_file(job, "grompp.mdp", print_settings);
}

static void explain(const struct export_job *job, FILE *stream) {
    fprintf(stream,
            "GROMACS reads tables up to version 2019. It has no DPD%s: its integrator sd, "
            "a bath of each particle,\nkeeps g(r), energy and pressure; the dynamics is "
            "not the result's: diffusion and all else that moves differs.\n",
            job->model->setup.omega ? " and so no omega" : "");
    if (job->model->molecules)
        fprintf(stream, "With molecules: gmx grompp -n index.ndx%s.\n",
                job->bonded.tables ? ", and gmx mdrun -tableb with all of table_b*.xvg, "
                                     "table_a*.xvg and\ntable_d*.xvg"
                                   : "");
}

const struct export_engine mf_export_gromacs = {
    .name = "gromacs",
    .title = "GROMACS",
    .summary = "grompp.mdp, conf.gro, topol.top, table_A_B.xvg, for versions up to 2019; nm, ps, "
               "kJ/mol",
    .system = EXPORT_NANOMETRES,
    .physical = true,
    .interpolation = &mf_export_grid_hermite,
    .bath = "integrator sd",
    .commands = "    gmx grompp\n    gmx mdrun\n",
    .verified = "Such folders were checked against the manual of GROMACS, and not run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .one_cutoff = true,
    .pair_name = name_pair,
    .molecules = true,
    .has_law = mf_export_gromacs_has_law,
    .write = write,
    .explain = explain,
};
