// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/run_frames.h"

#include <math.h>
#include <string.h>

static enum status read_frame(void *context, size_t number, struct trajectory_memory_frame *frame,
                              bool *there) {
    const struct mesofit_trajectory *const from = ((const struct run_frames *)context)->from;
    struct mesofit_frame given = {.time = NAN};
    const int answer = from->read(from->context, number, &given);
    if (answer < 0)
        return mf_status_fail(STATUS_INTERRUPTED, "%s: frame %zu could not be had", from->name,
                              number + 1);
    *there = answer > 0;
    if (*there && given.positions == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu has no positions", from->name,
                              number + 1);
    frame->time = given.time;
    memcpy(frame->box, given.box, sizeof given.box);
    frame->positions = given.positions;
    frame->velocities = given.velocities;
    return STATUS_OK;
}

static enum status check(const struct mesofit_trajectory *from) {
    const char *const name = from->name ? from->name : "a trajectory without a name";
    if (from->name == NULL || from->read == NULL || from->names == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: names of atoms and a reader are required",
                              name);
    if (from->atoms == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there are no atoms", name);
    if (!(from->length > 0) || !(from->time > 0) || isinf(from->length) || isinf(from->time))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: units of length and time must be above 0",
                              name);
    if ((from->residues == NULL) != (from->residue_names == NULL))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: residues need names and numbers", name);
    return STATUS_OK;
}

static enum status copy_name(const struct mesofit_trajectory *from, size_t atom, const char *name,
                             char to[STRUCTURE_NAME]) {
    if (name == NULL || name[0] == '\0')
        return mf_status_fail(STATUS_BAD_INPUT, "%s: atom %zu has no name", from->name, atom + 1);
    if (strlen(name) >= STRUCTURE_NAME)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the name \"%.60s\" of atom %zu has more than %d characters",
                              from->name, name, atom + 1, STRUCTURE_NAME - 1);
    strcpy(to, name);
    return STATUS_OK;
}

static enum status describe(struct structure *structure, const struct mesofit_trajectory *from) {
    const bool residues = from->residues != NULL;
    TRY(mf_structure_init(structure, from->atoms));
    structure->has_names = structure->has_residues = true;
    structure->has_masses = from->masses != NULL;
    for (size_t k = 0; k < from->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        TRY(copy_name(from, k, from->names[k], atom->name));
        TRY(copy_name(from, k, residues ? from->residue_names[k] : from->names[k],
                      atom->residue_name));
        atom->residue_number = residues ? from->residues[k] : (int64_t)k + 1;
        atom->mass = from->masses ? from->masses[k] : NAN;
    }
    return STATUS_OK;
}

enum status mf_run_frames_begin(struct run_frames *frames, const struct mesofit_trajectory *from) {
    TRY(check(from));
    frames->from = from;
    TRY(describe(&frames->structure, from));
    frames->memory_files = (struct trajectory_memory){.name = from->name,
                                                      .structure = &frames->structure,
                                                      .frames = from->frames,
                                                      .length = from->length,
                                                      .time = from->time,
                                                      .read = read_frame,
                                                      .context = frames};
    mf_trajectory_lend(&frames->memory_files);
    return STATUS_OK;
}

void mf_run_frames_end(struct run_frames *frames) {
    mf_trajectory_lend(NULL);
    mf_structure_clear(&frames->structure);
}
