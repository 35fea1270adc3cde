// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_file.h"

#include "base/digest.h"
#include "base/memory.h"
#include "defaults/fit_defaults.h"
#include "defaults/fit_densities.h"
#include "defaults/fit_engine.h"
#include "defaults/methods.h"
#include "defaults/fit_states.h"
#include "defaults/fit_unknowns.h"
#include "inversion/inversion.h"
#include "io/text_file.h"
#include "problem/unknowns.h"

#include <math.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct fit_core, name)
const struct field mf_fit_core_fields[] = {
    {"threshold", FIELD_NUMBER, MEMBER(threshold), .initial = 1e-3, .minimum = 0, .maximum = 1,
     .unit = "",
     .help = "g, if larger than two standard errors, below which bins near r = 0 are the core"},
    {"stiffness", FIELD_NUMBER, MEMBER(stiffness), .initial = 2000, .minimum = 0,
     .maximum = DBL_MAX, .unit = "k_B T_0/lambda^2",
     .help = "curvature of the potential in the core"},
    FIELD_END,
};

/// What stands in scene files, but not in the scene of a fit.
static void refuse_foreign(struct json_object *scene, int unknown) {
    if (unknown & SCENE_FITS_POTENTIAL)
        mf_json_refuse(
            scene, "conservative",
            "it is to be found; give an initial law as \"start\" of \"unknowns.potential\", and a "
            "part that is known as \"scene.known\"");
    if (unknown & SCENE_FITS_OMEGA)
        mf_json_refuse(scene, "dissipative",
                       "it is to be found; give an initial law as \"start\" of \"unknowns.omega\"");
    if (unknown & SCENE_FITS_TRANSVERSE)
        mf_json_refuse(
            scene, "dissipative_transverse",
            "it is to be found; give an initial law as \"start\" of \"unknowns.omega_transverse\"");
    mf_json_refuse(scene, "seed", "it belongs at the top of a run file");
    mf_json_refuse(scene, "measure", "\"method\" and \"verification\" set the sampling of a fit");
    for (size_t k = 0; mf_observables[k]; k++)
        mf_json_refuse(scene, mf_observables[k]->name, "a fit measures what its \"target\" names");
}

/// The scene leaves out what "unknowns" names.
static enum status read_scene(struct fit_file *fit, struct json_object *root) {
    struct json_object scene = mf_json_child(root, "scene", true);
    if (scene.item == NULL)
        return STATUS_OK;
    struct scene_fitted fitted;
    const int unknown = mf_fit_unknowns_left_out(root);
    mf_fit_unknowns_groups(root, &scene, &fitted);
    fitted.count_follows = mf_json_is_member(&scene, "density");
    TRY(mf_scene_read(&fit->scene, &scene, unknown, &fitted));
    refuse_foreign(&scene, unknown);
    mf_json_finish(&scene);
    return STATUS_OK;
}

static struct target_scene target_scene_of(const struct fit_file *fit) {
    const struct simulation_setup *setup = &fit->scene.setup;
    return (struct target_scene){&setup->box, &setup->composition,
                                 mf_molecules_find(setup->interaction, setup->interactions),
                                 &fit->scene.units};
}

/// @param[in] leader  the first of several states, whose units all have; NULL of itself
static enum status read_root(struct fit_file *fit, struct json_object *root,
                             const struct fit_file *leader) {
    mf_json_fields(root, mf_heading_fields, &fit->heading);
    mf_json_fields(root, mf_fit_friction_fields, &fit->friction);
    struct json_object scene = mf_json_child(root, "scene", false);
    mf_units_read_document(root, &scene);
    if (leader && mf_units_are_physical(&leader->scene.units))
        mf_json_set_units(root->document, &leader->scene.units);
    // Before what its units convert.
    TRY(read_scene(fit, root));
    const struct target_scene about = target_scene_of(fit);
    TRY(mf_target_files_read(&fit->files, root, &about));
    TRY(mf_fit_unknowns_read(fit, root));
    TRY(mf_fit_densities_read(fit, root));
    TRY(mf_methods_read(fit, root));
    mf_fit_engine_read(fit, root);
    struct json_object core = mf_json_child(root, "core", false);
    fit->core_given = mf_json_fields(&core, mf_fit_core_fields, &fit->core);
    if (core.item)
        mf_json_finish(&core);
    struct json_object verification = mf_json_child(root, "verification", false);
    fit->verification_given = mf_json_fields(&verification, mf_verify_fields, &fit->verification);
    if (verification.item)
        mf_json_finish(&verification);
    mf_json_finish(root);
    return STATUS_OK;
}

