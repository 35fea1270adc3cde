# SPDX-License-Identifier: GPL-3.0-or-later
"""`mesofit describe --format schema`: editors that know it accept what the program accepts."""

import copy
import json
import re
import subprocess

import pytest
from conftest import PROGRAM, ROOT, SCENE

import mesofit

jsonschema = pytest.importorskip("jsonschema")


@pytest.fixture(scope="module")
def schema():
    text = subprocess.run([PROGRAM, "describe", "--format", "schema"], capture_output=True,
                          text=True, check=True).stdout
    read = json.loads(text)
    jsonschema.Draft7Validator.check_schema(read)
    return jsonschema.Draft7Validator(read)


def fault(schema, content):
    """The first fault, in words, or ""."""
    found = next(iter(schema.iter_errors(content)), None)
    return "" if found is None else f"{list(found.absolute_path)}: {found.message[:200]}"


FILES = sorted(path for folder in ("runs", "examples", "tests/bench", "tests/fuzz/corpus")
               for path in (ROOT / folder).rglob("*.json") if "out" not in path.parts)


def test_states_make_a_run_file(schema):
    state = {"target": {"rdf": {"file": "rdf.tsv"}}}
    assert fault(schema, {"states": {"hot": state, "cold": state}, "scene": {"density": 1}}) == ""
    assert fault(schema, {"states": {"hot": state}, "secne": {}}) != ""
    # They may share a part of a target that is whole in each alone.
    shared = {"rdf": {"cutoff": 0.9}}
    assert fault(schema, {"states": {"hot": state}, "target": shared, "scene": {"density": 1}}) == ""
    assert fault(schema, {"states": {}, "scene": {"density": 1}}) != ""


FRICTION = {"law": "power", "sigma": 3}


@pytest.mark.parametrize("shared, state", [
    ({"memory": {"slow": {"omega": FRICTION}}}, {"memory": {"slow": {"time": 0.5}}}),
    ({"bonds": {"AB": {"law": "harmonic", "length": 1}}}, {"bonds": {"AB": {"k": 30}}}),
    ({"bonds": {"AB": {"law": "harmonic", "k": 30}}}, {"bonds": {"AB": {"length": 1}}}),
    ({"conservative": {"law": "table"}}, {"conservative": {"file": "phi.tsv"}}),
    ({"dissipative": {"law": "power"}}, {"dissipative": {"sigma": 3}}),
    ({"dissipative": FRICTION}, {"dissipative": None}),
    ({"dissipative": FRICTION}, {"dissipative": {"sigma": None}}),
    ({"dissipative": FRICTION},
     {"dissipative": {"law": "table", "file": "omega.tsv", "sigma": None}}),
    ({"memory": {"slow": {"omega": FRICTION, "time": 1}}}, {"memory": {"slow": None}}),
    ({"particles": {"types": {"A": 5, "B": 5}}}, {"particles": {"types": {"A": None}}}),
], ids=json.dumps)
def test_a_state_is_a_patch_of_its_file(schema, shared, state):
    hot = {"target": {"rdf": {"file": "rdf.tsv"}}, "scene": state}
    assert fault(schema, {"states": {"hot": hot}, "scene": {"density": 1, **shared}}) == ""
    # Without states a file is whole: one of the parts alone is not.
    assert any(fault(schema, {**hot, "scene": {"density": 1, **part}}) for part in (shared, state))


def test_wrong_keys_and_values_of_a_state_are_named(schema):
    def in_state(**scene):
        return fault(schema, {"states": {"hot": {"scene": scene}}, "scene": {"density": 1}})
    assert "'temprature' was unexpected" in in_state(temprature=1)
    assert "'temperature']: 'hot' is not of type 'number'" in in_state(temperature="hot")
    for key, law in (("dissipative", {"law": "power", "sigma": "x"}),
                     ("conservative", {"law": "soft-repulsion", "b": 1})):
        assert f"['states', 'hot', 'scene', '{key}']" in in_state(**{key: law})
    assert fault(schema, {"states": {"hot": None}, "scene": {"density": 1}}) != ""


