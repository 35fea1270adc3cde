// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hard_gas_events.h"

#include "dynamics/hard_gas_calendar.h"

/// fmin and fmax are calls of the library, since they know NaN.
static inline double earlier(double a, double b) {
    return a < b ? a : b;
}

static inline double later(double a, double b) {
    return a > b ? a : b;
}

/// A body as it is now, and what it will meet first.
struct prediction {
    int32_t body;
    double now;
    double place[3], velocity[3], radius;
    double time; ///< earliest collision of the epoch, INFINITY: none
    int32_t partner;
};

/// Rows of cells around a body along an axis, and where it stands as seen from there: beyond the
/// border of the box it is shifted.
struct reach {
    int count, cell[3];
    double place[3];
};

static inline struct reach find_reach(const struct hard_gas *gas, int d, int cell, int low,
                                      int high, double place) {
    struct reach reach = {0};
    for (int step = low; step <= high; step++) {
        const int n = gas->cells[d];
        int other = cell + step;
        double shift = 0;
        if (other < 0 || other >= n) {
            if (gas->walls >> d & 1)
                continue;
            shift = other < 0 ? gas->length[d] : -gas->length[d];
            other += other < 0 ? n : -n;
        }
        reach.cell[reach.count] = other;
        reach.place[reach.count++] = place + shift;
    }
    return reach;
}

/// Bodies to look at: the first ones of all cells near by, then the second ones, and so on. Their
/// number is not known before, and a loop for each cell would be mispredicted each time.
struct crowd {
    int count;
    int32_t body[28];    ///< the last for one that is not counted
    uint8_t from[28][3]; ///< number of the row along each axis
};

/// What is needed of those whose paths touch.
struct meeting {
    int32_t body;
    double b, gap, root;
};

/// An approach slower than this share of the relative velocity is none, if two bodies touch:
/// rounding of the last collision.
static const double grazing = 1e-14;

/// Of r² + 2 b t + v² t² = s²; written after the meetings that there are, and counted if the two
/// approach each other and touch.
static inline int add_meeting(const struct hard_gas *gas, const struct prediction *prediction,
                              const struct reach reach[3], const uint8_t from[3], int32_t k,
                              struct meeting *meeting, const int dimensions) {
    const struct hard_gas_body *body = &gas->body[k];
    const double ago = prediction->now - body->time, s = prediction->radius + body->radius;
    double b = 0, rr = 0, vv = 0;
    for (int d = 0; d < dimensions; d++) {
        const double v = body->velocity[d] - prediction->velocity[d];
        const double r = body->place[d] + body->velocity[d] * ago - reach[d].place[from[d]];
        b += r * v;
        rr += r * r;
        vv += v * v;
    }
    const double gap = rr - s * s, root = b * b - vv * gap;
    *meeting = (struct meeting){k, b, gap, root};
    return (b < 0) & (root >= 0) & ((gap > 0) | (b * b > grazing * grazing * vv * rr));
}

/// Take the meeting if it is the first, t = gap/(sqrt(root) − b), which cancels nothing. A body
/// that turns before will look by itself.
static inline void take_earlier(const struct hard_gas *gas, struct prediction *prediction,
                                const struct meeting *meeting) {
    const double wait = meeting->gap > 0 ? meeting->gap / (sqrt(meeting->root) - meeting->b) : 0;
    const double time = prediction->now + wait;
    if (time < prediction->time && time < gas->link[meeting->body].collision) {
        prediction->time = time;
        prediction->partner = meeting->body;
    }
}

static inline void look_at(const struct hard_gas *gas, struct prediction *prediction,
                           const struct reach reach[3], struct crowd *crowd, const int dimensions) {
    while (crowd->count > 0) {
        struct meeting meeting[28];
        int meetings = 0, left = 0;
        for (int n = 0; n < crowd->count; n++) {
            const int32_t k = crowd->body[n];
            meetings += add_meeting(gas, prediction, reach, crowd->from[n], k, &meeting[meetings],
                                    dimensions);
            crowd->body[left] = gas->link[k].next;
            for (int d = 0; d < dimensions; d++)
                crowd->from[left][d] = crowd->from[n][d];
            left += crowd->body[left] >= 0;
        }
        for (int n = 0; n < meetings; n++)
            take_earlier(gas, prediction, &meeting[n]);
        crowd->count = left;
    }
}

static inline void add_cell(const struct hard_gas *gas, struct crowd *crowd, size_t cell, int x,
                            int y, int z) {
    crowd->body[crowd->count] = gas->first[cell];
    crowd->from[crowd->count][0] = (uint8_t)x;
    crowd->from[crowd->count][1] = (uint8_t)y;
    crowd->from[crowd->count][2] = (uint8_t)z;
    crowd->count += gas->first[cell] >= 0;
}

