// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_case.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/number_text.h"
#include "base/simd.h"
#include "base/statistics.h"
#include "dynamics/respa.h"
#include "observe/observable.h"
#include "scene/heading.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

// Scenes ------------------------------------------------------------------------------------------

/// "a/b/thesis.json" is the scene "thesis".
static void name_scene(struct bench_scene *scene, const char *file) {
    static const char ending[] = ".json";
    const char *slash = strrchr(file, '/');
    snprintf(scene->name, sizeof scene->name, "%.*s", BENCH_NAME_SIZE - 1,
             slash ? slash + 1 : file);
    const size_t length = strlen(scene->name), cut = sizeof ending - 1;
    if (length > cut && strcmp(scene->name + length - cut, ending) == 0)
        scene->name[length - cut] = '\0';
}

static enum status read_file(struct bench_scene *scene, const char *file, struct heading *heading,
                             struct input_files *inputs) {
    struct json_document *document;
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, mf_heading_fields, heading);
    enum status status = mf_json_collect_files(document, inputs);
    if (status == STATUS_OK)
        status = mf_scene_read(&scene->scene, &root, SCENE_FITS_NOTHING, NULL);
    mf_json_has(&root, "measure");
    for (int k = 0; mf_observables[k]; k++)
        mf_json_has(&root, mf_observables[k]->name);
    mf_json_finish(&root);
    return mf_json_close(document, status);
}

/// A file of results is none that the program may know: it replaces no file without a word.
static enum status check_output(const struct input_files *inputs, const char *output, bool force) {
    struct stat about;
    if (output == NULL || lstat(output, &about) != 0)
        return STATUS_OK;
    TRY(mf_input_files_protect(inputs, output));
    if (force)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s is there: --force replaces it, -o OTHER keeps it",
                          output);
}

enum status mf_bench_scene_read(struct bench_scene *scene, const char *file, const char *output,
                                const struct run_options *options) {
    struct heading heading;
    struct input_files inputs = {0};
    enum status status = read_file(scene, file, &heading, &inputs);
    if (status == STATUS_OK)
        status = check_output(&inputs, output, options->force);
    mf_input_files_clear(&inputs);
    TRY(status);
    scene->scene.setup.seed = options->has_seed ? options->seed : heading.seed;
    name_scene(scene, file);
    return STATUS_OK;
}

enum {
    EQUILIBRATION = 300, ///< steps: the lattice has melted, as far as speed is concerned
    SCALE_EVERY = 10,    ///< steps between scalings of the velocities
    FIRST_TRIAL = 16,    ///< steps of the first trial of the speed
};

/// A trial must take so long to tell the speed, a quarter of a repeat [repeats].
static const double trial_share = 0.25;

// Statistics --------------------------------------------------------------------------------------

