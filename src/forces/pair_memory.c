// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/pair_memory.h"

#include <math.h>

double mf_pair_memory_range(const struct pair_memory_law *law) {
    double range = law->transverse ? law->transverse->cutoff : 0;
    for (int m = 0; m < law->modes; m++)
        range = fmax(range, law->mode[m].omega->cutoff);
    return range;
}

// Tables ------------------------------------------------------------------------------------------

/// A function of ω for each row of its table: at the start of an interval, and its change over it.
static enum status tabulate(double (**rows)[2], const struct table *omega,
                            double (*of)(double omega, double number), double number) {
    enum status status = STATUS_OK;
    const int count = (TABLE_INTERVALS + 1) * omega->curves;
    NEW_ARRAY(*rows, count);
    for (int k = 0; k < count; k++) {
        if (k % (TABLE_INTERVALS + 1) == TABLE_INTERVALS) // beyond the cutoff is nothing
            continue;
        const double *c = omega->coefficient + 2 * k;
        (*rows)[k][0] = of(c[0], number);
        (*rows)[k][1] = of(c[0] + c[1], number) - (*rows)[k][0];
    }
done:
    return status;
}

/// tan(g Δt/√2), half the angle, with g Δt = ω `number`. A rotation of nearly half a turn a step
/// keeps the stationary law too, but follows no motion: it is not exceeded.
static double half_angle(double omega, double number) {
    static const double most = 1.4;
    return tan(fmin(omega * number * M_SQRT1_2, most));
}

/// sqrt of the damping ½ (1 − exp(−2 ω² Δt)), which is straight where ω is.
static double root_damping(double omega, double time_step) {
    return sqrt(-0.5 * expm1(-2 * omega * omega * time_step));
}

static enum status init_mode(struct pair_memory *memory, int m) {
    const struct pair_memory_mode *mode = &memory->law.mode[m];
    const double dt = memory->scene.time_step, decay = exp(-dt / mode->time);
    memory->mode[m].first = memory->variables;
    memory->mode[m].keep = decay * cos(mode->frequency * dt);
    memory->mode[m].turn = decay * sin(mode->frequency * dt);
    memory->mode[m].noise = sqrt(-memory->scene.temperature * expm1(-2 * dt / mode->time));
    memory->variables += mode->frequency > 0 ? 2 : 1;
    return tabulate(&memory->mode[m].half, mode->omega, half_angle, dt / sqrt(mode->time));
}

/// The largest distance at which anything acts on a pair type.
static double range_of(const struct pair_memory_law *law, int pair) {
    double range = law->transverse ? table_cutoff(law->transverse, pair) : 0;
    for (int m = 0; m < law->modes; m++)
        range = fmax(range, table_cutoff(law->mode[m].omega, pair));
    return range;
}

enum status mf_pair_memory_init(struct pair_memory *memory, const struct pair_memory_law *law,
                                const struct pair_memory_scene *scene) {
    *memory = (struct pair_memory){.law = *law, .scene = *scene, .builds = UINT64_MAX};
    mf_normal_table_init(&memory->normal);
    for (int pair = 0; pair < mf_composition_pairs(&scene->composition); pair++)
        memory->range[pair] = range_of(law, pair);
    for (int m = 0; m < law->modes; m++)
        TRY(init_mode(memory, m));
    return law->transverse
               ? tabulate(&memory->root, law->transverse, root_damping, scene->time_step)
               : STATUS_OK;
}

// Pairs -------------------------------------------------------------------------------------------

static void free_pairs(struct pair_memory *memory) {
    mf_memory_free(memory->first);
    mf_memory_free(memory->second);
    mf_memory_free(memory->low);
    mf_memory_free(memory->high);
    mf_memory_free(memory->kind);
    for (int k = 0; k < memory->variables; k++)
        mf_memory_free(memory->value[k]);
}

void mf_pair_memory_clear(struct pair_memory *memory) {
    free_pairs(memory);
    for (int m = 0; m < memory->law.modes; m++)
        mf_memory_free(memory->mode[m].half);
    mf_memory_free(memory->root);
    *memory = (struct pair_memory){0};
}

/// Room for `count` pairs, which are none yet; the old arrays are left to the caller.
static enum status allocate(struct pair_memory *memory, size_t count) {
    enum status status = STATUS_OK;
    memory->first = memory->second = NULL;
    memory->low = memory->high = NULL;
    memory->kind = NULL;
    memory->capacity = count;
    for (int k = 0; k < memory->variables; k++)
        memory->value[k] = NULL;
    NEW_ARRAY(memory->first, count);
    NEW_ARRAY(memory->second, count);
    NEW_ARRAY(memory->low, count);
    NEW_ARRAY(memory->high, count);
    NEW_ARRAY(memory->kind, count);
    for (int k = 0; k < memory->variables; k++)
        NEW_ARRAY(memory->value[k], count);
done:
    return status;
}

/// The pairs in range of an older list by their ids.
struct lookup {
    const struct pair_memory *old;
    size_t buckets; ///< a power of two
    uint32_t *bucket, *next;
};

static const uint32_t none = UINT32_MAX;

static size_t bucket_of(const struct lookup *lookup, uint32_t low, uint32_t high) {
    const uint64_t mixed = ((uint64_t)low << 32 | high) * 0x9E3779B97F4A7C15u;
    return (size_t)(mixed >> 32) & (lookup->buckets - 1);
}

