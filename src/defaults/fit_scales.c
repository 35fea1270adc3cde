// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_scales.h"

#include "base/memory.h"

#include <math.h>

/// g of one pair type.
struct view {
    const struct rdf_bins *bins;
    const double *g, *error; ///< shape [bins->count]
    double tail;             ///< mean over the last quarter
};

static size_t pairs_of(const struct fit_scales_rdf *rdf) {
    return (size_t)mf_composition_pairs(rdf->composition);
}

/// Whether g of a pair type is known.
static bool has_g(const struct fit_scales_rdf *rdf, size_t pair) {
    return !isnan(rdf->g[pair * rdf->bins.count]);
}

static struct view view_of(const struct fit_scales_rdf *rdf, size_t pair) {
    const size_t bins = rdf->bins.count, first = 3 * bins / 4;
    struct view view = {&rdf->bins, rdf->g + pair * bins, rdf->error + pair * bins, 0};
    for (size_t k = first; k < bins; k++)
        view.tail += view.g[k] / (double)(bins - first);
    return view;
}

static size_t highest_bin(const struct view *view) {
    size_t highest = 0;
    for (size_t k = 0; k < view->bins->count; k++)
        if (view->g[k] > view->g[highest])
            highest = k;
    return highest;
}

/// A maximum of g that is no more than noise says nothing.
static const double min_peak = 0.05, peak_errors = 4;

/// The first maximum that stands out from what follows, as that of chains does below 1.
static double find_first_neighbour(const struct view *view, double spacing) {
    size_t highest = 0;
    for (size_t k = 0; k < view->bins->count; k++) {
        const double noise = hypot(view->error[highest], view->error[k]);
        if (view->g[k] > view->g[highest])
            highest = k;
        else if (view->g[highest] - view->g[k] > fmax(min_peak, peak_errors * noise))
            return mf_rdf_bins_centre(view->bins, highest);
    }
    return spacing;
}

static double find_neighbour(const struct view *view, double spacing) {
    const size_t k = highest_bin(view);
    const double peak = view->g[k] - view->tail;
    return peak > fmax(min_peak, peak_errors * view->error[k])
               ? mf_rdf_bins_centre(view->bins, k)
               : find_first_neighbour(view, spacing);
}

/// Whether g rises from one bin to a later one by more than noise.
static bool rises(const struct view *view, size_t from, size_t to) {
    const double noise = hypot(view->error[from], view->error[to]);
    return view->g[to] - view->g[from] > fmax(min_peak, peak_errors * noise);
}

/// The first minimum after the neighbours: g is above 1 again, or, where bonded neighbours fill the
/// gap between shells and it is never below, it rises by more than noise. Without one, half as far
/// again as they are.
static double find_shell(const struct view *view, double neighbour) {
    static const double without = 1.5, min = 1.2, max = 2;
    const struct rdf_bins *bins = view->bins;
    size_t k = 0, lowest;
    while (k + 1 < bins->count && mf_rdf_bins_edge(bins, k + 1) <= neighbour)
        k++;
    for (lowest = k; k < bins->count; k++) {
        if (view->g[k] < view->g[lowest])
            lowest = k;
        if (view->g[k] >= 1 && (view->g[lowest] < 1 || rises(view, lowest, k)))
            break;
    }
    const double shell = mf_rdf_bins_centre(bins, lowest);
    return k < bins->count && shell > min * neighbour && shell < max * neighbour
               ? shell
               : without * neighbour;
}

