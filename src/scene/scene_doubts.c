// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_doubts.h"

#include "dynamics/usual_step.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

/// Kelvins: below, all but neon, hydrogen and helium are solid; above, molecules come apart.
static const double coldest = 60, hottest = 3000, celsius = 273.15;

/// How many times as long as is usual a step may be without a word. Of the time in which a bead
/// reaches its neighbours a fiftieth is usual, and dissipative particles as in the literature take
/// up to a seventh; Ω Δt of a pair is 1 with five times, and four times make the variance of a bond
/// wrong by 5 %.
static const double times_free = 7.5, times_of_pairs = 5, times_of_bonds = 4;

/// Of atoms, in nm.
static const double shortest_bond = 0.05;

__attribute__((format(printf, 2, 3))) static void tell(const struct scene_doubts_listener *listener,
                                                       const char *format, ...) {
    char line[SCENE_DOUBT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    listener->tell(listener->context, line);
}

struct scene_scales mf_scene_scales(const struct scene *scene) {
    const struct simulation_setup *setup = &scene->setup;
    const double density = (double)setup->placement.count / mf_box_volume(&setup->box);
    const double distance = pow(density, -1.0 / setup->box.dimensions);
    return (struct scene_scales){.distance = distance,
                                 .time = mf_usual_step_crossing(setup, distance)};
}

static void doubt_temperature(const struct scene *scene,
                              const struct scene_doubts_listener *listener) {
    static const double usual = 50; // hardly a multiple of T_0, often a number of kelvins
    const struct units *units = &scene->units;
    const double temperature = scene->setup.temperature, kelvin = temperature * units->temperature;
    if (!mf_units_known(units)) {
        if (temperature > usual)
            tell(listener,
                 "temperature: %g in units of k_B T_0, usually 1; give kelvins in \"units\"",
                 temperature);
        return;
    }
    if (kelvin > 0 && kelvin < coldest)
        tell(listener,
             "temperature: at %g K hardly anything is liquid; it is in kelvins, and %g degrees "
             "Celsius are %.6g",
             kelvin, kelvin, kelvin + celsius);
    else if (kelvin > hottest)
        tell(listener, "temperature: at %g K hardly anything is liquid; it is in kelvins", kelvin);
}

static void doubt_time_step(const struct scene *scene,
                            const struct scene_doubts_listener *listener) {
    const struct simulation_setup *setup = &scene->setup;
    if (setup->integrator->samples || setup->integrator->events)
        return;
    const struct usual_step usual = mf_usual_step_find(setup);
    const double step = setup->time_step, factor = mf_units_factor(&scene->units, "tau");
    char unit[UNITS_NAME_SIZE];
    mf_units_name(&scene->units, "tau", unit);
    const double free = step / (times_free * usual.free),
                 pairs = step / (times_of_pairs * usual.pairs),
                 bonds = step / (times_of_bonds * usual.bonds);
    const double worst = fmax(free, fmax(pairs, bonds));
    if (!(worst > 1))
        return;
    if (worst == free)
        tell(listener,
             "time_step: in %.4g %s a bead moves %.2g of the distance to its neighbours, which no "
             "forces follow; a fiftieth is usual, %.2g %s",
             factor * step, unit, step / mf_scene_scales(scene).time, factor * usual.free, unit);
    else if (worst == pairs)
        tell(listener,
             "time_step: %.4g %s is %.2g times as long as this potential allows if the "
             "configurational temperature is to be right within 1 %%, %.2g %s",
             factor * step, unit, step / usual.pairs, factor * usual.pairs, unit);
    else
        tell(listener,
             "time_step: %.4g %s is %.2g times as long as bonds, angles and dihedrals allow if "
             "their distributions are to be right within 0.3 %% of their variance, %.2g %s",
             factor * step, unit, step / usual.bonds, factor * usual.bonds, unit);
}

static void doubt_length(const struct scene *scene, const char *key, double rest,
                         const struct scene_doubts_listener *listener) {
    const struct units *units = &scene->units;
    const double factor = mf_units_factor(units, "lambda"),
                 distance = mf_scene_scales(scene).distance;
    char unit[UNITS_NAME_SIZE];
    mf_units_name(units, "lambda", unit);
    if (rest > scene_longest_bond * distance)
        tell(listener,
             "%s: a bond of %.4g %s, where beads have a mean distance of %.3g: is it in another "
             "unit of length?",
             key, factor * rest, unit, factor * distance);
    else if (mf_units_known(units) && rest > 0 && rest * units->length < shortest_bond)
        tell(listener,
             "%s: a bond of %.4g %s is shorter than any between atoms: is it in another "
             "unit of length?",
             key, factor * rest, unit);
}

static void doubt_terms(const struct scene *scene, const struct scene_doubts_listener *listener) {
    const struct molecules *molecules = &scene->molecules.molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct bonded_curve *curve = &molecules->group[order][g].curve;
            char key[64];
            if (curve->law == NULL)
                continue;
            snprintf(key, sizeof key, "%s.%s", mf_bonded_kinds[order]->plural,
                     molecules->group[order][g].name);
            const double rest = mf_bonded_rest(curve) / mf_bonded_kinds[order]->scale;
            if (mf_bonded_kinds[order]->is_length)
                doubt_length(scene, key, rest, listener);
            else if (order == BONDED_ANGLE && rest > 0 && rest <= M_PI)
                tell(listener,
                     "%s: an angle of %.4g degrees lets beads overlap: angles are in degrees, and "
                     "%.4g radians are %.4g",
                     key, rest, rest, rest / BONDED_RADIANS);
        }
}