static enum status lookup_init(struct lookup *lookup, const struct pair_memory *old) {
    enum status status = STATUS_OK;
    *lookup = (struct lookup){.old = old, .buckets = 16};
    if (old->variables == 0)
        return STATUS_OK;
    while (lookup->buckets < old->pairs)
        lookup->buckets *= 2;
    NEW_ARRAY(lookup->bucket, lookup->buckets);
    NEW_ARRAY(lookup->next, old->pairs + 1);
    memset(lookup->bucket, 0xFF, lookup->buckets * sizeof *lookup->bucket);
    for (size_t n = 0; n < old->pairs; n++) {
        if (isnan(old->value[0][n]))
            continue;
        const size_t bucket = bucket_of(lookup, old->low[n], old->high[n]);
        lookup->next[n] = lookup->bucket[bucket];
        lookup->bucket[bucket] = (uint32_t)n;
    }
done:
    return status;
}

static void lookup_clear(struct lookup *lookup) {
    mf_memory_free(lookup->bucket);
    mf_memory_free(lookup->next);
}

/// Give a new pair its old variables, or none.
static void carry(struct pair_memory *memory, size_t n, const struct lookup *lookup) {
    const struct pair_memory *old = lookup->old;
    for (int k = 0; k < memory->variables; k++)
        memory->value[k][n] = NAN;
    if (memory->variables == 0)
        return;
    uint32_t found = lookup->bucket[bucket_of(lookup, memory->low[n], memory->high[n])];
    while (found != none &&
           (old->low[found] != memory->low[n] || old->high[found] != memory->high[n]))
        found = lookup->next[found];
    for (int k = 0; found != none && k < memory->variables; k++)
        memory->value[k][n] = old->value[k][found];
}

/// Squared distance when the list was built [λ²]: a restart finds the same pairs.
static double square_of(const struct neighbours *neighbours, const struct box *box, size_t i,
                        size_t j) {
    double square = 0;
    for (int d = 0; d < box->dimensions; d++) {
        const double dx =
            box_nearest(neighbours->built[d][i] - neighbours->built[d][j], box->length[d]);
        square += dx * dx;
    }
    return square;
}

static int kind_of(const struct composition *composition, uint32_t i, uint32_t j) {
    return composition_is_mixed(composition) ? mf_composition_pair_of_ids(composition, i, j) : 0;
}

/// Pairs that may come into their range before the list is built anew. With nowhere to put them
/// they are counted.
static size_t collect_part(struct pair_memory *memory, const struct particles *particles,
                           const struct neighbours *neighbours, int p, size_t n, bool put) {
    const struct neighbours_part *part = &neighbours->part[p];
    for (size_t k = part->begin; k < part->end; k++) {
        const int32_t i = neighbours->owner[k / NEIGHBOURS_ROW], j = neighbours->list[k];
        if (i == j)
            continue;
        const uint32_t a = particles->id[i], b = particles->id[j];
        const int kind = kind_of(&memory->scene.composition, a, b);
        const double far = memory->range[kind] + neighbours->skin;
        if (memory->range[kind] == 0 ||
            square_of(neighbours, &particles->box, (size_t)i, (size_t)j) >= far * far)
            continue;
        if (put) {
            memory->first[n] = i;
            memory->second[n] = j;
            memory->low[n] = a < b ? a : b;
            memory->high[n] = a < b ? b : a;
            memory->kind[n] = kind;
        }
        n++;
    }
    return n;
}

static size_t collect(struct pair_memory *memory, const struct particles *particles,
                      const struct neighbours *neighbours, bool put) {
    size_t n = 0;
    memory->parts = neighbours->parts;
    for (int p = 0; p < neighbours->parts; p++) {
        memory->begin[p] = n;
        n = collect_part(memory, particles, neighbours, p, n, put);
        memory->end[p] = n;
    }
    return n;
}

enum status mf_pair_memory_follow(struct pair_memory *memory, const struct particles *particles,
                                  const struct neighbours *neighbours, uint64_t builds) {
    if (memory->builds == builds)
        return STATUS_OK;
    enum status status = STATUS_OK;
    struct pair_memory old = *memory;
    struct lookup lookup;
    const size_t count = collect(memory, particles, neighbours, false);
    CHECK(lookup_init(&lookup, &old));
    CHECK(allocate(memory, count));
    memory->pairs = collect(memory, particles, neighbours, true);
    memory->builds = builds;
    for (size_t n = 0; n < memory->pairs; n++)
        carry(memory, n, &lookup);
done:
    lookup_clear(&lookup);
    free_pairs(&old);
    return status;
}

double mf_pair_memory_energy(const struct pair_memory *memory, size_t *variables) {
    double energy = 0;
    *variables = 0;
    for (int k = 0; k < memory->variables; k++)
        for (size_t n = 0; n < memory->pairs; n++)
            if (!isnan(memory->value[k][n])) {
                energy += 0.5 * memory->value[k][n] * memory->value[k][n];
                ++*variables;
            }
    return energy;
}

size_t mf_pair_memory_spans(struct pair_memory *memory, struct memory_span *spans) {
    size_t n = 0;
    spans[n++] = (struct memory_span){&memory->pairs, sizeof memory->pairs};
    spans[n++] = (struct memory_span){memory->low, memory->pairs * sizeof *memory->low};
    spans[n++] = (struct memory_span){memory->high, memory->pairs * sizeof *memory->high};
    for (int k = 0; k < memory->variables; k++)
        spans[n++] = (struct memory_span){memory->value[k], memory->pairs * sizeof(double)};
    return n;
}

enum status mf_pair_memory_make_room(struct pair_memory *memory) {
    free_pairs(memory);
    memory->builds = UINT64_MAX;
    return allocate(memory, memory->pairs);
}
