# SPDX-License-Identifier: GPL-3.0-or-later
"""Results: folders that the program or this package has written."""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import threading
from pathlib import Path
from typing import Any

import numpy as np

from . import _library as c
from ._errors import FileError, InputError, check, fail
from ._inputs import Memory, PathLike, absolute, encode
from ._run import Folder, Outcome, carry_out
from ._table import Curves, Table, named


class _Handle:
    """A result of the library, which lives as long as anything that was read from it."""

    def __init__(self, path: Path) -> None:
        self.lock = threading.Lock()
        self.pointer = c.lib.mesofit_result_open(encode(path))
        if not self.pointer:
            raise fail(c.BAD_INPUT if path.is_dir() else c.IO, c.message())

    def __del__(self) -> None:
        if getattr(self, "pointer", None) and c.lib is not None:  # None: Python ends
            c.lib.mesofit_result_free(self.pointer)
            self.pointer = None


class _Numbers:
    """Memory of a result as numpy sees it: the array that is made of this keeps the result."""

    def __init__(self, handle: _Handle, columns: c.Columns) -> None:
        self.handle = handle
        address = ctypes.cast(columns.values, ctypes.c_void_p).value
        self.__array_interface__ = {"version": 3, "shape": (columns.rows, columns.columns),
                                    "typestr": np.dtype(np.float64).str, "data": (address, True)}


