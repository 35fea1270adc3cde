// SPDX-License-Identifier: GPL-3.0-or-later
//
// Configurations by another program, piece by piece: whole runs that it makes of all samples of a
// plan. Pairs are counted by our own force pass, whose energies must be those of the program.
#include "base/statistics.h"
#include "dynamics/hybrid.h"
#include "dynamics/simulation_change.h"
#include "inversion/sampler_source.h"
#include "inversion/tilted_pairs.h"
#include "problem/sampling_engine.h"

#include <math.h>

/// Of an energy as the program has it, over ours, and of each bead [k_B T]: tables are read between
/// their rows within 1e-4 k_B T a pair.
static const double energy_share = 1e-3, energy_of_bead = 5e-3;

struct engine_source {
    struct hybrid hybrid; ///< of whatever configuration
    struct tilted_pairs tilted;
    const struct sampling_engine *engine;
    const struct table *potential;
    const struct molecules *molecules;
    double temperature;
    size_t replica;
    uint64_t seed, number;
    bool fresh;                       ///< nothing has been left to go on from
    struct engine_piece piece;        ///< that was announced last
    struct running_mean temperatures; ///< of the present piece
    void *frames;                     ///< of it
    double *position[3];              ///< of a frame, by id
};

static void clear(void *own) {
    struct engine_source *source = own;
    if (source->engine)
        source->engine->end(source->frames);
    for (int d = 0; d < 3; d++)
        mf_memory_free(source->position[d]);
    mf_hybrid_clear(&source->hybrid);
    mf_tilted_pairs_clear(&source->tilted);
}

static enum status init(void *own, const struct sampler_system *system,
                        const struct pair_histogram *bins) {
    struct engine_source *source = own;
    source->engine = system->engine;
    source->potential = system->potential;
    source->molecules = system->molecules;
    source->temperature = system->temperature;
    source->replica = system->replica;
    source->seed = system->seed;
    source->fresh = true;
    for (int d = 0; d < system->box->dimensions; d++)
        TRY_ARRAY(source->position[d], (size_t)mf_composition_particles(system->composition));
    return mf_hybrid_init(&source->hybrid, system->box, system->composition, system->potential,
                          system->molecules, system->many_body, bins, system->temperature,
                          system->seed, &system->bias);
}

/// The program begins again from where it began, and equilibrates, as it was told before.
static enum status scatter(void *own) {
    (void)own;
    return STATUS_OK;
}

static enum status begin(void *own) {
    (void)own;
    return STATUS_OK;
}

static enum status equilibrate(void *own, uint64_t sweeps) {
    (void)own, (void)sweeps;
    return STATUS_OK;
}

static enum status announce(void *own, bool scatter, uint64_t lead, uint64_t samples,
                            uint64_t every) {
    struct engine_source *source = own;
    source->number++; // of all replicas, whichever of them will come to begin
    source->engine->end(source->frames);
    source->frames = NULL;
    source->piece = (struct engine_piece){.replica = source->replica,
                                          .number = source->number,
                                          .fresh = scatter || source->fresh,
                                          .seed = source->seed,
                                          .temperature = source->temperature,
                                          .potential = source->potential,
                                          .molecules = source->molecules,
                                          .lead = lead,
                                          .frames = samples,
                                          .every = every};
    return source->engine->announce
               ? source->engine->announce(source->engine->context, &source->piece)
               : STATUS_OK;
}

/// Ask for all samples that were announced, at once.
static enum status open_frames(struct engine_source *source) {
    if (source->frames)
        return STATUS_OK;
    const enum status status =
        source->engine->begin(source->engine->context, &source->piece, &source->frames);
    source->fresh = status != STATUS_OK; // from what it has not left nothing goes on
    source->temperatures = (struct running_mean){0};
    return status;
}

static void place(struct engine_source *source) {
    struct particles *particles = &source->hybrid.simulation.particles;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->position[d][k] = source->position[d][particles->id[k]];
}

static enum status count(struct engine_source *source, const struct box *box,
                         struct sampler_pairs *pairs) {
    struct hybrid *hybrid = &source->hybrid;
    TRY(mf_simulation_set_box(&hybrid->simulation, box));
    TRY(mf_hybrid_refresh(hybrid));
    *pairs = (struct sampler_pairs){hybrid->counts, hybrid->sums};
    return STATUS_OK;
}

