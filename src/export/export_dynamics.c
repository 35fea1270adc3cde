// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_dynamics.h"

#include "export/export_engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A bath -----------------------------------------------------------------------------------------

/// ω² of a table at r, or 0.
static double friction_at(const struct table *omega, double r) {
    double value = 0;
    if (omega && r < omega->cutoff)
        mf_table_evaluate_pair(omega, 0, r, &value, NULL, NULL);
    return value * value;
}

double mf_export_slowing(const struct export_job *job) {
    enum { POINTS = 1000 };
    const struct simulation_setup *setup = &job->model->setup;
    const struct table *across = export_model_across(job->model);
    const double density = (double)job->model->count / mf_box_volume(&setup->box);
    const int dimensions = setup->box.dimensions;
    const double reach = fmax(setup->omega ? setup->omega->cutoff : 0, across ? across->cutoff : 0);
    double friction = 0;
    for (int k = 0; k < POINTS && reach > 0; k++) {
        const double width = reach / POINTS, r = (k + 0.5) * width;
        double phi;
        mf_table_evaluate_pair(setup->potential, 0, r, &phi, NULL, NULL);
        friction += density * mf_box_shell_volume(&setup->box, r - width / 2, r + width / 2) *
                    (friction_at(setup->omega, r) + (dimensions - 1) * friction_at(across, r)) *
                    fmin(1, exp(-phi / setup->temperature)) / dimensions;
    }
    return friction > 0 ? job->model->mass[0] / friction : 100 * job->time_step;
}

// What runs ---------------------------------------------------------------------------------------

const char *mf_export_dynamics_friction(const struct export_job *job) {
    return job->engine->friction != EXPORT_POWER ? job->engine->friction_name
           : mf_export_is_linear(job) && !export_model_across(job->model) ? "dpd/tstat"
                                                                          : "dpd/ext/tstat";
}

/// Whether the engine can express the friction at all.
static bool can_express(const struct export_job *job) {
    switch (job->engine->friction) {
    case EXPORT_NO_FRICTION:
        return false;
    case EXPORT_LINEAR:
        return mf_export_is_linear(job);
    case EXPORT_POWER:
    case EXPORT_RISING:
        return mf_export_is_power(job);
    }
    return false;
}

/// What was asked for by --project runs of its own; else what is sure to run here does.
static enum export_motion choose(const struct export_job *job) {
    if (job->engine->bath == NULL)
        return EXPORT_TABLES_ALONE;
    if (!can_express(job))
        return EXPORT_BATH;
    if (job->projected)
        return EXPORT_PROJECTED;
    return job->engine->ask && job->here != EXPORT_HERE ? EXPORT_BATH : EXPORT_OWN_FRICTION;
}

bool mf_export_dynamics_pairs(const struct export_job *job) {
    return job->runs == EXPORT_OWN_FRICTION || job->runs == EXPORT_PROJECTED;
}

static enum status measure(struct export_job *job, const struct export_request *request) {
    const struct export_substitute substitute = {job->runs == EXPORT_PROJECTED ? job->power : NULL,
                                                 job->across, 1 / mf_export_slowing(job)};
    const enum status status =
        mf_export_project(job->model, &substitute, job->runs != EXPORT_PROJECTED, request->threads,
                          request->listener, &job->projection);
    if (job->runs == EXPORT_PROJECTED || status == STATUS_OK || status == STATUS_INTERRUPTED ||
        status == STATUS_NO_MEMORY) {
        job->measured = status == STATUS_OK;
        return status;
    }
    snprintf(job->unmeasured, sizeof job->unmeasured, "%s", mf_status_message());
    return STATUS_OK;
}

enum status mf_export_dynamics_find(struct export_job *job, const struct export_request *request) {
    job->here = can_express(job) && job->engine->ask ? job->engine->ask(job) : EXPORT_NOT_ASKED;
    job->runs = choose(job);
    if (job->runs == EXPORT_BATH && job->model->thermostat)
        return STATUS_OK; // what moves is no result
    return job->runs == EXPORT_PROJECTED || (job->runs == EXPORT_BATH && request->dynamics)
               ? measure(job, request)
               : STATUS_OK;
}

// The block ---------------------------------------------------------------------------------------

