# SPDX-License-Identifier: GPL-3.0-or-later
"""Bonds of ESPResSo by its manual and source (4.3): each gives (U, dU/dq) of q."""

import numpy


class Bond:
    def __init__(self, **numbers):
        assert set(numbers) == set(self.wanted), (type(self), numbers)
        self.__dict__.update(numbers)


class _Length(Bond):
    kind, beads = "bonds", 2


class _Angle(Bond):
    kind, beads = "angles", 3


class HarmonicBond(_Length):
    wanted = ("k", "r_0")

    def law(self, r):
        return 0.5 * self.k * (r - self.r_0)**2, self.k * (r - self.r_0)


class FeneBond(_Length):
    wanted = ("k", "d_r_max", "r_0")

    def law(self, r):
        share = ((r - self.r_0) / self.d_r_max)**2
        assert numpy.all(share < 1)
        return (-0.5 * self.k * self.d_r_max**2 * numpy.log(1 - share),
                self.k * (r - self.r_0) / (1 - share))


def read(low, high, values, q):
    """What is linear between rows, both ends among them."""
    return numpy.interp(q, numpy.linspace(low, high, len(values)), values)


class TabulatedDistance(_Length):
    wanted = ("min", "max", "energy", "force")

    def law(self, r):
        assert numpy.all(r < self.max)
        return read(self.min, self.max, self.energy, r), -read(self.min, self.max, self.force, r)


class AngleHarmonic(_Angle):
    wanted = ("bend", "phi0")

    def law(self, q):
        return 0.5 * self.bend * (q - self.phi0)**2, self.bend * (q - self.phi0)


class AngleCosine(_Angle):
    wanted = ("bend", "phi0")

    def law(self, q):
        return self.bend * (1 - numpy.cos(q - self.phi0)), self.bend * numpy.sin(q - self.phi0)


class AngleCossquare(_Angle):
    wanted = ("bend", "phi0")

    def law(self, q):
        away = numpy.cos(q) - numpy.cos(self.phi0)
        return 0.5 * self.bend * away**2, -self.bend * away * numpy.sin(q)


class TabulatedAngle(_Angle):
    """bonded_tab.hpp multiplies with -force/sin, where AngleHarmonic has -bend (phi - phi0)/sin."""
    wanted = ("energy", "force")

    def law(self, q):
        return read(0, numpy.pi, self.energy, q), read(0, numpy.pi, self.force, q)


class Dihedral(Bond):
    wanted, kind, beads = ("mult", "bend", "phase"), "dihedrals", 4

    def law(self, q):
        assert isinstance(self.mult, int)
        turn = self.mult * q - self.phase
        return self.bend * (1 - numpy.cos(turn)), self.bend * self.mult * numpy.sin(turn)
