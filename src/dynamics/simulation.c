// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/visible.h"
#include "dynamics/relax.h"
#include "dynamics/relax_molecules.h"
#include "dynamics/simulation_place.h"
#include "dynamics/unstable.h"
#include "forces/molecules.h"
#include "system/orientation.h"

#include <unistd.h>

double mf_simulation_range(const struct simulation_setup *setup) {
    const struct pair_law law = {.potential = setup->potential, .omega = setup->omega};
    double range = fmax(mf_pair_cutoff(&law), mf_pair_memory_range(&setup->memory));
    for (int k = 0; k < setup->interactions; k++) {
        const struct interaction_choice *choice = &setup->interaction[k];
        if (choice->kind->range)
            range = fmax(range, choice->kind->range(choice->parameters));
    }
    return range;
}

/// The lightest particles are the fastest, and wear the list out.
static double lightest(const struct simulation_setup *setup) {
    const struct attributes_source *mass = &setup->attribute[ATTRIBUTES_MASS];
    return mass->ranges > 0 ? mf_attributes_span(mass).minimum : 1;
}

/// Speed of particles without velocities: of what drives them, or of unknown forces if
/// not even noise moves them.
static double drift_of(const struct simulation_setup *setup) {
    static const double slowest = 1e-3; // of the range in a step
    const double driven = mf_simulation_push(setup) * setup->integrator->mobility(setup);
    const bool still = driven == 0 && setup->temperature == 0;
    return still ? slowest * mf_simulation_range(setup) / setup->time_step : driven;
}

/// A list of Monte Carlo is for one look, and the next one finds the particles anywhere.
static double free_step_of(const struct simulation_setup *setup) {
    if (setup->integrator->samples)
        return mf_box_shortest(&setup->box);
    return setup->integrator->mobility ? simulation_free_step(setup) : 0;
}

struct skin_scene mf_simulation_skin_scene(const struct simulation_setup *setup) {
    return (struct skin_scene){.box = &setup->box,
                               .count = (size_t)setup->placement.count,
                               .cutoff = mf_simulation_range(setup),
                               .temperature = setup->temperature / lightest(setup),
                               .time_step = setup->time_step,
                               .free_step = free_step_of(setup),
                               .drift = setup->integrator->mobility ? drift_of(setup) : 0};
}

double mf_simulation_push(const struct simulation_setup *setup) {
    double push = 0;
    for (int k = 0; k < setup->interactions; k++) {
        const struct interaction_choice *choice = &setup->interaction[k];
        push += choice->kind->push ? choice->kind->push(choice->parameters) : 0;
    }
    return push;
}

const struct interaction *mf_simulation_oriented(const struct simulation_setup *setup) {
    for (int k = 0; k < setup->interactions; k++)
        if (setup->interaction[k].kind->oriented)
            return setup->interaction[k].kind;
    return NULL;
}

bool mf_simulation_is_thermal(const struct simulation_setup *setup) {
    return setup->temperature > 0 && mf_simulation_oriented(setup) == NULL;
}

static double find_skin(const struct simulation *simulation) {
    const struct skin_scene scene = mf_simulation_skin_scene(&simulation->setup);
    return simulation->setup.skin > 0 ? simulation->setup.skin : mf_skin_choose(&scene);
}

/// Copy the parameters of the integrator, or its defaults, and make room for its state.
static enum status prepare_integrator(struct simulation *simulation) {
    const struct integrator *integrator = simulation->setup.integrator;
    const void *given = simulation->setup.integrator_parameters;
    const size_t size = integrator->parameters_size;
    if (size > 0) {
        simulation->integrator_parameters = mf_memory_zeroed(1, size);
        if (simulation->integrator_parameters == NULL)
            return STATUS_NO_MEMORY;
        mf_fields_set_defaults(integrator->fields, simulation->integrator_parameters);
        if (given)
            memcpy(simulation->integrator_parameters, given, size);
    }
    simulation->setup.integrator_parameters = simulation->integrator_parameters;
    if (integrator->state_size > 0)
        simulation->integrator_state = mf_memory_zeroed(1, integrator->state_size);
    return integrator->state_size == 0 || simulation->integrator_state ? STATUS_OK
                                                                       : STATUS_NO_MEMORY;
}

enum status mf_simulation_add_interaction(struct simulation *simulation,
                                          const struct interaction_choice *choice) {
    const struct interaction *kind = choice->kind;
    if (simulation->interactions == SIMULATION_MAX_INTERACTIONS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there are %d interactions already", kind->name,
                              SIMULATION_MAX_INTERACTIONS);
    struct interaction_use *use = &simulation->interaction[simulation->interactions++];
    *use = (struct interaction_use){.choice = *choice};
    if (kind->state_size > 0) {
        use->state = mf_memory_zeroed(1, kind->state_size);
        if (use->state == NULL)
            return STATUS_NO_MEMORY;
    }
    if (kind->join)
        kind->join(use->state, &simulation->law);
    return kind->begin ? kind->begin(choice->parameters, use->state, &simulation->particles)
                       : STATUS_OK;
}

