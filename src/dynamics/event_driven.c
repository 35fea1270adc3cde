// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/event_driven.h"

#include "base/clock.h"
#include "forces/molecules.h"
#include "system/cells.h"
#include "system/particles.h"

#include <math.h>
#include <stdbool.h>

// A start of hard discs or spheres without overlap ------------------------------------------------

/// Distances after a move, in sums of radii: a little more than contact, so that sweeps end.
static const double moved_to = 1 + 1e-3;

/// A fluid needs dozens of sweeps, one near jamming hundreds; what has not parted then has no room.
enum { MAX_SWEEPS = 5000 };

/// What an overlap may be, in sums of radii: the rounding of coordinates that were written down.
static const double tolerance = 1e-9;

/// The particles in cells at least as wide as the largest diameter.
struct grid {
    double *const *position;
    const double *radius;
    const struct box *box;
    size_t count;
    int walls;
    double largest; ///< radius
    struct cells sorted;
};

static bool is_walled(const struct grid *grid, int d) {
    return grid->walls >> d & 1;
}

static enum status grid_init(struct grid *grid, const struct particles *particles,
                             const double *radius, int walls) {
    *grid = (struct grid){.position = particles->position,
                          .radius = radius,
                          .box = &particles->box,
                          .count = particles->count,
                          .walls = walls};
    for (size_t k = 0; k < grid->count; k++)
        grid->largest = fmax(grid->largest, radius[k]);
    const double capacity = mf_box_volume(grid->box) / (double)grid->count;
    const double width =
        fmax(2 * moved_to * grid->largest, pow(capacity, 1.0 / grid->box->dimensions));
    int cells[3];
    mf_cells_fit_box(grid->box, width, 1e6, cells);
    return mf_cells_shape(&grid->sorted, cells, grid->count);
}

static void cell_of(const struct grid *grid, size_t k, int cell[3]) {
    for (int d = 0; d < 3; d++) {
        const double share =
            d < grid->box->dimensions ? grid->position[d][k] / grid->box->length[d] : 0;
        cell[d] = cells_along(share, grid->sorted.count[d]);
    }
}

static void fill_cells(struct grid *grid) {
    int cell[3];
    for (size_t k = 0; k < grid->count; k++) {
        cell_of(grid, k, cell);
        grid->sorted.of[k] = (uint32_t)cells_number(grid->sorted.count, cell);
    }
    mf_cells_sort(&grid->sorted);
}

/// From particle i to the nearest image of j; returns the distance.
static double separation(const struct grid *grid, size_t i, size_t j, double r[3]) {
    double square = 0;
    for (int d = 0; d < grid->box->dimensions; d++) {
        r[d] = grid->position[d][j] - grid->position[d][i];
        if (!is_walled(grid, d))
            r[d] = box_nearest(r[d], grid->box->length[d]);
        square += r[d] * r[d];
    }
    return sqrt(square);
}

/// Move both by half of what they lack; along x if they stand at one place.
static void part(const struct grid *grid, size_t i, size_t j, const double r[3], double distance,
                 double contact) {
    const double half = 0.5 * (moved_to * contact - distance);
    for (int d = 0; d < grid->box->dimensions; d++) {
        const double along = distance > 0 ? r[d] / distance : d == 0;
        grid->position[d][i] -= half * along;
        grid->position[d][j] += half * along;
    }
}

/// Look at all pairs of neighbouring cells, and part those that overlap if they are to be.
/// @param[out] pair  one that overlapped
/// @return whether one did
static bool sweep(const struct grid *grid, bool parts, size_t pair[2]) {
    bool found = false;
    const struct cells *cells = &grid->sorted;
    int cell[3];
    size_t around[CELLS_AROUND];
    for (size_t i = 0; i < grid->count; i++) {
        cell_of(grid, i, cell);
        const int near = mf_cells_around(cells->count, cell, grid->box->dimensions, around);
        for (int n = 0; n < near; n++)
            for (uint32_t at = cells->start[around[n] + 1]; at-- > cells->start[around[n]];) {
                const size_t j = cells->order[at];
                if (j <= i)
                    continue;
                double r[3];
                const double distance = separation(grid, i, j, r);
                const double contact = grid->radius[i] + grid->radius[j];
                if (distance >= contact * (1 - tolerance))
                    continue;
                found = true;
                pair[0] = i;
                pair[1] = j;
                if (!parts)
                    return true;
                part(grid, i, j, r, distance, contact);
            }
    }
    return found;
}

