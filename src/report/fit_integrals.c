// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_integrals.h"

#include "observe/kirkwood_buff.h"
#include "observe/kirkwood_buff_observable.h"

#include <math.h>
#include <stdio.h>

/// One sample tells no error.
static double own_error(double error) {
    return error > 0 ? error : NAN;
}

void mf_fit_integrals_write(struct json_writer *writer, const struct fit_file *fit,
                            const struct verification *v) {
    const int kind = mf_kirkwood_buff_kind();
    const struct composition *components = &target_files_kirkwood_buff(&fit->files)->components;
    const struct target *target = &fit->problem.compared.target[kind];
    for (size_t pair = 0; pair < target->count; pair++) {
        mf_kirkwood_buff_write(writer, "target_kirkwood_buff", components, pair,
                               target->value[pair], target->error[pair]);
        mf_kirkwood_buff_write(writer, "kirkwood_buff", components, pair,
                               v->observed.value[kind][pair], v->observed.error[kind][pair]);
    }
}

/// Kirkwood and Buff's integral of a g(r), and S(0) with it, at a density, or that of the scene.
static void write_integral(struct json_writer *writer, const struct fit_file *fit, const char *of,
                           const double *g, const double *error, const double *density) {
    const double count = (double)fit->scene.setup.placement.count;
    const struct box box = density ? mf_box_cube(count / *density) : fit->scene.setup.box;
    const struct kirkwood_buff found = mf_kirkwood_buff_integrate(
        target_pairs_bins(target_files_rdf(&fit->files)), g, error, &box, (size_t)count, 0);
    const double value[] = {found.integral, own_error(found.integral_error), found.compressibility,
                            own_error(found.compressibility_error)};
    static const char *const name[] = {"kirkwood_buff", "kirkwood_buff_error", "compressibility",
                                       "compressibility_error"};
    for (int k = 0; k < 4; k++) {
        char key[40];
        snprintf(key, sizeof key, "%s%s", of, name[k]);
        if (isfinite(value[k]))
            mf_json_write_quantity(writer, key, k < 2 ? "lambda^d" : "1", value[k]);
    }
}

void mf_fit_integrals_write_compressibility(struct json_writer *writer, const struct fit_file *fit,
                                            const struct verification *v) {
    const struct target *density = &fit->problem.compared.target[TARGET_DENSITY];
    const bool held = density->count == 0; // by the box
    if (!fit->files.given[TARGET_RDF] || fit->scene.setup.box.dimensions != 3 ||
        composition_is_mixed(&fit->scene.setup.composition) ||
        scene_has_molecules(&fit->scene.molecules))
        return;
    write_integral(writer, fit, "target_", target_files_rdf(&fit->files)->g,
                   target_files_rdf(&fit->files)->error, held ? NULL : density->value);
    write_integral(writer, fit, "", v->observed.value[TARGET_RDF], v->observed.error[TARGET_RDF],
                   held ? NULL : v->observed.value[TARGET_DENSITY]);
}
