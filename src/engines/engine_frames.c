// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/digest.h"
#include "base/memory.h"
#include "base/statistics.h"
#include "engines/engine.h"
#include "engines/engine_folder.h"
#include "forces/molecules.h"
#include "defaults/fit_engine.h"
#include "trajectory/frame.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

struct engine_frames {
    struct engine_run *run;
    char folder[OUTPUT_PATH_SIZE];
    char file[OUTPUT_PATH_SIZE];
    struct trajectory trajectory;
    struct trajectory_frame frame;
    bool open;
    const struct box *box;
    double nm; ///< of λ, as the trajectory is read
    size_t beads;
    size_t *atom; ///< of each bead, shape [beads]
    size_t replica;
    bool fresh; ///< from the beginning
    uint64_t number, taken, wanted;
    uint64_t last; ///< digest of the places in the frame before
    size_t skip;
    struct engine_numbers numbers;
    size_t row; ///< of the frame before: both grow
};

void mf_engine_frames_close(void *memory) {
    struct engine_frames *frames = memory;
    if (frames == NULL)
        return;
    if (frames->open)
        mf_trajectory_close(&frames->trajectory);
    mf_frame_clear(&frames->frame);
    mf_memory_free(frames->atom);
    mf_engine_numbers_clear(&frames->numbers);
    mf_memory_free(frames);
}

// Atoms -------------------------------------------------------------------------------------------

/// Whether an atom is of a type: as the run file calls it for the engine, or by its own name, or,
/// in files of numbers, by its place.
static bool is_of_type(const struct engine_run *run, const struct structure *structure, size_t k,
                       int type) {
    const struct structure_atom *atom = &structure->atom[k];
    const struct composition *composition = &run->fit->scene.setup.composition;
    const char *called = run->settings->type[type];
    char number[STRUCTURE_NAME];
    snprintf(number, sizeof number, "%lld", (long long)atom->type);
    if (called[0])
        return strcmp(called, atom->name) == 0 || strcmp(called, atom->type_name) == 0 ||
               (structure->has_types && strcmp(called, number) == 0);
    if (composition->types == 0 || (composition->types == 1 && !composition->name[0][0]))
        return true;
    if (structure->has_names && structure->names != STRUCTURE_TYPES)
        return strcmp(composition->name[type], atom->name) == 0;
    return structure->has_types && atom->type == type + 1;
}

static const char *name_of(const struct composition *composition, int type) {
    return composition->types > 0 && composition->name[type][0] ? composition->name[type]
                                                                : "the beads";
}

/// Beads in the order of their types, those of a type as the atoms stand.
static enum status find_atoms(const struct engine_run *run, struct engine_frames *frames) {
    const struct structure *structure = &frames->trajectory.structure;
    const struct composition *composition = &run->fit->scene.setup.composition;
    size_t bead = 0;
    for (int type = 0; type < (composition->types > 0 ? composition->types : 1); type++) {
        const size_t first = bead;
        const size_t wanted =
            composition->types > 0 ? (size_t)composition->count[type] : frames->beads;
        for (size_t k = 0; k < structure->atoms; k++) {
            if (!is_of_type(run, structure, k, type))
                continue;
            if (bead < first + wanted)
                frames->atom[bead] = k;
            bead++;
        }
        if (bead != first + wanted)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %zu atoms of the engine are %s, of which the scene has %zu; "
                                  "\"types\" of \"engine\" says which are",
                                  frames->file, bead - first, name_of(composition, type), wanted);
    }
    return STATUS_OK;
}

// Frames ------------------------------------------------------------------------------------------

/// By which a box may differ from that of the scene and be the same, as a part of its edges; and
/// beyond which it is that of another system, or in other units.
static const double rounding = 1e-4, another = 0.5;

