// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/fit_output.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "mesofit.h"

#include <math.h>

/// Points of omega.tsv.
enum { OMEGA_POINTS = 200 };

/// Column `factor` · values, for physical units; the caller frees it.
static double *scaled(const double *values, size_t count, double factor) {
    double *copy = memory_zeroed(count, sizeof *copy);
    for (size_t k = 0; copy && k < count; k++)
        copy[k] = factor * values[k];
    return copy;
}

static enum status write_potential(const struct fit_file *fit, const struct potential_grid *grid,
                                   const struct fit_result *result,
                                   const struct run_folder *folder) {
    enum status status = STATUS_OK;
    const struct units *units = &fit->scene.units;
    const size_t points = grid->points;
    struct table table = {0};
    double *force = NULL, *nanometres = NULL, *energy = NULL;
    char path[OUTPUT_PATH_SIZE];
    CHECK(potential_grid_table(grid, result->phi, &table));
    NEW_ARRAY(force, points);
    for (size_t k = 0; k < points; k++) {
        table_evaluate(&table, grid->r[k], NULL, &force[k], NULL);
        force[k] = -force[k];
    }
    nanometres = scaled(grid->r, points, units->length);
    energy = scaled(result->phi, points, units_known(units) ? units_energy_kj_per_mol(units) : 0);
    CHECK(nanometres && energy ? STATUS_OK : STATUS_NO_MEMORY);
    const struct data_column columns[] = {{"r[lambda]", grid->r, "%.17g"},
                                          {"phi[k_B.T_0]", result->phi, "%.17g"},
                                          {"force[k_B.T_0/lambda]", force, NULL},
                                          {"phi_error[k_B.T_0]", result->phi_error, "%.3g"},
                                          {"r[nm]", nanometres, NULL},
                                          {"phi[kJ/mol]", energy, NULL}};
    run_folder_file(folder, "potential.tsv", path);
    CHECK(data_table_write(path, NULL, columns, units_known(units) ? 6 : 4, points));
done:
    table_clear(&table);
    memory_free(force);
    memory_free(nanometres);
    memory_free(energy);
    return status;
}

static enum status write_omega(const struct fit_file *fit, const struct run_folder *folder) {
    double r[OMEGA_POINTS + 1], omega[OMEGA_POINTS + 1];
    char path[OUTPUT_PATH_SIZE];
    if (fit->scene.weight.family == NULL)
        return STATUS_OK;
    const double cutoff = curve_cutoff(&fit->scene.weight);
    for (int k = 0; k <= OMEGA_POINTS; k++) {
        r[k] = cutoff * k / OMEGA_POINTS;
        omega[k] = curve_value(&fit->scene.weight, r[k]);
    }
    const struct data_column columns[] = {{"r[lambda]", r, NULL},
                                          {"omega[sqrt(mu/tau)]", omega, NULL}};
    run_folder_file(folder, "omega.tsv", path);
    return data_table_write(path, NULL, columns, 2, OMEGA_POINTS + 1);
}

enum status fit_output_potential(const struct fit_file *fit, const struct potential_grid *grid,
                                 const struct fit_result *result, const struct run_folder *folder) {
    TRY(write_potential(fit, grid, result, folder));
    return write_omega(fit, folder);
}

enum status fit_output_rdf(const struct fit_file *fit, const struct fit_result *result,
                           const struct run_folder *folder) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = &fit->target.bins;
    const struct units *units = &fit->scene.units;
    double *r = NULL, *nanometres = NULL;
    char path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(r, bins->count);
    for (size_t k = 0; k < bins->count; k++)
        r[k] = rdf_bins_centre(bins, k);
    nanometres = scaled(r, bins->count, units->length);
    CHECK(nanometres ? STATUS_OK : STATUS_NO_MEMORY);
    const struct data_column columns[] = {
        {"r[lambda]", r, NULL},
        {"target[1]", fit->target.g, "%.8g"},
        {"target_error[1]", fit->target.error, "%.3g"},
        {"result[1]", result->verification->g, "%.8g"},
        {"result_error[1]", result->verification->g_error, "%.3g"},
        {"r[nm]", nanometres, NULL}};
    run_folder_file(folder, "rdf.tsv", path);
    CHECK(data_table_write(path, NULL, columns, units_known(units) ? 6 : 5, bins->count));
