// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesofit/optimiser.h"

#include "base/memory.h"
#include "io/json.h"
#include "library/guard.h"
#include "optimise/optimiser.h"

struct mesofit_optimiser {
    const struct optimiser *kind;
    void *state, *parameters;
    double *exact; ///< variances of errors that have none, shape [count of the round]
    size_t exact_count;
    size_t count; ///< of the round that was asked for
};

static enum status read_settings(const struct optimiser *kind, const char *text, void *parameters) {
    struct json_document *document;
    TRY(mf_json_open_text(&document, "settings", text ? text : "{}"));
    struct json_object root = mf_json_root(document);
    for (size_t k = 0; kind->tables[k]; k++)
        mf_json_fields(&root, kind->tables[k], parameters);
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

static enum status create(struct mesofit_optimiser *optimiser, const char *name,
                          const char *settings, const struct optimiser_space *space) {
    enum status status = STATUS_OK;
    optimiser->kind = mf_optimiser_find(name);
    if (optimiser->kind == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "there is no optimiser \"%s\"", name);
    CHECK((optimiser->parameters = mf_memory_zeroed(1, optimiser->kind->parameters_size))
              ? STATUS_OK
              : STATUS_NO_MEMORY);
    CHECK(read_settings(optimiser->kind, settings, optimiser->parameters));
    CHECK((optimiser->state = mf_memory_zeroed(1, optimiser->kind->state_size)) ? STATUS_OK
                                                                                : STATUS_NO_MEMORY);
    status = optimiser->kind->create(optimiser->state, space, optimiser->parameters);
done:
    return status;
}

struct mesofit_optimiser *mesofit_optimiser_create(const char *name, const char *settings,
                                                   size_t dimensions, double minimum,
                                                   double maximum, const double *start,
                                                   uint64_t seed) {
    const struct optimiser_space space = {.variables = dimensions,
                                          .minimum = minimum,
                                          .maximum = maximum,
                                          .start = start,
                                          .seed = seed};
    mf_guard_enter();
    struct mesofit_optimiser *optimiser = mf_memory_zeroed(1, sizeof *optimiser);
    if (optimiser && create(optimiser, name, settings, &space) != STATUS_OK) {
        mesofit_optimiser_free(optimiser);
        optimiser = NULL;
    }
    mf_guard_leave();
    return optimiser;
}

void mesofit_optimiser_free(struct mesofit_optimiser *optimiser) {
    if (optimiser == NULL)
        return;
    if (optimiser->state)
        optimiser->kind->destroy(optimiser->state);
    mf_memory_free(optimiser->state);
    mf_memory_free(optimiser->parameters);
    mf_memory_free(optimiser->exact);
    mf_memory_free(optimiser);
}

enum mesofit_status mesofit_optimiser_ask(struct mesofit_optimiser *optimiser,
                                          const double **population, size_t *count) {
    struct optimiser_round round = {0};
    mf_guard_enter();
    const enum status status = optimiser->kind->ask(optimiser->state, &round);
    *population = round.variables;
    *count = optimiser->count = round.count;
    return mf_guard_return(status);
}

static enum status tell(struct mesofit_optimiser *optimiser, const double *errors,
                        const double *variances) {
    enum status status = STATUS_OK;
    if (variances == NULL && optimiser->count > optimiser->exact_count) {
        mf_memory_free(optimiser->exact);
        optimiser->exact_count = 0;
        NEW_ARRAY(optimiser->exact, optimiser->count);
        optimiser->exact_count = optimiser->count;
    }
    status =
        optimiser->kind->tell(optimiser->state, errors, variances ? variances : optimiser->exact);
done:
    return status;
}

enum mesofit_status mesofit_optimiser_tell(struct mesofit_optimiser *optimiser,
                                           const double *errors, const double *variances) {
    mf_guard_enter();
    return mf_guard_return(tell(optimiser, errors, variances));
}

int mesofit_optimiser_best(const struct mesofit_optimiser *optimiser, double *best) {
    mf_guard_enter();
    const bool known = optimiser->kind->best_candidate(optimiser->state, best);
    mf_guard_leave();
    return known;
}
