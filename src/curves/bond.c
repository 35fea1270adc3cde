// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_batch.h"
#include "curves/bonded_table.h"

#include <math.h>

/// glibc has a log of vectors (libmvec) since 2.22, at most 4 units of the last place off.
#if SIMD_X86 && defined(__GLIBC__)
__attribute__((simd("notinbranch"))) extern double log(double x);
#endif

#define POSITIVE .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX
#define AT_LEAST_ZERO .minimum = 0, .maximum = DBL_MAX

// Harmonic ----------------------------------------------------------------------------------------

struct harmonic {
    double k, length;
};

SIMD_CLONES static void harmonic_evaluate(const void *parameters, size_t count, const double *r,
                                          double *energy, double *slope) {
    const struct harmonic p = *(const struct harmonic *)parameters;
    for (size_t n = 0; n < count; n++) {
        const double stretch = r[n] - p.length;
        energy[n] = 0.5 * p.k * stretch * stretch;
        slope[n] = p.k * stretch;
    }
}

static double harmonic_rest(const void *parameters) {
    return ((const struct harmonic *)parameters)->length;
}

#define HARMONIC(member) .offset = offsetof(struct harmonic, member)
static const struct field harmonic_fields[] = {
    {"k", FIELD_NUMBER, HARMONIC(k), .required = true, AT_LEAST_ZERO, .unit = "k_B T_0/lambda^2",
     .help = "k of GROMACS; the K of LAMMPS is k/2"},
    {"length", FIELD_NUMBER, HARMONIC(length), .required = true, AT_LEAST_ZERO, .unit = "lambda",
     .help = "equilibrium length"},
    FIELD_END,
};

const struct bonded_law mf_bond_harmonic = {
    .name = "harmonic",
    .summary = "U = k (r - length)^2/2",
    .fields = harmonic_fields,
    .size = sizeof(struct harmonic),
    .evaluate = harmonic_evaluate,
    .rest = harmonic_rest,
};

// FENE --------------------------------------------------------------------------------------------

struct fene {
    double k, longest;
};

/// 1 − (r/R)² from which on U is a straight line, so that it is finite for all r, and so steep that
/// a ring that was placed open is closed (mf_relax_overlaps). No bond gets there later.
static const double straight = 1e-4;

SIMD_CLONES static void fene_slopes(const void *parameters, size_t count, const double *r,
                                    double *slope) {
    const struct fene p = *(const struct fene *)parameters;
    const double last = p.longest * sqrt(1 - straight), inverse = 1 / p.longest;
    for (size_t n = 0; n < count; n++) {
        const double x = r[n] < last ? r[n] : last, share = x * inverse;
        slope[n] = p.k * x / (1 - share * share);
    }
}

SIMD_CLONES static void fene_evaluate(const void *parameters, size_t count, const double *r,
                                      double *energy, double *slope) {
    const struct fene p = *(const struct fene *)parameters;
    const double last = p.longest * sqrt(1 - straight);
    fene_slopes(parameters, count, r, slope);
    for (size_t n = 0; n < count; n++) {
        const double x = r[n] < last ? r[n] : last, share = x / p.longest;
        energy[n] =
            -0.5 * p.k * p.longest * p.longest * log(1 - share * share) + slope[n] * (r[n] - x);
    }
}

/// Where the repulsion of beads of size 1 and R = 1.5 leaves bonds at k = 30: Kremer and Grest's
/// 0.97.
static double fene_rest(const void *parameters) {
    static const double share = 0.97 / 1.5;
    return share * ((const struct fene *)parameters)->longest;
}

static double fene_longest(const void *parameters) {
    return ((const struct fene *)parameters)->longest;
}

#define FENE(member) .offset = offsetof(struct fene, member)
static const struct field fene_fields[] = {
    {"k", FIELD_NUMBER, FENE(k), .initial = 30, AT_LEAST_ZERO, .unit = "k_B T_0/lambda^2",
     .help = "k, the curvature at r = 0"},
    {"longest", FIELD_NUMBER, FENE(longest), .initial = 1.5, POSITIVE, .unit = "lambda",
     .help = "R; a longer bond ends the simulation as unstable"},
    FIELD_END,
};

const struct bonded_law mf_bond_fene = {
    .name = "fene",
    .summary = "U = -k R^2 ln(1 - (r/R)^2)/2, to which the pair's own repulsion belongs "
               "(\"exclude\": 0); K. Kremer and G. S. Grest, J. Chem. Phys. 92, 5057 (1990)",
    .fields = fene_fields,
    .size = sizeof(struct fene),
    .evaluate = fene_evaluate,
    .slopes = fene_slopes,
    .rest = fene_rest,
    .longest = fene_longest,
};

BONDED_TABLE(mf_bond_table, "columns r, U",
             "cubic spline through the points of a file, straight lines beyond its ends");

// Geometry ----------------------------------------------------------------------------------------

SIMD_CLONES static void measure(struct bonded_batch *batch) {
    const double *x = batch->arm[0][0], *y = batch->arm[0][1], *z = batch->arm[0][2];
    for (int n = 0; n < batch->count; n++)
        batch->q[n] = sqrt(x[n] * x[n] + y[n] * y[n] + z[n] * z[n]);
}

SIMD_CLONES static void push(struct bonded_batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        const double pull = batch->q[n] > 0 ? -batch->slope[n] / batch->q[n] : 0;
        for (int d = 0; d < 3; d++)
            batch->arm[0][d][n] *= pull;
    }
}

/// Of r^(d−1).
static double jacobian(int dimensions, double low, double width) {
    const double from = fmax(0, low), to = low + width;
    return dimensions == 3 ? (pow(to, 3) - pow(from, 3)) / 3 : (to * to - from * from) / 2;
}

static const struct bonded_law *const laws[] = {&mf_bond_harmonic, &mf_bond_fene, &mf_bond_table,
                                                NULL};

const struct bonded_kind mf_bond = {
    .name = "bond",
    .plural = "bonds",
    .article = "a",
    .beads = 2,
    .reach = 1,
    .chain = {0, 1},
    .arms = 1,
    .arm = {{0, 1}},
    .measure = measure,
    .push = push,
    .jacobian = jacobian,
    BONDED_LENGTHS,
    .high = INFINITY,
    .laws = laws,
    .table = &mf_bond_table,
    .narrow = 0.01,
    .fine = 10000,
    .cost = 15,
    .common = true,
};
