// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_watch.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "io/json_write.h"
#include "live/live_particles.h"
#include "observe/thermodynamics.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_LOG = 32768 };

/// Least time between news of a kind [s], and the part of the time that they may take.
static const double progress_interval = 0.2, particles_interval = 0.02, numbers_interval = 0.2,
                    tables_interval = 1.5, candidate_interval = 0.5, part_of_time = 1.0 / 500;

/// Time between words of a simulation while somebody draws its particles, or looks at all [s].
static const double drawn_interval = 0.015, looked_interval = 0.25;

static bool is_due(const struct live_pace *pace) {
    return clock_seconds() >= pace->next;
}

/// @param[in] begun  clock_thread_seconds before the work: a busy machine's time is not its own
static void set_pace(struct live_pace *pace, double begun, double interval) {
    const double spent = clock_thread_seconds() - begun;
    pace->next = clock_seconds() + fmax(interval, spent / part_of_time);
}

/// Steps a second from here on, if the page holds a simulation to fewer than it has made so far.
static double find_rate_ahead(const struct live_watch *watch, double rate) {
    const double speed = mf_live_control_speed_now(&watch->view->control);
    return watch->run.simulation && speed > 0 ? fmin(speed, rate) : rate;
}

static void publish_progress(struct live_watch *watch, const struct watcher_progress *progress) {
    const double begun = clock_thread_seconds();
    const double rate = find_rate_ahead(watch, progress->rate);
    const bool known = rate > 0 && !progress->open;
    const double left = known ? (double)(progress->total - progress->done) / rate : NAN;
    struct json_writer *writer = mf_json_writer_create();
    if (writer == NULL || (!is_due(&watch->progress) && progress->done < progress->total)) {
        mf_json_writer_free(writer);
        return;
    }
    mf_json_write_integer(writer, "done", (int64_t)progress->done);
    mf_json_write_integer(writer, "total", (int64_t)progress->total);
    mf_json_write_text(writer, "unit", progress->unit);
    mf_json_write_text(writer, "text", progress->text);
    mf_json_write_number(writer, "rate", rate);
    mf_json_write_number(writer, "left", left);
    mf_live_view_publish(watch->view, LIVE_PROGRESS, writer);
    set_pace(&watch->progress, begun, progress_interval);
}

// A simulation ------------------------------------------------------------------------------------

static void publish_particles(struct live_watch *watch, bool forced) {
    struct live_feed *feed = &watch->view->feed;
    const double begun = clock_thread_seconds();
    if (!mf_live_feed_wants_particles(feed) || (!forced && !is_due(&watch->particles)))
        return;
    watch->frame_step = watch->run.simulation->step;
    watch->frame_energies = mf_live_feed_wants_energies(feed);
    mf_live_particles_write(watch->run.simulation, watch->frame_energies, &watch->bytes);
    if (watch->bytes.size > 0)
        mf_live_feed_push_particles(feed, &watch->bytes);
    set_pace(&watch->particles, begun, particles_interval);
}

/// Who comes while the run is paused, or asks for energies then, gets the particles as they are.
static void show_held_particles(struct live_watch *watch) {
    const bool energies = mf_live_feed_wants_energies(&watch->view->feed);
    if (watch->frame_step != watch->run.simulation->step || (energies && !watch->frame_energies))
        publish_particles(watch, true);
}

static void write_number(struct json_writer *writer, const struct live_watch *watch,
                         const char *name, const char *unit, double value) {
    char text[UNITS_NAME_SIZE];
    mf_json_begin(writer, name);
    mf_json_write_number(writer, "value", value * mf_units_factor(watch->run.units, unit));
    mf_json_write_text(writer, "unit", mf_units_name(watch->run.units, unit, text));
    mf_json_end(writer);
}

/// The samples of energy and pressure, as they are kept for the end.
static const struct thermodynamics *find_samples(const struct live_watch *watch) {
    for (const struct observable_use *use = watch->run.observables; use->observable; use++)
        if (use->observable == &mf_thermodynamics_observable)
            return use->state;
    return NULL;
}

