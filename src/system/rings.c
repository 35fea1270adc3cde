// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/rings.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Rings of a kind ---------------------------------------------------------------------------------

/// The path from a to b along the tree, which a bond of the two closes. `bead` may be NULL.
/// @return its beads
static int trace_ring(const int *parent, const int *depth, int a, int b, int *bead) {
    int top = a, other = b;
    while (top != other)
        if (depth[top] >= depth[other])
            top = parent[top];
        else
            other = parent[other];
    const int length = depth[a] + depth[b] - 2 * depth[top] + 1;
    if (bead == NULL)
        return length;
    for (; a != top; a = parent[a])
        *bead++ = a;
    *bead = top;
    for (int n = depth[b] - depth[top]; n > 0; b = parent[b])
        bead[n--] = b;
    return length;
}

/// The rings' beads, or without `start` only how many there are.
static int trace_rings(const struct topology_kind *kind, const int *parent, const int *depth,
                       int *start, int *bead, int *rings) {
    int beads = 0;
    *rings = 0;
    for (int n = 0; n < kind->terms[BONDED_BOND]; n++) {
        const int *pair = kind->term[BONDED_BOND][n].bead;
        if (parent[pair[0]] == pair[1] || parent[pair[1]] == pair[0])
            continue;
        beads += trace_ring(parent, depth, pair[0], pair[1], bead ? bead + beads : NULL);
        ++*rings;
        if (start)
            start[*rings] = beads;
    }
    return beads;
}

/// The least bead that is joined to each by rings.
static void find_ring_systems(struct ring_kind *own, int beads) {
    for (int bead = 0; bead < beads; bead++)
        own->ring_system[bead] = -1;
    for (int k = 0; k < own->start[own->rings]; k++)
        own->ring_system[own->bead[k]] = own->bead[k];
    for (bool changed = true; changed;) {
        changed = false;
        for (int n = 0; n < own->rings; n++) {
            int min = beads;
            for (int k = own->start[n]; k < own->start[n + 1]; k++)
                min = own->ring_system[own->bead[k]] < min ? own->ring_system[own->bead[k]] : min;
            for (int k = own->start[n]; k < own->start[n + 1]; k++) {
                changed |= own->ring_system[own->bead[k]] != min;
                own->ring_system[own->bead[k]] = min;
            }
        }
    }
}

static enum status find_kind(const struct topology_kind *kind, const int *order, const int *parent,
                             struct ring_kind *own) {
    enum status status = STATUS_OK;
    int *depth = NULL;
    NEW_ARRAY(depth, kind->beads);
    for (int n = 0; n < kind->beads; n++)
        depth[order[n]] = parent[order[n]] < 0 ? 0 : depth[parent[order[n]]] + 1;
    const int beads = trace_rings(kind, parent, depth, NULL, NULL, &own->rings);
    if (own->rings == 0)
        goto done;
    NEW_ARRAY(own->start, own->rings + 1);
    NEW_ARRAY(own->bead, beads);
    NEW_ARRAY(own->ring_system, kind->beads);
    trace_rings(kind, parent, depth, own->start, own->bead, &own->rings);
    find_ring_systems(own, kind->beads);
done:
    mf_memory_free(depth);
    return status;
}

// Rings of all molecules --------------------------------------------------------------------------

static void list_rings(struct rings *rings) {
    struct ring *ring = rings->ring;
    double(*corner)[3] = rings->corner;
    for (int k = 0; k < rings->whole.topology->kinds; k++) {
        const struct ring_kind *own = &rings->kind[k];
        for (int64_t m = 0; own->rings > 0 && m < rings->whole.topology->kind[k].count; m++)
            for (int n = 0; n < own->rings; n++) {
                const int corners = own->start[n + 1] - own->start[n];
                *ring++ = (struct ring){
                    .kind = k, .number = n, .molecule = m, .corners = corners, .corner = corner};
                corner += corners;
            }
    }
}

enum status mf_rings_init(struct rings *rings, const struct topology *topology) {
    enum status status = STATUS_OK;
    size_t corners = 0;
    *rings = (struct rings){0};
    CHECK(mf_whole_molecules_init(&rings->whole, topology));
    for (int k = 0; k < topology->kinds; k++) {
        const size_t first = (size_t)k * rings->whole.max_beads;
        struct ring_kind *own = &rings->kind[k];
        CHECK(find_kind(&topology->kind[k], rings->whole.order + first, rings->whole.parent + first,
                        own));
        const size_t count = (size_t)topology->kind[k].count;
        rings->count += count * (size_t)own->rings;
        corners += own->rings > 0 ? count * (size_t)own->start[own->rings] : 0;
    }
    if (rings->count == 0)
        goto done;
    NEW_ARRAY(rings->ring, rings->count);
    NEW_ARRAY(rings->corner, corners);
    NEW_ARRAY(rings->order, rings->count);
    list_rings(rings);
done:
    return status;
}

