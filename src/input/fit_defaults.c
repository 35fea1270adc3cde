// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/fit_defaults.h"

#include "curves/formula.h"
#include "input/fit_scales.h"
#include "inversion/inversion.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// What is known when something is to be chosen, in the order of the choices.
struct choice {
    const struct fit_file *read;
    struct json_object *root;
    struct fit_choices *said;
    struct fit_scales scales;
    int dimensions;
    double density, temperature;
    double crossing;  ///< time in which a bead moves as far as its neighbours are [τ]
    double range;     ///< of g(r) as it will be used [λ]
    double count;     ///< beads of a simulation
    double time_step; ///< [τ]
    double precision; ///< of the method, of g
};

__attribute__((format(printf, 2, 3))) static void say(struct choice *c, const char *format, ...) {
    va_list arguments;
    if (c->said->count == FIT_MOST_CHOICES)
        return;
    va_start(arguments, format);
    vsnprintf(c->said->line[c->said->count++], FIT_CHOICE_SIZE, format, arguments);
    va_end(arguments);
}

/// The object at a path as "scene.particles", without the reader learning of the keys.
static struct json_object object_at(const struct json_object *root, const char *path) {
    char name[JSON_PATH_SIZE], *rest;
    struct json_object object = *root;
    snprintf(name, sizeof name, "%s", path);
    for (char *key = strtok_r(name, ".", &rest); key; key = strtok_r(NULL, ".", &rest)) {
        struct json_object child = mf_json_child(&object, key, false);
        child.asked_count = 0;
        object = child;
    }
    return object;
}

static bool lacks(const struct json_object *root, const char *path, const char *key) {
    struct json_object object = object_at(root, path);
    return !mf_json_has(&object, key);
}

/// A writer inside the objects of a path.
static struct json_writer *writer_at(const char *path) {
    char name[JSON_PATH_SIZE], *rest;
    struct json_writer *writer = mf_json_writer_create();
    snprintf(name, sizeof name, "%s", path);
    for (char *key = strtok_r(name, ".", &rest); writer && key; key = strtok_r(NULL, ".", &rest))
        mf_json_begin(writer, key);
    return writer;
}

static enum status put_in(struct json_writer *writer, const struct json_object *root) {
    const enum status status = writer ? mf_json_write_into(writer, root) : STATUS_NO_MEMORY;
    mf_json_writer_free(writer);
    return status;
}

static enum status give_text(const struct json_object *root, const char *path, const char *key,
                             const char *text) {
    struct json_writer *writer = writer_at(path);
    if (writer)
        mf_json_put_text(writer, key, text);
    return put_in(writer, root);
}

/// A number or whole number of a field table, in its type.
static enum status give(const struct json_object *root, const char *path,
                        const struct field *fields, const char *key, double value) {
    struct json_writer *writer = writer_at(path);
    struct field own[2] = {{.name = key}, FIELD_END};
    while (strcmp(fields->name, key) != 0)
        fields++;
    own[0] = *fields;
    own[0].offset = 0;
    const int64_t whole = (int64_t)value;
    if (writer)
        mf_json_put_fields(writer, own,
                           own->type == FIELD_INTEGER ? (const void *)&whole : (void *)&value);
    return put_in(writer, root);
}

bool mf_fit_defaults_wanted(const struct json_object *root) {
    return root->item && lacks(root, "", "method");
}

enum status mf_fit_defaults_make_readable(struct json_object *root) {
    enum { ANY_COUNT = 1000 };
    TRY(give_text(root, "method", "name", mf_automatic.name));
    if (lacks(root, "scene", "density") || !lacks(root, "scene.particles", "types"))
        return STATUS_OK;
    return give(root, "scene.particles", mf_placement_count_fields, "count", ANY_COUNT);
}

// The choices -------------------------------------------------------------------------------------

/// Where g is seen to differ from 1, and within half of a box that is given.
static enum status choose_cutoff(struct choice *c) {
    static const double beyond = 1.1, worth = 0.9, least_of_box = 0.8;
    const double half = lacks(c->root, "scene", "box")
                            ? INFINITY
                            : 0.5 * mf_box_shortest(&c->read->scene.setup.box);
    double cutoff = fmax(beyond * c->scales.seen, 2 * c->scales.neighbour);
    const char *why = "beyond, g - 1 is within its noise";
    if (cutoff > half && half > least_of_box * c->scales.range) {
        cutoff = half;
        why = "half of the box";
    }
    c->range = c->scales.range;
    if (cutoff >= worth * c->scales.range && !(cutoff == half && cutoff < c->scales.range))
        return STATUS_OK;
    struct json_object rdf = object_at(c->root, "target.rdf");
    const struct composition *composition = &c->read->scene.setup.composition;
    const char *key;
    if (!composition_is_mixed(composition) && lacks(c->root, "target.rdf", "cutoff")) {
        TRY(give(c->root, "target.rdf", mf_target_rdf_fields, "cutoff", cutoff));
        c->range = cutoff;
    }
    for (size_t n = 0; composition_is_mixed(composition) && (key = mf_json_key(&rdf, n)); n++) {
        char path[JSON_PATH_SIZE];
        snprintf(path, sizeof path, "target.rdf.%.64s", key);
        if (mf_composition_find_pair(composition, key) < 0 || !lacks(c->root, path, "cutoff"))
            continue;
        TRY(give(c->root, path, mf_target_rdf_fields, "cutoff", cutoff));
        c->range = cutoff;
    }
    if (c->range == cutoff)
        say(c, "cutoff %.4g: %s", cutoff, why);
    return STATUS_OK;
}

