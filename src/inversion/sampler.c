// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/sampler_source.h"

#include "base/statistics.h"

#include <math.h>
#include <string.h>

const char *const mf_sampler_kinds[] = {"monte-carlo", "dynamics", "auto", NULL};

static const struct sampler_source *const sources[] = {
    [SAMPLER_MONTE_CARLO] = &mf_sampler_moves, [SAMPLER_DYNAMICS] = &mf_sampler_trajectories};

size_t mf_sampler_bins(const struct sampler_system *system) {
    size_t bins = (size_t)mf_composition_pairs(system->composition) * system->bins;
    for (size_t k = 0; k < system->groups; k++)
        bins += system->group[k].bins.count;
    return bins;
}

size_t mf_sampler_numbers(const struct sampler_system *system) {
    size_t stresses = 0;
    for (size_t k = 0; k < system->groups; k++)
        stresses += system->group[k].density ? system->group[k].bins.count : 0;
    return mf_sampler_bins(system) + SAMPLER_SUMS + system->integrals + stresses;
}

/// The waves whose integrals are asked for.
static enum status begin_waves(struct sampler *sampler, const struct sampler_system *system) {
    if (system->integrals == 0)
        return STATUS_OK;
    sampler->waves = true;
    const enum status status = mf_kirkwood_buff_waves_init(
        &sampler->kirkwood_buff, system->box, system->composition,
        (size_t)mf_composition_particles(system->composition),
        system->molecules ? &system->molecules->topology : NULL, system->q_maximum);
    return status == STATUS_BAD_INPUT ? mf_status_prefix(status, "target.kirkwood_buff") : status;
}

static enum status begin_densities(struct sampler *sampler, const struct sampler_system *system,
                                   const struct weighted_density_settings *settings) {
    TRY_ARRAY(sampler->densities, 1);
    return mf_weighted_density_list_init(sampler->densities, settings, system->box,
                                         (size_t)mf_composition_particles(system->composition));
}

