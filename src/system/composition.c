// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/composition.h"

#include "base/names.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct composition mf_composition_of_one(int64_t count) {
    return (struct composition){.types = 1, .count = {count}};
}

int64_t mf_composition_particles(const struct composition *composition) {
    int64_t sum = 0;
    for (int type = 0; type < composition->types; type++)
        sum += composition->count[type];
    return sum;
}

struct composition mf_composition_scaled(const struct composition *composition, int64_t particles) {
    const double share = (double)particles / (double)mf_composition_particles(composition);
    struct composition scaled = *composition;
    for (int type = 0; type < scaled.types; type++) {
        const double count = (double)composition->count[type];
        scaled.count[type] =
            count < 2 ? composition->count[type] : (int64_t)fmax(2, round(share * count));
    }
    return scaled;
}

int mf_composition_pairs(const struct composition *composition) {
    const int types = composition->types;
    return types > 1 ? types * (types + 1) / 2 : 1;
}

int mf_composition_pair(const struct composition *composition, int a, int b) {
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * (2 * composition->types - 1 - low) / 2 + high;
}

int mf_composition_type(const struct composition *composition, uint32_t id) {
    int type = 0;
    for (int64_t end = composition->count[0]; type + 1 < composition->types && id >= end;)
        end += composition->count[++type];
    return type;
}

int mf_composition_pair_of_ids(const struct composition *composition, uint32_t i, uint32_t j) {
    if (!composition_is_mixed(composition))
        return 0;
    return mf_composition_pair(composition, mf_composition_type(composition, i),
                               mf_composition_type(composition, j));
}

void mf_composition_pair_types(const struct composition *composition, int pair, int type[2]) {
    type[0] = type[1] = 0;
    for (int n = 0; n < pair; n++)
        if (++type[1] == composition->types)
            type[1] = ++type[0];
}

double mf_composition_possible_pairs(const struct composition *composition, int pair) {
    int type[2];
    mf_composition_pair_types(composition, pair, type);
    const double a = (double)composition->count[type[0]], b = (double)composition->count[type[1]];
    return type[0] == type[1] ? 0.5 * a * (a - 1) : a * b;
}

bool mf_composition_has_pairs(const struct composition *composition, int pair) {
    return composition->types == 0 || mf_composition_possible_pairs(composition, pair) > 0;
}

void mf_composition_pair_name(const struct composition *composition, int pair,
                              char text[COMPOSITION_PAIR_NAME_SIZE]) {
    int type[2];
    text[0] = '\0';
    if (!composition_is_mixed(composition))
        return;
    mf_composition_pair_types(composition, pair, type);
    snprintf(text, COMPOSITION_PAIR_NAME_SIZE, "%s-%s", composition->name[type[0]],
             composition->name[type[1]]);
}

int mf_composition_find_pair(const struct composition *composition, const char *name) {
    for (int a = 0; a < composition->types; a++)
        for (int b = 0; b < composition->types; b++) {
            char text[COMPOSITION_PAIR_NAME_SIZE];
            snprintf(text, sizeof text, "%s-%s", composition->name[a], composition->name[b]);
            if (strcmp(text, name) == 0)
                return mf_composition_pair(composition, a, b);
        }
    return -1;
}

bool mf_composition_is_name(const char *name) {
    return mf_names_is_plain(name, "_", COMPOSITION_NAME_SIZE) && !mf_names_is_reserved(name);
}
