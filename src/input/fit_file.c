// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/fit_file.h"

#include "base/memory.h"
#include "base/names.h"
#include "input/fit_base.h"
#include "input/fit_check.h"
#include "input/fit_defaults.h"

#include <math.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct fit_core, name)
const struct field mf_fit_core_fields[] = {
    {"threshold", FIELD_NUMBER, MEMBER(threshold), .initial = 1e-3, .minimum = 0, .maximum = 1,
     .unit = "", .help = "the bins before the first with a target above this are the hard core"},
    {"stiffness", FIELD_NUMBER, MEMBER(stiffness), .initial = 2000, .minimum = 0,
     .maximum = DBL_MAX, .unit = "k_B T_0/lambda^2",
     .help = "curvature of the potential in the core"},
    FIELD_END,
};

NAMED_RECORD(struct inverse_method);

/// Where forces from outside act, g(r) does not follow from those of pairs; partial g(r) do not
/// follow from the force on a bead of either type.
static void check_estimator(const struct fit_file *fit, struct json_object *method) {
    if (fit->method->sampling == NULL || !fit->method->sampling(fit->method_parameters).rdf_force)
        return;
    if (composition_is_mixed(&fit->scene.setup.composition))
        mf_json_fault(method, "estimator",
                      "\"force\" is not for mixtures; \"histogram\" counts their partial g(r)");
    if (fit->scene.setup.interactions > 0)
        mf_json_fault(method, "estimator",
                      "\"force\" knows the forces of pairs alone, not \"interactions\"");
}

static enum status read_method(struct fit_file *fit, struct json_object *root) {
    const char **names;
    struct json_object object = mf_json_child_of(root, "method", true, "name");
    if (object.item == NULL)
        return STATUS_OK;
    TRY(mf_names_collect(mf_inverse_methods, NULL, &names));
    const char *name = mf_json_choice(&object, "name", names, NULL);
    mf_memory_free(names);
    if (name == NULL)
        return STATUS_OK;
    fit->method = mf_names_find(mf_inverse_methods, name);
    fit->method_parameters = mf_memory_zeroed(1, fit->method->parameters_size);
    if (fit->method_parameters == NULL)
        return STATUS_NO_MEMORY;
    for (const struct inverse_table *table = fit->method->tables; table->fields; table++)
        mf_json_fields(&object, table->fields, (char *)fit->method_parameters + table->offset);
    check_estimator(fit, &object);
    mf_json_finish(&object);
    return STATUS_OK;
}

static const struct field *unknown_fields(enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? mf_inverse_potential_fields : mf_inverse_omega_fields;
}

/// Coefficients of a curve if the file does not say how many.
static const int64_t coefficients_of_curve[] = {[INVERSE_CURVE_BEZIER] = 100,
                                                [INVERSE_CURVE_BSPLINE] = 12,
                                                [INVERSE_CURVE_POWER] = INVERSE_PARAMETERS};

