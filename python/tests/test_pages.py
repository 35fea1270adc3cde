# SPDX-License-Identifier: GPL-3.0-or-later
"""What docs/python.md and the README show is run in its order; and the example."""

import inspect
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

import mesofit

WATER = ROOT / "tests" / "trajectories"


def blocks(page):
    text = (ROOT / page).read_text()
    return [block for block in re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)]


@pytest.fixture
def names(tmp_path, monkeypatch, fitted, simulated):
    """What the blocks know: files that they name, and fits and simulations that are short."""
    pytest.importorskip("matplotlib").use("agg")
    pytest.importorskip("pandas")
    shutil.copy(WATER / "water.gro", tmp_path / "conf.gro")
    shutil.copy(WATER / "water.xtc", tmp_path / "traj.xtc")
    run_file = (ROOT / "examples" / "potential.json").read_text()
    (tmp_path / "potential.json").write_text(run_file.replace("../targets", f"{ROOT}/targets"))
    monkeypatch.chdir(tmp_path)
    signature, simulate = inspect.signature(mesofit.fit), mesofit.simulate

    def fit(*arguments, **keys):
        signature.bind(*arguments, **keys)
        return fitted

    def few_steps(scene, steps, **keys):
        return simulate(scene, steps=100, measure={"equilibration": 10}, **keys)
    monkeypatch.setattr(mesofit, "fit", fit)
    monkeypatch.setattr(mesofit, "simulate", few_steps)
    monkeypatch.setattr(mesofit.Simulation, "run", lambda self, steps, run=mesofit.Simulation.run:
                        run(self, min(steps, 20)))
    for name in ("rdf", "means"):
        monkeypatch.setattr(mesofit.Simulation, name, lambda self, measure=getattr(
            mesofit.Simulation, name), **keys: measure(self, samples=4, every=2, **keys))
    random = np.random.default_rng(1)
    count = (5, 100)
    return {"table": simulated["rdf"].values, "positions": 3 * random.random((*count, 3)),
            "velocities": random.normal(size=(*count, 3)), "box": [3, 3, 3], "types": ["A"] * 100,
            "times": np.arange(5.0), "masses": np.full(100, 18.0)}


def run(page, names):
    for block in blocks(page):
        if "import MDAnalysis" in block:
            try:
                import MDAnalysis  # noqa: F401
            except ImportError:
                block = block.split("\n\n", 1)[1]
        if "scipy" in block:
            scipy = pytest.importorskip("scipy.optimize")
            minimise = scipy.minimize
            scipy.minimize = lambda *a, **k: minimise(*a, **k, options={"maxfev": 2})
            import scipy as whole
            names["scipy"] = whole
        exec(compile(block, page, "exec"), names)
        if "scipy" in block:
            scipy.minimize = minimise


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_pages_run(page, names):
    assert len(blocks(page)) >= (1 if page == "README.md" else 6)
    run(page, names)


def test_all_public_names_are_on_the_page():
    page = (ROOT / "docs" / "python.md").read_text()
    shown_by_others = {"Curve", "Curves", "Error", "FileError", "Means", "Rdf", "Result", "State",
                       "Table", "UnstableError", "Value", "__version__"}
    for name in set(mesofit.__all__) - shown_by_others:
        assert re.search(rf"\b{name}\b", page), name


def test_example_of_an_optimiser_finds_a_better_potential():
    pytest.importorskip("scipy")
    example = ROOT / "examples" / "own_optimiser.py"
    done = subprocess.run([sys.executable, str(example), str(ROOT / "examples" / "potential.json")],
                          capture_output=True, text=True, check=True,
                          env={"PYTHONPATH": str(ROOT / "python"), "PATH": "/usr/bin:/bin"})
    start, end, fair = (float(re.search(r"(\d+\.\d+)", line).group(1))
                        for line in done.stdout.splitlines())
    assert end < 0.7 * start and fair < start
    wrong = subprocess.run([sys.executable, str(example), "no.json"], capture_output=True,
                           text=True, env={"PYTHONPATH": str(ROOT / "python")})
    assert wrong.returncode == 1 and "no.json: No such file" in wrong.stderr


