// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_many_body.h"

#include "base/digest.h"
#include "base/names.h"
#include "scene/scene_law.h"

#include <string.h>

#define MEMBER(name) .offset = offsetof(struct scene_many_body_types, name)
const struct field mf_scene_many_body_fields[] = {
    {"central", FIELD_TEXT, MEMBER(central), .unit = "",
     .help = "types of the beads with the energy, as \"A B\"; default: all"},
    {"neighbours", FIELD_TEXT, MEMBER(neighbours), .unit = "",
     .help = "types that count; default: all"},
    FIELD_END,
};

// Types -------------------------------------------------------------------------------------------

static int find_type(const struct composition *composition, const char *name, size_t length) {
    for (int t = 0; t < composition->types; t++)
        if (strlen(composition->name[t]) == length &&
            strncmp(composition->name[t], name, length) == 0)
            return t;
    return -1;
}

/// The set of the types that a text names; all of an empty one.
static uint32_t read_types(struct json_object *object, const char *key, const char *text,
                           const struct composition *composition) {
    const int types = composition->types > 1 ? composition->types : 1;
    uint32_t set = 0;
    if (text[0] == '\0')
        return (1U << types) - 1;
    while (*(text += strspn(text, " ,"))) {
        const size_t length = strcspn(text, " ,");
        const int type = find_type(composition, text, length);
        if (type < 0)
            mf_json_fault(object, key, "\"%.*s\" is no type of \"particles\"", (int)length, text);
        else
            set |= 1U << type;
        text += length;
    }
    return set;
}

/// Whether there is a bead of the one set that has a neighbour of the other.
static bool occurs(const struct many_body_term *term, const struct composition *composition) {
    for (int a = 0; a < composition->types; a++)
        for (int b = 0; b < composition->types; b++)
            if (term->central >> a & term->neighbours >> b & 1 &&
                mf_composition_has_pairs(composition, mf_composition_pair(composition, a, b)))
                return true;
    return composition->types < 2;
}

// Laws --------------------------------------------------------------------------------------------

/// Points of a table of f: densities are in `density` of the file's.
static enum status load_points(struct curve *curve, struct json_object *object,
                               const char *density) {
    OWNED double *x = NULL;
    OWNED double *f = NULL;
    size_t count = 0;
    const char *file = mf_density_energy_file(curve);
    const enum status status =
        mf_scene_read_columns(file, (const char *[]){density, "k_B T_0"}, -DBL_MAX,
                              mf_json_units(object), &x, &f, &count);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        mf_json_fault(object, "file", "%s", mf_status_marked());
    else if (mf_density_energy_set_points(curve, x, f, count) != STATUS_OK)
        mf_json_fault(object, "file", "%s: %s", file, mf_status_marked());
    return STATUS_OK;
}

/// f, with ρ in the unit that it has by the weight.
static enum status read_energy(struct curve *curve, struct density_energy *energy,
                               struct json_object *parent, int dimensions, const char *density) {
    const char **names;
    struct json_object object = mf_json_child_of(parent, "energy", true, "law");
    if (object.item == NULL)
        return STATUS_OK;
    TRY(mf_names_collect(mf_density_energy_laws, NULL, &names));
    const char *law = mf_json_choice(&object, "law", names, NULL);
    mf_memory_free(names);
    if (law == NULL)
        return STATUS_OK;
    const size_t faults = mf_json_fault_count(object.document);
    TRY(mf_curve_create(curve, mf_curve_find(mf_density_energy_laws, law)));
    mf_json_fields(&object, curve->family->fields, curve->parameters);
    mf_json_finish(&object);
    mf_curve_scale(curve, mf_json_factor(&object, density), mf_json_factor(&object, "k_B T_0"));
    mf_density_energy_set_dimensions(curve, dimensions);
    if (mf_json_fault_count(object.document) == faults && curve->family == &mf_density_energy_table)
        TRY(load_points(curve, &object, density));
    if (mf_json_fault_count(object.document) > faults)
        return STATUS_OK;
    const enum status status = mf_density_energy_init(energy, curve);
    if (status == STATUS_BAD_INPUT)
        mf_json_fault(&object, NULL, "%s", mf_status_marked());
    return status == STATUS_NO_MEMORY ? status : STATUS_OK;
}

