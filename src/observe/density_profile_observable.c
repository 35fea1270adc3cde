// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/density_profile.h"

#include "base/memory.h"
#include "observe/measure.h"

#include <math.h>

struct state {
    struct density_profile profile;
    int dimensions;
    double *share; ///< shape [count]: where the beads are along the axis
    double length; ///< of the box along it, summed over the samples
};

static void clear(void *state) {
    struct state *s = state;
    mf_density_profile_clear(&s->profile);
    mf_memory_free(s->share);
    *s = (struct state){0};
}

/// Masses of a simulation are not in u.
static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct density_profile_settings *const set = settings;
    const struct density_profile_plan own = {.composition = *configuration->composition,
                                             .bins = (size_t)set->bins,
                                             .samples = (size_t)plan->samples,
                                             .axis = set->axis,
                                             .masses = configuration->mass != NULL};
    struct state *s = state;
    s->dimensions = configuration->dimensions;
    if (set->axis >= s->dimensions)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "density_profile.axis: z; expected x or y in two dimensions");
    TRY_ARRAY(s->share, configuration->count);
    return mf_density_profile_init(&s->profile, &own);
}

/// Slabs are parallel to the other vectors of the box, and counted along its height.
static enum status sample(void *state, const struct configuration *configuration) {
    struct state *s = state;
    const double *const mass = configuration->mass;
    const struct density_profile_plan *const plan = &s->profile.plan;
    const double one = (double)plan->bins / configuration->box.volume;
    mf_configuration_shares(configuration, plan->axis, s->share);
    mf_density_profile_next(&s->profile);
    for (size_t k = 0; k < configuration->count; k++)
        density_profile_add(&s->profile, mf_composition_type(&plan->composition, (uint32_t)k),
                            s->share[k] - floor(s->share[k]), one, mass ? mass[k] : 0);
    s->length += configuration->box.height[plan->axis];
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    spans[0] = (struct memory_span){&s->length, sizeof s->length};
    return 1 + mf_density_profile_spans(&s->profile, spans + 1);
}

static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    const double samples = (double)s->profile.blocks.taken;
    return mf_density_profile_write(&s->profile, s->length / samples, s->dimensions, results);
}

/// Nanoseconds of a particle.
static const double particle_cost = 5;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)setup;
    mf_stages_add(stages, "density profile", true, particle_cost / every,
                  "%lld bins, one step in %.0f",
                  (long long)((const struct density_profile_settings *)settings)->bins, every);
}

static const struct field fields[] = {
    {"axis", FIELD_CHOICE, offsetof(struct density_profile_settings, axis),
     .choices = mf_density_profile_axes, .initial = 2, .unit = "", .help = "axis"},
    {"bins", FIELD_INTEGER, offsetof(struct density_profile_settings, bins), .initial = 100,
     .minimum = 1, .maximum = 100000, .unit = "", .help = "number"},
    FIELD_END,
};
static const char *const files[] = {"density_profile.tsv", NULL};

const struct observable mf_density_profile_observable = {
    .name = "density_profile",
    .of_places = true,
    .summary = "number density along an axis",
    .fields = fields,
    .settings_size = sizeof(struct density_profile_settings),
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
