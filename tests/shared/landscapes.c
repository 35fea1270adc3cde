// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/landscapes.h"

#include "base/rng.h"
#include "shared/testing.h"

#include <math.h>

static double square(double x) {
    return x * x;
}

static double sphere(const double *variables, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += square(variables[k] - 0.3);
    return sum;
}

static double rosenbrock(const double *variables, size_t count) {
    double sum = 0;
    for (size_t k = 0; k + 1 < count; k++)
        sum += 100 * square(variables[k + 1] - square(variables[k])) + square(1 - variables[k]);
    return sum;
}

static double rastrigin(const double *variables, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += 10 + square(variables[k] - 1) - 10 * cos(2 * M_PI * (variables[k] - 1));
    return sum;
}

static double edge(const double *variables, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += variables[k];
    return sum;
}

const struct landscape landscape_sphere = {"sphere", sphere, 0, 1, 0.3};
const struct landscape landscape_rosenbrock = {"rosenbrock", rosenbrock, -2, 2, 1};
const struct landscape landscape_rastrigin = {"rastrigin", rastrigin, -5, 5, 1};
const struct landscape landscape_edge = {"edge", edge, 0, 1, 0};

void *landscape_parameters(const struct optimiser *optimiser) {
    void *parameters = mf_memory_zeroed(1, optimiser->parameters_size);
    assert_non_null(parameters);
    for (size_t k = 0; optimiser->tables[k]; k++)
        mf_fields_set_defaults(optimiser->tables[k], parameters);
    return parameters;
}

void landscape_set(const struct optimiser *optimiser, void *parameters, const char *name,
                   double value) {
    for (size_t k = 0; optimiser->tables[k]; k++)
        for (const struct field *field = optimiser->tables[k]; field->name; field++) {
            if (strcmp(field->name, name) != 0)
                continue;
            struct field alone[2] = {*field, FIELD_END};
            alone[0].initial = value;
            mf_fields_set_defaults(alone, parameters);
            return;
        }
    fail_msg("%s has no field %s", optimiser->name, name);
}

void *landscape_parameters_with(const struct optimiser *optimiser,
                                const struct landscape_setting *settings, int max) {
    void *parameters = landscape_parameters(optimiser);
    for (int k = 0; k < max && settings[k].name; k++)
        landscape_set(optimiser, parameters, settings[k].name, settings[k].value);
    return parameters;
}

struct landscape_run landscape_begin(const struct optimiser *optimiser, void *parameters,
                                     const struct landscape_drive *drive) {
    const struct optimiser_space space = {.variables = drive->variables,
                                          .minimum = drive->landscape->minimum,
                                          .maximum = drive->landscape->maximum,
                                          .start = drive->start,
                                          .seed = drive->seed,
                                          .max = drive->max};
    struct landscape_run run = {optimiser, parameters, mf_memory_zeroed(1, optimiser->state_size)};
    assert_non_null(run.state);
    assert_ok(optimiser->create(run.state, &space, parameters));
    return run;
}

void landscape_end(struct landscape_run *run) {
    run->optimiser->destroy(run->state);
    mf_memory_free(run->state);
    run->state = NULL;
}

/// An error as it is measured, measurement number `number`.
static double measure(const struct landscape_drive *drive, double exact, uint64_t number) {
    static const double failures[] = {OPTIMISER_FAILED, NAN, HUGE_VAL, -HUGE_VAL, 1e300};
    const struct rng_block block =
        mf_rng_philox(drive->seed, RNG_EVALUATION, (uint32_t)number, 0, 0);
    double normal[4];
    mf_rng_normal4(mf_rng_philox(drive->seed, RNG_EVALUATION, (uint32_t)number, 1, 0), normal);
    if (mf_rng_uniform(block.word[0], block.word[1]) < drive->failing)
        return failures[number % 5];
    return exact + drive->noise * normal[0];
}

static void check_round(const struct landscape_drive *drive, const struct optimiser_round *round) {
    for (size_t k = 0; k < round->count * drive->variables; k++)
        assert_true(round->variables[k] >= drive->landscape->minimum &&
                    round->variables[k] <= drive->landscape->maximum);
}

/// Ask twice: the same candidates. Frees nothing; the copy is compared here.
static struct optimiser_round ask_twice(struct landscape_run *run, size_t variables) {
    struct optimiser_round first, second;
    assert_ok(run->optimiser->ask(run->state, &first));
    const size_t bytes = first.count * variables * sizeof(double);
    double *copy = mf_memory_zeroed(bytes + 1, 1);
    assert_non_null(copy);
    memcpy(copy, first.variables, bytes);
    assert_ok(run->optimiser->ask(run->state, &second));
    assert_int_equal(first.count, second.count);
    assert_memory_equal(copy, second.variables, bytes);
    mf_memory_free(copy);
    return second;
}

static void look_at_best_candidate(const struct landscape_run *run,
                                   const struct landscape_drive *drive,
                                   struct landscape_result *result) {
    double *variables = mf_memory_zeroed(drive->variables, sizeof *variables);
    assert_non_null(variables);
    if (run->optimiser->best_candidate(run->state, variables)) {
        check_round(drive, &(struct optimiser_round){variables, 1});
        result->best_candidate = drive->landscape->error(variables, drive->variables);
    }
    mf_memory_free(variables);
}

bool landscape_step(struct landscape_run *run, const struct landscape_drive *drive,
                    struct landscape_result *result) {
    const struct optimiser_round round = ask_twice(run, drive->variables);
    result->finished = round.count == 0;
    if (result->finished)
        return false;
    check_round(drive, &round);
    double *errors = mf_memory_zeroed(2 * round.count, sizeof *errors);
    assert_non_null(errors);
    for (size_t k = 0; k < round.count; k++) {
        const double exact =
            drive->landscape->error(round.variables + k * drive->variables, drive->variables);
        result->min = fmin(result->min, exact); // fmin leaves NaN out
        errors[k] = measure(drive, exact, result->evaluations++);
        errors[round.count + k] = drive->noise * drive->noise;
    }
    assert_ok(run->optimiser->tell(run->state, errors, errors + round.count));
    mf_memory_free(errors);
    result->rounds++;
    look_at_best_candidate(run, drive, result);
    return true;
}

struct landscape_result landscape_minimise(const struct optimiser *optimiser, void *parameters,
                                           const struct landscape_drive *drive) {
    struct landscape_result result = {.min = HUGE_VAL, .best_candidate = HUGE_VAL};
    struct landscape_run run = landscape_begin(optimiser, parameters, drive);
    while ((drive->evaluations == 0 || result.evaluations < drive->evaluations) &&
           result.min > drive->target && landscape_step(&run, drive, &result))
        continue;
    assert_true(result.rounds <= optimiser->max_rounds(parameters, drive->variables));
    landscape_end(&run);
    return result;
}
