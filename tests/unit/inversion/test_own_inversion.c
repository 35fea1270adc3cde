// SPDX-License-Identifier: GPL-3.0-or-later
//
// The recipe of ARCHITECTURE.md for an inversion with memory of its own: iterative Boltzmann
// inversion, each step the mean of its own and the one before. It compiles without warnings, and
// goes on with the same bits.
#include "base/memory.h"
#include "curves/table.h"
#include "inversion/inversion.h"
#include "inversion/method_steps.h"
#include "observe/rdf.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 50 };

struct mean_inversion {
    struct inversion shared;
    double *before; ///< shape [points]: the step before
};

static enum status update(struct inversion *inversion, double *extra) {
    struct mean_inversion *const own = (struct mean_inversion *)inversion;
    double *const step = inversion->course.step;
    (void)extra;
    mf_ibi_step(inversion->state, step);
    for (size_t k = 0; k <= BINS; k++) {
        step[k] = 0.5 * (step[k] + own->before[k]);
        own->before[k] = step[k];
    }
    return STATUS_OK;
}

static enum status create(void *inversion, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct mean_inversion *const own = inversion;
    TRY_ARRAY(own->before, BINS + 1);
    return mf_inversion_create(inversion, method, problem, parameters);
}

static void destroy(void *inversion) {
    mf_memory_free(((struct mean_inversion *)inversion)->before);
    mf_inversion_destroy(inversion);
}

static size_t spans(void *inversion, struct memory_span *span) {
    span[0] = (struct memory_span){((struct mean_inversion *)inversion)->before,
                                   (BINS + 1) * sizeof(double)};
    return 1 + mf_inversion_spans(inversion, span + 1);
}

static const char *const columns[] = {INVERSION_COLUMNS, NULL};

static const struct inverse_method method = {
    .name = "mean-ibi",
    .summary = "IBI by the mean of two steps",
    .own = &(const struct inversion_rule){.update = update},
    .columns = columns,
    .create = create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD_OF(struct mean_inversion, destroy, spans),
};

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

static struct mean_inversion *make(const struct inverse_problem *problem) {
    static const struct inversion_parameters parameters = {.replicas = 2,
                                                           .equilibration = 10,
                                                           .samples = 8,
                                                           .every = 1,
                                                           .iterations = 5,
                                                           .damping = 1,
                                                           .precision = 0.1};
    struct mean_inversion *own = calloc(1, method.state_size);
    assert_non_null(own);
    assert_ok(method.create(own, &method, problem, &parameters));
    return own;
}

static void iterate(struct mean_inversion *own) {
    struct inverse_step step;
    assert_ok(method.iterate(own, &step, &(const struct inverse_listener){ignore, NULL}));
}

static void copy_state(struct mean_inversion *from, struct mean_inversion *to) {
    static struct memory_span source[INVERSE_MAX_SPANS], target[INVERSE_MAX_SPANS];
    const size_t count = method.spans(from, source);
    assert_int_equal(method.spans(to, target), count);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(target[k].bytes, source[k].bytes);
        memcpy(target[k].memory, source[k].memory, source[k].bytes);
    }
}

static void test_own_inversion_goes_on_by_its_memory(void **state) {
    (void)state;
    struct fluid fluid;
    double g[BINS], error[BINS], kept = 0;
    fluid_lennard_jones(&fluid, 200, 0.004);
    const struct rdf_bins bins = {0, 2.5 / BINS, BINS};
    for (size_t k = 0; k < BINS; k++) {
        double phi;
        mf_table_evaluate(&fluid.potential, mf_rdf_bins_centre(&bins, k), &phi, NULL, NULL);
        g[k] = exp(-phi / fluid.setup.temperature);
        error[k] = 0.01 * g[k];
    }
    const struct inverse_problem problem = {
        .targets = {.bins = bins,
                    .target[TARGET_RDF] = {.count = BINS, .value = g, .error = error}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .scene = fluid.setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 1};
    struct mean_inversion *through = make(&problem), *resumed = make(&problem);
    iterate(through);
    copy_state(through, resumed);
    iterate(through);
    iterate(resumed);
    for (size_t k = 0; k <= BINS; k++) {
        assert_close(resumed->before[k], through->before[k], 0);
        assert_close(resumed->shared.course.phi[k], through->shared.course.phi[k], 0);
        kept += fabs(through->before[k]);
    }
    assert_true(kept > 0);
    method.destroy(through);
    method.destroy(resumed);
    free(through);
    free(resumed);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_own_inversion_goes_on_by_its_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
