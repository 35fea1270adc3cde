// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS: the potentials as tables, an input that is the user's or ours, frames as text with nine
// digits, which all builds of LAMMPS write, and pressure and energies of the same steps.
#include "base/memory.h"
#include "engines/engine.h"
#include "engines/engine_folder.h"
#include "engines/engine_model.h"
#include "engines/lammps_input.h"
#include "export/export_lammps_molecules.h"
#include "export/export_start.h"
#include "io/data_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char frames_name[] = "frames.lammpstrj", numbers_name[] = "numbers.txt",
                  last_name[] = "last.lammpstrj", input_name[] = "in.mesofit";

/// What all pieces share.
struct shared {
    struct export_model model; ///< of the scene, as it begins
    const char *input;         ///< name of the user's input; NULL: it is ours
    struct lammps_input files; ///< of it
};

/// A piece as it is written.
struct job {
    struct export_job export;
    struct export_model model;
    const struct engine_run *run;
    const struct engine_piece *piece;
    char before[OUTPUT_PATH_SIZE]; ///< folder of the piece before
};

// The input ---------------------------------------------------------------------------------------

/// All that is exchanged is in these units.
static enum status check_units(const struct engine_run *run, const struct lammps_input *input) {
    const bool real = mf_units_known(&run->fit->scene.units);
    if (input->units[0] == '\0' || strcmp(input->units, real ? "real" : "lj") == 0)
        return STATUS_OK;
    const bool other = strcmp(input->units, real ? "lj" : "real") == 0;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: its units are %s where the run file %s: write `units %s` there%s",
                          run->settings->input, input->units,
                          real ? "has \"units\"" : "has no \"units\"", real ? "real" : "lj",
                          !other ? ""
                          : real ? ", or leave \"units\" out of the run file"
                                 : ", or give \"units\" in the run file");
}

/// The input of a user. What it says must not change while a fit goes on.
static enum status check_input(const struct engine_run *run, struct shared *shared) {
    const char *file = run->settings->input, *slash = strrchr(file, '/');
    char folder[OUTPUT_PATH_SIZE], path[OUTPUT_PATH_SIZE];
    unsigned long long before = 0;
    TRY(mf_lammps_input_read(&shared->files, file));
    TRY(check_units(run, &shared->files));
    shared->input = slash ? slash + 1 : file;
    mf_engine_path(run->folder, "engine", folder);
    mf_engine_path(folder, "inputs", path);
    FILE *kept = fopen(path, "r");
    const bool known = kept && fscanf(kept, "%llx", &before) == 1;
    if (kept)
        fclose(kept);
    if (known && before != shared->files.digest)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: it, or a file that it reads, has changed since the fit began: "
                              "begin anew with --force, or change it back",
                              file);
    char text[32];
    snprintf(text, sizeof text, "%llx\n", (unsigned long long)shared->files.digest);
    return mf_engine_write_text(folder, "inputs", text);
}

static void print_data(const void *job, FILE *stream) {
    mf_export_lammps_print_data(job, stream);
}

/// Where the scene begins, for all replicas; kept, so that a fit that goes on has it, too.
static enum status write_data(const struct engine_run *run, const struct shared *shared) {
    char folder[OUTPUT_PATH_SIZE], path[OUTPUT_PATH_SIZE];
    struct stat found;
    mf_engine_path(run->folder, "engine", folder);
    mf_engine_path(folder, "data.mesofit", path);
    if (stat(path, &found) == 0)
        return STATUS_OK;
    const struct export_job job = {.model = &shared->model,
                                   .units =
                                       mf_export_units(EXPORT_REAL, &run->fit->scene.units, false)};
    return mf_engine_write(folder, "data.mesofit", print_data, &job);
}

static void forget(struct engine_run *run) {
    struct shared *shared = run->own;
    if (shared == NULL)
        return;
    for (int d = 0; d < 3; d++) {
        mf_memory_free(shared->model.position[d]);
        mf_memory_free(shared->model.velocity[d]);
        mf_memory_free(shared->model.image[d]);
    }
    mf_memory_free(shared);
}

static enum status prepare(struct engine_run *run, const struct engine_piece *piece) {
    struct shared *shared = mf_memory_zeroed(1, sizeof *shared);
    char folder[OUTPUT_PATH_SIZE];
    if (shared == NULL)
        return STATUS_NO_MEMORY;
    run->own = shared;
    if (run->settings->input[0])
        return check_input(run, shared);
    mf_engine_model(run, piece, &shared->model);
    shared->model.scene.start = run->fit->scene.start;
    TRY(mf_export_start_find(&shared->model));
    mf_engine_path(run->folder, "engine", folder);
    return write_data(run, shared);
}

// Files of a piece --------------------------------------------------------------------------------

static void print_table(const void *memory, FILE *stream) {
    mf_export_lammps_print_table(&((const struct job *)memory)->export, stream);
}

/// The number or label of a type there.
static const char *type_name(const struct job *job, int type, char number[12]) {
    const char *called = job->run->settings->type[type];
    snprintf(number, 12, "%d", type + 1);
    return called[0] ? called : number;
}

