# SPDX-License-Identifier: GPL-3.0-or-later
"""openmm_rdf.py FOLDER STEPS RANGE BINS: g(r) of all pairs that act in a run of the script in FOLDER, of
every fifth step after a fifth of them, and the mean temperature; one row a bin, r, g, T."""

import contextlib
import os
import sys

import numpy


def main():
    folder, steps, last, bins = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])
    path = os.path.join(folder, "run.py")
    with open(path) as script:
        text = script.read().split("for block in")[0]
    sys.argv = [path, "0"]
    names = {"__file__": path}
    with contextlib.redirect_stdout(sys.stderr):  # what it says of its columns
        exec(compile(text, path, "exec"), names)
    integrator, context, box = names["integrator"], names["context"], numpy.array(names["box"])
    count = len(names["start"])
    integrator.setRandomNumberSeed(3)
    acts = numpy.triu(numpy.ones((count, count), bool), 1)
    acts[tuple(names["excluded"].T)] = False
    i, j = numpy.nonzero(acts)
    sums, kinetic, samples = numpy.zeros(bins), 0.0, 0
    integrator.step(steps // 5)
    for _ in range(steps * 4 // 5 // 5):
        integrator.step(5)
        state = context.getState(getPositions=True, getEnergy=True)
        x = state.getPositions(asNumpy=True)._value
        apart = x[i] - x[j]
        apart -= numpy.round(apart / box) * box
        sums += numpy.histogram(numpy.linalg.norm(apart, axis=1), bins, (0, last))[0]
        kinetic += state.getKineticEnergy()._value
        samples += 1
    edges = numpy.linspace(0, last, bins + 1)
    shells = 4 / 3 * numpy.pi * (edges[1:]**3 - edges[:-1]**3)
    g = sums / samples * box.prod() / shells / (count * (count - 1) / 2)
    temperature = names["temperature"] * 2 * kinetic / samples / (3 * count * names["kT"])
    for k in range(bins):
        print((edges[k] + edges[k + 1]) / 2, g[k], temperature)


main()