/// Into the box: between the walls, or by the period.
static void confine(const struct grid *grid) {
    for (int d = 0; d < grid->box->dimensions; d++)
        for (size_t k = 0; k < grid->count; k++) {
            const double length = grid->box->length[d], radius = grid->radius[k];
            double *x = &grid->position[d][k];
            if (is_walled(grid, d))
                *x = fmin(length - radius, fmax(radius, *x));
            else
                *x -= length * floor(*x / length);
        }
}

static enum status check_box(const struct grid *grid) {
    for (int d = 0; d < grid->box->dimensions; d++) {
        const double length = grid->box->length[d];
        if (length < (is_walled(grid, d) ? 2 : 4) * grid->largest)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "box: its edge %g" STATUS_LENGTH
                                  " is below %s of the largest particle, %g" STATUS_LENGTH,
                                  length, is_walled(grid, d) ? "the diameter" : "two diameters",
                                  2 * grid->largest);
    }
    return STATUS_OK;
}

/// Move the particles of a random or disturbed start apart until no two overlap: again and again
/// each overlapping pair is moved to a distance a little above contact. Denser than by sequential
/// addition, which ends at η = 0.547 and 0.38; positions are not those of equilibrium.
static enum status part_overlaps(struct particles *particles, const double *radius, int walls) {
    struct grid grid;
    size_t pair[2];
    enum status status = STATUS_OK;
    CHECK(grid_init(&grid, particles, radius, walls));
    CHECK(check_box(&grid));
    for (int n = 0; n < MAX_SWEEPS; n++) {
        confine(&grid);
        fill_cells(&grid);
        if (!sweep(&grid, true, pair))
            break;
    }
    confine(&grid);
done:
    mf_cells_clear(&grid.sorted);
    return status;
}

static enum status check_walls(const struct grid *grid, const uint32_t *id) {
    for (int d = 0; d < grid->box->dimensions; d++)
        for (size_t k = 0; k < grid->count && is_walled(grid, d); k++) {
            const double x = grid->position[d][k], radius = grid->radius[k];
            const double near = fmin(x, grid->box->length[d] - x);
            if (near < radius * (1 - tolerance))
                return mf_status_fail(
                    STATUS_BAD_INPUT,
                    "particle %u overlaps a wall of the axis %c at the start: its "
                    "centre is %.10g" STATUS_LENGTH " from it, its radius %g" STATUS_LENGTH,
                    id[k], "xyz"[d], near, radius);
        }
    return STATUS_OK;
}

static enum status check_start(const struct particles *particles, const double *radius, int walls) {
    struct grid grid;
    size_t pair[2];
    double r[3];
    enum status status = STATUS_OK;
    CHECK(grid_init(&grid, particles, radius, walls));
    CHECK(check_box(&grid));
    CHECK(check_walls(&grid, particles->id));
    fill_cells(&grid);
    if (!sweep(&grid, false, pair))
        goto done;
    const uint32_t a = particles->id[pair[0]], b = particles->id[pair[1]];
    status = mf_status_fail(STATUS_BAD_INPUT,
                            "particles %u and %u overlap at the start: they are %.10g" STATUS_LENGTH
                            " apart, their "
                            "radii %g" STATUS_LENGTH " and %g" STATUS_LENGTH,
                            a < b ? a : b, a < b ? b : a, separation(&grid, pair[0], pair[1], r),
                            radius[pair[a < b ? 0 : 1]], radius[pair[a < b ? 1 : 0]]);
done:
    mf_cells_clear(&grid.sorted);
    return status;
}

// The integrator ----------------------------------------------------------------------------------

static const struct event_driven_parameters *parameters_of(const struct simulation *simulation) {
    return simulation->setup.integrator_parameters;
}

const struct event_driven *mf_event_driven_state(const struct simulation *simulation) {
    return simulation->setup.integrator == &mf_event_driven ? simulation->integrator_state : NULL;
}

static enum status refuse(const char *key) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: \"event-driven\" moves hard particles, on which no forces act; "
                          "leave it out, or take another integrator",
                          key);
}

static enum status check(const struct simulation_setup *setup, int walls) {
    if (setup->potential)
        return refuse("conservative");
    if (setup->omega)
        return refuse("dissipative");
    if (mf_molecules_find(setup->interaction, setup->interactions))
        return refuse("molecules");
    if (setup->interactions > 0)
        return refuse("interactions");
    if (walls >> setup->box.dimensions)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.walls: the scene has two dimensions, and no axis z");
    return STATUS_OK;
}

/// What all particles have that the scene says nothing of.
static const double usual_radius = 0.5, usual_mass = 1;