static enum status open_trajectory(const struct engine_run *run, struct engine_frames *frames) {
    const struct units *units = &run->fit->scene.units;
    // LAMMPS is given real units where there is a scale, a command those of the run file.
    const bool physical = run->tongue->units ? mf_units_known(units) : mf_units_are_physical(units);
    const char *other = physical ? run->tongue->units : "lj";
    // Files that do not say their units are in those of the run file.
    const char *own = !physical ? NULL : units->system == UNITS_ANGSTROM_FS ? "real" : "nm-ps";
    frames->nm = physical ? units->length : 1;
    enum status status = mf_trajectory_open(&frames->trajectory, frames->file,
                                            &(struct trajectory_options){.units = other});
    if (status == STATUS_BAD_INPUT && run->tongue->units == NULL) // a format that has its own
        status = mf_trajectory_open(&frames->trajectory, frames->file,
                                    &(struct trajectory_options){.units = own});
    frames->open = status == STATUS_OK;
    return status;
}

/// Fewer frames than were asked for are a fault; what comes after them is left.
static enum status fail_short(const struct engine_frames *frames) {
    return mf_status_fail(
        STATUS_BAD_INPUT, "%s: it ends after %llu of the %llu frames that were asked for",
        frames->file, (unsigned long long)frames->taken, (unsigned long long)frames->wanted);
}

static enum status fill(const struct engine_run *run, const struct engine_piece *piece,
                        const char *folder, struct engine_frames *frames) {
    const struct simulation_setup *setup = &run->fit->scene.setup;
    frames->box = &setup->box;
    frames->beads = (size_t)setup->placement.count;
    frames->wanted = piece->frames;
    frames->replica = piece->replica;
    frames->number = piece->number;
    frames->fresh = piece->fresh;
    frames->skip = run->tongue->skip;
    mf_engine_path(folder, run->tongue->frames(run), frames->file);
    if (access(frames->file, F_OK) != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the command has left no such file; all it "
                              "said is in engine.log beside it",
                              frames->file);
    TRY_ARRAY(frames->atom, frames->beads);
    TRY(open_trajectory(run, frames));
    TRY(find_atoms(run, frames));
    TRY(run->tongue->numbers(run, piece, folder, &frames->numbers));
    if (targets_ask(&run->fit->problem.targets, TARGET_PRESSURE) && !frames->numbers.pressure)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: target.pressure: the engine does not tell the pressure of its "
                              "frames, and may have forces that mesofit does not know",
                              folder);
    return STATUS_OK;
}

enum status mf_engine_frames_open(struct engine_run *run, const struct engine_piece *piece,
                                  const char *folder, struct engine_frames **frames) {
    TRY_ARRAY(*frames, 1);
    (*frames)->run = run;
    snprintf((*frames)->folder, sizeof(*frames)->folder, "%s", folder);
    const enum status status = fill(run, piece, folder, *frames);
    if (status == STATUS_OK)
        return STATUS_OK;
    mf_engine_frames_close(*frames);
    *frames = NULL;
    return status;
}

static enum status check_periodic(const struct trajectory_frame *frame, int dimensions) {
    for (int a = 0; frame->has_box && a < dimensions; a++)
        if (!frame->periodic[a])
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: frame %zu: the box is not periodic along %c, and g(r) is that "
                "of periodic boxes",
                frame->file, frame->number, 'x' + a);
    return STATUS_OK;
}

static enum status refuse_box(const struct engine_frames *frames, const char *why) {
    const struct trajectory_frame *frame = &frames->frame;
    const double nm = frames->nm, *scene = frames->box->length;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: frame %zu: the box is %.6g by %.6g by %.6g" STATUS_LENGTH
                          " where the scene's is %.6g by %.6g by %.6g" STATUS_LENGTH "; %s",
                          frames->file, frame->number, frame->box[0][0] / nm, frame->box[1][1] / nm,
                          frame->box[2][2] / nm, scene[0], scene[1], scene[2], why);
}

static bool is_tilted(const struct engine_frames *frames) {
    bool tilted = false;
    for (int a = 0; a < frames->box->dimensions; a++)
        for (int b = 0; b < frames->box->dimensions; b++)
            tilted = tilted || (a != b && fabs(frames->frame.box[a][b]) >
                                              rounding * frames->box->length[a] * frames->nm);
    return tilted;
}