/// A box that is somewhat wider than twice what is looked at, with a thousand beads at least.
static enum status choose_count(struct choice *c) {
    static const double least = 1000, margin = 2.2;
    if (lacks(c->root, "scene", "density") || !lacks(c->root, "scene.particles", "count") ||
        !lacks(c->root, "scene.particles", "types"))
        return STATUS_OK;
    const double range = fmax(c->range, c->read->files.etd.grid.r_maximum);
    const double needed = c->density * pow(margin * range, c->dimensions);
    c->count = ceil(fmax(least, needed));
    say(c, "%.0f particles: %s", c->count,
        c->count > least ? "the box is 2.2 times as wide as the range of the targets"
                         : "enough for the statistics, and the box is wider than twice the range");
    return give(c->root, "scene.particles", mf_placement_count_fields, "count", c->count);
}

/// The next lower of 1, 1.2, 1.5, 2, … times a power of 10.
static double round_down(double value) {
    static const double steps[] = {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8};
    const double power = pow(10, floor(log10(value) + 1e-9));
    double rounded = power;
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        if (steps[k] * power <= value * (1 + 1e-9))
            rounded = steps[k] * power;
    return rounded;
}

/// A whole fraction of the interval of targets at times, if there are any.
static double fit_interval(const struct choice *c, double time_step) {
    const struct target_files *files = &c->read->files;
    const double interval = files->given[TARGET_ETD]    ? files->etd.interval
                            : files->given[TARGET_VACF] ? files->curve[TARGET_VACF].interval
                            : files->given[TARGET_MSD]  ? files->curve[TARGET_MSD].interval
                                                        : 0;
    return interval > 0 ? interval / ceil(interval / time_step - 1e-9) : round_down(time_step);
}

/// Integrators of Verlet's kind give an oscillator of angular frequency Ω the configurational
/// temperature T/(1 − (Ω Δt)²/4). Two beads oscillate with Ω² = 2 Φ''/m, and Φ is at most as steep
/// as −k_B T ln g where pairs come near. What flies free moves a fiftieth of the way to its
/// neighbours.
static enum status choose_time_step(struct choice *c) {
    static const double allowed = 0.01, way = 0.02;
    const double free = way * c->crossing;
    const double bound = sqrt(4 * allowed / (2 * c->scales.curvature));
    if (!lacks(c->root, "scene", "time_step")) {
        c->time_step = c->read->scene.setup.time_step;
        return STATUS_OK;
    }
    c->time_step = fit_interval(c, fmin(free, bound));
    if (bound < free)
        say(c,
            "time step %.4g: the curvature of -k_B T ln g is up to %.3g k_B T_0/lambda^2, at "
            "%.3g lambda, and the configurational temperature is to be right within 1 %%",
            c->time_step, c->scales.curvature, c->scales.curvature_at);
    else
        say(c, "time step %.4g: beads move a fiftieth of the way to their neighbours in it",
            c->time_step);
    return give(c->root, "scene", mf_scene_fields, "time_step", c->time_step);
}

/// Friction between neighbours that takes a bead's velocity in the time in which it would reach
/// them: it holds the temperature against what the integrator heats, and leaves g(r) as it is.
static enum status choose_friction(struct choice *c) {
    static const double strongest = 0.1;
    const struct simulation_setup *setup = &c->read->scene.setup;
    if (!lacks(c->root, "scene", "dissipative") || !lacks(c->root, "scene", "dynamics") ||
        setup->attribute[ATTRIBUTES_MASS].ranges > 0)
        return STATUS_OK;
    const double cutoff = c->scales.shell;
    const double rate = mf_fit_scales_friction(&c->read->files, c->density, c->dimensions, cutoff);
    // In a gas collisions are rare, and no pair may lose more than a tenth of its velocity a step.
    const double sigma = sqrt(fmin(1 / (rate * c->crossing), strongest / c->time_step));
    const struct field *fields = mf_formula_power_omega.fields;
    say(c,
        "friction omega = %.3g (1 - r/%.3g): up to the end of the first shell, and a bead forgets "
        "its velocity in %.2g tau",
        sigma, cutoff, 1 / (rate * sigma * sigma));
    TRY(give_text(c->root, "scene.dissipative", "law", mf_formula_power_omega.name));
    TRY(give(c->root, "scene.dissipative", fields, "sigma", sigma));
    return give(c->root, "scene.dissipative", fields, "cutoff", cutoff);
}

