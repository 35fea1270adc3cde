// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/cmaes.h"

#include <math.h>

static double square(double x) {
    return x * x;
}

/// µ_eff = (Σ w)²/Σ w² of the ranks from `begin` on, before `end`.
static double effective(const double *weights, size_t begin, size_t end) {
    double sum = 0, squares = 0;
    for (size_t k = begin; k < end; k++) {
        sum += weights[k];
        squares += square(weights[k]);
    }
    return squares > 0 ? square(sum) / squares : 0;
}

/// Rates of the covariance (eq. 56–58, α_cov = 2).
static void set_rates(struct cmaes_strategy *s, double n) {
    const double eff = s->effective;
    s->path = (4 + eff / n) / (n + 4 + 2 * eff / n);
    s->rank_one = 2 / (square(n + 1.3) + eff);
    s->rank_mu = fmin(1 - s->rank_one, 2 * (0.25 + eff + 1 / eff - 2) / (square(n + 2) + eff));
}

/// Positive weights add up to 1, negative ones to as much as keeps the covariance positive
/// (eq. 50–53).
static void scale_weights(struct cmaes_strategy *s, double n, double effective_negative) {
    double positive = 0, negative = 0;
    for (size_t k = 0; k < s->population; k++) {
        positive += fmax(s->weights[k], 0);
        negative += fmax(-s->weights[k], 0);
    }
    const double by_rates = 1 + s->rank_one / s->rank_mu;
    const double by_effective = 1 + 2 * effective_negative / (s->effective + 2);
    const double by_definiteness = (1 - s->rank_one - s->rank_mu) / (n * s->rank_mu);
    const double min = fmin(by_rates, fmin(by_effective, by_definiteness));
    s->weights_sum = 0;
    for (size_t k = 0; k < s->population; k++) {
        s->weights[k] *= s->weights[k] >= 0 ? 1 / positive : min / negative;
        s->weights_sum += s->weights[k];
    }
}

void mf_cmaes_strategy_set(struct cmaes_strategy *s, size_t variables) {
    const double n = (double)variables;
    s->parents = s->population / 2;
    for (size_t k = 0; k < s->population; k++)
        s->weights[k] = log(((double)s->population + 1) / 2) - log((double)k + 1); // eq. 49
    s->effective = effective(s->weights, 0, s->parents);
    const double effective_negative = effective(s->weights, s->parents, s->population);
    s->path_sigma = (s->effective + 2) / (n + s->effective + 5); // eq. 55
    s->damping = 1 + 2 * fmax(0, sqrt((s->effective - 1) / (n + 1)) - 1) + s->path_sigma;
    s->length = sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
    set_rates(s, n);
    scale_weights(s, n, effective_negative);
}
