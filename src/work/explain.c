// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/explain.h"

#include "base/simd.h"
#include "dynamics/hybrid.h"
#include "dynamics/metropolis.h"
#include "observe/hard_theory.h"
#include "scene/scene_doubts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Nanoseconds, as those of observe/stages.h: of a particle and step, also with noise for each
/// (`walk`); of a collision of hard particles with the crossings on the way to it; of a pair in
/// range, whatever is computed of it; `remember`: for each mode of memory; `report`: of its types;
/// of a move of Monte Carlo (`propose`), of its energy (`assess`) and of each neighbour (`meet`),
/// and of what holds a bead in a molecule (`hold`).
static const struct {
    double move, walk, collision, pair, conservative, dissipative, kept, remember, report;
    double propose, assess, meet, hold;
} cost = {.move = 8,
          .walk = 30,
          .propose = 55,
          .assess = 100,
          .meet = 1.7,
          .hold = 100,
          .collision = 600,
          .pair = 0.9,
          .conservative = 0.3,
          .dissipative = 1.3,
          .kept = 3.0,
          .remember = 12,
          .report = 0.7};

/// From event to event: as many collisions as there are of particles of the mean radius and mass.
static void add_events(struct stages *stages, const struct simulation_setup *setup) {
    static const double usual[] = {[ATTRIBUTES_MASS] = 1, [ATTRIBUTES_RADIUS] = 0.5};
    double mean[2];
    for (int name = 0; name < 2; name++)
        mean[name] = mf_attributes_sum(&setup->attribute[name], usual[name], &setup->composition,
                                       setup->placement.count) /
                     (double)setup->placement.count;
    const double capacity = mf_box_volume(&setup->box) / (double)setup->placement.count;
    const double rate = mf_hard_theory(setup->box.dimensions, capacity, setup->temperature,
                                       &mean[ATTRIBUTES_RADIUS], &mean[ATTRIBUTES_MASS], 1)
                            .collision_rate;
    mf_stages_add(stages, "motion", true,
                  cost.move + 0.5 * rate * setup->time_step * cost.collision,
                  "%s, about %.2g collisions of each particle; no list, no forces",
                  setup->integrator->name, rate * setup->time_step);
}

/// Nanoseconds of a move of a bead among so many, `around` of which are near.
static double move_of(double around) {
    return cost.propose + cost.assess + cost.meet * around;
}

double mf_explain_sweep(const struct simulation_setup *setup, double particles, double range) {
    const double reach = range + mf_metropolis_skin(&setup->box, particles);
    return 1e-9 * particles * move_of(2 * mf_stages_pairs_within(setup, reach));
}

double mf_explain_trajectory(const struct simulation_setup *setup, double particles, double range) {
    static const double whole = 5;
    const double of_pair = mf_stages_cost.go_through + cost.pair + cost.conservative +
                           (composition_is_mixed(&setup->composition) ? cost.report : 0);
    double of_bead = cost.move + of_pair * mf_stages_pairs_within(setup, range);
    for (int k = 0; k < setup->interactions; k++)
        of_bead += setup->interaction[k].kind->cost;
    return 1e-9 * whole * particles * HYBRID_STEPS * of_bead;
}

/// Sweeps, and what is computed for a sample besides.
static void add_sweeps(struct stages *stages, const struct simulation_setup *setup, double every) {
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const double cutoff = mf_stages_cutoff(setup), pairs = mf_stages_pairs_within(setup, cutoff);
    const double reach = cutoff + mf_metropolis_skin(&setup->box, (double)setup->placement.count);
    const double around = setup->potential ? 2 * mf_stages_pairs_within(setup, reach) : 0;
    const double energy = setup->potential ? cost.assess + cost.meet * around : 0;
    mf_stages_add(stages, "moves of beads", true,
                  cost.propose + energy + (molecules ? cost.hold : 0),
                  "%s, %.0f neighbours within reach of a move", setup->integrator->name, around);
    if (molecules)
        mf_stages_add(stages, "moves of molecules", true, cost.hold + energy,
                      "one of each in a sweep: shifted, turned, or an arm of it");
    else
        mf_stages_add(stages, "moves of molecules", false, 0, "no molecules");
    mf_stages_add(stages, "list building and forces", true,
                  (mf_stages_cost.sort + (mf_stages_cost.build + mf_stages_cost.go_through +
                                          cost.pair + cost.conservative) *
                                             pairs) /
                      every,
                  "for what is measured, one sweep in %.0f", every);
}

