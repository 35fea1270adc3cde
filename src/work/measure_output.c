// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_output.h"

#include "io/json_write.h"
#include "io/units.h"
#include "base/memory.h"
#include "base/statistics.h"
#include "base/version.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"
#include "problem/targets.h"

#include <math.h>

/// The digest of a file's frames, as a text: not every reader of JSON knows integers of 64 bits.
static void write_digest(struct json_writer *writer, uint64_t digest) {
    char text[24];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)digest);
    mf_json_write_text(writer, "digest", text);
}

/// "trajectories": {"1": {"file": …, "bytes": …, …}, "2": …}
static void write_trajectories(const struct measure_result *result, struct json_writer *writer) {
    mf_json_begin(writer, "trajectories");
    for (size_t k = 0; k < result->request->frames.files; k++) {
        const struct frames_source *const source = &result->frames->source[k];
        char number[24];
        snprintf(number, sizeof number, "%zu", k + 1);
        mf_json_begin(writer, number);
        mf_json_write_text(writer, "file", result->request->frames.file[k]);
        mf_json_write_integer(writer, "bytes", (int64_t)source->bytes);
        mf_json_write_integer(writer, "frames", (int64_t)source->read);
        mf_json_write_integer(writer, "frames_used", (int64_t)source->used);
        mf_json_write_integer(writer, "frames_doubled", (int64_t)source->doubled);
        write_digest(writer, source->digest);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

static enum status write_json(const struct measure_result *result, const char *name,
                              struct json_writer *writer) {
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.*s/%s", OUTPUT_PATH_SIZE - 64, result->folder, name);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}

/// Number density of all beads [1/nm³].
double mf_measure_output_density(const struct measure_result *result) {
    const struct box box = mf_measured_box(result->measured);
    return (double)result->mapping->beads / mf_box_volume(&box);
}

double mf_measure_output_temperature_scatter(const struct measure_result *result) {
    const double frames = (double)result->measured->motion.temperature.count;
    return sqrt(2 / (3 * (double)result->mapping->beads * frames));
}

/// [K]: as given, or the kinetic one; NAN if neither is known, or one frame alone tells it, and not
/// well.
double mf_measure_output_temperature(const struct measure_result *result) {
    static const double tolerance = 0.03;
    const double given = result->request->temperature;
    const struct measured_motion *const motion = &result->measured->motion;
    const bool vague =
        motion->temperature.count < 2 && mf_measure_output_temperature_scatter(result) > tolerance;
    if (!isnan(given) || !motion->is_thermal || vague)
        return given;
    return mf_measured_mean(&motion->temperature, NULL);
}

/// Mean mass of a type's beads [u]; NAN if it is not known.
double mf_measure_output_mass(const struct measure_result *result, int type) {
    const struct mapping *const mapping = result->mapping;
    struct running_mean mean = {0};
    for (size_t k = 0; k < mapping->beads; k++)
        if (mapping->bead[k].type == (size_t)type)
            mf_statistics_add(&mean, mapping->bead[k].mass);
    return mean.mean;
}

bool mf_measure_output_masses_may_differ(const struct measure_result *result) {
    const int types = result->measured->pairs.composition.types;
    bool differ = false;
    for (int type = 1; type < types; type++)
        differ = differ ||
                 !(fabs(mf_measure_output_mass(result, type) / mf_measure_output_mass(result, 0) -
                        1) <= 1e-9);
    return differ;
}

bool mf_measure_output_is_alone(const struct measure_result *result) {
    const struct topology *const topology =
        result->kinds ? &result->kinds->molecules.topology : NULL;
    return result->measured->in_vacuum ||
           (topology && topology->molecules == 1 && topology->kind[0].count == 1 &&
            (size_t)topology->kind[0].beads == result->mapping->beads);
}

// summary.json ------------------------------------------------------------------------------------

static void write_density(const struct measure_result *result, struct json_writer *writer) {
    double error;
    const double mean = mf_measured_mean(&result->measured->volume, &error);
    const double density = mf_measure_output_density(result);
    mf_json_put_measured(writer, "density", "1/lambda^3", density, density * error / mean);
    mf_json_write_quantity(writer, "volume", "lambda^3", mean);
}

/// Share of all pairs that g(r) of one type leaves out: those that molecules exclude, which count
/// as possible, or those of one residue, which do not.
static double share_inside(const struct measured *measured) {
    static const int type[2] = {0, 0};
    const struct molecules *const molecules = measured->molecules.molecules;
    if (molecules == NULL)
        return 1 - measured->share[0];
    return mf_topology_intramolecular_pairs(&molecules->topology, type, true) / 2 /
           mf_composition_possible_pairs(&measured->pairs.composition, 0);
}

/// Kirkwood and Buff's integral of what is of one type.
static enum status write_kirkwood_buff(const struct measure_result *result,
                                       struct json_writer *writer) {
    const struct rdf *const rdf = mf_measured_rdf(result->measured);
    const struct box box = mf_measured_box(result->measured);
    OWNED double *g = NULL, *error = NULL;
    if (composition_is_mixed(&rdf->composition))
        return STATUS_OK;
    TRY_ARRAY(g, rdf->bins.count);
    TRY_ARRAY(error, rdf->bins.count);
    TRY(mf_rdf_result(rdf, 1, g, error));
    const double inside = mf_box_volume(&box) * share_inside(result->measured);
    const bool possible = result->measured->molecules.molecules != NULL;
    struct kirkwood_buff found = mf_kirkwood_buff_known(&rdf->bins, g, error, &box,
                                                        rdf->particle_count, possible ? inside : 0);
    if (!possible) { // their g is higher as a whole, and its tail that of G without them
        found.integral += inside;
        found.compressibility += mf_measure_output_density(result) * inside;
    }
    mf_json_put_measured(writer, "kirkwood_buff", "lambda^3", found.integral, found.integral_error);
    mf_json_put_measured(writer, "compressibility", "1", found.compressibility,
                         found.compressibility_error);
    return STATUS_OK;
}

static void write_temperature(const struct measure_result *result, struct json_writer *writer) {
    const struct sample_series *const series = &result->measured->motion.temperature;
    if (series->count == 0 || !result->measured->motion.is_thermal)
        return;
    double error;
    const double mean = mf_measured_mean(series, &error);
    mf_json_put_measured(writer, "temperature", "1", mean, error);
}

/// D by the MSD, and by the VACF if there is one.
static void write_diffusion(const struct measure_result *result, struct json_writer *writer) {
    const double unit = mf_units_diffusion_cm2_per_s(&result->units);
    char early[MOTION_EARLY_SIZE];
    if (!mf_measure_tables_have_motion(result))
        return;
    struct motion_summary s = mf_motion_result(&result->measured->motion.motion, NULL);
    mf_statistics_mark_unknown_errors(&s.msd_error, 1);
    if (mf_motion_is_early(&s))
        mf_json_write_text(writer, "diffusion_warning", mf_motion_early_text(&s, early));
    mf_json_put_measured(writer, "diffusion", "lambda^2/tau", s.msd, s.msd_error);
    mf_json_write_number(writer, "diffusion_cm2_per_s", s.msd * unit);
    mf_json_write_number(writer, "diffusion_error_cm2_per_s", s.msd_error * unit);
    mf_json_write_quantity(writer, "diffusion_fit_begin", "tau", s.fit_begin);
    mf_json_write_quantity(writer, "diffusion_fit_end", "tau", s.fit_end);
    if (!result->measured->motion.has_vacf)
        return;
    const double error = mf_motion_green_kubo_uncertainty(&s);
    mf_json_put_measured(writer, "diffusion_green_kubo", "lambda^2/tau", s.green_kubo, error);
    mf_json_write_number(writer, "diffusion_green_kubo_cm2_per_s", s.green_kubo * unit);
    mf_json_write_number(writer, "diffusion_green_kubo_error_cm2_per_s", error * unit);
}

/// What is measured of time.
static void write_motion(const struct measure_result *result, struct json_writer *writer) {
    const struct measured_motion *const motion = &result->measured->motion;
    if (!motion->begun)
        return;
    mf_json_write_quantity(writer, "interval", "tau", motion->interval);
    mf_json_write_quantity(writer, "window", "tau",
                           (double)motion->motion.plan.lags * motion->interval);
    write_temperature(result, writer);
    write_diffusion(result, writer);
}

void mf_measure_output_write_masses(const struct measure_result *result,
                                    struct json_writer *writer) {
    const struct composition *const composition = &result->measured->pairs.composition;
    const bool mixed = composition_is_mixed(composition);
    if (isnan(mf_measure_output_mass(result, 0)))
        return;
    if (!mixed) {
        mf_json_write_quantity(writer, "mass", "mu", mf_measure_output_mass(result, 0));
        return;
    }
    mf_json_begin(writer, "mass");
    for (int type = 0; type < composition->types; type++)
        mf_json_write_quantity(writer, composition->name[type], "mu",
                               mf_measure_output_mass(result, type));
    mf_json_end(writer);
}

static void write_observables(const struct measure_result *result, struct json_writer *writer) {
    const struct observable_results results = {.units = &result->units};
    const struct observable_use *use = result->measured->use;
    for (; use->observable; use++)
        if (use->observable->write_summary)
            use->observable->write_summary(use->state, &results, writer);
}

static enum status write_summary(const struct measure_result *result) {
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_text(writer, "status",
                       mf_status_name(result->interrupted ? STATUS_INTERRUPTED : STATUS_OK));
    mf_json_write_text(writer, "method", "measure");
    if (result->drift[0])
        mf_json_write_text(writer, "warning", result->drift);
    mf_units_write_summary(&result->units, writer);
    mf_json_write_number(writer, "seconds", result->seconds);
    mf_json_write_integer(writer, "frames", (int64_t)result->measured->frames);
    mf_json_write_integer(writer, "frames_left_out", (int64_t)result->frames->skipped);
    mf_json_write_integer(writer, "particles", (int64_t)result->mapping->beads);
    mf_measure_output_write_masses(result, writer);
    if (!result->measured->in_vacuum)
        write_density(result, writer);
    write_motion(result, writer);
    write_observables(result, writer);
    if (result->measured->plan.weighted.cutoff > 0 && !result->measured->in_vacuum)
        mf_weighted_density_write_summary(&result->measured->weighted, writer);
    const enum status status =
        result->measured->in_vacuum ? STATUS_OK : write_kirkwood_buff(result, writer);
    if (status != STATUS_OK) {
        mf_json_writer_free(writer);
        return status;
    }
    write_trajectories(result, writer);
    mf_json_write_text(writer, "version", mf_version);
    return write_json(result, "summary.json", writer);
}

// target.json -------------------------------------------------------------------------------------

static void write_rdf_file(const struct measure_result *result, struct json_writer *writer,
                           const char *file) {
    mf_json_write_text(writer, "file", file);
    mf_json_write_integer(writer, "particles", (int64_t)result->mapping->beads);
}

static void write_rdf(const struct measure_result *result, struct json_writer *writer) {
    const struct composition *const composition = &result->measured->pairs.composition;
    mf_json_begin(writer, "rdf");
    if (!composition_is_mixed(composition))
        write_rdf_file(result, writer, "rdf.tsv");
    for (int pair = 0;
         composition_is_mixed(composition) && pair < mf_composition_pairs(composition); pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE], file[COMPOSITION_PAIR_NAME_SIZE + 16];
        if (!mf_composition_has_pairs(composition, pair))
            continue;
        mf_composition_pair_name(composition, pair, name);
        snprintf(file, sizeof file, "rdf_%s.tsv", name);
        mf_json_begin(writer, name);
        write_rdf_file(result, writer, file);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

/// Friction is found for single beads of one mass: motion of others is compared with, and not
/// fitted.
static void write_fitted(const struct measure_result *result, struct json_writer *writer) {
    if (result->kinds || mf_measure_output_masses_may_differ(result))
        mf_json_write_text(writer, "fitted", "no");
}

static void write_curve(const struct measure_result *result, struct json_writer *writer,
                        const char *name, const char *file) {
    mf_json_begin(writer, name);
    write_fitted(result, writer);
    mf_json_write_text(writer, "file", file);
    mf_json_end(writer);
}

static void write_etd(const struct measure_result *result, struct json_writer *writer) {
    mf_json_begin(writer, "etd");
    write_fitted(result, writer);
    mf_json_write_text(writer, "file", "etd.tsv");
    mf_json_write_text(writer, "error_file", "etd_error.tsv");
    mf_json_end(writer);
}

static void write_diffusion_target(const struct measure_result *result,
                                   struct json_writer *writer) {
    struct motion_summary s = mf_motion_result(&result->measured->motion.motion, NULL);
    if (!isfinite(s.msd_error)) // of too few frames
        return;
    mf_json_begin(writer, "diffusion");
    mf_json_write_text(writer, "fitted", "no");
    mf_json_write_quantity(writer, "value", "lambda^2/tau", s.msd);
    mf_json_write_quantity(writer, "error", "lambda^2/tau", s.msd_error);
    mf_json_end(writer);
}

/// "bond_lengths": {"backbone": {"file": "bond_lengths.tsv"}} and so on.
static void write_groups(const struct measure_result *result, struct json_writer *writer) {
    const struct molecules *const molecules = &result->kinds->molecules;
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct observable *observable = mf_bonded_distribution_of(order);
        if (molecules->groups[order] > 0)
            mf_json_begin(writer, observable->name);
        for (int g = 0; g < molecules->groups[order]; g++) {
            mf_json_begin(writer, molecules->group[order][g].name);
            mf_json_write_text(writer, "file", observable->files[0]);
            mf_json_end(writer);
        }
        if (molecules->groups[order] > 0)
            mf_json_end(writer);
    }
}

static void write_motion_targets(const struct measure_result *result, struct json_writer *writer) {
    if (mf_measure_tables_have_etd(result))
        write_etd(result, writer);
    if (!mf_measure_tables_have_motion(result))
        return;
    if (result->measured->motion.has_vacf)
        write_curve(result, writer, "vacf", "vacf.tsv");
    write_curve(result, writer, "msd", "msd.tsv");
    write_diffusion_target(result, writer);
}

/// With the settings of its observable, in the folder's units.
static void write_weighted(const struct measure_result *result, struct json_writer *writer) {
    if (result->measured->plan.weighted.cutoff == 0)
        return;
    mf_json_begin(writer, mf_weighted_density.name);
    mf_json_write_text(writer, "fitted", "no");
    mf_json_write_fields(writer, mf_weighted_density_fields, &result->measured->weighted.settings);
    mf_json_write_text(writer, "file", mf_weighted_density.files[0]);
    mf_json_end(writer);
}

/// What --forces has measured, for "force-matching".
static void write_forces(const struct measure_result *result, struct json_writer *writer) {
    if (result->measured->forces.equations.frames == 0)
        return;
    mf_json_begin(writer, "forces");
    mf_json_write_text(writer, "file", "forces.tsv");
    mf_json_write_text(writer, "gram_file", "forces_gram.tsv");
    mf_json_end(writer);
}

static void write_targets(const struct measure_result *result, struct json_writer *writer) {
    mf_json_begin(writer, "target");
    if (!mf_measure_output_is_alone(result))
        write_rdf(result, writer);
    if (result->kinds)
        write_groups(result, writer);
    if (!mf_measure_output_is_alone(result))
        write_motion_targets(result, writer);
    if (!mf_measure_output_is_alone(result))
        write_weighted(result, writer);
    write_forces(result, writer);
    mf_json_end(writer);
}

static enum status write_target(const struct measure_result *result) {
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_text(writer, "title", result->request->frames.file[0]);
    mf_json_write_text(writer, "units", mf_units_systems[result->units.system]);
    mf_json_writer_set_units(writer, &result->units);
    write_targets(result, writer);
    const enum status status = mf_measure_scene_write(result, writer);
    if (status == STATUS_OK)
        return write_json(result, "target.json", writer);
    mf_json_writer_free(writer);
    return status;
}

static enum status write_used(const struct measure_result *result) {
    const struct measured_plan *const plan = &result->measured->plan;
    const struct units *const units = &result->units;
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_text(writer, "units", mf_units_systems[units->system]);
    mf_json_writer_set_units(writer, units);
    write_trajectories(result, writer);
    mf_json_write_number(writer, "range", mf_units_factor(units, "lambda") * plan->range);
    mf_json_write_integer(writer, "bins", plan->bins);
    mf_json_write_number(writer, "q_maximum",
                         mf_units_factor(units, "1/lambda") * plan->waves.q_maximum);
    mf_json_write_integer(writer, "waves", plan->waves.waves);
    if (plan->profile.bins > 0) {
        mf_json_begin(writer, "density_profile");
        mf_json_write_text(writer, "axis", mf_density_profile_axes[plan->profile.axis]);
        mf_json_write_integer(writer, "bins", plan->profile.bins);
        mf_json_end(writer);
    }
    if (plan->weighted.cutoff > 0) {
        mf_json_begin(writer, mf_weighted_density.name);
        mf_json_write_fields(writer, mf_weighted_density_fields,
                             &result->measured->weighted.settings);
        mf_json_end(writer);
    }
    return write_json(result, "used.json", writer);
}

enum status mf_measure_output_write(const struct measure_result *result) {
    TRY(write_used(result));
    TRY(mf_measure_tables_write(result));
    TRY(write_target(result));
    return write_summary(result);
}
