// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_unknowns.h"

#include "base/memory.h"
#include "base/names.h"
#include "base/nearest.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A key of the scene.
struct entry {
    char path[INVERSE_NUMBER_NAME_SIZE];
    const struct field *field;
    const char *fixed; ///< why it cannot be an unknown; NULL: it can
    enum inverse_place place;
    int part;
    size_t offset;
    double value; ///< that the scene gives
};

/// Keys of a scene, all of them; counted only while `entry` is NULL.
struct entries {
    struct entry *entry;
    size_t count;
};

/// Why a field is no number.
static const char *not_a_number(const struct field *field) {
    switch (field->type) {
    case FIELD_NUMBER:
        return NULL;
    case FIELD_INTEGER:
    case FIELD_SEED:
        return "it is an integer; only real numbers can be found";
    case FIELD_LENGTHS:
        return "it is several numbers";
    case FIELD_TEXT:
    case FIELD_FILE:
        return "it is a text, not a number";
    default: // of choices
        return "it is a choice, not a number";
    }
}

/// Add the fields of a table, whose numbers are counted from `base` and at `offset` in their place.
static void add(struct entries *entries, const char *prefix, const struct field *fields,
                const char *fixed, const struct entry *where, const void *base) {
    for (const struct field *field = fields; field->name; field++) {
        struct entry *entry = entries->entry ? &entries->entry[entries->count] : NULL;
        entries->count++;
        if (entry == NULL)
            continue;
        *entry = *where;
        snprintf(entry->path, sizeof entry->path, "%s%s", prefix, field->name);
        entry->field = field;
        entry->fixed = not_a_number(field);
        if (entry->fixed == NULL)
            entry->fixed = fixed;
        entry->offset = where->offset + field->offset;
        if (entry->fixed == NULL)
            memcpy(&entry->value, (const char *)base + field->offset, sizeof entry->value);
    }
}

/// What stands at the top of a scene: of its numbers the temperature, and the time step of dynamics
/// that have it as a property.
static void add_top(struct entries *entries, const struct scene *scene) {
    static const struct {
        const char *name, *fixed;
    } fixed[] = {{"time_step", "targets are measured in whole time steps"},
                 {"skin", "it changes the speed, not the results"},
                 {"temperature_limit", "it only defines when a simulation has failed"}};
    static const size_t count = sizeof fixed / sizeof *fixed;
    const struct simulation_setup *setup = &scene->setup;
    for (const struct field *field = mf_scene_fields; field->name; field++) {
        struct field one[] = {*field, FIELD_END};
        const bool is_step = strcmp(field->name, "time_step") == 0;
        const bool is_free = strcmp(field->name, "temperature") == 0 ||
                             (is_step && setup->integrator && setup->integrator->model_time_step);
        const struct entry where = {.place = INVERSE_OF_SETUP,
                                    .offset = is_step
                                                  ? offsetof(struct simulation_setup, time_step)
                                                  : offsetof(struct simulation_setup, temperature)};
        const char *why = is_free ? NULL : "it is not a property of the fluid";
        for (size_t k = 0; k < count && !is_free; k++)
            why = strcmp(fixed[k].name, field->name) == 0 ? fixed[k].fixed : why;
        one[0].offset = 0;
        add(entries, "", one, why, &where, is_step ? &setup->time_step : &setup->temperature);
        if (entries->entry)
            entries->entry[entries->count - 1].field = field;
    }
}

static void add_law(struct entries *entries, const char *key, const struct scene_law *law,
                    enum inverse_place place, const struct composition *composition) {
    for (int pair = 0; pair < law->curves; pair++) {
        const struct curve *curve = &law->curve[pair];
        char name[COMPOSITION_PAIR_NAME_SIZE] = "", prefix[INVERSE_NUMBER_NAME_SIZE];
        if (law->curves > 1)
            mf_composition_pair_name(composition, pair, name);
        snprintf(prefix, sizeof prefix, "%s.%s%s", key, name, name[0] ? "." : "");
        if (curve->family)
            add(entries, prefix, curve->family->fields, NULL,
                &(struct entry){.place = place, .part = pair}, curve->parameters);
    }
}

