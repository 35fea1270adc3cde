# SPDX-License-Identifier: GPL-3.0-or-later
"""A simulation that is stepped by the caller."""

from __future__ import annotations

import json
from typing import Any, Callable, NamedTuple

import numpy as np

from . import _library as c
from ._errors import InputError
from ._library import Array
from ._inputs import Memory, pointer, read_only
from ._run import Owned
from ._work import Content, Scene, _read


class Rdf(NamedTuple):
    """g(r).

    Attributes
    ----------
    r : array, shape (bins,) [lambda]
        Centres of the bins.
    g, error : array, shape (bins,)
        Values, and their standard errors.
    """

    r: Array
    g: Array
    error: Array


class Means(NamedTuple):
    """Means over samples with their standard errors; NaN: not known.

    Attributes
    ----------
    temperature, temperature_error : float [T_0]
    energy, energy_error : float [k_B T_0]
        Potential energy of a particle.
    pressure, pressure_error : float [k_B T_0/lambda^d]
    """

    temperature: float
    temperature_error: float
    energy: float
    energy_error: float
    pressure: float
    pressure_error: float


class Simulation(Owned):
    """A simulation that is stepped, looked at, and pushed by forces of one's own.

    All numbers are in reduced units; `units` says what 1 is of a scene that has units. Its memory
    goes with it, at the end of ``with Simulation(…) as simulation:``, or by `close`.

    Parameters
    ----------
    scene : Scene, dict or path
    **keys
        Put into the scene at its top.

    Raises
    ------
    InputError
        With the line that the program would print; also by what is asked of it while it runs.
    """

    _free = "mesofit_simulation_free"

    def __init__(self, scene: Content, **keys: Any) -> None:
        memory = Memory()
        memory.add_json("scene", Scene(_read(scene), **keys))
        inputs = memory.lend()
        self._faults: list[BaseException] = []  # of the force, which must not know of this
        self._force = c.FORCE(0)
        self._make(c.lib.mesofit_simulation_parse, memory.texts["scene"].encode(), inputs.tables,
                   inputs.table_count)

    # What it is -----------------------------------------------------------------------------------

    @property
    def scene(self) -> dict[str, Any]:
        """The scene as it was read, defaults filled in."""
        text = c.lib.mesofit_simulation_text(self._pointer)
        if text is None:
            raise MemoryError("out of memory")
        return dict(json.loads(text))

    @property
    def box(self) -> Array:
        """Edges of the box, shape (dimensions,) [lambda]."""
        return read_only(np.array(self.scene["edges"], dtype=np.float64))

    @property
    def units(self) -> dict[str, float]:
        """What 1 is, as "length_unit_nm"; empty of a scene without units."""
        return dict(self.scene.get("physical", {}))

    @property
    def step(self) -> int:
        """Steps that were made."""
        return int(c.lib.mesofit_simulation_step(self._pointer))

    @property
    def dimensions(self) -> int:
        """2 or 3."""
        return int(c.lib.mesofit_simulation_dimensions(self._pointer))

    def __len__(self) -> int:
        return int(c.lib.mesofit_simulation_count(self._pointer))

    @property
    def temperature(self) -> float:
        """Kinetic temperature now [T_0]; NaN without velocities."""
        return float(c.lib.mesofit_simulation_temperature(self._pointer))

    def _by_id(self, axis_of: Callable[[Any, int], Any]) -> Array:
        self._check_idle()
        count = len(self)
        ids = np.ctypeslib.as_array(c.lib.mesofit_simulation_ids(self._pointer), (count,))
        result = np.empty((count, self.dimensions))
        for axis in range(self.dimensions):
            result[ids, axis] = np.ctypeslib.as_array(axis_of(self._pointer, axis), (count,))
        return read_only(result)

    @property
    def positions(self) -> Array:
        """A copy that is read-only, shape (particles, dimensions), by the number of the particle
        [lambda]."""
        return self._by_id(c.lib.mesofit_simulation_positions)

    @property
    def velocities(self) -> Array:
        """A copy that is read-only, shape (particles, dimensions), by the number of the particle
        [lambda/tau]."""
        return self._by_id(c.lib.mesofit_simulation_velocities)

    # What it does ---------------------------------------------------------------------------------

    def set_force(self, force: Any) -> None:
        """Add forces of one's own from the next step on; None ends it.

        Parameters
        ----------
        force : callable, or a compiled function of the type `FORCE`
            ``force(positions, forces, ids)``, once or more often in each step: arrays of shape
            (particles, dimensions), in the order of `ids`. It adds to `forces` and returns the
            potential energy of all, or None. A Python function costs some 10 µs a call beside what
            it does; a function of numba (``@cfunc(…)``) or C costs nothing.

        Raises
        ------
        InputError
            It is no function. What it raises, or a force that is not finite, ends `run` with that
            step, and is raised by it.
        """
        self._check_idle()
        if force is None:
            self._force = c.FORCE(0)
        elif isinstance(force, c.FORCE):
            self._force = force
        elif hasattr(force, "address"):  # of numba
            self._force = c.FORCE(force.address)
        elif callable(force):
            self._force = self._wrap(force)
        else:
            raise InputError(f"force: expected a function, found {type(force).__name__}")
        c.lib.mesofit_simulation_set_force(self._pointer, self._force, None)

    def _wrap(self, force: Callable[..., Any]) -> Any:
        dimensions, faults, handle = self.dimensions, self._faults, self._pointer

        def call(context: Any, count: int, ids: Any, positions: Any, forces: Any) -> float:
            if faults:
                return 0.0
            try:
                shape = (count,)
                # Axis by axis in memory, as the library has them.
                at = np.stack([np.ctypeslib.as_array(positions[d], shape)
                               for d in range(dimensions)]).T
                added = np.zeros_like(at)
                energy = force(read_only(at), added, np.ctypeslib.as_array(ids, shape).copy())
                if added.shape != at.shape or not np.isfinite(added).all():
                    raise InputError("force: a force is not finite")
                for d in range(dimensions):
                    np.ctypeslib.as_array(forces[d], shape)[:] += added[:, d]
                return 0.0 if energy is None else float(energy)
            except BaseException as fault:  # noqa: B902 - raised again by run
                faults.append(fault)
                c.lib.mesofit_simulation_stop(handle)  # after this step
                return 0.0
        return c.FORCE(call)

    def _check_idle(self) -> None:
        if self._lock.locked():
            raise InputError("the simulation is running; a force is given its positions")

    def _call(self, function: Any, *arguments: Any) -> None:
        if not self._lock.acquire(blocking=False):
            raise InputError("the simulation is running")
        self._faults.clear()
        try:
            self._work(function, *arguments,
                       stop=lambda: c.lib.mesofit_simulation_stop(self._pointer))
        except KeyboardInterrupt:
            if not self._faults:  # which have stopped it
                raise
        finally:
            self._lock.release()
        if self._faults:
            raise self._faults.pop()

    def run(self, steps: int) -> "Simulation":
        """Advance. Ctrl-C is seen between steps, after which it can go on. A call costs some 50 µs
        beside its steps.

        Parameters
        ----------
        steps : int

        Returns
        -------
        Simulation
            Itself.

        Raises
        ------
        UnstableError
            It blew up.
        """
        self._call(c.lib.mesofit_simulation_run, _count(steps, "steps", 0))
        return self

    def rdf(self, *, range: float = 0.0, bins: int = 100, samples: int = 200,
            every: int = 25) -> Rdf:
        """Run samples · every steps and measure g(r). Ctrl-C ends it between steps, without a g(r).

        Parameters
        ----------
        range : float [lambda]
            0: to the cutoff of the forces.
        bins : int
        samples : int
        every : int
            Steps between samples.

        Returns
        -------
        Rdf

        Raises
        ------
        InputError
            The range is more than half of the box.
        UnstableError
            It blew up.
        """
        bins = _count(bins, "bins", 1)
        plan = c.RdfPlan(float(range), bins, _count(samples, "samples", 1),
                         _count(every, "every", 1))
        r, g, error = (np.empty(bins) for _ in "rge")
        self._call(c.lib.mesofit_simulation_rdf, plan, pointer(r), pointer(g),
                   pointer(error))
        return Rdf(r, g, error)

    def means(self, *, samples: int = 200, every: int = 25) -> Means:
        """Run samples · every steps and take means of temperature, energy and pressure. Ctrl-C as
        of `rdf`.

        Parameters
        ----------
        samples : int
        every : int
            Steps between samples.

        Returns
        -------
        Means

        Raises
        ------
        UnstableError
            It blew up.
        """
        means = c.Means()
        self._call(c.lib.mesofit_simulation_means, _count(samples, "samples", 1),
                   _count(every, "every", 1), means)
        return Means(*(getattr(means, name) for name in Means._fields))

    def __repr__(self) -> str:
        if not self._handle:
            return "<Simulation, closed>"
        return f"<Simulation of {len(self)} particles at step {self.step}>"


def _count(value: Any, what: str, least: int) -> int:
    """A whole number that the library can count to."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not (
            least <= value < 2**53):
        raise InputError(f"{what}: expected a whole number from {least} on, found {value!r}")
    return int(value)
