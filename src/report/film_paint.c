// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/film_paint.h"

#include "io/configuration.h"
#include "io/input.h"
#include "io/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = OUTPUT_PATH_SIZE + 64 };

static bool find(const char *folder, const char *name, char path[PATH_SIZE]) {
    snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    return access(path, R_OK) == 0;
}

// Types ------------------------------------------------------------------------------------------

/// Of the comment "# types: A 20 B 10".
static int take_names(struct film_beads *beads, char *line) {
    static const char begin[] = "# types: ", blanks[] = " \t\n";
    int names = 0;
    if (strncmp(line, begin, sizeof begin - 1) != 0)
        return 0;
    for (char *rest, *word = strtok_r(line + sizeof begin - 1, blanks, &rest);
         word && names < COMPOSITION_MAX_TYPES && mf_composition_is_name(word);
         word = strtok_r(NULL, blanks, &rest)) {
        snprintf(beads->name[names++], COMPOSITION_NAME_SIZE, "%s", word);
        if (strtok_r(NULL, blanks, &rest) == NULL)
            break;
    }
    return names;
}

/// The others have no names of their own: a solvent comes last.
static enum status read_names(struct film_beads *beads, const char *folder) {
    char path[PATH_SIZE], *line = NULL;
    size_t size = 0;
    FILE *stream;
    int names = 0;
    if (find(folder, CONFIGURATION_FILE, path)) {
        TRY(mf_input_open(&stream, path));
        while (names == 0 && getline(&line, &size, stream) > 0 && line[0] == '#')
            names = take_names(beads, line);
        free(line);
        fclose(stream);
    }
    for (int type = names; type < beads->types; type++)
        snprintf(beads->name[type], COMPOSITION_NAME_SIZE, "%s",
                 type > 0 && type == beads->types - 1 ? "solvent" : "particles");
    return STATUS_OK;
}

static enum status fail_to_hide(const struct film_beads *beads, const char *name) {
    char known[FILM_TYPES_MAX * (COMPOSITION_NAME_SIZE + 2)] = "";
    for (int type = 0, length = 0; type < beads->types; type++)
        length += snprintf(known + length, sizeof known - (size_t)length, "%s%s",
                           type > 0 ? ", " : "", beads->name[type]);
    return mf_status_fail(STATUS_BAD_INPUT, "--hide: no type \"%.60s\"; there are %s", name, known);
}

static enum status hide_types(struct film_beads *beads, const char *names) {
    int left = beads->types;
    for (size_t length; *names; names += length + (names[length] == ',')) {
        int type = 0;
        length = strcspn(names, ",");
        while (type < beads->types && (strlen(beads->name[type]) != length ||
                                       strncmp(beads->name[type], names, length) != 0))
            type++;
        if (type == beads->types)
            return fail_to_hide(beads, names);
        left -= !beads->hidden[type];
        beads->hidden[type] = true;
    }
    return left > 0 ? STATUS_OK
                    : mf_status_fail(STATUS_BAD_INPUT, "--hide: no type of particles is left");
}

bool mf_film_beads_hides(const struct film_beads *beads, double type) {
    return type < beads->types && beads->hidden[(int)type];
}

// Bonds ------------------------------------------------------------------------------------------

/// The two particles of bond number n, and the nearest way from the first one to the second; false
/// if the frame has no such particles.
static bool film_beads_bond(const struct film_beads *beads, size_t n,
                            const struct film_frame *frame, size_t bead[2], double way[3]) {
    const double *row = beads->bonds.values + n * beads->bonds.columns;
    for (int k = 0; k < 2; k++) {
        if (!(row[k] >= 1 && row[k] <= (double)frame->count))
            return false;
        bead[k] = (size_t)row[k] - 1;
    }
    for (size_t d = 0; d < 3; d++) {
        const double edge = frame->box[d];
        way[d] = frame->position[3 * bead[1] + d] - frame->position[3 * bead[0] + d];
        way[d] -= edge > 0 ? edge * rint(way[d] / edge) : 0;
    }
    return true;
}

