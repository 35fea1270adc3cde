// SPDX-License-Identifier: GPL-3.0-or-later
//
// The state in which a g(r) was measured, which `measure` writes beside it.
#include "targets/target_sanity.h"

#include "io/json.h"
#include "io/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// As far as a density or a temperature may be rounded.
static const double rounded = 0.02;

/// Density [nm^-3] and temperature [K]; NAN where a file does not say.
struct state {
    double density, temperature;
};

static double number_at(const struct json_object *object, const char *key) {
    double value;
    return mf_json_numbers(object, key, &value, 1) == 1 ? value : NAN;
}

/// Of the scene of a target.json as `measure` writes them; false of any other file, or of none.
static bool read_measured(const char *file, struct state *measured) {
    struct json_document *document;
    if (mf_json_open(&document, file) != STATUS_OK)
        return false;
    struct json_object root = mf_json_root(document);
    const char *const units = mf_json_choice(&root, "units", NULL, "");
    const bool known = units && strcmp(units, mf_units_systems[UNITS_NM_PS]) == 0 &&
                       mf_json_is_object(&root, "scene");
    if (known) {
        const struct json_object scene = mf_json_child(&root, "scene", true);
        measured->density = number_at(&scene, "density");
        measured->temperature = number_at(&scene, "temperature");
    }
    return mf_json_close(document, STATUS_OK) == STATUS_OK && known;
}

/// Without a scale λ is what r is in, nm.
static struct state state_of(const struct scene *scene) {
    const struct units *units = &scene->units;
    const struct simulation_setup *setup = &scene->setup;
    const double length = mf_units_known(units) ? units->length : 1;
    return (struct state){
        .density = (double)setup->placement.count / mf_box_volume(&setup->box) / pow(length, 3),
        .temperature =
            mf_units_known(units) ? setup->temperature * units->temperature : (double)NAN};
}

static bool differ(double one, double other) {
    return fabs(one - other) > rounded * other;
}

/// What a summary.json of `measure` warns of: "" if of nothing, or if there is none.
enum { WARNING_SIZE = 512 };
static void read_warning(const char *file, char text[WARNING_SIZE]) {
    struct json_document *document;
    text[0] = '\0';
    if (mf_json_open(&document, file) != STATUS_OK)
        return;
    struct json_object root = mf_json_root(document);
    const char *const method = mf_json_choice(&root, "method", NULL, "");
    const char *const warning = mf_json_choice(&root, "warning", NULL, "");
    if (method && warning && strcmp(method, "measure") == 0)
        snprintf(text, WARNING_SIZE, "%s", warning);
    if (mf_json_close(document, STATUS_OK) != STATUS_OK)
        text[0] = '\0';
}

static void report_state(const char *path, const struct scene *scene,
                         const struct target_sanity_listener *listener) {
    char density[64] = "", temperature[64] = "";
    struct state measured;
    if (scene->setup.box.dimensions != 3 || !read_measured(path, &measured))
        return;
    const struct state own = state_of(scene);
    if (differ(own.density, measured.density))
        snprintf(density, sizeof density, "%.4g nm^-3, not %.4g", measured.density, own.density);
    if (differ(own.temperature, measured.temperature))
        snprintf(temperature, sizeof temperature, "%.4g K, not %.4g", measured.temperature,
                 own.temperature);
    if (density[0] || temperature[0])
        mf_target_sanity_warn(listener,
                              "mesofit: warning: scene: %s, beside the table of g(r), says that it "
                              "was measured at %s%s%s: is the scene's in other units?",
                              path, density, density[0] && temperature[0] ? ", and at " : "",
                              temperature);
}

void mf_target_sanity_report_measured(const struct target_files *files, const struct scene *scene,
                                      const struct target_sanity_listener *listener) {
    const struct target_pairs *const pairs = target_files_rdf(files);
    char path[OUTPUT_PATH_SIZE], warning[WARNING_SIZE];
    if (pairs->pairs == 0)
        return;
    const char *const file = pairs->member[0].parameters.file, *const slash = strrchr(file, '/');
    const int folder = slash ? (int)(slash + 1 - file) : 0;
    snprintf(path, sizeof path, "%.*starget.json", folder, file);
    report_state(path, scene, listener);
    snprintf(path, sizeof path, "%.*ssummary.json", folder, file);
    read_warning(path, warning);
    if (warning[0])
        mf_target_sanity_warn(
            listener, "mesofit: warning: target: %s, beside the table of g(r), says that %s", path,
            warning);
}
