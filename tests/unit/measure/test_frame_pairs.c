// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pairs in boxes of any shape, against all images of all pairs.
#include "base/rng.h"
#include "measure/frame_pairs.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BEADS = 600, BINS = 50, MAX_COUNTS = 6 * (BINS + 1) };

/// A distance is known to some units of 2⁻³² of the box: a pair as near to an edge of a bin may be
/// counted on its other side.
static const double resolution = 1e-8;

static const double boxes[][3][3] = {
    {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}},
    {{3, 0, 0}, {0, 7, 0}, {0, 0, 2}},
    {{3, 0, 0}, {0, 3, 0}, {1.5, 1.5, 2.1213}},        // rhombic dodecahedron
    {{3, 0, 0}, {1, 2.8284, 0}, {-1, 1.4142, 2.4495}}, // truncated octahedron
    {{9, 0, 0}, {4.4, 3, 0}, {-4.2, 1.4, 4}},          // flat and tilted
    {{1, 2, 3}, {-3, 1.5, 0.2}, {0.3, -2.5, 2.2}},     // not along the axes
    {{0, 0, 3}, {0, 4, 0}, {3.5, 0, 0}},               // left-handed
};
enum { BOXES = sizeof boxes / sizeof *boxes };

struct system {
    struct trajectory_frame frame;
    struct box_vectors box;
    struct frame_pairs_plan plan;
    double position[MAX_BEADS][3];
    uint32_t molecule[MAX_BEADS];
    int32_t memory[3][MAX_BEADS], *place[3];
};

/// Beads anywhere, in any image of the box.
static struct system *make_system(const double box[3][3], const struct composition *composition,
                                  double share, uint32_t seed) {
    struct system *s = calloc(1, sizeof *s);
    struct rng_sequence random = mf_rng_sequence_begin(seed, RNG_PLACEMENT, 0, 0);
    s->plan = (struct frame_pairs_plan){.bins = BINS, .composition = *composition};
    s->frame = (struct trajectory_frame){.atoms = (size_t)mf_composition_particles(composition),
                                         .position = s->position,
                                         .file = "x"};
    mf_frame_set_box(&s->frame, box);
    for (size_t k = 0; k < s->frame.atoms; k++)
        for (int i = 0; i < 3; i++) {
            const double fraction = 3 * mf_rng_sequence_uniform(&random) - 1;
            for (int d = 0; d < 3; d++)
                s->position[k][d] += fraction * box[i][d];
        }
    for (int i = 0; i < 3; i++)
        s->place[i] = s->memory[i];
    assert_ok(mf_frame_box_find(&s->box, &s->frame));
    assert_ok(mf_frame_box_places(&s->box, &s->frame, s->place));
    s->plan.range = share * mf_box_vectors_min_height(&s->box);
    return s;
}

/// Distance of the nearest of 11³ images of what has first been brought near.
static double find_distance(const struct system *s, size_t i, size_t j) {
    enum { IMAGES = 5 };
    const double(*box)[3] = s->frame.box;
    double difference[3], min = INFINITY;
    for (int d = 0; d < 3; d++)
        difference[d] = s->position[i][d] - s->position[j][d];
    for (int i_ = 0; i_ < 3; i_++) {
        double fraction = 0;
        for (int d = 0; d < 3; d++)
            fraction += (s->position[i][d] - s->position[j][d]) * s->box.inverse[i_][d];
        for (int d = 0; d < 3; d++)
            difference[d] -= floor(fraction) * box[i_][d];
    }
    for (int a = -IMAGES; a <= IMAGES; a++)
        for (int b = -IMAGES; b <= IMAGES; b++)
            for (int c = -IMAGES; c <= IMAGES; c++) {
                double square = 0;
                for (int d = 0; d < 3; d++) {
                    const double x = difference[d] + a * box[0][d] + b * box[1][d] + c * box[2][d];
                    square += x * x;
                }
                min = fmin(min, square);
            }
    return sqrt(min);
}

