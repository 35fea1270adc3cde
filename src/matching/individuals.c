// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/individuals.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

#include <stdio.h>
#include <string.h>

enum { ITERATION, ERROR, PARENT, OTHER_PARENT };

/// Numbers that are kept: 4 MiB, which are 5000 individuals of a hundred genes.
enum { MAX_NUMBERS = 1 << 19, NAME_SIZE = UNKNOWNS_NAME_SIZE + INVERSE_NUMBER_NAME_SIZE };

static double *row_of(const struct individuals *individuals, uint64_t number) {
    const size_t width = INDIVIDUALS_HEAD + individuals->variables;
    return individuals->row + number % individuals->capacity * width;
}

enum status mf_individuals_init(struct individuals *individuals, size_t variables) {
    const size_t width = INDIVIDUALS_HEAD + variables;
    *individuals =
        (struct individuals){.variables = variables, .capacity = 1 + MAX_NUMBERS / width};
    TRY_ARRAY(individuals->row, individuals->capacity * width);
    return STATUS_OK;
}

void mf_individuals_clear(struct individuals *individuals) {
    mf_memory_free(individuals->row);
    *individuals = (struct individuals){0};
}

void mf_individuals_add(struct individuals *individuals, uint32_t iteration,
                        const double *variables, double error, const uint64_t parent[2]) {
    double *row = row_of(individuals, individuals->count++);
    row[ITERATION] = iteration;
    row[ERROR] = error < OPTIMISER_FAILED ? error : NAN;
    row[PARENT] = (double)parent[0];
    row[OTHER_PARENT] = (double)parent[1];
    memcpy(row + INDIVIDUALS_HEAD, variables, individuals->variables * sizeof *variables);
}

// Tables ------------------------------------------------------------------------------------------

/// What a variable is in the table: its name with unit, and its range.
struct gene {
    char name[NAME_SIZE];
    double minimum, range;
};

static bool is_formula(const struct unknown *unknown) {
    return unknown->parameters.shape == INVERSE_CURVE_POWER;
}

/// The genes of an unknown; those of a formula stay in [0, 1].
static void name_genes(const struct parametrisation *parametrisation, enum unknown_kind kind,
                       const struct units *units, struct gene *gene) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    if (!unknowns->problem->unknown[kind].wanted)
        return;
    for (size_t curve = 0; curve < mf_unknowns_curve_count(unknowns, kind); curve++) {
        char of[UNKNOWNS_NAME_SIZE], name[NAME_SIZE];
        mf_unknowns_curve_name(unknowns, kind, curve, of);
        for (size_t k = 0; k < mf_parametrisation_variables_of(parametrisation, kind, curve); k++) {
            snprintf(name, sizeof name, "%s(%zu)", of, k + 1);
            if (is_formula(&unknowns->problem->unknown[kind]))
                snprintf(gene->name, sizeof gene->name, "%s", name);
            else
                mf_data_table_name(units, name, mf_unknowns_unit(kind), gene->name,
                                   sizeof gene->name);
            gene++;
        }
    }
}

static void name_all(const struct parametrisation *parametrisation, const struct units *units,
                     struct gene *gene) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        name_genes(parametrisation, kind, units, gene + parametrisation->first[kind]);
    for (size_t n = 0; n < problem->numbers; n++) {
        struct gene *number = &gene[parametrisation->first_number + n];
        mf_data_table_name(units, problem->number[n].name, problem->number[n].unit, number->name,
                           sizeof number->name);
    }
    for (size_t n = 0; n < parametrisation->variables; n++) {
        gene[n].minimum = parametrisation->min[n];
        gene[n].range = parametrisation->range[n];
    }
}

/// Columns of all that are kept, one after the other.
static void fill_columns(const struct individuals *individuals, const struct gene *gene,
                         size_t rows, double *values) {
    const uint64_t first = individuals->count - rows;
    for (size_t k = 0; k < rows; k++) {
        const double *row = row_of(individuals, first + k);
        double *to = values + k;
        to[0] = row[ITERATION];
        to[1 * rows] = (double)(first + k + 1);
        for (int n = ERROR; n < INDIVIDUALS_HEAD; n++)
            to[(size_t)(n + 1) * rows] = row[n];
        for (size_t n = 0; n < individuals->variables; n++)
            to[(INDIVIDUALS_HEAD + 1 + n) * rows] =
                gene[n].minimum + gene[n].range * row[INDIVIDUALS_HEAD + n];
    }
}

