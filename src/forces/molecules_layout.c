// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/molecules_layout.h"

#include "base/parallel.h"

enum {
    LANES = BONDED_LANES,
    FEWEST = LANES / 2, ///< molecules of a kind that fill lanes well enough
    BUCKET = 64,        ///< places in which the first beads of molecules are in any order
};

// Begin -------------------------------------------------------------------------------------------

static bool is_single(const struct topology_kind *kind) {
    return kind->count < FEWEST;
}

/// Molecules that are in the same bundles.
static int64_t together(const struct topology_kind *kind) {
    return is_single(kind) ? 1 : LANES;
}

static int64_t teams(const struct topology_kind *kind) {
    return (kind->count + together(kind) - 1) / together(kind);
}

/// Bundles of a motif in a team.
static int bundles_each(const struct molecules_motif *motif) {
    return (motif->copies + LANES - 1) / LANES;
}

static enum status reserve(struct molecules_layout *layout, const struct particles *particles) {
    size_t bundles = 0, rows = 0;
    for (int k = 0; k < layout->topology->kinds; k++)
        for (int n = 0; n < layout->motifs[k].count; n++) {
            const struct molecules_motif *motif = &layout->motifs[k].motif[n];
            const size_t more =
                (size_t)teams(&layout->topology->kind[k]) * (size_t)bundles_each(motif);
            bundles += more;
            rows += more * (size_t)motif->beads;
        }
    TRY_ARRAY(layout->bundle, bundles);
    TRY_ARRAY(layout->place, rows * LANES);
    TRY_ARRAY(layout->sequence, (size_t)layout->topology->molecules);
    TRY_ARRAY(layout->bucket, particles->count / BUCKET + 2);
    return STATUS_OK;
}

/// Append the bundles of a team of molecules.
static void add_team(struct molecules_layout *layout, int k, int64_t team, size_t *bundles,
                     size_t *rows) {
    const struct topology_kind *kind = &layout->topology->kind[k];
    const int64_t first = team * together(kind), left = kind->count - first;
    for (int n = 0; n < layout->motifs[k].count; n++) {
        const struct molecules_motif *motif = &layout->motifs[k].motif[n];
        for (int copy = 0; copy < motif->copies; copy += LANES) {
            const int64_t all = is_single(kind) ? motif->copies - copy : left;
            layout->bundle[(*bundles)++] =
                (struct molecules_bundle){.kind = kind,
                                          .motif = motif,
                                          .lanes = all < LANES ? (int)all : LANES,
                                          .molecule = first,
                                          .copy = copy,
                                          .row = *rows};
            *rows += (size_t)motif->beads;
        }
    }
}

static void add_teams(struct molecules_layout *layout) {
    const struct topology *topology = layout->topology;
    int64_t all = 0, number = 0;
    size_t bundles = 0, rows = 0;
    for (int k = 0; k < topology->kinds; k++)
        all += teams(&topology->kind[k]);
    layout->blocks = all < MOLECULES_MAX_BLOCKS ? (int)all : MOLECULES_MAX_BLOCKS;
    for (int k = 0, block = 0; k < topology->kinds; k++)
        for (int64_t team = 0; team < teams(&topology->kind[k]); team++, number++) {
            if (number == all * block / layout->blocks)
                layout->start[block++] = bundles;
            add_team(layout, k, team, &bundles, &rows);
        }
    layout->start[layout->blocks] = bundles;
}

enum status mf_molecules_layout_init(struct molecules_layout *layout,
                                     const struct topology *topology,
                                     const struct particles *particles) {
    layout->topology = topology;
    layout->orders = particles->orders - 1; // not this one: places are not known
    for (int k = 0; k < topology->kinds; k++)
        TRY(mf_molecules_motifs_find(&layout->motifs[k], &topology->kind[k],
                                     is_single(&topology->kind[k])));
    TRY(reserve(layout, particles));
    add_teams(layout);
    return STATUS_OK;
}

void mf_molecules_layout_clear(struct molecules_layout *layout) {
    for (int k = 0; k < TOPOLOGY_MAX_KINDS; k++)
        mf_molecules_motifs_clear(&layout->motifs[k]);
    mf_memory_free(layout->bundle);
    mf_memory_free(layout->sequence);
    mf_memory_free(layout->bucket);
    mf_memory_free(layout->place);
}

// Places ------------------------------------------------------------------------------------------

/// Sort the molecules of a kind by the buckets of their first beads.
static void sort_molecules(struct molecules_layout *layout, const struct topology_kind *kind,
                           const struct particles *particles) {
    const size_t buckets = particles->count / BUCKET + 1;
    uint32_t *begin = layout->bucket, *sequence = layout->sequence + kind->first;
    memset(begin, 0, (buckets + 1) * sizeof *begin);
    for (int64_t m = 0; m < kind->count; m++)
        begin[particles->place[topology_id(kind, m, 0)] / BUCKET + 1]++;
    for (size_t n = 0; n < buckets; n++)
        begin[n + 1] += begin[n];
    for (int64_t m = 0; m < kind->count; m++)
        sequence[begin[particles->place[topology_id(kind, m, 0)] / BUCKET]++] = (uint32_t)m;
}

struct placing {
    struct molecules_layout *layout;
    const struct particles *particles;
};

/// Lanes beyond the last one repeat it.
static void place_bundle(const struct placing *placing, const struct molecules_bundle *bundle) {
    const struct topology_kind *kind = bundle->kind;
    const struct molecules_motif *motif = bundle->motif;
    const uint32_t *sequence = placing->layout->sequence + kind->first + bundle->molecule;
    int32_t *place = placing->layout->place + bundle->row * LANES;
    uint32_t molecule[LANES];
    const int *bead[LANES];
    for (int l = 0; l < LANES; l++) {
        const int lane = l < bundle->lanes ? l : bundle->lanes - 1;
        molecule[l] = sequence[motif->copies == 1 ? lane : 0];
        bead[l] = motif->bead + (bundle->copy + (motif->copies == 1 ? 0 : lane)) * motif->beads;
    }
    for (int b = 0; b < motif->beads; b++)
        for (int l = 0; l < LANES; l++)
            *place++ =
                (int32_t)placing->particles->place[topology_id(kind, molecule[l], bead[l][b])];
}

static void place_blocks(void *context, size_t begin, size_t end) {
    const struct placing *placing = context;
    const struct molecules_layout *layout = placing->layout;
    for (size_t n = layout->start[begin]; n < layout->start[end]; n++)
        place_bundle(placing, &layout->bundle[n]);
}

void mf_molecules_layout_follow(struct molecules_layout *layout,
                                const struct particles *particles) {
    struct placing placing = {layout, particles};
    if (layout->orders == particles->orders)
        return;
    for (int k = 0; k < layout->topology->kinds; k++)
        sort_molecules(layout, &layout->topology->kind[k], particles);
    mf_parallel_for((size_t)layout->blocks, particles->threads, place_blocks, &placing);
    layout->orders = particles->orders;
}
