// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_equilibrium.h"

#include "base/statistics.h"
#include "inversion/inversion_state.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>

/// Chance with which one of all tests of one look complains of samples in equilibrium.
static const double false_alarm = 1e-3;

/// Chance with which halves that have forgotten where they began are taken for different: it costs
/// no more than time.
static const double apart_alarm = 0.05;

/// Numbers that are tested: sections, and the sums of a sample.
enum { TESTS = 2, MAX_QUANTITIES = INVERSION_MAX_SECTIONS + SAMPLER_SUMS };

/// Σ t² of the middles of the blocks, in parts of the samples from their middle.
static const double times_squared =
    (REPLICAS_BLOCKS * REPLICAS_BLOCKS - 1) / (12.0 * REPLICAS_BLOCKS);

static double time_of(int block) {
    return (block + 0.5) / REPLICAS_BLOCKS - 0.5;
}

static const char *const sums[SAMPLER_SUMS] = {[SAMPLER_VIRIAL] = "the pressure",
                                               [SAMPLER_ENERGY] = "the energy",
                                               [SAMPLER_GYRATION] = "R_g^2 of the molecules",
                                               [SAMPLER_ENDS] = "R_e^2 of the molecules",
                                               [SAMPLER_DENSITY] = "the density",
                                               [SAMPLER_WAVES] = "the longest waves of the types"};

/// Numbers of a sample that are tested together.
struct quantity {
    size_t count, first;  ///< in a row of numbers, if there is no list of them
    const size_t *number; ///< or NULL
    const char *name;
};

static bool is_size(size_t sum) {
    return sum == SAMPLER_GYRATION || sum == SAMPLER_ENDS;
}

/// Add those sums that move, which are sizes of molecules or not.
static size_t list_sums(const struct inversion_state *state, bool sizes,
                        struct quantity quantity[MAX_QUANTITIES], size_t n) {
    for (size_t k = 0; k < SAMPLER_SUMS; k++)
        if (is_size(k) == sizes &&
            mf_comoments_covariance(&state->replicas.counts, state->bins + k, state->bins + k) > 0)
            quantity[n++] = (struct quantity){1, state->bins + k, NULL, sums[k]};
    return n;
}

/// @param[out] others  so many stand before the sizes of molecules; or NULL
static size_t list(const struct inversion_state *state, struct quantity quantity[MAX_QUANTITIES],
                   size_t *others) {
    size_t n = list_sums(state, false, quantity, 0);
    for (int k = 0; k < state->assessment.sections; k++) {
        const struct inversion_section *section = &state->assessment.section[k];
        quantity[n++] = (struct quantity){
            section->known_count, 0, state->grid.known_bin + section->known,
            section->kind == TARGET_RDF ? "g(r)" : mf_targets_name(section->kind)};
    }
    if (others)
        *others = n;
    return list_sums(state, true, quantity, n);
}

/// Bins with fewer counts in each block are tested with all others alone: they are not normal.
static const double frequent = 5;

static bool is_frequent(const struct replicas *replicas, size_t number) {
    const double blocks = (double)(replicas->count * REPLICAS_BLOCKS);
    return replicas->counts.mean[number] * replicas->counts.count >= frequent * blocks;
}

static enum status test(const struct inversion_state *state, const struct quantity *quantity,
                        struct stationary *result) {
    enum status status = STATUS_OK;
    const struct replicas *replicas = &state->replicas;
    const double *chain[REPLICAS_MAX];
    double *weight = NULL;
    bool *alone = NULL;
    NEW_ARRAY(weight, quantity->count);
    NEW_ARRAY(alone, quantity->count);
    for (size_t k = 0; k < replicas->count; k++)
        chain[k] = replicas->member[k].block;
    for (size_t n = 0; n < quantity->count; n++) {
        const size_t number = quantity->number ? quantity->number[n] : quantity->first;
        const double variance = mf_comoments_covariance(&replicas->counts, number, number);
        weight[n] = variance > 0 ? 1 / variance : 0;
        alone[n] = is_frequent(replicas, number);
    }
    CHECK(mf_stationary_test(&(struct stationary_numbers){.chains = replicas->count,
                                                          .chain = chain,
                                                          .row = replicas->numbers,
                                                          .count = quantity->count,
                                                          .number = quantity->number
                                                                        ? quantity->number
                                                                        : &quantity->first,
                                                          .weight = weight,
                                                          .alone = alone},
                             result));
done:
    mf_memory_free(weight);
    mf_memory_free(alone);
    return status;
}

