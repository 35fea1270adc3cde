// SPDX-License-Identifier: GPL-3.0-or-later
//
// Free flight of one particle against plates and an obstacle. At both it sticks: it comes back the
// way it went (v to −v at the point of contact), so that the fluid next to them is at rest.
#include "dynamics/solvent.h"

#include <math.h>

/// From the centre of the obstacle to a point [λ]; plates are no mirror images of each other.
static void from_obstacle(const struct solvent *solvent, const double position[3],
                          double separation[3]) {
    const bool plates = solvent->parameters.walls == COLLISION_PLATES;
    for (int d = 0; d < solvent->box.dimensions; d++) {
        separation[d] = position[d] - solvent->parameters.obstacle_centre[d];
        if (!(plates && d == 1))
            separation[d] = box_nearest(separation[d], solvent->box.length[d]);
    }
}

bool mf_solvent_is_free(const struct solvent *solvent, const double position[3]) {
    const double radius = solvent->parameters.obstacle_radius;
    double separation[3], square = 0;
    from_obstacle(solvent, position, separation);
    for (int d = 0; d < solvent->box.dimensions; d++)
        square += separation[d] * separation[d];
    return square >= radius * radius;
}

/// Of the cell's point that is nearest to the obstacle's centre.
static bool is_cut_by_obstacle(const struct solvent *solvent, const int place[3]) {
    const double edge = solvent->parameters.cell, radius = solvent->parameters.obstacle_radius;
    double middle[3] = {0}, separation[3], square = 0;
    for (int d = 0; d < solvent->box.dimensions; d++)
        middle[d] = (place[d] + 0.5) * edge - solvent->shift[d];
    from_obstacle(solvent, middle, separation);
    for (int d = 0; d < solvent->box.dimensions; d++) {
        const double outside = fmax(0, fabs(separation[d]) - 0.5 * edge);
        square += outside * outside;
    }
    return square < radius * radius;
}

enum solvent_cut mf_solvent_cut(const struct solvent *solvent, size_t cell) {
    const int *cells = solvent->cells, number = (int)cell;
    const int place[3] = {number % cells[0], number / cells[0] % cells[1],
                          number / cells[0] / cells[1]};
    if (solvent->parameters.obstacle_radius > 0 && is_cut_by_obstacle(solvent, place))
        return SOLVENT_CUT_BY_OBSTACLE;
    const bool plates = solvent->parameters.walls == COLLISION_PLATES;
    return plates && (place[1] == 0 || place[1] == cells[1] - 1) ? SOLVENT_CUT_BY_PLATE
                                                                 : SOLVENT_UNCUT;
}

static double dot(const double a[3], const double b[3], int dimensions) {
    double sum = 0;
    for (int d = 0; d < dimensions; d++)
        sum += a[d] * b[d];
    return sum;
}

/// When a particle at a height y meets a plate; INFINITY: never.
static double time_to_plate(const struct solvent *solvent, double y, double v) {
    if (solvent->parameters.walls != COLLISION_PLATES || !(v != 0))
        return INFINITY;
    return fmax(0, v > 0 ? (solvent->box.length[1] - y) / v : -y / v);
}

/// When a particle meets the obstacle within `time`: where the chord of its way does, then by
/// Newton's method on the parabola. INFINITY: not.
static double time_to_obstacle(const struct solvent *solvent, const double position[3],
                               const double velocity[3], const double g[3], double time) {
    const int dimensions = solvent->box.dimensions;
    const double radius = solvent->parameters.obstacle_radius;
    double separation[3], chord[3];
    if (!(radius > 0))
        return INFINITY;
    from_obstacle(solvent, position, separation);
    for (int d = 0; d < dimensions; d++)
        chord[d] = velocity[d] + 0.5 * time * g[d];
    const double square = dot(chord, chord, dimensions);
    const double approach = dot(separation, chord, dimensions);
    const double beyond = dot(separation, separation, dimensions) - radius * radius;
    const double root = approach * approach - square * beyond;
    if (!(approach < 0) || !(root > 0))
        return INFINITY;
    double t = fmax(0, beyond / (sqrt(root) - approach));
    // What rises from the wall falls back no sooner than it would on a plane through its place.
    const double rise = dot(separation, velocity, dimensions),
                 pull = dot(separation, g, dimensions);
    if (rise > 0 && pull < 0)
        t = fmax(t, -2 * rise / pull);
    for (int n = 0; n < 3 && beyond > 0 && dot(g, g, dimensions) > 0; n++) {
        double at[3], speed[3];
        for (int d = 0; d < dimensions; d++) {
            at[d] = separation[d] + t * (velocity[d] + 0.5 * t * g[d]);
            speed[d] = velocity[d] + t * g[d];
        }
        const double slope = 2 * dot(at, speed, dimensions);
        if (!(slope < 0))
            return INFINITY; // it passes by
        t = fmax(0, t - (dot(at, at, dimensions) - radius * radius) / slope);
    }
    return t;
}