/// Counts of all pairs; returns how many are as near to an edge as the resolution.
static size_t count_slowly(const struct system *s, uint64_t counts[MAX_COUNTS]) {
    const double width = s->plan.range / BINS;
    size_t doubtful = 0;
    memset(counts, 0, MAX_COUNTS * sizeof *counts);
    for (size_t i = 0; i < s->frame.atoms; i++)
        for (size_t j = 0; j < i; j++) {
            const double place = find_distance(s, i, j) / width;
            const int pair =
                mf_composition_pair_of_ids(&s->plan.composition, (uint32_t)i, (uint32_t)j);
            doubtful += fabs(place - rint(place)) * width < resolution;
            if (place < BINS && !(s->plan.molecule && s->molecule[i] == s->molecule[j]))
                counts[(size_t)pair * (BINS + 1) + (size_t)place]++;
        }
    return doubtful;
}

/// A doubtful pair may be missing in one bin and be in the next.
static void check_counts(struct system *s) {
    struct frame_pairs pairs = {.counts = NULL};
    uint64_t counts[MAX_COUNTS], differences = 0;
    const size_t doubtful = count_slowly(s, counts);
    assert_true(doubtful < 10);
    assert_ok(mf_frame_pairs_count(&pairs, &s->plan, &s->box, s->place));
    for (int pair = 0; pair < mf_composition_pairs(&s->plan.composition); pair++)
        for (size_t k = 0; k < BINS; k++) {
            const size_t at = (size_t)pair * (BINS + 1) + k;
            differences += (uint64_t)llabs((int64_t)pairs.counts[at] - (int64_t)counts[at]);
        }
    assert_true(differences <= 2 * doubtful);
    mf_frame_pairs_clear(&pairs);
    free(s);
}

static void test_frame_pairs_are_all_when_the_box_has_any_shape(void **state) {
    (void)state;
    static const double shares[] = {0.03, 0.11, 0.2, 0.24, 0.34, 0.45, 0.5};
    const struct composition one = mf_composition_of_one(120);
    for (uint32_t b = 0; b < BOXES; b++)
        for (uint32_t n = 0; n < sizeof shares / sizeof *shares; n++)
            check_counts(make_system(boxes[b], &one, shares[n], 10 * b + n));
}

/// Weights of all pairs but those of one molecule, or, counted apart, but the excluded ones.
static void check_weights(struct system *s, bool within) {
    static uint32_t excluded[][2] = {{3, 4}, {40, 90}, {7, 11}};
    enum { EXCLUDED = sizeof excluded / sizeof *excluded };
    const double range = s->plan.range;
    const struct weighted_density_settings settings = {0.5 * range, range, 10, 0};
    struct frame_pairs pairs = {.counts = NULL};
    double found[MAX_BEADS], expected[MAX_BEADS] = {0};
    s->plan.molecule = s->molecule;
    s->plan.within = within;
    for (size_t k = 0; k < s->frame.atoms; k++)
        s->molecule[k] = (uint32_t)(k / 4);
    for (size_t i = 0; i < s->frame.atoms; i++)
        for (size_t j = 0; j < i; j++) {
            const double x = fmax(0, (pow(find_distance(s, i, j) / range, 2) - 0.25) / 0.75);
            const double weight = x < 1 ? (1 - x) * (1 - x) * (1 + 2 * x) : 0;
            bool counts = within || i / 4 != j / 4;
            for (int n = 0; within && n < EXCLUDED; n++)
                counts = counts && !(j == excluded[n][0] && i == excluded[n][1]);
            expected[i] += counts ? weight : 0;
            expected[j] += counts ? weight : 0;
        }
    assert_ok(mf_frame_pairs_weigh(&pairs, &s->plan, &settings, &s->box, s->place,
                                   within ? excluded : NULL, within ? EXCLUDED : 0, found));
    for (size_t k = 0; k < s->frame.atoms; k++)
        assert_close(found[k], expected[k], 1e-6);
    mf_frame_pairs_clear(&pairs);
    free(s);
}

static void test_weighted_densities_are_those_of_all_pairs(void **state) {
    (void)state;
    const struct composition one = mf_composition_of_one(120);
    for (uint32_t b = 0; b < BOXES; b++)
        for (int within = 0; within < 2; within++) {
            check_weights(make_system(boxes[b], &one, 0.2, 300 + b), within);
            check_weights(make_system(boxes[b], &one, 0.5, 400 + b), within);
        }
}

