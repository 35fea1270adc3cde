// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo. A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995).
#include "inverse/imc_solve.h"
#include "inverse/inversion.h"

#include <assert.h>

struct own {
    double strength;
    int regularisation;
};

static_assert(sizeof(struct own) <= sizeof((struct inversion_settings){0}.own), "no room");

/// How the linear equations are solved, in the order of `regularisations`.
static enum status (*const solvers[])(const struct imc_system *, double, double *, double *,
                                      struct imc_solution *) = {imc_solve, imc_votca};
static const char *const regularisations[] = {"noise", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct inversion_settings, own) + offsetof(struct own, name)
static const struct field own_fields[] = {
    {"regularisation", FIELD_CHOICE, MEMBER(regularisation), .choices = regularisations,
     .initial = 0, .unit = "",
     .help = "noise: smooth, and as strong as the noise asks; votca: Tikhonov's lambda, as there"},
    {"strength", FIELD_NUMBER, MEMBER(strength), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "", .help = "of the regularisation; 0: chosen from the noise, or none with \"votca\""},
    FIELD_END,
};

static const char *const columns[] = {INVERSION_COLUMNS, "regularisation[1]", "misfit[1]", NULL};

/// The regularised linear step for the known bins.
static enum status update(struct inversion *inversion, double extra[2]) {
    enum status status = STATUS_OK;
    const struct own *own = (const void *)inversion->settings.own;
    const size_t core = inversion->grid.core, known = inversion->grid.known;
    double *covariance = NULL;
    struct imc_solution solution;
    NEW_ARRAY(covariance, known * known);
    for (size_t a = 0; a < known; a++)
        for (size_t b = 0; b < known; b++)
            covariance[a * known + b] =
                comoments_covariance(&inversion->replicas.counts, core + a, core + b);
    const struct imc_system system = {.size = known,
                                      .covariance = covariance,
                                      .excess = inversion->excess + core,
                                      .variance = inversion->variance + core,
                                      .temperature = inversion->problem->scene.temperature,
                                      .spacing = inversion->problem->goals.bins.width};
    CHECK(solvers[own->regularisation](&system, own->strength, inversion->step + core,
                                       inversion->error + core, &solution));
    extra[0] = solution.strength;
    extra[1] = solution.misfit;
done:
    memory_free(covariance);
    return status;
}

const struct inverse_method imc = {
    .name = "imc",
    .summary = "inverse Monte Carlo; A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 "
               "(1995)",
    .tables = (const struct field *const[]){inversion_fields, own_fields, NULL},
    .parameters_size = sizeof(struct inversion_settings),
    .state_size = sizeof(struct inversion),
    .fits = {[UNKNOWN_POTENTIAL] = true},
    .most_iterations = inversion_most_iterations,
    .sampling = inversion_sampling,
    .columns = columns,
    .update = update,
    .create = inversion_create,
    .destroy = inversion_destroy,
    .iterate = inversion_iterate,
    .spans = inversion_spans,
};
