// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Another engine at work for an inversion: the folder of a piece, the command that fills it,
/// and the frames that are read from it.
///
/// Each replica has a folder for each of its pieces, engine/NNNN/RR in the folder of the fit. What
/// an engine needs is written there by its record (struct engine_tongue), the user's command
/// runs there, and its frames are read from there.
#pragma once

#include "base/status.h"
#include "defaults/fit_file.h"
#include "io/output.h"
#include "problem/sampling_engine.h"
#include "report/progress.h"
#include "scene/run_options.h"
#include "trajectory/trajectory.h"

#include <pthread.h>
#include <stdatomic.h>

struct engine_run;

/// Numbers beside the frames of a piece, as far as they are known.
struct engine_numbers {
    size_t rows;
    int64_t *step;       ///< shape [rows]; NULL: a row is a frame
    double *temperature; ///< shape [rows] [T_0]; NULL: not known
    double *pressure;    ///< the same [k_B T_0/λ^d]
    double *energy;      ///< the same [k_B T_0]
};
void mf_engine_numbers_clear(struct engine_numbers *numbers);

/// How an engine is spoken to.
struct engine_tongue {
    const char *units; ///< of its trajectories where they do not say it; NULL: as the scene's
    bool whole_energy; ///< its energies are those of pairs and molecules
    /// Before the first piece of this process. NULL: nothing.
    enum status (*prepare)(struct engine_run *run, const struct engine_piece *piece);
    /// Write the files of a piece.
    enum status (*write)(const struct engine_run *run, const struct engine_piece *piece,
                         const char *folder);
    /// Words after the command, NULL-terminated, into `words` of ENGINE_MAX_WORDS; texts into
    /// `text`.
    void (*words)(const struct engine_run *run, const struct engine_piece *piece,
                  const char **words, char *text, size_t size);
    /// The line of what the engine said that tells why it failed, or NULL.
    const char *(*reason)(char *text);
    bool (*blames_potential)(const char *reason); ///< whether that is its fault; NULL: never
    /// Name of the trajectory in the folder, and how many of its first frames are no samples.
    const char *(*frames)(const struct engine_run *run);
    size_t skip;
    enum status (*numbers)(const struct engine_run *run, const struct engine_piece *piece,
                           const char *folder, struct engine_numbers *numbers);
    void (*forget)(struct engine_run *run); ///< what `prepare` has made; NULL: nothing
};
enum { ENGINE_MAX_WORDS = 16, ENGINE_MAX_REPLICAS = 64 };
extern const struct engine_tongue mf_engine_lammps, mf_engine_command;

/// An engine of a run.
struct engine_run {
    struct sampling_engine engine; ///< its context is this
    const struct engine_tongue *tongue;
    const struct engine_settings *settings;
    const struct fit_file *fit;
    const char *command;
    bool later;         ///< somebody else runs the pieces (ENGINE_LATER)
    atomic_bool waits;  ///< for a piece that is not there yet
    const char *folder; ///< of the fit; borrowed
    pthread_mutex_t lock;
    bool prepared;
    void *own; ///< of the tongue
    struct {
        uint64_t number, digest;
    } seen[ENGINE_MAX_REPLICAS]; ///< of the first frames
};

/// The command that is none: pieces are written, and the fit ends; it goes on once somebody has run
/// them, on this machine or another.
#define ENGINE_LATER "later"

/// Path of the folder of a piece, into `path` of OUTPUT_PATH_SIZE bytes.
void mf_engine_folder(const struct engine_run *run, size_t replica, uint64_t number, char *path);

/// A file of a folder, "folder/name", into `path` of OUTPUT_PATH_SIZE bytes.
void mf_engine_path(const char *folder, const char *name, char *path);

/// Time steps of so many sweeps.
static inline uint64_t engine_steps(const struct engine_run *run, uint64_t sweeps) {
    return sweeps * (uint64_t)run->settings->steps;
}

/// Add a line to the list of the folders that wait for their frames, those of ENGINE_LATER; NULL:
/// begin it. Fails: IO.
enum status mf_engine_wait(struct engine_run *run, const char *folder);

/// Of pieces that somebody else runs, whose frames are no samples: wait for the piece again.
/// Returns the status, why they are none.
enum status mf_engine_refuse(struct engine_run *run, const char *folder, enum status status);

/// Compare the first frame of a piece, by a digest of its places, with that of the other replicas.
/// Fails: BAD_INPUT if another one has the same.
enum status mf_engine_compare(struct engine_run *run, uint64_t number, size_t replica,
                              uint64_t digest);

/// Frames of a piece while they are read.
struct engine_frames;
enum status mf_engine_frames_open(struct engine_run *run, const struct engine_piece *piece,
                                  const char *folder, struct engine_frames **frames) MUST_USE;
enum status mf_engine_frames_next(void *frames, double *const position[3],
                                  struct engine_sample *sample) MUST_USE;
void mf_engine_frames_close(void *frames);
