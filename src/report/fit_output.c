// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_output.h"

#include "base/memory.h"
#include "io/configuration.h"
#include "io/votca.h"
#include "observe/rdf_observable.h"

#include <math.h>

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
    enum status status = STATUS_OK;
    const struct units *units = &fit->scene.units;
    const size_t points = unknowns->potential.bins + 1;
    const size_t first = mf_potential_grid_block(&unknowns->potential, pair);
    const double *r = unknowns->potential.r + first;
    const double *phi = result->curve[UNKNOWN_POTENTIAL] + first;
    double *force = NULL, *truth = NULL, *nanometres = NULL, *energy = NULL;
    size_t count = 0;
    char path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(force, points);
    for (size_t k = 0; k < points; k++) {
        mf_table_evaluate_pair(table, (int)pair, r[k], NULL, &force[k], NULL);
        force[k] = -force[k];
    }
    nanometres = mf_units_column(r, points, units->length);
    energy =
        mf_units_column(phi, points, mf_units_known(units) ? mf_units_energy_kj_per_mol(units) : 0);
    truth = truth_at(fit, UNKNOWN_POTENTIAL, pair, r, points);
    CHECK(nanometres && energy && truth ? STATUS_OK : STATUS_NO_MEMORY);
    struct data_column columns[8] = {
        {"r[lambda]", r, "%.17g"},
        {"phi[k_B.T_0]", phi, "%.17g"},
        {"force[k_B.T_0/lambda]", force, NULL},
        {"phi_error[k_B.T_0]", result->curve_error[UNKNOWN_POTENTIAL] + first, "%.3g"}};
    count = 4;
    if (result->ramp.error > 0)
        columns[count++] = (struct data_column){"phi_error_without_ramp[k_B.T_0]",
                                                result->without_ramp + first, "%.3g"};
    if (mf_scene_law_curve(&fit->unknown[UNKNOWN_POTENTIAL].truth, (int)pair))
        columns[count++] = (struct data_column){"truth[k_B.T_0]", truth, "%.8g"};
    if (mf_units_beside(units)) {
        columns[count++] = (struct data_column){"r[nm]", nanometres, NULL};
        columns[count++] = (struct data_column){"phi[kJ/mol]", energy, NULL};
    }
    curve_file(unknowns, UNKNOWN_POTENTIAL, pair, ".tsv", folder, path);
    CHECK(mf_data_table_write_in(path, &fit->scene.units, NULL, columns, count, points));
    if (mf_units_known(units)) {
        curve_file(unknowns, UNKNOWN_POTENTIAL, pair, ".pot", folder, path);
        CHECK(mf_votca_write(path, nanometres, energy, points, unknowns->potential.core[pair]));
    }
done:
    mf_memory_free(force);
    mf_memory_free(truth);
    mf_memory_free(nanometres);
    mf_memory_free(energy);
    return status;
}

static enum status write_potentials(const struct fit_file *fit, const struct unknowns *unknowns,
                                    const struct fit_result *result,
                                    const struct run_folder *folder) {
    enum status status = STATUS_OK;
    struct table table = {0};
    CHECK(mf_potential_grid_table(&unknowns->potential, result->curve[UNKNOWN_POTENTIAL], &table));
    for (size_t pair = 0; pair < unknowns->potential.pairs; pair++)
        CHECK(write_potential(fit, unknowns, result, &table, pair, folder));
done:
    mf_table_clear(&table);
    return status;
}

static enum status write_omega(const struct fit_file *fit, const struct unknowns *unknowns,
                               const struct fit_result *result, enum unknown_kind kind,
                               const struct run_folder *folder) {
    const bool truth_known = fit->unknown[kind].truth.curves > 0;
    const struct units *units = &fit->scene.units;
    enum status status = STATUS_NO_MEMORY;
    const double *r = mf_unknowns_r(unknowns, kind);
    double *truth = truth_at(fit, kind, 0, r, OMEGA_POINTS);
    double *nanometres = mf_units_column(r, OMEGA_POINTS, units->length);
    char path[OUTPUT_PATH_SIZE];
    struct data_column columns[5] = {
        {"r[lambda]", r, "%.17g"},
        {"omega[sqrt(mu/tau)]", result->curve[kind], "%.17g"},
        {"omega_error[sqrt(mu/tau)]", result->curve_error[kind], "%.3g"}};
    size_t count = 3;
    if (truth_known)
        columns[count++] = (struct data_column){"truth[sqrt(mu/tau)]", truth, "%.8g"};
    if (mf_units_beside(units))
        columns[count++] = (struct data_column){"r[nm]", nanometres, NULL};
    curve_file(unknowns, kind, 0, ".tsv", folder, path);
    if (truth && nanometres)
        status =
            mf_data_table_write_in(path, &fit->scene.units, NULL, columns, count, OMEGA_POINTS);
    mf_memory_free(truth);
    mf_memory_free(nanometres);
    return status;
}

