// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hard_gas.h"

#include "base/interrupt.h"
#include "dynamics/hard_gas_calendar.h"
#include "dynamics/hard_gas_events.h"

#include <math.h>

/// Events of each body in an epoch, after which all are made synchronous, sorted and predicted
/// again: a few per cent of the work for neighbours that are neighbours in memory, too, and for
/// times that stay small, whose rounding would be an error of places.
static const uint64_t events_an_epoch = 32;

/// Events between two looks at who may want to stop.
enum { EVENTS_A_LOOK = 1 << 16 };

/// Bodies in a cell, if they are not larger than that.
static const double bodies_a_cell = 0.5;

/// Cells are numbered by 16 bits along an axis.
enum { MAX_CELLS = 65535 };

// Making it ---------------------------------------------------------------------------------------

/// Cells at least as wide as the largest diameter, so that what touches is next door.
static void shape_cells(struct hard_gas *gas, const struct box *box, double diameter) {
    const double capacity = mf_box_volume(box) / gas->count;
    const double width =
        fmax(diameter, pow(bodies_a_cell * capacity, 1.0 / box->dimensions)) * (1 + 1e-12);
    mf_cells_fit_box(box, width, MAX_CELLS, gas->cells);
    for (int d = 0; d < 3; d++) {
        gas->length[d] = box->length[d];
        gas->cell_width[d] = box->length[d] / gas->cells[d];
        gas->half[d] = gas->walls >> d & 1 ? INFINITY : box->length[d] / 2;
    }
}

static enum status allocate(struct hard_gas *gas) {
    const size_t count = (size_t)gas->count;
    TRY_SCATTERED(gas->body, count);
    TRY_SCATTERED(gas->spare_body, count);
    TRY_SCATTERED(gas->label, count);
    TRY_SCATTERED(gas->spare_label, count);
    TRY_SCATTERED(gas->event, count);
    TRY_SCATTERED(gas->link, count);
    TRY_SCATTERED(gas->first, cells_total(gas->cells) + 1);
    TRY_SCATTERED(gas->place, count);
    return mf_hard_gas_calendar_init(gas);
}

static void take_particles(struct hard_gas *gas, const struct particles *particles,
                           const double *radius, const double *mass) {
    for (size_t k = 0; k < particles->count; k++) {
        gas->body[k].radius = radius[k];
        gas->label[k] = (struct hard_gas_label){.mass = mass[k], .id = particles->id[k]};
        for (int d = 0; d < gas->dimensions; d++) {
            gas->body[k].place[d] = particles->position[d][k];
            gas->body[k].velocity[d] = particles->velocity[d][k];
            gas->label[k].image[d] = particles->image[d][k];
        }
    }
}

// Epochs ------------------------------------------------------------------------------------------

static int cell_along(const struct hard_gas *gas, const struct hard_gas_body *body, int d) {
    return (int)fmin(gas->cells[d] - 1, fmax(0, floor(body->place[d] / gas->cell_width[d])));
}

static size_t cell_of(const struct hard_gas *gas, const struct hard_gas_body *body) {
    size_t cell = 0;
    for (int d = 0; d < gas->dimensions; d++)
        cell = cell * (size_t)gas->cells[d] + (size_t)cell_along(gas, body, d);
    return cell;
}

/// All bodies where they are now, at time 0 of the next epoch.
static void synchronise(struct hard_gas *gas) {
    const double now = gas->now.time;
    for (int k = 0; k < gas->count; k++) {
        struct hard_gas_body *body = &gas->body[k];
        for (int d = 0; d < gas->dimensions; d++)
            body->place[d] += body->velocity[d] * (now - body->time);
        body->time = 0;
    }
    gas->now.elapsed += now;
    gas->now.time = 0;
}

/// Into the order of their cells, by counting; leaves the cells empty.
static void sort(struct hard_gas *gas) {
    const size_t cells = cells_total(gas->cells);
    int32_t *end = gas->first;
    memset(end, 0, (cells + 1) * sizeof *end);
    for (int k = 0; k < gas->count; k++)
        end[cell_of(gas, &gas->body[k]) + 1]++;
    for (size_t cell = 0; cell < cells; cell++)
        end[cell + 1] += end[cell];
    for (int k = 0; k < gas->count; k++) {
        const int32_t place = end[cell_of(gas, &gas->body[k])]++;
        gas->spare_body[place] = gas->body[k];
        gas->spare_label[place] = gas->label[k];
    }
    memcpy(gas->body, gas->spare_body, (size_t)gas->count * sizeof *gas->body);
    memcpy(gas->label, gas->spare_label, (size_t)gas->count * sizeof *gas->label);
    memset(gas->first, 0xff, (cells + 1) * sizeof *gas->first);
    for (int k = 0; k < gas->count; k++)
        for (int d = 0; d < gas->dimensions; d++)
            gas->event[k].cell[d] = (uint16_t)cell_along(gas, &gas->body[k], d);
}

