// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units_beads.h"

#include "io/json_list.h"

/// Beads that were found so far.
struct found {
    struct json_object mass; ///< of the types
    double count, sum;       ///< sum of the masses
};

struct json_object mf_units_peek(const struct json_object *parent, const char *key) {
    struct json_object looked = *parent;
    return mf_json_is_object(parent, key) ? mf_json_child(&looked, key, false)
                                          : (struct json_object){.document = parent->document};
}

/// A number, or the middle of the range in which it is looked for; 0 if there is none.
static double find_mass(const struct json_object *parent, const char *key) {
    const struct json_object range = mf_units_peek(parent, key);
    double mass, minimum, maximum;
    if (mf_json_numbers(parent, key, &mass, 1) == 1)
        return mass;
    if (mf_json_numbers(&range, "minimum", &minimum, 1) == 1 &&
        mf_json_numbers(&range, "maximum", &maximum, 1) == 1)
        return 0.5 * (minimum + maximum);
    return 0;
}

static void add(struct found *found, const char *type, double count) {
    found->count += count;
    found->sum += count * find_mass(&found->mass, type);
}

/// "beads" of a molecule or a chain: the type of each.
static void add_beads(struct found *found, const struct json_object *object, double molecules) {
    const int beads = mf_json_count(object, "beads");
    for (int k = 0; k < beads; k++) {
        const char *const type = mf_json_list_text(object, "beads", (size_t)k);
        if (type)
            add(found, type, molecules);
    }
}

static void add_molecules(struct found *found, const struct json_object *molecules) {
    const char *kind;
    for (size_t n = 0; (kind = mf_json_key(molecules, n)); n++) {
        const struct json_object molecule = mf_units_peek(molecules, kind);
        const struct json_object chain = mf_units_peek(&molecule, "chain");
        const char *const type = mf_json_list_text(&chain, "type", 0);
        double count, length;
        if (mf_json_numbers(&molecule, "count", &count, 1) != 1)
            continue;
        add_beads(found, &molecule, count);
        add_beads(found, &chain, count);
        if (type && mf_json_numbers(&chain, "length", &length, 1) == 1)
            add(found, type, count * length);
    }
}

double mf_units_beads(const struct json_object *scene, double *mean_mass) {
    const struct json_object particles = mf_units_peek(scene, "particles");
    const struct json_object types = mf_units_peek(&particles, "types");
    const struct json_object molecules = mf_units_peek(scene, "molecules");
    struct found found = {.mass = mf_units_peek(&particles, "mass")};
    const char *type;
    double number;
    for (size_t n = 0; (type = mf_json_key(&types, n)); n++)
        if (mf_json_numbers(&types, type, &number, 1) == 1)
            add(&found, type, number);
    mf_json_numbers(&particles, "count", &found.count, 1);
    add_molecules(&found, &molecules);
    *mean_mass = find_mass(&particles, "mass");
    if (*mean_mass == 0 && found.count > 0)
        *mean_mass = found.sum / found.count;
    return found.count;
}
