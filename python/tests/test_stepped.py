# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulations, fits and optimisers whose loop is the caller's."""

import ctypes
import gc
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, SCENE

import mesofit


def soft(r):
    return 12.5 * (1 - r) ** 2


def test_own_law_is_the_law_of_the_formula():
    own = mesofit.Simulation({**SCENE, "conservative": mesofit.law(soft, 1.0)}).run(20)
    formula = mesofit.Simulation(SCENE).run(20)
    assert np.abs(own.positions - formula.positions).max() < 1e-4
    numbers_alone = mesofit.law(lambda r: 12.5 * (1 - r) ** 2 if r < 1 else 0.0, 1.0)
    assert np.allclose(numbers_alone["file"], mesofit.law(soft, 1.0)["file"])


def test_simulation_tells_of_itself():
    scene = {"units": {"system": "nm-ps", "length": 0.5, "mass": 18}, "box": [4, 4, 4],
             "particles": {"count": 300}, "temperature": 300, "time_step": 0.001,
             "conservative": {"law": "soft-repulsion", "a": 20, "cutoff": 0.5}}
    simulation = mesofit.Simulation(scene)
    assert np.array_equal(simulation.box, [8, 8, 8])
    assert simulation.units["length_unit_nm"] == 0.5
    assert simulation.units["energy_unit_kJ_per_mol"] == pytest.approx(2.494, rel=1e-3)
    assert len(simulation) == 300 and simulation.dimensions == 3 and simulation.step == 0
    assert mesofit.Simulation(SCENE).units == {}
    velocities = mesofit.Simulation(SCENE).velocities
    assert velocities.shape == (190, 3)
    assert np.abs(velocities.mean(axis=0)).max() < 1e-12


def test_pieces_of_a_run_have_its_bits():
    whole, pieces = mesofit.Simulation(SCENE).run(70), mesofit.Simulation(SCENE)
    for _ in range(7):
        pieces.run(10)
    assert np.array_equal(whole.positions, pieces.positions)
    assert whole.step == 70


def test_own_force_does_work():
    """A uniform force in a free flight: x = x0 + v t + f t^2 / 2, by leapfrog without error."""
    scene = {"box": [9, 9, 9], "particles": {"count": 20}, "time_step": 0.01,
             "dynamics": {"integrator": "velocity-verlet"}}
    simulation = mesofit.Simulation(scene)
    x, v = simulation.positions, simulation.velocities
    seen = []

    def force(positions, forces, ids):
        seen.append((positions.shape, sorted(ids) == list(range(20))))
        forces[:, 0] += 2.0
    simulation.set_force(force)
    simulation.run(100)
    # The first half step knows the forces of before.
    assert np.allclose(simulation.velocities[:, 0] - v[:, 0], 2.0, atol=0.03)
    assert np.allclose(simulation.velocities[:, 1], v[:, 1])
    moved = (simulation.positions - x - v)[:, 0]
    assert np.allclose(moved - 9 * np.round(moved / 9), 1.0, atol=0.03)
    assert seen[0] == ((20, 3), True)
    simulation.set_force(None)
    v = simulation.velocities
    simulation.run(10)
    assert np.allclose(simulation.velocities, v, atol=0.03)


def test_compiled_force_is_called():
    calls = []

    @mesofit.FORCE
    def force(context, count, ids, positions, forces):
        calls.append(count)
        return 0.0

    class Numba:
        address = ctypes.cast(force, ctypes.c_void_p).value
    for compiled in (force, Numba()):
        simulation = mesofit.Simulation(SCENE)
        simulation.set_force(compiled)
        simulation.run(3)
    assert len(calls) >= 6 and set(calls) == {190}


