// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/beads_file.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool mf_beads_file_has_masses(const struct beads_file *file) {
    for (size_t k = 0; k < file->mapping->beads; k++)
        if (!isfinite(file->mapping->bead[k].mass))
            return false;
    return true;
}

static bool has_extension(const struct trajectory_format *format, const char *extension) {
    for (int k = 0; format->extensions[k]; k++)
        if (strcasecmp(extension, format->extensions[k]) == 0)
            return true;
    return false;
}

static enum status find_format(struct beads_file *file, const char *path) {
    const char *const point = strrchr(path, '.');
    for (int k = 0; point && mf_trajectory_formats[k]; k++)
        if (mf_trajectory_formats[k]->print && has_extension(mf_trajectory_formats[k], point + 1))
            file->format = mf_trajectory_formats[k];
    if (file->format)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "--beads %.200s: expected a name that ends with .gro, .xyz, .extxyz, "
                          ".xtc, .gsd, .lammpstrj or .dump",
                          path);
}

/// A bead's place in the list of beads, and by what it is sorted.
struct place {
    size_t molecule, atom, bead;
};

static int by_atoms(const void *a, const void *b) {
    const struct place *const x = a, *const y = b;
    if (x->molecule != y->molecule)
        return x->molecule < y->molecule ? -1 : 1;
    return x->atom < y->atom ? -1 : x->atom > y->atom;
}

static enum status sort_beads(struct beads_file *file) {
    const struct mapping *const mapping = file->mapping;
    OWNED struct place *place = NULL;
    TRY_ARRAY(place, mapping->beads);
    TRY_ARRAY(file->order, mapping->beads);
    for (size_t k = 0; k < mapping->beads; k++)
        place[k] =
            (struct place){mapping->bead[k].molecule, mapping->atom[mapping->bead[k].first], k};
    qsort(place, mapping->beads, sizeof *place, by_atoms);
    for (size_t k = 0; k < mapping->beads; k++)
        file->order[k] = place[k].bead;
    return STATUS_OK;
}

enum status mf_beads_file_open(struct beads_file *file, const char *path,
                               const struct mapping *mapping, const struct structure *structure) {
    enum status status;
    *file = (struct beads_file){.mapping = mapping, .structure = structure};
    CHECK(find_format(file, path));
    CHECK(sort_beads(file));
    CHECK(mf_output_open(&file->output, path));
done:
    if (status != STATUS_OK)
        mf_beads_file_clear(file);
    return status;
}

enum status mf_beads_file_add(struct beads_file *file, const struct trajectory_frame *beads) {
    TRY(file->format->print(file, beads));
    file->frames++;
    return STATUS_OK;
}

enum status mf_beads_file_restart(struct beads_file *file) {
    char path[OUTPUT_PATH_SIZE];
    memcpy(path, file->output.path, sizeof path);
    mf_output_abandon(&file->output);
    file->frames = 0;
    return mf_output_open(&file->output, path);
}

enum status mf_beads_file_commit(struct beads_file *file) {
    return mf_output_commit(&file->output);
}

void mf_beads_file_clear(struct beads_file *file) {
    if (file->format)
        mf_output_abandon(&file->output);
    mf_memory_free(file->order);
    *file = (struct beads_file){0};
}
