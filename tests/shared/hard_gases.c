// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/hard_gases.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/// Volume of a disc or sphere.
static double volume(int dimensions, double diameter) {
    return dimensions == 2 ? pi / 4 * pow(diameter, 2) : pi / 6 * pow(diameter, 3);
}

static void begin(struct hard_gas_scene *scene, int dimensions, int64_t count, double box_volume) {
    const double length = pow(box_volume, 1.0 / dimensions);
    *scene = (struct hard_gas_scene){
        .setup = {.box = {dimensions, {length, length, dimensions == 3 ? length : 1}},
                  .placement = {.count = count, .kind = PLACEMENT_RANDOM, .separation = 0.5},
                  .temperature = 1,
                  .time_step = 0.1,
                  .temperature_limit = 20,
                  .integrator = &mf_event_driven,
                  .seed = 1,
                  .threads = 1}};
    scene->setup.integrator_parameters = &scene->parameters;
}

void hard_gases_make(struct hard_gas_scene *scene, int dimensions, int64_t count, double eta) {
    begin(scene, dimensions, count, (double)count * volume(dimensions, 1) / eta);
}

void hard_gases_make_mixture(struct hard_gas_scene *scene, int dimensions, int64_t count,
                             double eta, const double diameter[2], const double mass[2]) {
    const double one = 0.5 * (volume(dimensions, diameter[0]) + volume(dimensions, diameter[1]));
    begin(scene, dimensions, count, (double)count * one / eta);
    scene->setup.composition = (struct composition){
        .types = 2, .count = {count / 2, count - count / 2}, .name = {"A", "B"}};
    scene->setup.attribute[ATTRIBUTES_RADIUS].ranges = 2;
    scene->setup.attribute[ATTRIBUTES_MASS].ranges = 2;
    for (int n = 0; n < 2; n++) {
        scene->setup.attribute[ATTRIBUTES_RADIUS].range[n] =
            (struct attributes_range){diameter[n] / 2, diameter[n] / 2};
        scene->setup.attribute[ATTRIBUTES_MASS].range[n] =
            (struct attributes_range){mass[n], mass[n]};
    }
}

const struct hard_gas *hard_gases_of(const struct simulation *simulation) {
    return &mf_event_driven_state(simulation)->gas;
}

double hard_gases_smallest_gap(const struct simulation *simulation) {
    const struct particles *p = &simulation->particles;
    const struct event_driven_parameters *parameters = simulation->setup.integrator_parameters;
    const double *radius = mf_particles_numbers(p, "radius");
    double smallest = INFINITY;
    for (size_t i = 0; i < p->count; i++)
        for (size_t j = 0; j <= i; j++) {
            const double s = radius ? radius[i] + radius[j] : 1;
            double square = 0;
            for (int d = 0; d < p->box.dimensions; d++) {
                const double length = p->box.length[d], x = p->position[d][i];
                const double straight = x - p->position[d][j];
                const bool walled = parameters->walls >> d & 1;
                const double r = walled ? straight : box_nearest(straight, length);
                square += r * r;
                if (walled && i == j)
                    smallest = fmin(smallest, (2 * fmin(x, length - x) - s) / s);
            }
            if (i != j)
                smallest = fmin(smallest, (sqrt(square) - s) / s);
        }
    return smallest;
}
