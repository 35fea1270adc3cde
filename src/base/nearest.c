// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/nearest.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// Longest name compared; names of the product are far shorter.
enum { LONGEST_NAME = 63 };

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/// Optimal string alignment distance, of letters of either case: one edit inserts, deletes or
/// replaces a letter, or swaps two neighbours. The swap counts once because it is the commonest
/// slip in short names.
static size_t edit_distance(const char *a, size_t length_a, const char *b, size_t length_b) {
    size_t cost[LONGEST_NAME + 1][LONGEST_NAME + 1];
    for (size_t i = 0; i <= length_a; i++)
        cost[i][0] = i;
    for (size_t j = 0; j <= length_b; j++)
        cost[0][j] = j;
    for (size_t i = 1; i <= length_a; i++)
        for (size_t j = 1; j <= length_b; j++) {
            const size_t replace = cost[i - 1][j - 1] + (lower(a[i - 1]) != lower(b[j - 1]));
            cost[i][j] = smaller(replace, 1 + smaller(cost[i - 1][j], cost[i][j - 1]));
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1]))
                cost[i][j] = smaller(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    return cost[length_a][length_b];
}

/// Whether two names differ by the order of their letters alone.
static bool has_same_letters(const char *a, const char *b) {
    int count[256] = {0};
    for (; *a; a++)
        count[(unsigned char)*a]++;
    for (; *b; b++)
        count[(unsigned char)*b]--;
    for (size_t k = 0; k < 256; k++)
        if (count[k] != 0)
            return false;
    return true;
}

/// The one name that begins so, as "sim" of "simulate"; NULL if there are several.
static const char *find_beginning(const char *given, const char *const *known, size_t count) {
    const size_t length = strlen(given);
    const char *found = NULL;
    for (size_t k = 0; k < count; k++) {
        size_t same = 0;
        while (same < length && lower(given[same]) == lower(known[k][same]))
            same++;
        if (same < length || length < 2)
            continue;
        if (found)
            return NULL;
        found = known[k];
    }
    return found;
}

const char *mf_nearest_name(const char *given, const char *const *known, size_t count) {
    const char *nearest = NULL;
    size_t min = LONGEST_NAME + 1; // farther than any two names
    const size_t length = strlen(given);
    for (size_t k = 0; k < count; k++) {
        const size_t other = strlen(known[k]);
        const size_t longer = length > other ? length : other;
        if (longer > LONGEST_NAME || longer < 2)
            continue;
        const size_t distance = edit_distance(given, length, known[k], other);
        const size_t allowed = longer < 6 ? 1 : longer / 3;
        // Of two that are as near: "yz" is nearer to "zy" than "y" and "xy" are.
        const bool better =
            distance < min || (distance == min && !has_same_letters(given, nearest) &&
                               has_same_letters(given, known[k]));
        if (distance <= allowed && better) {
            min = distance;
            nearest = known[k];
        }
    }
    return nearest ? nearest : find_beginning(given, known, count);
}

void mf_nearest_hint(const char *given, const char *const *known, size_t count, char *text,
                     size_t size) {
    const char *nearest = mf_nearest_name(given, known, count);
    if (nearest) {
        snprintf(text, size, "did you mean \"%s\"?", nearest);
        return;
    }
    size_t used = (size_t)snprintf(text, size, count ? "known: " : "no name is known here");
    for (size_t k = 0; k < count && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", k ? ", " : "", known[k]);
}
