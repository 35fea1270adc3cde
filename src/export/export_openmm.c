// SPDX-License-Identifier: GPL-3.0-or-later
//
// OpenMM: the natural spline of a Continuous1DFunction, one force for each pair type. Its
// DPDIntegrator (from 8.3 on) multiplies the velocity of a pair by exp(−2 Δt friction (1 −
// r/r_c)²): friction is γ over twice the reduced mass, γ/m between beads of one mass.
#include "export/export_script.h"
#include "export/export_terms.h"
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

static void print(const struct export_job *job, FILE *stream) {
    mf_export_script_head(job, "openmm", stream);
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
        "    integrator = openmm.LangevinMiddleIntegrator(temperature, 1 / slowing, "
        "time_step)\n"
        "context = openmm.Context(system, integrator)\n"
        "context.setPositions(start[:, 1:4].tolist())\n"
        "context.setVelocities(start[:, 4:7].tolist())\n");
    mf_export_script_columns(job, false, stream);
    fprintf(stream,
            "for block in range(10):\n"
            "    integrator.step(steps // 10)\n"
            "    state = context.getState(getEnergy=True)\n"
            "    kinetic = state.getKineticEnergy()._value\n"
            "    print((block + 1) * (steps // 10), temperature * 2 * kinetic / (3 * len(start) * "
            "kT), state.getPotentialEnergy()._value)\n"
            "state = context.getState(getPositions=True, getVelocities=True)\n"
            "numpy.savetxt(\"end.txt\", numpy.column_stack((types_of,\n"
            "    state.getPositions(asNumpy=True)._value, state.getVelocities(asNumpy=True)."
            "_value)))\n");
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
    .commands = "    python3 run.py\n    python3 run.py 100000   # steps\n",
    .verified = "Such folders, also of molecules, were run with OpenMM 7.7 and its Langevin bath; "
                "DPDIntegrator "
                "is as in its source, and was not run.",
    .max_types = COMPOSITION_MAX_TYPES,
    .molecules = true,
    .has_law = has_law,
    .write = write,
    .explain = explain,
};
