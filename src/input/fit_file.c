// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/fit_file.h"

#include "base/memory.h"
#include "problem/decoder.h"
#include "inversion/inversion.h"
#include "input/target_sanity.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct fit_core, name)
const struct field fit_core_fields[] = {
    {"threshold", FIELD_NUMBER, MEMBER(threshold), .initial = 1e-3, .minimum = 0, .maximum = 1,
     .unit = "", .help = "the bins before the first with a target above this are the hard core"},
    {"stiffness", FIELD_NUMBER, MEMBER(stiffness), .initial = 2000, .minimum = 0,
     .maximum = DBL_MAX, .unit = "k_B T_0 / lambda^2",
     .help = "curvature of the potential in the core"},
    FIELD_END,
};

static enum status read_method(struct fit_file *fit, struct json_object *root) {
    enum { MOST = 16 };
    const char *names[MOST] = {NULL};
    for (size_t k = 0; inverse_methods[k] && k + 1 < MOST; k++)
        names[k] = inverse_methods[k]->name;
    struct json_object object = json_child(root, "method", true);
    if (object.item == NULL)
        return STATUS_OK;
    const char *name = json_choice(&object, "name", names, NULL);
    for (size_t k = 0; name && inverse_methods[k]; k++)
        if (strcmp(inverse_methods[k]->name, name) == 0)
            fit->method = inverse_methods[k];
    if (fit->method == NULL)
        return STATUS_OK;
    fit->method_parameters = memory_zeroed(1, fit->method->parameters_size);
    if (fit->method_parameters == NULL)
        return STATUS_NO_MEMORY;
    for (size_t k = 0; fit->method->tables[k]; k++)
        json_fields(&object, fit->method->tables[k], fit->method_parameters);
    json_finish(&object);
    return STATUS_OK;
}

static const struct field *unknown_fields(enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? inverse_potential_fields : inverse_weight_fields;
}

/// Genes of a curve if the file does not say how many.
static const int64_t genes_of_curve[] = {[INVERSE_CURVE_BEZIER] = 100,
                                         [INVERSE_CURVE_BSPLINE] = 12,
                                         [INVERSE_CURVE_POWER] = INVERSE_PARAMETERS};

/// "fixed": {"exponent": 1}, what is not to be found of a formula.
static void read_fixed(struct unknown_parameters *p, struct json_object *object) {
    struct json_object fixed = json_child(object, "fixed", false);
    json_fields(&fixed, inverse_fixed_fields, p->fixed);
    if (fixed.item == NULL)
        return;
    json_finish(&fixed);
    if (p->shape != INVERSE_CURVE_POWER)
        json_fault(object, "fixed", "only \"curve\": \"power\" has parameters to hold fixed");
    else if (inverse_free_parameters(p->fixed) == 0)
        json_fault(object, "fixed", "with all of its parameters fixed nothing is left to be found");
    const double inner = p->fixed[INVERSE_INNER_CUTOFF];
    if (inner < p->inner_cutoff || inner >= p->cutoff)
        json_fault(&fixed, "inner_cutoff", "%g is not between the weight's cutoffs, %g and %g",
                   inner, p->inner_cutoff, p->cutoff);
}

/// Genes of a formula are its parameters that are not fixed.
static void check_genes(struct unknown_parameters *p, struct json_object *object) {
    const int parameters = inverse_free_parameters(p->fixed);
    if (p->shape != INVERSE_CURVE_POWER || parameters == 0)
        return;
    if (p->genes == 0)
        p->genes = parameters;
    else if (p->genes != parameters)
        json_fault(object, "genes",
                   "the curve \"power\" has %d: sigma, exponent, inner cutoff, less those that "
                   "\"fixed\" holds",
                   parameters);
}

static enum status read_unknown(struct fit_unknown *unknown, enum unknown_kind kind,
                                struct json_object *object, const struct composition *composition,
                                const struct units *units) {
    const struct curve_family *const *laws =
        kind == UNKNOWN_POTENTIAL ? curve_potentials : curve_weights;
    json_fields(object, unknown_fields(kind), &unknown->parameters);
    struct unknown_parameters *p = &unknown->parameters;
    fields_set_defaults(inverse_fixed_fields, p->fixed);
    if (kind == UNKNOWN_WEIGHT)
        read_fixed(p, object);
    check_genes(p, object);
    if (p->genes == 0)
        p->genes = genes_of_curve[p->shape];
    if (object->item == NULL)
        return STATUS_OK;
    if (p->maximum <= p->minimum)
        json_fault(object, "maximum", "%g is not above the minimum %g", p->maximum, p->minimum);
    if (kind == UNKNOWN_WEIGHT && p->cutoff <= p->inner_cutoff)
        json_fault(object, "cutoff", "%g is not above the inner cutoff %g", p->cutoff,
                   p->inner_cutoff);
    TRY(scene_law_read(&unknown->start, object, "start", laws, composition, units));
    TRY(scene_law_read(&unknown->truth, object, "truth", laws, composition, units));
    json_finish(object);
    return STATUS_OK;
}

