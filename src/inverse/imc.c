// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo. A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995).
#include "inverse/inverse.h"

#include "base/comoments.h"
#include "base/memory.h"
#include "base/rng.h"
#include "base/statistics.h"
#include "dynamics/metropolis.h"
#include "inverse/imc_solve.h"
#include "inverse/potential_grid.h"

#include <math.h>
#include <string.h>

/// Consecutive parts of each replica's samples; their scatter gives the statistical error.
enum { BLOCKS = 4, MAX_REPLICAS = 64 };

/// The error counts as statistical below this multiple of the noise of target and measurement: the
/// potential also carries the noise of the measurement before (a factor of up to sqrt 2), and the
/// errors of a target are themselves known to 10 to 20 %.
static const double noise_margin = 1.5;

/// Largest change of the potential in one iteration where the target is well known [k_B T_0].
static const double largest_change = 1;

struct parameters {
    int64_t particles, replicas;
    int64_t equilibration, samples, every;
    int64_t iterations;
    double precision, damping, strength;
};

struct replica {
    struct metropolis sampler;
    struct comoments counts; ///< of S over this iteration's samples
    double *histogram;       ///< shape [bins]: S of one sample
    double *block;           ///< shape [BLOCKS, bins]: mean S of each block
};

struct state {
    struct parameters parameters;
    const struct inverse_problem *problem;
    struct potential_grid grid;
    struct box box; ///< of the Monte Carlo system
    struct table table;
    struct replica replica[MAX_REPLICAS];
    struct comoments counts;       ///< merged
    double *ideal, *target_counts; ///< shape [bins]
    double *excess, *variance;     ///< of S, shape [bins]
    double *phi, *step, *error;    ///< present potential and the last step, shape [points]
    double *best, *best_step, *best_error;
    // What a checkpoint keeps besides phi, step and the samplers:
    struct progress {
        uint32_t iteration;
        int64_t effort; ///< the samples of an iteration are multiplied by this
        uint64_t evaluations, sweeps;
        double damping, best_rmse, best_noise, strength;
    } progress;
};

#define MEMBER(name) .offset = offsetof(struct parameters, name)
static const struct field fields[] = {
    {"particles", FIELD_INTEGER, MEMBER(particles), .initial = 0, .minimum = 0, .maximum = 1e7,
     .unit = "", .help = "of the Monte Carlo system, at the scene's density; 0 means the scene's"},
    {"replicas", FIELD_INTEGER, MEMBER(replicas), .initial = 8, .minimum = 2,
     .maximum = MAX_REPLICAS, .unit = "", .help = "independent Markov chains"},
    {"equilibration", FIELD_INTEGER, MEMBER(equilibration), .initial = 200, .minimum = 0,
     .maximum = 1e9, .unit = "sweeps",
     .help = "before each iteration's samples; five times as "
             "many before the first"},
    {"samples", FIELD_INTEGER, MEMBER(samples), .initial = 200, .minimum = 2 * BLOCKS,
     .maximum = 1e9, .unit = "",
     .help = "of each replica in the first iteration; doubled when "
             "the error has come down to the noise"},
    {"every", FIELD_INTEGER, MEMBER(every), .initial = 4, .minimum = 1, .maximum = 1e6,
     .unit = "sweeps", .help = "between samples"},
    {"iterations", FIELD_INTEGER, MEMBER(iterations), .initial = 30, .minimum = 1, .maximum = 10000,
     .unit = "", .help = "at most"},
    {"precision", FIELD_NUMBER, MEMBER(precision), .initial = 0.004, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "",
     .help = "statistical error of g, rms over bins, at which an "
             "agreement is believed"},
    {"damping", FIELD_NUMBER, MEMBER(damping), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "", .help = "share of the linear step taken at first; adapts"},
    {"strength", FIELD_NUMBER, MEMBER(strength), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "", .help = "of the Tikhonov regularisation; 0 chooses it from the noise"},
    FIELD_END,
};

static const char *const columns[] = {"damping[1]", "regularisation[1]", "own_noise[1]",
                                      "misfit[1]", NULL};

static struct inverse_sampling sampling(const void *parameters) {
    (void)parameters;
    return (struct inverse_sampling){0};
}

static uint32_t most_iterations(const struct inverse_method *method,
                                const struct inverse_problem *problem, const void *parameters) {
    (void)method, (void)problem;
    return (uint32_t)((const struct parameters *)parameters)->iterations;
}

static size_t bin_count(const struct state *state) {
    return state->problem->goals.bins.count;
}

