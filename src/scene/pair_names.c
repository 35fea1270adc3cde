// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/pair_names.h"

#include <string.h>

static void fault_unknown(struct json_object *object, const struct composition *composition,
                          const char *key) {
    char names[COMPOSITION_MAX_PAIRS * (COMPOSITION_PAIR_NAME_SIZE + 2)] = "";
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, pair, name);
        strcat(names, pair ? ", " : "");
        strcat(names, name);
    }
    mf_json_fault(object, key, "unknown pair; expected %s", names);
}

bool mf_pair_names_find(struct json_object *object, const struct composition *composition,
                        const char *key[COMPOSITION_MAX_PAIRS]) {
    const char *member;
    bool all = true;
    for (int pair = 0; pair < COMPOSITION_MAX_PAIRS; pair++)
        key[pair] = NULL;
    for (size_t n = 0; (member = mf_json_key(object, n)); n++) {
        const int pair = mf_composition_find_pair(composition, member);
        if (pair >= 0 && key[pair] == NULL) {
            key[pair] = member;
            continue;
        }
        if (pair >= 0)
            mf_json_fault(object, member, "duplicate pair, in both orders");
        else if (mf_json_is_object(object, member))
            fault_unknown(object, composition, member);
        else
            continue;
        mf_json_has(object, member); // it has had its line
        all = false;
    }
    return all;
}

bool mf_pair_names_refuse(struct json_object *object, const struct composition *composition,
                          const char *instead) {
    const char *key;
    for (size_t n = 0; (key = mf_json_key(object, n)); n++) {
        if (!mf_json_is_object(object, key))
            continue;
        mf_json_fault(object, key, "pairs are named in mixtures, and there is only %s; write %s",
                      composition->name[0][0] ? composition->name[0] : "one type", instead);
        return true;
    }
    return false;
}
