// SPDX-License-Identifier: GPL-3.0-or-later
//
// One potential for several states: temperatures, densities, compositions. Each state is an
// inversion with samples of its own; the first one takes the step for all of them, by the linear
// equations of all.
//
// The rows B_s x = b_s of the states, each over its errors, stand one below the other. A QR
// decomposition leaves as many rows as unknowns, with the same least squares, so that the strength
// of the regularisation, the band and its ramp are found as of one state.
#include "inversion/imc_solve.h"
#include "inversion/inversion.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

struct joint {
    size_t states;
    struct inversion *state; ///< shape [states]; the first one leads
    struct imc_system system;
    double *covariance, *excess, *variance; ///< of the system
    double least;                           ///< error so far
    uint32_t standstill;                    ///< iterations since it was lower by more than a little
};

static struct inversion *leader_of(const struct joint *joint) {
    return &joint->state[0];
}

// The equations of all states ---------------------------------------------------------------------

/// Rows of the states and, below each state's, one of its pressure if it is asked for.
static size_t count_rows(const struct joint *joint) {
    const struct inversion *leader = leader_of(joint);
    const bool pressure = targets_ask(&leader->problem->targets, TARGET_PRESSURE);
    return joint->states * (leader->grid.known + pressure);
}

/// P + p·x = P* within the errors of both.
static void fill_pressure(const struct inversion *state, gsl_matrix *rows, gsl_vector *rhs,
                          size_t row) {
    const double error = state->distance[TARGET_PRESSURE].noise;
    const double wanted = *state->problem->targets.target[TARGET_PRESSURE].value;
    for (size_t b = 0; b < state->grid.known; b++)
        gsl_matrix_set(rows, row, b, state->pressure.slope[b] / error);
    gsl_vector_set(rhs, row, (wanted - state->pressure.value) / error);
}

static void fill_rows(const struct joint *joint, gsl_matrix *rows, gsl_vector *rhs) {
    const size_t known = leader_of(joint)->grid.known;
    size_t row = 0;
    for (size_t s = 0; s < joint->states; s++) {
        const struct inversion *state = &joint->state[s];
        const struct imc_system own = mf_inversion_system(state);
        gsl_matrix_view response = gsl_matrix_submatrix(rows, row, 0, known, known);
        mf_imc_solve_response(&own, &response.matrix);
        for (size_t a = 0; a < known; a++)
            gsl_vector_set(rhs, row + a, own.excess[a] / sqrt(own.variance[a]));
        row += known;
        if (targets_ask(&state->problem->targets, TARGET_PRESSURE))
            fill_pressure(state, rows, rhs, row++);
    }
}

/// The rows that a QR decomposition leaves, as a system whose variances are 1: R x = (Qᵀ b).
static enum status reduce(struct joint *joint) {
    enum status status = STATUS_OK;
    const struct inversion *leader = leader_of(joint);
    const size_t known = leader->grid.known, count = count_rows(joint);
    gsl_matrix *rows = gsl_matrix_alloc(count, known);
    gsl_vector *rhs = gsl_vector_alloc(count), *reflect = gsl_vector_alloc(known);
    CHECK(rows && rhs && reflect ? STATUS_OK : STATUS_NO_MEMORY);
    fill_rows(joint, rows, rhs);
    gsl_linalg_QR_decomp(rows, reflect);
    gsl_linalg_QR_QTvec(rows, reflect, rhs);
    for (size_t a = 0; a < known; a++) {
        joint->excess[a] = gsl_vector_get(rhs, a);
        joint->variance[a] = 1;
        for (size_t b = 0; b < known; b++)
            joint->covariance[a * known + b] =
                b < a ? 0 : gsl_matrix_get(rows, a, b) * joint->system.temperature;
    }
done:
    gsl_matrix_free(rows);
    gsl_vector_free(rhs);
    gsl_vector_free(reflect);
    return status;
}

// All states in one -------------------------------------------------------------------------------

/// In units of its noise.
static double noises_of(const struct target_distance *distance) {
    return distance->rms > 0 ? distance->rms / distance->noise : 0;
}

/// The target of a state that is farthest off.
struct worst {
    size_t state;
    int kind;
    double noises;
};

