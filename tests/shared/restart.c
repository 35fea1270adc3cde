// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/restart.h"

#include "shared/testing.h"

void restart_simulation(struct simulation *simulation) {
    struct memory_span from[SIMULATION_SPANS], to[SIMULATION_SPANS];
    struct simulation again;
    assert_ok(mf_simulation_init(&again, &simulation->setup, NULL));
    const size_t spans = mf_simulation_spans(simulation, from);
    if (simulation_wants_capacity(&again)) {
        mf_simulation_spans(&again, to);
        memcpy(to[0].memory, from[0].memory, from[0].bytes);
        assert_ok(mf_simulation_reserve(&again));
    }
    assert_int_equal(mf_simulation_spans(&again, to), spans);
    for (size_t n = 0; n < spans; n++) {
        assert_int_equal(from[n].bytes, to[n].bytes);
        memcpy(to[n].memory, from[n].memory, from[n].bytes);
    }
    const uint64_t list_builds = simulation->list_builds;
    mf_simulation_clear(simulation);
    *simulation = again;
    assert_ok(mf_simulation_restore(simulation));
    assert_int_equal(simulation->list_builds, list_builds);
}

void restart_assert_same(const struct simulation *a, const struct simulation *b) {
    const struct particles *p = &a->particles, *q = &b->particles;
    const size_t size = p->count * sizeof(double);
    assert_int_equal(a->step, b->step);
    assert_int_equal(a->list_builds, b->list_builds);
    assert_memory_equal(p->id, q->id, p->count * sizeof *p->id);
    for (int d = 0; d < p->box.dimensions; d++) {
        assert_memory_equal(p->position[d], q->position[d], size);
        assert_memory_equal(p->velocity[d], q->velocity[d], size);
        assert_memory_equal(p->force[d], q->force[d], size);
        assert_memory_equal(p->image[d], q->image[d], p->count * sizeof *p->image[d]);
    }
}
