// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_output.h"

#include "base/memory.h"
#include "curves/sum.h"
#include "io/configuration.h"
#include "io/votca.h"

#include <math.h>
#include <stdio.h>

/// The true curve number `curve` of an unknown at `r`, where the run file names it; the caller
/// frees it.
static double *truth_at(const struct fit_file *fit, enum unknown_kind kind, size_t curve,
                        const double *r, size_t points) {
    const struct curve *truth = mf_scene_law_curve(&fit->unknown[kind].truth, (int)curve);
    double *values = mf_memory_zeroed(points, sizeof *values);
    for (size_t k = 0; values && truth && k < points; k++)
        values[k] = mf_curve_value(truth, r[k]);
    return values;
}

/// The potential and what is known beside it at `r`, if anything is; the caller frees it.
static double *total_at(const struct fit_file *fit, size_t pair, const double *r, const double *phi,
                        size_t points) {
    const struct curve *known = inverse_law_curve(&fit->problem.known, (int)pair);
    double *values = mf_memory_zeroed(points, sizeof *values);
    for (size_t k = 0; values && known && k < points; k++)
        values[k] = phi[k] + mf_sum_shifted(known, r[k]);
    return values;
}

/// Path of a table about one curve of an unknown: its name and an ending.
static void curve_file(const struct unknowns *unknowns, enum unknown_kind kind, size_t curve,
                       const char *ending, const struct run_folder *folder, char *path) {
    char name[UNKNOWNS_NAME_SIZE], file[UNKNOWNS_NAME_SIZE + 16];
    mf_unknowns_curve_name(unknowns, kind, curve, name);
    snprintf(file, sizeof file, "%s%s", name, ending);
    mf_run_folder_file(folder, file, path);
}

/// Of one pair type, from the table of all.
static enum status write_potential(const struct fit_file *fit, const struct unknowns *unknowns,
                                   const struct fit_result *result, const struct table *table,
                                   size_t pair, const struct run_folder *folder) {
    const struct units *units = &fit->scene.units;
    const size_t points = unknowns->potential.bins + 1;
    const size_t first = mf_potential_grid_block(&unknowns->potential, pair);
    const double *r = unknowns->potential.r + first;
    const double *phi = result->step.curve[UNKNOWN_POTENTIAL] + first;
    OWNED double *force = NULL, *truth = NULL, *total = NULL;
    size_t count = 0;
    char path[OUTPUT_PATH_SIZE];
    TRY_ARRAY(force, points);
    for (size_t k = 0; k < points; k++) {
        mf_table_evaluate_pair(table, (int)pair, r[k], NULL, &force[k], NULL);
        force[k] = -force[k];
    }
    truth = truth_at(fit, UNKNOWN_POTENTIAL, pair, r, points);
    total = total_at(fit, pair, r, phi, points);
    TRY(truth && total ? STATUS_OK : STATUS_NO_MEMORY);
    static const char *const beside[7] = {"%.10g", "%.10g"};
    struct data_column columns[7] = {
        {"r[lambda]", r, "%.17g"},
        {"phi[k_B.T_0]", phi, "%.17g"},
        {"force[k_B.T_0/lambda]", force, NULL},
        {"phi_error[k_B.T_0]", result->step.curve_error[UNKNOWN_POTENTIAL] + first, "%.3g"}};
    count = 4;
    if (result->step.ramp.error > 0)
        columns[count++] = (struct data_column){"phi_error_without_ramp[k_B.T_0]",
                                                result->step.without_ramp + first, "%.3g"};
    if (mf_scene_law_curve(&fit->unknown[UNKNOWN_POTENTIAL].truth, (int)pair))
        columns[count++] = (struct data_column){"truth[k_B.T_0]", truth, "%.8g"};
    if (inverse_law_curve(&fit->problem.known, (int)pair))
        columns[count++] = (struct data_column){"total[k_B.T_0]", total, "%.17g"};
    curve_file(unknowns, UNKNOWN_POTENTIAL, pair, ".tsv", folder, path);
    TRY(mf_data_table_write_beside(path, units, NULL, columns, beside, count, points));
    if (mf_units_known(units)) {
        const struct votca_scale scale = {units->length, mf_units_energy_kj_per_mol(units)};
        curve_file(unknowns, UNKNOWN_POTENTIAL, pair, ".pot", folder, path);
        TRY(mf_votca_write(path, r, phi, scale, points, unknowns->potential.core[pair]));
    }
    return STATUS_OK;
}

