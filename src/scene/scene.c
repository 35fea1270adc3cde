// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include "base/digest.h"
#include "base/memory.h"
#include "scene/scene_parts.h"

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
     .unit = "", .help = "number of dimensions"},
    {"box", FIELD_LENGTHS, MEMBER(box), .minimum = FIELD_ABOVE_ZERO, .maximum = LARGEST_BOX,
     .unit = "lambda", .help = "edges of the periodic box"},
    {"temperature", FIELD_NUMBER, MEMBER(temperature), .initial = 1, .minimum = 0,
     .maximum = DBL_MAX, .unit = "T_0",
     .help = "temperature; 0 only for dynamics without velocities"},
    {"time_step", FIELD_NUMBER, MEMBER(time_step), .initial = 0.01, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "tau",
     .help = "time step; another chosen if needed; unused by \"monte-carlo\""},
    {"skin", FIELD_NUMBER, MEMBER(skin), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "skin of the neighbour list; 0: chosen"},
    {"temperature_limit", FIELD_NUMBER, MEMBER(temperature_limit), .initial = 20, .minimum = 1,
     .maximum = DBL_MAX, .unit = "",
     .help = "kinetic over set temperature above which a run is unstable"},
    {"precision", FIELD_CHOICE, MEMBER(precision), .choices = precisions, .initial = PAIR_MIXED,
     .unit = "", .help = "precision of pair forces"},
    FIELD_END,
};

const struct field mf_scene_density_fields[] = {
    {"density", FIELD_NUMBER, .offset = offsetof(struct scene, density), .initial = 0,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "1/lambda^d",
     .help = "number density of all beads, for a box of equal edges instead of \"box\""},
    FIELD_END,
};

/// A box, or the density that makes it once the beads are counted.
static void check_box(struct scene *scene, struct json_object *object, const struct top *top) {
    const bool has_box = mf_json_has(object, "box");
    mf_json_fields(object, mf_scene_density_fields, scene);
    if (has_box == mf_json_has(object, "density"))
        mf_json_fault(object, has_box ? "density" : "box", "%s",
                      has_box ? "\"box\" is given, too; leave one of them out"
                              : "missing: it or \"density\" is required");
    if (top->box[0] > 0 && (top->box[2] > 0) != (top->dimensions == 3))
        mf_json_fault(object, "box",
                      "has %d edges, but the scene has %d dimensions; \"dimensions\" sets them",
                      top->box[2] > 0 ? 3 : 2, (int)top->dimensions);
}

static void check_omega(const struct scene *scene, struct json_object *object) {
    const struct table *table = &scene->omega.table;
    for (int row = 0; row < table->curves * (TABLE_INTERVALS + 1); row++)
        if (table->coefficient[2 * row] < 0) {
            const int pair = row / (TABLE_INTERVALS + 1), k = row % (TABLE_INTERVALS + 1);
            mf_json_fault(object, "dissipative", "omega is negative at r = %g",
                          mf_json_factor(object, "lambda") * k /
                              mf_table_inverse_spacing(table, pair));
            return;
        }
}

static void read_top(struct scene *scene, struct json_object *object) {
    struct top top;
    const uint64_t given = mf_json_fields(object, mf_scene_fields, &top);
    scene->given.time_step = given & mf_fields_bit(mf_scene_fields, "time_step");
    struct simulation_setup *setup = &scene->setup;
    setup->box.dimensions = (int)top.dimensions;
    for (int d = 0; d < 3; d++)
        setup->box.length[d] = d < top.dimensions ? top.box[d] : 1;
    check_box(scene, object, &top);
    setup->temperature = top.temperature;
    setup->time_step = top.time_step;
    setup->skin = top.skin;
    setup->temperature_limit = top.temperature_limit;
    setup->precision = top.precision;
    setup->threads = 1;
}

double mf_scene_mass_density(const struct scene *scene) {
    const double metres = scene->units.length * 1e-9;
    const struct simulation_setup *setup = &scene->setup;
    const double masses = mf_attributes_sum(&setup->attribute[ATTRIBUTES_MASS], 1,
                                            &setup->composition, setup->placement.count);
    const double kilograms = masses * scene->units.mass;
    return 1e-3 * kilograms / (mf_box_volume(&scene->setup.box) * pow(metres, 3));
}

/// Hardly a multiple of T_0, often a number of kelvins.
static const double hottest = 50;

