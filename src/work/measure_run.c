// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_run.h"

#include "base/number_text.h"
#include "scene/molecules_file.h"
#include "io/units.h"
#include "report/progress.h"
#include "work/measure_output.h"

#include <math.h>
#include <string.h>

struct run {
    const struct measure_request *request;
    struct progress progress;
    struct run_folder folder;
    struct input_files inputs;
    struct trajectory structure;
    struct scene_molecules molecules;
    struct composition types; ///< of their beads
    struct mapping mapping;
    struct frames frames;
    struct measured measured;
};

/// Every file that is read must be spared.
static enum status collect_inputs(struct run *run) {
    const struct measure_request *const request = run->request;
    for (size_t k = 0; k < request->frames.files; k++)
        TRY(mf_input_files_add(&run->inputs, request->frames.file[k]));
    if (request->structure)
        TRY(mf_input_files_add(&run->inputs, request->structure));
    if (request->molecules)
        TRY(mf_input_files_add(&run->inputs, request->molecules));
    return request->map ? mf_input_files_add(&run->inputs, request->map) : STATUS_OK;
}

static const char *structure_file(const struct run *run) {
    return run->request->structure ? run->request->structure : run->request->frames.file[0];
}

/// Lines of a text, one at a time.
static void print_lines(struct progress *progress, const struct bytes *notes) {
    const char *line = (const char *)notes->data;
    while (line && *line) {
        const char *const end = strchr(line, '\n');
        mf_progress_print(progress, "%.*s", (int)(end - line), line);
        line = end + 1;
    }
}

/// Beads are atoms whose types the molecules' file names.
static enum status take_atoms(struct run *run) {
    const char *types[COMPOSITION_MAX_TYPES];
    for (int type = 0; type < run->types.types; type++)
        types[type] = run->types.name[type];
    return mf_mapping_init_atoms(&run->mapping, &run->structure.structure, types,
                                 (size_t)run->types.types, run->request->molecules);
}

/// Beads are what a map makes of atoms, or one a residue.
static enum status map_atoms(struct run *run) {
    struct mapping_plan plan;
    TRY(run->request->map ? mf_mapping_plan_read(&plan, run->request->map)
                          : mf_mapping_plan_default(&plan));
    const enum status status = mf_mapping_init(&run->mapping, &plan, &run->structure.structure);
    mf_mapping_plan_clear(&plan);
    return status;
}

/// What the atoms are, which of them are beads, and what molecules there may be.
static enum status find_beads(struct run *run) {
    const struct measure_request *const request = run->request;
    if (request->molecules)
        TRY(mf_molecules_file_read(&run->molecules, &run->types, request->molecules));
    TRY(mf_trajectory_open(&run->structure, structure_file(run), &request->frames.options));
    TRY(request->molecules && !request->map ? take_atoms(run) : map_atoms(run));
    print_lines(&run->progress, &run->mapping.notes);
    return STATUS_OK;
}

static void report(struct run *run) {
    const struct frames *const frames = &run->frames;
    uint64_t done, total;
    char text[96];
    mf_frames_bytes(frames, &done, &total);
    if ((!run->progress.terminal && !run->progress.watcher) || total == 0 || done == 0)
        return;
    const double all = (double)frames->used * (double)total / (double)done;
    snprintf(text, sizeof text, "%zu frames", frames->used);
    mf_progress_report(&run->progress, frames->used, (uint64_t)fmax(all, (double)frames->used),
                       "frames", text);
}

/// Frames that are wanted further apart than they are come at common multiples of both times.
static void print_interval(struct run *run, size_t count) {
    static const double share = 0.01;
    const double every = run->request->frames.every;
    const struct trajectory_frame *const frame = run->frames.frame;
    const double interval = count > 1 ? frame[1].time - frame[0].time : every;
    if (every > 0 && fabs(interval / every - 1) > share)
        mf_progress_print(&run->progress,
                          "mesofit: warning: --every %g: frames %.6g ps apart are used, since "
                          "there are none between",
                          every, interval);
}

static enum status begin_measuring(struct run *run) {
    struct measured_plan plan = run->request->measured;
    plan.motion.expected = mf_frames_expected(&run->frames, MEASURED_MOTION_FRAMES);
    if (run->request->molecules)
        plan.molecules = (struct measured_molecules_plan){&run->molecules.molecules, &run->types,
                                                          run->request->molecules};
    return mf_measured_begin(&run->measured, &plan, &run->mapping, run->frames.frame);
}