static void test_frame_pairs_are_of_their_types_when_beads_differ(void **state) {
    (void)state;
    const struct composition three = {.types = 3, .count = {80, 20, 41}};
    for (uint32_t b = 0; b < BOXES; b++) {
        check_counts(make_system(boxes[b], &three, 0.4, 100 + b));
        check_counts(make_system(boxes[b], &three, 0.15, 200 + b));
    }
}

static void test_frame_pairs_leave_molecules_out_when_asked(void **state) {
    (void)state;
    const struct composition two = {.types = 2, .count = {60, 120}};
    struct system *s = make_system(boxes[3], &two, 0.5, 7);
    double possible[3];
    for (size_t k = 0; k < 180; k++) // an A and two B each
        s->molecule[k] = (uint32_t)(k < 60 ? k : (k - 60) / 2);
    s->plan.molecule = s->molecule;
    assert_ok(mf_frame_pairs_possible(&s->plan, possible));
    assert_close(possible[0], 60 * 59 / 2, 0);
    assert_close(possible[1], 60 * 120 - 120, 0);
    assert_close(possible[2], 120 * 119 / 2 - 60, 0);
    check_counts(s);
}

struct seen {
    const struct system *system;
    const uint32_t *bead;
    double range;
    size_t near;
};

static void see(void *context, const struct cell_pairs_batch *batch) {
    struct seen *seen = context;
    double squares[CELL_PAIRS_BATCH];
    mf_cell_pairs_squares(batch, squares);
    for (size_t k = 0; k < batch->count; k++) {
        if (squares[k] >= seen->range * seen->range)
            continue;
        assert_close(
            sqrt(squares[k]),
            find_distance(seen->system, seen->bead[batch->i], seen->bead[batch->begin + k]),
            resolution);
        seen->near++;
    }
}

/// How many pairs a search finds within a range, each at its distance.
static size_t find_near(struct system *s, double range) {
    struct cell_pairs search = {.room = 0};
    assert_ok(mf_cell_pairs_sort(&search, &s->box, s->place, s->frame.atoms, range));
    struct seen seen = {s, search.cells.order, range, 0};
    mf_cell_pairs_visit(&search, see, &seen);
    mf_cell_pairs_clear(&search);
    return seen.near;
}

static void test_frame_pairs_see_each_other_when_a_corner_is_between(void **state) {
    (void)state;
    const struct composition one = mf_composition_of_one(2);
    for (uint32_t b = 0; b < BOXES; b++) {
        struct system *s = make_system(boxes[b], &one, 0.5, b);
        struct frame_pairs pairs = {.counts = NULL};
        // Around the corner where all three vectors meet, and its image seven boxes away.
        const double r = 0.777 * s->plan.range, x = r / sqrt(3);
        for (int d = 0; d < 3; d++) {
            s->position[0][d] = -0.5 * x;
            s->position[1][d] = 0.5 * x + 7 * boxes[b][0][d] - 3 * boxes[b][2][d];
        }
        assert_ok(mf_frame_box_places(&s->box, &s->frame, s->place));
        assert_ok(mf_frame_pairs_count(&pairs, &s->plan, &s->box, s->place));
        for (size_t k = 0; k < BINS; k++)
            assert_int_equal(pairs.counts[k], k == (size_t)(0.777 * BINS));
        assert_int_equal(find_near(s, 1.001 * r), 1);
        assert_int_equal(find_near(s, 0.999 * r), 0);
        mf_frame_pairs_clear(&pairs);
        free(s);
    }
}