/// In a reduced file masses of beads are in μ: one that is μ in u was given twice, and a bead would
/// have its square.
static void check_mass_given_twice(const struct scene *scene, struct json_object *object) {
    static const double alike = 0.01, light = 1.1;
    const struct attributes_range masses =
        mf_attributes_span(&scene->setup.attribute[ATTRIBUTES_MASS]);
    const double unit = scene->units.mass / UNITS_ATOMIC_MASS;
    if (masses.maximum > light && fabs(masses.maximum / unit - 1) < alike)
        mf_json_fault(object, "particles.mass",
                      "%g is in units of mu, and \"mass\" of \"units\" sets mu to %.6g u: a bead "
                      "would have %.6g u; leave one of them out, or choose another mu",
                      masses.maximum, unit, masses.maximum * unit);
}

/// In a file in u: a bead that is lighter than any atom was told in another unit. That of an
/// engine's reduced units may have less than 1.
static void check_lightest(const struct scene *scene, struct json_object *object) {
    static const double lightest = 0.1, kg_a_mole = 1e-5; // below, it is no mass of a mole in kg
    const struct attributes_source *source = &scene->setup.attribute[ATTRIBUTES_MASS];
    const double unit = scene->units.mass / UNITS_ATOMIC_MASS;
    const double mass = source->ranges > 0 ? unit * mf_attributes_span(source).minimum : unit;
    if (mass >= lightest)
        return;
    mf_json_fault(object, "particles.mass",
                  "%g u is less than any atom has: masses are in u, which is g/mol; "
                  "%s",
                  mass, mass < kg_a_mole ? "1 kg is 6.02214e+26 u" : "1 kg/mol is 1000 u");
}

/// Masses that are not in kg and temperatures that are in K.
static void check_units(const struct scene *scene, struct json_object *object) {
    static const double densest = 30; // g/cm³: no matter is denser
    static const double atomic_mass = 1e-3 / UNITS_AVOGADRO;
    const struct simulation_setup *setup = &scene->setup;
    const double mass = scene->units.mass;
    if (!mf_units_known(&scene->units) || mf_json_fault_count(object->document) > 0)
        return;
    const bool reduced = !mf_units_are_physical(&scene->units);
    struct json_object units = {0};
    if (reduced)
        units = mf_json_child(object, "units", false);
    if (reduced && setup->temperature > hottest)
        mf_json_fault(object, "temperature",
                      "%g is in units of T_0, %g K in \"units\": it would be %g K; 1 is T_0",
                      setup->temperature, scene->units.temperature,
                      setup->temperature * scene->units.temperature);
    if (reduced)
        check_mass_given_twice(scene, object);
    else
        check_lightest(scene, object);
    const double density = setup->box.dimensions == 3 ? mf_scene_mass_density(scene) : 0;
    if (density > densest && !reduced)
        mf_json_fault(object, "box",
                      "%g u a bead make %.3g g/cm^3: the mass, the box or the number of particles "
                      "is wrong",
                      mass / UNITS_ATOMIC_MASS, density);
    else if (density > densest && mass >= 1)
        mf_json_fault(&units, "mass", "it is in kg: %g u would be %.6g", mass, mass * atomic_mass);
    else if (density > densest)
        mf_json_fault(
            &units, "mass",
            "%g kg a bead, 1 u being %.6g, make %.3g g/cm^3: the mass, the unit of length, the "
            "box or the number of particles is wrong",
            mass, atomic_mass, density);
}

/// A vector has a number for each axis: one too many would act on nothing, one too few leave an
/// axis free.
static void check_vectors(struct json_object *object, const struct field *fields, int dimensions) {
    for (const struct field *field = fields; field->name; field++) {
        const int count = mf_json_count(object, field->name);
        if (field->type == FIELD_LENGTHS && (count == 2 || count == 3) && count != dimensions)
            mf_json_fault(object, field->name, "has %d numbers, but the scene has %d dimensions",
                          count, dimensions);
    }
}

static enum status read_interaction(struct scene_interactions *interactions,
                                    struct json_object *object, const struct interaction *kind) {
    struct json_object own = mf_json_child(object, kind->name, false);
    if (own.item == NULL)
        return STATUS_OK;
    void *parameters = mf_memory_zeroed(1, kind->parameters_size);
    if (parameters == NULL)
        return STATUS_NO_MEMORY;
    mf_json_fields(&own, kind->fields, parameters);
    check_vectors(&own, kind->fields, interactions->dimensions);
    if (kind->oriented && interactions->dimensions != 2)
        mf_json_fault(object, kind->name, "orientations are of two dimensions, not %d",
                      interactions->dimensions);
    mf_json_finish(&own);
    interactions->parameters[interactions->count] = parameters;
    interactions->choice[interactions->count++] = (struct interaction_choice){kind, parameters};
    return STATUS_OK;
}

