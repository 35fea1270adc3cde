// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_case.h"
#include "input/heading.h"

#include <stdio.h>
#include <string.h>

/// "a/b/thesis.json" is the scene "thesis".
static void name_scene(struct bench_scene *scene, const char *file) {
    static const char ending[] = ".json";
    const char *slash = strrchr(file, '/');
    snprintf(scene->name, sizeof scene->name, "%.*s", BENCH_NAME_SIZE - 1,
             slash ? slash + 1 : file);
    const size_t length = strlen(scene->name), cut = sizeof ending - 1;
    if (length > cut && strcmp(scene->name + length - cut, ending) == 0)
        scene->name[length - cut] = '\0';
}

static enum status read_file(struct bench_scene *scene, const char *file, struct heading *heading,
                             struct input_files *inputs) {
    struct json_document *document;
    TRY(json_open(&document, file));
    struct json_object root = json_root(document);
    json_fields(&root, heading_fields, heading);
    enum status status = json_collect_files(document, inputs);
    if (status == STATUS_OK)
        status = scene_read(&scene->scene, &root, SCENE_FITS_NOTHING);
    json_has(&root, "measure");
    json_has(&root, "rdf");
    json_finish(&root);
    return json_close(document, status);
}

enum status bench_scene_read(struct bench_scene *scene, const char *file, const char *output,
                             const struct run_options *options) {
    struct heading heading;
    struct input_files inputs = {0};
    enum status status = read_file(scene, file, &heading, &inputs);
    if (status == STATUS_OK && output)
        status = input_files_spare(&inputs, output);
    input_files_clear(&inputs);
    TRY(status);
    scene->scene.setup.seed = options->has_seed ? options->seed : heading.seed;
    name_scene(scene, file);
    return STATUS_OK;
}
