// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_defaults.h"

#include "defaults/fit_choice.h"
#include "defaults/fit_engine.h"
#include "defaults/fit_unknowns.h"
#include "dynamics/usual_step.h"
#include "inversion/inversions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool lacks_method(const struct fit_file *fit) {
    return fit->method == NULL;
}

static bool says_verification(const struct fit_file *fit, const char *key) {
    return fit->verification_given & mf_fields_bit(mf_verify_fields, key);
}

/// A part of it is enough.
static bool lacks_verification(const struct fit_file *fit) {
    static const char *const keys[] = {"replicas", "equilibration", "every", "samples"};
    bool lacks = false;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        lacks = lacks || !says_verification(fit, keys[k]);
    return lacks;
}

/// Before a fit a time step can be chosen for its target alone: the verification takes it as a
/// first one.
static void choose_shorter_steps(struct fit_choice *c) {
    const struct fit_place verification = mf_fit_defaults_verification_place(c);
    if (!c->fit->scene.given.time_step && !says_verification(c->fit, "time_step") &&
        mf_usual_step_applies(&c->fit->scene.setup))
        mf_fit_choice_give(c, &verification, "shorten_time_step", true);
}

/// Whether nothing would hold the temperature.
static bool lacks_friction(const struct fit_file *fit) {
    const struct scene_given *given = &fit->scene.given;
    return !given->dissipative && !given->transverse && !given->dynamics && !given->memory;
}

static bool leaves_choices(const struct fit_file *fit) {
    return lacks_method(fit) || !fit->scene.given.count || lacks_friction(fit) ||
           !fit->scene.given.time_step || lacks_verification(fit);
}

// The choices -------------------------------------------------------------------------------------

/// Give a key of the target g(r), of a mixture those of each pair type that do not say it.
static bool give_to_pairs(struct fit_choice *c, const char *key, double value) {
    struct target_pairs *rdf = c->fit->files.own[TARGET_RDF];
    bool given = false;
    for (size_t pair = 0; pair < rdf->pairs; pair++) {
        struct target_rdf *member = &rdf->member[pair];
        const struct fit_place place = {"target.rdf", mf_target_rdf_fields, &member->parameters,
                                        &member->given};
        if (rdf->has_g[pair])
            given |= mf_fit_choice_give(c, &place, key, value);
    }
    return given;
}

/// Whether the file says how wide the bins of any pair type are.
static bool says_bins(const struct fit_choice *c) {
    bool says = false;
    for (size_t pair = 0; pair < target_files_rdf(&c->fit->files)->pairs; pair++)
        says = says || target_files_rdf(&c->fit->files)->member[pair].parameters.bin_width > 0;
    return says;
}

/// Rows finer than what g distinguishes are joined: to those of the first state, if there are more.
static enum status choose_bins(struct fit_choice *c, struct fit_scales_rdf *rdf) {
    static const double finest = 0.001, coarsest = 0.004;
    const struct target_files *files = &c->fit->files;
    char text[FIT_CHOICE_TEXT_SIZE];
    if (!files->given[TARGET_RDF] || !c->fit->unknown[UNKNOWN_POTENTIAL].wanted || says_bins(c))
        return STATUS_OK;
    size_t of = mf_fit_scales_joined(rdf, finest, coarsest);
    if (c->leader)
        of = (size_t)fmax(1, round(target_pairs_bins(target_files_rdf(&c->leader->files))->width /
                                   rdf->bins.width));
    if (of < 2)
        return STATUS_OK;
    TRY(mf_fit_scales_rdf_join(rdf, of));
    c->joined = of;
    give_to_pairs(c, "bin_width", rdf->bins.width);
    mf_fit_choice_note(c, "bins of %s: %s", mf_fit_choice_text(c, "lambda", rdf->bins.width, text),
                       c->leader ? "as the first state has them"
                                 : "as wide as they can be with g between them within its noise");
    return STATUS_OK;
}

/// Centre of the last row of a bin of so many rows: where a cutoff leaves all of the bin.
static double last_row(const struct rdf_bins *bins, size_t bin, size_t rows) {
    return mf_rdf_bins_centre(bins, bin) + 0.5 * bins->width * (1 - 1 / (double)rows);
}

/// Distances of the neighbours that a potential reaches at least, as those that Lennard-Jones beads
/// are cut at, 2.5 σ: with less, Φ of a hot liquid bent to 0 too soon, by two of its errors.
static const double min_reach = 2.3;

