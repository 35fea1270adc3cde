// SPDX-License-Identifier: GPL-3.0-or-later
//
// HOOMD-blue: its table has no row at the cutoff and no force below the first row. Two DPD objects
// would share their noise, and γ = 0 is an error: one object, and a cutoff of 0 without friction.
#include "export/export_script.h"

static void print(const struct export_job *job, FILE *stream) {
    mf_export_script_head(job, "hoomd", stream);
    fprintf(stream, "simulation = hoomd.Simulation(device=hoomd.device.auto_select(), seed=1)\n"
                    "snapshot = hoomd.Snapshot()\n"
                    "if snapshot.communicator.rank == 0:\n"
                    "    snapshot.configuration.box = box + [0, 0, 0]\n"
                    "    snapshot.particles.N = len(start)\n"
                    "    snapshot.particles.types = types\n"
                    "    snapshot.particles.typeid[:] = start[:, 0].astype(int)\n"
                    "    snapshot.particles.mass[:] = [masses[int(a)] for a in start[:, 0]]\n"
                    "    snapshot.particles.position[:] = start[:, 1:4]\n"
                    "    snapshot.particles.velocity[:] = start[:, 4:7]\n"
                    "simulation.create_state_from_snapshot(snapshot)\n\n"
                    "cells = hoomd.md.nlist.Cell(buffer=0.1 * max(p[3] for p in pairs))\n"
                    "table = hoomd.md.pair.Table(nlist=cells)\n"
                    "for a, b, name, cutoff, gamma, friction_cutoff in pairs:\n"
                    "    rows = numpy.loadtxt(name + \".txt\")\n"
                    "    table.params[(types[a], types[b])] = dict(r_min=rows[0, 0], U=rows[:, 1], "
                    "F=rows[:, 2])\n"
                    "    table.r_cut[(types[a], types[b])] = cutoff\n"
                    "forces = [table]\n"
                    "if linear:\n"
                    "    friction = hoomd.md.pair.DPD(nlist=cells, kT=kT)\n"
                    "    for a, b, name, cutoff, gamma, friction_cutoff in pairs:\n"
                    "        friction.params[(types[a], types[b])] = dict(A=0, gamma=gamma or 1)\n"
                    "        friction.r_cut[(types[a], types[b])] = friction_cutoff\n"
                    "    forces.append(friction)\n"
                    "    method = hoomd.md.methods.ConstantVolume(filter=hoomd.filter.All())\n"
                    "else:\n"
                    "    method = hoomd.md.methods.Langevin(filter=hoomd.filter.All(), kT=kT)\n"
                    "    for a, mass in zip(types, masses):\n"
                    "        method.gamma[a] = mass / slowing\n"
                    "simulation.operations.integrator = hoomd.md.Integrator(dt=time_step, "
                    "methods=[method], forces=forces)\n"
                    "state = hoomd.md.compute.ThermodynamicQuantities(filter=hoomd.filter.All())\n"
                    "simulation.operations.computes.append(state)\n"
                    "simulation.always_compute_pressure = True # else there is none after a run\n");
    mf_export_script_columns(job, true, stream);
    fprintf(stream,
            "for block in range(10):\n"
            "    simulation.run(steps // 10)\n"
            "    print(simulation.timestep, state.kinetic_temperature * temperature / kT,\n"
            "          state.pressure * pressure_unit, state.potential_energy)\n"
            "hoomd.write.GSD.write(state=simulation.state, filename=\"end.gsd\", mode=\"wb\")\n");
}

static enum status write(const struct export_job *job) {
    TRY(mf_export_script_files(job, 0.5)); // its box is around the origin
    return mf_export_file(job, "run.py", print);
}

static void explain(const struct export_job *job, FILE *stream) {
    mf_export_script_explain(job, "hoomd.md.pair.DPD with A = 0", stream);
}

const struct export_engine mf_export_hoomd = {
    .name = "hoomd",
    .title = "HOOMD-blue",
    .summary = "run.py, start.txt, A-B.txt; reduced units, or nm, ps, kJ/mol",
    .system = EXPORT_NANOMETRES,
    .interpolation = &mf_export_grid_open,
    .friction = EXPORT_LINEAR,
    .friction_name = "hoomd.md.pair.DPD",
    .bath = "methods.Langevin",
    .commands = "    python3 run.py\n    python3 run.py 100000   # steps\n",
    .verified = "The tables of such folders were checked against the source of the engine; nothing "
                "was run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .write = write,
    .explain = explain,
};
