// SPDX-License-Identifier: GPL-3.0-or-later
//
// Normal equations of a frame against the obvious sums: pairs of a mixture in a tilted box, fewer
// beads at a time than there are; a local density against differences of its energy; forces that
// are of no use.
#include "base/rng.h"
#include "measure/frame_forces.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { MOST = 3000 };

struct system {
    struct trajectory_frame frame;
    struct box_vectors box;
    struct composition composition;
    struct frame_pairs_plan pairs;
    struct measured_molecules none;
    struct frame_forces_plan plan;
    double position[MOST][3], force[MOST][3];
    int32_t memory[3][MOST], *place[3];
};

static const double tilted[3][3] = {{5, 0, 0}, {1, 4.5, 0}, {-1, 1.4, 5}};

/// Beads anywhere, with any forces.
static struct system *make_system(const struct composition *composition, double cutoff, int bins) {
    struct system *s = calloc(1, sizeof *s);
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_PLACEMENT, 0, 0);
    s->pairs = (struct frame_pairs_plan){
        .range = cutoff, .bins = (size_t)bins, .composition = *composition};
    s->frame = (struct trajectory_frame){.atoms = (size_t)mf_composition_particles(composition),
                                         .position = s->position,
                                         .force = s->force,
                                         .has_forces = true,
                                         .file = "x"};
    mf_frame_set_box(&s->frame, tilted);
    for (size_t k = 0; k < s->frame.atoms; k++)
        for (int d = 0; d < 3; d++) {
            const double fraction = mf_rng_sequence_uniform(&random);
            for (int e = 0; e < 3; e++)
                s->position[k][e] += fraction * tilted[d][e];
            s->force[k][d] = mf_rng_sequence_uniform(&random) - 0.5;
        }
    for (int i = 0; i < 3; i++)
        s->place[i] = s->memory[i];
    assert_ok(mf_frame_box_find(&s->box, &s->frame));
    assert_ok(mf_frame_box_places(&s->box, &s->frame, s->place));
    s->plan =
        (struct frame_forces_plan){.cutoff = cutoff, .pairs = &s->pairs, .molecules = &s->none};
    assert_ok(mf_frame_forces_begin(&s->plan, &s->box, &s->frame, s->place, NULL));
    return s;
}

static void clear(struct system *s) {
    mf_frame_forces_end(&s->plan);
    free(s);
}

/// The way from i to the nearest image of j.
static void find_way(const struct system *s, size_t i, size_t j, double way[3]) {
    double best = INFINITY;
    for (int a = -2; a <= 2; a++)
        for (int b = -2; b <= 2; b++)
            for (int c = -2; c <= 2; c++) {
                double own[3], square = 0;
                for (int d = 0; d < 3; d++) {
                    own[d] = s->position[j][d] - s->position[i][d] + a * tilted[0][d] +
                             b * tilted[1][d] + c * tilted[2][d];
                    square += own[d] * own[d];
                }
                if (square < best) {
                    best = square;
                    for (int d = 0; d < 3; d++)
                        way[d] = own[d];
                }
            }
}

/// X of all beads, shape [beads, 3, unknowns]: hats about nodes k h.
static double *find_all(const struct system *s) {
    const struct force_equations *const e = &s->plan.equations;
    double *all = calloc(s->frame.atoms * 3 * e->size, sizeof *all);
    for (size_t i = 0; i < s->frame.atoms; i++)
        for (size_t j = 0; j < s->frame.atoms; j++) {
            double way[3] = {0};
            if (i == j)
                continue;
            find_way(s, i, j, way);
            const double r = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
            const int pair =
                mf_composition_pair_of_ids(&s->pairs.composition, (uint32_t)i, (uint32_t)j);
            const struct force_curve *const curve = &e->curve[pair];
            for (size_t k = 0; k < curve->nodes && r < s->plan.cutoff; k++) {
                const double hat = 1 - fabs(r / curve->width - (double)k);
                for (int d = 0; hat > 0 && d < 3; d++)
                    all[(i * 3 + (size_t)d) * e->size + curve->first + k] -= hat * way[d] / r;
            }
        }
    return all;
}

/// Some entries of G, and all of b.
static void assert_sums(const struct system *s, const struct frame_forces *forces, size_t stride) {
    const size_t size = s->plan.equations.size, rows = 3 * s->frame.atoms;
    double *const all = find_all(s);
    for (size_t k = 0; k < size; k += stride) {
        double sum = 0;
        for (size_t row = 0; row < rows; row++)
            sum += all[row * size + k] * s->force[row / 3][row % 3];
        assert_close(forces->product[k], sum, 1e-5 * (1 + fabs(sum)));
        for (size_t l = 0; l <= k; l += stride) {
            sum = 0;
            for (size_t row = 0; row < rows; row++)
                sum += all[row * size + k] * all[row * size + l];
            assert_close(forces->gram[k * (k + 1) / 2 + l], sum, 1e-5 * (1 + fabs(sum)));
        }
    }
    free(all);
}

static void test_pairs_against_the_obvious_sums(void **state) {
    static const struct composition kinds[] = {
        {.types = 1, .count = {90}},
        {.types = 2, .count = {60, 50}, .name = {"A", "B"}},
    };
    (void)state;
    for (int n = 0; n < 2; n++) {
        struct system *const s = make_system(&kinds[n], 2.1, 30);
        struct frame_forces forces = {0};
        assert_int_equal(s->plan.equations.size, 31 * (n == 0 ? 1 : 3));
        for (int again = 0; again < 2; again++)
            assert_ok(mf_frame_forces_find(&forces, &s->plan, &s->box, &s->frame, s->place, NULL));
        assert_sums(s, &forces, 1);
        mf_frame_forces_clear(&forces);
        clear(s);
    }
}

