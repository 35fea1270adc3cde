# SPDX-License-Identifier: GPL-3.0-or-later
"""A model of what scripts of ours call of HOOMD-blue, by its manual and source (4.8): the names,
the parameters that each force wants of each type, and energies and forces of one configuration.
What moves is not modelled. Of whatever the manual does not know it is an error to speak."""

import types as _types

import numpy
import terms


class _Parameters(dict):
    """Of each type the keys that the manual asks for, as numbers or arrays."""

    def __init__(self, *keys):
        super().__init__()
        self.keys_wanted = set(keys)

    def __setitem__(self, name, values):
        if isinstance(values, dict):
            assert set(values) == self.keys_wanted, (name, values)
            for value in values.values():
                assert numpy.all(numpy.isfinite(numpy.asarray(value, float))), (name, values)
        super().__setitem__(name, values)


class _Section:
    """Particles or terms of a snapshot: setting N makes the arrays."""

    def __init__(self, beads):
        self.__dict__.update(beads=beads, N=0, types=[])

    def __setattr__(self, name, value):
        self.__dict__[name] = value
        if name == "N" and self.beads:
            self.typeid = numpy.zeros(value, numpy.uint32)
            self.group = numpy.zeros((value, self.beads), numpy.uint32)
        elif name == "N":
            self.typeid, self.mass = numpy.zeros(value, numpy.uint32), numpy.ones(value)
            self.position, self.velocity = numpy.zeros((value, 3)), numpy.zeros((value, 3))
        elif name not in ("types", "typeid", "group", "mass", "position", "velocity"):
            raise AttributeError(name)


class Snapshot:
    def __init__(self):
        self.communicator = _types.SimpleNamespace(rank=0)
        self.configuration = _types.SimpleNamespace(box=None)
        self.particles = _Section(0)
        self.bonds, self.pairs, self.angles, self.dihedrals = map(_Section, (2, 2, 3, 4))


def _linear(first, spacing, values):
    """What is linear between rows; there is none behind the last."""
    padded = numpy.append(values, values[-1])

    def read(q):
        k = ((q - first) / spacing).astype(int)
        f = (q - first) / spacing - k
        return padded[k] + f * (padded[k + 1] - padded[k])
    return read


def _terms(kind, wanted, law):
    """A class of force on all terms of a kind; law(force, parameters) gives (U, dU/dq) of q."""
    class Force:
        def __init__(self, width=None):
            self.width, self.params = width, _Parameters(*wanted)

        def add(self, state, position, force):
            section, energy = getattr(state.snapshot, kind), 0.0
            for number, name in enumerate(section.types):
                mine = section.group[section.typeid == number].astype(int)
                energy += terms.add_terms(position, state.box, mine,
                                          law(self, self.params[name]), force)
            return energy
    Force.kind = kind
    return Force


def _harmonic(rest):
    return lambda force, p: lambda q: (0.5 * p["k"] * (q - p[rest])**2, p["k"] * (q - p[rest]))


def _fene(force, p):
    assert p["epsilon"] == 0 and p["delta"] == 0

    def law(r):
        share = (r / p["r0"])**2
        if p["k"] == 0:
            return 0 * r, 0 * r
        assert numpy.all(share < 1)
        return -0.5 * p["k"] * p["r0"]**2 * numpy.log(1 - share), p["k"] * r / (1 - share)
    return law


def _cosine_squared(force, p):
    def law(q):
        away = numpy.cos(q) - numpy.cos(p["t0"])
        return 0.5 * p["k"] * away**2, -p["k"] * away * numpy.sin(q)
    return law


def _table(low, high, slope):
    def make(force, p):
        assert len(p["U"]) == len(p[slope]) == force.width
        first, last = p.get("r_min", low), p.get("r_max", high)
        spacing = (last - first) / (force.width - 1)
        u, push = _linear(first, spacing, p["U"]), _linear(first, spacing, p[slope])

        def law(q):
            assert numpy.all(q <= last)
            return u(q), -push(q)
        return law
    return make


