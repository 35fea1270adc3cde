// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS: pair_style table linear reads the rows as they are if its N is that of the file and the
// rows are RSQ. Friction by dpd/tstat and dpd/ext/tstat, or by mesofit/table (share/lammps).
#include "export/export_checks.h"
#include "export/export_lammps_molecules.h"
#include "export/export_lammps_place.h"
#include "report/program.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Skin of the neighbour list [λ]: a tenth of the cutoff, and so much that the fastest particle, of
/// eight times the thermal velocity, crosses half of it in no step.
static double choose_skin(const struct export_job *job) {
    const struct export_model *model = job->model;
    double lightest = model->mass[0];
    for (int type = 1; type < model->types; type++)
        lightest = fmin(lightest, model->mass[type]);
    return fmax(0.1 * mf_export_model_cutoff(model),
                16 * job->time_step * sqrt(model->setup.temperature / lightest));
}

static bool dpd_runs(const struct export_job *job) {
    return job->runs == EXPORT_OWN_FRICTION || job->runs == EXPORT_PROJECTED;
}

static bool is_real(const struct export_job *job) {
    return job->units.system == EXPORT_REAL;
}

static void print_head(const struct export_job *job, FILE *stream) {
    static const char axes[] = "xyz";
    const struct export_model *model = job->model;
    const struct box *box = &model->setup.box;
    const struct export_units *units = &job->units;
    fprintf(stream, "%s (mesofit)\n\n%zu atoms\n%d atom types\n",
            model->title[0] ? model->title : "beads", model->count, model->types);
    if (model->molecules)
        mf_export_lammps_counts(job, stream);
    fprintf(stream, "\n");
    for (int d = 0; d < 3; d++)
        fprintf(stream, "%.15g %.15g %clo %chi\n", d < box->dimensions ? 0 : -0.5 * units->length,
                (d < box->dimensions ? box->length[d] : 0.5) * units->length, axes[d], axes[d]);
    fprintf(stream, "\nMasses\n\n");
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%d %.12g # %s\n", type + 1, model->mass[type] * units->mass,
                model->name[type]);
}

void mf_export_lammps_print_data(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    print_head(job, stream);
    fprintf(stream, "\nAtoms # %s\n\n", model->molecules ? "molecular" : "atomic");
    for (size_t k = 0; k < model->count; k++) {
        double x[3] = {0};
        for (int d = 0; d < model->setup.box.dimensions; d++)
            x[d] = mf_export_place(model, d, k) * units->length;
        fprintf(stream, "%zu ", k + 1);
        if (model->molecules)
            fprintf(stream, "%zu ", mf_export_lammps_molecule(model, k));
        fprintf(stream, "%d %.12g %.12g %.12g", mf_export_type(model, k) + 1, x[0], x[1], x[2]);
        if (model->molecules)
            fprintf(stream, " %d %d %d", model->image[0][k], model->image[1][k],
                    model->image[2][k]);
        fprintf(stream, "\n");
    }
    fprintf(stream, "\nVelocities\n\n");
    for (size_t k = 0; k < model->count; k++)
        fprintf(stream, "%zu %.12g %.12g %.12g\n", k + 1,
                model->velocity[0][k] * export_units_velocity(units),
                model->velocity[1][k] * export_units_velocity(units),
                model->velocity[2][k] * export_units_velocity(units));
    if (model->molecules)
        mf_export_lammps_terms(job, stream);
}

static void print_potential(const struct export_job *job, enum export_curve curve, int pair,
                            FILE *stream) {
    const struct export_grid *grid = &job->grids.grid[curve][pair];
    const struct export_units *units = &job->units;
    char name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    mf_export_model_pair(job->model, pair, type, name);
    fprintf(stream, "\nPHI_%s%s\nN %zu RSQ %.15g %.15g\n\n", name, mf_export_curve_name(curve),
            grid->rows, grid->first * units->length, grid->last * units->length);
    for (size_t k = 0; k < grid->rows; k++)
        fprintf(stream, "%zu %.15g %.15g %.15g\n", k + 1, grid->r[k] * units->length,
                grid->phi[k] * units->energy, grid->force[k] * export_units_force(units));
}

