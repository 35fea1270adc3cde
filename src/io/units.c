// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units.h"

#include "io/json.h"

#include <math.h>

// How many beads a scene has ----------------------------------------------------------------------

/// Beads that were found so far.
struct found {
    struct json_object mass; ///< of the types
    double count, sum;       ///< sum of the masses
};

/// An object if one stands there: what else does is the reader's to say.
static struct json_object peek(const struct json_object *parent, const char *key) {
    struct json_object looked = *parent;
    return mf_json_is_object(parent, key) ? mf_json_child(&looked, key, false)
                                          : (struct json_object){.document = parent->document};
}

/// A number, or the middle of the range in which it is looked for; 0 if there is none.
static double find_mass(const struct json_object *parent, const char *key) {
    const struct json_object range = peek(parent, key);
    double mass, minimum, maximum;
    if (mf_json_numbers(parent, key, &mass, 1) == 1)
        return mass;
    if (mf_json_numbers(&range, "minimum", &minimum, 1) == 1 &&
        mf_json_numbers(&range, "maximum", &maximum, 1) == 1)
        return 0.5 * (minimum + maximum);
    return 0;
}

static void add(struct found *found, const char *type, double count) {
    found->count += count;
    found->sum += count * find_mass(&found->mass, type);
}

/// "beads" of a molecule or a chain: the type of each.
static void add_beads(struct found *found, const struct json_object *object, double molecules) {
    const int beads = mf_json_count(object, "beads");
    for (int k = 0; k < beads; k++) {
        const char *const type = mf_json_list_text(object, "beads", (size_t)k);
        if (type)
            add(found, type, molecules);
    }
}

static void add_molecules(struct found *found, const struct json_object *molecules) {
    const char *kind;
    for (size_t n = 0; (kind = mf_json_key(molecules, n)); n++) {
        const struct json_object molecule = peek(molecules, kind);
        const struct json_object chain = peek(&molecule, "chain");
        const char *const type = mf_json_list_text(&chain, "type", 0);
        double count, length;
        if (mf_json_numbers(&molecule, "count", &count, 1) != 1)
            continue;
        add_beads(found, &molecule, count);
        add_beads(found, &chain, count);
        if (type && mf_json_numbers(&chain, "length", &length, 1) == 1)
            add(found, type, count * length);
    }
}

/// How many beads there are, single ones and those of molecules that stand in the scene itself; 0
/// if a fault will tell why it is not known.
static double find_beads(const struct json_object *scene, double *mean_mass) {
    const struct json_object particles = peek(scene, "particles");
    const struct json_object types = peek(&particles, "types");
    const struct json_object molecules = peek(scene, "molecules");
    struct found found = {.mass = peek(&particles, "mass")};
    const char *type;
    double number;
    for (size_t n = 0; (type = mf_json_key(&types, n)); n++)
        if (mf_json_numbers(&types, type, &number, 1) == 1)
            add(&found, type, number);
    mf_json_numbers(&particles, "count", &found.count, 1);
    add_molecules(&found, &molecules);
    *mean_mass = find_mass(&particles, "mass");
    if (*mean_mass == 0 && found.count > 0)
        *mean_mass = found.sum / found.count;
    return found.count;
}

// Units of a file ---------------------------------------------------------------------------------

#define MEMBER(name) .offset = offsetof(struct units, name)
const struct field mf_units_fields[] = {
    {"length", FIELD_NUMBER, MEMBER(length), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "nm", .help = "unit of length, lambda"},
    {"temperature", FIELD_NUMBER, MEMBER(temperature), .required = true,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "K",
     .help = "T_0, which makes k_B T_0 the unit of energy"},
    {"mass", FIELD_NUMBER, MEMBER(mass), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "kg", .help = "mass of a particle"},
    FIELD_END,
};

/// What a file in physical units says of its scale, in them.
struct system {
    int kind; ///< enum units_system, less one
    double length, temperature, mass;
    bool massless; ///< neither here nor of the beads
};

#define SYSTEM(name) .offset = offsetof(struct system, name)
#define SCALE .initial = NAN, .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX
const struct field mf_units_system_fields[] = {
    {"system", FIELD_CHOICE, SYSTEM(kind), .required = true, .choices = mf_units_systems + 1,
     .unit = "", .help = "units of the file, its tables and results"},
    {"length", FIELD_NUMBER, SYSTEM(length), SCALE, .unit = "nm or angstrom",
     .help = "lambda; default: three beads in lambda^d"},
    {"temperature", FIELD_NUMBER, SYSTEM(temperature), SCALE, .unit = "K",
     .help = "T_0; default: the scene's temperature"},
    {"mass", FIELD_NUMBER, SYSTEM(mass), SCALE, .unit = "u",
     .help = "mu; default: mean mass of the scene's beads, or 1"},
    FIELD_END,
};

