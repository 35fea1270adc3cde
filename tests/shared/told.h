// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Observables by their records, told what a simulation holds now.
#pragma once

#include "observe/observable.h"

static inline enum status told_begin(const struct observable *observable, void *state,
                                     const void *settings, struct simulation *simulation,
                                     const struct measure_plan *plan) {
    const struct configuration now = mf_configuration_of(simulation);
    return observable->begin(state, settings, &now, plan);
}

static inline enum status told_sample(const struct observable *observable, void *state,
                                      struct simulation *simulation) {
    const struct configuration now = mf_configuration_of(simulation);
    return observable->sample(state, &now);
}