/// The groups that are to be found and have a target, in the order of their targets.
static void state_groups(struct fit_file *fit) {
    struct inverse_problem *problem = &fit->problem;
    const struct molecules *molecules = &fit->scene.molecules.molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct target_groups *groups = target_files_groups(&fit->files, order);
            if (!mf_scene_groups_are_fitted(&molecules->group[order][g]) ||
                (size_t)g >= groups->groups || groups->member[g].bins.count == 0)
                continue;
            problem->group[problem->bonded++] = (struct bonded_unknown){
                order, g, groups->member[g].bins, groups->first[g], fit->shape[order][g]};
        }
}

/// What is known of all groups of an order is compared, as nothing is found from it.
static void compare_known(struct fit_file *fit) {
    bool found[BONDED_KINDS] = {false};
    for (size_t g = 0; g < fit->problem.bonded; g++)
        found[fit->problem.group[g].order] = true;
    for (size_t n = 0; n < fit->numbers; n++)
        if (fit->number[n].place == INVERSE_OF_BONDED)
            found[inverse_order(fit->number[n].part)] = true;
    for (int order = 0; order < BONDED_KINDS; order++)
        if (!found[order])
            fit->files.use[mf_bonded_distribution_kind(order)].fitted = 0;
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
    problem->scene.cancel = options->stop;
    problem->forces = fit->files.forces.given ? &fit->files.forces.equations : NULL;
    problem->numbers = fit->numbers;
    memcpy(problem->number, fit->number, sizeof problem->number);
    mf_fit_numbers_lend(&fit->scene, problem);
    problem->knows_elsewhere = mf_fit_engine_knows_more(fit);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct fit_unknown *from = &fit->unknown[kind];
        struct unknown *unknown = &problem->unknown[kind];
        unknown->wanted = from->wanted;
        unknown->parameters = from->parameters;
        for (int pair = 0; pair < mf_composition_pairs(&problem->scene.composition); pair++)
            unknown->start[pair] = mf_scene_law_curve(&from->start, pair);
    }
    for (int m = 0; m < fit->scene.memory.modes; m++)
        problem->mode[m] = fit->scene.memory.name[m];
    state_groups(fit);
    compare_known(fit);
    mf_fit_densities_state(fit, problem);
    const size_t others = mf_inverse_unknown_count(problem) -
                          problem->unknown[UNKNOWN_POTENTIAL].wanted -
                          problem->unknown[UNKNOWN_BONDED].wanted;
    mf_target_files_targets(&fit->files, others > 0, &problem->targets, &problem->compared);
}

/// Which state of which file is read.
struct reading {
    const char *file, *text;
    const struct run_options *options;
    size_t state;
    const struct fit_file *leader; ///< the first state, in whose units and range the others are
    size_t states;                 ///< found; 0: the file has no states
    struct json_document *document;
};

/// Laws for the groups that are constraints: of all states those of the first.
static enum status take_constraints(struct fit_file *fit, const struct reading *reading,
                                    const struct json_object *root) {
    if (reading->leader)
        fit->constraints = reading->leader->constraints;
    else if (!mf_fit_unknowns_name_groups(root))
        mf_fit_constraints_find(fit);
    if (fit->constraints.count == 0)
        return STATUS_OK;
    TRY(mf_fit_constraints_apply(fit));
    state_problem(fit, reading->options);
    fit->unknown[UNKNOWN_BONDED].wanted = fit->problem.bonded > 0;
    return STATUS_OK;
}

/// What follows from the choices.
static enum status complete(struct fit_file *fit, struct json_object *root) {
    struct json_object scene = mf_json_child(root, "scene", true);
    TRY(mf_scene_complete(&fit->scene, &scene, fit->integrator, fit->inner_steps));
    if (fit->method == NULL)
        mf_json_child(root, "method", true);
    const struct target_scene about = target_scene_of(fit);
    TRY(mf_target_files_complete(&fit->files, root, &about));
    return mf_fit_unknowns_complete(fit, root);
}

static enum status read_state(struct fit_file *fit, struct reading *reading) {
    struct json_document *document = reading->document;
    TRY(mf_json_add(document, reading->options->words, reading->options->word_count));
    TRY(mf_fit_states_take(document, reading->file, reading->state, fit->name, &reading->states));
    struct json_object root = mf_json_root(document);
    TRY(mf_heading_check_run(&root, reading->file));
    TRY(mf_json_collect_files(document, &fit->inputs));
    TRY(read_root(fit, &root, reading->leader));
    state_problem(fit, reading->options);
    if (mf_json_fault_count(document) > 0)
        return STATUS_OK;
    TRY(take_constraints(fit, reading, &root));
    fit->choices.thermostat = fit->friction == FIT_FRICTION_CHOSEN && fit->scene.given.dissipative;
    TRY(mf_fit_defaults_choose(fit, reading->leader));
    mf_methods_check(fit, &root);
    TRY(complete(fit, &root));
    state_problem(fit, reading->options);
    return STATUS_OK;
}

