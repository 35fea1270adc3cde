# SPDX-License-Identifier: GPL-3.0-or-later
"""What pairs and terms do, for the models of engines beside this file: energies, and forces by
dU/dq of a term and the gradient of its q, which is taken numerically. Dihedrals are 0 for cis
and beyond 0 for i, j, k, l that turn clockwise, as IUPAC has it."""

import numpy


def measure(places):
    """q of terms from the places of their beads, shape [terms, beads, 3]."""
    steps = numpy.diff(places, axis=1)
    if steps.shape[1] == 1:
        return numpy.linalg.norm(steps[:, 0], axis=1)
    if steps.shape[1] == 2:
        sine = numpy.linalg.norm(numpy.cross(-steps[:, 0], steps[:, 1]), axis=1)
        return numpy.arctan2(sine, -(steps[:, 0] * steps[:, 1]).sum(1))
    a, b = numpy.cross(steps[:, 0], steps[:, 1]), numpy.cross(steps[:, 1], steps[:, 2])
    middle = numpy.linalg.norm(steps[:, 1], axis=1)
    return numpy.arctan2(middle * (steps[:, 0] * b).sum(1), (a * b).sum(1))


def whole(position, box, terms):
    """Places of the beads of terms, each nearest to the one before it."""
    places = position[terms]
    for bead in range(1, terms.shape[1]):
        away = places[:, bead] - places[:, bead - 1]
        places[:, bead] -= numpy.round(away / box) * box
    return places


def add_terms(position, box, terms, law, force):
    """Energy of terms of one law, (U, dU/dq) of q; their forces are added."""
    step = 1e-6
    places = whole(position, box, terms)
    energy, slope = law(measure(places))
    for bead in range(terms.shape[1]):
        for axis in range(3):
            moved = places.copy()
            moved[:, bead, axis] += step
            rise = measure(moved)
            moved[:, bead, axis] -= 2 * step
            rise = (rise - measure(moved) + numpy.pi) % (2 * numpy.pi) - numpy.pi
            numpy.add.at(force[:, axis], terms[:, bead], -slope * rise / (2 * step))
    return energy.sum()


def add_pairs(position, box, excluded, types, law, force):
    """Energy of all pairs by law(a, b), which gives the cutoff and a function (U, -dU/dr) of r."""
    energy = 0.0
    i, j = numpy.triu_indices(len(position), 1)
    near = position[i] - position[j]
    near -= numpy.round(near / box) * box
    r = numpy.linalg.norm(near, axis=1)
    left_out = {tuple(sorted(pair)) for pair in excluded}
    acts = numpy.array([pair not in left_out for pair in zip(i, j)])
    for a in range(max(types) + 1):
        for b in range(a, max(types) + 1):
            cutoff, of = law(a, b)
            here = acts & (r < cutoff) & (numpy.minimum(types[i], types[j]) == a) & (
                numpy.maximum(types[i], types[j]) == b)
            u, push = of(r[here])
            energy += u.sum()
            along = (push / r[here])[:, None] * near[here]
            numpy.add.at(force, i[here], along)
            numpy.add.at(force, j[here], -along)
    return energy
