// SPDX-License-Identifier: GPL-3.0-or-later
//
// What dynamics without walls and thermostat keep: particles, momentum and energy, those of a
// solvent among them, in time. Tested: cli/test_conserved.
#include "base/memory.h"
#include "dynamics/event_driven.h"
#include "dynamics/solvent.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_series.h"

#include <math.h>

enum quantity { STEP, PARTICLES, ENERGY, FLOW, MOMENTUM, QUANTITIES = MOMENTUM + 3 };

struct state {
    struct sample_series series; ///< of QUANTITIES
};

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    (void)settings, (void)simulation, (void)plan;
    *(struct state *)state = (struct state){.series.columns = QUANTITIES};
    return STATUS_OK;
}

static void clear(void *state) {
    mf_sample_series_clear(&((struct state *)state)->series);
}

/// The axes along which there are walls, a bit each: along others nothing can leave the box, and
/// between two lists of pairs beads stand beyond its edge.
static int walls_of(const struct simulation *simulation, const struct solvent *solvent) {
    const struct event_driven *events = mf_event_driven_state(simulation);
    if (solvent)
        return solvent->parameters.walls == COLLISION_PLATES ? 1 << 1 : 0;
    return events ? events->gas.walls : 0;
}

/// Add particles of one kind: how many are in the box, their momentum, energy, and Σ m |v|.
static void add(double here[QUANTITIES], const struct box *box, int walls,
                double *const position[3], double *const velocity[3], const double *mass,
                double usual, size_t count) {
    for (size_t k = 0; k < count; k++) {
        const double m = mass ? mass[k] : usual;
        double square = 0;
        bool inside = true;
        for (int d = 0; d < box->dimensions; d++) {
            const double x = position[d][k], v = velocity[d][k];
            inside = inside && (walls >> d & 1 ? x >= 0 && x <= box->length[d] : isfinite(x));
            here[MOMENTUM + d] += m * v;
            square += v * v;
        }
        here[PARTICLES] += inside;
        here[ENERGY] += 0.5 * m * square;
        here[FLOW] += m * sqrt(square);
    }
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    double here[QUANTITIES] = {[STEP] = (double)simulation->step};
    const struct particles *particles = &simulation->particles;
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    here[ENERGY] = particles->count > 0 ? simulation->sums.energy : 0;
    const int walls = walls_of(simulation, solvent);
    add(here, &particles->box, walls, particles->position, particles->velocity,
        particles_masses(particles), 1, particles->count);
    if (solvent)
        add(here, &particles->box, walls, solvent->position, solvent->velocity, NULL,
            solvent->parameters.mass, solvent->count);
    return mf_sample_series_add(&s->series, here);
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_sample_series_spans(&((struct state *)state)->series, spans);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->series);
}

static const double *column(const struct state *s, int quantity) {
    return sample_series_column(&s->series, (size_t)quantity);
}

/// conserved.tsv: a row for each sample.
static enum status write(const void *state, const struct observable_results *results) {
    enum status status = STATUS_OK;
    const struct state *s = state;
    double *time = NULL;
    char path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(time, s->series.count);
    for (size_t k = 0; k < s->series.count; k++)
        time[k] = column(s, STEP)[k] * results->setup->time_step;
    const struct data_column columns[] = {
        {"step", column(s, STEP), NULL},
        {"time[tau]", time, NULL},
        {"particles[1]", column(s, PARTICLES), "%.0f"},
        {"energy[k_B.T_0]", column(s, ENERGY), "%.17g"},
        {"momentum_x[mu.lambda/tau]", column(s, MOMENTUM), "%.10g"},
        {"momentum_y[mu.lambda/tau]", column(s, MOMENTUM + 1), "%.10g"},
        {"momentum_z[mu.lambda/tau]", column(s, MOMENTUM + 2), "%.10g"}};
    mf_observable_file(results, "conserved.tsv", path);
    status = mf_data_table_write_in(path, results->units, NULL, columns,
                                    4 + (size_t)results->setup->box.dimensions, s->series.count);
done:
    mf_memory_free(time);
    return status;
}

/// The largest change since the first sample.
static double change(const struct state *s, int quantity) {
    const double *values = column(s, quantity);
    double max = 0;
    for (size_t k = 0; k < s->series.count; k++)
        max = fmax(max, fabs(values[k] - values[0]));
    return max;
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    double momentum = 0;
    for (int d = 0; d < results->setup->box.dimensions; d++)
        momentum = fmax(momentum, change(s, MOMENTUM + d));
    mf_json_write_number(writer, "particles_change", change(s, PARTICLES));
    mf_json_write_number(writer, "momentum_change", momentum / column(s, FLOW)[0]);
    mf_json_write_number(writer, "energy_change", change(s, ENERGY) / fabs(column(s, ENERGY)[0]));
}

/// Nanoseconds of a particle.
static const double particle_cost = 3;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)settings;
    mf_stages_add(stages, "conserved", true, particle_cost * simulation_moved(setup) / every,
                  "one step in %.0f", every);
}

static const struct field fields[] = {FIELD_END};
static const char *const files[] = {"conserved.tsv", NULL};

const struct observable mf_conserved = {
    .name = "conserved",
    .summary = "particles, momentum, energy",
    .of_time = true,
    .of_solvent = true,
    .fields = fields,
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sums = true,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .explain = explain,
    .stage = "conserved",
    .files = files,
    .figure = "conserved",
};
