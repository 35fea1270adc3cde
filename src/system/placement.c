// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/placement.h"

#include "base/memory.h"
#include "base/rng.h"
#include "system/cells.h"

#include <math.h>

static const char *const kinds[] = {"lattice", "random", "file", NULL};
static const char *const speeds[] = {"maxwell", "normal", "uniform", "signs",
                                     NULL}; // enum particles_speeds

#define MEMBER(name) .offset = offsetof(struct placement, name)
const struct field mf_placement_count_fields[] = {
    {"count", FIELD_INTEGER, MEMBER(count), .required = true, .minimum = 0, .maximum = 1e8,
     .unit = "", .help = "number of particles, below 2 only with a solvent"},
    FIELD_END,
};

const struct field mf_placement_fields[] = {
    {"placement", FIELD_CHOICE, MEMBER(kind), .initial = PLACEMENT_LATTICE, .choices = kinds,
     .unit = "",
     .help = "simple cubic lattice, random without overlap, or file; of molecules' first beads"},
    {"separation", FIELD_NUMBER, MEMBER(separation), .initial = 0.5, .minimum = 0,
     .maximum = DBL_MAX, .unit = "lambda", .help = "random: least distance of two particles"},
    {"slab", FIELD_NUMBER, MEMBER(slab), .initial = 0, .minimum = 0, .maximum = 1, .unit = "",
     .help = "lattice, random: part of the longest edge that is filled, in its middle; 0: all"},
    {"file", FIELD_FILE, MEMBER(file), .unit = "",
     .help = "columns x, y (, z), velocities, attributes by name, in the order of "
             "\"types\", then molecules, single beads last; or a JSON snapshot"},
    {"velocities", FIELD_CHOICE, MEMBER(speeds), .initial = PARTICLES_MAXWELL, .choices = speeds,
     .unit = "",
     .help =
         "initial velocities; maxwell: equilibrium; the others have one variance for all masses"},
    FIELD_END,
};

/// Lattice cells along each axis: the smallest grid of nearly cubic cells with room for all.
static void lattice_shape(const struct particles *particles, size_t cells[3]) {
    const struct box *box = &particles->box;
    double spacing = pow(mf_box_volume(box) / (double)particles->count, 1.0 / box->dimensions);
    for (;; spacing *= 0.999) {
        double capacity = 1;
        for (int d = 0; d < 3; d++) {
            // A part in 10⁹ forgives the rounding of count = n³ and length = n · spacing.
            cells[d] = d < box->dimensions
                           ? (size_t)fmax(1, floor(box->length[d] / spacing * (1 + 1e-9)))
                           : 1;
            capacity *= (double)cells[d];
        }
        if (capacity >= (double)particles->count)
            return;
    }
}

void mf_placement_lattice(struct particles *particles, double jitter, uint64_t seed) {
    const struct box *box = &particles->box;
    size_t cells[3];
    if (particles->count == 0)
        return;
    lattice_shape(particles, cells);
    const size_t sites = cells[0] * cells[1] * cells[2];
    for (size_t k = 0; k < particles->count; k++) {
        size_t site = placement_site(k, particles->count, sites);
        const struct rng_block block = mf_rng_philox(seed, RNG_PLACEMENT, (uint32_t)k, 0, 0);
        for (int d = box->dimensions - 1; d >= 0; d--) {
            const double spacing = box->length[d] / (double)cells[d];
            const double shift = jitter * (2 * mf_rng_uniform(block.word[d], 0) - 1);
            particles->position[d][k] = spacing * ((double)(site % cells[d]) + 0.5 + shift);
            site /= cells[d];
        }
    }
    mf_particles_wrap(particles);
    mf_particles_update_fractions(particles);
}

void mf_placement_mix(struct particles *particles, uint64_t seed) {
    struct rng_sequence sequence = mf_rng_sequence_begin(seed, RNG_MIXING, 0, 0);
    for (size_t k = particles->count; k > 1; k--) {
        const size_t other = mf_rng_sequence_below(&sequence, (uint32_t)k);
        const uint32_t id = particles->id[k - 1];
        particles->id[k - 1] = particles->id[other];
        particles->id[other] = id;
    }
}

static double wave(double periods) {
    return cos(2 * M_PI * periods);
}

void mf_placement_tilt(struct particles *particles, double tilt, uint64_t seed) {
    enum { TRIALS = 30 }; // of each particle
    const int axis = mf_placement_slab_axis(&particles->box);
    const double *place = particles->position[axis], length = particles->box.length[axis];
    struct rng_sequence sequence = mf_rng_sequence_begin(seed, RNG_MIXING, 0, 1);
    for (size_t n = 0; tilt != 0 && n < TRIALS * particles->count; n++) {
        const size_t a = mf_rng_sequence_below(&sequence, (uint32_t)particles->count);
        const size_t b = mf_rng_sequence_below(&sequence, (uint32_t)particles->count);
        const uint32_t id[2] = {particles->id[a], particles->id[b]};
        const double place_a = place[a] / length, place_b = place[b] / length;
        const double phase[2] = {id[0] / (double)particles->count,
                                 id[1] / (double)particles->count};
        const double now = wave(place_a - phase[0]) + wave(place_b - phase[1]);
        const double then = wave(place_a - phase[1]) + wave(place_b - phase[0]);
        if (!(mf_rng_sequence_uniform(&sequence) < exp(tilt * (then - now))))
            continue;
        particles->id[a] = id[1];
        particles->id[b] = id[0];
    }
}

