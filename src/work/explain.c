// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/explain.h"

#include "base/simd.h"

#include <math.h>
#include <stdarg.h>

/// Nanoseconds, measured on Zen 5 with AVX-512 in mixed precision, one thread: of a particle and
/// step, also with noise for each (`walk`), of an entry of the list, of a pair in range; of a
/// particle and sample of the motion, and of each time origin of that; of a pair and sample of the
/// escape times, and of one at an origin; of a pair and sample of the force covariance; `tell`: the
/// types of a pair in range.
static const struct {
    double move, walk, sort, build, go_through, pair, conservative, dissipative, kept, count, flux,
        sum, curvature, tell, gather, correlate, follow, begin, covary;
} cost = {.move = 8,
          .walk = 30,
          .sort = 28,
          .build = 0.9,
          .go_through = 0.7,
          .pair = 0.9,
          .conservative = 0.3,
          .dissipative = 1.3,
          .kept = 3.0,
          .count = 1.0,
          .flux = 5,
          .sum = 0.2,
          .curvature = 8,
          .tell = 0.7,
          .gather = 4,
          .correlate = 1.3,
          .follow = 2.4,
          .begin = 30,
          .covary = 3};

enum { MOST_STAGES = 15 + INTERACTION_MOST };

struct stage {
    const char *name;
    bool on;
    double nanoseconds; ///< of a particle and step
    char why[160];
};

struct plan {
    struct stage stage[MOST_STAGES];
    int count;
};

__attribute__((format(printf, 5, 6))) static void add(struct plan *plan, const char *name, bool on,
                                                      double nanoseconds, const char *format, ...) {
    struct stage *stage = &plan->stage[plan->count++];
    *stage = (struct stage){.name = name, .on = on, .nanoseconds = on ? nanoseconds : 0};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(stage->why, sizeof stage->why, format, arguments);
    va_end(arguments);
}

/// Pairs of a particle nearer than r in a uniform fluid, each pair once.
static double pairs_within(const struct simulation_setup *setup, double r) {
    const double density = (double)setup->placement.count / mf_box_volume(&setup->box);
    return density * mf_box_shell_volume(&setup->box, 0, r) / 2;
}

static void add_list(struct plan *plan, const struct simulation_setup *setup, double cutoff) {
    const struct skin_scene scene = mf_simulation_skin_scene(setup, cutoff);
    const bool given = setup->skin > 0;
    const double skin = given ? setup->skin : mf_skin_choose(&scene);
    const double interval = mf_skin_interval(&scene, skin);
    const double entries = pairs_within(setup, cutoff + skin);
    add(plan, "list building", true, (cost.sort + cost.build * entries) / interval,
        "every %.1f steps: skin %.2f %s", interval, skin,
        given ? "from the scene" : "chosen by time step, temperature and cost");
    add(plan, "going through the list", true, cost.go_through * entries,
        "%.0f entries a particle, of which %.0f in range", entries, pairs_within(setup, cutoff));
}

static void add_forces(struct plan *plan, const struct simulation_setup *setup,
                       const struct explain_measured *measured) {
    const double cutoff = measured->cutoff, pairs = pairs_within(setup, cutoff);
    add(plan, "distances and forces on particles", true, cost.pair * pairs, "%s, %s precision",
        mf_simd_name(), setup->precision == PAIR_DOUBLE ? "double" : "mixed");
    const int types = setup->composition.types;
    if (composition_is_mixed(&setup->composition))
        add(plan, "types of beads", true, cost.tell * pairs,
            "%d types: which curve a pair of the %d kinds has", types,
            mf_composition_pairs(&setup->composition));
    if (measured->has_potential)
        add(plan, "conservative force", true, cost.conservative * pairs,
            "a potential with cutoff %.3g", cutoff);
    else
        add(plan, "conservative force", false, 0, "no potential");
    const bool dissipative = setup->omega != NULL;
    const double reach = dissipative ? setup->omega->cutoff : 0;
    const double near_pairs = pairs_within(setup, fmin(reach, cutoff));
    if (dissipative && setup->integrator->friction)
        add(plan, "friction and noise", true, cost.kept * near_pairs,
            "a friction weight with cutoff %.3g; its pairs are kept for %s", reach,
            setup->integrator->name);
    else if (dissipative)
        add(plan, "friction and noise", true, cost.dissipative * near_pairs,
            "a friction weight with cutoff %.3g; farther pairs skip it", reach);
    else
        add(plan, "friction and noise", false, 0,
            "no friction of pairs: no velocities are read, no random numbers drawn for them");
}

static void add_interactions(struct plan *plan, const struct simulation_setup *setup) {
    for (int k = 0; k < setup->interactions; k++) {
        const struct interaction *kind = setup->interaction[k].kind;
        add(plan, kind->name, true, kind->cost, "%s", kind->summary);
    }
}

