// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/hard_theory.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

struct fluid {
    int dimensions;
    double density, temperature;
    double moment[4]; ///< ⟨σⁿ⟩
    double eta;
};

static struct fluid fluid_of(int dimensions, double volume, double temperature,
                             const double *radius, size_t count) {
    struct fluid fluid = {
        .dimensions = dimensions, .density = (double)count / volume, .temperature = temperature};
    for (size_t k = 0; k < count; k++) {
        const double diameter = 2 * radius[k];
        double power = 1 / (double)count;
        for (int n = 0; n < 4; n++, power *= diameter)
            fluid.moment[n] += power;
    }
    fluid.eta = fluid.density * fluid.moment[dimensions] * (dimensions == 2 ? pi / 4 : pi / 6);
    return fluid;
}

static double contact_of_discs(double eta) {
    const double capacity = 1 - eta;
    return (1 - 7 * eta / 16) / (capacity * capacity) - pow(eta, 3) / 128 / pow(capacity, 4);
}

/// What Kolafa adds to the contact value of Carnahan and Starling.
static double kolafa(double eta) {
    return (eta * eta / 12 - pow(eta, 3) / 6) / pow(1 - eta, 3);
}

static double compressibility_factor(const struct fluid *fluid) {
    const double *m = fluid->moment, eta = fluid->eta, capacity = 1 - eta;
    if (fluid->dimensions == 2) {
        const double alike = m[1] * m[1] / m[2];
        return (1 - alike) / capacity + alike * (1 + 2 * eta * contact_of_discs(eta));
    }
    const double unit = pi / 6 * fluid->density, xi = unit * m[2]; // ξ_0 = unit
    const double alike = pow(m[2], 3) / (m[3] * m[3]);
    return 1 / capacity + 3 * m[1] * xi / (capacity * capacity) +
           xi * xi * xi * (3 - eta) / (unit * capacity * capacity * capacity) +
           alike * 4 * eta * kolafa(eta);
}

static double contact_value(const struct fluid *fluid, double a, double b) {
    const double *m = fluid->moment, capacity = 1 - fluid->eta, tau = a * b / (a + b);
    if (fluid->dimensions == 2)
        return 1 / capacity + (contact_of_discs(fluid->eta) - 1 / capacity) * 2 * tau * m[1] / m[2];
    const double xi = pi / 6 * fluid->density * m[2] * tau;
    return 1 / capacity + 3 * xi / (capacity * capacity) +
           2 * xi * xi / (capacity * capacity * capacity) +
           kolafa(fluid->eta) * pow(2 * tau * m[2] / m[3], 2);
}

/// How often one of a species meets any of another, of that density.
static double rate(const struct fluid *fluid, const struct hard_theory_species *a,
                   const struct hard_theory_species *b, double density) {
    const double chi = contact_value(fluid, 2 * a->radius, 2 * b->radius);
    const double sigma = a->radius + b->radius;
    const double speed = sqrt(2 * pi * fluid->temperature * (1 / a->mass + 1 / b->mass));
    return density * chi * (fluid->dimensions == 2 ? sigma * speed : 2 * sigma * sigma * speed);
}

static double mean_speed(const struct fluid *fluid, double mass) {
    return sqrt((fluid->dimensions == 2 ? pi / 2 : 8 / pi) * fluid->temperature / mass);
}

/// Sort the particles into species; 0 if they are too many.
static int find_species(const double *radius, const double *mass, size_t count,
                        struct hard_theory_species species[HARD_THEORY_MAX_SPECIES]) {
    int found = 0;
    for (size_t k = 0; k < count; k++) {
        int n = 0;
        while (n < found && (species[n].radius != radius[k] || species[n].mass != mass[k]))
            n++;
        if (n == HARD_THEORY_MAX_SPECIES)
            return 0;
        if (n == found)
            species[found++] = (struct hard_theory_species){radius[k], mass[k], 0};
        species[n].count++;
    }
    return found;
}

struct hard_theory mf_hard_theory(int dimensions, double volume, double temperature,
                                  const double *radius, const double *mass, size_t count) {
    const struct fluid fluid = fluid_of(dimensions, volume, temperature, radius, count);
    struct hard_theory_species species[HARD_THEORY_MAX_SPECIES];
    const int found = find_species(radius, mass, count, species);
    double meetings = 0, speeds = 0; // of all particles
    for (int a = 0; a < found; a++) {
        for (int b = 0; b < found; b++)
            meetings += species[a].count *
                        rate(&fluid, &species[a], &species[b], species[b].count / volume);
        speeds += species[a].count * mean_speed(&fluid, species[a].mass);
    }
    return (struct hard_theory){
        .eta = fluid.eta,
        .compressibility_factor = compressibility_factor(&fluid),
        .collision_rate = found ? meetings / (double)count : NAN,
        .mean_free_path = found ? speeds / meetings : NAN,
    };
}