static enum status add_interactions(struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    TRY(mf_simulation_add_interaction(simulation, &(struct interaction_choice){&mf_pairs, NULL}));
    for (int k = 0; k < setup->interactions; k++)
        TRY(mf_simulation_add_interaction(simulation, &setup->interaction[k]));
    return STATUS_OK;
}

static void clear_interactions(struct simulation *simulation) {
    for (int k = 0; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        if (use->state && use->choice.kind->clear)
            use->choice.kind->clear(use->state);
        mf_memory_free(use->state);
    }
    simulation->interactions = 0;
}

/// Whether particles and their neighbours go into the memory of this machine: a box that is too
/// small for its molecules has more of them than any.
static enum status check_memory(const struct simulation_setup *setup) {
    static const double bytes_of_particle = 300, bytes_of_pair = 4, giga = 1e9;
    const double count = (double)setup->placement.count;
    const double density = count / mf_box_volume(&setup->box);
    const double neighbours =
        density * mf_box_shell_volume(&setup->box, 0, mf_simulation_range(setup));
    const double bytes = count * (bytes_of_particle + 0.5 * bytes_of_pair * neighbours);
    const double there = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (!(bytes > there))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%.0f particles with %.3g neighbours each would take %.3g GB, and this "
                          "machine has %.3g: is the box too small?",
                          count, neighbours, bytes / giga, there / giga);
}

enum status mf_simulation_init(struct simulation *simulation, const struct simulation_setup *setup,
                               const struct simulation_start *start) {
    enum status status = STATUS_OK;
    *simulation = (struct simulation){
        .setup = *setup,
        .law = {.composition = setup->composition,
                .potential = setup->potential,
                .omega = setup->omega,
                .temperature = setup->temperature,
                .time_step = setup->time_step,
                .seed = setup->seed,
                .precision = (enum pair_precision)setup->precision},
    };
    const size_t count = (size_t)setup->placement.count;
    CHECK(prepare_integrator(simulation));
    CHECK(check_memory(&simulation->setup));
    CHECK(mf_particles_init(&simulation->particles, &setup->box, count));
    if (simulation->law.precision == PAIR_DOUBLE)
        CHECK(mf_particles_keep_precise(&simulation->particles));
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    if (molecules)
        CHECK(mf_particles_join(&simulation->particles, &molecules->topology));
    mf_thread_count_init(&simulation->threads, setup->threads > 1 ? setup->threads : 1);
    simulation->particles.threads = simulation->threads.now;
    CHECK(mf_neighbours_init(&simulation->neighbours, NEIGHBOURS_HALF, &setup->box, count,
                             mf_simulation_range(setup), find_skin(simulation)));
    if (setup->omega && setup->integrator->friction)
        CHECK(mf_friction_init(&simulation->friction, setup->omega, setup->time_step,
                               setup->temperature, setup->integrator->friction));
    if (pair_memory_acts(&setup->memory))
        CHECK(
            mf_pair_memory_init(&simulation->memory, &setup->memory,
                                &(struct pair_memory_scene){setup->composition, setup->temperature,
                                                            setup->time_step, setup->seed}));
    CHECK(mf_simulation_place(simulation, start));
    CHECK(add_interactions(simulation));
    CHECK(mf_neighbours_sort_and_build(&simulation->neighbours, &simulation->particles));
    if (molecules && setup->placement.kind != PLACEMENT_FILE)
        CHECK(mf_relax_molecules(simulation));
    if (!molecules && setup->placement.kind == PLACEMENT_RANDOM && setup->potential)
        CHECK(mf_relax_overlaps(simulation));
    CHECK(mf_simulation_compute_forces(simulation, 0));
    if (setup->integrator->begin)
        CHECK(setup->integrator->begin(simulation));
done:
    if (status != STATUS_OK)
        mf_simulation_clear(simulation);
    return status;
}

void mf_simulation_clear(struct simulation *simulation) {
    if (simulation->integrator_state && simulation->setup.integrator->clear)
        simulation->setup.integrator->clear(simulation->integrator_state);
    mf_memory_free(simulation->integrator_state);
    mf_memory_free(simulation->integrator_parameters);
    simulation->integrator_state = simulation->integrator_parameters = NULL;
    clear_interactions(simulation);
    mf_particles_clear(&simulation->particles);
    mf_neighbours_clear(&simulation->neighbours);
    mf_friction_clear(&simulation->friction);
    mf_pair_memory_clear(&simulation->memory);
}

void mf_simulation_take_temperature(struct simulation *simulation) {
    if (simulation->wants == PAIR_FORCES_AND_SUMS)
        simulation->temperature = mf_particles_temperature(&simulation->particles);
}

