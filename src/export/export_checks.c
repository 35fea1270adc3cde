// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_checks.h"

#include <math.h>

void mf_export_checks_tables(const struct export_job *job, FILE *stream) {
    const struct export_error *error = &job->grids.error;
    const struct export_units *units = &job->units;
    fprintf(
        stream,
        "Tables of %zu rows, read by %s as it reads them (%s), are within %.2g k_B T of the\n"
        "potential and within %.2g of its largest force, %.4g %s/%s, for all r from %.4g %s on.\n",
        job->grids.grid[0][0].rows, job->engine->title, job->engine->interpolation->summary,
        error->phi, error->force, export_units_force(units) * error->largest_force,
        units->energy_name, units->length_name, units->length * error->from, units->length_name);
    if (job->bonded.tables > 0)
        fprintf(stream,
                "%d of the laws of bonds, angles and dihedrals are tables of %zu rows, too. Linear "
                "between the rows they are\nwithin %.2g k_B T and %.2g of the largest slope.\n",
                job->bonded.tables, job->bonded.rows, job->bonded.energy_error,
                job->bonded.slope_error);
    if (job->densities.terms > 0)
        fprintf(
            stream,
            "Of the tables of \"many_body\" what %s reads between the rows is within %.2g k_B T "
            "of f and within %.2g\nof its largest slope at densities that the start has, from a "
            "500th of the last density said above on.\n",
            job->engine->title, job->densities.error.phi, job->densities.error.force);
    if (job->grids.curves > 1)
        fprintf(stream, "\n_lower and _upper are the potential minus and plus one standard error "
                        "at each r. Errors at\ndifferent r are correlated; the two are a band, not "
                        "two likely potentials.\n");
}

void mf_export_checks_rdf(const struct export_job *job, const char *files, FILE *stream) {
    const struct export_model *model = job->model;
    fprintf(stream,
            "g(r) of the run, to be laid beside rdf.tsv of the result:\n\n    mesofit measure %s "
            "--temperature %.6g%s -o measured\n\n",
            files, model->setup.temperature * job->units.temperature,
            model->molecules ? " --molecules RESULT/used.json" : "");
    if (model->molecules)
        fprintf(stream, "where RESULT is the folder of the result, %s.\n\n", model->folder);
}

/// Change of the density up to which a straight line is of use.
static const double straight = 0.1;

static double density_of(const struct export_model *model) {
    return (double)model->count / mf_box_volume(&model->setup.box);
}

double mf_export_checks_compressibility(const struct export_job *job) {
    const struct export_model *model = job->model;
    return model->compressibility.value / (density_of(model) * model->setup.temperature) /
           job->units.pressure;
}

double mf_export_checks_usual_pressure(const struct export_job *job) {
    const struct export_model *model = job->model;
    // Where nothing tells what density another pressure has, none but its own is a check.
    const bool own =
        job->units.system == EXPORT_REDUCED || !(mf_export_checks_compressibility(job) > 0);
    if (own && !model->partial && model->pressure.value > 0)
        return job->units.pressure * model->pressure.value;
    return job->engine->system == EXPORT_DL_POLY ? 1e-3 : 1;
}

/// " = 0.0123 +- 0.0004", the error if it is known.
static void print_with_error(double value, double error, FILE *stream) {
    fprintf(stream, " = %.3g", value);
    if (isfinite(error))
        fprintf(stream, " +- %.2g", error);
}

static void print_density(const struct export_job *job, double factor, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    const int dimensions = model->setup.box.dimensions;
    const double density = factor * density_of(model) / pow(units->length, dimensions);
    double mass = 0;
    fprintf(stream, "%.4g 1/%s^%d", density, units->length_name, dimensions);
    if (!mf_units_known(&model->scene.units) || model->scene.units.massless || dimensions == 2)
        return;
    for (int type = 0; type < model->types; type++)
        mass += model->mass[type] * units->mass * (double)mf_export_count(model, type);
    const double cubic_cm = units->system == EXPORT_NANOMETRES ? 1e-21 : 1e-24;
    fprintf(stream, " (%.4g g/cm^3)",
            density * mass / (double)model->count / (UNITS_AVOGADRO * cubic_cm));
}

/// The density at another pressure, by the slope at that of the result.
static void print_expected(const struct export_job *job, double change, FILE *stream) {
    fprintf(stream, "At %g %s that is ", mf_export_checks_usual_pressure(job),
            job->units.pressure_name);
    if (fabs(change) < straight)
        print_density(job, 1 + change, stream);
    else
        fprintf(stream, "%.0f %% %s, too far for a straight line: there the run alone tells",
                100 * fabs(change), change > 0 ? "more" : "less");
    fprintf(stream, ".\n");
}

void mf_export_checks_pressure(const struct export_job *job, const char *commands, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    const double kappa = mf_export_checks_compressibility(job);
    const double pressure = units->pressure * model->pressure.value;
    if (model->setup.box.dimensions == 2 && units->system != EXPORT_REDUCED)
        return; // LAMMPS takes pressures of the plane for those of space
    fprintf(stream, "At constant pressure (in %s), as a check of the density:\n\n%s\n",
            units->pressure_name, commands);
    if (!isfinite(pressure) ||
        model->partial) // then the pressure is that of forces that are missing
        return;
    fprintf(stream, "The result has %.5g %s at ", pressure, units->pressure_name);
    print_density(job, 1, stream);
    fprintf(stream, ", and so should a run at that pressure.\n");
    if (!(kappa > 0)) {
        fprintf(stream, "How the density follows another one is not known%s.\n\n",
                model->types == 1 && model->molecules == NULL
                    ? "; \"kirkwood_buff\": {} of a simulation measures it"
                    : "");
        return;
    }
    fprintf(stream, "At another one, P, the density is higher by the share kappa (P - %.5g), kappa",
            pressure);
    print_with_error(kappa, kappa * model->compressibility.error / model->compressibility.value,
                     stream);
    fprintf(stream, " per %s:\nrho k_B T kappa", units->pressure_name);
    print_with_error(model->compressibility.value, model->compressibility.error, stream);
    fprintf(stream, ", %s.\n",
            model->fit ? "by g(r) up to the range of the target, which is rough"
                       : "by the longest waves of S(q)");
    if (units->system != EXPORT_REDUCED)
        print_expected(job, kappa * (mf_export_checks_usual_pressure(job) - pressure), stream);
    fprintf(stream, "\n");
}
