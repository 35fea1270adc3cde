// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/variants.h"

#include "base/simd.h"
#include "shared/testing.h"

#include <stdio.h>

int variants_find(struct variant variants[VARIANTS_MAX]) {
    // The best first: one that the processor lacks is refused.
    static const char *const instruction_sets[] = {"avx512", "avx2", "portable"};
    static const struct {
        enum pair_precision precision;
        const char *name;
    } precisions[] = {{PAIR_MIXED, "mixed"}, {PAIR_DOUBLE, "double"}};
    int count = 0;
    for (int s = 0; s < 3; s++) {
        if (!mf_simd_select(instruction_sets[s]))
            continue;
        for (int p = 0; p < 2; p++) {
            struct variant *variant = &variants[count++];
            *variant = (struct variant){.instruction_set = instruction_sets[s],
                                        .precision = precisions[p].precision};
            snprintf(variant->name, sizeof variant->name, "%s, %s", instruction_sets[s],
                     precisions[p].name);
        }
    }
    variants_select(&variants[0]);
    return count;
}

void variants_select(const struct variant *variant) {
    assert_true(mf_simd_select(variant->instruction_set));
}
