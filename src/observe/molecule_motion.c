// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How far the centres of mass of molecules go, by kind: ⟨|R(s + t) − R(s)|²⟩ and D, its
/// slope over 2d. Positions are unwrapped and, where momentum is conserved, relative to the centre
/// of mass of all particles. Errors as those of observe/motion.h. Tested: cli/test_molecule_motion.

#include "base/memory.h"
#include "base/statistics.h"
#include "forces/molecules.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/motion.h"

_Static_assert(TOPOLOGY_MAX_KINDS *MOTION_SPANS <= OBSERVABLE_MAX_SPANS, "OBSERVABLE_MAX_SPANS");

struct state {
    const struct molecules *molecules;
    size_t max;                               ///< molecules of a kind
    struct motion motion[TOPOLOGY_MAX_KINDS]; ///< of each kind
    double *centres;                          ///< shape [2, dimensions, most]: of a kind
    double together[3];                       ///< centre of mass of all particles [λ]
};

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    enum status status = STATUS_OK;
    struct state *s = state;
    const struct simulation_setup *setup = &simulation->setup;
    *s = (struct state){.molecules = configuration->molecules};
    if (s->molecules == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "molecule_motion: the scene has no molecules");
    const struct topology *topology = &s->molecules->topology;
    for (int k = 0; k < topology->kinds; k++) {
        const size_t count = (size_t)topology->kind[k].count;
        s->max = count > s->max ? count : s->max;
        status = mf_motion_init_points(&s->motion[k], settings, simulation, count,
                                       plan->equilibration, plan->samples * plan->every);
        CHECK(status != STATUS_OK ? mf_status_prefix(status, "molecule_motion") : STATUS_OK);
    }
    NEW_ARRAY(s->centres, 2 * (size_t)setup->box.dimensions * s->max);
done:
    return status;
}

static void clear(void *state) {
    struct state *s = state;
    for (int k = 0; k < TOPOLOGY_MAX_KINDS; k++)
        mf_motion_clear(&s->motion[k]);
    mf_memory_free(s->centres);
    *s = (struct state){0};
}

static int64_t due(const void *state) {
    const struct state *s = state;
    return mf_motion_due(&s->motion[0]);
}

static double unwrapped(const struct particles *particles, size_t k, int d) {
    return particles->position[d][k] + particles->image[d][k] * particles->box.length[d];
}

/// The centre of mass of all particles, which is that of the molecules' frame if momentum is
/// conserved.
static void find_together(struct state *s, const struct particles *particles) {
    const double *mass = particles_masses(particles);
    for (int d = 0; d < particles->box.dimensions && s->motion[0].together; d++) {
        double sum = 0, all = 0;
        for (size_t k = 0; k < particles->count; k++) {
            sum += (mass ? mass[k] : 1) * unwrapped(particles, k, d);
            all += mass ? mass[k] : 1;
        }
        s->together[d] = sum / all;
    }
}

/// Centres of mass of the molecules of a kind.
static void find_centres(struct state *s, const struct particles *particles,
                         const struct topology_kind *kind) {
    const double *mass = particles_masses(particles);
    const size_t count = (size_t)kind->count;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t m = 0; m < count; m++) {
            double sum = 0, all = 0;
            for (int bead = 0; bead < kind->beads; bead++) {
                const size_t k = particles->place[topology_id(kind, (int64_t)m, bead)];
                sum += (mass ? mass[k] : 1) * unwrapped(particles, k, d);
                all += mass ? mass[k] : 1;
            }
            s->centres[(size_t)d * count + m] = sum / all - s->together[d];
        }
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const struct topology *topology = &s->molecules->topology;
    find_together(s, &simulation->particles);
    for (int k = 0; k < topology->kinds; k++) {
        find_centres(s, &simulation->particles, &topology->kind[k]);
        mf_motion_add(&s->motion[k], s->centres, 1);
    }
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    size_t n = 0;
    for (int k = 0; k < s->molecules->topology.kinds; k++)
        n += mf_motion_spans(&s->motion[k], spans + n);
    return n;
}

// Results -----------------------------------------------------------------------------------------