double mf_simulation_temperature(const struct simulation *simulation) {
    if (!simulation_has_velocities(&simulation->setup) || simulation->particles.count < 2)
        return NAN;
    return isfinite(simulation->temperature) ? simulation->temperature
                                             : mf_particles_temperature(&simulation->particles);
}

/// The mean m v² along an axis beyond which a simulation is unstable: so many times that of the
/// temperature, or v² of a free particle's steps. Particles without velocities that something
/// drives, or that no noise moves, may move in a step as far as they see each other.
static double largest_square(const struct simulation_setup *setup) {
    if (setup->integrator->mobility == NULL)
        return setup->temperature_limit * setup->temperature;
    const double range = mf_simulation_range(setup);
    const double steps = setup->temperature_limit * pow(simulation_free_step(setup), 2);
    const double far = mf_simulation_is_thermal(setup) ? 0 : range > 0 ? range * range : INFINITY;
    return fmax(steps, far) / pow(setup->time_step, 2);
}

static enum status fail_unstable(const struct simulation *simulation, double square) {
    const struct simulation_setup *setup = &simulation->setup;
    const bool has_velocities = simulation_has_velocities(setup);
    const double unit = has_velocities ? 1 : setup->time_step * setup->time_step;
    char what[128];
    snprintf(what, sizeof what,
             has_velocities
                 ? "kinetic temperature %.3g" STATUS_TEMPERATURE " (limit %g" STATUS_TEMPERATURE ")"
                 : "mean squared step along an axis %.3g" STATUS_AREA " (limit %g" STATUS_AREA ")",
             mf_visible_number(square * unit), largest_square(setup) * unit);
    return mf_unstable_fail(simulation, what);
}

/// Before a list is built: particles flung beyond the reach of box_fraction would meet on a few
/// spots, where the list is one of all pairs and takes minutes.
static enum status check_flight(const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const double flight = simulation->setup.time_step *
                          sqrt(mf_particles_square_velocities(particles)) /
                          mf_box_shortest(&particles->box);
    char what[128];
    if (flight <= 0x1p18)
        return STATUS_OK;
    snprintf(what, sizeof what, "particles fly %.3g times the edge of the box in a step",
             mf_visible_number(flight));
    return mf_unstable_fail(simulation, what);
}

/// Count the time since `begin` to a phase; returns the present time.
static uint64_t count_ticks(struct simulation *simulation, enum simulation_phase phase,
                            uint64_t begin) {
    const uint64_t now = clock_ticks();
    simulation->ticks[phase] += now - begin;
    return now;
}

static enum status refresh_list(struct simulation *simulation) {
    struct particles *particles = &simulation->particles;
    if (!mf_neighbours_are_stale(&simulation->neighbours, particles)) {
        mf_particles_update_fractions(particles);
        return STATUS_OK;
    }
    TRY(check_flight(simulation));
    const enum status status = mf_neighbours_sort_and_build(&simulation->neighbours, particles);
    // At the start positions are moved by forces alone, whatever the velocities.
    TRY(status == STATUS_UNSTABLE ? mf_unstable_fail(simulation, mf_status_marked()) : status);
    simulation->list_builds++;
    return STATUS_OK;
}

static enum status apply(const struct interaction_use *use, const struct interaction_pass *pass) {
    return use->choice.kind->add(use->choice.parameters, use->state, pass);
}

/// One pass: forces and sums are replaced by those of all interactions, the pairs (forces/pairs.c)
/// among them.
static enum status apply_interactions(const struct simulation *simulation,
                                      const struct interaction_pass *pass) {
    struct interaction_pass before = *pass;
    before.before_pairs = true;
    *pass->sums = (struct pair_sums){0};
    mf_pair_clear(pass->particles);
    for (int k = 0; k < simulation->interactions; k++)
        if (simulation->interaction[k].choice.kind->before_pairs)
            TRY(apply(&simulation->interaction[k], &before));
    for (int k = 0; k < simulation->interactions; k++)
        if (!simulation->interaction[k].choice.kind->before_pairs)
            TRY(apply(&simulation->interaction[k], pass));
    return STATUS_OK;
}

enum status mf_simulation_compute_forces(struct simulation *simulation, double ahead) {
    struct particles *particles = &simulation->particles;
    struct neighbours *neighbours = &simulation->neighbours;
    struct pair_law law = simulation->law;
    uint64_t begin = clock_ticks();
    if (simulation->friction.single)
        law.friction = &simulation->friction;
    else if (law.omega)
        mf_particles_update_motion(particles,
                                   ahead); // before a sort, which does not move the forces
    TRY(refresh_list(simulation));
    if (law.friction)
        TRY(mf_friction_reserve(law.friction, neighbours));
    law.transfer = simulation->transfer;
    begin = count_ticks(simulation, SIMULATION_LIST, begin);
    mf_orientation_clear_torques(particles);
    const enum status status =
        apply_interactions(simulation, &(struct interaction_pass){.law = &law,
                                                                  .particles = particles,
                                                                  .neighbours = neighbours,
                                                                  .step = simulation->step,
                                                                  .wants = simulation->wants,
                                                                  .sums = &simulation->sums});
    mf_transfer_collect(law.transfer, neighbours->parts, simulation->setup.time_step);
    count_ticks(simulation, SIMULATION_FORCES, begin);
    return status;
}

