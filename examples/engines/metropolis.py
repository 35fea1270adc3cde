#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""An engine for `mesofit fit run.json --engine "python3 metropolis.py"`: Metropolis moves of single beads of one type.

It reads engine.json and potential.tsv in the folder where it is started, and leaves the frames and last.npy, from
which the next piece goes on. A "time step" is a sweep: one move of every bead. The run file is in reduced units, or in
nm and ps.
"""
import json
import os

import numpy

asked = json.load(open("engine.json"))
box = numpy.array(asked["box"])
BEADS = sum(asked["beads"].values())
r, phi, _ = numpy.loadtxt("potential.tsv", unpack=True)
random = numpy.random.default_rng(asked["seed"])
in_nm = "[nm]" in open("potential.tsv").readline()
BOLTZMANN = 8.31446261815324e-3 if in_nm else 1  # kJ/mol/K
UNITS = "nm-ps" if in_nm else "lj"


def energy(place, others):
    """Sum of the potential between one bead and others."""
    apart = others - place
    apart -= box * numpy.rint(apart / box)
    return numpy.interp(numpy.sqrt((apart**2).sum(axis=1)), r, phi, right=0).sum()


def start():
    """Where the piece before has ended, or a lattice."""
    if "before" in asked:
        return numpy.load(os.path.join(asked["before"], "last.npy"))
    cells = int(numpy.ceil(BEADS ** (1 / len(box))))
    grid = numpy.stack(numpy.meshgrid(*[numpy.arange(cells)] * len(box)), axis=-1).reshape(-1, len(box))
    return (grid[:BEADS] + 0.5) * box / cells


def sweep(places, longest):
    """One move of every bead; returns which part was taken."""
    taken = 0
    for k in range(len(places)):
        others = numpy.delete(places, k, axis=0)
        trial = (places[k] + longest * (random.random(len(box)) - 0.5)) % box
        change = energy(trial, others) - energy(places[k], others)
        if change <= 0 or random.random() < numpy.exp(-change / (BOLTZMANN * asked["temperature"])):
            places[k] = trial
            taken += 1
    return taken / len(places)


places = start()
longest = 0.3
for _ in range(asked["equilibration"]):
    longest *= numpy.exp(0.2 * (sweep(places, longest) - 0.4))
with open(asked["trajectory"], "w") as out:
    lattice = " ".join("%.10g" % x for x in numpy.diag(box).ravel())
    for _ in range(asked["frames"]):
        for _ in range(asked["every"]):
            sweep(places, longest)
        out.write('%d\nLattice="%s" Properties=species:S:1:pos:R:3 Units=%s\n' % (BEADS, lattice, UNITS))
        out.writelines("A %.9g %.9g %.9g\n" % tuple(place) for place in places)
numpy.save("last.npy", places)
