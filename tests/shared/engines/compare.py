# SPDX-License-Identifier: GPL-3.0-or-later
"""compare.py FOLDER CONFIGURATIONS: what the engine of the script in FOLDER makes of
configurations, beside what we make of them: prints how far its energies of pairs, bonds, angles
and dihedrals are from ours, over the number of beads, and its forces, at most; one line.

CONFIGURATIONS has a line of beads, and of each configuration a line of these four energies and
lines of places and forces. Where an engine leaves out a constant of dihedrals, what their energy
has beyond that of the first configuration is compared."""

import os
import sys

import numpy


def openmm_evaluator(names):
    """Energies by groups of forces, and the forces of all."""
    import openmm
    kinds = ["pairs", "bonds", "angles", "dihedrals"]
    for force in names["system"].getForces():
        beads = force.getNumParticlesPerBond() if hasattr(force, "getNumParticlesPerBond") else 1
        force.setForceGroup(beads - 1)
    context = openmm.Context(names["system"], openmm.VerletIntegrator(0.001),
                             openmm.Platform.getPlatformByName("Reference"))

    def evaluate(position):
        context.setPositions(position.tolist())
        energies = {kind: context.getState(getEnergy=True, groups={group})
                    .getPotentialEnergy()._value for group, kind in enumerate(kinds)}
        return energies, context.getState(getForces=True).getForces(asNumpy=True)._value
    return evaluate


def load(folder):
    """A function of positions, by the script up to the steps it takes."""
    path = os.path.join(folder, "run.py")
    with open(path) as script:
        text = script.read()
    names = {"__file__": path}
    sys.argv = [path, "0"]
    if "import openmm" in text:
        exec(compile(text.split("context = ")[0], path, "exec"), names)
        return openmm_evaluator(names)
    exec(compile(text, path, "exec"), names)
    return (names["simulation"] if "simulation" in names else names["system"]).evaluate


def main():
    here = os.getcwd()
    with open(sys.argv[2]) as stream:
        count = int(stream.readline())
        numbers = numpy.array(stream.read().split(), float).reshape(-1, 4 + 6 * count)
    evaluate = load(sys.argv[1])
    os.chdir(here)
    kinds = ["pairs", "bonds", "angles", "dihedrals"]
    ours, theirs, worst = numbers[:, :4], [], 0.0
    for row in numbers:
        rows = row[4:].reshape(count, 6)
        energies, force = evaluate(rows[:, :3])
        theirs.append([energies.get(kind, 0.0) for kind in kinds])
        worst = max(worst, abs(force - rows[:, 3:]).max())
    away = numpy.array(theirs) - ours
    if "espressomd" in sys.modules:
        away[:, 3] -= away[0, 3]
    print(len(numbers), *(abs(away).max(0) / count), worst)


main()
