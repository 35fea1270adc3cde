// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far several states are from their targets together.
#include "inversion/inversion_state.h"
#include "inversion/inversion_states.h"
#include "observe/kirkwood_buff.h"

#include <math.h>

/// An error in units of its noise.
static double noises_of(double rms, double noise) {
    return rms > 0 ? rms / noise : 0;
}

/// Of the pressure, or of integrals of Kirkwood and Buff.
static double number_noises(const struct inversion_state *state, int kind) {
    const struct target_distance *distance = &state->assessment.distance[kind];
    return targets_ask(&state->problem->targets, kind) ? noises_of(distance->rms, distance->noise)
                                                       : 0;
}

static double section_noises(const struct inversion_state *state, int k) {
    return noises_of(state->assessment.section[k].rms, state->assessment.section[k].noise);
}

struct inversion_worst mf_inversion_states_worst(const struct inversion_state *state,
                                                 size_t states) {
    const int number[] = {TARGET_PRESSURE, TARGET_DENSITY, mf_kirkwood_buff_kind()};
    struct inversion_worst worst = {0, state->assessment.section[0].kind, 0};
    for (size_t s = 0; s < states; s++) {
        for (int k = 0; k < state[s].assessment.sections; k++)
            if (section_noises(&state[s], k) > worst.noises)
                worst = (struct inversion_worst){s, state[s].assessment.section[k].kind,
                                                 section_noises(&state[s], k)};
        for (size_t k = 0; k < sizeof number / sizeof *number; k++)
            if (number_noises(&state[s], number[k]) > worst.noises)
                worst = (struct inversion_worst){s, number[k], number_noises(&state[s], number[k])};
    }
    return worst;
}

double mf_inversion_states_distance(const struct inversion_state *state, size_t states) {
    double squares = 0, count = 0;
    for (size_t s = 0; s < states; s++)
        for (int k = 0; k < TARGETS; k++) {
            const struct target_distance *distance = &state[s].assessment.distance[k];
            if (!targets_ask(&state[s].problem->targets, k))
                continue;
            squares += pow(noises_of(distance->rms, distance->noise), 2);
            count++;
        }
    return sqrt(squares / count);
}

/// The distance of a kind of targets, rms over the states.
static struct target_distance join_distance(const struct inversion_state *state, size_t count,
                                            int kind) {
    struct target_distance all = {.count = 0};
    const double states = (double)count;
    for (size_t s = 0; s < count; s++) {
        const struct target_distance *own = &state[s].assessment.distance[kind];
        all.rms += own->rms * own->rms / states;
        all.noise += own->noise * own->noise / states;
        all.variance += own->variance / states;
        all.count += own->count;
    }
    all.rms = sqrt(all.rms);
    all.noise = sqrt(all.noise);
    return all;
}

static void join_number(const struct inversion_state *state, size_t states, int kind,
                        struct target_distance *all) {
    double noises = 0;
    for (size_t s = 0; s < states; s++)
        noises = fmax(noises, number_noises(&state[s], kind));
    all->rms = noises * all->noise;
}

/// As many times as much as the noise as the state that is farthest off in what it can be asked
/// for.
static void join_reach(const struct inversion_state *state, size_t states,
                       struct inversion_assessment *all) {
    double farthest = 0;
    for (size_t s = 0; s < states; s++) {
        const struct inversion_assessment *own = &state[s].assessment;
        if (mf_inversion_bulk_is_asked(&state[s]))
            farthest =
                fmax(farthest, noises_of(own->distance[mf_inversion_bulk_kind(&state[s])].rms,
                                         own->bulk_reach));
    }
    const struct target_distance *distance = &all->distance[mf_inversion_bulk_kind(state)];
    all->bulk_reach = farthest > 0 ? distance->rms / farthest : distance->noise;
}

/// From the section of the first state to that of all.
static void join_section(const struct inversion_state *state, size_t states, int k,
                         struct inversion_section *all) {
    size_t worst = 0;
    for (size_t s = 1; s < states; s++) {
        const struct inversion_section *own = &state[s].assessment.section[k];
        if (section_noises(&state[s], k) > section_noises(&state[worst], k))
            worst = s;
        if (own->own_noise * all->precision > all->own_noise * own->precision) {
            all->own_noise = own->own_noise;
            all->precision = own->precision;
        }
        if (own->misfit * all->probable > all->misfit * own->probable) {
            all->misfit = own->misfit;
            all->probable = own->probable;
        }
    }
    all->rms = state[worst].assessment.section[k].rms;
    all->noise = state[worst].assessment.section[k].noise;
}

static void join_sections(const struct inversion_state *state, size_t states,
                          struct inversion_assessment *all) {
    all->own_noise = 0;
    for (int k = 0; k < all->sections; k++) {
        const int kind = all->section[k].kind;
        all->distance[kind] = join_distance(state, states, kind);
        join_section(state, states, k, &all->section[k]);
        all->own_noise = fmax(all->own_noise, all->section[k].own_noise);
    }
}

void mf_inversion_states_assess(const struct inversion_state *state, size_t states,
                                struct inversion_assessment *all) {
    *all = state->assessment;
    if (states == 1)
        return;
    all->misfit = all->disagreement = 0;
    for (size_t s = 0; s < states; s++) {
        const struct inversion_assessment *own = &state[s].assessment;
        all->disagreement = fmax(all->disagreement, own->disagreement);
        all->misfit += own->misfit / (double)states;
        all->stretch = own->stretch > all->stretch ? own->stretch : all->stretch;
        const bool found = all->unequilibrated.found || own->unequilibrated.found;
        const bool given_up = own->unequilibrated.found && own->unequilibrated.for_long;
        if (!all->useless && (own->useless || given_up))
            all->unequilibrated = own->unequilibrated;
        all->unequilibrated.found = found;
        all->useless = all->useless || own->useless;
    }
    join_sections(state, states, all);
    join_number(state, states, mf_inversion_bulk_kind(state),
                &all->distance[mf_inversion_bulk_kind(state)]);
    join_reach(state, states, all);
    join_number(state, states, mf_kirkwood_buff_kind(), &all->distance[mf_kirkwood_buff_kind()]);
}
