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

// The equations of all states
// ----------------------------------------------------------------------

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

// All states in one
// --------------------------------------------------------------------------------

static void add_squares(struct target_distance *sum, const struct target_distance *own,
                        size_t states) {
    sum->rms += own->rms * own->rms / (double)states;
    sum->noise += own->noise * own->noise / (double)states;
    sum->variance += own->variance / (double)states;
    sum->count += own->count;
}

/// The distances of the first state become those of all, rms over the states; its section that of
/// the state that is farthest off by its noise, with the noise of the least exact.
static void join_distances(struct joint *joint) {
    struct inversion *leader = leader_of(joint);
    struct target_distance all[TARGETS] = {{0}};
    double misfit = 0;
    for (size_t s = 0; s < joint->states; s++) {
        const struct inversion *state = &joint->state[s];
        const struct inversion_section *own = &state->section[0];
        struct inversion_section *worst = &leader->section[0];
        for (int kind = 0; kind < TARGETS; kind++)
            add_squares(&all[kind], &state->distance[kind], joint->states);
        if (own->rms * worst->noise > worst->rms * own->noise) {
            worst->rms = own->rms;
            worst->noise = own->noise;
        }
        worst->own_noise = fmax(worst->own_noise, own->own_noise);
        leader->own_noise = fmax(leader->own_noise, state->own_noise);
        leader->disagreement = fmax(leader->disagreement, state->disagreement);
        misfit += state->misfit / (double)joint->states;
    }
    for (int kind = 0; kind < TARGETS; kind++) {
        leader->distance[kind] = all[kind];
        leader->distance[kind].rms = sqrt(all[kind].rms);
        leader->distance[kind].noise = sqrt(all[kind].noise);
    }
    leader->misfit = misfit;
}

/// The state that is farthest off by its noise.
static size_t find_worst(const struct joint *joint) {
    size_t worst = 0;
    for (size_t s = 1; s < joint->states; s++) {
        const struct target_distance *own = &joint->state[s].distance[TARGET_RDF];
        const struct target_distance *most = &joint->state[worst].distance[TARGET_RDF];
        if (own->rms * most->noise > most->rms * own->noise)
            worst = s;
    }
    return worst;
}

/// Where the states want different potentials the steps end in a compromise, about which they go
/// on: the equations of a state that is far off carry the noise of C into the step.
static void end_at_standstill(struct joint *joint, size_t worst,
                              const struct target_distance *of_worst, struct inverse_step *step) {
    static const double progress = 0.95;
    static const uint32_t patience = 5;
    const bool better = step->iteration == 0 || step->error < progress * joint->least;
    joint->least = better ? step->error : joint->least;
    joint->standstill = better ? 0 : joint->standstill + 1;
    if (step->finished || joint->standstill < patience ||
        of_worst->rms <= mf_inverse_noise_margin * of_worst->noise)
        return;
    step->finished = true;
    snprintf(step->reason, sizeof step->reason,
             "no step makes all states better together: the error of g of \"%s\" is %.2g, its "
             "statistical error %.2g; they seem to have no potential in common",
             joint->state[worst].problem->name, of_worst->rms, of_worst->noise);
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
    const size_t worst = find_worst(joint);
    const struct target_distance of_worst = joint->state[worst].distance[TARGET_RDF];
    TRY(reduce(joint));
    join_distances(joint);
    leader->joint = &joint->system;
    status = mf_inversion_advance(leader, step);
    leader->joint = NULL;
    add_work(joint, step);
    end_at_standstill(joint, worst, &of_worst, step);
    return status;
}

static enum status update(struct inversion *inversion, double *extra) {
    return mf_imc_step(inversion, &(const struct imc_parameters){0}, inversion->step, extra);
}

// The record
// ---------------------------------------------------------------------------------------

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
        CHECK(mf_inversion_create(&joint->state[joint->states], method, own, parameters));
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
