// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/monte_carlo.h"

#include "dynamics/simulation.h"

#include <string.h>

static enum status begin(struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    struct monte_carlo *state = simulation->integrator_state;
    struct particles *particles = &simulation->particles;
    for (int d = 0; d < particles->box.dimensions; d++)
        memset(particles->velocity[d], 0, particles->count * sizeof *particles->velocity[d]);
    TRY(mf_metropolis_init_at(&state->chain, particles, &simulation->law,
                              mf_molecules_find(setup->interaction, setup->interactions)));
    state->chain.cancel = setup->cancel;
    return STATUS_OK;
}

static void clear(void *state) {
    mf_metropolis_clear(&((struct monte_carlo *)state)->chain);
}

/// The particles of the simulation keep their order and their images of the box, which its list is
/// about.
static void follow(struct particles *particles, const struct particles *chain) {
    uint32_t *place = particles->spare_words; // of each id in the chain
    for (size_t k = 0; k < chain->count; k++)
        place[chain->id[k]] = (uint32_t)k;
    for (int d = 0; d < chain->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++) {
            const uint32_t from = place[particles->id[k]];
            particles->position[d][k] =
                chain->position[d][from] +
                chain->box.length[d] * (chain->image[d][from] - particles->image[d][k]);
        }
}

static enum status step(struct simulation *simulation) {
    struct monte_carlo *state = simulation->integrator_state;
    const enum status status =
        state->settled ? mf_metropolis_run(&state->chain, 1) : mf_metropolis_tune(&state->chain);
    if (status != STATUS_OK) {
        simulation->step--; // no bead has moved
        return status;
    }
    follow(&simulation->particles, &state->chain.particles);
    return STATUS_OK;
}

static void settle(void *state) {
    ((struct monte_carlo *)state)->settled = true;
}

/// The order of the moves is that of the start, which a run that goes on has, too.
static size_t spans(void *state, struct memory_span *spans) {
    struct monte_carlo *s = state;
    struct metropolis *chain = &s->chain;
    const size_t count = chain->particles.count;
    size_t n = mf_particles_spans(&chain->particles, spans);
    for (int d = 0; d < chain->particles.box.dimensions; d++)
        spans[n++] = (struct memory_span){chain->neighbours.built[d], count * sizeof(double)};
    spans[n++] = (struct memory_span){&chain->step, sizeof chain->step};
    spans[n++] = (struct memory_span){&chain->sweep, sizeof chain->sweep};
    spans[n++] = (struct memory_span){&chain->accepted, sizeof chain->accepted};
    spans[n++] = (struct memory_span){&chain->tried, sizeof chain->tried};
    spans[n++] = (struct memory_span){chain->molecules.tally, sizeof chain->molecules.tally};
    spans[n++] = (struct memory_span){&s->settled, sizeof s->settled};
    return n;
}

static enum status restore(void *state) {
    struct metropolis *chain = &((struct monte_carlo *)state)->chain;
    return mf_neighbours_rebuild(&chain->neighbours, &chain->particles);
}

static size_t numbers(const void *state, struct integrator_number *numbers) {
    static const char *const names[MOLECULE_MOVES] = {"acceptance_translate", "acceptance_rotate",
                                                      "acceptance_pivot"};
    const struct metropolis *chain = &((const struct monte_carlo *)state)->chain;
    size_t n = 0;
    numbers[n++] = (struct integrator_number){"acceptance_beads",
                                              (double)chain->accepted / (double)chain->tried};
    for (int move = 0; move < MOLECULE_MOVES; move++) {
        const struct molecule_tally *tally = &chain->molecules.tally[move];
        if (tally->tried > 0)
            numbers[n++] = (struct integrator_number){names[move], (double)tally->accepted /
                                                                       (double)tally->tried};
    }
    return n;
}

static const struct field fields[] = {FIELD_END};

const struct integrator mf_monte_carlo = {
    .name = "monte-carlo",
    .summary = "Metropolis Monte Carlo: a step is a sweep, one move of each bead and of each "
               "molecule; N. Metropolis et al., J. Chem. Phys. 21, 1087 (1953)",
    .fields = fields,
    .state_size = sizeof(struct monte_carlo),
    .begin = begin,
    .clear = clear,
    .spans = spans,
    .restore = restore,
    .settle = settle,
    .numbers = numbers,
    .masses = true,
    .samples = true,
    .step = step,
};
