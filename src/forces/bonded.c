// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/bonded.h"

#include "base/lanes.h"
#include "base/simd.h"

#include <math.h>
#include <string.h>

/// glibc has an atan2 of vectors (libmvec) since 2.35, at most 4 units of the last place off.
#if SIMD_X86 && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 35)
__attribute__((simd("notinbranch"))) extern double atan2(double y, double x);
#endif
#endif

enum { WIDTH = BONDED_LANES, TERMS = BONDED_BATCH / WIDTH, MOST_ARMS = BONDED_KINDS };

/// Where a sine, or a product of lengths that it is measured by, is below this there is no
/// direction: that of a cross product is then rounding.
static const double no_direction = 1e-9;

/// All lanes, which a compiler spreads over as many registers as it takes.
typedef double lanes __attribute__((vector_size(sizeof(double) * WIDTH)));

/// Component d of number n is [d][n]; term t in lane l is number t · WIDTH + l.
typedef double vectors[3][BONDED_BATCH];

/// The arms of a term are differences of its beads: of a bond r_0 − r_1; of an angle that and
/// r_2 − r_1; of a dihedral F = r_0 − r_1, G = r_1 − r_2 and H = r_3 − r_2. A force on an arm is
/// one on its first bead, and the opposite one on the other.
struct arm {
    int from, to;
};
static const struct arm arms[BONDED_KINDS][MOST_ARMS] = {
    [BONDED_BOND] = {{0, 1}},
    [BONDED_ANGLE] = {{0, 1}, {2, 1}},
    [BONDED_DIHEDRAL] = {{0, 1}, {1, 2}, {3, 2}},
};

/// Terms that are worked on together. Forces on the arms take the place of the arms.
struct batch {
    _Alignas(MEMORY_ALIGNMENT) vectors arm[MOST_ARMS];
    double q[BONDED_BATCH], slope[BONDED_BATCH];
    int order;
    int count; ///< of numbers
};

// Vectors -----------------------------------------------------------------------------------------

LANES_INLINE double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

LANES_INLINE void cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

LANES_INLINE void take(const vectors from, int n, double vector[3]) {
    for (int d = 0; d < 3; d++)
        vector[d] = from[d][n];
}

// Beads -------------------------------------------------------------------------------------------

SIMD_CLONES void mf_bonded_take(struct bonded_beads *beads, const struct particles *particles,
                                const int32_t *place, int count) {
    const double *x = particles->position[0], *y = particles->position[1];
    const double *z = particles->position[2];
    beads->box = &particles->box;
    memset(beads->force, 0, (size_t)count * sizeof *beads->force);
    for (int b = 0; b < count; b++, place += WIDTH)
        for (int l = 0; l < WIDTH; l++) {
            beads->position[b][0][l] = x[place[l]];
            beads->position[b][1][l] = y[place[l]];
            beads->position[b][2][l] = z[place[l]];
        }
}

SIMD_CLONES void mf_bonded_give_sums(const struct bonded_beads *beads, struct particles *particles,
                                     const int32_t *place, int count, int used) {
    lanes_double4 *sum = (lanes_double4 *)particles->kernel_force;
    for (int b = 0; b < count; b++, place += WIDTH)
        for (int l = 0; l < used; l++)
            sum[place[l]] += (lanes_double4){beads->force[b][0][l], beads->force[b][1][l],
                                             beads->force[b][2][l], 0};
}

void mf_bonded_give(const struct bonded_beads *beads, struct particles *particles,
                    const int32_t *place, int count, int used) {
    for (int b = 0; b < count; b++, place += WIDTH)
        for (int l = 0; l < used; l++)
            for (int d = 0; d < particles->box.dimensions; d++)
                particles->force[d][place[l]] += beads->force[b][d][l];
}

/// The arms of terms, to the nearest images (box_nearest).
LANES_INLINE void stretch_arms(struct batch *batch, const struct bonded_beads *beads,
                               const int *bead, const int order, int terms) {
    static const double large = 0x1.8p52; // leaves no room for a fraction
    const double *length = beads->box->length;
    const double inverse[3] = {1 / length[0], 1 / length[1], 1 / length[2]};
    for (int t = 0; t < terms; t++, bead += order + 2)
        for (int k = 0; k <= order; k++)
            for (int d = 0; d < 3; d++) {
                lanes from, to;
                memcpy(&from, beads->position[bead[arms[order][k].from]][d], sizeof from);
                memcpy(&to, beads->position[bead[arms[order][k].to]][d], sizeof to);
                const lanes apart = from - to, boxes = apart * inverse[d] + large - large;
                const lanes arm = apart - length[d] * boxes;
                memcpy(batch->arm[k][d] + t * WIDTH, &arm, sizeof arm);
            }
}

LANES_INLINE void push_bead(double *force, lanes push) {
    lanes sum;
    memcpy(&sum, force, sizeof sum);
    sum += push;
    memcpy(force, &sum, sizeof sum);
}

