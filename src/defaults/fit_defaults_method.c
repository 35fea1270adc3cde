// SPDX-License-Identifier: GPL-3.0-or-later
//
// How long, how exactly and by what method a fit works that its run file leaves to the program.
#include "defaults/fit_choice.h"
#include "defaults/methods.h"
#include "inversion/inversion.h"
#include "observe/kirkwood_buff.h"
#include "problem/evaluate.h"
#include "system/scaled_system.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// In a gas collisions are rare, and no pair may lose more than a tenth of its velocity a step.
double mf_fit_defaults_sigma(const struct fit_choice *c, double cutoff) {
    static const double strongest = 0.1;
    const double rate = mf_fit_scales_friction(c->rdf, cutoff) / c->mass;
    return sqrt(fmin(1 / (rate * c->crossing), strongest * c->mass / c->time_step));
}

/// A power law: its parameters are few, and its start is one. A steep one needs more at r = 0.
static void choose_power(struct fit_choice *c, const struct fit_place *omega, double largest,
                         double cutoff) {
    static const double steeper = 3;
    const struct unknown_parameters *said = omega->parameters;
    char most[FIT_CHOICE_TEXT_SIZE], to[FIT_CHOICE_TEXT_SIZE];
    largest *= isnan(said->fixed[INVERSE_EXPONENT]) ? steeper : 1;
    mf_fit_choice_note(c,
                       "omega: a power law of 1 - r/(%s), a cutoff that the fit does not change, "
                       "and at r = 0 from 0 to %s",
                       mf_fit_choice_text(c, "lambda", cutoff, to),
                       mf_fit_choice_text(c, "sqrt(mu/tau)", largest, most));
    mf_fit_choice_give(c, omega, "maximum", largest);
}

/// A spline from where pairs begin.
static void choose_spline(struct fit_choice *c, const struct fit_place *omega, double largest,
                          double cutoff) {
    enum { COEFFICIENTS = 8 };
    char most[FIT_CHOICE_TEXT_SIZE], from[FIT_CHOICE_TEXT_SIZE], to[FIT_CHOICE_TEXT_SIZE];
    mf_fit_choice_note(c, "omega: %d coefficients from 0 to %s, between r = %s and %s, %s",
                       COEFFICIENTS, mf_fit_choice_text(c, "sqrt(mu/tau)", largest, most),
                       mf_fit_choice_text(c, "lambda", c->scales.core, from),
                       mf_fit_choice_text(c, "lambda", cutoff, to),
                       "about the end of the second shell");
    mf_fit_choice_give(c, omega, "maximum", largest);
    mf_fit_choice_give(c, omega, "coefficients", COEFFICIENTS);
    mf_fit_choice_give(c, omega, "curve", INVERSE_CURVE_BSPLINE);
}

enum status mf_fit_defaults_omega(struct fit_choice *c) {
    static const double shells = 2, beyond_etd = 1.3, max = 6;
    struct fit_unknown *unknown = &c->fit->unknown[UNKNOWN_OMEGA];
    if (!c->finds[UNKNOWN_OMEGA] || fit_unknown_says(unknown, "cutoff") ||
        fit_unknown_says(unknown, "maximum"))
        return STATUS_OK;
    const struct fit_place omega = {"unknowns.omega", unknown->fields, &unknown->said,
                                    &unknown->given};
    const double cutoff =
        fmin(c->range, fmax(shells * c->scales.shell,
                            beyond_etd * target_files_etd(&c->fit->files)->grid.r_maximum));
    const double sigma = mf_fit_defaults_sigma(c, cutoff);
    mf_fit_choice_give(c, &omega, "cutoff", cutoff);
    mf_fit_choice_give(c, &omega, "inner_cutoff", c->scales.core);
    if (unknown->said.shape == INVERSE_CURVE_POWER)
        choose_power(c, &omega, max * sigma, cutoff);
    else
        choose_spline(c, &omega, max * sigma, cutoff);
    return unknown->start.curves > 0 ? STATUS_OK
                                     : mf_fit_choice_give_omega(c, "unknowns.omega.start", sigma,
                                                                cutoff, &unknown->start);
}

