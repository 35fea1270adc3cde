// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/programming.h"

#include "base/interrupt.h"
#include "base/parallel.h"
#include "programming_fit.h"
#include "programming_operators.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct programming_parameters, name)
const struct field mf_programming_fields[] = {
    {"nodes", FIELD_INTEGER, MEMBER(nodes), .initial = 12, .minimum = 1,
     .maximum = PROGRAMMING_MAX_NODES, .unit = "",
     .help = "most nodes of a formula: constants, r, operators, powers and exp"},
    {"islands", FIELD_INTEGER, MEMBER(islands), .initial = 8, .minimum = 1,
     .maximum = PROGRAMMING_MAX_ISLANDS, .unit = "", .help = "number of subpopulations"},
    {"rounds", FIELD_INTEGER, MEMBER(rounds), .initial = 12, .minimum = 1, .maximum = 10000,
     .unit = "", .help = "rounds of breeding"},
    {"children", FIELD_INTEGER, MEMBER(children), .initial = 1000, .minimum = 1, .maximum = 1e7,
     .unit = "", .help = "children of an island in a round"},
    FIELD_END,
};

/// Levels of a formula.
enum { MAX_DEPTH = 7 };

/// Steps of the fit of a child's constants, from the best of so many starts; of those whose error
/// is then this multiple of what is kept at least; and of the members of a front. Measured: of
/// starts at random (e^(−cr) − d)² finds its constants from 13 in 100, from the best of eight 34.
enum { CHILD_STARTS = 8, CHILD_STEPS = 12, GOOD_STEPS = 40, FRONT_STEPS = 200 };
static const double is_good = 3;

/// Children of a structure that is kept already which are fitted all the same.
static const double is_tried_again = 0.2;

/// Children that come from one parent alone, or from none, and rounds after which the best of all
/// islands go to each. Measured: of four searches for Morse's potential in 24 rounds all find it
/// so, two where islands mix after three rounds and parents are rather the good ones of their
/// length.
static const double mutates = 0.6, is_new = 0.03;
enum { ROUNDS_APART = 12 };

static void clear_island(struct programming_island *island) {
    for (int length = 0; length <= PROGRAMMING_MAX_NODES; length++)
        for (int k = 0; k < PROGRAMMING_KEPT; k++)
            island->member[length][k].error = INFINITY;
}

enum status mf_programming_init(struct programming *programming,
                                const struct programming_points *points,
                                const struct programming_parameters *parameters, uint64_t seed,
                                int threads, const atomic_bool *cancel) {
    *programming = (struct programming){.parameters = *parameters,
                                        .points = points,
                                        .seed = seed,
                                        .threads = threads,
                                        .cancel = cancel};
    TRY_ARRAY(programming->island, (size_t)parameters->islands);
    for (int length = 0; length <= PROGRAMMING_MAX_NODES; length++)
        programming->best[length].error = INFINITY;
    for (int64_t k = 0; k < parameters->islands; k++)
        clear_island(&programming->island[k]);
    return STATUS_OK;
}

void mf_programming_clear(struct programming *programming) {
    mf_memory_free(programming->island);
    *programming = (struct programming){0};
}

// An island ---------------------------------------------------------------------------------------

static bool have_same_structure(const struct expression *a, const struct expression *b) {
    if (a->length != b->length)
        return false;
    for (int k = 0; k < a->length; k++) {
        const bool stays = mf_programming_fit_stays(a, k);
        if (a->node[k].kind != b->node[k].kind || stays != mf_programming_fit_stays(b, k) ||
            (stays && a->node[k].constant != b->node[k].constant))
            return false;
    }
    return true;
}

/// Keep a formula if it is among the best of its length; of one structure only the best stays.
static void keep(struct programming_island *island, const struct programming_member *member) {
    struct programming_member *row = island->member[member->expression.length];
    int last = PROGRAMMING_KEPT - 1;
    for (int k = 0; k < PROGRAMMING_KEPT; k++)
        if (isfinite(row[k].error) && have_same_structure(&row[k].expression, &member->expression))
            last = k;
    if (!(member->error < row[last].error))
        return;
    for (; last > 0 && row[last - 1].error > member->error; last--)
        row[last] = row[last - 1];
    row[last] = *member;
}

