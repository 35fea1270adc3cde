# SPDX-License-Identifier: GPL-3.0-or-later
"""A line that tells how far a run is, in a terminal or a notebook."""

from __future__ import annotations

import sys
from typing import Any


def _in_notebook() -> bool:
    # A notebook has it; a child that is forked while it is imported here would wait for it for ever.
    shell = getattr(sys.modules.get("IPython"), "get_ipython", None)
    return shell is not None and type(shell()).__name__ == "ZMQInteractiveShell"


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.1f} min"


class Progress:
    """Shows lines and one that changes. `None`: where a person looks."""

    def __init__(self, wanted: bool | None) -> None:
        self.notebook = _in_notebook()
        looks = self.notebook or (sys.stderr is not None and sys.stderr.isatty())
        self.wanted = looks if wanted is None else bool(wanted)
        self.open_line = False
        self.handle: Any = None

    def _show(self, line: str) -> None:
        if self.notebook:
            from IPython.display import display
            text = {"text/plain": line}
            if self.handle is None:
                self.handle = display(text, raw=True, display_id=True)
            else:
                self.handle.update(text, raw=True)
        else:
            sys.stderr.write("\r\033[K" + line)
            sys.stderr.flush()
        self.open_line = True

    def tell(self, done: int, total: int, rate: float, unit: str, text: str, known: bool) -> None:
        if not self.wanted or total == 0:
            return
        share = min(1.0, done / total)
        bar = "█" * round(20 * share) + "░" * (20 - round(20 * share))
        line = f"{bar} {100 * share:3.0f} %  {text}"
        if rate > 0:
            line += f"  {rate:.3g} {unit}/s"
            if known:
                line += f"  {_duration((total - done) / rate)} left"
        self._show(line)

    def say(self, line: str) -> None:
        if not self.wanted:
            return
        if self.open_line and not self.notebook:
            sys.stderr.write("\r\033[K")
        print(line, file=sys.stderr, flush=True)
        self.open_line = False

    def end(self) -> None:
        if self.open_line and not self.notebook:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()
        self.open_line = False
