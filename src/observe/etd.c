// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/etd.h"

#include "base/simd.h"

#include <math.h>
#include <string.h>

// Etd records -------------------------------------------------------------------------------------

// The pairs that an etd follows, one record each, found by their ids.

/// In place of a record.
static const uint32_t no_record = UINT32_MAX;

static void etd_records_clear(struct etd *etd) {
    mf_memory_free(etd->first);
    mf_memory_free(etd->second);
    mf_memory_free(etd->bin);
    mf_memory_free(etd->bucket);
    mf_memory_free(etd->next);
}

static uint32_t *find_bucket(const struct etd *etd, uint32_t low, uint32_t high) {
    // Multiplicative hashing (D. E. Knuth, The Art of Computer Programming, vol. 3, section 6.4).
    const uint64_t hash = ((uint64_t)low << 32 | high) * 0x9e3779b97f4a7c15u;
    return &etd->bucket[(hash >> 32) & (etd->buckets - 1)];
}

static void link_record(struct etd *etd, size_t record) {
    uint32_t *bucket = find_bucket(etd, etd->first[record], etd->second[record]);
    etd->next[record] = *bucket;
    *bucket = (uint32_t)record;
}

/// Drop the records of escaped pairs, and make the buckets again.
static void etd_records_compact(struct etd *etd) {
    size_t kept = 0;
    memset(etd->bucket, 0xff, etd->buckets * sizeof *etd->bucket);
    for (size_t p = 0; p < etd->state.followed; p++) {
        if (etd->first[p] == etd->second[p])
            continue;
        etd->first[kept] = etd->first[p];
        etd->second[kept] = etd->second[p];
        memmove(etd->bin + kept * etd->slots, etd->bin + p * etd->slots,
                etd->slots * sizeof *etd->bin);
        link_record(etd, kept++);
    }
    etd->state.followed = kept;
}

/// Move to arrays of twice the room, with two buckets a record.
static enum status grow(struct etd *etd) {
    enum status status = STATUS_OK;
    struct etd larger = *etd;
    larger.capacity = etd->capacity ? 2 * etd->capacity : 1024;
    larger.buckets = 2 * larger.capacity;
    larger.first = larger.second = larger.bucket = larger.next = NULL;
    larger.bin = NULL;
    NEW_ARRAY(larger.first, larger.capacity);
    NEW_ARRAY(larger.second, larger.capacity);
    NEW_ARRAY(larger.bin, larger.capacity * larger.slots);
    NEW_ARRAY(larger.bucket, larger.buckets);
    NEW_ARRAY(larger.next, larger.capacity);
    if (etd->capacity > 0) {
        memcpy(larger.first, etd->first, etd->capacity * sizeof *etd->first);
        memcpy(larger.second, etd->second, etd->capacity * sizeof *etd->second);
        memcpy(larger.bin, etd->bin, etd->capacity * etd->slots * sizeof *etd->bin);
        etd_records_clear(etd);
    }
    *etd = larger;
done:
    if (status != STATUS_OK)
        etd_records_clear(&larger);
    return status;
}

enum status mf_etd_reserve(struct etd *etd) {
    while (etd->capacity == 0 || etd->state.followed > etd->capacity)
        TRY(grow(etd));
    return STATUS_OK;
}

/// The record of a pair that is within r_maximum at an origin, a new one if there is none.
static enum status etd_records_find(struct etd *etd, uint32_t low, uint32_t high, size_t *record) {
    for (uint32_t p = *find_bucket(etd, low, high); p != no_record; p = etd->next[p])
        if (etd->first[p] == low && etd->second[p] == high) {
            *record = p;
            return STATUS_OK;
        }
    if (etd->state.followed == etd->capacity) {
        TRY(grow(etd));
        etd_records_compact(etd);
    }
    *record = etd->state.followed++;
    etd->first[*record] = low;
    etd->second[*record] = high;
    memset(etd->bin + *record * etd->slots, 0xff, etd->slots * sizeof *etd->bin);
    link_record(etd, *record);
    return STATUS_OK;
}