enum status mf_sampler_init(struct sampler *sampler, enum sampler_kind kind,
                            const struct sampler_system *system) {
    enum status status = STATUS_OK;
    if (kind == SAMPLER_AUTO)
        kind = system->molecules || system->many_body ? SAMPLER_DYNAMICS : SAMPLER_MONTE_CARLO;
    *sampler =
        (struct sampler){.source = system->engine ? &mf_sampler_engine : sources[kind],
                         .molecules = system->molecules,
                         .composition = *system->composition,
                         .volume = mf_box_volume(system->box),
                         .bins = {.low = system->low,
                                  .width = system->width,
                                  .bins = system->bins,
                                  .pairs = (size_t)mf_composition_pairs(system->composition)},
                         .group = system->group,
                         .groups = system->groups,
                         .integrals = system->integrals};
    CHECK(begin_waves(sampler, system));
    for (size_t k = 0; k < system->groups; k++)
        if (system->group[k].density)
            CHECK(begin_densities(sampler, system, system->group[k].density));
    if (system->molecules)
        CHECK(mf_whole_molecules_init(&sampler->whole, &system->molecules->topology));
    sampler->own = mf_memory_zeroed(1, sampler->source->size);
    CHECK(sampler->own ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(sampler->source->init(sampler->own, system, &sampler->bins));
done:
    if (status != STATUS_OK)
        mf_sampler_clear(sampler);
    return status;
}

void mf_sampler_clear(struct sampler *sampler) {
    if (sampler->own)
        sampler->source->clear(sampler->own);
    mf_memory_free(sampler->own);
    mf_kirkwood_buff_waves_clear(&sampler->kirkwood_buff);
    mf_whole_molecules_clear(&sampler->whole);
    if (sampler->densities)
        mf_weighted_density_list_clear(sampler->densities);
    mf_memory_free(sampler->densities);
    *sampler = (struct sampler){0};
}

enum status mf_sampler_scatter(struct sampler *sampler) {
    return sampler->source->scatter(sampler->own);
}

enum status mf_sampler_begin(struct sampler *sampler) {
    return sampler->source->begin(sampler->own);
}

enum status mf_sampler_equilibrate(struct sampler *sampler, uint64_t sweeps) {
    return sampler->source->equilibrate(sampler->own, sweeps);
}

enum status mf_sampler_announce(struct sampler *sampler, bool scatter, uint64_t lead,
                                uint64_t samples, uint64_t every) {
    return sampler->source->announce
               ? sampler->source->announce(sampler->own, scatter, lead, samples, every)
               : STATUS_OK;
}

double mf_sampler_acceptance(const struct sampler *sampler) {
    return sampler->source->acceptance(sampler->own);
}

const struct particles *mf_sampler_particles(const struct sampler *sampler) {
    return sampler->source->particles(sampler->own);
}

/// Beads in each bin of their densities, or the sums of what they have there.
/// @param[in] of  by id; NULL: 1
static void count_densities(const struct density_list *densities, const struct bonded_bins *bins,
                            const double *of, double *sums) {
    for (size_t id = 0; id < densities->particles.count; id++) {
        const double place = (densities->values[id] - bins->low) / bins->width;
        if (place >= 0 && place < (double)bins->count)
            sums[(size_t)place] += of ? of[id] : 1;
    }
}

/// S of the groups in the present configuration, from `sample` on; returns their end.
static double *count_groups(const struct sampler *sampler, double *sample) {
    const struct particles *particles = mf_sampler_particles(sampler);
    for (size_t k = 0; k < sampler->groups; k++) {
        const struct sampler_group *group = &sampler->group[k];
        memset(sample, 0, group->bins.count * sizeof *sample);
        if (group->density)
            count_densities(sampler->densities, &group->bins, NULL, sample);
        else
            mf_bonded_distribution_count(sampler->molecules, group->order, group->group,
                                         &group->bins, particles, sample);
        sample += group->bins.count;
    }
    return sample;
}

/// The stresses of the groups that are local densities, from `sample` on.
static void sum_stresses(const struct sampler *sampler, double *sample) {
    for (size_t k = 0; k < sampler->groups; k++) {
        const struct sampler_group *group = &sampler->group[k];
        if (group->density == NULL)
            continue;
        memset(sample, 0, group->bins.count * sizeof *sample);
        count_densities(sampler->densities, &group->bins, sampler->densities->stresses, sample);
        sample += group->bins.count;
    }
}

/// Add R_g² and R_e² of a molecule that was made whole.
static void add_size(const struct whole_molecules *whole, const struct topology_kind *kind,
                     double *sums) {
    const double(*place)[3] = (const double(*)[3])whole->place;
    for (int d = 0; d < 3; d++) {
        struct running_mean mean = {0};
        for (int bead = 0; bead < kind->beads; bead++)
            mf_statistics_add(&mean, place[bead][d]);
        sums[SAMPLER_GYRATION] += mean.squares / mean.count;
        sums[SAMPLER_ENDS] += pow(place[kind->end[1]][d] - place[kind->end[0]][d], 2);
    }
}

/// Sizes of all molecules.
static void sum_sizes(struct sampler *sampler, double *sums) {
    sums[SAMPLER_GYRATION] = sums[SAMPLER_ENDS] = 0;
    if (sampler->molecules == NULL)
        return;
    const struct topology *topology = &sampler->molecules->topology;
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++) {
            mf_whole_molecules_make(&sampler->whole, mf_sampler_particles(sampler), k, m);
            add_size(&sampler->whole, &topology->kind[k], sums);
        }
}

