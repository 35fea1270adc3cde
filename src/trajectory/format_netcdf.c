// SPDX-License-Identifier: GPL-3.0-or-later
//
// Amber's trajectories and restarts (conventions AMBER and AMBERRESTART, ambermd.org/netcdf) in
// NetCDF-3: classic, with 64-bit offsets or 64-bit data (Unidata's "File Format Specifications").
// After a header that says what stands where, each frame is one record of all variables, so that
// an own reader goes forwards, also through a pipe. NetCDF-4 is HDF5 and is refused there.
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

enum { DIMENSION = 10, VARIABLE = 11, ATTRIBUTE = 12 };
enum { CHARACTER = 2, INTEGER = 4, FLOAT = 5, DOUBLE = 6 };
enum {
    MAX_DIMENSIONS = 256,
    MAX_VARIABLES = 4096,
    MAX_RANK = 8,
    NAME = 64,
    LONGEST_VALUE = 1 << 20
};

enum role { TIME, COORDINATES, VELOCITIES, LENGTHS, ANGLES, ID, ROLES };
static const struct {
    const char *name;
    int rank;    ///< in one frame
    size_t last; ///< numbers of its last dimension; 0: of atoms
} roles[ROLES] = {{"time", 0, 1},         {"coordinates", 2, 3}, {"velocities", 2, 3},
                  {"cell_lengths", 1, 3}, {"cell_angles", 1, 3}, {"id", 1, 0}};

struct variable {
    char name[NAME], unit[NAME];
    bool timed; ///< it has numbers in each record
    int type, rank;
    uint64_t size[MAX_RANK]; ///< of its dimensions in one frame
    uint64_t begin, bytes;   ///< in the file; in one frame, what fills up not included
    double factor;           ///< "scale_factor"
};

struct netcdf {
    int version; ///< 1: classic, 2: 64-bit offsets, 5: 64-bit data
    uint64_t records;
    uint64_t dimension[MAX_DIMENSIONS]; ///< 0: that of records
    size_t dimensions;
    struct variable of[ROLES]; ///< "": not there, or not in each frame
    uint64_t begin, bytes;     ///< of the first frame in the file; of one frame
    double unit[ROLES];        ///< what their numbers are to be multiplied by [nm], [ps], [°]
};

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 4 && memcmp(begin, "CDF", 3) == 0 &&
           (begin[3] == 1 || begin[3] == 2 || begin[3] == 5);
}

// Header ------------------------------------------------------------------------------------------

struct head {
    struct trajectory *trajectory;
    struct netcdf *netcdf;
    struct bytes raw; ///< what was taken last
};

static enum status take(struct head *head, uint64_t count) {
    head->raw.size = 0;
    return mf_source_take(&head->trajectory->source, &head->raw, count);
}

static enum status take_number(struct head *head, bool is_long, uint64_t *number) {
    TRY(take(head, is_long ? 8 : 4));
    *number = is_long ? binary_long(head->raw.data, true) : binary_word(head->raw.data, true);
    return STATUS_OK;
}

/// A number that is longer in files of 64-bit data.
static enum status take_count(struct head *head, uint64_t max, uint64_t *count) {
    TRY(take_number(head, head->netcdf->version == 5, count));
    return *count <= max ? STATUS_OK
                         : mf_source_fail_byte(&head->trajectory->source,
                                               "%llu of what has %llu at most: it is damaged",
                                               (unsigned long long)*count, (unsigned long long)max);
}

static enum status take_text(struct head *head, char *text) {
    uint64_t length;
    TRY(take_count(head, LONGEST_VALUE, &length));
    TRY(take(head, (length + 3) / 4 * 4));
    memset(text, 0, NAME);
    memcpy(text, head->raw.data, length < NAME ? length : NAME - 1);
    return STATUS_OK;
}

/// The number of items of a list, 0 if there is none.
static enum status take_list(struct head *head, unsigned kind, uint64_t max, uint64_t *items) {
    uint64_t found;
    TRY(take_number(head, false, &found));
    TRY(take_count(head, max, items));
    if (found != (*items > 0 ? kind : 0) && found != kind)
        return mf_source_fail_byte(&head->trajectory->source,
                                   "a list begins with %llu instead of %u: it is damaged",
                                   (unsigned long long)found, kind);
    return STATUS_OK;
}

static size_t bytes_of(uint64_t type) {
    static const unsigned char bytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < sizeof bytes ? bytes[type] : 0;
}