/// What is farthest off of all states and targets, or of targets of one kind; `kind` −1: all.
static struct worst find_worst(const struct joint *joint, int kind) {
    struct worst worst = {0, kind < 0 ? TARGET_RDF : kind, 0};
    for (size_t s = 0; s < joint->states; s++)
        for (int k = 0; k < TARGETS; k++) {
            const struct inversion *state = &joint->state[s];
            const double noises = noises_of(&state->distance[k]);
            if ((kind < 0 || k == kind) && targets_ask(&state->problem->targets, k) &&
                noises > worst.noises)
                worst = (struct worst){s, k, noises};
        }
    return worst;
}

/// rms over the states and their targets, each in units of its noise.
static double find_distance(const struct joint *joint) {
    double squares = 0, count = 0;
    for (size_t s = 0; s < joint->states; s++)
        for (int k = 0; k < TARGETS; k++)
            if (targets_ask(&joint->state[s].problem->targets, k)) {
                squares += pow(noises_of(&joint->state[s].distance[k]), 2);
                count++;
            }
    return sqrt(squares / count);
}

/// The section of the first state becomes that of the state that is farthest off by its noise, with
/// the noise of the least exact; its distance of g the rms over the states, and that of the
/// pressure as many times its own noise as that of the worst state.
static void join_distances(struct joint *joint) {
    struct inversion *leader = leader_of(joint);
    struct inversion_section section = leader->section[0];
    struct target_distance rdf = {.count = 0};
    double misfit = 0, disagreement = 0;
    const double states = (double)joint->states;
    const struct worst pressure = find_worst(joint, TARGET_PRESSURE);
    const struct worst worst = find_worst(joint, TARGET_RDF);
    for (size_t s = 0; s < joint->states; s++) {
        const struct inversion *state = &joint->state[s];
        const struct target_distance *own = &state->distance[TARGET_RDF];
        rdf.rms += own->rms * own->rms / states;
        rdf.noise += own->noise * own->noise / states;
        rdf.variance += own->variance / states;
        rdf.count += own->count;
        section.own_noise = fmax(section.own_noise, state->section[0].own_noise);
        disagreement = fmax(disagreement, state->disagreement);
        misfit += state->misfit / states;
    }
    rdf.rms = sqrt(rdf.rms);
    rdf.noise = sqrt(rdf.noise);
    section.rms = joint->state[worst.state].section[0].rms;
    section.noise = joint->state[worst.state].section[0].noise;
    leader->section[0] = section;
    leader->own_noise = section.own_noise;
    leader->disagreement = disagreement;
    leader->misfit = misfit;
    leader->distance[TARGET_RDF] = rdf;
    leader->distance[TARGET_PRESSURE].rms =
        pressure.noises * leader->distance[TARGET_PRESSURE].noise;
}

static void tell_worst(const struct joint *joint, const struct worst *worst, const char *why,
                       char reason[INVERSE_REASON_SIZE]) {
    const struct inversion *state = &joint->state[worst->state];
    snprintf(reason, INVERSE_REASON_SIZE, "%s%s of \"%s\" is off by %.1f times its noise", why,
             mf_targets_name(worst->kind), state->problem->name, worst->noises);
}

/// Where the states want different potentials the steps end in a compromise, about which they go
/// on: the equations of a state that is far off carry the noise of C into the step.
static void end_at_standstill(struct joint *joint, double distance, const struct worst *worst,
                              struct inverse_step *step) {
    static const double progress = 0.95;
    static const uint32_t patience = 5;
    const bool better = step->iteration == 0 || distance < progress * joint->least;
    const bool met = worst->noises <= mf_inverse_noise_margin;
    joint->least = better ? distance : joint->least;
    joint->standstill = better ? 0 : joint->standstill + 1;
    if (met || step->converged)
        return;
    if (!step->finished && joint->standstill >= patience) {
        step->finished = true;
        tell_worst(joint, worst,
                   "no step makes all states better together; they seem to have no potential in "
                   "common: ",
                   step->reason);
    } else if (step->finished) {
        tell_worst(joint, worst, "", step->reason);
    }
}

/// Let the other states sample what the first one does.
static void follow(struct joint *joint) {
    const struct inversion *leader = leader_of(joint);
    for (size_t s = 1; s < joint->states; s++) {
        struct inversion *state = &joint->state[s];
        memcpy(state->phi, leader->phi, leader->grid.points * sizeof *leader->phi);
        state->progress.iteration = leader->progress.iteration;
        state->progress.anew = leader->progress.anew;
    }
}

