# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits and optimisers that are driven by the caller."""

from __future__ import annotations

import ctypes
import json
import threading
from typing import Any, NamedTuple

import numpy as np

from . import _library as c
from ._errors import InputError, check
from ._library import Array
from ._inputs import Memory, numbers, pointer
from ._run import Owned
from ._simulation import _count
from ._work import Content, _lend


class Value(NamedTuple):
    """What a candidate is worth.

    Attributes
    ----------
    error : float
        Infinite where its simulation failed.
    variance : float
        Of the error, by noise.
    """

    error: float
    variance: float


class State(NamedTuple):
    """Where a fit is.

    Attributes
    ----------
    iteration, simulations, engine_steps : int
        How many there were.
    error, noise : float
        Rms distance from the target, and what of it is noise.
    finished, converged : bool
    reason : str
        Why it has ended without having converged.
    """

    iteration: int
    simulations: int
    engine_steps: int
    error: float
    noise: float
    finished: bool
    converged: bool
    reason: str


class Curve(NamedTuple):
    """A curve that was found, in reduced units.

    Attributes
    ----------
    r : array, shape (points,) [lambda]
    value, error : array, shape (points,) [k_B T_0], of ω [sqrt(mu/tau)]
        And its standard error; NaN: not known.
    """

    r: Array
    value: Array
    error: Array


class Problem(Owned):
    """A fit whose loop is the caller's: step by step, or by an optimiser of one's own.

    Its memory goes with it, at the end of ``with Problem(…) as problem:``, or by `close`.

    Parameters
    ----------
    run : dict or path
        What a run file says.
    threads : int
    **keys
        Put into it, as of `fit`.

    Raises
    ------
    InputError
        With the line that the program would print.
    """

    _free = "mesofit_fit_free"

    def __init__(self, run: Content, *, threads: int = 1, **keys: Any) -> None:
        memory = Memory()
        if isinstance(keys.get("method"), str):
            keys["method"] = {"name": keys["method"]}
        word = _lend(run, keys, "run", memory)
        inputs = memory.lend()
        stopping = self._stopping = threading.Event()  # the progress must not know of this
        self._broken = False
        self._progress = c.FIT_PROGRESS(
            lambda context, iteration, done, total: int(stopping.is_set()))
        threads = _count(threads, "threads", 1)
        if word in memory.texts:
            self._make(c.lib.mesofit_fit_parse, memory.texts[word].encode(), inputs.tables,
                       inputs.table_count, threads, self._progress, None)
        else:
            self._make(c.lib.mesofit_fit_open, word.encode(), threads, self._progress, None)

    def _call(self, function: Any, *arguments: Any) -> None:
        """One call at a time."""
        with self._lock:
            if self._broken:
                raise InputError("the fit has failed or was interrupted: begin a new one")
            self._stopping.clear()
            self._broken = function is c.lib.mesofit_fit_iterate
            self._work(function, *arguments, stop=self._stopping.set)
            self._broken = False

    # By the method of the run file ----------------------------------------------------------------

    def iterate(self) -> State:
        """One iteration of its method; after `finished` nothing happens any more.

        Returns
        -------
        State

        Raises
        ------
        UnstableError
            A simulation blew up.
        KeyboardInterrupt
            By Ctrl-C; the fit is then over.
        """
        state = c.FitState()
        self._call(c.lib.mesofit_fit_iterate, state)
        return State(state.iteration, state.simulations, state.engine_steps, state.error,
                     state.noise, bool(state.finished), bool(state.converged),
                     (state.reason or b"").decode(errors="replace"))

    def curve(self, name: str = "potential") -> Curve:
        """The best curve so far; of a mixture those of all pairs, one behind the other.

        Parameters
        ----------
        name : "potential" or "omega"

        Returns
        -------
        Curve

        Raises
        ------
        InputError
            It is not looked for, or there was no iteration yet.
        """
        kinds = {"potential": 0, "omega": 1}
        if name not in kinds:
            raise InputError(f"curve: expected potential or omega, found {name!r}")
        with self._lock:
            found = c.lib.mesofit_fit_curve(self._pointer, kinds[name])
            if found.count == 0:
                raise InputError(f"{name}: it is not looked for, or there was no iteration yet")
            unknown = np.full(found.count, np.nan)
            return Curve(*(np.ctypeslib.as_array(array, (found.count,)).copy()
                           if array else unknown
                           for array in (found.r, found.value, found.error)))

    def verify(self) -> dict[str, float]:
        """Simulate the best so far with new seeds.

        Returns
        -------
        dict of str to float
            Distances from the targets and means, with their errors.

        Raises
        ------
        InputError
            There was no iteration yet.
        UnstableError
            A simulation blew up.
        """
        found = c.Verification()
        self._call(c.lib.mesofit_fit_verify, found)
        return {name: getattr(found, name) for name, _ in c.Verification._fields_}

    # By an optimiser of the caller's --------------------------------------------------------------

    def __len__(self) -> int:
        """Coefficients of a candidate; 0 of a method that does not search."""
        return int(c.lib.mesofit_fit_coefficients(self._pointer))

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """(0, 1) for each coefficient, as scipy.optimize wants it."""
        return [(0.0, 1.0)] * len(self)

    def start(self) -> Array:
        """Coefficients that the fit begins with.

        Returns
        -------
        array, shape (coefficients,)
            From 0 to 1.

        Raises
        ------
        InputError
            The method does not search.
        """
        coefficients = np.zeros(len(self))
        with self._lock:
            check(c.lib.mesofit_fit_start(self._pointer, pointer(coefficients)))
        return coefficients

    def evaluate(self, coefficients: Any, seed: int = 1) -> Value:
        """Simulate one candidate.

        Parameters
        ----------
        coefficients : array, shape (coefficients,), from 0 to 1
        seed : int
            The same gives the same noise.

        Returns
        -------
        Value

        Raises
        ------
        InputError
            A coefficient is not from 0 to 1, or the method does not search.
        """
        candidate = numbers(coefficients, "coefficients", (len(self),))
        if not ((candidate >= 0) & (candidate <= 1)).all():
            raise InputError("coefficients: expected numbers from 0 to 1")
        error, variance = np.empty(1), np.empty(1)
        self._call(c.lib.mesofit_fit_evaluate, pointer(candidate), _count(seed, "seed", 0),
                   pointer(error), pointer(variance))
        return Value(float(error[0]), float(variance[0]))

    def __call__(self, coefficients: Any) -> float:
        """The error alone, always with the same noise: what scipy.optimize minimises."""
        return self.evaluate(coefficients).error


