// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_run.h"

#include "base/memory.h"
#include "scene/molecules_file.h"
#include "io/units.h"
#include "report/progress.h"
#include "trajectory/beads_file.h"
#include "trajectory/votca_map.h"
#include "work/measure_doubts.h"
#include "work/measure_output.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>

struct run {
    const struct measure_request *request;
    struct units units; ///< of the results
    struct progress progress;
    struct run_folder folder;
    struct input_files inputs;
    struct trajectory structure;
    struct scene_molecules molecules;
    struct composition types; ///< of their beads
    struct molecules_listing listing;
    struct mapping mapping;
    struct frames frames;
    struct measured measured;
    struct beads_file beads;
    bool told;       ///< what the first frame shows was, before the frames were read again
    double height;   ///< of the least box, where the first does not do for the range [nm]; else 0
    char drift[512]; ///< what changes along the trajectory; "": nothing
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
    if (request->map == NULL || !mf_votca_map_is(request->map))
        return request->map ? mf_input_files_add(&run->inputs, request->map) : STATUS_OK;
    const char *at = request->map;
    char file[VOTCA_MAP_PATH_SIZE];
    while (mf_votca_map_next(&at, file, sizeof file))
        TRY(mf_input_files_add(&run->inputs, file));
    return STATUS_OK;
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

/// The atoms of the trajectory, as the molecules' file knows them if it lists them.
static const struct structure *atoms_of(const struct run *run) {
    return run->listing.repeats > 0 ? &run->listing.structure : &run->structure.structure;
}

/// Beads are atoms whose types the molecules' file names.
static enum status take_atoms(struct run *run) {
    const struct measure_request *const request = run->request;
    const char *types[COMPOSITION_MAX_TYPES];
    double mass[COMPOSITION_MAX_TYPES];
    TRY(mf_molecules_file_masses(mass, &run->types, request->molecules,
                                 request->frames.options.units));
    for (int type = 0; type < run->types.types; type++)
        types[type] = run->types.name[type];
    return mf_mapping_init_atoms(&run->mapping, atoms_of(run), types, mass,
                                 (size_t)run->types.types, request->molecules);
}

/// Beads are what a map makes of atoms, or one a residue.
static enum status map_atoms(struct run *run) {
    struct mapping_plan plan;
    TRY(run->request->map ? mf_mapping_plan_read(&plan, run->request->map)
                          : mf_mapping_plan_default(&plan));
    const enum status status = mf_mapping_init(&run->mapping, &plan, atoms_of(run));
    mf_mapping_plan_clear(&plan);
    return status;
}

static enum status read_molecules(struct run *run) {
    const struct measure_request *const request = run->request;
    if (request->molecules == NULL)
        return STATUS_OK;
    mf_molecules_listing_clear(&run->listing);
    mf_scene_molecules_clear(&run->molecules);
    TRY(mf_molecules_file_read(&run->molecules, &run->types, request->molecules));
    return mf_molecules_listing_read(&run->listing, &run->molecules.molecules.topology,
                                     request->molecules, request->frames.options.units,
                                     &run->structure.structure, request->map != NULL);
}

/// Names, residues and masses are of -s alone, if it is given.
static enum status open_structure(struct run *run) {
    const char *const given = run->request->structure;
    const enum status status =
        mf_trajectory_open(&run->structure, structure_file(run), &run->request->frames.options);
    const bool says_what = structure_says_what(&run->structure.structure);
    if (status != STATUS_OK)
        return given ? mf_status_prefix(status, "-s") : status;
    if (given == NULL && !says_what && run->request->map == NULL)
        mf_measure_print_nameless(&run->progress, run->structure.file);
    if (given == NULL || says_what)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "-s: %s: the format \"%s\" says where atoms are, and not what: give a .gro, "
        ".pdb, .top, .psf or data file of LAMMPS of the same atoms",
        given, run->structure.format->name);
}

/// What the atoms are, which of them are beads, and what molecules there may be.
static enum status find_beads(struct run *run) {
    const struct measure_request *const request = run->request;
    if (request->structure == NULL)
        TRY(mf_frames_refuse_pipe(request->frames.file[0]));
    TRY(open_structure(run));
    TRY(read_molecules(run));
    TRY(request->molecules && !request->map ? take_atoms(run) : map_atoms(run));
    print_lines(&run->progress, &run->mapping.notes);
    return STATUS_OK;
}

