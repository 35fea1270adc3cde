# SPDX-License-Identifier: GPL-3.0-or-later
"""What is raised, and what is warned of."""

from __future__ import annotations

import re

from . import _library


#: Options that are words alone.
_FLAGS = ("force", "resume", "static", "allow-truncated", "bands", "dynamics",
          "project")


#: Options that have other names here.
_NAMES = {"s": "structure", "o": "folder"}


#: What the program says to do next, and what does the same here.
_NEXT = ((r"mesofit export .*? --engine lammps", 'export("lammps") of the result'),
         (r"run the pieces whose folders are listed in .*?, and go on with --engine later --resume",
          "tell each of `pieces` its frames, and go_on()"),
         (r"( are no window of \d+ intervals) \(--window\)", r"\1 (give window, or the count of Frames)"))


def said(text: str, frames: bool = False, hidden: str = "") -> str:
    """A line of the program with its options as the functions here, or `Frames`, name them. What
    stands in quotes is a command of the shell; a folder that goes with the result is `hidden`."""
    for pattern, here in _NEXT:
        text = re.sub(pattern, here, text)
    if hidden:
        text = text.replace(hidden, "result.folder")
    names = {**_NAMES, **({"file-time-step": "times"} if frames else {})}

    def name(found: re.Match[str]) -> str:
        option = found[1] or found[2]
        flag = "=True" if option in _FLAGS else ""
        return names.get(option, option.replace("-", "_")) + flag
    parts = text.split('"')
    parts[::2] = [re.sub(r"(?<![\w-])(?:--([a-z]+(?:-[a-z]+)*)|-([so])(?![\w-]))", name, part)
                  for part in parts[::2]]
    return '"'.join(parts)


class Error(Exception):
    """Anything that the program would end with; the text is the line that it would print, with
    options as the functions here name them."""


class InputError(Error, ValueError):
    """An argument, a text or what a file says is wrong; also a ValueError."""


class FileError(Error, OSError):
    """A file or folder cannot be read or written; also an OSError."""


class UnstableError(Error, ArithmeticError):
    """A simulation blew up: the text says when, and what helps; also an ArithmeticError."""


class MesofitWarning(UserWarning):
    """What the program would warn of."""


class UnconvergedWarning(MesofitWarning):
    """A fit has ended before its criterion was met. The text says why, and what helps."""


class InterruptedWarning(MesofitWarning):
    """Work was interrupted; the result is what there was until then."""


def fail(status: int, text: str) -> BaseException:
    """The exception of a status of the library, other than OK."""
    text = said(text)
    if status == _library.NO_MEMORY:
        return MemoryError(text)
    if status == _library.INTERRUPTED:
        return KeyboardInterrupt(text)
    kinds = {_library.BAD_INPUT: InputError, _library.IO: FileError,
             _library.UNSTABLE: UnstableError}
    return kinds.get(status, Error)(text)


def check(status: int) -> None:
    """Raise what the last call of this thread failed by."""
    if status != _library.OK:
        raise fail(status, _library.message())