static enum status read_weight(struct curve *curve, struct weight_table *weight,
                               struct json_object *parent, int dimensions) {
    if (!mf_json_is_object(parent, "weight")) {
        mf_json_child_of(parent, "weight", true, "law");
        return STATUS_OK;
    }
    TRY(mf_scene_read_curve(curve, parent, "weight", mf_weight_laws, mf_json_units(parent)));
    if (curve->family == NULL)
        return STATUS_OK;
    mf_weight_set_dimensions(curve, dimensions);
    const enum status status = mf_weight_tabulate(weight, curve);
    if (status == STATUS_BAD_INPUT)
        mf_json_fault(parent, "weight", "%s", mf_status_marked());
    return status == STATUS_NO_MEMORY ? status : STATUS_OK;
}

/// The unit of ρ.
static const char *density_unit(const struct curve *weight, int dimensions) {
    if (weight->family == NULL || !mf_weight_is_normalised(weight))
        return "";
    return dimensions == 2 ? "1/lambda^2" : "1/lambda^3";
}

bool mf_scene_many_body_remark(const struct scene_many_body *many_body, const void *state, int term,
                               const struct units *units, char line[SCENE_MANY_BODY_REMARK_SIZE]) {
    const struct many_body_term *of = &many_body->law->term[term];
    const struct density_energy *energy = &of->energy;
    double found[2];
    if (mf_density_energy_is_zero(energy)) {
        snprintf(line, SCENE_MANY_BODY_REMARK_SIZE,
                 "many_body.%s.energy: all its coefficients are 0, and so is the energy: give one, "
                 "or leave \"%s\" out",
                 of->name, of->name);
        return true;
    }
    if (!mf_many_body_was_beyond(many_body->law, state, term, found))
        return false;
    const char *const unit = density_unit(&many_body->weight[term], units->dimensions);
    const double factor = mf_units_factor(units, unit);
    const bool never = found[1] < energy->low || found[0] > energy->high;
    char name[UNITS_NAME_SIZE];
    snprintf(line, SCENE_MANY_BODY_REMARK_SIZE,
             "many_body.%s.energy: densities were %.4g to %.4g%s, %s the table from %.4g to %.4g: "
             "the energy was continued as a straight line there",
             of->name, factor * found[0], factor * found[1], mf_units_suffix(units, unit, name),
             never ? "never in" : "and so beyond", factor * energy->low, factor * energy->high);
    return true;
}

enum status mf_scene_many_body_give_energy(struct scene_many_body *many_body, int term,
                                           const char *file, const struct units *units) {
    const char *const unit[2] = {density_unit(&many_body->weight[term], units->dimensions),
                                 "k_B T_0"};
    OWNED double *rho = NULL, *f = NULL;
    size_t count = 0;
    struct curve *curve = &many_body->energy[term];
    TRY(mf_scene_read_columns(file, unit, -DBL_MAX, units, &rho, &f, &count));
    TRY(mf_curve_create(curve, &mf_density_energy_table));
    enum status status = mf_density_energy_set_points(curve, rho, f, count);
    if (status == STATUS_OK)
        status = mf_density_energy_init(&many_body->law->term[term].energy, curve);
    return status == STATUS_OK ? STATUS_OK : mf_status_prefix(status, "%s", file);
}

