// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hard discs and spheres beside a slow twin: of all pairs and all images the first collision is
// looked for, all fly there, two turn, and so on. No cells, no calendar, no forecasts.
#include "shared/hard_gases.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 26, MAX = 200 };

struct twin {
    int dimensions, walls;
    double length[3];
    double x[COUNT][3], v[COUNT][3], radius[COUNT], mass[COUNT];
    double virial, impulse[3];
    int collisions;
};

struct found {
    double wait;
    int i, j, axis; ///< j −1: a wall of the axis
    double r[3];
};

static void copy(struct twin *twin, const struct simulation *simulation) {
    const struct particles *p = &simulation->particles;
    const struct event_driven_parameters *parameters = simulation->setup.integrator_parameters;
    *twin = (struct twin){.dimensions = p->box.dimensions, .walls = parameters->walls};
    for (int d = 0; d < 3; d++)
        twin->length[d] = p->box.length[d];
    for (size_t k = 0; k < COUNT; k++) {
        const uint32_t id = p->id[k];
        twin->radius[id] = mf_particles_numbers(p, "radius")[k];
        twin->mass[id] = particles_masses(p)[k];
        for (int d = 0; d < p->box.dimensions; d++) {
            twin->x[id][d] = p->position[d][k];
            twin->v[id][d] = p->velocity[d][k];
        }
    }
}

/// The roots of a quadratic, as in schools.
static double contact(const double r[3], const double v[3], double s, int dimensions) {
    double a = 0, b = 0, c = -s * s;
    for (int d = 0; d < dimensions; d++) {
        a += v[d] * v[d];
        b += 2 * r[d] * v[d];
        c += r[d] * r[d];
    }
    if (b >= 0 || b * b < 4 * a * c)
        return INFINITY;
    return fmax(0, (-b - sqrt(b * b - 4 * a * c)) / (2 * a));
}

