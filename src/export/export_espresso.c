// SPDX-License-Identifier: GPL-3.0-or-later
//
// ESPResSo: its table holds its first value below the first row, which is at r = 0 here. The weight
// of its DPD friction is 1 − (r/r_c)^k, which is ours for k = 1 alone.
#include "export/export_script.h"

static void print(const struct export_job *job, FILE *stream) {
    mf_export_script_head(job, "espressomd", stream);
    fprintf(stream,
            "system = espressomd.System(box_l=box)\n"
            "system.time_step = time_step\n"
            "system.cell_system.skin = 0.1 * max(p[3] for p in pairs)\n"
            "types_of = start[:, 0].astype(int)\n"
            "system.part.add(type=types_of, pos=start[:, 1:4], v=start[:, 4:7],\n"
            "                mass=[masses[a] for a in types_of]) # feature MASS\n\n"
            "for a, b, name, cutoff, gamma, friction_cutoff in pairs: # feature TABULATED\n"
            "    rows = numpy.loadtxt(name + \".txt\")\n"
            "    system.non_bonded_inter[a, b].tabulated.set_params(\n"
            "        min=rows[0, 0], max=rows[-1, 0], energy=rows[:, 1], force=rows[:, 2])\n"
            "if linear: # feature DPD\n"
            "    for a, b, name, cutoff, gamma, friction_cutoff in pairs:\n"
            "        system.non_bonded_inter[a, b].dpd.set_params(\n"
            "            weight_function=1, k=1, gamma=gamma, r_cut=friction_cutoff,\n"
            "            trans_weight_function=1, trans_gamma=0, trans_r_cut=0)\n"
            "    system.thermostat.set_dpd(kT=kT, seed=1)\n"
            "else:\n"
            "    system.thermostat.set_langevin(kT=kT, gamma=masses[0] / slowing, seed=1)\n\n");
    mf_export_script_columns(job, true, stream);
    fprintf(stream, "for block in range(10):\n"
                    "    system.integrator.run(steps // 10)\n"
                    "    energy = system.analysis.energy()\n"
                    "    print(round(system.time / time_step),\n"
                    "          2 * energy[\"kinetic\"] / (3 * len(start)) * temperature / kT,\n"
                    "          system.analysis.pressure()[\"total\"] * pressure_unit, "
                    "energy[\"non_bonded\"])\n"
                    "numpy.savetxt(\"end.txt\", numpy.column_stack(\n"
                    "    (types_of, system.part.all().pos, system.part.all().v)))\n");
}

static enum status write(const struct export_job *job) {
    TRY(mf_export_script_files(job, 0));
    return mf_export_file(job, "run.py", print);
}

static void explain(const struct export_job *job, FILE *stream) {
    mf_export_script_explain(job, "its dpd interaction with weight_function 1 and k = 1", stream);
}

const struct export_engine mf_export_espresso = {
    .name = "espresso",
    .title = "ESPResSo",
    .summary = "run.py, start.txt, A-B.txt; reduced units, or nm, ps, kJ/mol",
    .system = EXPORT_NANOMETRES,
    .interpolation = &mf_export_grid_linear,
    .friction = EXPORT_LINEAR,
    .friction_name = "dpd with weight_function 1",
    .bath = "thermostat.set_langevin",
    .commands = "    pypresso run.py\n    pypresso run.py 100000   # steps\n",
    .verified = "The tables of such folders were checked against the source of the engine; nothing "
                "was run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .write = write,
    .explain = explain,
};
