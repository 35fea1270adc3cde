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
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from . import _library as c
from ._errors import InputError, InterruptedWarning, MesofitWarning, UnconvergedWarning, fail, said
from ._inputs import Memory, absolute, encode
from ._progress import Progress

log = logging.getLogger("mesofit")

_WARNING = "mesofit: warning: "
_LOOK = 0.1  # seconds between looks at how far it is
# What threads have in common in Python: the size of stacks of those that begin, the lock of `tempfile`.
# A child of a fork has locks, but not the thread that would open them.
_common = threading.RLock()
os.register_at_fork(before=_common.acquire, after_in_parent=_common.release,
                    after_in_child=_common.release)


class Folder:
    """A folder of results: the user's, or a temporary one that goes with the last who knows it."""

    def __init__(self, path: Any = None) -> None:
        self.temporary = path is None
        if path is None:
            with _common:
                path = tempfile.mkdtemp(prefix="mesofit-")
            weakref.finalize(self, _remove, path, os.getpid())
        self.path = absolute(path, "folder")


def _remove(path: str, process: int) -> None:
    if os.getpid() == process:  # and not in a child of it
        shutil.rmtree(path, ignore_errors=True)


class Outcome:
    """How a run has ended, and what was said."""

    def __init__(self) -> None:
        self.status, self.message = c.OK, ""
        self.lines: list[str] = []  # with names of Python

    def warn(self) -> None:
        """Turn what was said, and how it has ended, into Python's warnings."""
        level = _level()
        for line in self.lines:
            if line.startswith(_WARNING):
                warnings.warn(line[len(_WARNING):], MesofitWarning, stacklevel=level)
        if self.status == c.UNCONVERGED:
            warnings.warn(self.message, UnconvergedWarning, stacklevel=level)
        elif self.status == c.INTERRUPTED:
            warnings.warn(self.message, InterruptedWarning, stacklevel=level)


def _level() -> int:
    """Of the first caller outside of this package."""
    here, level, frame = str(Path(__file__).parent), 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(here):
        frame, level = frame.f_back, level + 1
    return level


_STACK = 8 << 20  # of a thread that works for the library, whatever threads of the user's have [bytes]


class Work:
    """A call of the library in a thread of its own: with a stack that suffices, while this one sees
    Ctrl-C. It keeps what is called, and all that is lent to it, as long as it works."""

    def __init__(self, function: Callable[..., Any], *arguments: Any) -> None:
        self.function, self.arguments = function, arguments
        self.answer: Any = None
        self.message = ""
        # Not Thread.join: a thread whose join was interrupted counts as ended (CPython 3.11).
        self.begun, self.ended = threading.Event(), threading.Event()

    def _do(self) -> None:
        self.begun.set()
        try:
            self.answer = self.function(*self.arguments)
            self.message = c.message()
        finally:
            self.ended.set()

    def _begin(self) -> None:
        thread = threading.Thread(target=self._do, name="mesofit", daemon=True)
        with _common:
            before = threading.stack_size(_STACK)
            try:
                thread.start()
            finally:
                threading.stack_size(before)

    def wait(self, stop: Callable[[], Any], look: Callable[[], Any] = lambda: None) -> int:
        """Do it, asking it to stop from the first Ctrl-C on. Returns how many there were."""
        interrupts = 0
        try:
            self._begin()
        except KeyboardInterrupt:
            if not self.begun.wait(1):
                raise
            interrupts = 1
        while not self.ended.is_set():
            try:
                if interrupts > 0:
                    stop()  # again and again: the first may have come before it was called
                self.ended.wait(_LOOK)
                look()
            except KeyboardInterrupt:
                interrupts += 1
        return interrupts


class Owned:
    """An object of the library, which `close`, the end of `with`, or the last who knows it frees."""

    _handle: Any = None
    _free = ""  # the function that frees it

    def _make(self, function: Any, *arguments: Any) -> None:
        self._lock = threading.Lock()  # held while the library works with it
        work = Work(function, *arguments)
        interrupts = work.wait(lambda: None)
        self._handle = work.answer
        if interrupts > 0:
            raise KeyboardInterrupt
        if not self._handle:
            raise fail(c.BAD_INPUT, work.message)

    def _work(self, function: Any, *arguments: Any, stop: Callable[[], Any]) -> None:
        """Call the library, with the lock held."""
        work = Work(function, self._pointer, *arguments)
        if work.wait(stop) > 0:
            raise KeyboardInterrupt(work.message)
        if work.answer != c.OK:
            raise fail(work.answer, work.message)

    @property
    def _pointer(self) -> Any:
        if not self._handle:
            raise InputError(f"the {type(self).__name__} is closed")
        return self._handle

    def close(self) -> None:
        """Free its memory now; nothing can be asked of it any more. The end of ``with`` does this."""
        if not self._handle:
            return
        if not self._lock.acquire(blocking=False):
            raise InputError(f"the {type(self).__name__} is running")
        handle, self._handle = self._handle, None
        getattr(c.lib, self._free)(handle)
        self._lock.release()

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        if c.lib is not None:  # None: Python ends
            self.close()

    def __reduce__(self) -> Any:
        raise TypeError(f"a {type(self).__name__} cannot be pickled")


class _Run:
    def __init__(self, words: Sequence[str], memory: Memory, hidden: str) -> None:
        self.outcome, self.hidden = Outcome(), hidden
        self.memory, self.inputs = memory, memory.lend()
        self.words = (ctypes.c_char_p * len(words))(*[encode(word, "a word") for word in words])
        self.run = c.lib.mesofit_run_create()
        if not self.run:
            raise MemoryError("out of memory")

    def work(self) -> int:
        return int(c.lib.mesofit_run_words(self.run, len(self.words), self.words, self.inputs))

    def said(self, text: str) -> str:
        return said(text, self.memory.frames is not None, self.hidden)

    def look(self, progress: Progress) -> None:
        lines = self.outcome.lines
        while (line := c.lib.mesofit_run_line(self.run, len(lines))) is not None:
            lines.append(self.said(line.decode(errors="replace")))
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
              progress: bool | None = None, hidden: str = "") -> Outcome:
    """Do what the program does with these words. Raises what the program would fail by, but for
    UNCONVERGED and INTERRUPTED, which leave results. `hidden`: as of `said`."""
    memory = Memory() if memory is None else memory
    shown = Progress(progress)
    run = _Run(words, memory, hidden)
    work = Work(run.work)

    def look() -> None:
        try:
            run.look(shown)
        except Exception:  # of a stream that nobody reads any more
            log.debug("progress cannot be shown", exc_info=True)
            shown.wanted = False
    interrupts = work.wait(run.stop, look)
    look()
    shown.end()
    outcome = run.outcome
    outcome.status = work.answer
    outcome.message = run.said(work.message) if work.answer != c.OK else ""
    for functions in (memory.frames, memory.observables):
        if functions is not None and functions.fault is not None:
            raise functions.fault
    if interrupts > 1:
        raise KeyboardInterrupt(outcome.message)
    if outcome.status not in (c.OK, c.UNCONVERGED, c.INTERRUPTED):
        raise fail(outcome.status, outcome.message)
    return outcome
