# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in memory: arrays, functions, and what looks like a Universe of MDAnalysis."""

import json
import math
import shutil
import warnings

import numpy as np
import pytest
from conftest import ROOT

import mesofit

WATER = ROOT / "tests" / "trajectories"


def read_gro(text):
    """Frames of GROMACS's text: names, residues, positions [nm], edges, times."""
    lines, frames = text.splitlines(), []
    while lines:
        count = int(lines[1])
        body = lines[2:2 + count]
        frames.append(dict(
            time=float(lines[0].split("t=")[1].split()[0]) if "t=" in lines[0] else 0.0,
            names=[line[10:15].strip() for line in body],
            residues=[int(line[:5]) for line in body],
            residue_names=[line[5:10].strip() for line in body],
            positions=np.array([[float(line[20 + 8 * d:28 + 8 * d]) for d in range(3)]
                                for line in body]),
            box=np.array(lines[2 + count].split(), dtype=float)))
        lines = lines[3 + count:]
    return frames


@pytest.fixture(scope="module")
def water(tmp_path_factory):
    """Frames of water, and the file that has the same numbers."""
    first = read_gro((WATER / "water.gro").read_text())[0]
    frames, text = [], []
    random = np.random.default_rng(1)
    for k in range(4):
        moved = np.round(first["positions"] + 0.01 * k * random.normal(
            size=first["positions"].shape).round(2), 3)
        frames.append({**first, "time": 0.5 * k, "positions": moved})
        text.append(f"water t= {0.5 * k}\n{len(moved)}\n" + "".join(
            f"{first['residues'][i] % 100000:5d}{first['residue_names'][i]:<5s}"
            f"{first['names'][i]:>5s}{(i + 1) % 100000:5d}"
            f"{moved[i, 0]:8.3f}{moved[i, 1]:8.3f}{moved[i, 2]:8.3f}\n" for i in range(len(moved)))
            + " ".join(f"{edge:.5f}" for edge in first["box"]) + "\n")
    path = tmp_path_factory.mktemp("water") / "water.gro"
    path.write_text("".join(text))
    return frames, path


class Step:
    has_velocities = has_forces = False

    def __init__(self, frame):
        self.time = frame["time"]
        self.dimensions = np.array([*(10 * frame["box"][:3]), 90, 90, 90], dtype=np.float32)
        self.positions = 10 * frame["positions"]


class Trajectory:
    """That of a fake Universe, which is where it was asked to be."""

    def __init__(self, frames):
        self.frames, self.frame, self.make = frames, 2, Step
        self.step = Step(frames[2])

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, number):
        self.frame, self.step = number, self.make(self.frames[number])
        return self.step


class Atoms:
    """An AtomGroup without masses, as MDAnalysis has them of a file that knows none."""

    def __init__(self, universe, frames):
        self.universe = universe
        self.names = np.array(frames[0]["names"], dtype=object)
        self.resnames = np.array(frames[0]["residue_names"], dtype=object)
        self.resindices = np.array(frames[0]["residues"]) - 1

    @property
    def atoms(self):
        return self

    @property
    def masses(self):
        raise AttributeError("this Universe has no masses")

    @property
    def positions(self):
        return self.universe.trajectory.step.positions

    def __len__(self):
        return len(self.names)


class Universe:
    def __init__(self, frames):
        self.trajectory = Trajectory(frames)
        self.atoms = Atoms(self, frames)


def measure(what, **keys):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return mesofit.measure(what, bins=60, range=0.9, q_range=0, begin=0, threads=2, **keys)


def test_universe_is_measured_as_its_file(water):
    frames, path = water
    universe = Universe(frames)
    of_file, of_universe = measure(path), measure(universe)
    g, expected = of_universe["rdf"]["g"], of_file["rdf"]["g"]
    # A number of angstrom over ten is rounded: a pair may change its bin.
    assert np.abs(g - expected).max() < 1e-3 and expected.max() > 1.5
    assert np.allclose(of_universe["msd"]["msd"], of_file["msd"]["msd"], rtol=1e-6)
    assert of_universe.summary["particles"] == of_file.summary["particles"]
    assert universe.trajectory.frame == 2
    of_group = measure(universe.atoms)
    assert np.array_equal(of_group["rdf"].values, of_universe["rdf"].values)


