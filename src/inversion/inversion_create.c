// SPDX-License-Identifier: GPL-3.0-or-later
//
// What an inversion is made of: its parameters, its system, its memory.
#include "inversion/inversion.h"
#include "inversion/inversion_coarse.h"

#include <math.h>
#include <string.h>

static const char *const starts[] = {"auto", "mean-force", NULL};

#define MEMBER(name) .offset = offsetof(struct inversion_parameters, name)
const struct field mf_inversion_fields[] = {
    {"particles", FIELD_INTEGER, MEMBER(particles), .initial = 0, .minimum = 0, .maximum = 1e7,
     .unit = "", .help = "of the Monte Carlo system, at the scene's density; 0 means the scene's"},
    {"sampler", FIELD_CHOICE, MEMBER(sampler), .choices = mf_sampler_kinds, .initial = SAMPLER_AUTO,
     .unit = "",
     .help = "Metropolis moves of beads and molecules, or short trajectories of all particles "
             "(hybrid Monte Carlo); auto: moves of single beads, trajectories of molecules"},
    {"replicas", FIELD_INTEGER, MEMBER(replicas), .initial = 8, .minimum = 2,
     .maximum = REPLICAS_MOST, .unit = "", .help = "independent samplers"},
    {"equilibration", FIELD_INTEGER, MEMBER(equilibration), .initial = 200, .minimum = 0,
     .maximum = 8e8, .unit = "sweeps",
     .help = "before each iteration's samples, at least; five times as many where replicas begin "
             "anew, and more until the samples have settled"},
    {"samples", FIELD_INTEGER, MEMBER(samples), .initial = 200, .minimum = 2 * REPLICAS_BLOCKS,
     .maximum = 1e9, .unit = "",
     .help = "of each replica, at least; doubled until the noise is a third of the error, or as "
             "small as \"precision\""},
    {"every", FIELD_INTEGER, MEMBER(every), .initial = 2, .minimum = 1, .maximum = 1e6,
     .unit = "sweeps", .help = "between samples, at least"},
    {"iterations", FIELD_INTEGER, MEMBER(iterations), .initial = 30, .minimum = 1, .maximum = 10000,
     .unit = "", .help = "at most"},
    {"precision", FIELD_NUMBER, MEMBER(precision), .initial = 0.004, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "",
     .help =
         "statistical error of g, rms over bins, at which an agreement is believed; half of its "
         "target's is enough"},
    {"start", FIELD_CHOICE, MEMBER(start), .choices = starts, .initial = INVERSION_FROM_HNC,
     .unit = "",
     .help = "without unknowns.potential.start: the hypernetted-chain inversion, and -k_B T ln g "
             "where that leads nowhere or in two dimensions; mean-force: -k_B T ln g"},
    FIELD_END,
};

void mf_inversion_destroy(void *memory) {
    struct inversion *inversion = memory;
    mf_replicas_clear(&inversion->replicas);
    mf_table_clear(&inversion->table);
    mf_potential_grid_molecules_clear(&inversion->grid, &inversion->molecules);
    mf_potential_grid_clear(&inversion->grid);
    mf_inversion_band_clear(&inversion->band);
    mf_inversion_basis_clear(&inversion->basis);
    mf_inversion_basis_clear(&inversion->coarse);
    mf_inversion_trail_clear(&inversion->trail);
    mf_inversion_kirkwood_buff_clear(&inversion->kirkwood_buff);
    mf_inversion_rows_clear(&inversion->rows);
    mf_inversion_response_clear(&inversion->response);
    mf_inversion_rows_clear(&inversion->doubted);
    mf_memory_free(inversion->shape);
    mf_memory_free(inversion->smoothness);
    mf_memory_free(inversion->groups);
    mf_memory_free(inversion->doubt);
    double *arrays[] = {
        inversion->ideal,           inversion->unit,        inversion->target_counts,
        inversion->target_error,    inversion->least,       inversion->excess,
        inversion->variance,        inversion->common,      inversion->covariance,
        inversion->pressure.slope,  inversion->phi,         inversion->step,
        inversion->other_step,      inversion->best,        inversion->best_step,
        inversion->best_other,      inversion->best_counts, inversion->pooled,
        inversion->pooled_variance, inversion->pooled_phi};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        mf_memory_free(arrays[k]);
}

