// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors of targets that leave nothing to be fitted, and a g(r) that does not end at 1.
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
