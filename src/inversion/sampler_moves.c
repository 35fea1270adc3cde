// SPDX-License-Identifier: GPL-3.0-or-later
//
// Configurations by single moves, which are counted one at a time.
#include "dynamics/metropolis.h"
#include "inversion/sampler_source.h"

#include <string.h>

struct moves {
    struct metropolis chain;
    struct pair_histogram histogram; ///< of the chain's configuration
};

static void clear(void *own) {
    struct moves *moves = own;
    mf_metropolis_clear(&moves->chain);
    mf_memory_free(moves->histogram.counts);
}

static enum status init(void *own, const struct sampler_system *system,
                        const struct pair_histogram *bins) {
    struct moves *moves = own;
    struct metropolis *chain = &moves->chain;
    moves->histogram = *bins;
    moves->histogram.counts = NULL;
    TRY_ARRAY(moves->histogram.counts, pair_histogram_size(bins));
    TRY(mf_metropolis_init(chain, system->box, system->composition, system->potential,
                           system->temperature, system->seed));
    chain->cancel = system->cancel;
    chain->bias = system->bias;
    if (system->molecules == NULL)
        mf_metropolis_exchange(chain);
    if (system->molecules == NULL && system->bias.tilt != 0) {
        mf_placement_tilt(&chain->particles, system->bias.tilt, system->seed);
        TRY(mf_metropolis_refresh(chain));
    }
    return mf_metropolis_join(chain, system->molecules);
}

static enum status scatter(void *own) {
    return mf_metropolis_scatter(&((struct moves *)own)->chain);
}

static enum status begin(void *own) {
    return mf_metropolis_refresh(&((struct moves *)own)->chain);
}

static enum status equilibrate(void *own, uint64_t sweeps) {
    return mf_metropolis_equilibrate(&((struct moves *)own)->chain, (uint32_t)sweeps);
}

static enum status run(void *own, uint64_t sweeps, struct sampler_pairs *pairs) {
    struct moves *moves = own;
    TRY(mf_metropolis_run(&moves->chain, (uint32_t)sweeps));
    memset(moves->histogram.counts, 0, pair_histogram_size(&moves->histogram) * sizeof(uint32_t));
    pairs->counts = moves->histogram.counts;
    return mf_metropolis_count(&moves->chain, &moves->histogram, &pairs->sums);
}

static double acceptance(const void *own) {
    uint64_t accepted, tried;
    mf_metropolis_tally(&((const struct moves *)own)->chain, &accepted, &tried);
    return (double)accepted / (double)tried;
}

static const struct particles *particles(const void *own) {
    return &((const struct moves *)own)->chain.particles;
}

static size_t spans(void *own, struct memory_span *span) {
    struct metropolis *chain = &((struct moves *)own)->chain;
    size_t n = mf_sampler_place_spans(&chain->particles, span);
    span[n++] = (struct memory_span){&chain->step, sizeof chain->step};
    span[n++] = (struct memory_span){&chain->sweep, sizeof chain->sweep};
    span[n++] = (struct memory_span){&chain->exchanges, sizeof chain->exchanges};
    if (chain->molecules.molecules)
        span[n++] = (struct memory_span){chain->molecules.tally, sizeof chain->molecules.tally};
    return n;
}

const struct sampler_source mf_sampler_moves = {.size = sizeof(struct moves),
                                                .init = init,
                                                .clear = clear,
                                                .scatter = scatter,
                                                .begin = begin,
                                                .equilibrate = equilibrate,
                                                .run = run,
                                                .acceptance = acceptance,
                                                .particles = particles,
                                                .spans = spans};

const struct molecule_tally *mf_sampler_tally(const struct sampler *sampler) {
    if (sampler->source != &mf_sampler_moves || sampler->molecules == NULL)
        return NULL;
    return ((const struct moves *)sampler->own)->chain.molecules.tally;
}
