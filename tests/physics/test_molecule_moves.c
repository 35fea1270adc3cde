// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each kind of Metropolis moves of molecules alone, and all of them together, against integrals
// over the configurations that they reach: what the moves leave as it is is given, everything else
// is drawn from the exact distribution of free molecules (P. J. Flory, Statistical Mechanics of
// Chain Molecules, 1969), and weighed with exp(−U/T) of the pairs. So energies, orientations and
// sizes are known without any Markov chain.
#include "base/rng.h"
#include "base/statistics.h"
#include "curves/formula.h"
#include "dynamics/metropolis.h"
#include "forces/bonded.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

static const double temperature = 1.3, strength = 40; // Φ = strength (1 − r)²/2
static const double spring = 40, rest = 0.6, stiffness = 5, bent = 110, torsion = 1.5, phase = 70;

enum { MAX_BEADS = 6, VALUES = 4, BEADS_ALONE = MOLECULE_MOVES, ALL_MOVES };

/// One system and the moves that it is given.
struct example {
    const char *name;
    int dimensions;
    int molecules, beads; ///< of each molecule
    int highest;          ///< order of the terms of a chain
    bool ring, star;      ///< in place of a chain
    int exclude;          ///< bonds
    int move;             ///< enum molecule_move, BEADS_ALONE or ALL_MOVES
    double edge;          ///< of the box
};

// The exact side ----------------------------------------------------------------------------------

struct draw {
    const struct example *example;
    struct rng_sequence random;
    double start[2 * MAX_BEADS][3]; ///< where the Markov chain begins
    double x[2 * MAX_BEADS][3];
    double weight; ///< of what is not drawn exactly
};

static double uniform(struct draw *draw) {
    return mf_rng_sequence_uniform(&draw->random);
}

/// A number of a density that is at most 1, between two ends.
static double reject(struct draw *draw, double low, double high, int order) {
    for (;;) {
        const double q = low + (high - low) * uniform(draw);
        const int flat = draw->example->dimensions == 2;
        double energy, measure;
        if (order == BONDED_BOND) {
            energy = spring * pow(q - rest, 2) / 2;
            measure = pow(q / high, flat ? 1 : 2);
        } else if (order == BONDED_ANGLE) {
            energy = stiffness * pow(q - bent * M_PI / 180, 2) / 2;
            measure = sin(q);
        } else {
            energy = torsion * (1 + cos(2 * q - phase * M_PI / 180));
            measure = 1;
        }
        if (uniform(draw) < measure * exp(-energy / temperature))
            return q;
    }
}

