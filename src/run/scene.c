// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/scene.h"

#include "base/memory.h"
#include "curves/sampled.h"
#include "io/data_table.h"
#include "io/votca.h"
#include "run/checkpoint.h"

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
const struct field scene_fields[] = {
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

/// The first two columns of a file as points. Faults go to the document and leave `count` 0.
static enum status read_columns(const char *file, double **r, double **value, size_t *count) {
    struct data_table table = {0};
    enum status status = STATUS_OK;
    CHECK(data_table_read(&table, file, 2));
    CHECK(data_table_check_increasing(&table, file, 0, 0));
    NEW_ARRAY(*r, table.rows);
    NEW_ARRAY(*value, table.rows);
    for (size_t k = 0; k < table.rows; k++) {
        (*r)[k] = table.values[k * table.columns];
        (*value)[k] = table.values[k * table.columns + 1];
    }
    *count = table.rows;
done:
    data_table_clear(&table);
    return status;
}

/// VOTCA's points, from nm and kJ/mol.
static enum status read_votca(const char *file, const struct units *units, double **r,
                              double **value, size_t *count) {
    struct votca_table table = {0};
    enum status status = STATUS_OK;
    CHECK(votca_read(&table, file));
    NEW_ARRAY(*r, table.rows);
    NEW_ARRAY(*value, table.rows);
    for (size_t k = 0; k < table.rows; k++) {
        if (table.x[k] < 0) {
            status = status_fail(STATUS_BAD_INPUT, "%s:%zu: r = %g is negative", file,
                                 table.line[k], table.x[k]);
            goto done;
        }
        (*r)[k] = table.x[k] / units->length;
        (*value)[k] = table.y[k] / units_energy_kj_per_mol(units);
    }
    *count = table.rows;
done:
    votca_clear(&table);
    return status;
}

/// Points of a table file for a curve of the law "table".
static enum status load_points(struct curve *curve, struct json_object *object,
                               const struct units *units) {
    struct sampled_parameters *parameters = curve->parameters;
    double *r = NULL, *value = NULL;
    size_t count = 0;
    enum status status = STATUS_OK;
    if (parameters->format == SAMPLED_VOTCA && !units_known(units)) {
        json_fault(object, "format", "VOTCA's nm and kJ/mol need \"units\" in the scene");
        return STATUS_OK;
    }
    status = parameters->format == SAMPLED_VOTCA
                 ? read_votca(parameters->file, units, &r, &value, &count)
                 : read_columns(parameters->file, &r, &value, &count);
    if (status != STATUS_OK)
        json_fault(object, "file", "%s", status_message());
    else if (sampled_set_points(curve, r, value, count) != STATUS_OK)
        json_fault(object, "file", "%s: %s", parameters->file, status_message());
    memory_free(r);
    memory_free(value);
    return status == STATUS_NO_MEMORY ? status : STATUS_OK;
}

/// A table that could not be loaded has no points: forget the curve, the fault is recorded.
static bool is_usable(const struct curve *curve) {
    return curve->family != &sampled_family ||
           ((const struct sampled_parameters *)curve->parameters)->spline != NULL;
}

enum status scene_read_curve(struct curve *curve, struct json_object *parent, const char *key,
                             const struct curve_family *const *list, const struct units *units) {
    enum { MOST = 16 };
    const char *names[MOST] = {"none"};
    for (size_t k = 0; list[k] && k + 2 < MOST; k++)
        names[k + 1] = list[k]->name;
    struct json_object object = json_child(parent, key, false);
    if (object.item == NULL)
        return STATUS_OK;
    const char *law = json_choice(&object, "law", names, NULL);
    const struct curve_family *family = law ? curve_find(list, law) : NULL;
    if (family) {
        const size_t faults = json_fault_count(object.document);
        TRY(curve_create(curve, family));
        json_fields(&object, family->fields, curve->parameters);
        if (family == &sampled_family && json_fault_count(object.document) == faults)
            TRY(load_points(curve, &object, units));
        if (!is_usable(curve))
            curve_clear(curve);
    }
    if (law)
        json_finish(&object);
    return STATUS_OK;
}

static enum status read_weight(struct scene *scene, struct json_object *object) {
    TRY(scene_read_curve(&scene->weight, object, "dissipative", curve_weights, &scene->units));
    if (scene->weight.family == NULL)
        return STATUS_OK;
    TRY(table_init_weight(&scene->weight_table, &scene->weight));
    for (int k = 0; k <= TABLE_INTERVALS; k++)
        if (scene->weight_table.coefficient[2 * k] < 0) {
            json_fault(object, "dissipative", "omega is negative at r = %g",
                       k / scene->weight_table.inverse_spacing);
            break;
        }
    return STATUS_OK;
}

static void read_top(struct scene *scene, struct json_object *object) {
    struct top top;
    json_fields(object, scene_fields, &top);
    struct simulation_setup *setup = &scene->setup;
    setup->box.dimensions = (int)top.dimensions;
    for (int d = 0; d < 3; d++)
        setup->box.length[d] = d < top.dimensions ? top.box[d] : 1;
    if (top.box[0] > 0 && (top.box[2] > 0) != (top.dimensions == 3))
        json_fault(object, "box", "has %d edges, but the scene has %d dimensions",
                   top.box[2] > 0 ? 3 : 2, (int)top.dimensions);
    setup->temperature = top.temperature;
    setup->time_step = top.time_step;
    setup->skin = top.skin;
    setup->temperature_limit = top.temperature_limit;
    setup->precision = top.precision;
    setup->threads = 1;
}

static void read_dynamics(struct scene *scene, struct json_object *object, int unknown) {
    enum { MOST = 16 };
    const char *names[MOST] = {NULL};
    for (size_t k = 0; integrator_list[k] && k + 1 < MOST; k++)
        names[k] = integrator_list[k]->name;
    struct json_object dynamics = json_child(object, "dynamics", false);
    const bool dissipative = scene->weight.family != NULL || (unknown & SCENE_FITS_WEIGHT);
    const char *name = dissipative ? aboba.name : velocity_verlet.name;
    if (dynamics.item)
        name = json_choice(&dynamics, "integrator", names, name);
    const struct integrator *integrator = NULL;
    for (size_t k = 0; name && integrator_list[k]; k++)
        if (strcmp(integrator_list[k]->name, name) == 0)
            integrator = integrator_list[k];
    if (integrator == NULL)
        return;
    scene->setup.integrator = integrator;
    json_fields(&dynamics, integrator->fields, &scene->setup.integrator_parameters);
    if (dynamics.item)
        json_finish(&dynamics);
    if (dissipative && !integrator->dissipative)
        json_fault(object, "dynamics", "%s knows no friction; use \"aboba\" with \"dissipative\"",
                   integrator->name);
}

/// Columns x, y (, z) and, if there are as many again, the velocities.
static enum status read_positions(struct scene *scene, struct json_object *particles) {
    const struct placement *placement = &scene->setup.placement;
    const size_t dimensions = (size_t)scene->setup.box.dimensions;
    struct data_table table = {0};
    enum status status = data_table_read(&table, placement->file, dimensions);
    if (status != STATUS_OK) {
        json_fault(particles, "file", "%s", status_message());
        return status == STATUS_NO_MEMORY ? status : STATUS_OK;
    }
    if (table.rows != (size_t)placement->count ||
        (table.columns != dimensions && table.columns != 2 * dimensions)) {
        json_fault(particles, "file", "%s: %zu rows of %zu numbers, not %lld of %zu or %zu",
                   placement->file, table.rows, table.columns, (long long)placement->count,
                   dimensions, 2 * dimensions);
        goto done;
    }
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
    data_table_clear(&table);
    return status;
}

static enum status read_particles(struct scene *scene, struct json_object *object) {
    struct json_object particles = json_child(object, "particles", true);
    struct placement *placement = &scene->setup.placement;
    json_fields(&particles, placement_fields, placement);
    if (particles.item == NULL)
        return STATUS_OK;
    json_finish(&particles);
    if (placement->kind != PLACEMENT_FILE)
        return STATUS_OK;
    if (placement->file[0] == '\0') {
        json_fault(&particles, "file", "is required with \"placement\": \"file\"");
        return STATUS_OK;
    }
    return read_positions(scene, &particles);
}

enum status scene_read(struct scene *scene, struct json_object *object, int unknown) {
    *scene = (struct scene){.unknown = unknown};
    struct json_object units = json_child(object, "units", false);
    json_fields(&units, units_fields, &scene->units);
    if (units.item)
        json_finish(&units);
    read_top(scene, object);
    TRY(read_particles(scene, object));
    if (unknown == SCENE_FITS_WEIGHT) // between what particles, a fit would ask in vain
        json_child(object, "conservative", true);
    if (!(unknown & SCENE_FITS_POTENTIAL)) {
        TRY(scene_read_curve(&scene->potential, object, "conservative", curve_potentials,
                             &scene->units));
        if (scene->potential.family)
            TRY(table_init_potential(&scene->potential_table, &scene->potential));
    }
    if (!(unknown & SCENE_FITS_WEIGHT))
        TRY(read_weight(scene, object));
    read_dynamics(scene, object, unknown);
    scene->setup.potential = scene->potential.family ? &scene->potential_table : NULL;
    scene->setup.weight = scene->weight.family ? &scene->weight_table : NULL;
    return STATUS_OK;
}

void scene_clear(struct scene *scene) {
    curve_clear(&scene->potential);
    curve_clear(&scene->weight);
    table_clear(&scene->potential_table);
    table_clear(&scene->weight_table);
    memory_free(scene->start_values);
    *scene = (struct scene){0};
}

void scene_write_curve(const struct curve *curve, struct json_writer *writer, const char *key) {
    json_begin(writer, key);
    json_put_text(writer, "law", curve->family ? curve->family->name : "none");
    if (curve->family)
        json_put_fields(writer, curve->family->fields, curve->parameters);
    json_end(writer);
}

void scene_write(const struct scene *scene, struct json_writer *writer) {
    const struct simulation_setup *setup = &scene->setup;
    struct top top = {.dimensions = setup->box.dimensions,
                      .temperature = setup->temperature,
                      .time_step = setup->time_step,
                      .skin = setup->skin,
                      .temperature_limit = setup->temperature_limit,
                      .precision = setup->precision};
    for (int d = 0; d < setup->box.dimensions; d++)
        top.box[d] = setup->box.length[d];
    json_put_fields(writer, scene_fields, &top);
    json_begin(writer, "particles");
    json_put_fields(writer, placement_fields, &setup->placement);
    json_end(writer);
    if (scene->potential.family || scene->unknown == SCENE_FITS_WEIGHT)
        scene_write_curve(&scene->potential, writer, "conservative");
    if (scene->weight.family)
        scene_write_curve(&scene->weight, writer, "dissipative");
    json_begin(writer, "dynamics");
    json_put_text(writer, "integrator", setup->integrator->name);
    json_put_fields(writer, setup->integrator->fields, &setup->integrator_parameters);
    json_end(writer);
    if (units_known(&scene->units)) {
        json_begin(writer, "units");
        json_put_fields(writer, units_fields, &scene->units);
        json_end(writer);
    }
}

static void digest_table(const struct table *table, uint64_t *digest) {
    checkpoint_digest_add(digest, table->coefficient,
                          (size_t)((TABLE_INTERVALS + 1) * table->terms) * sizeof(double));
}

void scene_digest(const struct scene *scene, uint64_t *digest) {
    digest_table(&scene->potential_table, digest);
    digest_table(&scene->weight_table, digest);
    const size_t count = (size_t)scene->setup.placement.count;
    for (int d = 0; d < scene->setup.box.dimensions; d++) {
        checkpoint_digest_add(digest, scene->start.position[d], count * sizeof(double));
        checkpoint_digest_add(digest, scene->start.velocity[d], count * sizeof(double));
    }
}
