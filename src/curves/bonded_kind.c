// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_kind.h"

#define BONDED_RECORD(NAME, kind, ...) &mf_##kind,
const struct bonded_kind *const mf_bonded_kinds[BONDED_KINDS] = {BONDED_LIST(BONDED_RECORD)};

const struct bonded_kind *mf_bonded_kind_of_table(const struct bonded_law *law) {
    for (int order = 0; order < BONDED_KINDS; order++)
        if (mf_bonded_kinds[order]->table == law)
            return mf_bonded_kinds[order];
    return NULL;
}