LANES_INLINE void push_beads(const struct batch *batch, struct bonded_beads *beads, const int *bead,
                             const int order, int terms) {
    for (int t = 0; t < terms; t++, bead += order + 2)
        for (int k = 0; k <= order; k++)
            for (int d = 0; d < 3; d++) {
                lanes push;
                memcpy(&push, batch->arm[k][d] + t * WIDTH, sizeof push);
                push_bead(beads->force[bead[arms[order][k].from]][d], push);
                push_bead(beads->force[bead[arms[order][k].to]][d], -push);
            }
}

// Bonds -------------------------------------------------------------------------------------------

LANES_INLINE void measure_bonds(struct batch *batch) {
    const double *x = batch->arm[0][0], *y = batch->arm[0][1], *z = batch->arm[0][2];
    for (int n = 0; n < batch->count; n++)
        batch->q[n] = sqrt(x[n] * x[n] + y[n] * y[n] + z[n] * z[n]);
}

LANES_INLINE void find_pulls(struct batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        const double pull = batch->q[n] > 0 ? -batch->slope[n] / batch->q[n] : 0;
        for (int d = 0; d < 3; d++)
            batch->arm[0][d][n] *= pull;
    }
}

// Angles ------------------------------------------------------------------------------------------

/// θ between a = r_0 − r_1 and b = r_2 − r_1, by its sine and cosine, exact at all angles.
LANES_INLINE void measure_angles(struct batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        double a[3], b[3], normal[3];
        take(batch->arm[0], n, a);
        take(batch->arm[1], n, b);
        cross(a, b, normal);
        batch->q[n] = atan2(sqrt(dot(normal, normal)), dot(a, b));
    }
}

/// With p = a × b, ∂θ/∂a = a × p/(a² |p|) and ∂θ/∂b = p × b/(b² |p|), away from each other in their
/// plane.
LANES_INLINE void find_turns(struct batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        double a[3], b[3], p[3], first[3], last[3];
        take(batch->arm[0], n, a);
        take(batch->arm[1], n, b);
        cross(a, b, p);
        const double aa = dot(a, a), bb = dot(b, b), length = sqrt(dot(p, p));
        const double turn = length > no_direction * sqrt(aa * bb) ? -batch->slope[n] / length : 0;
        cross(a, p, first);
        cross(p, b, last);
        for (int d = 0; d < 3; d++) {
            batch->arm[0][d][n] = turn != 0 ? turn / aa * first[d] : 0;
            batch->arm[1][d][n] = turn != 0 ? turn / bb * last[d] : 0;
        }
    }
}

// Dihedrals ---------------------------------------------------------------------------------------
//
// A. Blondel and M. Karplus, J. Comput. Chem. 17, 1132 (1996): with A = F × G and B = H × G nothing
// is divided by the sine of φ.

LANES_INLINE void measure_dihedrals(struct batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        double f[3], g[3], h[3], a[3], b[3], turn[3];
        take(batch->arm[0], n, f);
        take(batch->arm[1], n, g);
        take(batch->arm[2], n, h);
        cross(f, g, a);
        cross(h, g, b);
        cross(b, a, turn);
        batch->q[n] = atan2(dot(turn, g), dot(a, b) * sqrt(dot(g, g)));
    }
}

/// Their eq. 27.
LANES_INLINE void find_twists(struct batch *batch) {
    static const double least = no_direction * no_direction;
    for (int n = 0; n < batch->count; n++) {
        double f[3], g[3], h[3], a[3], b[3];
        take(batch->arm[0], n, f);
        take(batch->arm[1], n, g);
        take(batch->arm[2], n, h);
        cross(f, g, a);
        cross(h, g, b);
        const double aa = dot(a, a), bb = dot(b, b), gg = dot(g, g), length = sqrt(gg);
        const bool directed = aa > least * dot(f, f) * gg && bb > least * dot(h, h) * gg;
        const double slope = batch->slope[n];
        const double fg = dot(f, g) / (aa * length), hg = dot(h, g) / (bb * length);
        for (int d = 0; d < 3; d++) {
            batch->arm[0][d][n] = directed ? slope * length / aa * a[d] : 0;
            batch->arm[1][d][n] = directed ? slope * (hg * b[d] - fg * a[d]) : 0;
            batch->arm[2][d][n] = directed ? -slope * length / bb * b[d] : 0;
        }
    }
}

// Terms -------------------------------------------------------------------------------------------

LANES_INLINE void measure(struct batch *batch, const struct bonded_beads *beads, const int *bead,
                          const int order, int terms) {
    stretch_arms(batch, beads, bead, order, terms);
    if (order == BONDED_BOND)
        measure_bonds(batch);
    else if (order == BONDED_ANGLE)
        measure_angles(batch);
    else
        measure_dihedrals(batch);
}

LANES_INLINE void push(struct batch *batch, struct bonded_beads *beads, const int *bead,
                       const int order, int terms) {
    if (order == BONDED_BOND)
        find_pulls(batch);
    else if (order == BONDED_ANGLE)
        find_turns(batch);
    else
        find_twists(batch);
    push_beads(batch, beads, bead, order, terms);
}