static void look_at_pair(const struct twin *twin, int i, int j, struct found *first) {
    for (int n = 0; n < 27; n++) {
        const int image[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        double r[3], v[3];
        bool there = twin->dimensions == 3 || image[2] == 0;
        for (int d = 0; d < twin->dimensions; d++) {
            there = there && (image[d] == 0 || !(twin->walls >> d & 1));
            r[d] = twin->x[j][d] - twin->x[i][d] + image[d] * twin->length[d];
            v[d] = twin->v[j][d] - twin->v[i][d];
        }
        const double wait =
            there ? contact(r, v, twin->radius[i] + twin->radius[j], twin->dimensions) : INFINITY;
        if (wait < first->wait) {
            *first = (struct found){.wait = wait, .i = i, .j = j};
            for (int d = 0; d < twin->dimensions; d++)
                first->r[d] = r[d] + v[d] * wait;
        }
    }
}

static void look_at_walls(const struct twin *twin, int i, struct found *first) {
    for (int d = 0; d < twin->dimensions; d++) {
        const double v = twin->v[i][d];
        const double to = v > 0 ? twin->length[d] - twin->radius[i] : twin->radius[i];
        const double wait =
            twin->walls >> d & 1 && v != 0 ? fmax(0, (to - twin->x[i][d]) / v) : INFINITY;
        if (wait < first->wait)
            *first = (struct found){.wait = wait, .i = i, .j = -1, .axis = d};
    }
}

static void fly(struct twin *twin, double time) {
    for (int k = 0; k < COUNT; k++)
        for (int d = 0; d < twin->dimensions; d++) {
            twin->x[k][d] += twin->v[k][d] * time;
            if (!(twin->walls >> d & 1))
                twin->x[k][d] -= twin->length[d] * floor(twin->x[k][d] / twin->length[d]);
        }
}

/// Velocities of the centre of mass and relative to it, as in textbooks.
static void turn(struct twin *twin, const struct found *event) {
    if (event->j < 0) {
        double *v = &twin->v[event->i][event->axis];
        twin->impulse[event->axis] += 2 * twin->mass[event->i] * fabs(*v);
        *v = -*v;
        return;
    }
    const double a = twin->mass[event->i], b = twin->mass[event->j];
    double rr = 0, along = 0;
    for (int d = 0; d < twin->dimensions; d++) {
        rr += event->r[d] * event->r[d];
        along += event->r[d] * (twin->v[event->j][d] - twin->v[event->i][d]);
    }
    for (int d = 0; d < twin->dimensions; d++) {
        const double centre = (a * twin->v[event->i][d] + b * twin->v[event->j][d]) / (a + b);
        const double relative =
            twin->v[event->j][d] - twin->v[event->i][d] - 2 * along / rr * event->r[d];
        twin->virial += event->r[d] * b * (centre + a / (a + b) * relative - twin->v[event->j][d]);
        twin->v[event->i][d] = centre - b / (a + b) * relative;
        twin->v[event->j][d] = centre + a / (a + b) * relative;
    }
    twin->collisions++;
}

static void run(struct twin *twin, double time) {
    for (;;) {
        struct found first = {.wait = INFINITY};
        for (int i = 0; i < COUNT; i++) {
            look_at_walls(twin, i, &first);
            for (int j = 0; j < i; j++)
                look_at_pair(twin, i, j, &first);
        }
        const double wait = fmin(first.wait, time);
        fly(twin, wait);
        time -= wait;
        if (first.wait > wait)
            return;
        turn(twin, &first);
    }
}

/// Errors grow with each collision of a particle, of which there are four: by a factor of ten in
/// the dense cases, of a hundred in the thin ones.
static void compare(const struct twin *twin, const struct simulation *simulation) {
    const struct particles *p = &simulation->particles;
    const struct hard_gas_tally *tally = &hard_gases_of(simulation)->now.tally;
    assert_int_equal(tally->collisions, twin->collisions);
    assert_close_relative(tally->virial, twin->virial, 1e-6);
    for (int d = 0; d < twin->dimensions; d++)
        assert_close(tally->impulse[d], twin->impulse[d], 1e-6);
    for (size_t k = 0; k < COUNT; k++)
        for (int d = 0; d < twin->dimensions; d++) {
            const double off = p->position[d][k] - twin->x[p->id[k]][d];
            assert_close(box_nearest(off, twin->length[d]), 0, 1e-6);
            assert_close(p->velocity[d][k], twin->v[p->id[k]][d], 1e-6);
        }
}

/// Boxes of one cell along an axis, of two and of more; periodic and between walls.
static void test_hard_gas_has_the_events_of_all_pairs(void **state) {
    (void)state;
    static const struct {
        int dimensions, walls;
        double eta, shape[3], large;
    } cases[] = {{2, 0, 0.3, {1, 1, 1}, 1},    {2, 3, 0.3, {1, 1, 1}, 1},
                 {2, 2, 0.05, {2, 0.5, 1}, 1}, {2, 0, 0.2, {4, 0.25, 1}, 1},
                 {3, 0, 0.2, {1, 1, 1}, 1},    {3, 5, 0.3, {1, 1, 1}, 1},
                 {3, 0, 0.02, {1, 2, 0.5}, 1}, {2, 1, 0.3, {1, 1, 1}, 4}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        struct hard_gas_scene scene;
        struct simulation simulation;
        struct twin twin;
        hard_gases_make_mixture(&scene, cases[n].dimensions, COUNT, cases[n].eta,
                                (const double[2]){1, 0.7 * cases[n].large},
                                (const double[2]){1, 2.5});
        scene.parameters.walls = cases[n].walls;
        for (int d = 0; d < cases[n].dimensions; d++)
            scene.setup.box.length[d] *= cases[n].shape[d];
        scene.setup.seed = 10 + n;
        assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
        copy(&twin, &simulation);
        while (twin.collisions < 50) {
            assert_ok(mf_simulation_run(&simulation, 1));
            run(&twin, scene.setup.time_step);
            assert_true(simulation.step < MAX * 100);
        }
        print_message("case %zu: %d collisions, virial %.1e from that of all pairs\n", n,
                      twin.collisions,
                      hard_gases_of(&simulation)->now.tally.virial / twin.virial - 1);
        compare(&twin, &simulation);
        mf_simulation_clear(&simulation);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hard_gas_has_the_events_of_all_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