/// Curvature of the parabola through ln g at 2 half + 1 bins about k, by least squares, and its
/// standard error; false if some of them have no pairs.
static bool fit_parabola(const struct view *view, size_t k, size_t half, double *curvature,
                         double *error) {
    // With x = −half … half and P = x² − mean of x²: curvature = 2 Σ P ln g/Σ P x².
    double mean = 0, sum = 0, norm = 0, variance = 0;
    const double points = 2 * (double)half + 1, h = view->bins->width;
    for (size_t j = 0; j <= 2 * half; j++)
        mean += pow((double)j - (double)half, 2) / points;
    for (size_t j = 0; j <= 2 * half; j++) {
        const double square = pow((double)j - (double)half, 2), weight = square - mean;
        const double g = view->g[k - half + j];
        if (!(g > 0))
            return false;
        sum += weight * log(g);
        norm += weight * square;
        variance += pow(weight * view->error[k - half + j] / g, 2);
    }
    *curvature = 2 * sum / (norm * h * h);
    *error = 2 * sqrt(variance) / (norm * h * h);
    return true;
}

/// The largest −(ln g)'' up to the neighbours, where g is not so small that pairs hardly get there.
static void find_curvature(const struct view *view, size_t half, double *largest, double *at) {
    static const double rare = 0.02, known = 0.25;
    const size_t last = highest_bin(view);
    for (size_t k = half; k <= last && k + half < view->bins->count; k++) {
        double curvature, error;
        if (view->g[k] < rare * view->g[last] || !fit_parabola(view, k, half, &curvature, &error))
            continue;
        if (-curvature > *largest && error < known * -curvature) {
            *largest = -curvature;
            *at = mf_rdf_bins_centre(view->bins, k);
        }
    }
}

/// Lower edge of the first bin with pairs.
static double find_core(const struct view *view) {
    static const double rare = 0.02;
    size_t k = 0;
    while (k + 1 < view->bins->count && view->g[k] < rare)
        k++;
    return mf_rdf_bins_edge(view->bins, k);
}

/// Upper edge of the last bin about which g differs from its tail by more than noise, and `little`.
static double find_seen(const struct view *view, double little) {
    enum { HALF = 2 };
    static const double standard_errors = 5; // of some hundred places
    const struct rdf_bins *bins = view->bins;
    for (size_t k = bins->count; k-- > 0;) {
        double sum = 0, variance = 0, count = 0;
        for (size_t j = k < HALF ? 0 : k - HALF; j <= k + HALF && j < bins->count; j++) {
            sum += view->g[j] - view->tail;
            variance += view->error[j] * view->error[j];
            count++;
        }
        if (fabs(sum) > fmax(little * count, standard_errors * sqrt(variance)))
            return mf_rdf_bins_edge(bins, k + 1);
    }
    return 0;
}

static double find_noise(const struct fit_scales_rdf *rdf) {
    const size_t values = pairs_of(rdf) * rdf->bins.count;
    double squares = 0, count = 0;
    for (size_t k = 0; k < values; k++) {
        squares += isnan(rdf->error[k]) ? 0 : rdf->error[k] * rdf->error[k];
        count += rdf->g[k] > 0;
    }
    return count > 0 ? sqrt(squares / count) : 0;
}

struct fit_scales mf_fit_scales_find(const struct fit_scales_rdf *rdf, double temperature,
                                     double little) {
    enum { NARROWEST = 2, WIDEST = 8 };
    struct fit_scales scales = {.core = INFINITY,
                                .neighbour = INFINITY,
                                .noise = find_noise(rdf),
                                .range = mf_rdf_bins_range(&rdf->bins)};
    const double spacing = pow(rdf->density, -1.0 / rdf->dimensions);
    for (size_t pair = 0; pair < pairs_of(rdf); pair++) {
        if (!has_g(rdf, pair))
            continue;
        const struct view view = view_of(rdf, pair);
        const double neighbour = find_neighbour(&view, spacing);
        double curvature = 0, at = 0;
        for (size_t half = NARROWEST; half <= WIDEST && curvature == 0; half++)
            find_curvature(&view, half, &curvature, &at);
        if (temperature * curvature > scales.curvature) {
            scales.curvature = temperature * curvature;
            scales.curvature_at = at;
        }
        scales.core = fmin(scales.core, find_core(&view));
        scales.neighbour = fmin(scales.neighbour, neighbour);
        scales.shell = fmax(scales.shell, find_shell(&view, neighbour));
        scales.seen = fmax(scales.seen, find_seen(&view, little));
    }
    scales.shell = fmin(scales.shell, scales.range);
    return scales;
}