def test_arrays_and_functions_are_the_same(water):
    frames, path = water
    about = dict(types=frames[0]["names"], residues=frames[0]["residues"],
                 residue_names=frames[0]["residue_names"])
    positions = np.array([frame["positions"] for frame in frames])
    arrays = mesofit.Frames(positions, frames[0]["box"], times=[f["time"] for f in frames], **about)
    asked = []

    def get(number):
        asked.append(number)
        return frames[number] if number < len(frames) else None
    once = mesofit.Frames(get, **about)
    expected = measure(path)["rdf"].values
    assert np.array_equal(measure(arrays)["rdf"].values, expected)
    assert np.array_equal(measure(once)["rdf"].values, expected)
    assert asked == [0, 1, 2, 3, 4]
    positions = 10 * positions
    angstrom = mesofit.Frames(positions, 10 * frames[0]["box"], length="angstrom",
                              times=[1e3 * f["time"] for f in frames], time="fs", **about)
    assert np.abs(measure(angstrom)["rdf"].values - expected).max() < 1e-3


def test_forces_of_memory_are_those_of_a_file(water, tmp_path):
    """Of an extended XYZ in eV and angstrom, of arrays in nm, and of a Universe in angstrom."""
    frames, _ = water
    joule, random = 96.48533212, np.random.default_rng(5)  # kJ/mol of an eV
    many = [{**frames[0], "positions": frames[0]["positions"] + 0.01 * random.normal(
        size=frames[0]["positions"].shape)} for _ in range(9)]
    forces = random.normal(size=(9, len(many[0]["names"]), 3))
    types = [name[0] for name in many[0]["names"]]
    edges = 10 * many[0]["box"]
    with open(tmp_path / "water.xyz", "w", encoding="ascii") as file:
        for frame, force in zip(many, forces):
            file.write(f"{len(types)}\nLattice=\"{edges[0]} 0 0 0 {edges[1]} 0 0 0 {edges[2]}\" "
                       "Properties=species:S:1:pos:R:3:forces:R:3:masses:R:1\n")
            for name, at, push in zip(types, 10 * frame["positions"], force):
                numbers = " ".join(repr(float(x)) for x in [*at, *push])
                file.write(f"{name} {numbers} 1\n")
    keys = dict(static=True, forces=0.5, temperature=300, bins=60, range=0.9, q_range=0)
    of_file = mesofit.measure(tmp_path / "water.xyz", folder=tmp_path / "file", **keys)
    positions = np.array([frame["positions"] for frame in many])
    arrays = mesofit.Frames(positions, many[0]["box"], types=types, forces=10 * joule * forces,
                            masses=[1.0] * len(types))
    mesofit.measure(arrays, folder=tmp_path / "arrays", **keys)

    class ForcedStep(Step):
        has_forces = True

    universe = Universe([{**frame, "names": types} for frame in many])
    universe.trajectory.make = ForcedStep
    type(universe.atoms).forces = property(
        lambda atoms: joule * forces[atoms.universe.trajectory.frame])
    universe.atoms.resnames = np.array(types, dtype=object)
    universe.atoms.resindices = np.arange(len(types))
    type(universe.atoms).masses = property(lambda atoms: np.ones(len(types)))
    mesofit.measure(universe, folder=tmp_path / "universe", **keys)
    assert of_file.summary["particles"] == len(types)
    expected = np.loadtxt(tmp_path / "file" / "forces.tsv")
    for folder in ("arrays", "universe"):
        found = np.loadtxt(tmp_path / folder / "forces.tsv")
        assert np.abs(found - expected).max() < 1e-3 * np.abs(expected).max()
    with pytest.raises(mesofit.InputError, match="has no forces"):
        mesofit.measure(mesofit.Frames(positions, many[0]["box"], types=types,
                               masses=[1.0] * len(types)), **keys)


