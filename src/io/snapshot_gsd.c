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
                mf_gsd_put(stream, (uint32_t)(int32_t)value, 4);
            else
                mf_gsd_put_float(stream, value - middle);
        }
}

static void put_types(const struct snapshot *snapshot, FILE *stream) {
    for (int type = 0; type < count_types(snapshot); type++) {
        size_t k = 0;
        while (k < snapshot->count && mf_snapshot_type(snapshot, k) != type)
            k++;
        mf_gsd_put_text(stream, k < snapshot->count ? mf_snapshot_type_name(snapshot, k) : "",
                        GSD_NAME);
    }
}

static void put_bonds(const struct topology *topology, FILE *stream) {
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *const kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int t = 0; t < kind->terms[BONDED_BOND]; t++)
                for (int end = 0; end < 2; end++)
                    mf_gsd_put(stream, topology_id(kind, m, kind->term[BONDED_BOND][t].bead[end]),
                               4);
    }
}

static void put_box(const struct box *box, FILE *stream) {
    for (int k = 0; k < 6; k++)
        mf_gsd_put_float(stream, k < box->dimensions ? box->length[k] : k == 2 ? 1 : 0);
}

static void put_numbers(const struct snapshot *snapshot, enum chunk chunk, FILE *stream) {
    const size_t rows = rows_of(snapshot, chunk);
    if (chunk == STEP)
        mf_gsd_put(stream, snapshot->step, 8);
    else if (chunk == DIMENSIONS)
        mf_gsd_put(stream, (uint64_t)snapshot->box.dimensions, 1);
    else if (chunk == BOX)
        put_box(&snapshot->box, stream);
    else if (chunk == COUNT)
        mf_gsd_put(stream, snapshot->count, 4);
    else if (chunk == TYPES)
        put_types(snapshot, stream);
    else if (chunk == POSITION || chunk == VELOCITY || chunk == IMAGE)
        put_vector(snapshot, strrchr(chunks[chunk].name, '/') + 1, stream);
    else if (chunk == BONDS)
        mf_gsd_put(stream, count_bonds(snapshot->topology), 4);
    else if (chunk == BOND_TYPES)
        mf_gsd_put_text(stream, "bond", GSD_NAME);
    else if (chunk == BOND)
        put_bonds(snapshot->topology, stream);
    else
        for (size_t k = 0; k < rows; k++)
            if (chunk == MASS)
                mf_gsd_put_float(stream, find(snapshot, "mass")->values[k]);
            else
                mf_gsd_put(stream, chunk == TYPE ? (uint64_t)mf_snapshot_type(snapshot, k) : 0, 4);
}

// The file ----------------------------------------------------------------------------------------

static size_t bytes_of(const struct snapshot *snapshot, enum chunk chunk) {
    return rows_of(snapshot, chunk) * chunks[chunk].columns * chunks[chunk].bytes;
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    uint64_t at = GSD_HEAD;
    size_t names = 0;
    int written = 0;
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        at += bytes_of(snapshot, (enum chunk)chunk);
    mf_gsd_put_head(stream, at, CHUNKS, CHUNKS); // entries at the end may be empty
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (rows_of(snapshot, (enum chunk)chunk) > 0)
            put_numbers(snapshot, (enum chunk)chunk, stream);
    at = GSD_HEAD;
    for (int chunk = 0; chunk < CHUNKS; chunk++) {
        if (rows_of(snapshot, (enum chunk)chunk) > 0)
            mf_gsd_put_entry(stream,
                             &(struct gsd_entry){.rows = rows_of(snapshot, (enum chunk)chunk),
                                                 .at = at,
                                                 .columns = chunks[chunk].columns,
                                                 .id = written++,
                                                 .type = chunks[chunk].type});
        at += bytes_of(snapshot, (enum chunk)chunk);
    }
    mf_gsd_put_text(stream, "", (size_t)(CHUNKS - written) * GSD_ENTRY);
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (rows_of(snapshot, (enum chunk)chunk) > 0) {
            fputs(chunks[chunk].name, stream);
            putc('\0', stream);
            names += strlen(chunks[chunk].name) + 1;
        }
    mf_gsd_put_text(stream, "", (size_t)CHUNKS * GSD_NAME - names);
}

const struct snapshot_format mf_snapshot_gsd = {.name = "gsd", .suffix = "gsd", .print = print};
