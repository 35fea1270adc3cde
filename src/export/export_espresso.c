// SPDX-License-Identifier: GPL-3.0-or-later
//
// ESPResSo: its table holds its first value below the first row, which is at r = 0 here. The weight
// of its DPD friction is 1 − (r/r_c)^k, along pairs and across them with one k.
#include "curves/bonded_table.h"
#include "export/export_script.h"

/// Ryckaert and Bellemans' are sums of waves, as tables of dihedrals are.
static bool has_law(const struct bonded_curve *curve) {
    return !bonded_is_table(curve->law) && curve->law != &mf_dihedral_ryckaert_bellemans;
}

/// The bonds of a group. TabulatedAngle takes +dU/dtheta for its force, and TabulatedDihedral
/// −dU/dphi over sin phi, which has no bound: a table of a dihedral becomes a Fourier series, of as
/// many waves as its slope needs.
static void print_laws(FILE *stream) {
    fprintf(stream,
            "import espressomd.interactions as laws\n\n\n"
            "def waves(rows): # from -pi on; energies differ by a constant\n"
            "    c = numpy.fft.rfft(rows[:-1, 1]) / (len(rows) - 1)\n"
            "    slopes = 2 * numpy.arange(len(c)) * abs(c)\n"
            "    left = slopes[::-1].cumsum()[::-1] # of a wave and those beyond it\n"
            "    return [laws.Dihedral(mult=n, bend=2 * abs(c[n]),\n"
            "                          phase=numpy.pi * (1 - n) - numpy.angle(c[n]))\n"
            "            for n in range(1, len(c)) if left[n] > 1e-4 * abs(rows[:, 2]).max()]\n\n\n"
            "def make(kind, law, numbers):\n"
            "    if law == \"table\":\n"
            "        rows = numpy.loadtxt(numbers[\"file\"])\n"
            "        if kind == \"bonds\": # feature TABULATED\n"
            "            return [laws.TabulatedDistance(min=rows[0, 0], max=rows[-1, 0],\n"
            "                                           energy=rows[:, 1], force=rows[:, 2])]\n"
            "        if kind == \"angles\": # the slope stands for the force\n"
            "            return [laws.TabulatedAngle(energy=rows[:, 1], force=-rows[:, 2])]\n"
            "        return waves(rows)\n"
            "    k = numbers[\"k\"]\n"
            "    if kind == \"bonds\" and law == \"harmonic\":\n"
            "        return [laws.HarmonicBond(k=k, r_0=numbers[\"length\"])]\n"
            "    if kind == \"bonds\":\n"
            "        return [laws.FeneBond(k=k, d_r_max=numbers[\"longest\"], r_0=0)]\n"
            "    if kind == \"dihedrals\":\n"
            "        return [laws.Dihedral(mult=int(numbers[\"multiplicity\"]), bend=k,\n"
            "                              phase=numbers[\"phase\"] + numpy.pi)]\n"
            "    if law == \"cosine\":\n"
            "        return [laws.AngleCosine(bend=k, phi0=numpy.pi)]\n"
            "    return [(laws.AngleHarmonic if law == \"harmonic\" else laws.AngleCossquare)(\n"
            "        bend=k, phi0=numbers[\"angle\"])]\n\n\n");
}

/// An angle is a bond of its middle bead, a dihedral of its second.
static void print_terms(FILE *stream) {
    fprintf(stream, "for kind, (groups, rows) in terms.items():\n"
                    "    owner = 0 if kind == \"bonds\" else 1\n"
                    "    for number, (name, law, numbers) in enumerate(groups):\n"
                    "        for bond in make(kind, law, numbers):\n"
                    "            system.bonded_inter.add(bond)\n"
                    "            for term in rows[rows[:, 0] == number, 1:].tolist():\n"
                    "                system.part.by_id(term.pop(owner)).add_bond((bond, *term))\n"
                    "for i, j in excluded.tolist(): # feature EXCLUSIONS\n"
                    "    system.part.by_id(i).add_exclusion(j)\n\n");
}

/// γ, cutoff and exponent of each pair's friction, along it and across.
static void print_frictions(const struct export_job *job, FILE *stream) {
    const double unit = export_units_friction(&job->units), length = job->units.length;
    fprintf(stream, "frictions = {}\n");
    for (int pair = 0; pair < job->grids.pairs; pair++) {
        const struct export_power *p = &job->power[pair], *t = &job->across[pair];
        char name[COMPOSITION_PAIR_NAME_SIZE];
        int type[2];
        if (!(p->cutoff > 0 || t->cutoff > 0))
            continue;
        mf_export_model_pair(job->model, pair, type, name);
        fprintf(stream,
                "frictions[%d, %d] = dict(k=%.12g, gamma=%.12g, r_cut=%.12g, trans_gamma=%.12g, "
                "trans_r_cut=%.12g)\n",
                type[0], type[1], p->cutoff > 0 ? p->exponent : t->exponent,
                p->amplitude * p->amplitude * unit, p->cutoff * length,
                t->amplitude * t->amplitude * unit, t->cutoff * length);
    }
}

static void print(const struct export_job *job, FILE *stream) {
    mf_export_script_head(job, "espressomd", stream);
    if (mf_export_dynamics_pairs(job))
        print_frictions(job, stream);
    if (job->model->molecules) {
        mf_export_terms_head(job, stream);
        print_laws(stream);
    }
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
            "        min=rows[0, 0], max=rows[-1, 0], energy=rows[:, 1], force=rows[:, 2])\n");
    if (job->model->molecules)
        print_terms(stream);
    fprintf(stream,
            "if dpd: # feature DPD\n"
            "    for (a, b), numbers in frictions.items():\n"
            "        system.non_bonded_inter[a, b].dpd.set_params(\n"
            "            weight_function=1, trans_weight_function=1, **numbers)\n"
            "    system.thermostat.set_dpd(kT=kT, seed=1)\n"
            "else:\n"
            "    system.thermostat.set_langevin(kT=kT, gamma=masses[0] / slowing, seed=1)\n\n");
    mf_export_script_columns(job, false, stream);
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
    TRY(mf_export_terms_files(job));
    return mf_export_file(job, "run.py", print);
}

static void explain(const struct export_job *job, FILE *stream) {
    mf_export_script_explain(job, "its dpd interaction with weight_function 1", stream);
    mf_export_script_excluded(job, stream);
}

const struct export_engine mf_export_espresso = {
    .name = "espresso",
    .title = "ESPResSo",
    .summary = "run.py, start.txt, A-B.txt; reduced units, or nm, ps, kJ/mol",
    .system = EXPORT_NANOMETRES,
    .interpolation = &mf_export_grid_linear,
    .friction = EXPORT_RISING,
    .across = true,
    .friction_name = "dpd with weight_function 1",
    .bath = "thermostat.set_langevin",
    .commands = "    pypresso run.py\n    pypresso run.py 100000   # steps\n",
    .verified =
        "Its calls are those of the manual and source of ESPResSo 4.3; a model of them has the "
        "energies and forces of the result. ESPResSo itself was not run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .molecules = true,
    .has_law = has_law,
    .tables = mf_export_script_tables,
    .write = write,
    .explain = explain,
};
