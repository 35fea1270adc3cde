// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Hard discs and spheres, moved from event to event.
///
/// They fly straight until two touch, which reverses their relative velocity along the line of
/// centres. B. J. Alder and T. E. Wainwright, J. Chem. Phys. 31, 459 (1959). What is next is
/// computed, so that there is no time step: of each body its next collision and when it leaves its
/// cell are foreseen, and the events of all wait in a calendar. A forecast is not taken back when
/// the partner turns earlier; it is found void when its time comes, and rebuilt
/// (B. D. Lubachevsky, J. Comput. Phys. 94, 255 (1991)). A body stays where its last turn was, with
/// the time of that; only results are synchronous.
///
/// Events do not depend on when results are asked for.
/// Tested: test_hard_gas (unit), test_hard_gas_all_pairs, test_kinetic_gas (physics, cli).
#pragma once

#include "base/memory.h"
#include "system/cells.h"
#include "system/particles.h"

#include <stdatomic.h>
#include <stdbool.h>

struct hard_gas_body {
    double place[3]; ///< at its time; in its cell between turns, wrapped by crossings [λ]
    double time;     ///< of the epoch                                                 [τ]
    double velocity[3];
    double radius;
};

/// What a body does next.
struct hard_gas_event {
    double time;            ///< the earlier of collision and border, of the epoch [τ]
    double border;          ///< of its cell, or a wall
    int32_t partner;        ///< body
    uint32_t partner_turns; ///< of the partner, when that was foreseen: if it has more, it is void
    uint16_t cell[3];
    uint8_t axis; ///< of the border
};

/// What a look at a neighbour needs beside its body.
struct hard_gas_link {
    int32_t next;     ///< in its cell, −1: none
    uint32_t turns;   ///< own changes of velocity, modulo 2³²
    double collision; ///< with its partner; INFINITY: none is foreseen
};

/// Of the calendar (hard_gas_calendar.h).
struct hard_gas_entry {
    double time;
    int32_t body;
    int32_t next, other; ///< in its bucket; in the heap: its branches. −1: none
};

enum { HARD_GAS_WAITING = 8 };
struct hard_gas_fetch; // hard_gas_fetch.h
struct hard_gas_calendar {
    int64_t buckets; ///< a power of two
    int32_t *first;  ///< entry of each, shape [buckets], −1: none
    int32_t entries;
    struct hard_gas_entry *entry;             ///< shape [entries]
    int32_t unused, heap;                     ///< the first of them, −1: none
    int64_t present;                          ///< number of the bucket that the heap is of
    int32_t waiting[HARD_GAS_WAITING], waits; ///< bodies whose events go in at the next bucket
    struct hard_gas_fetch *fetch;             ///< NULL: nothing is fetched ahead
};

struct hard_gas_label {
    double mass;
    uint32_t id;
    int32_t image[3]; ///< boxes crossed
};

/// Sums since the start.
struct hard_gas_tally {
    uint64_t collisions, crossings, wall_hits;
    uint64_t voids; ///< forecasts that were void
    double virial;  ///< Σ r_ij · Δp over collisions                                 [k_B T_0 τ]
    double impulse[3]; ///< on the two walls of each axis together                      [μ λ/τ]
    double overlap;    ///< deepest at a collision, (s² − r²)/s² with s the sum of radii
};

/// All numbers beside the arrays.
struct hard_gas_now {
    struct hard_gas_tally tally;
    double elapsed;        ///< of the epochs before                [τ]
    double time;           ///< of the last event, of this epoch    [τ]
    uint64_t left;         ///< events until the next epoch
    uint64_t events;       ///< since the start
    double bucket_density; ///< buckets a time                      [1/τ]
};

struct hard_gas {
    int count, dimensions;
    int walls; ///< bit d: axis d has walls at 0 and at the length of the box
    double length[3], cell_width[3];
    double half[3]; ///< of the length, beyond which an image is nearer; INFINITY with walls
    int cells[3];
    struct hard_gas_now now;
    struct hard_gas_body *body, *spare_body;    ///< shape [count], in the order of cells at first
    struct hard_gas_label *label, *spare_label; ///< shape [count]
    struct hard_gas_event *event;               ///< shape [count]
    struct hard_gas_link *link;                 ///< shape [count]
    int32_t *first;                             ///< body of each cell, shape [cells], −1: none
    /// Not saved, but filled again: it then holds events after `calendar_events` of them.
    struct hard_gas_calendar calendar;
    uint64_t calendar_events;
    uint32_t *place; ///< shape [count], for writing
};

/// Begin at the positions and velocities of `particles`, no two of which may overlap.
/// @param[in] radius, mass  shape [count], as the particles are sorted now     [λ], [μ]
/// @param[in] walls         bit d: axis d has reflecting walls
/// Fails: NO_MEMORY; BAD_INPUT with their ids if two particles, or one and a wall, overlap, or if a
/// periodic edge of the box is below two diameters of the largest.
enum status mf_hard_gas_init(struct hard_gas *gas, const struct particles *particles,
                             const double *radius, const double *mass, int walls) MUST_USE;
void mf_hard_gas_clear(struct hard_gas *gas);

/// All events before `time` [τ] since the start.
/// Fails: INTERRUPTED, between two events; goes on from there if it is called again.
enum status mf_hard_gas_run(struct hard_gas *gas, double time, const atomic_bool *cancel) MUST_USE;

/// Positions, velocities and images at `time`, which is not before the last event.
void mf_hard_gas_write(const struct hard_gas *gas, double time, struct particles *particles);

/// What a checkpoint must keep.
enum { HARD_GAS_SPANS = 6 };
size_t mf_hard_gas_spans(struct hard_gas *gas, struct memory_span *spans);
