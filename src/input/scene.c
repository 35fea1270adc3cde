// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/scene.h"

#include "base/digest.h"
#include "base/memory.h"
#include "base/names.h"
#include "io/data_table.h"

#include <math.h>

/// The members of a scene that stand at its top.
struct top {
    int64_t dimensions;
    double box[3];
    double temperature, time_step, skin, temperature_limit;
    int precision;
};

static const char *const precisions[] = {"mixed", "double", NULL}; // enum pair_precision

/// Positions are known to 2^-32 of the box: 2e-4 lambda in the largest.
#define LARGEST_BOX 1e6

#define MEMBER(name) .offset = offsetof(struct top, name)
const struct field mf_scene_fields[] = {
    {"dimensions", FIELD_INTEGER, MEMBER(dimensions), .initial = 3, .minimum = 2, .maximum = 3,
     .unit = "", .help = "of space"},
    {"box", FIELD_LENGTHS, MEMBER(box), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = LARGEST_BOX, .unit = "lambda", .help = "edges of the periodic box"},
    {"temperature", FIELD_NUMBER, MEMBER(temperature), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "T_0", .help = "of the first velocities and of the noise"},
    {"time_step", FIELD_NUMBER, MEMBER(time_step), .initial = 0.01, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "tau", .help = "of the integrator"},
    {"skin", FIELD_NUMBER, MEMBER(skin), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda",
     .help = "of the neighbour list: changes speed, not results; 0: the program chooses"},
    {"temperature_limit", FIELD_NUMBER, MEMBER(temperature_limit), .initial = 20, .minimum = 1,
     .maximum = DBL_MAX, .unit = "",
     .help = "a kinetic temperature above this multiple of the "
             "temperature ends the simulation as unstable"},
    {"precision", FIELD_CHOICE, MEMBER(precision), .choices = precisions, .initial = PAIR_MIXED,
     .unit = "",
     .help = "of the arithmetic of a pair; positions, velocities and sums are in double always"},
    FIELD_END,
};

static void check_omega(const struct scene *scene, struct json_object *object) {
    const struct table *table = &scene->omega.table;
    for (int row = 0; row < table->curves * (TABLE_INTERVALS + 1); row++)
        if (table->coefficient[2 * row] < 0) {
            const int pair = row / (TABLE_INTERVALS + 1), k = row % (TABLE_INTERVALS + 1);
            mf_json_fault(object, "dissipative", "omega is negative at r = %g",
                          k / mf_table_inverse_spacing(table, pair));
            return;
        }
}

static void read_top(struct scene *scene, struct json_object *object) {
    struct top top;
    mf_json_fields(object, mf_scene_fields, &top);
    struct simulation_setup *setup = &scene->setup;
    setup->box.dimensions = (int)top.dimensions;
    for (int d = 0; d < 3; d++)
        setup->box.length[d] = d < top.dimensions ? top.box[d] : 1;
    if (top.box[0] > 0 && (top.box[2] > 0) != (top.dimensions == 3))
        mf_json_fault(object, "box",
                      "has %d edges, but the scene has %d dimensions; \"dimensions\" says how many",
                      top.box[2] > 0 ? 3 : 2, (int)top.dimensions);
    setup->temperature = top.temperature;
    setup->time_step = top.time_step;
    setup->skin = top.skin;
    setup->temperature_limit = top.temperature_limit;
    setup->precision = top.precision;
    setup->threads = 1;
}

NAMED_RECORD(struct integrator);

static void fault_lonely(const struct scene *scene, struct json_object *object) {
    struct json_object particles = mf_json_child(object, "particles", false);
    if (particles.item && mf_json_has(&particles, "count") &&
        mf_json_fault_count(object->document) == 0)
        mf_json_fault(&particles, "count", "%lld is out of range; allowed: 2 to 1e+08",
                      (long long)scene->setup.placement.count);
}