static void add_work(struct joint *joint, struct inverse_step *step) {
    for (size_t s = 1; s < joint->states; s++) {
        step->evaluations += joint->state[s].progress.evaluations;
        step->engine_steps += joint->state[s].progress.sweeps;
    }
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct joint *joint = memory;
    struct inversion *leader = leader_of(joint);
    enum status status;
    follow(joint);
    for (size_t s = 0; s < joint->states; s++)
        TRY(mf_inversion_observe(&joint->state[s], listener));
    if (joint->states == 1)
        return mf_inversion_advance(leader, step);
    const struct worst worst = find_worst(joint, -1);
    const double distance = find_distance(joint);
    TRY(reduce(joint));
    join_distances(joint);
    leader->joint = &joint->system;
    status = mf_inversion_advance(leader, step);
    leader->joint = NULL;
    TRY(status); // else there is no step
    add_work(joint, step);
    end_at_standstill(joint, distance, &worst, step);
    return STATUS_OK;
}

static enum status update(struct inversion *inversion, double *extra) {
    return mf_imc_step(inversion, &(const struct imc_parameters){0}, inversion->step, extra);
}

// The record --------------------------------------------------------------------------------------

static enum status allocate(struct joint *joint) {
    enum status status = STATUS_OK;
    const struct inversion *leader = leader_of(joint);
    const size_t known = leader->grid.known;
    NEW_ARRAY(joint->covariance, known * known);
    NEW_ARRAY(joint->excess, known);
    NEW_ARRAY(joint->variance, known);
    joint->system = mf_inversion_system(leader);
    joint->system.covariance = joint->covariance;
    joint->system.excess = joint->excess;
    joint->system.variance = joint->variance;
done:
    return status;
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    enum status status = STATUS_OK;
    struct joint *joint = memory;
    const size_t states = problem->states > 0 ? problem->states : 1;
    if (problem->bonded > 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.name: \"%s\" finds potentials of pairs; give bonds, angles "
                              "and dihedrals their laws",
                              method->name);
    NEW_ARRAY(joint->state, states);
    for (; joint->states < states; joint->states++) {
        const struct inverse_problem *own = states > 1 ? problem->state[joint->states] : problem;
        status = mf_inversion_create(&joint->state[joint->states], method, own, parameters);
        CHECK(status == STATUS_OK || states == 1
                  ? status
                  : mf_status_prefix(status, "states.%s", own->name));
    }
    CHECK(allocate(joint));
done:
    if (status != STATUS_OK && joint->state && joint->states < states)
        joint->states++; // the one that failed has memory, too
    return status;
}

static void destroy(void *memory) {
    struct joint *joint = memory;
    for (size_t s = 0; s < joint->states; s++)
        mf_inversion_destroy(&joint->state[s]);
    mf_memory_free(joint->state);
    mf_memory_free(joint->covariance);
    mf_memory_free(joint->excess);
    mf_memory_free(joint->variance);
}

static size_t spans(void *memory, struct memory_span *span) {
    struct joint *joint = memory;
    size_t n = 0;
    span[n++] = (struct memory_span){&joint->least, sizeof joint->least};
    span[n++] = (struct memory_span){&joint->standstill, sizeof joint->standstill};
    for (size_t s = 0; s < joint->states; s++)
        n += mf_inversion_spans(&joint->state[s], span + n);
    return n;
}

static enum status write(const void *memory, const struct inverse_folder *folder) {
    return mf_inversion_write(leader_of(memory), folder);
}

static const char *const columns[] = {INVERSION_COLUMNS, "regularisation[1]", "misfit[1]",
                                      "directions", NULL};

const struct inverse_method mf_joint_imc = {
    .name = "joint-imc",
    .summary = "inverse Monte Carlo of several \"states\" that share a potential; A. P. "
               "Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995), with the equations of "
               "all states",
    .kind = INVERSE_INVERSION,
    .own = &(const struct inversion_rule){update},
    .tables = (const struct inverse_table[]){INVERSION_TABLE, {NULL, 0}},
    .parameters_size = sizeof(struct inversion_settings),
    .state_size = sizeof(struct joint),
    .most_iterations = mf_inversion_most_iterations,
    .columns = columns,
    .finds_potential = true,
    .knows_molecules = true,
    .knows_states = true,
    .create = create,
    .destroy = destroy,
    .iterate = iterate,
    .spans = spans,
    .write = write,
};
