// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/scene_words.h"

#include "curves/table.h"

#include <math.h>
#include <string.h>

struct mesofit_scene mesofit_scene_default(void) {
    return (struct mesofit_scene){.box = {10, 10, 10},
                                  .particles = 3000,
                                  .temperature = 1,
                                  .time_step = 0.02,
                                  .seed = 1,
                                  .threads = 1};
}

/// A law of the caller's own is put in later, in the place of none.
static size_t find_law(const struct mesofit_law *law, const char *object, const char *key,
                       struct json_word *words) {
    *words = (struct json_word){
        .object = object, .key = key, .json = law->text ? law->text : "{\"law\": \"none\"}"};
    return law->text || law->value;
}

size_t mf_scene_words(const struct mesofit_scene *scene, bool of_fit,
                      struct json_word words[SCENE_WORDS]) {
    const char *const top = of_fit ? "scene" : NULL;
    const int dimensions = scene->box[2] == 0 ? 2 : 3;
    // The words lack a friction weight of the caller's own, by which their reader would choose.
    const char *integrator =
        scene->integrator || scene->dissipative.value == NULL ? scene->integrator : mf_aboba.name;
    const struct json_word always[] = {
        {.key = "seed", .value = (double)scene->seed},
        {.object = top, .key = "dimensions", .value = dimensions},
        {.object = top, .key = "box", .count = (size_t)dimensions, .values = scene->box},
        {.object = top, .key = "temperature", .value = scene->temperature},
        {.object = top, .key = "time_step", .value = scene->time_step},
        {.object = of_fit ? "scene.particles" : "particles",
         .key = "count",
         .value = (double)scene->particles}};
    size_t count = sizeof always / sizeof *always;
    memcpy(words, always, sizeof always);
    count += find_law(&scene->conservative, top, "conservative", &words[count]);
    count += find_law(&scene->dissipative, top, "dissipative", &words[count]);
    if (integrator)
        words[count++] = (struct json_word){.object = of_fit ? "scene.dynamics" : "dynamics",
                                            .key = "integrator",
                                            .text = integrator};
    return count;
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

enum status mf_scene_words_add_own(const struct mesofit_scene *from, struct scene *scene) {
    TRY(add_law(&from->conservative, "conservative", mf_table_init_potential, &scene->potential,
                &scene->setup.potential));
    TRY(add_law(&from->dissipative, "dissipative", mf_table_init_omega, &scene->omega,
                &scene->setup.omega));
    if (scene->setup.omega && !scene->setup.integrator->dissipative)
        return mf_status_fail(STATUS_BAD_INPUT, "the integrator \"%s\" has no friction",
                              scene->setup.integrator->name);
    return STATUS_OK;
}
