// SPDX-License-Identifier: GPL-3.0-or-later
//
// Discs, or spheres in three dimensions, that repel each other where they overlap, each with its
// own radius and stiffness:
//   U = a k_i k_j (r² − s²)² for r ≤ s = r_i + r_j,  F on i = 4 a k_i k_j (s² − r²) (r_i − r_j).
// Tested: test_soft_discs, physics/test_soft_discs.
#include "base/parallel.h"
#include "base/simd.h"
#include "forces/interaction.h"
#include "forces/soft_discs_kernels.h"

struct parameters {
    double strength;
};

struct state {
    struct soft_discs_cells cells;
    double *energy, *virial; ///< shape [count]
};

static enum status begin(const void *parameters, void *state, const struct particles *particles) {
    enum status status = STATUS_OK;
    struct state *own = state;
    (void)parameters;
    if (mf_particles_numbers(particles, "radius") == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "interactions.soft-discs: needs \"radius\" in \"particles\"");
    if (particles->topology && particles->topology->excludes)
        return mf_status_fail(STATUS_BAD_INPUT, "interactions.soft-discs: does not support "
                                                "excluded pairs of molecules; set \"exclude\": 0");
    CHECK(mf_soft_discs_cells_init(&own->cells, particles, particles->precise_place != NULL));
    const double reach = 2 * own->cells.of[own->cells.classes - 1].largest;
    if (mf_box_shortest(&particles->box) < 2 * reach)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "interactions.soft-discs: the shortest edge %g" STATUS_LENGTH " of the box is below "
            "four times the largest radius %g" STATUS_LENGTH ": two discs would interact twice",
            mf_box_shortest(&particles->box), 0.5 * reach);
    NEW_ARRAY(own->energy, particles->count);
    NEW_ARRAY(own->virial, particles->count);
done:
    return status;
}

static void clear(void *state) {
    struct state *own = state;
    mf_soft_discs_cells_clear(&own->cells);
    mf_memory_free(own->energy);
    mf_memory_free(own->virial);
}

/// Kernels for the instruction set in use.
static soft_discs_kernels *choose_set(bool is_double) {
    switch (mf_simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return is_double ? &mf_soft_discs_avx512_double : &mf_soft_discs_avx512;
    case SIMD_AVX2:
        return is_double ? &mf_soft_discs_avx2_double : &mf_soft_discs_avx2;
#endif
    default:
        return is_double ? &mf_soft_discs_portable_double : &mf_soft_discs_portable;
    }
}

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct parameters *numbers = parameters;
    struct state *own = state;
    struct particles *particles = pass->particles;
    const bool wants_sums = pass->wants == PAIR_FORCES_AND_SUMS;
    soft_discs_kernel *kernel = (*choose_set(own->cells.precise_radius !=
                                             NULL))[particles->box.dimensions == 3][wants_sums];
    mf_soft_discs_cells_sort(&own->cells, particles);
    mf_parallel_for(own->cells.blocks, particles->threads, kernel,
                    &(struct soft_discs_pass){.cells = &own->cells,
                                              .particles = particles,
                                              .strength = numbers->strength,
                                              .energy = own->energy,
                                              .virial = own->virial});
    for (size_t k = 0; k < particles->count && wants_sums; k++) {
        pass->sums->energy += own->energy[k];
        pass->sums->virial += own->virial[k];
    }
    return STATUS_OK;
}

static const struct field fields[] = {
    {"strength", FIELD_NUMBER, offsetof(struct parameters, strength), .initial = 1, .minimum = 0,
     .maximum = DBL_MAX, .unit = "k_B T_0/lambda^4", .help = "a; without \"stiffness\" k is 1"},
    FIELD_END,
};

const struct interaction mf_soft_discs = {
    .name = "soft-discs",
    .summary = "U = a k_i k_j (r^2 - s^2)^2 where r < s = r_i + r_j, of discs or spheres with a "
               "\"radius\" and "
               "\"stiffness\" k each",
    .fields = fields,
    .parameters_size = sizeof(struct parameters),
    .state_size = sizeof(struct state),
    .cost = 60,
    .finds_pairs = true,
    .begin = begin,
    .clear = clear,
    .add = add,
};