enum { MAX_COLUMNS = 1 + 2 * TOPOLOGY_MAX_KINDS, HEAD_SIZE = TOPOLOGY_NAME_SIZE + 32 };

/// molecule_motion.tsv: time, MSD and error of each kind.
static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    const struct topology *topology = &s->molecules->topology;
    const struct motion *first = &s->motion[0];
    const size_t rows = (size_t)first->plan.lags + 1, kinds = (size_t)topology->kinds;
    struct data_column columns[MAX_COLUMNS];
    char names[MAX_COLUMNS][HEAD_SIZE];
    OWNED double *values = NULL;
    size_t n = 0;
    TRY_ARRAY(values, (1 + 4 * kinds) * rows);
    for (size_t k = 0; k < rows; k++)
        values[k] = (double)k * (double)first->plan.every * first->time_step;
    columns[n++] = (struct data_column){"time[tau]", values, NULL};
    for (size_t k = 0; k < kinds; k++) {
        double *own = values + (1 + 4 * k) * rows;
        mf_motion_result(&s->motion[k],
                         &(struct motion_curves){own, own + rows, own + 2 * rows, own + 3 * rows});
        mf_statistics_mark_unknown_errors(own + rows, rows);
        for (size_t which = 0; which < 2; which++) {
            snprintf(names[n], HEAD_SIZE, "%s%s[lambda^2]", topology->kind[k].name,
                     which == 0 ? "" : "_error");
            columns[n] =
                (struct data_column){names[n], own + which * rows, which == 0 ? "%.8g" : "%.3g"};
            n++;
        }
    }
    return mf_observable_table(results, "molecule_motion.tsv", columns, n, rows);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    char early[MOTION_EARLY_SIZE];
    (void)results;
    mf_json_begin(writer, "molecule_motion");
    for (int k = 0; k < s->molecules->topology.kinds; k++) {
        struct motion_summary found = mf_motion_result(&s->motion[k], NULL);
        mf_statistics_mark_unknown_errors(&found.msd_error, 1);
        mf_json_begin(writer, s->molecules->topology.kind[k].name);
        if (mf_motion_is_early(&found))
            mf_json_write_text(writer, "warning", mf_motion_early_text(&found, early));
        mf_json_put_measured(writer, "diffusion", "lambda^2/tau", found.msd, found.msd_error);
        mf_json_write_quantity(writer, "fit_begin", "tau", found.fit_begin);
        mf_json_write_quantity(writer, "fit_end", "tau", found.fit_end);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

/// D of the first kind.
static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    const struct motion_summary found = mf_motion_result(&s->motion[0], NULL);
    char text[UNITS_MEASURED_SIZE], early[MOTION_EARLY_SIZE];
    snprintf(line, size, "%s: D = %s of the centres of mass%s%s",
             s->molecules->topology.kind[0].name,
             mf_units_measured(results->units, "lambda^2/tau", found.msd, found.msd_error, text),
             mf_motion_is_early(&found) ? "; " : "", mf_motion_early_text(&found, early));
}

/// Nanoseconds of a bead and sample, and of a molecule and time origin.
static const double gather_cost = 10, correlate_cost = 1.3;

static void explain(const void *settings, const struct simulation_setup *setup,
                    double samples_every, struct stages *stages) {
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const struct motion_plan *plan = settings;
    const double every = (double)plan->every, count = (double)setup->placement.count;
    const double share = molecules ? (double)molecules->topology.molecules / count : 0;
    const double origins = (double)plan->lags / (double)plan->origin_every + 1;
    (void)samples_every;
    mf_stages_add(stages, "diffusion of molecules", true,
                  (gather_cost + correlate_cost * origins * share) / every,
                  "%.0f time origins, one step in %.0f", origins, every);
}

static const char *const files[] = {"molecule_motion.tsv", NULL};

const struct observable mf_molecule_motion = {
    .name = "molecule_motion",
    .summary = "diffusion of the molecules' centres of mass",
    .of_time = true,
    .fields = mf_motion_plan_fields,
    .settings_size = sizeof(struct motion_plan),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .due = due,
    .sample = sample,
    .spans = spans,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "diffusion of molecules",
    .files = files,
    .figure = OBSERVABLE_FIGURE_OF_GROUPS,
};
