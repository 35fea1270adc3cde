// SPDX-License-Identifier: GPL-3.0-or-later
//
// No two rings of molecules begin linked. Links are counted by Gauss's integral over both curves,
// for straight bonds a sum of solid angles (K. Klenin and J. Langowski, Biopolymers 54, 307 (2000),
// method 1a), over rings that are written down here bead by bead.
#include "base/memory.h"
#include "dynamics/hybrid.h"
#include "dynamics/metropolis.h"
#include "dynamics/relax.h"
#include "dynamics/relax_molecules.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { MAX_BEADS = 40, KINDS = 2, MAX_CYCLES = 2 };

/// A kind's bonds, and its rings, which are closed from the last bead to the first.
struct plan {
    int64_t count;
    int beads, bonds, cycles;
    bool fused;
    int bond[2 * MAX_BEADS][2];
    int length[MAX_CYCLES], cycle[MAX_CYCLES][MAX_BEADS];
};

static void add_bond(struct plan *plan, int from, int to) {
    plan->bond[plan->bonds][0] = from;
    plan->bond[plan->bonds++][1] = to;
}

/// A ring of the beads from `first` on.
static void add_ring(struct plan *plan, int first, int beads) {
    for (int k = 0; k < beads; k++) {
        add_bond(plan, first + k, first + (k + 1) % beads);
        plan->cycle[plan->cycles][k] = first + k;
    }
    plan->length[plan->cycles++] = beads;
}

static struct plan plan_ring(int64_t count, int beads) {
    struct plan plan = {.count = count, .beads = beads};
    add_ring(&plan, 0, beads);
    return plan;
}

/// Two rings of six that share a bond, as in naphthalene.
static struct plan plan_fused(int64_t count) {
    struct plan plan = {.count = count, .beads = 10, .fused = true};
    static const int half[2][6] = {{0, 1, 2, 3, 4, 5}, {0, 5, 6, 7, 8, 9}};
    add_ring(&plan, 0, 10);
    add_bond(&plan, 0, 5);
    plan.cycles = 2;
    for (int n = 0; n < 2; n++) {
        plan.length[n] = 6;
        memcpy(plan.cycle[n], half[n], sizeof half[n]);
    }
    return plan;
}

/// A triangle and a ring of eight at the ends of a chain.
static struct plan plan_joined(int64_t count) {
    struct plan plan = {.count = count, .beads = 14};
    add_ring(&plan, 0, 3);
    for (int k = 2; k < 6; k++)
        add_bond(&plan, k, k + 1);
    add_ring(&plan, 6, 8);
    return plan;
}

struct melt {
    struct plan plan[KINDS];
    struct fluid fluid;
    struct composition composition;
    struct molecules molecules;
};

static struct topology_kind make_kind(const struct plan *plan) {
    static const int type[MAX_BEADS] = {0};
    struct topology_kind kind = molecules_chain(plan->count, type, plan->beads, -1, 0);
    kind.terms[BONDED_BOND] = plan->bonds;
    kind.term[BONDED_BOND] = mf_memory_zeroed((size_t)plan->bonds, sizeof *kind.term[BONDED_BOND]);
    for (int n = 0; n < plan->bonds; n++)
        memcpy(kind.term[BONDED_BOND][n].bead, plan->bond[n], sizeof plan->bond[n]);
    return kind;
}

