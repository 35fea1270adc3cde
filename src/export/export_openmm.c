// SPDX-License-Identifier: GPL-3.0-or-later
//
// OpenMM: the natural spline of a Continuous1DFunction, one force for each pair type. Its
// DPDIntegrator (from 8.3 on) multiplies the velocity of a pair by exp(−2 Δt friction (1 −
// r/r_c)²): friction is γ over twice the reduced mass, γ/m between beads of one mass.
#include "export/export_checks.h"
#include "export/export_script.h"
#include "curves/bonded_table.h"

static bool has_law(const struct bonded_curve *curve) {
    return !bonded_is_table(curve->law);
}

/// A force for each group of terms, of the formulas of our laws: CustomCompoundBondForce alone has
/// tables. Beyond its last row a table goes on as a straight line, as ours does.
static void print_terms(FILE *stream) {
    fprintf(
        stream,
        "places = {\"bonds\": (2, \"; r=distance(p1,p2)\"),\n"
        "          \"angles\": (3, \"; theta=angle(p1,p2,p3)\"),\n"
        "          \"dihedrals\": (4, \"; x=-cos(phi); phi=dihedral(p1,p2,p3,p4)\")}\n"
        "energies = {(\"bonds\", \"harmonic\"): \"0.5*k*(r-length)^2\",\n"
        "            (\"bonds\", \"fene\"): \"-0.5*k*longest^2*log(1-(r/longest)^2)\",\n"
        "            (\"bonds\", \"table\"): \"u(min(r,last))+slope*max(0,r-last)\",\n"
        "            (\"angles\", \"harmonic\"): \"0.5*k*(theta-angle)^2\",\n"
        "            (\"angles\", \"cosine\"): \"k*(1+cos(theta))\",\n"
        "            (\"angles\", \"cosine-squared\"): \"0.5*k*(cos(theta)-cos(angle))^2\",\n"
        "            (\"angles\", \"table\"): \"u(min(theta,last))\",\n"
        "            (\"dihedrals\", \"periodic\"): \"k*(1+cos(multiplicity*phi-phase))\",\n"
        "            (\"dihedrals\", \"ryckaert-bellemans\"):\n"
        "                \"c0+x*(c1+x*(c2+x*(c3+x*(c4+x*c5))))\",\n"
        "            (\"dihedrals\", \"table\"): \"u(phi)\"}\n"
        "for kind, (groups, rows) in terms.items():\n"
        "    for number, (name, law, numbers) in enumerate(groups):\n"
        "        beads, place = places[kind]\n"
        "        force = openmm.CustomCompoundBondForce(beads, energies[kind, law] + place)\n"
        "        force.setUsesPeriodicBoundaryConditions(True)\n"
        "        if law == \"table\":\n"
        "            table = numpy.loadtxt(numbers[\"file\"])\n"
        "            force.addTabulatedFunction(\"u\", openmm.Continuous1DFunction(\n"
        "                table[:, 1].tolist(), table[0, 0], table[-1, 0], kind == \"dihedrals\"))\n"
        "            numbers = dict(last=table[-1, 0], slope=-table[-1, 2])\n"
        "        for parameter in numbers:\n"
        "            force.addPerBondParameter(parameter)\n"
        "        for term in rows[rows[:, 0] == number, 1:].tolist():\n"
        "            force.addBond(term, list(numbers.values()))\n"
        "        system.addForce(force)\n\n");
}

/// The context, and for how long it will run: a platform without CPU or CUDA takes an hour.
static void print_context(const struct export_job *job, FILE *stream) {
    fprintf(stream,
            "context = openmm.Context(system, integrator)\n"
            "context.setPositions(start[:, 1:4].tolist())\n"
            "context.setVelocities(start[:, 4:7].tolist())\n"
            "settling, trial = %d, 10\n"
            "integrator.step(trial)\n"
            "context.getState(getEnergy=True)\n"
            "began = time.time()\n"
            "integrator.step(trial)\n"
            "context.getState(getEnergy=True)\n"
            "print(\"# platform %%s: %%d steps take about %%.2g min\" %% "
            "(context.getPlatform().getName(),\n"
            "      settling + steps, (time.time() - began) / trial * (settling + steps) / 60), "
            "flush=True)\n",
            job->model->equilibrated ? 1000 : 5000);
}

