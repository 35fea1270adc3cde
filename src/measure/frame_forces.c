// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_forces.h"

#include "base/memory.h"
#include "base/simd.h"
#include "curves/bonded_batch.h"

#include <math.h>
#include <string.h>

/// Bytes that X may take.
static const double room = 0x1p25;

static size_t curve_of_pair(int pair) {
    return (size_t)pair;
}

static size_t curve_of_group(const struct frame_forces_plan *plan, int order, int group) {
    size_t n = 0;
    while (plan->equations.curve[n].order != order || plan->equations.curve[n].number != group)
        n++;
    return n;
}

void mf_frame_forces_clear(struct frame_forces *forces) {
    mf_cell_pairs_clear(&forces->search);
    mf_memory_free(forces->way);
    mf_memory_free(forces->gram);
    mf_memory_free(forces->product);
    mf_memory_free(forces->virial);
    *forces = (struct frame_forces){0};
}

static size_t beads_of(const struct frame_forces_plan *plan) {
    return (size_t)mf_composition_particles(&plan->pairs->composition);
}

static size_t beads_at_once(const struct frame_forces_plan *plan) {
    const double bytes = 3.0 * sizeof(double) * (double)plan->equations.size;
    return (size_t)fmin((double)beads_of(plan), fmax(1, floor(room / bytes)));
}

static enum status reserve(struct frame_forces *forces, const struct frame_forces_plan *plan) {
    const struct force_equations *const equations = &plan->equations;
    if (forces->way)
        return STATUS_OK;
    TRY_ARRAY(forces->way, 3 * beads_at_once(plan) * equations->size);
    TRY_ARRAY(forces->gram, force_equations_entries(equations));
    TRY_ARRAY(forces->product, equations->size);
    TRY_ARRAY(forces->virial, equations->size);
    return STATUS_OK;
}

// X -----------------------------------------------------------------------------------------------

/// One pass over pairs and terms.
struct work {
    struct frame_forces *forces;
    const struct frame_forces_plan *plan;
    double limit; ///< square of the cutoff
};

/// Add `factor` times a force of 1 at q along a way to the X of a bead, if it is one of those that
/// are looked at, and its part of the virial.
static void add(const struct work *work, size_t bead, const struct force_curve *curve, double q,
                const double way[3], double factor, double virial) {
    const size_t size = work->plan->equations.size;
    size_t node, next;
    double share;
    if (bead < work->forces->begin || bead >= work->forces->end ||
        !mf_force_equations_find(curve, q, &node, &next, &share))
        return;
    double *row = work->forces->way + 3 * (bead - work->forces->begin) * size;
    for (int d = 0; d < 3; d++, row += size) {
        row[node] += (1 - share) * factor * way[d];
        row[next] += share * factor * way[d];
    }
    work->forces->virial[node] += (1 - share) * virial;
    work->forces->virial[next] += share * virial;
}

/// The force between two beads of the energies of the densities around them.
static void add_density(const struct work *work, size_t i, size_t j, double square,
                        const double way[3], double sign) {
    const struct frame_forces_plan *const plan = work->plan;
    const double stress = sign * weighted_density_stress(plan->weight, square);
    if (stress == 0)
        return;
    const struct force_curve *const curve =
        &plan->equations.curve[curve_of_group(plan, FORCES_OF_DENSITY, 0)];
    for (int own = 0; own < 2; own++) {
        const double density = work->forces->density[own ? i : j];
        add(work, i, curve, density, way, -stress / square, 0.5 * stress);
        add(work, j, curve, density, way, stress / square, 0.5 * stress);
    }
}