/// Centre of the last row that is used: where g is seen to differ from its tail, and all of the bin
/// within half of a box that is given and not much too small.
static double find_cutoff(const struct fit_choice *c, const char **why) {
    static const double min_of_box = 0.8;
    const double whole = c->scales.range - 0.5 * c->rdf->bins.width;
    double cutoff = fmin(whole, fmax(c->scales.seen, min_reach * c->scales.neighbour));
    *why = "beyond, g differs from its tail by less than 0.03 or its noise, as it may without "
           "forces there";
    if (c->leader) {
        const struct rdf_bins *bins = target_pairs_bins(target_files_rdf(&c->leader->files));
        *why = "as the first state has it";
        return last_row(bins, bins->count - 1,
                        target_files_rdf(&c->leader->files)->member[0].joined);
    }
    if (c->fit->scene.density > 0) // and no box
        return cutoff;
    const double half = 0.5 * mf_box_shortest(&c->fit->scene.setup.box),
                 last = floor((half - c->rdf->bins.low) / c->rdf->bins.width + 1e-9);
    if (last < 1)
        return cutoff;
    const double within = last_row(&c->rdf->bins, (size_t)last - 1,
                                   c->joined * target_files_rdf(&c->fit->files)->member[0].joined);
    if (within >= cutoff || within < min_of_box * cutoff)
        return cutoff;
    *why = "half of the box";
    return within;
}

static void choose_cutoff(struct fit_choice *c) {
    static const double worth = 0.9;
    const char *why;
    char text[FIT_CHOICE_TEXT_SIZE];
    const double cutoff = find_cutoff(c, &why);
    const bool forced = c->leader || strcmp(why, "half of the box") == 0;
    if (!c->finds[UNKNOWN_POTENTIAL] || (cutoff > worth * c->range && !forced))
        return;
    if (give_to_pairs(c, "cutoff", cutoff))
        c->range = cutoff + 0.5 * c->rdf->bins.width;
    if (c->range < c->scales.range)
        mf_fit_choice_note(c, "cutoff %s: %s", mf_fit_choice_text(c, "lambda", cutoff, text), why);
}

/// A box that is somewhat wider than twice what is looked at, with a thousand beads at least.
static void choose_count(struct fit_choice *c) {
    static const double min = 1000, margin = 2.2;
    struct scene *scene = &c->fit->scene;
    uint64_t given = 0;
    if (scene->given.count)
        return;
    const double range =
        fmax(fit_choice_reach(c), target_files_etd(&c->fit->files)->grid.r_maximum);
    const double needed = c->density * pow(margin * range, c->dimensions);
    c->count = ceil(fmax(min, needed));
    mf_fit_choice_note(
        c, "%.0f particles: %s%s", c->count,
        c->count <= min ? "enough for the statistics, and the box is wider than twice the range"
        : range > c->range && fit_choice_reach(c) == range
            ? "the box is 2.2 times as wide as the known part reaches"
            : "the box is 2.2 times as wide as the range of the targets",
        target_files_rdf(&c->fit->files)->member[0].parameters.particles > 0
            ? ""
            : "; g(r) is taken for that of as many, since its \"particles\" are not given");
    const struct fit_place place = {"scene.particles", mf_placement_count_fields,
                                    &scene->setup.placement, &given};
    scene->given.count = mf_fit_choice_give(c, &place, "count", c->count);
}

/// In the core, where no pair is seen, the potential goes on bending up more than it does where
/// pairs come near, so that none is lost there.
static void choose_core(struct fit_choice *c) {
    static const double steeper = 1.5, min = 2000;
    const double temperature = c->fit->scene.setup.temperature;
    const double stiffness =
        fmax(steeper * c->scales.curvature, min * temperature / pow(c->scales.neighbour, 2));
    const struct fit_place place = {"core", mf_fit_core_fields, &c->fit->core, &c->fit->core_given};
    if (c->finds[UNKNOWN_POTENTIAL])
        mf_fit_choice_give(c, &place, "stiffness", stiffness);
}

/// Whether something is to be fitted that friction decides.
static bool fits_motion(const struct target_files *files) {
    bool fits = false;
    for (int kind = TARGET_ETD; kind <= TARGET_DIFFUSION; kind++)
        fits = fits || (files->given[kind] && files->use[kind].fitted);
    return fits;
}

/// The potential, and ω if what is to be fitted moves and no friction is given.
static void choose_unknowns(struct fit_choice *c) {
    struct fit_file *fit = c->fit;
    struct scene *scene = &fit->scene;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        c->finds[kind] = fit->unknown[kind].wanted;
    if (fit->says_unknowns || !fits_motion(&fit->files) || scene->given.dissipative ||
        scene->given.conservative)
        return;
    mf_fit_choice_note(
        c, "unknowns: the potential and, since targets that move are to be fitted, omega");
    c->finds[UNKNOWN_OMEGA] = true;
    fit->unknown[UNKNOWN_POTENTIAL].wanted = fit->unknown[UNKNOWN_OMEGA].wanted = true;
    scene->unknown |= SCENE_FITS_POTENTIAL | SCENE_FITS_OMEGA;
    mf_fit_friction_take(&fit->unknown[UNKNOWN_OMEGA], (enum fit_friction)fit->friction);
}

/// Friction of any kind, along or across pairs.
static bool finds_friction(const struct fit_choice *c) {
    bool finds = false;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        finds = finds || (unknown_is_omega(kind) && c->finds[kind]);
    return finds;
}

