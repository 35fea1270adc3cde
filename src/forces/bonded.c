// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/bonded.h"

#include "base/simd.h"

#include <math.h>
#include <string.h>

/// glibc has an atan2 of vectors (libmvec) since 2.35, at most 4 units of the last place off.
#if SIMD_X86 && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 35)
__attribute__((simd("notinbranch"))) extern double atan2(double y, double x);
#endif
#endif

#define INLINE static inline __attribute__((always_inline))

/// Where a sine, or a product of lengths that it is measured by, is below this there is no
/// direction: that of a cross product is then rounding.
static const double no_direction = 1e-9;

// Vectors -----------------------------------------------------------------------------------------

INLINE void separate(const struct particles *particles, const int32_t *place, const int beads,
                     const int a, const int b, size_t count, bonded_vectors to) {
    for (int d = 0; d < 3; d++) {
        const double length = particles->box.length[d], inverse = 1 / length;
        const double *restrict x = particles->position[d];
        for (size_t n = 0; n < count; n++) {
            const size_t at = n * (size_t)beads;
            const double apart = x[place[at + (size_t)a]] - x[place[at + (size_t)b]];
            to[d][n] = apart - length * rint(apart * inverse);
        }
    }
}

INLINE double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

INLINE void cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

INLINE void take(const bonded_vectors from, size_t n, double vector[3]) {
    for (int d = 0; d < 3; d++)
        vector[d] = from[d][n];
}

INLINE void push(struct particles *particles, int32_t k, const double force[3]) {
    for (int d = 0; d < particles->box.dimensions; d++)
        particles->force[d][k] += force[d];
}

INLINE void add_transfer(struct bonded_sums *sums, const double r[3], const double force[3]) {
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            sums->transfer[a][b] += r[a] * force[b];
}

/// Energies and slopes of terms, the former summed.
INLINE void ask_law(const struct bonded_terms *terms, const double *q, double *slope,
                    struct bonded_sums *sums) {
    double energy[BONDED_BATCH];
    terms->curve->law->evaluate(terms->curve->parameters, terms->count, q, energy, slope);
    for (size_t n = 0; n < terms->count; n++)
        sums->energy += energy[n];
}

// Bonds -------------------------------------------------------------------------------------------

SIMD_CLONES static void measure_bonds(const struct particles *particles, const int32_t *place,
                                      size_t count, bonded_vectors r, double *length) {
    separate(particles, place, 2, 0, 1, count, r);
    for (size_t n = 0; n < count; n++)
        length[n] = sqrt(r[0][n] * r[0][n] + r[1][n] * r[1][n] + r[2][n] * r[2][n]);
}

/// Forces on the first beads, in the place of the vectors.
SIMD_CLONES static void find_pulls(const double *length, const double *slope, size_t count,
                                   bonded_vectors r) {
    for (size_t n = 0; n < count; n++) {
        const double pull = length[n] > 0 ? -slope[n] / length[n] : 0;
        for (int d = 0; d < 3; d++)
            r[d][n] *= pull;
    }
}

static void find_torn(const struct bonded_terms *terms, const double *length,
                      struct bonded_sums *sums) {
    const double longest = mf_bonded_longest(terms->curve);
    for (size_t n = 0; n < terms->count; n++)
        if (length[n] > longest && length[n] > sums->longest) {
            sums->longest = length[n];
            sums->torn = terms->group;
        }
}

void mf_bonded_add_bonds(const struct bonded_terms *terms, struct particles *particles,
                         struct bonded_sums *sums) {
    const size_t count = terms->count;
    const int32_t *place = terms->place;
    double length[BONDED_BATCH], slope[BONDED_BATCH];
    bonded_vectors force, r;
    measure_bonds(particles, place, count, force, length);
    ask_law(terms, length, slope, sums);
    for (size_t n = 0; n < count; n++)
        sums->virial -= slope[n] * length[n];
    if (terms->transfer)
        memcpy(r, force, sizeof r);
    find_pulls(length, slope, count, force);
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict f = particles->force[d];
        for (size_t n = 0; n < count; n++) {
            f[place[2 * n]] += force[d][n];
            f[place[2 * n + 1]] -= force[d][n];
        }
    }
    for (size_t n = 0; n < count && terms->transfer; n++) {
        double from[3], pull[3];
        take(r, n, from);
        take(force, n, pull);
        add_transfer(sums, from, pull);
    }
    if (terms->curve->law->longest)
        find_torn(terms, length, sums);
}

// Angles ------------------------------------------------------------------------------------------

/// θ between a = r_0 − r_1 and b = r_2 − r_1, by its sine and cosine, exact at all angles.
SIMD_CLONES static void measure_angles(const struct particles *particles, const int32_t *place,
                                       size_t count, bonded_vectors a, bonded_vectors b,
                                       double *theta) {
    separate(particles, place, 3, 0, 1, count, a);
    separate(particles, place, 3, 2, 1, count, b);
    for (size_t n = 0; n < count; n++) {
        double u[3], v[3], normal[3];
        take(a, n, u);
        take(b, n, v);
        cross(u, v, normal);
        theta[n] = atan2(sqrt(dot(normal, normal)), dot(u, v));
    }
}

