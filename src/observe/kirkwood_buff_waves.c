// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/kirkwood_buff_waves.h"

#include "base/memory.h"

#include <math.h>

/// R_g of the largest molecules, as of a random walk whose steps are the mean distance of all
/// beads.
static double guess_size(const struct box *box, size_t beads, const struct topology *topology) {
    const double step = pow(mf_box_volume(box) / (double)beads, 1.0 / box->dimensions);
    int max = 1;
    for (int k = 0; topology && k < topology->kinds; k++)
        max = topology->kind[k].beads > max ? topology->kind[k].beads : max;
    return step * sqrt(max / 6.0);
}

double mf_kirkwood_buff_waves_maximum(const struct box *box, size_t sites, size_t beads,
                                      const struct topology *topology, double wish) {
    static const double part = 0.2; // of 2π ρ^(1/d), near the first peak of S
    const double density = (double)sites / mf_box_volume(box);
    const double of_sites = part * 2 * M_PI * pow(density, 1.0 / box->dimensions);
    return wish > 0 ? wish : fmin(of_sites, 1 / guess_size(box, beads, topology));
}

double mf_kirkwood_buff_waves_expected(const struct box *box, double q_maximum) {
    const double ball = mf_box_shell_volume(box, 0, q_maximum);
    return ball * mf_box_volume(box) / pow(2 * M_PI, box->dimensions) / 2;
}

static double squared_length(const struct density_waves *waves, size_t k) {
    double square = 0;
    for (int d = 0; d < 3; d++) {
        double q = 0;
        for (int i = 0; i < 3; i++)
            q += waves->wave[k].n[i] * waves->lattice[i][d];
        square += q * q;
    }
    return square;
}

/// Weights of the intercept of least squares, Σ (S − S_0 − c q²)².
static enum status find_weights(struct kirkwood_buff_waves *kb) {
    static const double same = 1e-6;
    const struct density_waves *waves = &kb->waves;
    const double count = (double)waves->vectors;
    double first = 0, second = 0;
    for (size_t k = 0; k < waves->vectors; k++) {
        const double x = squared_length(waves, k);
        first += x;
        second += x * x;
    }
    const double spread = count * second - first * first;
    if (!(spread > same * count * second))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the waves of the box up to q_maximum %.4g" STATUS_WAVE_NUMBER
                              " all have one length, so that S(q) cannot be "
                              "extrapolated to q = 0: take a box with more particles",
                              kb->q_maximum);
    for (size_t k = 0; k < waves->vectors; k++)
        kb->weight[k] = (second - squared_length(waves, k) * first) / spread;
    return STATUS_OK;
}

enum status mf_kirkwood_buff_waves_init(struct kirkwood_buff_waves *kb, const struct box *box,
                                        const struct composition *composition, size_t count,
                                        const struct topology *topology, double q_maximum) {
    const struct box_vectors vectors = mf_box_vectors_of(box);
    const struct composition *const components = &kb->sites.components;
    *kb = (struct kirkwood_buff_waves){.box = *box};
    TRY(mf_component_sites_init(&kb->sites, box->dimensions, composition, count, topology));
    kb->q_maximum = mf_kirkwood_buff_waves_maximum(
        box, (size_t)mf_composition_particles(components), count, topology, q_maximum);
    const struct density_waves_plan plan = {
        .composition = *components, .q_maximum = kb->q_maximum, .bins = 1};
    TRY(mf_density_waves_init(&kb->waves, &plan));
    TRY(mf_density_waves_list(&kb->waves, &vectors));
    TRY_ARRAY(kb->weight, kb->waves.vectors);
    return find_weights(kb);
}

void mf_kirkwood_buff_waves_clear(struct kirkwood_buff_waves *kb) {
    mf_density_waves_clear(&kb->waves);
    mf_component_sites_clear(&kb->sites);
    mf_memory_free(kb->weight);
    *kb = (struct kirkwood_buff_waves){0};
}

const struct composition *mf_kirkwood_buff_waves_components(const struct kirkwood_buff_waves *kb) {
    return &kb->sites.components;
}

/// Σ weight Re ρ_a ρ_b*.
static double extrapolate(const struct kirkwood_buff_waves *kb, const int type[2]) {
    const struct density_waves *waves = &kb->waves;
    const size_t types = (size_t)waves->plan.composition.types;
    double sum = 0;
    for (size_t k = 0; k < waves->vectors; k++) {
        const double *const rho = waves->amplitude + 2 * k * types;
        const double *const a = rho + 2 * type[0], *const b = rho + 2 * type[1];
        sum += kb->weight[k] * (a[0] * b[0] + a[1] * b[1]);
    }
    return sum;
}

static void find_waves(struct kirkwood_buff_waves *kb, const struct particles *particles,
                       int threads) {
    struct density_places places = {{NULL}, {0}};
    mf_component_sites_find(&kb->sites, particles);
    for (int d = 0; d < kb->box.dimensions; d++) {
        places.place[d] = kb->sites.site[d];
        places.unit[d] = 2 * M_PI / kb->box.length[d];
    }
    mf_density_waves_find(&kb->waves, &places, threads);
}

void mf_kirkwood_buff_waves_take(struct kirkwood_buff_waves *kb, const struct particles *particles,
                                 int threads, double *integral) {
    const struct composition *components = mf_kirkwood_buff_waves_components(kb);
    const double volume = mf_box_volume(&kb->box);
    find_waves(kb, particles, threads);
    for (int pair = 0; pair < mf_composition_pairs(components); pair++) {
        int type[2];
        mf_composition_pair_types(components, pair, type);
        const double a = (double)components->count[type[0]];
        const double b = (double)components->count[type[1]];
        integral[pair] =
            volume * (extrapolate(kb, type) / (a * b) - (type[0] == type[1] ? 1 / a : 0));
    }
}