static void destroy(void *memory) {
    struct state *state = memory;
    for (int64_t k = 0; k < state->parameters.replicas; k++) {
        struct replica *replica = &state->replica[k];
        metropolis_clear(&replica->sampler);
        comoments_clear(&replica->counts);
        memory_free(replica->histogram);
        memory_free(replica->block);
    }
    comoments_clear(&state->counts);
    table_clear(&state->table);
    potential_grid_clear(&state->grid);
    double *arrays[] = {state->ideal,     state->target_counts, state->excess, state->variance,
                        state->phi,       state->step,          state->error,  state->best,
                        state->best_step, state->best_error};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        memory_free(arrays[k]);
}

static enum status allocate(struct state *state) {
    enum status status = STATUS_OK;
    const size_t bins = bin_count(state), points = state->grid.points;
    NEW_ARRAY(state->ideal, bins);
    NEW_ARRAY(state->target_counts, bins);
    NEW_ARRAY(state->excess, bins);
    NEW_ARRAY(state->variance, bins);
    NEW_ARRAY(state->phi, points);
    NEW_ARRAY(state->step, points);
    NEW_ARRAY(state->error, points);
    NEW_ARRAY(state->best, points);
    NEW_ARRAY(state->best_step, points);
    NEW_ARRAY(state->best_error, points);
    CHECK(comoments_init(&state->counts, bins));
    for (int64_t k = 0; k < state->parameters.replicas; k++) {
        NEW_ARRAY(state->replica[k].histogram, bins);
        NEW_ARRAY(state->replica[k].block, BLOCKS * bins);
        CHECK(comoments_init(&state->replica[k].counts, bins));
    }
done:
    return status;
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    (void)method;
    struct state *state = memory;
    state->parameters = *(const struct parameters *)parameters;
    state->problem = problem;
    const struct parameters *p = &state->parameters;
    const size_t scene_count = (size_t)problem->scene.placement.count;
    const size_t count = p->particles > 0 ? (size_t)p->particles : scene_count;
    state->box = problem->scene.box;
    for (int d = 0; d < state->box.dimensions; d++)
        state->box.length[d] *=
            pow((double)count / (double)scene_count, 1.0 / state->box.dimensions);
    TRY(potential_grid_init(&state->grid, problem));
    TRY(allocate(state));
    const double finite_size = rdf_finite_size_factor(scene_count, count);
    for (size_t a = 0; a < bin_count(state); a++) {
        state->ideal[a] = rdf_ideal_pairs(&problem->goals.bins, a, &state->box, count);
        state->target_counts[a] =
            state->ideal[a] * problem->goals.goal[GOAL_RDF].value[a] * finite_size;
    }
    potential_grid_start(&state->grid, problem, state->phi);
    TRY(potential_grid_table(&state->grid, state->phi, &state->table));
    for (int64_t k = 0; k < p->replicas; k++)
        TRY(metropolis_init(&state->replica[k].sampler, &state->box, count, &state->table,
                            problem->scene.temperature,
                            rng_child_seed(problem->seed, RNG_EVALUATION, (uint32_t)k, 0)));
    state->progress = (struct progress){.effort = 1, .damping = p->damping, .best_rmse = INFINITY};
    return STATUS_OK;
}

/// Equilibrate one replica, then take its samples block by block.
static enum status sample_replica(const struct state *state, struct replica *replica) {
    const struct parameters *p = &state->parameters;
    const size_t bins = bin_count(state);
    const int64_t samples = p->samples * state->progress.effort;
    const int64_t equilibration = p->equilibration * (state->progress.iteration == 0 ? 5 : 1);
    comoments_reset(&replica->counts);
    memset(replica->block, 0, BLOCKS * bins * sizeof *replica->block);
    TRY(metropolis_refresh(&replica->sampler));
    TRY(metropolis_equilibrate(&replica->sampler, (uint32_t)equilibration));
    for (int64_t block = 0; block < BLOCKS; block++) {
        const int64_t begin = samples * block / BLOCKS, end = samples * (block + 1) / BLOCKS;
        for (int64_t sample = begin; sample < end; sample++) {
            TRY(metropolis_run(&replica->sampler, (uint32_t)p->every));
            memset(replica->histogram, 0, bins * sizeof *replica->histogram);
            rdf_count_pairs(&state->problem->goals.bins, &replica->sampler.particles,
                            &replica->sampler.neighbours, replica->histogram);
            // The sampler's list has each pair from both sides.
            for (size_t a = 0; a < bins; a++)
                replica->histogram[a] *= 0.5;
            comoments_add(&replica->counts, replica->histogram);
            for (size_t a = 0; a < bins; a++)
                replica->block[(size_t)block * bins + a] +=
                    replica->histogram[a] / (double)(end - begin);
        }
    }
    return STATUS_OK;
}

