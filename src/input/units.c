// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/units.h"

#include "base/memory.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct units, name)
const struct field units_fields[] = {
    {"length", FIELD_NUMBER, MEMBER(length), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "nm", .help = "the unit of length, lambda"},
    {"temperature", FIELD_NUMBER, MEMBER(temperature), .required = true,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "K",
     .help = "T_0, which makes k_B T_0 the unit of energy"},
    {"mass", FIELD_NUMBER, MEMBER(mass), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "kg", .help = "of a particle"},
    FIELD_END,
};

void units_read(struct units *units, struct json_object *scene) {
    struct json_object object = json_child(scene, "units", false);
    const size_t faults = json_fault_count(object.document);
    json_fields(&object, units_fields, units);
    if (object.item == NULL)
        return;
    json_finish(&object);
    const double derived[] = {units_time_ps(units), units_energy_kj_per_mol(units),
                              units_pressure_bar(units), units_diffusion_cm2_per_s(units)};
    for (size_t k = 0; k < sizeof derived / sizeof *derived; k++)
        if (json_fault_count(object.document) == faults && !isnormal(derived[k]))
            json_fault(scene, "units",
                       "no numbers can hold the units of time, energy, pressure and "
                       "diffusion that these make");
}

bool units_known(const struct units *units) {
    return units->length > 0;
}

double units_energy_kj_per_mol(const struct units *units) {
    return UNITS_BOLTZMANN * units->temperature * UNITS_AVOGADRO * 1e-3;
}

double units_time_ps(const struct units *units) {
    const double metres = units->length * 1e-9;
    return metres * sqrt(units->mass / (UNITS_BOLTZMANN * units->temperature)) * 1e12;
}

double units_pressure_bar(const struct units *units) {
    return UNITS_BOLTZMANN * units->temperature / pow(units->length * 1e-9, 3) * 1e-5;
}

double units_diffusion_cm2_per_s(const struct units *units) {
    const double centimetres = units->length * 1e-7;
    return centimetres * centimetres / (units_time_ps(units) * 1e-12);
}

double *units_column(const double *values, size_t count, double factor) {
    double *column = memory_zeroed(count, sizeof *column);
    for (size_t k = 0; column && k < count; k++)
        column[k] = factor * values[k];
    return column;
}

void units_put(const struct units *units, struct json_writer *writer, double energy,
               double pressure) {
    if (!units_known(units))
        return;
    json_begin(writer, "physical");
    json_put_number(writer, "length_unit_nm", units->length);
    json_put_number(writer, "time_unit_ps", units_time_ps(units));
    json_put_number(writer, "energy_unit_kJ_per_mol", units_energy_kj_per_mol(units));
    json_put_number(writer, "diffusion_unit_cm2_per_s", units_diffusion_cm2_per_s(units));
    json_put_number(writer, "potential_energy_kJ_per_mol", energy * units_energy_kj_per_mol(units));
    json_put_number(writer, "pressure_bar", pressure * units_pressure_bar(units));
    json_end(writer);
}