/// In the order of mf_interaction_list.
static enum status read_interactions(struct scene_interactions *interactions,
                                     struct json_object *parent, struct simulation_setup *setup) {
    struct json_object object = mf_json_child(parent, "interactions", false);
    if (object.item == NULL)
        return STATUS_OK;
    interactions->dimensions = setup->box.dimensions;
    for (size_t k = 0; mf_interaction_list[k]; k++)
        TRY(read_interaction(interactions, &object, mf_interaction_list[k]));
    mf_json_finish(&object);
    memcpy(setup->interaction, interactions->choice, sizeof interactions->choice);
    setup->interactions = interactions->count;
    return STATUS_OK;
}

/// Molecules act, if there are any and the box is large enough for them.
static void enter_molecules(struct scene *scene, struct json_object *object) {
    const struct molecules *molecules = &scene->molecules.molecules;
    struct simulation_setup *setup = &scene->setup;
    if (!scene_has_molecules(&scene->molecules))
        return;
    if (mf_json_fault_count(object->document) == 0) {
        if (mf_molecules_check(molecules, &setup->box) != STATUS_OK)
            mf_json_fault(object, NULL, "%s", mf_status_marked());
        else
            mf_scene_molecules_warn_of_box(&scene->molecules, &setup->box, setup->temperature);
    }
    setup->interaction[setup->interactions++] =
        (struct interaction_choice){&mf_molecules, molecules};
}

/// Friction, of pairs whose potential is known.
static bool finds_friction_alone(int unknown) {
    return unknown && !(unknown & SCENE_FITS_POTENTIAL);
}

/// Lend the setup what the scene owns.
static void lend_laws(struct scene *scene) {
    scene->setup.potential = scene->potential.curves ? &scene->potential.table : NULL;
    scene->setup.omega = scene->omega.curves ? &scene->omega.table : NULL;
}

static void read_given(struct scene *scene, const struct json_object *object) {
    scene->given.conservative = mf_json_is_member(object, "conservative");
    scene->given.dissipative = mf_json_is_member(object, "dissipative");
    scene->given.transverse = mf_json_is_member(object, "dissipative_transverse");
    scene->given.memory = mf_json_is_member(object, "memory");
    scene->given.dynamics = mf_json_is_member(object, "dynamics");
}

enum status mf_scene_read(struct scene *scene, struct json_object *object, int unknown,
                          const struct scene_fitted *fitted) {
    *scene = (struct scene){.unknown = unknown};
    mf_units_read(&scene->units, object);
    read_top(scene, object);
    read_given(scene, object);
    TRY(mf_scene_particles_read(scene, object, fitted));
    check_units(scene, object);
    if (finds_friction_alone(unknown)) // between what particles, a fit would ask in vain
        mf_json_child(object, "conservative", true);
    if (!(unknown & SCENE_FITS_POTENTIAL)) {
        TRY(mf_scene_law_read(&scene->potential, object, "conservative", mf_curve_potentials,
                              &scene->setup.composition, &scene->units));
        TRY(mf_scene_law_tabulate(&scene->potential, mf_table_init_potential));
        mf_json_refuse(object, "known",
                       "it acts beside a potential that a fit looks for; here \"conservative\" "
                       "is all there is, and {\"law\": \"sum\"} adds laws");
    } else {
        TRY(mf_scene_law_read(&scene->known, object, "known", mf_curve_potentials,
                              &scene->setup.composition, &scene->units));
        TRY(mf_scene_law_tabulate(&scene->known, mf_table_init_potential));
    }
    if (!(unknown & SCENE_FITS_OMEGA)) {
        TRY(mf_scene_law_read(&scene->omega, object, "dissipative", mf_curve_omegas,
                              &scene->setup.composition, &scene->units));
        TRY(mf_scene_law_tabulate(&scene->omega, mf_table_init_omega));
        check_omega(scene, object);
    }
    TRY(mf_scene_memory_read(&scene->memory, object, &scene->setup.composition, &scene->units,
                             unknown & SCENE_FITS_MEMORY));
    scene->setup.memory = mf_scene_memory_law(&scene->memory);
    TRY(read_interactions(&scene->interactions, object, &scene->setup));
    TRY(mf_scene_many_body_read(&scene->many_body, object, &scene->setup, fitted != NULL));
    enter_molecules(scene, object);
    TRY(mf_scene_dynamics_read(scene, object));
    lend_laws(scene);
    return STATUS_OK;
}

enum status mf_scene_complete(struct scene *scene, struct json_object *object,
                              const struct integrator *integrator, int64_t inner_steps) {
    struct table *const omega = &scene->omega.table;
    mf_scene_particles_complete(scene, object);
    if (scene->omega.curves > 0 && omega->curves == 0)
        TRY(mf_scene_law_tabulate(&scene->omega, mf_table_init_omega));
    lend_laws(scene);
    return mf_scene_dynamics_complete(scene, object, integrator, inner_steps);
}

