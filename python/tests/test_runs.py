# SPDX-License-Identifier: GPL-3.0-or-later
"""measure, fit, simulate: the bits, the lines and the folders of the program."""

import json
import os
import pickle
import signal
import threading
import warnings

import numpy as np
import pytest
from conftest import ROOT, SCENE, run_program

import mesofit
from mesofit import _library, _run

WATER = ROOT / "tests" / "trajectories"


def assert_same_tables(folder, other, but=("timing.tsv", "tasks.tsv")):
    names = sorted(path.name for path in folder.glob("*.tsv") if path.name not in but)
    assert names == sorted(path.name for path in other.glob("*.tsv") if path.name not in but)
    for name in names:
        assert (folder / name).read_bytes() == (other / name).read_bytes(), name


def test_simulation_has_the_bits_of_the_program(tmp_path):
    run = mesofit.simulate(SCENE, threads=1, seed=7)
    (tmp_path / "scene.json").write_text(json.dumps(SCENE))
    run_program("simulate", "scene.json", "--seed", 7, "-o", "out", cwd=tmp_path)
    assert_same_tables(run.folder, tmp_path / "out")
    assert run.used == mesofit.open(tmp_path / "out").used
    assert run.kind == "simulation" and run.status == "ok"


def test_fit_has_the_bits_of_the_program(run_file, fitted, tmp_path):
    table = run_file["target"]["rdf"]["file"]
    np.savetxt(tmp_path / "rdf.tsv", table, fmt="%.17g")
    plain = {**run_file, "target": {"rdf": {"file": "rdf.tsv"}}}
    (tmp_path / "run.json").write_text(json.dumps(plain))
    run_program("fit", "run.json", "-o", "out", "--threads", 2, cwd=tmp_path)
    assert_same_tables(fitted.folder, tmp_path / "out")
    assert fitted.kind == "fit"
    # and from the file, by keys that change it
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other = mesofit.fit(tmp_path / "run.json", threads=1, seed=1)
    assert_same_tables(fitted.folder, other.folder)


def test_measurement_has_the_bits_of_the_program(tmp_path):
    target = mesofit.measure(WATER / "water.xtc", WATER / "water.gro", temperature=298, bins=50)
    run_program("measure", WATER / "water.xtc", "-s", WATER / "water.gro", "--temperature", 298,
                "--bins", 50, "-o", tmp_path / "out")
    assert_same_tables(target.folder, tmp_path / "out")
    assert target.kind == "measurement"
    assert target["rdf"].unit("r") == "nm" and len(target["rdf"]) == 50


def test_target_is_fitted_with_keys_of_the_callers(tmp_path):
    target = mesofit.measure(WATER / "water.xtc", WATER / "water.gro")
    with pytest.raises(mesofit.InputError) as fault:
        mesofit.fit(target, folder=tmp_path / "out")
    line, code = run_program("fit", "--target", target.folder, "-o", tmp_path / "out")
    # Keywords have no dashes.
    assert str(fault.value) == line.replace("--", "") and code == 2
    keys = dict(method="ibi", unknowns={"potential": {"cuttof": 0.9}})
    with pytest.raises(mesofit.InputError, match="cuttof: unknown key"):
        mesofit.fit(target, temperature=298, folder=tmp_path / "out", **keys)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("scene", [
    {"bax": 1}, {**SCENE, "temperature": -1}, {**SCENE, "particles": {"count": 0}},
    {**SCENE, "conservative": {"law": "table", "file": "no.tsv"}},
    {**SCENE, "dynamics": {"integrator": "leapfrog"}}, {**SCENE, "units": "metric"},
])
def test_faults_are_the_lines_of_the_program(scene, tmp_path):
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    line, code = run_program("simulate", tmp_path / "scene.json", "-o", tmp_path / "out")
    with pytest.raises(mesofit.Error) as fault:
        mesofit.simulate(tmp_path / "scene.json", folder=tmp_path / "out")
    assert str(fault.value) == line and code == 2
    with pytest.raises(mesofit.Error):
        mesofit.simulate(scene)


