// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/soft_discs_cells.h"

/// Radii of a class differ by less than this factor.
static const double class_factor = 3;

/// Height of a row in mean distances of the discs of a class.
static const double row_height = 5;

/// Discs of a class for each of its cells.
static const double in_cell = 2;

static double largest_of(const double *radius, size_t count) {
    double largest = 0;
    for (size_t k = 0; k < count; k++)
        largest = fmax(largest, radius[k]);
    return largest;
}

/// The class of a radius: the number of classes that are too small for it.
static inline int class_of(const struct soft_discs_cells *cells, double radius) {
    int class = 0;
    for (int c = 0; c + 1 < cells->classes; c++)
        class += radius > cells->of[c].largest;
    return class;
}

/// Classes from the largest radius down; the first takes all that are smaller still. Each then ends
/// at the largest radius in it.
static void choose_classes(struct soft_discs_cells *cells, const double *radius) {
    const double largest = largest_of(radius, cells->count);
    double smallest = largest;
    for (size_t k = 0; k < cells->count; k++)
        smallest = fmin(smallest, radius[k]);
    cells->classes = 1 + (int)fmin(SOFT_DISCS_MAX_CLASSES - 1,
                                   floor(log(largest / smallest) / log(class_factor)));
    for (int c = 0; c < cells->classes; c++)
        cells->of[c].largest = largest / pow(class_factor, cells->classes - 1 - c);
    double found[SOFT_DISCS_MAX_CLASSES] = {0};
    for (size_t k = 0; k < cells->count; k++) {
        const int class = class_of(cells, radius[k]);
        found[class] = fmax(found[class], radius[k]);
        cells->of[class].count++;
    }
    int kept = 0;
    for (int c = 0; c < cells->classes; c++) {
        if (cells->of[c].count > 0)
            cells->of[kept++] =
                (struct soft_discs_class){.largest = found[c], .count = cells->of[c].count};
    }
    cells->classes = kept;
}

/// @return how many there are
static int choose_cells(struct soft_discs_cells *cells, const struct box *box) {
    int total = 0;
    for (int c = 0; c < cells->classes; c++) {
        struct soft_discs_class *class = &cells->of[c];
        const double area = box->length[0] * box->length[1];
        const double spacing = sqrt(area / (double)class->count);
        class->rows = (int)fmax(
            1, fmin(floor(box->length[0] / (row_height * spacing)), (double)class->count));
        const double in_row = (double)class->count / class->rows;
        class->columns = (int)fmax(1, floor(in_row / in_cell));
        class->first_cell = (size_t)total;
        total += class->rows * class->columns;
    }
    return total;
}

enum status mf_soft_discs_cells_init(struct soft_discs_cells *cells,
                                     const struct particles *particles, bool precise) {
    const size_t count = particles->count, capacity = count + PARTICLES_PADDING;
    *cells = (struct soft_discs_cells){.count = count};
    choose_classes(cells, mf_particles_numbers(particles, "radius"));
    const int total = choose_cells(cells, &particles->box);
    TRY(mf_cells_shape(&cells->sorted, (const int[3]){1, 1, total}, count));
    size_t rows = 0;
    for (int c = 0; c < cells->classes; c++)
        rows += (size_t)cells->of[c].rows;
    TRY_ARRAY(cells->block, count / SOFT_DISCS_BLOCK + rows);
    TRY_ARRAY(cells->radius, capacity);
    TRY_ARRAY(cells->stiffness, capacity);
    for (int d = 0; d < particles->box.dimensions; d++) {
        TRY_ARRAY(cells->fraction[d], capacity);
        if (precise)
            TRY_ARRAY(cells->position[d], capacity);
    }
    if (precise) {
        TRY_ARRAY(cells->precise_radius, capacity);
        TRY_ARRAY(cells->precise_stiffness, capacity);
    }
    return STATUS_OK;
}

void mf_soft_discs_cells_clear(struct soft_discs_cells *cells) {
    mf_memory_free(cells->block);
    mf_cells_clear(&cells->sorted);
    mf_memory_free(cells->radius);
    mf_memory_free(cells->stiffness);
    for (int d = 0; d < 3; d++) {
        mf_memory_free(cells->fraction[d]);
        mf_memory_free(cells->position[d]);
    }
    mf_memory_free(cells->precise_radius);
    mf_memory_free(cells->precise_stiffness);
    *cells = (struct soft_discs_cells){0};
}

static void find_cells(struct soft_discs_cells *cells, const struct particles *particles,
                       const double *radius) {
    for (size_t k = 0; k < cells->count; k++) {
        const struct soft_discs_class *class = &cells->of[class_of(cells, radius[k])];
        const uint32_t row = cells_along_fraction(particles->fraction[0][k], class->rows);
        const uint32_t column = cells_along_fraction(particles->fraction[1][k], class->columns);
        cells->sorted.of[k] =
            (uint32_t) class->first_cell + row * (uint32_t) class->columns + column;
    }
}

static void find_blocks(struct soft_discs_cells *cells) {
    cells->blocks = 0;
    for (int c = 0; c < cells->classes; c++) {
        const struct soft_discs_class *class = &cells->of[c];
        const size_t columns = (size_t) class->columns;
        for (int row = 0; row < class->rows; row++) {
            const uint32_t *start = cells->sorted.start + class->first_cell + (size_t)row * columns;
            for (uint32_t at = start[0]; at < start[columns]; at += SOFT_DISCS_BLOCK) {
                const uint32_t left = start[columns] - at;
                cells->block[cells->blocks++] = (struct soft_discs_block){
                    at, left < SOFT_DISCS_BLOCK ? left : SOFT_DISCS_BLOCK, row};
            }
        }
    }
}

void mf_soft_discs_cells_sort(struct soft_discs_cells *cells, const struct particles *particles) {
    const double *radius = mf_particles_numbers(particles, "radius");
    const double *stiffness = mf_particles_numbers(particles, "stiffness");
    find_cells(cells, particles, radius);
    mf_cells_sort(&cells->sorted);
    for (size_t at = 0; at < cells->count; at++) {
        const size_t k = cells->sorted.order[at];
        for (int d = 0; d < particles->box.dimensions; d++)
            cells->fraction[d][at] = particles->fraction[d][k];
        cells->radius[at] = (float)radius[k];
        cells->stiffness[at] = stiffness ? (float)stiffness[k] : 1;
        if (cells->precise_radius == NULL)
            continue;
        for (int d = 0; d < particles->box.dimensions; d++)
            cells->position[d][at] = particles->position[d][k];
        cells->precise_radius[at] = radius[k];
        cells->precise_stiffness[at] = stiffness ? stiffness[k] : 1;
    }
    find_blocks(cells);
}
