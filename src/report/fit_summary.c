// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/version.h"
#include "observe/kirkwood_buff.h"
#include "problem/parametrisation.h"
#include "report/fit_output.h"
#include "report/fit_report.h"
#include "report/fit_verification.h"

#include <math.h>
#include <stdio.h>

/// Put "changed", what a person has, a list, if there is anything.
static void write_dampings(const struct fit_dampings *changes, struct json_writer *writer) {
    if (changes->count == 0)
        return;
    mf_json_begin_list(writer, "changed");
    for (size_t k = 0; k < changes->count; k++) {
        mf_json_begin(writer, NULL);
        mf_json_write_integer(writer, "iteration", (int64_t)changes->change[k].iteration);
        mf_json_write_number(writer, "damping", changes->change[k].damping);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

/// How far the fitted potential of a pair type is from the known true one, over the bins with a
/// target above 0.1.
struct fit_truth {
    double rms;              ///< of Φ − Φ_true [k_B T_0]
    double ramp;             ///< A of the ramp A(1 − r/r_c) that explains most of it [k_B T_0]
    double rms_without_ramp; ///< of what is left
};

static struct fit_truth find_truth(const struct fit_file *fit, const struct unknowns *unknowns,
                                   const double *phi, size_t pair) {
    const struct potential_grid *grid = &unknowns->potential;
    const struct curve *curve =
        mf_scene_law_curve(&fit->unknown[UNKNOWN_POTENTIAL].truth, (int)pair);
    double count = 0, squares = 0, with_ramp = 0, ramp_squares = 0;
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const size_t point = grid->known_point[n];
        if (point / (grid->bins + 1) != pair || !grid->well_known[n])
            continue;
        const double difference = phi[point] - mf_curve_value(curve, grid->r[point]);
        const double ramp = mf_potential_grid_ramp(grid, point);
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

/// rms of ω − ω_true over the points that the data can see, relative to the largest ω_true.
static double omega_truth(const struct fit_file *fit, const struct unknowns *unknowns,
                          enum unknown_kind kind, const double *omega) {
    double squares = 0, largest = 0, count = 0;
    // Between the cutoffs, at which a friction weight may end in a step.
    for (size_t k = 1; k + 1 < OMEGA_POINTS; k++) {
        const double r = unknowns->omega[kind].r[k];
        const double truth = mf_curve_value(mf_scene_law_curve(&fit->unknown[kind].truth, 0), r);
        largest = fmax(largest, truth);
        // Closer pairs than the target follows do not exist.
        if (fit->files.given[TARGET_ETD] && r < target_files_etd(&fit->files)->grid.r_minimum)
            continue;
        squares += (omega[k] - truth) * (omega[k] - truth);
        count += 1;
    }
    return sqrt(squares / count) / largest;
}

/// A number that is not known is left out.
static void write_known(struct json_writer *writer, const char *key, double value) {
    if (isfinite(value))
        mf_json_write_number(writer, key, value);
}

static void write_quantity(struct json_writer *writer, const char *key, const char *unit,
                           double value) {
    if (isfinite(value))
        mf_json_write_quantity(writer, key, unit, value);
}

/// One sample tells no error.
static double known_error(double error) {
    return error > 0 ? error : NAN;
}

/// Integrals of Kirkwood and Buff, those of the target and of the result.
static void write_integrals(struct json_writer *writer, const struct fit_file *fit,
                            const struct verification *v) {
    const int kind = mf_kirkwood_buff_kind();
    const struct composition *components = &target_files_kirkwood_buff(&fit->files)->components;
    const struct target *target = &fit->problem.compared.target[kind];
    for (size_t pair = 0; pair < target->count; pair++) {
        mf_kirkwood_buff_write(writer, "target_kirkwood_buff", components, pair,
                               target->value[pair], target->error[pair]);
        mf_kirkwood_buff_write(writer, "kirkwood_buff", components, pair,
                               v->observed.value[kind][pair], v->observed.error[kind][pair]);
    }
}

/// Kirkwood and Buff's integral of a g(r), and S(0) with it, at a density, or that of the scene.
static void write_integral(struct json_writer *writer, const struct fit_file *fit, const char *of,
                           const double *g, const double *error, const double *density) {
    const double count = (double)fit->scene.setup.placement.count;
    const struct box box = density ? mf_box_cube(count / *density) : fit->scene.setup.box;
    const struct kirkwood_buff found = mf_kirkwood_buff_known(
        target_pairs_bins(target_files_rdf(&fit->files)), g, error, &box, (size_t)count, 0);
    const double value[] = {found.integral, found.integral_error, found.compressibility,
                            found.compressibility_error};
    static const char *const name[] = {"kirkwood_buff", "kirkwood_buff_error", "compressibility",
                                       "compressibility_error"};
    for (int k = 0; k < 4; k++) {
        char key[40];
        snprintf(key, sizeof key, "%s%s", of, name[k]);
        write_quantity(writer, key, k < 2 ? "lambda^d" : "1", value[k]);
    }
}

/// Those of the g(r) of target and result, in three dimensions and of beads that are alike: each at
/// its density, where that is a target, else at that of the scene.
static void write_compressibility(struct json_writer *writer, const struct fit_file *fit,
                                  const struct verification *v) {
    const struct target *density = &fit->problem.compared.target[TARGET_DENSITY];
    const bool held = density->count == 0; // by the box
    if (!fit->files.given[TARGET_RDF] || fit->scene.setup.box.dimensions != 3 ||
        composition_is_mixed(&fit->scene.setup.composition) ||
        scene_has_molecules(&fit->scene.molecules))
        return;
    write_integral(writer, fit, "target_", target_files_rdf(&fit->files)->g,
                   target_files_rdf(&fit->files)->error, held ? NULL : density->value);
    write_integral(writer, fit, "", v->observed.value[TARGET_RDF], v->observed.error[TARGET_RDF],
                   held ? NULL : v->observed.value[TARGET_DENSITY]);
}

/// "etd_rmse", "etd_rmse_error", "etd_noise", and so on for every target.
static void write_distances(struct json_writer *writer, const struct fit_file *fit,
                            const struct verification *v) {
    char key[64];
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!fit->files.given[kind])
            continue;
        const char *own = mf_observable_kind(kind).target->unit, *unit = own ? own : "";
        snprintf(key, sizeof key, "%s_rmse", mf_targets_name(kind));
        write_quantity(writer, key, unit, v->distance[kind].rms);
        snprintf(key, sizeof key, "%s_rmse_error", mf_targets_name(kind));
        write_quantity(writer, key, unit, v->distance_error[kind]);
        snprintf(key, sizeof key, "%s_noise", mf_targets_name(kind));
        mf_json_write_quantity(writer, key, unit, v->distance[kind].noise);
    }
}

static void write_diffusion(struct json_writer *writer, const struct fit_file *fit,
                            const struct verification *v) {
    const struct units *units = &fit->scene.units;
    if (!targets_ask(&fit->problem.compared, TARGET_DIFFUSION))
        return;
    const double value = *v->observed.value[TARGET_DIFFUSION];
    const double error = *v->observed.error[TARGET_DIFFUSION];
    write_quantity(writer, "diffusion", "lambda^2/tau", value);
    if (error > 0) // one replica of one window has none
        write_quantity(writer, "diffusion_error", "lambda^2/tau", error);
    mf_json_write_quantity(writer, "diffusion_fit_begin", "tau", v->diffusion_begin);
    mf_json_write_quantity(writer, "diffusion_fit_end", "tau", v->diffusion_end);
    if (mf_units_known(units)) {
        const double unit = mf_units_diffusion_cm2_per_s(units);
        mf_json_write_number(writer, "diffusion_cm2_per_s", value * unit);
        if (error > 0)
            write_known(writer, "diffusion_error_cm2_per_s", error * unit);
    }
}

/// What part of a curve's variance its widest direction is, and of a potential's how much of that
/// is the ramp 1 − r/r_c, which moves the pressure and hardly g(r).
static void write_flat(struct json_writer *writer, enum unknown_kind kind,
                       const struct unknowns *unknowns, const struct fit_result *result) {
    const size_t points = mf_unknowns_points(unknowns, kind);
    const double *r = mf_unknowns_r(unknowns, kind), *flat = result->step.curve_flat[kind];
    double all = 0, widest = 0, ramps = 0, product = 0;
    char key[UNKNOWNS_NAME_SIZE + 16], name[UNKNOWNS_NAME_SIZE];
    for (size_t k = 0; flat && k < points; k++) {
        const double ramp = 1 - r[k] / r[points - 1], error = result->step.curve_error[kind][k];
        if (!isfinite(flat[k]) || !isfinite(error))
            continue;
        all += error * error;
        widest += flat[k] * flat[k];
        ramps += ramp * ramp;
        product += ramp * flat[k];
    }
    if (!(all > 0))
        return;
    mf_unknowns_kind_name(unknowns, kind, name);
    snprintf(key, sizeof key, "%s_flat_share", name);
    mf_json_write_number(writer, key, fmin(1, widest / all));
    if (kind == UNKNOWN_POTENTIAL)
        mf_json_write_number(writer, "potential_flat_is_ramp",
                             product * product / (widest * ramps));
}

/// What g(r) leaves open.
static void write_ramp(struct json_writer *writer, const struct inverse_ramp *ramp,
                       enum target_kind bulk) {
    if (!(ramp->error > 0))
        return;
    write_quantity(writer, "ramp_error", "k_B T_0", ramp->error);
    if (bulk == TARGET_PRESSURE) {
        write_quantity(writer, "ramp_pressure", "1/lambda^d", ramp->bulk);
        write_quantity(writer, "pressure_left_open", "k_B T_0/lambda^d", ramp->bulk_open);
        if (ramp->bulk_samples > 0) // not known of coefficients
            write_quantity(writer, "pressure_left_open_by_samples", "k_B T_0/lambda^d",
                           ramp->bulk_samples);
    } else
        write_quantity(writer, "density_left_open", "1/lambda^d", ramp->bulk_open);
    write_known(writer, "directions", ramp->directions);
    write_known(writer, "directions_of", ramp->bins);
}

/// What decides how long the samples had to be.
static void write_slowest(struct json_writer *writer, const struct inverse_slowest *slowest) {
    if (slowest->quantity[0] == '\0')
        return;
    mf_json_write_text(writer, "slowest", slowest->quantity);
    mf_json_write_number(writer, "slowest_samples", slowest->independent);
}

static void write_parameter(struct json_writer *writer, const char *name, const char *unit,
                            const struct inverse_parameter *parameter, bool fixed,
                            const char *bound, bool undetermined) {
    mf_json_begin(writer, name);
    write_quantity(writer, "value", unit, parameter->value);
    if (fixed)
        mf_json_write_text(writer, "fixed", "yes");
    else
        write_quantity(writer, "error", unit, parameter->error);
    if (bound)
        mf_json_write_text(writer, "bound", bound);
    if (undetermined)
        mf_json_write_text(writer, "undetermined", "yes");
    mf_json_end(writer);
}

/// "parameters": {"omega": {"sigma": {"value": 3.0, "error": 0.1}, …}, "conservative.a": {"value":
/// 25.1, "error": 0.3}}: of a friction weight that is a formula, and numbers of the scene.
static void write_parameters(struct json_writer *writer, const struct fit_file *fit,
                             const struct fit_result *result) {
    const struct unknown_parameters *p = &fit->unknown[UNKNOWN_OMEGA].parameters;
    const bool formula = fit->unknown[UNKNOWN_OMEGA].wanted && p->shape == INVERSE_CURVE_POWER;
    if (!formula && fit->numbers == 0)
        return;
    mf_json_begin(writer, "parameters");
    if (formula)
        mf_json_begin(writer, mf_inverse_unknown_names[UNKNOWN_OMEGA]);
    for (int k = 0; formula && k < INVERSE_PARAMETERS; k++)
        write_parameter(writer, mf_inverse_fixed_fields[k].name, mf_inverse_fixed_fields[k].unit,
                        &result->step.parameter[k], !isnan(p->fixed[k]),
                        mf_parametrisation_parameter_bound(p, k, result->step.parameter[k].value),
                        false);
    if (formula)
        mf_json_end(writer);
    for (size_t n = 0; n < fit->numbers; n++)
        write_parameter(writer, fit->number[n].name, fit->number[n].unit, &result->step.number[n],
                        false, mf_numbers_bound(&fit->number[n], result->step.number[n].value),
                        mf_numbers_undetermined(&fit->number[n], &result->step.number[n]));
    mf_json_end(writer);
}

/// "start": {"from": "forces", "error": 0.11, "potential": {"change": 0.05, "well": -0.45,
/// "well_at": 0.99}, …}, the first iteration, and what the fit changed by since.
static void write_start(struct json_writer *writer, const struct unknowns *unknowns,
                        const struct fit_result *result) {
    char name[UNKNOWNS_NAME_SIZE];
    mf_json_begin(writer, "start");
    if (result->step.start != INVERSE_START_ONLY)
        mf_json_write_text(writer, "from",
                           result->step.start == INVERSE_START_TARGET_NEARER ? "g(r)" : "forces");
    write_known(writer, "error", result->first_error);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t n = 0; result->first[kind] && n < mf_unknowns_curve_count(unknowns, kind);
             n++) {
            const struct fit_change change = mf_fit_change_find(unknowns, kind, n, result);
            if (isnan(change.rms))
                continue; // that of pairs without g(r) is not looked for
            mf_unknowns_curve_name(unknowns, kind, n, name);
            mf_json_begin(writer, name);
            write_quantity(writer, "change", mf_unknowns_unit(kind), change.rms);
            if (kind == UNKNOWN_POTENTIAL) {
                write_quantity(writer, "well", "k_B T_0", change.first_well);
                write_quantity(writer, "well_at", "lambda", change.first_well_at);
                write_quantity(writer, "well_now", "k_B T_0", change.well);
                write_quantity(writer, "well_now_error", "k_B T_0", change.well_error);
                write_quantity(writer, "well_now_at", "lambda", change.well_at);
            }
            mf_json_end(writer);
        }
    mf_json_end(writer);
}

