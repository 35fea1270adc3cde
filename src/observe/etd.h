// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long pairs stay together: the escape time distribution.
///
///   E(t, r_0) = of the pairs that at a time origin are r_0 apart, r_minimum ≤ r_0 < r_maximum, the
///   fraction that at no sampled time up to t after it has been at r ≥ r_maximum.
///
/// Absorbing: a pair that was out and came back counts as out. E(0, r_0) = 1, and E falls with t.
/// It is the survival probability of the pair, as the residence times of R. W. Impey, P. A. Madden
/// and I. R. McDonald, J. Phys. Chem. 87, 5071 (1983) without their tolerance of short absences,
/// and resolved by r_0. The sampling interval is part of the definition: what happens between two
/// samples goes unseen, so compare E of the same interval only (for SPC water, E of samples 0.02 ps
/// apart lies 0.001 to 0.005 above that of 0.002 ps). Images: the nearest.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "observe/configuration.h"
#include "system/cell_pairs.h"

/// Equal bins of r_0 from r_minimum to r_maximum [λ]; `times` counts t = 0.
struct etd_grid {
    double r_minimum, r_maximum;
    int64_t bins, times;
};

struct etd_plan {
    int64_t every;        ///< steps between times
    int64_t origin_every; ///< times between origins
};

struct etd_settings {
    struct etd_grid grid;
    struct etd_plan plan;
};

extern const struct field mf_etd_fields[]; ///< of etd_settings

/// Blocks of consecutive origins, for the errors; of fewer origins, each is a block.
enum { ETD_BLOCKS = 10 };

/// A pair is followed from the first origin that finds it within r_maximum until it escapes, by one
/// record for all origins: one distance for each pair and sample, however many windows overlap.
/// Everything is counted in integers.
struct etd {
    struct etd_grid grid;
    struct etd_plan plan;
    int64_t begin;          ///< step of the first sample
    size_t origins, blocks; ///< origins whose windows fit into the run
    size_t each;            ///< origins of a block if nothing is planned, else 0
    size_t count;           ///< of particles, likewise
    double edge[3][3];      ///< vectors of the box, lower triangular [λ]
    size_t slots;           ///< windows that are open at the same time
    struct {
        uint64_t samples, followed;
    } state;         ///< samples so far, records (those of escaped pairs until the next origin)
    size_t capacity; ///< for records
    uint32_t *first, *second; ///< shape [room]: ids, the lower first; equal: the pair has escaped
    uint16_t *bin;            ///< shape [room, slots]: of r_0 at each open origin, or none
    uint64_t *began;          ///< shape [slots]: samples before the origin
    uint32_t *open;   ///< shape [slots, times, bins]: pairs at time 0, then those escaped at a time
    uint64_t *counts; ///< shape [blocks, times, bins]: the same of all complete windows
    int32_t *place[3];       ///< shape [particles]: box_fraction by id
    uint32_t *bucket, *next; ///< shapes [buckets], [room]: records by the hash of their pair
    size_t buckets;
    struct cell_pairs search;
};

/// Cells of a matrix of times and bins.
static inline size_t etd_cells(const struct etd *etd) {
    return (size_t)(etd->grid.times * etd->grid.bins);
}

/// Prepare to sample a simulation from step `begin` on, for `steps` steps; only windows that end
/// within them are begun.
/// Fails: BAD_INPUT if there is no whole window, r_maximum is not above r_minimum, or the box is
/// below 2 r_maximum; NO_MEMORY.
enum status mf_etd_init(struct etd *etd, const struct etd_grid *grid, const struct etd_plan *plan,
                        const struct simulation *simulation, int64_t begin, int64_t steps) MUST_USE;

/// Prepare for the frames of a trajectory, as many as there will be, of `count` beads. Blocks have
/// equal numbers of origins, and are joined two by two when there are 20. Fails: NO_MEMORY.
enum status mf_etd_init_endless(struct etd *etd, const struct etd_grid *grid, int64_t origin_every,
                                size_t count) MUST_USE;
void mf_etd_clear(struct etd *etd);

/// Origins whose windows are complete.
size_t mf_etd_complete(const struct etd *etd);

/// Pairs that began at those origins: without any there is no E.
uint64_t mf_etd_pairs(const struct etd *etd);

/// The step of the next sample, or INT64_MAX after the last.
int64_t mf_etd_due(const struct etd *etd);

/// Add a configuration: of a simulation that of step mf_etd_due.
///
/// Linear in the pairs within r_maximum, and at an origin in those around. The same counts for any
/// number of threads or order of particles: distances are in double precision of 32-bit fractions
/// of the box (2e-9 λ). Fails: NO_MEMORY. Tested: test_etd, test_etd_brute_force, test_measured.
enum status mf_etd_sample(struct etd *etd, const struct configuration *configuration) MUST_USE;

/// Whether sample number `sample`, from 0, is an origin.
bool mf_etd_opens(const struct etd *etd, uint64_t sample);

/// E and its standard error from the complete windows of independent replicas with the same grid.
///
/// E = 1 − escaped/begun, sums over all origins. Errors: jackknife that leaves out one block of
/// consecutive origins, of all replicas' blocks, so that it knows of the correlation between pairs
/// and between windows that overlap (blocks should be longer than a window);
///   error² = (B − 1)/B Σ_b (E_(b) − mean E_(b))²
/// over the B blocks with a pair in the bin (B. Efron and C. Stein, Ann. Stat. 9, 586 (1981)).
/// Fewer than 3, or blocks that do not differ, tell nothing: then sqrt(E (1 − E)/n), as if the n
/// pairs were independent, and 1/(n + 1) if all or none of them survive, the end of the interval
/// of E. B. Wilson, J. Am. Stat. Assoc. 22, 209 (1927). The error of E(0), 1 by definition, is 0.
/// @param[in]  replicas         shape [count]
/// @param[out] survival, error  shape [times, bins]; NaN where no pair began; error may be NULL
/// @param[out] pairs            shape [bins]: begun, sum over origins; may be NULL
/// Fails: NO_MEMORY. Tested: test_etd, test_etd_brute_force.
enum status mf_etd_result(const struct etd *const *replicas, size_t count, double *survival,
                          double *error, uint64_t *pairs) MUST_USE;

/// What goes with a checkpoint. The first span is `state`: read it before the others and call
/// mf_etd_reserve, since their lengths depend on it.
size_t mf_etd_spans(struct etd *etd, struct memory_span *spans);

/// Room for state.followed records. Fails: NO_MEMORY.
enum status mf_etd_reserve(struct etd *etd) MUST_USE;
