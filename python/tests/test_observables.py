# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions of the user's, averaged by a simulation: beside what is known of them."""

import ctypes
import shutil
import subprocess

import numpy as np
import pytest
from conftest import SCENE

import mesofit
from mesofit import _library


def kinetic(positions, velocities, types, box):
    return 0.5 * (velocities**2).sum() / len(velocities)


def potential(positions, velocities, types, box):
    """Of soft repulsion, a/2 (1 - r)², by all pairs."""
    apart = positions[:, None] - positions[None]
    apart -= box * np.rint(apart / box)
    r = np.sqrt((apart**2).sum(axis=-1))[np.triu_indices(len(positions), 1)]
    return 12.5 * (np.clip(1 - r, 0, None)**2).sum() / len(positions)


def simulate(**observables):
    return mesofit.simulate(SCENE, threads=1, observables=observables)


def test_energies_are_those_that_are_known():
    run = simulate(kinetic=kinetic, energy=potential)
    table = run["kinetic"]
    assert table.columns == ("index", "value", "error") and len(table["value"]) == 1
    equipartition = 1.5 * 189 / 190
    assert abs(table["value"][0] - equipartition) < 4 * table["error"][0] < 0.2
    # The program sums in single precision.
    assert run["energy"]["value"][0] == pytest.approx(run.summary["potential_energy"], rel=1e-5)
    assert run["energy"]["error"][0] == pytest.approx(run.summary["potential_energy_error"],
                                                      rel=0.5)


def test_errors_see_correlation():
    """The error of a slow wave's mean is that of far fewer samples than there are."""
    phase = iter(range(10**6))
    run = mesofit.simulate(SCENE, threads=1, measure={"equilibration": 0, "samples": 400,
                                                      "every": 1},
                           observables={"wave": lambda *_: np.sin(2 * np.pi * next(phase) / 100)})
    assert run["wave"]["error"][0] > 2 * np.sqrt(0.5 / 400)


@pytest.mark.filterwarnings("ignore:there is no thermostat")
def test_arrays_are_rows_and_units_are_the_scenes():
    scene = {"units": {"system": "nm-ps", "length": 0.5, "mass": 18}, "box": [2, 2, 2],
             "particles": {"count": 190}, "temperature": 300, "time_step": 0.01,
             "conservative": {"law": "soft-repulsion", "a": 60, "cutoff": 0.5},
             "measure": {"equilibration": 500, "samples": 40, "every": 5}}

    def seen(positions, velocities, types, box):
        assert positions.shape == velocities.shape == (190, 3) and (types == 0).all()
        return [[*box, positions.min(), positions.max()], [velocities.var(), 0, 0, 0, np.nan]]
    run = mesofit.simulate(scene, threads=1, seed=3, observables={"seen": seen})
    values = run["seen"]["value"]
    assert values[:3] == pytest.approx([2, 2, 2]) and 0 <= values[3] < 0.1 and 1.9 < values[4] < 2
    assert np.isnan(values[9]) and values[8] == 0
    # k_B T/m in (nm/ps)², at the temperature that the run says it had.
    expected = 0.00831446 * run.summary["temperature"] / 18
    assert values[5] == pytest.approx(expected * 189 / 190, rel=0.02)


def test_types_are_in_the_order_of_the_scene():
    scene = {"box": [4, 4, 4], "particles": {"types": {"A": 25, "B": 75}},
             "conservative": {"A-A": {"law": "soft-repulsion", "a": 25},
                              "A-B": {"law": "soft-repulsion", "a": 25},
                              "B-B": {"law": "soft-repulsion", "a": 25}},
             "dissipative": {"law": "power", "sigma": 3},
             "measure": {"equilibration": 0, "samples": 1, "every": 1}}
    run = mesofit.simulate(scene, observables={"types": lambda p, v, types, box: types})
    assert list(run["types"]["value"]) == [0] * 25 + [1] * 75


