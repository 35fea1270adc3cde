# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong calls: each raises, and none ends the interpreter."""

import pickle
import re

import numpy as np
import pytest
from conftest import SCENE

import mesofit
from mesofit import InputError
from mesofit._errors import said


@pytest.fixture(scope="module")
def simulation():
    return mesofit.Simulation(SCENE)


@pytest.fixture(scope="module")
def optimiser():
    return mesofit.Optimiser("genetic", 2)


def test_explain_is_of_the_program():
    for run in (mesofit.fit, mesofit.simulate):
        with pytest.raises(InputError, match="explain: --explain of the program prints"):
            run(SCENE, explain=True)


NESTED: list = []
NESTED.append(NESTED)

SIMULATE = [
    None, 3, "no.json", "", "a\0b", [], b"no.json", {}, {1: 2}, {"box": NESTED},
    {**SCENE, "temperature": float("nan")}, {**SCENE, "temperature": object()},
    {**SCENE, "box": [1, 2, 3, 4]}, {**SCENE, "particles": "many"}, {**SCENE, "particles": True},
    {**SCENE, "conservative": lambda r: r}, {**SCENE, "conservative": None, "seed": -1},
    {**SCENE, "conservative": {"law": "table", "file": [1, 2, 3]}},
    {**SCENE, "conservative": {"law": "table", "file": np.empty((0, 2))}},
    {**SCENE, "conservative": {"law": "table", "file": np.array([["a", "b"]])}},
    {**SCENE, "conservative": {"law": "table", "file": [[0, np.nan], [1, 0]]}},
    {**SCENE, "title": "\ud800"},
]


@pytest.mark.parametrize("scene", SIMULATE, ids=range(len(SIMULATE)))
def test_scenes(scene):
    for do in (mesofit.simulate, mesofit.Simulation):
        with pytest.raises((mesofit.Error, TypeError)):
            do(scene)


def test_title_with_a_nul_is_refused_or_shown():
    try:
        mesofit.Simulation({**SCENE, "title": "a\0b"})
    except InputError as fault:
        assert "title" in str(fault) or "scene" in str(fault)


CALLS = {
    "fit of nothing": lambda: mesofit.fit(None),
    "fit of a number": lambda: mesofit.fit(3.0),
    "fit of no file": lambda: mesofit.fit("no/run.json"),
    "fit of a scene": lambda: mesofit.fit(SCENE),
    "fit of a folder without a target": lambda: mesofit.fit("/"),
    "fit by no method": lambda: mesofit.fit({"target": {}, "scene": SCENE}, method="magic"),
    "fit in a file": lambda: mesofit.fit({}, folder=__file__),
    "fit in many threads": lambda: mesofit.fit({}, threads=-1),
    "fit with a seed of text": lambda: mesofit.fit({}, seed="one"),
    "fit that goes on and begins": lambda: mesofit.fit({}, resume=True, force=True),
    "simulate no steps": lambda: mesofit.simulate(SCENE, steps=-5),
    "simulate half a step": lambda: mesofit.simulate(SCENE, steps=0.5),
    "steps of a wrong measure": lambda: mesofit.simulate(SCENE, steps=50, measure=3),
    "steps of no interval": lambda: mesofit.simulate(SCENE, steps=50, measure={"every": 0}),
    "simulate with a wrong key": lambda: mesofit.simulate(SCENE, stepps=5),
    "simulate in no folder": lambda: mesofit.simulate(SCENE, folder=3),
    "go on with nothing": lambda: mesofit.simulate(SCENE, resume=True),
    "measure nothing": lambda: mesofit.measure(None),
    "measure no files": lambda: mesofit.measure([]),
    "measure numbers": lambda: mesofit.measure([1, 2]),
    "measure an array": lambda: mesofit.measure(np.zeros((2, 3, 3))),
    "measure an option": lambda: mesofit.measure("--help"),
    "measure this": lambda: mesofit.measure(__file__),
    "measure by no bins": lambda: mesofit.measure("x.xtc", bins=0),
    "measure by wrong words": lambda: mesofit.measure("x.xtc", velocities="fast"),
    "measure by a broken map": lambda: mesofit.measure("x.xtc", map={"beads": 3}),
    "open nothing": lambda: mesofit.open(None),
    "open no folder": lambda: mesofit.open("no/folder"),
    "open a file": lambda: mesofit.open(__file__),
    "law beyond its cutoff": lambda: mesofit.law(abs, 0.0),
    "law of one point": lambda: mesofit.law(abs, 1.0, points=1),
    "law without end": lambda: mesofit.law(lambda r: r + np.inf, 1.0),
    "law of no function": lambda: mesofit.law(3, 1.0),
    "problem without a file": lambda: mesofit.Problem("no.json"),
    "problem of a scene": lambda: mesofit.Problem(SCENE),
    "problem in no thread": lambda: mesofit.Problem({}, threads=0),
    "no optimiser": lambda: mesofit.Optimiser("steepest", 2),
    "optimiser of no numbers": lambda: mesofit.Optimiser("genetic", 0),
    "optimiser upside down": lambda: mesofit.Optimiser("genetic", 2, minimum=1, maximum=0),
    "optimiser from afar": lambda: mesofit.Optimiser("genetic", 2, start=[1, 2, 3]),
    "optimiser with wrong settings": lambda: mesofit.Optimiser("genetic", 2, colour="red"),
    "optimiser with no settings": lambda: mesofit.Optimiser("genetic", 2, population=object()),
}


