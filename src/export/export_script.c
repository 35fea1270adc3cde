// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_script.h"

#include <math.h>
#include <string.h>

// Terms of molecules ------------------------------------------------------------------------------

// Files -------------------------------------------------------------------------------------------

/// A file of a kind of terms, or of its table number `number`.
static enum status open_file(struct output *output, const struct export_job *job, const char *name,
                             int number) {
    char path[OUTPUT_PATH_SIZE], ending[16] = "";
    if (number >= 0)
        snprintf(ending, sizeof ending, "%d", number);
    snprintf(path, sizeof path, "%.3800s/%.200s%s.txt", job->folder, name, ending);
    return mf_output_open(output, path);
}

static enum status write_terms(const struct export_job *job, int order) {
    enum { NO_TABLE = -1 };
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const struct topology *topology = &job->model->molecules->topology;
    struct output output;
    TRY(open_file(&output, job, kind->plural, NO_TABLE));
    fprintf(output.stream, "# group and beads, from 0 on\n");
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            for (int n = 0; n < topology->kind[k].terms[order]; n++) {
                const struct topology_term *term = &topology->kind[k].term[order][n];
                fprintf(output.stream, "%d", term->group);
                for (int bead = 0; bead < kind->beads; bead++)
                    fprintf(output.stream, " %u",
                            topology_id(&topology->kind[k], m, term->bead[bead]));
                fprintf(output.stream, "\n");
            }
    return mf_output_commit(&output);
}

static enum status write_table(const struct export_job *job, int order,
                               const struct export_bonded_table *table) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double unit = kind->is_length ? job->units.length : 1;
    struct output output;
    TRY(open_file(&output, job, kind->name, table->number));
    fprintf(output.stream, "# %s[%s] energy[%s] -slope[%s/%s]\n", kind->is_length ? "r" : "angle",
            kind->is_length ? job->units.length_name : "rad", job->units.energy_name,
            job->units.energy_name, kind->is_length ? job->units.length_name : "rad");
    for (size_t k = 0; k < job->bonded.rows; k++)
        fprintf(output.stream, "%.15g %.15g %.15g\n", table->q[k] * unit,
                table->energy[k] * job->units.energy, -table->slope[k] * job->units.energy / unit);
    return mf_output_commit(&output);
}

static void print_exclusions(const struct export_job *job, FILE *stream) {
    const struct topology *topology = &job->model->molecules->topology;
    fprintf(stream, "# pairs of beads, from 0 on, that do not act as pairs\n");
    for (size_t id = 0; id < topology->particles; id++)
        for (size_t k = topology->excluded_start[id]; k < topology->excluded_start[id + 1]; k++)
            if (topology->excluded[k] > id)
                fprintf(stream, "%zu %u\n", id, topology->excluded[k]);
}

enum status mf_export_terms_files(const struct export_job *job) {
    const struct molecules *molecules = job->model->molecules;
    if (molecules == NULL)
        return STATUS_OK;
    for (int order = 0; order < BONDED_KINDS; order++) {
        if (mf_topology_terms(&molecules->topology, order) > 0)
            TRY(write_terms(job, order));
        for (int g = 0; g < molecules->groups[order]; g++)
            if (job->bonded.table[order][g].q)
                TRY(write_table(job, order, &job->bonded.table[order][g]));
    }
    return molecules->topology.excludes ? mf_export_file(job, "exclusions.txt", print_exclusions)
                                        : STATUS_OK;
}

// The script --------------------------------------------------------------------------------------

/// What a parameter of a law is to be multiplied with, by the unit that its field has.
static double unit_of(const struct export_job *job, const char *unit) {
    const struct export_units *units = &job->units;
    if (strcmp(unit, "lambda") == 0)
        return units->length;
    if (strcmp(unit, "degrees") == 0)
        return BONDED_RADIANS;
    if (strcmp(unit, "k_B T_0") == 0)
        return units->energy;
    if (strcmp(unit, "k_B T_0/lambda^2") == 0)
        return units->energy / (units->length * units->length);
    return 1;
}