/// "truth_rms" and so on, in a mixture "truth_rms_A-B".
static void write_potential_truth(struct json_writer *writer, const struct fit_file *fit,
                                  const struct unknowns *unknowns, const double *phi, size_t pair) {
    static const char *const names[] = {"truth_rms", "truth_ramp", "truth_rms_without_ramp"};
    const struct fit_truth truth = find_truth(fit, unknowns, phi, pair);
    const double values[] = {truth.rms, truth.ramp, truth.rms_without_ramp};
    char kind[COMPOSITION_PAIR_NAME_SIZE], key[COMPOSITION_PAIR_NAME_SIZE + 32];
    mf_composition_pair_name(&fit->scene.setup.composition, (int)pair, kind);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(key, sizeof key, "%s%s%s", names[k], kind[0] ? "_" : "", kind);
        write_quantity(writer, key, mf_unknowns_unit(UNKNOWN_POTENTIAL), values[k]);
    }
}

static void write_truth(struct json_writer *writer, const struct fit_file *fit,
                        const struct unknowns *unknowns, const struct fit_result *result) {
    const double *phi = result->step.curve[UNKNOWN_POTENTIAL];
    char name[UNKNOWNS_NAME_SIZE], key[UNKNOWNS_NAME_SIZE + 16];
    for (size_t pair = 0; phi && pair < unknowns->potential.pairs; pair++)
        if (mf_scene_law_curve(&fit->unknown[UNKNOWN_POTENTIAL].truth, (int)pair))
            write_potential_truth(writer, fit, unknowns, phi, pair);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const double *omega = result->step.curve[kind];
        if (!unknown_is_omega(kind) || omega == NULL || fit->unknown[kind].truth.curves == 0)
            continue;
        mf_unknowns_kind_name(unknowns, kind, name);
        snprintf(key, sizeof key, "%s_truth_rms", name);
        write_known(writer, key, omega_truth(fit, unknowns, kind, omega));
    }
}