/// Whether the pair style of our own has all of the friction: it has none across pairs.
static bool is_exact(const struct export_job *job) {
    return job->model->setup.omega && export_model_across(job->model) == NULL;
}

/// ω is made of straight pieces, whose ends are the rows.
static void print_omega(const struct export_job *job, int pair, FILE *stream) {
    const struct table *omega = job->model->setup.omega;
    const double unit = sqrt(export_units_friction(&job->units));
    const double cutoff = table_cutoff(omega, pair);
    char name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    if (!(cutoff > 0))
        return;
    mf_export_model_pair(job->model, pair, type, name);
    fprintf(stream, "\nOMEGA_%s\nN %d R 0 %.15g\n\n", name, TABLE_INTERVALS + 1,
            cutoff * job->units.length);
    for (int k = 0; k <= TABLE_INTERVALS; k++) {
        const double r = cutoff * k / TABLE_INTERVALS;
        const ptrdiff_t row = (ptrdiff_t)pair * table_stride(omega) + k;
        fprintf(stream, "%d %.15g %.15g\n", k + 1, r * job->units.length,
                unit * omega->coefficient[2 * row]);
    }
}

void mf_export_lammps_print_table(const struct export_job *job, FILE *stream) {
    fprintf(stream, "# UNITS: %s\n# r[%s] energy[%s] force[%s/%s]; omega[sqrt(%s %s)/%s]\n",
            is_real(job) ? "real" : "lj", job->units.length_name, job->units.energy_name,
            job->units.energy_name, job->units.length_name, job->units.energy_name,
            job->units.time_name, job->units.length_name);
    for (int curve = 0; curve < job->grids.curves; curve++)
        for (int pair = 0; pair < job->grids.pairs; pair++)
            print_potential(job, (enum export_curve)curve, pair, stream);
    for (int pair = 0; is_exact(job) && pair < job->grids.pairs; pair++)
        print_omega(job, pair, stream);
    if (job->model->molecules)
        mf_export_lammps_tables(job, stream);
}

static void print_names(const struct export_job *job, int pair, FILE *stream) {
    char name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    mf_export_model_pair(job->model, pair, type, name);
    fprintf(stream, "mesofit.table PHI_%s${band}", name);
}

static void print_types(const struct export_job *job, int pair, FILE *stream) {
    char name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    mf_export_model_pair(job->model, pair, type, name);
    fprintf(stream, "%d %d", type[0] + 1, type[1] + 1);
}

/// Friction of a power law beside the table; gamma and then exponents, of each that along pairs
/// first.
static void print_coefficients(const struct export_job *job, int pair, const char *style,
                               FILE *stream) {
    const struct export_power *power = &job->power[pair], *across = &job->across[pair];
    const double unit = export_units_friction(&job->units);
    const double cutoff = fmax(power->cutoff, across->cutoff);
    if (!(cutoff > 0))
        return;
    fprintf(stream, " &\n  \"pair_coeff ");
    print_types(job, pair, stream);
    fprintf(stream, " %s %.12g", style, power->amplitude * power->amplitude * unit);
    if (strcmp(style, "dpd/ext/tstat") == 0)
        fprintf(stream, " %.12g %.12g %.12g", across->amplitude * across->amplitude * unit,
                power->cutoff > 0 ? power->exponent : 1, across->cutoff > 0 ? across->exponent : 1);
    fprintf(stream, " %.12g\"", cutoff * job->units.length);
}

static double friction_range(const struct export_job *job) {
    double range = 0;
    for (int pair = 0; pair < job->grids.pairs; pair++)
        range = fmax(range, fmax(job->power[pair].cutoff, job->across[pair].cutoff));
    return range;
}