/// What counts molecules, and verifies, knows rectangular boxes.
static enum status refuse_tilted(const struct engine_frames *frames) {
    const struct fit_file *fit = frames->run->fit;
    const struct simulation_setup *setup = &fit->scene.setup;
    if (frames->box->dimensions == 2 || mf_molecules_find(setup->interaction, setup->interactions))
        return refuse_box(frames, "it is tilted, which a box of molecules, or of two dimensions, "
                                  "may not be");
    if (mf_fit_engine_verifies(fit))
        return refuse_box(frames, "it is tilted: what is found in such a box is verified by "
                                  "mesofit, in a rectangular one, if the scene has all forces: "
                                  "\"verification\": {\"by\": \"mesofit\"}");
    return STATUS_OK;
}

/// In λ, with the diagonal as the edges of a box of the same volume.
static enum status find_vectors(struct engine_frames *frames, struct engine_sample *sample) {
    struct box_vectors *v = &sample->vectors;
    TRY(refuse_tilted(frames));
    TRY(mf_frame_box_find(v, &frames->frame));
    for (int a = 0; a < 3; a++) {
        sample->box.length[a] = v->edge[a][a] / frames->nm;
        v->height[a] /= frames->nm;
        for (int b = 0; b < 3; b++) {
            v->edge[a][b] /= frames->nm;
            v->inverse[a][b] *= frames->nm;
        }
    }
    v->volume /= frames->nm * frames->nm * frames->nm;
    return STATUS_OK;
}

/// Whether the box is not that of the scene: its edges, or the volume of one that is tilted; at
/// constant pressure by much.
static bool is_another(const struct engine_frames *frames, const struct engine_sample *sample,
                       bool changes) {
    const struct box *scene = frames->box, *box = &sample->box;
    const double allowed = changes ? another : rounding;
    bool is = sample->tilted && fabs(mf_box_volume(box) / mf_box_volume(scene) - 1) > 3 * allowed;
    for (int d = 0; d < scene->dimensions && !sample->tilted; d++)
        is = is || fabs(box->length[d] / scene->length[d] - 1) > allowed;
    return is;
}

/// At constant volume the box is that of the scene; at constant pressure, where the density is a
/// target, it is that of the frame. In a tilted one of the same volume g(r) is the same.
static enum status find_box(struct engine_frames *frames, struct engine_sample *sample) {
    const struct trajectory_frame *frame = &frames->frame;
    const bool changes = targets_ask(&frames->run->fit->problem.compared, TARGET_DENSITY);
    sample->box = *frames->box;
    sample->tilted = false;
    TRY(check_periodic(frame, sample->box.dimensions));
    if (!frame->has_box)
        return changes ? mf_status_fail(STATUS_BAD_INPUT,
                                        "%s: target.density: its frames tell no box", frames->file)
                       : STATUS_OK;
    sample->tilted = is_tilted(frames);
    for (int d = 0; d < sample->box.dimensions; d++)
        sample->box.length[d] = frame->box[d][d] / frames->nm;
    if (sample->tilted)
        TRY(find_vectors(frames, sample));
    if (is_another(frames, sample, changes))
        return refuse_box(
            frames, changes ? "it must be of about that density, and in the units of its format"
                            : "\"box\" of the scene must be that of the engine, constant unless "
                              "\"density\" is a target, and the frames in their format's units");
    if (!changes && !sample->tilted)
        sample->box = *frames->box;
    return STATUS_OK;
}

/// Along an axis, or of a tilted box as much of the vector.
static double place_along(const struct engine_frames *frames, const struct engine_sample *sample,
                          size_t atom, int d) {
    const double *place = frames->frame.position[atom], *row = sample->vectors.inverse[d];
    if (!sample->tilted)
        return place[d] / frames->nm;
    return sample->box.length[d] / frames->nm *
           (place[0] * row[0] + place[1] * row[1] + place[2] * row[2]);
}

