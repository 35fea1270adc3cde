// SPDX-License-Identifier: GPL-3.0-or-later
//
// Stochastic rotation: the velocities relative to the cell's centre of mass turn by ±α about an
// axis that is drawn once for each cell, v ← V + R (v − V): momentum and energy of the cell stay.
// A. Malevanets and R. Kapral, J. Chem. Phys. 110, 8605 (1999). Cells that a wall cuts are filled
// up to M with virtual particles of the wall's temperature, which count as one body (A. Lamura et
// al., Europhys. Lett. 56, 319 (2001)). The thermostat draws the energy of relative motion of the
// cell from the canonical distribution (C. C. Huang et al., J. Comput. Phys. 229, 168
// (2010)).
#include "base/parallel.h"
#include "base/simd.h"
#include "dynamics/solvent.h"

#include <math.h>

#define INLINE static inline __attribute__((always_inline))

struct pass {
    struct solvent *solvent;
    struct particles *beads;
    uint64_t step;
};

/// All bodies of a cell together.
struct sums {
    double mass, momentum[3], squares; ///< Σ m, Σ m v, Σ m v²
    int bodies;
};

/// What a collision does to a velocity: v ← matrix v + shift.
struct collision {
    double matrix[3][3], shift[3];
};

static double bead_mass(const struct pass *pass, size_t bead) {
    const double *mass = particles_masses(pass->beads);
    return mass ? mass[bead] : 1;
}

INLINE struct sums add_solvent(const struct solvent *solvent, uint32_t begin, uint32_t end,
                               const bool squares, const int dimensions) {
    const double mass = solvent->parameters.mass;
    struct sums sums = {.mass = mass * (end - begin), .bodies = (int)(end - begin)};
    for (int d = 0; d < dimensions; d++) {
        const double *v = solvent->velocity[d];
        double sum = 0, square = 0;
        for (uint32_t k = begin; k < end; k++) {
            sum += v[k];
            if (squares)
                square += v[k] * v[k];
        }
        sums.momentum[d] = mass * sum;
        sums.squares += mass * square;
    }
    return sums;
}

/// Maxwell's velocities in place of those that the particles of a bead's cell have: it meets a
/// random solvent, as that of M. Ripoll, R. G. Winkler and G. Gompper, Eur. Phys. J. E 23, 349
/// (2007).
static void redraw(const struct pass *pass, uint32_t begin, uint32_t end, int dimensions) {
    const struct solvent *solvent = pass->solvent;
    const double sigma = sqrt(solvent->temperature / solvent->parameters.mass);
    for (uint32_t k = begin; k < end; k++) {
        double normal[4];
        mf_rng_normal4(solvent_noise(solvent, pass->step, k, SOLVENT_ANEW, 0), normal);
        for (int d = 0; d < dimensions; d++)
            solvent->velocity[d][k] = sigma * normal[d];
    }
}

INLINE void add_beads(const struct pass *pass, size_t cell, struct sums *sums,
                      const int dimensions) {
    for (int32_t bead = pass->solvent->first_bead[cell]; bead >= 0;
         bead = pass->solvent->next_bead[bead]) {
        const double mass = bead_mass(pass, (size_t)bead);
        sums->mass += mass;
        sums->bodies++;
        for (int d = 0; d < dimensions; d++) {
            const double v = pass->beads->velocity[d][bead];
            sums->momentum[d] += mass * v;
            sums->squares += mass * v * v;
        }
    }
}

