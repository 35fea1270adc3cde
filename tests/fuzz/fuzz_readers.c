// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every reader of a file, for libFuzzer: the first byte of an input says which one, the rest is the
// file. `make fuzz` builds and runs it. What a reader may do is take the file or refuse it.
#include "base/digest.h"
#include "base/memory.h"
#include "io/data_table.h"
#include "io/votca.h"
#include "io/checkpoint.h"
#include "defaults/fit_file.h"
#include "import/import_system.h"
#include "report/result.h"
#include "scene/molecules_file.h"
#include "trajectory/mapping.h"
#include "trajectory/trajectory.h"
#include "trajectory/votca_map.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerInitialize(int *count, char ***words);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char folder[512];

static void write_file(const char *name, const void *bytes, size_t size) {
    FILE *stream = fopen(name, "wb");
    if (stream == NULL || fwrite(bytes, 1, size, stream) != size || fclose(stream) != 0)
        abort();
}

static void write_text(const char *name, const char *text) {
    write_file(name, text, strlen(text));
}

static void remove_folder(void) {
    char command[sizeof folder + 16];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    if (chdir("/") != 0 || system(command) != 0)
        perror(folder);
}

/// Work in a folder with the tables that scenes and run files name, and the files of a fit.
int LLVMFuzzerInitialize(int *count, char ***words) {
    (void)count, (void)words;
    const char *parent = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/mesofit-fuzz-XXXXXX", parent ? parent : "/tmp");
    if (mkdtemp(folder) == NULL || chdir(folder) != 0)
        abort();
    atexit(remove_folder);
    write_text("target.tsv", "0.1 0.3 0.1\n0.3 0.6 0.1\n0.5 0.8 0.1\n0.7 1.1 0.1\n0.9 1.0 0.1\n");
    write_text("start.tsv", "0 12\n0.3 6\n0.6 2\n1 0\n");
    write_text("potential.tsv", "0 20\n0.25 12\n0.5 6\n0.75 1.5\n1 0\n");
    write_text("beads.tsv", "0.1 0.2 0.3\n1.1 1.2 1.3\n");
    write_text("summary.json", "{\"status\": \"ok\", \"rdf_rmse\": 0.1}\n");
    write_text("history.tsv",
               "# iteration\tevaluations\tengine_steps\terror\tnoise\n0\t1\t2\t3\t4\n");
    write_text("timing.tsv", "# iteration\tseconds\n0\t1\n");
    return 0;
}

static void read_table(const char *file) {
    struct data_table table;
    if (mf_data_table_read(&table, file, 2) != STATUS_OK)
        return;
    if (mf_data_table_check_increasing(&table, file, 0, 0) == STATUS_OK && table.rows == 0)
        abort();
    mf_data_table_clear(&table);
}

static void read_votca(const char *file) {
    struct votca_table table;
    if (mf_votca_read(&table, file) == STATUS_OK)
        mf_votca_clear(&table);
}

static void read_scene(const char *file) {
    struct json_document *document;
    struct scene scene;
    if (mf_json_open(&document, file) != STATUS_OK)
        return;
    struct json_object root = mf_json_root(document);
    const enum status status = mf_scene_read(&scene, &root, SCENE_FITS_NOTHING, NULL);
    mf_json_finish(&root);
    if (mf_json_close(document, status) == STATUS_OK && scene.setup.integrator == NULL)
        abort();
    mf_scene_clear(&scene);
}

static void read_run(const char *file) {
    const struct run_options options = {.threads = 1};
    struct fit_file fit;
    if (mf_fit_file_parse(&fit, file, &options) == STATUS_OK && fit.method == NULL)
        abort();
    mf_fit_file_clear(&fit);
}

/// All frames, and their beads by residues if there are any.
static void read_trajectory(const char *file, const char *units) {
    struct trajectory trajectory;
    struct trajectory_frame frame = {0}, beads = {0};
    struct mapping_plan plan;
    struct mapping mapping;
    bool more = true;
    if (mf_trajectory_open(&trajectory, file, &(struct trajectory_options){.units = units}) !=
        STATUS_OK)
        return;
    if (mf_mapping_plan_default(&plan) != STATUS_OK)
        abort();
    const bool mapped = mf_mapping_init(&mapping, &plan, &trajectory.structure) == STATUS_OK;
    while (more && mf_trajectory_next(&trajectory, &frame, &more) == STATUS_OK && more)
        if (frame.atoms != trajectory.structure.atoms ||
            (mapped && mf_mapping_apply(&mapping, &frame, &beads) != STATUS_OK))
            abort();
    if (mapped)
        mf_mapping_clear(&mapping);
    mf_mapping_plan_clear(&plan);
    mf_frame_clear(&frame);
    mf_frame_clear(&beads);
    mf_trajectory_close(&trajectory);
}