static void add_motion(struct stages *stages, const struct simulation_setup *setup) {
    const bool has_velocities = simulation_has_velocities(setup);
    mf_stages_add(stages, "motion", true, has_velocities ? cost.move : cost.walk,
                  "%s, and a watch over the %s", setup->integrator->name,
                  has_velocities ? "velocities" : "steps");
}

/// λ in the units of the file, and the unit of a length.
static double length_of(const struct stages *stages, char unit[UNITS_NAME_SIZE]) {
    mf_units_suffix(stages->units, "lambda", unit);
    return mf_units_factor(stages->units, "lambda");
}

static void add_list(struct stages *stages, const struct simulation_setup *setup) {
    const struct skin_scene scene = mf_simulation_skin_scene(setup);
    char unit[UNITS_NAME_SIZE];
    const double length = length_of(stages, unit);
    const double cutoff = scene.cutoff;
    const bool given = setup->skin > 0;
    const double skin = given ? setup->skin : mf_skin_choose(&scene);
    const double interval = mf_skin_interval(&scene, skin);
    const double entries = mf_stages_pairs_within(setup, cutoff + skin);
    mf_stages_add(stages, "list building", true,
                  (mf_stages_cost.sort + mf_stages_cost.build * entries) / interval,
                  "every %.1f steps: skin %.2f%s %s", interval, length * skin, unit,
                  given ? "from the scene" : "chosen by time step, temperature and cost");
    mf_stages_add(stages, "going through the list", true, mf_stages_cost.go_through * entries,
                  "%.0f entries a particle, of which %.0f in range", entries,
                  mf_stages_pairs_within(setup, cutoff));
}

static void add_forces(struct stages *stages, const struct simulation_setup *setup) {
    char unit[UNITS_NAME_SIZE];
    const double length = length_of(stages, unit);
    const double cutoff = mf_stages_cutoff(setup), pairs = mf_stages_pairs_within(setup, cutoff);
    mf_stages_add(stages, "distances and forces on particles", true, cost.pair * pairs,
                  "%s, %s precision", mf_simd_name(),
                  setup->precision == PAIR_DOUBLE ? "double" : "mixed");
    const int types = setup->composition.types;
    if (composition_is_mixed(&setup->composition))
        mf_stages_add(stages, "types of beads", true, cost.report * pairs,
                      "%d types: which curve a pair of the %d kinds has", types,
                      mf_composition_pairs(&setup->composition));
    if (setup->potential)
        mf_stages_add(stages, "conservative force", true, cost.conservative * pairs,
                      "a potential with cutoff %.3g%s", length * cutoff, unit);
    else
        mf_stages_add(stages, "conservative force", false, 0, "no potential");
    const bool dissipative = setup->omega != NULL;
    const double reach = dissipative ? setup->omega->cutoff : 0;
    const double near_pairs = mf_stages_pairs_within(setup, fmin(reach, cutoff));
    if (dissipative && setup->integrator->friction)
        mf_stages_add(stages, "friction and noise", true, cost.kept * near_pairs,
                      "a friction weight with cutoff %.3g%s; its pairs are kept for %s",
                      length * reach, unit, setup->integrator->name);
    else if (dissipative)
        mf_stages_add(stages, "friction and noise", true, cost.dissipative * near_pairs,
                      "a friction weight with cutoff %.3g%s; farther pairs skip it", length * reach,
                      unit);
    else
        mf_stages_add(stages, "friction and noise", false, 0,
                      "no friction of pairs: no velocities are read, no random numbers drawn for "
                      "them");
}

