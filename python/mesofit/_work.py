# SPDX-License-Identifier: GPL-3.0-or-later
"""measure, fit, simulate: the program's own, from files or from memory."""

from __future__ import annotations

import filecmp
import inspect
import json
import os
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Callable, Union

import numpy as np

from . import _library as c
from ._errors import InputError
from ._library import Array
from ._inputs import Frames, Memory, PathLike, absolute, array_of, from_universe, merge, numbers
from ._observables import Observables
from ._result import Result, _path
from ._run import Folder, carry_out

Content = Union[Mapping[str, Any], PathLike]


def law(function: Callable[[Any], Any], cutoff: float, *, begin: float = 0.0,
        points: int = 2000) -> dict[str, Any]:
    """A pair law of one's own, Φ(r) or ω(r), for "conservative", "dissipative" or "start".

    It is sampled once and becomes a law "table", so that a Python function is as fast as any other.

    Parameters
    ----------
    function : callable
        Its value at an array of distances, or at one.
    cutoff : float
        Beyond it the law is 0.
    begin : float
        First distance that is sampled, above 0 where the law has no finite value there.
    points : int
        How many distances are sampled, evenly.

    Returns
    -------
    dict
        A law that a scene or a run file takes.

    Raises
    ------
    InputError
        The distances are in no order, or a value is not finite.
    """
    if not cutoff > begin >= 0 or points < 2:
        raise InputError(f"law: expected 0 <= begin < cutoff and 2 points; found {begin}, {cutoff}, "
                         f"{points}")
    r = np.linspace(begin, cutoff, int(points))
    try:
        values = np.asarray(function(r), dtype=np.float64)
    except Exception:  # a function of numbers
        values = np.array([])
    if values.shape != r.shape:
        values = np.array([float(function(float(at))) for at in r])
    if not np.isfinite(values).all():
        at = r[~np.isfinite(values)][0]
        raise InputError(f"law: its value at r = {at:g} is not finite; let it begin further out")
    return {"law": "table", "file": np.column_stack([r, values])}


class Scene(dict):  # type: ignore[type-arg]
    """What a scene file says, as a dict: ``Scene(box=[10, 10, 10], particles=3000, …)``.

    Keys are those of a scene file (`mesofit describe scene`); a number of particles stands for
    ``{"count": number}``, an array of rows for a table where a file is named. Nothing is checked
    before it is used.

    Parameters
    ----------
    base : dict or path, optional
        A scene, or its file, that the keys are put into.
    **keys
        What stands at its top; in a dict of a dict single keys are replaced.

    Raises
    ------
    InputError
        `base` is a file that cannot be read, or no object.
    """

    def __init__(self, base: Content | None = None, /, **keys: Any) -> None:
        super().__init__(merge(_read(base) if base is not None else {}, keys))
        particles = self.get("particles")
        if isinstance(particles, (int, np.integer)) and not isinstance(particles, bool):
            self["particles"] = {"count": int(particles)}

    def __repr__(self) -> str:
        return f"Scene({', '.join(f'{key}={value!r}' for key, value in self.items())})"


def _read(content: Content) -> dict[str, Any]:
    """A dict, or that of a JSON file."""
    if isinstance(content, Mapping):
        return dict(content)
    path = os.fspath(content)
    try:
        read = json.loads(Path(path).read_text(encoding="utf-8-sig"))
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror}") from None
    except ValueError as fault:
        raise InputError(f"{path}: {fault}") from None
    if not isinstance(read, dict):
        raise InputError(f"{path}: expected an object")
    return read


def _lend(content: Content, keys: Mapping[str, Any], name: str, memory: Memory) -> str:
    """The word for a file, which is lent with the keys in it if there are some."""
    if "explain" in keys:
        raise InputError("explain: --explain of the program prints what a run would do; the library "
                         "prints nothing")
    if isinstance(content, Mapping):
        return memory.add_json(name, merge(content, keys))
    path = _path(content)
    # A text under the file's own name: what it names beside it is found there.
    return memory.add_json(path, merge(_read(content), keys)) if keys else path