static enum status allocate(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const size_t bins = inversion->bins, points = inversion->grid.points;
    const size_t known = inversion->grid.known;
    NEW_ARRAY(inversion->shape, inversion->grid.blocks);
    NEW_ARRAY(inversion->groups, inversion->grid.groups);
    NEW_ARRAY(inversion->ideal, bins);
    NEW_ARRAY(inversion->unit, bins);
    NEW_ARRAY(inversion->target_counts, bins);
    NEW_ARRAY(inversion->target_error, bins);
    NEW_ARRAY(inversion->least, bins);
    NEW_ARRAY(inversion->excess, known);
    NEW_ARRAY(inversion->variance, known);
    NEW_ARRAY(inversion->common, known);
    NEW_ARRAY(inversion->covariance, known * known);
    NEW_ARRAY(inversion->pooled, known);
    NEW_ARRAY(inversion->pooled_variance, known);
    NEW_ARRAY(inversion->pooled_phi, points);
    if (inversion->grid.groups > 0)
        NEW_ARRAY(inversion->doubt, known);
    NEW_ARRAY(inversion->pressure.slope, known);
    NEW_ARRAY(inversion->phi, points);
    NEW_ARRAY(inversion->step, points);
    NEW_ARRAY(inversion->other_step, points);
    NEW_ARRAY(inversion->best, points);
    NEW_ARRAY(inversion->best_step, points);
    NEW_ARRAY(inversion->best_other, points);
    NEW_ARRAY(inversion->best_counts, bins);
    CHECK(mf_inversion_band_init(&inversion->band, known, points));
    CHECK(mf_inversion_response_init(inversion));
    CHECK(mf_inversion_trail_init(&inversion->trail, (size_t)inversion->settings.common.iterations,
                                  bins));
done:
    return status;
}

/// By which the share of a type may change with the number of particles: rare types are rounded,
/// and keep two beads.
static const double most_distortion = 0.2;

/// As many particles as are asked for, at the densities of the scene.
static enum status choose_size(struct inversion *inversion) {
    const struct simulation_setup *scene = &inversion->problem->scene;
    const int64_t wanted = inversion->settings.common.particles;
    const int64_t count = mf_composition_particles(&scene->composition);
    if (wanted > 0 && wanted != count && mf_molecules_find(scene->interaction, scene->interactions))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.particles: molecules are sampled in the scene's box, with "
                              "all of its %lld beads; leave it out",
                              (long long)count);
    inversion->composition =
        wanted > 0 ? mf_composition_scaled(&scene->composition, wanted) : scene->composition;
    inversion->box =
        mf_box_scaled(&scene->box, (double)mf_composition_particles(&inversion->composition) /
                                       (double)mf_composition_particles(&scene->composition));
    const double distortion =
        mf_composition_distortion(&scene->composition, &inversion->composition);
    if (distortion <= most_distortion)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "method.particles: %lld change the share of a type by %.0f %%; %lld are the "
        "next that keep all shares",
        (long long)wanted, 100 * distortion,
        (long long)mf_composition_least_particles(&scene->composition, wanted, most_distortion));
}

/// No potential of pairs empties a shell in the midst of a liquid: an empty bin beyond one that is
/// well known is a fault of the target, and what would be made of it a barrier without an end.
static enum status refuse_holes(const struct inversion *inversion) {
    static const double well = 0.1;
    const struct inverse_problem *problem = inversion->problem;
    const struct potential_grid *grid = &inversion->grid;
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const size_t bin = grid->known_bin[n], next = grid->known_bin[n] + 1;
        const double *g = problem->targets.target[TARGET_RDF].value;
        if (next % grid->bins == 0 || !(g[bin] > well) || g[next] > problem->core_threshold)
            continue;
        const double r = mf_rdf_bins_centre(&problem->targets.bins, next % grid->bins);
        char kind[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&problem->scene.composition, (int)(bin / grid->bins), kind);
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s%sthe target is empty at r = %g, where the bin before it has g = %.3g: no "
            "potential of pairs makes such a hole; mend the target there, or end "
            "it before by \"cutoff\"",
            kind, kind[0] ? ": " : "", r, problem->targets.target[TARGET_RDF].value[bin]);
    }
    return STATUS_OK;
}

/// All but the samplers, with phi where it begins.
static enum status prepare(struct inversion *inversion, const struct inverse_problem *problem) {
    inversion->problem = problem;
    TRY(choose_size(inversion));
    TRY(mf_potential_grid_init(&inversion->grid, problem));
    inversion->bins = inversion->grid.all_bins;
    TRY(refuse_holes(inversion));
    TRY(allocate(inversion));
    mf_inversion_count_targets(inversion);
    TRY(mf_inversion_smooth_init(inversion));
    if (inversion->method && inversion->method->restricted)
        TRY(mf_inversion_basis_init(&inversion->basis, &inversion->grid,
                                    &inversion->settings.entropy));
    else if (inversion->grid.groups > 0)
        TRY(mf_inversion_coarse_init(inversion));
    return mf_inversion_start(inversion);
}

/// The virial pressure if the pairs were as the target has them: (d N k_B T − Σ S* r Φ')/(d V).
static enum status find_pressure(struct inversion *inversion, double *pressure) {
    const struct potential_grid *grid = &inversion->grid;
    const double dimensions = inversion->box.dimensions;
    double virial = dimensions * (double)mf_composition_particles(&inversion->composition) *
                    inversion->problem->scene.temperature;
    double volume = 1, slope;
    TRY(mf_potential_grid_table(grid, inversion->phi, &inversion->table));
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const double r = grid->r[grid->known_point[n]];
        const int pair = (int)(grid->known_point[n] / (grid->bins + 1));
        mf_table_evaluate_pair(&inversion->table, pair, r, NULL, &slope, NULL);
        virial -= inversion->target_counts[grid->known_bin[n]] * r * slope;
    }
    for (int d = 0; d < inversion->box.dimensions; d++)
        volume *= inversion->box.length[d];
    *pressure = virial / (dimensions * volume);
    return STATUS_OK;
}