static void print_power(const struct export_job *job, FILE *stream) {
    const char *style = mf_export_dynamics_friction(job);
    const double temperature = job->model->setup.temperature * job->units.temperature;
    fprintf(stream,
            " &\nelif \"${friction} == dpd\" &\n  \"pair_style hybrid/overlay table linear %zu "
            "%s %.12g %.12g %.12g ${seed}",
            job->grids.grid[0][0].rows, style, temperature, temperature,
            friction_range(job) * job->units.length);
    mf_export_lammps_density_styles(job, stream);
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        fprintf(stream, " &\n  \"pair_coeff ");
        print_types(job, pair, stream);
        fprintf(stream, " table ");
        print_names(job, pair, stream);
        fprintf(stream, "\"");
        print_coefficients(job, pair, style, stream);
    }
    mf_export_lammps_density_coefficients(job, stream);
}

/// Potential and friction weight as they are, by the pair style of our own.
static void print_exact(const struct export_job *job, FILE *stream) {
    fprintf(stream,
            " &\nelif \"${friction} == exact\" &\n  \"pair_style %smesofit/table %.12g ${seed}",
            mf_export_lammps_overlays(job) ? "hybrid/overlay " : "",
            job->model->setup.temperature * job->units.temperature);
    mf_export_lammps_density_styles(job, stream);
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        int type[2];
        mf_export_model_pair(job->model, pair, type, name);
        fprintf(stream, " &\n  \"pair_coeff ");
        print_types(job, pair, stream);
        fprintf(stream, mf_export_lammps_overlays(job) ? " mesofit/table " : " ");
        print_names(job, pair, stream);
        if (table_cutoff(job->model->setup.omega, pair) > 0)
            fprintf(stream, " OMEGA_%s", name);
        fprintf(stream, "\"");
    }
    mf_export_lammps_density_coefficients(job, stream);
}

/// A bath for each particle, which keeps g(r) and not the motion.
static void print_langevin(const struct export_job *job, FILE *stream) {
    const double temperature = job->model->setup.temperature * job->units.temperature;
    fprintf(stream, "if \"${friction} == langevin\" then &\n  \"pair_style %stable linear %zu",
            mf_export_lammps_overlays(job) ? "hybrid/overlay " : "", job->grids.grid[0][0].rows);
    mf_export_lammps_density_styles(job, stream);
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        fprintf(stream, " &\n  \"pair_coeff ");
        print_types(job, pair, stream);
        fprintf(stream, mf_export_lammps_overlays(job) ? " table " : " ");
        print_names(job, pair, stream);
        fprintf(stream, "\"");
    }
    mf_export_lammps_density_coefficients(job, stream);
    fprintf(stream, " &\n  \"fix bath all langevin %.12g %.12g %.6g ${seed} zero yes\"",
            temperature, temperature, mf_export_slowing(job) * job->units.time);
}

static void print_thermostat(const struct export_job *job, FILE *stream) {
    print_langevin(job, stream);
    if (mf_export_is_power(job))
        print_power(job, stream);
    if (is_exact(job))
        print_exact(job, stream);
    fprintf(stream, " &\nelse \"print 'no such friction here: ${friction}'\" \"quit 1\"\n");
}

/// g(r) on the bins of the result, of all pair types. LAMMPS refuses a range that is longer than
/// its list by a rounding.
static void print_measurements(const struct export_job *job, FILE *stream) {
    static const double rounding = 1 - 1e-9;
    const struct export_model *model = job->model;
    fprintf(stream, "compute rdf all rdf %zu", model->rdf_bins);
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        fprintf(stream, " ");
        print_types(job, pair, stream);
    }
    fprintf(stream, " cutoff %.12g\n", model->rdf_range * job->units.length * rounding);
    fprintf(stream, "variable samples equal floor(v_steps/v_every)\n"
                    "fix rdf all ave/time ${every} ${samples} $(v_samples*v_every) c_rdf[*] file "
                    "rdf.dat mode vector\n"
                    "fix means all ave/time ${every} 1 ${every} c_thermo_temp c_thermo_press "
                    "c_thermo_pe v_density file thermo.dat\n"
                    "if \"${dump} > 0\" then &\n  \"dump beads all custom ${dump} dump.lammpstrj "
                    "id type x y z vx vy vz\"\n");
}

