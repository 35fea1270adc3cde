// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_unknowns.h"

#include "base/names.h"
#include "observe/weighted_density.h"

#include <math.h>
#include <string.h>

#define AND(NAME, kind, ...) ", \"" #kind "s\""

/// Whether the scene knows the laws of molecules, and no target is left of which anything is found.
static bool knows_all(const struct json_object *root, const struct json_object *target) {
    struct json_object own = *root; // looks, and asks for nothing
    bool known = false;
    if (!mf_json_is_object(root, "scene") || mf_json_key(target, 0))
        return false;
    const struct json_object scene = mf_json_child(&own, "scene", false);
    for (int order = 0; order < BONDED_KINDS; order++)
        known = known || mf_json_is_object(&scene, mf_bonded_kinds[order]->plural);
    return known;
}

/// Whether an energy of local densities is left out, to be found from its target.
static bool finds_density(const struct json_object *root, const struct json_object *target) {
    const char *name, *const key = mf_targets_name(mf_weighted_density_kind());
    struct json_object own = *root; // looks, and asks for nothing
    if (!mf_json_is_object(root, "scene") || !mf_json_is_object(target, key))
        return false;
    const struct json_object scene = mf_json_child(&own, "scene", false);
    if (!mf_json_is_object(&scene, "many_body"))
        return false;
    struct json_object scene_own = scene;
    const struct json_object all = mf_json_child(&scene_own, "many_body", false);
    for (size_t n = 0; (name = mf_json_key(&all, n)); n++) {
        struct json_object terms = all;
        const struct json_object term = mf_json_child(&terms, name, false);
        if (term.item && !mf_json_is_member(&term, "energy"))
            return true;
    }
    return false;
}

/// Without "unknowns": what has a target is unknown, and g(r) always if nothing else is.
static bool has_potential(struct json_object *root) {
    const struct json_object target = mf_json_child(root, "target", false);
    bool groups = knows_all(root, &target) || finds_density(root, &target);
    for (int order = 0; order < BONDED_KINDS; order++)
        groups = groups || mf_json_is_object(&target, mf_bonded_distribution_of(order)->name);
    return !groups || mf_json_is_member(&target, mf_targets_name(TARGET_RDF));
}

int mf_fit_unknowns_left_out(struct json_object *root) {
    static const int part[UNKNOWNS] = {[UNKNOWN_POTENTIAL] = SCENE_FITS_POTENTIAL,
                                       [UNKNOWN_OMEGA] = SCENE_FITS_OMEGA,
                                       [UNKNOWN_MEMORY] = SCENE_FITS_MEMORY,
                                       [UNKNOWN_TRANSVERSE] = SCENE_FITS_TRANSVERSE};
    int all = 0;
    if (!mf_json_has(root, "unknowns"))
        return has_potential(root) ? SCENE_FITS_POTENTIAL : SCENE_FITS_NOTHING;
    const struct json_object unknowns = mf_json_child(root, "unknowns", false);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (part[kind] && mf_json_is_object(&unknowns, mf_inverse_unknown_names[kind]))
            all |= part[kind];
    return all;
}

/// A group is looked for, unless the scene knows its law.
static void enter_group(struct scene_fitted *fitted, int order, const char *name,
                        const struct json_object *known, struct json_object *from) {
    const bool has_law = mf_json_is_member(known, name);
    if (has_law && fitted->given)
        mf_json_fault(from, name, "it is to be found, but \"scene.%s\" has a law for it",
                      mf_bonded_kinds[order]->plural);
    if (has_law || fitted->count[order] == MOLECULES_MAX_GROUPS)
        return;
    if (!mf_topology_is_name(name)) {
        mf_json_fault(from, name, "expected a group name of " NAMES_OF_OTHERS,
                      TOPOLOGY_NAME_SIZE - 1);
        return;
    }
    strcpy(fitted->name[order][fitted->count[order]++], name);
}

bool mf_fit_unknowns_name_groups(const struct json_object *root) {
    struct json_object own = *root; // looks, and asks for nothing
    if (!mf_json_is_object(root, "unknowns"))
        return false;
    const struct json_object unknowns = mf_json_child(&own, "unknowns", false);
    for (int order = 0; order < BONDED_KINDS; order++)
        if (mf_json_is_member(&unknowns, mf_bonded_kinds[order]->plural))
            return true;
    return false;
}

