// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units_scale.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "io/units_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const mf_units_systems[] = {"reduced", "nm-ps", "angstrom-fs", NULL};

bool mf_units_are_physical(const struct units *units) {
    return units && units->system != UNITS_REDUCED;
}

bool mf_units_known(const struct units *units) {
    return units->length > 0;
}

bool mf_units_have_second_columns(const struct units *units) {
    return mf_units_known(units) && !mf_units_are_physical(units);
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

// Reduced units in those of a file ----------------------------------------------------------------

/// The parts of unit names, in their order in a name.
enum quantity { ENERGY, MASS, LENGTH, TIME, TEMPERATURE, QUANTITIES };

struct physical {
    const char *name[QUANTITIES], *pressure;
    double nanometre, picosecond, kilojoule, bar; ///< in the physical units
};

static const struct physical physical[] = {
    [UNITS_NM_PS] = {{"kJ/mol", "u", "nm", "ps", "K"}, "bar", 1, 1, 1, 1},
    [UNITS_ANGSTROM_FS] =
        {{"kcal/mol", "g/mol", "angstrom", "fs", "K"}, "atm", 10, 1e3, 1 / 4.184, 1 / 1.01325},
};

/// A unit as energies, masses, lengths, times and temperatures.
struct dimension {
    double exponent[QUANTITIES];
    bool is_pressure; ///< energy over a volume, which has a name of its own
};

/// Whether there is something to convert: the unit is one that the scene sets, and is written in
/// others.
static bool find_dimension(const struct units *units, const char *text,
                           struct dimension *dimension) {
    struct units_text unit;
    bool scaled = false;
    if (!mf_units_are_physical(units) || !mf_units_text_parse(&unit, text, units->dimensions))
        return false;
    for (int base = 0; base < UNITS_BASES; base++) {
        if (base >= UNITS_SCALED && unit.exponent[base] != 0)
            return false;
        scaled = scaled || unit.exponent[base] != 0;
    }
    double *exponent = dimension->exponent;
    exponent[ENERGY] = unit.exponent[UNITS_K_B];
    exponent[TEMPERATURE] = unit.exponent[UNITS_T_0] - unit.exponent[UNITS_K_B];
    exponent[MASS] = unit.exponent[UNITS_MU];
    exponent[LENGTH] = unit.exponent[UNITS_LAMBDA];
    exponent[TIME] = unit.exponent[UNITS_TAU];
    dimension->is_pressure = exponent[ENERGY] == 1 && exponent[LENGTH] == -3 &&
                             exponent[MASS] == 0 && exponent[TIME] == 0 &&
                             exponent[TEMPERATURE] == 0;
    return scaled && unit.factor == 1;
}

double mf_units_factor(const struct units *units, const char *unit) {
    struct dimension dimension;
    if (!find_dimension(units, unit, &dimension))
        return 1;
    const struct physical *to = &physical[units->system];
    if (dimension.is_pressure)
        return mf_units_pressure_bar(units) * to->bar;
    const double scale[QUANTITIES] = {[ENERGY] = mf_units_energy_kj_per_mol(units) * to->kilojoule,
                                      [MASS] = units->mass / UNITS_ATOMIC_MASS,
                                      [LENGTH] = units->length * to->nanometre,
                                      [TIME] = mf_units_time_ps(units) * to->picosecond,
                                      [TEMPERATURE] = units->temperature};
    double factor = 1;
    for (int k = 0; k < QUANTITIES; k++)
        if (dimension.exponent[k] != 0)
            factor *= pow(scale[k], dimension.exponent[k]);
    return factor;
}

/// Add "nm^2" or "/(kJ/mol)" to a name.
static void add_power(char *name, const char *unit, double exponent, bool over) {
    const bool inner = strchr(unit, '/') && (over || exponent != 1);
    char power[16] = "";
    if (exponent != 1)
        snprintf(power, sizeof power, "^%.0f", exponent);
    const size_t length = strlen(name);
    snprintf(name + length, UNITS_NAME_SIZE - length, "%s%s%s%s%s",
             over                                     ? "/"
             : length == 0 || name[length - 1] == '(' ? ""
                                                      : ".",
             inner ? "(" : "", unit, inner ? ")" : "", power);
}

const char *mf_units_name(const struct units *units, const char *unit, char *name) {
    struct dimension dimension;
    if (!find_dimension(units, unit, &dimension)) {
        snprintf(name, UNITS_NAME_SIZE, "%s", unit);
        return name;
    }
    const struct physical *to = &physical[units->system];
    if (dimension.is_pressure) {
        snprintf(name, UNITS_NAME_SIZE, "%s", to->pressure);
        return name;
    }
    double root = 1;
    for (int k = 0; k < QUANTITIES; k++)
        root = dimension.exponent[k] == floor(dimension.exponent[k]) ? root : 2;
    strcpy(name, root == 2 ? "sqrt(" : "");
    const size_t begin = strlen(name);
    for (int k = 0; k < QUANTITIES; k++)
        if (dimension.exponent[k] > 0)
            add_power(name, to->name[k], root * dimension.exponent[k], false);
    if (strlen(name) == begin)
        strcat(name, "1");
    for (int k = 0; k < QUANTITIES; k++)
        if (dimension.exponent[k] < 0)
            add_power(name, to->name[k], -root * dimension.exponent[k], true);
    strcat(name, root == 2 ? ")" : "");
    return name;
}

const char *mf_units_suffix(const struct units *units, const char *unit, char *name) {
    name[0] = name[1] = '\0';
    if (!mf_units_are_physical(units) || strcmp(unit, "1") == 0)
        return name;
    char text[UNITS_NAME_SIZE];
    mf_units_name(units, unit, text);
    snprintf(name, UNITS_NAME_SIZE, "%s%.120s", text[0] ? " " : "", text);
    return name;
}

const char *mf_units_measured(const struct units *units, const char *unit, double value,
                              double error, char text[UNITS_MEASURED_SIZE]) {
    const double factor = mf_units_factor(units, unit);
    char name[UNITS_NAME_SIZE];
    mf_number_text(factor * value, factor * error, text);
    strncat(text, mf_units_suffix(units, unit, name), UNITS_MEASURED_SIZE - NUMBER_TEXT_SIZE);
    return text;
}

double mf_units_file_value(double reduced, double factor) {
    const double near = reduced * factor;
    char text[32];
    if (!isfinite(near) || factor == 1)
        return near;
    snprintf(text, sizeof text, "%.15g", near);
    const double shortest = strtod(text, NULL);
    if (shortest / factor == reduced)
        return shortest;
    double above = near, below = near;
    for (int step = 0; step < 3; step++) {
        if (above / factor == reduced)
            return above;
        if (below / factor == reduced)
            return below;
        above = nextafter(above, INFINITY);
        below = nextafter(below, -INFINITY);
    }
    return near;
}

// Other units in reduced ones ---------------------------------------------------------------------

/// Replace the units that the scene sets by those of SI.
static void resolve(struct units_text *unit, const struct units *units) {
    const double scale[UNITS_SCALED] = {[UNITS_LAMBDA] = units->length * 1e-9,
                                        [UNITS_TAU] = mf_units_time_ps(units) * 1e-12,
                                        [UNITS_MU] = units->mass,
                                        [UNITS_K_B] = UNITS_BOLTZMANN,
                                        [UNITS_T_0] = units->temperature};
    double *exponent = unit->exponent;
    for (int base = 0; base < UNITS_SCALED; base++)
        if (exponent[base] != 0)
            unit->factor *= pow(scale[base], exponent[base]);
    exponent[UNITS_METRE] += exponent[UNITS_LAMBDA] + 2 * exponent[UNITS_K_B];
    exponent[UNITS_SECOND] += exponent[UNITS_TAU] - 2 * exponent[UNITS_K_B];
    exponent[UNITS_KILOGRAM] += exponent[UNITS_MU] + exponent[UNITS_K_B];
    exponent[UNITS_KELVIN] += exponent[UNITS_T_0] - exponent[UNITS_K_B];
}

enum status mf_units_from(const struct units *units, const char *from, const char *unit,
                          double *factor) {
    struct units_text given, wanted;
    *factor = 1;
    if (!mf_units_text_parse(&given, from, units->dimensions))
        return mf_status_fail(STATUS_BAD_INPUT, "unknown unit \"%.60s\"", from);
    if (!mf_units_text_parse(&wanted, unit, units->dimensions))
        return STATUS_OK;
    if (units->chosen && (given.exponent[UNITS_LAMBDA] != 0 || given.exponent[UNITS_TAU] != 0))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "\"%.60s\" needs the lambda that it was written with: give it as "
                              "\"length\" of \"units\"",
                              from);
    resolve(&given, units);
    resolve(&wanted, units);
    for (int base = UNITS_SCALED; base < UNITS_BASES; base++)
        if (given.exponent[base] != wanted.exponent[base]) {
            char name[UNITS_NAME_SIZE];
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "\"%.60s\" is not a unit of the same kind as %s", from,
                                  mf_units_name(units, unit, name));
        }
    *factor = given.factor / wanted.factor;
    return STATUS_OK;
}

