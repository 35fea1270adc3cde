// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS up to 2019: tables of energy groups in the group scheme, cubics between rows of value and
// −derivative. The potential stands in the column of the repulsion, whose C12 is 1 for all pairs.
#include "export/export_checks.h"
#include "topologies/gromacs_functions.h"

#include <math.h>

// Laws --------------------------------------------------------------------------------------------

static const struct gromacs_function *find_function(const struct bonded_curve *curve) {
    const struct gromacs_function *function = mf_gromacs_functions;
    while (function->law && function->law != curve->law)
        function++;
    return function->law ? function : NULL;
}

/// Whether GROMACS has a law as it is: all but tables and k (1 + cos θ).
static bool has_law(const struct bonded_curve *curve) {
    return find_function(curve) != NULL;
}

static void print_law(const struct export_job *job, int order, int group, FILE *stream) {
    const struct bonded_curve *curve = &job->model->molecules->group[order][group].curve;
    const struct gromacs_function *function = find_function(curve);
    if (function == NULL) { // its factor after the number of the table
        fprintf(stream, " 8 %d 1", job->bonded.table[order][group].number);
        return;
    }
    fprintf(stream, " %d", function->number);
    for (int n = 0; n < GROMACS_MAX_PARAMETERS && function->parameter[n]; n++)
        fprintf(stream, " %.10g",
                mf_bonded_number(curve, function->parameter[n]) *
                    gromacs_unit(function->unit[n], job->units.length, job->units.energy));
}

// Atoms -------------------------------------------------------------------------------------------

/// An atom in the order of the files.
struct atom {
    size_t id, number; ///< the number from 1 on
    size_t residue;    ///< from 1 on
    const char *name;  ///< of the residue
};

typedef void visit_atom(const struct export_job *job, FILE *stream, const struct atom *atom);
enum { ALL_TYPES = -1 };

/// Visit the atoms of a type, or of all.
static void visit(const struct export_job *job, FILE *stream, int type, visit_atom *visitor) {
    const struct export_model *model = job->model;
    const struct topology *topology = &model->molecules->topology;
    size_t number = 0, residue = 0;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++) {
            residue++;
            for (int bead = 0; bead < kind->beads; bead++) {
                number++;
                if (type == ALL_TYPES || kind->type[bead] == type)
                    visitor(
                        job, stream,
                        &(struct atom){topology_id(kind, m, bead), number, residue, kind->name});
            }
        }
    }
    for (size_t id = 0; id < model->count; id++) {
        const int own = mf_export_type(model, id);
        if (topology->molecule[id] < (uint64_t)topology->molecules)
            continue;
        number++;
        residue++;
        if (type == ALL_TYPES || own == type)
            visitor(job, stream, &(struct atom){id, number, residue, model->name[own]});
    }
}

static void print_atom(const struct export_job *job, FILE *stream, const struct atom *atom) {
    const struct export_model *model = job->model;
    const size_t id = atom->id;
    fprintf(stream, "%5zu%-5.5s%5.5s%5zu", atom->residue % 100000, atom->name,
            model->name[mf_export_type(model, id)], atom->number % 100000);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "%12.7f", mf_export_place(model, d, id) * job->units.length);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "%12.8f", model->velocity[d][id] * export_units_velocity(&job->units));
    fprintf(stream, "\n");
}

static void print_molecules_conf(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const double length = job->units.length;
    fprintf(stream, "%s\n%zu\n", model->title[0] ? model->title : "beads", model->count);
    visit(job, stream, ALL_TYPES, print_atom);
    fprintf(stream, "%.9g %.9g %.9g\n", model->setup.box.length[0] * length,
            model->setup.box.length[1] * length, model->setup.box.length[2] * length);
}

static void print_number(const struct export_job *job, FILE *stream, const struct atom *atom) {
    (void)job;
    fprintf(stream, "%zu\n", atom->number);
}