#define GRID(name) .offset = offsetof(struct etd_settings, grid.name)
#define PLAN(name) .offset = offsetof(struct etd_settings, plan.name)
const struct field mf_etd_fields[] = {
    {"r_minimum", FIELD_NUMBER, GRID(r_minimum), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "lower edge of the bins of the first separation r_0"},
    {"r_maximum", FIELD_NUMBER, GRID(r_maximum), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda", .help = "upper edge, at which a pair has escaped"},
    {"bins", FIELD_INTEGER, GRID(bins), .initial = 100, .minimum = 1, .maximum = 10000, .unit = "",
     .help = "number of bins of r_0"},
    {"times", FIELD_INTEGER, GRID(times), .initial = 101, .minimum = 2, .maximum = 100000,
     .unit = "", .help = "number of times, including t = 0"},
    {"every", FIELD_INTEGER, PLAN(every), .initial = 1, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "interval between times; escapes in between are missed"},
    {"origin_every", FIELD_INTEGER, PLAN(origin_every), .initial = 10, .minimum = 1, .maximum = 1e6,
     .unit = "times", .help = "interval between time origins"},
    FIELD_END,
};

/// In place of a bin: the pair was too near at the origin, or not there.
static const uint16_t no_bin = UINT16_MAX;

/// Pairs whose distances are computed together.
enum { BATCH = 512 };

static enum status check(const struct etd_grid *grid, const struct box *box) {
    if (!(grid->r_maximum > grid->r_minimum))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "etd: r_maximum %g" STATUS_LENGTH
                              " is not above r_minimum %g" STATUS_LENGTH,
                              grid->r_maximum, grid->r_minimum);
    if (mf_box_shortest(box) < 2 * grid->r_maximum)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "etd: the box is too small: its shortest edge %g" STATUS_LENGTH
                              " is below twice "
                              "r_maximum, %g" STATUS_LENGTH,
                              mf_box_shortest(box), grid->r_maximum);
    return STATUS_OK;
}

/// A window is closed before the next is opened.
static size_t find_slots(const struct etd *etd) {
    const int64_t window = etd->grid.times - 1, every = etd->plan.origin_every;
    return (size_t)((window + every - 1) / every);
}

static enum status count_origins(struct etd *etd, int64_t steps) {
    const int64_t window = etd->grid.times - 1, samples = steps / etd->plan.every;
    if (samples < window)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "etd: %lld times of %lld steps are longer than the %lld steps of the "
                              "measurement",
                              (long long)window, (long long)etd->plan.every, (long long)steps);
    etd->origins = (size_t)((samples - window) / etd->plan.origin_every + 1);
    etd->blocks = etd->origins < ETD_BLOCKS ? etd->origins : ETD_BLOCKS;
    etd->slots = find_slots(etd);
    return STATUS_OK;
}

static enum status allocate(struct etd *etd, size_t count) {
    TRY_ARRAY(etd->began, etd->slots);
    TRY_ARRAY(etd->open, etd->slots * etd_cells(etd));
    TRY_ARRAY(etd->counts, etd->blocks * etd_cells(etd));
    for (int d = 0; d < 3; d++)
        TRY_ARRAY(etd->place[d], count);
    return mf_etd_reserve(etd);
}

enum status mf_etd_init(struct etd *etd, const struct etd_grid *grid, const struct etd_plan *plan,
                        const struct simulation *simulation, int64_t begin, int64_t steps) {
    enum status status = STATUS_OK;
    const struct box *box = &simulation->setup.box;
    const size_t count = simulation->particles.count;
    *etd = (struct etd){.grid = *grid, .plan = *plan, .begin = begin, .count = count};
    CHECK(check(grid, box));
    CHECK(count_origins(etd, steps));
    CHECK(allocate(etd, count));
done:
    if (status != STATUS_OK)
        mf_etd_clear(etd);
    return status;
}

enum status mf_etd_init_endless(struct etd *etd, const struct etd_grid *grid, int64_t origin_every,
                                size_t count) {
    *etd = (struct etd){.grid = *grid,
                        .plan = {.every = 1, .origin_every = origin_every},
                        .origins = SIZE_MAX,
                        .each = 1,
                        .count = count,
                        .blocks = 2 * (size_t)ETD_BLOCKS};
    etd->slots = find_slots(etd);
    const enum status status = allocate(etd, count);
    if (status != STATUS_OK)
        mf_etd_clear(etd);
    return status;
}

void mf_etd_clear(struct etd *etd) {
    etd_records_clear(etd);
    mf_memory_free(etd->began);
    mf_memory_free(etd->open);
    mf_memory_free(etd->counts);
    for (int d = 0; d < 3; d++)
        mf_memory_free(etd->place[d]);
    mf_cell_pairs_clear(&etd->search);
    *etd = (struct etd){0};
}

int64_t mf_etd_due(const struct etd *etd) {
    const int64_t last = (int64_t)(etd->origins - 1) * etd->plan.origin_every + etd->grid.times - 1;
    const int64_t sample = (int64_t)etd->state.samples;
    return sample > last ? INT64_MAX : etd->begin + sample * etd->plan.every;
}

// Sampling ----------------------------------------------------------------------------------------

