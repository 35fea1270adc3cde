// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/scene_text.h"

#include "curves/table.h"

#include <inttypes.h>
#include <math.h>

struct mesofit_scene mesofit_scene_default(void) {
    return (struct mesofit_scene){.box = {10, 10, 10},
                                  .particles = 3000,
                                  .temperature = 1,
                                  .time_step = 0.02,
                                  .seed = 1,
                                  .threads = 1};
}

/// A law of the caller's own is put in later, in the place of none.
static void write_law(const struct mesofit_law *law, const char *key, FILE *stream) {
    if (law->text || law->value)
        fprintf(stream, ", \"%s\": %s", key, law->text ? law->text : "{\"law\": \"none\"}");
}

void mf_scene_text_write(const struct mesofit_scene *scene, FILE *stream) {
    const bool plane = scene->box[2] == 0;
    fprintf(stream, "\"dimensions\": %d, \"box\": [%.17g, %.17g", plane ? 2 : 3, scene->box[0],
            scene->box[1]);
    if (!plane)
        fprintf(stream, ", %.17g", scene->box[2]);
    fprintf(stream,
            "], \"particles\": {\"count\": %" PRId64 "}, \"temperature\": %.17g, "
            "\"time_step\": %.17g",
            scene->particles, scene->temperature, scene->time_step);
    write_law(&scene->conservative, "conservative", stream);
    write_law(&scene->dissipative, "dissipative", stream);
    // The text lacks a friction weight of the caller's own, by which its reader would choose.
    const char *integrator =
        scene->integrator || scene->dissipative.value == NULL ? scene->integrator : mf_aboba.name;
    if (integrator)
        fprintf(stream, ", \"dynamics\": {\"integrator\": \"%s\"}", integrator);
}

static double own_value(const void *parameters, double r) {
    const struct mesofit_law *law = parameters;
    return law->value(law->context, r);
}

static double own_cutoff(const void *parameters) {
    return ((const struct mesofit_law *)parameters)->cutoff;
}

static const struct field own_fields[] = {FIELD_END};

/// A law that is a function of the caller's.
static const struct curve_family own_family = {.name = "own",
                                               .summary = "a function of the caller's",
                                               .fields = own_fields,
                                               .size = sizeof(struct mesofit_law),
                                               .value = own_value,
                                               .cutoff = own_cutoff};

static enum status check_own(const struct mesofit_law *law, const char *name) {
    enum { POINTS = 100 };
    if (!(law->cutoff > 0) || !isfinite(law->cutoff))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the cutoff %g is not positive", name,
                              law->cutoff);
    for (int k = 0; k <= POINTS; k++) {
        const double r = law->cutoff * k / POINTS, value = law->value(law->context, r);
        if (!isfinite(value))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: its value at r = %g is %g; it must be finite from 0 on",
                                  name, r, value);
    }
    return STATUS_OK;
}

static enum status add_law(const struct mesofit_law *from, const char *name,
                           scene_law_table *tabulate, struct scene_law *law,
                           const struct table **table) {
    if (from->text || from->value == NULL)
        return STATUS_OK;
    TRY(check_own(from, name));
    TRY(mf_curve_create(&law->curve[0], &own_family));
    *(struct mesofit_law *)law->curve[0].parameters = *from;
    law->curves = 1;
    TRY(mf_scene_law_tabulate(law, tabulate));
    *table = &law->table;
    return STATUS_OK;
}

enum status mf_scene_text_add_own(const struct mesofit_scene *from, struct scene *scene) {
    TRY(add_law(&from->conservative, "conservative", mf_table_init_potential, &scene->potential,
                &scene->setup.potential));
    TRY(add_law(&from->dissipative, "dissipative", mf_table_init_omega, &scene->omega,
                &scene->setup.omega));
    if (scene->setup.omega && !scene->setup.integrator->dissipative)
        return mf_status_fail(STATUS_BAD_INPUT, "the integrator \"%s\" has no friction",
                              scene->setup.integrator->name);
    return STATUS_OK;
}