/// A pair of beads, or what takes it away again.
static void add_pair(const struct work *work, const struct cell_pairs_batch *batch, size_t k,
                     size_t i, size_t j, double sign) {
    double way[3];
    const struct composition *const composition = &work->plan->pairs->composition;
    cell_pairs_vector(batch, k, way);
    const double square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
    if (square >= work->limit || square == 0)
        return;
    const double r = sqrt(square);
    const int pair = mf_composition_pair_of_ids(composition, (uint32_t)i, (uint32_t)j);
    const struct force_curve *const curve = &work->plan->equations.curve[curve_of_pair(pair)];
    add(work, i, curve, r, way, -sign / r, 0.5 * sign * r);
    add(work, j, curve, r, way, sign / r, 0.5 * sign * r);
    if (work->plan->weight)
        add_density(work, i, j, square, way, sign);
}

static bool is_looked_at(const struct work *work, size_t bead) {
    return bead >= work->forces->begin && bead < work->forces->end;
}

static void add_batch(void *context, const struct cell_pairs_batch *batch) {
    const struct work *const work = context;
    const struct frame_pairs_plan *const pairs = work->plan->pairs;
    const uint32_t *const bead = work->forces->search.cells.order;
    const size_t i = bead[batch->i];
    const bool apart = pairs->molecule && !pairs->within;
    double squares[CELL_PAIRS_BATCH];
    mf_cell_pairs_squares(batch, squares);
    for (size_t k = 0; k < batch->count; k++) {
        const size_t j = bead[batch->begin + k];
        if (squares[k] < work->limit && (is_looked_at(work, i) || is_looked_at(work, j)) &&
            !(apart && pairs->molecule[i] == pairs->molecule[j]))
            add_pair(work, batch, k, i, j, 1);
    }
}

/// Pairs that molecules exclude have been added with all others.
static void take_excluded(const struct work *work, int32_t *const place[3]) {
    const struct measured_molecules *const molecules = work->plan->molecules;
    for (size_t n = 0; work->plan->pairs->within && n < molecules->excluded_count; n++) {
        const uint32_t i = molecules->excluded[n][0], j = molecules->excluded[n][1];
        const struct cell_pairs_batch one = mf_cell_pairs_one(&work->forces->search, place, i, j);
        add_pair(work, &one, 0, i, j, -1);
    }
}

/// The arms of a term, and its q.
static void measure_term(const struct frame_forces *forces, const struct bonded_kind *kind,
                         const size_t *bead, int32_t *const place[3], struct bonded_batch *batch) {
    batch->count = 1;
    for (int a = 0; a < kind->arms; a++) {
        double way[3];
        const struct cell_pairs_batch one = mf_cell_pairs_one(
            &forces->search, place, bead[kind->arm[a].to], bead[kind->arm[a].from]);
        cell_pairs_vector(&one, 0, way);
        for (int d = 0; d < 3; d++)
            batch->arm[a][d][0] = way[d];
    }
    kind->measure(batch);
}

static void add_term(const struct work *work, int order, int group, const size_t *bead,
                     int32_t *const place[3]) {
    const struct bonded_kind *const kind = mf_bonded_kinds[order];
    const struct force_curve *const curve =
        &work->plan->equations.curve[curve_of_group(work->plan, order, group)];
    struct bonded_batch batch;
    measure_term(work->forces, kind, bead, place, &batch);
    const double q = batch.q[0];
    const double virial = kind->is_length ? 0.5 * q : 0; // angles do not change with the box
    batch.slope[0] = -1;                                 // of U, so that the force is 1
    kind->push(&batch);
    for (int a = 0; a < kind->arms; a++) {
        double way[3];
        bonded_take(batch.arm[a], 0, way);
        add(work, bead[kind->arm[a].from], curve, q, way, 1, virial);
        add(work, bead[kind->arm[a].to], curve, q, way, -1, virial);
    }
}

/// What is done with each term of a frame.
typedef void take_term(void *context, int order, int group, const size_t *bead);

