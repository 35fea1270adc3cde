// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_lammps.h"

#include "base/interrupt.h"
#include "curves/formula.h"
#include "curves/sampled.h"
#include "io/output.h"
#include "report/program.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    TURNS = 3,
    TABLE_POINTS = 1000,
    PATH_SIZE = OUTPUT_PATH_SIZE + 32,
    TEXT_SIZE = 16384, ///< what LAMMPS prints after a run fits
    WARM_UP = 50,      ///< steps before the timed ones
};

/// LAMMPS's own skin for reduced units; see `neighbor` in its manual.
static const double usual_skin = 0.3;

/// A trial of a variant takes so long [seconds of a turn].
static const double trial_share = 0.25;

static const char *const files[] = {"in.bench", "start.data", "pair.table"};

/// Command-line options that choose one of LAMMPS's implementations.
static const char *const suffixes[][5] = {
    {NULL}, {"-sf", "opt"}, {"-sf", "omp", "-pk", "omp", "1"}};
enum { SUFFIXES = sizeof suffixes / sizeof *suffixes, SUFFIX_WORDS = 5 };

/// One way to run LAMMPS.
struct variant {
    const char *const *suffix; ///< up to SUFFIX_WORDS words
    double skin;
    double rate; ///< in its trial [steps/s]
};

enum status mf_bench_lammps_check(void) {
    static const char *const words[] = {"lmp", "-h", NULL};
    char text[TEXT_SIZE];
    if (mf_program_run("/", words, PROGRAM_EVERYTHING, 0, text, sizeof text) == STATUS_OK)
        return STATUS_OK;
    return mf_status_prefix(STATUS_BAD_INPUT, "--against-lammps needs Debian's package lammps");
}

const char *mf_bench_lammps_unsupported(const struct scene *scene) {
    const struct curve_family *family = scene->potential.curve[0].family;
    if (composition_is_mixed(&scene->setup.composition))
        return "it is a mixture";
    if (scene->omega.curves)
        return "Debian's LAMMPS has no pair style with friction and noise";
    if (scene->setup.integrator != &mf_velocity_verlet)
        return "its integrator is not velocity-verlet";
    if (scene->setup.interactions > 0)
        return "it has interactions other than pair potentials";
    if (scene->setup.attribute[ATTRIBUTES_MASS].ranges > 0)
        return "its particles have masses of their own";
    if (family != &mf_sampled_family && family != &mf_formula_lennard_jones)
        return "its potential is neither a table nor Lennard-Jones";
    if (scene->setup.box.dimensions != 3)
        return "it is not in three dimensions";
    return NULL;
}

// Input -------------------------------------------------------------------------------------------

static enum status open_in(struct output *output, const char *folder, const char *name) {
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return mf_output_open(output, path);
}

/// Every particle with its velocity: both programs begin where the other does.
static enum status write_start(const char *folder, const struct particles *particles) {
    static const char axis[] = "xyz";
    struct output output;
    TRY(open_in(&output, folder, "start.data"));
    FILE *stream = output.stream;
    fprintf(stream, "from mesofit bench\n\n%zu atoms\n1 atom types\n\n", particles->count);
    for (int d = 0; d < 3; d++)
        fprintf(stream, "0 %.17g %clo %chi\n", particles->box.length[d], axis[d], axis[d]);
    fprintf(stream, "\nMasses\n\n1 1\n\nAtoms # atomic\n\n");
    for (size_t k = 0; k < particles->count; k++)
        fprintf(stream, "%zu 1 %.17g %.17g %.17g\n", k + 1, particles->position[0][k],
                particles->position[1][k], particles->position[2][k]);
    fprintf(stream, "\nVelocities\n\n");
    for (size_t k = 0; k < particles->count; k++)
        fprintf(stream, "%zu %.17g %.17g %.17g\n", k + 1, particles->velocity[0][k],
                particles->velocity[1][k], particles->velocity[2][k]);
    return mf_output_commit(&output);
}

/// Points of the table that our kernels read, at equal steps of r² as pair_style table keeps them.
static enum status write_table(const char *folder, const struct table *table) {
    struct output output;
    const double last = table->cutoff, first = last / TABLE_POINTS;
    TRY(open_in(&output, folder, "pair.table"));
    fprintf(output.stream,
            "# from mesofit bench: index r energy force\n\nSCENE\nN %d RSQ %.17g %.17g\n\n",
            TABLE_POINTS, first, last);
    for (int k = 0; k < TABLE_POINTS; k++) {
        const double share = k / (TABLE_POINTS - 1.0);
        const double r = sqrt(first * first + share * (last * last - first * first));
        double value, slope;
        mf_table_evaluate(table, r, &value, &slope, NULL);
        fprintf(output.stream, "%d %.17g %.17g %.17g\n", k + 1, r, value, -slope);
    }
    return mf_output_commit(&output);
}

static void write_pair_style(FILE *stream, const struct scene *scene) {
    if (scene->potential.curve[0].family == &mf_sampled_family) {
        fprintf(stream, "pair_style table linear %d\npair_coeff 1 1 pair.table SCENE %.17g\n",
                TABLE_POINTS, scene->potential.table.cutoff);
        return;
    }
    const struct formula_lennard_jones_parameters *p = scene->potential.curve[0].parameters;
    fprintf(stream, "pair_style lj/cut %.17g\npair_coeff 1 1 %.17g %.17g\npair_modify shift yes\n",
            p->cutoff, p->epsilon, p->sigma);
}

