// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/stream_function.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { NX = 24, NY = 15, COUNT = NX * NY };
static const size_t bins[2] = {NX, NY};
static const double width[2] = {0.5, 2};

static const double u = 0.3, v = -0.2;

/// A mean flow and two waves.
static double exact(double x, double y) {
    const double p = 2 * M_PI / (NX * 0.5), q = 2 * M_PI / (NY * 2.);
    return u * y - v * x + sin(p * x) * cos(2 * q * y) + 0.4 * cos(3 * p * x + q * y);
}

static void exact_velocity(double x, double y, double *vx, double *vy) {
    const double p = 2 * M_PI / (NX * 0.5), q = 2 * M_PI / (NY * 2.);
    *vx = u - 2 * q * sin(p * x) * sin(2 * q * y) - 0.4 * q * sin(3 * p * x + q * y);
    *vy = v - p * cos(p * x) * cos(2 * q * y) + 1.2 * p * sin(3 * p * x + q * y);
}

/// With what is a gradient, which no stream function has.
static void check(double gradient) {
    static double vx[COUNT], vy[COUNT], psi[COUNT];
    const double p = 2 * M_PI / (NX * 0.5);
    for (size_t n = 0; n < COUNT; n++) {
        const double x = ((double)(n % NX) + 0.5) * width[0];
        exact_velocity(x, ((double)(n / NX) + 0.5) * width[1], &vx[n], &vy[n]);
        vx[n] += gradient * sin(2 * p * x);
    }
    assert_ok(mf_stream_function(psi, vx, vy, bins, width));
    double shift = 0;
    for (size_t n = 0; n < COUNT; n++) {
        const double x = ((double)(n % NX) + 0.5) * width[0];
        const double difference = psi[n] - exact(x, ((double)(n / NX) + 0.5) * width[1]);
        if (n == 0)
            shift = difference;
        assert_close(difference, shift, 1e-12);
    }
}

static void test_stream_function_is_that_of_known_waves_and_a_mean_flow(void **state) {
    (void)state;
    check(0);
}

static void test_stream_function_leaves_out_what_diverges(void **state) {
    (void)state;
    check(0.7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stream_function_is_that_of_known_waves_and_a_mean_flow),
        cmocka_unit_test(test_stream_function_leaves_out_what_diverges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
