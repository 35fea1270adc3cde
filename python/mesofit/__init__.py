# SPDX-License-Identifier: GPL-3.0-or-later
"""mesofit: the pair interactions of a coarse-grained liquid from what was measured of it.

    target = mesofit.measure("traj.xtc", structure="conf.gro", temperature=298)
    fit = mesofit.fit(target)
    fit.potential.plot()
    fit.export("lammps", "lammps")

Everything is done by the program's own code, in the library that comes with it; results have the
same bits as the program's.
"""

from ._errors import (
    Error, FileError, InputError, InterruptedWarning, MesofitWarning, UnconvergedWarning,
    UnstableError,
)
from ._inputs import Frames
from ._inversion import Inversion, Piece
from ._library import FORCE, OBSERVABLE, version as __version__
from ._problem import Curve, Optimiser, Problem, State, Value
from ._result import Result, open
from ._simulation import Means, Rdf, Simulation
from ._table import Curves, Table
from ._work import Scene, fit, import_votca, law, measure, simulate

__all__ = [
    "Curve", "Curves", "Error", "FORCE", "FileError", "Frames", "InputError",
    "InterruptedWarning", "Inversion", "Means", "MesofitWarning", "OBSERVABLE", "Optimiser", "Piece", "Problem", "Rdf",
    "Result", "Scene", "Simulation", "State", "Table", "UnconvergedWarning", "UnstableError", "Value",
    "__version__", "fit", "import_votca", "law", "measure", "open", "simulate",
]