/// The part of a wall in a cell, at rest on the average: all its virtual particles as one body.
///
/// A cell of which a plate leaves the share x, filled up to c M, takes from a shear flow that ends
/// at y = −b the momentum ρ (1 − ρ_1) x a (x a/2 + b)(1 − x/c), on the average over the shifts
/// a²/6 − a²/(8 c) + b a (1/2 − 1/(3 c)) times the shear. The bulk hands on a²/12: so c = 1 has
/// the slip b = a/4, and c = 3/2 none.
/// @return its mass, 0: none
INLINE double add_wall(const struct pass *pass, size_t cell, int particles, struct sums *sums,
                       const int dimensions) {
    const struct solvent *solvent = pass->solvent;
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    const double mass =
        parameters->mass * (parameters->wall_filling * parameters->particles_per_cell - particles);
    double normal[4];
    if (!(mass > 0))
        return 0;
    mf_rng_normal4(solvent_noise(solvent, pass->step, cell, SOLVENT_VIRTUAL, 0), normal);
    for (int d = 0; d < dimensions; d++) {
        const double momentum = sqrt(mass * solvent->temperature) * normal[d];
        sums->momentum[d] += momentum;
        sums->squares += momentum * momentum / mass;
    }
    sums->mass += mass;
    sums->bodies++;
    return mass;
}

/// A number from the Gamma distribution of shape k ≥ 1: G. Marsaglia and W. W. Tsang, ACM Trans.
/// Math. Softw. 26, 363 (2000).
static double draw_gamma(const struct pass *pass, size_t cell, double shape) {
    const double d = shape - 1.0 / 3, c = 1 / sqrt(9 * d);
    for (uint32_t trial = 0;; trial++) {
        const struct rng_block block =
            solvent_noise(pass->solvent, pass->step, cell, SOLVENT_THERMOSTAT, trial);
        double normal[2];
        rng_box_muller(mf_rng_uniform(block.word[0], 0), mf_rng_uniform(block.word[1], 0), normal);
        const double u = mf_rng_uniform(block.word[2], block.word[3]), x = normal[0];
        const double root = 1 + c * x, v = root * root * root;
        if (v > 0 &&
            (u < 1 - 0.0331 * x * x * x * x || log(u) < 0.5 * x * x + d * (1 - v + log(v))))
            return d * v;
    }
}

/// The factor of relative velocities that gives the cell an energy drawn from the canonical
/// distribution.
static double thermal_factor(const struct pass *pass, size_t cell, const struct sums *sums,
                             int dimensions) {
    double energy = sums->squares;
    for (int d = 0; d < dimensions; d++)
        energy -= sums->momentum[d] * sums->momentum[d] / sums->mass;
    if (!(energy > 0))
        return 1;
    const double shape = 0.5 * dimensions * (sums->bodies - 1);
    return sqrt(2 * pass->solvent->temperature * draw_gamma(pass, cell, shape) / energy);
}

/// Rotation by ±α in the plane: a bit of a block that serves many cells.
enum { CELLS_A_BLOCK = 128 };

/// α of a cell, in radians: the same for all, or its own, from words that nothing else takes.
static double angle_of(const struct pass *pass, size_t cell) {
    const struct solvent *solvent = pass->solvent;
    if (solvent->parameters.angles == COLLISION_FIXED_ANGLES)
        return solvent->parameters.angle * (M_PI / 180);
    const struct rng_block block = solvent_noise(solvent, pass->step, cell, SOLVENT_ROTATION, 1);
    return 2 * M_PI * mf_rng_uniform(block.word[0], block.word[1]);
}

static void rotate_plane(const struct pass *pass, size_t cell, struct rng_block *bits,
                         struct collision *collision) {
    const double angle = angle_of(pass, cell);
    const size_t bit = cell % CELLS_A_BLOCK;
    const double sine = bits->word[bit / 32] >> bit % 32 & 1 ? sin(angle) : -sin(angle);
    const double cosine = cos(angle);
    collision->matrix[0][0] = collision->matrix[1][1] = cosine;
    collision->matrix[0][1] = -sine;
    collision->matrix[1][0] = sine;
}

