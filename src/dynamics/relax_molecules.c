// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/relax_molecules.h"

#include "dynamics/relax.h"
#include "dynamics/relax_soft.h"
#include "system/rings.h"

#include <math.h>

/// A second time is seldom needed.
enum { MAX_TIMES = 10 };

/// Size of a ring that is drawn together, in its own: no bond of another passes through it.
static const double drawn_together = 0.02;

/// Force that need not part its beads further, in k_B T over the mean spacing; much of this is in
/// any liquid.
static const double gentle = 25;

/// @param[in] second  see mf_rings_choose_linked
/// @param[out] linked  rings that were drawn together, and have grown again
static enum status unlink_rings(struct simulation *simulation, struct rings *rings, bool second,
                                size_t *linked) {
    struct particles *particles = &simulation->particles;
    const double temperature = fmax(simulation->setup.temperature, 1e-3);
    *linked = mf_rings_choose_linked(rings, particles, second);
    if (*linked == 0)
        return STATUS_OK;
    mf_rings_shrink_chosen(rings, particles, drawn_together);
    TRY(mf_neighbours_sort_and_build(&simulation->neighbours, particles));
    return mf_relax_downhill(simulation,
                             gentle * temperature * cbrt(mf_particles_density(particles)));
}

static enum status unlink_all(struct simulation *simulation) {
    enum status status = STATUS_OK;
    struct rings rings;
    size_t linked = 0;
    CHECK(mf_rings_init(&rings, simulation->particles.topology));
    if (rings.count == 0)
        goto done;
    for (int time = 0; time < MAX_TIMES; time++) {
        CHECK(unlink_rings(simulation, &rings, time % 2 != 0, &linked));
        if (linked == 0)
            goto done;
    }
    linked = mf_rings_choose_linked(&rings, &simulation->particles, false);
    if (linked > 0)
        status =
            mf_status_fail(STATUS_BAD_INPUT,
                           "molecules: %zu of %zu rings are linked with others where they were "
                           "placed, and stay so; a lower density or another seed may help",
                           linked, rings.count);
done:
    mf_rings_clear(&rings);
    return status;
}

enum status mf_relax_molecules(struct simulation *simulation) {
    TRY(mf_relax_soft(simulation));
    TRY(mf_relax_overlaps(simulation));
    if (simulation->particles.box.dimensions != 3 || simulation->law.potential == NULL)
        return STATUS_OK;
    return unlink_all(simulation);
}