/// Pairs of types as LAMMPS wants them, the smaller number first.
static void print_pair(const struct job *job, int pair, const char *style, FILE *stream) {
    int type[2];
    char name[COMPOSITION_PAIR_NAME_SIZE], number[2][12];
    mf_export_model_pair(&job->model, pair, type, name);
    const char *a = type_name(job, type[0], number[0]), *b = type_name(job, type[1], number[1]);
    const bool turned = atoi(a) > atoi(b) && atoi(b) > 0;
    fprintf(stream, "pair_coeff %s %s %s mesofit.table PHI_%s\n", turned ? b : a, turned ? a : b,
            style, name);
}

/// Where interactions are set.
static void print_interactions(const void *memory, FILE *stream) {
    const struct job *job = memory;
    const struct shared *shared = job->run->own;
    const bool own_style = shared->input && shared->files.sets_style;
    fprintf(stream, "# written by mesofit\n");
    if (!own_style)
        fprintf(stream, "pair_style table linear %zu\n", job->export.grids.grid[0][0].rows);
    if (shared->input && job->piece->molecules) {
        mf_export_lammps_styles(&job->export, stream);
        mf_export_lammps_coefficients(&job->export, stream);
    }
    for (int pair = 0; pair < job->export.grids.pairs; pair++)
        if (!shared->input || mf_targets_have_pair(&job->run->fit->problem.targets, (size_t)pair))
            print_pair(job, pair, own_style && shared->files.is_hybrid ? "table" : "", stream);
}

/// A seed as LAMMPS takes it, for each piece another.
static unsigned seed_of(const struct engine_piece *piece) {
    enum { MOST = 899999999, STRIDE = 7919 };
    return (unsigned)((piece->seed % MOST + STRIDE * piece->number) % MOST) + 1;
}

/// Where the run would stand.
static void print_run(const void *memory, FILE *stream) {
    const struct job *job = memory;
    const struct engine_piece *piece = job->piece;
    const bool own = ((const struct shared *)job->run->own)->input == NULL;
    const unsigned long long every = engine_steps(job->run, piece->every);
    fprintf(stream, "# written by mesofit: replica %zu, piece %llu\n", piece->replica + 1,
            (unsigned long long)piece->number);
    if (!piece->fresh)
        fprintf(stream, "read_dump '%s/%s' 0 x y z vx vy vz ix iy iz box yes replace yes\n",
                job->before, last_name);
    else if (own) // where it begins chains may touch
        fprintf(stream, "minimize 1e-3 0 100 1000\nvelocity all create %.12g %u dist gaussian\n",
                piece->temperature * job->export.units.temperature, seed_of(piece));
    if (piece->lead > 0)
        fprintf(stream, "run %llu\n", (unsigned long long)engine_steps(job->run, piece->lead));
    fprintf(stream, "reset_timestep 0\n");
    if (!own)
        fprintf(stream, "compute mesofit_table all pair table epair\n");
    fprintf(
        stream,
        "variable mesofit_temp equal temp\nvariable mesofit_press equal press\n"
        "fix mesofit_numbers all ave/time %llu 1 %llu v_mesofit_temp v_mesofit_press %s file %s "
        "format \" %%.10g\"\n",
        every, every, own ? "c_thermo_pe" : "c_mesofit_table", numbers_name);
    fprintf(stream,
            "dump mesofit_frames all custom %llu %s id type x y z\n"
            "dump_modify mesofit_frames format float %%.9g\nrun %llu\n"
            "unfix mesofit_numbers\nundump mesofit_frames\nreset_timestep 0\n"
            "write_dump all custom %s id type x y z vx vy vz ix iy iz modify sort id format float "
            "%%.17g\n",
            every, frames_name, every * (unsigned long long)piece->frames, last_name);
}

/// The whole input of a scene.
static void print_input(const void *memory, FILE *stream) {
    const struct job *job = memory;
    const struct export_units *units = &job->export.units;
    const double temperature = job->piece->temperature * units->temperature;
    mf_export_lammps_print_system(&job->export, stream);
    fprintf(stream,
            "include mesofit.lmp\nfix bath all langevin %.12g %.12g %.6g ${seed} zero yes\n"
            "fix move all nve\n%stimestep %.9g\nthermo 1000\ninclude mesofit-run.lmp\n",
            temperature, temperature, mf_export_slowing(&job->export) * units->time,
            job->model.setup.box.dimensions == 2 ? "fix flat all enforce2d\n" : "",
            job->export.time_step * units->time);
}

static enum status link_data(const char *folder) {
    char link[OUTPUT_PATH_SIZE];
    mf_engine_path(folder, "data.mesofit", link);
    return symlink("../../data.mesofit", link) == 0
               ? STATUS_OK
               : mf_status_fail(STATUS_IO, "%s: cannot make the link", link);
}

/// What the input reads beside it. Nothing else is there, so that it can write what it likes.
static enum status link_inputs(const struct job *job, const char *folder) {
    const struct shared *shared = job->run->own;
    for (size_t k = 0; k < shared->files.files; k++)
        TRY(mf_engine_folder_link(folder, job->run->settings->input, shared->files.file[k]));
    return STATUS_OK;
}