static void measure_bonds(struct film_beads *beads, const struct film_frame *frame) {
    double sum = 0, way[3];
    size_t bead[2], count = 0;
    for (size_t n = 0; n < beads->bonds.rows; n++)
        if (film_beads_bond(beads, n, frame, bead, way)) {
            sum += sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
            count++;
        }
    beads->length = count > 0 ? sum / (double)count : 0;
}

// Both -------------------------------------------------------------------------------------------

static void measure(struct film_beads *beads, const struct film_frame *frame) {
    for (size_t k = 0; k < frame->count; k++)
        beads->types = (int)fmin(fmax(beads->types, frame->type[k] + 1), FILM_TYPES_MAX);
    measure_bonds(beads, frame);
}

enum status mf_film_beads_read(struct film_beads *beads, const char *folder, const char *first,
                               const char *hide) {
    char path[PATH_SIZE];
    struct film_frame frame;
    *beads = (struct film_beads){0};
    if (find(folder, CONFIGURATION_BONDS_FILE, path))
        TRY(mf_data_table_read(&beads->bonds, path, 2));
    TRY(mf_film_frame_read(&frame, first, NULL));
    measure(beads, &frame);
    mf_film_frame_clear(&frame);
    TRY(read_names(beads, folder));
    return hide ? hide_types(beads, hide) : STATUS_OK;
}

void mf_film_beads_clear(struct film_beads *beads) {
    mf_data_table_clear(&beads->bonds);
}

enum {
    SHADES = 24, ///< of a colour bar
    DEPTHS = 6,  ///< of depth, each of two layers
};

/// Of the values of a quantity this share, at each end, may lie beyond the ends of its colours.
static const double tail = 0.02;

/// Half the width of a bond, in radii of particles.
static const double half_bond = 0.45;

// Choosing ---------------------------------------------------------------------------------------

static int compare(const void *first, const void *second) {
    const double a = *(const double *)first, b = *(const double *)second;
    return (a > b) - (a < b);
}

/// Widen the range to what nearly all values of a frame lie within.
static void widen(struct film_paint *paint, struct film_frame *frame) {
    qsort(frame->colour, frame->count, sizeof(double), compare);
    const size_t skipped = (size_t)(tail * (double)frame->count);
    paint->min = fmin(paint->min, frame->colour[skipped]);
    paint->max = fmax(paint->max, frame->colour[frame->count - 1 - skipped]);
}

/// Particles as large as leaves most of the box free, and their bonds.
static double size_of(const struct film_beads *beads, const struct film_frame *frame) {
    const int dimensions = frame->box[2] > 0 ? 3 : 2;
    const double volume = frame->box[0] * frame->box[1] * (dimensions == 3 ? frame->box[2] : 1);
    const double size = 0.35 * pow(volume / (double)frame->count, 1.0 / dimensions);
    return beads->length > 0 ? fmin(size, beads->length / 5) : size;
}

static enum status choose_quantity(struct film_paint *paint, const char *file, const char *wanted) {
    struct film_frame frame;
    TRY(mf_film_frame_read(&frame, file, NULL));
    const char *colour = wanted           ? wanted
                         : frame.oriented ? "orientation"
                         : frame.mixed    ? "type"
                                          : "speed";
    snprintf(paint->colour, sizeof paint->colour, "%s", colour);
    paint->scale = strcmp(colour, "type") == 0          ? FILM_TYPES
                   : strcmp(colour, "orientation") == 0 ? FILM_TURNS
                                                        : FILM_RANGE;
    paint->size = size_of(paint->beads, &frame);
    mf_film_frame_clear(&frame);
    return STATUS_OK;
}