/// u per kg, and units of length per nm.
static const double masses = 1 / UNITS_ATOMIC_MASS;
static double lengths(int system) {
    return system == UNITS_ANGSTROM_FS ? 10 : 1;
}

static bool can_be_held(const struct units *units) {
    return isnormal(mf_units_time_ps(units)) && isnormal(mf_units_energy_kj_per_mol(units)) &&
           isnormal(mf_units_pressure_bar(units)) && isnormal(mf_units_diffusion_cm2_per_s(units));
}

static void fault_unrepresentable(struct json_object *object) {
    mf_json_fault(object, "units",
                  "the resulting units of time, energy, pressure or diffusion are out of the range "
                  "of floating-point numbers");
}

// The scale that follows from a scene -------------------------------------------------------------

/// Of space, by what the scene says first.
static int find_dimensions(const struct json_object *scene) {
    double dimensions = 3, box[3];
    mf_json_numbers(scene, "dimensions", &dimensions, 1);
    return dimensions == 2 || mf_json_numbers(scene, "box", box, 3) == 2 ? 2 : 3;
}

/// The edge of a cube, or square, that holds three of the beads. Those of molecules overlap, so
/// that their number does not tell their size: with them, and if there is no number, it is 1 nm.
static double find_length(const struct json_object *scene, double beads, int kind) {
    double box[3], volume = 1, density;
    const int edges = mf_json_numbers(scene, "box", box, 3);
    if (mf_json_is_object(scene, "molecules"))
        return lengths(kind + 1);
    if (mf_json_numbers(scene, "density", &density, 1) == 1 && density > 0)
        return pow(3 / density, 1.0 / find_dimensions(scene));
    for (int d = 0; d < edges; d++)
        volume *= box[d];
    return edges >= 2 && beads > 0 && volume > 0 ? pow(3 * volume / beads, 1.0 / edges)
                                                 : lengths(kind + 1);
}

/// Fill in what the file does not say.
static void complete(struct system *system, struct json_object *scene) {
    double mean_mass;
    const double beads = find_beads(scene, &mean_mass);
    if (isnan(system->length))
        system->length = find_length(scene, beads, system->kind);
    system->massless = isnan(system->mass) && !(mean_mass > 0);
    if (isnan(system->mass))
        system->mass = mean_mass > 0 ? mean_mass : 1;
    if (!isnan(system->temperature))
        return;
    const bool is_number =
        mf_json_numbers(scene, "temperature", &system->temperature, 1) == 1 && scene->item;
    if (!is_number || !(system->temperature > 0)) {
        // What is no number is told where it is read.
        if (scene->item && (is_number || !mf_json_has(scene, "temperature")))
            mf_json_fault(
                scene, "temperature",
                is_number && system->temperature < 0 ? "below 0 K: temperatures are in kelvins"
                : is_number
                    ? "0 K gives no unit of energy; \"temperature\" of \"units\" gives another"
                : scene->path[0]
                    ? "missing: expected a number (K), as fit --target DIR takes it by "
                      "--temperature"
                    : "missing: expected a number (K)");
        system->temperature = 300;
    }
}

/// "units": "nm-ps", or an object with "system"; false if the file is reduced.
static bool read_system(struct system *system, struct json_object *root) {
    if (mf_json_is_object(root, "units")) {
        struct json_object looked = peek(root, "units");
        if (!mf_json_has(&looked, "system"))
            return false;
        struct json_object object = mf_json_child(root, "units", false);
        mf_json_fields(&object, mf_units_system_fields, system);
        mf_json_finish(&object);
        return true;
    }
    mf_fields_set_defaults(mf_units_system_fields, system);
    const char *name = mf_json_choice(root, "units", mf_units_systems, mf_units_systems[0]);
    system->kind = name ? mf_fields_choice_index(mf_units_system_fields, name) : -1;
    return system->kind >= 0;
}