/// OpenMM tells no virial: the pressure is by the energies of a box that is a little larger, and
/// smaller, if twice the cutoff still fits, which OpenMM asks for.
static void print_pressure(FILE *stream) {
    fprintf(stream,
            "def pressure_of(state):\n"
            "    places = state.getPositions(asNumpy=True)._value\n"
            "    edges = state.getPeriodicBoxVectors(asNumpy=True)._value\n"
            "    energy, high = [], 1 + 1e-4\n"
            "    fits = 2 * max(p[3] for p in pairs) / edges.diagonal().min() * (1 + 1e-9)\n"
            "    low = min(1, max(1 - 1e-4, fits))\n"
            "    for scale in high, low, 1: # the last one as it was\n"
            "        context.setPeriodicBoxVectors(*(scale * edges))\n"
            "        context.setPositions(scale * places)\n"
            "        energy.append(context.getState(getEnergy=True).getPotentialEnergy()._value)\n"
            "    volume = state.getPeriodicBoxVolume()._value\n"
            "    return (2 * state.getKineticEnergy()._value / 3\n"
            "            - (energy[0] - energy[1]) / (3 * (high - low))) / volume * pressure_unit"
            "\n\n\n");
}

/// Frames in extended XYZ, in nm and ps, and lines of energies.
static void print_run(const struct export_job *job, FILE *stream) {
    fprintf(stream,
            "integrator.step(settling - 2 * trial)\n\n\n"
            "def write_frame(stream, state, time):\n"
            "    rows = numpy.column_stack((state.getPositions(asNumpy=True)._value,\n"
            "                               state.getVelocities(asNumpy=True)._value))\n"
            "    a, b, c = state.getPeriodicBoxVectors(asNumpy=True)._value.diagonal()\n"
            "    stream.write(f'{len(rows)}\\nLattice=\"{a} 0 0 0 {b} 0 0 0 {c}\" pbc=\"T T T\" '\n"
            "                 f'Units=nm-ps Time={time:.9g} '\n"
            "                 'Properties=name:S:1:pos:R:3:velo:R:3:masses:R:1\\n')\n"
            "    for a, row in zip(types_of, rows):\n"
            "        stream.write(types[a] + \" %%.8g %%.8g %%.8g %%.6g %%.6g %%.6g %%.9g\\n\"\n"
            "                     %% (*row, masses[a]))\n\n\n");
    print_pressure(stream);
    mf_export_script_columns(job, true, stream);
    fprintf(stream,
            "frames = open(\"trajectory.xyz\", \"w\")\n"
            "for block in range(100):\n"
            "    integrator.step(steps // 100)\n"
            "    state = context.getState(getPositions=True, getVelocities=True, getEnergy=True)\n"
            "    step = (block + 1) * (steps // 100)\n"
            "    write_frame(frames, state, step * time_step)\n"
            "    print(step, temperature * 2 * state.getKineticEnergy()._value / (3 * len(start) * "
            "kT),\n"
            "          pressure_of(state), state.getPotentialEnergy()._value,\n"
            "          len(start) / state.getPeriodicBoxVolume()._value)\n"
            "frames.close()\n"
            "numpy.savetxt(\"end.txt\", numpy.column_stack((types_of,\n"
            "    state.getPositions(asNumpy=True)._value, state.getVelocities(asNumpy=True)."
            "_value)))\n");
}

