# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands for files: dicts for JSON, arrays for tables, frames for trajectories."""

from __future__ import annotations

import ctypes
import json
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Callable, Union

import numpy as np

from . import _library as c
from ._errors import InputError
from ._library import Array

PathLike = Union[str, "os.PathLike[str]"]


def encode(text: Any, what: str = "a text") -> bytes:
    """Bytes of a text or path for the library, in which none ends too early."""
    if isinstance(text, os.PathLike):
        text = os.fspath(text)
    if isinstance(text, bytes):
        text = os.fsdecode(text)
    if not isinstance(text, str):
        raise InputError(f"{what}: expected a text, found {type(text).__name__}")
    if "\0" in text:
        raise InputError(f"{what}: a text with a NUL character")
    return os.fsencode(text)


def absolute(path: Any, what: str) -> Path:
    """A path for results: the process may be elsewhere when they are written, or read."""
    return Path(os.path.abspath(os.fsdecode(encode(path, what))))


def merge(base: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`base` with `changes` in it, at all depths (RFC 7396); None removes. Another law has other
    keys, and is put in the place of the one before."""
    result = dict(base)
    for key, value in changes.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, Mapping):
            before = result.get(key)
            if not isinstance(before, Mapping) or value.get("law") not in (None, before.get("law")):
                before = {}
            result[key] = merge(before, value)
        else:
            result[key] = value
    return result


def _is_masked(values: Any) -> bool:
    if isinstance(values, (list, tuple)):
        return any(_is_masked(value) for value in values)
    return isinstance(values, np.ma.MaskedArray) and bool(np.any(values.mask))


def array_of(values: Any, what: str) -> Array:
    """An array of doubles. What is masked has no value: numpy would give what is beneath."""
    if _is_masked(values):
        raise InputError(f"{what}: values are masked; leave them out, or fill them")
    try:
        if np.iscomplexobj(values):
            raise TypeError("values are complex; their real or imaginary part is a number")
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as fault:
        raise InputError(f"{what}: {fault}") from None


def read_only(array: Array) -> Array:
    """A copy, so that what is written to it would be lost in silence."""
    array.flags.writeable = False
    return array


def numbers(values: Any, what: str, shape: tuple[int | None, ...]) -> Array:
    """A contiguous array of doubles of that shape, None being any length."""
    array = np.ascontiguousarray(array_of(values, what))
    fits = array.ndim == len(shape) and all(
        n is None or n == m for n, m in zip(shape, array.shape))
    if not fits:
        wanted = ", ".join("any" if n is None else str(n) for n in shape)
        raise InputError(f"{what}: expected shape ({wanted}), found {array.shape}")
    return array


def pointer(array: Array) -> Any:
    return array.ctypes.data_as(c.NUMBERS)


class Memory:
    """Texts and tables that are lent for one call, and the struct that lends them."""

    def __init__(self) -> None:
        self.texts: dict[str, str] = {}
        self.tables: list[tuple[str, Array]] = []
        self.frames: Frames | None = None
        self.observables: Any = None  # an Observables

    def add_json(self, name: str, content: Any) -> str:
        """Lend an object as a text of this name, and the arrays in it as tables beside."""
        try:
            self.texts[name] = json.dumps(self._plain(content, name), allow_nan=False)
        except RecursionError as fault:
            raise InputError(f"{name}: {fault}") from None
        return name

    def _table(self, value: Any, path: str) -> str:
        array = numbers(getattr(value, "values", value), path, (None, None))
        name = f"<array {len(self.tables) + 1}>"
        self.tables.append((name, array))
        return name

    def _plain(self, value: Any, path: str) -> Any:
        if isinstance(value, Mapping):
            plain = {}
            for key, member in value.items():
                if not isinstance(key, str):
                    raise InputError(f"{path}: the key {key!r} is no text")
                inside = f"{path}: {key}"
                if key.endswith("file") and not isinstance(member, (str, os.PathLike, Mapping)):
                    plain[key] = self._table(member, inside)
                else:
                    plain[key] = self._plain(member, inside)
            return plain
        if isinstance(value, np.ndarray):
            if _is_masked(value):
                raise InputError(f"{path}: values are masked; leave them out, or fill them")
            return self._plain(value.tolist(), path)
        if isinstance(value, np.generic):
            return self._plain(value.item(), path)
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
            return [self._plain(member, path) for member in value]
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"{path}: {value} is not finite")
        if value is not None and not isinstance(value, (bool, int, float, str)):
            raise InputError(f"{path}: expected a number, a text, a list or a dict, found "
                             f"{type(value).__name__}")
        return value

    def lend(self) -> c.Inputs:
        """Valid as long as this object and what was added live."""
        self._texts = (c.Text * len(self.texts))(
            *[c.Text(encode(name), encode(text)) for name, text in self.texts.items()])
        self._tables = (c.Table * len(self.tables))(
            *[c.Table(name.encode(), *array.shape, pointer(array))
              for name, array in self.tables])
        inputs = c.Inputs(self._texts, len(self._texts), self._tables, len(self._tables))
        if self.frames is not None:
            self._trajectory = self.frames._lend()
            inputs.trajectory = ctypes.pointer(self._trajectory)
        if self.observables is not None:
            own = self.observables.lend()
            inputs.observables, inputs.observable_count = own, len(own)
        return inputs


# Frames -------------------------------------------------------------------------------------------

_LENGTHS = {"nm": 1.0, "angstrom": 0.1}
_TIMES = {"ps": 1.0, "fs": 1e-3, "ns": 1e3}


def _box(box: Any) -> Array:
    """Vectors of a box, one a row, of three edges, of edges and angles in degrees, or of vectors."""
    if box is None:
        return np.zeros((3, 3))
    array = array_of(box, "box")
    if array.shape == (3, 3):
        return array
    if array.shape == (3,):
        return np.diag(array)
    if array.shape != (6,):
        raise InputError(f"box: expected 3 edges, edges and angles, or 3 vectors; found shape "
                         f"{array.shape}")
    if not array[:3].all():
        return np.zeros((3, 3))
    edges = array[:3]
    cosines = [0.0 if angle == 90 else math.cos(math.radians(angle)) for angle in array[3:]]
    alpha, beta, gamma = cosines
    sine = math.sqrt(1 - gamma * gamma)
    a = [edges[0], 0, 0]
    b = [edges[1] * gamma, edges[1] * sine, 0]
    x, y = edges[2] * beta, edges[2] * (alpha - beta * gamma) / sine
    height = edges[2] ** 2 - x * x - y * y
    if not height > 0:
        raise InputError(f"box: there is no box of the angles {list(array[3:])}")
    return np.array([a, b, [x, y, math.sqrt(height)]])


class Frames:
    """Frames in memory, for `measure`.

    Parameters
    ----------
    positions : array, shape (frames, particles, 3), or a function
        Or ``positions(number)``, which gives the frame of that number, from 0 on, as a dict with
        "positions" and, if there are, "box", "time", "velocities" and "forces"; None behind the
        last.
    box : array, shape (3,), (6,), (3, 3), or one of these for each frame
        Edges; edges and angles in degrees; vectors, one a row. Without one nothing is periodic.
    types : sequence of str
        Names of the particles. Without `residues` each is a bead, called by its type.
    velocities : array, shape (frames, particles, 3), optional
    forces : array, shape (frames, particles, 3), optional
        In kJ/mol by the unit of length.
    times : array, shape (frames,), optional
        Without them there is no motion to be measured.
    residues : sequence of int, optional
        Number of the residue of each particle; a run of the same is one.
    residue_names : sequence of str, optional
    masses : sequence of float, optional [u]
    length : "nm", "angstrom" or a number of nm
    time : "ps", "fs", "ns" or a number of ps
        Units of all that is given.
    count : int, optional
        Of a function: how many frames there are. Any may then be asked for again. Without it the
        window of motion is 100 frames unless `measure` is told one.
    particles : int, optional
        Of a function, where no types are given.

    Raises
    ------
    InputError
        Shapes do not fit each other, or a unit is not known.
    """

    name = "<frames>"

    def __init__(self, positions: Any, box: Any = None, *, types: Any = None,
                 velocities: Any = None, forces: Any = None, times: Any = None,
                 residues: Any = None, residue_names: Any = None, masses: Any = None,
                 length: str | float = "nm", time: str | float = "ps",
                 count: int | None = None, particles: int | None = None) -> None:
        self.fault: BaseException | None = None
        self._first: Any = None
        self.length, self.time = _unit(length, _LENGTHS), _unit(time, _TIMES)
        if callable(positions):
            for what, given in (("box", box), ("velocities", velocities), ("forces", forces),
                                ("times", times)):
                if given is not None:
                    raise InputError(f"{what}: of a function they are in the dicts that it gives")
            self._get: Callable[[int], Any] = positions
            self.count = 0 if count is None else int(count)
            self.particles = particles if particles is not None else (
                len(types) if types is not None else 0)
        else:
            self._keep_arrays(positions, box, velocities, forces, times)
        if self.particles <= 0:
            raise InputError("frames: types, or the number of particles, are required")
        self._names = _names(types if types is not None else ["A"] * self.particles,
                             self.particles, "types")
        self._residues = None if residues is None else _count(
            np.ascontiguousarray(residues, dtype=np.int64), self.particles, "residues")
        self._residue_names = None
        if residues is not None:
            named = residue_names if residue_names is not None else ["RES"] * self.particles
            self._residue_names = _names(named, self.particles, "residue_names")
        elif residue_names is not None:
            raise InputError("residue_names: residues are required, too")
        self._masses = None if masses is None else numbers(masses, "masses", (self.particles,))

    def _keep_arrays(self, positions: Any, box: Any, velocities: Any, forces: Any,
                     times: Any) -> None:
        at = numbers(positions, "positions", (None, None, 3))
        self.count, self.particles = at.shape[0], at.shape[1]
        if self.count == 0:
            raise InputError("positions: there are no frames")
        speed = None if velocities is None else numbers(velocities, "velocities", at.shape)
        push = None if forces is None else numbers(forces, "forces", at.shape)
        when = None if times is None else numbers(times, "times", (self.count,))
        given = np.zeros((3, 3)) if box is None else array_of(box, "box")
        each = given.ndim > 1 and given.shape != (3, 3)
        if each and len(given) != self.count:
            raise InputError(f"box: {len(given)} boxes of {self.count} frames")
        boxes = given if each else _box(given)

        def get(number: int) -> dict[str, Any]:
            return {"positions": at[number], "box": boxes[number] if each else boxes,
                    "velocities": None if speed is None else speed[number],
                    "forces": None if push is None else push[number],
                    "time": None if when is None else when[number]}
        self._get = get

    def _read(self, context: Any, number: int, frame: Any) -> int:
        try:
            if number == 0 and self._first is not None:
                got = self._first
            else:
                got = self._get(number)
            if got is None:
                return 0
            if number == 0 and not self.count:
                self._first = got  # the library asks for it twice
            self._fill(got, number, frame.contents)
            return 1
        except BaseException as fault:  # noqa: B902 - raised again where the run was begun
            self.fault = fault
            return -1

    def _fill(self, got: Any, number: int, frame: Any) -> None:
        if not isinstance(got, Mapping) or "positions" not in got:
            raise InputError(f"frame {number + 1}: expected a dict with \"positions\", found "
                             f"{type(got).__name__}")
        positions = numbers(got["positions"], "positions", (self.particles, 3))
        velocities, forces = (
            None if got.get(what) is None else numbers(got[what], what, (self.particles, 3))
            for what in ("velocities", "forces"))
        time = got.get("time")
        frame.time = math.nan if time is None else float(array_of(time, "time"))
        if time is not None and not math.isfinite(frame.time):
            raise InputError(f"frame {number + 1}: its time, {frame.time}, is not finite")
        frame.box[:] = _box(got.get("box")).reshape(9).tolist()
        frame.positions = pointer(positions)
        frame.velocities = None if velocities is None else pointer(velocities)
        frame.forces = None if forces is None else pointer(forces)
        self._held = positions, velocities, forces

    def _lend(self) -> c.Trajectory:
        self.fault, self._first = None, None
        self._reader = c.FRAME_READER(self._read)
        return c.Trajectory(
            self.name.encode(), self.particles, self.count, self.length, self.time, self._names,
            self._residue_names,
            None if self._residues is None else self._residues.ctypes.data_as(
                ctypes.POINTER(ctypes.c_int64)),
            None if self._masses is None else pointer(self._masses), self._reader, None)

    def __repr__(self) -> str:
        return f"<Frames of {self.particles} particles, {self.count or 'unknown'} frames>"


def _unit(unit: str | float, known: dict[str, float]) -> float:
    if isinstance(unit, str):
        if unit not in known:
            raise InputError(f"the unit \"{unit}\" is none of {', '.join(known)}")
        return known[unit]
    return float(unit)


def _count(values: Any, count: int, what: str) -> Any:
    if len(values) != count:
        raise InputError(f"{what}: {len(values)} of {count} particles")
    return values


def _names(names: Any, count: int, what: str) -> Any:
    texts = [encode(str(name), what) for name in _count(list(names), count, what)]
    return (ctypes.c_char_p * count)(*texts)


def _attribute(group: Any, name: str) -> Any:
    """An attribute of an AtomGroup, which may know none of it."""
    try:
        return getattr(group, name)
    except Exception:  # NoDataError, of a package that may not be there
        return None


def from_universe(source: Any) -> Frames:
    """Frames of a Universe or an AtomGroup of MDAnalysis, or of what looks like one."""
    atoms = source.atoms
    universe = getattr(source, "universe", source)
    trajectory = universe.trajectory

    def get(number: int) -> dict[str, Any]:
        step = trajectory[number]
        return {"positions": atoms.positions, "box": step.dimensions, "time": step.time,
                "velocities": atoms.velocities if getattr(step, "has_velocities", False) else None,
                "forces": atoms.forces if getattr(step, "has_forces", False) else None}

    count = len(atoms)
    names = _attribute(atoms, "names")
    if names is None:
        names = _attribute(atoms, "types")
    residues = _attribute(atoms, "resindices")
    residue_names = _attribute(atoms, "resnames")
    if residue_names is None:
        residues = None
    elif residues is None:
        residues = _attribute(atoms, "resids")
    return Frames(get, types=names, masses=_attribute(atoms, "masses"), residues=residues,
                  residue_names=residue_names, length="angstrom", time="ps",
                  count=len(trajectory), particles=count)