void mf_units_read_document(struct json_object *root, struct json_object *scene) {
    struct system system;
    if (!read_system(&system, root)) {
        if (root->item != scene->item && mf_json_is_object(root, "units") &&
            mf_json_has(root, "units"))
            mf_json_fault(root, "units",
                          "\"system\" is missing; units without it belong into \"scene\"");
        return;
    }
    const size_t faults = mf_json_fault_count(root->document);
    const bool chosen = isnan(system.length);
    complete(&system, scene);
    const struct units units = {.length = system.length / lengths(system.kind + 1),
                                .temperature = system.temperature,
                                .mass = system.mass / masses,
                                .system = system.kind + 1,
                                .chosen = chosen,
                                .massless = system.massless,
                                .dimensions = find_dimensions(scene)};
    if (mf_json_fault_count(root->document) == faults && !can_be_held(&units))
        fault_unrepresentable(root);
    mf_json_set_units(root->document, &units);
}

// The units of a scene ----------------------------------------------------------------------------

void mf_units_read(struct units *units, struct json_object *scene) {
    const bool is_root = scene->path[0] == '\0';
    if (is_root)
        mf_units_read_document(scene, scene);
    *units = *mf_json_units(scene);
    if (mf_units_are_physical(units) || (is_root && !mf_json_is_object(scene, "units"))) {
        if (!is_root)
            mf_json_refuse(scene, "units", "the file's units are at its top; leave them out");
        return;
    }
    struct json_object object = mf_json_child(scene, "units", false);
    const size_t faults = mf_json_fault_count(object.document);
    mf_json_fields(&object, mf_units_fields, units);
    if (object.item == NULL)
        return;
    units->dimensions = find_dimensions(scene);
    mf_json_finish(&object);
    if (mf_json_fault_count(object.document) == faults && !can_be_held(units))
        fault_unrepresentable(scene);
}

// Written -----------------------------------------------------------------------------------------

/// @param[in] with_mass  false: who reads it again is not to take for a mass what stands for none
static void write_scale(const struct units *units, struct json_writer *writer, bool with_mass) {
    mf_json_write_text(writer, "system", mf_units_systems[units->system]);
    mf_json_write_number(writer, "length",
                         mf_units_file_value(units->length, lengths(units->system)));
    mf_json_write_number(writer, "temperature", units->temperature);
    if (with_mass)
        mf_json_write_number(writer, "mass", mf_units_file_value(units->mass, masses));
}

void mf_units_write(const struct units *units, struct json_writer *writer) {
    if (!mf_units_are_physical(units))
        return;
    mf_json_writer_set_units(writer, units);
    mf_json_begin(writer, "units");
    write_scale(units, writer, !units->massless);
    mf_json_end(writer);
}

void mf_units_write_summary(const struct units *units, struct json_writer *writer) {
    static const char *const derived[][2] = {{"time", "tau"},
                                             {"energy", "k_B T_0"},
                                             {"pressure", "k_B T_0/lambda^d"},
                                             {"friction", "mu/tau"},
                                             {"diffusion", "lambda^2/tau"}};
    if (!mf_units_are_physical(units))
        return;
    mf_json_writer_set_units(writer, units);
    mf_json_begin(writer, "units");
    write_scale(units, writer, true);
    for (size_t k = 0; k < sizeof derived / sizeof *derived; k++)
        mf_json_write_quantity(writer, derived[k][0], derived[k][1], 1);
    if (units->dimensions == 2) // of pressure, which is then of an area
        mf_json_write_integer(writer, "dimensions", 2);
    mf_json_end(writer);
}

void mf_units_write_results(const struct units *units, struct json_writer *writer, double energy,
                            double pressure) {
    if (!mf_units_have_second_columns(units))
        return;
    mf_json_begin(writer, "physical");
    mf_json_write_number(writer, "length_unit_nm", units->length);
    mf_json_write_number(writer, "time_unit_ps", mf_units_time_ps(units));
    mf_json_write_number(writer, "energy_unit_kJ_per_mol", mf_units_energy_kj_per_mol(units));
    mf_json_write_number(writer, "diffusion_unit_cm2_per_s", mf_units_diffusion_cm2_per_s(units));
    mf_json_write_number(writer, "potential_energy_kJ_per_mol",
                         energy * mf_units_energy_kj_per_mol(units));
    if (units->dimensions != 2) // there it is energy over an area
        mf_json_write_number(writer, "pressure_bar", pressure * mf_units_pressure_bar(units));
    mf_json_end(writer);
}
