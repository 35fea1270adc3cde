#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""An engine for `mesofit fit run.json --engine "python3 openmm_engine.py"`: single beads by OpenMM.

The run file is in nm and ps. It is started in the folder of a piece, and leaves the frames, the temperature of each,
and last.npz, from which the next piece goes on.
"""
import json
import os

import numpy
import openmm

MASS = {"A": 18.015}  # of each type [u]
TIME_STEP = 0.005  # ps
PLATFORM = "Reference"  # "CUDA", "OpenCL" or "CPU" where there is one

GAS = 8.31446261815324e-3  # kJ/mol/K
asked = json.load(open("engine.json"))
box = numpy.array(asked["box"])
BEADS = asked["beads"]  # how many of each type
types = numpy.repeat(list(BEADS), list(BEADS.values()))
mass = [MASS[name] for name in types]


def pair_force(name, a, b):
    """The potential of a pair type, by a spline through its table; its slope at the ends is 0."""
    r, phi, _ = numpy.loadtxt(name, unpack=True)
    force = openmm.CustomNonbondedForce("phi(r)")
    force.addTabulatedFunction("phi", openmm.Continuous1DFunction(phi, r[0], r[-1]))
    force.setNonbondedMethod(openmm.CustomNonbondedForce.CutoffPeriodic)
    force.setCutoffDistance(r[-1])
    for _ in types:
        force.addParticle([])
    of = [[int(k) for k in numpy.flatnonzero(types == name)] for name in (a, b)]
    if len(BEADS) > 1:
        force.addInteractionGroup(*of)
    return force


def make_system():
    system = openmm.System()
    system.setDefaultPeriodicBoxVectors(*numpy.diag(box).tolist())
    for one in mass:
        system.addParticle(one)
    names = list(BEADS)
    for i, a in enumerate(names):
        for b in names[i:]:
            mixed = "potential_%s-%s.tsv" % (a, b)
            system.addForce(pair_force(mixed if len(names) > 1 else "potential.tsv", a, b))
    return system


def start():
    """Positions [nm] where the piece before has ended, or on a lattice, mixed."""
    if "before" in asked:
        return numpy.load(os.path.join(asked["before"], "last.npz"))["positions"]
    cells = int(numpy.ceil(len(types) ** (1 / 3)))
    grid = numpy.stack(numpy.meshgrid(*[numpy.arange(cells)] * 3), axis=-1).reshape(-1, 3)
    chosen = numpy.random.default_rng(asked["seed"]).permutation(len(grid))[: len(types)]
    return (grid[chosen] + 0.5) * box / cells


def temperature(state):
    """Kinetic, of velocities half a step back, as the integrator has them."""
    return 2 * state.getKineticEnergy()._value / (3 * len(types) * GAS)


integrator = openmm.LangevinMiddleIntegrator(asked["temperature"], 1.0, TIME_STEP)
integrator.setRandomNumberSeed(asked["seed"])
context = openmm.Context(make_system(), integrator, openmm.Platform.getPlatformByName(PLATFORM))
context.setPositions(start())
if "before" not in asked:
    openmm.LocalEnergyMinimizer.minimize(context, 10, 100)
context.setVelocitiesToTemperature(asked["temperature"], asked["seed"])
integrator.step(asked["equilibration"])
temperatures = []
with open(asked["trajectory"], "w") as out:
    for frame in range(asked["frames"]):
        integrator.step(asked["every"])
        state = context.getState(getPositions=True, getEnergy=True)
        places = state.getPositions(asNumpy=True)._value
        temperatures.append(temperature(state))
        out.write("frame %d\n%d\n" % (frame, len(types)))
        for k, place in enumerate(places):
            inside = place % box
            out.write("%5d%-5s%5s%5d%12.7f%12.7f%12.7f\n" % (k % 99999 + 1, "X", types[k], k % 99999 + 1, *inside))
        out.write(" %.7f %.7f %.7f\n" % tuple(box))
numpy.savez("last.npz", positions=places)
json.dump({"temperature": temperatures}, open("sample.json", "w"))
