// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/flow_field.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "dynamics/solvent.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_series.h"
#include "observe/stream_function.h"

#include <math.h>

struct settings {
    double spacing;
};

/// Of a sample, along x: the mean velocity of all, and the drag since the last; the first drag is
/// not known.
enum { VELOCITY, DRAG, NUMBERS };

struct flow_field {
    struct simulation_setup setup; ///< with the parameters of the solvent
    struct collision_dynamics_parameters parameters;
    struct box box;
    size_t bins[2];
    double mass;                ///< of the solvent and its beads
    double width[2], thickness; ///< of a bin; of the slice, 0 in two dimensions
    double every;               ///< steps between samples
    struct sample_series series;
    double *sums;  ///< shape [bins y, bins x, 3]: Σ 1, Σ v
    int64_t given; ///< at the last sample, in SOLVENT_IMPULSE
};

static const struct field fields[] = {
    {"spacing", FIELD_NUMBER, offsetof(struct settings, spacing), .initial = 1,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "lambda",
     .help = "approximate spacing of points"},
    FIELD_END,
};

/// Of all beads.
static double mass_of(const struct particles *beads) {
    const double *masses = particles_masses(beads);
    double sum = 0;
    for (size_t k = 0; k < beads->count; k++)
        sum += masses ? masses[k] : 1;
    return sum;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    const struct settings *given = settings;
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    struct flow_field *f = state;
    if (solvent == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "flow_field: %s has no solvent; use \"collision-dynamics\"",
                              simulation->setup.integrator->name);
    f->setup = simulation->setup;
    f->parameters = solvent->parameters;
    f->setup.integrator_parameters = &f->parameters;
    f->box = solvent->box;
    f->mass = f->parameters.mass * (double)solvent->count + mass_of(&simulation->particles);
    for (int d = 0; d < 2; d++) {
        f->bins[d] = (size_t)fmin(fmax(1, rint(f->box.length[d] / given->spacing)), 1e4);
        f->width[d] = f->box.length[d] / (double)f->bins[d];
    }
    f->thickness = f->box.dimensions == 3 ? f->width[0] : 0;
    f->series.columns = NUMBERS;
    f->every = (double)plan->every;
    TRY_ARRAY(f->sums, 3 * f->bins[0] * f->bins[1]);
    return STATUS_OK;
}

static void clear(void *state) {
    struct flow_field *f = state;
    mf_memory_free(f->sums);
    mf_sample_series_clear(&f->series);
    *f = (struct flow_field){0};
}

static bool is_in_slice(const struct flow_field *f, double z) {
    const double centre = f->parameters.obstacle_centre[2];
    return fabs(box_nearest(z - centre, f->box.length[2])) < 0.5 * f->thickness;
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct flow_field *f = state;
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    double along = 0;
    for (size_t k = 0; k < solvent->count; k++) {
        const double vx = solvent->velocity[0][k];
        along += vx;
        if (f->thickness > 0 && !is_in_slice(f, solvent->position[2][k]))
            continue;
        size_t bin[2];
        for (int d = 0; d < 2; d++) {
            const double place = solvent->position[d][k] / f->width[d];
            bin[d] = place < (double)f->bins[d] ? (size_t)fmax(0, place) : f->bins[d] - 1;
        }
        double *sum = f->sums + 3 * (bin[1] * f->bins[0] + bin[0]);
        sum[0] += 1;
        sum[1] += vx;
        sum[2] += solvent->velocity[1][k];
    }
    const double time = f->every * f->setup.time_step;
    const double numbers[NUMBERS] = {along / (double)solvent->count,
                                     (double)(solvent->given[0] - f->given) * SOLVENT_IMPULSE /
                                         time};
    f->given = solvent->given[0];
    return mf_sample_series_add(&f->series, numbers);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct flow_field *f = state;
    size_t n = mf_sample_series_spans(&f->series, spans);
    spans[n++] = (struct memory_span){&f->given, sizeof f->given};
    spans[n++] = (struct memory_span){f->sums, 3 * f->bins[0] * f->bins[1] * sizeof *f->sums};
    return n;
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct flow_field *)state)->series);
}

// Results -----------------------------------------------------------------------------------------

struct flow_tables {
    double *x, *y, *vx, *vy, *density, *vorticity, *stream; ///< shape [bins y, bins x]
};

static size_t at(const struct flow_field *f, size_t i, size_t j) {
    return j * f->bins[0] + i;
}

/// Central differences, one-sided next to plates.
static double find_vorticity(const struct flow_field *f, const struct flow_tables *t, size_t i,
                             size_t j) {
    const size_t nx = f->bins[0], ny = f->bins[1];
    const bool plates = f->parameters.walls == COLLISION_PLATES;
    const size_t below = j > 0 ? j - 1 : plates ? 0 : ny - 1;
    const size_t above = j + 1 < ny ? j + 1 : plates ? ny - 1 : 0;
    const double rows = plates && (j == 0 || j + 1 == ny) ? 1 : 2;
    return (t->vy[at(f, (i + 1) % nx, j)] - t->vy[at(f, (i + nx - 1) % nx, j)]) /
               (2 * f->width[0]) -
           (t->vx[at(f, i, above)] - t->vx[at(f, i, below)]) / (rows * f->width[1]);
}

