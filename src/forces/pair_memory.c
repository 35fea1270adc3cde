// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/pair_memory.h"

#include "base/simd.h"
#include "forces/pair_memory_kernels.h"

#include <math.h>

double mf_pair_memory_range(const struct pair_memory_law *law) {
    double range = law->transverse ? law->transverse->cutoff : 0;
    for (int m = 0; m < law->modes; m++)
        range = fmax(range, law->mode[m].omega->cutoff);
    return range;
}

static double largest(const struct table *omega) {
    double max = 0;
    for (int k = 0; omega && k < (TABLE_INTERVALS + 1) * omega->curves; k++)
        max = fmax(max, fabs(omega->coefficient[2 * k]));
    return max;
}

bool mf_pair_memory_is_coarse(const struct pair_memory_law *law, double time_step) {
    static const double part = 0.5, max_turn = 1;
    for (int m = 0; m < law->modes; m++) {
        const struct pair_memory_mode *mode = &law->mode[m];
        const double turn = M_SQRT2 * largest(mode->omega) * time_step / sqrt(mode->time);
        if (time_step > part * mode->time || time_step * mode->frequency > part || turn > max_turn)
            return true;
    }
    return false;
}

// Tables ------------------------------------------------------------------------------------------

/// A function of ω for each row of its table: at the start of an interval, and its change over it.
/// The other two are 0: kernels read records of four.
static enum status tabulate(float (**rows)[4], const struct table *omega,
                            double (*of)(double omega, double number), double number) {
    const int count = (TABLE_INTERVALS + 1) * omega->curves;
    TRY_ARRAY(*rows, count);
    for (int k = 0; k < count; k++) {
        if (k % (TABLE_INTERVALS + 1) == TABLE_INTERVALS) // beyond the cutoff is nothing
            continue;
        const double *c = omega->coefficient + 2 * k;
        const double value = of(c[0], number);
        (*rows)[k][0] = (float)value;
        (*rows)[k][1] = (float)(of(c[0] + c[1], number) - value);
    }
    return STATUS_OK;
}