/// Sample all replicas in parallel and merge their counts in order.
static enum status sample_all(struct state *state, const struct inverse_listener *listener) {
    const int64_t replicas = state->parameters.replicas;
    enum status worst = STATUS_OK;
    uint64_t done = 0;
#pragma omp parallel for schedule(dynamic) num_threads(state->problem->threads)
    for (int64_t k = 0; k < replicas; k++) {
        const enum status status = sample_replica(state, &state->replica[k]);
#pragma omp critical
        {
            if (status != STATUS_OK)
                worst = status;
            done++;
            const struct inverse_progress progress = {.iteration = state->progress.iteration,
                                                      .iterations =
                                                          (uint32_t)state->parameters.iterations,
                                                      .done = done,
                                                      .total = (uint64_t)replicas,
                                                      .best = state->progress.best_rmse,
                                                      .mean = NAN};
            listener->tell(listener->context, &progress);
        }
    }
    if (worst == STATUS_INTERRUPTED)
        return status_fail(worst, "interrupted");
    if (worst != STATUS_OK)
        return status_fail(worst, "no memory for the Monte Carlo replicas");
    comoments_reset(&state->counts);
    for (int64_t k = 0; k < replicas; k++)
        comoments_merge(&state->counts, &state->replica[k].counts);
    return STATUS_OK;
}

/// Statistical inefficiency: how many samples count as one independent, from the scatter of the
/// block means, averaged over bins because that of one bin is noisy.
static double inefficiency(const struct state *state) {
    const size_t bins = bin_count(state);
    double scatter = 0, variance = 0;
    for (size_t a = state->grid.core; a < bins; a++) {
        struct running_mean blocks = {0};
        for (int64_t k = 0; k < state->parameters.replicas; k++)
            for (size_t b = 0; b < BLOCKS; b++)
                statistics_add(&blocks, state->replica[k].block[b * bins + a]);
        // Weighted by 1/S²: bins with many pairs would drown the others.
        const double weight = 1 / (state->ideal[a] * state->ideal[a]);
        scatter += weight * blocks.squares / (blocks.count - 1);
        variance += weight * comoments_covariance(&state->counts, a, a);
    }
    const double block_samples =
        state->counts.count / (double)(state->parameters.replicas * BLOCKS);
    return variance > 0 ? fmax(1, scatter / variance * block_samples) : 1;
}

/// Fill excess and variance of S; returns rms errors of g over all bins.
static void assess(struct state *state, double *rmse, double *noise, double *own_noise) {
    const size_t bins = bin_count(state);
    const double independent = state->counts.count / inefficiency(state);
    double sum = 0, own = 0, both = 0;
    for (size_t a = 0; a < bins; a++) {
        const double target_error = state->ideal[a] * state->problem->goals.goal[GOAL_RDF].error[a];
        // An empty bin still has the uncertainty of one pair.
        const double sampled =
            fmax(comoments_covariance(&state->counts, a, a), 1 / state->counts.count) / independent;
        state->excess[a] = state->counts.mean[a] - state->target_counts[a];
        state->variance[a] = sampled + target_error * target_error;
        const double unit = 1 / (state->ideal[a] * state->ideal[a]);
        if (a >= state->grid.core) {
            own += unit * sampled;
            both += unit * state->variance[a];
        }
        sum += unit * state->excess[a] * state->excess[a];
    }
    *rmse = sqrt(sum / (double)bins);
    *own_noise = sqrt(own / (double)bins);
    *noise = sqrt(both / (double)bins);
}

/// The regularised linear step for the known bins.
static enum status find_step(struct state *state, double *strength, double *misfit) {
    enum status status = STATUS_OK;
    const size_t core = state->grid.core, known = state->grid.known;
    double *covariance = NULL;
    struct imc_solution solution;
    NEW_ARRAY(covariance, known * known);
    for (size_t a = 0; a < known; a++)
        for (size_t b = 0; b < known; b++)
            covariance[a * known + b] = comoments_covariance(&state->counts, core + a, core + b);
    const struct imc_system system = {.size = known,
                                      .covariance = covariance,
                                      .excess = state->excess + core,
                                      .variance = state->variance + core,
                                      .temperature = state->problem->scene.temperature,
                                      .spacing = state->problem->goals.bins.width};
    CHECK(imc_solve(&system, state->parameters.strength, state->step + core, state->error + core,
                    &solution));
    *strength = solution.strength;
    *misfit = solution.misfit;
done:
    memory_free(covariance);
    return status;
}