/// What the targets g(r) were divided by. In a mixture those that the file states are left out.
static void write_normalisation(struct json_writer *writer, const struct fit_file *fit) {
    const struct normalisation *found = &fit->files.normalisation;
    const double given = target_files_rdf(&fit->files)->member[0].parameters.normalisation;
    const bool mixed = composition_is_mixed(&fit->scene.setup.composition);
    if (!fit->files.given[TARGET_RDF])
        return;
    const bool divided = !mixed && given > 0;
    mf_json_put_measured(writer, "normalisation", "1", divided ? given : found->factor,
                         divided ? 0 : found->error);
}

/// "verification_time_step", and what there is to be said of it.
static void write_step(struct json_writer *writer, const struct units *units,
                       const struct verification *v) {
    char text[FIT_STEP_TEXT_SIZE];
    mf_json_write_quantity(writer, "verification_time_step", "tau", v->step.used);
    mf_fit_step_text(v, units, text);
    if (text[0])
        mf_json_write_text(writer, "verification_time_step_note", text);
}

static void write_verification(struct json_writer *writer, const struct fit_file *fit,
                               const struct verification *v) {
    const struct thermodynamics_summary *t = &v->thermodynamics;
    if (v->warning[0])
        mf_json_write_text(writer, "warning", v->warning);
    write_distances(writer, fit, v);
    write_diffusion(writer, fit, v);
    if (targets_ask(&fit->problem.compared, mf_kirkwood_buff_kind()))
        write_integrals(writer, fit, v);
    else
        write_compressibility(writer, fit, v);
    mf_json_put_measured(writer, "temperature", "T_0", t->temperature,
                         known_error(t->temperature_error));
    write_quantity(writer, "temperature_configurational", "T_0", t->temperature_configurational);
    write_quantity(writer, "temperature_configurational_error", "T_0",
                   known_error(t->temperature_configurational_error));
    mf_json_put_measured(writer, "potential_energy", "k_B T_0", t->potential_energy,
                         known_error(t->potential_energy_error));
    mf_json_put_measured(writer, "pressure", "k_B T_0/lambda^d", t->pressure,
                         known_error(t->pressure_error));
    if (targets_ask(&fit->problem.compared, TARGET_DENSITY))
        mf_json_put_measured(writer, "density", "1/lambda^d", t->density, t->density_error);
    write_quantity(writer, "pressure_of_time_step", "k_B T_0/lambda^d", v->shift.pressure);
    write_quantity(writer, "pressure_of_time_step_error", "k_B T_0/lambda^d", v->shift.error);
    if (v->by_engine)
        mf_json_write_text(writer, "verified_by", mf_sampling_engine_kinds[fit->engine.kind]);
    mf_json_write_number(writer, "verification_steps", (double)v->engine_steps);
    write_step(writer, &fit->scene.units, v);
    mf_units_write_results(&fit->scene.units, writer, t->potential_energy, t->pressure);
}

