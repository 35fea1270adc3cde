// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/molecules_motifs.h"

#include <stdlib.h>

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

enum status mf_molecules_motifs_find(struct molecules_motifs *motifs,
                                     const struct topology_kind *kind, bool single) {
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

void mf_molecules_motifs_clear(struct molecules_motifs *motifs) {
    for (int n = 0; n < motifs->count; n++) {
        mf_memory_free(motifs->motif[n].bead);
        mf_memory_free(motifs->motif[n].term_bead);
    }
    mf_memory_free(motifs->motif);
    *motifs = (struct molecules_motifs){0};
}
