// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify_agreement.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

/// That noise alone makes a result look as if it did not agree.
static const double false_alarms = 1e-3;

static double known_or_0(double error) {
    return isfinite(error) ? error : 0;
}

/// The error that value k has in common with the others of its pair type: that of their factor.
static double common_error(const struct target *target, size_t k) {
    return target->factor_error
               ? known_or_0(target->factor_error[k * target->pairs / target->count] *
                            target->value[k])
               : 0;
}

/// How many times the variance of the verification is that of the fit's samples: with it the noise
/// of all targets is the fit's.
static double find_share(const struct targets *targets, const struct observed *observed,
                         double noise) {
    struct target_distance theirs[TARGETS] = {0}, own[TARGETS] = {0};
    for (int kind = 0; kind < TARGETS; kind++) {
        const struct target *const target = &targets->target[kind];
        for (size_t k = 0; k < target->count; k++) {
            const double error = hypot(known_or_0(target->error[k]), common_error(target, k));
            theirs[kind].noise += error * error / (double)target->count;
            own[kind].noise += pow(known_or_0(observed->error[kind][k]), 2) / (double)target->count;
        }
        theirs[kind].noise = sqrt(theirs[kind].noise);
        own[kind].noise = sqrt(own[kind].noise);
    }
    const double of_targets = mf_targets_noise(targets, theirs);
    const double of_verification = mf_targets_noise(targets, own);
    if (!(of_verification > 0) || !(noise > of_targets))
        return 0;
    return (noise * noise - of_targets * of_targets) / (of_verification * of_verification);
}

/// χ² by bin that noise alone exceeds with this chance. Errors that are known by few values are as
/// often too small: F instead of χ².
static double find_probable(const struct statistics_independence *known, double chance) {
    static const double many = 200; // F is that of known errors, and GSL's inverse fails at times
    const double numbers = fmax(1, known->numbers);
    if (!(known->freedom >= 1))
        return INFINITY;
    const double probable =
        known->freedom < many ? gsl_cdf_fdist_Qinv(chance, numbers, known->freedom) : NAN;
    return isfinite(probable) ? probable : gsl_cdf_chisq_Qinv(chance, numbers) / numbers;
}

/// Of counts, those of a target have too small an error where they are fewer than expected: it is
/// that of the counts that the result expects, if these are more.
static double target_variance(const struct target *target, bool counted, size_t k, double value) {
    const double error = known_or_0(target->error[k]);
    const double counts = fmax(target->value[k], error);
    return error > 0 ? error * error * (counted ? fmax(1, value / counts) : 1) : 0;
}

/// What was observed beside its target.
struct comparison {
    const struct target *target;
    const double *value, *error;
    double share;
    double open;                 ///< standard error that what was fitted leaves of each value
    bool counted;                ///< values are counts
    const struct rdf_bins *bins; ///< of g(r); NULL: of others
};

static struct comparison compare(const struct targets *targets, int kind,
                                 const struct observed *observed, double share) {
    const struct target *const target = &targets->target[kind];
    return (struct comparison){.target = target,
                               .value = observed->value[kind],
                               .error = observed->error[kind],
                               .share = share,
                               .counted = kind == TARGET_RDF || target->block,
                               .bins = kind == TARGET_RDF ? &targets->bins : NULL};
}

/// What one count makes of value k, by the nearest of the values first … end − 1 that has counts;
/// of g(r) as its shell of three dimensions is smaller. 0 if none has.
static double value_of_count(const double *value, const double *error, const struct rdf_bins *bins,
                             size_t k, size_t first, size_t end) {
    size_t nearest = end;
    for (size_t n = first; n < end; n++)
        if (value[n] > 0 && error[n] > 0 &&
            (nearest == end || (n < k ? k - n : n - k) < (nearest < k ? k - nearest : nearest - k)))
            nearest = n;
    if (nearest == end)
        return 0;
    const double there = error[nearest] * error[nearest] / value[nearest];
    if (bins == NULL || !(bins->width > 0))
        return there;
    return there * pow(mf_rdf_bins_centre(bins, nearest % bins->count) /
                           mf_rdf_bins_centre(bins, k % bins->count),
                       2);
}

