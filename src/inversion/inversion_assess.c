// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the samples of a state say beside its targets.
#include "base/statistics.h"
#include "inversion/inversion_state.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

const double mf_inversion_chance = 1e-3;

/// Share of the present samples in what all iterations near the target tell, at least.
static const double min_share = 1.0 / 3;

/// The gradient of coefficients, in its noise, below which C hardly changes any more.
static const double near_gradient = 3;

double mf_inversion_g(const struct inversion_state *state, size_t bin) {
    return state->replicas.counts.mean[bin] / state->target.ideal[bin];
}

double mf_inversion_target_g(const struct inversion_state *state, size_t bin) {
    return state->target.counts[bin] / state->target.ideal[bin];
}

/// Add a section to the distance of its kind, over the bins of all of them, with the mean variance
/// of the samples for its own.
static void add_distance(struct target_distance *distance, double sum, double both, double own,
                         double bins) {
    const double before = (double)distance->count, all = before + bins;
    distance->rms = sqrt((before * distance->rms * distance->rms + sum) / all);
    distance->noise = sqrt((before * distance->noise * distance->noise + both) / all);
    distance->variance = (before * distance->variance + own) / all;
    distance->count += (size_t)bins;
}

double mf_inversion_target_variance(const struct inversion_state *state, size_t a) {
    const size_t bin = state->grid.known_bin[a];
    const double error = state->target.error[bin];
    if (!(error > 0))
        return error * error;
    const double counts = fmax(state->target.counts[bin], error);
    return error * error * fmax(1, state->replicas.counts.mean[bin] / counts);
}

/// As how many independent bins those of a section count, which are off together with the bins
/// beside them: (Σ ρ_aa)²/Σ ρ_ab² by the correlations ρ of the samples; 0 if none was seen.
static double count_independent(const struct inversion_state *state,
                                const struct inversion_section *section) {
    const struct comoments *counts = &state->replicas.counts;
    const size_t end = section->known + section->known_count;
    const double samples = counts->count / section->inefficiency;
    double bins = 0, squares = 0;
    for (size_t a = section->known; a < end; a++) {
        const size_t i = state->grid.known_bin[a];
        const double own = mf_comoments_covariance(counts, i, i);
        if (!state->grid.seen[a])
            continue;
        bins++;
        for (size_t b = section->known; b < a && own > 0; b++) {
            const size_t j = state->grid.known_bin[b];
            const double other = mf_comoments_covariance(counts, j, j);
            if (state->grid.seen[b] && other > 0)
                squares +=
                    2 * mf_statistics_square_of_correlation(
                            pow(mf_comoments_covariance(counts, i, j), 2) / (own * other), samples);
        }
    }
    if (!(samples > 2))
        return fmin(bins, 1);
    return bins > 0 ? bins * bins / (bins + fmax(squares, 0)) : 0;
}

double mf_inversion_probable(const struct inversion_state *state,
                             const struct inversion_section *section, double chance) {
    const double independent = count_independent(state, section);
    return independent > 0 ? gsl_cdf_chisq_Qinv(chance, independent) / independent : INFINITY;
}

/// What a block's bins have in common with the error of its factor: u·x and |u|², with u that error
/// and x the excess in units of their noise.
static void find_common(const struct inversion_state *state, const double *excess, size_t begin,
                        size_t end, double *along, double *squares) {
    *along = *squares = 0;
    for (size_t a = begin; a < end; a++) {
        const double u = state->target.common[a] / sqrt(state->variance[a]);
        if (!state->grid.seen[a])
            continue;
        *along += u * excess[a] / sqrt(state->variance[a]);
        *squares += u * u;
    }
}

/// What the factors of pair types explain of the excess of a section.
struct explained {
    double misfit; ///< of χ²: Σ (u·x)²/(1 + |u|²)
    double square; ///< of Σ x², where each factor is the one that is most probable
    double noise;  ///< of Σ σ²: the most probable factor follows the noise of its bins
};

/// The most probable factor of a block, in its errors, explains f u of the excess, with
/// f = u·x/(1 + |u|²). What is left of noise has the covariance 1 − u uᵀ/(1 + |u|²), in units of
/// that of the bins.
static void explain_block(const struct inversion_state *state, const double *excess, size_t begin,
                          size_t end, struct explained *explained) {
    double along, squares;
    find_common(state, excess, begin, end, &along, &squares);
    const double factor = along / (1 + squares);
    explained->misfit += along * factor;
    for (size_t a = begin; a < end; a++) {
        const double unit = state->target.unit[state->grid.known_bin[a]];
        const double common = state->target.common[a] / unit, x = excess[a] / unit;
        if (!state->grid.seen[a])
            continue;
        explained->square += x * x - pow(x - factor * common, 2);
        explained->noise += common * common / (1 + squares);
    }
}

static struct explained explain(const struct inversion_state *state, const double *excess,
                                size_t begin, size_t end) {
    const struct potential_grid *grid = &state->grid;
    struct explained explained = {0};
    for (size_t block = 0, first = 0; state->target.common && block < grid->blocks; block++) {
        const size_t last = first + grid->known_of[block];
        if (first >= begin && last <= end)
            explain_block(state, excess, first, last, &explained);
        first = last;
    }
    return explained;
}

