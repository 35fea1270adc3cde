// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/attributes.h"

#include "base/rng.h"

const struct field mf_attributes_fields[] = {
    {"mass", FIELD_NUMBER, .initial = NAN, .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX,
     .unit = "mu",
     .help = "mass of each particle: a number, {\"minimum\": …, \"maximum\": …} (uniform), or an "
             "object for each type; default 1"},
    {"radius", FIELD_NUMBER, .initial = NAN, .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX,
     .unit = "lambda", .help = "radius of each particle, likewise, if an interaction needs it"},
    {"stiffness", FIELD_NUMBER, .initial = NAN, .minimum = 0, .maximum = DBL_MAX, .unit = "",
     .help = "stiffness of each particle, likewise, in the unit of its interaction"},
    {"orientation", FIELD_NUMBER, .initial = NAN, .minimum = -1e6, .maximum = 1e6, .unit = "rad",
     .help = "initial theta of each particle, likewise; default: uniform"},
    FIELD_END,
};

struct attributes_range mf_attributes_span(const struct attributes_source *source) {
    struct attributes_range span = source->range[0];
    for (int type = 1; type < source->ranges; type++) {
        span.minimum = fmin(span.minimum, source->range[type].minimum);
        span.maximum = fmax(span.maximum, source->range[type].maximum);
    }
    return span;
}

static double middle_of(const struct attributes_range *range) {
    return 0.5 * (range->minimum + range->maximum);
}

double mf_attributes_sum(const struct attributes_source *source, double usual,
                         const struct composition *composition, int64_t particles) {
    double sum = 0;
    if (source->column) {
        for (int64_t k = 0; k < particles; k++)
            sum += source->column[k];
        return sum;
    }
    if (source->ranges < 2)
        return (double)particles * (source->ranges == 1 ? middle_of(&source->range[0]) : usual);
    for (int type = 0; type < composition->types; type++)
        sum += (double)composition->count[type] * middle_of(&source->range[type]);
    return sum;
}

static double number_of(const struct attributes_source *source, enum attributes_name name,
                        const struct composition *composition, uint32_t id, uint64_t seed) {
    if (source->column)
        return source->column[id];
    const int type = source->ranges > 1 ? mf_composition_type(composition, id) : 0;
    const struct attributes_range *range = &source->range[type];
    const struct rng_block block = mf_rng_philox(seed, RNG_PLACEMENT, id, (uint32_t)name, 1);
    const double share = mf_rng_uniform(block.word[0], block.word[1]);
    return range->minimum + share * (range->maximum - range->minimum);
}

enum status mf_attributes_give(struct particles *particles,
                               const struct attributes_source source[ATTRIBUTES_NAMES],
                               const struct composition *composition, uint64_t seed) {
    for (int name = 0; name < ATTRIBUTES_NAMES; name++) {
        const struct particles_attribute attribute = {
            .name = mf_attributes_fields[name].name, .type = PARTICLES_DOUBLE, .components = 1};
        int number;
        if (source[name].ranges == 0)
            continue;
        TRY(mf_particles_add_attribute(particles, &attribute, &number));
        double *value = particles->attribute[number].value[0];
        for (size_t k = 0; k < particles->count; k++)
            value[k] = number_of(&source[name], (enum attributes_name)name, composition,
                                 particles->id[k], seed);
    }
    return STATUS_OK;
}