/// Of counts that are fewer than expected, or none, whose own error would be 0, it is that of those
/// that the target expects.
static double own_variance(const struct comparison *of, size_t k, size_t first, size_t end) {
    const double error = known_or_0(of->error[k]), expected = fmax(0, of->target->value[k]);
    if (!of->counted || !isfinite(expected) || !(of->value[k] < expected))
        return error * error;
    return of->value[k] > 0
               ? error * error * expected / of->value[k]
               : expected * value_of_count(of->value, of->error, of->bins, k, first, end);
}

/// What χ² is made of, with the covariance σ_a² δ_ab + c_a c_b, of which c is the error that bins
/// have in common: Σ x²/σ² − (Σ c x/σ²)²/(1 + Σ c²/σ²).
struct sums {
    double square, along, common, bins;
};

/// The sums over values first … end − 1, of which so much of c is taken off.
static struct sums add_up(const struct comparison *of, size_t first, size_t end, double factor) {
    struct sums sums = {0};
    for (size_t k = first; k < end; k++) {
        const double variance = target_variance(of->target, of->counted, k, of->value[k]) +
                                (1 + of->share) * own_variance(of, k, first, end) +
                                of->open * of->open;
        const double common = common_error(of->target, k);
        const double difference = of->value[k] - of->target->value[k] - factor * common;
        if (!isfinite(difference) || !(variance > 0))
            continue;
        sums.square += difference * difference / variance;
        sums.along += common * difference / variance;
        sums.common += common * common / variance;
        sums.bins++;
    }
    return sums;
}

/// Values of a stretch; those beside it share half of them.
enum { STRETCH = 6 };

/// The stretch that is farthest off, in what noise alone exceeds with the chance over all of them.
/// Few values drown among the others, as those that few pairs reach. Of g(r): U of groups is made
/// smooth at the end.
static void find_stretch(const struct comparison *of, const struct verify_section *section,
                         double factor, double chance, struct verify_agreement *agreement) {
    const size_t end = section->first + section->count;
    struct statistics_independence known = section->known;
    const double independent = known.numbers / (double)section->count;
    agreement->stretch = (struct verify_stretch){.probable = 1};
    for (size_t first = section->first; first < end; first += STRETCH / 2) {
        const size_t last = end - first < STRETCH ? end : first + STRETCH;
        const struct sums sums = add_up(of, first, last, factor);
        known.numbers = independent * sums.bins;
        const double probable =
            find_probable(&known, chance * STRETCH / (2.0 * (double)section->count));
        const double misfit = sums.bins > 0 ? sums.square / sums.bins : 0;
        if (misfit * agreement->stretch.probable > agreement->stretch.misfit * probable)
            agreement->stretch =
                (struct verify_stretch){first, last - first, misfit, probable, false};
    }
}

/// Pairs in the core, where the target has none: what the samples of a fit do not judge, as it has
/// no equations there. They are one number, as they came through one gap; of the target's counts,
/// which are none, the error is that of those which the result expects. Fewer pairs than the
/// target's few are no fault, as these tell nothing.
static void find_core(const struct comparison *of, const struct verify_section *section,
                      double chance, struct verify_agreement *agreement) {
    const size_t end = section->first + section->count;
    const struct statistics_independence one = {1, section->known.freedom};
    const struct target *const target = of->target;
    struct verify_stretch core = {.first = end, .core = true};
    double more = 0, variance = 0;
    for (size_t k = section->first - section->core; k < section->first; k++) {
        const double r = mf_rdf_bins_centre(of->bins, k % of->bins->count);
        const double value = of->value[k], wanted = fmax(0, target->value[k]);
        if (!(value > section->threshold) && !(wanted > section->threshold))
            continue;
        const double count =
            value_of_count(target->value, target->error, of->bins, k, section->first, end);
        more += r * r * (value - fmax(wanted, section->threshold));
        variance += pow(r, 4) * (fmax(target_variance(target, true, k, value), value * count) +
                                 (1 + of->share) * own_variance(of, k, section->first, end));
        core.first = k < core.first ? k : core.first;
    }
    if (!(more > 0) || !(variance > 0))
        return;
    core.count = section->first - core.first;
    core.misfit = more * more / variance;
    core.probable = find_probable(&one, chance * STRETCH / (2.0 * (double)section->count));
    if (core.misfit * agreement->stretch.probable > agreement->stretch.misfit * core.probable)
        agreement->stretch = core;
}