void mf_fit_unknowns_groups(struct json_object *root, struct json_object *scene,
                            struct scene_fitted *fitted) {
    const bool given = mf_fit_unknowns_name_groups(root);
    struct json_object parent = mf_json_child(root, given ? "unknowns" : "target", false);
    *fitted = (struct scene_fitted){.given = given};
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct json_object known =
            mf_json_child(scene, mf_bonded_kinds[order]->plural, false);
        const char *key = given ? mf_bonded_kinds[order]->plural
                                : mf_bonded_distribution_of(order)->name,
                   *name;
        if (!mf_json_is_object(&parent, key))
            continue;
        struct json_object *from = &fitted->from[order];
        *from = mf_json_child(&parent, key, false);
        for (size_t n = 0; (name = mf_json_key(from, n)); n++)
            if (given || (strcmp(name, "weight") != 0 && strcmp(name, "fitted") != 0))
                enter_group(fitted, order, name, &known, from);
    }
}

static void read_shape(struct bonded_shape *shape, int order, struct json_object *group) {
    enum { COEFFICIENTS = 4, OF_CIRCLE = 6 };
    mf_json_fields(group, mf_inverse_group_fields, shape);
    if (shape->coefficients == 0)
        shape->coefficients = mf_bonded_kinds[order]->periodic ? OF_CIRCLE : COEFFICIENTS;
    if (group->item)
        mf_json_finish(group);
}

/// "bonds": {"backbone": {"coefficients": 6}}: each needs a target.
static void read_groups(struct fit_file *fit, struct json_object *root,
                        struct json_object *unknowns) {
    const struct molecules *molecules = &fit->scene.molecules.molecules;
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct target_groups *targets = target_files_groups(&fit->files, order);
        struct json_object groups = mf_json_child(unknowns, mf_bonded_kinds[order]->plural, false);
        for (int g = 0; g < molecules->groups[order]; g++) {
            const char *name = molecules->group[order][g].name;
            if (!mf_scene_groups_are_fitted(&molecules->group[order][g]))
                continue;
            fit->unknown[UNKNOWN_BONDED].wanted = true;
            struct json_object group = mf_json_child(&groups, name, false);
            read_shape(&fit->shape[order][g], order, &group);
            if (mf_json_fault_count(root->document) == 0 &&
                ((size_t)g >= targets->groups || targets->member[g].bins.count == 0))
                mf_json_fault(&groups, name, "there is no \"target.%s.%s\" to find it from",
                              mf_bonded_distribution_of(order)->name, name);
        }
        if (groups.item)
            mf_json_finish(&groups);
    }
}

/// Coefficients of a curve if the file does not say how many.
static const int64_t coefficients_of_curve[] = {[INVERSE_CURVE_BEZIER] = 100,
                                                [INVERSE_CURVE_BSPLINE] = 12,
                                                [INVERSE_CURVE_POWER] = INVERSE_PARAMETERS};

/// "fixed": {"exponent": 1}, what is not to be found of a formula.
static void check_fixed(const struct unknown_parameters *p, struct json_object *object) {
    const int free = mf_inverse_free_parameters(p->fixed);
    const double inner = p->fixed[INVERSE_INNER_CUTOFF];
    const double length = mf_json_factor(object, "lambda");
    if (free < INVERSE_PARAMETERS && p->shape != INVERSE_CURVE_POWER)
        mf_json_fault(object, "fixed", "only \"curve\": \"power\" has parameters to hold fixed");
    else if (free == 0)
        mf_json_fault(object, "fixed",
                      "with all of its parameters fixed nothing is left to be found");
    if (inner < p->inner_cutoff || inner >= p->cutoff)
        mf_json_fault(object, "fixed.inner_cutoff",
                      "%g is not between the friction weight's cutoffs, %g and %g", length * inner,
                      length * p->inner_cutoff, length * p->cutoff);
}

