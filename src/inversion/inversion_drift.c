// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_drift.h"

#include <math.h>

/// Way of the ramp over the memory that counts as a drift [k_B T]. Measured: fits that converge go
/// by 0.05 (water) to 1 (a soft fluid from −k_B T ln g) in as many iterations; the water above 3.5.
static const double long_way = 2;

/// The error of g that was left, as a part of that at the begin of the memory, if the way helps.
static const double helped = 0.75;

void mf_inversion_drift_add(struct inversion_drift *drift, double amplitude, double error) {
    const int place = drift->count++ % INVERSION_DRIFT_MEMORY;
    drift->amplitude[place] = amplitude;
    drift->error[place] = error;
}

/// The amplitude of `ago` iterations ago.
static int place_of(const struct inversion_drift *drift, int ago) {
    return (drift->count - 1 - ago) % INVERSION_DRIFT_MEMORY;
}

double mf_inversion_drift_way(const struct inversion_drift *drift) {
    double way = 0;
    if (drift->count < INVERSION_DRIFT_MEMORY)
        return 0;
    for (int ago = 0; ago + 1 < INVERSION_DRIFT_MEMORY; ago++) {
        const double step =
            drift->amplitude[place_of(drift, ago)] - drift->amplitude[place_of(drift, ago + 1)];
        if (way * step < 0)
            return 0;
        way += step;
    }
    return way;
}

bool mf_inversion_drifts(const struct inversion_drift *drift, double temperature) {
    if (!(fabs(mf_inversion_drift_way(drift)) > long_way * temperature))
        return false;
    return drift->error[place_of(drift, 0)] >
           helped * drift->error[place_of(drift, INVERSION_DRIFT_MEMORY - 1)];
}
