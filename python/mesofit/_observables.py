# SPDX-License-Identifier: GPL-3.0-or-later
"""Observables of the user's: functions that a simulation asks at each sample."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Callable

import numpy as np

from . import _library as c
from ._errors import InputError
from ._inputs import array_of, encode, read_only


class Observables:
    """Functions by the names of their tables, and the first exception that one of them raised."""

    def __init__(self, functions: Mapping[str, Any]) -> None:
        if not isinstance(functions, Mapping):
            raise InputError(f"observables: expected a dict of names and functions, found "
                             f"{type(functions).__name__}")
        self.fault: BaseException | None = None
        self._named = [(encode(name, "observables: a name"), self._compiled(name, function))
                       for name, function in functions.items()]

    def lend(self) -> Any:
        """Structs, valid as long as this object lives."""
        self.fault = None
        self._lent = (c.NamedObservable * len(self._named))(
            *[c.NamedObservable(name, function, None) for name, function in self._named])
        return self._lent

    def _compiled(self, name: str, function: Any) -> Any:
        if isinstance(function, c.OBSERVABLE):
            return function
        if hasattr(function, "address"):  # of numba
            return c.OBSERVABLE(function.address)
        if callable(function):
            return self._wrap(name, function)
        raise InputError(f"observable {name!r}: expected a function, found "
                         f"{type(function).__name__}")

    def _wrap(self, name: str, function: Callable[..., Any]) -> Any:
        kept: list[Any] = []  # what there was no room for, which is asked for at once

        def call(context: Any, count: int, dimensions: int, positions: Any, velocities: Any,
                 types: Any, box: Any, room: int, values: Any) -> int:
            try:
                if not kept:
                    shape = (count, dimensions)
                    kept.append(_numbers(name, function(
                        _copy(positions, shape),
                        _copy(velocities, shape) if velocities else None,
                        _copy(types, (count,)), _copy(box, (dimensions,)))))
                size = int(kept[0].size)
                if size <= room:
                    np.ctypeslib.as_array(values, (size,))[:] = kept.pop()
                return size
            except BaseException as fault:  # noqa: B902 - raised again where the run was begun
                self.fault = fault
                return -1
        return c.OBSERVABLE(call)


def _copy(values: Any, shape: tuple[int, ...]) -> Any:
    """A function may keep what it is given."""
    return read_only(np.ctypeslib.as_array(values, shape).copy())


def _numbers(name: str, answer: Any) -> Any:
    """What a function answers, as numbers one behind the other."""
    if answer is None:
        raise InputError(f"observable {name!r}: expected a number or an array, found None")
    numbers = array_of(answer, f"observable {name!r}: expected a number or an array").ravel()
    if numbers.size == 0:
        raise InputError(f"observable {name!r}: an empty array has no value")
    return numbers