/// Coefficients of a formula are its parameters that are not fixed.
static void check_coefficients(struct unknown_parameters *p, struct json_object *object) {
    const int parameters = mf_inverse_free_parameters(p->fixed);
    if (p->shape != INVERSE_CURVE_POWER || parameters == 0)
        return;
    if (p->coefficients == 0)
        p->coefficients = parameters;
    else if (p->coefficients != parameters)
        mf_json_fault(object, "coefficients",
                      "the curve \"power\" has %d: sigma, exponent, inner cutoff, less those that "
                      "\"fixed\" holds",
                      parameters);
}

/// What follows from what was said of an unknown, by the file or by choices.
static void complete_unknown(struct fit_unknown *unknown, enum unknown_kind kind,
                             struct json_object *object) {
    struct unknown_parameters *p = &unknown->parameters;
    const double length = mf_json_factor(object, "lambda");
    const double unit =
        mf_json_factor(object, kind == UNKNOWN_POTENTIAL ? "k_B T_0" : "sqrt(mu/tau)");
    *p = unknown->said;
    if (unknown_is_omega(kind))
        check_fixed(p, object);
    if (kind != UNKNOWN_OMEGA && p->shape == INVERSE_CURVE_POWER)
        mf_json_fault(object, "curve",
                      "\"power\" is for \"unknowns.omega\"; here the scene has the law, and "
                      "\"numbers\" its parameters");
    check_coefficients(p, object);
    if (p->coefficients == 0)
        p->coefficients = coefficients_of_curve[p->shape];
    mf_fit_base_check(unknown, object);
    if (p->maximum <= p->minimum)
        mf_json_fault(object, "maximum", "%g is not above the minimum %g", unit * p->maximum,
                      unit * p->minimum);
    if (unknown_is_omega(kind) && p->cutoff <= p->inner_cutoff)
        mf_json_fault(object, "cutoff", "%g is not above the inner cutoff %g", length * p->cutoff,
                      length * p->inner_cutoff);
}

static enum status read_unknown(struct fit_unknown *unknown, enum unknown_kind kind,
                                struct json_object *object, const struct composition *composition,
                                const struct units *units) {
    const struct curve_family *const *laws =
        kind == UNKNOWN_POTENTIAL ? mf_curve_potentials : mf_curve_omegas;
    struct json_object fixed = {.document = object->document};
    unknown->fields =
        kind == UNKNOWN_POTENTIAL ? mf_inverse_potential_fields : mf_inverse_omega_fields;
    unknown->given = mf_json_fields(object, unknown->fields, &unknown->said);
    if (unknown_is_omega(kind))
        fixed = mf_json_child(object, "fixed", false);
    mf_json_fields(&fixed, mf_inverse_fixed_fields, unknown->said.fixed);
    if (fixed.item)
        mf_json_finish(&fixed);
    mf_json_retired(object, "spacing", "even", "coefficients are spread evenly; leave it out");
    TRY(mf_scene_law_read(&unknown->start, object, "start", laws, composition, units));
    TRY(mf_scene_law_read(&unknown->truth, object, "truth", laws, composition, units));
    if (object->item)
        mf_json_finish(object);
    return STATUS_OK;
}

/// Those with an object of their own; a mode of memory stands in "memory" under its name.
static const enum unknown_kind alone[] = {UNKNOWN_POTENTIAL, UNKNOWN_OMEGA, UNKNOWN_TRANSVERSE};
enum { ALONE = sizeof alone / sizeof *alone };

/// The scene says the friction weight of a mode, or the fit finds it.
static void check_modes(const struct fit_file *fit, struct json_object *memory) {
    for (int m = 0; m < fit->scene.memory.modes; m++) {
        const bool wanted = fit->unknown[UNKNOWN_MEMORY + m].wanted;
        const bool known = fit->scene.memory.omega[m].curves > 0;
        if (wanted && known)
            mf_json_fault(
                memory, fit->scene.memory.name[m],
                "it is to be found, but \"scene.memory.%s\" has an \"omega\"; give it as \"start\"",
                fit->scene.memory.name[m]);
        if (!wanted && !known)
            mf_json_fault(memory, fit->scene.memory.name[m],
                          "is missing, and \"scene.memory.%s\" has no \"omega\"",
                          fit->scene.memory.name[m]);
    }
}