/// The file of beads is outside of the folder, and a file that is there is somebody's.
static enum status open_beads(struct run *run, bool force) {
    const char *const path = run->request->beads;
    struct stat is;
    if (path == NULL)
        return STATUS_OK;
    TRY(mf_input_files_protect(&run->inputs, path));
    if (!force && lstat(path, &is) == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s is there: --force replaces it, --beads OTHER keeps it", path);
    return mf_beads_file_open(&run->beads, path, &run->mapping, &run->structure.structure);
}

/// The frames that were measured last, as beads.
static enum status add_beads(struct run *run, size_t count) {
    for (size_t k = 0; run->request->beads && k < count; k++)
        TRY(mf_beads_file_add(&run->beads, &run->measured.slot[k].beads));
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

/// What frames that are read again would tell again.
static void tell_first(struct run *run, size_t count) {
    mf_measure_doubt_interval(&run->progress, &run->frames, count);
    // Of several atoms, which bonds of fixed length may join to those of others.
    const bool parts = run->mapping.broken && run->mapping.beads < run->mapping.atoms;
    if (run->request->measured.force_cutoff > 0 && parts)
        mf_progress_print(&run->progress,
                          "mesofit: warning: --forces: beads are parts of their residues: bonds of "
                          "fixed length between them make their forces wrong; simulate the atoms "
                          "without constraints");
    mf_measure_doubts(&run->progress, run->frames.frame, run->mapping.beads,
                      run->request->frames.options.units);
    run->told = true;
}

static enum status begin_measuring(struct run *run) {
    struct measured_plan plan = run->request->measured;
    plan.height = run->height;
    plan.motion.expected = mf_frames_expected(&run->frames, MEASURED_MOTION_FRAMES);
    if (run->request->molecules)
        plan.molecules = (struct measured_molecules_plan){&run->molecules.molecules, &run->types,
                                                          run->request->molecules};
    return mf_measured_begin(&run->measured, &plan, &run->mapping, run->frames.frame);
}

static enum status read_again(struct run *run, size_t skip);

/// Pipes are read once.
static bool can_be_read_again(const struct frames *frames) {
    for (size_t k = 0; k < frames->plan.files; k++)
        if (frames->source[k].bytes == 0)
            return false;
    return true;
}

/// Ranges were chosen by the first frame, and boxes shrink: begin again with those of the least.
static enum status shorten_range(struct run *run, double least) {
    size_t count = 1;
    while (count > 0) {
        TRY(mf_frames_next(&run->frames, &count));
        least = mf_measured_height(run->frames.frame, count, least);
    }
    run->height = least;
    return read_again(run, run->frames.plan.skip);
}

/// What --begin and --end leave nothing of.
static enum status fail_without_frames(const struct frames *frames) {
    const char *const file = frames->plan.file[0];
    if (isnan(frames->earliest))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: no frame is left to be measured", file);
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: no frame is left to be measured: there are times from %.7g to "
                          "%.7g ps%s",
                          file, frames->earliest, frames->latest,
                          frames->goes_on ? " and later" : "");
}

static enum status read_frames(struct run *run) {
    size_t count;
    for (;;) {
        TRY(mf_frames_next(&run->frames, &count));
        if (count == 0)
            break;
        if (run->measured.mapping == NULL) {
            if (!run->told)
                tell_first(run, count);
            TRY(begin_measuring(run));
        }
        const double height = mf_measured_height(run->frames.frame, count, INFINITY);
        if (!mf_measured_fits(&run->measured, &run->request->measured, height) &&
            can_be_read_again(&run->frames) && run->height == 0)
            return shorten_range(run, height);
        TRY(mf_measured_add(&run->measured, run->frames.frame, count));
        TRY(add_beads(run, count));
        report(run);
    }
    return run->frames.used > 0 ? STATUS_OK : fail_without_frames(&run->frames);
}

/// "pairs A-B at 0.3 to 0.35 nm", "the volume".
static void print_slowest(const struct run *run, const struct frame_features_slowest *slowest,
                          char *text, size_t size) {
    const struct composition *const composition = &run->measured.pairs.composition;
    const double length = mf_units_factor(&run->units, "lambda");
    char name[COMPOSITION_PAIR_NAME_SIZE] = "", unit[UNITS_NAME_SIZE];
    if (composition_is_mixed(composition))
        mf_composition_pair_name(composition, slowest->pair, name);
    if (slowest->volume)
        snprintf(text, size, "the volume");
    else
        snprintf(text, size, "%s%s%s at %.3g to %.3g %s",
                 slowest->within ? "pairs within molecules" : "pairs", name[0] ? " " : "", name,
                 length * slowest->from, length * slowest->to,
                 mf_units_name(&run->units, "lambda", unit));
}

static enum status read_again(struct run *run, size_t skip) {
    struct frames_plan plan = run->request->frames;
    plan.skip = skip;
    mf_measured_clear(&run->measured);
    mf_frames_close(&run->frames);
    if (run->request->beads)
        TRY(mf_beads_file_restart(&run->beads));
    TRY(read_molecules(run)); // whose types have become those of the beads
    TRY(mf_frames_open(&run->frames, &plan, &run->structure.structure, structure_file(run)));
    return read_frames(run);
}

/// What goes on to the end is no beginning, and nothing can be left out.
static enum status tell_drift(struct run *run, size_t begin) {
    struct frame_features_slowest most;
    char what[128], unit[UNITS_NAME_SIZE];
    TRY(mf_frame_features_drift(&run->measured.features, &run->measured.pairs, begin, &most));
    if (!most.drifts)
        return STATUS_OK;
    print_slowest(run, &most, what, sizeof what);
    const double factor = most.volume ? mf_units_factor(&run->units, "lambda^d") : 1;
    snprintf(run->drift, sizeof run->drift,
             "the trajectory is not in equilibrium: %s: %.4g +- %.1g%s in the first %.0f %% of the "
             "frames, %.4g +- %.1g in the rest: use frames from where nothing changes any more "
             "(--begin), or simulate for longer",
             what, factor * most.drift.before, factor * most.drift.before_error,
             most.volume ? mf_units_suffix(&run->units, "lambda^d", unit) : " a frame",
             100 * most.drift.part, factor * most.drift.after, factor * most.drift.after_error);
    mf_progress_print(&run->progress, "mesofit: warning: %s", run->drift);
    return STATUS_OK;
}

/// What is not over where no more may be left out goes on.
static void tell_rest(struct run *run, size_t left_out, size_t frames, const char *what) {
    static const double most = 0.4;
    if (run->drift[0] || (double)left_out < most * (double)frames)
        return;
    snprintf(run->drift, sizeof run->drift,
             "the first %zu of %zu frames were not in equilibrium (%s), and the rest may still be "
             "on its way: simulate for longer",
             left_out, frames, what);
    mf_progress_print(&run->progress, "mesofit: warning: %s", run->drift);
}

/// Leave out what is before equilibrium, unless a person has said where to begin.
static enum status find_equilibrium(struct run *run) {
    const size_t frames = run->measured.frames;
    struct frame_features_slowest slowest;
    if (!run->measured.in_vacuum)
        mf_measure_doubt_few(&run->progress, frames);
    TRY(mf_frame_features_assess(&run->measured.features, &run->measured.pairs, &slowest));
    if (slowest.frames == 0)
        return tell_drift(run, 0);
    char what[128];
    print_slowest(run, &slowest, what, sizeof what);
    if (!isnan(run->request->frames.begin) || !can_be_read_again(&run->frames)) {
        mf_progress_print(&run->progress,
                          "mesofit: warning: the first %zu frames are not in equilibrium (%s): "
                          "--begin leaves them out",
                          slowest.frames, what);
        return tell_drift(run, slowest.frames);
    }
    mf_progress_print(&run->progress,
                      "the first %zu of %zu frames are not in equilibrium (%s) and are left out; "
                      "--begin 0 keeps them",
                      slowest.frames, frames, what);
    run->height = 0;
    TRY(read_again(run, slowest.frames));
    TRY(tell_drift(run, 0));
    tell_rest(run, slowest.frames, frames, what);
    return STATUS_OK;
}

static enum status write_results(struct run *run, bool interrupted) {
    mf_measured_end(&run->measured);
    TRY(mf_measured_forces_check(&run->measured, run->request->frames.file[0]));
    const struct measure_result result = {.request = run->request,
                                          .frames = &run->frames,
                                          .mapping = &run->mapping,
                                          .measured = &run->measured,
                                          .kinds = run->request->molecules ? &run->molecules : NULL,
                                          .units = run->units,
                                          .folder = run->folder.path,
                                          .drift = run->drift,
                                          .interrupted = interrupted,
                                          .seconds = mf_progress_seconds(&run->progress)};
    TRY(mf_run_folder_begin(&run->folder, 0));
    TRY(mf_run_folder_take_over(&run->folder));
    TRY(mf_measure_output_write(&result));
    mf_run_folder_draw(&run->folder);
    print_lines(&run->progress, &run->frames.notes);
    TRY(mf_measure_print(&run->progress, &result));
    if (run->request->beads) {
        TRY(mf_beads_file_commit(&run->beads));
        mf_progress_print(&run->progress, "beads of %zu frames in %s", run->beads.frames,
                          run->request->beads);
    }
    mf_progress_print(&run->progress, "%zu frame%s of %zu beads in %.3g s; results in %s",
                      run->measured.frames, run->measured.frames == 1 ? "" : "s",
                      run->mapping.beads, result.seconds, run->folder.path);
    mf_measure_print_next(&run->progress, &result);
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
    TRY(open_beads(run, options->force));
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

/// A map of VOTCA that has bonds tells of the molecules, too.
static enum status find_bonds_of_map(struct measure_request *request) {
    OWNED char *bonds = NULL;
    if (request->map && !request->molecules && mf_votca_map_is(request->map))
        TRY(mf_votca_map_bonds(&bonds, request->map));
    if (bonds)
        request->molecules = request->map;
    return STATUS_OK;
}

enum status mf_measure_run(const struct measure_request *request,
                           const struct run_options *options) {
    struct measure_request own = *request;
    struct run run = {.request = &own,
                      .units = mf_measured_units(request->system),
                      .progress = mf_progress_begin(options->quiet, options->watcher)};
    enum status status = find_bonds_of_map(&own);
    if (status == STATUS_OK)
        status = carry_out(&run, options);
    mf_beads_file_clear(&run.beads);
    mf_measured_clear(&run.measured);
    mf_molecules_listing_clear(&run.listing);
    mf_scene_molecules_clear(&run.molecules);
    mf_frames_close(&run.frames);
    mf_mapping_clear(&run.mapping);
    mf_trajectory_close(&run.structure);
    mf_input_files_clear(&run.inputs);
    mf_run_folder_close(&run.folder);
    return status;
}
