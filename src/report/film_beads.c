// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/film_beads.h"

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

bool mf_film_beads_bond(const struct film_beads *beads, size_t n, const struct film_frame *frame,
                        size_t bead[2], double way[3]) {
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
        if (mf_film_beads_bond(beads, n, frame, bead, way)) {
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