static enum status write_potentials(const struct fit_file *fit, const struct unknowns *unknowns,
                                    const struct fit_result *result,
                                    const struct run_folder *folder) {
    CLEARED_BY(mf_table_clear) struct table table = {0};
    TRY(mf_potential_grid_table_sought(&unknowns->potential, result->step.curve[UNKNOWN_POTENTIAL],
                                       &table));
    for (size_t pair = 0; pair < unknowns->potential.pairs; pair++)
        TRY(write_potential(fit, unknowns, result, &table, pair, folder));
    return STATUS_OK;
}

static enum status write_omega(const struct fit_file *fit, const struct unknowns *unknowns,
                               const struct fit_result *result, enum unknown_kind kind,
                               const struct run_folder *folder) {
    const bool truth_known = fit->unknown[kind].truth.curves > 0;
    static const char *const beside[4] = {"%.10g"};
    enum status status = STATUS_NO_MEMORY;
    const double *r = mf_unknowns_r(unknowns, kind);
    double *truth = truth_at(fit, kind, 0, r, OMEGA_POINTS);
    char path[OUTPUT_PATH_SIZE];
    struct data_column columns[4] = {
        {"r[lambda]", r, "%.17g"},
        {"omega[sqrt(mu/tau)]", result->step.curve[kind], "%.17g"},
        {"omega_error[sqrt(mu/tau)]", result->step.curve_error[kind], "%.3g"}};
    size_t count = 3;
    if (truth_known)
        columns[count++] = (struct data_column){"truth[sqrt(mu/tau)]", truth, "%.8g"};
    curve_file(unknowns, kind, 0, ".tsv", folder, path);
    if (truth)
        status = mf_data_table_write_beside(path, &fit->scene.units, NULL, columns, beside, count,
                                            OMEGA_POINTS);
    mf_memory_free(truth);
    return status;
}

/// Changes that the data say least of; no table where the method does not tell.
static enum status write_flat(const struct fit_file *fit, enum unknown_kind kind, size_t curve,
                              const struct unknowns *unknowns, const struct fit_result *result,
                              const struct run_folder *folder) {
    const size_t all = mf_unknowns_points(unknowns, kind);
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const double *flat = result->step.curve_flat[kind];
    char path[OUTPUT_PATH_SIZE];
    if (flat == NULL || isnan(flat[all - 1]))
        return STATUS_OK;
    const char *unit = mf_unknowns_unit(kind);
    char names[INVERSE_FLAT][64];
    struct data_column columns[1 + INVERSE_FLAT] = {{mf_unknowns_heading(unknowns, kind, curve),
                                                     mf_unknowns_r(unknowns, kind) + part.first,
                                                     NULL}};
    for (size_t n = 0; n < INVERSE_FLAT; n++) {
        snprintf(names[n], sizeof names[n], "flat_%zu[%s]", n + 1, unit);
        columns[n + 1] = (struct data_column){names[n], flat + n * all + part.first, "%.5g"};
    }
    curve_file(unknowns, kind, curve, "_flat.tsv", folder, path);
    return mf_data_table_write_in(
        path, &fit->scene.units,
        "changes of the curve that the data determine least, widest first; one standard error each",
        columns, 1 + INVERSE_FLAT, part.points);
}

/// U of a group: a table that a scene's law "table" reads.
static enum status write_group(const struct fit_file *fit, const struct unknowns *unknowns,
                               const struct fit_result *result, size_t group,
                               const struct run_folder *folder) {
    static const char *const beside[] = {NULL, "%.10g", NULL};
    const struct unknowns_part part = mf_unknowns_part(unknowns, UNKNOWN_BONDED, group);
    char path[OUTPUT_PATH_SIZE];
    const struct data_column columns[] = {
        {mf_unknowns_heading(unknowns, UNKNOWN_BONDED, group),
         mf_unknowns_r(unknowns, UNKNOWN_BONDED) + part.first, "%.17g"},
        {"energy[k_B.T_0]", result->step.curve[UNKNOWN_BONDED] + part.first, "%.17g"},
        {"energy_error[k_B.T_0]", result->step.curve_error[UNKNOWN_BONDED] + part.first, "%.3g"}};
    curve_file(unknowns, UNKNOWN_BONDED, group, ".tsv", folder, path);
    return mf_data_table_write_beside(path, &fit->scene.units, NULL, columns, beside, 3,
                                      part.points);
}

