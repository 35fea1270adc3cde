// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/force_solve.h"

#include "base/memory.h"
#include "inversion/force_work.h"

#include <math.h>

double mf_force_equations_share(const struct force_equations *equations, const double *c) {
    double sum = 0;
    for (size_t k = 0; k < equations->size; k++) {
        sum += 2 * c[k] * force_work_total(equations, equations->product, k, equations->size);
        for (size_t l = 0; l < equations->size; l++)
            if (c[k] != 0 && c[l] != 0)
                sum -= c[k] * c[l] * force_work_gram(equations, k, l);
    }
    return sum / equations->square;
}

/// ⟨w⟩·c, and its variance by the scatter of whole blocks.
static double find_virial(const struct force_equations *equations, const double *c,
                          double *variance) {
    const size_t size = equations->size, blocks = equations->frames / equations->each;
    double value = 0, mean = 0, squares = 0;
    for (size_t k = 0; k < size; k++)
        value += c[k] * force_work_total(equations, equations->virial, k, size);
    for (size_t b = 0; b < blocks; b++) {
        double own = 0;
        for (size_t k = 0; k < size; k++)
            own += c[k] * equations->virial[b * size + k] / (double)equations->each;
        mean += own / (double)blocks;
        squares += own * own;
    }
    *variance = fmax(0, squares / (double)blocks - mean * mean) / (double)(blocks - 1);
    return value / (double)equations->frames;
}

/// Whether a curve makes up for the pressure: a bond would change its length, and leave it.
static bool is_free(const struct force_curve *curve) {
    return !curve->held && (curve->order == FORCES_OF_PAIRS || curve->order == FORCES_OF_DENSITY);
}

/// C w, w being that of free curves alone.
static void find_along(const struct force_solution *solution,
                       const struct force_equations *equations, double *along) {
    const size_t size = solution->size;
    for (size_t n = 0; n < equations->curves; n++) {
        const struct force_curve *const curve = &equations->curve[n];
        for (size_t l = curve->first; l < curve->first + curve->nodes; l++) {
            const double w =
                force_work_total(equations, equations->virial, l, size) / (double)equations->frames;
            for (size_t k = 0; k < size && is_free(curve); k++)
                along[k] += solution->covariance[k * size + l] * w;
        }
    }
}

enum status mf_force_solution_meet(struct force_solution *solution,
                                   const struct force_equations *equations, double virial,
                                   double error) {
    const size_t size = solution->size;
    double noise, open = 0;
    OWNED double *along = NULL, *step = NULL;
    TRY_ARRAY(along, size);
    TRY_ARRAY(step, size);
    const double missing = virial - find_virial(equations, solution->value, &noise);
    find_along(solution, equations, along);
    for (size_t n = 0; n < equations->curves; n++)
        for (size_t k = 0; k < equations->curve[n].nodes; k++) {
            const size_t at = equations->curve[n].first + k;
            step[at] = is_free(&equations->curve[n]) ? along[at] : 0;
            open += step[at] * force_work_total(equations, equations->virial, at, size) /
                    (double)equations->frames;
        }
    if (!(open > 0))
        return STATUS_OK;
    for (size_t k = 0; k < size; k++) {
        step[k] /= open;
        solution->value[k] += step[k] * missing;
        solution->coarse[k] += step[k] * missing;
    }
    for (size_t k = 0; k < size; k++)
        for (size_t l = 0; l < size; l++)
            solution->covariance[k * size + l] +=
                step[k] * step[l] * (open + noise + error * error) - step[k] * along[l] -
                along[k] * step[l];
    solution->explained = mf_force_equations_share(equations, solution->value);
    return STATUS_OK;
}
