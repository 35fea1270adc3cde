// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/sampling_engine.h"

#include "dynamics/simulation_change.h"

#include <math.h>

const char *const mf_sampling_engine_kinds[] = {"none", "lammps", "command", NULL};
const char *const mf_sampling_engine_tables[] = {
    "none", "lammps", "hoomd", "espresso", "openmm", "gromacs", "dl_poly", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct engine_settings, name)
const struct field mf_sampling_engine_fields[] = {
    {"name", FIELD_CHOICE, MEMBER(kind), .choices = mf_sampling_engine_kinds,
     .initial = ENGINE_NONE, .unit = "", .help = "who samples; its command stands after --engine"},
    {"input", FIELD_FILE, MEMBER(input), .unit = "", .help = "LAMMPS input; none: one is written"},
    {"frames", FIELD_TEXT, MEMBER(frames), .unit = "", .help = "trajectory of the command"},
    {"tables", FIELD_CHOICE, MEMBER(tables), .choices = mf_sampling_engine_tables, .initial = 0,
     .unit = "", .help = "as `export` writes them"},
    {"time_step", FIELD_NUMBER, MEMBER(time_step), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau", .help = "0: the scene's"},
    {"steps", FIELD_INTEGER, MEMBER(steps), .initial = 10, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "time steps of a sweep"},
    {"at_once", FIELD_INTEGER, MEMBER(at_once), .initial = 0, .minimum = 0, .maximum = 1024,
     .unit = "", .help = "replicas side by side; 0: as --threads"},
    {"keep", FIELD_INTEGER, MEMBER(keep), .initial = 2, .minimum = 1, .maximum = 1e9, .unit = "",
     .help = "pieces of a replica that stay"},
    FIELD_END,
};

// Frames of an engine as a simulation -------------------------------------------------------------

struct replay {
    const struct sampling_engine *engine;
    void *frames; ///< NULL: not asked for yet
    uint64_t taken;
    double *position[3]; ///< by id
    struct integrator_told told;
};

static enum status begin(struct simulation *simulation) {
    struct replay *replay = simulation->integrator_state;
    replay->engine =
        ((const struct engine_replay *)simulation->setup.integrator_parameters)->engine;
    replay->told = (struct integrator_told){NAN, NAN};
    for (int d = 0; d < simulation->setup.box.dimensions; d++)
        TRY_ARRAY(replay->position[d], simulation->particles.count);
    return STATUS_OK;
}

static void clear(void *state) {
    struct replay *replay = state;
    if (replay->engine)
        replay->engine->end(replay->frames);
    for (int d = 0; d < 3; d++)
        mf_memory_free(replay->position[d]);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct replay *replay = state;
    spans[0] = (struct memory_span){&replay->taken, sizeof replay->taken};
    spans[1] = (struct memory_span){&replay->told, sizeof replay->told};
    return 2;
}

/// Ask for the frames, and pass those that were taken before an interruption.
static enum status open_frames(struct replay *replay, const struct engine_piece *piece) {
    struct engine_sample sample;
    TRY(replay->engine->begin(replay->engine->context, piece, &replay->frames));
    for (uint64_t k = 0; k < replay->taken; k++)
        TRY(replay->engine->next(replay->frames, replay->position, &sample));
    return STATUS_OK;
}

/// Particles are where the frame has them, in the image in which the list knows them.
static void place(struct particles *particles, const struct box *box, double *const position[3]) {
    for (int d = 0; d < box->dimensions; d++) {
        const double length = box->length[d];
        for (size_t k = 0; k < particles->count; k++)
            particles->position[d][k] +=
                box_nearest(position[d][particles->id[k]] - particles->position[d][k], length);
    }
}

static enum status step(struct simulation *simulation) {
    struct replay *replay = simulation->integrator_state;
    const struct engine_replay *of = simulation->setup.integrator_parameters;
    struct engine_sample sample;
    enum status status = replay->frames ? STATUS_OK : open_frames(replay, &of->piece);
    if (status == STATUS_OK)
        status = replay->engine->next(replay->frames, replay->position, &sample);
    if (status != STATUS_OK) {
        simulation->step--; // nothing has moved
        return status;
    }
    replay->taken++;
    replay->told = (struct integrator_told){sample.temperature, sample.pressure};
    place(&simulation->particles, &sample.box, replay->position);
    return mf_simulation_set_box(simulation, &sample.box);
}

static const struct integrator_told *tell(const void *state) {
    return &((const struct replay *)state)->told;
}

static const struct field fields[] = {FIELD_END};

const struct integrator mf_sampling_engine_replay = {
    .name = "replay",
    .summary = "frames of another engine",
    .fields = fields,
    .parameters_size = sizeof(struct engine_replay),
    .state_size = sizeof(struct replay),
    .begin = begin,
    .clear = clear,
    .spans = spans,
    .tell = tell,
    .masses = true,
    .samples = true,
    .step = step,
};