static void add_memory(struct stages *stages, const struct simulation_setup *setup) {
    const struct pair_memory_law *law = &setup->memory;
    char unit[UNITS_NAME_SIZE];
    if (!pair_memory_acts(law))
        return;
    const double length = length_of(stages, unit), range = mf_pair_memory_range(law);
    const int passes = law->modes + (law->transverse != NULL);
    mf_stages_add(stages, "friction that remembers", true,
                  cost.remember * passes * mf_stages_pairs_within(setup, range),
                  "%d mode%s of memory%s, of pairs within %.3g%s", law->modes,
                  law->modes == 1 ? "" : "s", law->transverse ? " and friction across pairs" : "",
                  length * range, unit);
}

static void add_interactions(struct stages *stages, const struct simulation_setup *setup) {
    for (int k = 0; k < setup->interactions; k++) {
        const struct interaction *kind = setup->interaction[k].kind;
        mf_stages_add(stages, kind->name, true, kind->cost, "%s", kind->summary);
    }
}

/// What each observable that somebody has asked for costs.
static void add_observables(struct stages *stages, const struct simulation_setup *setup,
                            const struct observable_use *uses, double every) {
    for (size_t k = 0; mf_observables[k]; k++) {
        const struct observable_use *use = uses;
        while (use->observable && use->observable != mf_observables[k])
            use++;
        if (use->observable && use->observable->explain)
            use->observable->explain(use->settings, setup, every, stages);
    }
}

/// Stages count time by the scene's particles; if it has none, by one.
static double counted(const struct simulation_setup *setup) {
    return fmax(1, (double)setup->placement.count);
}

static void add_solvent_particles(struct stages *stages, const struct simulation_setup *setup) {
    const struct integrator *integrator = setup->integrator;
    const double own = integrator->solvent_particles ? integrator->solvent_particles(setup) : 0;
    if (integrator->solvent_particles)
        mf_stages_add(stages, "solvent", true, integrator->solvent_cost * own / counted(setup),
                      "%.0f particles of %s", own, integrator->name);
}

static void print_doubt(void *out, const char *line) {
    fprintf(out, "mesofit: warning: %s\n", line);
}

void mf_explain_doubts(FILE *out, const struct scene *scene) {
    const char *warning = mf_scene_warning(scene);
    if (warning)
        print_doubt(out, warning);
    mf_scene_doubts(scene, &(struct scene_doubts_listener){print_doubt, out});
}

void mf_explain_scale(FILE *out, const struct units *units) {
    char line[UNITS_LINE_SIZE];
    mf_units_print(units, line);
    if (mf_units_are_physical(units))
        fprintf(out, "%s\n", line);
}

void mf_explain_scene(FILE *out, const struct simulation_setup *setup, const struct units *units,
                      const struct observable_use *uses, int64_t every) {
    struct stages stages = {.units = units};
    if (setup->integrator->events) {
        add_events(&stages, setup);
        add_interactions(&stages, setup);
    } else if (setup->integrator->samples) {
        add_sweeps(&stages, setup, (double)every);
    } else {
        add_motion(&stages, setup);
        add_solvent_particles(&stages, setup);
        if (setup->placement.count > 0)
            add_list(&stages, setup);
        add_forces(&stages, setup);
        add_memory(&stages, setup);
        add_interactions(&stages, setup);
    }
    add_observables(&stages, setup, uses, (double)every);
    if (!simulation_holds_temperature(setup) && !setup->integrator->events)
        mf_stages_add(&stages, "thermostat", false, 0, "no thermostat");
    double total = 0;
    for (int k = 0; k < stages.count; k++)
        total += stages.stage[k].nanoseconds;
    const double rate = 1e9 / (total * counted(setup));
    const double digits = pow(10, floor(log10(rate)) - 1);
    fprintf(out, "%.0f particles: about %.4g %s/s with one thread of a processor of 2024\n",
            simulation_moved(setup), digits * round(rate / digits),
            setup->integrator->samples ? "sweeps" : "steps");
    for (int k = 0; k < stages.count; k++) {
        const struct stage *stage = &stages.stage[k];
        const double share = 100 * stage->nanoseconds / total;
        if (stage->on)
            fprintf(out, "  %-34s on   %*.*f %%  %s\n", stage->name, 4, share < 1 ? 1 : 0, share,
                    stage->why);
        else
            fprintf(out, "  %-34s off         %s\n", stage->name, stage->why);
    }
}