/// "unknowns": {"potential": {…}, "weight": {…}}; a file without it looks for the potential.
static enum status read_unknowns(struct fit_file *fit, struct json_object *root) {
    struct json_object object = json_child(root, "unknowns", false);
    // A potential for each kind of pairs, one weight for all.
    const struct composition composition[UNKNOWNS] = {
        [UNKNOWN_POTENTIAL] = fit->scene.setup.composition,
        [UNKNOWN_WEIGHT] = composition_of_one(fit->scene.setup.placement.count)};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        struct json_object child = json_child(&object, inverse_unknown_names[kind], false);
        fit->unknown[kind].wanted = child.item != NULL;
        TRY(read_unknown(&fit->unknown[kind], kind, &child, &composition[kind], &fit->scene.units));
    }
    if (object.item) {
        json_finish(&object);
        if (!fit->unknown[UNKNOWN_POTENTIAL].wanted && !fit->unknown[UNKNOWN_WEIGHT].wanted)
            json_fault(root, "unknowns", "needs \"potential\", \"weight\" or both");
    } else {
        fit->unknown[UNKNOWN_POTENTIAL].wanted = true;
    }
    return STATUS_OK;
}

/// The scene leaves out what "unknowns" names.
static enum status read_scene(struct fit_file *fit, struct json_object *root) {
    struct json_object scene = json_child(root, "scene", true);
    if (scene.item == NULL)
        return STATUS_OK;
    int unknown = SCENE_FITS_POTENTIAL;
    if (json_has(root, "unknowns")) {
        struct json_object unknowns = json_child(root, "unknowns", false);
        unknown = (json_has(&unknowns, inverse_unknown_names[0]) ? SCENE_FITS_POTENTIAL : 0) |
                  (json_has(&unknowns, inverse_unknown_names[1]) ? SCENE_FITS_WEIGHT : 0);
    }
    TRY(scene_read(&fit->scene, &scene, unknown));
    json_finish(&scene);
    return STATUS_OK;
}

static enum status read_root(struct fit_file *fit, struct json_object *root) {
    json_fields(root, heading_fields, &fit->heading);
    // Before what its units convert.
    TRY(read_scene(fit, root));
    TRY(targets_read(&fit->targets, root, &fit->scene.setup.box, &fit->scene.setup.composition,
                     &fit->scene.units));
    TRY(read_unknowns(fit, root));
    TRY(read_method(fit, root));
    struct json_object core = json_child(root, "core", false);
    json_fields(&core, fit_core_fields, &fit->core);
    if (core.item)
        json_finish(&core);
    struct json_object verification = json_child(root, "verification", false);
    json_fields(&verification, verify_fields, &fit->verification);
    if (verification.item)
        json_finish(&verification);
    json_finish(root);
    return STATUS_OK;
}

/// Begin one simulation, so that a box too small for the forces or particles without room are found
/// now and not by the verification after the fit.
static enum status try_scene(const struct inverse_problem *problem) {
    enum status status = STATUS_OK;
    struct decoder decoder = {0};
    struct decoder_laws laws = {0};
    struct simulation simulation = {0};
    struct simulation_setup setup = problem->scene;
    double *genes = NULL;
    CHECK(decoder_init(&decoder, problem));
    NEW_ARRAY(genes, decoder.genes);
    CHECK(decoder_start(&decoder, genes));
    CHECK(decoder_laws(&decoder, genes, &laws));
    setup.weight = laws.table[UNKNOWN_WEIGHT];
    CHECK(simulation_init(&simulation, &setup, NULL));
done:
    simulation_clear(&simulation);
    decoder_laws_clear(&laws);
    decoder_clear(&decoder);
    memory_free(genes);
    return status;
}

static enum status check_range(const struct fit_file *fit, const char *file, const char *target,
                               double range) {
    const struct box *box = &fit->scene.setup.box;
    if (box_shortest(box) >= 2 * range)
        return STATUS_OK;
    return status_fail(STATUS_BAD_INPUT,
                       "%s: scene.box: the shortest edge %g is below twice the range of the "
                       "target \"%s\", %g",
                       file, box_shortest(box), target, range);
}

