# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `mesofit` of a wheel: the program that lies in it, or that of a clone."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def main() -> None:
    here = Path(__file__).resolve().parent
    places = here / "lib" / "mesofit", here.parent.parent / "build" / "mesofit"
    program = next((place for place in places if place.exists()), None)
    if program is None:
        sys.exit("mesofit: no program beside the package; in a clone, run make")
    os.execv(program, [str(program), *sys.argv[1:]])
