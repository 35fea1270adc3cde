// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units_text.h"

#include "io/units_scale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Pure numbers whose names are no products of units.
static const char *const pure[] = {"",
                                   "steps",
                                   "sweeps",
                                   "samples",
                                   "times",
                                   "genes",
                                   "rad",
                                   "error",
                                   "standard errors",
                                   "lattice spacings",
                                   "particles_per_cell",
                                   "thermal speeds",
                                   "its own",
                                   "nm or angstrom"};

#define ENERGY                                                                                     \
    { [UNITS_METRE] = 2, [UNITS_SECOND] = -2, [UNITS_KILOGRAM] = 1 }
#define PRESSURE                                                                                   \
    { [UNITS_METRE] = -1, [UNITS_SECOND] = -2, [UNITS_KILOGRAM] = 1 }
static const struct {
    const char *name;
    struct units_text unit;
} symbols[] = {
    {"lambda", {1, {[UNITS_LAMBDA] = 1}}},
    {"tau", {1, {[UNITS_TAU] = 1}}},
    {"mu", {1, {[UNITS_MU] = 1}}},
    {"k_B", {1, {[UNITS_K_B] = 1}}},
    {"T_0", {1, {[UNITS_T_0] = 1}}},
    {"k_BT_0", {1, {[UNITS_K_B] = 1, [UNITS_T_0] = 1}}},
    {"m", {1, {[UNITS_METRE] = 1}}},
    {"cm", {1e-2, {[UNITS_METRE] = 1}}},
    {"pm", {1e-12, {[UNITS_METRE] = 1}}},
    {"nm", {1e-9, {[UNITS_METRE] = 1}}},
    {"angstrom", {1e-10, {[UNITS_METRE] = 1}}},
    {"A", {1e-10, {[UNITS_METRE] = 1}}},
    {"Angstrom", {1e-10, {[UNITS_METRE] = 1}}},
    {"\xc3\x85", {1e-10, {[UNITS_METRE] = 1}}},     // the letter with the ring
    {"\xe2\x84\xab", {1e-10, {[UNITS_METRE] = 1}}}, // the sign
    {"s", {1, {[UNITS_SECOND] = 1}}},
    {"ns", {1e-9, {[UNITS_SECOND] = 1}}},
    {"ps", {1e-12, {[UNITS_SECOND] = 1}}},
    {"fs", {1e-15, {[UNITS_SECOND] = 1}}},
    {"kg", {1, {[UNITS_KILOGRAM] = 1}}},
    {"g", {1e-3, {[UNITS_KILOGRAM] = 1}}},
    {"u", {UNITS_ATOMIC_MASS, {[UNITS_KILOGRAM] = 1}}},
    {"K", {1, {[UNITS_KELVIN] = 1}}},
    {"mol", {UNITS_AVOGADRO, {0}}},
    {"J", {1, ENERGY}},
    {"kJ", {1e3, ENERGY}},
    {"kcal", {4184, ENERGY}},
    {"eV", {1.602176634e-19, ENERGY}},
    {"Pa", {1, PRESSURE}},
    {"bar", {1e5, PRESSURE}},
    {"atm", {101325, PRESSURE}},
    {"degrees", {1, {0}}},
};

struct reader {
    const char *at;
    int dimensions;
};

static void raise_to(struct units_text *unit, double power) {
    unit->factor = pow(unit->factor, power);
    for (int base = 0; base < UNITS_BASES; base++)
        unit->exponent[base] *= power;
}

static void multiply(struct units_text *unit, const struct units_text *by) {
    unit->factor *= by->factor;
    for (int base = 0; base < UNITS_BASES; base++)
        unit->exponent[base] += by->exponent[base];
}

static void skip_blanks(struct reader *reader) {
    reader->at += strspn(reader->at, " ");
}

/// The longest stretch of what names are made of: letters, and "_0" after one.
static size_t name_length(const char *text) {
    size_t length = 0;
    while ((text[length] >= 'a' && text[length] <= 'z') ||
           (text[length] >= 'A' && text[length] <= 'Z') || text[length] == '_' ||
           (unsigned char)text[length] >= 0x80 ||
           (text[length] == '0' && length > 0 && text[length - 1] == '_'))
        length++;
    return length;
}

static bool read_name(struct reader *reader, struct units_text *unit) {
    const size_t length = name_length(reader->at);
    for (size_t k = 0; k < sizeof symbols / sizeof *symbols; k++)
        if (strlen(symbols[k].name) == length &&
            strncmp(symbols[k].name, reader->at, length) == 0) {
            *unit = symbols[k].unit;
            reader->at += length;
            return true;
        }
    return false;
}

static bool read_product(struct reader *reader, struct units_text *unit);

/// "(…)" or "sqrt(…)", of which the name was read.
static bool read_inner(struct reader *reader, struct units_text *unit) {
    if (*reader->at != '(')
        return false;
    reader->at++;
    if (!read_product(reader, unit) || *reader->at != ')')
        return false;
    reader->at++;
    return true;
}

static bool read_exponent(struct reader *reader, double *exponent) {
    *exponent = 1;
    if (*reader->at != '^')
        return true;
    reader->at++;
    if (*reader->at == 'd') {
        *exponent = reader->dimensions;
        reader->at++;
        return true;
    }
    char *end;
    *exponent = (double)strtol(reader->at, &end, 10);
    const bool is_number = end > reader->at;
    reader->at = end;
    return is_number && fabs(*exponent) <= 12;
}

static bool read_factor(struct reader *reader, struct units_text *unit) {
    double exponent;
    bool is_unit;
    skip_blanks(reader);
    if (*reader->at == '1') {
        *unit = (struct units_text){.factor = 1};
        reader->at++;
        is_unit = true;
    } else if (strncmp(reader->at, "sqrt(", 5) == 0) {
        reader->at += 4;
        is_unit = read_inner(reader, unit);
        raise_to(unit, 0.5);
    } else {
        is_unit = *reader->at == '(' ? read_inner(reader, unit) : read_name(reader, unit);
    }
    if (!is_unit || !read_exponent(reader, &exponent))
        return false;
    if (exponent != 1)
        raise_to(unit, exponent);
    skip_blanks(reader);
    return true;
}

/// Parentheses cannot nest deeper than the text is long, which no heading is by much.
static bool read_product(struct reader *reader, struct units_text *unit) {
    *unit = (struct units_text){.factor = 1};
    double sign = 1;
    bool more = true;
    while (more) {
        struct units_text factor = {0};
        if (!read_factor(reader, &factor))
            return false;
        raise_to(&factor, sign);
        multiply(unit, &factor);
        const char mark = *reader->at;
        const bool marked = mark == '/' || mark == '.' || mark == '*';
        sign = mark == '/' ? -1 : 1;
        reader->at += marked;
        more = marked || (mark && mark != ')');
    }
    return true;
}

bool mf_units_text_parse(struct units_text *unit, const char *text, int dimensions) {
    enum { LONGEST = 64 };
    struct reader reader = {text, dimensions > 0 ? dimensions : 3};
    *unit = (struct units_text){.factor = 1};
    for (size_t k = 0; k < sizeof pure / sizeof *pure; k++)
        if (strcmp(pure[k], text) == 0)
            return true;
    return strlen(text) <= LONGEST && read_product(&reader, unit) && *reader.at == '\0';
}

const char *mf_units_text_in_brackets(const char *heading, size_t *length) {
    const char *open = strrchr(heading, '[');
    if (open == NULL)
        return NULL;
    *length = strcspn(open + 1, "]");
    return open[1 + *length] == ']' && open[2 + *length] == '\0' ? open + 1 : NULL;
}
