// SPDX-License-Identifier: GPL-3.0-or-later
//
// GSD of HOOMD-blue, as OVITO, VMD and MDAnalysis read it (gsd.readthedocs.io: file layer 2.0,
// schema hoomd 1.4), one frame a file: head, numbers of each chunk, index, names, all
// little-endian. The box is centred at 0. It says no units: its numbers are those of all snapshots.
#include "io/gsd.h"
#include "io/snapshot.h"
#include "system/topology.h"

#include <string.h>

/// What a chunk is made of, in the order of `chunks`.
enum chunk {
    STEP,
    DIMENSIONS,
    BOX,
    COUNT,
    TYPES,
    TYPE,
    MASS,
    POSITION,
    VELOCITY,
    IMAGE,
    BONDS,
    BOND_TYPES,
    BOND_TYPE,
    BOND,
    CHUNKS
};

static const struct {
    const char *name;
    unsigned char type, bytes; ///< of a number
    unsigned columns;
} chunks[CHUNKS] = {
    [STEP] = {"configuration/step", GSD_UINT64, 8, 1},
    [DIMENSIONS] = {"configuration/dimensions", GSD_UINT8, 1, 1},
    [BOX] = {"configuration/box", GSD_FLOAT, 4, 1},
    [COUNT] = {"particles/N", GSD_UINT32, 4, 1},
    [TYPES] = {"particles/types", GSD_INT8, 1, GSD_NAME},
    [TYPE] = {"particles/typeid", GSD_UINT32, 4, 1},
    [MASS] = {"particles/mass", GSD_FLOAT, 4, 1},
    [POSITION] = {"particles/position", GSD_FLOAT, 4, 3},
    [VELOCITY] = {"particles/velocity", GSD_FLOAT, 4, 3},
    [IMAGE] = {"particles/image", GSD_INT32, 4, 3},
    [BONDS] = {"bonds/N", GSD_UINT32, 4, 1},
    [BOND_TYPES] = {"bonds/types", GSD_INT8, 1, GSD_NAME},
    [BOND_TYPE] = {"bonds/typeid", GSD_UINT32, 4, 1},
    [BOND] = {"bonds/group", GSD_UINT32, 4, 2},
};

// Numbers -----------------------------------------------------------------------------------------

static void put(FILE *stream, uint64_t bits, int bytes) {
    for (int k = 0; k < bytes; k++)
        putc((int)(bits >> 8 * k & 0xff), stream);
}

static void put_float(FILE *stream, double number) {
    const float value = (float)number;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(stream, bits, sizeof bits);
}

static void put_text(FILE *stream, const char *text, size_t width) {
    for (size_t k = 0, length = strlen(text); k < width; k++)
        putc(k < length ? text[k] : '\0', stream);
}

// What a snapshot has -----------------------------------------------------------------------------

static const struct snapshot_column *find(const struct snapshot *snapshot, const char *name) {
    for (int n = 0; n < snapshot->columns; n++)
        if (strcmp(snapshot->column[n].name, name) == 0)
            return &snapshot->column[n];
    return NULL;
}

static size_t count_bonds(const struct topology *topology) {
    size_t bonds = 0;
    for (int k = 0; topology && k < topology->kinds; k++)
        bonds += (size_t)topology->kind[k].count * (size_t)topology->kind[k].terms[BONDED_BOND];
    return bonds;
}

static int count_types(const struct snapshot *snapshot) {
    return snapshot->count > 0 ? mf_snapshot_type(snapshot, snapshot->count - 1) + 1 : 1;
}

/// 0: there is no such chunk.
static size_t rows_of(const struct snapshot *snapshot, enum chunk chunk) {
    const size_t bonds = count_bonds(snapshot->topology);
    switch (chunk) {
    case STEP:
    case DIMENSIONS:
    case COUNT:
        return 1;
    case BOX:
        return 6;
    case TYPES:
        return (size_t)count_types(snapshot);
    case MASS:
        return find(snapshot, "mass") ? snapshot->count : 0;
    case BONDS:
    case BOND_TYPES:
        return bonds > 0;
    case BOND_TYPE:
    case BOND:
        return bonds;
    default:
        return snapshot->count;
    }
}

/// Three components, of which the third is 0 in two dimensions; places are about the middle.
static void put_vector(const struct snapshot *snapshot, const char *name, FILE *stream) {
    const struct snapshot_column *const column = find(snapshot, name);
    const bool place = strcmp(name, "position") == 0;
    for (size_t k = 0; k < snapshot->count; k++)
        for (int d = 0; d < 3; d++) {
            const double value =
                d < column->components ? column->values[(size_t)d * snapshot->count + k] : 0;
            const double middle = place && d < column->components ? snapshot->box.length[d] / 2 : 0;
            if (column->whole)
                put(stream, (uint32_t)(int32_t)value, 4);
            else
                put_float(stream, value - middle);
        }
}