double mf_inversion_chi_squared(const struct inversion_state *state, const double *excess,
                                size_t begin, size_t end) {
    double sum = 0;
    for (size_t a = begin; a < end; a++)
        sum += state->grid.seen[a] ? excess[a] * excess[a] / state->variance[a] : 0;
    return sum - explain(state, excess, begin, end).misfit;
}

struct inversion_factor mf_inversion_factor_of(const struct inversion_state *state, size_t pair) {
    const struct potential_grid *grid = &state->grid;
    const double *prior = state->problem->targets.target[TARGET_RDF].factor_error;
    double along, squares;
    size_t first = 0;
    if (state->target.common == NULL || prior == NULL)
        return (struct inversion_factor){0};
    for (size_t n = 0; n < pair; n++)
        first += grid->known_of[n];
    find_common(state, state->excess, first, first + grid->known_of[pair], &along, &squares);
    return (struct inversion_factor){.missing = prior[pair] * along / (1 + squares),
                                     .prior = squares > 0 ? prior[pair] : 0};
}

void mf_inversion_find_factor(const struct inversion_state *state,
                              struct inversion_factor *factor) {
    *factor = (struct inversion_factor){0};
    for (size_t pair = 0; pair < state->grid.pairs; pair++) {
        const struct inversion_factor own = mf_inversion_factor_of(state, pair);
        if (own.prior > 0 && fabs(own.missing) * factor->prior >= fabs(factor->missing) * own.prior)
            *factor = own;
    }
}

/// Samples that count as one independent, of each pair type by itself: where chains among single
/// beads forget slowly, these do not.
static void find_inefficiencies(struct inversion_state *state, struct inversion_section *section) {
    const struct potential_grid *grid = &state->grid;
    const struct replicas *replicas = &state->replicas;
    const double every = (double)replicas->every;
    const double run = replicas->counts.count / (double)replicas->count * every;
    double sum = 0;
    for (size_t block = 0, first = 0; block < grid->blocks; first += grid->known_of[block++]) {
        const size_t *bin = grid->known_bin + first, count = grid->known_of[block];
        if (first < section->known || first >= section->known + section->known_count)
            continue;
        // Blocks of samples do not see what lasts longer than they do, nor short runs.
        const double seen = fmax(mf_replicas_inefficiency(replicas, REPLICAS_BLOCKS, bin, count),
                                 mf_replicas_inefficiency(replicas, 1, bin, count));
        const double found = mf_inversion_memory_recall(&state->memory[block], every, run, seen);
        for (size_t a = first; a < first + count; a++)
            state->bin_inefficiency[a] = found;
        sum += found * (double)count;
    }
    section->inefficiency = section->known_count > 0 ? sum / (double)section->known_count : 1;
}

/// Bins of a section that have a target.
static double count_told(const struct inversion_state *state,
                         const struct inversion_section *section) {
    double told = 0;
    for (size_t n = section->bin; n < section->bin + section->bins; n++)
        told += isfinite(state->target.unit[n]);
    return told;
}

/// Mean over the bins of a section of the variance of their target, in its units.
static double mean_target_variance(const struct inversion_state *state,
                                   const struct inversion_section *section) {
    double sum = 0;
    for (size_t a = section->known; a < section->known + section->known_count; a++)
        if (state->grid.seen[a])
            sum += mf_inversion_target_variance(state, a) /
                   pow(state->target.unit[state->grid.known_bin[a]], 2);
    return sum / count_told(state, section);
}

/// Of one section; returns its χ².
static double assess(struct inversion_state *state, struct inversion_section *section) {
    const struct comoments *counts = &state->replicas.counts;
    const size_t *known_bin = state->grid.known_bin;
    const double bins = count_told(state, section);
    const double mean = mean_target_variance(state, section);
    double sum = 0, own = 0, both = 0, whole = 0, alone = 0, followed = 0, seen = 0, wanted = 0;
    find_inefficiencies(state, section);
    for (size_t n = section->bin; n < section->bin + section->bins; n++)
        sum += pow((counts->mean[n] - state->target.counts[n]) / state->target.unit[n], 2);
    for (size_t a = section->known; a < section->known + section->known_count; a++) {
        const size_t bin = known_bin[a];
        const double unit = state->target.unit[bin] * state->target.unit[bin];
        // An empty bin still has the uncertainty of one count.
        const double sampled = fmax(mf_comoments_covariance(counts, bin, bin), 1 / counts->count) *
                               state->bin_inefficiency[a] / counts->count;
        const double target = mf_inversion_target_variance(state, a);
        const double common = state->target.common ? state->target.common[a] : 0;
        state->excess[a] = counts->mean[bin] - state->target.counts[bin];
        state->variance[a] = sampled + target;
        if (!state->grid.seen[a])
            continue;
        seen++;
        own += sampled / unit;
        wanted += sampled / fmax(unit, mean > 0 ? target / mean : 0);
        alone += sampled / state->variance[a];
        followed += state->pool.samples > 0 ? state->pool.variance[a] / state->variance[a] : 0;
        both += state->variance[a] / unit;
        whole += (state->variance[a] + common * common) / unit;
    }
    const double misfit = mf_inversion_chi_squared(state, state->excess, section->known,
                                                   section->known + section->known_count);
    const struct explained explained =
        explain(state, state->excess, section->known, section->known + section->known_count);
    add_distance(&state->assessment.distance[section->kind], sum, whole, own, bins);
    section->rms = sqrt(fmax(0, sum - explained.square) / bins) / section->peak;
    section->noise = sqrt(fmax(0, both - explained.noise) / bins) / section->peak;
    section->misfit = seen > 0 ? misfit / seen : 0;
    section->own_misfit = seen > 0 ? alone / seen : 0;
    // The potential follows the noise of the samples that it was made from.
    section->probable = mf_inversion_probable(state, section, mf_inversion_chance) *
                        (1 + (seen > 0 ? followed / seen : 0));
    section->own_noise = sqrt(wanted / bins) / section->peak;
    // p of a group need not be known better than that of its target, which has as many bins.
    section->precision = state->parameters->precision;
    if (section->kind != TARGET_RDF)
        section->precision = fmax(section->precision, sqrt((both - own) / bins) / section->peak);
    return misfit;
}