/// The longest wave of the density of each type along the longest edge, where replicas begin apart:
/// nothing of a mixture is slower.
static double sum_waves(const struct particles *particles, const struct composition *composition) {
    const int axis = mf_placement_slab_axis(&particles->box);
    const double wave = 2 * M_PI / particles->box.length[axis];
    double rho[COMPOSITION_MAX_TYPES][2] = {{0}}, sum = 0;
    for (size_t k = 0; k < particles->count; k++) {
        const double angle = wave * particles->position[axis][k];
        double *own = rho[mf_composition_type(composition, particles->id[k])];
        own[0] += cos(angle);
        own[1] += sin(angle);
    }
    for (int type = 0; type < composition->types; type++)
        if (composition->count[type] > 0)
            sum += (pow(rho[type][0], 2) + pow(rho[type][1], 2)) / (double)composition->count[type];
    return sum;
}

enum status mf_sampler_sample(struct sampler *sampler, uint64_t sweeps, double *sample) {
    const size_t bins = pair_histogram_size(&sampler->bins) - 1;
    struct sampler_pairs pairs = {0};
    TRY(sampler->source->run(sampler->own, sweeps, &pairs));
    const double weight = mf_box_volume(&mf_sampler_particles(sampler)->box) / sampler->volume;
    for (size_t a = 0; a < bins; a++)
        sample[a] = pairs.counts[a] * weight;
    if (sampler->densities)
        TRY(mf_weighted_density_list_find(sampler->densities, mf_sampler_particles(sampler)));
    double *sum = count_groups(sampler, sample + bins);
    sum[SAMPLER_VIRIAL] = pairs.sums.virial;
    sum[SAMPLER_ENERGY] = pairs.sums.energy;
    sum[SAMPLER_DENSITY] = 1 / weight;
    sum_sizes(sampler, sum);
    sum[SAMPLER_WAVES] = composition_is_mixed(&sampler->composition)
                             ? sum_waves(mf_sampler_particles(sampler), &sampler->composition)
                             : 0;
    if (sampler->waves)
        mf_kirkwood_buff_waves_take(&sampler->kirkwood_buff, mf_sampler_particles(sampler), 1,
                                    sum + SAMPLER_SUMS);
    sum_stresses(sampler, sum + SAMPLER_SUMS + sampler->integrals);
    return STATUS_OK;
}

/// Of a molecule that was made whole; returns how many are nearer than the first bin.
static double count_excluded_of(const struct sampler *sampler,
                                const struct composition *composition,
                                const struct topology_kind *kind, double *counts) {
    const struct pair_histogram *bins = &sampler->bins;
    const double(*place)[3] = (const double(*)[3])sampler->whole.place;
    double nearer = 0;
    for (int bead = 0; bead < kind->beads; bead++)
        for (int n = kind->near_start[bead]; n < kind->near_start[bead + 1]; n++) {
            const int other = kind->near[n];
            double square = 0;
            for (int d = 0; d < 3; d++)
                square += pow(place[other][d] - place[bead][d], 2);
            const double bin = floor((sqrt(square) - bins->low) / bins->width);
            const int pair = mf_composition_pair(composition, kind->type[bead], kind->type[other]);
            nearer += bead < other && bin < 0;
            if (bead < other && bin >= 0 && bin < (double)bins->bins)
                counts[(size_t)pair * bins->bins + (size_t)bin]++;
        }
    return nearer;
}

double mf_sampler_count_excluded(struct sampler *sampler, const struct composition *composition,
                                 double *counts) {
    const struct topology *topology = &sampler->molecules->topology;
    double nearer = 0;
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++) {
            mf_whole_molecules_make(&sampler->whole, mf_sampler_particles(sampler), k, m);
            nearer += count_excluded_of(sampler, composition, &topology->kind[k], counts);
        }
    return nearer;
}

size_t mf_sampler_place_spans(struct particles *particles, struct memory_span *span) {
    size_t n = 0;
    for (int d = 0; d < particles->box.dimensions; d++)
        span[n++] = (struct memory_span){particles->position[d], particles->count * sizeof(double)};
    span[n++] = (struct memory_span){particles->id, particles->count * sizeof(uint32_t)};
    return n;
}

size_t mf_sampler_spans(struct sampler *sampler, struct memory_span *span) {
    return sampler->source->spans(sampler->own, span);
}
