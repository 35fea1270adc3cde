// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"
#include "work/measure_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    STRUCTURE,
    MAP,
    MOLECULES,
    BEGIN,
    END,
    EVERY,
    RANGE,
    BINS,
    Q_RANGE,
    WAVES,
    PROFILE,
    PROFILE_BINS,
    WEIGHTED,
    FORCES,
    WINDOW,
    ESCAPE,
    VELOCITIES,
    STATIC,
    TEMPERATURE,
    UNITS,
    ALLOW_TRUNCATED,
    FILE_UNITS,
    FILE_TIME_STEP,
    FILE_GROUP,
    BOX,
    BEADS,
};

static const struct command_option options[] = {
    [STRUCTURE] = {"-s", "FILE", "names, residues, masses (.gro, .pdb, .top, .psf, …)"},
    [MAP] = {"--map", "FILE", "atoms to beads (describe map, or VOTCA's); else a residue"},
    [MOLECULES] = {"--molecules", "FILE",
                   "bonds of beads (a scene's \"molecules\"); without a map a bead an atom"},
    [BEGIN] = {"--begin", "T", "first time used [ps]; else the begin of equilibrium"},
    [END] = {"--end", "T", "last time used [ps]"},
    [EVERY] = {"--every", "T", "interval between the frames used [ps]"},
    [RANGE] = {"--range", "R", "range of g(r) [nm]; else most of half the box"},
    [BINS] = {"--bins", "N", "bins of g(r); else 0.01 nm wide"},
    [Q_RANGE] = {"--q-range", "Q", "range of S(q) [1/nm]; else 4 pi density^(1/3); 0: no S(q)"},
    [WAVES] = {"--waves", "N", "most waves in a bin of S(q); else 10"},
    [PROFILE] = {"--density-profile", "x|y|z", "density of each type along an axis"},
    [PROFILE_BINS] = {"--profile-bins", "N", "its bins; else 100"},
    [WEIGHTED] =
        {"--weighted-density", "R0,RC[,END]",
         "density around each bead, by a weight from 1 at r_0 to 0 at r_c [nm]; 200 bins to END"},
    [FORCES] = {"--forces", "R", "for force-matching: of pairs up to R [nm]"},
    [WINDOW] = {"--window", "T",
                "window of MSD, VACF, escape times [ps]; else a tenth, at most 100 frames"},
    [ESCAPE] = {"--escape", "R",
                "distance at which a pair has escaped [nm]; else 1.6 density^(-1/3)"},
    [VELOCITIES] = {"--velocities", "file|differences|none",
                    "velocities of the VACF; else the file's, if any"},
    [STATIC] = {"--static", NULL, "no motion: frames in any order"},
    [TEMPERATURE] = {"--temperature", "T", "temperature [K]; else that of the velocities"},
    [UNITS] = {"--units", "nm-ps|angstrom-fs", "units of the results (nm-ps)"},
    [ALLOW_TRUNCATED] = {"--allow-truncated", NULL, "use what is before damage"},
    [FILE_UNITS] = {"--file-units", "STYLE", "units of files without any: real, metal, …"},
    [FILE_TIME_STEP] = {"--file-time-step", "T", "time step of frames without times [ps]"},
    [FILE_GROUP] = {"--file-group", "NAME", "particle group of H5MD"},
    [BOX] = {"--box", "LX,LY,LZ", "box of files without one [nm]"},
    [BEADS] = {"--beads", "FILE", "the beads' trajectory (.gro, .xtc, …)"},
    {NULL, NULL, NULL},
};

/// A finite number from `min` on; NULL leaves it alone.
static enum status read_number(const struct command_line *line, int option, double min,
                               double *number) {
    const char *const text = line->own[option];
    char *end = NULL;
    if (text == NULL)
        return STATUS_OK;
    *number = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*number) || *number < min)
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes a number %s, not \"%.60s\"",
                              options[option].name, min > 0 ? "above 0" : "from 0 on", text);
    return STATUS_OK;
}

static enum status read_times(const struct command_line *line, struct frames_plan *frames) {
    TRY(read_number(line, BEGIN, 0, &frames->begin));
    TRY(read_number(line, END, 0, &frames->end));
    if (frames->begin > frames->end)
        return mf_status_fail(STATUS_BAD_INPUT, "--begin %s is after --end %s: exchange them",
                              line->own[BEGIN], line->own[END]);
    return STATUS_OK;
}

static enum status read_count(const struct command_line *line, int option, int64_t *count) {
    const char *const text = line->own[option];
    char *end = NULL;
    if (text == NULL)
        return STATUS_OK;
    *count = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || *count < 1 || *count > 100000)
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes a whole number from 1 to 100000",
                              options[option].name);
    return STATUS_OK;
}