/// tan(g Δt/√2), half the angle, with g Δt = ω `number`. A rotation of nearly half a turn a step
/// keeps the stationary law too, but follows no motion: it is not exceeded.
static double half_angle(double omega, double number) {
    static const double max = 1.4;
    return tan(fmin(omega * number * M_SQRT1_2, max));
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
    memory->mode[m].noise =
        sqrt(-memory->scene.temperature * expm1(-2 * dt / mode->time)) / memory->unit;
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

/// All that depends on temperature and time step.
static enum status tabulate_all(struct pair_memory *memory) {
    const struct pair_memory_law *law = &memory->law;
    memory->variables = 0;
    memory->unit = memory->scene.temperature > 0 ? sqrt(memory->scene.temperature) : 1;
    for (int m = 0; m < law->modes; m++)
        TRY(init_mode(memory, m));
    return law->transverse
               ? tabulate(&memory->root, law->transverse, root_damping, memory->scene.time_step)
               : STATUS_OK;
}

static void free_tables(struct pair_memory *memory) {
    for (int m = 0; m < memory->law.modes; m++) {
        mf_memory_free(memory->mode[m].half);
        memory->mode[m].half = NULL;
    }
    mf_memory_free(memory->root);
    memory->root = NULL;
}

enum status mf_pair_memory_init(struct pair_memory *memory, const struct pair_memory_law *law,
                                const struct pair_memory_scene *scene) {
    *memory = (struct pair_memory){.law = *law, .scene = *scene, .builds = UINT64_MAX};
    mf_normal_table_init(&memory->normal);
    for (int pair = 0; pair < mf_composition_pairs(&scene->composition); pair++)
        memory->range[pair] = range_of(law, pair);
    return tabulate_all(memory);
}

enum status mf_pair_memory_change(struct pair_memory *memory, double temperature,
                                  double time_step) {
    memory->scene.temperature = temperature;
    memory->scene.time_step = time_step;
    free_tables(memory);
    return tabulate_all(memory);
}

// Pairs -------------------------------------------------------------------------------------------

static void free_pairs(struct pair_memory_pairs *pairs) {
    mf_memory_free(pairs->first);
    mf_memory_free(pairs->second);
    mf_memory_free(pairs->first_id);
    mf_memory_free(pairs->second_id);
    mf_memory_free(pairs->source);
    mf_memory_free(pairs->missing);
    for (int k = 0; k < PAIR_MEMORY_MAX_VARIABLES; k++)
        mf_memory_free(pairs->value[k]);
    *pairs = (struct pair_memory_pairs){0};
}

void mf_pair_memory_clear(struct pair_memory *memory) {
    free_pairs(&memory->pairs);
    free_pairs(&memory->before);
    mf_memory_free(memory->index.built);
    mf_memory_free(memory->index.begin);
    mf_memory_free(memory->index.end);
    mf_memory_free(memory->index.seen);
    mf_memory_free(memory->index.mark);
    free_tables(memory);
    *memory = (struct pair_memory){0};
}

/// Room for `count` pairs; what the arrays held is lost if they are too small.
static enum status reserve(struct pair_memory_pairs *pairs, size_t count, int variables) {
    if (count <= pairs->capacity)
        return STATUS_OK;
    const size_t capacity = count + count / 8;
    free_pairs(pairs);
    TRY_ARRAY(pairs->first, capacity + PARTICLES_PADDING);
    TRY_ARRAY(pairs->second, capacity + PARTICLES_PADDING);
    TRY_ARRAY(pairs->first_id, capacity + PARTICLES_PADDING);
    TRY_ARRAY(pairs->second_id, capacity + PARTICLES_PADDING);
    TRY_ARRAY(pairs->source, capacity + 1);
    TRY_ARRAY(pairs->missing, capacity + 1);
    for (int k = 0; k < variables; k++)
        TRY_ARRAY(pairs->value[k], capacity + 1);
    pairs->capacity = capacity;
    return STATUS_OK;
}

static enum status reserve_index(struct pair_memory_index *index, size_t particles) {
    if (index->mark)
        return STATUS_OK;
    TRY_ARRAY(index->built, particles);
    TRY_ARRAY(index->begin, particles);
    TRY_ARRAY(index->end, particles);
    TRY_ARRAY(index->seen, particles);
    TRY_ARRAY(index->mark, particles);
    return STATUS_OK;
}

/// Find the pairs of each first particle. There is no branch that a processor would not foresee.
static void index_pairs(struct pair_memory_index *index, const struct pair_memory_pairs *pairs,
                        size_t particles) {
    memset(index->begin, 0, particles * sizeof *index->begin);
    memset(index->end, 0, particles * sizeof *index->end);
    memset(index->seen, 0, particles * sizeof *index->seen);
    memset(index->mark, 0xFF, particles * sizeof *index->mark);
    uint32_t last = UINT32_MAX, begin = 0;
    uint64_t seen = 0;
    for (uint32_t n = 0; n < pairs->count; n++) {
        const uint32_t id = pairs->first_id[n];
        begin = id == last ? begin : n;
        seen = (id == last ? seen : 0) | (uint64_t)1 << pairs->second_id[n] % 64;
        index->begin[id] = begin;
        index->end[id] = n + 1;
        index->seen[id] = seen;
        last = id;
    }
}

/// Find the pairs of `before` whose particles are in the same order now, one row of the list of a
/// first particle after the other: a row of before marks the ids of the others. Lists the pairs
/// that are not among them.
/// @param[out] source   shape [pairs]: numbers in `before`; the place after its last: none
/// @param[out] missing  shape [pairs]
static size_t find_sources(struct pair_memory *memory, uint32_t *source, uint32_t *missing) {
    const struct pair_memory_index *index = &memory->index;
    const uint32_t total = (uint32_t)memory->pairs.count, none = (uint32_t)memory->before.count;
    const uint32_t *first_id = memory->pairs.first_id, *second_id = memory->pairs.second_id;
    const uint32_t *before = memory->before.second_id;
    uint32_t *mark = index->mark;
    size_t misses = 0;
    for (uint32_t n = 0; n < total;) {
        const uint32_t id = first_id[n], begin = index->begin[id], count = index->end[id] - begin;
        for (uint32_t p = begin; p < begin + count; p++)
            mark[before[p]] = p;
        for (; n < total && first_id[n] == id; n++) {
            const uint32_t place = mark[second_id[n]];
            const bool known = place - begin < count; // else it is a mark of another particle's
            source[n] = known ? place : none;
            missing[misses] = n;
            misses += !known;
        }
    }
    return misses;
}

/// The same of pairs whose particles have been in the other order, if they were there.
SIMD_CLONES static void find_turned(const struct pair_memory *memory, uint32_t *source,
                                    const uint32_t *missing, size_t count) {
    const struct pair_memory_index *index = &memory->index;
    const uint32_t *before = memory->before.second_id;
    for (size_t k = 0; k < count; k++) {
        const uint32_t n = missing[k], id = memory->pairs.first_id[n];
        const uint32_t other = memory->pairs.second_id[n];
        if (!(index->seen[other] >> id % 64 & 1))
            continue;
        uint32_t found = source[n];
        for (uint32_t p = index->begin[other]; p < index->end[other]; p++)
            found = before[p] == id ? p : found;
        source[n] = found;
    }
}

/// Give the pairs their variables of before, or none.
static void carry(struct pair_memory *memory) {
    uint32_t *source = memory->pairs.source, *missing = memory->pairs.missing;
    find_turned(memory, source, missing, find_sources(memory, source, missing));
    for (int k = 0; k < memory->variables; k++) {
        float *before = memory->before.value[k], *value = memory->pairs.value[k];
        before[memory->before.count] = NAN;
        for (size_t n = 0; n < memory->pairs.count; n++)
            value[n] = before[source[n]];
    }
}

/// Where particles were when the list was built: a restart finds the same pairs.
static void find_built(struct particle_place *built, const struct particles *particles,
                       const struct neighbours *neighbours) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double inverse_length = 1 / particles->box.length[d];
        for (size_t k = 0; k < particles->count; k++)
            built[k].fraction[d] = box_fraction(neighbours->built[d][k], inverse_length);
    }
    for (size_t k = 0; k < particles->count; k++)
        built[k].id = particles->id[k];
}