/// A potential for each pair type, one friction weight for all.
static enum status read_curve(struct fit_file *fit, struct json_object *parent, const char *name,
                              enum unknown_kind kind) {
    const struct composition alike = mf_composition_of_one(fit->scene.setup.placement.count);
    struct fit_unknown *unknown = &fit->unknown[kind];
    struct json_object child = mf_json_child(parent, name, false);
    unknown->wanted = child.item != NULL;
    TRY(read_unknown(unknown, kind, &child,
                     unknown_is_omega(kind) ? &alike : &fit->scene.setup.composition,
                     &fit->scene.units));
    if (kind == UNKNOWN_OMEGA && unknown->wanted && !mf_fit_friction_take(unknown, fit->friction))
        mf_json_fault(&child, "curve",
                      "\"%s\" is not the power law that \"friction\" asks for: leave one of them "
                      "out",
                      unknown->fields->choices[unknown->said.shape]);
    complete_unknown(unknown, kind, &child);
    return STATUS_OK;
}

static enum status read_curves(struct fit_file *fit, struct json_object *unknowns) {
    for (size_t k = 0; k < ALONE; k++)
        TRY(read_curve(fit, unknowns, mf_inverse_unknown_names[alone[k]], alone[k]));
    struct json_object memory = mf_json_child(unknowns, "memory", false);
    for (int m = 0; m < fit->scene.memory.modes; m++)
        TRY(read_curve(fit, &memory, fit->scene.memory.name[m], UNKNOWN_MEMORY + m));
    if (memory.item == NULL)
        return STATUS_OK;
    check_modes(fit, &memory);
    mf_json_finish(&memory);
    return STATUS_OK;
}

enum status mf_fit_unknowns_read(struct fit_file *fit, struct json_object *root) {
    struct json_object object = mf_json_child(root, "unknowns", false);
    size_t wanted = 0;
    fit->says_unknowns = mf_json_is_member(root, "unknowns");
    TRY(read_curves(fit, &object));
    TRY(mf_fit_numbers_read(&object, &fit->scene, fit->number, &fit->numbers));
    read_groups(fit, root, &object);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        wanted += fit->unknown[kind].wanted;
    if (object.item == NULL) {
        fit->unknown[UNKNOWN_POTENTIAL].wanted = has_potential(root);
        return STATUS_OK;
    }
    const size_t faults = mf_json_fault_count(root->document);
    mf_json_finish(&object);
    if (wanted == 0 && !mf_json_has(&object, "numbers") &&
        mf_json_fault_count(root->document) == faults)
        mf_json_fault(root, "unknowns",
                      "needs \"potential\", \"omega\", \"numbers\", or "
                      "\"bonds\"" BONDED_LIST_BEYOND_BONDS(AND));
    const bool of_family =
        fit->friction == FIT_FRICTION_EXPORTABLE || fit->friction == FIT_FRICTION_LINEAR;
    if (of_family && !fit->unknown[UNKNOWN_OMEGA].wanted)
        mf_json_fault(root, "friction", "there is no \"omega\" among the \"unknowns\"");
    return STATUS_OK;
}

enum status mf_fit_unknowns_complete(struct fit_file *fit, struct json_object *root) {
    struct json_object object = mf_json_child(root, "unknowns", false);
    for (size_t k = 0; k < ALONE; k++) {
        struct json_object child =
            mf_json_child(&object, mf_inverse_unknown_names[alone[k]], false);
        complete_unknown(&fit->unknown[alone[k]], alone[k], &child);
    }
    return mf_fit_numbers_complete(&fit->scene, fit->number, fit->numbers);
}

static void write_fixed(const struct unknown_parameters *p, struct json_writer *writer) {
    if (mf_inverse_free_parameters(p->fixed) == INVERSE_PARAMETERS)
        return;
    mf_json_begin(writer, "fixed");
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        if (!isnan(p->fixed[k]))
            mf_json_write_quantity(writer, mf_inverse_fixed_fields[k].name,
                                   mf_inverse_fixed_fields[k].unit, p->fixed[k]);
    mf_json_end(writer);
}

