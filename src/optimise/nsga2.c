// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/nsga2.h"

#include "base/rng.h"
#include "base/statistics.h"

#include <stdlib.h>
#include <string.h>

// Operators ---------------------------------------------------------------------------------------

/// Spread factor β of a uniform number u, when the nearest bound allows β = `max` at last.
static double spread_factor(double u, double max, double exponent) {
    const double inside = 2 - pow(max, -(exponent + 1));
    if (u <= 1 / inside)
        return pow(u * inside, 1 / (exponent + 1));
    return pow(1 / (2 - u * inside), 1 / (exponent + 1));
}

static double within(double x) {
    return fmin(1, fmax(0, x));
}

void mf_nsga2_cross(double *a, double *b, size_t genes, double exponent,
                    struct rng_sequence *random) {
    static const double same = 1e-14;
    for (size_t k = 0; k < genes; k++) {
        const double low = fmin(a[k], b[k]), high = fmax(a[k], b[k]), apart = high - low;
        const double chance = mf_rng_sequence_uniform(random), u = mf_rng_sequence_uniform(random);
        const bool swapped = mf_rng_sequence_uniform(random) < 0.5;
        if (chance >= 0.5 || apart < same)
            continue;
        const double below = spread_factor(u, 1 + 2 * low / apart, exponent);
        const double above = spread_factor(u, 1 + 2 * (1 - high) / apart, exponent);
        const double first = within(0.5 * (low + high - below * apart));
        const double second = within(0.5 * (low + high + above * apart));
        a[k] = swapped ? second : first;
        b[k] = swapped ? first : second;
    }
}

double mf_nsga2_mutate(double gene, double exponent, struct rng_sequence *random) {
    const double u = mf_rng_sequence_uniform(random), power = exponent + 1;
    const bool down = u < 0.5;
    const double capacity = pow(down ? 1 - gene : gene, power);
    if (down)
        return within(gene + pow(2 * u + (1 - 2 * u) * capacity, 1 / power) - 1);
    return within(gene + 1 - pow(2 * (1 - u) + (2 * u - 1) * capacity, 1 / power));
}

// Fronts ------------------------------------------------------------------------------------------

bool mf_nsga2_dominates(const double *a, const double *b, size_t objectives) {
    bool better = false;
    for (size_t m = 0; m < objectives; m++) {
        if (a[m] > b[m])
            return false;
        better = better || a[m] < b[m];
    }
    return better;
}

enum status mf_nsga2_sort(const double *value, size_t count, size_t objectives, uint32_t *rank) {
    enum status status = STATUS_OK;
    size_t *above = NULL; // those on no front yet that dominate each
    size_t left = count;
    NEW_ARRAY(above, count);
    for (size_t a = 0; a < count; a++) {
        rank[a] = 0;
        for (size_t b = 0; b < count; b++)
            above[a] +=
                mf_nsga2_dominates(value + b * objectives, value + a * objectives, objectives);
    }
    for (uint32_t front = 1; left > 0; front++) {
        for (size_t a = 0; a < count; a++)
            if (rank[a] == 0 && above[a] == 0) {
                rank[a] = front;
                left--;
            }
        for (size_t a = 0; a < count; a++)
            for (size_t b = 0; rank[a] == front && b < count; b++)
                above[b] -=
                    mf_nsga2_dominates(value + a * objectives, value + b * objectives, objectives);
    }
done:
    mf_memory_free(above);
    return status;
}

struct place {
    double value;
    size_t index;
};