enum status mf_simulation_compute_potential(struct simulation *simulation) {
    TRY(refresh_list(simulation));
    return apply_interactions(simulation,
                              &(struct interaction_pass){.law = &simulation->law,
                                                         .particles = &simulation->particles,
                                                         .neighbours = &simulation->neighbours,
                                                         .step = simulation->step,
                                                         .conservative = true,
                                                         .wants = PAIR_FORCES_AND_SUMS,
                                                         .sums = &simulation->sums});
}

/// Σ m v² tells at once of NaN, overflow and a runaway temperature; what drifts as a whole is asked
/// for its velocities relative to the mean.
static enum status check_stable(const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const double degrees = particles->box.dimensions * fmax(1, (double)particles->count - 1);
    const double max = largest_square(&simulation->setup);
    if (2 * mf_particles_kinetic_energy(particles) / degrees <= max)
        return STATUS_OK;
    const double square = mf_particles_temperature(particles);
    return square <= max ? STATUS_OK : fail_unstable(simulation, square);
}

enum status mf_simulation_run(struct simulation *simulation, uint64_t steps) {
    for (uint64_t k = 0; k < steps; k++) {
        if (mf_interrupt_wanted(simulation->setup.cancel))
            return mf_status_fail(STATUS_INTERRUPTED, "interrupted");
        const uint64_t begin = clock_ticks();
        const uint64_t other =
            simulation->ticks[SIMULATION_LIST] + simulation->ticks[SIMULATION_FORCES];
        simulation->step++;
        simulation->temperature = NAN;
        simulation->particles.threads = simulation->threads.now;
        TRY(simulation->setup.integrator->step(simulation));
        mf_transfer_carry(simulation->transfer, &simulation->particles,
                          simulation->setup.time_step);
        TRY(check_stable(simulation));
        mf_thread_count_update(&simulation->threads,
                               count_ticks(simulation, SIMULATION_MOTION, begin) - begin);
        simulation->ticks[SIMULATION_MOTION] -=
            simulation->ticks[SIMULATION_LIST] + simulation->ticks[SIMULATION_FORCES] - other;
    }
    return STATUS_OK;
}

double mf_simulation_pressure(const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const struct simulation_setup *setup = &simulation->setup;
    const bool held = simulation->law.omega || pair_memory_acts(&setup->memory) ||
                      !simulation_has_velocities(setup);
    const double temperature = held ? setup->temperature : mf_simulation_temperature(simulation);
    return mf_particles_density(particles) * temperature +
           simulation->sums.virial / (particles->box.dimensions * mf_box_volume(&particles->box));
}

size_t mf_simulation_spans(struct simulation *simulation, struct memory_span *spans) {
    struct particles *particles = &simulation->particles;
    const struct integrator *integrator = simulation->setup.integrator;
    const size_t numbers = particles->count * sizeof(double);
    size_t n = simulation_wants_capacity(simulation)
                   ? mf_pair_memory_spans(&simulation->memory, spans)
                   : 0;
    n += mf_particles_spans(particles, spans + n);
    for (int d = 0; d < particles->box.dimensions; d++)
        spans[n++] = (struct memory_span){simulation->neighbours.built[d], numbers};
    spans[n++] = (struct memory_span){&simulation->step, sizeof simulation->step};
    spans[n++] = (struct memory_span){&simulation->list_builds, sizeof simulation->list_builds};
    if (integrator->spans)
        n += integrator->spans(simulation->integrator_state, spans + n);
    for (int k = 0; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        if (use->choice.kind->spans)
            n += use->choice.kind->spans(use->state, spans + n);
    }
    return n;
}

enum status mf_simulation_reserve(struct simulation *simulation) {
    return mf_pair_memory_reserve(&simulation->memory);
}

enum status mf_simulation_restore(struct simulation *simulation) {
    TRY(mf_neighbours_rebuild(&simulation->neighbours, &simulation->particles));
    const struct integrator *integrator = simulation->setup.integrator;
    if (integrator->restore)
        TRY(integrator->restore(simulation->integrator_state));
    // Kept pairs are not saved; another pass at the same step keeps the same.
    return integrator->friction_first ? mf_simulation_compute_forces(simulation, 0) : STATUS_OK;
}