/// The line through the blocks of a replica: returns the squares of what they are off it.
static double fit_line(const double *block, size_t numbers, double *mean, double *slope) {
    double squares = 0;
    *mean = *slope = 0;
    for (int b = 0; b < REPLICAS_BLOCKS; b++) {
        *mean += block[b * (ptrdiff_t)numbers] / REPLICAS_BLOCKS;
        *slope += block[b * (ptrdiff_t)numbers] * time_of(b) / times_squared;
    }
    for (int b = 0; b < REPLICAS_BLOCKS; b++)
        squares += pow(block[b * (ptrdiff_t)numbers] - *mean - *slope * time_of(b), 2);
    return squares;
}

double mf_inversion_equilibrium_shift(const struct replicas *replicas, size_t number) {
    struct running_mean chains = {0};
    const double count = (double)replicas->count;
    double shift = 0, squares = 0;
    for (size_t k = 0; k < replicas->count; k++) {
        double mean, slope;
        squares += fit_line(replicas->member[k].block + number, replicas->numbers, &mean, &slope);
        mf_statistics_add(&chains, mean);
        shift += slope / count;
    }
    const double noise = squares / (count * (REPLICAS_BLOCKS - 2));
    return shift * shift + pow(mf_statistics_standard_error(&chains), 2) -
           noise / count * (1 / times_squared + 1.0 / REPLICAS_BLOCKS);
}

/// The least chance that the replicas' means of a number differ so between the halves that begin on
/// both sides, by what they differ within them.
static double find_chance_of_sides(const struct replicas *replicas, size_t number) {
    const double count = (double)replicas->count;
    double contrast[REPLICAS_SIDES] = {0}, freedom = count - 1, largest = 0;
    struct running_mean all = {0};
    for (size_t k = 0; k < replicas->count; k++) {
        double mean, slope;
        fit_line(replicas->member[k].block + number, replicas->numbers, &mean, &slope);
        mf_statistics_add(&all, mean);
        for (int side = 0; side < REPLICAS_SIDES; side++)
            contrast[side] += replicas_side(k, (enum replicas_side)side) * mean / count;
    }
    double squares = all.squares, sides = 0;
    for (int side = 0; side < REPLICAS_SIDES; side++) {
        if (!replicas->begins[side])
            continue;
        const double square = count * contrast[side] * contrast[side];
        largest = fmax(largest, square);
        squares -= square;
        sides++;
    }
    freedom -= sides;
    if (!(squares > 0))
        return largest > 0 ? 0 : 1;
    return sides * gsl_cdf_fdist_Q(largest * freedom / squares, 1, freedom);
}

/// The first of the quantities in which halves of the replicas differ by where they began; their
/// number if none does.
static size_t find_apart(const struct replicas *replicas, const struct quantity *quantity,
                         size_t quantities) {
    for (size_t k = 0; k < quantities; k++) {
        double least = 1, tested = 0;
        for (size_t n = 0; n < quantity[k].count; n++) {
            const size_t number = quantity[k].number ? quantity[k].number[n] : quantity[k].first;
            if (!is_frequent(replicas, number) && quantity[k].number)
                continue;
            least = fmin(least, find_chance_of_sides(replicas, number));
            tested++;
        }
        if (tested > 0 && least * tested * (double)quantities < apart_alarm)
            return k;
    }
    return quantities;
}

/// Whether there are halves that begin on both sides, of enough replicas.
static bool has_sides(const struct replicas *replicas) {
    const bool tilts = replicas->begins[REPLICAS_TILT];
    return (tilts || replicas->begins[REPLICAS_STRETCH]) &&
           replicas->count >= REPLICAS_MIN_OF_SIDES && replicas->count % (tilts ? 4 : 2) == 0;
}