static enum status read_dynamics(struct scene *scene, struct json_object *object, int unknown) {
    const char **names;
    TRY(mf_names_collect(mf_integrator_list, NULL, &names));
    struct json_object dynamics = mf_json_child_of(object, "dynamics", false, "integrator");
    const bool dissipative = scene->omega.curves > 0 || (unknown & SCENE_FITS_OMEGA);
    const char *name = dissipative ? mf_aboba.name : mf_velocity_verlet.name;
    if (dynamics.item)
        name = mf_json_choice(&dynamics, "integrator", names, name);
    mf_memory_free(names);
    if (name == NULL)
        return STATUS_OK;
    const struct integrator *integrator = mf_names_find(mf_integrator_list, name);
    scene->setup.integrator = integrator;
    if (integrator->parameters_size > 0) {
        scene->integrator_parameters = mf_memory_zeroed(1, integrator->parameters_size);
        if (scene->integrator_parameters == NULL)
            return STATUS_NO_MEMORY;
    }
    mf_json_fields(&dynamics, integrator->fields, scene->integrator_parameters);
    scene->setup.integrator_parameters = scene->integrator_parameters;
    if (dynamics.item)
        mf_json_finish(&dynamics);
    if (scene->setup.placement.count < 2 && integrator->companions == NULL)
        fault_lonely(scene, object);
    if (dissipative && !integrator->dissipative)
        mf_json_fault(object, "dynamics",
                      "%s knows no friction; use \"aboba\" with \"dissipative\"", integrator->name);
    return STATUS_OK;
}

/// Coordinates may be unwrapped, but so far outside they are in other units, as nm and pm.
static const double most_boxes = 100;

/// Whether all coordinates of a file are within most_boxes of the box; tells of the first that is
/// not.
static bool are_near(const struct scene *scene, const struct data_table *table,
                     struct json_object *particles) {
    const struct box *box = &scene->setup.box;
    for (size_t k = 0; k < table->rows; k++)
        for (int d = 0; d < box->dimensions; d++) {
            const double x = table->values[k * table->columns + (size_t)d];
            if (fabs(x) <= most_boxes * box->length[d])
                continue;
            mf_json_fault(
                particles, "file",
                "%s:%zu: the coordinate %g is more than %g boxes of %g away; are the units "
                "those of \"box\"?",
                scene->setup.placement.file, table->line[k], x, most_boxes, box->length[d]);
            return false;
        }
    return true;
}

/// Columns x, y (, z) and, if there are as many again, the velocities.
static enum status read_positions(struct scene *scene, struct json_object *particles) {
    const struct placement *placement = &scene->setup.placement;
    const size_t dimensions = (size_t)scene->setup.box.dimensions;
    struct data_table table = {0};
    enum status status = mf_data_table_read(&table, placement->file, dimensions);
    if (status != STATUS_OK) {
        mf_json_fault(particles, "file", "%s", mf_status_message());
        return status == STATUS_NO_MEMORY ? status : STATUS_OK;
    }
    if (table.rows != (size_t)placement->count ||
        (table.columns != dimensions && table.columns != 2 * dimensions)) {
        mf_json_fault(particles, "file", "%s: %zu rows of %zu numbers, not %lld of %zu or %zu",
                      placement->file, table.rows, table.columns, (long long)placement->count,
                      dimensions, 2 * dimensions);
        goto done;
    }
    if (!are_near(scene, &table, particles))
        goto done;
    NEW_ARRAY(scene->start_values, table.rows * table.columns);
    for (size_t column = 0; column < table.columns; column++) {
        double *values = scene->start_values + column * table.rows;
        for (size_t k = 0; k < table.rows; k++)
            values[k] = table.values[k * table.columns + column];
        if (column < dimensions)
            scene->start.position[column] = values;
        else
            scene->start.velocity[column - dimensions] = values;
    }
done:
    mf_data_table_clear(&table);
    return status;
}

static void read_count(struct scene *scene, struct json_object *particles) {
    mf_json_fields(particles, mf_placement_count_fields, &scene->setup.placement);
    scene->setup.composition = mf_composition_of_one(scene->setup.placement.count);
}

/// One type of a mixture and how many beads there are of it, after those that were read before.
static void read_type(struct scene *scene, struct json_object *types, const char *name) {
    struct composition *composition = &scene->setup.composition;
    struct field fields[] = {mf_placement_count_fields[0], FIELD_END};
    int64_t *count = &composition->count[composition->types];
    fields[0].name = name;
    fields[0].offset = 0;
    mf_json_fields(types, fields, count);
    scene->setup.placement.count += *count;
    if (!mf_composition_is_name(name))
        mf_json_fault(types, name, "a type is called by up to %d letters, digits and _",
                      COMPOSITION_NAME_SIZE - 1);
    snprintf(composition->name[composition->types++], COMPOSITION_NAME_SIZE, "%s", name);
}