void mf_rings_clear(struct rings *rings) {
    for (int k = 0; k < TOPOLOGY_MAX_KINDS; k++) {
        mf_memory_free(rings->kind[k].start);
        mf_memory_free(rings->kind[k].bead);
        mf_memory_free(rings->kind[k].ring_system);
    }
    mf_whole_molecules_clear(&rings->whole);
    mf_memory_free(rings->ring);
    mf_memory_free(rings->corner);
    mf_memory_free(rings->order);
    *rings = (struct rings){0};
}

/// A ring is to be drawn together at that of its corners which is farthest from `centre`.
static void choose(struct ring *ring, const double centre[3]) {
    double farthest = -1;
    ring->chosen = true;
    for (int k = 0; k < ring->corners; k++) {
        double square = 0;
        for (int d = 0; d < 3; d++)
            square += pow(ring->corner[k][d] - centre[d], 2);
        if (square <= farthest)
            continue;
        farthest = square;
        memcpy(ring->anchor, ring->corner[k], sizeof ring->anchor);
    }
}

/// Corners, centre and radius of a ring of the molecule that was made whole last, whose first bead
/// is at `origin`. One that closes only around the box is chosen.
static void look_at(const struct rings *rings, struct ring *ring, const double origin[3],
                    const struct box *box) {
    const struct ring_kind *own = &rings->kind[ring->kind];
    const int *bead = own->bead + own->start[ring->number];
    double square = 0;
    bool wound = false;
    ring->chosen = false;
    for (int d = 0; d < 3; d++) {
        double sum = 0;
        for (int k = 0; k < ring->corners; k++) {
            ring->corner[k][d] = origin[d] + rings->whole.place[bead[k]][d];
            sum += ring->corner[k][d];
        }
        ring->centre[d] = sum / ring->corners;
        const double gap = ring->corner[ring->corners - 1][d] - ring->corner[0][d];
        wound |= fabs(gap) > box->length[d] / 2;
    }
    for (int k = 0; k < ring->corners; k++) {
        double here = 0;
        for (int d = 0; d < 3; d++)
            here += pow(ring->corner[k][d] - ring->centre[d], 2);
        square = fmax(square, here);
    }
    ring->radius = sqrt(square);
    if (wound)
        choose(ring, ring->centre);
}

/// Place of a molecule's first bead, from which the others are measured.
static void find_origin(const struct rings *rings, const struct particles *particles, int kind,
                        int64_t m, double origin[3]) {
    const int first = rings->whole.order[(size_t)kind * rings->whole.max_beads];
    const uint32_t id = topology_id(&rings->whole.topology->kind[kind], m, first);
    for (int d = 0; d < 3; d++)
        origin[d] = particles->position[d][particles->place[id]];
}

static void look_at_all(struct rings *rings, const struct particles *particles) {
    for (size_t r = 0; r < rings->count; r++) {
        struct ring *ring = &rings->ring[r];
        double origin[3];
        if (ring->number == 0)
            mf_whole_molecules_make(&rings->whole, particles, ring->kind, ring->molecule);
        find_origin(rings, particles, ring->kind, ring->molecule, origin);
        look_at(rings, ring, origin, &particles->box);
    }
}

// Links -------------------------------------------------------------------------------------------

/// Six times the volume of the tetrahedron of four points; its sign is on which side of a, b, c the
/// fourth one lies.
static double volume(const double a[3], const double b[3], const double c[3], const double p[3]) {
    double x[3], y[3], z[3];
    for (int d = 0; d < 3; d++) {
        x[d] = a[d] - p[d];
        y[d] = b[d] - p[d];
        z[d] = c[d] - p[d];
    }
    return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
           x[2] * (y[0] * z[1] - y[1] * z[0]);
}

/// 1 or −1 if a bond from p to q passes through a triangle, by the side that it comes from; else 0.
static int piercing(const double a[3], const double b[3], const double c[3], const double p[3],
                    const double q[3]) {
    const bool before = volume(a, b, c, p) > 0, after = volume(a, b, c, q) > 0;
    if (before == after)
        return 0;
    const bool side = volume(p, q, a, b) > 0;
    if ((volume(p, q, b, c) > 0) != side || (volume(p, q, c, a) > 0) != side)
        return 0;
    return before ? 1 : -1;
}

/// The linking number, with the second ring moved by `shift`: how often its bonds pass through the
/// triangles from the centre of the first to its bonds.
static int linking(const struct ring *one, const struct ring *other, const double shift[3]) {
    int sum = 0;
    for (int n = 0; n < other->corners; n++) {
        double p[3], q[3];
        for (int d = 0; d < 3; d++) {
            p[d] = other->corner[n][d] + shift[d];
            q[d] = other->corner[(n + 1) % other->corners][d] + shift[d];
        }
        for (int k = 0; k < one->corners; k++)
            sum += piercing(one->centre, one->corner[k], one->corner[(k + 1) % one->corners], p, q);
    }
    return sum;
}