static void put_types(const struct snapshot *snapshot, FILE *stream) {
    for (int type = 0; type < count_types(snapshot); type++) {
        size_t k = 0;
        while (k < snapshot->count && mf_snapshot_type(snapshot, k) != type)
            k++;
        put_text(stream, k < snapshot->count ? mf_snapshot_type_name(snapshot, k) : "", GSD_NAME);
    }
}

static void put_bonds(const struct topology *topology, FILE *stream) {
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *const kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int t = 0; t < kind->terms[BONDED_BOND]; t++)
                for (int end = 0; end < 2; end++)
                    put(stream, topology_id(kind, m, kind->term[BONDED_BOND][t].bead[end]), 4);
    }
}

static void put_box(const struct box *box, FILE *stream) {
    for (int k = 0; k < 6; k++)
        put_float(stream, k < box->dimensions ? box->length[k] : k == 2 ? 1 : 0);
}

static void put_numbers(const struct snapshot *snapshot, enum chunk chunk, FILE *stream) {
    const size_t rows = rows_of(snapshot, chunk);
    if (chunk == STEP)
        put(stream, snapshot->step, 8);
    else if (chunk == DIMENSIONS)
        put(stream, (uint64_t)snapshot->box.dimensions, 1);
    else if (chunk == BOX)
        put_box(&snapshot->box, stream);
    else if (chunk == COUNT)
        put(stream, snapshot->count, 4);
    else if (chunk == TYPES)
        put_types(snapshot, stream);
    else if (chunk == POSITION || chunk == VELOCITY || chunk == IMAGE)
        put_vector(snapshot, strrchr(chunks[chunk].name, '/') + 1, stream);
    else if (chunk == BONDS)
        put(stream, count_bonds(snapshot->topology), 4);
    else if (chunk == BOND_TYPES)
        put_text(stream, "bond", GSD_NAME);
    else if (chunk == BOND)
        put_bonds(snapshot->topology, stream);
    else
        for (size_t k = 0; k < rows; k++)
            if (chunk == MASS)
                put_float(stream, find(snapshot, "mass")->values[k]);
            else
                put(stream, chunk == TYPE ? (uint64_t)mf_snapshot_type(snapshot, k) : 0, 4);
}

// The file ----------------------------------------------------------------------------------------

static size_t bytes_of(const struct snapshot *snapshot, enum chunk chunk) {
    return rows_of(snapshot, chunk) * chunks[chunk].columns * chunks[chunk].bytes;
}

static void print_head(uint64_t index, FILE *stream) {
    put(stream, 0x65DF65DF65DF65DF, 8);
    put(stream, index, 8);
    put(stream, CHUNKS, 8); // entries, of which those at the end may be empty
    put(stream, index + (uint64_t)CHUNKS * GSD_ENTRY, 8);
    put(stream, CHUNKS, 8); // names, of up to 64 bytes each
    put(stream, 1 << 16 | 4, 4);
    put(stream, 2 << 16, 4);
    put_text(stream, "mesofit", GSD_NAME);
    put_text(stream, "hoomd", GSD_NAME);
    put_text(stream, "", GSD_HEAD - 2 * GSD_NAME - 48);
}

static void print_entry(const struct snapshot *snapshot, int chunk, uint64_t at, int id,
                        FILE *stream) {
    put(stream, 0, 8); // the frame
    put(stream, rows_of(snapshot, (enum chunk)chunk), 8);
    put(stream, at, 8);
    put(stream, chunks[chunk].columns, 4);
    put(stream, (uint64_t)id, 2);
    put(stream, chunks[chunk].type, 1);
    put(stream, 0, 1);
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    uint64_t at = GSD_HEAD;
    size_t names = 0;
    int written = 0;
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        at += bytes_of(snapshot, (enum chunk)chunk);
    print_head(at, stream);
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (rows_of(snapshot, (enum chunk)chunk) > 0)
            put_numbers(snapshot, (enum chunk)chunk, stream);
    at = GSD_HEAD;
    for (int chunk = 0; chunk < CHUNKS; chunk++) {
        if (rows_of(snapshot, (enum chunk)chunk) > 0)
            print_entry(snapshot, chunk, at, written++, stream);
        at += bytes_of(snapshot, (enum chunk)chunk);
    }
    put_text(stream, "", (size_t)(CHUNKS - written) * GSD_ENTRY);
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (rows_of(snapshot, (enum chunk)chunk) > 0) {
            fputs(chunks[chunk].name, stream);
            putc('\0', stream);
            names += strlen(chunks[chunk].name) + 1;
        }
    put_text(stream, "", (size_t)CHUNKS * GSD_NAME - names);
}

const struct snapshot_format mf_snapshot_gsd = {.name = "gsd", .suffix = "gsd", .print = print};