/// "fixed": {"exponent": 1}, what is not to be found of a formula.
static void read_fixed(struct unknown_parameters *p, struct json_object *object) {
    struct json_object fixed = mf_json_child(object, "fixed", false);
    mf_json_fields(&fixed, mf_inverse_fixed_fields, p->fixed);
    if (fixed.item == NULL)
        return;
    mf_json_finish(&fixed);
    if (p->shape != INVERSE_CURVE_POWER)
        mf_json_fault(object, "fixed", "only \"curve\": \"power\" has parameters to hold fixed");
    else if (mf_inverse_free_parameters(p->fixed) == 0)
        mf_json_fault(object, "fixed",
                      "with all of its parameters fixed nothing is left to be found");
    const double inner = p->fixed[INVERSE_INNER_CUTOFF];
    const double length = mf_json_factor(object, "lambda");
    if (inner < p->inner_cutoff || inner >= p->cutoff)
        mf_json_fault(&fixed, "inner_cutoff",
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

static enum status read_unknown(struct fit_unknown *unknown, enum unknown_kind kind,
                                struct json_object *object, const struct composition *composition,
                                const struct units *units) {
    const struct curve_family *const *laws =
        kind == UNKNOWN_POTENTIAL ? mf_curve_potentials : mf_curve_omegas;
    mf_json_fields(object, unknown_fields(kind), &unknown->parameters);
    struct unknown_parameters *p = &unknown->parameters;
    const double length = mf_json_factor(object, "lambda");
    const double unit =
        mf_json_factor(object, kind == UNKNOWN_POTENTIAL ? "k_B T_0" : "sqrt(mu/tau)");
    mf_fields_set_defaults(mf_inverse_fixed_fields, p->fixed);
    if (kind == UNKNOWN_OMEGA)
        read_fixed(p, object);
    check_coefficients(p, object);
    if (p->coefficients == 0)
        p->coefficients = coefficients_of_curve[p->shape];
    if (object->item == NULL) {
        mf_fit_base_check(unknown, object);
        return STATUS_OK;
    }
    mf_json_renamed(object, "genes", "coefficients");
    TRY(mf_scene_law_read(&unknown->start, object, "start", laws, composition, units));
    mf_fit_base_check(unknown, object);
    if (p->maximum <= p->minimum)
        mf_json_fault(object, "maximum", "%g is not above the minimum %g", unit * p->maximum,
                      unit * p->minimum);
    if (kind == UNKNOWN_OMEGA && p->cutoff <= p->inner_cutoff)
        mf_json_fault(object, "cutoff", "%g is not above the inner cutoff %g", length * p->cutoff,
                      length * p->inner_cutoff);
    TRY(mf_scene_law_read(&unknown->truth, object, "truth", laws, composition, units));
    mf_json_finish(object);
    return STATUS_OK;
}

/// "unknowns": {"potential": {…}, "omega": {…}, "numbers": {…}}; a file without it looks for the
/// potential.
static enum status read_unknowns(struct fit_file *fit, struct json_object *root) {
    struct json_object object = mf_json_child(root, "unknowns", false);
    // A potential for each pair type, one friction weight for all.
    const struct composition composition[UNKNOWNS] = {
        [UNKNOWN_POTENTIAL] = fit->scene.setup.composition,
        [UNKNOWN_OMEGA] = mf_composition_of_one(fit->scene.setup.placement.count)};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        struct json_object child = mf_json_child(&object, mf_inverse_unknown_names[kind], false);
        fit->unknown[kind].wanted = child.item != NULL;
        TRY(read_unknown(&fit->unknown[kind], kind, &child, &composition[kind], &fit->scene.units));
    }
    TRY(mf_fit_numbers_read(&object, &fit->scene, fit->number, &fit->numbers));
    if (object.item) {
        const size_t faults = mf_json_fault_count(root->document);
        mf_json_renamed(&object, "weight", mf_inverse_unknown_names[UNKNOWN_OMEGA]);
        mf_json_finish(&object);
        if (!fit->unknown[UNKNOWN_POTENTIAL].wanted && !fit->unknown[UNKNOWN_OMEGA].wanted &&
            !mf_json_has(&object, "numbers") && mf_json_fault_count(root->document) == faults)
            mf_json_fault(root, "unknowns", "needs \"potential\", \"omega\" or \"numbers\"");
    } else {
        fit->unknown[UNKNOWN_POTENTIAL].wanted = true;
    }
    return STATUS_OK;
}

/// What stands in scene files, but not in the scene of a fit.
static void refuse_foreign(struct json_object *scene, int unknown) {
    if (unknown & SCENE_FITS_POTENTIAL)
        mf_json_refuse(
            scene, "conservative",
            "it is to be found; \"start\" in \"unknowns.potential\" takes a law to begin "
            "with");
    if (unknown & SCENE_FITS_OMEGA)
        mf_json_refuse(
            scene, "dissipative",
            "it is to be found; \"start\" in \"unknowns.omega\" takes a law to begin with");
    mf_json_refuse(scene, "seed", "it stands at the top of a run file");
    mf_json_refuse(scene, "measure", "\"method\" and \"verification\" say when a fit samples");
    for (size_t k = 0; mf_observables[k]; k++)
        mf_json_refuse(scene, mf_observables[k]->name, "a fit measures what its \"target\" names");
}

/// The scene leaves out what "unknowns" names.
static enum status read_scene(struct fit_file *fit, struct json_object *root) {
    struct json_object scene = mf_json_child(root, "scene", true);
    if (scene.item == NULL)
        return STATUS_OK;
    int unknown = SCENE_FITS_POTENTIAL;
    if (mf_json_has(root, "unknowns")) {
        struct json_object unknowns = mf_json_child(root, "unknowns", false);
        unknown = (mf_json_has(&unknowns, mf_inverse_unknown_names[0]) ? SCENE_FITS_POTENTIAL : 0) |
                  (mf_json_has(&unknowns, mf_inverse_unknown_names[1]) ? SCENE_FITS_OMEGA : 0);
    }
    TRY(mf_scene_read(&fit->scene, &scene, unknown));
    refuse_foreign(&scene, unknown);
    mf_json_finish(&scene);
    return STATUS_OK;
}

static enum status read_root(struct fit_file *fit, struct json_object *root) {
    mf_json_fields(root, mf_heading_fields, &fit->heading);
    struct json_object scene = mf_json_child(root, "scene", false);
    mf_units_speak(root, &scene);
    // Before what its units convert.
    TRY(read_scene(fit, root));
    TRY(mf_target_files_read(&fit->files, root, &fit->scene.setup.box,
                             &fit->scene.setup.composition, &fit->scene.units));
    TRY(read_unknowns(fit, root));
    TRY(read_method(fit, root));
    struct json_object core = mf_json_child(root, "core", false);
    mf_json_fields(&core, mf_fit_core_fields, &fit->core);
    if (core.item)
        mf_json_finish(&core);
    struct json_object verification = mf_json_child(root, "verification", false);
    mf_json_fields(&verification, mf_verify_fields, &fit->verification);
    if (verification.item)
        mf_json_finish(&verification);
    mf_json_finish(root);
    return STATUS_OK;
}

static void state_problem(struct fit_file *fit, const struct run_options *options) {
    struct inverse_problem *problem = &fit->problem;
    if (options->has_seed)
        fit->heading.seed = options->seed;
    *problem = (struct inverse_problem){
        .scene = fit->scene.setup,
        .core_threshold = fit->core.threshold,
        .core_stiffness = fit->core.stiffness,
        .seed = fit->heading.seed,
        .threads = options->threads,
    };
    problem->numbers = fit->numbers;
    memcpy(problem->number, fit->number, sizeof problem->number);
    for (int place = 0; place < INVERSE_LAWS; place++) {
        const struct scene_law *law = mf_fit_numbers_law(&fit->scene, place);
        problem->law[place] = (struct inverse_law){law->curves, law->curve};
    }
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct fit_unknown *from = &fit->unknown[kind];
        struct unknown *unknown = &problem->unknown[kind];
        unknown->wanted = from->wanted;
        unknown->parameters = from->parameters;
        for (int pair = 0; pair < mf_composition_pairs(&problem->scene.composition); pair++)
            unknown->start[pair] = mf_scene_law_curve(&from->start, pair);
    }
    mf_target_files_targets(&fit->files, fit->unknown[UNKNOWN_OMEGA].wanted || fit->numbers > 0,
                            &problem->targets, &problem->compared);
}