static void write_samples(struct json_writer *writer, const struct live_watch *watch) {
    const struct thermodynamics *samples = find_samples(watch);
    if (samples == NULL || samples->series.count == 0)
        return;
    const size_t last = samples->series.count - 1;
    const double squares = mf_thermodynamics_series(samples, THERMODYNAMICS_FORCE_SQUARES)[last];
    const double laplacian = mf_thermodynamics_series(samples, THERMODYNAMICS_LAPLACIAN)[last];
    write_number(writer, watch, "potential energy of a bead", "k_B T_0",
                 mf_thermodynamics_series(samples, THERMODYNAMICS_POTENTIAL_ENERGY)[last]);
    write_number(writer, watch, "pressure", "k_B T_0/lambda^d",
                 mf_thermodynamics_series(samples, THERMODYNAMICS_PRESSURE)[last]);
    write_number(writer, watch, "configurational temperature", "T_0", squares / laplacian);
}

static void publish_numbers(struct live_watch *watch, bool forced) {
    const struct simulation *simulation = watch->run.simulation;
    const double begun = clock_thread_seconds();
    struct json_writer *writer;
    if ((!forced && !is_due(&watch->numbers)) || (writer = mf_json_writer_create()) == NULL)
        return;
    const double time = (double)simulation->step * simulation->setup.time_step;
    write_number(writer, watch, "step", "", (double)simulation->step);
    if (!simulation->setup.integrator->samples) {
        write_number(writer, watch, "time", "tau", time);
        write_number(writer, watch, "time step", "tau", simulation->setup.time_step);
    }
    write_number(writer, watch, "set temperature", "T_0", simulation->setup.temperature);
    write_number(writer, watch, "beads", "", (double)simulation->particles.count);
    write_number(writer, watch, "steps a second", "", watch->rate);
    if (simulation_has_velocities(&simulation->setup) && simulation->particles.count > 1)
        write_number(writer, watch, "temperature", "T_0", mf_simulation_temperature(simulation));
    write_samples(writer, watch);
    mf_live_view_publish(watch->view, LIVE_NUMBERS, writer);
    set_pace(&watch->numbers, begun, numbers_interval);
}

/// The observables write their tables as they do at the end, into a folder of the view's own.
static void publish_tables(struct live_watch *watch) {
    const struct watcher_run *run = &watch->run;
    const double begun = clock_thread_seconds();
    const int64_t sampled = (int64_t)run->simulation->step - run->plan->equilibration;
    const struct observable_results results = {.setup = &run->simulation->setup,
                                               .plan = run->plan,
                                               .units = run->units,
                                               .folder = watch->now.path};
    if (watch->now.path[0] == '\0' || sampled < 2 * run->plan->every || !is_due(&watch->tables))
        return;
    for (const struct observable_use *use = run->observables; use->observable; use++)
        if (use->observable->write && use->observable->write(use->state, &results) != STATUS_OK)
            break;
    mf_live_view_write_tables(watch->view);
    set_pace(&watch->tables, begun, tables_interval);
}

static void find_rate(struct live_watch *watch) {
    const double now = clock_seconds();
    const uint64_t step = watch->run.simulation->step;
    if (now > watch->last_clock && step > watch->last_step)
        watch->rate = (double)(step - watch->last_step) / (now - watch->last_clock);
    watch->last_clock = now;
    watch->last_step = step;
}

/// @param[in] forced  at once, since this is what the page will see for a while
static void publish_simulation(struct live_watch *watch, bool forced) {
    publish_particles(watch, forced);
    if (mf_live_feed_streams(&watch->view->feed) == 0)
        return;
    publish_numbers(watch, forced);
    publish_tables(watch);
}

// A fit -------------------------------------------------------------------------------------------

