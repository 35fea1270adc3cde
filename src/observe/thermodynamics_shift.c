// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/thermodynamics.h"

#include "dynamics/respa.h"
#include "forces/molecules.h"

#include <math.h>

/// What fluctuates: the potential energy of all, Σ|F|², Σ∇²U and the pressure.
enum { ENERGY, SQUARES, LAPLACIAN, PRESSURE, FLUCTUATING };

/// Means and covariances over all replicas, each about its own mean.
struct fluctuations {
    double samples, mean[FLUCTUATING], covariance[FLUCTUATING][FLUCTUATING];
};

static void add_replica(const struct thermodynamics *replica, double particles,
                        struct fluctuations *all) {
    const double *series[FLUCTUATING] = {
        [ENERGY] = mf_thermodynamics_series(replica, THERMODYNAMICS_POTENTIAL_ENERGY),
        [SQUARES] = mf_thermodynamics_series(replica, THERMODYNAMICS_FORCE_SQUARES),
        [LAPLACIAN] = mf_thermodynamics_series(replica, THERMODYNAMICS_LAPLACIAN),
        [PRESSURE] = mf_thermodynamics_series(replica, THERMODYNAMICS_PRESSURE)};
    const double unit[FLUCTUATING] = {[ENERGY] = particles, 1, 1, 1};
    const size_t samples = replica->series.count;
    double mean[FLUCTUATING] = {0};
    for (int a = 0; a < FLUCTUATING; a++)
        for (size_t k = 0; k < samples; k++)
            mean[a] += unit[a] * series[a][k] / (double)samples;
    for (int a = 0; a < FLUCTUATING; a++) {
        all->mean[a] += (double)samples * mean[a];
        for (int b = 0; b < FLUCTUATING; b++)
            for (size_t k = 0; k < samples; k++)
                all->covariance[a][b] +=
                    (unit[a] * series[a][k] - mean[a]) * (unit[b] * series[b][k] - mean[b]);
    }
    all->samples += (double)samples;
}

static struct fluctuations find_fluctuations(const struct thermodynamics *replicas, size_t count,
                                             double particles) {
    struct fluctuations all = {0};
    for (size_t k = 0; k < count; k++)
        add_replica(&replicas[k], particles, &all);
    for (int a = 0; a < FLUCTUATING; a++) {
        all.mean[a] /= all.samples;
        for (int b = 0; b < FLUCTUATING; b++)
            all.covariance[a][b] /= all.samples - (double)count;
    }
    return all;
}

/// Response of the mean of `a` to the step, for Δt²/m = 1.
static double response(const struct fluctuations *f, int a, double temperature, double degrees) {
    const double heats = f->mean[LAPLACIAN] / (6 * degrees);
    const double *with = f->covariance[a];
    return (heats * with[ENERGY] - (with[SQUARES] - 0.5 * temperature * with[LAPLACIAN]) / 12) /
           temperature;
}

/// Whether the series are of the whole U, as all that acts knows its Laplacian, and a step is short
/// for all of it. It is not for bonds, whose (Ω Δt)² is near 1: of trimers with 0.8 a step makes
/// 0.048(5) of the pressure, and 0.020(3) is told.
static bool is_whole(const struct simulation_setup *setup) {
    for (int k = 0; k < setup->interactions; k++)
        if (setup->interaction[k].kind->laplacian == NULL ||
            setup->interaction[k].kind == &mf_molecules)
            return false;
    return true;
}

static bool is_known(const struct simulation_setup *setup) {
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    return setup->integrator->forces_midway && setup->potential && !mf_respa_acts(setup) &&
           simulation_holds_temperature(setup) && is_whole(setup) &&
           masses.maximum <= masses.minimum;
}

struct thermodynamics_shift mf_thermodynamics_shift(const struct thermodynamics *replicas,
                                                    size_t count,
                                                    const struct thermodynamics_summary *summary,
                                                    const struct simulation_setup *setup) {
    enum { MIN_SAMPLES = 100 };
    const double particles = (double)setup->placement.count, temperature = setup->temperature;
    const double degrees = setup->box.dimensions * particles;
    const struct fluctuations f = find_fluctuations(replicas, count, particles);
    if (f.samples < MIN_SAMPLES || !is_known(setup))
        return (struct thermodynamics_shift){NAN, NAN};
    const double off = response(&f, SQUARES, temperature, degrees) / f.mean[SQUARES] -
                       response(&f, LAPLACIAN, temperature, degrees) / f.mean[LAPLACIAN];
    const double ratio = response(&f, PRESSURE, temperature, degrees) / off;
    return (struct thermodynamics_shift){
        ratio * (summary->temperature_configurational / temperature - 1),
        fabs(ratio) * summary->temperature_configurational_error / temperature};
}