/// Of the attributes of a variable, or of the file, those that are of use.
static enum status take_attributes(struct head *head, struct variable *variable) {
    uint64_t attributes, type, values;
    char name[NAME];
    TRY(take_list(head, ATTRIBUTE, LONGEST_VALUE, &attributes));
    for (uint64_t k = 0; k < attributes; k++) {
        TRY(take_text(head, name));
        TRY(take_number(head, false, &type));
        TRY(take_count(head, LONGEST_VALUE, &values));
        TRY(take(head, (values * bytes_of(type) + 3) / 4 * 4));
        const unsigned char *const value = head->raw.data;
        if (strcmp(name, "units") == 0 && type == CHARACTER)
            memcpy(variable->unit, value, values < NAME ? values : NAME - 1);
        if (strcmp(name, "scale_factor") == 0 && values == 1 && (type == FLOAT || type == DOUBLE))
            variable->factor = binary_real(value, 0, bytes_of(type), true);
    }
    return STATUS_OK;
}

static enum status take_dimensions(struct head *head) {
    struct netcdf *const netcdf = head->netcdf;
    uint64_t dimensions;
    char name[NAME];
    TRY(take_list(head, DIMENSION, MAX_DIMENSIONS, &dimensions));
    netcdf->dimensions = (size_t)dimensions;
    for (size_t k = 0; k < netcdf->dimensions; k++) {
        TRY(take_text(head, name));
        TRY(take_count(head, UINT32_MAX, &netcdf->dimension[k]));
    }
    return STATUS_OK;
}

/// Sizes of the dimensions, the first of which may be that of records.
static enum status take_shape(struct head *head, struct variable *variable) {
    const struct netcdf *const netcdf = head->netcdf;
    uint64_t rank, id;
    TRY(take_count(head, MAX_RANK, &rank));
    variable->bytes = 1;
    for (uint64_t k = 0; k < rank; k++) {
        TRY(take_count(head, netcdf->dimensions, &id));
        const uint64_t size = id < netcdf->dimensions ? netcdf->dimension[id] : 0;
        if (id == netcdf->dimensions || (size == 0 && k > 0) ||
            (size > 0 && variable->bytes > (UINT64_MAX >> 8) / size))
            return mf_source_fail_byte(&head->trajectory->source,
                                       "\"%s\" has a dimension that cannot be: it is damaged",
                                       variable->name);
        variable->timed = variable->timed || size == 0;
        if (size > 0) {
            variable->size[variable->rank++] = size;
            variable->bytes *= size;
        }
    }
    return STATUS_OK;
}

static enum status take_variable(struct head *head, struct variable *variable) {
    uint64_t type, size;
    *variable = (struct variable){.factor = 1};
    TRY(take_text(head, variable->name));
    TRY(take_shape(head, variable));
    TRY(take_attributes(head, variable));
    TRY(take_number(head, false, &type));
    TRY(take_count(head, UINT64_MAX, &size)); // which is wrong for large ones
    TRY(take_number(head, head->netcdf->version != 1, &variable->begin));
    variable->type = (int)type;
    variable->bytes *= bytes_of(type);
    if (bytes_of(type) == 0 || variable->begin > UINT64_MAX >> 8)
        return mf_source_fail_byte(&head->trajectory->source,
                                   "\"%s\" has no type or place that can be: it is damaged",
                                   variable->name);
    return STATUS_OK;
}

static bool is_of_role(const struct variable *variable, enum role role) {
    return strcmp(variable->name, roles[role].name) == 0 && variable->rank == roles[role].rank &&
           (roles[role].last == 0 || variable->rank == 0 ||
            variable->size[variable->rank - 1] == roles[role].last) &&
           (variable->type == FLOAT || variable->type == DOUBLE ||
            (role == ID && variable->type == INTEGER));
}

/// Find what is of use. Records are all variables of each frame, one after the other; without
/// records, the frame is all that there is.
static enum status take_variables(struct head *head) {
    struct netcdf *const netcdf = head->netcdf;
    struct variable variable;
    uint64_t variables, begin[2] = {UINT64_MAX, UINT64_MAX}, bytes = 0, end = 0;
    TRY(take_list(head, VARIABLE, MAX_VARIABLES, &variables));
    for (uint64_t k = 0; k < variables; k++) {
        TRY(take_variable(head, &variable));
        bytes += variable.timed ? (variable.bytes + 3) / 4 * 4 : 0;
        if (variable.begin < begin[variable.timed])
            begin[variable.timed] = variable.begin;
        if (!variable.timed && variable.begin + variable.bytes > end)
            end = variable.begin + variable.bytes;
        for (int role = 0; role < ROLES; role++)
            if (is_of_role(&variable, role))
                netcdf->of[role] = variable;
    }
    const bool timed = netcdf->of[COORDINATES].timed;
    netcdf->begin = begin[timed];
    netcdf->bytes = timed ? bytes : end - begin[false];
    netcdf->records = timed ? netcdf->records : 1;
    return STATUS_OK;
}