/// Chains of those placed, in cells of an edge of at least `separation`, at most a few for each
/// particle.
struct occupied {
    int cells[3];
    int32_t *first;
    int32_t *next;
};

static enum status occupied_init(struct occupied *occupied, const struct particles *particles,
                                 double separation) {
    *occupied = (struct occupied){0};
    mf_cells_fit_box(&particles->box, separation, floor(cbrt((double)particles->count)),
                     occupied->cells);
    const size_t total = cells_total(occupied->cells);
    TRY_ARRAY(occupied->first, total);
    TRY_ARRAY(occupied->next, particles->count);
    memset(occupied->first, 0xff, total * sizeof *occupied->first); // −1: empty
    return STATUS_OK;
}

static void cell_of(const struct occupied *occupied, const struct box *box, const double x[3],
                    int cell[3]) {
    for (int d = 0; d < 3; d++)
        cell[d] = d < box->dimensions ? cells_along(x[d] / box->length[d], occupied->cells[d]) : 0;
}

static bool is_free(const struct occupied *occupied, const struct particles *particles,
                    const double x[3], double separation) {
    const struct box *box = &particles->box;
    int cell[3];
    size_t around[CELLS_AROUND];
    cell_of(occupied, box, x, cell);
    const int cells = mf_cells_around(occupied->cells, cell, box->dimensions, around);
    for (int n = 0; n < cells; n++) {
        int32_t other = occupied->first[around[n]];
        for (; other >= 0; other = occupied->next[other]) {
            double square = 0;
            for (int d = 0; d < box->dimensions; d++) {
                const double dx = box_nearest(x[d] - particles->position[d][other], box->length[d]);
                square += dx * dx;
            }
            if (square < separation * separation)
                return false;
        }
    }
    return true;
}

enum status mf_placement_random(struct particles *particles, double separation, uint64_t seed) {
    enum { TRIALS = 10000 };
    enum status status = STATUS_OK;
    const struct box *box = &particles->box;
    struct occupied occupied = {0};
    CHECK(occupied_init(&occupied, particles, separation));
    for (size_t k = 0; k < particles->count; k++) {
        double x[3] = {0};
        uint32_t trial = 0;
        do {
            if (trial == TRIALS) {
                status = mf_status_fail(
                    STATUS_BAD_INPUT,
                    "no room for particle %zu of %zu at a least distance of %g" STATUS_LENGTH ": "
                    "lower \"separation\" or place on a lattice",
                    k + 1, particles->count, separation);
                goto done;
            }
            const struct rng_block block =
                mf_rng_philox(seed, RNG_PLACEMENT, (uint32_t)k, ++trial, 0);
            for (int d = 0; d < box->dimensions; d++)
                x[d] = box->length[d] * mf_rng_uniform(block.word[d], block.word[3]);
        } while (!is_free(&occupied, particles, x, separation));
        int cell[3];
        cell_of(&occupied, box, x, cell);
        cells_enter(&occupied.first[cells_number(occupied.cells, cell)], occupied.next, (int32_t)k);
        for (int d = 0; d < box->dimensions; d++)
            particles->position[d][k] = x[d];
    }
    mf_particles_update_fractions(particles);
done:
    mf_memory_free(occupied.first);
    mf_memory_free(occupied.next);
    return status;
}

int mf_placement_slab_axis(const struct box *box) {
    int longest = 0;
    for (int d = 1; d < box->dimensions; d++)
        longest = box->length[d] >= box->length[longest] ? d : longest;
    return longest;
}

enum status mf_placement_fill(struct particles *particles, const struct placement *placement,
                              uint64_t seed) {
    const struct box box = particles->box;
    const int axis = mf_placement_slab_axis(&box);
    const double share = placement->slab > 0 ? placement->slab : 1;
    enum status status = STATUS_OK;
    particles->box.length[axis] *= share;
    if (placement->kind == PLACEMENT_RANDOM)
        status = mf_placement_random(particles, placement->separation, seed);
    else
        mf_placement_lattice(particles, placement->jitter, seed);
    particles->box = box;
    if (share == 1)
        return status;
    for (size_t k = 0; k < particles->count; k++)
        particles->position[axis][k] += 0.5 * (1 - share) * box.length[axis];
    mf_particles_update_fractions(particles);
    return status;
}

enum status mf_placement_disordered(struct particles *particles, uint64_t seed) {
    static const double share = 0.7;
    const struct box *box = &particles->box;
    const double distance =
        pow(mf_box_volume(box) / (double)particles->count, 1.0 / box->dimensions);
    return mf_placement_random(particles, share * distance, seed);
}
