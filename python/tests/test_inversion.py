# SPDX-License-Identifier: GPL-3.0-or-later
"""An inversion that is told its samples: an ideal gas, whose g(r) is 1, needs no potential."""

import numpy as np
import pytest

import mesofit

BEADS = 200


def run_file(folder):
    r = np.arange(0.05, 1.0, 0.1)
    np.savetxt(folder / "rdf.tsv", np.stack([r, np.ones_like(r), 0.02 * np.ones_like(r)], axis=1))
    return {"target": {"rdf": {"file": str(folder / "rdf.tsv")}},
            "scene": {"box": [4, 4, 4], "temperature": 1, "particles": {"count": BEADS}},
            "method": {"name": "auto", "replicas": 2, "samples": 40, "precision": 0.02},
            "verification": {"replicas": 2, "samples": 20}}


def gas(piece):
    """Samples of the ideal gas."""
    random = np.random.default_rng(piece.asked["seed"])
    return random.random((piece.asked["frames"], BEADS, 3)) * piece.asked["box"]


def tell_all(inversion):
    for piece in inversion.pieces:
        assert set(piece.potentials) == {""}
        table = piece.potentials[""]
        assert table.columns == ("r", "phi", "force") and len(table) == 2000
        piece.tell(gas(piece))
        assert piece.told


def test_an_ideal_gas_has_no_potential(tmp_path):
    inversion = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out")
    rounds = 0
    while not inversion.ended:
        tell_all(inversion)
        inversion.go_on()
        rounds += 1
        assert rounds < 20
    assert inversion.result.converged
    assert np.nanmax(np.abs(inversion.result.potential["phi"])) < 0.3
    assert np.isnan(inversion.result["history"]["pressure"]).all()  # nobody told one


def test_it_goes_on_in_another_object(tmp_path):
    first = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out")
    tell_all(first)
    second = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out", resume=True)
    assert len(second.pieces) == 2 and all(piece.asked["piece"] == 2 for piece in second.pieces)
    assert all(piece.before == second.pieces[0].before.parent / piece.folder.name
               for piece in second.pieces)


def test_lines_are_for_python(tmp_path, caplog):
    caplog.set_level("INFO", "mesofit")
    inversion = mesofit.Inversion(run_file(tmp_path))
    while not inversion.ended:
        tell_all(inversion)
        inversion.go_on()
    lines = [record.getMessage() for record in caplog.records]
    assert sum(line.startswith("target rdf") for line in lines) == 1  # and not in each round
    assert lines[-1].startswith("next:") and 'export("lammps") of the result' in lines[-1]
    assert "result.folder/engine" in lines[-1] and str(inversion.result.folder) not in lines[-1]


def test_wrong_samples_are_refused(tmp_path):
    inversion = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out")
    piece = inversion.pieces[0]
    with pytest.raises(mesofit.InputError, match="expected .* frames"):
        piece.tell(np.zeros((3, BEADS, 3)))
    with pytest.raises(mesofit.InputError, match="expected 200 beads, found 7"):
        piece.tell(np.zeros((piece.asked["frames"], 7, 3)))
    with pytest.raises(mesofit.InputError, match="one of each frame"):
        piece.tell(gas(piece), pressure=1.0)
    samples = gas(piece)
    with pytest.raises(mesofit.InputError, match="positions: values are masked"):
        piece.tell(np.ma.masked_less(samples, 0.1))
    with pytest.raises(mesofit.InputError, match="pressure: the value at \\[0\\] is nan"):
        piece.tell(samples, pressure=np.full(len(samples), np.nan))
    samples[1, 3, 2] = np.nan
    with pytest.raises(mesofit.InputError, match="positions: the value at \\[1, 3, 2\\] is nan"):
        piece.tell(samples)
    assert not piece.told


def test_a_broken_piece_is_asked_for_again(tmp_path):
    inversion = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out")
    tell_all(inversion)
    frames = tmp_path / "out/engine/0001/02/frames.extxyz"
    frames.write_text("A nan".join(frames.read_text().rsplit("A ", 1)))
    with pytest.raises(mesofit.InputError, match="0001/02/frames.extxyz"):
        inversion.go_on()
    for again in (inversion,
                  mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out", resume=True)):
        assert not again.ended and [piece.folder for piece in again.pieces] == [frames.parent]
    tell_all(again)
    again.go_on()
    assert [piece.asked["piece"] for piece in again.pieces] == [2, 2]


def test_positions_in_another_unit_are_noticed(tmp_path):
    for factor in (0.1, 10):
        inversion = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out", force=True)
        piece = inversion.pieces[0]
        with pytest.raises(mesofit.InputError, match="look at the unit of their positions"):
            piece.tell(factor * gas(piece))
        assert not piece.told


def test_a_droplet_may_be_small(tmp_path):
    inversion = mesofit.Inversion(run_file(tmp_path), folder=tmp_path / "out")
    for piece in inversion.pieces:
        piece.tell(0.15 * gas(piece) + 1)
    inversion.go_on()
    assert inversion.pieces[0].asked["piece"] == 2


def test_boxes_of_constant_pressure_are_told(tmp_path):
    run = run_file(tmp_path)
    run["target"]["density"] = {"value": 200 / 64, "error": 0.05}
    inversion = mesofit.Inversion(run, folder=tmp_path / "out")
    for piece in inversion.pieces:
        edges = 4 + 0.01 * np.random.default_rng(piece.asked["seed"]).normal(
            size=(piece.asked["frames"], 1)) * np.ones(3)
        piece.tell(gas(piece) / 4 * edges[:, None, :], boxes=edges)
    inversion.go_on()
    assert all(piece.asked["piece"] == 2 for piece in inversion.pieces)