static void advance(int dimensions, double position[3], double velocity[3], const double g[3],
                    double time) {
    for (int d = 0; d < dimensions; d++) {
        position[d] += time * (velocity[d] + 0.5 * time * g[d]);
        velocity[d] += time * g[d];
    }
}

/// Rounding leaves no one behind a wall.
static void write_outside(const struct solvent *solvent, double position[3]) {
    const int dimensions = solvent->box.dimensions;
    const double radius = solvent->parameters.obstacle_radius;
    if (solvent->parameters.walls == COLLISION_PLATES)
        position[1] = fmin(fmax(position[1], 0), solvent->box.length[1]);
    if (!(radius > 0))
        return;
    double separation[3];
    from_obstacle(solvent, position, separation);
    const double distance = sqrt(dot(separation, separation, dimensions));
    for (int d = 0; d < dimensions && distance < radius && distance > 0; d++)
        position[d] += separation[d] * (radius / distance - 1);
}

/// How long a parabola may be taken for its chord in looking for the obstacle: between them are
/// less than 1e-4 of its radius.
static double longest_leg(const struct solvent *solvent, const double g[3]) {
    const double bend = sqrt(dot(g, g, solvent->box.dimensions)) / 8;
    const double radius = solvent->parameters.obstacle_radius;
    return radius > 0 && bend > 0 ? sqrt(1e-4 * radius / bend) : INFINITY;
}

/// A particle that the acceleration presses against a wall, so that it hops by next to
/// nothing, rests there and hands on what presses it.
static bool rests(const struct solvent *solvent, double position[3], const double velocity[3],
                  const double g[3], double hop, double time, double impulse[3]) {
    static const double min = 1e-4;
    const int dimensions = solvent->box.dimensions;
    if (!(hop * sqrt(dot(velocity, velocity, dimensions)) < min * solvent->parameters.cell))
        return false;
    write_outside(solvent, position);
    for (int d = 0; d < dimensions && impulse; d++)
        impulse[d] += time * g[d];
    return true;
}

bool mf_solvent_propagate(const struct solvent *solvent, double position[3], double velocity[3],
                          const double g[3], double time, double impulse[3]) {
    enum { MAX_MEETINGS = 10000 };
    const int dimensions = solvent->box.dimensions;
    const double longest = longest_leg(solvent, g);
    double hop = 0;
    for (int meetings = 0; meetings < MAX_MEETINGS;) {
        const double leg = fmin(time, longest);
        const double plate = time_to_plate(solvent, position[1], velocity[1]);
        const double obstacle = time_to_obstacle(solvent, position, velocity, g, leg);
        const double next = fmin(leg, fmin(plate, obstacle));
        advance(dimensions, position, velocity, g, next);
        time -= next;
        if (next < leg) {
            meetings++;
            hop = next;
            for (int d = 0; d < dimensions; d++) {
                if (impulse && obstacle < plate)
                    impulse[d] += 2 * velocity[d];
                velocity[d] = -velocity[d];
            }
        } else if (!(time > 0)) {
            write_outside(solvent, position);
            return true;
        }
    }
    return rests(solvent, position, velocity, g, hop, time, impulse);
}