static enum status write_individuals(const struct individuals *individuals,
                                     const struct parametrisation *parametrisation,
                                     const struct inverse_folder *folder) {
    static const char *const head[INDIVIDUALS_HEAD + 1] = {"iteration", "individual", "error[1]",
                                                           "parent_1", "parent_2"};
    const size_t rows = individuals->count < individuals->capacity ? (size_t)individuals->count
                                                                   : individuals->capacity;
    const size_t columns = INDIVIDUALS_HEAD + 1 + individuals->variables;
    char path[OUTPUT_PATH_SIZE];
    OWNED struct data_column *column = NULL;
    OWNED struct gene *gene = NULL;
    OWNED double *values = NULL;
    TRY_ARRAY(column, columns);
    TRY_ARRAY(gene, individuals->variables);
    TRY_ARRAY(values, columns * rows + 1);
    name_all(parametrisation, folder->units, gene);
    fill_columns(individuals, gene, rows, values);
    for (size_t n = 0; n < columns; n++)
        column[n] = (struct data_column){
            n <= INDIVIDUALS_HEAD ? head[n] : gene[n - INDIVIDUALS_HEAD - 1].name,
            values + n * rows, n == 2 || n > INDIVIDUALS_HEAD ? "%.8g" : NULL};
    folder->file(folder->context, "individuals.tsv", path);
    return mf_data_table_write_in(path, folder->units, "parents are individuals; 0: none", column,
                                  columns, rows);
}

/// Where a curve's points lie among its control points, and what it is added to.
static enum status write_genes(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve,
                               const struct inverse_folder *folder) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    const double *base = unknowns->problem->unknown[kind].base;
    const size_t points = mf_unknowns_part(unknowns, kind, curve).points, begin = curve * points;
    const size_t first = mf_parametrisation_first_point(parametrisation, kind, curve);
    char name[UNKNOWNS_NAME_SIZE], file[UNKNOWNS_NAME_SIZE + 16], heading[64];
    char path[OUTPUT_PATH_SIZE];
    OWNED double *place = NULL, *added = NULL;
    TRY_ARRAY(place, points);
    TRY_ARRAY(added, points);
    mf_parametrisation_places(parametrisation, kind, curve, place);
    for (size_t k = first; base && k < points; k++)
        added[k - first] = base[begin + k];
    mf_data_table_name(folder->units, "base", mf_unknowns_unit(kind), heading, sizeof heading);
    const struct data_column columns[] = {
        {"r[lambda]", mf_unknowns_r(unknowns, kind) + begin + first, NULL},
        {"place[1]", place, "%.8g"},
        {heading, added, "%.8g"}};
    mf_unknowns_curve_name(unknowns, kind, curve, name);
    snprintf(file, sizeof file, "genes_%s.tsv", name);
    folder->file(folder->context, file, path);
    return mf_data_table_write_in(path, folder->units, NULL, columns, 3, points - first);
}

enum status mf_individuals_write(const struct individuals *individuals,
                                 const struct parametrisation *parametrisation,
                                 const struct inverse_folder *folder) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    if (individuals->count == 0)
        return STATUS_OK;
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct unknown *unknown = &unknowns->problem->unknown[kind];
        if (!unknown->wanted || kind == UNKNOWN_BONDED ||
            unknown->parameters.shape != INVERSE_CURVE_BEZIER)
            continue;
        for (size_t n = 0; n < mf_unknowns_curve_count(unknowns, kind); n++)
            TRY(write_genes(parametrisation, kind, n, folder));
    }
    return write_individuals(individuals, parametrisation, folder);
}

size_t mf_individuals_spans(struct individuals *individuals, struct memory_span *spans) {
    const size_t width = INDIVIDUALS_HEAD + individuals->variables;
    spans[0] = (struct memory_span){&individuals->count, sizeof individuals->count};
    spans[1] = (struct memory_span){individuals->row,
                                    individuals->capacity * width * sizeof *individuals->row};
    return INDIVIDUALS_SPANS;
}
