// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/hnc_closure.h"
#include "inversion/ornstein_zernike.h"

#include <math.h>
#include <string.h>

/// Cells of all pair types together are no more than this, as bins are joined, ...
enum { MAX_CELLS = 400 };

/// ... but of each pair type as many at least: h − c is smooth.
enum { MIN_CELLS = 40 };

/// Rounds in which S(0), which says how an infinite system differs from N particles, settles.
enum { ROUNDS = 6 };

/// Where there is no liquid with these g within the softness that is asked for, h may be missed by
/// so much of g² c, then by ten times as much.
static const double more_softness = 1e-3;
enum { TRIES = 4 };

struct work {
    struct ornstein_zernike oz;
    size_t core, join; ///< cells below the first bin, and bins of each of the others
    double *g, *h;     ///< of N particles, and as if they were infinitely many; [pairs, cells]
};

static void work_clear(struct work *work) {
    mf_ornstein_zernike_clear(&work->oz);
    mf_memory_free(work->g);
    mf_memory_free(work->h);
}

/// How many bins are joined to a cell.
static size_t find_join(const struct rdf_bins *bins, size_t pairs) {
    const size_t most = MAX_CELLS / pairs > MIN_CELLS ? MAX_CELLS / pairs : MIN_CELLS;
    return (bins->count - 1) / most + 1;
}

/// Cells of the core below the first bin, about as wide as the others, then the bins joined.
static enum status find_cells(struct work *work, const struct hnc_liquid *liquid) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = liquid->bins;
    const size_t join = find_join(bins, (size_t)mf_composition_pairs(liquid->composition));
    const size_t core = (size_t)ceil(bins->low / (bins->width * (double)join) - 1e-6);
    const size_t cells = core + (bins->count - 1) / join + 1;
    double *edge = NULL;
    work->core = core;
    work->join = join;
    NEW_ARRAY(edge, cells + 1);
    for (size_t k = 0; k < core; k++)
        edge[k] = bins->low * (double)k / (double)core;
    for (size_t k = core; k < cells; k++)
        edge[k] = mf_rdf_bins_edge(bins, (k - core) * join);
    edge[cells] = mf_rdf_bins_range(bins);
    CHECK(mf_ornstein_zernike_init(&work->oz, edge, cells, liquid->composition,
                                   mf_box_volume(liquid->box)));
    NEW_ARRAY(work->g, work->oz.pairs * cells);
    NEW_ARRAY(work->h, work->oz.pairs * cells);
done:
    mf_memory_free(edge);
    return status;
}

/// Mean over a cell of what is given for the bins of a pair type; 0 in the core.
static double mean_in(const struct work *work, const struct rdf_bins *bins, const double *values,
                      size_t cell) {
    double sum = 0;
    if (cell < work->core)
        return 0;
    const size_t first = (cell - work->core) * work->join, last = first + work->join;
    for (size_t bin = first; bin < last && bin < bins->count; bin++)
        sum += values[bin] *
               (pow(mf_rdf_bins_edge(bins, bin + 1), 3) - pow(mf_rdf_bins_edge(bins, bin), 3));
    return sum * 4 * M_PI / 3 / work->oz.volume[cell];
}

/// g of each cell, over N_a² pairs of like beads, and Ω.
static void fill(struct work *work, const struct hnc_liquid *liquid, const double *g) {
    struct ornstein_zernike *oz = &work->oz;
    for (size_t p = 0; p < oz->pairs; p++) {
        int type[2];
        mf_composition_pair_types(liquid->composition, (int)p, type);
        const size_t a = (size_t)type[0], b = (size_t)type[1], types = oz->types;
        const double like = a == b ? 1 - 1 / (double)liquid->composition->count[a] : 1;
        const double density = sqrt(oz->density[a] * oz->density[b]);
        for (size_t k = 0; k < oz->cells; k++) {
            const size_t n = p * oz->cells + k, bin = p * liquid->bins->count;
            work->g[n] = like * mean_in(work, liquid->bins, g + bin, k);
            if (!liquid->inside)
                continue;
            const double inside = density * mean_in(work, liquid->bins, liquid->inside + bin, k);
            for (size_t wave = 0; wave < oz->waves; wave++) {
                double *omega = oz->intramolecular + wave * types * types;
                const double value = inside * oz->transform[wave * oz->cells + k];
                omega[a * types + b] += value;
                omega[b * types + a] += a == b ? 0 : value;
            }
        }
    }
}