static struct verify_agreement assess(const struct targets *targets,
                                      const struct verify_section *section,
                                      const struct observed *observed, double share,
                                      double chance) {
    struct comparison of = compare(targets, section->kind, observed, share);
    of.counted = true;
    const struct sums sums = add_up(&of, section->first, section->first + section->count, 0);
    const double factor = sums.along / (1 + sums.common);
    struct target part = *of.target;
    part.count = section->count;
    part.value += section->first;
    part.error += section->first;
    struct verify_agreement agreement = {
        .distance =
            mf_targets_distance(&part, of.value + section->first, of.error + section->first),
        .misfit = sums.bins > 0 ? (sums.square - sums.along * factor) / sums.bins : 0,
        .probable = find_probable(&section->known, chance),
        .part = {0, 1, section->first, section->count}};
    if (section->kind == TARGET_RDF) {
        find_stretch(&of, section, factor, chance, &agreement);
        find_core(&of, section, chance, &agreement);
    }
    return agreement;
}

/// Keep what noise alone explains least.
static void keep(struct verify_agreement *worst, struct verify_agreement own) {
    if (worst->probable == 0 || verify_agreement_off(&own) > verify_agreement_off(worst))
        *worst = own;
}

// Targets without sections ------------------------------------------------------------------------

/// The rms difference over a part, and that of its errors, those of the fit's samples, too.
static struct target_distance distance_of(const struct comparison *of,
                                          const struct verify_part *part) {
    struct target_distance distance = {0};
    double squares = 0, noise = 0;
    for (size_t n = 0; n < part->rows * part->columns; n++) {
        const size_t k = (part->row + n / part->columns) * of->target->columns + part->column +
                         n % part->columns;
        const double difference = of->value[k] - of->target->value[k];
        if (!isfinite(difference))
            continue;
        squares += difference * difference;
        noise += pow(known_or_0(of->target->error[k]), 2) +
                 (1 + of->share) * pow(known_or_0(of->error[k]), 2) + of->open * of->open;
        distance.count++;
    }
    distance.rms = sqrt(squares / (double)distance.count);
    distance.noise = sqrt(noise / (double)distance.count);
    return distance;
}

/// Where the values end that have the error of their factor in common with value k.
static size_t end_of_pair(const struct target *target, size_t k) {
    const size_t pair = target->count / (target->pairs > 0 ? target->pairs : 1);
    return target->factor_error ? (k / pair + 1) * pair : target->count;
}

static struct verify_agreement assess_part(const struct comparison *of,
                                           const struct verify_part *part, double probable) {
    double square = 0, bins = 0;
    for (size_t row = part->row; row < part->row + part->rows; row++) {
        const size_t first = row * of->target->columns + part->column;
        const size_t end = first + part->columns;
        for (size_t k = first, next = first; k < end; k = next) {
            next = end_of_pair(of->target, k) < end ? end_of_pair(of->target, k) : end;
            const struct sums own = add_up(of, k, next, 0);
            square += own.square - own.along * own.along / (1 + own.common);
            bins += own.bins;
        }
    }
    return (struct verify_agreement){.distance = distance_of(of, part),
                                     .misfit = bins > 0 ? square / bins : 0,
                                     .probable = probable,
                                     .part = *part};
}

