// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/unpack.h"

#include "base/memory.h"

#include <string.h>

#ifdef HAS_ZLIB
#include <zlib.h>
#endif
#ifdef HAS_ZSTD
#include <zstd.h>
#endif

enum { INPUT = 1 << 18 };

struct unpack {
    bool zstd;
    bool within; ///< a member, as files of gzip and zstd are called that follow each other in one
    bool ended;
    const char *fault;
    unsigned char *input;
    size_t at, size; ///< of the input, what is not yet taken
    uint64_t bytes;
#ifdef HAS_ZLIB
    z_stream gzip;
#endif
#ifdef HAS_ZSTD
    ZSTD_DStream *stream;
#endif
};

// gzip --------------------------------------------------------------------------------------------

#ifdef HAS_ZLIB
enum { GZIP_WINDOW = 15 + 16 }; ///< the largest, in what gzip wraps around it
enum { MOST_AT_ONCE = 1 << 30 };

static bool begin_gzip(struct unpack *unpack) {
    return inflateInit2(&unpack->gzip, GZIP_WINDOW) == Z_OK;
}

static size_t read_gzip(struct unpack *unpack, unsigned char *to, size_t count) {
    z_stream *const gzip = &unpack->gzip;
    gzip->next_in = unpack->input + unpack->at;
    gzip->avail_in = (uInt)(unpack->size - unpack->at);
    gzip->next_out = to;
    gzip->avail_out = (uInt)(count < MOST_AT_ONCE ? count : MOST_AT_ONCE);
    const uInt room = gzip->avail_out;
    const int result = inflate(gzip, Z_NO_FLUSH);
    unpack->at = unpack->size - gzip->avail_in;
    unpack->within = result != Z_STREAM_END;
    if (result == Z_STREAM_END)
        inflateReset(gzip);
    else if (result != Z_OK && result != Z_BUF_ERROR)
        unpack->fault = "what gzip has compressed is damaged";
    return room - gzip->avail_out;
}

static void end_gzip(struct unpack *unpack) {
    inflateEnd(&unpack->gzip);
}
#else
static bool begin_gzip(struct unpack *unpack) {
    return unpack == NULL;
}

static size_t read_gzip(struct unpack *unpack, unsigned char *to, size_t count) {
    return (void)unpack, (void)to, 0 * count;
}

static void end_gzip(struct unpack *unpack) {
    (void)unpack;
}
#endif

// zstd --------------------------------------------------------------------------------------------

#ifdef HAS_ZSTD
static bool begin_zstd(struct unpack *unpack) {
    unpack->stream = ZSTD_createDStream();
    return unpack->stream != NULL;
}

static size_t read_zstd(struct unpack *unpack, unsigned char *to, size_t count) {
    ZSTD_inBuffer in = {unpack->input, unpack->size, unpack->at};
    ZSTD_outBuffer out = {to, count, 0};
    const size_t result = ZSTD_decompressStream(unpack->stream, &out, &in);
    unpack->at = in.pos;
    unpack->within = result != 0;
    if (ZSTD_isError(result))
        unpack->fault = "what zstd has compressed is damaged";
    return out.pos;
}

static void end_zstd(struct unpack *unpack) {
    ZSTD_freeDStream(unpack->stream);
}
#else
static bool begin_zstd(struct unpack *unpack) {
    return unpack == NULL;
}

static size_t read_zstd(struct unpack *unpack, unsigned char *to, size_t count) {
    return (void)unpack, (void)to, 0 * count;
}

static void end_zstd(struct unpack *unpack) {
    (void)unpack;
}
#endif

// Both --------------------------------------------------------------------------------------------

static enum status check_built(const char *file, bool zstd) {
#ifdef HAS_ZLIB
    if (!zstd)
        return STATUS_OK;
#endif
#ifdef HAS_ZSTD
    if (zstd)
        return STATUS_OK;
#endif
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: it is compressed by %s, which this mesofit was built without: "
                          "decompress it with %s, or install %s (Debian's name) and build again",
                          file, zstd ? "zstd" : "gzip", zstd ? "unzstd" : "gunzip",
                          zstd ? "libzstd-dev" : "zlib1g-dev");
}

enum status mf_unpack_begin(struct unpack **unpack, const char *file, const unsigned char *begin,
                            size_t size) {
    const bool gzip = size >= 2 && memcmp(begin, "\x1F\x8B", 2) == 0,
               zstd = size >= 4 && memcmp(begin, "\x28\xB5\x2F\xFD", 4) == 0;
    *unpack = NULL;
    if (!gzip && !zstd)
        return STATUS_OK;
    TRY(check_built(file, zstd));
    struct unpack *const made = mf_memory_zeroed(1, sizeof *made);
    if (made == NULL)
        return STATUS_NO_MEMORY;
    made->zstd = zstd;
    made->input = mf_memory_uncleared(size > INPUT ? size : INPUT, 1);
    if (made->input == NULL || !(zstd ? begin_zstd(made) : begin_gzip(made))) {
        mf_memory_free(made->input);
        mf_memory_free(made);
        return STATUS_NO_MEMORY;
    }
    memcpy(made->input, begin, size);
    made->size = size;
    made->bytes = size;
    made->within = true;
    *unpack = made;
    return STATUS_OK;
}

size_t mf_unpack_read(struct unpack *unpack, FILE *stream, unsigned char *to, size_t count) {
    size_t done = 0;
    while (done < count && unpack->fault == NULL && !unpack->ended) {
        if (unpack->at == unpack->size) {
            unpack->at = 0;
            unpack->size = fread(unpack->input, 1, INPUT, stream);
            unpack->bytes += unpack->size;
            unpack->ended = unpack->size == 0;
        }
        // With the input at its end, what a decoder has kept for want of room may still come.
        const size_t before = done;
        if (!unpack->ended || unpack->within)
            done += (unpack->zstd ? read_zstd : read_gzip)(unpack, to + done, count - done);
        if (unpack->ended && done > before)
            unpack->ended = false;
    }
    if (unpack->ended && unpack->within && unpack->fault == NULL)
        unpack->fault = "the compressed file ends early: it was cut off";
    return done;
}

const char *mf_unpack_fault(const struct unpack *unpack) {
    return unpack->fault;
}

uint64_t mf_unpack_bytes(const struct unpack *unpack) {
    return unpack->bytes;
}

void mf_unpack_end(struct unpack *unpack) {
    if (unpack == NULL)
        return;
    if (unpack->zstd)
        end_zstd(unpack);
    else
        end_gzip(unpack);
    mf_memory_free(unpack->input);
    mf_memory_free(unpack);
}