def test_what_no_file_may_have_is_refused(schema):
    for wrong in ({"box": [3, -3, 3]}, {"box": [0, 3, 3]}, {"particles": {"count": 5, "mass": 0}},
                  {"particles": {"types": {"A": 5, "B": 5}, "mass": {"A": -1, "B": 1}}}):
        assert fault(schema, wrong) != "", wrong
    assert fault(schema, {"box": [3, 3, 3], "particles": {"count": 5, "mass": 18}}) == ""


def test_files_of_the_repository_are_valid(schema):
    read = []
    for path in FILES:
        try:
            read.append((path, json.loads(path.read_text())))
        except ValueError:  # some of the corpus are broken on purpose
            continue
    assert len(read) > 60
    for path, content in read:
        if "system" not in content:  # an initial file of a tutorial, which is a placement
            assert fault(schema, content) == "", path


def test_blocks_of_the_pages_are_valid(schema):
    count = 0
    for page in (ROOT / "docs").glob("*.md"):
        for block in re.findall(r"^```json\n(.*?)^```", page.read_text(), re.M | re.S):
            try:
                content = json.loads(block)
            except ValueError:  # a part of a file
                continue
            if {"target", "box", "particles"} & set(content):
                count += 1
                assert fault(schema, content) == "", f"{page.name}: {block}"
    assert count >= 5


def test_what_was_used_is_valid(schema, simulated, fitted):
    assert fault(schema, simulated.used) == "" and fault(schema, fitted.used) == ""


def test_a_wrong_key_is_named(schema):
    assert "'bxo' was unexpected" in fault(schema, {**SCENE, "bxo": [4, 4, 4]})
    assert "'temprature' was unexpected" in fault(
        schema, {"target": {"rdf": {"file": "rdf.tsv"}}, "scene": {"density": 3, "temprature": 1}})


@pytest.mark.parametrize("wrong", [
    {"units": {"length": 0.4}}, {"seed": 2**53}, {"scene": {"title": "water"}},
    {"scene": {"seed": 3}}, {"scene": {"measure": {"samples": 10}}},
    {"scene": {"rdf": {"range": 1}}}, {"scene": {"particles": {"types": {}}}},
    {"scene": {"dissipative": {"law": "table"}}}],
    ids=json.dumps)
def test_what_no_run_file_may_have_is_refused_by_both(schema, run_file, wrong):
    good = {**run_file, "target": {"rdf": {"file": "rdf.tsv"}}}
    part, value = next(iter(wrong.items()))
    bad = {part: {**good["scene"], **value} if part == "scene" else value}
    assert fault(schema, good) == "" and fault(schema, {**good, **bad}) != ""
    with pytest.raises(mesofit.InputError):
        mesofit.fit({**run_file, **bad})


@pytest.fixture
def run():
    return {"target": {"rdf": {"file": "rdf.tsv"}}, "scene": {"density": 3, "temperature": 1}}


def members(schema, group, chief):
    """Keys of each of a group, by its name, as an editor is told them."""
    return {member["if"]["properties"][chief]["const"]: set(member["then"]["properties"])
            for member in schema.schema["definitions"][group]["allOf"]}


@pytest.mark.parametrize("group, chief", [
    ("method", "name"), ("conservative", "law"), ("dissipative", "law"), ("dynamics", "integrator")])
def test_keys_of_one_are_not_those_of_another(schema, group, chief):
    """Beside what `mesofit describe` says of each."""
    found = members(schema, group, chief)
    enum = schema.schema["definitions"][group]["properties"][chief]["enum"]
    assert len(found) >= 4 and sorted(found) == sorted(enum)
    for name, keys in found.items():
        if name == "none":
            assert keys == {chief}
            continue
        said = subprocess.run([PROGRAM, "describe", name], capture_output=True, text=True).stdout
        own = [part for part in re.split(r"(?m)^(?=[\w-]+ \()", said)
               if part.startswith(f"{name} ({group}")]
        assert len(own) == 1, said
        assert set(re.findall(r"(?m)^  (\w+)", own[0])) == keys - {chief}, name


