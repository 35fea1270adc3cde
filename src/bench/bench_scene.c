// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_case.h"
#include "observe/observable.h"
#include "scene/heading.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

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
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, mf_heading_fields, heading);
    enum status status = mf_json_collect_files(document, inputs);
    if (status == STATUS_OK)
        status = mf_scene_read(&scene->scene, &root, SCENE_FITS_NOTHING, NULL);
    mf_json_has(&root, "measure");
    for (int k = 0; mf_observables[k]; k++)
        mf_json_has(&root, mf_observables[k]->name);
    mf_json_finish(&root);
    return mf_json_close(document, status);
}

/// A file of results is none that the program may know: it replaces no file without a word.
static enum status check_output(const struct input_files *inputs, const char *output, bool force) {
    struct stat about;
    if (output == NULL || lstat(output, &about) != 0)
        return STATUS_OK;
    TRY(mf_input_files_protect(inputs, output));
    if (force)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s is there: --force replaces it, -o OTHER keeps it",
                          output);
}

enum status mf_bench_scene_read(struct bench_scene *scene, const char *file, const char *output,
                                const struct run_options *options) {
    struct heading heading;
    struct input_files inputs = {0};
    enum status status = read_file(scene, file, &heading, &inputs);
    if (status == STATUS_OK)
        status = check_output(&inputs, output, options->force);
    mf_input_files_clear(&inputs);
    TRY(status);
    scene->scene.setup.seed = options->has_seed ? options->seed : heading.seed;
    name_scene(scene, file);
    return STATUS_OK;
}