/// By how much larger the noise of g of all pair types is, rms, than that of g of all beads in the
/// same samples: of few beads there are few pairs.
static double find_noise_ratio(const struct composition *composition) {
    double all = 0, sum = 0, pairs = 0;
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++)
        all += mf_composition_possible_pairs(composition, pair);
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        const double own = mf_composition_possible_pairs(composition, pair);
        sum += own > 0 ? all / own : 0;
        pairs += own > 0;
    }
    return pairs > 0 ? sqrt(sum / pairs) : 1;
}

/// Parameters of an inversion of which the file says this one; or NULL.
static const struct inversion_parameters *said(const struct fit_choice *c, const char *key) {
    const uint64_t bit = mf_fields_bit(mf_automatic.tables->fields, key);
    return c->fit->parameters_given & bit ? c->fit->method_parameters : NULL;
}

double mf_fit_defaults_precision(const struct fit_choice *c) {
    const struct inversion_parameters *given = said(c, "precision");
    // Molecules move slowly: a third of the noise would take ten times as long.
    const bool slow = scene_has_molecules(&c->fit->scene.molecules);
    const double min = (slow ? 0.003 : 0.001) * find_noise_ratio(c->rdf->composition);
    static const double max = 0.004;
    // Of single beads more samples than that would make the error of the result smaller by an
    // eighth at most.
    const double part_of_target = slow ? 1 : 0.5;
    return given ? given->precision
                 : fmax(part_of_target * c->scales.noise, fmin(max, fmax(min, c->scales.noise)));
}

/// Molecules are sampled in a smaller system only if that is half of the scene at most: what is
/// saved is equilibration.
static const double worth_it = 0.5;

/// Whether molecules may be sampled in another number. Integrals of Kirkwood and Buff are those of
/// the waves of a box, of which a small one has few.
static bool may_be_fewer(const struct fit_choice *c) {
    return !c->fit->files.given[mf_kirkwood_buff_kind()] &&
           mf_scaled_system_is_alike(c->rdf->composition,
                                     &c->fit->scene.molecules.molecules.topology);
}

/// A system that is large enough for the range, whatever the shape of the box, and in which no
/// molecule meets its own image; 0: that of the scene. States of other densities have other
/// particles in a box of one width.
static double choose_particles(const struct fit_choice *c) {
    static const double min = 700, margin = 2.15, distortion = 0.05;
    const struct inversion_parameters *given = said(c, "particles");
    const bool joined = scene_has_molecules(&c->fit->scene.molecules);
    if (given)
        return (double)given->particles;
    if (c->fit->name[0] || c->fit->engine.kind != ENGINE_NONE)
        return 0;
    const double reach = fit_choice_reach(c);
    const double width = fmax(margin * reach, joined ? reach + mf_fit_longest_molecule(c) : 0);
    const double share = pow(width / mf_box_shortest(&c->fit->scene.setup.box), c->dimensions);
    const double wanted = ceil(fmax(min, share * c->count));
    if (joined && (!may_be_fewer(c) || wanted > worth_it * c->count))
        return 0;
    const struct topology *topology = joined ? &c->fit->scene.molecules.molecules.topology : NULL;
    const int64_t least =
        mf_scaled_system_min(c->rdf->composition, topology, (int64_t)wanted, distortion);
    const struct scaled_system system = mf_scaled_system(c->rdf->composition, topology, least);
    const double particles =
        joined ? (double)mf_composition_particles(&system.composition) : (double)least;
    // One molecule of a kind has its share of hardly any other number.
    return joined && particles > worth_it * c->count ? 0 : particles;
}