/// The number that a text ends with: where it begins, NULL if there is none, and its digits.
static char *find_number(char *text, double *number, int *digits) {
    const size_t length = strlen(text);
    size_t begin = length;
    while (begin > 0 && strchr("0123456789.e+-naif", text[begin - 1]))
        begin--;
    char *end;
    *number = strtod(text + begin, &end);
    *digits = 0;
    for (const char *at = text + begin; *at && *at != 'e'; at++)
        *digits += *at >= '0' && *at <= '9';
    return begin < length && *end == '\0' ? text + begin : NULL;
}

/// Replace the number at the end of a text by that in the file's unit, in one digit less, as the
/// last one has been rounded.
static void convert_last(const struct units *units, const char *unit, char *text, size_t size) {
    enum { FEWEST_DIGITS = 3 };
    char name[UNITS_NAME_SIZE];
    double number;
    int digits;
    char *const begin = find_number(text, &number, &digits);
    if (begin)
        snprintf(begin, size - (size_t)(begin - text), "%.*g%s",
                 digits > FEWEST_DIGITS ? digits - 1 : FEWEST_DIGITS,
                 mf_units_factor(units, unit) * number, mf_units_suffix(units, unit, name));
}

void mf_units_convert_text(const struct units *units, char *text, size_t size) {
    char converted[STATUS_MESSAGE_SIZE] = "", unit[UNITS_NAME_SIZE];
    const char mark[] = {STATUS_MARK, '\0'};
    if (!mf_units_are_physical(units)) {
        mf_status_strip(text);
        return;
    }
    for (const char *at = text; *at;) {
        const size_t plain = strcspn(at, mark), used = strlen(converted);
        snprintf(converted + used, sizeof converted - used, "%.*s", (int)plain, at);
        at += plain + (at[plain] != '\0');
        const size_t length = strcspn(at, mark);
        snprintf(unit, sizeof unit, "%.*s", (int)length, at);
        if (at[length] != '\0')
            convert_last(units, unit, converted, sizeof converted);
        at += length + (at[length] != '\0');
    }
    snprintf(text, size, "%s", converted);
}

enum status mf_units_convert_message(const struct units *units, enum status status) {
    char message[STATUS_MESSAGE_SIZE];
    if (status == STATUS_OK)
        return status;
    snprintf(message, sizeof message, "%s", mf_status_marked());
    mf_units_convert_text(units, message, sizeof message);
    return mf_status_fail(status, "%s", message);
}

void mf_units_print(const struct units *units, char line[UNITS_LINE_SIZE]) {
    static const char *const symbol[] = {"lambda", "T_0", "mu", "tau", "k_B T_0"};
    int length = snprintf(line, UNITS_LINE_SIZE, "%s:", mf_units_systems[units->system]);
    for (size_t k = 0; k < sizeof symbol / sizeof *symbol; k++) {
        char name[UNITS_NAME_SIZE];
        const bool assumed = units->massless && strcmp(symbol[k], "mu") == 0;
        length += snprintf(line + length, UNITS_LINE_SIZE - (size_t)length, "%s %s = %.6g %s%s",
                           k ? "," : "", symbol[k], mf_units_factor(units, symbol[k]),
                           mf_units_name(units, symbol[k], name),
                           assumed ? " (no mass is given: times have no meaning)" : "");
    }
}