class _Pairs:
    def __init__(self, nlist, **settings):
        self.nlist, self.settings, self.r_cut = nlist, settings, {}
        self.params = _Parameters("r_min", "U", "F")

    def add(self, state, position, force):
        particles = state.snapshot.particles
        names = particles.types

        def law(a, b):
            pair = (names[a], names[b])
            pair = pair if pair in self.params else pair[::-1]
            p, cutoff = self.params[pair], self.r_cut[pair]
            spacing = (cutoff - p["r_min"]) / len(p["U"])
            read = [_linear(p["r_min"], spacing, numpy.append(p[key], 0)) for key in ("U", "F")]
            return cutoff, lambda r: (read[0](r), read[1](r))
        excluded = [tuple(pair) for pair in state.snapshot.pairs.group] if (
            "special_pair" in self.nlist.exclusions) else []
        assert set(self.nlist.exclusions) <= {"special_pair"}
        return terms.add_pairs(position, state.box, excluded, particles.typeid, law, force)


class _DPD(_Pairs):
    kind = "friction"

    def __init__(self, nlist, kT):
        super().__init__(nlist, kT=kT)
        self.params = _Parameters("A", "gamma")

    def add(self, state, position, force):
        assert all(p["A"] == 0 and p["gamma"] > 0 for p in self.params.values())
        return 0.0


_Pairs.kind = "pairs"


class _Cell:
    def __init__(self, buffer, exclusions=("bond",)):
        self.buffer, self.exclusions = buffer, exclusions


class _State:
    def __init__(self, filter):
        self.kinetic_temperature = self.pressure = self.potential_energy = numpy.nan


class Simulation:
    def __init__(self, device, seed):
        self.timestep, self.state = 0, None
        self.operations = _types.SimpleNamespace(integrator=None, computes=[])

    def create_state_from_snapshot(self, snapshot):
        self.state = _types.SimpleNamespace(snapshot=snapshot,
                                            box=numpy.array(snapshot.configuration.box[:3]))

    def run(self, steps):
        self.timestep += steps

    def evaluate(self, position):
        """Energies of pairs and of each kind of terms, and forces, of a configuration in the box
        from 0 on."""
        energies, force = {}, numpy.zeros_like(position)
        for part in self.operations.integrator.forces:
            energy = part.add(self.state, position, force)
            energies[part.kind] = energies.get(part.kind, 0.0) + energy
        return energies, force


def _langevin(filter, kT):
    return _types.SimpleNamespace(kT=kT, gamma={})


_space = _types.SimpleNamespace
device = _space(auto_select=lambda: None)
filter = _space(All=lambda: None)
write = _space(GSD=_space(write=lambda state, filename, mode: None))
md = _space(
    nlist=_space(Cell=_Cell),
    pair=_space(Table=_Pairs, DPD=_DPD),
    bond=_space(Harmonic=_terms("bonds", ["k", "r0"], _harmonic("r0")),
                FENEWCA=_terms("bonds", ["k", "r0", "epsilon", "sigma", "delta"], _fene),
                Table=_terms("bonds", ["r_min", "r_max", "U", "F"], _table(None, None, "F"))),
    angle=_space(Harmonic=_terms("angles", ["k", "t0"], _harmonic("t0")),
                 CosineSquared=_terms("angles", ["k", "t0"], _cosine_squared),
                 Table=_terms("angles", ["U", "tau"], _table(0, numpy.pi, "tau"))),
    dihedral=_space(Table=_terms("dihedrals", ["U", "tau"],
                                 _table(-numpy.pi, numpy.pi, "tau"))),
    methods=_space(ConstantVolume=lambda filter: None, Langevin=_langevin),
    compute=_space(ThermodynamicQuantities=_State),
    Integrator=lambda dt, methods, forces: _space(dt=dt, methods=methods, forces=forces))
