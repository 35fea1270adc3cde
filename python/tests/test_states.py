# SPDX-License-Identifier: GPL-3.0-or-later
"""A fit of several states, as a dict in memory, and the same as files of the program."""

import json
import warnings

import numpy as np
import pytest
from conftest import SCENE, run_program

import mesofit

METHOD = {"name": "imc", "replicas": 2, "precision": 0.05, "iterations": 2}
VERIFICATION = {"replicas": 2, "equilibration": 100, "samples": 40, "every": 5}


@pytest.fixture(scope="module")
def targets(simulated):
    """g(r) of one liquid at two temperatures."""
    warm = mesofit.simulate(SCENE, temperature=1.5, threads=1,
                            measure={"equilibration": 1000, "samples": 200})
    return {"cold": simulated["rdf"].values, "warm": warm["rdf"].values}


@pytest.fixture(scope="module")
def states(targets):
    """What a fit of both says, tables in memory."""
    scene = {key: SCENE[key] for key in ("box", "particles", "dissipative")}
    return {"scene": scene, "method": METHOD, "verification": VERIFICATION, "states": {
        "cold": {"target": {"rdf": {"file": targets["cold"]}}, "scene": {"temperature": 1}},
        "warm": {"target": {"rdf": {"file": targets["warm"]}}, "scene": {"temperature": 1.5}}}}


@pytest.fixture(scope="module")
def both(states):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it is short, and may say so
        return mesofit.fit(states, threads=2)


def test_states_have_their_tables_and_one_potential(both, targets):
    assert list(both.states) == ["warm"] and set(both.summary["states"]) == {"cold", "warm"}
    for name, result in (("cold", both), ("warm", both.states["warm"])):
        rdf = result["rdf"]
        assert "target" in rdf.columns, rdf.columns
        measured = np.interp(rdf["r"], targets[name][:, 0], targets[name][:, 1])
        assert np.abs(rdf["target"] - measured).max() < 0.02
    r, phi = both.potential["r"], both.potential["phi"]
    inside = (r > 0.4) & (r < 1)
    # The potential that both were made with.
    assert np.abs(phi - 12.5 * (1 - r)**2)[inside].max() < 1.5


def test_it_is_what_the_program_makes_of_files(both, states, tmp_path):
    written = json.loads(json.dumps({**states, "states": {}}))
    for name, state in states["states"].items():
        np.savetxt(tmp_path / f"{name}.tsv", state["target"]["rdf"]["file"], fmt="%.17g")
        written["states"][name] = {"target": {"rdf": {"file": f"{name}.tsv"}},
                                   "scene": state["scene"]}
    (tmp_path / "run.json").write_text(json.dumps(written))
    run_program("fit", "run.json", "-o", "out", "--threads", "2", cwd=tmp_path)
    there = mesofit.open(tmp_path / "out")
    for name in both.tables:
        if name not in ("timing", "tasks"):  # seconds
            assert np.array_equal(there[name].values, both[name].values, equal_nan=True), name
    assert np.array_equal(there.states["warm"]["rdf"].values,
                          both.states["warm"]["rdf"].values, equal_nan=True)


def test_a_problem_has_one_state(states):
    with pytest.raises(mesofit.InputError, match="states: a fit that is stepped has one; .*fit"):
        mesofit.Problem(states)


def test_keywords_reach_into_states(states):
    with pytest.raises(mesofit.InputError, match="states.warm: .*temprature: unknown key"):
        mesofit.fit(states, **{"states": {"warm": {"scene": {"temprature": 2}}}})
    with pytest.raises(mesofit.InputError, match='"genetic" fits one state; "auto" and "imc" fit several'):
        mesofit.fit(states, method={"name": "genetic", "replicas": None, "precision": None,
                                    "iterations": None})
