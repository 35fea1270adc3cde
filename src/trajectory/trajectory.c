// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/trajectory.h"

#include "base/memory.h"
#include "base/names.h"
#include "base/nearest.h"
#include "trajectory/trajectory_memory.h"
#include "trajectory/words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

NAMED_RECORD(struct trajectory_format);

#define TRAJECTORY_LISTED(record) &record,
const struct trajectory_format *const mf_trajectory_formats[] = {
    TRAJECTORY_FORMATS(TRAJECTORY_LISTED) NULL};

static bool ends_with(const char *file, const char *extension) {
    const char *const point = strrchr(file, '.');
    return point && strcasecmp(point, extension) == 0;
}

/// Whether a file is called "name.extension", or so before it was compressed.
static bool has_extension(const struct trajectory_format *format, const char *file) {
    const char *end = file + strlen(file);
    if (ends_with(file, ".gz") || ends_with(file, ".zst"))
        end = strrchr(file, '.');
    for (size_t k = 0; format->extensions[k]; k++) {
        const size_t length = strlen(format->extensions[k]);
        if ((size_t)(end - file) > length && end[-(ptrdiff_t)length - 1] == '.' &&
            strncasecmp(end - length, format->extensions[k], length) == 0)
            return true;
    }
    return false;
}

enum { HINT = 512 };

/// All formats by their names.
static void list_formats(char *hint) {
    size_t length = (size_t)snprintf(hint, HINT, "read are ");
    for (size_t k = 0; mf_trajectory_formats[k]; k++)
        length += (size_t)snprintf(hint + length, HINT - length, "%s%s", k ? ", " : "",
                                   mf_trajectory_formats[k]->name);
    snprintf(hint + length, HINT - length,
             ", also as .gz or .zst; gmx trjconv, cpptraj, VMD or MDAnalysis convert others");
}