// What it is of -----------------------------------------------------------------------------------

static enum status fail(const struct head *head, enum role role, const char *what) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: \"%s\" %s", head->trajectory->file,
                          roles[role].name, what);
}

/// The unit of a variable, which is Amber's if it has none.
static enum status find_unit(const struct head *head, enum role role, double *unit) {
    static const struct {
        const char *name;
        double unit[ROLES]; ///< 0: not for this one
    } known[] = {{"angstrom", {[COORDINATES] = 0.1, [LENGTHS] = 0.1}},
                 {"nanometer", {[COORDINATES] = 1, [LENGTHS] = 1}},
                 {"picosecond", {[TIME] = 1}},
                 {"femtosecond", {[TIME] = 1e-3}},
                 {"nanosecond", {[TIME] = 1e3}},
                 {"degree", {[ANGLES] = 1}},
                 {"angstrom/picosecond", {[VELOCITIES] = 0.1}},
                 {"angstrom/femtosecond", {[VELOCITIES] = 100}},
                 {"nanometer/picosecond", {[VELOCITIES] = 1}}};
    static const double usual[ROLES] = {1, 0.1, 0.1, 0.1, 1, 1};
    const struct variable *const variable = &head->netcdf->of[role];
    const struct word word = {variable->unit, strlen(variable->unit)};
    *unit = variable->unit[0] == '\0' || role == ID ? usual[role] : 0;
    for (size_t k = 0; *unit == 0 && k < sizeof known / sizeof *known; k++)
        if (mf_words_alike(&word, known[k].name) ||
            (word.length > 0 && word.begin[word.length - 1] == 's' &&
             mf_words_alike(&(struct word){word.begin, word.length - 1}, known[k].name)))
            *unit = known[k].unit[role];
    *unit *= variable->factor;
    if (*unit != 0 && isfinite(*unit))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: \"%s\" is in \"%s\": angstrom, nanometer, picosecond and degree "
                          "are known",
                          head->trajectory->file, roles[role].name, variable->unit);
}

/// What is not of each frame, or not of its atoms, is not there; all else stands within a frame.
static enum status check(struct head *head) {
    struct netcdf *const netcdf = head->netcdf;
    const struct variable *const coordinates = &netcdf->of[COORDINATES];
    if (coordinates->name[0] == '\0')
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: NetCDF, but not of Amber's conventions: it has no "
                              "\"coordinates\" of atoms",
                              head->trajectory->file);
    for (int role = 0; role < ROLES; role++) {
        struct variable *const variable = &netcdf->of[role];
        if (variable->name[0] == '\0' || variable->timed != coordinates->timed) {
            variable->name[0] = '\0';
            continue;
        }
        if (variable->begin < netcdf->begin ||
            variable->begin - netcdf->begin + variable->bytes > netcdf->bytes)
            return fail(head, role, "is not within a frame: the file is damaged");
        if ((role == VELOCITIES || role == ID) && variable->size[0] != coordinates->size[0])
            return fail(head, role, "is of another number of atoms than \"coordinates\"");
        TRY(find_unit(head, role, &netcdf->unit[role]));
    }
    if (netcdf->records == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file has no frame",
                              head->trajectory->file);
    if (netcdf->records < UINT32_MAX) // what is written still may not know
        head->trajectory->frames = netcdf->records;
    return STATUS_OK;
}

static enum status read_head(struct head *head) {
    struct variable ignored = {0};
    TRY(take(head, 4));
    head->netcdf->version = head->raw.data[3];
    TRY(take_count(head, UINT64_MAX, &head->netcdf->records));
    TRY(take_dimensions(head));
    TRY(take_attributes(head, &ignored));
    TRY(take_variables(head));
    TRY(check(head));
    const struct source *const source = &head->trajectory->source;
    if (head->netcdf->begin < source->byte)
        return mf_source_fail_byte(source, "frames begin within the header: it is damaged");
    return take(head, head->netcdf->begin - source->byte);
}