/// Changes that the data say least of; no table where the method does not tell.
static enum status write_flat(const struct fit_file *fit, enum unknown_kind kind, size_t curve,
                              const struct unknowns *unknowns, const struct fit_result *result,
                              const struct run_folder *folder) {
    const size_t all = mf_unknowns_points(unknowns, kind);
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const double *flat = result->curve_flat[kind];
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
    enum status status = STATUS_OK;
    const struct unknowns_part part = mf_unknowns_part(unknowns, UNKNOWN_BONDED, group);
    const double *energy = result->curve[UNKNOWN_BONDED] + part.first;
    const double unit =
        mf_units_beside(&fit->scene.units) ? mf_units_energy_kj_per_mol(&fit->scene.units) : 0;
    double *beside = mf_units_column(energy, part.points, unit);
    char path[OUTPUT_PATH_SIZE];
    const struct data_column columns[] = {
        {mf_unknowns_heading(unknowns, UNKNOWN_BONDED, group),
         mf_unknowns_r(unknowns, UNKNOWN_BONDED) + part.first, "%.17g"},
        {"energy[k_B.T_0]", energy, "%.17g"},
        {"energy_error[k_B.T_0]", result->curve_error[UNKNOWN_BONDED] + part.first, "%.3g"},
        {"energy[kJ/mol]", beside, NULL}};
    CHECK(beside ? STATUS_OK : STATUS_NO_MEMORY);
    curve_file(unknowns, UNKNOWN_BONDED, group, ".tsv", folder, path);
    CHECK(mf_data_table_write_in(path, &fit->scene.units, NULL, columns, unit > 0 ? 4 : 3,
                                 part.points));
done:
    mf_memory_free(beside);
    return status;
}

enum status mf_fit_output_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                 const struct fit_result *result, const struct run_folder *folder) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t n = 0; result->curve[kind] && n < mf_unknowns_curve_count(unknowns, kind); n++)
            TRY(write_flat(fit, kind, n, unknowns, result, folder));
    if (result->curve[UNKNOWN_POTENTIAL])
        TRY(write_potentials(fit, unknowns, result, folder));
    for (size_t n = 0; result->curve[UNKNOWN_BONDED] && n < unknowns->potential.groups; n++)
        TRY(write_group(fit, unknowns, result, n, folder));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknown_is_omega(kind) && result->curve[kind])
            TRY(write_omega(fit, unknowns, result, kind, folder));
    return STATUS_OK;
}

/// g(r) of a pair type, of the target number `kind`: rdf.tsv, or rdf_A-B.tsv in a mixture.
static enum status write_rdf(const struct fit_file *fit, const struct target_pairs *target,
                             int kind, const struct observed *observed, size_t pair,
                             const struct run_folder *folder) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = target_pairs_bins(target);
    const struct units *units = &fit->scene.units;
    const size_t first = pair * bins->count;
    double *r = NULL, *nanometres = NULL;
    char path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(r, bins->count);
    for (size_t k = 0; k < bins->count; k++)
        r[k] = mf_rdf_bins_centre(bins, k);
    nanometres = mf_units_column(r, bins->count, units->length);
    CHECK(nanometres ? STATUS_OK : STATUS_NO_MEMORY);
    struct data_column columns[7] = {{"r[lambda]", r, NULL},
                                     {"target[1]", target->g + first, "%.8g"},
                                     {"target_error[1]", target->error + first, "%.3g"},
                                     {"result[1]", observed->value[kind] + first, "%.8g"},
                                     {"result_error[1]", observed->error[kind] + first, "%.3g"}};
    size_t count = 5;
    if (mf_units_beside(units))
        columns[count++] = (struct data_column){"r[nm]", nanometres, NULL};
    // What the target was before it was divided by its normalisation.
    if (memcmp(target->given + first, target->g + first, bins->count * sizeof(double)) != 0)
        columns[count++] = (struct data_column){"given[1]", target->given + first, "%.8g"};
    mf_rdf_observable_file(folder->path, mf_targets_name(kind), &fit->files.composition, (int)pair,
                           path);
    CHECK(mf_data_table_write_in(path, &fit->scene.units, NULL, columns, count, bins->count));