def test_monte_carlo_has_no_velocities():
    found = []
    scene = {key: value for key, value in SCENE.items() if key != "dissipative"}
    mesofit.simulate(scene, dynamics={"integrator": "monte-carlo"}, threads=1,
                     observables={"x": lambda p, v, t, b: found.append(v) or 1})
    assert found == [None] * 40


@pytest.mark.parametrize("place", [1, 40])
def test_an_exception_ends_the_run_without_results(tmp_path, place):
    calls = []

    def fails(positions, velocities, types, box):
        calls.append(positions)
        if len(calls) == place:
            raise ZeroDivisionError("my own")
        return 1.0
    out = tmp_path / "out"
    with pytest.raises(ZeroDivisionError, match="my own"):
        mesofit.simulate(SCENE, folder=out, threads=1, observables={"fails": fails})
    assert len(calls) == place
    assert not list(out.glob("*.tsv")) and not (out / "summary.json").exists()
    assert not (calls[0] == calls[-1]).all() or place == 1  # its own arrays, not views
    run = mesofit.simulate(SCENE, folder=out, threads=1, resume=True, observables={"fails": fails})
    whole = mesofit.simulate(SCENE, threads=1)
    assert run["fails"]["value"][0] == 1
    assert (run["rdf"].values == whole["rdf"].values).all()


@pytest.mark.parametrize("answer, said", [
    (None, "found None"), ("text", "expected a number or an array"), ([], "no value"),
    (1j, "expected a number or an array"), ([[1], [2, 3]], "expected a number or an array")])
def test_answers_that_are_no_numbers(answer, said):
    with pytest.raises(mesofit.InputError, match=said):
        simulate(x=lambda *_: answer)


def test_an_array_that_grows_is_refused():
    size = iter(range(1, 100))
    with pytest.raises(mesofit.InputError, match='"x" has 2 values at step 210, and had 1 before'):
        simulate(x=lambda *_: np.zeros(next(size)))


def test_a_large_array_is_asked_for_once():
    calls = []
    run = simulate(x=lambda *_: calls.append(1) or np.arange(1000))
    assert len(calls) == 40 and list(run["x"]["value"]) == list(range(1000))


@pytest.mark.parametrize("observables, said", [
    ([kinetic], "expected a dict"), ({"x": 3}, "expected a function, found int"),
    ({1: kinetic}, "expected a text"), ({"rdf": kinetic}, "has a table of this name"),
    ({"a/b": kinetic}, "expected a name of letters"),
    ({f"x{k}": kinetic for k in range(17)}, "at most 16")])
def test_what_is_no_observable_is_refused(observables, said):
    with pytest.raises(mesofit.InputError, match=said):
        mesofit.simulate(SCENE, observables=observables)


@pytest.mark.skipif(shutil.which("cc") is None, reason="no compiler")
def test_a_function_in_c_is_called_directly(tmp_path):
    source = tmp_path / "own.c"
    source.write_text("""
        #include <mesofit.h>
        mesofit_observable kinetic;
        ptrdiff_t kinetic(void *context, size_t count, int dimensions, const double *position,
                          const double *velocity, const int32_t *type, const double *edge,
                          size_t room, double *values) {
            if (room < 1) return 1;
            values[0] = 0;
            for (size_t k = 0; k < count * (size_t)dimensions; k++)
                values[0] += 0.5 * velocity[k] * velocity[k] / (double)count;
            return 1;
        }""")
    from conftest import ROOT
    subprocess.run(["cc", "-shared", "-fPIC", f"-I{ROOT / 'include'}", "-o",
                    str(tmp_path / "own.so"), str(source)], check=True)
    own = ctypes.CDLL(str(tmp_path / "own.so")).kinetic
    run = simulate(c=mesofit.OBSERVABLE(ctypes.cast(own, ctypes.c_void_p).value), python=kinetic)
    assert run["c"]["value"][0] == pytest.approx(run["python"]["value"][0], rel=1e-12)
    assert _library.OBSERVABLE is mesofit.OBSERVABLE