static void begin_epoch(struct hard_gas *gas) {
    const uint64_t events = events_an_epoch * (uint64_t)gas->count;
    const double rate = gas->now.time > 0 ? (double)events / gas->now.time : 0;
    synchronise(gas);
    sort(gas);
    gas->now.left = events;
    mf_hard_gas_events_begin(gas, rate);
}

// The rest ----------------------------------------------------------------------------------------

enum status mf_hard_gas_init(struct hard_gas *gas, const struct particles *particles,
                             const double *radius, const double *mass, int walls) {
    double largest = 0;
    *gas = (struct hard_gas){
        .count = (int)particles->count, .dimensions = particles->box.dimensions, .walls = walls};
    for (size_t k = 0; k < particles->count; k++)
        largest = fmax(largest, radius[k]);
    shape_cells(gas, &particles->box, 2 * largest);
    const enum status status = allocate(gas);
    if (status != STATUS_OK) {
        mf_hard_gas_clear(gas);
        return status;
    }
    take_particles(gas, particles, radius, mass);
    begin_epoch(gas);
    return STATUS_OK;
}

void mf_hard_gas_clear(struct hard_gas *gas) {
    mf_memory_free(gas->body);
    mf_memory_free(gas->spare_body);
    mf_memory_free(gas->label);
    mf_memory_free(gas->spare_label);
    mf_memory_free(gas->event);
    mf_memory_free(gas->link);
    mf_memory_free(gas->first);
    mf_hard_gas_calendar_clear(&gas->calendar);
    mf_memory_free(gas->place);
    *gas = (struct hard_gas){0};
}

enum status mf_hard_gas_run(struct hard_gas *gas, double time, const atomic_bool *cancel) {
    if (gas->calendar_events != gas->now.events)
        mf_hard_gas_calendar_fill(gas);
    for (;;) {
        const uint64_t max = gas->now.left < EVENTS_A_LOOK ? gas->now.left : EVENTS_A_LOOK;
        if (mf_interrupt_wanted(cancel))
            return mf_status_fail(STATUS_INTERRUPTED, "interrupted");
        const bool done = mf_hard_gas_events_run(gas, time - gas->now.elapsed, max);
        gas->calendar_events = gas->now.events;
        if (done)
            return STATUS_OK;
        if (gas->now.left == 0)
            begin_epoch(gas);
    }
}

void mf_hard_gas_write(const struct hard_gas *gas, double time, struct particles *particles) {
    const double now = time - gas->now.elapsed;
    for (int k = 0; k < gas->count; k++)
        gas->place[gas->label[k].id] = (uint32_t)k;
    for (size_t n = 0; n < particles->count; n++) {
        const uint32_t k = gas->place[particles->id[n]];
        const struct hard_gas_body *body = &gas->body[k];
        for (int d = 0; d < gas->dimensions; d++) {
            particles->position[d][n] = body->place[d] + body->velocity[d] * (now - body->time);
            particles->velocity[d][n] = body->velocity[d];
            particles->image[d][n] = gas->label[k].image[d];
        }
    }
}

size_t mf_hard_gas_spans(struct hard_gas *gas, struct memory_span *spans) {
    const size_t count = (size_t)gas->count;
    spans[0] = (struct memory_span){&gas->now, sizeof gas->now};
    spans[1] = (struct memory_span){gas->body, count * sizeof *gas->body};
    spans[2] = (struct memory_span){gas->label, count * sizeof *gas->label};
    spans[3] = (struct memory_span){gas->event, count * sizeof *gas->event};
    spans[4] = (struct memory_span){gas->link, count * sizeof *gas->link};
    spans[5] = (struct memory_span){gas->first, cells_total(gas->cells) * sizeof *gas->first};
    return HARD_GAS_SPANS;
}