static void draw_direction(struct draw *draw, double u[3]) {
    const double z = draw->example->dimensions == 2 ? 0 : 2 * uniform(draw) - 1;
    const double angle = 2 * M_PI * uniform(draw);
    u[0] = sqrt(1 - z * z) * cos(angle);
    u[1] = sqrt(1 - z * z) * sin(angle);
    u[2] = z;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double normalise(double a[3]) {
    const double length = sqrt(dot(a, a));
    for (int d = 0; d < 3; d++)
        a[d] /= length;
    return length;
}

/// The direction of the next bond of a chain: at an angle θ with the last one, turned by φ from
/// where the bond before it lies (φ = 0: cis).
static void turn(struct draw *draw, const double last[3], const double before[3], double theta,
                 double phi, double u[3]) {
    double side[3], normal[3];
    if (before) {
        for (int d = 0; d < 3; d++)
            side[d] = -(before[d] - dot(before, last) * last[d]);
    } else {
        draw_direction(draw, side);
        const double along = dot(side, last);
        for (int d = 0; d < 3; d++)
            side[d] -= along * last[d];
    }
    normalise(side);
    for (int d = 0; d < 3; d++)
        normal[d] = last[(d + 1) % 3] * side[(d + 2) % 3] - last[(d + 2) % 3] * side[(d + 1) % 3];
    for (int d = 0; d < 3; d++)
        u[d] = -cos(theta) * last[d] + sin(theta) * (cos(phi) * side[d] + sin(phi) * normal[d]);
}

/// A free molecule from its first bead on; a pivot keeps lengths of bonds.
static void draw_molecule(struct draw *draw, double (*x)[3], const double (*start)[3]) {
    const struct example *e = draw->example;
    double u[MAX_BEADS][3];
    for (int bead = 1; bead < e->beads; bead++) {
        const int parent = e->star ? 0 : bead - 1;
        const double length = e->move == MOLECULE_PIVOT
                                  ? sqrt(pow(start[bead][0] - start[parent][0], 2) +
                                         pow(start[bead][1] - start[parent][1], 2) +
                                         pow(start[bead][2] - start[parent][2], 2))
                                  : reject(draw, 0, 1.7, BONDED_BOND);
        if (bead == 1 || e->star || e->highest < BONDED_ANGLE) {
            draw_direction(draw, u[bead]);
        } else {
            const double theta = reject(draw, 0, M_PI, BONDED_ANGLE);
            const bool twisted = bead > 2 && e->highest == BONDED_DIHEDRAL;
            const double phi = twisted ? reject(draw, -M_PI, M_PI, BONDED_DIHEDRAL) : 0;
            turn(draw, u[bead - 1], twisted ? u[bead - 2] : NULL, theta, phi, u[bead]);
        }
        for (int d = 0; d < 3; d++)
            x[bead][d] = x[parent][d] + length * u[bead][d];
    }
    if (e->ring) {
        double apart[3];
        for (int d = 0; d < 3; d++)
            apart[d] = x[e->beads - 1][d] - x[0][d];
        draw->weight *= exp(-spring * pow(sqrt(dot(apart, apart)) - rest, 2) / 2 / temperature);
    }
}

/// Turn a molecule about its centre into an orientation that is uniform: for dumbbells.
static void draw_orientation(struct draw *draw, double (*x)[3], const double (*start)[3]) {
    double u[3], half[3], centre[3];
    draw_direction(draw, u);
    for (int d = 0; d < 3; d++) {
        half[d] = (start[1][d] - start[0][d]) / 2;
        centre[d] = (start[1][d] + start[0][d]) / 2;
    }
    const double length = sqrt(dot(half, half));
    for (int d = 0; d < 3; d++) {
        x[0][d] = centre[d] - length * u[d];
        x[1][d] = centre[d] + length * u[d];
    }
}

/// A configuration of molecules that do not see each other, with its weight.
static void draw_configuration(struct draw *draw) {
    const struct example *e = draw->example;
    memcpy(draw->x, draw->start, sizeof draw->x);
    draw->weight = 1;
    for (int m = 0; m < e->molecules; m++) {
        double(*x)[3] = draw->x + m * e->beads;
        const double(*start)[3] = (const double(*)[3])draw->start + m * e->beads;
        double shift[3] = {0};
        if (e->move == MOLECULE_ROTATE) {
            draw_orientation(draw, x, start);
            continue;
        }
        for (int d = 0; d < e->dimensions && e->move != MOLECULE_PIVOT; d++)
            shift[d] = e->edge * uniform(draw);
        for (int bead = 0; bead < e->beads; bead++)
            for (int d = 0; d < 3; d++)
                x[bead][d] += shift[d];
        if (e->move != MOLECULE_TRANSLATE)
            draw_molecule(draw, x, start);
    }
}

// What is measured --------------------------------------------------------------------------------

/// Φ of the pairs that are not excluded; the square of the cosine between the first bonds
/// of the first and the last molecule; the mean length of first bonds; and how far the ends of the
/// first molecule are apart, or of two molecules the cosine of the distance of their first beads.
static void measure(const struct example *e, double (*x)[3], double values[VALUES]) {
    double u[2][3] = {{0}}, length = 0, last[3];
    values[0] = 0;
    for (int i = 0; i < e->molecules * e->beads; i++)
        for (int j = 0; j < i; j++) {
            const int a = i % e->beads, b = j % e->beads;
            const bool bonded =
                i / e->beads == j / e->beads &&
                (e->star ? b == 0 : a - b == 1 || (e->ring && a - b == e->beads - 1));
            double square = 0;
            for (int d = 0; d < e->dimensions; d++)
                square += pow(box_nearest(x[i][d] - x[j][d], e->edge), 2);
            if ((!bonded || e->exclude == 0) && square < 1)
                values[0] += strength * pow(1 - sqrt(square), 2) / 2;
        }
    for (int m = 0; m < e->molecules; m++) {
        for (int d = 0; d < 3; d++)
            u[m][d] = d < e->dimensions
                          ? box_nearest(x[m * e->beads + 1][d] - x[m * e->beads][d], e->edge)
                          : 0;
        length += normalise(u[m]) / e->molecules;
    }
    values[1] = pow(dot(u[0], u[e->molecules - 1]), 2);
    values[2] = length;
    for (int d = 0; d < 3; d++)
        last[d] = d < e->dimensions ? box_nearest(x[e->beads - 1][d] - x[0][d], e->edge) : 0;
    values[3] = e->molecules == 1 ? sqrt(dot(last, last))
                                  : cos(2 * M_PI * (x[e->beads][0] - x[0][0]) / e->edge) +
                                        cos(2 * M_PI * (x[e->beads][1] - x[0][1]) / e->edge);
}

static void integrate(struct draw *draw, struct running_mean mean[VALUES]) {
    enum { BLOCKS = 40, SAMPLES = 10000 };
    for (int block = 0; block < BLOCKS; block++) {
        double sum[VALUES] = {0}, whole = 0;
        for (int sample = 0; sample < SAMPLES; sample++) {
            double values[VALUES];
            draw_configuration(draw);
            measure(draw->example, draw->x, values);
            const double weight = draw->weight * exp(-values[0] / temperature);
            whole += weight;
            for (int v = 0; v < VALUES; v++)
                sum[v] += weight * values[v];
        }
        for (int v = 0; v < VALUES; v++)
            mf_statistics_add(&mean[v], sum[v] / whole);
    }
}

// The Markov chain --------------------------------------------------------------------------------

static void add_term(struct topology_kind *kind, int order, int a, int b) {
    kind->term[order][kind->terms[order]++] = (struct topology_term){.bead = {a, b}};
}

static struct composition make_molecules(struct molecules *molecules, const struct example *e) {
    static const int type[MAX_BEADS] = {0};
    const struct molecules_number bond[] = {{"k", spring}, {"length", rest}, {NULL, 0}};
    const struct molecules_number bend[] = {{"k", stiffness}, {"angle", bent}, {NULL, 0}};
    const struct molecules_number twist[] = {
        {"k", torsion}, {"multiplicity", 2}, {"phase", phase}, {NULL, 0}};
    struct topology_kind kind =
        molecules_chain(e->molecules, type, e->beads, e->highest, e->exclude);
    if (e->ring || e->star) {
        mf_memory_free(kind.term[BONDED_BOND]);
        kind.term[BONDED_BOND] = mf_memory_zeroed(MAX_BEADS, sizeof(struct topology_term));
        kind.terms[BONDED_BOND] = 0;
        for (int bead = 1; bead < e->beads; bead++)
            add_term(&kind, BONDED_BOND, e->star ? 0 : bead - 1, bead);
        if (e->ring)
            add_term(&kind, BONDED_BOND, 0, e->beads - 1);
    }
    *molecules = (struct molecules){0};
    const struct composition composition =
        molecules_topology(&molecules->topology, kind, (struct topology_kind){0}, 1, NULL);
    molecules_add_group(molecules, BONDED_BOND, &mf_bond_harmonic, bond);
    if (e->highest >= BONDED_ANGLE)
        molecules_add_group(molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    if (e->highest == BONDED_DIHEDRAL)
        molecules_add_group(molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    return composition;
}

static void get_positions(const struct metropolis *metropolis, const struct example *e,
                          double (*x)[3]) {
    const struct topology_kind *kind = &metropolis->molecules.molecules->topology.kind[0];
    const struct particles *particles = &metropolis->particles;
    for (int m = 0; m < e->molecules; m++)
        for (int bead = 0; bead < e->beads; bead++)
            for (int d = 0; d < 3; d++)
                x[m * e->beads + bead][d] =
                    d < e->dimensions
                        ? particles->position[d][particles->place[topology_id(kind, m, bead)]]
                        : 0;
}

static void step(struct metropolis *metropolis, int move) {
    if (move == BEADS_ALONE) {
        assert_ok(mf_metropolis_move_beads(metropolis));
        metropolis->sweep++;
    } else if (move == ALL_MOVES) {
        assert_ok(mf_metropolis_run(metropolis, 1));
    } else {
        assert_ok(mf_molecule_moves_pass(metropolis, (enum molecule_move)move));
        metropolis->sweep++;
    }
}

static void sample(struct metropolis *metropolis, const struct example *e,
                   struct running_mean mean[VALUES]) {
    enum { BLOCKS = 40, SAMPLES = 1500, EVERY = 5 };
    for (int n = 0; n < 2000; n++)
        step(metropolis, e->move);
    for (int block = 0; block < BLOCKS; block++) {
        double sum[VALUES] = {0};
        for (int k = 0; k < SAMPLES; k++) {
            double x[2 * MAX_BEADS][3], values[VALUES];
            for (int n = 0; n < EVERY; n++)
                step(metropolis, e->move);
            get_positions(metropolis, e, x);
            measure(e, x, values);
            for (int v = 0; v < VALUES; v++)
                sum[v] += values[v];
        }
        for (int v = 0; v < VALUES; v++)
            mf_statistics_add(&mean[v], sum[v] / SAMPLES);
    }
}

/// Where rigid motions begin: two molecules within reach of each other, bonds of a chain as they
/// come.
static void begin(struct metropolis *metropolis, const struct example *e, struct draw *draw) {
    get_positions(metropolis, e, draw->start);
    for (int m = 0; m < e->molecules; m++) // whole
        for (int bead = 1; bead < e->beads; bead++)
            for (int d = 0; d < 3; d++) {
                const double *first = draw->start[m * e->beads];
                double *x = draw->start[m * e->beads + bead];
                x[d] = first[d] + box_nearest(x[d] - first[d], e->edge);
            }
}

/// 50 numbers that scatter, with errors of 40 blocks: one is off by 4.8 of them once in 1000 seeds.
static void check(const struct example *e) {
    struct molecules molecules;
    struct metropolis metropolis;
    struct table table;
    struct formula_soft_repulsion_parameters soft = {strength, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &soft};
    const struct box box = {e->dimensions, {e->edge, e->edge, e->dimensions == 2 ? 1 : e->edge}};
    struct running_mean exact[VALUES] = {{0}}, found[VALUES] = {{0}};
    struct draw draw = {.example = e, .random = mf_rng_sequence_begin(11, RNG_INITIAL, 3, 4)};
    const struct composition composition = make_molecules(&molecules, e);
    assert_ok(mf_table_init_potential(&table, &curve));
    assert_ok(mf_metropolis_init(&metropolis, &box, &composition, &table, temperature, 7));
    assert_ok(mf_metropolis_join(&metropolis, &molecules));
    assert_ok(mf_metropolis_run(&metropolis, 50)); // somewhere
    for (int move = 0; move < MOLECULE_MOVES; move++)
        metropolis.molecules.tally[move].step = move == MOLECULE_TRANSLATE ? 0.15 : 1.2;
    begin(&metropolis, e, &draw);
    sample(&metropolis, e, found);
    integrate(&draw, exact);
    for (int v = 0; v < VALUES; v++) {
        const double error = sqrt(pow(mf_statistics_standard_error(&exact[v]), 2) +
                                  pow(mf_statistics_standard_error(&found[v]), 2));
        print_message("%s %d: %.5f, exact %.5f, apart by %.2f standard errors (%.5f)\n", e->name, v,
                      found[v].mean, exact[v].mean, (found[v].mean - exact[v].mean) / error, error);
        assert_close(found[v].mean, exact[v].mean, 4.8 * error + 1e-9);
    }
    mf_metropolis_clear(&metropolis);
    mf_molecules_clear(&molecules);
    mf_table_clear(&table);
}

static void test_each_move_alone_leaves_dumbbells_in_equilibrium(void **state) {
    (void)state;
    for (int move = 0; move <= ALL_MOVES; move++) {
        static const char *const names[] = {"translate", "rotate", "pivot", "beads", "all"};
        const double edge = move == MOLECULE_PIVOT ? 4.2 : 3; // four times as long as what turns
        check(&(struct example){names[move], 3, 2, 2, BONDED_BOND, .move = move, .edge = edge});
    }
}

static void test_moves_leave_flat_dumbbells_in_equilibrium(void **state) {
    (void)state;
    check(&(struct example){"flat, rotate", 2, 2, 2, .exclude = 1, .move = MOLECULE_ROTATE,
                            .edge = 3});
    check(&(struct example){"flat, all", 2, 2, 2, .exclude = 1, .move = ALL_MOVES, .edge = 3});
}

static void test_moves_leave_chains_that_meet_themselves_in_equilibrium(void **state) {
    (void)state;
    check(&(struct example){"chain, pivot", 3, 1, 5, BONDED_DIHEDRAL, .exclude = 1,
                            .move = MOLECULE_PIVOT, .edge = 12});
    check(&(struct example){"chain, beads", 3, 1, 5, BONDED_DIHEDRAL, .exclude = 1,
                            .move = BEADS_ALONE, .edge = 12});
    check(&(struct example){"chain, all", 3, 1, 6, BONDED_DIHEDRAL, .exclude = 1, .move = ALL_MOVES,
                            .edge = 12});
}

static void test_moves_leave_stars_and_rings_in_equilibrium(void **state) {
    (void)state;
    check(&(struct example){"star, pivot", 3, 1, 5, .star = true, .exclude = 1,
                            .move = MOLECULE_PIVOT, .edge = 6});
    check(&(struct example){"ring, all", 3, 2, 4, .ring = true, .exclude = 1, .move = ALL_MOVES,
                            .edge = 6});
}

/// A bond that tears has p(r) ~ r² (1 − (r/R)²)^(k R²/2T): (r/R)² is of a beta distribution, whose
/// mean is 3/2 over 5/2 + k R²/2T. 200 dumbbells, whose scatter is the error: 4 of them, one in
/// 16,000 seeds.
static void test_bonds_that_tear_stay_whole_in_equilibrium(void **state) {
    (void)state;
    enum { DUMBBELLS = 200 };
    static const int type[2] = {0};
    static const double k = 2, longest = 1.5;
    const struct molecules_number fene[] = {{"k", k}, {"longest", longest}, {NULL, 0}};
    const struct box box = {3, {8, 8, 8}};
    struct molecules molecules = {0};
    struct metropolis metropolis;
    struct running_mean all = {0};
    const struct composition composition =
        molecules_topology(&molecules.topology, molecules_chain(DUMBBELLS, type, 2, BONDED_BOND, 1),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_fene, fene);
    assert_ok(mf_metropolis_init(&metropolis, &box, &composition, NULL, temperature, 7));
    assert_ok(mf_metropolis_join(&metropolis, &molecules));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 300));
    for (int m = 0; m < DUMBBELLS; m++) {
        double sum = 0;
        for (int n = 0; n < 100; n++) {
            int32_t place[2];
            double r;
            if (m == 0 || n > 0)
                assert_ok(mf_metropolis_run(&metropolis, 1));
            for (int bead = 0; bead < 2; bead++)
                place[bead] = (int32_t)metropolis.particles
                                  .place[topology_id(&molecules.topology.kind[0], m, bead)];
            mf_bonded_measure(BONDED_BOND, 1, place, &metropolis.particles, &r);
            assert_true(r < longest);
            sum += r * r / (longest * longest) / 100;
        }
        mf_statistics_add(&all, sum);
    }
    const double exact = 1.5 / (2.5 + k * longest * longest / (2 * temperature));
    const double error = mf_statistics_standard_error(&all);
    print_message("fene: (r/R)^2 %.4f(%.4f), exact %.4f\n", all.mean, error, exact);
    assert_close(all.mean, exact, 4 * error);
    mf_metropolis_clear(&metropolis);
    mf_molecules_clear(&molecules);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_move_alone_leaves_dumbbells_in_equilibrium),
        cmocka_unit_test(test_moves_leave_flat_dumbbells_in_equilibrium),
        cmocka_unit_test(test_moves_leave_chains_that_meet_themselves_in_equilibrium),
        cmocka_unit_test(test_bonds_that_tear_stay_whole_in_equilibrium),
        cmocka_unit_test(test_moves_leave_stars_and_rings_in_equilibrium),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
