// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The frames of one trajectory, which may be in several files, some at a time.
///
/// Frames are fetched one after the other and decoded by all threads; memory holds a batch of them
/// and their times. A simulation that was restarted writes again what it had written since its last
/// checkpoint: frames of a time that has been are left out and counted. Other steps back in time
/// are a fault, unless the frames are independent of each other.
#pragma once

#include "observe/sample_series.h"
#include "trajectory/trajectory.h"

#include <stdatomic.h>

struct frames_plan {
    const char *const *file; ///< shape [files], in the order of time
    size_t files;
    struct trajectory_options options;
    double begin, end;         ///< what is before or after is left out [ps]; NAN: nothing is
    double every;              ///< frames are taken this far apart, from the first on [ps]; 0: all
    size_t skip;               ///< of those to be used so many are left out at the beginning
    bool allow_truncated;      ///< a file that breaks off is used up to there
    bool in_any_order;         ///< frames of any times, also of the same: their order says nothing
    const atomic_bool *cancel; ///< ends the reading once it is set, or NULL; borrowed
    int threads;
};

/// What a file has given.
struct frames_source {
    uint64_t bytes;  ///< its size; 0: not known, as of a pipe
    uint64_t digest; ///< of the frames' bytes (base/digest.h)
    size_t read, used, doubled;
    double first_time, last_time; ///< of what was used [ps]
};

struct frames {
    struct frames_plan plan;
    const struct structure *structure; ///< what every file must be of, borrowed
    const char *structure_file;
    struct frames_source *source; ///< shape [files]
    struct trajectory trajectory; ///< of the file that is read
    size_t at;                    ///< its number
    bool open, ended;
    size_t slots;
    struct trajectory_frame *frame; ///< shape [slots]: a batch, those to be used first
    struct sample_series time;      ///< of all frames in order, so far
    double earliest, latest;        ///< of all frames that were seen, used or not [ps]; NAN: none
    bool unsorted;                  ///< rows may be other atoms in each frame
    bool goes_on;                   ///< beyond `latest`: what is after the end is not looked at
    size_t used, skipped;
    struct bytes notes; ///< lines for a person: what was left out and why; a text
};

/// Refuse a pipe that is to say what its atoms are, too: that is read before its frames.
/// Fails: BAD_INPUT. Tested: cli/test_measure_words.
enum status mf_frames_refuse_pipe(const char *file) MUST_USE;

/// Open the first file. @param[in] structure  NULL: that of the first file
/// Fails: as mf_trajectory_open; BAD_INPUT if its atoms are not those of the structure.
/// Tested: test_measure.
enum status mf_frames_open(struct frames *frames, const struct frames_plan *plan,
                           const struct structure *structure, const char *structure_file) MUST_USE;

/// Read the next frames to be used into frames->frame[0 … *count − 1], in order; *count is 0 after
/// the last, and at least 2 before. They are the same however many threads there are, but for how
/// many come at a time. Fails: BAD_INPUT for a damaged frame, unless that is allowed, for frames
/// out of order or without a time that is asked for; IO; NO_MEMORY; INTERRUPTED.
enum status mf_frames_next(struct frames *frames, size_t *count) MUST_USE;

/// How many frames there will be to be used, if all are as far apart as the first two that were
/// seen; `most` if there are more. Files that do not say it are read for it. 0: not known, as of a
/// pipe. Tested: test_measure.
size_t mf_frames_expected(const struct frames *frames, size_t most);

/// Bytes of the files, and those taken so far.
void mf_frames_bytes(const struct frames *frames, uint64_t *done, uint64_t *total);

void mf_frames_close(struct frames *frames);