/// In a unit that is ten times as large all places are within a tenth of the box from its origin,
/// where no droplet happens to be; in one that is ten times smaller they spread over ten boxes.
/// Those of a beginning have not gone far.
static enum status check_units(const struct engine_frames *frames,
                               const struct engine_sample *sample) {
    static const double least = 0.12, most = 4;
    double narrowest = INFINITY, farthest = 0;
    for (int d = 0; d < sample->box.dimensions; d++) {
        struct running_mean places = {0};
        for (size_t bead = 0; bead < frames->beads; bead++) {
            const double place =
                place_along(frames, sample, frames->atom[bead], d) / sample->box.length[d];
            mf_statistics_add(&places, place);
            farthest = fmax(farthest, fabs(place));
        }
        narrowest = fmin(narrowest, sqrt(12 * places.squares / places.count));
    }
    const bool small = farthest < least, large = frames->fresh && narrowest > most;
    if (frames->beads < 2 || !(small || large))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: frame %zu: the beads are spread over %.2g of the box along each axis: "
        "look at the unit of their positions",
        frames->file, frames->frame.number, small ? farthest : narrowest);
}

/// Samples of replicas, and of times, differ.
static enum status check_motion(struct engine_frames *frames) {
    uint64_t digest = DIGEST_OF_NOTHING;
    for (size_t bead = 0; bead < frames->beads; bead++)
        mf_digest_add(&digest, frames->frame.position[frames->atom[bead]],
                      sizeof *frames->frame.position);
    if (frames->taken > 0 && digest == frames->last)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu: all beads are where they were in the frame before: "
                              "nothing moves",
                              frames->file, frames->frame.number);
    frames->last = digest;
    return frames->taken == 0
               ? mf_engine_compare(frames->run, frames->number, frames->replica, digest)
               : STATUS_OK;
}

/// What is known beside the frame.
static enum status find_sample(struct engine_frames *frames, struct engine_sample *sample) {
    const struct engine_numbers *numbers = &frames->numbers;
    size_t row = (size_t)frames->taken + frames->skip;
    if (numbers->step)
        for (row = frames->row; row < numbers->rows && numbers->step[row] != frames->frame.step;)
            row++;
    frames->row = row;
    const bool known = row < numbers->rows;
    if (!known && numbers->step)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: no numbers of step %lld are beside it",
                              frames->file, (long long)frames->frame.step);
    *sample = (struct engine_sample){
        .temperature = known && numbers->temperature ? numbers->temperature[row] : NAN,
        .pressure = known && numbers->pressure ? numbers->pressure[row] : NAN,
        .energy = known && numbers->energy ? numbers->energy[row] : NAN};
    return STATUS_OK;
}

static enum status next(struct engine_frames *frames, double *const position[3],
                        struct engine_sample *sample) {
    struct trajectory_frame *frame = &frames->frame;
    const size_t reads = frames->taken == 0 ? frames->skip + 1 : 1;
    for (size_t k = 0; k < reads; k++) {
        bool more;
        TRY(mf_trajectory_next(&frames->trajectory, frame, &more));
        if (!more)
            return fail_short(frames);
    }
    TRY(check_motion(frames));
    TRY(find_sample(frames, sample));
    TRY(find_box(frames, sample));
    if (frames->taken == 0)
        TRY(check_units(frames, sample));
    frames->taken++;
    for (int d = 0; d < sample->box.dimensions; d++) {
        const double length = sample->box.length[d];
        for (size_t bead = 0; bead < frames->beads; bead++) {
            const double x = place_along(frames, sample, frames->atom[bead], d);
            if (!isfinite(x))
                return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu: a position is no number",
                                      frames->file, frame->number);
            position[d][bead] = x - length * floor(x / length);
        }
    }
    return STATUS_OK;
}

enum status mf_engine_frames_next(void *memory, double *const position[3],
                                  struct engine_sample *sample) {
    struct engine_frames *frames = memory;
    const enum status status = next(frames, position, sample);
    return status == STATUS_OK ? STATUS_OK : mf_engine_refuse(frames->run, frames->folder, status);
}