/// Look around: into all cells near by, or into the new ones at `side` of an axis.
static inline void look_around(const struct hard_gas *gas, struct prediction *prediction, int axis,
                               int side, const int dimensions) {
    const uint16_t *cell = gas->event[prediction->body].cell;
    struct reach reach[3] = {{.count = 1}, {.count = 1}, {.count = 1}};
    struct crowd crowd;
    crowd.count = 0;
    for (int d = 0; d < dimensions; d++)
        reach[d] = find_reach(gas, d, cell[d], d == axis ? side : -1, d == axis ? side : 1,
                              prediction->place[d]);
    for (int x = 0; x < reach[0].count; x++)
        for (int y = 0; y < reach[1].count; y++) {
            const size_t row =
                (size_t)reach[0].cell[x] * (size_t)gas->cells[1] + (size_t)reach[1].cell[y];
            if (dimensions == 2)
                add_cell(gas, &crowd, row, x, y, 0);
            for (int z = 0; dimensions == 3 && z < reach[2].count; z++)
                add_cell(gas, &crowd, row * (size_t)gas->cells[2] + (size_t)reach[2].cell[z], x, y,
                         z);
        }
    hard_gas_fetch_some(gas->calendar.fetch);
    look_at(gas, prediction, reach, &crowd, dimensions);
}

static inline struct prediction begin_prediction(const struct hard_gas *gas, int32_t k,
                                                 const int dimensions) {
    const struct hard_gas_body *body = &gas->body[k];
    struct prediction prediction = {
        .body = k, .now = gas->now.time, .radius = body->radius, .time = INFINITY, .partner = -1};
    for (int d = 0; d < dimensions; d++) {
        prediction.velocity[d] = body->velocity[d];
        prediction.place[d] = body->place[d] + body->velocity[d] * (prediction.now - body->time);
    }
    return prediction;
}

static inline void keep(struct hard_gas *gas, const struct prediction *prediction) {
    struct hard_gas_event *event = &gas->event[prediction->body];
    gas->link[prediction->body].collision = prediction->time;
    event->partner = prediction->partner;
    if (prediction->partner >= 0)
        event->partner_turns = gas->link[prediction->partner].turns;
}

static inline bool is_wall(const struct hard_gas *gas, int d, int cell, bool up) {
    return (gas->walls >> d & 1) && cell == (up ? gas->cells[d] - 1 : 0);
}

/// When a body leaves its cell, or its rim touches a wall.
static inline void predict_border(struct hard_gas *gas, int32_t k, const int dimensions) {
    const struct hard_gas_body *body = &gas->body[k];
    struct hard_gas_event *event = &gas->event[k];
    double earliest = INFINITY;
    for (int d = 0; d < dimensions; d++) {
        const double v = body->velocity[d];
        const bool up = v > 0;
        double edge = (event->cell[d] + (up ? 1 : 0)) * gas->cell_width[d];
        if (gas->walls && is_wall(gas, d, event->cell[d], up))
            edge = up ? gas->length[d] - body->radius : body->radius;
        const double time = v != 0 ? (edge - body->place[d]) / v : INFINITY;
        if (time < earliest) {
            earliest = time;
            event->axis = (uint8_t)d;
        }
    }
    event->border = later(gas->now.time, body->time + earliest);
}

/// Foresee all of a body that has turned, or whose partner has; it is not in the calendar.
static inline void predict(struct hard_gas *gas, int32_t k, const int dimensions) {
    struct hard_gas_event *event = &gas->event[k];
    hard_gas_fetch_some(gas->calendar.fetch);
    struct prediction prediction = begin_prediction(gas, k, dimensions);
    look_around(gas, &prediction, -1, 0, dimensions);
    keep(gas, &prediction);
    event->time = earlier(gas->link[k].collision, event->border);
}

static inline void advance(struct hard_gas *gas, int32_t k, const int dimensions) {
    struct hard_gas_body *body = &gas->body[k];
    const double ago = gas->now.time - body->time;
    for (int d = 0; d < dimensions; d++)
        body->place[d] += body->velocity[d] * ago;
    body->time = gas->now.time;
}

/// The relative velocity along the line of centres is reversed: v_i += 2 μ/m_i (b/r²) r, with the
/// reduced mass μ; with r² in the place of s² energy is kept to rounding.
static inline void turn(struct hard_gas *gas, int32_t i, int32_t j, const int dimensions) {
    struct hard_gas_body *a = &gas->body[i], *b = &gas->body[j];
    const double mass_a = gas->label[i].mass, mass_b = gas->label[j].mass,
                 s = a->radius + b->radius;
    double r[3], along = 0, rr = 0;
    for (int d = 0; d < dimensions; d++) {
        const double straight = b->place[d] - a->place[d];
        r[d] = straight - (straight > gas->half[d] ? gas->length[d] : 0) +
               (straight < -gas->half[d] ? gas->length[d] : 0);
        along += r[d] * (b->velocity[d] - a->velocity[d]);
        rr += r[d] * r[d];
    }
    const double share = 2 * along / (rr * (mass_a + mass_b));
    for (int d = 0; d < dimensions; d++) {
        a->velocity[d] += share * mass_b * r[d];
        b->velocity[d] -= share * mass_a * r[d];
    }
    struct hard_gas_tally *tally = &gas->now.tally;
    tally->collisions++;
    tally->virial -= share * mass_a * mass_b * rr;
    tally->overlap = later(tally->overlap, 1 - rr / (s * s));
}

