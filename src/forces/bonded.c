// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/bonded.h"

#include "curves/bonded_batch.h"

#include <string.h>

enum { WIDTH = BONDED_LANES, TERMS = BONDED_BATCH / WIDTH };

/// All lanes, which a compiler spreads over as many registers as it takes. Term t in lane l is
/// number t · WIDTH + l of a batch.
typedef double lanes __attribute__((vector_size(sizeof(double) * WIDTH)));

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
LANES_INLINE void stretch_some(const struct bonded_kind *kind, const int arms,
                               const struct bonded_beads *beads, const int *bead, int terms,
                               struct bonded_batch *batch) {
    static const double large = 0x1.8p52; // leaves no room for a fraction
    const double *length = beads->box->length;
    const double inverse[3] = {1 / length[0], 1 / length[1], 1 / length[2]};
    const struct bonded_kind own = *kind; // which nothing that is written can change
    for (int t = 0; t < terms; t++, bead += own.beads)
        for (int k = 0; k < arms; k++)
            for (int d = 0; d < 3; d++) {
                lanes from, to;
                memcpy(&from, beads->position[bead[own.arm[k].from]][d], sizeof from);
                memcpy(&to, beads->position[bead[own.arm[k].to]][d], sizeof to);
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

/// Add the forces on arms to those of their beads.
LANES_INLINE void push_some(const struct bonded_kind *kind, const int arms,
                            const struct bonded_batch *batch, const int *bead, int terms,
                            struct bonded_beads *beads) {
    const struct bonded_kind own = *kind;
    for (int t = 0; t < terms; t++, bead += own.beads)
        for (int k = 0; k < arms; k++)
            for (int d = 0; d < 3; d++) {
                lanes push;
                memcpy(&push, batch->arm[k][d] + t * WIDTH, sizeof push);
                push_bead(beads->force[bead[own.arm[k].from]][d], push);
                push_bead(beads->force[bead[own.arm[k].to]][d], -push);
            }
}

// A number of arms that the compiler knows is worth 3 % of a simulation of chains.

SIMD_CLONES static void stretch_arms(const struct bonded_kind *kind,
                                     const struct bonded_beads *beads, const int *bead, int terms,
                                     struct bonded_batch *batch) {
    if (kind->arms == 1)
        stretch_some(kind, 1, beads, bead, terms, batch);
    else if (kind->arms == 2)
        stretch_some(kind, 2, beads, bead, terms, batch);
    else
        stretch_some(kind, 3, beads, bead, terms, batch);
}

SIMD_CLONES static void push_arms(const struct bonded_kind *kind, const struct bonded_batch *batch,
                                  const int *bead, int terms, struct bonded_beads *beads) {
    if (kind->arms == 1)
        push_some(kind, 1, batch, bead, terms, beads);
    else if (kind->arms == 2)
        push_some(kind, 2, batch, bead, terms, beads);
    else
        push_some(kind, 3, batch, bead, terms, beads);
}

// Terms -------------------------------------------------------------------------------------------

static void add_sums(const struct bonded_terms *terms, const struct bonded_batch *batch,
                     const double *energy, struct bonded_sums *sums) {
    for (int n = 0; n < batch->count; n++)
        if (n % WIDTH < terms->lanes) {
            sums->energy += energy[n];
            if (mf_bonded_kinds[terms->order]->is_length)
                sums->virial -= batch->slope[n] * batch->q[n];
        }
}

static void add_transfer(const struct bonded_terms *terms, const bonded_arms *arm,
                         const struct bonded_batch *forces, struct bonded_sums *sums) {
    for (int k = 0; k < mf_bonded_kinds[terms->order]->arms; k++)
        for (int n = 0; n < forces->count; n++)
            for (int a = 0; a < 3 && n % WIDTH < terms->lanes; a++)
                for (int b = 0; b < 3; b++)
                    sums->transfer[a][b] += arm[k][a][n] * forces->arm[k][b][n];
}

SIMD_CLONES static bool is_longer(const struct bonded_batch *batch, double longest) {
    int longer = 0;
    for (int n = 0; n < batch->count; n++)
        longer |= batch->q[n] > longest;
    return longer;
}

static void find_broken(const struct bonded_terms *terms, const struct bonded_batch *batch,
                        struct bonded_sums *sums) {
    const double longest = mf_bonded_longest(terms->curve);
    for (int n = 0; n < batch->count && is_longer(batch, longest); n++)
        if (batch->q[n] > longest && batch->q[n] > sums->longest) {
            sums->longest = batch->q[n];
            sums->broken_order = terms->order;
            sums->broken = terms->group;
        }
}

static void add_batch(const struct bonded_terms *terms, const int *bead, int count,
                      struct bonded_beads *beads, struct bonded_sums *sums) {
    const struct bonded_law *law = terms->curve->law;
    const struct bonded_kind *kind = mf_bonded_kinds[terms->order];
    struct bonded_batch batch;
    double energy[BONDED_BATCH];
    bonded_arms arm[BONDED_MAX_ARMS];
    batch.count = count * WIDTH;
    stretch_arms(kind, beads, bead, count, &batch);
    kind->measure(&batch);
    if (law->slopes && !terms->sums)
        law->slopes(terms->curve->parameters, (size_t)batch.count, batch.q, batch.slope);
    else
        law->evaluate(terms->curve->parameters, (size_t)batch.count, batch.q, energy, batch.slope);
    if (terms->sums)
        add_sums(terms, &batch, energy, sums);
    if (law->longest)
        find_broken(terms, &batch, sums);
    if (terms->transfer)
        memcpy(arm, batch.arm, sizeof arm);
    kind->push(&batch);
    push_arms(kind, &batch, bead, count, beads);
    if (terms->transfer)
        add_transfer(terms, arm, &batch, sums);
}

void mf_bonded_add(const struct bonded_terms *terms, struct bonded_beads *beads,
                   struct bonded_sums *sums) {
    for (int t = 0; t < terms->count; t += TERMS)
        add_batch(terms, terms->bead + t * mf_bonded_kinds[terms->order]->beads,
                  terms->count - t < TERMS ? terms->count - t : TERMS, beads, sums);
}

// Laplacian ---------------------------------------------------------------------------------------

/// A step of differences [λ]: forces are exact to 1e-15 of themselves.
static const double apart = 1e-5;

/// A place number `n` of a term's: a coordinate of one of its beads, forth or back.
struct shift {
    int bead, axis;
    double by;
};

static struct shift shift_of(int n, int dimensions) {
    return (struct shift){n / 2 / dimensions, n / 2 % dimensions, n % 2 ? apart : -apart};
}

/// One term of one lane, whose shifted copies are the lanes.
static double laplacian_of(const struct bonded_terms *terms, const struct bonded_beads *beads,
                           const int *bead, int lane) {
    static const int own[BONDED_MAX_TERM_BEADS] = {0, 1, 2, 3};
    const int count = mf_bonded_kinds[terms->order]->beads, dimensions = beads->box->dimensions;
    const int shifts = 2 * count * dimensions;
    struct bonded_terms one = *terms;
    struct bonded_beads copies;
    struct bonded_sums sums = {0};
    double sum = 0;
    one.count = 1;
    one.bead = own;
    one.sums = one.transfer = false;
    copies.box = beads->box;
    for (int first = 0; first < shifts; first += WIDTH) {
        one.lanes = shifts - first < WIDTH ? shifts - first : WIDTH;
        memset(copies.force, 0, (size_t)count * sizeof *copies.force);
        for (int b = 0; b < count; b++)
            for (int d = 0; d < 3; d++)
                for (int l = 0; l < WIDTH; l++)
                    copies.position[b][d][l] = beads->position[bead[b]][d][lane];
        for (int l = 0; l < one.lanes; l++) {
            const struct shift shift = shift_of(first + l, dimensions);
            copies.position[shift.bead][shift.axis][l] += shift.by;
        }
        mf_bonded_add(&one, &copies, &sums);
        for (int l = 0; l < one.lanes; l++) {
            const struct shift shift = shift_of(first + l, dimensions);
            sum -= copies.force[shift.bead][shift.axis][l] / (2 * shift.by);
        }
    }
    return sum;
}

double mf_bonded_laplacian(const struct bonded_terms *terms, const struct bonded_beads *beads) {
    double sum = 0;
    for (int t = 0; t < terms->count; t++)
        for (int lane = 0; lane < terms->lanes; lane++)
            sum += laplacian_of(terms, beads,
                                terms->bead + t * mf_bonded_kinds[terms->order]->beads, lane);
    return sum;
}

// Measuring ---------------------------------------------------------------------------------------

/// Terms are the lanes of one.
void mf_bonded_measure(int order, size_t count, const int32_t *place,
                       const struct particles *particles, double *q) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const size_t each = (size_t)kind->beads;
    static const int bead[BONDED_MAX_TERM_BEADS] = {0, 1, 2, 3};
    struct bonded_beads beads;
    struct bonded_batch batch;
    beads.box = &particles->box;
    memset(beads.position, 0, each * sizeof *beads.position);
    for (size_t done = 0; done < count; done += WIDTH) {
        const size_t some = count - done < WIDTH ? count - done : WIDTH;
        for (size_t n = 0; n < some * each; n++)
            for (int d = 0; d < 3; d++)
                beads.position[n % each][d][n / each] =
                    particles->position[d][place[done * each + n]];
        batch.count = (int)some;
        stretch_arms(kind, &beads, bead, 1, &batch);
        kind->measure(&batch);
        memcpy(q + done, batch.q, some * sizeof *q);
    }
}
