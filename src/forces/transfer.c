// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/transfer.h"

#include "base/simd.h"

#include <string.h>

void mf_transfer_collect(struct transfer *transfer, int parts, double scale) {
    if (transfer == NULL)
        return;
    for (int p = 0; p < parts; p++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                transfer->sum[a][b] += scale * transfer->part[p][a][b];
    memset(transfer->part, 0, (size_t)parts * sizeof *transfer->part);
}

SIMD_CLONES static double sum_products(const double *x, const double *y, const double *mass,
                                       size_t count) {
    enum { STRIPS = 8 };
    double sum[STRIPS] = {0}, rest = 0;
    const size_t whole = count / STRIPS * STRIPS;
    for (size_t k = 0; k < whole; k += STRIPS)
        for (size_t n = k; n < k + STRIPS; n++)
            sum[n - k] += mass ? mass[n] * x[n] * y[n] : x[n] * y[n];
    for (size_t k = whole; k < count; k++)
        rest += mass ? mass[k] * x[k] * y[k] : x[k] * y[k];
    for (int n = 0; n < STRIPS; n++)
        rest += sum[n];
    return rest;
}

void mf_transfer_carry(struct transfer *transfer, const struct particles *particles, double time) {
    if (transfer == NULL)
        return;
    const double *mass = particles_masses(particles);
    const int dimensions = particles->box.dimensions;
    const size_t count = particles->count;
    double momentum[3] = {0}, all = 0;
    for (size_t k = 0; k < count; k++)
        all += mass ? mass[k] : 1;
    for (int d = 0; d < dimensions; d++)
        for (size_t k = 0; k < count; k++)
            momentum[d] += (mass ? mass[k] : 1) * particles->velocity[d][k];
    for (int a = 0; a < dimensions; a++)
        for (int b = a; b < dimensions; b++) {
            const double product =
                sum_products(particles->velocity[a], particles->velocity[b], mass, count) -
                momentum[a] * momentum[b] / all;
            transfer->sum[a][b] += time * product;
            if (b != a)
                transfer->sum[b][a] += time * product;
        }
}