def _options(**options: Any) -> list[str]:
    """Words of options: None and False say nothing, True is a word alone."""
    words: list[str] = []
    for name, value in options.items():
        word = {"structure": "-s"}.get(name, "--" + name.replace("_", "-"))
        if value is None or value is False:
            continue
        words.append(word)
        if isinstance(value, (float, np.floating)):
            words.append(repr(float(value)))
        elif value is not True:
            words.append(_path(value) if isinstance(value, os.PathLike) else str(value))
    return words


def _carry_out(words: list[str], memory: Memory, folder: PathLike | Folder | None, resume: bool,
               force: bool, progress: bool | None) -> Result:
    """Results of words, in a folder of the user's or in a temporary one."""
    place = folder if isinstance(folder, Folder) else Folder(folder)
    words += ["-o", _path(place.path)]
    words += [word for word, wanted in (("--resume", resume), ("--force", force)) if wanted]
    outcome = carry_out(words, memory, progress, str(place.path) if place.temporary else "")
    if place.temporary:  # it goes with the result
        outcome.message = outcome.message.replace("continue with resume=True",
                                                  "in a folder=… it could be continued")
    result = Result(place, outcome)
    if outcome.status == c.INTERRUPTED and not (place.path / "summary.json").exists():
        raise KeyboardInterrupt(outcome.message)
    outcome.warn()
    return result


def simulate(scene: Content, steps: int | None = None, *,
             observables: Mapping[str, Any] | None = None, folder: PathLike | None = None,
             threads: int | None = None, seed: int | None = None, resume: bool = False,
             force: bool = False, progress: bool | None = None, **keys: Any) -> Result:
    """Run a scene and measure it, as `mesofit simulate` does.

    Parameters
    ----------
    scene : Scene, dict or path
        What a scene file says, or its path.
    steps : int, optional
        Steps that are measured, in place of "samples" of "measure".
    observables : dict of functions by the names of their tables, optional
        ``function(positions, velocities, types, box)``, called at each sample: arrays of shape
        (particles, dimensions), positions in the box; (particles,), types being 0, 1, … in the
        order of the scene; (dimensions,), the edges. All in the units of the scene; velocities are
        None for Monte Carlo. It returns a number or an array, always of the same size. The table of
        its name has the mean of each "value" over the samples, NaN if one was not finite, and its
        standard "error", which sees that samples are correlated. An array becomes rows, in C's
        order. What it raises ends the run and is raised here, without results. At most 16; a
        function of the type `OBSERVABLE`, or of numba, is called directly.
    folder : path, optional
        Of the results; else they go with what is returned.
    threads, seed, resume, force
        As the program's options.
    progress : bool, optional
        Show how far it is; None: where a person looks.
    **keys
        Put into the scene at its top, as ``rdf={"range": 2}``.

    Returns
    -------
    Result
        Its tables are in the units of the scene.

    Raises
    ------
    InputError
        With the line that the program would print.
    FileError
        A file cannot be read, or the folder not be written.
    UnstableError
        It blew up.
    KeyboardInterrupt
        By Ctrl-C before there was anything to return.
    """
    memory = Memory()
    content: Content = scene
    if isinstance(scene, Mapping):
        content = Scene(scene)
    if steps is not None:
        measure = merge(_read(content), keys).get("measure", {})
        if isinstance(measure, Mapping):  # or else it is refused as it is
            keys = merge(keys, {"measure": {"samples": _samples(measure, steps)}})
    words = ["simulate", _lend(content, keys, "scene", memory)]
    words += _options(threads=threads, seed=seed)
    if observables is not None:
        memory.observables = Observables(observables)
    return _carry_out(words, memory, folder, resume, force, progress)


def _samples(measure: Mapping[str, Any], steps: int) -> int:
    """How many samples so many steps are; a wrong interval is left to the program."""
    every = measure.get("every", 25)
    if isinstance(every, bool) or not isinstance(every, (int, np.integer)) or every < 1:
        return 1
    if isinstance(steps, bool) or not isinstance(steps, (int, np.integer)) or steps < every:
        raise InputError(f"steps: expected {every} or more, since a sample is taken every {every} "
                         f"of them")
    return int(steps) // int(every)


