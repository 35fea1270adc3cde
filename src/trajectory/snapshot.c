// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/snapshot.h"

#include "base/memory.h"
#include "io/tracked_files.h"
#include "system/attributes.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const struct snapshot_format *const mf_snapshot_formats[] = {&mf_snapshot_vtp,
                                                             &mf_snapshot_json,
                                                             &mf_snapshot_xyz,
                                                             &mf_format_lammps_dump_snapshot,
                                                             &mf_gsd_snapshot,
                                                             &mf_format_xtc_snapshot,
                                                             NULL};
const char *const mf_snapshot_format_names[] = {"vtp", "json", "extxyz", "lammps-dump",
                                                "gsd", "xtc",  NULL};
_Static_assert(sizeof mf_snapshot_formats / sizeof *mf_snapshot_formats == SNAPSHOT_FORMATS + 1 &&
                   sizeof mf_snapshot_format_names == sizeof mf_snapshot_formats,
               "every format has a name");

// Taking ------------------------------------------------------------------------------------------

/// A new column with room for its numbers, which are the next of `memory`.
static double *add_column(struct snapshot *snapshot, const char *name, int components, bool vector,
                          bool whole, size_t *used) {
    struct snapshot_column *column = &snapshot->column[snapshot->columns++];
    double *values = snapshot->memory + *used;
    *column = (struct snapshot_column){
        .components = components, .vector = vector, .whole = whole, .values = values};
    snprintf(column->name, sizeof column->name, "%.*s", (int)strcspn(name, "["), name);
    *used += (size_t)components * snapshot->count;
    return values;
}

static void copy_axes(struct snapshot *snapshot, const struct particles *particles,
                      const char *name, double *const *axes, size_t *used) {
    double *to = add_column(snapshot, name, snapshot->box.dimensions, true, false, used);
    for (int d = 0; d < snapshot->box.dimensions; d++, to += snapshot->count)
        for (size_t k = 0; k < snapshot->own; k++)
            to[particles->id[k]] = axes[d][k];
}

/// A coordinate in the box.
/// @param[out] boxes  how many boxes away from it the coordinate was
static double wrap(double x, double length, double *boxes) {
    *boxes = floor(x / length);
    const double inside = x - *boxes * length;
    if (inside < length)
        return inside;
    *boxes += 1;
    return 0;
}

/// Positions in the box, and how many boxes away from it their particles are.
static void copy_places(struct snapshot *snapshot, const struct particles *particles,
                        size_t *used) {
    const int dimensions = snapshot->box.dimensions;
    double *position = add_column(snapshot, "position", dimensions, true, false, used);
    double *image = add_column(snapshot, "image", dimensions, true, true, used);
    for (int d = 0; d < dimensions; d++)
        for (size_t k = 0; k < snapshot->own; k++) {
            const size_t place = (size_t)d * snapshot->count + particles->id[k];
            double boxes;
            position[place] = wrap(particles->position[d][k], snapshot->box.length[d], &boxes);
            image[place] = particles->image[d][k] + boxes;
        }
}

static void copy_attribute(struct snapshot *snapshot, const struct particles *particles,
                           const struct particles_attribute *attribute, size_t *used) {
    double *to = add_column(snapshot, attribute->name, attribute->components,
                            attribute->components == snapshot->box.dimensions,
                            attribute->type == PARTICLES_WORD, used);
    for (int c = 0; c < attribute->components; c++, to += snapshot->count)
        for (size_t k = 0; k < snapshot->own; k++) {
            const void *value = attribute->value[c];
            to[particles->id[k]] = attribute->type == PARTICLES_DOUBLE ? ((const double *)value)[k]
                                   : attribute->type == PARTICLES_FLOAT
                                       ? (double)((const float *)value)[k]
                                       : (double)((const uint32_t *)value)[k];
        }
}

static void copy_molecules(struct snapshot *snapshot, const struct topology *topology,
                           size_t *used) {
    double *to = add_column(snapshot, "molecule", 1, false, true, used);
    for (size_t id = 0; id < snapshot->own; id++)
        to[id] = (double)topology->molecule[id] + 1;
}

/// After the others, into the columns that are about them.
static void copy_solvent_particles(struct snapshot *snapshot,
                                   const struct snapshot_solvent_particles *solvent_particles) {
    for (int n = 0; n < snapshot->columns; n++) {
        struct snapshot_column *column = &snapshot->column[n];
        double *to = snapshot->memory + (column->values - snapshot->memory) + snapshot->own;
        const bool position = strcmp(column->name, "position") == 0;
        const bool velocity = strcmp(column->name, "velocity") == 0;
        const bool mass = strcmp(column->name, "mass") == 0;
        column->shared = position || velocity || mass;
        for (int c = 0; c < column->components; c++, to += snapshot->count)
            for (size_t k = 0; k < solvent_particles->count; k++) {
                double boxes;
                if (position)
                    to[k] =
                        wrap(solvent_particles->position[c][k], snapshot->box.length[c], &boxes);
                else if (velocity)
                    to[k] = solvent_particles->velocity[c][k];
                else if (mass)
                    to[k] = solvent_particles->mass;
            }
    }
}