def test_steps_are_samples_and_keys_are_put_in():
    run = mesofit.simulate(SCENE, steps=100, measure={"every": 10}, rdf={"bins": 16})
    assert run.used["measure"] == {"equilibration": 200, "samples": 10, "every": 10}
    assert len(run["rdf"]) == 16
    default = mesofit.simulate({**SCENE, "measure": {"equilibration": 0}}, steps=100)
    assert default.used["measure"] == {"equilibration": 0, "samples": 4, "every": 25}
    with pytest.raises(mesofit.InputError, match="steps: expected 25"):
        mesofit.simulate({**SCENE, "measure": {}}, steps=10)


def test_warnings_are_pythons():
    hot = {**SCENE, "temperature": 300, "time_step": 0.0005}
    with pytest.warns(mesofit.MesofitWarning) as warned:
        run = mesofit.simulate(hot, steps=50)
    assert {warning.filename for warning in warned} == {__file__}
    assert any(line.startswith("mesofit: warning: ") for line in run.messages)


def test_keywords_reach_into_the_target_of_a_file(run_file):
    with pytest.raises(mesofit.InputError, match='target.rdf.cutof: .* "cutoff"'):
        mesofit.fit(run_file, target={"rdf": {"cutof": 1}})


def test_unconverged_fits_are_results_with_a_warning(run_file):
    short = {**run_file, "method": {"name": "ibi", "replicas": 2, "iterations": 1}}
    with pytest.warns(mesofit.UnconvergedWarning, match="has not converged"):
        fit = mesofit.fit(short)
    assert fit.status == "unconverged" and fit.reason and not fit.converged
    assert len(fit.potential.table) > 10


# Folders ------------------------------------------------------------------------------------------

def test_results_are_saved_opened_and_pickled(fitted, tmp_path):
    fitted.save(tmp_path / "copy")
    opened, pickled = mesofit.open(tmp_path / "copy"), pickle.loads(pickle.dumps(fitted))
    for other in (opened, pickled):
        assert other.tables == fitted.tables and other.summary == fitted.summary
        for name in fitted.tables:
            assert np.array_equal(other[name].values, fitted[name].values, equal_nan=True)
    assert pickled.messages == fitted.messages
    assert "resume" in run_program("fit", tmp_path / "copy" / "used.json", "-o",
                                   tmp_path / "copy")[0] or opened.status == "converged"
    run = pickle.loads(pickle.dumps(fitted["rdf"]))
    assert run.columns == fitted["rdf"].columns and np.array_equal(run["r"], fitted["rdf"]["r"])


def test_temporary_folders_go_with_what_was_read_from_them():
    run = mesofit.simulate(SCENE, steps=50)
    folder, g = run.folder, run["rdf"]["g"]
    assert not g.flags.writeable and not g.flags.owndata
    before = g.copy()
    del run
    assert not folder.exists()
    assert np.array_equal(g, before)  # the memory is still there


def test_folder_of_the_users_is_not_replaced_unasked(fitted, run_file, tmp_path):
    fitted.save(tmp_path / "out")
    with pytest.raises(mesofit.InputError, match="force=True replaces it"):
        mesofit.fit(run_file, folder=tmp_path / "out")


def test_export_writes_what_the_program_writes(fitted, tmp_path):
    assert fitted.export("lammps", tmp_path / "one") == tmp_path / "one"
    run_program("export", fitted.folder, "--engine", "lammps", "-o", tmp_path / "two")
    for path in (tmp_path / "two").iterdir():
        if path.name not in ("README", ".mesofit-export"):
            other = (tmp_path / "one" / path.name).read_bytes()
            assert other.replace(b"/one", b"/two") == path.read_bytes()
    with pytest.raises(mesofit.InputError, match="lammps"):
        fitted.export("gulp", tmp_path / "three")


# Interruption -------------------------------------------------------------------------------------

def interrupt_once(monkeypatch, when):
    """Ctrl-C at the first look at a run of which `when` is true."""
    look, sent = _run._Run.look, []

    def look_and_interrupt(self, progress):
        look(self, progress)
        if not sent and when(self):
            sent.append(True)
            os.kill(os.getpid(), signal.SIGINT)
    # What is started in the background by a shell ignores Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(_run._Run, "look", look_and_interrupt)


def steps_of(run):
    now = _library.RunProgress()
    _library.lib.mesofit_run_progress(run.run, now)
    return now.done


def test_simulation_interrupted_before_its_first_sample_has_no_results(tmp_path, monkeypatch):
    interrupt_once(monkeypatch, lambda run: True)
    with pytest.raises(KeyboardInterrupt, match="continue with resume=True"):
        mesofit.simulate(SCENE, folder=tmp_path / "out", measure={"equilibration": 10**9})
    assert (tmp_path / "out" / "checkpoint.bin").exists()