/// A file's name as a shell takes it: in quotes, with each ' as '\\'', if it has more than letters,
/// digits and what is safe.
static void quote(const char *file, char *quoted, size_t size) {
    static const char safe[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/+";
    size_t length = 0;
    const bool plain = file[strspn(file, safe)] == '\0';
    const char *const mark = plain ? "" : "'";
    length += (size_t)snprintf(quoted, size, "%s", mark);
    for (; *file && length + 6 < size; file++)
        length +=
            (size_t)snprintf(quoted + length, size - length, *file == '\'' ? "'\\''" : "%c", *file);
    snprintf(quoted + length, size - length, "%s%s", *file ? "…" : "", mark);
}

/// What another format is called or begins with, and what is to be done about it.
static void find_hint(const char *file, const unsigned char *begin, size_t size, char *hint) {
    char name[256];
    quote(file, name, sizeof name);
    if (ends_with(file, ".tpr") || (size >= 15 && memcmp(begin + 8, "VERSION", 7) == 0))
        snprintf(hint, HINT,
                 "GROMACS's .tpr is not read: \"gmx editconf -f %s -o conf.gro\" writes names "
                 "and residues, and topol.top has masses (-s)",
                 name);
    else if (ends_with(file, ".tng") || (size >= 52 && memcmp(begin + 40, "GENERAL INFO", 12) == 0))
        snprintf(hint, HINT, "TNG is not read: \"gmx trjconv -f %s -o traj.xtc\" makes what is",
                 name);
    else if (ends_with(file, ".trz"))
        snprintf(hint, HINT, "TRZ is not read: MDAnalysis makes .xtc or .dcd of it");
    else if (ends_with(file, ".mdcrd") || ends_with(file, ".crd"))
        snprintf(hint, HINT,
                 "Amber's text does not say how many atoms it has: \"cpptraj -p PRMTOP -y %s -x "
                 "traj.nc\" makes what is read",
                 name);
    else
        list_formats(hint);
}

static enum status find_format(struct trajectory *trajectory) {
    const unsigned char *begin;
    size_t size;
    TRY(mf_source_peek(&trajectory->source, &begin, &size));
    if (size == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file is empty", trajectory->file);
    const struct trajectory_format *const *formats = mf_trajectory_formats;
    for (size_t k = 0; formats[k] && trajectory->format == NULL; k++)
        if (formats[k]->recognise(begin, size))
            trajectory->format = formats[k];
    for (size_t k = 0; formats[k] && trajectory->format == NULL; k++)
        if (has_extension(formats[k], trajectory->file))
            trajectory->format = formats[k];
    if (trajectory->format)
        return STATUS_OK;
    char hint[HINT];
    find_hint(trajectory->file, begin, size, hint);
    return mf_status_fail(STATUS_BAD_INPUT, "%s: not a trajectory: %s", trajectory->file, hint);
}

/// Reduced units have no size: ours is as good as any, and shapes all that is printed.
static void note_reduced(struct trajectory *trajectory, const char *units) {
    if (units && strcmp(units, "lj") == 0 && trajectory->note[0] == '\0')
        snprintf(
            trajectory->note, sizeof trajectory->note,
            "%.150s: units lj: 1 is taken as 1 nm, 1 ps and 1 u, so that k_B T = 1 is 120.272 K",
            trajectory->file);
}

/// What is given, unless the format has units of its own; else Å, fs and u, unless only the file
/// can know.
static enum status find_units(struct trajectory *trajectory, const char *units) {
    const struct trajectory_format *const format = trajectory->format;
    if (format->unit_source == TRAJECTORY_OWN_UNITS)
        trajectory->scale = (struct trajectory_scale){1, 1, 1, 1, 1};
    else if (units || format->unit_source == TRAJECTORY_ANGSTROM) {
        note_reduced(trajectory, units);
        return mf_trajectory_units_find(units ? units : "real", &trajectory->scale);
    }
    return STATUS_OK;
}

enum status mf_trajectory_found_units(struct trajectory *trajectory, const char *name) {
    struct trajectory_scale scale;
    if (mf_trajectory_units_find(name, &scale) != STATUS_OK)
        return mf_status_prefix(STATUS_BAD_INPUT, "%s", trajectory->file);
    const bool given = trajectory->scale.length > 0;
    note_reduced(trajectory, name);
    if (given && memcmp(&scale, &trajectory->scale, sizeof scale) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file has the units \"%s\"",
                              trajectory->file, name);
    trajectory->scale = scale;
    return STATUS_OK;
}

static enum status check_units(const struct trajectory *trajectory) {
    if (trajectory->scale.length > 0)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: the file has no units: give them by --file-units (real, metal, nano, nm-ps, lj …)",
        trajectory->file);
}

/// NAN is a mass that is not known, 0 that of a site without any.
static enum status check_masses(const struct trajectory *trajectory) {
    const struct structure *const structure = &trajectory->structure;
    for (size_t k = 0; k < structure->atoms; k++)
        if (structure->atom[k].mass < 0 || isinf(structure->atom[k].mass))
            return mf_status_fail(STATUS_BAD_INPUT, "%s: the mass of atom %zu is %.6g u",
                                  trajectory->file, k + 1, structure->atom[k].mass);
    return STATUS_OK;
}

static enum status begin(struct trajectory *trajectory) {
    const struct trajectory_format *const format = trajectory->format;
    bool more = true;
    trajectory->state = mf_memory_zeroed(1, format->state_size);
    if (trajectory->state == NULL)
        return STATUS_NO_MEMORY;
    if (format->open)
        TRY(format->open(trajectory));
    TRY(mf_trajectory_fetch(trajectory, &trajectory->first, &more));
    if (!more)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file has no frame", trajectory->file);
    TRY(format->describe(trajectory, &trajectory->first));
    TRY(check_units(trajectory));
    TRY(check_masses(trajectory));
    TRY(mf_structure_number_residues(&trajectory->structure));
    trajectory->waiting = true;
    return STATUS_OK;
}

enum status mf_trajectory_open(struct trajectory *trajectory, const char *file,
                               const struct trajectory_options *options) {
    enum status status;
    *trajectory = (struct trajectory){.file = file,
                                      .time_step = options->time_step,
                                      .group = options->group,
                                      .forces = options->forces};
    memcpy(trajectory->box, options->box, sizeof trajectory->box);
    if (mf_trajectory_memory_find(file)) {
        trajectory->format = &mf_trajectory_memory;
        mf_source_stand_in(&trajectory->source, file);
    } else {
        CHECK(mf_source_open(&trajectory->source, file));
        CHECK(find_format(trajectory));
    }
    CHECK(find_units(trajectory, options->units));
    CHECK(begin(trajectory));
done:
    if (status != STATUS_OK)
        mf_trajectory_close(trajectory);
    return status;
}

void mf_trajectory_close(struct trajectory *trajectory) {
    if (trajectory->state && trajectory->format->close)
        trajectory->format->close(trajectory);
    mf_source_close(&trajectory->source);
    mf_structure_clear(&trajectory->structure);
    mf_frame_clear(&trajectory->first);
    mf_memory_free(trajectory->state);
    *trajectory = (struct trajectory){0};
}

/// The frame that opening has taken changes hands; the caller's arrays are kept, and freed later.
static void give_first(struct trajectory *trajectory, struct trajectory_frame *frame) {
    const struct trajectory_frame given = trajectory->first;
    trajectory->first = *frame;
    *frame = given;
    trajectory->waiting = false;
}

enum status mf_trajectory_fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                                bool *more) {
    struct source *const source = &trajectory->source;
    *more = true;
    if (trajectory->waiting) {
        give_first(trajectory, frame);
        return STATUS_OK;
    }
    if (trajectory->frames > 0)
        *more = source->frame < trajectory->frames;
    else
        TRY(mf_source_more(source, more));
    if (!*more)
        return STATUS_OK;
    frame->file = trajectory->file;
    frame->number = source->frame;
    frame->first_byte = source->byte;
    frame->first_line = source->line;
    frame->raw.size = 0;
    TRY(trajectory->format->fetch(trajectory, frame, more));
    source->frame += *more;
    return STATUS_OK;
}