static enum status read_frames(struct run *run) {
    size_t count;
    for (;;) {
        TRY(mf_frames_next(&run->frames, &count));
        if (count == 0)
            break;
        if (run->measured.mapping == NULL) {
            if (run->frames.plan.skip == 0)
                print_interval(run, count);
            TRY(begin_measuring(run));
        }
        TRY(mf_measured_add(&run->measured, run->frames.frame, count));
        report(run);
    }
    if (run->frames.used > 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: no frame is left to be measured",
                          run->request->frames.file[0]);
}

/// "pairs A-B at 0.3 to 0.35 nm", "the volume".
static void print_slowest(const struct run *run, const struct frame_features_slowest *slowest,
                          char *text, size_t size) {
    const struct composition *const composition = &run->measured.pairs.composition;
    char name[COMPOSITION_PAIR_NAME_SIZE] = "";
    if (composition_is_mixed(composition))
        mf_composition_pair_name(composition, slowest->pair, name);
    if (slowest->volume)
        snprintf(text, size, "the volume");
    else
        snprintf(text, size, "%s%s%s at %.3g to %.3g nm",
                 slowest->within ? "pairs within molecules" : "pairs", name[0] ? " " : "", name,
                 slowest->from, slowest->to);
}

/// Pipes are read once.
static bool can_be_read_again(const struct frames *frames) {
    for (size_t k = 0; k < frames->plan.files; k++)
        if (frames->source[k].bytes == 0)
            return false;
    return true;
}

static enum status read_again(struct run *run, size_t skip) {
    struct frames_plan plan = run->request->frames;
    plan.skip = skip;
    mf_measured_clear(&run->measured);
    mf_frames_close(&run->frames);
    if (run->request->molecules) { // whose types have become those of the beads
        mf_scene_molecules_clear(&run->molecules);
        TRY(mf_molecules_file_read(&run->molecules, &run->types, run->request->molecules));
    }
    TRY(mf_frames_open(&run->frames, &plan, &run->structure.structure, structure_file(run)));
    return read_frames(run);
}

/// Leave out what is before equilibrium, unless a person has said where to begin.
static enum status find_equilibrium(struct run *run) {
    struct frame_features_slowest slowest;
    TRY(mf_frame_features_assess(&run->measured.features, &run->measured.pairs, &slowest));
    if (slowest.frames == 0)
        return STATUS_OK;
    char what[128];
    print_slowest(run, &slowest, what, sizeof what);
    if (!isnan(run->request->frames.begin) || !can_be_read_again(&run->frames)) {
        mf_progress_print(&run->progress,
                          "mesofit: warning: the first %zu frames are not in equilibrium (%s): "
                          "--begin leaves them out",
                          slowest.frames, what);
        return STATUS_OK;
    }
    mf_progress_print(&run->progress,
                      "the first %zu of %zu frames are not in equilibrium (%s) and are left out; "
                      "--begin 0 keeps them",
                      slowest.frames, run->measured.frames, what);
    return read_again(run, slowest.frames);
}

/// How far beads go, and what is to be known of it: a periodic box slows D.
static void print_diffusion(struct run *run, const struct units *units) {
    const struct measured_motion *const motion = &run->measured.motion;
    const struct motion_summary s = mf_motion_result(&motion->motion, NULL);
    const double cm2 = mf_units_diffusion_cm2_per_s(units) * 1e5;
    char diffusion[NUMBER_TEXT_SIZE];
    mf_number_text(cm2 * s.msd, cm2 * s.msd_error, diffusion);
    mf_progress_print(&run->progress,
                      "D = %s 1e-5 cm^2/s by the MSD from %.4g to %.4g ps, for this box: a larger "
                      "one has a larger D, by 2.84 k_B T/(6 pi eta L) of a cube",
                      diffusion, s.fit_begin, s.fit_end);
    if (motion->path.differences)
        mf_progress_print(&run->progress,
                          "mesofit: warning: the VACF is of differences of positions over %.4g ps: "
                          "it is lower at short times, its integral is right",
                          2 * motion->interval);
    else if (motion->has_vacf && mf_motion_is_coarse(&s))
        mf_progress_print(
            &run->progress,
            "mesofit: warning: frames are too far apart for D by the VACF, %.3g 1e-5 "
            "cm^2/s: velocities lose %.0f %% of their correlation from one to the next",
            cm2 * s.green_kubo, 100 * s.vacf_drop);
}