enum status mf_snapshot_take(struct snapshot *snapshot, const struct particles *particles,
                             const struct composition *composition,
                             const struct snapshot_solvent_particles *solvent_particles,
                             uint64_t step, double time) {
    size_t components = 4 * (size_t)particles->box.dimensions, used = 0;
    *snapshot = (struct snapshot){
        .count = particles->count + (solvent_particles ? solvent_particles->count : 0),
        .own = particles->count,
        .solvent_particles = solvent_particles ? solvent_particles->name : NULL,
        .box = particles->box,
        .composition = composition,
        .topology = particles->topology,
        .step = step,
        .time = time,
        .mass = 1,
        .solvent_mass = solvent_particles ? solvent_particles->mass : 1};
    for (int k = 0; k < particles->attributes; k++)
        components += (size_t)particles->attribute[k].components;
    components += particles->topology != NULL;
    snapshot->numbers = components * snapshot->count;
    snapshot->memory = mf_memory_zeroed(snapshot->numbers, sizeof(double));
    if (snapshot->memory == NULL)
        return STATUS_NO_MEMORY;
    copy_places(snapshot, particles, &used);
    copy_axes(snapshot, particles, "velocity", particles->velocity, &used);
    copy_axes(snapshot, particles, "force", particles->force, &used);
    for (int k = 0; k < particles->attributes; k++)
        copy_attribute(snapshot, particles, &particles->attribute[k], &used);
    if (particles->topology)
        copy_molecules(snapshot, particles->topology, &used);
    if (solvent_particles)
        copy_solvent_particles(snapshot, solvent_particles);
    return STATUS_OK;
}

void mf_snapshot_clear(struct snapshot *snapshot) {
    mf_memory_free(snapshot->memory);
    *snapshot = (struct snapshot){0};
}

// Names and units ---------------------------------------------------------------------------------

const struct snapshot_column *mf_snapshot_find(const struct snapshot *snapshot, const char *name) {
    for (int n = 0; n < snapshot->columns; n++)
        if (strcmp(snapshot->column[n].name, name) == 0)
            return &snapshot->column[n];
    return NULL;
}

double mf_snapshot_mass(const struct snapshot *snapshot, size_t particle) {
    const struct snapshot_column *const column = mf_snapshot_find(snapshot, "mass");
    if (column)
        return column->values[particle];
    return particle < snapshot->own ? snapshot->mass : snapshot->solvent_mass;
}

bool mf_snapshot_has_common_mass(const struct snapshot *snapshot) {
    return !isnan(snapshot->mass) && mf_snapshot_find(snapshot, "mass") == NULL;
}

bool mf_snapshot_has_masses(const struct snapshot *snapshot) {
    return mf_snapshot_has_common_mass(snapshot) || mf_snapshot_find(snapshot, "mass");
}

void mf_snapshot_component_name(const struct snapshot_column *column, int component,
                                char name[SNAPSHOT_NAME_SIZE]) {
    if (strcmp(column->name, "position") == 0)
        snprintf(name, SNAPSHOT_NAME_SIZE, "%c", "xyz"[component]);
    else if (column->components == 1)
        snprintf(name, SNAPSHOT_NAME_SIZE, "%s", column->name);
    else if (column->vector)
        snprintf(name, SNAPSHOT_NAME_SIZE, "%s_%c", column->name, "xyz"[component]);
    else
        snprintf(name, SNAPSHOT_NAME_SIZE, "%s_%d", column->name, component);
}

int mf_snapshot_type(const struct snapshot *snapshot, size_t particle) {
    const struct composition *composition = snapshot->composition;
    if (particle < snapshot->own)
        return mf_composition_type(composition, (uint32_t)particle);
    return composition_is_mixed(composition) ? composition->types : 1;
}

const char *mf_snapshot_type_name(const struct snapshot *snapshot, size_t particle) {
    if (particle >= snapshot->own)
        return snapshot->solvent_particles;
    return composition_is_mixed(snapshot->composition)
               ? snapshot->composition->name[mf_snapshot_type(snapshot, particle)]
               : "A";
}