enum status mf_fit_output_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                 const struct fit_result *result, const struct run_folder *folder) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t n = 0; result->step.curve[kind] && n < mf_unknowns_curve_count(unknowns, kind);
             n++)
            if (mf_unknowns_is_sought(unknowns, kind, n))
                TRY(write_flat(fit, kind, n, unknowns, result, folder));
    if (result->step.curve[UNKNOWN_POTENTIAL])
        TRY(write_potentials(fit, unknowns, result, folder));
    for (size_t n = 0; result->step.curve[UNKNOWN_BONDED] && n < unknowns->potential.groups; n++)
        TRY(write_group(fit, unknowns, result, n, folder));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknown_is_omega(kind) && result->step.curve[kind])
            TRY(write_omega(fit, unknowns, result, kind, folder));
    return STATUS_OK;
}

enum { PLACES = 2, VALUES = 4, MAX_COLUMNS = PLACES + VALUES + 1 };

/// Where the values are: columns of their own.
static enum status find_places(const struct target_files *files, int kind,
                               const struct target_table *table, double *place[PLACES]) {
    for (size_t n = 0; n < table->places; n++)
        TRY_ARRAY(place[n], table->count);
    for (size_t k = 0; k < table->count; k++) {
        double at[PLACES];
        mf_target_record(kind)->place(files, kind, table, k, at);
        for (size_t n = 0; n < table->places; n++)
            place[n][k] = at[n];
    }
    return STATUS_OK;
}

/// A table of a target beside the result, each with its error, as rdf_A-B.tsv.
static enum status write_table(const struct fit_file *fit, int kind,
                               const struct target_table *table, const struct observed *observed,
                               const struct run_folder *folder) {
    static const char *const words[VALUES] = {"target", "target_error", "result", "result_error"};
    enum status status = STATUS_OK;
    const struct target *target = &fit->problem.compared.target[kind];
    const char *unit = mf_observable_kind(kind).target->unit;
    const double *const values[VALUES] = {target->value, target->error, observed->value[kind],
                                          observed->error[kind]};
    const char *const usual = table->value_format ? table->value_format : "%.8g";
    struct data_column columns[MAX_COLUMNS];
    const char *beside[MAX_COLUMNS] = {NULL};
    char path[OUTPUT_PATH_SIZE], names[VALUES][64], file[8 + sizeof table->name];
    double *place[PLACES] = {NULL};
    size_t count = 0;
    CHECK(find_places(&fit->files, kind, table, place));
    for (; count < table->places; count++) {
        columns[count] =
            (struct data_column){table->place[count], place[count], table->place_format};
        if (table->beside)
            beside[count] = table->place_format ? "%.6g" : "%.10g";
    }
    for (size_t k = 0; k < VALUES; k++, count++) {
        snprintf(names[k], sizeof *names, "%s[%s]", words[k], unit ? unit : "1");
        columns[count] =
            (struct data_column){names[k], values[k] + table->first, k % 2 ? "%.3g" : usual};
        if (table->values_beside)
            beside[count] = columns[count].format;
    }
    if (table->given)
        columns[count++] = (struct data_column){"given[1]", table->given, "%.8g"};
    snprintf(file, sizeof file, "%s.tsv", table->name);
    mf_run_folder_file(folder, file, path);
    CHECK(mf_data_table_write_beside(path, &fit->scene.units, NULL, columns, beside, count,
                                     table->count));
done:
    for (size_t n = 0; n < PLACES; n++)
        mf_memory_free(place[n]);
    return status;
}