/// Forces on the first and the last beads, in the place of the vectors: with p = a × b, ∂θ/∂a = a ×
/// p/(a² |p|) and ∂θ/∂b = p × b/(b² |p|), away from each other in their plane.
SIMD_CLONES static void find_turns(const double *slope, size_t count, bonded_vectors a,
                                   bonded_vectors b) {
    for (size_t n = 0; n < count; n++) {
        double u[3], v[3], p[3], first[3], last[3];
        take(a, n, u);
        take(b, n, v);
        cross(u, v, p);
        const double uu = dot(u, u), vv = dot(v, v), length = sqrt(dot(p, p));
        const double turn = length > no_direction * sqrt(uu * vv) ? -slope[n] / length : 0;
        cross(u, p, first);
        cross(p, v, last);
        for (int d = 0; d < 3; d++) {
            a[d][n] = turn != 0 ? turn / uu * first[d] : 0;
            b[d][n] = turn != 0 ? turn / vv * last[d] : 0;
        }
    }
}

void mf_bonded_add_angles(const struct bonded_terms *terms, struct particles *particles,
                          struct bonded_sums *sums) {
    const size_t count = terms->count;
    const int32_t *place = terms->place;
    double theta[BONDED_BATCH], slope[BONDED_BATCH];
    bonded_vectors first, last, a, b;
    measure_angles(particles, place, count, first, last, theta);
    ask_law(terms, theta, slope, sums);
    if (terms->transfer) {
        memcpy(a, first, sizeof a);
        memcpy(b, last, sizeof b);
    }
    find_turns(slope, count, first, last);
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict f = particles->force[d];
        for (size_t n = 0; n < count; n++) {
            f[place[3 * n]] += first[d][n];
            f[place[3 * n + 1]] -= first[d][n] + last[d][n];
            f[place[3 * n + 2]] += last[d][n];
        }
    }
    for (size_t n = 0; n < count && terms->transfer; n++) {
        double from[3], force[3];
        take(a, n, from);
        take(first, n, force);
        add_transfer(sums, from, force);
        take(b, n, from);
        take(last, n, force);
        add_transfer(sums, from, force);
    }
}

// Dihedrals ---------------------------------------------------------------------------------------
//
// A. Blondel and M. Karplus, J. Comput. Chem. 17, 1132 (1996): with F = r_0 − r_1, G = r_1 − r_2,
// H = r_3 − r_2, A = F × G and B = H × G nothing is divided by the sine of φ.

SIMD_CLONES static void measure_dihedrals(const struct particles *particles, const int32_t *place,
                                          size_t count, bonded_vectors f, bonded_vectors g,
                                          bonded_vectors h, double *phi) {
    separate(particles, place, 4, 0, 1, count, f);
    separate(particles, place, 4, 1, 2, count, g);
    separate(particles, place, 4, 3, 2, count, h);
    for (size_t n = 0; n < count; n++) {
        double u[3], v[3], w[3], a[3], b[3], turn[3];
        take(f, n, u);
        take(g, n, v);
        take(h, n, w);
        cross(u, v, a);
        cross(w, v, b);
        cross(b, a, turn);
        phi[n] = atan2(dot(turn, v), dot(a, b) * sqrt(dot(v, v)));
    }
}

/// Their eq. 27. Sums of r F are about bead 1.
static void push_dihedral(const struct bonded_terms *terms, struct particles *particles, size_t n,
                          const double f[3], const double g[3], const double h[3], double slope,
                          struct bonded_sums *sums) {
    const int32_t *place = terms->place + 4 * n;
    double a[3], b[3], force[4][3], to_third[3], to_last[3];
    cross(f, g, a);
    cross(h, g, b);
    const double aa = dot(a, a), bb = dot(b, b), gg = dot(g, g), length = sqrt(gg);
    static const double least = no_direction * no_direction;
    if (!(aa > least * dot(f, f) * gg && bb > least * dot(h, h) * gg))
        return;
    const double fg = dot(f, g) / (aa * length), hg = dot(h, g) / (bb * length);
    for (int d = 0; d < 3; d++) {
        const double outer_a = length / aa * a[d], outer_b = length / bb * b[d];
        const double inner = fg * a[d] - hg * b[d];
        force[0][d] = slope * outer_a;
        force[1][d] = -slope * (outer_a + inner);
        force[2][d] = slope * (outer_b + inner);
        force[3][d] = -slope * outer_b;
        to_third[d] = -g[d];
        to_last[d] = h[d] - g[d];
    }
    for (int bead = 0; bead < 4; bead++)
        push(particles, place[bead], force[bead]);
    if (terms->transfer) {
        add_transfer(sums, f, force[0]);
        add_transfer(sums, to_third, force[2]);
        add_transfer(sums, to_last, force[3]);
    }
}

void mf_bonded_add_dihedrals(const struct bonded_terms *terms, struct particles *particles,
                             struct bonded_sums *sums) {
    double phi[BONDED_BATCH], slope[BONDED_BATCH];
    bonded_vectors f, g, h;
    measure_dihedrals(particles, terms->place, terms->count, f, g, h, phi);
    ask_law(terms, phi, slope, sums);
    for (size_t n = 0; n < terms->count; n++) {
        double u[3], v[3], w[3];
        take(f, n, u);
        take(g, n, v);
        take(h, n, w);
        push_dihedral(terms, particles, n, u, v, w, slope[n], sums);
    }
}

// Measuring ---------------------------------------------------------------------------------------

void mf_bonded_measure(int order, size_t count, const int32_t *place,
                       const struct particles *particles, double *q) {
    bonded_vectors a, b, c;
    for (size_t done = 0; done < count; done += BONDED_BATCH) {
        const size_t some = count - done < BONDED_BATCH ? count - done : BONDED_BATCH;
        const int32_t *from = place + done * (size_t)(order + 2);
        if (order == BONDED_BOND)
            measure_bonds(particles, from, some, a, q + done);
        else if (order == BONDED_ANGLE)
            measure_angles(particles, from, some, a, b, q + done);
        else
            measure_dihedrals(particles, from, some, a, b, c, q + done);
    }
}