static void add_samples(struct plan *plan, const struct simulation_setup *setup,
                        const struct explain_measured *measured) {
    const double every = (double)measured->every, pairs = pairs_within(setup, measured->cutoff);
    const double farther = pairs_within(setup, measured->rdf_range);
    if (measured->rdf_range <= 0)
        add(plan, "g(r)", false, 0, "not asked for");
    else if (measured->rdf_force_alone)
        add(plan, "g(r)", false, 0, "from forces; counted if a potential keeps no pair apart");
    else if (measured->rdf_range <= measured->cutoff * (1 + 1e-9))
        add(plan, "g(r)", true, cost.count * pairs / every, "counted in %s of one step in %.0f",
            setup->integrator->forces_midway ? "a pass at the end" : "the force pass", every);
    else
        add(plan, "g(r)", true, (cost.sort + (cost.build + cost.count) * farther) / every,
            "to %.3g, beyond the forces: a list of its own, one step in %.0f", measured->rdf_range,
            every);
    if (measured->rdf_force)
        add(plan, "g(r) from forces", true, cost.flux * fmax(pairs, farther) / every,
            "one step in %.0f: the forces without friction and noise, then all pairs", every);
    if (measured->force_covariance)
        add(plan, "force covariance", true, cost.covary * pairs / every, "one step in %.0f", every);
    if (measured->sums) {
        add(plan, "energy, virial, temperature", true, (cost.sum * pairs + 2) / every,
            "one step in %.0f", every);
        add(plan, "configurational temperature", true, cost.curvature * pairs / every,
            "one step in %.0f, in double precision", every);
    } else {
        add(plan, "energy, virial, temperature", false, 0, "not asked for");
        add(plan, "configurational temperature", false, 0, "not asked for");
    }
}

static void add_motion(struct plan *plan, const struct motion_plan *motion) {
    if (motion == NULL) {
        add(plan, "diffusion", false, 0, "not asked for");
        return;
    }
    const double every = (double)motion->every;
    const double origins = (double)motion->lags / (double)motion->origin_every + 1;
    add(plan, "diffusion", true, (cost.gather + cost.correlate * origins) / every,
        "%.0f time origins, one step in %.0f", origins, every);
}

static void add_etd(struct plan *plan, const struct simulation_setup *setup,
                    const struct explain_measured *measured) {
    const struct etd_grid *grid = measured->etd_grid;
    if (grid == NULL) {
        add(plan, "escape times", false, 0, "not asked for");
        return;
    }
    const double every = (double)measured->etd_plan->every;
    const double origin_every = (double)measured->etd_plan->origin_every;
    const double pairs = pairs_within(setup, grid->r_maximum);
    const double listed = pairs_within(setup, fmax(grid->r_maximum, measured->cutoff));
    const double origin = (cost.begin * pairs + cost.go_through * listed) / origin_every;
    add(plan, "escape times", true, (cost.gather + cost.follow * pairs + origin) / every,
        "%.0f pairs a particle within %g, one step in %.0f; an origin in %.0f", pairs,
        grid->r_maximum, every, origin_every * every);
}

void mf_explain_scene(FILE *out, const struct simulation_setup *setup,
                      const struct explain_measured *measured) {
    struct plan plan = {0};
    const bool flies = !simulation_is_overdamped(setup);
    add(&plan, "motion", true, flies ? cost.move : cost.walk, "%s, and a watch over the %s",
        setup->integrator->name, flies ? "velocities" : "steps");
    add_list(&plan, setup, measured->cutoff);
    add_forces(&plan, setup, measured);
    add_interactions(&plan, setup);
    add_samples(&plan, setup, measured);
    add_motion(&plan, measured->motion);
    add_etd(&plan, setup, measured);
    double total = 0;
    for (int k = 0; k < plan.count; k++)
        total += plan.stage[k].nanoseconds;
    const double rate = 1e9 / (total * (double)setup->placement.count);
    const double digits = pow(10, floor(log10(rate)) - 1);
    fprintf(out, "%lld particles: about %.4g steps/s with one thread of a processor of 2024\n",
            (long long)setup->placement.count, digits * round(rate / digits));
    for (int k = 0; k < plan.count; k++) {
        const struct stage *stage = &plan.stage[k];
        const double share = 100 * stage->nanoseconds / total;
        if (stage->on)
            fprintf(out, "  %-34s on   %*.*f %%  %s\n", stage->name, 4, share < 1 ? 1 : 0, share,
                    stage->why);
        else
            fprintf(out, "  %-34s off         %s\n", stage->name, stage->why);
    }
}