/// `auto`, as exact as the target is, in a system that is large enough for the range.
static enum status choose_method(struct choice *c) {
    static const double least_precision = 0.001, most_precision = 0.004;
    static const double least = 700, margin = 2.1;
    const double particles =
        fmin(c->count, ceil(fmax(least, c->density * pow(margin * c->range, c->dimensions))));
    c->precision = fmin(most_precision, fmax(least_precision, c->scales.noise));
    say(c,
        "method \"%s\": it finds a potential from g(r); %.0f particles, until g is known within "
        "%.2g, as the target is (%.2g)",
        mf_automatic.name, particles, c->precision, c->scales.noise);
    TRY(give_text(c->root, "method", "name", mf_automatic.name));
    TRY(give(c->root, "method", mf_inversion_fields, "particles", particles));
    return give(c->root, "method", mf_inversion_fields, "precision", c->precision);
}

/// rms of the errors of g that one sample leaves, if pairs are independent.
static double noise_of_sample(const struct choice *c) {
    const struct target_files *files = &c->read->files;
    const struct rdf_bins *bins = &files->rdf[0].bins;
    const struct composition *composition = &files->composition;
    const struct box *box = &c->read->scene.setup.box;
    const double larger = c->count / (double)mf_composition_particles(composition);
    double squares = 0, count = 0;
    for (size_t pair = 0; pair < files->pairs; pair++)
        for (size_t k = 0; k < bins->count && mf_rdf_bins_edge(bins, k + 1) <= c->range; k++) {
            const double g = files->rdf_g[pair * bins->count + k];
            const double ideal =
                larger * mf_rdf_ideal_pairs_of(bins, k, box, composition, (int)pair);
            squares += ideal > 0 ? g / ideal : 0;
            count++;
        }
    return sqrt(squares / fmax(1, count));
}

/// So long that the rms of g − g* is known within a tenth: its noise is half of what the errors of
/// target and method make.
static enum status choose_verification(struct choice *c) {
    static const double apart = 0.1, equilibration = 10, part = 0.5;
    static const double inefficiency = 2, least = 50, most_moves = 3e8;
    enum { REPLICAS = 4 };
    const char *path = "verification";
    enum target_kind longest;
    const double every = fmax(1, round(apart * c->crossing / c->time_step));
    const double begin = fmax(1000, ceil(equilibration * c->crossing / c->time_step));
    const double wanted = part * hypot(c->scales.noise, c->precision);
    const double window =
        (double)mf_measurement_window(&c->read->problem.compared, c->time_step, &longest);
    double samples = ceil(inefficiency * pow(noise_of_sample(c) / wanted, 2) / REPLICAS);
    samples = fmin(samples, most_moves / (REPLICAS * c->count * every));
    samples = ceil(fmax(samples, fmax(least, window / every)));
    if (lacks(c->root, "", path))
        say(c,
            "verification: %d simulations of %.0f samples, so that the difference of g is known "
            "within a tenth of it",
            REPLICAS, samples);
    TRY(give(c->root, path, mf_verify_fields, "replicas", REPLICAS));
    TRY(give(c->root, path, mf_verify_fields, "equilibration", begin));
    TRY(give(c->root, path, mf_verify_fields, "every", every));
    return give(c->root, path, mf_verify_fields, "samples", samples);
}

enum status mf_fit_defaults_choose(const struct fit_file *read, struct json_object *root,
                                   struct fit_choices *choices) {
    static enum status (*const steps[])(struct choice *) = {
        choose_cutoff,   choose_count,  choose_time_step,
        choose_friction, choose_method, choose_verification,
    };
    const struct simulation_setup *setup = &read->scene.setup;
    struct choice c = {.read = read,
                       .root = root,
                       .said = choices,
                       .dimensions = setup->box.dimensions,
                       .temperature = setup->temperature,
                       .count = (double)setup->placement.count};
    c.density = c.count / mf_box_volume(&setup->box);
    c.scales = mf_fit_scales_find(&read->files, c.density, c.temperature, c.dimensions);
    c.crossing = c.scales.neighbour / sqrt(c.temperature);
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        TRY(steps[k](&c));
    return STATUS_OK;
}