enum { MAX_EDGES = 66, TENTHS = 10 };

/// Where the parts of an axis begin, and its end: of times from one power of two to the next, of
/// others tenths. Returns how many parts there are.
static size_t find_edges(size_t count, bool of_time, size_t edge[MAX_EDGES]) {
    const size_t tenths = count < TENTHS ? count : TENTHS;
    size_t parts = 0;
    if (of_time)
        for (size_t k = 0; k < count; k = k == 0 ? 1 : 2 * k)
            edge[parts++] = k;
    else
        for (; parts < tenths; parts++)
            edge[parts] = parts * count / tenths;
    edge[parts] = count;
    return parts;
}

static bool is_curve_of_time(int kind) {
    const struct observable_kind found = mf_observable_kind(kind);
    return found.observable && found.target->form == OBSERVABLE_CURVE_OF_TIME;
}

/// The whole by its independent numbers, and each part as one number.
static void assess_curve(const struct comparison *of, int kind,
                         const struct statistics_independence *known, double chance,
                         struct verify_agreement *worst) {
    const bool matrix = of->target->columns > 0;
    const size_t columns = matrix ? of->target->columns : of->target->count;
    size_t row[MAX_EDGES], column[MAX_EDGES];
    const size_t above = find_edges(matrix ? of->target->count / columns : 1, true, row);
    const size_t across = find_edges(columns, !matrix && is_curve_of_time(kind), column);
    const size_t parts = above * across;
    const double own = parts > 1 ? 0.5 * chance : chance;
    const struct verify_part whole = {0, row[above], 0, columns};
    const struct statistics_independence one = {1, known->freedom};
    const double probable = find_probable(&one, own / (double)parts);
    keep(worst, assess_part(of, &whole, find_probable(known, own)));
    for (size_t p = 0; parts > 1 && p < parts; p++) {
        const size_t i = p / across, j = p % across;
        const struct verify_part part = {row[i], row[i + 1] - row[i], column[j],
                                         column[j + 1] - column[j]};
        keep(worst, assess_part(of, &part, probable));
    }
}

/// Whether a kind of targets is judged as a curve.
static bool is_curve(const struct targets *targets, const struct verify_sections *sections,
                     int kind) {
    return targets_ask(targets, kind) && sections->curve[kind].numbers > 0;
}

double mf_verify_agree(const struct targets *targets, const struct verify_sections *sections,
                       const struct observed *observed, double noise,
                       struct verify_agreement *agreement) {
    const double share = find_share(targets, observed, noise);
    size_t judged = sections->count;
    for (int kind = 0; kind < TARGETS; kind++)
        judged += is_curve(targets, sections, kind);
    const double chance = false_alarms / (double)judged;
    for (int kind = 0; kind < TARGETS; kind++) {
        agreement[kind] = (struct verify_agreement){0};
        if (!is_curve(targets, sections, kind))
            continue;
        const struct comparison of = compare(targets, kind, observed, share);
        assess_curve(&of, kind, &sections->curve[kind], chance, &agreement[kind]);
    }
    for (size_t s = 0; s < sections->count; s++)
        keep(&agreement[sections->section[s].kind],
             assess(targets, &sections->section[s], observed, share, chance));
    return share;
}

void mf_verify_compare(const struct targets *compared, const struct verify_sections *sections,
                       const struct observed *observed, double share, const double *open,
                       struct verify_agreement *agreement) {
    size_t judged = 0;
    for (int kind = 0; kind < TARGETS; kind++)
        judged += is_curve(compared, sections, kind) && isfinite(open[kind]);
    for (int kind = 0; kind < TARGETS; kind++) {
        agreement[kind] = (struct verify_agreement){0};
        if (!is_curve(compared, sections, kind) || !isfinite(open[kind]))
            continue;
        struct comparison of = compare(compared, kind, observed, share);
        of.open = open[kind];
        assess_curve(&of, kind, &sections->curve[kind], false_alarms / (double)judged,
                     &agreement[kind]);
    }
}