/// It holds the temperature against what the integrator heats, and leaves g(r) as it is.
static enum status choose_friction(struct fit_choice *c) {
    if (finds_friction(c) || !lacks_friction(c->fit))
        return STATUS_OK;
    const double cutoff = c->scales.shell, sigma = mf_fit_defaults_sigma(c, cutoff);
    const double time = c->mass / (mf_fit_scales_friction(c->rdf, cutoff) * sigma * sigma);
    char size[FIT_CHOICE_TEXT_SIZE], end[FIT_CHOICE_TEXT_SIZE], memory[FIT_CHOICE_TEXT_SIZE];
    if (!mf_fit_engine_moves(c->fit))
        mf_fit_choice_note(
            c,
            "friction omega = %s times 1 - r/(%s): up to the end of the first shell, and "
            "a bead forgets its velocity in %s",
            mf_fit_choice_text(c, "sqrt(mu/tau)", sigma, size),
            mf_fit_choice_text(c, "lambda", cutoff, end),
            mf_fit_choice_text(c, "tau", time, memory));
    c->fit->choices.thermostat = true;
    return mf_fit_choice_give_omega(c, "scene.dissipative", sigma, cutoff, &c->fit->scene.omega);
}

static enum status choose_all(struct fit_choice *c) {
    choose_unknowns(c);
    choose_core(c);
    choose_cutoff(c);
    choose_count(c);
    mf_fit_defaults_time_step(c);
    TRY(mf_fit_defaults_omega(c));
    TRY(choose_friction(c));
    TRY(mf_fit_defaults_method(c));
    mf_fit_defaults_verification(c);
    return STATUS_OK;
}

/// Beside a method that the file gives: without friction nothing would hold the temperature.
/// Molecules have many pairs, and are long on their way.
static enum status choose_simulation(struct fit_choice *c) {
    const bool joined = scene_has_molecules(&c->fit->scene.molecules);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        c->finds[kind] = c->fit->unknown[kind].wanted;
    if (joined)
        choose_cutoff(c);
    choose_count(c);
    mf_fit_defaults_time_step(c);
    TRY(choose_friction(c));
    if (joined)
        mf_fit_defaults_verification(c);
    return STATUS_OK;
}

/// Molecules without pairs do not see each other: nothing but their bonds, angles and dihedrals is
/// to be found, and what holds their temperature is Monte Carlo.
static enum status choose_without_pairs(struct fit_choice *c) {
    enum { EQUILIBRATION = 2000, SAMPLES = 200, EVERY = 20 };
    const struct fit_place verification = mf_fit_defaults_verification_place(c);
    mf_fit_choice_note(
        c,
        "method \"%s\": it finds the potentials of bonds, angles and dihedrals from "
        "their distributions; without \"target.rdf\" and \"scene.conservative\" beads "
        "do not act as pairs",
        mf_automatic.name);
    TRY(mf_fit_defaults_take_method(c, &mf_automatic));
    if (lacks_friction(c->fit)) {
        mf_fit_choice_note(c,
                           "dynamics \"%s\" of the verification: nothing else thermostats "
                           "molecules without pair friction",
                           mf_monte_carlo.name);
        c->fit->integrator = &mf_monte_carlo;
    }
    mf_fit_choice_give(c, &verification, "equilibration", EQUILIBRATION);
    mf_fit_choice_give(c, &verification, "samples", SAMPLES);
    mf_fit_choice_give(c, &verification, "every", EVERY);
    return STATUS_OK;
}

enum status mf_fit_defaults_choose(struct fit_file *fit, const struct fit_file *leader) {
    const struct simulation_setup *setup = &fit->scene.setup;
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    const bool all = lacks_method(fit);
    enum status status = STATUS_OK;
    struct fit_scales_rdf rdf = {0};
    struct fit_choice c = {.fit = fit,
                           .leader = leader,
                           .rdf = &rdf,
                           .joined = 1,
                           .dimensions = setup->box.dimensions,
                           .count = (double)setup->placement.count};
    if (!leaves_choices(fit))
        return STATUS_OK;
    choose_shorter_steps(&c);
    CHECK(mf_fit_scales_rdf_init(&rdf, &fit->files, &fit->scene));
    if (rdf.bins.count == 0) { // there are no pairs to choose by
        status = all && fit->problem.bonded + fit->constraints.count > 0 ? choose_without_pairs(&c)
                                                                         : status;
        goto done;
    }
    c.density = rdf.density;
    if (all)
        CHECK(choose_bins(&c, &rdf));
    c.scales = mf_fit_scales_find(&rdf, setup->temperature, fit_scales_little);
    c.mass = masses.maximum > 0 ? masses.minimum : 1;
    c.crossing = mf_usual_step_crossing(setup, c.scales.neighbour);
    c.range = c.scales.range;
    c.precision = mf_fit_defaults_precision(&c);
    CHECK(all ? choose_all(&c) : choose_simulation(&c));
done:
    mf_fit_scales_rdf_clear(&rdf);
    return status;
}