static inline void collide(struct hard_gas *gas, int32_t i, const int dimensions) {
    const int32_t pair[2] = {i, gas->event[i].partner};
    for (int n = 0; n < 2; n++) {
        advance(gas, pair[n], dimensions);
        gas->link[pair[n]].turns++;
        gas->link[pair[n]].collision = INFINITY;
    }
    turn(gas, pair[0], pair[1], dimensions);
    for (int n = 0; n < 2; n++) {
        predict_border(gas, pair[n], dimensions);
        predict(gas, pair[n], dimensions);
        hard_gas_calendar_insert(gas, pair[n]);
    }
}

static void bounce(struct hard_gas *gas, int32_t k, const int dimensions) {
    struct hard_gas_event *event = &gas->event[k];
    double *v = &gas->body[k].velocity[event->axis];
    advance(gas, k, dimensions);
    gas->now.tally.impulse[event->axis] += 2 * gas->label[k].mass * fabs(*v);
    gas->now.tally.wall_hits++;
    *v = -*v;
    gas->link[k].turns++;
    predict_border(gas, k, dimensions);
    predict(gas, k, dimensions);
}

static inline size_t index_of(const struct hard_gas *gas, const uint16_t cell[3]) {
    return ((size_t)cell[0] * (size_t)gas->cells[1] + cell[1]) * (size_t)gas->cells[2] + cell[2];
}

/// Into its cell, as the first of its chain, and out of it.
static inline void enter(struct hard_gas *gas, int32_t k) {
    int32_t *first = &gas->first[index_of(gas, gas->event[k].cell)];
    gas->link[k].next = *first;
    *first = k;
}

static inline void leave(struct hard_gas *gas, int32_t k) {
    int32_t *place = &gas->first[index_of(gas, gas->event[k].cell)];
    while (*place != k)
        place = &gas->link[*place].next;
    *place = gas->link[k].next;
}

/// Into the next cell, and look at those that have come near.
static inline void cross(struct hard_gas *gas, int32_t k, const int dimensions) {
    struct hard_gas_event *event = &gas->event[k];
    const int d = event->axis, side = gas->body[k].velocity[d] > 0 ? 1 : -1;
    int cell = event->cell[d] + side;
    leave(gas, k);
    if (cell < 0 || cell >= gas->cells[d]) {
        cell -= side * gas->cells[d];
        gas->body[k].place[d] -= side * gas->length[d];
        gas->label[k].image[d] += side;
    }
    event->cell[d] = (uint16_t)cell;
    enter(gas, k);
    gas->now.tally.crossings++;
    hard_gas_fetch_some(gas->calendar.fetch);
    struct prediction prediction = begin_prediction(gas, k, dimensions);
    prediction.time = gas->link[k].collision;
    look_around(gas, &prediction, d, side, dimensions);
    if (prediction.partner >= 0)
        keep(gas, &prediction);
    predict_border(gas, k, dimensions);
    event->time = earlier(gas->link[k].collision, event->border);
}

static inline bool happen(struct hard_gas *gas, double time, uint64_t max, const int dimensions) {
    for (uint64_t n = 0; n < max; n++) {
        const int32_t k = hard_gas_calendar_take(gas, time);
        if (k < 0)
            return true;
        const struct hard_gas_event *event = &gas->event[k];
        gas->now.time = event->time;
        gas->now.events++;
        gas->now.left--;
        if (event->time < event->border &&
            gas->link[event->partner].turns == event->partner_turns) {
            collide(gas, k, dimensions);
            continue;
        }
        if (event->time < event->border) {
            gas->now.tally.voids++;
            predict(gas, k, dimensions);
        } else if (gas->walls && is_wall(gas, event->axis, event->cell[event->axis],
                                         gas->body[k].velocity[event->axis] > 0)) {
            bounce(gas, k, dimensions);
        } else {
            cross(gas, k, dimensions);
        }
        hard_gas_calendar_insert(gas, k);
    }
    return false;
}

bool mf_hard_gas_events_run(struct hard_gas *gas, double time, uint64_t max) {
    return gas->dimensions == 2 ? happen(gas, time, max, 2) : happen(gas, time, max, 3);
}

static inline double predict_all(struct hard_gas *gas, const int dimensions) {
    double waits = 0;
    for (int32_t k = 0; k < gas->count; k++) {
        predict_border(gas, k, dimensions);
        predict(gas, k, dimensions);
        waits += isfinite(gas->event[k].time) ? gas->event[k].time : 0;
    }
    return waits;
}

void mf_hard_gas_events_begin(struct hard_gas *gas, double rate) {
    for (int32_t k = 0; k < gas->count; k++) {
        gas->link[k].collision = INFINITY;
        enter(gas, k);
    }
    const double waits = gas->dimensions == 2 ? predict_all(gas, 2) : predict_all(gas, 3);
    if (!(rate > 0))
        rate = waits > 0 ? (double)gas->count * (double)gas->count / waits : 1;
    gas->now.bucket_density = rate;
    mf_hard_gas_calendar_fill(gas);
}