static int compare_places(const void *a, const void *b) {
    const struct place *x = a, *y = b;
    if (x->value != y->value)
        return x->value < y->value ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

/// Add the room along one objective to the members of a front, which get sorted by it.
static void crowd_along(struct place *place, size_t count, double *crowding) {
    qsort(place, count, sizeof *place, compare_places);
    const double range = place[count - 1].value - place[0].value;
    crowding[place[0].index] = crowding[place[count - 1].index] = HUGE_VAL;
    for (size_t k = 1; k + 1 < count && range > 0; k++)
        crowding[place[k].index] += (place[k + 1].value - place[k - 1].value) / range;
}

enum status mf_nsga2_crowd(const double *value, size_t count, size_t objectives,
                           const uint32_t *rank, double *crowding) {
    OWNED struct place *place = NULL;
    size_t done_with = 0;
    TRY_ARRAY(place, count);
    for (uint32_t front = 1; done_with < count; front++) {
        size_t members = 0;
        for (size_t m = 0; m < objectives; m++) {
            members = 0;
            for (size_t k = 0; k < count; k++)
                if (rank[k] == front) {
                    if (m == 0)
                        crowding[k] = 0;
                    place[members++] = (struct place){value[k * objectives + m], k};
                }
            if (members > 0)
                crowd_along(place, members, crowding);
        }
        done_with += members;
    }
    return STATUS_OK;
}

#define MEMBER(name) .offset = offsetof(struct nsga2_parameters, name)
const struct field mf_nsga2_fields[] = {
    {"population", FIELD_INTEGER, MEMBER(population), .initial = 40, .minimum = 4, .maximum = 512,
     .unit = "", .help = "parents, and children of a generation"},
    {"generations", FIELD_INTEGER, MEMBER(generations), .initial = 50, .minimum = 1,
     .maximum = 10000, .unit = "", .help = "number of generations"},
    {"spread", FIELD_NUMBER, MEMBER(spread), .initial = 0.1, .minimum = 0, .maximum = 1, .unit = "",
     .help = "spread of the first genes around the start; 0: uniform"},
    {"mutation_exponent", FIELD_NUMBER, MEMBER(mutation_exponent), .initial = 20, .minimum = 0,
     .maximum = 1000, .unit = "", .help = "exponent of mutations: larger for smaller ones"},
    FIELD_END,
};

/// Probability of crossover of two parents, and its exponent; genes of a child that mutate, on
/// average; part of the parents that every generation measures again.
static const double crossover = 0.9, crossover_exponent = 15, mutation = 1, remeasured = 0.25;

/// Widths of the first population about the start: from this part of `spread` to all of it.
static const double min_spread = 0.1;

static double *row(const struct nsga2 *nsga2, size_t index) {
    return nsga2->x + index * nsga2->genes;
}

static double *value_of(const struct nsga2 *nsga2, size_t index) {
    return nsga2->value + index * nsga2->objectives;
}

/// First individual that is there: there are no parents before the first tell.
static size_t first_row(const struct nsga2 *nsga2) {
    return nsga2->progress.generation == 0 ? nsga2->population : 0;
}

size_t mf_nsga2_parents(const struct nsga2 *nsga2) {
    return nsga2->population - first_row(nsga2);
}

const double *mf_nsga2_parent(const struct nsga2 *nsga2, size_t parent) {
    return row(nsga2, parent);
}

bool mf_nsga2_is_over(const struct nsga2 *nsga2) {
    return nsga2->progress.generation >= (uint32_t)nsga2->parameters.generations;
}

/// Individuals about the start, each at a distance of its own; the first is the start.
static void make_first(struct nsga2 *nsga2, const double *start) {
    const double spread = nsga2->parameters.spread;
    for (size_t k = 0; k < nsga2->population; k++) {
        struct rng_sequence random =
            mf_rng_sequence_begin(nsga2->seed, RNG_INITIAL, (uint32_t)k, 0);
        const double width = spread * pow(min_spread, mf_rng_sequence_uniform(&random));
        double *x = row(nsga2, nsga2->population + k);
        for (size_t n = 0; n < nsga2->genes; n++) {
            const double u = mf_rng_sequence_uniform(&random), v = mf_rng_sequence_uniform(&random);
            double normal[2];
            rng_box_muller(u, v, normal);
            x[n] = start && spread > 0 ? mf_optimiser_reflect(start[n] + width * normal[0]) : u;
            if (start && k == 0)
                x[n] = fmin(1, fmax(0, start[n]));
        }
    }
}

enum status mf_nsga2_init(struct nsga2 *nsga2, const struct nsga2_parameters *parameters,
                          const struct nsga2_space *space) {
    const size_t population = (size_t)parameters->population;
    *nsga2 = (struct nsga2){.parameters = *parameters,
                            .genes = space->genes,
                            .objectives = space->objectives,
                            .population = population,
                            .seed = space->seed};
    if (space->genes < 1 || space->objectives < 1)
        return mf_status_fail(STATUS_BAD_INPUT, "nothing to optimise: %zu genes, %zu objectives",
                              space->genes, space->objectives);
    TRY_ARRAY(nsga2->x, 3 * population * space->genes);
    TRY_ARRAY(nsga2->value, 2 * population * space->objectives);
    TRY_ARRAY(nsga2->measured, 2 * population);
    TRY_ARRAY(nsga2->rank, 2 * population);
    TRY_ARRAY(nsga2->crowding, 2 * population);
    TRY_ARRAY(nsga2->again, population);
    TRY_ARRAY(nsga2->injected, NSGA2_INJECTED * space->genes);
    make_first(nsga2, space->start);
    nsga2->progress.is_made = 1;
    return STATUS_OK;
}

void mf_nsga2_clear(struct nsga2 *nsga2) {
    mf_memory_free(nsga2->x);
    mf_memory_free(nsga2->value);
    mf_memory_free(nsga2->measured);
    mf_memory_free(nsga2->rank);
    mf_memory_free(nsga2->crowding);
    mf_memory_free(nsga2->again);
    mf_memory_free(nsga2->injected);
    *nsga2 = (struct nsga2){0};
}

// A round ---------------------------------------------------------------------------------------

/// The crowded comparison: by rank, then by room.
static bool is_better(const struct nsga2 *nsga2, size_t a, size_t b) {
    if (nsga2->rank[a] != nsga2->rank[b])
        return nsga2->rank[a] < nsga2->rank[b];
    return nsga2->crowding[a] > nsga2->crowding[b];
}

/// A copy of the better of two parents.
static void copy_winner(const struct nsga2 *nsga2, double *child, struct rng_sequence *random) {
    const size_t a = mf_rng_sequence_below(random, (uint32_t)nsga2->population);
    const size_t b = mf_rng_sequence_below(random, (uint32_t)nsga2->population);
    memcpy(child, row(nsga2, is_better(nsga2, b, a) ? b : a), nsga2->genes * sizeof *child);
}

static bool is_twin(const struct nsga2 *nsga2, const double *child) {
    for (size_t k = 0; k < nsga2->population; k++)
        if (memcmp(row(nsga2, k), child, nsga2->genes * sizeof *child) == 0)
            return true;
    return false;
}

/// Mutate some genes, and one at least of a child that would be a parent's twin: a twin is a second
/// draw of the same noise.
static void mutate(const struct nsga2 *nsga2, double *child, struct rng_sequence *random) {
    const struct nsga2_parameters *p = &nsga2->parameters;
    for (size_t n = 0; n < nsga2->genes; n++)
        if (mf_rng_sequence_uniform(random) * (double)nsga2->genes < mutation)
            child[n] = mf_nsga2_mutate(child[n], p->mutation_exponent, random);
    if (!is_twin(nsga2, child))
        return;
    const size_t n = mf_rng_sequence_below(random, (uint32_t)nsga2->genes);
    child[n] = mf_nsga2_mutate(child[n], p->mutation_exponent, random);
}

static void make_children(struct nsga2 *nsga2) {
    for (size_t k = 0; k < nsga2->population; k += 2) {
        struct rng_sequence random = mf_rng_sequence_begin(nsga2->seed, RNG_SELECTION,
                                                           nsga2->progress.generation, (uint32_t)k);
        // The second of the last pair of an odd population stands where `again` is copied to.
        double *a = row(nsga2, nsga2->population + k), *b = a + nsga2->genes;
        copy_winner(nsga2, a, &random);
        copy_winner(nsga2, b, &random);
        if (mf_rng_sequence_uniform(&random) < crossover)
            mf_nsga2_cross(a, b, nsga2->genes, crossover_exponent, &random);
        mutate(nsga2, a, &random);
        mutate(nsga2, b, &random);
    }
    const size_t injected = nsga2->progress.injected;
    memcpy(row(nsga2, 2 * nsga2->population - injected), nsga2->injected,
           injected * nsga2->genes * sizeof *nsga2->injected);
    nsga2->progress.injected = 0;
}

static bool is_chosen_again(const struct nsga2 *nsga2, size_t parent) {
    for (uint32_t k = 0; k < nsga2->progress.again; k++)
        if (nsga2->again[k] == parent)
            return true;
    return false;
}

/// Member of the first front that was measured least, of those not chosen yet; `population` if
/// there is none.
static size_t min_measured(const struct nsga2 *nsga2) {
    size_t min = nsga2->population;
    for (size_t k = 0; k < nsga2->population; k++)
        if (nsga2->rank[k] == 1 && value_of(nsga2, k)[0] < OPTIMISER_FAILED &&
            !is_chosen_again(nsga2, k) &&
            (min == nsga2->population || nsga2->measured[k] < nsga2->measured[min]))
            min = k;
    return min;
}

static void choose_again(struct nsga2 *nsga2) {
    const size_t max = (size_t)ceil(remeasured * (double)nsga2->population);
    nsga2->progress.again = 0;
    while (nsga2->progress.again < max) {
        const size_t parent = min_measured(nsga2);
        if (parent == nsga2->population)
            break;
        memcpy(row(nsga2, 2 * nsga2->population + nsga2->progress.again), row(nsga2, parent),
               nsga2->genes * sizeof(double));
        nsga2->again[nsga2->progress.again++] = (uint32_t)parent;
    }
}

struct optimiser_round mf_nsga2_ask(struct nsga2 *nsga2) {
    if (mf_nsga2_is_over(nsga2))
        return (struct optimiser_round){0};
    if (!nsga2->progress.is_made) {
        make_children(nsga2);
        choose_again(nsga2);
        nsga2->progress.is_made = 1;
    }
    return (struct optimiser_round){row(nsga2, nsga2->population),
                                    nsga2->population + nsga2->progress.again};
}

void mf_nsga2_inject(struct nsga2 *nsga2, const double *genes) {
    const size_t injected = nsga2->progress.injected;
    if (injected >= NSGA2_INJECTED || injected >= nsga2->population / 2)
        return;
    for (size_t n = 0; n < nsga2->genes; n++)
        nsga2->injected[injected * nsga2->genes + n] = fmin(1, fmax(0, genes[n]));
    nsga2->progress.injected++;
}

// Selection ---------------------------------------------------------------------------------------

/// Add a measurement to the means; what failed once has failed.
static void add(struct nsga2 *nsga2, size_t index, const double *value) {
    double *mean = value_of(nsga2, index);
    bool failed = nsga2->measured[index] > 0 && mean[0] >= OPTIMISER_FAILED;
    nsga2->measured[index] += 1;
    for (size_t m = 0; m < nsga2->objectives; m++) {
        failed = failed || optimiser_error(value[m]) >= OPTIMISER_FAILED;
        mean[m] += (value[m] - mean[m]) / nsga2->measured[index];
    }
    for (size_t m = 0; m < nsga2->objectives && failed; m++)
        mean[m] = OPTIMISER_FAILED;
}

static enum status sort(struct nsga2 *nsga2, size_t first, size_t count) {
    const double *value = value_of(nsga2, first);
    TRY(mf_nsga2_sort(value, count, nsga2->objectives, nsga2->rank + first));
    return mf_nsga2_crowd(value, count, nsga2->objectives, nsga2->rank + first,
                          nsga2->crowding + first);
}

enum status mf_nsga2_add_measurement(struct nsga2 *nsga2, size_t parent, const double *value) {
    add(nsga2, parent, value);
    return sort(nsga2, 0, mf_nsga2_parents(nsga2));
}

struct rival {
    const struct nsga2 *nsga2;
    size_t index;
};

static int compare_rivals(const void *a, const void *b) {
    const struct rival *x = a, *y = b;
    if (is_better(x->nsga2, x->index, y->index))
        return -1;
    if (is_better(x->nsga2, y->index, x->index))
        return 1;
    return (x->index > y->index) - (x->index < y->index);
}

/// The best of parents and children become the parents.
static enum status select_parents(struct nsga2 *nsga2) {
    const size_t first = first_row(nsga2), end = 2 * nsga2->population;
    const size_t genes = nsga2->genes, objectives = nsga2->objectives;
    OWNED struct rival *rivals = NULL;
    OWNED double *copy = NULL;
    const size_t width = genes + objectives + 1;
    TRY_ARRAY(rivals, end - first);
    TRY_ARRAY(copy, nsga2->population * width);
    TRY(sort(nsga2, first, end - first));
    for (size_t k = first; k < end; k++)
        rivals[k - first] = (struct rival){nsga2, k};
    qsort(rivals, end - first, sizeof *rivals, compare_rivals);
    for (size_t k = 0; k < nsga2->population; k++) {
        double *to = copy + k * width;
        memcpy(to, row(nsga2, rivals[k].index), genes * sizeof *to);
        memcpy(to + genes, value_of(nsga2, rivals[k].index), objectives * sizeof *to);
        to[genes + objectives] = nsga2->measured[rivals[k].index];
    }
    for (size_t k = 0; k < nsga2->population; k++) {
        const double *from = copy + k * width;
        memcpy(row(nsga2, k), from, genes * sizeof *from);
        memcpy(value_of(nsga2, k), from + genes, objectives * sizeof *from);
        nsga2->measured[k] = from[genes + objectives];
    }
    return sort(nsga2, 0, nsga2->population);
}

enum status mf_nsga2_tell(struct nsga2 *nsga2, const double *value) {
    for (size_t k = 0; k < nsga2->population; k++) {
        nsga2->measured[nsga2->population + k] = 0;
        add(nsga2, nsga2->population + k, value + k * nsga2->objectives);
    }
    for (size_t k = 0; k < nsga2->progress.again; k++)
        add(nsga2, nsga2->again[k], value + (nsga2->population + k) * nsga2->objectives);
    TRY(select_parents(nsga2));
    nsga2->progress.generation++;
    nsga2->progress.again = 0;
    nsga2->progress.is_made = 0;
    return STATUS_OK;
}

double mf_nsga2_diversity(const struct nsga2 *nsga2) {
    const size_t first = first_row(nsga2);
    double sum = 0;
    for (size_t n = 0; n < nsga2->genes; n++) {
        struct running_mean over = {0};
        for (size_t k = first; k < first + nsga2->population; k++)
            mf_statistics_add(&over, row(nsga2, k)[n]);
        sum += sqrt(over.squares / over.count);
    }
    return sum / (double)nsga2->genes;
}

size_t mf_nsga2_spans(struct nsga2 *nsga2, struct memory_span *span) {
    const size_t rows = 2 * nsga2->population;
    size_t n = 0;
    span[n++] = (struct memory_span){&nsga2->progress, sizeof nsga2->progress};
    span[n++] =
        (struct memory_span){nsga2->x, 3 * nsga2->population * nsga2->genes * sizeof(double)};
    span[n++] = (struct memory_span){nsga2->value, rows * nsga2->objectives * sizeof(double)};
    span[n++] = (struct memory_span){nsga2->measured, rows * sizeof(double)};
    span[n++] = (struct memory_span){nsga2->rank, rows * sizeof *nsga2->rank};
    span[n++] = (struct memory_span){nsga2->crowding, rows * sizeof(double)};
    span[n++] = (struct memory_span){nsga2->again, nsga2->population * sizeof *nsga2->again};
    span[n++] =
        (struct memory_span){nsga2->injected, NSGA2_INJECTED * nsga2->genes * sizeof(double)};
    return n;
}