def test_interrupted_simulation_without_a_folder_says_that_it_needs_one(monkeypatch):
    interrupt_once(monkeypatch, lambda run: True)
    with pytest.raises(KeyboardInterrupt, match="in a folder=… it could be continued"):
        mesofit.simulate(SCENE, measure={"equilibration": 10**9})


def test_interrupted_simulation_goes_on_with_the_same_bits(tmp_path, monkeypatch):
    long = {**SCENE, "measure": {"equilibration": 0, "samples": 4000, "every": 10}}
    interrupt_once(monkeypatch, lambda run: steps_of(run) > 1000)
    with pytest.warns(mesofit.InterruptedWarning, match="continue with resume=True"):
        stopped = mesofit.simulate(long, folder=tmp_path / "out", threads=1)
    assert stopped.status == "interrupted" and len(stopped["rdf"]) == 32
    assert (tmp_path / "out" / "checkpoint.bin").exists()
    run = mesofit.simulate(long, folder=tmp_path / "out", threads=1, resume=True)
    whole = mesofit.simulate(long, threads=1)
    assert_same_tables(run.folder, whole.folder)


def test_fit_of_a_temporary_target_goes_on_in_another_session(tmp_path, monkeypatch):
    positions = np.random.default_rng(1).random((20, 100, 3)) * 2.0

    def target():
        return mesofit.measure(mesofit.Frames(positions, [2, 2, 2]), temperature=298, static=True)
    keys = {"method": {"name": "ibi", "replicas": 2, "precision": 0.1, "iterations": 2, "samples": 8,
                       "equilibration": 5}, "verification": {"replicas": 2, "samples": 5}}
    warnings.simplefilter("ignore", mesofit.MesofitWarning)
    interrupt_once(monkeypatch, lambda run: any("iteration 0" in line for line in run.outcome.lines))
    stopped = mesofit.fit(target(), folder=tmp_path / "out", **keys)
    assert stopped.status == "interrupted"
    # The first target's folder is gone; what was measured again has the same bits.
    again = mesofit.fit(target(), folder=tmp_path / "out", resume=True, **keys)
    assert again.status != "interrupted"
    other = mesofit.fit(tmp_path / "out" / "target", folder=tmp_path / "two", **keys)
    assert_same_tables(again.folder, other.folder)
    with pytest.raises(mesofit.InputError, match="force=True replaces it"):
        mesofit.fit(target(), folder=tmp_path / "out", **keys)


def test_interrupted_fit_is_what_there_is(run_file, monkeypatch):
    endless = {**run_file, "method": {"name": "ibi", "replicas": 2, "precision": 1e-3,
                                      "samples": 20, "equilibration": 20}}
    interrupt_once(monkeypatch, lambda run: any("iteration 0" in line
                                                for line in run.outcome.lines))
    with pytest.warns(mesofit.InterruptedWarning, match="interrupted after"):
        fit = mesofit.fit(endless)
    assert fit.status == "interrupted" and len(fit.potential.table) > 10


def test_runs_side_by_side_do_not_disturb_each_other(simulated):
    results = [None] * 3
    scene = {**SCENE, "measure": {"equilibration": 1000, "samples": 200, "every": 5}}

    def work(k):
        results[k] = mesofit.simulate(scene, threads=1)
    threads = [threading.Thread(target=work, args=(k,)) for k in range(len(results))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for run in results:
        assert_same_tables(run.folder, simulated.folder)


def test_fits_side_by_side_have_the_bits_of_one(run_file, fitted):
    results = [None, None]

    def work(k):
        results[k] = mesofit.fit(run_file, threads=1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    for fit in results:
        assert_same_tables(fit.folder, fitted.folder)


def test_child_of_a_fork_leaves_the_parents_results():
    run = mesofit.simulate(SCENE, steps=50, threads=2)
    child = os.fork()
    if child == 0:
        same = False
        try:
            other = mesofit.simulate(SCENE, steps=50, threads=2)
            same = np.array_equal(other["rdf"].values, run["rdf"].values)
            run.__dict__.clear()
        finally:
            os._exit(0 if same else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert run.folder.exists() and len(run["rdf"]) == 32