static int members_of(const struct programming_member row[PROGRAMMING_KEPT]) {
    int members = 0;
    while (members < PROGRAMMING_KEPT && isfinite(row[members].error))
        members++;
    return members;
}

/// A parent: any of a length at random. NULL while that length has none.
static const struct expression *choose(struct rng_sequence *random,
                                       const struct programming_parameters *parameters,
                                       const struct programming_island *island) {
    const uint32_t length = 1 + mf_rng_sequence_below(random, (uint32_t)parameters->nodes);
    const struct programming_member *row = island->member[length];
    const int members = members_of(row);
    return members > 0 ? &row[mf_rng_sequence_below(random, (uint32_t)members)].expression : NULL;
}

static struct expression breed(struct rng_sequence *random,
                               const struct programming_parameters *parameters,
                               const struct programming_island *island) {
    const struct expression *first = choose(random, parameters, island),
                            *second = choose(random, parameters, island);
    if (first == NULL || mf_rng_sequence_uniform(random) < is_new)
        return mf_programming_random(random, 4);
    if (second == NULL || mf_rng_sequence_uniform(random) < mutates)
        return mf_programming_mutate(random, first);
    return mf_programming_cross(random, first, second);
}

static bool is_allowed(const struct programming_parameters *parameters,
                       const struct expression *child) {
    bool depends = false;
    for (int k = 0; k < child->length; k++)
        depends = depends || child->node[k].kind == EXPRESSION_DISTANCE;
    return depends && child->length <= parameters->nodes && mf_expression_depth(child) <= MAX_DEPTH;
}

/// Whether a formula has no pole between the points.
static bool is_regular(const struct programming_points *points,
                       const struct expression *expression) {
    const double last = points->r[points->count - 1];
    return mf_expression_is_finite(expression, points->r[0],
                                   isnan(points->zero) ? last : fmax(last, points->zero),
                                   (int)points->count, NULL);
}

/// A number added to the whole says nothing where it is shifted.
static void drop_shift(const struct programming_points *points, struct expression *expression) {
    const int last = expression->length - 1;
    if (!isnan(points->zero) && last > 1 && expression->node[last].kind == EXPRESSION_ADD &&
        expression->node[last - 1].kind == EXPRESSION_CONSTANT)
        expression->length -= 2;
}

/// Fit a child's constants, from where they are or from elsewhere; on if they promise something.
static void fit_child(const struct programming_points *points, struct programming_scratch *scratch,
                      struct rng_sequence *random, const struct programming_island *island,
                      struct programming_member *child) {
    const double worst = island->member[child->expression.length][PROGRAMMING_KEPT - 1].error;
    child->error = INFINITY;
    for (int start = 0; start < CHILD_STARTS; start++) {
        struct programming_member other = *child;
        if (start > 0)
            mf_programming_shake(random, &other.expression);
        other.error = mf_programming_fit_scale(points, scratch, &other.expression);
        if (start == 0 || other.error < child->error)
            *child = other;
    }
    child->error = mf_programming_fit(points, scratch, &child->expression, NULL, CHILD_STEPS);
    if (child->error < is_good * worst)
        child->error = mf_programming_fit(points, scratch, &child->expression, NULL, GOOD_STEPS);
}

static bool is_kept(const struct programming_island *island, const struct expression *expression) {
    const struct programming_member *row = island->member[expression->length];
    for (int k = 0; k < members_of(row); k++)
        if (have_same_structure(&row[k].expression, expression))
            return true;
    return false;
}

static void try_child(const struct programming *programming, struct programming_scratch *scratch,
                      struct rng_sequence *random, struct programming_island *island) {
    const struct programming_points *points = programming->points;
    struct programming_member child = {.expression =
                                           breed(random, &programming->parameters, island)};
    mf_expression_simplify(&child.expression);
    drop_shift(points, &child.expression);
    if (!is_allowed(&programming->parameters, &child.expression) ||
        (is_kept(island, &child.expression) && mf_rng_sequence_uniform(random) > is_tried_again))
        return;
    fit_child(points, scratch, random, island, &child);
    if (isfinite(child.error) && is_regular(points, &child.expression))
        keep(island, &child);
}