/// The molecules of a file that lists atoms, and what each of these is: of itself they fit.
static void read_molecules(const char *file) {
    struct scene_molecules molecules;
    struct composition types;
    struct molecules_listing listing = {.repeats = 0};
    struct trajectory trajectory;
    const struct trajectory_options options = {.units = "lj"};
    if (mf_molecules_file_read(&molecules, &types, file) != STATUS_OK)
        return;
    if (mf_trajectory_open(&trajectory, file, &options) == STATUS_OK) {
        if (mf_molecules_listing_read(&listing, &molecules.molecules.topology, file, "lj",
                                      &trajectory.structure, false) == STATUS_OK &&
            listing.repeats != 1)
            abort();
        mf_molecules_listing_clear(&listing);
        mf_trajectory_close(&trajectory);
    }
    mf_scene_molecules_clear(&molecules);
}

static void read_map(const char *file) {
    struct mapping_plan plan;
    if (mf_mapping_plan_read(&plan, file) != STATUS_OK)
        return;
    if (plan.entries == 0 && plan.molecules == 0)
        abort();
    mf_mapping_plan_clear(&plan);
}

/// VOTCA's maps are known by the name.
static void read_votca_map(const char *file) {
    char *bonds = NULL;
    read_map(file);
    if (mf_votca_map_bonds(&bonds, file) == STATUS_OK)
        mf_memory_free(bonds);
}

static void read_settings(const char *file) {
    static struct import_settings settings;
    struct import_system system;
    if (mf_import_settings_read(&settings, file) == STATUS_OK &&
        mf_import_system_find(&system, &settings, &(struct import_options){.box = {3, 3, 3}}) ==
            STATUS_OK) {
        if (system.beads.types == 0)
            abort();
        mf_import_system_clear(&system);
    }
    mf_import_settings_clear(&settings);
}

/// The file as it is, and with the checksum that its bytes should have: the second gets further.
static void read_checkpoint(const char *file, const uint8_t *data, size_t size) {
    unsigned char state[3][64] = {{0}};
    const struct memory_span spans[] = {{state[0], 8}, {state[1], 0}, {state[2], 64}};
    uint64_t digest = 0, checksum = DIGEST_OF_NOTHING;
    if (size >= 24)
        memcpy(&digest, data + 16, sizeof digest);
    for (int time = 0; time < 2; time++) {
        if (mf_checkpoint_load(file, digest, spans, 3) != STATUS_OK &&
            mf_checkpoint_load_span(file, digest, 1, &spans[1]) != STATUS_OK && time == 0)
            mf_digest_add(&checksum, data, size);
        FILE *stream = fopen(file, "ab");
        if (stream == NULL || fwrite(&checksum, sizeof checksum, 1, stream) != 1 ||
            fclose(stream) != 0)
            abort();
    }
    remove(file);
}

/// One of the files of a fit's folder, the others being whole.
static void read_result(const char *name, const uint8_t *data, size_t size) {
    struct result result;
    char kept[4096];
    FILE *stream = fopen(name, "rb");
    const size_t bytes = stream ? fread(kept, 1, sizeof kept, stream) : 0;
    if (stream)
        fclose(stream);
    write_file(name, data, size);
    if (mf_result_read(&result, ".") == STATUS_OK)
        mf_result_clear(&result);
    if (bytes > 0)
        write_file(name, kept, bytes);
    else
        remove(name);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const results[] = {"summary.json", "history.tsv",   "timing.tsv",
                                          "rdf.tsv",      "potential.tsv", "omega.tsv"};
    if (size == 0)
        return 0;
    const uint8_t kind = data[0];
    const char *const file = kind == 'w' || kind == 'i' ? "input.xml"
                             : kind == 'g'              ? "input.top"
                             : kind == 'd'              ? "input.data"
                                                        : "input";
    write_file(file, ++data, --size);
    if (kind == 't')
        read_table(file);
    else if (kind == 'v')
        read_votca(file);
    else if (kind == 's')
        read_scene(file);
    else if (kind == 'r')
        read_run(file);
    else if (kind == 'x')
        read_trajectory(file, NULL);
    else if (kind == 'l')
        read_trajectory(file, "lj");
    else if (kind == 'g' || kind == 'd')
        read_molecules(file);
    else if (kind == 'm')
        read_map(file);
    else if (kind == 'w')
        read_votca_map(file);
    else if (kind == 'i')
        read_settings(file);
    else if (kind == 'c')
        read_checkpoint(file, data, size);
    else if (kind >= '0' && kind <= '5')
        read_result(results[kind - '0'], data, size);
    return 0;
}