enum status mf_film_paint_choose(struct film_paint *paint, const struct film_beads *beads,
                                 const char *const files[3], const char *wanted) {
    *paint = (struct film_paint){.min = INFINITY, .max = -INFINITY, .beads = beads};
    TRY(choose_quantity(paint, files[0], wanted));
    for (int k = 0; k < 3; k++) {
        struct film_frame frame;
        TRY(mf_film_frame_read(&frame, files[k], paint->colour));
        widen(paint, &frame);
        mf_film_frame_clear(&frame);
    }
    if (strcmp(paint->colour, "speed") == 0)
        paint->min = 0;
    if (!(paint->max > paint->min)) // all alike
        paint->max = paint->min + 1;
    return STATUS_OK;
}

// Colours ----------------------------------------------------------------------------------------

static int join(double red, double green, double blue) {
    return (int)lround(255 * red) << 16 | (int)lround(255 * green) << 8 | (int)lround(255 * blue);
}

/// Round the circle: hue of a colour of 75 % saturation and 85 % value.
static int turn_colour(double turn) {
    static const double saturation = 0.75, value = 0.85;
    double part[3];
    for (int c = 0; c < 3; c++) {
        const double k = fmod(5 - 2 * c + 6 * turn, 6);
        part[c] = value - value * saturation * fmax(0, fmin(fmin(k, 4 - k), 1));
    }
    return join(part[0], part[1], part[2]);
}

/// From dark blue over green to yellow, each lighter than the one before: viridis (S. van der Walt
/// and N. Smith, 2015), joined by straight lines.
static int range_colour(double share) {
    static const double anchors[][3] = {{0.267, 0.005, 0.329}, {0.254, 0.265, 0.530},
                                        {0.164, 0.471, 0.558}, {0.135, 0.659, 0.518},
                                        {0.478, 0.821, 0.318}, {0.993, 0.906, 0.144}};
    const double place = 5 * fmin(fmax(share, 0), 1);
    const int left = (int)fmin(floor(place), 4);
    double part[3];
    for (int c = 0; c < 3; c++)
        part[c] = anchors[left][c] + (place - left) * (anchors[left + 1][c] - anchors[left][c]);
    return join(part[0], part[1], part[2]);
}

/// Those of plots/style.gp.
static int type_colour(int type) {
    static const int colours[] = {0x0072b2, 0xd55e00, 0x009e73, 0xaa4499,
                                  0xe69f00, 0x56b4e9, 0x882255, 0x7a7a1f};
    return colours[type % 8];
}

/// Number of one of the shades, the middle of which stands for all in it.
static double in_shades(double share) {
    return (floor(fmin(fmax(share, 0), 1 - 1e-12) * SHADES) + 0.5) / SHADES;
}

static int colour_of(const struct film_paint *paint, double value) {
    static const double full_turn = 6.283185307179586;
    if (paint->scale == FILM_TYPES)
        return type_colour((int)value);
    if (paint->scale == FILM_TURNS)
        return turn_colour(in_shades(value / full_turn - floor(value / full_turn)));
    return range_colour(in_shades((value - paint->min) / (paint->max - paint->min)));
}

/// Of what is behind the rest the colour is a part, the others white.
static int faded(int colour, int layer) {
    const double share = (layer * DEPTHS / FILM_LAYERS + 1.0) / DEPTHS;
    int result = 0;
    for (int shift = 0; shift <= 16; shift += 8)
        result |= (int)lround(255 - share * (255 - (colour >> shift & 255))) << shift;
    return result;
}

void mf_film_paint_palette(const struct film_paint *paint, FILE *stream) {
    if (paint->scale == FILM_TYPES)
        return;
    fprintf(stream, "set palette maxcolors %d defined (", SHADES);
    for (int k = 0; k < SHADES; k++) {
        const double share = (k + 0.5) / SHADES;
        const int colour = paint->scale == FILM_TURNS ? turn_colour(share) : range_colour(share);
        fprintf(stream, "%s%d '#%06x'", k > 0 ? ", " : "", k, (unsigned)colour);
    }
    fprintf(stream, ")\n");
}

