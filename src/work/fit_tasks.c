// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_tasks.h"

#include "base/digest.h"
#include "base/memory.h"
#include "base/parallel_times.h"
#include "base/rng.h"
#include "base/simd.h"
#include "io/data_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COLUMNS = 5, MAX_ROWS = PARALLEL_MAX_SIZES + 1 };

enum status mf_fit_tasks_write(const struct run_folder *folder, double seconds) {
    const struct parallel_times times = mf_parallel_times();
    double tasks[MAX_ROWS] = {0}, rounds[MAX_ROWS] = {1}, mean[MAX_ROWS] = {0},
           spread[MAX_ROWS] = {0}, waited[MAX_ROWS] = {seconds};
    char path[OUTPUT_PATH_SIZE];
    for (size_t k = 0; k < times.sizes; k++) {
        const struct parallel_size *size = &times.size[k];
        tasks[k + 1] = (double)size->tasks;
        rounds[k + 1] = size->rounds;
        mean[k + 1] = size->done > 0 ? size->seconds / size->done : 0;
        spread[k + 1] = size->done > 0 ? mean[k + 1] * sqrt(size->squares / size->done) : 0;
        waited[k + 1] = size->waited;
        waited[0] = fmax(0, waited[0] - size->waited);
    }
    mean[0] = waited[0];
    const struct data_column columns[COLUMNS] = {{"tasks[1]", tasks, NULL},
                                                 {"rounds[1]", rounds, NULL},
                                                 {"each[s]", mean, "%.6f"},
                                                 {"spread[s]", spread, "%.6f"},
                                                 {"waited[s]", waited, "%.3f"}};
    mf_run_folder_file(folder, "tasks.tsv", path);
    return mf_data_table_write(path, NULL, columns, COLUMNS, 1 + times.sizes);
}

// The model ---------------------------------------------------------------------------------------

/// The worker who is free first, from a heap by the times at which they are, takes a task.
static double take_task(double *free_at, size_t workers, double seconds) {
    const double end = free_at[0] + seconds;
    size_t k = 0;
    for (;;) {
        size_t child = 2 * k + 1;
        if (child >= workers)
            break;
        if (child + 1 < workers && free_at[child + 1] < free_at[child])
            child++;
        if (end <= free_at[child])
            break;
        free_at[k] = free_at[child];
        k = child;
    }
    free_at[k] = end;
    return end;
}

/// Seconds from begin to end of `tasks` that `workers` take one after the other, each when it is
/// free, as mf_parallel_try hands them out: a model by discrete events. NAN without memory.
static double schedule(const double *seconds, size_t tasks, int workers) {
    const size_t busy = tasks < (size_t)workers ? tasks : (size_t)workers;
    double *free_at = mf_memory_zeroed(busy + 1, sizeof *free_at), last = free_at ? 0 : NAN;
    for (size_t k = 0; free_at && k < tasks; k++)
        last = fmax(last, take_task(free_at, busy, seconds[k]));
    mf_memory_free(free_at);
    return last;
}

double mf_fit_tasks_span(size_t tasks, double mean, double spread, int workers) {
    enum { DRAWS = 200 };
    const double width = mean > 0 ? sqrt(log1p(spread * spread / (mean * mean))) : 0;
    double *seconds = mf_memory_zeroed(tasks, sizeof *seconds), total = seconds ? 0 : NAN;
    double normal[4] = {0};
    for (uint32_t round = 0; seconds && round < DRAWS; round++) {
        for (size_t k = 0; k < tasks; k++) {
            if (k % 4 == 0)
                mf_rng_normal4(mf_rng_philox(1, RNG_SELECTION, (uint32_t)k, round, 0), normal);
            seconds[k] = mean * exp(width * (normal[k % 4] - width / 2));
        }
        total += schedule(seconds, tasks, workers) / DRAWS;
    }
    mf_memory_free(seconds);
    return total;
}

/// Seconds of everything in the table, and those of the tasks in it, with so many workers.
static double expect(const struct data_table *table, int workers, double *of_tasks) {
    double alike = 0;
    *of_tasks = 0;
    for (size_t k = 0; k < table->rows; k++) {
        const double *row = table->values + k * table->columns;
        if (row[0] > 0)
            *of_tasks += row[1] * mf_fit_tasks_span((size_t)row[0], row[2], row[3], workers);
        else
            alike += row[2];
    }
    return *of_tasks + alike;
}