def test_methods_share_few_keys(schema, run):
    def with_method(**method):
        return fault(schema, {**run, "method": method})
    assert with_method(name="imc", precision=0.05) == with_method(name="genetic",
                                                                   crossover=0.5) == ""
    # One fault, of the method that is named.
    assert with_method(name="imc", crossover=0.5) == (
        "['method']: Additional properties are not allowed ('crossover' was unexpected)")
    assert "['method', 'crossover']: 3 is greater" in with_method(name="genetic", crossover=3)
    assert "'magic' is not one of ['auto', 'imc'" in with_method(name="magic")
    # Without a name it is chosen, and has the keys of an inversion.
    assert with_method(precision=0.05) == ""
    assert "'crossover' was unexpected" in with_method(crossover=0.5)


def bad_runs():
    """Each method with a key that only another one has."""
    for name, key in (("auto", "population"), ("ibi", "population"), ("hnc", "population"),
                      ("imc", "population"), ("genetic", "sampler"), ("cma-es", "sampler")):
        yield f"{name}: {key}", {"name": name, key: 1}


@pytest.mark.parametrize("method", dict(bad_runs()).values(), ids=dict(bad_runs()).keys())
def test_keys_of_another_method_are_refused_by_both(schema, run_file, method):
    bad = {**run_file, "target": {"rdf": {"file": "rdf.tsv"}}, "method": method}
    assert "was unexpected" in fault(schema, bad)
    with pytest.raises(mesofit.InputError, match="unknown key"):
        mesofit.fit({**run_file, "method": method})


def test_an_integrator_need_not_be_named(schema):
    assert fault(schema, {**SCENE, "dynamics": {}}) == ""
    assert "'friction' was unexpected" in fault(
        schema, {**SCENE, "dynamics": {"integrator": "aboba", "friction": 1}})


def objects(content, path=()):
    """Paths of all objects of a file."""
    yield path
    for key, value in content.items():
        if isinstance(value, dict):
            yield from objects(value, (*path, key))


def bad_scenes():
    """A word too much in each object, and values of wrong types and ranges."""
    full = {**copy.deepcopy(SCENE), "dynamics": {"integrator": "aboba"}, "motion": {},
            "interactions": {"uniform-force": {"force": [1, 0, 0]}}}
    for path in objects(full):
        if path not in (("interactions", "uniform-force"),):
            bad = copy.deepcopy(full)
            inside = bad
            for key in path:
                inside = inside[key]
            inside["nonsense"] = 1
            yield "/".join((*path, "nonsense")), bad
    wrong = {
        "box": ["4", 4, [4], [4, 4, 4, 4], ["a", 4, 4], None],
        "particles": [190, "190", [], {"count": "190"}, {"count": 1.5}, {"count": -3},
                      {"count": None}, {"count": 190, "placement": "heap"}],
        "temperature": ["hot", -1, True, {}, [1]],
        "conservative": ["soft", {"law": "lava"}, {}, {"law": "soft-repulsion", "a": "25"},
                         {"law": "soft-repulsion", "b": 1}, {"law": 3}],
        "dissipative": [{"law": "power", "sigma": []}, {"law": "lennard-jones"}, {"sigma": 3}],
        "measure": [3, {"samples": 0}, {"samples": "many"}, {"every": 0}, {"every": 2.5}],
        "dynamics": ["aboba", {"integrator": "leapfrog"}, {"integrator": 1}],
        "rdf": [{"bins": 0}, {"bins": "32"}, {"range": -1}, []],
        "seed": [-1, "one", 1.5], "title": [3, {}], "skin": ["thick"],
        "units": ["metric", 3], "time_step": [0, -0.1, "short"], "precision": ["triple"],
    }
    for key, values in wrong.items():
        for value in values:
            yield f"{key}: {json.dumps(value)}", {**full, key: value}


BAD = dict(bad_scenes())


def test_there_are_fifty_bad_files():
    assert len(BAD) >= 50


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD.keys())
def test_bad_files_are_refused_by_both(schema, bad):
    with pytest.raises(mesofit.Error):
        mesofit.simulate(bad)
    assert fault(schema, bad) != ""
