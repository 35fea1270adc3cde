# SPDX-License-Identifier: GPL-3.0-or-later
"""An inversion whose samples somebody else makes: ask for them, and tell them."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ._errors import InputError, InterruptedWarning
from ._inputs import PathLike, array_of
from ._library import Array
from ._result import Result
from ._result import open as open_result
from ._run import Folder
from ._table import Table
from ._work import fit_with

_FRAMES = "frames.extxyz"


def _finite(values: Any, what: str) -> Array:
    array = array_of(values, what)
    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        raise InputError(f"{what}: the value at {wrong[0].tolist()} is {array[tuple(wrong[0])]}")
    return array


class Piece:
    """Samples that a replica asks for.

    Attributes
    ----------
    folder : pathlib.Path
        Of its files.
    asked : dict
        What engine.json says (docs/any-engine.md): ``asked["seed"]``, ``asked["temperature"]``,
        ``asked["equilibration"]`` and ``asked["every"]`` in time steps, ``asked["frames"]``.
    before : pathlib.Path or None
        Folder of the piece from whose last configuration this one goes on; None: it begins anew.
    """

    def __init__(self) -> None:
        self.folder = Path()
        self.asked: dict[str, Any] = {}
        self.before: Path | None = None
        self._units = ""

    @classmethod
    def _at(cls, folder: Path, units: str) -> "Piece":
        piece = cls()
        piece.folder, piece._units = folder, units
        piece.asked = json.loads((folder / "engine.json").read_text())
        before = piece.asked.get("before")
        piece.before = (folder / before).resolve() if before else None
        return piece

    @property
    def told(self) -> bool:
        """Whether its samples are there."""
        return Path(self.folder, self.asked["trajectory"]).exists()

    @property
    def potentials(self) -> dict[str, Table]:
        """Φ of each pair type, by names such as "A-B" ("" of beads of one type): columns r, phi, force."""
        tables = {}
        for path in sorted(self.folder.glob("potential*.tsv")):
            heading = path.read_text().partition("\n")[0].strip("# ").split("\t")
            names = tuple(word.split("[")[0] for word in heading)
            units = tuple(word.split("[")[1].rstrip("]") for word in heading)
            name = path.stem[len("potential_"):]
            tables[name] = Table(name or "potential", names, units, np.loadtxt(path))
        return tables

    def tell(self, positions: Any, *, pressure: Any = None, temperature: Any = None,
             pair_energy: Any = None, boxes: Any = None) -> None:
        """The samples.

        Parameters
        ----------
        positions : array, shape (frames, beads, dimensions)
            In the units of the run file, beads in the order of the scene's types.
        pressure, temperature, pair_energy : array, shape (frames,), optional
            Of each frame: what is known of it besides.
        boxes : array, shape (frames, dimensions), optional
            Edges of each frame, at constant pressure; as asked for if none are given.

        Raises
        ------
        InputError
            The array has another shape, fewer frames than were asked for, another unit, or values
            that are masked or not finite.
        """
        box = np.array(self.asked["box"], dtype=float)
        places = _finite(positions, "positions")
        wanted = self.asked["frames"]
        if places.ndim != 3 or places.shape[2] != len(box) or len(places) < wanted:
            raise InputError(f"positions: expected {wanted} frames of beads of {len(box)} coordinates, "
                             f"found the shape {places.shape}")
        numbers = {name: np.ravel(_finite(values, name))[:wanted].tolist()
                   for name, values in (("pressure", pressure), ("temperature", temperature),
                                        ("pair_energy", pair_energy)) if values is not None}
        if any(len(values) != wanted for values in numbers.values()):
            raise InputError(f"expected {wanted} numbers, one of each frame")
        edges = np.broadcast_to(box if boxes is None else _finite(boxes, "boxes"),
                                (len(places), len(box)))
        names = self._names(places.shape[1])
        self._check_unit(places[0] / edges[0])
        (self.folder / "sample.json").write_text(json.dumps(numbers))
        with (self.folder / "partial").open("w") as out:
            for frame, edge in zip(places[:wanted], edges):
                frame = np.pad(frame, ((0, 0), (0, 3 - len(box))))
                lattice = np.diag(np.append(edge, np.ones(3 - len(box)))).ravel()
                out.write(f'{len(frame)}\nLattice="{" ".join("%.12g" % x for x in lattice)}" '
                          f'Properties=species:S:1:pos:R:3 {self._units}\n')
                out.writelines("%s %.10g %.10g %.10g\n" % (name, *place)
                               for name, place in zip(names, frame))
        (self.folder / "partial").rename(self.folder / self.asked["trajectory"])  # whole or not at all

    def _check_unit(self, places: Array) -> None:
        """Places of a frame in the edges of its box; as of frames that are read."""
        farthest, spread = np.abs(places).max(), np.sqrt(12 * np.var(places, axis=0)).min()
        if len(places) > 1 and (farthest < 0.12 or (self.before is None and spread > 4)):
            raise InputError(f"positions: the beads are spread over {min(farthest, spread):.2g} of the box "
                             f"along each axis: look at the unit of their positions, that of the run file")

    def _names(self, beads: int) -> list[str]:
        types = self.asked["beads"]
        names = [name for name, count in types.items() for _ in range(count)]
        if len(names) != beads:
            raise InputError(f"positions: expected {len(names)} beads, found {beads}")
        return names


class Inversion:
    """An inversion of g(r) whose samples are the caller's, by HOOMD on a GPU, a cluster or anything.

        inversion = mesofit.Inversion("run.json", folder="out")
        while not inversion.ended:
            for piece in inversion.pieces:
                piece.tell(my_engine(piece.potentials, piece.asked))
            inversion.go_on()
        inversion.result.potential.plot()

    All pieces of a round may be sampled side by side. What was told is on disk: another process goes on from there
    with ``resume=True``.

    Parameters
    ----------
    target, folder, threads, seed, resume, force, **keys
        As of `fit`. In ``engine={"name": "command", "frames": "frames.extxyz", "steps": 10}`` "steps"
        says how many time steps count as a sweep.
    """

    def __init__(self, target: Any, /, *, folder: PathLike | None = None,
                 threads: int | None = None, seed: int | None = None, resume: bool = False,
                 force: bool = False, **keys: Any) -> None:
        self._place = Folder(folder)
        # What a run file says of its engine is left to it.
        said = target if isinstance(target, Mapping) else keys
        if "engine" not in said:
            keys["engine"] = {"name": "command", "frames": _FRAMES}
        self._target, self._keys = target, keys
        self._words = ["--engine", "later"]
        for word, value in (("--threads", threads), ("--seed", seed)):
            self._words += [] if value is None else [word, str(value)]
        self._run(resume, force)

    def _run(self, resume: bool, force: bool) -> None:
        before = self._listed()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", InterruptedWarning)
                fit_with(self._target, dict(self._keys), list(self._words), self._place, resume, force,
                         False)
        except KeyboardInterrupt:
            if not self._waiting():
                raise
        except InputError:
            if self._listed() != before:  # for pieces whose samples were none
                self._put_aside()
            raise

    def _list(self) -> Path:
        return self._place.path / "engine" / "waiting"

    def _listed(self) -> int:
        return self._list().stat().st_mtime_ns if self._list().exists() else 0

    def _waiting(self) -> list[Path]:
        return [Path(line) for line in self._list().read_text().splitlines()] if self._listed() else []

    def _put_aside(self) -> None:
        for folder in self._waiting():
            frames = folder / _FRAMES
            if frames.exists():
                frames.rename(folder / (_FRAMES + ".broken"))

    @property
    def ended(self) -> bool:
        """Whether no more samples are wanted."""
        return not self._waiting()

    @property
    def pieces(self) -> list[Piece]:
        """What is asked for now: one piece of each replica that has not been told."""
        used = json.loads((self._place.path / "used.json").read_text())
        system = used.get("units", {}).get("system", "lj")
        units = "" if system == "angstrom-fs" else f"Units={system}"  # Å are those of the format
        return [piece for piece in (Piece._at(path, units) for path in self._waiting())
                if not piece.told]

    def go_on(self) -> None:
        """Take what was told, and ask for what is needed next. Raises: as `fit`. Frames that are no
        samples are put aside, as frames.extxyz.broken, and their piece is asked for again."""
        self._run(True, False)

    @property
    def result(self) -> Result:
        """What there is so far, or in the end: as of `fit`."""
        return open_result(self._place.path)
