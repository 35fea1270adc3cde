// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/stream_function.h"

#include "base/memory.h"

#include <gsl/gsl_fft_complex.h>
#include <math.h>
#include <stdbool.h>

/// Fourier transforms of complex numbers, shape [ny, nx, 2], in place.
struct plane {
    size_t bins[2];
    gsl_fft_complex_wavetable *table[2];
    gsl_fft_complex_workspace *room[2];
};

static void plane_clear(struct plane *plane) {
    for (int d = 0; d < 2; d++) {
        if (plane->table[d])
            gsl_fft_complex_wavetable_free(plane->table[d]);
        if (plane->room[d])
            gsl_fft_complex_workspace_free(plane->room[d]);
    }
}

static enum status plane_init(struct plane *plane, const size_t bins[2]) {
    *plane = (struct plane){.bins = {bins[0], bins[1]}};
    for (int d = 0; d < 2; d++) {
        plane->table[d] = gsl_fft_complex_wavetable_alloc(bins[d]);
        plane->room[d] = gsl_fft_complex_workspace_alloc(bins[d]);
    }
    const bool complete = plane->table[0] && plane->table[1] && plane->room[0] && plane->room[1];
    if (!complete)
        plane_clear(plane);
    return complete ? STATUS_OK : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
}

static void transform(const struct plane *plane, double *values, gsl_fft_direction direction) {
    const size_t nx = plane->bins[0], ny = plane->bins[1];
    for (size_t j = 0; j < ny; j++)
        gsl_fft_complex_transform(values + 2 * j * nx, 1, nx, plane->table[0], plane->room[0],
                                  direction);
    for (size_t i = 0; i < nx; i++)
        gsl_fft_complex_transform(values + 2 * i, nx, ny, plane->table[1], plane->room[1],
                                  direction);
}

/// The wave number of mode n of `bins`.
static double wave_number(size_t n, size_t bins, double width) {
    const double signed_n = 2 * n < bins ? (double)n : (double)n - (double)bins;
    return 2 * M_PI * signed_n / ((double)bins * width);
}

/// The modes of ψ from those of v_x + i v_y, of which those of v_x and v_y, real fields, are what a
/// mode and its partner at −k have in common, and where they differ.
static void solve(const double *modes, const size_t bins[2], const double width[2],
                  double *psi_modes) {
    for (size_t j = 0; j < bins[1]; j++)
        for (size_t i = 0; i < bins[0]; i++) {
            const double *here = modes + 2 * (j * bins[0] + i);
            const double *partner =
                modes + 2 * ((bins[1] - j) % bins[1] * bins[0] + (bins[0] - i) % bins[0]);
            const double kx = wave_number(i, bins[0], width[0]);
            const double ky = wave_number(j, bins[1], width[1]);
            const double square = kx * kx + ky * ky;
            const double vx[2] = {(here[0] + partner[0]) / 2, (here[1] - partner[1]) / 2};
            const double vy[2] = {(here[1] + partner[1]) / 2, (partner[0] - here[0]) / 2};
            double *mode = psi_modes + 2 * (j * bins[0] + i);
            mode[0] = square > 0 ? -(kx * vy[1] - ky * vx[1]) / square : 0;
            mode[1] = square > 0 ? (kx * vy[0] - ky * vx[0]) / square : 0;
        }
}

enum status mf_stream_function(double *psi, const double *vx, const double *vy,
                               const size_t bins[2], const double width[2]) {
    enum status status = STATUS_OK;
    const size_t count = bins[0] * bins[1];
    struct plane plane = {0};
    double *modes = NULL, *psi_modes = NULL;
    NEW_ARRAY(modes, 2 * count);
    NEW_ARRAY(psi_modes, 2 * count);
    CHECK(plane_init(&plane, bins));
    for (size_t n = 0; n < count; n++) {
        modes[2 * n] = vx[n];
        modes[2 * n + 1] = vy[n];
    }
    transform(&plane, modes, gsl_fft_forward);
    solve(modes, bins, width, psi_modes);
    transform(&plane, psi_modes, gsl_fft_backward);
    for (size_t j = 0; j < bins[1]; j++)
        for (size_t i = 0; i < bins[0]; i++) {
            const size_t n = j * bins[0] + i;
            psi[n] = (psi_modes[2 * n] + modes[0] * ((double)j + 0.5) * width[1] -
                      modes[1] * ((double)i + 0.5) * width[0]) /
                     (double)count;
        }
done:
    plane_clear(&plane);
    mf_memory_free(modes);
    mf_memory_free(psi_modes);
    return status;
}
