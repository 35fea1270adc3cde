// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_parts.h"

#include "base/digest.h"
#include "base/memory.h"
#include "base/names.h"
#include "io/data_table.h"
#include "trajectory/snapshot.h"

#include <math.h>

/// Coordinates may be unwrapped, but so far outside they are in other units, as nm and pm.
static const double max_boxes = 100;

/// Whether all coordinates of a file are within max_boxes of the box; tells of the first that is
/// not.
static bool are_near(const struct scene *scene, const struct data_table *table,
                     struct json_object *particles) {
    const struct box *box = &scene->setup.box;
    const double length = mf_json_factor(particles, "lambda");
    for (size_t k = 0; k < table->rows; k++)
        for (int d = 0; d < box->dimensions; d++) {
            const double x = table->values[k * table->columns + (size_t)d];
            if (fabs(x) <= max_boxes * box->length[d])
                continue;
            mf_json_fault(
                particles, "file",
                "%s:%zu: the coordinate %g is more than %g boxes of %g away; are the units "
                "those of \"box\"?",
                scene->setup.placement.file, table->line[k], x * length, max_boxes,
                box->length[d] * length);
            return false;
        }
    return true;
}

/// A table, or a snapshot in JSON with the same columns.
static enum status read_file(struct data_table *table, const struct scene *scene) {
    const char *file = scene->setup.placement.file, *dot = strrchr(file, '.');
    const int dimensions = scene->setup.box.dimensions;
    return dot && strcmp(dot, ".json") == 0
               ? mf_snapshot_read(table, file, &scene->setup.box, &scene->setup.composition)
               : mf_data_table_read(table, file, (size_t)dimensions);
}

/// Rows or columns that are too many or too few. If the last column that is not an attribute's is
/// not a velocity's either, it has a name that is unknown.
static void fault_shape(const struct scene *scene, struct json_object *particles,
                        const struct data_table *table, size_t motion) {
    const struct placement *placement = &scene->setup.placement;
    const size_t dimensions = (size_t)scene->setup.box.dimensions;
    char name[32], called[64] = "";
    if (mf_data_table_numbers_rows(table, 0) && motion % dimensions == 1) {
        mf_json_fault(particles, "file",
                      "%s: column 1 numbers the rows: leave it out, so that x is first",
                      placement->file);
        return;
    }
    if (motion > dimensions && motion != 2 * dimensions &&
        mf_scene_attributes_column_name(table, motion - 1, name, sizeof name))
        snprintf(called, sizeof called, ", of which \"%s\" is unknown", name);
    mf_json_fault(particles, "file",
                  "%s: %zu rows of %zu numbers%s, not %lld of %zu or %zu; further columns need the "
                  "names mass, radius, stiffness or orientation in a header",
                  placement->file, table->rows, motion, called, (long long)placement->count,
                  dimensions, 2 * dimensions);
}

/// Make the columns reduced: `dimensions` of places, as far as `motion` of velocities, the rest of
/// attributes.
static enum status convert(struct data_table *table, const char *file, size_t dimensions,
                           size_t motion, const struct units *units) {
    for (size_t column = 0; column < motion; column++)
        TRY(mf_data_table_convert(table, file, column,
                                  column < dimensions ? "lambda" : "lambda/tau", units));
    for (size_t column = motion; column < table->columns; column++)
        TRY(mf_scene_attributes_convert(table, file, column, units));
    return STATUS_OK;
}

/// Columns x, y (, z), if there are as many again the velocities, and attributes by their names.
static enum status read_positions(struct scene *scene, struct json_object *particles) {
    const struct placement *placement = &scene->setup.placement;
    const size_t dimensions = (size_t)scene->setup.box.dimensions;
    struct data_table table = {0};
    enum status status = read_file(&table, scene);
    if (status != STATUS_OK) {
        mf_json_fault(particles, "file", "%s", mf_status_marked());
        return status == STATUS_NO_MEMORY ? status : STATUS_OK;
    }
    const size_t motion = mf_scene_attributes_first_column(&table);
    if (table.rows != (size_t)placement->count ||
        (motion != dimensions && motion != 2 * dimensions)) {
        fault_shape(scene, particles, &table, motion);
        goto done;
    }
    if (convert(&table, placement->file, dimensions, motion, mf_json_units(particles)) !=
        STATUS_OK) {
        mf_json_fault(particles, "file", "%s", mf_status_marked());
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
        else if (column < motion)
            scene->start.velocity[column - dimensions] = values;
        else
            mf_scene_attributes_column(scene, particles, &table, column, values);
    }
    if (mf_json_fault_count(particles->document) == 0)
        mf_scene_coordinates_check_bonds(scene, particles, NULL);
done:
    mf_data_table_clear(&table);
    return status;
}

