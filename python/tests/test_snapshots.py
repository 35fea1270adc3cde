# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots of a simulation, opened by ASE, MDAnalysis and gsd: they hold what the JSON beside them
does."""

import json
import warnings

import numpy as np
import pytest

import mesofit

SCENE = {
    "units": "nm-ps", "seed": 3, "box": [3, 3.5, 4], "temperature": 300, "time_step": 0.01,
    "bonds": {"spring": {"law": "harmonic", "k": 2000, "length": 0.4}},
    "molecules": {"pair": {"count": 30, "beads": ["A", "C"], "bonds": {"spring": [[1, 2]]}}},
    "particles": {"types": {"W": 40}, "mass": {"A": 20, "C": 12, "W": 18}},
    "conservative": {"law": "soft-repulsion", "a": 50, "cutoff": 0.5},
    "dissipative": {"law": "power", "sigma": 5, "cutoff": 0.5},
    "snapshots": {"every": 20, "formats": ["json", "extxyz", "lammps-dump", "gsd", "xtc"]},
    "measure": {"equilibration": 100, "samples": 10, "every": 20},
}
FRAMES = 11


@pytest.fixture(scope="module")
def snapshots(tmp_path_factory):
    """The folder, and its frames by JSON, in nm, ps and u."""
    folder = tmp_path_factory.mktemp("snapshots") / "out"
    mesofit.simulate(SCENE, folder=folder, threads=1)
    frames = []
    for path in sorted((folder / "snapshots").glob("step_*.json")):
        frame = json.loads(path.read_text())
        beads = frame["particles"]
        frames.append(dict(
            step=frame["step"], time=frame["time"], box=np.array(frame["box"]),
            types=beads["type"], masses=np.array(beads["mass"]),
            positions=np.column_stack([beads[axis] for axis in "xyz"]),
            velocities=np.column_stack([beads["velocity_" + axis] for axis in "xyz"])))
    assert len(frames) == FRAMES and set(frames[0]["masses"]) == {20, 12, 18}
    return folder / "snapshots", frames


def symbols(frame):
    """What ASE can call them: tungsten and carbon are elements."""
    return [name if name in ("W", "C") else "X" for name in frame["types"]]


def test_extended_xyz_is_opened_by_ase(snapshots):
    io = pytest.importorskip("ase.io")
    folder, frames = snapshots
    found = io.read(folder / "trajectory.extxyz", index=":")
    assert len(found) == FRAMES
    for atoms, frame in zip(found, frames):
        assert np.allclose(atoms.cell.lengths(), 10 * frame["box"], rtol=1e-9) and atoms.pbc.all()
        assert np.allclose(atoms.positions, 10 * frame["positions"], atol=1e-7)
        assert np.allclose(atoms.arrays["velo"], frame["velocities"] / 100, atol=1e-9)
        assert np.allclose(atoms.get_masses(), frame["masses"])
        assert list(atoms.arrays["name"]) == frame["types"]
        assert atoms.get_chemical_symbols() == symbols(frame)
        assert atoms.info["Time"] == pytest.approx(1000 * frame["time"])
        assert atoms.info["Step"] == frame["step"]
        kinds = {}
        assert all(kinds.setdefault(name, number) == number
                   for name, number in zip(frame["types"], atoms.arrays["type"]))


def test_dump_is_opened_by_ase(snapshots):
    lammps = pytest.importorskip("ase.io.lammpsrun")
    units = pytest.importorskip("ase.units")
    folder, frames = snapshots
    with open(folder / "trajectory.lammpstrj") as stream:
        found = lammps.read_lammps_dump_text(stream, index=slice(None), units="real")
    assert len(found) == FRAMES
    for atoms, frame in zip(found, frames):
        assert np.allclose(atoms.cell.lengths(), 10 * frame["box"], rtol=1e-6)
        assert np.allclose(atoms.positions, 10 * frame["positions"], atol=1e-6)
        assert atoms.get_chemical_symbols() == symbols(frame)
        # ASE makes momenta of them with the masses of elements.
        mine = atoms.get_momenta() / atoms.get_masses()[:, None] * units.fs
        known = np.array(symbols(frame)) != "X"
        assert np.allclose(mine[known], frame["velocities"][known] / 100, atol=1e-8)


@pytest.mark.parametrize("name, keys, scale", [
    ("trajectory.lammpstrj", {"format": "LAMMPSDUMP", "dt": 0.01}, 1),
    ("trajectory.gsd", {"dt": 0.01}, 10)])  # GSD, which is in nm here, is taken as it is
def test_trajectories_are_opened_by_mdanalysis(snapshots, name, keys, scale):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mda = pytest.importorskip("MDAnalysis")
        if name.endswith("gsd"):
            pytest.importorskip("gsd")
        folder, frames = snapshots
        universe = mda.Universe(str(folder / name), **keys)
        assert len(universe.trajectory) == FRAMES
        for found, frame in zip(universe.trajectory, frames):
            assert np.allclose(scale * found.dimensions[:3], 10 * frame["box"], rtol=1e-6)
            apart = scale * found.positions - 10 * frame["positions"]
            apart -= 10 * frame["box"] * np.rint(apart / (10 * frame["box"]))
            shift = 0 if scale == 1 else 5 * frame["box"]  # about the middle of the box
            apart = (apart + shift + 1e-3) % (10 * frame["box"])
            assert np.abs(apart - 1e-3).max() < 5e-5
            if name.endswith("gsd"):
                assert list(universe.atoms.types) == frame["types"]
                assert np.allclose(universe.atoms.masses, frame["masses"])
            else:  # of which it reads the numbers of types, and no masses or, in 2.4, velocities
                kinds = {}
                assert all(kinds.setdefault(known, number) == number
                           for known, number in zip(frame["types"], universe.atoms.types))


def test_gsd_is_opened_by_its_own_reader(snapshots):
    gsd = pytest.importorskip("gsd.hoomd")
    folder, frames = snapshots
    with gsd.open(str(folder / "trajectory.gsd"), "rb") as trajectory:
        assert len(trajectory) == FRAMES
        for found, frame in zip(trajectory, frames):
            names = [found.particles.types[k] for k in found.particles.typeid]
            assert found.configuration.step == frame["step"] and names == frame["types"]
            assert np.allclose(found.configuration.box[:3], frame["box"], rtol=1e-6)
            assert np.allclose(found.particles.position + frame["box"] / 2, frame["positions"],
                               atol=2e-6)
            assert np.allclose(found.particles.velocity, frame["velocities"], atol=1e-5)
            assert np.allclose(found.particles.mass, frame["masses"])
            assert found.bonds.N == 30


def test_reduced_scenes_stay_reduced(tmp_path):
    """Nothing is converted where there are no units, and a bead's mass is told all the same."""
    io = pytest.importorskip("ase.io")
    mesofit.simulate({"box": [3, 3, 3], "particles": {"count": 81}, "time_step": 0.02,
                      "conservative": {"law": "soft-repulsion"}, "dissipative": {"law": "power"},
                      "snapshots": {"every": 10, "formats": ["extxyz"]},
                      "measure": {"equilibration": 0, "samples": 2, "every": 10}},
                     folder=tmp_path / "out", threads=1)
    atoms = io.read(tmp_path / "out/snapshots/trajectory.extxyz", index=-1)
    assert np.allclose(atoms.cell.lengths(), 3) and np.all(atoms.get_masses() == 1)
    assert set(atoms.arrays["name"]) == {"A"} and set(atoms.get_chemical_symbols()) == {"X"}