/// Read the file, with choices for what it leaves out if there is a `plain` reading of it; else
/// made readable if it needs choices, and `wanted` says so.
static enum status read_document(struct fit_file *fit, const char *file,
                                 const struct fit_file *plain, bool *wanted) {
    struct json_document *document;
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    enum status status = mf_heading_check_run(&root, file);
    *wanted = mf_fit_defaults_wanted(&root);
    if (status == STATUS_OK && *wanted)
        status = plain ? mf_fit_defaults_choose(plain, &root, &fit->choices)
                       : mf_fit_defaults_make_readable(&root);
    if (status == STATUS_OK)
        status = mf_json_collect_files(document, &fit->inputs);
    if (status == STATUS_OK)
        status = read_root(fit, &root);
    return mf_json_close(document, status);
}

enum status mf_fit_file_parse(struct fit_file *fit, const char *file,
                              const struct run_options *options) {
    bool wanted;
    *fit = (struct fit_file){0};
    TRY(read_document(fit, file, NULL, &wanted));
    state_problem(fit, options);
    if (wanted) {
        struct fit_file plain = *fit;
        *fit = (struct fit_file){0};
        const enum status status = read_document(fit, file, &plain, &wanted);
        mf_fit_file_clear(&plain);
        TRY(status);
        state_problem(fit, options);
    }
    return STATUS_OK;
}

