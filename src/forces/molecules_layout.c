// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/molecules_layout.h"

#include "base/parallel.h"

#include <stdlib.h>

// Motifs ------------------------------------------------------------------------------------------

/// A term, and where it stands when terms near each other along the molecule follow each other.
struct numbered_term {
    const struct topology_term *term;
    int order, lowest; ///< of its beads
};

static int lowest_bead(const struct topology_term *term, int order) {
    int lowest = term->bead[0];
    for (int k = 1; k < mf_bonded_kinds[order]->beads; k++)
        lowest = term->bead[k] < lowest ? term->bead[k] : lowest;
    return lowest;
}

/// In the order of the topology, within an order of terms.
static int compare_numbers(const struct numbered_term *a, const struct numbered_term *b) {
    return a->order != b->order ? a->order - b->order : (a->term > b->term) - (a->term < b->term);
}

static int compare_beads(const void *a, const void *b) {
    const struct numbered_term *one = a, *other = b;
    return one->lowest != other->lowest ? one->lowest - other->lowest : compare_numbers(one, other);
}

static int compare_groups(const void *a, const void *b) {
    const struct numbered_term *one = a, *other = b;
    return one->order == other->order && one->term->group != other->term->group
               ? one->term->group - other->term->group
               : compare_numbers(one, other);
}

static int list_terms(const struct topology_kind *kind, struct numbered_term *terms) {
    int count = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < kind->terms[order]; n++) {
            const struct topology_term *term = &kind->term[order][n];
            terms[count++] = (struct numbered_term){term, order, lowest_bead(term, order)};
        }
    return count;
}

/// Number the beads of a piece as its terms come, as long as there is room.
/// @param[in,out] number  shape [beads of the kind]: in the piece, −1 of others
/// @return the terms that it takes
static int number_beads(struct molecules_motif *motif, const struct numbered_term *terms, int count,
                        int *number) {
    for (int n = 0; n < count; n++) {
        if (motif->beads + mf_bonded_kinds[terms[n].order]->beads > BONDED_MAX_BEADS)
            return n;
        for (int k = 0; k < mf_bonded_kinds[terms[n].order]->beads; k++) {
            const int bead = terms[n].term->bead[k];
            if (number[bead] >= 0)
                continue;
            number[bead] = motif->beads;
            motif->bead[motif->beads++] = bead;
        }
    }
    return count;
}

/// Make the next piece, of the first of some terms, which are put into the order of their groups.
/// @param[out] taken  how many they are
static enum status add_piece(struct molecules_motifs *motifs, struct numbered_term *terms,
                             int count, int *number, int *taken) {
    struct molecules_motif *motif = &motifs->motif[motifs->count++];
    int *next;
    motif->copies = 1;
    TRY_ARRAY(motif->bead, BONDED_MAX_BEADS);
    *taken = number_beads(motif, terms, count, number);
    TRY_ARRAY(motif->term_bead, (size_t)*taken * BONDED_MAX_TERM_BEADS);
    next = motif->term_bead;
    qsort(terms, (size_t)*taken, sizeof *terms, compare_groups);
    for (int n = 0; n < *taken; n++) {
        motif->terms[terms[n].order][terms[n].term->group]++;
        for (int k = 0; k < mf_bonded_kinds[terms[n].order]->beads; k++)
            *next++ = number[terms[n].term->bead[k]];
    }
    for (int b = 0; b < motif->beads; b++)
        number[motif->bead[b]] = -1;
    return STATUS_OK;
}

static enum status add_pieces(struct molecules_motifs *motifs, const struct topology_kind *kind,
                              struct numbered_term *terms, int count) {
    enum status status = STATUS_OK;
    int *number, taken = 0;
    NEW_ARRAY(number, (size_t)kind->beads);
    for (int b = 0; b < kind->beads; b++)
        number[b] = -1;
    qsort(terms, (size_t)count, sizeof *terms, compare_beads);
    for (int n = 0; n < count; n += taken)
        CHECK(add_piece(motifs, terms + n, count - n, number, &taken));
done:
    mf_memory_free(number);
    return status;
}

/// Make a motif of all terms of the group of the first.
/// @param[out] taken  how many they are
static enum status add_single(struct molecules_motifs *motifs, const struct numbered_term *terms,
                              int count, int *taken) {
    struct molecules_motif *motif = &motifs->motif[motifs->count++];
    const int order = terms->order, group = terms->term->group;
    motif->beads = mf_bonded_kinds[order]->beads;
    motif->terms[order][group] = 1;
    TRY_ARRAY(motif->bead, (size_t)count * BONDED_MAX_TERM_BEADS);
    TRY_ARRAY(motif->term_bead, BONDED_MAX_TERM_BEADS);
    for (int k = 0; k < motif->beads; k++)
        motif->term_bead[k] = k;
    for (; motif->copies < count && terms[motif->copies].order == order &&
           terms[motif->copies].term->group == group;
         motif->copies++)
        for (int k = 0; k < motif->beads; k++)
            motif->bead[motif->copies * motif->beads + k] = terms[motif->copies].term->bead[k];
    *taken = motif->copies;
    return STATUS_OK;
}

static enum status add_singles(struct molecules_motifs *motifs, struct numbered_term *terms,
                               int count) {
    int taken = 0;
    qsort(terms, (size_t)count, sizeof *terms, compare_groups);
    for (int n = 0; n < count; n += taken)
        TRY(add_single(motifs, terms + n, count - n, &taken));
    return STATUS_OK;
}

/// Find them: pieces of up to BONDED_MAX_BEADS beads, or single terms.
static enum status find(struct molecules_motifs *motifs, const struct topology_kind *kind,
                        bool single) {
    // A piece that is full has this many terms at least.
    enum { FEWEST_TERMS = BONDED_MAX_BEADS / BONDED_MAX_TERM_BEADS - 1 };
    OWNED struct numbered_term *terms = NULL;
    size_t count = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        count += (size_t)kind->terms[order];
    TRY_ARRAY(terms, count);
    TRY_ARRAY(motifs->motif,
              single ? (size_t)BONDED_KINDS * MOLECULES_MAX_GROUPS : count / FEWEST_TERMS + 1);
    list_terms(kind, terms);
    return single ? add_singles(motifs, terms, (int)count)
                  : add_pieces(motifs, kind, terms, (int)count);
}

static void clear(struct molecules_motifs *motifs) {
    for (int n = 0; n < motifs->count; n++) {
        mf_memory_free(motifs->motif[n].bead);
        mf_memory_free(motifs->motif[n].term_bead);
    }
    mf_memory_free(motifs->motif);
    *motifs = (struct molecules_motifs){0};
}

// Layouts -----------------------------------------------------------------------------------------

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
        TRY(find(&layout->motifs[k], &topology->kind[k], is_single(&topology->kind[k])));
    TRY(reserve(layout, particles));
    add_teams(layout);
    return STATUS_OK;
}

void mf_molecules_layout_clear(struct molecules_layout *layout) {
    for (int k = 0; k < TOPOLOGY_MAX_KINDS; k++)
        clear(&layout->motifs[k]);
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