static void print_group(const struct export_job *job, int order, int g, FILE *stream) {
    const struct molecules_group *group = &job->model->molecules->group[order][g];
    const struct bonded_law *law = group->curve.law;
    if (job->bonded.table[order][g].q) {
        fprintf(stream, "(\"%s\", \"table\", dict(file=\"%s%d.txt\"))", group->name,
                mf_bonded_kinds[order]->name, job->bonded.table[order][g].number);
        return;
    }
    fprintf(stream, "(\"%s\", \"%s\", dict(", group->name, law->name);
    for (const struct field *field = law->fields; field->name; field++)
        fprintf(stream, "%s%s=%.15g", field == law->fields ? "" : ", ", field->name,
                mf_bonded_number(&group->curve, field->name) * unit_of(job, field->unit));
    fprintf(stream, "))");
}

void mf_export_terms_head(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    fprintf(stream, "# of each kind of terms its groups (name, law, numbers; angles in radians), "
                    "and rows of group and beads\nterms = {}\n");
    for (int order = 0; order < BONDED_KINDS; order++) {
        const char *kind = mf_bonded_kinds[order]->plural;
        if (mf_topology_terms(&molecules->topology, order) == 0)
            continue;
        fprintf(stream, "terms[\"%s\"] = [\n", kind);
        for (int g = 0; g < molecules->groups[order]; g++) {
            fprintf(stream, "    ");
            print_group(job, order, g, stream);
            fprintf(stream, ",\n");
        }
        fprintf(stream, "], numpy.loadtxt(\"%s.txt\", dtype=int, ndmin=2)\n", kind);
    }
    fprintf(stream, molecules->topology.excludes
                        ? "excluded = numpy.loadtxt(\"exclusions.txt\", dtype=int, ndmin=2)\n\n"
                        : "excluded = numpy.empty((0, 2), dtype=int)\n\n");
}

/// What a printer of one file is to print.
struct printed {
    const struct export_job *job;
    enum export_curve curve;
    int pair;
    double shift;
};

static void print_start(const struct export_job *job, double shift, FILE *stream) {
    const struct export_model *model = job->model;
    const double velocity = export_units_velocity(&job->units);
    fprintf(stream, "# type\tx[%s]\ty\tz\tvelocity_x[%s/%s]\tvelocity_y\tvelocity_z\n",
            job->units.length_name, job->units.length_name, job->units.time_name);
    for (size_t k = 0; k < model->count; k++) {
        fprintf(stream, "%d", mf_export_type(model, k));
        for (int d = 0; d < 3; d++)
            fprintf(stream, "\t%.12g",
                    (mf_export_place(model, d, k) - shift * model->setup.box.length[d]) *
                        job->units.length);
        for (int d = 0; d < 3; d++)
            fprintf(stream, "\t%.12g", model->velocity[d][k] * velocity);
        fprintf(stream, "\n");
    }
}

static void print_table(const struct printed *what, FILE *stream) {
    const struct export_job *job = what->job;
    const struct export_grid *grid = &job->grids.grid[what->curve][what->pair];
    fprintf(stream, "# r[%s] energy[%s] force[%s/%s]\n", job->units.length_name,
            job->units.energy_name, job->units.energy_name, job->units.length_name);
    for (size_t k = 0; k < grid->rows; k++)
        fprintf(stream, "%.15g %.15g %.15g\n", grid->r[k] * job->units.length,
                grid->phi[k] * job->units.energy, grid->force[k] * export_units_force(&job->units));
}

static enum status write_one(const struct printed *what, const char *name, bool start) {
    struct output output;
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.3800s/%.200s", what->job->folder, name);
    TRY(mf_output_open(&output, path));
    if (start)
        print_start(what->job, what->shift, output.stream);
    else
        print_table(what, output.stream);
    return mf_output_commit(&output);
}

enum status mf_export_script_tables(const struct export_job *job) {
    struct printed what = {.job = job};
    for (int curve = 0; curve < job->grids.curves; curve++)
        for (what.pair = 0; what.pair < job->grids.pairs; what.pair++) {
            char pair[COMPOSITION_PAIR_NAME_SIZE], name[2 * COMPOSITION_PAIR_NAME_SIZE];
            int type[2];
            what.curve = (enum export_curve)curve;
            mf_export_model_pair(job->model, what.pair, type, pair);
            snprintf(name, sizeof name, "%s%s.txt", pair, mf_export_curve_name(what.curve));
            TRY(write_one(&what, name, false));
        }
    return STATUS_OK;
}

