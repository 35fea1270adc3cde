// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapshots of a simulation: files while it runs, at steps of their own. A run that was resumed
// leaves the files of one that was not.
#include "base/memory.h"
#include "dynamics/simulation_look.h"
#include "dynamics/solvent.h"
#include "io/configuration.h"
#include "trajectory/snapshot.h"
#include "observe/measure.h"

#define SOLVENT_FILE "solvent.tsv"

struct settings {
    int64_t every;
    int formats; ///< a bit each
    int solvent; ///< 0 or 1: show it
};

struct state {
    struct settings settings;
    struct observable_results results;
    int64_t begin, steps; ///< of the measurement
    int64_t taken;
    int64_t size[SNAPSHOT_FORMATS];  ///< of the file of all snapshots of a format [bytes]
    struct snapshot last;            ///< or the state before the first
    const struct topology *topology; ///< of the simulation, or NULL
};

/// The forces are those of the potentials at the positions beside them, whatever an integrator
/// keeps.
static enum status take(struct state *s, const struct simulation *simulation) {
    struct simulation look;
    const double time = (double)simulation->step * simulation->setup.time_step;
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    struct snapshot_solvent_particles solvent_particles = {.name = "solvent"};
    if (s->settings.solvent) {
        solvent_particles.count = solvent->count;
        solvent_particles.position = solvent->position;
        solvent_particles.velocity = solvent->velocity;
        solvent_particles.mass = solvent->parameters.mass;
    }
    mf_snapshot_clear(&s->last);
    TRY(mf_simulation_look(simulation, &look));
    const enum status status =
        mf_snapshot_take(&s->last, &look.particles, &simulation->setup.composition,
                         s->settings.solvent ? &solvent_particles : NULL, simulation->step, time);
    mf_simulation_clear(&look);
    return status;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    *s = (struct state){.settings = *(const struct settings *)settings,
                        .begin = plan->equilibration,
                        .steps = plan->samples * plan->every,
                        .topology = simulation->particles.topology};
    if (s->settings.solvent && mf_collision_dynamics_solvent(simulation) == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "snapshots.solvent: %s has no solvent; use \"collision-dynamics\", "
                              "or leave the key out",
                              simulation->setup.integrator->name);
    if (!s->settings.solvent && simulation->particles.count == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "snapshots: no particles; \"solvent\": \"yes\" includes the solvent");
    return take(s, simulation);
}

static void clear(void *state) {
    struct state *s = state;
    mf_snapshot_clear(&s->last);
    *s = (struct state){0};
}

static void open_folder(void *state, const struct observable_results *results) {
    ((struct state *)state)->results = *results;
}

static int64_t due(const void *state) {
    const struct state *s = state;
    const int64_t next = s->taken * s->settings.every;
    return next > s->steps ? INT64_MAX : s->begin + next;
}

static enum status write_formats(struct state *s) {
    char folder[OUTPUT_PATH_SIZE];
    CLEARED_BY(mf_snapshot_clear) struct snapshot converted = {0};
    mf_observable_file(&s->results, SNAPSHOT_FOLDER, folder);
    for (int angstrom = 0; angstrom < 2; angstrom++) {
        TRY(mf_snapshot_translate(&converted, &s->last, s->results.units, angstrom));
        converted.number = (size_t)s->taken;
        for (int k = 0; mf_snapshot_formats[k]; k++)
            if (s->settings.formats >> k & 1 && mf_snapshot_formats[k]->angstrom == angstrom)
                TRY(mf_snapshot_write(&converted, mf_snapshot_formats[k], folder, &s->size[k]));
    }
    return STATUS_OK;
}

/// Whether a scene can give particles this column at the start.
static bool is_given(const struct snapshot_column *column) {
    for (int k = 0; k < ATTRIBUTES_NAMES; k++)
        if (strcmp(column->name, mf_attributes_fields[k].name) == 0)
            return true;
    return strcmp(column->name, "position") == 0 || strcmp(column->name, "velocity") == 0;
}

/// solvent.tsv: where the solvent's particles are in the last snapshot.
static enum status write_solvent(const struct snapshot *snapshot,
                                 const struct observable_results *results) {
    struct data_column columns[3];
    char names[3][SNAPSHOT_NAME_SIZE + 16], path[OUTPUT_PATH_SIZE];
    const struct snapshot_column *position = snapshot->column;
    while (strcmp(position->name, "position") != 0)
        position++;
    for (int c = 0; c < position->components; c++) {
        char name[SNAPSHOT_NAME_SIZE];
        mf_snapshot_component_name(position, c, name);
        snprintf(names[c], sizeof names[c], "%s[%s]", name, mf_snapshot_unit(position));
        columns[c] = (struct data_column){
            names[c], position->values + (size_t)c * snapshot->count + snapshot->own, "%.6g"};
    }
    mf_observable_file(results, SOLVENT_FILE, path);
    return mf_data_table_write_in(path, results->units, NULL, columns, (size_t)position->components,
                                  snapshot->count - snapshot->own);
}