const char *mf_snapshot_unit(const struct snapshot_column *column) {
    static const char *const known[][2] = {
        {"position", "lambda"}, {"velocity", "lambda/tau"}, {"force", "k_B T_0/lambda"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(column->name, known[k][0]) == 0)
            return known[k][1];
    for (const struct field *field = mf_attributes_fields; field->name; field++)
        if (strcmp(column->name, field->name) == 0)
            return field->unit;
    return "";
}

static const char *name_units(const struct units *units) {
    if (!mf_units_are_physical(units))
        return "lj";
    return units->system == UNITS_NM_PS ? "nm-ps" : "real";
}

enum status mf_snapshot_translate(struct snapshot *converted, const struct snapshot *from,
                                  const struct units *of_scene, bool angstrom) {
    struct units real = of_scene ? *of_scene : (struct units){0};
    const struct units *units = of_scene;
    if (angstrom && mf_units_known(&real)) {
        real.system = UNITS_ANGSTROM_FS;
        units = &real;
    }
    mf_snapshot_clear(converted);
    *converted = *from;
    converted->memory = mf_memory_zeroed(from->numbers, sizeof(double));
    if (converted->memory == NULL) {
        *converted = (struct snapshot){0};
        return STATUS_NO_MEMORY;
    }
    converted->units = name_units(units);
    const double mass = units && units->massless ? NAN : mf_units_factor(units, "mu");
    converted->mass = from->mass * mass;
    converted->solvent_mass = from->solvent_mass * mass;
    converted->time = mf_units_file_value(from->time, mf_units_factor(units, "tau"));
    for (int d = 0; d < from->box.dimensions; d++)
        converted->box.length[d] =
            mf_units_file_value(from->box.length[d], mf_units_factor(units, "lambda"));
    for (int n = 0; n < from->columns; n++) {
        const struct snapshot_column *column = &from->column[n];
        const double factor = mf_units_factor(units, mf_snapshot_unit(column));
        const size_t numbers = (size_t)column->components * from->count;
        double *values = converted->memory + (column->values - from->memory);
        for (size_t k = 0; k < numbers; k++)
            values[k] = column->values[k] * factor;
        converted->column[n].values = values;
    }
    return STATUS_OK;
}

// Writing -----------------------------------------------------------------------------------------

static enum status write_whole(const struct snapshot *snapshot,
                               const struct snapshot_format *format, const char *path) {
    struct output output;
    TRY(mf_output_open_later(&output, path));
    format->print(snapshot, output.stream);
    return mf_output_commit(&output);
}

/// Print after the first `size` bytes of a file, or leave it at these.
static int print_at(const struct snapshot *snapshot, const struct snapshot_format *format, int file,
                    bool frame, int64_t size, int64_t *end) {
    struct stat found;
    if (fstat(file, &found) != 0 || ftruncate(file, size) != 0)
        return errno;
    FILE *stream = fdopen(dup(file), "wb");
    if (stream == NULL)
        return errno;
    if (format->cut && found.st_size > size)
        format->cut(snapshot, snapshot->number, stream);
    if (fseeko(stream, size, SEEK_SET) != 0) {
        const int error = errno;
        fclose(stream);
        return error;
    }
    if (frame)
        format->print(snapshot, stream);
    *end = ftello(stream);
    errno = 0;
    const int error = fflush(stream) != 0 || ferror(stream) ? (errno ? errno : EIO) : 0;
    fclose(stream);
    return error;
}

static int append(const struct snapshot *snapshot, const struct snapshot_format *format, int file,
                  int64_t *size) {
    int64_t end = *size;
    const int error = print_at(snapshot, format, file, true, *size, &end);
    mf_output_leave_for_later();
    if (error == 0)
        *size = end;
    else // what was there before is what counts
        print_at(snapshot, format, file, false, *size, &end);
    return error;
}

static enum status write_appended(const struct snapshot *snapshot,
                                  const struct snapshot_format *format, const char *path,
                                  int64_t *size) {
    TRY(mf_tracked_files_claim(path, true));
    const int file = open(path, O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    const int error = file < 0 ? errno : append(snapshot, format, file, size);
    if (file >= 0)
        close(file);
    if (error == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "cannot write %s: %s", path, strerror(error));
}

enum status mf_snapshot_write(const struct snapshot *snapshot, const struct snapshot_format *format,
                              const char *folder, int64_t *size) {
    char path[OUTPUT_PATH_SIZE];
    TRY(mf_output_make_folder(folder));
    if (format->appended) {
        snprintf(path, sizeof path, "%.*s/trajectory.%s", OUTPUT_PATH_SIZE - 64, folder,
                 format->suffix);
        return write_appended(snapshot, format, path, size);
    }
    snprintf(path, sizeof path, "%.*s/step_%09llu.%s", OUTPUT_PATH_SIZE - 64, folder,
             (unsigned long long)snapshot->step, format->suffix);
    return write_whole(snapshot, format, path);
}
