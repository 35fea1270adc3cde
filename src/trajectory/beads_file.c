// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/beads_file.h"

#include "base/memory.h"
#include "io/xtc.h"
#include "trajectory/beads_gsd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct beads_format {
    const char *extension; ///< with its point
    enum status (*print)(struct beads_file *file, const struct trajectory_frame *beads);
    void (*finish)(struct beads_file *file); ///< after the last frame, or NULL
};

/// Å in a nm, fs in a ps, and Å/fs in a nm/ps.
static const double angstrom = 10, femtosecond = 1e3, angstrom_per_femtosecond = 1e-2;

static const char *type_name(const struct beads_file *file, size_t bead) {
    return file->mapping->type_name[file->mapping->bead[bead].type];
}

/// Whether all masses are known.
static bool has_masses(const struct mapping *mapping) {
    for (size_t k = 0; k < mapping->beads; k++)
        if (!isfinite(mapping->bead[k].mass))
            return false;
    return true;
}

/// In a file of LAMMPS steps are numbers that grow: those of the simulation, or of frames.
static long long step_of(const struct beads_file *file, const struct trajectory_frame *beads) {
    return beads->step >= 0 ? (long long)beads->step : (long long)file->frames;
}

static void print_scaled(FILE *stream, const double vector[3], double scale) {
    for (int d = 0; d < 3; d++)
        fprintf(stream, " %.9g", vector[d] * scale);
}

// GRO (manual of GROMACS, file formats) -----------------------------------------------------------

/// Decimals of positions; velocities have one more.
enum { DECIMALS = 6, WIDTH = DECIMALS + 5 };

static void print_gro_box(FILE *stream, const double box[3][3]) {
    static const int rest[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
    bool tilted = false;
    for (int k = 0; k < 6; k++)
        tilted = tilted || box[rest[k][0]][rest[k][1]] != 0;
    for (int d = 0; d < 3; d++)
        fprintf(stream, " %.9f", box[d][d]);
    for (int k = 0; tilted && k < 6; k++)
        fprintf(stream, " %.9f", box[rest[k][0]][rest[k][1]]);
    fprintf(stream, "\n");
}

static enum status print_gro(struct beads_file *file, const struct trajectory_frame *beads) {
    enum { MAX_NUMBER = 100000 }; // of five digits
    static const double farthest = 999;
    FILE *const stream = file->output.stream;
    fprintf(stream, "beads by mesofit");
    if (!isnan(beads->time))
        fprintf(stream, ", t= %.9g", beads->time);
    if (beads->step >= 0)
        fprintf(stream, " step= %lld", (long long)beads->step);
    fprintf(stream, "\n%zu\n", beads->atoms);
    for (size_t n = 0; n < beads->atoms; n++) {
        const size_t k = file->order[n];
        const struct mapping_bead *const bead = &file->mapping->bead[k];
        const char *const residue =
            file->structure->atom[file->mapping->atom[bead->first]].residue_name;
        const double *const x = beads->position[k], *const v = beads->velocity[k];
        if (!(fmax(fmax(fabs(x[0]), fabs(x[1])), fabs(x[2])) < farthest))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: a bead is more than %g nm away, and .gro has no "
                                  "room for that: --beads takes .xyz or .lammpstrj, too",
                                  beads->file, beads->number, farthest);
        fprintf(stream, "%5zu%-5.5s%5.5s%5zu", (bead->molecule + 1) % MAX_NUMBER,
                residue[0] ? residue : type_name(file, k), type_name(file, k),
                (n + 1) % MAX_NUMBER);
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%*.*f", WIDTH, DECIMALS, x[d]);
        for (int d = 0; beads->has_velocities && d < 3; d++)
            fprintf(stream, "%*.*f", WIDTH, DECIMALS + 1, v[d]);
        fprintf(stream, "\n");
    }
    print_gro_box(stream, beads->box);
    return STATUS_OK;
}

// Extended XYZ (github.com/libAtoms/extxyz) -------------------------------------------------------

static void print_xyz_heading(const struct beads_file *file, const struct trajectory_frame *beads,
                              bool masses) {
    FILE *const stream = file->output.stream;
    const double *const box = beads->box[0];
    fprintf(stream, "%zu\n", beads->atoms);
    if (beads->has_box) {
        fprintf(stream, "Lattice=\"");
        for (int k = 0; k < 9; k++)
            fprintf(stream, k ? " %.9g" : "%.9g", box[k] * angstrom);
        fprintf(stream, "\" ");
    }
    fprintf(stream, "pbc=\"%c %c %c\" Units=real ", beads->periodic[0] ? 'T' : 'F',
            beads->periodic[1] ? 'T' : 'F', beads->periodic[2] ? 'T' : 'F');
    if (!isnan(beads->time))
        fprintf(stream, "Time=%.9g ", beads->time * femtosecond);
    if (beads->step >= 0)
        fprintf(stream, "Step=%lld ", (long long)beads->step);
    fprintf(stream, "Properties=species:S:1:pos:R:3%s%s:molecule:I:1\n",
            beads->has_velocities ? ":velo:R:3" : "", masses ? ":masses:R:1" : "");
}

static enum status print_xyz(struct beads_file *file, const struct trajectory_frame *beads) {
    const bool masses = has_masses(file->mapping);
    FILE *const stream = file->output.stream;
    print_xyz_heading(file, beads, masses);
    for (size_t n = 0; n < beads->atoms; n++) {
        const size_t k = file->order[n];
        fputs(type_name(file, k), stream);
        print_scaled(stream, beads->position[k], angstrom);
        if (beads->has_velocities)
            print_scaled(stream, beads->velocity[k], angstrom_per_femtosecond);
        if (masses)
            fprintf(stream, " %.9g", file->mapping->bead[k].mass);
        fprintf(stream, " %zu\n", file->mapping->bead[k].molecule + 1);
    }
    return STATUS_OK;
}

