// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_output.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "observe/measure.h"

#include <math.h>

bool mf_measure_tables_have_motion(const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    return motion->begun && mf_motion_blocks(&motion->motion) > 0;
}

bool mf_measure_tables_have_etd(const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    return motion->begun && mf_etd_pairs(&motion->etd) > 0;
}

/// What the records of observables want to know of the system.
static struct simulation_setup make_setup(const struct measure_result *result) {
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

/// forces.tsv and forces_gram.tsv.
static enum status write_forces(const struct measure_result *result) {
    const struct force_equations *const equations = &result->measured->forces.equations;
    char file[OUTPUT_PATH_SIZE], gram[OUTPUT_PATH_SIZE];
    if (equations->frames == 0)
        return STATUS_OK;
    snprintf(file, sizeof file, "%.*s/forces.tsv", OUTPUT_PATH_SIZE - 64, result->folder);
    snprintf(gram, sizeof gram, "%.*s/forces_gram.tsv", OUTPUT_PATH_SIZE - 64, result->folder);
    return mf_force_equations_write(equations, file, gram);
}

enum status mf_measure_tables_write(const struct measure_result *result) {
    const struct simulation_setup setup = make_setup(result);
    const struct measure_plan plan = {.samples = (int64_t)result->measured->frames};
    const struct observable_results results = {&setup, &plan, &result->units, result->folder,
                                               result->measured->use};
    if (!result->measured->in_vacuum && result->measured->plan.weighted.cutoff > 0)
        TRY(mf_weighted_density_write(&result->measured->weighted, &results));
    for (const struct observable_use *use = result->measured->use; use->observable; use++)
        TRY(use->observable->write(use->state, &results));
    if (mf_measure_tables_have_motion(result))
        TRY(write_motion(result));
    TRY(write_forces(result));
    return mf_measure_tables_have_etd(result)
               ? mf_etd_observable.write(&result->measured->motion.etd, &results)
               : STATUS_OK;
}

// The scene of a target ---------------------------------------------------------------------------

/// Beads that a fit simulates well.
enum { MAX_BEADS = 4000 };

/// Beads that are in no molecule.
static struct composition find_single(const struct measure_result *result) {
    struct composition single = result->measured->pairs.composition;
    const struct topology *const topology = &result->kinds->molecules.topology;
    for (int k = 0; k < topology->kinds; k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            single.count[topology->kind[k].type[bead]] -= topology->kind[k].count;
    return single;
}

static void write_types(const struct composition *composition, double share,
                        struct json_writer *writer) {
    mf_json_begin(writer, "types");
    for (int type = 0; type < composition->types; type++)
        if (composition->count[type] > 0)
            mf_json_write_integer(writer, composition->name[type],
                                  (int64_t)ceil(share * (double)composition->count[type]));
    mf_json_end(writer);
}

/// Molecules that do not see each other are as many as a fit simulates well, in a box that is wide
/// beside their bonds.
enum { ALONE_BEADS = 1000 };

static double share_of_alone(const struct measure_result *result) {
    return fmax(1, ALONE_BEADS / (double)result->mapping->beads);
}

static enum status write_wide_box(const struct measure_result *result, struct json_writer *writer) {
    static const double bonds = 3;
    const struct molecules *const molecules = &result->kinds->molecules;
    double longest = 0, edge[3];
    for (int g = 0; g < molecules->groups[BONDED_BOND]; g++) {
        struct bonded_moments found;
        TRY(mf_measured_moments(result->measured, BONDED_BOND, g, &found));
        longest = fmax(longest, found.mean);
    }
    const double beads = share_of_alone(result) * (double)result->mapping->beads;
    for (int d = 0; d < 3; d++)
        edge[d] = bonds * (longest > 0 ? longest : 1) * cbrt(beads);
    mf_json_write_quantities(writer, "box", "lambda", edge, 3);
    return STATUS_OK;
}

/// The part of all that a fit simulates well; all, if there are so few of anything that the
/// composition would be another one.
static double find_share(const struct measure_result *result, const struct composition *single) {
    static const double max_change = 0.02;
    const struct topology *const topology = &result->kinds->molecules.topology;
    const double beads = (double)mf_composition_particles(&result->measured->pairs.composition);
    const double share = fmin(1, MAX_BEADS / beads), fewest = 1 / (share * max_change);
    for (int k = 0; k < topology->kinds; k++)
        if (topology->kind[k].count > 0 && (double)topology->kind[k].count < fewest)
            return 1;
    for (int type = 0; type < single->types; type++)
        if (single->count[type] > 0 && (double)single->count[type] < fewest)
            return 1;
    return share;
}

/// Molecules, and the single beads beside them.
static void write_molecules_of_scene(const struct measure_result *result,
                                     struct json_writer *writer) {
    const struct composition *const all = &result->measured->pairs.composition;
    const struct composition single = find_single(result);
    const double share =
        mf_measure_output_is_alone(result) ? share_of_alone(result) : find_share(result, &single);
    mf_scene_kinds_write(result->kinds, all, share, writer);
    if (mf_composition_particles(&single) == 0 && isnan(mf_measure_output_mass(result, 0)))
        return;
    mf_json_begin(writer, "particles");
    if (mf_composition_particles(&single) > 0)
        write_types(&single, share, writer);
    mf_measure_output_write_masses(result, writer);
    mf_json_end(writer);
}

/// A mixture is given by the numbers of its beads, of no more of them than a fit simulates well.
static void write_particles(const struct measure_result *result, struct json_writer *writer) {
    const struct composition *const all = &result->measured->pairs.composition;
    const int64_t beads = mf_composition_particles(all);
    const struct composition some =
        mf_composition_scaled(all, beads < MAX_BEADS ? beads : MAX_BEADS);
    if (!composition_is_mixed(all) && isnan(mf_measure_output_mass(result, 0)))
        return;
    mf_json_begin(writer, "particles");
    if (composition_is_mixed(all))
        write_types(&some, 1, writer);
    mf_measure_output_write_masses(result, writer);
    mf_json_end(writer);
}

enum status mf_measure_scene_write(const struct measure_result *result,
                                   struct json_writer *writer) {
    const double temperature = mf_measure_output_temperature(result);
    mf_json_begin(writer, "scene");
    if (mf_measure_output_is_alone(result))
        TRY(write_wide_box(result, writer));
    else
        mf_json_write_quantity(writer, "density", "1/lambda^3", mf_measure_output_density(result));
    if (result->kinds)
        write_molecules_of_scene(result, writer);
    else
        write_particles(result, writer);
    if (!isnan(temperature))
        mf_json_write_number(writer, "temperature", temperature);
    mf_json_end(writer);
    return STATUS_OK;
}
