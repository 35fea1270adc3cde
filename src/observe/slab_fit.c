// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/slab_fit.h"

#include "base/statistics.h"

#include <math.h>

/// How far the plateaus stay from the middle of an interface, in w.
static const double reach = 3;

/// What chance does not do.
static const double deviations = 5;

struct profile {
    const double *density;
    size_t bins;
    double length;
};

static double place_of(const struct profile *profile, size_t bin) {
    return profile->length * ((0.5 + (double)bin) / (double)profile->bins - 0.5);
}

double mf_slab_fit_value(const struct slab_fit *fit, double z) {
    return fit->middle - fit->half * tanh((fabs(z) - fit->place) / fit->scale);
}

/// The best a and b for given h and w; returns the sum of squares that they leave.
static double solve(const struct profile *profile, struct slab_fit *fit) {
    double t1 = 0, t2 = 0, y1 = 0, y2 = 0, ty = 0;
    const double count = (double)profile->bins;
    for (size_t k = 0; k < profile->bins; k++) {
        const double t = -tanh((fabs(place_of(profile, k)) - fit->place) / fit->scale);
        const double y = profile->density[k];
        t1 += t / count;
        t2 += t * t / count;
        y1 += y / count;
        y2 += y * y / count;
        ty += t * y / count;
    }
    const double spread = t2 - t1 * t1;
    fit->half = spread > 0 ? (ty - t1 * y1) / spread : 0;
    fit->middle = y1 - fit->half * t1;
    return y2 - y1 * y1 - fit->half * (ty - t1 * y1);
}

/// The best of a grid of places and scales.
static struct slab_fit scan(const struct profile *profile) {
    enum { PLACES = 48, SCALES = 16 };
    const double least = 0.25 * profile->length / (double)profile->bins;
    const double ratio = pow(0.25 * profile->length / least, 1.0 / (SCALES - 1));
    struct slab_fit best = {0};
    double smallest = INFINITY;
    for (int i = 1; i < PLACES; i++)
        for (int j = 0; j < SCALES; j++) {
            struct slab_fit fit = {.place = 0.5 * profile->length * i / PLACES,
                                   .scale = least * pow(ratio, j)};
            const double squares = solve(profile, &fit);
            if (squares < smallest && fit.half > 0) {
                smallest = squares;
                best = fit;
            }
        }
    if (smallest == INFINITY) // flat: any will do
        best = (struct slab_fit){.place = 0.25 * profile->length, .scale = 0.25 * profile->length};
    return best;
}

/// Go downhill in place and scale by steps that are halved where none is better.
static void refine(const struct profile *profile, struct slab_fit *fit) {
    static const double end = 1e-5, direction[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    const double least = 0.25 * profile->length / (double)profile->bins;
    double squares = solve(profile, fit), step = 0.25;
    while (step > end) {
        bool better = false;
        for (int n = 0; n < 4; n++) {
            struct slab_fit next = *fit;
            next.place += direction[n][0] * step * fit->scale;
            next.scale *= exp(direction[n][1] * step);
            next.scale = fmin(fmax(next.scale, least), 0.5 * profile->length);
            next.place = fmin(fmax(next.place, 0), 0.5 * profile->length);
            const double left = solve(profile, &next);
            if (left < squares && next.half > 0) {
                squares = left;
                *fit = next;
                better = true;
            }
        }
        step *= better ? 1 : 0.5;
    }
}

struct slab_fit mf_slab_fit(const double *density, size_t bins, double length,
                            const struct slab_fit *near) {
    const struct profile profile = {density, bins, length};
    struct slab_fit fit = near ? *near : scan(&profile);
    double liquid = 0, vapour = 0;
    refine(&profile, &fit);
    fit.liquid_bins = fit.vapour_bins = 0;
    for (size_t k = 0; k < bins; k++) {
        const double beyond = (fabs(place_of(&profile, k)) - fit.place) / fit.scale;
        liquid += beyond < -reach ? density[k] : 0;
        vapour += beyond > reach ? density[k] : 0;
        fit.liquid_bins += beyond < -reach;
        fit.vapour_bins += beyond > reach;
    }
    fit.liquid = fit.liquid_bins > 0 ? liquid / (double)fit.liquid_bins : NAN;
    fit.vapour = fit.vapour_bins > 0 ? vapour / (double)fit.vapour_bins : NAN;
    fit.width = 2 * atanh(0.8) * fit.scale;
    return fit;
}

bool mf_slab_fit_is_slab(const struct slab_fit *fit, double length, double volume, double count) {
    enum { LEAST = 2 };
    if (fit->liquid_bins < LEAST || fit->vapour_bins < LEAST)
        return false;
    const double within = volume * 2 * fit->place / length;
    const double variance = count / volume * (1 / within + 1 / (volume - within));
    return fit->liquid - fit->vapour > deviations * sqrt(variance);
}

/// By how many standard deviations the density of some bins is above the half of the step.
/// @param[in] volume  of the window
static double above_half(const struct slab_fit *fit, const struct slab_blocks *blocks, size_t first,
                         size_t window, double volume) {
    const double half = 0.5 * (fit->liquid + fit->vapour), count = (double)blocks->count;
    double means[SLAB_MAX_BLOCKS], mean = 0;
    for (size_t b = 0; b < blocks->count; b++) {
        means[b] = 0;
        for (size_t k = first; k < first + window; k++)
            means[b] += blocks->sums[b * blocks->row + k] / blocks->samples[b] / (double)window;
        mean += means[b] / count;
    }
    const double error =
        blocks->count > 1 ? mf_statistics_correlated_error(means, blocks->count, 1) : 0;
    return (mean - half) / sqrt(error * error + half / (volume * count));
}

/// Whether no window of one size is above the half again once others have been above and below.
static bool rises_once(const struct slab_fit *fit, const struct slab_blocks *blocks, size_t bins,
                       size_t window, double volume) {
    bool rose = false, fell = false;
    for (size_t first = 0; first + window <= bins; first += (window + 1) / 2) {
        const double above = above_half(fit, blocks, first, window, volume);
        if (fell && above > deviations)
            return false;
        rose = rose || above > deviations;
        fell = fell || (rose && above < -deviations);
    }
    return true;
}

bool mf_slab_fit_rises_once(const struct slab_fit *fit, const struct slab_blocks *blocks,
                            size_t bins, double length, double volume) {
    const double narrow = fit->scale / length * (double)bins;
    for (size_t window = narrow < 1 ? 1 : (size_t)narrow; 4 * window <= bins; window *= 2)
        if (!rises_once(fit, blocks, bins, window, volume * (double)window / (double)bins))
            return false;
    return true;
}