static enum status parse_state(struct fit_file *fit, struct reading *reading) {
    TRY(mf_json_open_text(&reading->document, reading->file, reading->text));
    return mf_json_close(reading->document, read_state(fit, reading));
}

/// The states after the first. What they read is read by the run.
static enum status parse_others(struct fit_file *fit, const struct reading *first) {
    if (first->states < 2)
        return STATUS_OK;
    TRY_ARRAY(fit->other, first->states - 1);
    while (fit->others < first->states - 1) {
        struct fit_file *other = &fit->other[fit->others++];
        struct reading reading = *first;
        reading.state = fit->others;
        reading.leader = fit;
        TRY(mf_fit_states_mark(other, parse_state(other, &reading)));
        for (size_t k = 0; k < other->inputs.count; k++)
            TRY(mf_input_files_add(&fit->inputs, other->inputs.file[k].name));
    }
    return STATUS_OK;
}

enum status mf_fit_file_parse(struct fit_file *fit, const char *file,
                              const struct run_options *options) {
    *fit = (struct fit_file){0};
    OWNED char *text = NULL;
    size_t length;
    TRY(mf_text_file_read(file, &text, &length));
    struct reading reading = {.file = file, .text = text, .options = options};
    TRY(mf_fit_states_mark(fit, parse_state(fit, &reading)));
    TRY(parse_others(fit, &reading));
    TRY(mf_fit_states_widen(fit, file));
    for (size_t s = 0; fit->others > 0 && s < mf_fit_states_count(fit); s++)
        state_problem(mf_fit_states_at(fit, s), options);
    mf_fit_states_link(fit);
    return STATUS_OK;
}

// Bases ------------------------------------------------------------------------------------------

/// BASE_AUTO as far as the file says it: the start, or else what is found in the target.
static enum unknown_base base_of(const struct fit_unknown *unknown) {
    if (unknown->parameters.base == BASE_AUTO && unknown->start.curves > 0)
        return BASE_START;
    return (enum unknown_base)unknown->parameters.base;
}

void mf_fit_base_check(struct fit_unknown *unknown, struct json_object *object) {
    struct unknown_parameters *p = &unknown->parameters;
    if (p->base == BASE_AUTO && !fit_unknown_says(unknown, "base") &&
        (fit_unknown_says(unknown, "minimum") || fit_unknown_says(unknown, "maximum")))
        p->base = BASE_NONE;
    const enum unknown_base base = base_of(unknown);
    if (isnan(p->minimum))
        p->minimum = base == BASE_NONE ? 0 : -p->maximum;
    if (base != BASE_NONE && p->shape == INVERSE_CURVE_POWER)
        mf_json_fault(object, "base", "the curve \"power\" takes no base");
    else if (base != BASE_NONE && p->minimum >= 0)
        mf_json_fault(object, "minimum",
                      "%g: coefficients are added to the base and must be free to fall below 0; "
                      "with \"base\": \"none\" they make the curve alone",
                      p->minimum);
    else if (base == BASE_START && unknown->start.curves == 0)
        mf_json_fault(object, "base", "\"start\" needs a start");
}

/// The hypernetted chain's. Where it puts the liquid under tension it is far off, and some targets
/// have none. There `auto` takes −k_B T ln g.
static enum status fill_hnc(const struct inverse_problem *problem, const struct unknowns *unknowns,
                            bool even_under_tension, double *curve) {
    double pressure;
    const enum status status = mf_inversion_start_curve(problem, curve, &pressure);
    if (even_under_tension || status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK || pressure < 0)
        mf_potential_grid_start_pairs(&unknowns->potential, problem, curve);
    return STATUS_OK;
}

/// The base of an unknown; what is made of the target, whatever start there is. The hypernetted
/// chain knows no bonds.
static enum status fill_base(const struct fit_file *fit, const struct unknowns *unknowns,
                             enum unknown_kind kind, double *curve) {
    struct inverse_problem without = fit->problem;
    const enum unknown_base base = base_of(&fit->unknown[kind]);
    const bool joined = scene_has_molecules(&fit->scene.molecules);
    for (int pair = 0; pair < COMPOSITION_MAX_PAIRS; pair++)
        without.unknown[UNKNOWN_POTENTIAL].start[pair] = NULL;
    if (base == BASE_START)
        mf_unknowns_start(unknowns, kind, curve);
    else if (base == BASE_MEAN_FORCE || (base == BASE_AUTO && joined))
        mf_potential_grid_start_pairs(&unknowns->potential, &without, curve);
    else if (joined)
        return mf_status_fail(STATUS_BAD_INPUT, "unknowns.potential.base: the hypernetted chain is "
                                                "not for molecules; use \"mean-force\"");
    else if (base == BASE_HNC && fit->problem.scene.box.dimensions != 3)
        return mf_status_fail(STATUS_BAD_INPUT, "unknowns.potential.base: the hypernetted chain is "
                                                "for three dimensions; use \"mean-force\"");
    else
        return fill_hnc(&without, unknowns, base == BASE_HNC, curve);
    return STATUS_OK;
}