/// Whether two rings are linked, by any of the images near each other.
/// @param[out] shift  of the second ring to that image
static bool are_linked(const struct ring *one, const struct ring *other, const struct box *box,
                       double shift[3]) {
    const double reach = one->radius + other->radius;
    const int images = 2 * reach > mf_box_shortest(box) ? 27 : 1; // the nearest first
    for (int image = 0; image < images; image++) {
        const int step[3] = {(image + 1) % 3 - 1, (image / 3 + 1) % 3 - 1, (image / 9 + 1) % 3 - 1};
        double square = 0;
        for (int d = 0; d < 3; d++) {
            const double apart = other->centre[d] - one->centre[d];
            shift[d] = box_nearest(apart, box->length[d]) - apart + step[d] * box->length[d];
            square += pow(apart + shift[d], 2);
        }
        if (square < reach * reach && linking(one, other, shift) != 0)
            return true;
    }
    return false;
}

static int ring_system_of(const struct rings *rings, const struct ring *ring) {
    const struct ring_kind *own = &rings->kind[ring->kind];
    return own->ring_system[own->bead[own->start[ring->number]]];
}

static bool same_ring_system(const struct rings *rings, const struct ring *one,
                             const struct ring *other) {
    return one->kind == other->kind && one->molecule == other->molecule &&
           ring_system_of(rings, one) == ring_system_of(rings, other);
}

static int compare_places(const void *one, const void *other) {
    const struct ring_place *a = one, *b = other;
    if (a->along != b->along)
        return a->along < b->along ? -1 : 1;
    return a->ring < b->ring ? -1 : a->ring > b->ring;
}

/// Sort the rings along the first axis of the box.
/// @return the largest radius
static double sort_rings(struct rings *rings, double length) {
    double largest = 0;
    for (size_t r = 0; r < rings->count; r++) {
        const double x = rings->ring[r].centre[0];
        rings->order[r] = (struct ring_place){x - length * floor(x / length), r};
        largest = fmax(largest, rings->ring[r].radius);
    }
    qsort(rings->order, rings->count, sizeof *rings->order, compare_places);
    return largest;
}

/// Choose one of two rings, if they are linked and none of them is chosen.
static void choose_one(struct rings *rings, size_t a, size_t b, const struct box *box,
                       bool second) {
    struct ring *one = &rings->ring[a < b ? a : b], *other = &rings->ring[a < b ? b : a];
    double shift[3], centre[3];
    if (one->chosen || other->chosen || same_ring_system(rings, one, other) ||
        !are_linked(one, other, box, shift))
        return;
    for (int d = 0; d < 3; d++)
        centre[d] = second ? one->centre[d] - shift[d] : other->centre[d] + shift[d];
    choose(second ? other : one, centre);
}

size_t mf_rings_choose_linked(struct rings *rings, const struct particles *particles, bool second) {
    const double length = particles->box.length[0];
    size_t count = 0;
    look_at_all(rings, particles);
    const double reach = 2 * sort_rings(rings, length);
    for (size_t n = 0; n < rings->count; n++)
        for (size_t ahead = 1; ahead < rings->count; ahead++) {
            const size_t next = (n + ahead) % rings->count;
            const double apart = rings->order[next].along - rings->order[n].along;
            if ((next < n ? apart + length : apart) > reach)
                break;
            choose_one(rings, rings->order[n].ring, rings->order[next].ring, &particles->box,
                       second);
        }
    for (size_t r = 0; r < rings->count; r++)
        count += rings->ring[r].chosen;
    return count;
}

// Shrinking ---------------------------------------------------------------------------------------

static void shrink_ring_system(const struct rings *rings, const struct ring *chosen,
                               struct particles *particles, double scale) {
    const struct ring_kind *own = &rings->kind[chosen->kind];
    const struct topology_kind *kind = &rings->whole.topology->kind[chosen->kind];
    const struct ring *first = chosen - chosen->number;
    for (const struct ring *ring = first; ring < first + own->rings; ring++)
        for (int k = 0; k < ring->corners && same_ring_system(rings, ring, chosen); k++) {
            const int bead = own->bead[own->start[ring->number] + k];
            const uint32_t place = particles->place[topology_id(kind, ring->molecule, bead)];
            for (int d = 0; d < 3; d++)
                particles->position[d][place] =
                    chosen->anchor[d] + scale * (ring->corner[k][d] - chosen->anchor[d]);
        }
}

void mf_rings_shrink_chosen(const struct rings *rings, struct particles *particles, double scale) {
    for (size_t r = 0; r < rings->count; r++) {
        bool before = !rings->ring[r].chosen; // or with another ring of its clump
        for (size_t other = r - (size_t)rings->ring[r].number; other < r && !before; other++)
            before = rings->ring[other].chosen &&
                     same_ring_system(rings, &rings->ring[other], &rings->ring[r]);
        if (!before)
            shrink_ring_system(rings, &rings->ring[r], particles, scale);
    }
}
