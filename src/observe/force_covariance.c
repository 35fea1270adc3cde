// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/force_covariance.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct force_covariance_plan, name)
const struct field mf_force_covariance_fields[] = {
    {"range", FIELD_NUMBER, MEMBER(range), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "range; 0: the cutoff of the friction weight"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 50, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "number of bins from r = 0"},
    FIELD_END,
};

static enum status check(const struct simulation *simulation, double range) {
    const struct simulation_setup *setup = &simulation->setup;
    if (setup->omega == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "force_covariance: the scene has no friction weight");
    if (setup->integrator->friction)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "force_covariance: \"%s\" splits friction and noise off the forces; use "
            "\"dynamics\": {\"integrator\": \"dpd-verlet\"}",
            setup->integrator->name);
    // A part in 10⁹ forgives a range that was rounded in another unit.
    if (range > mf_pair_cutoff(&simulation->law) * (1 + 1e-9))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "force_covariance: the range %g" STATUS_LENGTH
                              " exceeds %g" STATUS_LENGTH ", that of the forces",
                              range, mf_pair_cutoff(&simulation->law));
    return STATUS_OK;
}

enum status mf_force_covariance_init(struct force_covariance *covariance,
                                     const struct force_covariance_plan *plan,
                                     const struct simulation *simulation, size_t planned) {
    enum status status = STATUS_OK;
    const struct table *omega = simulation->setup.omega;
    const double range = plan->range > 0 || omega == NULL ? plan->range : omega->cutoff;
    *covariance = (struct force_covariance){.width = range / (double)plan->bins,
                                            .bins = (size_t)plan->bins,
                                            .planned = planned,
                                            .time_step = simulation->setup.time_step};
    CHECK(check(simulation, range));
    NEW_ARRAY(covariance->products, FORCE_COVARIANCE_BLOCKS * covariance->bins);
    NEW_ARRAY(covariance->pairs, FORCE_COVARIANCE_BLOCKS * covariance->bins);
done:
    if (status != STATUS_OK)
        mf_force_covariance_clear(covariance);
    return status;
}

void mf_force_covariance_clear(struct force_covariance *covariance) {
    mf_memory_free(covariance->products);
    mf_memory_free(covariance->pairs);
    *covariance = (struct force_covariance){0};
}

static double distance(const struct particles *particles, size_t i, size_t j) {
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double x = particles->position[d][i] - particles->position[d][j];
        const double nearest = box_nearest(x, particles->box.length[d]);
        square += nearest * nearest;
    }
    return sqrt(square);
}

void mf_force_covariance_sample(struct force_covariance *covariance,
                                const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const struct neighbours *neighbours = &simulation->neighbours;
    const size_t max = FORCE_COVARIANCE_BLOCKS - 1, sample = covariance->samples++;
    const size_t fair = sample * FORCE_COVARIANCE_BLOCKS / covariance->planned;
    const size_t first = (fair < max ? fair : max) * covariance->bins;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            const double place = distance(particles, i, j) / covariance->width;
            if (j == i || place >= (double)covariance->bins)
                continue;
            double product = 0;
            for (int d = 0; d < particles->box.dimensions; d++)
                product += particles->force[d][i] * particles->force[d][j];
            covariance->products[first + (size_t)place] += product;
            covariance->pairs[first + (size_t)place] += 1;
        }
}

/// Jackknife of a ratio of sums over blocks; blocks without pairs do not count.
static double find_error(const struct force_covariance *covariance, size_t bin, double products,
                         double pairs) {
    double filled = 0, changes = 0, squares = 0;
    for (size_t b = 0; b < FORCE_COVARIANCE_BLOCKS; b++) {
        const double here = covariance->pairs[b * covariance->bins + bin];
        if (here == 0 || here == pairs)
            continue;
        const double without = products - covariance->products[b * covariance->bins + bin];
        const double change = without / (pairs - here) - products / pairs;
        filled++;
        changes += change;
        squares += change * change;
    }
    if (filled < 2)
        return NAN;
    return sqrt(fmax(0, squares - changes * changes / filled) * (filled - 1) / filled);
}

void mf_force_covariance_result(const struct force_covariance *covariance, double *kappa,
                                double *error) {
    for (size_t bin = 0; bin < covariance->bins; bin++) {
        double products = 0, pairs = 0;
        for (size_t b = 0; b < FORCE_COVARIANCE_BLOCKS; b++) {
            products += covariance->products[b * covariance->bins + bin];
            pairs += covariance->pairs[b * covariance->bins + bin];
        }
        kappa[bin] = pairs > 0 ? -covariance->time_step * products / pairs : NAN;
        error[bin] = covariance->time_step * find_error(covariance, bin, products, pairs);
    }
}

void mf_force_covariance_extrapolate(const double time_step[2], const double *const kappa[2],
                                     const double *const error[2], size_t bins, double *squared,
                                     double *squared_error) {
    const double first = time_step[1] / (time_step[1] - time_step[0]), second = 1 - first;
    for (size_t k = 0; k < bins; k++) {
        squared[k] = first * kappa[0][k] + second * kappa[1][k];
        squared_error[k] = hypot(first * error[0][k], second * error[1][k]);
    }
}

size_t mf_force_covariance_spans(struct force_covariance *covariance, struct memory_span *spans) {
    const size_t bytes = FORCE_COVARIANCE_BLOCKS * covariance->bins * sizeof(double);
    size_t n = 0;
    spans[n++] = (struct memory_span){&covariance->samples, sizeof covariance->samples};
    spans[n++] = (struct memory_span){covariance->products, bytes};
    spans[n++] = (struct memory_span){covariance->pairs, bytes};
    return n;
}
