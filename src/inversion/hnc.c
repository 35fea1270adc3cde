// SPDX-License-Identifier: GPL-3.0-or-later
//
// Newton steps with the slope of the hypernetted-chain potential: F. Delbary, M. Hanke and D.
// Ivanizki, J. Inverse Ill-Posed Probl. 28 (2020). With K the slope of h − c
// (mf_hnc_closure_slope),
//   Φ ← Φ + k_B T [ln(g/g*) − K (g − g*)],
// where ibi takes the first term alone. Differs from it: K is that of the target, at all steps. The
// whole of h − c instead of its slope (D. Levesque, J. J. Weis and L. Reatto, Phys. Rev. Lett. 54,
// 451 (1985)) was tried: for water the noise of S at small q made every step but the first useless.
#include "inversion/hnc_closure.h"
#include "inversion/inversion.h"

/// Structure factors below this are not trusted.
static const double ridge = 0.35;

static const char *const columns[] = {INVERSION_COLUMNS, NULL};

enum status mf_hnc_step(const struct inversion *inversion, double *step) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &inversion->grid;
    double *target = NULL, *difference = NULL, *indirect = NULL;
    NEW_ARRAY(target, inversion->bins);
    NEW_ARRAY(difference, inversion->bins);
    NEW_ARRAY(indirect, inversion->bins);
    for (size_t k = 0; k < inversion->bins; k++) {
        target[k] = mf_inversion_target_g(inversion, k);
        difference[k] = mf_inversion_g(inversion, k) - target[k];
    }
    CHECK(mf_hnc_closure_slope(&inversion->problem->targets.bins, &inversion->box,
                               &inversion->composition, target, difference, ridge, indirect));
    mf_ibi_logarithms(inversion, step);
    for (size_t n = 0; n < grid->known; n++)
        step[grid->known_point[n]] -=
            inversion->problem->scene.temperature * indirect[grid->known_bin[n]];
    mf_inversion_pressure_add_ramp(inversion, step);
done:
    mf_memory_free(target);
    mf_memory_free(difference);
    mf_memory_free(indirect);
    return status;
}

static enum status update(struct inversion *inversion, double *extra) {
    (void)extra;
    return mf_hnc_step(inversion, inversion->step);
}

static enum status create(void *inversion, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    if (problem->scene.box.dimensions != 3)
        return mf_status_fail(STATUS_BAD_INPUT, "method.name: \"hnc\" is for three dimensions");
    return mf_inversion_create(inversion, method, problem, parameters);
}

const struct inverse_method mf_hnc = {
    .name = "hnc",
    .summary = "Newton steps by the hypernetted chain; F. Delbary, M. Hanke and D. Ivanizki, J. "
               "Inverse Ill-Posed Probl. 28 (2020)",
    .own = &(const struct inversion_rule){.update = update, .forgets = true},
    .tables = (const struct inverse_table[]){INVERSION_TABLE, {NULL, 0}},
    .columns = columns,
    .create = create,
    INVERSION_RECORD,
};