def test_ideal_gas_of_two_types_in_a_sheared_box_is_flat():
    random = np.random.default_rng(3)
    box = np.array([[4, 0, 0], [1, 4, 0], [0.5, -1, 4.0]])
    positions = random.random((60, 400, 3)) @ box
    frames = mesofit.Frames(positions, box, types=["A", "B"] * 200, masses=[1.0] * 400)
    target = mesofit.measure(frames, static=True, bins=6, range=1.5, temperature=300)
    assert {"rdf_A-A", "rdf_A-B", "rdf_B-B"} <= set(target.tables)
    table = target["rdf_A-B"]
    assert np.all(np.abs(table["g"] - 1) < 5 * table["g_error"] + 1e-3)
    angles = [math.degrees(math.acos(np.dot(box[i], box[j]) / math.sqrt(
        np.dot(box[i], box[i]) * np.dot(box[j], box[j])))) for i, j in ((1, 2), (0, 2), (0, 1))]
    edges = np.sqrt((box**2).sum(axis=1))
    lengths = mesofit.Frames(positions, [*edges, *angles], types=["A", "B"] * 200,
                             masses=[1.0] * 400)
    same = mesofit.measure(lengths, static=True, bins=6, range=1.5, temperature=300)
    assert np.allclose(same["rdf_A-B"]["g"], table["g"], rtol=1e-3)


@pytest.mark.parametrize("masses, reason", [
    (None, "masses of beads are not known, structure gives them: target.json has motion compared"),
    ([1, 2], "masses of beads differ"), ([2, 2], None)])
def test_motion_of_masses_that_may_differ_is_not_fitted(masses, reason, tmp_path, caplog):
    caplog.set_level("INFO", "mesofit")
    random = np.random.default_rng(2)
    steps = random.normal(scale=0.02, size=(60, 200, 3)).cumsum(axis=0)
    frames = mesofit.Frames(3 * random.random((200, 3)) + steps, [3, 3, 3], types=["A", "B"] * 100,
                            times=np.arange(60) * 1.0, masses=masses and masses * 100)
    mesofit.measure(frames, folder=tmp_path / "out", window=20, temperature=300)
    target = json.loads((tmp_path / "out/target.json").read_text())["target"]
    lines = " ".join(record.getMessage() for record in caplog.records)
    assert (target["msd"].get("fitted") == "no") == (reason is not None)
    assert ("then omega" in lines) == (reason is None)
    assert reason is None or reason in lines


def test_a_function_of_few_frames_is_told_what_it_needs():
    def get(number):
        at = np.random.default_rng(number).random((50, 3))
        return {"positions": 3 * at, "box": [3, 3, 3], "time": number} if number < 60 else None
    with pytest.warns(mesofit.MesofitWarning, match="60 frames are no window of 100 intervals "
                                                    r"\(give window, or the count of Frames\)"):
        mesofit.measure(mesofit.Frames(get, types=["A"] * 50), temperature=300)
    counted = mesofit.measure(mesofit.Frames(get, types=["A"] * 50, count=60),
                              temperature=300)
    assert "msd" in counted.tables


def test_fault_of_a_function_is_the_callers():
    def get(number):
        if number == 1:
            raise RuntimeError("the disk is gone")
        return {"positions": np.zeros((2, 3)), "box": [3, 3, 3]}
    with pytest.raises(RuntimeError, match="the disk is gone"):
        mesofit.measure(mesofit.Frames(get, types=["A", "B"]), static=True)


@pytest.mark.parametrize("about, text", [
    (dict(positions=np.zeros((2, 3)), types="AB"), "positions: expected shape"),
    (dict(positions=np.zeros((1, 2, 3)), types="ABC"), "types: 3 of 2"),
    (dict(positions=np.zeros((1, 2, 3)), box=[1, 2]), "box: expected 3 edges"),
    (dict(positions=np.zeros((3, 2, 3)), box=np.ones((2, 3))), "2 boxes of 3 frames"),
    (dict(positions=np.zeros((1, 2, 3)), box=[1, 1, 1, 20, 20, 150]), "no box of the angles"),
    (dict(positions=np.zeros((1, 2, 3)), times=[1, 2]), "times: expected shape"),
    (dict(positions=np.zeros((1, 2, 3)), forces=np.zeros((1, 2))), "forces: expected shape"),
    (dict(positions=np.zeros((1, 2, 3)), residues=[1]), "residues: 1 of 2"),
    (dict(positions=np.zeros((1, 2, 3)), residue_names=["A", "B"]), "residues are required"),
    (dict(positions=np.zeros((1, 2, 3)), length="inch"), "inch"),
    (dict(positions=np.zeros((1, 2, 3)), length=-1), "units of length"),
    (dict(positions=np.zeros((1, 2, 3)), types=["A\0", "B"]), "NUL"),
    (dict(positions=np.zeros((1, 2, 3)), types=["", "B"]), "has no name"),
    (dict(positions=np.full((1, 2, 3), np.nan), box=[3, 3, 3]), "is not finite"),
    (dict(positions=np.zeros((1, 2, 3)), masses=[1, -1]), "mass of atom 2 is -1 u"),
    (dict(positions=np.zeros((1, 0, 3))), "types, or the number of particles"),
    (dict(positions=lambda number: None), "types, or the number of particles"),
    (dict(positions=lambda number: None, types="AB"), "no frame"),
    (dict(positions=lambda number: {"positions": np.zeros((3, 3))}, types="AB"), "expected shape"),
    (dict(positions=np.zeros((0, 2, 3))), "positions: there are no frames"),
    (dict(positions=lambda number: np.zeros((2, 3)), types="AB"),
     'frame 1: expected a dict with "positions", found ndarray'),
    (dict(positions=lambda number: None, types="AB", box=[3, 3, 3]), "box: of a function"),
])
def test_wrong_frames_are_refused(about, text):
    with pytest.raises(mesofit.InputError, match=text):
        mesofit.measure(mesofit.Frames(**about), static=True)