/// One of the names of a list, the first of which is the default.
static enum status read_choice(const struct command_line *line, int option,
                               const char *const *names, int *choice) {
    const char *const text = line->own[option];
    if (text == NULL)
        return STATUS_OK;
    for (*choice = 1; names[*choice]; ++*choice)
        if (strcmp(text, names[*choice]) == 0)
            return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s takes %s", options[option].name,
                          options[option].value);
}

static enum status read_profile(const struct command_line *line, struct measured_plan *plan) {
    enum { USUAL_BINS = 100 };
    const char *const axis = line->own[PROFILE];
    if (axis == NULL && line->own[PROFILE_BINS])
        return mf_status_fail(STATUS_BAD_INPUT, "--profile-bins is for --density-profile x|y|z");
    for (int k = 0; axis && mf_density_profile_axes[k]; k++)
        if (strcmp(axis, mf_density_profile_axes[k]) == 0) {
            plan->profile.axis = k;
            plan->profile.bins = USUAL_BINS;
        }
    if (axis && plan->profile.bins == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "--density-profile takes x, y or z");
    return read_count(line, PROFILE_BINS, &plan->profile.bins);
}

/// "R0,RC", the first below the second, or "R0,RC,END" with the end of the bins.
static enum status read_weighted(const struct command_line *line,
                                 struct weighted_density_settings *settings) {
    enum { BINS_OF_DENSITY = 200, NUMBERS = 3 };
    const char *const text = line->own[WEIGHTED];
    double number[NUMBERS] = {NAN, NAN, 0};
    int count = 0, length = 0, read = 0;
    if (text == NULL)
        return STATUS_OK;
    while (count < NUMBERS && sscanf(text + length, "%lf%n", &number[count], &read) == 1) {
        length += read;
        count++;
        if (text[length] != ',')
            break;
        length++;
    }
    *settings =
        (struct weighted_density_settings){number[0], number[1], BINS_OF_DENSITY, number[2]};
    if (count >= 2 && text[length] == '\0' && text[length - 1] != ',' && number[0] >= 0 &&
        number[1] > number[0] && isfinite(number[1]) &&
        (count == 2 || (number[2] > 0 && isfinite(number[2]))))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "--weighted-density takes two distances, the first below the second, as "
                          "0.3,0.7, and perhaps the end of its bins, 0.3,0.7,40, not \"%.60s\"",
                          text);
}

static enum status read_request(const struct command_line *line, struct measure_request *request) {
    static const double above_zero = 1e-300;
    struct frames_plan *const frames = &request->frames;
    TRY(mf_command_read_box(line->own[BOX], frames->options.box));
    TRY(read_times(line, frames));
    TRY(read_number(line, EVERY, above_zero, &frames->every));
    TRY(read_number(line, RANGE, above_zero, &request->measured.range));
    TRY(read_number(line, WINDOW, above_zero, &request->measured.motion.window));
    TRY(read_number(line, ESCAPE, above_zero, &request->measured.motion.escape));
    TRY(read_number(line, TEMPERATURE, above_zero, &request->temperature));
    TRY(read_number(line, FILE_TIME_STEP, above_zero, &frames->options.time_step));
    TRY(read_number(line, Q_RANGE, 0, &request->measured.waves.q_maximum));
    TRY(read_number(line, FORCES, above_zero, &request->measured.force_cutoff));
    frames->options.forces = line->own[FORCES] != NULL;
    TRY(read_count(line, BINS, &request->measured.bins));
    TRY(read_weighted(line, &request->measured.weighted));
    TRY(read_count(line, WAVES, &request->measured.waves.waves));
    TRY(read_profile(line, &request->measured));
    TRY(read_choice(line, VELOCITIES, mf_measured_velocities,
                    &request->measured.motion.velocities));
    return read_choice(line, UNITS, mf_units_systems, &request->system);
}

static enum status run(const struct command_line *line) {
    struct measure_request request = {
        .structure = line->own[STRUCTURE],
        .map = line->own[MAP],
        .molecules = line->own[MOLECULES],
        .beads = line->own[BEADS],
        .frames = {.file = line->files,
                   .files = line->file_count,
                   .options = {.units = line->own[FILE_UNITS], .group = line->own[FILE_GROUP]},
                   .begin = NAN,
                   .end = NAN,
                   .allow_truncated = line->own[ALLOW_TRUNCATED] != NULL,
                   .in_any_order = line->own[STATIC] != NULL,
                   .cancel = line->options.stop,
                   .threads = line->options.threads},
        .measured = {.motion = {.leave_out = line->own[STATIC] != NULL,
                                .threads = line->options.threads},
                     .waves = {.q_maximum = NAN},
                     .threads = line->options.threads},
        .temperature = NAN,
        .system = UNITS_NM_PS,
    };
    TRY(read_request(line, &request));
    return mf_measure_run(&request, &line->options);
}

const struct command mf_command_measure = {
    .name = "measure",
    .usage = "TRAJECTORY...",
    .summary = "a target of a simulation of atoms: beads, g(r), motion",
    .min_files = 1,
    .max_files = SIZE_MAX,
    .options = options,
    .run = run,
};
