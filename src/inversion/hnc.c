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
#include "inversion/inversion_intramolecular.h"
#include "inversion/inversions.h"
#include "inversion/method_steps.h"

/// Structure factors below this are not trusted.
static const double ridge = 0.35;

static const char *const columns[] = {INVERSION_COLUMNS, NULL};

enum status mf_hnc_step(const struct inversion_state *state, double *step) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &state->grid;
    double *target = NULL, *difference = NULL, *indirect = NULL;
    NEW_ARRAY(target, state->bins);
    NEW_ARRAY(difference, state->bins);
    NEW_ARRAY(indirect, state->bins);
    for (size_t k = 0; k < state->bins; k++) {
        target[k] = mf_inversion_target_g(state, k);
        difference[k] = mf_inversion_g(state, k) - target[k];
    }
    const struct hnc_liquid liquid = mf_inversion_liquid(state);
    CHECK(mf_hnc_closure_slope(&liquid, target, difference, ridge, indirect));
    mf_ibi_logarithms(state, step);
    for (size_t n = 0; n < grid->known; n++)
        step[grid->known_point[n]] -=
            state->problem->scene.temperature * indirect[grid->known_bin[n]];
    mf_inversion_bulk_add_ramp(state, step); // the last: it is for the pressure of the whole
done:
    mf_memory_free(target);
    mf_memory_free(difference);
    mf_memory_free(indirect);
    return status;
}

static enum status update(struct inversion *inversion, double *extra) {
    (void)extra;
    return mf_hnc_step(inversion->state, inversion->course.step);
}

static enum status create(void *inversion, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    if (problem->scene.box.dimensions != 3)
        return mf_status_fail(STATUS_BAD_INPUT, "method.name: \"%s\" is for three dimensions",
                              method->name);
    return mf_inversion_create(inversion, method, problem, parameters);
}

const struct inverse_method mf_hnc = {
    .name = "hnc",
    .summary = "Newton steps by the hypernetted chain; F. Delbary, M. Hanke and D. Ivanizki, J. "
               "Inverse Ill-Posed Probl. 28 (2020)",
    .own = &(const struct inversion_rule){.update = update, .memoryless = true},
    .columns = columns,
    .create = create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD,
};
