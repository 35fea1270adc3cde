// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frames.h"

#include "base/digest.h"
#include "base/interrupt.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "trajectory/trajectory_memory.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>

/// Frames of a batch for each thread, and at least: a batch is called for when half of it is there,
/// and the first has two frames.
enum { FRAMES_A_THREAD = 2, MIN_SLOTS = 4 };

/// Times are written in single precision: two that differ by so much, one or two of its last
/// digits, may be the same [ps].
static double time_tolerance(double time) {
    return (double)FLT_EPSILON * fabs(time) + 1e-9;
}

static enum status note(struct frames *frames, const char *format, ...)
    __attribute__((format(printf, 2, 3), warn_unused_result));

static enum status note(struct frames *frames, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const enum status status = mf_source_note(&frames->notes, format, arguments);
    va_end(arguments);
    return status;
}

// Files -------------------------------------------------------------------------------------------

/// Whether a file is one of those before it.
static bool is_given_again(const struct frames *frames) {
    struct stat here, before;
    bool again = false;
    if (stat(frames->plan.file[frames->at], &here) != 0 || !S_ISREG(here.st_mode))
        return false;
    for (size_t k = 0; k < frames->at && !again; k++)
        again = stat(frames->plan.file[k], &before) == 0 && before.st_dev == here.st_dev &&
                before.st_ino == here.st_ino;
    return again;
}

static enum status open_file(struct frames *frames) {
    const char *const file = frames->plan.file[frames->at];
    if (is_given_again(frames))
        TRY(note(
            frames,
            "mesofit: warning: %s is given twice: frames that count twice make errors too small",
            file));
    TRY(mf_trajectory_open(&frames->trajectory, file, &frames->plan.options));
    frames->open = true;
    frames->unsorted = frames->unsorted || (frames->trajectory.format->unsorted &&
                                            !frames->trajectory.structure.has_ids);
    if (frames->at == 0 && frames->trajectory.note[0])
        TRY(note(frames, "%s", frames->trajectory.note));
    if (frames->structure == NULL)
        return STATUS_OK;
    return mf_structure_check_same(frames->structure, frames->structure_file,
                                   &frames->trajectory.structure, file);
}

static enum status close_file(struct frames *frames) {
    const struct frames_source *source = &frames->source[frames->at];
    const bool most = 2 * source->doubled >= source->read;
    if (source->doubled > 0)
        TRY(note(frames, "%s%s: %zu frames of times that had been were left out%s",
                 most ? "mesofit: warning: " : "", frames->plan.file[frames->at], source->doubled,
                 most ? ", half of them or more; --static uses frames of any times" : ""));
    mf_trajectory_close(&frames->trajectory);
    frames->open = false;
    frames->at++;
    frames->ended = frames->ended || frames->at == frames->plan.files;
    return STATUS_OK;
}

enum status mf_frames_refuse_pipe(const char *file) {
    struct stat is;
    if (stat(file, &is) != 0 || !S_ISFIFO(is.st_mode))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: a pipe is read once: say what its atoms are by -s FILE, or save it "
                          "to a file first",
                          file);
}

enum status mf_frames_open(struct frames *frames, const struct frames_plan *plan,
                           const struct structure *structure, const char *structure_file) {
    enum status status;
    *frames = (struct frames){.plan = *plan,
                              .structure = structure,
                              .structure_file = structure_file,
                              .time.columns = 1,
                              .earliest = NAN,
                              .latest = NAN,
                              .slots = (size_t)(FRAMES_A_THREAD * plan->threads)};
    frames->slots = frames->slots < MIN_SLOTS ? MIN_SLOTS : frames->slots;
    NEW_ARRAY(frames->source, plan->files);
    NEW_ARRAY(frames->frame, frames->slots);
    for (size_t k = 0; k < plan->files; k++) {
        const struct trajectory_memory *const memory_files =
            mf_trajectory_memory_find(plan->file[k]);
        struct stat is;
        frames->source[k].digest = DIGEST_OF_NOTHING;
        if (memory_files)
            frames->source[k].bytes = mf_trajectory_memory_bytes(memory_files);
        else if (stat(plan->file[k], &is) == 0 && S_ISREG(is.st_mode))
            frames->source[k].bytes = (uint64_t)is.st_size;
    }
    CHECK(open_file(frames));
done:
    if (status != STATUS_OK)
        mf_frames_close(frames);
    return status;
}