def test_fault_of_a_force_is_the_callers_and_the_simulation_lives():
    simulation = mesofit.Simulation(SCENE)

    def broken(positions, forces, ids):
        raise ZeroDivisionError("no force")
    simulation.set_force(broken)
    with pytest.raises(ZeroDivisionError, match="no force"):
        simulation.run(5)
    assert simulation.step <= 1

    def meddles(positions, forces, ids):
        simulation.run(1)
    simulation.set_force(meddles)
    with pytest.raises(mesofit.InputError, match="is running"):
        simulation.run(5)
    simulation.set_force(lambda positions, forces, ids: forces.fill(np.nan))
    with pytest.raises(mesofit.InputError, match="not finite"):
        simulation.run(5)
    simulation.set_force(None)
    simulation.run(5)
    assert np.isfinite(simulation.positions).all()


def test_rdf_and_means_are_measured():
    simulation = mesofit.Simulation(SCENE).run(500)
    rdf = simulation.rdf(range=1.6, bins=32, samples=40, every=5)
    assert rdf.r.shape == rdf.g.shape == (32,)
    assert abs(rdf.g[-8:].mean() - 1) < 0.05
    means = simulation.means(samples=40, every=5)
    assert abs(means.temperature - 1) < 6 * means.temperature_error + 0.02
    with pytest.raises(mesofit.InputError):
        simulation.rdf(range=9)


def test_hot_steps_blow_up_as_an_exception():
    scene = {**SCENE, "conservative": {"law": "soft-repulsion", "a": 1e9}, "time_step": 0.5}
    with pytest.raises(mesofit.UnstableError):
        mesofit.Simulation(scene).run(200)


# Fits ---------------------------------------------------------------------------------------------

@pytest.fixture(scope="module")
def problem():
    return mesofit.Problem(ROOT / "examples" / "potential.json")


def test_candidates_are_measured(problem):
    start = problem.start()
    assert start.shape == (len(problem),) and len(problem.bounds) == len(problem)
    value = problem.evaluate(start, seed=3)
    assert value.error > 0 and value.variance >= 0
    assert problem.evaluate(start, seed=3) == value
    assert problem.evaluate(start, seed=4) != value
    assert problem(start) == problem.evaluate(start, seed=1).error


def test_threads_wait_for_each_other(problem):
    start, found = problem.start(), []
    threads = [threading.Thread(target=lambda: found.append(problem.evaluate(start)))
               for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3 and len(set(found)) == 1


def test_fit_is_stepped_and_verified(run_file):
    fit = mesofit.Problem(run_file)
    with pytest.raises(mesofit.InputError, match="no iteration yet"):
        fit.curve()
    with pytest.raises(mesofit.InputError, match="before an iteration"):
        fit.verify()
    state = fit.iterate()
    assert state.iteration == 1 and state.simulations == 2 and state.error > 0
    curve = fit.curve("potential")
    assert curve.r.shape == curve.value.shape and np.isfinite(curve.value).all()
    assert fit.verify()["rdf_rms"] > 0
    assert len(fit) == 0
    with pytest.raises(mesofit.InputError, match="does not measure candidates"):
        fit.start()
    before = curve.value.copy()
    fit.iterate()
    assert np.array_equal(curve.value, before)  # it is a copy
    del fit
    gc.collect()
    assert np.isfinite(curve.value).all()


def test_optimiser_finds_the_bottom_of_a_bowl():
    optimiser = mesofit.Optimiser("cma-es", 3, minimum=-1, maximum=2, seed=5)
    assert optimiser.best() is None
    for _ in range(60):
        candidates = optimiser.ask()
        if len(candidates) == 0:
            break
        optimiser.tell(((candidates - 0.3) ** 2).sum(axis=1))
    assert np.allclose(optimiser.best(), 0.3, atol=0.01)


def test_objects_that_outlive_the_library_end_in_silence():
    code = ("import numpy, mesofit; from conftest import SCENE\n"
            "numpy.kept = mesofit.Simulation(SCENE), mesofit.Optimiser('cma-es', 2)\n")
    done = subprocess.run([sys.executable, "-c", code], cwd=Path(__file__).parent,
                          env={**os.environ, "PYTHONPATH": str(ROOT / "python")},
                          capture_output=True, text=True, check=True)
    assert done.stderr == ""
