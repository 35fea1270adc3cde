// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/force_equations.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static bool is_circle(const struct force_curve *curve) {
    return curve->order != FORCES_OF_PAIRS && mf_bonded_kinds[curve->order]->periodic;
}

enum status mf_force_equations_init(struct force_equations *equations,
                                    const struct force_curve *curve, size_t curves) {
    enum status status = STATUS_OK;
    *equations = (struct force_equations){.curves = curves, .each = 1};
    NEW_ARRAY(equations->curve, curves);
    for (size_t n = 0; n < curves; n++) {
        equations->curve[n] = curve[n];
        equations->curve[n].first = equations->size;
        equations->size += curve[n].nodes;
    }
    NEW_ARRAY(equations->gram, FORCES_BLOCKS * force_equations_entries(equations));
    NEW_ARRAY(equations->product, FORCES_BLOCKS * equations->size);
    NEW_ARRAY(equations->virial, FORCES_BLOCKS * equations->size);
done:
    if (status != STATUS_OK)
        mf_force_equations_clear(equations);
    return status;
}

void mf_force_equations_clear(struct force_equations *equations) {
    mf_memory_free(equations->curve);
    mf_memory_free(equations->gram);
    mf_memory_free(equations->product);
    mf_memory_free(equations->virial);
    *equations = (struct force_equations){0};
}

bool mf_force_equations_find(const struct force_curve *curve, double q, size_t *node, size_t *next,
                             double *share) {
    double at = (q - curve->low) / curve->width;
    const double last = (double)(curve->nodes - 1);
    const bool circle = is_circle(curve);
    if (curve->order == FORCES_OF_PAIRS && at > last)
        return false;
    if (circle)
        at -= (double)curve->nodes * floor(at / (double)curve->nodes);
    const size_t below = (size_t)fmin(fmax(floor(at), 0), circle ? last : last - 1);
    *node = curve->first + below;
    *next = curve->first + (below + 1) % curve->nodes;
    *share = at - (double)below;
    return true;
}

/// Join blocks of so many numbers two by two.
static void join(double *block, size_t numbers) {
    enum { HALF = FORCES_BLOCKS / 2 };
    for (size_t b = 0; b < HALF; b++)
        for (size_t k = 0; k < numbers; k++)
            block[b * numbers + k] = block[2 * b * numbers + k] + block[(2 * b + 1) * numbers + k];
    memset(block + HALF * numbers, 0, HALF * numbers * sizeof *block);
}

void mf_force_equations_add(struct force_equations *equations, const double *gram,
                            const double *product, const double *virial, double square) {
    const size_t entries = force_equations_entries(equations), size = equations->size;
    if (equations->frames == FORCES_BLOCKS * equations->each) {
        join(equations->gram, entries);
        join(equations->product, size);
        join(equations->virial, size);
        equations->each *= 2;
    }
    const size_t block = equations->frames / equations->each;
    for (size_t k = 0; k < entries; k++)
        equations->gram[block * entries + k] += gram[k];
    for (size_t k = 0; k < size; k++) {
        equations->product[block * size + k] += product[k];
        equations->virial[block * size + k] += virial[k];
    }
    equations->square += square;
    equations->frames++;
}

void mf_force_equations_scale(struct force_equations *equations, double length, double energy) {
    double factor[FORCES_MAX_NODES] = {0};
    for (size_t n = 0; n < equations->curves; n++) {
        struct force_curve *const curve = &equations->curve[n];
        const bool is_length =
            curve->order == FORCES_OF_PAIRS || mf_bonded_kinds[curve->order]->is_length;
        const double unit = is_length ? length : 1;
        curve->low /= unit;
        curve->width /= unit;
        for (size_t k = 0; k < curve->nodes; k++)
            factor[curve->first + k] = energy / unit;
    }
    for (size_t b = 0; b < force_equations_blocks(equations); b++) {
        double *entry = equations->gram + b * force_equations_entries(equations);
        for (size_t k = 0; k < equations->size; k++) {
            equations->product[b * equations->size + k] *= factor[k];
            equations->virial[b * equations->size + k] *= factor[k] * pow(length, 3) / energy;
            for (size_t l = 0; l <= k; l++)
                *entry++ *= factor[k] * factor[l];
        }
    }
}
