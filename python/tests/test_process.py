# SPDX-License-Identifier: GPL-3.0-or-later
"""What a process is to its library: where it is, its locale, threads, forks, memory, Ctrl-C."""

import gc
import locale
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest
from conftest import SCENE

import mesofit

SHORT = {"equilibration": 20, "samples": 4, "every": 5}


@pytest.fixture
def german(tmp_path, monkeypatch):
    monkeypatch.setenv("LOCPATH", str(tmp_path / "locales"))
    (tmp_path / "locales").mkdir()
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8",
                           str(tmp_path / "locales" / "de_DE.UTF-8")], capture_output=True)
    if made.returncode != 0:
        pytest.skip("localedef has no sources of de_DE (Debian: locales)")
    before = locale.setlocale(locale.LC_ALL)
    locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
    yield
    locale.setlocale(locale.LC_ALL, before)


def test_a_comma_of_the_process_reaches_no_number(german, tmp_path):
    law = mesofit.law(lambda r: 12.5 * (1 - r) ** 2, 1.0)
    run = mesofit.simulate({**SCENE, "conservative": law}, measure=SHORT, folder=tmp_path / "run",
                           observables={"x": lambda positions, *_: positions[:, 0].mean()})
    assert run["rdf"]["r"][0] == pytest.approx(0.025)
    assert run.used["conservative"]["law"] == "table" and run.summary["seconds"] > 0
    assert mesofit.Simulation({**SCENE, "conservative": law}).scene["temperature"] == 1
    assert locale.str(0.5) == "0,5"


def test_a_folder_is_where_it_was_named(tmp_path, monkeypatch):
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
    monkeypatch.chdir(tmp_path / "here")

    def leaves(positions, velocities, types, box):
        os.chdir(tmp_path / "there")  # as %cd of a notebook, while it runs
        return 0.0
    run = mesofit.simulate(SCENE, measure=SHORT, folder="run", observables={"x": leaves})
    assert run.folder == tmp_path / "here" / "run" and len(run["rdf"]) == 32
    again = pickle.loads(pickle.dumps(run))
    assert again.status == "ok" and len(again["rdf"]) == 32
    assert list((tmp_path / "there").iterdir()) == []


def test_a_folder_that_is_gone_is_told(tmp_path):
    run = mesofit.simulate(SCENE, measure=SHORT, folder=tmp_path / "run")
    run.folder.rename(tmp_path / "elsewhere")
    for look in (lambda: run.summary, lambda: run.status, lambda: pickle.dumps(run)):
        with pytest.raises(mesofit.FileError, match="is gone"):
            look()


@pytest.mark.parametrize("make", [
    lambda run_file: mesofit.Simulation(SCENE), lambda run_file: mesofit.Problem(run_file),
    lambda run_file: mesofit.Optimiser("cma-es", 2)])
def test_what_nobody_knows_is_freed_at_once(make, run_file):
    thing = make(run_file)
    if isinstance(thing, mesofit.Simulation):
        thing.set_force(lambda positions, forces, ids: None)
        thing.run(2)
    gone = weakref.ref(thing)
    gc.disable()
    try:
        del thing
        assert gone() is None
    finally:
        gc.enable()


def test_what_is_closed_is_told(run_file):
    with mesofit.Simulation(SCENE) as simulation:
        simulation.run(2)
    with mesofit.Problem(run_file) as problem, mesofit.Optimiser("cma-es", 2) as optimiser:
        pass
    simulation.close()
    for call in (lambda: simulation.run(1), lambda: simulation.positions, lambda: len(simulation),
                 lambda: simulation.set_force(None), lambda: simulation.scene, problem.iterate,
                 problem.curve, optimiser.ask, optimiser.best):
        with pytest.raises(mesofit.InputError, match="is closed"):
            call()
    assert "closed" in repr(simulation)
    live = mesofit.Simulation(SCENE)
    live.set_force(lambda positions, forces, ids: live.close())
    with pytest.raises(mesofit.InputError, match="is running"):
        live.run(2)


