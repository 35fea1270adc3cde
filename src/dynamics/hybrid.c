// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hybrid.h"

#include "base/rng.h"
#include "dynamics/hybrid_step.h"
#include "dynamics/relax_molecules.h"
#include "dynamics/respa.h"

#include <math.h>
#include <string.h>

/// A particle collides once in so many trajectories.
enum { TURNS = 25 };

/// A trajectory goes on so often where its end is not taken. To be turned round undoes what came
/// before, as the particles go back the way they came: what is slow takes 3 to 9 times as long with
/// one chance (lab/samplers.md).
enum { CHANCES = 16 };

/// Share of trajectories that are taken at their first chance, to which the time step is tuned, and
/// how fast.
static const double wanted_acceptance = 0.8, gain = 0.05;

enum status mf_hybrid_init(struct hybrid *hybrid, const struct box *box,
                           const struct composition *composition, const struct table *potential,
                           const struct molecules *molecules, const struct many_body *many_body,
                           const struct pair_histogram *bins, double temperature, uint64_t seed,
                           const struct placement_bias *bias) {
    enum status status = STATUS_OK;
    const size_t count = (size_t)mf_composition_particles(composition);
    const struct hybrid_step step =
        mf_hybrid_step_find(potential, molecules, many_body, temperature);
    const struct respa_parameters respa = {step.inner};
    struct simulation_setup setup = {
        .box = *box,
        .composition = *composition,
        .placement = {.count = (int64_t)count,
                      .kind = PLACEMENT_LATTICE,
                      .jitter = PLACEMENT_JITTER,
                      .bias = bias ? *bias : (struct placement_bias){0}},
        .temperature = temperature,
        .time_step = step.first,
        .temperature_limit = 1e6,
        .integrator = &mf_velocity_verlet,
        .integrator_parameters = &respa,
        .potential = potential,
        .seed = seed,
        .threads = 1,
    };
    if (molecules)
        setup.interaction[setup.interactions++] =
            (struct interaction_choice){&mf_molecules, molecules};
    if (many_body)
        setup.interaction[setup.interactions++] =
            (struct interaction_choice){&mf_many_body, many_body};
    *hybrid = (struct hybrid){.trial = *bins, .longest = step.longest};
    NEW_ARRAY(hybrid->trial.counts, NEIGHBOURS_MAX_PARTS * (pair_histogram_size(bins)));
    NEW_ARRAY(hybrid->kept, pair_histogram_size(bins));
    hybrid->counts = hybrid->kept;
    NEW_ARRAY(hybrid->id, count);
    for (int d = 0; d < box->dimensions; d++) {
        NEW_ARRAY(hybrid->position[d], count);
        NEW_ARRAY(hybrid->velocity[d], count);
    }
    CHECK(mf_simulation_init(&hybrid->simulation, &setup, NULL));
    CHECK(mf_hybrid_refresh(hybrid));
done:
    if (status != STATUS_OK)
        mf_hybrid_clear(hybrid);
    return status;
}

void mf_hybrid_clear(struct hybrid *hybrid) {
    mf_simulation_clear(&hybrid->simulation);
    for (int d = 0; d < 3; d++) {
        mf_memory_free(hybrid->position[d]);
        mf_memory_free(hybrid->velocity[d]);
    }
    mf_memory_free(hybrid->id);
    mf_memory_free(hybrid->trial.counts);
    mf_memory_free(hybrid->kept);
    *hybrid = (struct hybrid){0};
}

/// From now on a force pass counts the pairs and sums Φ and r·F, or no longer.
static void count_pairs(struct hybrid *hybrid, bool wanted) {
    struct simulation *simulation = &hybrid->simulation;
    const size_t row = pair_histogram_size(&hybrid->trial);
    if (wanted)
        memset(hybrid->trial.counts, 0,
               (size_t)simulation->neighbours.parts * row * sizeof(uint32_t));
    simulation->law.histogram = wanted && hybrid->trial.bins > 0 ? &hybrid->trial : NULL;
    simulation->wants = wanted ? PAIR_FORCES_AND_SUMS : PAIR_FORCES;
}

/// Keep what the last force pass has counted and summed.
static void keep_sample(struct hybrid *hybrid) {
    const size_t row = pair_histogram_size(&hybrid->trial);
    for (size_t a = 0; a < row; a++) {
        hybrid->kept[a] = 0;
        for (int p = 0; p < hybrid->simulation.neighbours.parts; p++)
            hybrid->kept[a] += hybrid->trial.counts[(size_t)p * row + a];
    }
    hybrid->sums = hybrid->simulation.sums;
}

enum status mf_hybrid_refresh(struct hybrid *hybrid) {
    struct simulation *simulation = &hybrid->simulation;
    TRY(mf_neighbours_sort_and_build(&simulation->neighbours, &simulation->particles));
    count_pairs(hybrid, true);
    TRY(mf_simulation_compute_forces(simulation, 0));
    count_pairs(hybrid, false);
    keep_sample(hybrid);
    return STATUS_OK;
}

/// Molecules are placed by their ids, and parted.
static enum status scatter_molecules(struct simulation *simulation,
                                     const struct molecules *molecules) {
    struct particles *particles = &simulation->particles;
    for (size_t k = 0; k < particles->count; k++)
        particles->id[k] = (uint32_t)k;
    TRY(mf_molecules_place(molecules, &simulation->law, particles, &simulation->setup.placement,
                           simulation->setup.seed));
    TRY(mf_neighbours_sort_and_build(&simulation->neighbours, particles));
    return mf_relax_molecules(simulation);
}