/// @param[in] follows  whether a count that is missing is chosen later, from what any has; a file
/// of places has its own
static void read_count(struct scene *scene, struct json_object *particles, bool follows) {
    enum { ANY_COUNT = 1000 };
    scene->given.count =
        !follows || mf_json_has(particles, "count") || mf_json_has(particles, "file");
    if (!scene->given.count)
        scene->setup.placement.count = ANY_COUNT;
    else
        mf_json_fields(particles, mf_placement_count_fields, &scene->setup.placement);
    scene->setup.composition = mf_composition_of_one(scene->setup.placement.count);
}

/// One type of a mixture and how many beads there are of it, after those that were read before.
static void read_type(struct scene *scene, struct json_object *types, const char *name) {
    struct composition *composition = &scene->setup.composition;
    struct field fields[] = {mf_placement_count_fields[0], FIELD_END};
    int64_t *count = &composition->count[composition->types];
    fields[0].name = name;
    fields[0].minimum = 1;
    fields[0].offset = 0;
    mf_json_fields(types, fields, count);
    scene->setup.placement.count += *count;
    if (!mf_composition_is_name(name))
        mf_json_fault(types, name, "expected a type name of " NAMES_OF_TYPE,
                      COMPOSITION_NAME_SIZE - 1);
    snprintf(composition->name[composition->types++], COMPOSITION_NAME_SIZE, "%s", name);
}

/// "types": {"A": 500, "B": 300} in the place of "count"; beside molecules they are single beads,
/// of any number of types.
static void read_types(struct scene *scene, struct json_object *particles, bool beside) {
    struct json_object types = mf_json_child(particles, "types", true);
    const size_t fewest = beside ? 1 : 2;
    const size_t faults = mf_json_fault_count(types.document);
    const bool counted = mf_json_has(particles, "count");
    size_t n = 0;
    if (counted)
        mf_json_fault(particles, "count",
                      "is given with \"types\", which has numbers, too: leave one of them out");
    for (const char *name; (name = mf_json_key(&types, n)); n++)
        if (n < COMPOSITION_MAX_TYPES)
            read_type(scene, &types, name);
    if (types.item && !counted && (n < fewest || n > COMPOSITION_MAX_TYPES))
        mf_json_fault(particles, "types",
                      "a mixture has %zu to %d types, not %zu; \"count\" is for one", fewest,
                      COMPOSITION_MAX_TYPES, n);
    if (types.item == NULL || mf_json_fault_count(types.document) > faults)
        scene->setup.composition.types = 0; // not known
}

/// The box that a density asks for.
static void make_box(struct scene *scene) {
    struct box *box = &scene->setup.box;
    const double volume = (double)scene->setup.placement.count / scene->density;
    for (int d = 0; d < box->dimensions && scene->density > 0 && volume > 0; d++)
        box->length[d] = pow(volume, 1.0 / box->dimensions);
}

/// How many there are, of which types: single beads, then those of molecules.
static enum status read_beads(struct scene *scene, struct json_object *object,
                              const struct scene_fitted *fitted, struct json_object *particles) {
    const size_t faults = mf_json_fault_count(object->document);
    const bool beside = mf_json_has(object, "molecules");
    struct composition *composition = &scene->setup.composition;
    const bool typed = mf_json_has(particles, "types");
    scene->given.count = true;
    if (beside && !typed && mf_json_has(particles, "count"))
        mf_json_fault(particles, "count",
                      "with molecules single beads need types, as in \"types\": {\"A\": 100}");
    else if (typed)
        read_types(scene, particles, beside);
    else if (!beside)
        read_count(scene, particles, fitted && fitted->count_follows);
    TRY(mf_scene_molecules_read(&scene->molecules, object, fitted, composition, &scene->units));
    if (scene_has_molecules(&scene->molecules))
        scene->setup.placement.count = mf_composition_particles(composition);
    if (beside && mf_json_fault_count(object->document) > faults)
        composition->types = 0; // not known
    return STATUS_OK;
}

