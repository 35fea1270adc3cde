// SPDX-License-Identifier: GPL-3.0-or-later
//
// How dense it is around a place: particles in cells of a grid over the box, as a histogram of
// their numbers. Where a fluid has come apart into two phases the histogram has two peaks. G. S.
// Redner, M. F. Hagan and A. Baskaran, Phys. Rev. Lett. 110, 055701 (2013). Tested:
// test_clusters.
#include "base/memory.h"
#include "io/data_table.h"
#include "observe/measure.h"

struct settings {
    double cell, diameter;
};

struct state {
    struct settings settings;
    int cells[3];
    size_t total, count, samples;
    double volume;     ///< of a cell [λ^d]
    double body;       ///< of a particle
    uint32_t *members; ///< shape [total]
    double *histogram; ///< shape [count + 1]: cells with so many particles, over all samples
};

static void clear(void *state) {
    struct state *s = state;
    mf_memory_free(s->members);
    mf_memory_free(s->histogram);
    *s = (struct state){0};
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const struct box *box = &simulation->setup.box;
    (void)plan;
    *s = (struct state){.settings = *(const struct settings *)settings,
                        .cells = {1, 1, 1},
                        .total = 1,
                        .count = simulation->particles.count};
    const double max = 4 * (double)s->count + 64;
    double total = 1;
    for (int d = 0; d < box->dimensions; d++) {
        const double fit = fmax(1, round(box->length[d] / s->settings.cell));
        total *= fit;
        s->cells[d] = (int)fmin(fit, max);
    }
    if (total > max)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "local_density.cell: %g" STATUS_LENGTH
                              " gives %.3g cells for %zu particles",
                              s->settings.cell, total, s->count);
    s->total = (size_t)total;
    s->volume = mf_box_volume(box) / total;
    const double radius = 0.5 * s->settings.diameter;
    s->body = mf_box_shell_volume(box, 0, radius);
    TRY_ARRAY(s->members, s->total);
    TRY_ARRAY(s->histogram, s->count + 1);
    return STATUS_OK;
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const struct particles *particles = &simulation->particles;
    memset(s->members, 0, s->total * sizeof *s->members);
    for (size_t k = 0; k < particles->count; k++) {
        size_t cell = 0;
        for (int d = 0; d < particles->box.dimensions; d++) {
            const double share = particles->position[d][k] / particles->box.length[d];
            cell =
                cell * (size_t)s->cells[d] + (size_t)cells_along(share - floor(share), s->cells[d]);
        }
        s->members[cell]++;
    }
    for (size_t cell = 0; cell < s->total; cell++)
        s->histogram[s->members[cell]]++;
    s->samples++;
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    spans[0] = (struct memory_span){&s->samples, sizeof s->samples};
    spans[1] = (struct memory_span){s->histogram, (s->count + 1) * sizeof *s->histogram};
    return 2;
}

/// local_density.tsv: particles in a cell, density, packing fraction if the particles have a size,
/// and the share of the cells.
static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    OWNED double *values = NULL;
    size_t rows = s->count + 1;
    TRY_ARRAY(values, 4 * rows);
    double *number = values, *density = number + rows, *packing = density + rows,
           *share = packing + rows;
    while (rows > 1 && s->histogram[rows - 1] == 0)
        rows--;
    for (size_t k = 0; k < rows; k++) {
        number[k] = (double)k;
        density[k] = number[k] / s->volume;
        packing[k] = density[k] * s->body;
        share[k] = s->histogram[k] / ((double)s->total * (double)s->samples);
    }
    const struct data_column columns[] = {{"number[1]", number, "%.0f"},
                                          {"density[1/lambda^d]", density, "%.6g"},
                                          {"share[1]", share, "%.6g"},
                                          {"packing[1]", packing, "%.6g"}};
    return mf_observable_table(results, "local_density.tsv", columns,
                               s->settings.diameter > 0 ? 4 : 3, rows);
}

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    char text[STAGES_LENGTH_SIZE];
    (void)setup;
    mf_stages_add(stages, "local density", true, 10 / every, "cells of %s, one step in %.0f",
                  mf_stages_length(stages, ((const struct settings *)settings)->cell, 3, text),
                  every);
}

#define MEMBER(name) .offset = offsetof(struct settings, name)
static const struct field fields[] = {
    {"cell", FIELD_NUMBER, MEMBER(cell), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda", .help = "approximate edge of a cell"},
    {"diameter", FIELD_NUMBER, MEMBER(diameter), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "diameter of a particle, for the packing fraction; 0: none"},
    FIELD_END,
};
static const char *const files[] = {"local_density.tsv", NULL};

const struct observable mf_local_density = {
    .name = "local_density",
    .summary = "histogram of the density in cells of the box",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .explain = explain,
    .stage = "local density",
    .files = files,
    .figure = "local_density",
};