@pytest.mark.parametrize("name", ["water.xtc", "water.trr"])
def test_real_universe_is_measured_as_its_file(name, tmp_path):
    shutil.copy(WATER / name, tmp_path)  # an index is written beside it
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mda = pytest.importorskip("MDAnalysis")
        universe = mda.Universe(str(WATER / "water.gro"), str(tmp_path / name))
        of_file = mesofit.measure(WATER / name, WATER / "water.gro", threads=1)
        of_universe = mesofit.measure(universe, threads=1)
    # Positions are of single precision in angstrom: pairs at the edge of a bin.
    assert np.abs(of_universe["rdf"]["g"] - of_file["rdf"]["g"]).max() < 2e-3
    assert of_universe.tables == of_file.tables
    if "msd" in of_file.tables:
        assert np.allclose(of_universe["msd"].values, of_file["msd"].values, rtol=1e-3, atol=1e-9)
    scenes = [json.loads(target.text("target.json"))["scene"] for target in (of_file, of_universe)]
    assert scenes[0].keys() == scenes[1].keys()
    assert ("temperature" in scenes[0]) == (name == "water.trr")
    assert scenes[0].get("temperature", 0) == pytest.approx(scenes[1].get("temperature", 0))


@pytest.mark.parametrize("name, keys", [
    ("beads.gro", {}), ("beads.xtc", {"topology_format": "MINIMAL"}), ("beads.gsd", {}),
    ("beads.xyz", {}), ("beads.lammpstrj", {"format": "LAMMPSDUMP"})])
def test_beads_are_opened_by_mdanalysis(name, keys, tmp_path):
    """Centres of mass as MDAnalysis finds them of the atoms, in each file that is written."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mda = pytest.importorskip("MDAnalysis")
        if name.endswith("gsd"):
            pytest.importorskip("gsd")
        shutil.copy(WATER / "water.trr", tmp_path)
        atoms = mda.Universe(str(WATER / "water.gro"), str(tmp_path / "water.trr"))
        atoms.add_TopologyAttr("masses", np.tile([15.999, 1.008, 1.008], len(atoms.residues)))
        mesofit.measure(WATER / "water.trr", WATER / "water.gro", static=True, threads=1,
                        q_range=0, beads=tmp_path / name, folder=tmp_path / "out")
        beads = mda.Universe(*[str(tmp_path / name)] * (2 if name.endswith("xtc") else 1), **keys)
        assert len(beads.trajectory) == (1 if name.endswith("gro") else 2)
        for frame, expected in zip(beads.trajectory, atoms.trajectory):
            edges = expected.dimensions[:3]
            scale = 10 if name.endswith("gsd") else 1  # taken as it is, which is in nm
            apart = scale * frame.positions - atoms.atoms.center_of_mass(compound="residues")
            apart -= edges * np.rint(apart / edges)
            assert np.abs(apart).max() < (0.0055 if name.endswith("xtc") else 5e-5)
            if not name.endswith("xyz"):
                assert np.allclose(scale * frame.dimensions[:3], edges, rtol=1e-6)
            if name.endswith("xtc"):
                assert frame.time == pytest.approx(expected.time, abs=1e-6)
