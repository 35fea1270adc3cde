// SPDX-License-Identifier: GPL-3.0-or-later
//
// H5MD 1.1 (P. de Buyl, P. H. Colberg and F. Höfling, Comput. Phys. Commun. 185, 1546 (2014);
// https://h5md.nongnu.org): particles of one group, by the HDF5 library, frame by frame. Positions,
// velocities, forces, images, ids and the box's edges may change in time; masses are those of the
// first frame, and so must species be. Built if HDF5 is there: format_h5md_without.c stands for it
// otherwise.
#include "base/memory.h"
#include "base/status.h"
#include "trajectory/h5md_file.h"
#include "trajectory/trajectory.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

// The canary --------------------------------------------------------------------------------------

// A process that goes ahead: what HDF5 crashes on, of a damaged file, ends it alone.
//
// HDF5 1.10 believes sizes, addresses and chunks that a damaged file tells it. A child does all
// that is done with the file before its parent does it, and says so; where it has died, the file
// is refused. Another processor works for it, if there is one. Tested: test_trajectory_h5md.

struct h5md_canary {
    pid_t child;   ///< 0: none, or it has ended
    int from;      ///< it
    size_t passed; ///< steps that it has come through
};

/// It dies in silence: no handler of anybody, no core.
static void be_mortal(void) {
    static const int signals[] = {SIGSEGV, SIGBUS,  SIGFPE, SIGILL,  SIGABRT,
                                  SIGPIPE, SIGTERM, SIGHUP, SIGUSR1, SIGINT};
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++)
        signal(signals[k], signals[k] == SIGINT ? SIG_IGN : SIG_DFL);
    setrlimit(RLIMIT_CORE, &(const struct rlimit){0});
}

/// Begin. `go` is called in the child, which ends with it; it tells of each step.
static enum status canary_begin(struct h5md_canary *canary, void (*go)(void *context, int to),
                                void *context) {
    int ends[2];
    *canary = (struct h5md_canary){0};
    if (pipe(ends) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "no pipe to a process that reads HDF5 ahead");
    canary->child = fork();
    if (canary->child == 0) {
        be_mortal();
        close(ends[0]);
        go(context, ends[1]);
        _exit(0);
    }
    close(ends[1]);
    canary->from = ends[0];
    fcntl(canary->from, F_SETFD, FD_CLOEXEC);
    if (canary->child > 0)
        return STATUS_OK;
    *canary = (struct h5md_canary){0};
    close(ends[0]);
    return mf_status_fail(STATUS_NO_MEMORY, "no process is left that could read HDF5 ahead");
}

/// In the child: one more step is done.
static void canary_tell(int to) {
    if (write(to, "", 1) != 1)
        _exit(0); // nobody listens any more
}

/// Whether it died of a signal.
static bool has_died(struct h5md_canary *canary) {
    int how = 0;
    close(canary->from);
    while (waitpid(canary->child, &how, 0) < 0 && errno == EINTR)
        continue;
    canary->child = 0;
    return WIFSIGNALED(how);
}

/// Wait until it has come through so many steps, or has ended by itself. Fails: BAD_INPUT, naming
/// the file, if it died of one.
static enum status canary_wait(struct h5md_canary *canary, size_t steps, const char *file) {
    char byte;
    while (canary->child > 0 && canary->passed < steps) {
        const ssize_t got = read(canary->from, &byte, 1);
        canary->passed += got == 1;
        if (got == 0 && has_died(canary))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: HDF5 crashes where it reads it: it is damaged", file);
    }
    return STATUS_OK;
}

static void canary_end(struct h5md_canary *canary) {
    if (canary->child <= 0)
        return;
    kill(canary->child, SIGKILL);
    has_died(canary);
}

/// What goes before the numbers of a frame in its raw bytes.
struct header {
    double step, time; ///< [ps]
    double box[3][3];  ///< [nm]; 0: none
    bool has_velocities, has_images, has_forces, has_species, has_ids;
};

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 8 && memcmp(begin, "\x89HDF\r\n\x1A\n", 8) == 0;
}

struct state {
    struct h5md_file h5md; ///< first: what most functions know
    struct h5md_canary canary;
};

/// All that HDF5 is asked for by way of a trajectory, a step each: to open, every frame with, after
/// the first, what the atoms are.
static void go_ahead(void *context, int to);

