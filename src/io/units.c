// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units.h"

#include "base/memory.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct units, name)
const struct field mf_units_fields[] = {
    {"length", FIELD_NUMBER, MEMBER(length), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "nm", .help = "the unit of length, lambda"},
    {"temperature", FIELD_NUMBER, MEMBER(temperature), .required = true,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "K",
     .help = "T_0, which makes k_B T_0 the unit of energy"},
    {"mass", FIELD_NUMBER, MEMBER(mass), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "kg", .help = "of a particle"},
    FIELD_END,
};

void mf_units_read(struct units *units, struct json_object *scene) {
    struct json_object object = mf_json_child(scene, "units", false);
    const size_t faults = mf_json_fault_count(object.document);
    mf_json_fields(&object, mf_units_fields, units);
    if (object.item == NULL)
        return;
    mf_json_finish(&object);
    const double derived[] = {mf_units_time_ps(units), mf_units_energy_kj_per_mol(units),
                              mf_units_pressure_bar(units), mf_units_diffusion_cm2_per_s(units)};
    for (size_t k = 0; k < sizeof derived / sizeof *derived; k++)
        if (mf_json_fault_count(object.document) == faults && !isnormal(derived[k]))
            mf_json_fault(scene, "units",
                          "no numbers can hold the units of time, energy, pressure and "
                          "diffusion that these make");
}

bool mf_units_known(const struct units *units) {
    return units->length > 0;
}

double mf_units_energy_kj_per_mol(const struct units *units) {
    return UNITS_BOLTZMANN * units->temperature * UNITS_AVOGADRO * 1e-3;
}

double mf_units_time_ps(const struct units *units) {
    const double metres = units->length * 1e-9;
    return metres * sqrt(units->mass / (UNITS_BOLTZMANN * units->temperature)) * 1e12;
}

double mf_units_pressure_bar(const struct units *units) {
    return UNITS_BOLTZMANN * units->temperature / pow(units->length * 1e-9, 3) * 1e-5;
}

double mf_units_diffusion_cm2_per_s(const struct units *units) {
    const double centimetres = units->length * 1e-7;
    return centimetres * centimetres / (mf_units_time_ps(units) * 1e-12);
}

double *mf_units_column(const double *values, size_t count, double factor) {
    double *column = mf_memory_zeroed(count, sizeof *column);
    for (size_t k = 0; column && k < count; k++)
        column[k] = factor * values[k];
    return column;
}

void mf_units_put(const struct units *units, struct json_writer *writer, double energy,
                  double pressure) {
    if (!mf_units_known(units))
        return;
    mf_json_begin(writer, "physical");
    mf_json_put_number(writer, "length_unit_nm", units->length);
    mf_json_put_number(writer, "time_unit_ps", mf_units_time_ps(units));
    mf_json_put_number(writer, "energy_unit_kJ_per_mol", mf_units_energy_kj_per_mol(units));
    mf_json_put_number(writer, "diffusion_unit_cm2_per_s", mf_units_diffusion_cm2_per_s(units));
    mf_json_put_number(writer, "potential_energy_kJ_per_mol",
                       energy * mf_units_energy_kj_per_mol(units));
    mf_json_put_number(writer, "pressure_bar", pressure * mf_units_pressure_bar(units));
    mf_json_end(writer);
}
