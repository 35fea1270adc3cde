# SPDX-License-Identifier: GPL-3.0-or-later
"""The shared library: where it is, and what its headers declare.

ctypes, not cffi or an extension module: nothing is compiled, so that one wheel serves every Python 3
of a machine; a call lets other threads run; and what is declared here is compared with the headers
by tests/test_declarations.py and, when the package is imported, with the library that is there.
"""

from __future__ import annotations

import ctypes
import os
import sys
from ctypes import (
    CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t,
    c_ssize_t, c_uint32, c_uint64, c_void_p,
)
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

#: Of numbers, as numpy has them.
Array = NDArray[Any]

NUMBERS = POINTER(c_double)
TEXTS = POINTER(c_char_p)

# enum mesofit_status
OK, BAD_INPUT, IO, NO_MEMORY, UNSTABLE, UNCONVERGED, INTERRUPTED = range(7)

LAW = CFUNCTYPE(c_double, c_void_p, c_double)
FORCE = CFUNCTYPE(c_double, c_void_p, c_size_t, POINTER(c_uint32), POINTER(NUMBERS),
                  POINTER(NUMBERS))
FORCE.__doc__ = """Type of a compiled force for `Simulation.set_force`, as in mesofit/simulation.h:
``double force(void *context, size_t count, const uint32_t *ids, const double *const *positions,
double *const *forces)``."""
OBSERVABLE = CFUNCTYPE(c_ssize_t, c_void_p, c_size_t, c_int, NUMBERS, NUMBERS, POINTER(c_int32),
                       NUMBERS, c_size_t, NUMBERS)
OBSERVABLE.__doc__ = """Type of a compiled observable for `simulate`, as in mesofit/run.h:
``ptrdiff_t observable(void *context, size_t count, int dimensions, const double *positions,
const double *velocities, const int32_t *types, const double *box, size_t room, double *values)``.
It returns how many values it has, and writes them if there is room."""
FIT_PROGRESS = CFUNCTYPE(c_int, c_void_p, c_uint32, c_uint64, c_uint64)


class Table(Structure):
    _fields_ = [("name", c_char_p), ("rows", c_size_t), ("columns", c_size_t), ("values", NUMBERS)]


class Text(Structure):
    _fields_ = [("name", c_char_p), ("text", c_char_p)]


class Frame(Structure):
    _fields_ = [("time", c_double), ("box", c_double * 9), ("positions", NUMBERS),
                ("velocities", NUMBERS), ("forces", NUMBERS)]


FRAME_READER = CFUNCTYPE(c_int, c_void_p, c_size_t, POINTER(Frame))


class Trajectory(Structure):
    _fields_ = [("name", c_char_p), ("atoms", c_size_t), ("frames", c_size_t),
                ("length", c_double), ("time", c_double), ("names", TEXTS),
                ("residue_names", TEXTS), ("residues", POINTER(c_int64)), ("masses", NUMBERS),
                ("read", FRAME_READER), ("context", c_void_p)]


class NamedObservable(Structure):
    _fields_ = [("name", c_char_p), ("function", OBSERVABLE), ("context", c_void_p)]


class Inputs(Structure):
    _fields_ = [("texts", POINTER(Text)), ("text_count", c_size_t), ("tables", POINTER(Table)),
                ("table_count", c_size_t), ("trajectory", POINTER(Trajectory)),
                ("observables", POINTER(NamedObservable)), ("observable_count", c_size_t)]


class RunProgress(Structure):
    _fields_ = [("done", c_uint64), ("total", c_uint64), ("rate", c_double), ("open", c_int),
                ("unit", c_char * 16), ("text", c_char * 160)]


class Columns(Structure):
    _fields_ = [("rows", c_size_t), ("columns", c_size_t), ("values", NUMBERS), ("names", TEXTS),
                ("units", TEXTS), ("comment", c_char_p)]


class Law(Structure):
    _fields_ = [("text", c_char_p), ("value", LAW), ("context", c_void_p), ("cutoff", c_double)]


class Scene(Structure):
    _fields_ = [("box", c_double * 3), ("particles", c_int64), ("temperature", c_double),
                ("time_step", c_double), ("conservative", Law), ("dissipative", Law),
                ("integrator", c_char_p), ("seed", c_uint64), ("threads", c_int)]