static enum status open_file(struct trajectory *trajectory) {
    struct h5md_file *const h5md = trajectory->state;
    TRY(mf_h5md_file_open(h5md, trajectory));
    trajectory->frames = h5md->position.frames;
    return STATUS_OK;
}

static enum status open_trajectory(struct trajectory *trajectory) {
    struct state *const state = trajectory->state;
    TRY(canary_begin(&state->canary, go_ahead, trajectory));
    TRY(canary_wait(&state->canary, 1, trajectory->file));
    return open_file(trajectory);
}

static void close_trajectory(struct trajectory *trajectory) {
    struct state *const state = trajectory->state;
    mf_h5md_file_close(&state->h5md);
    canary_end(&state->canary);
}

// Fetching ----------------------------------------------------------------------------------------

/// Room after what is there, for the numbers of a frame.
static enum status take(struct trajectory_frame *frame, const struct h5md_element *element,
                        hsize_t at, hid_t type) {
    const size_t size = mf_h5md_element_numbers(element) * sizeof(double);
    TRY(mf_source_capacity(&frame->raw, size));
    TRY(mf_h5md_element_read(element, at, type, frame->raw.data + frame->raw.size));
    frame->raw.size += size;
    return STATUS_OK;
}

/// The same of what may be missing, if it is there at this step.
static enum status take_if(struct trajectory_frame *frame, struct h5md_element *element,
                           double step, hsize_t at, hid_t type, bool *taken) {
    *taken = false;
    if (element->there)
        TRY(mf_h5md_element_find(element, step, at, taken));
    return *taken ? take(frame, element, element->at, type) : STATUS_OK;
}

/// What each frame must have has nothing of this one.
static enum status fail_of_step(const struct h5md_element *element, double step, hsize_t at,
                                const char *what) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: frame %llu: \"%s\"%s has no frame of the positions' step, %.15g",
                          element->file, (unsigned long long)at, element->name, what, step);
}

static enum status read_box(struct h5md_file *h5md, double step, hsize_t at, double box[3][3]) {
    struct h5md_element *const edges = &h5md->edges;
    double numbers[9];
    bool found = false;
    if (!edges->there)
        return STATUS_OK;
    TRY(mf_h5md_element_find(edges, step, at, &found));
    if (!found)
        return fail_of_step(edges, step, at, " of the box");
    TRY(mf_h5md_element_read(edges, edges->at, H5T_NATIVE_DOUBLE, numbers));
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++) {
            const double number = edges->rank == 2 ? numbers[3 * i + d] : i == d ? numbers[d] : 0;
            box[i][d] = number * h5md->edge_length;
        }
    return STATUS_OK;
}

static enum status fetch_numbers(struct trajectory *trajectory, struct trajectory_frame *frame) {
    struct h5md_file *const h5md = trajectory->state;
    const hsize_t at = trajectory->source.frame;
    struct header header = {0};
    TRY(mf_h5md_element_clock(&h5md->position, &h5md->position.step, at, &header.step));
    TRY(mf_h5md_element_clock(&h5md->position, &h5md->position.time, at, &header.time));
    TRY(read_box(h5md, header.step, at, header.box));
    header.time *= trajectory->scale.time;
    TRY(mf_source_capacity(&frame->raw, sizeof header));
    frame->raw.size = sizeof header;
    TRY(take(frame, &h5md->position, at, H5T_NATIVE_DOUBLE));
    TRY(take_if(frame, &h5md->velocity, header.step, at, H5T_NATIVE_DOUBLE,
                &header.has_velocities));
    TRY(take_if(frame, &h5md->image, header.step, at, H5T_NATIVE_DOUBLE, &header.has_images));
    if (trajectory->forces)
        TRY(take_if(frame, &h5md->force, header.step, at, H5T_NATIVE_DOUBLE, &header.has_forces));
    if (h5md->species.timed)
        TRY(take_if(frame, &h5md->species, header.step, at, H5T_NATIVE_INT64, &header.has_species));
    TRY(take_if(frame, &h5md->id, header.step, at, H5T_NATIVE_INT64, &header.has_ids));
    if (h5md->id.there && !header.has_ids) // then it is unknown which particle is which
        return fail_of_step(&h5md->id, header.step, at, "");
    memcpy(frame->raw.data, &header, sizeof header);
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct state *const state = trajectory->state;
    const size_t at = trajectory->source.frame;
    *more = at < state->h5md.position.frames;
    if (!*more)
        return STATUS_OK;
    TRY(canary_wait(&state->canary, at + 2, trajectory->file));
    return fetch_numbers(trajectory, frame);
}

