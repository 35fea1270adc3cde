// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_tables.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "observe/measure.h"

bool mf_measure_tables_have_motion(const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    return motion->begun && mf_motion_blocks(&motion->motion) > 0;
}

bool mf_measure_tables_have_etd(const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    return motion->begun && mf_etd_pairs(&motion->etd) > 0;
}

struct simulation_setup mf_measure_tables_setup(const struct measure_result *result) {
    return (struct simulation_setup){.box = mf_measured_box(result->measured),
                                     .placement = {.count = (int64_t)result->mapping->beads},
                                     .composition = result->measured->pairs.composition,
                                     .time_step = result->measured->motion.interval};
}

static enum status write_curve(const struct measure_result *result, const char *file,
                               const struct data_column *columns, size_t rows) {
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.*s/%s", OUTPUT_PATH_SIZE - 64, result->folder, file);
    return mf_data_table_write_in(path, &result->units, NULL, columns, 3, rows);
}

/// msd.tsv and vacf.tsv: time, value, standard error.
static enum status write_motion(const struct measure_result *result) {
    const struct measured_motion *const measured = &result->measured->motion;
    const size_t rows = (size_t)measured->motion.plan.lags + 1;
    OWNED double *values = NULL;
    TRY(mf_motion_table(&measured->motion, &values));
    const struct data_column msd[] = {{"time[tau]", values, NULL},
                                      {"msd[lambda^2]", values + rows, "%.8g"},
                                      {"msd_error[lambda^2]", values + 2 * rows, "%.3g"}};
    const struct data_column vacf[] = {{"time[tau]", values, NULL},
                                       {"vacf[lambda^2/tau^2]", values + 3 * rows, "%.8g"},
                                       {"vacf_error[lambda^2/tau^2]", values + 4 * rows, "%.3g"}};
    TRY(write_curve(result, "msd.tsv", msd, rows));
    if (measured->has_vacf)
        TRY(write_curve(result, "vacf.tsv", vacf, rows));
    return STATUS_OK;
}

/// g(r) between molecules, and what observables have of them.
static enum status write_molecules(const struct measure_result *result,
                                   const struct observable_results *results) {
    const struct measured *const measured = result->measured;
    if (measured->molecules.molecules == NULL)
        return STATUS_OK;
    if (!measured->in_vacuum)
        TRY(mf_rdf_observable.write(&measured->intermolecular, results));
    for (const struct observable_use *use = measured->molecules.use; use->observable; use++)
        TRY(use->observable->write(use->state, results));
    return STATUS_OK;
}

enum status mf_measure_tables_write(const struct measure_result *result) {
    const struct simulation_setup setup = mf_measure_tables_setup(result);
    const struct measure_plan plan = {.samples = (int64_t)result->measured->frames};
    const struct observable_results results = {&setup, &plan, &result->units, result->folder, NULL};
    if (!result->measured->in_vacuum)
        TRY(mf_rdf_observable.write(&result->measured->rdf, &results));
    TRY(write_molecules(result, &results));
    if (!result->measured->in_vacuum && result->measured->plan.weighted.cutoff > 0)
        TRY(mf_weighted_density_write(&result->measured->weighted, &results));
    if (!result->measured->in_vacuum && mf_structure_factor_blocks(&result->measured->factor) > 0)
        TRY(mf_structure_factor_write(&result->measured->factor, &results));
    if (result->measured->profile_length > 0)
        TRY(mf_density_profile_write(
            &result->measured->profile,
            result->measured->profile_length / (double)result->measured->frames, 3, &results));
    if (mf_measure_tables_have_motion(result))
        TRY(write_motion(result));
    return mf_measure_tables_have_etd(result)
               ? mf_etd_observable.write(&result->measured->motion.etd, &results)
               : STATUS_OK;
}