enum status mf_fit_defaults_take_method(struct fit_choice *c, const struct inverse_method *method) {
    c->fit->method = method;
    if (c->fit->method_parameters && method->tables->fields == mf_automatic.tables->fields)
        return STATUS_OK; // as far as the file says them
    mf_memory_free(c->fit->method_parameters);
    TRY((c->fit->method_parameters = mf_memory_zeroed(1, method->parameters_size))
            ? STATUS_OK
            : STATUS_NO_MEMORY);
    for (const struct inverse_table *table = method->tables; table->fields; table++)
        mf_fields_set_defaults(table->fields, (char *)c->fit->method_parameters + table->offset);
    return STATUS_OK;
}

static bool has_field(const struct field *fields, const char *name) {
    while (fields->name && strcmp(fields->name, name) != 0)
        fields++;
    return fields->name != NULL;
}

/// Choose a parameter of the method that was taken.
static void give_to_method(struct fit_choice *c, const char *key, double value) {
    uint64_t given = c->fit->parameters_given;
    const struct inverse_table *table = c->fit->method->tables;
    while (!has_field(table->fields, key))
        table++;
    const struct fit_place place = {"method", table->fields,
                                    (char *)c->fit->method_parameters + table->offset, &given};
    mf_fit_choice_give(c, &place, key, value);
}

/// How candidates for ω are simulated: from the last configuration, as long as their targets look.
/// They are not equilibrated for long, since the first of them has settled before
/// (mf_evaluate_settle).
static void choose_rounds(struct fit_choice *c) {
    static const double equilibration = 0.7, apart = 0.1, windows = 1.5, min = 40;
    enum target_kind longest;
    const double window =
        (double)mf_measurement_window(&c->fit->problem.compared, c->time_step, &longest);
    const double free = round(apart * c->crossing / c->time_step);
    const double every = fmax(1, fmin(free, window > 0 ? floor(windows * window / min) : free));
    const double begin = fmax(50, ceil(equilibration * c->crossing / c->time_step));
    give_to_method(c, "equilibration", begin);
    give_to_method(c, "every", every);
    give_to_method(c, "samples", fmax(min, ceil(windows * window / every)));
    give_to_method(c, "precision", 0.1);
    give_to_method(c, "temperature_tolerance", 0.3);
    give_to_method(c, "warm_start", true);
    if (!c->finds[UNKNOWN_POTENTIAL] || c->fit->method == &mf_successive)
        mf_fit_choice_note(
            c,
            "candidates: equilibrated for %.0f steps, from a configuration that is simulated for "
            "%.0f steps at least before, until neither its energy nor its temperature drifts",
            begin, EVALUATE_SETTLE * begin);
}

enum status mf_fit_defaults_method(struct fit_choice *c) {
    const bool simulates = c->finds[UNKNOWN_OMEGA] || c->fit->numbers > 0;
    // Where there is more than the scene knows, nothing but the samples tells how g responds.
    const bool goes_by_samples = c->fit->name[0] || c->fit->engine.input[0];
    const bool both = simulates && c->finds[UNKNOWN_POTENTIAL] && c->fit->numbers == 0;
    const struct inverse_method *method = both              ? &mf_successive
                                          : simulates       ? &mf_gauss_newton
                                          : goes_by_samples ? &mf_imc
                                                            : &mf_automatic;
    const double particles = choose_particles(c);
    TRY(mf_fit_defaults_take_method(c, method));
    if (both || !simulates) {
        char others[64] = "";
        if (particles > 0 && particles != c->count)
            snprintf(others, sizeof others, ", not the %.0f of the scene and of its verification",
                     c->count);
        mf_fit_choice_note(
            c,
            "method \"%s\": it finds the potential from g(r) by samples of %.0f particles%s, until "
            "their g is known within %.2g; the target's is within %.2g",
            method->name, particles > 0 ? particles : c->count, others, c->precision,
            c->scales.noise);
        if (particles > 0)
            give_to_method(c, both ? "potential_particles" : "particles", particles);
        give_to_method(c, both ? "potential_precision" : "precision", c->precision);
    }
    if (!simulates)
        return STATUS_OK;
    mf_fit_choice_note(
        c, "method \"%s\": it finds %s from simulations as long as the targets' windows",
        method->name, c->finds[UNKNOWN_OMEGA] ? "omega" : "what is unknown");
    choose_rounds(c);
    return STATUS_OK;
}