static enum status live(void *context, size_t task, void *result) {
    const struct programming *programming = context;
    struct programming_island *island = &programming->island[task];
    struct programming_scratch scratch;
    struct rng_sequence random = mf_rng_sequence_begin(
        programming->seed, RNG_SELECTION, (uint32_t)programming->round, (uint32_t)task);
    enum status status = STATUS_OK;
    (void)result;
    CHECK(mf_programming_fit_init(&scratch, programming->points));
    for (int64_t k = 0; k < programming->parameters.children; k++) {
        if (mf_interrupt_wanted(programming->cancel)) {
            status = mf_status_fail(STATUS_INTERRUPTED, "interrupted");
            break;
        }
        try_child(programming, &scratch, &random, island);
    }
done:
    mf_programming_fit_clear(&scratch);
    return status;
}

static size_t list_island(void *context, size_t task, struct memory_span *span) {
    const struct programming *programming = context;
    *span = (struct memory_span){&programming->island[task], sizeof *programming->island};
    return 1;
}

// All islands -------------------------------------------------------------------------------------

/// The best of each length over all islands, and now and then to all of them.
static void mix(struct programming *programming) {
    const size_t islands = (size_t)programming->parameters.islands;
    for (int length = 1; length <= PROGRAMMING_MAX_NODES; length++)
        for (size_t k = 0; k < islands; k++) {
            const struct programming_member *member = &programming->island[k].member[length][0];
            if (member->error < programming->best[length].error)
                programming->best[length] = *member;
        }
    if (programming->round % ROUNDS_APART != 0)
        return;
    for (int length = 1; length <= PROGRAMMING_MAX_NODES; length++)
        for (size_t k = 0; k < islands && isfinite(programming->best[length].error); k++)
            keep(&programming->island[k], &programming->best[length]);
}

enum status mf_programming_round(struct programming *programming) {
    TRY(mf_parallel_try(&(struct parallel_tasks){.count = (size_t)programming->parameters.islands,
                                                 .threads = programming->threads,
                                                 .run = live,
                                                 .context = programming,
                                                 .spans = list_island}));
    programming->round++;
    mix(programming);
    return STATUS_OK;
}

static enum status reconsider(void *context, size_t task, void *result) {
    const struct programming *programming = context;
    struct programming_island *island = &programming->island[task], *before = NULL;
    struct programming_scratch scratch;
    enum status status = STATUS_OK;
    (void)result;
    CHECK(mf_programming_fit_init(&scratch, programming->points));
    NEW_ARRAY(before, 1);
    *before = *island;
    clear_island(island);
    for (int n = 0; n < (PROGRAMMING_MAX_NODES + 1) * PROGRAMMING_KEPT; n++) {
        struct programming_member *member = &before->member[0][0] + n;
        if (!isfinite(member->error))
            continue;
        member->error = mf_programming_fit(programming->points, &scratch, &member->expression, NULL,
                                           GOOD_STEPS);
        if (isfinite(member->error) && is_regular(programming->points, &member->expression))
            keep(island, member);
    }
done:
    mf_memory_free(before);
    mf_programming_fit_clear(&scratch);
    return status;
}

enum status mf_programming_reconsider(struct programming *programming) {
    TRY(mf_parallel_try(&(struct parallel_tasks){.count = (size_t)programming->parameters.islands,
                                                 .threads = programming->threads,
                                                 .run = reconsider,
                                                 .context = programming,
                                                 .spans = list_island}));
    for (int length = 0; length <= PROGRAMMING_MAX_NODES; length++)
        programming->best[length].error = INFINITY;
    mix(programming);
    return STATUS_OK;
}

// The front ---------------------------------------------------------------------------------------

/// Errors that count as none, as a part of the points' own size; by which a longer formula must be
/// better; and by which a tidy one may be worse, as a part of it or of the noise.
static const double nothing = 1e-9, gain = 0.02, loss = 0.01;
static const double exponent_share = 1, digits_share = 0.5;

/// What the error of 0 would be in place of the points.
static double size_of(const struct programming_points *points,
                      struct programming_scratch *scratch) {
    const struct expression zero = {1, {{EXPRESSION_CONSTANT, 0}}};
    return mf_programming_fit_error(points, scratch, &zero);
}