/// Squared distances [λ²] from places.
struct metric {
    const int32_t *place[3];
    double edge[3][3]; ///< vectors of the box in units of 2⁻³²; 0 for an axis that is not there
    double limit;      ///< of what has escaped [λ²]
};

static struct metric make_metric(const struct etd *etd) {
    struct metric metric = {.limit = etd->grid.r_maximum * etd->grid.r_maximum};
    for (int d = 0; d < 3; d++) {
        metric.place[d] = etd->place[d];
        for (int e = 0; e < 3; e++)
            metric.edge[d][e] = etd->edge[d][e] * 0x1p-32;
    }
    return metric;
}

static inline double square_distance(const struct metric *metric, size_t a, size_t b) {
    double s[3], square = 0;
    for (int d = 0; d < 3; d++)
        s[d] = box_fraction_difference(metric->place[d][a], metric->place[d][b]);
    for (int e = 0; e < 3; e++) {
        double x = 0;
        for (int d = e; d < 3; d++)
            x += s[d] * metric->edge[d][e];
        square += x * x;
    }
    return square;
}

SIMD_CLONES static void measure_pairs(const struct metric *metric, const uint32_t *first,
                                      const uint32_t *second, size_t count,
                                      double *restrict squares) {
    const struct metric m = *metric;
    for (size_t k = 0; k < count; k++)
        squares[k] = square_distance(&m, first[k], second[k]);
}

/// Places by id. Of a simulation not those that it keeps for its kernels: these may be of the
/// middle of the step.
static void gather(struct etd *etd, const struct configuration *configuration) {
    const struct particles *const particles = configuration->particles;
    memcpy(etd->edge, configuration->box.edge, sizeof etd->edge);
    for (int d = 0; d < configuration->dimensions; d++)
        for (size_t k = 0; k < etd->count; k++)
            if (configuration->fraction)
                etd->place[d][k] = configuration->fraction[d][k];
            else
                etd->place[d][particles->id[k]] =
                    box_fraction(particles->position[d][k], configuration->box.inverse[d][d]);
}

/// Count an escape for every window that the pair is in, and end its record.
static void escape(struct etd *etd, size_t record) {
    uint16_t *bin = etd->bin + record * etd->slots;
    for (size_t slot = 0; slot < etd->slots; slot++) {
        const uint64_t time = etd->state.samples - etd->began[slot];
        if (bin[slot] != no_bin && time < (uint64_t)etd->grid.times)
            etd->open[slot * etd_cells(etd) + time * (size_t)etd->grid.bins + bin[slot]]++;
    }
    // A particle is at no distance from itself: what has escaped stays, until the next origin.
    etd->second[record] = etd->first[record];
}

static void find_escapes(struct etd *etd) {
    const struct metric metric = make_metric(etd);
    double squares[BATCH];
    for (size_t begin = 0; begin < etd->state.followed; begin += BATCH) {
        const size_t left = etd->state.followed - begin, count = left < BATCH ? left : BATCH;
        measure_pairs(&metric, etd->first + begin, etd->second + begin, count, squares);
        for (size_t k = 0; k < count; k++)
            if (squares[k] >= metric.limit)
                escape(etd, begin + k);
    }
}

/// Make of every two blocks one, of twice the origins.
static void join_blocks(struct etd *etd) {
    const size_t cells = etd_cells(etd), half = etd->blocks / 2;
    for (size_t b = 0; b < half; b++)
        for (size_t cell = 0; cell < cells; cell++)
            etd->counts[b * cells + cell] =
                etd->counts[2 * b * cells + cell] + etd->counts[(2 * b + 1) * cells + cell];
    memset(etd->counts + half * cells, 0, half * cells * sizeof *etd->counts);
    etd->each *= 2;
}

static size_t find_block(struct etd *etd, size_t origin) {
    if (etd->each == 0)
        return origin * etd->blocks / etd->origins;
    if (origin == etd->blocks * etd->each)
        join_blocks(etd);
    return origin / etd->each;
}

size_t mf_etd_complete(const struct etd *etd) {
    const uint64_t window = (uint64_t)etd->grid.times - 1, every = (uint64_t)etd->plan.origin_every;
    const uint64_t samples = etd->state.samples;
    const size_t complete = samples > window ? (size_t)((samples - 1 - window) / every + 1) : 0;
    return complete < etd->origins ? complete : etd->origins;
}

uint64_t mf_etd_pairs(const struct etd *etd) {
    uint64_t pairs = 0;
    for (size_t block = 0; block < etd->blocks; block++)
        for (int64_t bin = 0; bin < etd->grid.bins; bin++)
            pairs += etd->counts[block * etd_cells(etd) + (size_t)bin];
    return pairs;
}