static void fill(double *to, const double *from, double otherwise, size_t count) {
    for (size_t k = 0; k < count; k++)
        to[k] = from ? from[k] : otherwise;
}

/// They keep the energy that they begin with, which is therefore exactly that of the scene's
/// temperature. Momentum, 0 at first, is kept along axes without walls alone.
static enum status scale_velocities(struct particles *particles, int walls, double temperature) {
    double degrees = (double)particles->box.dimensions * (double)particles->count;
    for (int d = 0; d < particles->box.dimensions; d++)
        degrees -= walls >> d & 1 ? 0 : 1;
    const double energy = mf_particles_kinetic_energy(particles);
    if (!(energy > 0))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "particles.velocities: all velocities are equal; choose another \"seed\"");
    const double scale = sqrt(0.5 * degrees * temperature / energy);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] *= scale;
    return STATUS_OK;
}

/// What a file puts beyond a wall has been wrapped into the box.
static enum status check_inside(const struct particles *particles, int walls) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count && (walls >> d & 1); k++)
            if (particles->image[d][k] != 0)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "particles.file: particle %u is beyond a wall along %c",
                                      particles->id[k], "xyz"[d]);
    return STATUS_OK;
}

static enum status begin(struct simulation *simulation) {
    struct event_driven *state = simulation->integrator_state;
    struct particles *particles = &simulation->particles;
    const int walls = parameters_of(simulation)->walls;
    OWNED double *radius = NULL, *mass = NULL;
    TRY(check(&simulation->setup, walls));
    TRY_ARRAY(radius, particles->count);
    TRY_ARRAY(mass, particles->count);
    fill(radius, mf_particles_numbers(particles, "radius"), usual_radius, particles->count);
    fill(mass, particles_masses(particles), usual_mass, particles->count);
    if (simulation->velocities_drawn)
        TRY(scale_velocities(particles, walls, simulation->setup.temperature));
    if (simulation->setup.placement.kind != PLACEMENT_FILE)
        TRY(part_overlaps(particles, radius, walls));
    else
        TRY(check_inside(particles, walls));
    TRY(check_start(particles, radius, walls));
    TRY(mf_hard_gas_init(&state->gas, particles, radius, mass, walls));
    return mf_simulation_compute_forces(simulation, 0);
}

static void clear(void *state) {
    mf_hard_gas_clear(&((struct event_driven *)state)->gas);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct event_driven *own = state;
    const size_t n = mf_hard_gas_spans(&own->gas, spans);
    spans[n] = (struct memory_span){&own->virial, sizeof own->virial};
    return n + 1;
}

/// The virial of the step, as if forces had acted in it: that of its collisions over its time. No
/// forces are computed, and no list is built: there are none for which it would be needed.
static enum status step(struct simulation *simulation) {
    struct event_driven *state = simulation->integrator_state;
    const uint64_t collisions = state->gas.now.tally.collisions;
    const double dt = simulation->setup.time_step, time = (double)simulation->step * dt;
    const double begin = clock_seconds();
    const enum status status = mf_hard_gas_run(&state->gas, time, simulation->setup.cancel);
    const struct hard_gas_tally *after = &state->gas.now.tally;
    state->seconds += clock_seconds() - begin;
    state->collisions += after->collisions - collisions;
    if (status != STATUS_OK) {
        simulation->step--; // the rest of it is done by the next call
        return status;
    }
    mf_hard_gas_write(&state->gas, time, &simulation->particles);
    mf_particles_wrap(&simulation->particles);
    mf_particles_update_fractions(&simulation->particles);
    simulation->sums = (struct pair_sums){.virial = (after->virial - state->virial) / dt};
    state->virial = after->virial;
    return STATUS_OK;
}

/// In the order of the bits of the axes.
static const char *const walls[] = {"none", "x", "y", "xy", "z", "xz", "yz", "xyz", NULL};

static const struct field fields[] = {
    {"walls", FIELD_CHOICE, offsetof(struct event_driven_parameters, walls), .choices = walls,
     .unit = "", .help = "axes with reflecting walls at both ends; others are periodic"},
    FIELD_END,
};

const struct integrator mf_event_driven = {
    .name = "event-driven",
    .summary = "hard discs and spheres, from collision to collision; B. J. Alder and T. E. "
               "Wainwright, J. Chem. Phys. 31, 459 (1959)",
    .fields = fields,
    .parameters_size = sizeof(struct event_driven_parameters),
    .state_size = sizeof(struct event_driven),
    .begin = begin,
    .clear = clear,
    .spans = spans,
    .masses = true,
    .events = true,
    .step = step,
};