/// "types": {"A": 500, "B": 300} in the place of "count".
static void read_types(struct scene *scene, struct json_object *particles) {
    struct json_object types = mf_json_child(particles, "types", true);
    const size_t faults = mf_json_fault_count(types.document);
    size_t n = 0;
    for (const char *name; (name = mf_json_key(&types, n)); n++)
        if (n < COMPOSITION_MOST_TYPES)
            read_type(scene, &types, name);
    if (types.item && (n < 2 || n > COMPOSITION_MOST_TYPES))
        mf_json_fault(particles, "types",
                      "a mixture has 2 to %d types, not %zu; \"count\" is for one",
                      COMPOSITION_MOST_TYPES, n);
    if (types.item == NULL || mf_json_fault_count(types.document) > faults)
        scene->setup.composition.types = 0; // not known
}

static enum status read_particles(struct scene *scene, struct json_object *object) {
    struct json_object particles = mf_json_child(object, "particles", true);
    struct placement *placement = &scene->setup.placement;
    if (mf_json_has(&particles, "types"))
        read_types(scene, &particles);
    else
        read_count(scene, &particles);
    mf_json_fields(&particles, mf_placement_fields, placement);
    if (particles.item == NULL)
        return STATUS_OK;
    mf_json_finish(&particles);
    if (placement->kind != PLACEMENT_FILE)
        return STATUS_OK;
    if (placement->file[0] == '\0') {
        mf_json_fault(&particles, "file", "is required with \"placement\": \"file\"");
        return STATUS_OK;
    }
    return read_positions(scene, &particles);
}

double mf_scene_mass_density(const struct scene *scene) {
    const double metres = scene->units.length * 1e-9;
    const double kilograms = scene->units.mass * (double)scene->setup.placement.count;
    return 1e-3 * kilograms / (mf_box_volume(&scene->setup.box) * pow(metres, 3));
}

/// Hardly a multiple of T_0, often a number of kelvins.
static const double hottest = 50;

bool mf_scene_is_hot(const struct scene *scene, char line[SCENE_LINE_SIZE]) {
    snprintf(line, SCENE_LINE_SIZE,
             "temperature: %g in units of k_B T_0, which is 1 as a rule; kelvins belong into "
             "\"units\"",
             scene->setup.temperature);
    return scene->setup.temperature > hottest && !mf_units_known(&scene->units);
}

/// Masses that are not in kg and temperatures that are in K.
static void check_units(const struct scene *scene, struct json_object *object) {
    static const double densest = 30; // g/cm³: no matter is denser
    static const double atomic_mass = 1e-3 / UNITS_AVOGADRO;
    const struct simulation_setup *setup = &scene->setup;
    const double mass = scene->units.mass;
    if (!mf_units_known(&scene->units) || mf_json_fault_count(object->document) > 0)
        return;
    struct json_object units = mf_json_child(object, "units", false);
    if (setup->temperature > hottest)
        mf_json_fault(object, "temperature",
                      "%g is in units of T_0, %g K in \"units\": it would be %g K; 1 is T_0",
                      setup->temperature, scene->units.temperature,
                      setup->temperature * scene->units.temperature);
    const double density = setup->box.dimensions == 3 ? mf_scene_mass_density(scene) : 0;
    if (density > densest && mass >= 1)
        mf_json_fault(&units, "mass", "it is in kg: %g u would be %.6g", mass, mass * atomic_mass);
    else if (density > densest)
        mf_json_fault(
            &units, "mass",
            "%g kg a bead, 1 u being %.6g, make %.3g g/cm^3: the mass, the unit of length, the "
            "box or the number of particles is wrong",
            mass, atomic_mass, density);
}

