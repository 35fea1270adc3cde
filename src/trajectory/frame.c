// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/frame.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "base/visible.h"
#include "trajectory/words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum status reserve(double (**array)[3], size_t *capacity, size_t atoms) {
    if (atoms <= *capacity)
        return STATUS_OK;
    mf_memory_free(*array);
    *capacity = 0;
    *array = mf_memory_uncleared(atoms, sizeof **array);
    if (*array == NULL)
        return STATUS_NO_MEMORY;
    *capacity = atoms;
    return STATUS_OK;
}

enum status mf_frame_reserve(struct trajectory_frame *frame, size_t atoms, bool velocities) {
    frame->atoms = atoms;
    frame->has_velocities = velocities;
    frame->has_forces = false;
    frame->unwrapped = false;
    TRY(reserve(&frame->position, &frame->capacity, atoms));
    return velocities ? reserve(&frame->velocity, &frame->speed_capacity, atoms) : STATUS_OK;
}

enum status mf_frame_reserve_forces(struct trajectory_frame *frame) {
    frame->has_forces = true;
    return reserve(&frame->force, &frame->force_capacity, frame->atoms);
}

void mf_frame_clear(struct trajectory_frame *frame) {
    mf_memory_free(frame->position);
    mf_memory_free(frame->velocity);
    mf_memory_free(frame->force);
    mf_source_free(&frame->raw);
    mf_source_free(&frame->scratch);
    *frame = (struct trajectory_frame){0};
}

static double volume(const double (*box)[3]) {
    const double *a = box[0], *b = box[1], *c = box[2];
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

void mf_frame_set_box(struct trajectory_frame *frame, const double box[3][3]) {
    const double size = fabs(volume(box));
    frame->has_box = size > 0 && isfinite(size);
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++)
            frame->box[i][d] = frame->has_box ? box[i][d] : 0;
    for (int i = 0; i < 3; i++)
        frame->periodic[i] = frame->has_box;
}

/// Exactly 0 for a right angle, so that an orthorhombic box is one.
static double cosine(double degrees) {
    return degrees == 90 ? 0 : cos(degrees * (acos(-1) / 180));
}

bool mf_frame_box_of_angles(struct trajectory_frame *frame, const double length[3],
                            const double angle[3]) {
    for (int i = 0; i < 3; i++)
        if (!(length[i] > 0 && angle[i] > 0 && angle[i] < 180))
            return false;
    const double cos_a = cosine(angle[0]), cos_b = cosine(angle[1]), cos_c = cosine(angle[2]);
    const double sin_c = sqrt(1 - cos_c * cos_c);
    const double y = (cos_a - cos_b * cos_c) / sin_c, rest = 1 - cos_b * cos_b - y * y;
    if (!(rest > 0))
        return false;
    const double box[3][3] = {
        {length[0], 0, 0},
        {length[1] * cos_c, length[1] * sin_c, 0},
        {length[2] * cos_b, length[2] * y, length[2] * sqrt(rest)},
    };
    mf_frame_set_box(frame, box);
    return frame->has_box;
}

static void cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

void mf_frame_reciprocal(const struct trajectory_frame *frame, double reciprocal[3][3]) {
    memset(reciprocal, 0, 9 * sizeof(double));
    if (!frame->has_box)
        return;
    for (int i = 0; i < 3; i++) {
        const double *const own = frame->box[i];
        double *const row = reciprocal[i];
        cross(frame->box[(i + 1) % 3], frame->box[(i + 2) % 3], row);
        const double volume = own[0] * row[0] + own[1] * row[1] + own[2] * row[2];
        for (int d = 0; d < 3; d++)
            row[d] = frame->periodic[i] ? row[d] / volume : 0;
    }
}

enum { REASON_SIZE = 1024 };

void mf_frame_step_to(const struct trajectory_frame *frame, double reciprocal[3][3],
                      const double position[3], double place[3]) {
    double difference[3];
    for (int d = 0; d < 3; d++)
        difference[d] = position[d] - place[d];
    for (int i = 2; i >= 0; i--) {
        const double *const row = reciprocal[i];
        const double images =
            rint(difference[0] * row[0] + difference[1] * row[1] + difference[2] * row[2]);
        for (int d = 0; images != 0 && d < 3; d++)
            difference[d] -= images * frame->box[i][d];
    }
    for (int d = 0; d < 3; d++)
        place[d] += difference[d];
}

enum status mf_frame_fail_line(const struct trajectory_frame *frame, const char *at,
                               const char *format, ...) {
    char reason[REASON_SIZE];
    size_t line = frame->first_line + 1;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    for (const char *c = (const char *)frame->raw.data; c < at; c++)
        line += *c == '\0';
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: frame %zu: %s", frame->file, line,
                          frame->number, reason);
}