static enum status read_term(struct scene_many_body *many_body, struct json_object *object,
                             const char *name, const struct simulation_setup *setup, bool fitted) {
    struct many_body *law = many_body->law;
    const int t = law->terms, dimensions = setup->box.dimensions;
    if (t == MANY_BODY_MAX_TERMS || !mf_names_is_plain(name, "_-", MANY_BODY_NAME_SIZE) ||
        mf_names_is_reserved(name)) {
        mf_json_fault(object, name, "expected at most %d densities with names of " NAMES_OF_OTHERS,
                      MANY_BODY_MAX_TERMS, MANY_BODY_NAME_SIZE - 1);
        return STATUS_OK;
    }
    struct json_object own = mf_json_child(object, name, true);
    if (own.item == NULL)
        return STATUS_OK;
    struct many_body_term *term = &law->term[law->terms++];
    struct scene_many_body_types *types = &many_body->types[t];
    strcpy(term->name, name);
    const size_t faults = mf_json_fault_count(own.document);
    mf_json_fields(&own, mf_scene_many_body_fields, types);
    term->central = read_types(&own, "central", types->central, &setup->composition);
    term->neighbours = read_types(&own, "neighbours", types->neighbours, &setup->composition);
    if (mf_json_fault_count(own.document) == faults && !occurs(term, &setup->composition))
        mf_json_fault(object, name,
                      "no density occurs: no bead of its central types has another one of its "
                      "neighbours' types");
    TRY(read_weight(&many_body->weight[t], &term->weight, &own, dimensions));
    if (!fitted || mf_json_is_member(&own, "energy"))
        TRY(read_energy(&many_body->energy[t], &term->energy, &own, dimensions,
                        density_unit(&many_body->weight[t], dimensions)));
    mf_json_finish(&own);
    if (mf_json_fault_count(own.document) == faults && !scene_many_body_is_fitted(many_body, t) &&
        mf_density_energy_check_weight(&many_body->energy[t], &many_body->weight[t]) != STATUS_OK)
        mf_json_fault(&own, "energy", "%s", mf_status_marked());
    return STATUS_OK;
}

enum status mf_scene_many_body_read(struct scene_many_body *many_body, struct json_object *scene,
                                    struct simulation_setup *setup, bool fitted) {
    const char *name;
    struct json_object object = mf_json_child(scene, "many_body", false);
    if (object.item == NULL || mf_json_key(&object, 0) == NULL)
        return STATUS_OK;
    TRY_ARRAY(many_body->law, 1);
    many_body->law->composition = setup->composition;
    for (size_t n = 0; (name = mf_json_key(&object, n)); n++)
        TRY(read_term(many_body, &object, name, setup, fitted));
    mf_json_finish(&object);
    setup->interaction[setup->interactions++] =
        (struct interaction_choice){&mf_many_body, many_body->law};
    return STATUS_OK;
}

void mf_scene_many_body_clear(struct scene_many_body *many_body) {
    if (many_body->law)
        mf_many_body_clear(many_body->law);
    mf_memory_free(many_body->law);
    for (int t = 0; t < MANY_BODY_MAX_TERMS; t++) {
        mf_curve_clear(&many_body->weight[t]);
        mf_curve_clear(&many_body->energy[t]);
    }
    *many_body = (struct scene_many_body){0};
}

void mf_scene_many_body_write(const struct scene_many_body *many_body, struct json_writer *writer) {
    if (many_body->law == NULL)
        return;
    mf_json_begin(writer, "many_body");
    for (int t = 0; t < many_body->law->terms; t++) {
        mf_json_begin(writer, many_body->law->term[t].name);
        mf_json_write_fields(writer, mf_scene_many_body_fields, &many_body->types[t]);
        mf_scene_write_curve(&many_body->weight[t], writer, "weight");
        if (!scene_many_body_is_fitted(many_body, t))
            mf_scene_write_curve(&many_body->energy[t], writer, "energy");
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_scene_many_body_digest(const struct scene_many_body *many_body, uint64_t *digest) {
    static const size_t size = sizeof(double) * 4 * (TABLE_INTERVALS + 1);
    for (int t = 0; many_body->law && t < many_body->law->terms; t++) {
        const struct many_body_term *term = &many_body->law->term[t];
        mf_digest_add(digest, term->weight.table.coefficient, size);
        if (term->energy.tabulated)
            mf_digest_add(digest, term->energy.table.coefficient, size);
    }
}