/// What there is, up to its bonds. Ghosts reach as far as lists, g(r) and terms do.
void mf_export_lammps_print_system(const struct export_job *job, FILE *stream) {
    const struct export_model *model = job->model;
    const double skin = choose_skin(job);
    const double reach =
        fmax(fmax(mf_export_model_cutoff(model), model->rdf_range), mf_export_lammps_reach(model));
    fprintf(stream,
            "units %s\ndimension %d\nboundary p p p\natom_style %s\nneighbor %.6g bin\n"
            "neigh_modify every 1 delay 0 check yes\ncomm_modify vel yes cutoff %.9g\n",
            is_real(job) ? "real" : "lj", model->setup.box.dimensions,
            model->molecules ? "molecular" : "atomic", skin * job->units.length,
            (reach + skin) * job->units.length * (1 + 1e-6));
    if (model->molecules)
        mf_export_lammps_styles(job, stream);
    fprintf(stream, "read_data data.mesofit\n");
    if (model->molecules)
        mf_export_lammps_coefficients(job, stream);
    fprintf(stream, "\n");
}

static void print_input(const struct export_job *job, FILE *stream) {
    static const double steps_of_barostat = 1000;
    const struct export_model *model = job->model;
    const double step = job->time_step * job->units.time;
    fprintf(stream,
            "# %s: written by mesofit; see README. Variables: lmp -in in.mesofit -var steps "
            "100000\n\nvariable steps index 10000      # that are measured\nvariable equilibration "
            "index %d\nvariable every index 20         # steps between samples\nvariable dump "
            "index 0           # steps between frames of dump.lammpstrj; 0: none\nvariable "
            "friction index %s # or another one named in README\n# variable pressure: none of its "
            "own; -var pressure P holds P\nvariable band index \"\"          "
            "# _lower or _upper: exported with --bands\nvariable seed index 12345\n\n",
            model->title[0] ? model->title : "beads", model->equilibrated ? 1000 : 5000,
            dpd_runs(job) ? "dpd" : "langevin");
    mf_export_dynamics_print(job, "# ", stream);
    fprintf(stream, "\n");
    mf_export_lammps_print_place(job->folder, stream);
    mf_export_lammps_print_system(job, stream);
    print_thermostat(job, stream);
    mf_export_lammps_print_return(job->folder, stream);
    fprintf(stream,
            "\nif \"$(is_defined(variable,pressure)) == 1\" then &\n  \"fix move all nph iso "
            "${pressure} ${pressure} %.9g\" &\nelse \"fix move all nve\"\n%stimestep %.9g\n"
            "variable density equal atoms/vol\nthermo 1000\n"
            "thermo_style custom step temp press pe v_density%s\nthermo_modify norm yes\n"
            "run ${equilibration}\nreset_timestep 0\n\n",
            steps_of_barostat * step,
            model->setup.box.dimensions == 2 ? "fix flat all enforce2d\n" : "", step,
            model->molecules ? " evdwl ebond eangle edihed" : "");
    print_measurements(job, stream);
    fprintf(stream, "run ${steps}\n");
}

static enum status write_table(const struct export_job *job) {
    return mf_export_file(job, "mesofit.table", mf_export_lammps_print_table);
}

static enum status write(const struct export_job *job) {
    TRY(write_table(job));
    TRY(mf_export_file(job, "data.mesofit", mf_export_lammps_print_data));
    TRY(mf_export_lammps_write_densities(job));
    return mf_export_file(job, "in.mesofit", print_input);
}

/// `lmp -h` lists its styles, each with spaces about it.
static bool lists_style(const char *text, const char *style) {
    const size_t length = strlen(style);
    for (const char *at = strstr(text, style); at; at = strstr(at + 1, style))
        if (at > text && isspace((unsigned char)at[-1]) &&
            (at[length] == '\0' || isspace((unsigned char)at[length])))
            return true;
    return false;
}

static enum export_here ask(const struct export_job *job) {
    enum { SIZE = 1 << 18, SECONDS = 20 };
    static const char *const words[] = {"lmp", "-h", NULL};
    enum export_here here = EXPORT_NO_PROGRAM;
    char *text = malloc(SIZE);
    if (text && mf_program_run(".", words, PROGRAM_EVERYTHING, SECONDS, text, SIZE) == STATUS_OK)
        here = lists_style(text, mf_export_dynamics_friction(job)) ? EXPORT_HERE : EXPORT_NOT_HERE;
    free(text);
    return here;
}