/// Put a value in the place of a constant for good, if the others make up for it.
static bool settle_constant(const struct programming_points *points,
                            struct programming_scratch *scratch, int node, double value,
                            double allowed, bool *held, struct programming_member *member) {
    struct programming_member simplified = *member;
    simplified.expression.node[node].constant = value;
    held[node] = true;
    simplified.error =
        mf_programming_fit(points, scratch, &simplified.expression, held, FRONT_STEPS);
    if (!(simplified.error <= allowed) || !is_regular(points, &simplified.expression)) {
        held[node] = false;
        return false;
    }
    *member = simplified;
    return true;
}

static double rounded(double value, int digits) {
    char text[40];
    snprintf(text, sizeof text, "%.*g", digits, value);
    return strtod(text, NULL);
}

/// The error that a tidy formula may have.
static double allowed_error(const struct programming_points *points,
                            struct programming_scratch *scratch, double error,
                            double share_of_noise) {
    return fmax(hypot(error, share_of_noise * points->noise),
                fmax((1 + loss) * error, nothing * size_of(points, scratch)));
}

/// Whole exponents first, then few digits, constant after constant.
static void simplified(const struct programming_points *points, struct programming_scratch *scratch,
                       struct programming_member *member) {
    bool held[EXPRESSION_MAX] = {false};
    const struct expression *e = &member->expression;
    double allowed = allowed_error(points, scratch, member->error, exponent_share);
    for (int k = 0; k < e->length; k++)
        if (mf_expression_is_exponent(e, k) && rint(e->node[k].constant) != 0)
            settle_constant(points, scratch, k, rint(e->node[k].constant), allowed, held, member);
    allowed = allowed_error(points, scratch, member->error, digits_share);
    for (int k = e->length - 1; k >= 0; k--)
        for (int digits = 1; digits <= 15 && e->node[k].kind == EXPRESSION_CONSTANT && !held[k];
             digits++)
            settle_constant(points, scratch, k, rounded(e->node[k].constant, digits), allowed, held,
                            member);
}

enum status mf_programming_polish(const struct programming_points *points,
                                  struct programming_member *member) {
    enum status status = STATUS_OK;
    struct programming_scratch scratch;
    struct programming_member fitted = *member;
    CHECK(mf_programming_fit_init(&scratch, points));
    fitted.error = mf_programming_fit(points, &scratch, &fitted.expression, NULL, FRONT_STEPS);
    if (!is_regular(points, &fitted.expression)) {
        fitted = *member;
        fitted.error = mf_programming_fit_error(points, &scratch, &fitted.expression);
    }
    simplified(points, &scratch, &fitted);
    // A power may have become a first one.
    mf_expression_simplify(&fitted.expression);
    drop_shift(points, &fitted.expression);
    fitted.error = mf_programming_fit_error(points, &scratch, &fitted.expression);
    *member = fitted;
done:
    mf_programming_fit_clear(&scratch);
    return status;
}

enum status mf_programming_front(const struct programming *programming,
                                 struct programming_member *front, size_t *members) {
    enum status status = STATUS_OK;
    struct programming_scratch scratch;
    double min = INFINITY;
    *members = 0;
    CHECK(mf_programming_fit_init(&scratch, programming->points));
    const double floor = nothing * size_of(programming->points, &scratch);
    for (int length = 1; length <= programming->parameters.nodes && min > floor; length++) {
        if (!(programming->best[length].error < (1 - gain) * min))
            continue;
        front[*members] = programming->best[length];
        CHECK(mf_programming_polish(programming->points, &front[*members]));
        if (!(front[*members].error < (1 - gain) * min))
            continue;
        min = front[(*members)++].error;
    }
done:
    mf_programming_fit_clear(&scratch);
    return status;
}

size_t mf_programming_spans(struct programming *programming, struct memory_span *spans) {
    const size_t islands = (size_t)programming->parameters.islands;
    spans[0] = (struct memory_span){programming->island, islands * sizeof *programming->island};
    spans[1] = (struct memory_span){programming->best, sizeof programming->best};
    spans[2] = (struct memory_span){&programming->round, sizeof programming->round};
    return 3;
}