static enum status check(const struct data_table *table, const char *path) {
    for (size_t k = 0; k < table->rows; k++)
        for (size_t c = 0; c < COLUMNS; c++) {
            const double value = table->values[k * table->columns + c];
            if (!(value >= 0) || (c == 0 && value > 1e6))
                return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: no times of tasks", path,
                                      table->line[k]);
        }
    return STATUS_OK;
}

/// What more workers cannot make shorter.
static const char *limit(const struct data_table *table, double seconds, double of_tasks,
                         int workers) {
    double few = 0, all = 0;
    for (size_t k = 0; k < table->rows; k++) {
        const double *row = table->values + k * table->columns;
        all += row[0] * row[1] * row[2];
        few += row[0] < 2 * workers ? row[0] * row[1] * row[2] : 0;
    }
    if (workers == 1)
        return "one worker";
    if (seconds > 2 * of_tasks)
        return "what every process does alike";
    return 2 * few > all ? "tasks are too few for two each" : "tasks that end last";
}

static void print(FILE *out, const struct data_table *table, int ranks, int threads) {
    double of_tasks;
    const double one = expect(table, 1, &of_tasks);
    for (size_t k = 0; k < table->rows; k++) {
        const double *row = table->values + k * table->columns;
        if (row[0] > 0)
            fprintf(out, "%6.0f rounds of %4.0f tasks of %.3g s, +- %.0f %%: %.1f times as fast\n",
                    row[1], row[0], row[2], 100 * row[3] / fmax(row[2], 1e-9),
                    row[0] * row[2] /
                        mf_fit_tasks_span((size_t)row[0], row[2], row[3], ranks * threads));
        else
            fprintf(out, "%.2g %% of the time of one worker is what every process does alike\n",
                    100 * row[2] / one);
    }
    for (int count = 1;; count = 2 * count < ranks ? 2 * count : ranks) {
        const int workers = count * threads;
        const double seconds = expect(table, workers, &of_tasks);
        fprintf(out, "%6d ranks: %.1f times as fast as one worker, %.0f %% of %d; the limit: %s\n",
                count, one / seconds, 100 * one / seconds / workers, workers,
                limit(table, seconds, of_tasks, workers));
        if (count == ranks)
            return;
    }
}

enum status mf_fit_tasks_explain(FILE *out, const char *file, const struct run_options *options,
                                 int ranks) {
    struct run_folder folder = {0};
    CLEARED_BY(mf_data_table_clear) struct data_table table = {0};
    char path[OUTPUT_PATH_SIZE];
    TRY(mf_run_folder_choose(&folder, RUN_FIT, file, options));
    mf_run_folder_file(&folder, "tasks.tsv", path);
    if (access(path, F_OK) != 0) {
        fprintf(out,
                "The speed-up of %d ranks follows from the times of tasks: start the fit, stop it "
                "after some iterations, and ask again; %s not found.\n",
                ranks, path);
        return STATUS_OK;
    }
    TRY(mf_data_table_read(&table, path, COLUMNS));
    TRY(check(&table, path));
    fprintf(out, "By %s, with %d threads a rank:\n", path, options->threads);
    print(out, &table, ranks, options->threads);
    return STATUS_OK;
}

// What ranks have in common -----------------------------------------------------------------------

uint64_t mf_fit_ranks_digest(const struct fit_file *fit) {
    enum { TRIED = 1000 };
    double (*const functions[])(double) = {exp, log, sin, cos, tanh, erf, cbrt};
    uint64_t digest = DIGEST_OF_NOTHING;
    const char *kernels = mf_simd_name();
    mf_digest_add(&digest, kernels, strlen(kernels));
    for (size_t f = 0; f < sizeof functions / sizeof *functions; f++)
        for (int k = 1; k <= TRIED; k++) {
            const double value = functions[f](0.0137 * k) + pow(0.0137 * k, 1.7);
            mf_digest_add(&digest, &value, sizeof value);
        }
    mf_digest_add(&digest, &fit->problem.seed, sizeof fit->problem.seed);
    mf_fit_file_digest(fit, &digest);
    return digest;
}

uint64_t mf_fit_ranks_digest_curves(const struct unknowns *unknowns, double *const *curve) {
    uint64_t digest = DIGEST_OF_NOTHING;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_digest_add(&digest, curve[kind],
                      mf_unknowns_points(unknowns, kind) * sizeof *curve[kind]);
    return digest;
}