def fit(target: Any, /, *, density: float | None = None, temperature: float | None = None,
        engine: str | None = None, folder: PathLike | None = None, threads: int | None = None,
        seed: int | None = None, resume: bool = False, force: bool = False,
        progress: bool | None = None, **keys: Any) -> Result:
    """Find the potential, and the friction, that reproduce a target, as `mesofit fit` does.

    Parameters
    ----------
    target : Result, dict or path
        What `measure` has returned, what a run file says, its path, or the folder of a target.
    density, temperature : float, optional
        Of a target that does not say them, in its units: 1/nm³ and K of one that `measure` made.
    engine : str, optional
        Command of the engine that samples (docs/any-engine.md), as "lmp"; the run file says what it is.
    folder, threads, seed, resume, force, progress
        As of `simulate`.
    **keys
        Put into the run file, as ``method={"name": "ibi"}`` or ``method="ibi"``, and
        ``target={"rdf": {"cutoff": 1}}``.

    Returns
    -------
    Result
        Also of a fit that has not converged, with an UnconvergedWarning.

    Raises
    ------
    InputError
        With the line that the program would print.
    FileError, UnstableError, KeyboardInterrupt
        As of `simulate`.
    """
    if engine == "later":
        raise InputError("engine: who makes the samples later is an Inversion")
    return fit_with(target, keys, _options(engine=engine, threads=threads, seed=seed), folder, resume,
                    force, progress, density=density, temperature=temperature)


def fit_with(target: Any, keys: dict[str, Any], words: list[str],
             folder: PathLike | Folder | None, resume: bool, force: bool, progress: bool | None, *, density: float | None = None,
             temperature: float | None = None) -> Result:
    """`fit` with keys of the run file and words of the command line."""
    memory = Memory()
    if isinstance(keys.get("method"), str):
        keys["method"] = {"name": keys["method"]}
    if isinstance(target, Result):
        return _fit_result(target, keys, words, folder, resume, force, progress, density=density,
                           temperature=temperature)
    if not isinstance(target, (Mapping, str, os.PathLike)):
        raise InputError(f"target: expected a result of measure, a dict or a path, found "
                         f"{type(target).__name__}")
    if not isinstance(target, Mapping) and os.path.isdir(target) and not keys:
        own = _options(target=Path(target), density=density, temperature=temperature)
    else:
        if not isinstance(target, Mapping) and os.path.isdir(target):
            target = Path(target) / "target.json"
        own = [_lend(target, _filled(keys, density, temperature), "run", memory)]
    return _carry_out(["fit", *own, *words], memory, folder, resume, force, progress)


def _fit_result(target: Result, keys: dict[str, Any], words: list[str],
                folder: PathLike | Folder | None, resume: bool, force: bool,
                progress: bool | None, **scene: float | None) -> Result:
    """`fit_with` of a Result; a copy of a temporary one is gone again if the fit is refused."""
    kept, new = _keep(target, folder, resume, force)
    try:
        return fit_with(kept, keys, words, folder, resume, force, progress, **scene)
    except InputError as fault:
        if not new:
            raise
        shutil.rmtree(kept)
        if not any(kept.parent.iterdir()):
            kept.parent.rmdir()
        fault.args = (str(fault).replace(str(kept), str(target.folder)), *fault.args[1:])
        raise


def _keep(target: Result, folder: PathLike | Folder | None, resume: bool, force: bool) -> tuple[Path, bool]:
    """The folder of a target, and whether it is a new copy. A temporary one goes with its Result: beside results of the user's,
    which name it and may be continued in another session, a copy stays, "target" in their folder."""
    here = folder.path if isinstance(folder, Folder) and not folder.temporary else folder
    if not target._folder.temporary or here is None or isinstance(here, Folder):
        return target.folder, False
    kept = Path(absolute(here, "folder")) / "target"
    if kept.exists():
        names = {path.name for place in (kept, target.folder) for path in place.glob("*.tsv")}
        names = names - {"timing.tsv"} | {"target.json"}
        same = set(filecmp.cmpfiles(kept, target.folder, names, shallow=False)[0]) == names
        if same or resume or not force:  # without force the run itself refuses what is there
            return (kept if same else target.folder), False
        shutil.rmtree(kept)
    elif kept.parent.exists() and any(kept.parent.iterdir()) and not force:
        return target.folder, False
    return target.save(kept), True