/// "states": {"dilute": {"rdf_rmse": …}, …}: those of the first stand above, too.
static void write_states(struct json_writer *writer, const struct fit_file *fit,
                         const struct verification *verification) {
    if (fit->name[0] == '\0')
        return;
    mf_json_begin(writer, "states");
    for (size_t s = 0; s <= fit->others; s++) {
        const struct fit_file *state = s == 0 ? fit : &fit->other[s - 1];
        mf_json_begin(writer, state->name);
        write_verification(writer, state, &verification[s]);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

enum status mf_fit_output_summary(const struct fit_file *fit, const struct unknowns *unknowns,
                                  const struct fit_result *result,
                                  const struct run_folder *folder) {
    struct json_writer *writer = mf_json_writer_create();
    char path[OUTPUT_PATH_SIZE];
    mf_units_write_summary(&fit->scene.units, writer);
    mf_json_write_text(writer, "status",
                       result->status != STATUS_OK ? mf_status_name(result->status)
                       : result->step.converged    ? "converged"
                                                   : "finished");
    if (result->reason[0])
        mf_json_write_text(writer, "reason", result->reason);
    mf_json_write_text(writer, "method", fit->method->name);
    mf_json_write_text(writer, "method_summary", fit->method->summary);
    if (fit->choices.thermostat)
        mf_json_write_text(writer, "friction", "chosen");
    mf_json_write_number(writer, "seconds", result->seconds);
    mf_json_write_number(writer, "threads", fit->problem.threads);
    mf_json_write_number(writer, "iterations", result->step.iteration + 1.0);
    mf_json_write_number(writer, "evaluations", (double)result->step.evaluations);
    mf_json_write_number(writer, "engine_steps", (double)result->step.engine_steps);
    write_known(writer, "error", result->step.error);
    if (result->step.formula[0])
        mf_json_write_text(writer, "formula", result->step.formula);
    if (result->verification)
        write_verification(writer, fit, result->verification);
    if (result->verification)
        write_states(writer, fit, result->verification);
    write_normalisation(writer, fit);
    write_truth(writer, fit, unknowns, result);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (result->step.curve[kind])
            write_flat(writer, kind, unknowns, result);
    write_ramp(writer, &result->step.ramp, inverse_problem_bulk(&fit->problem));
    write_slowest(writer, &result->step.slowest);
    write_parameters(writer, fit, result);
    write_start(writer, unknowns, result);
    write_dampings(result->changes, writer);
    if (fit->files.given[TARGET_ETD])
        mf_json_write_number(writer, "etd_cells_left_out",
                             (double)target_files_etd(&fit->files)->left_out);
    mf_json_write_number(writer, "seed", (double)fit->heading.seed);
    mf_json_write_text(writer, "version", mf_version);
    mf_run_folder_file(folder, "summary.json", path);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}
