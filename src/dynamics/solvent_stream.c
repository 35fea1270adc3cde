// SPDX-License-Identifier: GPL-3.0-or-later
//
// Streaming: plain loops over blocks of particles, axis by axis, which compilers make vectors of;
// those few that meet a wall in this step fly one by one.
#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "dynamics/solvent.h"

#include <math.h>

enum { BLOCK = 1024 };

struct pass {
    struct solvent *solvent;
    const double *g;
};

/// A particle that met a wall: where it is at the end of the step, and how fast.
struct turned {
    size_t particle;
    double position[3], velocity[3];
};

uint32_t mf_solvent_cell(const struct solvent *solvent, const double position[3]) {
    uint32_t cell = 0;
    for (int d = solvent->box.dimensions - 1; d >= 0; d--) {
        const bool plates = d == 1 && solvent->parameters.walls == COLLISION_PLATES;
        const double length = solvent->box.length[d];
        const double x = position[d] - (plates ? 0 : length * floor(position[d] / length));
        int c = (int)((x + solvent->shift[d]) / solvent->parameters.cell);
        c -= c >= solvent->cells[d] ? solvent->cells[d] : 0;
        c = c < 0 ? 0 : c < solvent->cells[d] ? c : solvent->cells[d] - 1;
        cell = cell * (uint32_t)solvent->cells[d] + (uint32_t)c;
    }
    return cell;
}

/// v_x += Δt A sin(2π y/L): the sine of the turn's nearest quarter by its series, good to 6e-8.
SIMD_CLONES static void push_by_wave(struct solvent *solvent, size_t begin, size_t end) {
    const double kick = solvent->time * solvent->parameters.wave_acceleration;
    const double inverse = 1 / solvent->box.length[1];
    const double *restrict y = solvent->position[1];
    double *restrict v = solvent->velocity[0];
    for (size_t k = begin; k < end; k++) {
        const double turn = y[k] * inverse - 0.5; // −½ to ½: sin(2π y/L) = −sin(2π turn)
        const double folded = 0.25 - fabs(0.25 - fabs(turn)); // 0 to ¼
        const double z = 2 * M_PI * folded, z2 = z * z;
        const double sine =
            z *
            (1 + z2 * (-1.0 / 6 + z2 * (1.0 / 120 +
                                        z2 * (-1.0 / 5040 + z2 * (1.0 / 362880 - z2 / 39916800)))));
        v[k] -= kick * copysign(sine, turn);
    }
}

/// Which particles may meet a plate or the obstacle: all that do, and perhaps some more.
/// @param[out] meets  shape [end − begin]
SIMD_CLONES static void find_meetings(const struct pass *pass, size_t begin, size_t end,
                                      int *restrict meets) {
    const struct solvent *solvent = pass->solvent;
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    const double dt = solvent->time;
    for (size_t k = begin; k < end; k++)
        meets[k - begin] = 0;
    if (parameters->walls == COLLISION_PLATES)
        for (size_t k = begin; k < end; k++) {
            const double y = solvent->position[1][k] + dt * solvent->velocity[1][k];
            meets[k - begin] = (y < 0) | (y >= solvent->box.length[1]);
        }
    if (!(parameters->obstacle_radius > 0))
        return;
    double bend = 0; // of the parabola, away from its chord
    for (int d = 0; d < solvent->box.dimensions; d++)
        bend += pass->g[d] * pass->g[d];
    const double reach = parameters->obstacle_radius * (1 + 1e-9) + 0.125 * dt * dt * sqrt(bend);
    double approach[BLOCK] = {0}, square[BLOCK] = {0}, chord[BLOCK] = {0};
    for (int d = 0; d < solvent->box.dimensions; d++) {
        const bool periodic = !(d == 1 && parameters->walls == COLLISION_PLATES);
        const double length = solvent->box.length[d], inverse = periodic ? 1 / length : 0;
        const double centre = parameters->obstacle_centre[d], half = 0.5 * dt * dt * pass->g[d];
        const double *restrict x = solvent->position[d], *restrict v = solvent->velocity[d];
        for (size_t k = begin; k < end; k++) {
            const double raw = x[k] - centre, s = raw - length * rint(raw * inverse);
            const double way = dt * v[k] + half;
            square[k - begin] += s * s;
            approach[k - begin] += s * way;
            chord[k - begin] += way * way;
        }
    }
    for (size_t k = 0; k < end - begin; k++) {
        const double at = fmin(fmax(-approach[k] / chord[k], 0), 1); // where the chord is nearest
        meets[k] |= square[k] + at * (2 * approach[k] + at * chord[k]) < reach * reach;
    }
}

/// Let those that may meet something fly on their own.
static size_t turn_back(const struct pass *pass, int part, size_t begin, size_t end,
                        const int *meets, struct turned *turned) {
    struct solvent *solvent = pass->solvent;
    size_t count = 0;
    for (size_t k = begin; k < end; k++) {
        if (!meets[k - begin])
            continue;
        struct turned *one = &turned[count++];
        double impulse[3] = {0};
        one->particle = k;
        for (int d = 0; d < solvent->box.dimensions; d++) {
            one->position[d] = solvent->position[d][k];
            one->velocity[d] = solvent->velocity[d][k];
        }
        if (!mf_solvent_propagate(solvent, one->position, one->velocity, pass->g, solvent->time,
                                  impulse))
            solvent->trapped[part] = true;
        for (int d = 0; d < solvent->box.dimensions; d++)
            solvent->impulse[part][d] +=
                llrint(solvent->parameters.mass * impulse[d] / SOLVENT_IMPULSE);
    }
    return count;
}