/// phi = best + damping · best_step, with a bound where the target is well known.
static void take_step(struct state *state) {
    const struct potential_grid *grid = &state->grid;
    double largest = 0;
    for (size_t a = grid->core; a < grid->core + grid->known; a++)
        if (state->problem->goals.goal[GOAL_RDF].value[a] > 0.1)
            largest = fmax(largest, fabs(state->best_step[a]));
    const double share = fmin(state->progress.damping, largest_change / fmax(largest, 1e-300));
    for (size_t a = grid->core; a < grid->core + grid->known; a++)
        state->phi[a] = state->best[a] + share * state->best_step[a];
    potential_grid_complete(grid, state->phi);
}

/// Keep the present potential as the best, with the step that leads on from it.
static void keep(struct state *state, double rmse, double noise) {
    const size_t bytes = state->grid.points * sizeof(double);
    memcpy(state->best, state->phi, bytes);
    memcpy(state->best_step, state->step, bytes);
    memcpy(state->best_error, state->error, bytes);
    state->progress.best_rmse = rmse;
    state->progress.best_noise = noise;
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct state *state = memory;
    struct progress *progress = &state->progress;
    const struct parameters *p = &state->parameters;
    double rmse, noise, own_noise, misfit;
    table_clear(&state->table);
    TRY(potential_grid_table(&state->grid, state->phi, &state->table));
    TRY(sample_all(state, listener));
    assess(state, &rmse, &noise, &own_noise);
    TRY(find_step(state, &progress->strength, &misfit));
    const int64_t samples = p->samples * progress->effort;
    progress->evaluations += (uint64_t)p->replicas;
    progress->sweeps +=
        (uint64_t)(p->replicas *
                   (samples * p->every + p->equilibration * (progress->iteration == 0 ? 5 : 1)));
    // A worse potential than the best, by more than chance: go back and take half the step.
    const bool worse = rmse > progress->best_rmse + 2 * noise;
    if (worse) {
        progress->damping *= 0.5;
    } else {
        if (progress->iteration > 0)
            progress->damping = fmin(1, 1.5 * progress->damping);
        keep(state, rmse, noise);
    }
    const bool agrees = !worse && rmse <= noise_margin * noise;
    const bool precise = own_noise <= p->precision;
    if (!worse && rmse < 2 * noise && !precise)
        progress->effort *= 2;
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = progress->evaluations,
        .engine_steps = progress->sweeps,
        .error = progress->best_rmse,
        .noise = progress->best_noise,
        .extra = {progress->damping, progress->strength, own_noise, misfit},
        .curve = {state->best},
        .curve_error = {state->best_error},
        .converged = agrees && precise,
        .finished = (agrees && precise) || progress->iteration + 1 >= p->iterations,
    };
    progress->iteration++;
    if (!step->finished)
        take_step(state);
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    const size_t bytes = state->grid.points * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    double *arrays[] = {state->phi, state->best, state->best_step, state->best_error};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        span[n++] = (struct memory_span){arrays[k], bytes};
    for (int64_t k = 0; k < state->parameters.replicas; k++) {
        struct metropolis *sampler = &state->replica[k].sampler;
        struct particles *particles = &sampler->particles;
        for (int d = 0; d < state->box.dimensions; d++)
            span[n++] =
                (struct memory_span){particles->position[d], particles->count * sizeof(double)};
        span[n++] = (struct memory_span){particles->id, particles->count * sizeof(uint32_t)};
        span[n++] = (struct memory_span){&sampler->step, sizeof sampler->step};
        span[n++] = (struct memory_span){&sampler->sweep, sizeof sampler->sweep};
    }
    return n;
}

const struct inverse_method imc = {
    .name = "imc",
    .summary = "inverse Monte Carlo; A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 "
               "(1995)",
    .tables = (const struct field *const[]){fields, NULL},
    .parameters_size = sizeof(struct parameters),
    .state_size = sizeof(struct state),
    .fits = {[UNKNOWN_POTENTIAL] = true},
    .most_iterations = most_iterations,
    .sampling = sampling,
    .columns = columns,
    .create = create,
    .destroy = destroy,
    .iterate = iterate,
    .spans = spans,
};