static enum status write_files(const struct job *job, const char *folder) {
    const struct shared *shared = job->run->own;
    TRY(mf_engine_write(folder, "mesofit.table", print_table, job));
    TRY(mf_engine_write(folder, "mesofit.lmp", print_interactions, job));
    TRY(mf_engine_write(folder, "mesofit-run.lmp", print_run, job));
    if (shared->input)
        return link_inputs(job, folder);
    TRY(link_data(folder));
    return mf_engine_write(folder, input_name, print_input, job);
}

static enum status make(struct job *job, const char *folder) {
    const struct export_engine *engine = &mf_export_lammps;
    job->export.engine = engine;
    job->export.model = &job->model;
    job->export.folder = folder;
    job->export.units =
        mf_export_units(engine->system, &job->run->fit->scene.units, engine->physical);
    job->export.time_step = mf_export_safe_step(&job->model, &job->export.why_step);
    TRY(mf_export_grids_make(&job->export.grids, engine->interpolation, &job->model, false, 0));
    TRY(mf_export_bonded_make(&job->export.bonded, &job->model, engine->has_law));
    TRY(engine->check(&job->export));
    return write_files(job, folder);
}

static enum status write_piece(const struct engine_run *run, const struct engine_piece *piece,
                               const char *folder) {
    OWNED struct job *job = NULL;
    TRY_ARRAY(job, 1);
    job->model = ((const struct shared *)run->own)->model;
    job->run = run;
    job->piece = piece;
    mf_engine_model(run, piece, &job->model);
    snprintf(job->before, sizeof job->before, "../../%04llu/%02zu",
             (unsigned long long)piece->number - 1, piece->replica + 1);
    const enum status status = make(job, folder);
    mf_export_grids_clear(&job->export.grids);
    mf_export_bonded_clear(&job->export.bonded);
    return status;
}

static void list_words(const struct engine_run *run, const struct engine_piece *piece,
                       const char **words, char *text, size_t size) {
    const struct shared *shared = run->own;
    const struct export_units units = mf_export_units(EXPORT_REAL, &run->fit->scene.units, false);
    const int length = snprintf(text, size, "%u", seed_of(piece)) + 1;
    snprintf(text + length, size - (size_t)length, "%.12g", piece->temperature * units.temperature);
    const char *const all[] = {"-in",         shared->input ? shared->input : input_name,
                               "-log",        "log.lammps",
                               "-var",        "seed",
                               text,          "-var",
                               "temperature", text + length};
    memcpy(words, all, sizeof all);
}

/// "ERROR: …" or "ERROR on proc 0: …", the last one; MPI has errors of its own after it.
static const char *find_reason(char *text) {
    char *found = NULL;
    for (char *at = strstr(text, "ERROR"); at; at = strstr(at + 1, "ERROR"))
        if (at[strlen("ERROR")] == ':' || at[strlen("ERROR")] == ' ')
            found = at;
    if (found)
        found[strcspn(found, "\n")] = '\0';
    return found;
}

/// Errors of beads that flew apart.
static bool blames_potential(const char *reason) {
    static const char *const errors[] = {"Lost atoms",   "Non-numeric",  "table inner cutoff",
                                         "Bond atom",    "Angle atom",   "Dihedral atom",
                                         "Out of range", "Bond length >"};
    for (size_t k = 0; k < sizeof errors / sizeof *errors; k++)
        if (strstr(reason, errors[k]))
            return true;
    return false;
}

static const char *name_frames(const struct engine_run *run) {
    (void)run;
    return frames_name;
}

/// Step, temperature, pressure, energy of each frame.
static enum status read_numbers(const struct engine_run *run, const struct engine_piece *piece,
                                const char *folder, struct engine_numbers *numbers) {
    (void)piece;
    CLEARED_BY(mf_data_table_clear) struct data_table table = {0};
    const struct export_units units = mf_export_units(EXPORT_REAL, &run->fit->scene.units, false);
    char path[OUTPUT_PATH_SIZE];
    mf_engine_path(folder, numbers_name, path);
    TRY(mf_data_table_read(&table, path, 4));
    numbers->rows = table.rows;
    TRY_ARRAY(numbers->step, table.rows);
    TRY_ARRAY(numbers->temperature, table.rows);
    TRY_ARRAY(numbers->pressure, table.rows);
    TRY_ARRAY(numbers->energy, table.rows);
    for (size_t k = 0; k < table.rows; k++) {
        const double *row = table.values + k * table.columns;
        numbers->step[k] = (int64_t)row[0];
        numbers->temperature[k] = row[1] / units.temperature;
        numbers->pressure[k] = row[2] / units.pressure;
        numbers->energy[k] = row[3] / units.energy;
    }
    return STATUS_OK;
}

const struct engine_tongue mf_engine_lammps = {.units = "real",
                                               .whole_energy = true,
                                               .prepare = prepare,
                                               .write = write_piece,
                                               .words = list_words,
                                               .reason = find_reason,
                                               .blames_potential = blames_potential,
                                               .frames = name_frames,
                                               .skip = 1,
                                               .numbers = read_numbers,
                                               .forget = forget};