def _filled(keys: Mapping[str, Any], density: float | None,
            temperature: float | None) -> Mapping[str, Any]:
    scene = {key: value for key, value in (("density", density), ("temperature", temperature))
             if value is not None}
    return merge(keys, {"scene": scene}) if scene else keys


def measure(trajectory: Any, structure: PathLike | None = None, *,
            map: Content | Sequence[PathLike] | None = None,
            molecules: Content | None = None,
            begin: float | None = None, end: float | None = None, every: float | None = None,
            range: float | None = None, bins: int | None = None, q_range: float | None = None,
            waves: int | None = None, density_profile: str | None = None,
            profile_bins: int | None = None,
            weighted_density: tuple[float, ...] | None = None, forces: float | None = None,
            window: float | None = None,
            escape: float | None = None, velocities: str | None = None, static: bool = False,
            temperature: float | None = None, units: str | None = None,
            allow_truncated: bool = False, file_units: str | None = None,
            file_time_step: float | None = None, file_group: str | None = None,
            box: float | Sequence[float] | None = None, beads: PathLike | None = None,
            folder: PathLike | None = None, threads: int | None = None, force: bool = False,
            progress: bool | None = None) -> Result:
    """Make a target of a simulation of atoms, as `mesofit measure` does.

    Parameters
    ----------
    trajectory : path, list of paths, Frames, or a Universe or AtomGroup of MDAnalysis
        Files follow each other in time.
    structure : path, optional
        Names, residues and masses of the atoms of files.
    map : dict, path, or list of paths, optional
        Atoms to beads, as of the program or, of VOTCA, one or several in XML; else a residue is a
        bead.
    molecules : dict or path, optional
        Bonds of beads, as of a scene.
    begin, end, every : float, optional [ps]
        First time that is used, else the begin of equilibrium; last one; time between frames.
    range : float, optional [nm]
        Of g(r); else most of half the box.
    bins : int, optional
        Of g(r); else they are 0.01 nm wide.
    q_range : float, optional [1/nm]
        Of S(q), else 4 π density^(1/3); 0: no S(q).
    waves : int, optional
        Most wave vectors in a bin of S(q), else 10.
    density_profile : "x", "y" or "z", optional
        Axis of the box along which the density of each type is measured.
    profile_bins : int, optional
        Of it; else 100.
    weighted_density : two or three floats, optional [nm, nm, 1]
        r_0 and r_c of the distribution of densities around each bead, by a weight from 1 to 0, and
        where its bins end, the same for all states that are fitted together.
    forces : float, optional [nm]
        Keep what "force-matching" needs, of pairs up to there, from the forces of a trajectory.
    window : float, optional [ps]
        Of MSD, VACF and escape times; else a tenth of the time, 100 frames at most.
    escape : float, optional [nm]
        Distance at which a pair has escaped; else 1.6 density^(-1/3).
    velocities : "file", "differences" or "none", optional
        Where those of the VACF come from.
    static : bool
        No motion: frames of any times.
    temperature : float, optional [K]
        Of the target; else that of the velocities.
    units : "nm-ps" or "angstrom-fs", optional
        Of the results.
    allow_truncated, file_units, file_time_step, file_group
        As the program's options.
    box : float or three of them, optional [nm]
        Edges of a box, for files that have none.
    beads : path, optional
        File for the beads' trajectory: .gro, .xtc, .gsd, .xyz or .lammpstrj.
    folder, threads, force, progress
        As of `simulate`.

    Returns
    -------
    Result
        A target for `fit`.

    Raises
    ------
    InputError
        With the line that the program would print.
    FileError
        A file cannot be read, or the folder not be written.
    Exception
        Whatever a function of `Frames` or MDAnalysis has raised.
    """
    memory = Memory()
    files, back = _frames(trajectory, memory)
    words = ["measure", *files]
    words += _options(
        structure=None if structure is None else absolute(structure, "structure"),
        map=None if map is None else Path(_maps(map, memory)),
        molecules=None if molecules is None else Path(_lend(molecules, {}, "molecules", memory)),
        begin=begin, end=end, every=every, range=range, bins=bins, q_range=q_range, waves=waves,
        density_profile=density_profile, profile_bins=profile_bins,
        weighted_density=_list(weighted_density, "weighted_density"), forces=forces,
        window=window, escape=escape, velocities=velocities, static=static, temperature=temperature,
        units=units, allow_truncated=allow_truncated, file_units=file_units,
        file_time_step=file_time_step, file_group=file_group,
        box=_list(box, "box"),
        beads=None if beads is None else absolute(beads, "beads"), threads=threads)
    try:
        return _carry_out(words, memory, folder, False, force, progress)
    finally:
        back()