class Optimiser(Owned):
    """An optimiser for noisy errors in a box, by ask and tell.

    Parameters
    ----------
    name : "genetic", "cma-es" or "nlopt"
    dimensions : int
    minimum, maximum : float
        Of each number.
    start : array, shape (dimensions,), optional
    seed : int
    **settings
        As in "method" of a run file.

    Raises
    ------
    InputError
        With the line that the program would print.
    """

    _free = "mesofit_optimiser_free"

    def __init__(self, name: str, dimensions: int, *, minimum: float = 0.0, maximum: float = 1.0,
                 start: Any = None, seed: int = 1, **settings: Any) -> None:
        self.dimensions = _count(dimensions, "dimensions", 1)
        begin = None if start is None else numbers(start, "start", (self.dimensions,))
        try:
            text = json.dumps(settings, allow_nan=False).encode()
        except (TypeError, ValueError) as fault:
            raise InputError(f"settings: {fault}") from None
        self._asked: int | None = None
        self._make(c.lib.mesofit_optimiser_create, str(name).encode(), text, self.dimensions,
                   float(minimum), float(maximum), None if begin is None else pointer(begin),
                   _count(seed, "seed", 0))

    def ask(self) -> Array:
        """Candidates to be measured next.

        Returns
        -------
        array, shape (count, dimensions)
            The count is 0 at the end.
        """
        population, count = c.NUMBERS(), ctypes.c_size_t()
        check(c.lib.mesofit_optimiser_ask(self._pointer, population, count))
        self._asked = count.value
        if count.value == 0:
            return np.empty((0, self.dimensions))
        return np.ctypeslib.as_array(population, (count.value, self.dimensions)).copy()

    def tell(self, errors: Any, variances: Any = None) -> None:
        """Errors of what was asked last.

        Parameters
        ----------
        errors : array, shape (count,)
            Infinite where there is none.
        variances : array, shape (count,), optional
            Of the errors, by noise.

        Raises
        ------
        InputError
            There is nothing that was asked for, or an error is NaN.
        """
        if not self._asked:
            raise InputError("tell: there is nothing that was asked for")
        found = numbers(errors, "errors", (self._asked,))
        if np.isnan(found).any():
            raise InputError("errors: what could not be measured is infinite, not NaN")
        noise = None if variances is None else numbers(variances, "variances", (self._asked,))
        check(c.lib.mesofit_optimiser_tell(self._pointer, pointer(found),
                                               None if noise is None else pointer(noise)))
        self._asked = None

    def best(self) -> Array | None:
        """What it believes best.

        Returns
        -------
        array, shape (dimensions,), or None
            None before the first `tell`.
        """
        best = np.empty(self.dimensions)
        return best if c.lib.mesofit_optimiser_best(self._pointer, pointer(best)) else None
