// SPDX-License-Identifier: GPL-3.0-or-later
//
// Conformations that are drawn against the distributions of their laws, measured by vectors.
#include "forces/molecules_growth.h"

#include "base/memory.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { BINS = 24, BEADS = 8, MOLECULES = 4000 };
static const int type[64];
static const struct pair_law alone = {.composition = {.types = 1}, .temperature = 1.5};

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void between(const double from[3], const double to[3], double way[3]) {
    for (int d = 0; d < 3; d++)
        way[d] = to[d] - from[d];
}

/// q of beads that follow each other: a length, an angle, a dihedral by the formula of
/// A. Blondel and M. Karplus, J. Comput. Chem. 17, 1132 (1996).
static double measure(int order, const double (*place)[3]) {
    double a[3], b[3], c[3];
    between(place[0], place[1], a);
    if (order == BONDED_BOND)
        return sqrt(dot(a, a));
    between(place[1], place[2], b);
    if (order == BONDED_ANGLE)
        return acos(-dot(a, b) / sqrt(dot(a, a) * dot(b, b)));
    between(place[2], place[3], c);
    const double ab[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                          a[0] * b[1] - a[1] * b[0]};
    const double bc[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                          b[0] * c[1] - b[1] * c[0]};
    return atan2(sqrt(dot(b, b)) * dot(a, bc), dot(ab, bc));
}

/// What bends and twists, as the laws' formulas are known: angles about 100 degrees with k = 4,
/// dihedrals 3 (1 + cos(φ − 40 degrees)), which are not the same on both sides.
static double expected(int order, double q) {
    if (order == BONDED_BOND)
        return q * q * exp(-0.5 * 80 * pow(q - 0.6, 2) / alone.temperature);
    if (order == BONDED_ANGLE)
        return sin(q) * exp(-0.5 * 4 * pow(q - 100 * M_PI / 180, 2) / alone.temperature);
    return exp(-3 * (1 + cos(q - 40 * M_PI / 180)) / alone.temperature);
}

static const double low[] = {0, 0, -M_PI}, high[] = {1.4, M_PI, M_PI};

/// χ² per bin of drawn counts about those of the laws.
static double compare(int order, const double counts[BINS]) {
    enum { FINE = 100 };
    double part[BINS] = {0}, all = 0, sum = 0, chi = 0;
    const double width = (high[order] - low[order]) / BINS;
    for (int n = 0; n < BINS * FINE; n++) {
        part[n / FINE] += expected(order, low[order] + (n + 0.5) * width / FINE);
        all += expected(order, low[order] + (n + 0.5) * width / FINE);
    }
    for (int n = 0; n < BINS; n++)
        sum += counts[n];
    for (int n = 0; n < BINS; n++)
        chi += pow(counts[n] - sum * part[n] / all, 2) / fmax(sum * part[n] / all, 1) / BINS;
    return chi;
}

static void make_chains(struct molecules *molecules, int beads, int highest) {
    *molecules = (struct molecules){0};
    molecules_topology(&molecules->topology, molecules_chain(1, type, beads, highest, 3),
                       (struct topology_kind){0}, 1, NULL);
    molecules_add_group(molecules, BONDED_BOND, &mf_bond_harmonic,
                        (struct molecules_number[]){{"k", 80}, {"length", 0.6}, {NULL, 0}});
    molecules_add_group(molecules, BONDED_ANGLE, &mf_angle_harmonic,
                        (struct molecules_number[]){{"k", 4}, {"angle", 100}, {NULL, 0}});
    molecules_add_group(
        molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic,
        (struct molecules_number[]){{"k", 3}, {"multiplicity", 1}, {"phase", 40}, {NULL, 0}});
}

/// One in 10^4 of χ² of 24 bins, of 4000 · 7 and fewer numbers, is above 2.4.
static void test_chains_are_drawn_from_their_laws(void **state) {
    (void)state;
    struct molecules molecules;
    struct growth growth;
    double place[BEADS][3], counts[BONDED_KINDS][BINS] = {{0}};
    make_chains(&molecules, BEADS, BONDED_DIHEDRAL);
    assert_ok(mf_molecules_growth_init(&growth, &molecules, molecules.topology.kind, &alone, 3));
    for (uint32_t m = 0; m < MOLECULES; m++) {
        mf_molecules_growth_draw(&growth, 7, m, place);
        for (int order = 0; order < BONDED_KINDS; order++)
            for (int n = 0; n < BEADS - 1 - order; n++) {
                const double q = measure(order, (const double(*)[3])place + n);
                counts[order][(int)((q - low[order]) / (high[order] - low[order]) * BINS)]++;
            }
    }
    for (int order = 0; order < BONDED_KINDS; order++) {
        print_message("%s: %.2f\n", mf_bonded_kinds[order]->plural, compare(order, counts[order]));
        assert_true(compare(order, counts[order]) < 2.4);
    }
    mf_molecules_growth_clear(&growth);
    mf_molecules_clear(&molecules);
}