enum status mf_frame_fail_byte(const struct trajectory_frame *frame, size_t at, const char *format,
                               ...) {
    char reason[REASON_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu, byte %llu: %s", frame->file,
                          frame->number, (unsigned long long)(frame->first_byte + at), reason);
}

const char *mf_frame_next_line(const struct trajectory_frame *frame, const char *line) {
    const char *const end = (const char *)frame->raw.data + frame->raw.size;
    const char *next = line + strlen(line) + 1;
    return next < end ? next : NULL;
}

/// The number after "t=" or "t= ", where a word begins.
static bool find_number(const char *title, const char *key, double *value) {
    const size_t length = strlen(key);
    for (const char *at = strstr(title, key); at; at = strstr(at + 1, key)) {
        const char *rest = at + length;
        if ((at == title || at[-1] == ' ') && mf_words_numbers(&rest, value, 1))
            return true;
    }
    return false;
}

void mf_frame_read_title(struct trajectory_frame *frame, const char *title) {
    double value;
    if (find_number(title, "t=", &value))
        frame->time = value;
    if (find_number(title, "step=", &value) && fabs(value) < 9e15)
        frame->step = (int64_t)value;
}

static double product(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Cholesky's factor of the products of the box's vectors.
static void find_edges(const double vector[3][3], double edge[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double rest = product(vector[i], vector[j]);
            for (int k = 0; k < j && j <= i; k++)
                rest -= edge[i][k] * edge[j][k];
            edge[i][j] = j > i ? 0 : j == i ? sqrt(fmax(0, rest)) : rest / edge[j][j];
        }
}

enum status mf_frame_box_find(struct box_vectors *box, const struct trajectory_frame *frame) {
    *box = (struct box_vectors){.volume = 1};
    if (!frame->has_box)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu has no box: g(r) needs the volume and its images; "
                              "give it by --box; with --molecules bonds and angles are measured "
                              "without",
                              frame->file, frame->number);
    for (int i = 0; i < 3; i++)
        if (!frame->periodic[i])
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: frame %zu is not periodic along vector %c of its box: give a "
                "box that is, by --box",
                frame->file, frame->number, 'a' + i);
    find_edges(frame->box, box->edge);
    mf_frame_reciprocal(frame, box->inverse);
    for (int i = 0; i < 3; i++) {
        box->height[i] = 1 / sqrt(product(box->inverse[i], box->inverse[i]));
        box->volume *= box->edge[i][i];
    }
    return STATUS_OK;
}

enum status mf_frame_box_check_range(const struct box_vectors *box,
                                     const struct trajectory_frame *frame, double range,
                                     const char *what) {
    const double half = 0.5 * mf_box_vectors_min_height(box);
    if (range <= half)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: frame %zu: %s, %g nm, is beyond half the shortest height of the "
                          "box, %.6g nm: pairs would be seen in the wrong image",
                          frame->file, frame->number, what, range, half);
}

/// Boxes beyond which a fraction is none (box_fraction): no digit of the place in a box is left.
static const double max_boxes = 0x1p19;

enum status mf_frame_box_places(const struct box_vectors *box, const struct trajectory_frame *frame,
                                int32_t *const place[3]) {
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < frame->atoms; k++) {
            const double boxes = product(frame->position[k], box->inverse[i]);
            if (!(fabs(boxes) < max_boxes))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: frame %zu: bead %zu is %.3g boxes away, so that its "
                                      "place in a box is lost",
                                      frame->file, frame->number, k + 1, mf_visible_number(boxes));
            place[i][k] = box_fraction(boxes, 1);
        }
    return STATUS_OK;
}

void mf_frame_box_spread(const struct box_vectors *box, const struct trajectory_frame *frame,
                         double spread[3]) {
    for (int i = 0; i < 3; i++) {
        struct running_mean boxes = {0};
        for (size_t k = 0; k < frame->atoms; k++)
            mf_statistics_add(&boxes, product(frame->position[k], box->inverse[i]));
        spread[i] = mf_statistics_standard_error(&boxes) * sqrt(12 * (double)frame->atoms);
    }
}

bool mf_frame_box_is_plane(const struct box_vectors *box, const struct trajectory_frame *frame) {
    enum { MIN_ATOMS = 16 }; // fewer may be a flat molecule, and two or three often are in a plane
    static const double flat = 1e-6, full = 0.5;
    double spread[3];
    int flats = 0, fulls = 0;
    mf_frame_box_spread(box, frame, spread);
    for (int i = 0; i < 3; i++) {
        flats += spread[i] < flat;
        fulls += spread[i] > full;
    }
    return frame->atoms >= MIN_ATOMS && flats == 1 && fulls == 2;
}
