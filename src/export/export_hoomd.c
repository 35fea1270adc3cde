// SPDX-License-Identifier: GPL-3.0-or-later
//
// HOOMD-blue: its table has no row at the cutoff and no force below the first row. Two DPD objects
// would share their noise, and γ = 0 is an error: one object, and a cutoff of 0 without friction.
#include "export/export_script.h"

static bool has_law(const struct bonded_curve *curve) {
    return curve->law == &mf_bond_harmonic || curve->law == &mf_bond_fene ||
           curve->law == &mf_angle_harmonic || curve->law == &mf_angle_cosine_squared;
}

/// Terms, and special pairs for what molecules exclude, whatever their "exclude".
static void print_topology(FILE *stream) {
    fprintf(stream, "    for kind, (groups, rows) in terms.items():\n"
                    "        section = getattr(snapshot, kind)\n"
                    "        section.N = len(rows)\n"
                    "        section.types = [name for name, law, numbers in groups]\n"
                    "        section.typeid[:] = rows[:, 0]\n"
                    "        section.group[:] = rows[:, 1:]\n"
                    "    if len(excluded):\n"
                    "        snapshot.pairs.N = len(excluded)\n"
                    "        snapshot.pairs.types = [\"excluded\"]\n"
                    "        snapshot.pairs.group[:] = excluded\n");
}

/// A force for each law; it acts on all terms of its kind, and so has a strength of 0 for groups
/// with another law. FENE is without its repulsion.
static void print_terms(const struct export_job *job, FILE *stream) {
    fprintf(
        stream,
        "md = hoomd.md\n"
        "makers = {(\"bonds\", \"harmonic\"): md.bond.Harmonic,\n"
        "          (\"bonds\", \"fene\"): md.bond.FENEWCA,\n"
        "          (\"bonds\", \"table\"): lambda: md.bond.Table(width=width),\n"
        "          (\"angles\", \"harmonic\"): md.angle.Harmonic,\n"
        "          (\"angles\", \"cosine-squared\"): md.angle.CosineSquared,\n"
        "          (\"angles\", \"table\"): lambda: md.angle.Table(width=width),\n"
        "          (\"dihedrals\", \"table\"): lambda: md.dihedral.Table(width=width)}\n"
        "width = %zu # of all tables of terms\n\n\n"
        "def parameters(kind, law, numbers): # None: of a group with another law\n"
        "    if law == \"table\":\n"
        "        rows = numpy.loadtxt(numbers[\"file\"]) if numbers else numpy.zeros((width, 3))\n"
        "        if kind != \"bonds\":\n"
        "            return dict(U=rows[:, 1], tau=rows[:, 2])\n"
        "        return dict(r_min=0.0, r_max=rows[-1, 0] if numbers else max(box),\n"
        "                    U=rows[:, 1], F=rows[:, 2])\n"
        "    k = numbers[\"k\"] if numbers else 0.0\n"
        "    if kind == \"angles\":\n"
        "        return dict(k=k, t0=numbers[\"angle\"] if numbers else 0.0)\n"
        "    if law == \"harmonic\":\n"
        "        return dict(k=k, r0=numbers[\"length\"] if numbers else 0.0)\n"
        "    return dict(k=k, r0=numbers[\"longest\"] if numbers else 1.0,\n"
        "                epsilon=0.0, sigma=1.0, delta=0.0)\n\n\n"
        "for kind, (groups, rows) in terms.items():\n"
        "    for law in sorted({law for name, law, numbers in groups}):\n"
        "        force = makers[kind, law]()\n"
        "        for name, own, numbers in groups:\n"
        "            force.params[name] = parameters(kind, law, numbers if own == law else None)\n"
        "        forces.append(force)\n",
        job->bonded.rows);
}

static void print(const struct export_job *job, FILE *stream) {
    const bool molecules = job->model->molecules != NULL;
    mf_export_script_head(job, "hoomd", stream);
    if (molecules)
        mf_export_terms_head(job, stream);
    fprintf(stream, "simulation = hoomd.Simulation(device=hoomd.device.auto_select(), seed=1)\n"
                    "snapshot = hoomd.Snapshot()\n"
                    "if snapshot.communicator.rank == 0:\n"
                    "    snapshot.configuration.box = box + [0, 0, 0]\n"
                    "    snapshot.particles.N = len(start)\n"
                    "    snapshot.particles.types = types\n"
                    "    snapshot.particles.typeid[:] = start[:, 0].astype(int)\n"
                    "    snapshot.particles.mass[:] = [masses[int(a)] for a in start[:, 0]]\n"
                    "    snapshot.particles.position[:] = start[:, 1:4]\n"
                    "    snapshot.particles.velocity[:] = start[:, 4:7]\n");
    if (molecules)
        print_topology(stream);
    fprintf(stream,
            "simulation.create_state_from_snapshot(snapshot)\n\n"
            "cells = hoomd.md.nlist.Cell(buffer=0.1 * max(p[3] for p in pairs)%s)\n"
            "table = hoomd.md.pair.Table(nlist=cells)\n"
            "for a, b, name, cutoff, gamma, friction_cutoff in pairs:\n"
            "    rows = numpy.loadtxt(name + \".txt\")\n"
            "    table.params[(types[a], types[b])] = dict(r_min=rows[0, 0], U=rows[:, 1], "
            "F=rows[:, 2])\n"
            "    table.r_cut[(types[a], types[b])] = cutoff\n"
            "forces = [table]\n",
            molecules ? ", exclusions=[\"special_pair\"] if len(excluded) else []" : "");
    if (molecules)
        print_terms(job, stream);
    fprintf(stream, "if dpd:\n"
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
    mf_export_script_columns(job, false, stream);
    fprintf(stream,
            "for block in range(10):\n"
            "    simulation.run(steps // 10)\n"
            "    print(simulation.timestep, state.kinetic_temperature * temperature / kT,\n"
            "          state.pressure * pressure_unit, state.potential_energy)\n"
            "hoomd.write.GSD.write(state=simulation.state, filename=\"end.gsd\", mode=\"wb\")\n");
}

static enum status write(const struct export_job *job) {
    TRY(mf_export_script_files(job, 0.5)); // its box is around the origin
    TRY(mf_export_terms_files(job));
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
    .verified =
        "Its calls are those of the manual and source of HOOMD-blue 4.8; a model of them has "
        "the energies and forces of the result. HOOMD-blue itself was not run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .molecules = true,
    .has_law = has_law,
    .tables = mf_export_script_tables,
    .write = write,
    .explain = explain,
};
