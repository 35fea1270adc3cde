// SPDX-License-Identifier: GPL-3.0-or-later
//
// An inversion whose samples are the caller's: a fit with --engine later, whose pieces are read
// from their folders and answered there.
#include "mesofit/inversion.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "io/json.h"
#include "io/json_write.h"
#include "io/output.h"
#include "io/text_file.h"
#include "library/guard.h"
#include "mesofit/run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// What engine.json of a piece says, and its texts.
struct asked {
    int64_t replica, seed, equilibration, frames, every;
    double temperature;
    char trajectory[FIELD_TEXT_SIZE], before[FIELD_TEXT_SIZE];
};

#define MEMBER(name) .offset = offsetof(struct asked, name)
#define COUNT(name_)                                                                               \
    { .name = #name_, .type = FIELD_INTEGER, MEMBER(name_), .minimum = 0, .maximum = 1e18 }
static const struct field fields[] = {
    COUNT(replica),
    COUNT(seed),
    COUNT(equilibration),
    COUNT(frames),
    COUNT(every),
    {.name = "temperature", .type = FIELD_NUMBER, MEMBER(temperature), .maximum = DBL_MAX},
    {.name = "trajectory", .type = FIELD_TEXT, MEMBER(trajectory)},
    {.name = "before", .type = FIELD_TEXT, MEMBER(before)},
    FIELD_END,
};

enum { TYPES = 32, NAME = 64 };

struct piece {
    struct mesofit_piece told;
    struct asked asked;
    char folder[OUTPUT_PATH_SIZE], before[2 * OUTPUT_PATH_SIZE];
    int *type; ///< shape [beads]
    char name[TYPES][NAME];
};

struct mesofit_inversion {
    char run[OUTPUT_PATH_SIZE], folder[OUTPUT_PATH_SIZE];
    const char *units; ///< of its frames, as extended XYZ names them
    struct piece *piece;
    size_t pieces;
};

// What is asked for -------------------------------------------------------------------------------

static void forget(struct mesofit_inversion *inversion) {
    for (size_t n = 0; n < inversion->pieces; n++)
        mf_memory_free(inversion->piece[n].type);
    mf_memory_free(inversion->piece);
    inversion->piece = NULL;
    inversion->pieces = 0;
}

/// "beads": how many there are of each type.
static enum status read_beads(struct json_object *root, struct piece *piece) {
    struct json_object beads = mf_json_child(root, "beads", true);
    const char *key;
    size_t count[TYPES] = {0}, bead = 0;
    int types = 0;
    for (; types < TYPES && (key = mf_json_key(&beads, (size_t)types)) != NULL; types++) {
        double number = 0;
        (void)mf_json_has(&beads, key);
        (void)mf_json_numbers(&beads, key, &number, 1);
        snprintf(piece->name[types], NAME, "%s", key);
        count[types] = (size_t)number;
        piece->told.beads += count[types];
    }
    TRY_ARRAY(piece->type, piece->told.beads + 1);
    for (int type = 0; type < types; type++)
        for (size_t k = 0; k < count[type]; k++)
            piece->type[bead++] = type;
    mf_json_finish(&beads);
    return STATUS_OK;
}

static enum status read_asked(struct json_document *document, struct piece *piece) {
    struct json_object root = mf_json_root(document);
    const struct asked *asked = &piece->asked;
    (void)mf_json_fields(&root, fields, &piece->asked);
    (void)mf_json_has(&root, "piece");
    const int dimensions = mf_json_count(&root, "box");
    if (dimensions == 2 || dimensions == 3)
        (void)mf_json_list_numbers(&root, "box", piece->told.box, (size_t)dimensions);
    TRY(read_beads(&root, piece));
    mf_json_finish(&root);
    snprintf(piece->before, sizeof piece->before, "%s/%s", piece->folder, asked->before);
    piece->told = (struct mesofit_piece){
        .folder = piece->folder,
        .before = asked->before[0] ? piece->before : NULL,
        .replica = asked->replica,
        .seed = asked->seed,
        .temperature = asked->temperature,
        .dimensions = dimensions,
        .box = {piece->told.box[0], piece->told.box[1], dimensions == 3 ? piece->told.box[2] : 1},
        .equilibration = asked->equilibration,
        .frames = asked->frames,
        .every = asked->every,
        .beads = piece->told.beads,
        .type = piece->type};
    return STATUS_OK;
}

static enum status read_piece(struct piece *piece, const char *folder) {
    struct json_document *document;
    char file[OUTPUT_PATH_SIZE + 16];
    snprintf(piece->folder, sizeof piece->folder, "%s", folder);
    snprintf(file, sizeof file, "%s/engine.json", folder);
    TRY(mf_json_open(&document, file));
    return mf_json_close(document, read_asked(document, piece));
}

static size_t count_lines(const char *text) {
    size_t lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

/// The list of the pieces that are waited for, and each of them.
static enum status look(struct mesofit_inversion *inversion) {
    char file[OUTPUT_PATH_SIZE + 32], *rest = NULL;
    OWNED char *text = NULL;
    size_t length;
    forget(inversion);
    snprintf(file, sizeof file, "%s/engine/waiting", inversion->folder);
    FILE *list = fopen(file, "r");
    const bool empty = list == NULL || fgetc(list) == EOF;
    if (list)
        fclose(list);
    if (empty)
        return STATUS_OK;
    TRY(mf_text_file_read(file, &text, &length));
    TRY_ARRAY(inversion->piece, count_lines(text) + 1);
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        TRY(read_piece(&inversion->piece[inversion->pieces++], line));
    return STATUS_OK;
}

/// The units of a run are those that its used.json has.
static enum status find_units(struct mesofit_inversion *inversion) {
    char file[OUTPUT_PATH_SIZE + 16];
    OWNED char *text = NULL;
    size_t length;
    snprintf(file, sizeof file, "%s/used.json", inversion->folder);
    TRY(mf_text_file_read(file, &text, &length));
    inversion->units = strstr(text, "\"angstrom-fs\"") ? ""
                       : strstr(text, "\"nm-ps\"")     ? " Units=nm-ps"
                                                       : " Units=lj";
    return STATUS_OK;
}

/// Run the fit until it waits for samples, or ends.
static enum mesofit_status run(struct mesofit_inversion *inversion, bool resume) {
    const char *const words[] = {"fit",      inversion->run, "-o",      inversion->folder,
                                 "--engine", "later",        "--resume"};
    const size_t count = sizeof words / sizeof *words - !resume;
    struct mesofit_run *fit = mesofit_run_create();
    if (fit == NULL)
        return MESOFIT_NO_MEMORY;
    const enum mesofit_status ran = mesofit_run_words(fit, count, words, NULL);
    mesofit_run_free(fit);
    if (ran != MESOFIT_OK && ran != MESOFIT_INTERRUPTED)
        return ran;
    mf_guard_enter();
    enum status status = look(inversion);
    if (status == STATUS_OK)
        status = find_units(inversion);
    const enum mesofit_status looked = mf_guard_return(status);
    return looked == MESOFIT_OK && inversion->pieces == 0 ? ran : looked;
}

struct mesofit_inversion *mesofit_inversion_open(const char *run_file, const char *folder,
                                                 int resume) {
    struct mesofit_inversion *inversion = mf_memory_zeroed(1, sizeof *inversion);
    if (inversion == NULL)
        return NULL;
    snprintf(inversion->run, sizeof inversion->run, "%s", run_file ? run_file : "");
    snprintf(inversion->folder, sizeof inversion->folder, "%s", folder ? folder : "");
    if (run(inversion, resume != 0) == MESOFIT_OK)
        return inversion;
    forget(inversion);
    mf_memory_free(inversion);
    return NULL;
}

void mesofit_inversion_free(struct mesofit_inversion *inversion) {
    if (inversion == NULL)
        return;
    forget(inversion);
    mf_memory_free(inversion);
}

size_t mesofit_inversion_pieces(const struct mesofit_inversion *inversion) {
    return inversion->pieces;
}

const struct mesofit_piece *mesofit_inversion_piece(const struct mesofit_inversion *inversion,
                                                    size_t number) {
    return number < inversion->pieces ? &inversion->piece[number].told : NULL;
}

struct mesofit_result *mesofit_inversion_potentials(const struct mesofit_inversion *inversion,
                                                    size_t number) {
    return mesofit_result_open(number < inversion->pieces ? inversion->piece[number].folder : "");
}

enum mesofit_status mesofit_inversion_go_on(struct mesofit_inversion *inversion) {
    return run(inversion, true);
}

// What is told ------------------------------------------------------------------------------------

static enum status check_numbers(const char *name, const double *values, size_t count) {
    for (size_t k = 0; values && k < count; k++)
        if (!isfinite(values[k]))
            return mf_status_fail(STATUS_BAD_INPUT, "%s: number %zu is %g", name, k + 1, values[k]);
    return STATUS_OK;
}

/// As of frames that are read (engines/engine_frames.c): in another unit the first one is within a
/// tenth of the box from its origin, or spreads over ten. Those of a beginning have not gone far.
static enum status check_unit(const struct mesofit_piece *piece,
                              const struct mesofit_samples *samples) {
    static const double least = 0.12, most = 4;
    const double *box = samples->boxes ? samples->boxes : piece->box;
    double narrowest = INFINITY, farthest = 0;
    for (int d = 0; d < piece->dimensions; d++) {
        struct running_mean places = {0};
        for (size_t bead = 0; bead < piece->beads; bead++) {
            const double place =
                samples->positions[bead * (size_t)piece->dimensions + (size_t)d] / box[d];
            mf_statistics_add(&places, place);
            farthest = fmax(farthest, fabs(place));
        }
        narrowest = fmin(narrowest, sqrt(12 * places.squares / places.count));
    }
    const bool small = farthest < least, large = piece->before == NULL && narrowest > most;
    if (piece->beads < 2 || !(small || large))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "positions: the beads are spread over %.2g of the box along each axis: "
                          "look at the unit of their positions, that of the run file",
                          small ? farthest : narrowest);
}

static enum status check_samples(const struct mesofit_piece *piece,
                                 const struct mesofit_samples *samples) {
    const size_t frames = (size_t)piece->frames, dimensions = (size_t)piece->dimensions;
    if (samples->positions == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "positions: there are none");
    TRY(check_numbers("positions", samples->positions, frames * piece->beads * dimensions));
    TRY(check_numbers("boxes", samples->boxes, frames * dimensions));
    TRY(check_numbers("pressure", samples->pressure, frames));
    TRY(check_numbers("temperature", samples->temperature, frames));
    TRY(check_numbers("pair_energy", samples->pair_energy, frames));
    return check_unit(piece, samples);
}

static void print_frame(const struct mesofit_inversion *inversion, const struct piece *piece,
                        const struct mesofit_samples *samples, size_t frame, FILE *stream) {
    const struct mesofit_piece *told = &piece->told;
    const size_t dimensions = (size_t)told->dimensions;
    const double *place = samples->positions + frame * told->beads * dimensions;
    const double *box = samples->boxes ? samples->boxes + frame * dimensions : told->box;
    fprintf(stream,
            "%zu\nLattice=\"%.12g 0 0 0 %.12g 0 0 0 %.12g\" Properties=species:S:1:pos:R:3%s\n",
            told->beads, box[0], box[1], dimensions == 3 ? box[2] : 1, inversion->units);
    for (size_t k = 0; k < told->beads; k++, place += dimensions)
        fprintf(stream, "%s %.10g %.10g %.10g\n", piece->name[told->type[k]], place[0], place[1],
                dimensions == 3 ? place[2] : 0.0);
}

/// The trajectory appears whole or not at all.
static enum status write_frames(const struct mesofit_inversion *inversion,
                                const struct piece *piece, const struct mesofit_samples *samples) {
    struct output output;
    char path[OUTPUT_PATH_SIZE + FIELD_TEXT_SIZE];
    snprintf(path, sizeof path, "%s/%s", piece->folder, piece->asked.trajectory);
    TRY(mf_output_open(&output, path));
    for (size_t frame = 0; frame < (size_t)piece->told.frames; frame++)
        print_frame(inversion, piece, samples, frame, output.stream);
    return mf_output_commit(&output);
}

/// sample.json: what is known beside the frames.
static enum status write_numbers(const struct piece *piece, const struct mesofit_samples *samples) {
    char path[OUTPUT_PATH_SIZE + 16];
    const struct {
        const char *name;
        const double *values;
    } lists[] = {{"pressure", samples->pressure},
                 {"temperature", samples->temperature},
                 {"pair_energy", samples->pair_energy}};
    struct json_writer *writer = mf_json_writer_create();
    if (writer == NULL)
        return STATUS_NO_MEMORY;
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++)
        if (lists[k].values)
            mf_json_write_quantities(writer, lists[k].name, "1", lists[k].values,
                                     (size_t)piece->told.frames);
    snprintf(path, sizeof path, "%s/sample.json", piece->folder);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}

static enum status tell(const struct mesofit_inversion *inversion, size_t number,
                        const struct mesofit_samples *samples) {
    if (number >= inversion->pieces)
        return mf_status_fail(STATUS_BAD_INPUT, "piece %zu: %zu are asked for", number,
                              inversion->pieces);
    const struct piece *piece = &inversion->piece[number];
    TRY(check_samples(&piece->told, samples));
    TRY(write_numbers(piece, samples));
    return write_frames(inversion, piece, samples);
}

enum mesofit_status mesofit_inversion_tell(struct mesofit_inversion *inversion, size_t number,
                                           const struct mesofit_samples *samples) {
    mf_guard_enter();
    return mf_guard_return(tell(inversion, number, samples));
}
