// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/solvent.h"

#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>

/// From the counts of each part to its places: after the earlier cells, and the earlier parts.
static void find_places(struct solvent *solvent) {
    uint32_t place = 0;
    for (size_t cell = 0; cell < solvent->cell_total; cell++) {
        solvent->start[cell] = place;
        for (int part = 0; part < solvent->parts; part++) {
            const uint32_t count = solvent->places[part][cell];
            solvent->places[part][cell] = place;
            place += count;
        }
    }
    solvent->start[solvent->cell_total] = place;
}

static void sort_plane(const struct solvent *solvent, int part) {
    uint32_t *restrict places = solvent->places[part];
    const double *x = solvent->position[0], *y = solvent->position[1];
    const double *vx = solvent->velocity[0], *vy = solvent->velocity[1];
    double *const *to = solvent->spare;
    const size_t end = solvent_part(solvent, solvent->count, part + 1);
    for (size_t k = solvent_part(solvent, solvent->count, part); k < end; k++) {
        const uint32_t place = places[solvent->cell[k]]++;
        to[0][place] = x[k];
        to[1][place] = y[k];
        to[3][place] = vx[k];
        to[4][place] = vy[k];
    }
}

static inline void fetch(const struct solvent *solvent, uint32_t place) {
    for (int d = 0; d < 6; d++)
        __builtin_prefetch(&solvent->spare[d][place], 1);
}

/// Particles beyond which memory is not in the caches of a core, and how many ahead a place is
/// fetched.
enum { FETCHED_FROM = 30000, AHEAD = 6 };

static void sort_space(const struct solvent *solvent, int part) {
    uint32_t *restrict places = solvent->places[part];
    double *const *to = solvent->spare;
    const size_t end = solvent_part(solvent, solvent->count, part + 1);
    const size_t fetches = solvent->count >= FETCHED_FROM ? end : 0;
    for (size_t k = solvent_part(solvent, solvent->count, part); k < end; k++) {
        const uint32_t place = places[solvent->cell[k]]++;
        if (k + AHEAD < fetches)
            fetch(solvent, places[solvent->cell[k + AHEAD]]);
        for (int d = 0; d < 3; d++) {
            to[d][place] = solvent->position[d][k];
            to[3 + d][place] = solvent->velocity[d][k];
        }
    }
}

static void sort_parts(void *context, size_t begin, size_t end) {
    const struct solvent *solvent = context;
    for (size_t part = begin / SOLVENT_STRETCH; part < end / SOLVENT_STRETCH; part++)
        if (solvent->box.dimensions == 2)
            sort_plane(solvent, (int)part);
        else
            sort_space(solvent, (int)part);
}

void mf_solvent_sort(struct solvent *solvent, int threads) {
    find_places(solvent);
    mf_parallel_for((size_t)solvent->parts * SOLVENT_STRETCH, threads, sort_parts, solvent);
    for (int d = 0; d < solvent->box.dimensions; d++) {
        double *position = solvent->position[d], *velocity = solvent->velocity[d];
        solvent->position[d] = solvent->spare[d];
        solvent->velocity[d] = solvent->spare[3 + d];
        solvent->spare[d] = position;
        solvent->spare[3 + d] = velocity;
    }
}

static double free_volume(const struct collision_dynamics_parameters *parameters,
                          const struct box *box) {
    const double radius = parameters->obstacle_radius;
    return mf_box_volume(box) - (radius > 0 ? mf_box_shell_volume(box, 0, radius) : 0);
}

double mf_solvent_count(const struct collision_dynamics_parameters *parameters,
                        const struct box *box) {
    const double cell = pow(parameters->cell, box->dimensions);
    return fmax(0, rint(parameters->particles_per_cell * free_volume(parameters, box) / cell));
}

static enum status check_acceleration(const struct solvent *solvent) {
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    if (parameters->walls != COLLISION_PLATES)
        return STATUS_OK;
    if (parameters->acceleration[1] != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.acceleration: %g" STATUS_ACCELERATION
                              " along y would press the solvent against "
                              "the plates",
                              parameters->acceleration[1]);
    if (parameters->wave_acceleration != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.wave_acceleration: a wave is for a periodic box, without "
                              "plates");
    return STATUS_OK;
}

/// The farthest that a particle flies in a step, but for one in a million.
static double longest_flight(const struct solvent *solvent) {
    static const double deviations = 5;
    const double *drift = solvent->parameters.drift;
    return solvent->time * (deviations * sqrt(solvent->temperature / solvent->parameters.mass) +
                            sqrt(drift[0] * drift[0] + drift[1] * drift[1] + drift[2] * drift[2]));
}

/// Walls and obstacle leave room, and nobody crosses what is between them twice.
static enum status check_capacity(const struct solvent *solvent) {
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    const struct box *box = &solvent->box;
    const double radius = parameters->obstacle_radius, flight = longest_flight(solvent);
    const bool plates = parameters->walls == COLLISION_PLATES;
    if (plates && flight > 2 * box->length[1])
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.interval: between two collisions, a time of %g" STATUS_TIME
                              ", a particle "
                              "moves up to %.3g" STATUS_LENGTH
                              " and crosses the channel of width %g" STATUS_LENGTH " twice",
                              solvent->time, flight, box->length[1]);
    for (int d = 0; d < box->dimensions && radius > 0; d++) {
        const double centre = parameters->obstacle_centre[d];
        const double margin = plates && d == 1 ? radius : 0;
        if (!(centre >= margin && centre <= box->length[d] - margin))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "dynamics.obstacle_centre[%d]: with %g" STATUS_LENGTH
                                  " an obstacle of radius %g" STATUS_LENGTH
                                  " is outside the box of %g" STATUS_LENGTH,
                                  d, centre, radius, box->length[d]);
        // Farther away, the nearest image of the obstacle may not be the one that is met.
        if (margin == 0 && !(radius + flight < 0.5 * box->length[d]))
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "dynamics.obstacle_radius: %g" STATUS_LENGTH ", and the %.3g" STATUS_LENGTH
                " that a particle "
                "flies between two collisions, are beyond half the box of %g" STATUS_LENGTH,
                radius, flight, box->length[d]);
    }
    return check_acceleration(solvent);
}

