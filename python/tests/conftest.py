# SPDX-License-Identifier: GPL-3.0-or-later
"""Small systems, and the program beside which the package is held."""

import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

import mesofit  # noqa: E402

PROGRAM = os.environ.get("MESOFIT", str(ROOT / "build" / "mesofit"))

SCENE = {
    "box": [4, 4, 4], "particles": {"count": 190}, "temperature": 1, "time_step": 0.01,
    "conservative": {"law": "soft-repulsion", "a": 25},
    "dissipative": {"law": "power", "sigma": 3},
    "measure": {"equilibration": 200, "samples": 40, "every": 5},
    "rdf": {"range": 1.6, "bins": 32},
}


def run_program(*words, cwd=None):
    """What it says on stderr, without its name, and its exit code."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=cwd, capture_output=True, text=True)
    return done.stderr.strip().removeprefix("mesofit: "), done.returncode


@pytest.fixture(scope="session")
def simulated():
    return mesofit.simulate(SCENE, threads=1, measure={"equilibration": 1000, "samples": 200})


@pytest.fixture(scope="session")
def run_file(simulated):
    """What a fit of it says, as a dict."""
    scene = {key: SCENE[key] for key in ("box", "particles", "temperature", "dissipative")}
    return {"target": {"rdf": {"file": simulated["rdf"].values}}, "scene": scene,
            "method": {"name": "ibi", "replicas": 2, "precision": 0.03, "iterations": 4},
            "verification": {"replicas": 2, "equilibration": 100, "samples": 40, "every": 5}}


@pytest.fixture(scope="session")
def fitted(run_file):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it is short, and may say so
        return mesofit.fit(run_file, threads=2)
