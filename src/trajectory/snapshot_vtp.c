// SPDX-License-Identifier: GPL-3.0-or-later
//
// PolyData of the Visualization Toolkit's XML files, which ParaView opens: points with arrays.
// Numbers are binary in base64: they are exact, and a third of the size of their digits. W.
// Schroeder, K. Martin and B. Lorensen, The Visualization Toolkit (4th ed., 2006); the VTK file
// formats document.
#include "trajectory/snapshot.h"

#include <inttypes.h>
#include <string.h>

/// Bytes on their way into a stream, three at a time.
struct base64 {
    FILE *stream;
    unsigned char bytes[3];
    int count;
};

static void encode(struct base64 *base64) {
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = base64->bytes;
    const unsigned index[] = {b[0] >> 2, (b[0] & 3u) << 4 | b[1] >> 4,
                              (b[1] & 15u) << 2 | b[2] >> 6, b[2] & 63u};
    for (int k = 0; k < 4; k++)
        putc(k <= base64->count ? letters[index[k]] : '=', base64->stream);
    *base64 = (struct base64){.stream = base64->stream};
}

static void append(struct base64 *base64, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t k = 0; k < size; k++) {
        base64->bytes[base64->count++] = bytes[k];
        if (base64->count == 3)
            encode(base64);
    }
}

/// Begin an array, whose number of bytes comes first.
static struct base64 begin_array(FILE *stream, const char *type, const char *name, int components,
                                 uint64_t size) {
    struct base64 base64 = {.stream = stream};
    fprintf(stream,
            "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
            "format=\"binary\">",
            type, name, components);
    append(&base64, &size, sizeof size);
    return base64;
}

static void end_array(struct base64 *base64) {
    if (base64->count > 0)
        encode(base64);
    fputs("</DataArray>\n", base64->stream);
}

/// A column; a vector has three components, the third 0 in two dimensions.
static void print_column(const struct snapshot *snapshot, const struct snapshot_column *column,
                         FILE *stream) {
    const int width = column->vector ? 3 : column->components;
    struct base64 base64 = begin_array(stream, "Float64", column->name, width,
                                       (uint64_t)width * snapshot->count * sizeof(double));
    for (size_t k = 0; k < snapshot->count; k++)
        for (int c = 0; c < width; c++) {
            const double value =
                c < column->components ? column->values[(size_t)c * snapshot->count + k] : 0;
            append(&base64, &value, sizeof value);
        }
    end_array(&base64);
}

/// Integers that follow from the place of a particle: base + step · k, or its type.
static void print_integers(const struct snapshot *snapshot, const char *name, int64_t base,
                           int64_t step, bool types, FILE *stream) {
    struct base64 base64 = begin_array(stream, "Int64", name, 1, snapshot->count * sizeof(int64_t));
    for (size_t k = 0; k < snapshot->count; k++) {
        const int64_t value = types ? mf_snapshot_type(snapshot, k) : base + step * (int64_t)k;
        append(&base64, &value, sizeof value);
    }
    end_array(&base64);
}

static void print_time(const struct snapshot *snapshot, FILE *stream) {
    fprintf(stream,
            "    <FieldData>\n"
            "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
            "format=\"ascii\">%.17g</DataArray>\n"
            "      <DataArray type=\"Float64\" Name=\"box\" NumberOfTuples=\"3\" "
            "format=\"ascii\">%.17g %.17g %.17g</DataArray>\n"
            "    </FieldData>\n",
            snapshot->time, snapshot->box.length[0], snapshot->box.length[1],
            snapshot->box.dimensions == 3 ? snapshot->box.length[2] : 0);
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    const uint16_t one = 1;
    const bool little = *(const unsigned char *)&one == 1;
    fprintf(stream,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"%s\" header_type=\"UInt64\">\n  <PolyData>\n",
            little ? "LittleEndian" : "BigEndian");
    print_time(snapshot, stream);
    fprintf(stream, "    <Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\">\n      <Points>\n",
            snapshot->count, snapshot->count);
    print_column(snapshot, &snapshot->column[0], stream);
    fputs("      </Points>\n      <Verts>\n", stream);
    print_integers(snapshot, "connectivity", 0, 1, false, stream);
    print_integers(snapshot, "offsets", 1, 1, false, stream);
    fputs("      </Verts>\n      <PointData>\n", stream);
    print_integers(snapshot, "id", 0, 1, false, stream);
    print_integers(snapshot, "type", 0, 0, true, stream);
    for (int n = 1; n < snapshot->columns; n++)
        print_column(snapshot, &snapshot->column[n], stream);
    fputs("      </PointData>\n    </Piece>\n  </PolyData>\n</VTKFile>\n", stream);
}

const struct snapshot_format mf_snapshot_vtp = {.name = "vtp", .suffix = "vtp", .print = print};
