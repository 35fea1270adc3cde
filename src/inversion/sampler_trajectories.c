// SPDX-License-Identifier: GPL-3.0-or-later
//
// Configurations by dynamics, whose last force pass counts the pairs.
#include "dynamics/hybrid.h"
#include "inversion/sampler_source.h"

static void clear(void *own) {
    mf_hybrid_clear(own);
}

static enum status init(void *own, const struct sampler_system *system,
                        const struct pair_histogram *bins) {
    struct hybrid *hybrid = own;
    TRY(mf_hybrid_init(hybrid, system->box, system->composition, system->potential,
                       system->molecules, system->many_body, bins, system->temperature,
                       system->seed, &system->bias));
    hybrid->simulation.setup.cancel = system->cancel;
    return STATUS_OK;
}

static enum status scatter(void *own) {
    return mf_hybrid_scatter(own);
}

static enum status begin(void *own) {
    return mf_hybrid_refresh(own);
}

static enum status equilibrate(void *own, uint64_t sweeps) {
    return mf_hybrid_equilibrate(own, sweeps);
}

static enum status run(void *own, uint64_t sweeps, struct sampler_pairs *pairs) {
    struct hybrid *hybrid = own;
    TRY(mf_hybrid_run(hybrid, sweeps));
    *pairs = (struct sampler_pairs){hybrid->counts, hybrid->sums};
    return STATUS_OK;
}

static double acceptance(const void *own) {
    const struct hybrid *hybrid = own;
    return (double)hybrid->taken / (double)hybrid->tried;
}

static const struct particles *particles(const void *own) {
    return &((const struct hybrid *)own)->simulation.particles;
}

static size_t spans(void *own, struct memory_span *span) {
    struct hybrid *hybrid = own;
    struct particles *beads = &hybrid->simulation.particles;
    double *time_step = &hybrid->simulation.setup.time_step;
    size_t n = mf_sampler_place_spans(beads, span);
    for (int d = 0; d < beads->box.dimensions; d++)
        span[n++] = (struct memory_span){beads->velocity[d], beads->count * sizeof(double)};
    span[n++] = (struct memory_span){time_step, sizeof *time_step};
    span[n++] = (struct memory_span){&hybrid->trajectory, sizeof hybrid->trajectory};
    return n;
}

const struct sampler_source mf_sampler_trajectories = {.size = sizeof(struct hybrid),
                                                       .init = init,
                                                       .clear = clear,
                                                       .scatter = scatter,
                                                       .begin = begin,
                                                       .equilibrate = equilibrate,
                                                       .run = run,
                                                       .acceptance = acceptance,
                                                       .particles = particles,
                                                       .spans = spans};