static void print_motion(struct run *run, const struct units *units) {
    const struct measured_motion *const motion = &run->measured.motion;
    if (!motion->begun && !motion->plan.leave_out)
        mf_progress_print(&run->progress, "mesofit: warning: no motion, no escape times: %s",
                          run->measured.frames < 2 ? "there is one frame"
                                                   : "frames have no times (--file-time-step)");
    if (!motion->begun)
        return;
    if (mf_motion_blocks(&motion->motion) == 0)
        mf_progress_print(&run->progress,
                          "mesofit: warning: no motion, no escape times: %zu frames are no window "
                          "of %lld intervals (--window)",
                          motion->frames, (long long)motion->motion.plan.lags);
    else
        print_diffusion(run, units);
    const struct etd_grid *const grid = &motion->etd.grid;
    if (mf_etd_complete(&motion->etd) > 0 && mf_etd_pairs(&motion->etd) == 0)
        mf_progress_print(&run->progress,
                          "mesofit: warning: no escape times: no pair was between %.4g and %.4g nm",
                          grid->r_minimum, grid->r_maximum);
    else
        mf_progress_print(
            &run->progress, "escape times of pairs from %.4g to %.4g nm, in windows of %.4g ps",
            grid->r_minimum, grid->r_maximum, (double)(grid->times - 1) * motion->interval);
    if (!motion->has_vacf && motion->plan.velocities == MEASURED_VELOCITIES_USUAL)
        mf_progress_print(&run->progress, "no VACF: there are no velocities (--velocities "
                                          "differences makes them of positions)");
}

/// The first atom of each bead of the first molecule of a kind, counted from 1.
static bool list_atoms(const struct run *run, const struct topology_kind *kind, char *text,
                       size_t size) {
    const struct mapping *const mapping = &run->mapping;
    bool sorted = true;
    size_t length = 0, last = 0;
    for (int n = 0; n < kind->beads && length < size; n++) {
        const size_t bead = run->measured.molecules.match.bead[topology_id(kind, 0, n)];
        const size_t atom = mapping->atom[mapping->bead[bead].first] + 1;
        length += (size_t)snprintf(text + length, size - length, n ? ", %zu" : "%zu", atom);
        sorted = sorted && atom > last;
        last = atom;
    }
    return sorted;
}

/// Types in another order than that of the trajectory may be meant, or a slip: bonds show it.
static void print_order(struct run *run) {
    const struct topology *const topology = &run->molecules.molecules.topology;
    char text[256];
    for (int k = 0; run->request->map && k < topology->kinds; k++)
        if (!list_atoms(run, &topology->kind[k], text, sizeof text))
            mf_progress_print(
                &run->progress,
                "%s: its beads are not in the order of the atoms: they begin with the "
                "atoms %s",
                topology->kind[k].name, text);
}

static void print_molecules(struct run *run, const struct measure_result *result) {
    const struct observable_results results = {.units = &result->units};
    const struct observable_use *use = run->measured.molecules.use;
    char line[256];
    print_order(run);
    for (; use->observable; use++) {
        if (use->observable->print == NULL)
            continue;
        use->observable->print(use->state, &results, line, sizeof line);
        mf_progress_print(&run->progress, "%s", line);
    }
}

/// Bonds and angles that a fit takes a law for.
static enum status print_constraints(struct run *run) {
    const struct molecules *const molecules = run->measured.molecules.molecules;
    for (int order = 0; molecules && order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            struct bonded_moments found;
            TRY(mf_measured_molecules_moments(&run->measured.molecules, order, g, &found));
            if (!mf_bonded_distribution_is_constrained(order, &found))
                continue;
            const char *const unit = mf_bonded_kinds[order]->is_length ? "nm" : "degrees";
            mf_progress_print(
                &run->progress,
                "%s \"%s\": a constraint (standard deviation %.2g, mean %.4g %s): a fit replaces "
                "it by a harmonic potential with a standard deviation of %.2g %s",
                mf_bonded_kinds[order]->name, molecules->group[order][g].name, found.deviation,
                found.mean, unit, mf_bonded_distribution_narrow(order, found.mean), unit);
        }
    return STATUS_OK;
}

static void print_pairs(struct run *run) {
    const struct measured *const measured = &run->measured;
    mf_progress_print(&run->progress, "g(r) to %.4g nm in %lld bins%s", measured->plan.range,
                      (long long)measured->plan.bins,
                      measured->pairs.within     ? ", without pairs that molecules exclude"
                      : measured->pairs.molecule ? ", without pairs of one molecule or residue"
                                                 : "");
    if (mf_rdf_observable.assess(&measured->rdf, NULL) != STATUS_OK)
        mf_progress_print(&run->progress, "mesofit: warning: %s", mf_status_message());
    if (measured->plan.q_maximum > 0)
        mf_progress_print(&run->progress, "S(q) to %.4g 1/nm, of at most %lld waves in a bin",
                          measured->plan.q_maximum, (long long)measured->plan.waves);
}