@pytest.mark.parametrize("name, bad", [("structure", 3), ("box", "wide"), ("box", {"a": 1}),
                                       ("weighted_density", "x"), ("weighted_density", object())])
def test_measure_names_the_argument_that_is_wrong(name, bad):
    with pytest.raises(mesofit.InputError, match=name):
        mesofit.measure("x.xtc", **{name: bad})


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_calls(call):
    with pytest.raises((mesofit.Error, TypeError, OSError)):
        call()


def test_options_have_the_names_of_arguments():
    with pytest.raises(mesofit.InputError, match="^temperature takes a number"):
        mesofit.measure("x.xtc", temperature=-3)
    with pytest.raises(mesofit.InputError, match="q_range takes a number"):
        mesofit.measure("x.xtc", q_range="far")
    assert said('give -s, -o DIR or --file-time-step; "gmx trjconv -o traj.xtc --s" makes it, a-o') == (
        'give structure, folder DIR or file_time_step; "gmx trjconv -o traj.xtc --s" makes it, a-o')
    assert said("next: look in /t/a; mesofit export /t/a --engine lammps writes it", hidden="/t/a") == (
        'next: look in result.folder; export("lammps") of the result writes it')
    assert said("waits: run the pieces whose folders are listed in o/engine/waiting, each by its run.sh or as you "
                "like, and go on with --engine later --resume") == (
        "waits: tell each of `pieces` its frames, and go_on()")


def test_hints_and_numbers_are_those_of_frames():
    positions = np.random.default_rng(1).random((20, 30, 3)) * 2
    run = mesofit.measure(mesofit.Frames(positions, [2, 2, 2]), temperature=300)
    assert any("frames have no times (times)" in line for line in run.messages)
    positions[3, 4, 1] = np.nan
    with pytest.raises(mesofit.InputError, match="frame 4: the position of atom 5 is not finite"):
        mesofit.measure(mesofit.Frames(positions, [2, 2, 2]), temperature=300)
    with pytest.raises(mesofit.InputError, match="frame 3: its time, inf, is not finite"):
        mesofit.measure(mesofit.Frames(np.ones((3, 2, 3)), [2, 2, 2], times=[0, 1, np.inf]))
    positions[3, 4, 1] = 0
    with pytest.raises(mesofit.InputError, match=r"frame 2: its time is 1e\+300 ps, beyond"):
        mesofit.measure(mesofit.Frames(positions, [2, 2, 2], times=np.arange(20) * 1e300))