/// Rotation by α about an axis n, uniform on the sphere: cos α 1 + sin α [n]× + (1 − cos α) n nᵀ.
static void rotate_space(const struct pass *pass, size_t cell, struct collision *collision) {
    const double angle = angle_of(pass, cell);
    const double cosine = cos(angle), sine = sin(angle);
    const struct rng_block block =
        solvent_noise(pass->solvent, pass->step, cell, SOLVENT_ROTATION, 0);
    const double z = 2 * mf_rng_uniform(block.word[0], block.word[2]) - 1;
    const double turn = 2 * M_PI * mf_rng_uniform(block.word[1], block.word[3]);
    const double ring = sqrt(1 - z * z), n[3] = {ring * cos(turn), ring * sin(turn), z};
    const double cross[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            collision->matrix[i][j] =
                sine * cross[i][j] + (1 - cosine) * n[i] * n[j] + (i == j ? cosine : 0);
}

INLINE void finish(struct collision *collision, const struct sums *sums, double factor,
                   const int dimensions) {
    for (int i = 0; i < dimensions; i++) {
        const double mean = sums->momentum[i] / sums->mass;
        collision->shift[i] = mean;
        for (int j = 0; j < dimensions; j++) {
            collision->matrix[i][j] *= factor;
            collision->shift[i] -= collision->matrix[i][j] * (sums->momentum[j] / sums->mass);
        }
    }
}

INLINE void turn_plane(const struct solvent *solvent, uint32_t begin, uint32_t end,
                       const struct collision *collision) {
    const double xx = collision->matrix[0][0], xy = collision->matrix[0][1];
    const double yx = collision->matrix[1][0], yy = collision->matrix[1][1];
    const double x = collision->shift[0], y = collision->shift[1];
    double *restrict vx = solvent->velocity[0], *restrict vy = solvent->velocity[1];
    for (uint32_t k = begin; k < end; k++) {
        const double ux = vx[k], uy = vy[k];
        vx[k] = xx * ux + xy * uy + x;
        vy[k] = yx * ux + yy * uy + y;
    }
}

INLINE void turn_space(const struct solvent *solvent, uint32_t begin, uint32_t end,
                       const struct collision *collision) {
    double *restrict vx = solvent->velocity[0], *restrict vy = solvent->velocity[1],
                     *restrict vz = solvent->velocity[2];
    const struct collision c = *collision;
    for (uint32_t k = begin; k < end; k++) {
        const double ux = vx[k], uy = vy[k], uz = vz[k];
        vx[k] = c.matrix[0][0] * ux + c.matrix[0][1] * uy + c.matrix[0][2] * uz + c.shift[0];
        vy[k] = c.matrix[1][0] * ux + c.matrix[1][1] * uy + c.matrix[1][2] * uz + c.shift[1];
        vz[k] = c.matrix[2][0] * ux + c.matrix[2][1] * uy + c.matrix[2][2] * uz + c.shift[2];
    }
}

static void turn_beads(const struct pass *pass, size_t cell, const struct collision *collision) {
    const int dimensions = pass->solvent->box.dimensions;
    for (int32_t bead = pass->solvent->first_bead[cell]; bead >= 0;
         bead = pass->solvent->next_bead[bead]) {
        double u[3];
        for (int d = 0; d < dimensions; d++)
            u[d] = pass->beads->velocity[d][bead];
        for (int i = 0; i < dimensions; i++) {
            double v = collision->shift[i];
            for (int j = 0; j < dimensions; j++)
                v += collision->matrix[i][j] * u[j];
            pass->beads->velocity[i][bead] = v;
        }
    }
}

/// What the obstacle's virtual particles took from the others: P − P', P' = M' b + A P.
static void give_impulse(struct solvent *solvent, int part, const struct sums *real,
                         const struct collision *collision) {
    for (int i = 0; i < solvent->box.dimensions; i++) {
        double given = real->momentum[i] - real->mass * collision->shift[i];
        for (int j = 0; j < solvent->box.dimensions; j++)
            given -= collision->matrix[i][j] * real->momentum[j];
        solvent->impulse[part][i] += llrint(given / SOLVENT_IMPULSE);
    }
}

INLINE void collide_part(const struct pass *pass, int part, const int dimensions,
                         const bool thermostat) {
    struct solvent *solvent = pass->solvent;
    const bool walls = solvent->parameters.walls || solvent->parameters.obstacle_radius > 0;
    const size_t last = solvent_part(solvent, solvent->cell_total, part + 1);
    struct rng_block bits = {{0}};
    size_t known = SIZE_MAX; // the cells of `bits`
    for (size_t cell = solvent_part(solvent, solvent->cell_total, part); cell < last; cell++) {
        const uint32_t begin = solvent->start[cell], end = solvent->start[cell + 1];
        const bool beads = solvent->first_bead && solvent->first_bead[cell] >= 0;
        if (begin == end && !beads)
            continue;
        if (beads && !solvent->parameters.hydrodynamics)
            redraw(pass, begin, end, dimensions);
        struct sums sums = add_solvent(solvent, begin, end, thermostat, dimensions);
        if (beads)
            add_beads(pass, cell, &sums, dimensions);
        const struct sums real = sums;
        const enum solvent_cut cut = walls ? mf_solvent_cut(solvent, cell) : SOLVENT_UNCUT;
        const double wall = cut ? add_wall(pass, cell, (int)(end - begin), &sums, dimensions) : 0;
        if (sums.bodies < 2)
            continue;
        struct collision collision = {.shift = {0}};
        if (dimensions == 2) {
            if (cell / CELLS_A_BLOCK != known) {
                known = cell / CELLS_A_BLOCK;
                bits = solvent_noise(solvent, pass->step, known, SOLVENT_ROTATION, 0);
            }
            rotate_plane(pass, cell, &bits, &collision);
        } else {
            rotate_space(pass, cell, &collision);
        }
        finish(&collision, &sums, thermostat ? thermal_factor(pass, cell, &sums, dimensions) : 1,
               dimensions);
        if (dimensions == 2)
            turn_plane(solvent, begin, end, &collision);
        else
            turn_space(solvent, begin, end, &collision);
        if (beads)
            turn_beads(pass, cell, &collision);
        if (cut == SOLVENT_CUT_BY_OBSTACLE && wall > 0)
            give_impulse(solvent, part, &real, &collision);
    }
}

SIMD_CLONES static void collide_parts(void *context, size_t begin, size_t end) {
    const struct pass *pass = context;
    const bool plane = pass->solvent->box.dimensions == 2,
               thermostat = pass->solvent->parameters.thermostat;
    for (size_t part = begin / SOLVENT_STRETCH; part < end / SOLVENT_STRETCH; part++)
        if (plane && thermostat)
            collide_part(pass, (int)part, 2, true);
        else if (plane)
            collide_part(pass, (int)part, 2, false);
        else if (thermostat)
            collide_part(pass, (int)part, 3, true);
        else
            collide_part(pass, (int)part, 3, false);
}

/// Beads by cell, each list in the order of the particles.
static void sort_beads(struct solvent *solvent, const struct particles *beads) {
    memset(solvent->first_bead, 0xff, solvent->cell_total * sizeof *solvent->first_bead);
    for (size_t k = beads->count; k-- > 0;) {
        double position[3] = {0};
        for (int d = 0; d < solvent->box.dimensions; d++)
            position[d] = beads->position[d][k];
        cells_enter(&solvent->first_bead[mf_solvent_cell(solvent, position)], solvent->next_bead,
                    (int32_t)k);
    }
}

void mf_solvent_collide(struct solvent *solvent, struct particles *beads, uint64_t step,
                        int threads) {
    struct pass pass = {solvent, beads, step};
    if (solvent->first_bead)
        sort_beads(solvent, beads);
    mf_parallel_for((size_t)solvent->parts * SOLVENT_STRETCH, threads, collide_parts, &pass);
    for (int part = 0; part < solvent->parts; part++)
        for (int d = 0; d < 3; d++) {
            solvent->given[d] += solvent->impulse[part][d];
            solvent->impulse[part][d] = 0;
        }
}