static void print_friction(const struct export_job *job, const char *prefix, FILE *stream) {
    const bool lost = export_model_has_friction(job->model);
    fprintf(stream, "%sfriction   ", prefix);
    if (job->runs == EXPORT_TABLES_ALONE)
        fprintf(stream, "none: the tables are of the potential alone%s\n",
                lost ? "; the friction of the result is left out" : "");
    else if (job->runs == EXPORT_OWN_FRICTION)
        fprintf(stream, "%s: %s, with a misfit of %.2g\n",
                lost ? "that of the result" : "no result, but chosen to hold the temperature",
                mf_export_dynamics_friction(job), job->worst_misfit);
    else if (job->runs == EXPORT_PROJECTED)
        fprintf(stream, "the nearest that %s has: %s, with a misfit of %.2g\n", job->engine->title,
                mf_export_dynamics_friction(job), job->worst_misfit);
    else
        fprintf(stream, "%s: a Langevin bath of each bead, %s, m/gamma = %.4g %s%s\n",
                !lost ? job->model->thermostat ? "no result, but chosen to hold the temperature"
                                               : "the result has none"
                : can_express(job) ? "by default NOT that of the result (see \"package\")"
                                   : "NOT that of the result",
                job->engine->bath, mf_export_slowing(job) * job->units.time, job->units.time_name,
                lost ? "; omega(r), conserved momentum and flow are left out" : "");
}

static void print_number(FILE *stream, const struct export_number *number, double factor) {
    fprintf(stream, "%.4g", factor * number->value);
    if (isfinite(number->error))
        fprintf(stream, " +- %.2g", factor * number->error);
}

/// D, as the fit prints it: in the units of the run file, whatever those of the engine are.
static void print_diffusion(FILE *stream, const struct export_job *job,
                            const struct export_number *number) {
    const struct units *units = &job->model->scene.units;
    char unit[UNITS_NAME_SIZE];
    print_number(stream, number, mf_units_factor(units, "lambda^2/tau"));
    fprintf(stream, "%s", mf_units_suffix(units, "lambda^2/tau", unit));
}

/// How much faster or slower, if the errors show it.
static void print_change(FILE *stream, const struct export_number *here,
                         const struct export_number *there) {
    const double change = there->value / here->value - 1;
    const double error = fabs(there->value / here->value) *
                         hypot(here->error / here->value, there->error / there->value);
    if (fabs(change) <= 2 * error || isnan(error))
        fprintf(stream, ", alike within the errors");
    else
        fprintf(stream, ", %.0f(%.0f) %% %s", 100 * fabs(change), fmax(1, 100 * error),
                change > 0 ? "higher" : "lower");
}

/// D of the result that its folder has is the only one: of what runs there it is told how much
/// higher the MSD's slope is, as that of the times of two short simulations may be another one.
static void print_measured(const struct export_job *job, const char *prefix, FILE *stream) {
    const struct export_projection *p = &job->projection;
    const struct units *units = &job->model->scene.units;
    const struct export_number *own = &p->result.diffusion, *there = &p->projected.diffusion;
    const struct export_number *known = &job->model->diffusion;
    const double diffusion = mf_units_factor(units, "lambda^2/tau");
    const double time = mf_units_factor(units, "tau");
    char name[UNITS_NAME_SIZE];
    const bool both = isfinite(own->value), has_own = isfinite(known->value);
    mf_units_name(units, "tau", name);
    fprintf(stream, "%sD          ", prefix);
    if (both || has_own) {
        print_diffusion(stream, job, has_own ? known : own);
        fprintf(stream, " of the result, ");
    }
    if (!both || !has_own) {
        print_diffusion(stream, job, there);
        fprintf(stream, " ");
    }
    fprintf(stream, "%s", job->runs == EXPORT_BATH ? "in that bath" : "by that friction");
    if (both)
        print_change(stream, own, there);
    const double window = time * p->interval * (EXPORT_TIMES - 1);
    fprintf(stream, " (by slopes of the MSD from %.3g to %.3g %s", window / 2, window, name);
    if (both)
        fprintf(stream, ", %.3g and there %.3g", diffusion * own->value, diffusion * there->value);
    fprintf(stream, ", simulated by mesofit for %.3g %s%s)\n",
            time * (double)p->steps * job->model->setup.time_step, name, both ? " each" : "");
    if (isfinite(p->rms))
        fprintf(stream,
                "%sE(t, r_0)  to t = %.4g %s: rms of the difference %.2g; statistical noise alone "
                "gives %.2g\n",
                prefix, window, name, p->rms, p->noise);
}

const char *mf_export_dynamics_kept(const struct export_job *job) {
    if (job->model->partial)
        return "It samples the forces that are here at their\ntemperature.";
    return export_model_has_friction(job->model)
               ? "It keeps g(r), energy and pressure; the dynamics\nis not the result's: diffusion "
                 "and all else that moves differs."
               : "It keeps g(r), energy and pressure,\nwhich is all that the result knows: of what "
                 "moves nothing was fitted.";
}

