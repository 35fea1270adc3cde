// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Radial distribution function with standard errors.
///
///   g(r_k) = (2 V / (N (N − 1))) ⟨S_k⟩ / v_k
/// with S_k the pairs in bin k and v_k the exact volume of its shell (area of its ring in 2D). A
/// mixture has a partial g for each pair type,
///   g_ab(r_k) = (V / (N_a N_b)) ⟨S_ab,k⟩ / v_k for a ≠ b, and as above with N_a for a = b.
/// Arrays over kinds and bins have shape [pairs, bins], the kinds in the order of
/// mf_composition_pair.
#pragma once

#include "base/memory.h"
#include "base/statistics.h"
#include "forces/pair.h"
#include "observe/configuration.h"
#include "observe/sample_blocks.h"

#include <stddef.h>

/// Equal bins from `low` on.
struct rdf_bins {
    double low, width; ///< [λ]
    size_t count;
};

double mf_rdf_bins_edge(const struct rdf_bins *bins, size_t k);   ///< lower edge of bin k [λ]
double mf_rdf_bins_centre(const struct rdf_bins *bins, size_t k); ///< [λ]
double mf_rdf_bins_range(const struct rdf_bins *bins); ///< upper edge of the last bin [λ]

/// Expected S_k if g were 1 [pairs]: N (N − 1) v_k / (2 V).
double mf_rdf_ideal_pairs(const struct rdf_bins *bins, size_t k, const struct box *box,
                          size_t count);

/// The same of one pair type: N_a N_b v_k / V if they are unlike.
double mf_rdf_ideal_pairs_of(const struct rdf_bins *bins, size_t k, const struct box *box,
                             const struct composition *composition, int pair);

/// Add the pairs of one configuration to `histogram`, shape [pairs, bins], uncleared. The list must
/// be a half list complete for the range of the bins.
void mf_rdf_count_pairs(const struct rdf_bins *bins, const struct composition *composition,
                        const struct particles *particles, const struct neighbours *neighbours,
                        double *histogram);

/// Accumulates configurations into consecutive blocks.
struct rdf {
    struct rdf_bins bins;
    struct box box;
    size_t particle_count;
    struct composition composition;        ///< of what is distinguished
    size_t pairs;                          ///< pair types
    struct sample_blocks blocks;           ///< of histograms, shape [pairs, bins.count]
    double weight;                         ///< of the pairs of the next sample: V/V_box
    bool needs_own_list;                   ///< the range exceeds that of the simulation's list
    const struct topology *intermolecular; ///< count pairs of different molecules alone; NULL: all
    struct pair_histogram counted;         ///< by the force pass
    struct particles own_particles;
    struct neighbours manifest;
};

/// Prepare for `planned` samples of a system of particles, whatever their types, whose list is
/// complete up to `list_cutoff`. Fails: NO_MEMORY; BAD_INPUT if the box is shorter than twice the
/// range of the bins.
enum status mf_rdf_init(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                        size_t particle_count, double list_cutoff, size_t planned) MUST_USE;

/// The same for the partial g of a mixture, which counts its types.
enum status mf_rdf_init_mixture(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                                const struct composition *composition, double list_cutoff,
                                size_t planned) MUST_USE;

/// The same for as many configurations as there will be, whose source counts pairs.
enum status mf_rdf_init_endless(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                                const struct composition *composition) MUST_USE;
void mf_rdf_clear(struct rdf *rdf);

/// Add a configuration by what its source has counted. Pairs have the weight V/V_box, so that g is
/// that of ⟨V S⟩, and where some are left out that of all over those that were looked at.
void mf_rdf_add(struct rdf *rdf, const struct configuration *configuration);

/// The volume of the next sample of a simulation whose box changes; else it is that of `box`.
void mf_rdf_set_volume(struct rdf *rdf, double volume);

/// What a force pass is to count for the next sample, cleared: for pair_law.histogram. NULL if the
/// range exceeds that of the forces; then mf_rdf_sample makes a list of its own.
const struct pair_histogram *mf_rdf_histogram(struct rdf *rdf);

/// Add the configuration that a force pass has counted.
void mf_rdf_sample_counted(struct rdf *rdf);

/// Add the present configuration. Fails: NO_MEMORY.
enum status mf_rdf_sample(struct rdf *rdf, const struct particles *particles,
                          const struct neighbours *neighbours) MUST_USE;

/// g and its standard error over the blocks of all replicas, whose correlation the bins of a kind
/// of pairs tell together but for slower ones (mf_statistics_correlated_errors): of close samples
/// even the means of blocks are correlated.
/// @param[in]  replicas  shape [count], same bins, box and composition
/// @param[out] g, error  shape [pairs, bins.count]; error may be NULL
/// Fails: NO_MEMORY, with an error asked for. Tested: test_rdf, test_errors.
enum status mf_rdf_result(const struct rdf *replicas, size_t count, double *g,
                          double *error) MUST_USE;

/// Root mean square of g − g* over all bins of all pair types, with its standard error by
/// leaving out blocks (jackknife), whose correlation is that of the bins; `error` may be NULL.
/// Fails: NO_MEMORY.
enum status mf_rdf_distance(const struct rdf *replicas, size_t count, const double *target,
                            double *rmse, double *error) MUST_USE;

/// How many independent ones `bins` bins from `first` on, of one pair type, count as, by the
/// scatter of the blocks. Fails: NO_MEMORY.
enum status mf_rdf_independence(const struct rdf *replicas, size_t count, size_t first, size_t bins,
                                struct statistics_independence *found) MUST_USE;

/// sqrt(mean of (g − g*)²) over `count` bins.
double mf_rdf_rmse(const double *g, const double *target, size_t count);