static double peek(const struct trajectory_frame *frame) {
    struct header header;
    memcpy(&header, frame->raw.data, sizeof header);
    return header.time;
}

// What the atoms are ------------------------------------------------------------------------------

/// Numbers of the first frame of what tells of atoms, one each. The caller frees them.
static enum status read_first(const struct h5md_element *element, hid_t type, void **numbers) {
    *numbers = mf_memory_zeroed(mf_h5md_element_numbers(element), sizeof(double));
    if (*numbers == NULL)
        return STATUS_NO_MEMORY;
    return mf_h5md_element_read(element, 0, type, *numbers);
}

static enum status describe_masses(const struct h5md_file *h5md, struct structure *structure) {
    double *mass = NULL;
    if (!h5md->mass.there)
        return STATUS_OK;
    const enum status status = read_first(&h5md->mass, H5T_NATIVE_DOUBLE, (void **)&mass);
    structure->has_masses = status == STATUS_OK;
    for (size_t k = 0; status == STATUS_OK && k < structure->atoms; k++)
        structure->atom[k].mass = mass[k] * h5md->mass_unit;
    mf_memory_free(mass);
    return status;
}

/// A species' name is that of the file's enumeration, or else its number.
static enum status describe_species(const struct h5md_file *h5md, struct structure *structure) {
    int64_t *species = NULL;
    if (!h5md->species.there)
        return STATUS_OK;
    const enum status status = read_first(&h5md->species, H5T_NATIVE_INT64, (void **)&species);
    structure->has_types = status == STATUS_OK;
    for (size_t k = 0; status == STATUS_OK && k < structure->atoms; k++) {
        structure->atom[k].type = species[k];
        mf_h5md_file_species(h5md, species[k], structure->atom[k].name);
    }
    mf_memory_free(species);
    return status;
}

static const unsigned char *ids_of(const struct trajectory_frame *frame) {
    return frame->raw.data + frame->raw.size - frame->atoms * sizeof(int64_t);
}

static int64_t read_id(const struct trajectory_frame *frame, size_t k) {
    int64_t id;
    memcpy(&id, ids_of(frame) + k * sizeof id, sizeof id);
    return id;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct h5md_file *const h5md = trajectory->state;
    struct structure *const structure = &trajectory->structure;
    struct header header;
    memcpy(&header, first->raw.data, sizeof header);
    first->atoms = (size_t)h5md->position.size[0];
    TRY(mf_structure_init(structure, first->atoms));
    TRY(describe_masses(h5md, structure));
    TRY(describe_species(h5md, structure));
    TRY(mf_h5md_topology_read(h5md, trajectory));
    structure->has_ids = header.has_ids;
    for (size_t k = 0; header.has_ids && k < structure->atoms; k++)
        structure->atom[k].id = read_id(first, k);
    const enum status status = header.has_ids ? mf_structure_sort(structure) : STATUS_OK;
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s: frame 0", trajectory->file);
    return mf_h5md_topology_bonds(h5md, trajectory);
}

static void go_ahead(void *context, int to) {
    struct trajectory *const trajectory = context;
    struct trajectory_frame frame = {.file = trajectory->file};
    enum status status = open_file(trajectory);
    canary_tell(to);
    size_t *const at = &trajectory->source.frame;
    for (; status == STATUS_OK && *at < trajectory->frames; ++*at) {
        frame.raw.size = 0;
        status = fetch_numbers(trajectory, &frame);
        if (status == STATUS_OK && *at == 0)
            status = describe(trajectory, &frame);
        canary_tell(to);
    }
}

// Decoding ----------------------------------------------------------------------------------------

/// Where each atom of the frame belongs, by its id.
static enum status find_atoms(const struct trajectory *trajectory, struct trajectory_frame *frame,
                              size_t *place) {
    TRY(mf_trajectory_begin_atoms(trajectory, frame));
    for (size_t k = 0; k < frame->atoms; k++) {
        const int64_t id = read_id(frame, k);
        place[k] = mf_structure_find(&trajectory->structure, id);
        if (place[k] == frame->atoms || frame->scratch.data[place[k]])
            return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu: the id %lld %s", frame->file,
                                  frame->number, (long long)id,
                                  place[k] == frame->atoms ? "is not in the first frame"
                                                           : "is a duplicate");
        frame->scratch.data[place[k]] = 1;
    }
    return STATUS_OK;
}