/// Add the window that ends with this sample, if one does.
static void search_window(struct etd *etd) {
    const uint64_t window = (uint64_t)etd->grid.times - 1, every = (uint64_t)etd->plan.origin_every;
    const uint64_t sample = etd->state.samples;
    if (sample < window || (sample - window) % every != 0)
        return;
    const size_t origin = (sample - window) / every;
    const uint32_t *open = etd->open + origin % etd->slots * etd_cells(etd);
    uint64_t *counts = etd->counts + find_block(etd, origin) * etd_cells(etd);
    for (size_t cell = 0; cell < etd_cells(etd); cell++)
        counts[cell] += open[cell];
}

/// A pair that is within r_maximum at the origin of the window in `slot`.
static enum status begin_pair(struct etd *etd, size_t slot, uint32_t a, uint32_t b, double square) {
    size_t record;
    TRY(etd_records_find(etd, a < b ? a : b, a < b ? b : a, &record));
    const double r = sqrt(square), low = etd->grid.r_minimum, high = etd->grid.r_maximum;
    if (r < low)
        return STATUS_OK;
    const int64_t place = (int64_t)((r - low) / (high - low) * (double)etd->grid.bins);
    const int64_t max = etd->grid.bins - 1; // the quotient may be rounded up
    const uint16_t bin = (uint16_t)(place < max ? place : max);
    etd->bin[record * etd->slots + slot] = bin;
    etd->open[slot * etd_cells(etd) + bin]++;
    return STATUS_OK;
}

bool mf_etd_opens(const struct etd *etd, uint64_t sample) {
    const uint64_t every = (uint64_t)etd->plan.origin_every;
    return sample % every == 0 && sample / every < etd->origins;
}

/// Begin the window of the present sample; its slot.
static size_t open_window(struct etd *etd) {
    const uint64_t sample = etd->state.samples;
    const size_t slot = sample / (uint64_t)etd->plan.origin_every % etd->slots;
    etd->began[slot] = sample;
    memset(etd->open + slot * etd_cells(etd), 0, etd_cells(etd) * sizeof *etd->open);
    for (size_t p = 0; p < etd->state.followed; p++)
        etd->bin[p * etd->slots + slot] = no_bin;
    etd_records_compact(etd);
    return slot;
}

struct opening {
    struct etd *etd;
    const struct configuration *configuration;
    bool apart; ///< some pairs are none
    size_t slot;
    enum status status;
};

static void begin_pairs(void *context, const struct cell_pairs_batch *batch) {
    struct opening *const opening = context;
    struct etd *const etd = opening->etd;
    const double limit = etd->grid.r_maximum * etd->grid.r_maximum;
    const uint32_t *const id = etd->search.cells.order, a = id[batch->i];
    double squares[CELL_PAIRS_BATCH];
    mf_cell_pairs_squares(batch, squares);
    for (size_t k = 0; k < batch->count && opening->status == STATUS_OK; k++) {
        const uint32_t b = id[batch->begin + k];
        if (squares[k] < limit &&
            !(opening->apart && mf_configuration_leaves_out(opening->configuration, a, b)))
            opening->status = begin_pair(etd, opening->slot, a, b, squares[k]);
    }
}

enum status mf_etd_sample(struct etd *etd, const struct configuration *configuration) {
    gather(etd, configuration);
    find_escapes(etd);
    search_window(etd);
    if (mf_etd_opens(etd, etd->state.samples)) {
        struct opening opening = {etd, configuration,
                                  configuration->molecule || configuration->molecules,
                                  open_window(etd), STATUS_OK};
        TRY(mf_cell_pairs_sort(&etd->search, &configuration->box, etd->place, etd->count,
                               etd->grid.r_maximum));
        mf_cell_pairs_visit(&etd->search, begin_pairs, &opening);
        TRY(opening.status);
    }
    etd->state.samples++;
    return STATUS_OK;
}

size_t mf_etd_spans(struct etd *etd, struct memory_span *spans) {
    const size_t records = etd->state.followed, slots = etd->slots;
    size_t n = 0;
    spans[n++] = (struct memory_span){&etd->state, sizeof etd->state};
    spans[n++] = (struct memory_span){etd->first, records * sizeof *etd->first};
    spans[n++] = (struct memory_span){etd->second, records * sizeof *etd->second};
    spans[n++] = (struct memory_span){etd->bin, records * slots * sizeof *etd->bin};
    spans[n++] = (struct memory_span){etd->began, slots * sizeof *etd->began};
    spans[n++] = (struct memory_span){etd->open, slots * etd_cells(etd) * sizeof *etd->open};
    spans[n++] =
        (struct memory_span){etd->counts, etd->blocks * etd_cells(etd) * sizeof *etd->counts};
    return n;
}
