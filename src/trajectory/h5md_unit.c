// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/h5md_unit.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// One mole, and one gram in u: CODATA 2018.
#define MOLE 6.02214076e23
#define GRAM 6.02214076208e23

/// Powers of nm, ps and u in a unit.
enum { POWERS = 3 };

static const struct symbol {
    const char *name;
    double factor;
    int power[POWERS];
} symbols[] = {
    {"nm", 1, {1, 0, 0}},
    {"Angstrom", 0.1, {1, 0, 0}},
    {"angstrom", 0.1, {1, 0, 0}},
    {"A", 0.1, {1, 0, 0}},
    {"\xC3\x85", 0.1, {1, 0, 0}},
    {"\xE2\x84\xAB", 0.1, {1, 0, 0}},
    {"pm", 1e-3, {1, 0, 0}},
    {"um", 1e3, {1, 0, 0}},
    {"mm", 1e6, {1, 0, 0}},
    {"cm", 1e7, {1, 0, 0}},
    {"m", 1e9, {1, 0, 0}},
    {"fs", 1e-3, {0, 1, 0}},
    {"ps", 1, {0, 1, 0}},
    {"ns", 1e3, {0, 1, 0}},
    {"us", 1e6, {0, 1, 0}},
    {"ms", 1e9, {0, 1, 0}},
    {"s", 1e12, {0, 1, 0}},
    {"u", 1, {0, 0, 1}},
    {"amu", 1, {0, 0, 1}},
    {"Da", 1, {0, 0, 1}},
    {"kDa", 1e3, {0, 0, 1}},
    {"AKMA", 0.0488882129, {0, 1, 0}}, // sqrt(u Å²/(kcal/mol)), of CHARMM
    {"g", GRAM, {0, 0, 1}},
    {"kg", 1e3 * GRAM, {0, 0, 1}},
    {"mol", MOLE, {0, 0, 0}},
};

static const struct {
    const char *name;
    int power[POWERS];
} kinds[] = {[H5MD_LENGTH] = {"a length", {1, 0, 0}},
             [H5MD_TIME] = {"a time", {0, 1, 0}},
             [H5MD_SPEED] = {"a speed", {1, -1, 0}},
             [H5MD_MASS] = {"a mass", {0, 0, 1}}};

static const struct symbol *find_symbol(const char *name, size_t length) {
    for (size_t k = 0; k < sizeof symbols / sizeof *symbols; k++)
        if (strlen(symbols[k].name) == length && strncmp(symbols[k].name, name, length) == 0)
            return &symbols[k];
    return NULL;
}

/// One factor of the product, "ps-1": a symbol and its power. @return where it ends; NULL if the
/// symbol is not known.
static const char *read_factor(const char *at, double *factor, int power[POWERS]) {
    const size_t length = strcspn(at, " +-0123456789");
    const struct symbol *const symbol = find_symbol(at, length);
    const char *end = at + length;
    long times = 1;
    if (*end != '\0' && *end != ' ')
        times = strtol(end, (char **)&end, 10);
    if (symbol == NULL || (*end != '\0' && *end != ' ') || labs(times) > 9)
        return NULL;
    *factor *= pow(symbol->factor, (double)times);
    for (int k = 0; k < POWERS; k++)
        power[k] += (int)times * symbol->power[k];
    return end;
}

enum status mf_h5md_unit_find(const char *unit, enum h5md_kind kind, double *factor) {
    int power[POWERS] = {0};
    *factor = 1;
    for (const char *at = unit + strspn(unit, " "); *at; at += strspn(at, " ")) {
        at = read_factor(at, factor, power);
        if (at == NULL)
            return mf_status_fail(STATUS_BAD_INPUT, "the unit \"%.60s\" is not known", unit);
    }
    for (int k = 0; k < POWERS; k++)
        if (power[k] != kinds[kind].power[k])
            return mf_status_fail(STATUS_BAD_INPUT, "the unit \"%.60s\" is not that of %s", unit,
                                  kinds[kind].name);
    return STATUS_OK;
}
