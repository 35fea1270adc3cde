// SPDX-License-Identifier: GPL-3.0-or-later
//
// A look at a g(r): errors that leave nothing to be fitted, an end that is not 1, a table that is
// not what a program writes, a system that is no homogeneous liquid; and at errors of all targets.
#include "observe/kirkwood_buff.h"
#include "targets/target_resample.h"
#include "targets/target_sanity.h"

#include <math.h>
#include <stdio.h>

/// What a target has.
struct measured {
    const char *kind, *name, *file;
    const double *value, *error; ///< shape [count]
    size_t count;
};

/// Whether most of what is not nearly 0 has errors of more than such a share of it; their mean
/// share.
static bool are_large(const struct measured *measured, double most, double *mean) {
    static const double structure = 0.1;
    size_t large = 0, seen = 0;
    double largest = 0, sum = 0;
    for (size_t k = 0; k < measured->count; k++)
        largest = fmax(largest, fabs(measured->value[k]));
    for (size_t k = 0; k < measured->count; k++) {
        const double value = fabs(measured->value[k]);
        if (!(value > structure * fmin(1, largest)) || !isfinite(measured->error[k]))
            continue;
        seen++;
        sum += measured->error[k] / value;
        large += measured->error[k] > most * value;
    }
    *mean = sum / (double)seen;
    return 2 * large > seen;
}

static void warn_of_errors(const struct measured *measured, double mean, const char *scatter,
                           const struct target_sanity_listener *listener) {
    mf_target_sanity_warn(
        listener,
        "mesofit: warning: target.%s%s%s: %s: its errors are %.2g times its values%s, so that "
        "nearly anything agrees with it: are they in per cent, or another column? Give standard "
        "errors in the unit of the values, or \"error_column\": 0 to take them from the scatter",
        measured->kind, measured->name[0] ? "." : "", measured->name, measured->file, mean,
        scatter);
}

static void look_at_errors(const struct measured *measured,
                           const struct target_sanity_listener *listener) {
    static const double largest_share = 0.5;
    double mean;
    if (are_large(measured, largest_share, &mean))
        warn_of_errors(measured, mean, "", listener);
}

/// Rows of narrow bins may have large errors, but they scatter by them.
enum status mf_target_sanity_report_errors(const struct target_rdf *target, const char *name,
                                           const struct target_sanity_listener *listener) {
    static const double largest_share = 0.2, contradiction = 3;
    const struct target_rows *rows = &target->rows;
    const struct measured measured = {name,    "",          target->parameters.file,
                                      rows->y, rows->error, rows->count};
    double mean, scatter = NAN;
    char text[64] = "";
    if (!rows->has_errors || !are_large(&measured, largest_share, &mean))
        return STATUS_OK;
    if (!mf_target_resample_is_needed(rows))
        TRY(mf_target_rows_scatter(rows, &scatter));
    if (rows->error[rows->count - 1] < contradiction * scatter)
        return STATUS_OK;
    if (!isnan(scatter))
        snprintf(text, sizeof text, " (rows scatter by %.2g)", scatter);
    warn_of_errors(&measured, mean, text, listener);
    return STATUS_OK;
}
void mf_target_sanity_report_other_errors(const struct target_files *files,
                                          const struct target_sanity_listener *listener) {
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct target_groups *groups = target_files_groups(files, order);
        for (size_t g = 0; g < groups->groups; g++) {
            const struct target_bonded *member = &groups->member[g];
            look_at_errors(&(struct measured){mf_bonded_distribution_of(order)->name,
                                              groups->name[g], member->parameters.file,
                                              member->value, member->error, member->bins.count},
                           listener);
        }
    }
    for (int kind = TARGET_VACF; kind <= TARGET_MSD; kind++) {
        const struct target_curve *curve = target_files_curve(files, kind);
        if (files->given[kind])
            look_at_errors(&(struct measured){mf_targets_name(kind), "", curve->parameters.file,
                                              curve->value, curve->error, curve->points},
                           listener);
    }
}

/// Mean of g over the last tenth of its range and what it may be off by chance: by the errors of
/// the file, and by how rows scatter there, of which two remember each other.
struct end {
    double from, mean, error;
};

static struct end end_of(const struct target_rows *rows) {
    struct end end = {.from = 0.9 * rows->x[rows->count - 1]};
    double count = 0, sum = 0, squares = 0, variance = 0;
    for (size_t k = 0; k < rows->count; k++) {
        if (rows->x[k] <= end.from)
            continue;
        count++;
        sum += rows->y[k];
        squares += rows->y[k] * rows->y[k];
        variance += rows->has_errors ? rows->error[k] * rows->error[k] : 0;
    }
    end.mean = sum / count;
    end.error =
        sqrt(variance) / count + sqrt(2 * fmax(0, squares / count - end.mean * end.mean) / count);
    return end;
}