enum status mf_hybrid_scatter(struct hybrid *hybrid) {
    struct simulation *simulation = &hybrid->simulation;
    const struct simulation_setup *setup = &simulation->setup;
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    TRY(molecules ? scatter_molecules(simulation, molecules)
                  : mf_placement_disordered(&simulation->particles, setup->seed));
    if (!molecules)
        mf_placement_tilt(&simulation->particles, setup->placement.bias.tilt, setup->seed);
    return mf_hybrid_refresh(hybrid);
}

/// New velocities for the particles whose turn it is, by their ids.
static void collide(struct hybrid *hybrid) {
    struct particles *particles = &hybrid->simulation.particles;
    const double speed = sqrt(hybrid->simulation.setup.temperature);
    for (size_t k = 0; k < particles->count; k++) {
        if (particles->id[k] % TURNS != hybrid->trajectory % TURNS)
            continue;
        double normal[4];
        mf_rng_normal4(mf_rng_philox(hybrid->simulation.setup.seed, RNG_COLLISIONS,
                                     hybrid->trajectory, particles->id[k], 0),
                       normal);
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->velocity[d][k] = speed * normal[d];
    }
}

/// Φ + Σ v²/2 [k_B T_0].
static double hamiltonian(const struct hybrid *hybrid, const struct pair_sums *sums) {
    return sums->energy + mf_particles_kinetic_energy(&hybrid->simulation.particles);
}

static void remember(struct hybrid *hybrid) {
    const struct particles *particles = &hybrid->simulation.particles;
    const size_t count = particles->count;
    for (int d = 0; d < particles->box.dimensions; d++) {
        memcpy(hybrid->position[d], particles->position[d], count * sizeof(double));
        memcpy(hybrid->velocity[d], particles->velocity[d], count * sizeof(double));
    }
    memcpy(hybrid->id, particles->id, count * sizeof(uint32_t));
}

/// Back to where the trajectory began, the other way round.
static enum status turn_round(struct hybrid *hybrid, uint64_t list_builds) {
    struct simulation *simulation = &hybrid->simulation;
    struct particles *particles = &simulation->particles;
    const size_t count = particles->count;
    for (int d = 0; d < particles->box.dimensions; d++) {
        memcpy(particles->position[d], hybrid->position[d], count * sizeof(double));
        for (size_t k = 0; k < count; k++)
            particles->velocity[d][k] = -hybrid->velocity[d][k];
    }
    memcpy(particles->id, hybrid->id, count * sizeof(uint32_t));
    // A list that was built meanwhile belongs to another order of the particles.
    if (simulation->list_builds != list_builds)
        TRY(mf_neighbours_sort_and_build(&simulation->neighbours, particles));
    return mf_simulation_compute_forces(simulation, 0);
}

/// The steps of a trajectory; the last force pass counts. Unstable ones end beyond all energies.
static enum status propose(struct hybrid *hybrid, double *energy) {
    struct simulation *simulation = &hybrid->simulation;
    enum status status = mf_simulation_run(simulation, HYBRID_STEPS - 1);
    count_pairs(hybrid, true);
    if (status == STATUS_OK)
        status = mf_simulation_run(simulation, 1);
    count_pairs(hybrid, false);
    *energy = status == STATUS_OK ? hamiltonian(hybrid, &simulation->sums) : INFINITY;
    return status == STATUS_UNSTABLE ? STATUS_OK : status;
}

/// Go on until an end is taken, with one random number for all chances, as detailed balance asks;
/// an unstable trajectory has no more of them.
static enum status find_end(struct hybrid *hybrid, double before, double limit, bool *taken) {
    const double temperature = hybrid->simulation.setup.temperature;
    double after = before;
    *taken = false;
    for (int chance = 0; chance < CHANCES && !*taken && isfinite(after); chance++) {
        TRY(propose(hybrid, &after));
        // Written so that a NaN is refused.
        const double share = exp(-(after - before) / temperature);
        if (chance == 0)
            hybrid->accepted = share > 0 ? fmin(1, share) : 0;
        *taken = limit < share;
    }
    return STATUS_OK;
}

static enum status run_trajectory(struct hybrid *hybrid) {
    struct simulation *simulation = &hybrid->simulation;
    bool taken;
    collide(hybrid);
    remember(hybrid);
    const uint64_t list_builds = simulation->list_builds;
    const struct rng_block random =
        mf_rng_philox(simulation->setup.seed, RNG_METROPOLIS, hybrid->trajectory++, UINT32_MAX, 0);
    TRY(find_end(hybrid, hamiltonian(hybrid, &hybrid->sums), mf_rng_uniform(random.word[0], 0),
                 &taken));
    hybrid->tried++;
    if (!taken)
        return turn_round(hybrid, list_builds);
    hybrid->taken++;
    keep_sample(hybrid);
    return STATUS_OK;
}

enum status mf_hybrid_run(struct hybrid *hybrid, uint64_t trajectories) {
    for (uint64_t k = 0; k < trajectories; k++)
        TRY(run_trajectory(hybrid));
    return STATUS_OK;
}

enum status mf_hybrid_equilibrate(struct hybrid *hybrid, uint64_t trajectories) {
    struct simulation_setup *setup = &hybrid->simulation.setup;
    for (uint64_t k = 0; k < trajectories; k++) {
        TRY(run_trajectory(hybrid));
        setup->time_step *= exp(gain * (hybrid->accepted - wanted_acceptance));
        setup->time_step = fmin(setup->time_step, hybrid->longest);
    }
    hybrid->taken = hybrid->tried = 0;
    return STATUS_OK;
}