/// x += v Δt + g Δt²/2 along one axis, v += g Δt, and the cell's number so far.
SIMD_CLONES static void move(const struct pass *pass, int d, size_t begin, size_t end) {
    struct solvent *solvent = pass->solvent;
    const double dt = solvent->time, half = 0.5 * dt * dt * pass->g[d], more = dt * pass->g[d];
    const bool plates = d == 1 && solvent->parameters.walls == COLLISION_PLATES;
    const double length = solvent->box.length[d], inverse = plates ? 0 : 1 / length;
    const double shift = solvent->shift[d], scale = 1 / solvent->parameters.cell;
    const int cells = solvent->cells[d];
    double *restrict x = solvent->position[d], *restrict v = solvent->velocity[d];
    uint32_t *restrict cell = solvent->cell;
    for (size_t k = begin; k < end; k++) {
        const double to = x[k] + (dt * v[k] + half);
        const double inside = to - length * floor(to * inverse);
        int c = (int)((inside + shift) * scale);
        c -= c >= cells ? cells : 0;
        c = c < 0 ? 0 : c < cells ? c : cells - 1; // what is not a number has a cell, too
        x[k] = inside;
        cell[k] = cell[k] * (uint32_t)cells + (uint32_t)c;
    }
    for (size_t k = begin; k < end && more != 0; k++)
        v[k] += more;
}

static void put_back(struct solvent *solvent, const struct turned *turned, size_t count) {
    const bool plates = solvent->parameters.walls == COLLISION_PLATES;
    for (size_t n = 0; n < count; n++) {
        const size_t k = turned[n].particle;
        for (int d = 0; d < solvent->box.dimensions; d++) {
            const double x = turned[n].position[d], length = solvent->box.length[d];
            solvent->position[d][k] = plates && d == 1 ? x : x - length * floor(x / length);
            solvent->velocity[d][k] = turned[n].velocity[d];
        }
        solvent->cell[k] = mf_solvent_cell(solvent, turned[n].position);
    }
}

static void stream_block(const struct pass *pass, int part, size_t begin, size_t end) {
    struct solvent *solvent = pass->solvent;
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    int meets[BLOCK];
    struct turned turned[BLOCK];
    size_t count = 0;
    if (parameters->wave_acceleration != 0)
        push_by_wave(solvent, begin, end);
    if (parameters->walls == COLLISION_PLATES || parameters->obstacle_radius > 0) {
        find_meetings(pass, begin, end, meets);
        count = turn_back(pass, part, begin, end, meets, turned);
    }
    memset(solvent->cell + begin, 0, (end - begin) * sizeof *solvent->cell);
    for (int d = solvent->box.dimensions - 1; d >= 0; d--)
        move(pass, d, begin, end);
    put_back(solvent, turned, count);
}

/// One part of the particles: stream, and count those of each cell.
static void stream_part(const struct pass *pass, int part) {
    struct solvent *solvent = pass->solvent;
    uint32_t *places = solvent->places[part];
    const size_t first = solvent_part(solvent, solvent->count, part);
    const size_t last = solvent_part(solvent, solvent->count, part + 1);
    memset(places, 0, solvent->cell_total * sizeof *places);
    for (size_t begin = first; begin < last; begin += BLOCK) {
        const size_t end = begin + BLOCK < last ? begin + BLOCK : last;
        stream_block(pass, part, begin, end);
        for (size_t k = begin; k < end; k++)
            places[solvent->cell[k]]++;
    }
}

static void stream_parts(void *context, size_t begin, size_t end) {
    for (size_t part = begin / SOLVENT_STRETCH; part < end / SOLVENT_STRETCH; part++)
        stream_part(context, (int)part);
}

static void draw_shift(struct solvent *solvent, uint64_t step) {
    const struct rng_block block = solvent_noise(solvent, step, 0, SOLVENT_SHIFT, 0);
    for (int d = 0; d < 3; d++)
        solvent->shift[d] = solvent->parameters.grid_shift
                                ? solvent->parameters.cell * mf_rng_uniform(block.word[d], 0)
                                : 0;
}

enum status mf_solvent_stream(struct solvent *solvent, uint64_t step, int threads) {
    const struct pass pass = {solvent, solvent->parameters.acceleration};
    draw_shift(solvent, step);
    mf_parallel_for((size_t)solvent->parts * SOLVENT_STRETCH, threads, stream_parts, (void *)&pass);
    for (int part = 0; part < solvent->parts; part++)
        if (solvent->trapped[part])
            return mf_status_fail(STATUS_UNSTABLE,
                                  "unstable at step %llu: a particle of the solvent hits walls "
                                  "endlessly; lower the acceleration or use the thermostat",
                                  (unsigned long long)step);
    return STATUS_OK;
}