static void publish_candidate(struct live_watch *watch, const struct inverse_candidate *candidate) {
    const double begun = clock_thread_seconds();
    if (candidate == NULL || mf_live_feed_streams(&watch->view->feed) == 0 ||
        !is_due(&watch->candidate))
        return;
    struct json_writer *writer = mf_live_candidate_write(&watch->run, candidate);
    if (writer)
        mf_live_view_publish(watch->view, LIVE_CANDIDATE, writer);
    set_pace(&watch->candidate, begun, candidate_interval);
}

/// The page offers to change what it is told of.
static void publish_damping(struct live_watch *watch) {
    struct json_writer *writer = mf_json_writer_create();
    if (writer && watch->run.damping)
        write_number(writer, watch, "damping", "", *watch->run.damping);
    mf_live_view_publish(watch->view, LIVE_NUMBERS, writer);
}

static void begin_fit(struct live_watch *watch) {
    watch->damping = NAN;
    mf_live_feed_push(&watch->view->feed, LIVE_CANDIDATE, "{}");
    publish_damping(watch);
}

// What the page wishes ----------------------------------------------------------------------------

/// Not so fast: the next word is due so long after the last one.
static void keep_speed(const struct live_watch *watch, double speed, uint64_t steps) {
    const double until = watch->last_clock + (double)steps / speed;
    double left;
    while ((left = until - clock_seconds()) > 0 && !mf_interrupt_requested()) {
        const double nap = fmin(left, 0.1);
        nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * nap)}, NULL);
    }
}

static void show_pause(struct live_watch *watch, bool paused) {
    if (watch->paused != paused)
        mf_live_view_set_phase(watch->view, paused ? LIVE_PAUSED : LIVE_RUNNING, NULL);
    watch->paused = paused;
}

static void answer_wish(struct live_watch *watch, const char *answer) {
    mf_live_view_set_phase(watch->view, watch->paused ? LIVE_PAUSED : LIVE_RUNNING, answer);
}

/// Where the steps of a fit have no damping the wish is refused.
static void review_damping(struct live_watch *watch, double wish) {
    const bool changes = watch->run.damping != NULL;
    if (changes)
        watch->damping = wish;
    answer_wish(watch, changes ? "it takes effect at the next iteration"
                               : "this method has no damping to be changed");
}

/// A change that cannot be is refused at once, one that can waits for the next step.
static void review_change(struct live_watch *watch) {
    const struct simulation *simulation = watch->run.simulation;
    struct live_change wish;
    if (!mf_live_control_take_change(&watch->view->control, &wish))
        return;
    if (simulation == NULL) {
        review_damping(watch, wish.damping);
        return;
    }
    const struct simulation_setup *setup = &simulation->setup;
    const struct units *units = watch->run.units;
    watch->change = (struct simulation_change){
        simulation->step,
        isnan(wish.temperature) ? setup->temperature
                                : wish.temperature / mf_units_factor(units, "T_0"),
        isnan(wish.time_step) ? setup->time_step : wish.time_step / mf_units_factor(units, "tau")};
    watch->changes = mf_simulation_check_change(simulation, &watch->change) == STATUS_OK;
    answer_wish(watch, watch->changes ? "it takes effect at the next step; samples are reset"
                                      : mf_status_message());
}

static struct live_pause apply_control(struct live_watch *watch) {
    struct live_pause pause;
    while ((pause = mf_live_control_wait(&watch->view->control)).paused &&
           !mf_interrupt_requested()) {
        if (watch->run.simulation && !watch->paused)
            publish_simulation(watch, true);
        show_pause(watch, true);
        review_change(watch);
        if (watch->run.simulation)
            show_held_particles(watch);
        watch->last_clock = clock_seconds();
    }
    if (!pause.stepping)
        show_pause(watch, false);
    review_change(watch);
    return pause;
}

// The calls of a watcher --------------------------------------------------------------------------