void mf_target_sanity_report_end(const struct target_rdf *target, const char *name,
                                 const struct normalisation *normalisation,
                                 const struct scene *scene,
                                 const struct target_sanity_listener *listener) {
    static const double allowed = 0.03, deviations = 4, oscillation = 2;
    const struct end end = end_of(&target->rows);
    const double given = target->parameters.normalisation;
    const double factor = given > 0 ? given : normalisation->found ? normalisation->factor : 1;
    const double away = fabs(end.mean / factor - 1);
    double length;
    const char *unit = mf_target_sanity_length(scene, &length);
    if (!(away > allowed && away > deviations * end.error / factor &&
          away > oscillation * target->tail.scatter / factor))
        return;
    mf_target_sanity_warn(
        listener,
        "mesofit: warning: target.%s: beyond %.4g %s, in the last tenth of its range, g%s is "
        "%.3f(%.0f), not 1: a potential for it would be wrong at all distances. Is g over another "
        "volume or number of pairs (\"normalisation\" divides by a factor), of two phases, or too "
        "short for its structure?",
        name, end.from * length, unit, factor != 1 ? " over its normalisation" : "",
        end.mean / factor, ceil(1e3 * end.error / factor));
}

// What was made of a table of g(r) ----------------------------------------------------------------

/// How many times as large as an ideal gas's a pressure can be. Fluids of repulsions r^-12 freeze
/// at 19 times, of r^-6 at 39, hard spheres at 12.5; coarse potentials of water, and DPD's, have 7
/// to
/// 25. Water's 1 bar in Pa would be 73.
static const double largest = 50;

void mf_target_sanity_report_pressure(const struct target_files *files, const struct scene *scene,
                                      const struct target_sanity_listener *listener) {
    const struct target_number *const target = files->own[TARGET_PRESSURE];
    const struct simulation_setup *const setup = &scene->setup;
    const struct units *const units = &scene->units;
    const double ideal = setup->temperature *
                         (double)mf_composition_particles(&setup->composition) /
                         mf_box_volume(&setup->box);
    const double factor = mf_units_factor(units, "k_B T_0/lambda^d");
    char unit[UNITS_NAME_SIZE];
    if (!files->given[TARGET_PRESSURE] || !(fabs(target->value) > largest * ideal))
        return;
    mf_units_suffix(units, "k_B T_0/lambda^d", unit);
    mf_target_sanity_warn(listener,
                          "mesofit: warning: target.pressure: %.6g%s is %.3g times the pressure of "
                          "an ideal gas of this density and temperature, %.4g%s: no fluid has more "
                          "than some %g times as much; is it in%s, and not in Pa or another unit?",
                          factor * target->value, unit, fabs(target->value) / ideal, factor * ideal,
                          unit, largest, unit[0] ? unit : " units of k_B T_0/lambda^3");
}

/// Where pairs do not come g is 0, and a fluid of soft cores has pairs from r = 0 on.
static void warn_of_missing_rows(const struct target_rdf *target, const char *name,
                                 const struct scene *scene,
                                 const struct target_sanity_listener *listener) {
    static const double seen = 0.05, standard_errors = 3;
    double length;
    const char *unit = mf_target_sanity_length(scene, &length);
    if (target->bins.low < 0.5 * target->bins.width ||
        target->g[0] < fmax(seen, standard_errors * target->error[0]))
        return;
    mf_target_sanity_warn(listener,
                          "mesofit: warning: target.%s: its first row, at %.4g %s, has g = %.3g: "
                          "nearer pairs are taken for none, as if rows of 0 were missing; give g "
                          "from where it is 0, or from r = 0",
                          name, mf_rdf_bins_centre(&target->bins, 0) * length, unit, target->g[0]);
}

/// A potential that ends before its "cutoff" is not the one that was asked for. That a mixture ends
/// with its shortest pair is told elsewhere.
static void warn_of_missing_end(const struct target_rdf *target, const char *name,
                                const struct scene *scene,
                                const struct target_sanity_listener *listener) {
    const struct target_rows *rows = &target->rows;
    const double end = mf_rdf_bins_edge(&target->bins, target->bins.count);
    const double last = rows->count > 0 ? rows->x[rows->count - 1] : INFINITY;
    const double cutoff = target->parameters.cutoff;
    double length;
    const char *unit = mf_target_sanity_length(scene, &length);
    if (cutoff > last + target->bins.width)
        mf_target_sanity_warn(listener,
                              "mesofit: warning: target.%s.cutoff: %.4g %s is beyond the end of "
                              "the table: g(r) and the potential end at %.4g %s",
                              name, cutoff * length, unit, end * length, unit);
}