static void write_unknown(const struct fit_file *fit, int kind, const char *name,
                          struct json_writer *writer) {
    const struct fit_unknown *unknown = &fit->unknown[kind];
    if (!unknown->wanted)
        return;
    mf_json_begin(writer, name);
    mf_json_write_fields(writer, unknown->fields, &unknown->parameters);
    write_fixed(&unknown->parameters, writer);
    mf_scene_law_write(&unknown->start, &fit->scene.setup.composition, writer, "start");
    mf_scene_law_write(&unknown->truth, &fit->scene.setup.composition, writer, "truth");
    mf_json_end(writer);
}

/// The modes that are to be found.
static void write_memory(const struct fit_file *fit, struct json_writer *writer) {
    bool any = false;
    for (int m = 0; m < fit->scene.memory.modes; m++)
        any = any || fit->unknown[UNKNOWN_MEMORY + m].wanted;
    if (!any)
        return;
    mf_json_begin(writer, "memory");
    for (int m = 0; m < fit->scene.memory.modes; m++)
        write_unknown(fit, UNKNOWN_MEMORY + m, fit->scene.memory.name[m], writer);
    mf_json_end(writer);
}

static void write_groups(const struct fit_file *fit, struct json_writer *writer) {
    const struct molecules *molecules = &fit->scene.molecules.molecules;
    for (int order = 0; order < BONDED_KINDS; order++) {
        bool begun = false;
        for (int g = 0; g < molecules->groups[order]; g++) {
            if (!mf_scene_groups_are_fitted(&molecules->group[order][g]))
                continue;
            if (!begun)
                mf_json_begin(writer, mf_bonded_kinds[order]->plural);
            begun = true;
            mf_json_begin(writer, molecules->group[order][g].name);
            mf_json_write_fields(writer, mf_inverse_group_fields, &fit->shape[order][g]);
            mf_json_end(writer);
        }
        if (begun)
            mf_json_end(writer);
    }
}

/// With the values that they begin with.
static void write_numbers(const struct inverse_number *number, size_t count,
                          struct json_writer *writer) {
    if (count == 0)
        return;
    mf_json_begin(writer, "numbers");
    for (size_t n = 0; n < count; n++) {
        mf_json_begin(writer, number[n].name);
        struct field fields[NUMBERS_FIELDS];
        mf_numbers_fields_of(number[n].unit, fields);
        mf_json_write_fields(writer, fields, &number[n]);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_fit_unknowns_write(const struct fit_file *fit, struct json_writer *writer) {
    mf_json_begin(writer, "unknowns");
    for (size_t k = 0; k < ALONE; k++)
        write_unknown(fit, alone[k], mf_inverse_unknown_names[alone[k]], writer);
    write_memory(fit, writer);
    write_groups(fit, writer);
    write_numbers(fit->number, fit->numbers, writer);
    mf_json_end(writer);
}

static const char *const families[] = {"free", "exportable", "linear", "chosen", NULL};

const struct field mf_fit_friction_fields[] = {
    {"friction", FIELD_CHOICE, .choices = families, .initial = FIT_FRICTION_FREE, .unit = "",
     .help = "as --friction of fit; chosen: it holds the temperature alone"},
    FIELD_END,
};

bool mf_fit_friction_take(struct fit_unknown *omega, enum fit_friction family) {
    struct unknown_parameters *said = &omega->said;
    if (family == FIT_FRICTION_FREE || family == FIT_FRICTION_CHOSEN)
        return true;
    if (fit_unknown_says(omega, "curve") && said->shape != INVERSE_CURVE_POWER)
        return false;
    said->shape = INVERSE_CURVE_POWER;
    if (!fit_unknown_says(omega, "inner_cutoff"))
        said->inner_cutoff = 0;
    omega->given |=
        mf_fields_bit(omega->fields, "curve") | mf_fields_bit(omega->fields, "inner_cutoff");
    if (isnan(said->fixed[INVERSE_INNER_CUTOFF]))
        said->fixed[INVERSE_INNER_CUTOFF] = 0;
    if (family == FIT_FRICTION_LINEAR && isnan(said->fixed[INVERSE_EXPONENT]))
        said->fixed[INVERSE_EXPONENT] = 1;
    return true;
}
