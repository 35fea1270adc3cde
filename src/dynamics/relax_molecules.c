// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/relax_molecules.h"

#include "dynamics/relax.h"
#include "system/rings.h"

#include <math.h>

// Forces with a cap -------------------------------------------------------------------------------

/// Caps in k_B T over the mean spacing.
static const double caps[] = {20, 100};
enum { STAGES = sizeof caps / sizeof *caps };

// The capped potential ----------------------------------------------------------------------------

/// A pair type's Φ, below `from` a straight line.
struct capped {
    const struct table *table;
    int pair;
    double from, value, slope;
};

static double capped_value(const void *parameters, double r) {
    const struct capped *own = parameters;
    double value;
    if (r < own->from)
        return own->value + own->slope * (r - own->from);
    mf_table_evaluate_pair(own->table, own->pair, r, &value, NULL, NULL);
    return value;
}

static double capped_cutoff(const void *parameters) {
    const struct capped *own = parameters;
    return table_cutoff(own->table, own->pair);
}

static const struct curve_family capped_family = {
    .name = "capped", .value = capped_value, .cutoff = capped_cutoff};

/// From the cutoff inwards to where the force is the cap.
static struct capped find_cap(const struct table *table, int pair, double cap) {
    struct capped capped = {.table = table, .pair = pair};
    const double cutoff = table_cutoff(table, pair);
    for (int k = TABLE_INTERVALS; k >= 0; k--) {
        const double r = cutoff * k / TABLE_INTERVALS;
        double slope;
        mf_table_evaluate_pair(table, pair, r, NULL, &slope, NULL);
        if (slope > -cap)
            continue;
        capped.from = r;
        mf_table_evaluate_pair(table, pair, r, &capped.value, NULL, NULL);
        capped.slope = -cap;
        break;
    }
    return capped;
}

static enum status cap_table(const struct table *table, double cap, struct table *to) {
    struct table part[TABLE_MAX_CURVES] = {{0}};
    enum status status = STATUS_OK;
    for (int pair = 0; pair < table->curves; pair++) {
        struct capped capped = find_cap(table, pair, cap);
        const struct curve curve = {&capped_family, &capped};
        if (table_cutoff(table, pair) > 0)
            CHECK(mf_table_init_potential(&part[pair], &curve));
    }
    CHECK(mf_table_stack(to, part, table->curves));
done:
    for (int pair = 0; pair < table->curves; pair++)
        mf_table_clear(&part[pair]);
    return status;
}

// Relaxation --------------------------------------------------------------------------------------

enum status mf_relax_soft(struct simulation *simulation) {
    const struct table *whole = simulation->law.potential;
    const struct particles *particles = &simulation->particles;
    const double spacing = pow(mf_particles_density(particles), -1.0 / particles->box.dimensions);
    const double temperature = fmax(simulation->setup.temperature, 1e-3);
    enum status status = STATUS_OK;
    for (int stage = 0; stage < STAGES && whole && status == STATUS_OK; stage++) {
        const double cap = caps[stage] * temperature / spacing;
        struct table soft = {0};
        status = cap_table(whole, cap, &soft);
        simulation->law.potential = &soft;
        if (status == STATUS_OK)
            status = mf_relax_downhill(simulation, cap / 4);
        simulation->law.potential = whole;
        mf_table_clear(&soft);
    }
    return status;
}

// Whole molecules ---------------------------------------------------------------------------------

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