static void add_memory(struct entries *entries, const struct scene_memory *memory,
                       const struct composition *composition) {
    char key[INVERSE_NUMBER_NAME_SIZE];
    add_law(entries, "dissipative_transverse", &memory->transverse, INVERSE_OF_TRANSVERSE,
            composition);
    for (int m = 0; m < memory->modes; m++) {
        struct field times[] = {mf_scene_memory_fields[0], mf_scene_memory_fields[1], FIELD_END};
        const struct pair_memory_mode mode = {.time = memory->mode[m].time,
                                              .frequency = memory->mode[m].frequency};
        times[0].offset = offsetof(struct pair_memory_mode, time);
        times[1].offset = offsetof(struct pair_memory_mode, frequency);
        snprintf(key, sizeof key, "memory.%s.", memory->name[m]);
        add(entries, key, times, NULL,
            &(struct entry){.place = INVERSE_OF_SETUP,
                            .offset = offsetof(struct simulation_setup, memory.mode) +
                                      (size_t)m * sizeof mode},
            &mode);
        if (entries->entry)
            for (size_t k = 0; k < 2; k++)
                entries->entry[entries->count - 2 + k].field = &mf_scene_memory_fields[k];
        snprintf(key, sizeof key, "memory.%s.omega", memory->name[m]);
        add_law(entries, key, &memory->omega[m], INVERSE_OF_MEMORY + m, composition);
    }
}

/// Where the potential of pairs is unknown, a share of it is no unknown of its own: the slope of f
/// at the origin stays what the scene says.
static void fix_linear_term_of_embedding(struct entries *entries, const struct scene *scene) {
    static const char name[] = ".energy.c1";
    for (size_t k = 0; entries->entry && k < entries->count; k++) {
        struct entry *entry = &entries->entry[k];
        const size_t length = strlen(entry->path);
        if ((scene->unknown & SCENE_FITS_POTENTIAL) && length > strlen(name) &&
            entry->place == INVERSE_OF_DENSITY_ENERGY &&
            strcmp(entry->path + length - strlen(name), name) == 0)
            entry->fixed = "it is a potential of pairs, 2 c1 w(r), and so a part of the unknown "
                           "potential; what the scene says stays";
    }
}

/// Laws of local densities: "many_body.cohesion.energy.c2".
static void add_densities(struct entries *entries, const struct scene *scene) {
    const struct scene_many_body *many_body = &scene->many_body;
    for (int t = 0; many_body->law && t < many_body->law->terms; t++) {
        const struct {
            const char *key;
            const struct curve *curve;
            enum inverse_place place;
        } laws[] = {{"weight", &many_body->weight[t], INVERSE_OF_WEIGHT},
                    {"energy", &many_body->energy[t], INVERSE_OF_DENSITY_ENERGY}};
        for (size_t k = 0; k < sizeof laws / sizeof *laws; k++) {
            if (scene_many_body_is_fitted(many_body, t))
                continue;
            char prefix[INVERSE_NUMBER_NAME_SIZE];
            snprintf(prefix, sizeof prefix, "many_body.%s.%s.", many_body->law->term[t].name,
                     laws[k].key);
            add(entries, prefix, laws[k].curve->family->fields, NULL,
                &(struct entry){.place = laws[k].place, .part = t}, laws[k].curve->parameters);
        }
    }
    fix_linear_term_of_embedding(entries, scene);
}

/// Laws of bonds, angles and dihedrals: "bonds.backbone.k".
static void add_groups(struct entries *entries, const struct molecules *molecules) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct molecules_group *group = &molecules->group[order][g];
            char prefix[INVERSE_NUMBER_NAME_SIZE];
            snprintf(prefix, sizeof prefix, "%s.%s.", mf_bonded_kinds[order]->plural, group->name);
            add(entries, prefix, group->curve.law->fields, NULL,
                &(struct entry){.place = INVERSE_OF_BONDED, .part = inverse_group(order, g)},
                group->curve.parameters);
        }
}