enum status mf_scene_read(struct scene *scene, struct json_object *object, int unknown) {
    *scene = (struct scene){.unknown = unknown};
    mf_units_read(&scene->units, object);
    read_top(scene, object);
    TRY(read_particles(scene, object));
    check_units(scene, object);
    if (unknown == SCENE_FITS_OMEGA) // between what particles, a fit would ask in vain
        mf_json_child(object, "conservative", true);
    if (!(unknown & SCENE_FITS_POTENTIAL)) {
        TRY(mf_scene_law_read(&scene->potential, object, "conservative", mf_curve_potentials,
                              &scene->setup.composition, &scene->units));
        TRY(mf_scene_law_tabulate(&scene->potential, mf_table_init_potential));
    }
    if (!(unknown & SCENE_FITS_OMEGA)) {
        TRY(mf_scene_law_read(&scene->omega, object, "dissipative", mf_curve_omegas,
                              &scene->setup.composition, &scene->units));
        TRY(mf_scene_law_tabulate(&scene->omega, mf_table_init_omega));
        check_omega(scene, object);
    }
    TRY(mf_scene_interactions_read(&scene->interactions, object, &scene->setup));
    TRY(read_dynamics(scene, object, unknown));
    scene->setup.potential = scene->potential.curves ? &scene->potential.table : NULL;
    scene->setup.omega = scene->omega.curves ? &scene->omega.table : NULL;
    return STATUS_OK;
}

void mf_scene_clear(struct scene *scene) {
    mf_scene_law_clear(&scene->potential);
    mf_scene_law_clear(&scene->omega);
    mf_memory_free(scene->start_values);
    mf_memory_free(scene->integrator_parameters);
    mf_scene_interactions_clear(&scene->interactions);
    *scene = (struct scene){0};
}

const char *mf_scene_warning(const struct scene *scene) {
    if (simulation_holds_temperature(&scene->setup) || (scene->unknown & SCENE_FITS_OMEGA))
        return NULL;
    return "nothing holds the temperature: without \"dissipative\", friction and noise, a "
           "simulation "
           "conserves its energy, and its temperature drifts";
}

static void write_count(const struct simulation_setup *setup, struct json_writer *writer) {
    const struct composition *composition = &setup->composition;
    if (!composition_is_mixed(composition)) {
        mf_json_put_fields(writer, mf_placement_count_fields, &setup->placement);
        return;
    }
    mf_json_begin(writer, "types");
    for (int type = 0; type < composition->types; type++)
        mf_json_put_number(writer, composition->name[type], (double)composition->count[type]);
    mf_json_end(writer);
}

void mf_scene_write(const struct scene *scene, struct json_writer *writer) {
    const struct simulation_setup *setup = &scene->setup;
    struct top top = {.dimensions = setup->box.dimensions,
                      .temperature = setup->temperature,
                      .time_step = setup->time_step,
                      .skin = setup->skin,
                      .temperature_limit = setup->temperature_limit,
                      .precision = setup->precision};
    for (int d = 0; d < setup->box.dimensions; d++)
        top.box[d] = setup->box.length[d];
    mf_json_put_fields(writer, mf_scene_fields, &top);
    mf_json_begin(writer, "particles");
    write_count(setup, writer);
    mf_json_put_fields(writer, mf_placement_fields, &setup->placement);
    mf_json_end(writer);
    if (scene->potential.curves || scene->unknown == SCENE_FITS_OMEGA)
        mf_scene_law_write(&scene->potential, &setup->composition, writer, "conservative");
    if (scene->omega.curves)
        mf_scene_law_write(&scene->omega, &setup->composition, writer, "dissipative");
    mf_scene_interactions_write(&scene->interactions, writer);
    mf_json_begin(writer, "dynamics");
    mf_json_put_text(writer, "integrator", setup->integrator->name);
    mf_json_put_fields(writer, setup->integrator->fields, setup->integrator_parameters);
    mf_json_end(writer);
    if (mf_units_known(&scene->units)) {
        mf_json_begin(writer, "units");
        mf_json_put_fields(writer, mf_units_fields, &scene->units);
        mf_json_end(writer);
    }
}

void mf_scene_digest(const struct scene *scene, uint64_t *digest) {
    mf_scene_law_digest(&scene->potential, digest);
    mf_scene_law_digest(&scene->omega, digest);
    const size_t count = (size_t)scene->setup.placement.count;
    for (int d = 0; d < scene->setup.box.dimensions; d++) {
        mf_digest_add(digest, scene->start.position[d], count * sizeof(double));
        mf_digest_add(digest, scene->start.velocity[d], count * sizeof(double));
    }
}