/// Find the bases of a problem that has been checked, for methods that move coefficients.
static enum status find_bases(struct fit_file *fit) {
    CLEARED_BY(mf_unknowns_clear) struct unknowns unknowns = {0};
    if (fit->method->kind != INVERSE_MATCHING)
        return STATUS_OK;
    TRY(mf_unknowns_init(&unknowns, &fit->problem));
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        struct fit_unknown *unknown = &fit->unknown[kind];
        if (!unknown->wanted || kind == UNKNOWN_BONDED || base_of(unknown) == BASE_NONE)
            continue;
        TRY_ARRAY(unknown->base, mf_unknowns_points(&unknowns, kind));
        TRY(fill_base(fit, &unknowns, kind, unknown->base));
        fit->problem.unknown[kind].base = unknown->base;
    }
    return STATUS_OK;
}

// Files ------------------------------------------------------------------------------------------

enum status mf_fit_file_check(struct fit_file *fit, const char *file) {
    TRY(mf_fit_states_check(fit, file));
    for (size_t s = 0; s < mf_fit_states_count(fit); s++) {
        struct fit_file *state = mf_fit_states_at(fit, s);
        TRY(mf_fit_states_mark(state, mf_fit_check(state, file)));
    }
    TRY(mf_fit_engine_check(fit, file));
    return find_bases(fit);
}

enum status mf_fit_file_read(struct fit_file *fit, const char *file,
                             const struct run_options *options) {
    TRY(mf_fit_file_parse(fit, file, options));
    return mf_fit_file_check(fit, file);
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
    for (size_t s = 0; s < fit->others; s++)
        mf_fit_file_clear(&fit->other[s]);
    mf_memory_free(fit->other);
    *fit = (struct fit_file){0};
}

static void write_verification(const struct fit_file *fit, struct json_writer *writer) {
    mf_json_begin(writer, "verification");
    mf_json_write_fields(writer, mf_verify_fields, &fit->verification);
    mf_json_end(writer);
}

/// What is measured, and of what.
static void write_state(const struct fit_file *fit, struct json_writer *writer) {
    mf_target_files_write(&fit->files, writer);
    mf_json_begin(writer, "scene");
    mf_scene_write(&fit->scene, writer);
    mf_json_end(writer);
    write_verification(fit, writer);
}

static void write_states(const struct fit_file *fit, struct json_writer *writer) {
    mf_json_begin(writer, "states");
    for (size_t s = 0; s < mf_fit_states_count(fit); s++) {
        const struct fit_file *state = s == 0 ? fit : &fit->other[s - 1];
        mf_json_begin(writer, state->name);
        write_state(state, writer);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_fit_file_write(const struct fit_file *fit, struct json_writer *writer) {
    mf_json_write_fields(writer, mf_heading_fields, &fit->heading);
    mf_units_write(&fit->scene.units, writer);
    if (fit->choices.thermostat)
        mf_json_write_text(writer, "friction", "chosen");
    if (fit->name[0])
        write_states(fit, writer);
    else
        write_state(fit, writer);
    mf_fit_unknowns_write(fit, writer);
    mf_json_begin(writer, "method");
    mf_json_write_text(writer, "name", fit->method->name);
    for (const struct inverse_table *table = fit->method->tables; table->fields; table++)
        mf_json_write_fields(writer, table->fields,
                             (const char *)fit->method_parameters + table->offset);
    mf_json_end(writer);
    mf_fit_engine_write(fit, writer);
    mf_json_begin(writer, "core");
    mf_json_write_fields(writer, mf_fit_core_fields, &fit->core);
    mf_json_end(writer);
}

static void digest_curve(const struct curve *curve, uint64_t *digest) {
    enum { POINTS = 1000 };
    for (int k = 0; k < POINTS; k++) {
        const double value = mf_curve_value(curve, mf_curve_cutoff(curve) * k / POINTS);
        mf_digest_add(digest, &value, sizeof value);
    }
}

void mf_fit_file_digest(const struct fit_file *fit, uint64_t *digest) {
    mf_target_files_digest(&fit->files, digest);
    mf_scene_digest(&fit->scene, digest);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (int pair = 0; pair < COMPOSITION_MAX_PAIRS; pair++)
            if (fit->problem.unknown[kind].start[pair])
                digest_curve(fit->problem.unknown[kind].start[pair], digest);
    for (size_t s = 0; s < fit->others; s++)
        mf_fit_file_digest(&fit->other[s], digest);
}
