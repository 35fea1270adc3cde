// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/joint.h"
#include "observe/kirkwood_buff_observable.h"

#include <math.h>

/// An error in units of its noise.
static double noises_of(double rms, double noise) {
    return rms > 0 ? rms / noise : 0;
}

/// Of the pressure, or of integrals of Kirkwood and Buff.
static double number_noises(const struct inversion *state, int kind) {
    const struct target_distance *distance = &state->distance[kind];
    return targets_ask(&state->problem->targets, kind) ? noises_of(distance->rms, distance->noise)
                                                       : 0;
}

static void find_worst_number(const struct joint *joint, size_t s, int kind,
                              struct joint_worst *worst) {
    const double noises = number_noises(&joint->state[s], kind);
    if (noises > worst->noises)
        *worst = (struct joint_worst){s, kind, noises};
}

static double section_noises(const struct joint *joint, size_t s, int k) {
    const struct inversion_section *section = &joint->state[s].section[k];
    return noises_of(section->rms, section->noise);
}

struct joint_worst mf_joint_targets_worst(const struct joint *joint) {
    struct joint_worst worst = {0, joint_leader(joint)->section[0].kind, 0};
    for (size_t s = 0; s < joint->states; s++) {
        for (int k = 0; k < joint->state[s].sections; k++)
            if (section_noises(joint, s, k) > worst.noises)
                worst = (struct joint_worst){s, joint->state[s].section[k].kind,
                                             section_noises(joint, s, k)};
        find_worst_number(joint, s, TARGET_PRESSURE, &worst);
        find_worst_number(joint, s, mf_kirkwood_buff_kind(), &worst);
    }
    return worst;
}

double mf_joint_targets_distance(const struct joint *joint) {
    double squares = 0, count = 0;
    for (size_t s = 0; s < joint->states; s++)
        for (int k = 0; k < TARGETS; k++) {
            const struct target_distance *distance = &joint->state[s].distance[k];
            if (!targets_ask(&joint->state[s].problem->targets, k))
                continue;
            squares += pow(noises_of(distance->rms, distance->noise), 2);
            count++;
        }
    return sqrt(squares / count);
}

/// A section of the first state becomes that of all.
static struct inversion_section join_section(const struct joint *joint, int k) {
    struct inversion_section all = joint_leader(joint)->section[k];
    size_t worst = 0;
    for (size_t s = 1; s < joint->states; s++) {
        const struct inversion_section *own = &joint->state[s].section[k];
        if (section_noises(joint, s, k) > section_noises(joint, worst, k))
            worst = s;
        if (own->own_noise * all.precision > all.own_noise * own->precision) {
            all.own_noise = own->own_noise;
            all.precision = own->precision;
        }
    }
    for (size_t s = 1; s < joint->states; s++) {
        const struct inversion_section *own = &joint->state[s].section[k];
        if (own->misfit * all.probable > all.misfit * own->probable) {
            all.misfit = own->misfit;
            all.probable = own->probable;
        }
    }
    all.rms = joint->state[worst].section[k].rms;
    all.noise = joint->state[worst].section[k].noise;
    return all;
}

/// The distance of a kind of targets, rms over the states.
static struct target_distance join_distance(const struct joint *joint, int kind) {
    struct target_distance all = {.count = 0};
    const double states = (double)joint->states;
    for (size_t s = 0; s < joint->states; s++) {
        const struct target_distance *own = &joint->state[s].distance[kind];
        all.rms += own->rms * own->rms / states;
        all.noise += own->noise * own->noise / states;
        all.variance += own->variance / states;
        all.count += own->count;
    }
    all.rms = sqrt(all.rms);
    all.noise = sqrt(all.noise);
    return all;
}

static void join_numbers(const struct joint *joint, int kind) {
    double noises = 0;
    for (size_t s = 0; s < joint->states; s++)
        noises = fmax(noises, number_noises(&joint->state[s], kind));
    struct target_distance *distance = &joint_leader(joint)->distance[kind];
    distance->rms = noises * distance->noise;
}

void mf_joint_targets_join(const struct joint *joint) {
    struct inversion *leader = joint_leader(joint);
    struct target_distance distance[TARGETS] = {{.count = 0}};
    double misfit = 0, disagreement = 0;
    for (size_t s = 0; s < joint->states; s++) {
        disagreement = fmax(disagreement, joint->state[s].disagreement);
        misfit += joint->state[s].misfit / (double)joint->states;
        if (joint->state[s].stretch > leader->stretch)
            leader->stretch = joint->state[s].stretch;
        leader->unsettled = leader->unsettled || joint->state[s].unsettled;
        if (leader->useless || !joint->state[s].useless)
            continue;
        leader->useless = true;
        leader->progress.unsettled = joint->state[s].progress.unsettled;
    }
    leader->disagreement = disagreement;
    leader->misfit = misfit;
    for (int k = 0; k < leader->sections; k++)
        distance[leader->section[k].kind] = join_distance(joint, leader->section[k].kind);
    leader->own_noise = 0;
    for (int k = 0; k < leader->sections; k++) {
        leader->distance[leader->section[k].kind] = distance[leader->section[k].kind];
        leader->section[k] = join_section(joint, k);
        leader->own_noise = fmax(leader->own_noise, leader->section[k].own_noise);
    }
    join_numbers(joint, TARGET_PRESSURE);
    join_numbers(joint, mf_kirkwood_buff_kind());
}