enum status mf_bench_lammps_write(const char *folder, const struct scene *scene,
                                  const struct simulation *simulation) {
    struct output output;
    TRY(write_start(folder, &simulation->particles));
    if (scene->potential.curve[0].family == &mf_sampled_family)
        TRY(write_table(folder, &scene->potential.table));
    TRY(open_in(&output, folder, "in.bench"));
    fprintf(output.stream, "# from mesofit bench: -var skin S -var steps N\n"
                           "units lj\natom_style atomic\nnewton on\nread_data start.data\n");
    write_pair_style(output.stream, scene);
    // the list is built again when a particle has moved by half the skin, and not before: as ours
    fprintf(output.stream,
            "neighbor ${skin} bin\nneigh_modify delay 0 every 1 check yes\n"
            "fix motion all nve\ntimestep %.17g\nthermo 0\nrun %d\nrun ${steps}\n",
            scene->setup.time_step, WARM_UP);
    return mf_output_commit(&output);
}

// Running -----------------------------------------------------------------------------------------

double mf_bench_lammps_rate(const char *text) {
    const char *last = NULL;
    for (const char *line = text; (line = strstr(line, "Loop time of ")); line++)
        last = line;
    double seconds, steps;
    if (last == NULL ||
        sscanf(last, "Loop time of %lf on %*d procs for %lf steps", &seconds, &steps) != 2)
        return NAN;
    return steps / seconds;
}

static enum status run_variant(const char *folder, const struct variant *variant, double steps,
                               double *rate) {
    char skin[32], count[32], text[TEXT_SIZE];
    const char *words[16 + SUFFIX_WORDS] = {"lmp",  "-in", "in.bench", "-log",  "none", "-var",
                                            "skin", skin,  "-var",     "steps", count};
    snprintf(skin, sizeof skin, "%.17g", variant->skin);
    snprintf(count, sizeof count, "%.0f", ceil(steps));
    for (size_t k = 0, used = 11; k < SUFFIX_WORDS && variant->suffix[k]; k++)
        words[used++] = variant->suffix[k];
    const enum status status =
        mf_program_run(folder, words, PROGRAM_EVERYTHING, 0, text, sizeof text);
    if (mf_interrupt_requested())
        return mf_status_fail(STATUS_INTERRUPTED, "interrupted");
    TRY(status);
    *rate = mf_bench_lammps_rate(text);
    if (isfinite(*rate))
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "lmp does not say how long its run took");
}

/// Try every variant and keep the fastest. Some may be missing in this LAMMPS, but not all.
static enum status choose_variant(const char *folder, double skin, double ours, double seconds,
                                  struct variant *best) {
    const double skins[] = {skin, usual_skin};
    enum status status = STATUS_OK;
    double steps = ours * seconds * trial_share / 4; // LAMMPS may be slower than we are
    *best = (struct variant){.rate = 0};
    for (size_t k = 0; k < SUFFIXES; k++)
        for (size_t s = 0; s < (skin != usual_skin ? 2 : 1); s++) {
            struct variant variant = {.suffix = suffixes[k], .skin = skins[s]};
            status = run_variant(folder, &variant, steps, &variant.rate);
            if (status == STATUS_INTERRUPTED)
                return status;
            if (status != STATUS_OK)
                continue;
            steps = variant.rate * seconds * trial_share;
            if (variant.rate > best->rate)
                *best = variant;
        }
    return best->rate > 0 ? STATUS_OK : status;
}

static void describe_variant(const struct scene *scene, const struct variant *variant, char *text) {
    const char *style =
        scene->potential.curve[0].family == &mf_sampled_family ? "table linear" : "lj/cut";
    int used = snprintf(text, BENCH_NAME_SIZE, "pair_style %s, skin %g", style, variant->skin);
    for (size_t k = 0; k < SUFFIX_WORDS && variant->suffix[k]; k++)
        used += snprintf(text + used, (size_t)(BENCH_NAME_SIZE - used), "%s%s", k ? " " : ", ",
                         variant->suffix[k]);
}

static enum status take_turns(struct bench_case *bench, const struct bench_scene *scene,
                              const char *folder, struct bench_result *result) {
    struct variant variant;
    double theirs[TURNS];
    const double seconds = bench->how.seconds;
    TRY(mf_bench_lammps_write(folder, &scene->scene, &bench->simulation));
    TRY(choose_variant(folder, scene->scene.setup.skin, (double)bench->steps / seconds, seconds,
                       &variant));
    for (int turn = 0; turn < TURNS; turn++) {
        TRY(mf_bench_case_repeat(bench));
        TRY(run_variant(folder, &variant, variant.rate * seconds, &theirs[turn]));
    }
    mf_bench_case_result(bench, scene->name, result);
    result->lammps_steps_per_second = mf_bench_median(theirs, TURNS);
    result->lammps_ratio = result->steps_per_second / result->lammps_steps_per_second;
    describe_variant(&scene->scene, &variant, result->lammps_style);
    return STATUS_OK;
}

enum status mf_bench_lammps_compare(struct bench_case *bench, const struct bench_scene *scene,
                                    struct bench_result *result) {
    char folder[OUTPUT_PATH_SIZE], path[PATH_SIZE];
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.3900s/mesofit-lammps-XXXXXX",
             temporary ? temporary : "/tmp");
    if (mkdtemp(folder) == NULL)
        return mf_status_fail(STATUS_IO, "cannot make a folder for LAMMPS: %s", folder);
    enum status status = STATUS_NO_MEMORY;
    if (setenv("OMP_NUM_THREADS", "1", 1) == 0)
        status = take_turns(bench, scene, folder, result);
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, files[k]);
        remove(path);
    }
    rmdir(folder);
    return status;
}
