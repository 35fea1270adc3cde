# SPDX-License-Identifier: GPL-3.0-or-later
"""A model of what scripts of ours call of ESPResSo, by its manual and source (4.3): the names, and
energies and forces of one configuration. What moves is not modelled."""

import types as _types

import numpy
import terms

from . import interactions


class _Table:
    def set_params(self, *, min, max, energy, force):
        assert len(energy) == len(force)
        self.min, self.max, self.energy, self.force = min, max, energy, force

    def law(self):
        return self.max, lambda r: (interactions.read(self.min, self.max, self.energy, r),
                                    interactions.read(self.min, self.max, self.force, r))


class _Friction:
    def set_params(self, *, weight_function, k, gamma, r_cut, trans_weight_function, trans_gamma,
                   trans_r_cut):
        assert weight_function in (0, 1) and trans_weight_function in (0, 1)
        self.numbers = dict(weight_function=weight_function, k=k, gamma=gamma, r_cut=r_cut,
                            trans_weight_function=trans_weight_function, trans_gamma=trans_gamma,
                            trans_r_cut=trans_r_cut)


class _Pairs(dict):
    def __missing__(self, pair):
        key = tuple(sorted(pair))
        if key not in self.keys():
            self[key] = _types.SimpleNamespace(tabulated=_Table(), dpd=_Friction())
        return dict.__getitem__(self, key)


class _Particle:
    def __init__(self, system, number):
        self.system, self.number = system, number

    def add_bond(self, bond):
        law, *partners = bond
        assert law in self.system.bonded_inter.known and len(partners) == law.beads - 1
        assert all(type(k) is int for k in partners)
        beads = [self.number, *partners]
        if law.beads > 2:  # its owner is in the second place
            beads[0], beads[1] = beads[1], beads[0]
        self.system.bonds.setdefault(law, []).append(beads)

    def add_exclusion(self, partner):
        assert type(partner) is int
        self.system.excluded.append((self.number, partner))


class _Particles:
    def __init__(self, system):
        self.system = system

    def add(self, *, type, pos, v, mass):
        self.type, self.pos, self.v, self.mass = type, numpy.array(pos), numpy.array(v), mass

    def by_id(self, p_id):
        assert isinstance(p_id, int) and 0 <= p_id < len(self.pos)
        return _Particle(self.system, p_id)

    def all(self):
        return self


class _Known:
    def __init__(self):
        self.known = []

    def add(self, law):
        self.known.append(law)


class System:
    def __init__(self, box_l):
        self.box, self.time, self.time_step = numpy.array(box_l), 0.0, None
        self.cell_system = _types.SimpleNamespace(skin=None)
        self.part, self.non_bonded_inter, self.bonded_inter = _Particles(self), _Pairs(), _Known()
        self.bonds, self.excluded = {}, []
        self.thermostat = _types.SimpleNamespace(set_dpd=lambda kT, seed: None,
                                                 set_langevin=lambda kT, gamma, seed: None)
        self.integrator = _types.SimpleNamespace(run=lambda steps: None)
        nothing = {"kinetic": numpy.nan, "non_bonded": numpy.nan, "total": numpy.nan}
        self.analysis = _types.SimpleNamespace(energy=lambda: nothing, pressure=lambda: nothing)

    def evaluate(self, position):
        force = numpy.zeros_like(position)
        energies = {"pairs": terms.add_pairs(
            position, self.box, self.excluded, numpy.asarray(self.part.type),
            lambda a, b: self.non_bonded_inter[a, b].tabulated.law(), force)}
        for law, beads in self.bonds.items():
            energy = terms.add_terms(position, self.box, numpy.array(beads), law.law, force)
            energies[law.kind] = energies.get(law.kind, 0.0) + energy
        return energies, force