/// How many samples of each replica make the noise of g such a part of what the errors of target
/// and method make. With half of it the rms of g − g* is known within a tenth.
static double samples_for_rdf(const struct fit_choice *c, double replicas, double part) {
    static const double inefficiency = 2;
    const double wanted = part * hypot(c->scales.noise, c->precision);
    const double noise =
        mf_fit_scales_noise_of_sample(c->rdf, &c->fit->scene.setup.box, c->count, c->range);
    return inefficiency * pow(noise / wanted, 2) / replicas;
}

/// How many samples of each replica, so many crossings apart, tell the temperature within a third
/// of a per cent: a bead forgets its velocity in one.
static double samples_for_temperature(const struct fit_choice *c, double replicas, double apart) {
    static const double wanted = 1.0 / 300;
    const double degrees = c->fit->scene.setup.box.dimensions * c->count;
    return 2 / (degrees * wanted * wanted) / (fmin(1, apart) * replicas);
}

/// As exact as is wanted where that costs little; else as exact as is needed, if that may be paid.
static double what_pays(double wanted, double needed, double little, double max) {
    return fmin(wanted, fmax(little, fmin(needed, max)));
}

struct fit_place mf_fit_defaults_verification_place(const struct fit_choice *c) {
    return (struct fit_place){"verification", mf_verify_fields, &c->fit->verification,
                              &c->fit->verification_given};
}

void mf_fit_defaults_verification(struct fit_choice *c) {
    static const double apart = 0.1, equilibration = 10, min = 50, windows = 20;
    static const double max_moves = 3e8, few_moves = 1e8, exact = 0.5, enough = 1;
    const struct fit_place place = mf_fit_defaults_verification_place(c);
    const struct verify_parameters *chosen = &c->fit->verification;
    enum target_kind longest;
    const double time_step = chosen->time_step > 0 ? chosen->time_step : c->time_step;
    mf_fit_choice_give(c, &place, "replicas", 4);
    mf_fit_choice_give(c, &place, "every", fmax(1, round(apart * c->crossing / time_step)));
    const double replicas = (double)chosen->replicas, every = (double)chosen->plan.every;
    const double begin = fmax(1000, ceil(equilibration * c->crossing / time_step));
    const double window =
        (double)mf_measurement_window(&c->fit->problem.compared, time_step, &longest);
    const double sample = replicas * c->count * every;
    const double looks = windows * window / every;
    const bool counted = c->fit->files.given[TARGET_RDF];
    const double counts = counted ? samples_for_rdf(c, replicas, exact) : 0;
    const double wanted = fmax(counts, fmax(min, looks));
    const double needed =
        fmax(counted ? samples_for_rdf(c, replicas, enough) : wanted,
             fmax(looks, samples_for_temperature(c, replicas, every * time_step / c->crossing)));
    const double can = what_pays(wanted, needed, few_moves / sample, max_moves / sample);
    const double samples = ceil(fmax(can, fmax(min, window / every)));
    const char *why = wanted > samples && needed > samples ? "as many as a few minutes allow"
                      : wanted > samples ? "so that the noise of g is no more than that of target "
                                           "and method, and T known within a third of a per cent"
                      : counts == wanted ? "so that the difference of g is known within a tenth "
                                           "of it"
                      : looks == wanted  ? "20 times as long as the targets' windows"
                                         : "the least that gives errors";
    mf_fit_choice_give(c, &place, "equilibration", begin);
    if (!mf_fit_choice_give(c, &place, "samples", samples))
        return;
    mf_fit_choice_note(c, "verification: %.0f simulations of %.0f samples at most, %s", replicas,
                       samples, why);
    if (replicas > 1)
        mf_fit_choice_give(c, &place, "end_early", true);
}
