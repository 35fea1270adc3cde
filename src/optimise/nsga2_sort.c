// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/nsga2.h"

#include <stdlib.h>

bool mf_nsga2_dominates(const double *a, const double *b, size_t objectives) {
    bool better = false;
    for (size_t m = 0; m < objectives; m++) {
        if (a[m] > b[m])
            return false;
        better = better || a[m] < b[m];
    }
    return better;
}

enum status mf_nsga2_sort(const double *value, size_t count, size_t objectives, uint32_t *rank) {
    enum status status = STATUS_OK;
    size_t *above = NULL; // those on no front yet that dominate each
    size_t left = count;
    NEW_ARRAY(above, count);
    for (size_t a = 0; a < count; a++) {
        rank[a] = 0;
        for (size_t b = 0; b < count; b++)
            above[a] +=
                mf_nsga2_dominates(value + b * objectives, value + a * objectives, objectives);
    }
    for (uint32_t front = 1; left > 0; front++) {
        for (size_t a = 0; a < count; a++)
            if (rank[a] == 0 && above[a] == 0) {
                rank[a] = front;
                left--;
            }
        for (size_t a = 0; a < count; a++)
            for (size_t b = 0; rank[a] == front && b < count; b++)
                above[b] -=
                    mf_nsga2_dominates(value + a * objectives, value + b * objectives, objectives);
    }
done:
    mf_memory_free(above);
    return status;
}

struct place {
    double value;
    size_t index;
};

static int compare_places(const void *a, const void *b) {
    const struct place *x = a, *y = b;
    if (x->value != y->value)
        return x->value < y->value ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

/// Add the room along one objective to the members of a front, which get sorted by it.
static void crowd_along(struct place *place, size_t count, double *crowding) {
    qsort(place, count, sizeof *place, compare_places);
    const double range = place[count - 1].value - place[0].value;
    crowding[place[0].index] = crowding[place[count - 1].index] = HUGE_VAL;
    for (size_t k = 1; k + 1 < count && range > 0; k++)
        crowding[place[k].index] += (place[k + 1].value - place[k - 1].value) / range;
}

enum status mf_nsga2_crowd(const double *value, size_t count, size_t objectives,
                           const uint32_t *rank, double *crowding) {
    OWNED struct place *place = NULL;
    size_t done_with = 0;
    TRY_ARRAY(place, count);
    for (uint32_t front = 1; done_with < count; front++) {
        size_t members = 0;
        for (size_t m = 0; m < objectives; m++) {
            members = 0;
            for (size_t k = 0; k < count; k++)
                if (rank[k] == front) {
                    if (m == 0)
                        crowding[k] = 0;
                    place[members++] = (struct place){value[k * objectives + m], k};
                }
            if (members > 0)
                crowd_along(place, members, crowding);
        }
        done_with += members;
    }
    return STATUS_OK;
}