static void begin(void *context, const struct watcher_run *run) {
    struct live_watch *watch = context;
    watch->run = *run;
    watch->last_clock = clock_seconds();
    watch->last_step = 0;
    watch->frame_step = UINT64_MAX;
    watch->paused = watch->changes = false;
    if (run->simulation) {
        mf_live_scratch_make(&watch->now);
        if (watch->now.path[0])
            mf_live_view_set_root(watch->view, LIVE_NOW,
                                  open(watch->now.path, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    }
    if (mf_live_view_show_folder(watch->view, run->folder, LIVE_RUNNING) != STATUS_OK)
        mf_live_view_set_phase(watch->view, LIVE_RUNNING, mf_status_message());
    if (run->unknowns)
        begin_fit(watch);
}

static void report(void *context, const struct watcher_progress *progress) {
    struct live_watch *watch = context;
    const uint64_t before = watch->last_step;
    if (watch->run.simulation) {
        if (before > 0 && watch->run.simulation->step == before)
            return; // told twice of one step
        find_rate(watch);
        publish_simulation(watch, watch->paused || progress->done == progress->total);
    }
    publish_progress(watch, progress);
    publish_candidate(watch, progress->candidate);
    const struct live_pause pause = apply_control(watch);
    if (watch->run.simulation && pause.speed > 0)
        keep_speed(watch, pause.speed, watch->last_step - before);
}

static void print(void *context, const char *line) {
    struct live_watch *watch = context;
    const size_t before = watch->log ? strlen(watch->log) : 0, size = before + strlen(line) + 2;
    char *log = realloc(watch->log, size);
    if (log == NULL)
        return;
    snprintf(log + before, size - before, "%s%s", before ? "\n" : "", line);
    const char *cut = size > LONGEST_LOG ? strchr(log + (size - LONGEST_LOG), '\n') : NULL;
    if (cut)
        memmove(log, cut + 1, strlen(cut));
    watch->log = log;
    mf_live_feed_push(&watch->view->feed, LIVE_LOG, log);
}

static void show_tables(void *context) {
    struct live_watch *watch = context;
    mf_live_view_write_tables(watch->view);
    if (watch->run.unknowns)
        publish_damping(watch);
}

static int64_t find_steps(void *context) {
    struct live_watch *watch = context;
    struct live_feed *feed = &watch->view->feed;
    const double speed = mf_live_control_speed_now(&watch->view->control);
    if (watch->paused)
        return 1;
    double interval = mf_live_feed_wants_particles(feed) ? drawn_interval
                      : mf_live_feed_streams(feed) > 0   ? looked_interval
                                                         : 0;
    const double rate = speed > 0 ? fmin(speed, watch->rate) : watch->rate;
    if (speed > 0 && interval == 0)
        interval = looked_interval;
    return interval > 0 ? 1 + (int64_t)(interval * rate) : 0;
}

static bool take_change(void *context, struct simulation_change *change) {
    struct live_watch *watch = context;
    const bool changes = watch->changes;
    *change = watch->change;
    watch->changes = false;
    return changes;
}

static bool take_damping(void *context, double *damping) {
    struct live_watch *watch = context;
    const bool changes = !isnan(watch->damping);
    if (!changes)
        return false;
    *damping = watch->damping;
    watch->damping = NAN;
    return true;
}

void mf_live_watch_init(struct live_watch *watch, struct live_view *view) {
    *watch = (struct live_watch){
        .view = view,
        .watcher = {watch, begin, report, print, show_tables, find_steps, take_change,
                    take_damping},
    };
}

void mf_live_watch_end(struct live_watch *watch) {
    watch->run = (struct watcher_run){0};
    if (watch->now.path[0] == '\0')
        return;
    mf_live_view_set_root(watch->view, LIVE_NOW, -1);
    mf_live_scratch_remove(&watch->now);
}

void mf_live_watch_clear(struct live_watch *watch) {
    mf_live_watch_end(watch);
    free(watch->bytes.bytes);
    free(watch->log);
    watch->bytes = (struct live_bytes){0};
    watch->log = NULL;
}
