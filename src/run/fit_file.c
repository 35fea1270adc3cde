// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/fit_file.h"

#include "base/memory.h"

#define MEMBER(name) .offset = offsetof(struct fit_core, name)
const struct field fit_core_fields[] = {
    {"threshold", FIELD_NUMBER, MEMBER(threshold), .initial = 1e-3, .minimum = 0, .maximum = 1,
     .unit = "", .help = "the bins before the first with a target above this are the hard core"},
    {"stiffness", FIELD_NUMBER, MEMBER(stiffness), .initial = 2000, .minimum = 0,
     .maximum = DBL_MAX, .unit = "k_B T_0 / lambda^2",
     .help = "curvature of the potential in the core"},
    FIELD_END,
};

static enum status read_method(struct fit_file *fit, struct json_object *root) {
    enum { MOST = 16 };
    const char *names[MOST] = {NULL};
    for (size_t k = 0; inverse_methods[k] && k + 1 < MOST; k++)
        names[k] = inverse_methods[k]->name;
    struct json_object object = json_child(root, "method", true);
    if (object.item == NULL)
        return STATUS_OK;
    const char *name = json_choice(&object, "name", names, NULL);
    for (size_t k = 0; name && inverse_methods[k]; k++)
        if (strcmp(inverse_methods[k]->name, name) == 0)
            fit->method = inverse_methods[k];
    if (fit->method == NULL)
        return STATUS_OK;
    fit->method_parameters = memory_zeroed(1, fit->method->parameters_size);
    if (fit->method_parameters == NULL)
        return STATUS_NO_MEMORY;
    for (size_t k = 0; fit->method->tables[k]; k++)
        json_fields(&object, fit->method->tables[k], fit->method_parameters);
    json_finish(&object);
    return STATUS_OK;
}

static enum status read_root(struct fit_file *fit, struct json_object *root) {
    json_fields(root, heading_fields, &fit->heading);
    TRY(target_read(&fit->target, root));
    struct json_object scene = json_child(root, "scene", true);
    if (scene.item) {
        TRY(scene_read(&fit->scene, &scene, SCENE_FITS_POTENTIAL));
        json_finish(&scene);
    }
    TRY(read_method(fit, root));
    TRY(scene_read_curve(&fit->start, root, "start", curve_potentials));
    TRY(scene_read_curve(&fit->truth, root, "truth", curve_potentials));
    struct json_object core = json_child(root, "core", false);
    json_fields(&core, fit_core_fields, &fit->core);
    if (core.item)
        json_finish(&core);
    struct json_object verification = json_child(root, "verification", false);
    json_fields(&verification, evaluate_verification_fields, &fit->verification);
    if (verification.item)
        json_finish(&verification);
    json_finish(root);
    return STATUS_OK;
}

/// Begin one simulation, so that a box too small for the forces or particles without room are found
/// now and not by the verification after the fit.
static enum status try_scene(const struct fit_file *fit, const char *file) {
    struct simulation simulation;
    const enum status status = simulation_init(&simulation, &fit->scene.setup, NULL);
    if (status != STATUS_OK)
        return status_prefix(status, "%s: scene", file);
    simulation_clear(&simulation);
    return STATUS_OK;
}

/// What only the parts together can get wrong.
static enum status check(const struct fit_file *fit, const char *file) {
    const struct box *box = &fit->scene.setup.box;
    const double range = rdf_bins_range(&fit->target.bins);
    if (box_shortest(box) < 2 * range)
        return status_fail(STATUS_BAD_INPUT,
                           "%s: scene.box: the shortest edge %g is below twice the range of the "
                           "target, %g",
                           file, box_shortest(box), range);
    if (fit->scene.setup.placement.kind == PLACEMENT_FILE)
        return status_fail(STATUS_BAD_INPUT,
                           "%s: scene.particles.placement: a fit places its particles on a lattice "
                           "or at random",
                           file);
    return try_scene(fit, file);
}

enum status fit_file_read(struct fit_file *fit, const char *file,
                          const struct run_options *options) {
    *fit = (struct fit_file){0};
    struct json_document *document;
    TRY(json_open(&document, file));
    struct json_object root = json_root(document);
    const enum status status = read_root(fit, &root);
    TRY(json_close(document));
    TRY(status);
    TRY(check(fit, file));
    if (options->has_seed)
        fit->heading.seed = options->seed;
    target_convert(&fit->target, (size_t)fit->scene.setup.placement.count);
    fit->problem = (struct inverse_problem){
        .bins = fit->target.bins,
        .target = fit->target.g,
        .target_error = fit->target.error,
        .scene = fit->scene.setup,
        .start = fit->start.family ? &fit->start : NULL,
        .core_threshold = fit->core.threshold,
        .core_stiffness = fit->core.stiffness,
        .seed = fit->heading.seed,
        .threads = options->threads,
    };
    return STATUS_OK;
}

void fit_file_clear(struct fit_file *fit) {
    target_clear(&fit->target);
    scene_clear(&fit->scene);
    curve_clear(&fit->start);
    curve_clear(&fit->truth);
    memory_free(fit->method_parameters);
    *fit = (struct fit_file){0};
}

enum status fit_file_write(const struct fit_file *fit, const char *path) {
    struct json_writer *writer = json_writer_create();
    json_put_fields(writer, heading_fields, &fit->heading);
    json_begin(writer, "target");
    json_put_fields(writer, target_fields, &fit->target.parameters);
    json_end(writer);
    json_begin(writer, "scene");
    scene_write(&fit->scene, writer);
    json_end(writer);
    json_begin(writer, "method");
    json_put_text(writer, "name", fit->method->name);
    for (size_t k = 0; fit->method->tables[k]; k++)
        json_put_fields(writer, fit->method->tables[k], fit->method_parameters);
    json_end(writer);
    scene_write_curve(&fit->start, writer, "start");
    scene_write_curve(&fit->truth, writer, "truth");
    json_begin(writer, "core");
    json_put_fields(writer, fit_core_fields, &fit->core);
    json_end(writer);
    json_begin(writer, "verification");
    json_put_fields(writer, evaluate_verification_fields, &fit->verification);
    json_end(writer);
    const enum status status = json_write(writer, path);
    json_writer_free(writer);
    return status;
}
