# SPDX-License-Identifier: GPL-3.0-or-later
"""Carry out a run of the library: in a thread of its own, so that Ctrl-C and progress are seen."""

from __future__ import annotations

import ctypes
import logging
import os
import shutil
import sys
import tempfile
import threading
import warnings
import weakref
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import _library as c
from ._errors import InterruptedWarning, MesofitWarning, UnconvergedWarning, fail, said
from ._inputs import Memory, encode
from ._progress import Progress

log = logging.getLogger("mesofit")

_WARNING = "mesofit: warning: "
_LOOK = 0.1  # seconds between looks at how far it is


class Folder:
    """A folder of results: the user's, or a temporary one that goes with the last who knows it."""

    def __init__(self, path: Any = None) -> None:
        self.temporary = path is None
        if path is None:
            path = tempfile.mkdtemp(prefix="mesofit-")
            weakref.finalize(self, _remove, path, os.getpid())
        self.path = Path(os.fsdecode(encode(path, "folder")))


def _remove(path: str, process: int) -> None:
    if os.getpid() == process:  # and not in a child of it
        shutil.rmtree(path, ignore_errors=True)


class Outcome:
    """How a run has ended, and what was said."""

    def __init__(self) -> None:
        self.status, self.message = c.OK, ""
        self.lines: list[str] = []

    def warn(self) -> None:
        """Turn what was said, and how it has ended, into Python's warnings."""
        level = _level()
        for line in self.lines:
            if line.startswith(_WARNING):
                warnings.warn(line[len(_WARNING):], MesofitWarning, stacklevel=level)
        if self.status == c.UNCONVERGED:
            warnings.warn(said(self.message), UnconvergedWarning, stacklevel=level)
        elif self.status == c.INTERRUPTED:
            warnings.warn(said(self.message), InterruptedWarning, stacklevel=level)


def _level() -> int:
    """Of the first caller outside of this package."""
    here, level, frame = str(Path(__file__).parent), 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(here):
        frame, level = frame.f_back, level + 1
    return level


class _Run:
    def __init__(self, words: Sequence[str], memory: Memory) -> None:
        self.outcome = Outcome()
        # Not Thread.join: a thread whose join was interrupted counts as ended (CPython 3.11).
        self.ended = threading.Event()
        self.memory, self.inputs = memory, memory.lend()
        self.words = (ctypes.c_char_p * len(words))(*[encode(word, "a word") for word in words])
        self.run = c.lib.mesofit_run_create()
        if not self.run:
            raise MemoryError("out of memory")

    def work(self) -> None:
        outcome = self.outcome
        try:
            outcome.status = c.lib.mesofit_run_words(self.run, len(self.words), self.words,
                                                         self.inputs)
            outcome.message = c.message() if outcome.status != c.OK else ""
        finally:
            self.ended.set()

    def look(self, progress: Progress) -> None:
        lines = self.outcome.lines
        while (line := c.lib.mesofit_run_line(self.run, len(lines))) is not None:
            lines.append(line.decode(errors="replace"))
            log.info("%s", lines[-1])
            progress.say(lines[-1])
        if progress.wanted:
            now = c.RunProgress()
            c.lib.mesofit_run_progress(self.run, now)
            progress.tell(now.done, now.total, now.rate, now.unit.decode(errors="replace"),
                          now.text.decode(errors="replace"), not now.open)

    def stop(self) -> None:
        c.lib.mesofit_run_stop(self.run)

    def __del__(self) -> None:
        if getattr(self, "run", None) and c.lib is not None:  # None: Python ends
            c.lib.mesofit_run_free(self.run)
            self.run = None


def carry_out(words: Sequence[str], memory: Memory | None = None,
              progress: bool | None = None) -> Outcome:
    """Do what the program does with these words. Raises what the program would fail by, but for
    UNCONVERGED and INTERRUPTED, which leave results."""
    memory = Memory() if memory is None else memory
    shown = Progress(progress)
    run = _Run(words, memory)
    interrupts = 0
    # It keeps the run, and all that is lent to it, as long as it works.
    threading.Thread(target=run.work, name="mesofit", daemon=True).start()
    while not run.ended.is_set():
        try:
            run.ended.wait(_LOOK)
            run.look(shown)
        except KeyboardInterrupt:
            interrupts += 1
            run.stop()
        except Exception:  # of a stream that nobody reads any more
            log.debug("progress cannot be shown", exc_info=True)
            shown.wanted = False
    run.look(shown)
    shown.end()
    outcome = run.outcome
    for functions in (memory.frames, memory.observables):
        if functions is not None and functions.fault is not None:
            raise functions.fault
    if interrupts > 1:
        raise KeyboardInterrupt(outcome.message)
    if outcome.status not in (c.OK, c.UNCONVERGED, c.INTERRUPTED):
        raise fail(outcome.status, outcome.message)
    return outcome