static void visit_terms(const struct measured_molecules *molecules, take_term *take,
                        void *context) {
    const struct topology *const topology = &molecules->molecules->topology;
    for (int k = 0; k < topology->kinds; k++)
        for (int order = 0; order < BONDED_KINDS; order++)
            for (int n = 0; n < topology->kind[k].terms[order]; n++) {
                const struct topology_term *const term = &topology->kind[k].term[order][n];
                for (int64_t m = 0; m < topology->kind[k].count; m++) {
                    size_t bead[BONDED_MAX_TERM_BEADS];
                    for (int b = 0; b < mf_bonded_kinds[order]->beads; b++)
                        bead[b] =
                            molecules->bead[topology_id(&topology->kind[k], m, term->bead[b])];
                    take(context, order, term->group, bead);
                }
            }
}

struct terms {
    const struct work *work;
    int32_t *const *place;
};

static void add_one_term(void *context, int order, int group, const size_t *bead) {
    const struct terms *const terms = context;
    bool looked_at = false;
    for (int b = 0; b < mf_bonded_kinds[order]->beads; b++)
        looked_at = looked_at || is_looked_at(terms->work, bead[b]);
    if (looked_at)
        add_term(terms->work, order, group, bead, terms->place);
}

// G and b -----------------------------------------------------------------------------------------

/// The X of a bead where it is not 0: few of all unknowns where types are many.
struct own {
    size_t count, node[FORCES_MAX_NODES];
    double x[3][FORCES_MAX_NODES];
};

static void gather(const double *x, size_t size, struct own *own) {
    own->count = 0;
    for (size_t k = 0; k < size; k++) {
        if (x[k] == 0 && x[size + k] == 0 && x[2 * size + k] == 0)
            continue;
        own->node[own->count] = k;
        for (size_t d = 0; d < 3; d++)
            own->x[d][own->count] = x[d * size + k];
        own->count++;
    }
}

/// G += X·X of a bead, and b += X·F.
SIMD_CLONES static void add_products(const struct own *own, const double force[3],
                                     double *restrict gram, double *restrict product) {
    const double *const x = own->x[0], *const y = own->x[1], *const z = own->x[2];
    double sum[FORCES_MAX_NODES];
    for (size_t n = 0; n < own->count; n++) {
        const size_t k = own->node[n];
        double *const row = gram + k * (k + 1) / 2;
        product[k] += x[n] * force[0] + y[n] * force[1] + z[n] * force[2];
        for (size_t l = 0; l <= n; l++)
            sum[l] = x[n] * x[l] + y[n] * y[l] + z[n] * z[l];
        for (size_t l = 0; l <= n; l++)
            row[own->node[l]] += sum[l];
    }
}

static void sum_up(struct frame_forces *forces, const struct frame_forces_plan *plan,
                   const struct trajectory_frame *beads) {
    const size_t size = plan->equations.size;
    struct own own;
    for (size_t k = forces->begin; k < forces->end; k++) {
        const double *const force = beads->force[k];
        gather(forces->way + 3 * (k - forces->begin) * size, size, &own);
        add_products(&own, force, forces->gram, forces->product);
        forces->square += force[0] * force[0] + force[1] * force[1] + force[2] * force[2];
    }
}

enum status mf_frame_forces_find(struct frame_forces *forces, const struct frame_forces_plan *plan,
                                 const struct box_vectors *box,
                                 const struct trajectory_frame *beads, int32_t *const place[3],
                                 const double *density) {
    const size_t size = plan->equations.size, count = beads_of(plan);
    struct work work = {forces, plan, plan->cutoff * plan->cutoff};
    struct terms terms = {&work, place};
    TRY(reserve(forces, plan));
    TRY(mf_cell_pairs_sort(&forces->search, box, place, count, plan->cutoff));
    memset(forces->gram, 0, force_equations_entries(&plan->equations) * sizeof(double));
    memset(forces->product, 0, size * sizeof(double));
    memset(forces->virial, 0, size * sizeof(double));
    forces->square = 0;
    forces->density = density;
    for (forces->begin = 0; forces->begin < count; forces->begin = forces->end) {
        const size_t end = forces->begin + beads_at_once(plan);
        forces->end = end < count ? end : count;
        memset(forces->way, 0, 3 * (forces->end - forces->begin) * size * sizeof(double));
        mf_cell_pairs_visit(&forces->search, add_batch, &work);
        if (plan->molecules->molecules) {
            take_excluded(&work, place);
            visit_terms(plan->molecules, add_one_term, &terms);
        }
        sum_up(forces, plan, beads);
    }
    for (size_t k = 0; k < size; k++)
        forces->virial[k] /= 3 * box->volume;
    return STATUS_OK;
}