done:
    mf_memory_free(r);
    mf_memory_free(nanometres);
    return status;
}

/// One row a cell: time, r_0, target, result; what is not known is nan.
static enum status write_etd(const struct fit_file *fit, const struct observed *observed,
                             const struct run_folder *folder) {
    enum status status = STATUS_OK;
    const struct target_etd *target = &fit->files.etd;
    const size_t bins = (size_t)target->grid.bins, cells = (size_t)target->grid.times * bins;
    const double width = (target->grid.r_maximum - target->grid.r_minimum) / (double)bins;
    const struct units *units = &fit->scene.units;
    double *time = NULL, *r = NULL, *picoseconds = NULL, *nanometres = NULL;
    char path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(time, cells);
    NEW_ARRAY(r, cells);
    for (size_t k = 0; k < cells; k++) {
        time[k] = (double)(k / bins) * target->interval;
        r[k] = target->grid.r_minimum + ((double)(k % bins) + 0.5) * width;
    }
    const bool known = mf_units_beside(units);
    picoseconds = mf_units_column(time, cells, known ? mf_units_time_ps(units) : 0);
    nanometres = mf_units_column(r, cells, units->length);
    CHECK(picoseconds && nanometres ? STATUS_OK : STATUS_NO_MEMORY);
    const struct data_column columns[] = {{"time[tau]", time, "%.6f"},
                                          {"r0[lambda]", r, "%.6f"},
                                          {"target[1]", target->survival, "%.6f"},
                                          {"target_error[1]", target->error, "%.3g"},
                                          {"result[1]", observed->value[TARGET_ETD], "%.6f"},
                                          {"result_error[1]", observed->error[TARGET_ETD], "%.3g"},
                                          {"time[ps]", picoseconds, "%.6g"},
                                          {"r0[nm]", nanometres, "%.6g"}};
    mf_run_folder_file(folder, "etd_cells.tsv", path);
    CHECK(mf_data_table_write_in(path, &fit->scene.units, NULL, columns, known ? 8 : 6, cells));
done:
    mf_memory_free(time);
    mf_memory_free(r);
    mf_memory_free(picoseconds);
    mf_memory_free(nanometres);
    return status;
}

/// What the columns of a curve's table are called in nm and ps, of which `factor` makes reduced
/// units; 0: it has none of them.
struct physical_unit {
    const char *columns[4];
    double factor;
};

static struct physical_unit physical_unit(enum target_kind kind, const struct units *units) {
    const double nm2 = units->length * units->length;
    if (!mf_units_beside(units) || (kind != TARGET_MSD && kind != TARGET_VACF))
        return (struct physical_unit){0};
    if (kind == TARGET_MSD)
        return (struct physical_unit){
            {"target[nm^2]", "target_error[nm^2]", "result[nm^2]", "result_error[nm^2]"}, nm2};
    const double ps = mf_units_time_ps(units);
    return (struct physical_unit){{"target[nm^2/ps^2]", "target_error[nm^2/ps^2]",
                                   "result[nm^2/ps^2]", "result_error[nm^2/ps^2]"},
                                  nm2 / (ps * ps)};
}