/// h as of an infinite system with such S(0): of one whose particles are always N, g is too small
/// by the factor 1 − S_ab(0)/(V sqrt(ρ_a ρ_b)), as the numbers in parts of a large one vary. Pairs
/// that do not exist do not repel each other.
static void enlarge(struct work *work, const struct hnc_liquid *liquid, const double *structure) {
    static const double most = 0.9; // of few molecules, while S(0) is not known
    const struct ornstein_zernike *oz = &work->oz;
    const double volume = mf_box_volume(liquid->box);
    for (size_t p = 0; p < oz->pairs; p++) {
        int type[2];
        mf_composition_pair_types(liquid->composition, (int)p, type);
        const bool exists = mf_composition_has_pairs(liquid->composition, (int)p);
        const double missing = structure[(size_t)type[0] * oz->types + (size_t)type[1]] /
                               (volume * sqrt(oz->density[type[0]] * oz->density[type[1]]));
        for (size_t n = p * oz->cells; n < (p + 1) * oz->cells; n++)
            work->h[n] = exists ? work->g[n] / (1 - fmin(missing, most)) - 1 : 0;
    }
}

/// c, with S(0) as it follows from it; false if there is no such liquid.
static enum status solve_softly(struct work *work, const struct hnc_liquid *liquid, double softness,
                                bool *found) {
    struct ornstein_zernike *oz = &work->oz;
    double structure[COMPOSITION_MAX_TYPES * COMPOSITION_MAX_TYPES] = {0};
    for (size_t n = 0; n < oz->pairs * oz->cells; n++) {
        oz->softness[n] = softness * work->g[n] * work->g[n];
        oz->c[n] = 0;
    }
    *found = true;
    for (int round = 0; round < ROUNDS && *found; round++) {
        enlarge(work, liquid, structure);
        TRY(mf_ornstein_zernike_solve(oz, work->h, structure));
        *found = isfinite(structure[0]);
    }
    return STATUS_OK;
}

/// Where all fails c is h, and h − c is 0.
static enum status solve(struct work *work, const struct hnc_liquid *liquid) {
    double softness = liquid->softness;
    bool found = false;
    if (!mf_ornstein_zernike_set_molecules(&work->oz))
        return mf_status_fail(STATUS_BAD_INPUT, "no molecules have such distances");
    for (int n = 0; n < TRIES && !found; n++) {
        TRY(solve_softly(work, liquid, softness, &found));
        softness = fmax(10 * softness, more_softness);
    }
    if (!found)
        memcpy(work->oz.c, work->h, work->oz.pairs * work->oz.cells * sizeof *work->h);
    return STATUS_OK;
}

/// h − c at a distance, between the centres of cells.
static double indirect_at(const struct work *work, size_t pair, double r) {
    const struct ornstein_zernike *oz = &work->oz;
    const double *h = work->h + pair * oz->cells, *c = oz->c + pair * oz->cells;
    size_t k = 0;
    if (oz->cells == 1)
        return h[0] - c[0];
    while (k + 2 < oz->cells && 0.5 * (oz->edge[k + 1] + oz->edge[k + 2]) < r)
        k++;
    const double left = 0.5 * (oz->edge[k] + oz->edge[k + 1]);
    const double right = 0.5 * (oz->edge[k + 1] + oz->edge[k + 2]);
    const double part = (r - left) / (right - left);
    return (1 - part) * (h[k] - c[k]) + part * (h[k + 1] - c[k + 1]);
}

enum status mf_hnc_closure(const struct hnc_liquid *liquid, const double *g, double *indirect) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = liquid->bins;
    struct work work = {0};
    if (liquid->box->dimensions != 3)
        return mf_status_fail(STATUS_BAD_INPUT, "the hypernetted chain is for three dimensions");
    CHECK(find_cells(&work, liquid));
    fill(&work, liquid, g);
    CHECK(solve(&work, liquid));
    for (size_t p = 0; p < work.oz.pairs; p++)
        for (size_t k = 0; k < bins->count; k++)
            indirect[p * bins->count + k] = indirect_at(&work, p, mf_rdf_bins_centre(bins, k));
done:
    work_clear(&work);
    return status;
}
