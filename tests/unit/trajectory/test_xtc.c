// SPDX-License-Identifier: GPL-3.0-or-later
//
// Frames that are packed and read again are rounded to 0.001 nm, whatever their atoms are like; the
// reader is that of GROMACS's files, and Python's tests have MDAnalysis read ours.
#include "trajectory/xtc.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

enum { ATOMS = 2000, FRAMES = 2 };

/// How atoms stand: alone, in chains, in one point, in a box beyond 2^24 thousandths, few.
enum arrangement { GAS, CHAINS, POINT, WIDE, SHELLS, FEW, ARRANGEMENTS };

struct atoms {
    size_t count;
    double place[ATOMS][3];
};

static double chance(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) * 0x1p-24;
}

static void arrange(struct atoms *atoms, enum arrangement arrangement) {
    static const double edge[ARRANGEMENTS] = {4, 6, 0, 4e4, 5, 2};
    unsigned seed = 3 + (unsigned)arrangement;
    atoms->count = arrangement == FEW ? 9 : arrangement == POINT ? 10 : ATOMS;
    for (size_t k = 0; k < atoms->count; k++)
        for (int d = 0; d < 3; d++) {
            double *const x = &atoms->place[k][d];
            *x = edge[arrangement] * (chance(&seed) - 0.3);
            if (arrangement == CHAINS && k % 17 > 0) // steps of many sizes
                *x = atoms->place[k - 1][d] +
                     pow(2, (double)(k / 100 % 9) - 8) * (chance(&seed) - 0.5);
            if (arrangement == SHELLS && k % 3 > 0)
                *x = atoms->place[k - k % 3][d] + 0.2 * (chance(&seed) - 0.5);
        }
}

static void place(const void *context, size_t atom, double position[3]) {
    memcpy(position, ((const struct atoms *)context)->place[atom], 3 * sizeof *position);
}

static void check(const struct atoms *atoms, const char *path, double rounding) {
    static const struct trajectory_options no_options;
    struct trajectory trajectory;
    struct trajectory_frame frame = {0};
    bool more = true;
    assert_ok(mf_trajectory_open(&trajectory, path, &no_options));
    for (int t = 0; t < FRAMES; t++) {
        assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
        assert_true(more && frame.atoms == atoms->count && frame.step == 7 + t);
        assert_true(fabs(frame.time - 0.5 * t) < 1e-9 && fabs(frame.box[1][0] - 1.5) < 1e-6);
        for (size_t k = 0; k < atoms->count; k++)
            for (int d = 0; d < 3; d++)
                assert_true(fabs(frame.position[k][d] - atoms->place[k][d]) <= rounding);
    }
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_false(more);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

static void test_frames_are_read_as_they_were(void **state) {
    static struct atoms atoms;
    const char *const path = temporary_folder_file(*state, "a.xtc");
    for (int arrangement = 0; arrangement < ARRANGEMENTS; arrangement++) {
        FILE *const stream = fopen(path, "wb");
        assert_non_null(stream);
        arrange(&atoms, (enum arrangement)arrangement);
        for (int t = 0; t < FRAMES; t++) {
            struct xtc_frame frame = {.atoms = atoms.count,
                                      .step = 7 + t,
                                      .time = 0.5 * t,
                                      .box = {{9, 0, 0}, {1.5, 8, 0}, {0, 0, 7}},
                                      .place = place,
                                      .context = &atoms};
            mf_xtc_write(&frame, stream);
        }
        const double bytes = (double)ftell(stream) / FRAMES / (double)atoms.count;
        fclose(stream);
        check(&atoms, path, 0.0005 + (arrangement == FEW ? -0.0004 : 1e-9));
        // 12 bytes are three floats; near atoms take less.
        assert_true(arrangement == FEW || arrangement == POINT ||
                    bytes < (arrangement == WIDE  ? 10.5
                             : arrangement == GAS ? 5
                                                  : 4.5));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(
        test_frames_are_read_as_they_were, temporary_folder_create, temporary_folder_remove)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
