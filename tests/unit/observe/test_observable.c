// SPDX-License-Identifier: GPL-3.0-or-later
//
// The records of the list are whole, and an observable that is no part of it is measured by its
// record alone.
#include "observe/measure.h"
#include "observe/rdf_observable.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <string.h>

enum { PARTICLES = 200, SAMPLES = 6, EVERY = 5, EQUILIBRATION = 20, OWN_EVERY = 7 };

static const struct measure_plan plan = {
    .equilibration = EQUILIBRATION, .samples = SAMPLES, .every = EVERY};

static void test_records_have_what_their_callers_take_for_granted(void **state) {
    (void)state;
    for (size_t k = 0; mf_observables[k]; k++) {
        const struct observable *o = mf_observables[k];
        assert_non_null(o->name);
        assert_non_null(o->summary);
        assert_true(o->begin && o->clear && o->sample && o->spans && o->state_size > 0);
        assert_true(o->fields == NULL || o->fields->name == NULL || o->settings_size > 0);
        assert_true(o->always || o->fields); // else a scene could not ask for it
        assert_true((o->write == NULL) == (o->files == NULL));
        assert_true((o->histogram == NULL) == (o->counted == NULL));
        assert_true((o->targets == NULL) == (o->result == NULL && o->result_of_all == NULL));
        assert_non_null(o->stage);
        for (size_t n = 0; n < k; n++)
            assert_string_not_equal(o->name, mf_observables[n]->name);
    }
}

static void test_kinds_are_numbered_through_the_list(void **state) {
    (void)state;
    int kinds = 0;
    for (size_t place = 0; mf_observables[place]; place++)
        for (size_t n = 0; mf_observables[place]->targets && mf_observables[place]->targets[n].name;
             n++, kinds++) {
            const struct observable_kind kind = mf_observable_kind(kinds);
            assert_ptr_equal(kind.observable, mf_observables[place]);
            assert_ptr_equal(kind.target, &mf_observables[place]->targets[n]);
            assert_int_equal(kind.place, place);
            assert_int_equal(kind.number, n);
        }
    assert_in_range(kinds, 1, OBSERVABLE_TARGETS);
    assert_null(mf_observable_kind(kinds).observable);
}

// An observable of this test's own ----------------------------------------------------------------

/// The steps at which it was sampled, and the energies there.
struct seen {
    int64_t next, last;
    int count;
    int64_t step[64];
    double energy[64];
};

static enum status see(void *state, const struct configuration *configuration) {
    struct seen *seen = state;
    seen->step[seen->count] = (int64_t)configuration->simulation->step;
    seen->energy[seen->count++] = configuration->simulation->sums.energy;
    seen->next += OWN_EVERY;
    return STATUS_OK;
}

static int64_t due(const void *state) {
    const struct seen *seen = state;
    return seen->next <= seen->last ? seen->next : INT64_MAX;
}

static const struct observable of_the_plan = {.name = "plan", .sums = true, .sample = see};
static const struct observable of_its_own = {.name = "own", .due = due, .sample = see};

static void measure(struct simulation *simulation, const struct observable_use *uses) {
    double temperature;
    assert_ok(mf_measure_equilibrate(simulation, &plan, &temperature, NULL));
    assert_ok(mf_measure_sample(simulation, &plan, uses, NULL));
}

static void begin(struct fluid *fluid, struct simulation *simulation) {
    fluid_groot_warren(fluid, PARTICLES, 0.02);
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
}

/// One is sampled with the plan, the other every seven steps, also where both are due.
static void test_a_record_is_sampled_when_it_is_due(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct seen planned = {0}, own = {.next = EQUILIBRATION, .last = EQUILIBRATION + 28};
    begin(&fluid, &simulation);
    measure(&simulation, (const struct observable_use[]){{&of_the_plan, &planned, NULL},
                                                         {&of_its_own, &own, NULL},
                                                         {NULL, NULL, NULL}});
    assert_int_equal(planned.count, SAMPLES);
    for (int k = 0; k < SAMPLES; k++) {
        assert_int_equal(planned.step[k], EQUILIBRATION + EVERY * (k + 1));
        assert_true(planned.energy[k] > 0);
        assert_true(k == 0 || planned.energy[k] != planned.energy[k - 1]);
    }
    assert_int_equal(own.count, 5);
    for (int k = 0; k < own.count; k++)
        assert_int_equal(own.step[k], EQUILIBRATION + OWN_EVERY * k);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// The force pass counts for one of two g(r); the other counts by itself, and the same.
static void test_two_histograms_of_a_step_are_the_same(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct rdf_observed first = {0}, second = {0};
    const struct rdf_settings settings = {.bins = 30};
    begin(&fluid, &simulation);
    assert_ok(told_begin(&mf_rdf_observable, &first, &settings, &simulation, &plan));
    assert_ok(told_begin(&mf_rdf_observable, &second, &settings, &simulation, &plan));
    measure(&simulation, (const struct observable_use[]){{&mf_rdf_observable, &first, NULL},
                                                         {&mf_rdf_observable, &second, NULL},
                                                         {NULL, NULL, NULL}});
    assert_int_equal(first.counted.blocks.taken, SAMPLES);
    assert_int_equal(second.counted.blocks.taken, SAMPLES);
    double pairs = 0;
    for (size_t k = 0; k < first.counted.blocks.count * 30; k++) {
        assert_close(first.counted.blocks.sums[k], second.counted.blocks.sums[k], 0);
        pairs += first.counted.blocks.sums[k];
    }
    assert_true(pairs > SAMPLES * PARTICLES);
    mf_rdf_observable.clear(&first);
    mf_rdf_observable.clear(&second);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_records_have_what_their_callers_take_for_granted),
        cmocka_unit_test(test_kinds_are_numbered_through_the_list),
        cmocka_unit_test(test_a_record_is_sampled_when_it_is_due),
        cmocka_unit_test(test_two_histograms_of_a_step_are_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
