// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/density_profile.h"
#include "observe/measure.h"

#include <math.h>

struct settings {
    int axis;
    int64_t bins;
};

struct state {
    struct density_profile profile;
    struct box box; ///< at the begin, by which distances are told
};

static void clear(void *state) {
    struct state *s = state;
    mf_density_profile_clear(&s->profile);
    *s = (struct state){0};
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    const struct settings *const set = settings;
    const struct density_profile_plan own = {.composition = simulation->setup.composition,
                                             .bins = (size_t)set->bins,
                                             .samples = (size_t)plan->samples,
                                             .axis = set->axis};
    struct state *s = state;
    s->box = simulation->particles.box;
    if (set->axis >= s->box.dimensions)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "density_profile.axis: z; expected x or y in two dimensions");
    return mf_density_profile_init(&s->profile, &own);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const struct particles *const particles = &simulation->particles;
    const struct density_profile_plan *const plan = &s->profile.plan;
    const double one = (double)plan->bins / mf_box_volume(&particles->box);
    mf_density_profile_next(&s->profile);
    for (size_t k = 0; k < particles->count; k++) {
        const double share = particles->position[plan->axis][k] / particles->box.length[plan->axis];
        const int type = mf_composition_type(&plan->composition, particles->id[k]);
        density_profile_add(&s->profile, type, share - floor(share), one, 0);
    }
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_density_profile_spans(&((struct state *)state)->profile, spans);
}

static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    return mf_density_profile_write(&s->profile, s->box.length[s->profile.plan.axis],
                                    s->box.dimensions, results);
}

/// Nanoseconds of a particle.
static const double particle_cost = 5;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)setup;
    mf_stages_add(stages, "density profile", true, particle_cost / every,
                  "%lld bins, one step in %.0f",
                  (long long)((const struct settings *)settings)->bins, every);
}

static const struct field fields[] = {
    {"axis", FIELD_CHOICE, offsetof(struct settings, axis), .choices = mf_density_profile_axes,
     .initial = 2, .unit = "", .help = "axis"},
    {"bins", FIELD_INTEGER, offsetof(struct settings, bins), .initial = 100, .minimum = 1,
     .maximum = 100000, .unit = "", .help = "number"},
    FIELD_END,
};
static const char *const files[] = {"density_profile.tsv", NULL};

const struct observable mf_density_profile_observable = {
    .name = "density_profile",
    .summary = "number density along an axis",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "density profile",
    .files = files,
    .figure = "density_profile",
};