static enum status open_file(struct trajectory *trajectory) {
    struct head head = {.trajectory = trajectory, .netcdf = trajectory->state};
    const enum status status = read_head(&head);
    mf_source_free(&head.raw);
    return status;
}

// Frames ------------------------------------------------------------------------------------------

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    const struct netcdf *const netcdf = trajectory->state;
    (void)more;
    return mf_source_take(&trajectory->source, &frame->raw, netcdf->bytes);
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct netcdf *const netcdf = trajectory->state;
    (void)first;
    return mf_structure_init(&trajectory->structure, (size_t)netcdf->of[COORDINATES].size[0]);
}

/// Number `k` of a variable in nm, ps and degrees; NAN if it is not there.
static double number(const struct netcdf *netcdf, const struct trajectory_frame *frame,
                     enum role role, size_t k) {
    const struct variable *const variable = &netcdf->of[role];
    if (variable->name[0] == '\0')
        return NAN;
    const unsigned char *const at = frame->raw.data + (variable->begin - netcdf->begin);
    return netcdf->unit[role] *
           (variable->type == INTEGER
                ? binary_int(at + 4 * k, true)
                : binary_real(at, k, bytes_of((unsigned)variable->type), true));
}

/// LAMMPS writes atoms with their ids: in the order of these, they are the same in each frame.
static enum status check_ids(const struct netcdf *netcdf, const struct trajectory_frame *frame) {
    for (size_t k = 1; netcdf->of[ID].name[0] && k < frame->atoms; k++)
        if (!(number(netcdf, frame, ID, k) > number(netcdf, frame, ID, k - 1)))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: atoms are not in the order of their ids: write "
                                  "it with \"dump_modify sort id\"",
                                  frame->file, frame->number);
    return STATUS_OK;
}

/// A box is endless along a length of 0.
static enum status read_box(const struct netcdf *netcdf, struct trajectory_frame *frame) {
    const double none[3][3] = {{0}};
    double length[3], angle[3];
    mf_frame_set_box(frame, none);
    for (size_t k = 0; k < 3; k++) {
        length[k] = number(netcdf, frame, LENGTHS, k);
        angle[k] = number(netcdf, frame, ANGLES, k);
        angle[k] = isnan(angle[k]) && netcdf->of[ANGLES].name[0] == '\0' ? 90 : angle[k];
    }
    if (netcdf->of[LENGTHS].name[0] == '\0' || (length[0] == 0 && length[1] == 0 && length[2] == 0))
        return STATUS_OK;
    bool periodic[3];
    for (int k = 0; k < 3; k++) {
        periodic[k] = length[k] != 0;
        length[k] = periodic[k] ? length[k] : 1; // any
    }
    if (!mf_frame_box_of_angles(frame, length, angle))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu: not a valid box: lengths %g %g %g nm, angles %g %g "
                              "%g",
                              frame->file, frame->number, length[0], length[1], length[2], angle[0],
                              angle[1], angle[2]);
    memcpy(frame->periodic, periodic, sizeof periodic);
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const struct netcdf *const netcdf = trajectory->state;
    const size_t atoms = trajectory->structure.atoms;
    frame->time = number(netcdf, frame, TIME, 0);
    TRY(mf_frame_reserve(frame, atoms, netcdf->of[VELOCITIES].name[0] != '\0'));
    TRY(read_box(netcdf, frame));
    TRY(check_ids(netcdf, frame));
    for (size_t k = 0; k < 3 * atoms; k++) {
        frame->position[k / 3][k % 3] = number(netcdf, frame, COORDINATES, k);
        if (frame->has_velocities)
            frame->velocity[k / 3][k % 3] = number(netcdf, frame, VELOCITIES, k);
        if (!isfinite(frame->position[k / 3][k % 3]) ||
            (frame->has_velocities && !isfinite(frame->velocity[k / 3][k % 3])))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: position or velocity of atom %zu is not finite",
                                  frame->file, frame->number, k / 3 + 1);
    }
    return STATUS_OK;
}

static const char *const extensions[] = {"nc", "ncdf", "ncrst", NULL};

const struct trajectory_format mf_format_netcdf = {
    .name = "netcdf",
    .extensions = extensions,
    .summary = "Amber, NetCDF-3: trajectories and restarts, velocities, boxes of any angles",
    .unit_source = TRAJECTORY_OWN_UNITS,
    .state_size = sizeof(struct netcdf),
    .recognise = recognise,
    .open = open_file,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