/// Bins of which the targets tell.
static double count_seen(const struct potential_grid *grid) {
    double count = 0;
    for (size_t a = 0; a < grid->known; a++)
        count += grid->seen[a];
    return count;
}

/// From the mean variance of the bins to that of their rms.
static void finish_distance(struct inversion_state *state, int kind) {
    struct target_distance *distance = &state->assessment.distance[kind];
    bool counted = false;
    for (int k = 0; k < state->assessment.sections; k++)
        counted = counted || state->assessment.section[k].kind == kind;
    if (counted)
        distance->variance =
            mf_targets_rms_variance(distance->rms, distance->variance, (double)distance->count);
}

void mf_inversion_assess(struct inversion_state *state) {
    double misfit = 0;
    state->assessment.own_noise = state->inefficiency = 0;
    for (int k = 0; k < state->assessment.sections; k++)
        state->assessment.distance[state->assessment.section[k].kind] = (struct target_distance){0};
    for (int k = 0; k < state->assessment.sections; k++) {
        const struct inversion_section *section = &state->assessment.section[k];
        misfit += assess(state, &state->assessment.section[k]);
        state->assessment.own_noise = fmax(state->assessment.own_noise, section->own_noise);
        state->inefficiency = fmax(state->inefficiency, section->inefficiency);
    }
    for (int kind = 0; kind < TARGETS; kind++)
        finish_distance(state, kind);
    state->assessment.disagreement = mf_replicas_disagreement(
        &state->replicas, state->target.ideal, state->grid.known_bin, state->grid.known);
    state->assessment.misfit = misfit / count_seen(&state->grid);
    mf_inversion_kirkwood_buff_measure(state);
}

bool mf_inversion_state_is_near(const struct inversion_state *state) {
    if (state->basis.count > 0)
        return state->gradient < near_gradient;
    return mf_inversion_assessment_is_near(&state->assessment, state->pool.samples > 0);
}

/// The mean excess of the pool, S̄ at the mean potential Φ̄, at the present one: S̄ − C (Φ − Φ̄)/k_B T.
static void move_pool(struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const double *response = mf_inversion_response_values(state);
    const double temperature = state->problem->scene.temperature;
    for (size_t a = 0; a < grid->known; a++)
        state->excess[a] = state->pool.excess[a];
    for (size_t b = 0; b < grid->known; b++) {
        const size_t point = grid->known_point[b];
        const double change = (state->phi[point] - state->pool.phi[point]) / temperature;
        for (size_t a = 0; a < grid->known; a++)
            state->excess[a] -= response[a * grid->known + b] * change;
    }
}

void mf_inversion_pool(struct inversion_state *state, bool alone) {
    const struct potential_grid *grid = &state->grid;
    double *pool = &state->pool.samples;
    const double now = state->replicas.counts.count;
    if (!mf_inversion_state_is_near(state)) {
        *pool = 0;
        return;
    }
    const double share = alone ? 1 : fmax(min_share, now / (*pool + now));
    for (size_t a = 0; a < grid->known; a++) {
        const double target = mf_inversion_target_variance(state, a);
        double *excess = &state->pool.excess[a], *sampled = &state->pool.variance[a];
        *excess = (1 - share) * *excess + share * state->excess[a];
        *sampled = pow(1 - share, 2) * *sampled + pow(share, 2) * (state->variance[a] - target);
        state->variance[a] = *sampled + target;
    }
    for (size_t k = 0; k < grid->points; k++)
        state->pool.phi[k] = (1 - share) * state->pool.phi[k] + share * state->phi[k];
    move_pool(state);
    *pool = 1 / (pow(1 - share, 2) / fmax(*pool, 1) + share * share / now);
}