void mf_frames_close(struct frames *frames) {
    if (frames->open)
        mf_trajectory_close(&frames->trajectory);
    for (size_t k = 0; frames->frame && k < frames->slots; k++)
        mf_frame_clear(&frames->frame[k]);
    mf_memory_free(frames->frame);
    mf_memory_free(frames->source);
    mf_sample_series_clear(&frames->time);
    mf_source_free(&frames->notes);
    *frames = (struct frames){0};
}

/// Bytes of the open file that its frames so far have taken, as if all had as many.
static uint64_t bytes_done(const struct frames *frames) {
    const struct trajectory *const trajectory = &frames->trajectory;
    const uint64_t bytes = frames->source[frames->at].bytes;
    if (trajectory->frames == 0)
        return mf_source_done(&trajectory->source);
    return (uint64_t)((double)bytes * (double)trajectory->source.frame /
                      (double)trajectory->frames);
}

void mf_frames_bytes(const struct frames *frames, uint64_t *done, uint64_t *total) {
    *done = frames->open ? bytes_done(frames) : 0;
    *total = 0;
    for (size_t k = 0; k < frames->plan.files; k++) {
        *total += frames->source[k].bytes;
        *done += k < frames->at ? frames->source[k].bytes : 0;
    }
}

/// Add the frames of a file, without decoding them, until there are `most`. A damaged one has those
/// before the damage.
static void count_file(const struct frames *frames, const char *file, uint64_t most,
                       uint64_t *count) {
    struct trajectory trajectory;
    struct trajectory_frame frame = {0};
    bool more = true;
    if (mf_trajectory_open(&trajectory, file, &frames->plan.options) != STATUS_OK)
        return;
    if (trajectory.frames > 0)
        *count += trajectory.frames;
    while (trajectory.frames == 0 && more && *count < most &&
           !mf_interrupt_wanted(frames->plan.cancel))
        if (mf_trajectory_fetch(&trajectory, &frame, &more) != STATUS_OK)
            more = false;
        else
            *count += more;
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

/// How many frames the files have, or `most`; 0: not known, since one is read only once.
static uint64_t count_frames(const struct frames *frames, uint64_t most) {
    uint64_t count = 0;
    for (size_t k = 0; k < frames->plan.files; k++)
        if (frames->source[k].bytes == 0)
            return 0;
    for (size_t k = 0; k < frames->plan.files && count < most; k++)
        count_file(frames, frames->plan.file[k], most, &count);
    return count < most ? count : most;
}

size_t mf_frames_expected(const struct frames *frames, size_t most) {
    const struct frames_plan *const plan = &frames->plan;
    if (frames->time.count < 2 || plan->in_any_order)
        return 0;
    size_t read = 0;
    for (size_t k = 0; k <= frames->at && k < frames->plan.files; k++)
        read += frames->source[k].read;
    const size_t left_out = read - frames->time.count; // before the first, or doubled
    const double begin = frames->time.values[0], interval = frames->time.values[1] - begin;
    const double apart = fmax(interval, plan->every);
    const double wanted = ((double)most + (double)plan->skip) * apart / interval;
    const uint64_t count = count_frames(frames, left_out + (uint64_t)ceil(fmin(wanted, 1e15)));
    if (count == 0)
        return 0;
    double last = begin + ((double)count - (double)left_out - 1) * interval;
    if (plan->end < last)
        last = plan->end;
    return (size_t)fmax(1, floor((last - begin) / apart + 1 + 1e-6) - (double)plan->skip);
}

// Which are used ----------------------------------------------------------------------------------

/// Whether a frame of this time has been.
static bool was_seen(const struct frames *frames, double time) {
    const double tolerance = time_tolerance(time);
    size_t low = 0, high = frames->time.count; // of the first that is not before
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (frames->time.values[middle] < time - tolerance)
            low = middle + 1;
        else
            high = middle;
    }
    return low < frames->time.count && frames->time.values[low] <= time + tolerance;
}