double mf_fit_scales_friction(const struct fit_scales_rdf *rdf, double cutoff) {
    const struct rdf_bins *bins = &rdf->bins;
    const struct composition *composition = rdf->composition;
    const double count = (double)mf_composition_particles(composition);
    const struct box space = {.dimensions = rdf->dimensions};
    double sum = 0;
    for (size_t pair = 0; pair < pairs_of(rdf); pair++) {
        int type[2];
        if (!has_g(rdf, pair))
            continue;
        mf_composition_pair_types(composition, (int)pair, type);
        const double share = (type[0] == type[1] ? 1 : 2) * (double)composition->count[type[0]] *
                             (double)composition->count[type[1]] / (count * count);
        for (size_t k = 0; k < bins->count && mf_rdf_bins_centre(bins, k) < cutoff; k++)
            sum += share * rdf->g[pair * bins->count + k] *
                   pow(1 - mf_rdf_bins_centre(bins, k) / cutoff, 2) *
                   mf_box_shell_volume(&space, mf_rdf_bins_edge(bins, k),
                                       mf_rdf_bins_edge(bins, k + 1));
    }
    return rdf->density * sum / rdf->dimensions;
}

double mf_fit_scales_noise_of_sample(const struct fit_scales_rdf *rdf, const struct box *box,
                                     double count, double range) {
    const struct rdf_bins *bins = &rdf->bins;
    const double larger = count / (double)mf_composition_particles(rdf->composition);
    double squares = 0, seen = 0;
    for (int pair = 0; pair < mf_composition_pairs(rdf->composition); pair++)
        for (size_t k = 0; k < bins->count && mf_rdf_bins_edge(bins, k) < range; k++) {
            const double ideal =
                larger * mf_rdf_ideal_pairs_of(bins, k, box, rdf->composition, pair);
            const double g = rdf->g[(size_t)pair * bins->count + k];
            squares += ideal > 0 && !isnan(g) ? g / ideal : 0;
            seen += ideal > 0 && !isnan(g);
        }
    return sqrt(squares / seen);
}

// Bins --------------------------------------------------------------------------------------------

/// `of` bins from bin k on as one: g and its variance.
static void join_bins(const struct fit_scales_rdf *rdf, size_t pair, size_t k, size_t of, double *g,
                      double *variance) {
    const struct rdf_bins *bins = &rdf->bins;
    const struct box space = {.dimensions = rdf->dimensions};
    double whole = 0;
    *g = *variance = 0;
    for (size_t j = k; j < k + of; j++) {
        const double part =
            mf_box_shell_volume(&space, mf_rdf_bins_edge(bins, j), mf_rdf_bins_edge(bins, j + 1));
        whole += part;
        *g += part * rdf->g[pair * bins->count + j];
        *variance += pow(part * rdf->error[pair * bins->count + j], 2);
    }
    *g /= whole;
    *variance /= whole * whole;
}

/// What cubics through bins of a pair type that are joined are off by, beyond noise, over what they
/// may be: the noise of a bin, from `finest` to `coarsest` times sqrt(g), as that of pairs is.
static double find_interpolation(const struct fit_scales_rdf *rdf, size_t pair, size_t of,
                                 double finest, double coarsest) {
    enum { TAPS = 5, MIDDLE = TAPS / 2 };
    static const double taps[TAPS] = {1, -4, 6, -4, 1}, share = 3.0 / 128, standard_errors = 3;
    static const double rare = 0.02;
    double g[TAPS] = {0}, variance[TAPS] = {0}, max = 0;
    for (size_t k = 0; (k + 1) * of <= rdf->bins.count; k++) {
        join_bins(rdf, pair, k * of, of, &g[k % TAPS], &variance[k % TAPS]);
        if (k + 1 < TAPS)
            continue;
        double difference = 0, noise = 0;
        for (size_t j = 0; j < TAPS; j++) {
            difference += taps[j] * g[(k + 1 + j) % TAPS];
            noise += taps[j] * taps[j] * variance[(k + 1 + j) % TAPS];
        }
        const size_t middle = (k + 1 + MIDDLE) % TAPS;
        const double level = sqrt(fmin(1, fmax(rare, g[middle])));
        const double may = fmin(coarsest * level, fmax(finest * level, sqrt(variance[middle])));
        max = fmax(max, share * (fabs(difference) - standard_errors * sqrt(noise)) / may);
    }
    return max;
}