/// Species that are written for each frame: beads are made by those of the first.
static enum status check_species(const struct trajectory *trajectory,
                                 const struct trajectory_frame *frame, const struct header *header,
                                 const size_t *place) {
    const size_t size = frame->atoms * sizeof(int64_t), blocks = header->has_ids ? 2 : 1;
    const unsigned char *const from = frame->raw.data + frame->raw.size - blocks * size;
    for (size_t k = 0; k < frame->atoms; k++) {
        const int64_t first = trajectory->structure.atom[place ? place[k] : k].type;
        int64_t species;
        memcpy(&species, from + k * sizeof species, sizeof species);
        if (species != first)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: particle %zu is of species %lld, in the first "
                                  "frame of %lld: particles must keep theirs",
                                  frame->file, frame->number, k + 1, (long long)species,
                                  (long long)first);
    }
    return STATUS_OK;
}

/// Add to vectors the numbers that stand at `*at`, in units of three vectors.
static enum status add(const struct trajectory_frame *frame, size_t *at, const double unit[3][3],
                       const size_t *place, double (*array)[3]) {
    for (size_t k = 0; k < frame->atoms; k++, *at += 3 * sizeof(double)) {
        double number[3];
        memcpy(number, frame->raw.data + *at, sizeof number);
        for (int i = 0; i < 3; i++) {
            if (!isfinite(number[i]))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: frame %zu: a coordinate of particle %zu is not finite",
                                      frame->file, frame->number, k + 1);
            for (int d = 0; d < 3; d++)
                array[place ? place[k] : k][d] += number[i] * unit[i][d];
        }
    }
    return STATUS_OK;
}

static enum status decode_vectors(const struct trajectory *trajectory,
                                  struct trajectory_frame *frame, const struct header *header,
                                  const size_t *place) {
    const double x = trajectory->scale.length, v = trajectory->scale.speed,
                 f = trajectory->scale.force;
    const double lengths[3][3] = {{x, 0, 0}, {0, x, 0}, {0, 0, x}},
                 speeds[3][3] = {{v, 0, 0}, {0, v, 0}, {0, 0, v}},
                 forces[3][3] = {{f, 0, 0}, {0, f, 0}, {0, 0, f}};
    size_t at = sizeof *header;
    memset(frame->position, 0, frame->atoms * sizeof *frame->position);
    TRY(add(frame, &at, lengths, place, frame->position));
    if (header->has_velocities) {
        memset(frame->velocity, 0, frame->atoms * sizeof *frame->velocity);
        TRY(add(frame, &at, speeds, place, frame->velocity));
    }
    if (header->has_images)
        TRY(add(frame, &at, header->box, place, frame->position));
    if (!header->has_forces)
        return STATUS_OK;
    TRY(mf_frame_reserve_forces(frame));
    memset(frame->force, 0, frame->atoms * sizeof *frame->force);
    return add(frame, &at, forces, place, frame->force);
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const struct h5md_file *const h5md = trajectory->state;
    struct header header;
    OWNED size_t *place = NULL;
    memcpy(&header, frame->raw.data, sizeof header);
    frame->step = isfinite(header.step) && fabs(header.step) < 9e15 ? (int64_t)header.step : -1;
    frame->time = header.time;
    mf_frame_set_box(frame, (const double(*)[3])header.box);
    for (int i = 0; i < 3; i++)
        frame->periodic[i] = frame->has_box && h5md->periodic[i];
    TRY(mf_frame_reserve(frame, trajectory->structure.atoms, header.has_velocities));
    frame->unwrapped = header.has_images;
    if (header.has_ids) {
        TRY_ARRAY(place, frame->atoms);
        TRY(find_atoms(trajectory, frame, place));
    }
    if (header.has_species)
        TRY(check_species(trajectory, frame, &header, place));
    return decode_vectors(trajectory, frame, &header, place);
}

static const char *const extensions[] = {"h5md", "h5", "hdf5", NULL};

const struct trajectory_format mf_format_h5md = {
    .name = "h5md",
    .extensions = extensions,
    .summary = "H5MD 1.1: positions, velocities, forces, images, ids, box; masses, species, "
               "GROMACS's topology",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .state_size = sizeof(struct state),
    .recognise = recognise,
    .open = open_trajectory,
    .close = close_trajectory,
    .fetch = fetch,
    .peek = peek,
    .describe = describe,
    .decode = decode,
};
