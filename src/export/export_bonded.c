// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_bonded.h"

#include "base/memory.h"
#include "curves/bonded_table.h"
#include "export/export_grid.h"

#include <math.h>

static double length_of(const struct export_model *model, uint32_t i, uint32_t j) {
    double square = 0;
    for (int d = 0; d < model->setup.box.dimensions; d++) {
        const double apart =
            box_nearest(model->position[d][i] - model->position[d][j], model->setup.box.length[d]);
        square += apart * apart;
    }
    return sqrt(square);
}

double mf_export_bonded_longest(const struct export_model *model) {
    const struct topology *topology = &model->molecules->topology;
    double longest = 0;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int n = 0; n < kind->terms[BONDED_BOND]; n++) {
                const int *bead = kind->term[BONDED_BOND][n].bead;
                longest = fmax(longest, length_of(model, topology_id(kind, m, bead[0]),
                                                  topology_id(kind, m, bead[1])));
            }
    }
    return longest;
}

// Tables ------------------------------------------------------------------------------------------

/// Where the rows of a table begin and end. A bond's go on after its own table, where the energy
/// is a straight line, by as much as that is wide, and have room for all bonds that there are.
static void find_range(const struct export_model *model, int order,
                       const struct bonded_curve *curve, double *low, double *high) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    *low = kind->scale * kind->low;
    *high = kind->scale * kind->high;
    if (!kind->is_length)
        return;
    *high = 2 * fmax(mf_bonded_rest(curve), mf_export_bonded_longest(model));
    if (bonded_is_table(curve->law)) {
        const struct bonded_table *table = curve->parameters;
        const double wide = table->spacing * table->intervals;
        *high = fmax(*high, table->first + 2 * wide);
    }
}

static enum status fill_table(struct export_bonded_table *table, const struct bonded_curve *curve,
                              double low, double high, size_t intervals) {
    mf_memory_free(table->q);
    mf_memory_free(table->energy);
    mf_memory_free(table->slope);
    *table = (struct export_bonded_table){.number = table->number};
    TRY_ARRAY(table->q, intervals + 1);
    TRY_ARRAY(table->energy, intervals + 1);
    TRY_ARRAY(table->slope, intervals + 1);
    for (size_t k = 0; k <= intervals; k++) {
        table->q[k] = low + (high - low) * (double)k / (double)intervals;
        mf_bonded_value(curve, table->q[k], &table->energy[k], &table->slope[k]);
    }
    return STATUS_OK;
}

/// Compare what is linear between the rows with the law, where terms are.
static void find_errors(struct export_bonded *bonded, const struct export_bonded_table *table,
                        const struct bonded_curve *curve, double temperature) {
    enum { BETWEEN = 4 };
    const size_t intervals = bonded->rows - 1;
    double min = INFINITY, largest = 0, worst = 0;
    for (size_t k = 0; k <= intervals; k++)
        min = fmin(min, table->energy[k]);
    for (size_t n = 0; n < intervals * BETWEEN; n++) {
        const size_t k = n / BETWEEN;
        const double f = ((double)(n % BETWEEN) + 0.5) / BETWEEN;
        const double q = table->q[k] + f * (table->q[k + 1] - table->q[k]);
        double energy, slope;
        mf_bonded_value(curve, q, &energy, &slope);
        if (energy - min > EXPORT_ACCESSIBLE * temperature)
            continue;
        const double read = table->energy[k] + f * (table->energy[k + 1] - table->energy[k]);
        const double rise = table->slope[k] + f * (table->slope[k + 1] - table->slope[k]);
        bonded->energy_error = fmax(bonded->energy_error, fabs(read - energy) / temperature);
        worst = fmax(worst, fabs(rise - slope));
        largest = fmax(largest, fabs(slope));
    }
    if (largest > 0)
        bonded->slope_error = fmax(bonded->slope_error, worst / largest);
}

/// All tables with so many rows, and their worst errors.
static enum status make_all(struct export_bonded *bonded, const struct export_model *model,
                            bool (*has_law)(const struct bonded_curve *curve), size_t rows) {
    const struct molecules *molecules = model->molecules;
    bonded->rows = rows;
    bonded->tables = 0;
    bonded->energy_error = bonded->slope_error = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0, number = 0; g < molecules->groups[order]; g++) {
            const struct bonded_curve *curve = &molecules->group[order][g].curve;
            struct export_bonded_table *table = &bonded->table[order][g];
            double low, high;
            if (!mf_bonded_kinds[order]->common)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: cannot be exported: other engines have no \"%s\"",
                                      model->folder, mf_bonded_kinds[order]->plural);
            if (has_law(curve))
                continue;
            find_range(model, order, curve, &low, &high);
            TRY(fill_table(table, curve, low, high, rows - 1));
            find_errors(bonded, table, curve, model->setup.temperature);
            table->number = number++;
            bonded->tables++;
        }
    return STATUS_OK;
}

enum status mf_export_bonded_make(struct export_bonded *bonded, const struct export_model *model,
                                  bool (*has_law)(const struct bonded_curve *curve)) {
    static const size_t rows[] = {1001, 2001, 5001, 10001, 20001, 50001, 100001};
    enum status status = STATUS_OK;
    *bonded = (struct export_bonded){0};
    if (model->molecules == NULL)
        return STATUS_OK;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        CHECK(make_all(bonded, model, has_law, rows[k]));
        if (bonded->energy_error < EXPORT_PHI_BOUND && bonded->slope_error < EXPORT_FORCE_BOUND)
            return STATUS_OK;
    }
    status = mf_status_fail(STATUS_BAD_INPUT,
                            "%s: tables of bonds, angles or dihedrals of %zu rows are still wrong "
                            "by %.2g k_B T and %.2g of the largest slope",
                            model->folder, bonded->rows, bonded->energy_error, bonded->slope_error);
done:
    mf_export_bonded_clear(bonded);
    return status;
}

void mf_export_bonded_clear(struct export_bonded *bonded) {
    for (int n = 0; n < BONDED_KINDS * MOLECULES_MAX_GROUPS; n++) {
        struct export_bonded_table *table =
            &bonded->table[n / MOLECULES_MAX_GROUPS][n % MOLECULES_MAX_GROUPS];
        mf_memory_free(table->q);
        mf_memory_free(table->energy);
        mf_memory_free(table->slope);
    }
    *bonded = (struct export_bonded){0};
}