size_t mf_fit_scales_joined(const struct fit_scales_rdf *rdf, double finest, double coarsest) {
    enum { FEWEST = 40 }; // so few take no time, and of fewer no rms is known well
    size_t joined = 1;
    for (size_t of = 2; of * FEWEST <= rdf->bins.count; of++) {
        double off = 0;
        for (size_t pair = 0; pair < pairs_of(rdf); pair++)
            off = fmax(off, find_interpolation(rdf, pair, of, finest, coarsest));
        if (off > 1)
            break;
        joined = of;
    }
    return joined;
}

enum status mf_fit_scales_rdf_join(struct fit_scales_rdf *rdf, size_t of) {
    const size_t count = rdf->bins.count / of, values = pairs_of(rdf) * count;
    double *own = NULL;
    TRY_ARRAY(own, 2 * values);
    for (size_t n = 0; n < values; n++) {
        double variance;
        join_bins(rdf, n / count, n % count * of, of, &own[n], &variance);
        own[values + n] = sqrt(variance);
    }
    mf_memory_free(rdf->own);
    rdf->own = own;
    rdf->g = own;
    rdf->error = own + values;
    rdf->bins.count = count;
    rdf->bins.width *= (double)of;
    return STATUS_OK;
}

// g(r) --------------------------------------------------------------------------------------------

/// That of a gas.
static enum status make_rdf(struct fit_scales_rdf *rdf, const struct scene *scene) {
    enum { BINS = 200 };
    static const double known = 0.001;
    const size_t pairs = pairs_of(rdf);
    double range = 0;
    for (size_t pair = 0; pair < pairs; pair++)
        range = fmax(range, mf_curve_cutoff(mf_scene_law_curve(&scene->potential, (int)pair)));
    rdf->bins = (struct rdf_bins){.width = range / BINS, .count = BINS};
    TRY_ARRAY(rdf->own, 2 * pairs * BINS);
    for (size_t n = 0; n < pairs * BINS; n++) {
        const struct curve *phi = mf_scene_law_curve(&scene->potential, (int)(n / BINS));
        const double r = mf_rdf_bins_centre(&rdf->bins, n % BINS);
        rdf->own[n] = exp(-mf_curve_value(phi, r) / scene->setup.temperature);
        rdf->own[pairs * BINS + n] = known;
    }
    rdf->g = rdf->own;
    rdf->error = rdf->own + pairs * BINS;
    return STATUS_OK;
}

enum status mf_fit_scales_rdf_init(struct fit_scales_rdf *rdf, const struct target_files *files,
                                   const struct scene *scene) {
    const struct simulation_setup *setup = &scene->setup;
    *rdf = (struct fit_scales_rdf){.composition = &setup->composition,
                                   .dimensions = setup->box.dimensions,
                                   .density =
                                       (double)setup->placement.count / mf_box_volume(&setup->box)};
    if (files->given[TARGET_RDF]) {
        rdf->bins = *target_pairs_bins(target_files_rdf(files));
        rdf->g = target_files_rdf(files)->g;
        rdf->error = target_files_rdf(files)->error;
    }
    return files->given[TARGET_RDF] || scene->potential.curves == 0 ? STATUS_OK
                                                                    : make_rdf(rdf, scene);
}

void mf_fit_scales_rdf_clear(struct fit_scales_rdf *rdf) {
    mf_memory_free(rdf->own);
    *rdf = (struct fit_scales_rdf){0};
}
