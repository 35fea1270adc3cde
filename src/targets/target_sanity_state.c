// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_sanity_state.h"

#include "observe/kirkwood_buff.h"

#include <math.h>
#include <stdio.h>

static const double standard_errors = 3, frozen = 3.3;

/// How many times as compressible as an ideal gas a fluid of two phases is at least: Lennard-Jones
/// at 1.1 T_c has 2.8, dumbbells of two phases whose g stays above 1 have 2.5, liquids are below 1.
static const double several = 3, several_above_1 = 2;

/// Mean of g over the last quarter from which on it is said to stay above 1.
static const double above_1 = 1.01;

/// S at a wave number and its standard error.
struct wave {
    double value, error;
};

static struct wave wave_of(const struct target_state *state, double density, double q) {
    const double area = 4 * acos(-1) * density / q * state->bins->width;
    double sum = 0, variance = 0;
    for (size_t k = 0; k < state->bins->count; k++) {
        const double r = mf_rdf_bins_centre(state->bins, k), part = r * sin(q * r);
        sum += part * (state->g[k] - 1);
        variance += isnan(state->error[k]) ? 0 : pow(part * state->error[k], 2);
    }
    return (struct wave){1 + area * sum, area * sqrt(variance)};
}

/// The highest of 200 wave numbers about the first peak of liquids and crystals, 2π ρ^(1/3).
static struct wave highest_of(const struct target_state *state) {
    enum { WAVES = 200 };
    const double density = (double)state->count / mf_box_volume(state->box);
    const double unit = 2 * acos(-1) * cbrt(density);
    struct wave highest = {0, 0};
    for (int k = 0; k < WAVES; k++) {
        const struct wave now = wave_of(state, density, unit * (0.5 + 2.0 * k / WAVES));
        if (now.value > highest.value)
            highest = now;
    }
    return highest;
}

bool mf_target_state_print(const struct target_state *state, char line[TARGET_STATE_LINE]) {
    if (state->box->dimensions != 3 || state->count < 2)
        return false;
    const struct kirkwood_buff kb = mf_kirkwood_buff_integrate(
        state->bins, state->g, state->error, state->box, state->count, state->inside);
    const double value = kb.compressibility / (1 + state->bound);
    const double error = kb.compressibility_error / (1 + state->bound);
    if (value - standard_errors * error > (state->tail > above_1 ? several_above_1 : several)) {
        char tail[64] = "";
        if (state->tail > above_1)
            snprintf(tail, sizeof tail, ", and g ends at %.3f", state->tail);
        snprintf(line, TARGET_STATE_LINE,
                 "1 + rho G%s = %.3g(%.1g)%s: of two phases, or near a critical point? A fit may "
                 "condense; take g of one phase with its density, a shorter \"cutoff\", or give "
                 "\"pressure\"",
                 state->bound > 0 ? " of the molecules" : "", value, error, tail);
        return true;
    }
    if (state->bound > 0)
        return false;
    const struct wave highest = highest_of(state);
    if (!(highest.value - standard_errors * highest.error > frozen))
        return false;
    snprintf(line, TARGET_STATE_LINE,
             "its structure factor has a peak of %.3g, while liquids freeze at 2.85: of a crystal? "
             "A fit begins from disorder and finds no potential for it; take g of the liquid",
             highest.value);
    return true;
}

bool mf_target_state_print_whole(const struct target_state *state,
                                 const struct target_rdf_whole *whole,
                                 char line[TARGET_STATE_LINE]) {
    struct target_state other = *state;
    if (whole->bins.count == 0)
        return false;
    other.bins = &whole->bins;
    other.g = whole->g;
    other.error = whole->error;
    return mf_target_state_print(&other, line);
}