enum status mf_fit_file_read(struct fit_file *fit, const char *file,
                             const struct run_options *options) {
    TRY(mf_fit_file_parse(fit, file, options));
    TRY(mf_fit_check(fit, file));
    return mf_fit_base_find(fit);
}

void mf_fit_file_clear(struct fit_file *fit) {
    mf_target_files_clear(&fit->files);
    mf_scene_clear(&fit->scene);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        mf_scene_law_clear(&fit->unknown[kind].start);
        mf_scene_law_clear(&fit->unknown[kind].truth);
        mf_memory_free(fit->unknown[kind].base);
    }
    mf_memory_free(fit->method_parameters);
    mf_input_files_clear(&fit->inputs);
    *fit = (struct fit_file){0};
}

static void write_fixed(const struct unknown_parameters *p, struct json_writer *writer) {
    if (mf_inverse_free_parameters(p->fixed) == INVERSE_PARAMETERS)
        return;
    mf_json_begin(writer, "fixed");
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        if (!isnan(p->fixed[k]))
            mf_json_put_quantity(writer, mf_inverse_fixed_fields[k].name,
                                 mf_inverse_fixed_fields[k].unit, p->fixed[k]);
    mf_json_end(writer);
}

static void write_unknowns(const struct fit_file *fit, struct json_writer *writer) {
    mf_json_begin(writer, "unknowns");
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct fit_unknown *unknown = &fit->unknown[kind];
        if (!unknown->wanted)
            continue;
        mf_json_begin(writer, mf_inverse_unknown_names[kind]);
        mf_json_put_fields(writer, unknown_fields(kind), &unknown->parameters);
        write_fixed(&unknown->parameters, writer);
        mf_scene_law_write(&unknown->start, &fit->scene.setup.composition, writer, "start");
        mf_scene_law_write(&unknown->truth, &fit->scene.setup.composition, writer, "truth");
        mf_json_end(writer);
    }
    mf_fit_numbers_write(fit->number, fit->numbers, writer);
    mf_json_end(writer);
}

enum status mf_fit_file_write(const struct fit_file *fit, const char *path) {
    struct json_writer *writer = mf_json_writer_create();
    mf_json_put_fields(writer, mf_heading_fields, &fit->heading);
    mf_units_write(&fit->scene.units, writer);
    mf_target_files_write(&fit->files, writer);
    write_unknowns(fit, writer);
    mf_json_begin(writer, "scene");
    mf_scene_write(&fit->scene, writer);
    mf_json_end(writer);
    mf_json_begin(writer, "method");
    mf_json_put_text(writer, "name", fit->method->name);
    for (const struct inverse_table *table = fit->method->tables; table->fields; table++)
        mf_json_put_fields(writer, table->fields,
                           (const char *)fit->method_parameters + table->offset);
    mf_json_end(writer);
    mf_json_begin(writer, "core");
    mf_json_put_fields(writer, mf_fit_core_fields, &fit->core);
    mf_json_end(writer);
    mf_json_begin(writer, "verification");
    mf_json_put_fields(writer, mf_verify_fields, &fit->verification);
    mf_json_end(writer);
    const enum status status = mf_json_write(writer, path);
    mf_json_writer_free(writer);
    return status;
}