class RdfPlan(Structure):
    _fields_ = [("range", c_double), ("bins", c_size_t), ("samples", c_size_t),
                ("every", c_uint64)]


class Means(Structure):
    _fields_ = [("temperature", c_double), ("temperature_error", c_double), ("energy", c_double),
                ("energy_error", c_double), ("pressure", c_double), ("pressure_error", c_double)]


class FitState(Structure):
    _fields_ = [("iteration", c_uint32), ("simulations", c_uint64), ("engine_steps", c_uint64),
                ("error", c_double), ("noise", c_double), ("finished", c_int),
                ("converged", c_int), ("reason", c_char_p)]


class Curve(Structure):
    _fields_ = [("count", c_size_t), ("r", NUMBERS), ("value", NUMBERS), ("error", NUMBERS)]


class Verification(Structure):
    _fields_ = [("rdf_rms", c_double), ("rdf_rms_error", c_double), ("rdf_noise", c_double),
                ("etd_rms", c_double), ("etd_noise", c_double), ("temperature", c_double),
                ("pressure", c_double), ("pressure_error", c_double)]


#: Structs of the headers by their names there.
STRUCTS = {
    "mesofit_table": Table, "mesofit_text": Text, "mesofit_frame": Frame,
    "mesofit_trajectory": Trajectory, "mesofit_named_observable": NamedObservable, "mesofit_inputs": Inputs,
    "mesofit_run_progress": RunProgress, "mesofit_columns": Columns, "mesofit_law": Law,
    "mesofit_scene": Scene, "mesofit_rdf_plan": RdfPlan, "mesofit_means": Means,
    "mesofit_fit_state": FitState, "mesofit_curve": Curve, "mesofit_verification": Verification,
}

#: Functions of the headers: what they return, and what they take. Opaque structs are c_void_p.
FUNCTIONS = {
    "mesofit_message": (c_char_p, []),
    "mesofit_version": (c_char_p, []),
    "mesofit_size_of": (c_size_t, [c_char_p]),
    "mesofit_run_create": (c_void_p, []),
    "mesofit_run_free": (None, [c_void_p]),
    "mesofit_run_words": (c_int, [c_void_p, c_size_t, TEXTS, POINTER(Inputs)]),
    "mesofit_run_stop": (None, [c_void_p]),
    "mesofit_run_progress": (None, [c_void_p, POINTER(RunProgress)]),
    "mesofit_run_line": (c_char_p, [c_void_p, c_size_t]),
    "mesofit_result_open": (c_void_p, [c_char_p]),
    "mesofit_result_free": (None, [c_void_p]),
    "mesofit_result_name": (c_char_p, [c_void_p, c_size_t]),
    "mesofit_result_table": (c_int, [c_void_p, c_char_p, POINTER(Columns)]),
    "mesofit_result_text": (c_char_p, [c_void_p, c_char_p]),
    "mesofit_simulation_parse": (c_void_p, [c_char_p, POINTER(Table), c_size_t]),
    "mesofit_simulation_free": (None, [c_void_p]),
    "mesofit_simulation_set_force": (None, [c_void_p, FORCE, c_void_p]),
    "mesofit_simulation_stop": (None, [c_void_p]),
    "mesofit_simulation_run": (c_int, [c_void_p, c_uint64]),
    "mesofit_simulation_text": (c_char_p, [c_void_p]),
    "mesofit_simulation_step": (c_uint64, [c_void_p]),
    "mesofit_simulation_count": (c_size_t, [c_void_p]),
    "mesofit_simulation_dimensions": (c_int, [c_void_p]),
    "mesofit_simulation_ids": (POINTER(c_uint32), [c_void_p]),
    "mesofit_simulation_positions": (NUMBERS, [c_void_p, c_int]),
    "mesofit_simulation_velocities": (NUMBERS, [c_void_p, c_int]),
    "mesofit_simulation_temperature": (c_double, [c_void_p]),
    "mesofit_simulation_rdf": (c_int, [c_void_p, POINTER(RdfPlan), NUMBERS, NUMBERS, NUMBERS]),
    "mesofit_simulation_means": (c_int, [c_void_p, c_size_t, c_uint64, POINTER(Means)]),
    "mesofit_fit_parse": (c_void_p, [c_char_p, POINTER(Table), c_size_t, c_int, FIT_PROGRESS,
                                     c_void_p]),
    "mesofit_fit_open": (c_void_p, [c_char_p, c_int, FIT_PROGRESS, c_void_p]),
    "mesofit_fit_free": (None, [c_void_p]),
    "mesofit_fit_iterate": (c_int, [c_void_p, POINTER(FitState)]),
    "mesofit_fit_curve": (Curve, [c_void_p, c_int]),
    "mesofit_fit_verify": (c_int, [c_void_p, POINTER(Verification)]),
    "mesofit_fit_coefficients": (c_size_t, [c_void_p]),
    "mesofit_fit_start": (c_int, [c_void_p, NUMBERS]),
    "mesofit_fit_evaluate": (c_int, [c_void_p, NUMBERS, c_uint64, NUMBERS, NUMBERS]),
    "mesofit_optimiser_create": (c_void_p, [c_char_p, c_char_p, c_size_t, c_double, c_double,
                                            NUMBERS, c_uint64]),
    "mesofit_optimiser_free": (None, [c_void_p]),
    "mesofit_optimiser_ask": (c_int, [c_void_p, POINTER(NUMBERS), POINTER(c_size_t)]),
    "mesofit_optimiser_tell": (c_int, [c_void_p, NUMBERS, NUMBERS]),
    "mesofit_optimiser_best": (c_int, [c_void_p, NUMBERS]),
}

