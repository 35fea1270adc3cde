// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/thermodynamics.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "forces/reference_forces.h"

#include <math.h>

enum { BLOCKS = 20 };

enum status thermodynamics_init(struct thermodynamics *thermodynamics, size_t planned) {
    *thermodynamics = (struct thermodynamics){.planned = planned};
    thermodynamics->values = memory_zeroed(THERMODYNAMICS_QUANTITIES * planned, sizeof(double));
    return thermodynamics->values ? STATUS_OK : STATUS_NO_MEMORY;
}

void thermodynamics_clear(struct thermodynamics *thermodynamics) {
    memory_free(thermodynamics->values);
    *thermodynamics = (struct thermodynamics){0};
}

enum status thermodynamics_sample(struct thermodynamics *thermodynamics,
                                  const struct simulation *simulation) {
    double *here = thermodynamics->values + thermodynamics->samples;
    const size_t stride = thermodynamics->planned;
    const double count = (double)simulation->particles.count;
    here[THERMODYNAMICS_TEMPERATURE * stride] = simulation_temperature(simulation);
    here[THERMODYNAMICS_POTENTIAL_ENERGY * stride] = simulation->sums.energy / count;
    here[THERMODYNAMICS_PRESSURE * stride] = simulation_pressure(simulation);
    if (simulation->law.potential)
        TRY(reference_configurational(simulation->law.potential, &simulation->particles,
                                      &simulation->neighbours,
                                      &here[THERMODYNAMICS_FORCE_SQUARES * stride],
                                      &here[THERMODYNAMICS_LAPLACIAN * stride]));
    thermodynamics->samples++;
    return STATUS_OK;
}

const double *thermodynamics_series(const struct thermodynamics *thermodynamics,
                                    enum thermodynamics_quantity quantity) {
    return thermodynamics->values + (size_t)quantity * thermodynamics->planned;
}

/// Mean of a quantity over the samples begin … end − 1 of one replica.
static double block_mean(const struct thermodynamics *replica,
                         enum thermodynamics_quantity quantity, size_t begin, size_t end) {
    const double *series = thermodynamics_series(replica, quantity);
    double sum = 0;
    for (size_t k = begin; k < end; k++)
        sum += series[k];
    return sum / (double)(end - begin);
}

/// Mean and standard error of numerator/denominator over the blocks of all replicas.
static void blocked_ratio(const struct thermodynamics *replicas, size_t count,
                          enum thermodynamics_quantity numerator, int denominator, double *mean,
                          double *error) {
    struct running_mean blocks = {0}, above = {0}, below = {0};
    for (size_t r = 0; r < count; r++) {
        const size_t samples = replicas[r].samples;
        const size_t parts = samples < BLOCKS ? samples : BLOCKS;
        for (size_t b = 0; b < parts; b++) {
            const size_t begin = samples * b / parts, end = samples * (b + 1) / parts;
            const double top = block_mean(&replicas[r], numerator, begin, end);
            const double bottom =
                denominator < 0 ? 1
                                : block_mean(&replicas[r],
                                             (enum thermodynamics_quantity)denominator, begin, end);
            statistics_add(&above, top);
            statistics_add(&below, bottom);
            statistics_add(&blocks, top / bottom);
        }
    }
    *mean = above.mean / below.mean;
    *error = statistics_standard_error(&blocks);
}

struct thermodynamics_summary thermodynamics_result(const struct thermodynamics *replicas,
                                                    size_t count) {
    struct thermodynamics_summary s;
    blocked_ratio(replicas, count, THERMODYNAMICS_TEMPERATURE, -1, &s.temperature,
                  &s.temperature_error);
    blocked_ratio(replicas, count, THERMODYNAMICS_POTENTIAL_ENERGY, -1, &s.potential_energy,
                  &s.potential_energy_error);
    blocked_ratio(replicas, count, THERMODYNAMICS_PRESSURE, -1, &s.pressure, &s.pressure_error);
    blocked_ratio(replicas, count, THERMODYNAMICS_FORCE_SQUARES, THERMODYNAMICS_LAPLACIAN,
                  &s.temperature_configurational, &s.temperature_configurational_error);
    return s;
}