static enum status find_cells(struct solvent *solvent) {
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    double total = 1;
    for (int d = 0; d < solvent->box.dimensions; d++) {
        const double cells = solvent->box.length[d] / parameters->cell;
        if (!(fabs(cells - rint(cells)) <= 1e-9 * cells) || cells < 0.5)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "dynamics.cell: cells of %g" STATUS_LENGTH
                                  " do not divide box[%d] = %g" STATUS_LENGTH,
                                  parameters->cell, d, solvent->box.length[d]);
        total *= rint(cells) + 1;
        if (total > INT32_MAX)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "dynamics.cell: cells of %g" STATUS_LENGTH
                                  " are too many in this box",
                                  parameters->cell);
        solvent->cells[d] = (int)rint(cells) + (d == 1 && parameters->walls == COLLISION_PLATES);
    }
    for (int d = solvent->box.dimensions; d < 3; d++)
        solvent->cells[d] = 1;
    solvent->cell_total = cells_total(solvent->cells);
    return STATUS_OK;
}

static enum status allocate(struct solvent *solvent, size_t beads) {
    enum status status = STATUS_OK;
    for (int d = 0; d < solvent->box.dimensions; d++) {
        NEW_SCATTERED(solvent->position[d], solvent->count);
        NEW_SCATTERED(solvent->velocity[d], solvent->count);
        NEW_SCATTERED(solvent->spare[d], solvent->count);
        NEW_SCATTERED(solvent->spare[3 + d], solvent->count);
    }
    NEW_SCATTERED(solvent->cell, solvent->count);
    NEW_SCATTERED(solvent->start, solvent->cell_total + 1);
    for (int part = 0; part < solvent->parts; part++)
        NEW_SCATTERED(solvent->places[part], solvent->cell_total);
    if (beads == 0)
        goto done;
    NEW_SCATTERED(solvent->first_bead, solvent->cell_total);
    NEW_SCATTERED(solvent->next_bead, beads);
done:
    return status;
}

/// Uniform places, redrawn where the obstacle is.
static void place(struct solvent *solvent) {
    const int dimensions = solvent->box.dimensions;
    for (size_t k = 0; k < solvent->count; k++) {
        double position[3];
        uint32_t trial = 0;
        do {
            const struct rng_block block =
                solvent_noise(solvent, trial / 256, k, SOLVENT_PLACE, trial);
            for (int d = 0; d < dimensions; d++)
                position[d] = solvent->box.length[d] * mf_rng_uniform(block.word[d], block.word[3]);
            trial++;
        } while (!mf_solvent_is_free(solvent, position));
        for (int d = 0; d < dimensions; d++)
            solvent->position[d][k] = position[d];
    }
}

/// Normal numbers, shifted and scaled to the temperature and the drift exactly.
static void draw_velocities(struct solvent *solvent) {
    const int dimensions = solvent->box.dimensions;
    const double count = (double)solvent->count;
    double sum[3] = {0}, squares = 0;
    for (size_t k = 0; k < solvent->count; k++) {
        double normal[4];
        mf_rng_normal4(solvent_noise(solvent, 0, k, SOLVENT_VELOCITY, 0), normal);
        for (int d = 0; d < dimensions; d++) {
            solvent->velocity[d][k] = normal[d];
            sum[d] += normal[d];
            squares += normal[d] * normal[d];
        }
    }
    for (int d = 0; d < dimensions; d++)
        squares -= sum[d] * sum[d] / count;
    const double degrees = dimensions * (count - 1);
    const double scale =
        squares > 0 ? sqrt(solvent->temperature / solvent->parameters.mass * degrees / squares) : 0;
    for (int d = 0; d < dimensions; d++)
        for (size_t k = 0; k < solvent->count; k++)
            solvent->velocity[d][k] =
                scale * (solvent->velocity[d][k] - sum[d] / count) + solvent->parameters.drift[d];
}

enum status mf_solvent_init(struct solvent *solvent, const struct particles *beads, int threads) {
    const double count = mf_solvent_count(&solvent->parameters, &solvent->box);
    TRY(find_cells(solvent));
    TRY(check_capacity(solvent));
    if (!(count >= 2 && count < UINT32_MAX))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "dynamics.particles_per_cell: %g would be %g solvent particles in the "
            "box",
            solvent->parameters.particles_per_cell, count);
    solvent->count = (size_t)count;
    solvent->parts = threads < SOLVENT_MAX_PARTS ? threads : SOLVENT_MAX_PARTS;
    TRY(allocate(solvent, beads->count));
    place(solvent);
    draw_velocities(solvent);
    return STATUS_OK;
}

void mf_solvent_clear(struct solvent *solvent) {
    for (int d = 0; d < 3; d++) {
        mf_memory_free(solvent->position[d]);
        mf_memory_free(solvent->velocity[d]);
        mf_memory_free(solvent->spare[d]);
        mf_memory_free(solvent->spare[3 + d]);
    }
    for (int part = 0; part < SOLVENT_MAX_PARTS; part++)
        mf_memory_free(solvent->places[part]);
    mf_memory_free(solvent->cell);
    mf_memory_free(solvent->start);
    mf_memory_free(solvent->first_bead);
    mf_memory_free(solvent->next_bead);
    *solvent = (struct solvent){0};
}