/// Lennard-Jones beads whose bonds are as long as they are wide.
static void make_melt(struct melt *melt, struct plan first, struct plan second, double density) {
    static const struct molecules_number spring[] = {{"k", 500}, {"length", 1}, {NULL, 0}};
    *melt = (struct melt){.plan = {first, second}};
    melt->composition = molecules_topology(
        &melt->molecules.topology, make_kind(&melt->plan[0]),
        second.count > 0 ? make_kind(&melt->plan[1]) : (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&melt->molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    const int64_t count = mf_composition_particles(&melt->composition);
    fluid_lennard_jones(&melt->fluid, count, 0.002);
    struct simulation_setup *setup = &melt->fluid.setup;
    setup->temperature = 2.5;
    for (int d = 0; d < 3; d++)
        setup->box.length[d] = cbrt((double)count / density);
    molecules_enter(setup, &melt->molecules, &melt->composition);
}

static void clear_melt(struct melt *melt) {
    mf_molecules_clear(&melt->molecules);
    fluid_clear(&melt->fluid);
}

// Gauss's integral --------------------------------------------------------------------------------

typedef double vector[3];

static void cross(const vector a, const vector b, vector product) {
    for (int d = 0; d < 3; d++)
        product[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

static double dot(const vector a, const vector b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const vector a, const vector b, vector difference) {
    for (int d = 0; d < 3; d++)
        difference[d] = a[d] - b[d];
}

/// What the straight bonds from a to b and from p to q add to 4 π times the linking number.
static double solid_angle(const vector a, const vector b, const vector p, const vector q) {
    vector to[4], normal[4], one, other, both;
    subtract(p, a, to[0]);
    subtract(q, a, to[1]);
    subtract(q, b, to[2]);
    subtract(p, b, to[3]);
    double angle = 0;
    for (int n = 0; n < 4; n++) {
        cross(to[n], to[(n + 1) % 4], normal[n]);
        const double length = sqrt(dot(normal[n], normal[n]));
        for (int d = 0; d < 3; d++)
            normal[n][d] /= length;
    }
    for (int n = 0; n < 4; n++)
        angle += asin(fmax(-1, fmin(1, dot(normal[n], normal[(n + 1) % 4]))));
    subtract(b, a, one);
    subtract(q, p, other);
    cross(other, one, both);
    return dot(both, to[0]) > 0 ? angle : -angle;
}

/// A ring made whole, and where it is.
struct curve_of_beads {
    int kind, beads;
    int64_t molecule;
    vector at[MAX_BEADS], centre;
};

static double linking_number(const struct curve_of_beads *one, const struct curve_of_beads *other,
                             const vector shift) {
    double sum = 0;
    for (int k = 0; k < one->beads; k++)
        for (int n = 0; n < other->beads; n++) {
            vector p, q;
            for (int d = 0; d < 3; d++) {
                p[d] = other->at[n][d] + shift[d];
                q[d] = other->at[(n + 1) % other->beads][d] + shift[d];
            }
            sum += solid_angle(one->at[k], one->at[(k + 1) % one->beads], p, q);
        }
    return sum / (4 * M_PI);
}

/// Follow a ring's bonds from bead to bead. Returns whether it ends where it began.
static bool follow(const struct melt *melt, const struct particles *particles, int kind, int64_t m,
                   int cycle, struct curve_of_beads *curve) {
    const struct plan *plan = &melt->plan[kind];
    double gap = 0;
    *curve = (struct curve_of_beads){.kind = kind, .beads = plan->length[cycle], .molecule = m};
    for (int d = 0; d < 3; d++) {
        double x = 0, before = 0;
        for (int k = 0; k <= curve->beads; k++) {
            const int bead = plan->cycle[cycle][k % curve->beads];
            const double now = particles->position[d][particles->place[topology_id(
                &melt->molecules.topology.kind[kind], m, bead)]];
            x = k == 0 ? now : x + box_nearest(now - before, particles->box.length[d]);
            before = now;
            if (k == curve->beads)
                gap = fmax(gap, fabs(x - curve->at[0][d]));
            else
                curve->at[k][d] = x;
        }
        for (int k = 0; k < curve->beads; k++)
            curve->centre[d] += curve->at[k][d] / curve->beads;
    }
    return gap < 1e-6;
}

/// Whether rings are of one molecule and share beads.
static bool share_beads(const struct melt *melt, const struct curve_of_beads *one,
                        const struct curve_of_beads *other) {
    return one->kind == other->kind && one->molecule == other->molecule &&
           melt->plan[one->kind].fused;
}

/// Pairs of linked rings, by the images nearest to each other, and rings that close only around
/// the box.
static int count_links(const struct melt *melt, const struct particles *particles, int *wound) {
    int curves = 0, links = 0;
    int64_t all = 0;
    *wound = 0;
    for (int kind = 0; kind < KINDS; kind++)
        all += melt->plan[kind].count * melt->plan[kind].cycles;
    struct curve_of_beads *curve = mf_memory_zeroed((size_t)all, sizeof *curve);
    for (int kind = 0; kind < KINDS; kind++)
        for (int64_t m = 0; m < melt->plan[kind].count; m++)
            for (int cycle = 0; cycle < melt->plan[kind].cycles; cycle++)
                *wound += !follow(melt, particles, kind, m, cycle, &curve[curves++]);
    for (int i = 0; i < curves; i++)
        for (int j = 0; j < i; j++) {
            vector shift;
            for (int d = 0; d < 3; d++) {
                const double apart = curve[j].centre[d] - curve[i].centre[d];
                shift[d] = box_nearest(apart, particles->box.length[d]) - apart;
            }
            if (share_beads(melt, &curve[i], &curve[j]))
                continue;
            const double number = linking_number(&curve[i], &curve[j], shift);
            assert_close(number, round(number), 1e-6); // what an integral knows of itself
            links += fabs(number) > 0.5;
        }
    mf_memory_free(curve);
    return links;
}

/// Two squares at right angles: linked one way round, the other way round, and side by side.
static void test_linking_number_is_known_for_two_squares(void **state) {
    (void)state;
    const struct curve_of_beads flat = {.beads = 4,
                                        .at = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
    const struct curve_of_beads upright = {
        .beads = 4, .at = {{0, 0.1, -1}, {2, 0.1, -1}, {2, 0.1, 1}, {0, 0.1, 1}}};
    const double linked = linking_number(&flat, &upright, (vector){0, 0, 0});
    assert_close(fabs(linked), 1, 1e-6);
    assert_close(linking_number(&flat, &upright, (vector){-1.5, 0, 0}), -linked, 1e-6);
    assert_close(linking_number(&flat, &upright, (vector){1.5, 0, 0}), 0, 1e-6);
}

// Where scenes and samplers begin -----------------------------------------------------------------

static void check_particles(const struct melt *melt, const struct particles *particles) {
    int wound;
    const int links = count_links(melt, particles, &wound);
    print_message("%d links, %d rings around the box\n", links, wound);
    assert_int_equal(links, 0);
    assert_int_equal(wound, 0);
}

static void check_scene(struct melt *melt, uint64_t seed) {
    struct simulation simulation;
    melt->fluid.setup.seed = seed;
    assert_ok(mf_simulation_init(&simulation, &melt->fluid.setup, NULL));
    check_particles(melt, &simulation.particles);
    mf_simulation_clear(&simulation);
}

static void test_scene_begins_without_links_when_molecules_are_rings(void **state) {
    (void)state;
    struct melt melt;
    make_melt(&melt, plan_ring(120, 6), (struct plan){0}, 0.6);
    check_scene(&melt, 1);
    check_scene(&melt, 112);
    clear_melt(&melt);
}

static void test_scene_begins_without_links_when_rings_are_fused_and_joined(void **state) {
    (void)state;
    struct melt melt;
    make_melt(&melt, plan_fused(40), plan_joined(30), 0.8);
    check_scene(&melt, 3);
    clear_melt(&melt);
}

/// As wide as the box when they are placed: some close around it, others are linked.
static void test_scene_begins_without_links_when_rings_are_large(void **state) {
    (void)state;
    struct melt melt;
    make_melt(&melt, plan_ring(12, MAX_BEADS), (struct plan){0}, 0.85);
    check_scene(&melt, 1);
    check_scene(&melt, 2);
    clear_melt(&melt);
}

static void test_samplers_begin_without_links(void **state) {
    (void)state;
    struct melt melt;
    make_melt(&melt, plan_ring(120, 6), (struct plan){0}, 0.6);
    const struct simulation_setup *setup = &melt.fluid.setup;
    struct hybrid hybrid;
    assert_ok(mf_hybrid_init(&hybrid, &setup->box, &melt.composition, setup->potential,
                             &melt.molecules, NULL, &(struct pair_histogram){0}, setup->temperature,
                             5, NULL));
    check_particles(&melt, &hybrid.simulation.particles);
    assert_ok(mf_hybrid_scatter(&hybrid));
    check_particles(&melt, &hybrid.simulation.particles);
    mf_hybrid_clear(&hybrid);
    struct metropolis metropolis;
    assert_ok(mf_metropolis_init(&metropolis, &setup->box, &melt.composition, setup->potential,
                                 setup->temperature, 6));
    assert_ok(mf_metropolis_join(&metropolis, &melt.molecules));
    check_particles(&melt, &metropolis.particles);
    mf_metropolis_clear(&metropolis);
    clear_melt(&melt);
}

// Same bits ---------------------------------------------------------------------------------------

static void check_same(const struct particles *one, const struct particles *other) {
    for (int d = 0; d < 3; d++)
        assert_memory_equal(one->position[d], other->position[d], one->count * sizeof(double));
}

static void test_rings_begin_with_the_same_bits_when_there_are_threads(void **state) {
    (void)state;
    struct melt melt;
    struct simulation alone, shared;
    make_melt(&melt, plan_ring(120, 6), (struct plan){0}, 0.6);
    assert_ok(mf_simulation_init(&alone, &melt.fluid.setup, NULL));
    melt.fluid.setup.threads = 2;
    assert_ok(mf_simulation_init(&shared, &melt.fluid.setup, NULL));
    check_same(&alone.particles, &shared.particles);
    mf_simulation_clear(&alone);
    mf_simulation_clear(&shared);
    clear_melt(&melt);
}

/// Molecules without rings begin where the other steps have left them.
static void test_chains_begin_where_overlaps_are_parted(void **state) {
    (void)state;
    struct melt melt;
    struct simulation begun, parted;
    struct plan chain = plan_ring(60, 10);
    chain.bonds--;
    chain.cycles = 0;
    make_melt(&melt, chain, (struct plan){0}, 0.7);
    assert_ok(mf_simulation_init(&begun, &melt.fluid.setup, NULL));
    assert_ok(mf_simulation_init(&parted, &melt.fluid.setup, NULL));
    struct simulation *both[] = {&begun, &parted};
    for (int n = 0; n < 2; n++) {
        for (size_t k = 0; k < both[n]->particles.count; k++)
            both[n]->particles.id[k] = (uint32_t)k;
        assert_ok(mf_molecules_place(&melt.molecules, &both[n]->law, &both[n]->particles,
                                     &melt.fluid.setup.placement, 8));
        assert_ok(mf_neighbours_sort_and_build(&both[n]->neighbours, &both[n]->particles));
    }
    assert_ok(mf_relax_molecules(&begun));
    assert_ok(mf_relax_soft(&parted));
    assert_ok(mf_relax_overlaps(&parted));
    check_same(&begun.particles, &parted.particles);
    mf_simulation_clear(&begun);
    mf_simulation_clear(&parted);
    clear_melt(&melt);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linking_number_is_known_for_two_squares),
        cmocka_unit_test(test_scene_begins_without_links_when_molecules_are_rings),
        cmocka_unit_test(test_scene_begins_without_links_when_rings_are_fused_and_joined),
        cmocka_unit_test(test_scene_begins_without_links_when_rings_are_large),
        cmocka_unit_test(test_samplers_begin_without_links),
        cmocka_unit_test(test_rings_begin_with_the_same_bits_when_there_are_threads),
        cmocka_unit_test(test_chains_begin_where_overlaps_are_parted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