void mf_target_sanity_report_reading(const struct target_rdf *target, const char *name,
                                     const struct scene *scene,
                                     const struct target_sanity_listener *listener) {
    const struct target_resampling *r = &target->resampling;
    double length;
    char error[96] = "";
    const char *unit = mf_target_sanity_length(scene, &length);
    if (target->negative > 0)
        mf_target_sanity_warn(listener,
                              "target %s: g is below 0 in %zu rows, by %.2g at most: taken as 0",
                              name, target->negative, -target->min);
    warn_of_missing_rows(target, name, scene, listener);
    warn_of_missing_end(target, name, scene, listener);
    if (r->points == 0)
        return;
    if (r->assumed)
        snprintf(error, sizeof error, ", each with the error %.2g that is assumed,", r->error);
    else if (r->error > 0)
        snprintf(error, sizeof error, ", which scatter by %.2g in g and %.2g %s in r,", r->error,
                 r->error_in_r * length, unit);
    mf_target_sanity_warn(listener,
                          "target %s: r is not equally spaced (steps of %.3g to %.3g %s): its %zu "
                          "points%s are read at equal bins of %.4g %s by cubic interpolation",
                          name, r->shortest * length, r->longest * length, unit, r->points, error,
                          target->bins.width * length / (double)target->joined, unit);
}

void mf_target_sanity_report_normalisation(const struct normalisation *n,
                                           const struct target_sanity_listener *listener) {
    if (n->found)
        mf_target_sanity_warn(
            listener,
            "target.rdf: g(r) is too %s at all distances: it is divided by %.4f(%.0f); "
            "\"normalisation\" of the target sets another factor, 1 for none",
            n->factor > 1 ? "large" : "small", n->factor, ceil(n->error * 1e4));
}

// Whether it is a homogeneous liquid --------------------------------------------------------------

static const double standard_errors = 3, frozen = 3.3;

/// How many times as compressible as an ideal gas a fluid of two phases is at least: Lennard-Jones
/// at 1.1 T_c has 2.8, dumbbells of two phases whose g stays above 1 have 2.5, liquids are below 1.
static const double several = 3, several_above_1 = 2;

/// Mean of g over the last quarter from which on it is said to stay above 1.
static const double above_1 = 1.01;

/// S at a wave number and its standard error.
struct wave {
    double value, error;
};

static struct wave wave_of(const struct target_state *state, double density, double q) {
    const double area = 4 * acos(-1) * density / q * state->bins->width;
    double sum = 0, variance = 0;
    for (size_t k = 0; k < state->bins->count; k++) {
        const double r = mf_rdf_bins_centre(state->bins, k), part = r * sin(q * r);
        sum += part * (state->g[k] - 1);
        variance += isnan(state->error[k]) ? 0 : pow(part * state->error[k], 2);
    }
    return (struct wave){1 + area * sum, area * sqrt(variance)};
}

/// The highest of 200 wave numbers about the first peak of liquids and crystals, 2π ρ^(1/3).
static struct wave highest_of(const struct target_state *state) {
    enum { WAVES = 200 };
    const double density = (double)state->count / mf_box_volume(state->box);
    const double unit = 2 * acos(-1) * cbrt(density);
    struct wave highest = {0, 0};
    for (int k = 0; k < WAVES; k++) {
        const struct wave now = wave_of(state, density, unit * (0.5 + 2.0 * k / WAVES));
        if (now.value > highest.value)
            highest = now;
    }
    return highest;
}

bool mf_target_state_print(const struct target_state *state, char line[TARGET_STATE_LINE]) {
    if (state->box->dimensions != 3 || state->count < 2)
        return false;
    const struct kirkwood_buff kb = mf_kirkwood_buff_integrate(
        state->bins, state->g, state->error, state->box, state->count, state->inside);
    const double value = kb.compressibility / (1 + state->bound);
    const double error = kb.compressibility_error / (1 + state->bound);
    if (value - standard_errors * error > (state->tail > above_1 ? several_above_1 : several)) {
        char tail[64] = "";
        if (state->tail > above_1)
            snprintf(tail, sizeof tail, ", and g ends at %.3f", state->tail);
        snprintf(line, TARGET_STATE_LINE,
                 "1 + rho G%s = %.3g(%.1g)%s: of two phases, or near a critical point? A fit may "
                 "condense; take g of one phase with its density, a shorter \"cutoff\", or give "
                 "\"pressure\"",
                 state->bound > 0 ? " of the molecules" : "", value, error, tail);
        return true;
    }
    if (state->bound > 0)
        return false;
    const struct wave highest = highest_of(state);
    if (!(highest.value - standard_errors * highest.error > frozen))
        return false;
    snprintf(line, TARGET_STATE_LINE,
             "its structure factor has a peak of %.3g, while liquids freeze at 2.85: of a crystal? "
             "A fit begins from disorder and finds no potential for it; take g of the liquid",
             highest.value);
    return true;
}

bool mf_target_state_print_whole(const struct target_state *state,
                                 const struct target_rdf_whole *whole,
                                 char line[TARGET_STATE_LINE]) {
    struct target_state other = *state;
    if (whole->bins.count == 0)
        return false;
    other.bins = &whole->bins;
    other.g = whole->g;
    other.error = whole->error;
    return mf_target_state_print(&other, line);
}