/// How the friction can be had, and whether this machine's LAMMPS has it.
static void advise(const struct export_job *job, const char *prefix, FILE *stream) {
    static const char *const here[] = {
        [EXPORT_HERE] = "the lmp of this machine has it",
        [EXPORT_NOT_HERE] = "the lmp of this machine lacks it, as Debian's does",
        [EXPORT_NO_PROGRAM] = "no lmp was found here; Debian's lacks it"};
    if (mf_export_is_power(job))
        fprintf(stream,
                "%spackage    -var friction dpd runs that of the result, misfit %.2g: %s, of "
                "LAMMPS's package DPD-BASIC; %s\n",
                prefix, job->worst_misfit, mf_export_dynamics_friction(job), here[job->here]);
    if (job->runs != EXPORT_OWN_FRICTION && is_exact(job))
        fprintf(stream,
                "%sexact      -var friction exact runs omega as it is, by mesofit's share/lammps\n",
                prefix);
}

/// The columns of rdf.dat, in their order.
static void explain_columns(const struct export_job *job, FILE *stream) {
    char name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    fprintf(stream, "in.mesofit leaves LAMMPS's own g(r) in rdf.dat, on the bins of the result: "
                    "row, r, g and coordination number");
    for (int pair = 0; job->grids.pairs > 1 && pair < job->grids.pairs; pair++) {
        mf_export_model_pair(job->model, pair, type, name);
        fprintf(stream, "%s %s", pair ? "," : " of", name);
    }
    fprintf(stream,
            ".\nthermo.dat has temperature, pressure, energy and density of beads (1/%s^%d).\n\n",
            job->units.length_name, job->model->setup.box.dimensions);
}

static void explain(const struct export_job *job, FILE *stream) {
    char command[128];
    explain_columns(job, stream);
    snprintf(
        command, sizeof command,
        "    lmp -in in.mesofit -var pressure %.4g -var equilibration 20000 -var steps 50000\n",
        mf_export_checks_usual_pressure(job));
    mf_export_checks_pressure(job, command, stream);
    fprintf(stream, "-var friction langevin%s runs in every LAMMPS: a bath for each particle. %s\n",
            dpd_runs(job) ? "" : ", the default,", mf_export_dynamics_kept(job));
    if (mf_export_is_power(job))
        fprintf(stream,
                "-var friction dpd%s: %s by pair_style hybrid/overlay, the power law above. LAMMPS "
                "needs its package DPD-BASIC.\n",
                dpd_runs(job) ? ", the default" : "", mf_export_dynamics_friction(job));
    else if (job->model->setup.omega || export_model_across(job->model))
        fprintf(stream, "LAMMPS's own dpd/tstat and dpd/ext/tstat cannot express this omega.\n");
    if (is_exact(job))
        fprintf(stream, "-var friction exact: the result's own omega, by pair_style mesofit/table "
                        "of mesofit's share/lammps.\n");
}

const struct export_engine mf_export_lammps = {
    .name = "lammps",
    .title = "LAMMPS",
    .summary = "in.mesofit, data.mesofit, mesofit.table; units real or lj",
    .system = EXPORT_REAL,
    .interpolation = &mf_export_grid_square,
    .friction = EXPORT_POWER,
    .across = true,
    .bath = "fix langevin",
    .ask = ask,
    .advise = advise,
    .commands = "    lmp -in in.mesofit\n    mpirun -np 4 lmp -in in.mesofit   # the same on four "
                "processors\n",
    .verified = "Such folders were run with LAMMPS of 29 Sep 2021 and 6 Jan 2022.",
    .max_types = COMPOSITION_MAX_TYPES,
    .flat = true,
    .molecules = true,
    .many_body = true,
    .has_law = mf_export_lammps_has_law,
    .check = mf_export_lammps_check,
    .tables = write_table,
    .write = write,
    .explain = explain,
};