/// Nodes are wider where types are many, and X of 2800 beads does not fit at once.
static void test_beads_some_at_a_time(void **state) {
    static const struct composition many = {
        .types = 3, .count = {1000, 900, 900}, .name = {"A", "B", "C"}};
    (void)state;
    struct system *const s = make_system(&many, 1.2, 400);
    struct frame_forces forces = {0};
    assert_int_equal(s->plan.equations.size, FORCES_MAX_NODES);
    assert_ok(mf_frame_forces_find(&forces, &s->plan, &s->box, &s->frame, s->place, NULL));
    assert_true(forces.begin == s->frame.atoms && forces.end == s->frame.atoms);
    assert_sums(s, &forces, 37);
    mf_frame_forces_clear(&forces);
    clear(s);
}

/// T. Sanyal and M. S. Shell, J. Chem. Phys. 145, 034109 (2016), eq. 3.
static double weight(double r, double r0, double rc) {
    const double x = r0 * r0 / (rc * rc), d = pow(1 - x, 3), u = r * r / (rc * rc);
    if (r <= r0 || r >= rc)
        return r < rc;
    return ((1 - 3 * x) + 6 * x * u - 3 * (1 + x) * u * u + 2 * u * u * u) / d;
}

/// With f' = 3 − 0.4 ρ, which straight lines between nodes are; ρ of all beads into `density`.
static double energy_of_densities(const struct system *s, double *density) {
    double energy = 0;
    for (size_t i = 0; i < s->frame.atoms; i++) {
        density[i] = 0;
        for (size_t j = 0; j < s->frame.atoms; j++) {
            double way[3] = {0};
            if (i == j)
                continue;
            find_way(s, i, j, way);
            density[i] += weight(sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]), 0.6, 2);
        }
        energy += 3 * density[i] - 0.2 * density[i] * density[i];
    }
    return energy;
}

/// The forces of an energy of densities, by its differences, are those of its nodes: b = G c, and
/// Σ F² = c·b.
static void test_a_density_by_differences_of_its_energy(void **state) {
    static const struct composition one = {.types = 1, .count = {60}};
    static const struct weighted_density_settings settings = {.inner_cutoff = 0.6, .cutoff = 2};
    const double small = 1e-4;
    double density[60];
    struct frame_forces forces = {0};
    (void)state;
    struct system *const s = make_system(&one, 2.1, 10);
    for (size_t k = 0; k < 60; k++)
        for (int d = 0; d < 3; d++) {
            s->position[k][d] += small;
            s->force[k][d] = -energy_of_densities(s, density);
            s->position[k][d] -= 2 * small;
            s->force[k][d] = (s->force[k][d] + energy_of_densities(s, density)) / (2 * small);
            s->position[k][d] += small;
        }
    energy_of_densities(s, density);
    mf_frame_forces_end(&s->plan);
    s->plan.weight = &settings;
    assert_ok(mf_frame_forces_begin(&s->plan, &s->box, &s->frame, s->place, density));
    assert_ok(mf_frame_forces_find(&forces, &s->plan, &s->box, &s->frame, s->place, density));
    const struct force_equations *const e = &s->plan.equations;
    const struct force_curve *const curve = &e->curve[1];
    assert_true(curve->order == FORCES_OF_DENSITY);
    double sum = 0;
    for (size_t k = 0; k < e->size; k++) {
        double product = 0;
        for (size_t l = curve->first; l < e->size; l++) {
            const double q = curve->low + curve->width * (double)(l - curve->first);
            const size_t row = k > l ? k : l, column = k > l ? l : k;
            product -= (3 - 0.4 * q) * forces.gram[row * (row + 1) / 2 + column];
        }
        assert_close(product, forces.product[k], 1e-4 * (1 + fabs(product)));
        if (k >= curve->first)
            sum -= (3 - 0.4 * (curve->low + curve->width * (double)(k - curve->first))) *
                   forces.product[k];
    }
    assert_close(sum / forces.square, 1, 1e-5);
    mf_frame_forces_clear(&forces);
    clear(s);
}

static void test_forces_of_no_use_are_refused(void **state) {
    static const struct composition mixed = {.types = 2, .count = {30, 30}, .name = {"A", "B"}};
    (void)state;
    struct system *const s = make_system(&mixed, 2, 20);
    mf_frame_forces_end(&s->plan);
    for (size_t k = 30; k < 60; k++)
        for (int d = 0; d < 3; d++)
            s->force[k][d] = 0;
    assert_int_equal(mf_frame_forces_begin(&s->plan, &s->box, &s->frame, s->place, NULL),
                     STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "x: frame 0: the forces of all beads \"B\" are 0");
    for (size_t k = 0; k < 30; k++)
        for (int d = 0; d < 3; d++)
            s->force[k][d] = 0;
    assert_int_equal(mf_frame_forces_begin(&s->plan, &s->box, &s->frame, s->place, NULL),
                     STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "x: frame 0: all forces are 0");
    free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_against_the_obvious_sums),
        cmocka_unit_test(test_beads_some_at_a_time),
        cmocka_unit_test(test_a_density_by_differences_of_its_energy),
        cmocka_unit_test(test_forces_of_no_use_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