/// What a person is to know.
static void print_results(struct run *run, const struct measure_result *result) {
    const struct measured *const measured = &run->measured;
    if (mf_measure_output_is_alone(result))
        mf_progress_print(&run->progress,
                          measured->in_vacuum
                              ? "there is no box: molecules alone are measured, no g(r), no motion"
                              : "a single molecule: its g(r) is intramolecular and no target; "
                                "bonds, angles and dihedrals are");
    if (!measured->in_vacuum)
        print_pairs(run);
    if (measured->pairs.molecule && result->kinds == NULL)
        mf_progress_print(
            &run->progress,
            "mesofit: warning: molecules have several beads: without --molecules a fit has no "
            "bonds; g(r) is of different molecules alone, no target of a fit that has them");
    print_molecules(run, result);
    if (!measured->in_vacuum)
        print_motion(run, &result->units);
    if (measured->motion.begun && mf_measure_output_masses_differ(result))
        mf_progress_print(&run->progress, "masses of beads differ: target.json has motion compared "
                                          "with and not fitted, since friction is for one mass");
    if (isnan(run->request->temperature) && measured->motion.temperature.count == 0)
        mf_progress_print(
            &run->progress,
            "unknown temperature%s: give it by --temperature, or in \"scene\" of target.json",
            run->mapping.broken ? " by parts of molecules" : "");
}

static enum status write_results(struct run *run, bool interrupted) {
    mf_measured_motion_end(&run->measured.motion);
    mf_measured_molecules_end(&run->measured.molecules);
    const struct measure_result result = {.request = run->request,
                                          .frames = &run->frames,
                                          .mapping = &run->mapping,
                                          .measured = &run->measured,
                                          .kinds = run->request->molecules ? &run->molecules : NULL,
                                          .units = mf_measured_units(run->request->system),
                                          .folder = run->folder.path,
                                          .interrupted = interrupted,
                                          .seconds = mf_progress_seconds(&run->progress)};
    TRY(mf_run_folder_begin(&run->folder, 0));
    TRY(mf_run_folder_take_over(&run->folder));
    TRY(mf_measure_output_write(&result));
    mf_run_folder_draw(&run->folder);
    print_lines(&run->progress, &run->frames.notes);
    print_results(run, &result);
    TRY(print_constraints(run));
    mf_progress_print(&run->progress, "%zu frames of %zu beads in %.3g s; results in %s",
                      run->measured.frames, run->mapping.beads, result.seconds, run->folder.path);
    return STATUS_OK;
}

/// --file-units is for the trajectory or for the structure: one of them must want it.
static enum status check_units(const struct run *run) {
    const struct trajectory *const trajectory = &run->frames.trajectory;
    if (run->request->frames.options.units == NULL ||
        run->structure.format->unit_source != TRAJECTORY_OWN_UNITS ||
        trajectory->format->unit_source != TRAJECTORY_OWN_UNITS)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: the format \"%s\" defines its units: leave out --file-units",
                          trajectory->file, trajectory->format->name);
}

static enum status prepare(struct run *run, const struct run_options *options) {
    TRY(collect_inputs(run));
    TRY(find_beads(run));
    TRY(mf_frames_open(&run->frames, &run->request->frames, &run->structure.structure,
                       structure_file(run)));
    TRY(check_units(run));
    return mf_run_folder_open(&run->folder, RUN_MEASUREMENT, run->request->frames.file[0],
                              &run->inputs, options);
}

/// What was measured before a wish to stop is a measurement, too.
static enum status carry_out(struct run *run, const struct run_options *options) {
    TRY(prepare(run, options));
    enum status status = read_frames(run);
    if (status == STATUS_OK)
        status = find_equilibrium(run);
    const bool interrupted = status == STATUS_INTERRUPTED && run->measured.frames > 0;
    if (status != STATUS_OK && !interrupted)
        return status;
    TRY(write_results(run, interrupted));
    return !interrupted ? STATUS_OK
                        : mf_status_fail(STATUS_INTERRUPTED,
                                         "interrupted after %zu frames, whose results are in %s",
                                         run->measured.frames, run->folder.path);
}

enum status mf_measure_run(const struct measure_request *request,
                           const struct run_options *options) {
    struct run run = {.request = request,
                      .progress = mf_progress_begin(options->quiet, options->watcher)};
    const enum status status = carry_out(&run, options);
    mf_measured_clear(&run.measured);
    mf_scene_molecules_clear(&run.molecules);
    mf_frames_close(&run.frames);
    mf_mapping_clear(&run.mapping);
    mf_trajectory_close(&run.structure);
    mf_input_files_clear(&run.inputs);
    mf_run_folder_close(&run.folder);
    return status;
}