// Painting ---------------------------------------------------------------------------------------

static int layer_of(const struct film_frame *frame, double z) {
    if (!(frame->box[2] > 0))
        return FILM_LAYERS - 1;
    return (int)fmin(fmax(floor(z / frame->box[2] * FILM_LAYERS), 0), FILM_LAYERS - 1);
}

static double radius_of(const struct film_paint *paint, const struct film_frame *frame, size_t k) {
    return frame->radius && frame->radius[k] > 0 ? frame->radius[k] : paint->size;
}

static void print_particle(const struct film_paint *paint, const struct film_frame *frame, size_t k,
                           int layer, FILE *stream) {
    fprintf(stream, "%.5g\t%.5g\t%.4g\t%d\n", frame->position[3 * k], frame->position[3 * k + 1],
            radius_of(paint, frame, k), faded(colour_of(paint, frame->colour[k]), layer));
}

/// A solvent, which comes last, lies behind the others of its layer.
static void print_particles(const struct film_paint *paint, const struct film_frame *frame,
                            int layer, FILE *stream) {
    for (size_t k = frame->count; k-- > 0;)
        if (layer_of(frame, frame->position[3 * k + 2]) == layer &&
            !mf_film_beads_hides(paint->beads, frame->type[k]))
            print_particle(paint, frame, k, layer, stream);
}

/// Four corners: from the rim of a particle to the middle of its bond, `sign` times half the way.
/// Nothing of a bond that the particle covers, or of another layer.
static void print_half(const struct film_paint *paint, const struct film_frame *frame, size_t k,
                       const double way[3], double sign, int layer, FILE *stream) {
    static const double along[] = {0, 0, 1, 1}, beside[] = {1, -1, -1, 1};
    const double *from = frame->position + 3 * k;
    const double seen = hypot(way[0], way[1]), length = hypot(seen, way[2]);
    const double begin = radius_of(paint, frame, k) / length;
    if (!(begin < 0.5 && seen > 0) ||
        layer_of(frame, from[2] + sign * 0.5 * (begin + 0.5) * way[2]) != layer)
        return;
    const double half_width = half_bond * paint->size / seen;
    for (int corner = 0; corner < 4; corner++) {
        const double part = sign * (begin + along[corner] * (0.5 - begin));
        const double side = half_width * beside[corner];
        fprintf(stream, "%.5g\t%.5g\t%d\n", from[0] + part * way[0] - side * way[1],
                from[1] + part * way[1] + side * way[0],
                faded(colour_of(paint, frame->colour[k]), layer));
    }
    fputc('\n', stream);
}

static void print_bonds(const struct film_paint *paint, const struct film_frame *frame, int layer,
                        FILE *stream) {
    for (size_t n = 0; n < paint->beads->bonds.rows; n++) {
        size_t bead[2];
        double way[3];
        if (!film_beads_bond(paint->beads, n, frame, bead, way) ||
            mf_film_beads_hides(paint->beads, frame->type[bead[0]]) ||
            mf_film_beads_hides(paint->beads, frame->type[bead[1]]))
            continue;
        print_half(paint, frame, bead[0], way, 1, layer, stream);
        print_half(paint, frame, bead[1], way, -1, layer, stream);
    }
}

void mf_film_paint_frame(const struct film_paint *paint, const struct film_frame *frame,
                         FILE *stream) {
    // A block is not empty, and two blank lines end it.
    const char *const end = paint->beads->bonds.rows > 0 ? "NaN NaN NaN NaN\n\n\n" : "";
    for (int layer = 0; layer < FILM_LAYERS; layer++) {
        print_bonds(paint, frame, layer, stream);
        fputs(end, stream);
        print_particles(paint, frame, layer, stream);
        fputs(end, stream);
    }
}