static void test_frame_pairs_are_those_of_a_lattice_when_it_is_simple_cubic(void **state) {
    (void)state;
    enum { EDGE = 8, SITES = EDGE * EDGE * EDGE };
    const double box[3][3] = {{EDGE, 0, 0}, {0, EDGE, 0}, {0, 0, EDGE}};
    const struct composition one = mf_composition_of_one(SITES);
    struct system *s = make_system(box, &one, 0.5, 1);
    struct frame_pairs pairs = {.counts = NULL};
    for (int k = 0; k < SITES; k++) {
        s->position[k][0] = k % EDGE;
        s->position[k][1] = k / EDGE % EDGE;
        s->position[k][2] = k / EDGE / EDGE;
    }
    assert_ok(mf_frame_box_places(&s->box, &s->frame, s->place));
    s->plan.range = 2.5; // bins of 0.05: shells at 1, √2, √3, 2, √5, √6 are inside one each
    s->box.edge[0][0] *= 1 + 1e-6; // and not on an edge
    s->box.edge[1][1] *= 1 + 1e-6;
    s->box.edge[2][2] *= 1 + 1e-6;
    assert_ok(mf_frame_pairs_count(&pairs, &s->plan, &s->box, s->place));
    static const struct {
        double square;
        uint64_t neighbours;
    } shells[] = {{1, 6}, {2, 12}, {3, 8}, {4, 6}, {5, 24}, {6, 24}};
    uint64_t all = 0;
    for (size_t n = 0; n < 6; n++) {
        const size_t bin = (size_t)(sqrt(shells[n].square) * 1.000001 / 0.05);
        assert_int_equal(pairs.counts[bin], shells[n].neighbours * SITES / 2);
    }
    for (size_t k = 0; k < BINS; k++)
        all += pairs.counts[k];
    assert_int_equal(all, (6 + 12 + 8 + 6 + 24 + 24) * SITES / 2);
    mf_frame_pairs_clear(&pairs);
    free(s);
}

static void test_frame_pairs_near_are_those_counted_when_listed(void **state) {
    (void)state;
    const struct composition two = {.types = 2, .count = {60, 70}};
    for (uint32_t b = 0; b < BOXES; b++) {
        struct system *s = make_system(boxes[b], &two, 0.3, 40 + b);
        size_t found = 0;
        for (size_t i = 0; i < s->frame.atoms; i++)
            for (size_t j = 0; j < i; j++)
                found += find_distance(s, i, j) < s->plan.range;
        assert_int_equal(find_near(s, s->plan.range), found);
        free(s);
    }
}

static void test_frame_box_is_refused_when_it_is_none_or_too_small(void **state) {
    (void)state;
    const struct composition one = mf_composition_of_one(2);
    struct system *s = make_system(boxes[2], &one, 0.5, 1);
    // A rhombic dodecahedron of edge 3: heights are √6 and, of the two faces that are squares,
    // 3/√2.
    for (int i = 0; i < 3; i++)
        assert_close(s->box.height[i], i < 2 ? sqrt(6) : 3 / sqrt(2), 1e-4);
    assert_close(mf_box_vectors_min_height(&s->box), s->box.height[2], 0);
    assert_close(s->box.volume, 3 * 3 * 2.1213, 1e-12);
    assert_ok(mf_frame_box_check_range(&s->box, &s->frame, 1.06, "r"));
    assert_fails(mf_frame_box_check_range(&s->box, &s->frame, 1.07, "the range of g(r)"),
                 STATUS_BAD_INPUT, "x: frame 0: the range of g(r), 1.07 nm, is beyond half");
    s->frame.periodic[1] = false;
    assert_fails(mf_frame_box_find(&s->box, &s->frame), STATUS_BAD_INPUT, "along vector b");
    s->frame.has_box = false;
    assert_fails(mf_frame_box_find(&s->box, &s->frame), STATUS_BAD_INPUT, "has no box");
    free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frame_pairs_are_all_when_the_box_has_any_shape),
        cmocka_unit_test(test_weighted_densities_are_those_of_all_pairs),
        cmocka_unit_test(test_frame_pairs_are_of_their_types_when_beads_differ),
        cmocka_unit_test(test_frame_pairs_leave_molecules_out_when_asked),
        cmocka_unit_test(test_frame_pairs_see_each_other_when_a_corner_is_between),
        cmocka_unit_test(test_frame_pairs_are_those_of_a_lattice_when_it_is_simple_cubic),
        cmocka_unit_test(test_frame_pairs_near_are_those_counted_when_listed),
        cmocka_unit_test(test_frame_box_is_refused_when_it_is_none_or_too_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