static size_t collect(struct pair_memory *memory, const struct particles *particles,
                      const struct neighbours *neighbours) {
    const struct pair_memory_kernels *kernels = mf_pair_memory_kernels();
    struct particles built = *particles;
    size_t n = 0;
    built.kernel_place = memory->index.built;
    memory->parts = neighbours->parts;
    for (int p = 0; p < neighbours->parts; p++) {
        memory->begin[p] = n;
        n = kernels->collect(memory, &built, neighbours, p, n);
        memory->end[p] = n;
    }
    return n;
}

enum status mf_pair_memory_follow(struct pair_memory *memory, const struct particles *particles,
                                  const struct neighbours *neighbours, uint64_t builds) {
    if (memory->builds == builds)
        return STATUS_OK;
    TRY(reserve_index(&memory->index, particles->count));
    find_built(memory->index.built, particles, neighbours);
    const struct pair_memory_pairs last = memory->pairs;
    memory->pairs = memory->before;
    memory->before = last;
    TRY(reserve(&memory->pairs, 1, memory->variables));
    memory->pairs.count = collect(memory, particles, neighbours);
    if (memory->pairs.count > memory->pairs.capacity) {
        const size_t count = memory->pairs.count;
        TRY(reserve(&memory->pairs, count, memory->variables));
        memory->pairs.count = collect(memory, particles, neighbours);
    }
    memory->builds = builds;
    if (memory->variables == 0)
        return STATUS_OK;
    TRY(reserve(&memory->before, 1, memory->variables));
    index_pairs(&memory->index, &memory->before, particles->count);
    carry(memory);
    return STATUS_OK;
}

size_t mf_pair_memory_spans(struct pair_memory *memory, struct memory_span *spans) {
    struct pair_memory_pairs *pairs = &memory->pairs;
    const size_t count = pairs->count;
    size_t n = 0;
    spans[n++] = (struct memory_span){&pairs->count, sizeof pairs->count};
    spans[n++] = (struct memory_span){pairs->first_id, count * sizeof *pairs->first_id};
    spans[n++] = (struct memory_span){pairs->second_id, count * sizeof *pairs->second_id};
    for (int k = 0; k < memory->variables; k++)
        spans[n++] = (struct memory_span){pairs->value[k], count * sizeof(float)};
    return n;
}

enum status mf_pair_memory_reserve(struct pair_memory *memory) {
    const size_t count = memory->pairs.count;
    memory->builds = UINT64_MAX;
    TRY(reserve(&memory->pairs, count, memory->variables));
    memory->pairs.count = count;
    return STATUS_OK;
}