static void print(const struct export_job *job, FILE *stream) {
    mf_export_script_head(job, "openmm\nimport time", stream);
    if (job->model->molecules)
        mf_export_terms_head(job, stream);
    fprintf(stream,
            "system = openmm.System()\n"
            "system.setDefaultPeriodicBoxVectors((box[0], 0, 0), (0, box[1], 0), (0, 0, box[2]))\n"
            "types_of = start[:, 0].astype(int)\n"
            "for a in types_of:\n"
            "    system.addParticle(masses[a])\n"
            "for a, b, name, cutoff, gamma, friction_cutoff in pairs:\n"
            "    rows = numpy.loadtxt(name + \".txt\")\n"
            "    force = openmm.CustomNonbondedForce(\"phi(r)\")\n"
            "    force.addTabulatedFunction(\"phi\", openmm.Continuous1DFunction(\n"
            "        rows[:, 1].tolist(), rows[0, 0], rows[-1, 0]))\n"
            "    force.setNonbondedMethod(openmm.CustomNonbondedForce.CutoffPeriodic)\n"
            "    force.setCutoffDistance(cutoff)\n"
            "    for particle in types_of:\n"
            "        force.addParticle([])\n"
            "    if len(types) > 1:\n"
            "        force.addInteractionGroup(numpy.flatnonzero(types_of == a).tolist(),\n"
            "                                  numpy.flatnonzero(types_of == b).tolist())\n"
            "%s"
            "    system.addForce(force)\n\n",
            job->model->molecules ? "    for i, j in excluded:\n"
                                    "        force.addExclusion(int(i), int(j))\n"
                                  : "");
    if (job->model->molecules)
        print_terms(stream);
    fprintf(
        stream,
        "if dpd and hasattr(openmm, \"DPDIntegrator\"):\n"
        "    integrator = openmm.DPDIntegrator(temperature, 0, max(p[5] for p in pairs), "
        "time_step)\n"
        "    for particle, a in enumerate(types_of):\n"
        "        integrator.setParticleType(particle, int(a))\n"
        "    for a, b, name, cutoff, gamma, friction_cutoff in pairs:\n"
        "        if gamma > 0: # over twice the reduced mass\n"
        "            integrator.addTypePair(a, b, gamma * (1 / masses[a] + 1 / masses[b]) / 2,\n"
        "                                   friction_cutoff)\n"
        "else:\n"
        "    if dpd:\n"
        "        print(\"# a Langevin bath: this OpenMM has no DPDIntegrator\")\n"
        "    integrator = openmm.LangevinMiddleIntegrator(temperature, 1 / slowing, "
        "time_step)\n"
        "if len(sys.argv) > 2: # constant pressure\n"
        "    system.addForce(openmm.MonteCarloBarostat(float(sys.argv[2]), temperature))\n");
    print_context(job, stream);
    print_run(job, stream);
}

static enum status write(const struct export_job *job) {
    TRY(mf_export_script_files(job, 0));
    TRY(mf_export_terms_files(job));
    return mf_export_file(job, "run.py", print);
}

static void explain(const struct export_job *job, FILE *stream) {
    mf_export_script_explain(job,
                             "DPDIntegrator with friction gamma/(2 m), m the reduced mass, from "
                             "version 8.3 on; an older "
                             "one runs a Langevin bath",
                             stream);
    mf_export_script_excluded(job, stream);
    fprintf(stream,
            "\nrun.py lets the start settle for %d steps, and then prints temperature, pressure, "
            "energy "
            "and density a hundred times\nand writes as many frames to trajectory.xyz (nm, ps). "
            "end.txt has the last one in the columns of start.txt:\ncopied over that, it lets a "
            "run at constant volume go on.\n\n",
            job->model->equilibrated ? 1000 : 5000);
    mf_export_checks_rdf(job, "trajectory.xyz", stream);
    char command[64];
    snprintf(command, sizeof command, "    python3 run.py 100000 %.4g   # steps, pressure\n",
             mf_export_checks_usual_pressure(job));
    mf_export_checks_pressure(job, command, stream);
}

const struct export_engine mf_export_openmm = {
    .name = "openmm",
    .title = "OpenMM",
    .summary = "run.py, start.txt, A-B.txt; nm, ps, kJ/mol",
    .system = EXPORT_NANOMETRES,
    .physical = true,
    .interpolation = &mf_export_grid_spline,
    .friction = EXPORT_LINEAR,
    .friction_name = "DPDIntegrator, from version 8.3 on (an older one runs a bath)",
    .bath = "LangevinMiddleIntegrator",
    .commands = "    python3 run.py\n    python3 run.py 100000   # steps that are measured\n",
    .verified = "Such folders, also of molecules, were run with OpenMM 7.7 and its Langevin bath; "
                "DPDIntegrator "
                "is called as its manual and source have it, and was not run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .molecules = true,
    .has_law = has_law,
    .tables = mf_export_script_tables,
    .write = write,
    .explain = explain,
};