/// Particles are then known by their parts of the box's vectors.
static enum status count_tilted(struct engine_source *source, const struct engine_sample *sample,
                                struct sampler_pairs *pairs) {
    struct particles *particles = &source->hybrid.simulation.particles;
    const struct composition *composition = &source->hybrid.simulation.setup.composition;
    particles->box = sample->box;
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < particles->count; k++)
            source->position[d][k] /= sample->box.length[d];
    TRY(mf_tilted_pairs_count(&source->tilted, &sample->vectors, source->position, composition,
                              source->potential, &source->hybrid.trial, &pairs->sums));
    pairs->counts = source->tilted.counts;
    return STATUS_OK;
}

/// Whether the program has the potential that it was given.
static enum status check_energy(const struct engine_source *source, double energy, double own) {
    const double beads = (double)source->hybrid.simulation.particles.count;
    const double off = fabs(energy - own);
    if (!isfinite(energy) || (source->molecules && !source->engine->whole_energy) ||
        !(off > energy_share * fabs(own) + energy_of_bead * beads * source->temperature))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "of the same configuration the engine has the energy %.6g" STATUS_ENERGY
        " a bead where the potential that it was given makes %.6g" STATUS_ENERGY
        ": look for other units, pairs that are excluded on one side, types in another order, "
        "a shift, or an include that is missing",
        energy / beads, own / beads);
}

/// Whether it samples at the temperature that it was given, once enough is known of it: a kinetic
/// temperature scatters by sqrt(2/(d N)), and ten frames in a row count as one.
static enum status check_temperature(struct engine_source *source, double temperature) {
    static const double allowed = 0.05, errors = 5;
    enum { MEMORY = 10, LEAST = 30 };
    struct running_mean *mean = &source->temperatures;
    const struct particles *particles = &source->hybrid.simulation.particles;
    if (!isfinite(temperature))
        return STATUS_OK;
    mf_statistics_add(mean, temperature);
    const double off = mean->mean / source->temperature - 1;
    const double degrees = (double)particles->box.dimensions * (double)particles->count;
    const double error = sqrt(2 / degrees * MEMORY / mean->count);
    if (mean->count < LEAST || !(fabs(off) > allowed + errors * error))
        return STATUS_OK;
    return mf_status_fail(STATUS_UNSTABLE,
                          "the engine samples at a temperature that is %.0f %% too %s: look for a "
                          "time step that is too long for this potential, and for its thermostat",
                          100 * fabs(off), off > 0 ? "high" : "low");
}

static enum status run(void *own, uint64_t sweeps, struct sampler_pairs *pairs) {
    struct engine_source *source = own;
    struct hybrid *hybrid = &source->hybrid;
    struct engine_sample sample;
    (void)sweeps; // as they were announced
    TRY(open_frames(source));
    TRY(source->engine->next(source->frames, source->position, &sample));
    place(source);
    TRY(sample.tilted ? count_tilted(source, &sample, pairs) : count(source, &sample.box, pairs));
    TRY(check_energy(source, sample.energy, pairs->sums.energy));
    TRY(check_temperature(source, sample.temperature));
    if (!source->engine->whole_energy && !isfinite(sample.pressure))
        pairs->sums.virial = 0; // that of the known forces is missing
    if (isfinite(sample.pressure)) {
        const struct box *box = &hybrid->simulation.setup.box; // where pressures are found by it
        const double ideal = (double)hybrid->simulation.particles.count * source->temperature;
        pairs->sums.virial = box->dimensions * (sample.pressure * mf_box_volume(box) - ideal);
    }
    return STATUS_OK;
}

static double acceptance(const void *own) {
    (void)own;
    return NAN;
}

static const struct particles *particles(const void *own) {
    return &((const struct engine_source *)own)->hybrid.simulation.particles;
}

static size_t spans(void *own, struct memory_span *span) {
    struct engine_source *source = own;
    size_t n = mf_sampler_place_spans(&source->hybrid.simulation.particles, span);
    span[n++] = (struct memory_span){&source->number, sizeof source->number};
    span[n++] = (struct memory_span){&source->fresh, sizeof source->fresh};
    return n;
}

const struct sampler_source mf_sampler_engine = {.size = sizeof(struct engine_source),
                                                 .init = init,
                                                 .clear = clear,
                                                 .scatter = scatter,
                                                 .begin = begin,
                                                 .equilibrate = equilibrate,
                                                 .announce = announce,
                                                 .run = run,
                                                 .acceptance = acceptance,
                                                 .particles = particles,
                                                 .spans = spans};
