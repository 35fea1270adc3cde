// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The density's waves in a periodic box of any shape, of one configuration.
///
///   ρ_a(q) = Σ_j exp(−i q·r_j) over beads j of type a,   q = Σ_i n_i b_i ≠ 0,
///
/// b_i being 2π times the reciprocal vectors of the box, so that q·r = Σ_i n_i φ_i with
/// φ_i = b_i·r the angle of a place along the box's vector i. Of q and −q, which tell the same, one
/// is taken. Each wave counts for the bin of |q|:
///   S(q) = |Σ_a ρ_a(q)|²/N,   S_ab(q) = Re ρ_a(q) ρ_b(−q)/sqrt(N_a N_b)
/// (N. W. Ashcroft and D. C. Langreth, Phys. Rev. 156, 685 (1967)).
#pragma once

#include "base/status.h"
#include "system/box_vectors.h"
#include "system/composition.h"

#include <stdbool.h>
#include <stddef.h>

struct density_waves_plan {
    struct composition composition; ///< beads stand in the order of their types
    double q_maximum;               ///< [1/length]
    size_t bins;                    ///< of |q|, from 0 on
    size_t max; ///< waves of a bin: of more, as many that are evenly spread; 0: all are taken
};

struct density_waves {
    struct density_waves_plan plan;
    size_t count, curves;     ///< of beads; S, and in a mixture those of all pair types
    double lattice[3][3];     ///< b_i, one a row, of the box that the waves are listed for
    int largest[3];           ///< |n| along each vector
    size_t vectors, capacity; ///< waves, and how many there could be
    struct density_wave {
        int n[3];
        size_t bin;
    } * wave;                 ///< shape [vectors]
    double *q, *members;      ///< shape [bins]: Σ |q| of a bin's waves, and their number
    double *phase[3];         ///< shape [largest + 1, 2, beads of a stretch]: cos and sin of n φ
    size_t phase_capacity[3]; ///< waves along each vector that there is room for
    double *amplitude;        ///< shape [vectors, types, 2]: ρ
};

/// Waves that are measured at most, and how many of their lengths an edge of the box may have.
enum { DENSITY_WAVES_MAX = 1000000, DENSITY_WAVES_LONGEST = 10000 };

/// Fails: NO_MEMORY. What has failed is cleared.
enum status mf_density_waves_init(struct density_waves *waves,
                                  const struct density_waves_plan *plan) MUST_USE;

void mf_density_waves_clear(struct density_waves *waves);

/// How many waves are looked at, about, of a box with vectors of these lengths, 0 for those that no
/// wave has: more than there are, since they fill a ball in it.
double mf_density_waves_expected(double q_maximum, const double length[3]);

/// List the waves of a box, unless it is that of the last call. Along a vector without a reciprocal
/// one there are none.
/// Fails: BAD_INPUT, without a place, for more than DENSITY_WAVES_MAX that are taken, or for none;
/// NO_MEMORY.
/// Tested: test_density_waves, test_structure_factor.
enum status mf_density_waves_list(struct density_waves *waves,
                                  const struct box_vectors *box) MUST_USE;

/// Where beads are, in the order of types: their angles φ along the box's vectors are unit · place.
struct density_places {
    const double *place[3]; ///< shape [count]
    double unit[3];         ///< 0: there is no such vector
};

/// Find ρ of all waves. The same bits for any number of threads. Tested: test_density_waves,
/// test_structure_factor.
void mf_density_waves_find(struct density_waves *waves, const struct density_places *places,
                           int threads);

/// Add S of all waves to those of their bins. @param[in,out] sums  shape [curves, bins]
void mf_density_waves_add(const struct density_waves *waves, double *sums);