/// The deepest well of any pair type, in units of k_B T.
static double find_well(const struct table *potential, double temperature) {
    enum { PLACES = 500 };
    double least = 0;
    for (int pair = 0; pair < potential->curves; pair++)
        for (int k = 1; k < PLACES; k++) {
            double value;
            mf_table_evaluate_pair(potential, pair, potential->cutoffs[pair] * k / PLACES, &value,
                                   NULL, NULL);
            least = fmin(least, value);
        }
    return -least / temperature;
}

/// The largest force of any pair type at its cutoff, times the cutoff, in units of k_B T.
static double find_end(const struct table *potential, double temperature, double *cutoff) {
    static const double nearly = 1 - 1e-6;
    double most = 0;
    for (int pair = 0; pair < potential->curves; pair++) {
        const double end = potential->cutoffs[pair];
        double slope;
        mf_table_evaluate_pair(potential, pair, nearly * end, NULL, &slope, NULL);
        if (end * fabs(slope) > most) {
            most = end * fabs(slope);
            *cutoff = end;
        }
    }
    return most / temperature;
}

static void doubt_potential(const struct scene *scene,
                            const struct scene_doubts_listener *listener) {
    // Ions of a molten salt have 50, argon at its triple point 1.4, a cold crystal 100.
    static const double deepest = 110, abrupt = 20;
    const struct table *potential = scene->setup.potential;
    const double temperature = scene->setup.temperature;
    const char *const key = scene->known.curves > 0 ? "known" : "conservative";
    double cutoff = 0;
    if (potential == NULL || !(temperature > 0) || scene->many_body.law) // which may repel
        return;
    const double well = find_well(potential, temperature);
    const double end = find_end(potential, temperature, &cutoff);
    char unit[UNITS_NAME_SIZE];
    if (well > deepest)
        tell(listener,
             "%s: a well of %.3g k_B T, which beads hardly ever leave: is its energy in "
             "another unit?",
             key, well);
    if (end > abrupt)
        tell(listener,
             "%s: the force ends abruptly at the cutoff, %.4g%s, where it is still %.2g "
             "k_B T over that length: is the cutoff, or a length, in another unit?",
             key, mf_units_factor(&scene->units, "lambda") * cutoff,
             mf_units_suffix(&scene->units, "lambda", unit), end);
}

void mf_scene_doubts(const struct scene *scene, const struct scene_doubts_listener *listener) {
    doubt_temperature(scene, listener);
    doubt_time_step(scene, listener);
    doubt_terms(scene, listener);
    doubt_potential(scene, listener);
}