/// What would carry the friction, if it is not carried.
static void print_instead(const struct export_job *job, const char *prefix, FILE *stream) {
    const struct export_engine *engine = job->engine;
    const bool across = export_model_across(job->model) != NULL;
    const bool has = export_model_has_friction(job->model) && !job->model->remembers;
    if (engine->advise && has)
        engine->advise(job, prefix, stream);
    if (!has || job->runs == EXPORT_OWN_FRICTION || job->projected || can_express(job))
        return;
    if (across && !engine->across)
        fprintf(stream,
                "%sinstead    LAMMPS (dpd/ext/tstat) and ESPResSo have friction across pairs, "
                "too\n",
                prefix);
    else if (engine->friction == EXPORT_NO_FRICTION)
        fprintf(
            stream,
            "%sinstead    LAMMPS, HOOMD-blue, ESPResSo and OpenMM have friction between pairs\n",
            prefix);
    else if (across)
        fprintf(stream, "%sinstead    export --project writes the nearest that %s has\n", prefix,
                engine->title);
    else
        fprintf(stream,
                "%sinstead    mesofit fit --friction %s finds an omega that %s has; export "
                "--project writes the nearest to this one\n",
                prefix, engine->friction == EXPORT_POWER ? "exportable" : "linear", engine->title);
}

void mf_export_dynamics_print(const struct export_job *job, const char *prefix, FILE *stream) {
    fprintf(stream, "%sWhat of the dynamics goes to %s:\n", prefix, job->engine->title);
    fprintf(stream, "%sstructure  phi as tables: %s\n", prefix,
            job->model->partial ? "alone, without what else the engine of the fit had"
                                : "g(r), energy and pressure are those of the result");
    mf_export_densities_print(&job->densities, job->model, &job->units, prefix, stream);
    print_friction(job, prefix, stream);
    if (job->measured)
        print_measured(job, prefix, stream);
    else if (job->unmeasured[0])
        fprintf(stream, "%sD          not measured of what runs there: %s\n", prefix,
                job->unmeasured);
    if (!job->measured && !job->model->thermostat && isfinite(job->model->diffusion.value)) {
        fprintf(stream, "%sD          ", prefix);
        print_diffusion(stream, job, &job->model->diffusion);
        fprintf(stream, " of the result\n");
    }
    if (!job->measured && !job->unmeasured[0] && !job->model->thermostat &&
        job->runs == EXPORT_BATH)
        fprintf(stream, "%sdiffusion  export --dynamics simulates what D is in that bath\n",
                prefix);
    print_instead(job, prefix, stream);
}

/// Lines of a text, one at a time.
static void print_lines(char *text, struct progress *to) {
    for (char *rest, *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        mf_progress_print(to, "%s", line);
}

void mf_export_dynamics_tell(const struct export_job *job, struct progress *progress) {
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL)
        return;
    mf_export_dynamics_print(job, "  ", stream);
    fclose(stream);
    print_lines(text, progress);
    free(text);
}

// A projection ------------------------------------------------------------------------------------

/// What both simulations found, in the units of the engine but for D.
static void print_cost(const struct export_job *job, FILE *stream) {
    const struct export_projection *p = &job->projection;
    const struct export_units *units = &job->units;
    const struct export_measured *const both[] = {&p->result, &p->projected};
    static const char *const names[] = {"omega of the result", "what stands for it "};
    for (int k = 0; k < 2; k++) {
        fprintf(stream, "    %s: temperature %.6g +- %.2g %s, slope of the MSD ", names[k],
                units->temperature * both[k]->temperature.value,
                units->temperature * both[k]->temperature.error, units->temperature_name);
        print_diffusion(stream, job, &both[k]->diffusion);
        fprintf(stream, "\n");
    }
    fprintf(stream,
            "    E(t, r_0) to t = %.4g %s, r_0 < %.4g %s: rms of the difference %.2g; statistical "
            "noise alone gives %.2g\n",
            units->time * p->interval * (EXPORT_TIMES - 1), units->time_name,
            units->length * p->r_maximum, units->length_name, p->rms, p->noise);
}

void mf_export_dynamics_explain(const struct export_job *job, FILE *stream) {
    fprintf(stream,
            "\nOmega is replaced by the law above (--project). The effect, by two simulations "
            "of mesofit\nof %lld steps each, with standard errors; projection.tsv has both E:\n\n",
            (long long)job->projection.steps);
    print_cost(job, stream);
}

void mf_export_dynamics_escapes(const struct export_job *job, FILE *stream) {
    const struct export_projection *p = &job->projection;
    const struct export_measured *a = &p->result, *b = &p->projected;
    fprintf(stream,
            "# t[%s]\tr_0[%s]\tresult[1]\tresult_error[1]\tprojected[1]\tprojected_error[1]\n",
            job->units.time_name, job->units.length_name);
    for (int k = 0; k < EXPORT_TIMES * EXPORT_BINS; k++) {
        const int time = k / EXPORT_BINS, bin = k % EXPORT_BINS;
        if (isfinite(a->survival[k] + b->survival[k]))
            fprintf(stream, "%.6g\t%.6g\t%.6g\t%.2g\t%.6g\t%.2g\n",
                    time * p->interval * job->units.time,
                    (bin + 0.5) / EXPORT_BINS * p->r_maximum * job->units.length, a->survival[k],
                    a->error[k], b->survival[k], b->error[k]);
    }
}
