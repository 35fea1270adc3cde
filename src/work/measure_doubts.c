// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_doubts.h"

#include "base/memory.h"
#include "observe/equilibration.h"
#include "trajectory/frame.h"

#include <math.h>
#include <string.h>

/// Units are wrong more often than matter is so thin or dense; bins of 0.01 nm may
/// then be more than memory holds.
static void doubt_density(struct progress *progress, const struct trajectory_frame *frame,
                          size_t beads, const char *units) {
    static const double thinnest = 1e-3, densest = 200;
    const double(*const a)[3] = (const double(*)[3])frame->box;
    double volume = 0;
    for (int d = 0; d < 3; d++)
        volume += a[0][d] *
                  (a[1][(d + 1) % 3] * a[2][(d + 2) % 3] - a[1][(d + 2) % 3] * a[2][(d + 1) % 3]);
    const double density = (double)beads / fabs(volume);
    if (!frame->has_box || (density >= thinnest && density <= densest))
        return;
    if (units == NULL)
        mf_progress_print(progress,
                          "mesofit: warning: %s: %.3g beads in a nm^3: are places and box in "
                          "another unit?",
                          frame->file, density);
    else
        mf_progress_print(
            progress,
            "mesofit: warning: --file-units %s make %.3g beads in a nm^3: is the file "
            "in other units?",
            units, density);
}

/// A box that the atoms of the first frame do not fill, or not go into unless they were unwrapped,
/// is another's, or in another unit.
static void doubt_box(struct progress *progress, const struct trajectory_frame *frame) {
    enum { MIN_ATOMS = 50 };
    static const double widest = 1.5, narrowest = 0.5;
    struct box_vectors box;
    double spread[3], most = 0, least = INFINITY;
    if (frame->atoms < MIN_ATOMS || !frame->has_box ||
        mf_frame_box_find(&box, frame) != STATUS_OK || mf_frame_box_is_plane(&box, frame))
        return;
    mf_frame_box_spread(&box, frame, spread);
    for (int i = 0; i < 3; i++) {
        most = fmax(most, spread[i]);
        least = fmin(least, spread[i]);
    }
    if (most > widest && !frame->unwrapped)
        mf_progress_print(progress,
                          "mesofit: warning: %s: in its first frame atoms spread over %.2g boxes: "
                          "that is right of unwrapped positions; of others the box is wrong, or in "
                          "another unit, and so are g(r) and S(q)",
                          frame->file, most);
    else if (least < narrowest)
        mf_progress_print(progress,
                          "mesofit: warning: %s: in its first frame atoms fill %.2g of the box: "
                          "g(r) and S(q) are of all of it; is the box in another unit?",
                          frame->file, least);
}

void mf_measure_doubts(struct progress *progress, const struct trajectory_frame *frame,
                       size_t beads, const char *units) {
    doubt_density(progress, frame, beads, units);
    doubt_box(progress, frame);
}

void mf_measure_doubt_interval(struct progress *progress, const struct frames *frames,
                               size_t count) {
    static const double share = 0.01;
    const double every = frames->plan.every;
    const struct trajectory_frame *const frame = frames->frame;
    const double interval = count > 1 ? frame[1].time - frame[0].time : every;
    if (every > 0 && fabs(interval / every - 1) > share)
        mf_progress_print(progress,
                          "mesofit: warning: --every %g: frames %.6g ps apart are used, since "
                          "there are none between",
                          every, interval);
}

void mf_measure_doubt_few(struct progress *progress, size_t frames) {
    if (frames > 1 && frames < EQUILIBRATION_MIN_SAMPLES)
        mf_progress_print(progress,
                          "too few frames (%zu) to tell whether the trajectory is in equilibrium: "
                          "%d at least",
                          frames, EQUILIBRATION_MIN_SAMPLES);
}

/// Where g(r) of a pair type has the highest peak of all [nm]; 0: none has any.
static enum status find_peak(const struct rdf *rdf, double *r) {
    static const double least = 1.5;
    const size_t bins = rdf->bins.count;
    const size_t all = bins * (size_t)mf_composition_pairs(&rdf->composition);
    OWNED double *g = NULL;
    double most = least;
    *r = 0;
    TRY_ARRAY(g, all);
    TRY(mf_rdf_result(rdf, 1, g, NULL));
    for (size_t k = 0; k < all; k++)
        if (g[k] > most) {
            most = g[k];
            *r = mf_rdf_bins_centre(&rdf->bins, k % bins);
        }
    return STATUS_OK;
}

/// Mean mass of all beads [u]; NAN if it is not known.
static double mean_mass(const struct measure_result *result) {
    const struct composition *const composition = &result->measured->pairs.composition;
    double sum = 0, count = 0;
    for (int type = 0; type < composition->types; type++) {
        const double beads = (double)composition->count[type];
        sum += beads * mf_measure_output_mass(result, type);
        count += beads;
    }
    return sum / count;
}