/// Velocities are 0 where nobody is; the stream function ψ, v_x ρ = ∂ψ/∂y, v_y ρ = −∂ψ/∂x, relative
/// to the mean density, counts flow between plates from the lower one to the middle of a bin.
static enum status find_tables(const struct flow_field *f, const struct flow_tables *t,
                               double *flow_x, double *flow_y) {
    const double whole = f->thickness > 0 ? f->thickness : 1;
    const double volume = f->width[0] * f->width[1] * whole * fmax(1, (double)f->series.count);
    const double mean =
        f->parameters.particles_per_cell / pow(f->parameters.cell, f->box.dimensions);
    for (size_t i = 0; i < f->bins[0]; i++) {
        double stream = 0;
        for (size_t j = 0; j < f->bins[1]; j++) {
            const size_t n = at(f, i, j);
            const double *sum = f->sums + 3 * n;
            t->x[n] = ((double)i + 0.5) * f->width[0];
            t->y[n] = ((double)j + 0.5) * f->width[1];
            t->vx[n] = sum[0] > 0 ? sum[1] / sum[0] : 0;
            t->vy[n] = sum[0] > 0 ? sum[2] / sum[0] : 0;
            t->density[n] = sum[0] / volume;
            flow_x[n] = sum[1] / volume / mean;
            flow_y[n] = sum[2] / volume / mean;
            t->stream[n] = stream + 0.5 * flow_x[n] * f->width[1];
            stream += flow_x[n] * f->width[1];
        }
    }
    for (size_t j = 0; j < f->bins[1]; j++)
        for (size_t i = 0; i < f->bins[0]; i++)
            t->vorticity[at(f, i, j)] = find_vorticity(f, t, i, j);
    return f->parameters.walls == COLLISION_PLATES
               ? STATUS_OK
               : mf_stream_function(t->stream, flow_x, flow_y, f->bins, f->width);
}

static enum status write(const void *state, const struct observable_results *results) {
    const struct flow_field *f = state;
    const size_t rows = f->bins[0] * f->bins[1];
    OWNED double *values = NULL;
    TRY_ARRAY(values, 9 * rows);
    const struct flow_tables t = {values,
                                  values + rows,
                                  values + 2 * rows,
                                  values + 3 * rows,
                                  values + 4 * rows,
                                  values + 5 * rows,
                                  values + 6 * rows};
    TRY(find_tables(f, &t, values + 7 * rows, values + 8 * rows));
    const struct data_column columns[] = {{"x[lambda]", t.x, NULL},
                                          {"y[lambda]", t.y, NULL},
                                          {"v_x[lambda/tau]", t.vx, "%.5g"},
                                          {"v_y[lambda/tau]", t.vy, "%.5g"},
                                          {"density[1/lambda^d]", t.density, "%.5g"},
                                          {"vorticity[1/tau]", t.vorticity, "%.5g"},
                                          {"stream_function[lambda^2/tau]", t.stream, "%.6g"}};
    return mf_observable_table(results, "flow_field.tsv", columns, 7, rows);
}

/// Mean of a series and its error.
static double average(const double *values, size_t count, double *error) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += values[k];
    *error = mf_statistics_correlated_error(values, count, 1);
    mf_statistics_mark_unknown_errors(error, 1);
    return count > 0 ? sum / (double)count : NAN;
}

struct flow_field_summary mf_flow_field_result(const void *state) {
    const struct flow_field *f = state;
    const double radius = f->parameters.obstacle_radius;
    const double density = f->parameters.mass * f->parameters.particles_per_cell /
                           pow(f->parameters.cell, f->box.dimensions);
    const double area = f->box.dimensions == 2 ? 2 * radius : M_PI * radius * radius;
    const size_t samples = f->series.count, intervals = samples > 0 ? samples - 1 : 0;
    const double *velocity = sample_series_column(&f->series, VELOCITY);
    const double *drag = sample_series_column(&f->series, DRAG);
    struct flow_field_summary found;
    found.velocity = average(velocity, samples, &found.velocity_error);
    found.drag = average(samples > 0 ? drag + 1 : NULL, intervals, &found.drag_error);
    found.driving_force = f->mass * f->parameters.acceleration[0];
    // What does not differ from 0 is no flow, and what it would be divided by is noise.
    const bool flows = fabs(found.velocity) > 3 * found.velocity_error;
    found.coefficient =
        flows ? found.drag / (0.5 * density * found.velocity * found.velocity * area) : NAN;
    found.reynolds = 2 * radius * fabs(found.velocity) / mf_collision_dynamics_viscosity(&f->setup);
    return found;
}

/// The object "flow_field"; of an obstacle the drag, beside the force on the whole solvent.
static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct flow_field *f = state;
    const struct flow_field_summary found = mf_flow_field_result(f);
    (void)results;
    mf_json_begin(writer, "flow_field");
    if (f->parameters.wave_acceleration == 0) { // whose noise lets the whole solvent wander
        mf_json_put_measured(writer, "mean_velocity", "lambda/tau", found.velocity,
                             found.velocity_error);
    }
    if (f->parameters.obstacle_radius > 0) {
        mf_json_put_measured(writer, "drag", "k_B T_0/lambda", found.drag, found.drag_error);
        mf_json_write_quantity(writer, "driving_force", "k_B T_0/lambda", found.driving_force);
        mf_json_write_number(writer, "drag_coefficient", found.coefficient);
        mf_json_write_number(writer, "reynolds_number", found.reynolds);
    }
    mf_json_end(writer);
}

/// Nanoseconds of a solvent particle and sample.
static const double sample_cost = 6;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)settings;
    mf_stages_add(stages, "flow field", true,
                  sample_cost * simulation_moved(setup) / fmax(1, (double)setup->placement.count) /
                      every,
                  "one step in %.0f", every);
}

static const char *const files[] = {"flow_field.tsv", NULL};

const struct observable mf_flow_field = {
    .name = "flow_field",
    .summary = "flow of the solvent in the plane, and the drag on an obstacle",
    .of_time = true,
    .of_solvent = true,
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct flow_field),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .explain = explain,
    .stage = "flow field",
    .files = files,
    .figure = "flow_field",
};