enum status mf_export_script_files(const struct export_job *job, double shift) {
    const struct printed what = {.job = job, .shift = shift};
    TRY(write_one(&what, "start.txt", true));
    return mf_export_script_tables(job);
}

static void print_pairs(const struct export_job *job, FILE *stream) {
    const double friction = export_units_friction(&job->units);
    fprintf(stream,
            "# types a and b, table, cutoff; friction gamma (1 - r/r_c)^2 and r_c\npairs = [");
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        const struct export_power *power = &job->power[pair];
        char name[COMPOSITION_PAIR_NAME_SIZE];
        int type[2];
        mf_export_model_pair(job->model, pair, type, name);
        fprintf(stream, "%s(%d, %d, \"%s\", %.15g, %.12g, %.12g)", pair ? ",\n         " : "",
                type[0], type[1], name, job->grids.grid[0][pair].last * job->units.length,
                power->amplitude * power->amplitude * friction, power->cutoff * job->units.length);
    }
    fprintf(stream, "]\n");
}

void mf_export_script_head(const struct export_job *job, const char *module, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    const double *length = model->setup.box.length;
    fprintf(stream, "# Written by mesofit; see README. Units: %s, %s, %s.\n", units->length_name,
            units->time_name, units->energy_name);
    mf_export_dynamics_print(job, "# ", stream);
    fprintf(stream,
            "import os\nimport sys\nimport numpy\nimport %s\n\n"
            "os.chdir(os.path.dirname(os.path.abspath(__file__)))\n",
            module);
    fprintf(stream, "box = [%.12g, %.12g, %.12g]\n", length[0] * units->length,
            length[1] * units->length, length[2] * units->length);
    fprintf(stream, "kT = %.12g # %s\ntemperature = %.12g # %s\n",
            model->setup.temperature * units->energy, units->energy_name,
            model->setup.temperature * units->temperature, units->temperature_name);
    fprintf(stream, "pressure_unit = %.9g # %s in a %s/%s^%d\ntime_step = %.9g # %s\n",
            units->pressure * pow(units->length, model->setup.box.dimensions) / units->energy,
            units->pressure_name, units->energy_name, units->length_name,
            model->setup.box.dimensions, job->time_step * units->time, units->time_name);
    fprintf(stream, "types = [");
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%s\"%s\"", type ? ", " : "", model->name[type]);
    fprintf(stream, "]\nmasses = [");
    for (int type = 0; type < model->types; type++)
        fprintf(stream, "%s%.12g", type ? ", " : "", model->mass[type] * units->mass);
    fprintf(stream, "]\n");
    print_pairs(job, stream);
    fprintf(stream, "dpd = %s # the friction is that of pairs; else a bath\nslowing = %.6g\n",
            mf_export_dynamics_pairs(job) ? "True" : "False", mf_export_slowing(job) * units->time);
    fprintf(stream, "steps = int(sys.argv[1]) if len(sys.argv) > 1 else 10000\n"
                    "start = numpy.loadtxt(\"start.txt\")\n\n");
}

void mf_export_script_columns(const struct export_job *job, bool density, FILE *stream) {
    const struct export_units *units = &job->units;
    fprintf(stream, "print(\"# step, temperature [%s], pressure [%s], potential energy [%s]",
            units->temperature_name, units->pressure_name, units->energy_name);
    if (density)
        fprintf(stream, ", density [1/%s^3]", units->length_name);
    fprintf(stream, "\")\n");
}

void mf_export_script_explain(const struct export_job *job, const char *dpd, FILE *stream) {
    if (mf_export_dynamics_pairs(job))
        fprintf(stream, "Friction and noise: %s, %s%s.\n", dpd,
                job->model->thermostat ? "chosen to hold the temperature, and no result"
                                       : "that of the result",
                job->projected ? " as the law above" : "");
    else if (job->model->setup.omega || export_model_across(job->model))
        fprintf(stream,
                "%s cannot express this omega: a Langevin bath of each particle holds the "
                "temperature instead. %s\n",
                job->engine->title, mf_export_dynamics_kept(job));
    else
        fprintf(stream, "A Langevin bath of each particle holds the temperature.\n");
}

void mf_export_script_excluded(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    if (molecules && molecules->topology.excludes && mf_export_dynamics_pairs(job))
        fprintf(stream, "It acts also between the pairs that molecules exclude, where that of the "
                        "result does not.\n");
}