def _list(values: Any, what: str) -> str | None:
    """Numbers, or one of them, as an option takes them."""
    return None if values is None else ",".join(
        repr(float(x)) for x in numbers(np.atleast_1d(array_of(values, what)), what, (None,)))


def _maps(map: Content | Sequence[PathLike], memory: Memory) -> str:
    """The word for a map, or for several of VOTCA."""
    if isinstance(map, (list, tuple)):
        return ";".join(_path(file) for file in map)
    return _lend(map, {}, "map", memory)  # type: ignore[arg-type]


#: Options of `measure` for a test that compares them with the program's.
MEASURE_OPTIONS = tuple(name for name in inspect.signature(measure).parameters
                        if name not in ("trajectory", "folder", "threads", "force", "progress"))


def import_votca(settings: PathLike, folder: PathLike = "imported", *,
                 box: float | Sequence[float] | None = None,
                 count: Mapping[str, int] | None = None, force: bool = False,
                 progress: bool | None = None) -> Path:
    """Make a run file of VOTCA's settings, as `mesofit import votca` does.

    Parameters
    ----------
    settings : path
        Of `csg_inverse`, in XML.
    folder : path
        For the run file and copies of its tables.
    box : float or three of them, optional [nm]
        Edges of the box, where no conf.gro beside the settings has it.
    count : dict, optional
        Beads of each type, where no file beside them has them.
    force : bool
        Replace files that were changed since.
    progress
        As of `simulate`; what was read and left out is among its lines.

    Returns
    -------
    pathlib.Path
        The run file, for `fit`.

    Raises
    ------
    InputError
        With the line that the program would print.
    FileError
        A file cannot be read, or the folder not be written.
    """
    if isinstance(box, str) or isinstance(count, str):
        raise InputError("import_votca: box is a number or three, count a dict: "
                         "box=4.031, count={'CG': 2180}")
    place = absolute(folder, "folder")
    words = ["import", "votca", _path(settings), "-o", str(place)]
    words += _options(
        box=None if box is None else ",".join(repr(float(x)) for x in np.atleast_1d(box)),
        count=None if count is None else ",".join(f"{type}={n}" for type, n in count.items()),
        force=force)
    carry_out(words, Memory(), progress)
    return place / "run.json"


def _frames(trajectory: Any, memory: Memory) -> tuple[list[str], Callable[[], Any]]:
    """Words for the trajectory, and what puts it back where it was."""
    if isinstance(trajectory, (str, os.PathLike)):
        return [_path(trajectory)], lambda: None
    if isinstance(trajectory, Frames):
        memory.frames = trajectory
        return [Frames.name], lambda: None
    if hasattr(trajectory, "atoms") and hasattr(getattr(trajectory, "universe", trajectory),
                                                "trajectory"):
        memory.frames = from_universe(trajectory)
        played = getattr(trajectory, "universe", trajectory).trajectory
        at = getattr(played, "frame", 0)
        return [Frames.name], lambda: played[at]
    if isinstance(trajectory, (list, tuple)) and trajectory and all(
            isinstance(file, (str, os.PathLike)) for file in trajectory):
        return [_path(file) for file in trajectory], lambda: None
    raise InputError(f"trajectory: expected paths, Frames, or a Universe or AtomGroup; found "
                     f"{type(trajectory).__name__}")