/// Beads that meet as in a liquid of so many, which is a hundred times lighter than any, or
/// heavier: angstrom taken for nm make a thousand times. Masses of some u may be those of reduced
/// units.
static enum status doubt_mass_density(struct progress *progress,
                                      const struct measure_result *result) {
    static const double of_liquids = 0.3, lightest = 0.01, heaviest = 30, reduced = 6;
    static const double of_u = 1.66053907e-3; // [g/cm³] of 1 u/nm³
    const double n = mf_measure_output_density(result), mass = mean_mass(result);
    const double density = of_u * n * mass;
    double r;
    if (!(mass > reduced) || (density >= lightest && density <= heaviest))
        return STATUS_OK;
    TRY(find_peak(mf_measured_rdf(result->measured), &r));
    if (n * r * r * r > of_liquids)
        mf_progress_print(progress,
                          "mesofit: warning: pairs are at %.3g nm, as close as in a liquid of so "
                          "many beads, but it has %.2g g/cm^3: are places and box in another unit?",
                          r, density);
    return STATUS_OK;
}

/// Beads cannot move farther than their velocities carry them; and where these are still much alike
/// from one frame to the next, not much less far.
static enum status doubt_times(struct progress *progress, const struct measure_result *result) {
    static const double farthest = 1.5, nearest = 0.05, errors = 3;
    const struct measured_motion *const motion = &result->measured->motion;
    OWNED double *columns = NULL;
    if (!mf_measure_tables_have_motion(result) || !motion->has_vacf || motion->path.differences ||
        result->frames->unsorted || motion->path.far > 0)
        return STATUS_OK;
    TRY(mf_motion_table(&motion->motion, &columns));
    const size_t rows = (size_t)motion->motion.plan.lags + 1;
    const double *const time = columns, *const msd = time + rows, *const vacf = msd + 2 * rows;
    const double *const error = vacf + rows;
    if (!(vacf[0] > 0))
        return STATUS_OK;
    const double carried = sqrt(msd[1] / vacf[0]) / time[1];
    const bool alike = !(vacf[1] <= errors * error[1]); // or it is not known
    const bool less = alike && carried < nearest * vacf[1] / vacf[0];
    if (carried > farthest || less)
        mf_progress_print(progress,
                          "mesofit: warning: from frame to frame beads move %.2g times as far as "
                          "their velocities carry them in %.3g ps: is %s, or that of places, in "
                          "another unit?",
                          carried, time[1],
                          result->request->frames.options.time_step > 0 ? "--file-time-step (ps)"
                                                                        : "the time");
    return STATUS_OK;
}

/// The temperature of a type by its velocities; its error, no less than by equipartition.
static double temperature_of(const struct measure_result *result, size_t type, double *error) {
    const struct sample_series *const series = &result->measured->motion.of_type;
    const double beads = (double)result->measured->pairs.composition.count[type];
    const double mean = mf_sample_series_mean(series, type, error);
    const double least = mean * sqrt(2 / (3 * beads * (double)series->count));
    *error = fmax(least, *error);
    return mean;
}

/// Types that are far apart in temperature have wrong masses, unless something holds or drives
/// some.
static void doubt_equipartition(struct progress *progress, const struct measure_result *result) {
    static const double least = 0.1, errors = 6;
    const struct sample_series *const series = &result->measured->motion.of_type;
    size_t coldest = 0, hottest = 0;
    double cold = INFINITY, cold_error = 0, hot = 0, hot_error = 0;
    for (size_t type = 0; type < series->columns && series->count > 0; type++) {
        double error;
        const double found = temperature_of(result, type, &error);
        if (found < cold)
            cold = found, cold_error = error, coldest = type;
        if (found > hot)
            hot = found, hot_error = error, hottest = type;
    }
    if (hot < (1 + least) * cold || !(hot - cold > errors * hypot(hot_error, cold_error)))
        return;
    mf_progress_print(
        progress,
        "mesofit: warning: by velocities and masses %s has %.4g K and %s %.4g K: is a "
        "mass wrong, or are some held, as walls or by bonds of fixed length? Then give the others' "
        "by --temperature",
        result->mapping->type_name[coldest], cold, result->mapping->type_name[hottest], hot);
}

enum status mf_measure_doubt_results(struct progress *progress,
                                     const struct measure_result *result) {
    if (result->measured->in_vacuum)
        return STATUS_OK;
    if (result->request->frames.options.units == NULL ||
        strcmp(result->request->frames.options.units, "lj") != 0)
        TRY(doubt_mass_density(progress, result));
    doubt_equipartition(progress, result);
    return doubt_times(progress, result);
}