/// A curve beside its target: x, target, result, each with its error; VACF and MSD also in nm, ps.
static enum status write_curve(const struct fit_file *fit, enum target_kind kind,
                               const struct observed *observed, const struct run_folder *folder) {
    enum status status = STATUS_OK;
    static const char *const words[4] = {"target", "target_error", "result", "result_error"};
    const struct observable_target *about = mf_observable_kind(kind).target;
    const struct target_curve *target = &fit->files.curve[kind];
    const struct physical_unit unit = physical_unit(kind, &fit->scene.units);
    const double *const values[4] = {target->value, target->error, observed->value[kind],
                                     observed->error[kind]};
    double *x = NULL, *picoseconds = NULL, *physical[4] = {NULL};
    char path[OUTPUT_PATH_SIZE], name[64], names[4][64];
    struct data_column columns[10];
    NEW_ARRAY(x, target->points);
    for (size_t k = 0; k < target->points; k++)
        x[k] = target->interval > 0 ? (double)k * target->interval : target->x[k];
    picoseconds = mf_units_column(x, target->points,
                                  unit.factor > 0 ? mf_units_time_ps(&fit->scene.units) : 0);
    CHECK(picoseconds ? STATUS_OK : STATUS_NO_MEMORY);
    columns[0] = (struct data_column){about->argument, x, NULL};
    columns[5] = (struct data_column){"time[ps]", picoseconds, NULL};
    for (int k = 0; k < 4; k++) {
        const char *format = k % 2 ? "%.3g" : "%.8g";
        physical[k] = mf_units_column(values[k], target->points, unit.factor);
        CHECK(physical[k] ? STATUS_OK : STATUS_NO_MEMORY);
        snprintf(names[k], sizeof names[k], "%s[%s]", words[k], about->unit);
        columns[1 + k] = (struct data_column){names[k], values[k], format};
        columns[6 + k] = (struct data_column){unit.columns[k], physical[k], format};
    }
    snprintf(name, sizeof name, "%s.tsv", about->name);
    mf_run_folder_file(folder, name, path);
    CHECK(mf_data_table_write_in(path, &fit->scene.units, NULL, columns, unit.factor > 0 ? 10 : 5,
                                 target->points));
done:
    mf_memory_free(x);
    mf_memory_free(picoseconds);
    for (int k = 0; k < 4; k++)
        mf_memory_free(physical[k]);
    return status;
}

/// p of a group beside its target: bond_lengths_backbone.tsv.
static enum status write_distribution(const struct fit_file *fit,
                                      const struct target_groups *groups, size_t g,
                                      const struct observed *observed,
                                      const struct run_folder *folder) {
    enum status status = STATUS_OK;
    static const char *const words[4] = {"target", "target_error", "result", "result_error"};
    const int kind = mf_bonded_distribution_kind(groups->order);
    const struct observable_target *about = mf_observable_kind(kind).target;
    const struct bonded_bins *bins = &groups->member[g].bins;
    const size_t first = groups->first[g];
    const double *const values[4] = {groups->value + first, groups->error + first,
                                     observed->value[kind] + first, observed->error[kind] + first};
    double *q = NULL;
    char path[OUTPUT_PATH_SIZE], name[128], names[4][64];
    struct data_column columns[5];
    NEW_ARRAY(q, bins->count);
    for (size_t k = 0; k < bins->count; k++)
        q[k] = bonded_bins_centre(bins, k);
    columns[0] = (struct data_column){about->argument, q, NULL};
    for (int k = 0; k < 4; k++) {
        snprintf(names[k], sizeof names[k], "%s[%s]", words[k], about->unit);
        columns[1 + k] = (struct data_column){names[k], values[k], k % 2 ? "%.3g" : "%.8g"};
    }
    snprintf(name, sizeof name, "%s_%s.tsv", about->name, groups->name[g]);
    mf_run_folder_file(folder, name, path);
    CHECK(mf_data_table_write_in(path, &fit->scene.units, NULL, columns, 5, bins->count));
done:
    mf_memory_free(q);
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
    const struct target_files *files = &fit->files;
    const struct observed *observed = &verification->observed;
    for (size_t pair = 0; pair < files->rdf.pairs; pair++)
        if (mf_composition_has_pairs(&files->composition, (int)pair))
            TRY(write_rdf(fit, &files->rdf, TARGET_RDF, observed, pair, folder));
    for (size_t pair = 0; pair < files->apart.pairs; pair++)
        if (mf_composition_has_pairs(&files->composition, (int)pair))
            TRY(write_rdf(fit, &files->apart, mf_rdf_intermolecular_kind(), observed, pair,
                          folder));
    if (files->given[TARGET_ETD])
        TRY(write_etd(fit, observed, folder));
    for (int order = 0; order < BONDED_KINDS; order++)
        for (size_t g = 0; g < files->groups[order].groups; g++)
            if (files->groups[order].member[g].bins.count > 0)
                TRY(write_distribution(fit, &files->groups[order], g, observed, folder));
    for (int kind = 0; kind < TARGETS; kind++)
        if (files->curve[kind].points > 0)
            TRY(write_curve(fit, kind, observed, folder));
    return write_configuration(fit, verification, folder);
}