/// The values in growing order: an insertion sort, since they are few.
static void sort(double *sorted, const double *values, uint64_t count) {
    for (uint64_t k = 0; k < count; k++) {
        uint64_t place = k;
        for (; place > 0 && sorted[place - 1] > values[k]; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = values[k];
    }
}

double mf_bench_median(const double *values, uint64_t count) {
    double sorted[BENCH_REPEATS];
    if (count == 0)
        return NAN;
    sort(sorted, values, count);
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

double mf_bench_spread(const double *values, uint64_t count) {
    double sorted[BENCH_REPEATS];
    if (count == 0)
        return NAN;
    sort(sorted, values, count);
    return (sorted[count - 1] - sorted[0]) / mf_bench_median(values, count);
}

// Running -----------------------------------------------------------------------------------------

/// Scale all velocities to the set temperature.
static void scale_velocities(struct simulation *simulation) {
    struct particles *particles = &simulation->particles;
    const double temperature = mf_particles_temperature(particles);
    if (!(temperature > 0))
        return;
    const double factor = sqrt(simulation->setup.temperature / temperature);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] *= factor;
}

static enum status equilibrate(struct simulation *simulation) {
    for (int step = 0; step < EQUILIBRATION; step += SCALE_EVERY) {
        TRY(mf_simulation_run(simulation, SCALE_EVERY));
        if (simulation->setup.omega == NULL)
            scale_velocities(simulation);
    }
    return STATUS_OK;
}

/// Steps of a repeat, from longer and longer trials.
static enum status calibrate(struct bench_case *bench) {
    const double wanted = bench->how.seconds;
    for (uint64_t steps = FIRST_TRIAL;; steps *= 2) {
        const double begin = clock_seconds();
        TRY(mf_simulation_run(&bench->simulation, steps));
        const double seconds = clock_seconds() - begin;
        if (seconds < trial_share * wanted)
            continue;
        bench->steps = (uint64_t)ceil((double)steps * wanted / seconds);
        return STATUS_OK;
    }
}

enum status mf_bench_case_begin(struct bench_case *bench, const struct bench_scene *scene,
                                const struct bench_how *how) {
    *bench = (struct bench_case){.how = *how};
    if (!mf_simd_select(how->isa))
        return mf_status_fail(STATUS_BAD_INPUT, "this processor lacks %s", how->isa);
    struct simulation_setup setup = scene->scene.setup;
    setup.precision = strcmp(how->precision, "double") == 0 ? PAIR_DOUBLE : PAIR_MIXED;
    setup.threads = how->threads;
    TRY(mf_simulation_init(&bench->simulation, &setup, &scene->scene.start));
    bench->simulation.wants = PAIR_FORCES;
    TRY(equilibrate(&bench->simulation));
    return calibrate(bench);
}

void mf_bench_case_clear(struct bench_case *bench) {
    mf_simulation_clear(&bench->simulation);
}

static void count_distances(void *context, const float *squared_distances, size_t count) {
    (void)squared_distances;
    *(double *)context += (double)count;
}

/// Add the pairs of the present moment to the sums.
static void sample(struct bench_case *bench) {
    const struct simulation *simulation = &bench->simulation;
    const struct neighbours *neighbours = &simulation->neighbours;
    mf_neighbours_visit_distances(neighbours, &simulation->particles,
                                  mf_pair_cutoff(&simulation->law), count_distances,
                                  &bench->in_range);
    bench->listed += (double)mf_neighbours_listed(neighbours);
    bench->places += (double)mf_neighbours_entries(neighbours);
    bench->temperature += mf_particles_temperature(&simulation->particles);
}

enum status mf_bench_case_repeat(struct bench_case *bench) {
    struct simulation *simulation = &bench->simulation;
    const struct bench_case before = *bench;
    if (!mf_simd_select(bench->how.isa)) // another case may have run in between
        return mf_status_fail(STATUS_BAD_INPUT, "this processor lacks %s", bench->how.isa);
    const uint64_t begin_ticks = clock_ticks();
    const double begin = clock_seconds(), begin_busy = clock_thread_seconds();
    TRY(mf_simulation_run(simulation, bench->steps));
    const double seconds = clock_seconds() - begin, busy = clock_thread_seconds() - begin_busy;
    bench->ticks_total += clock_ticks() - begin_ticks;
    bench->seconds += seconds;
    bench->busy_rate[bench->repeats] = (double)bench->steps / busy;
    bench->rate[bench->repeats++] = (double)bench->steps / seconds;
    bench->list_builds += simulation->list_builds - before.simulation.list_builds;
    for (int phase = 0; phase < SIMULATION_PHASES; phase++)
        bench->ticks[phase] += simulation->ticks[phase] - before.simulation.ticks[phase];
    sample(bench);
    return STATUS_OK;
}

void mf_bench_case_result(const struct bench_case *bench, const char *scene,
                          struct bench_result *result) {
    const double repeats = (double)bench->repeats;
    const double particles = (double)bench->simulation.particles.count;
    const double pairs = bench->in_range / repeats;
    const double steps = mf_bench_median(bench->rate, bench->repeats);
    double best = NAN, phases = 0;
    for (uint64_t k = 0; k < bench->repeats; k++)
        best = fmax(best, bench->rate[k]);
    for (int phase = 0; phase < SIMULATION_PHASES; phase++)
        phases += (double)bench->ticks[phase];
    *result = (struct bench_result){
        .isa = bench->how.isa,
        .precision = bench->how.precision,
        .particles = particles,
        .threads = bench->how.threads,
        .temperature = bench->temperature / repeats,
        .pairs = pairs,
        .steps_per_second = steps,
        .steps_per_second_best = best,
        .steps_per_second_spread = mf_bench_spread(bench->rate, bench->repeats),
        .particle_steps_per_second = particles * steps,
        .pairs_per_second = pairs * steps,
        .ns_per_pair = 1e9 / (pairs * steps),
        .ticks_per_pair = (double)bench->ticks_total / bench->seconds / (pairs * steps),
        .list_efficiency = bench->in_range / bench->listed,
        .row_filling = bench->listed / bench->places,
        // a list that was never built again has lasted for all steps at least
        .steps_per_build = (double)bench->steps * repeats / fmax((double)bench->list_builds, 1),
        .lammps_steps_per_second = NAN,
        .lammps_ratio = NAN,
    };
    for (int phase = 0; phase < SIMULATION_PHASES; phase++)
        result->phase_share[phase] = (double)bench->ticks[phase] / phases;
    snprintf(result->scene, sizeof result->scene, "%s", scene);
}

// Parts of a step ---------------------------------------------------------------------------------

enum {
    BINS = 100,
    MOST_VARIANTS = 6 + INTERACTION_MAX, ///< the scene itself and each part that it has or lacks
};

/// A skin so narrow that every step finds the pairs anew, in units of the cutoff.
static const double no_skin = 1e-9;

/// A scene with one part more or less.
struct variant {
    char part[64];
    bool less; ///< the scene has the part, and this one does without
    struct bench_scene scene;
    enum pair_wants wants;
    bool histogram;
    struct bench_case bench;
};

struct skips {
    struct variant variant[MOST_VARIANTS]; ///< the scene as it is first
    int variants;
    struct pair_histogram histogram;
};

// What there is to leave out or to add -----------------------------------------------------------

static struct variant *add(struct skips *skips, const struct bench_scene *scene, const char *part,
                           bool less) {
    struct variant *variant = &skips->variant[skips->variants++];
    *variant = (struct variant){.less = less, .scene = *scene, .wants = PAIR_FORCES};
    snprintf(variant->part, sizeof variant->part, "%s", part);
    return variant;
}

/// Friction and noise are left out with the integrator that is made for them, and with their
/// memory.
static void leave_out_friction(struct simulation_setup *setup) {
    const bool keeps_inner_steps = mf_respa_acts(setup);
    setup->omega = NULL;
    setup->memory = (struct pair_memory_law){0};
    if (!keeps_inner_steps) // other parameters are those of the other integrator
        setup->integrator_parameters = NULL;
    setup->integrator = &mf_velocity_verlet;
}

static void leave_out_interaction(struct simulation_setup *setup, int which) {
    setup->interactions--;
    memmove(&setup->interaction[which], &setup->interaction[which + 1],
            (size_t)(setup->interactions - which) * sizeof *setup->interaction);
}

static void list_parts(struct skips *skips, const struct bench_scene *scene) {
    const struct simulation_setup *setup = &scene->scene.setup;
    // Of a pass over the pairs, which moves of Monte Carlo do not take.
    const bool pairs = (setup->potential || setup->omega) && !setup->integrator->samples;
    add(skips, scene, "", false);
    if (setup->omega && setup->potential)
        leave_out_friction(&add(skips, scene, "friction and noise", true)->scene.scene.setup);
    if (setup->omega && pair_memory_acts(&setup->memory))
        add(skips, scene, "memory", true)->scene.scene.setup.memory = (struct pair_memory_law){0};
    // Inner steps are those of what stands beside the pairs: they go together.
    for (int k = 0; k < setup->interactions && !mf_respa_acts(setup); k++)
        leave_out_interaction(
            &add(skips, scene, setup->interaction[k].kind->name, true)->scene.scene.setup, k);
    if (!pairs)
        return;
    add(skips, scene, "energy and virial at every step", false)->wants = PAIR_FORCES_AND_SUMS;
    add(skips, scene, "g(r) at every step", false)->histogram = true;
    add(skips, scene, "a new neighbour list at every step", false)->scene.scene.setup.skin =
        no_skin * mf_simulation_range(setup);
}

// Timing -----------------------------------------------------------------------------------------

static enum status begin(struct skips *skips, const struct bench_how *how) {
    for (int k = 0; k < skips->variants; k++) {
        struct variant *variant = &skips->variant[k];
        TRY(mf_bench_case_begin(&variant->bench, &variant->scene, how));
        variant->bench.simulation.wants = variant->wants;
        if (!variant->histogram)
            continue;
        skips->histogram.width = mf_pair_cutoff(&variant->bench.simulation.law) / BINS;
        variant->bench.simulation.law.histogram = &skips->histogram;
    }
    return STATUS_OK;
}

/// In turn, so that what else the machine does slows down all of them alike; what it takes of the
/// processor's time does not count.
static enum status repeat(struct skips *skips) {
    for (int round = 0; round < BENCH_REPEATS; round++)
        for (int k = 0; k < skips->variants; k++)
            TRY(mf_bench_case_repeat(&skips->variant[k].bench));
    return STATUS_OK;
}

// Telling ----------------------------------------------------------------------------------------

static double rate_of(const struct variant *variant) {
    return mf_bench_median(variant->bench.busy_rate, variant->bench.repeats);
}

/// What a part adds to a step, a share of the step without it: the mean over the rounds, in each of
/// which both were timed in turn.
static struct running_mean find_added(const struct variant *plain, const struct variant *variant) {
    struct running_mean added = {0};
    for (uint64_t round = 0; round < variant->bench.repeats; round++) {
        const double ratio = plain->bench.busy_rate[round] / variant->bench.busy_rate[round];
        mf_statistics_add(&added, (variant->less ? 1 / ratio : ratio) - 1);
    }
    return added;
}

/// "+65.9(12)" per cent.
static void print_per_cent(const struct running_mean *added, char text[NUMBER_TEXT_SIZE + 1]) {
    mf_number_text(100 * added->mean, 100 * mf_statistics_standard_error(added), text + 1);
    text[0] = '+';
    if (text[1] == '-')
        memmove(text, text + 1, NUMBER_TEXT_SIZE);
}

static void report(const struct skips *skips, FILE *out, FILE *table,
                   const struct bench_scene *scene, const struct bench_how *how) {
    const double plain = rate_of(&skips->variant[0]);
    fprintf(out, "%s: %lld particles, %s, %s precision: %.0f steps/s\n", scene->name,
            (long long)scene->scene.setup.placement.count, how->isa, how->precision, plain);
    fprintf(out, "  %-36s %8s %8s  %s\n", "part [steps/s of processor time]", "with", "without",
            "adds to a step");
    for (int k = 1; k < skips->variants; k++) {
        const struct variant *variant = &skips->variant[k];
        const double other = rate_of(variant);
        const double with = variant->less ? plain : other, without = variant->less ? other : plain;
        const struct running_mean added = find_added(&skips->variant[0], variant);
        char text[NUMBER_TEXT_SIZE + 1];
        print_per_cent(&added, text);
        fprintf(out, "  %-36s %8.0f %8.0f  %s %%%s\n", variant->part, with, without, text,
                variant->less ? "" : "  (skipped)");
        if (table)
            fprintf(table, "%s\t%s\t%s\t%s\t%s\t%.6g\t%.6g\t%.4g\t%.2g\n", scene->name, how->isa,
                    how->precision, variant->part, variant->less ? "no" : "yes", with, without,
                    added.mean, mf_statistics_standard_error(&added));
    }
    fflush(out);
}

void mf_bench_skips_head(FILE *table) {
    fprintf(table, "# scene\tisa\tprecision\tpart\tskipped\twith[1/s]\twithout[1/s]\tadds[1]\t"
                   "adds_error[1]\n");
}

enum status mf_bench_skips(FILE *out, FILE *table, const struct bench_scene *scene,
                           const struct bench_how *how) {
    enum status status = STATUS_OK;
    struct skips *skips = NULL;
    NEW_ARRAY(skips, 1);
    skips->histogram.bins = BINS;
    NEW_ARRAY(skips->histogram.counts, NEIGHBOURS_MAX_PARTS * (BINS + 1));
    list_parts(skips, scene);
    CHECK(begin(skips, how));
    CHECK(repeat(skips));
    report(skips, out, table, scene, how);
done:
    for (int k = 0; skips && k < skips->variants; k++)
        mf_bench_case_clear(&skips->variant[k].bench);
    if (skips)
        mf_memory_free(skips->histogram.counts);
    mf_memory_free(skips);
    return status;
}
