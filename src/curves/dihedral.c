// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_batch.h"
#include "curves/bonded_table.h"

#include <math.h>

#define ANY_NUMBER .minimum = -DBL_MAX, .maximum = DBL_MAX

static double trans_rest(const void *parameters) {
    (void)parameters;
    return M_PI;
}

// Ryckaert and Bellemans --------------------------------------------------------------------------

enum { TERMS = 6 };
struct cosines {
    double c[TERMS];
};

/// x = cos(φ − 180°) = −cos φ, dx/dφ = sin φ.
static void cosines_evaluate(const void *parameters, size_t count, const double *phi,
                             double *energy, double *slope) {
    const double *c = ((const struct cosines *)parameters)->c;
    for (size_t n = 0; n < count; n++) {
        const double x = -cos(phi[n]);
        double value = c[TERMS - 1], derivative = 0;
        for (int power = TERMS - 2; power >= 0; power--) {
            derivative = derivative * x + value;
            value = value * x + c[power];
        }
        energy[n] = value;
        slope[n] = derivative * sin(phi[n]);
    }
}

#define COSINE(n, text)                                                                            \
    {                                                                                              \
        "c" #n, FIELD_NUMBER, .offset = offsetof(struct cosines, c) + n * sizeof(double),          \
                              .initial = 0, ANY_NUMBER, .unit = "k_B T_0", .help = text            \
    }
static const struct field cosines_fields[] = {
    COSINE(0, "C_0"),
    COSINE(1, "C_1 cos psi"),
    COSINE(2, "C_2 (cos psi)^2"),
    COSINE(3, "C_3 (cos psi)^3"),
    COSINE(4, "C_4 (cos psi)^4"),
    COSINE(5, "C_5 (cos psi)^5"),
    FIELD_END,
};

const struct bonded_law mf_dihedral_ryckaert_bellemans = {
    .name = "ryckaert-bellemans",
    .summary = "U = sum_n C_n (cos psi)^n, psi = 0 for trans, as GROMACS has it; J.-P. Ryckaert "
               "and A. Bellemans, Chem. Phys. Lett. 30, 123 (1975)",
    .fields = cosines_fields,
    .size = sizeof(struct cosines),
    .evaluate = cosines_evaluate,
    .rest = trans_rest,
};

// Periodic ----------------------------------------------------------------------------------------

struct periodic {
    double k, phase; ///< [k_B T_0], [degrees]
    int64_t multiplicity;
};

static void periodic_evaluate(const void *parameters, size_t count, const double *phi,
                              double *energy, double *slope) {
    const struct periodic *p = parameters;
    const double times = (double)p->multiplicity, phase = BONDED_RADIANS * p->phase;
    for (size_t n = 0; n < count; n++) {
        energy[n] = p->k * (1 + cos(times * phi[n] - phase));
        slope[n] = -p->k * times * sin(times * phi[n] - phase);
    }
}

static double periodic_rest(const void *parameters) {
    const struct periodic *p = parameters;
    const double top = BONDED_RADIANS * p->phase + (p->k >= 0 ? M_PI : 0);
    return remainder(top / (double)p->multiplicity, 2 * M_PI);
}

#define PERIODIC(member) .offset = offsetof(struct periodic, member)
static const struct field periodic_fields[] = {
    {"k", FIELD_NUMBER, PERIODIC(k), .required = true, ANY_NUMBER, .unit = "k_B T_0",
     .help = "k; phi is 0 for cis and 180 degrees for trans (IUPAC)"},
    {"multiplicity", FIELD_INTEGER, PERIODIC(multiplicity), .initial = 1, .minimum = 1,
     .maximum = 12, .unit = "", .help = "n, the number of minima"},
    {"phase", FIELD_NUMBER, PERIODIC(phase), .initial = 0, .minimum = -360, .maximum = 360,
     .unit = "degrees", .help = "n phi at the maximum, if k is above 0"},
    FIELD_END,
};

const struct bonded_law mf_dihedral_periodic = {
    .name = "periodic",
    .summary = "U = k [1 + cos(n phi - phase)], phi = 0 for cis, as GROMACS and CHARMM have it",
    .fields = periodic_fields,
    .size = sizeof(struct periodic),
    .evaluate = periodic_evaluate,
    .rest = periodic_rest,
};

BONDED_TABLE(mf_dihedral_table, "columns phi, U: 360 degrees; 0 is cis and 180 trans (IUPAC)",
             "periodic cubic spline through the points of a file");

// Geometry: F = r_0 − r_1, G = r_1 − r_2 and H = r_3 − r_2 ----------------------------------------
//
// A. Blondel and M. Karplus, J. Comput. Chem. 17, 1132 (1996): with A = F × G and B = H × G nothing
// is divided by the sine of φ.

SIMD_CLONES static void measure(struct bonded_batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        double f[3], g[3], h[3], a[3], b[3], turn[3];
        bonded_take(batch->arm[0], n, f);
        bonded_take(batch->arm[1], n, g);
        bonded_take(batch->arm[2], n, h);
        bonded_cross(f, g, a);
        bonded_cross(h, g, b);
        bonded_cross(b, a, turn);
        batch->q[n] = atan2(bonded_dot(turn, g), bonded_dot(a, b) * sqrt(bonded_dot(g, g)));
    }
}

/// Their eq. 27.
SIMD_CLONES static void push(struct bonded_batch *batch) {
    static const double min = BONDED_NO_DIRECTION * BONDED_NO_DIRECTION;
    for (int n = 0; n < batch->count; n++) {
        double f[3], g[3], h[3], a[3], b[3];
        bonded_take(batch->arm[0], n, f);
        bonded_take(batch->arm[1], n, g);
        bonded_take(batch->arm[2], n, h);
        bonded_cross(f, g, a);
        bonded_cross(h, g, b);
        const double aa = bonded_dot(a, a), bb = bonded_dot(b, b), gg = bonded_dot(g, g);
        const double length = sqrt(gg), slope = batch->slope[n];
        const bool directed = aa > min * bonded_dot(f, f) * gg && bb > min * bonded_dot(h, h) * gg;
        const double fg = bonded_dot(f, g) / (aa * length), hg = bonded_dot(h, g) / (bb * length);
        for (int d = 0; d < 3; d++) {
            batch->arm[0][d][n] = directed ? slope * length / aa * a[d] : 0;
            batch->arm[1][d][n] = directed ? slope * (hg * b[d] - fg * a[d]) : 0;
            batch->arm[2][d][n] = directed ? -slope * length / bb * b[d] : 0;
        }
    }
}

static double jacobian(int dimensions, double low, double width) {
    (void)dimensions;
    (void)low;
    return width * BONDED_RADIANS;
}

static const struct bonded_law *const laws[] = {&mf_dihedral_ryckaert_bellemans,
                                                &mf_dihedral_periodic, &mf_dihedral_table, NULL};

const struct bonded_kind mf_dihedral = {
    .name = "dihedral",
    .plural = "dihedrals",
    .article = "a",
    .beads = 4,
    .reach = 3,
    .chain = {0, 1, 2, 3},
    .spatial = true,
    .arms = 3,
    .arm = {{0, 1}, {1, 2}, {3, 2}},
    .measure = measure,
    .push = push,
    .jacobian = jacobian,
    BONDED_ANGLES,
    .low = -180,
    .high = 180,
    .periodic = true,
    .laws = laws,
    .table = &mf_dihedral_table,
    .fine = 3600,
    .cost = 60,
    .common = true,
};