static enum status check_unknowns(const struct fit_file *fit, const char *file) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (fit->unknown[kind].wanted && !fit->method->fits[kind])
            return status_fail(STATUS_BAD_INPUT, "%s: method.name: \"%s\" does not find a %s", file,
                               fit->method->name, inverse_unknown_names[kind]);
    const struct inverse_sampling sampling = fit->method->sampling(fit->method_parameters);
    for (int kind = 0; kind < GOALS && sampling.every == 0; kind++)
        if (kind != GOAL_RDF && kind != GOAL_PRESSURE && goals_ask(&fit->problem.goals, kind))
            return status_fail(
                STATUS_BAD_INPUT,
                "%s: target.%s.fitted: \"%s\" fits g(r) and pressure; \"no\" compares it "
                "with the result",
                file, goals_names[kind], fit->method->name);
    if (fit->unknown[UNKNOWN_POTENTIAL].wanted && !fit->targets.given[GOAL_RDF])
        return status_fail(STATUS_BAD_INPUT, "%s: target.rdf is required to find a potential",
                           file);
    if (fit->unknown[UNKNOWN_POTENTIAL].wanted && !fit->targets.goal[GOAL_RDF].fitted)
        return status_fail(STATUS_BAD_INPUT,
                           "%s: target.rdf.fitted: a potential is found from its g(r)", file);
    return STATUS_OK;
}

static enum status check_bins(const struct fit_file *fit, const char *file) {
    const size_t bins = fit->problem.goals.goal[GOAL_RDF].count;
    if (fit->method->update == NULL || bins <= INVERSION_MOST_BINS)
        return STATUS_OK;
    return status_fail(
        STATUS_BAD_INPUT,
        "%s: target.rdf: an inversion takes %d bins at most, of all pairs, and there "
        "are %zu: join bins, or end the target by \"cutoff\"",
        file, INVERSION_MOST_BINS, bins);
}

static enum status check_steps(const struct fit_file *fit, const char *file) {
    enum status status = targets_check_steps(&fit->targets, fit->scene.setup.time_step);
    if (status != STATUS_OK)
        return status_prefix(status, "%s: scene.time_step", file);
    if (fit->verification.time_step > 0)
        status = targets_check_steps(&fit->targets, fit->verification.time_step);
    return status == STATUS_OK ? STATUS_OK
                               : status_prefix(status, "%s: verification.time_step", file);
}

/// A simulation must be as long as the longest window of what is measured in it.
static enum status check_window(const char *file, const char *key, const struct goals *goals,
                                double time_step, int64_t samples, int64_t every) {
    enum goal_kind longest;
    const int64_t window = observation_window(goals, time_step, &longest);
    if (samples * every >= window)
        return STATUS_OK;
    return status_fail(STATUS_BAD_INPUT,
                       "%s: %s.samples: %lld, one \"every\" %lld steps, are %lld steps, but \"%s\" "
                       "looks at %lld; %lld would do",
                       file, key, (long long)samples, (long long)every,
                       (long long)(samples * every), goals_names[longest], (long long)window,
                       (long long)((window + every - 1) / every));
}

static enum status check_windows(const struct fit_file *fit, const char *file) {
    const struct inverse_sampling sampling = fit->method->sampling(fit->method_parameters);
    const struct verify_parameters *verification = &fit->verification;
    const double time_step = fit->scene.setup.time_step;
    if (sampling.every > 0)
        TRY(check_window(file, "method", &fit->problem.goals, time_step, sampling.samples,
                         sampling.every));
    return check_window(file, "verification", &fit->problem.compared,
                        verification->time_step > 0 ? verification->time_step : time_step,
                        verification->plan.samples, verification->plan.every);
}

/// What only the parts together can get wrong.
static enum status check(const struct fit_file *fit, const char *file) {
    const struct targets *targets = &fit->targets;
    TRY(check_unknowns(fit, file));
    if (targets->given[GOAL_RDF])
        TRY(check_range(fit, file, "rdf", rdf_bins_range(&targets->rdf[0].bins)));
    if (targets->given[GOAL_ETD])
        TRY(check_range(fit, file, "etd", targets->etd.grid.r_maximum));
    if (goals_count(&fit->problem.goals) == 0)
        return status_fail(STATUS_BAD_INPUT, "%s: target: nothing is to be fitted", file);
    TRY(check_bins(fit, file));
    TRY(check_steps(fit, file));
    TRY(check_windows(fit, file));
    if (fit->scene.setup.placement.kind == PLACEMENT_FILE)
        return status_fail(STATUS_BAD_INPUT,
                           "%s: scene.particles.placement: a fit places its particles on a lattice "
                           "or at random",
                           file);
    const enum status status = try_scene(&fit->problem);
    if (status != STATUS_OK)
        return status_prefix(status, "%s: scene", file);
    return target_sanity_check(targets, &fit->scene, file);
}