static enum status check_known(const struct frames *frames, const struct trajectory_frame *frame) {
    const struct frames_plan *const plan = &frames->plan;
    if (isnan(plan->begin) && isnan(plan->end) && plan->every == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: frame %zu has no time: --begin, --end and --every cannot be met",
                          frame->file, frame->number);
}

/// Whether a frame is the next in time, or a doubled one.
static enum status find_order(struct frames *frames, const struct trajectory_frame *frame,
                              bool *is_next) {
    const struct sample_series *const seen = &frames->time;
    const double last = seen->count ? seen->values[seen->count - 1] : NAN;
    *is_next = frames->plan.in_any_order || !(frame->time <= last + time_tolerance(last));
    if (*is_next)
        return mf_sample_series_add(&frames->time, &frame->time);
    if (!was_seen(frames, frame->time))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu is out of order: its time, %.7g ps, comes after %.7g "
                              "ps",
                              frame->file, frame->number, frame->time, last);
    frames->source[frames->at].doubled++;
    return STATUS_OK;
}

/// Whether a frame in order is wanted.
static bool is_wanted(const struct frames *frames, double time) {
    const struct frames_plan *const plan = &frames->plan;
    static const double share = 1e-3; // of an interval
    const double steps = (time - frames->time.values[0]) / plan->every;
    return plan->every == 0 ||
           fabs(steps - rint(steps)) < share + time_tolerance(time) / plan->every;
}

/// Squares of what is longer, and what is divided by them, would be no numbers.
static enum status check_time(const struct trajectory_frame *frame) {
    static const double longest = 1e30; // [ps]: more than the age of the universe
    if (isnan(frame->time) || fabs(frame->time) <= longest)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu: its time is %.3g ps, beyond %g ps",
                          frame->file, frame->number, frame->time, longest);
}

static enum status assess_time(struct frames *frames, const struct trajectory_frame *frame,
                               bool *use) {
    const struct frames_plan *const plan = &frames->plan;
    const double time = frame->time;
    *use = true;
    TRY(check_time(frame));
    if (isnan(time))
        return check_known(frames, frame);
    frames->earliest = fmin(frames->earliest, time);
    frames->latest = fmax(frames->latest, time);
    *use = !(time < plan->begin - time_tolerance(time));
    frames->goes_on = frames->goes_on || time > plan->end + time_tolerance(time);
    frames->ended = frames->ended || frames->goes_on;
    if (frames->ended || !*use) {
        *use = false;
        return STATUS_OK;
    }
    TRY(find_order(frames, frame, use));
    *use = *use && is_wanted(frames, time);
    return STATUS_OK;
}

static enum status assess(struct frames *frames, const struct trajectory_frame *frame, bool *use) {
    TRY(assess_time(frames, frame, use));
    if (*use && frames->skipped < frames->plan.skip) {
        frames->skipped++;
        *use = false;
    }
    return STATUS_OK;
}

// Batches -----------------------------------------------------------------------------------------

/// What a batch has of the file that is read.
struct batch {
    struct frames *frames;
    bool *decoded;         ///< shape [slots]
    size_t first, fetched; ///< frames first … fetched − 1 are new
    bool assessed;         ///< only those to be used were kept, by times that took no decoding
    bool over;             ///< the file has no further frame, or is damaged
};

/// A file that breaks off is over, if that is allowed: the failure becomes a note.
static enum status forgive(struct batch *batch, enum status status) {
    struct frames *const frames = batch->frames;
    if (status != STATUS_BAD_INPUT)
        return status;
    if (!frames->plan.allow_truncated)
        return frames->source[frames->at].read > 0
                   ? mf_status_fail(status, "%s; --allow-truncated uses what is before",
                                    mf_status_marked())
                   : status;
    batch->over = true;
    return note(frames, "%s; what is before it is used", mf_status_message());
}

