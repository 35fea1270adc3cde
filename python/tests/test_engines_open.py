# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots and beads, opened by GROMACS and LAMMPS, and beads by ASE: they hold what was written
beside them. The programs are Debian's, and run for ENGINES=1; without them a test is skipped."""

import os
import re
import shutil
import subprocess

import numpy as np
import pytest
from conftest import ROOT
from test_snapshots import FRAMES, SCENE, snapshots  # noqa: F401 (a fixture)

import mesofit

WATER = ROOT / "tests/trajectories"
NUMBER = r"[-+]?\d[^,}\s]*"


def run(program, *words, folder):
    if "ENGINES" not in os.environ:
        pytest.skip("ENGINES=1 runs it, by " + program)
    if shutil.which(program) is None:
        pytest.skip(program + " is not installed")
    found = subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True, text=True,
                           timeout=60)
    assert found.returncode == 0, found.stdout[-500:] + found.stderr[-2000:]
    return found.stdout


def dumped(path, folder):
    """Frames of `gmx dump`: time, box, positions and velocities."""
    frames = []
    for text in run("gmx", "dump", "-f", path, folder=folder).split(" frame ")[1:]:
        rows = {key: np.array([[float(x) for x in re.findall(NUMBER, row)] for row in re.findall(
            r"\b" + key + r"\[\s*\d+\]=\{([^}]*)\}", text)]) for key in ("box", "x", "v")}
        frames.append(dict(rows, time=float(re.search(r"time=\s*(\S+)", text)[1])))
    return frames


def test_xtc_is_opened_by_gromacs(snapshots):  # noqa: F811
    folder, frames = snapshots
    found = dumped("trajectory.xtc", folder)
    assert len(found) == FRAMES
    for frame, expected in zip(found, frames):
        assert frame["time"] == pytest.approx(expected["time"], rel=1e-5)
        assert np.allclose(frame["box"].diagonal(), expected["box"], rtol=1e-5)
        assert np.abs(frame["x"] - expected["positions"]).max() < 0.0006


def test_dump_is_opened_by_lammps(snapshots, tmp_path):  # noqa: F811
    folder, frames = snapshots
    types = list(SCENE["particles"]["mass"])
    frame = frames[-1]
    script = ["units real", "region box block 0 1 0 1 0 1", f"create_box {len(types)} box",
              "mass * 1",
              f"read_dump {folder}/trajectory.lammpstrj {frame['step']} x y z vx vy vz "
              "box yes replace no purge yes trim no add keep",
              "write_dump all custom out.txt id type x y z vx vy vz "
              "modify sort id format float %.10g"]
    (tmp_path / "in.read").write_text("\n".join(script) + "\n")
    run("lmp", "-in", "in.read", folder=tmp_path)
    lines = (tmp_path / "out.txt").read_text().splitlines()
    bounds = np.array([line.split() for line in lines[5:8]], float)
    rows = np.array([line.split() for line in lines[9:]], float)
    assert len(rows) == len(frame["types"])
    assert np.allclose(bounds[:, 1] - bounds[:, 0], 10 * frame["box"])
    apart = rows[:, 2:5] - 10 * frame["positions"]
    assert np.abs(apart - 10 * frame["box"] * np.rint(apart / (10 * frame["box"]))).max() < 1e-4
    assert np.allclose(rows[:, 5:], frame["velocities"] / 100, atol=1e-7)
    kinds = {}
    assert all(kinds.setdefault(name, number) == number
               for name, number in zip(frame["types"], rows[:, 1]))


@pytest.fixture(scope="module")
def beads(tmp_path_factory):
    """Writes the beads of two frames of water with velocities, and reads those of the .gsd."""
    folder = tmp_path_factory.mktemp("beads")
    for name in ("beads.gro", "beads.xtc", "beads.lammpstrj", "beads.extxyz", "beads.gsd"):
        mesofit.measure(WATER / "water.trr", WATER / "water.gro", static=True, threads=1,
                        q_range=0, beads=folder / name, folder=folder / "out", force=True)
    gsd = pytest.importorskip("gsd.hoomd")
    with gsd.open(str(folder / "beads.gsd"), "rb") as trajectory:
        return folder, [dict(box=np.array(frame.configuration.box[:3]),
                             positions=np.array(frame.particles.position),
                             velocities=np.array(frame.particles.velocity),
                             masses=np.array(frame.particles.mass)) for frame in trajectory]


def away(found, frame, scale=1):
    apart = found / scale - frame["positions"]
    return np.abs(apart - frame["box"] * np.rint(apart / frame["box"])).max()


def test_beads_are_opened_by_gromacs(beads):
    folder, frames = beads
    found = dumped("beads.xtc", folder)
    assert len(found) == len(frames) == 2
    assert all(away(one["x"], frame) < 0.0006 for one, frame in zip(found, frames))
    run("gmx", "editconf", "-f", "beads.gro", "-o", "again.g96", folder=folder)
    text = (folder / "again.g96").read_text()
    blocks = [np.array([line.split()[-3:] for line in text.split(name)[1].split("END")[0]
                        .strip().splitlines()], float) for name in ("POSITION\n", "VELOCITY\n")]
    assert min(away(blocks[0], frame) for frame in frames) < 1e-5
    assert min(np.abs(blocks[1] - frame["velocities"]).max() for frame in frames) < 1e-3


@pytest.mark.parametrize("name", ["beads.extxyz", "beads.lammpstrj"])
def test_beads_are_opened_by_ase(beads, name):
    folder, frames = beads
    io = pytest.importorskip("ase.io")
    lammps = pytest.importorskip("ase.io.lammpsrun")
    if name.endswith("xyz"):
        found = io.read(folder / name, index=":")
    else:
        with open(folder / name) as stream:
            found = lammps.read_lammps_dump_text(stream, index=slice(None), units="real")
    assert len(found) == len(frames)
    for atoms, frame in zip(found, frames):
        assert np.allclose(atoms.cell.lengths(), 10 * frame["box"], rtol=1e-6)
        assert away(atoms.positions, frame, 10) < 1e-5
        if name.endswith("xyz"):
            assert np.allclose(atoms.get_masses(), frame["masses"], rtol=1e-5)
