# SPDX-License-Identifier: GPL-3.0-or-later
"""openmm_dpd.py FOLDER: what the script in FOLDER tells OpenMM's DPDIntegrator, by a model of the
calls that the manual of 8.3 has where OpenMM is older; of each pair of types a row: types,
friction [1/ps] and cutoff [nm]; then temperature [K], time step [ps] and the types of all
particles."""

import contextlib
import os
import sys

import openmm


class DPDIntegrator(openmm.LangevinMiddleIntegrator):
    """Keeps what it is told. Types and pairs are set before there is a context."""

    def __init__(self, temperature, default_friction, default_cutoff, step_size):
        super().__init__(temperature, 1, step_size)
        assert default_friction >= 0 and default_cutoff > 0
        self.default_cutoff, self.pairs, self.types = default_cutoff, {}, {}

    def setParticleType(self, index, kind):
        assert type(index) is int and type(kind) is int
        self.types[index] = kind

    def addTypePair(self, first, second, friction, cutoff):
        assert type(first) is int and type(second) is int and 0 < cutoff <= self.default_cutoff
        assert (first, second) not in self.pairs and (second, first) not in self.pairs
        self.pairs[first, second] = friction, cutoff


def main():
    path = os.path.join(sys.argv[1], "run.py")
    with open(path) as script:
        text = script.read().split("integrator.step(")[0]
    openmm.DPDIntegrator = DPDIntegrator
    sys.argv = [path, "0"]
    names = {"__file__": path}
    with contextlib.redirect_stdout(sys.stderr):
        exec(compile(text, path, "exec"), names)
    integrator = names["integrator"]
    for (first, second), (friction, cutoff) in integrator.pairs.items():
        print(first, second, friction, cutoff)
    print(integrator.getTemperature()._value, integrator.getStepSize()._value,
          *(integrator.types[k] for k in range(len(names["start"]))))


main()