// A dump of LAMMPS (manual, command `dump`), its units and times as lammps_dump.h says ------------

/// Bounds of a tilted box are those of the upright one around it.
static enum status print_lammps_box(FILE *stream, const struct trajectory_frame *beads) {
    const double(*const box)[3] = (const double(*)[3])beads->box;
    const double xy = box[1][0], xz = box[2][0], yz = box[2][1];
    const double low[3] = {fmin(fmin(0, xy), fmin(xz, xy + xz)), fmin(0, yz), 0};
    const double high[3] = {fmax(fmax(0, xy), fmax(xz, xy + xz)), fmax(0, yz), 0};
    const double tilt[3] = {xy, xz, yz};
    const bool tilted = xy != 0 || xz != 0 || yz != 0;
    if (box[0][1] != 0 || box[0][2] != 0 || box[1][2] != 0)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: frame %zu: a dump has boxes with a along x and b in the plane of "
            "x and y: --beads takes .xyz or .gro, too",
            beads->file, beads->number);
    fprintf(stream, "ITEM: BOX BOUNDS%s", tilted ? " xy xz yz" : "");
    for (int d = 0; d < 3; d++)
        fprintf(stream, beads->periodic[d] ? " pp" : " ff");
    for (int d = 0; d < 3; d++) {
        fprintf(stream, "\n%.9g %.9g", low[d] * angstrom, (box[d][d] + high[d]) * angstrom);
        if (tilted)
            fprintf(stream, " %.9g", tilt[d] * angstrom);
    }
    fprintf(stream, "\n");
    return STATUS_OK;
}

static enum status print_lammps(struct beads_file *file, const struct trajectory_frame *beads) {
    const bool masses = has_masses(file->mapping);
    FILE *const stream = file->output.stream;
    fprintf(stream, "ITEM: TIMESTEP\n%lld\nITEM: NUMBER OF ATOMS", step_of(file, beads));
    if (!isnan(beads->time))
        fprintf(stream, " time=%.9g", beads->time * femtosecond);
    fprintf(stream, " units=real\n%zu\n", beads->atoms);
    TRY(print_lammps_box(stream, beads));
    fprintf(stream, "ITEM: ATOMS id mol type element%s%s%s\n", masses ? " mass" : "",
            beads->unwrapped ? " xu yu zu" : " x y z", beads->has_velocities ? " vx vy vz" : "");
    for (size_t n = 0; n < beads->atoms; n++) {
        const size_t k = file->order[n];
        const struct mapping_bead *const bead = &file->mapping->bead[k];
        fprintf(stream, "%zu %zu %zu %s", n + 1, bead->molecule + 1, bead->type + 1,
                type_name(file, k));
        if (masses)
            fprintf(stream, " %.9g", bead->mass);
        print_scaled(stream, beads->position[k], angstrom);
        if (beads->has_velocities)
            print_scaled(stream, beads->velocity[k], angstrom_per_femtosecond);
        fprintf(stream, "\n");
    }
    return STATUS_OK;
}

// XTC ---------------------------------------------------------------------------------------------

static void place_bead(const void *context, size_t n, double position[3]) {
    const struct beads_file *const file = context;
    memcpy(position, file->beads->position[file->order[n]], 3 * sizeof *position);
}

static enum status print_xtc(struct beads_file *file, const struct trajectory_frame *beads) {
    struct xtc_frame frame = {.atoms = beads->atoms,
                              .step = step_of(file, beads),
                              .time = isnan(beads->time) ? (double)file->frames : beads->time,
                              .place = place_bead,
                              .context = file};
    memcpy(frame.box, beads->box, sizeof frame.box);
    for (size_t n = 0; n < beads->atoms; n++)
        for (int d = 0; d < 3; d++)
            if (!(fabs(beads->position[n][d]) < XTC_FARTHEST))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: frame %zu: a bead is more than %g nm away, and .xtc has "
                                      "no room for that: --beads takes .xyz or .lammpstrj, too",
                                      beads->file, beads->number, XTC_FARTHEST);
    file->beads = beads;
    mf_xtc_write(&frame, file->output.stream);
    return STATUS_OK;
}

// The file ----------------------------------------------------------------------------------------

static const struct beads_format formats[] = {
    {".gro", print_gro, NULL},           {".xyz", print_xyz, NULL},
    {".extxyz", print_xyz, NULL},        {".lammpstrj", print_lammps, NULL},
    {".lammpsdump", print_lammps, NULL}, {".dump", print_lammps, NULL},
    {".xtc", print_xtc, NULL},           {".gsd", mf_beads_gsd_print, mf_beads_gsd_finish},
};

static enum status find_format(struct beads_file *file, const char *path) {
    const char *const point = strrchr(path, '.');
    for (size_t k = 0; point && k < sizeof formats / sizeof *formats; k++)
        if (strcasecmp(point, formats[k].extension) == 0)
            file->format = &formats[k];
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
    if (file->format->finish)
        file->format->finish(file);
    return mf_output_commit(&file->output);
}

void mf_beads_file_clear(struct beads_file *file) {
    if (file->format)
        mf_output_abandon(&file->output);
    mf_memory_free(file->order);
    *file = (struct beads_file){0};
}