#: What the headers declare and this package does by other ways: a text says more than a struct.
UNUSED = {
    "mesofit_scene_default", "mesofit_simulation_create", "mesofit_simulation_open",
    "mesofit_fit_options_default", "mesofit_fit_create", "mesofit_rdf_plan_default",
    "mesofit_inversion_open", "mesofit_inversion_free", "mesofit_inversion_pieces",
    "mesofit_inversion_piece", "mesofit_inversion_potentials", "mesofit_inversion_tell",
    "mesofit_inversion_go_on",
}


def _places() -> list[str]:
    """Where the library may be: what the user says, the wheel, a clone that was built, the system."""
    here = Path(__file__).resolve().parent
    clone = here.parent.parent / "build"
    named = [os.environ["MESOFIT_LIBRARY"]] if os.environ.get("MESOFIT_LIBRARY") else []
    found = [str(path) for path in (here / "lib" / "libmesofit.so.0", clone / "libmesofit.so.0")
             if path.exists()]
    return named or found + ["libmesofit.so.0"]


def _declare(library: ctypes.CDLL, path: str) -> None:
    for name, (result, arguments) in FUNCTIONS.items():
        try:
            function = getattr(library, name)
        except AttributeError:
            raise ImportError(f"{path} has no {name}: it is of an older mesofit than this package")
        function.restype, function.argtypes = result, arguments
    for name, struct in STRUCTS.items():
        size = library.mesofit_size_of(name.encode())
        if size != ctypes.sizeof(struct):
            raise ImportError(f"{path}: struct {name} has {size} bytes, expected "
                              f"{ctypes.sizeof(struct)}: library and package are of different "
                              f"versions of mesofit")


def _load() -> ctypes.CDLL:
    # As the program does: threads of libgomp that wait for each other sleep, for cores may be busy.
    # It reads this when it is loaded.
    if "OMP_WAIT_POLICY" not in os.environ:
        os.environ.setdefault("GOMP_SPINCOUNT", "1000")
    faults = []
    for path in _places():
        try:
            library = ctypes.CDLL(path)
        except OSError as fault:
            faults.append(str(fault))
            continue
        _declare(library, path)
        return library
    raise ImportError("the library of mesofit was not found (" + "; ".join(faults) + "): install "
                      "the wheel, or run make in the clone, or set MESOFIT_LIBRARY to its path")


if not sys.platform.startswith("linux"):
    raise ImportError("mesofit is for Linux")

lib = _load()
version: str = lib.mesofit_version().decode()


def message() -> str:
    """Why the last call of this thread failed."""
    return str(lib.mesofit_message().decode(errors="replace"))