/// A group of each type, by which tables are chosen.
static void print_index(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    fprintf(stream, "[ System ]\n");
    visit(job, stream, ALL_TYPES, print_number);
    for (int type = 0; type < model->types; type++) {
        fprintf(stream, "[ %s ]\n", model->name[type]);
        visit(job, stream, type, print_number);
    }
}

// Topology ----------------------------------------------------------------------------------------

static void print_kind(const struct export_job *job, const struct topology_kind *kind,
                       FILE *stream) {
    const struct export_model *model = job->model;
    fprintf(stream, "\n[ moleculetype ]\n%s %d\n\n[ atoms ]\n", kind->name, kind->exclude);
    for (int bead = 0; bead < kind->beads; bead++) {
        const char *type = model->name[kind->type[bead]];
        fprintf(stream, "%d %s 1 %.5s %.5s %d 0.0 %.9g\n", bead + 1, type, kind->name, type,
                bead + 1, model->mass[kind->type[bead]] * job->units.mass);
    }
    for (int order = 0; order < BONDED_KINDS; order++) {
        if (kind->terms[order] > 0)
            fprintf(stream, "\n[ %s ]\n", mf_bonded_kinds[order]->plural);
        for (int n = 0; n < kind->terms[order]; n++) {
            const struct topology_term *term = &kind->term[order][n];
            for (int bead = 0; bead < mf_bonded_kinds[order]->beads; bead++)
                fprintf(stream, "%d ", term->bead[bead] + 1);
            print_law(job, order, term->group, stream);
            fprintf(stream, " ; %s\n", job->model->molecules->group[order][term->group].name);
        }
    }
}

/// Beads of a type that no molecule has.
static int64_t count_single(const struct export_model *model, int type) {
    const struct topology *topology = &model->molecules->topology;
    int64_t count = (int64_t)mf_export_count(model, type);
    for (int k = 0; k < topology->kinds; k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            count -= topology->kind[k].type[bead] == type ? topology->kind[k].count : 0;
    return count;
}

/// A single bead is a molecule whose name no kind can have.
static void print_single(const struct export_job *job, int type, FILE *stream) {
    const char *name = job->model->name[type];
    fprintf(stream, "\n[ moleculetype ]\nsingle.%s 0\n\n[ atoms ]\n1 %s 1 %.5s %.5s 1 0.0 %.9g\n",
            name, name, name, name, job->model->mass[type] * job->units.mass);
}

static void print_molecules_topology(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const struct topology *topology = &model->molecules->topology;
    fprintf(stream, "[ defaults ]\n1 1 no 1.0 1.0\n\n[ atomtypes ]\n");
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%s %.9g 0.0 A 0.0 1.0\n", model->name[type],
                model->mass[type] * job->units.mass);
    for (int k = 0; k < topology->kinds; k++)
        print_kind(job, &topology->kind[k], stream);
    for (int type = 0; type < model->types; type++)
        if (count_single(model, type) > 0)
            print_single(job, type, stream);
    fprintf(stream, "\n[ system ]\nmolecules\n\n[ molecules ]\n");
    for (int k = 0; k < topology->kinds; k++)
        fprintf(stream, "%s %lld\n", topology->kind[k].name, (long long)topology->kind[k].count);
    for (int type = 0; type < model->types; type++)
        if (count_single(model, type) > 0)
            fprintf(stream, "single.%s %lld\n", model->name[type],
                    (long long)count_single(model, type));
}

// Tables ------------------------------------------------------------------------------------------

static enum status write_bonded_table(const struct export_job *job, int order,
                                      const struct export_bonded_table *table) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double unit = kind->is_length ? job->units.length : 1 / kind->scale;
    struct output output;
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.3800s/table_%c%d.xvg", job->folder, kind->name[0],
             table->number);
    TRY(mf_output_open(&output, path));
    fprintf(output.stream, "# %s, energy [kJ/mol], -derivative\n",
            kind->is_length ? "r [nm]" : "angle [degrees]");
    for (size_t k = 0; k < job->bonded.rows; k++)
        fprintf(output.stream, "%.12e %.12e %.12e\n", table->q[k] * unit,
                table->energy[k] * job->units.energy, -table->slope[k] * job->units.energy / unit);
    return mf_output_commit(&output);
}