done:
    memory_free(r);
    memory_free(nanometres);
    return status;
}

struct fit_truth fit_output_truth(const struct fit_file *fit, const struct potential_grid *grid,
                                  const double *phi) {
    const double cutoff = grid->r[grid->points - 1];
    double count = 0, squares = 0, with_ramp = 0, ramp_squares = 0;
    for (size_t k = grid->core; k + 1 < grid->points; k++) {
        if (fit->target.g[k] <= 0.1)
            continue;
        const double difference = phi[k] - curve_value(&fit->truth, grid->r[k]);
        const double ramp = 1 - grid->r[k] / cutoff;
        count += 1;
        squares += difference * difference;
        with_ramp += difference * ramp;
        ramp_squares += ramp * ramp;
    }
    const double amplitude = with_ramp / ramp_squares;
    return (struct fit_truth){
        .rms = sqrt(squares / count),
        .ramp = amplitude,
        .rms_without_ramp = sqrt(fmax(0, squares - amplitude * with_ramp) / count),
    };
}

static void put_verification(struct json_writer *writer, const struct fit_file *fit,
                             const struct evaluate_verification *v) {
    const struct thermodynamics_summary *t = &v->thermodynamics;
    if (thermodynamics_judge(t, &fit->problem.scene) != STATUS_OK)
        json_put_text(writer, "warning", status_message());
    json_put_number(writer, "rdf_rmse", v->rmse);
    json_put_number(writer, "rdf_rmse_error", v->rmse_error);
    json_put_number(writer, "rdf_noise", v->noise);
    json_put_number(writer, "temperature", t->temperature);
    json_put_number(writer, "temperature_error", t->temperature_error);
    json_put_number(writer, "temperature_configurational", t->temperature_configurational);
    json_put_number(writer, "temperature_configurational_error",
                    t->temperature_configurational_error);
    json_put_number(writer, "potential_energy", t->potential_energy);
    json_put_number(writer, "potential_energy_error", t->potential_energy_error);
    json_put_number(writer, "pressure", t->pressure);
    json_put_number(writer, "pressure_error", t->pressure_error);
    json_put_number(writer, "verification_steps", (double)v->engine_steps);
    units_put(&fit->scene.units, writer, t->potential_energy, t->pressure);
}

enum status fit_output_summary(const struct fit_file *fit, const struct potential_grid *grid,
                               const struct fit_result *result, const struct run_folder *folder) {
    struct json_writer *writer = json_writer_create();
    char path[OUTPUT_PATH_SIZE];
    json_put_text(writer, "status",
                  result->status == STATUS_OK ? "converged" : status_name(result->status));
    json_put_text(writer, "method", fit->method->name);
    json_put_number(writer, "seconds", result->seconds);
    json_put_number(writer, "threads", fit->problem.threads);
    json_put_number(writer, "iterations", (double)result->iterations);
    json_put_number(writer, "evaluations", (double)result->evaluations);
    json_put_number(writer, "engine_steps", (double)result->engine_steps);
    if (result->verification)
        put_verification(writer, fit, result->verification);
    if (fit->truth.family) {
        const struct fit_truth truth = fit_output_truth(fit, grid, result->phi);
        json_put_number(writer, "truth_rms", truth.rms);
        json_put_number(writer, "truth_ramp", truth.ramp);
        json_put_number(writer, "truth_rms_without_ramp", truth.rms_without_ramp);
    }
    json_put_number(writer, "seed", (double)fit->heading.seed);
    json_put_text(writer, "version", MESOFIT_VERSION);
    run_folder_file(folder, "summary.json", path);
    const enum status status = json_write(writer, path);
    json_writer_free(writer);
    return status;
}