/// A law of pairs by its place.
static const struct scene_law *law_of(const struct scene *scene, enum inverse_place place) {
    switch (place) {
    case INVERSE_OF_POTENTIAL:
        return &scene->potential;
    case INVERSE_OF_OMEGA:
        return &scene->omega;
    case INVERSE_OF_TRANSVERSE:
        return &scene->memory.transverse;
    default:
        return &scene->memory.omega[place - INVERSE_OF_MEMORY];
    }
}

void mf_fit_numbers_lend(const struct scene *scene, struct inverse_problem *problem) {
    const struct scene_many_body *many_body = &scene->many_body;
    const int densities = many_body->law ? many_body->law->terms : 0;
    for (int place = 0; place < UNKNOWN_BONDED; place++) {
        const struct scene_law *law = law_of(scene, place);
        problem->law[place] = (struct inverse_law){law->curves, law->curve};
    }
    problem->weight = (struct inverse_law){densities, many_body->weight};
    problem->density_energy = (struct inverse_law){densities, many_body->energy};
    problem->known = (struct inverse_law){scene->known.curves, scene->known.curve};
}

static void add_all(struct entries *entries, const struct scene *scene) {
    static const char converts[] = "it converts results, and changes none";
    static const char places[] = "it sets the number of particles or where they start";
    const struct simulation_setup *setup = &scene->setup;
    const struct entry nowhere = {.place = INVERSE_OF_SETUP};
    const struct entry dynamics = {.place = INVERSE_OF_DYNAMICS};
    entries->count = 0;
    add_top(entries, scene);
    add_law(entries, "conservative", &scene->potential, INVERSE_OF_POTENTIAL, &setup->composition);
    add_law(entries, "dissipative", &scene->omega, INVERSE_OF_OMEGA, &setup->composition);
    add_memory(entries, &scene->memory, &setup->composition);
    if (setup->integrator)
        add(entries, "dynamics.", setup->integrator->fields, NULL, &dynamics,
            setup->integrator_parameters);
    add_groups(entries, &scene->molecules.molecules);
    add_densities(entries, scene);
    for (int k = 0; k < setup->interactions; k++) {
        const struct interaction_choice *choice = &setup->interaction[k];
        if (choice->kind->fields == NULL) // their numbers are those of their laws
            continue;
        char prefix[INVERSE_NUMBER_NAME_SIZE];
        snprintf(prefix, sizeof prefix, "interactions.%s.", choice->kind->name);
        add(entries, prefix, choice->kind->fields, NULL,
            &(struct entry){.place = INVERSE_OF_INTERACTION, .part = k}, choice->parameters);
    }
    add(entries, "particles.", mf_placement_count_fields, places, &nowhere, NULL);
    add(entries, "particles.", mf_placement_fields, places, &nowhere, NULL);
    add(entries, "particles.", mf_attributes_fields, "it is not the same for all particles",
        &nowhere, NULL);
    add(entries, "units.", mf_units_fields, converts, &nowhere, NULL);
}

static enum status list(struct entries *entries, const struct scene *scene) {
    add_all(entries, scene);
    TRY_ARRAY(entries->entry, entries->count);
    add_all(entries, scene);
    return STATUS_OK;
}

/// The group of a path that is an unknown curve, or NULL.
static const char *sought_group(const struct scene *scene, const char *path) {
    const struct molecules *molecules = &scene->molecules.molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct molecules_group *group = &molecules->group[order][g];
            char prefix[INVERSE_NUMBER_NAME_SIZE];
            snprintf(prefix, sizeof prefix, "%s.%s.", mf_bonded_kinds[order]->plural, group->name);
            if (mf_scene_groups_are_fitted(group) && strncmp(path, prefix, strlen(prefix)) == 0)
                return group->name;
        }
    return NULL;
}