bool mf_trajectory_peek(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    if (trajectory->format->peek == NULL)
        return false;
    frame->time = trajectory->format->peek(frame);
    return true;
}

/// Vectors as formats have them that tell lengths or bounds of a box: lower triangular.
static enum status check_box(const struct trajectory_frame *frame) {
    const double(*box)[3] = (const double(*)[3])frame->box;
    const bool triangular = box[0][1] == 0 && box[0][2] == 0 && box[1][2] == 0;
    for (int d = 0; d < 3 && triangular; d++)
        if (box[d][d] < 0)
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: frame %zu: edge %d of the box is %.6g nm; expected a positive length",
                frame->file, frame->number, d + 1, box[d][d]);
    return STATUS_OK;
}

/// The box that was told is for frames without one that is periodic along all of its vectors.
static enum status take_told_box(const struct trajectory *trajectory,
                                 struct trajectory_frame *frame) {
    const double box[3][3] = {
        {trajectory->box[0], 0, 0}, {0, trajectory->box[1], 0}, {0, 0, trajectory->box[2]}};
    if (frame->periodic[0] && frame->periodic[1] && frame->periodic[2])
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu has a box of its own: leave out --box", frame->file,
                              frame->number);
    mf_frame_set_box(frame, box);
    return STATUS_OK;
}

enum status mf_trajectory_decode(const struct trajectory *trajectory,
                                 struct trajectory_frame *frame) {
    frame->step = -1;
    frame->time = NAN;
    if (trajectory->format->decode == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: has no coordinates: give it by -s, beside a trajectory",
                              trajectory->file);
    TRY(trajectory->format->decode(trajectory, frame));
    TRY(check_box(frame));
    if (trajectory->box[0] > 0)
        TRY(take_told_box(trajectory, frame));
    if (isnan(frame->time) && frame->step >= 0 && trajectory->time_step > 0)
        frame->time = (double)frame->step * trajectory->time_step;
    return STATUS_OK;
}

enum status mf_trajectory_next(struct trajectory *trajectory, struct trajectory_frame *frame,
                               bool *more) {
    TRY(mf_trajectory_fetch(trajectory, frame, more));
    return *more ? mf_trajectory_decode(trajectory, frame) : STATUS_OK;
}

enum status mf_trajectory_sort(struct trajectory *trajectory,
                               const struct trajectory_frame *first) {
    const enum status status = mf_structure_sort(&trajectory->structure);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s:%zu: frame 0", first->file, first->first_line + 1);
    return STATUS_OK;
}

enum status mf_trajectory_begin_atoms(const struct trajectory *trajectory,
                                      struct trajectory_frame *frame) {
    const size_t atoms = trajectory->structure.atoms;
    frame->scratch.size = 0;
    TRY(mf_source_capacity(&frame->scratch, atoms));
    memset(frame->scratch.data, 0, atoms);
    return STATUS_OK;
}

enum status mf_trajectory_find_atom(const struct trajectory *trajectory,
                                    struct trajectory_frame *frame, const char *line, int64_t id,
                                    size_t *atom) {
    *atom = mf_structure_find(&trajectory->structure, id);
    if (*atom == trajectory->structure.atoms)
        return mf_frame_fail_line(frame, line, "the first frame has no atom of id %lld",
                                  (long long)id);
    if (frame->scratch.data[*atom])
        return mf_frame_fail_line(frame, line, "duplicate atom id %lld", (long long)id);
    frame->scratch.data[*atom] = 1;
    return STATUS_OK;
}