@pytest.fixture
def interrupted():
    """Ctrl-C some time after."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("call", [
    lambda s: s.run(10**9), lambda s: s.rdf(samples=10**6, every=100),
    lambda s: s.means(samples=10**6, every=100)])
def test_a_simulation_sees_ctrl_c_and_goes_on(call, interrupted):
    simulation = mesofit.Simulation(SCENE)
    begin = time.process_time()
    with pytest.raises(KeyboardInterrupt):
        call(simulation)
    assert time.process_time() - begin < 5
    step = simulation.step
    assert 0 < step < 10**6
    simulation.run(5)
    assert simulation.step == step + 5 and np.isfinite(simulation.positions).all()


def test_threads_have_a_stack_that_suffices():
    """In a process of its own: it would be a segmentation fault."""
    code = ("import threading; from conftest import SCENE; import mesofit\n"
            "threading.stack_size(32768)\n"
            f"mesofit.simulate(SCENE, measure={SHORT})\n"
            "mesofit.Simulation(SCENE).rdf(samples=2)\n"
            "assert threading.stack_size() == 32768\n")
    here = os.path.dirname(__file__)
    done = subprocess.run([sys.executable, "-c", code], cwd=here, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_children_that_are_forked_beside_a_first_run_go_on():
    """Python's own locks, of a module that is imported and of `tempfile`, are held by first runs."""
    code = ("import os, signal, sys, threading\nimport mesofit\n"
            f"run = lambda: mesofit.simulate({SCENE!r}, measure={SHORT!r}, threads=1)\n"
            "thread = threading.Thread(target=run)\nthread.start()\n"
            "statuses = []\n"
            "for _ in range(3):\n"
            "    child = os.fork()\n"
            "    if child == 0:\n"
            "        signal.alarm(20)\n        run()\n        os._exit(0)\n"
            "    statuses.append(os.waitpid(child, 0)[1])\n"
            "thread.join()\nsys.exit(any(statuses))\n")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                          cwd=os.path.dirname(os.path.dirname(mesofit.__file__)))
    assert done.returncode == 0, done.stderr


def test_children_that_are_forked_beside_a_run_go_on():
    """One in ten hung: of a lock of the library, or of the package, that a thread held."""
    stop, times = threading.Event(), []

    def work():
        while not stop.is_set():
            mesofit.simulate(SCENE, measure=SHORT, threads=1, progress=False)
    beside = threading.Thread(target=work)
    beside.start()
    try:
        for _ in range(10):
            child = os.fork()
            if child == 0:
                signal.alarm(20)
                mesofit.simulate(SCENE, measure=SHORT, threads=1, progress=False)
                os._exit(0)
            times.append(os.waitpid(child, 0)[1])
    finally:
        stop.set()
        beside.join()
    assert times == [0] * 10


MASKED = np.ma.masked_array(np.ones((2, 5, 3)), mask=np.eye(5, 3, dtype=bool)[None].repeat(2, 0))

REFUSED = {
    "positions": lambda: mesofit.Frames(MASKED, [4, 4, 4]),
    "a list of positions": lambda: mesofit.Frames(list(MASKED), [4, 4, 4]),
    "masses": lambda: mesofit.Frames(MASKED.data, masses=MASKED[0, :, 0]),
    "a box": lambda: mesofit.Frames(MASKED.data, MASKED[0, 0]),
    "an edge": lambda: mesofit.Simulation({**SCENE, "box": MASKED[0, 0]}),
    "a table": lambda: mesofit.Simulation(
        {**SCENE, "conservative": {"law": "table", "file": MASKED[0, :, :2]}}),
    "an observable": lambda: mesofit.simulate(
        SCENE, measure=SHORT, observables={"x": lambda *_: MASKED[0, 0]}),
}


@pytest.mark.parametrize("call", REFUSED.values(), ids=REFUSED.keys())
def test_what_is_masked_has_no_value(call):
    with pytest.raises(mesofit.InputError, match="masked"):
        call()


def test_complex_values_are_no_numbers():
    with pytest.raises(mesofit.InputError, match="positions: values are complex"):
        mesofit.Frames(np.ones((2, 5, 3)) * 1j, box=[3, 3, 3])



def test_a_copy_takes_no_writes():
    simulation = mesofit.Simulation(SCENE)
    for copy in (simulation.positions, simulation.velocities, simulation.box):
        with pytest.raises(ValueError, match="read-only"):
            copy[0] = 0
    simulation.set_force(lambda positions, forces, ids: positions.fill(0))
    with pytest.raises(ValueError, match="read-only"):
        simulation.run(1)
    with pytest.raises(ValueError, match="read-only"):
        mesofit.simulate(SCENE, measure=SHORT, observables={"x": lambda x, *_: x.fill(0)})