static enum status fetch(struct batch *batch) {
    struct frames *const frames = batch->frames;
    struct frames_source *const source = &frames->source[frames->at];
    while (batch->fetched < frames->slots && !batch->over && !frames->ended &&
           !mf_interrupt_wanted(frames->plan.cancel)) {
        struct trajectory_frame *const frame = &frames->frame[batch->fetched];
        bool more = true;
        const enum status status = mf_trajectory_fetch(&frames->trajectory, frame, &more);
        if (status != STATUS_OK)
            return forgive(batch, status);
        batch->over = !more;
        if (!more)
            break;
        mf_digest_add(&source->digest, frame->raw.data, frame->raw.size);
        source->read++;
        batch->assessed = mf_trajectory_peek(&frames->trajectory, frame);
        bool use = true;
        if (batch->assessed)
            TRY(assess(frames, frame, &use));
        batch->fetched += use;
    }
    return STATUS_OK;
}

static enum status decode_one(void *context, size_t task, void *result) {
    const struct batch *const batch = context;
    (void)result;
    const size_t k = batch->first + task;
    TRY(mf_trajectory_decode(&batch->frames->trajectory, &batch->frames->frame[k]));
    batch->decoded[k] = true;
    return STATUS_OK;
}

/// Decode all that was fetched; what is after a damaged frame is lost.
static enum status decode(struct batch *batch) {
    const struct parallel_tasks tasks = {.count = batch->fetched - batch->first,
                                         .threads = batch->frames->plan.threads,
                                         .run = decode_one,
                                         .context = batch};
    TRY(forgive(batch, mf_parallel_try(&tasks)));
    size_t good = batch->first;
    while (good < batch->fetched && batch->decoded[good])
        good++;
    batch->fetched = good;
    return STATUS_OK;
}

static void swap(struct trajectory_frame *a, struct trajectory_frame *b) {
    const struct trajectory_frame kept = *a;
    *a = *b;
    *b = kept;
}

/// Bring those to be used to the front.
static enum status choose(struct batch *batch, size_t *count) {
    struct frames *const frames = batch->frames;
    struct frames_source *const source = &frames->source[frames->at];
    for (size_t k = batch->first; k < batch->fetched; k++) {
        bool use = batch->assessed;
        if (!batch->assessed)
            TRY(assess(frames, &frames->frame[k], &use));
        if (!use)
            continue;
        if (*count != k)
            swap(&frames->frame[*count], &frames->frame[k]);
        const double time = frames->frame[*count].time;
        source->first_time = source->used ? source->first_time : time;
        source->last_time = time;
        source->used++;
        frames->used++;
        ++*count;
    }
    return STATUS_OK;
}

static enum status read_batch(struct batch *batch, size_t *count) {
    struct frames *const frames = batch->frames;
    if (!frames->open)
        TRY(open_file(frames));
    TRY(fetch(batch));
    TRY(decode(batch));
    TRY(choose(batch, count));
    return batch->over || frames->ended ? close_file(frames) : STATUS_OK;
}

enum status mf_frames_next(struct frames *frames, size_t *count) {
    enum status status = STATUS_OK;
    struct batch batch = {.frames = frames};
    *count = 0;
    NEW_ARRAY(batch.decoded, frames->slots);
    while (*count < frames->slots / 2 && !frames->ended) {
        if (mf_interrupt_wanted(frames->plan.cancel)) {
            status = mf_status_fail(STATUS_INTERRUPTED, "interrupted");
            goto done;
        }
        batch.first = batch.fetched = *count;
        batch.over = false;
        memset(batch.decoded, 0, frames->slots * sizeof *batch.decoded);
        CHECK(read_batch(&batch, count));
    }
done:
    mf_memory_free(batch.decoded);
    return status;
}