enum status mf_inversion_start_curve(const struct inverse_problem *problem, double *curve,
                                     double *pressure) {
    struct inversion inversion = {0};
    mf_fields_set_defaults(mf_inversion_fields, &inversion.settings.common);
    enum status status = prepare(&inversion, problem);
    if (status == STATUS_OK)
        status = find_pressure(&inversion, pressure);
    if (status == STATUS_OK)
        memcpy(curve, inversion.phi, inversion.grid.points * sizeof *curve);
    mf_inversion_destroy(&inversion);
    return status;
}

enum status mf_inversion_tabulate(struct inversion *inversion) {
    const struct simulation_setup *scene = &inversion->problem->scene;
    const struct potential_grid *grid = &inversion->grid;
    const struct molecules *molecules = mf_molecules_find(scene->interaction, scene->interactions);
    mf_table_clear(&inversion->table);
    mf_potential_grid_molecules_clear(grid, &inversion->molecules);
    if (grid->pairs > 0)
        TRY(mf_potential_grid_table(grid, inversion->phi, &inversion->table));
    return molecules ? mf_potential_grid_molecules(grid, inversion->phi + grid->pair_points,
                                                   molecules, &inversion->molecules)
                     : STATUS_OK;
}

enum status mf_inversion_create(void *memory, const struct inverse_method *method,
                                const struct inverse_problem *problem, const void *parameters) {
    struct inversion *inversion = memory;
    const struct rdf_bins *bins = &problem->targets.bins;
    inversion->settings = *(const struct inversion_settings *)parameters;
    inversion->method = method;
    const struct inversion_parameters *p = &inversion->settings.common;
    TRY(prepare(inversion, problem));
    TRY(mf_inversion_kirkwood_buff_init(inversion));
    if (inversion->kirkwood_buff.pairs > 0)
        TRY(mf_inversion_rows_init(&inversion->rows, inversion));
    if (inversion->kirkwood_buff.pairs > 0 && inversion->doubt)
        TRY(mf_inversion_rows_init(&inversion->doubted, inversion));
    const struct simulation_setup *scene = &problem->scene;
    const bool joined = mf_molecules_find(scene->interaction, scene->interactions) != NULL;
    const bool pairs = inversion->grid.pairs > 0;
    if (!pairs && targets_ask(&problem->targets, TARGET_PRESSURE))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "target.pressure: no potential of pairs is to be found that could "
                              "meet it; with \"fitted\": \"no\" it is compared with");
    TRY(mf_inversion_tabulate(inversion));
    // What one cannot sample none can: molecules take long to be placed.
    TRY(mf_replicas_init(
        &inversion->replicas, problem->trial ? 1 : (size_t)p->replicas,
        (enum sampler_kind)p->sampler,
        &(struct sampler_system){.cancel = scene->cancel,
                                 .box = &inversion->box,
                                 .composition = &inversion->composition,
                                 .potential = pairs ? &inversion->table : scene->potential,
                                 .temperature = scene->temperature,
                                 .low = bins->low,
                                 .width = bins->width,
                                 .bins = pairs ? bins->count : 0,
                                 .molecules = joined ? &inversion->molecules : NULL,
                                 .group = inversion->groups,
                                 .groups = inversion->grid.groups,
                                 .integrals = inversion->kirkwood_buff.pairs,
                                 .q_maximum = inversion->kirkwood_buff.q_maximum,
                                 .seed = problem->seed}));
    inversion->progress = (struct inversion_progress){.anew = true,
                                                      .stretch = 1,
                                                      .damping = 1,
                                                      .best[TARGET_RDF].rms = INFINITY,
                                                      .least_decrement = INFINITY,
                                                      .miss = INFINITY};
    return STATUS_OK;
}

size_t mf_inversion_spans(void *memory, struct memory_span *span) {
    struct inversion *inversion = memory;
    const size_t bytes = inversion->grid.points * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&inversion->progress, sizeof inversion->progress};
    double *arrays[] = {inversion->phi, inversion->best, inversion->best_step,
                        inversion->best_other, inversion->pooled_phi};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        span[n++] = (struct memory_span){arrays[k], bytes};
    span[n++] = (struct memory_span){inversion->best_counts, inversion->bins * sizeof(double)};
    const size_t known = inversion->grid.known;
    span[n++] = (struct memory_span){inversion->covariance, known * known * sizeof(double)};
    span[n++] = (struct memory_span){inversion->pooled, known * sizeof(double)};
    span[n++] = (struct memory_span){inversion->pooled_variance, known * sizeof(double)};
    if (inversion->kirkwood_buff.pairs > 0)
        span[n++] = (struct memory_span){inversion->kirkwood_buff.slope,
                                         inversion->kirkwood_buff.pairs * known * sizeof(double)};
    n += mf_inversion_band_spans(&inversion->band, inversion->grid.points, span + n);
    n += mf_inversion_trail_spans(&inversion->trail, span + n);
    return n + mf_replicas_spans(&inversion->replicas, span + n);
}