/// A star of four arms with angles between all of them: each arm but the first two is drawn by one
/// angle and chosen by the others.
static void test_branches_are_chosen_by_all_of_their_angles(void **state) {
    (void)state;
    struct molecules molecules = {0};
    struct growth growth;
    struct topology_kind star = molecules_chain(1, type, 5, BONDED_BOND, 3);
    for (int n = 0; n < 4; n++)
        star.term[BONDED_BOND][n] = (struct topology_term){{0, n + 1}, 0};
    star.terms[BONDED_ANGLE] = 6;
    star.term[BONDED_ANGLE] = mf_memory_zeroed(6, sizeof *star.term[0]);
    for (int a = 1, n = 0; a < 5; a++)
        for (int b = a + 1; b < 5; b++)
            star.term[BONDED_ANGLE][n++] = (struct topology_term){{a, 0, b}, 0};
    molecules_topology(&molecules.topology, star, (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic,
                        (struct molecules_number[]){{"k", 80}, {"length", 0.6}, {NULL, 0}});
    molecules_add_group(&molecules, BONDED_ANGLE, &mf_angle_harmonic,
                        (struct molecules_number[]){{"k", 60}, {"angle", 109.47}, {NULL, 0}});
    assert_ok(mf_molecules_growth_init(&growth, &molecules, molecules.topology.kind, &alone, 3));
    double worst = 0;
    for (uint32_t m = 0; m < 500; m++) {
        double place[5][3];
        mf_molecules_growth_draw(&growth, 3, m, place);
        for (int n = 0; n < 6; n++) {
            const int *bead = growth.kind->term[BONDED_ANGLE][n].bead;
            double three[3][3];
            for (int k = 0; k < 3; k++)
                memcpy(three[k], place[bead[k]], sizeof three[k]);
            worst +=
                pow(measure(BONDED_ANGLE, (const double(*)[3])three) - 109.47 * M_PI / 180, 2) /
                (6 * 500);
        }
    }
    print_message("rms of angles about a tetrahedron's: %.1f degrees\n", sqrt(worst) * 180 / M_PI);
    assert_true(sqrt(worst) < 15 * M_PI / 180); // sqrt(k_B T/k) is 9; free ones 39
    mf_molecules_growth_clear(&growth);
    mf_molecules_clear(&molecules);
}

/// A ring of 40 freely jointed bonds comes back within a few of them, and is as large as a random
/// walk that does: R_g² = N b²/12.
static void test_rings_come_back_to_where_they_began(void **state) {
    (void)state;
    enum { CORNERS = 40, RINGS = 200 };
    struct molecules molecules = {0};
    struct growth growth;
    struct topology_kind ring = molecules_chain(1, type, CORNERS, BONDED_BOND, 1);
    mf_memory_free(ring.term[BONDED_BOND]);
    ring.term[BONDED_BOND] = mf_memory_zeroed(CORNERS, sizeof *ring.term[0]);
    ring.terms[BONDED_BOND] = CORNERS;
    for (int n = 0; n < CORNERS; n++)
        ring.term[BONDED_BOND][n] = (struct topology_term){{n, (n + 1) % CORNERS}, 0};
    molecules_topology(&molecules.topology, ring, (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic,
                        (struct molecules_number[]){{"k", 800}, {"length", 1}, {NULL, 0}});
    assert_ok(mf_molecules_growth_init(&growth, &molecules, molecules.topology.kind, &alone, 3));
    double gap = 0, size = 0;
    for (uint32_t m = 0; m < RINGS; m++) {
        double place[CORNERS][3], ends[2][3], mean[3] = {0};
        mf_molecules_growth_draw(&growth, 3, m, place);
        memcpy(ends[0], place[0], sizeof ends[0]);
        memcpy(ends[1], place[CORNERS - 1], sizeof ends[1]);
        gap += measure(BONDED_BOND, (const double(*)[3])ends) / RINGS;
        for (int n = 0; n < CORNERS; n++)
            for (int d = 0; d < 3; d++)
                mean[d] += place[n][d] / CORNERS;
        for (int n = 0; n < CORNERS; n++)
            for (int d = 0; d < 3; d++)
                size += pow(place[n][d] - mean[d], 2) / (CORNERS * RINGS);
    }
    print_message("gap %.2f, R_g^2 %.2f\n", gap, size);
    assert_true(fabs(gap - 1) < 0.3);
    assert_true(fabs(size / (CORNERS / 12.0) - 1) < 0.2);
    mf_molecules_growth_clear(&growth);
    mf_molecules_clear(&molecules);
}

/// Stretched, coiled and free chains of eight: <R_e²> of free ones is (N − 1) <r²>.
static void test_chains_begin_stretched_or_coiled_when_asked(void **state) {
    (void)state;
    struct molecules molecules;
    struct growth growth;
    double size[3] = {0};
    make_chains(&molecules, BEADS, BONDED_BOND);
    assert_ok(mf_molecules_growth_init(&growth, &molecules, molecules.topology.kind, &alone, 3));
    for (int n = 0; n < 3; n++)
        for (uint32_t m = 0; m < 1000; m++) {
            double place[BEADS][3], way[3];
            growth.stretch = 0.7 * (n - 1);
            mf_molecules_growth_draw(&growth, 7, m, place);
            between(place[0], place[BEADS - 1], way);
            size[n] += dot(way, way) / 1000;
        }
    print_message("R_e^2 %.2f, %.2f, %.2f\n", size[0], size[1], size[2]);
    assert_true(fabs(size[1] / (7 * 0.452) - 1) < 0.1); // <r²> of r² exp(-k (r - l)²/2 k_B T)
    assert_true(size[0] < 0.8 * size[1] && size[2] > 1.25 * size[1]);
    mf_molecules_growth_clear(&growth);
    mf_molecules_clear(&molecules);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chains_are_drawn_from_their_laws),
        cmocka_unit_test(test_branches_are_chosen_by_all_of_their_angles),
        cmocka_unit_test(test_rings_come_back_to_where_they_began),
        cmocka_unit_test(test_chains_begin_stretched_or_coiled_when_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