enum status mf_scene_particles_read(struct scene *scene, struct json_object *object,
                                    const struct scene_fitted *fitted) {
    const bool required = !mf_json_has(object, "molecules") && !(fitted && fitted->count_follows);
    struct json_object particles = mf_json_child(object, "particles", required);
    struct placement *placement = &scene->setup.placement;
    TRY(read_beads(scene, object, fitted, &particles));
    make_box(scene);
    mf_json_fields(&particles, mf_placement_fields, placement);
    placement->jitter = PLACEMENT_JITTER;
    mf_json_retired(&particles, "jitter", "0.05", "it is 0.05 always; leave it out");
    mf_scene_attributes_read(scene, &particles);
    if (placement->kind == PLACEMENT_FILE && placement->slab > 0)
        mf_json_fault(&particles, "slab", "is for \"lattice\" and \"random\"; a file has places");
    if (particles.item == NULL)
        return STATUS_OK;
    mf_json_finish(&particles);
    if (placement->kind != PLACEMENT_FILE)
        return STATUS_OK;
    if (placement->file[0] == '\0') {
        mf_json_fault(&particles, "file", "is required with \"placement\": \"file\"");
        return STATUS_OK;
    }
    return mf_scene_coordinates_are_of_engine(placement->file)
               ? mf_scene_coordinates_read(scene, &particles)
               : read_positions(scene, &particles);
}

void mf_scene_particles_complete(struct scene *scene, struct json_object *object) {
    struct simulation_setup *setup = &scene->setup;
    if (!scene->given.count) {
        struct json_object particles = mf_json_child(object, "particles", true);
        mf_json_fields(&particles, mf_placement_count_fields, &setup->placement);
    } else if (!composition_is_mixed(&setup->composition) &&
               !scene_has_molecules(&scene->molecules)) {
        setup->composition = mf_composition_of_one(setup->placement.count);
        make_box(scene);
    }
}

/// Single beads beside molecules, if there are any.
static void write_single(const struct scene *scene, struct json_writer *writer) {
    const struct composition *composition = &scene->setup.composition;
    const struct topology *topology = &scene->molecules.molecules.topology;
    int64_t single[COMPOSITION_MAX_TYPES], all = 0;
    memcpy(single, composition->count, sizeof single);
    for (int k = 0; k < topology->kinds; k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            single[topology->kind[k].type[bead]] -= topology->kind[k].count;
    for (int type = 0; type < composition->types; type++)
        all += single[type];
    if (all == 0)
        return;
    mf_json_begin(writer, "types");
    for (int type = 0; type < composition->types; type++)
        if (single[type] > 0)
            mf_json_write_integer(writer, composition->name[type], single[type]);
    mf_json_end(writer);
}

static void write_count(const struct simulation_setup *setup, struct json_writer *writer) {
    const struct composition *composition = &setup->composition;
    if (!composition_is_mixed(composition)) {
        mf_json_write_fields(writer, mf_placement_count_fields, &setup->placement);
        return;
    }
    mf_json_begin(writer, "types");
    for (int type = 0; type < composition->types; type++)
        mf_json_write_number(writer, composition->name[type], (double)composition->count[type]);
    mf_json_end(writer);
}

void mf_scene_particles_write(const struct scene *scene, struct json_writer *writer) {
    mf_json_begin(writer, "particles");
    if (scene_has_molecules(&scene->molecules))
        write_single(scene, writer);
    else
        write_count(&scene->setup, writer);
    mf_json_write_fields(writer, mf_placement_fields, &scene->setup.placement);
    mf_scene_attributes_write(scene, writer);
    mf_json_end(writer);
}

void mf_scene_particles_digest(const struct scene *scene, uint64_t *digest) {
    const size_t bytes = (size_t)scene->setup.placement.count * sizeof(double);
    for (int d = 0; d < scene->setup.box.dimensions; d++) {
        mf_digest_add(digest, scene->start.position[d], bytes);
        mf_digest_add(digest, scene->start.velocity[d], bytes);
    }
    for (int k = 0; k < ATTRIBUTES_NAMES; k++)
        mf_digest_add(digest, scene->setup.attribute[k].column,
                      scene->setup.attribute[k].column ? bytes : 0);
}
