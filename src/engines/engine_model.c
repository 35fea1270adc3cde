// SPDX-License-Identifier: GPL-3.0-or-later
#include "engines/engine_model.h"

#include "forces/molecules.h"

#include <math.h>

static void name_types(struct export_model *model) {
    const struct composition *composition = &model->setup.composition;
    model->types = composition->types > 1 ? composition->types : 1;
    for (int type = 0; type < model->types; type++)
        snprintf(model->name[type], sizeof model->name[type], "%s",
                 composition->name[type][0] ? composition->name[type] : "A");
}

void mf_engine_model(const struct engine_run *run, const struct engine_piece *piece,
                     struct export_model *model) {
    model->setup = run->fit->scene.setup;
    model->setup.potential = piece->potential;
    model->setup.omega = NULL;
    model->molecules = piece->molecules;
    for (int n = 0; piece->molecules && n < model->setup.interactions; n++)
        if (model->setup.interaction[n].kind == &mf_molecules)
            model->setup.interaction[n].parameters = piece->molecules;
    if (run->settings->time_step > 0)
        model->setup.time_step = run->settings->time_step;
    model->configurational = (struct export_number){NAN, NAN};
    model->rdf_range = piece->potential->cutoff;
    name_types(model);
    snprintf(model->folder, sizeof model->folder, "%s", run->folder);
}