static void state_problem(struct fit_file *fit, const struct run_options *options) {
    struct inverse_problem *problem = &fit->problem;
    *problem = (struct inverse_problem){
        .scene = fit->scene.setup,
        .core_threshold = fit->core.threshold,
        .core_stiffness = fit->core.stiffness,
        .seed = fit->heading.seed,
        .threads = options->threads,
    };
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct fit_unknown *from = &fit->unknown[kind];
        struct unknown *unknown = &problem->unknown[kind];
        unknown->wanted = from->wanted;
        unknown->parameters = from->parameters;
        for (int pair = 0; pair < composition_pairs(&problem->scene.composition); pair++)
            unknown->start[pair] = scene_law_curve(&from->start, pair);
    }
    targets_goals(&fit->targets, fit->unknown[UNKNOWN_WEIGHT].wanted, &problem->goals,
                  &problem->compared);
}

enum status fit_file_parse(struct fit_file *fit, const char *file,
                           const struct run_options *options) {
    *fit = (struct fit_file){0};
    struct json_document *document;
    TRY(json_open(&document, file));
    struct json_object root = json_root(document);
    enum status status = heading_check_run(&root, file);
    if (status == STATUS_OK)
        status = json_collect_files(document, &fit->inputs);
    if (status == STATUS_OK)
        status = read_root(fit, &root);
    TRY(json_close(document, status));
    if (options->has_seed)
        fit->heading.seed = options->seed;
    state_problem(fit, options);
    return STATUS_OK;
}

enum status fit_file_read(struct fit_file *fit, const char *file,
                          const struct run_options *options) {
    TRY(fit_file_parse(fit, file, options));
    return check(fit, file);
}

void fit_file_clear(struct fit_file *fit) {
    targets_clear(&fit->targets);
    scene_clear(&fit->scene);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        scene_law_clear(&fit->unknown[kind].start);
        scene_law_clear(&fit->unknown[kind].truth);
    }
    memory_free(fit->method_parameters);
    input_files_clear(&fit->inputs);
    *fit = (struct fit_file){0};
}

static void write_fixed(const struct unknown_parameters *p, struct json_writer *writer) {
    if (inverse_free_parameters(p->fixed) == INVERSE_PARAMETERS)
        return;
    json_begin(writer, "fixed");
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        if (!isnan(p->fixed[k]))
            json_put_number(writer, inverse_fixed_fields[k].name, p->fixed[k]);
    json_end(writer);
}

static void write_unknowns(const struct fit_file *fit, struct json_writer *writer) {
    json_begin(writer, "unknowns");
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const struct fit_unknown *unknown = &fit->unknown[kind];
        if (!unknown->wanted)
            continue;
        json_begin(writer, inverse_unknown_names[kind]);
        json_put_fields(writer, unknown_fields(kind), &unknown->parameters);
        write_fixed(&unknown->parameters, writer);
        scene_law_write(&unknown->start, &fit->scene.setup.composition, writer, "start");
        scene_law_write(&unknown->truth, &fit->scene.setup.composition, writer, "truth");
        json_end(writer);
    }
    json_end(writer);
}

enum status fit_file_write(const struct fit_file *fit, const char *path) {
    struct json_writer *writer = json_writer_create();
    json_put_fields(writer, heading_fields, &fit->heading);
    targets_write(&fit->targets, writer);
    write_unknowns(fit, writer);
    json_begin(writer, "scene");
    scene_write(&fit->scene, writer);
    json_end(writer);
    json_begin(writer, "method");
    json_put_text(writer, "name", fit->method->name);
    for (size_t k = 0; fit->method->tables[k]; k++)
        json_put_fields(writer, fit->method->tables[k], fit->method_parameters);
    json_end(writer);
    json_begin(writer, "core");
    json_put_fields(writer, fit_core_fields, &fit->core);
    json_end(writer);
    json_begin(writer, "verification");
    json_put_fields(writer, verify_fields, &fit->verification);
    json_end(writer);
    const enum status status = json_write(writer, path);
    json_writer_free(writer);
    return status;
}