/// No key of the scene: the nearest that could be found, or why there is none.
static enum status fault_unknown(struct json_object *numbers, const char *path,
                                 const struct entries *entries, const struct scene *scene) {
    OWNED const char **known = NULL;
    size_t count = 0;
    char hint[1024];
    const bool in_potential =
        (scene->unknown & SCENE_FITS_POTENTIAL) && strncmp(path, "conservative.", 13) == 0;
    const bool in_omega =
        (scene->unknown & SCENE_FITS_OMEGA) && strncmp(path, "dissipative.", 12) == 0;
    if (in_potential || in_omega) {
        mf_json_fault(numbers, path, "%s is an unknown curve itself; set its form by \"curve\"",
                      mf_inverse_unknown_names[in_potential ? UNKNOWN_POTENTIAL : UNKNOWN_OMEGA]);
        return STATUS_OK;
    }
    if (sought_group(scene, path)) {
        mf_json_fault(
            numbers, path,
            "\"%s\" is an unknown curve itself; with a law of it in the scene its numbers "
            "can be found",
            sought_group(scene, path));
        return STATUS_OK;
    }
    TRY_ARRAY(known, entries->count);
    for (size_t k = 0; k < entries->count; k++)
        if (entries->entry[k].fixed == NULL)
            known[count++] = entries->entry[k].path;
    mf_nearest_hint(path, known, count, hint, sizeof hint);
    mf_json_fault(numbers, path, "the scene has no such number; %s", hint);
    return STATUS_OK;
}

/// The range lies within that of the field, and the start within the range.
static void check_range(struct json_object *object, const struct field *field,
                        const struct inverse_number *number) {
    const double end[] = {number->minimum, number->maximum};
    static const char *const key[] = {"minimum", "maximum"};
    char allowed[64 + UNITS_NAME_SIZE];
    const double factor = mf_json_factor(object, field->unit);
    mf_json_range_text(object, field, allowed, sizeof allowed);
    for (int k = 0; k < 2; k++)
        if (end[k] < field->minimum || end[k] > field->maximum)
            mf_json_fault(object, key[k], "%g is not in the range of \"%s\", %s", factor * end[k],
                          number->name, allowed);
    if (number->minimum >= number->maximum)
        mf_json_fault(object, "maximum", "%g is not above the minimum %g", factor * number->maximum,
                      factor * number->minimum);
    else if (!isfinite(number->maximum - number->minimum))
        mf_json_fault(object, "maximum", "%g is too far from the minimum %g",
                      factor * number->maximum, factor * number->minimum);
    else if (number->start < number->minimum || number->start > number->maximum)
        mf_json_fault(object, "start", "%g is not between the minimum %g and the maximum %g",
                      factor * number->start, factor * number->minimum, factor * number->maximum);
}

static void read_one(struct json_object *numbers, const char *path, const struct entry *entry,
                     struct inverse_number *number) {
    const size_t faults = mf_json_fault_count(numbers->document);
    struct json_object object = mf_json_child(numbers, path, false);
    struct field fields[NUMBERS_FIELDS];
    mf_numbers_fields_of(entry->field->unit, fields);
    mf_json_fields(&object, fields, number);
    mf_json_finish(&object);
    snprintf(number->name, sizeof number->name, "%s", entry->path);
    number->unit = entry->field->unit;
    number->place = entry->place;
    number->part = entry->part;
    number->offset = entry->offset;
    if (mf_json_fault_count(numbers->document) == faults)
        check_range(&object, entry->field, number);
}

/// That of a path, or NULL.
static const struct entry *find(const struct entries *entries, const char *path) {
    const struct entry *found = NULL;
    for (const struct entry *one = entries->entry; one < entries->entry + entries->count; one++)
        if (strcmp(one->path, path) == 0 || (!found && mf_names_are_one_path(one->path, path)))
            found = one;
    return found;
}

static enum status read_all(struct json_object *numbers, const struct scene *scene,
                            const struct entries *entries, struct inverse_number *number,
                            size_t *count) {
    const char *path;
    for (size_t n = 0; (path = mf_json_key(numbers, n)); n++) {
        const struct entry *const found = find(entries, path);
        if (found == NULL)
            TRY(fault_unknown(numbers, path, entries, scene));
        else if (strcmp(found->path, path) != 0 && mf_json_has(numbers, found->path))
            mf_json_fault(numbers, path, "it stands there as \"%s\", too", found->path);
        else if (found->fixed)
            mf_json_fault(numbers, path, "it cannot be found: %s", found->fixed);
        else if (*count < INVERSE_MAX_NUMBERS)
            read_one(numbers, path, found, &number[(*count)++]);
        else
            mf_json_fault(numbers, path, "there are more than %d numbers", INVERSE_MAX_NUMBERS);
        mf_json_has(numbers, path);
    }
    return STATUS_OK;
}