/// Write conf.gro, topol.top, index.ndx with a group for each type, and the tables of laws.
static enum status write_molecules(const struct export_job *job) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < job->model->molecules->groups[order]; g++)
            if (job->bonded.table[order][g].q)
                TRY(write_bonded_table(job, order, &job->bonded.table[order][g]));
    TRY(mf_export_file(job, "conf.gro", print_molecules_conf));
    TRY(mf_export_file(job, "index.ndx", print_index));
    return mf_export_file(job, "topol.top", print_molecules_topology);
}

// The folder --------------------------------------------------------------------------------------

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

/// The same at constant pressure: the mean density is right, its fluctuations are too small.
static void print_pressure(const struct export_job *job, FILE *stream) {
    static const double steps = 1000, water = 4.5e-5; // 1/bar, where the result does not say
    const double kappa = mf_export_checks_compressibility(job);
    print_settings(job, stream);
    fprintf(stream,
            "pcoupl = Berendsen\nref-p = %g ; bar: the pressure that is held\ncompressibility = "
            "%.3g ; 1/bar\ntau-p = %.6g\n",
            mf_export_checks_usual_pressure(job), kappa > 0 ? kappa : water,
            steps * job->time_step * job->units.time);
}

static enum status write(const struct export_job *job) {
    TRY(write_tables(job));
    if (job->model->molecules) {
        TRY(write_molecules(job));
    } else {
        TRY(mf_export_file(job, "conf.gro", print_conf));
        TRY(mf_export_file(job, "topol.top", print_topology));
    }
    TRY(mf_export_file(job, "grompp.mdp", print_settings));
    return mf_export_file(job, "pressure.mdp", print_pressure);
}

/// A table of a bond, angle or dihedral is called by a letter and a number.
static const char *commands_of(const struct export_job *job) {
    if (job->model->molecules == NULL)
        return "    gmx grompp\n    gmx mdrun\n";
    return job->bonded.tables
               ? "    gmx grompp -n index.ndx\n    gmx mdrun -tableb table_[abd][0-9]*.xvg\n"
               : "    gmx grompp -n index.ndx\n    gmx mdrun\n";
}

static void explain(const struct export_job *job, FILE *stream) {
    fprintf(stream, "GROMACS has no DPD%s: its integrator sd is a bath of each particle.\n%s\n",
            export_model_has_friction(job->model) ? " and so no omega" : "",
            mf_export_dynamics_kept(job));
    fprintf(stream, "\n");
    mf_export_checks_rdf(job, "traj_comp.xtc -s conf.gro", stream);
    mf_export_checks_pressure(
        job,
        job->model->molecules
            ? "    gmx grompp -f pressure.mdp -n index.ndx   # ref-p in it is the pressure; then "
              "mdrun as above\n"
            : "    gmx grompp -f pressure.mdp   # ref-p in it is the pressure; then mdrun as "
              "above\n",
        stream);
}

const struct export_engine mf_export_gromacs = {
    .name = "gromacs",
    .title = "GROMACS",
    .summary = "grompp.mdp, pressure.mdp, conf.gro, topol.top, table_A_B.xvg, for versions up to "
               "2019; nm, ps, kJ/mol",
    .system = EXPORT_NANOMETRES,
    .physical = true,
    .interpolation = &mf_export_grid_hermite,
    .bath = "integrator sd",
    .commands_of = commands_of,
    .versions =
        "GROMACS up to 2019 runs this; 2020 and later refuse it, as their tables of pairs went "
        "with the group scheme.",
    .verified =
        "Such folders were checked against the manual of GROMACS, and not run; of molecules, "
        "bonds, angles and dihedrals alone were, with GROMACS 2022.",
    .max_types = COMPOSITION_MAX_TYPES,
    .one_cutoff = true,
    .pair_name = name_pair,
    .molecules = true,
    .has_law = has_law,
    .tables = write_tables,
    .write = write,
    .explain = explain,
};