/// Take a quantity that is slower.
static void take_slower(struct inverse_slowest *slowest, double independent, const char *name) {
    if (slowest->quantity[0] != '\0' && !(independent < slowest->independent))
        return;
    slowest->independent = independent;
    snprintf(slowest->quantity, sizeof slowest->quantity, "%s", name);
}

void mf_inversion_equilibrium_slowest(const struct inversion_state *state,
                                      struct inverse_slowest *slowest) {
    const struct replicas *replicas = &state->replicas;
    struct quantity quantity[MAX_QUANTITIES];
    const size_t count = list(state, quantity, NULL);
    for (size_t k = 0; k < count; k++) {
        const size_t *number = quantity[k].number ? quantity[k].number : &quantity[k].first;
        const size_t numbers = quantity[k].count;
        // Quarters do not see what lasts longer than they do.
        const double independent =
            replicas->counts.count /
            fmax(mf_replicas_inefficiency(replicas, REPLICAS_BLOCKS, number, numbers),
                 mf_replicas_inefficiency(replicas, 1, number, numbers));
        take_slower(slowest, independent, quantity[k].name);
    }
    if (state->open.independent > 0)
        take_slower(slowest, state->open.independent, "the potential's ramp");
}

enum status mf_inversion_equilibrium_check(const struct inversion_state *state,
                                           struct inversion_unequilibrated *unequilibrated) {
    struct quantity quantity[MAX_QUANTITIES];
    size_t others;
    const size_t count = list(state, quantity, &others);
    double min = false_alarm / (double)(TESTS * count);
    const double limit = min;
    unequilibrated->found = unequilibrated->drifts = unequilibrated->beside_sizes = false;
    for (size_t k = 0; k < count; k++) {
        struct stationary is;
        TRY(test(state, &quantity[k], &is));
        const double chance = stationary_p_value(&is);
        unequilibrated->drifts = unequilibrated->drifts || is.drift < limit;
        unequilibrated->beside_sizes =
            unequilibrated->beside_sizes || (k < others && chance < limit);
        if (!(chance < min))
            continue;
        min = chance;
        unequilibrated->found = true;
        unequilibrated->is = is;
        snprintf(unequilibrated->quantity, sizeof unequilibrated->quantity, "%s", quantity[k].name);
    }
    const size_t apart =
        has_sides(&state->replicas) ? find_apart(&state->replicas, quantity, count) : count;
    unequilibrated->apart = apart < count;
    unequilibrated->beside_sizes = unequilibrated->beside_sizes || apart < others;
    if (unequilibrated->apart && !unequilibrated->found) {
        TRY(test(state, &quantity[apart], &unequilibrated->is));
        snprintf(unequilibrated->quantity, sizeof unequilibrated->quantity, "%s",
                 quantity[apart].name);
    }
    unequilibrated->found = unequilibrated->found || unequilibrated->apart;
    return STATUS_OK;
}

/// Whether replicas that began on both sides scatter by so little that what each of them still
/// remembers does not matter: halves that are not apart differ by no more than twice that.
static bool agrees_anyway(const struct inversion_state *state) {
    static const double part_of_precision = 1.0 / 3;
    const struct inversion_unequilibrated *unequilibrated = &state->assessment.unequilibrated;
    if (unequilibrated->drifts || unequilibrated->apart || !has_sides(&state->replicas))
        return false;
    for (int k = 0; k < state->assessment.sections; k++) {
        const struct inversion_section *section = &state->assessment.section[k];
        if (!(section->own_noise < part_of_precision * section->precision))
            return false;
    }
    return true;
}

void mf_inversion_equilibrium_reset(struct inversion_state *state) {
    struct inversion_unequilibrated *unequilibrated = &state->assessment.unequilibrated;
    if (!unequilibrated->found || agrees_anyway(state))
        state->work.mixed = true;
    if (state->work.mixed)
        unequilibrated->found = unequilibrated->drifts;
}