STEPPED = {
    "steps below 0": lambda s: s.run(-1),
    "half a step": lambda s: s.run(1.5),
    "endless steps": lambda s: s.run(2**60),
    "true steps": lambda s: s.run(True),
    "no bins": lambda s: s.rdf(bins=0),
    "bins without end": lambda s: s.rdf(bins=2**70),
    "no samples": lambda s: s.means(samples=0),
    "range beyond the box": lambda s: s.rdf(range=1e9),
    "range that is no number": lambda s: s.rdf(range=float("nan")),
    "a force of text": lambda s: s.set_force("gravity"),
}


@pytest.mark.parametrize("call", STEPPED.values(), ids=STEPPED.keys())
def test_stepped_calls(call, simulation):
    with pytest.raises((mesofit.Error, MemoryError)):
        call(simulation)
    assert len(simulation) == 190


def test_optimiser_is_told_what_it_asked_for(optimiser):
    with pytest.raises(InputError, match="nothing that was asked"):
        optimiser.tell([1, 2])
    count = len(optimiser.ask())
    for errors in ([1.0], [1.0] * (count + 1), [float("nan")] * count, "errors"):
        with pytest.raises(InputError):
            optimiser.tell(errors)
    with pytest.raises(InputError):
        optimiser.tell([1.0] * count, [1.0])
    optimiser.tell([1.0] * count)
    with pytest.raises(InputError):
        optimiser.tell([1.0] * count)


def test_tables_refuse_what_they_have_not(simulated):
    table = simulated["rdf"]
    for call in (lambda: simulated.table("gdr"), lambda: simulated.table(3),
                 lambda: simulated.table("a\0"), lambda: simulated.potential,
                 lambda: simulated.omega, lambda: simulated.text("no.json"),
                 lambda: table["h"], lambda: table[99], lambda: table[-4]):
        with pytest.raises(mesofit.Error):
            call()
    with pytest.raises(ValueError, match="read-only"):
        table["g"][0] = 1


def test_what_is_stepped_is_not_pickled(simulation, optimiser):
    for thing in (simulation, optimiser):
        with pytest.raises(TypeError, match="cannot be pickled"):
            pickle.dumps(thing)


def test_objects_that_were_never_made_are_freed():
    for kind in (mesofit.Simulation, mesofit.Problem, mesofit.Optimiser):
        thing = kind.__new__(kind)
        del thing


@pytest.mark.filterwarnings("ignore::mesofit.MesofitWarning")
def test_the_number_of_particles_that_is_advised_is_taken(run_file):
    method = {"name": "ibi", "replicas": 2, "samples": 10, "iterations": 1}
    with pytest.raises(mesofit.InputError, match="method.particles: 60 make a box") as refused:
        mesofit.fit(run_file, method={**method, "particles": 60})
    least = int(re.search(r"(\d+) are the least", str(refused.value))[1])
    with pytest.raises(mesofit.InputError, match=f"{least} are the least"):
        mesofit.fit(run_file, method={**method, "particles": least - 1})
    result = mesofit.fit(run_file, method={**method, "particles": least})
    assert result.used["method"]["particles"] == least


@pytest.mark.parametrize("keys, text", [
    ({"temperature": float("nan")}, "temperature: nan is not finite"),
    ({"temperature": np.float32("inf")}, "temperature: inf is not finite"),
    ({"box": np.array([4, np.nan, 4])}, "box: nan is not finite"),
    ({"observables": lambda *_: 1}, "observables: expected a number, a text, a list or a dict, "
                                    "found function")])
def test_values_that_no_file_has_are_named_by_their_keys(keys, text):
    for run in (lambda: mesofit.Simulation(SCENE, **keys), lambda: mesofit.fit(SCENE, **keys)):
        with pytest.raises(InputError, match=text):
            run()


def test_another_law_takes_the_place_of_the_first():
    own = mesofit.law(lambda r: 10 * (1 - r), 1)
    assert mesofit.Scene(SCENE, conservative=own)["conservative"].keys() == {"law", "file"}
    assert mesofit.Scene(SCENE, conservative={"a": 20})["conservative"] == {
        "law": "soft-repulsion", "a": 20}
    assert len(mesofit.Simulation(SCENE, conservative=own)) == 190