// Beginning ---------------------------------------------------------------------------------------

/// Nodes go beyond what a frame has by this much of its range, and of its largest value at least.
static const double beyond = 0.5, least_beyond = 0.1;

enum { NODES = 41 };

/// Where the terms of the groups are in a frame.
struct ranges {
    struct frame_forces forces; ///< whose search knows the box
    int32_t *const *place;
    double low[BONDED_KINDS][MOLECULES_MAX_GROUPS], high[BONDED_KINDS][MOLECULES_MAX_GROUPS];
};

static void stretch_range(void *context, int order, int group, const size_t *bead) {
    struct ranges *const ranges = context;
    struct bonded_batch batch;
    measure_term(&ranges->forces, mf_bonded_kinds[order], bead, ranges->place, &batch);
    ranges->low[order][group] = fmin(ranges->low[order][group], batch.q[0]);
    ranges->high[order][group] = fmax(ranges->high[order][group], batch.q[0]);
}

/// Nodes from below the least to above the largest value of a frame; all around of a circle.
static struct force_curve curve_of_terms(const struct ranges *ranges, int order, int group,
                                         const char *name) {
    enum { AROUND = 60 };
    const struct bonded_kind *const kind = mf_bonded_kinds[order];
    const double low = ranges->low[order][group], high = ranges->high[order][group];
    const double more = fmax(beyond * (high - low), least_beyond * fabs(high));
    const double begin = fmax(low - more, kind->scale * kind->low);
    const double end = fmin(high + more, kind->is_length ? INFINITY : kind->scale * kind->high);
    struct force_curve curve = {.order = order,
                                .number = group,
                                .low = kind->periodic ? kind->scale * kind->low : begin,
                                .width = kind->periodic ? 2 * M_PI / AROUND
                                                        : (end - begin) / (NODES - 1),
                                .nodes = kind->periodic ? AROUND : NODES};
    snprintf(curve.name, sizeof curve.name, "%s", name);
    return curve;
}

static enum status add_groups(const struct frame_forces_plan *plan, const struct box_vectors *box,
                              int32_t *const place[3], struct force_curve *curve, size_t *curves) {
    const struct molecules *const molecules = plan->molecules->molecules;
    struct ranges ranges = {.place = place};
    if (molecules == NULL)
        return STATUS_OK;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < MOLECULES_MAX_GROUPS; g++) {
            ranges.low[order][g] = INFINITY;
            ranges.high[order][g] = -INFINITY;
        }
    const enum status status =
        mf_cell_pairs_sort(&ranges.forces.search, box, place, beads_of(plan), plan->cutoff);
    if (status == STATUS_OK)
        visit_terms(plan->molecules, stretch_range, &ranges);
    for (int order = 0; status == STATUS_OK && order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++)
            curve[(*curves)++] = curve_of_terms(&ranges, order, g, molecules->group[order][g].name);
    mf_frame_forces_clear(&ranges.forces);
    return status;
}