/// The parameters that are sought go together at all ends of their ranges, so that each candidate
/// is a curve. Tells of the first corner where they do not.
static enum status check_corners(struct json_object *numbers, const struct curve *curve,
                                 const struct inverse_number *const *number, size_t count) {
    void *parameters = mf_memory_zeroed(1, curve->family->size);
    if (parameters == NULL)
        return STATUS_NO_MEMORY;
    memcpy(parameters, curve->parameters, curve->family->size);
    const struct curve other = {curve->family, parameters};
    enum status status = STATUS_OK;
    for (size_t corner = 0; corner < (size_t)1 << count && status == STATUS_OK; corner++) {
        for (size_t n = 0; n < count; n++)
            memcpy((char *)parameters + number[n]->offset,
                   corner >> n & 1 ? &number[n]->maximum : &number[n]->minimum, sizeof(double));
        status = mf_curve_check(&other);
    }
    if (status != STATUS_OK)
        mf_json_fault(numbers, number[0]->name, "at ends of the ranges %s", mf_status_marked());
    mf_memory_free(parameters);
    return STATUS_OK;
}

static enum status check_law(struct json_object *numbers, const struct inverse_law *law,
                             enum inverse_place place, const struct inverse_number *number,
                             size_t count) {
    for (int pair = 0; pair < law->curves; pair++) {
        const struct inverse_number *own[INVERSE_MAX_NUMBERS];
        size_t found = 0;
        for (size_t n = 0; n < count; n++)
            if (number[n].place == place && number[n].part == pair)
                own[found++] = &number[n];
        if (found > 0)
            TRY(check_corners(numbers, &law->curve[pair], own, found));
    }
    return STATUS_OK;
}

static enum status check_laws(struct json_object *numbers, const struct scene *scene,
                              const struct inverse_number *number, size_t count) {
    struct inverse_problem laws = {0};
    mf_fit_numbers_lend(scene, &laws);
    for (int place = 0; place < UNKNOWN_BONDED; place++)
        TRY(check_law(numbers, &laws.law[place], place, number, count));
    TRY(check_law(numbers, &laws.weight, INVERSE_OF_WEIGHT, number, count));
    return check_law(numbers, &laws.density_energy, INVERSE_OF_DENSITY_ENERGY, number, count);
}

enum status mf_fit_numbers_read(struct json_object *unknowns, const struct scene *scene,
                                struct inverse_number number[INVERSE_MAX_NUMBERS], size_t *count) {
    enum status status = STATUS_OK;
    struct entries entries = {0};
    *count = 0;
    // A scene with faults would be told to lack what it only says wrongly.
    const bool faulty = mf_json_fault_count(unknowns->document) > 0;
    struct json_object numbers = mf_json_child(unknowns, "numbers", false);
    if (numbers.item == NULL || faulty)
        return STATUS_OK;
    CHECK(list(&entries, scene));
    CHECK(read_all(&numbers, scene, &entries, number, count));
    if (*count == 0 && mf_json_fault_count(unknowns->document) == 0)
        mf_json_fault(unknowns, "numbers", "names none");
    if (mf_json_fault_count(unknowns->document) == 0)
        CHECK(check_laws(&numbers, scene, number, *count));
    mf_json_finish(&numbers);
done:
    mf_memory_free(entries.entry);
    return status;
}

enum status mf_fit_numbers_complete(const struct scene *scene, struct inverse_number *number,
                                    size_t count) {
    struct entries entries = {0};
    const enum status status = list(&entries, scene);
    for (size_t n = 0; n < count && status == STATUS_OK; n++) {
        double *const start = &number[n].start;
        if (isnan(*start))
            *start = find(&entries, number[n].name)->value;
        if (!(*start >= number[n].minimum && *start <= number[n].maximum))
            *start = 0.5 * (number[n].minimum + number[n].maximum);
    }
    mf_memory_free(entries.entry);
    return status;
}
