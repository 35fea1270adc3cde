#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""data.lattice: 117 rigid SPC/E molecules and 8 solutes on a lattice of 5 by 5 by 5 places, turned at random."""
import random
from math import cos, radians, sin

BOX, EDGE, SOLUTES = 15.7, 5, 8
OH, HALF_ANGLE = 1.0, radians(109.47 / 2)
CHARGE = {1: -0.8476, 2: 0.4238, 3: 0}


def product(a, b):
    return sum(x * y for x, y in zip(a, b))


def direction():
    v = [random.gauss(0, 1) for _ in range(3)]
    return [x / product(v, v) ** 0.5 for x in v]


def turned():
    """Two unit vectors at right angles, at random."""
    u, v = direction(), direction()
    v = [y - product(u, v) * x for x, y in zip(u, v)]
    return u, [x / product(v, v) ** 0.5 for x in v]


random.seed(1)
places = [[(n + 0.5) * BOX / EDGE for n in (i, j, k)] for i in range(EDGE) for j in range(EDGE) for k in range(EDGE)]
solutes = set(random.sample(range(len(places)), SOLUTES))
atoms, bonds, angles = [], [], []
for n, place in enumerate(places):
    atoms.append((n + 1, 3 if n in solutes else 1, place))
    if n in solutes:
        continue
    u, v = turned()
    oxygen = len(atoms)
    for sign in (1, -1):
        h = [x + OH * (cos(HALF_ANGLE) * a + sign * sin(HALF_ANGLE) * b) for x, a, b in zip(place, u, v)]
        atoms.append((n + 1, 2, h))
        bonds.append((oxygen, len(atoms)))
    angles.append((oxygen + 1, oxygen, oxygen + 2))

with open("data.lattice", "w") as out:
    out.write("SPC/E water and solutes\n\n%d atoms\n%d bonds\n%d angles\n" % (len(atoms), len(bonds), len(angles)))
    out.write("3 atom types\n1 bond types\n1 angle types\n\n")
    for axis in "xyz":
        out.write("0 %g %slo %shi\n" % (BOX, axis, axis))
    out.write("\nMasses\n\n1 15.9994\n2 1.008\n3 16.043\n\nAtoms # full\n\n")
    for n, (molecule, kind, place) in enumerate(atoms):
        out.write("%d %d %d %g %.5f %.5f %.5f\n" % (n + 1, molecule, kind, CHARGE[kind], *place))
    for name, lists in (("Bonds", bonds), ("Angles", angles)):
        out.write("\n%s\n\n" % name)
        for n, members in enumerate(lists):
            out.write("%d 1 %s\n" % (n + 1, " ".join(map(str, members))))