/// configuration.tsv: where the first simulation of the verification ended, as a placement file
/// with which a scene or another program can begin.
static enum status write_configuration(const struct fit_file *fit,
                                       const struct verification *verification,
                                       const struct run_folder *folder) {
    static const char *const names[2][3] = {
        {"x[lambda]", "y[lambda]", "z[lambda]"},
        {"velocity_x[lambda/tau]", "velocity_y[lambda/tau]", "velocity_z[lambda/tau]"}};
    const struct simulation_setup *setup = &fit->scene.setup;
    const int kinds = !simulation_has_velocities(setup) ? 1 : 2;
    struct data_column columns[6];
    char path[OUTPUT_PATH_SIZE], bonds[OUTPUT_PATH_SIZE];
    size_t n = 0;
    for (size_t kind = 0; kind < (size_t)kinds; kind++)
        for (size_t d = 0; d < (size_t)setup->box.dimensions; d++)
            columns[n++] = (struct data_column){
                names[kind][d],
                verification->configuration + (3 * kind + d) * verification->particles, "%.17g"};
    mf_run_folder_file(folder, CONFIGURATION_FILE, path);
    mf_run_folder_file(folder, CONFIGURATION_BONDS_FILE, bonds);
    return mf_configuration_write(path, bonds, &fit->scene.units, &setup->composition,
                                  &fit->scene.molecules.molecules.topology, columns, n,
                                  verification->particles);
}

enum status mf_fit_output_observables(const struct fit_file *fit,
                                      const struct verification *verification,
                                      const struct run_folder *folder) {
    struct target_table table;
    for (int kind = 0; mf_targets_name(kind); kind++)
        for (size_t n = 0; mf_target_files_table(&fit->files, kind, n, &table); n++)
            if (table.count > 0)
                TRY(write_table(fit, kind, &table, &verification->observed, folder));
    return write_configuration(fit, verification, folder);
}

// The names of what a fit writes, refused at its start and not after hours of work ----------------

static enum status reserve(struct run_folder *folder, const char *inside, const char *name,
                           const char *ending) {
    char whole[OUTPUT_PATH_SIZE];
    snprintf(whole, sizeof whole, "%.3000s%.200s%s", inside, name, ending);
    return mf_run_folder_reserve(folder, whole);
}

enum status mf_fit_reserve_observables(const struct fit_file *state, const char *inside,
                                       struct run_folder *folder) {
    struct target_table table;
    for (int kind = 0; mf_targets_name(kind); kind++)
        for (size_t n = 0; mf_target_files_table(&state->files, kind, n, &table); n++)
            if (table.count > 0)
                TRY(reserve(folder, inside, table.name, ".tsv"));
    return reserve(folder, inside, CONFIGURATION_FILE, "");
}

enum status mf_fit_reserve_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                  struct run_folder *folder) {
    static const char *const endings[] = {".tsv", "_history.tsv", ".pot"};
    TRY(mf_run_folder_reserve(folder, "history.tsv"));
    TRY(mf_run_folder_reserve(folder, "timing.tsv"));
    TRY(mf_run_folder_reserve(folder, "tasks.tsv"));
    if (fit->problem.numbers > 0)
        TRY(mf_run_folder_reserve(folder, "numbers_history.tsv"));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; mf_unknowns_points(unknowns, kind) > 0 &&
                               curve < mf_unknowns_curve_count(unknowns, kind);
             curve++) {
            char name[UNKNOWNS_NAME_SIZE];
            mf_unknowns_curve_name(unknowns, kind, curve, name);
            const bool votca = kind == UNKNOWN_POTENTIAL && mf_units_known(&fit->scene.units);
            for (int k = 0; k < (votca ? 3 : 2); k++)
                TRY(reserve(folder, "", name, endings[k]));
        }
    return STATUS_OK;
}

bool mf_fit_damping_ask(struct fit_dampings *changes, uint64_t iteration, double *damping,
                        struct progress *progress) {
    double wanted;
    if (damping == NULL || !mf_progress_ask_damping(progress, &wanted) || wanted == *damping)
        return false;
    const bool again =
        changes->count > 0 && changes->change[changes->count - 1].iteration == iteration;
    if (changes->count == FIT_DAMPINGS_MAX && !again) {
        mf_progress_print(progress, "mesofit: warning: the damping was changed %d times; it stays",
                          FIT_DAMPINGS_MAX);
        return false;
    }
    changes->count += !again;
    changes->change[changes->count - 1] = (struct fit_damping){iteration, wanted};
    *damping = wanted;
    mf_progress_print(progress, "from iteration %llu on: damping %.6g",
                      (unsigned long long)iteration, wanted);
    return true;
}
