// SPDX-License-Identifier: GPL-3.0-or-later
//
// VOTCA: A-B.pot with rows r, Φ and a flag, "i" where pairs come and "o" in the core.
#include "base/memory.h"
#include "export/export_engine.h"
#include "io/votca.h"

static enum status write_curve(const struct export_job *job, enum export_curve curve, int pair) {
    const struct export_grid *grid = &job->grids.grid[curve][pair];
    char path[OUTPUT_PATH_SIZE], name[COMPOSITION_PAIR_NAME_SIZE];
    int type[2];
    size_t first = 0;
    for (size_t k = 0; k < grid->rows; k++)
        first += grid->r[k] < job->grids.error.from;
    mf_export_model_pair(job->model, pair, type, name);
    snprintf(path, sizeof path, "%.3800s/%s%s.pot", job->folder, name, mf_export_curve_name(curve));
    return mf_votca_write(path, grid->r, grid->phi,
                          (struct votca_scale){job->units.length, job->units.energy}, grid->rows,
                          first);
}

static enum status write(const struct export_job *job) {
    for (int n = 0; n < job->grids.curves * job->grids.pairs; n++)
        TRY(write_curve(job, (enum export_curve)(n / job->grids.pairs), n % job->grids.pairs));
    return STATUS_OK;
}

static void explain(const struct export_job *job, FILE *stream) {
    (void)job;
    fprintf(stream, "VOTCA makes tables of other programs from .pot files; it has no friction "
                    "weights.\n");
}

const struct export_engine mf_export_votca = {
    .name = "votca",
    .title = "VOTCA",
    .summary = "A-B.pot; nm, kJ/mol",
    .system = EXPORT_NANOMETRES,
    .physical = true,
    .interpolation = &mf_export_grid_spline,
    .commands = "    csg_resample --in A-A.pot --out table.pot --grid 0:0.002:1\n"
                "    csg_call --ia-type non-bonded --options settings.xml convert_potential "
                "lammps A-A.pot A-A.table\n",
    .verified = "Such files were checked against the format that VOTCA reads, and not run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .tables = write,
    .write = write,
    .explain = explain,
};