/// Nodes from below the least to above the largest density of a frame.
static struct force_curve curve_of_density(const struct frame_forces_plan *plan,
                                           const double *density) {
    const struct weighted_density_settings *const weight = plan->weight;
    double low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < beads_of(plan); k++) {
        low = fmin(low, density[k]);
        high = fmax(high, density[k]);
    }
    const double more = fmax(beyond * (high - low), least_beyond * fmax(high, 1));
    struct force_curve curve = {.order = FORCES_OF_DENSITY,
                                .inner_cutoff = weight->inner_cutoff,
                                .cutoff = weight->cutoff,
                                .low = fmax(0, low - more),
                                .nodes = NODES};
    curve.width = (high + more - curve.low) / (NODES - 1);
    snprintf(curve.name, sizeof curve.name, "%.10g,%.10g", weight->inner_cutoff, weight->cutoff);
    return curve;
}

/// Nodes of a pair type where all have so many.
static size_t nodes_of_pairs(const struct frame_forces_plan *plan, size_t others) {
    const double pairs = (double)mf_composition_pairs(&plan->pairs->composition);
    const double most = floor(((double)FORCES_MAX_NODES - (double)others) / pairs);
    const double width = plan->pairs->range / (double)plan->pairs->bins;
    return (size_t)fmax(0, fmin(ceil(plan->cutoff / width - 1e-9) + 1, most));
}

static enum status check_forces(const struct frame_forces_plan *plan,
                                const struct trajectory_frame *beads) {
    const struct composition *const composition = &plan->pairs->composition;
    double square[COMPOSITION_MAX_TYPES] = {0}, sum = 0;
    for (size_t k = 0; k < beads->atoms; k++)
        for (int d = 0; d < 3; d++)
            square[mf_composition_type(composition, (uint32_t)k)] += pow(beads->force[k][d], 2);
    for (int type = 0; type < composition->types; type++)
        sum += square[type];
    if (!(sum > 0))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu: all forces are 0: --forces needs those of the "
                              "simulation (gmx mdrun with nstfout, LAMMPS's dump with fx fy fz)",
                              beads->file, beads->number);
    for (int type = 0; type < composition->types; type++)
        if (!(square[type] > 0))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: the forces of all beads \"%s\" are 0: --forces "
                                  "needs those of all atoms",
                                  beads->file, beads->number, composition->name[type]);
    return STATUS_OK;
}

enum status mf_frame_forces_begin(struct frame_forces_plan *plan, const struct box_vectors *box,
                                  const struct trajectory_frame *beads, int32_t *const place[3],
                                  const double *density) {
    enum { FEWEST = 8 };
    const struct composition *const composition = &plan->pairs->composition;
    OWNED struct force_curve *curve = NULL;
    size_t curves = (size_t)mf_composition_pairs(composition), others = 0;
    TRY(check_forces(plan, beads));
    TRY_ARRAY(curve, FORCES_MAX_CURVES);
    TRY(add_groups(plan, box, place, curve, &curves));
    if (plan->weight)
        curve[curves++] = curve_of_density(plan, density);
    for (size_t n = 0; n < curves; n++)
        others += curve[n].nodes;
    const size_t nodes = nodes_of_pairs(plan, others);
    if (nodes < FEWEST)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--forces: %zu pair types and groups are too many for %d unknowns: a "
                              "map (--map) with fewer types of beads has fewer",
                              curves, FORCES_MAX_NODES);
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        struct force_curve *const own = &curve[pair];
        *own = (struct force_curve){.order = FORCES_OF_PAIRS,
                                    .number = pair,
                                    .name = "-",
                                    .width = plan->cutoff / (double)(nodes - 1),
                                    .nodes = nodes};
        if (composition_is_mixed(composition))
            mf_composition_pair_name(composition, pair, own->name);
    }
    TRY_ARRAY(plan->pushed, beads->atoms);
    TRY(mf_force_equations_init(&plan->equations, curve, curves));
    plan->equations.beads = (double)beads->atoms;
    return STATUS_OK;
}

void mf_frame_forces_end(struct frame_forces_plan *plan) {
    mf_force_equations_clear(&plan->equations);
    mf_memory_free(plan->pushed);
    plan->pushed = NULL;
}