class Result:
    """A folder of results of a fit, a simulation or a measurement.

    Made by `measure`, `fit`, `simulate` and `open`; can be pickled. Without a folder of the user's
    its files go with it.

    Attributes
    ----------
    messages : tuple of str
        What the program would have said.

    Notes
    -----
    ``result["rdf"]`` is ``result.table("rdf")``.
    """

    def __init__(self, folder: Folder, outcome: Outcome | None = None) -> None:
        self._folder = folder
        self._handle: _Handle | None = None
        self.messages = tuple(outcome.lines) if outcome else ()

    # What there is --------------------------------------------------------------------------------

    @property
    def folder(self) -> Path:
        """Where its files are, a pathlib.Path."""
        return self._folder.path

    def _open(self) -> _Handle:
        if self._handle is None:
            self._handle = _Handle(self.folder)
        return self._handle

    @property
    def tables(self) -> tuple[str, ...]:
        """Names of all tables, a tuple of str."""
        handle = self._open()
        names: list[str] = []
        while (name := c.lib.mesofit_result_name(handle.pointer, len(names))) is not None:
            names.append(name.decode(errors="replace"))
        return tuple(names)

    def table(self, name: str) -> Table:
        """The table of this name.

        Parameters
        ----------
        name : str
            "rdf", "rdf_A-B" or "rdf_B-A", "potential", …: one of `tables`.

        Returns
        -------
        Table

        Raises
        ------
        InputError
            There is none; the text lists those that there are.
        """
        handle, columns = self._open(), c.Columns()
        name = named(name, self.tables)
        if name not in self.tables:
            raise InputError(f"no table {name!r}; there are {', '.join(self.tables)}")
        with handle.lock:
            check(c.lib.mesofit_result_table(handle.pointer, encode(name), columns))
            names, units = (tuple(texts[k].decode(errors="replace")
                                  for k in range(columns.columns))
                            for texts in (columns.names, columns.units))
            comment = columns.comment.decode(errors="replace")
        units = tuple("" if unit == "1" else unit for unit in units)
        return Table(name, names, units, np.asarray(_Numbers(handle, columns)), comment)

    __getitem__ = table

    def text(self, file: str) -> str:
        """The text of a file of the folder.

        Parameters
        ----------
        file : str
            Its name, as "summary.json".

        Returns
        -------
        str

        Raises
        ------
        FileError
            There is none.
        """
        handle = self._open()
        with handle.lock:
            content = c.lib.mesofit_result_text(handle.pointer, encode(file))
            if content is None:
                raise fail(c.IO, c.message())
            return str(content.decode(errors="replace"))

    def _check_there(self) -> None:
        if not self.folder.is_dir():
            raise FileError(f"{self.folder}: the folder of the result is gone")

    def _json(self, file: str) -> dict[str, Any]:
        self._check_there()
        return dict(json.loads(self.text(file))) if (self.folder / file).exists() else {}

    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json says, a dict: numbers with their errors, units, status."""
        return self._json("summary.json")

    @property
    def used(self) -> dict[str, Any]:
        """All settings that the run had, a dict; they can be run again."""
        return self._json("used.json")

    @property
    def kind(self) -> str:
        """ "fit", "simulation" or "measurement"."""
        used = self.used
        if "trajectories" in used or (self.folder / "target.json").exists():
            return "measurement"
        return "fit" if "method" in used else "simulation"

    @property
    def status(self) -> str:
        """ "ok", "converged", "finished", "unconverged", "interrupted" or "unstable"."""
        return str(self.summary.get("status", "interrupted"))

    @property
    def reason(self) -> str:
        """Why a fit has not converged, else an empty text."""
        return str(self.summary.get("reason", ""))

    @property
    def converged(self) -> bool:
        """Whether `status` is "converged"."""
        return self.status == "converged"

    def _curves(self, name: str) -> Curves:
        parts = Curves._parts(name, self.tables)
        if not parts:
            raise InputError(f"no {name}; there are the tables {', '.join(self.tables)}")
        return Curves(name, {part: self.table(table) for part, table in parts.items()})

    @property
    def potential(self) -> Curves:
        """`Curves` of Φ(r), with standard errors; InputError where none was looked for."""
        return self._curves("potential")

    @property
    def omega(self) -> Curves:
        """`Curves` of ω(r), with standard errors; InputError where none was looked for."""
        return self._curves("omega")

    @property
    def states(self) -> dict[str, "Result"]:
        """Results of each state of a fit of several but the first, a dict by their names."""
        folders = sorted(path for path in (self.folder / "states").glob("*") if path.is_dir())
        return {path.name: _State(self, path) for path in folders}

    # What is done with it -------------------------------------------------------------------------

    def export(self, engine: str, folder: PathLike | None = None, *, bands: bool = False,
               dynamics: bool = False, project: bool = False, force: bool = False,
               threads: int | None = None, progress: bool | None = None) -> Path:
        """Write the result as files that another engine runs.

        Parameters
        ----------
        engine : str
            "lammps", "hoomd", "espresso", "openmm", "gromacs", "dl_poly" or "votca".
        folder : path, optional
            Called as the engine, here, if it is not given.
        bands : bool
            Also the potential minus and plus one standard error.
        dynamics : bool
            Simulate what D and E(t, r_0) are with the friction that runs there.
        project : bool
            The nearest friction that the engine has.
        force : bool
            Replace files that were changed since.
        threads, progress
            As of `simulate`.

        Returns
        -------
        pathlib.Path
            Their folder.

        Raises
        ------
        InputError
            The engine is not known, or cannot have this model.
        FileError
            The folder cannot be written.
        """
        target = absolute(engine if folder is None else folder, "folder")
        words = ["export", _path(self.folder), "--engine", engine, "-o", _path(target)]
        words += [word for word, wanted in (("--bands", bands), ("--dynamics", dynamics),
                                            ("--project", project),
                                            ("--force", force)) if wanted]
        words += [] if threads is None else ["--threads", str(threads)]
        outcome = carry_out(words, Memory(), progress)
        outcome.warn()
        return target

    def save(self, folder: PathLike) -> Path:
        """Copy all files into a new folder, which the program knows as one of its own.

        Parameters
        ----------
        folder : path
            It must not be there yet.

        Returns
        -------
        pathlib.Path
            The folder.

        Raises
        ------
        OSError
            It cannot be written, or is there already.
        """
        return Path(shutil.copytree(self.folder, absolute(folder, "folder")))

    def plot(self) -> Any:
        """Draw what there is with matplotlib: g with its target, Φ, ω, errors by iteration.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        ImportError
            There is no matplotlib.
        InputError
            There is nothing to draw.
        """
        from . import _plot

        return _plot.draw_result(self)

    def __getstate__(self) -> dict[str, Any]:
        self._check_there()
        # Of a run that has ended nobody needs what it would go on from.
        over = self.status != "interrupted"
        files = {str(path.relative_to(self.folder)): path.read_bytes()
                 for path in sorted(self.folder.rglob("*"))
                 if path.is_file() and not (over and path.name == "checkpoint.bin")}
        return {"files": files, "messages": self.messages}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._folder, self._handle, self.messages = Folder(), None, state["messages"]
        for name, content in state["files"].items():
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def __reduce_ex__(self, protocol: Any) -> Any:
        return _empty, (), self.__getstate__()

    def __repr__(self) -> str:
        reason = f": {self.reason}" if self.reason else ""
        return f"<{self.kind} in {self.folder}: {self.status}{reason}>"

    def _repr_html_(self) -> str:
        from . import _plot

        return _plot.show_result(self)


class _State(Result):
    """A state of a fit, whose files are the fit's."""

    def __init__(self, fit: Result, path: Path) -> None:
        super().__init__(Folder(path))
        self._fit = fit  # its folder may go with it


def _empty() -> Result:
    return Result.__new__(Result)


def _path(path: Any) -> str:
    """A path that is taken for no option."""
    text = os.fsdecode(encode(path, "a path"))
    return "./" + text if text.startswith("-") else text


def open(folder: PathLike) -> Result:  # noqa: A001 - as the program says it
    """Open a folder of results, whoever wrote it.

    Parameters
    ----------
    folder : path

    Returns
    -------
    Result

    Raises
    ------
    FileError, InputError
        There is none, or it holds no results.
    """
    result = Result(Folder(folder))
    result._open()
    return result