/// configuration.tsv: the last snapshot as a placement file, with which another scene can begin.
static enum status write(const void *state, const struct observable_results *results) {
    enum { MAX = 3 * SNAPSHOT_MAX_COLUMNS };
    const struct state *s = state;
    const struct snapshot *snapshot = &s->last;
    if (snapshot->count > snapshot->own)
        TRY(write_solvent(snapshot, results));
    struct data_column columns[MAX];
    char names[MAX][SNAPSHOT_NAME_SIZE + 16], path[OUTPUT_PATH_SIZE], bonds[OUTPUT_PATH_SIZE];
    size_t n = 0;
    if (snapshot->own == 0)
        return STATUS_OK; // a solvent starts no scene
    for (int k = 0; k < snapshot->columns; k++) {
        const char *unit = mf_snapshot_unit(&snapshot->column[k]);
        for (int c = 0; c < snapshot->column[k].components && is_given(&snapshot->column[k]); c++) {
            char name[SNAPSHOT_NAME_SIZE];
            mf_snapshot_component_name(&snapshot->column[k], c, name);
            // Attributes are reduced, and say nothing of it.
            if (snapshot->column[k].components > 1)
                snprintf(names[n], sizeof names[n], "%s[%s]", name, unit);
            else
                mf_data_table_name(results->units, name, unit, names[n], sizeof names[n]);
            columns[n] = (struct data_column){
                names[n], snapshot->column[k].values + (size_t)c * snapshot->count, "%.17g"};
            n++;
        }
    }
    mf_observable_file(results, CONFIGURATION_FILE, path);
    mf_observable_file(results, CONFIGURATION_BONDS_FILE, bonds);
    return mf_configuration_write(path, bonds, results->units, snapshot->composition, s->topology,
                                  columns, n, snapshot->own);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    TRY(take(s, simulation));
    TRY(write_formats(s));
    s->taken++;
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    spans[0] = (struct memory_span){&s->taken, sizeof s->taken};
    spans[1] = (struct memory_span){s->size, sizeof s->size};
    spans[2] = (struct memory_span){s->last.memory, s->last.numbers * sizeof *s->last.memory};
    return 3;
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    (void)results;
    mf_json_write_number(writer, "snapshots", (double)((const struct state *)state)->taken);
}

static bool has_format(const struct state *s, const struct snapshot_format *format) {
    bool has = false;
    for (int k = 0; mf_snapshot_formats[k]; k++)
        has = has || (mf_snapshot_formats[k] == format && s->settings.formats >> k & 1);
    return has;
}

/// Where they are; of .xtc, which has positions alone, also what tells the types.
static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    char folder[OUTPUT_PATH_SIZE];
    mf_observable_file(results, SNAPSHOT_FOLDER, folder);
    const int length =
        snprintf(line, size, "%lld snapshots in %.150s", (long long)s->taken, folder);
    if (!has_format(s, &mf_format_xtc_snapshot))
        return;
    if (has_format(s, &mf_format_lammps_dump_snapshot))
        snprintf(line + length, size - (size_t)length,
                 "; there: mesofit measure trajectory.xtc -s trajectory.lammpstrj");
    else
        snprintf(
            line + length, size - (size_t)length,
            "; trajectory.xtc has no types: for measure -s add \"lammps-dump\" to \"formats\"");
}

/// Nanoseconds of a particle in a snapshot and format.
static const double write_cost = 1500;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const struct settings *s = settings;
    const double shown =
        s->solvent ? simulation_moved(setup) / fmax(1, (double)setup->placement.count) : 1;
    int formats = 0;
    (void)every;
    for (int k = 0; mf_snapshot_formats[k]; k++)
        formats += s->formats >> k & 1;
    mf_stages_add(stages, "snapshots", true, write_cost * formats * shown / (double)s->every,
                  "%d formats, one step in %lld", formats, (long long)s->every);
}

static const char *const no_or_yes[] = {"no", "yes", NULL};

static const struct field fields[] = {
    {"every", FIELD_INTEGER, offsetof(struct settings, every), .required = true, .minimum = 1,
     .maximum = 1e9, .unit = "steps", .help = "interval between snapshots"},
    {"formats", FIELD_CHOICES, offsetof(struct settings, formats), .initial = 1,
     .choices = mf_snapshot_format_names, .unit = "",
     .help = "ParaView, JSON (also for \"placement\"), extended XYZ, LAMMPS dump, GSD, XTC"},
    {"solvent", FIELD_CHOICE, offsetof(struct settings, solvent), .choices = no_or_yes,
     .initial = 0, .unit = "",
     .help = "include the solvent of collision-dynamics, as the last type"},
    FIELD_END,
};

static const char *const files[] = {CONFIGURATION_FILE, SOLVENT_FILE, NULL};

const struct observable mf_snapshots = {
    .name = "snapshots",
    .of_solvent = true, // if it is to be shown
    .summary =
        "files of positions, velocities, conservative forces and attributes of all particles",
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .open = open_folder,
    .due = due,
    .sample = sample,
    .spans = spans,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "snapshots",
    .files = files,
    .figure = "configuration",
};