/// The first numbers of terms.
SIMD_CLONES static void measure_terms(struct batch *batch, const struct bonded_beads *beads,
                                      const int *bead, int terms) {
    if (batch->order == BONDED_BOND)
        measure(batch, beads, bead, BONDED_BOND, terms);
    else if (batch->order == BONDED_ANGLE)
        measure(batch, beads, bead, BONDED_ANGLE, terms);
    else
        measure(batch, beads, bead, BONDED_DIHEDRAL, terms);
}

/// From slopes to forces on the arms, and on the beads.
SIMD_CLONES static void push_terms(struct batch *batch, struct bonded_beads *beads, const int *bead,
                                   int terms) {
    if (batch->order == BONDED_BOND)
        push(batch, beads, bead, BONDED_BOND, terms);
    else if (batch->order == BONDED_ANGLE)
        push(batch, beads, bead, BONDED_ANGLE, terms);
    else
        push(batch, beads, bead, BONDED_DIHEDRAL, terms);
}

static void add_sums(const struct bonded_terms *terms, const struct batch *batch,
                     const double *energy, struct bonded_sums *sums) {
    for (int n = 0; n < batch->count; n++)
        if (n % WIDTH < terms->lanes) {
            sums->energy += energy[n];
            if (batch->order == BONDED_BOND)
                sums->virial -= batch->slope[n] * batch->q[n];
        }
}

static void add_transfer(const struct bonded_terms *terms, const vectors *arm,
                         const struct batch *forces, struct bonded_sums *sums) {
    for (int k = 0; k <= forces->order; k++)
        for (int n = 0; n < forces->count; n++)
            for (int a = 0; a < 3 && n % WIDTH < terms->lanes; a++)
                for (int b = 0; b < 3; b++)
                    sums->transfer[a][b] += arm[k][a][n] * forces->arm[k][b][n];
}

SIMD_CLONES static bool is_longer(const struct batch *batch, double longest) {
    int longer = 0;
    for (int n = 0; n < batch->count; n++)
        longer |= batch->q[n] > longest;
    return longer;
}

static void find_torn(const struct bonded_terms *terms, const struct batch *batch,
                      struct bonded_sums *sums) {
    const double longest = mf_bonded_longest(terms->curve);
    for (int n = 0; n < batch->count && is_longer(batch, longest); n++)
        if (batch->q[n] > longest && batch->q[n] > sums->longest) {
            sums->longest = batch->q[n];
            sums->torn = terms->group;
        }
}

static void add_batch(const struct bonded_terms *terms, const int *bead, int count,
                      struct bonded_beads *beads, struct bonded_sums *sums) {
    const struct bonded_law *law = terms->curve->law;
    struct batch batch;
    double energy[BONDED_BATCH];
    vectors arm[MOST_ARMS];
    batch.order = terms->order;
    batch.count = count * WIDTH;
    measure_terms(&batch, beads, bead, count);
    if (law->slopes && !terms->sums)
        law->slopes(terms->curve->parameters, (size_t)batch.count, batch.q, batch.slope);
    else
        law->evaluate(terms->curve->parameters, (size_t)batch.count, batch.q, energy, batch.slope);
    if (terms->sums)
        add_sums(terms, &batch, energy, sums);
    if (law->longest)
        find_torn(terms, &batch, sums);
    if (terms->transfer)
        memcpy(arm, batch.arm, sizeof arm);
    push_terms(&batch, beads, bead, count);
    if (terms->transfer)
        add_transfer(terms, arm, &batch, sums);
}

void mf_bonded_add(const struct bonded_terms *terms, struct bonded_beads *beads,
                   struct bonded_sums *sums) {
    for (int t = 0; t < terms->count; t += TERMS)
        add_batch(terms, terms->bead + t * (terms->order + 2),
                  terms->count - t < TERMS ? terms->count - t : TERMS, beads, sums);
}

// Measuring ---------------------------------------------------------------------------------------

/// Terms are the lanes of one.
void mf_bonded_measure(int order, size_t count, const int32_t *place,
                       const struct particles *particles, double *q) {
    const size_t each = (size_t)order + 2;
    static const int bead[MOST_ARMS + 1] = {0, 1, 2, 3};
    struct bonded_beads beads;
    struct batch batch;
    batch.order = order;
    beads.box = &particles->box;
    memset(beads.position, 0, each * sizeof *beads.position);
    for (size_t done = 0; done < count; done += WIDTH) {
        const size_t some = count - done < WIDTH ? count - done : WIDTH;
        for (size_t n = 0; n < some * each; n++)
            for (int d = 0; d < 3; d++)
                beads.position[n % each][d][n / each] =
                    particles->position[d][place[done * each + n]];
        batch.count = (int)some;
        measure_terms(&batch, &beads, bead, 1);
        memcpy(q + done, batch.q, some * sizeof *q);
    }
}
