// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_checks.h"

#include <math.h>

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
    return job->engine->system == EXPORT_DL_POLY ? 1e-3 : 1;
}

static void print_density(const struct export_job *job, double factor, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    const int dimensions = model->setup.box.dimensions;
    const double density = factor * density_of(model) / pow(units->length, dimensions);
    double mass = 0;
    fprintf(stream, "%.4g 1/%s^%d", density, units->length_name, dimensions);
    if (!mf_units_known(&model->scene.units) || dimensions == 2)
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
    if (!isfinite(pressure))
        return;
    fprintf(stream, "The result has %.5g %s at ", pressure, units->pressure_name);
    print_density(job, 1, stream);
    fprintf(stream, ", and so should a run at that pressure.\n");
    if (!(kappa > 0)) {
        fprintf(stream, "How the density follows another one is not known%s.\n",
                model->types == 1 && model->molecules == NULL
                    ? "; \"kirkwood_buff\": {} of a simulation measures it"
                    : "");
        return;
    }
    fprintf(stream,
            "At another one, P, the density follows the compressibility, rho k_B T kappa = %.3g "
            "of the result:\nit changes by kappa (P - %.5g), kappa = %.3g per %s.\n",
            model->compressibility.value, pressure, kappa, units->pressure_name);
    if (units->system != EXPORT_REDUCED)
        print_expected(job, kappa * (mf_export_checks_usual_pressure(job) - pressure), stream);
}