enum status mf_trajectory_fail_type(const struct trajectory *trajectory,
                                    const struct trajectory_frame *frame, const char *line,
                                    size_t atom, const struct word *type) {
    const struct structure *const structure = &trajectory->structure;
    const struct structure_atom *const first = &structure->atom[atom];
    char before[STRUCTURE_NAME + 8];
    if (structure->has_types)
        snprintf(before, sizeof before, "%lld", (long long)first->type);
    else
        snprintf(before, sizeof before, "%s", first->name);
    return mf_frame_fail_line(
        frame, line,
        "atom %lld is of type %.*s, in the first frame of %s: %swhere atoms swap types, leave out "
        "ids, sort rows by type (in LAMMPS columns type x y z, \"dump_modify sort 1\") and use "
        "--static",
        structure->has_ids ? (long long)first->id : (long long)atom + 1, words_shown(type),
        type->begin, before,
        structure->has_ids ? ""
                           : "without ids atoms come in any order; dump the column id, too, or use "
                             "\"dump_modify sort id\"; ");
}

enum status mf_trajectory_read_count(const struct trajectory *trajectory, const char *line,
                                     uint64_t *atoms) {
    const struct source *const source = &trajectory->source;
    const size_t wanted = trajectory->structure.atoms;
    struct word word;
    int64_t count;
    if (!mf_words_next(&line, &word) || !mf_words_integer(&word, &count) || count < 1)
        return mf_source_fail_line(source, "expected the number of atoms");
    *atoms = (uint64_t)count;
    if (source->frame > 0 && *atoms != wanted)
        return mf_source_fail_line(source, "it has %lld atoms, the first frame %zu",
                                   (long long)count, wanted);
    return STATUS_OK;
}

// Units -------------------------------------------------------------------------------------------

/// One gram, and the masses of an electron and an attogram, in u: CODATA 2018.
#define GRAM 6.02214076208e23
#define BOHR 0.0529177210903
/// The time of "electron" is a femtosecond, its speed that of one Bohr in 1.03275 fs.
#define ATOMIC_TIME 1.03275e-3
/// Of energies in kJ/mol: kcal/mol, eV, Hartree; and a newton in kJ/mol/nm.
#define KILOCALORIE 4.184
#define ELECTRON_VOLT 96.4853321233
#define HARTREE 2625.49963948
#define NEWTON 6.02214076208e11

const char *const mf_trajectory_unit_names[] = {"real",     "metal", "nano",  "lj",    "si",
                                                "electron", "cgs",   "micro", "nm-ps", NULL};

static const struct trajectory_scale scales[] = {
    {0.1, 1e-3, 1, 100, KILOCALORIE / 0.1},
    {0.1, 1, 1, 0.1, ELECTRON_VOLT / 0.1},
    {1, 1e3, 1e-18 * GRAM, 1e-3, 1e-12 * NEWTON},
    {1, 1, 1, 1, 1},
    {1e9, 1e12, 1e3 * GRAM, 1e-3, NEWTON},
    {BOHR, 1e-3, 1, BOHR / ATOMIC_TIME, HARTREE / BOHR},
    {1e7, 1e12, GRAM, 1e-5, 1e-5 * NEWTON},
    {1e3, 1e6, 1e-12 * GRAM, 1e-3, 1e-9 * NEWTON},
    {1, 1, 1, 1, 1},
};

enum { STYLES = sizeof scales / sizeof *scales };
_Static_assert(sizeof mf_trajectory_unit_names / sizeof *mf_trajectory_unit_names == STYLES + 1,
               "every style has a scale");

enum status mf_trajectory_units_find(const char *name, struct trajectory_scale *scale) {
    char hint[256];
    for (int k = 0; k < STYLES; k++)
        if (strcmp(name, mf_trajectory_unit_names[k]) == 0) {
            *scale = scales[k];
            return STATUS_OK;
        }
    if (strcmp(name, "angstrom-fs") == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "unknown units \"%s\"; of trajectories they are "
                              "called \"real\"",
                              name);
    mf_nearest_hint(name, mf_trajectory_unit_names, STYLES, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "unknown units \"%s\"; %s", name, hint);
}