static void clear_interactions(struct scene_interactions *interactions) {
    for (int k = 0; k < interactions->count; k++)
        mf_memory_free(interactions->parameters[k]);
    *interactions = (struct scene_interactions){0};
}

void mf_scene_clear(struct scene *scene) {
    mf_scene_law_clear(&scene->potential);
    mf_scene_law_clear(&scene->known);
    mf_scene_law_clear(&scene->omega);
    mf_scene_memory_clear(&scene->memory);
    mf_scene_many_body_clear(&scene->many_body);
    mf_memory_free(scene->start_values);
    mf_memory_free(scene->integrator_parameters);
    clear_interactions(&scene->interactions);
    mf_scene_molecules_clear(&scene->molecules);
    *scene = (struct scene){0};
}

const char *mf_scene_warning(const struct scene *scene) {
    const struct integrator *integrator = scene->setup.integrator;
    const char *own = integrator->warning ? integrator->warning(&scene->setup) : NULL;
    if (own)
        return own;
    if (scene->molecules.warning[0])
        return scene->molecules.warning;
    if (mf_pair_memory_is_coarse(&scene->setup.memory, scene->setup.time_step))
        return "\"time_step\" is too long for \"memory\": beyond half of a \"time\" or of "
               "1/\"frequency\", or where a pair's friction is strong, what acts is another "
               "friction; a tenth of both follows it, and a short memory is \"dissipative\"";
    if (simulation_holds_temperature(&scene->setup) || integrator->events ||
        (scene->unknown & ~SCENE_FITS_POTENTIAL))
        return NULL;
    return "there is no thermostat: without \"dissipative\", friction and noise, a simulation "
           "conserves its energy, and its temperature drifts";
}

/// Vectors with a number for each axis, be it 0.
static void write_parameter(const struct field *field, const char *parameters, int dimensions,
                            struct json_writer *writer) {
    const struct field one[] = {*field, FIELD_END};
    double vector[3];
    if (field->type != FIELD_LENGTHS) {
        mf_json_write_fields(writer, one, parameters);
        return;
    }
    memcpy(vector, parameters + field->offset, sizeof vector);
    mf_json_write_quantities(writer, field->name, field->unit, vector, (size_t)dimensions);
}

static void write_interactions(const struct scene_interactions *interactions,
                               struct json_writer *writer) {
    if (interactions->count == 0)
        return;
    mf_json_begin(writer, "interactions");
    for (int k = 0; k < interactions->count; k++) {
        const struct interaction *kind = interactions->choice[k].kind;
        mf_json_begin(writer, kind->name);
        for (const struct field *field = kind->fields; field->name; field++)
            write_parameter(field, interactions->parameters[k], interactions->dimensions, writer);
        mf_json_end(writer);
    }
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
    mf_json_write_fields(writer, mf_scene_fields, &top);
    mf_scene_particles_write(scene, writer);
    mf_scene_molecules_write(&scene->molecules, &setup->composition, writer);
    if (scene->potential.curves || finds_friction_alone(scene->unknown))
        mf_scene_law_write(&scene->potential, &setup->composition, writer, "conservative");
    if (scene->known.curves)
        mf_scene_law_write(&scene->known, &setup->composition, writer, "known");
    if (scene->omega.curves)
        mf_scene_law_write(&scene->omega, &setup->composition, writer, "dissipative");
    mf_scene_memory_write(&scene->memory, &setup->composition, writer);
    mf_scene_many_body_write(&scene->many_body, writer);
    write_interactions(&scene->interactions, writer);
    mf_json_begin(writer, "dynamics");
    mf_json_write_text(writer, "integrator", setup->integrator->name);
    mf_json_write_fields(writer, setup->integrator->fields, setup->integrator_parameters);
    mf_json_end(writer);
    if (mf_units_have_second_columns(&scene->units)) {
        mf_json_begin(writer, "units");
        mf_json_write_fields(writer, mf_units_fields, &scene->units);
        mf_json_end(writer);
    }
}

void mf_scene_digest(const struct scene *scene, uint64_t *digest) {
    mf_scene_law_digest(&scene->potential, digest);
    mf_scene_law_digest(&scene->known, digest);
    mf_scene_law_digest(&scene->omega, digest);
    mf_scene_memory_digest(&scene->memory, digest);
    mf_scene_many_body_digest(&scene->many_body, digest);
    mf_scene_molecules_digest(&scene->molecules, digest);
    mf_scene_particles_digest(scene, digest);
}
